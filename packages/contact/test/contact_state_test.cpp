// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_state.hpp"

#include "foundation_scene.hpp"
#include "rpc/fem/interpolation.hpp"

#include <gtest/gtest.h>

namespace contact_state_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// (contact nodes) side(k) at a point of side k.
DeviceView<double *> at_contact_nodes(const Scene &scene, const std::vector<std::function<double(const Point &)>> &side)
{
  const auto &c = scene.iterate->points();
  const auto node = to_host(c.node);
  const auto coords = to_host(scene.d.mesh->coords);
  HostView<double *> values("values", c.size());
  for (int k = 0; k < c.num_sides(); ++k)
    for (LO i = c.first(k); i < c.first(k + 1); ++i) values(i) = side[k]({coords(node(i), 0), coords(node(i), 1), 0});
  return to_device(values);
}

contact::ContactState interpolated(const Scene &coarse, const Scene &fine, const RCP<Vector> &u,
                                   const DeviceView<double *> &multiplier)
{
  return contact::interpolated(*fem::interpolation(coarse.d, fine.d), coarse.iterate->points(), {u, multiplier, {}},
                               fine.iterate->points(), fine.d.owned_dofs);
}

TEST(StartFrom, CarriesAffineDisplacementsAndMultipliersSideBySide)
{
  // Another factor than the partition's divisions: fine nodes lie on other ranks than their coarse cells.
  const std::vector<contact::ContactOptions> foundations{below(40), beside(40)};
  const Scene coarse(foundations), fine(foundations, held("top"), 3);
  const auto displacement = [](const Point &x) { return Point{0.2 * (1 - x[1]), -0.3 * (1 - x[1]), 0}; };
  const std::vector<std::function<double(const Point &)>> pressure{[](const Point &x) { return 0.3 + 0.4 * x[0]; },
                                                                   [](const Point &x) { return 2.5 - 2 * x[1]; }};
  Vector u(fine.d.owned_dofs);
  fine.iterate->start_from(interpolated(coarse, fine, coarse.vector(displacement), at_contact_nodes(coarse, pressure)),
                           u);
  u.update(-1., *fine.vector(displacement), 1.);
  EXPECT_LT(u.norm2(), 1e-14);
  const auto found = to_host(fine.iterate->duals().multipliers().normal),
             expected = to_host(at_contact_nodes(fine, pressure));
  const auto fixed = to_host(fine.iterate->points().fixed);
  const auto coords = to_host(fine.d.mesh->coords);
  const auto node = to_host(fine.iterate->points().node);
  for (LO i = 0; i < fine.iterate->points().size(); ++i) {
    if (coords(node(i), 1) > 1 - 1. / 3 - 1e-9) continue; // beside a held node, whose multiplier is 0 by convention
    EXPECT_NEAR(found(i), fixed(i) ? 0 : expected(i), 1e-14) << i;
  }
}

TEST(ContactState, CarriesTangentialMultipliersWhereThereAreSomeAndNoneElsewhere)
{
  const std::vector<contact::ContactOptions> foundations{below(40), beside(40)};
  const Scene coarse(foundations), fine(foundations, held("top"), 3);
  const auto along = [](const Point &x, const int k) { return k == 0 ? 1 + x[0] : 3 - 2 * x[1]; };
  const auto vectors_on = [&](const Scene &scene) {
    const auto &c = scene.iterate->points();
    const auto node = to_host(c.node);
    const auto coords = to_host(scene.d.mesh->coords);
    const DeviceView<double **> vectors("vectors", c.size(), 2);
    const auto host = Kokkos::create_mirror_view(vectors);
    for (LO i = 0; i < c.size(); ++i)
      for (int k = 0; k < 2; ++k) host(i, k) = along({coords(node(i), 0), coords(node(i), 1), 0}, k);
    Kokkos::deep_copy(vectors, host);
    return vectors;
  };
  const auto &points = coarse.iterate->points();
  const auto to_fine = fem::interpolation(coarse.d, fine.d);
  contact::ContactState state{coarse.vector(0, 0), DeviceView<double *>("pressure", points.size()), {}};
  const auto without = contact::interpolated(*to_fine, points, state, fine.iterate->points(), fine.d.owned_dofs);
  EXPECT_FALSE(without.multiplier.has_tangential());
  state.multiplier.tangential = vectors_on(coarse);
  const auto with = contact::interpolated(*to_fine, points, state, fine.iterate->points(), fine.d.owned_dofs);
  const contact::Multipliers copy = with.multiplier.copy();
  Kokkos::deep_copy(with.multiplier.tangential, 0.); // the copy has numbers of its own
  const DeviceView<double **> expected = vectors_on(fine);
  const auto found = Kokkos::create_mirror_view(copy.tangential), right = Kokkos::create_mirror_view(expected);
  Kokkos::deep_copy(found, copy.tangential);
  Kokkos::deep_copy(right, expected);
  ASSERT_EQ(found.extent(0), right.extent(0));
  for (std::size_t i = 0; i < found.extent(0); ++i)
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(found(i, k), right(i, k), 1e-13) << i;
}

TEST(StartFrom, LeavesPrescribedDisplacementsAndStaysWithinTheYieldLimit)
{
  const std::vector<contact::ContactOptions> foundations{below(40)};
  const Scene coarse(foundations, held("top", {0.5, 0, 0})), fine(foundations, held("top", {0, 0.25, 0}), 2);
  Vector u(*fine.elastic.dirichlet.value, Teuchos::Copy);
  const auto above = at_contact_nodes(coarse, {[](const Point &) { return 100.; }});
  fine.iterate->start_from(interpolated(coarse, fine, coarse.vector(1, 2), above), u);
  const auto fixed = to_host(fine.elastic.dirichlet.fixed);
  const auto prescribed = fine.elastic.dirichlet.value->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto now = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t dof = 0; dof < now.extent(0); ++dof)
    if (fixed(dof)) {
      EXPECT_EQ(now(dof, 0), prescribed(dof, 0)) << dof;
    }
  const auto lambda = to_host(fine.iterate->duals().multipliers().normal),
             xi = to_host(fine.iterate->points().law.yield);
  for (std::size_t i = 0; i < lambda.extent(0); ++i) {
    EXPECT_GE(lambda(i), 0);
    EXPECT_LE(lambda(i), xi(i));
  }
}

TEST(OnFoundation, MovesClosedPointsAlone)
{
  const Scene scene({below(40), beside(40)});
  const contact::ContactNodes &c = scene.iterate->points();
  const auto pressure = at_contact_nodes(
      scene, {[](const Point &x) { return x[0] < 0.5 ? 0.5 : 0.; }, [](const Point &) { return 40.; }});
  const auto u = scene.vector(0.01, 0.02);
  const auto before = to_host(contact::penetrations(c, *u));
  const auto after = to_host(contact::penetrations(c, *contact::on_foundation(c, {u, pressure, {}})));
  const auto p = to_host(pressure);
  const auto fixed = to_host(c.fixed);
  for (LO i = 0; i < c.size(); ++i)
    if (fixed(i) || p(i) != 0.5)
      EXPECT_EQ(after(i), before(i)) << i; // open, or at the yield limit
    else
      EXPECT_NEAR(after(i), 0, 1e-16) << i;
}

} // namespace
} // namespace contact_state_test

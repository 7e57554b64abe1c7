// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/interpolation.hpp"

#include <algorithm>

namespace mixed_box_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// With a last cell of another length in each direction; x > 0.
mesh::BoxOptions box_of(const mesh::Element &element)
{
  if (element.dim == 2) return {{1, 2}, {1.5, 3}, {4, 5}, element, {1.5, 1}};
  return {{1, 2, 0}, {2, 2.1, 0.5}, {4, 3, 3}, element, {1, 1.5, 2}};
}
mesh::BoxOptions whole(mesh::BoxOptions box)
{
  box.element.linear = {};
  return box;
}

template <class Check>
void for_each_mixed(const Check &check)
{
  for (const int dim : {2, 3})
    for (const mesh::Element &element : mesh::mixed_elements(dim)) {
      SCOPED_TRACE(element.name());
      check(element);
    }
}

/// (owned nodes; dim) Without order, of places alone.
MultiVector displacement(const fem::Discretization &d)
{
  MultiVector u(d.mesh->owned_nodes, d.dim());
  const auto values = u.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
    const Point x = point_of(d, n);
    for (int c = 0; c < d.dim(); ++c) values(n, c) = std::sin(100 * c + 91 * x[0] + 83 * x[1] + 57 * x[2]);
  }
  return u;
}
/// (owned dofs)
Vector as_dofs(const fem::Discretization &d, const MultiVector &nodal)
{
  Vector u(d.owned_dofs);
  const auto to = u.getLocalViewHost(Tpetra::Access::OverwriteAll);
  const auto from = nodal.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
    for (int c = 0; c < d.dim(); ++c) to(dof(d.dim(), n, c), 0) = from(n, c);
  return u;
}
double work(const CrsMatrix &K, const Vector &u, const Vector &v)
{
  Vector Ku(K.getRangeMap());
  K.apply(u, Ku);
  return Ku.dot(v);
}

/// u K v is that of Q2 for the interpolated u and v: K is P^T K P.
TEST(MixedBox, HasTheStiffnessOfQ2ForItsDisplacements)
{
  using fem::Kinematics;
  const fem::Materials materials = fem::Material{1000, 0.3};
  for_each_mixed([&](const mesh::Element &element) {
    std::vector<Kinematics> all{Kinematics::plane_strain};
    if (element.dim == 2) all = {Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric};
    for (const Kinematics kinematics : all) {
      const auto mixed = body(box_of(element), world(), {}, kinematics);
      const auto full = body(whole(box_of(element)), world(), {}, kinematics);
      const auto K = fem::assemble_stiffness(mixed, materials), K2 = fem::assemble_stiffness(full, materials);
      const auto P = fem::interpolation(mixed, full);
      const MultiVector u = displacement(mixed);
      MultiVector v(u, Teuchos::Copy), Pu(full.mesh->owned_nodes, full.dim()), Pv(Pu.getMap(), full.dim());
      v.abs(u);
      P->apply(u, Pu);
      P->apply(v, Pv);
      const auto du = as_dofs(mixed, u), dv = as_dofs(mixed, v), fu = as_dofs(full, Pu), fv = as_dofs(full, Pv);
      const double scale = std::sqrt(work(*K2, fu, fu) * work(*K2, fv, fv));
      EXPECT_GT(scale, 0);
      EXPECT_NEAR(work(*K, du, dv), work(*K2, fu, fv), 1e-12 * scale);
      EXPECT_NEAR(work(*K, du, du), work(*K2, fu, fu), 1e-12 * work(*K2, fu, fu));
    }
  });
}

/// A mesh reproduces the polynomials of its orders on any finer one: order 2 on the same cells, more cells, and those that it came from.
TEST(MixedBox, InterpolatesItsPolynomialsExactly)
{
  for_each_mixed([](const mesh::Element &element) {
    const auto from = body(box_of(element), world());
    auto more = whole(box_of(element));
    for (int &cells : more.cells) cells = 2 * cells + 1;
    for (const auto &box : {whole(box_of(element)), more}) {
      const auto to = body(box, world());
      const auto at_nodes = [&](const fem::Discretization &d) {
        MultiVector f(d.mesh->owned_nodes, 1);
        const auto values = f.getLocalViewHost(Tpetra::Access::OverwriteAll);
        for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
          const Point x = point_of(d, n);
          values(n, 0) = 1;
          for (int k = 0; k < element.dim; ++k)
            values(n, 0) *= 0.3 + x[k] - (element.order_along(k) - 1) * 0.7 * x[k] * x[k];
        }
        return f;
      };
      MultiVector found(to.mesh->owned_nodes, 1), expected = at_nodes(to);
      const auto P = fem::interpolation(from, to);
      P->apply(at_nodes(from), found);
      const double size = expected.getVector(0)->normInf();
      found.update(-1., expected, 1.);
      EXPECT_LT(found.getVector(0)->normInf(), 1e-13 * size);
    }
  });
}

/// Where the cells are the same, so is their division among ranks.
TEST(MixedBox, StaysOnTheRanksOfItsCells)
{
  for_each_mixed([](const mesh::Element &element) {
    const auto mixed = body(box_of(element), world()), full = body(whole(box_of(element)), world());
    ASSERT_EQ(mixed.mesh->num_owned_cells, full.mesh->num_owned_cells);
    ASSERT_EQ(mixed.mesh->num_cells(), full.mesh->num_cells());
    for (LO c = 0; c < mixed.mesh->num_owned_cells; ++c) EXPECT_EQ(mixed.mesh->cell_id(c), full.mesh->cell_id(c));
  });
}

} // namespace
} // namespace mixed_box_test

// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::contact
{
namespace
{

/// How deep the deepest of a side's points lies in the foundation, and the normal there.
struct Deepest {
  double depth = 0; // [m]
  Point normal{};
};

Deepest deepest_point(const Comm &comm, const ContactNodes &points, const int side)
{
  using Location = Kokkos::MaxLoc<double, LO>;
  const auto gap = points.free_gap;
  Location::value_type local;
  Kokkos::parallel_reduce(
      "rpc::contact::deepest_point",
      Kokkos::RangePolicy<ExecutionSpace, LO>(points.first(side), points.first(side + 1)),
      KOKKOS_LAMBDA(const LO i, Location::value_type &most) {
        if (!(-gap(i) > most.val)) return;
        most.val = -gap(i);
        most.loc = i;
      },
      Location(local));
  Deepest deepest;
  deepest.depth = max_all(comm, std::max(0., local.val)); // a maximum over no points is -DBL_MAX
  if (!(deepest.depth > 0)) return deepest;
  const int owner = min_all(comm, local.val == deepest.depth ? comm.getRank() : comm.getSize());
  Point mine{};
  if (owner == comm.getRank()) {
    const auto normal = points.normal;
    const DeviceView<double[3]> at("rpc::contact::normal_of_deepest");
    Kokkos::parallel_for(
        "rpc::contact::normal_of_deepest", device_range(points.dim),
        KOKKOS_LAMBDA(const LO k) { at(k) = normal(local.loc, k); });
    const auto values = to_host(at);
    for (int k = 0; k < points.dim; ++k) mine[k] = values(k);
  }
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 3, mine.data(), deepest.normal.data());
  return deepest;
}

} // namespace

Overlap overlap(const fem::Discretization &d, const ContactNodes &points, const int side,
                const fem::DirichletDofs &dirichlet)
{
  const Comm &comm = d.mesh->comm();
  const Deepest deepest = deepest_point(comm, points, side);
  if (!(deepest.depth > 0)) return {};
  const Kokkos::Array<double, 3> n{deepest.normal[0], deepest.normal[1], deepest.normal[2]};
  const int dim = d.dim();
  int largest = 0; // component of the normal
  for (int k = 1; k < dim; ++k)
    if (std::abs(n[k]) > std::abs(n[largest])) largest = k;
  const auto coords = d.mesh->coords;
  const auto condition = dirichlet.condition;
  const auto u = device_read(*dirichlet.value);
  double low = 0, high = 0, out = 0;
  int held = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::extent_along_normal", device_range(d.mesh->num_owned_nodes()),
      KOKKOS_LAMBDA(const LO node, double &least, double &most, double &moved, int &any) {
        double along = 0, away = 0;
        for (int k = 0; k < dim; ++k) {
          along += n[k] * coords(node, k);
          away -= n[k] * u(dof(dim, node, k));
        }
        if (along < least) least = along;
        if (along > most) most = along;
        if (away > moved) moved = away;
        if (condition(dof(dim, node, largest)) >= 0) any = 1;
      },
      Kokkos::Min<double>(low), Kokkos::Max<double>(high), Kokkos::Max<double>(out), Kokkos::Max<int>(held));
  return {deepest.depth - max_all(comm, std::max(0., out)), max_all(comm, high) - min_all(comm, low),
          max_all(comm, held) > 0};
}

bool is_loaded(const Comm &comm, const fem::ElasticProblem &elastic, const ContactNodes &points)
{
  if (elastic.applied_load->normInf() > 0 || elastic.dirichlet.value->normInf() > 0) return true;
  const auto gap = points.free_gap;
  const FrictionPoints friction = points.friction;
  const bool drags = friction.exists();
  const int dim = points.dim;
  int any = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::is_loaded", device_range(points.size()),
      KOKKOS_LAMBDA(const LO i, int &loaded) {
        if (gap(i) < 0) loaded = 1;
        for (int k = 0; drags && k < dim; ++k)
          if (friction.from(i, k) != 0) loaded = 1;
      },
      Kokkos::Max<int>(any));
  return max_all(comm, any) > 0;
}

double smallest_gap(const Comm &comm, const ContactNodes &points, const ContactResult &result)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto weight = points.weight, v = result.penetration, dent = result.dent;
  double least = infinite;
  Kokkos::parallel_reduce(
      "rpc::contact::smallest_gap", device_range(points.size()),
      KOKKOS_LAMBDA(const LO i, double &smallest) {
        if (weight(i) > 0 && dent(i) - v(i) < smallest) smallest = dent(i) - v(i);
      },
      Kokkos::Min<double>(least));
  const double all = min_all(comm, least); // a minimum over no points is DBL_MAX
  return std::min(all < std::numeric_limits<double>::max() ? all : infinite, result.between.smallest_gap);
}

} // namespace rpc::contact

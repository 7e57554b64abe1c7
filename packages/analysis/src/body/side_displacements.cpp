// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/side_displacements.hpp"

#include "rpc/fem/surface.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <map>

namespace rpc::analysis
{
namespace
{

/// (owned nodes of a side) the area that each stands for: the integral of its shape function.
std::map<LO, double> node_areas(const fem::Discretization &d, const mesh::Side &side)
{
  const auto facets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), side.facets);
  const auto measure = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fem::facet_measure(d, side));
  const auto value = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), d.reference.facet.value);
  const std::size_t points = value.extent(0), owned = d.mesh->num_owned_nodes();
  std::map<LO, double> areas;
  for (std::size_t f = 0; f < facets.extent(0); ++f)
    for (std::size_t a = 0; a < facets.extent(1); ++a) {
      const LO node = facets(f, a);
      if (static_cast<std::size_t>(node) >= owned) continue; // another rank counts it
      double &area = areas[node];
      for (std::size_t q = 0; q < points; ++q) area += measure(f * points + q) * value(q, a);
    }
  return areas;
}

} // namespace

std::vector<SideDisplacement> side_displacements(const fem::Discretization &d, const Vector &u)
{
  const auto displacement = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  const int dim = d.dim();
  constexpr int width = 8; // of a side: sums by area and by nodes, 3 each, then area and number of nodes
  const auto &sides = d.mesh->sides;
  std::vector<double> own(width * sides.size(), 0), sums(own.size()), longest(sides.size(), 0), largest(sides.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    double *const sum = &own[width * s];
    for (const auto &[node, area] : node_areas(d, sides[s])) {
      double length = 0;
      for (int c = 0; c < dim; ++c) {
        const double x = displacement(dim * node + c, 0);
        sum[c] += area * x;
        sum[3 + c] += x;
        length = std::hypot(length, x);
      }
      sum[6] += area;
      sum[7] += 1;
      longest[s] = std::max(longest[s], length);
    }
  }
  const Comm &comm = d.mesh->comm();
  if (!sides.empty()) {
    Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(own.size()), own.data(), sums.data());
    Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, static_cast<int>(longest.size()), longest.data(), largest.data());
  }
  std::vector<SideDisplacement> all;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const double *const sum = &sums[width * s];
    const bool by_area = sum[6] > 0;
    SideDisplacement side{sides[s].name, {}, largest[s]};
    for (int c = 0; c < dim; ++c) side.mean[c] = by_area ? sum[c] / sum[6] : sum[7] > 0 ? sum[3 + c] / sum[7] : 0;
    all.push_back(side);
  }
  return all;
}

} // namespace rpc::analysis

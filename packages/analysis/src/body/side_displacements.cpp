// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/side_displacements.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/values_at.hpp"
#include "rpc/fem/discretization.hpp"
#include "rpc/fem/surface.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::analysis
{

namespace
{

/// Adds to u_x, u_y, u_z and 1 over the area of a side what the facets of the cells have that this rank owns.
/// @param u  (overlap dofs) [m]
void add_over_area(const fem::Discretization &d, const mesh::Side &side, const Vector &u, double *const sum)
{
  const auto x = device_read(u);
  const auto node = side.facets;
  const auto cell = side.cell;
  const auto value = d.reference.facet.value;
  const auto measure = fem::facet_measure(d, side);
  const int dim = d.dim(), nodes = static_cast<int>(node.extent(1)), points = d.reference.facet.num_points();
  const LO num_owned = d.mesh->num_owned_cells;
  double own[4] = {};
  Kokkos::parallel_reduce(
      "rpc::analysis::over_area", device_range(static_cast<LO>(node.extent(0))),
      KOKKOS_LAMBDA(const LO f, double &x0, double &x1, double &x2, double &area) {
        if (cell(f) >= num_owned) return;
        double of_facet[3] = {};
        for (int q = 0; q < points; ++q) {
          area += measure(f * points + q);
          for (int a = 0; a < nodes; ++a)
            for (int c = 0; c < dim; ++c)
              of_facet[c] += measure(f * points + q) * value(q, a) * x(rpc::dof(dim, node(f, a), c));
        }
        x0 += of_facet[0];
        x1 += of_facet[1];
        x2 += of_facet[2];
      },
      own[0], own[1], own[2], own[3]);
  for (int c = 0; c < 4; ++c) sum[c] += own[c];
}

} // namespace

std::vector<SideDisplacement> side_displacements(const fem::Discretization &d, const Vector &u,
                                                 const std::vector<std::string> &sides)
{
  const int dim = d.dim();
  constexpr int width = 8; // of a side: sums over its area, 3 and the area, then over its nodes, 3 and their number
  std::vector<double> own(width * sides.size(), 0), sums(own.size()), longest(sides.size(), 0), largest(sides.size());
  const auto on_overlap = fem::on_overlap(d, u);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    double *const sum = &own[width * s];
    for (const mesh::Side &side : d.mesh->sides)
      if (side.name == sides[s]) add_over_area(d, side, *on_overlap, sum);
    const std::vector<LO> nodes = d.mesh->nodes_of(sides[s], "side_displacement");
    const auto displacement = values_at(u, nodes, dim);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      double length = 0;
      for (int c = 0; c < dim; ++c) {
        const double x = displacement(n, c);
        sum[4 + c] += x;
        length = std::hypot(length, x);
      }
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
    const bool by_area = sum[3] > 0;
    SideDisplacement side{sides[s], {}, largest[s]};
    for (int c = 0; c < dim; ++c) side.mean[c] = by_area ? sum[c] / sum[3] : sum[7] > 0 ? sum[4 + c] / sum[7] : 0;
    all.push_back(side);
  }
  return all;
}

std::vector<std::array<double, 3>> held_displacements(const Problem &problem, const Vector &u)
{
  std::vector<std::string> sides;
  for (const auto &condition : problem.model().dirichlet) sides.push_back(condition.side);
  std::vector<std::array<double, 3>> means;
  for (const auto &side : side_displacements(problem.discretization(), u, sides)) means.push_back(side.mean);
  return means;
}

} // namespace rpc::analysis

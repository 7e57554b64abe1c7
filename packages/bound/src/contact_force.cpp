// SPDX-License-Identifier: BSD-3-Clause
#include "contact_force.hpp"

#include "unit_press.hpp"

#include <cmath>

namespace rpc::bound
{
namespace
{

constexpr const char *no_limit_at_its_end =
    "the side ends where displacements are prescribed along its normal, and no yield stress limits the pressure there";

} // namespace

double largest_force(const ContactFacets &c)
{
  double length = 0;
  for (const double of_facet : c.length) length += of_facet;
  return length * largest_pressure(c);
}

UnitPress unit_press(const analysis::Problem &problem, const double time, const std::vector<ContactFacets> &sides,
                     const int k, const solver::LinearSolverOptions &options)
{
  const mesh::Mesh &mesh = *problem.discretization().mesh;
  const ContactFacets &c = sides[k];
  const analysis::Model model = problem.model().seen_at(time);
  UnitPress press;
  for (const std::array<double, 2> &nu : c.normal)
    if (std::abs(nu[0] - c.normal[0][0]) + std::abs(nu[1] - c.normal[0][1]) > 1e-10)
      press.missing = "the side's normals differ";
  const double near = near_places(mesh);
  const std::vector<Point> cut = cut_places(model, mesh, sides, k);
  const double most = largest_pressure(c);
  if (!cut.empty() && std::isinf(most)) press.missing = no_limit_at_its_end;
  if (!press.missing.empty()) return press;
  // int p (1 - w_nu) over the facets at cut nodes: 1 - w_nu is the element's function of the node there.
  const double positive = c.order == 1 ? 1. / 2 : 5. / 24, negative = c.order == 1 ? 0 : 1. / 24;
  for (std::size_t f = 0; f < c.facet.size(); ++f)
    for (int end = 0; end < 2; ++end)
      for (const Point &place : cut)
        if (is_at(c.ends[f][end], place, near)) {
          press.high += most * c.length[f] * positive;
          press.low -= most * c.length[f] * negative;
        }
  solve_press(problem, time, sides, k, cut, options, press);
  return press;
}

double largest_force(const SpaceContact &c)
{
  double area = 0;
  for (const double of_facet : c.area) area += of_facet;
  return area * largest_pressure(c);
}

UnitPress unit_press(const analysis::Problem &problem, const double time, const std::vector<SpaceContact> &sides,
                     const int k, const solver::LinearSolverOptions &options)
{
  const mesh::Mesh &mesh = *problem.discretization().mesh;
  const SpaceContact &c = sides[k];
  UnitPress press;
  if (!has_facets(c)) press.missing = "the side has no facets";
  if (!press.missing.empty()) return press;
  const double near = near_places(mesh), most = largest_pressure(c);
  const std::vector<Point> cut = cut_places(problem.model().seen_at(time), mesh, sides, k);
  if (!cut.empty() && std::isinf(most)) press.missing = no_limit_at_its_end;
  if (!press.missing.empty()) return press;
  for (std::size_t f = 0; f < c.facet.size(); ++f)
    for (const Point &corner : c.corner[f])
      for (const Point &place : cut)
        if (is_at(corner, place, near)) press.high += most * c.area[f] / 3;
  solve_press(problem, time, sides, k, cut, options, press);
  return press;
}

} // namespace rpc::bound

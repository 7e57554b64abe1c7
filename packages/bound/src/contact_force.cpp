// SPDX-License-Identifier: BSD-3-Clause
#include "contact_force.hpp"

#include "unit_press.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

/// Why no functional of the stress is the force of a side; empty if there is one.
std::string without_press(const ContactFacets &c)
{
  for (const std::array<double, 2> &nu : c.normal)
    if (std::abs(nu[0] - c.normal[0][0]) + std::abs(nu[1] - c.normal[0][1]) > 1e-10) return "the side's normals differ";
  for (const OfFacet &circle : c.circle)
    if (std::min(circle[0], circle[c.order]) == 0 && std::abs(c.normal[0][0]) > 1e-10)
      return "the side meets the axis at an angle";
  return "";
}
std::string without_press(const SpaceContact &c)
{
  return has_facets(c) ? "" : "the side has no facets";
}

/// The length of a facet, of revolution the area on its middle circle; the area in space.
double size_of(const ContactFacets &c, const std::size_t f)
{
  return c.length[f] * (c.circle.empty() ? 1 : (c.circle[f][0] + c.circle[f][c.order]) / 2);
}
double size_of(const SpaceContact &c, const std::size_t f)
{
  return c.area[f];
}

/// No less than the size that a part of a facet counts with: of revolution on its larger circle.
double most_size_of(const ContactFacets &c, const std::size_t f)
{
  return c.length[f] * (c.circle.empty() ? 1 : std::max(c.circle[f][0], c.circle[f][c.order]));
}
double most_size_of(const SpaceContact &c, const std::size_t f)
{
  return c.area[f];
}

/// Parts of a facet's size that are no less than the integrals of the positive and of the negative part of 1 - w_nu, the sum of the element's
/// functions of its nodes where w is 0.
struct Missed {
  double positive = 0, negative = 0;
};
template <class IsCut>
Missed missed(const ContactFacets &c, const std::size_t f, const IsCut &is_cut)
{
  const int ends = is_cut(c.ends[f][0]) + is_cut(c.ends[f][1]);
  return {ends * (c.order == 1 ? 1. / 2 : 5. / 24), ends * (c.order == 1 ? 0 : 1. / 24)};
}
template <class IsCut>
Missed missed(const SpaceContact &c, const std::size_t f, const IsCut &is_cut)
{
  const auto &corner = c.corner[f];
  const int nodes = nodes_of_triangle(c.order);
  OfTriangle cut{};
  for (int v = 0; v < 3; ++v) cut[v] = is_cut(corner[v]);
  for (int m = 3; m < nodes; ++m) {
    const Point &a = corner[m == 4 ? 1 : 0], &b = corner[m == 3 ? 1 : 2];
    cut[m] = is_cut({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
  }
  Missed of;
  for (const double b : bernstein_of(c.order, cut)) {
    of.positive += std::max(0., b) / nodes;
    of.negative += std::max(0., -b) / nodes;
  }
  return of;
}

} // namespace

template <class Side>
UnitPress unit_press(const analysis::Problem &problem, const double time, const std::vector<Side> &sides, const int k,
                     const solver::LinearSolverOptions &options)
{
  const mesh::Mesh &mesh = *problem.discretization().mesh;
  const Side &c = sides[k];
  UnitPress press;
  press.missing = without_press(c);
  if (!press.missing.empty()) return press;
  const double near = near_places(mesh), most = largest_pressure(c);
  const std::vector<Point> cut = cut_places(problem.model().seen_at(time), mesh, sides, k);
  if (!cut.empty() && std::isinf(most)) {
    press.missing = "the side ends where displacements are prescribed along its normal, and no yield stress limits the "
                    "pressure there";
    return press;
  }
  const auto is_cut = [&](const Point &x) {
    return std::any_of(cut.begin(), cut.end(), [&](const Point &place) { return is_at(x, place, near); });
  };
  for (std::size_t f = 0; f < c.facet.size() && !cut.empty(); ++f) {
    const Missed of = missed(c, f, is_cut);
    press.high += most * most_size_of(c, f) * of.positive;
    press.low -= most * most_size_of(c, f) * of.negative;
  }
  solve_press(problem, time, sides, k, cut, options, press);
  return press;
}

template <class Side>
double largest_force(const Side &c)
{
  double size = 0;
  for (std::size_t f = 0; f < c.facet.size(); ++f) size += size_of(c, f);
  return size * largest_pressure(c);
}

template UnitPress unit_press(const analysis::Problem &, double, const std::vector<ContactFacets> &, int,
                              const solver::LinearSolverOptions &);
template UnitPress unit_press(const analysis::Problem &, double, const std::vector<SpaceContact> &, int,
                              const solver::LinearSolverOptions &);
template double largest_force(const ContactFacets &);
template double largest_force(const SpaceContact &);

} // namespace rpc::bound

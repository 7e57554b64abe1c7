// SPDX-License-Identifier: BSD-3-Clause
#include "side_press.hpp"

#include "part_of_side.hpp"
#include "pressed_body.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace rpc::bound
{
namespace
{

/// How near places of nodes are the same [m]. Collective.
double near_places(const mesh::Mesh &mesh)
{
  return 1e-9 * mesh::diameter(mesh);
}

/// The most pressure that a side has; infinite where there is no limit.
template <class Side>
double largest_pressure(const Side &c)
{
  return c.rise == 0 && !c.limit_of.empty() ? c.limit_of[0][0] : std::numeric_limits<double>::infinity();
}

/// Why no functional of the stress is the force of a side; empty if there is one.
std::string without_press(const ContactFacets &c)
{
  if (!has_facets(c)) return "the side has no facets";
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

/// The points at the corners of a facet.
std::vector<int> corners_of(const ContactFacets &c, const std::size_t f)
{
  return {c.point[f][0], c.point[f][1]};
}
std::vector<int> corners_of(const SpaceContact &c, const std::size_t f)
{
  return {c.point[f][0], c.point[f][1], c.point[f][2]};
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
Point place_of(const SidePoint &p)
{
  return {p.place[0], p.place[1], 0};
}
Point place_of(const SpacePoint &p)
{
  return {p.place[0], p.place[1], p.place[2]};
}

/// Middle nodes take the mean of the ends.
void fill_middles(const ContactFacets &c, std::vector<double> &of_point)
{
  for (const auto &point : c.point)
    if (c.order == 2) of_point[point[2]] = (of_point[point[0]] + of_point[point[1]]) / 2;
}
void fill_middles(const SpaceContact &c, std::vector<double> &of_point)
{
  for (const auto &point : c.point)
    for (int m = 3; m < nodes_of_triangle(c.order); ++m)
      of_point[point[m]] = (of_point[point[m == 4 ? 1 : 0]] + of_point[point[m == 3 ? 1 : 2]]) / 2;
}

/// Parts of a facet's size that are no less than the integrals of the positive and of the negative part of the element's function with values
/// from 0 to 1 at the points.
struct Integrals {
  double positive = 0, negative = 0;
};
Integrals integrals(const ContactFacets &c, const std::size_t f, const std::vector<double> &of_point)
{
  const double ends = of_point[c.point[f][0]] + of_point[c.point[f][1]];
  const bool is_linear = c.order == 1 || of_point[c.point[f][2]] != 0;
  return {ends * (is_linear ? 1. / 2 : 5. / 24), ends * (is_linear ? 0 : 1. / 24)};
}
Integrals integrals(const SpaceContact &c, const std::size_t f, const std::vector<double> &of_point)
{
  const int nodes = nodes_of_triangle(c.order);
  OfTriangle values{};
  for (int a = 0; a < nodes; ++a) values[a] = of_point[c.point[f][a]];
  Integrals of;
  for (const double b : bernstein_of(c.order, values)) {
    of.positive += std::max(0., b) / nodes;
    of.negative += std::max(0., -b) / nodes;
  }
  return of;
}

/// Places of this side's nodes at which w has to be 0, since other conditions hold them along its normal; on all ranks.
template <class Side>
NearPlaces cut_places(const analysis::Model &model, const mesh::Mesh &mesh, const std::vector<Side> &sides, const int k,
                      const double near)
{
  const auto coords = to_host(mesh.coords);
  const std::string &side = model.contact[k].side;
  const auto own = mesh.nodes_of(side, model.contact[k].path);
  std::set<LO> cut;
  const auto hold = [&](const std::string &other, const std::array<bool, 3> &components) {
    for (int d = 0; d < mesh.dim(); ++d) {
      if (!components[d] || std::abs(normal_of(sides[k])[d]) < 1e-12) continue;
      for (const LO node : mesh.nodes_of(other, "Contact"))
        if (std::binary_search(own.begin(), own.end(), node)) cut.insert(node);
    }
  };
  for (const auto &condition : model.dirichlet) {
    std::array<bool, 3> components{};
    for (int d = 0; d < 3; ++d) components[d] = condition.displacement[d].has_value();
    hold(condition.side, components);
  }
  for (std::size_t j = 0; j < sides.size(); ++j)
    if (static_cast<int>(j) != k && has_facets(sides[j])) hold(model.contact[j].side, held_components(sides[j]));
  std::vector<double> mine;
  for (const LO node : cut)
    for (int d = 0; d < 3; ++d) mine.push_back(d < mesh.dim() ? coords(node, d) : 0);
  const std::vector<double> all = gathered_by_all(mesh.comm(), mine);
  NearPlaces places(near);
  for (std::size_t i = 0; i + 2 < all.size(); i += 3) places.add({all[i], all[i + 1], all[i + 2]}, 0);
  return places;
}

template <class Side>
SidePress press_of(const analysis::Problem &problem, const double time, const std::vector<Side> &sides, const int k,
                   const Box &box, const solver::LinearSolverOptions &options)
{
  const auto &mesh = problem.discretization().mesh;
  const Side &c = sides[k];
  SidePress press;
  press.missing = without_press(c);
  if (!press.missing.empty()) return press;
  const double near = near_places(*mesh), most = largest_pressure(c);
  const analysis::Model model = problem.model().seen_at(time);
  const NearPlaces cut = cut_places(model, *mesh, sides, k, near);
  const std::vector<PartOfFacet> parts = parts_of_facets(c, box, near);
  const bool whole = std::all_of(parts.begin(), parts.end(), [](const PartOfFacet &part) { return part.whole; });
  std::vector<double> above(c.points.size(), whole ? 1. : 0.), below(c.points.size(), 1.), lacks;
  for (const auto &p : c.points) lacks.push_back(cut.has(place_of(p)) ? 1 : 0);
  const std::vector<double> is_cut = lacks;
  if (!whole) fill_middles(c, lacks);
  for (std::size_t f = 0; f < parts.size(); ++f) {
    press.size += parts[f].size;
    press.force += parts[f].force;
    for (const int p : corners_of(c, f)) {
      if (parts[f].partly) above[p] = 1;
      if (!parts[f].whole) below[p] = 0;
    }
    const Integrals of = integrals(c, f, lacks);
    if (!parts[f].partly || of.positive == 0) continue;
    press.missed += most * most_size_of(c, f) * of.positive;
    press.counted_twice += most * most_size_of(c, f) * of.negative;
  }
  press.most = most * press.size;
  press.force = std::clamp(press.force, 0., press.most); // between nodes it may be beyond
  if (press.size == 0) press.missing = "nothing of the side is in its box";
  if (std::isinf(press.missed))
    press.missing =
        "the side ends where displacements are prescribed along its normal, and no yield stress limits the pressure "
        "there";
  if (!press.missing.empty()) return press;
  for (auto *const values : {&below, &above}) {
    for (std::size_t i = 0; i < values->size(); ++i)
      if (is_cut[i] != 0) (*values)[i] = 0;
    if (!whole) fill_middles(c, *values);
  }
  const auto solved = [&](const std::vector<double> &values) {
    NearPlaces along_normal(near);
    for (std::size_t i = 0; i < values.size(); ++i) along_normal.add(place_of(c.points[i]), values[i]);
    const analysis::Problem body(mesh, held_at_contact(model, mesh->dim(), sides, k, along_normal), time);
    const RoughSolution s = rough_solution(body, time, options);
    if (press.missing.empty()) press.missing = s.missing;
    return s.u;
  };
  press.above = solved(above);
  if (below == above)
    press.below = press.above;
  else if (std::any_of(below.begin(), below.end(), [](const double x) { return x > 0; }))
    press.below = solved(below);
  return press;
}

} // namespace

SidePress side_press(const analysis::Problem &problem, const double time, const std::vector<ContactFacets> &sides,
                     const int k, const Box &part, const solver::LinearSolverOptions &options)
{
  return press_of(problem, time, sides, k, part, options);
}

SidePress side_press(const analysis::Problem &problem, const double time, const std::vector<SpaceContact> &sides,
                     const int k, const Box &part, const solver::LinearSolverOptions &options)
{
  return press_of(problem, time, sides, k, part, options);
}

} // namespace rpc::bound

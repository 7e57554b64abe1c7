// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_force.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/core/parallel.hpp"
#include "space_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

/// What the displacements of contact forces in the plane and in space share.                                doc/bounds.md (13.14)
namespace rpc::bound
{

inline bool has_facets(const ContactFacets &c)
{
  return !c.normal.empty();
}
inline bool has_facets(const SpaceContact &c)
{
  return !c.facet.empty();
}
inline Point normal_of(const ContactFacets &c)
{
  return {c.normal[0][0], c.normal[0][1], 0};
}
inline Point normal_of(const SpaceContact &c)
{
  return c.normal;
}

/// The most pressure that a side has; infinite where there is no limit.
template <class Side>
double largest_pressure(const Side &c)
{
  return c.rise == 0 && !c.limit_of.empty() ? c.limit_of[0][0] : std::numeric_limits<double>::infinity();
}

/// Which components of w are given on a contact side: that along the normal, where that is an axis and nothing rubs; else those that the normal has,
/// or all.
template <class Side>
std::array<bool, 3> held_components(const Side &c)
{
  constexpr double nothing = 1e-12;
  const Point nu = normal_of(c);
  std::array<bool, 3> held{};
  for (int d = 0; d < 3; ++d) held[d] = c.friction.acts || std::abs(nu[d]) > nothing;
  return held;
}

/// Places of this side's nodes at which w has to be 0, since other conditions hold them along its normal; on all ranks.
template <class Side>
std::vector<Point> cut_places(const analysis::Model &model, const mesh::Mesh &mesh, const std::vector<Side> &sides,
                              const int k)
{
  const auto coords = to_host(mesh.coords);
  const std::string &side = model.contact[k].side;
  const auto own = mesh.nodes_of(side, model.contact[k].path);
  std::set<LO> cut;
  const auto hold = [&](const std::string &other, const std::array<bool, 3> &components) {
    for (int d = 0; d < mesh.dim(); ++d) {
      if (!components[d] || !has_facets(sides[k]) || std::abs(normal_of(sides[k])[d]) < 1e-12) continue;
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
  std::vector<Point> places;
  for (std::size_t i = 0; i + 2 < all.size(); i += 3) places.push_back({all[i], all[i + 1], all[i + 2]});
  return places;
}

inline bool is_at(const Point &x, const Point &place, const double near)
{
  return std::abs(x[0] - place[0]) + std::abs(x[1] - place[1]) + std::abs(x[2] - place[2]) <= near;
}

/// The body without loads and contact, moved by w on its boundary.
template <class Side>
analysis::Model pressed(const analysis::Model &model, const int dim, const std::vector<Side> &sides, const int k,
                        const std::vector<Point> &cut, const double near)
{
  analysis::Model m = model;
  m.tractions.clear();
  m.body_force = {};
  m.contact.clear();
  for (auto &condition : m.dirichlet)
    for (auto &u : condition.displacement)
      if (u) u = ScalarField(0.);
  for (int j = 0; j < static_cast<int>(sides.size()); ++j) {
    if (!has_facets(sides[j])) continue;
    fem::DirichletCondition condition{model.contact[j].path, model.contact[j].side, {}};
    const std::array<bool, 3> held = held_components(sides[j]);
    for (int d = 0; d < dim; ++d) {
      if (!held[d]) continue;
      const double value = j == k ? normal_of(sides[k])[d] : 0;
      condition.displacement[d] = ScalarField(value);
      if (value == 0 || cut.empty()) continue;
      condition.displacement[d] =
          ScalarField("1 along the normal", std::function<double(const Point &)>([cut, near, value](const Point &x) {
                        const auto here = [&](const Point &place) { return is_at(x, place, near); };
                        return std::any_of(cut.begin(), cut.end(), here) ? 0. : value;
                      }));
    }
    m.dirichlet.push_back(condition);
  }
  return m;
}

/// Solves for w: press.missing says why there is none.
template <class Side>
void solve_press(const analysis::Problem &problem, const double time, const std::vector<Side> &sides, const int k,
                 const std::vector<Point> &cut, const solver::LinearSolverOptions &options, UnitPress &press)
{
  const auto &mesh = problem.discretization().mesh;
  const analysis::Model model = problem.model().seen_at(time);
  const analysis::Problem body(mesh, pressed(model, mesh->dim(), sides, k, cut, near_places(*mesh)), time);
  analysis::SolverState state(body, options);
  analysis::StepOptions rough; // any w gives an interval
  rough.newton.residual_tolerance = rough.uzawa.tolerance = 1e-4;
  rough.looks_between_nodes = false;
  const analysis::StepSolution s = analysis::solve_step(body, body.step(time), state, rough);
  if (s.uzawa.converged)
    press.w = s.u;
  else
    press.missing = "the elastic solve for it failed: " + s.uzawa.reason;
}

} // namespace rpc::bound

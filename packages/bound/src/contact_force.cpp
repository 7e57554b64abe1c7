// SPDX-License-Identifier: BSD-3-Clause
#include "contact_force.hpp"

#include "rpc/analysis/solve_step.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace rpc::bound
{
namespace
{

/// The most pressure that a side has; infinite where there is no limit.
double largest_pressure(const ContactFacets &c)
{
  return c.rise == 0 && !c.limit_of.empty() ? c.limit_of[0][0] : std::numeric_limits<double>::infinity();
}

/// Which components of w are given on a contact side: that along the normal, where that is an axis and nothing rubs; else both.
std::array<bool, 2> held_components(const ContactFacets &c)
{
  constexpr double nothing = 1e-12;
  const std::array<double, 2> &nu = c.normal[0];
  return {c.friction.acts || std::abs(nu[0]) > nothing, c.friction.acts || std::abs(nu[1]) > nothing};
}

/// Places of this side's nodes at which w has to be 0, since other conditions hold them along its normal; on all ranks.
std::vector<Point> cut_places(const analysis::Model &model, const mesh::Mesh &mesh,
                              const std::vector<ContactFacets> &sides, const int k)
{
  const auto coords = to_host(mesh.coords);
  const std::string &side = model.contact[k].side;
  const auto own = mesh.nodes_of(side, model.contact[k].path);
  std::set<LO> cut;
  const auto hold = [&](const std::string &other, const std::array<bool, 2> &components) {
    for (int d = 0; d < 2; ++d) {
      if (!components[d] || sides[k].normal.empty() || std::abs(sides[k].normal[0][d]) < 1e-12) continue;
      for (const LO node : mesh.nodes_of(other, "Contact"))
        if (std::binary_search(own.begin(), own.end(), node)) cut.insert(node);
    }
  };
  for (const auto &condition : model.dirichlet)
    hold(condition.side, {condition.displacement[0].has_value(), condition.displacement[1].has_value()});
  for (std::size_t j = 0; j < sides.size(); ++j)
    if (static_cast<int>(j) != k && !sides[j].normal.empty()) hold(model.contact[j].side, held_components(sides[j]));
  std::vector<double> mine;
  for (const LO node : cut) mine.insert(mine.end(), {coords(node, 0), coords(node, 1)});
  const std::vector<double> all = gathered_by_all(mesh.comm(), mine);
  std::vector<Point> places;
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) places.push_back({all[i], all[i + 1], 0});
  return places;
}

bool is_at(const Point &x, const Point &place, const double near)
{
  return std::abs(x[0] - place[0]) + std::abs(x[1] - place[1]) <= near;
}

/// The body without loads and contact, moved by w on its boundary.
analysis::Model pressed(const analysis::Model &model, const std::vector<ContactFacets> &sides, const int k,
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
    if (sides[j].normal.empty()) continue;
    fem::DirichletCondition condition{model.contact[j].path, model.contact[j].side, {}};
    const std::array<bool, 2> held = held_components(sides[j]);
    for (int d = 0; d < 2; ++d) {
      if (!held[d]) continue;
      const double value = j == k ? sides[k].normal[0][d] : 0;
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
  const double near = 1e-9 * mesh::diameter(mesh);
  const std::vector<Point> cut = cut_places(model, mesh, sides, k);
  const double most = largest_pressure(c);
  if (!cut.empty() && std::isinf(most))
    press.missing = "the side ends where displacements are prescribed along its normal, and no yield stress limits the "
                    "pressure there";
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
  const analysis::Problem body(problem.discretization().mesh, pressed(model, sides, k, cut, near), time);
  analysis::SolverState state(body, options);
  analysis::StepOptions rough; // any w gives an interval
  rough.newton.residual_tolerance = rough.uzawa.tolerance = 1e-4;
  rough.looks_between_nodes = false;
  const analysis::StepSolution s = analysis::solve_step(body, body.step(time), state, rough);
  if (s.uzawa.converged)
    press.w = s.u;
  else
    press.missing = "the elastic solve for it failed: " + s.uzawa.reason;
  return press;
}

} // namespace rpc::bound

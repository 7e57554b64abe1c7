// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"
#include "near_places.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "space_contact.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

/// Elastic problems without contact whose solutions intervals of functionals come from.                   doc/bounds.md (13.14)
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

/// The body as it is held, without loads, contact and motions of what holds it.
inline analysis::Model without_loads(const analysis::Model &model)
{
  analysis::Model m = model;
  m.tractions.clear();
  m.body_force = {};
  m.contact.clear();
  for (auto &condition : m.dirichlet)
    for (auto &u : condition.displacement)
      if (u) u = ScalarField(0.);
  return m;
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

/// The body without loads and contact, held as it is; contact sides move along their normals by what is given for nodes of side k and do not
/// move else. @param k  -1: none of them moves
template <class Side>
analysis::Model held_at_contact(const analysis::Model &model, const int dim, const std::vector<Side> &sides,
                                const int k, const NearPlaces &along_normal)
{
  analysis::Model m = without_loads(model);
  for (int j = 0; j < static_cast<int>(sides.size()); ++j) {
    if (!has_facets(sides[j])) continue;
    fem::DirichletCondition condition{model.contact[j].path, model.contact[j].side, {}};
    const std::array<bool, 3> held = held_components(sides[j]);
    for (int d = 0; d < dim; ++d) {
      if (!held[d]) continue;
      const double normal = normal_of(sides[j])[d];
      condition.displacement[d] = ScalarField(0.);
      if (j == k && normal != 0)
        condition.displacement[d] = ScalarField(
            "along the normal", std::function<double(const Point &)>([along_normal, normal](const Point &x) {
              return normal * along_normal.value_at(x);
            }));
    }
    m.dirichlet.push_back(condition);
  }
  return m;
}

/// An elastic problem without contact, solved roughly: any displacement gives an interval.
struct RoughSolution {
  RCP<const Vector> u;
  std::string missing; ///< why there is none; else empty
};
inline RoughSolution rough_solution(const analysis::Problem &body, const double time,
                                    const solver::LinearSolverOptions &options)
{
  analysis::SolverState state(body, options);
  analysis::StepOptions rough;
  rough.newton.residual_tolerance = rough.uzawa.tolerance = 1e-4;
  rough.looks_between_nodes = false;
  const analysis::StepSolution s = analysis::solve_step(body, body.step(time), state, rough);
  return s.uzawa.converged ? RoughSolution{s.u, ""}
                           : RoughSolution{{}, "the elastic solve for it failed: " + s.uzawa.reason};
}

} // namespace rpc::bound

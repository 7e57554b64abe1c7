// SPDX-License-Identifier: BSD-3-Clause
#include "guide.hpp"

#include "rpc/core/error.hpp"

#include <cmath>
#include <limits>

namespace rpc::adapt
{

ErrorEstimate guide(const Solution &s)
{
  ErrorEstimate estimate = *s.estimate;
  if (!s.bound || !s.bound->missing.empty()) return estimate;
  estimate.squared = s.bound->squared;
  estimate.parts = {{"guaranteed", s.bound->energy_norm * s.bound->energy_norm}, {ErrorEstimate::unseen_contact, 0.}};
  estimate.hidden = 0;
  return estimate;
}

double relative_error(const Task &task, const Solution &s)
{
  if (task.adapt.bound != ErrorBound::guaranteed || only_rounding(s)) return relative_estimate(s);
  if (!s.bound || !s.bound->missing.empty()) return std::numeric_limits<double>::infinity();
  return relative_bound(*s.bound, s.energy_norm_squared);
}

void require_coverable_meshes(const Task &task, const mesh::Element &first)
{
  RPC_REQUIRE(!task.adapt.adapts() || nests(task.mesh, task.adapt) || first.shape == mesh::Shape::simplex,
              "deck: \"Adapt->Error Bound\" = guaranteed covers parallelograms, and the quadrilaterals that gmsh "
              "makes for the next mesh are none. Let it make triangles (no \"Recombine\" in the .geo), or leave out "
              "\"Adapt->Target Relative Error\"");
}

} // namespace rpc::adapt

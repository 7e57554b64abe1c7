// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/cycle.hpp"

/// Meshes of a run, of which error bars are observed.
namespace rpc::test
{

inline adapt::Cycle mesh(const double estimate, const double force, const double pressure)
{
  adapt::Cycle c;
  c.estimate = estimate;
  c.energy = 1;
  c.energy_norm_squared = 2;
  c.contact.force = {0, force, 0};
  c.contact.max_pressure = pressure;
  c.contact.contact_length = 1;
  return c;
}

/// A mesh on which nothing touches. @param left  the smallest gap
inline adapt::Cycle open_mesh(const double estimate, const double left)
{
  adapt::Cycle c = mesh(estimate, 0, 0);
  c.contact.contact_length = 0;
  c.reactions = {{0, 10, 0}};
  c.smallest_gap = left;
  c.max_displacement = 1;
  return c;
}

} // namespace rpc::test

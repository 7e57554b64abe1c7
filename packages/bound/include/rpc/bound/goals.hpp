// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/interval.hpp"
#include "rpc/core/units.hpp"

#include <Teuchos_ParameterList.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace rpc::bound
{

/// A number that a deck asks for, to be told with an interval that holds the exact one.                  doc/bounds.md (13.14) - (13.18)
struct Goal {
  enum class Type {
    mean_displacement, ///< of a side along an axis [m]
    mean_pressure,     ///< of the part of a contact side in a box [Pa]
    contact_force      ///< the integral of this pressure [N], in 2D per m
  } type = Type::mean_displacement;
  std::string name, side;
  int component = 0;       ///< the axis of a mean displacement
  std::optional<Box> part; ///< of pressures: what of the side is in it [m]; none: all

  std::string path() const { return "Goals->" + name; } ///< in decks
};

/// As decks name it.
const char *name_of(Goal::Type type);
Unit unit_of(Goal::Type type);

/// A goal on one mesh.
struct GoalBound {
  Goal goal;
  double value = std::numeric_limits<double>::quiet_NaN();           ///< of the discrete solution
  double estimated_error = std::numeric_limits<double>::quiet_NaN(); ///< of the exact one less this: an estimate
  double lower = 0, upper = 0;                                       ///< of the exact solution
  std::string missing; ///< why there is no interval; empty if there is one
};

/// Parameters of the deck's `Goals` sublist.
Teuchos::ParameterList valid_goal_parameters();
/// @throws rpc::Error (bad_input) on anything that is missing or out of range
std::vector<Goal> goal_options(const Teuchos::ParameterList &list, int dim);

} // namespace rpc::bound

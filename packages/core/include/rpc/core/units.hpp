// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc
{

/// Unit of a number in the results, in powers of force and length.
struct Unit {
  int force = 0, length = 0;
  bool of_body = false;   ///< of a plane body it is per length of its depth
  const char *fixed = ""; ///< name where it is no matter of force and length
};

namespace unit
{
inline constexpr Unit none{};
inline constexpr Unit second{0, 0, false, "s"};
inline constexpr Unit pressure{1, -2};
inline constexpr Unit length{0, 1};
inline constexpr Unit extent{0, 2, true}; ///< of a part of the surface
inline constexpr Unit volume{0, 3, true}; ///< of a part of the surface times a length
inline constexpr Unit force{1, 0, true};
inline constexpr Unit energy{1, 1, true};
} // namespace unit

/// Names of the units that a deck's numbers have: those of length and force are chosen, all others follow. They are printed;
/// no number depends on them.
struct UnitNames {
  std::string length = "m", force = "N";

  bool is_default() const { return length == "m" && force == "N"; }
  std::string stress() const; ///< Pa of m and N, MPa of mm and N, GPa of mm and kN; "lbf/in^2" of lbf and in
  std::string energy() const; ///< J of m and N, mJ of mm and N, J of mm and kN; "lbf in" of lbf and in
  std::string moment() const; ///< "N m"
  /// @param per_length  whether the body is plane
  std::string of(const Unit &unit, bool per_length) const;
  /// What follows the name of a column: " [MPa]"; nothing where the units are m and N, and for numbers that do not depend on them.
  std::string heading(const Unit &unit, bool per_length) const;
};

/// Parameters of the deck's `Units` sublist.
Teuchos::ParameterList valid_units_parameters();
/// @throws rpc::Error (bad_input) on a name that would break a table or a file
UnitNames units_options(const Teuchos::ParameterList &list);

} // namespace rpc

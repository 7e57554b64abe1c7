// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/units.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/pascals.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace rpc
{
namespace
{

constexpr std::size_t longest_unit = 12; // bytes

// Prefixes of derived units by their power of ten.
const std::map<int, std::string> prefixes = {{-12, "p"}, {-9, "n"}, {-6, "u"}, {-3, "m"}, {0, ""},
                                             {3, "k"},   {6, "M"},  {9, "G"},  {12, "T"}};

/// The power of ten of a unit with a prefix: -3 of "mm" for "m". None of a unit that is another one.
std::optional<int> power_of_ten(const std::string &name, const std::string &base)
{
  if (name.size() < base.size() || name.compare(name.size() - base.size(), base.size(), base) != 0) return std::nullopt;
  const std::string prefix = name.substr(0, name.size() - base.size());
  if (prefix == "c") return -2;
  if (prefix == "d") return -1;
  if (prefix == "\u00b5" || prefix == "\u03bc") return -6; // the sign for micro, and the Greek letter
  for (const auto &[power, known] : prefixes)
    if (prefix == known) return power;
  return std::nullopt;
}

/// The name of force * length^exponent as a multiple of an SI unit, if there is one with a usual prefix.
std::optional<std::string> si_name(const UnitNames &units, const int exponent, const std::string &base)
{
  const auto force = power_of_ten(units.force, "N"), length = power_of_ten(units.length, "m");
  if (!force || !length) return std::nullopt;
  const auto prefix = prefixes.find(*force + exponent * *length);
  if (prefix == prefixes.end()) return std::nullopt;
  return prefix->second + base;
}

std::string power(const std::string &name, const int exponent)
{
  return exponent == 1 ? name : name + "^" + std::to_string(exponent);
}

std::string checked_unit(const Teuchos::ParameterList &list, const std::string &parameter)
{
  const auto &name = list.get<std::string>(parameter);
  const bool plain = std::all_of(name.begin(), name.end(), [](const unsigned char c) {
    return c > ' ' && c != 127 && std::string(",;\"'[]()\\").find(static_cast<char>(c)) == std::string::npos;
  });
  RPC_REQUIRE(!name.empty() && name.size() <= longest_unit && plain,
              "deck: \"Units->" << parameter << "\" must be a name of 1 to " << longest_unit
                                << " characters without blanks, commas, semicolons, quotes, backslashes and brackets, "
                                   "got \""
                                << name << "\"; give one such as " << (parameter == "Length" ? "mm" : "kN"));
  return name;
}

} // namespace

std::string UnitNames::stress() const
{
  return si_name(*this, -2, "Pa").value_or(force + "/" + power(length, 2));
}

std::optional<double> pascals(const UnitNames &units)
{
  const auto of_force = power_of_ten(units.force, "N"), of_length = power_of_ten(units.length, "m");
  if (!of_force || !of_length) return std::nullopt;
  return std::pow(10., *of_force - 2 * *of_length);
}

std::string UnitNames::energy() const
{
  return si_name(*this, 1, "J").value_or(moment());
}

std::string UnitNames::moment() const
{
  return force + " " + length;
}

std::string UnitNames::of(const Unit &unit, const bool per_length) const
{
  if (unit.force == 0 && unit.length == 0) return unit.fixed;
  const bool shared = unit.of_body && per_length;
  if (unit.force == 0) return power(length, unit.length - (shared ? 1 : 0));
  const std::string whole = unit.length == 0 ? force : unit.length > 0 ? energy() : stress();
  return shared ? whole + "/" + length : whole;
}

std::string UnitNames::heading(const Unit &unit, const bool per_length) const
{
  const std::string name = of(unit, per_length);
  return is_default() || name.empty() || name == unit.fixed ? "" : " [" + name + "]";
}

Teuchos::ParameterList valid_units_parameters()
{
  Teuchos::ParameterList valid("Units");
  valid.set("Length", "m", "Unit in which the deck's lengths are, such as `mm`. Results are printed with it.");
  valid.set(
      "Force", "N",
      "Unit in which the deck's forces are, such as `kN`. Stresses are in force per length^2: with mm and N in MPa.");
  return valid;
}

UnitNames units_options(const Teuchos::ParameterList &list)
{
  return {checked_unit(list, "Length"), checked_unit(list, "Force")};
}

} // namespace rpc

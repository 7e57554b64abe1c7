// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/units.hpp"

#include "expect_error.hpp"
#include "rpc/core/pascals.hpp"

#include <gtest/gtest.h>

namespace units_test
{
namespace
{

using namespace rpc;
using rpc::test::expect_error;

UnitNames given(const std::string &length, const std::string &force)
{
  Teuchos::ParameterList list = valid_units_parameters();
  list.set("Length", length);
  list.set("Force", force);
  return units_options(list);
}

TEST(UnitNames, StressAndEnergyFollowFromLengthAndForce)
{
  struct Case {
    const char *length, *force, *stress, *energy;
  };
  for (const Case &c : {Case{"m", "N", "Pa", "J"}, Case{"mm", "N", "MPa", "mJ"}, Case{"mm", "kN", "GPa", "J"},
                        Case{"m", "kN", "kPa", "kJ"}, Case{"m", "MN", "MPa", "MJ"}, Case{"um", "uN", "MPa", "pJ"},
                        Case{"\u00b5m", "mN", "GPa", "nJ"}, Case{"cm", "N", "N/cm^2", "N cm"},
                        Case{"in", "lbf", "lbf/in^2", "lbf in"}, Case{"m", "kgf", "kgf/m^2", "kgf m"}}) {
    const UnitNames units = given(c.length, c.force);
    EXPECT_EQ(units.stress(), c.stress);
    EXPECT_EQ(units.energy(), c.energy);
  }
}

TEST(UnitNames, OfMetresAndNewtonsAreSoManyPascals)
{
  EXPECT_EQ(pascals({}), 1);
  EXPECT_NEAR(pascals(given("mm", "N")).value(), 1e6, 1e-9);
  EXPECT_NEAR(pascals(given("cm", "kN")).value(), 1e7, 1e-8);
  EXPECT_FALSE(pascals(given("in", "lbf")));
  EXPECT_FALSE(pascals(given("in", "N")));
}

TEST(UnitNames, NumbersOfAPlaneBodyArePerLength)
{
  const UnitNames units = given("mm", "N");
  EXPECT_EQ(units.of(unit::force, false), "N");
  EXPECT_EQ(units.of(unit::force, true), "N/mm");
  EXPECT_EQ(units.of(unit::energy, false), "mJ");
  EXPECT_EQ(units.of(unit::energy, true), "mJ/mm");
  EXPECT_EQ(units.of(unit::extent, false), "mm^2");
  EXPECT_EQ(units.of(unit::extent, true), "mm");
  EXPECT_EQ(units.of(unit::volume, false), "mm^3");
  EXPECT_EQ(units.of(unit::volume, true), "mm^2");
  for (const bool per_length : {false, true}) {
    EXPECT_EQ(units.of(unit::length, per_length), "mm");
    EXPECT_EQ(units.of(unit::pressure, per_length), "MPa");
    EXPECT_EQ(units.of(unit::second, per_length), "s");
    EXPECT_EQ(units.of(unit::none, per_length), "");
  }
  EXPECT_EQ(units.moment(), "N mm");
}

TEST(UnitNames, StandInHeadingsUnlessTheyAreMetreAndNewton)
{
  EXPECT_EQ(UnitNames().heading(unit::pressure, false), "");
  EXPECT_EQ(given("m", "N").heading(unit::pressure, false), "");
  EXPECT_EQ(given("m", "kN").heading(unit::pressure, false), " [kPa]");
  EXPECT_EQ(given("m", "kN").heading(unit::length, false), " [m]");
  EXPECT_EQ(given("mm", "N").heading(unit::second, false), "");
  EXPECT_EQ(given("mm", "N").heading(unit::none, false), "");
}

TEST(UnitsOptions, ANameThatWouldBreakATableIsRefused)
{
  for (const char *const name : {"", "m m", "m,", "m\"", "m'", "m\n", "[m]", "thirteen_char"}) {
    expect_error(ExitCode::bad_input,
                 {"\"Units->Length\" must be a name of 1 to 12 characters", "got \"" + std::string(name) + "\"", "mm"},
                 [&] { given(name, "N"); });
    expect_error(ExitCode::bad_input, {"\"Units->Force\"", "such as kN"}, [&] { given("m", name); });
  }
}

} // namespace
} // namespace units_test

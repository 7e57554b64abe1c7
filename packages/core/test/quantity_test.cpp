// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/quantity.hpp"

#include <array>
#include <gtest/gtest.h>

namespace quantity_test
{
namespace
{

using namespace rpc;

struct Record {
  double work = 1, peak = 2, patch = 3, slip = 4;
};

constexpr std::array<Quantity<Record>, 4> table{{
    {&Record::work, "work", unit::energy, Combine::sum, {true, 2}},
    {&Record::peak, "peak", unit::pressure, Combine::maximum, {true, 1}},
    {&Record::patch, "patch_length", unit::extent, Combine::sum, {true}, "patch_area"},
    {&Record::slip, "slip", unit::length, Combine::maximum, {true, 3}, nullptr, Needs::friction},
}};

template <class Numbers>
std::vector<std::string> names(const Numbers &numbers, const ResultScope &scope)
{
  std::vector<std::string> all;
  for (const auto &q : numbers) all.push_back(q.name(scope));
  return all;
}

TEST(Quantity, SumsAndMaximaAreCombinedByTheTable)
{
  Record a, b{10, -5, 30, 40};
  add_numbers(table, a, b);
  EXPECT_EQ(a.work, 11);
  EXPECT_EQ(a.peak, 2);
  EXPECT_EQ(a.patch, 33);
  EXPECT_EQ(a.slip, 40);
}

TEST(Quantity, NamesAndUnitsFollowTheBody)
{
  const ResultScope plane{true, false, {}}, space{false, false, {}};
  EXPECT_EQ(table[2].name(plane), "patch_length");
  EXPECT_EQ(table[2].name(space), "patch_area");
  EXPECT_EQ(table[1].name(space), "peak");
  EXPECT_EQ(table[2].unit_name(plane), "m");
  EXPECT_EQ(table[2].unit_name(space), "m^2");
  EXPECT_EQ(table[0].unit_name(plane), "J/m");
  const ResultScope in_mm{true, false, {"mm", "N"}};
  EXPECT_EQ(table[0].unit_name(in_mm), "mJ/mm");
  EXPECT_EQ(table[1].unit_name(in_mm), "MPa");
  EXPECT_EQ(table[0].name(in_mm), "work");
}

TEST(Quantity, NumbersOfFrictionAreThereOnlyWithFriction)
{
  const ResultScope without{true, false, {}}, with{true, true, {}};
  EXPECT_EQ(names(defined_numbers(table, without), without),
            (std::vector<std::string>{"work", "peak", "patch_length"}));
  EXPECT_EQ(names(defined_numbers(table, with), with),
            (std::vector<std::string>{"work", "peak", "patch_length", "slip"}));
}

TEST(Quantity, ColumnsComeInTheirPlaces)
{
  const ResultScope without{true, false, {}}, with{true, true, {}};
  EXPECT_EQ(names(history_columns(table, without), without), (std::vector<std::string>{"peak", "work"}));
  EXPECT_EQ(names(history_columns(table, with), with), (std::vector<std::string>{"peak", "work", "slip"}));
}

} // namespace
} // namespace quantity_test

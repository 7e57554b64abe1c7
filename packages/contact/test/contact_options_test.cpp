// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "rpc/contact/contact_nodes.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <limits>

namespace contact_options_test
{
namespace
{

using namespace rpc;
using contact::ContactOptions;
using contact::Normal;
using rpc::test::expect_error;
using Teuchos::ParameterList;

/// Reads constants only, as a deck without expressions.
ScalarField parse_constant(const std::string &text, const std::string &)
{
  ScalarField constant(std::stod(text));
  constant.text = text;
  return constant;
}

std::vector<ContactOptions> read(ParameterList list, const int dim = 2)
{
  validate(list, contact::valid_contact_parameters(), "Contact");
  return contact::contact_options(list, dim, parse_constant);
}

void expect_refused(const ParameterList &list, const std::initializer_list<std::string> parts, const int dim = 2)
{
  expect_error(ExitCode::bad_input, parts, [&] { read(list, dim); });
}

/// A deck of one side.
ParameterList bottom()
{
  ParameterList list;
  list.set("Side", "bottom");
  return list;
}
ParameterList bottom_with_normal(const std::string &text)
{
  ParameterList list = bottom();
  list.set("Normal", text);
  return list;
}

/// A horizontal floor.
void add_floor(ParameterList &list)
{
  ParameterList &obstacle = list.sublist("Obstacle");
  obstacle.set("Type", "plane");
  obstacle.set("Point", Teuchos::Array<double>(Teuchos::tuple(0., -1.)));
  obstacle.set("Normal", Teuchos::Array<double>(Teuchos::tuple(0., 2.)));
}

/// Two floors below the bottom, under these names.
ParameterList two_floors(const std::string &one, const std::string &other)
{
  ParameterList list;
  for (const std::string &name : {one, other}) {
    ParameterList &entry = list.sublist("Sides").sublist(name);
    entry.set("Side", "bottom");
    add_floor(entry);
  }
  return list;
}

TEST(ContactOptions, SeveralFoundationsOfOneSideAreNamedAfterTheirEntries)
{
  ParameterList list = two_floors("left flank", "right flank");
  list.sublist("Sides").sublist("top");
  const auto options = read(list);
  ASSERT_EQ(options.size(), 3u);
  const std::string names[] = {"left flank", "right flank", "top"}, sides[] = {"bottom", "bottom", "top"};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(options[k].name_in_results(), names[k]);
    EXPECT_EQ(options[k].side, sides[k]);
  }
}

TEST(ContactOptions, OneNameInTheResultsForTwoIsRefused)
{
  ParameterList unnamed = two_floors("one", "other");
  unnamed.sublist("Sides").sublist("third").set("Side", "one");
  expect_refused(unnamed, {"\"one\"", "in the results", "another name"});
}

TEST(ContactOptions, NothingTouchesWithoutASide)
{
  EXPECT_TRUE(read(ParameterList()).empty());
}

TEST(ContactOptions, DefaultsAreARigidFoundationWithoutGapAlongTheSurfaceNormal)
{
  const auto options = read(bottom());
  ASSERT_EQ(options.size(), 1u);
  EXPECT_EQ(options[0].path, "Contact");
  EXPECT_EQ(options[0].side, "bottom");
  EXPECT_EQ(options[0].yield_stress.constant, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(options[0].gap.is_zero());
  EXPECT_TRUE(options[0].hardening.is_zero());
  EXPECT_EQ(options[0].stiffness.constant, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(options[0].remembers); // auto
  EXPECT_EQ(options[0].penalty, 0);  // auto
  EXPECT_EQ(options[0].normal, Normal::surface);
  EXPECT_FALSE(options[0].obstacle.exists());
}

TEST(ContactOptions, NormalIsThatOfTheFoundationByDefaultWhereThereIsAnObstacle)
{
  auto list = bottom();
  add_floor(list);
  const auto options = read(list);
  EXPECT_EQ(options[0].normal, Normal::foundation);
  ASSERT_TRUE(options[0].obstacle.exists());
  EXPECT_EQ(*contact::direction_into(options[0].obstacle, {}), (Point{0, -1, 0}));
  EXPECT_EQ(read(list.set("Normal", "surface"))[0].normal, Normal::surface);
  EXPECT_EQ(read(list.set("Normal", "foundation"))[0].normal, Normal::foundation);
  EXPECT_EQ(read(list.set("Normal", "0, -1"))[0].normal, Normal::fixed);
}

TEST(ContactOptions, FixedNormalIsReadFromNumbersOfAnyLength)
{
  const auto direction = [](const std::string &text, const int dim = 2) {
    const auto options = read(bottom_with_normal(text), dim);
    EXPECT_EQ(options[0].normal, Normal::fixed) << text;
    return options[0].direction;
  };
  EXPECT_EQ(direction("0, -1"), (Point{0, -1, 0}));
  EXPECT_EQ(direction(" 0,-2.5 "), (Point{0, -1, 0}));
  EXPECT_EQ(direction("0, 0, -2", 3), (Point{0, 0, -1}));
  const Point slanted = direction("3e-7, -4e-7");
  EXPECT_NEAR(slanted[0], 0.6, 1e-15);
  EXPECT_NEAR(slanted[1], -0.8, 1e-15);
}

TEST(ContactOptions, NormalsThatAreNoDirectionAreRefusedWithAnExample)
{
  for (const std::string text : {"0", "0,", "0, 0", "0; -1", "0 -1", "0, -1, 0", "0, -1,", "0, -1 x", "down", ", 1",
                                 "nan, 1", "inf, 1", "1e400, 0", "Surface"})
    expect_refused(bottom_with_normal(text), {"\"Contact->Normal\"", "2 numbers", "\"0, -1\"", "got \"" + text + "\""});
  expect_refused(bottom_with_normal("0, -1"), {"\"Contact->Normal\"", "3 numbers", "\"0, 0, -1\""}, 3);
}

TEST(ContactOptions, NormalOfTheFoundationNeedsAnObstacle)
{
  expect_refused(bottom_with_normal("foundation"), {"\"Contact->Normal\"", "needs an \"Contact->Obstacle\""});
}

TEST(ContactOptions, GapDoesNotGoWithAnObstacleEvenAtItsDefault)
{
  auto list = bottom();
  add_floor(list);
  list.set("Gap", 0);
  expect_refused(list, {"\"Contact->Gap\"", "does not go with \"Contact->Obstacle\""});
}

TEST(ContactOptions, FurtherSidesAreNamedAfterTheirEntriesUnlessGiven)
{
  auto list = bottom();
  list.sublist("Sides").sublist("left").set("Yield Stress", 3);
  list.sublist("Sides").sublist("wall").set("Side", "right").set("Gap", 0.25).set("Penalty", 40.);
  add_floor(list.sublist("Sides").sublist("ceiling").set("Side", "top"));
  const auto options = read(list);
  ASSERT_EQ(options.size(), 4u);
  const std::vector<std::string> paths = {"Contact", "Contact->Sides->left", "Contact->Sides->wall",
                                          "Contact->Sides->ceiling"},
                                 sides = {"bottom", "left", "right", "top"};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(options[k].path, paths[k]);
    EXPECT_EQ(options[k].side, sides[k]);
  }
  EXPECT_EQ(options[1].yield_stress.constant, 3);
  EXPECT_EQ(options[1].penalty, 0);
  EXPECT_EQ(options[2].gap.constant, 0.25);
  EXPECT_EQ(options[2].penalty, 40);
  EXPECT_EQ(options[3].normal, Normal::foundation);
  EXPECT_EQ(options[0].normal, Normal::surface);
}

TEST(ContactOptions, SidesStandWithoutAFirstOne)
{
  ParameterList list;
  list.sublist("Sides").sublist("left");
  const auto options = read(list);
  ASSERT_EQ(options.size(), 1u);
  EXPECT_EQ(options[0].side, "left");
}

TEST(ContactOptions, OneSideTwiceIsRefusedWithBothEntries)
{
  auto list = bottom();
  list.sublist("Sides").sublist("floor").set("Side", "bottom");
  expect_refused(list, {"\"Contact\" and \"Contact->Sides->floor\"", "the side \"bottom\""});
  ParameterList entries;
  entries.sublist("Sides").sublist("left");
  entries.sublist("Sides").sublist("wall").set("Side", "left");
  expect_refused(entries, {"\"Contact->Sides->left\" and \"Contact->Sides->wall\"", "the side \"left\""});
}

TEST(ContactOptions, ValuesOutOfRangeAreRefusedByPathOnASideOrNone)
{
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const std::string &name, const double value) {
    ParameterList list, entry;
    list.set(name, value);
    entry.sublist("Sides").sublist("wall").set(name, value);
    expect_refused(list, {"\"Contact->" + name + "\"", "> 0"});
    expect_refused(entry, {"\"Contact->Sides->wall->" + name + "\"", "> 0"});
  };
  for (const double value : {0., -1., nan}) refused("Yield Stress", value);
  for (const double value : {0., -1., nan, inf}) refused("Penalty", value);
  for (const double value : {0., -1., nan, -inf}) refused("Stiffness", value);
  ParameterList obstacle;
  obstacle.sublist("Sides").sublist("wall").sublist("Obstacle").set("Type", "pyramid");
  expect_refused(obstacle, {"\"Contact->Sides->wall->Obstacle->Type\"", "\"pyramid\""});
}

TEST(ContactOptions, SayWhatDentsMoveWith)
{
  ParameterList list = bottom();
  EXPECT_EQ(read(list)[0].dents_move_with, contact::DentsMoveWith::body);
  list.set("Dents Move With", "foundation");
  EXPECT_EQ(read(list)[0].dents_move_with, contact::DentsMoveWith::foundation);
  list.set("Remembers", "false");
  expect_refused(list, {"Contact->Dents Move With", "foundation", "Contact->Remembers", "false"});
  list = bottom();
  list.set("Dents Move With", "obstacle");
  expect_refused(list, {"Contact->Dents Move With", "body, foundation", "obstacle"});
}

TEST(ContactOptions, HardeningIsFiniteAndNotNegative)
{
  EXPECT_EQ(read(bottom().set("Hardening", 0))[0].hardening.constant, 0);
  EXPECT_EQ(read(bottom().set("Hardening", 2.5))[0].hardening.constant, 2.5);
  for (const std::string text : {"-1", "-1e-300", "nan", "inf", "-inf"})
    expect_refused(bottom().set("Hardening", text), {"\"Contact->Hardening\"", ">= 0 [Pa/m]", "finite", "got " + text});
}

TEST(ContactOptions, StiffnessMayBeInfinite)
{
  EXPECT_EQ(read(bottom().set("Stiffness", 1e9))[0].stiffness.constant, 1e9);
  EXPECT_EQ(read(bottom().set("Stiffness", "inf"))[0].stiffness.constant, std::numeric_limits<double>::infinity());
}

TEST(ContactOptions, AFoundationRemembersUnlessToldNotTo)
{
  EXPECT_TRUE(read(bottom().set("Remembers", "auto"))[0].remembers);
  EXPECT_TRUE(read(bottom().set("Remembers", "true"))[0].remembers);
  EXPECT_FALSE(read(bottom().set("Remembers", "false"))[0].remembers);
  for (const std::string text : {"True", "no", ""})
    expect_refused(bottom().set("Remembers", text),
                   {"\"Contact->Remembers\"", "auto, true, false", "got \"" + text + "\""});
  ParameterList entry;
  entry.sublist("Sides").sublist("wall").set("Remembers", "never");
  expect_refused(entry, {"\"Contact->Sides->wall->Remembers\"", "\"never\""});
}

} // namespace
} // namespace contact_options_test

// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parameters.hpp"

#include "expect_error.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace parameters_test
{
namespace
{

using rpc::assign;
using rpc::ExitCode;
using rpc::field_text;
using rpc::test::error_of;
using rpc::test::expect_error;
using Teuchos::Array;
using Teuchos::ParameterList;
using Teuchos::tuple;

/// One parameter of each kind.
ParameterList valid_deck()
{
  ParameterList valid("deck"), entry;
  ParameterList &mesh = valid.sublist("Mesh", false, "The mesh.");
  mesh.set("Type", "box", "Kind of mesh.");
  mesh.set("Lower", Array<double>(tuple(0., 0.)), "Lower corner [m].");
  mesh.set("Cells", Array<int>(tuple(8, 8)), "Number of cells.");
  mesh.set("Blocks", Array<std::string>(tuple<std::string>("a")), "Names of blocks.");
  ParameterList &contact = valid.sublist("Contact", false, "The contact.");
  contact.set("Penalty", 1e8, "r > 0 [Pa/m].");
  contact.set("Steps", 3, "Number of steps.");
  contact.set("Verbose", false, "Whether to talk.");
  rpc::set_field(contact, "Gap", "0", "Gap [m].");
  rpc::set_fields(contact, "Centre", "Where it is [m].");
  rpc::set_pass_through(valid, "NOX", "Handed on to NOX.");
  entry.set("Side", "", "Side of the mesh.");
  rpc::set_field(entry, "X", "", "Displacement [m].");
  rpc::set_named_entries(valid, "Dirichlet", entry, "Prescribed displacements.");
  return valid;
}

ParameterList assigned(const std::string &assignment)
{
  ParameterList list;
  assign(list, valid_deck(), assignment);
  return list;
}

void expect_refused(const std::string &assignment, const std::initializer_list<std::string> parts)
{
  SCOPED_TRACE(assignment);
  expect_error(ExitCode::bad_input, parts, [&] { assigned(assignment); });
}

void expect_invalid(ParameterList list, const std::initializer_list<std::string> parts)
{
  expect_error(ExitCode::bad_input, parts, [&] { rpc::validate(list, valid_deck()); });
}

TEST(Validate, EmptyListGetsAllDefaults)
{
  ParameterList list;
  rpc::validate(list, valid_deck());
  EXPECT_EQ(list.sublist("Mesh").get<std::string>("Type"), "box");
  EXPECT_EQ(list.sublist("Mesh").get<Array<int>>("Cells"), Array<int>(tuple(8, 8)));
  EXPECT_EQ(list.sublist("Contact").get<double>("Penalty"), 1e8);
  EXPECT_EQ(field_text(list.sublist("Contact"), "Gap"), "0");
  EXPECT_TRUE(list.isSublist("Dirichlet"));
  EXPECT_EQ(list.sublist("Dirichlet").numParams(), 0);
  EXPECT_EQ(list.sublist("NOX").numParams(), 0);
}

TEST(Validate, GivenValuesSurviveTheDefaults)
{
  ParameterList list;
  list.sublist("Contact").set("Steps", 7);
  rpc::validate(list, valid_deck());
  EXPECT_EQ(list.sublist("Contact").get<int>("Steps"), 7);
  EXPECT_EQ(list.sublist("Contact").get<bool>("Verbose"), false);
}

TEST(Validate, FilledInDefaultsSaySoAndGivenValuesDoNot)
{
  ParameterList list;
  list.sublist("Mesh").set("Type", "box"); // the default's own value
  list.sublist("Contact").set("Penalty", 5).set("Gap", 0);
  list.sublist("Dirichlet").sublist("anchor").set("X", "");
  const auto expect_marks = [&](const ParameterList &done) {
    EXPECT_FALSE(done.sublist("Mesh").getEntry("Type").isDefault());
    EXPECT_TRUE(done.sublist("Mesh").getEntry("Lower").isDefault());
    EXPECT_TRUE(done.sublist("Mesh").getEntry("Cells").isDefault());
    EXPECT_FALSE(done.sublist("Contact").getEntry("Penalty").isDefault()); // an int made a double
    EXPECT_FALSE(done.sublist("Contact").getEntry("Gap").isDefault());
    EXPECT_TRUE(done.sublist("Contact").getEntry("Steps").isDefault());
    EXPECT_TRUE(done.sublist("Contact").getEntry("Verbose").isDefault());
    EXPECT_FALSE(done.sublist("Dirichlet").sublist("anchor").getEntry("X").isDefault());
    EXPECT_TRUE(done.sublist("Dirichlet").sublist("anchor").getEntry("Side").isDefault());
  };
  rpc::validate(list, valid_deck());
  expect_marks(list);
  rpc::validate(list, valid_deck()); // once more changes nothing
  expect_marks(list);
}

TEST(Validate, AssignedValuesAreGivenOnes)
{
  ParameterList list;
  assign(list, valid_deck(), "Contact->Steps=3"); // the default's own value
  rpc::validate(list, valid_deck());
  EXPECT_FALSE(list.sublist("Contact").getEntry("Steps").isDefault());
  EXPECT_TRUE(list.sublist("Contact").getEntry("Penalty").isDefault());
}

TEST(Validate, MisspeltNameIsRefusedWithTheNearestOne)
{
  ParameterList parameter, sublist;
  parameter.sublist("Contact").set("penaltty", 1.);
  expect_invalid(parameter, {"\"Contact->penaltty\"", "Did you mean \"Penalty\"", "Penalty, Steps, Verbose, Gap"});
  sublist.sublist("Contat");
  expect_invalid(sublist, {"\"Contat\"", "Did you mean \"Contact\""});
}

TEST(Validate, WrongTypeIsRefusedWithBothTypesAndTheValue)
{
  ParameterList text, fraction, number, list, parameter, array;
  text.sublist("Contact").set("Penalty", "much");
  expect_invalid(text, {"\"Contact->Penalty\"", "double", "string", "much"});
  fraction.sublist("Contact").set("Steps", 2.5);
  expect_invalid(fraction, {"\"Contact->Steps\"", "int", "double", "2.5"});
  number.sublist("Contact").set("Gap", true);
  expect_invalid(number, {"\"Contact->Gap\"", "number or expression", "bool"});
  list.sublist("Contact").sublist("Steps");
  expect_invalid(list, {"\"Contact->Steps\"", "int", "sublist"});
  parameter.set("Contact", 1);
  expect_invalid(parameter, {"\"Contact\"", "sublist", "int"});
  array.sublist("Mesh").set("Cells", Array<double>(tuple(1., 2.)));
  expect_invalid(array, {"\"Mesh->Cells\"", "array of int", "array of double"});
}

TEST(Validate, ListsThatAreFilledInSayThatTheyAreNoDecks)
{
  ParameterList list;
  list.sublist("Dirichlet");
  for (int time = 0; time < 2; ++time) {
    rpc::validate(list, valid_deck());
    EXPECT_FALSE(list.getEntry("Dirichlet").isDefault());
    EXPECT_TRUE(list.isSublist("Contact") && list.getEntry("Contact").isDefault());
  }
}

TEST(Validate, IntegersServeAsDoubles)
{
  ParameterList list;
  list.sublist("Contact").set("Penalty", 5);
  list.sublist("Mesh").set("Lower", Array<int>(tuple(-1, 2)));
  rpc::validate(list, valid_deck());
  EXPECT_EQ(list.sublist("Contact").get<double>("Penalty"), 5.);
  EXPECT_EQ(list.sublist("Mesh").get<Array<double>>("Lower"), Array<double>(tuple(-1., 2.)));
}

TEST(Validate, FieldIsAnIntADoubleOrAText)
{
  for (const std::string expected : {"2", "0.5", "x + 1"}) {
    ParameterList list;
    if (expected == "2") list.sublist("Contact").set("Gap", 2);
    if (expected == "0.5") list.sublist("Contact").set("Gap", 0.5);
    if (expected == "x + 1") list.sublist("Contact").set("Gap", expected);
    rpc::validate(list, valid_deck());
    EXPECT_EQ(field_text(list.sublist("Contact"), "Gap"), expected);
  }
}

TEST(Validate, AChoiceIsOneOfItsWordsOrABool)
{
  ParameterList valid("rpc");
  rpc::set_choice(valid, "Exodus", {"joined", "split", "none"}, "Files.");
  const auto chosen = [&](const auto &...given) {
    ParameterList list("deck");
    (list.set("Exodus", given), ...);
    rpc::validate(list, valid);
    return list.get<std::string>("Exodus");
  };
  EXPECT_EQ(chosen(), "joined");
  EXPECT_EQ(chosen(std::string("split")), "split");
  EXPECT_EQ(chosen(true), "joined");
  EXPECT_EQ(chosen(false), "none");
  EXPECT_EQ(chosen(std::string("false")), "none");
  expect_error(ExitCode::bad_input, {"\"Exodus\"", "one of joined, split, none", "both"},
               [&] { chosen(std::string("both")); });
  expect_error(ExitCode::bad_input, {"one of joined, split, none"}, [&] { chosen(2.); });
  for (const auto &[text, word] : {std::pair("Exodus=split", "split"), std::pair("Exodus=false", "none")}) {
    ParameterList list("deck");
    assign(list, valid, text);
    EXPECT_EQ(list.get<std::string>("Exodus"), word);
  }
  ParameterList list("deck");
  expect_error(ExitCode::bad_input, {"--set", "one of joined, split, none"},
               [&] { assign(list, valid, "Exodus=all"); });
}

TEST(Validate, PassThroughSublistStaysAsItIs)
{
  ParameterList list;
  ParameterList &nox = list.sublist("NOX");
  nox.set("Anything", 1);
  nox.sublist("Deeper").set("Gap", true);
  const ParameterList before = nox;
  rpc::validate(list, valid_deck());
  EXPECT_EQ(list.sublist("NOX"), before);
}

TEST(Validate, NamedEntriesGetTheirOwnDefaultsAndChecks)
{
  ParameterList list, misspelt, flat;
  list.sublist("Dirichlet").sublist("anchor").set("X", 1);
  list.sublist("Dirichlet").sublist("right");
  rpc::validate(list, valid_deck());
  EXPECT_EQ(list.sublist("Dirichlet").numParams(), 2);
  EXPECT_EQ(field_text(list.sublist("Dirichlet").sublist("anchor"), "X"), "1");
  EXPECT_EQ(list.sublist("Dirichlet").sublist("anchor").get<std::string>("Side"), "");
  EXPECT_EQ(field_text(list.sublist("Dirichlet").sublist("right"), "X"), "");
  misspelt.sublist("Dirichlet").sublist("anchor").set("Sid", "left");
  expect_invalid(misspelt, {"\"Dirichlet->anchor->Sid\"", "Did you mean \"Side\""});
  flat.sublist("Dirichlet").set("X", 1);
  expect_invalid(flat, {"\"Dirichlet->X\"", "sublist", "int"});
}

TEST(Assign, ReadsTheTextAsTheTypeOfTheParameter)
{
  EXPECT_EQ(assigned("Contact->Penalty=16").sublist("Contact").get<double>("Penalty"), 16.);
  EXPECT_EQ(assigned("Contact->Steps=-2").sublist("Contact").get<int>("Steps"), -2);
  EXPECT_EQ(assigned("Contact->Verbose=true").sublist("Contact").get<bool>("Verbose"), true);
  EXPECT_EQ(assigned("Mesh->Type=12").sublist("Mesh").get<std::string>("Type"), "12");
  EXPECT_EQ(assigned("Contact->Gap=x = 1").sublist("Contact").get<std::string>("Gap"), "x = 1");
  EXPECT_EQ(assigned("Mesh->Cells={160, 32}").sublist("Mesh").get<Array<int>>("Cells"), Array<int>(tuple(160, 32)));
  EXPECT_EQ(assigned("Mesh->Lower={1, 0.5}").sublist("Mesh").get<Array<double>>("Lower"), Array<double>(tuple(1., .5)));
  EXPECT_EQ(assigned("Mesh->Blocks={a, b}").sublist("Mesh").get<Array<std::string>>("Blocks"),
            Array<std::string>(tuple<std::string>("a", "b")));
  EXPECT_EQ(assigned("Dirichlet->anchor->X=1").sublist("Dirichlet").sublist("anchor").get<std::string>("X"), "1");
}

TEST(Assign, ReplacesWhatTheDeckSaid)
{
  ParameterList list;
  list.sublist("Contact").set("Penalty", 1).set("Steps", 5); // an int, as a deck may give it
  assign(list, valid_deck(), "Contact->Penalty=2.5");
  EXPECT_EQ(list.sublist("Contact").get<double>("Penalty"), 2.5);
  EXPECT_EQ(list.sublist("Contact").get<int>("Steps"), 5);
}

TEST(Assign, BelowAPassThroughTheFirstTypeThatFitsIsTaken)
{
  EXPECT_EQ(assigned("NOX->A=3").sublist("NOX").get<int>("A"), 3);
  EXPECT_EQ(assigned("NOX->Deep->A=1e-8").sublist("NOX").sublist("Deep").get<double>("A"), 1e-8);
  EXPECT_EQ(assigned("NOX->Deep->Deeper->A=false").sublist("NOX").sublist("Deep").sublist("Deeper").get<bool>("A"),
            false);
  EXPECT_EQ(assigned("NOX->A=3 steps").sublist("NOX").get<std::string>("A"), "3 steps");
}

TEST(Assign, PathThatDoesNotExistIsRefusedWithTheNearestOne)
{
  expect_refused("Contact->Penality=1", {"\"Contact->Penality\"", "Did you mean \"Penalty\""});
  expect_refused("Contakt->Penalty=1", {"\"Contakt\"", "Did you mean \"Contact\""});
  expect_refused("Dirichlet->anchor->Sides=left", {"\"Dirichlet->anchor->Sides\"", "Did you mean \"Side\""});
}

TEST(Assign, ParameterAndSublistAreNotMixedUp)
{
  expect_refused("Contact->Gap->X=1", {"\"Contact->Gap\"", "not a sublist"});
  expect_refused("Contact=1", {"\"Contact\"", "is a sublist"});
  expect_refused("Dirichlet->anchor=1", {"\"Dirichlet->anchor\"", "is a sublist"});
  ParameterList list;
  list.set("Contact", 1);
  expect_error(ExitCode::bad_input, {"\"Contact\"", "not a sublist"},
               [&] { assign(list, valid_deck(), "Contact->Steps=1"); });
}

TEST(Assign, TextThatDoesNotReadAsTheTypeIsRefused)
{
  expect_refused("Contact->Penalty=much", {"\"Contact->Penalty\"", "double", "\"much\""});
  expect_refused("Contact->Penalty=1 m", {"\"1 m\""});
  expect_refused("Contact->Penalty=", {"\"Contact->Penalty\"", "\"\""});
  expect_refused("Contact->Steps=2.5", {"\"Contact->Steps\"", "int", "\"2.5\""});
  expect_refused("Contact->Steps=99999999999", {"\"Contact->Steps\""});
  expect_refused("Contact->Verbose=1", {"\"Contact->Verbose\"", "bool"});
  expect_refused("Mesh->Cells=8", {"\"Mesh->Cells\"", "array of int"});
  expect_refused("Mesh->Cells={1.5, 2}", {"\"Mesh->Cells\"", "array of int"});
  expect_refused("Mesh->Cells={1, two}", {"\"Mesh->Cells\"", "array of int"});
  expect_refused("Mesh->Lower={1, 2m}", {"\"Mesh->Lower\"", "array of double"});
}

TEST(Assign, TextWithoutNameOrValueIsRefused)
{
  expect_refused("Contact->Penalty", {"Contact->Penalty", "=value"});
  expect_refused("=1", {"=value"});
}

TEST(FieldText, DoublesKeepAllTheirDigits)
{
  for (const double value :
       {0.1, 1. / 3, -2e-300, 1e22, std::nextafter(16., 17.), std::numeric_limits<double>::max()}) {
    ParameterList list;
    list.set("Gap", value);
    EXPECT_EQ(std::stod(field_text(list, "Gap")), value) << field_text(list, "Gap");
  }
}

using Texts = std::vector<std::string>;

TEST(FieldTexts, AreReadFromNumbersAndFromExpressions)
{
  const auto read = [](const auto &array) {
    ParameterList deck;
    deck.sublist("Contact").set("Centre", array);
    rpc::validate(deck, valid_deck());
    return rpc::field_texts(deck.sublist("Contact"), "Centre");
  };
  EXPECT_EQ(read(Array<int>(tuple(1, -2))), (Texts{"1", "-2"}));
  EXPECT_EQ(read(Array<double>(tuple(0.1, 1e-300, 3.))), (Texts{"0.1", "1e-300", "3"}));
  EXPECT_EQ(read(Array<std::string>(tuple<std::string>("0", "0.1*t"))), (Texts{"0", "0.1*t"}));
  EXPECT_EQ(read(Array<std::string>()), Texts{});
  ParameterList deck;
  rpc::validate(deck, valid_deck());
  EXPECT_EQ(rpc::field_texts(deck.sublist("Contact"), "Centre"), Texts{});
}

TEST(FieldTexts, CommasBetweenParenthesesCutNoExpression)
{
  // As Teuchos cuts "{min(t, max(1, 2)), 0, (t)}" in a deck.
  ParameterList list;
  list.set("Centre", Array<std::string>(tuple<std::string>("min(t", " max(1", " 2))", " 0 ", " (t)")));
  EXPECT_EQ(rpc::field_texts(list, "Centre"), (Texts{"min(t, max(1, 2))", "0", "(t)"}));
  const auto set = [](const std::string &text) {
    ParameterList deck = assigned("Contact->Centre=" + text);
    rpc::validate(deck, valid_deck());
    return rpc::field_texts(deck.sublist("Contact"), "Centre");
  };
  EXPECT_EQ(set("{min(t, max(1, 2)), 0, (t)}"), (Texts{"min(t, max(1, 2))", "0", "(t)"}));
  EXPECT_EQ(set(" { 0.5 } "), Texts{"0.5"});
  EXPECT_EQ(set("{1, -2}"), (Texts{"1", "-2"}));
  EXPECT_EQ(set("{}"), Texts{});
}

TEST(FieldTexts, AreRefusedByTheirRuleWhereTheyAreNoArray)
{
  for (const std::string text : {"0", "t", "0, t", "{0, t", ""})
    expect_refused("Contact->Centre=" + text, {"\"Contact->Centre\"", "array of numbers, such as",
                                               "of strings with expressions, such as {0, 0.1*t}"});
  ParameterList deck;
  deck.sublist("Contact").set("Centre", 3);
  expect_invalid(deck, {"\"Contact->Centre\"", "array of numbers", "int"});
  deck.sublist("Contact").set("Centre", Array<int>(tuple(3)));
  rpc::validate(deck, valid_deck());
}

TEST(Validate, RefusedValueIsSpeltAsInADeck)
{
  ParameterList array, boolean;
  array.sublist("Mesh").set("Cells", Array<double>(tuple(1., 2.5)));
  expect_invalid(array, {"{1, 2.5}"});
  boolean.sublist("Contact").set("Steps", true);
  expect_invalid(boolean, {"true"});
}

TEST(NearestName, IsTheOneOfLeastEditDistanceWithoutRegardToCase)
{
  EXPECT_EQ(rpc::nearest_name("yeild stress", {"Side", "Yield Stress", "Gap"}), "Yield Stress");
  EXPECT_EQ(rpc::nearest_name("ga", {"Side", "Gap", "Gab Gap"}), "Gap");
  EXPECT_EQ(rpc::nearest_name("Gpa", {"Side", "Gap"}), "Gap");
  EXPECT_EQ(rpc::nearest_name("nu", {"Young's Modulus", "Blocks"}), "");
  EXPECT_EQ(rpc::nearest_name("Gap", {}), "");
  EXPECT_EQ(rpc::nearest_name("Filename", {"Type", "File"}), "File");
  EXPECT_EQ(rpc::nearest_name("bottom left", {"left", "left bottom"}), "left bottom");
  // Far: more than a third of the letters.
  EXPECT_EQ(rpc::nearest_name("Name", {"Time", "Mesh"}), "");
  EXPECT_EQ(rpc::nearest_name("Refine", {"File"}), "");
  EXPECT_EQ(rpc::nearest_name("Shear Modulus", {"Young's Modulus"}), "");
  EXPECT_EQ(rpc::nearest_name("P", {"Penalty"}), "");
}

TEST(Join, PutsCommasBetween)
{
  EXPECT_EQ(rpc::join({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(rpc::join({"a"}), "a");
  EXPECT_EQ(rpc::join({}), "");
}

TEST(PrintParameters, ListsEachParameterWithTypeDefaultAndDoc)
{
  std::ostringstream out;
  ParameterList valid = valid_deck();
  valid.set("Modulus", std::numeric_limits<double>::quiet_NaN(), "E > 0 [Pa].");
  rpc::print_parameters(out, valid);
  const std::string text = out.str();
  for (const std::string line :
       {"- `Type` (string, default `box`): Kind of mesh.",
        "- `Lower` (array of double, default `{0, 0}`): Lower corner",
        "- `Cells` (array of int, default `{8, 8}`): Number of cells.", "- `Blocks` (array of string, default `{a}`)",
        "- `Penalty` (double, default `1e+08`): r > 0 [Pa/m].", "- `Steps` (int, default `3`)",
        "- `Verbose` (bool, default `false`)", "- `Modulus` (double, no default): E > 0 [Pa].",
        "- `Gap` (number or expression, default `0`): Gap [m].",
        "### Dirichlet-><any name>\n\nPrescribed displacements.", "- `Side` (string, default ``)",
        "### NOX\n\nHanded on to NOX.", "### Mesh\n\nThe mesh."})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
  EXPECT_EQ(text.find("**"), std::string::npos) << text; // the mark of a pass-through is no parameter
}

} // namespace
} // namespace parameters_test

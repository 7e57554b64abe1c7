// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/remedies.hpp"

#include "rpc/core/parameters.hpp"

#include "expect_error.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterList.hpp>
#include <string>

namespace remedies_test
{
namespace
{

using rpc::ExitCode;
using rpc::test::expect_error;
using Teuchos::ParameterList;

TEST(WrittenNumber, IsReadAsPeopleWriteIt)
{
  const std::pair<const char *, double> texts[] = {{"0,3", 0.3},
                                                   {"-0,3", -0.3},
                                                   {".5", 0.5},
                                                   {"5.", 5},
                                                   {"210 000", 210000},
                                                   {"210'000", 210000},
                                                   {"210_000", 210000},
                                                   {"210.000,5", 210000.5},
                                                   {"210,000.5", 210000.5},
                                                   {"1,000,000", 1e6},
                                                   {"2,1e5", 2.1e5},
                                                   {"2.1d5", 2.1e5},
                                                   {"2.1D+05", 2.1e5},
                                                   {"2.1*10^5", 2.1e5},
                                                   {"2.1 x 10^5", 2.1e5},
                                                   {"2.1\u00b710^-5", 2.1e-5},
                                                   {"\u22122.5", -2.5},
                                                   {"\"2000\"", 2000},
                                                   {"2000;", 2000}};
  for (const auto &[text, value] : texts) {
    const auto number = rpc::written_number(text);
    ASSERT_TRUE(number) << text;
    EXPECT_DOUBLE_EQ(number->value, value) << text;
    EXPECT_EQ(number->unit, "") << text;
  }
  for (const char *const text : {"", "stiff", "1 2", "1,2,3", "{1}", "1.2.3", "x+1", "-"})
    EXPECT_FALSE(rpc::written_number(text)) << text;
}

TEST(NumberRemedy, TurnsUnitsIntoThoseOfDecks)
{
  const std::string modulus = rpc::number_remedy("210 GPa");
  EXPECT_NE(modulus.find("without \"GPa\""), std::string::npos) << modulus;
  EXPECT_NE(modulus.find("2.1e+11 with m and N, 210000 with mm and N, 210000000 with m and kN."), std::string::npos)
      << modulus;
  EXPECT_EQ(rpc::number_remedy("210e3N/mm^2").substr(0, 29), " Write the number alone, with");
  EXPECT_NE(rpc::number_remedy("0,5 mm").find("0.0005 with m and N, 0.5 with mm and N"), std::string::npos);
  EXPECT_NE(rpc::number_remedy("3 MN/m^3").find("3000000 with m and N, 0.003 with mm and N"), std::string::npos);
  EXPECT_NE(rpc::number_remedy("30 %").find(": 0.3."), std::string::npos);
  EXPECT_NE(rpc::number_remedy("12 parsec").find("without \"parsec\""), std::string::npos);
  EXPECT_EQ(rpc::number_remedy("0,3"), " Write 0.3: decks have a decimal point.");
  EXPECT_NE(rpc::number_remedy("1,234").find("1.234, or 1234 if the comma stands between thousands"),
            std::string::npos);
  EXPECT_EQ(rpc::number_remedy("stiff"), "");
  EXPECT_EQ(rpc::number_remedy("2*x"), "");
}

TEST(Arithmetic, IsOfNumbersAlone)
{
  const std::pair<const char *, double> texts[] = {
      {"-500/120", -500. / 120}, {"2*(3 + 4)", 14}, {"2^3^2", 512}, {"-2**2", -4}, {"1e3/4", 250},
      {"1 - 2 - 3", -4},         {"+1/.5", 2}};
  for (const auto &[text, value] : texts) {
    const auto found = rpc::arithmetic(text);
    ASSERT_TRUE(found) << text;
    EXPECT_DOUBLE_EQ(*found, value) << text;
  }
  for (const char *const text : {"", "5", "-5", "2*x", "1/0", "2*", "(1+2", "1+2)", "0x10/2", "inf/2", "3 N/m"})
    EXPECT_FALSE(rpc::arithmetic(text)) << text;
  EXPECT_FALSE(rpc::arithmetic(std::string(150, '(') + "1+1" + std::string(150, ')')));
}

/// A list as decks have one for loads.
ParameterList traction()
{
  ParameterList entry;
  entry.set("Side", "", "Side of the mesh.");
  for (const char *const name : {"X", "Y", "Z"}) rpc::set_field(entry, name, "0", "Force per area [Pa].");
  for (const char *const name : {"Force X", "Force Y", "Force Z"})
    rpc::set_field(entry, name, "0", "Force on the whole side [N].");
  return entry;
}

ParameterList loaded_deck()
{
  ParameterList valid("deck"), entry;
  rpc::set_named_entries(valid, "Traction", traction(), "Loads.");
  rpc::set_field(entry, "X", "", "Displacement [m].");
  rpc::set_field(entry, "Z", "", "Displacement [m].");
  rpc::set_named_entries(valid, "Dirichlet", entry, "Supports.");
  valid.sublist("Material").set("Young's Modulus", 1., "E > 0 [Pa].");
  valid.sublist("Contact").set("Yield Stress", 1., "xi [Pa].");
  valid.sublist("Body Force").set("Y", 0., "Force per volume [N/m^3].");
  return valid;
}

TEST(NumberRemedy, SaysThatAnotherQuantityIsWanted)
{
  const auto remedy = [valid = loaded_deck()](const std::string &text, const std::string &path) {
    return rpc::number_remedy(text, rpc::wanted_of(valid, path));
  };
  EXPECT_EQ(
      remedy("-500 N", "Traction->top->Y"),
      " \"N\" is a unit of force, where a pressure is wanted [Pa]. For a force write \"Force Y\" instead of \"Y\", "
      "and the number alone, in the deck's units (see \"Units\").");
  EXPECT_NE(remedy("5 MPa", "Traction->top->Force Z").find("For a pressure write \"Z\" instead of \"Force Z\""),
            std::string::npos);
  EXPECT_NE(remedy("5 kN/m", "Traction->top->Force X").find("without \"kN/m\""), std::string::npos); // of a plane body
  EXPECT_EQ(remedy("0MPa", "Dirichlet->left->X"),
            " \"MPa\" is a unit of pressure, where a length is wanted [m]. Write 0.");
  EXPECT_NE(remedy("-500 N", "Dirichlet->left->X").find("belong into \"Traction\""), std::string::npos);
  EXPECT_NE(remedy("78.5 kN/m^3", "Material->Young's Modulus").find("a unit of force per volume"), std::string::npos);
  EXPECT_NE(remedy("210 GPa", "Material->Young's Modulus").find("2.1e+11 with m and N"), std::string::npos);
  EXPECT_EQ(remedy("-500/120", "Material->Young's Modulus"),
            " Write its value, -4.166666667: this parameter takes a number, not an expression.");
  EXPECT_NE(remedy("-500/120", "Traction->top->Y").find("-4.166666667: or in XML type=\"string\""), std::string::npos);
  EXPECT_NE(rpc::number_remedy("-500/120").find("only parameters of the kind \"number or expression\""),
            std::string::npos);
}

TEST(Wanted, IsKnownOfPathsOfTheDeckAlone)
{
  const ParameterList valid = loaded_deck();
  EXPECT_EQ(rpc::wanted_of(valid, "Traction->any->Force Y").unit, "N");
  EXPECT_TRUE(*rpc::wanted_of(valid, "Traction->any->Y").expression);
  EXPECT_FALSE(*rpc::wanted_of(valid, "Material->Young's Modulus").expression);
  for (const char *const path : {"Traction", "Traction->any", "Traction->any->Q", "Nothing->X", ""})
    EXPECT_FALSE(rpc::wanted_of(valid, path).expression) << path;
}

TEST(AxisRemedy, WritesTheUnitVector)
{
  EXPECT_EQ(rpc::axis_remedy("z"), " Write {0, 0, 1} (in YAML [0, 0, 1]).");
  EXPECT_EQ(rpc::axis_remedy("{-y}"), " Write {0, -1, 0} in space, {0, -1} in the plane (in YAML [0, -1, 0]).");
  for (const char *const text : {"", "xy", "up", "1"}) EXPECT_EQ(rpc::axis_remedy(text), "") << text;
}

TEST(OneForEachRemedy, IsOfArraysWithSeveralNumbers)
{
  EXPECT_EQ(rpc::one_for_each_remedy("20", 2),
            " Write one for each direction: {20, 20} in the plane, {20, 20, 20} in space (in YAML [20, 20]).");
  EXPECT_EQ(rpc::one_for_each_remedy("20", 0), "");
  EXPECT_EQ(rpc::one_for_each_remedy("20 x 10", 2), "");
}

TEST(WordRemedy, KnowsWordsOfOtherPrograms)
{
  EXPECT_EQ(rpc::word_remedy("step", {"box", "gmsh"}), " For \"step\" write gmsh.");
  EXPECT_EQ(rpc::word_remedy("STL", {"box", "gmsh"}), " For \"STL\" write gmsh.");
  EXPECT_EQ(rpc::word_remedy("STL", {"plane", "surface mesh"}), " For \"STL\" write surface mesh.");
  EXPECT_EQ(rpc::word_remedy("ball", {"plane", "sphere"}), " For \"ball\" write sphere.");
  EXPECT_EQ(rpc::word_remedy("Box", {"box", "gmsh"}), " Did you mean \"box\"?");
  EXPECT_EQ(rpc::word_remedy("ball", {"box", "gmsh"}), "");
}

TEST(NumberRemedy, KnowsParametersWithoutAUnit)
{
  const rpc::Wanted ratio{"Poisson's Ratio", "", std::nullopt, {{"Young's Modulus", "Pa"}}};
  EXPECT_EQ(rpc::number_remedy("0.3GPa", ratio),
            " \"Poisson's Ratio\" is a number without a unit: write 0.3. \"GPa\" is a unit "
            "of pressure, as of \"Young's Modulus\".");
  EXPECT_EQ(rpc::number_remedy("0.3 mm", ratio), " \"Poisson's Ratio\" is a number without a unit: write 0.3.");
  EXPECT_EQ(rpc::number_remedy("30 %", ratio), " Write the number alone, without \"%\": 0.3.");
}

TEST(FileRemedy, LooksAtStemsToo)
{
  EXPECT_EQ(rpc::file_remedy("bal.geo", {"ball.geo", "x.msh"}), " Did you mean \"ball.geo\"?");
  EXPECT_EQ(rpc::file_remedy("ball.step", {"ball.geo", "x.msh"}), " Did you mean \"ball.geo\"?");
  EXPECT_EQ(rpc::file_remedy("xyz.geo", {"ball.geo", "x.msh"}), "");
  EXPECT_EQ(rpc::file_remedy("ball.stp", {"ball.msh", "ball.step"}), " Did you mean \"ball.step\"?");
}

TEST(FileRemedy, IsNotMisledByAnEndingThatFilesShare)
{
  EXPECT_EQ(rpc::file_remedy("seal.yml", {"heel.xml", "shear.xml"}), "");
  EXPECT_EQ(rpc::file_remedy("sea.msh", {"hex.msh"}), "");
  EXPECT_EQ(rpc::file_remedy("seel.yml", {"seal.xml", "shear.xml"}), " Did you mean \"seal.xml\"?");
}

TEST(ArrayRemedy, WritesListsOfOtherPrograms)
{
  const std::string good = " Write {160, 32} (in YAML [160, 32]).";
  for (const char *const text : {"160 32", "160, 32", "[160, 32]", "(160; 32)", "{160 32}", "160x32", "160 x 32",
                                 "{160, 32", "\"160, 32\"", "{160; 32;}"})
    EXPECT_EQ(rpc::array_remedy(text), good) << text;
  EXPECT_EQ(rpc::array_remedy("{5,0; 1,5}"), " Write {5, 1.5} (in YAML [5, 1.5]).");
  EXPECT_EQ(rpc::array_remedy("0,5 1,5 2"), " Write {0.5, 1.5, 2} (in YAML [0.5, 1.5, 2]).");
  EXPECT_EQ(rpc::array_remedy("{20.5, 4}", true), " Write whole numbers, such as {21, 4} (in YAML [21, 4]).");
  EXPECT_EQ(rpc::array_remedy("{500/100, 1}"), " Write {5, 1} (in YAML [5, 1]).");
  EXPECT_EQ(rpc::array_remedy("{zero, 1}"), "");
  EXPECT_EQ(rpc::array_remedy(""), "");
}

TEST(IntegerRemedy, WritesAWholeNumber)
{
  EXPECT_EQ(rpc::integer_remedy("4.0"), " Write 4.");
  EXPECT_EQ(rpc::integer_remedy("1e3"), " Write 1000.");
  EXPECT_EQ(rpc::integer_remedy("2.4"), " Write a whole number, such as 2.");
  EXPECT_EQ(rpc::integer_remedy("20000000000"), " Write at most 2147483647.");
}

TEST(BoolRemedy, KnowsWordsForYesAndNo)
{
  EXPECT_EQ(rpc::bool_remedy("ON"), " Write true.");
  EXPECT_EQ(rpc::bool_remedy(".FALSE."), " Write false.");
  EXPECT_EQ(rpc::bool_remedy("maybe"), "");
}

/// Refusals of a name, of a deck whose lists have some of the real names.
void expect_named(const std::string &assignment, const std::string &part)
{
  SCOPED_TRACE(assignment);
  ParameterList valid("deck"), entry, list;
  ParameterList &material = valid.sublist("Material");
  material.set("Young's Modulus", 1., "E.");
  material.set("Poisson's Ratio", 0.3, "nu.");
  rpc::set_words(valid.sublist("Mesh"), "Element", {"Q1", "Q2"}, "Element of the box: `Q1` is of order 1.");
  valid.sublist("Contact").set("Yield Stress", 1., "xi.");
  entry.set("Side", "", "Side of the mesh.");
  for (const char *const name : {"X", "Y", "Z"}) rpc::set_field(entry, name, "", "A component.");
  rpc::set_named_entries(valid, "Traction", entry, "Loads.");
  expect_error(ExitCode::bad_input, part, [&] { rpc::assign(list, valid, assignment); });
}

TEST(UnknownName, OfBooksAndOtherProgramsIsTranslated)
{
  expect_named("Material->E=1", "Did you mean \"Young's Modulus\"?");
  expect_named("Material->nu=1", "Did you mean \"Poisson's Ratio\"?");
  expect_named("Material->youngs_modulus=1", "Did you mean \"Young's Modulus\"?");
  expect_named("Material->Loads=1", "In a deck that is \"Traction\".");
  expect_named("Traction->top->fy=1", "Did you mean \"Y\"?");
  expect_named("Traction->top->Pressure=1", "Write the components of the force per area, X, Y, Z");
}

TEST(UnknownName, OfASideThatAForceMovesIsADisplacementOrItsForce)
{
  ParameterList valid("deck"), entry, list;
  rpc::set_field(entry, "X", "", "Displacement [m].");
  rpc::set_field(entry, "Z", "", "Displacement [m].");
  rpc::set_field(entry, "Force X", "", "Force on the whole side [N].");
  rpc::set_named_entries(valid, "Dirichlet", entry, "Supports.");
  for (const auto &[assignment, part] :
       {std::pair("Dirichlet->top->Fx=1",
                  "Did you mean \"Force X\", the force on the whole side, or \"X\", its displacement?"),
        std::pair("Dirichlet->top->Force=1", "the force that moves the side as one rigid piece, Force X"),
        std::pair("Dirichlet->top->px=1", "A load belongs into \"Traction\".")})
    expect_error(ExitCode::bad_input, part, [&] { rpc::assign(list, valid, assignment); });
}

TEST(UnknownName, OfARigidSideIsAMotionOrWhatMovesIt)
{
  ParameterList valid("deck"), entry, list;
  for (const char *const name : {"X", "Z", "Rotation X", "Force X", "Moment X", "Stiffness X", "Rotation Stiffness X"})
    rpc::set_field(entry, name, "", "Displacement [m].");
  rpc::set_named_entries(valid, "Rigid", entry, "Rigid sides.");
  for (const auto &[assignment, part] :
       {std::pair("Rigid->top->Torque=1", "Moment X, Moment Y, Moment Z; in the plane Z alone"),
        std::pair("Rigid->top->Tilt=1", "Rotation X, Rotation Y, Rotation Z; in the plane Z alone"),
        std::pair("Rigid->top->Spring=1", "Stiffness X, Y or Z, or Rotation Stiffness X, Y or Z")})
    expect_error(ExitCode::bad_input, part, [&] { rpc::assign(list, valid, assignment); });
}

TEST(UnknownName, OfAComponentIsTakenByItsQuantity)
{
  ParameterList list;
  const ParameterList valid = loaded_deck();
  for (const auto &[assignment, part] :
       {std::pair("Traction->top->Fx=1",
                  "Did you mean \"Force X\", the force on the whole side, or \"X\", the force per area?"),
        std::pair("Traction->top->ux=1", "A displacement is prescribed in \"Dirichlet\"."),
        std::pair("Traction->top->py=1", "Did you mean \"Y\"?"),
        std::pair("Traction->top->Force=1", "force on the whole side, Force X, Force Y, Force Z"),
        std::pair("Traction->top->Force Yy=1", "Did you mean \"Force Y\"?"),
        std::pair("Dirichlet->left->Fx=1", "A load belongs into \"Traction\"."),
        std::pair("Dirichlet->left->ux=1", "Did you mean \"X\"?"),
        std::pair("Dirichlet->left->Value=1", "Write the displacement's components")})
    expect_error(ExitCode::bad_input, part, [&] { rpc::assign(list, valid, assignment); });
}

TEST(UnknownName, WithMarksOfAPathIsTakenApart)
{
  ParameterList list;
  const ParameterList valid = loaded_deck();
  for (const char *const path :
       {"Contact.Yield Stress", "Contact/Yield", "Contact::Yield Stress", "Contact->Contact.Yield"})
    expect_error(ExitCode::bad_input,
                 "write \"Yield Stress\" into the list \"Contact\", in --set as \"Contact->Yield Stress\"",
                 [&] { rpc::assign(list, valid, path + std::string("=3")); });
  expect_error(ExitCode::bad_input, "write \"Y\" into the list \"Traction->top\"",
               [&] { rpc::assign(list, valid, "Traction.top.Y=3"); });
}

TEST(UnknownName, OfAListInAWrongListIsSentOut)
{
  const ParameterList valid = loaded_deck();
  ParameterList in_contact, as_entry, twice, flat;
  in_contact.sublist("Contact").sublist("Material").set("Young's Modulus", 1.);
  expect_error(ExitCode::bad_input, {"\"Contact->Material\"", "close \"Contact\" before it"},
               [&] { rpc::validate(in_contact, valid); });
  as_entry.sublist("Traction").sublist("Contact").set("Yield Stress", 1.);
  expect_error(ExitCode::bad_input, {"\"Contact\" is a list of the outermost level: close \"Traction\" before it"},
               [&] { rpc::validate(as_entry, valid); });
  twice.sublist("Dirichlet").sublist("Dirichlet").sublist("left").set("X", 0.);
  expect_error(ExitCode::bad_input, {"\"Dirichlet\" stands within \"Dirichlet\""},
               [&] { rpc::validate(twice, valid); });
  flat.sublist("Traction").set("Y", -5.);
  expect_error(ExitCode::bad_input,
               {"\"Traction->Y\" must be a sublist", "named after a side", "<ParameterList name=\"top\">"},
               [&] { rpc::validate(flat, valid); });
}

TEST(UnknownName, OfWhatADeckDoesNotHaveIsExplained)
{
  ParameterList list;
  const ParameterList valid = loaded_deck();
  expect_error(ExitCode::bad_input,
               {"\"Material->Density\"", "the weight is \"Body Force\", the density times gravity"},
               [&] { rpc::assign(list, valid, "Material->Density=7850"); });
  expect_error(ExitCode::bad_input, {"\"Material->Shear Modulus\"", "G = E/(2 (1 + nu))"},
               [&] { rpc::assign(list, valid, "Material->Shear Modulus=1"); });
  expect_error(ExitCode::bad_input, {"\"Title\"", "named by its file"}, [&] { rpc::assign(list, valid, "Title=1"); });
}

TEST(UnknownName, OfAUnitThatFollowsFromOthersIsExplained)
{
  ParameterList list, valid("rpc");
  valid.sublist("Units").set("Length", "m").set("Force", "N");
  for (const char *const name : {"Stress", "Pressure", "Energy", "System"})
    expect_error(ExitCode::bad_input, {name, "Units of stress and energy follow from those of length and force"},
                 [&] { rpc::assign(list, valid, std::string("Units->") + name + "=MPa"); });
  expect_error(ExitCode::bad_input, {"Did you mean \"Length\"?"},
               [&] { rpc::assign(list, valid, "Units->Lenght=mm"); });
}

TEST(Entries, GivenAsATextAreSentToTheParameterForOneOfThem)
{
  ParameterList deck, body, valid("rpc"), entry;
  entry.set("Side", "", "Side").set("Gap", 0., "Gap [m]");
  valid.sublist("Contact").set("Side", "");
  rpc::set_named_entries(valid.sublist("Contact"), "Sides", entry, "Further ones.");
  rpc::set_named_entries(valid, "Traction", entry, "Loads.");
  deck.sublist("Contact").set("Sides", "FOOT");
  expect_error(ExitCode::bad_input, {"\"Contact->Sides\" must be a sublist", "A single one is \"Side\" = FOOT."},
               [&] { rpc::validate(deck, valid); });
  body.set("Traction", "top");
  expect_error(ExitCode::bad_input, {"\"Traction\" must be a sublist", "in YAML Traction: {top: {Gap: ...}}"},
               [&] { rpc::validate(body, valid); });
}

TEST(UnknownName, OfAnotherListIsSentThere)
{
  expect_named("Yield Stress=1", "It is a parameter of another list: \"Contact->Yield Stress\".");
  expect_named("Material->yield stress=1", "\"Contact->Yield Stress\"");
}

TEST(Words, AreRefusedWithTheNearestOrWithWhatTheyMean)
{
  expect_named("Mesh->Element=q2", "must be one of Q1, Q2, got \"q2\". Did you mean \"Q2\"?");
  expect_named("Mesh->Element=CPE4", "For \"CPE4\" write Q1.");
  expect_named("Mesh->Element=spline", "`Q1` is of order 1.");
}

} // namespace
} // namespace remedies_test

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

TEST(ArrayRemedy, WritesListsOfOtherPrograms)
{
  const std::string good = " Write {160, 32} (in YAML [160, 32]).";
  for (const char *const text : {"160 32", "160, 32", "[160, 32]", "(160; 32)", "{160 32}", "160x32", "160 x 32",
                                 "{160, 32", "\"160, 32\"", "{160; 32;}"})
    EXPECT_EQ(rpc::array_remedy(text), good) << text;
  EXPECT_EQ(rpc::array_remedy("{5,0; 1,5}"), " Write {5, 1.5} (in YAML [5, 1.5]).");
  EXPECT_EQ(rpc::array_remedy("0,5 1,5 2"), " Write {0.5, 1.5, 2} (in YAML [0.5, 1.5, 2]).");
  EXPECT_EQ(rpc::array_remedy("{20.5, 4}", true), " Write whole numbers, such as {21, 4} (in YAML [21, 4]).");
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
  expect_named("Traction->top->Pressure=1", "Write its components: X, Y, Z.");
}

TEST(UnknownName, OfAnotherListIsSentThere)
{
  expect_named("Yield Stress=1", "It is a parameter of another list: \"Contact->Yield Stress\".");
  expect_named("Material->yield stress=1", "\"Contact->Yield Stress\"");
}

TEST(Words, AreRefusedWithTheNearestOrWithWhatTheyMean)
{
  expect_named("Mesh->Element=q2", "must be one of Q1, Q2, got \"q2\". Did you mean \"Q2\"?");
  expect_named("Mesh->Element=CPE4", "`Q1` is of order 1.");
}

} // namespace
} // namespace remedies_test

// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "rpc/io/deck.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <string>

namespace yaml_deck_test
{
namespace
{

using rpc::ExitCode;
using rpc::test::expect_error;

class YamlDeck : public testing::Test
{
protected:
  Teuchos::ParameterList read(const std::string &text) const
  {
    scratch_.write("deck.yaml", text);
    return rpc::io::read_deck(scratch_.path("deck.yaml"), *Tpetra::getDefaultComm());
  }
  /// A deck whose third line is wrong, and what is told of that.
  void expect_refused(const std::string &line, const std::string &part) const
  {
    SCOPED_TRACE(line);
    const std::string place = "deck: \"" + scratch_.path("deck.yaml") + "\", line 3: ";
    expect_error(ExitCode::bad_input, {place, part},
                 [&] { read("deck:\n  Contact:\n" + line + "\n    Penalty: 1.0\n"); });
  }

  rpc::test::Scratch scratch_{*Tpetra::getDefaultComm()};
};

TEST_F(YamlDeck, WithSignsOfYamlIsToldWhichNeedQuotes)
{
  expect_refused("    Gap: x > 1 ? 0 : 2",
                 "\"Contact->Gap\" = x > 1 ? 0 : 2 has a >: in YAML such a value needs quotes. "
                 "Write Gap: \"x > 1 ? 0 : 2\"");
  expect_refused("    Walls: {a: {Gap: x != 1}}", "has a !: in YAML such a value needs quotes. Write Gap: \"x != 1\"");
  expect_refused("    Side: a \"b\"", "Write Side: 'a \"b\"'");
  expect_refused("    Gap: 0.1*x\"", "has a single \". Remove it");
  expect_refused("    File: C:\\new\\foot.step", "Write File: \"C:/new/foot.step\"");
  expect_refused("    File: \"C:\\new\\foot.step\"", "Write File: \"C:/new/foot.step\"");
  expect_refused("    Side: *foot", "is an anchor of YAML, which no deck has");
  expect_refused("    Side: ${SIDE}", "${SIDE} is not replaced by a value");
  expect_refused("    X = \"t < 1 ? 0 : t\"", "lacks a colon with a blank behind it. Write X: \"t < 1 ? 0 : t\"");
  expect_refused("    \"Side: foot", "the quote at the beginning of \"Side: foot does not close");
}

TEST_F(YamlDeck, WithoutACommaIsToldWhere)
{
  expect_refused(
      "    Side: {X: 0.0 Y: 1}",
      "\"Contact->Side->X\" = 0.0 Y: 1 holds another entry, \"Y\": a comma is missing before it, or a new line. "
      "Write X: 0.0, Y: 1 in { }, or each on its own line.");
  expect_refused("    Side: a Gap: 1", "holds another entry, \"Gap\"");
  expect_refused("    Cells: [1, 2],", "\",\" stands behind the end of \"Contact->Cells\". Remove it");
  expect_refused("    Side: {Y: -2*max(x, 1)}", "needs quotes: write \"-2*max(x, 1)\"");
  expect_refused("    Upper: {2.0, 1.0}", "has no names. Write Upper: [2.0, 1.0] for a list of numbers.");
  expect_refused("    Y: {-2*x}", "has no names. Write Y: \"-2*x\" for a value.");
}

TEST_F(YamlDeck, HasLettersOfAllLanguagesInCommentsNamesAndTexts)
{
  const auto list =
      read("deck: # Bock für die Prüfung\n  Dirichlet:\n    Außen: {X: 0.0}\n  Contact: {Side: 接触面, Gap: \"ü\"}\n");
  EXPECT_EQ(list.sublist("Dirichlet").sublist("Außen").get<double>("X"), 0);
  EXPECT_EQ(list.sublist("Contact").get<std::string>("Side"), "接触面");
  EXPECT_EQ(list.sublist("Contact").get<std::string>("Gap"), "ü");
  for (const std::string name : {"a~~4Z~~1ä", "~~41é", "~~~ö~~"})
    EXPECT_TRUE(read("deck:\n  " + name + ": {X: 0.0}\n").isSublist(name)) << name;
  expect_refused("\u00a0\u00a0\u00a0\u00a0Side: foot", "a blank that does not break lines");
}

TEST_F(YamlDeck, EndsItsLinesAsAnySystemDoes)
{
  for (const char *const text : {"deck:\r\n  Side: foot\r\n  Gap: 1.5\r\n", "deck:\r  Side: foot\r  Gap: 1.5\r"}) {
    const auto list = read(text);
    EXPECT_EQ(list.get<std::string>("Side"), "foot");
    EXPECT_EQ(list.get<double>("Gap"), 1.5);
  }
}

TEST_F(YamlDeck, InUtf16IsToldToBeSavedAnew)
{
  expect_error(ExitCode::bad_input, {"is written in UTF-16. Save it as UTF-8"},
               [&] { read(std::string("\xFF\xFE") + std::string("d\0:\0", 4)); });
}

TEST_F(YamlDeck, OfAnotherProgramIsToldWhich)
{
  expect_error(ExitCode::bad_input, {"line 1: \"*Heading\"", "Abaqus"}, [&] { read("*Heading\n*Node\n1, 0., 0.\n"); });
}

} // namespace
} // namespace yaml_deck_test

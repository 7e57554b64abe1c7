// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/deck.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/io/expression.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <string>

namespace deck_refusals_test
{
namespace
{

using rpc::ExitCode;
using rpc::test::error_of;
using rpc::test::expect_error;

const std::string xml = R"xml(<?xml version="1.0"?>
<!-- a beam -->
<ParameterList name="beam">
  <ParameterList name="Mesh">
    <Parameter name="Cells" type="Array(int)" value="{160, 32}"/>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Gap" type="string" value="0.1"/>
  </ParameterList>
</ParameterList>
)xml";

const std::string yaml = R"yaml(beam:
  Mesh:
    Cells: [160, 32]   # a comment
    Lower: [0.0,
            0.0]
  Contact: {Side: bottom, Gap: "x, y: {1"}
  Material:
    Poisson's Ratio: 0.3
)yaml";

class Refusal : public testing::Test
{
protected:
  void expect_replaced(std::string text, const std::string &extension, const std::string &from, const std::string &to,
                       const int line, const std::string &part) const
  {
    SCOPED_TRACE(to);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    scratch_.write("deck" + extension, text);
    const std::string path = scratch_.path("deck" + extension);
    const std::string place = "deck: \"" + path + "\", line " + std::to_string(line) + ": ";
    expect_error(ExitCode::bad_input, {place, part}, [&] { rpc::io::read_deck(path, *Tpetra::getDefaultComm()); });
  }
  void expect_xml(const std::string &from, const std::string &to, const int line, const std::string &part) const
  {
    expect_replaced(xml, ".xml", from, to, line, part);
  }
  void expect_yaml(const std::string &from, const std::string &to, const int line, const std::string &part) const
  {
    expect_replaced(yaml, ".yaml", from, to, line, part);
  }

  rpc::test::Scratch scratch_{*Tpetra::getDefaultComm()};
};

TEST_F(Refusal, OfTagsSaysWhatIsOpen)
{
  const std::string side = "\"bottom\"/>", end_of_mesh = "  </ParameterList>\n  <ParameterList name=\"Contact\">";
  expect_xml(side, "\"bottom\">", 8,
             "<Parameter name=\"Side\"> is not closed when </ParameterList> of line 10 comes. End it with \"/>\".");
  expect_xml(
      end_of_mesh, "  <ParameterList name=\"Contact\">", 11,
      "the file ends while <ParameterList name=\"beam\"> of line 3 is open. Write </ParameterList> where it ends. "
      "By the indentation it is <ParameterList name=\"Mesh\"> of line 4 that is not closed.");
  expect_xml(
      end_of_mesh, "  </Parameter>\n  <ParameterList name=\"Contact\">", 6,
      "</Parameter> does not close what is open, <ParameterList name=\"Mesh\"> of line 4. Write </ParameterList>.");
  expect_xml("</ParameterList>\n</ParameterList>", "</ParameterList>\n</ParameterList></ParameterList>", 11,
             "closes nothing");
  expect_xml("</ParameterList>\n</ParameterList>", "</ParameterList>\n</ParameterList>\n<ParameterList/>", 12,
             "begins behind the end");
  expect_xml(
      "<ParameterList name=\"Contact\">", "<parameterList name=\"Contact\">", 10,
      "does not close what is open, <parameterList name=\"Contact\"> of line 7. Did you mean \"ParameterList\"?");
  expect_xml("<!-- a beam -->", "<!-- a beam", 2, "the comment that begins here does not end. Write -->");
  for (const std::string broken : {"<!- a beam ->", "<!- a beam -->", "<! -- a beam -->", "<!a beam>"})
    expect_xml("<!-- a beam -->", broken, 2, "is no comment and no tag. Write a comment as <!-- ... -->.");
  expect_xml("<!-- a beam -->", "<!-- a beam ->\n<!-- more -->", 2,
             "the comment that begins here does not end before the next one, of line 3. Write -->");
  expect_xml("<Parameter name=\"Side\"", "<Paramter name=\"Side\"", 8, "Did you mean \"Parameter\"?");
  expect_xml("<Parameter name=\"Side\" type=\"string\" value=\"bottom\"/>", "<Side>bottom</Side>", 8,
             "Write <Parameter name=\"Side\" type=\"string\" value=\"bottom\"/>.");
  expect_xml("<ParameterList name=\"Mesh\">", "<ParameterList name=\"Mesh\">\n    a word", 5,
             "\"a word\" stands between tags");
  expect_xml("<ParameterList name=\"Mesh\">", "<ParameterList>", 4, "<ParameterList> in the deck has no name");
  expect_xml("<ParameterList name=\"Mesh\">", "<ParameterList name=\"Mesh\"", 4, "does not end before the next tag");
}

TEST_F(Refusal, OfAttributesSaysWhatToWrite)
{
  expect_xml("value=\"bottom\"", "value=bottom", 8, "value=bottom has no quotes. Write value=\"bottom\".");
  expect_xml("value=\"bottom\"", "value=bottom\"", 8, "value=bottom\" lacks its first quote. Write value=\"bottom\".");
  expect_xml("value=\"bottom\"", "value=\u201cbottom\u201d", 8, "typographic quotes. Write value=\"bottom\".");
  expect_xml("value=\"bottom\"", "value=\"bottom", 8, "the quote of value=\"bottom/> does not close");
  expect_xml("value=\"0.1\"", "value=\"x<2 ? x : 0\"", 9, "Write value=\"x&lt;2 ? x : 0\".");
  expect_xml("value=\"0.1\"", "value=\"x > 2 && y > 1\"", 9, "is written &amp;");
  expect_xml("type=\"string\" value=\"bottom\"", "typ=\"string\" value=\"bottom\"", 8, "write type=\"string\"");
  expect_xml("type=\"string\" value=\"bottom\"", "type=\"string\" unit=\"mm\" value=\"bottom\"", 8,
             "\"Contact->Side\" has unit=\"mm\", which is not read. Remove it: numbers count in the deck's units");
  expect_xml("type=\"string\" value=\"bottom\"", "value=\"bottom\"", 8,
             "\"Contact->Side\" has no type=. Write type=\"string\".");
  expect_xml("type=\"string\" value=\"bottom\"", "type=\"sting\" value=\"bottom\"", 8, "Did you mean \"string\"?");
  expect_xml("type=\"string\" value=\"bottom\"", "type=\"double\" value=\"bottom\"", 8,
             "For a word write type=\"string\".");
  expect_xml("type=\"string\" value=\"0.1\"", "type=\"double\" value=\"0,1\"", 9,
             "Write 0.1: decks have a decimal point.");
  expect_xml("type=\"string\" value=\"0.1\"", "type=\"double\" value=\"x^2\"", 9,
             "For an expression write type=\"string\".");
  expect_xml("value=\"{160, 32}\"", "value=\"160 32\"", 5, "Write {160, 32}");
}

TEST_F(Refusal, OfAValueKnowsWhatIsWanted)
{
  Teuchos::ParameterList valid("deck");
  valid.sublist("Contact").set("Side", "", "Side.");
  rpc::set_field(valid.sublist("Contact"), "Gap", "0", "Gap [m].");
  valid.sublist("Contact").set("Penalty", 1., "r > 0 [Pa/m].");
  const auto refused = [&](const std::string &parameter, const std::string &part) {
    SCOPED_TRACE(parameter);
    scratch_.write("a.xml", "<ParameterList><ParameterList name=\"Contact\">\n" + parameter +
                                "\n</ParameterList></ParameterList>");
    expect_error(ExitCode::bad_input, {"line 2: ", part},
                 [&] { rpc::io::read_deck(scratch_.path("a.xml"), *Tpetra::getDefaultComm(), valid); });
  };
  refused(R"(<Parameter name="Gap" type="double" value="5 N"/>)",
          "\"N\" is a unit of force, where a length is wanted [m]");
  refused(R"(<Parameter name="Gap" type="double" value="1/3"/>)", "0.3333333333: or in XML type=\"string\"");
  refused(R"(<Parameter name="Penalty" type="double" value="1/3"/>)",
          "this parameter takes a number, not an expression");
  refused(R"(<Parameter name="Penalty" type="double" value="x^2"/>)", "this parameter takes no expressions");
  expect_error(ExitCode::bad_input, {"\"Contact->Gap\"", "a unit of force, where a length is wanted"},
               [&] { rpc::io::field_parser(valid)("5 N", "Contact->Gap"); });
}

TEST_F(Refusal, OfYamlNamesTheLine)
{
  expect_yaml("    Cells", "\tCells", 3, "a tab stands before \"Cells: [160, 32]   # a comment\"");
  expect_yaml("    Lower", "   Lower", 4, "\"Lower\" is indented by 3 blanks, the entries above it in \"Mesh\" by 4");
  expect_yaml("    Lower", "     Lower", 4, "\"Lower: [0.0,\" is indented by 5 blanks, more than the value above it");
  expect_yaml("Cells: [", "Cells [", 3, "lacks a colon with a blank behind it. Write Cells: [160, 32]");
  expect_yaml("Cells: [", "Cells:[", 3, "Write Cells: [160, 32]");
  expect_yaml("Cells: [160, 32]", "Cells = 160", 3, "Write Cells: 160");
  expect_yaml("32]", "32", 3, "the \"[\" of \"Mesh->Cells\" is not closed");
  expect_yaml("32]", "32}", 3, "\"}\" does not close what is open, the \"[\" of \"Mesh->Cells\" of line 3. Write ].");
  expect_yaml("Gap: \"x, y: {1\"", "Gap: 0,3", 6, "For a decimal comma write a point: 0.3.");
  expect_yaml("Contact: {Side: bottom, Gap: \"x, y: {1\"}", "Element P2", 6, "Write Element: P2");
  expect_yaml("beam:", "<ParameterList>\nbeam:", 1, "name the file .xml");
  expect_yaml("beam:\n  Mesh:", "  Mesh:", 1, "Write the name of the outermost list above it, such as deck:");
  expect_yaml("Cells: [160, 32]", "- Cells: 160", 3, "A list of parameters has none: write Cells: 160");
  expect_yaml("Gap: \"x, y: {1\"", "Gap: 3 %", 6,
              "\"Contact->Gap\" = 3 % has a %, which no deck has outside of quotes. Write "
              "the number alone, without \"%\": 0.03.");
  expect_yaml("Cells: [", "Cells [mm]: [", 3, "has a unit in its name. Write Cells: [160, 32]");
  expect_yaml("Contact: {Side", "Contact {Side", 6,
              "lacks a colon with a blank behind it. Write Contact: {Side: bottom");
}

TEST_F(Refusal, OfAFileOfAnotherProgramNamesTheProgram)
{
  for (const auto &[text, part] :
       {std::pair("*HEADING\n*NODE\n", "Abaqus"), std::pair("beam:\n  Mesh:\n", "name the file .yaml"),
        std::pair("{\"Mesh\": {}}", "JSON"), std::pair("$MeshFormat\n2.2 0 8\n", "Mesh->File"),
        std::pair("ISO-10303-21;\n", "STEP"), std::pair("/PREP7\nET,1,182\n", "ANSYS")})
    expect_replaced(xml, ".xml", xml, text, 1, part);
}

TEST_F(Refusal, HasThePlaceOfTheParameter)
{
  scratch_.write("a.xml", xml);
  scratch_.write("a.yaml", yaml);
  const std::string of_xml = scratch_.path("a.xml"), of_yaml = scratch_.path("a.yaml");
  const auto placed = [](const std::string &message, const std::string &path,
                         const std::vector<std::string> &assigned = {}) {
    return rpc::io::with_place("deck: " + message, path, assigned);
  };
  EXPECT_EQ(placed("\"Contact->Gap\" is bad", of_xml), "deck: \"" + of_xml + "\", line 9: \"Contact->Gap\" is bad");
  EXPECT_EQ(placed("unknown \"Contact->Gaap\"", of_xml), "deck: \"" + of_xml + "\", line 7: unknown \"Contact->Gaap\"");
  EXPECT_EQ(placed("\"Time\" is bad", of_xml), "deck: \"" + of_xml + "\": \"Time\" is bad");
  EXPECT_EQ(placed("\"Contact->Gap\" is bad", of_yaml), "deck: \"" + of_yaml + "\", line 6: \"Contact->Gap\" is bad");
  EXPECT_EQ(placed("\"Material->Poisson's Ratio\"", of_yaml),
            "deck: \"" + of_yaml + "\", line 8: \"Material->Poisson's Ratio\"");
  EXPECT_EQ(placed("\"Mesh->Lower\"", of_yaml), "deck: \"" + of_yaml + "\", line 4: \"Mesh->Lower\"");
  for (const std::string same : {"deck: \"Contact->Gap\" is bad", "mesh: \"Contact->Gap\"", "deck: bad"})
    EXPECT_EQ(rpc::io::with_place(same, of_xml, {"Contact->Gap=3"}), same);
  EXPECT_EQ(placed("\"Contact\" is bad", scratch_.path("gone.xml")), "deck: \"Contact\" is bad");
}

TEST(ExpressionRefusal, SaysWhatToWrite)
{
  for (const auto &[text, part] :
       {std::pair("16 MPa", "16000000 with m and N, 16 with mm and N"), std::pair("16,5", "Write 16.5"),
        std::pair("-20,5*sin(x)", "write a point: 20.5"), std::pair("2*x**2", "Powers are written ^"),
        std::pair("Sin(x)", "Did you mean \"sin\"?"), std::pair("2*X", "Did you mean \"x\"?"),
        std::pair("np.sin(x)", "Leave out \"np.\""), std::pair("2*time", "For \"time\" write t."),
        std::pair("pow(x, 2)", "a^b"), std::pair("\u22122*x", "minus of a keyboard"),
        std::pair("2*(x+1", "A \")\" is missing"), std::pair("2x+1", "Products are written *"),
        std::pair("", "remove the parameter")})
    expect_error(ExitCode::bad_input, {"\"Contact->Gap\"", part}, [&] { rpc::io::parse_field(text, "Contact->Gap"); });
}

} // namespace
} // namespace deck_refusals_test

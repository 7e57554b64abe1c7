// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/deck.hpp"

#include "rpc/core/error.hpp"
#include "scratch.hpp"

#include <Teuchos_Array.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <regex>
#include <stdlib.h>

namespace deck_test
{
namespace
{

using rpc::ExitCode;
using rpc::test::error_of;
using rpc::test::expect_error;
using Teuchos::Array;
using Teuchos::ParameterList;

const char *const good_xml = R"xml(<ParameterList name="rpc">
  <!-- a comment -->
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="box"/>
    <Parameter name="Upper" type="Array(double)" value="{5, 1.0}"/>
    <Parameter name="Cells" type="Array(int)" value="{160, 32}"/>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Yield Stress" type="string" value="x &lt; 1 ? 2 : inf"/>
    <Parameter name="Penalty" type="double" value="1e8"/>
    <Parameter name="On" type="bool" value="true"/>
  </ParameterList>
</ParameterList>
)xml";

const char *const good_yaml = R"yaml(# a comment
rpc:
  Mesh:
    Type: box
    Upper: [5, 1.0]
    Cells: [160, 32]
  Contact:
    Yield Stress: "x < 1 ? 2 : inf"
    Penalty: 1e8
    On: true
)yaml";

ParameterList read_deck(const std::string &path)
{
  return rpc::io::read_deck(path, *Tpetra::getDefaultComm());
}

std::string find_deck(const std::string &name)
{
  return rpc::io::find_deck(name, *Tpetra::getDefaultComm());
}

class Deck : public testing::Test
{
protected:
  /// Written by rank 0; collective.
  std::string file(const std::string &name, const std::string &text) const
  {
    comm_->barrier(); // nobody reads an older one any more
    if (comm_->getRank() == 0) scratch_.write(name, text);
    return scratch_.path(name);
  }
  /// Expects a refusal in one line that starts with the path, and holds `part`.
  void expect_refusal(const std::string &name, const std::string &text, const std::string &part) const
  {
    const std::string path = file(name, text);
    expect_error(ExitCode::bad_input, part, [&] { read_deck(path); });
    const std::string message = error_of([&] { read_deck(path); }).what();
    EXPECT_EQ(message.rfind("deck: \"" + path + "\"", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.find(".cpp"), std::string::npos) << message;
    EXPECT_EQ(message.find("Throw"), std::string::npos) << message;
  }
  static std::string replaced(std::string text, const std::string &from, const std::string &to)
  {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  /// The same deck without its root's name.
  static std::string unindented(const std::string &yaml)
  {
    return std::regex_replace(replaced(yaml, "rpc:\n", ""), std::regex("\n  "), "\n");
  }

  rpc::RCP<const rpc::Comm> comm_ = Tpetra::getDefaultComm();
  rpc::test::Scratch scratch_{*comm_};
};

void expect_good(const Teuchos::ParameterList &list)
{
  const auto &mesh = list.sublist("Mesh"), &contact = list.sublist("Contact");
  EXPECT_EQ(mesh.get<std::string>("Type"), "box");
  EXPECT_EQ(mesh.get<Array<double>>("Upper"), Array<double>(Teuchos::tuple(5., 1.)));
  EXPECT_EQ(mesh.get<Array<int>>("Cells"), Array<int>(Teuchos::tuple(160, 32)));
  EXPECT_EQ(contact.get<std::string>("Yield Stress"), "x < 1 ? 2 : inf");
  EXPECT_EQ(contact.get<double>("Penalty"), 1e8);
  EXPECT_TRUE(contact.get<bool>("On"));
}

TEST_F(Deck, XmlRootMayHaveANameOrNot)
{
  expect_good(read_deck(file("a.xml", good_xml)));
  expect_good(read_deck(file("b.xml", replaced(good_xml, " name=\"rpc\"", ""))));
}

TEST_F(Deck, YamlRootMayHaveANameOrNot)
{
  expect_good(read_deck(file("a.yaml", good_yaml)));
  expect_good(read_deck(file("a.YML", good_yaml)));
  expect_good(read_deck(file("b.yaml", unindented(good_yaml)))); // Teuchos itself loses Mesh here
  const std::string with_markers = "%YAML 1.1\n---\nMesh:\n  Type: box\n\nE: 2.5\nContact:\n  Penalty: 1\n...\n";
  const auto list = read_deck(file("c.yaml", with_markers));
  EXPECT_EQ(list.sublist("Mesh").get<std::string>("Type"), "box");
  EXPECT_EQ(list.get<double>("E"), 2.5);
  EXPECT_EQ(list.sublist("Contact").get<int>("Penalty"), 1);
}

TEST_F(Deck, YamlNeedsNoFinalNewline)
{
  EXPECT_EQ(read_deck(file("a.yaml", "rpc:\n  Mesh:\n    Type: box")).sublist("Mesh").get<std::string>("Type"), "box");
}

TEST_F(Deck, AnyTruncatedXmlIsRefused)
{
  const std::string whole = good_xml;
  const std::size_t end = whole.rfind('>');
  for (std::size_t length = 0; length <= end; length += 7) expect_refusal("t.xml", whole.substr(0, length), ": ");
  expect_refusal("t.xml", whole.substr(0, end), ": ");
  expect_refusal("t.xml", whole.substr(0, whole.find("  <ParameterList name=\"Contact\"")),
                 "line 8: the file ends while <ParameterList name=\"rpc\"> of line 1 is open");
}

TEST_F(Deck, MalformedXmlIsRefusedWithItsLine)
{
  expect_refusal("m.xml", replaced(good_xml, "</ParameterList>", "</ParamList>"),
                 "line 7: </ParamList> does not close what is open");
  expect_refusal("m.xml", std::string(good_xml) + "<ParameterList/>",
                 "behind the end of the deck, which is one <ParameterList>");
  expect_refusal("m.xml", "hello", "line 1");
  expect_refusal("m.xml", "<Foo/>", "line 1: expected tag ParameterList first, got <Foo>");
  expect_refusal("m.xml", replaced(good_xml, "<Parameter ", "<Paramete "), "line 4: a deck has no tag <Paramete>");
  expect_refusal("m.xml", replaced(good_xml, " value=\"box\"", ""), "line 4: \"Mesh->Type\" has no value=");
  expect_refusal("m.xml", replaced(good_xml, " type=\"string\"", " type=\"strin\""),
                 "\"Mesh->Type\" has the unknown type \"strin\"");
}

TEST_F(Deck, ValueMustReadAsItsType)
{
  expect_refusal("v.xml", replaced(good_xml, "1e8", "1e8 Pa"),
                 "\"Contact->Penalty\" = \"1e8 Pa\" does not read as double");
  expect_refusal("v.xml", replaced(good_xml, "1e8", ""), "\"Contact->Penalty\"");
  expect_refusal("v.xml", replaced(good_xml, "{160, 32}", "{160, 3.2}"),
                 "\"Mesh->Cells\" = \"{160, 3.2}\" does not read as Array(int)");
  expect_refusal("v.xml", replaced(good_xml, "{160, 32}", "{160, 32"), "\"Mesh->Cells\"");
  expect_refusal("v.xml", replaced(good_xml, "{160, 32}", "{160,, 32}"), "\"Mesh->Cells\"");
  expect_refusal("v.xml", replaced(good_xml, "{160, 32}", "{160, 99999999999}"), "\"Mesh->Cells\"");
  expect_refusal("v.xml", replaced(good_xml, "{5, 1.0}", "{5, l.0}"), "\"Mesh->Upper\"");
  expect_refusal("v.xml", replaced(good_xml, "\"true\"", "\"maybe\""),
                 "\"Contact->On\" = \"maybe\" does not read as bool");
}

TEST_F(Deck, DoubleInfArrivesAsText)
{
  const auto list = read_deck(file("i.xml", replaced(good_xml, "1e8", "inf"))); // Teuchos itself reads 0
  EXPECT_EQ(list.sublist("Contact").get<std::string>("Penalty"), "inf");
}

TEST_F(Deck, YamlsInfinityArrivesAsText)
{
  const std::vector<std::pair<std::string, std::string>> cases = {
      {".inf", "inf"},         {".Inf", "inf"},     {".INF", "inf"},
      {"+.inf", "+inf"},       {"-.inf", "-inf"},   {"-.INF", "-inf"},
      {".inf # rigid", "inf"}, {".inf  \r", "inf"}, {"\"a, .inf\"", "a, .inf"},
      {"'a: .inf'", "a: .inf"}};
  for (const auto &[text, value] : cases) {
    const auto list = read_deck(file("i.yaml", replaced(good_yaml, "1e8", text)));
    EXPECT_EQ(list.sublist("Contact").get<std::string>("Penalty"), value) << text;
  }
  const auto flow = read_deck(file("f.yaml", "rpc:\n  Contact: {Penalty: .inf, Side: \"it's .inf, \"}\n"));
  EXPECT_EQ(flow.sublist("Contact").get<std::string>("Penalty"), "inf");
  EXPECT_EQ(flow.sublist("Contact").get<std::string>("Side"), "it's .inf, ");
  const auto last = read_deck(file("l.yaml", "Young's Modulus: 1\nYield Stress: .inf"));
  EXPECT_EQ(last.get<std::string>("Yield Stress"), "inf");
  const auto name = read_deck(file("n.yaml", "rpc:\n  A: x.inf\n  B: a .inf\n"));
  EXPECT_EQ(name.get<std::string>("A"), "x.inf");
  EXPECT_EQ(name.get<std::string>("B"), "a .inf");
  const auto xml =
      read_deck(file("x.xml", replaced(replaced(good_xml, "1e8", ".inf"), "type=\"double\"", "type=\"string\"")));
  EXPECT_EQ(xml.sublist("Contact").get<std::string>("Penalty"), ".inf"); // XML has no such number
}

TEST_F(Deck, NameGivenTwiceIsRefused)
{
  const std::string type = "<Parameter name=\"Type\" type=\"string\" value=\"box\"/>";
  expect_refusal("d.xml", replaced(good_xml, type, type + type), "\"Mesh->Type\" is given twice");
  expect_refusal("d.xml", replaced(good_xml, "\"Contact\"", "\"Mesh\""), "\"Mesh\" is given twice");
  expect_refusal("d.yaml", replaced(good_yaml, "    Type: box\n", "    Type: box\n    Type: box\n"),
                 "line 5: \"Mesh->Type\" is given twice, first in line 4");
  expect_refusal("d.yaml", replaced(good_yaml, "Contact", "Mesh"), "\"Mesh\" is given twice");
  const std::string twice = unindented(replaced(good_yaml, "Contact", "Mesh"));
  expect_refusal("d.yaml", twice, "\"Mesh\" is given twice");
  EXPECT_EQ(std::string(error_of([&] { read_deck(file("d.yaml", twice)); }).what()).find("ANONYMOUS"),
            std::string::npos);
}

TEST_F(Deck, ListsWithinListsHaveABound)
{
  const auto nested = [](const int depth, const std::string &open, const std::string &close) {
    std::string text;
    for (int n = 0; n < depth; ++n) text += open;
    for (int n = 0; n < depth; ++n) text += close;
    return text;
  };
  const std::string open = "<ParameterList name=\"a>\">", close = "</ParameterList>";
  EXPECT_NO_THROW(read_deck(file("d.xml", nested(100, open, close))));
  for (const int depth : {101, 20000}) expect_refusal("d.xml", nested(depth, open, close), "deeper than 100");
  expect_refusal("d.yaml", "a: " + nested(20000, "{a: ", "}"), "deeper than 100");
  const std::string many = nested(200, "", "<Parameter name=\"a\" type=\"int\" value=\"1\"/>");
  expect_refusal("d.xml", "<!-- 0 < x < 1 -->" + open + many + close, "given twice");
}

TEST_F(Deck, MalformedYamlIsRefusedWithItsLine)
{
  const std::string bad = replaced(good_yaml, "[160, 32]", "[160, 32");
  expect_refusal("m.yaml", bad, "line 6: the \"[\" of \"Mesh->Cells\" is not closed");
  expect_refusal("m.yaml", unindented(bad), "line 5: the \"[\" of \"Mesh->Cells\" is not closed");
  expect_refusal("m.yaml", replaced(good_yaml, "\"x < 1 ? 2 : inf\"", "x > 1 ? 2 : inf"), "needs quotes");
  for (const char *text : {"", " \n"}) expect_refusal("m.yaml", text, "is empty");
  for (const char *text : {"---\n", "# a comment\n", "beam: 3\n"})
    expect_refusal("m.yaml", text, "it has no list of parameters. Write its name, such as deck:");
  expect_refusal("m.yaml", "- 1\n- 2\n", "line ");
  expect_refusal("m.yaml", "rpc:\n  Mesh: \"bo", "line ");
  expect_refusal("m.yaml", "just text", "line ");
}

TEST_F(Deck, UnreadableFileIsRefused)
{
  for (const char *extension : {".xml", ".yaml"})
    expect_error(ExitCode::bad_input, "No such file", [&] { read_deck(scratch_.path("none") + extension); });
  if (comm_->getRank() == 0) std::filesystem::create_directory(scratch_.path("folder.xml"));
  expect_error(ExitCode::bad_input, "Is a directory", [&] { read_deck(scratch_.path("folder.xml")); });
}

TEST_F(Deck, IsReadFromTheDiskOfRankZero)
{
  const bool root = comm_->getRank() == 0;
  const std::string here = file("own.xml", good_xml), nowhere = scratch_.path("none.xml");
  expect_good(read_deck(root ? here : nowhere));
  EXPECT_EQ(find_deck(root ? here : nowhere), here);
  expect_error(ExitCode::bad_input, {nowhere, "No such file"}, [&] { read_deck(root ? nowhere : here); });
  expect_error(ExitCode::bad_input, {nowhere, "there is no file"}, [&] { find_deck(root ? nowhere : here); });
}

TEST_F(Deck, IsLookedUpAsGivenThenInTheInputFolders)
{
  const std::string path = file("own.xml", good_xml);
  EXPECT_EQ(find_deck(path), path);
  ::setenv("RPC_INPUT_DIR", scratch_.folder().c_str(), 1);
  EXPECT_EQ(find_deck("own.xml"), path);
  ::unsetenv("RPC_INPUT_DIR");
  const std::string message = error_of([] { find_deck("own.xml"); }).what();
  for (const char *part : {"\"own.xml\"", "/input/own.xml", "/share/rpc/input/own.xml"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  expect_error(ExitCode::bad_input, "there is no file", [&] { find_deck(scratch_.folder()); });
}

} // namespace
} // namespace deck_test

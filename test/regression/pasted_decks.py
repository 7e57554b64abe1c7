# SPDX-License-Identifier: BSD-3-Clause
"""Decks as they come from other programs, editors and languages: pasted lines, wrong nesting, marks of encodings, paths of Windows, decimal commas,
numbers that are none. Each is read, or refused in one line that names the place and the remedy. test/stress/bad_decks.py has slips of the finger."""

import unittest

from rpc_run import RpcTestCase, run_all

XML = """<ParameterList name="a">
  <ParameterList name="Mesh">
    <Parameter name="Lower" type="Array(double)" value="{0, 0}"/>
    <Parameter name="Upper" type="Array(double)" value="{2, 1}"/>
    <Parameter name="Cells" type="Array(int)" value="{8, 4}"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="left">
      <Parameter name="X" type="double" value="0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Traction">
    <ParameterList name="top">
      <Parameter name="Y" type="double" value="-2"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Yield Stress" type="double" value="5"/>
  </ParameterList>
</ParameterList>
"""
YAML = """deck:
  Mesh:
    Lower: [0.0, 0.0]
    Upper: [2.0, 1.0]
    Cells: [8, 4]
  Material:
    Young's Modulus: 1000.0
    Poisson's Ratio: 0.3
  Dirichlet:
    left: {X: 0.0}
  Traction:
    top: {Y: -2.0}
  Contact:
    Side: bottom
    Yield Stress: 5.0
"""
BOX = "    Lower: [0.0, 0.0]\n    Upper: [2.0, 1.0]\n    Cells: [8, 4]\n"
XML_BOX = XML[XML.index("    <Parameter"):XML.index("  </ParameterList>")]
XML_GMSH = """<Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="C:\\parts\\foot.step"/>
"""
GMSH = "    Type: gmsh\n    File: "
GOOD = None


def x(old, new):
    assert old in XML, old
    return "xml", XML.replace(old, new, 1)


def y(old, new):
    assert old in YAML, old
    return "yaml", YAML.replace(old, new, 1)


# A name, (ending, text), the line of the mistake (None: none is told), and a part of the message; GOOD where the deck is read.
DECKS = [
    ("Abaqus", ("xml", "*Heading\n*Node\n1, 0., 0.\n"), 1, "gmsh body.inp -save -o body.msh"),
    ("Abaqus in YAML", ("yaml", "*Heading\n*Node\n1, 0., 0.\n"), 1, "gmsh body.inp -save -o body.msh"),
    ("lines of Abaqus", x('  <ParameterList name="Material">', '*ELASTIC\n210000., 0.3\n  <ParameterList name="Material">'), 7, "stands between tags"),
    ("lines of Abaqus in YAML", y("  Material:", "*ELASTIC\n210000., 0.3\n  Material:"), 6, "Abaqus"),
    ("list in a value", y("    Side: bottom\n    Yield Stress: 5.0", "    Yield Stress:\n      Side: bottom"), 14, "write them beside it"),
    ("list in another", ("yaml", YAML.replace("  Material:\n    Young's Modulus: 1000.0\n    Poisson's", "    Material:\n      Young's Modulus: 1000.0\n      Poisson's")), 6,
     'close "Mesh" before it'),
    ("no list", y("    left: {X: 0.0}", "    left: fixed"), 10, "in YAML left: {X: ..., Y: ...}"),
    ("items", y("    left: {X: 0.0}", "    - left: {X: 0.0}"), 10, "write left: {X: 0.0}"),
    ("tabs", ("yaml", YAML.replace("  ", "\t")), 2, "write two for each level"),
    ("tab behind a colon", y("Side: bottom", "Side:\tbottom"), 0, GOOD),
    ("mark of UTF-8", ("xml", "\ufeff" + XML), 0, GOOD),
    ("UTF-16", ("xml", XML.encode("utf-16")), None, "Save it as UTF-8"),
    ("UTF-16 in YAML", ("yaml", YAML.encode("utf-16")), None, "Save it as UTF-8"),
    ("comment in Latin 1", ("yaml", (YAML + "  # Auflager für Bock\n").encode("latin-1")), 0, GOOD),
    ("name of another language", y("Side: bottom", "Side: Außen"), 14, 'the side "Außen"'),
    ("lines of Windows", ("xml", XML.replace("\n", "\r\n")), 0, GOOD),
    ("lines of Windows and a slip", ("yaml", YAML.replace("Side:", "Sied:").replace("\n", "\r\n")), 14, 'Did you mean "Side"?'),
    ("lines of an old Mac", ("yaml", YAML.replace("\n", "\r")), 0, GOOD),
    ("path of Windows", y(BOX, GMSH + "C:\\parts\\foot.step\n"), 4, 'Write File: "C:/parts/foot.step"'),
    ("path of Windows in quotes", y(BOX, GMSH + '"C:\\parts\\foot.step"\n'), 4, 'Write File: "C:/parts/foot.step"'),
    ("path of Windows in XML", ("xml", XML.replace(XML_BOX, XML_GMSH)), 4, "below WSL /mnt/c/parts/foot.step"),
    ("commas of decimals in a list", y("[2.0, 1.0]", "[2,0, 1,0]"), 4, "with decimal points"),
    ("commas and semicolons", x("{2, 1}", "{2,5; 1,0}"), 4, "Write {2.5, 1}"),
    ("comma of a decimal", y("{X: 0.0}", "{X: 0,5}"), 10, "write a point: 0.5"),
    ("thousands of Germany", y("1000.0", "210.000,0"), 7, "Write 210000"),
    ("thousands with a blank", y("1000.0", "210 000"), 7, "Write 210000"),
    ("Fortran", y("1000.0", "2.1d5"), 7, "Write 210000"),
    ("hexadecimal", y("1000.0", "0x3e8"), 7, "Write 1000"),
    ("list twice", x('  <ParameterList name="Traction">', '  <ParameterList name="Material">\n  </ParameterList>\n  <ParameterList name="Traction">'), 16, "given twice"),
    ("list twice in YAML", ("yaml", YAML + "  Mesh:\n    Cells: [4, 2]\n"), 16, "first in line 2"),
    ("small letters", ("yaml", YAML.lower()), 2, 'Did you mean "Mesh"?'),
    ("tags in small letters", ("xml", XML.replace("ParameterList", "parameterlist")), 1, 'Did you mean "ParameterList"?'),
    ("list as a text", y("[2.0, 1.0]", '"[2.0, 1.0]"'), 4, "in YAML [2, 1]"),
    ("list in braces", y("[2.0, 1.0]", "{2.0, 1.0}"), 4, "Write Upper: [2.0, 1.0]"),
    ("list in parentheses", y("[2.0, 1.0]", "(2.0, 1.0)"), 4, "in YAML [2, 1]"),
    ("list without commas", y("[2.0, 1.0]", "[2.0 1.0]"), 4, "in YAML [2, 1]"),
    ("list with a comma too many", y("[2.0, 1.0]", "[2.0, 1.0],"), 4, "Remove it"),
    ("units in a list", y("[2.0, 1.0]", "[2.0 mm, 1.0 mm]"), 4, "Write numbers alone"),
    ("units are no list", ("yaml", YAML + "  Units: SI\n"), 16, "in YAML Units: {Length: ..., Force: ...}"),
    ("unit of stress", ("yaml", YAML + "  Units: {Length: mm, Stress: MPa}\n"), 16, "write Length and Force alone"),
    ("unit in a name", y("Yield Stress: 5.0", "Yield Stress [MPa]: 5.0"), 15, "Write Yield Stress: 5.0"),
    ("unit as an attribute", x('value="1000"', 'value="1000" unit="MPa"'), 8, "which is not read"),
    ("not a number", y("0.3", ".nan"), 8, "Write a number"),
    ("too large", x('value="1000"', 'value="1e400"'), 8, "Write a number of at most"),
    ("too large in YAML", y("1000.0", "1e400"), 7, "Write a number of at most"),
    ("negative size", y("[2.0, 1.0]", "[-2.0, 1.0]"), 4, 'must be above "Mesh->Lower"'),
    ("no cells", y("[8, 4]", "[8, 0]"), 5, "must be > 0"),
    ("cells with points", y("[8, 4]", "[8.0, 4.0]"), 5, "in YAML [8, 4]"),
    ("more cells than integers", y("[8, 4]", "[99999999999, 4]"), 5, "at most 2147483647"),
    ("empty", ("xml", ""), None, "is empty"),
    ("comments alone", ("yaml", "# a deck\n"), None, "such as deck:"),
    ("JSON", ("json", '{"Mesh": {"Lower": [0, 0]}}'), 1, "name the file .yaml"),
    ("JSON without a comma", ("yaml", '{"Material": {"Young\'s Modulus": 1000.0 "Poisson\'s Ratio": 0.3}}'), 1, "a comma is missing before it"),
    ("YAML as XML", ("xml", YAML), 1, "name the file .yaml"),
    ("no closing tag", ("xml", XML.rstrip().removesuffix("</ParameterList>")), 25, "Write </ParameterList>"),
    ("a closing tag too many", ("xml", XML + "</ParameterList>\n"), 26, "closes nothing"),
    ("no comma", y("{X: 0.0}", "{X: 0.0 Y: 1}"), 10, "a comma is missing before it"),
    ("comma of a function", y("{Y: -2.0}", "{Y: -2*max(x, 1)}"), 12, 'write "-2*max(x, 1)"'),
    ("value in braces", y("{Y: -2.0}", "{Y: {-2*x}}"), 12, 'Write Y: "-2*x"'),
    ("conditional", y("{Y: -2.0}", "{Y: x > 1 ? -2 : 0}"), 12, 'Write Y: "x > 1 ? -2 : 0"'),
    ("colon in a value", y("Side: bottom", "Side: bottom: left"), 14, 'Write Side: "bottom: left"'),
    ("anchor", y("Side: bottom", "Side: *bottom"), 14, "Write the value out"),
    ("variable of a shell", y("Side: bottom", "Side: ${SIDE}"), 14, "Write the value"),
    ("no value", y("Side: bottom", "Side:"), 14, "write one behind the colon"),
    ("open quote", y("Poisson's Ratio", '"Poisson\'s Ratio'), 8, "does not close"),
    ("apostrophe of a word processor", y("Poisson's", "Poisson’s"), 8, 'Did you mean "Poisson\'s Ratio"?'),
    ("minus of a word processor", y("-2.0", "−2.0"), 12, "Write -2"),
    ("blanks of a word processor", y("    Side", "\u00a0\u00a0\u00a0\u00a0Side"), 14, "Write blanks of the keyboard"),
    ("no indentation", ("yaml", YAML.replace("\n  ", "\n")), 1, "Indent them by two blanks"),
    ("two decks", ("yaml", YAML + "---\n" + YAML), 17, "given twice"),
    ("percentage", ("yaml", YAML + "  Adapt: {Target Relative Error: 5%}\n"), 16, "0.05"),
]


class PastedDecks(RpcTestCase):
    def test_each_is_read_or_refused_with_place_and_remedy(self):
        names = []
        for number, (_, (ending, text), _, _) in enumerate(DECKS):
            names.append(f"{number}.{ending}")
            (self.folder / names[-1]).write_bytes(text if isinstance(text, bytes) else text.encode())
        results = run_all([([f"--input={name}", "--check"], self.folder) for name in names])
        for (what, _, line, part), name, result in zip(DECKS, names, results):
            with self.subTest(what):
                if part is GOOD:
                    self.assertEqual((result.returncode, result.stderr), (0, ""))
                    continue
                place = f'deck: "{name}"' + (f", line {line}: " if line else "")
                self.expect_refusal(result, 2, [place, part])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Decks as dicts."""
import re
import unittest

from support import SOURCE, TestCase, rpc

import numpy as np

ALL = {"Int": 3, "Double": 3.0, "Tiny": 1e-300, "Third": 1 / 3, "Infinite": float("inf"), "Text": 'x < 1 && y > "2" ? 1 : -inf', "Umlaut ä": "Größe",
       "Number": "3", "Yes": True, "No": False, "Sub": {"Ints": [1, -2], "Doubles": [1.0, 2.5], "Texts": ["0", "min(t, 1)"], "None": [], "Empty": {}}}


def typed(value):
    """A value with the types of all that is in it: 1, 1.0 and True are three."""
    if isinstance(value, dict):
        return {name: typed(item) for name, item in value.items()}
    return [typed(item) for item in value] if isinstance(value, list) else (type(value), value)


class Decks(TestCase):
    def written(self, deck):
        rpc.write_deck(deck, self.folder / "deck.xml")
        return rpc.read_deck(self.folder / "deck.xml")

    def read(self, text, name="deck.xml"):
        (self.folder / name).write_text(text)
        return rpc.read_deck(self.folder / name)

    def test_types_survive(self):
        self.assertEqual(typed(self.written(ALL)), typed(ALL))

    def test_decks_of_the_program_survive(self):
        decks = sorted((SOURCE / "input").glob("*.xml"))
        self.assertGreater(len(decks), 10)
        for path in decks:
            deck = rpc.read_deck(path)
            with self.subTest(path.name):
                self.assertEqual(typed(self.written(deck)), typed(deck))
                self.assertEqual(self.parameters(path.read_text()), self.parameters((self.folder / "deck.xml").read_text()))

    @staticmethod
    def parameters(text):
        """Names and types as a text of XML has them."""
        return re.findall(r'<Parameter(?:List)? name="([^"]*)"(?: type="([^"]*)")?', text)[1:]

    def test_values_of_numpy_are_numbers(self):
        given = {"a": np.float64(0.5), "b": np.int64(2), "c": np.bool_(True), "d": np.array([1.0, 2]), "e": (1, 2), "f": np.linspace(0, 1, 3), "g": [1, 0.5]}
        expected = {"a": 0.5, "b": 2, "c": True, "d": [1.0, 2.0], "e": [1, 2], "f": [0.0, 0.5, 1.0], "g": [1.0, 0.5]}
        self.assertEqual(typed(self.written(given)), typed(expected))

    def test_a_file_of_the_mesh_has_a_place(self):
        deck = rpc.read_deck(SOURCE / "input" / "hertz.xml")
        self.assertEqual(deck["Mesh"]["File"], str(SOURCE / "input" / "hertz.geo"))

    def test_a_file_of_an_obstacle_has_a_place(self):
        deck = rpc.read_deck(SOURCE / "input" / "rough.xml")
        self.assertEqual(deck["Contact"]["Obstacle"]["File"], str(SOURCE / "input" / "rough.npy"))

    def test_decks_of_the_program_are_found_by_name(self):
        self.assertEqual(rpc.read_deck("beam.xml"), rpc.read_deck(SOURCE / "input" / "beam.xml"))

    def test_yaml_is_what_the_manual_says(self):
        try:
            import yaml  # noqa: F401
        except ImportError:
            self.skipTest("needs PyYAML")
        manual = (SOURCE / "doc" / "input" / "README.md").read_text()
        xml, same = (re.search(f"```{kind}\n(.*?)```", manual, re.DOTALL) for kind in ("xml", "yaml"))
        self.assertEqual(typed(self.read(same[1], "deck.yaml")), typed(self.read(xml[1])))
        read = self.read("Mesh: {Type: box}\nA: 1e-8\nB: on\nC: yes\nD: .inf\nE: '3'\nF: 1_0\nG: [1, 2]\n", "deck.yml")
        self.assertEqual(typed(read), typed({"Mesh": {"Type": "box"}, "A": 1e-8, "B": "on", "C": True, "D": float("inf"), "E": "3", "F": "1_0", "G": [1, 2]}))
        self.refused(["deck.yaml", "line 2", "given twice"], self.read, "A: 1\nA: 2\n", "deck.yaml")
        self.refused(["deck.yaml", "line 2"], self.read, "A: [1\nB: 2\n", "deck.yaml")
        self.refused(["deck.yaml", "names and values"], self.read, "3\n", "deck.yaml")

    def test_settings_are_paths(self):
        deck = {"Contact": {"Side": "bottom"}, "Time": 1.0}
        changed = rpc.with_settings(deck, {"Contact->Yield Stress": 12, "Mesh->Box->Cells": [2, 3], "Time": 2, "Units": {"Length": "mm"}})
        self.assertEqual(changed, {"Contact": {"Side": "bottom", "Yield Stress": 12}, "Time": 2, "Mesh": {"Box": {"Cells": [2, 3]}}, "Units": {"Length": "mm"}})
        self.assertEqual(deck, {"Contact": {"Side": "bottom"}, "Time": 1.0})
        self.refused(['"Time->x" leads through "Time"'], rpc.with_settings, deck, {"Time->x": 1})
        for path in ("", "Contact->", 3):
            self.refused(["must be a path"], rpc.with_settings, deck, {path: 1})

    def test_values_that_no_deck_has_are_refused(self):
        for value, part in ((None, "NoneType"), (2**31, "2147483648.0"), ("a\nb", "of one line"), ([1, "a"], "of one kind"), ([True], "of one kind"),
                            ([[1, 2]], "of one kind"), (["a,b"], "commas"), (1j, "complex"), (np.ones((2, 2)), "of one kind")):
            self.refused(['"A->B"', part], rpc.write_deck, {"A": {"B": value}}, self.folder / "deck.xml")
        self.refused(["must be a dict", "str"], rpc.write_deck, "beam.xml", self.folder / "deck.xml")
        self.refused(["must be a dict", "read_deck"], rpc.with_settings, "beam.xml", {})
        self.refused(["names must be texts", "3"], rpc.write_deck, {3: 1}, self.folder / "deck.xml")
        self.refused(["deck.yaml", "deck.xml"], rpc.write_deck, {}, self.folder / "deck.yaml")
        deep = {}
        for _ in range(200):
            deep = {"A": deep}
        self.refused(["deeper than 100"], rpc.write_deck, deep, self.folder / "deck.xml")

    def test_files_that_are_no_decks_are_refused(self):
        def of(*parameters):
            return '<ParameterList name="a">' + "".join(parameters) + "</ParameterList>"
        for text, parts in ((of("\n<"), ["line 2"]), ("<a/>", ["got a"]), (of('<Parameter name="b" type="int" value="1.5"/>'), ['"b" = "1.5"', "int"]),
                            (of('<Parameter name="b" type="int" value="1"/>' * 2), ['"b" is given twice']), (of("<Parameter/>"), ["names"]),
                            (of('<Parameter name="b" type="TwoDArray(double)" value="1"/>'), ["TwoDArray", "run(path)"]), (of('<Parameter name="b"/>'), ["a type"]),
                            (of('<Parameter name="b" type="bool" value="maybe"/>'), ["maybe"]), (of('<Parameter name="b" type="Array(int)" value="1"/>'), ['"1"']),
                            (of('<ParameterList name="b">' * 200, "</ParameterList>" * 200), ["deeper than 100"])):
            self.refused([str(self.folder / "deck.xml"), *parts], self.read, text)
        (self.folder / "deck.xml").write_bytes(b"\xff\xfe")
        self.refused(["UTF-8"], rpc.read_deck, self.folder / "deck.xml")
        self.refused(['no file "nowhere.xml"; searched: nowhere.xml', "input/nowhere.xml"], rpc.read_deck, "nowhere.xml")


if __name__ == "__main__":
    unittest.main()

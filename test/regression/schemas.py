# SPDX-License-Identifier: BSD-3-Clause
"""rpc --print-schema: every deck that comes with rpc fits, typing errors do not."""

import copy
import json
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from rpc_run import BEAM, SOURCE, RpcTestCase

try:
    import jsonschema
except ImportError:
    jsonschema = None

DECKS = sorted([*SOURCE.glob("input/*.xml"), *SOURCE.glob("input/templates/*.xml"), *SOURCE.glob("test/*/decks/*.xml")])
READ = {"int": int, "double": float, "bool": lambda text: text == "true", "string": str}


def content(element):
    """A list of a deck in XML as YAML has it."""
    result = {}
    for child in element:
        name, kind, text = (child.get(key) for key in ("name", "type", "value"))
        if child.tag == "ParameterList":
            result[name] = content(child)
        elif kind.startswith("Array"):
            items = text.strip()[1:-1]
            result[name] = [READ[kind[6:-1]](item.strip()) for item in items.split(",")] if items.strip() else []
        else:
            result[name] = READ[kind](text)
    return result


def deck_of(path):
    return content(xml.etree.ElementTree.parse(path).getroot())


TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}


def is_a(value, kind):
    if kind in ("integer", "number"):
        return isinstance(value, (int, float)) and not isinstance(value, bool) and (kind == "number" or float(value).is_integer())
    return isinstance(value, TYPES[kind])


def fits(value, schema, root):
    """As much of JSON Schema as rpc's has; what jsonschema says where it is installed."""
    if "$ref" in schema:
        return fits(value, root["$defs"][schema["$ref"].rsplit("/", 1)[1]], root)
    kinds = schema.get("type", [])
    good = not kinds or any(is_a(value, kind) for kind in ([kinds] if isinstance(kinds, str) else kinds))
    good = good and ("enum" not in schema or any(value == each and isinstance(value, bool) == isinstance(each, bool) for each in schema["enum"]))
    good = good and not ("not" in schema and fits(value, schema["not"], root))
    if good and isinstance(value, dict):
        others = [name for name in value if name not in schema.get("properties", {})]
        more = schema.get("additionalProperties", True)
        good = len(value) <= schema.get("maxProperties", len(value)) and all(fits(name, schema.get("propertyNames", {}), root) for name in value)
        good = good and (not others or (isinstance(more, dict) and all(fits(value[name], more, root) for name in others)) or more is True)
        good = good and all(fits(value[name], each, root) for name, each in schema.get("properties", {}).items() if name in value)
    if good and isinstance(value, list):
        good = all(fits(item, schema.get("items", {}), root) for item in value)
    if good and "if" in schema:
        good = fits(value, schema["then" if fits(value, schema["if"], root) else "else"], root)
    return good


# (path in the beam's deck, value)
ERRORS = [("Materail", {"Poisson's Ratio": 0.3}), ("Material->Youngs Modulus", 3.0), ("Material->Young's Modulus", "210 GPa"),
          ("Material->Poisson's Ratio", "0,3"), ("Mesh->Cells", "160 32"), ("Mesh->Cells", [160, 3.2]), ("Mesh->Element", "q2"), ("Mesh", 3),
          ("Traction->top->y", 1.0), ("Traction->top", 1.0), ("Output", {"JSON": "on"}), ("Contact->Obstacle", {"Type": "pyramid"}),
          ("Steps", {"Times": 3.0}), ("Uzawa", {"Maximum Iterations": 2.5}), ("Yield Stress", 3.0)]
GOOD = [("Contact->Remembers", False), ("Contact->Remembers", "auto"), ("Output", {"Exodus": False}), ("Output", {"Exodus": "split"}),
        ("Contact->Yield Stress", "4 + x"), ("Contact->Obstacle", {"Type": "plane", "Point": [0, "0.1*t"], "Normal": [0.0, 1.0]}),
        ("Linear Solver", {"MueLu": {"max levels": 3}}), ("Dirichlet->hinge", {"Side": "left bottom", "X": 0})]


def changed(deck, path, value):
    deck = copy.deepcopy(deck)
    inner = deck
    *lists, last = path.split("->")
    for name in lists:
        inner = inner[name]
    inner[last] = value
    return deck


class Schemas(RpcTestCase):
    def test_json_schema(self):
        schema = json.loads(self.rpc("--print-schema").stdout)
        self.assertEqual(schema, json.loads(self.rpc("--print-schema=json").stdout))
        self.assertGreater(len(DECKS), 25)
        beam = deck_of(BEAM)
        cases = [(str(path), deck_of(path), True) for path in DECKS]
        cases += [(f"{path} = {value}", changed(beam, path, value), False) for path, value in ERRORS]
        cases += [(f"{path} = {value}", changed(beam, path, value), True) for path, value in GOOD]
        cases += [("named " + name, {"beam": deck}, good) for name, deck, good in cases]
        cases += [("two roots", {"a": beam, "b": beam}, False), ("a number", 3, False)]
        for name, deck, good in cases:
            with self.subTest(name):
                self.assertEqual(fits(deck, schema, schema) and isinstance(deck, dict), good)
                if jsonschema and isinstance(deck, dict):
                    self.assertEqual(jsonschema.Draft202012Validator(schema).is_valid(deck), good)
        if jsonschema:
            jsonschema.Draft202012Validator.check_schema(schema)
        else:
            print("jsonschema is not installed: the subset of it in this file has judged alone")

    def test_every_parameter_is_in_both(self):
        names = set(re.findall("(?m)^- `(.*?)` ", self.rpc("--print-parameters").stdout))
        self.assertGreater(len(names), 60)
        for kind, mark in (("json", '"{}": {{'), ("relaxng", '<value type="string">{}</value>')):
            text = self.rpc(f"--print-schema={kind}").stdout
            self.assertEqual([name for name in names if mark.format(name) not in text], [])

    @unittest.skipUnless(shutil.which("xmllint"), "xmllint (libxml2-utils) is not installed: nothing judges RELAX NG")
    def test_relax_ng_schema(self):
        (self.folder / "deck.rng").write_text(self.rpc("--print-schema=relaxng").stdout)

        def judged(paths):
            lint = subprocess.run(["xmllint", "--noout", "--relaxng", "deck.rng", *paths], cwd=self.folder, capture_output=True, text=True)
            return re.findall("(?m)^(.*) fails to validate$", lint.stderr), re.findall("(?m)^(.*) validates$", lint.stderr)
        self.assertEqual(judged(DECKS), ([], [str(path) for path in DECKS]))
        beam = BEAM.read_text()
        errors = [('"Material"', '"Materail"'), ("Young's Modulus", "Youngs Modulus"), ('value="2000"', 'value="210 GPa"'), ('"0.3"', '"0,3"'),
                  ("{160, 32}", "160 32"), ('"Q1"', '"q2"'), ('name="Y" type="string"', 'name="y" type="string"'),
                  ('type="double" value="2000"', 'type="string" value="2000"'), ("Parameter name", "Paramter name")]
        names = []
        for k, (old, new) in enumerate(errors):
            self.assertIn(old, beam)
            names.append(f"{k}.xml")
            (self.folder / names[-1]).write_text(beam.replace(old, new, 1))
        self.assertEqual(judged(names), (names, []))

    def test_other_schemas_are_refused(self):
        self.expect_refusal(self.rpc("--print-schema=xsd", code=2), 2, ["--print-schema must be one of json, relaxng", '"xsd"'])


if __name__ == "__main__":
    unittest.main()

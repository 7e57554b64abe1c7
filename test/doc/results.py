# SPDX-License-Identifier: BSD-3-Clause
"""Every key and column of the files that a run writes is in doc/input/results.md, and the other way round."""

import csv
import json
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "regression"))
from rpc_run import SMALL, SOURCE, RpcTestCase  # noqa: E402

NAMED = {"contact_patches", "contact_sides", "force_displacement", "goals", "reaction_force", "rigid", "side_displacement"}  # their keys are names of the deck
MODELS = {"beam": ["--input=beam.xml", SMALL, "--set=Steps->Times={0.5, 1}", "--set=Adapt->Estimate Error=true"],
          "beam_adaptive": ["--input=beam_adaptive.xml", "--set=Adapt->Target Relative Error=0.02", "--set=Adapt->Error Bound=guaranteed", "--set=Goals->top->Component=Y"],
          "shear": ["--input=shear.xml", "--set=Mesh->Cells={12, 6}", "--set=Steps->Times={1, 1.5}"],
          "block": ["--input=block.xml", "--set=Mesh->Cells={4, 4, 2}", "--set=Contact->Friction Coefficient=0.2"]}
STEPPED = {"beam", "shear"}  # their runs write a history


def section(title):
    text = (SOURCE / "doc" / "input" / "results.md").read_text()
    return text.split(f"\n## `{title}`\n")[1].split("\n## ")[0]


def code_words(text):
    return set(re.findall(r"`([^`]+)`", text))


def keys(value, name=None):
    """All keys of a summary, those of objects inside it too."""
    if isinstance(value, dict):
        own = set() if name in NAMED else set(value)
        return own.union(*(keys(inner, key) for key, inner in value.items()))
    if isinstance(value, list):
        return set().union(*(keys(inner) for inner in value))
    return set()


class Results(RpcTestCase):
    def run_models(self):
        for name, arguments in MODELS.items():
            self.rpc(*arguments, "--output=out")
            yield name, json.loads((self.folder / "out" / f"{name}.json").read_text())

    def run_that_fails(self):
        """The summary of a run whose second step has no load."""
        self.rpc("--input=beam.xml", SMALL, "--set=Traction->top->Y=-20*sqrt(1.5-t)", "--set=Steps->Times={1,2}",
                 "--set=Steps->Energy Tolerance=0.5", "--output=failed", code=2)
        return json.loads((self.folder / "failed" / "beam.json").read_text())

    def test_every_key_of_the_summary_is_documented_and_every_documented_key_is_written(self):
        text = section("<deck>.json")
        written = set().union(*(keys(summary) for _, summary in self.run_models()))
        written |= keys(self.run_that_fails())
        self.assertGreater(len(written), 60)
        self.assertEqual(written - code_words(text), set())
        listed = code_words("\n".join(line.split("|")[1] for line in text.splitlines() if line.startswith("|")))
        self.assertGreater(len(listed), 40)
        self.assertEqual(listed - written, set())

    def header(self, file):
        return next(csv.reader((self.folder / "out" / file).read_text().splitlines()))

    def test_every_column_is_documented(self):
        history = code_words(section("<deck>.history.csv"))
        contact = code_words(section("<deck>.contact.csv"))
        for name, _ in self.run_models():
            self.assertEqual(set(self.header(f"{name}.contact.csv")) - contact, set())
            if name in STEPPED:
                header = self.header(f"{name}.history.csv")
                own = [column for column in header if not re.search(r"_(displacement|reaction)_[xyz]$", column)]
                self.assertLess(len(own), len(header))
                self.assertEqual(set(own) - history, set())


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Graded boxes: "Mesh->Expansion Ratio"."""
import json
import unittest

from rpc_run import RANKS, RpcTestCase

# A strip that repeats itself, pressed unevenly on a flat foundation: smooth, and in contact all along. E* = 1.
STRIP = """deck:
  Mesh: {{Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [{cells}, {cells}], Element: {element}, Periodic: X, Expansion Ratio: [1.0, {ratio}]}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{hold: {{Side: bottom, X: 0.0}}}}
  Traction: {{top: {{Y: "-0.01*(1 + 0.5*cos(2*pi*x))"}}}}
  Contact: {{Side: bottom}}
  Output: {{Exodus: false}}
"""
# A layer on waves, with a dozen layers in place of 32 equal ones: the first ones are as deep as those.
LAYER = """deck:
  Mesh: {{Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [{along}, {along}, {layers}], Element: {element}, Periodic: "X, Y"{ratio}}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{front: {{X: 0.0, Y: 0.0, Force Z: -0.01}}}}
  Contact: {{Side: back, Normal: "0, 0, -1", Gap: "0.02*(2 - cos(4*pi*x) - cos(2*pi*y))", Yield Stress: 0.08}}
  Output: {{Exodus: false}}
"""
GRADED = ", Expansion Ratio: [1.0, 1.0, 8.0]"
ENERGY = {"Q1": -0.00016854127478616073, "P1": -0.00016397170033167455}  # of one rank [J]


class Graded(RpcTestCase):
    def solve(self, deck, *arguments):
        (self.folder / "deck.yaml").write_text(deck)
        self.rpc("--input=deck.yaml", "--output=out", *arguments)
        return json.loads((self.folder / "out" / "deck.json").read_text())

    @unittest.skipIf(RANKS > 1, "nothing here depends on ranks")
    def test_errors_fall_as_fast_as_on_equal_cells(self):
        for element, order in (("Q1", 2), ("P1", 2), ("Q2", 4), ("P2", 4)):
            for ratio in (2.0, 0.5):
                with self.subTest(element=element, ratio=ratio):
                    coarse, middle, fine = (self.solve(STRIP.format(cells=cells, element=element, ratio=ratio))["energy_J"] for cells in ((20, 40, 80) if order == 2 else (10, 20, 40)))
                    self.assertGreater((coarse - middle) / (middle - fine), 0.75 * 2**order)

    @unittest.skipIf(RANKS > 1, "nothing here depends on ranks")
    def test_check_tells_the_first_and_the_last_cell(self):
        (self.folder / "deck.yaml").write_text(STRIP.format(cells=20, element="Q1", ratio=8.0))
        out = self.rpc("--input=deck.yaml", "--check").stdout
        q = 8.0 ** (1 / 19)
        first = (q - 1) / (q**20 - 1)
        self.assertIn(f"x from 0 to 1 (periodic), y from 0 to 1 (graded: cells of {first:.6g} at the lower end to {8 * first:.6g} at the upper end)", " ".join(out.split()))
        (self.folder / "deck.yaml").write_text(STRIP.format(cells=20, element="Q1", ratio=1.0))
        self.assertNotIn("graded", self.rpc("--input=deck.yaml", "--check").stdout)

    def test_iterations_are_those_of_equal_cells_and_ranks_agree(self):
        for element, along in (("Q1", 24), ("P1", 12)):
            with self.subTest(element=element):
                found = self.solve(LAYER.format(along=along, layers=along // 2 - 2, element=element, ratio=GRADED))
                self.assertAlmostEqual(found["energy_J"], ENERGY[element], delta=1e-10 * abs(ENERGY[element]))
                equal = self.solve(LAYER.format(along=along, layers=along, element=element, ratio=""))
                self.assertLess(sum(found["linear_iterations"]), 1.5 * sum(equal["linear_iterations"]))
                self.assertAlmostEqual(found["energy_J"], equal["energy_J"], delta=0.02 * abs(equal["energy_J"]))


if __name__ == "__main__":
    unittest.main()

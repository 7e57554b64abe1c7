# SPDX-License-Identifier: BSD-3-Clause
"""How far the sides of a body have moved, in the JSON file: on any number of ranks the same, and what the deck prescribes."""

import csv
import json
import unittest

from rpc_run import RpcTestCase

BLOCK = """block:
  Mesh: {{Lower: [0.0, 0.0, 0.0], Upper: [2.0, 1.0, 1.0], Cells: [6, 3, 3], Element: {element}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    left: {{X: 0.0, Y: 0.0, Z: 0.0}}
    right: {{X: "{moved}", Y: 0.0, Z: 0.02}}
  Contact: {{Side: bottom, Gap: 1.0}}
  Output: {{Exodus: none}}
"""
TUBE = """tube:
  Kinematics: axisymmetric
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4], Element: Q2}
  Material: {Young's Modulus: 1.0, Poisson's Ratio: 0.0}
  Dirichlet:
    bottom: {Y: 0.0}
    top: {Y: -0.01*x}
  Contact: {Side: right, Gap: 1.0}
  Output: {Exodus: none}
"""


class SideDisplacements(RpcTestCase):
    def displacements(self, name, deck, code=0):
        (self.folder / f"{name}.yaml").write_text(deck)
        self.rpc(f"--input={name}.yaml", "--output=out", code=code)
        return json.loads((self.folder / "out" / f"{name}.json").read_text())["side_displacement"]

    def test_means_are_over_the_area_and_the_largest_is_that_of_a_node(self):
        for element, moved, mean in (("Q1", "0.01*y", 0.005), ("Q2", "0.03*y^2", 0.01), ("P2", "0.03*y^2", 0.01)):
            with self.subTest(element):
                found = self.displacements("block", BLOCK.format(element=element, moved=moved))
                self.assertEqual(set(found), {"left", "right", "bottom", "top", "back", "front"})
                self.assertEqual(found["left"], {"mean": [0, 0, 0], "max": 0})
                for x, y in zip(found["right"]["mean"], (mean, 0, 0.02)):
                    self.assertAlmostEqual(x, y, delta=1e-15)
                top = 0.01 if element == "Q1" else 0.03
                self.assertAlmostEqual(found["right"]["max"], (top**2 + 0.02**2)**0.5, delta=1e-15)
                self.assertAlmostEqual(found["top"]["max"], found["right"]["max"], delta=1e-15)  # the edge that they share
                self.assertLess(found["bottom"]["mean"][0], found["top"]["mean"][0])

    def test_of_revolution_they_are_over_the_area_of_the_ring_and_on_the_axis_over_the_nodes(self):
        found = self.displacements("tube", TUBE)
        self.assertAlmostEqual(found["top"]["mean"][1], -0.02 / 3, delta=1e-14)  # of x over x dx
        self.assertAlmostEqual(found["top"]["max"], 0.01, delta=1e-3)
        self.assertEqual(found["left"]["mean"][0], 0)
        self.assertLess(found["left"]["mean"][1], 0)

    def test_of_load_steps_too_a_side_on_the_axis_has_the_mean_over_its_nodes(self):
        steps = TUBE.replace("    bottom:", "    left: {X: 0.0}\n    bottom:") + "  Steps: {Times: [1.0, 2.0]}\n"
        (self.folder / "tube.yaml").write_text(steps)
        self.rpc("--input=tube.yaml", "--output=out")
        with open(self.folder / "out" / "tube.history.csv", newline="") as file:
            row = list(csv.DictReader(file))[-1]
        column = {key.split(" ")[0]: float(value) for key, value in row.items() if key.startswith(("left_disp", "top_disp"))}
        self.assertEqual(column["left_displacement_x"], 0)
        self.assertLess(column["left_displacement_y"], 0)
        self.assertAlmostEqual(column["top_displacement_y"], -0.02 / 3, delta=1e-14)


if __name__ == "__main__":
    unittest.main()

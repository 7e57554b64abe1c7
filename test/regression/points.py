# SPDX-License-Identifier: BSD-3-Clause
"""Results at points and along lines, "Output->Points"."""
import csv
import json
import math
import unittest

from rpc_run import RANKS, SOURCE, RpcTestCase, errors

E, NU, P = 1000.0, 0.3, 10.0
# A body that is pressed flat on a rigid foundation, y = 0: its displacement is linear.
DECK = """deck:
  Mesh: {{Lower: {lower}, Upper: {upper}, Cells: {cells}, Element: {element}}}
  Kinematics: {kinematics}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {dirichlet}
  Traction: {{top: {{Y: -10.0}}}}
  Contact: {{Side: bottom, Yield Stress: inf}}
  Output: {{Points: {{inside: {{Points: "{inside}"}}, floor: {{From: {start}, To: {end}, Count: 3}}}}}}
"""
PLANE = {"lower": "[0.0, 0.0]", "upper": "[2.0, 1.0]", "cells": "[4, 3]", "inside": "0.3 0.71; 2 1", "start": "[0.1, 0.0]", "end": "[1.9, 0.0]"}
SPACE = {"lower": "[0.0, 0.0, 0.0]", "upper": "[2.0, 1.0, 1.0]", "cells": "[4, 3, 2]", "inside": "0.3 0.71 0.4; 2 1 1",
         "start": "[0.1, 0.0, 0.2]", "end": "[1.9, 0.0, 0.9]"}
STRETCH = {"plane strain": (NU * (1 + NU), 1 - NU**2), "axisymmetric": (NU, 1), "space": (NU, 1)}  # in x, and in y, times P/E


class Points(RpcTestCase):
    def rows(self, name="deck", output="out"):
        return list(csv.DictReader((self.folder / output / f"{name}.points.csv").read_text().splitlines()))

    def test_a_linear_displacement_is_exact_with_every_element(self):
        for kinematics, (across, along) in STRETCH.items():
            space = kinematics == "space"
            for element in ("P1", "P2", "Q1", "Q2"):
                with self.subTest(f"{kinematics} {element}"):
                    held = "{left: {X: 0.0}, back: {Z: 0.0}}" if space else "{left: {X: 0.0}}"
                    deck = DECK.format(**(SPACE if space else PLANE), element=element, dirichlet=held,
                                       kinematics='""' if space else kinematics)
                    (self.folder / "deck.yaml").write_text(deck.replace('  Kinematics: ""\n', ""))
                    self.rpc("--input=deck.yaml", "--output=out")
                    rows = self.rows()
                    self.assertEqual([(row["name"], row["number"]) for row in rows],
                                     [("inside", "1"), ("inside", "2"), ("floor", "1"), ("floor", "2"), ("floor", "3")])
                    for row in rows:
                        x, y = float(row["x"]), float(row["y"])
                        self.assertAlmostEqual(float(row["disp_x"]), across * P / E * x, delta=1e-9)
                        self.assertAlmostEqual(float(row["disp_y"]), -along * P / E * y, delta=1e-9)
                        self.assertAlmostEqual(float(row["stress_yy"]), -P, delta=1e-5)
                        self.assertAlmostEqual(float(row["stress_xx"]), 0, delta=1e-5)
                        self.assertEqual(float(row["off"]), 0)
                        if row["name"] == "floor":
                            self.assertAlmostEqual(float(row["contact_pressure"]), P, delta=1e-6)
                        else:
                            self.assertTrue(math.isnan(float(row["contact_pressure"])))
                    length = math.dist([float(rows[2][axis]) for axis in "xyz"[:3 if space else 2]], [float(rows[4][axis]) for axis in "xyz"[:3 if space else 2]])
                    self.assertAlmostEqual(float(rows[3]["s"]), length / 2, delta=1e-12)
                    self.assertAlmostEqual(float(rows[4]["s"]), length, delta=1e-12)

    def test_each_step_has_its_rows_whatever_the_mesh_and_a_restart_goes_on(self):
        line = ["--set=Output->Points->line->From={1, 0}", "--set=Output->Points->line->To={4, 0}", "--set=Output->Points->line->Count=7"]
        steps = ["--set=Steps->Times={0.2, 0.6, 1.0}", "--set=Steps->Checkpoint Every=1"]
        adaptive = [f"--input={SOURCE / 'input' / 'beam_adaptive.xml'}", "--set=Adapt->Target Relative Error=0.05", "--set=Traction->top->Y=-20*t*sin(pi*x/5)"]
        self.rpc(*adaptive, *line, *steps, "--output=out")
        rows = self.rows("beam_adaptive")
        self.assertEqual([float(row["time"]) for row in rows], [t for t in (0.2, 0.6, 1.0) for _ in range(7)])
        summary = json.loads((self.folder / "out" / "beam_adaptive.json").read_text())
        most = max(float(row["contact_pressure"]) for row in rows[14:])
        self.assertTrue(0.5 * summary["max_pressure"] < most <= summary["max_pressure"] * (1 + 1e-9))
        half = ["--set=Steps->Times={0.2, 0.6}", "--set=Steps->Checkpoint Every=1"]
        self.rpc(*adaptive, *line, *half, "--output=on")
        checkpoint = max((self.folder / "on").glob("*.checkpoint-*.e"))
        self.rpc(*adaptive, *line, *steps, f"--restart={checkpoint}", "--output=on")
        self.assertEqual([(row["time"], row["number"]) for row in self.rows("beam_adaptive", "on")], [(row["time"], row["number"]) for row in rows])

    def test_units_stand_in_the_headings_and_older_tables_go(self):
        point = ["--input=beam.xml", "--set=Mesh->Cells={20,4}", "--output=out"]
        self.rpc(*point, "--set=Output->Points->tip->Points=5 1", "--set=Units->Length=mm")
        (row,) = self.rows("beam")
        self.assertEqual(list(row)[:8], ["time", "name", "number", "x [mm]", "y [mm]", "s [mm]", "off [mm]", "disp_x [mm]"])
        self.assertIn("von_mises [MPa]", row)
        self.rpc(*point)
        self.assertFalse((self.folder / "out" / "beam.points.csv").exists())

    def test_what_is_no_point_of_the_body_is_refused(self):
        def refused(*assignments, parts):
            result = self.rpc("--input=beam.xml", "--set=Mesh->Cells={20,4}", "--output=out", *(f"--set=Output->Points->{one}" for one in assignments), code=2)
            for part in parts:
                self.assertIn(part, result.stderr)
            self.assertEqual(len(errors(result)), 1, result.stderr)
        refused("tip->Points=1 0; 7 1", parts=['point 2 of "Output->Points->tip" at (7, 1) must lie in the undeformed body, which is 2 [m] away'])
        refused("a line->From={0, 0}", "a line->To={0, 3}", "a line->Count=4", parts=['point 3 of "Output->Points->a line" at (0, 2)', "1 [m] away"])
        if RANKS > 1:
            return
        refused("tip->Points=1 0; 2", parts=['"Output->Points->tip->Points" must have 2 numbers for each point', '" 2"', 'such as "0 0; 1 0.5"'])
        refused("tip->Points=1 two", parts=["2 numbers for each point", '"1 two"'])
        refused("tip->Points=nan 0", parts=["2 numbers for each point"])
        refused("tip->Count=2", parts=['"Output->Points->tip->From" must be 2 finite numbers'])
        refused("tip->From={0, 0}", "tip->To={1, 0}", "tip->Count=1", parts=['"Output->Points->tip->Count" must be from 2', "got 1"])
        refused("tip->From={0, 0}", "tip->To={1, 0}", "tip->Count=3", "tip->Points=0 0", parts=["either Points or From, To and Count, got both"])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Foundations that move, that several of touch one side, and that remember what the body has left behind; bodies held at points."""

import csv
import json
import math
import unittest

from rpc_run import BEAM, RANKS, SMALL, SOURCE, RpcTestCase

DECKS = SOURCE / "test" / "regression" / "decks"
TRACK = SOURCE / "input" / "track.xml"
BAD_INPUT = 2
# Its foundation hardens little, so that pressures tell little of dents.
SOFT = """soft:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [4, 2, 4], Element: P2}
  Material: {Young's Modulus: 20.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: -0.001, Z: 0.0}}
  Contact: {Side: bottom, Gap: "0.008*((x - 0.54)^2 + (z - 0.7)^2)", Yield Stress: "0.012 + 0.003*x", Hardening: 1.0}
"""
# On a foundation with a conical gap, which hardens little; with order 2 no contact law holds on the axis.
CONE = """cone:
  Kinematics: axisymmetric
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [8, 6], Element: P2}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: -0.03}}
  Contact: {Side: bottom, Gap: "0.022*x", Yield Stress: 20.0, Hardening: 35.0}
"""


def rows(path):
    return list(csv.DictReader(path.read_text().splitlines()))


class Foundations(RpcTestCase):
    def summary_of(self, deck, *arguments, output="out"):
        self.rpc(f"--input={deck}", f"--output={output}", *arguments)
        return json.loads((self.folder / output / f"{deck.stem}.json").read_text())

    def history_of(self, deck, output="out"):
        return [{k: float(v) for k, v in row.items() if k != "reason"} for row in rows(self.folder / output / f"{deck.stem}.history.csv")]

    def test_a_cone_presses_in_most_on_the_axis(self):
        deck = self.folder / "cone.yaml"
        deck.write_text(CONE)
        deepest = {}
        for element in ("P2", "Q2", "Q1"):
            summary = self.summary_of(deck, f"--set=Mesh->Element={element}", output=element)
            table = sorted(rows(self.folder / element / "cone.contact.csv"), key=lambda row: float(row["x"]))
            self.assertEqual(float(table[0]["x"]), 0)
            self.assertAlmostEqual(summary["max_penetration"], float(table[0]["dent"]), delta=1e-6 * summary["max_penetration"])
            self.assertAlmostEqual(summary["max_dent"], summary["max_penetration"], delta=1e-6 * summary["max_penetration"])
            self.assertGreater(summary["max_penetration"], 1.02 * float(table[1]["dent"]))
            deepest[element] = float(table[0]["u_nu"])  # the gap is 0 there
        self.assertAlmostEqual(deepest["P2"], deepest["Q2"], delta=0.02 * deepest["Q2"])

    def test_a_roller_comes_from_beside_the_body_and_leaves_it(self):
        for normal in ["0, 1", "surface", "foundation"] if RANKS == 1 else ["surface"]:
            summary = self.summary_of(DECKS / "roller.xml", f"--set=Contact->Normal={normal}")
            self.assertTrue(summary["converged"])
            table = self.history_of(DECKS / "roller.xml")
            self.assertEqual(len(table), 16)
            pressed = [row["time"] for row in table if row["max_pressure"] > 0]
            self.assertEqual((pressed[0], pressed[-1]), (2, 6))  # its centre over the ends of the strip
            for row, after in zip(table, table[1:]):
                for key in ["max_dent", "dent_volume", "dissipated_energy"]:
                    self.assertGreaterEqual(after[key], row[key], (normal, key, row["time"]))
            self.assertGreater(table[-1]["max_dent"], 0.01)
            self.assertAlmostEqual(table[-1]["dissipated_energy"], 30 * table[-1]["dent_volume"], delta=1e-12)
            if normal != "foundation":  # else nodes see it from anywhere
                self.assertIn("faces no node", " ".join(summary["skipped"]))

    def test_a_roller_that_stands_beside_the_body_is_refused(self):
        result = self.rpc(f"--input={DECKS / 'roller.xml'}", "--set=Contact->Obstacle->Centre={-2, 1.47}", code=None)
        self.expect_refusal(result, BAD_INPUT, ['"Contact"', 'side "top"', "nor from any other node"])

    def test_two_foundations_of_one_side_hold_a_body_between_them(self):
        summary = self.summary_of(DECKS / "groove.xml")
        left, right = summary["contact_sides"]["left flank"], summary["contact_sides"]["right flank"]
        across = 24 * 0.125 / math.sqrt(1 - 0.125**2)  # of half the load, 3 Pa on 16 m
        for flank, sign in [(left, 1), (right, -1)]:
            self.assertAlmostEqual(flank["contact_force"][0], sign * across, delta=1e-6)
            self.assertAlmostEqual(flank["contact_force"][1], 24, delta=1e-6)
        self.assertAlmostEqual(summary["contact_force"][0], 0, delta=1e-6)
        self.assertEqual(summary["contact_nodes"], left["contact_nodes"] + right["contact_nodes"])
        table = rows(self.folder / "out" / "groove.contact.csv")
        self.assertEqual({row["side"] for row in table}, {"left flank", "right flank"})
        for row in table:
            if float(row["pressure"]) > 0:
                self.assertEqual(row["side"], "left flank" if float(row["x"]) < 0 else "right flank")

    def test_two_foundations_of_one_side_are_refused_where_they_cannot_be_told_apart(self):
        result = self.rpc(f"--input={BEAM}", "--set=Contact->Sides->again->Side=bottom", code=None)
        self.expect_refusal(result, BAD_INPUT, ['"Contact"', '"Contact->Sides->again"', '"bottom"', '"Obstacle"'])
        result = self.rpc(f"--input={DECKS / 'groove.xml'}", "--set=Adapt->Estimate Error=true", code=None)
        self.expect_refusal(result, BAD_INPUT, ['"Adapt"', '"Contact->Sides->left flank"', "not estimated yet"])

    def test_a_body_is_held_at_a_point(self):
        summary = self.summary_of(BEAM, SMALL, "--set=Contact->Side=", "--set=Traction->top->Y=0", "--set=Traction->top->X=2",
                                  "--set=Dirichlet->right->Side=right bottom")
        total = [sum(force[c] for force in summary["reaction_force"].values()) for c in (0, 1)]
        self.assertAlmostEqual(total[0], -2 * 5, delta=1e-6)
        self.assertAlmostEqual(total[1], 0, delta=1e-6)
        result = self.rpc(f"--input={BEAM}", "--set=Dirichlet->left->Side=corner", code=None)
        self.expect_refusal(result, BAD_INPUT, ['"Dirichlet->left->Side"', '"corner"', "left bottom", "right top"])

    def test_dents_that_the_body_has_left_behind_are_met_again(self):
        # Pressed at x = 0, moved by `shift` and pressed, moved back and pressed as before. Meshes that adapt need not be the same again.
        cases = [(3, [], 1e-9), (3, ["--set=Adapt->Target Relative Error=0.02"], 1e-3), (4.5, [], 1e-9)]
        for shift, mesh, near in cases if RANKS == 1 else cases[:1]:  # verification.track has adapted meshes on several ranks
            summary = self.summary_of(
                TRACK, "--set=Mesh->Size Factor=6", f"--set=Dirichlet->top->X={shift} * max(0, min(1, min(t - 2, 6 - t)))",
                "--set=Dirichlet->top->Y=-0.1 * max(0, max(max(1 - abs(t - 1), 1 - abs(t - 4)), 1 - abs(t - 7)))",
                "--set=Steps->Times={0.5, 1, 2, 3, 3.5, 4, 5, 6, 6.5, 7, 8}", *mesh)
            steps = {step["time"]: step for step in summary["steps"]}
            one, both = steps[2], steps[8]
            self.assertGreater(one["dissipated_energy"], 0)
            for key in ["dissipated_energy", "dent_volume"]:
                self.assertAlmostEqual(steps[5][key] / one[key], 2, delta=near, msg=(shift, key))
                self.assertAlmostEqual(both[key] / one[key], 2, delta=near, msg=(shift, key))
            self.assertAlmostEqual(both["max_dent"] / one["max_dent"], 1, delta=near)

    def test_vertices_without_weight_have_dents_as_those_of_the_points_around_them(self):
        (self.folder / "soft.yaml").write_text(SOFT)
        summary = self.summary_of(self.folder / "soft.yaml")
        table = [{key: float(row[key]) for key in ["area", "dent", "pressure"]} for row in rows(self.folder / "out" / "soft.contact.csv")]
        for key in ["dent", "pressure"]:
            most = max(row[key] for row in table if row["area"] > 0)
            self.assertEqual(most, summary[f"max_{key}"])
            self.assertLess(max(row[key] for row in table if row["area"] == 0), 1.3 * most)

    def test_a_restart_knows_the_dents_that_the_body_has_left_behind(self):
        arguments = [f"--input={TRACK}", "--set=Mesh->Size Factor=6", "--set=Dirichlet->top->X=3 * min(1, max(0, t - 2))"]
        whole = "--set=Steps->Times={0.5, 1, 2, 3, 3.5, 4, 5}"
        self.rpc(*arguments, whole, "--set=Steps->Checkpoint Every=4", "--output=whole")
        self.rpc(*arguments, "--set=Steps->Times={0.5, 1, 2, 3}", "--set=Steps->Checkpoint Every=4", "--output=part")
        self.rpc(*arguments, whole, "--set=Steps->Checkpoint Every=4", "--output=part", "--restart")
        for name in ["track.history.csv", "track.contact.csv"]:
            a, b = (rows(self.folder / folder / name) for folder in ("whole", "part"))
            for one, other in zip(a, b, strict=True):
                for key in one:
                    if key != "seconds":
                        self.assertEqual(one[key], other[key], (name, key))


if __name__ == "__main__":
    unittest.main()

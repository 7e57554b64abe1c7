# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles on springs: series of springs by hand, springs so stiff or so soft that they are a path or a force, and what they are refused for."""

import json
import unittest

from obstacle_forces import (ABOVE_NODE, BAD_INPUT, BALL, BEFORE_AXIS, BOX, CUBE, NO_SOLUTION, ROLLER, RUBS, SAME, SPRINGS, STEPS, YIELDS, by_force,
                             by_path, written)
from rpc_run import RANKS, WrittenDeckTestCase

# A column of 2 m by 1 m without lateral strain gives way by its force over 4000 N/m; a plate lies on it, or hangs above it.
COLUMN = BOX.replace("Poisson's Ratio: 0.3", "Poisson's Ratio: 0.0").replace("X: 0.0, Y: 0.0", "Y: 0.0}\n    left: {X: 0.0")
K = 4000.0


def plate(height, *parameters):
    return ", ".join([f"Type: plane, Point: [0.0, {height}], Normal: [0.0, -1.0]", *parameters])


def on_spring(obstacle, force, stiffness):
    return by_force(obstacle, force) + f", Stiffness Y: {stiffness!r}"


class ObstacleSprings(WrittenDeckTestCase):
    def expect_column(self, name, deck, moved, force, stiffness, energy=None):
        """Displacement of the plate, force on the body, and force of the plate's spring."""
        found = self.solve(name, deck)
        self.assertAlmostEqual(found["obstacle_displacement"][1], moved, delta=SAME * abs(moved))
        self.assertAlmostEqual(found["contact_force"][1], force, delta=SAME * max(1, abs(force)))
        self.assertAlmostEqual(found["obstacle_spring_force"][1], -stiffness * moved, delta=SAME * stiffness * abs(moved))
        self.assertEqual(found["obstacle_spring_force"][0], 0)
        self.assertAlmostEqual(found["reaction_force"]["bottom"][1], -force, delta=SAME * max(1, abs(force)))
        if energy is not None:
            self.assertAlmostEqual(found["energy_J"], energy, delta=1e-9 * abs(energy))
        return found

    def test_springs_in_series_by_hand(self):
        k = 1000.0
        for element in ("Q1", "P2"):
            with self.subTest(element=element):
                d = -25 / (k + K)
                self.expect_column("touches", written(COLUMN, plate(1.0, "Force Y: -25.0", f"Stiffness Y: {k}"), element), d, K * d, k, 25 * d / 2)
                x = -(25 - 0.01 * k) / (k + K)  # of the column, once the plate has gone the first 0.01 m
                self.expect_column("comes", written(COLUMN, plate(1.01, "Force Y: -25.0", f"Stiffness Y: {k}"), element), x - 0.01, K * x, k)
                x = -0.01 * k / (k + K)  # the plate starts in the body, at rest: a spring alone
                self.expect_column("overlaps", written(COLUMN, plate(0.99, f"Stiffness Y: {k}"), element), 0.01 + x, K * x, k)
                self.expect_column("hangs", written(COLUMN, plate(1.1, "Force Y: -25.0", f"Stiffness Y: {k}"), element), -0.025, 0, k, -25 * 0.025 / 2)
        # The foundation carries 16 N, and no more of a force of 25 N: the spring bears the rest.
        found = self.expect_column("yields", written(COLUMN, plate(1.0, "Force Y: -25.0", f"Stiffness Y: {k}"), "Q1", law="Yield Stress: 8.0"), -9 / k, -16, k)
        self.assertAlmostEqual(found["max_penetration"], 9 / k - 16 / K, delta=1e-10)
        self.refuse(written(COLUMN, plate(1.0, "Force Y: -25.0"), "Q1", law="Yield Stress: 8.0"), NO_SOLUTION, ["carries at most 16"])

    def test_a_spring_whose_end_follows_a_path_presses_by_what_it_is_compressed(self):
        k, path, times = 500.0, [-0.01, -0.03, -0.02], "{Times: [1, 2, 3]}"
        force = f'"{k}*(t < 1.5 ? {path[0]} : t < 2.5 ? {path[1]} : {path[2]})"'
        self.solve("pressed", written(COLUMN, plate(1.0, f"Force Y: {force}", f"Stiffness Y: {k}"), "Q1", more=f"Steps: {times}"))
        for moved, pressed, drawn, end in zip(*self.columns("pressed", "obstacle_displacement_y", "contact_force_y", "obstacle_spring_force_y"), path):
            self.assertAlmostEqual(moved, k * end / (k + K), delta=SAME)
            self.assertAlmostEqual(pressed, k * (end - moved), delta=SAME * K)
            self.assertAlmostEqual(drawn, -k * moved, delta=SAME * K)

    def test_a_spring_and_its_force_lead_to_the_place_that_takes_both(self):
        axisymmetric = "Kinematics: axisymmetric"
        scenes = [(BOX, ROLLER, "Q2", YIELDS, 0.02, "", 3e3), (BOX, ROLLER, "P1", SPRINGS, 0.03, "", 50.0), (BOX, ABOVE_NODE, "P2", RUBS, 0.02, "", 1e3),
                  (BOX, BEFORE_AXIS, "Q2", YIELDS, 0.02, axisymmetric, 1e3), (CUBE, BALL, "Q1", "Yield Stress: 3.0e+7", 0.01, "", 1e9)]
        for deck, obstacle, element, law, depth, kinematics, k in scenes:
            with self.subTest(element=element, law=law, kinematics=kinematics):
                given = self.solve("moved", written(deck, by_path(obstacle, f"-{depth}*t"), element, law, kinematics=kinematics))
                pressed = given["contact_force"][1]
                force = pressed - k * depth
                found = self.solve("pressed", written(deck, on_spring(obstacle, repr(force), k), element, law, kinematics=kinematics))
                self.assertAlmostEqual(found["obstacle_displacement"][1], -depth, delta=SAME * depth)
                self.assertAlmostEqual(found["contact_force"][1], pressed, delta=SAME * max(abs(pressed), k * depth))
                self.assertAlmostEqual(found["obstacle_spring_force"][1], k * depth, delta=SAME * k * depth)
                of_tool = -force * -depth + k * depth ** 2 / 2
                self.assertAlmostEqual(found["energy_J"], given["energy_J"] + of_tool, delta=1e-9 * max(abs(of_tool), abs(given["energy_J"])))

    def test_a_stiff_spring_is_a_path_and_a_soft_one_a_force(self):
        depth, stiff, soft = 0.02, 1e9, 1e-6
        given = self.solve("path", written(BOX, by_path(ROLLER, f"-{depth}*t"), law=YIELDS))
        force = given["contact_force"][1]
        found = self.solve("stiff", written(BOX, on_spring(ROLLER, repr(-stiff * depth), stiff), law=YIELDS))
        self.assertAlmostEqual(found["obstacle_displacement"][1], -depth, delta=2 * abs(force) / stiff)
        self.assertAlmostEqual(found["contact_force"][1], force, delta=1e-5 * abs(force))
        found = self.solve("soft", written(BOX, on_spring(ROLLER, repr(force), soft), law=YIELDS))
        self.assertAlmostEqual(found["obstacle_displacement"][1], -depth, delta=1e-7 * depth)
        self.assertAlmostEqual(found["contact_force"][1], force, delta=1e-8 * abs(force))

    def test_a_spring_holds_a_tool_that_friction_alone_does_not(self):
        pushed = plate(1.0, "Force Y: -25.0", "Force X: 40.0")
        self.refuse(written(BOX, pushed, "Q1", law=RUBS), NO_SOLUTION, ["friction holds at most 7.5"])
        found = self.solve("held", written(BOX, pushed + ", Stiffness X: 100.0", "Q1", law=RUBS))
        self.assertAlmostEqual(found["contact_force"][0], 7.5, delta=1e-7)  # all of it slips
        self.assertAlmostEqual(found["contact_force"][1], -25, delta=1e-8)
        self.assertAlmostEqual(found["obstacle_spring_force"][0], -32.5, delta=1e-6)
        self.assertAlmostEqual(found["obstacle_displacement"][0], 0.325, delta=1e-8)

    def test_the_way_of_a_tool_to_its_first_touch_is_no_slip_beside_a_stiff_spring_across(self):
        roller = "Type: sphere, Radius: 1.0, Centre: [0.99, 2.5], Force Y: -60.0"
        held, on_spring_across = (self.solve(name, written(BOX, roller + more, "Q1", law=RUBS)) for name, more in (("held", ""), ("sprung", ", Stiffness X: 1.0e+9")))
        for found, expected in zip(on_spring_across["contact_force"], held["contact_force"]):
            self.assertAlmostEqual(found, expected, delta=1e-6)
        self.assertAlmostEqual(on_spring_across["energy_J"], held["energy_J"], delta=1e-8)

    def test_a_tool_that_springs_hold_before_it_touches_strains_nothing(self):
        pressed = plate(1.1, "Force X: 3.0", "Stiffness X: 50.0", "Force Y: -20.0", "Stiffness Y: 300.0")
        found = self.solve("hangs", written(BOX, pressed, "Q1", law=RUBS))
        self.assertEqual(found["contact_force"], [0, 0])
        for moved, expected in zip(found["obstacle_displacement"], (3 / 50, -20 / 300)):
            self.assertAlmostEqual(moved, expected, delta=SAME)

    def test_a_force_that_jumps_at_one_place_ends_the_search_there(self):
        # One node lies in a groove whose walls push the tool to and fro: the force of the spring is nowhere that of the node.
        heights = [(0.01 * i, 0.105 + 0.005 * abs(i - 5)) for i in range(11)]
        (self.folder / "groove.csv").write_text("\n".join(["x,height"] + [f"{x},{h}" for x, h in heights]))
        groove = "Type: height map, File: groove.csv, Normal: [0.0, -1.0], Interpolation: bilinear, Origin: [0.83, 1.1], Stiffness X: 1.0"
        self.solve("groove", written(BOX, groove, "Q1", more="Steps: {Times: [1], Max Halvings: 0}"), code=4)
        found = json.loads((self.folder / "groove" / "groove.json").read_text())
        self.assertIn("jumps at one place", found["reason"])
        self.assertLess(found["uzawa_iterations"], 50)  # as many as halve the way to the tolerance of 1e-11

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_a_restart_goes_on_with_the_same_digits(self):
        force = '"t < 1 ? -60*t : t < 1.5 ? -60 + 40*(t - 1) : -40 - 100*(t - 1.5)"'
        self.expect_restart_with_the_same_digits(written(BOX, on_spring(ROLLER, force, 700.0), law=YIELDS, more=STEPS))

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_error_bars_of_the_spring_and_of_the_way(self):
        k = 2e3
        deck = written(BOX, on_spring(ROLLER, "-80.0", k), "P2", law=YIELDS).replace("Uzawa: {Tolerance: 1.0e-11}", "Adapt: {Target Relative Error: 0.05}")
        coarse, fine = (self.solve(name, deck.replace("0.05", target))["results"] for name, target in (("coarse", "0.05"), ("fine", "0.01")))
        for key in ("obstacle_displacement", "obstacle_spring_force", "contact_force", "energy_J"):
            values = [each[key]["value"] if isinstance(each[key]["value"], list) else [each[key]["value"]] for each in (coarse, fine)]
            self.assertLessEqual(sum((a - b) ** 2 for a, b in zip(*values)) ** 0.5, coarse[key]["error_bar"] + fine[key]["error_bar"], key)
            self.assertGreater(coarse[key]["error_bar"], 0)
        self.assertAlmostEqual(coarse["obstacle_spring_force"]["error_bar"], k * coarse["obstacle_displacement"]["error_bar"], delta=1e-12 * k)

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_what_is_not_supported_is_refused(self):
        self.refuse(written(BOX, on_spring(ROLLER, "-1.0", -2.0)), BAD_INPUT, ['"Contact->Obstacle->Stiffness Y" must be finite and >= 0, got -2'])
        self.refuse(written(BOX, by_force(ROLLER, "-1.0") + ", Stiffness Z: 1.0"), BAD_INPUT, ["Stiffness Z", "does not have"])
        self.refuse(written(BOX, plate('"1.0 - 0.01*t"', "Stiffness Y: 1.0")), BAD_INPUT, ["where the obstacle starts", "Stiffness Y", "Leave one of them out"])
        self.refuse(written(BOX, "Stiffness Y: 1.0"), BAD_INPUT, ["no obstacle to move"])
        self.refuse(written(BOX, plate(1.0, "Stiffness Y: 1.0")).replace(", Y: 0.0", ""), BAD_INPUT, ["Stiffness Y", "nothing holds along Y"])
        revolved = written(BOX, by_force(BEFORE_AXIS, "-1.0") + ", Stiffness X: 1.0", kinematics="Kinematics: axisymmetric")
        self.refuse(revolved, BAD_INPUT, ["Stiffness X", "off its axis"])
        bound = written(BOX, plate(1.0, "Stiffness Y: 1.0"), more="Adapt: {Target Relative Error: 0.1, Error Bound: guaranteed}")
        self.refuse(bound, BAD_INPUT, ["Error Bound"])


if __name__ == "__main__":
    unittest.main()

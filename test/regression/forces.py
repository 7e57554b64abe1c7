# SPDX-License-Identifier: BSD-3-Clause
"""Sides and tools that a force moves: what displacement it leads to, what it is refused for, and that a restart goes on with the same digits."""

import unittest

from rpc_run import RANKS, WrittenDeckTestCase

BAD_INPUT, NO_SOLUTION = 2, 5
SAME = 1e-10
BOX = """ram:
  Mesh: {Upper: [2.0, 1.0], Cells: [16, 8], Element: Q2}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet:
    top: {X: 0.0, TOP}
  Contact:
    Side: bottom
    LAW
    Obstacle: {Type: sphere, Centre: [0.9, -3.0], Radius: 3.0}
  Uzawa: {Tolerance: 1.0e-11}
  MORE
"""
BALL = """ball:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.2], Cells: [5, 5, 6], Element: P1}
  Material: {Young's Modulus: 1.0e9, Poisson's Ratio: 0.3}
  Dirichlet:
    top: {X: 0.0, Z: 0.0, TOP}
  Contact:
    Side: bottom
    LAW
    Obstacle: {Type: sphere, Centre: [0.5, -4.0, 0.5], Radius: 4.0}
  Uzawa: {Tolerance: 1.0e-11}
  MORE
"""
SOFT = """tool:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.1, 1.0], Cells: [20, 18], Element: Q1}
  Kinematics: axisymmetric
  Material: {Young's Modulus: 200.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: 0.0}}
  Contact:
    Side: bottom
    Stiffness: 25.0
    Obstacle: {Type: sphere, Radius: 1.0, Centre: [0.0, -1.0], TOP}
  Output: {Exodus: false}
"""
EDGE = """edge:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [2.84597, 1.0, 0.995], Cells: [23, 8, 8], Element: P1}
  Material: {Young's Modulus: 2400.0, Poisson's Ratio: 0.2}
  Dirichlet: {top: {X: 0.0, Y: 0.0, Z: 0.0}}
  Contact:
    Side: bottom
    Obstacle: {Type: wedge, Normal: [0.0, 1.0, 0.0], Axis: [0.0, 0.0, 1.0], Slope: 0.068, Edge Radius: 2.9, Point: [1.9157, PLACE, 0.5], FORCE}
  Uzawa: {Tolerance: 1.0e-11}
  Output: {Exodus: false}
"""
YIELDS, SPRINGS, RUBS = "Yield Stress: 40.0", "Stiffness: 3000.0\n    Yield Stress: 60.0", "Friction Coefficient: 0.3"
TWO_MOTIONS = """tool:
  Mesh: {Lower: [-1.0, 0.0], Upper: [1.0, 1.0], Cells: [32, 16], Element: Q2}
  Material: {Young's Modulus: 200.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {Y: 0.0, Force X: 1.0362e-6}}
  Contact:
    Side: bottom
    Obstacle: {Type: sphere, Radius: 5.0, Centre: [0.076, -5.0], Force Y: 3.4e-3}
  Output: {Exodus: false}
"""
STEPS = "Steps: {Times: [0.5, 1.0, 1.5, 2.0]}"
FORCE = '"t < 1 ? -30*t : t < 1.5 ? -30 + 20*(t - 1) : -20 - 50*(t - 1.5)"'


def written(deck, top, law="", more=""):
    return deck.replace("TOP", top).replace("LAW", law).replace("MORE", more)


class Forces(WrittenDeckTestCase):
    def test_a_force_leads_to_the_displacement_that_takes_it(self):
        for deck, law, depth in [(BOX, "", 0.02), (BOX, YIELDS, 0.01), (BOX, SPRINGS, 0.03), (BOX, RUBS, 0.02), (BALL, "Yield Stress: 3.0e+7", 0.01)]:
            with self.subTest(law=law, depth=depth):
                given = self.solve("moved", written(deck, f"Y: {-depth}", law))
                force = given["reaction_force"]["top"]
                found = self.solve("pressed", written(deck, f"Force Y: {force[1]!r}", law))
                self.assertAlmostEqual(found["force_displacement"]["top"][1], -depth, delta=SAME * depth)
                self.assertAlmostEqual(found["reaction_force"]["top"][1], force[1], delta=SAME * abs(force[1]))
                self.assertAlmostEqual(found["contact_force"][1], -force[1], delta=SAME * abs(force[1]))
                self.assertLessEqual(sum(found["newton_iterations"]), 1.5 * sum(given["newton_iterations"]) + 5)

    def test_a_tool_on_soft_springs_takes_as_few_steps_by_its_force_as_by_its_path(self):
        for force in (1.5e-4, 5e-4, 2e-3):  # one point bears it, two, more
            with self.subTest(force=force):
                found = self.solve("pressed", written(SOFT, f"Force Y: {force!r}"))
                moved = found["obstacle_displacement"][1]
                given = self.solve("moved", SOFT.replace("[0.0, -1.0], TOP", f'[0.0, "-1.0 + {moved!r}*t"]'))
                self.assertAlmostEqual(given["contact_force"][1], force, delta=1e-7 * force)
                self.assertLessEqual(sum(found["newton_iterations"]), sum(given["newton_iterations"]) + 2)

    def test_searches_for_a_curved_tool_take_no_more_steps_than_its_path(self):
        given = self.solve("moved", EDGE.replace("PLACE", '"0.0065*t"').replace(", FORCE", ""))
        found = self.solve("pressed", EDGE.replace("PLACE", "0.0").replace("FORCE", f"Force Y: {given['contact_force'][1]!r}"))
        self.assertAlmostEqual(found["obstacle_displacement"][1], 0.0065, delta=SAME * 0.0065)
        self.assertLessEqual(sum(found["newton_iterations"]), sum(given["newton_iterations"]))

    def test_a_tool_moves_along_one_direction_and_its_body_along_another_that_contact_alone_holds(self):
        found = self.solve("pressed", TWO_MOTIONS)  # predicted with one point closed, which holds one of the two
        for force, given in zip(found["contact_force"], (-1.0362e-6, 3.4e-3)):
            self.assertAlmostEqual(force, given, delta=1e-7 * 3.4e-3)

    def test_a_history_of_forces_follows_its_dents_and_its_work_is_that_of_the_path(self):
        self.solve("pressed", written(BOX, f"Force Y: {FORCE}", YIELDS, STEPS))
        rows = self.history("pressed")
        moved = [float(next(v for k, v in row.items() if k.startswith("top_displacement_y"))) for row in rows]
        self.assertEqual(len(rows), 4)
        self.assertLess(moved[3], moved[1])
        self.assertLess(moved[1], moved[2])  # lifted, but not back to where it was: the dent stays
        self.assertLess(moved[2], moved[0])
        path = f'"t < 0.75 ? {moved[0]!r} : t < 1.25 ? {moved[1]!r} : t < 1.75 ? {moved[2]!r} : {moved[3]!r}"'
        self.solve("moved", written(BOX, f"Y: {path}", YIELDS, STEPS))
        for row, force in zip(self.history("moved"), [-15, -30, -20, -45]):
            reaction = float(next(v for k, v in row.items() if k.startswith("top_reaction_y")))
            self.assertAlmostEqual(reaction, force, delta=1e-8 * 45)
        for row, by_path in zip(rows, self.history("moved")):  # the force does the work that the supports do
            for key in ("work", "strain_energy", "dissipated_energy"):
                self.assertAlmostEqual(float(row[key]), float(by_path[key]), delta=1e-8 * float(rows[-1]["work"]))

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_a_restart_goes_on_with_the_same_digits(self):
        self.expect_restart_with_the_same_digits(written(BOX, f"Force Y: {FORCE}", YIELDS, STEPS))

    def test_what_a_foundation_cannot_bear_has_no_solution(self):
        self.refuse(written(BOX, "Force Y: -80.5", YIELDS), NO_SOLUTION, ["carries at most 78.55", '"Contact->Yield Stress"'])
        self.refuse(written(BOX, "Force Y: 3.0", YIELDS), NO_SOLUTION, ["pulls the body away from the foundation", "3 [N/m]"])
        self.refuse(written(BOX, "Force Y: 0.0", YIELDS), NO_SOLUTION, ["nothing presses the body"])
        near = self.solve("near", written(BOX, "Force Y: -75.0", YIELDS))
        self.assertAlmostEqual(near["contact_force"][1], 75, delta=1e-9)

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_what_is_not_supported_is_refused(self):
        point = "Dirichlet:\n    corner: {Side: left top, Force Y: -1.0}"
        self.refuse(written(BOX, "Y: 0.0").replace("Dirichlet:", point), BAD_INPUT, ["corner->Force Y", "must move a side"])
        self.refuse(written(BOX, "Y: 0.0, Force Y: -1.0"), BAD_INPUT, ["Y or Force Y", "Leave one of them out"])
        self.refuse(written(BOX, 'Force Y: "-x"'), BAD_INPUT, ["must not depend on x, y or z"])
        self.refuse(written(BOX, "Force Z: 1.0"), BAD_INPUT, ["Force Z", "does not have"])
        left = "Dirichlet:\n    left: {Y: 0.0}"
        self.refuse(written(BOX, "Force Y: -1.0").replace("Dirichlet:", left), BAD_INPUT, ["both hold Y of one node", '"Force Y" is to move it'])
        side = written(BOX, "Y: 0.0").replace("top: {X: 0.0, Y: 0.0}", "left: {X: 0.0, Force Y: -40.0}").replace("[0.9, -3.0]", "[0.1, -3.0]")
        self.refuse(side, BAD_INPUT, ["the node at (0, 0)", "touches"])
        slope = written(BOX, "Y: -0.02").replace("top: {X: 0.0, Y: -0.02}", "right: {X: 0.0, Y: -0.02}\n    left: {Force X: 10.0}")
        slope = slope.replace("{Type: sphere, Centre: [0.9, -3.0], Radius: 3.0}", "{Type: plane, Point: [0.0, 0.0], Normal: [0.4, 1.0]}")
        self.refuse(slope, BAD_INPUT, ["the node at (0, 0)", "touches"])  # the force draws it off, and a pressure without it was to be seen
        drawn = written(BOX, "Y: 0.0").replace("top: {X: 0.0, Y: 0.0}", "top: {Y: -0.01}\n    left: {Force X: 1.0}")
        self.refuse(drawn.replace("LAW", "").replace("Side: bottom", "Side: bottom\n    Friction Coefficient: 0.2"), BAD_INPUT, ["has friction"])
        revolved = written(BOX, "Y: -0.001").replace("ram:", "ram:\n  Kinematics: axisymmetric").replace("X: 0.0, Y", "Force X: 1.0, Y")
        self.refuse(revolved.replace("[0.9, -3.0]", "[0.0, -3.0]"), BAD_INPUT, ["along its radius"])


if __name__ == "__main__":
    unittest.main()

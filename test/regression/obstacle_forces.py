# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles that a force moves: where it leads them, what they are refused for, and that a restart goes on with the same digits."""

import unittest

from rpc_run import RANKS, WrittenDeckTestCase

BAD_INPUT, NO_SOLUTION = 2, 5
SAME = 1e-10
BOX = """tool:
  KINEMATICS
  Mesh: {Upper: [2.0, 1.0], Cells: [16, 8], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet:
    bottom: {X: 0.0, Y: 0.0}
  Contact:
    Side: top
    LAW
    Obstacle: {OBSTACLE}
  Uzawa: {Tolerance: 1.0e-11}
  Output: {Exodus: false}
  MORE
"""
CUBE = """tool:
  KINEMATICS
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.2], Cells: [5, 5, 6], Element: ELEMENT}
  Material: {Young's Modulus: 1.0e9, Poisson's Ratio: 0.3}
  Dirichlet:
    bottom: {X: 0.0, Y: 0.0, Z: 0.0}
  Contact:
    Side: top
    LAW
    Obstacle: {OBSTACLE}
  Uzawa: {Tolerance: 1.0e-11}
  Output: {Exodus: false}
  MORE
"""
YIELDS, SPRINGS, RUBS = "Yield Stress: 40.0", "Stiffness: 3000.0\n    Yield Stress: 60.0", "Friction Coefficient: 0.3"
ROLLER = "Type: sphere, Radius: 3.0, Centre: [0.9, 4.0 PATH] FORCE"
ABOVE_NODE = ROLLER.replace("0.9", "0.875")  # touches at once where it starts, from where a path counts its slip
BALL = "Type: sphere, Radius: 4.0, Centre: [0.5, 5.0 PATH, 0.55] FORCE"
BEFORE_AXIS = "Type: sphere, Radius: 3.0, Centre: [0.0, 4.0 PATH] FORCE"
STEPS = "Steps: {Times: [0.5, 1.0, 1.5, 2.0]}"
FORCE = '"t < 1 ? -30*t : t < 1.5 ? -30 + 20*(t - 1) : -20 - 50*(t - 1.5)"'


def written(deck, obstacle, element="Q2", law="", more="", kinematics=""):
    for word, text in (("ELEMENT", element), ("OBSTACLE", obstacle), ("LAW", law), ("MORE", more), ("KINEMATICS", kinematics)):
        deck = deck.replace(word, text)
    return deck


def by_path(obstacle, path):
    return obstacle.replace(" FORCE", "").replace("5.0 PATH", f'"5.0 + ({path})"').replace("4.0 PATH", f'"4.0 + ({path})"')


def by_force(obstacle, force):
    return obstacle.replace(" FORCE", f", Force Y: {force}").replace(" PATH", "")


class ObstacleForces(WrittenDeckTestCase):
    def test_a_force_leads_to_the_place_that_takes_it(self):
        axisymmetric = "Kinematics: axisymmetric"
        scenes = [(BOX, ROLLER, "Q2", "", 0.02, ""), (BOX, ROLLER, "P1", YIELDS, 0.01, ""), (BOX, ROLLER, "Q1", SPRINGS, 0.03, ""),
                  (BOX, ABOVE_NODE, "P2", RUBS, 0.02, ""), (BOX, BEFORE_AXIS, "Q2", YIELDS, 0.02, axisymmetric), (CUBE, BALL, "P1", "Yield Stress: 3.0e+7", 0.01, ""),
                  (CUBE, BALL, "Q1", "", 0.01, "")]
        for deck, obstacle, element, law, depth, kinematics in scenes:
            with self.subTest(element=element, law=law, kinematics=kinematics):
                given = self.solve("moved", written(deck, by_path(obstacle, f"-{depth}*t"), element, law, kinematics=kinematics))
                force = given["contact_force"][1]
                found = self.solve("pressed", written(deck, by_force(obstacle, repr(force)), element, law, kinematics=kinematics))
                self.assertAlmostEqual(found["obstacle_displacement"][1], -depth, delta=SAME * depth)
                self.assertAlmostEqual(found["contact_force"][1], force, delta=SAME * abs(force))
                self.assertAlmostEqual(found["reaction_force"]["bottom"][1], -force, delta=SAME * abs(force))
                work = force * -depth
                self.assertAlmostEqual(found["energy_J"], given["energy_J"] - work, delta=1e-9 * abs(work))
                self.assertLessEqual(sum(found["newton_iterations"]), 1.5 * sum(given["newton_iterations"]) + 5)

    def test_the_way_of_a_tool_to_its_first_touch_is_no_slip(self):
        found = []
        for height in (4.0, 4.5, 3.98):  # near, away, in the body
            deck = written(BOX, by_force(ROLLER.replace("4.0", repr(height)), "-40.0"), "Q1", law=RUBS, more="Steps: {Times: [1, 2]}")
            found.append(self.solve(f"from_{height}", deck))
            self.assertAlmostEqual(found[-1]["obstacle_displacement"][1], 4.0 - height - 0.024, delta=1e-4)
        for key in ("max_shear", "stick_length", "slip_length", "dissipated_by_friction", "work", "strain_energy"):
            values = [each["steps"][0][key] for each in found]
            for value in values:
                self.assertAlmostEqual(value, values[0], delta=1e-7 * max(map(abs, values)), msg=key)
        self.assertGreater(found[0]["steps"][0]["stick_length"], 0)

    def test_a_plate_bears_its_force_and_the_weight_of_the_body_goes_to_the_support(self):
        plate = "Type: plane, Point: [0.0, 7.0], Normal: [0.0, -1.0], Force Y: -25.0"
        found = self.solve("pressed", written(BOX, plate, "Q1", more="Body Force: {Y: -3.0}"))
        self.assertAlmostEqual(found["contact_force"][1], -25, delta=25 * SAME)
        self.assertAlmostEqual(found["reaction_force"]["bottom"][1], 31, delta=31 * SAME)
        self.assertLess(found["obstacle_displacement"][1], -6)

    def test_a_place_at_which_the_force_that_a_tool_takes_jumps_is_found_between_two(self):
        # Three nodes touch and yield, all but for friction that is all of the force; from below the place a fourth begins to touch.
        cone = ("Type: cone, Axis: [0.0, 1.0], Slope: 0.13687668491206686, Tip Radius: 3.290138423748068, "
                "Point: [0.992840369380968, -0.0007880879981054542], Force Y: 2083934.224630031")
        law = "Yield Stress: 11166060.513133796\n    Friction Coefficient: 0.05503298101677036"
        deck = written(BOX, cone, "P1", law).replace("[2.0, 1.0]", "[2.4870137989238374, 1.0]").replace("[16, 8]", "[40, 19]").replace("top", "bottom")
        deck = deck.replace("bottom: {X", "top: {X").replace("Young's Modulus: 2000.0", "Young's Modulus: 11528961291.460278").replace("Ratio: 0.3", "Ratio: 0.45")
        found = self.solve("jumps", deck)
        self.assertAlmostEqual(found["contact_force"][1], 2083934.224630031, delta=1e-8 * 2083934)
        self.assertAlmostEqual(found["yielded_length"], found["contact_length"], delta=1e-12)

    def test_a_history_of_forces_follows_its_dents_and_its_work_is_that_of_the_path(self):
        self.solve("pressed", written(BOX, by_force(ROLLER, FORCE), law=YIELDS, more=STEPS))
        (moved,) = self.columns("pressed", "obstacle_displacement_y")
        self.assertEqual(len(moved), 4)
        self.assertLess(moved[3], moved[1])
        self.assertLess(moved[1], moved[2])  # lifted, but not back to where it was: the dent stays
        self.assertLess(moved[2], moved[0])
        path = f"t < 0.75 ? {moved[0]!r} : t < 1.25 ? {moved[1]!r} : t < 1.75 ? {moved[2]!r} : {moved[3]!r}"
        self.solve("moved", written(BOX, by_path(ROLLER, path), law=YIELDS, more=STEPS))
        names = ("contact_force_y", "work", "strain_energy", "dissipated_energy")
        for name, pressed, given in zip(names, self.columns("pressed", *names), self.columns("moved", *names)):
            for a, b in zip(pressed, given):
                self.assertAlmostEqual(a, b, delta=1e-8 * max(map(abs, given)), msg=name)

    def test_a_tool_that_is_pressed_and_dragged_rubs_with_mu_times_the_force(self):
        plate = 'Type: plane, Point: ["0.02*max(t - 1, 0)", 1.0], Normal: [0.0, -1.0], Force Y: "-25*min(t, 1)"'
        found = self.solve("dragged", written(BOX, plate, "Q1", law=RUBS, more="Steps: {Times: [1, 2, 3]}"))
        self.assertAlmostEqual(found["contact_force"][1], -25, delta=1e-9)
        self.assertAlmostEqual(found["contact_force"][0], 0.3 * 25, delta=1e-7)
        pushed = 'Type: plane, Point: [0.0, 1.0], Normal: [0.0, -1.0], Force Y: -25.0, Force X: "5*(t - 1)"'
        found = self.solve("pushed", written(BOX, pushed, "Q1", law=RUBS, more="Steps: {Times: [1, 2]}"))
        self.assertAlmostEqual(found["contact_force"][0], 5, delta=1e-9)
        self.assertGreater(found["obstacle_displacement"][0], 0)
        self.refuse(written(BOX, pushed.replace("5*", "8*"), "Q1", law=RUBS, more="Steps: {Times: [2]}"), NO_SOLUTION, ["friction holds at most 7.5"])

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_a_restart_goes_on_with_the_same_digits(self):
        self.expect_restart_with_the_same_digits(written(BOX, by_force(ROLLER, FORCE), law=YIELDS, more=STEPS))

    def test_what_a_foundation_cannot_bear_has_no_solution(self):
        self.refuse(written(BOX, by_force(ROLLER, "-80.5"), law=YIELDS), NO_SOLUTION, ["carries at most 7", '"Contact->Yield Stress"', "the other way round"])
        self.refuse(written(BOX, by_force(ROLLER, "3.0"), law=YIELDS), NO_SOLUTION, ["meets no node", "Turn the force round"])
        self.refuse(written(BOX, by_force(ROLLER, "0.0"), law=YIELDS), NO_SOLUTION, ["nothing presses the body"])

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_what_is_not_supported_is_refused(self):
        self.refuse(written(BOX, by_force(ROLLER, '"-x"')), BAD_INPUT, ["must not depend on x, y or z"])
        self.refuse(written(BOX, by_force(ROLLER, "-1.0") + ", Force Z: 1.0"), BAD_INPUT, ["Force Z", "does not have"])
        self.refuse(written(BOX, by_force(ROLLER.replace("4.0 PATH", '"4.0 - t"'), "-1.0")), BAD_INPUT, ["where the obstacle starts", "Leave one of them out"])
        self.refuse(written(BOX, "Force Y: -1.0"), BAD_INPUT, ["no obstacle to move"])
        ram = written(BOX, by_force(ROLLER, "-1.0")).replace("Y: 0.0", "Force Y: 1.0")
        self.refuse(ram, BAD_INPUT, ["both to move along one direction"])
        self.refuse(written(BOX, by_force(ROLLER, "-1.0")).replace("Y: 0.0", "Y: 0.1"), BAD_INPUT, ["must be 0 where a force or a spring moves the obstacle"])
        self.refuse(written(BOX, by_force(ROLLER, "-1.0")).replace(", Y: 0.0", ""), BAD_INPUT, ["nothing holds along Y"])
        two = written(BOX, by_force(ROLLER, "-1.0")).replace("Side: top", "Side: top\n    Sides: {right: {Gap: 1.0}}")
        self.refuse(two, BAD_INPUT, ["is another foundation"])
        revolved = written(BOX, by_force(BEFORE_AXIS, "-1.0").replace("Force Y", "Force X"), kinematics="Kinematics: axisymmetric")
        self.refuse(revolved, BAD_INPUT, ["off its axis"])
        held = written(BOX, "Type: plane, Point: [0.0, 1.0], Normal: [0.0, -1.0], Force Y: -1.0").replace("bottom:", "left:")
        self.refuse(held, BAD_INPUT, ["the node at (0, 1)", "touches", "is held along a direction"])


if __name__ == "__main__":
    unittest.main()

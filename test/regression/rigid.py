# SPDX-License-Identifier: BSD-3-Clause
"""Rigid sides: closed forms, equalities, how forces and motions lead to each other, what is refused, and a restart with the same digits."""

import math
import unittest

from rpc_run import RANKS, WrittenDeckTestCase

BAD_INPUT, NO_SOLUTION = 2, 5
SAME = 1e-10
MODULUS = 2000.0
BEAM = """beam:
  Mesh: {Upper: [4.0, 1.0], Cells: [8, 2], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.0}
  Dirichlet: {left: {X: 0.0}, corner: {Side: left bottom, Y: 0.0}}
  Rigid: {right: {Moment Z: 3.0}}
"""
BAR = """bar:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 3.0, 1.0], Cells: [2, 6, 2], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet: {bottom: {X: 0.0, Y: 0.0, Z: 0.0}}
  Rigid: {top: {TOP}}
  Uzawa: {Tolerance: 1.0e-11}
"""
PUNCH = """punch:
  Mesh: {Upper: [2.0, 1.0], Cells: [16, 8], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Rigid:
    top: {TOP}
  Contact:
    Side: bottom
    LAW
  Uzawa: {Tolerance: 1.0e-11}
  MORE
"""
BLOCK = PUNCH.replace("Upper: [2.0, 1.0], Cells: [16, 8]", "Lower: [0.0, 0.0, 0.0], Upper: [2.0, 1.0, 1.0], Cells: [6, 4, 4]")
ROLLER = "Obstacle: {Type: sphere, Centre: [0.9, -3.0], Radius: 3.0}"
BALL = "Obstacle: {Type: sphere, Centre: [0.9, -3.0, 0.6], Radius: 3.0}"
STEPS = "Steps: {Times: [0.5, 1.0, 1.5, 2.0]}"
FORCE = '"t < 1 ? -20*t : t < 1.5 ? -20 + 16*(t - 1) : -12 - 30*(t - 1.5)"'


def written(deck, top="", law="", more="", element="Q2"):
    return deck.replace("TOP", top).replace("LAW", law).replace("MORE", more).replace("ELEMENT", element)


class Rigid(WrittenDeckTestCase):
    def near(self, found, wanted, size, same=SAME):
        found, wanted = (list(each) if isinstance(each, (list, tuple)) else [each] for each in (found, wanted))
        self.assertEqual(len(found), len(wanted))
        for a, b in zip(found, wanted):
            self.assertAlmostEqual(a, b, delta=same * size)

    def test_a_moment_bends_a_beam_by_the_closed_form(self):
        inertia, moment, length = 1 / 12, 3.0, 4.0
        turned = moment * length / (MODULUS * inertia)
        for element in ("Q2", "P2"):
            with self.subTest(element=element):
                end = self.solve("beam", written(BEAM, element=element))["rigid"]["right"]
                self.near(end["rotation"], turned, turned)
                self.near(end["displacement"], [0, turned * length / 2], turned)
                self.near(end["point"], [4, 0.5], 1)
                self.near(end["moment"], moment, moment, 1e-8)
                self.near(end["force"], [0, 0], moment, 1e-8)

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_prescribed_motions_are_those_of_dirichlet(self):
        arm = "x - 0.5", "z - 0.25"
        for element in ("P1", "P2", "Q1", "Q2"):
            turned = self.solve("turned", written(BAR, "Point: [0.5, 3.0, 0.25], X: 0.01, Y: -0.02, Z: 0.0, Rotation X: 0.01, Rotation Y: 0.03, Rotation Z: -0.02", element=element))
            plain = written(BAR, element=element).replace("  Rigid: {top: {}}\n", "").replace(
                "Dirichlet: {", f'Dirichlet: {{top: {{X: "0.01 + 0.03*({arm[1]})", Y: "-0.02 - 0.02*({arm[0]}) - 0.01*({arm[1]})", Z: "-0.03*({arm[0]})"}}, ')
            given = self.solve("given", plain)
            self.near(turned["energy_J"], given["energy_J"], given["energy_J"], 1e-12)
            self.near(turned["reaction_force"]["top"], given["reaction_force"]["top"], math.hypot(*given["reaction_force"]["top"]))

    def test_a_moment_twists_a_bar_back_to_the_angle_that_took_it(self):
        for element in ("P1", "Q2"):
            angle = 0.02
            given = self.solve("given", written(BAR, f"X: 0.0, Y: 0.0, Z: 0.0, Rotation X: 0.0, Rotation Y: {angle}, Rotation Z: 0.0", element=element))["rigid"]["top"]
            found = self.solve("found", written(BAR, f"X: 0.0, Z: 0.0, Rotation X: 0.0, Moment Y: {given['moment'][1]!r}, Force Y: {given['force'][1]!r}, Rotation Z: 0.0",
                                                element=element))["rigid"]["top"]
            self.near(found["rotation"], [0, angle, 0], angle)
            self.near(found["displacement"], [0, 0, 0], angle)
            self.near(found["moment"], given["moment"], given["moment"][1])
            if element == "Q2":
                free = 2000 / 2.6 * 0.1406 * angle / 3  # of St. Venant's square bar, whose ends may warp
                self.assertGreater(given["moment"][1], free)
                self.assertLess(given["moment"][1], 1.2 * free)

    def test_springs_are_in_series_with_the_body(self):
        for held, motion, force, spring in [("X: 0.0, Rotation Z: 0.0", "Y", "Force Y", "Stiffness Y"), ("X: 0.0, Y: 0.0", "Rotation Z", "Moment Z", "Rotation Stiffness Z")]:
            deck = written(BAR, "TOP", element="Q2").replace("Lower: [0.0, 0.0, 0.0], Upper: [1.0, 3.0, 1.0]", "Upper: [1.0, 3.0]").replace("[2, 6, 2]", "[2, 6]").replace(", Z: 0.0", "")
            read = (lambda end: (end["displacement"][1], end["force"][1])) if motion == "Y" else (lambda end: (end["rotation"], end["moment"]))
            q, f = read(self.solve("body", written(deck, f"{held}, {motion}: 0.01"))["rigid"]["top"])
            stiffness, own = 700.0, f / q
            found = self.solve("spring", written(deck, f"{held}, {force}: 5.0, {spring}: {stiffness}"))
            moved, held_by = read(found["rigid"]["top"])
            self.near(moved, 5.0 / (stiffness + own), abs(moved))
            self.near(held_by, 5.0 - stiffness * moved, 5.0)
            self.near(found["energy_J"], -2.5 * moved, 5 * abs(moved))

    def test_a_punch_that_is_free_to_tilt_finds_its_tilt(self):
        for deck, tilt, law in [(PUNCH, "X: 0.0", ROLLER), (PUNCH, "X: 0.0, Point: [1.1, 1.3]", "Yield Stress: 40.0\n    " + ROLLER), (PUNCH, "X: 0.0", "Yield Stress: 18.0"),
                                (BLOCK, "X: 0.0, Z: 0.0, Rotation Y: 0.0, Point: [0.95, 1.0, 0.55]", BALL), (BLOCK, "X: 0.0, Z: 0.0, Rotation Y: 0.0, Point: [0.9, 1.0, 0.6]", "Yield Stress: 18.0")]:
            space = deck is BLOCK
            for element in ("P1", "Q2") if not space else ("Q1",):
                with self.subTest(tilt=tilt, law=law, element=element, space=space):
                    point = "" if "Point" in tilt else ", Point: [0.95, 1.0]"
                    found = self.solve("tilts", written(deck, f"{tilt}{point}, Force Y: -22.0", law, element=element))
                    top = found["rigid"]["top"]
                    moments = [top["moment"][0], top["moment"][2]] if space else [top["moment"]]
                    self.near(moments, [0] * len(moments), 22.0)
                    self.near(found["contact_force"][1], 22.0, 22.0)
                    turned = f"Rotation X: {top['rotation'][0]!r}, Rotation Z: {top['rotation'][2]!r}" if space else f"Rotation Z: {top['rotation']!r}"
                    given = self.solve("turned", written(deck, f"{tilt}{point}, Y: {top['displacement'][1]!r}, {turned}", law, element=element))
                    self.near(given["rigid"]["top"]["force"], top["force"], 22.0, 1e-9)
                    self.near(given["rigid"]["top"]["moment"], top["moment"], 22.0, 1e-9)
                    self.near(given["energy_J"] + 22.0 * top["displacement"][1], found["energy_J"], abs(22.0 * top["displacement"][1]), 1e-9)

    def test_a_force_beside_the_point_is_a_force_and_a_moment(self):
        beside = self.solve("beside", written(PUNCH, "X: 0.0, Force Y: -22.0, Point: [1.1, 1.0]", ROLLER))
        moment = self.solve("moment", written(PUNCH, "X: 0.0, Force Y: -22.0, Moment Z: -2.2", ROLLER))
        self.near(beside["rigid"]["top"]["rotation"], moment["rigid"]["top"]["rotation"], abs(moment["rigid"]["top"]["rotation"]))
        self.near(moment["rigid"]["top"]["moment"], -2.2, 2.2)
        self.near(beside["energy_J"], moment["energy_J"], abs(moment["energy_J"]))

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_of_revolution_it_is_a_force_of_dirichlet(self):
        deck = written(PUNCH, "Force Y: -22.0", ROLLER.replace("0.9", "0.0")).replace("punch:", "punch:\n  Kinematics: axisymmetric")
        rigid = self.solve("rigid", deck)
        plain = self.solve("plain", deck.replace("Rigid", "Dirichlet").replace("Force Y", "X: 0.0, Force Y"))
        self.near(rigid["energy_J"], plain["energy_J"], abs(plain["energy_J"]), 1e-12)
        self.near(rigid["rigid"]["top"]["displacement"][1], plain["force_displacement"]["top"][1], 1e-2)
        self.assertNotIn("rotation", rigid["rigid"]["top"])
        self.near(rigid["rigid"]["top"]["point"], [0, 1], 1)

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_large_rotations_are_told(self):
        end = self.solve("beam", written(BEAM).replace("3.0}", "12.0}"))
        self.assertTrue(any('"right" turns by 0.288 rad' in note for note in end["notes"]), end["notes"])
        self.assertFalse(any("turns by" in note for note in self.solve("less", written(BEAM))["notes"]))

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_a_restart_goes_on_with_the_same_digits(self):
        deck = written(PUNCH, f'X: "0.001*t", Force Y: {FORCE}, Moment Z: "t", Rotation Stiffness Z: 20.0', "Yield Stress: 40.0\n    " + ROLLER, STEPS)
        last = self.expect_restart_with_the_same_digits(deck)[-1]
        self.near(float(last["top_moment_z"]), 2.0 - 20.0 * float(last["top_rotation_z"]), 2.0)
        self.near(float(last["top_displacement_x"]), 0.002, 0.002)

    def test_what_a_foundation_cannot_bear_has_no_solution(self):
        law = "Yield Stress: 40.0"
        self.refuse(written(PUNCH, "X: 0.0, Force Y: -81.0", law), NO_SOLUTION, ["carries at most"])
        self.refuse(written(PUNCH, "X: 0.0, Force Y: -22.0, Point: [2.5, 1.0]", law), NO_SOLUTION, ["the load turns the body", "passes through (2.5, "])
        self.refuse(written(PUNCH, "Force Y: -22.0", law), NO_SOLUTION, ["translation along (1, 0)"])
        self.refuse(written(PUNCH, "X: 0.0, Force Y: 1.0", law), NO_SOLUTION, ["pulls the body away"])
        self.solve("held", written(PUNCH, "X: 0.0, Force Y: 1.0, Stiffness Y: 10.0, Rotation Z: 0.0", law))  # a spring holds it

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_what_is_not_supported_is_refused(self):
        self.refuse(written(PUNCH, "X: 0.0, Force X: 1.0"), BAD_INPUT, ['"Rigid->top" must have X or Force X, got both'])
        self.refuse(written(PUNCH, "Y: 0.0, Stiffness Y: 1.0"), BAD_INPUT, ['"Rigid->top" must have Y or Stiffness Y, got both'])
        self.refuse(written(PUNCH, "Rotation X: 0.0"), BAD_INPUT, ['"Rigid->top->Rotation X"', "X, Y and Rotation Z"])
        self.refuse(written(PUNCH, "Stiffness Y: -1.0"), BAD_INPUT, ['"Rigid->top->Stiffness Y" must be finite and >= 0, got -1'])
        self.refuse(written(PUNCH, "Point: [1.0]"), BAD_INPUT, ['"Rigid->top->Point" must have 2 numbers, got 1'])
        self.refuse(written(PUNCH, 'Moment Z: "x"'), BAD_INPUT, ["must not depend on x, y or z"])
        self.refuse(written(PUNCH, 'Force Y: "1/(t - 1)"'), BAD_INPUT, ['"Rigid->top->Force Y" must be finite'])
        self.refuse(written(PUNCH, "Side: left top, Force Y: 1.0"), BAD_INPUT, ["must be a side", "left top"])
        self.refuse(written(PUNCH, "X: 0.0, Force Y: -22.0, Point: [1.0e+6, 1.0]"), BAD_INPUT, ['"Rigid->top->Point" must be nearer to the side "top"'])
        repeated = lambda deck, top: written(deck, top).replace("Element: Q2", "Element: Q2, Periodic: X")
        for deck, turns, given in [(PUNCH, "Rotation Z", "X: 0.0, Force Y: -22.0"), (PUNCH, "Rotation Z", "Rotation Z: 0.01"), (BLOCK, "Rotation Y", "Rotation Z: 0.0")]:
            self.refuse(repeated(deck, given), BAD_INPUT, [f'"Rigid->top->{turns}" must be 0 with "Mesh->Periodic"'])
        self.near(self.solve("repeated", repeated(PUNCH, "X: 0.0, Rotation Z: 0.0, Force Y: -22.0"))["contact_force"][1], 22.0, 22.0)
        held = "Dirichlet: {NAME: {X: 0.0, Y: 0.0}}\n  Rigid:"
        self.refuse(written(PUNCH, "X: 0.0").replace("Rigid:", held.replace("NAME", "left")), BAD_INPUT, ["both hold X of one node", "the rigid side is to move it"])
        self.refuse(written(PUNCH, "X: 0.0").replace("Rigid:", held.replace("NAME", "top")), BAD_INPUT, ["different names"])
        revolved = written(PUNCH, "Rotation Z: 0.0", ROLLER.replace("0.9", "0.0")).replace("punch:", "punch:\n  Kinematics: axisymmetric")
        self.refuse(revolved, BAD_INPUT, ["Rotation Z", "body of revolution"])
        side = written(PUNCH, "Side: left, X: 0.0, Rotation Z: 0.0, Force Y: -40.0", ROLLER.replace("0.9", "0.1"))
        self.refuse(side, BAD_INPUT, ["the node at (0, 0)", "touches"])
        # A plane of symmetry may share its edge with the rigid side along components that are prescribed.
        half = written(PUNCH, "X: 0.0, Rotation Z: 0.0, Force Y: -20.0", ROLLER.replace("0.9", "0.0")).replace("Rigid:", "Dirichlet: {left: {X: 0.0}}\n  Rigid:")
        self.near(self.solve("half", half)["contact_force"][1], 20.0, 20.0)


if __name__ == "__main__":
    unittest.main()

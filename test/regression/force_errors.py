# SPDX-License-Identifier: BSD-3-Clause
"""Error bars and adapted meshes where forces press: Hertz's ball by force, a path and the force that it takes on the same mesh, tilts, histories, restarts."""

import json
import math
import unittest

from rpc_run import RANKS, WrittenDeckTestCase

BAD_INPUT = 2
GMSH, NESTED = "Meshes: gmsh", "Meshes: nested"
HERTZ = """ball:
  Kinematics: axisymmetric
  Mesh: {Upper: [1.0, 1.0], Cells: [5, 5], Element: ELEMENT}
  Material: {Young's Modulus: 1.0, Poisson's Ratio: 0.3}
  Dirichlet: {bottom: {X: 0.0, Y: 0.0}}
  Contact:
    Side: top
    Obstacle: {Type: sphere, Radius: 1.0, Centre: [0.0, 2.3], Force Y: FORCE}
  Adapt: {Target Relative Error: TARGET, MESHES}
  Output: {Exodus: false}
"""
TOOL = """tool:
  Mesh: {Upper: [2.0, 1.0], Cells: [8, 4], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet: {bottom: {X: 0.0, Y: 0.0}}
  Contact:
    Side: top
    LAW
    Obstacle: {Type: sphere, Radius: 3.0, Centre: CENTRE}
  Adapt: {ADAPT}
  Output: {Exodus: false}
  MORE
"""
PUNCH = """punch:
  Mesh: {Upper: [2.0, 1.0], Cells: [8, 4], Element: P2}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Rigid: {top: {TOP}}
  Contact:
    Side: bottom
    Stiffness: 500.0
  Adapt: {Target Relative Error: TARGET}
  Output: {Exodus: false}
"""
CUBE = """cube:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [3, 3, 3], Element: ELEMENT}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet: {bottom: {X: 0.0, Y: 0.0, Z: 0.0}}
  Contact:
    Side: top
    Obstacle: {Type: sphere, Radius: 2.0, Centre: [0.45, 3.0, 0.5], Force Y: -20.0}
  Adapt: {Target Relative Error: 0.25, MESHES}
  Output: {Exodus: false}
"""
STEPS = "Steps: {Times: [1, 2, 3]}"
FORCE = '"t < 1.5 ? -30 : t < 2.5 ? -8 : -25"'
YIELDS = "Yield Stress: 60.0"


def written(deck, **words):
    for word, text in {"ELEMENT": "P2", "LAW": "", "MORE": "", "MESHES": GMSH, **words}.items():
        deck = deck.replace(word, text)
    return deck


class ForceErrors(WrittenDeckTestCase):
    def within(self, here, there):
        """The values lie no further apart than both bars."""
        lists = [entry["value"] if isinstance(entry["value"], list) else [entry["value"]] for entry in (here, there)]
        self.assertIsNotNone(here["error_bar"])
        self.assertLessEqual(math.dist(*lists), here["error_bar"] + (there["error_bar"] or 0))

    def test_hertz_by_force_has_his_pressure_and_area_within_their_bars(self):
        force, radius, modulus = 2e-4, 1.0, 1 / (1 - 0.3 ** 2)
        contact = (3 * force * radius / (4 * modulus)) ** (1 / 3)  # radius of the area, a twentieth of the body's height
        found = {}
        for meshes, target, element in [(GMSH, 0.02, "P2"), (NESTED, 0.04, "P2"), (GMSH, 0.005, "P2"), (GMSH, 0.1, "Q1")]:
            with self.subTest(meshes=meshes, target=target, element=element):
                results = self.solve("ball", written(HERTZ, FORCE=repr(-force), TARGET=repr(target), MESHES=meshes, ELEMENT=element))["results"]
                self.assertAlmostEqual(results["contact_force"]["value"][1], -force, delta=1e-8 * force)
                self.assertEqual(results["contact_force"]["error_bar"], 0)
                pressure, area, moved = results["max_pressure"], results["contact_area"], results["obstacle_displacement"]
                self.within(area, {"value": math.pi * contact ** 2, "error_bar": 0})
                exact = 3 * force / (2 * math.pi * contact ** 2)
                self.within(pressure, {"value": exact, "error_bar": 2e-3 * exact})  # of a body that ends somewhere
                self.assertLess(moved["error_bar"], 0.1 * contact ** 2)
                found[(meshes, target)] = results
        self.assertLess(found[(GMSH, 0.005)]["obstacle_displacement"]["error_bar"], 0.3 * found[(GMSH, 0.02)]["obstacle_displacement"]["error_bar"])
        for key in ("obstacle_displacement", "energy_J"):
            for results in found.values():
                self.within(results[key], found[(GMSH, 0.005)][key])

    def test_a_path_and_its_force_have_the_same_estimate_on_the_same_mesh(self):
        for element, law in [("P1", ""), ("P2", YIELDS), ("Q1", YIELDS), ("Q2", "")]:
            with self.subTest(element=element, law=law):
                given = self.solve("moved", written(TOOL, ELEMENT=element, LAW=law, ADAPT="Estimate Error: true", CENTRE='[0.9, "4.0 - 0.03*t"]'))
                force = given["contact_force"][1]
                found = self.solve("pressed", written(TOOL, ELEMENT=element, LAW=law, ADAPT="Estimate Error: true", CENTRE=f"[0.9, 4.0], Force Y: {force!r}"))
                self.assertAlmostEqual(found["obstacle_displacement"][1], -0.03, delta=1e-6 * 0.03)
                self.assertAlmostEqual(found["error_estimate"]["relative"], given["error_estimate"]["relative"], delta=1e-5 * given["error_estimate"]["relative"])
                work = force * -0.03
                self.assertAlmostEqual(found["energy_J"], given["energy_J"] - work, delta=1e-7 * abs(work))
                bars = [summary["results"]["energy_J"]["error_bar"] for summary in (given, found)]
                self.assertAlmostEqual(*bars, delta=1e-4 * bars[0])
                self.assertIsNone(found["results"]["obstacle_displacement"]["error_bar"])  # one mesh shows no change

    def test_a_tool_off_its_axis_has_a_bar_for_each_component_of_its_force(self):
        coarse, fine = (self.solve("tool", written(TOOL, ADAPT=f"Target Relative Error: {target}", CENTRE="[0.6, 4.0], Force Y: -25.0"))["results"]["contact_force"]
                        for target in ("0.1", "0.02"))
        self.assertEqual(coarse["error_bars"][1], 0)
        self.assertAlmostEqual(coarse["value"][1], -25, delta=1e-6)
        self.assertLessEqual(abs(coarse["value"][0] - fine["value"][0]), coarse["error_bars"][0] + fine["error_bars"][0])
        self.assertEqual(coarse["error_bar"], coarse["error_bars"][0])
        self.assertGreater(coarse["error_bar"], 0)

    def test_a_tilt_has_a_bar_and_forces_that_are_given_are_exact(self):
        coarse, fine = (self.solve("tilt", written(PUNCH, TOP="X: 0.0, Point: [1.1, 1.0], Force Y: -22.0", TARGET=target)) for target in ("0.05", "0.005"))
        for key in ("force_displacement", "rigid_rotation"):
            self.within(coarse["results"][key]["top"], fine["results"][key]["top"])
            self.assertLess(fine["results"][key]["top"]["error_bar"], coarse["results"][key]["top"]["error_bar"])
            self.assertGreater(coarse["results"][key]["top"]["error_bar"], 0)
        self.within(coarse["results"]["energy_J"], fine["results"]["energy_J"])
        self.assertLess(coarse["results"]["rigid_moment"]["top"]["error_bar"], 1e-8)
        turned = [self.solve("turned", written(PUNCH, TOP="X: 0.0, Force Y: -22.0, Rotation Z: 0.002", TARGET=target))["results"] for target in ("0.05", "0.005")]
        self.within(*(results["rigid_moment"]["top"] for results in turned))
        self.assertGreater(turned[1]["rigid_moment"]["top"]["error_bar"], 0)

    def test_in_space(self):
        for kind in (GMSH, NESTED) if RANKS == 1 else (NESTED,):
            with self.subTest(meshes=kind):
                found = self.solve("cube", written(CUBE, MESHES=kind))
                self.assertAlmostEqual(found["contact_force"][1], -20, delta=1e-7)
                moved = found["results"]["obstacle_displacement"]
                self.assertGreater(moved["error_bar"], 0)
                self.assertLess(moved["error_bar"], 0.2 * abs(moved["value"][1]))
                self.assertGreater(len(found["adaptation"]["cycles"]), 1)

    def test_a_history_of_forces_on_adapted_meshes_goes_on_from_a_checkpoint(self):
        deck = written(TOOL, LAW=YIELDS, ADAPT="Target Relative Error: 0.08", CENTRE=f"[0.9, 4.0], Force Y: {FORCE}", MORE=STEPS)
        whole = self.solve("whole", deck)
        moved = [step["contact_force"][1] for step in whole["steps"]]
        for got, wanted in zip(moved, [-30, -8, -25]):
            self.assertAlmostEqual(got, wanted, delta=1e-6)
        fine = self.solve("fine", deck.replace("0.08", "0.02"))
        for key in ("obstacle_displacement", "energy_J", "max_penetration"):
            self.within(whole["results"][key], fine["results"][key])
        if RANKS == 1:
            (self.folder / "parts.yaml").write_text(deck)
            self.rpc("--input=parts.yaml", "--output=parts", "--set=Steps->Times={1, 2}", "--set=Steps->Checkpoint Every=1")
            self.rpc("--input=parts.yaml", "--output=parts", "--set=Steps->Checkpoint Every=1", "--restart")
            parts = json.loads((self.folder / "parts" / "parts.json").read_text())
            self.assertEqual(parts["obstacle_displacement"], whole["obstacle_displacement"])
            self.assertEqual(parts["results"]["obstacle_displacement"], whole["results"]["obstacle_displacement"])

    @unittest.skipIf(RANKS > 1, "once is enough")
    def test_guaranteed_bounds_are_refused(self):
        guaranteed = "Error Bound: guaranteed"
        decks = [(written(TOOL, ADAPT=guaranteed, CENTRE="[0.9, 4.0], Force Y: -1.0"), "a force or a spring moves the obstacle"),
                 (written(PUNCH, TOP="X: 0.0, Force Y: -1.0").replace("Target Relative Error: TARGET", guaranteed), '"Rigid->top" holds its side rigid'),
                 (written(PUNCH, TOP="X: 0.0, Y: -0.1, Rotation Z: 0.0").replace("Target Relative Error: TARGET", guaranteed), '"Rigid->top" holds its side rigid'),
                 (written(PUNCH, TOP="Force Y: -1.0").replace("Rigid", "Dirichlet").replace("Target Relative Error: TARGET", guaranteed), '"Dirichlet->top" is moved by a force')]
        for deck, words in decks:
            self.refuse(deck, BAD_INPUT, [words])


if __name__ == "__main__":
    unittest.main()

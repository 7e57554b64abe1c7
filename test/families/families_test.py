# SPDX-License-Identifier: BSD-3-Clause
"""What the generator promises: scenes come from seed and number alone, and all are held, with yield stresses > 0; and that the bars
can fail."""
import math
import pathlib
import random
import unittest
import xml.etree.ElementTree as ElementTree

import families
import fields  # of test/stress, whose folder families.py has put on the path
import growth
import hard
import report
from runs import Row
from scene import Friction, deck, verdict

SCENES = 5 * len(families.FAMILIES)


def text(scene):
    return deck(scene, "scene.geo" if scene.file else None) + (scene.file(scene.units[0]) if scene.file else "")


def without_mesh(scene):
    root = ElementTree.fromstring(deck(scene, "scene.geo" if scene.file else None))
    root.remove(root.find("ParameterList[@name='Mesh']"))
    return ElementTree.tostring(root)


def points(scene):
    """Some of the coordinates that a body may have."""
    rng = random.Random(1)
    return [[rng.uniform(-8, 8) for _ in range(3)] for _ in range(200)]


class HardGenerator(unittest.TestCase):
    def test_scenes_come_from_seed_and_number_and_keep_their_law_and_loads_in_every_size(self):
        for k in range(4 * len(hard.FAMILIES)):
            small, full, again = (families.make(7, k, size, "hard")[1] for size in ("small", "full", "full"))
            self.assertEqual(text(full), text(again))
            self.assertEqual(without_mesh(small), without_mesh(full))
            self.assertEqual(verdict(full), "solution")

    def test_numbers_reach_every_family(self):
        drawn = {families.make(7, k, "small", "hard")[0] for k in range(len(hard.FAMILIES))}
        self.assertEqual(len(drawn), len(hard.FAMILIES))


class FrictionGenerator(unittest.TestCase):
    def test_scenes_come_from_seed_and_number_and_keep_their_law_and_loads_in_every_size(self):
        for k in range(SCENES):
            small, full, again = (families.make(7, k, size, "friction")[1] for size in ("small", "full", "full"))
            self.assertEqual(text(full), text(again))
            self.assertEqual(without_mesh(small), without_mesh(full))
            self.assertEqual(verdict(full), "solution")

    def test_laws_are_those_of_coulomb_and_tresca_and_both_constant_and_varying_with_a_limit_and_without(self):
        laws = [contact.friction for k in range(200) for contact in families.make(7, k, "small", "friction")[1].contact if contact.friction]
        bears = [(law.coefficient(1.0), law.bound(1.0), law.limit(1.0)) for law in laws]
        self.assertEqual({(mu > 0, bound > 0) for mu, bound, _ in bears}, {(True, False), (False, True), (True, True)})
        self.assertEqual({math.isinf(limit) for _, _, limit in bears}, {True, False})
        self.assertEqual({isinstance(law.coefficient, fields.Constant) for law in laws}, {True, False})
        coefficients = [mu for mu, _, _ in bears if mu]
        self.assertTrue(0.05 <= min(coefficients) < 0.07 and 1.2 < max(coefficients) <= 1.5)

    def test_every_scene_has_friction_and_a_drag_along_the_foundation(self):
        for k in range(SCENES):
            family, scene = families.make(7, k, "small", "friction")
            root = ElementTree.fromstring(deck(scene, "scene.geo" if scene.file else None))
            names = {entry.get("name") for entry in root.find("ParameterList[@name='Contact']")}
            self.assertTrue(names & {"Friction Coefficient", "Friction Bound"}, family)
            drags = [f[0] for f in scene.traction.values()] + [held["X"] for held in scene.dirichlet.values()]
            self.assertTrue(any(drag(0.7) for drag in drags) or scene.body_force[0], family)

    def test_a_point_bears_what_its_law_says(self):
        law = Friction(fields.Constant(0.5), fields.linear(1.0, 2.0), fields.Constant(6.0))
        self.assertEqual([law.bears(p, x) for p, x in ((0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (10.0, 1.0))], [1.0, 3.0, 5.0, 6.0])


class Generator(unittest.TestCase):
    def test_a_scene_comes_from_its_seed_and_number_alone(self):
        for k in range(SCENES):
            self.assertEqual(text(families.make(7, k, "full")[1]), text(families.make(7, k, "full")[1]))
        self.assertNotEqual(text(families.make(7, 0, "full")[1]), text(families.make(8, 0, "full")[1]))
        self.assertNotEqual(text(families.make(7, 0, "full")[1]), text(families.make(7, len(families.FAMILIES), "full")[1]))

    def test_sizes_are_meshes_of_one_scene(self):
        for k in range(SCENES):
            small, full = (families.make(7, k, size)[1] for size in ("small", "full"))
            self.assertEqual(without_mesh(small), without_mesh(full))
            self.assertNotEqual(text(small), text(full))

    def test_every_body_is_held_and_every_yield_stress_is_positive(self):
        for k in range(SCENES):
            family, scene = families.make(7, k, "small")
            holders = [side for side, held in scene.dirichlet.items() if len(held) == scene.dim]
            self.assertEqual(len(holders) >= (2 if family == "bodies" else 1), True, family)
            self.assertEqual(verdict(scene), "solution", family)
            for contact in scene.contact:
                self.assertGreater(min(contact.xi(*point) for point in points(scene)), 0, family)
                self.assertTrue(all(math.isfinite(contact.xi(*point)) for point in points(scene)), family)

    def test_moduli_and_yield_stresses_span_six_decades(self):
        made = [families.make(7, k, "small")[1] for k in range(200)]
        self.assertGreater(max(s.units[1] for s in made) / min(s.units[1] for s in made), 10 ** 5.5)
        yields = [s.contact[0].xi(1) * s.units[1] for s in made]
        self.assertGreater(max(yields) / min(yields), 1e6)


class Bars(unittest.TestCase):
    def row(self, number, **values):
        standard = {"open": 9, "closed": 9, "yielding": 9, "seconds": 1.0, "elastic_seconds": 1.0, "steps": 3, "cold_steps": 5, "residual": 1e-9}
        return Row(number, "cantilever", **{**standard, **values})

    def judged(self, *changed):
        rows = [self.row(k) for k in range(20)] + [self.row(20 + k, **values) for k, values in enumerate(changed)]
        return report.bar_table(rows, report.STEP_BARS + report.TIME_BARS).good

    def test_bars_hold_or_fail(self):
        self.assertTrue(self.judged())
        self.assertTrue(self.judged({"cold_steps": 30}))  # one of 21 is less than 5 %
        for worse in ({"cold_steps": 61}, {"steps": 61}, {"seconds": 6.1}, {"seconds": math.inf}, {"failure": "exit 4"}):
            self.assertFalse(self.judged(worse), worse)
        self.assertFalse(self.judged(*[{"cold_steps": 30}] * 2))
        self.assertFalse(self.judged(*[{"steps": 13}] * 2))
        self.assertFalse(self.judged(*[{"seconds": 2.6}] * 3))
        self.assertFalse(self.judged(*[{"seconds": 1.6}] * 21))
        self.assertFalse(self.judged(*[{"closed": 0}] * 25))

    def test_stick_and_slip_are_wanted_in_most_scenes_with_friction(self):
        def judged(both):
            rows = [self.row(k, sticks=3 * (k < both), slips=3) for k in range(20)]
            return report.bar_table(rows, report.FRICTION_BARS + report.FRICTION_TIME_BARS, [report.STICK_AND_SLIP])
        self.assertTrue(judged(12).good)
        self.assertFalse(judged(11).good)
        self.assertFalse(report.bar_table([self.row(k, steps=7) for k in range(20)], report.FRICTION_BARS, []).good)

    def test_quantiles_are_nearest_ranks(self):
        self.assertEqual([report.quantile(range(1, 21), share) for share in (0.5, 0.9, 0.95, 1.0)], [10, 18, 19, 20])
        self.assertEqual(report.quantile([3], 0.5), 3)

    def test_growth_is_at_most_one_step_a_halving(self):
        def judged(*cold):
            return growth.table({"cantilever": [(16 * 2 ** k, self.row(k, cold_steps=c)) for k, c in enumerate(cold)]}).good
        self.assertTrue(judged(5, 6, 6, 7, 5))
        self.assertFalse(judged(5, 7))
        self.assertFalse(judged(5, math.inf))


if __name__ == "__main__":
    unittest.main()

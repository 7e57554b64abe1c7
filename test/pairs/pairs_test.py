# SPDX-License-Identifier: BSD-3-Clause
"""The array holds all pairs, the oracle's elements are right, and the oracle sees what is wrong with a run: files that were changed fail."""
import copy
import itertools
import os
import pathlib
import sys
import tempfile
import types
import unittest
import unittest.mock

try:
    import allpairspy  # noqa: F401
    import netCDF4  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}; what this takes: bash cmake/install_packages.sh cmake/ci_packages.txt doc/packages.txt")
    sys.exit(77)

import numpy as np

import between
import comparisons
import covering
import decks
import elasticity
import elements
import fields
import foundation
import outputs
import reasons
import rows
import run as suite
from oracle import Oracle

BASE = {"body": "plane", "element": "Q2", "mesh": "box", "law": "xi", "friction": "coulomb", "obstacle": "smooth", "history": "unload", "shape": "well",
        "solver": "factor", "parallel": "1 rank"}
ROWS = {"plane": BASE,
        "space": {**BASE, "body": "space", "element": "P2", "law": "springs", "friction": "none", "history": "one", "obstacle": "plane"},
        "round": {**BASE, "element": "P2", "mesh": "geo", "friction": "none", "history": "one", "obstacle": "plane", "solver": "meshes"},
        "revolution": {**BASE, "body": "axisymmetric", "element": "P1", "law": "hardening", "friction": "tresca", "obstacle": "plane"},
        "layers": {**BASE, "element": "Q1", "mesh": "msh", "shape": "layers", "history": "one", "friction": "none"},
        "soft": {**BASE, "body": "space", "element": "Q2", "shape": "incompressible", "history": "one", "law": "rigid",
                 "obstacle": "plane"}}


class Array(unittest.TestCase):
    def test_holds_every_pair_that_may_stand_together(self):
        for threads, seed in itertools.product((False, True), range(3)):
            of = covering.factors(threads)
            found = covering.array(seed, 60, of)
            self.assertEqual(len(found), 60)
            self.assertTrue(all(covering.allowed(row) and set(row) == set(of) for row in found))
            held, wanted = covering.coverage(found, of)
            self.assertEqual(held, wanted)
            self.assertGreater(wanted, 650)

    def test_knows_a_pair_that_is_missing(self):
        of = covering.factors()
        found = [row for row in covering.array(1, 60, of) if (row["element"], row["law"]) != ("P2", "springs")]
        held, wanted = covering.coverage(found, of)
        self.assertLess(held, wanted)

    def test_is_that_of_its_seed(self):
        of = covering.factors()
        self.assertEqual(covering.array(3, 40, of), covering.array(3, 40, of))
        self.assertNotEqual(covering.array(3, 40, of), covering.array(4, 40, of))
        one, other = (decks.make(3, 5, BASE) for _ in range(2))
        self.assertEqual(decks.scenes.deck(one.scene), decks.scenes.deck(other.scene))


def contact_nodes(run):
    return foundation.contact_points(run.mesh, "bottom", False)[0]


def suits(name, case):
    return "top" in case.scene.dirichlet and (name == "round") == (case.shape.radius < np.inf)


def cube(name):
    """One element of a name, slightly turned."""
    element = elements.Element(name)
    coords = element.places @ (np.eye(element.dim) + 0.1 * np.arange(element.dim ** 2).reshape(element.dim, -1) / 9) + 3.0
    sides = {"all": [(0, 0, facet) for facet in range(len(element.facets))]}
    return outputs.Mesh(coords, [outputs.Block("body", element, np.arange(len(coords))[None])], sides)


class Elements(unittest.TestCase):
    def test_shape_functions_are_one_at_their_node(self):
        for name in elements.NODES:
            element = elements.Element(name)
            values, slopes = element.shapes(element.places)
            np.testing.assert_allclose(values, np.eye(len(values)), atol=1e-14)
            np.testing.assert_allclose(slopes.sum(axis=1), 0, atol=1e-13)

    def test_rules_are_exact(self):
        for rule, degree in ((elements.triangle(2), 2), (elements.triangle(4), 4), (elements.triangle(6), 6), (elements.tetrahedron(3), 3)):
            points, weights = rule
            dim = points.shape[1]
            for powers in itertools.product(range(degree + 1), repeat=dim):
                if sum(powers) <= degree:
                    exact = np.prod([np.math.factorial(p) for p in powers]) / np.math.factorial(sum(powers) + dim)
                    self.assertAlmostEqual(np.sum(weights * np.prod(points ** np.array(powers), axis=1)), exact, 14)

    def test_middles_of_parts_of_a_facet_count_alike(self):
        for corners, size, square in ((2, 2, 2 / 3), (3, 1 / 2, 1 / 12), (4, 4, 4 / 3)):
            at = foundation.middles_of(corners)
            self.assertEqual(len(at), 20 ** min(corners - 1, 2))
            self.assertEqual(foundation.REFERENCE[corners], size)
            self.assertAlmostEqual(size * np.mean(at[:, 0] ** 2) / square, 1, 2)
        for name in elements.NODES:
            mesh = cube(name)
            still = np.zeros_like(mesh.coords)
            facets = [elasticity.facet_geometry(mesh, element, cells, facet, np.zeros((1, mesh.dim - 1)))[2] for element, cells, facet in mesh.facets("all")]
            area = sum(np.linalg.norm(each) * foundation.REFERENCE[len(mesh.blocks[0].element.facets[k])] for k, each in enumerate(facets))
            self.assertAlmostEqual(np.sum(foundation.samples(mesh, "all", still, still[:, 0], foundation.middles_of).area) / area, 1, 10, name)

    def test_energy_of_a_strip_that_is_unseen(self):
        element, part = elements.Element("HEX8"), 0.2
        bottom = next(k for k in range(6) if np.ptp(element.places[element.facet_nodes(k)][:, 1]) == 0)
        mesh = outputs.Mesh(element.places, [outputs.Block("body", element, np.arange(8)[None])], {"bottom": [(0, 0, bottom)]})
        low, length = np.min(mesh.coords[:, 0]), np.ptp(mesh.coords[:, 0])
        depth = lambda x: max(0.0, 1 - (x - low) / (part * length))
        side = types.SimpleNamespace(stiffness=1e-9, at=lambda x, n: (n, -depth(x[0])), xi=lambda *x: np.inf)  # so soft that the width does not count
        side.seen_at = lambda time: side
        case = types.SimpleNamespace(scene=types.SimpleNamespace(material={"E": 1.0, "nu": 0.3}), side=side)
        judge = types.SimpleNamespace(mesh=mesh, side="bottom", axisymmetric=False, case=case)
        still = np.zeros_like(mesh.coords)
        state = types.SimpleNamespace(time=0.0, u=still, dent=still[:, 0], p=still[:, 0], strain_energy=1.0)
        exact = 1e-9 / 2 * length ** 2 * part / 3
        self.assertAlmostEqual(between.share(judge, state, {0}) ** 2 / exact, 1, 1)
        self.assertEqual(between.share(judge, state, set()), 0)

    def test_energy_of_a_linear_displacement(self):
        material = {"E": 7.0, "nu": 0.45, "blocks": {}}
        lam, mu = elasticity.lame(7.0, 0.45)
        for name in elements.NODES:
            mesh = cube(name)
            gradient = np.random.default_rng(1).normal(size=(mesh.dim, mesh.dim))
            forces, energy = elasticity.internal(mesh, mesh.coords @ gradient.T, material)
            strain = (gradient + gradient.T) / 2
            volume = np.sum(elasticity.Cells(mesh, mesh.blocks[0], False).weights)
            self.assertAlmostEqual(energy / (volume * (lam * np.trace(strain) ** 2 / 2 + mu * np.sum(strain ** 2))), 1, 10, name)
            np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-10)
            stress = lam * np.trace(strain) * np.eye(mesh.dim) + 2 * mu * strain
            outer = np.zeros_like(mesh.coords)  # int N sigma n over all facets
            for element, cells, facet in mesh.facets("all"):
                points, weights = elements.triangle(6) if len(element.facets[facet]) == 3 else elements.gauss(4, mesh.dim - 1)
                values, _, normal = elasticity.facet_geometry(mesh, element, cells, facet, points)
                np.add.at(outer, cells, np.einsum("q,qn,fqd->fnd", weights, values, normal @ stress))
            np.testing.assert_allclose(forces, outer, atol=1e-10)


@unittest.skipUnless("RPC_PROGRAM" in os.environ, "RPC_PROGRAM names no program")
class Changed(unittest.TestCase):
    """The oracle on runs that are right, and on their files with one thing changed."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        program = rows.Program(types.SimpleNamespace(program=os.environ["RPC_PROGRAM"], openmp=None, mpiexec="", preload=None))
        cls.cases, cls.runs = {}, {}
        for name, row in ROWS.items():
            case = cls.cases[name] = next(case for case in (decks.make(11, k, row) for k in range(99)) if suits(name, case))
            folder = pathlib.Path(cls.folder.name) / name
            rows.write(case.scene, folder)
            cls.runs[name] = program.run(folder)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def judged(self, name, change=None, case=None):
        run = copy.deepcopy(self.runs[name])
        if change:
            change(run)
        return Oracle(case or self.cases[name], run).judge()

    def pressed(self, run, step):
        """A point of contact that bears the largest pressure."""
        nodes = contact_nodes(run)
        return int(nodes[np.argmax(run.fields[step]["contact_pressure"][nodes])])

    def assert_found(self, name, words, change, case=None):
        found = self.judged(name, change, case)
        self.assertTrue(any(words in complaint for complaint in found), f"{name}: {words}: {found}")

    def test_what_is_right_passes(self):
        for name, run in self.runs.items():
            self.assertEqual(run.code, 0, run.stderr)
            self.assertGreater(max(np.max(f["contact_pressure"]) for f in run.fields), 0)
            self.assertEqual(self.judged(name), [], name)

    def test_a_displacement(self):
        for name in ROWS:
            for node in (0, len(self.runs[name].mesh.coords) // 2):
                def shift(run):
                    run.fields[0]["disp_x"][node] += 1e-4 * np.max(np.abs(run.fields[0]["disp_y"]))
                self.assertTrue(self.judged(name, shift), name)

    def test_a_pressure(self):
        for name in ROWS:
            def press(run):
                run.fields[0]["contact_pressure"][self.pressed(run, 0)] *= 1.001
            self.assert_found(name, "forces do not balance", press)

    def test_a_pressure_at_an_open_point(self):
        def press(run):
            on_side = run.mesh.side_nodes("bottom")
            open_point = on_side[np.argmin(run.fields[0]["contact_pressure"][on_side] + run.fields[0]["penetration"][on_side])]
            run.fields[0]["contact_pressure"][open_point] = 0.1 * np.max(run.fields[0]["contact_pressure"])
        self.assert_found("plane", "pressure without touch", press)

    def test_forces(self):
        for name in ROWS:
            def drop(run):
                run.summary["contact_force"] = [0.0 for _ in run.summary["contact_force"]]
                for step in run.summary.get("steps", []):
                    step["contact_force"] = run.summary["contact_force"]
            self.assert_found(name, "contact_force", drop)

            def drop_reaction(run):
                run.summary["reaction_force"]["top"] = [0.0 for _ in run.summary["contact_force"]]
            if self.runs[name].summary["max_pressure"] > 0:
                self.assert_found(name, "reaction_force", drop_reaction)

    def test_extents(self):
        for key, name in (("contact_length", "plane"), ("contact_area", "space"), ("dent_volume", "revolution"), ("max_pressure", "soft")):
            def change(run):
                for step in run.step_summaries():
                    step[key] *= 1.001
            self.assert_found(name, key, change)

    def test_energies(self):
        def scaled(key, factor):
            def change(run):
                for step in run.step_summaries():
                    step[key] *= factor
            return change
        for name in ROWS:
            self.assert_found(name, "strain_energy", scaled("strain_energy", 1 + 1e-5))
        for name in ("space", "layers", "soft", "round"):
            self.assert_found(name, "energy_J", scaled("energy_J", 1 + 1e-5))
        for key in ("work", "dissipated_energy"):
            self.assert_found("revolution", key, scaled(key, 1.01))

    def test_friction(self):
        def more(run):
            run.fields[0]["friction_x"] *= 1.01
        self.assert_found("plane", "forces do not balance", more)
        for name, words in (("plane", "friction"), ("revolution", "friction")):
            def turned(run):
                run.fields[0]["friction_x"] *= -1
            self.assert_found(name, words, turned)

        def upwards(run):
            run.fields[0]["friction_y"][self.pressed(run, 0)] = 0.01 * np.max(run.fields[0]["contact_pressure"])
        self.assert_found("plane", "friction along the normal", upwards)

    def test_dents(self):
        def shrink(run):
            run.fields[1]["dent"] *= 0.9
        self.assert_found("revolution", "dent", shrink)

    def test_the_table(self):
        for key, name in (("pressure", "plane"), ("u_nu", "plane"), ("gap", "space"), ("area", "space")):
            def change(run):
                table = run.contact_rows()
                row = max(table, key=lambda row: (row.get("area", 1.0) > 0, row["pressure"]))
                row[key] += 0.01 * max(abs(row[key]) for row in table) + 1e-3
                run.contact_rows = lambda: table
            self.assert_found(name, f"{key} at", change)

    def test_a_bump_between_contact_points(self):
        for name in ("plane", "space"):
            case, run = self.cases[name], self.runs[name]
            x = run.mesh.coords[run.mesh.side_nodes("bottom")]
            xs = np.unique(np.round(x[:, 0], 9))
            middle, width = float(xs[2] + xs[3]) / 2, float(xs[3] - xs[2]) / 8
            bump = fields.Field("", lambda a, b, c: -0.1 * max(0.0, 1 - abs(a - middle) / width))
            higher = copy.deepcopy(case)
            higher.scene.contact[0].obstacle = None
            higher.scene.contact[0].gap = case.side.gap + bump
            self.assert_found(name, "between contact points", None, higher)

    def test_what_the_tolerance_leaves_on_springs(self):
        for name, run in self.runs.items():
            judge, most = Oracle(self.cases[name], run), max(np.max(np.abs(step["contact_force"])) for step in run.step_summaries())
            left = judge.left_on_springs()
            if self.cases[name].side.stiffness == np.inf:
                self.assertEqual(left, 0, name)
            else:
                self.assertGreaterEqual(left, 1e-8 * most, name)
                self.assertLess(left, 1e-6 * most, name)
                self.assertGreaterEqual(judge.rests()[0], left)

    def test_other_runs(self):
        for name, run in self.runs.items():
            self.assertEqual(comparisons.same(run, run, "again"), [])
            other = copy.deepcopy(run)
            other.fields[0]["disp_y"] *= 1 + 1e-5
            self.assertTrue(comparisons.same(run, other, "again"), name)
            other = copy.deepcopy(run)
            for step in other.step_summaries():
                step["strain_energy"] *= 1 + 1e-7
            self.assertTrue(comparisons.same(run, other, "again"), name)


def finished(code, errors=None, stderr="", **summary):
    """A run without files."""
    adaptation = {"errors": errors or {}, "cycles": [{"dofs": 100}], "reached": code == 0, "reason": ""}
    run = types.SimpleNamespace(code=code, stdout="", stderr=stderr, mesh=None, reason=lambda: stderr)
    run.summary = {"converged": True, "time": 1.0, "energy_J": 1.0, "contact_force": [0.0, 2.0], "energy_norm_squared": 4.0, "adaptation": adaptation, **summary}
    return run


class Judgement(unittest.TestCase):
    def test_bars(self):
        run = finished(0, {"contact_force": 0.1, "energy_J": None})
        self.assertEqual(comparisons.bars(run, finished(0, contact_force=[0.0, 2.05])), [])
        self.assertTrue(comparisons.bars(run, finished(0, contact_force=[0.0, 2.2])))
        self.assertEqual(comparisons.bars(run, finished(0, {"contact_force": 0.15}, contact_force=[0.0, 2.2])), [])
        self.assertEqual(comparisons.bars(run, finished(0, contact_force=[0.0, 2.2], time=2.0)), [])  # a step that the run has not reached

    def test_estimates(self):
        run = finished(0, error_estimate={"energy_norm": 0.1})
        self.assertEqual(comparisons.estimate(run, finished(0, energy_J=1 - 0.01 / 2)), [])
        self.assertTrue(comparisons.estimate(run, finished(0, energy_J=1 - 0.2)))
        run = finished(0, error_estimate={"energy_norm": 20.0})
        self.assertTrue(comparisons.estimate(run, finished(0, energy_J=1 - 0.01)))

    def test_estimates_where_data_jump_between_nodes(self):
        run = finished(0, error_estimate={"energy_norm": 0.1}, results={"energy_J": {"error_bar": 0.15}})
        self.assertEqual(comparisons.estimate(run, finished(0, energy_J=1 - 0.1)), [])
        self.assertTrue(comparisons.estimate(run, finished(0, energy_J=1 - 0.2)))

    def test_estimates_of_rounding(self):
        run = finished(0, error_estimate={"energy_norm": 1e-12, "relative": 0}, energy_J=1e-24, energy_norm_squared=1e-24)
        self.assertEqual(comparisons.estimate(run, finished(0, error_estimate={"relative": 0}, energy_J=2e-23)), [])
        self.assertTrue(comparisons.estimate(run, finished(0, error_estimate={"relative": 0.1}, energy_J=2e-23)))

    def test_a_tolerance_of_energies(self):
        case = decks.make(1, 0, {**BASE, "history": "tolerance"})
        zero = {"work": 0.0, "strain_energy": 0.0, "foundation_energy": 0.0, "dissipated_energy": 0.0, "energy_imbalance": 0.0, "parts": 4,
                "max_initial_penetration": 0.0, "max_dent": 0.0, "dent_volume": 0.0}
        steps = [{**zero, "time": time, "work": 1.0 + 0.5 * case.tolerance, "strain_energy": 1.0, "energy_imbalance": 0.5 * case.tolerance}
                 for time in case.scene.times]
        within = finished(0, steps=steps)
        within.summary.pop("adaptation")
        within.step_summaries = lambda: steps
        self.assertEqual(comparisons.promises(case, within), [])
        steps[2]["energy_imbalance"] += 2 * case.tolerance
        self.assertIn("Energy Tolerance", comparisons.promises(case, within)[0])
        within.code, within.reason = 4, lambda: '"Steps->Energy Tolerance" is not kept'
        self.assertIsNone(reasons.confirmed(case, within))
        steps[2]["energy_imbalance"] = steps[1]["energy_imbalance"]
        self.assertIsNotNone(reasons.confirmed(case, within))

    def test_reasons(self):
        case = decks.make(1, 0, {**BASE, "mesh": "gmsh", "history": "one"})
        self.assertIsNone(reasons.confirmed(case, finished(0)))
        for code in (1, 2, 3, 4, 5, 15, None):
            self.assertIn("exit", reasons.confirmed(case, finished(code, stderr="rpc: error: something")))
        short = finished(4, stderr='a mesh for the target would exceed "Adapt->Max Dofs" = 6000')
        self.assertIsNotNone(reasons.confirmed(case, short))  # of 100 unknowns
        short.summary["adaptation"]["cycles"] = [{"dofs": 5000}]
        self.assertIsNone(reasons.confirmed(case, short))
        self.assertIsNotNone(reasons.confirmed(case, finished(5, stderr="presses the node at (0, 0)")))  # its supports share no point with the foundation

    def test_known_failures(self):
        known = suite.Known(None)
        known.entries = [{"features": {"law": ["xi"]}, "complaint": "a bar of", "reason": "bars"}]
        self.assertEqual(known.reason(BASE, "a bar of force"), "bars")
        self.assertIsNone(known.reason({**BASE, "law": "rigid"}, "a bar of force"))
        self.assertIsNone(known.reason(BASE, "exit 15"))
        outcome = lambda number, *complaints: types.SimpleNamespace(row=BASE, number=number, complaints=list(complaints))
        self.assertEqual(known.of(outcome(1, "a bar of force")), ["bars"])
        self.assertIsNone(known.of(outcome(1, "a bar of force", "exit 15")))
        known.lists = [{"seed": 1, "rows": 2, "fail": [0, 1]}]
        options = types.SimpleNamespace(seed=1, rows=2, only=None)
        self.assertEqual(suite.stale(options, [outcome(0, "a bar of force"), outcome(1)], known), [1])

    def test_no_rank_outlives_a_run_that_waits_for_ever(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(rows, "GIVEN_UP", 1):
            waits = pathlib.Path(folder) / "waits"
            waits.write_text("#!/bin/bash\nset -m\nsleep 60 &\necho $! > rank\nwait\n")  # the rank has a process group of its own
            waits.chmod(0o755)
            program = rows.Program(types.SimpleNamespace(program=str(waits), openmp=None, mpiexec="", preload=None))
            run = program.run(pathlib.Path(folder))
            self.assertIsNone(run.code)
            self.assertIn("still running", run.stderr)
            rank = int((pathlib.Path(folder) / "rank").read_text())
            status = pathlib.Path(f"/proc/{rank}/status")
            self.assertFalse(status.exists() and "State:\tZ" not in status.read_text())

    def test_files_of_relative_paths_are_found_from_the_folders_of_rows(self):
        options = suite.arguments(["--program=build/rpc", "--openmp=other/rpc", "--preload=build/a.so:b.so"])
        here = pathlib.Path.cwd()
        self.assertEqual((options.program, options.openmp), (str(here / "build/rpc"), str(here / "other/rpc")))
        self.assertEqual(options.preload, f"{here / 'build/a.so'}:{here / 'b.so'}")
        self.assertIsNone(suite.arguments([]).preload)


if __name__ == "__main__":
    unittest.main()

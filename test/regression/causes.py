# SPDX-License-Identifier: BSD-3-Clause
"""Why a step does not converge: each reason of the table in doc/robustness.md is provoked, and its remedy followed.
Scenes that once ended with a wrong reason, and now converge."""

import csv
import json
import math
import re
import unittest

from rpc_run import RANKS, SOURCE, RpcTestCase
from sheared import SHEARED

BEAM = """beam:
  Mesh: {Lower: [0.0, 0.0], Upper: [5.0, 1.0], Cells: [40, 8]}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet:
    left: {X: 0.0, Y: 0.0}
    right: {X: 0.0, Y: 0.0}
  Traction:
    top: {Y: "-20*sin(pi*x/5)"}
  Contact:
    Side: bottom
    Yield Stress: 16.0
  Output: {Exodus: false}
"""
ENERGY = -0.212873523814  # of the beam [J/m], by the default solver and by Newton's with exact line search
FOOTING = """footing:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 0.5], Cells: [16, 4], Element: Q1}
  Material: {Young's Modulus: 1.0e15, Poisson's Ratio: 0.2}
  Dirichlet:
    left bottom: {X: 0.0}
  Traction:
    top: {Y: "-1.0e5*(1 + 0.3*(x - 1))"}
  Contact:
    Side: bottom
    Stiffness: 1.0e7
  Output: {Exodus: false}
"""
# So light a load, and so low a yield stress, that the rounding of the gap to the sphere counts.
LIGHT = """light:
  Kinematics: axisymmetric
  Mesh: {Lower: [0.0, 0.0], Upper: [1.7, 1.0], Cells: [6, 4], Element: P2}
  Material: {Young's Modulus: 2.1e4, Poisson's Ratio: 0.0}
  Dirichlet: {right: {X: 0.0}}
  Traction: {top: {Y: "-1e-8*t"}}
  Contact:
    Side: bottom
    Yield Stress: 1.0e-7
    Stiffness: 3.7e5
    Obstacle: {Type: sphere, Centre: [0.0, "14.17 + 0.0005*t"], Radius: 14.17, Encloses Body: true}
  Steps: {Times: [1.0], Max Halvings: 0}
  Output: {Exodus: false}
"""
# Between two walls nearer to each other than it is long, whose friction bears a weight of 0.3 x 2.2 N/m; the other half hangs free.
PRESS_FIT = """press_fit:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [8, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Traction: {top: {Y: -2.5}}
  Contact:
    Side: left
    Gap: -0.002
    Friction Coefficient: 0.3
    Sides: {right: {Side: right, Gap: -0.002, Friction Coefficient: 0.3}}
  Output: {Exodus: false}
"""
# Friction that may leave no equilibrium.
DRAGGED = """dragged:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [6, 8], Element: P2}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: -0.3}
  Dirichlet: {top: {X: "0.03*t", Y: -0.01}}
  Contact: {Side: bottom, Friction Coefficient: 30.0}
  Steps: {Times: [1.0, 2.0, 3.0], Max Halvings: 0}
  Output: {Exodus: false}
"""


def causes():
    """The table of the program: {name: (measured, said, remedy)}."""
    text = (SOURCE / "packages/core/include/rpc/core/causes.hpp").read_text()
    table = {}
    for entry in re.findall(r"inline constexpr Cause \w+\{(.*?)\};", text, re.DOTALL):
        texts = ["".join(part.replace('\\"', '"') for part in re.findall(r'"((?:[^"\\]|\\.)*)"', pieces))
                 for pieces in re.findall(r'(?:"(?:[^"\\]|\\.)*"\s*)+', entry)]
        name, *rest = texts
        table[name] = tuple(rest)
    return table


def sets(values):
    return [f"--set={path}={value}" for path, value in values.items()]


ONE_RANK = unittest.skipIf(RANKS > 1, "needs one rank: what several find is compared with it")


class Causes(RpcTestCase):
    def summary(self, text, *arguments, code=0):
        name = text.split(":")[0]
        (self.folder / f"{name}.yaml").write_text(text)
        self.rpc(f"--input={name}.yaml", "--output=out", *arguments, code=code)
        return json.loads((self.folder / "out" / f"{name}.json").read_text())

    def provoke(self, cause, provoked, remedy, text=BEAM, figures=(), energy=ENERGY):
        """A run with settings that provoke the cause, and one with the remedy's instead."""
        measured, said, helps = causes()[cause]
        self.provoked.add(cause)
        with self.subTest(cause):
            summary = self.summary(text, *sets(provoked), code=4)
            for part in [said, helps, *figures]:
                self.assertIn(part, summary["reason"])
            cured = self.summary(text, *sets(remedy))
            if text is BEAM and energy:
                self.assertAlmostEqual(cured["energy_J"], energy, delta=1e-7)

    provoked = set()

    @ONE_RANK
    def test_each_is_provoked_and_its_remedy_helps(self):
        newton = {"NOX->Direction->Method": "Newton"}
        search, backtrack = "NOX->Line Search->Method", "NOX->Line Search->Backtrack->"
        steep = {**newton, "Contact->Penalty": 1e7}  # kinks near each other
        no_step = {**steep, "NOX->Maximum Iterations": 20, search: "Backtrack", backtrack + "Minimum Step": 0.9, backtrack + "Recovery Step": 1e-6}
        self.provoke("no lower step", no_step, steep, figures=["Backtrack", "Minimum Step 0.9", "Recovery Step 1e-06"])
        self.provoke("no lower step", no_step, {**no_step, backtrack + "Minimum Step": 1e-12})
        self.provoke("circles", {**newton, search: "Full Step"}, newton, figures=["Full Step"])
        self.provoke("circles", {**newton, search: "NonlinearCG"}, newton, figures=["NonlinearCG"])
        self.provoke("status tests", {**newton, "NOX->Status Tests->Test Type": "MaxIters", "NOX->Status Tests->Maximum Iterations": 1}, newton)
        tight = {**newton, "Uzawa->Tolerance": 1e-12}
        self.provoke("Newton steps", {**tight, "NOX->Maximum Iterations": 1}, {**tight, "NOX->Maximum Iterations": 200},
                     figures=["Newton did not converge in 1 step"])
        self.provoke("Uzawa iterations", {**tight, "Uzawa->Maximum Iterations": 1}, {**tight, "Uzawa->Maximum Iterations": 50})
        self.provoke("rounding", {"Uzawa->Tolerance": 1e-17}, {"Uzawa->Tolerance": 1e-14})
        solver = "Linear Solver->"
        jacobi = {solver + "MueLu->max levels": 1, solver + "MueLu->coarse: type": "RELAXATION"}
        self.provoke("linear solver", {**jacobi, solver + "Maximum Iterations": 5}, {}, figures=["after 5 iterations"])
        self.provoke("linear solver", {**jacobi, solver + "Maximum Iterations": 5}, {**jacobi, solver + "Maximum Iterations": 500})
        self.provoke("breakdown", {**newton, **jacobi, solver + "MueLu->coarse: params->relaxation: damping factor": -1.0}, newton)
        self.provoke("breakdown", {"Material->Young's Modulus": 1e24}, {"Material->Young's Modulus": 1e18}, FOOTING)
        loose = {**newton, **jacobi, solver + "Method": "Pseudoblock GMRES", solver + "Tolerance": 0.9}
        self.provoke("stagnation", loose, newton)
        self.provoke("stagnation", loose, {**loose, "Uzawa->Tolerance": 0.5}, energy=None)
        # Two sweeps with so large a damping factor are indefinite: GMRES meets its bound by a step the wrong way.
        uphill = {**newton, **jacobi, solver + "MueLu->coarse: params->relaxation: damping factor": 1.2,
                  solver + "MueLu->coarse: params->relaxation: sweeps": 2, solver + "Method": "Pseudoblock GMRES", solver + "Tolerance": 0.95}
        self.provoke("no descent", uphill, newton)
        self.provoke("stuck", {}, {"Uzawa->Tolerance": 1e-3}, LIGHT)
        for remedy in [{"Contact->Friction Coefficient": 3.0}, {"Steps->Times": "{3}"}]:
            self.provoke("stuck by friction", {}, remedy, DRAGGED)
        for remedy in [{"Contact->Friction Coefficient": 2.0, "Contact->Sides->right->Friction Coefficient": 2.0}, {"Traction->top->Y": -0.5},
                       {"Contact->Gap": -0.02, "Contact->Sides->right->Gap": -0.02}, {"Dirichlet->bottom->Y": 0.0}]:
            self.provoke("want of friction", {}, remedy, PRESS_FIT)
        self.assertEqual(self.provoked, set(causes()))

    @ONE_RANK
    def test_a_step_that_is_divided_in_vain_tells_what_it_ended_with_as_a_whole(self):
        divided = LIGHT.replace(", Max Halvings: 0", "")  # the lighter the load, the more rounding counts
        reason = self.summary(divided, code=4)["reason"]
        part, whole = reason.split("; undivided, the step to t = 1 ended nearer to a solution: ")
        of = lambda text: float(text.split("KKT residual ")[1].split(",")[0])
        self.assertLess(of(whole), of(part))
        for helps in causes()["stuck"][1:]:
            self.assertIn(helps, whole)
        self.summary(divided, f"--set=Uzawa->Tolerance={5 * of(whole)}")

    @unittest.skipIf(RANKS == 1, "needs several ranks")
    def test_reasons_are_those_of_one_rank(self):
        newton, search = {"NOX->Direction->Method": "Newton"}, "NOX->Line Search->Method"
        self.provoke("circles", {**newton, search: "Full Step"}, newton)
        self.provoke("rounding", {"Uzawa->Tolerance": 1e-17}, {"Uzawa->Tolerance": 1e-14})
        self.provoke("breakdown", {"Material->Young's Modulus": 1e24}, {"Material->Young's Modulus": 1e18}, FOOTING)
        self.provoke("want of friction", {}, {"Traction->top->Y": -0.5}, PRESS_FIT)

    @ONE_RANK
    def test_table_of_the_documentation_is_that_of_the_program(self):
        document = (SOURCE / "doc/robustness.md").read_text()
        rows = re.findall(r"^\| (.+?) \| (.+?) \| (.+?) \| (.+?) \|$", document.split("## Random scenes")[0], re.MULTILINE)
        self.assertEqual({name: tuple(rest) for name, *rest in rows[1:]}, causes())

    def test_lists_of_nox_for_other_problems_do_as_well(self):
        newton = {"NOX->Direction->Method": "Newton", "NOX->Direction->Newton->Forcing Term Method": "Constant",
                  "NOX->Direction->Newton->Rescue Bad Newton Solve": "true"}
        for method in ["Backtrack", "Polynomial", "More'-Thuente"] if RANKS == 1 else ["Backtrack"]:
            with self.subTest(method):
                given = () if method == "More'-Thuente" else ("Minimum Step", "Recovery Step")
                steps = {f"NOX->Line Search->{method}->{name}": 1e-4 for name in given}
                summary = self.summary(BEAM, *sets({**newton, "NOX->Line Search->Method": method, **steps}))
                self.assertAlmostEqual(summary["energy_J"], ENERGY, delta=1e-10)
                self.assertLess(sum(summary["newton_iterations"]), 30)

    def test_nearly_rigid_footing_settles_on_its_springs(self):
        h = 1 / 8
        c = (2 / 3) / (2 / 3 + h**2 / 3)  # of weights by the trapezoidal rule: pressures are 1e5 (1 + 0.3 c (x - 1))
        for modulus in [1e9, 1e13, 1e15, 1e16, 1e18] if RANKS == 1 else [1e16]:
            with self.subTest(modulus):
                summary = self.summary(FOOTING, f"--set=Material->Young's Modulus={modulus:g}")
                self.assertAlmostEqual(summary["contact_force"][1], 2e5, delta=1e-3)
                rows = list(csv.DictReader((self.folder / "out" / "footing.contact.csv").read_text().splitlines()))
                if modulus < 1e13:
                    continue
                for row in rows:
                    self.assertAlmostEqual(float(row["pressure"]), 1e5 * (1 + 0.3 * c * (float(row["x"]) - 1)), delta=1)

    def test_what_rounding_has_spoilt_is_no_solution(self):
        """So stiff a body that its matrix has lost the springs below it: Newton's direction leads down without end."""
        for method in ["Sweep", "Newton", "Active Set"] if RANKS == 1 else ["Sweep"]:
            for modulus in [1e22, 1e23]:
                with self.subTest(method=method, modulus=modulus):
                    summary = self.summary(FOOTING, f"--set=Material->Young's Modulus={modulus:g}", f"--set=NOX->Direction->Method={method}", code=4)
                    self.assertIsNone(summary["energy_J"])
                    for part in causes()["breakdown"][1:]:
                        self.assertIn(part, summary["reason"])

    def test_rounding_of_penetrations_is_no_violation_of_friction(self):
        rubbing = LIGHT.replace("Stiffness:", "Friction Coefficient: 0.09\n    Stiffness:").replace("[1.0]", "[1.0, 2.0, 3.0]")
        summary = self.summary(rubbing)
        self.assertAlmostEqual(summary["contact_force"][1] / (3e-8 * math.pi * 1.7**2), 1, delta=1e-7)

    def test_much_friction_settles_with_low_penalties(self):
        for mu in [1.65, 1.75, 1.95] if RANKS == 1 else [1.75]:
            with self.subTest(mu):
                summary = self.summary(SHEARED, f"--set=Contact->Friction Coefficient={mu}")
                self.assertLess(summary["energy_J"], 1e-20)  # at t = 4 it has left its dents

    def test_a_step_that_settles_from_rest_alone_is_told(self):
        told = "first at t = 3.75, the friction states settled from rest alone"
        self.assertEqual(sum(told in note for note in self.summary(SHEARED)["notes"]), 1)
        little = self.summary(SHEARED, "--set=Contact->Friction Coefficient=0.5")
        self.assertFalse([note for note in little["notes"] if "from rest" in note])


if __name__ == "__main__":
    unittest.main()

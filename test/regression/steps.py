# SPDX-License-Identifier: BSD-3-Clause
"""Load steps as a user gets them: their summary, table and film, and the same on several ranks."""

import csv
import json
import math
import subprocess
import unittest

from film import Film
from rpc_run import BEAM, PROGRAM, RANKS, SMALL, RpcTestCase, errors, files

# Up, back to a fifth, up again, on.
TO_AND_FRO = "-20*sin(pi*x/5)*(t <= 1 ? t : t <= 2 ? 1.8 - 0.8*t : t <= 3 ? 0.8*t - 1.4 : 0.5*t - 0.5)"
LOADED = [f"--set=Traction->top->Y={TO_AND_FRO}", "--set=Steps->Times={0.5, 1, 2, 3, 4}", "--set=Contact->Yield Stress=12"]
# The same, but that no point is at its yield limit by a hair.
OTHER = "-20*sin(pi*x/5)*(t <= 1 ? t : t <= 2 ? 1.8 - 0.8*t : t <= 3 ? 0.7*t - 1.2 : 0.6*t - 0.9)"
LAWS = {"plastic": [], "hardening": ["--set=Contact->Hardening=300"], "elastic": ["--set=Contact->Stiffness=4000"],
        "both": ["--set=Contact->Hardening=300", "--set=Contact->Stiffness=4000"]}
COUNTS = {"parts", "newton_iterations", "linear_solves", "linear_iterations", "preconditioner_setups", "seconds"}


def rows(path):
    return [{k: float(v) for k, v in row.items() if k != "reason"} for row in csv.DictReader(path.read_text().splitlines())]


ONE_RANK = unittest.skipIf(RANKS > 1, "needs one rank: histories of several are compared with its own")


class Steps(RpcTestCase):
    def expect_near(self, a, b, scale, name):
        for x, y in zip(a if isinstance(a, list) else [a], b if isinstance(b, list) else [b]):
            self.assertLessEqual(abs(x - y), 1e-10 * scale, name)

    def test_every_step_is_in_the_summary_the_table_and_the_film(self):
        summary = self.solve(*LOADED, *LAWS["both"])
        steps = summary["steps"]
        times = [0.5, 1, 2, 3, 4]
        self.assertEqual([step["time"] for step in steps], times)
        self.assertTrue(all(step["converged"] and step["parts"] == 1 for step in steps))
        self.assertEqual((summary["time"], summary["matrix_assemblies"]), (4, 1))
        for key in ["contact_force", "max_pressure", "max_penetration", "contact_length", "yielded_length", "max_dent", "dent_volume",
                    "strain_energy"]:
            self.assertEqual(summary[key], steps[-1][key], key)
        dents = [step["max_dent"] for step in steps]
        self.assertEqual(dents[0], 0)
        self.assertGreater(dents[1], 1e-4)
        self.assertEqual(dents[2], dents[1])
        self.assertAlmostEqual(dents[3], dents[1], delta=1e-12)
        self.assertGreater(dents[4], 1.1 * dents[3])
        for key in ["strain_energy", "foundation_energy", "work"]:
            self.assertLess(steps[2][key], 0.7 * steps[1][key], key)
        self.assertEqual(steps[2]["dissipated_energy"], steps[1]["dissipated_energy"])

        table = rows(self.folder / "out" / "beam.history.csv")
        self.assertEqual(len(table), 5)
        names = {"dissipated_energy": "dissipated_energy", "max_dent": "max_dent", "time": "time", "work": "work", "parts": "parts",
                 "max_pressure": "max_pressure", "dent_volume": "dent_volume", "newton_iterations": "newton_iterations"}
        for row, step in zip(table, steps):
            for column, key in names.items():
                self.assertEqual(row[column], step[key], column)
            self.assertEqual([row["contact_force_x"], row["contact_force_y"]], step["contact_force"])
            # what presses the beam down, the foundation and its ends hold up
            load = 20 * [0.5, 1, 0.2, 1, 1.5][times.index(step["time"])] * 2 * 5 / math.pi
            self.assertAlmostEqual(row["contact_force_y"] + row["left_reaction_y"] + row["right_reaction_y"], load, delta=0.02 * load)

        film = Film(self.folder / "out" / "beam.e")
        self.assertEqual(film.times, times)
        for number, dent in enumerate(dents):
            self.assertAlmostEqual(max(film.nodal["dent"][number]), dent, delta=1e-15)
        last = rows_of_contact(self.folder / "out" / "beam.contact.csv")
        self.assertAlmostEqual(max(row["dent"] for row in last), dents[-1], delta=1e-15)

    @ONE_RANK
    def test_not_every_step_need_be_in_the_film(self):
        for every, times in [(2, [1, 3, 4]), (3, [2, 4]), (9, [4])]:
            summary = self.solve(*LOADED, f"--set=Steps->Write Every={every}")
            self.assertEqual(len(summary["steps"]), 5)
            self.assertEqual(Film(self.folder / "out" / "beam.e").times, times)

    @ONE_RANK
    def test_a_support_has_its_mean_displacement_along_which_it_is_free_too(self):
        """A column on springs: u_y = -p/k - p y/E at height y. Its left side and a corner slide."""
        (self.folder / "deck.yaml").write_text("""deck:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 2.0], Cells: [4, 6]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.0}
  Dirichlet: {left: {X: 0.0}, right top: {X: 0.0}}
  Traction: {top: {Y: "-10*t"}}
  Contact: {Side: bottom, Stiffness: 500.0}
  Steps: {Times: [1.0, 2.0]}
  Output: {Exodus: false}
""")
        self.rpc("--input=deck.yaml")
        for row in rows(self.folder / "deck.history.csv"):
            pressure = 10 * row["time"]
            self.assertAlmostEqual(row["left_displacement_y"], -pressure / 500 - pressure / 1000, delta=1e-12)
            self.assertAlmostEqual(row["right top_displacement_y"], -pressure / 500 - 2 * pressure / 1000, delta=1e-12)
            self.assertEqual(row["left_displacement_x"], 0)

    @ONE_RANK
    def test_each_of_several_sides_has_its_force(self):
        squeezed = ["--input=beam.xml", SMALL, "--set=Contact->Sides->ceiling->Side=top", "--set=Contact->Yield Stress=inf",
                    "--set=Contact->Gap=-0.001*t*x*(5 - x)", "--set=Contact->Sides->ceiling->Gap=-0.001*t*x*(5 - x)", "--set=Traction->top->Y=0",
                    "--set=Steps->Times={1, 2}", "--set=Steps->Checkpoint Every=1", "--output=out"]
        console = self.rpc(*squeezed).stdout
        table = rows(self.folder / "out" / "beam.history.csv")
        sides = json.loads((self.folder / "out" / "beam.json").read_text())["contact_sides"]
        for row in table:
            for axis in "xy":
                self.assertAlmostEqual(row[f"bottom_contact_force_{axis}"] + row[f"top_contact_force_{axis}"],
                                       row[f"contact_force_{axis}"], delta=1e-10)
        self.assertGreater(table[0]["bottom_contact_force_y"], 1)
        sizes = sum(math.hypot(table[1][f"{name}_contact_force_x"], table[1][f"{name}_contact_force_y"]) for name in ("bottom", "top"))
        shown = next(line.split()[2] for line in console.splitlines() if line.startswith("   2/2"))
        self.assertAlmostEqual(float(shown) / sizes, 1, delta=1e-5)  # |force|
        for name, side in sides.items():
            self.assertEqual([table[1][f"{name}_contact_force_x"], table[1][f"{name}_contact_force_y"]], side["contact_force"], name)
        self.rpc(*squeezed, "--restart=out/beam.checkpoint-000001.e")
        for row, again in zip(table, rows(self.folder / "out" / "beam.history.csv")):
            for name in row.keys() - COUNTS:
                self.expect_near(row[name], again[name], 1, name)

    def test_without_steps_there_is_no_history(self):
        summary = self.solve()
        self.assertNotIn("steps", summary)
        self.assertEqual(files(self.folder / "out"), ["beam.contact.csv", "beam.e", "beam.json"])
        self.assertEqual(Film(self.folder / "out" / "beam.e").times, [1])

    @ONE_RANK
    def test_one_step_is_the_run_without_steps(self):
        for law in LAWS.values():
            whole = self.solve(*law)
            step = self.solve(*law, "--set=Steps->Times={1}")
            for key in ["energy_J", "contact_force", "max_pressure", "max_dent", "newton_iterations", "linear_iterations"]:
                self.assertEqual(step[key], whole[key], key)

    @ONE_RANK
    def test_a_foundation_that_forgets_is_that_of_its_last_step(self):
        alone = self.solve(*LOADED, "--set=Steps->Times={4}")
        forgets = self.solve(*LOADED, "--set=Contact->Remembers=false")
        remembers = self.solve(*LOADED)
        scale = abs(alone["energy_J"])
        self.assertAlmostEqual(forgets["energy_J"], alone["energy_J"], delta=1e-9 * scale)
        self.assertGreater(abs(remembers["energy_J"] - alone["energy_J"]), 1e-3 * scale)
        self.assertTrue(all(step["dissipated_energy"] == 0 for step in forgets["steps"]))

    def test_an_obstacle_moves_along_its_expressions(self):
        # A floor that rises into the beam is a gap that falls below zero; the way that its point goes aside is none.
        free = ["--set=Traction->top->Y=0", "--set=Steps->Times={1, 2, 3}", *LAWS["both"]]
        height = "(0.01*min(t, 2) - 0.004*max(t - 2, 0))"
        moving = self.solve(*free, "--set=Contact->Obstacle->Type=plane", "--set=Contact->Obstacle->Normal={0, 1}",
                            "--set=Contact->Obstacle->Point={7*t, " + height + "}")
        gaps = self.solve(*free, f"--set=Contact->Gap=-{height}")
        for a, b in zip(moving["steps"], gaps["steps"]):
            for key in ["strain_energy", "dissipated_energy", "work", "max_dent", "max_pressure"]:
                self.assertAlmostEqual(a[key], b[key], delta=1e-9 * max(step[key] for step in gaps["steps"]))
        forces = [step["contact_force"][1] for step in moving["steps"]]
        self.assertGreater(forces[0], 0)
        self.assertGreater(forces[1], forces[0])
        self.assertLess(forces[2], 0.9 * forces[1])
        self.assertEqual(moving["matrix_assemblies"], 1)

    def test_a_step_that_needs_more_iterations_than_allowed_is_halved_and_the_run_says_so(self):
        hard = [*LOADED, "--set=Steps->Times={1}", "--set=Nested Iteration->Enabled=false", "--set=Uzawa->Maximum Iterations=1",
                "--set=Contact->Gap=0.004*sin(pi*x/5)"]
        needed = sum(self.solve(*hard)["newton_iterations"])
        self.assertGreater(needed, 2)
        few = [*hard, f"--set=NOX->Maximum Iterations={needed - 1}"]
        stopped = self.solve(*few, "--set=Steps->Max Halvings=0", code=4)
        self.assertFalse(stopped["steps"][-1]["converged"])
        halved = self.solve(*few, "--set=Steps->Max Halvings=8")
        self.assertEqual(len(halved["steps"]), 1)
        self.assertGreater(halved["steps"][0]["parts"], 2)
        self.assertEqual(rows(self.folder / "out" / "beam.history.csv")[0]["parts"], halved["steps"][0]["parts"])
        self.assertEqual(Film(self.folder / "out" / "beam.e").times, [1])

    @ONE_RANK
    def test_an_energy_tolerance_divides_the_step_in_which_contact_opens(self):
        # A floor presses the beam and goes far away: all work comes back.
        lifted = ["--set=Traction->top->Y=0", "--set=Contact->Yield Stress=inf", "--set=Steps->Times={1, 2}",
                  "--set=Contact->Gap=(t <= 1 ? -0.01*t*sin(pi*x/5) : 1.01*(t - 1) - 0.01*sin(pi*x/5))"]
        coarse = self.solve(*lifted)["steps"]
        fine = self.solve(*lifted, "--set=Steps->Energy Tolerance=1e-3")["steps"]
        stored = coarse[0]["strain_energy"]
        self.assertGreater(abs(coarse[1]["work"]), 10 * stored)
        self.assertEqual(coarse[1]["parts"], 1)
        self.assertLess(abs(fine[1]["work"]), 0.01 * stored)
        self.assertGreater(fine[1]["parts"], 5)
        for step in [*coarse, *fine]:
            sums = step["strain_energy"] + step["foundation_energy"] + step["dissipated_energy"]
            self.assertAlmostEqual(step["energy_imbalance"], step["work"] - sums, delta=1e-12 * abs(coarse[1]["work"]))
        result = self.rpc("--input=beam.xml", SMALL, *lifted, "--output=out")
        self.assertIn("in 1 of 2 steps work and energies differ by more than 1 %", result.stdout)

    def test_a_body_that_tresca_friction_has_held_comes_back_to_rest(self):
        # At the end nothing presses the body: what the friction of earlier steps leaves in it is rounding.
        press = "-0.005*(0.5*max(0, 1 - abs(t - 1)) + max(0, 1 - abs(t - 2)) + 0.4*max(0, 1 - abs(t - 3)))"
        for tilt in ["-0.0003", "-0.05"]:
            with self.subTest(tilt=tilt):
                (self.folder / "held.yaml").write_text(f"""
held:
  Mesh: {{Element: Q2, Cells: [8, 4]}}
  Material: {{"Young's Modulus": 6.4, "Poisson's Ratio": 0.385}}
  Dirichlet: {{top: {{X: 0.0, Y: "{press}"}}}}
  Contact: {{Side: bottom, Yield Stress: 0.0114, Friction Bound: 0.012, Obstacle: {{Type: plane, Point: [0.5, 0.0], Normal: [{tilt}, 1.0]}}}}
  Steps: {{Times: [1.0, 2.0, 3.0, 4.0, 5.0]}}
""")
                self.rpc("--input=held.yaml", "--output=out")
                steps = json.loads((self.folder / "out" / "held.json").read_text())["steps"]
                forces = [max(map(abs, step["contact_force"])) for step in steps]
                self.assertGreater(forces[1], 1e-3)
                self.assertLess(max(forces[3:]), 1e-8 * forces[1])
                self.assertEqual([step["parts"] for step in steps], [1] * 5)

    @ONE_RANK
    def test_times_that_do_not_rise_are_refused(self):
        result = self.rpc("--input=beam.xml", SMALL, "--set=Steps->Times={1, 2, 2}", code=None)
        self.expect_refusal(result, 2, ['"Steps->Times"', "rise", "got 2 after 2"])
        self.assertEqual(files(self.folder), [])

    @unittest.skipIf(RANKS == 1, "on several ranks")
    def test_histories_do_not_depend_on_the_number_of_ranks(self):
        tight = ["--set=Uzawa->Tolerance=1e-11", "--set=NOX->Residual Tolerance=1e-12"]
        path = [*LOADED, f"--set=Traction->top->Y={OTHER}"]
        for name, law in LAWS.items():
            arguments = [f"--input={BEAM}", SMALL, *path, *law, *tight]
            alone = subprocess.run([PROGRAM, *arguments, "--output=alone"], cwd=self.folder, capture_output=True, text=True, timeout=600)
            self.assertEqual((alone.returncode, errors(alone)), (0, []), alone.stdout + alone.stderr)
            many = self.solve(*path, *law, *tight)
            one = json.loads((self.folder / "alone" / "beam.json").read_text())
            self.assertEqual((one["ranks"], many["ranks"]), (1, RANKS))
            for key in set(one["steps"][0]) - COUNTS:
                value = lambda step: step[key] if isinstance(step[key], list) else [step[key]]
                scale = max(max(map(abs, value(step))) for step in one["steps"])
                for a, b in zip(one["steps"], many["steps"]):
                    self.expect_near(value(a), value(b), scale, f"{name}: {key} at t = {a['time']}")


def rows_of_contact(path):
    return [{k: v if k in ("state", "side") else float(v) for k, v in row.items()} for row in csv.DictReader(path.read_text().splitlines())]


if __name__ == "__main__":
    unittest.main()

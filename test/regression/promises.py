# SPDX-License-Identifier: BSD-3-Clause
"""What a deck asks for is met, or refused with what was reached: the most unknowns of adapted meshes, the energy tolerance of load steps,
times without a load, and after a failure the results of the last step that converged, or none."""

import csv
import json
import unittest

from film import Film
from rpc_run import BEAM as INPUT_BEAM, RANKS, SMALL, RpcTestCase, errors, files, run_all

CONVERGED, NOT_TO_THE_TARGET, NO_SOLUTION = 0, 4, 5

STEEL = "Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}"
# By name: a deck, and whose first mesh is larger than the smallest limit or not.
PUNCH = """punch:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [2, 2, 2], Element: P2}
  Dirichlet: {front: {X: 0.0, Y: 0.0, Z: -0.01}}
  Contact: {Side: back}
  """ + STEEL + "\n"
DISC = """disc:
  Kinematics: axisymmetric
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 0.01], Cells: [60, 2], Element: Q2}
  Dirichlet: {right: {X: 0.0, Y: 0.0}}
  Traction: {top: {Y: -1.0e-4}}
  Contact: {Side: bottom, Gap: 0.004}
  """ + STEEL + "\n"
BEAM = """beam:
  Mesh: {Lower: [0.0, 0.0], Upper: [5.0, 1.0], Cells: [20, 4], Element: P2}
  Dirichlet: {left: {X: 0.0, Y: 0.0}, right: {X: 0.0, Y: 0.0}}
  Traction: {top: {Y: "-20*sin(pi*x/5)"}}
  Contact: {Side: bottom, Yield Stress: 16.0}
  """ + STEEL + "\n"
# Where the first meshes touch at few points, so that their estimates do not fall.
PYRAMID = """pyramid:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [4, 4, 4], Element: P2}
  Dirichlet: {front: {X: 0.0, Y: 0.0, Z: 0.0}}
  Contact: {Side: back, Gap: "0.35*max(abs(x - 0.5), abs(y - 0.5)) - 0.05"}
  """ + STEEL + "\n"
# Touched by a ball between the nodes of its coarse mesh, where the size that sees the contact has more unknowns than the limit.
BALL = """ball:
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [2, 2, 2], Element: P2}
  Dirichlet: {top: {X: 0.0, Y: -0.003, Z: 0.0}}
  Contact: {Side: bottom, Obstacle: {Type: sphere, Centre: [0.6, -1.7, 0.4], Radius: 1.7}}
  """ + STEEL + "\n"
# Pressed by a rigid plate and lifted off by 1 m, at once or gradually.
LIFT = """lift:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [16, 16], Element: Q1}
  Dirichlet: {bottom: {X: 0.0, Y: 0.0}}
  Contact:
    Side: top
    Obstacle: {Type: plane, Point: [0.0, "1 - 0.01*t*(t <= 1) + HEIGHT*(t > 1)"], Normal: [0.0, -1.0]}
  Steps: {Times: [0.5, 1.0, 2.0]}
  """ + STEEL + "\n"
AT_ONCE, GRADUAL = LIFT.replace("HEIGHT", "1"), LIFT.replace("HEIGHT", "(1.01*(t - 1) - 0.01)")
# Held by contact alone, with a load that rises from 0 at t = 0.
RAMP = """ramp:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4]}
  Dirichlet: {left: {X: 0.0}}
  Traction: {top: {Y: "-2*t"}}
  Contact: {Side: bottom}
  """ + STEEL + "\n"

# Leaves a dent and is lifted a little.
DENT = """dent:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [6, 4], Element: P2}
  Dirichlet: {top: {X: 0.0, Y: "t < 2.5 ? -0.002*t : -0.0035"}}
  Contact: {Side: bottom, Gap: "0.008*(x - 0.3)^2", Yield Stress: 2.0, Hardening: 200.0}
  Steps: {Times: [1.0, 2.0, 3.0]}
  """ + STEEL + "\n"
TIP = """tip:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [6, 4], Element: P2}
  Dirichlet: {top: {X: 0.0, Y: -0.01}}
  Contact: {Side: bottom, Gap: "0.05*abs(x - 0.47)"}
  """ + STEEL + "\n"
# Bends down by 0.028 at its free end.
SHELF = """shelf:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [4, 2], Element: P2}
  Dirichlet: {left: {X: 0.0, Y: 0.0}}
  Traction: {top: {Y: -1.0}}
  Contact: {Side: bottom, Gap: 0.1}
  """ + STEEL + "\n"
# Sizes for the targets below hardly change its first mesh.
STEP = """step:
  Mesh: {Lower: [0.0, 0.0], Upper: [8.7, 1.0], Cells: [24, 4], Element: Q2}
  Dirichlet: {top: {X: 0.0, Y: -0.003}}
  Contact: {Side: bottom, Gap: "x < 4.4 ? 0.005 : 0.0018", Yield Stress: 2.1}
  """ + STEEL.replace("0.3", "0.1") + "\n"


def adapt(target, max_dofs, meshes="gmsh"):
    return ["--set=Output->Exodus=none", f"--set=Adapt->Target Relative Error={target}", f"--set=Adapt->Max Dofs={max_dofs}",
            f"--set=Adapt->Meshes={meshes}"]


ONE_RANK = unittest.skipIf(RANKS > 1, "needs one rank: several plan the same meshes and steps, which verification.adapt_ranks compares")


class Promises(RpcTestCase):
    done = {}  # runs, which several tests look at

    def runs(self, jobs):
        """Runs of (deck, options): each its exit code and summary."""
        new = [job for job in jobs if str(job) not in self.done]
        for k, (deck, _) in enumerate(new):
            (self.folder / f"deck{k}.yaml").write_text(deck)
        results = run_all([([f"--input=deck{k}.yaml", f"--output=out{k}", *options], self.folder) for k, (_, options) in enumerate(new)])
        for k, (job, result) in enumerate(zip(new, results)):
            self.assertEqual(errors(result), [], result.stdout)
            self.done[str(job)] = result, json.loads((self.folder / f"out{k}" / f"deck{k}.json").read_text())
        return [self.done[str(job)] for job in jobs]

    def test_nothing_of_contact_is_exactly_zero_where_the_body_may_touch(self):
        jobs = [(SHELF, [*adapt(0.05, 3000), f"--set=Contact->Gap={gap}", *more])
                for gap in (0.1, 0.0283) for more in ([], ["--set=Contact->Stiffness=1e5"])]
        for (_, options), (_, summary) in zip(jobs, self.runs(jobs)):
            with self.subTest(options=options[4:]):
                adaptation = summary["adaptation"]
                bars, unknown = adaptation["errors"], adaptation["errors_unknown"]
                self.assertEqual([summary[key] for key in ("max_pressure", "contact_length", "max_penetration")], [0, 0, 0])
                names = ["contact_force", "max_pressure", "contact_length", "max_penetration"]
                if options[4].endswith("0.1"):
                    self.assertEqual([bars[name] for name in names], [0, 0, 0, 0])
                    continue
                self.assertGreater(bars["contact_force"], 0)
                self.assertEqual([bars[name] for name in names[1:3]], [None, None])
                self.assertIn("the smallest gap that is left is within its error", unknown["max_pressure"])
                self.assertEqual(bars["max_penetration"], None if len(options) > 5 else 0)  # a rigid foundation never gives way

    def test_a_bump_between_nodes_counts_for_what_may_touch(self):
        # The solution presses the bump with 0.9 N; on the last mesh, which bends less, 0.6 mm are left there, and 0.43 m at the nodes.
        job = BEAM, [*adapt(0.2, 3000), "--set=Mesh->Element=P1", "--set=Material->Young's Modulus=2000",
                     "--set=Contact->Gap=min(1, 0.2112 + 100*(x - 2.445)^2)"]
        summary = self.runs([job])[0][1]
        bars = summary["adaptation"]["errors"]
        self.assertEqual(summary["max_pressure"], 0)
        self.assertGreater(bars["contact_force"], 0.9)
        self.assertEqual([bars["max_pressure"], bars["contact_length"]], [None, None])

    def test_no_mesh_but_the_first_has_more_unknowns_than_allowed(self):
        limits = [(deck, meshes, limit) for deck, meshes, all_limits in [
            (PUNCH, "gmsh", [3000, 300, 20000, 45000]), (PUNCH, "nested", [3000, 300, 20000]), (DISC, "gmsh", [1000, 300, 3000]),
            (DISC, "nested", [1000, 3000]), (BEAM, "gmsh", [500, 3000]), (BEAM, "nested", [500, 3000])]
                  for limit in (all_limits if RANKS == 1 else all_limits[:1])]
        jobs = [(deck, adapt(1e-5, limit, meshes)) for deck, meshes, limit in limits]
        for (deck, meshes, limit), (result, summary) in zip(limits, self.runs(jobs)):
            with self.subTest(deck=deck.split(":")[0], meshes=meshes, limit=limit):
                cycles = summary["adaptation"]["cycles"]
                self.assertEqual(result.returncode, NOT_TO_THE_TARGET)
                self.assertLessEqual(max([c["dofs"] for c in cycles[1:]], default=0), limit)
                reason = summary["adaptation"]["reason"]
                self.assertIn(f'"Adapt->Max Dofs" = {limit}', reason)
                best = min(cycles, key=lambda c: c["relative_estimate"])
                self.assertIn(f"the least estimated error is {best['relative_estimate']:.6g}, with {best['dofs']} dofs", reason)
                self.assertEqual(summary["dofs"], best["dofs"])
                self.assertRegex(reason, r"; by the order of the elements the target takes about \d+\. Raise ")
                self.assertRegex(result.stdout, rf'(?m)^next mesh: .* the target with about \d+ dofs, more than "Adapt->Max Dofs" = {limit}(;|,|$)')

    @ONE_RANK
    def test_a_target_is_refused_only_after_meshes_at_the_limit(self):
        limits = [(PUNCH, "gmsh", 20000), (PUNCH, "nested", 20000), (DISC, "gmsh", 3000), (BEAM, "gmsh", 3000), (BEAM, "nested", 3000)]
        for (deck, meshes, limit), (_, summary) in zip(limits, self.runs([(deck, adapt(1e-5, limit, meshes)) for deck, meshes, limit in limits])):
            with self.subTest(deck=deck.split(":")[0], meshes=meshes):
                self.assertGreater(summary["adaptation"]["cycles"][-1]["dofs"], limit / 2)

    @ONE_RANK
    def test_contact_that_nodes_miss_is_looked_for_with_the_unknowns_that_are_allowed(self):
        limits = [("nested", 3000), ("gmsh", 3000), ("nested", 4000)]
        for (meshes, limit), (_, summary) in zip(limits, self.runs([(BALL, adapt(0.25, limit, meshes)) for meshes, limit in limits])):
            with self.subTest(meshes=meshes, limit=limit):
                dofs = [cycle["dofs"] for cycle in summary["adaptation"]["cycles"]]
                self.assertGreater(max(dofs), limit / 2)
                self.assertLessEqual(max(dofs), limit)
                self.assertIn("the target is not reached within", summary["adaptation"]["reason"])

    @ONE_RANK
    def test_a_target_within_the_limit_is_reached_though_first_estimates_do_not_fall(self):
        for result, summary in self.runs([(PYRAMID, adapt(0.3, 30000))]):
            self.assertEqual(result.returncode, CONVERGED, summary["adaptation"]["reason"])
            self.assertTrue(summary["adaptation"]["reached"])
            self.assertLessEqual(summary["dofs"], 30000)

    def test_nested_meshes_for_which_sizes_ask_for_too_little_reach_their_target(self):
        for result, summary in self.runs([(STEP, adapt(target, 6000, "nested")) for target in (0.085, 0.077)]):
            self.assertEqual(result.returncode, CONVERGED, summary["adaptation"]["reason"])
            self.assertLess(len(summary["adaptation"]["cycles"]), 8)

    def test_error_bars_of_the_last_step_count_what_meshes_of_earlier_steps_have_left(self):
        coarse, fine = (each for _, each in self.runs([(DENT, adapt(0.03, 20000)), (DENT, adapt(0.004, 20000))]))
        bars = coarse["adaptation"]["errors"]
        self.assertEqual(len(coarse["adaptation"]["cycles"]), 1)  # which alone shows no change
        for key, value in (("energy_J", lambda s: s["energy_J"]), ("contact_force", lambda s: s["contact_force"][1])):
            error = abs(value(coarse) - value(fine))
            self.assertLess(error, bars[key])
            self.assertLess(bars[key], 20 * error)
        floor = 2 * coarse["error_estimate"]["relative"]**2 * coarse["contact_force"][1]  # of the last step by itself
        self.assertGreater(abs(coarse["contact_force"][1] - fine["contact_force"][1]), 5 * floor)

    def test_a_foundation_that_never_yields_is_not_said_to(self):
        [(_, summary)] = self.runs([(TIP, adapt(0.03, 20000))])
        unknown = summary["adaptation"]["errors_unknown"]
        self.assertIn("max_pressure", unknown)
        self.assertNotIn("max_penetration", unknown)

    @unittest.skipIf(RANKS > 1, "the mesh of one cell is for one rank")
    def test_error_bars_are_none_where_no_mesh_shows_what_earlier_steps_have_left(self):
        (_, summary), = self.runs([(DENT, ["--set=Mesh->Cells={1,1}", *adapt(0.9, 20000)])])
        self.assertEqual(set(summary["adaptation"]["errors"].values()), {None})
        for key in ("energy_J", "contact_force"):
            self.assertIn("what the meshes of earlier steps have left is not known: ", summary["adaptation"]["errors_unknown"][key])
            self.assertIn("has no coarser one", summary["results"][key]["reason"])

    def test_an_energy_tolerance_that_is_not_kept_ends_with_code_4_and_says_where(self):
        tolerance = ["--set=Steps->Energy Tolerance=0.001"]
        (at_once, off), (gradual, kept), (_, free) = self.runs([(AT_ONCE, tolerance), (GRADUAL, tolerance), (AT_ONCE, [])])
        self.assertEqual((at_once.returncode, gradual.returncode), (NOT_TO_THE_TARGET, CONVERGED))
        self.assertEqual(kept["energy_tolerance"], {"tolerance": 0.001, "kept": True, "reason": ""})
        found = off["energy_tolerance"]
        self.assertFalse(found["kept"])
        self.assertEqual((found["steps"], found["at"]), (1, 2))
        self.assertGreater(found["largest"], 0.9)
        for part in ['"Steps->Energy Tolerance" = 0.001', "at t = 2", f"{off['steps'][2]['parts']} parts", "jumps in t"]:
            self.assertIn(part, found["reason"])
        self.assertIn("NOT TO THE TOLERANCE: " + found["reason"], at_once.stdout)
        self.assertNotIn("NOT TO THE TOLERANCE", gradual.stdout)
        self.assertTrue(off["converged"])  # as with Adapt: the states are solutions
        self.assertEqual([step["converged"] for step in off["steps"]], [True] * 3)
        self.assertLess(abs(kept["steps"][2]["work"]), 0.002 * kept["steps"][1]["work"])
        self.assertNotIn("energy_tolerance", free)

    @ONE_RANK
    def test_a_body_that_only_moves_keeps_an_energy_tolerance(self):
        moved = AT_ONCE.replace("bottom: {X: 0.0, Y: 0.0}", 'bottom: {X: "0.3*t", Y: "-0.7*t"}').replace("0.01*t*(t <= 1)", "0*t")
        for result, summary in self.runs([(moved, ["--set=Steps->Energy Tolerance=1e-9"])]):
            self.assertEqual(result.returncode, CONVERGED, summary["energy_tolerance"])
            self.assertTrue(summary["energy_tolerance"]["kept"])

    def test_adapted_meshes_keep_an_energy_tolerance_or_end_with_code_4(self):
        adapted = ["--set=Adapt->Target Relative Error=0.3", "--set=Steps->Energy Tolerance=0.001", "--set=Output->Exodus=none"]
        (at_once, off), (gradual, kept) = self.runs([(AT_ONCE, adapted), (GRADUAL, adapted)])
        self.assertEqual((at_once.returncode, gradual.returncode), (NOT_TO_THE_TARGET, CONVERGED))
        self.assertEqual([off["energy_tolerance"]["kept"], kept["energy_tolerance"]["kept"]], [False, True])

    @ONE_RANK
    def test_max_halvings_bounds_all_halvings_where_it_is_given(self):
        tolerance = ["--set=Steps->Energy Tolerance=1e-4"]
        jobs = [(GRADUAL, [*tolerance, *(["--set=Steps->Max Halvings=" + most] if most else [])]) for most in ["", "0", "2"]]
        parts = [[step["parts"] for step in summary["steps"]] for _, summary in self.runs(jobs)]
        self.assertGreater(max(parts[0]), 4)
        self.assertEqual(parts[1], [1, 1, 1])
        self.assertLessEqual(max(parts[2]), 4)
        self.assertGreater(max(parts[2]), 1)

    def test_a_time_without_a_load_is_named_with_its_load_and_its_remedy_helps(self):
        (self.folder / "ramp.yaml").write_text(RAMP)
        adapted = ["--set=Adapt->Target Relative Error=0.1", "--set=Output->Exodus=none"]
        parts = ["nothing presses the body", "At t = 0 the load is zero", '"Traction->top"', '"Steps->Times"']
        for times in ["{0, 0.5, 1}", "{-0.5, 0}"] if RANKS == 1 else ["{0, 0.5, 1}"]:
            for options in [[], adapted]:
                if times[1] == "-":
                    options = [*options, "--set=Traction->top->Y=2*t"]
                result = self.rpc("--input=ramp.yaml", "--output=out", f"--set=Steps->Times={times}", *options, code=None)
                self.expect_refusal(result, NO_SOLUTION, ["at t = 0: ", *parts])
        self.rpc("--input=ramp.yaml", "--output=out", "--set=Steps->Times={0.5, 1}", code=CONVERGED)
        self.rpc("--input=ramp.yaml", "--output=out", "--set=Steps->Times={0.5, 1}", *adapted, code=CONVERGED)
        self.expect_refusal(self.rpc("--input=ramp.yaml", "--output=out", "--set=Time=0", code=None), NO_SOLUTION, [*parts, '"Time"'])
        self.rpc("--input=ramp.yaml", "--output=out", "--set=Time=0.5", code=CONVERGED)

    @ONE_RANK
    def test_a_first_step_beyond_the_limit_names_its_time_and_no_zero_load(self):
        (self.folder / "ramp.yaml").write_text(RAMP)
        result = self.rpc("--input=ramp.yaml", "--output=out", "--set=Steps->Times={2, 3}", "--set=Contact->Yield Stress=3", code=None)
        self.expect_refusal(result, NO_SOLUTION, ["at t = 2: ", "carries at most 3 [N/m]"])
        self.assertNotIn("the load is zero", result.stderr)

    # From where nothing touches to a load that takes more than one step of the iteration.
    HARD = [SMALL, "--set=Traction->top->Y=-20*t*sin(pi*x/5)", "--set=Contact->Gap=0.004*sin(pi*x/5)", "--set=NOX->Maximum Iterations=1",
            "--set=Uzawa->Maximum Iterations=1", "--set=Nested Iteration->Enabled=false", "--set=Steps->Max Halvings=0"]

    def beam(self, output, *options, code=NOT_TO_THE_TARGET):
        result = self.rpc(f"--input={INPUT_BEAM}", f"--output={output}", *self.HARD, *options, code=code)
        self.assertEqual(errors(result), [])
        return result, json.loads((self.folder / output / "beam.json").read_text())

    def test_after_a_step_that_does_not_converge_all_files_have_the_one_before(self):
        _, right = self.beam("right", "--set=Steps->Times={1e-4, 1e-3}", code=CONVERGED)
        result, failed = self.beam("failed", "--set=Steps->Times={1e-4, 1e-3, 1}")
        self.assertFalse(failed["converged"])
        self.assertEqual((failed["failed_at"], failed["time"]), (1, 1e-3))
        self.assertIn("Newton did not converge in 1 step", failed["reason"])
        for key in ["energy_J", "max_displacement", "contact_force", "reaction_force", "max_pressure", "contact_sides", "kkt_residual"]:
            self.assertEqual(failed[key], right[key])
        self.assertEqual([step["converged"] for step in failed["steps"]], [True, True, False])
        self.assertEqual([step["max_displacement"] is None for step in failed["steps"]], [False, False, True])
        self.assertEqual(Film(self.folder / "failed" / "beam.e").times, [1e-4, 1e-3])
        self.assertEqual((self.folder / "failed" / "beam.contact.csv").read_text(), (self.folder / "right" / "beam.contact.csv").read_text())
        row = list(csv.DictReader((self.folder / "failed" / "beam.history.csv").read_text().splitlines()))[-1]
        self.assertEqual((row["converged"], row["max_pressure"], row["contact_force_y"]), ("0", "nan", "nan"))
        self.assertIn("NOT CONVERGED: at t = 1: ", result.stdout)
        self.assertIn("of the last step that converged, t = 0.001", result.stdout)

    @ONE_RANK
    def test_where_no_step_has_converged_there_are_no_numbers_and_no_fields(self):
        (self.folder / "out").mkdir()
        for end in ["e", "contact.csv"]:
            (self.folder / "out" / f"beam.{end}").write_text("of an earlier run")
        result, failed = self.beam("out", "--set=Steps->Times={1, 2}")
        self.assertEqual(files(self.folder / "out"), ["beam.history.csv", "beam.json"])
        self.assertEqual(failed["failed_at"], 1)
        for key in ["time", "energy_J", "max_displacement", "max_pressure"]:
            self.assertIsNone(failed[key])
        self.assertEqual(set(failed["contact_force"]), {None})
        self.assertEqual(len(failed["steps"]), 1)
        self.assertIsNone(failed["steps"][0]["max_pressure"])
        self.assertIsInstance(failed["equilibrium_residual"], float)
        self.assertIn("results             none", result.stdout)
        self.assertNotIn("nan", result.stdout)

    def test_adapted_steps_end_with_the_last_one_that_converged(self):
        adapted = ["--set=Mesh->Element=P2", "--set=Adapt->Target Relative Error=0.5"]
        _, failed = self.beam("out", *adapted, "--set=Steps->Times={1e-4, 1e-3, 1}")
        self.assertEqual((failed["failed_at"], failed["time"]), (1, 1e-3))
        self.assertEqual(Film(self.folder / "out" / "beam.e").times, [1e-4, 1e-3])
        self.assertLess(failed["max_displacement"], 1e-3)
        _, none = self.beam("none", *adapted, "--set=Time=1", "--set=Traction->top->Y=-20*sin(pi*x/5)")
        self.assertEqual(files(self.folder / "none"), ["beam.json"])
        for key in ["energy_J", "max_pressure"]:
            self.assertIsNone(none[key])
            self.assertIsNone(none["adaptation"]["cycles"][0][key])
        self.assertIsNone(none["error_estimate"]["relative"])

    def test_after_a_restart_that_finds_no_step_the_earlier_files_stay(self):
        every = "--set=Steps->Checkpoint Every=1"
        self.beam("out", every, "--set=Steps->Times={1e-4, 1e-3}", code=CONVERGED)
        _, failed = self.beam("out", every, "--set=Steps->Times={1e-4, 1e-3, 1}", "--restart")
        self.assertEqual((failed["failed_at"], failed["time"]), (1, None))
        self.assertEqual([step["converged"] for step in failed["steps"]], [True, True, False])
        self.assertEqual(Film(self.folder / "out" / "beam.e").times, [1e-4, 1e-3])


if __name__ == "__main__":
    unittest.main()

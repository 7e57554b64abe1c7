# SPDX-License-Identifier: BSD-3-Clause
"""The command line, the deck's forms, and the files that a run leaves."""

import csv
import json
import math
import pathlib
import re
import shutil
import time
import unittest
import xml.etree.ElementTree as ElementTree

from rpc_run import BEAM, SMALL, SOURCE, RpcTestCase, errors, files, run_all

YAML = SOURCE / "test" / "regression" / "decks" / "beam.yaml"
OPTIONS = ["--input", "--output", "--restart", "--set", "--check", "--make-surface", "--mesh-info", "--new", "--print-parameters", "--print-schema", "--version", "--help", "--kokkos-"]
SUBLISTS = ["Units", "Mesh", "Material", "Dirichlet", "Traction", "Body Force", "Contact", "Steps", "Nested Iteration", "Adapt", "Uzawa", "NOX", "Linear Solver",
            "Linear Solver->Belos", "Linear Solver->MueLu", "Output"]

NUMBER, INTEGERS, NUMBERS = (int, float), [int], [(int, float)]
SUMMARY = {"converged": bool, "reason": str, "dofs": int, "contact_nodes": int, "ranks": int, "energy_J": NUMBER,
           "strain_energy": NUMBER, "energy_norm_squared": NUMBER, "units": dict, "max_displacement": NUMBER, "max_strain": NUMBER,
           "max_von_mises": NUMBER, "contact_force": NUMBERS, "max_pressure": NUMBER, "max_penetration": NUMBER,
           "contact_length": NUMBER, "yielded_length": NUMBER, "max_dent": NUMBER, "dent_volume": NUMBER, "time": NUMBER, "kkt_residual": NUMBER, "uzawa_iterations": int,
           "newton_iterations": INTEGERS, "linear_solves": int, "linear_iterations": INTEGERS,
           "preconditioner_setups": int, "local_corrections": int, "solver": str, "solver_path": str, "candidates": list, "matrix_assemblies": int,
           "notes": list, "skipped": list, "levels": list, "seconds": dict}


class CommandLine(RpcTestCase):
    def test_help_names_every_option_and_exit_code(self):
        for option in ["--help", "-h"]:
            text = self.rpc(option).stdout
            for name in OPTIONS:
                self.assertIn(name, text)
            for code in ["0 converged", "1 internal error", "2 bad input", "3 bad mesh", "4 not converged",
                         "5 no solution exists"]:
                self.assertIn(code, text)
            self.assertNotIn("Kokkos command line arguments", text)  # its own help is --kokkos-help
        self.assertEqual(files(self.folder), [])

    def test_version_is_one_line(self):
        self.assertRegex(self.rpc("--version").stdout, r"^rpc \d+\.\d+\.\d+ \(Kokkos \w+\)\n$")

    def test_print_parameters_lists_every_sublist_with_units(self):
        text = self.rpc("--print-parameters").stdout
        sections = {re.sub(r"-><.*>$", "", title) for title in re.findall(r"^### (.*)$", text, re.MULTILINE)}
        for name in SUBLISTS:
            self.assertIn(name, sections)
        for unit in ["[m]", "[Pa]", "[Pa/m]", "[N/m^3]"]:
            self.assertIn(unit, text)
        for line in re.findall(r"^- .*$", text, re.MULTILINE):
            self.assertRegex(line, r"^- `[^`]+` \([a-z ]+, (default `[^`]*`|no default)\): .{5,}$")
        self.assertNotIn("e+00", text)

    def test_every_parameter_of_the_deck_is_documented(self):
        text = self.rpc("--print-parameters").stdout
        for parameter in ElementTree.parse(BEAM).getroot().iter("Parameter"):
            self.assertIn(f"- `{parameter.get('name')}` (", text)

    def test_check_writes_nothing(self):
        result = self.rpc("--check", "--input=beam.xml", "--output=out")
        self.assertIn("nothing wrong with it: 10626 dofs, 161 contact points", result.stdout)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_texts_need_no_kernels(self):
        """Kokkos does not start, which on a machine without a GPU it could not; nor with this."""
        refused = {"KOKKOS_NUM_THREADS": "many"}
        for options in (["--help"], ["--version"], ["--print-parameters"], ["--print-schema"], ["--new"]):
            self.rpc(*options, environment=refused)
        for options in (["--input=beam.xml", SMALL], ["--check", "--input=beam.xml", SMALL]):
            self.rpc(*options, environment=refused, code=1)

    def test_kokkos_options_are_taken(self):
        for option in ["--kokkos-threads=1", "--kokkos-num-threads=1", "--kokkos-device-id=0", "--kokkos-disable-warnings"]:
            self.rpc("--version", option)
        text = self.rpc("--kokkos-help").stdout
        self.assertEqual(len(re.findall("--kokkos-(?:num-)?threads=INT", text)), 1)

    def test_faulty_option_is_refused(self):
        cases = [(["--inpt=beam.xml"], ['"--inpt=beam.xml"', "Did you mean --input?", "rpc --help"]),
                 (["--chekc"], ['"--chekc"', "Did you mean --check?"]),
                 (["--threads=2", "--input=beam.xml"], ['unknown option "--threads=2"']),
                 (["beam.xml"], ['unknown option "beam.xml"', "--input=beam.xml"]),
                 ([], ["--input=DECK is missing"]),
                 (["--input="], ["--input needs a value"]),
                 (["--input"], ["--input needs a value"]),
                 (["--output", "--input=beam.xml"], ["--output needs a value"]),
                 (["--input=beam.xml", "--set"], ['--set needs a value, as in --set="Sublist->Parameter=value"']),
                 (["--check=no", "--input=beam.xml"], ["--check takes no value"]),
                 (["--kokkos-theads=2", "--version"], ['"--kokkos-theads=2"', "rpc --kokkos-help"]),
                 (["--kokkos-threads=many", "--version"], ["Kokkos refuses", "--kokkos-threads=many"]),
                 (["--kokkos-threads", "--version"], ["Kokkos refuses", "--kokkos-threads"])]
        for (arguments, parts), result in zip(cases, run_all([(a, self.folder) for a, _ in cases])):
            with self.subTest(arguments):
                self.expect_refusal(result, 2, parts)
        self.assertEqual(files(self.folder), [])

    def test_values_may_follow_their_options(self):
        self.rpc("--input", "beam.xml", "--set", "Mesh->Cells={20,4}", "--output", "out")
        self.assertIn("beam.json", files(self.folder / "out"))

    def host_program(self, commands):
        """The environment with a program of the shell's commands to hand small scenes over to."""
        program = self.folder / "host_rpc"
        program.write_text(f"#!/bin/sh\n{commands}\n")
        program.chmod(0o755)
        return {"RPC_HOST_PROGRAM": str(program)}

    def test_small_scene_is_handed_over(self):
        """To a program that tells its arguments, its processors and that it would not hand the scene on."""
        given = self.host_program('echo "$@; $RPC_HAND_OVER_REPORT; ${RPC_HOST_PROGRAM}."; grep Cpus_allowed_list /proc/self/status')
        cpus = re.search(r"Cpus_allowed_list:\s*(\S+)", pathlib.Path("/proc/self/status").read_text())[1]
        for places in ({}, {"OMP_PROC_BIND": "true", "OMP_PLACES": "cores"}):
            text = self.rpc("--input=beam.xml", SMALL, environment={**given, **places}).stdout
            self.assertRegex(text, r"^--input=beam.xml --set=\S+; taken over from \S+: 210 unknowns, at most \d+; \.\n")
            self.assertEqual(re.search(r"Cpus_allowed_list:\s*(\S+)", text)[1], cpus)

    def test_what_the_host_cannot_take_stays(self):
        given = self.host_program("exit 1")
        self.rpc("--version", environment=given)
        self.rpc("--input=beam.xml", SMALL, "--kokkos-threads=1", environment=given)
        self.rpc("--input=beam.xml", "--set=Mesh->Cells={2,1}", "--set=Material->Poisson's Ratio=7", environment=given, code=2)
        self.rpc("--input=beam.xml", "--set=Mesh->Cells={450,450}", "--set=Output->Exodus=none", environment=given)  # large
        self.rpc("--input=hertz.xml", "--set=Mesh->Size Factor=4", environment=given)  # of a size that gmsh will tell
        for missing in (self.folder / "nothing", self.folder):
            text = self.rpc("--input=beam.xml", SMALL, environment={"RPC_HOST_PROGRAM": str(missing)}).stdout
            self.assertIn(f'host: cannot start RPC_HOST_PROGRAM = "{missing}"', text)


class Decks(RpcTestCase):
    def test_deck_is_taken_as_given_before_one_that_comes_with_rpc(self):
        text = BEAM.read_text().replace('value="16"', 'value="-7"')
        (self.folder / "beam.xml").write_text(text)
        self.assertIn("got -7", self.rpc("--check", "--input=beam.xml", code=2).stderr)
        self.rpc("--check", f"--input={BEAM}")
        (self.folder / "beam.xml").unlink()
        self.assertIn(str(BEAM), self.rpc("--check", "--input=beam.xml").stdout)

    def test_deck_lies_where_the_environment_says(self):
        decks = self.folder / "decks"
        decks.mkdir()
        shutil.copy(BEAM, decks / "mine.xml")
        self.rpc("--check", "--input=mine.xml", environment={"RPC_INPUT_DIR": str(decks)})
        self.rpc("--check", "--input=mine.xml", code=2)

    def test_yaml_and_xml_and_the_roots_name_make_no_difference(self):
        (self.folder / "noname.xml").write_text(BEAM.read_text().replace('<ParameterList name="beam">', "<ParameterList>"))
        (self.folder / "noname.yaml").write_text(
            re.sub(r"^  ", "", YAML.read_text().replace("beam:\n", ""), flags=re.MULTILINE))
        expected = None
        for deck in [BEAM, YAML, self.folder / "noname.xml", self.folder / "noname.yaml"]:
            with self.subTest(deck.name):
                summary = self.solve(deck=deck)
                del summary["seconds"], summary["deck"]
                expected = expected or summary
                self.assertEqual(summary, expected)

    def test_yamls_infinity_is_a_rigid_foundation(self):
        expected = self.solve("--set=Contact->Yield Stress=inf")
        for number in [".inf", "+.INF"]:
            (self.folder / "rigid.yaml").write_text(YAML.read_text().replace("Yield Stress: 16", f"Yield Stress: {number}"))
            self.assertEqual(self.solve(deck="rigid.yaml")["energy_J"], expected["energy_J"])

    def test_assignments_win_over_the_deck_and_over_earlier_ones(self):
        summary = self.solve("--set=Mesh->Cells={10, 2}", "--set", "Contact->Yield Stress=2", "--set=Output->Exodus=false",
                             "--set=Contact->Yield Stress=10+0*x", "--set=Dirichlet->clamp->Side=left",
                             "--set=Dirichlet->clamp->Y=0")
        self.assertEqual((summary["cells"], summary["max_pressure"]), (20, 10))
        self.assertEqual(files(self.folder / "out"), ["beam.contact.csv", "beam.json"])


class Results(RpcTestCase):
    def expect_type(self, value, kind, name):
        if isinstance(kind, list):
            self.assertIsInstance(value, list, name)
            self.assertTrue(value, name)
            for item in value:
                self.expect_type(item, kind[0], name)
        else:
            self.assertIsInstance(value, kind, name)
            self.assertEqual(isinstance(value, bool), kind is bool, name)

    def test_summary_has_all_keys_and_agrees_with_itself(self):
        summary = self.solve()
        for name, kind in SUMMARY.items():
            self.assertIn(name, summary)
            self.expect_type(summary[name], kind, name)
        for phase in ["mesh", "assembly", "setup", "solve", "output", "total"]:
            self.expect_type(summary["seconds"][phase], NUMBER, phase)
            self.assertGreaterEqual(summary["seconds"][phase], 0)
        self.assertTrue(summary["converged"])
        self.assertEqual((summary["dofs"], summary["contact_nodes"], summary["ranks"]), (210, 21, 1))
        self.assertEqual(len(summary["newton_iterations"]), summary["uzawa_iterations"])
        self.assertEqual(len(summary["linear_iterations"]), summary["linear_solves"])
        self.assertEqual(len(summary["contact_force"]), 2)
        self.assertLess(summary["kkt_residual"], 1e-8)
        self.assertAlmostEqual(summary["energy_J"], -0.2113221, delta=1e-6)

    def test_table_is_sorted_and_agrees_with_the_summary(self):
        summary = self.solve()
        text = (self.folder / "out" / "beam.contact.csv").read_text()
        self.assertEqual(text.splitlines()[0], "x,y,s,u_nu,gap,pressure,state,side,dent,u_t_x,u_t_y,force_x,force_y")
        rows = [{k: v if k in ("state", "side") else float(v) for k, v in row.items()} for row in csv.DictReader(text.splitlines())]
        self.assertEqual(len(rows), summary["contact_nodes"])
        self.assertEqual([row["s"] for row in rows], sorted(row["s"] for row in rows))
        for k, column in enumerate(("force_x", "force_y")):
            self.assertAlmostEqual(sum(row[column] for row in rows), summary["contact_force"][k], delta=1e-12)
        for row in rows:
            self.assertAlmostEqual(row["s"], row["x"], delta=1e-12)
            self.assertEqual(row["y"], 0)
            self.assertTrue(0 <= row["pressure"] <= 16)
            self.assertEqual(row["state"], "yielding" if row["pressure"] == 16 else "closed" if row["pressure"] > 0 else "open")
            self.assertAlmostEqual(row["dent"], row["u_nu"] - row["gap"] if row["pressure"] == 16 else 0, delta=1e-15)
        self.assertEqual(max(row["pressure"] for row in rows), summary["max_pressure"])
        self.assertEqual(max(row["dent"] for row in rows), summary["max_dent"])
        self.assertAlmostEqual(max(row["u_nu"] - row["gap"] for row in rows), summary["max_penetration"], delta=1e-12)
        weights = [0.25 if 0 < row["x"] < 5 else 0.125 for row in rows]
        self.assertAlmostEqual(sum(w for w, row in zip(weights, rows) if row["state"] == "yielding"),
                               summary["yielded_length"], delta=1e-12)
        self.assertAlmostEqual(sum(w * row["pressure"] for w, row in zip(weights, rows)), summary["contact_force"][1],
                               delta=1e-9)

    def test_nodes_that_miss_the_obstacle_are_no_contact_nodes(self):
        circle = ["--set=Contact->Obstacle->Type=circle", "--set=Contact->Obstacle->Centre={2.5,-1}",
                  "--set=Contact->Obstacle->Radius=1", "--set=Contact->Normal=0, -1", "--set=Adapt->Estimate Error=true"]
        result = self.rpc("--input=beam.xml", SMALL, "--output=out", *circle)
        self.assertIn("note: from 12 nodes of the contact sides the normal misses the obstacle", result.stdout)
        summary = json.loads((self.folder / "out" / "beam.json").read_text())
        self.assertEqual((summary["contact_nodes"], summary["fixed_contact_nodes"]), (9, 0))
        self.assertTrue(math.isfinite(summary["error_estimate"]["relative"]))
        rows = list(csv.DictReader((self.folder / "out" / "beam.contact.csv").read_text().splitlines()))
        self.assertEqual([float(row["x"]) for row in rows], [1.5 + 0.25 * k for k in range(9)])
        for row in rows:
            self.assertAlmostEqual(float(row["s"]), float(row["x"]) - 1.5, delta=1e-12)
            self.assertAlmostEqual(float(row["gap"]), 1 - math.sqrt(1 - (float(row["x"]) - 2.5) ** 2), delta=1e-12)
        force = sum(0.25 * float(row["pressure"]) for row in rows)
        self.assertAlmostEqual(force, summary["contact_force"][1], delta=1e-9)
        self.assertGreater(force, 0)

    def test_folder_is_made_and_holds_the_results_alone(self):
        result = self.rpc("--input=beam.xml", SMALL, "--output=new/deeper")
        self.assertEqual(files(self.folder), [f"new/deeper/beam.{end}" for end in ("contact.csv", "e", "json")])
        for name in files(self.folder):
            self.assertIn(f"wrote {name}", result.stdout)
        self.assertEqual(errors(result), [])
        self.assertEqual(result.stderr, "")

    def test_older_results_are_replaced(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "beam.json").write_text("old")
        self.assertTrue(self.solve()["converged"])

    def test_files_of_an_earlier_run_do_not_stay_beside_results_without_them(self):
        self.solve()
        (self.folder / "out" / "beam.cycle1.e").write_text("of an adaptive run")
        (self.folder / "out" / "beam.cycle2.json").write_text("of an adaptive run")
        others = ["beam.csv", "beam.cycle1.txt", "beam2.e", "beam2.cycle1.e"]
        for name in others:
            (self.folder / "out" / name).write_text("the user's own")
        self.solve("--set=Output->CSV=false", "--set=Output->Exodus=false")
        self.assertEqual(files(self.folder / "out"), sorted(["beam.json", *others]))
        self.rpc("--input=beam.xml", SMALL, "--output=out", "--set=Output->JSON=false")
        self.assertEqual(files(self.folder / "out"), sorted(["beam.contact.csv", "beam.e", *others]))

    def test_note_says_that_dirichlet_wins_over_contact(self):
        self.assertIn("note: the normal displacement of 2 of 21 contact nodes is prescribed",
                      self.rpc("--input=beam.xml", SMALL, "--output=out").stdout)

    def test_run_that_does_not_converge_writes_no_results_and_says_why(self):
        # One step from a sweep each is enough for Uzawa's iterations to converge.
        for assignment, reason in [("Uzawa->Maximum Iterations=1", "1 Uzawa iteration"),
                                   ("NOX->Maximum Iterations=1", "Newton did not converge in 1 step")]:
            with self.subTest(assignment):
                summary = self.solve(f"--set={assignment}", "--set=Uzawa->Tolerance=1e-12",
                                     "--set=NOX->Direction->Method=Newton",
                                     output=assignment[:3], code=4)
                self.assertFalse(summary["converged"])
                self.assertIn(reason, summary["reason"])
                self.assertEqual(files(self.folder / assignment[:3]), ["beam.json"])
                for key in ["time", "energy_J", "max_pressure", "max_displacement", "strain_energy", "contact_length"]:
                    self.assertIsNone(summary[key])
                for key in ["contact_force", "reaction_force"]:
                    self.assertRegex(json.dumps(summary[key]), r"null")
                    self.assertNotRegex(json.dumps(summary[key]), r"\d")
                for key in ["kkt_residual", "equilibrium_residual", "energy_balance", "duality_gap"]:
                    self.assertIsInstance(summary[key], float)

    def test_numbers_that_are_not_finite_do_not_break_the_summary_and_are_named(self):
        summary = self.solve("--set=NOX->Direction->Method=Sweep", "--set=NOX->Line Search->Method=Full Step",
                             "--set=NOX->Line Search->Full Step->Full Step=1.7e308", code=4)  # json.loads has refused nothing
        self.assertFalse(summary["converged"])
        self.assertRegex(summary["reason"], r"not finite appeared first in the forces on the nodes.* of the node at \([\d.]+, [\d.]+\)")
        self.assertIsNone(summary["energy_J"])


class LoadSteps(RpcTestCase):
    """input/indent.xml: pressed, lifted, pressed again deeper."""

    LAWS = {"plastic": [], "hardening": ["--set=Contact->Hardening=200"], "springs": ["--set=Contact->Stiffness=1000"],
            "reversible": ["--set=Contact->Remembers=false"]}

    def indent(self):
        """{law: (rows of the history by their time, summary)}"""
        results = run_all([(["--input=indent.xml", "--set=Mesh->Size Factor=8", f"--output={law}", *arguments], self.folder)
                           for law, arguments in self.LAWS.items()])
        found = {}
        for law, result in zip(self.LAWS, results):
            self.assertEqual((result.returncode, errors(result)), (0, []), result.stdout)
            self.assertEqual(files(self.folder / law), [f"indent.{end}" for end in ("contact.csv", "e", "history.csv", "json")])
            rows = csv.DictReader((self.folder / law / "indent.history.csv").read_text().splitlines())
            rows = [{name: float(value) for name, value in row.items() if name != "reason"} for row in rows]
            summary = json.loads((self.folder / law / "indent.json").read_text())
            self.expect_agreement(rows, summary)
            found[law] = {row["time"]: row for row in rows}
        return found

    def expect_agreement(self, rows, summary):
        self.assertEqual([row["time"] for row in rows], [step["time"] for step in summary["steps"]])
        self.assertEqual(summary["time"], 3)
        for row, step in zip(rows, summary["steps"]):
            self.assertTrue(step["converged"])
            self.assertEqual(row["contact_force_y"], step["contact_force"][1])
            for name in ("work", "strain_energy", "foundation_energy", "dissipated_energy", "max_dent", "dent_volume", "max_pressure"):
                self.assertEqual(row[name], step[name])
            self.assertAlmostEqual(row["top_reaction_y"], -row["contact_force_y"], delta=1e-6)
        for name in ("contact_force", "max_dent", "contact_length", "strain_energy"):
            self.assertEqual(summary[name], summary["steps"][-1][name])

    def test_the_foundation_remembers_unless_it_is_told_not_to(self):
        for law, steps in self.indent().items():
            with self.subTest(law):
                force = {t: step["contact_force_y"] for t, step in steps.items()}
                dent = [step["max_dent"] for t, step in steps.items() if 1 <= t <= 2.5]
                for lifted, again in [(1.75, 2.125), (1.625, 2.1875), (1.5, 2.25), (1.25, 2.375), (1, 2.5)]:  # in the same place
                    self.assertAlmostEqual(force[lifted], force[again], delta=1e-7)
                last = steps[3]
                elastic = last["strain_energy"] + last["foundation_energy"]
                self.assertAlmostEqual(last["work"], elastic + last["dissipated_energy"], delta=0.03 * last["work"])
                if law == "reversible":
                    self.assertAlmostEqual(force[1.625], force[0.625], delta=1e-7)
                    self.assertLess(min(dent), 0.7 * max(dent))
                    self.assertEqual(last["dissipated_energy"], 0)
                    continue
                self.assertLess(force[1.625], 0.5 * force[0.625])
                self.assertEqual(force[2], 0)
                self.assertAlmostEqual(steps[2]["strain_energy"], 0, delta=1e-12)
                self.assertAlmostEqual(min(dent), max(dent), delta=1e-9)
                self.assertGreater(min(dent), 0.04)
                self.assertGreater(last["max_dent"], 1.5 * max(dent))

    def test_coarser_meshes_predict_a_step_in_which_points_begin_to_yield(self):
        for hardening in (0, 1000):  # with hardening the extrapolated pressures are in equilibrium, but beyond the yield limit
            summary = self.solve("--set=Mesh->Cells={80,16}", "--set=Steps->Times={0.3,0.6,1}",
                                 "--set=Traction->top->Y=-20*t*sin(pi*x/5)", f"--set=Contact->Hardening={hardening}")
            self.assertEqual(summary["steps"][1]["yielded_length"], 0)
            self.assertGreater(summary["steps"][2]["yielded_length"], 0)
            self.assertGreater(len(summary["levels"]), 0, hardening)
            for level in summary["levels"]:
                self.assertLess(level["dofs"], summary["dofs"])
                self.assertGreater(level["newton_iterations"], 0)


class Restarts(RpcTestCase):
    """Checkpoints of load steps, and runs that go on from them."""

    DECK = ["--input=beam.xml", SMALL, "--set=Traction->top->Y=-20*sin(pi*t)*sin(pi*x/5)"]
    TIMES = "--set=Steps->Times={0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9}"
    EVERY = "--set=Steps->Checkpoint Every=2"

    def summary(self, folder):
        summary = json.loads((self.folder / folder / "beam.json").read_text())
        for part in [summary, *summary["steps"]]:
            part.pop("seconds")
        return summary

    def test_a_run_that_goes_on_ends_where_an_uninterrupted_one_does(self):
        self.rpc(*self.DECK, self.TIMES, self.EVERY, "--output=whole")
        self.assertEqual([name for name in files(self.folder / "whole") if "checkpoint" in name],
                         ["beam.checkpoint-000006.e", "beam.checkpoint-000008.e"])  # the newest two
        self.rpc(*self.DECK, self.TIMES, self.EVERY, "--output=again", "--restart=whole/beam.checkpoint-000006.e")
        self.assertEqual(self.summary("whole"), self.summary("again"))  # bit for bit
        self.assertEqual(*[(self.folder / run / "beam.contact.csv").read_bytes() for run in ["whole", "again"]])
        self.assertGreater(self.summary("again")["steps"][-1]["dissipated_energy"], 0)  # there is something to remember
        self.assertEqual(len(self.summary("again")["steps"]), 9)

    def test_a_run_that_was_killed_goes_on(self):
        whole = self.rpc(*self.DECK, self.TIMES, "--output=whole")
        self.assertEqual(whole.returncode, 0)
        process = self.start(*self.DECK, self.TIMES, "--set=Steps->Checkpoint Every=1", "--output=killed")
        folder = self.folder / "killed"
        while process.poll() is None and not list(folder.glob("*.checkpoint-*.e")):
            time.sleep(0.002)
        process.kill()
        process.wait()
        newest = max(folder.glob("*.checkpoint-*.e"))
        self.rpc(*self.DECK, self.TIMES, "--output=again", f"--restart={newest}")
        a, b = [self.summary(run)["steps"][-1] for run in ["whole", "again"]]
        for name in ["dissipated_energy", "max_dent", "dent_volume", "strain_energy"]:
            self.assertAlmostEqual(a[name], b[name], delta=1e-10)

    def test_foreign_checkpoints_are_refused(self):
        self.rpc(*self.DECK, self.TIMES, self.EVERY, "--output=whole")
        checkpoint = "--restart=whole/beam.checkpoint-000006.e"
        cases = [([checkpoint, "--set=Contact->Yield Stress=17"], ["another deck", '"Contact->Yield Stress"', "it is 17 and was "]),
                 ([checkpoint, "--set=Mesh->Cells={21,4}"], ["another deck", '"Mesh->Cells"']),
                 ([checkpoint, "--set=Steps->Times={0.1, 0.6, 1}"], ["the steps at t = 0.1, 0.2", '"Steps->Times" has others']),
                 ([checkpoint, "--set=Steps->Times={0.1, 0.2, 0.3, 0.4, 0.5, 0.6}"], ["t = 0.6", "nothing to do"]),
                 (["--restart=whole/beam.e"], ["damaged or no checkpoint"]),
                 (["--restart=none.e"], ['no file "none.e"'])]
        results = run_all([([*self.DECK, self.TIMES, *arguments, f"--output=out{k}"], self.folder) for k, (arguments, _) in enumerate(cases)])
        for (arguments, parts), result in zip(cases, results):
            with self.subTest(arguments):
                self.expect_refusal(result, 2, ["restart:", *parts])
        self.expect_refusal(self.rpc("--input=beam.xml", checkpoint, code=2), 2, ["--restart goes with load steps"])
        # Later times, other output and other solvers are welcome.
        self.rpc(*self.DECK, "--set=Steps->Times={0.65, 1.5}", "--set=Output->CSV=false", "--set=Uzawa->Tolerance=1e-9",
                 "--output=on", checkpoint)
        self.assertEqual([round(step["time"], 2) for step in self.summary("on")["steps"]], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 1.5])


class AdaptiveRuns(RpcTestCase):
    def adapt(self, *arguments, code=0):
        result = self.rpc("--input=beam_adaptive.xml", "--output=out", *arguments, code=code)
        return result, json.loads((self.folder / "out" / "beam_adaptive.json").read_text())

    def test_the_summary_tells_the_way_to_the_target(self):
        result, summary = self.adapt("--set=Adapt->Target Relative Error=0.01", "--set=Adapt->Exact Energy=-0.21344083")
        adaptation, estimate = summary["adaptation"], summary["error_estimate"]
        self.assertTrue(adaptation["reached"])
        self.assertLessEqual(estimate["relative"], 0.01)
        self.assertAlmostEqual(estimate["effectivity"], 1, delta=0.5)
        self.assertAlmostEqual(estimate["energy_norm"] ** 2, sum(estimate[part] ** 2 for part in (
            "recovery", "contact_equilibrium", "contact_complementarity")), delta=1e-9 * estimate["energy_norm"] ** 2)
        cycles = adaptation["cycles"]
        self.assertEqual(cycles[-1]["dofs"], summary["dofs"])
        self.assertEqual(cycles[-1]["relative_estimate"], estimate["relative"])
        self.assertGreater(cycles[0]["relative_estimate"], 0.01)
        for error in adaptation["errors"].values():
            self.assertIsInstance(error, float)
        self.assertEqual(adaptation["errors_unknown"], {})
        self.assertIn("the error is what was asked for", result.stdout)
        self.assertEqual(files(self.folder / "out"), ["beam_adaptive.contact.csv", "beam_adaptive.e", "beam_adaptive.json"])

    def test_a_target_out_of_reach_ends_with_code_4_and_the_best_result(self):
        result, summary = self.adapt("--set=Adapt->Target Relative Error=1e-6", "--set=Adapt->Max Dofs=3000", code=4)
        self.assertEqual(errors(result), [])
        self.assertIn("NOT TO THE TARGET", result.stdout)
        self.assertTrue(summary["converged"])
        self.assertFalse(summary["adaptation"]["reached"])
        self.assertIn("Max Dofs", summary["adaptation"]["reason"])
        self.assertLessEqual(summary["dofs"], 3000)
        self.assertLess(summary["error_estimate"]["relative"], 0.01)
        self.assertTrue((self.folder / "out" / "beam_adaptive.e").exists())

    def test_a_hint_leads_from_p2_to_q2_where_it_loses_an_order(self):
        hint = 'P2 loses an order in block "body" with nu = 0.49'
        rubber = ["--set=Material->Poisson's Ratio=0.49", "--set=Adapt->Max Dofs=3000"]
        result, summary = self.adapt("--set=Adapt->Target Relative Error=0.1", *rubber)
        self.assertEqual(result.stdout.count(f"note: {hint}"), 1)
        self.assertTrue(summary["adaptation"]["reached"])
        self.assertEqual(summary["adaptation"]["reason"], "")
        result, summary = self.adapt("--set=Adapt->Target Relative Error=1e-6", *rubber, code=4)
        self.assertEqual(result.stdout.count(f"note: {hint}"), 1)
        self.assertIn("Max Dofs", summary["adaptation"]["reason"])
        self.assertIn(hint, summary["adaptation"]["reason"])
        for other in ["Material->Poisson's Ratio=0.48", "Mesh->Element=Q2"]:
            result, summary = self.adapt("--set=Adapt->Target Relative Error=1e-6", *rubber, f"--set={other}", code=4)
            self.assertNotIn("loses an order", result.stdout + summary["adaptation"]["reason"])

    def test_the_first_mesh_shows_no_errors_by_the_sequence(self):
        for target, code in [("0.3", 0), ("1e-6", 4)]:
            result, summary = self.adapt(f"--set=Adapt->Target Relative Error={target}", "--set=Adapt->Max Cycles=1", code=code)
            self.assertRegex(result.stdout, r"\n  errors +of J alone: one mesh shows no change\n")
            self.assertNotIn("nan", result.stdout)
            self.assertEqual(set(summary["adaptation"]["errors"].values()), {None})

    def test_a_beam_that_is_only_lifted_needs_one_mesh_and_the_run_says_why(self):
        result, summary = self.adapt("--set=Dirichlet->left->Y=0.01", "--set=Dirichlet->right->Y=0.01",
                                     "--set=Traction->top->Y=0")
        adaptation, estimate = summary["adaptation"], summary["error_estimate"]
        self.assertTrue(adaptation["reached"])
        self.assertEqual(len(adaptation["cycles"]), 1)
        self.assertEqual(estimate["relative"], 0)
        self.assertLess(summary["energy_norm_squared"], estimate["rounding"] ** 2)
        self.assertIn("nothing is strained", adaptation["reason"])
        self.assertIn("nothing is strained", result.stdout)
        self.assertNotIn("nan", result.stdout)

    def test_an_error_bar_that_cannot_be_had_is_null_and_the_run_says_why(self):
        result, summary = self.adapt("--set=Adapt->Target Relative Error=0.02",
                                     "--set=Contact->Yield Stress=x < 2.5 ? 3 : inf")
        adaptation = summary["adaptation"]
        self.assertIsNone(adaptation["errors"]["max_pressure"])
        self.assertIsInstance(adaptation["errors"]["energy_J"], float)
        self.assertEqual(list(adaptation["errors_unknown"]), ["max_pressure"])
        self.assertIn("yield stress jumps", adaptation["errors_unknown"]["max_pressure"])
        self.assertRegex(result.stdout, r" Pa at \(.*\) m.* \(no error bar: the yield stress jumps")

    def test_every_mesh_is_written_on_request(self):
        _, summary = self.adapt("--set=Adapt->Target Relative Error=0.01", "--set=Adapt->Write All=true")
        for cycle in range(1, 1 + len(summary["adaptation"]["cycles"])):
            for ending in (".e", ".json", ".contact.csv"):
                self.assertTrue((self.folder / "out" / f"beam_adaptive.cycle{cycle}{ending}").exists())
        names = files(self.folder / "out")
        _, summary = self.adapt("--set=Adapt->Target Relative Error=0.02", "--set=Adapt->Write All=true",
                                "--set=Output->CSV=false")
        kept = [f"beam_adaptive.{cycle}{ending}" for ending in ("e", "json")
                for cycle in ["", *(f"cycle{c + 1}." for c in range(len(summary["adaptation"]["cycles"])))]]
        self.assertLess(len(kept), len(names))
        self.assertEqual(files(self.folder / "out"), sorted(kept))
        self.adapt("--set=Adapt->Target Relative Error=0.02")
        self.assertEqual(len(files(self.folder / "out")), 3)

    def test_a_single_mesh_has_an_estimate_on_request(self):
        summary = self.solve("--set=Adapt->Estimate Error=true", "--set=Adapt->Exact Energy=-0.21344083")
        self.assertAlmostEqual(summary["error_estimate"]["effectivity"], 1, delta=0.1)
        self.assertNotIn("adaptation", summary)
        self.assertNotIn("error_estimate", self.solve())

    def test_an_estimate_takes_tractions_at_the_time_of_its_step(self):
        arguments = ("--set=Adapt->Estimate Error=true", "--set=Contact->Yield Stress=inf",
                     "--set=Traction->top->Y=-5*t*sin(pi*x/5)", "--set=Traction->bottom->X=3*t*x*(5-x)")
        at_once, in_steps = self.solve(*arguments, "--set=Time=2"), self.solve(*arguments, "--set=Steps->Times={1,2}")
        self.assertGreater(at_once["error_estimate"]["contact_equilibrium"], 0)
        for part, value in at_once["error_estimate"].items():
            if part not in ("rounding", "exact_relative", "effectivity"):
                self.assertAlmostEqual(in_steps["error_estimate"][part], value, delta=1e-5 * abs(value), msg=part)


class PassThrough(RpcTestCase):
    def test_muelu_gets_its_parameters(self):
        levels = "--set=Linear Solver->MueLu->coarse: max size=20"  # small meshes are solved directly by default
        arguments = (levels, "--set=Contact->Yield Stress=2")
        chebyshev = self.solve(*arguments)
        factors = self.solve(*arguments, "--set=Linear Solver->MueLu->smoother: type=ILUT")
        degree = self.solve(*arguments, "--set=Linear Solver->MueLu->smoother: params->chebyshev: degree=5")
        for summary in (factors, degree):
            self.assertLess(sum(summary["linear_iterations"]), sum(chebyshev["linear_iterations"]))
            self.assertAlmostEqual(summary["energy_J"], chebyshev["energy_J"], delta=1e-9 * abs(chebyshev["energy_J"]))

    def test_belos_gets_its_parameters(self):
        silent = self.rpc("--input=beam.xml", SMALL, "--output=out")
        talks = self.rpc("--input=beam.xml", SMALL, "--output=out", "--set=Linear Solver->Belos->Verbosity=127",
                         "--set=Linear Solver->Belos->Output Frequency=1")
        self.assertNotIn("Belos", silent.stdout)
        self.assertIn("Belos", talks.stdout)

    def test_fields_follow_the_time(self):
        loaded = self.solve("--set=Contact->Yield Stress=32*t", "--set=Traction->top->Y=-40*t*sin(pi*x/5)", "--set=Time=0.5")
        given = self.solve("--set=Contact->Yield Stress=16", "--set=Traction->top->Y=-20*sin(pi*x/5)")
        late = self.solve("--set=Contact->Yield Stress=16*t", "--set=Traction->top->Y=-20*t*sin(pi*x/5)")
        for summary in loaded, late:  # without steps, t = 1
            self.assertAlmostEqual(summary["energy_J"], given["energy_J"], delta=1e-10 * abs(given["energy_J"]))

    def test_another_krylov_method_works(self):
        self.assertTrue(self.solve("--set=Linear Solver->Method=Block GMRES")["converged"])

    def test_nox_gets_its_parameters(self):
        start = "--set=NOX->Direction->Method=Sweep"
        result = self.rpc("--input=beam.xml", SMALL, "--output=out", start, "--set=NOX->Line Search->Method=Full Step")
        steps = re.findall(r"^ +\d+ +[1-9]\d* +\S+ +(\d\S+) +\d+ +\d+ +\d+", result.stdout, re.MULTILINE)
        self.assertTrue(steps)
        self.assertEqual(set(steps), {"1.00e+00"})
        half = self.rpc("--input=beam.xml", SMALL, "--output=out", start, "--set=NOX->Line Search->Method=Full Step",
                        "--set=NOX->Line Search->Full Step->Full Step=0.5")
        self.assertIn("5.00e-01", half.stdout)


if __name__ == "__main__":
    unittest.main()

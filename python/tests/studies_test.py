# SPDX-License-Identifier: BSD-3-Clause
"""Parameter studies."""
import contextlib
import csv
import io
import os
import signal
import subprocess
import sys
import time
import unittest

from support import LARGE, TestCase, beam, rpc

FORCE = "contact_force"
YIELD = "Contact->Yield Stress"


class Studies(TestCase):
    def study(self, *arguments, **options):
        """Results, and what was told of progress."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            return rpc.study(*arguments, **options), said.getvalue().splitlines()

    def counted(self):
        """A program that leaves a line for each run of it."""
        return self.script(f"case $1 in --version) ;; *) echo run >> '{self.folder}/runs';; esac\nexec \"$RPC\" \"$@\"")

    def runs(self):
        """How many runs there were since the last call."""
        path = self.folder / "runs"
        count = len(path.read_text().splitlines()) if path.exists() else 0
        path.unlink(missing_ok=True)
        return count

    def test_results_come_in_the_order_of_the_parameters(self):
        results, said = self.study(beam(), {YIELD: [2, 4.5], "Contact->Gap": [0, "1"]}, workers=2)
        self.assertEqual([result.settings for result in results],
                         [{YIELD: xi, "Contact->Gap": gap} for xi in (2, 4.5) for gap in (0, "1")])
        for result, force in zip(results, (10, 0, 22.5, 0)):
            self.assertAlmostEqual(result.summary[FORCE][1], force, delta=1e-9)
        self.assertEqual(len(said), 4)
        self.assertTrue(said[-1].startswith("4/4 Contact->Yield Stress = "), said)
        self.assertIn(": converged (", said[0])
        self.assertIn(" s left)", said[0])

    def test_a_list_is_taken_as_it_is_and_a_deck_may_be_a_file(self):
        results, said = self.study("beam.xml", [{YIELD: 2, "Mesh->Cells": [20, 4]}, {"Mesh->Cells": [10, 2]}], progress=False)
        self.assertEqual([result.summary["cells"] for result in results], [80, 20])
        self.assertEqual(said, [])

    def test_failures_are_kept_in_their_place(self):
        results, said = self.study(beam(), {YIELD: [2, "x*", 4]})
        self.assertEqual([result.code for result in results], [0, 2, 0])
        self.assertIn('"x*" is not a number', results[1].message)
        self.assertIn("exit code 2, deck: ", said[1])

    def test_what_has_not_changed_is_not_run_again(self):
        options = {"folder": self.folder / "study", "program": self.counted()}
        first, _ = self.study(beam(), {YIELD: [2, 4, 4, "x*"]}, **options)
        self.assertEqual(self.runs(), 3)  # equal rows are one run
        self.assertEqual([result.settings[YIELD] for result in first], [2, 4, 4, "x*"])
        same, _ = self.study(beam(), [{YIELD: 2}, {YIELD: 2, "Mesh->Cells": [20, 4]}], **options)
        self.assertEqual([len(result.settings) for result in same], [1, 2])  # two ways to say the same
        self.assertEqual(self.runs(), 0)
        again, said = self.study(beam(), {YIELD: [4, 2, "x*", 8]}, **options)
        self.assertEqual(self.runs(), 2)  # what is new, and what was refused: it may have been the fault of a folder
        self.assertEqual([again[k].folder for k in (0, 1)], [first[k].folder for k in (1, 0)])
        self.assertAlmostEqual(again[1].summary[FORCE][1], 10, delta=1e-9)
        self.assertEqual(again[1].settings, {YIELD: 2})
        self.assertEqual(sum("kept from before" in line for line in said), 2)
        self.study(beam(Material__Poissons_Ratio=0.2), {YIELD: [2]}, **options)
        self.assertEqual(self.runs(), 1)
        (again[0].folder / "deck.json").unlink()
        self.study(beam(), {YIELD: [4]}, **options)
        self.assertEqual(self.runs(), 1)
        with open(self.folder / "study" / "study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([[row[name] for name in ("folder", "exit_code", YIELD)] for row in rows], [[again[0].folder.name, "0", "4"]])

    def test_the_table_has_the_main_results_of_each_run(self):
        results, _ = self.study(beam(Adapt={"Estimate Error": True}), {YIELD: [2, "x*", 4]}, folder=self.folder / "study")
        with open(self.folder / "study" / "study.csv", newline="") as file:
            table = csv.DictReader(file)
            rows = list(table)
        self.assertEqual(table.fieldnames[:4], ["folder", "exit_code", YIELD, "seconds"])
        self.assertEqual(table.fieldnames[-1], "reason")
        self.assertNotIn("contact_area", table.fieldnames)  # the body is plane
        self.assertEqual([row["exit_code"] for row in rows], ["0", "2", "0"])
        self.assertEqual([row["reason"] for row in rows], ["", results[1].message, ""])
        self.assertEqual({rows[1][name] for name in table.fieldnames[4:-1]}, {""})
        for row, result, force in zip(rows[::2], results[::2], (10, 20)):
            told = result.summary["results"]
            self.assertAlmostEqual(float(row["contact_force"]), force, delta=1e-9)
            for key in ("max_pressure", "contact_length", "energy_J"):
                self.assertEqual((float(row[key]), row[key + "_unit"]), (told[key]["value"], told[key]["unit"]))
            self.assertEqual(float(row["energy_J_error_bar"]), told["energy_J"]["error_bar"])
            self.assertEqual(row["contact_force_error_bar"], "")  # one mesh shows none
            self.assertGreater(float(row["seconds"]), 0)

    def test_the_table_has_how_far_a_force_moves_a_side_or_an_obstacle(self):
        obstacle = {"Type": "sphere", "Centre": [2.5, -3], "Radius": 3, "Force Y": 20}
        for deck, name, moved_of in (
                (beam(Dirichlet={"top": {"X": 0, "Force Y": -20}}, Traction={}), "force_displacement of top", lambda s: -s["force_displacement"]["top"][1]),
                (beam(Contact__Obstacle=obstacle, Traction={}), "obstacle_displacement", lambda s: s["obstacle_displacement"][1])):
            with self.subTest(name):
                results, _ = self.study(deck, {"Material->Young's Modulus": [1000]}, folder=self.folder / "study")
                with open(self.folder / "study" / "study.csv", newline="") as file:
                    row = next(csv.DictReader(file))
                self.assertGreater(moved_of(results[0].summary), 1e-3)
                self.assertAlmostEqual(float(row[name]), moved_of(results[0].summary))
                self.assertEqual(row[f"{name}_unit"], "m")

    def test_a_file_of_an_obstacle_is_found_and_counts(self):
        heights, deck = self.folder / "heights.csv", self.folder / "rough.xml"
        heights.write_text("0, 0, 0\n")
        obstacle = {"Type": "height map", "File": heights.name, "Spacing X": 5, "Origin": [0, -0.001], "Normal": [0, 1]}
        rpc.write_deck(beam(Contact__Obstacle=obstacle), deck)
        program, options = self.counted(), {"folder": self.folder / "study"}
        first, _ = self.study(deck, {YIELD: [2]}, program=program, **options)
        self.assertEqual((first[0].code, first[0].message), (0, ""))
        self.study(deck, {YIELD: [2]}, program=program, **options)
        self.assertEqual(self.runs(), 1)
        heights.write_text("0, 0.0005, 0\n")
        self.study(deck, {YIELD: [2]}, program=program, **options)
        self.assertEqual(self.runs(), 1)

    def test_the_table_has_the_force_of_each_of_several_sides(self):
        deck = beam(Dirichlet={"left": {"X": 0}}, Traction={}, Contact={"Side": "bottom", "Gap": -0.002, "Sides": {"top": {"Gap": -0.002}}})
        self.study(deck, {"Material->Poisson's Ratio": [0.3]}, folder=self.folder / "study")
        with open(self.folder / "study" / "study.csv", newline="") as file:
            row = next(csv.DictReader(file))
        self.assertLess(float(row["contact_force"]), 1e-8 * float(row["contact_force on top"]))
        self.assertAlmostEqual(float(row["contact_force on bottom"]) / float(row["contact_force on top"]), 1)

    def test_a_run_that_was_interrupted_is_run_again(self):
        logs = f"'{self.folder}'/study/run-*/deck.log"
        stopping = self.script(f'case $1 in --version) exec "$RPC" "$@";; esac\n"$RPC" "$@" &\nuntil grep -q uzawa {logs}; do sleep 0.02; done\n'
                               "kill -TERM $!\nwait $!", "stopping.sh")
        deck = rpc.with_settings(beam(), LARGE)
        stopped, _ = self.study(deck, {YIELD: [8]}, folder=self.folder / "study", program=stopping)
        self.assertEqual((stopped[0].code, stopped[0].message[:22]), (4, "interrupted by SIGTERM"))
        self.study(deck, {YIELD: [8]}, folder=self.folder / "study", program=self.counted(), timeout=0.3)
        self.assertEqual(self.runs(), 1)

    def test_a_mesh_that_has_changed_is_another_run(self):
        mesh = self.folder / "beam.geo"
        text = 'Point(1) = {0, 0, 0, 0.5}; out[] = Extrude {5, 0, 0} { Point{1}; }; all[] = Extrude {0, %s, 0} { Curve{1}; };\n' \
               'Physical Surface("body") = {5}; Physical Curve("bottom") = {1}; Physical Curve("top") = {2}; Physical Curve("ends") = {3, 4};\n'
        mesh.write_text(text % "1")
        deck = beam(Mesh={"Type": "gmsh", "File": str(mesh)}, Dirichlet={"ends": {"X": 0, "Y": 0}})
        options = {"folder": self.folder / "study", "program": self.counted(), "progress": False}
        codes = [result.code for _ in range(2) for result in rpc.study(deck, {YIELD: [8]}, **options)]
        self.assertIn(codes, ([0, 0], [2, 2]))  # 2: built without gmsh
        self.assertEqual(self.runs(), 1 if codes == [0, 0] else 2)
        mesh.write_text(text % "1.5")
        rpc.study(deck, {YIELD: [8]}, **options)
        self.assertEqual(self.runs(), 1)

    def test_a_height_map_that_has_changed_is_another_run(self):
        heights = self.folder / "flat.csv"
        obstacle = {"Type": "height map", "File": str(heights), "Spacing X": 1.25, "Origin": [0.0, 0.0], "Normal": [0.0, 1.0]}
        deck = beam(Contact={"Side": "bottom", "Obstacle": obstacle})
        energies = []
        for height in ("-0.001", "-0.001", "-0.002"):
            heights.write_text(",".join([height] * 5) + "\n")
            results, _ = self.study(deck, {YIELD: [8]}, folder=self.folder / "study", program=self.counted())
            self.assertEqual(results[0].code, 0, results[0].message)
            energies.append(results[0].summary["energy_J"])
        self.assertEqual(energies[0], energies[1])
        self.assertNotEqual(energies[1], energies[2])
        self.assertEqual(self.runs(), 2)

    def test_ctrl_c_ends_all_runs(self):
        program = self.script(f"echo $$ >> '{self.folder}/pids'\nexec sleep 600")
        code = f"import rpc; rpc.study('beam.xml', {{{YIELD!r}: [8, 12, 16]}}, workers=2, program={str(program)!r})"
        process = subprocess.Popen([sys.executable, "-B", "-c", code], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        begin = time.monotonic()
        while not (self.folder / "pids").exists() or len((self.folder / "pids").read_text().splitlines()) < 2:
            self.assertLess(time.monotonic() - begin, 60)
            time.sleep(0.02)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", stderr)
        pids = (self.folder / "pids").read_text().split()
        self.assertEqual(len(pids), 2)  # the third has not begun
        for pid in pids:
            self.assertFalse(os.path.exists(f"/proc/{pid}"), pid)

    def test_what_cannot_be_studied_is_refused_before_the_first_run(self):
        program = self.counted()
        for parameters, parts in (({YIELD: 3}, [YIELD, "a list of values"]), ({YIELD: "12"}, ["a list of values"]), ([1], ["a list of dicts"]),
                                  ({YIELD: [1, None]}, [YIELD, "None"]), ({"Contact->Side->x": [1]}, ["leads through"])):
            self.refused(parts, rpc.study, beam(), parameters, program=program)
        self.refused(["workers must be an int > 0"], rpc.study, beam(), {YIELD: [1]}, workers=0, program=program)
        self.refused(["ranks must be"], rpc.study, beam(), {YIELD: [1]}, ranks=0, program=program)
        self.refused(["nowhere"], rpc.study, beam(), {YIELD: [1]}, program=self.folder / "nowhere")
        (self.folder / "file").touch()
        self.refused(["file"], rpc.study, beam(), {YIELD: [1]}, folder=self.folder / "file", program=program)
        self.assertEqual(self.runs(), 0)


if __name__ == "__main__":
    unittest.main()

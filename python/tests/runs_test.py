# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the program, and how they end."""
import gc
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

from support import HAS_MPI, LARGE, SMALL, SOURCE, TestCase, beam, rpc

import numpy as np


class Runs(TestCase):
    def test_a_dict_and_a_file_give_the_same(self):
        of_dict = rpc.run(beam(), settings={"Contact->Yield Stress": 12})
        of_file = rpc.run(SOURCE / "input" / "beam.xml", settings={**SMALL, "Contact->Yield Stress": 12})
        self.assertTrue(of_dict.ok and of_file.ok)
        self.assertEqual((of_dict.message, of_dict.name, of_file.name), ("", "deck", "beam"))
        self.assertEqual(of_dict.summary["energy_J"], of_file.summary["energy_J"])
        self.assertAlmostEqual(of_dict.summary["contact_force"][1], 60, delta=1e-9)  # xi times the length: all yields
        self.assertIn("contact force", of_dict.console)

    def test_the_program_reads_values_of_all_kinds(self):
        result = rpc.run(beam(), settings={
            "Contact->Yield Stress": float("inf"), "Contact->Gap": 'x < 2.5 && y <= 0 ? 0.001 : 1e-3', "Nested Iteration->Enabled": False,
            "Traction->größer & <>": {"Side": "top", "X": 0.5, "Y": -1}, "Uzawa->Tolerance": 1e-9, "Linear Solver->MueLu->sa: damping factor": 1.2})
        self.assertEqual(result.summary["yielded_length"], 0)
        self.assertEqual(set(result.contact()["gap"]), {1e-3})

    def test_temporary_folders_go_with_their_results(self):
        result = rpc.run(beam())
        folder = result.folder
        self.assertTrue((folder / "deck.json").is_file())
        del result
        gc.collect()
        self.assertFalse(folder.exists())

    def test_bad_input_is_exit_code_2(self):
        error = self.refused(['"Contact->Yeld Stress"', 'Did you mean "Yield Stress"?'], rpc.run, beam(), settings={"Contact->Yeld Stress": 1}, code=2)
        self.assertTrue(error.message.startswith("deck: "), error.message)
        self.assertIn("mend the parameter", error.remedy)
        self.assertEqual(error.result.code, 2)
        self.refused(["nowhere.xml"], rpc.run, "nowhere.xml", code=2)

    def test_files_of_an_earlier_run_are_not_taken_for_its_own(self):
        rpc.run(beam(), folder=self.folder)
        result = rpc.run(beam(), folder=self.folder, settings={"Contact->Yeld Stress": 1}, check=False)
        self.assertEqual((result.code, result.files), (2, []))
        self.assertTrue((self.folder / "deck.json").is_file())  # it is the user's
        for read in (lambda: result.summary, result.contact, result.history, result.fields, lambda: result.times):
            self.refused(["has written no", "Yeld"], read, code=2)

    def test_a_bad_mesh_is_exit_code_3(self):
        (self.folder / "bad.msh").write_text("$MeshFormat\n9 9 9\n")
        self.refused(["bad.msh", "mend the mesh"], rpc.run, beam(Mesh={"Type": "gmsh", "File": str(self.folder / "bad.msh")}), code=3)

    def test_not_converged_is_exit_code_4_and_its_summary_is_there(self):
        error = self.refused(['raise "Uzawa->Tolerance"'], rpc.run, beam(Uzawa__Tolerance=1e-40), code=4)
        self.assertFalse(error.result.summary["converged"])
        self.refused(['"Adapt->Max Cycles" = 1'], rpc.run, "beam_adaptive.xml", settings={"Adapt->Max Cycles": 1}, code=4)

    def test_no_solution_is_exit_code_5_and_the_steps_before_are_there(self):
        deck = beam(Dirichlet={"left": {"X": 0.0}}, Steps={"Times": [0.2, 0.5, 1.0]}, Traction={"top": {"Y": "-10*t"}})
        error = self.refused(["at t = 1", "the foundation carries at most 30"], rpc.run, deck, settings={"Contact->Yield Stress": 6}, code=5)
        self.assertIn("lower the load", error.remedy)
        history = error.result.history()
        self.assertEqual(history["converged"].tolist(), [1, 1, 0])
        self.assertIn("the foundation carries at most 30", history["reason"][2])
        self.assertEqual(error.result.times.tolist(), [0.2, 0.5])

    def test_a_run_that_is_killed_is_an_error_with_the_signal(self):
        self.refused(["killed by signal 9", "memory"], rpc.run, beam(), program=self.script("kill -9 $$"), code=-9)
        self.refused(["killed by signal 11"], rpc.run, beam(), program=self.script("kill -11 $$"), code=-11)
        self.refused(["killed by signal 9"], rpc.run, beam(), program=self.script("exit 137"), code=-9)  # as launchers tell

    def test_what_others_than_rpc_say_is_told_as_theirs(self):
        self.refused(["a library is missing", "rpc itself has said nothing"], rpc.run, beam(), program=self.script("echo a library is missing >&2; exit 127"),
                     code=127)
        error = self.refused([" ..."], rpc.run, beam(), program=self.script("for k in 1 2 3 4 5 6 7 8 9; do echo " + 60 * "x" + " >&2; done; exit 1"), code=1)
        self.assertLess(len(error.message), 310)

    def test_time_can_run_out(self):
        begin = time.monotonic()
        result = rpc.run(beam(), settings=LARGE, timeout=0.3, check=False)
        self.assertIn(result.code, (4, -signal.SIGTERM))  # the latter if the program has not got so far as to look for signals
        self.assertIn("interrupted by timeout = 0.3 [s]", result.message)
        self.assertLess(time.monotonic() - begin, 60)

    def test_load_steps_go_on_after_a_checkpoint(self):
        settings = {"Mesh->Cells": [24, 12], "Steps->Checkpoint Every": 1}
        rpc.run("shear.xml", folder=self.folder, settings={**settings, "Steps->Times": [0.5, 1]})
        result = rpc.run("shear.xml", folder=self.folder, settings={**settings, "Steps->Times": [0.5, 1, 1.125]}, restart=True)
        self.assertIn("goes on after", result.console)
        self.assertEqual(result.history()["time"].tolist(), [0.5, 1, 1.125])
        self.assertEqual(result.times.tolist(), [0.5, 1, 1.125])
        self.refused(["--restart"], rpc.run, "beam.xml", folder=self.folder, restart=True, code=2)

    def test_a_missing_program_is_refused(self):
        nowhere = self.folder / "nowhere"
        self.refused([f'program = "{nowhere}"', "remedy"], rpc.run, beam(), program=nowhere)
        self.environment(RPC_PROGRAM=nowhere)
        self.refused(["$RPC_PROGRAM"], rpc.run, beam())
        (self.folder / "empty").mkdir()
        self.environment(RPC_PROGRAM=None, PATH=self.folder / "empty")
        script = self.folder / "no_interpreter"
        script.write_text("#!/nowhere/sh\n")
        script.chmod(0o755)
        self.refused(["cannot start"], rpc.run, beam(), program=script)

    def test_the_program_is_looked_for_in_a_checkout_and_on_the_path(self):
        shutil.copytree(SOURCE / "python" / "rpc", self.folder / "site" / "rpc", ignore=shutil.ignore_patterns("__pycache__"))
        (self.folder / "checkout" / "packages" / "contact").mkdir(parents=True)
        (self.folder / "checkout" / "CMakeLists.txt").touch()
        (self.folder / "bin").mkdir()
        self.environment(RPC_PROGRAM=None, PATH=self.folder / "bin")
        paths = [path for path in sys.path if path != str(SOURCE / "python")]

        def found():
            code = f"import sys; sys.path = [{str(self.folder / 'site')!r}, *{paths!r}]; import rpc\ntry: print(rpc.find_program())\nexcept rpc.Error as e: print(e)"
            return subprocess.run([sys.executable, "-B", "-c", code], cwd=self.folder / "checkout", capture_output=True, text=True, check=True).stdout.strip()
        self.assertIn("there is no rpc; searched", found())
        for place in ("bin/rpc", "checkout/rpc", "checkout/build/rpc"):  # from the last to the first
            (self.folder / place).parent.mkdir(exist_ok=True)
            shutil.copy(self.script(""), self.folder / place)
            self.assertEqual(found(), str(self.folder.resolve() / place))

    def test_what_cannot_be_run_is_refused(self):
        self.refused(["must be a dict or the name of a file", "list"], rpc.run, [1])
        self.refused(['"Contact->Gap"', "NoneType"], rpc.run, "beam.xml", settings={"Contact->Gap": None})
        for ranks in (0, 1.5, True, "2"):
            self.refused(["ranks must be an int > 0"], rpc.run, beam(), ranks=ranks)
        (self.folder / "file").touch()
        self.refused(["folder=", "file"], rpc.run, beam(), folder=self.folder / "file")
        self.environment(RPC_MPIRUN="nowhere/mpirun -x")
        self.refused(["ranks = 2", '"nowhere/mpirun"', "$RPC_MPIRUN"], rpc.run, beam(), ranks=2)

    @unittest.skipUnless(HAS_MPI, "needs MPI")
    def test_two_ranks_give_the_same_and_their_files_are_joined(self):
        one = rpc.run(beam())
        two = rpc.run(beam(), ranks=2, folder=self.folder, settings={"Output->Exodus": "split"})
        self.assertEqual(two.summary["ranks"], 2)
        self.assertEqual([file for file in two.files if ".e" in file], ["deck.e.2.0", "deck.e.2.1"])
        self.assertAlmostEqual(two.summary["energy_J"], one.summary["energy_J"], delta=1e-12)
        expected, found = one.fields(), two.fields()
        np.testing.assert_array_equal(found.points, expected.points)
        np.testing.assert_array_equal(found.blocks[0].cells, expected.blocks[0].cells)
        self.assertEqual((found.blocks[0].name, found.blocks[0].element), (expected.blocks[0].name, expected.blocks[0].element))
        self.assertEqual(found.nodal.keys(), expected.nodal.keys())
        for name in expected.nodal:
            np.testing.assert_allclose(found[name], expected[name], atol=1e-9 * np.abs(expected[name]).max())
        for name in expected.sides:
            np.testing.assert_array_equal(found.sides[name], expected.sides[name])
        os.remove(self.folder / "deck.e.2.1")
        lost = rpc.load(self.folder / "deck")
        self.refused(["does not read"], lost.fields)

    @unittest.skipUnless(HAS_MPI, "needs MPI")
    def test_a_python_that_mpirun_has_started_runs_programs_of_its_own(self):
        code = "import rpc; print(rpc.run('beam.xml', settings={'Mesh->Cells': [20, 4]}).summary['ranks'])"
        launcher = shlex.split(os.environ.get("RPC_MPIRUN", "mpirun --oversubscribe"))
        result = subprocess.run([*launcher, "-n", "2", sys.executable, "-B", "-c", code], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
        self.assertEqual((result.returncode, result.stdout.split()), (0, ["1", "1"]), result.stderr)

    @unittest.skipUnless(HAS_MPI, "needs MPI")
    def test_messages_and_exit_codes_come_from_two_ranks(self):
        self.refused(['"Contact->Yeld Stress"'], rpc.run, beam(), ranks=2, settings={"Contact->Yeld Stress": 1}, code=2)


if __name__ == "__main__":
    unittest.main()

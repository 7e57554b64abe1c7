# SPDX-License-Identifier: BSD-3-Clause
"""SIGINT and SIGTERM: the run stops with what it has found so far; a second signal ends it at once. On several ranks the
signal goes to the last one alone."""

import json
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from rpc_run import LAUNCH, PROGRAM, RANKS, RpcTestCase, errors, files, processes_below, ranks_below

GMSH = pathlib.Path(PROGRAM).parent / "packages" / "mesh" / "rpc_gmsh"
SIGNALS = [signal.SIGINT, signal.SIGTERM]
NOT_CONVERGED = 4
RESULTS = ["out/beam.json"]  # an iterate is no result
LARGE = "--set=Mesh->Cells={1280,256}"  # seconds are left when the signal comes, on a busy machine too
FACTORED = ["--set=Mesh->Cells={20,20,10}", "--set=Mesh->Upper={1,1,0.15}", "--set=Material->Poisson's Ratio=0.4999",
            "--set=Material->Dilatation=full"]  # some ten seconds
NO_MULTIGRID = ["--set=Linear Solver->MueLu->max levels=1", "--set=Linear Solver->MueLu->coarse: type=RELAXATION",
                "--set=Linear Solver->Maximum Iterations=100000"]

FINE = """SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1}; MeshSize {:} = 0.01;  // gmsh takes minutes
Physical Volume("body") = {1}; Physical Surface("bottom") = {5}; Physical Surface("top") = {6};
"""
DECK_OF_FINE = """fine:
  Mesh: {Type: gmsh, File: fine.geo}
  Material: {Young's Modulus: 1.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: 0.0, Z: -0.01}}
  Contact: {Side: bottom}
"""


def told(number):
    """The name of a signal, and of Open MPI's mpirun what it makes of another one."""
    return number.name + (" (mpirun sends it for Ctrl-C, too)" if number == signal.SIGTERM and LAUNCH else "")


def catches(pid, number):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    mask = next(line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(mask, 16) >> (number - 1) & 1)


def num_threads(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("Threads:")))


@unittest.skipUnless(pathlib.Path(f"/proc/self/task/{os.getpid()}/children").exists(), "needs Linux' /proc")
class Interrupt(RpcTestCase):
    def start(self, *arguments, deck="beam.xml", **options):
        process = subprocess.Popen(LAUNCH + [PROGRAM, f"--input={deck}", "--output=out", *arguments], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL, **options,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.addCleanup(process.kill)
        return process

    def wait_for(self, process, condition):
        while process.poll() is None:
            try:
                found = condition()
            except (FileNotFoundError, ProcessLookupError):  # a process that has just ended
                found = False
            if found:
                return
            time.sleep(0.001)
        self.fail(f"ended before its time\n{process.communicate()}")

    def last_rank(self, process):
        """The last rank, as soon as all of them catch signals."""
        def ready():
            ranks = ranks_below(process.pid)
            return len(ranks) == RANKS and all(catches(rank, n) for rank in ranks for n in SIGNALS)
        self.wait_for(process, ready)
        return max(ranks_below(process.pid))

    def read_to(self, process, line):
        """Reads the log to the line that begins so."""
        for text in process.stdout:
            if text.startswith(line):
                break

    def end(self, process, code):
        out, err = process.communicate(timeout=600)
        self.assertEqual(process.returncode, code, f"{out}\n{err}")
        return subprocess.CompletedProcess(process.args, code, out, err)

    def test_before_there_is_anything_to_write_leaves_nothing(self):
        for number in SIGNALS:
            with self.subTest(number.name):
                process = self.start(LARGE)
                os.kill(self.last_rank(process), number)
                result = self.end(process, NOT_CONVERGED)
                self.expect_refusal(result, NOT_CONVERGED, [f"interrupted by {told(number)} before", "no results are written"])
                self.assertEqual(files(self.folder), [])

    @unittest.skipIf(RANKS == 1, "needs mpirun")
    def test_ctrl_c_at_mpirun_is_not_told_as_another_signal_alone(self):
        process = self.start(LARGE)
        self.last_rank(process)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=600)
        for told_of in re.findall("interrupted by .*", out + err):
            self.assertRegex(told_of, r"interrupted by (SIGINT|SIGTERM \(mpirun sends it for Ctrl-C, too\)) ")

    def expect_results(self, process, number):
        result = self.end(process, NOT_CONVERGED)
        self.assertEqual(errors(result), [])
        self.assertIn(f"NOT CONVERGED: interrupted by {told(number)} in Uzawa iteration 1", result.stdout)
        self.assertEqual(files(self.folder), RESULTS)
        summary = json.loads((self.folder / "out" / "beam.json").read_text())
        self.assertFalse(summary["converged"])
        self.assertEqual(summary["reason"], f"interrupted by {told(number)} in Uzawa iteration 1")
        return summary

    def interrupt_solve(self, number, line, *arguments):
        process = self.start(LARGE, *arguments)
        rank = self.last_rank(process)
        self.read_to(process, line)
        os.kill(rank, number)
        return self.expect_results(process, number)

    def test_in_the_active_set_iteration_results_are_written(self):
        for number in SIGNALS:
            with self.subTest(number.name):
                summary = self.interrupt_solve(number, "    1      1")
                self.assertGreater(summary["newton_iterations"][0], 0)
                self.assertIsNone(summary["max_penetration"])
                self.assertIsInstance(summary["equilibrium_residual"], float)

    def test_in_newton_results_are_written(self):
        self.interrupt_solve(signal.SIGTERM, "    1      1", "--set=NOX->Direction->Method=Sweep")

    def test_within_a_long_linear_solve_results_are_written(self):
        summary = self.interrupt_solve(signal.SIGTERM, "uzawa newton", *NO_MULTIGRID)
        self.assertEqual(summary["newton_iterations"], [0])

    @unittest.skipUnless(os.environ.get("RPC_MUMPS") == "ON", "needs MUMPS, whose factor has a thread of its own")
    @unittest.skipIf(RANKS > 1, "needs one rank: on several, an MPI that allows calls from several threads")
    def test_within_a_factor_the_run_ends_within_seconds(self):
        for number in SIGNALS:
            with self.subTest(number.name):
                process = self.start(*FACTORED, "--set=Output->Exodus=false", deck="block.xml")
                rank = self.last_rank(process)
                self.read_to(process, "    1      0")  # MPI's threads, and the prediction, are there before
                threads = num_threads(rank)
                self.wait_for(process, lambda: num_threads(rank) > threads)
                time.sleep(0.5)
                self.assertGreater(num_threads(rank), threads, "the factor takes seconds: else this tells nothing")
                os.kill(rank, number)
                sent = time.monotonic()
                result = self.end(process, NOT_CONVERGED)
                self.assertLess(time.monotonic() - sent, 5)
                self.assertEqual(errors(result), [])
                self.assertIn(f"NOT CONVERGED: interrupted by {told(number)} in Uzawa iteration 1", result.stdout)
                self.assertEqual(files(self.folder), ["out/block.json"])
                summary = json.loads((self.folder / "out" / "block.json").read_text())
                self.assertIn("sparse factor", summary["solver_path"])

    @unittest.skipUnless(os.environ.get("RPC_GMSH") == "ON", "needs gmsh")
    def test_while_gmsh_makes_a_mesh_the_run_and_gmsh_end_within_seconds(self):
        (self.folder / "fine.geo").write_text(FINE)
        (self.folder / "fine.yaml").write_text(DECK_OF_FINE)
        written = files(self.folder)
        for number in SIGNALS:
            for to_all in (False, True) if RANKS == 1 else (False,):  # Ctrl-C at a console, and batch systems, reach gmsh too; mpirun has an exit code of its own
                with self.subTest(number.name, to_all=to_all):
                    process = self.start(deck="fine.yaml", start_new_session=True)
                    rank = self.last_rank(process)
                    gmsh = []

                    def meshes():
                        gmsh[:] = processes_below(process.pid, GMSH)
                        return len(gmsh) == 2  # the program, and its child with this mesh
                    self.wait_for(process, meshes)
                    time.sleep(0.2)
                    (os.killpg if to_all else os.kill)(rank, number)
                    sent = time.monotonic()
                    result = self.end(process, NOT_CONVERGED)
                    self.assertLess(time.monotonic() - sent, 5)
                    self.expect_refusal(result, NOT_CONVERGED, [f"interrupted by {told(number)} while gmsh made a mesh; no results are written"])
                    self.assertEqual(files(self.folder), written)
                    left = [pid for pid in gmsh if pathlib.Path(f"/proc/{pid}/exe").exists()]
                    self.assertEqual(left, [])

    def test_while_results_are_written_lets_them_be_finished(self):
        process = self.start("--set=Mesh->Cells={160,32}")
        rank = self.last_rank(process)
        self.wait_for(process, lambda: list(self.folder.glob("out/beam.*.tmp.*")))
        os.kill(rank, signal.SIGTERM)
        self.end(process, 0)
        self.assertEqual(files(self.folder), [f"out/beam.{end}" for end in ("contact.csv", "e", "json")])
        self.assertTrue(json.loads((self.folder / "out" / "beam.json").read_text())["converged"])

    @unittest.skipIf(RANKS > 1, "needs one rank: mpiexec has an exit code of its own")
    def test_second_signal_ends_the_run_at_once(self):
        process = self.start(LARGE, *NO_MULTIGRID)
        rank = self.last_rank(process)
        for number in SIGNALS:
            os.kill(rank, number)
        process.communicate(timeout=600)
        self.assertIn(-process.returncode, SIGNALS)


if __name__ == "__main__":
    unittest.main()

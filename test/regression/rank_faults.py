# SPDX-License-Identifier: BSD-3-Clause
"""What happens to one of several ranks ends all of them: soon, with one message and an exit code."""

import os
import resource
import signal
import subprocess
import time
import unittest
from pathlib import Path

from rpc_run import LAUNCH, PROGRAM, RANKS, RpcTestCase, errors, files, ranks_below

SCENE = ["--set=Mesh->Cells={640,128}"]  # takes seconds
LARGE = ["--set=Mesh->Cells={1280,256}"]  # with algebraic multigrid hundreds of megabytes
SOON = 30  # [s]
INTERNAL_ERROR, BAD_INPUT = 1, 2


class RankFaults(RpcTestCase):
    def begun(self, *arguments, scene=SCENE):
        """A run that has come to its first Newton step, and its ranks' processes."""
        process = subprocess.Popen([*LAUNCH, PROGRAM, "--input=beam.xml", "--output=out", *scene, *arguments], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        for line in process.stdout:
            if line.startswith("uzawa newton"):
                break
        ranks = ranks_below(process.pid)
        self.assertEqual(len(ranks), RANKS)
        return process, ranks

    def ended(self, process, limit):
        out, err = process.communicate(timeout=limit)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def test_a_killed_rank_ends_the_run(self):
        for which in (0, -1):
            with self.subTest(which):
                process, ranks = self.begun()
                os.kill(ranks[which], signal.SIGKILL)
                result = self.ended(process, SOON)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn("signal 9", result.stderr)  # the launcher's message
                self.assertEqual([name for name in files(self.folder) if name.endswith(".json")], [])

    def test_a_disk_that_is_full_on_one_rank(self):
        process, ranks = self.begun("--set=Output->Exodus=split")
        resource.prlimit(ranks[-1], resource.RLIMIT_FSIZE, (200_000, 200_000))
        result = self.ended(process, 10 * SOON)
        self.assertEqual(result.returncode, INTERNAL_ERROR, result.stderr)
        self.assertEqual(len(errors(result)), 1, result.stderr)
        for part in ("rpc: error: output: ", f'"out/beam.e.{RANKS}.', "File too large"):
            self.assertIn(part, errors(result)[0])
        self.assertEqual(files(self.folder), [])

    def test_a_rank_that_runs_out_of_memory(self):
        process, ranks = self.begun("--set=Linear Solver->Multigrid=algebraic", "--set=Output->Exodus=none", scene=LARGE)
        pages = int(Path(f"/proc/{ranks[-1]}/statm").read_text().split()[0])  # of addresses that are in use
        most = pages * resource.getpagesize() + 32 * 2**20  # MPI's own small allocations must not be the first to fail: it does not look
        resource.prlimit(ranks[-1], resource.RLIMIT_AS, (most, most))
        result = self.ended(process, SOON)
        self.assertEqual(result.returncode, INTERNAL_ERROR, result.stderr)
        self.assertEqual(len(errors(result)), 1, result.stderr)
        self.assertIn("out of memory", errors(result)[0])
        self.assertEqual([name for name in files(self.folder) if name.endswith(".json")], [])

    def test_a_rank_that_cannot_start(self):
        # Not by two programs with their options on one line, at which mpirun of Open MPI 5.0.7 breaks down.
        last_alone = f'test "${{OMPI_COMM_WORLD_RANK:-$PMI_RANK}}" = {RANKS - 1} && set -- "$@" --kokkos-threads=none; exec "$@"'
        command = [*LAUNCH, "sh", "-c", last_alone, "sh", PROGRAM, "--input=beam.xml", "--output=out"]
        start = time.monotonic()
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=10 * SOON, stdin=subprocess.DEVNULL, check=False)
        self.assertLess(time.monotonic() - start, SOON)
        self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
        self.assertEqual(len(errors(result)), 1, result.stderr)
        self.assertIn("Kokkos refuses its options --kokkos-threads=none", errors(result)[0])
        self.assertIn(f"This happened on rank {RANKS - 1} of {RANKS}, host ", errors(result)[0])


if __name__ == "__main__":
    unittest.main()

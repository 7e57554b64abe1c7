# SPDX-License-Identifier: BSD-3-Clause
"""The benchmarks of rough surfaces run, the comparison with other programs also where these are missing."""
import os
import shutil
import subprocess
import sys
import unittest

from rpc_run import PROGRAM, SOURCE, RpcTestCase

try:
    import numpy
except ImportError:
    numpy = None
FOLDER = SOURCE / "test" / "benchmark"
MPIEXEC = os.environ.get("RPC_MPIEXEC", shutil.which("mpiexec"))  # empty of a program without MPI


class RoughBenchmarks(RpcTestCase):
    def start(self, *words):
        return subprocess.run([str(word) for word in words], cwd=self.folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)

    def test_the_large_layer_runs_on_a_small_mesh(self):
        done = self.start("bash", FOLDER / "rough_layer.sh", os.path.abspath(PROGRAM), "16,16,4", self.folder / "layer")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("3840 dofs, 256 contact nodes"), 2, done.stdout)
        self.assertEqual(done.stdout.count("  patches  "), 2, done.stdout)
        self.assertNotIn("NOT CONV", done.stdout)

    @unittest.skipUnless(MPIEXEC, "there is no MPI")
    def test_the_large_layer_runs_on_two_ranks(self):
        areas = []
        for ranks in ("1", "2"):
            os.environ["MPIEXEC"] = f"{sys.executable} -B {self.folder / 'launch.py'}"  # notes how it is called
            (self.folder / "launch.py").write_text(f"import os, sys\nprint('rough_layer: launched as', *sys.argv[1:3], flush=True)\nos.execvp({MPIEXEC!r}, [{MPIEXEC!r}, *sys.argv[1:]])\n")
            self.addCleanup(os.environ.pop, "MPIEXEC", None)
            done = self.start("bash", FOLDER / "rough_layer.sh", f"--ranks={ranks}", os.path.abspath(PROGRAM), "8,8,4", self.folder / "layer")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertEqual(done.stdout.count(f"launched as -n {ranks}"), 2, done.stdout)
            areas.append([line for line in done.stdout.splitlines() if "in contact" in line])
        self.assertEqual(areas[0], areas[1])

    @unittest.skipUnless(numpy, "python3 has no NumPy")
    def test_the_comparison_leaves_out_what_is_missing(self):
        (self.folder / "tamaas.py").write_text("raise ImportError\n")
        (self.folder / "ContactMechanics.py").write_text("raise ImportError\n")
        os.environ["PYTHONPATH"] = str(self.folder)
        self.addCleanup(os.environ.pop, "PYTHONPATH")
        done = self.start(sys.executable, "-B", FOLDER / "rough_peers.py", f"--rpc={PROGRAM}", "--grids=16,32", "--reference=32", "--highest=4")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for peer in ("tamaas", "ContactMechanics"):
            self.assertIn(f"{peer} is missing and left out: pip install {peer}", done.stderr)
        self.assertEqual(done.stdout.count("| layer | inf | rpc | "), 4, done.stdout)
        self.assertIn("| layer | 0.3 | rpc | extrapolated | ", done.stdout)


if __name__ == "__main__":
    unittest.main()

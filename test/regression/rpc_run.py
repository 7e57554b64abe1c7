# SPDX-License-Identifier: BSD-3-Clause
"""Starts rpc as a user would, each run in a folder of its own. What to start comes from the environment, set by CTest."""

import concurrent.futures
import contextlib
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("RPC_PROGRAM", "rpc")
SOURCE = pathlib.Path(os.environ.get("RPC_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
RANKS = int(os.environ.get("RPC_RANKS", "1"))
LAUNCH = [word for word in os.environ.get("RPC_LAUNCH", "").split("|") if word]
BEAM = SOURCE / "input" / "beam.xml"
SMALL = "--set=Mesh->Cells={20,4}"

# What no user should get to see, whatever is wrong.
NOISE = ["Teuchos::", ".cpp", ".hpp", "Throw number", "Throw test", "Traceback", "terminate called", "what():", "Signal:",
         "ANONYMOUS", "internal error"]


def run(arguments, cwd, environment=None):
    with tempfile.TemporaryDirectory(prefix="rpc_mpi_") as session:  # Open MPI's own: those of two runs that start or end at once collide
        return subprocess.run(LAUNCH + [PROGRAM] + [str(a) for a in arguments], cwd=cwd, capture_output=True, text=True,
                              errors="replace", timeout=600, stdin=subprocess.DEVNULL,
                              env={**os.environ, "OMPI_MCA_orte_tmpdir_base": session, "PRTE_MCA_prte_tmpdir_base": session,
                                   **(environment or {})})


def run_all(jobs):
    """Runs (arguments, cwd) pairs, two at a time; most of a short run is the loading of its libraries."""
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        return list(pool.map(lambda job: run(*job), jobs))


def processes_below(pid, program):
    """Processes of a program from a launcher down, itself included; those that end meanwhile are left out."""
    found, waiting = [], [pid]
    while waiting:
        one = waiting.pop()
        with contextlib.suppress(OSError):
            if os.path.realpath(f"/proc/{one}/exe") == os.path.realpath(program):
                found.append(one)
            for thread in pathlib.Path(f"/proc/{one}/task").iterdir():  # a launcher may start ranks from any
                waiting += map(int, (thread / "children").read_text().split())
    return sorted(found)


def ranks_below(pid):
    """Processes of the program below a launcher, or the process itself."""
    return processes_below(pid, PROGRAM) if LAUNCH else [pid]


def errors(result):
    return [line for line in result.stderr.splitlines() if line.startswith("rpc: ")]


def files(folder):
    """All the files below a folder, hidden ones too."""
    return sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*") if path.is_file())


class RpcTestCase(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="rpc_test_")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def rpc(self, *arguments, code=0, **options):
        result = run(arguments, self.folder, **options)
        if code is not None:
            self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def start(self, *arguments):
        """A run that goes on by itself."""
        process = subprocess.Popen(LAUNCH + [PROGRAM] + [str(a) for a in arguments], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        return process

    def solve(self, *arguments, deck="beam.xml", output="out", code=0):
        """A run of the small beam: its summary."""
        result = self.rpc(f"--input={deck}", SMALL, f"--output={output}", *arguments, code=code)
        self.assertEqual(errors(result), [])
        return json.loads((self.folder / output / f"{pathlib.Path(deck).stem}.json").read_text())

    def expect_refusal(self, result, code, parts):
        """One message with all the parts, and nothing that only a developer understands."""
        text = f"{result.args}\n{result.stdout}\n{result.stderr}"
        self.assertEqual(result.returncode, code, text)
        self.assertEqual(len(errors(result)), 1, text)
        self.assertTrue(errors(result)[0].startswith("rpc: error: "), text)
        for part in parts:
            self.assertIn(part, errors(result)[0])
        for noise in NOISE:
            self.assertNotIn(noise, result.stdout + result.stderr)
        if RANKS == 1:  # mpiexec has words of its own
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, text)


class WrittenDeckTestCase(RpcTestCase):
    """Tests that write their decks as YAML text; each run has a name, its output a folder of that name."""

    def solve(self, name, text, *arguments, code=0):
        """The summary of a run, or the finished process where it is to end with another exit code than 0."""
        path = self.folder / f"{name}.yaml"
        path.write_text(text)
        result = self.rpc(f"--input={path}", f"--output={name}", *arguments, code=code)
        return result if code else json.loads((self.folder / name / f"{name}.json").read_text())

    def history(self, name):
        return list(csv.DictReader((self.folder / name / f"{name}.history.csv").read_text().splitlines()))

    def columns(self, name, *begin):
        """The numbers of the first column of the history whose name begins so, for each beginning."""
        rows = self.history(name)
        return [[float(next(v for k, v in row.items() if k.startswith(each))) for row in rows] for each in begin]

    def refuse(self, text, code, words):
        self.expect_refusal(self.solve("refused", text, code=code), code, words)

    def expect_restart_with_the_same_digits(self, text):
        """A deck with times 0.5 to 2 against a run that stops at 1 and goes on; the rows of the history."""
        every = "--set=Steps->Checkpoint Every=2"
        self.solve("whole", text, every)
        self.solve("parts", text, "--set=Steps->Times={0.5, 1}", every)
        self.solve("parts", text, every, "--restart")
        whole, parts = ([{k: v for k, v in row.items() if k != "seconds"} for row in self.history(name)] for name in ("whole", "parts"))
        self.assertEqual(parts, whole)
        return whole

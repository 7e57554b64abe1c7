# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program on a row, as it is and in other ways, and collects what is wrong."""
import dataclasses
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import tempfile
import time

import comparisons
import decks
import oracle
import reasons
import scene as scenes
from outputs import Run

TIME_LIMIT = 120  # of one run, of processor time of each rank, whatever else the machine does [s]
GIVEN_UP = 900  # [s] of a run that waits: half of what the array may take, so that its row is named
OUT_OF_TIME = (-signal.SIGXCPU, 128 + signal.SIGXCPU)  # a process by itself, and in mpiexec
FINER_DOFS = 8  # a finer mesh may have so many times the unknowns
TO_REST = {"one", "unload", "slide"}  # histories that are also run with a finer mesh where meshes adapt
FIXED = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
         "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMP_PROC_BIND": "false",
         "OMP_WAIT_POLICY": "passive"}


@dataclasses.dataclass
class Outcome:
    number: int
    row: dict
    folder: pathlib.Path
    seconds: float = 0.0
    runs: int = 0
    complaints: list = dataclasses.field(default_factory=list)


def end_session(leader):
    """Kills all processes of a session: mpiexec gives each rank a process group of its own, and ranks that wait for each other outlive it."""
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and os.getsid(int(entry.name)) == leader:
                os.kill(int(entry.name), signal.SIGKILL)
        except (ProcessLookupError, PermissionError):
            pass  # it has ended, or is not ours


class Program:
    """@param options  program, openmp, one_rank, mpiexec, preload"""

    def __init__(self, options):
        self.options = options

    def run(self, folder, ranks=1, threads=1, *arguments):
        """Runs the deck of a folder."""
        program = self.options.openmp if threads > 1 else self.options.program
        command = [program, "--input=scene.xml", *arguments]
        environment = {**os.environ, **FIXED, "OMP_NUM_THREADS": str(threads)}
        with tempfile.TemporaryDirectory(prefix="pairs") as session:  # of Open MPI's: two runs that share one disturb each other
            if ranks > 1:
                environment["OMPI_MCA_mpi_yield_when_idle"] = "1"  # one rank waits for nobody: on a busy machine it would not get its share
                command = [*shlex.split(self.options.mpiexec), "-n", str(ranks), *command]
                environment.update({name + "_tmpdir_base": session for name in ("OMPI_MCA_orte", "PRTE_MCA_prte")})
                if self.options.preload:
                    environment["LD_PRELOAD"] = self.options.preload
            command = ["bash", "-c", f'ulimit -St {TIME_LIMIT}; exec "$@"', "-", *command]
            start = time.monotonic()
            with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  errors="replace", start_new_session=True, env=environment) as process:
                try:
                    stdout, stderr = process.communicate(timeout=GIVEN_UP)
                    code = process.returncode
                except subprocess.TimeoutExpired:
                    end_session(process.pid)
                    code, stdout, stderr = None, "", f"rpc: still running after {GIVEN_UP} s"
        if code in OUT_OF_TIME:
            code, stderr = None, f"rpc: still running after {TIME_LIMIT} s of processor time"
        (folder / "stdout.txt").write_text(stdout)
        (folder / "stderr.txt").write_text(stderr)
        return Run(folder, code, stdout, stderr, time.monotonic() - start)


def write(scene, folder):
    """The deck and its mesh file into a new folder."""
    folder.mkdir(parents=True)
    mesh_file = None
    if scene.file:
        mesh_file = "scene.geo" if "Order" in scene.mesh else "scene.msh"
        (folder / mesh_file).write_text(scene.file(scene.units[0]))
    (folder / "scene.xml").write_text(scenes.deck(scene, mesh_file))


def judge(options, seed, number, row):
    """The outcome of a row; its folder stays if something is wrong."""
    case = decks.make(seed, number, row)
    outcome = Outcome(number, row, pathlib.Path(options.keep) / f"seed{seed}" / case.name)
    shutil.rmtree(outcome.folder, ignore_errors=True)
    start = time.monotonic()
    try:
        outcome.complaints += Judge(Program(options), case, outcome).all()
    except Exception as error:  # the oracle's own, or a file that cannot be read: a failure of the row
        outcome.complaints.append(f"the oracle ends with {type(error).__name__}: {error}")
    outcome.seconds = time.monotonic() - start
    if not outcome.complaints and not options.keep_all:
        shutil.rmtree(outcome.folder, ignore_errors=True)
    return outcome


class Judge:
    """One row: the run itself, then those that it is compared with."""

    def __init__(self, program, case, outcome):
        self.program, self.case, self.outcome = program, case, outcome

    def go(self, name, scene, ranks=None, threads=None, *arguments):
        folder = self.outcome.folder / name if name else self.outcome.folder
        if not folder.exists():
            write(scene, folder)
        self.outcome.runs += 1
        return self.program.run(folder, ranks or self.case.ranks, threads or self.case.threads, *arguments)

    def all(self):
        case = self.case
        run = self.go("", case.scene)
        refusal = reasons.confirmed(case, run)
        if refusal:
            return [refusal]
        if run.summary is None or run.mesh is None:
            return [] if run.code != 0 else ["exit 0, but files are missing"]
        judge = oracle.Oracle(case, run)
        rests = judge.rests()
        found = judge.judge() if run.summary["converged"] else []
        found += comparisons.promises(case, run, rests[1])
        found += comparisons.same(run, self.reference(), "on other ranks, by the default solver", rests)
        if case.row["history"] == "restart":
            found += self.restarted(run, rests)
        return found + self.finer(run)

    def reference(self):
        """By the program's own choice of solver on one rank, or on two if the row is that and the program has MPI."""
        row = self.case.row
        plain = row["solver"] == "factor" and self.case.ranks == 1 and self.case.threads == 1 and not self.program.options.one_rank
        more = {name: entries for name, entries in self.case.scene.more.items() if name != "Linear Solver"}
        return self.go("reference", dataclasses.replace(self.case.scene, more=more), 2 if plain else 1, 1)

    def restarted(self, run, rests):
        """After the first steps alone, with the deck of all. That bits are the same, kills.py of test/stress checks."""
        scene = self.case.scene
        first = self.go("restarted", dataclasses.replace(scene, times=scene.times[:decks.CHECKPOINT_AFTER]))
        if first.code != 0:
            return [f"the first steps: exit {first.code}: {first.reason()[:200]}"] if run.code == 0 else []
        (self.outcome.folder / "restarted" / "scene.xml").write_text((self.outcome.folder / "scene.xml").read_text())
        return comparisons.same(run, self.go("restarted", scene, None, None, "--restart"), "restarted", rests)

    def finer(self, run):
        scene, row = self.case.scene, self.case.row
        if self.case.target:
            if row["history"] not in TO_REST or (row["history"] != "one" and scene.dim == 3) or not run.summary["adaptation"].get("errors"):
                return []
            adapt = {**scene.more["Adapt"], "Target Relative Error": self.case.target / 2 ** decks.ORDER[row["element"]],
                     "Max Dofs": FINER_DOFS * scene.more["Adapt"]["Max Dofs"]}
            times = scene.times and [t for t in scene.times if t <= run.summary["time"]]  # to where this one has come
            finer = self.go("finer", dataclasses.replace(scene, times=times, more={**scene.more, "Adapt": adapt}), 1, 1)
            return comparisons.bars(run, finer) + (comparisons.estimate(run, finer) if row["history"] == "one" else [])
        if row["history"] != "one" or (row["mesh"] == "geo" and self.case.shape.radius != float("inf") and decks.ORDER[row["element"]] == 1):
            return []  # or the finer mesh is of another shape
        mesh = {**scene.mesh, "Refinements": 1} if scene.file else {**scene.mesh, "Cells": tuple(2 * n for n in scene.mesh["Cells"])}
        return comparisons.estimate(run, self.go("finer", dataclasses.replace(scene, mesh=mesh), 1, 1))

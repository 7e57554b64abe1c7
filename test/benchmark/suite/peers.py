# SPDX-License-Identifier: BSD-3-Clause
"""The same problem by what a user might take instead, in the same run."""
import glob
import itertools
import json
import os
import subprocess
import statistics
import sys
import typing

from .program import Failure, can_import, execute, find_python
from .table import Table, skipped

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "peers")
ENERGY_TOLERANCE = 4e-7  # of J, between peer and rpc: the same discrete problem
TIMEOUT = 600  # [s]


class Peer(typing.NamedTuple):
    """finest: by scene the last mesh, 1/h, that it runs on; no limit where the scene is not named."""

    name: str
    modules: tuple
    command: tuple
    rigid: bool = False  # takes no foundation but a rigid one
    direct: bool = True
    threads: bool = True  # its libraries have some
    finest: dict = {}


SKFEM, PETSC = ("skfem",), ("skfem", "petsc4py")
PEERS = (Peer("scikit-fem, SuperLU", SKFEM, ("skfem_superlu.py", "{scene}", "{n}", "{xi}"), threads=False, finest={"block": 4}),
         Peer("scikit-fem, PETSc MUMPS", PETSC, ("skfem_petsc.py", "{scene}", "{n}", "{xi}", "mumps"), finest={"block": 12}),
         Peer("scikit-fem, PETSc hypre", PETSC, ("skfem_petsc.py", "{scene}", "{n}", "{xi}", "hypre"), direct=False, threads=False),
         Peer("scikit-fem, PETSc GAMG", PETSC, ("skfem_petsc.py", "{scene}", "{n}", "{xi}", "gamg"), direct=False, threads=False),
         Peer("scikit-fem, MUMPS Schur complement", PETSC, ("skfem_schur.py", "{scene}", "{n}", "{xi}"),
              finest={"block": 12}),
         Peer("GetFEM, MUMPS", ("getfem",), ("getfem_contact.py", "{scene}", "{n}"), rigid=True, finest={"block": 12}))


class Scene(typing.NamedTuple):
    """What the peers are compared on. xi [Pa]: of the peers that can; least: what the criteria ask of peer's time over rpc's on one
    rank."""

    title: str
    xi: str
    unit: str  # of J
    run: typing.Callable  # (bench, n, xi, ranks) -> result
    least: tuple  # (of whom, Peer -> whether it is one of them, ratio)


def run_beam(bench, n, xi, ranks):
    return bench.program.beam(n, xi, ranks, fresh=True)


def run_block(bench, n, xi, ranks):
    """xi [Pa]: in the middle, half as much more at the right end."""
    return bench.program.run("block.xml", ranks, fresh=True, **{
        "Mesh->Cells": "{%d, %d, %d}" % (2 * n, 2 * n, n), "Mesh->Element": "Q1", "Contact->Yield Stress": "%s*(1 + x/2)" % xi
        if xi != "inf" else xi})


SCENES = {"beam": Scene("Peers: the beam, Q1", "16", "J/m", run_beam,
                        (("of multigrid", lambda peer: not peer.direct, 15.0), ("of direct ways", lambda peer: peer.direct, 5.0))),
          "block": Scene("Peers in space: the block, Q1", "18", "J", run_block, (("", lambda peer: True, 10.0),))}


class Python:
    """The interpreter for the peers: Debian's modules are those of its own Python, scikit-fem comes from PyPI."""

    def __init__(self, output):
        self.environment, self.reasons, self.results = {}, {}, {}
        petsc = sorted(glob.glob("/usr/lib/petscdir/*/*-real/lib/python3/dist-packages/petsc4py"))
        if "PETSC_DIR" not in os.environ and petsc:  # Debian's petsc4py finds itself through it
            self.environment["PETSC_DIR"] = petsc[-1].split("/lib/python3")[0]
        fast_blas = glob.glob("/usr/lib/*/openblas-pthread")
        if fast_blas:  # whichever BLAS is the system's default
            self.environment["LD_LIBRARY_PATH"] = ":".join([fast_blas[0]] + os.environ.get("LD_LIBRARY_PATH", "").split(":"))
        self.blas = "OpenBLAS" if fast_blas else "the default BLAS"
        self.base = find_python("petsc4py.PETSc", self.environment) or find_python("getfem") or sys.executable
        self.path = self.base
        if not self.has("skfem"):
            self._make_venv(os.path.join(output, "venv"))

    def _make_venv(self, folder):
        python = os.path.join(folder, "bin/python")
        for step in ([self.base, "-m", "venv", "--system-site-packages", folder],
                     [python, "-m", "pip", "install", "--quiet", "--retries=1", "--timeout=15", "scikit-fem"]):
            run = subprocess.run(step, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if run.returncode != 0:
                lines = run.stdout.strip().splitlines() or ["exit code %d" % run.returncode]
                self.reasons["skfem"] = "scikit-fem cannot be installed: " + lines[-1]
                return
        self.path = python

    def has(self, module):
        found = can_import(self.path, "petsc4py.PETSc" if module == "petsc4py" else module, self.environment)
        if not found:
            self.reasons.setdefault(module, "%s cannot import %s" % (self.base, module))
        return found

    def lacks(self, modules):
        """Why the first of the modules that is missing is missing; None if all are there."""
        return next((self.reasons[module] for module in modules if not self.has(module)), None)

    def run(self, command, scene, n, xi, threads, fresh=False):
        """Equal runs once, unless fresh. A result is what the script reports, with `process` and `cpu` [s]."""
        key = (command, scene, n, xi, threads)
        if fresh or key not in self.results:
            arguments = [argument.format(scene=scene, n=n, xi=xi) for argument in command[1:]]
            self.results[key] = self._run(command[0], arguments, threads)
        return self.results[key]

    def _run(self, script, arguments, threads):
        print("  %s, %d thread(s)" % (" ".join([script, *arguments]), threads), file=sys.stderr, flush=True)
        environment = {**self.environment, "OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": str(threads)}
        run = execute([self.path, os.path.join(HERE, script), *arguments], environment=environment, timeout=TIMEOUT)
        return {**json.loads(run.output.splitlines()[-1]), "process": run.seconds, "cpu": run.cpu_seconds, "gib": run.gib}


def compare(bench, scene, peer, n, xi, threads, repeats):
    """A peer in turns with rpc: its last result with medians of its time (process), of its time over rpc's on 1 and 2 ranks
    (over 1, over 2) and of its CPU time over that of 1 rank (cpu), and the relative difference of J."""
    runs = []
    for _ in range(repeats):
        ours = [SCENES[scene].run(bench, n, xi, ranks) for ranks in (1, 2)]
        runs.append((bench.python.run(peer.command, scene, n, xi, threads, fresh=True), *ours))
    theirs, ours, _ = runs[-1]
    return {**theirs, "threads": threads, "difference": theirs["J"] / ours["energy_J"] - 1,
            "process": statistics.median(theirs["process"] for theirs, _, _ in runs),
            "over 1": statistics.median(theirs["process"] / one["process"] for theirs, one, _ in runs),
            "over 2": statistics.median(theirs["process"] / two["process"] for theirs, _, two in runs),
            "cpu": statistics.median(theirs["cpu"] / one["cpu"] for theirs, one, _ in runs)}


def wrapped(steps):
    """Counts of a list, shortened: 5 3 1 1 1 -> 5 3 1x3."""
    groups = [(value, len(list(equal))) for value, equal in itertools.groupby(steps)]
    return " ".join(str(value) if count == 1 else "%dx%d" % (value, count) for value, count in groups)


def judge(table, scene, n, ratios):
    """Adds a row for each criterion; ratios: (over 1 rank, peer)."""
    for whom, belongs, least in SCENES[scene].least:
        of_them = [(ratio, peer.name) for ratio, peer in ratios if belongs(peer)]
        if of_them:
            ratio, name = min(of_them)
            table.add("best %s: %s" % (whom, name) if whom else "best: " + name, n, "", SCENES[scene].xi, *[""] * 5, "%.2f" % ratio,
                      "", "", table.check(ratio >= least))


def comparison(bench, scene, sizes):
    meshes, repeats, judged = sizes
    title, xi, unit, _, criteria = SCENES[scene]
    python = bench.python
    cores = len(os.sched_getaffinity(0))
    table = Table(title,
                  "Whole processes, taken in turns with rpc's on 1 and 2 ranks (the latter with mpirun's start); medians of %d. "
                  "The same discrete problem: J within %g of rpc's, relative. Newton: steps for each set of multipliers. Peers "
                  "with threads run with 1 and with %d of them, the faster one is shown. CPU: its CPU time over rpc's on 1 rank. "
                  "By %s with %s. %s"
                  % (repeats, ENERGY_TOLERANCE, cores, python.base, python.blas,
                     "Criteria: at 1/h = %d, xi = %s Pa %s rpc's time on 1 rank."
                     % (judged, xi, ", ".join("the best %stakes at least %g x" % (whom + " " * bool(whom), least)
                                              for whom, _, least in criteria))
                     if judged else "No criterion: the meshes are too small."),
                  ["peer", "1/h", "dofs", "xi [Pa]", "J [%s]" % unit, "Newton", "CG", "threads", "time [s]", "over 1 rank",
                   "over 2 ranks", "CPU", ""])
    missing = []
    for n in meshes:
        ratios = []
        for peer in PEERS:
            reason = python.lacks(peer.modules)
            if reason:
                missing.append("%s: %s" % (peer.name, reason))
                continue
            if n > peer.finest.get(scene, n):
                missing.append("%s at 1/h = %d: it takes too long" % (peer.name, n))
                continue
            law = "inf" if peer.rigid else xi
            try:
                best = min((compare(bench, scene, peer, n, law, threads, repeats)
                            for threads in ([1, cores] if peer.threads and cores > 1 else [1])), key=lambda run: run["over 1"])
            except Failure as failure:
                table.add(peer.name, n, "", law, *[""] * 8, str(failure).strip().splitlines()[-1])
                continue
            same = abs(best["difference"]) <= ENERGY_TOLERANCE
            table.add(peer.name, n, best["dofs"], law, "%.8f" % best["J"], wrapped(best["newton"]),
                      "" if peer.direct else sum(best["linear_iterations"]), best["threads"], "%.2f" % best["process"],
                      "%.2f" % best["over 1"], "%.2f" % best["over 2"], "%.2f" % best["cpu"], "" if same else table.check(False))
            if not peer.rigid:
                ratios.append((best["over 1"], peer))
        if n == judged:
            judge(table, scene, n, ratios)
    if len(table.rows) == 1:
        return skipped(title, "; ".join(dict.fromkeys(missing)))
    if missing:
        table.note += " Skipped: %s." % "; ".join(dict.fromkeys(missing))
    return table


def peers(bench):
    return comparison(bench, "beam", bench.sizes["peers"])


def peers_in_space(bench):
    return comparison(bench, "block", bench.sizes["peers in space"])

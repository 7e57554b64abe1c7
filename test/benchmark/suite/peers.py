"""The same problem by what a user might take instead, in the same run."""
import glob
import json
import os
import subprocess
import statistics
import sys

from .program import Failure, can_import, execute, find_python
from .table import Table, skipped

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "peers")
LEAST_RATIO = 15.0  # peer's time over rpc's on one rank
ENERGY_TOLERANCE = 1e-7  # [J/m] between peer and rpc: the same discrete problem
TIMEOUT = 600  # [s]
# name, modules, xi [Pa], command, whether its libraries have threads
PEERS = (("scikit-fem, SuperLU", ("skfem",), "16", ("skfem_superlu.py", "{n}", "{xi}"), False),
         ("scikit-fem, PETSc MUMPS", ("skfem", "petsc4py"), "16", ("skfem_petsc.py", "{n}", "{xi}", "mumps"), True),
         ("scikit-fem, PETSc hypre", ("skfem", "petsc4py"), "16", ("skfem_petsc.py", "{n}", "{xi}", "hypre"), False),
         ("scikit-fem, PETSc GAMG", ("skfem", "petsc4py"), "16", ("skfem_petsc.py", "{n}", "{xi}", "gamg"), False),
         ("scikit-fem, MUMPS Schur complement", ("skfem", "petsc4py"), "16", ("skfem_schur.py", "{n}", "{xi}"), True),
         ("GetFEM, MUMPS", ("getfem",), "inf", ("getfem_contact.py", "{n}"), True))


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

    def run(self, command, n, xi, threads, fresh=False):
        """Equal runs once, unless fresh. A result is what the script reports, with `process` and `cpu` [s]."""
        key = (command, n, xi, threads)
        if fresh or key not in self.results:
            self.results[key] = self._run(command[0], [argument.format(n=n, xi=xi) for argument in command[1:]], threads)
        return self.results[key]

    def _run(self, script, arguments, threads):
        print("  %s, %d thread(s)" % (" ".join([script, *arguments]), threads), file=sys.stderr, flush=True)
        environment = {**self.environment, "OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": str(threads)}
        run = execute([self.path, os.path.join(HERE, script), *arguments], environment=environment, timeout=TIMEOUT)
        return {**json.loads(run.output.splitlines()[-1]), "process": run.seconds, "cpu": run.cpu_seconds}


def compare(bench, python, n, xi, command, threads, repeats):
    """A peer in turns with rpc: its last result with medians of its time (process), of its time over rpc's on 1 and 2 ranks
    (over 1, over 2) and of its CPU time over that of 1 rank (cpu), and the difference of J."""
    runs = []
    for _ in range(repeats):
        ours = [bench.program.beam(n, xi, ranks, fresh=True) for ranks in (1, 2)]
        runs.append((python.run(command, n, xi, threads, fresh=True), *ours))
    peer, ours, _ = runs[-1]
    return {**peer, "threads": threads, "difference": peer["J"] - ours["energy_J"],
            "process": statistics.median(peer["process"] for peer, _, _ in runs),
            "over 1": statistics.median(peer["process"] / one["process"] for peer, one, _ in runs),
            "over 2": statistics.median(peer["process"] / two["process"] for peer, _, two in runs),
            "cpu": statistics.median(peer["cpu"] / one["cpu"] for peer, one, _ in runs)}


def peers(bench):
    meshes, repeats, judged = bench.sizes["peers"]
    title = "Peers: the beam, Q1"
    python = bench.python
    cores = len(os.sched_getaffinity(0))
    table = Table(title,
                  "Whole processes, taken in turns with rpc's on 1 and 2 ranks (the latter with mpirun's start); medians of %d. "
                  "The same discrete problem: J within %g J/m of rpc's. Peers with threads run with 1 and with %d of them, the "
                  "faster one is shown. CPU: its CPU time over rpc's on 1 rank. By %s with %s. %s"
                  % (repeats, ENERGY_TOLERANCE, cores, python.base, python.blas,
                     "Criterion: at 1/h = %d, xi = 16 Pa the best peer takes at least %g x rpc's time on 1 rank."
                     % (judged, LEAST_RATIO) if judged else "No criterion: the meshes are too small."),
                  ["peer", "1/h", "xi [Pa]", "J [J/m]", "Newton", "threads", "time [s]", "over 1 rank", "over 2 ranks", "CPU",
                   ""])
    missing = []
    for n in meshes:
        ratios = []
        for name, modules, xi, command, threaded in PEERS:
            reason = python.lacks(modules)
            if reason:
                missing.append("%s: %s" % (name, reason))
                continue
            try:
                best = min((compare(bench, python, n, xi, command, threads, repeats)
                            for threads in ([1, cores] if threaded and cores > 1 else [1])), key=lambda run: run["over 1"])
            except Failure as failure:
                table.add(name, n, xi, *[""] * 7, str(failure).strip().splitlines()[-1])
                continue
            same = abs(best["difference"]) <= ENERGY_TOLERANCE
            table.add(name, n, xi, "%.8f" % best["J"], " ".join(map(str, best["newton"])), best["threads"],
                      "%.2f" % best["process"], "%.2f" % best["over 1"], "%.2f" % best["over 2"], "%.2f" % best["cpu"],
                      "" if same else table.check(False))
            if xi == "16":
                ratios.append((best["over 1"], name))
        if n == judged and ratios:
            ratio, name = min(ratios)
            table.add("best: " + name, n, "16", *[""] * 4, "%.2f" % ratio, "", "", table.check(ratio >= LEAST_RATIO))
    if len(table.rows) == 1:
        return skipped(title, "; ".join(dict.fromkeys(missing)))
    if missing:
        table.note += " Skipped: %s." % "; ".join(dict.fromkeys(missing))
    return table

"""The paper's beam at full size: tables with pass or fail.

    python3 beam.py --rpc=build/rpc --output=build/benchmark [--only=a,c] [--quick] [--largest=128]

  a  Table 1: energy and Uzawa iterations for xi = 2 from 1/h = 8 to 512, peak memory
  b  Table 2: Uzawa iterations for xi = 4 to 20 at 1/h = 128
  c  CG iterations per linear solve over mesh, yield stress and ranks
  d  time on 1 rank over time on 2 ranks
  e  Fig. 2: error in the energy norm against an independent solution (reference.json)

Each table goes to the screen and to a Markdown file. The exit code is 0 if every criterion that was checked holds.
"""
import argparse
import glob
import json
import math
import os
import shlex
import statistics
import subprocess
import sys
import tempfile

os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")  # Open MPI refuses root, as in a container, unless told twice
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
HERE = os.path.dirname(os.path.abspath(__file__))
ENERGY_TOLERANCE = 2e-6  # [J/m], half a digit of the paper's tables and more
MEMORY_LIMIT = 8.0  # [GiB], over all ranks
MOST_UZAWA = {"table 1": 3, "table 2": 4}
MOST_CG = 20
ERROR_RATIO, ERROR_RATIO_TOLERANCE = 2.0, 0.15  # per halving of h at xi = 16


class Program:
    """Runs rpc on the beam; equal runs once."""

    def __init__(self, options):
        self.options = options
        self.results = {}

    def run(self, n, xi, ranks=1, fresh=False, **parameters):
        key = (n, xi, ranks, tuple(sorted(parameters.items())))
        if fresh or key not in self.results:
            self.results[key] = self._run(n, xi, ranks, parameters)
        return self.results[key]

    def _run(self, n, xi, ranks, parameters):
        print("  1/h = %d, xi = %s, %d rank(s)" % (n, xi, ranks), file=sys.stderr, flush=True)
        assignments = {"Mesh->Cells": "{%d, %d}" % (5 * n, n), "Contact->Yield Stress": xi, "Output->Exodus": "false",
                       "Output->CSV": "false", **parameters}
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, os.path.join(HERE, "measure.py"), folder, self.options.rpc,
                       "--input=" + self.options.input, "--output=" + folder]
            command += ["--set=%s=%s" % assignment for assignment in assignments.items()]
            if ranks > 1:
                command = shlex.split(self.options.mpiexec) + ["-n", str(ranks)] + command
            run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if run.returncode != 0:
                sys.exit("%s\nbenchmark: exit code %d of: %s" % (run.stdout, run.returncode, shlex.join(command)))
            stem = os.path.splitext(os.path.basename(self.options.input))[0]
            with open(os.path.join(folder, stem + ".json")) as file:
                result = json.load(file)
            peaks = [open(path).read() for path in glob.glob(os.path.join(folder, "*.maxrss"))]
        if result["ranks"] != ranks or len(peaks) != ranks:
            sys.exit("benchmark: asked for %d ranks, got %d" % (ranks, result["ranks"]))
        result["gib"] = sum(map(int, peaks)) / 2.0**20
        return result


class Table:
    """Rows of text; remembers whether all criteria hold."""

    def __init__(self, title, note, columns):
        self.title, self.note, self.rows, self.good = title, note, [columns], True

    def add(self, *cells):
        self.rows.append([str(cell) for cell in cells])

    def check(self, holds):
        self.good = self.good and holds
        return "ok" if holds else "FAIL"

    def text(self):
        widths = [max(len(row[c]) for row in self.rows) for c in range(len(self.rows[0]))]
        lines = ["| " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths)) + " |" for row in self.rows]
        lines.insert(1, "|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
        return "\n".join(["## " + self.title, "", self.note, ""] + lines) + "\n"


def total(result, *phases):
    return sum(result["seconds"][phase] for phase in phases)


def table_1(program, reference, sizes):
    table = Table("Energy and Uzawa iterations for xi = 2 Pa (the paper's Table 1)",
                  "Criteria: energy within %g J/m of the paper's, at most %d Uzawa iterations, memory of all ranks below %g GiB."
                  % (ENERGY_TOLERANCE, MOST_UZAWA["table 1"], MEMORY_LIMIT),
                  ["1/h", "dofs", "ranks", "Uzawa", "paper", "J [J/m]", "paper", "difference", "CG, most", "time [s]",
                   "memory [GiB]", ""])
    for n, uzawa, energy in reference["table_1"]["rows"]:
        if n not in sizes["a"]:
            continue
        ranks = 2 if n >= sizes["two ranks from"] else 1
        r = program.run(n, "2", ranks)
        difference = r["energy_J"] - energy
        good = (abs(difference) <= ENERGY_TOLERANCE and r["uzawa_iterations"] <= MOST_UZAWA["table 1"]
                and r["gib"] < MEMORY_LIMIT)
        table.add(n, r["dofs"], ranks, r["uzawa_iterations"], uzawa, "%.7f" % r["energy_J"], "%.6f" % energy,
                  "%.1e" % difference, max(r["linear_iterations"]), "%.2f" % r["seconds"]["total"], "%.2f" % r["gib"],
                  table.check(good))
    return table


def table_2(program, reference, sizes):
    n = sizes["b"]
    test = {"Uzawa->Stopping Test": "multiplier change"}
    table = Table("Uzawa iterations at 1/h = %d (the paper's Table 2)" % n,
                  "Two stopping tests: certificate (the default), and the paper's, the relative change of the multiplier. "
                  "Newton: steps in each Uzawa iteration. Criterion: at most %d Uzawa iterations with either test."
                  % MOST_UZAWA["table 2"],
                  ["xi [Pa]", "paper", "certificate", "Newton", "multiplier change", "Newton", "J [J/m]", ""])
    for xi, uzawa in reference["table_2"]["rows"]:
        ours, theirs = program.run(n, xi), program.run(n, xi, **test)
        good = max(ours["uzawa_iterations"], theirs["uzawa_iterations"]) <= MOST_UZAWA["table 2"]
        table.add(xi, uzawa, ours["uzawa_iterations"], " ".join(map(str, ours["newton_iterations"])),
                  theirs["uzawa_iterations"], " ".join(map(str, theirs["newton_iterations"])),
                  "%.7f" % ours["energy_J"], table.check(good))
    return table


def cg_iterations(program, _, sizes):
    meshes, ranks = sizes["c"]
    table = Table("CG iterations of a linear solve, the most in a run",
                  "Relative residual 1e-8. Criterion: at most %d. In brackets the mean." % MOST_CG,
                  ["1/h", "xi [Pa]"] + ["%d rank%s" % (k, "s" * (k > 1)) for k in ranks] + [""])
    for n in meshes:
        for xi in ("2", "16", "inf"):
            runs = [program.run(n, xi, k)["linear_iterations"] for k in ranks]
            table.add(n, xi, *["%d (%.1f)" % (max(run), statistics.mean(run)) for run in runs],
                      table.check(max(map(max, runs)) <= MOST_CG))
    return table


def speed_up(program, _, sizes):
    meshes, repeats, judged = sizes["d"]
    load = os.getloadavg()[0]  # [processes] by others, unless another table came just before
    phases = {"assembly": ["assembly"], "set-up": ["setup"], "solve": ["solve"],
              "together": ["mesh", "assembly", "setup", "solve"]}
    table = Table("Time on 1 rank over time on 2 ranks, xi = 16 Pa",
                  "Median of %d interleaved pairs of runs; in brackets the medians in s on 1 and 2 ranks. %d cores, load "
                  "average before %.1f. %s"
                  % (repeats, len(os.sched_getaffinity(0)), load,
                     "Criterion: above 1 for the solve phase and for all phases together." if judged else
                     "No criterion: the meshes are too small."), ["1/h"] + list(phases) + [""])
    for n in meshes:
        program.run(n, "16", 2, fresh=True)  # warms up file caches
        pairs = [(program.run(n, "16", 1, fresh=True), program.run(n, "16", 2, fresh=True)) for _ in range(repeats)]
        ratios, cells = {}, []
        for name, parts in phases.items():
            times = [(total(one, *parts), total(two, *parts)) for one, two in pairs]
            ratios[name] = statistics.median(one / two for one, two in times)
            medians = [statistics.median(time) for time in zip(*times)]
            cells.append("%.2f (%.3f, %.3f)" % (ratios[name], *medians))
        good = min(ratios["solve"], ratios["together"]) > 1
        table.add(n, *cells, table.check(good) if judged else "")
    return table


def energy_error(program, reference, sizes):
    table = Table("Relative error in the energy norm (the paper's Fig. 2)",
                  "sqrt(2 (J_h - J) / a(u,u)), with J and a(u,u) of an independent solution: an upper bound of the error, since "
                  "J_h >= J. Ratio: error on the mesh before over this one; order: its base-2 logarithm. Criterion: the "
                  "ratio at xi = 16 Pa is %g within %g." % (ERROR_RATIO, ERROR_RATIO_TOLERANCE),
                  ["xi [Pa]", "1/h", "J_h [J/m]", "J_h - J", "error", "ratio", "order", ""])
    exact = {row[0]: row[1:] for row in reference["beam"]["rows"]}
    for xi in ("2", "16"):
        energy, _, norm = exact[xi]
        before = None
        for n in sizes["e"]:
            r = program.run(n, xi, 2 if n >= sizes["two ranks from"] else 1)
            error = math.sqrt(max(0, 2 * (r["energy_J"] - energy) / norm))
            cells = ["", "", ""]
            if before:
                ratio = before / error if error > 0 else math.inf
                good = table.check(abs(ratio - ERROR_RATIO) <= ERROR_RATIO_TOLERANCE) if xi == "16" else ""
                cells = ["%.3f" % ratio, "%.2f" % math.log2(ratio), good]
            table.add(xi, n, "%.8f" % r["energy_J"], "%.3e" % (r["energy_J"] - energy), "%.3f %%" % (100 * error), *cells)
            before = error
    return table


HEADING = """# Benchmarks

The paper's beam (input/beam.xml). Every figure below was printed by

    cmake --build build --target benchmark

which writes this page to build/benchmark/benchmarks.md. Times are those of one machine on one day; ratios and counts are what to compare.
"""
TABLES = {"a": ("table_1", table_1), "b": ("table_2", table_2), "c": ("cg_iterations", cg_iterations),
          "d": ("speed_up", speed_up), "e": ("energy_error", energy_error)}
FULL = {"a": [8, 16, 32, 64, 128, 256, 512], "b": 128, "c": ([32, 64, 128, 256], [1, 2, 3]), "d": ([128, 256], 3, True),
        "e": [8, 16, 32, 64, 128, 256], "two ranks from": 256}
QUICK = {"a": [8, 16, 32], "b": 32, "c": ([16, 32], [1, 2]), "d": ([32], 1, False), "e": [8, 16, 32], "two ranks from": 32}


def cut(sizes, largest):
    """Without the meshes finer than 1/largest."""
    def kept(meshes):
        return [n for n in meshes if n <= largest]

    return {**sizes, "a": kept(sizes["a"]), "b": min(sizes["b"], largest), "c": (kept(sizes["c"][0]), sizes["c"][1]),
            "d": (kept(sizes["d"][0]), *sizes["d"][1:]), "e": kept(sizes["e"])}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", default="build/rpc", help="program (%(default)s)")
    parser.add_argument("--input", default=os.path.join(HERE, "../../input/beam.xml"), help="deck of the beam")
    parser.add_argument("--output", default="build/benchmark", help="folder for the tables (%(default)s)")
    parser.add_argument("--mpiexec", default="mpirun --oversubscribe --bind-to none", help="as one text (%(default)s)")
    parser.add_argument("--only", default=",".join(TABLES), help="tables, as a,c (all)")
    parser.add_argument("--quick", action="store_true", help="coarse meshes: a test of this script")
    parser.add_argument("--largest", type=int, default=512, help="leave out meshes finer than 1/h = LARGEST")
    options = parser.parse_args(arguments)
    options.only = options.only.split(",")
    unknown = [name for name in options.only if name not in TABLES]
    if unknown:
        parser.error("--only: there is no table %s; there are %s" % (", ".join(unknown), ", ".join(TABLES)))
    options.rpc, options.input = os.path.abspath(options.rpc), os.path.abspath(options.input)
    return options


def main(arguments):
    options = parse(arguments)
    with open(os.path.join(HERE, "reference.json")) as file:
        reference = json.load(file)
    program = Program(options)
    sizes = cut(QUICK if options.quick else FULL, options.largest)
    os.makedirs(options.output, exist_ok=True)
    failed, document = [], HEADING
    for name in options.only:
        stem, make = TABLES[name]
        table = make(program, reference, sizes)
        print("\n" + table.text(), flush=True)
        with open(os.path.join(options.output, stem + ".md"), "w") as file:
            file.write(table.text())
        document += "\n" + table.text()
        if not table.good:
            failed.append(name)
    with open(os.path.join(options.output, "benchmarks.md"), "w") as file:
        file.write(document)
    print("benchmark: " + ("FAILED: " + ", ".join(failed) if failed else "all criteria hold"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

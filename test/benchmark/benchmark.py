# SPDX-License-Identifier: BSD-3-Clause
"""The tables of doc/benchmarks.md, with pass or fail.

    python3 benchmark.py --rpc=build/rpc --output=build/benchmark [--only=cg,peers] [--quick] [--largest=128]

Tables: {tables}

Each table goes to the screen and to a Markdown file. The exit code is 0 if every criterion that was checked holds. What a table
takes beyond Python and rpc and does not find is skipped, with the reason.
"""
import argparse
import functools
import json
import os
import sys

from suite import accuracy, adaptive, contact, families, kernels, own_meshes, paper, peers, scaling, step_42
from suite.program import Failure, Program

HERE = os.path.dirname(os.path.abspath(__file__))
TABLES = {"table-1": paper.table_1, "table-2": paper.table_2, "figure-2": paper.figure_2, "cg": scaling.cg_iterations,
          "mesh-size": scaling.mesh_size, "ranks": scaling.ranks, "contact": contact.contact_cost, "kernels": kernels.kernels,
          "accuracy": accuracy.accuracy, "adaptive": adaptive.adaptive, "peers": peers.peers,
          "peers-in-space": peers.peers_in_space, "own-mesh": own_meshes.own_mesh, "step-42": step_42.step_42, "families": families.families,
          "growth": families.steps_over_mesh}
# Meshes: 1/h; of "accuracy" also sizes of cells, and targets; of "adaptive" first the least target. The last number of "ranks",
# "peers", "peers in space", "step-42" and "adaptive": where the criterion is judged; of "contact" and "own mesh": whether it is; "kernels": in the
# plane, in space. "families": scenes and their size; "growth": the finest meshes.
FULL = {"table 1": [8, 16, 32, 64, 128, 256, 512], "table 2": 128, "figure 2": [8, 16, 32, 64, 128, 256], "two ranks from": 256,
        "cg": ([32, 64, 128], [1, 2, 3]), "mesh size": [32, 64, 128, 256, 512], "ranks": ([128, 256], 3, 256),
        "contact": (256, 3, True), "kernels": ([256, 512], [16, 32]), "peers": ([128], 2, 128),
        "peers in space": ([12, 24], 2, 24), "own mesh": ((48, 34, 34), 2, True), "step-42": ([32, 64], 2, 64),
        "accuracy": {"elements": ("P1", "Q1", "P2", "Q2"), "box": [16, 32, 64, 128], "finer Q1": [256, 512],
                     "peers": [16, 32, 64, 128],
                     "graded": ([0.05, 0.025, 0.0125, 0.00625], [0.2, 0.1, 0.05, 0.025]), "hertz": [4, 2, 1, 0.5],
                     "targets": [0.02, 0.01, 0.005, 0.002, 0.001, 0.0005]},
        "adaptive": (0, 3, 512), "families": (200, "full"), "growth": {"plane": 256, "space": 32}}
QUICK = {"table 1": [8, 16, 32], "table 2": 32, "figure 2": [8, 16, 32], "two ranks from": 32, "cg": ([16, 32], [1, 2]),
         "mesh size": [16, 32], "ranks": ([32], 1, None), "contact": (32, 1, False), "kernels": ([32], [4]), "peers": ([16], 1, None),
         "peers in space": ([4], 1, None), "own mesh": ((12, 8, 8), 1, False), "step-42": ([8, 16], 1, None),
         "accuracy": {"elements": ("Q1", "P2"), "box": [8, 16], "finer Q1": [], "peers": [16], "graded": ([0.2], [0.4]),
                      "hertz": [8], "targets": [0.05, 0.02]},
         "adaptive": (0.02, 1, None), "families": (24, "small"), "growth": {"plane": 32, "space": 16}}
HEADING = """# Benchmarks

Example 1 of the paper is input/beam.xml, its Example 2 input/hertz.xml. Every figure below was printed by

    cmake --build build --target benchmark

which writes this page to build/benchmark/benchmarks.md. Times are those of one machine on one day; ratios and counts are what
to compare. %s
"""


class Bench:
    """What a table needs."""

    def __init__(self, options, sizes):
        self.output, self.kernels, self.sizes, self.seed = options.output, options.kernels, sizes, options.seed
        self.program = Program(options.rpc, options.input, options.mpiexec)
        self.triads = {}
        with open(os.path.join(HERE, "reference.json")) as file:
            self.reference = json.load(file)

    @functools.cached_property
    def python(self):
        """The interpreter for the peers."""
        return peers.Python(self.output)

    def energy_reference(self, problem, xi):
        """[J, its tolerance, a(u, u)] of the problem, beam or hertz."""
        return self.row(problem, xi)[1:4]

    def row(self, problem, xi):
        """Of the reference."""
        return next(row for row in self.reference[problem]["rows"] if row[0] == xi)


def machine(bench):
    """Cores, processor and memory bandwidth."""
    facts = "%d cores" % len(os.sched_getaffinity(0))
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as file:
            names = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
        facts += ", " + names[0] if names else ""
    if bench.kernels:
        facts += ", STREAM triad %.1f GB/s on one rank" % kernels.triad(bench, 1)
    return "Here: %s." % facts


def cut(sizes, largest):
    """Without the meshes finer than 1/largest."""
    def kept(value):
        if isinstance(value, list):
            return [n for n in value if n <= largest]
        return min(value, largest)

    plain = {name: kept(sizes[name]) for name in ("table 1", "table 2", "figure 2", "mesh size")}
    first = {name: (kept(sizes[name][0]), *sizes[name][1:])
             for name in ("cg", "ranks", "contact", "kernels", "peers", "peers in space", "step-42")}
    boxes = {name: kept(sizes["accuracy"][name]) for name in ("box", "finer Q1", "peers")}
    return {**sizes, **plain, **first, "accuracy": {**sizes["accuracy"], **boxes}}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.format(tables=", ".join(TABLES)),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", default="build/rpc", help="program (%(default)s)")
    parser.add_argument("--kernels", help="program benchmark_kernels (none: no table of kernels, no STREAM triad)")
    parser.add_argument("--input", default=os.path.join(HERE, "../../input"), help="folder of the decks")
    parser.add_argument("--output", default="build/benchmark", help="folder for the tables (%(default)s)")
    parser.add_argument("--mpiexec", default="mpirun --oversubscribe --bind-to none", help="as one text (%(default)s)")
    parser.add_argument("--only", default=",".join(TABLES), help="tables, as cg,peers (all)")
    parser.add_argument("--quick", action="store_true", help="coarse meshes: a test of these scripts")
    parser.add_argument("--largest", type=int, default=512, help="leave out meshes finer than 1/h = LARGEST")
    parser.add_argument("--seed", type=int, default=1, help="of the random scenes of families (%(default)s)")
    options = parser.parse_args(arguments)
    options.only = options.only.split(",")
    unknown = [name for name in options.only if name not in TABLES]
    if unknown:
        parser.error("--only: there is no table %s; there are %s" % (", ".join(unknown), ", ".join(TABLES)))
    for name in ("rpc", "kernels", "input", "output"):
        if getattr(options, name):
            setattr(options, name, os.path.abspath(getattr(options, name)))
    return options


def main(arguments):
    options = parse(arguments)
    os.makedirs(options.output, exist_ok=True)
    bench = Bench(options, cut(QUICK if options.quick else FULL, options.largest))
    failed = []
    try:
        document = HEADING % machine(bench)
        for name in options.only:
            table = TABLES[name](bench)
            print("\n" + table.text(), flush=True)
            with open(os.path.join(options.output, name + ".md"), "w") as file:
                file.write(table.text())
            document += "\n" + table.text()
            if not table.good:
                failed.append(name)
    except Failure as failure:
        sys.exit("benchmark: %s" % failure)
    with open(os.path.join(options.output, "benchmarks.md"), "w") as file:
        file.write(document)
    print("benchmark: " + ("FAILED: " + ", ".join(failed) if failed else "all criteria hold"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

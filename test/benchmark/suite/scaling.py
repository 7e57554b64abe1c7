# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory over mesh size and ranks; CG iterations."""
import math
import os
import statistics

from .kernels import triad
from .program import median_ratio
from .table import Table

MOST_CG = 20
MEMORY_LIMIT = 8.0  # [GiB], over all ranks
MOST_GROWTH = 6.0  # of the time for 4 times the unknowns
LEAST_SPEED_UP = 1.6
PHASES = {"mesh": "mesh", "assembly": "assembly", "prediction": "prediction", "set-up": "setup", "solve": "solve"}


def phase_seconds(result):
    """By the names of PHASES. Prediction: on coarser meshes."""
    return {name: result["seconds"].get(phase, 0.0) for name, phase in PHASES.items()}


def cg_iterations(bench):
    meshes, ranks = bench.sizes["cg"]
    table = Table("CG iterations of a linear solve, the most in a run",
                  "Relative residual 1e-8. Criterion: at most %d. In brackets the mean." % MOST_CG,
                  ["1/h", "xi [Pa]"] + ["%d rank%s" % (k, "s" * (k > 1)) for k in ranks] + [""])
    for n in meshes:
        for xi in ("2", "16", "inf"):
            runs = [bench.program.beam(n, xi, k)["linear_iterations"] for k in ranks]
            table.add(n, xi, *["%d (%.1f)" % (max(run), statistics.mean(run)) for run in runs],
                      table.check(max(map(max, runs)) <= MOST_CG))
    return table


def mesh_size(bench):
    meshes = bench.sizes["mesh size"]
    table = Table("Time and memory over the mesh, xi = 16 Pa",
                  "Times in s, in brackets ns per unknown; of the whole process with its start, 2 ranks with that of mpirun. "
                  "Criteria for 1/h = 512: less than %g GiB, at most %g x the time for 256 on as many ranks."
                  % (MEMORY_LIMIT, MOST_GROWTH),
                  ["1/h", "dofs", "ranks", *PHASES, "whole process", "growth", "memory [GiB]", ""])
    before = {}
    for n in meshes:
        for ranks in (1, 2) if n < 512 else (2,):
            r = bench.program.beam(n, "16", ranks, fresh=True)
            cells = ["%.3f (%.0f)" % (seconds, 1e9 * seconds / r["dofs"]) for seconds in phase_seconds(r).values()]
            growth = r["process"] / before[ranks] if ranks in before else math.nan
            good = table.check(r["gib"] < MEMORY_LIMIT and growth <= MOST_GROWTH) if n == 512 else ""
            table.add(n, r["dofs"], ranks, *cells, "%.2f (%.0f)" % (r["process"], 1e9 * r["process"] / r["dofs"]),
                      "" if math.isnan(growth) else "%.2f" % growth, "%.2f" % r["gib"], good)
            before[ranks] = r["process"]
    return table


def ranks(bench):
    meshes, repeats, judged = bench.sizes["ranks"]
    load = os.getloadavg()[0]  # [processes] by others, unless another table came just before
    stream = [triad(bench, k) for k in (1, 2)]
    table = Table("1 rank against 2 ranks, xi = 16 Pa",
                  "Strong: time on 1 rank over time on 2, equal meshes; weak: time on 1 rank over time on 2 with twice the "
                  "unknowns (ideal: 2 and 1). Medians of %d interleaved pairs, in brackets of the times in s. %s. %d cores, load "
                  "average before %.1f. %s"
                  % (repeats,
                     "STREAM triad: %.1f and %.1f GB/s, ratio %.2f" % (*stream, stream[1] / stream[0]) if stream[0] else
                     "No STREAM triad: it takes Google Benchmark", len(os.sched_getaffinity(0)), load,
                     "Criterion: strong, solve phase, 1/h = %d: at least %g." % (judged, LEAST_SPEED_UP) if judged else
                     "No criterion: the meshes are too small."), ["", "1/h", *PHASES, "together", ""])
    for n in meshes:
        for kind, n_two in (("strong", n), ("weak", round(math.sqrt(2) * n))):
            bench.program.beam(n_two, "16", 2, fresh=True)  # warms up file caches
            pairs = [[phase_seconds(bench.program.beam(size, "16", k, fresh=True)) for k, size in ((1, n), (2, n_two))]
                     for _ in range(repeats)]
            results = {name: median_ratio([(one[name], two[name]) for one, two in pairs])
                       for name in PHASES if all(times[name] > 0 for pair in pairs for times in pair)}
            together = median_ratio([[sum(times.values()) for times in pair] for pair in pairs])
            good = table.check(results["solve"][0] >= LEAST_SPEED_UP) if n == judged and kind == "strong" else ""
            cells = ["%.2f (%.3f, %.3f)" % tuple(results[name]) if name in results else "" for name in PHASES]
            table.add(kind, n if n == n_two else "%d, %d" % (n, n_two), *cells, "%.2f (%.3f, %.3f)" % tuple(together), good)
    return table

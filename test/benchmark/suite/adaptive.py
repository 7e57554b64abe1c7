# SPDX-License-Identifier: BSD-3-Clause
"""What adaptive meshes reach, and how much faster than uniform ones and peers."""
import math
import statistics
import typing

from .accuracy import adaptive_beam, adaptive_hertz, beam_run, fastest, peer_results, uniform_beam
from .table import Table, skipped

LEAST_SPEED_UP = 100.0  # over uniform Q1 of the same error


class Aim(typing.NamedTuple):
    """Of the beam."""

    xi: str
    target: float  # the estimate's
    error: float  # in the energy norm, the true one
    dofs: float
    seconds: float


BEAM = (Aim("2", 0.006, 0.005, 8000, 1.0), Aim("2", 0.0005, 0.0005, math.inf, 5.0), Aim("16", 0.0005, 0.0005, math.inf, 2.0))
HERTZ = {"xi": "inf", "target": 0.002, "pressure": 0.001, "half width": 0.005, "seconds": 2.0}  # relative errors


def uniform_sizes(bench):
    """1/h of Q1."""
    return bench.sizes["accuracy"]["box"] + bench.sizes["accuracy"]["finer Q1"]


def median_of(repeats, run):
    """Runs so many times: the last result with the median of the times."""
    results = [run() for _ in range(repeats)]
    return {**results[-1], "process": statistics.median(result["process"] for result in results)}


def extrapolated(runs, error):
    """Seconds for an error by the slope of error over time of the last three runs, from coarse to fine; nan if it does not fall."""
    first, last = runs[-min(3, len(runs))], runs[-1]
    if first.error <= last.error:
        return math.nan
    slope = math.log(last.seconds / first.seconds) / math.log(first.error / last.error)
    return last.seconds * (last.error / error)**slope


def against(lines, error, seconds):
    """The fastest run with at most the error of several lines of runs, else the one with the least; its time over seconds; as
    two cells. And whether it has the error."""
    reached = [run for run in (fastest(runs, error) for runs in lines) if run]
    run = min(reached or sum(lines, []), key=lambda run: (0 if reached else round(run.error, 6), run.seconds))
    return ["%.2f, %.3f %%" % (run.seconds, 100 * run.error),
            "%s%.1f" % ("" if reached else "> ", run.seconds / seconds)], bool(reached)


def uniform_cells(bench, aim, error, seconds):
    """Cells on uniform Q1 meshes, and how much longer they take."""
    results = [uniform_beam(bench, aim.xi, "Q1", n) for n in uniform_sizes(bench)]
    runs = [beam_run(bench, aim.xi, "uniform", "Q1", result) for result in results]
    cells, reached = against([runs], error, seconds)
    if reached:
        return cells + ["", ""], fastest(runs, error).seconds / seconds
    predicted = extrapolated(runs, error)
    return cells + ["%.3g" % predicted, "%.1f" % (predicted / seconds)], predicted / seconds


def peer_cells(bench, aim, error, seconds):
    """Cells on the best peer, and why others have no runs."""
    found, reasons = peer_results(bench, aim.xi)
    lines = {}
    for result in found:
        lines.setdefault(result[0], []).append(beam_run(bench, aim.xi, *result))
    return against(list(lines.values()), error, seconds)[0] if lines else ["", ""], reasons


def add_beam(bench, table, aim):
    """Adds a row; returns why peers are missing."""
    least, repeats, judged = bench.sizes["adaptive"]
    target, error = max(aim.target, least), max(aim.error, least)
    run = beam_run(bench, aim.xi, "adaptive", "P2",
                   median_of(repeats, lambda: adaptive_beam(bench, aim.xi, "P2", target, fresh=True)))
    uniform, speed_up = uniform_cells(bench, aim, error, run.seconds)
    peer, reasons = peer_cells(bench, aim, error, run.seconds)
    good = run.error <= error and run.dofs <= aim.dofs and run.seconds <= aim.seconds
    asked = "%g %%" % (100 * error) + (", %d dofs" % aim.dofs if aim.dofs < math.inf else "") + ", %g s" % aim.seconds
    table.add(run.scene, asked, "%g %%" % (100 * target), run.dofs, "%.3f %%" % (100 * run.error), "%.2f" % run.seconds,
              table.check(good) if judged else "", *uniform,
              table.check(speed_up >= LEAST_SPEED_UP) if judged in uniform_sizes(bench) else "", *peer)
    return reasons


def add_hertz(bench, table):
    least, repeats, judged = bench.sizes["adaptive"]
    xi, target = HERTZ["xi"], max(HERTZ["target"], least)
    r = median_of(repeats, lambda: adaptive_hertz(bench, xi, "P2", target, fresh=True))
    _, pressure, half_width = bench.row("hertz", xi)[4:]
    errors = {"pressure": abs(r["max_pressure"] / pressure - 1), "half width": abs(r["contact_length"] / 2 / half_width - 1)}
    good = all(error <= HERTZ[name] for name, error in errors.items()) and r["process"] <= HERTZ["seconds"]
    asked = ", ".join("%s %g %%" % (name, 100 * HERTZ[name]) for name in errors) + ", %g s" % HERTZ["seconds"]
    table.add("Hertz, xi = " + xi, asked, "%g %%" % (100 * target), r["dofs"],
              ", ".join("%.3f %%" % (100 * error) for error in errors.values()), "%.2f" % r["process"],
              table.check(good) if judged else "", *[""] * 7)


def adaptive(bench):
    title = "Adaptive meshes over uniform ones and peers"
    _, repeats, judged = bench.sizes["adaptive"]
    sizes = uniform_sizes(bench)
    if not sizes:
        return skipped(title, "no uniform mesh to compare with")
    table = Table(title,
                  "P2; whole processes on one rank, adaptive ones with all their meshes, median of %d. Asked: most error, in the "
                  "energy norm for the beam, dofs and time. Target: of the estimated error. Uniform Q1, down to 1/h = %d, and the "
                  "best peer on uniform Q1, down to 1/h = %d: seconds and error of the fastest run with at most the error "
                  "asked for; where none has it, of the best one, and with > the ratio of its time. Extrapolated: seconds "
                  "that uniform Q1 would take for the error asked for by the slope of error over time of its last three "
                  "meshes, not run. %s"
                  % (repeats, max(sizes), max(bench.sizes["accuracy"]["peers"], default=0),
                     "Criteria: what is asked for; uniform Q1, run or extrapolated, takes at least %g x as long, judged with "
                     "1/h = %d among its meshes." % (LEAST_SPEED_UP, judged) if judged else
                     "No criterion: the meshes are too small."),
                  ["scene", "asked", "target", "dofs", "error", "time [s]", "", "uniform Q1 [s]", "over adaptive",
                   "extrapolated [s]", "over adaptive", "", "best peer [s]", "over adaptive"])
    missing = [reason for aim in BEAM for reason in add_beam(bench, table, aim)]
    if missing:
        table.note += " Skipped: %s." % "; ".join(dict.fromkeys(missing))
    add_hertz(bench, table)
    return table

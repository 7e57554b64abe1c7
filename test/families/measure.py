# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes by family: contact over the elastic solve of the same mesh, steps, CG iterations, set-ups, residuals.

    python3 measure.py --rpc=build/rpc [--seed=1] [--scenes=200] [--size=full] [--only=K] [--family=NAME,...] [--kind=hard] [--csv=FILE]
                       [--keep=DIR]

Scene K comes from the seed and K alone (families.py). Each is run with contact, without its Contact list, and with contact but
without coarser meshes; times are of whole processes. A table by family, the bars, and each failed scene with its command. The exit
code is 1 if a scene failed or a bar does not hold. --size=small has meshes of a few thousand dofs of the same scenes; times mean
nothing there, and their bars are left out. --steps-only leaves out the runs without contact. --kind=hard has the families of hard.py,
--kind=friction those of friction.py, both without the cold runs.
"""
import argparse
import concurrent.futures
import os
import sys

import families
import report
import runs


BARS = {  # of steps, of times, and what scenes must have
    "three states": (report.STEP_BARS, report.TIME_BARS, [report.THREE_STATES]),
    "hard": (report.HARD_BARS, report.HARD_TIME_BARS, []),
    "friction": (report.FRICTION_BARS, report.FRICTION_TIME_BARS, [report.STICK_AND_SLIP]),
}


def arguments(parser):
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", type=int)
    parser.add_argument("--family", help="only these of the scenes, separated by commas")
    parser.add_argument("--kind", choices=list(families.KINDS), default="three states", help="%(default)s")
    parser.add_argument("--size", choices=list(families.SIZES), default="full")
    parser.add_argument("--steps-only", dest="elastic", action="store_false")
    parser.add_argument("--time-limit", type=float, default=300.0, help="of a run [s] (%(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at a time; more than one disturbs the times")
    parser.add_argument("--np", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpiexec --oversubscribe --bind-to none")
    parser.add_argument("--csv", help="file for a row a scene")
    parser.add_argument("--keep", help="folder for the files of failed scenes, and of --only")


def chosen(options):
    if options.only is not None:
        return [options.only]
    numbers = range(options.first, options.first + options.scenes)
    return [k for k in numbers if not options.family or families.family_of(k, options.kind) in options.family.split(",")]


def rubbing(row):
    return f", {row.sticks} sticking, {row.slips} slipping" if row.sticks or row.slips else ""


def measured(options):
    """The Rows of the scenes, in order; a line each on standard error."""
    rows = []
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for row in pool.map(lambda number: runs.measure(options, number), chosen(options)):
            rows.append(row)
            print("  %d %s %s: %d dofs, %d points (%d open, %d closed, %d yielding%s), %s s, ratio %s, steps %s, cold %s, CG %s%s%s"
                  % (row.number, row.family, row.element, row.dofs, row.points, row.open, row.closed, row.yielding, rubbing(row),
                     report.short(row.seconds), report.short(row.ratio), report.short(row.steps, "%.0f"), report.short(row.cold_steps, "%.0f"),
                     report.short(row.most_cg, "%.0f"), row.at_rounding and "; at rounding", row.failure and "; FAILED: " + row.failure),
                  file=sys.stderr, flush=True)
    return rows


def note(options):
    return ("Seed %d, size %s, %d rank(s). Ratio: time of the whole process over that of the same deck without its Contact list%s. Steps: "
            "active-set and Newton steps on the finest mesh, from a coarser mesh's solution%s. CG "
            "iterations and set-ups on the finest mesh." % (options.seed, options.size, options.np, ", best of 2 where short" if options.elastic else "",
                                                            "" if options.kind in runs.WITHOUT_COLD else "; cold: without coarser meshes"))


def tables(options, rows):
    timed = options.elastic and options.size == "full"
    bars, time_bars, wanted = BARS[options.kind]
    names = list(families.KINDS[options.kind][0])
    return [report.family_table(rows, note(options), options.elastic, names, options.kind == "friction"),
            report.bar_table(rows, bars + (time_bars if timed else []), wanted)]


def failures(options, rows):
    """A line for each failed scene, with its command."""
    return ["FAILED %d %s: %s\n    %s" % (row.number, row.family, row.failure, runs.command(options, row)) for row in rows if row.failure]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments(parser)
    options = parser.parse_args()
    options.rpc = os.path.abspath(options.rpc)
    rows = measured(options)
    if options.csv:
        report.write_csv(rows, options.csv)
    results = tables(options, rows)
    for table in results:
        print("\n" + table.text())
    print("\n".join(failures(options, rows)))
    return 0 if all(table.good for table in results) else 1


if __name__ == "__main__":
    sys.exit(main())

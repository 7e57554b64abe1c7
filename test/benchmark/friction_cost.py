# SPDX-License-Identifier: BSD-3-Clause
"""What friction costs beside none: whole runs of a block and of histories with mu = 0 and 0.3, by size and backend.

    python3 friction_cost.py measure --backend=NAME ["--scenes=NAME; NAME; ..."] [--repeats=3] [--table=friction_cost.csv] COMMAND ...
    python3 friction_cost.py draw friction_cost.csv

COMMAND starts rpc: "build/rpc", "build-cuda/rpc", "env OMP_NUM_THREADS=16 build-openmp/rpc". `measure` puts the medians of whole processes, with mu = 0 and
0.3 in turns, into the table, in place of those of the same scene and backend: elapsed seconds, on one core the processor's, which other
processes disturb less. `draw` writes the table's picture beside it.
"""
import argparse
import csv
import json
import math
import os
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

COEFFICIENTS = (0.0, 0.3)
INPUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "input")
COLUMNS = ["scene", "unknowns", "backend", "mu", "seconds", "load steps", "Newton steps", "iterations", "runs", "version"]
STYLES = {"one core": {"color": "C0", "marker": "o"}, "16 threads": {"color": "C1", "marker": "s"}, "one H200": {"color": "C2", "marker": "D"}}
TWENTY = "{%s}" % ", ".join(map(str, range(1, 21)))


def block(n):
    """input/block.xml of Q1, 2 n x 2 n x n cells."""
    return ["block.xml", "Mesh->Element=Q1", "Mesh->Cells={%d, %d, %d}" % (2 * n, 2 * n, n)]


def history(n):
    """The block, pressed to and fro and pushed along the foundation to and fro, so that each step changes states without friction, too."""
    return block(n) + ["Traction->front->Z=-20*(0.75 + 0.25*sin(t))", "Traction->front->X=8*sin(0.5*t)", "Steps->Times=" + TWENTY]


SCENES = {  # name: (deck and settings, title of the part of the picture that has it)
    **{"%d x %d x %d" % (2 * n, 2 * n, n): (block(n), "block, one load") for n in (16, 32, 50, 100, 200, 260)},
    **{"%d x %d x %d, 20 steps" % (2 * n, 2 * n, n): (history(n), "block, 20 load steps") for n in (8, 16, 32, 50)},
    "shear.xml": (["shear.xml"], "shear.xml, 26 load steps"),
    "shear.xml, 600 x 300": (["shear.xml", "Mesh->Cells={600, 300}"], "shear.xml, 26 load steps"),
    "shear.xml, 1224 x 612": (["shear.xml", "Mesh->Cells={1224, 612}"], "shear.xml, 26 load steps"),
}


def refuse(what):
    print("friction_cost.py: " + what, file=sys.stderr)
    sys.exit(2)


def seconds_of_processor():
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return children.ru_utime + children.ru_stime


def run(command, name, mu, clock):
    """(seconds of the whole process by a clock, the summary)"""
    deck, *settings = SCENES[name][0]
    with tempfile.TemporaryDirectory(prefix="rpc_friction_cost_") as folder:
        settings += ["Contact->Friction Coefficient=%g" % mu, "Output->Exodus=false", "Output->CSV=false"]
        words = [*command, "--input=" + os.path.join(INPUT, deck), "--output=" + folder, *("--set=" + s for s in settings)]
        start = clock()
        try:
            done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        except OSError as error:
            refuse("cannot start %s: %s" % (command[0], error.strerror))
        seconds = clock() - start
        if done.returncode != 0:
            sys.exit("%s\nexit code %d of: %s" % (done.stdout[-2000:], done.returncode, shlex.join(words)))
        with open(os.path.join(folder, os.path.splitext(deck)[0] + ".json")) as file:
            return seconds, json.load(file)


def row(name, backend, mu, runs):
    seconds, summary = statistics.median(s for s, _ in runs), runs[0][1]
    steps = summary.get("steps")
    newton, iterations = (sum(s[key] for s in steps) if steps else sum(summary[key]) for key in ("newton_iterations", "linear_iterations"))
    return {"scene": name, "unknowns": summary["dofs"], "backend": backend, "mu": "%g" % mu, "seconds": "%.3g" % seconds,
            "load steps": len(steps) if steps else 1, "Newton steps": newton, "iterations": iterations, "runs": len(runs), "version": summary["rpc_version"]}


def read(path):
    """The rows of a table, all of known scenes and backends; none of a table that there is not."""
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        table = csv.DictReader(file)
        rows = list(table)
    if table.fieldnames != COLUMNS:
        refuse("%s has the columns %s, not %s" % (path, ", ".join(table.fieldnames or []), ", ".join(COLUMNS)))
    for number, r in enumerate(rows, 2):
        for key, known in (("scene", SCENES), ("backend", STYLES)):
            if r[key] not in known:
                refuse("%s, line %d: no %s \"%s\"; there are: %s. Take the line out, or name it as it is called now" % (path, number, key, r[key], "; ".join(known)))
    return rows


def measure(options):
    read(options.table)  # refused before hours of runs
    clock = seconds_of_processor if options.backend == "one core" else time.perf_counter
    for name in options.scenes:
        runs = {mu: [] for mu in COEFFICIENTS}
        for _ in range(options.repeats):
            for mu in COEFFICIENTS:
                runs[mu].append(run(options.command, name, mu, clock))
        new = [row(name, options.backend, mu, runs[mu]) for mu in COEFFICIENTS]
        print(json.dumps(new), flush=True)
        rows = [r for r in read(options.table) if (r["scene"], r["backend"]) != (name, options.backend)] + new
        rows.sort(key=lambda r: (list(SCENES).index(r["scene"]), list(STYLES).index(r["backend"]), float(r["mu"])))
        with open(options.table, "w", newline="") as file:
            table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            table.writeheader()
            table.writerows(rows)


def draw(path):
    rows = read(path)
    if not rows:
        refuse("%s has no rows; measure makes them" % path)
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker

    parts = list(dict.fromkeys(part for _, part in SCENES.values()))
    figure, axes = pyplot.subplots(2, len(parts), figsize=(3.6 * len(parts), 5), layout="constrained", sharex="col", squeeze=False,
                                   gridspec_kw={"height_ratios": [3, 2]})
    for (times, ratios), part in zip(axes.T, parts):
        for backend, style in STYLES.items():
            points = {mu: sorted((int(r["unknowns"]), float(r["seconds"])) for r in rows
                                 if SCENES[r["scene"]][1] == part and r["backend"] == backend and float(r["mu"]) == mu) for mu in COEFFICIENTS}
            if not points[0.3]:
                continue
            for mu, look in ((0.0, {"linestyle": "--", "markerfacecolor": "white"}), (0.3, {"linestyle": "-"})):
                times.loglog(*zip(*points[mu]), markersize=4, label="%s, $\\mu$ = %g" % (backend, mu), **look, **style)
            ratios.semilogx([n for n, _ in points[0.3]], [b / a for (_, a), (_, b) in zip(points[0.0], points[0.3])], markersize=4, **style)
        times.set_title(part, fontsize=9)
        times.yaxis.set_minor_formatter(ticker.NullFormatter())
        times.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        times.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: "%g" % value))
        ratios.set_ylim(0, math.ceil(max(1.0, ratios.get_ylim()[1])))
        ratios.set_xlabel("unknowns", fontsize=8)
        for axis in (times, ratios):
            axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.xaxis.set_major_formatter(ticker.EngFormatter(sep=""))
            axis.xaxis.set_minor_formatter(ticker.NullFormatter())
            axis.tick_params(labelsize=7, which="both")
            axis.grid(True, which="both", linewidth=0.3)
    axes[0][0].set_ylabel("whole process [s]", fontsize=8)
    axes[1][0].set_ylabel("$\\mu$ = 0.3 over $\\mu$ = 0", fontsize=8)
    axes[0][0].legend(fontsize=7, handlelength=3)
    figure.savefig(os.path.splitext(path)[0] + ".png", dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="what", required=True)
    measuring = commands.add_parser("measure")
    measuring.add_argument("--backend", required=True, choices=STYLES)
    measuring.add_argument("--scenes", default="64 x 64 x 32", help="names, separated by ;")
    measuring.add_argument("--repeats", type=int, default=3)
    measuring.add_argument("--table", default="friction_cost.csv")
    measuring.add_argument("command", nargs="+")
    commands.add_parser("draw").add_argument("table")
    options = parser.parse_args()
    if options.what == "draw":
        draw(options.table)
        return
    options.scenes = [name.strip() for name in options.scenes.split(";")]
    for name in options.scenes:
        if name not in SCENES:
            refuse("no scene \"%s\"; scenes: %s" % (name, "; ".join(SCENES)))
    measure(options)


if __name__ == "__main__":
    main()

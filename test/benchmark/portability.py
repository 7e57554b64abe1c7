# SPDX-License-Identifier: BSD-3-Clause
"""The same scenes by programs of different backends: do they agree, and how fast are they?

    python3 portability.py run --output=DIR [--hertz-mesh=hertz.msh] [--repeats=N] [--set=PATH=VALUE ...] NAME=COMMAND ...
    python3 portability.py compare --output=DIR --reference=NAME NAME ...
    python3 portability.py speed [--cells=256] [--yield-stress=16] [--repeats=3] NAME=COMMAND ...

COMMAND starts rpc: "OMP_NUM_THREADS=2 build-openmp/rpc", "mpirun -n 2 build/rpc", "build-cuda/rpc". `run` keeps the results in
DIR/NAME, of decks with what --set changes in them; `compare` prints a table from them, on any machine, and its exit code is 1
where a criterion does not hold; `speed` takes turns and prints medians. A mesh of hertz.geo in a file is for machines without gmsh.
"""

import argparse
import csv
import json
import os
import shlex
import statistics
import subprocess
import sys
import tempfile

ENERGY, PRESSURE, REPEATED = 1e-10, 1e-8, 1e-11  # largest relative differences: J, pressures; of a repeated run, both
CG = 4.0 / 3  # largest ratio of CG iterations: aggregates differ between backends
FEW_CG = 3  # iterations, a difference that says nothing
PHASES = ["mesh", "assembly", "prediction", "setup", "solve", "total"]
INPUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "input")


def cases(hertz_mesh):
    """name: arguments of rpc"""
    for n in (64, 128):
        for xi in ("2", "16", "inf"):
            yield "beam %d, xi = %s" % (n, xi), beam(n, xi)
    mesh = ["--set=Mesh->File=" + os.path.abspath(hertz_mesh)] if hertz_mesh else []
    yield "hertz", ["--input=" + os.path.join(INPUT, "hertz.xml"), *mesh]
    yield "manufactured", ["--input=" + os.path.join(INPUT, "manufactured.xml")]


def beam(n, xi):
    return ["--input=" + os.path.join(INPUT, "beam.xml"), "--set=Mesh->Cells={%d,%d}" % (5 * n, n),
            "--set=Contact->Yield Stress=" + xi]


def execute(command, arguments):
    """The summary, with the contact pressures."""
    with tempfile.TemporaryDirectory() as folder:
        words = shlex.split(command)
        environment = dict(os.environ)
        while "=" in words[0]:
            name, value = words.pop(0).split("=", 1)
            environment[name] = value
        done = subprocess.run([*words, *arguments, "--output=" + folder, "--set=Output->Exodus=false"], env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit("%s\nexit code %d of: %s %s" % (done.stdout, done.returncode, command, shlex.join(arguments)))
        files = {os.path.splitext(name)[1]: os.path.join(folder, name) for name in os.listdir(folder)}
        with open(files[".json"]) as file:
            result = json.load(file)
        with open(files[".csv"]) as file:
            result["pressure"] = [float(row["pressure"]) for row in csv.DictReader(file)]
    return result


def run(arguments):
    changes = ["--set=" + text for text in arguments.set]
    for name, command in arguments.programs:
        results = {case: [execute(command, [*words, *changes]) for _ in range(1 + arguments.repeats)]
                   for case, words in cases(arguments.hertz_mesh)}
        os.makedirs(os.path.join(arguments.output, name), exist_ok=True)
        with open(os.path.join(arguments.output, name, "results.json"), "w") as file:
            json.dump({"command": command, "changes": changes, "cases": results}, file)
        print("%s: %d scenes, %d runs of each" % (name, len(results), 1 + arguments.repeats), flush=True)
    return 0


def difference(a, b):
    """Of energies and of pressures, relative."""
    largest = max(abs(p) for p in b["pressure"])
    return (abs(a["energy_J"] - b["energy_J"]) / abs(b["energy_J"]),
            max(abs(p - q) for p, q in zip(a["pressure"], b["pressure"], strict=True)) / largest)


def compare(arguments):
    def load(name):
        with open(os.path.join(arguments.output, name, "results.json")) as file:
            results = json.load(file)
        return results["cases"], results["changes"]

    reference, changes = load(arguments.reference)
    bad = 0
    print("| scene | backend | J | dJ | dp | Uzawa | Newton | CG | %s | repeats differ by | |" % arguments.reference)
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name in arguments.programs:
        results, own_changes = load(name)
        if own_changes != changes:
            sys.exit("%s ran with %s, %s with %s: not the same decks" % (name, own_changes, arguments.reference, changes))
        for case, runs in results.items():
            one, other = runs[0], reference[case][0]
            energy, pressure = difference(one, other)
            repeated = max((max(difference(again, one)) for again in runs[1:]), default=None)
            counts_equal = all(again[key] == other[key] for again in runs for key in ("uzawa_iterations", "newton_iterations"))
            most, most_other = max(one["linear_iterations"]), max(other["linear_iterations"])
            good = (energy <= ENERGY and pressure <= PRESSURE and counts_equal and (repeated or 0) <= REPEATED
                    and (most <= CG * most_other or most - most_other <= FEW_CG))
            bad += not good
            print("| %s | %s | %.11g | %.1e | %.1e | %d | %s | %d | %d | %s | %s |"
                  % (case, name, one["energy_J"], energy, pressure, one["uzawa_iterations"],
                     " ".join(map(str, one["newton_iterations"])), most, most_other,
                     "" if repeated is None else "%.1e (%d runs)" % (repeated, len(runs)), "ok" if good else "FAIL"))
    return 1 if bad else 0


def speed(arguments):
    words = beam(arguments.cells, arguments.yield_stress)
    for _, command in arguments.programs:
        execute(command, beam(32, "16"))  # file caches, GPU code
    seconds = {name: [] for name, _ in arguments.programs}
    counts = {}
    for _ in range(arguments.repeats):
        for name, command in arguments.programs:
            result = execute(command, words)
            seconds[name].append([result["seconds"][phase] for phase in PHASES])
            counts[name] = (result["dofs"], sum(result["linear_iterations"]))
    print("| 1/h = %d, xi = %s | dofs | CG | %s |" % (arguments.cells, arguments.yield_stress, " | ".join(PHASES)))
    print("|---" * (3 + len(PHASES)) + "|")
    medians = {name: [statistics.median(column) for column in zip(*rows)] for name, rows in seconds.items()}
    for name, row in medians.items():
        print("| %s | %d | %d | %s |" % (name, *counts[name], " | ".join("%.3f s" % value for value in row)))
    first, *others = medians.items()
    for name, row in others:
        ratios = " | ".join("%.2f" % (one / value) if value > 0 else "" for one, value in zip(first[1], row))
        print("| %s over %s | | | %s |" % (first[0], name, ratios))
    return 0


def program(text):
    name, _, command = text.partition("=")
    if not command:
        raise argparse.ArgumentTypeError("must be NAME=COMMAND, got " + text)
    return name, command


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    for work in (run, compare, speed):
        command = commands.add_parser(work.__name__)
        command.set_defaults(work=work)
        command.add_argument("programs", nargs="+", type=str if work is compare else program)
        if work is not speed:
            command.add_argument("--output", required=True)
        if work is compare:
            command.add_argument("--reference", required=True)
        if work is run:
            command.add_argument("--hertz-mesh")
            command.add_argument("--set", action="append", default=[])
        if work is not compare:
            command.add_argument("--repeats", type=int, default=0 if work is run else 3)
        if work is speed:
            command.add_argument("--cells", type=int, default=256)
            command.add_argument("--yield-stress", default="16")
    arguments = parser.parse_args()
    return arguments.work(arguments)


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""Random rough surfaces, pressed from the first touch to nearly full contact, let go, and slid.

    python3 rough.py --rpc=build/rpc [--seed=1] [--surfaces=12] [--cells=64,64,16] [--kinds=mirrored,pressed,forced,released,slid] [--first=0]
                     [--only=K] [--jobs=2] [--keep=DIR] [--seconds=S] [--folder=DIR] [--seen-as=DIR]

Surface K is self-affine, of the seed seed + K. The kinds take turns; E* = 1 but for the kinds with a Poisson's ratio of their own.

- mirrored: Hurst exponent 0.8, waves from 4 a period to a quarter of the nodes, a root mean square of slopes of 0.1. A block of a quarter of the period
  between planes of symmetry lies on it; its far side is moved by displacements, in eight load steps. The yield stress is infinite, 0.3 and 0.1 of E* times
  the slope, in turn.

The others are periodic boxes, of one period along x and y. Drawn are Hurst exponent, lowest wave number, slope, Poisson's ratio, depth, and whether contact
acts along the mean plane's normal or along the normals of the surface.

- pressed: the far side is moved by displacements, from the first touch to nearly full contact; the yield stress is drawn from 0.03 of E* times the slope to
  infinity.
- forced: the far side bears a pressure that rises up to nearly full contact; the yield stress is from 1.02 times the highest mean pressure to infinity.
- released: like pressed, with a finite yield stress; then the body is let go, pressed again deeper, and let go till it is free.
- slid: like pressed, with friction and mostly a yield stress; then the far side slides along a drawn direction, back, and comes up while it slides.

Told are Newton steps and linear iterations of the load steps, those on coarser meshes left out, and the share of the side that touches. A surface fails if
its run does not end as it should, or a load step takes more than 20 Newton steps (of a step that was divided, in each of its parts on the average). The exit
code is 1 if a surface failed, or the median of Newton steps of load steps is above 8.

The program may be several words, such as "mpiexec -n 2 build/rpc" or "chroot DIR /rpc", whose files then lie in a folder that it sees under another name:
--folder=DIR/tmp --seen-as=/tmp. Where commands have a time limit, --seconds=S starts no surface later than that; the number to go on with, --first, is told.
Takes no packages of Python.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from friction_coefficients import written

SLOPE, MODULUS, POISSON = 0.1, 0.91, 0.3  # E* = E/(1 - nu^2) = 1
YIELDS = [math.inf, 0.3, 0.1]  # of E* times the slope
HALF, HEIGHT = 0.5, 0.25  # of the period 1, of the block
# Of the whole way. With the first few per cent the highest peaks alone touch.
WAY = [0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0]
SQUEEZED = 0.15  # the strain of an elastic block at nearly full contact; mean pressures are then some 1.5 E* times the slope
MOST_STEPS, MOST_MEDIAN = 20, 8
KINDS = ("mirrored", "pressed", "forced", "released", "slid")


def course(values):
    """An expression that has the k-th value at t = k + 1."""
    path = "0"
    for number, value in reversed(list(enumerate(values))):
        path = f"t < {number + 1.5} ? {value!r} : ({path})"
    return path


def deck(cells, heights, yield_stress, file):
    """A block that is pressed on a map. @param heights  the lowest and the highest [m]"""
    way = heights[1] - heights[0] + (SQUEEZED * HEIGHT if math.isinf(yield_stress) else 0)
    path = course([-share * way for share in WAY])
    law = {} if math.isinf(yield_stress) else {"Yield Stress": yield_stress}
    return {
        "Mesh": {"Lower": [0.0, 0.0, 0.0], "Upper": [HALF, HALF, HEIGHT], "Cells": cells},
        "Material": {"Young's Modulus": MODULUS, "Poisson's Ratio": POISSON},
        "Dirichlet": {"left": {"X": 0.0}, "right": {"X": 0.0}, "bottom": {"Y": 0.0}, "top": {"Y": 0.0}, "front": {"Z": path}},
        "Contact": {"Side": "back", "Normal": "0, 0, -1", **law,
                    "Obstacle": {"Type": "height map", "File": file, "Spacing X": HALF / cells[0], "Periodic": True,
                                 "Origin": [0.0, 0.0, -heights[1]], "Normal": [0.0, 0.0, 1.0]}},
        "Steps": {"Times": [float(k + 1) for k in range(len(WAY))]},
        "Output": {"Exodus": False},
    }


def drawn(kind, seed, number, cells):
    """(what is drawn of a periodic box, parameters of its surface)"""
    draw = random.Random(f"{seed} {number} {kind}")
    scene = {"nu": draw.choice([0.0, 0.3, 0.45]), "depth": draw.choice([0.125, 0.25, 0.5]), "own normals": draw.random() < 0.3,
             "slope": 10 ** draw.uniform(-2, -0.5), "share": draw.choice([math.inf, 10 ** draw.uniform(-1.5, 0)]),
             "friction": draw.choice([0.1, 0.3, 0.6, 1.0]), "direction": draw.uniform(0, 2 * math.pi), "times": draw.choice([1.02, 1.2, 2.0, 5.0, math.inf])}
    if kind == "released" and math.isinf(scene["share"]):
        scene["share"] = 0.3
    for other in {"forced": ("share",), "slid": ("times",)}.get(kind, ("times",)) + (() if kind == "slid" else ("friction", "direction")):
        del scene[other]
    lowest = draw.choice([1, 2, 4])
    surface = {"Points": cells[0], "Hurst Exponent": draw.choice([0.3, 0.8, 1.0]), "Lowest Wave Number": lowest,
               "Highest Wave Number": max(lowest, cells[0] // draw.choice([4, 8])), "RMS Slope": scene["slope"]}
    return scene, surface


def periodic_deck(kind, scene, cells, heights, file):
    """A periodic box on a map. @param heights  the lowest and the highest [m]"""
    nu, depth, slope = scene["nu"], scene["depth"], scene["slope"]
    range_of_heights = heights[1] - heights[0]
    share = scene.get("share", math.inf)
    way = range_of_heights + (1.5 * slope * depth if math.isinf(share) else 0)
    law, far = {}, {"X": 0.0, "Y": 0.0}
    if not math.isinf(share):
        law["Yield Stress"] = share * slope
    contact = {"Side": "back", **({} if scene["own normals"] else {"Normal": "0, 0, -1"})}
    loads = {}
    if kind == "forced":
        shares = [0.001, 0.01, 0.05, 0.2, 0.4, 0.7, 1.0]
        highest = 1.5 * slope  # nearly full contact of an elastic body
        if not math.isinf(scene["times"]):
            highest = 0.3 * slope
            law["Yield Stress"] = scene["times"] * highest
        loads = {"Traction": {"front": {"Z": course([-share * highest for share in shares])}}}
        count = len(shares)
    else:
        shares = {"pressed": WAY, "released": [0.1, 0.3, 0.6, 0.5, 0.3, 0.0, 0.6, 0.9, 0.7, 0.4, -0.1],
                  "slid": [0.05, 0.15, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.15, 0.05]}[kind]
        count = len(shares)
        far["Z"] = course([-share * way for share in shares])
        if kind == "slid":
            law["Friction Coefficient"] = scene["friction"]
            step = 0.5 * scene["friction"] * slope * depth  # about what lets all of it slip
            along = [step * share for share in (0, 0, 0, 0.1, 0.4, 1.5, 0.5, -1.0, -1.5, -2.0)]
            far["X"] = course([math.cos(scene["direction"]) * u for u in along])
            far["Y"] = course([math.sin(scene["direction"]) * u for u in along])
    return {
        "Mesh": {"Lower": [0.0, 0.0, 0.0], "Upper": [1.0, 1.0, depth], "Cells": cells, "Periodic": "X, Y"},
        "Material": {"Young's Modulus": 1 - nu**2, "Poisson's Ratio": nu},
        "Dirichlet": {"front": far},
        **loads,
        "Contact": {**contact, **law, "Obstacle": {"Type": "height map", "File": file, "Spacing X": 1.0 / cells[0], "Periodic": True,
                                                   "Origin": [0.0, 0.0, -heights[1]], "Normal": [0.0, 0.0, 1.0]}},
        "Steps": {"Times": [float(k + 1) for k in range(count)]},
        "Output": {"Exodus": False},
    }


def starts(row, name):
    return float(next(value for key, value in row.items() if key.startswith(name)))


def judge(options, number, cells, kinds):
    """(complaint or None, what happened, Newton steps of the load steps); None where it is too late to start"""
    if time.monotonic() > options.start + options.seconds:
        return None
    seed, keep = options.seed, options.keep
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rpc_rough_", dir=options.folder))
    inside = pathlib.PurePosixPath(options.seen_as) / folder.name if options.seen_as else folder
    kind = kinds[number % len(kinds)]
    try:
        if kind == "mirrored":
            points = 2 * cells[0]
            given = {"Points": points, "Lowest Wave Number": 4, "Highest Wave Number": points // 4, "RMS Slope": SLOPE, "Symmetric": "true"}
        else:
            scene, given = drawn(kind, seed, number, cells)
        given["Seed"] = seed + number
        made = subprocess.run([*options.rpc, f"--make-surface={inside / 'made.npy'}"] + [f"--set={name}={value}" for name, value in given.items()], capture_output=True, text=True, check=True)
        heights = [float(h) for h in re.search(r"heights from (\S+) to (\S+),", made.stdout).groups()]
        if kind == "mirrored":
            share = YIELDS[number // len(kinds) % len(YIELDS)]
            of, area = deck(cells, heights, share * SLOPE, "made.npy"), HALF**2
            told = f"yield stress {share:g} E* slope"
        else:
            of, area = periodic_deck(kind, scene, cells, heights, "made.npy"), 1
            told = ", ".join(f"{name} {value:.3g}" for name, value in {**scene, **given}.items())
        (folder / "rough.yaml").write_text("rough:\n" + written(of))
        result = subprocess.run([*options.rpc, f"--input={inside / 'rough.yaml'}", f"--output={inside}"], capture_output=True, text=True, errors="replace", check=False, stdin=subprocess.DEVNULL)
        if result.returncode != 0:
            return f"{kind}, {told}: exit {result.returncode}: {result.stderr.strip()[-300:]}", "", []
        summary = json.loads((folder / "rough.json").read_text())
        rows = list(csv.DictReader((folder / "rough.history.csv").open()))
        steps = summary["steps"]
        newton = [step["newton_iterations"] for step in steps]
        krylov = [step["linear_iterations"] for step in steps]
        parts = [int(float(row["parts"])) for row in rows]
        areas = [starts(row, "contact_area") / area for row in rows]
        forces = [abs(starts(row, "contact_force_z")) / area for row in rows]
        worst = max(n / p for n, p in zip(newton, parts))
        what = (f"{kind}, {told}: Newton {newton}, linear iterations {krylov}, {'parts ' + str(parts) + ', ' if max(parts) > 1 else ''}area "
                f"{[round(each, 4) for each in areas]}, mean pressure {forces[0]:.3g} to {max(forces):.3g}, {summary['seconds']['total']:.0f} s")
        return (f"{worst:g} Newton steps: {what}" if worst > MOST_STEPS else None), what, newton
    finally:
        if keep:
            shutil.copytree(folder, pathlib.Path(keep) / str(number), dirs_exist_ok=True)
        shutil.rmtree(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--surfaces", type=int, default=12)
    parser.add_argument("--cells", default="64,64,16", help="along both directions of the side, the same number, and through the block")
    parser.add_argument("--kinds", default=",".join(KINDS), help="that take turns")
    parser.add_argument("--first", type=int, default=0, help="number of the first surface")
    parser.add_argument("--only", type=int, help="number of the only surface")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="folder for the files of all surfaces")
    parser.add_argument("--seconds", type=float, default=math.inf, help="after which no surface is started")
    parser.add_argument("--folder", help="for the files of a run, in place of the system's folder for temporary ones")
    parser.add_argument("--seen-as", help="what the program calls that folder")
    options = parser.parse_args()
    if options.seen_as and not options.folder:
        parser.error("--seen-as takes --folder, which it names anew")
    words = shlex.split(options.rpc)
    options.rpc = [os.path.abspath(words[0])] if len(words) == 1 else words
    options.start, failed, counts, done = time.monotonic(), 0, [], 0
    cells = [int(n) for n in options.cells.split(",")]
    kinds = options.kinds.split(",")
    if unknown := [kind for kind in kinds if kind not in KINDS]:
        parser.error(f"--kinds: there is no kind {unknown[0]}; there are {', '.join(KINDS)}")
    numbers = range(options.first, options.first + options.surfaces) if options.only is None else [options.only]
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for number, judged in zip(numbers, pool.map(lambda k: judge(options, k, cells, kinds), numbers)):
            if judged is None:
                print(f"{options.seconds:g} s are over; go on with --first={number}")
                break
            complaint, what, newton = judged
            done += 1
            failed += complaint is not None
            counts += newton
            print(f"{number}: {'FAILED ' + complaint if complaint else what}", flush=True)
    median = statistics.median(counts) if counts else 0
    print(f"{failed} of {done} failed; Newton steps of {len(counts)} load steps: median {median:g}, most {max(counts, default=0)}")
    return 1 if failed or median > MOST_MEDIAN else 0


if __name__ == "__main__":
    sys.exit(main())

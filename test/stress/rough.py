# SPDX-License-Identifier: BSD-3-Clause
"""Random rough surfaces, pressed from the first touch to nearly full contact.

    python3 rough.py --rpc=build/rpc [--seed=1] [--surfaces=12] [--cells=64,64,16] [--only=K] [--jobs=2] [--keep=DIR]

Surface K is self-affine, of the seed seed + K: Hurst exponent 0.8, waves from 4 a period to a quarter of the nodes, a root mean square of slopes of 0.1.
A block of a quarter of the period between planes of symmetry lies on it, E* = 1; its far side is moved by displacements, in eight load steps. The yield
stress is infinite, 0.3 and 0.1 of E* times the slope, in turn. Told are Newton steps and linear iterations of the load steps, those on coarser
meshes left out, and the share of the side that touches. A surface fails if its run does not end as it should, or a load step takes more than
20 Newton steps. The exit code is 1 if a surface failed, or the median of Newton steps of load steps is above 8.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

from friction_coefficients import written

SLOPE, MODULUS, POISSON = 0.1, 0.91, 0.3  # E* = E/(1 - nu^2) = 1
YIELDS = [math.inf, 0.3, 0.1]  # of E* times the slope
HALF, HEIGHT = 0.5, 0.25  # of the period 1, of the block
# Of the whole way. With the first few per cent the highest peaks alone touch.
WAY = [0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0]
SQUEEZED = 0.15  # the strain of an elastic block at nearly full contact; mean pressures are then some 1.5 E* times the slope
MOST_STEPS, MOST_MEDIAN = 20, 8


def deck(cells, heights, yield_stress, file):
    """A block that is pressed on a map. @param heights  the lowest and the highest [m]"""
    way = heights[1] - heights[0] + (SQUEEZED * HEIGHT if math.isinf(yield_stress) else 0)
    path = "0"
    for number, share in reversed(list(enumerate(WAY))):
        path = f"t < {number + 1.5} ? {-share * way!r} : ({path})"
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


def judge(rpc, seed, number, cells, keep):
    """(complaint or None, what happened, Newton steps of the load steps)"""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rpc_rough_"))
    try:
        points = 2 * cells[0]
        given = {"Points": points, "Lowest Wave Number": 4, "Highest Wave Number": points // 4, "RMS Slope": SLOPE, "Symmetric": "true", "Seed": seed + number}
        made = subprocess.run([rpc, f"--make-surface={folder / 'made.npy'}"] + [f"--set={name}={value}" for name, value in given.items()], capture_output=True, text=True, check=True)
        heights = [float(h) for h in re.search(r"heights from (\S+) to (\S+),", made.stdout).groups()]
        share = YIELDS[number % len(YIELDS)]
        (folder / "rough.yaml").write_text("rough:\n" + written(deck(cells, heights, share * SLOPE, "made.npy")))
        result = subprocess.run([rpc, f"--input={folder / 'rough.yaml'}", f"--output={folder}"], capture_output=True, text=True, errors="replace", check=False, stdin=subprocess.DEVNULL)
        if result.returncode != 0:
            return f"exit {result.returncode}: {result.stderr.strip()[-300:]}", "", []
        summary = json.loads((folder / "rough.json").read_text())
        rows = list(csv.DictReader((folder / "rough.history.csv").open()))
        steps = summary["steps"]
        newton = [step["newton_iterations"] for step in steps]
        krylov = [step["linear_iterations"] for step in steps]
        areas = [float(next(value for key, value in row.items() if key.startswith("contact_area"))) / HALF**2 for row in rows]
        forces = [abs(float(next(value for key, value in row.items() if key.startswith("front_reaction_z")))) / HALF**2 for row in rows]
        what = (f"yield stress {share:g} E* slope: Newton {newton}, linear iterations {krylov}, area "
                f"{[round(area, 4) for area in areas]}, mean pressure {forces[0]:.3g} to {forces[-1]:.3g}")
        worst = max(newton)
        return (f"{worst} Newton steps: {what}" if worst > MOST_STEPS else None), what, newton
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
    parser.add_argument("--only", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="folder for the files of all surfaces")
    options = parser.parse_args()
    rpc, failed, counts = os.path.abspath(options.rpc), 0, []
    cells = [int(n) for n in options.cells.split(",")]
    numbers = range(options.surfaces) if options.only is None else [options.only]
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for number, (complaint, what, newton) in zip(numbers, pool.map(lambda k: judge(rpc, options.seed, k, cells, options.keep), numbers)):
            failed += complaint is not None
            counts += newton
            print(f"{number}: {'FAILED ' + complaint if complaint else what}", flush=True)
    median = statistics.median(counts) if counts else 0
    print(f"{failed} of {len(numbers)} failed; Newton steps of {len(counts)} load steps: median {median:g}, most {max(counts, default=0)}")
    return 1 if failed or median > MOST_MEDIAN else 0


if __name__ == "__main__":
    sys.exit(main())

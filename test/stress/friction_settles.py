# SPDX-License-Identifier: BSD-3-Clause
"""Friction states that once did not settle: each step must be solved in one part, within a number of Newton steps.

    python3 friction_settles.py --rpc=build/rpc

Histories of friction_histories.py by seed and number, a slender block that is lifted with mu = 1.75, and a block with a bound of friction that a
coarser mesh predicts not to touch. The exit code is 1 if one takes more.
"""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import friction_histories
import scenes
from trials import written

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "regression"))

from sheared import SHEARED  # noqa: E402

HISTORIES = {  # (seed, number): (most Newton steps of a step, what was wrong)
    (71779, 162): (15, "plane, a corner: what penalties left of a node's distance from one side was slip along the other (144 steps in 9 parts)"),
    (71779, 123): (20, "space, a point that cannot stick: its multiplier lagged behind the direction of its slip (107 steps)"),
    (90419, 123): (15, "plane: choices after a multiplier update counted r v twice (18 steps)"),
    (90419, 627): (15, "plane, a point that cannot stick: it could not turn (28 steps in 3 parts)"),
    (90428, 123): (11, "space: directions of slip took a linear solve for each turn (13 steps)"),
    (90426, 68): (15, "space, points on springs that stick by the lever of a slanted normal (5331 steps in 125 parts)"),
}
TIP = {  # pressed on the tip of a cone, between the nodes of a mesh of one cell, whose multipliers are rounding: no force to measure residuals by
    "Mesh": {"Lower": [0.0, 0.0, 0.0], "Upper": [1.9112547801400042, 1.0, 0.8610006452648495], "Cells": [5, 4, 4], "Element": "Q1"},
    "Material": {"Young's Modulus": 5118.426967911833, "Poisson's Ratio": 0.497036100325908},
    "Dirichlet": {"top": {"X": 0.0, "Y": -0.002671483184917161, "Z": 0.0}},
    "Contact": {"Side": "bottom", "Friction Bound": 2.184701318144199, "Normal": "0.0, -1.0, 0.0",
                "Gap": "0.007221390985594185*sqrt((x - 0.5905393681645565)^2 + (z - 0.5543901101392705)^2)"},
    "Output": {"Exodus": False},
    "Steps": {"Times": [1.0]},
}
TIP_STEPS = 8  # 12 and a sweep
BLOCK_STEPS = 32  # of two attempts, the second one from rest; 223 in 13 parts without that one


def complaints(rpc, folder, deck, most):
    run = subprocess.run([rpc, f"--input={deck}"], cwd=folder, capture_output=True, text=True, errors="replace", check=False, timeout=300,
                         stdin=subprocess.DEVNULL)
    if run.returncode != 0:
        return [f"exit {run.returncode}: {(run.stderr or run.stdout).strip()[-300:]}"]
    steps = json.loads((folder / pathlib.Path(deck).with_suffix(".json")).read_text())["steps"]
    return [f"{s['newton_iterations']} Newton steps in {s['parts']} parts at t = {s['time']}" for s in steps
            if s["parts"] != 1 or s["newton_iterations"] > most]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    rpc, failed = os.path.abspath(parser.parse_args().rpc), 0
    for (seed, number), (most, what) in HISTORIES.items():
        with tempfile.TemporaryDirectory(prefix="rpc_settles_") as name:
            folder = pathlib.Path(name)
            scenes.write(friction_histories.make(random.Random(f"{seed}/friction history/{number}"))[1], folder)
            for complaint in complaints(rpc, folder, "scene.xml", most):
                failed += 1
                print(f"FAILED seed {seed}, history {number}, {what}: {complaint}")
    with tempfile.TemporaryDirectory(prefix="rpc_settles_") as name:
        folder = pathlib.Path(name)
        (folder / "sheared.yaml").write_text(SHEARED)
        for complaint in complaints(rpc, folder, "sheared.yaml", BLOCK_STEPS):
            failed += 1
            print(f"FAILED the block: {complaint}")
    with tempfile.TemporaryDirectory(prefix="rpc_settles_") as name:
        folder = pathlib.Path(name)
        (folder / "tip.yaml").write_text("tip:\n" + written(TIP))
        for complaint in complaints(rpc, folder, "tip.yaml", TIP_STEPS):
            failed += 1
            print(f"FAILED the tip: {complaint}")
    print(f"{failed} steps of friction take more than they may")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

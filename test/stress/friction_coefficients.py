# SPDX-License-Identifier: BSD-3-Clause
"""Friction coefficients from 0 to 3 on a beam, a cantilever and a gripped strip, on rigid foundations and on some that yield.

    python3 friction_coefficients.py --rpc=build/rpc [--values=60] [--most=3] [--scene=NAME] [--jobs=2]

The cantilever is pressed and pushed along the foundation; the strip is gripped between two foundations and pulled, step by step, to and fro. Prints what
fails (an exit code that is not 0, residuals above 1e-8), steps that were divided, and steps of more than 20 Newton steps. The exit code is 1 if there
is any of these.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from trials import written

MOST_NEWTON, TOLERANCE = 20, 1e-8
RESIDUALS = ("kkt_residual", "equilibrium_residual", "energy_balance", "duality_gap")
CLAMPED = {"X": 0.0, "Y": 0.0}
MATERIAL = {"Young's Modulus": 1000.0, "Poisson's Ratio": 0.3}
BEAM = {
    "Mesh": {"Lower": [0.0, 0.0], "Upper": [5.0, 1.0], "Cells": [80, 16], "Element": "Q1"},
    "Material": {"Young's Modulus": 2000.0, "Poisson's Ratio": 0.3},
    "Dirichlet": {"left": CLAMPED, "right": CLAMPED},
    "Traction": {"top": {"Y": "-20*sin(pi*x/5)"}},
    "Contact": {"Side": "bottom"},
}
CANTILEVER = {
    "Mesh": {"Lower": [0.0, 0.0], "Upper": [3.0, 1.0], "Cells": [48, 16], "Element": "Q1"},
    "Material": MATERIAL,
    "Dirichlet": {"left": CLAMPED},
    "Traction": {"top": {"Y": "-4", "X": "2"}},
    "Contact": {"Side": "bottom", "Gap": "0.002*(x - 1.5)^2"},
}
STRIP = {
    "Mesh": {"Lower": [0.0, 0.0], "Upper": [4.0, 1.0], "Cells": [40, 10], "Element": "Q2"},
    "Material": MATERIAL,
    "Dirichlet": {"right": {"X": "0.02*(t < 1 ? 0 : t < 3 ? t - 1 : t < 6 ? 5 - t : t - 7)", "Y": 0.0}},
    "Contact": {"Side": "bottom", "Gap": "-0.004 + (x > 2)*0.01", "Sides": {"other": {"Side": "top", "Gap": "-0.004 + (x > 2)*0.01"}}},
    "Steps": {"Times": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]},
}
SCENES = {"beam": (BEAM, 16.0), "cantilever": (CANTILEVER, 8.0), "strip": (STRIP, 5.0)}  # and a yield stress [Pa]


def sides(deck):
    return [deck["Contact"], *deck["Contact"].get("Sides", {}).values()]


def scene(name, coefficient, yields):
    """The deck of a scene."""
    given, stress = SCENES[name]
    deck = json.loads(json.dumps(given))
    for side in sides(deck):
        side["Friction Coefficient"] = coefficient
        if yields:
            side["Yield Stress"] = stress
    deck["Output"] = {"Exodus": False, "CSV": False}
    return deck


def run(rpc, name, coefficient, yields):
    """(what is to be complained of, the largest number of Newton steps of a step)"""
    with tempfile.TemporaryDirectory(prefix="rpc_friction_") as folder:
        deck = pathlib.Path(folder) / "scene.yaml"
        deck.write_text("scene:\n" + written(scene(name, coefficient, yields)))
        result = subprocess.run([rpc, f"--input={deck}", f"--output={folder}"], capture_output=True, text=True, errors="replace", check=False,
                                stdin=subprocess.DEVNULL, timeout=300)
        path = pathlib.Path(folder) / "scene.json"
        if result.returncode != 0 or not path.exists():
            reason = json.loads(path.read_text()).get("reason") if path.exists() else None
            return [f"exit {result.returncode}: {reason or result.stderr.strip()[-300:]}"], 0
        summary = json.loads(path.read_text())
    complaints = [f"{key} {summary[key]}" for key in RESIDUALS if not summary[key] <= TOLERANCE]
    steps = summary.get("steps") or [{"time": 0, "parts": 1, "newton_iterations": sum(summary["newton_iterations"])}]
    for step in steps:
        if step["parts"] != 1:
            complaints.append(f"{step['parts']} parts at t = {step['time']}")
        if step["newton_iterations"] > MOST_NEWTON:
            complaints.append(f"{step['newton_iterations']} Newton steps at t = {step['time']}")
    return complaints, max(step["newton_iterations"] for step in steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--values", type=int, default=60)
    parser.add_argument("--most", type=float, default=3.0)
    parser.add_argument("--scene", choices=SCENES)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    rpc, failed, most = os.path.abspath(options.rpc), 0, {}
    cases = [(name, options.most * k / max(options.values - 1, 1), yields) for name in SCENES if options.scene in (None, name)
             for yields in (False, True) for k in range(options.values)]
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for case, (complaints, steps) in zip(cases, pool.map(lambda case: run(rpc, *case), cases)):
            name, coefficient, yields = case
            if complaints:
                failed += 1
                foundation = "yielding" if yields else "rigid"
                print(f"FAILED {name}, {foundation}, mu = {coefficient:.6g}: {'; '.join(complaints)}", flush=True)
            most[name] = max(most.get(name, 0), steps)
    print(f"{failed} of {len(cases)} failed; most Newton steps of a step: " + ", ".join(f"{name} {steps}" for name, steps in most.items()))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

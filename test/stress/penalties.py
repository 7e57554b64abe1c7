# SPDX-License-Identifier: BSD-3-Clause
"""The paper's beam over yield stresses and penalties: the iteration may cost more, the solution must not change.

    python3 penalties.py --rpc=build/rpc [--n=32] [--out=FILE] [--jobs=2] [--input=beam.xml]

Writes a Markdown table: rows xi, columns r, entries Newton steps/Uzawa iterations, then the largest difference of J from that of
r = auto, relative to max(|J|, strain energy). The exit code is 1 if a run does not converge, if J differs by more than 1e-9, or
if r = auto takes more than 10 Newton steps.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PENALTIES = ["auto", "1e2", "1e4", "1e6", "1e8", "1e10", "1e12"]  # [Pa/m]
YIELD_STRESSES = [10 ** (-3 + 9 * k / 39) for k in range(40)]  # [Pa]
MOST_DIFFERENCE, MOST_NEWTON = 1e-9, 10
BEAM = pathlib.Path(__file__).resolve().parents[2] / "input" / "beam.xml"


def solve(options, xi, penalty):
    """The JSON summary, or an empty one with the reason."""
    settings = {"Mesh->Cells": "{%d, %d}" % (5 * options.n, options.n), "Contact->Yield Stress": repr(xi),
                "Contact->Penalty": penalty, "Output->Exodus": "false", "Output->CSV": "false"}
    with tempfile.TemporaryDirectory(prefix="rpc_penalty_") as folder:
        command = [options.rpc, f"--input={options.input}", f"--output={folder}"] + [f"--set={k}={v}" for k, v in settings.items()]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False, stdin=subprocess.DEVNULL)
        path = pathlib.Path(folder) / (pathlib.Path(options.input).stem + ".json")
        if not path.exists():
            return {"converged": False, "reason": f"exit {result.returncode}: {result.stderr.strip()[-200:]}"}
        return json.loads(path.read_text())


def row(xi, runs, failures):
    """A line of the table; what is wrong in it goes to failures."""
    entries, worst = [], 0.0
    reference = runs["auto"]
    for penalty, run in runs.items():
        where = f"xi = {xi:.4g}, r = {penalty}"
        if not run["converged"]:
            failures.append(f"{where}: {run['reason']}")
            entries.append("-")
            continue
        newton = sum(run["newton_iterations"])
        entries.append(f"{newton}/{run['uzawa_iterations']}")
        if penalty == "auto" and newton > MOST_NEWTON:
            failures.append(f"{where}: {newton} Newton steps")
        if reference["converged"]:
            scale = max(abs(reference["energy_J"]), reference["energy_norm_squared"])
            difference = abs(run["energy_J"] - reference["energy_J"]) / scale
            worst = max(worst, difference)
            if difference > MOST_DIFFERENCE:
                failures.append(f"{where}: J differs by {difference:.1e}")
    return f"| {xi:.4g} | " + " | ".join(entries) + f" | {worst:.0e} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--n", type=int, default=32, help="1/h")
    parser.add_argument("--input", default=str(BEAM))
    parser.add_argument("--out", help="file for the table")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    options.rpc = os.path.abspath(options.rpc)
    lines, failures = ["| xi [Pa] | " + " | ".join(f"r = {r}" for r in PENALTIES) + " | difference of J |",
                       "|---" * (len(PENALTIES) + 2) + "|"], []
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        pending = {(xi, r): pool.submit(solve, options, xi, r) for xi in YIELD_STRESSES for r in PENALTIES}
        for xi in YIELD_STRESSES:
            lines.append(row(xi, {r: pending[xi, r].result() for r in PENALTIES}, failures))
            print(lines[-1], file=sys.stderr, flush=True)
    text = "\n".join(lines) + "\n"
    if options.out:
        pathlib.Path(options.out).write_text(text)
    else:
        print(text, end="")
    for failure in failures:
        print(f"FAILED {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

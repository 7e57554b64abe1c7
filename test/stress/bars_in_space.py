# SPDX-License-Identifier: BSD-3-Clause
"""Random bodies in space whose first mesh misses the contact, or whose error bars theory does not promise: the bars hold the true values, or are
null with a reason, and no mesh but the first has more unknowns than allowed.

    python3 bars_in_space.py --rpc=build/rpc [--seed=1] [--scenes=100] [--only=K] [--kind=NAME] [--jobs=2] [--np=1] [--keep=DIR]

Scene K comes from the seed and K alone: a box of hexahedra or tetrahedra, or a body with re-entrant edges, pressed on a foundation with one of the
features of KINDS: a bump narrower than the cells of the first mesh, the tip of a cone or a pyramid, a step. The true values are those of the same
scene from a first mesh with cells half as long, of order 2, and a target a third as large. Bars are judged as bars.py does. The exit code is 1 if a
run failed, contact was missed in silence, a mesh had too many unknowns, or the force's bars held in less than 95 of 100.
"""
import json
import random
import sys

import adaptive
import bars
import trials
from generate import log_uniform

KINDS = ["bump", "cone", "pyramid", "step", "edge", "edge and cone"]
TARGETS = [0.3, 0.2, 0.15]
FINER, FINER_CELLS = 3, 2  # of references: target and first mesh
MOST_DOFS, MOST_DOFS_OF_REFERENCE = [3000, 6000, 12000], 40000
NOT_TO_THE_TARGET = 4


def bent(rng):
    """A body with a re-entrant edge: (text of a .geo, width and depth of its bottom)."""
    width, x, y, depth = rng.uniform(0.6, 1.6), rng.uniform(0.3, 0.7), rng.uniform(0.3, 0.7), rng.uniform(0.6, 1.2)
    x *= width
    if rng.random() < 0.5:  # a foot to the right
        points, names, bottom = [(0.0, 0.0), (width, 0.0), (width, y), (x, y), (x, 1.0), (0.0, 1.0)], ["bottom", "", "", "", "top", ""], width
    else:  # it overhangs
        points, names, bottom = [(0.0, 0.0), (x, 0.0), (x, y), (width, y), (width, 1.0), (0.0, 1.0)], ["bottom", "", "", "", "top", ""], x
    text = adaptive.loop(points, adaptive.lines_of(6)) + adaptive.closed(6)
    text += f"out[] = Extrude {{0, 0, {depth!r}}} {{ Surface{{1}}; }};\nPhysical Volume(\"body\") = {{out[1]}};\n"
    return text + "".join(f'Physical Surface("{name}") = {{out[{k + 2}]}};\n' for k, name in enumerate(names) if name), bottom, depth


def gap_of(rng, kind, width, depth, pressed):
    """A gap over 0 <= x <= width, 0 <= z <= depth, less than `pressed` at some point."""
    x, z = rng.uniform(0.2, 0.8) * width, rng.uniform(0.2, 0.8) * depth
    squares = f"(x - {x!r})^2 + (z - {z!r})^2"
    if kind == "bump":
        narrow = min(width, depth) * log_uniform(rng, -1.6, -0.7)
        above = pressed * rng.uniform(0.1, 0.7)  # of the foundation's flat part, its top
        return f"{above!r} + {pressed * rng.uniform(0.5, 3)!r}*(1 - exp(-({squares})/{narrow ** 2!r}))"
    slope = pressed / min(width, depth) * log_uniform(rng, -0.2, 0.8)
    if "cone" in kind:
        return f"{slope!r}*sqrt({squares})"
    if kind == "pyramid":
        return f"{slope!r}*max(abs(x - {x!r}), abs(z - {z!r}))"
    if kind == "step":
        return f"{rng.choice([f'x < {x!r}', f'z > {z!r}', f'x + z < {x + z!r}'])} ? 0 : {pressed * log_uniform(rng, -0.5, 1.5)!r}"
    return "0"


def deck(rng, kind):
    """(nested lists of the deck, text of the .geo without its size or None, that size)"""
    geo, size = None, rng.uniform(0.3, 0.5)
    if "edge" in kind:
        geo, width, depth = bent(rng)
        mesh = {"Type": "gmsh", "File": "body.geo", "Order": rng.choice([2, 2, 1])}
    else:
        width, depth = rng.uniform(0.7, 1.5), rng.uniform(0.7, 1.5)
        mesh = {"Type": "box", "Lower": [0.0] * 3, "Upper": [width, 1.0, depth], "Cells": [rng.randint(2, 4) for _ in range(3)],
                "Element": rng.choice(["P2", "P2", "Q2", "Q1", "P1"])}
    pressed = log_uniform(rng, -2.5, -1.7)
    contact = {"Side": "bottom", "Normal": "0, -1, 0", "Gap": gap_of(rng, kind, width, depth, pressed)}
    if rng.random() < 0.4:
        contact["Yield Stress"] = repr(bars.YOUNG * pressed * log_uniform(rng, 0, 0.8))
    top = {"X": "0", "Y": repr(-pressed), "Z": "0"}
    if rng.random() < 0.2:
        contact["Friction Coefficient"] = repr(rng.uniform(0.05, 0.5))
        top["X"] = repr(pressed * rng.uniform(-0.5, 0.5))
    low_order = mesh.get("Order") == 1 or mesh.get("Element") in ("P1", "Q1")
    lists = {"Mesh": mesh, "Material": {"Young's Modulus": bars.YOUNG, "Poisson's Ratio": rng.uniform(0.0, 0.45)}, "Dirichlet": {"top": top},
             "Contact": contact, "Adapt": {"Target Relative Error": rng.choice(TARGETS) * (1.5 if low_order else 1), "Max Dofs": rng.choice(MOST_DOFS)}}
    return lists, geo, size


def complaint_of(result, summary, most):
    """What is wrong with a run, or nothing."""
    if summary is None or summary.get("adaptation") is None or not summary["converged"]:
        return f"exit {result.returncode}: {result.stderr.strip()[-200:]}"
    reason = summary["adaptation"]["reason"]
    if result.returncode not in (0, NOT_TO_THE_TARGET) or (result.returncode == NOT_TO_THE_TARGET) != bool(reason):
        return f"exit {result.returncode}: {reason}"
    if max((c["dofs"] for c in summary["adaptation"]["cycles"][1:]), default=0) > most:
        return f"more than {most} unknowns: {[c['dofs'] for c in summary['adaptation']['cycles']]}"
    return ""


def judge(options, number):
    rng = random.Random(f"{options.seed}/bars in space/{number}")
    kind = options.kind or KINDS[number % len(KINDS)]
    lists, geo, size = deck(rng, kind)
    outcome = bars.Outcome(number, kind)
    with trials.folder(options, f"bars_in_space_{options.seed}_{number:04d}", lambda: outcome.complaint or outcome.note) as folder:
        try:
            results = []
            reference = bars.finer(lists, FINER, FINER_CELLS, MOST_DOFS_OF_REFERENCE)
            for output, factor, most, more in (("out", 1, lists["Adapt"]["Max Dofs"], []), ("fine", FINER_CELLS, MOST_DOFS_OF_REFERENCE, reference)):
                (folder / "scene.yaml").write_text(trials.written({"scene": lists}, 0))
                if geo:
                    (folder / "body.geo").write_text(f"S = {size / factor!r};\n" + geo)
                result, summary = adaptive.run(options, folder, output, "--set=Output->Exodus=false", *more)
                complaint = complaint_of(result, summary, most)
                if complaint:
                    outcome.complaint = f"{output}: {complaint}"
                    return outcome
                results.append(summary)
            outcome.meshes = len(results[0]["adaptation"]["cycles"])
            forces = [max(map(abs, summary["contact_force"])) for summary in results]
            if forces[0] == 0 < forces[1] and not results[0]["adaptation"]["reason"]:
                outcome.complaint = f"contact was missed: force 0, right: {results[1]['contact_force']}"
            elif forces[1] > 0:
                bars.compare(outcome, *results)
        except Exception as error:  # a run that took too long, a file that is no JSON
            outcome.complaint = f"{type(error).__name__}: {error}"[:300]
    return outcome


def main():
    options = trials.arguments(__doc__, 100, ("--kind", {"choices": KINDS}), ("--meshes", {"choices": ["automatic", "gmsh", "nested"], "default": "automatic"}))
    outcomes = []
    for o in trials.each(options, judge):
        outcomes.append(o)
        print(f"{'FAILED ' if o.complaint else '  '}{o.number} ({o.kind}, {o.meshes} meshes): {o.complaint or json.dumps(o.judged)}{o.note}", flush=True)
    failed = sum(bool(o.complaint) for o in outcomes)
    print(f"{len(outcomes)} scenes in space, seed {options.seed}, {failed} failed, {sum(bool(o.judged) for o in outcomes)} compared")
    for key in bars.QUANTITIES:
        print(f"{key}: kind, bars that hold, of those judged, null, null of one mesh, not judged, median of bar over true error")
        for kind in [*KINDS, None]:
            *counts, ratio = bars.shares([o for o in outcomes if kind in (None, o.kind)], key)
            print(f"  {kind or 'all':13}" + "".join(f" {count:4}" for count in counts) + f" {ratio:8.3g}")
    held, judged, *_ = bars.shares(outcomes, "contact_force")
    return 1 if failed or held < bars.HELD * judged else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes whose error bars theory does not promise: the bars hold the true values, or are null with a reason.

    python3 bars.py --rpc=build/rpc [--seed=1] [--scenes=100] [--only=K] [--kind=NAME] [--histories=1] [--hardening=1] [--jobs=2] [--np=1] [--keep=DIR]

Scene K comes from the seed and K alone: a body in the plane or of revolution, pressed on a foundation with one of the features of KINDS: a smooth
gap, one with a tip or a step, a friction coefficient or a yield stress with a step, a body with re-entrant corners; or with two of them. The target
for the error in the energy norm is a loose one. The true values are those of the same scene from a first mesh with cells a quarter as long, of order
2, and a target a sixth as large. A bar holds where the true value lies within it and within the bar of the reference, if there is one; a scene whose
reference is known no better than its own bar allows is not judged, and counted. With --histories=1 each scene has load steps, which press, unload,
load again or slide, on foundations of which most remember; the reference is the whole history on the finer meshes, and the last step is judged. With --hardening=1 all foundations harden. For each quantity and each kind are told how many bars hold, how
many are null, and the median of bar over true error. The exit code is 1 if a run failed or the force's bars held in less than 95 of 100.
"""
import dataclasses
import math
import random
import statistics
import sys

import adaptive
import trials
from generate import log_uniform

KINDS = ["smooth", "tip", "gap step", "mu step", "xi step", "corner", "two"]
TARGETS = [0.05, 0.03, 0.02, 0.01]
FINER, FINER_CELLS = 6, 4  # of references: target and first mesh
MOST_DOFS = 60000  # of references
MOST_DOFS_IN_STEPS = 25000
KNOWN = 0.5  # a reference's bar is at most so much of the one that is judged
HELD = 0.95
YOUNG = 1000.0
REFUSED = 5  # exit code: the scene has no solution
QUANTITIES = {"contact_force": lambda s: s["contact_force"], "energy_J": lambda s: [s["energy_J"]], "max_pressure": lambda s: [s["max_pressure"]],
              "contact_length": lambda s: [s.get("contact_length", s.get("contact_area"))], "max_penetration": lambda s: [s["max_penetration"]]}


def fork(rng):
    """Two tines below a bar: (text of a .geo, width)."""
    tine, slot, height, bar = rng.uniform(0.2, 0.5), rng.uniform(0.3, 0.8), rng.uniform(0.4, 1), rng.uniform(0.2, 0.5)
    a, b, c = tine, tine + slot, 2 * tine + slot
    points = [(0.0, 0.0), (a, 0.0), (a, height), (b, height), (b, 0.0), (c, 0.0), (c, height + bar), (0.0, height + bar)]
    text = adaptive.loop(points, adaptive.lines_of(8)) + adaptive.closed(8)
    return text + ('Physical Surface("body") = {1};\nPhysical Curve("bottom") = {1, 5}; Physical Curve("right") = {6};\n'
                   'Physical Curve("top") = {7}; Physical Curve("left") = {8};\n'), c


def cornered(rng):
    """A section with a re-entrant corner: (text of a .geo, width of its bottom)."""
    if rng.random() < 0.5:
        return fork(rng)
    width, x, y = rng.uniform(0.6, 1.6), rng.uniform(0.3, 0.7), rng.uniform(0.3, 0.7)
    x *= width
    if rng.random() < 0.5:  # a foot to the right
        points, names, bottom = [(0.0, 0.0), (width, 0.0), (width, y), (x, y), (x, 1.0), (0.0, 1.0)], ["bottom", "right", "", "", "top", "left"], width
    else:  # it overhangs
        points, names, bottom = [(0.0, 0.0), (x, 0.0), (x, y), (width, y), (width, 1.0), (0.0, 1.0)], ["bottom", "", "", "right", "top", "left"], x
    text = adaptive.loop(points, adaptive.lines_of(6)) + adaptive.closed(6) + 'Physical Surface("body") = {1};\n'
    return text + "".join(f'Physical Curve("{name}") = {{{k + 1}}};\n' for k, name in enumerate(names) if name), bottom


def gap_of(rng, features, width, depth, revolution):
    place = rng.uniform(0.25, 0.75) * width
    steepness = depth / width
    if "tip" in features:
        slope = steepness * log_uniform(rng, -0.2, 0.6)
        return f"{slope!r}*x" if revolution else f"{slope!r}*abs(x - {place!r})"
    if "gap step" in features:
        far = depth * log_uniform(rng, 0.2, 1.5)
        return f"x < {place!r} ? 0 : {far!r}" if rng.random() < 0.5 else f"x > {place!r} ? 0 : {far!r}"
    if rng.random() < 0.3:
        return "0"
    return f"{steepness / width * log_uniform(rng, -0.5, 0.7)!r}*(x - {0.0 if revolution else place!r})^2"


def press_and_slide(rng):
    """[(share of the approach, share of the motion along the side)] of load steps."""
    steps = rng.randint(2, 5)
    along = sorted(rng.random() for _ in range(steps)) if rng.random() < 0.5 else [rng.random() for _ in range(steps)]
    kind = rng.choice(["press", "unload", "again", "slide", "any"])
    down = {"press": [(k + 1) / steps for k in range(steps)],
            "unload": [1.0] + [1.0 - rng.uniform(0.1, 0.9) * (k + 1) / steps for k in range(steps - 1)],
            "again": [(1.0, rng.uniform(0.1, 0.7), rng.uniform(0.9, 1.2))[k % 3] for k in range(steps)],
            "slide": [1.0] * steps,
            "any": [rng.uniform(0.2, 1) for _ in range(steps)]}[kind]
    return list(zip(down, along))


def in_steps(rng, lists):
    """The deck as a history: its top by hat functions of t, of most a foundation that remembers."""
    path, contact, top = press_and_slide(rng), lists["Contact"], lists["Dirichlet"]["top"]
    hats = lambda factors: "(" + " + ".join(f"({f!r})*max(0, 1 - abs(t - {k + 1}))" for k, f in enumerate(factors)) + ")"
    mean = -YOUNG * float(top["Y"])
    if "Yield Stress" not in contact and rng.random() < 0.6:
        contact["Yield Stress"] = repr(mean * log_uniform(rng, -0.4, 0.6))
    if "Yield Stress" in contact and rng.random() < 0.4:
        contact["Hardening"] = YOUNG * log_uniform(rng, -1, 1)
    lists["Steps"] = {"Times": [k + 1.0 for k in range(len(path))]}
    lists["Dirichlet"] = {"top": {"X": f"({top['X']})*{hats([along for _, along in path])}", "Y": f"({top['Y']})*{hats([down for down, _ in path])}"}}


def on_hardening_foundation(rng, lists):
    """The deck on a foundation that hardens, and yields in most scenes."""
    contact, mean = lists["Contact"], -YOUNG * float(lists["Dirichlet"]["top"]["Y"])
    if "Yield Stress" not in contact:
        contact["Yield Stress"] = repr(mean * log_uniform(rng, -0.5, 0.6))
    contact["Hardening"] = YOUNG * log_uniform(rng, -1.5, 1.5)


def deck(rng, kind):
    """(nested lists of the deck, text of the .geo without its size or None, that size)"""
    features = {kind} if kind != "two" else set(rng.sample(KINDS[1:-1], 2))
    revolution = rng.random() < 0.4
    width, geo, size = rng.uniform(0.6, 2), None, rng.uniform(0.15, 0.3)
    if "corner" in features:
        geo, width = cornered(rng)
        mesh = {"Type": "gmsh", "File": "body.geo", "Order": rng.choice([2, 2, 2, 1])}
    else:
        across = rng.randint(4, 8)
        mesh = {"Type": "box", "Lower": [0.0, 0.0], "Upper": [width, 1.0], "Cells": [across, rng.randint(3, 8)], "Element": rng.choice(["P2", "P2", "P2", "Q2", "P1", "Q1"])}
    depth = log_uniform(rng, -2.5, -1.5)
    contact = {"Side": "bottom", "Normal": "0, -1", "Gap": gap_of(rng, features, width, depth, revolution)}
    mean = YOUNG * depth
    if "xi step" in features:
        low, high = sorted([mean * log_uniform(rng, -0.3, 0.5), mean * log_uniform(rng, 0, 1)])
        contact["Yield Stress"] = f"x < {rng.uniform(0.2, 0.8) * width!r} ? {low!r} : {high!r}"
    elif rng.random() < 0.3:
        contact["Yield Stress"] = repr(mean * log_uniform(rng, 0, 0.8))
    top = {"X": "0", "Y": repr(-depth)}
    if "mu step" in features:
        low, high = rng.uniform(0.02, 0.2), rng.uniform(0.2, 0.6)
        contact["Friction Coefficient"] = f"x < {rng.uniform(0.2, 0.8) * width!r} ? {low!r} : {high!r}"
    elif rng.random() < 0.25:
        contact["Friction Coefficient"] = repr(rng.uniform(0.05, 0.6))
    if "Friction Coefficient" in contact and not revolution:
        top["X"] = repr(depth * rng.uniform(-1.5, 1.5))
    low_order = mesh.get("Order") == 1 or mesh.get("Element") in ("P1", "Q1")
    lists = {"Mesh": mesh, "Material": {"Young's Modulus": YOUNG, "Poisson's Ratio": rng.uniform(0.0, 0.45)}, "Dirichlet": {"top": top}, "Contact": contact,
             "Adapt": {"Target Relative Error": rng.choice(TARGETS) * (2 if low_order else 1)}}
    if revolution:
        lists["Kinematics"] = "axisymmetric"
    return lists, geo, size


@dataclasses.dataclass
class Outcome:
    number: int
    kind: str
    judged: dict = dataclasses.field(default_factory=dict)  # by quantity: "one mesh", "null", "unjudged", or (held, bar over true error)
    meshes: int = 0
    complaint: str = ""
    note: str = ""


def finer(lists, target, cells, most_dofs):
    """Arguments of the reference of a scene.

    @param target, cells  by how much its target is smaller, and its first mesh finer"""
    mesh = lists["Mesh"]
    changes = {"Adapt->Target Relative Error": lists["Adapt"]["Target Relative Error"] / target, "Adapt->Max Dofs": most_dofs}
    if mesh["Type"] == "box":
        changes["Mesh->Cells"] = "{" + ", ".join(str(cells * n) for n in mesh["Cells"]) + "}"
        changes["Mesh->Element"] = mesh["Element"][0] + "2"
    else:
        changes["Mesh->Order"] = 2
    return [f"--set={key}={value}" for key, value in changes.items()]


def compare(outcome, summary, reference):
    here, there = summary["adaptation"]["errors"], reference["adaptation"]["errors"]
    for key, of in QUANTITIES.items():
        name = key if key in here else "contact_area"
        bar, other = here.get(name), there.get(name)
        if bar is None:
            outcome.judged[key] = "one mesh" if outcome.meshes == 1 else "null"
            continue
        true = math.dist(of(summary), of(reference))
        slack = 1e-9 * max([summary["max_displacement"] if key == "max_penetration" else 0, *map(abs, of(summary))])
        if true > bar and (other or 0) > KNOWN * bar and true <= bar + other:
            outcome.judged[key] = "unjudged"
            continue
        held = true <= bar + min(other or 0, KNOWN * bar) + slack
        outcome.judged[key] = (held, bar / max(true, slack, 1e-300))
        if not held:
            outcome.note += f"; {key} {of(summary)} +- {bar:.4g}, right: {of(reference)} +- {other}"


def judge(options, number):
    rng = random.Random(f"{options.seed}/bars/{number}")
    kind = options.kind or KINDS[number % len(KINDS)]
    lists, geo, size = deck(rng, kind)
    if options.hardening:
        on_hardening_foundation(random.Random(f"{options.seed}/hardening/{number}"), lists)
    if options.histories:
        in_steps(random.Random(f"{options.seed}/steps/{number}"), lists)
    outcome = Outcome(number, kind)
    with trials.folder(options, f"bars_{options.seed}_{number:04d}") as folder:
        try:
            results = []
            reference = finer(lists, FINER, FINER_CELLS, MOST_DOFS_IN_STEPS if "Steps" in lists else MOST_DOFS)
            for output, factor, more in (("out", 1, []), ("fine", FINER_CELLS, reference)):
                (folder / "scene.yaml").write_text(trials.written({"scene": lists}, 0))
                if geo:
                    (folder / "body.geo").write_text(f"S = {size / factor!r};\n" + geo)
                result, summary = adaptive.run(options, folder, output, "--set=Output->Exodus=false", *more)
                if summary is None or summary.get("adaptation") is None or not summary["converged"]:
                    if result.returncode != REFUSED:
                        outcome.complaint = f"{output}: exit {result.returncode}: {result.stderr.strip()[-200:]}"
                    return outcome
                results.append(summary)
            outcome.meshes = len(results[0]["adaptation"]["cycles"])
            if results[0]["time"] == results[1]["time"] and max(map(abs, results[1]["contact_force"])) > 0:  # or a target was not met before
                compare(outcome, *results)
        except Exception as error:  # a run that took too long, a file that is no JSON
            outcome.complaint = f"{type(error).__name__}: {error}"[:300]
    return outcome


def shares(outcomes, key):
    """(held, judged, null, those of one mesh, unjudged, median of bar over true error) of a quantity."""
    found = [o.judged[key] for o in outcomes if key in o.judged]
    bars = [f for f in found if isinstance(f, tuple)]
    ratio = statistics.median(min(f[1], 1e9) for f in bars) if bars else math.nan
    return sum(f[0] for f in bars), len(bars), found.count("null"), found.count("one mesh"), found.count("unjudged"), ratio


def main():
    options = trials.arguments(__doc__, 100, ("--kind", {"choices": KINDS}), ("--histories", {"type": int, "default": 0}), ("--hardening", {"type": int, "default": 0}),
                              ("--meshes", {"choices": ["automatic", "gmsh", "nested"], "default": "automatic"}))
    outcomes = []
    for o in trials.each(options, judge):
        outcomes.append(o)
        if o.complaint:
            print(f"FAILED {o.number} ({o.kind}): {o.complaint}", flush=True)
        if o.note:
            print(f"  {o.number} ({o.kind}, {o.meshes} meshes){o.note}", flush=True)
    failed = sum(bool(o.complaint) for o in outcomes)
    print(f"{len(outcomes)} scenes, seed {options.seed}, {failed} failed, {sum(bool(o.judged) for o in outcomes)} compared")
    for key in QUANTITIES:
        print(f"{key}: kind, bars that hold, of those judged, null, null of one mesh, not judged, median of bar over true error")
        for kind in [*KINDS, None]:
            *counts, ratio = shares([o for o in outcomes if kind in (None, o.kind)], key)
            print(f"  {kind or 'all':10}" + "".join(f" {count:4}" for count in counts) + f" {ratio:8.3g}")
    held, judged, *_ = shares(outcomes, "contact_force")
    return 1 if failed or held < HELD * judged else 0


if __name__ == "__main__":
    sys.exit(main())

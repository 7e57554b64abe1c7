# SPDX-License-Identifier: BSD-3-Clause
"""Random load histories against rpc: each step must be solved, and what the foundation remembers must follow its law.

    python3 histories.py --rpc=build/rpc [--seed=1] [--scenes=500] [--only=K] [--jobs=2] [--np=1] [--keep=DIR]

History K comes from the seed and K alone: a scene of scenes.py that Dirichlet conditions hold, any law of the foundation, and for each of
its loads, prescribed displacements and obstacles a path in time: up and back, reversed, in random order, in large steps, with two
sides in turn. It is run as it is, with steps of a quarter, and up to a step in between. All must exit 0 with all steps converged in one
part, optimality residuals below 1e-8, finite numbers, pressures in [0, xi + H w] and forces that balance. Dents and the dissipated energy never
fall, as sums, and at each node from the run that stopped to the whole one, whose steps are the same. Energies balance to the order of the step:
the sum over the steps of what they miss falls, and so does, with friction (friction_histories.py), the sum of what it gives back. Without
memory nothing is dissipated by denting, and without friction, too, the last step is that of a run of that step alone. Histories whose steps rounding keeps from their tolerance, as scenes.py has it, are counted. The exit code is 1 if a history failed.
"""
import dataclasses
import json
import math
import pathlib
import random
import shutil
import sys
import tempfile
import time

import fields
import generate
import scenes
import space
import trials
from generate import log_uniform
from scene import verdict

BASES = {**{name: generate.PLAIN[name] for name in ("box", "varying_xi", "gaps", "obstacles", "displacement", "corner")},
         **{name: space.FAMILIES[name] for name in ("solid", "round", "axisymmetric", "plane_stress")}}
SAME = 1e-6  # of two runs over the same steps, relative
FALLS = 0.6  # of the sum of what steps miss of the energy, from steps to their quarters: order two makes it 1/16, one 1/4
SOFTER = 0.8  # of the histories without dents
SOLVED = 1e-9  # of the forces between cells: what may be left of equilibrium
MEMORY = ("strain_energy", "dissipated_energy", "work", "max_pressure", "max_dent", "dent_volume")
BY_FRICTION = ("dissipated_by_friction", "max_shear", "max_slip")
ROUNDING = 1e-5  # of the work done to and fro: less is left of solves


# --- paths -----------------------------------------------------------------------------------------------------------------


def path(rng, steps):
    """Factors of a load at t = 1, 2, ..., steps; the largest are about 1."""
    kind = rng.choice(["up and back", "reversed", "random", "large", "up"])
    if kind == "up":
        return [(k + 1) / steps for k in range(steps)]
    if kind == "up and back":
        top = rng.randint(1, steps)
        return [(k + 1) / top if k < top else 1 - rng.uniform(0.3, 1.2) * (k + 1 - top) / (steps - top) for k in range(steps)]
    if kind == "reversed":
        return [(-1) ** k * rng.uniform(0.5, 1) for k in range(steps)]
    if kind == "large":
        return [rng.choice([0.0, 0.1, 1.0, rng.uniform(1, 3)]) for _ in range(steps)]
    levels = [(k + 1) / steps for k in range(steps)]
    rng.shuffle(levels)
    return levels


def in_turn(rng, steps, first):
    """One of two loads that act in turn."""
    return [rng.uniform(0.5, 1) * (1.0 if (k + first) % 2 == 0 else 0.1) for k in range(steps)]


def make(rng):
    """(family, scene) of a history that has a solution at all of its steps."""
    while True:
        name = rng.choice(list(BASES))
        scene = BASES[name](rng)
        if scene is None or scene.body is None or verdict(scene) != "solution":
            continue
        steps = rng.randint(2, 6)
        loads = [(scene.traction, side) for side in scene.traction] + [(scene.dirichlet, side) for side in scene.dirichlet]
        turns = rng.random() < 0.3
        for number, (lists, side) in enumerate(loads):
            factors = in_turn(rng, steps, number) if turns else path(rng, steps)
            if lists is scene.traction:
                lists[side] = [fields.InTime(f, factors) for f in lists[side]]
            else:
                lists[side] = {c: f if isinstance(f, fields.Constant) and f.value == 0 else fields.InTime(f, factors)
                               for c, f in lists[side].items()}
        e = scene.material["E"]
        for contact in scene.contact:
            contact.hardening = e * log_uniform(rng, -2, 1) if rng.random() < 0.5 else 0.0
            contact.stiffness = e * log_uniform(rng, -1, 2) if rng.random() < 0.4 else math.inf
            contact.remembers = rng.random() < 0.85
            if contact.obstacle and rng.random() < 0.7:
                size = 10 ** rng.uniform(-4, -2)
                way = (rng.uniform(-1, 1), rng.uniform(0, 1), 0.0)[:scene.dim] if rng.random() < 0.5 else (0.0, 1.0, 0.0)[:scene.dim]
                if scene.kinematics:
                    way = (0.0, 1.0)
                contact.motion = tuple(size * w for w in way), path(rng, steps)
        scene.times = [float(k + 1) for k in range(steps)]
        if solvable(scene):
            return name, scene


def solvable(scene):
    """At all times, also those in between."""
    return all(verdict(scene.at(k / 4)) == "solution" for k in range(1, 4 * len(scene.times) + 1))


# --- judgement -------------------------------------------------------------------------------------------------------------


def rubs(scene):
    return any(contact.friction for contact in scene.contact)


class AtRounding(Exception):
    """Where |K||u|, rounded, is above 1e-8 of the load, no program in double precision can tell whether a step is solved."""


def floor(scene, summary, rows):
    """What rounding leaves of residuals at the last time."""
    now = scene.at(summary["steps"][-1]["time"])
    return 10 * scenes.rounding(now, summary, rows)


def at_rounding(scene, summary, folder):
    bound = floor(scene, summary, scenes.contact_rows(folder))
    return bound > scenes.TOLERANCE and all(summary[key] is not None and summary[key] <= bound for key in scenes.RESIDUALS)


def run(options, scene, folder, complain, *settings):
    """(summary, contact rows), or None; settings: further arguments. @raise AtRounding"""
    folder.mkdir()
    scenes.write(scene, folder)
    code, stdout, stderr = scenes.run(scenes.launch(options) + ["--input=scene.xml", *settings], folder)
    (folder / "stdout.txt").write_text(stdout)
    (folder / "stderr.txt").write_text(stderr)
    results = folder / "scene.json"
    if code == 4 and results.exists() and at_rounding(scene, json.loads(results.read_text()), folder):
        raise AtRounding
    off_balance = code == 4 and results.exists() and json.loads(results.read_text()).get("energy_tolerance", {}).get("kept") is False
    if (code != 0 and not off_balance) or not results.exists():
        lines = (stderr or stdout).strip().splitlines()
        reason = json.loads(results.read_text())["reason"] if results.exists() else lines[-1] if lines else ""
        complain(f"{folder.name}: exit {code}: {reason[:300]}")
        return None
    return json.loads(results.read_text()), scenes.contact_rows(folder)


def by_friction(step):
    return step.get("dissipated_by_friction", 0.0)


def missed(steps):
    """What each step misses of the energy [J]."""
    rest = [s["work"] - s["strain_energy"] - s["foundation_energy"] - s["dissipated_energy"] - by_friction(s) for s in steps]
    return [b - a for a, b in zip([0.0] + rest, rest)]


def soften(scene, summary):
    """A foundation that nothing dents yields from half of the largest pressure on."""
    highest = max(step["max_pressure"] for step in summary["steps"]) / scene.units[1]
    given = [contact.xi for contact in scene.contact]
    for contact in scene.contact if highest > 0 else []:
        contact.xi = fields.Constant(0.5 * highest)
    if not solvable(scene):
        for contact, xi in zip(scene.contact, given):
            contact.xi = xi


def check_run(scene, summary, rows, complain):
    """One run by itself."""
    worst = {key: summary[key] for key in scenes.RESIDUALS}
    if any(value is None or not value <= scenes.TOLERANCE for value in worst.values()):
        complain(", ".join(f"{k} {v}" for k, v in worst.items()))
    steps = summary["steps"]
    if [s["time"] for s in steps] != scene.times or not all(s["converged"] for s in steps):
        complain("steps " + ", ".join(f"{s['time']} {s['converged']}" for s in steps))
    if any(s["parts"] != 1 for s in steps) and floor(scene, summary, rows) <= scenes.TOLERANCE:
        complain("parts " + ", ".join(str(s["parts"]) for s in steps))
    now = scene.at(scene.times[-1])
    scenes.check_numbers(now, summary, rows, scenes.rounding(now, summary, rows), complain)
    if any(row["dent"] < 0 for row in rows):
        complain("a dent is negative")
    if not all(contact.remembers for contact in scene.contact):
        return
    for key in ("max_dent", "dent_volume", "dissipated_energy"):
        values = [s[key] for s in steps]
        for before, after in zip(values, values[1:]):
            if after < before * (1 - 1e-9) - 1e-300:
                complain(f"{key} falls: {values}")
                break


def place(row):
    return (row["side"],) + tuple(row.get(c) for c in "xyz")


def misses(result, start):
    """The sum of what steps miss of the energy after a time: at the first step a foundation may overlap the body at rest."""
    steps = result[0]["steps"]
    return sum(abs(m) for m, s in zip(missed(steps), steps) if s["time"] > start)


def falls(result, start):
    """By how much dissipation by friction falls in steps after a time: the trapezoidal rule may where traction turns and the pressure falls."""
    steps = result[0]["steps"]
    return sum(max(0.0, by_friction(a) - by_friction(b)) for a, b in zip(steps, steps[1:]) if b["time"] > start)


def at_work(result):
    """Work to and fro, and energies."""
    steps = result[0]["steps"]
    works = [s["work"] for s in steps]
    return sum(abs(b - a) for a, b in zip(works, works[1:])) + max(s["strain_energy"] + s["dissipated_energy"] + by_friction(s) for s in steps)


def solver_rest(scene, rows):
    """Energy [J] that the solver's tolerance leaves in a body that moves as a whole with its supports."""
    length, stress = scene.units
    rest = SOLVED * scenes.stress_of_cell(scene.at(scene.times[-1]), rows)
    return rest ** 2 / (scene.stiffest() * stress) * length ** scene.dim


def shrinks(what, scene, coarse, fine, start):
    rest = ROUNDING * at_work(fine) + len(fine[0]["steps"]) * solver_rest(scene, fine[1])
    return what(fine, start) <= FALLS * what(coarse, start) + rest


WHAT = {misses: "energy missed", falls: "given back by friction"}


def check_memory(scene, whole, part, number, complain):
    """The run up to a step in between is the beginning of the whole one."""
    for key in MEMORY + (BY_FRICTION if rubs(scene) else ()):
        largest = max(abs(s[key]) for s in whole[0]["steps"])
        for a, b in zip(whole[0]["steps"], part[0]["steps"]):
            if abs(a[key] - b[key]) > SAME * largest:
                complain(f"{key} at t = {a['time']} is {a[key]!r}, and {b[key]!r} in a run up to {number}")
                return
    remember = {contact.side for contact in scene.contact if contact.remembers}
    last = {place(row): row["dent"] for row in whole[1]}
    for row in part[1]:
        if row["side"] in remember and last.get(place(row), math.inf) < row["dent"] * (1 - 1e-9):
            complain(f"the dent at {place(row)} falls from {row['dent']!r} to {last[place(row)]!r}")
            return


def extent(step, what):
    return step.get(f"{what}_length", step.get(f"{what}_area", 0.0))


@dataclasses.dataclass
class Outcome:
    number: int
    family: str
    steps: int
    seconds: float
    dented: bool
    sticks_and_slips: bool
    at_rounding: bool
    complaints: list


def judge(options, number, name, make_one):
    """make_one: (family, scene) from random numbers of the suite's name."""
    rng = random.Random(f"{options.seed}/{name}/{number}")
    family, scene = make_one(rng)
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rpc_history_{number}_"))
    complaints, start, dented, rubbed, rounding = [], time.monotonic(), False, False, False
    complain = complaints.append
    try:
        steps = scene.times
        whole = run(options, scene, folder / "first", complain)
        if whole and not any(s["max_dent"] > 0 for s in whole[0]["steps"]) and rng.random() < SOFTER:
            soften(scene, whole[0])
            whole = None
        whole = whole or run(options, scene, folder / "whole", complain)
        if whole:
            check_run(scene, *whole, complain)
            dented = any(s["max_dent"] > 0 for s in whole[0]["steps"])
            rubbed = any(extent(s, "stick") > 0 and extent(s, "slip") > 0 for s in whole[0]["steps"])
            finer = dataclasses.replace(scene, times=[k / 4 for k in range(1, 4 * len(steps) + 1)])
            quarters = run(options, finer, folder / "quarters", complain)
            if quarters:
                check_run(finer, *quarters, complain)
                large = [what for what in (misses, falls) if not shrinks(what, scene, whole, quarters, steps[0])]
                if large:  # steps too large to show an order, which their parts must
                    finest = dataclasses.replace(scene, times=[k / 16 for k in range(1, 16 * len(steps) + 1)])
                    sixteenths = run(options, finest, folder / "sixteenths", complain)
                    for what in large if sixteenths else []:
                        if not shrinks(what, scene, quarters, sixteenths, steps[0]):
                            complain(WHAT[what] + ": " + ", ".join(f"{what(r, steps[0]):.3g}" for r in (whole, quarters, sixteenths))
                                     + f" of {at_work(sixteenths):.3g}")
            if len(steps) > 1:
                until = rng.randint(1, len(steps) - 1)
                part = run(options, dataclasses.replace(scene, times=steps[:until]), folder / "part", complain)
                if part:
                    check_memory(scene, whole, part, until, complain)
            if not any(contact.remembers for contact in scene.contact) and not rubs(scene):
                alone = run(options, dataclasses.replace(scene, times=steps[-1:]), folder / "alone", complain)
                a, b = whole[0]["steps"][-1], alone[0]["steps"][-1] if alone else {}
                rest = solver_rest(scene, alone[1]) if alone else 0
                for key in ("strain_energy", "foundation_energy", "max_pressure") if alone else ():
                    if abs(a[key] - b[key]) > SAME * max(s[key] for s in whole[0]["steps"]) + (rest if "energy" in key else 0):
                        complain(f"without memory {key} is {a[key]!r}, and {b[key]!r} alone")
            if not any(contact.remembers for contact in scene.contact) and whole[0]["steps"][-1]["dissipated_energy"] != 0:
                complain(f"dissipates {whole[0]['steps'][-1]['dissipated_energy']!r} without memory")
    except AtRounding:
        rounding = True
    try:
        if options.keep and (complaints or options.only is not None):
            kept = pathlib.Path(options.keep) / f"{number:04d}_{family}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            (kept / "complaints.txt").write_text("\n".join(complaints) + "\n")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return Outcome(number, family, len(steps), time.monotonic() - start, dented, rubbed, rounding, complaints)


def suite(description, count, name, make_one):
    """Judges histories as the command line asks. @return exit code"""
    options = trials.arguments(description, count)
    outcomes = []
    for o in trials.each(options, judge, name, make_one):
        outcomes.append(o)
        if o.complaints:
            print(f"FAILED {o.number} {o.family}: {'; '.join(o.complaints)}", flush=True)
    failed = sum(1 for o in outcomes if o.complaints)
    print(f"seed {options.seed}: {failed} of {len(outcomes)} histories failed, {sum(o.steps for o in outcomes)} steps, "
          f"{sum(o.dented for o in outcomes)} with dents, {sum(o.sticks_and_slips for o in outcomes)} with stick and slip, "
          f"{sum(o.at_rounding for o in outcomes)} at rounding, most seconds {max(o.seconds for o in outcomes):.1f}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(suite(__doc__, 500, "history", make))

# SPDX-License-Identifier: BSD-3-Clause
"""Random bodies whose rigid top forces and moments press and turn, against the same bodies whose top follows prescribed motions.

    python3 rigid.py --rpc=build/rpc [--seed=1] [--scenes=50] [--only=K] [--jobs=2] [--keep=DIR]

Scene K is that of forces.py with the same seed, but for its top: an entry of Rigid, which first goes down and tilts on a given path; a body of
revolution only goes down. Then the forces and moments that this took, of each step, move it, in some scenes with springs to the ground, which bear a
part of them. Told are failures: the force that comes back differs by more than 1e-10 of itself, the motions by more than 1e-7 of the largest
displacement that they make (where nearly all that touches yields a direction is soft, in which residuals of 1e-11 leave more), or a run does not end
as it should. Where the foundation carries no more than the given forces, they must be refused with exit code 5. Where less than a tenth of what
touches is short of yielding, without hardening, forces hardly determine the motions: such scenes must end, and are not compared. The exit code is 1
if a scene failed, the median of what motions are off is above 1e-10, or that of the ratio of Newton steps above 1.5.
"""
import json
import random
import statistics
import sys

import forces
import trials

SAME_FORCE, SAME_MOTION, MEDIAN, MOST_RATIO = 1e-10, 1e-7, 1e-10, 1.5
SPARE = 0.1  # of what touches: so much is short of yielding where motions are compared


def scene(seed, number):
    """(deck whose top follows a path, times of its load steps, motions that forces take over)"""
    rng = random.Random(f"rigid {seed} {number}")
    deck, times = forces.scene(seed, number)
    top = deck["Dirichlet"]["top"]
    path = top["Y"]
    depth = float(path.split("*")[0])
    del deck["Dirichlet"]
    if deck.get("Kinematics") == "axisymmetric":
        deck["Rigid"] = {"top": {"Y": path}}
        return deck, times, ["Y"]
    space = len(deck["Mesh"]["Upper"]) == 3
    turns = ["X", "Z"] if space else ["Z"]
    tilts = {f"Rotation {axis}": path.replace(repr(depth), repr(depth * rng.uniform(-0.6, 0.6) / deck["Mesh"]["Upper"][0])) for axis in turns}
    held = {"X": 0.0, "Z": 0.0, "Rotation Y": 0.0} if space else {"X": 0.0}
    deck["Rigid"] = {"top": {**held, "Y": path, **tilts}}
    if rng.random() < 0.3:
        deck["Rigid"]["top"]["Point"] = [extent * rng.uniform(0.2, 0.8) for extent in deck["Mesh"]["Upper"]]
    return deck, times, ["Y", *tilts]


def of_load(motion, kind):
    return motion.replace("Rotation", "Moment") if "Rotation" in motion else f"{kind} {motion}"


def column_of(motion, what):
    """Where the history has a motion, or its force or moment."""
    turns, axis = "Rotation" in motion, motion[-1].lower()
    return f"top_{('rotation' if turns else 'displacement') if what == 'motion' else ('moment' if turns else 'reaction')}_{axis}"


def read(summary, rows, motion, what):
    """The numbers of a motion, or of its force or moment, at all steps."""
    if rows:
        return forces.column(rows, column_of(motion, what))
    side = summary["rigid"]["top"]
    turns, axis = "Rotation" in motion, "XYZ".index(motion[-1])
    value = side[("rotation" if turns else "displacement") if what == "motion" else ("moment" if turns else "force")]
    return [value[axis] if isinstance(value, list) else value]


def by_forces(deck, loads, moved, times, springs):
    """The same deck, moved by forces and moments at times, which springs bear a part of."""
    deck = json.loads(json.dumps(deck))
    top = deck["Rigid"]["top"]
    for motion, values in loads.items():
        del top[motion]
        stiffness = springs.get(motion, 0)
        if stiffness:
            top[("Rotation Stiffness " if "Rotation" in motion else "Stiffness ") + motion[-1]] = stiffness
            values = [value + stiffness * q for value, q in zip(values, moved[motion])]
        top[of_load(motion, "Force")] = forces.steps_in_time(values, times)
    return deck


def spare(deck, summary, rows):
    """The least share of what touches that is short of yielding, of all steps; 1 where forces determine motions anyway."""
    if "Hardening" in deck["Contact"] or "Yield Stress" not in deck["Contact"]:
        return 1
    where = "length" if "contact_length" in summary else "area"
    pairs = zip(forces.column(rows, f"yielded_{where}"), forces.column(rows, f"contact_{where}")) if rows else [(summary[f"yielded_{where}"], summary[f"contact_{where}"])]
    return min(1 - yielded / touching if touching > 0 else 0 for yielded, touching in pairs)


def judge(options, number):
    """(complaint or None, what happened, (ratio of Newton steps, what motions are off) or None)"""
    deck, times, motions = scene(options.seed, number)
    with trials.folder(options, str(number)) as folder:
        code, given, given_rows, words = forces.run(options.rpc, deck, folder, "moved")
        if code != 0:
            return None, f"not compared: a path ends with {code}: {words}", None
        loads = {motion: read(given, given_rows, motion, "force") for motion in motions}
        moved = {motion: read(given, given_rows, motion, "motion") for motion in motions}
        largest = max(map(abs, moved["Y"]))
        modulus = deck["Material"]["Young's Modulus"]
        if min(map(abs, loads["Y"])) <= forces.NOTHING * modulus * largest:
            return None, "nothing touches: no force to compare", None
        rng = random.Random(f"springs {options.seed} {number}")
        springs = {motion: modulus * forces.log_uniform(rng, -2, 0) for motion in motions if rng.random() < 0.3}
        code, found, rows, words = forces.run(options.rpc, by_forces(deck, loads, moved, times or [1.0], springs), folder, "pressed")
        if code == forces.NO_SOLUTION and (spare(deck, given, given_rows) < SPARE or any(word in words for word in ("all that the foundation carries", "carries at most", "friction holds"))):
            return None, "all that the foundation carries, refused", None
        if code != 0:
            return f"exit {code}: {words or (found or {}).get('reason')}", "", None
        left = spare(deck, given, given_rows)
        off = max(abs(a - b) * (deck["Mesh"]["Upper"][0] if "Rotation" in motion else 1)
                  for motion in motions for a, b in zip(moved[motion], read(found, rows, motion, "motion"))) / largest
        ratio = forces.steps_of(found) / max(1, forces.steps_of(given))
        borne = [a - springs.get("Y", 0) * (b - c) for a, b, c in zip(loads["Y"], read(found, rows, "Y", "motion"), moved["Y"])]
        back = max(abs(a - b) for a, b in zip(borne, read(found, rows, "Y", "force"))) / max(map(abs, loads["Y"]))
        what = (f"{found['element']} {found.get('kinematics', 'space')}, {found['dofs']} dofs, {len(springs)} springs: off by {off:.1e}, "
                f"Newton {forces.steps_of(given)} -> {forces.steps_of(found)}")
        if left < SPARE:
            return None, f"{left:.2f} of what touches does not yield: not compared; {what}", None
        fits = off <= SAME_MOTION and back <= SAME_FORCE
        return (None if fits else f"the force differs by {back:.2e}, motions by {off:.2e}: {what}"), what, (ratio, off)


def main():
    options = trials.arguments(__doc__, 50)
    failed, ratios = trials.compared(options, judge)
    steps, off = [[both[k] for both in ratios] or [0] for k in (0, 1)]
    print(f"{failed} of {len(trials.numbers(options))} failed; {len(ratios)} compared; motions off by {statistics.median(off):.1e} in the median, {max(off):.1e} at most; "
          f"Newton steps by force over those by path: median {statistics.median(steps):.2f}, most {max(steps):.2f}")
    return 1 if failed or statistics.median(off) > MEDIAN or statistics.median(steps) > MOST_RATIO else 0


if __name__ == "__main__":
    sys.exit(main())

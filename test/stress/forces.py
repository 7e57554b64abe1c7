# SPDX-License-Identifier: BSD-3-Clause
"""Random bodies that a force presses, against the same bodies that a displacement presses.

    python3 forces.py --rpc=build/rpc [--moved=side] [--springs=1] [--histories=RANKS] [--bars=1] [--seed=1] [--scenes=50] [--only=K] [--jobs=2] [--keep=DIR]

Scene K comes from the seed and K alone: a box in the plane, of revolution or in space, whose top is held rigid, on an obstacle or a foundation with a
gap, rigid or yielding, hardening or on springs, some with friction, some in load steps. The top is first moved by a displacement; then the force
that this took, of each step, moves it. With --moved=obstacle the body is held, and an obstacle of a random shape is moved; with --springs=1 such an obstacle
lies on a spring, which bears a part of the force. With --histories=RANKS all scenes have load steps, and the run by force is done again: in two parts,
with a restart between them, which must give the same digits, and on 2 to RANKS ranks, which must agree to 1e-10. Told are failures: the displacement that comes back differs by more than 1e-10 of the given one, or a run
does not end as it should; where the foundation carries no more than the given force, it must be refused with exit code 5. Where all that touches yields, and does not harden, a force does not determine the displacement:
such scenes must end, and their displacements are not compared. Told are the Newton steps of the two ways. The exit code is 1 if a scene failed, or the median of the ratio of Newton steps is above 1.2.

With --bars=1 the forces press bodies on adapted meshes: each scene has a target for the error, and the true values are those of the same scene from a
first mesh with cells half as long, of order 2, and a target a fifth as large. --moved=rigid, with bars alone, has the rigid tops of rigid.py, which forces and moments press and turn. A bar holds where
the true value lies within it and within the bar of the reference; one whose reference has a bar of more than half of it is not judged, and counted. Told are for each quantity how many bars hold, how
many are null, and the median of bar over true error. The exit code is 1 if a run failed, or displacements or energies held in less than 95 of 100.
"""
import csv
import json
import random
import statistics
import subprocess
import sys

import trials
from generate import log_uniform

SAME, MOST_RATIO = 1e-10, 1.2
SAME_ON_HARDENING = 1e-8  # where all that touches yields, a force determines the displacement by hardening alone
SAME_BUT_FOR_APPROACH = 0.05  # with friction: a path's way to the first touch is slip, and that of a tool that a force moves is none
NO_SOLUTION = 5
FINER, MOST_DOFS, KNOWN, HELD = 5, 40000, 0.5, 0.95  # bars: of references the target and dofs; what counts as known; how many must hold
NOTHING = 1e-9  # of the modulus times the displacement: forces that are rounding
TIGHT = 1e-11  # residuals: the two ways are to agree to more digits than a run has by default
TIMES, PATH = [0.5, 1.0, 1.5, 2.0], "*(t < 1 ? t : t < 1.5 ? 1 - 0.3*(t - 1) : 0.85 + 0.6*(t - 1.5))"
KINDS = ["plane strain", "plane stress", "axisymmetric", "space", "space"]


def foundation(rng, modulus, height, depth):
    """The law of the foundation, without geometry."""
    law = {}
    kind = rng.choice(["rigid", "yields", "yields", "hardens", "springs", "springs that yield"])
    pressure = modulus * depth / height
    if kind in ("yields", "hardens", "springs that yield"):
        law["Yield Stress"] = pressure * rng.uniform(0.3, 1.5)
    if kind == "hardens":
        law["Hardening"] = modulus / height * log_uniform(rng, -1.3, 0.3)
    if kind.startswith("springs"):
        law["Stiffness"] = modulus / height * log_uniform(rng, -1, 1)
    if rng.random() < 0.3:
        law["Friction Coefficient"] = rng.uniform(0.05, 0.6)
    return law


def scene(seed, number):
    """(deck whose top is moved by a displacement, times of its load steps, axis along which it moves)"""
    rng = random.Random(f"forces {seed} {number}")
    kind = rng.choice(KINDS)
    dim = 3 if kind == "space" else 2
    height, width = 1.0, rng.uniform(0.6, 3)
    upper = [width, height] + [rng.uniform(0.6, 2)] * (dim - 2)
    per_height = rng.randint(4, 8) if dim == 3 else rng.randint(8, 24)
    cells = [max(3, min(40, round(per_height * extent))) for extent in upper]
    modulus, depth = log_uniform(rng, 2, 11), height * log_uniform(rng, -3, -1.3)
    deck = {
        "Mesh": {"Lower": [0.0] * dim, "Upper": upper, "Cells": cells, "Element": rng.choice(["Q1", "Q2", "P1", "P2"])},
        "Material": {"Young's Modulus": modulus, "Poisson's Ratio": rng.choice([0.0, 0.2, 0.3, 0.45])},
        "Contact": {"Side": "bottom", **foundation(rng, modulus, height, depth)},
        "Uzawa": {"Tolerance": TIGHT},
        "Output": {"Exodus": False},
    }
    if dim == 2:
        deck["Kinematics"] = kind
    if rng.random() < 0.5:  # a ball, or a roller
        radius, middle = width * log_uniform(rng, -0.15, 0.7), 0.0 if kind == "axisymmetric" else width * rng.uniform(0.3, 0.7)
        centre = [middle, -radius - rng.choice([0.0, 0.0, 0.2 * depth])] + [0.5 * upper[-1]] * (dim - 2)
        deck["Contact"]["Obstacle"] = {"Type": "sphere", "Centre": centre, "Radius": radius}
    else:
        deck["Contact"]["Gap"] = f"{depth * rng.uniform(0.1, 1)!r}*(1 - cos({rng.uniform(1, 7)!r}*x))/2"
    held = {"X": 0.0} if rng.random() < 0.7 or "Friction Coefficient" not in deck["Contact"] else {}
    held = {} if kind == "axisymmetric" and rng.random() < 0.5 else held
    if dim == 3:
        held = {"X": 0.0, "Z": 0.0}
    times = []
    path = f"{-depth!r}"
    if rng.random() < 0.35:
        times = TIMES
        path += PATH
        deck["Steps"] = {"Times": times}
    deck["Dirichlet"] = {"top": {**held, "Y": path}}
    if kind != "axisymmetric" and "X" not in held:
        deck["Dirichlet"]["corner"] = {"Side": "left top", "X": 0.0}
    return deck, times


def shape(rng, kind, width, depth, dim):
    """(name of its point, parameters) of an obstacle that lies below y = 0 and touches it"""
    middle = 0.0 if kind == "axisymmetric" else width * rng.uniform(0.3, 0.7)
    radius, up, across = width * log_uniform(rng, -0.15, 0.7), [0.0, 1.0] + [0.0] * (dim - 2), [0.0] * (dim - 2) + [0.0, 0.0]
    place = lambda y: [middle, y] + [0.5] * (dim - 2)
    of = rng.choice(["plane", "plane", "sphere", "sphere", "ellipsoid", "cone", "wedge", "flat punch"])
    if of == "plane":
        lean = 0.0 if kind == "axisymmetric" else rng.choice([0.0, rng.uniform(-0.3, 0.3) * depth / width])
        return "Point", place(-abs(lean) * width), {"Type": of, "Normal": [lean, *up[1:]]}
    if of == "sphere":
        return "Centre", place(-radius), {"Type": of, "Radius": radius}
    if of == "ellipsoid":
        axes = [radius * rng.uniform(0.5, 1), radius] + [radius * rng.uniform(0.5, 1)] * (dim - 2)
        across[0] = 1.0
        return "Centre", place(-axes[1]), {"Type": of, "Axis": across, "Semi-Axes": axes, **({"Second Axis": up} if dim == 3 else {})}
    if of == "cone" or (of == "wedge" and kind == "axisymmetric"):
        return "Point", place(0.0), {"Type": "cone", "Axis": up, "Slope": rng.uniform(0.02, 0.2), "Tip Radius": radius}
    if of == "wedge":
        across[-1] = 1.0
        along = {"Axis": across} if dim == 3 else {}
        return "Point", place(0.0), {"Type": of, "Normal": up, "Slope": rng.uniform(0.02, 0.2), "Edge Radius": radius, **along}
    half = 0.3 * width
    return "Point", place(0.0), {"Type": of, "Normal": up, "Radius": half, "Edge Radius": half * rng.uniform(0.5, 1)}


def with_tool(seed, number, histories=False):
    """The same body, held at its top, on an obstacle that moves up: (deck, times, path, name of its point)"""
    deck, times = scene(seed, number)
    if histories and not times:
        times = TIMES
        deck["Dirichlet"]["top"]["Y"] += PATH
        deck["Steps"] = {"Times": times}
    rng = random.Random(f"tools {seed} {number}")
    kind, dim = deck.get("Kinematics", "space"), len(deck["Mesh"]["Upper"])
    path = deck["Dirichlet"]["top"]["Y"].replace("-", "", 1)
    if not times:
        path += "*t"
    top = max(abs(eval_at(path, t)) for t in times or [1.0])
    contact = deck["Contact"]
    contact.pop("Gap", None)
    point, place, parameters = shape(rng, kind, deck["Mesh"]["Upper"][0], top, dim)
    place[1] -= rng.choice([0.0, 0.0, 0.3 * top])
    contact["Obstacle"] = {**parameters, point: [repr(x) if c != 1 else f"{x!r} + {path}" for c, x in enumerate(place)]}
    if parameters["Type"] == "flat punch":
        contact["Normal"] = "surface"
    deck["Dirichlet"]["top"] = {"X": 0.0, "Y": 0.0, **({"Z": 0.0} if dim == 3 else {})}
    deck["Dirichlet"].pop("corner", None)
    return deck, times, path, point


def eval_at(path, t):
    """A path of scene() at a time."""
    factor, _, rest = path.partition("*")
    along = t if rest in ("", "t") else (t if t < 1 else 1 - 0.3 * (t - 1) if t < 1.5 else 0.85 + 0.6 * (t - 1.5))
    return float(factor) * along


def run(rpc, deck, folder, name, *arguments, launch=()):
    """(exit code, summary or None, rows of the history, last words)"""
    path = folder / f"{name}.yaml"
    path.write_text(f"{name}:\n" + trials.written(deck))
    result = subprocess.run([*launch, rpc, f"--input={path}", f"--output={folder}", *arguments], capture_output=True, text=True, errors="replace", check=False,
                            stdin=subprocess.DEVNULL, timeout=600)
    summary, history = path.with_suffix(".json"), folder / f"{name}.history.csv"
    rows = list(csv.DictReader(history.open())) if history.exists() else []
    return result.returncode, json.loads(summary.read_text()) if summary.exists() else None, rows, result.stderr.strip()[-300:]


def column(rows, begins):
    """The numbers of the first column of a name that begins so."""
    name = next(key for key in rows[0] if key.startswith(begins))
    return [float(row[name]) for row in rows]


def determines(deck, summary, rows):
    """Whether the force determines the displacement: not all that touches yields."""
    if "Hardening" in deck["Contact"] or "Yield Stress" not in deck["Contact"]:
        return True
    return not all_yields(summary, rows)


def all_yields(summary, rows):
    """Whether all that touches yields, in any step."""
    where = "length" if "contact_length" in summary else "area"
    pairs = zip(column(rows, f"yielded_{where}"), column(rows, f"contact_{where}")) if rows else [(summary[f"yielded_{where}"], summary[f"contact_{where}"])]
    return any(yielded >= (1 - 1e-9) * touching for yielded, touching in pairs)


def steps_of(summary):
    return sum(step["newton_iterations"] for step in summary["steps"]) if summary.get("steps") else sum(summary["newton_iterations"])


def steps_in_time(forces, times):
    """An expression of t that has these values at times."""
    text = repr(forces[-1])
    for time, force in reversed(list(zip(times[:-1], forces[:-1]))):
        text = f"t < {time + 0.01!r} ? {force!r} : ({text})"
    return text


def by_force(deck, forces, times, point=None, stiffness=0):
    """The same deck, its top or its obstacle moved by forces at times; the obstacle on a spring, if it has a stiffness."""
    deck = json.loads(json.dumps(deck))
    if point is None:
        del deck["Dirichlet"]["top"]["Y"]
        deck["Dirichlet"]["top"]["Force Y"] = steps_in_time(forces, times)
        return deck
    obstacle = deck["Contact"]["Obstacle"]
    obstacle[point][1] = obstacle[point][1].partition(" + ")[0]
    obstacle["Force Y"] = steps_in_time(forces, times)
    if stiffness:
        obstacle["Stiffness Y"] = stiffness
    return deck


def done_again(options, deck, folder, rows):
    """What is wrong of a history that is done once more, in parts and on several ranks; None: nothing"""
    if len(rows) < len(deck["Steps"]["Times"]):
        return None
    times, every = deck["Steps"]["Times"], "--set=Steps->Checkpoint Every=1"
    _, _, whole, _ = run(options.rpc, deck, folder, "whole", every)
    run(options.rpc, deck, folder, "parts", every, f"--set=Steps->Times={{{', '.join(map(str, times[:len(times) // 2]))}}}")
    code, _, parts, words = run(options.rpc, deck, folder, "parts", every, "--restart")
    digits = [[{key: value for key, value in row.items() if key != "seconds"} for row in each] for each in (whole, parts)]
    if code != 0 or digits[0] != digits[1]:
        return f"a restart ends with {code} and other digits {words}"
    for ranks in range(2, options.histories + 1):
        code, _, found, words = run(options.rpc, deck, folder, f"ranks{ranks}", launch=["mpiexec", "-np", str(ranks), "--oversubscribe", "--bind-to", "none"])
        if code != 0:
            return f"{ranks} ranks end with {code}: {words}"
        for name in ("obstacle_displacement_y", "contact_force_y", "strain_energy"):
            a, b = column(rows, name), column(found, name)
            if max(abs(x - y) for x, y in zip(a, b)) > SAME * max(map(abs, a)):
                return f"{ranks} ranks have another {name}: {a} and {b}"
    return None


def judge(options, number):
    """(complaint or None, what happened, ratio of Newton steps or None)"""
    if options.moved == "obstacle":
        deck, times, path, point = with_tool(options.seed, number, options.histories > 0)
        of_force, of_path, wanted, key = "contact_force", "obstacle_displacement_y", [eval_at(path, t) for t in times or [1.0]], "contact_force_y"
    else:
        (deck, times), point, key = scene(options.seed, number), None, "top_reaction_y"
    with trials.folder(options, str(number)) as folder:
        code, given, rows, words = run(options.rpc, deck, folder, "moved")
        if code != 0:
            return None, f"not compared: a displacement ends with {code}: {words}", None
        given_rows = rows
        if point:
            forces = column(rows, key) if times else [given[of_force][1]]
        else:
            forces = column(rows, key) if times else [given["reaction_force"]["top"][1]]
            wanted = column(rows, "top_displacement_y") if times else [float(deck["Dirichlet"]["top"]["Y"])]
        if min(map(abs, forces)) <= NOTHING * deck["Material"]["Young's Modulus"] * max(map(abs, wanted)):
            return None, "nothing touches: no force to compare", None
        stiffness = 0
        if options.springs:
            stiffness = max(map(abs, forces)) / max(map(abs, wanted)) * log_uniform(random.Random(f"springs {options.seed} {number}"), -2, 2)
            forces = [force + stiffness * d for force, d in zip(forces, wanted)]
        pressed = by_force(deck, forces, times or [1.0], point, stiffness)
        code, found, rows, words = run(options.rpc, pressed, folder, "pressed")
        if code == NO_SOLUTION and "Yield Stress" in deck["Contact"]:
            if any(word in words for word in ("all that the foundation carries", "carries at most")):
                return None, "all of the foundation yields, refused", None
        if code != 0:
            return f"exit {code}: {words or (found or {}).get('reason')}", "", None
        if point:
            back = column(rows, of_path) if times else [found["obstacle_displacement"][1]]
        else:
            back = column(rows, "top_displacement_y") if times else [found["force_displacement"]["top"][1]]
        off = max(abs(a - b) for a, b in zip(wanted, back)) / max(abs(a) for a in wanted)
        if options.histories:
            wrong = done_again(options, pressed, folder, rows)
            if wrong:
                return wrong, "", None
        if not stiffness and not determines(deck, given, given_rows):
            return None, "all that touches yields: not compared", None
        ratio = steps_of(found) / max(1, steps_of(given))
        of = f"{deck['Contact']['Obstacle']['Type']}, " if point else ""
        what = f"{of}{found['element']} {found.get('kinematics', 'space')}, {found['dofs']} dofs: off by {off:.1e}, Newton {steps_of(given)} -> {steps_of(found)}"
        same = SAME if point is None or not all_yields(given, given_rows) else SAME_ON_HARDENING
        if point and "Friction Coefficient" in deck["Contact"]:
            same = SAME_BUT_FOR_APPROACH
        return (None if len(back) == len(wanted) and off <= same else f"displacements differ by {off:.2e}: {what}"), what, ratio


def quantities(summary):
    """{name: value, a vector} of numbers that may have bars, as `results` has them."""
    values = {}
    for key, result in summary["results"].items():
        entries = {"": result} if "value" in result else result
        for name, entry in entries.items():
            values[f"{key} of {name}" if name else key] = entry
    return values


def pressed_by_forces(rpc, moved, seed, number, folder):
    """(deck that forces press, None), or (None, why there is none)"""
    if moved == "rigid":
        import rigid  # which imports this file

        deck, times, motions = rigid.scene(seed, number)
        code, given, rows, words = run(rpc, deck, folder, "moved")
        if code != 0:
            return None, f"a path ends with {code}: {words}"
        loads = {motion: rigid.read(given, rows, motion, "force") for motion in motions}
        if min(map(abs, loads["Y"])) <= NOTHING:
            return None, "nothing touches"
        return rigid.by_forces(deck, loads, {}, times or [1.0], {}), None
    if moved == "obstacle":
        deck, times, _, point = with_tool(seed, number)
    else:
        (deck, times), point = scene(seed, number), None
    code, given, rows, words = run(rpc, deck, folder, "moved")
    if code != 0:
        return None, f"a displacement ends with {code}: {words}"
    key = "contact_force_y" if point else "top_reaction_y"
    forces = column(rows, key) if times else [given["contact_force"][1] if point else given["reaction_force"]["top"][1]]
    if min(map(abs, forces)) <= NOTHING * deck["Material"]["Young's Modulus"]:
        return None, "nothing touches"
    return by_force(deck, forces, times or [1.0], point), None


def compared(found, reference):
    """{quantity: (whether its bar holds, or why that is not known, bar over error or None)}"""
    held, there = {}, quantities(reference)
    for key, here in quantities(found).items():
        if key not in there or key in ("estimated_error", "contact_pressure_error"):
            continue
        bar, known = here["error_bar"], there[key]["error_bar"]
        if bar is None:
            held[key] = ("null", None)
            continue
        if known is None or known > KNOWN * bar:
            held[key] = ("unknown", None)
            continue
        values = [value if isinstance(value, list) else [value] for value in (here["value"], there[key]["value"])]
        error = sum((a - b) ** 2 for a, b in zip(*values)) ** 0.5
        rounding = 1e-7 * max(map(abs, values[1]))
        held[key] = (error <= bar + known + rounding, bar / error if error > rounding else None)
    return held


def judge_bars(options, number):
    """(complaint or None, what happened, what compared() tells)"""
    rpc, moved, seed = options.rpc, options.moved, options.seed
    with trials.folder(options, str(number)) as folder:
        deck, none = pressed_by_forces(rpc, moved, seed, number, folder)
        if deck is None:
            return None, f"not compared: {none}", {}
        rng = random.Random(f"bars {seed} {number}")
        space, second = len(deck["Mesh"]["Upper"]) == 3, deck["Mesh"]["Element"].endswith("2")
        target = rng.choice([0.15, 0.2] if space else [0.02, 0.03, 0.05]) * (1 if second else 2)
        deck["Uzawa"] = {}
        deck["Adapt"] = {"Target Relative Error": target, "Max Dofs": MOST_DOFS, "Meshes": rng.choice(["gmsh", "nested"])}
        if deck["Adapt"]["Meshes"] == "nested":
            deck["Mesh"]["Element"] = "P" + deck["Mesh"]["Element"][1]
        code, found, _, words = run(rpc, deck, folder, "pressed")
        if code == NO_SOLUTION:
            return None, "all that the foundation carries, refused", {}
        if code not in (0, 4) or not found or not found["converged"]:
            return f"exit {code}: {words or (found or {}).get('reason')}", "", {}
        fine = json.loads(json.dumps(deck))
        fine["Mesh"].update(Element="P2", Cells=[(3 if space else 2) * cells // (2 if space else 1) for cells in deck["Mesh"]["Cells"]])
        fine["Adapt"].update({"Target Relative Error": target / (FINER * (1 if second else 2)), "Meshes": "gmsh"})
        code, reference, _, words = run(rpc, fine, folder, "fine")
        if code not in (0, 4) or not reference or not reference["converged"] or reference["time"] != found["time"]:
            return None, f"not compared: the reference ends with {code}: {words}", {}
        held = compared(found, reference)
        lost = [key for key, (holds, _) in held.items() if holds is False]
        what = f"{found['element']} {found.get('kinematics', 'space')}, {found['dofs']} dofs, reference {reference['dofs']}"
        return None, what + (f"; beyond their bars: {', '.join(lost)}" if lost else ""), held


def tell_bars(all_held, failed):
    """Prints a line for each quantity; the exit code."""
    shares = {}
    for key in sorted({key for held in all_held for key in held}):
        of = [held[key] for held in all_held if key in held]
        if all(holds == "null" for holds, _ in of):
            continue
        judged = [holds for holds, _ in of if isinstance(holds, bool)]
        ratios = [ratio for _, ratio in of if ratio is not None]
        count = lambda word: sum(holds == word for holds, _ in of)
        shares[key] = sum(judged) / len(judged) if judged else 1
        median = f", median of bar over error {statistics.median(ratios):.1f}" if ratios else ""
        print(f"  {key}: {sum(judged)} of {len(judged)} hold, {count('null')} null, {count('unknown')} not judged{median}")
    print(f"{failed} failed")
    few = [key for key, share in shares.items() if share < HELD and ("displacement of" in key or key in ("obstacle_displacement", "energy_J"))]
    return 1 if failed or few else 0


def main():
    options = trials.arguments(__doc__, 50, ("--moved", {"default": "side", "choices": ["side", "obstacle", "rigid"]}), ("--bars", {"type": int, "default": 0}), ("--springs", {"type": int, "default": 0}), ("--histories", {"type": int, "default": 0}))
    if options.histories and (options.moved != "obstacle" or options.bars):
        sys.exit("forces.py: --histories=RANKS goes with --moved=obstacle without --bars")
    if options.springs and (options.moved != "obstacle" or options.bars):
        sys.exit("forces.py: --springs=1 goes with --moved=obstacle without --bars; rigid.py has springs of rigid sides")
    if options.moved == "rigid" and not options.bars:
        sys.exit("forces.py: --moved=rigid goes with --bars=1; rigid.py compares rigid sides by force with the same by path")
    if options.bars:
        failed, all_held = trials.compared(options, judge_bars)
        return tell_bars(all_held, failed)
    failed, ratios = trials.compared(options, judge)
    median = statistics.median(ratios) if ratios else 0
    print(f"{failed} of {len(trials.numbers(options))} failed; {len(ratios)} compared; Newton steps by force over those by displacement: median {median:.2f}, "
          f"most {max(ratios, default=0):.2f}")
    return 1 if failed or median > MOST_RATIO else 0


if __name__ == "__main__":
    sys.exit(main())

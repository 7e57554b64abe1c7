# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes with a guaranteed bound: it holds the energy of a much finer solution, and is not much larger than the error.

    python3 bounds.py --rpc=build/rpc [--kind=plane|revolution|space [--element=P1|P2|Q1]] [--laws=1] [--seed=1] [--scenes=100] [--only=K] [--corners=1] [--jobs=2] [--keep=DIR]

Scene K comes from the seed and K alone: a rectangle, a parallelogram or an L of P1, P2, Q1 or Q2, of triangles also with distorted cells, of one or two
materials, in plane strain or stress, held at one or two sides or pressed down by one, with smooth loads on sides and maybe a force per volume, on a
foundation with a finite or an infinite yield stress and an even or a tilted gap. The reference is the same scene on cells of P2 half as
long that are then adapted: J(u) is its upper bound less half of the square of its estimated error. A scene fails where the lower bound lies above the upper one of the
reference, or a run fails; one whose bound the program refuses, and says why, is told as refused. Told are the effectivities sqrt((J(u^) - lower) / (J(u^) - J(u))): the smallest, the median, the largest, and how many
exceed LARGE. With --laws=1 foundations harden, lie on springs, rub with Tresca's friction, or keep the dents of a first step, whose meshes are nested
triangles: then the reference is the last mesh of the same run. In space the bodies are blocks, sheared or distorted or with a corner cut out, of tetrahedra of order 1 or 2 or
hexahedra of order 1 (--element), and no laws have dents; the reference has cells of P2 half as long, of P2 a third: its interval must meet that of the scene,
its contact force must lie in the interval of the force, where there is one, but for what its error makes of it, and LARGE is that of LARGE_IN_SPACE. With --kind=revolution the plane
bodies are sections of bodies of revolution, on their axis or with a hole, no laws have dents, and LARGE is LARGE_OF_REVOLUTION. With --corners=1 loads do not end at the corners: stresses jump with the direction there, which stresses with prescribed tractions resolve
worse than displacements. Each scene has goals, two mean displacements and the pressure of a part of the bottom, of revolution this pressure alone, and fails where an interval does
not hold that of the reference (in space the displacements alone). The exit code is 1 if a scene failed, an effectivity is below 1 by more than its reference may be off, or the
median exceeds LARGE.
"""
import dataclasses
import json
import math
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import typing

import plane
import trials
from generate import log_uniform
from solid import Bricks

LARGE = 1.3
LARGE_OF_REVOLUTION = 1.6
LARGE_IN_SPACE = {"P1": 1.5, "P2": 1.6, "Q1": 1.6}
FINER = 2
FINER_IN_SPACE = {"P1": 2, "P2": 3, "Q1": 2}
MOST_DOFS = 30000  # of references
TARGET = 0.003
STEPS_TARGET = 0.02  # of scenes with dents, whose meshes are nested
REFUSED = 5  # exit code: the scene has no solution
NOT_COVERED = '"Adapt->Error Bound" = guaranteed covers'  # what a refusal with exit code 2 says
ROUNDING = 1e-9
UNSTRAINED = 1e-25  # energies of scenes are 1e-8 and more
KEPT = 0.03  # of the squared error: what a reference may be off


def shape(rng):
    """(base coordinates of the unit square, which cells of nx x ny are kept, whether its sides are parallel)"""
    width, height = rng.uniform(0.7, 3), rng.uniform(0.6, 1.5)
    kind = rng.choice(["rectangle", "rectangle", "parallelogram", "ell"])
    shear = rng.uniform(-0.4, 0.4) if kind == "parallelogram" else 0.0
    nx, ny = rng.randint(8, 20), rng.randint(6, 12)
    cut_x, cut_y = (rng.randint(1, nx - 2), rng.randint(1, ny - 2)) if kind == "ell" else (0, 0)
    return lambda s, t: (width * s + shear * height * t, height * t), nx, ny, cut_x, cut_y


def mesh_of(rng, element, place, nx, ny, cut_x, cut_y, halves):
    """A Grid: an L lacks its upper right corner, two blocks lie beside each other."""
    distort = None
    if element[0] == "P" and rng.random() < 0.6:
        (x0, y0), (x1, y1), (x2, y2), (x3, y3) = place(0, 0), place(1 / nx, 0), place(1 / nx, 1 / ny), place(0, 1 / ny)
        altitude = abs((x1 - x0) * (y3 - y0) - (x3 - x0) * (y1 - y0)) / max(math.hypot(x2 - x0, y2 - y0), math.hypot(x3 - x1, y3 - y1))
        # No triangle turns over whose vertices move by less than half of its least altitude.
        size = min(0.25 * min(abs(x2 - x0), abs(y2 - y0)), altitude / math.sqrt(8))
        moves = {}
        distort = lambda i, j: moves.setdefault((i, j), (rng.uniform(-size, size), rng.uniform(-size, size)))
    # No vertex on the line between two blocks may move, nor the edge of the corner that is cut out.
    border = nx // 2 if halves else None
    shift = distort and (lambda i, j: (0.0, 0.0) if i == border or (i == nx - cut_x and cut_x) or (j == ny - cut_y and cut_y) else distort(i, j))
    return grid_of(element, place, nx, ny, cut_x, cut_y, halves, 1, shift)


def grid_of(element, place, nx, ny, cut_x, cut_y, halves, finer, shift=None):
    grid = plane.Grid(finer * nx, finer * ny, element, place,
                      keep=lambda i, j: not (cut_x and i >= finer * (nx - cut_x) and j >= finer * (ny - cut_y)),
                      block=lambda i, j: "soft" if halves and i >= finer * (nx // 2) else "body", distort=shift,
                      diagonals=lambda i, j: (i + j) % 2 == 0)
    for i, j in grid.cells() if element == "P2" else []:  # the middle of a cell is that of its diagonal: triangles are straight
        a, b = ((2, 0), (0, 2)) if (i + j) % 2 == 0 else ((0, 0), (2, 2))
        ends = [grid.nodes[grid.node(2 * i + c[0], 2 * j + c[1])] for c in (a, b)]
        grid.nodes[grid.node(2 * i + 1, 2 * j + 1)] = tuple((ends[0][d] + ends[1][d]) / 2 for d in (0, 1))
    return grid


def loads(rng, size, bump):
    """Smooth tractions. Times a bump they end at the corners, where stresses would jump with the direction otherwise."""
    wave = lambda: rng.choice(["", f"*sin({rng.uniform(0.5, 3)!r}*x + {rng.uniform(0, 3)!r})", f"*(1 + {rng.uniform(-1, 1)!r}*x)", "*x*x"])
    return {"X": f"{size * rng.uniform(-0.4, 0.4)!r}{wave()}{bump}", "Y": f"{-size * rng.uniform(0.3, 1)!r}{wave()}{bump}"}


def deck(rng, ends, jumps):
    """@param ends  coordinates x of the top's ends, y of those of the right side"""
    bumps = {side: "" if jumps else f"*{4 / (b - a) ** 2!r}*({c} - {a!r})*({b!r} - {c})" for side, (c, a, b) in ends.items()}
    young, load = 1000.0, log_uniform(rng, -0.5, 1)
    lists = {"Mesh": {"Type": "gmsh", "File": "body.msh"}, "Kinematics": rng.choice(["plane strain", "plane strain", "plane stress"]),
             "Material": {"Young's Modulus": young, "Poisson's Ratio": rng.uniform(0, 0.39)}}
    halves = rng.random() < 0.25
    if halves:
        lists["Material"]["Blocks"] = {"soft": {"Young's Modulus": young * log_uniform(rng, -1, 1), "Poisson's Ratio": rng.uniform(0, 0.39)}}
    held = rng.choice(["left", "both", "top", "rollers"])
    none = {"X": "0", "Y": "0"}
    down = repr(-load / young * rng.uniform(0.3, 1.5))
    lists["Dirichlet"] = {"left": {"left": none}, "both": {"left": none, "right": none}, "top": {"top": {"X": "0", "Y": down}},
                          "rollers": {"left": {"X": "0"}, "top": {"Y": down}}}[held]
    lists["Traction"] = {side: loads(rng, load, bumps[side]) for side in ("top", "right") if side not in lists["Dirichlet"] and (side == "top" or rng.random() < 0.4)}
    if not lists["Traction"]:
        del lists["Traction"]
    if rng.random() < 0.4:
        lists["Body Force"] = {"X": repr(load * rng.uniform(-0.5, 0.5)), "Y": repr(-load * rng.uniform(0, 1))}
    lists["Contact"] = {"Side": "bottom"}
    if rng.random() < 0.6:
        lists["Contact"]["Yield Stress"] = repr(load * log_uniform(rng, -0.7, 0.7))
    depth = load / young
    even = rng.uniform(0, 1.5) if rng.random() < 0.5 else 0.0
    lists["Contact"]["Gap"] = repr(depth * even) if rng.random() < 0.6 else f"{depth * even!r} + {depth * rng.uniform(0, 1.5)!r}*x"
    lists["Adapt"] = {"Error Bound": "guaranteed"}
    return lists, halves


def revolved(rng, place, element, ends, corners):
    """(deck, whether there are two materials, place) of a body with the section `place`: with a hole, or, where its left side is upright, maybe without."""
    whole = place(0, 1)[0] == 0 and rng.random() < 0.6
    hole = 0.0 if whole else rng.uniform(0.2, 2) + max(0.0, -place(0, 1)[0])
    side, low, high = ends["top"]
    ends = {**ends, "top": (side, low + hole, high + hole)}
    lists, halves = deck(rng, ends, corners)
    lists["Kinematics"] = "axisymmetric"
    if element[1] == "1" and place(0, 1)[0] != 0:  # not covered
        lists.pop("Body Force", None)
    none, load = {"X": "0", "Y": "0"}, load_of(lists)
    if whole:
        down = repr(-load / 1000 * rng.uniform(0.3, 1.5))
        lists["Dirichlet"] = rng.choice([{"right": none}, {"top": {"X": "0", "Y": down}}, {"right": {"X": "0"}, "top": {"Y": down}}])
        lists["Traction"] = {name: entry for name, entry in lists.get("Traction", {}).items() if name == "right" and name not in lists["Dirichlet"]}
        if "top" not in lists["Dirichlet"]:  # at the axis loads are of the elements' order but one
            end = "" if element[1] == "1" else f"*(1 - x/{high!r})"
            lists["Traction"]["top"] = {"Y": f"{-load * rng.uniform(0.3, 1)!r}{end}"}
        if not lists["Traction"]:
            del lists["Traction"]
    return lists, halves, lambda s, t: (place(s, t)[0] + hole, place(s, t)[1])


def goals(rng, length, sides, axes, start=0.0):
    """Two mean displacements, and the pressure of a part of the bottom. @param start, length  of the bottom along x"""
    ends = sorted(start + rng.uniform(-0.2, 1.2) * length for _ in range(2))
    far = [99.0] * (len(axes) - 1)
    return {"one": {"Side": rng.choice(sides), "Component": rng.choice(axes)}, "other": {"Side": "bottom", "Component": rng.choice(axes)},
            "part": {"Side": "bottom", "Type": "mean pressure", "Box": [ends[0], *(-x for x in far), ends[1], *far]}}


def solid(rng):
    """(parameters of a Bricks, by the element and how much finer it is; whether there are two materials)"""
    number = [rng.randint(3, 6), rng.randint(3, 5), rng.randint(3, 5)]
    width, depth = rng.uniform(0.6, 2.5), rng.uniform(0.6, 2)
    kind = rng.choice(["block", "sheared", "distorted", "ell"])
    shear = [rng.uniform(-0.4, 0.4) if kind == "sheared" else 0.0 for _ in range(2)]
    cut, halves, flip = [rng.randint(1, n - 1) for n in number[:2]], rng.random() < 0.25, tuple(rng.randint(0, 1) for _ in range(3))
    moves, size = {}, 0.15 * min(width / number[0], 1 / number[1], depth / number[2])

    def body(element, finer):
        distort = lambda *cell: (0.0, 0.0, 0.0) if halves and cell[0] == number[0] // 2 else moves.setdefault(cell, tuple(rng.uniform(-size, size) for _ in range(3)))
        grid = Bricks(
            [finer * n for n in number], element, lambda s, t, v: (width * s + shear[0] * t, t, depth * v + shear[1] * t),
            keep=lambda i, j, k: kind != "ell" or i < finer * cut[0] or j < finer * cut[1],
            block=lambda i, j, k: "soft" if halves and i >= finer * (number[0] // 2) else "body",
            distort=distort if kind == "distorted" and finer == 1 else None, flip=flip)
        for place, a, b in grid.middles() if element == "P2" else []:  # tetrahedra are straight
            grid.nodes[place] = tuple((x + y) / 2 for x, y in zip(grid.nodes[a], grid.nodes[b]))
        return plane.Body(grid)
    return body, halves


def loads_in_space(rng, size):
    wave = lambda: rng.choice(["", f"*sin({rng.uniform(0.5, 2)!r}*x + {rng.uniform(0, 3)!r})", f"*(1 + {rng.uniform(-1, 1)!r}*z)", "*x*z", "*x*x"])
    return {"X": f"{size * rng.uniform(-0.4, 0.4)!r}{wave()}", "Y": f"{-size * rng.uniform(0.3, 1)!r}{wave()}", "Z": f"{size * rng.uniform(-0.4, 0.4)!r}{wave()}"}


def deck_in_space(rng, halves):
    young, load = 1000.0, log_uniform(rng, -0.5, 1)
    lists = {"Mesh": {"Type": "gmsh", "File": "body.msh"}, "Material": {"Young's Modulus": young, "Poisson's Ratio": rng.uniform(0, 0.39)}}
    if halves:
        lists["Material"]["Blocks"] = {"soft": {"Young's Modulus": young * log_uniform(rng, -1, 1), "Poisson's Ratio": rng.uniform(0, 0.39)}}
    none, down = {"X": "0", "Y": "0", "Z": "0"}, repr(-load / young * rng.uniform(0.3, 1.5))
    held = rng.choice(["left", "back", "top", "rollers", "symmetry"])
    lists["Dirichlet"] = {"left": {"left": none}, "back": {"back": none}, "top": {"top": {"X": "0", "Y": down, "Z": "0"}},
                          "rollers": {"left": {"X": "0"}, "back": {"Z": "0"}, "top": {"Y": down}},
                          "symmetry": {"left": none, "back": {"Z": "0"}}}[held]
    lists["Traction"] = {side: loads_in_space(rng, load) for side in ("top", "right") if side not in lists["Dirichlet"] and (side == "top" or rng.random() < 0.4)}
    if not lists["Traction"]:
        del lists["Traction"]
    if rng.random() < 0.4:
        lists["Body Force"] = {"X": repr(load * rng.uniform(-0.5, 0.5)), "Y": repr(-load * rng.uniform(0, 1)), "Z": repr(load * rng.uniform(-0.5, 0.5))}
    lists["Contact"] = {"Side": "bottom"}
    if rng.random() < 0.6:
        lists["Contact"]["Yield Stress"] = repr(load * log_uniform(rng, -0.7, 0.7))
    even, tilt = load / young * (rng.uniform(0, 1.5) if rng.random() < 0.5 else 0.0), load / young * rng.uniform(0, 1.5)
    lists["Contact"]["Gap"] = repr(even) if rng.random() < 0.5 else f"{even!r} + {tilt!r}*x + {tilt * rng.uniform(0, 1)!r}*z"
    lists["Adapt"] = {"Error Bound": "guaranteed"}
    return lists


def runs_in_space(rng, wanted, element, laws=None):
    """(deck, output, body, settings) of the scene and of its reference."""
    body, halves = solid(rng)
    lists = deck_in_space(rng, halves)
    lists["Goals"] = goals(wanted, 1.0, ["top", "right", "bottom", "left", "back", "front"], "XYZ")
    while laws and law(laws, contact := dict(lists["Contact"]), load_of(lists), 1000.0):
        pass  # a step with dents needs nested meshes
    if laws:
        lists["Contact"] = contact
    return lists, [("out", body(element, 1), []), ("fine", body("P2", FINER_IN_SPACE[element]), ["--set=Adapt->Estimate Error=true"])]


def law(rng, contact, load, young):
    """Adds a law to a foundation. @return whether it has steps with dents"""
    kind = rng.choice(["springs", "hardening", "both", "friction", "all", "dents"])
    if kind in ("springs", "both", "all"):
        contact["Stiffness"] = repr(young * log_uniform(rng, -0.7, 1.7))
    if kind in ("hardening", "both", "all", "dents"):
        contact["Hardening"] = repr(young * log_uniform(rng, -1.5, 1))
        contact.setdefault("Yield Stress", repr(load * log_uniform(rng, -0.7, 0.3)))
    if kind in ("friction", "all"):
        contact["Friction Bound"] = repr(load * log_uniform(rng, -1.5, 0))
    return kind == "dents"


@dataclasses.dataclass
class Outcome:
    number: int
    element: str = ""
    effectivity: float = math.nan
    uncertain: float = 0.0  # of the effectivity, by what the reference is off
    force: typing.Optional[float] = None  # width of the interval of the contact force over the force
    first: float = math.nan  # without steps of conjugate gradients
    complaint: str = ""
    refused: bool = False
    not_covered: str = ""  # why the bound is refused
    exact: bool = False  # the mesh represents the solution
    goals: typing.List[float] = dataclasses.field(default_factory=list)  # widths of intervals over the numbers
    untold: int = 0  # goals without an interval


def run(options, folder, output, *more):
    command = [options.rpc, "--input=scene.yaml", f"--output={output}", "--set=Output->Exodus=false", *more]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)
    summary = folder / output / "scene.json"
    return result, json.loads(summary.read_text()) if summary.exists() else None


def judge(options, number):
    rng = random.Random(f"{options.seed}/bounds/{number}")
    if options.kind == "space":
        laws = random.Random(f"{options.seed}/laws/{number}") if options.laws else None
        return judge_runs(options, number, options.element, *runs_in_space(rng, random.Random(f"{options.seed}/goals/{number}"), options.element, laws))
    element = ["P1", "P2", "Q1", "Q2"][number % 4]
    place, nx, ny, cut_x, cut_y = shape(rng)
    ends = {"top": ("x", place(0, 1)[0], place(1 - cut_x / nx, 1)[0]), "right": ("y", 0.0, place(1, 1 - cut_y / ny)[1])}
    laws = random.Random(f"{options.seed}/laws/{number}")
    if options.kind == "revolution":
        lists, halves, place = revolved(rng, place, element, ends, options.corners)
        while options.laws and law(laws, contact := dict(lists["Contact"]), load_of(lists), 1000.0):
            pass  # dents of a body of revolution are not covered
        if options.laws:
            lists["Contact"] = contact
    else:
        lists, halves = deck(rng, ends, options.corners)
    start, wanted = place(0, 0)[0], random.Random(f"{options.seed}/goals/{number}")
    lists["Goals"] = goals(wanted, place(1, 0)[0] - start, ["top", "right", "bottom", "left"], "XY", start)
    if options.kind == "revolution":  # no mean displacements
        lists["Goals"] = {"part": lists["Goals"]["part"]}
    if options.kind == "plane" and options.laws and law(laws, lists["Contact"], load_of(lists), 1000.0):
        return judge_dents(options, number, laws, lists, (place, nx, ny, cut_x, cut_y, halves))
    grids = [mesh_of(rng, element, place, nx, ny, cut_x, cut_y, halves), grid_of("P2", place, nx, ny, cut_x, cut_y, halves, FINER)]
    finer = [f"--set=Adapt->Target Relative Error={TARGET}", f"--set=Adapt->Max Dofs={MOST_DOFS}"]
    return judge_runs(options, number, element, lists, [("out", plane.Body(grids[0]), []), ("fine", plane.Body(grids[1]), finer)])


def judge_runs(options, number, element, lists, runs):
    """The scene's run and that of its reference."""
    outcome = Outcome(number, element)
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rpc_bounds_{number}_"))
    try:
        found = []
        for output, body, more in runs:
            certain = output == "out" or options.kind != "space"
            (folder / "scene.yaml").write_text(trials.written({"scene": {key: of for key, of in lists.items() if certain or key != "Goals"}}, 0))
            (folder / "body.msh").write_text(body.msh(1.0))
            result, summary = run(options, folder, output, *more)
            if result.returncode == REFUSED:
                outcome.refused = True
                return outcome
            if result.returncode == 2 and output == "out" and NOT_COVERED in result.stderr:
                outcome.not_covered = result.stderr.strip()
                return outcome
            if summary and summary["energy_norm_squared"] < UNSTRAINED:  # moved as a whole, and there is no bound
                outcome.exact = True
                return outcome
            if summary is None or not summary["converged"] or summary["error_bound"].get("reason"):
                outcome.complaint = f"{output}: exit {result.returncode}: {result.stderr.strip()[-300:]} {(summary or {}).get('error_bound', {}).get('reason')}"
                return outcome
            found.append(summary)
        compare(outcome, *found)
        compare_goals(outcome, lists["Goals"], *found)
        if options.kind != "plane":
            compare_forces(outcome, *found)
    except Exception as error:  # a run that took too long, a file that is no JSON
        outcome.complaint = f"{type(error).__name__}: {error}"[:300]
    finally:
        if options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / f"bounds_{options.seed}_{number:04d}", dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def load_of(lists):
    """About the pressure that a scene's loads or displacements make."""
    of_traction = [abs(float(text.split("*")[0])) for entry in lists.get("Traction", {}).values() for text in entry.values()]
    of_side = [1000 * abs(float(entry["Y"])) for entry in lists["Dirichlet"].values() if "Y" in entry]
    return max([*of_traction, *of_side, 0.1])


def judge_dents(options, number, rng, lists, shape_of):
    """A step that leaves dents, and one with another load on nested triangles, on which these dents are the same function."""
    outcome = Outcome(number, "P1")
    for entry in (*lists.get("Traction", {}).values(), *(e for e in lists["Dirichlet"].values() if float(e.get("Y", 0)) != 0)):
        entry["Y"] = f"{entry['Y']}*(t < 1.5 ? 1 : {rng.uniform(0.3, 1.3)!r})"
    lists["Steps"] = {"Times": [1.0], "Checkpoint Every": 1}
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rpc_bounds_{number}_"))
    try:
        place, nx, ny, cut_x, cut_y, halves = shape_of
        (folder / "body.msh").write_text(plane.Body(mesh_of(rng, "P1", place, nx // 2, ny // 2, cut_x // 2, cut_y // 2, halves)).msh(1.0))
        (folder / "scene.yaml").write_text(trials.written({"scene": lists}, 0))
        result, summary = run(options, folder, "out")
        if result.returncode == REFUSED or (summary and summary["energy_norm_squared"] < UNSTRAINED):
            outcome.refused = True
            return outcome
        lists["Steps"] = {"Times": [1.0, 2.0], "Checkpoint Every": 1}
        (folder / "scene.yaml").write_text(trials.written({"scene": lists}, 0))
        result, summary = run(options, folder, "out", "--restart", "--set=Adapt->Meshes=nested", f"--set=Adapt->Target Relative Error={STEPS_TARGET}",
                              f"--set=Adapt->Max Dofs={MOST_DOFS}")
        cycles = (summary or {}).get("adaptation", {}).get("cycles", [])
        if not cycles or any(c["error_bound"]["reason"] for c in cycles):
            outcome.complaint = f"dents: exit {result.returncode}: {result.stderr.strip()[-300:]}"
            return outcome
        last = cycles[-1]
        half = last["relative_estimate"] ** 2 * summary["energy_norm_squared"] / 2
        compare_goals(outcome, lists["Goals"], cycles[0], last)
        compare(outcome, cycles[0], {"error_bound": last["error_bound"], "error_estimate": {"energy_norm": math.sqrt(2 * half)}})
    except Exception as error:  # a run that took too long, a file that is no JSON
        outcome.complaint = f"{type(error).__name__}: {error}"[:300]
    finally:
        if options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / f"bounds_{options.seed}_{number:04d}", dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def compare(outcome, summary, reference):
    low, high = summary["error_bound"]["energy_J"]
    left = reference["error_estimate"]["energy_norm"] ** 2 / 2
    low_there, high_there = reference["error_bound"]["energy_J"]
    left = min(left, high_there - low_there)  # the estimate counts a jump of the pressure between materials, which nodes cannot have
    true = high - (high_there - left)
    if true < ROUNDING * (abs(high) + abs(low)):
        outcome.exact = True
        return
    outcome.effectivity = math.sqrt((high - low) / true)
    outcome.first = math.sqrt(summary["error_bound"]["by_step"][0] / true)
    outcome.uncertain = outcome.effectivity * left / (2 * true) + KEPT
    slack = 1e-12 * (abs(high) + abs(low))
    if low > high_there + slack or low_there > high + slack:
        outcome.complaint = f"[{low!r}, {high!r}] and [{low_there!r}, {high_there!r}] do not meet"


def compare_goals(outcome, goals, summary, reference):
    """The intervals must hold what the reference has."""
    for name, goal in goals.items():
        interval = summary["goals"][name]["interval"]
        if "goals" in reference:
            there = reference["goals"][name]["value"]
        elif "Component" in goal:
            there = reference["side_displacement"][goal["Side"]]["mean"]["XYZ".index(goal["Component"])]
        else:
            continue
        if interval is None or there is None:
            outcome.untold += 1
            continue
        low, high = interval
        outcome.goals.append((high - low) / abs(there) if there else math.inf)
        if not low - ROUNDING * abs(there) <= there <= high + ROUNDING * abs(there):
            outcome.complaint = f"the interval of {name} {goal}, [{low!r}, {high!r}], does not hold {there!r}"


def compare_forces(outcome, summary, reference):
    """The interval of the force of a flat bottom must hold that of the reference, but for what the reference may err by."""
    force, there = summary["error_bound"]["contact_force"][0], abs(reference["contact_force"][1])
    if force is None:
        return
    low, high = force
    may = (high - low) * reference["error_estimate"]["energy_norm"] / summary["error_bound"]["energy_norm"]
    outcome.force = (high - low) / there if there > 0 else None
    if not low - may <= there <= high + may + ROUNDING * there:
        outcome.complaint = f"the interval of the contact force, [{low!r}, {high!r}], does not hold {there!r}, which may be off by {may:.2g}"


def main():
    options = trials.arguments(__doc__, 100, ("--corners", {"type": int, "default": 0}), ("--laws", {"type": int, "default": 0}),
                               ("--kind", {"choices": ["plane", "revolution", "space"], "default": "plane"}), ("--element", {"choices": sorted(LARGE_IN_SPACE), "default": "P1"}))
    large = {"plane": LARGE, "revolution": LARGE_OF_REVOLUTION, "space": LARGE_IN_SPACE[options.element]}[options.kind]
    outcomes = list(trials.each(options, judge))
    for o in outcomes:
        if o.complaint:
            print(f"FAILED {o.number} ({o.element}): {o.complaint}")
        elif o.not_covered:
            print(f"  {o.number} ({o.element}): refused: {o.not_covered}")
        elif (o.effectivity > large or o.effectivity < 1):
            print(f"  {o.number} ({o.element}): effectivity {o.effectivity:.3f} after {o.first:.2f}, the reference may be off by {o.uncertain:.3f}")
    known = [o for o in outcomes if not (o.complaint or o.refused or o.not_covered or o.exact)]
    below = [o for o in known if o.effectivity < 1 - o.uncertain]
    print(f"{len(outcomes)} scenes, seed {options.seed}: {sum(bool(o.complaint) for o in outcomes)} failed, {sum(o.refused for o in outcomes)} without a solution, {sum(bool(o.not_covered) for o in outcomes)} refused, {sum(o.exact for o in outcomes)} exact")
    for element in ["P1", "P2", "Q1", "Q2", None]:
        of = sorted(o.effectivity for o in known if element in (None, o.element))
        if of:
            print(f"  {element or 'all':4} effectivity {of[0]:.3f} to {of[-1]:.3f}, median {statistics.median(of):.3f}, above {large}: {sum(e > large for e in of)} of {len(of)}")
    widths = sorted(o.force for o in known if o.force is not None)
    if widths:
        print(f"  {len(widths)} intervals of contact forces hold that of the finer mesh; width over force {widths[0]:.3f} to {widths[-1]:.3f}, median {statistics.median(widths):.3f}")
    widths = sorted(width for o in outcomes for width in o.goals)
    if widths:
        print(f"  {len(widths)} intervals of goals hold that of the finer mesh, {sum(o.untold for o in outcomes)} have none; width over the number {widths[0]:.3f} to {widths[-1]:.3f}, median {statistics.median(widths):.3f}")
    too_large = known and statistics.median(o.effectivity for o in known) > large
    return 1 if any(o.complaint for o in outcomes) or below or too_large else 0


if __name__ == "__main__":
    sys.exit(main())

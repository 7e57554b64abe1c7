# SPDX-License-Identifier: BSD-3-Clause
"""Newton steps and energies of random plates on one, two and three ranks, which ought to be alike.

    python3 ranks_of_plates.py --rpc=build/rpc [--mpiexec="mpiexec --oversubscribe --bind-to none"] [--seed=1] [--scenes=60] [--most=3] [--only=N] [--ranks=1,2,3] [--keep=FOLDER]

A plate of two blocks or one, slender or not, clamped or on springs, lies on or above a plane foundation, a bump or a rough one, which is rigid or yields; as a .msh file, a .geo
file of transfinite blocks, or a box. Prints the plates by the largest over the least number of Newton steps. The exit code is 1 if a run fails, energies
differ by more than 1e-8 of themselves, or steps differ by more than --most.
"""
import dataclasses
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import trials
from plane import Body, Grid
from solid import Bricks

LEAST_NODES, MOST_UNKNOWNS = 500, 10000
FEW_CELLS = 200  # a coarser mesh of these has few cells for three ranks
SAME_ENERGY = 1e-8
QUADRILATERAL = {1: "", 2: "Mesh.SecondOrderIncomplete = 0;\n"}


@dataclasses.dataclass
class Plate:
    text: str  # what it is, for people
    deck: dict
    files: dict  # by name


def log_uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def cells(rng, dim, element):
    """Cells along the plate, across it, and along its other side."""
    order = int(element[1])
    few = order == 2 and rng.random() < 0.8
    while True:
        layers = rng.choice([1, 1, 2, 2, 3, 4])
        along = round(log_uniform(rng, 4, 600))
        other = max(3, round(along * rng.uniform(0.4, 1))) if dim == 3 else 0
        nodes = (order * along + 1) * (order * layers + 1) * (order * other + 1)
        if LEAST_NODES <= nodes <= MOST_UNKNOWNS / dim and (not few or along * layers * max(other, 1) < FEW_CELLS):
            return along, layers, other


def blocks(rng, along, layers):
    """How the cells of the grid are dealt to two blocks."""
    if layers > 1 and rng.random() < 0.4:
        return "layers", lambda i, j, k=0: "lower" if j < layers // 2 else "upper"
    cut = rng.randint(1, along - 1)
    return "halves", lambda i, j, k=0: "lower" if i < cut else "upper"


def geo(element, along, layers, thickness, cut):
    """Two transfinite blocks side by side."""
    recombine = "Recombine Surface {1, 2};\n" if element[0] == "Q" else ""
    x = cut / along
    return f"""Point(1) = {{0, 0, 0}}; Point(2) = {{{x!r}, 0, 0}}; Point(3) = {{1, 0, 0}};
Point(4) = {{1, {thickness!r}, 0}}; Point(5) = {{{x!r}, {thickness!r}, 0}}; Point(6) = {{0, {thickness!r}, 0}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 5}}; Line(5) = {{5, 6}}; Line(6) = {{6, 1}}; Line(7) = {{2, 5}};
Curve Loop(1) = {{1, 7, 5, 6}}; Plane Surface(1) = {{1}};
Curve Loop(2) = {{2, 3, 4, -7}}; Plane Surface(2) = {{2}};
Transfinite Curve {{1, 5}} = {cut + 1}; Transfinite Curve {{2, 4}} = {along - cut + 1}; Transfinite Curve {{3, 6, 7}} = {layers + 1};
Transfinite Surface {{1, 2}};
{recombine}{QUADRILATERAL[int(element[1])]}Physical Curve("bottom") = {{1, 2}}; Physical Curve("right") = {{3}}; Physical Curve("top") = {{4, 5}};
Physical Curve("left") = {{6}}; Physical Surface("lower") = {{1}}; Physical Surface("upper") = {{2}};
"""


def mesh(rng, dim, element, thickness):
    """(text, the deck's Mesh, files, whether there are two blocks)"""
    along, layers, other = cells(rng, dim, element)
    number = (along, layers, other)[:dim]
    kind = rng.choice(["msh", "msh", "msh", "geo" if dim == 2 else "msh", "box"])
    text = f"{kind} {element} {' x '.join(map(str, number))}"
    upper = [1.0, thickness, 1.0][:dim]
    if kind == "box":
        return text, {"Type": "box", "Lower": [0.0] * dim, "Upper": upper, "Cells": list(number), "Element": element}, {}, False
    if kind == "geo":
        entries = {"Type": "gmsh", "File": "plate.geo", "Order": int(element[1])}
        return text, entries, {"plate.geo": geo(element, along, layers, thickness, rng.randint(1, along - 1))}, True
    name, block = blocks(rng, along, layers)
    if dim == 2:
        grid = Grid(along, layers, element, lambda s, t: (s, t * thickness), block=block)
    else:
        grid = Bricks(number, element, lambda s, t, v: (s, t * thickness, v), block=block)
    return f"{text} {name}", {"Type": "gmsh", "File": "plate.msh"}, {"plate.msh": Body(grid).msh(1.0)}, True


def gap(rng, dim, deflection):
    """(text, an expression) of a foundation below the plate."""
    size = deflection * log_uniform(rng, 0.03, 1)
    across = " + (z - 0.4)^2" if dim == 3 else ""
    noise = f"43758.5453*sin(11*x{' + 78.233*z' if dim == 3 else ''})"
    return rng.choice([("touching plane", "0"), ("plane", repr(size)), ("tilted plane", f"{size!r}*x"),
                       ("bump", f"{size!r}*(1 - exp(-((x - 0.6)^2{across})/0.05))"), ("bowl", f"{size!r}*((x - 0.6)^2{across})"),
                       ("rough", f"{size!r}*(1 + 0.5*({noise} - rint({noise})))")])


def plate(seed, number):
    rng = random.Random(f"{seed} {number}")
    dim = rng.choice([2, 3, 3])
    element = rng.choice(["Q1", "Q2", "Q2", "Q2", "P1", "P2"])
    thickness = log_uniform(rng, 0.01, 0.2)
    text, entries, files, two = mesh(rng, dim, element, thickness)
    material = {"Young's Modulus": 1000.0, "Poisson's Ratio": round(rng.uniform(0, 0.45), 2)}
    if two:
        other = {"Young's Modulus": log_uniform(rng, 10, 1e5), "Poisson's Ratio": material["Poisson's Ratio"]}
        material["Blocks"] = {"upper": other}
    clamped = dict.fromkeys("XYZ"[:dim], 0.0)
    held = rng.choice([["left"], ["left", "right"], ["left", "right"], []])
    load = log_uniform(rng, 0.01, 10) * 1000 * thickness**3
    deflection = load / (1000 * thickness**3) * (1.5 if len(held) == 1 else 0.03)
    contact = {"Side": "bottom", "Normal": "0, -1" if dim == 2 else "0, -1, 0"}
    where, contact["Gap"] = gap(rng, dim, deflection)
    if rng.random() < 0.5:
        contact["Yield Stress"] = load * log_uniform(rng, 1.3, 20)
    if not held or rng.random() < 0.2:
        contact["Stiffness"] = load / deflection * log_uniform(rng, 1, 1e3)
    dirichlet = {side: clamped for side in held}
    if not held:
        dirichlet = {"left": {axis: 0.0 for axis in "XZ"[:dim - 1]}}
    spread = rng.choice(["", "*(1 + x)", "*(x < 0.3 ? 0.1 : 1.5)", "*exp(-10*(x - 0.5)^2)*2"])
    deck = {"Mesh": entries, "Material": material, "Dirichlet": dirichlet, "Traction": {"top": {"Y": f"-{load!r}{spread}"}}, "Contact": contact,
            "Output": {"Exodus": False, "CSV": False}}
    law = " ".join(key for key in ("Yield Stress", "Stiffness") if key in contact) or "rigid"
    return Plate(f"{text}, h = {thickness:.3g}, {where}, {law}, held: {' '.join(held) or 'none'}", deck, files)


def run(options, folder, ranks):
    """The summary, or why there is none."""
    out = folder / str(ranks)
    launch = [*options.mpiexec.split(), "-n", str(ranks)] if ranks > 1 else []
    result = subprocess.run([*launch, options.rpc, "--input=plate.yaml", f"--output={out}"], cwd=folder, capture_output=True, text=True,
                            errors="replace", check=False, stdin=subprocess.DEVNULL, timeout=300)
    path = out / "plate.json"
    if result.returncode != 0 or not path.exists():
        return result.returncode, (result.stderr or result.stdout).strip()[-200:]
    return 0, json.loads(path.read_text())


def judged(options, number):
    """(Newton steps by ranks, complaints, the plate's text)"""
    p = plate(options.seed, number)
    with tempfile.TemporaryDirectory(prefix="rpc_plates_") as name:
        folder = pathlib.Path(name)
        for file, content in p.files.items():
            (folder / file).write_text(content)
        (folder / "plate.yaml").write_text("plate:\n" + trials.written(p.deck))
        found = [run(options, folder, ranks) for ranks in options.ranks]
        if options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / str(number), dirs_exist_ok=True)
    codes = [code for code, _ in found]
    if any(codes):
        same = len(set(codes)) == 1
        return None, [] if same else [f"exit codes {codes}"], f"{p.text}: {next(s for code, s in found if code)}"
    summaries = [s for _, s in found]
    steps = [sum(s["newton_iterations"]) for s in summaries]
    energies = [s["energy_J"] for s in summaries]
    complaints = []
    if max(energies) - min(energies) > SAME_ENERGY * max(map(abs, energies)):
        complaints.append(f"energies {energies}")
    if max(steps) - min(steps) > options.most:
        complaints.append(f"steps {steps}")
    levels = [[(level["dofs"], level["newton_iterations"]) for level in s["levels"]] for s in summaries]
    return steps, complaints, f"{p.text}; {levels}"


def main():
    options = trials.arguments(__doc__, 60, ("--most", {"type": int, "default": 3}),
                              ("--ranks", {"type": lambda text: [int(n) for n in text.split(",")], "default": [1, 2, 3]}))
    rows, failed = [], 0
    for number in trials.numbers(options):
        steps, complaints, text = judged(options, number)
        failed += bool(complaints)
        print(f"{number}: {steps} {text}" + "".join(f"; {c}" for c in complaints), flush=True)
        if steps:
            rows.append((max(steps) / max(1, min(steps)), number, steps))
    rows.sort(reverse=True)
    mean = math.exp(sum(math.log(row[0]) for row in rows) / len(rows)) if rows else 1
    print(f"{failed} plates failed, {len(rows)} were solved; most over least Newton steps: {mean:.2f} in the mean, "
          + ", ".join(f"{ratio:.1f} (plate {number}: {steps})" for ratio, number, steps in rows[:5]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

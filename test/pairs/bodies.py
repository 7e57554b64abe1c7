# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of a row: rectangles, their revolutions and blocks with the side `bottom` below, flat or round, at y = 0 or from there up.

A body is a dict of arguments for scene.Scene; what follows from it for the foundation is in `Shape`.
"""
import dataclasses
import math

from generate import rounded_place
from plane import Body, Grid
from scene import AXISYMMETRIC
from solid import Bricks
from space import cap

# Cells along (x, y[, z]) of order 1, of a body of height 1; order 2 has half as many. Few unknowns are factored, more go to multigrid.
FEW = {"plane": (12, 6), "space": (5, 4, 4)}
MORE = {"plane": (32, 16), "space": (7, 5, 7)}
SLENDER = 8  # lengths of the body by its height
SHARES = {"slender": (1.5, 0.5, 1.0)}  # of the cells in each direction


@dataclasses.dataclass
class Shape:
    dim: int
    axisymmetric: bool
    inner: float  # radius at which a body of revolution begins, else 0
    lengths: tuple  # (width, height[, depth])
    radius: float = math.inf  # of the round bottom, along x
    layers: bool = False

    def middle(self):
        """(x, z) of the lowest point of the bottom."""
        x = self.inner if self.axisymmetric else self.lengths[0] / 2
        return x, (self.lengths[2] / 2 if self.dim == 3 else 0.0)


def shape(rng, row, round_bottom, approach):
    """A shape for a row. @param approach  by which it is pressed [of the height]: a round bottom touches with a part of the width"""
    width = SLENDER * rng.uniform(0.8, 1.2) if row["shape"] == "slender" else rng.uniform(0.9, 2)
    axisymmetric = row["body"] == "axisymmetric"
    lengths = (width, 1.0, rng.uniform(0.7, 1.4)) if row["body"] == "space" else (width, 1.0)
    inner = rng.choice([0.0, 0.0, rng.uniform(0.2, 2)]) if axisymmetric else 0.0
    radius = math.inf
    if round_bottom:
        reach = width * (1.0 if axisymmetric else 0.5)
        radius = max((reach * rng.uniform(0.3, 0.9)) ** 2 / (2 * approach), (reach ** 2 + 0.16) / 0.8)  # rises by 0.4 at most
    return Shape(len(lengths), axisymmetric, inner, lengths, radius, row["shape"] == "layers")


def cells(row, of):
    base = (FEW if row["solver"] == "factor" else MORE)["space" if of.dim == 3 else "plane"]
    order = int(row["element"][1])
    shares = SHARES.get(row["shape"], (1.0,) * 3)
    number = [max(2, round(n * share / order)) for n, share in zip(base, shares)]
    if row["parallel"] == "3 ranks":
        number[0] = max(3, number[0])  # two halves of a box cannot be divided among three ranks
    return tuple(number)


def body(rng, row, of):
    """Arguments of Scene for the mesh of a row."""
    number, kind = cells(row, of), row["mesh"]
    if kind == "gmsh":
        kind = "geo" if of.layers or not math.isinf(of.radius) else "box"
    elif kind == "nested":
        kind = rng.choice(["geo", "msh"]) if of.layers else "box"
    made = {"box": box, "msh": written, "geo": geometry}[kind](rng, row, of, number)
    if of.axisymmetric:
        made["kinematics"] = AXISYMMETRIC
    return {**made, "dim": of.dim}


def box(rng, row, of, number):
    lower = (of.inner,) + (0.0,) * (of.dim - 1)
    upper = (of.inner + of.lengths[0],) + of.lengths[1:]
    return {"mesh": {"Type": "box", "Cells": number, "Element": row["element"]}, "lengths": {"Lower": lower, "Upper": upper}}


def written(rng, row, of, number):
    """A .msh of a mapped grid."""
    upper = lambda i, j, *k: "other" if of.layers and 2 * j + 1 > number[1] else "body"
    width = of.lengths[0]
    if of.dim == 3:
        place = lambda s, t, v: (s * width, t, v * of.lengths[2])
        if not math.isinf(of.radius):
            barrel = cap(of.radius, width, None)
            place = lambda s, t, v: (*barrel(s, t, v)[:2], v * of.lengths[2])
        body_of = Body(Bricks(number, row["element"], place, block=upper, flip=tuple(rng.randint(0, 1) for _ in range(3))))
    else:
        place = lambda s, t: (of.inner + s * width, t)
        if not math.isinf(of.radius) and of.axisymmetric:
            arc = rounded_place(2 * width, 1.0, of.radius)
            place = lambda s, t: (of.inner + s * width, arc((1 + s) / 2, t)[1])
        elif not math.isinf(of.radius):
            place = rounded_place(width, 1.0, of.radius)
        body_of = Body(Grid(*number, row["element"], place, block=upper, axisymmetric=of.axisymmetric))
    return {"mesh": {"Type": "gmsh"}, "file": body_of.msh}


# --- geometries for gmsh -----------------------------------------------------------------------------------------------------


def section(of):
    """(text of points and curves, curves of the loops [[lower], [upper]], sides {name: curves}): the lower layer first."""
    x, end, sag = of.inner, of.inner + of.lengths[0], 0.0
    height = of.lengths[1]
    if not math.isinf(of.radius):
        reach = of.lengths[0] * (1.0 if of.axisymmetric else 0.5)
        sag = of.radius - math.sqrt(of.radius ** 2 - reach ** 2)
    left = 0.0 if of.axisymmetric else sag
    places = [(x, left), (end, sag), (end, height), (x, height)]
    if of.layers:
        places += [(x, 0.5 * height), (end, 0.5 * height)]
    text = "".join(f"Point({k}) = {{{a!r}, {b!r}, 0, S}};\n" for k, (a, b) in enumerate(places, 1))
    if sag:
        middle = x if of.axisymmetric else x + of.lengths[0] / 2
        text += f"Point(7) = {{{middle!r}, {of.radius!r}, 0, S}};\nCircle(1) = {{1, 7, 2}};\n"
    else:
        text += "Line(1) = {1, 2};\n"
    if not of.layers:
        text += "Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
        return text, [[1, 2, 3, 4]], {"bottom": [1], "right": [2], "top": [3], "left": [4]}
    text += "Line(2) = {2, 6}; Line(3) = {6, 3}; Line(4) = {3, 4}; Line(5) = {4, 5}; Line(6) = {5, 1}; Line(7) = {6, 5};\n"
    return text, [[1, 2, 7, 6], [-7, 3, 4, 5]], {"bottom": [1], "right": [2, 3], "top": [4], "left": [5, 6]}


def listed(numbers):
    return "{" + ", ".join(map(str, numbers)) + "}"


def divided(loops, number):
    """Curves of a section divided as a grid has them: along x and, shared by the layers, along y."""
    along = {abs(loop[k]) for loop in loops for k in (0, 2)}
    across = {abs(loop[k]) for loop in loops for k in (1, 3)}
    rows = max(1, round(number[1] / len(loops)))
    return (f"Transfinite Curve {listed(sorted(along))} = {number[0] + 1}; Transfinite Curve {listed(sorted(across))} = {rows + 1};\n"
            "Transfinite Surface {:}; Recombine Surface {:};\n")


def geometry(rng, row, of, number):
    """A .geo: triangles and tetrahedra free, quadrilaterals by recombination, hexahedra by extrusion of a divided section."""
    text, loops, sides = section(of)
    for k, loop in enumerate(loops, 1):
        text += f"Curve Loop({k}) = {listed(loop)}; Plane Surface({k}) = {{{k}}};\n"
    blocks, quadrilaterals, adapted = ["body", "other"], row["element"][0] == "Q", row["mesh"] == "gmsh"
    size = of.lengths[1] / number[1] * rng.uniform(0.9, 1.1)
    if of.dim == 2:
        if quadrilaterals:
            text += "Recombine Surface {:};\nMesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1;\n"
            size *= 2
        text += "".join(f'Physical Surface("{blocks[k]}") = {{{k + 1}}};\n' for k in range(len(loops)))
        text += "".join(f'Physical Curve("{side}") = {listed(curves)};\n' for side, curves in sides.items())
    else:
        bricks = quadrilaterals and not adapted
        text += (divided(loops, number) if bricks else "") + extruded(of, loops, sides, number, bricks)
    head = lambda length: f"S = {size * length!r};\nMesh.HighOrderOptimize = 1;\n"
    return {"mesh": {"Type": "gmsh", "Order": int(row["element"][1])}, "file": lambda length: head(length) + text}


def extruded(of, loops, sides, number, bricks):
    """The section along z, with the names of volumes and faces."""
    text, faces = "", {side: [] for side in sides}
    layers = f" Layers {{{number[2]}}}; Recombine;" if bricks else ""
    for k, loop in enumerate(loops):
        text += f"out{k}[] = Extrude {{0, 0, {of.lengths[2]!r}}} {{ Surface {{{k + 1}}};{layers} }};\n"
        for side, curves in sides.items():
            faces[side] += [f"out{k}[{2 + n}]" for n, curve in enumerate(loop) if abs(curve) in curves]
        text += f'Physical Volume("{["body", "other"][k]}") = {{out{k}[1]}};\n'
    text += f'Physical Surface("back") = {listed(range(1, len(loops) + 1))};\n'
    text += 'Physical Surface("front") = ' + listed(f"out{k}[0]" for k in range(len(loops))) + ";\n"
    return text + "".join(f'Physical Surface("{side}") = {listed(names)};\n' for side, names in faces.items())

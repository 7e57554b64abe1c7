# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes by family whose contact states are wanted: open, closed and yielding. Bodies that Dirichlet conditions hold, loads
and gaps of the size of each other, yield stresses of the size of the pressures.

`make` has scene K of a seed. A scene's body, load, gap and yield stress come from its seed and number alone, and its mesh from them
and the size: `small` and `full` are meshes of the same scene. Base units have E = 1; the scene's units spread E and xi over six
decades.
"""
import math
import pathlib
import random
import sys

TEST = pathlib.Path(__file__).resolve().parent.parent
sys.path += [str(TEST / "stress"), str(TEST / "benchmark")]

import fields as f  # noqa: E402, after the folders of what scenes and tables are made of
from generate import CLAMPED, ELEMENTS, LAYERS, ZERO, log_uniform  # noqa: E402
from plane import Body, Grid  # noqa: E402
from scene import ContactSide, Scene  # noqa: E402
import friction  # noqa: E402
import hard  # noqa: E402

# Dofs, and contact points, of a scene.
SIZES = {"small": ((3e3, 1e4), (50, 300)), "middle": ((1e4, 4e4), (100, 1500)), "full": ((2e4, 4e5), (150, 4000))}
MOST_DOFS_WITH_BODY = 1e4  # the suite's own mesh, for forces and limit loads: slow where it is fine
INPUT = TEST.parent / "input"
CLAMPED_3D = dict.fromkeys("XYZ", ZERO)


# --- meshes ----------------------------------------------------------------------------------------------------------------


class Sizes:
    """Draws the mesh of a scene, apart from all else of it."""

    def __init__(self, rng, size):
        self.rng, (self.dofs_range, self.points_range) = rng, SIZES[size]

    def dofs(self):
        low, high = self.dofs_range
        return low * (high / low) ** self.rng.random()

    def box(self, lengths, sides=1):
        """Mesh parameters of a box from the origin, of 2 or 3 lengths, with contact on a number of sides like its bottom."""
        element = self.rng.choice(ELEMENTS) if len(lengths) == 2 else "Q1"
        cells = self._cells(lengths, int(element[1]), sides)
        mesh = {"Type": "box", "Cells": cells, "Element": element}
        parts = {"mesh": mesh, "lengths": {"Lower": (0.0,) * len(lengths), "Upper": tuple(map(float, lengths))}, "dim": len(lengths)}
        if len(lengths) == 3:
            return {**parts, "cell": min(a / n for a, n in zip(lengths, cells))}
        body = Body(Grid(*cells, element, lambda s, t: (s * lengths[0], t * lengths[1]))) if self.dofs_range[0] < MOST_DOFS_WITH_BODY else None
        return {**parts, "body": body, "cell": min(a / n for a, n in zip(lengths, cells)) / int(element[1])}

    def _cells(self, lengths, order, sides):
        """Cells of about the same length in all directions, as many as the dofs and contact points allow."""
        dim = len(lengths)
        while True:
            stretch = 10 ** self.rng.uniform(-0.15, 0.15)  # of cells, along x
            size = (math.prod(lengths) * dim / self.dofs() / stretch) ** (1 / dim)
            cells = tuple(max(2, round(a / size / order * (stretch ** -(dim - 1) if k == 0 else 1))) for k, a in enumerate(lengths))
            points = sides * math.prod(order * n + 1 for k, n in enumerate(cells) if k != 1)
            dofs = dim * math.prod(order * n + 1 for n in cells)
            if self.points_range[0] <= points <= self.points_range[1] and self.dofs_range[0] * 0.8 <= dofs <= self.dofs_range[1] * 1.2:
                return cells

    def geo(self, text, area, length, more=""):
        """Mesh parameters of a geometry of an area that sets its cells' size by S, with contact on curves of a length."""
        element, (low, high) = self.rng.choice(ELEMENTS), self.points_range
        order, density = int(element[1]), TRIANGLES if element[0] == "P" else QUADRILATERALS
        while True:
            spacing = math.sqrt(2 * density * area / self.dofs())
            if low <= length / spacing * (1 if element[0] == "P" else 2) <= high:
                break
        head = lambda unit: f"L = {unit!r}; S = {spacing * order * unit!r};\nGeometry.Tolerance = {1e-8 * unit!r};\n"
        tail = RECOMBINED if element[0] == "Q" else ""
        return {"mesh": {"Type": "gmsh", "Order": order}, "file": lambda unit: head(unit) + text + more + tail, "body": None, "cell": spacing / 4}

    def hertz(self, text, half_width):
        """Mesh parameters of input/hertz.geo. Its dofs are about a n^2 + b n, with n nodes on a length of 1 at the contact."""
        low, high = self.points_range
        while True:
            element = self.rng.choice(ELEMENTS)
            order, triangles = int(element[1]), element[0] == "P"
            a, b = (5, 106 * order) if triangles else (15, 495 * order)
            n = (math.sqrt(b * b + 4 * a * self.dofs()) - b) / (2 * a)
            if low <= 2.5 * n * (1 if triangles else 2) <= high:
                break
        head = f"contact_half_width = {half_width!r}; h = {order / n!r};\n"
        return {"mesh": {"Type": "gmsh", "Order": order}, "file": lambda unit: head + text + ("" if triangles else RECOMBINED), "body": None,
                "cell": order / n / 4}


TRIANGLES, QUADRILATERALS = 1.2, 5.2  # nodes times spacing^2 over area, of gmsh's meshes
RECOMBINED = "Recombine Surface{:};\nMesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1;\n"
ROUNDED = """w = %(width)r*L; h = L; sag = %(sag)r*L;
Point(1) = {0, sag, 0, S}; Point(2) = {w/2, 0, 0, S}; Point(3) = {w, sag, 0, S}; Point(4) = {w, h, 0, S}; Point(5) = {0, h, 0, S};
Spline(1) = {1, 2, 3}; Line(2) = {3, 4}; Line(3) = {4, 5}; Line(4) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("body") = {1};
"""
HOLE = """w = %(width)r*L; h = L; x = %(x)r*L; y = %(y)r*L; r = %(r)r*L;
Point(1) = {0, 0, 0, S}; Point(2) = {w, 0, 0, S}; Point(3) = {w, h, 0, S}; Point(4) = {0, h, 0, S};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Point(5) = {x, y, 0, S}; Point(6) = {x + r, y, 0, S}; Point(7) = {x, y + r, 0, S}; Point(8) = {x - r, y, 0, S}; Point(9) = {x, y - r, 0, S};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Circle(7) = {8, 5, 9}; Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(1) = {1, 2};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("body") = {1};
"""
BODIES = """w = %(first)r*L; v = %(second)r*L; a = (%(first)r + 0.2)*L; h = L;
Point(1) = {0, 0, 0, S}; Point(2) = {w, 0, 0, S}; Point(3) = {w, h, 0, S}; Point(4) = {0, h, 0, S};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(5) = {a, 0, 0, S}; Point(6) = {a + v, 0, 0, S}; Point(7) = {a + v, h, 0, S}; Point(8) = {a, h, 0, S};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Physical Curve("bottom") = {1}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Curve("other bottom") = {5}; Physical Curve("other top") = {7}; Physical Curve("other right") = {6};
Physical Surface("body") = {1}; Physical Surface("other") = {2};
"""


# --- loads, gaps and yield stresses ----------------------------------------------------------------------------------------


def load(rng, q, width):
    """A pressure of about q, > 0."""
    kind = rng.choice(["uniform", "sine", "linear"])
    if kind == "uniform":
        return f.Constant(q)
    if kind == "sine":
        return f.sine(q, q * rng.uniform(0.1, 0.9), rng.uniform(0.3, 2) / width, rng.uniform(0, 6))
    slope = rng.uniform(-0.9, 0.9)
    return f.linear(q * (1 - slope / 2), q * slope / width)


def wave(rng, q, waves):
    """A wavy gap that a pressure q closes in part: a half space takes E k amplitude/2 for a wave number k."""
    return f.sine(0.0, 2 * q / (2 * math.pi * waves) * log_uniform(rng, -0.5, 0.7), waves, rng.uniform(0, 6))


def yield_stress(rng, p, width, low=-0.5, high=0.5):
    """Of about the pressure p, constant or varying along x."""
    kind = rng.choice(["constant", "constant", "exponential", "step", "oscillation"])
    p *= log_uniform(rng, low, high)
    span = log_uniform(rng, 0.4, 1.3)
    small, large = p / math.sqrt(span), p * math.sqrt(span)
    if kind == "constant":
        return f.Constant(p)
    if kind == "exponential":
        return f.exponential(*rng.choice([(small, large), (large, small)]), width)
    if kind == "step":
        return f.step(rng.uniform(0.2, 0.8) * width, *rng.choice([(small, large), (large, small)]))
    return f.oscillation(small, large, rng.uniform(0.5, 4) / width)


def solid(rng, blocks=None):
    return {"E": 1.0, "nu": rng.uniform(0, 0.4), "blocks": blocks or {}}


def strain(rng):
    """Pressure over E."""
    return log_uniform(rng, -4, -2)


def sag_of_cantilever(q, length, height=1.0):
    return 1.5 * q * length ** 4 / height ** 3 + 1.5 * q * length ** 2 / height


def sag_of_beam(q, length, height=1.0):
    return q * length ** 4 / (32 * height ** 3) + 0.4 * q * length ** 2 / height


# --- families --------------------------------------------------------------------------------------------------------------


def cantilever(rng, sizes):
    """Clamped on the left, pressed from above on a foundation that is bent away from it, or wavy."""
    length, q = rng.uniform(2, 5), strain(rng)
    sag = sag_of_cantilever(q, length) * log_uniform(rng, -2, -0.3)
    bent = rng.choice([f.Constant(sag), f.parabola(sag / length ** 2, 0.0), f.parabola(sag / length ** 2, length, -sag / 4)])
    gap = bent + wave(rng, q, rng.uniform(0.2, 2)) if rng.random() < 0.7 else bent
    return Scene(material=solid(rng), dirichlet={"left": CLAMPED}, traction={"top": [ZERO, load(rng, q, length) * -1]},
                 contact=[ContactSide("bottom", yield_stress(rng, 1.2 * q, length, -0.4, 0.3), gap)], **sizes.box((length, 1.0)))


def clamped_beam(rng, sizes):
    """Clamped on both sides: the middle sinks on the foundation."""
    length, q = rng.uniform(3, 8), strain(rng)
    sag = sag_of_beam(q, length) * log_uniform(rng, -1.5, -0.3)
    middle = rng.uniform(0.3, 0.7) * length
    bent = rng.choice([f.Constant(sag), f.parabola(4 * sag / length ** 2, middle), f.parabola(-4 * sag / length ** 2, middle, sag)])
    gap = bent + wave(rng, q, rng.uniform(0.2, 2)) if rng.random() < 0.5 else bent
    return Scene(material=solid(rng), dirichlet={"left": CLAMPED, "right": CLAMPED}, traction={"top": [ZERO, load(rng, q, length) * -1]},
                 contact=[ContactSide("bottom", yield_stress(rng, 1.2 * q, length, -0.4, 0.3), gap)], **sizes.box((length, 1.0)))


def footing(rng, sizes):
    """Its top is pressed down on a foundation that is soft or stiff beside it, even or curved."""
    width, q = rng.uniform(1.5, 5), strain(rng)
    waves = rng.uniform(0.3, 1.5) / width
    top = {"X": ZERO, "Y": f.sine(-q, q * rng.uniform(0.1, 0.6), waves, rng.uniform(0, 6))}
    gap = rng.choice([f.parabola(4 * q * log_uniform(rng, -0.5, 0.3) / width ** 2, rng.uniform(0.2, 0.8) * width),
                      f.stairs(q * log_uniform(rng, -0.5, 0.2), width * rng.uniform(0.1, 0.4)), wave(rng, q, rng.uniform(1, 3) / width)])
    return Scene(material=solid(rng), dirichlet={"top": top}, traction={"left": [f.Constant(rng.uniform(-1, 1) * q), ZERO]},
                 contact=[ContactSide("bottom", yield_stress(rng, q, width, -0.7, 0.3), gap)], **sizes.box((width, 1.0)))


def wavy(rng, sizes):
    """Held on a side, over a foundation of many waves."""
    length, q = rng.uniform(1.5, 4), strain(rng)
    gap = wave(rng, q, rng.uniform(2, 10)) + wave(rng, q, rng.uniform(0.5, 2)) * rng.uniform(0, 1)
    holders = rng.choice([{"left": CLAMPED}, {"left": CLAMPED, "right": CLAMPED}, {"right": CLAMPED}])
    return Scene(material=solid(rng), dirichlet=holders, traction={"top": [ZERO, load(rng, q, length) * -1]},
                 contact=[ContactSide("bottom", yield_stress(rng, 1.5 * q, length), gap)], **sizes.box((length, 1.0)))


def rough(rng, sizes):
    """The gap is noise from point to point, besides a wave."""
    length, q = rng.uniform(1.5, 4), strain(rng)
    gap = f.noise(q * 0.01 * log_uniform(rng, -0.5, 1), rng.uniform(8, 16)) + wave(rng, q, rng.uniform(0.3, 2)) * rng.uniform(0, 1)
    holders = rng.choice([{"left": CLAMPED}, {"left": CLAMPED, "right": CLAMPED}])
    return Scene(material=solid(rng), dirichlet=holders, traction={"top": [ZERO, load(rng, q, length) * -1]},
                 contact=[ContactSide("bottom", yield_stress(rng, 1.5 * q, length), gap)], **sizes.box((length, 1.0)))


def two_sides(rng, sizes):
    """Contact under the body and beside it, or under and above it, as in a channel."""
    length, q = rng.uniform(1.5, 4), strain(rng)
    if rng.random() < 0.5:
        traction = {"top": [ZERO, load(rng, q, length) * -1]}
        xis = [yield_stress(rng, 2 * q, length), f.Constant(q * log_uniform(rng, -1, 0))]
        beside = f.Constant(-q * log_uniform(rng, -1, 0.3)) + f.bump(q, 0.0, 0.5) + f.HEIGHT * (q * rng.uniform(-1, 2))
        gaps = [wave(rng, q, rng.uniform(0.3, 3)), beside]
        return Scene(material=solid(rng), dirichlet={"right": CLAMPED}, traction=traction,
                     contact=[ContactSide("bottom", xis[0], gaps[0]), ContactSide("left", xis[1], gaps[1])], **sizes.box((length, 1.0)))
    holders = rng.choice([{"left": CLAMPED}, {"left": CLAMPED, "right": CLAMPED}])
    waves, shift = rng.uniform(0.5, 2), q * rng.uniform(-0.5, 0.5)
    gaps = [wave(rng, q, waves) + f.Constant(shift), wave(rng, q, waves * rng.uniform(0.7, 1.4)) + f.Constant(shift)]
    contact = [ContactSide(side, yield_stress(rng, q, length), gap) for side, gap in zip(("bottom", "top"), gaps)]
    end = {"right": [f.Constant(q * rng.uniform(-1, 1)), f.Constant(q * rng.uniform(-1, 1))]} if "right" not in holders else {}
    return Scene(material=solid(rng), dirichlet=holders, traction=end, body_force=[0.0, q * rng.uniform(-0.5, 0.5)], contact=contact,
                 **sizes.box((length, 1.0), sides=2))


def half_cylinder(rng, sizes):
    """That of input/hertz.geo, R = 8, smooth or rough; the pressure is about Hertz's 0.045 E* where its top sinks by 0.1."""
    depth, nu = 10 ** rng.uniform(-1.7, -0.7), rng.uniform(0, 0.4)
    p = 0.14 * math.sqrt(depth) / (1 - nu * nu)
    half_width = rng.uniform(1.5, 4)
    gap = f.HEIGHT
    if rng.random() < 0.6:
        waves = rng.uniform(0.5, 4)
        gap = gap + wave(rng, p, waves) * rng.uniform(0.1, 1)
    top = {"X": ZERO, "Y": f.sine(-depth, 0.2 * depth * rng.uniform(0.1, 1), rng.uniform(0.03, 0.1), rng.uniform(0, 6))}
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet={"top": top},
                 contact=[ContactSide("contact", f.Constant(p * log_uniform(rng, -0.4, -0.05)), gap, (0.0, -1.0))],
                 **sizes.hertz((INPUT / "hertz.geo").read_text(), half_width))


def shapes(rng, sizes):
    """A body with a round bottom, with a hole, or of two layers, meshed by gmsh."""
    shape, width, q = rng.choice(["rounded", "hole", "layers"]), rng.uniform(1.5, 3), strain(rng)
    material, normal = solid(rng), None
    if shape == "rounded":
        sag = sag_of_cantilever(q, width) * log_uniform(rng, -1, -0.3)
        parts = sizes.geo(ROUNDED % {"width": width, "sag": sag}, width, width)
        gap, normal = f.HEIGHT + wave(rng, q, rng.uniform(0.5, 4)) * rng.uniform(0, 1), (0.0, -1.0)
    elif shape == "hole":
        r = rng.uniform(0.1, 0.3)
        place = {"width": width, "r": r, "x": rng.uniform(0.5, width - 0.5), "y": rng.uniform(r + 0.1, 0.9 - r)}
        parts, gap = sizes.geo(HOLE % place, width, width), wave(rng, q, rng.uniform(0.3, 4))
    else:
        material = solid(rng, {"upper": (log_uniform(rng, -1, 2), rng.uniform(0, 0.4))})
        parts, gap = sizes.geo(LAYERS % {"width": width, "middle": rng.uniform(0.3, 0.7)}, width, width), wave(rng, q, rng.uniform(0.3, 4))
    holders = rng.choice([{"left": CLAMPED}, {"left": CLAMPED, "right": CLAMPED}])
    return Scene(material=material, dirichlet=holders, traction={"top": [ZERO, load(rng, q, width) * -1]},
                 contact=[ContactSide("bottom", yield_stress(rng, 1.5 * q, width), gap, normal)], **parts)


def bodies(rng, sizes):
    """Two bodies that do not touch, each held on a side of its own and over a foundation of its own."""
    first, second, q = rng.uniform(1, 4), rng.uniform(1, 4), strain(rng)
    width = first + 0.2 + second
    material = solid(rng, {"other": (log_uniform(rng, -1, 1), rng.uniform(0, 0.4))})
    loads = {"top": [ZERO, load(rng, q, width) * -1], "other top": [ZERO, load(rng, q, width) * -1]}
    contact = [ContactSide("bottom", yield_stress(rng, 2 * q, width), wave(rng, q, rng.uniform(0.3, 3))),
               ContactSide("other bottom", yield_stress(rng, 2 * q, width),
                           wave(rng, q, rng.uniform(0.3, 3)) * (1 / material["blocks"]["other"][0]))]
    return Scene(material=material, dirichlet={"left": CLAMPED, "other right": CLAMPED}, traction=loads, contact=contact,
                 **sizes.geo(BODIES % {"first": first, "second": second}, first + second, first + second))


def rising(rng, p, length):
    """A yield stress that rises along x, or falls."""
    span, p = log_uniform(rng, 0.2, 1), p * log_uniform(rng, -0.4, 0.5)
    ends = [p / math.sqrt(span), p * math.sqrt(span)]
    return f.exponential(*(ends if rng.random() < 0.7 else ends[::-1]), length)


def block(rng, sizes):
    """In space: clamped on a side, pressed from above on a paraboloid."""
    lengths, q = (rng.uniform(1, 3), rng.uniform(0.5, 1), rng.uniform(1, 2)), strain(rng)
    sag = sag_of_cantilever(q, lengths[0], lengths[1]) * log_uniform(rng, -1.5, -0.3)
    centre = rng.uniform(0.3, 1.0) * lengths[0], rng.uniform(0.2, 0.8) * lengths[2]
    gap = f.paraboloid(sag / (0.5 * lengths[0]) ** 2, *centre) + f.Constant(sag * rng.uniform(-0.3, 0.5))
    return Scene(material=solid(rng), dirichlet={"left": CLAMPED_3D}, traction={"top": [ZERO, load(rng, q, lengths[0]) * -1, ZERO]},
                 contact=[ContactSide("bottom", rising(rng, 1.5 * q, lengths[0]), gap)], **sizes.box(lengths))


def plate(rng, sizes):
    """In space: clamped on one or two sides, over waves in both directions, or noise."""
    lengths, q = (rng.uniform(1.5, 4), rng.uniform(0.4, 1), rng.uniform(1, 2)), strain(rng)
    waves = rng.uniform(0.3, 2), rng.uniform(0.3, 2)
    gap = f.egg_box(2 * q / (2 * math.pi * math.hypot(*waves)) * log_uniform(rng, -0.3, 0.7), *waves, rng.uniform(0, 6))
    if rng.random() < 0.3:
        gap = gap + f.noise(q * 0.05 * log_uniform(rng, -0.5, 1), rng.uniform(8, 16))
    holders = rng.choice([{"left": CLAMPED_3D}, {"left": CLAMPED_3D, "right": CLAMPED_3D}, {"left": CLAMPED_3D, "back": CLAMPED_3D}])
    return Scene(material=solid(rng), dirichlet=holders, traction={"top": [ZERO, load(rng, q, lengths[0]) * -1, ZERO]},
                 contact=[ContactSide("bottom", rising(rng, 2 * q, lengths[0]), gap)], **sizes.box(lengths))


def pressed_block(rng, sizes):
    """In space: its top is pressed down on a paraboloid, even or rough."""
    lengths, q = (rng.uniform(1, 2), rng.uniform(0.5, 1), rng.uniform(1, 2)), strain(rng)
    depth = q * lengths[1]
    top = {"X": ZERO, "Y": f.sine(-depth, depth * rng.uniform(0.1, 0.5), rng.uniform(0.3, 1.5) / lengths[0], rng.uniform(0, 6)), "Z": ZERO}
    gap = f.paraboloid(depth * log_uniform(rng, -0.2, 0.5), *(rng.uniform(0.2, 0.8) * a for a in lengths[::2]))
    if rng.random() < 0.4:
        gap = gap + f.noise(q * 0.05 * log_uniform(rng, -0.5, 1), rng.uniform(8, 16))
    return Scene(material=solid(rng), dirichlet={"top": top}, traction={"right": [f.Constant(q * rng.uniform(-0.5, 0.5)), ZERO, ZERO]},
                 contact=[ContactSide("bottom", rising(rng, 0.6 * q, lengths[0]), gap)], **sizes.box(lengths))


PLANE = {"cantilever": cantilever, "clamped_beam": clamped_beam, "footing": footing, "wavy": wavy, "rough": rough,
         "two_sides": two_sides, "half_cylinder": half_cylinder, "shapes": shapes, "bodies": bodies}
SPACE = {"block": block, "plate": plate, "pressed_block": pressed_block}
FAMILIES = {**PLANE, **SPACE}
KINDS = {"three states": (FAMILIES, Sizes), "hard": (hard.FAMILIES, hard.Meshes), "friction": (friction.families_of(FAMILIES), Sizes)}


def scene(family, rng, size, kind="three states"):
    """A scene of a family, its numbers from rng; those of its mesh are apart."""
    families, meshes = KINDS[kind]
    physics, mesh, stress = random.Random(rng.random()), random.Random(rng.random()), log_uniform(rng, 3, 9)
    made = families[family](physics, meshes(mesh, size))
    made.units, made.expect = (1.0, stress), "solution"
    return made


def family_of(number, kind="three states"):
    names = list(KINDS[kind][0])
    return names[number % len(names)]


def make(seed, number, size, kind="three states"):
    """(family, scene): families take turns."""
    family = family_of(number, kind)
    return family, scene(family, random.Random(f"{seed}/{number}"), size, kind)

# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes by family on which multigrid has the hardest work: thin plates, strips, discs and shells, slender beams, layers of much
different stiffness, nearly incompressible and stretched bodies, brackets; of all elements, in the plane, of revolution and in space.

All are held, and pressed from above on a foundation that they reach in part. Thickness is along y, from 1:5 to 1:1000 of the length.
As in families.py a scene's body, load, gap and yield stress come from its seed and number alone, and its mesh from them and the size.
"""
import math

import fields as f  # families.py has put its folder on the path
from generate import CLAMPED, ELEMENTS, ZERO, log_uniform
from scene import AXISYMMETRIC, ContactSide, Scene

SIZES = {"small": (1.5e3, 5e3), "middle": (1e4, 4e4), "full": (2e4, 3e5)}  # dofs
CLAMPED_3D = dict.fromkeys("XYZ", ZERO)
PRESSES = {2: lambda q: [ZERO, f.Constant(-q)], 3: lambda q: [ZERO, f.Constant(-q), ZERO]}


# --- meshes ----------------------------------------------------------------------------------------------------------------


class Meshes:
    """Draws the mesh of a scene, apart from all else of it."""

    def __init__(self, rng, size):
        self.rng, self.dofs_range = rng, SIZES[size]

    def dofs(self):
        return math.exp(self.rng.uniform(*map(math.log, self.dofs_range)))

    def box(self, lengths, stretch=None, through=None, at_least=1):
        """Mesh parameters of a box from the origin.

        stretch: of cells along each axis, relative to each other; None: cells are cubes.
        through: {axis: cells}, where they are given.
        """
        dim, through = len(lengths), through or {}
        element, dofs = self.rng.choice(ELEMENTS), self.dofs()
        order, stretch = int(element[1]), stretch or [1.0] * dim
        low, high = 1e-9, 1e3
        for _ in range(60):  # the length of a cell of stretch 1, by bisection
            length = math.sqrt(low * high)
            cells = tuple(through.get(k, max(at_least, round(a / (length * s)))) for k, (a, s) in enumerate(zip(lengths, stretch)))
            low, high = (length, high) if dim * math.prod(order * n + 1 for n in cells) > dofs else (low, length)
        return {"mesh": {"Type": "box", "Cells": cells, "Element": element}, "dim": dim,
                "lengths": {"Lower": (0.0,) * dim, "Upper": tuple(map(float, lengths))}, "cell": min(a / n for a, n in zip(lengths, cells)) / order}

    def geo(self, text, area, thickness):
        """Mesh parameters of a geometry that sets its cells' size by S; of an area and a thickness."""
        order, dofs = self.rng.choice([1, 2]), self.dofs()
        low, high = 1e-6, 1e3
        for _ in range(60):  # the distance of nodes
            spacing = math.sqrt(low * high)
            nodes = NODES * area / spacing ** 2 * (max(thickness / spacing, order) + 1)
            low, high = (spacing, high) if 3 * nodes > dofs else (low, spacing)
        head = lambda unit: f"L = {unit!r}; S = {spacing * order * unit!r};\nGeometry.Tolerance = {1e-8 * unit!r};\nMesh.MeshSizeMax = S;\n"
        return {"mesh": {"Type": "gmsh", "Order": order}, "file": lambda unit: head(unit) + text, "cell": min(spacing, thickness) / 4, "dim": 3}


NODES = 1.15  # times spacing^2 over area, of gmsh's triangles
# A surface in the plane of x and y, extruded along z, or in that of x and z, extruded along y.
HOLE = """w = %(width)r*L; d = %(depth)r*L; t = %(thickness)r*L; x = %(x)r*L; z = %(z)r*L; r = %(r)r*L;
Point(1) = {0, 0, 0, S}; Point(2) = {w, 0, 0, S}; Point(3) = {w, 0, d, S}; Point(4) = {0, 0, d, S};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Point(5) = {x, 0, z, S}; Point(6) = {x + r, 0, z, S}; Point(7) = {x, 0, z + r, S}; Point(8) = {x - r, 0, z, S}; Point(9) = {x, 0, z - r, S};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Circle(7) = {8, 5, 9}; Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(1) = {1, 2};
out[] = Extrude {0, t, 0} { Surface{1}; };
Physical Surface("bottom") = {1}; Physical Surface("top") = {out[0]}; Physical Volume("body") = {out[1]};
Physical Surface("back") = {out[2]}; Physical Surface("right") = {out[3]}; Physical Surface("front") = {out[4]}; Physical Surface("left") = {out[5]};
"""
SHELL = """r = L; t = %(thickness)r*L; d = %(depth)r*L; s = Sin(%(angle)r); c = Cos(%(angle)r);
Point(1) = {0, r, 0, S}; Point(2) = {-r*s, r - r*c, 0, S}; Point(3) = {0, 0, 0, S}; Point(4) = {r*s, r - r*c, 0, S};
Point(5) = {(r - t)*s, r - (r - t)*c, 0, S}; Point(6) = {0, t, 0, S}; Point(7) = {-(r - t)*s, r - (r - t)*c, 0, S};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 6}; Circle(5) = {6, 1, 7}; Line(6) = {7, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
out[] = Extrude {0, 0, d} { Surface{1}; };
Physical Surface("bottom") = {out[2], out[3]}; Physical Surface("top") = {out[5], out[6]}; Physical Volume("body") = {out[1]};
Physical Surface("right") = {out[4]}; Physical Surface("left") = {out[7]}; Physical Surface("back") = {1}; Physical Surface("front") = {out[0]};
"""
BRACKET = """w = %(width)r*L; h = %(height)r*L; t = %(thickness)r*L; d = %(depth)r*L;
Point(1) = {0, 0, 0, S}; Point(2) = {w, 0, 0, S}; Point(3) = {w, t, 0, S}; Point(4) = {t, t, 0, S}; Point(5) = {t, h, 0, S}; Point(6) = {0, h, 0, S};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
out[] = Extrude {0, 0, d} { Surface{1}; };
Physical Surface("bottom") = {out[2]}; Physical Surface("arm") = {out[4]}; Physical Surface("clamp") = {out[6]}; Physical Volume("body") = {out[1]};
"""


def layers_geo(width, heights, depth):
    """Layers of some heights, from below; volumes are layer 0, 1, ..."""
    lines, levels = [f"w = {width!r}*L; d = {depth!r}*L;"], [sum(heights[:k]) for k in range(len(heights) + 1)]
    for k, y in enumerate(levels):
        lines.append(f"Point({2 * k + 1}) = {{0, {y!r}*L, 0, S}}; Point({2 * k + 2}) = {{w, {y!r}*L, 0, S}}; Line({k + 1}) = {{{2 * k + 1}, {2 * k + 2}}};")
    last, every = len(heights) - 1, range(len(heights))
    left, right = 100, 200
    for k in every:
        lines += [f"Line({left + k}) = {{{2 * k + 1}, {2 * k + 3}}}; Line({right + k}) = {{{2 * k + 2}, {2 * k + 4}}};",
                  f"Curve Loop({k + 1}) = {{{k + 1}, {right + k}, -{k + 2}, -{left + k}}}; Plane Surface({k + 1}) = {{{k + 1}}};"]
    for k in every:  # after all of the surface: an extrusion takes the next free numbers
        lines.append(f"out{k}[] = Extrude {{0, 0, d}} {{ Surface{{{k + 1}}}; }}; Physical Volume(\"layer {k}\") = {{out{k}[1]}};")
    lines += [f'Physical Surface("bottom") = {{out0[2]}}; Physical Surface("top") = {{out{last}[4]}};',
              'Physical Surface("left") = {%s};' % ", ".join(f"out{k}[5]" for k in every)]
    return "\n".join(lines) + "\n"


# --- sizes of loads, gaps and yield stresses -------------------------------------------------------------------------------


def yield_stress(rng, p):
    """Of the size of a pressure where a body touches with a part of its side, or none."""
    return f.Constant(p * log_uniform(rng, 0, 1.5)) if rng.random() < 0.6 else f.INFINITE


def bump(rng, sag, lengths):
    """A gap that a body which sags by `sag` closes in part: a bump or waves, at times rough; a part of the bumps lift the body, since one
    that locks does not sag. Lengths along x, or along x and z."""
    at = [rng.uniform(0.3, 0.7) * a for a in lengths]
    curvature, lowest = sag * log_uniform(rng, -0.3, 0.7) / (lengths[0] / 2) ** 2, sag * rng.uniform(-0.3, 0.3)
    gap = (f.parabola(curvature, at[0]) if len(at) == 1 else f.paraboloid(curvature, *at)) + f.Constant(lowest)
    kind = rng.choice(["bump", "bump", "waves", "rough"])
    if kind == "waves":
        waves = [rng.uniform(1, 4) / a for a in lengths]
        high = sag * log_uniform(rng, -1.3, -0.5)
        return gap + (f.sine(0.0, high, waves[0], rng.uniform(0, 6)) if len(at) == 1 else f.egg_box(high, *waves, rng.uniform(0, 6)))
    return gap + f.noise(sag * log_uniform(rng, -2, -1), rng.uniform(8, 16)) if kind == "rough" else gap


def passable(gap, limit, held, lengths):
    """The gap, lifted where a clamped edge would lie in a rigid foundation: such a scene has no solution. Lengths as in bump()."""
    if limit is not f.INFINITE:
        return gap
    width, depth = (*lengths, 0.0)[:2]
    at = [k / 1000 for k in range(1001)]
    edges = {"left": [(0.0, depth * a) for a in at], "right": [(width, depth * a) for a in at],
             "back": [(width * a, 0.0) for a in at], "front": [(width * a, depth) for a in at]}
    lowest = min(gap(x, 0.0, z) for side in held for x, z in edges[side])
    return gap + f.Constant(-1.1 * lowest) if lowest < 0 else gap


def thickness(rng, thinnest=1e-3):
    return thinnest * (0.2 / thinnest) ** rng.random()


def bending_load(rng, t, factor, nu):
    """(pressure, sag) of a plate, E = 1, of length 1: the sag is factor q / D."""
    sag = log_uniform(rng, -3, -1.5)
    return sag / factor * t ** 3 / (12 * (1 - nu * nu)), sag


HELD_PLATES = [(("left", "right", "front", "back"), 0.00126), (("left", "right"), 1 / 384), (("left",), 1 / 8), (("left", "back"), 0.01)]


# --- families --------------------------------------------------------------------------------------------------------------


def thin_plate(rng, meshes):
    """A box clamped on one to four edges over a bump, waves or a rough foundation."""
    t, nu, depth = thickness(rng), rng.uniform(0, 0.45), rng.uniform(0.5, 1)
    held, factor = rng.choice(HELD_PLATES)
    q, sag = bending_load(rng, t, factor, nu)
    mesh = meshes.box((1.0, t, depth), [rng.uniform(1, 2), 1.0, 1.0], {1: rng.choice([1, 2, 2, 3])}, at_least=4)
    limit = yield_stress(rng, q)
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet=dict.fromkeys(held, CLAMPED_3D), traction={"top": PRESSES[3](q)},
                 contact=[ContactSide("bottom", limit, passable(bump(rng, sag, (1.0, depth)), limit, held, (1.0, depth)))], **mesh)


def holed_plate(rng, meshes):
    """The same with a hole, of tetrahedra."""
    t, nu, depth, r = thickness(rng, 5e-3), rng.uniform(0, 0.45), rng.uniform(0.7, 1), rng.uniform(0.1, 0.2)
    held, factor = rng.choice(HELD_PLATES)
    q, sag = bending_load(rng, t, factor, nu)
    place = {"width": 1.0, "depth": depth, "thickness": t, "r": r, "x": rng.uniform(0.3, 0.7), "z": rng.uniform(0.3, 0.7) * depth}
    limit = yield_stress(rng, q)
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet=dict.fromkeys(held, CLAMPED_3D), traction={"top": PRESSES[3](q)},
                 contact=[ContactSide("bottom", limit, passable(bump(rng, sag, (1.0, depth)), limit, held, (1.0, depth)))],
                 **meshes.geo(HOLE % place, depth - math.pi * r * r, t))


def shell(rng, meshes):
    """A part of a pipe's wall, of tetrahedra, held on both straight edges, with its round side down."""
    t, nu, depth, angle = thickness(rng, 5e-3), rng.uniform(0, 0.45), rng.uniform(0.5, 1.5), rng.uniform(0.3, 1.2)
    q = log_uniform(rng, -4, -2) * t
    sag = q / t * log_uniform(rng, -0.5, 0.5)  # the ring's own
    gap = f.HEIGHT + f.Constant(sag * rng.uniform(-0.3, 0.3)) + f.noise(sag * log_uniform(rng, -2, -1), rng.uniform(8, 16))
    parts = meshes.geo(SHELL % {"thickness": t, "depth": depth, "angle": angle}, 2 * angle * depth, t)
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet={"left": CLAMPED_3D, "right": CLAMPED_3D}, traction={"top": PRESSES[3](q)},
                 contact=[ContactSide("bottom", yield_stress(rng, q), gap, (0.0, -1.0, 0.0))], **parts)


def strip(rng, meshes):
    """A thin strip in the plane, or a thin disc, clamped on one end or both."""
    t, nu = thickness(rng), rng.uniform(0, 0.45)
    disc = rng.random() < 0.3
    held, factor = (("right",), 1 / 64) if disc else rng.choice([(("left",), 1 / 8), (("left", "right"), 1 / 384)])
    q, sag = bending_load(rng, t, factor, nu)
    mesh, limit = meshes.box((1.0, t), None, {1: rng.choice([1, 2, 4, 8])}, at_least=4), yield_stress(rng, q)
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet=dict.fromkeys(held, CLAMPED), traction={"top": PRESSES[2](q)},
                 contact=[ContactSide("bottom", limit, passable(bump(rng, sag, (1.0,)), limit, held, (1.0,)))],
                 kinematics=AXISYMMETRIC if disc else None, **mesh)


def slender_beam(rng, meshes):
    """In space, clamped on one end or both."""
    t, nu = thickness(rng), rng.uniform(0, 0.45)
    width = t * rng.uniform(0.5, 2)
    held, factor = rng.choice([(("left",), 1 / 8), (("left", "right"), 1 / 384)])
    q, sag = bending_load(rng, t, factor, nu)
    mesh = meshes.box((1.0, t, width), None, {1: rng.randint(1, 4), 2: rng.randint(1, 4)}, at_least=4)
    gap, limit = bump(rng, sag, (1.0, 1.0)), yield_stress(rng, q)
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet=dict.fromkeys(held, CLAMPED_3D), traction={"top": PRESSES[3](q)},
                 contact=[ContactSide("bottom", limit, passable(gap, limit, held, (1.0, width)))], **mesh)


def solid_sag(q, lengths):
    return 1.5 * q * lengths[0] ** 4 / lengths[1] ** 3 + 1.5 * q * lengths[0] ** 2 / lengths[1]


def rubber(rng, meshes):
    """A nearly incompressible block, in space or in the plane, nu to 0.49999."""
    dim = rng.choice([2, 3, 3])
    lengths, nu = (rng.uniform(1, 2), rng.uniform(0.6, 1.2), rng.uniform(0.6, 1.2))[:dim], 0.5 - log_uniform(rng, -5, -1.3)
    q = log_uniform(rng, -4, -2)
    sag = solid_sag(q, lengths)
    holders = rng.choice([{"left": CLAMPED_3D}, {"left": CLAMPED_3D, "right": CLAMPED_3D}])
    held = {side: {c: v for c, v in fixed.items() if c in "XYZ"[:dim]} for side, fixed in holders.items()}
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet=held, traction={"top": PRESSES[dim](q)},
                 contact=[ContactSide("bottom", yield_stress(rng, q), bump(rng, sag / 4 ** (len(held) - 1), lengths[::2]))],
                 **meshes.box(lengths, [log_uniform(rng, 0, 0.6) for _ in lengths], at_least=2))


def stretched(rng, meshes):
    """A body of about equal sides whose cells are stretched by up to a thousand, in the plane, of revolution or in space."""
    dim = rng.choice([2, 2, 3])
    revolution = dim == 2 and rng.random() < 0.4
    lengths, nu, q = (rng.uniform(1, 2), rng.uniform(0.6, 1.2), rng.uniform(0.6, 1.2))[:dim], rng.uniform(0, 0.45), log_uniform(rng, -4, -2)
    axes = rng.sample(range(dim), dim)
    flat = [1.0] * dim
    for k in axes[:rng.choice([1, dim - 1])]:
        flat[k] = log_uniform(rng, 0, 3)
    largest = max(flat)
    holder = {c: v for c, v in CLAMPED_3D.items() if c in "XYZ"[:dim]}
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet={"right": holder}, traction={"top": PRESSES[dim](q)},
                 contact=[ContactSide("bottom", yield_stress(rng, q), bump(rng, solid_sag(q, lengths), lengths[::2]))],
                 kinematics=AXISYMMETRIC if revolution else None, **meshes.box(lengths, [s / largest for s in flat], at_least=2))


def layers(rng, meshes):
    """Layers of tetrahedra whose E differ by up to a million."""
    number = rng.randint(2, 5)
    heights, width, depth = [rng.uniform(0.1, 0.4) for _ in range(number)], rng.uniform(0.8, 1.5), rng.uniform(0.6, 1.2)
    stiffness = [10 ** (rng.uniform(0, 6) if k % 2 else rng.uniform(0, 1)) for k in range(number)]
    if rng.random() < 0.5:
        stiffness.reverse()
    q = log_uniform(rng, -4, -2)
    sag = q * sum(h / e for h, e in zip(heights, stiffness)) + solid_sag(q, (width, sum(heights))) / stiffness[max(range(number), key=lambda k: stiffness[k])]
    blocks = {f"layer {k}": (e, rng.uniform(0, 0.4)) for k, e in enumerate(stiffness)}
    return Scene(material={"E": 1.0, "nu": 0.3, "blocks": blocks}, dirichlet={"left": CLAMPED_3D}, traction={"top": PRESSES[3](q)},
                 contact=[ContactSide("bottom", yield_stress(rng, q), bump(rng, sag, (width, depth)))],
                 **meshes.geo(layers_geo(width, heights, depth), width * depth, sum(heights)))


def bracket(rng, meshes):
    """An angle of tetrahedra, clamped at its upper end, over which the lower arm is pressed on the foundation."""
    t, nu, depth, height = 10 ** rng.uniform(-1.7, -0.7), rng.uniform(0.2, 0.4), rng.uniform(0.3, 0.8), rng.uniform(0.5, 1.2)
    q, sag = bending_load(rng, t, 1 / 8 + height / 2, nu)
    place = {"width": 1.0, "height": height, "thickness": t, "depth": depth}
    return Scene(material={"E": 1.0, "nu": nu, "blocks": {}}, dirichlet={"clamp": CLAMPED_3D},
                 traction={"arm": PRESSES[3](q)}, contact=[ContactSide("bottom", yield_stress(rng, q), bump(rng, sag, (1.0, depth)))],
                 **meshes.geo(BRACKET % place, (1 + height) * depth, t))


FAMILIES = {"thin_plate": thin_plate, "slender_beam": slender_beam, "rubber": rubber, "stretched": stretched, "strip": strip,
            "holed_plate": holed_plate, "shell": shell, "layers": layers, "bracket": bracket}

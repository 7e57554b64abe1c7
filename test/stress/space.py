# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes in space and of bodies of revolution, as generate.py has them in the plane; y is up and contact below, on the side bottom,
unless a scene says otherwise."""
import math

import fields as f
from generate import (CLAMPED, ELEMENTS, MOST_ASPECT, ZERO, box_scene, cells, gap, load_scale, log_uniform, material, near_limit, pressure,
                      rounded_place, varying_yield, written, yield_stress)
from plane import Body, Grid
from scene import AXISYMMETRIC, ContactSide, Scene
from solid import Bricks

MOST_NODES = 500
CLAMPED_SOLID = dict.fromkeys("XYZ", ZERO)
DOWN = (0.0, -1.0, 0.0)


# --- bodies ----------------------------------------------------------------------------------------------------------------


def number_of_cells(rng, element, most=8, nodes=MOST_NODES):
    order = int(element[1])
    while True:
        number = [rng.randint(2, most) for _ in range(3)]
        if math.prod(order * n + 1 for n in number) <= nodes:
            return number


def cap(radius, width, depth):
    """A block with a round bottom, lowest in the middle: a part of a ball, or of a cylinder along z without a depth."""
    def place(s, t, v):
        x, z = (s - 0.5) * width, (v - 0.5) * (depth or 1.0)
        sag = radius - math.sqrt(radius * radius - x * x - (z * z if depth else 0.0))
        return s * width, t + (1 - t) * sag, v * (depth or 1.0)
    return place


def bent(inner, half_angle, depth):
    """A part of a tube along z; its bottom is the outer wall, lowest point (0, 0)."""
    def place(s, t, v):
        angle, r = (2 * s - 1) * half_angle, 1 + t * (inner - 1)
        return r * math.sin(angle), 1 - r * math.cos(angle), v * depth
    return place


def twisted(width, depth, turn):
    """A block turned around the vertical through its middle, the further up the more."""
    def place(s, t, v):
        x, z, angle = (s - 0.5) * width, (v - 0.5) * depth, turn * t
        return x * math.cos(angle) + z * math.sin(angle), t, z * math.cos(angle) - x * math.sin(angle)
    return place


def solid(rng, shape=None, element=None, number=None):
    """A body of a random shape with sides bottom, top, left, right, back, front: cells straight, distorted or curved."""
    element = element or rng.choice(ELEMENTS)
    number = number or number_of_cells(rng, element)
    shape = shape or rng.choice(["block", "distorted", "graded", "ell", "ball", "barrel", "bent", "twisted"])
    width, depth = rng.uniform(0.5, 3), rng.uniform(0.5, 3)
    block = lambda s, t, v: (s * width, t, v * depth)
    options = {"flip": tuple(rng.randint(0, 1) for _ in range(3))}
    if shape == "distorted":
        size = rng.uniform(0.05, 0.15)
        lengths = [a / n for a, n in zip((width, 1.0, depth), number)]
        options["distort"] = lambda *cell: tuple(rng.uniform(-size, size) * a for a in lengths)
    elif shape == "graded":
        while True:
            powers = [rng.uniform(0.6, 2.5) for _ in range(3)]
            if max(n ** max(p, 1) for n, p in zip(number, powers)) < MOST_ASPECT:
                break
        block = lambda *at: tuple(a ** p for a, p in zip(at, powers))
        options["distort"] = lambda *cell: (0.0, 0.0, 0.0)
    elif shape == "ell":
        ci, cj, low = rng.randint(1, number[0] - 1), rng.randint(1, number[1] - 1), rng.random() < 0.5
        options["keep"] = (lambda i, j, k: i < ci or j >= cj) if low else (lambda i, j, k: i < ci or j < cj)
    elif shape == "ball":
        block = cap(math.hypot(width, depth) * log_uniform(rng, -0.2, 1.5), width, depth)
    elif shape == "barrel":
        block = cap(width * log_uniform(rng, -0.2, 1.5), width, None)
    elif shape == "bent":
        block = bent(rng.uniform(0.2, 0.8), rng.uniform(0.2, 1.2), depth)
    elif shape == "twisted":
        block = twisted(width, depth, rng.uniform(-0.6, 0.6))
    return Body(Bricks(number, element, block, **options))


def bounds(body):
    """(lowest, highest) coordinates."""
    places = [grid.nodes[k] for grid in body.parts for k in grid.used_nodes()]
    return [min(c) for c in zip(*places)], [max(c) for c in zip(*places)]


def pressure_of_round(depth):
    """Of the size of Hertz's, over E, of a round body of size 1 that is pressed in by a depth."""
    return 0.5 * math.sqrt(depth)


def gap_in_space(rng, u, lows, highs):
    """Gaps of about u along x, or along x and z."""
    kind = rng.choice(["none", "along x", "paraboloid", "egg box"])
    width, depth = highs[0] - lows[0], highs[2] - lows[2]
    g = u * log_uniform(rng, -1.5, 1)
    if kind == "along x":
        return gap(rng, u, width)
    if kind == "paraboloid":
        return f.paraboloid(g / width ** 2, *(a + rng.random() * (b - a) for a, b in ((lows[0], highs[0]), (lows[2], highs[2]))))
    if kind == "egg box":
        return f.egg_box(g, rng.uniform(0.3, 3) / width, rng.uniform(0.3, 3) / depth, rng.uniform(0, 6))
    return ZERO


def holders_in_space(rng, strain):
    """Sides that hold a body, or press it down."""
    down = {"X": ZERO, "Y": f.Constant(-strain), "Z": ZERO}
    return rng.choice([{"top": CLAMPED_SOLID}, {"left": CLAMPED_SOLID}, {"left": CLAMPED_SOLID, "right": CLAMPED_SOLID},
                       {"left": CLAMPED_SOLID, "back": {"Z": ZERO}}, {"top": down}, {"top": down},
                       {"left": {"X": ZERO}, "back": {"Z": ZERO}, "top": {"Y": f.Constant(-strain)}}])


def held_solid(rng, body, xi=None, gap_field=None, **contact):
    """A body that Dirichlet conditions hold, over a foundation under its bottom."""
    lows, highs = bounds(body)
    solid_material = material(rng, nu=rng.uniform(-0.2, 0.45))
    q = load_scale(rng, solid_material["E"])
    width, strain = highs[0] - lows[0], q / solid_material["E"]
    holders, names, traction = holders_in_space(rng, strain), body.sides(), {}
    if "top" not in holders:
        traction["top"] = [ZERO, pressure(rng, q, width) * -1, ZERO]
    free = [n for n in ("right", "front", "left", "top", "inner") if n in names and n not in holders]
    if free and rng.random() < 0.3:
        traction[free[0]] = [f.Constant(q * rng.uniform(-1, 1)), traction.get(free[0], [ZERO] * 2)[1], f.Constant(q * rng.uniform(-1, 1))]
    body_force = [rng.uniform(-1, 1) * q, -q, rng.uniform(-1, 1) * q] if rng.random() < 0.2 else None
    if xi is None:
        xi = yield_stress(rng, q, solid_material["E"]) if rng.random() < 0.6 else varying_yield(rng, q, width)
    side = ContactSide("bottom", xi, gap_field or gap_in_space(rng, strain * max(1, width ** 2), lows, highs), **contact)
    return Scene(contact=[side], material=solid_material, dirichlet=holders, traction=traction, body_force=body_force, dim=3, **written(body))


def geometry(rng, text, size, cut, order=None):
    """Mesh parameters of a geometry in space that rpc has meshed; cut: its tetrahedra into hexahedra."""
    head = lambda length: f"L = {length!r}; S = {size * length!r};\nGeometry.Tolerance = {1e-8 * length!r};\n"
    tail = "Mesh.SubdivisionAlgorithm = 2;\n" if cut else ""
    return {"mesh": {"Type": "gmsh", "Order": order or rng.choice([1, 2])}, "file": lambda length: head(length) + text + tail, "body": None,
            "cell": size / 8, "dim": 3}


OCTANT = """Point(1) = {0, L, 0, S}; Point(2) = {L, L, 0, S}; Point(3) = {0, L, L, S}; Point(4) = {0, 0, 0, %(fine)r*S};
Line(1) = {1, 2}; Line(2) = {1, 3}; Line(3) = {1, 4}; Circle(4) = {2, 1, 3}; Circle(5) = {3, 1, 4}; Circle(6) = {4, 1, 2};
Curve Loop(1) = {1, 4, -2}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 5, -3}; Plane Surface(2) = {2};
Curve Loop(3) = {3, 6, -1}; Plane Surface(3) = {3}; Curve Loop(4) = {4, 5, 6}; Surface(4) = {4} In Sphere {1};
Surface Loop(1) = {1, 2, 3, 4}; Volume(1) = {1};
Physical Volume("body") = {1}; Physical Surface("top") = {1}; Physical Surface("left") = {2}; Physical Surface("back") = {3};
Physical Surface("bottom") = {4};
"""
EXTRUDED = """out[] = Extrude {0, 0, %(depth)r*L} { Surface{1}; Layers{%(layers)d};%(recombine)s };
Physical Volume("body") = {out[1]}; Physical Surface("back") = {1}; Physical Surface("front") = {out[0]};
"""
ROLLER = """Point(1) = {-L, L, 0, S}; Point(2) = {0, 0, 0, %(fine)r*S}; Point(3) = {L, L, 0, S}; Point(4) = {0, L, 0, S};
Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
""" + EXTRUDED + """Physical Surface("bottom") = {out[2], out[3]}; Physical Surface("top") = {out[4], out[5]};
"""
ARCH = """w = %(width)r*L; r = %(radius)r*L; sag = r - Sqrt(r*r - w*w/4);
Point(1) = {0, sag, 0, S}; Point(2) = {w, sag, 0, S}; Point(3) = {w, L + sag, 0, S}; Point(4) = {0, L + sag, 0, S}; Point(5) = {w/2, r, 0, S};
Circle(1) = {1, 5, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = %(nx)d; Transfinite Curve {2, 4} = %(ny)d; Transfinite Surface {1};%(recombine_surface)s
""" + EXTRUDED + """Physical Surface("bottom") = {out[2]}; Physical Surface("right") = {out[3]}; Physical Surface("top") = {out[4]};
Physical Surface("left") = {out[5]};
"""
SOCKET = """SetFactory("OpenCASCADE");
Box(1) = {-L/2, 0, -L/2, L, L, L}; y = -%(radius)r*Cos(%(angle)r)*L; r = %(radius)r*L; e = 1e-3*L;
%(cutter)s
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Physical Volume("body") = {3};
top() = Surface In BoundingBox {-L, L - e, -L, L, L + e, L}; left() = Surface In BoundingBox {-L/2 - e, -e, -L, -L/2 + e, L + e, L};
hollow() = Surface{:}; hollow() -= top(); hollow() -= left(); hollow() -= Surface In BoundingBox {-L, -e, -L, L, e, L};
hollow() -= Surface In BoundingBox {L/2 - e, -e, -L, L/2 + e, L + e, L}; hollow() -= Surface In BoundingBox {-L, -e, -L/2 - e, L, L + e, -L/2 + e};
hollow() -= Surface In BoundingBox {-L, -e, L/2 - e, L, L + e, L/2 + e};
Physical Surface("bottom") = hollow(); Physical Surface("top") = top(); Physical Surface("left") = left();
Mesh.MeshSizeMax = S; Mesh.MeshSizeMin = S/5; Mesh.MeshSizeFromCurvature = 10;
"""
CUTTERS = {"sphere": "Sphere(2) = {0, y, 0, r};", "cylinder": "Cylinder(2) = {0, y, -L, 0, 0, 2*L, r};"}


# --- families --------------------------------------------------------------------------------------------------------------


def solid_scene(rng):
    return held_solid(rng, solid(rng), normal=rng.choice([None, "surface", DOWN]))


def round_scene(rng):
    """Planes, spheres and cylinders, the body outside or inside of them, any normal."""
    body = solid(rng)
    lows, highs = bounds(body)
    size = math.dist(lows, highs)
    scene = held_solid(rng, body, gap_field=ZERO)
    e = scene.material["E"]
    q = load_scale(rng, e)
    distance = q / e * rng.uniform(-3, 0.5)
    contact, kind = scene.contact[0], rng.choice(["plane", "sphere", "sphere", "cylinder", "cylinder"])
    middle = (lows[0] + highs[0]) / 2, lows[1] - distance, (lows[2] + highs[2]) / 2
    contact.xi = yield_stress(rng, rng.choice([q, pressure_of_round(q / e) * e]), e)
    if kind == "plane":
        tilt = rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1)
        contact.obstacle = {"Type": "plane", "Point": middle, "Normal": (tilt[0], 1.0, tilt[1])}
        contact.normal = rng.choice([None, "foundation", DOWN])
        return scene
    encloses = rng.random() < 0.4
    radius = size * log_uniform(rng, 0.3, 3) if encloses or rng.random() < 0.6 else size * rng.uniform(0.1, 0.45)
    centre = (middle[0], middle[1] + (radius if encloses else -radius), middle[2])
    contact.obstacle = {"Type": kind, "Radius": radius, "Encloses Body": encloses}
    if kind == "sphere":
        contact.obstacle["Centre"] = centre
    else:
        angle = rng.choice([0.0, math.pi / 2, rng.uniform(0, math.pi)])
        contact.obstacle.update(Point=centre, Axis=(math.cos(angle), rng.choice([0.0, rng.uniform(-0.05, 0.05)]), math.sin(angle)))
    contact.normal = rng.choice([None, None, DOWN, "surface"])
    return scene


def solid_rollers_scene(rng):
    """Held along the normal by contact only: one, two or three rigid motions are free. What becomes of it, `verdict` knows."""
    modes = rng.choice([1, 1, 1, 2, 3])
    element = rng.choice(ELEMENTS)
    shape = rng.choice(["block", "distorted", "ball", "barrel"] if modes == 1 else ["block", "distorted"])
    number = number_of_cells(rng, element, most=8 if modes < 3 else 6 // int(element[1]))
    body = solid(rng, shape, element, number)
    lows, highs = bounds(body)
    width = highs[0] - lows[0]
    solid_material = material(rng, nu=rng.uniform(-0.2, 0.45))
    q = load_scale(rng, solid_material["E"])
    holders = {1: rng.choice([{"left": {"X": ZERO}, "back": {"Z": ZERO}}, {"left": {"X": ZERO}, "right": {"X": ZERO}, "front": {"Z": ZERO}}]),
               2: {"left": {"X": ZERO}, "bottom": {"Z": ZERO}}, 3: {"bottom": {"X": ZERO, "Z": ZERO}}}[modes]
    chance = rng.random()
    xi = f.INFINITE if chance < 0.25 else f.Constant(q * log_uniform(rng, 0.05, 3)) if chance < 0.6 else varying_yield(rng, 10 * q, width)
    force = pressure(rng, q * rng.choice([1, 1, 1, 1, 1, -1]), width)
    scene = Scene(contact=[ContactSide("bottom", xi, gap_in_space(rng, q / solid_material["E"], lows, highs))], material=solid_material,
                  dirichlet=holders, traction={"top": [ZERO, force * -1, ZERO]}, dim=3, **written(body))
    if rng.random() < 0.15:
        scene.body_force = [0.0, -q, 0.0]
    if chance > 0.25 and rng.random() < 0.4:
        near_limit(rng, scene)
        scene.contact[0].xi = scene.contact[0].xi * rng.choice([1, 1, 1, 0.4])
    return scene


def gmsh_solid_scene(rng):
    """Balls, rollers and arches meshed by gmsh: tetrahedra, these cut into hexahedra, or hexahedra by extrusion, on obstacles."""
    shape, way = rng.choice(["octant", "roller", "arch"]), rng.choice(["tetrahedra", "cut", "extruded"])
    swept = way == "extruded" and shape == "arch"  # else gmsh would make triangles of the section here and there
    values = {"fine": rng.uniform(0.3, 1), "depth": rng.uniform(0.5, 2), "layers": rng.randint(2, 4), "width": rng.uniform(0.6, 2),
              "nx": rng.randint(3, 7), "ny": rng.randint(3, 5), "recombine": " Recombine;" if swept else "",
              "recombine_surface": " Recombine Surface {1};" if swept else ""}
    values["radius"] = values["width"] * rng.uniform(0.7, 3)
    if way == "cut" and shape == "arch":
        values.update(nx=3, ny=3, layers=2)
    text = {"octant": OCTANT, "roller": ROLLER, "arch": ARCH}[shape] % values
    parts = geometry(rng, text, rng.uniform(0.5, 0.9) if way == "cut" else rng.uniform(0.25, 0.6), way == "cut")
    solid_material = material(rng, nu=rng.uniform(0, 0.45))
    e, depth = solid_material["E"], log_uniform(rng, -2.7, -1.3)
    down = {"X": ZERO, "Y": f.Constant(-depth), "Z": ZERO}
    holders, traction, applied, q = {"top": down}, {}, [0.0] * 3, e * depth
    if shape == "octant":
        holders.update(left={"X": ZERO}, back={"Z": ZERO})
    elif shape == "arch" and rng.random() < 0.5:
        area = values["width"] * values["depth"]
        holders, traction, applied = {"left": CLAMPED_SOLID}, {"top": [ZERO, f.Constant(-q), ZERO]}, [0.0, -q * area, 0.0]
    x = values["width"] / 2 if shape == "arch" else 0.0
    clamped = "left" in holders and not shape == "octant"
    kind, radius = rng.choice(["plane", "sphere", "cylinder", "trough"] + (["bowl"] if shape == "octant" else [])), rng.uniform(0.5, 4)
    encloses = kind in ("bowl", "trough")
    radius += 2 * max(1, values["radius"]) if encloses else 0
    z, away = 0.0 if shape == "octant" else values["depth"] / 2, depth * rng.choice([0.0, 0.0, 0.3, 0.0 if clamped else -0.3])
    centre = (x, (1 if encloses else -1) * radius - away, z)
    along = rng.choice([(0.0, 0.0, 1.0)] if encloses else [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])
    obstacle = {"plane": {"Type": "plane", "Point": (0.0, -away, 0.0), "Normal": (0.0, 1.0, 0.0)},
                "sphere": {"Type": "sphere", "Centre": centre, "Radius": radius},
                "cylinder": {"Type": "cylinder", "Point": centre, "Axis": along, "Radius": radius}}
    chosen = {**obstacle.get({"bowl": "sphere", "trough": "cylinder"}.get(kind, kind)), **({"Encloses Body": True} if encloses else {})}
    xi = f.INFINITE if rng.random() < 0.3 else f.Constant(pressure_of_round(depth) * e * log_uniform(rng, -1, 0.3))
    return Scene(contact=[ContactSide("bottom", xi, normal=rng.choice([None, DOWN]), obstacle=chosen)], material=solid_material, dirichlet=holders,
                 traction=traction, applied=applied, expect="solution", **parts)


def socket_scene(rng):
    """A block by OpenCASCADE with a hollow in its underside, pressed on the ball or the rod that fits into it, nearly."""
    kind, radius = rng.choice(sorted(CUTTERS)), rng.uniform(0.5, 1)
    angle = math.asin(rng.uniform(0.15, 0.35) / radius)
    text = SOCKET % {"radius": radius, "angle": angle, "cutter": CUTTERS[kind]}
    cut = rng.random() < 0.3
    parts = geometry(rng, text, rng.uniform(0.35, 0.6), cut, order=1 if cut else None)
    solid_material = material(rng, nu=rng.uniform(0, 0.45))
    depth = log_uniform(rng, -4, -2)
    q, down = solid_material["E"] * depth, {"X": ZERO, "Y": f.Constant(-depth), "Z": ZERO}
    holders, traction, applied = rng.choice([({"top": down}, {}, [0.0] * 3),
                                             ({"left": CLAMPED_SOLID}, {"top": [ZERO, f.Constant(-q), ZERO]}, [0.0, -q, 0.0])])
    fit = radius * (1 - rng.choice([0.0, 1e-4, 1e-2, 0.1]))
    centre = (0.0, -radius * math.cos(angle) + radius - fit, 0.0)
    place = {"Centre": centre} if kind == "sphere" else {"Point": centre, "Axis": (0.0, 0.0, 1.0)}
    xi = f.INFINITE if rng.random() < 0.3 else f.Constant(q * log_uniform(rng, -1, 1))
    return Scene(contact=[ContactSide("bottom", xi, obstacle={"Type": kind, "Radius": fit, **place})], material=solid_material, dirichlet=holders,
                 traction=traction, applied=applied, expect="solution", **parts)


def revolved(rng, element, inner, width):
    """A section from a radius to another, with sides bottom, right, top, left: a box, or written to a mesh file."""
    nx, ny = cells(rng, element, most=30, nodes=1000)
    shape = rng.choice(["box", "box", "round", "distorted"])
    place = lambda s, t: (inner + s * width, t)
    if shape == "box":
        return {"mesh": {"Type": "box", "Cells": (nx, ny), "Element": element}, "lengths": {"Lower": (inner, 0.0), "Upper": (inner + width, 1.0)},
                "body": Body(Grid(nx, ny, element, place, axisymmetric=True))}
    if shape == "round":  # lowest at the inner end
        least = (width * width + 0.49) / 1.4  # the arc rises by 0.7 at most, below the top
        arc = rounded_place(2 * width, 1.0, max(least, width * log_uniform(rng, 0.1, 2)))
        place = lambda s, t: (inner + s * width, arc((1 + s) / 2, t)[1])
        return written(Body(Grid(nx, ny, element, place, axisymmetric=True)))
    size = rng.uniform(0.1, 0.24)
    shift = lambda i, j: (rng.uniform(-size, size) * width / nx, rng.uniform(-size, size) / ny)
    return written(Body(Grid(nx, ny, element, place, distort=shift, axisymmetric=True)))


def axisymmetric_scene(rng):
    """Discs, rings and tubes on a foundation below, in a bore or on a mandrel; some are held along the axis by contact only."""
    inner, width = rng.choice([0.0, 0.0, rng.uniform(0.05, 3)]), rng.uniform(0.3, 3)
    parts = revolved(rng, rng.choice(ELEMENTS), inner, width)
    solid_material = material(rng)
    e = solid_material["E"]
    q = load_scale(rng, e)
    strain, outer = q / e, inner + width
    kind = rng.choice(["below", "below", "below", "free", "bore"] + (["mandrel"] if inner else []))
    xi = yield_stress(rng, q, e) if rng.random() < 0.6 else varying_yield(rng, q, outer)
    field = gap(rng, strain, outer) if rng.random() < 0.5 else ZERO
    down, traction = {"Y": f.Constant(-strain)}, {"top": [ZERO, pressure(rng, -q, outer)]}
    contact = ContactSide("bottom", xi, field)
    if kind == "below":
        holders = rng.choice([{"top": down}, {"top": {"X": ZERO, **down}}, {"top": CLAMPED}, {"right": CLAMPED}])
        traction = {"right": [f.Constant(q * rng.uniform(-1, 1)), ZERO]} if "top" in holders else traction
    elif kind == "free":
        holders, traction = rng.choice([{}, {"right": {"X": ZERO}}]), {"top": [ZERO, f.Constant(-q)]}
        if xi is not f.INFINITE and rng.random() < 0.5:
            scene = Scene(contact=[contact], material=solid_material, dirichlet=holders, traction=traction, kinematics=AXISYMMETRIC, **parts)
            near_limit(rng, scene)
            contact.xi = contact.xi * rng.choice([1, 1, 0.4])
    else:
        side, sign = ("right", 1) if kind == "bore" else ("left", -1)
        contact = ContactSide(side, xi, f.Constant(strain * outer * rng.uniform(-0.5, 1)))
        holders, traction = {"bottom": {"Y": ZERO}}, {"top": [ZERO, f.Constant(-q * rng.uniform(0, 2))]}
        if kind == "mandrel" or inner:
            traction["right" if kind == "mandrel" else "left"] = [f.Constant(sign * q * rng.uniform(0.1, 2)), ZERO]
    if contact.side == "bottom" and rng.random() < 0.5:
        contact.gap = ZERO
        lowest, distance = min(y for _, y in parts["body"].parts[0].nodes), strain * rng.uniform(-0.2, 1)
        shape, radius = rng.choice(["plane", "sphere", "bowl"]), outer * log_uniform(rng, 0.2, 2)
        if shape == "plane":
            contact.obstacle = {"Type": "plane", "Point": (0.0, lowest - distance), "Normal": (0.0, 1.0)}
        else:
            contact.obstacle = {"Type": "sphere", "Centre": (0.0, lowest - distance + (radius if shape == "bowl" else -radius)), "Radius": radius,
                                "Encloses Body": shape == "bowl"}
        contact.normal = rng.choice([None, None, (0.0, -1.0)])
    body_force = [0.0, -q] if rng.random() < 0.1 and "lengths" in parts else None
    return Scene(contact=[contact], material=solid_material, dirichlet=holders, traction=traction, body_force=body_force, kinematics=AXISYMMETRIC,
                 **parts)


def plane_stress_scene(rng):
    scene = box_scene(rng)
    scene.kinematics = "plane stress"
    return scene


FAMILIES = {"solid": solid_scene, "round": round_scene, "solid_rollers": solid_rollers_scene, "gmsh_solid": gmsh_solid_scene,
            "socket": socket_scene, "axisymmetric": axisymmetric_scene, "plane_stress": plane_stress_scene}

# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes by family. A generator draws all it needs from a random.Random and returns a Scene in base units, in which
bodies have a size of about 1; `make` gives it units."""
import math

import fields as f
from plane import Body, Grid
from scene import ContactSide, Scene, applied_resultant, verdict

ELEMENTS = ["Q1", "P1", "Q2", "P2"]
MOST_NODES = 1500
MOST_ASPECT = 1000  # of cells


def log_uniform(rng, low, high):
    return 10 ** rng.uniform(low, high)


# --- meshes ----------------------------------------------------------------------------------------------------------------


def cells(rng, element, most=60, least=2, nodes=MOST_NODES):
    while True:
        nx, ny = (round(least * (most / least) ** rng.random()) for _ in range(2))
        p = int(element[1])
        if (p * nx + 1) * (p * ny + 1) <= nodes:
            return nx, ny


def box(rng, width=1.0, height=1.0, element=None, number=None, **more):
    """Mesh parameters of a box from (0, 0), and the same as a Body."""
    element = element or rng.choice(ELEMENTS)
    nx, ny = number or cells(rng, element, **more)
    body = Body(Grid(nx, ny, element, lambda s, t: (s * width, t * height)))
    return {"mesh": {"Type": "box", "Cells": (nx, ny), "Element": element},
            "lengths": {"Lower": (0.0, 0.0), "Upper": (width, height)}, "body": body}


def written(body):
    return {"mesh": {"Type": "gmsh"}, "file": body.msh, "body": body}


def rounded_place(width, height, radius):
    """A rectangle whose lower edge is an arc, lowest in the middle."""
    sag = lambda x: radius - math.sqrt(radius * radius - (x - width / 2) ** 2)
    return lambda s, t: (s * width, t * height + (1 - t) * sag(s * width))


def sector_place(inner, outer, half_angle):
    """Bottom is the outer arc, lowest point (0, 0)."""
    def place(s, t):
        angle, r = (2 * s - 1) * half_angle, outer + t * (inner - outer)
        return r * math.sin(angle), outer - r * math.cos(angle)
    return place


def mapped(rng, element=None, nodes=MOST_NODES):
    """A body of a random shape with sides bottom, top, left, right."""
    element = element or rng.choice(ELEMENTS)
    nx, ny = cells(rng, element, least=3, nodes=nodes)
    diagonal = rng.random() < 0.5
    options = {"diagonals": lambda i, j: diagonal and (i + j) % 2}
    shape = rng.choice(["rounded", "sector", "ell", "distorted", "graded"])
    if shape == "rounded":
        width = rng.uniform(0.5, 3)
        grid = Grid(nx, ny, element, rounded_place(width, 1.0, width * log_uniform(rng, -0.28, 3)), **options)
    elif shape == "sector":
        grid = Grid(nx, ny, element, sector_place(rng.uniform(0.1, 0.8), 1.0, rng.uniform(0.2, 1.4)), **options)
    elif shape == "ell":
        ci, cj = rng.randint(1, nx - 1), rng.randint(1, ny - 1)
        low = rng.random() < 0.5
        keep = (lambda i, j: i < ci or j >= cj) if low else (lambda i, j: i < ci or j < cj)
        width = rng.uniform(0.5, 4)
        grid = Grid(nx, ny, element, lambda s, t: (s * width, t), keep=keep, **options)
    elif shape == "distorted":
        width, size = rng.uniform(0.5, 4), rng.uniform(0.1, 0.3)
        shift = lambda i, j: (rng.uniform(-size, size) * width / nx, rng.uniform(-size, size) / ny)
        grid = Grid(nx, ny, element, lambda s, t: (s * width, t), distort=shift, **options)
    else:
        while True:
            a, b = rng.uniform(0.5, 4), rng.uniform(0.5, 4)
            if max(nx ** max(a, 1) / ny, ny ** max(b, 1) / nx) < MOST_ASPECT:
                break
        grid = Grid(nx, ny, element, lambda s, t: (s ** a, t ** b), distort=lambda i, j: (0.0, 0.0), **options)
    return Body(grid)


LAYERS = """w = %(width)r*L; h = L; m = %(middle)r*L;
Point(1) = {0, 0, 0, S}; Point(2) = {w, 0, 0, S}; Point(3) = {w, m, 0, S}; Point(4) = {0, m, 0, S};
Point(5) = {w, h, 0, S}; Point(6) = {0, h, 0, S};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2, 5}; Physical Curve("top") = {6}; Physical Curve("left") = {7, 4};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
"""
GEO = {
    "rounded": """w = 2*L; h = L; sag = 0.15*L;
Point(1) = {0, sag, 0, S}; Point(2) = {w/2, 0, 0, S}; Point(3) = {w, sag, 0, S}; Point(4) = {w, h, 0, S}; Point(5) = {0, h, 0, S};
Spline(1) = {1, 2, 3}; Line(2) = {3, 4}; Line(3) = {4, 5}; Line(4) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("body") = {1};
""",
    "half disc": """r = L;
Point(1) = {-r, r, 0, S}; Point(2) = {0, 0, 0, S}; Point(3) = {r, r, 0, S}; Point(4) = {0, r, 0, S};
Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1, 2}; Physical Curve("top") = {3, 4}; Physical Surface("body") = {1};
""",
    "layers": LAYERS % {"width": 2, "middle": 0.4},
}


def geo(rng):
    """Mesh parameters of a geometry that rpc has meshed, and its shape."""
    shape = rng.choice(sorted(GEO))
    size, order = rng.uniform(0.07, 0.3), rng.choice([1, 2])
    recombine = "Recombine Surface{:};\nMesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1;\n"
    text = GEO[shape] + (recombine if rng.random() < 0.5 else "")
    head = lambda length: f"L = {length!r}; S = {size * length!r};\nGeometry.Tolerance = {1e-8 * length!r};\n"
    return {"mesh": {"Type": "gmsh", "Order": order}, "file": lambda length: head(length) + text, "body": None, "cell": size / 4}, shape


# --- what acts on a body ---------------------------------------------------------------------------------------------------


def extent(body):
    xs = [x for grid in body.parts for x, _ in grid.nodes]
    ys = [y for grid in body.parts for _, y in grid.nodes]
    return min(xs), max(xs), min(ys), max(ys)


def material(rng, nu=None):
    e = 1000.0 if rng.random() < 0.4 else log_uniform(rng, 0, 12)
    return {"E": e, "nu": rng.uniform(-0.3, 0.45) if nu is None else nu, "blocks": {}}


def pressure(rng, q, width, positive=False):
    """A load of about q on a side of some width."""
    kind = rng.choice(["uniform", "uniform", "sine", "bump", "linear"])
    if kind == "uniform":
        return f.Constant(q)
    if kind == "sine":
        return f.sine(q, q * rng.uniform(0.1, 0.9 if positive else 2), rng.uniform(0.3, 4) / width, rng.uniform(0, 6))
    if kind == "bump":
        return f.bump(q * rng.uniform(1, 5), rng.uniform(0.1, 0.9) * width, width * log_uniform(rng, -1.5, -0.3))
    slope = rng.uniform(-0.9, 0.9) if positive else rng.uniform(-3, 3)
    return f.linear(q * (1 - slope / 2), q * slope / width)


def load_scale(rng, e):
    """Stress [Pa]: strains of 1e-5 to 1e-2, at times far from it."""
    q = e * log_uniform(rng, -5, -2)
    return q * log_uniform(rng, -6, 3) if rng.random() < 0.15 else q


def yield_stress(rng, q, e, infinite=0.2):
    chance = rng.random()
    if chance < infinite:
        return f.INFINITE
    return f.Constant(q * log_uniform(rng, -1, 1.5) if chance < 0.75 else e * log_uniform(rng, -8, 8))


def varying_yield(rng, q, width):
    span = log_uniform(rng, 0.3, 6)
    low = q * log_uniform(rng, -1, 0.3) / math.sqrt(span)
    kind = rng.choice(["exponential", "falling", "step", "oscillation"])
    if kind == "exponential":
        return f.exponential(low, low * span, width)
    if kind == "falling":
        return f.exponential(low * span, low, width)
    if kind == "step":
        pair = [low, low * span] if rng.random() < 0.5 else [low * span, low]
        return f.step(rng.uniform(0.1, 0.9) * width, *pair)
    return f.oscillation(low, low * span, rng.uniform(0.5, 12) / width)


def gap(rng, u, width, sign=None):
    """Gaps of about u, of a shape and a sign of their own."""
    g = u * log_uniform(rng, -2, 1) * (sign or rng.choice([-1, 1]))
    kind = rng.choice(["uniform", "wavy", "stairs", "parabola", "step", "bump"])
    if kind == "uniform":
        return f.Constant(g)
    if kind == "wavy":
        return f.sine(rng.uniform(-1, 1) * g, g, rng.uniform(0.5, 15) / width, rng.uniform(0, 6))
    if kind == "stairs":
        return f.stairs(g, width * rng.uniform(0.03, 0.5))
    if kind == "parabola":
        return f.parabola(4 * g / width ** 2, rng.uniform(0, 1) * width, rng.uniform(-1, 1) * g)
    if kind == "step":
        return f.step(rng.uniform(0.1, 0.9) * width, rng.uniform(-1, 1) * g, g)
    return f.bump(g, rng.uniform(0, 1) * width, width * log_uniform(rng, -1.5, 0))


ZERO = f.Constant(0.0)
CLAMPED = {"X": ZERO, "Y": ZERO}


def support(rng, names):
    """Sides that hold a body of sides left, right, top, bottom."""
    choices = [["top"], ["left"], ["left", "right"], ["left", "roller right"], ["left", "top"]]
    choice = rng.choice([c for c in choices if all(n.split()[-1] in names for n in c)])
    return {n.split()[-1]: ({"X": ZERO} if n.startswith("roller") else CLAMPED) for n in choice}


def held(rng, parts, width, q=None, xi=None, gap_field=None, normal=None, holders=None, force=None, shear=True, **more):
    """A body that Dirichlet conditions hold, over a foundation under its bottom."""
    parts = dict(parts)
    solid = more.pop("solid", None) or material(rng)
    names = parts["body"].sides() if parts.get("body") else more.pop("names")
    q = q if q is not None else load_scale(rng, solid["E"])
    holders = holders if holders is not None else support(rng, names)
    traction = {}
    if "top" in names and holders.get("top") is not CLAMPED:
        traction["top"] = [ZERO, (force or pressure(rng, q, width)) * -1]
    if shear and rng.random() < 0.3:
        free = [n for n in ("right", "left", "top") if n in names and n not in holders]
        if free:
            traction[free[0]] = [f.Constant(q * rng.uniform(-1, 1)), traction.get(free[0], [ZERO, ZERO])[1]]
    body_force = [rng.uniform(-1, 1) * q, -q] if (not traction or rng.random() < 0.15) else None
    contact = [ContactSide("bottom", xi or yield_stress(rng, q, solid["E"]), gap_field or ZERO, normal)]
    return Scene(contact=contact, material=solid, dirichlet=holders, traction=traction, body_force=body_force, **parts, **more)


# --- families --------------------------------------------------------------------------------------------------------------


def box_scene(rng):
    width = rng.uniform(0.3, 8)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    field = gap(rng, q / solid["E"], width) if rng.random() < 0.4 else ZERO
    return held(rng, box(rng, width), width, q, gap_field=field, solid=solid, normal=rng.choice([None, "surface", (0.0, -1.0)]))


def gmsh_scene(rng):
    if rng.random() < 0.4:
        parts, shape = geo(rng)
        names = {"rounded": ["bottom", "left", "right", "top"], "half disc": ["bottom", "top"]}.get(shape, ["bottom", "left", "right", "top"])
        holders = {"top": {"X": ZERO, "Y": f.Constant(-log_uniform(rng, -4, -1.5))}} if shape == "half disc" else None
        scene = held(rng, parts, 2.0, holders=holders, names=names, expect="solution")
        if holders:
            scene.traction, scene.body_force = {}, None
        if shape != "layers":
            plane = {"Type": "plane", "Point": (0.0, -rng.choice([0.0, 0.001])), "Normal": (0.0, 1.0)}
            q = scene.material["E"] * (-holders["top"]["Y"].value if holders else 1e-3)
            scene.contact = [ContactSide("bottom", f.Constant(q * log_uniform(rng, -1, 1)), normal=rng.choice([None, "surface"]), obstacle=plane)]
        else:
            scene.material["blocks"] = {"upper": (scene.material["E"] * log_uniform(rng, -3, 3), 0.3)}
        return scene
    body = mapped(rng)
    low, high, bottom, _ = extent(body)
    scene = held(rng, written(body), high - low)
    if rng.random() < 0.6:
        scene.contact[0].obstacle = {"Type": "plane", "Point": (0.0, bottom - rng.choice([0.0, 1e-3, -1e-4])), "Normal": (0.0, 1.0)}
        scene.contact[0].normal = None
    return scene


def slender_scene(rng):
    """Long bodies that lie on the foundation and thin ones that stand on it; nothing bends far."""
    ratio = log_uniform(rng, 1, 3)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    if rng.random() < 0.7:
        parts = box(rng, ratio, 1.0, number=(rng.randint(20, 60), rng.randint(2, 4)), element=rng.choice(ELEMENTS))
        holders = rng.choice([{"left": CLAMPED}, {"left": CLAMPED, "right": CLAMPED}, {"left": {"X": ZERO}, "right": {"X": ZERO}},
                              {"left": {"X": ZERO}}])
        xi = f.INFINITE if rng.random() < 0.3 else f.Constant(6 * q * log_uniform(rng, 0, 3))
        return held(rng, parts, ratio, q, xi, holders=holders, solid=solid, shear=False, force=pressure(rng, q, ratio, positive=True))
    parts = box(rng, 1.0, ratio, number=(rng.randint(2, 4), rng.randint(20, 60)))
    holders = rng.choice([{"left": {"X": ZERO}}, {"top": {"X": ZERO, "Y": f.Constant(-ratio * q / solid["E"])}, "left": {"X": ZERO}}])
    return held(rng, parts, 1.0, q, holders=holders, solid=solid, shear=False)


def stretched_scene(rng):
    """Cells of up to 1:1000."""
    thin = log_uniform(rng, -2.7, -0.5)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    if rng.random() < 0.5:  # a layer
        parts = box(rng, 1.0, thin, number=(rng.randint(4, 20), rng.randint(4, 24)))
        holders = rng.choice([{"top": {"X": ZERO, "Y": f.Constant(-q / solid["E"] * thin)}}, {"left": {"X": ZERO}, "right": {"X": ZERO}},
                              {"left": CLAMPED}])
    else:
        parts = box(rng, thin, 1.0, number=(rng.randint(4, 20), rng.randint(4, 24)))
        holders = {"left": {"X": ZERO}}
    width = parts["lengths"]["Upper"][0]
    field = gap(rng, q / solid["E"] * thin, width) if rng.random() < 0.3 else ZERO
    xi = f.INFINITE if rng.random() < 0.2 else f.Constant(q * log_uniform(rng, 0.3, 3))
    return held(rng, parts, width, q, xi, field, holders=holders, solid=solid, shear=False, force=pressure(rng, q, width, True))


def jump_scene(rng):
    element, width = rng.choice(ELEMENTS), rng.uniform(0.5, 4)
    nx, ny = cells(rng, element, most=30, least=4)
    at, pattern = rng.randint(1, ny - 1), rng.choice(["layers", "columns", "inclusion", "checkers"])
    upper = {"layers": lambda i, j: j >= at, "columns": lambda i, j: i >= nx // 2,
             "inclusion": lambda i, j: abs(2 * i + 1 - nx) < nx / 2 and abs(2 * j + 1 - ny) < ny / 2,
             "checkers": lambda i, j: (i // 2 + j // 2) % 2 == 1}[pattern]
    body = Body(Grid(nx, ny, element, lambda s, t: (s * width, t), block=lambda i, j: "second" if upper(i, j) else "first"))
    e = log_uniform(rng, 0, 6)
    solid = {"E": e, "nu": 0.3, "blocks": {"second": (e * log_uniform(rng, -6, 6), rng.uniform(0, 0.45))}}
    return held(rng, written(body), width, min(e, solid["blocks"]["second"][0]) * log_uniform(rng, -5, -2), solid=solid)


def incompressible_scene(rng):
    width = rng.uniform(0.5, 4)
    solid = material(rng, nu=0.5 - log_uniform(rng, -4, -1.31))
    return held(rng, box(rng, width, element=rng.choice(["Q2", "P2", "Q1"])), width, solid=solid)


def varying_xi_scene(rng):
    width = rng.uniform(0.5, 6)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    field = gap(rng, q / solid["E"], width) if rng.random() < 0.3 else ZERO
    return held(rng, box(rng, width), width, q, varying_yield(rng, q, width), field, solid=solid)


def gaps_scene(rng):
    width = rng.uniform(0.5, 6)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    far = rng.random() < 0.2
    field = gap(rng, (1e4 if far else 1) * q / solid["E"] * max(1, width ** 2), width, 1 if far else None)
    return held(rng, box(rng, width), width, q, varying_yield(rng, q, width) if rng.random() < 0.3 else None, field, solid=solid)


def obstacles_scene(rng):
    """Planes and circles, the body outside or inside of them, any normal."""
    body = mapped(rng)
    low, high, bottom, top = extent(body)
    width, middle = high - low, (low + high) / 2
    size = width + top - bottom
    scene = held(rng, written(body), width)
    q = load_scale(rng, scene.material["E"])
    distance = q / scene.material["E"] * rng.uniform(-0.5, 1)
    kind = rng.choice(["plane", "ball", "bowl"])
    contact = scene.contact[0]
    if kind == "plane":
        angle = rng.uniform(-0.1, 0.1)
        contact.obstacle = {"Type": "plane", "Point": (middle, bottom - distance), "Normal": (math.sin(angle), math.cos(angle))}
        contact.normal = rng.choice([None, "foundation", "surface", (0.0, -1.0)])
    else:
        radius = size * log_uniform(rng, 0.3, 3)
        centre = (middle, bottom - distance - radius) if kind == "ball" else (middle, bottom - distance + radius)
        contact.obstacle = {"Type": "circle", "Centre": centre, "Radius": radius, "Encloses Body": kind == "bowl"}
        contact.normal = rng.choice([None, None, (0.0, -1.0)])
        if kind == "ball" and contact.normal and rng.random() < 0.5:  # the normals of outer nodes miss it
            radius = width * rng.uniform(0.1, 0.45)
            contact.obstacle.update(Centre=(middle, bottom - distance - radius), Radius=radius)
    contact.xi = yield_stress(rng, q, scene.material["E"])
    return scene


def displacement_scene(rng):
    """A prescribed displacement presses the body into the foundation."""
    width = rng.uniform(0.5, 4)
    solid = material(rng)
    strain = log_uniform(rng, -6, -1)
    shape = rng.choice([f.Constant(-strain), f.linear(-strain * 1.5, strain / width), f.sine(-strain, strain / 2, 1 / width)])
    across = rng.choice([ZERO, f.Constant(strain * rng.uniform(-1, 1))])
    holders = {"top": {"X": across, "Y": shape}}
    chance = rng.random()
    if chance < 0.2:  # nodes that the foundation shares with a side that is moved into it
        holders = {"left": {"X": ZERO, "Y": f.Constant(-strain)}, "right": {"X": ZERO, "Y": f.Constant(-strain * rng.uniform(0, 1))}}
    elif chance < 0.4:
        holders = {"top": {"X": ZERO, "Y": shape}, "left": {"X": ZERO}}
    q = solid["E"] * strain
    parts = box(rng, width) if rng.random() < 0.6 else written(mapped(rng))
    if "top" not in parts["body"].sides():
        return None
    return held(rng, parts, width, q, yield_stress(rng, q, solid["E"], 0.35), holders=holders, solid=solid, shear=False,
                gap_field=gap(rng, strain, width) if rng.random() < 0.4 else ZERO)


def corner_scene(rng):
    """Contact under the body and beside it."""
    width = rng.uniform(0.4, 3)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    free = rng.random() < 0.5
    parts = box(rng, width, number=cells(rng, "Q2" if free else "Q1", most=24 if free else 60), element=rng.choice(ELEMENTS))
    if free:
        traction = {"top": [ZERO, f.Constant(-q)], "right": [f.Constant(-q * rng.uniform(0.2, 2)), ZERO]}
        xis = [f.INFINITE if rng.random() < 0.3 else f.Constant(q * log_uniform(rng, -0.5, 2)) for _ in range(2)]
        holders = {}
    else:
        traction = {"right": [f.Constant(-q), ZERO]}
        xis = [yield_stress(rng, q, solid["E"]) for _ in range(2)]
        holders = rng.choice([{"top": {"X": ZERO, "Y": f.Constant(-q / solid["E"])}}, {"top": CLAMPED}, {"right": CLAMPED}])
    gaps = [gap(rng, q / solid["E"], width) if rng.random() < 0.3 else ZERO for _ in range(2)]
    if "right" in holders:
        traction = {"top": [ZERO, pressure(rng, -q, width)]}
    return Scene(contact=[ContactSide("bottom", xis[0], gaps[0]), ContactSide("left", xis[1], gaps[1])], material=solid,
                 dirichlet=holders, traction=traction, **parts)


def rollers_scene(rng):
    """Held along the normal by contact only: whether by less than the foundation can carry, `verdict` knows."""
    width = rng.uniform(0.3, 6)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    chance = rng.random()
    xi = f.INFINITE if chance < 0.25 else f.Constant(q * log_uniform(rng, 0.05, 3)) if chance < 0.6 else varying_yield(rng, 10 * q, width)
    field = gap(rng, q / solid["E"] * log_uniform(rng, -1, 2), width) if rng.random() < 0.4 else ZERO
    holders = rng.choice([{"left": {"X": ZERO}}, {"left": {"X": ZERO}, "right": {"X": ZERO}}, {"top": {"X": ZERO}, "left": {"X": ZERO}}])
    parts = box(rng, width) if rng.random() < 0.7 else written(Body(Grid(*cells(rng, "Q2", least=3), rng.choice(ELEMENTS),
                                                                        rounded_place(width, 1.0, width * log_uniform(rng, 0, 3)))))
    scene = held(rng, parts, width, q, xi, field, holders=holders, solid=solid, shear=False, force=pressure(rng, q, width))
    if chance > 0.25 and rng.random() < 0.3:
        near_limit(rng, scene)
    return scene


def near_limit(rng, scene):
    """Scales a yield stress so that the load is 50 to 97 % of what the foundation carries."""
    grid = scene.body.parts[0]
    carried = sum(w * scene.contact[0].xi(*grid.nodes[k]) * -nu[1] for k, (w, nu) in grid.contact_nodes("bottom").items())
    load = -applied_resultant(scene)[1]
    if load > 0:
        scene.contact[0].xi = scene.contact[0].xi * (load / carried / rng.choice([0.5, 0.8, 0.9, 0.95, 0.969]))


def tilt_scene(rng):
    """Contact also has to carry a moment: only sliding is prevented."""
    width = rng.uniform(0.5, 4)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    xi = f.INFINITE if rng.random() < 0.3 else rng.choice([f.Constant(q * log_uniform(rng, 0.1, 2)), varying_yield(rng, 20 * q, width)])
    field = gap(rng, q / solid["E"] * log_uniform(rng, -1, 1), width) if rng.random() < 0.3 else ZERO
    parts = box(rng, width)
    return held(rng, parts, width, q, xi, field, holders={"bottom": {"X": ZERO}}, solid=solid, shear=rng.random() < 0.3,
                force=pressure(rng, q, width))


def parts_scene(rng):
    """Two bodies that do not touch."""
    element = rng.choice(ELEMENTS)
    nx, ny = cells(rng, element, least=3, nodes=600)
    first, second = rng.uniform(0.5, 2), rng.uniform(0.5, 2)
    body = Body(Grid(nx, ny, element, lambda s, t: (s * first, t)),
                Grid(nx, ny, element, lambda s, t: (first + 0.2 + s * second, t), prefix="other ", block=lambda i, j: "other"))
    solid = material(rng)
    solid["blocks"] = {"other": (solid["E"] * log_uniform(rng, -2, 2), 0.3)}
    q = load_scale(rng, min(solid["E"], solid["blocks"]["other"][0]))
    xi = yield_stress(rng, 3 * q, solid["E"], 0.4)
    holders = {"left": CLAMPED, "other left": rng.choice([CLAMPED, {"X": ZERO}, {"X": ZERO}, {}])}
    traction = {"top": [ZERO, f.Constant(-q)], "other top": [ZERO, f.Constant(-q * rng.choice([1, 1, 1, 1, -1, 0]))]}
    contact = [ContactSide("bottom", xi), ContactSide("other bottom", xi * rng.uniform(0.3, 3) if xi is not f.INFINITE else xi)]
    return Scene(contact=contact, material=solid, dirichlet={k: v for k, v in holders.items() if v}, traction=traction, **written(body))


def dim3_scene(rng):
    size = [rng.uniform(0.5, 3), rng.uniform(0.3, 2), rng.uniform(0.5, 3)]
    number = tuple(rng.randint(2, 7) for _ in range(3))
    solid = material(rng, nu=rng.uniform(-0.2, 0.45))
    q = load_scale(rng, solid["E"])
    area, volume = size[0] * size[2], size[0] * size[1] * size[2]
    rollers = rng.random() < 0.5
    uniform = rollers or rng.random() < 0.5
    load = f.Constant(-q) if uniform else pressure(rng, -q, size[0])
    weight = -q / size[1] if rng.random() < 0.3 else 0.0
    total = q * area - weight * volume
    if rollers:
        part = rng.choice([0.3, 0.8, 0.95, 0.969, 1.04, 2.0, -1])
        xi = f.INFINITE if part < 0 else f.Constant(total / area / part)
        holders, expect = {"left": {"X": ZERO}, "back": {"Z": ZERO}}, "limit" if part > 1 else "solution"
    else:
        xi, expect = yield_stress(rng, q, solid["E"]), "solution"
        holders = rng.choice([{"left": dict.fromkeys("XYZ", ZERO)}, {"left": dict.fromkeys("XYZ", ZERO), "right": dict.fromkeys("XYZ", ZERO)},
                              {"left": {"X": ZERO}, "back": {"Z": ZERO}, "right": {"Y": ZERO}}])
    field = f.Constant(q / solid["E"] * log_uniform(rng, -2, 0)) if rng.random() < 0.3 else ZERO
    element = rng.choice(ELEMENTS)
    order = int(element[1])
    number = tuple(max(2, (n + order - 1) // order) for n in number)
    return Scene(mesh={"Type": "box", "Cells": number, "Element": element}, lengths={"Lower": (0.0,) * 3, "Upper": tuple(size)}, dim=3,
                 contact=[ContactSide("bottom", xi, field)], material=solid, dirichlet=holders, traction={"top": [ZERO, load, ZERO]},
                 body_force=[0.0, weight, 0.0] if weight else None, expect=expect,
                 applied=[0.0, -total, 0.0] if uniform else None, cell=min(s / n for s, n in zip(size, number)) / order)


def no_solution_scene(rng):
    kind = rng.choice(["limit", "lifted", "slides", "no load", "tilted", "part", "single support", "pressed", "corner"])
    width = rng.uniform(0.5, 4)
    solid = material(rng)
    q = load_scale(rng, solid["E"])
    roller, sliding = {"left": {"X": ZERO}}, {"bottom": {"X": ZERO}}
    down = lambda force: {"top": [ZERO, force]}
    make_scene = lambda holders, traction, xi, field=ZERO, parts=None: Scene(
        contact=[ContactSide("bottom", xi, field)], material=solid, dirichlet=holders, traction=traction, **(parts or box(rng, width)))
    any_xi = f.INFINITE if rng.random() < 0.4 else f.Constant(q * log_uniform(rng, 0.5, 3))
    if kind == "limit":
        scene = make_scene(roller, down(f.Constant(-q)), varying_yield(rng, q, width))
        near_limit(rng, scene)
        scene.contact[0].xi = scene.contact[0].xi * (0.5 / rng.choice([1.04, 1.1, 2, 10]))
        return scene
    if kind == "lifted":
        return make_scene(roller, down(f.Constant(q)), any_xi, gap(rng, q / solid["E"], width))
    if kind == "slides":
        holders = rng.choice([{}, {"top": {"Y": f.Constant(-q / solid["E"])}}])
        return make_scene(holders, {} if holders else down(f.Constant(-q)), any_xi)
    if kind == "no load":
        return make_scene(roller, {}, any_xi, f.Constant(1e-3))
    if kind == "tilted":
        return make_scene(sliding, down(f.linear(-q * rng.uniform(0.5, 2), q * rng.uniform(5, 50) / width)), any_xi)
    if kind == "part":
        body = Body(Grid(6, 4, "Q1", lambda s, t: (s * width, t)),
                    Grid(6, 4, "Q1", lambda s, t: (s * width, 1.5 + t), prefix="other ", block=lambda i, j: "other"))
        return make_scene({"left": CLAMPED}, {"other top": [ZERO, f.Constant(-q)]}, any_xi, parts=written(body))
    if kind == "single support":  # one facet that may not sink, at an end
        element = rng.choice(ELEMENTS)
        grid = Grid(*cells(rng, element, least=3), element, lambda s, t: (s * width, t))
        grid.sides["support"] = grid.sides["bottom"][-1:]
        grid.sides["bottom"] = grid.sides["bottom"][:1]
        scene = make_scene({"support": {"X": ZERO}}, down(f.Constant(-q)), any_xi, parts=written(Body(grid)))
        return scene
    if kind == "pressed":
        holders = {"left": {"X": ZERO, "Y": f.Constant(-q / solid["E"])}, "right": CLAMPED}
        return make_scene(holders, {}, f.INFINITE)
    parts = box(rng, width, number=cells(rng, "Q2", most=20), element=rng.choice(ELEMENTS))
    xi = f.Constant(q / rng.choice([1.04, 1.5, 5]))
    return Scene(contact=[ContactSide("bottom", f.INFINITE), ContactSide("left", xi)], material=solid,
                 traction={"top": [ZERO, f.Constant(-q)], "right": [f.Constant(-q), ZERO]}, **parts)


PLAIN = {"box": box_scene, "gmsh": gmsh_scene, "slender": slender_scene, "stretched": stretched_scene, "jump": jump_scene,
         "incompressible": incompressible_scene, "varying_xi": varying_xi_scene, "gaps": gaps_scene, "obstacles": obstacles_scene,
         "displacement": displacement_scene, "corner": corner_scene, "rollers": rollers_scene, "tilt": tilt_scene,
         "parts": parts_scene, "dim3": dim3_scene, "no_solution": no_solution_scene}


def units_scene(rng):
    """A scene of any family in units far from 1."""
    scene = PLAIN[rng.choice([name for name in PLAIN if name != "no_solution"])](rng)
    if scene:
        scene.units = (log_uniform(rng, -6, 3), log_uniform(rng, -6, 12))
    return scene


def large_scene(rng):
    """Some of 4 000 to 12 000 unknowns, which multigrid solves."""
    width = rng.uniform(1, 6)
    number = (rng.randint(40, 60), rng.randint(30, 60))
    return held(rng, box(rng, width, element=rng.choice(["Q1", "P1"]), number=number), width)


FAMILIES = {**PLAIN, "units": units_scene, "large": large_scene}


def make(rng, number, families):
    """(family, scene, verdict): families take turns; what is too close to call is drawn again."""
    family = list(families)[number % len(families)]
    while True:
        scene = families[family](rng)
        if scene is None:
            continue
        scene.exodus = rng.random() < 0.05
        known = verdict(scene)
        if known is not None:
            return family, scene, known

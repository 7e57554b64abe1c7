# SPDX-License-Identifier: BSD-3-Clause
"""The scene of a row: sizes, fields and positions from a seed; what one feature is has one function each."""
import dataclasses
import math
import pathlib
import random
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent / folder) for folder in ("families", "stress")]

import bodies  # noqa: E402, after the folders of its imports
import fields as f  # noqa: E402
import scene as scenes  # noqa: E402
from generate import ZERO, log_uniform  # noqa: E402

TIMES = [1.0, 2.0, 3.0, 4.0]
CHECKPOINT_AFTER = 2  # steps that a run to be restarted takes before
ORDER = {"P1": 1, "Q1": 1, "P2": 2, "Q2": 2}
TARGETS = {("plane", 1): 0.15, ("plane", 2): 0.06, ("space", 1): 0.4, ("space", 2): 0.25}  # relative errors that few unknowns meet
MOST_DOFS = {"plane": 6000, "space": 9000}
TOLERANCES = (-1.5, -0.7)  # decades of Steps->Energy Tolerance
HELD_BY = {"pressed": 0.7, "loaded": 0.3}
INCOMPRESSIBLE = (0.49, 0.4999)


@dataclasses.dataclass
class Case:
    """A row with all that its seed has drawn."""

    number: int
    row: dict
    scene: scenes.Scene
    shape: bodies.Shape
    target: float = None  # relative error that is asked for
    tolerance: float = None  # of the energies
    ranks: int = 1
    threads: int = 1

    @property
    def side(self):
        return self.scene.contact[0]

    @property
    def name(self):
        return f"{self.number:04d}"


@dataclasses.dataclass
class Draw:
    """Sizes that the features of one row share."""

    rng: random.Random
    row: dict
    shape: bodies.Shape
    E: float
    approach: float  # of the body to the foundation, of its height [m]
    reach: float  # half of the width in contact, about [m]

    @property
    def pressure(self):
        """A pressure of the size of the largest [Pa]."""
        return self.E * self.approach / min(1.0, 2 * self.reach)


def make(seed, number, row):
    """The case of a row."""
    rng = random.Random(f"{seed}/row/{number}")
    approach = log_uniform(rng, -3, -2)
    curved = row["mesh"] in ("geo", "msh", "gmsh") and row["obstacle"] == "plane" and rng.random() < 0.5
    shape = bodies.shape(rng, row, curved, approach)
    reach = shape.lengths[0] * log_uniform(rng, -1.2, -0.35)
    draw = Draw(rng, row, shape, log_uniform(rng, 0, 4), approach, reach)
    contact = foundation(draw)
    stepped = row["history"] != "one"
    arguments = bodies.body(rng, row, shape)
    scene = scenes.Scene(contact=[contact], material=material(draw), exodus=True, times=list(TIMES) if stepped else None, **arguments)
    load(draw, scene)
    case = Case(number, row, scene, shape, threads=2 if row["parallel"].endswith("threads") else 1,
                ranks=int(row["parallel"][0]) if "rank" in row["parallel"] else 1)
    solver(row, scene)
    history(draw, case)
    adapt(draw, case)
    return case


def material(draw):
    rng, kind = draw.rng, draw.row["shape"]
    nu = rng.uniform(*INCOMPRESSIBLE) if kind == "incompressible" else rng.uniform(0.0, 0.45)
    blocks = {"other": (draw.E * log_uniform(rng, -1, 1), rng.uniform(0.0, 0.45))} if kind == "layers" else {}
    return {"E": draw.E, "nu": nu, "blocks": blocks}


# --- the foundation ----------------------------------------------------------------------------------------------------------


def foundation(draw):
    rng, row = draw.rng, draw.row
    down = (0.0, -1.0, 0.0)[:draw.shape.dim]
    contact = scenes.ContactSide("bottom", f.INFINITE)
    distance = draw.approach * rng.choice([0.0, 0.0, 0.3, -0.2])
    if row["obstacle"] in ("plane", "sphere"):
        contact.obstacle = obstacle(draw, distance)
        contact.normal = rng.choice([None, None, down])
    else:
        contact.gap = expression(draw, distance)
        contact.normal = rng.choice([None, down])
    law(draw, contact)
    if row["friction"] == "tresca":
        contact.friction = scenes.Friction(bound=f.Constant(draw.pressure * log_uniform(rng, -1.5, -0.3)))
    elif row["friction"] == "coulomb":
        contact.friction = scenes.Friction(f.Constant(rng.uniform(0.1, 0.6)))
    return contact


def law(draw, contact):
    rng, kind, p = draw.rng, draw.row["law"], draw.pressure
    if kind in ("xi", "hardening") or (kind == "springs" and rng.random() < 0.5):
        low = p * log_uniform(rng, -0.7, 0.3)
        contact.xi = f.linear(low, low * rng.uniform(0, 1) / draw.shape.lengths[0]) if rng.random() < 0.4 else f.Constant(low)
    if kind == "hardening":
        contact.hardening = p / draw.approach * log_uniform(rng, -1, 1)
    if kind == "springs":
        contact.stiffness = p / draw.approach * log_uniform(rng, -0.3, 1.5)


def centre(draw):
    """(x, z) of an obstacle's middle."""
    x, z = draw.shape.middle()
    if draw.shape.axisymmetric:
        return (0.0 if draw.row["obstacle"] == "sphere" or draw.rng.random() < 0.5 else x + draw.shape.lengths[0] * draw.rng.uniform(0.2, 0.8)), z
    return draw.shape.lengths[0] * draw.rng.uniform(0.25, 0.75), z * draw.rng.uniform(0.5, 1.5)


def obstacle(draw, distance):
    rng, dim = draw.rng, draw.shape.dim
    x, z = centre(draw)
    if draw.row["obstacle"] == "plane":
        slope = 0.0 if draw.shape.axisymmetric else draw.approach / draw.shape.lengths[0] * rng.uniform(-1, 1)
        return {"Type": "plane", "Point": (x, -distance, z)[:dim], "Normal": (slope, 1.0, 0.0)[:dim]}
    if draw.shape.axisymmetric and draw.shape.inner > 0:  # a sphere on the axis, under a ring: it touches at the bore
        draw.reach += draw.shape.inner
    radius = draw.reach ** 2 / (2 * draw.approach)
    below = math.sqrt(radius ** 2 - draw.shape.inner ** 2) if draw.shape.axisymmetric else radius
    return {"Type": "sphere", "Centre": (x, -distance - below, z)[:dim], "Radius": radius}


def expression(draw, distance):
    """Gaps of the size of the approach over the reach: smooth, with a tip, with a jump."""
    rng, (x, z) = draw.rng, centre(draw)
    base, space = f.Constant(distance), draw.shape.dim == 3
    if draw.row["obstacle"] == "smooth":
        curvature = draw.approach / draw.reach ** 2
        return base + (f.paraboloid(curvature, x, z) if space else f.parabola(curvature, x))
    if draw.row["obstacle"] == "tip":
        slope = draw.approach / draw.reach
        away = f"sqrt((X - {x!r})^2 + (Z - {z!r})^2)" if space else f"abs(X - {x!r})"
        return base + f.Field(f"({slope!r})*{away}", lambda a, b, c: slope * math.hypot(a - x, c - z if space else 0.0))
    height = draw.approach * log_uniform(rng, -1, 1)
    at = draw.shape.inner + draw.shape.lengths[0] * rng.uniform(0.3, 0.7)
    return base + f.step(at, *rng.choice([(0.0, height), (height, 0.0)]))


# --- loads and their history -------------------------------------------------------------------------------------------------


def load(draw, scene):
    """Pressed down by its top, or clamped at a side and loaded from above."""
    rng, dim = draw.rng, scene.dim
    components = scenes.COMPONENTS[:dim]
    loaded = rng.random() < HELD_BY["loaded"] and draw.row["history"] != "slide"
    if not loaded:
        scene.dirichlet = {"top": {**dict.fromkeys(components, ZERO), "Y": f.Constant(-draw.approach)}}
        return
    wall = "right" if draw.shape.axisymmetric else "left"
    scene.dirichlet = {wall: dict.fromkeys(components, ZERO)}
    q = draw.E * draw.approach / max(1.0, draw.shape.lengths[0]) ** 3
    scene.traction = {"top": [ZERO, f.Constant(-q), ZERO][:dim]}
    if math.isinf(draw.shape.radius) and rng.random() < 0.3:
        scene.body_force = [0.0, -q * rng.uniform(0.2, 1), 0.0][:dim]


def history(draw, case):
    kind, scene, rng = draw.row["history"], case.scene, draw.rng
    if kind == "one":
        return
    press = {"slide": [0.5, 1.0, 1.0, 1.0]}.get(kind, [0.5, 1.0, rng.uniform(0.2, 0.7), rng.choice([0.0, 0.1, 0.8])])
    for lists in (scene.dirichlet, scene.traction):
        for side, given in lists.items():
            moving = lambda field: field if field.value == 0 else f.InTime(field, press)
            lists[side] = {c: moving(v) for c, v in given.items()} if isinstance(given, dict) else [moving(v) for v in given]
    if kind == "slide":
        slide(draw, case)
    if kind == "tolerance":
        case.tolerance = log_uniform(rng, *TOLERANCES)
        scene.more["Steps"] = {"Energy Tolerance": case.tolerance}
    if kind == "restart":
        scene.more["Steps"] = {"Checkpoint Every": 1}


def slide(draw, case):
    """Along the foundation: the top, or an obstacle under it, from the first step on or later."""
    rng, scene, side = draw.rng, case.scene, case.side
    size = draw.approach * log_uniform(rng, -0.7, 0.5)
    factors = rng.choice([[0.3, 0.5, 0.75, 1.0], [0.0, 0.3, 1.0, 0.4]])
    if draw.shape.axisymmetric:
        end = draw.shape.inner + draw.shape.lengths[0]
        scene.dirichlet["top"]["X"] = f.InTime(f.linear(0.0, size / end), factors)
    elif side.obstacle and rng.random() < 0.5:
        along = (1.0, 0.0, rng.uniform(-1, 1))[:scene.dim]
        if side.obstacle["Type"] == "plane":
            slope = -side.obstacle["Normal"][0]
            along = (1.0, slope, along[2] if scene.dim == 3 else 0.0)[:scene.dim]
        side.motion = tuple(size * a for a in along), factors
    else:
        scene.dirichlet["top"]["X"] = f.InTime(f.Constant(size), factors)


# --- how it is solved ----------------------------------------------------------------------------------------------------------


def solver(row, scene):
    if row["solver"] == "meshes":
        scene.more["Linear Solver"] = {"Multigrid": "mesh"}
    elif row["solver"] == "algebraic":
        scene.more["Linear Solver"] = {"Multigrid": "algebraic"}
    # few unknowns have a factor of themselves


def adapt(draw, case):
    row = draw.row
    kind = "space" if row["body"] == "space" else "plane"
    if row["mesh"] in ("gmsh", "nested"):
        case.target = TARGETS[kind, ORDER[row["element"]]] * draw.rng.uniform(0.8, 1.5)
        case.scene.more["Adapt"] = {"Target Relative Error": case.target, "Max Dofs": MOST_DOFS[kind], "Meshes": row["mesh"]}
    elif row["history"] == "one":
        case.scene.more["Adapt"] = {"Estimate Error": True}

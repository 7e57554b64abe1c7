# SPDX-License-Identifier: BSD-3-Clause
"""Random load histories with friction, judged as histories.py has it: to and fro, pressed, lifted off and pressed again.

    python3 friction_histories.py --rpc=build/rpc [--seed=1] [--scenes=200] [--only=K] [--jobs=2] [--np=1] [--keep=DIR]

History K comes from the seed and K alone. Laws of friction are those of test/families/friction.py, some of a coefficient that depends on time,
on all laws of the foundation. Tractions along the side must be within what their points bear. What friction has dissipated never falls in the
limit of small steps, energies balance to the order of the step, and a run up to a step in between is the beginning of the whole one. The
exit code is 1 if a history failed.
"""
import dataclasses
import math
import sys

import fields
import generate
import histories
import space
from generate import CLAMPED, ZERO, log_uniform
from plane import Body, Grid
from scene import AXISYMMETRIC, ContactSide, Friction, Scene
from solid import Bricks
import friction  # of test/families, whose folder scenes.py has put on the path

NODES = 400
IN_TIME = 0.15  # of the coefficients
HELD = 0.55  # of mu p at most: the load that friction alone holds, pressed by 0.6 to 1 of p


# --- paths -----------------------------------------------------------------------------------------------------------------


def presses(rng, steps):
    """Factors of a press: it rises and falls, and may lift the body off in between."""
    return [1.0] + [rng.uniform(-0.5, 0.0) if rng.random() < 0.2 else rng.uniform(0.3, 1) for _ in range(steps - 1)]


def shears(rng, steps):
    """Factors of a shear: to and fro, up and back or at random, at times only once it is pressed."""
    kind = rng.choice(["to and fro", "up and back", "random"])
    if kind == "random":
        return [rng.uniform(-1, 1) for _ in range(steps)]
    start = rng.randint(0, 1)
    if kind == "up and back":
        top = rng.randint(1, steps)
        return [0.0] * start + [min(k / top, (2 * top - k) / top) for k in range(1, steps - start + 1)]
    turn = rng.randint(1, 3)
    return [0.0] * start + [(-1) ** (k // turn) * (k % turn + 1) / turn for k in range(steps - start)]


# --- bodies and laws -------------------------------------------------------------------------------------------------------


def slanted(rng, dim):
    """A body on a slope, and the slope."""
    slope, width, element = rng.uniform(-0.4, 0.4), rng.uniform(0.5, 2), rng.choice(generate.ELEMENTS)
    if dim == 2:
        return Body(Grid(*generate.cells(rng, element, nodes=NODES), element, lambda s, t: (s * width, t + slope * (1 - t) * s * width))), slope
    number = space.number_of_cells(rng, element, nodes=NODES)
    return Body(Bricks(number, element, lambda s, t, v: (s * width, t + slope * (1 - t) * s * width, v * width))), slope


def box(rng, dim, width=None):
    """Mesh parameters of a box, of a mapped body or of a block."""
    if dim == 3:
        return generate.written(space.solid(rng, "block" if width else rng.choice(["block", "distorted", "ball", "barrel"])))
    if width or rng.random() < 0.7:
        return generate.box(rng, width or rng.uniform(0.5, 3), nodes=NODES)
    while True:
        body = generate.mapped(rng, nodes=NODES)
        if "top" in body.sides():
            return generate.written(body)


def yields(rng, q, width):
    chance = rng.random()
    if chance < 0.3:
        return fields.INFINITE
    return fields.Constant(q * log_uniform(rng, -0.3, 0.8)) if chance < 0.7 else generate.varying_yield(rng, 3 * q, width)


def foundation(rng, contact, e):
    contact.hardening = e * log_uniform(rng, -2, 1) if rng.random() < 0.4 else 0.0
    contact.stiffness = e * log_uniform(rng, -1, 2) if rng.random() < 0.4 else math.inf
    contact.remembers = rng.random() < 0.85


def rub(rng, scene, p, steps):
    """Friction on the contact sides, where pressures are about p."""
    for number, contact in enumerate(scene.contact):
        if number and rng.random() < friction.WITHOUT:
            continue
        law, varies = friction.law(rng, p), rng.random() < IN_TIME
        factors = [rng.uniform(0.5, 1.5) for _ in range(steps)] if varies else None
        if varies and law.coefficient(1.0) > 0:
            law = dataclasses.replace(law, coefficient=fields.InTime(law.coefficient, factors))
        contact.friction = law


def largest(field):
    field = field.field if isinstance(field, fields.InTime) else field
    return max(abs(field(x)) for x in (0.0, 0.5, 1.0))


# --- families --------------------------------------------------------------------------------------------------------------


def any_history(rng):
    """One of histories.py, its loads as they are."""
    name, scene = histories.make(rng)
    pulls = [largest(f) for fs in scene.traction.values() for f in fs]
    moves = [scene.material["E"] * largest(f) for held in scene.dirichlet.values() for f in held.values()]
    rub(rng, scene, max(pulls + moves, default=0.0) or scene.material["E"] * 1e-3, len(scene.times))
    return scene


def moved(rng, steps, dim, strain):
    """Prescribed displacements of a side that presses and shears."""
    held = {"Y": fields.InTime(fields.Constant(-strain), presses(rng, steps))}
    for c in ["X", "Z"][:dim - 1]:
        held[c] = fields.InTime(fields.Constant(strain * log_uniform(rng, -0.7, 0.5)), shears(rng, steps)) if rng.random() < 0.8 else ZERO
    return held


def sheared(rng):
    """A block, or a body of revolution, whose top is pressed down and moved along a foundation, flat, with a gap or slanted."""
    steps, material, strain, dim = rng.randint(3, 6), generate.material(rng), log_uniform(rng, -4, -2), rng.choice([2, 2, 3])
    q, kinematics, contact = material["E"] * strain, None, ContactSide("bottom", fields.INFINITE)
    kind = rng.choice(["flat", "gap", "slanted", "slanted", "revolution"])
    if kind == "slanted":
        body, slope = slanted(rng, dim)
        parts = generate.written(body)
        contact.obstacle = {"Type": "plane", "Point": (0.0,) * dim, "Normal": (-slope, 1.0, 0.0)[:dim]}
    elif kind == "revolution":
        dim, kinematics = 2, AXISYMMETRIC
        parts = space.revolved(rng, rng.choice(generate.ELEMENTS), rng.choice([0.0, rng.uniform(0.05, 3)]), rng.uniform(0.3, 3))
    else:
        parts = box(rng, dim)
        contact.gap = generate.gap(rng, strain, 1.0) if kind == "gap" else ZERO
    contact.xi = yields(rng, q, 2.0)
    foundation(rng, contact, material["E"])
    held = moved(rng, steps, dim, strain)
    if kinematics:
        held["X"] = fields.InTime(fields.linear(0.0, strain * log_uniform(rng, -0.7, 0.3)), shears(rng, steps))  # 0 on the axis
    scene = Scene(material=material, dirichlet={"top": held}, contact=[contact], kinematics=kinematics, dim=dim,
                  times=[float(k + 1) for k in range(steps)], **parts)
    rub(rng, scene, q, steps)
    return scene


def dragged(rng):
    """The obstacle, a slanted plane, moves along itself under a body that is pressed on it."""
    steps, material, strain, dim = rng.randint(3, 6), generate.material(rng), log_uniform(rng, -4, -2), rng.choice([2, 2, 3])
    body, slope = slanted(rng, dim)
    q, size = material["E"] * strain, strain * log_uniform(rng, -0.7, 0.5)
    along, across = size / math.hypot(1, slope), size * rng.uniform(-1, 1)
    contact = ContactSide("bottom", yields(rng, q, 2.0), obstacle={"Type": "plane", "Point": (0.0,) * dim, "Normal": (-slope, 1.0, 0.0)[:dim]},
                          motion=((along, slope * along, across)[:dim], shears(rng, steps)))
    foundation(rng, contact, material["E"])
    top = {"Y": fields.InTime(fields.Constant(-strain), presses(rng, steps)), **dict.fromkeys(["X", "Z"][:dim - 1], ZERO)}
    scene = Scene(material=material, dirichlet={"top": top}, contact=[contact], dim=dim, times=[float(k + 1) for k in range(steps)],
                  **generate.written(body))
    rub(rng, scene, q, steps)
    return scene


def two_sides(rng):
    """In a corner, or in a channel."""
    steps, material, strain, width = rng.randint(3, 6), generate.material(rng), log_uniform(rng, -4, -2), rng.uniform(0.5, 3)
    q = material["E"] * strain
    moves = moved(rng, steps, 2, strain)
    if rng.random() < 0.5:
        sides, held = ("bottom", "left"), {"top": moves}
    else:
        sides, held = ("bottom", "top"), {"left": CLAMPED, "right": moves}
    contact = [ContactSide(side, fields.Constant(q * log_uniform(rng, -0.5, 0.7)), fields.Constant(strain * rng.uniform(-0.3, 0.3)))
               for side in sides]
    for side in contact:
        foundation(rng, side, material["E"])
    scene = Scene(material=material, dirichlet=held, contact=contact, times=[float(k + 1) for k in range(steps)], **box(rng, 2, width))
    rub(rng, scene, q, steps)
    return scene


def pushed(rng):
    """Pressed by a load, and held along the foundation by friction alone against another, which stays below what friction holds."""
    steps, material, strain, dim = rng.randint(3, 6), generate.material(rng), log_uniform(rng, -4, -2), rng.choice([2, 2, 3])
    q, mu = material["E"] * strain, rng.uniform(*friction.MU) / 2
    xi = fields.INFINITE if rng.random() < 0.5 else fields.Constant(q * rng.uniform(4, 10))
    push = fields.InTime(fields.Constant(rng.uniform(0.3, 1) * HELD * 0.6 * mu * q), shears(rng, steps))
    press = fields.InTime(fields.Constant(-q), [1.0] + [rng.uniform(0.6, 1) for _ in range(steps - 1)])
    contact = ContactSide("bottom", xi, friction=Friction(fields.Constant(mu)))
    foundation(rng, contact, material["E"])
    body = generate.box(rng, 3.0, nodes=NODES)
    if dim == 3:
        element = rng.choice(generate.ELEMENTS)
        body = generate.written(Body(Bricks(space.number_of_cells(rng, element, nodes=NODES), element, lambda s, t, v: (3 * s, t, 3 * v))))
    return Scene(material=material, traction={"top": [push, press, ZERO][:dim]}, contact=[contact], dim=dim,
                 times=[float(k + 1) for k in range(steps)], **body)


FAMILIES = {"any": any_history, "sheared": sheared, "dragged": dragged, "two_sides": two_sides, "pushed": pushed}
WITHOUT_SUPPORT = {"pushed"}  # whose loads friction holds by their making


def make(rng):
    """(family, scene) of a history that has a solution at all of its steps."""
    while True:
        name = rng.choice(list(FAMILIES))
        scene = FAMILIES[name](rng)
        if name in WITHOUT_SUPPORT or histories.solvable(scene):
            return name, scene


if __name__ == "__main__":
    sys.exit(histories.suite(__doc__, 200, "friction history", make))

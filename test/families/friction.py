# SPDX-License-Identifier: BSD-3-Clause
"""The families of families.py with friction: loads along the foundation besides those on it, so that points stick and slip.

A body, its press, gap and yield stress are those of the family. Each contact side has Coulomb's law, Tresca's or both, at times with a
limit and varying along the surface; some second sides have none. As in families.py all but the mesh comes from a scene's seed and number.
"""
import math

import fields as f  # families.py has put its folder on the path
from generate import log_uniform
from scene import Friction

MU = (0.05, 1.5)
WITHOUT = 0.2  # of second sides
HARDER = 0.8  # yield stresses, by up to 10 to this power: a foundation that yields is one on which points slip
SHEAR = 2.5  # E over G, about


def draw_mu(rng):
    return math.exp(rng.uniform(*map(math.log, MU)))


def varying(rng, draw):
    """A field that varies along x between two draws."""
    values = [draw(), draw()]
    if rng.random() < 0.5:
        return f.step(rng.uniform(0.3, 3), *values)
    return f.oscillation(min(values), max(values), log_uniform(rng, -0.7, 0.7))


def field(rng, draw):
    return f.Constant(draw()) if rng.random() < 0.7 else varying(rng, draw)


def law(rng, p):
    """Friction where pressures are about p."""
    bears = lambda: p * draw_mu(rng)
    kind = rng.choice(["coulomb"] * 5 + ["limited"] * 2 + ["tresca"] * 3 + ["both"] * 2)
    if kind == "tresca":
        return Friction(bound=field(rng, bears) * rng.choice([1, 1, 0.1]))
    mu = field(rng, lambda: draw_mu(rng))
    if kind == "both":
        return Friction(mu, field(rng, bears) * log_uniform(rng, -2, 0), f.Constant(bears()) if rng.random() < 0.3 else f.INFINITE)
    return Friction(mu, limit=f.Constant(bears()) if kind == "limited" else f.INFINITE)


def pressure_of(contact):
    """Yield stresses are of the size of pressures; that in the middle."""
    values = sorted(contact.xi(x) for x in (0.25, 0.5, 1.0, 1.5, 2.0))
    return values[len(values) // 2]


def drag_of(rng, p, frictions):
    """A traction along a side, in part of what the foundation bears, in part beyond it."""
    return rng.choice([-1, 1]) * log_uniform(rng, -1.3, 0.2) * max(min(friction.bears(p, 1.0), p) for friction in frictions)


def shear(rng, scene, p, frictions):
    """Loads and prescribed displacements that press from above press along the foundation, too."""
    along = ["X", "Z"][:scene.dim - 1]
    for fields in scene.traction.values():
        for c in along:
            fields["XYZ".index(c)] += f.Constant(drag_of(rng, p, frictions))
    if scene.body_force:
        scene.body_force[0] += drag_of(rng, p, frictions)
    for held in scene.dirichlet.values():
        if not is_zero(held["Y"]):
            for c in along:
                held[c] = f.Constant(SHEAR * abs(held["Y"](1.0)) / p * drag_of(rng, p, frictions))


def is_zero(field_):
    return isinstance(field_, f.Constant) and field_.value == 0


def rubbed(family):
    """The same family with friction."""
    def make(rng, sizes):
        scene = family(rng, sizes)
        for number, contact in enumerate(scene.contact):
            if number == 0 or rng.random() >= WITHOUT:
                contact.friction = law(rng, pressure_of(contact))
        shear(rng, scene, pressure_of(scene.contact[0]), [contact.friction for contact in scene.contact if contact.friction])
        for contact in scene.contact:
            contact.xi *= log_uniform(rng, 0, HARDER)
        return scene
    make.__doc__ = family.__doc__
    return make


def families_of(families):
    return {name: rubbed(family) for name, family in families.items()}

# SPDX-License-Identifier: BSD-3-Clause
"""The contact side: its points, weights and normals by doc/theory.md (2.7), gaps from the scene's own fields, and the laws at points.

Gaps and normals come from scene.ContactSide.at, closed forms and fields in Python.
"""
import dataclasses
import itertools
import math

import numpy as np

from elasticity import around, facet_geometry
from elements import gauss


@dataclasses.dataclass
class Points:
    """Places on the side with their foundation at one time. Those whose normal misses the obstacle are left out."""

    place: np.ndarray  # (points, dim)
    normal: np.ndarray  # (points, dim) nu
    gap: np.ndarray  # (points,)
    xi: np.ndarray
    index: np.ndarray  # of the places that were asked for


def seen(contact, place, outward):
    """@param place, outward (points, dim)  @return Points"""
    normals, gaps, limits, index = [], [], [], []
    for k, (x, n) in enumerate(zip(place, outward)):
        found = contact.at(tuple(map(float, x)), tuple(map(float, n)))
        if found:
            normals.append(found[0])
            gaps.append(found[1])
            limits.append(contact.xi(*map(float, x)))
            index.append(k)
    dim = place.shape[1]
    return Points(place[index], np.array(normals).reshape(-1, dim), np.array(gaps), np.array(limits), np.array(index, dtype=int))


def nodal_rule(element, facet, axisymmetric):
    """[(node of the cell, points, weights, whether to weigh with N)] of (2.7), (2.7a) on a facet."""
    corners, nodes = len(element.facets[facet]), element.facet_nodes(facet)
    if element.order == 1:
        points, weights = gauss(3, 1) if corners == 2 else gauss(3, 2) if corners == 4 else (np.array([[1 / 3, 1 / 3]]), np.array([0.5]))
        return [(node, points, weights, True) for node in nodes]
    if corners == 3:
        lattice = {(0.5, 0.0): 1 / 6, (0.5, 0.5): 1 / 6, (0.0, 0.5): 1 / 6}
    else:
        line = {-1.0: 1 / 3, 0.0: 4 / 3, 1.0: 1 / 3}
        lattice = {place: math.prod(line[c] for c in place) for place in itertools.product(line, repeat=1 if corners == 2 else 2)}
    rule = []
    for place, weight in lattice.items():
        at = element.facet_map(facet, np.array([place]))[0]
        node = int(np.argmin(np.linalg.norm(element.places - at, axis=1)))
        rule.append((node, np.array([place]), np.array([weight]), False))
    return rule


def contact_points(mesh, side, axisymmetric):
    """(nodes, weights, outward unit normals) of the points of contact; nodes without weight are none."""
    weight, normal = np.zeros(len(mesh.coords)), np.zeros_like(mesh.coords)
    for element, cells, facet in mesh.facets(side):
        for node, points, omega, by_shape in nodal_rule(element, facet, axisymmetric):
            values, place, scaled = facet_geometry(mesh, element, cells, facet, points)
            part = omega * (values[:, node] if by_shape else 1.0)
            np.add.at(weight, cells[:, node], np.sum(np.linalg.norm(scaled, axis=2) * around(place, axisymmetric) * part, axis=1))
            np.add.at(normal, cells[:, node], np.einsum("q,fqd->fd", part, scaled))
    nodes = np.flatnonzero(weight > 0)
    return nodes, weight[nodes], normal[nodes] / np.linalg.norm(normal[nodes], axis=1, keepdims=True)


def samples_of(corners):
    """Ten points of an edge or triangle, sixteen of a quadrilateral; their ends included."""
    if corners == 2:
        return np.linspace(-1, 1, 10)[:, None]
    if corners == 3:
        return np.array([(a / 3, b / 3) for a in range(4) for b in range(4 - a)])
    return np.array([(a, b) for a in np.linspace(-1, 1, 4) for b in np.linspace(-1, 1, 4)])


def middles_of(corners, parts=20):
    """The middles of equal parts of an edge, a triangle or a quadrilateral. They count alike in integrals, and none is on an edge."""
    if corners == 3:
        return np.array([((3 * a + k) / (3 * parts), (3 * b + k) / (3 * parts)) for k in (1, 2) for a in range(parts) for b in range(parts - a - k + 1)])
    line = (2 * np.arange(parts) + 1) / parts - 1
    return line[:, None] if corners == 2 else np.array([(a, b) for a in line for b in line])


@dataclasses.dataclass
class Samples:
    """Points between contact points: what their facet's nodes say there, and the facet of each."""

    place: np.ndarray
    outward: np.ndarray
    u: np.ndarray
    dent: np.ndarray
    area: np.ndarray  # of each one's part of the facet, if parts are equal
    facet: np.ndarray  # number of the facet
    nodes: list  # of each facet


REFERENCE = {2: 2.0, 3: 0.5, 4: 4.0}  # length and areas of the reference edge, triangle and quadrilateral


def samples(mesh, side, u, dent, lattice=samples_of):
    """@param lattice  by the number of corners: places in the reference facet"""
    parts, nodes = [], []
    for element, cells, facet in mesh.facets(side):
        corners = len(element.facets[facet])
        at = lattice(corners)
        values, place, normal = facet_geometry(mesh, element, cells, facet, at)
        size = np.linalg.norm(normal, axis=2, keepdims=True)
        number = len(nodes) + np.repeat(np.arange(len(cells)), place.shape[1])
        nodes += list(cells[:, element.facet_nodes(facet)])
        flat = lambda a: a.reshape(-1, a.shape[-1])
        parts.append((flat(place), flat(normal / size),
                      flat(np.einsum("qn,fnd->fqd", values, u[cells])), np.maximum(0, np.einsum("qn,fn->fq", values, dent[cells])).ravel(),
                      size.ravel() * REFERENCE[corners] / len(at), number))
    return Samples(*(np.concatenate(column) for column in zip(*parts)), nodes)


def facet_size(mesh, side):
    """Of the largest facet of a side [m]."""
    return max(float(np.max(np.ptp(mesh.coords[cells[:, element.facet_nodes(facet)]], axis=1))) for element, cells, facet in mesh.facets(side))


# --- laws --------------------------------------------------------------------------------------------------------------------


def energy_of(v, xi, hardening, compliance):
    """psi, (3.11); of a rigid foundation that never yields 0: what is left of v there is the solver's."""
    if v <= 0 or (math.isinf(xi) and compliance == 0):
        return 0.0
    if v <= compliance * xi:
        return v * v / (2 * compliance)
    beyond = v - compliance * xi
    return xi * (v - compliance * xi / 2) + hardening * beyond ** 2 / (2 * (1 + compliance * hardening))


def law_violations(contact, points, p, v, w, before, small, parts=1):
    """Complaints about contact points. @param v u_nu - g, w dents, before dents of the step before or None
    @param parts  of the step: the dent may have grown in one of several, before the pressure fell
    @param small  (pressure, length) that count as nothing"""
    limit = points.xi + (contact.hardening * w if contact.hardening else 0.0)
    compliance = 0.0 if math.isinf(contact.stiffness) else 1 / contact.stiffness
    off = v - w - compliance * p  # of a point under pressure: 0
    rules = {
        "pressure below 0": -p / small[0],
        "pressure above the yield limit": (p - limit) / (small[0] + 1e-6 * np.where(np.isinf(limit), 0, limit)),
        "penetration without pressure": np.where(p <= small[0], (v - w) / (small[1] + compliance * small[0]), 0),
        "pressure without touch": np.where(p > small[0], np.abs(off) / (small[1] + 10 * compliance * small[0]), 0),
        "a dent below 0": -w / small[1],
    }
    if before is not None:
        rules["a dent that shrinks"] = (before - w) / small[1]
        if parts == 1:
            rules["a dent that grows below the yield limit"] = np.where(w > before + small[1], (limit * (1 - 1e-6) - p) / small[0], 0)
    return worst(rules, points.place)


def friction_violations(law, points, p, q, e, small):
    """Of a law of friction (12.1), (12.2). @param e slip of the step along the side, or None where it is not known"""
    bound = np.array([law.bears(pressure, *map(float, x)) for pressure, x in zip(p, points.place)])
    size = np.linalg.norm(q, axis=1)
    rules = {"friction along the normal": np.abs(np.einsum("kd,kd->k", q, points.normal)) / small[0],
             "friction above its bound": (size - bound) / (small[0] + 1e-6 * bound)}
    if e is not None:
        slip = np.linalg.norm(e, axis=1)
        rules["slip below the bound"] = np.where(size < bound * (1 - 1e-5) - small[0], slip / small[1], 0)
        across = np.linalg.norm(size[:, None] * e - slip[:, None] * q, axis=1)
        # Errors of q and of e come in twice, by their lengths too.
        rules["friction that is not along the slip"] = across / (2 * (small[0] * slip + size * small[1]) + 1e-300)
    return worst(rules, points.place)


def worst(rules, place):
    """One complaint for each rule that is broken: its worst point, by how much of what counts as nothing."""
    found = []
    for name, excess in rules.items():
        if len(excess) and np.max(excess) > 1:
            k = int(np.argmax(excess))
            found.append(f"{name} at ({', '.join(f'{x:.6g}' for x in place[k])}), {excess[k]:.2g} times what counts as nothing")
    return found

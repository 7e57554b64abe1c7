# SPDX-License-Identifier: BSD-3-Clause
"""Lagrange elements of Exodus: shape functions, rules of integration and facets, for an oracle that shares no code with rpc.

Reference coordinates run over [-1, 1] in quadrilaterals and hexahedra, over the unit simplex in triangles and tetrahedra.
"""
import itertools

import numpy as np

SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
CUBE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
        (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1),
        (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (1, 1, 1),
        (1, 1, 0), (1, 1, 2), (0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1)]
EDGES = {2: [(0, 1), (1, 2), (2, 0)], 3: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]}  # with a middle node, of simplices
FACETS = {"TRI": [(0, 1), (1, 2), (2, 0)], "QUAD": [(0, 1), (1, 2), (2, 3), (3, 0)],
          "TETRA": [(0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)],
          "HEX": [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)]}
NODES = {"TRI3": 1, "TRI6": 2, "QUAD4": 1, "QUAD9": 2, "TETRA4": 1, "TETRA10": 2, "HEX8": 1, "HEX27": 2}


def gauss(points, dim):
    """(points, weights) on [-1, 1]^dim."""
    x, w = np.polynomial.legendre.leggauss(points)
    places = np.array(list(itertools.product(x, repeat=dim))).reshape(-1, dim)
    return places, np.array([np.prod(ws) for ws in itertools.product(w, repeat=dim)])


def orbits(*groups):
    """(points, weights): of each (barycentric coordinates, weight) all permutations."""
    places, weights = [], []
    for barycentric, weight in groups:
        for each in sorted(set(itertools.permutations(barycentric))):
            places.append(each[1:])
            weights.append(weight)
    return np.array(places), np.array(weights)


def triangle(degree):
    """Strang and Fix, Dunavant."""
    if degree <= 1:
        return orbits(((1 / 3,) * 3, 0.5))
    if degree == 2:
        return orbits(((2 / 3, 1 / 6, 1 / 6), 1 / 6))
    if degree <= 4:
        a, b = 0.445948490915964886, 0.0915762135097707435
        return orbits(((1 - 2 * a, a, a), 0.111690794839005733), ((1 - 2 * b, b, b), 0.0549758718276609338))
    a, b, c, d = 0.0630890144915022283, 0.249286745170910421, 0.310352451033784405, 0.0531450498448169474
    return orbits(((1 - 2 * a, a, a), 0.0254224531851034085), ((1 - 2 * b, b, b), 0.058393137863189683), ((c, d, 1 - c - d), 0.0414255378091867876))


def tetrahedron(degree):
    """The centroid, and the rule of two orbits of four points with the same weight, exact for degree 3."""
    if degree <= 1:
        return orbits(((0.25,) * 4, 1 / 6))
    a, b = two_orbits()
    return orbits(((1 - 3 * a, a, a, a), 1 / 48), ((1 - 3 * b, b, b, b), 1 / 48))


def two_orbits():
    """The numbers a, b of two orbits (1 - 3a, a, a, a), (1 - 3b, b, b, b) of eight points with the same weight that are exact for degree 3.

    With x one barycentric coordinate and s = 1/4 - a, three points of an orbit have x - 1/4 = -s and one 3 s. So the means of (x - 1/4)^2 and
    (x - 1/4)^3 over the eight points are 12/8 and 24/8 times the sums of s^2 and s^3; they must be those over the tetrahedron.
    """
    mean = lambda k: 6.0 / ((k + 1) * (k + 2) * (k + 3))  # of x^k
    second = mean(2) - mean(1) / 2 + 1 / 16
    third = mean(3) - 3 / 4 * mean(2) + 3 / 16 * mean(1) - 1 / 64
    s, sums = np.array([0.15, -0.08]), np.array([second * 8 / 12, third * 8 / 24])
    for _ in range(50):  # Newton's method
        s = s - np.linalg.solve(np.array([2 * s, 3 * s ** 2]), np.array([np.sum(s ** 2), np.sum(s ** 3)]) - sums)
    return 0.25 - s


class Element:
    """An element by Exodus' name."""

    def __init__(self, name):
        self.name, self.order = name, NODES[name]
        self.kind = name.rstrip("0123456789")
        self.simplex, self.dim = self.kind in ("TRI", "TETRA"), 3 if self.kind in ("TETRA", "HEX") else 2
        self.places = self._places()  # (nodes, dim)
        self.corners = self.dim + 1 if self.simplex else 2 ** self.dim
        self.facets = FACETS[self.kind]

    def _places(self):
        if not self.simplex:
            lattice = {2: SQUARE, 3: CUBE}[self.dim]
            return np.array(lattice[:2 ** self.dim] if self.order == 1 else lattice) - 1.0
        corners = np.vstack([np.zeros(self.dim), np.eye(self.dim)])
        return corners if self.order == 1 else np.vstack([corners] + [(corners[a] + corners[b]) / 2 for a, b in EDGES[self.dim]])

    def rule(self, axisymmetric=False):
        """For stiffness."""
        if not self.simplex:
            return gauss(self.order + 1, self.dim)
        degree = self.dim * (self.order - 1) + (2 if axisymmetric else 0)
        return triangle(degree) if self.dim == 2 else tetrahedron(degree)

    def shapes(self, at):
        """@param at (points, dim)  @return values (points, nodes), slopes (points, nodes, dim)"""
        at = np.atleast_2d(at)
        return simplex_shapes(self, at) if self.simplex else tensor_shapes(self, at)

    def facet_nodes(self, side):
        """Nodes of the cell on a facet: its corners first, in their order."""
        corners = list(self.facets[side])
        if self.order == 1:
            return corners
        plane = self.places[corners]
        on = [n for n in range(self.corners, len(self.places)) if in_hull(plane, self.places[n])]
        return corners + on

    def facet_map(self, side, at):
        """Cell coordinates (points, dim) of facet points, and their derivatives (points, dim, dim - 1). Facet coordinates are those of a
        line, triangle or quadrilateral with the corners of `facets`."""
        corners = self.places[list(self.facets[side])]
        values, slopes = FACET[len(corners)].shapes(at) if len(corners) > 2 else line_shapes(at)
        return values @ corners, np.einsum("qne,nd->qde", slopes, corners)


def in_hull(corners, place):
    """Whether a lattice place is a mean of some corners of a facet."""
    return any(np.allclose(np.mean(corners[list(some)], axis=0), place)
               for count in (2, len(corners)) for some in itertools.combinations(range(len(corners)), count))


def line_shapes(at):
    t = np.asarray(at).reshape(-1)
    return np.stack([(1 - t) / 2, (1 + t) / 2], axis=1), np.broadcast_to(np.array([-0.5, 0.5])[None, :, None], (len(t), 2, 1))


def tensor_shapes(element, at):
    if element.order == 1:
        of = lambda c, t: ((1 + c * t) / 2, np.full_like(t, c / 2))
    else:
        of = lambda c, t: (1 - t * t, -2 * t) if c == 0 else (t * (t + c) / 2, t + c / 2)
    factors = [[of(c, at[:, d]) for d, c in enumerate(place)] for place in element.places]
    values = np.stack([np.prod([f[0] for f in node], axis=0) for node in factors], axis=1)
    slopes = np.stack([np.stack([np.prod([f[1 if e == d else 0] for e, f in enumerate(node)], axis=0) for d in range(element.dim)], axis=1)
                       for node in factors], axis=1)
    return values, slopes


def simplex_shapes(element, at):
    dim = element.dim
    l = np.hstack([1 - at.sum(axis=1, keepdims=True), at])
    dl = np.vstack([-np.ones(dim), np.eye(dim)])
    if element.order == 1:
        return l, np.broadcast_to(dl, (len(at), dim + 1, dim)).copy()
    values = [l[:, a] * (2 * l[:, a] - 1) for a in range(dim + 1)] + [4 * l[:, a] * l[:, b] for a, b in EDGES[dim]]
    slopes = [(4 * l[:, a:a + 1] - 1) * dl[a] for a in range(dim + 1)]
    slopes += [4 * (l[:, a:a + 1] * dl[b] + l[:, b:b + 1] * dl[a]) for a, b in EDGES[dim]]
    return np.stack(values, axis=1), np.stack(slopes, axis=1)


FACET = {3: Element("TRI3"), 4: Element("QUAD4")}

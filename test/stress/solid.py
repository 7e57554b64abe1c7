# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in space from mapped grids, as plane.py has them in the plane: sides, contact nodes, loads and cells in gmsh's order. An
implementation apart from rpc's, for what a scene must do."""
import itertools
import math

from plane import GAUSS, shapes
from scene import difference, dot

MSH_TYPES = {"P1": (2, 4), "Q1": (3, 5), "P2": (9, 11), "Q2": (10, 12)}  # of facets and cells
SIDES = [("left", "right"), ("bottom", "top"), ("back", "front")]  # by direction, the lower end first
HEXAHEDRON = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
# Nodes of order 2 by the corners that they are the middle of, in gmsh's order.
MIDDLES = {
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
    "tetrahedron": [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)],
    "hexahedron": [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7), (0, 3, 2, 1), (0, 1, 5, 4),
                   (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7), tuple(range(8))],
}


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def with_middles(kind, order, corners):
    """Lattice places of all nodes of an entity, in gmsh's order, from those of its corners."""
    if order == 1:
        return corners
    return corners + [tuple(sum(corners[c][d] for c in group) // len(group) for d in range(3)) for group in MIDDLES[kind]]


def tensor_slopes(order, reference, at):
    """(value, derivative in each direction) of the shape functions of nodes at places of [-1, 1]^d."""
    rows = [shapes(order, t) for t in at]
    column = lambda c: round((c + 1) * order / 2)
    result = []
    for place in reference:
        factor = [(values[column(c)], slopes[column(c)]) for c, (values, slopes) in zip(place, rows)]
        result.append((math.prod(v for v, _ in factor),
                       [math.prod(factor[e][1 if e == d else 0] for e in range(len(at))) for d in range(len(at))]))
    return result


def simplex_slopes(order, middles, at):
    """The same on the simplex with a corner at 0 and one at 1 on each axis; middles: the corners beside each node of order 2."""
    l = [1 - sum(at)] + list(at)
    dim = len(at)
    dl = [[-1.0] * dim] + [[float(d == e) for e in range(dim)] for d in range(dim)]
    if order == 1:
        return list(zip(l, dl))
    corners = [(a * (2 * a - 1), [(4 * a - 1) * d for d in da]) for a, da in zip(l, dl)]
    return corners + [(4 * l[a] * l[b], [4 * (l[a] * db + l[b] * da) for da, db in zip(dl[a], dl[b])]) for a, b in middles]


def orbit(a, b, weight):
    """Of a triangle's rule: all points with these two barycentric coordinates and the one that is left."""
    return [((p, q), weight) for p, q, _ in set(itertools.permutations((a, b, 1 - a - b)))]


# Dunavant (1985): degrees 4 and 6; weights add up to 1/2.
TRIANGLE = {1: orbit(0.445948490915965, 0.445948490915965, 0.223381589678011 / 2) + orbit(0.091576213509771, 0.091576213509771, 0.109951743655322 / 2),
            2: orbit(0.063089014491502, 0.063089014491502, 0.050844906370207 / 2) + orbit(0.249286745170910, 0.249286745170910, 0.116786275726379 / 2)
            + orbit(0.053145049844817, 0.310352451033784, 0.082851075618374 / 2)}
THIRD = {1: [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], 2: [(0.5, 0.0), (0.5, 0.5), (0.0, 0.5)]}  # where the nodes with a third of the area lie
TETRAHEDRON = [((0.25,) * 3, -2 / 15)] + [(p, 3 / 40) for p in [(1 / 6,) * 3, (0.5, 1 / 6, 1 / 6), (1 / 6, 0.5, 1 / 6), (1 / 6, 1 / 6, 0.5)]]  # degree 3


class Bricks:
    """nx x ny x nz cells of an element on a mapped unit cube.

    place(s, t, v): base coordinates, of a right-handed map; keep(i, j, k): whether the cell is there; block(i, j, k): its block; inner
    sides of what is not kept are named `inner`. Other sides: bottom (t = 0), top, left (s = 0), right, back (v = 0), front, with a
    prefix. Tetrahedra: six to a cell around the diagonal from the corner `flip`.
    """

    dim = 3

    def __init__(self, number, element, place, keep=None, block=None, prefix="", distort=None, flip=(0, 0, 0)):
        self.number, self.element, self.prefix = tuple(number), element, prefix
        self.order, self.simplex = int(element[1]), element[0] == "P"
        self.keep = keep or (lambda *cell: True)
        self.block = block or (lambda *cell: "body")
        self.counts = [self.order * n + 1 for n in self.number]
        size = [c - 1 for c in self.counts]
        self.nodes = [tuple(map(float, place(i / size[0], j / size[1], k / size[2])))
                      for k in range(self.counts[2]) for j in range(self.counts[1]) for i in range(self.counts[0])]
        if distort:
            self._distort(distort)
        self.flip = flip
        self.sides = self._sides()

    def node(self, place):
        return (place[2] * self.counts[1] + place[1]) * self.counts[0] + place[0]

    def _distort(self, shift):
        """Moves vertices inside by shift(i, j, k); what lies between vertices follows linearly."""
        p = self.order
        for cell in itertools.product(*(range(1, n) for n in self.number)):
            k = self.node([p * c for c in cell])
            self.nodes[k] = tuple(a + b for a, b in zip(self.nodes[k], shift(*cell)))
        if p == 1:
            return
        for place in itertools.product(*(range(c) for c in self.counts)):
            if any(c % 2 for c in place):
                around = list(itertools.product(*({c - c % 2, c + c % 2} for c in place)))
                self.nodes[self.node(place)] = tuple(sum(self.nodes[self.node(a)][d] for a in around) / len(around) for d in range(3))

    def middles(self):
        """(node, those of both ends) of the edges of tetrahedra of order 2."""
        for cell in self.cells():
            for corners in self._parts(cell):
                nodes = [self.node(place) for place in with_middles("tetrahedron", 2, corners)]
                for node, (a, b) in zip(nodes[4:], MIDDLES["tetrahedron"]):
                    yield node, nodes[a], nodes[b]

    def cells(self):
        return [c for c in itertools.product(*(range(n) for n in self.number)) if self.keep(*c)]

    def _corners(self, cell):
        """Lattice places of the corners of a cell of the grid, by their place in the unit cube."""
        return {c: tuple(self.order * (a + b) for a, b in zip(cell, c)) for c in HEXAHEDRON}

    def _parts(self, cell):
        """Corners of the elements that a cell of the grid consists of."""
        at = self._corners(cell)
        if not self.simplex:
            return [[at[c] for c in HEXAHEDRON]]
        tetrahedra = []
        for axes in itertools.permutations(range(3)):
            path = [(0, 0, 0)]
            for axis in axes:
                path.append(tuple(c + (d == axis) for d, c in enumerate(path[-1])))
            path = [tuple(c ^ f for c, f in zip(corner, self.flip)) for corner in path]
            sides = [difference(corner, path[0]) for corner in path[1:]]
            if dot(cross(sides[0], sides[1]), sides[2]) < 0:
                path[2], path[3] = path[3], path[2]
            tetrahedra.append([at[c] for c in path])
        return tetrahedra

    def _sides(self):
        """{side: [(corners of a facet, corners of its cell)]}"""
        kept, sides = set(self.cells()), {}
        for cell in sorted(kept):
            for axis, end in itertools.product(range(3), (0, 1)):
                neighbour = tuple(c + (2 * end - 1) * (d == axis) for d, c in enumerate(cell))
                if neighbour in kept:
                    continue
                outer = not 0 <= neighbour[axis] < self.number[axis]
                facets = sides.setdefault(self.prefix + (SIDES[axis][end] if outer else "inner"), [])
                level = self.order * (cell[axis] + end)
                for corners in self._parts(cell):
                    mine = [c for c in corners if c[axis] == level]
                    if len(mine) == (3 if self.simplex else 4):
                        facets.append((mine if self.simplex else self._ring(mine), corners))
        return sides

    @staticmethod
    def _ring(corners):
        """The corners of a quadrilateral, one after the other."""
        first, *rest = corners
        across = max(rest, key=lambda c: math.dist(c, first))
        one, other = (c for c in rest if c != across)
        return [first, one, across, other]

    def _facet_nodes(self, corners):
        kind = "triangle" if self.simplex else "quadrilateral"
        return [self.node(place) for place in with_middles(kind, self.order, corners)]

    def _cell_nodes(self, corners):
        kind = "tetrahedron" if self.simplex else "hexahedron"
        return [self.node(place) for place in with_middles(kind, self.order, corners)]

    def side_nodes(self, side):
        return sorted({k for corners, _ in self.sides.get(side, []) for k in self._facet_nodes(corners)})

    def used_nodes(self):
        return sorted({k for _, nodes in self.elements() for k in nodes})

    def _facet_at(self, nodes, inside, at):
        """(position, outward normal times the area) at a point of the reference facet."""
        if self.simplex:
            slopes = simplex_slopes(self.order, MIDDLES["triangle"], at)
        else:
            corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            middles = [(0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)] if self.order == 2 else []
            slopes = tensor_slopes(self.order, corners + middles, at)
        of = lambda pick: tuple(sum(pick(s) * self.nodes[k][c] for s, k in zip(slopes, nodes)) for c in range(3))
        position = of(lambda s: s[0])
        normal = cross(of(lambda s: s[1][0]), of(lambda s: s[1][1]))
        return position, normal if dot(normal, difference(position, inside)) > 0 else tuple(-n for n in normal)

    def _facets_of(self, side):
        """(nodes, a point inside of its cell)"""
        for corners, cell in self.sides.get(side, []):
            places = [self.nodes[self.node(c)] for c in cell]
            yield self._facet_nodes(corners), [sum(c) / len(places) for c in zip(*places)]

    def contact_nodes(self, side):
        """{node: (weight, unit normal)} of nodal quadrature (2.7), on linear quadrilaterals int N_a; nodes without weight are left out."""
        places = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)]
        if self.simplex:
            rule = [(k + (3 if self.order == 2 else 0), at, 1 / 6) for k, at in enumerate(THIRD[self.order])]
        elif self.order == 1:
            rule = [(a, (s, t), ws * wt * (1 + p * s) * (1 + q * t) / 4) for a, (p, q) in enumerate(places[:4])
                    for s, ws in GAUSS[3] for t, wt in GAUSS[3]]
        else:
            line = [(-1, 1 / 3), (0, 4 / 3), (1, 1 / 3)]
            rule = [(places.index((s, t)), (s, t), ws * wt) for s, ws in line for t, wt in line]
        sums = {}
        for nodes, inside in self._facets_of(side):
            for a, at, omega in rule:
                _, normal = self._facet_at(nodes, inside, at)
                w, n = sums.get(nodes[a], (0.0, (0.0, 0.0, 0.0)))
                sums[nodes[a]] = w + omega * math.hypot(*normal), tuple(u + omega * v for u, v in zip(n, normal))
        return {k: (w, tuple(v / math.hypot(*n) for v in n)) for k, (w, n) in sums.items()}

    def side_points(self, side):
        """((x, y, z), weight) of rpc's rule for loads on a side."""
        gauss = GAUSS[self.order + 2]
        rule = TRIANGLE[self.order] if self.simplex else [((s, t), ws * wt) for s, ws in gauss for t, wt in gauss]
        for nodes, inside in self._facets_of(side):
            for at, omega in rule:
                position, normal = self._facet_at(nodes, inside, at)
                yield position, omega * math.hypot(*normal)

    def body_points(self):
        """((x, y, z), weight), exact for uniform forces on cells of any shape."""
        if self.simplex:
            table = [(simplex_slopes(self.order, MIDDLES["tetrahedron"], at), omega) for at, omega in TETRAHEDRON]
        else:
            corners = [tuple(2 * c - 1 for c in corner) for corner in HEXAHEDRON]
            reference = with_middles("hexahedron", self.order, corners)
            table = [(tensor_slopes(self.order, reference, (a, b, c)), u * v * w) for (a, u), (b, v), (c, w) in itertools.product(GAUSS[3], repeat=3)]
        for _, nodes in self.elements():
            for slopes, omega in table:
                of = lambda pick: tuple(sum(pick(s) * self.nodes[k][c] for s, k in zip(slopes, nodes)) for c in range(3))
                columns = [of(lambda s, d=d: s[1][d]) for d in range(3)]
                yield of(lambda s: s[0]), omega * dot(cross(columns[0], columns[1]), columns[2])

    def elements(self):
        """(block, nodes in gmsh's order)"""
        for cell in self.cells():
            for corners in self._parts(cell):
                yield self.block(*cell), self._cell_nodes(corners)

    def facets(self):
        """(side, nodes in gmsh's order), turned either way: rpc must find out which way is outward."""
        for side, facets in sorted(self.sides.items()):
            for corners, _ in facets:
                yield side, self._facet_nodes(corners)

    def msh_types(self):
        """gmsh's numbers of facets and cells."""
        return MSH_TYPES[self.element]

    def smallest_cell(self):
        """Shortest distance of two vertices of a cell that share an edge."""
        edges = set()
        for cell in self.cells():
            for corners in self._parts(cell):
                if self.simplex:
                    edges.update(itertools.combinations(corners, 2))
                else:
                    edges.update((corners[a], corners[b]) for a, b in MIDDLES["hexahedron"][:12])
        return min(math.dist(self.nodes[self.node(a)], self.nodes[self.node(b)]) for a, b in edges)

# SPDX-License-Identifier: BSD-3-Clause
"""Plane and axisymmetric bodies from mapped grids: their sides, contact nodes and loads as doc/theory.md (2.1), (2.7), (2.7a) has them, and
the .msh file of bodies of any dimension. An implementation apart from rpc's, for what a scene must do."""
import math

GAUSS = {
    3: [(-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9)],
    4: [(s * math.sqrt(3 / 7 + t * 2 / 7 * math.sqrt(6 / 5)), (18 - t * math.sqrt(30)) / 36) for s in (-1, 1) for t in (-1, 1)],
}
MSH_TYPE = {"P1": 2, "Q1": 3, "P2": 9, "Q2": 10}
MSH_EDGE = {1: 1, 2: 8}


def shapes(order, t):
    """Values and derivatives of an edge's shape functions at t in [-1, 1], nodes in the order of the edge."""
    if order == 1:
        return [(1 - t) / 2, (1 + t) / 2], [-0.5, 0.5]
    return [t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2], [t - 0.5, -2 * t, t + 0.5]


class Grid:
    """nx x ny cells of an element on a mapped unit square.

    place(s, t): base coordinates; keep(i, j): whether the cell is there; block(i, j): its block; inner sides of what is not
    kept are named `inner`. Other sides: bottom (t = 0), right, top, left, with a prefix. Edges run with the body on the left.
    An axisymmetric body has x >= 0 as its radius; its weights carry 2 pi x.
    """

    dim = 2

    def __init__(self, nx, ny, element, place, keep=None, block=None, prefix="", distort=None, diagonals=None, axisymmetric=False):
        self.nx, self.ny, self.element, self.prefix = nx, ny, element, prefix
        self.order = int(element[1])
        self.keep = keep or (lambda i, j: True)
        self.block = block or (lambda i, j: "body")
        self.diagonals = diagonals or (lambda i, j: False)
        self.axisymmetric = axisymmetric
        p = self.order
        self.columns, self.rows = p * nx + 1, p * ny + 1
        self.nodes = [place(i / (p * nx), j / (p * ny)) for j in range(self.rows) for i in range(self.columns)]
        if distort:
            self._distort(distort)
        self.sides = self._sides()

    def node(self, i, j):
        return j * self.columns + i

    def _distort(self, shift):
        """Moves vertices inside by shift(i, j); what lies between vertices follows linearly."""
        p = self.order
        for j in range(1, self.ny):
            for i in range(1, self.nx):
                k, (dx, dy) = self.node(p * i, p * j), shift(i, j)
                self.nodes[k] = (self.nodes[k][0] + dx, self.nodes[k][1] + dy)
        if p == 1:
            return
        mean = lambda ks: tuple(sum(self.nodes[k][c] for k in ks) / len(ks) for c in (0, 1))
        for j in range(self.rows):
            for i in range(self.columns):
                if i % 2 or j % 2:
                    self.nodes[self.node(i, j)] = mean([self.node(a, b) for a in (i - i % 2, i + i % 2) for b in (j - j % 2, j + j % 2)])

    def cells(self):
        return [(i, j) for j in range(self.ny) for i in range(self.nx) if self.keep(i, j)]

    def _sides(self):
        p, kept, sides = self.order, set(self.cells()), {}
        for i, j in sorted(kept):
            a, b = p * i, p * j
            edges = [("bottom", (i, j - 1), j == 0, [(a + k, b) for k in range(p + 1)]),
                     ("right", (i + 1, j), i == self.nx - 1, [(a + p, b + k) for k in range(p + 1)]),
                     ("top", (i, j + 1), j == self.ny - 1, [(a + p - k, b + p) for k in range(p + 1)]),
                     ("left", (i - 1, j), i == 0, [(a, b + p - k) for k in range(p + 1)])]
            for name, neighbour, outer, places in edges:
                if neighbour not in kept:
                    side = self.prefix + (name if outer else "inner")
                    sides.setdefault(side, []).append([self.node(*place) for place in places])
        return sides

    def side_nodes(self, side):
        return sorted({k for edge in self.sides.get(side, []) for k in edge})

    def used_nodes(self):
        p = self.order
        return sorted({self.node(p * i + a, p * j + b) for i, j in self.cells() for a in range(p + 1) for b in range(p + 1)})

    def around(self, x):
        """How much longer a point's circle is than it counts in the plane."""
        return 2 * math.pi * x if self.axisymmetric else 1.0

    def contact_nodes(self, side):
        """{node: (weight, unit normal)} of nodal quadrature (2.7), (2.7a); nodes without weight are left out."""
        sums = {}
        for edge in self.sides.get(side, []):
            for k, omega, t in self._nodal_rule(edge):
                dx, dy = self._tangent(edge, t)
                w, nx, ny = sums.get(k, (0.0, 0.0, 0.0))
                sums[k] = (w + omega * math.hypot(dx, dy), nx + omega * dy, ny - omega * dx)
        return {k: (w, (nx / math.hypot(nx, ny), ny / math.hypot(nx, ny))) for k, (w, nx, ny) in sums.items() if w > 0}

    def _nodal_rule(self, edge):
        """(node, weight, place on the edge)"""
        xs = [self.around(self.nodes[k][0]) for k in edge]
        if self.order == 1:  # the mean over the edge of N_a 2 pi x, twice
            return [(k, (2 * mine + other) / 3, 0.0) for k, mine, other in zip(edge, xs, xs[::-1])]
        return [(k, omega * x, t) for k, x, (t, omega) in zip(edge, xs, [(-1, 1 / 3), (0, 4 / 3), (1, 1 / 3)])]

    def _tangent(self, edge, t):
        dn = shapes(self.order, t)[1]
        return tuple(sum(d * self.nodes[k][c] for d, k in zip(dn, edge)) for c in (0, 1))

    def side_points(self, side):
        """((x, y), weight) of rpc's rule for loads on a side."""
        for edge in self.sides.get(side, []):
            for t, omega in GAUSS[self.order + 2]:
                n = shapes(self.order, t)[0]
                x, y = (sum(a * self.nodes[k][c] for a, k in zip(n, edge)) for c in (0, 1))
                yield (x, y), omega * math.hypot(*self._tangent(edge, t)) * self.around(x)

    def body_points(self):
        """((x, y), weight) of Simpson's rule over each bilinear cell's corners, middles and centre: exact for uniform forces on
        straight cells."""
        p = self.order
        rule = [(-1, 1 / 3), (0, 4 / 3), (1, 1 / 3)]
        for i, j in self.cells():
            corner = [self.nodes[self.node(p * i + a, p * j + b)] for b in (0, p) for a in (0, p)]
            for s, ws in rule:
                for t, wt in rule:
                    n = [(1 + a * s) * (1 + b * t) / 4 for b in (-1, 1) for a in (-1, 1)]
                    ds = [a * (1 + b * t) / 4 for b in (-1, 1) for a in (-1, 1)]
                    dt = [b * (1 + a * s) / 4 for b in (-1, 1) for a in (-1, 1)]
                    dot = lambda f, c: sum(v * x[c] for v, x in zip(f, corner))
                    det = dot(ds, 0) * dot(dt, 1) - dot(ds, 1) * dot(dt, 0)
                    yield (dot(n, 0), dot(n, 1)), ws * wt * det * self.around(dot(n, 0))

    def elements(self):
        """(block, nodes in gmsh's order)"""
        p = self.order
        for i, j in self.cells():
            at = lambda a, b: self.node(p * i + a, p * j + b)
            corners = [at(0, 0), at(p, 0), at(p, p), at(0, p)]
            if self.element[0] == "Q":
                middles = [at(1, 0), at(2, 1), at(1, 2), at(0, 1), at(1, 1)] if p == 2 else []
                yield self.block(i, j), corners + middles
                continue
            triangles = [(0, 1, 3), (1, 2, 3)] if self.diagonals(i, j) else [(0, 1, 2), (0, 2, 3)]
            for triangle in triangles:
                middles = []
                if p == 2:
                    place = {corners[0]: (0, 0), corners[1]: (2, 0), corners[2]: (2, 2), corners[3]: (0, 2)}
                    ring = [corners[c] for c in triangle]
                    for a, b in zip(ring, ring[1:] + ring[:1]):
                        middles.append(at((place[a][0] + place[b][0]) // 2, (place[a][1] + place[b][1]) // 2))
                yield self.block(i, j), [corners[c] for c in triangle] + middles

    def smallest_cell(self):
        """Shortest distance of two vertices of a cell that share an edge."""
        return min(math.dist(self.nodes[nodes[a]], self.nodes[nodes[a - 1]])
                   for _, nodes in self.elements() for a in range(3 if self.element[0] == "P" else 4))

    def facets(self):
        """(side, nodes in gmsh's order)"""
        for side, edges in sorted(self.sides.items()):
            for edge in edges:
                yield side, [edge[0], edge[-1]] + edge[1:-1]

    def msh_types(self):
        """gmsh's numbers of facets and cells."""
        return MSH_EDGE[self.order], MSH_TYPE[self.element]


class Body:
    """Grids that share no node; each is a part of the body. Sides of one name belong together."""

    def __init__(self, *grids):
        self.parts = list(grids)

    def num_nodes(self):
        return sum(len(grid.used_nodes()) for grid in self.parts)

    def smallest_cell(self):
        return min(grid.smallest_cell() for grid in self.parts)

    def sides(self):
        return sorted({side for grid in self.parts for side in grid.sides})

    def msh(self, length):
        """gmsh's format 2.2, coordinates times length."""
        blocks = sorted({block for grid in self.parts for block, _ in grid.elements()})
        sides = self.sides()
        dim = self.parts[0].dim
        facet_type, cell_type = self.parts[0].msh_types()
        tag, nodes, elements = {}, [], []
        for g, grid in enumerate(self.parts):
            for k in grid.used_nodes():
                tag[g, k] = len(nodes) + 1
                nodes.append(grid.nodes[k])
        for g, grid in enumerate(self.parts):
            for side, facet in grid.facets():
                elements.append((facet_type, sides.index(side) + 1, [tag[g, k] for k in facet]))
            for block, cell in grid.elements():
                elements.append((cell_type, len(sides) + blocks.index(block) + 1, [tag[g, k] for k in cell]))
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(sides) + len(blocks))]
        lines += [f'{dim - 1} {n + 1} "{name}"' for n, name in enumerate(sides)]
        lines += [f'{dim} {len(sides) + n + 1} "{name}"' for n, name in enumerate(blocks)]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
        lines += [" ".join([str(n + 1)] + [repr(x * length) for x in node] + ["0"] * (3 - dim)) for n, node in enumerate(nodes)]
        lines += ["$EndNodes", "$Elements", str(len(elements))]
        lines += [" ".join(map(str, [n + 1, kind, 2, group, group] + nodes)) for n, (kind, group, nodes) in enumerate(elements)]
        return "\n".join(lines + ["$EndElements", ""])

# SPDX-License-Identifier: BSD-3-Clause
"""Cells of rpc's Exodus files: their faces, how they are divided for drawing. Node orders as Exodus has them."""
import numpy as np

TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]
SQUARE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
TETRA_EDGES = [*TRIANGLE_EDGES, (0, 3), (1, 3), (2, 3)]
HEX_EDGES = [*SQUARE_EDGES, (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
TETRA_FACES = [(0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)]
HEX_FACES = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)]
HEX_FACE_CENTRES = [25, 24, 26, 23, 21, 22]  # of HEX27; its node 20 is the centre of the cell


def quadratic_faces(faces, edges, first_edge, centres):
    """Faces with their mid-edge nodes and, for quadrilaterals, their centre."""
    place = {frozenset(edge): first_edge + n for n, edge in enumerate(edges)}
    result = []
    for n, face in enumerate(faces):
        around = [place[frozenset((a, b))] for a, b in zip(face, face[1:] + face[:1])]
        result.append((*face, *around, *centres[n : n + 1]))
    return result


# Faces of each cell and their kind; a plane cell is its own face.
CELLS = {
    "TRI3": ("TRI3", [tuple(range(3))]),
    "TRI6": ("TRI6", [tuple(range(6))]),
    "QUAD4": ("QUAD4", [tuple(range(4))]),
    "QUAD9": ("QUAD9", [tuple(range(9))]),
    "TETRA4": ("TRI3", TETRA_FACES),
    "TETRA10": ("TRI6", quadratic_faces(TETRA_FACES, TETRA_EDGES, 4, [])),
    "HEX8": ("QUAD4", HEX_FACES),
    "HEX27": ("QUAD9", quadratic_faces(HEX_FACES, HEX_EDGES, 8, HEX_FACE_CENTRES)),
}
VERTICES = {"TRI3": 3, "TRI6": 3, "QUAD4": 4, "QUAD9": 4}
QUADRATIC = ("TRI6", "QUAD9")


def is_triangle(kind):
    """Whether faces of this kind have three vertices."""
    return VERTICES[kind] == 3


def face_edges(kind):
    """Node places (edges, 2 or 3) of a face's edges: ends, then the middle."""
    edges = TRIANGLE_EDGES if is_triangle(kind) else SQUARE_EDGES
    if kind not in QUADRATIC:
        return np.array(edges)
    return np.array([(*edge, len(edges) + n) for n, edge in enumerate(edges)])


def shape_1d(x, quadratic):
    """(points, nodes) of an edge, x in [0, 1]; nodes: ends, middle."""
    if quadratic:
        return np.stack([(1 - x) * (1 - 2 * x), x * (2 * x - 1), 4 * x * (1 - x)], axis=1)
    return np.stack([1 - x, x], axis=1)


def hat_1d(x, quadratic):
    """Linear from node to node, (points, nodes) of an edge."""
    if quadratic:
        return np.stack([np.maximum(1 - 2 * x, 0), np.maximum(2 * x - 1, 0), 1 - abs(1 - 2 * x)], axis=1)
    return shape_1d(x, False)


def tensor(x, y):
    """Products of functions of an edge, in the order of a quadrilateral's nodes."""
    places = [(0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (1, 2), (2, 1), (0, 2), (2, 2)][: x.shape[1] ** 2]
    return np.stack([x[:, i] * y[:, j] for i, j in places], axis=1)


def shape(kind, points):
    """Shape functions (points, nodes) at reference points (points, 2): where a point of the face lies."""
    x, y = points.T
    if not is_triangle(kind):
        return tensor(*(shape_1d(c, kind in QUADRATIC) for c in (x, y)))
    a, b, c = 1 - x - y, x, y
    if kind in QUADRATIC:
        return np.stack([a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a], axis=1)
    return np.stack([a, b, c], axis=1)


def hats(kind, points):
    """Like shape, but linear (bilinear) from node to node: for fields, which then do not overshoot."""
    x, y = points.T
    if not is_triangle(kind):
        return tensor(*(hat_1d(c, kind in QUADRATIC) for c in (x, y)))
    if kind not in QUADRATIC:
        return shape(kind, points)
    a, b, c = 1 - x - y, x, y
    corners = [np.maximum(2 * s - 1, 0) for s in (a, b, c)]
    inside = np.max([a, b, c], axis=0) <= 0.5
    # In a corner's triangle the two middles beside it share the rest; in the middle triangle each middle faces one corner.
    middles = []
    for s, t, opposite in ((a, b, c), (b, c, a), (c, a, b)):
        beside = np.where(s > 0.5, 2 * t, np.where(t > 0.5, 2 * s, 0))
        middles.append(np.where(inside, 1 - 2 * opposite, beside))
    return np.stack(corners + middles, axis=1)


def division(kind, n):
    """Reference points (points, 2) and triangles (n^2 or 2 n^2, 3) of a face, n pieces to an edge."""
    rows = np.arange(n + 1)
    if is_triangle(kind):
        grid = [(i, j) for j in rows for i in rows[: n + 1 - j]]
    else:
        grid = [(i, j) for j in rows for i in rows]
    number = {place: k for k, place in enumerate(grid)}
    triangles = []
    for i, j in grid:
        for corners in (((i, j), (i + 1, j), (i, j + 1)), ((i + 1, j), (i + 1, j + 1), (i, j + 1))):
            if all(corner in number for corner in corners):
                triangles.append([number[corner] for corner in corners])
    return np.array(grid, dtype=float) / n, np.array(triangles)


def hex_tetrahedra(place):
    """Six tetrahedra of a hexahedron whose vertices are place(i, j, k), i, j, k in {0, 1}."""
    paths = [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
    result = []
    for path in paths:
        corner, corners = [0, 0, 0], [place(0, 0, 0)]
        for axis in path:
            corner[axis] = 1
            corners.append(place(*corner))
        result.append(corners)
    return result


def tetrahedra(name):
    """Tetrahedra between the nodes of a cell in space, (tetrahedra, 4)."""
    if name == "TETRA4":
        return np.array([(0, 1, 2, 3)])
    if name == "TETRA10":
        return np.array([(0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3),
                         (4, 5, 6, 8), (4, 6, 7, 8), (5, 9, 6, 8), (6, 9, 7, 8)])
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
    if name == "HEX8":
        number = {tuple(corner): k for k, corner in enumerate(corners)}
        return np.array(hex_tetrahedra(lambda i, j, k: number[i, j, k]))
    lattice = [tuple(2 * corner) for corner in corners]
    lattice += [tuple(corners[list(edge)].sum(axis=0)) for edge in HEX_EDGES] + [(1, 1, 1)]
    lattice += [(1, 1, 0), (1, 1, 2), (0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1)]
    number = {place: k for k, place in enumerate(lattice)}
    octants = [corner for corner in corners]
    return np.array([tetra for o in octants
                     for tetra in hex_tetrahedra(lambda i, j, k, o=o: number[o[0] + i, o[1] + j, o[2] + k])])

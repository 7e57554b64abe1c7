# SPDX-License-Identifier: BSD-3-Clause
"""Faces of a mesh as triangles to draw: boundary, contact side, foundation, cuts.

Faces come as arrays of node numbers (faces, nodes per face) of one kind, see elements. A vertex of a triangle is a row: its place,
the normal there, the value of the field, and a level for each plane that cuts (see Cut).
"""
import dataclasses

import numpy as np

import elements

PLACE, NORMAL, VALUE, LEVELS = slice(0, 3), slice(3, 6), 6, 7
EDGES = "EDGES"
MOST_TRIANGLES = 1_000_000


@dataclasses.dataclass
class Faces:
    """Faces of one kind, or in the plane EDGES of cells.

    `cell` is the number, in the file, of the cell that a face belongs to, `place` the face's number in it.
    """

    kind: str
    nodes: np.ndarray  # (faces, nodes per face)
    cell: np.ndarray  # (faces,)
    place: np.ndarray  # (faces,)

    def part(self, chosen):
        """The faces chosen by a mask or by numbers."""
        return Faces(self.kind, self.nodes[chosen], self.cell[chosen], self.place[chosen])

    def edges(self):
        """Nodes (edges of all faces, 2 or 3): ends, then the middle. An edge is its own."""
        if self.kind == EDGES:
            return self.nodes
        return np.concatenate([self.nodes[:, edge] for edge in elements.face_edges(self.kind)])


def visible_faces(result):
    """In the plane the cells, in space the faces that belong to one cell only; [Faces], one a block."""
    blocks, start = [], 0
    for name, cells in result.blocks:
        kind, faces = elements.CELLS[name]
        nodes = np.concatenate([cells[:, face] for face in faces])
        cell = np.tile(np.arange(start, start + len(cells)), len(faces))
        blocks.append(Faces(kind, nodes, cell, np.repeat(np.arange(len(faces)), len(cells))))
        start += len(cells)
    if result.dim == 2 or not blocks:
        return blocks
    counts = occurrences(np.concatenate([corners(faces) for faces in blocks]))
    ends = np.cumsum([len(faces.nodes) for faces in blocks])
    return [faces.part(counts[end - len(faces.nodes) : end] == 1) for faces, end in zip(blocks, ends)]


def boundary_edges(faces):
    """The edges of cells in the plane that belong to one cell only; [Faces], one a block."""
    edges, number = [], [len(elements.face_edges(face.kind)) for face in faces]
    for face, n in zip(faces, number):
        edges.append(Faces(EDGES, face.edges(), np.tile(face.cell, n), np.repeat(np.arange(n), len(face.cell))))
    counts = occurrences(np.concatenate([np.sort(edge.nodes[:, :2], axis=1) for edge in edges]))
    ends = np.cumsum([len(edge.nodes) for edge in edges])
    return [edge.part(counts[end - len(edge.nodes) : end] == 1) for edge, end in zip(edges, ends)]


def outward(faces, places):
    """(faces, 3) normal out of the body, as long as the face is large; in the plane that of edges."""
    if faces.kind == EDGES:
        along = places[faces.nodes[:, 1]] - places[faces.nodes[:, 0]]
        return np.stack([along[:, 1], -along[:, 0], 0 * along[:, 0]], axis=1)
    vertices = places[faces.nodes[:, : elements.VERTICES[faces.kind]]]
    if elements.is_triangle(faces.kind):
        return 0.5 * np.cross(vertices[:, 1] - vertices[:, 0], vertices[:, 2] - vertices[:, 0])
    return 0.5 * np.cross(vertices[:, 2] - vertices[:, 0], vertices[:, 3] - vertices[:, 1])


def corners(faces):
    """Vertices (faces, 4), sorted; -1 in front of a triangle's three."""
    vertices = np.sort(faces.nodes[:, : elements.VERTICES[faces.kind]], axis=1)
    return np.pad(vertices, ((0, 0), (4 - vertices.shape[1], 0)), constant_values=-1)


def occurrences(rows):
    """(n,) how often each row occurs."""
    order = np.lexsort(rows.T)
    first = np.ones(len(rows), dtype=bool)
    first[1:] = (rows[order][1:] != rows[order][:-1]).any(axis=1)
    group = np.cumsum(first) - 1
    counts = np.empty(len(rows), dtype=np.int64)
    counts[order] = np.bincount(group)[group]
    return counts


def all_edges(faces):
    """Edges (n, 2 or 3 nodes), shared ones twice."""
    return np.concatenate([face.edges() for face in faces])


def outline(faces):
    """Edges that belong to one of the faces only."""
    edges = all_edges(faces)
    return edges[occurrences(np.sort(edges[:, :2], axis=1)) == 1]


def distinct(edges):
    """Each edge once."""
    return edges[np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_index=True)[1]]


def sharp(faces, places):
    """Edges where faces meet at more than 40 degrees."""
    edges, normals = [], []
    for face in faces:
        vertices = places[face.nodes[:, : elements.VERTICES[face.kind]]]
        normal = unit(np.cross(vertices[:, 1] - vertices[:, 0], vertices[:, -1] - vertices[:, 0]))
        edges.append(face.edges())
        normals.append(np.tile(normal, (vertices.shape[1], 1)))
    edges, normals = np.concatenate(edges), np.concatenate(normals)
    ends = np.sort(edges[:, :2], axis=1)
    order = np.lexsort(ends.T)
    same = (ends[order][1:] == ends[order][:-1]).all(axis=1)
    first, second = order[:-1][same], order[1:][same]
    return edges[first[(normals[first] * normals[second]).sum(axis=1) < np.cos(np.radians(40))]]


def on_contact_side(faces, contact):
    """(faces,) whether all nodes of a face are contact nodes; of quadratic triangles the middles of their edges count."""
    nodes = faces.nodes[:, 3:] if faces.kind == "TRI6" else faces.nodes
    return contact[nodes].all(axis=1)


def completed(values, contact, faces, category=False):
    """Contact values (nodes, ...) with, at nodes of contact faces that are no contact nodes, the mean of their neighbours; of a category
    one of theirs."""
    values = values.copy()
    total, count = np.zeros_like(values), np.zeros(len(values))
    for face in faces:
        for edge in elements.face_edges(face.kind):
            middles = face.nodes[:, edge[-1]]
            for end in edge[:2]:
                if category:
                    total[face.nodes[:, end]], count[face.nodes[:, end]] = values[middles], 1
                    continue
                np.add.at(total, face.nodes[:, end], values[middles])
                np.add.at(count, face.nodes[:, end], 1)
    missing = ~contact & (count > 0)
    values[missing] = (total[missing].T / count[missing]).T
    return values


def pieces(faces, category=False):
    """Into how many pieces edges are divided: curved faces and those of categories into more, a great number of faces into fewer."""
    wanted = 8 if category else 4 if faces.kind in elements.QUADRATIC else 1 if elements.is_triangle(faces.kind) else 2
    least = 2 if faces.kind in elements.QUADRATIC else 1
    while wanted > least and 2 * wanted**2 * len(faces.nodes) > MOST_TRIANGLES:
        wanted //= 2
    return wanted


def triangles(faces, places, levels, values, category=False):
    """Divides faces: (triangles, 3, 7 + planes).

    @param places    (nodes, 3) where the nodes are drawn
    @param levels    (nodes, planes)
    @param values    (faces, nodes per face) of the field
    @param category  whether each triangle has the value of the node next to it: there is nothing between categories
    """
    points, corner = elements.division(faces.kind, pieces(faces, category))
    shape = elements.shape(faces.kind, points)
    at_nodes = places[faces.nodes]
    rows = np.empty((len(faces.nodes), len(points), LEVELS + levels.shape[1]))
    rows[..., PLACE] = shape @ at_nodes
    tangents = []
    for step in ((1e-3, 0), (0, 1e-3)):  # shape functions are at most quadratic: these differences are exact
        rise = elements.shape(faces.kind, points + step) - elements.shape(faces.kind, points - np.array(step))
        tangents.append(rise @ at_nodes)
    rows[..., NORMAL] = unit(np.cross(*tangents))
    rows[..., LEVELS:] = shape @ levels[faces.nodes]
    rows[..., VALUE] = values @ elements.hats(faces.kind, points).T
    rows = rows[:, corner]
    if category:
        rows[..., VALUE] = values[:, elements.hats(faces.kind, points[corner].mean(axis=1)).argmax(axis=1), None]
    return rows.reshape(-1, 3, rows.shape[3])


def unit(vectors):
    """Vectors of length 1; zero stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)


def lines(edges, values, n=8):
    """Values (nodes, ...), such as places, at n + 1 points of edges (edges, 2 or 3 nodes): (edges, n + 1, ...)."""
    shape = elements.shape_1d(np.linspace(0, 1, n + 1 if edges.shape[1] == 3 else 2), edges.shape[1] == 3)
    return np.einsum("pk,ek...->ep...", shape, values[edges])


def segments(edges, places, levels):
    """Pieces (k, 2, 7 + planes) of edges, without normals and values."""
    points, level = lines(edges, places), lines(edges, levels)
    rows = np.zeros((*level.shape[:2], LEVELS + level.shape[2]))
    rows[..., PLACE], rows[..., LEVELS:] = points, level
    return np.stack([rows[:, :-1], rows[:, 1:]], axis=2).reshape(-1, 2, rows.shape[2])


def band(edges, places, directions, heights, values, category=False):
    """Between edges in the plane and what lies `heights` (nodes,) from them in `directions` (nodes, 3): triangles (n, 3, 7).

    Heights and values are linear from node to node; of a category each piece has the value of the node next to it.
    """
    x = np.linspace(0, 1, 9)
    shape, hats = (f(x, edges.shape[1] == 3) for f in (elements.shape_1d, elements.hat_1d))
    rows = np.zeros((len(edges), 2, len(x), LEVELS))
    rows[:, 0, :, PLACE] = shape @ places[edges]
    rows[:, 1, :, PLACE] = rows[:, 0, :, PLACE] + (hats @ heights[edges].T).T[..., None] * (shape @ directions[edges])
    rows[..., VALUE] = (hats @ values[edges].T).T[:, None]
    a, b, c, d = rows[:, 0, :-1], rows[:, 0, 1:], rows[:, 1, 1:], rows[:, 1, :-1]
    found = np.stack([np.stack(corner, axis=2) for corner in ((a, b, c), (a, c, d))])  # (2, edges, pieces, 3, 7)
    if category:
        nearest = elements.hat_1d(0.5 * (x[:-1] + x[1:]), edges.shape[1] == 3).argmax(axis=1)
        found[..., VALUE] = values[edges][:, nearest, None]
    return found.reshape(-1, 3, LEVELS)


class Cut:
    """The plane <axis> = <value> of the undeformed body; what lies beyond it, at a level > 0, is not drawn."""

    def __init__(self, axis, value, towards):
        """@param towards  +1 or -1: the side of the axis that is taken away"""
        self.axis, self.value, self.towards = axis, value, towards

    def levels(self, positions):
        """(n,) distances of undeformed positions beyond the plane."""
        return self.towards * (positions[:, self.axis] - self.value)


def box(low, high):
    """The six planes that leave a box of the undeformed body."""
    return [Cut(axis, value, towards) for axis in range(3) for value, towards in ((low[axis], -1), (high[axis], 1))]


def clip(rows, level):
    """The part of triangles (n, 3, m) that a plane leaves, and the lines (k, 2, m) along which they were cut.

    @param level  the plane's place in a row
    """
    inside = rows[..., level] <= 0
    count = inside.sum(axis=1)
    kept, sides = [rows[count == 3]], [np.empty((0, 2, rows.shape[2]))]
    for number in (1, 2):
        some = rows[count == number]
        order = np.argsort(inside[count == number] != (number == 1), axis=1, kind="stable")
        alone, left, right = (np.take_along_axis(some, order[:, k, None, None], axis=1)[:, 0] for k in range(3))
        at_left, at_right = crossing(alone, left, level), crossing(alone, right, level)
        if number == 1:
            kept.append(np.stack([alone, at_left, at_right], axis=1))
        else:
            kept += [np.stack(corner, axis=1) for corner in ((left, right, at_right), (left, at_right, at_left))]
        sides.append(np.stack([at_left, at_right], axis=1))
    return np.concatenate(kept), np.concatenate(sides)


def clip_lines(lines, level):
    """The part of lines (k, 2, m) that a plane leaves."""
    inside = lines[..., level] <= 0
    lines, inside = lines[inside.any(axis=1)], inside[inside.any(axis=1)]
    for end in (0, 1):
        beyond = ~inside[:, end]
        lines[beyond, end] = crossing(lines[beyond, 1 - end], lines[beyond, end], level)
    return lines


def clipped(rows):
    """What all planes leave of triangles, and the lines on it along which they were cut."""
    sides = np.empty((0, 2, rows.shape[2]))
    for level in range(LEVELS, rows.shape[2]):
        rows, added = clip(rows, level)
        sides = np.concatenate([clip_lines(sides, level), added])
    return rows, sides


def section(rows, level):
    """Where a plane crosses tetrahedra (n, 4, m): triangles."""
    inside = rows[..., level] <= 0
    count = inside.sum(axis=1)
    order = np.argsort(~inside, axis=1, kind="stable")
    rows = np.take_along_axis(rows, order[..., None], axis=1)  # those inside come first
    found = []
    for number in (1, 3):
        some = rows[count == number]
        alone, others = (0, (1, 2, 3)) if number == 1 else (3, (0, 1, 2))
        found.append(np.stack([crossing(some[:, alone], some[:, other], level) for other in others], axis=1))
    some = rows[count == 2]
    around = [crossing(some[:, i], some[:, o], level) for i, o in ((0, 2), (0, 3), (1, 3), (1, 2))]
    found += [np.stack([around[k] for k in corner], axis=1) for corner in ((0, 1, 2), (0, 2, 3))]
    found = np.concatenate(found)
    normal = np.cross(found[:, 1, PLACE] - found[:, 0, PLACE], found[:, 2, PLACE] - found[:, 0, PLACE])
    found[..., NORMAL] = unit(normal)[:, None]
    return found


def crossing(a, b, level):
    """Where a level is 0 between rows that have it with different signs."""
    weight = a[:, level] / (a[:, level] - b[:, level])
    found = a + weight[:, None] * (b - a)
    found[:, level] = 0  # what is cut is kept when it is cut again
    return found


def cells_section(result, plane, levels, places, values):
    """The section of a body in space by one of the planes, not yet clipped by the others: triangles (n, 3, 7 + planes).

    @param levels  (nodes, planes)
    @param values  (nodes,), or (cells,) if the field belongs to cells
    """
    found, start = [np.empty((0, 3, LEVELS + levels.shape[1]))], 0
    nodal = len(values) == len(levels)
    for name, cells in result.blocks:
        at_nodes = levels[cells, plane]
        crossed = np.flatnonzero((at_nodes.min(axis=1) <= 0) & (at_nodes.max(axis=1) > 0))
        nodes = cells[crossed][:, elements.tetrahedra(name)]
        rows = np.zeros((*nodes.shape, LEVELS + levels.shape[1]))
        rows[..., PLACE], rows[..., LEVELS:] = places[nodes], levels[nodes]
        rows[..., VALUE] = values[nodes] if nodal else values[start + crossed][:, None, None]
        found.append(section(rows.reshape(-1, 4, rows.shape[3]), LEVELS + plane))
        start += len(cells)
    return np.concatenate(found)


def walls(segments, direction):
    """What segments (k, 2, m) sweep when they move by a vector: triangles (2 k, 3, m)."""
    below = segments.copy()
    below[..., PLACE] += direction
    result = np.concatenate([np.stack([segments[:, 0], segments[:, 1], below[:, 1]], axis=1),
                             np.stack([segments[:, 0], below[:, 1], below[:, 0]], axis=1)])
    along = segments[:, 1, PLACE] - segments[:, 0, PLACE]
    result[..., NORMAL] = unit(np.cross(along, np.broadcast_to(direction, along.shape)))[list(range(len(along))) * 2, None]
    return result

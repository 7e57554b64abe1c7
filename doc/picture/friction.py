# SPDX-License-Identifier: BSD-3-Clause
"""Friction on the contact sides: arrows of its traction, of the body on the foundation, and the zones that stick and slip."""
import numpy as np

import surface
from surface import LEVELS, PLACE, VALUE, unit

ZONES = ("sticks", "slips")
RIBBON = 0.05  # height of the zones in the plane, below the foundation's diagram, of the size of what is drawn of the body
ARROWS = {2: 20, 3: 9}  # at most about so many across the zone with friction, by the dimension of space
LEAST = 0.025  # distance of arrows, of the size of what is drawn of the body
CLOSEST = 0.7  # of that distance
SMALL = 0.02  # of the largest traction: less has no arrow
LIFT = 0.01  # of arrows above the surface in space, of that size
SHAFT, HEAD, HEAD_WIDTH = 0.12, 0.45, 0.4  # width of the shaft, length and width of the head, of the longest arrow


def peak(sides):
    """Largest traction on any of the sides; 0 without friction."""
    return max((np.linalg.norm(side.fields["traction"][side.nodes()], axis=1).max() for side in sides if "traction" in side.fields), default=0.0)


def ribbon(edges, places, directions, height, indicator):
    """Where a zone lies in the plane: triangles (n, 3, 7) of a band along edges, up to half-way to the next node.

    @param indicator  (nodes,) 1 in the zone, 0 elsewhere
    """
    rows = surface.band(edges, places, directions, np.full(len(places), height), indicator)
    return rows[rows[..., VALUE].mean(axis=1) > 0.5]


def border(rows):
    """Lines (k, 2, m) around a zone in space. @param rows  triangles whose values are 1 in the zone, 0 elsewhere"""
    rows = rows.copy()
    rows[..., VALUE] = 0.5 - rows[..., VALUE]
    return surface.clip(rows, VALUE)[1]


def spread(places, distance):
    """Numbers of places (n, 3) about so far from each other: of each cell of a grid between them the one next to its middle, unless
    that is too close to another."""
    low, extent = places.min(axis=0), np.ptp(places, axis=0)
    number = np.maximum(np.ceil(extent / distance - 1e-9), 1)
    size = np.where(extent > 0, extent / number, 1)
    cell = np.minimum(np.floor((places - low) / size), number - 1)
    away = np.linalg.norm(places - low - size * (cell + 0.5 * (extent > 0)), axis=1)
    order = np.argsort((away / distance).round(9), kind="stable")
    order = order[np.sort(np.unique(cell[order], axis=0, return_index=True)[1])]
    kept = np.empty(0, dtype=np.int64)
    for node in order:
        if (np.linalg.norm(places[kept] - places[node], axis=1) >= CLOSEST * distance).all():
            kept = np.append(kept, node)
    return kept


def nearest(places):
    """Least distance between two of the places (n, 3); infinite if there is one only."""
    away = np.linalg.norm(places[:, None] - places[None], axis=2)
    np.fill_diagonal(away, np.inf)
    return away.min(initial=np.inf)


def arrows(places, tractions, normals, size, dim, largest):
    """Triangles (n, 3, 7) of arrows along a side, thinned out such that none covers another.

    @param places     (n, 3) of nodes, where the arrows have their middles
    @param tractions  (n, 3)
    @param normals    (n, 3) across the arrows and the surface that they lie on
    @param size       of what is drawn of the body
    @param largest    traction, whose arrow is the longest
    """
    strong = np.linalg.norm(tractions, axis=1) > SMALL * largest
    places, tractions, normals = places[strong], tractions[strong], normals[strong]
    if not len(places):
        return np.empty((0, 3, LEVELS))
    distance = max(np.ptp(places, axis=0).max() / ARROWS[dim], LEAST * size)
    chosen = spread(places, distance)
    longest = 0.95 * min(distance, nearest(places[chosen]))
    return shapes(places[chosen], tractions[chosen] * longest / largest, normals[chosen], longest)


def shapes(places, vectors, normals, longest):
    """Triangles (3 n, 3, 7): arrows with their middles at places. Shafts have one width; heads of short arrows are shorter."""
    length = np.linalg.norm(vectors, axis=1)
    along, across = unit(vectors), unit(np.cross(normals, vectors))
    head = np.minimum(HEAD * longest, 0.7 * length)
    half_shaft = 0.5 * np.minimum(SHAFT * longest, 0.3 * head)
    half_head = 0.5 * HEAD_WIDTH / HEAD * head

    def corner(forwards, aside):
        return places + forwards[:, None] * along + aside[:, None] * across

    neck = 0.5 * length - head
    a, b, c, d = (corner(*place) for place in ((-0.5 * length, -half_shaft), (neck, -half_shaft), (neck, half_shaft), (-0.5 * length, half_shaft)))
    tip, left, right = corner(0.5 * length, 0 * length), corner(neck, half_head), corner(neck, -half_head)
    rows = np.zeros((3 * len(places), 3, LEVELS))
    rows[..., PLACE] = np.concatenate([np.stack(corners, axis=1) for corners in ((a, b, c), (a, c, d), (right, tip, left))])
    rows[..., surface.NORMAL] = np.tile(normals, (3, 1))[:, None]
    return rows

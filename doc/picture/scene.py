# SPDX-License-Identifier: BSD-3-Clause
"""What a picture shows of a result: triangles with the field, lines, the foundation."""
import dataclasses

import numpy as np

import friction
import sides
import surface
from fields import is_category, is_signed
from result import PictureError, suggestion
from surface import LEVELS, PLACE

CONTACT_FIELDS = sides.FIELDS
THICKNESS = 0.08  # of the foundation as it is drawn, of the size of what is drawn of the body
DIAGRAM = 0.85  # height of the largest value in the plane, of that thickness
BEHIND = -5e-3  # z of the foundation in the plane, of the body's size
APART = 5e-3  # of that size: so far from the enlarged body, or as far as from the true one, the foundation is drawn where they do not touch
MOST, LEAST = 1000, 1e-6  # of the body's size: what can be shown of it
CELL_SIZE = "cell_size"  # a field that no file has: the root of a cell's area, in space the cube root of its volume


@dataclasses.dataclass
class Lines:
    """Lines on the surface, as dark as `opacity`; those that fade do so as they get short."""

    points: np.ndarray  # (lines, points, 3)
    levels: np.ndarray  # (lines, points, planes), see surface.Cut
    layer: str
    opacity: float
    fades: bool = False
    normals: np.ndarray = None  # (lines, 3) of lines that are drawn only where these look away from the viewer
    zone: str = None  # of friction, whose colour they have


class Scene:
    """Triangles (n, 3, 7 + planes) of the layers "body", "contact" (the contact sides; in the plane a diagram along each),
    "foundation", and in space "ground": the foundation's surface, drawn only where it looks away from the viewer. With friction also
    "arrows" of its traction, if contact sides show a field, and in the plane "sticks" and "slips": zones along each side.

    field, body_field, contact_field  what is asked for, what the body shows, what the contact sides show (None: the body's)
    sides                             [sides.Side]
    normal                            mean direction from the body into the foundation, at the side that bears most; 0 without contact
    rest                              in the plane the undeformed outline, (lines, points, 3)
    shear                             largest traction of friction, if it is drawn; else 0
    """

    def __init__(self, result, field=None, scale=None, cut=None, window=None):
        """@param field  None: the contact pressure where there is contact, else the von Mises stress
        @param scale  factor of displacements, not of gaps; None: see automatic_scale
        @param cut    surface.Cut, in space only
        @param window (2, dim) lowest and highest place [m]: in the plane of what is drawn, in space of the undeformed body
        """
        self.result, self.cut = result, cut
        self.contact = result.contact_nodes()
        self.field = ("von_mises" if self.contact is None else "contact_pressure") if field is None else field
        known = [*result.nodal, *result.cell, CELL_SIZE]
        if self.field not in known:
            raise PictureError(f'"{result.path}": --field must be one of {", ".join(known)}, got "{self.field}"{suggestion(self.field, known)}')
        self.contact_field = self.field if self.field in CONTACT_FIELDS else None
        self.body_field = "von_mises" if self.contact_field else self.field
        self.scale = automatic_scale(result) if scale is None else scale
        require_moderate(result, self.scale, window)
        self.places = result.positions + self.scale * result.vector("disp_")
        boxed = window is not None and result.dim == 3
        if boxed:  # no further than the body goes
            window = np.clip(window, result.positions.min(axis=0) - result.size(), result.positions.max(axis=0) + result.size())
            self.size = min(np.ptp(window, axis=0).max(), result.size())
        else:
            self.size = result.size() if window is None else np.ptp(window, axis=0).max()
        self.window = window
        self.cuts = ([cut] if cut else []) + (surface.box(*window) if boxed else [])
        self.levels = np.array([plane.levels(result.positions) for plane in self.cuts]).reshape(-1, len(result.positions)).T
        self.layers, self.lines, self.normal, self.rest = {}, [], np.zeros(3), None
        self._add_all(surface.visible_faces(result))

    def _add_all(self, faces):
        flat = self.result.dim == 2
        self.sides = sides.contact_sides(self.result, surface.boundary_edges(faces) if flat else faces)
        if self.sides:
            self.normal = max(self.sides, key=lambda side: side.force(self.result.positions)).mean_normal()
        self.shear = friction.peak(self.sides) if self.contact_field else 0.0
        if flat:
            self._add_plane(faces)
        else:
            self._add_space(faces)
        if self.window is not None:
            self._look_into_window()

    def _add_plane(self, faces):
        self._add_layer("body", self._body(faces))
        outline = surface.outline(faces)
        self._add_lines("body", surface.distinct(surface.all_edges(faces)), self.places, 0.4, fades=True)
        self._add_lines("body", outline, self.places, 0.8)
        self.rest = surface.lines(outline, self.result.positions)
        largest, ground, diagrams, zones, arrows = self._largest_contact_value(), [], [], {name: [] for name in friction.ZONES}, []
        for k, side in enumerate(self.sides):
            edges, top, sunk = side.edges(), self._foundation(side), self._away(side) - side.fields["gap"]
            top[:, 2] = BEHIND * self.result.size() * (1 + k / len(self.sides))  # where sides meet, one covers the other
            depth, ribbon = THICKNESS * self.size, friction.RIBBON * self.size * (self.shear > 0)
            below = depth + sunk[side.nodes()].max() - sunk
            ground.append(surface.band(edges, top, side.normals, below + ribbon, np.zeros(len(top))))
            self._add_lines("foundation", edges, top, 0.9)
            if self.contact_field:
                values = side.fields[self.contact_field]
                top[:, 2] /= 2
                heights = DIAGRAM * depth * self._heights(values) / largest
                diagrams.append(surface.band(edges, top, side.normals, heights, values, is_category(self.contact_field)))
            if self.shear and "traction" in side.fields:
                top += below[:, None] * side.normals
                for name, parts in zones.items():
                    parts.append(friction.ribbon(edges, top, side.normals, ribbon, side.fields[name]))
                top[:, 2] /= 2
                arrows.append(self._arrows(side, top + 0.5 * ribbon * side.normals, np.eye(3)[[2]]))
        if self.sides:
            self._add_layer("foundation", ground)
            self._add_layer("contact", diagrams)
        if self.shear:
            for name, parts in [*zones.items(), ("arrows", arrows)]:
                self._add_layer(name, parts)

    def _arrows(self, side, places, normals):
        """Of the traction on a side, where it is drawn. @param normals  (1 or nodes, 3) of the surface that arrows lie on"""
        nodes = side.nodes()
        if self.result.dim == 3:
            nodes = nodes[(self.levels[nodes] <= 0).all(axis=1)]
        elif self.window is not None:
            nodes = nodes[((places[nodes, :2] >= self.window[0]) & (places[nodes, :2] <= self.window[1])).all(axis=1)]
        normals = np.broadcast_to(normals, places.shape)[nodes]
        return friction.arrows(places[nodes], side.fields["traction"][nodes], normals, self.size, self.result.dim, self.shear)

    def _heights(self, values):
        """Of the diagram in the plane: sizes where the sign says a direction, the same everywhere for categories."""
        if is_category(self.contact_field):
            return np.full(len(values), 0.5)
        return abs(values) if is_signed(self.contact_field) else np.maximum(values, 0)

    def _largest_contact_value(self):
        """Height of the diagram before it is scaled; a number > 0."""
        if not self.contact_field or is_category(self.contact_field):
            return 1.0
        return max((self._heights(side.fields[self.contact_field][side.nodes()]).max() for side in self.sides), default=0) or 1e-300

    def states(self, field):
        """Numbers of a category that occur on the contact sides."""
        if not is_category(field):
            return []
        found = np.unique(np.concatenate([side.fields[field][side.nodes()] for side in self.sides])).astype(int)
        return [state for state in found if state >= 0]

    def _add_space(self, faces):
        bearing = np.zeros((sum(len(cells) for _, cells in self.result.blocks), 6), dtype=bool)
        for side in self.sides:
            for face in side.faces:
                bearing[face.cell, face.place] = True
        body = [face.part(~bearing[face.cell, face.place]) for face in faces] if self.contact_field else faces
        layer = self._body(body)
        for plane in range(len(self.cuts)):
            layer.append(surface.cells_section(self.result, plane, self.levels, self.places, self._values(self.body_field)))
        self._add_layer("body", layer)
        if self.contact_field:
            self._add_layer("contact", [rows for side in self.sides for rows in
                                        self._body(side.faces, side.fields[self.contact_field], is_category(self.contact_field))])
        self._add_lines("body", surface.distinct(surface.all_edges(faces)), self.places, 0.4, fades=True)
        self._add_lines("body", surface.sharp(faces, self.places), self.places, 0.8)
        if self.shear:
            self._add_friction()
        if self.sides:
            self._add_slabs()

    def _add_friction(self):
        """In space: the zones' borders, and arrows."""
        arrows, rubbing = [], [side for side in self.sides if "traction" in side.fields]
        for side in rubbing:
            arrows.append(self._arrows(side, self.places + friction.LIFT * self.size * side.normals, side.normals))
        self.layers["arrows"] = np.concatenate([np.pad(rows, ((0, 0), (0, 0), (0, len(self.cuts)))) for rows in arrows])
        for zone in reversed(friction.ZONES):  # where they meet the border is that of what sticks
            for side in rubbing:
                rows, _ = surface.clipped(np.concatenate(self._body(side.faces, side.fields[zone])))
                ends = friction.border(rows)
                if len(ends):
                    inwards = -ends[..., surface.NORMAL].mean(axis=1)
                    self.lines.append(Lines(ends[..., PLACE], 0 * ends[..., LEVELS:], "contact", 1.0, normals=inwards, zone=zone))

    def _add_slabs(self):
        """The foundation as a slab at each side; its surface has the body's faces, and goes as far as these are drawn."""
        ground, walls = [], []
        for side in self.sides:
            top, rim, none = self._foundation(side), surface.outline(side.faces), np.zeros(len(self.places))
            direction = THICKNESS * self.size * side.mean_normal()
            rows = np.concatenate([surface.triangles(face, top, self.levels, none[face.nodes]) for face in side.faces])
            rows, cut_lines = surface.clipped(rows)
            ground.append(rows)
            walls += [surface.walls(surface.segments(rim, top, self.levels), direction), surface.walls(cut_lines, direction)]
            edges = surface.distinct(surface.all_edges(side.faces))
            self._add_lines("foundation", edges, top, 0.25, fades=True, normals=side.normals[edges].mean(axis=1))
            self._add_lines("foundation", rim, top, 0.5)
        self.layers["ground"] = np.concatenate(ground)
        self._add_layer("foundation", walls)

    def _foundation(self, side):
        """Where the foundation's surface is drawn, (nodes, 3); of use at the side's nodes."""
        return self.result.positions + self._away(side)[:, None] * side.normals

    def _away(self, side):
        """(nodes,) how far from the undeformed body the foundation's surface is drawn.

        Gaps are those of the undeformed body, dents and what has been pressed in are enlarged as displacements are. Where the enlarged
        body would reach into it, the foundation gives way to it: they touch in the picture exactly where they touch.
        """
        gap, sunk, scale = side.fields["gap"], sunk_of(side), self.scale
        away = gap + scale * sunk
        if scale > 1:
            moved = ((self.places - self.result.positions) * side.normals).sum(axis=1)
            between = np.maximum(gap + sunk - moved / scale, 0)  # of the true body and the true foundation
            overlap = np.minimum(gap, 0)  # of the undeformed body, which displacements undo
            away = np.maximum(away + (scale - 1) * overlap, moved + np.minimum(between, APART * self.size))
        return away

    def _values(self, name):
        if name == CELL_SIZE:
            return self.result.cell_sizes()
        return self.result.nodal[name] if name in self.result.nodal else self.result.cell[name]

    def _body(self, faces, values=None, category=False):
        values = self._values(self.body_field) if values is None else values
        nodal = len(values) == len(self.levels)
        return [surface.triangles(face, self.places, self.levels, values[face.nodes] if nodal else
                                  np.broadcast_to(values[face.cell][:, None], face.nodes.shape), category) for face in faces]

    def _add_layer(self, name, rows):
        """What the planes leave of triangles, and lines along which they cut."""
        rows = np.concatenate([np.empty((0, 3, LEVELS + len(self.cuts))), *rows])
        self.layers[name], cut_lines = surface.clipped(rows)
        if self.cuts:
            self.lines.append(Lines(cut_lines[..., PLACE], cut_lines[..., LEVELS:] * 0, name, 0.8))

    def _add_lines(self, layer, edges, places, opacity, fades=False, normals=None):
        self.lines.append(Lines(surface.lines(edges, places), surface.lines(edges, self.levels), layer, opacity, fades, normals))

    def _look_into_window(self):
        """Leaves what the window shows, which must be something of the body."""
        dim, body = self.result.dim, ("body",) if self.result.dim == 2 else ("body", "contact")
        if dim == 2:
            self.layers = {name: rows[overlapping(rows, self.window)] for name, rows in self.layers.items()}
        if not sum(len(self.layers.get(name, ())) for name in body):
            places, unit = self.places if dim == 2 else self.result.positions, self.result.units["length"]
            raise PictureError(f'"{self.result.path}": --window must show a part of the body, which is drawn in '
                               f"{ranges(places, dim, unit)}, got {ranges(self.window, dim, unit)}; remedy: without --window the axes tell places")


def require_moderate(result, scale, window):
    """Of what is enlarged beyond all measure nothing can be seen."""
    size, displacement = result.size(), largest_displacement(result)
    if scale > 1 and scale * displacement > MOST * size:
        raise PictureError(f'"{result.path}": --scale must be at most {MOST * size / displacement:.3g}, which moves the body by {MOST} times '
                           f"its size, got {scale:g}")
    if window is not None and result.dim == 2:
        extent = np.ptp(window, axis=0)
        if extent.max() > MOST * size or extent.min() < LEAST * size or extent.max() > MOST * extent.min():
            raise PictureError(f'"{result.path}": --window must have sides between {LEAST * size:.3g} and {MOST * size:.3g} {result.units["length"]}, '
                               f"one at most {MOST} times as long as the other, got {extent[0]:g} and {extent[1]:g}")


def largest_displacement(result):
    """Of all nodes."""
    return np.linalg.norm(result.vector("disp_"), axis=1).max()


def sunk_of(side):
    """(nodes,) how far the foundation's surface lies below the one that it had at first: pressed in, or dented [m]."""
    return np.maximum(np.maximum(side.fields["penetration"], side.fields["dent"]), 0)


def overlapping(rows, window):
    """(n,) whether triangles in the plane may show in a window (2, 2)."""
    low, high = rows[..., :2].min(axis=1), rows[..., :2].max(axis=1)
    return ((low <= window[1]) & (high >= window[0])).all(axis=1)


def ranges(places, dim, unit):
    """The extent of places as a text."""
    return ", ".join(f"{places[:, d].min():g} <= {'xyz'[d]} <= {places[:, d].max():g}" for d in range(dim)) + f" {unit}"


def automatic_scale(result):
    """1, 2, 5, 10, ..., but no more than what makes the largest displacement or gap a twentieth of the body's size.

    Where a body has closed gaps, the foundation gives way to its enlarged displacements: 1 if a gap is larger than a hundredth of that size.
    """
    size, gap = result.size(), largest_gap(result)
    displacement = largest_displacement(result)
    if gap > 0.01 * size or displacement == 0:
        return 1.0
    wanted = 0.05 * size / max(displacement, gap)
    steps = [digit * 10.0**power for power in range(12) for digit in (1, 2, 5)]
    return max([step for step in steps if step <= wanted], default=1.0)


def largest_gap(result):
    """Largest distance, or initial penetration, between contact nodes and the foundation [m]; 0 without contact."""
    contact = result.contact_nodes()
    return 0.0 if contact is None else abs(result.nodal["gap"][contact]).max(initial=0)

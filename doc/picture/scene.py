"""What a picture shows of a result: triangles with the field, lines, the foundation."""
import dataclasses

import numpy as np

import surface
from result import PictureError
from surface import PLACE

CONTACT_FIELDS = ("contact_pressure", "gap", "dent", "penetration", "contact_status")
THICKNESS = 0.08  # of the foundation as it is drawn, of the body's size
DIAGRAM = 0.85  # height of the largest value in the plane, of that thickness
BEHIND = -1e-3  # z of the foundation in the plane, of the body's size


@dataclasses.dataclass
class Lines:
    """Lines on the surface, as dark as `opacity`; those that fade do so as they get short."""

    points: np.ndarray  # (lines, points, 3)
    levels: np.ndarray  # (lines, points), see surface.Cut
    layer: str
    opacity: float
    fades: bool = False


class Scene:
    """Triangles (n, 3, 8) of the layers "body", "contact" (the contact side; in the plane a diagram along it) and "foundation".

    field, body_field, contact_field  what is asked for, what the body shows, what the contact side shows (None: the body's)
    normal                            mean direction from the body into the foundation; 0 without contact
    rest                              in the plane the undeformed outline, (lines, points, 3)
    """

    def __init__(self, result, field=None, scale=None, cut=None):
        """@param field  None: the contact pressure where there is contact, else the von Mises stress
        @param scale  factor of displacements and gaps; None: see automatic_scale
        @param cut    surface.Cut, in space only
        """
        self.result, self.cut = result, cut
        self.contact = result.contact_nodes()
        self.field = field or ("von_mises" if self.contact is None else "contact_pressure")
        known = {**result.nodal, **result.cell}
        if self.field not in known:
            raise PictureError(f'--field must be one of {", ".join(known)}, got "{self.field}"')
        self.contact_field = self.field if self.field in CONTACT_FIELDS else None
        self.body_field = "von_mises" if self.contact_field else self.field
        self.scale = automatic_scale(result) if scale is None else scale
        self.places = result.positions + self.scale * result.vector("disp_")
        self.layers, self.lines, self.normal, self.rest = {}, [], np.zeros(3), None
        faces = surface.visible_faces(result)
        if result.dim == 2:
            self._add_plane(faces)
        else:
            self._add_space(faces)

    def _add_plane(self, faces):
        self._add_layer("body", self._body(faces))
        outline = surface.outline(faces)
        self._add_lines("body", surface.distinct(surface.all_edges(faces)), self.places, 0.4, fades=True)
        self._add_lines("body", outline, self.places, 0.8)
        self.rest = surface.lines(outline, self.result.positions)
        edges = outline[self.contact[outline].all(axis=1)] if self.contact is not None else []
        if not len(edges):
            return
        top, normals = self._foundation()
        self.normal = normals[edges].mean(axis=(0, 1))
        top[:, 2] = BEHIND * self.result.size()
        sunk = self.scale * self._sunk()
        depth = THICKNESS * self.result.size()
        self._add_layer("foundation", [surface.band(edges, top, normals, depth + sunk.max() - sunk, np.zeros(len(top)))])
        self._add_lines("foundation", edges, top, 0.9)
        if self.contact_field:
            values = self.result.nodal[self.contact_field]
            heights = DIAGRAM * depth * np.maximum(values, 0) / max(values[self.contact].max(), 1e-300)
            top[:, 2] /= 2
            self._add_layer("contact", [surface.band(edges, top, normals, heights, values)])

    def _add_space(self, faces):
        touching, others = [], faces
        if self.contact is not None:
            masks = [surface.on_contact_side(face, self.contact) for face in faces]
            touching = [face.part(mask) for face, mask in zip(faces, masks)]
            others = [face.part(~mask) for face, mask in zip(faces, masks)]
        body = others if self.contact_field else faces
        layer = self._body(body)
        if self.cut:
            layer.append(surface.cells_section(self.result, self.cut, self.places, self._values(self.body_field)))
        self._add_layer("body", layer)
        if self.contact_field:
            values = surface.completed(self._values(self.contact_field), self.contact, touching)
            self._add_layer("contact", self._body(touching, values))
        self._add_lines("body", surface.distinct(surface.all_edges(faces)), self.places, 0.4, fades=True)
        self._add_lines("body", surface.sharp(faces, self.places), self.places, 0.8)
        if touching:
            self._add_slab(touching)

    def _add_slab(self, faces):
        """The foundation as a slab; its surface has the body's faces."""
        top, normals = self._foundation()
        top, normals = (surface.completed(values, self.contact, faces) for values in (top, normals))
        levels, none = self._levels(top), np.zeros(len(top))
        self.normal = np.concatenate([normals[face.nodes].reshape(-1, 3) for face in faces]).mean(axis=0)
        direction = THICKNESS * self.result.size() * self.normal
        sheet = [surface.triangles(face, top, levels, none[face.nodes]) for face in faces]
        rim = surface.outline(faces)
        segments = surface.segments(rim, top, levels)
        cut_lines = self._add_layer("foundation", [*sheet, surface.walls(segments, direction)])
        self.layers["foundation"] = np.concatenate([self.layers["foundation"], surface.walls(cut_lines, direction)])
        self._add_lines("foundation", surface.distinct(surface.all_edges(faces)), top, 0.25, fades=True)
        self._add_lines("foundation", rim, top, 0.5)

    def _foundation(self):
        """Where the foundation's surface is drawn, (nodes, 3), and its normals; of use at contact nodes."""
        result = self.result
        normals = result.vector("contact_normal_")
        gap = max(self.scale, 1) * result.nodal["gap"] + self.scale * self._sunk()
        return result.positions + gap[:, None] * normals, normals

    def _sunk(self):
        """(nodes,) how far the foundation's surface lies below the one that it had at first: pressed in, or dented [m]."""
        return np.maximum(np.maximum(self.result.nodal["penetration"], self.result.nodal["dent"]), 0)

    def _values(self, name):
        return self.result.nodal[name] if name in self.result.nodal else self.result.cell[name]

    def _body(self, faces, values=None):
        values = self._values(self.body_field) if values is None else values
        levels = self._levels(self.result.positions)
        nodal = len(values) == len(levels)
        return [surface.triangles(face, self.places, levels, values[face.nodes] if nodal else
                                  np.broadcast_to(values[face.cell][:, None], face.nodes.shape)) for face in faces]

    def _levels(self, positions):
        return self.cut.levels(positions) if self.cut else np.full(len(positions), -1.0)

    def _add_layer(self, name, rows):
        """Returns the lines (k, 2, 8) along which the plane of the cut takes away a part."""
        rows = np.concatenate([np.empty((0, 3, 8)), *rows])
        self.layers[name] = rows
        if not self.cut:
            return np.empty((0, 2, 8))
        self.layers[name], sides = self.cut.clip(rows)
        self.lines.append(Lines(sides[..., PLACE], np.zeros((len(sides), 2)), name, 0.8))
        return sides

    def _add_lines(self, layer, edges, places, opacity, fades=False):
        undeformed = self.result.positions if layer == "body" else places
        levels = self._levels(undeformed)
        self.lines.append(Lines(surface.lines(edges, places), surface.lines(edges, levels), layer, opacity, fades))


def automatic_scale(result):
    """1, 2, 5, 10, ..., but no more than what makes the largest displacement or gap a twentieth of the body's size.

    Enlarged gaps bend the foundation: 1 if one is larger than a hundredth of that size.
    """
    size, gap = result.size(), largest_gap(result)
    displacement = np.linalg.norm(result.vector("disp_"), axis=1).max()
    if gap > 0.01 * size or displacement == 0:
        return 1.0
    wanted = 0.05 * size / max(displacement, gap)
    steps = [digit * 10.0**power for power in range(12) for digit in (1, 2, 5)]
    return max([step for step in steps if step <= wanted], default=1.0)


def largest_gap(result):
    """Largest distance, or initial penetration, between contact nodes and the foundation [m]; 0 without contact."""
    contact = result.contact_nodes()
    return 0.0 if contact is None else abs(result.nodal["gap"][contact]).max(initial=0)

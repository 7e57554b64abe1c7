# SPDX-License-Identifier: BSD-3-Clause
"""The contact sides of a body, each with the foundation that it meets.

A result names its sides. A node of two contact sides shows the values of one of them, see doc/input/results.md; on the other side they are
continued from the nodes around.
"""
import dataclasses

import numpy as np

import surface
from fields import is_category
from surface import unit

OF_FRICTION = ("friction_used", "friction_status", *(f"{stem}_{axis}" for stem in ("friction", "slip") for axis in "xyz"))
FIELDS = ("contact_pressure", "gap", "dent", "penetration", "contact_status", *OF_FRICTION)
FRICTION = ("traction", "sticks", "slips", *OF_FRICTION)
SAME_DIRECTION = 1e-3  # 1 - cosine up to which two normals are those of one side
NEIGHBOURS = {2: 2, 3: 9}  # nodes from which values are continued, by the dimension of space


@dataclasses.dataclass
class Side:
    """A contact side: [Faces], in the plane of edges; its fields and normals at all nodes of the body, of use at those of the side."""

    name: str
    faces: list
    fields: dict  # {name: (nodes,)}; with friction too "traction" (nodes, 3), "sticks" and "slips", 1 where a node does, else 0
    normals: np.ndarray  # (nodes, 3), into the foundation

    def nodes(self):
        """Numbers of its nodes."""
        return np.unique(np.concatenate([face.nodes.ravel() for face in self.faces]))

    def edges(self):
        """In the plane (edges, 2 or 3)."""
        return np.concatenate([face.nodes for face in self.faces])

    def mean_normal(self):
        """(3,) of all its faces' nodes."""
        return np.concatenate([self.normals[face.nodes].reshape(-1, 3) for face in self.faces]).mean(axis=0)

    def force(self, positions):
        """About what it bears."""
        pressure = self.fields["contact_pressure"]
        return sum((pressure[face.nodes].mean(axis=1) * np.linalg.norm(surface.outward(face, positions), axis=1)).sum()
                   for face in self.faces)


def contact_sides(result, skin):
    """[Side] of a result, none without contact. @param skin  [Faces] of the boundary"""
    contact = result.contact_nodes()
    if contact is None:
        return []
    groups = named(result, skin)
    others = nodes_of_several(list(groups.values()), len(contact))
    found = {}
    for name, faces in groups.items():
        touching = [face.part(surface.on_contact_side(face, contact)) for face in faces]
        if any(len(face.nodes) for face in touching) and (len(groups) == 1 or bears(result, faces, touching, others)):
            found[name] = touching
    shared = nodes_of_several(list(found.values()), len(contact))
    return [side_of(result, name, faces, shared) for name, faces in found.items()]


def named(result, skin):
    """{name: [Faces]} of the sides that the file names; all the skin if it names none."""
    if not result.side_sets:
        return {"": skin}
    owner = np.full((sum(len(cells) for _, cells in result.blocks), 6), -1)
    by_size = sorted(result.side_sets.items(), key=lambda entry: -len(entry[1]))  # a facet of two belongs to the smaller one
    for n, (_, facets) in enumerate(by_size):
        owner[facets[:, 0], facets[:, 1]] = n
    return {name: [face.part(owner[face.cell, face.place] == n) for face in skin] for n, (name, _) in enumerate(by_size)}


def nodes_of_several(groups, num_nodes):
    """(nodes,) whether a node belongs to several groups of faces."""
    count = np.zeros(num_nodes, dtype=int)
    for faces in groups:
        count[np.unique(np.concatenate([face.nodes.ravel() for face in faces]))] += 1
    return count > 1


def bears(result, faces, touching, others):
    """Whether a side is a contact side, and not one whose nodes happen to lie on contact sides beside it."""
    nodes = np.unique(np.concatenate([face.nodes.ravel() for face in faces]))
    if result.contact_nodes()[nodes[~others[nodes]]].any():
        return True
    normals = result.vector("contact_normal_")
    along = [(unit(surface.outward(face, result.positions)) * normals[face.nodes].mean(axis=1)).sum(axis=1) for face in touching]
    return np.concatenate(along).mean() > 0.3


def side_of(result, name, faces, shared):
    """A side with its own values at nodes that belong to others too. @param shared  (nodes,) of several contact sides"""
    contact = result.contact_nodes()
    fields = {name: result.nodal[name].copy() for name in FIELDS if name in result.nodal}
    if "friction_status" in result.nodal:
        status = result.nodal["friction_status"]
        fields |= {"traction": result.vector("friction_"), "sticks": (status == 1).astype(float), "slips": (status == 2).astype(float)}
    side = Side(name, faces, fields, result.vector("contact_normal_"))
    nodes = side.nodes()
    known = nodes[contact[nodes] & ~shared[nodes]]
    wanted = nodes[contact[nodes] & shared[nodes]]
    if len(known) and len(wanted):
        continue_values(result, side, known, wanted)
    if result.dim == 3:
        side.normals = surface.completed(side.normals, contact, faces)
        bare = vertices_of_quadratic_triangles(faces, len(contact))
        side.fields = {name: surface.completed(values, contact & ~bare if name in FRICTION else contact, faces, is_category(name))
                       for name, values in fields.items()}
    return side


def vertices_of_quadratic_triangles(faces, num_nodes):
    """(nodes,) which ones of a side carry no traction by themselves."""
    found = np.zeros(num_nodes, dtype=bool)
    for face in faces:
        if face.kind == "TRI6":
            found[face.nodes[:, :3]] = True
    return found


def continue_values(result, side, known, wanted):
    """Replaces the values at nodes that show another side's."""
    around, weights = continuation(result, known, wanted)
    normals = unit(weighted(side.normals[around], weights))
    foreign = (normals * side.normals[wanted]).sum(axis=1) < 1 - SAME_DIRECTION
    wanted, normals, around, weights = wanted[foreign], normals[foreign], around[foreign], weights[foreign]
    gap, dent, pressure = (weighted(side.fields[name][around], weights) for name in ("gap", "dent", "contact_pressure"))
    side.normals[wanted] = normals
    side.fields["gap"][wanted] = gap
    side.fields["dent"][wanted] = np.maximum(dent, 0)
    side.fields["penetration"][wanted] = (result.vector("disp_")[wanted] * normals).sum(axis=1) - gap
    side.fields["contact_pressure"][wanted] = np.clip(pressure, 0, side.fields["contact_pressure"][wanted])  # the higher one is shown
    for name in {"contact_status", *FRICTION} & set(side.fields):
        side.fields[name][wanted] = side.fields[name][around[:, 0]]


def weighted(values, weights):
    """(n, ...) sums of values (n, k, ...)."""
    return np.einsum("nk,nk...->n...", weights, values)


def continuation(result, known, wanted):
    """Nodes (wanted, k) next to each node, the nearest first, and their weights (wanted, k) in the linear function that fits
    their values best, at that node; constant where they do not tell a slope."""
    number = min(NEIGHBOURS[result.dim], len(known))
    around, weights = np.empty((len(wanted), number), dtype=np.int64), np.empty((len(wanted), number))
    for k, node in enumerate(wanted):
        away = result.positions[known] - result.positions[node]
        distance = (away**2).sum(axis=1)
        some = np.argpartition(distance, number - 1)[:number]
        some = some[np.argsort(distance[some], kind="stable")]
        slopes = 1e-3 * away[some] / abs(away[some]).max()  # small beside the constant, which the shortest solution then prefers
        terms = np.concatenate([np.ones((number, 1)), slopes], axis=1)
        around[k], weights[k] = known[some], np.linalg.pinv(terms, rcond=1e-6)[0]
    return around, weights

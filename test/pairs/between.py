# SPDX-License-Identifier: BSD-3-Clause
"""How much deeper the side lies in the foundation between its contact points than these, at ten points a facet and more."""
import dataclasses
import math

import numpy as np

import foundation
from elasticity import lame

UNSEEN = 0.25  # of the approach: a quarter of it unseen is a third of Hertz's force, which grows as its power 1.5
AGREES = 0.5  # samples of two programs miss the deepest place by less
MATTERS = 0.1  # of the energy norm: twice what a run leaves unsaid, doc/theory.md (3.16)
KEY = "max_penetration_between_nodes"  # of the summary
NOTES = ("unseen", "contact that no node has")  # words of a note, or of what the mesh misses, about contact that no point sees
WORDS = (*NOTES, "between")  # of notes on the console, where the summary has no such number


@dataclasses.dataclass
class Found:
    excess: float  # deepest penetration beyond that of the facet's contact points [m]
    place: np.ndarray
    approach: float  # of the side to the foundation: the most by which it has moved towards it, and overlaps it at rest [m]
    unseen: float  # what the worst facet without pressure would add to the energy norm, relative to it


def look(judge, state):
    """@param judge  the oracle of the run  @return Found, or None where no normal meets the foundation"""
    mesh, contact = judge.mesh, judge.case.side.seen_at(state.time)
    samples = foundation.samples(mesh, judge.side, state.u, state.dent)
    points = foundation.seen(contact, samples.place, samples.outward)
    if not len(points.index):
        return None
    nodes, _, _ = judge.nodal(state)
    v = np.einsum("kd,kd->k", state.u[nodes], state.points.normal) - state.points.gap
    at_nodes = np.zeros(len(mesh.coords))
    at_nodes[nodes] = np.maximum(0, v - state.dent[nodes])
    facet = samples.facet[points.index]
    towards = np.einsum("kd,kd->k", samples.u[points.index], points.normal)
    excess = towards - points.gap - samples.dent[points.index] - np.array([at_nodes[some].max() for some in samples.nodes])[facet]
    k = int(np.argmax(excess))
    approach = max(np.max(towards), 0.0) + max(-np.min(points.gap), 0.0)
    unseen = {int(f) for f in np.unique(facet[excess > 0]) if not state.p[samples.nodes[f]].max() > 0}
    return Found(float(excess[k]), points.place[k], approach, share(judge, state, unseen))


def share(judge, state, unseen):
    """Of the energy norm: what it takes to push the worst facet that bears no pressure out of the foundation. A layer of the body gives way that is
    as deep as the part in the foundation is wide. The part may be a strip at an edge, a hundredth of the facet: few samples, some on edges, would take
    it for ten times the energy.
    @param unseen  numbers of the facets that bear no pressure and lie in the foundation"""
    if not unseen:
        return 0.0
    worst, material, mesh = 0.0, judge.case.scene.material, judge.mesh
    lam, mu = lame(material["E"], min(material["nu"], 0.4))
    samples = foundation.samples(mesh, judge.side, state.u, state.dent, foundation.middles_of)
    mine = np.flatnonzero(np.isin(samples.facet, list(unseen)))
    points = foundation.seen(judge.case.side.seen_at(state.time), samples.place[mine], samples.outward[mine])
    index = mine[points.index]
    deep = np.maximum(0, np.einsum("kd,kd->k", samples.u[index], points.normal) - points.gap - samples.dent[index])
    area = samples.area[index] * (2 * math.pi * points.place[:, 0] if judge.axisymmetric else 1.0)
    for number in unseen:
        inside = (samples.facet[index] == number) & (deep > 0)
        if not inside.any():
            continue
        size = float(np.max(np.ptp(mesh.coords[samples.nodes[number]], axis=0)))
        width = size * (np.count_nonzero(inside) / np.count_nonzero(samples.facet == number)) ** (1 / (mesh.dim - 1))
        stiffness = 1 / (width / (lam + 2 * mu) + 1 / judge.case.side.stiffness)
        pressure = np.minimum(stiffness * deep[inside], points.xi[inside])
        worst = max(worst, float(np.sum(area[inside] * pressure * (deep[inside] - pressure / (2 * stiffness)))))
    return math.sqrt(worst / (state.strain_energy + worst)) if worst > 0 else 0.0

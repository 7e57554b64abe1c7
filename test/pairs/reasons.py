# SPDX-License-Identifier: BSD-3-Clause
"""Which refusals and unfinished runs the oracle confirms: for each exit code the reasons that it accepts, and what must hold then.

A run that ends with another exit code than 0 and no confirmed reason fails its row.
"""
import itertools
import math

import comparisons

MOST_CYCLES = 12  # Adapt->Max Cycles by default
NEAR = 8  # a mesh that the next one, for half of the error, may exceed has at least this part of Max Dofs


def confirmed(case, run):
    """None if the run ended well or with a reason that holds, else a complaint."""
    if run.code == 0:
        return None
    for words, holds in REASONS.get(run.code, []):
        if words in run.reason() and holds(case, run):
            return None
    return f"exit {run.code}: {run.reason()[:300] or run.stdout[-200:]}"


def wall_is_pressed(case, run):
    """A side that holds the body shares points with the contact side, and the obstacle lies above one of them at some time."""
    for wall in [side for side in case.scene.dirichlet if side != "top"]:
        for time, place in itertools.product(case.scene.times or [1.0], edge_of(case, wall)):
            found = case.side.seen_at(time).at(place, (0.0, -1.0, 0.0)[:case.scene.dim])
            if found and found[1] < 0 and math.isinf(case.side.xi(*place)) and math.isinf(case.side.stiffness):
                return True
    return False


def edge_of(case, wall):
    """Points of the edge between a wall and the bottom."""
    shape = case.shape
    width = shape.lengths[0]
    x = shape.inner + (width if wall == "right" else 0.0)
    reach = width if shape.axisymmetric else width / 2
    round_up = 0.0 if math.isinf(shape.radius) or (shape.axisymmetric and wall == "left") else shape.radius - math.sqrt(shape.radius ** 2 - reach ** 2)
    if shape.dim == 2:
        return [(x, round_up)]
    return [(x, round_up, shape.lengths[2] * k / 20) for k in range(21)]


def dofs_are_short(case, run):
    """The best mesh has so many unknowns that the next one may exceed what is allowed."""
    adaptation = run.summary["adaptation"]
    most = max(cycle["dofs"] for cycle in adaptation["cycles"])
    return run.summary["converged"] and not adaptation["reached"] and most * NEAR >= case.scene.more["Adapt"]["Max Dofs"]


def cycles_are_short(case, run):
    return run.summary["converged"] and len(run.summary["adaptation"]["cycles"]) >= MOST_CYCLES


def energy_is_missed(case, run):
    """A step misses more of the energies than the deck allows, and what is told has converged."""
    if case.tolerance is None or run.summary is None or not run.summary["converged"]:
        return False
    return max((share for _, _, share in comparisons.missed_shares(run, 0.0, overlaps=True)), default=0.0) > case.tolerance / 2


REASONS = {
    4: [('"Adapt->Max Dofs"', dofs_are_short), ('"Adapt->Max Cycles"', cycles_are_short), ("Energy Tolerance", energy_is_missed)],
    5: [("presses the node at", wall_is_pressed)],
}

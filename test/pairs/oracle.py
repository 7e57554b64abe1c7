# SPDX-License-Identifier: BSD-3-Clause
"""Judges one run by its files: equilibrium, laws of contact and friction at and between contact points, energies. No code of rpc's."""
import dataclasses
import math

import numpy as np

import between
import elasticity
import foundation
from scene import COMPONENTS

EQUAL = 1e-7  # of sums of forces and energies, relative to their largest part
TOLERANCE = 1e-8  # the solver's, of sums
SOLVED = 1e-6  # of pressures, tractions and forces at nodes
ROUNDING = 1e-12  # of |K||u|, in sums
LEFT = 1e-9  # of |K||u|, what a solve may leave of equilibrium where a body moves without strain, as in test/stress/histories.py
TINY = 1e-300


@dataclasses.dataclass
class State:
    """Nodal values at one time; all 0 at rest."""

    time: float
    u: np.ndarray
    p: np.ndarray
    dent: np.ndarray
    q: np.ndarray
    forces: np.ndarray = None
    strain_energy: float = 0.0
    rounding: float = 0.0  # what the digits of u leave of forces
    points: foundation.Points = None  # of the contact points


def vector(fields, time, dim):
    """Of a list of fields that are constant in space, at a time."""
    return np.array([field(0.0, 0.0, 0.0) for field in fields][:dim])


class Oracle:
    """@param case  what was asked for (decks.Case)  @param run  what came of it (outputs.Run)"""

    def __init__(self, case, run):
        self.case, self.run, self.mesh = case, run, run.mesh
        self.axisymmetric = case.shape.axisymmetric
        self.side = case.side.side
        self.nodes, self.weights, self.outward = foundation.contact_points(self.mesh, self.side, self.axisymmetric)
        self.prescribed = self.prescribed_unknowns()
        self.free = ~self.prescribed[self.nodes].any(axis=1)  # contact points that no Dirichlet condition holds
        self.complaints, self.said = [], set()
        self.summaries = {s["time"]: s for s in run.step_summaries()}
        self.states = [self.state(step) for step in range(len(run.times))]

    # --- what the files say

    def prescribed_unknowns(self):
        held = np.zeros(self.mesh.coords.shape, dtype=bool)
        for side, components in self.case.scene.dirichlet.items():
            for component in components:
                held[self.mesh.side_nodes(side), COMPONENTS.index(component)] = True
        if self.axisymmetric:
            held[self.mesh.coords[:, 0] <= 0, 0] = True
        return held

    def state(self, step):
        run, fields = self.run, self.run.fields[step]
        state = State(run.times[step], run.vector(step, "disp"), fields["contact_pressure"], fields["dent"], run.vector(step, "friction"))
        state.forces, state.strain_energy = elasticity.internal(self.mesh, state.u, self.case.scene.material, self.axisymmetric)
        state.rounding = ROUNDING * elasticity.largest_product(self.mesh, state.u, self.case.scene.material, self.axisymmetric)
        state.points = foundation.seen(self.case.side.seen_at(state.time), self.mesh.coords[self.nodes], self.outward)
        return state

    def at_rest(self):
        first, zero = self.states[0], np.zeros(len(self.mesh.coords))
        still = dataclasses.replace(first.points, gap=np.maximum(first.points.gap, 0.0))
        nothing = np.zeros_like(self.mesh.coords)
        return State(0.0, nothing, zero, zero, nothing, nothing, points=still)

    def before(self, step):
        """The state that a step began with; None where the file does not have it."""
        if step > 0:
            return self.states[step - 1]
        first = min(self.summaries)
        return self.at_rest() if self.states[0].time == first else None

    def nodal(self, state):
        """Of the contact points whose normal meets the foundation: (nodes, weights, free)"""
        k = state.points.index
        return self.nodes[k], self.weights[k], self.free[k]

    def motion(self, time):
        """Of the obstacle since rest."""
        side = self.case.side
        if not side.motion:
            return np.zeros(self.mesh.dim)
        name = "Centre" if "Centre" in side.obstacle else "Point"
        return np.subtract(side.moved_to(time).obstacle[name], side.obstacle[name])

    def complain(self, state, text):
        """Once about what goes on from step to step."""
        what = text.split(" at (")[0].split(" is ")[0]
        if what in self.said:
            return
        self.said.add(what)
        self.complaints.append(text if len(self.states) == 1 else f"t = {state.time:g}: {text}")

    def rest(self, state):
        """(forces, energies) that sums of what is rounded leave."""
        force = len(self.mesh.coords) * state.rounding
        return force, force * np.max(np.abs(state.u), initial=0.0)

    def rests(self):
        """The largest of all states, with what the tolerance leaves of forces on springs."""
        force, energy = (max(values) for values in zip(*map(self.rest, self.states)))
        return force + self.left_on_springs(), energy

    def left_on_springs(self):
        """Of the contact force. The solver's tolerance is of pressures (doc/theory.md, (5.3)), as if points were held by E/diameter of the body alone. A
        column of the body on stiffer springs amplifies what is left. A rigid foundation has no such rest: its last Newton step is exact."""
        if math.isinf(self.case.side.stiffness):
            return 0.0
        material, extents = self.case.scene.material, np.ptp(self.mesh.coords, axis=0)
        lam, mu = elasticity.lame(material["E"], min(material["nu"], 0.4))
        column = 1 / (np.min(extents) / (lam + 2 * mu) + 1 / self.case.side.stiffness)
        held = material["E"] / np.linalg.norm(extents)
        touching = {state.time: np.sum(weights[state.p[nodes] > 0]) for state in self.states for nodes, weights, _ in [self.nodal(state)]}
        return TOLERANCE * max(1.0, column / held) * max(np.max(state.p) * touching[state.time] for state in self.states)

    # --- the judgement

    def judge(self):
        """All complaints about the run."""
        if not self.run.summary["converged"] and self.run.code == 0:
            self.complaints.append("exit 0, not converged")
        for step, state in enumerate(self.states):
            self.check_equilibrium(state)
            self.check_laws(step, state)
            self.check_between(state)
            self.check_energies(step, state)
            self.check_extents(state)
        self.check_table()
        return self.complaints

    def loads(self, time):
        scene = self.case.scene.at(time)
        traction = {side: vector(fields, time, self.mesh.dim) for side, fields in scene.traction.items()}
        body = np.array(scene.body_force) if scene.body_force else None
        return elasticity.loads(self.mesh, traction, body, self.axisymmetric)

    def contact_forces(self, state):
        """Of the body on the foundation, by node."""
        forces = np.zeros_like(self.mesh.coords)
        nodes, weights, _ = self.nodal(state)
        forces[nodes] = weights[:, None] * (state.p[nodes, None] * state.points.normal + state.q[nodes])
        return forces

    def check_equilibrium(self, state):
        load, contact = self.loads(state.time), self.contact_forces(state)
        rest = state.forces - load + contact
        scale = max(np.max(np.abs(load)), np.max(np.abs(contact)), np.max(np.abs(rest[self.prescribed]), initial=0.0))
        off = np.where(self.prescribed, 0.0, np.abs(rest))
        left = LEFT / ROUNDING * state.rounding
        if np.max(off) > SOLVED * scale + left:
            node = int(np.argmax(off.max(axis=1)))
            self.complain(state, f"forces do not balance at {place_of(self.mesh.coords[node])}: {np.max(off):.3g} is left of {scale:.3g}")
        reaction = np.where(self.prescribed, rest, 0.0)
        self.check_resultants(state, load, contact, reaction)

    def check_resultants(self, state, load, contact, reaction):
        """Forces and moments of load, contact and supports, and the sums in the summary."""
        parts = [load, -contact, reaction]
        scale = max(max(np.sum(np.abs(part)) for part in parts), TINY)
        left = LEFT / ROUNDING * state.rounding
        moment = lambda f: np.sum(np.cross(self.mesh.coords, f), axis=0)
        if not self.axisymmetric:
            size = np.max(np.ptp(self.mesh.coords, axis=0))
            if np.max(np.abs(sum(moment(part) for part in parts))) > (SOLVED * scale + len(load) * left) * size:
                self.complain(state, f"moments do not balance: {np.max(np.abs(sum(moment(p) for p in parts))):.3g} is left of {scale * size:.3g}")
        radial = [0.0 if self.axisymmetric else 1.0] + [1.0] * (self.mesh.dim - 1)
        summary = self.summaries[state.time]
        told = {"contact_force": (np.array(summary["contact_force"]), -contact)}
        if state.time == self.run.summary["time"] and "reaction_force" in self.run.summary:
            told["reaction_force"] = (np.sum(list(self.run.summary["reaction_force"].values()), axis=0), reaction)
        for name, (value, mine) in told.items():
            own = np.sum(mine, axis=0) * radial
            if np.max(np.abs(value - own)) > SOLVED * scale + len(load) * state.rounding:
                self.complain(state, f"{name} is {value.tolist()}, by the displacement and pressures {own.tolist()}")

    def small(self, state):
        """(pressure, length) that count as nothing: of the largest pressure, and of what it does to a facet."""
        sizes = {other.time: max(np.max(other.p), np.max(np.abs(other.q)), 0.0) for other in self.states if other.time <= state.time}
        pressure = max(sizes[state.time], TOLERANCE / SOLVED * max(sizes.values()))  # earlier steps leave as much as the tolerance allows
        length = foundation.facet_size(self.mesh, self.side)
        stiff = min([self.case.scene.material["E"]] + [E for E, _ in self.case.scene.material["blocks"].values()])
        moved = max(np.max(np.abs(other.u), initial=0.0) for other in self.states if other.time <= state.time)  # a slip is a difference of two of them, each known to the solver's tolerance
        return SOLVED * pressure + TINY, SOLVED * pressure * length / stiff + TOLERANCE * moved + TINY

    def check_laws(self, step, state):
        nodes, _, free = self.nodal(state)
        points, before = chosen(state.points, free), self.before(step)
        nodes, small = nodes[free], self.small(state)
        v = np.einsum("kd,kd->k", state.u[nodes], points.normal) - points.gap
        whole = before is not None and not self.several_meshes()
        contact = self.case.side
        found = foundation.law_violations(contact, points, state.p[nodes], v, state.dent[nodes], before.dent[nodes] if whole else None, small, self.parts(state))
        if contact.friction:
            e = self.slip(state, before, nodes, points) if whole and self.parts(state) == 1 else None
            found += foundation.friction_violations(contact.friction, points, state.p[nodes], state.q[nodes], e, small)
        for text in found:
            self.complain(state, text)

    def slip(self, state, before, nodes, points):
        e = state.u[nodes] - before.u[nodes] - (self.motion(state.time) - self.motion(before.time))
        return e - np.einsum("kd,kd,ke->ke", e, points.normal, points.normal)

    def parts(self, state):
        return self.summaries[state.time].get("parts", 1)

    def several_meshes(self):
        """Whether steps may have been solved on other meshes than the file's."""
        return self.case.target is not None and self.case.scene.times is not None

    def check_between(self, state):
        """Penetration between contact points: told in the summary where it is large, and with a word where facets that matter are not seen."""
        found = between.look(self, state)
        if found is None or found.excess <= between.UNSEEN * found.approach + self.small(state)[1] or self.run.code != 0:
            return
        where = f"at {place_of(found.place)}: {found.excess:.3g} of an approach of {found.approach:.3g}"
        summary = self.summaries[state.time]
        console = " ".join((self.run.stdout + self.run.stderr).split())  # its lines are wrapped
        if between.KEY in summary:
            if summary[between.KEY] < found.excess * between.AGREES:
                self.complain(state, f"penetration between contact points {where}, the summary has {summary[between.KEY]:.3g}")
            elif found.unseen > between.MATTERS and not any(word in console for word in between.NOTES):
                self.complain(state, f"unseen contact {where}, with {found.unseen:.2g} of the energy norm, and no note")
        elif not any(word in console for word in between.WORDS):
            self.complain(state, f"penetration between contact points {where}, and no word")

    def check_extents(self, state):
        """What the summary says of the whole side."""
        nodes, weights, _ = self.nodal(state)
        summary, touches = self.summaries[state.time], state.p[nodes] > 0
        extent = "contact_area" if "contact_area" in summary else "contact_length"
        counts = nodes
        if self.axisymmetric:  # the axis, without weight, has the pressure that it is lent
            side = self.mesh.side_nodes(self.side)
            counts = np.concatenate([nodes, side[self.mesh.coords[side, 0] <= 0]])
        own = {extent: np.sum(weights[touches]), "max_pressure": np.max(state.p[counts], initial=0.0)}
        if not self.several_meshes():
            own["dent_volume"] = np.sum(weights * state.dent[nodes])
        for key, value in own.items():
            if abs(summary[key] - value) > SOLVED * max(abs(summary[key]), value) + TINY:
                self.complain(state, f"{key} is {summary[key]!r}, by the oracle {float(value)!r}")

    def check_energies(self, step, state):
        summary = self.summaries[state.time]
        self.equal(state, "strain_energy", summary["strain_energy"], state.strain_energy, state.strain_energy)
        before = self.before(step)
        if before is None or self.several_meshes() or self.parts(state) > 1:
            return
        nodes, weights, free = self.nodal(state)
        contact, p, growth = self.case.side, state.p[nodes], state.dent[nodes] - before.dent[nodes]
        if "energy_J" in summary:
            self.check_functional(state, before, summary)
        if "work" not in summary:
            return
        compliance = 0.0 if math.isinf(contact.stiffness) else 1 / contact.stiffness
        own = {"foundation_energy": np.sum(weights * compliance * p ** 2 / 2),
               "dissipated_energy": np.sum(weights * (p - contact.hardening * growth / 2) * growth),
               "work": self.work(state, before)}
        if contact.friction:
            e = self.slip(state, before, nodes, state.points)
            rubs = [contact.friction.bears(pk, *map(float, x)) > 0 for pk, x in zip(p, state.points.place)]  # no slip is told of points that have left
            own["dissipated_by_friction"] = np.sum(weights * rubs * np.einsum("kd,kd->k", state.q[nodes] + before.q[nodes], e) / 2)
        last = self.summaries[before.time] if before.time in self.summaries else {}
        scale = max(abs(each.get(key, 0.0)) for key in (*own, "strain_energy") for each in (summary, last))
        for key, value in own.items():
            told = summary[key] - (last.get(key, 0.0) if key != "foundation_energy" else 0.0)
            self.equal(state, f"{key} of the step", told, value, scale, before)

    def check_functional(self, state, before, summary):
        """J with its own integrals; not where a Dirichlet condition presses a point into the foundation."""
        nodes, weights, free = self.nodal(state)
        contact, dent = self.case.side, before.dent[nodes]
        v = np.einsum("kd,kd->k", state.u[nodes], state.points.normal) - state.points.gap - dent
        if np.any(v[~free] > 0):
            return
        compliance = 0.0 if math.isinf(contact.stiffness) else 1 / contact.stiffness
        stored = sum(w * foundation.energy_of(vk, xi + (contact.hardening * d if contact.hardening else 0.0), contact.hardening, compliance)
                     for w, vk, xi, d in zip(weights, v, state.points.xi, dent))
        load = np.sum(self.loads(state.time) * state.u)
        self.equal(state, "energy_J", summary["energy_J"], state.strain_energy - load + stored, max(state.strain_energy, abs(load), stored))

    def work(self, state, before):
        """Of a step, (11.3) and (12.9): of loads and supports, and of the foundation's own motion."""
        nodes, weights, _ = self.nodal(state)
        if not np.array_equal(state.points.index, before.points.index):
            return math.nan
        acting = state.forces + self.contact_forces(state) + before.forces + self.contact_forces(before)
        work = np.sum(acting * (state.u - before.u)) / 2
        turned = np.einsum("kd,kd->k", (state.u + before.u)[nodes] / 2, state.points.normal - before.points.normal)
        work += np.sum(weights * (state.p + before.p)[nodes] / 2 * (turned - (state.points.gap - before.points.gap)))
        if self.case.side.friction:
            moved = self.motion(state.time) - self.motion(before.time)
            along = moved - (state.points.normal @ moved)[:, None] * state.points.normal
            work -= np.sum(weights[:, None] * (state.q + before.q)[nodes] * along) / 2
        return work

    def equal(self, state, name, told, own, scale, *others):
        """@param others  states whose rounding is in the value too"""
        rest = sum(self.rest(each)[1] for each in (state, *others))
        if not math.isnan(own) and not abs(told - own) <= EQUAL * scale + rest + TINY:
            self.complain(state, f"{name} is {told!r}, by the oracle {own!r} (scale {scale:.3g})")

    def check_table(self):
        """The contact table has the last state, and weights in space."""
        state, at = self.states[-1], {}
        if state.time != self.run.summary["time"]:
            return
        for place, node in zip(np.round(self.mesh.coords[self.mesh.side_nodes(self.side)], 9), self.mesh.side_nodes(self.side)):
            at[tuple(place + 0.0)] = node
        own = {n: (w, nu, g) for n, w, nu, g in zip(*self.nodal(state)[:2], state.points.normal, state.points.gap)}
        small = self.small(state)
        for row in self.run.contact_rows():
            node = at.get(tuple(np.round([row[c] for c in "xyz"[:self.mesh.dim]], 9) + 0.0))
            if node is None or (node in self.nodes and node not in own):
                self.complain(state, f"a row of the contact table at {place_of([row[c] for c in 'xyz'[:self.mesh.dim]])} is no contact point")
            elif node in own:
                weight, nu, gap = own[node]
                if (row["state"] == "open") != (row["pressure"] == 0):
                    self.complain(state, f"state at {place_of(self.mesh.coords[node])} is {row['state']}, with a pressure of {row['pressure']!r}")
                pairs = [("pressure", row["pressure"], state.p[node], small[0]), ("u_nu", row["u_nu"], state.u[node] @ nu, small[1]),
                         ("gap", row["gap"], gap, small[1] + 1e-9 * abs(gap))]
                pairs += [("area", row["area"], weight, 1e-9 * weight)] if "area" in row else []
                for name, told, mine, nothing in pairs:
                    if abs(told - mine) > nothing:
                        self.complain(state, f"{name} at {place_of(self.mesh.coords[node])} is {told!r} in the table, by the oracle {float(mine)!r}")
                        return


def chosen(points, mask):
    return foundation.Points(points.place[mask], points.normal[mask], points.gap[mask], points.xi[mask], points.index[mask])


def place_of(place):
    return "(" + ", ".join(f"{float(x):.6g}" for x in place) + ")"

# SPDX-License-Identifier: BSD-3-Clause
"""Judges a run by others: ranks and preconditioners, a restart, a finer mesh, and what the deck has asked for."""
import math

import numpy as np

SAME = 1e-8  # of forces of one mesh
SAME_ENERGY = 1e-7  # a(u, u) is of first order in what forces out of balance by the solver's tolerance, 1e-8, leave of u: a slender body has 1.6e-8
SAME_FIELD = 1e-6  # of displacements and pressures, of the largest one: the solver's tolerance, 1e-8, is of sums of forces
NARROW = 2  # effectivities of estimates on coarse meshes begin at a half, doc/robustness.md
WIDE = 10  # an estimate may be so many times the change that halving all cells makes
SPLIT = 1e-6  # of the largest energy: what sums over divided steps may differ by


def extremes(run, state_key):
    return [abs(step.get(state_key) or 0.0) for step in run.step_summaries()]


def same_mesh(run, other):
    """The order of the other's nodes as the run has them; None where meshes differ."""
    a, b = run.mesh.coords, other.mesh.coords
    if a.shape != b.shape:
        return None
    scale = np.max(np.ptp(a, axis=0))
    key = lambda x: np.lexsort(np.round(x / scale, 7).T)
    one, two = key(a), key(b)
    if np.max(np.abs(a[one] - b[two])) > 1e-7 * scale:
        return None
    order = np.empty(len(a), dtype=int)
    order[one] = two
    return order


def same(run, other, what, rests=(0.0, 0.0)):
    """Complaints about two runs of one problem. @param rests  forces and energies that are rounding, or what the tolerance leaves"""
    if other.code != run.code:
        return [f"{what}: exit {other.code} instead of {run.code}: {other.reason()[:200]}"]
    if run.mesh is None or other.mesh is None:
        return []
    order = same_mesh(run, other)
    if order is None:
        return []  # adapted meshes, where rounding has decided on a cell
    found = []
    largest = max(np.max(np.abs(run.vector(step, "disp"))) for step in range(len(run.times)))
    for step, time in enumerate(run.times):
        if time not in other.times:
            found.append(f"{what}: no step t = {time:g}")
            continue
        off = np.max(np.abs(run.vector(step, "disp") - other.vector(other.times.index(time), "disp")[order]))
        if off > SAME_FIELD * largest:
            found.append(f"{what}: displacements at t = {time:g} differ by {off / largest:.2g} of the largest")
            break
    for key, bound, rest in (("strain_energy", SAME_ENERGY, rests[1]), ("max_pressure", SAME_FIELD, 0.0)):
        scale = max(extremes(run, key))
        for a, b in zip(run.step_summaries(), other.step_summaries()):
            if abs(a[key] - b[key]) > bound * scale + rest:
                found.append(f"{what}: {key} is {a[key]!r} and {b[key]!r}")
                break
    scale = max(np.max(np.abs(step["contact_force"])) for step in run.step_summaries())
    for a, b in zip(run.step_summaries(), other.step_summaries()):
        if np.max(np.abs(np.subtract(a["contact_force"], b["contact_force"]))) > SAME * scale + rests[0]:
            found.append(f"{what}: contact_force is {a['contact_force']} and {b['contact_force']}")
            break
    return found


# --- a finer mesh ------------------------------------------------------------------------------------------------------------

BARS = {"energy_J": "energy_J", "contact_force": "contact_force", "max_pressure": "max_pressure", "contact_length": "contact_length",
        "contact_area": "contact_area", "max_penetration": "max_penetration"}


def bars(run, finer):
    """Complaints about printed error bars that do not hold the difference to a finer mesh at the same time, with that one's own bars."""
    found = []
    if finer.summary is None or not finer.summary.get("converged"):
        return [f"finer: exit {finer.code}: {finer.reason()[:200]}"] if finer.code not in (0, 4) else []
    if finer.summary["time"] != run.summary["time"]:
        return []  # one of the two has ended before the other: nothing is comparable
    mine, other = (r.summary.get("adaptation", {}).get("errors", {}) for r in (run, finer))
    for name, key in BARS.items():
        if mine.get(name) is None or key not in run.summary:
            continue
        off = float(np.max(np.abs(np.subtract(run.summary[key], finer.summary[key]))))
        bar = float(np.max(np.abs(mine[name]))) + (float(np.max(np.abs(other[name]))) if other.get(name) is not None else 0.0)
        rest = SAME * np.max(np.abs(run.vector(-1, "disp"))) if name == "max_penetration" else 0.0
        if off > bar + rest:
            found.append(f"bar of {name}: {run.summary[key]} +- {mine[name]}, a finer mesh has {finer.summary[key]}")
    return found


def bar_of_energy(run):
    """That of J [J]; 0 where there is none."""
    return (run.summary.get("results") or {}).get("energy_J", {}).get("error_bar") or 0.0


def estimate(run, finer):
    """Complaints about an estimated error in the energy norm against the change of J to a finer mesh. Where data jump between nodes both meshes
    solve other problems: that counts in J's bar alone, (10.7b) of theory.md."""
    told = (run.summary.get("error_estimate") or {}).get("energy_norm")
    if told is None or finer.code != 0:
        return []
    off = abs(run.summary["energy_J"] - finer.summary["energy_J"])
    change = math.sqrt(2 * off)
    norm = math.sqrt(run.summary["energy_norm_squared"])
    if all((r.summary.get("error_estimate") or {}).get("relative") == 0 for r in (run, finer)):
        return []  # both say that nothing is strained: what changes is rounding
    at_least = run.summary["error_estimate"].get("at_least")  # most of it is contact that the mesh misses
    if not at_least and change > NARROW * told + 1e-6 * norm and off > bar_of_energy(run) + bar_of_energy(finer):
        return [f"estimated error {told:.3g} of {norm:.3g}; to a finer mesh J changes as by an error of {change:.3g}"]
    says_rounding = run.summary["error_estimate"].get("relative") == 0
    if told > norm and not says_rounding and told > WIDE * max(change, 1e-6 * norm):
        return [f"estimated error {told:.3g} is larger than the solution, {norm:.3g}; to a finer mesh J changes as by {change:.3g}"]
    return []


# --- what was asked for ------------------------------------------------------------------------------------------------------


def promises(case, run, rest=0.0):
    """Complaints about a run with exit 0 or 4 that has not kept what its deck asks for, and does not say so. @param rest  energy that is rounding"""
    found, adaptation = [], run.summary.get("adaptation")
    most = case.scene.more.get("Adapt", {}).get("Max Dofs")
    if adaptation:
        over = [c["dofs"] for c in adaptation["cycles"][1:] if c["dofs"] > most]
        if over:
            found.append(f"Max Dofs {most}, a mesh has {max(over)}")
        if run.code == 0 and not adaptation["reached"]:
            found.append("exit 0, target not reached")
    times = [step["time"] for step in run.step_summaries()]
    if run.code == 0 and case.scene.times and times != case.scene.times:
        found.append(f"steps at {times} instead of {case.scene.times}")
    if case.tolerance and run.code == 0:
        found += energy_tolerance(case, run, rest)
    if case.scene.times:
        found += memory(run)
    return found


def missed_shares(run, rest, overlaps=False):
    """[(time, parts, share)] of the largest energy before or after each step: by how much work and energies differ more after it.
    The first step of a body that the foundation overlaps at rest counts where that is asked for: no division balances it. @param rest  energy
    that is rounding"""
    keys = ("work", "strain_energy", "foundation_energy", "dissipated_energy")
    steps, shares = run.summary["steps"], []
    last = dict.fromkeys(("energy_imbalance", *keys), 0.0)
    rest += SAME * max(abs(step[key]) for step in steps for key in keys)
    for number, step in enumerate(steps):
        largest = max(abs(each[key]) for each in (step, last) for key in keys)
        off = max(0.0, abs(step["energy_imbalance"] - last["energy_imbalance"]) - rest)
        if largest > 0 and (overlaps or number > 0 or step["max_initial_penetration"] == 0):
            shares.append((step["time"], step["parts"], off / largest))
        last = step
    return shares


def energy_tolerance(case, run, rest):
    """Steps whose energies miss more than the deck allows, in a run that says nothing of it."""
    over = [(time, parts, share) for time, parts, share in missed_shares(run, rest) if share > case.tolerance * (1 + SPLIT)]
    return [f"t = {time:g}: Energy Tolerance {case.tolerance:.3g}, and {share:.3g} is left in {parts} parts, without a word" for time, parts, share in over[:1]]


def memory(run):
    """What never falls."""
    for key in ("max_dent", "dent_volume", "dissipated_energy"):
        values = [step[key] for step in run.summary["steps"]]
        for before, after in zip(values, values[1:]):
            if after < before * (1 - 1e-6) - 1e-300:
                return [f"{key} falls from {before!r} to {after!r}"]
    return []

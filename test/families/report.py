# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of measured scenes, the bars that they must stay under, and tables of both."""
import csv
import dataclasses
import math

import families
from suite.table import Table


@dataclasses.dataclass
class Bar:
    """A bound on a share of the scenes, at most 1, of the plane (2), of space (3) or of both."""

    what: str
    value: object  # of a Row; None: does not apply to it
    share: float
    bound: float
    dims: tuple = (2, 3)


def ratio(row):
    return row.ratio


def steps(row):
    return row.steps


def cold_steps(row):
    return row.cold_steps


def most_cg(row):
    return row.most_cg


STEP_BARS = [Bar("steps from a coarser mesh", steps, 0.5, 4), Bar("steps from a coarser mesh", steps, 0.95, 12),
             Bar("steps from a coarser mesh", steps, 1.0, 60), Bar("cold steps", cold_steps, 0.5, 9),
             Bar("cold steps", cold_steps, 0.95, 25), Bar("cold steps", cold_steps, 1.0, 60)]
TIME_BARS = [Bar("contact over elastic solve", ratio, 0.5, 1.5, (2,)), Bar("contact over elastic solve", ratio, 0.9, 2.5, (2,)),
             Bar("contact over elastic solve", ratio, 1.0, 6.0, (2,)), Bar("contact over elastic solve", ratio, 0.5, 2.5, (3,))]
HARD_BARS = [Bar("steps", steps, 1.0, 25), Bar("CG iterations of a solve", most_cg, 1.0, 60)]
HARD_TIME_BARS = [Bar("contact over elastic solve", ratio, 0.5, 1.6), Bar("contact over elastic solve", ratio, 0.95, 3),
                  Bar("contact over elastic solve", ratio, 1.0, 6)]
FRICTION_BARS = [Bar("steps from a coarser mesh", steps, 0.5, 6), Bar("steps from a coarser mesh", steps, 0.95, 15),
                 Bar("steps from a coarser mesh", steps, 1.0, 60)]
FRICTION_TIME_BARS = [Bar("contact over elastic solve", ratio, 0.5, 2.5), Bar("contact over elastic solve", ratio, 0.95, 5)]
LEAST = 0.6  # share of the scenes: the suite is about those


@dataclasses.dataclass
class Wanted:
    """What a share of the scenes, at least, must have."""

    what: str
    has: object  # of a Row: whether it has
    share: float = LEAST


def three_states(row):
    return row.states == 3


def sticks_and_slips(row):
    return row.sticks_and_slips


THREE_STATES = Wanted("all three states", three_states)
STICK_AND_SLIP = Wanted("stick and slip", sticks_and_slips)
FIELDS = ["number", "family", "dim", "element", "dofs", "points", "open", "closed", "yielding", "sticks", "slips", "seconds", "elastic_seconds", "ratio",
          "steps", "cold_steps", "levels", "cg", "elastic_cg", "most_cg", "setups", "residual", "at_rounding", "failure"]


def quantile(values, share):
    """The least value that a share of all does not exceed; None of none."""
    return sorted(values)[max(math.ceil(share * len(values) - 1e-9), 1) - 1] if values else None


def values_of(rows, value):
    return [v for v in map(value, rows) if v is not None]


def name_of_share(share):
    return {0.5: "median", 1.0: "worst"}.get(share, "%g %%" % (100 * share))


def name_of_dims(dims):
    return {(2,): "plane", (3,): "space"}.get(dims, "both")


def short(value, digits="%.2f"):
    return "" if value is None else "-" if math.isinf(value) else digits % value


def three(rows, value, shares, digits):
    return " / ".join(short(quantile(values_of(rows, value), share), digits) for share in shares)


def span(values):
    values = [v for v in values if v]
    return f"{min(values)}-{max(values)}" if values else ""


def cells(rows, elastic, friction):
    finite = [row for row in rows if math.isfinite(row.cg)]
    states = [sum(row.states == n for row in rows) for n in (3, 2, 1)]
    times = [three(rows, ratio, (0.5, 0.9, 1.0), "%.2f")] if elastic else []
    cg = [short(sum(r.cg for r in finite) / max(sum(r.elastic_cg for r in finite), 1), "%.1f")] if elastic else []
    rubbing = [sum(row.sticks_and_slips for row in rows)] if friction else []
    return [len(rows), span(r.dofs for r in rows), span(r.points for r in rows), " ".join(map(str, states)), *rubbing, *times,
            three(rows, steps, (0.5, 0.95, 1.0), "%.0f"), three(rows, cold_steps, (0.5, 0.95, 1.0), "%.0f"), *cg,
            short(max(r.most_cg for r in rows), "%.0f"), short(max(r.setups for r in rows), "%.0f"), "%.0e" % max(r.residual for r in rows),
            sum(bool(r.at_rounding) for r in rows), sum(bool(r.failure) for r in rows)]


def family_table(rows, note, elastic=True, names=families.FAMILIES, friction=False):
    rubbing = ["with stick and slip"] if friction else []
    times, cg = (["ratio: median / 90 % / worst"], ["CG over elastic"]) if elastic else ([], [])
    table = Table("Families of random scenes", note,
                  ["family", "scenes", "dofs", "contact points", "with 3, 2, 1 states", *rubbing, *times, "steps: median / 95 % / worst",
                   "cold: median / 95 % / worst", *cg, "CG of a solve, worst", "set-ups, worst", "residual, worst", "at rounding", "failed"])
    groups = {name: [r for r in rows if r.family == name] for name in names}
    groups.update({"plane": [r for r in rows if r.dim == 2], "space": [r for r in rows if r.dim == 3], "all": rows})
    for name, mine in groups.items():
        if mine:
            table.add(name, *cells(mine, elastic, friction))
    return table


def bar_table(rows, bars, wanted=(THREE_STATES,)):
    table = Table("Bars of the families", "Scenes that have no number, since their runs failed or ran out of time, stand above all "
                  "bounds. From a coarser mesh: scenes that have one.", ["", "bodies", "share", "scenes", "at most", "measured", ""])
    for bar in bars:
        mine = values_of([row for row in rows if row.dim in bar.dims], bar.value)
        measured = quantile(mine, bar.share)
        if mine:
            table.add(bar.what, name_of_dims(bar.dims), name_of_share(bar.share), len(mine), "%g" % bar.bound, short(measured),
                      table.check(measured <= bar.bound))
    failed = sum(bool(row.failure) for row in rows)
    table.add("scenes not solved, or with a residual above 1e-8", "both", "", len(rows), 0, failed, table.check(failed == 0))
    for each in wanted:
        full, least = sum(map(each.has, rows)), math.floor(each.share * len(rows))
        table.add(f"scenes with {each.what}, at least", "both", "", len(rows), least, full, table.check(full >= least))
    return table


def write_csv(rows, path):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(FIELDS)
        writer.writerows([getattr(row, name) for name in FIELDS] for row in rows)

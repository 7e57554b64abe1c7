# SPDX-License-Identifier: BSD-3-Clause
"""The load steps of one or several runs as a diagram: force against displacement, of friction too, and the energies of a single run."""
import itertools

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from curves import RC  # noqa: E402
from result import PictureError  # noqa: E402
from style import LIGHT  # noqa: E402
from table import require_same_units  # noqa: E402

ENERGIES = (("dissipated_energy", "dissipated"), ("strain_energy", "elastic, in the body"), ("foundation_energy", "elastic, in the foundation"))
WITH_FRICTION = (("dissipated_by_friction", "dissipated by friction"), ("dissipated_energy", "dissipated by yielding"), *ENERGIES[1:])
ROUNDING = 1e-6  # of the contact force: less is no friction, and of those of several sides no sum
OF_SIDE = "_contact_force_"


class History:
    """What load steps tell: the columns of a table, {name: [number of each step]}, and units."""

    def __init__(self, table):
        needed = ("time", "work", "contact_force_x", *(name for name, _ in ENERGIES))
        missing = [name for name in needed if name not in table.columns]
        if missing:
            raise PictureError(f'"{table.path}" has no column {missing[0]}; remedy: run this version of rpc again')
        self.label = table.label
        self.columns = {name: values.tolist() for name, values in table.columns.items() if name != "reason"}
        plane = "contact_length" in self.columns
        self.force_unit = table.units.get("contact_force_x", "N/m" if plane else "N")
        self.energy_unit = table.units.get("work", "J/m" if plane else "J")
        self.length_unit = table.units.get("max_dent", "m")
        self.sides = [name.removesuffix(f"{OF_SIDE}x") for name in self.columns if name.endswith(f"{OF_SIDE}x")]
        self.axis = max((axis for axis in "xyz" if f"contact_force_{axis}" in self.columns), key=self.largest)
        self.force = self.columns[f"contact_force_{self.axis}"]
        self.sign = 1 if sum(self.force) >= 0 else -1

    def largest(self, axis):
        """The largest force along an axis, of a single side or of all together."""
        return max(reach(self.columns[f"contact_force_{axis}"]), *(reach(self.columns[f"{side}{OF_SIDE}{axis}"]) for side in self.sides), 0)

    def curves(self):
        """[(label, [force of each step])] along the axis: all sides together, unless their forces cancel, and each of several sides. A
        curve is positive in the mean. Sides of the same forces, as of two plates, share one."""
        found = [(side, upwards(self.columns[f"{side}{OF_SIDE}{self.axis}"])) for side in self.sides]
        if not found or reach(self.force) > ROUNDING * self.largest(self.axis):
            found.insert(0, ("all sides" if found else "", upwards(self.force)))
        curves = []
        for name, force in found:
            same = next((curve for curve in curves if reach([a - b for a, b in zip(curve[1], force)]) <= ROUNDING * self.largest(self.axis)), None)
            if same:
                same[0].append(name)
            else:
                curves.append(([name], force))
        return [(": ".join(filter(None, (self.label, ", ".join(names)))), force) for names, force in curves]

    def moved(self, axis=None):
        """The prescribed displacement along the contact force, or along another axis, that changes most; None if none does. Positive
        where it goes against the foundation's force on the body."""
        axis, sign = (axis, -1) if axis else (self.axis, self.sign)
        held = [name for name in self.columns if name.endswith(f"_displacement_{axis}")]
        found = [name for name in held if reach(self.columns.get(name.replace("_displacement_", "_reaction_"), [1])) > 0]  # 0: it is free along the axis
        most = max(found, key=lambda name: spread(self.columns[name]), default=None)
        if most is None or spread(self.columns[most]) == 0:
            return None
        if most.startswith("obstacle_displacement"):
            sign = -sign  # the obstacle presses the body, which a side does from behind
        return [-sign * value for value in self.columns[most]]

    def shear(self):
        """The axis along the foundation with the largest force of friction; None if there is none."""
        if "dissipated_by_friction" not in self.columns:
            return None
        others = [axis for axis in "xyz" if axis != self.axis and f"contact_force_{axis}" in self.columns]
        most = max(others, key=lambda axis: reach(self.columns[f"contact_force_{axis}"]))
        return most if reach(self.columns[f"contact_force_{most}"]) > ROUNDING * self.largest(self.axis) else None


def upwards(force):
    """A force with the sign that makes it positive in the mean."""
    return force if sum(force) >= 0 else [-value for value in force]


def reach(values):
    """The largest size."""
    return max(abs(value) for value in values)


def spread(values):
    """Largest less least value, 0 included: bodies start at rest."""
    return max(*values, 0) - min(*values, 0)


def compose(tables, style=LIGHT):
    """The diagram as a figure. @param tables  [table.Table] of load steps"""
    histories = [History(table) for table in tables]
    require_same_units(tables, ("contact_force_x", "work", "max_dent"))
    alone = len(histories) == 1
    sheared = len({history.shear() for history in histories} - {None}) == 1
    number = 1 + sheared + alone
    with plt.rc_context({**RC, **style.rc()}):
        figure, panels = plt.subplots(1, number, figsize=((7.5, 10, 14)[number - 1], 4), layout="constrained", squeeze=False)
        add_forces(panels[0][0], histories, style)
        if sheared:
            add_loop(panels[0][1], histories, style)
        if alone:
            add_energies(panels[0][-1], histories[0], style)
        for axes in panels[0]:
            axes.locator_params(axis="x", nbins=6, steps=[1, 2, 5, 10])  # numbers that do not meet
    return figure


def add_forces(axes, histories, style):
    """Force against displacement, or against t where no displacement is prescribed along it."""
    by_time = any(history.moved() is None for history in histories)
    first = histories[0]
    curves = [(history, *curve) for history in histories for curve in history.curves()]
    for (history, label, force), look in zip(curves, itertools.cycle(style.curves)):
        along = history.columns["time"] if by_time else [0, *history.moved()]
        axes.plot(along, force if by_time else [0, *force], **{"markersize": 5, **look}, linewidth=1.4, label=label or None)
    axes.set(xlabel="t" if by_time else f"prescribed displacement [{first.length_unit}]", ylabel=f"contact force [{first.force_unit}]",
             ylim=(0, None))
    if any(label for _, label, _ in curves):
        axes.legend(frameon=False)


def add_loop(axes, histories, style):
    """Force of friction, of the body on the foundation, against the displacement along it, or against t where none is prescribed."""
    axis = next(history.shear() for history in histories if history.shear())
    by_time = any(history.moved(axis) is None for history in histories)
    first = histories[0]
    for history, look in zip(histories, style.curves):
        along = history.columns["time"] if by_time else history.moved(axis)
        force = [-value for value in history.columns[f"contact_force_{axis}"]]
        axes.plot([0, *along], [0, *force], **{"markersize": 5, **look}, linewidth=1.4, label=history.label or None)
    axes.axhline(0, color=style.faint, lw=0.8)
    axes.set(xlabel="t" if by_time else f"prescribed displacement in {axis} [{first.length_unit}]",
             ylabel=f"friction in {axis}, on the foundation [{first.force_unit}]")
    if any(history.label for history in histories):
        axes.legend(frameon=False)


def add_energies(axes, history, style):
    """What has become of the work, one energy upon the other."""
    rest = [0.0] * (history.columns["time"][0] > 0)  # the body is at rest at t = 0
    time = rest + history.columns["time"]
    known = WITH_FRICTION if "dissipated_by_friction" in history.columns else ENERGIES
    shown = [entry for entry in known if reach(history.columns[entry[0]]) > 0]
    if shown:
        axes.stackplot(time, [rest + history.columns[name] for name, _ in shown], labels=[label for _, label in shown],
                       colors=[style.energies[name] for name, _ in shown], alpha=0.75)
    axes.plot(time, rest + history.columns["work"], "--", color=style.text, lw=1.2, label="work")
    axes.set(xlabel="t", ylabel=f"energy since the start [{history.energy_unit}]", xlim=(min(time), max(time) if len(time) > 1 else None))
    axes.legend(frameon=False, loc="upper left")

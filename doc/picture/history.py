# SPDX-License-Identifier: BSD-3-Clause
"""The load steps of one or several runs as a diagram: force against displacement, of friction too, and the energies of a single run."""
import csv
import io
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from result import PictureError  # noqa: E402

DPI = 140
SUFFIX = ".history.csv"
HEADING = re.compile(r"(.*?)(?: \[([^\]]*)\])?", re.DOTALL)  # name and unit of a column
STYLE = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3}
COLOURS = ("#1b6ca8", "#d1495b", "#2e933c", "#8d6a9f", "#c77d0a", "0.3")
ENERGIES = (("dissipated_energy", "dissipated", "#d1495b"), ("strain_energy", "elastic, in the body", "#1b6ca8"),
            ("foundation_energy", "elastic, in the foundation", "#8fbfdc"))
WITH_FRICTION = (("dissipated_by_friction", "dissipated by friction", "#e9a03b"), ("dissipated_energy", "dissipated by yielding", "#d1495b"),
                 *ENERGIES[1:])
ROUNDING = 1e-6  # of the contact force: less is no friction


class History:
    """The columns of a file, {name: [number of each step]}, and their units where these are not m and N, {name: unit}."""

    def __init__(self, path):
        try:
            with open(path, newline="") as file:
                rows = [row for row in csv.DictReader(file) if row.get("converged") != "0"]  # of a step that failed there are no numbers
            headings = {heading: HEADING.fullmatch(heading).groups() for heading in rows[0] if heading != "reason"}
            self.columns = {name: [float(row[heading]) for row in rows] for heading, (name, _) in headings.items()}
            units = {name: unit for name, unit in headings.values() if unit}
        except OSError:
            raise PictureError(f'"{path}": no such file; rpc writes one for decks with Steps->Times') from None
        except (ValueError, TypeError, KeyError, IndexError, csv.Error, UnicodeDecodeError):
            raise PictureError(f'"{path}" is no table of numbers, or an empty one') from None
        missing = [name for name in ("time", "work", "contact_force_x", *(name for name, _, _ in ENERGIES)) if name not in self.columns]
        if missing:
            raise PictureError(f'"{path}" has no column {missing[0]}; remedy: run this version of rpc again')
        plane = "contact_length" in self.columns
        self.force_unit = units.get("contact_force_x", "N/m" if plane else "N")
        self.energy_unit = units.get("work", "J/m" if plane else "J")
        self.length_unit = units.get("max_dent", "m")
        self.axis = max((axis for axis in "xyz" if f"contact_force_{axis}" in self.columns),
                        key=lambda axis: reach(self.columns[f"contact_force_{axis}"]))
        self.force = self.columns[f"contact_force_{self.axis}"]
        self.sign = 1 if sum(self.force) >= 0 else -1

    def moved(self, axis=None):
        """The prescribed displacement along the contact force, or along another axis, that changes most; None if none does. Positive
        where it goes against the foundation's force on the body."""
        axis, sign = (axis, -1) if axis else (self.axis, self.sign)
        found = [name for name in self.columns if name.endswith(f"_displacement_{axis}")]
        most = max(found, key=lambda name: spread(self.columns[name]), default=None)
        if most is None or spread(self.columns[most]) == 0:
            return None
        return [-sign * value for value in self.columns[most]]

    def shear(self):
        """The axis along the foundation with the largest force of friction; None if there is none."""
        if "dissipated_by_friction" not in self.columns:
            return None
        others = [axis for axis in "xyz" if axis != self.axis and f"contact_force_{axis}" in self.columns]
        most = max(others, key=lambda axis: reach(self.columns[f"contact_force_{axis}"]))
        return most if reach(self.columns[f"contact_force_{most}"]) > ROUNDING * reach(self.force) else None


def require_same_units(first, other, path):
    """@param path  of the other one"""
    wanted, found = ((history.length_unit, history.force_unit) for history in (first, other))
    if found != wanted:
        raise PictureError(f'"{path}": results that are compared must have the same units, got {", ".join(found)} and '
                           f'{", ".join(wanted)} of the first one')


def reach(values):
    """The largest size."""
    return max(abs(value) for value in values)


def spread(values):
    """Largest less least value, 0 included: bodies start at rest."""
    return max(*values, 0) - min(*values, 0)


def draw(files):
    """The diagram as the bytes of a PNG. @param files [(label, path)]; a label may be empty"""
    histories = [(label, History(path)) for label, path in files]
    for (_, path), (_, other) in zip(files, histories):
        require_same_units(histories[0][1], other, path)
    with plt.rc_context(STYLE):
        figure = compose(histories)
        file = io.BytesIO()
        figure.savefig(file, format="png", dpi=DPI)
        plt.close(figure)
    return file.getvalue()


def compose(histories):
    """The diagram as a figure. @param histories  [(label, History)]"""
    alone = len(histories) == 1
    sheared = len({history.shear() for _, history in histories} - {None}) == 1
    number = 1 + sheared + alone
    figure, panels = plt.subplots(1, number, figsize=((7.5, 10, 14)[number - 1], 4), layout="constrained", squeeze=False)
    add_forces(panels[0][0], histories)
    if sheared:
        add_loop(panels[0][1], histories)
    if alone:
        add_energies(panels[0][-1], histories[0][1])
    return figure


def add_forces(axes, histories):
    """Force against displacement, or against t where no displacement is prescribed along it."""
    by_time = any(history.moved() is None for _, history in histories)
    first = histories[0][1]
    for (label, history), colour in zip(histories, COLOURS):
        along = history.columns["time"] if by_time else [0, *history.moved()]
        force = [history.sign * value for value in history.force]
        axes.plot(along, force if by_time else [0, *force], ".-", ms=5, lw=1.4, color=colour, label=label)
    axes.set(xlabel="t" if by_time else f"prescribed displacement [{first.length_unit}]", ylabel=f"contact force [{first.force_unit}]",
             ylim=(0, None))
    if any(label for label, _ in histories):
        axes.legend(frameon=False)


def add_loop(axes, histories):
    """Force of friction, of the body on the foundation, against the displacement along it, or against t where none is prescribed."""
    axis = next(history.shear() for _, history in histories if history.shear())
    by_time = any(history.moved(axis) is None for _, history in histories)
    first = histories[0][1]
    for (label, history), colour in zip(histories, COLOURS):
        along = history.columns["time"] if by_time else history.moved(axis)
        force = [-value for value in history.columns[f"contact_force_{axis}"]]
        axes.plot([0, *along], [0, *force], ".-", ms=5, lw=1.4, color=colour, label=label)
    axes.axhline(0, color="0.3", lw=0.8)
    axes.set(xlabel="t" if by_time else f"prescribed displacement in {axis} [{first.length_unit}]",
             ylabel=f"friction in {axis}, on the foundation [{first.force_unit}]")
    if any(label for label, _ in histories):
        axes.legend(frameon=False)


def add_energies(axes, history):
    """What has become of the work, one energy upon the other."""
    rest = [0.0] * (history.columns["time"][0] > 0)  # the body is at rest at t = 0
    time = rest + history.columns["time"]
    known = WITH_FRICTION if "dissipated_by_friction" in history.columns else ENERGIES
    shown = [entry for entry in known if reach(history.columns[entry[0]]) > 0]
    if shown:
        axes.stackplot(time, [rest + history.columns[name] for name, _, _ in shown], labels=[label for _, label, _ in shown],
                       colors=[colour for _, _, colour in shown], alpha=0.75)
    axes.plot(time, rest + history.columns["work"], "k--", lw=1.2, label="work")
    axes.set(xlabel="t", ylabel=f"energy since the start [{history.energy_unit}]", xlim=(min(time), max(time) if len(time) > 1 else None))
    axes.legend(frameon=False, loc="upper left")

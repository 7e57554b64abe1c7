# SPDX-License-Identifier: BSD-3-Clause
"""Reads the tables that rpc writes: RESULT.contact.csv along the contact sides, RESULT.history.csv of load steps, RESULT.points.csv at points,
and of RESULT.json that of the adapted meshes, or of the pressures' histogram."""
import csv
import os
import re

import numpy as np

import summary
from result import PictureError, suggestion

HEADING = re.compile(r"(.*?)(?: \[([^\]]*)\])?", re.DOTALL)  # name and unit of a column
KINDS = {"contact": ("pressure", "state", "u_nu"), "history": ("time", "work"), "points": ("time", "name", "number", "off")}  # columns that tell them
NAMES = {"contact": "*.contact.csv", "history": "*.history.csv", "points": "*.points.csv", "adaptation": "*.json of adapted meshes", "patches": "*.json"}
WORDS = ("state", "friction_state", "side", "reason", "name")  # columns that have no numbers
ORDERED = ("none", "open", "closed", "yielding", "unseen", "sticks", "slips")  # of categories
MOST_CATEGORIES = 12
RADIUS = "radius"
NEAR = 1e-6  # of the extent of a side: places are the same
# Names and units of columns where the headings have none; of history files {force}: N/m, {energy}: J/m in the plane.
MEANING = [
    ("[xyz]|off", "{0}", "m"), ("disp_([xyz])", "displacement in {1}", "m"), ("von_mises", "von Mises stress", "Pa"), ("contact_pressure|stress_.*", "{0}", "Pa"), ("s", "length along the surface", "m"), ("radius", "{radius}", "m"), ("area", "area of a point", "m^2"),
    ("u_nu", r"normal displacement $u_\nu$", "m"), ("pressure", "contact pressure", "Pa"), ("gap|dent|penetration", "{0}", "m"),
    ("friction", "friction", "Pa"), ("q_([xyz])", "friction in {1}", "Pa"), ("slip_([xyz])", "slip in {1}", "m"),
    ("u_t_([xyz])", "displacement along the side in {1}", "m"), ("force_([xyz])", "nodal force in {1}", "{force}"),
    ("friction_used", "friction over what it can be", ""), ("time", "t", ""), ("contact_force_([xyz])", "contact force in {1}", "{force}"),
    (".*_displacement_[xyz]|max_(displacement|penetration|dent|slip)", "{0}", "m"), (".*_reaction_[xyz]", "{0}", "{force}"),
    ("energy_J", "energy", "{energy}"), ("relative_estimate", "estimated relative error", ""), ("dofs", "degrees of freedom", ""), ("share_of_contact", "share of what is in contact", ""),
    ("max_(pressure|shear|von_mises)", "{0}", "Pa"), (".*_length", "{0}", "m"), (".*_area", "{0}", "m^2"),
    ("dent_volume", "{0}", "{volume}"), ("patches", "number of patches of contact", ""), ("largest_patch", "{0}", "{extent}"), ("mean_gap", "{0}", "m"), ("seconds", "wall-clock time", "s"),
    ("work|dissipated_by_friction|.*_energy|energy_imbalance", "{0}", "{energy}")]


class Table:
    """A file's columns, {name: (rows,) numbers or texts}, and their units where the headings have some, {name: unit}.

    kind    one of KINDS, "adaptation" or "patches"
    label   what a legend says of it
    target  of adapted meshes: that of the relative estimate; else None
    """

    def __init__(self, path, label=""):
        self.path, self.label, self.target = path, label, None
        if path.lower().endswith(".json"):
            self.kind = summary.kind_of(path)
            if self.kind == "patches":
                self.columns, self.units = summary.spread(path)
            else:
                self.columns, self.units, self.target = summary.meshes(path)
            return
        names, rows = self._read()
        self.kind = next((kind for kind, needed in KINDS.items() if set(needed) <= set(names)), None)
        if {"folder", "exit_code"} <= set(names):
            raise PictureError(f'"{path}" is the table of a study, whose columns go with its own parameters; remedy: draw its runs in one picture, '
                               f'{os.path.join(os.path.dirname(path), "run-*", "deck.contact.csv")}, or its columns as python/examples/yield_limit.py does')
        if not self.kind:
            raise PictureError(f'"{path}" is no table of rpc: it must have the columns {" or ".join(", ".join(some) for some in KINDS.values())}'
                               f'; those that can be drawn are *.contact.csv, *.history.csv and *.points.csv')
        if self.kind == "history" and "converged" in names:  # of a step that failed there are no numbers
            rows = [row for row in rows if row[names.index("converged")] != "0"]
        if not rows:
            raise PictureError(f'"{path}" has no rows' + (" of steps that have converged" if self.kind == "history" else "") +
                               ": there is nothing to draw")
        self.columns = {name: self._values(name, column) for name, column in zip(names, zip(*rows))}
        self._add_derived()

    def _read(self):
        """Names of the columns, and the rows as texts."""
        try:
            with open(self.path, newline="", encoding="utf-8") as file:
                lines = [row for row in csv.reader(file, strict=True) if row]
        except OSError as error:
            what = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
            raise PictureError(f'"{self.path}": {what}; rpc writes *.contact.csv where there is contact, '
                               "*.history.csv for decks with Steps->Times, and *.points.csv for those with Output->Points") from None
        except (csv.Error, UnicodeDecodeError) as error:
            raise PictureError(f'"{self.path}" is no table: {error}') from None
        if not lines:
            raise PictureError(f'"{self.path}" is empty')
        headings = [HEADING.fullmatch(heading).groups() for heading in lines[0]]
        for number, row in enumerate(lines[1:], 2):
            if len(row) != len(headings):
                raise PictureError(f'"{self.path}", row {number}: a row must have {len(headings)} entries, as many as there are columns, '
                                   f"got {len(row)}; remedy: run rpc again")
        self.units = {name: unit for name, unit in headings if unit}
        return [name for name, _ in headings], lines[1:]

    def _values(self, name, entries):
        """Of a column: numbers, or texts."""
        if name in WORDS:
            return np.array(entries, dtype=str)
        try:
            return np.array([float(entry) for entry in entries])
        except ValueError:
            wrong = next(entry for entry in entries if not is_number(entry))
            raise PictureError(f'"{self.path}", column {name}: entries must be numbers, got "{wrong[:40]}"; remedy: run rpc again') from None

    def _add_derived(self):
        """Columns that follow from others: penetration, size of the friction."""
        if self.kind != "contact":
            return
        for derived, needed, of in (("penetration", ("u_nu", "gap"), lambda u, gap: u - gap),
                                    ("friction", [f"q_{axis}" for axis in "xyz" if f"q_{axis}" in self.columns],
                                     lambda *q: np.sqrt(sum(part**2 for part in q)))):
            if needed and all(name in self.columns for name in needed):
                self.columns[derived] = of(*(self.columns[name] for name in needed))
                if needed[0] in self.units:
                    self.units[derived] = self.units[needed[0]]

    def is_text(self, name):
        """Whether a column is one of words, each of them a category."""
        return self.columns[name].dtype.kind == "U"

    def names(self, option="columns"):
        """Of all columns that an option can name."""
        more = [RADIUS] if option == "over" and self.kind == "contact" else []
        return [name for name in self.columns if name not in ("reason", "name") and (option != "over" or not self.is_text(name))] + more

    def column(self, name, option):
        """A column. @param option  that names it, without --"""
        names = self.names(option)
        if name in names:
            return self.columns[name]
        wanted = "a column of numbers" if option == "over" else "columns of the table"
        raise PictureError(f'"{self.path}": --{option} must name {wanted}, got "{name}"{suggestion(name, names)}; there are {", ".join(names)}')

    def radius_axes(self):
        """The axes across which --over=radius measures: all but the one along which the points that bear a pressure extend least."""
        axes = [axis for axis in "xyz" if axis in self.columns]
        bearing = self.columns["pressure"] > 0
        extents = [np.ptp(self.column(axis, "over")[bearing if bearing.any() else slice(None)]) for axis in axes]
        return [axis for k, axis in enumerate(axes) if k != int(np.argmin(extents))]

    def radius_centre(self, axes):
        """(axes,) where the radius is 0: in each direction the middle of what bears a pressure. Where that ends at one end of the side alone,
        or at both and one of them is 0, a plane of symmetry is taken to be there."""
        bearing = self.columns["pressure"] > 0
        bearing = bearing if bearing.any() else np.ones(len(bearing), dtype=bool)
        centre = []
        for axis in axes:
            side = self.column(axis, "over")
            pressed, near = side[bearing], NEAR * np.ptp(side)
            ends = [end for end, last in ((side.min(), pressed.min()), (side.max(), pressed.max())) if abs(end - last) <= near]
            planes = ends if len(ends) == 1 else [end for end in ends if abs(end) <= near]
            middle = planes[0] if planes else 0.5 * (pressed.min() + pressed.max())
            centre.append(0.0 if abs(middle) <= near else float(middle))
        return centre

    def name_of(self, name, axes="", centre=()):
        """What an axis says of a column. @param axes, centre  those of a radius"""
        plane = "contact_length" in self.columns
        # Contact sides of plane bodies and of those of revolution have the same columns.
        force = "N/m, of revolution N" if self.kind == "contact" and "area" not in self.columns else "N/m" if plane else "N"
        units = {"force": force, "energy": "J/m" if plane else "J", "volume": "m^2" if plane else "m^3", "extent": "m" if plane else "m^2"}
        away = [f"{axis} {'-' if at > 0 else '+'} {abs(at):.4g}" if at else axis for axis, at in zip(axes, centre or [0] * len(axes))]
        if len(axes) > 1:
            squares = " + ".join(f"({text})^2" if " " in text else f"{text}^2" for text in away)
            radius = rf"radius $\sqrt{{{squares}}}$"
        else:
            radius = f"radius |{''.join(away)}|"
        for pattern, text, unit in MEANING:
            match = re.fullmatch(pattern, name)
            if match:
                text = text.format(name, *match.groups(), radius=radius)
                text = "length along the line" if name == "s" and self.kind == "points" else text
                text = text if "$" in text else text.replace("_", " ")
                unit = self.units.get("x" if name == RADIUS else name, unit.format(**units))
                break
        else:
            text, unit = name.replace("_", " "), self.units.get(name)
        return f"{text} [{unit}]" if unit else text


def is_number(text):
    """Whether a text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def categories(tables, name):
    """The words of a column of texts, in their order."""
    found = list(dict.fromkeys(word for table in tables for word in table.columns[name].tolist()))
    if len(found) > MOST_CATEGORIES:
        raise PictureError(f'"{tables[0].path}": --columns must name columns of numbers, or of at most {MOST_CATEGORIES} words, '
                           f'got "{name}" with {len(found)}')
    return [word for word in ORDERED if word in found] + [word for word in found if word not in ORDERED]


def tables_of(arguments, most):
    """[Table] of files, each named FILE or LABEL=FILE; of one kind. @param most  files of one picture"""
    if len(arguments) > most:
        raise PictureError(f"at most {most} files go into one picture, got {len(arguments)}")
    named = [(text[: -len(path_of(text))].rstrip("="), path_of(text)) for text in arguments]
    if len(named) > 1:
        named = [(label or own, path) for (label, path), own in zip(named, own_names([path for _, path in named]))]
    tables = [Table(path, label) for label, path in named]
    for table in tables[1:]:
        if table.kind != tables[0].kind:
            raise PictureError(f'"{table.path}": files of one picture must be of one kind, got {NAMES[table.kind]} beside {NAMES[tables[0].kind]}')
    return tables


def require_same_units(tables, names):
    """Of columns that are drawn together."""
    for table in tables[1:]:
        for name in names:
            found, wanted = table.name_of(name), tables[0].name_of(name)
            if name in table.columns and found != wanted:
                raise PictureError(f'"{table.path}": files of one picture must have the same units, got {found} beside {wanted}')


def path_of(argument):
    """The file of FILE or LABEL=FILE."""
    return argument if os.path.isfile(argument) else argument.rsplit("=", 1)[-1]


def own_names(paths):
    """What tells files apart: their names without what all end in, or with their folders where names are the same."""
    shared = os.path.commonpath([os.path.dirname(os.path.abspath(path)) for path in paths])
    for names in ([os.path.basename(path) for path in paths], [os.path.relpath(path, shared) for path in paths]):
        stems = [re.sub(r"(\.contact|\.history|\.points)?\.(csv|json)$", "", name) for name in names]
        if len(set(stems)) == len(stems):
            return stems
    return paths

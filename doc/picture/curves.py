# SPDX-License-Identifier: BSD-3-Clause
"""Columns of tables over another one: pressures along contact sides, results of load steps, errors of adapted meshes."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import point_curves  # noqa: E402
from matplotlib import ticker  # noqa: E402

from result import PictureError  # noqa: E402
from table import RADIUS, categories, require_same_units  # noqa: E402

RC = {"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3}
WIDTH, PANEL, FLAT = 7.5, 2.6, 0.45  # inches: of the picture; height of a panel; of a panel for each category
MOST_PANELS = 8
MOST_MARKERS = 60  # of a curve that has them
LOGARITHMIC = ("dofs", "relative_estimate")
FROM_ZERO = ("pressure", "share_of_contact", "friction", "max_pressure", "friction_used")


def compose(tables, columns, over, span, style, centre=None, time=None):
    """A panel for each column, one above the other, as a figure.

    @param tables   [Table] of one kind
    @param columns  names; None: chosen
    @param over     name of the column to the right, or "radius"; None: chosen
    @param span     (least, largest) of it that is shown; None: all
    @param centre   where the radius is 0, a number for each of the directions across which it is measured; None: chosen
    @param time     of results at points: that of the rows; None: the last one
    """
    if tables[0].kind == "points":
        tables, over = point_curves.curves_of(tables, over, time, len(style.curves))
    columns = chosen_columns(tables) if columns is None else columns
    over = chosen_axis(tables[0]) if over is None else over
    if len(columns) > MOST_PANELS:
        raise PictureError(f"--columns must name at most {MOST_PANELS} columns, got {len(columns)}")
    axes_of_radius = tables[0].radius_axes() if over == RADIUS and tables[0].kind == "contact" else ()
    if centre is not None and len(centre) != len(axes_of_radius):
        where = f"must be {len(axes_of_radius)} number{'s' * (len(axes_of_radius) != 1)} of {' and '.join(axes_of_radius)}, across which the radius is measured"
        raise PictureError(f'"{tables[0].path}": --centre {where if axes_of_radius else "goes with --over=radius"}, got {len(centre)} number{"s" * (len(centre) != 1)}')
    if centre is None and axes_of_radius:
        centre = tables[0].radius_centre(axes_of_radius)
    along = [places(table, over, axes_of_radius, centre) for table in tables]
    require_something(tables, along, over, span)
    for table in tables:
        for name in columns:
            table.column(name, "columns")
    require_same_units(tables, [*columns, "x" if over == RADIUS else over])
    words = {name: categories(tables, name) for name in columns if any(table.is_text(name) for table in tables)}
    with plt.rc_context({**RC, **style.rc()}):
        heights = [0.5 + FLAT * len(words[name]) if name in words else PANEL for name in columns]
        figure, panels = plt.subplots(len(columns), 1, figsize=(WIDTH, sum(heights) + 0.9), layout="constrained", squeeze=False, sharex=True,
                                      height_ratios=heights)
        for name, panel in zip(columns, panels[:, 0]):
            for table, x, look in zip(tables, along, style.curves):
                add_curve(panel, table, x, name, words.get(name), look)
            finish(panel, tables[0], name, words.get(name))
            if name == "relative_estimate":
                add_targets(panel, tables, style)
        if over in LOGARITHMIC:
            panels[-1, 0].set_xscale("log")
        panels[-1, 0].set_xlabel(tables[0].name_of(over, axes_of_radius, centre))
        if span is not None:
            panels[-1, 0].set_xlim(span)
            for panel in panels[:, 0]:
                fit_height(panel, span)
        if any(table.label for table in tables):
            panels[0, 0].legend(frameon=False, markerscale=1.5, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=min(len(tables), 3))
    return figure


def chosen_columns(tables):
    """Of contact sides the pressure, or the dents where those alone are left, the friction, the state and what sticks; of load steps the contact force and the largest pressure; of adapted meshes
    the estimated error, of one mesh the shares of contact by pressure; at points the contact pressure and von Mises' stress."""
    names = [name for name in tables[0].names() if all(name in table.columns for table in tables)]
    if tables[0].kind == "contact":
        left = "dent" in names and any(table.columns["dent"].any() for table in tables) and not any(table.columns["pressure"].any() for table in tables)
        return [name for name in ("dent" if left else "pressure", "friction", "state", "friction_state") if name in names]
    if tables[0].kind == "points":
        return point_curves.chosen_columns(tables)
    if tables[0].kind in ("adaptation", "patches"):
        return ["relative_estimate" if tables[0].kind == "adaptation" else "share_of_contact"]
    return [name for name in names if name.startswith("contact_force_")] + [name for name in ("max_pressure",) if name in names]


def chosen_axis(table):
    """In the plane the length along the surface, or x where there are several; in space the radius; of load steps the time; of
    adapted meshes the number of degrees of freedom; of shares of contact the pressure."""
    if table.kind != "contact":
        return {"history": "time", "patches": "pressure"}.get(table.kind, "dofs")
    if "s" not in table.columns:
        return RADIUS
    return "s" if len(parts(table)) == 1 else "x"


def places(table, over, axes, centre):
    """(rows,) where points lie. @param axes, centre  of a radius"""
    if over == RADIUS and table.kind == "contact":
        found = np.sqrt(sum((table.column(axis, "over") - at) ** 2 for axis, at in zip(axes, centre)))
    else:
        found = table.column(over, "over")
    if not np.isfinite(found).all():
        raise PictureError(f'"{table.path}", column {over}: --over must name a column of finite numbers')
    return found


def require_something(tables, along, over, span):
    """Something must lie in the span."""
    low, high = min(x.min() for x in along), max(x.max() for x in along)
    if span is not None and not any(((x >= span[0]) & (x <= span[1])).any() for x in along):
        raise PictureError(f'"{tables[0].path}": --range must hold points of {over}, which goes from {low:g} to {high:g}, '
                           f"got {span[0]:g},{span[1]:g}")


def parts(table):
    """Slices of rows that follow each other on one contact side; of load steps all rows."""
    number = len(next(iter(table.columns.values())))
    if table.kind != "contact" or "s" not in table.columns:
        return [slice(0, number)]
    begins = np.diff(table.columns["s"]) <= 0
    if "side" in table.columns:
        begins |= table.columns["side"][1:] != table.columns["side"][:-1]
    ends = [0, *(np.flatnonzero(begins) + 1), number]
    return [slice(start, end) for start, end in zip(ends, ends[1:])]


def add_curve(panel, table, x, name, words, look):
    """One column of one table: a line, in space points."""
    values = table.columns[name]
    if words:
        values = np.array([words.index(str(value)) for value in values])
    in_space = table.kind == "contact" and "s" not in table.columns
    if in_space and "area" in table.columns and (table.columns["area"] > 0).any():
        kept = table.columns["area"] > 0
        x, values = x[kept], values[kept]
    for k, part in enumerate([slice(None)] if in_space else parts(table)):
        size = len(x[part])
        style = {**look, "label": None if k else table.label or None, "markersize": 3.5, "linewidth": 1.4}
        if in_space:
            style |= {"linestyle": "", "markersize": 2.5}
        elif words:
            style |= {"drawstyle": "steps-mid", "marker": ""}
        elif table.kind == "patches":
            style |= {"marker": ""}
        elif size > MOST_MARKERS and look["marker"] == ".":
            style |= {"marker": ""}
        else:
            style |= {"markevery": max(1, size // MOST_MARKERS * 4) if look["marker"] != "." else 1}
        panel.plot(x[part], values[part], **style)


def finish(panel, table, name, words):
    """Names of an axis upwards, and its numbers or categories."""
    panel.set_ylabel(table.name_of(name))
    if words:
        panel.set_yticks(range(len(words)), words)
        panel.set_ylim(-0.5, len(words) - 0.5)
        panel.set_ylabel(name.replace("_", " "))
        return
    if name in LOGARITHMIC:
        panel.set_yscale("log")
        return
    panel.yaxis.set_major_formatter(ticker.ScalarFormatter(useMathText=True))
    panel.ticklabel_format(axis="y", scilimits=(-3, 5))
    if name in FROM_ZERO and table.kind != "adaptation":
        most = np.nanmax(np.concatenate([[0], *(line.get_ydata() for line in panel.lines)]))
        panel.set_ylim(0, 1.05 * most or 1)


def add_targets(panel, tables, style):
    """Where runs would have ended."""
    for target in sorted({table.target for table in tables}):
        panel.axhline(target, color=style.faint, linestyle="--", linewidth=0.9)
        panel.annotate(f"target {target:g}", (1, target), xycoords=("axes fraction", "data"), xytext=(0, 2), textcoords="offset points",
                       ha="right", va="bottom", fontsize=9, color=style.faint)


def fit_height(panel, span):
    """Shows what lies in the span as high as there is room; categories and what begins at 0 as before."""
    if panel.get_yticklabels() and isinstance(panel.yaxis.get_major_locator(), ticker.FixedLocator):
        return
    shown = [np.asarray(line.get_ydata())[(line.get_xdata() >= span[0]) & (line.get_xdata() <= span[1])] for line in panel.lines]
    shown = np.concatenate(shown)
    shown = shown[np.isfinite(shown)]
    if not len(shown) or np.ptp(shown) == 0:
        return
    if panel.get_yscale() == "log":
        panel.set_ylim(0.8 * shown.min(), 1.25 * shown.max())
        return
    margin = 0.05 * np.ptp(shown)
    bottom = 0 if panel.get_ylim()[0] == 0 else shown.min() - margin
    panel.set_ylim(bottom, shown.max() + margin)

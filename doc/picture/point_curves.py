# SPDX-License-Identifier: BSD-3-Clause
"""Results at points, RESULT.points.csv: a curve for each line over its length, or for each point over time."""
import copy

import numpy as np

from result import PictureError

COORDINATES = ("time", "number", "x", "y", "z", "s", "off")
FIRST_CHOICE = ("contact_pressure", "von_mises")


def curves_of(tables, over, time, most):
    """([Table], name of the column to the right): of files of points one table for each curve.

    @param over  that name; None: chosen, the length along lines, or the time where there are single points alone
    @param time  of the rows to draw; None: the last one. No matter over time
    @param most  curves of one picture
    """
    if over is None:
        lines = any(np.ptp(table.columns["s"]) > 0 for table in tables)
        over = "s" if lines or all(len(np.unique(table.columns["time"])) == 1 for table in tables) else "time"
    if over == "time" and time is not None:
        raise PictureError(f'"{tables[0].path}": --time does not go with --over=time')
    curves = [curve for table in tables for curve in (over_time(table) if over == "time" else at_time(table, time))]
    if len(curves) > most:
        raise PictureError(f'"{tables[0].path}": at most {most} curves go into one picture, got {len(curves)}, one for each '
                           f'{"point" if over == "time" else "entry of Output->Points"}; run rpc with fewer of them')
    if len(curves) == 1 and len(tables) == 1:
        curves[0].label = ""
    return curves, over


def at_time(table, time):
    """Rows of one time, for each entry of the deck."""
    times = np.unique(table.columns["time"])
    time = times[-1] if time is None else time
    at = times[np.argmin(np.abs(times - time))]
    if abs(at - time) > 1e-9 * max(1.0, abs(time)):
        raise PictureError(f'"{table.path}": --time must be one of {", ".join(f"{t:g}" for t in times[:20])}'
                           f'{", ..." if len(times) > 20 else ""}, got {time:g}')
    rows = table.columns["time"] == at
    return [part_of(table, rows & (table.columns["name"] == name), str(name)) for name in dict.fromkeys(table.columns["name"][rows].tolist())]


def over_time(table):
    """Rows of one point, for each point."""
    keys = list(dict.fromkeys(zip(table.columns["name"].tolist(), table.columns["number"].tolist())))
    several = {name for name, _ in keys if sum(other == name for other, _ in keys) > 1}
    return [part_of(table, (table.columns["name"] == name) & (table.columns["number"] == number),
                    f"{name} {number:g}" if name in several else name) for name, number in keys]


def part_of(table, rows, label):
    """Some rows, as a table of their own."""
    part = copy.copy(table)
    part.columns = {name: column[rows] for name, column in table.columns.items()}
    part.label = f"{table.label}: {label}" if table.label else label
    return part


def chosen_columns(tables):
    """The contact pressure where a point lies on a contact side, and von Mises' stress."""
    known = [name for name in FIRST_CHOICE if all(name in table.columns for table in tables)]
    finite = [name for name in known if any(np.isfinite(table.columns[name]).any() for table in tables)]
    return finite or [name for name in tables[0].columns if name not in COORDINATES and not tables[0].is_text(name)][:1]

# SPDX-License-Identifier: BSD-3-Clause
"""Cost of contact over the number of contact points: python3 plot.py families.csv writes families.png beside it."""
import csv
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402, after the choice of the backend

STYLES = {"2": {"color": "C0", "marker": "o", "label": "plane"}, "3": {"color": "C3", "marker": "s", "label": "space"}}
PICTURES = (("ratio", "contact over elastic solve, whole process", True), ("steps", "steps from a coarser mesh", True),
            ("cold_steps", "steps, cold", True))


def number(text):
    return float(text) if text else math.nan


def main(path):
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if int(row["points"])]
    figure, axes = pyplot.subplots(1, len(PICTURES), figsize=(3.6 * len(PICTURES), 3.3), constrained_layout=True)
    for axis, (key, label, logarithmic) in zip(axes, PICTURES):
        for dim, style in STYLES.items():
            points = [(int(row["points"]), number(row[key])) for row in rows if row["dim"] == dim]
            points = [point for point in points if math.isfinite(point[1])]
            axis.plot(*zip(*points) if points else ([], []), linestyle="", markersize=3, **style)
        axis.set_xscale("log")
        if logarithmic:
            axis.set_yscale("log")
        axis.set_xlabel("contact points", fontsize=8)
        axis.set_ylabel(label, fontsize=8)
        for direction in (axis.xaxis, axis.yaxis):
            direction.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
            direction.set_major_formatter(ticker.FuncFormatter(lambda value, _: "%g" % value))
            direction.set_minor_formatter(ticker.NullFormatter())
        axis.tick_params(labelsize=7, which="both")
        axis.grid(True, which="both", linewidth=0.3)
    axes[0].legend(fontsize=8)
    figure.savefig(os.path.splitext(path)[0] + ".png", dpi=80)


if __name__ == "__main__":
    main(*sys.argv[1:])

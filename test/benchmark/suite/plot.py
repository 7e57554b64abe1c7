# SPDX-License-Identifier: BSD-3-Clause
"""Error over run time, log-log, a picture for each scene: python3 plot.py accuracy.csv writes accuracy.png beside it."""
import csv
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402, after the choice of the backend

COLORS = {"P1": "C0", "Q1": "C1", "P2": "C2", "Q2": "C3"}
STYLES = {"uniform": {"linestyle": "-", "marker": "o", "markersize": 3, "linewidth": 1},
          "gmsh": {"linestyle": "-", "marker": "o", "markersize": 3, "linewidth": 1},
          "graded": {"linestyle": "--", "marker": "s", "markersize": 3, "linewidth": 1},
          "adaptive": {"linestyle": "-", "marker": "D", "markersize": 5, "linewidth": 2.5, "zorder": 4}}
PEER_STYLES = ({"linestyle": ":", "marker": "x", "color": "black"}, {"linestyle": ":", "marker": "+", "color": "gray"})
COLUMNS = 3


def read(path):
    """{scene: {(mesh, element): [(seconds, error)]}}, {scene: error that the reference's tolerance allows}."""
    scenes, allowed = {}, {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            lines = scenes.setdefault(row["scene"], {})
            point = float(row["whole process [s]"]), float(row["error"])
            lines.setdefault((row["mesh"], row["element"]), []).append(point)
            allowed[row["scene"]] = float(row["error allowed by the reference"])
    return scenes, allowed


def styles(scenes):
    """{(mesh, element): style}; meshes without a style of their own are peers."""
    keys = list(dict.fromkeys(key for lines in scenes.values() for key in lines))
    names = list(dict.fromkeys(mesh for mesh, _ in keys if mesh not in STYLES))
    peers = {name: {**PEER_STYLES[k % len(PEER_STYLES)], "markersize": 5, "linewidth": 1} for k, name in enumerate(names)}
    return {(mesh, element): peers[mesh] if mesh in peers else {**STYLES[mesh], "color": COLORS[element]}
            for mesh, element in keys}


def labels(keys):
    """{(mesh, element): label}, one for each style: uniform boxes and gmsh's own meshes share theirs."""
    names = {}
    for mesh, element in sorted(keys, key=lambda key: (list(STYLES).index(key[0]) if key[0] in STYLES else len(STYLES), key[1])):
        if mesh not in STYLES:
            names[mesh, element] = mesh
        elif mesh != "gmsh" or ("uniform", element) not in keys:
            names[mesh, element] = "%s, %s" % (element, "uniform, gmsh" if mesh == "uniform" else mesh)
    return names


def draw(axis, scene, lines, allowed, style):
    for key, points in lines.items():
        axis.loglog(*zip(*points), **style[key])
    bottom, top = axis.get_ylim()
    bottom = min(bottom, allowed / 1.5)
    axis.axhspan(bottom, allowed, color="0.88", zorder=0)
    axis.set_ylim(bottom, top)
    axis.set_title(scene, fontsize=9)
    axis.set_xlabel("whole process [s]", fontsize=8)
    axis.set_ylabel("error in the energy norm", fontsize=8)
    span = math.log10(axis.get_xlim()[1] / axis.get_xlim()[0])
    axis.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0) if span < 2.5 else (1.0,)))
    axis.xaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: "%g" % value))
    axis.yaxis.set_major_locator(ticker.LogLocator())
    axis.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: "%g %%" % (100 * value)))
    for direction in (axis.xaxis, axis.yaxis):
        direction.set_minor_formatter(ticker.NullFormatter())
    axis.tick_params(labelsize=7, which="both")
    axis.grid(True, which="both", linewidth=0.3)


def main(path):
    scenes, allowed = read(path)
    style = styles(scenes)
    rows = len(scenes) // COLUMNS + 1  # the last place is the legend's
    figure, axes = pyplot.subplots(rows, COLUMNS, figsize=(3.6 * COLUMNS, 3.3 * rows), constrained_layout=True, squeeze=False)
    places = list(axes.flat)
    for axis, (scene, lines) in zip(places, scenes.items()):
        draw(axis, scene, lines, allowed[scene], style)
    for axis in places[len(scenes):]:
        axis.axis("off")
    handles = [pyplot.Line2D([], [], **style[key], label=label) for key, label in labels(style).items()]
    handles.append(pyplot.Rectangle((0, 0), 1, 1, color="0.88", label="less than the reference tells"))
    places[-1].legend(handles=handles, loc="center", fontsize=8, ncol=2)
    figure.savefig(os.path.splitext(path)[0] + ".png", dpi=80)


if __name__ == "__main__":
    main(*sys.argv[1:])

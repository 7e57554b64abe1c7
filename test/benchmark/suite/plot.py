"""Error over run time, log-log, a picture for each scene: python3 plot.py accuracy.csv writes accuracy.png beside it."""
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402, after the choice of the backend

COLORS = {"P1": "C0", "Q1": "C1", "P2": "C2", "Q2": "C3"}


def main(path):
    scenes = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            lines = scenes.setdefault(row["scene"], {})
            lines.setdefault((row["element"], row["mesh"]), []).append((float(row["whole process [s]"]), float(row["error"])))
    figure, axes = pyplot.subplots(1, len(scenes), figsize=(3.4 * len(scenes), 3.2), constrained_layout=True, squeeze=False)
    for axis, (scene, lines) in zip(axes[0], scenes.items()):
        for (element, mesh), points in lines.items():
            axis.loglog(*zip(*points), "o-" if mesh == "box" else "s--", color=COLORS[element], markersize=3, linewidth=1,
                        label="%s, %s" % (element, mesh))
        axis.set_title(scene, fontsize=9)
        axis.set_xlabel("whole process [s]", fontsize=8)
        axis.tick_params(labelsize=7, which="both")
        axis.grid(True, which="both", linewidth=0.3)
        axis.legend(fontsize=6)
    axes[0][0].set_ylabel("relative error", fontsize=8)
    figure.savefig(os.path.splitext(path)[0] + ".png", dpi=80)


if __name__ == "__main__":
    main(*sys.argv[1:])

# SPDX-License-Identifier: BSD-3-Clause
"""Pressure over the distance from the axis of input/ball.xml, rigid and with xi = 100, beside Hertz's: ball_pressure.py OUT.png RIGID YIELDING

RIGID and YIELDING are the folders of the results. Hertz's radius and largest pressure follow from the force: a^3 = 3 F R / (4 E*),
p0 = 3 F / (2 pi a^2).
"""
import csv
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

RADIUS, MODULUS = 1.0, 2000 / (1 - 0.3**2)  # R, E* of a ball on a rigid half space


def points(folder):
    """(r, p) of the contact points, those without weight left out."""
    with open(pathlib.Path(folder) / "ball.contact.csv") as file:
        rows = [row for row in csv.DictReader(file) if float(row["area"]) > 0]
    return sorted((math.hypot(float(row["x"]), float(row["y"])), float(row["pressure"])) for row in rows)


def main():
    target, *folders = sys.argv[1:]
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    for folder, colour in zip(folders, ("tab:blue", "tab:orange")):
        summary = json.loads((pathlib.Path(folder) / "ball.json").read_text())
        label = "rigid" if summary["yielded_area"] == 0 else "ξ = %g Pa" % summary["max_pressure"]
        near = [(r, p) for r, p in points(folder) if r < 0.2]
        axes.plot(*zip(*near), ".", ms=3, color=colour, label="rpc, %s: %d dofs" % (label, summary["dofs"]))
    force = 4 * json.loads((pathlib.Path(folders[0]) / "ball.json").read_text())["contact_force"][2]
    radius = (3 * force * RADIUS / (4 * MODULUS)) ** (1 / 3)
    peak = 3 * force / (2 * math.pi * radius**2)
    r = [radius * k / 300 for k in range(301)]
    axes.plot(r, [peak * math.sqrt(1 - (x / radius) ** 2) for x in r], "k-", lw=1, label="Hertz, for the force of the rigid one")
    axes.set_xlabel("distance from the axis [m]")
    axes.set_ylabel("contact pressure [Pa]")
    axes.set_xlim(0, 0.2)
    axes.set_ylim(0)
    axes.legend(frameon=False)
    figure.savefig(target, dpi=150)


if __name__ == "__main__":
    main()

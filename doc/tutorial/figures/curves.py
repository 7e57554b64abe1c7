# SPDX-License-Identifier: BSD-3-Clause
"""Diagrams of the lessons: python3 curves.py FOLDER-OF-RESULTS FOLDER-OF-PICTURES; make.sh has the runs."""

import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SIZE, DPI = (6.4, 3.2), 110
RUNS, PICTURES = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


def table(path):
    """Columns of a contact table, by names without units."""
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {name.split(" ")[0]: np.array([row[name] if name in ("state", "side", "friction_state") else float(row[name]) for row in rows])
            for name in rows[0]}


def save(figure, name):
    figure.tight_layout()
    figure.savefig(PICTURES / name, dpi=DPI)
    plt.close(figure)


def press_fit():
    """The pressure on three meshes; what converges and what does not."""
    figure, (left, right) = plt.subplots(1, 2, figsize=SIZE)
    cells = [8, 16, 32, 64, 128]
    summary = [json.loads((RUNS / f"press_fit_{n}" / "press_fit.json").read_text()) for n in cells]
    for n in cells[::2]:
        contact = table(RUNS / f"press_fit_{n}" / "press_fit.contact.csv")
        shown = (contact["x"] <= 1) & (contact["x"] >= 0.5)
        left.plot(contact["x"][shown], contact["pressure"][shown], ".-", ms=3, lw=1, label=f"{n} cells per m")
    left.set(xlabel="x [m]", ylabel="contact pressure [Pa]", ylim=(0, 180))
    left.legend(frameon=False)
    size = 1 / np.array(cells)
    limit = 25.881  # N/m, lesson 1
    right.loglog(size, [run["max_pressure"] / 20 for run in summary], "o-", ms=4, label="largest pressure / 20 Pa")
    right.loglog(size, [abs(run["contact_force"][1]) / limit - 1 for run in summary], "s-", ms=4, label="error of the force, relative")
    right.set(xlabel="size of a cell [m]")
    right.legend(frameon=False)
    save(figure, "press_fit_edge.png")


def roller():
    """The pressure and Hertz's."""
    contact = table(RUNS / "roller.contact.csv")
    a = np.sqrt(4 * 1000 * 10 * 0.91 / (np.pi * 210000))
    x = np.linspace(-a, a, 201)
    figure, axes = plt.subplots(figsize=SIZE)
    axes.plot(x, 2 * 1000 / (np.pi * a) * np.sqrt(1 - (x / a) ** 2), "-", lw=1, color="0.4", label="Hertz")
    near = abs(contact["x"]) < 0.3
    axes.plot(contact["x"][near], contact["pressure"][near], ".", label="rpc, points of the last mesh")
    axes.set(xlabel="x [mm]", ylabel="contact pressure [MPa]")
    axes.legend(frameon=False)
    save(figure, "roller_pressure.png")


def dents():
    """The dents after each press, and the roller that made the first, if it were rigid."""
    figure, axes = plt.subplots(figsize=SIZE)
    for folder, label in (("dents_first", "dent after t = 1"), (".", "dent after t = 3.5")):
        contact = table(RUNS / folder / "dents.contact.csv")
        near = abs(contact["x"]) < 1
        axes.plot(contact["x"][near], -1000 * contact["dent"][near], ".-", ms=3, lw=1, label=label)
    x = np.linspace(-1, 1, 201)
    for depth, style in ((30, "--"), (45, ":")):
        axes.plot(x, 1000 * (10 - np.sqrt(100 - x ** 2)) - depth, style, lw=1, color="0.5", label=f"roller, were it rigid, {depth} µm down")
    axes.set(xlabel="x [mm]", ylabel="[µm]", ylim=(-50, 35))
    axes.legend(frameon=False, ncol=2)
    save(figure, "dents.png")


def sheared():
    """The traction and what friction bears, and Cattaneo's and Mindlin's."""
    contact = table(RUNS / "sheared_part" / "sheared.contact.csv")
    summary = json.loads((RUNS / "sheared_part" / "sheared.json").read_text())
    force, pressing = np.abs(summary["contact_force"])
    a = np.sqrt(4 * pressing * 10 * (1 - 0.499 ** 2) / (np.pi * 210000))
    c = a * np.sqrt(1 - force / (0.3 * pressing))
    x = np.linspace(-a, a, 801)
    most = 0.3 * 2 * pressing / (np.pi * a)
    mindlin = most * (np.sqrt(1 - (x / a) ** 2) - c / a * np.sqrt(np.maximum(0, 1 - (x / c) ** 2)))
    figure, axes = plt.subplots(figsize=SIZE)
    near = abs(contact["x"]) < 0.36
    axes.plot(contact["x"][near], 0.3 * contact["pressure"][near], "-", lw=1, color="0.6", label="friction coefficient times pressure")
    axes.plot(x, mindlin, "-", lw=1, color="0.2", label="traction, Cattaneo and Mindlin")
    for state, marker in (("sticks", "o"), ("slips", "x")):
        shown = near & (contact["friction_state"] == state) & (contact["pressure"] > 0)
        axes.plot(contact["x"][shown], abs(contact["q_x"][shown]), marker, ms=4, label=f"traction, {state}")
    axes.set(xlabel="x [mm]", ylabel="[MPa]", ylim=(0, 1.6 * most))
    axes.legend(frameon=False, ncol=2)
    save(figure, "sheared_traction.png")


press_fit()
roller()
dents()
sheared()

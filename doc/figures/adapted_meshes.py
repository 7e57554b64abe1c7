# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that adaptive runs ended with: the beam's, its transition from closed to yielding, and the half cylinder's contact.

    python3 adapted_meshes.py adapted_meshes.png beam_adaptive.e beam_adaptive.contact.csv hertz_adaptive.e hertz_adaptive.contact.csv

Debian packages: doc/packages.txt.
"""
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../picture"))
from result import Result  # noqa: E402


def mesh(path):
    """Coordinates and corners of the triangles of an Exodus file."""
    result = Result(path)
    return *result.positions[:, :2].T, result.blocks[0][1][:, :3]


def contact(path):
    """Position x and pressure along the contact side."""
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return [float(row["x"]) for row in rows], [float(row["pressure"]) for row in rows]


def draw(axes, triangles, window, pressure=None, height=0):
    """The mesh in a window, and below the foundation the pressure, its maximum `height` high."""
    x, y, corners = triangles
    axes.triplot(x, y, corners, color="0.25", linewidth=0.35)
    left, right, bottom, top = window
    if pressure:
        largest = max(pressure[1])
        axes.fill_between(pressure[0], [-height * p / largest for p in pressure[1]], 0, color="tab:red", alpha=0.35, linewidth=0)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xlabel="x [m]", ylabel="y [m]")


def main(picture, beam, beam_contact, hertz, hertz_contact):
    plt.rcParams.update({"font.size": 9})
    figure = plt.figure(figsize=(10, 6.4), layout="constrained")
    whole, transition, cylinder = (figure.add_subplot(place) for place in (211, 223, 224))
    beam_mesh, beam_pressure, hertz_mesh, hertz_pressure = mesh(beam), contact(beam_contact), mesh(hertz), contact(hertz_contact)
    draw(whole, beam_mesh, (-0.1, 5.1, -0.35, 1.05), beam_pressure, 0.3)
    whole.set_title(r"beam, $\xi$ = 16 Pa: %d P2 triangles; below, the contact pressure" % len(beam_mesh[2]))
    draw(transition, beam_mesh, (0.6, 1.0, -0.06, 0.16), beam_pressure, 0.05)
    transition.set_title("between closed and yielding nodes")
    draw(cylinder, hertz_mesh, (-1.05, 1.05, -0.35, 0.8), hertz_pressure, 0.3)
    cylinder.set_title(r"half cylinder, $\xi = \infty$: %d P2 triangles" % len(hertz_mesh[2]))
    figure.savefig(picture, dpi=160)


if __name__ == "__main__":
    main(*sys.argv[1:])

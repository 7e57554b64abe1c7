"""Deformed body with its von Mises stress, from an Exodus file of rpc.

Matplotlib draws triangles: a QUAD4 is cut in two, a TRI6 in four, so that all its nodes count.
"""
import netCDF4
import numpy as np

TRIANGLES = {"QUAD4": [(0, 1, 2), (0, 2, 3)], "TRI6": [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]}


def read(path):
    """Positions (nodes, 2), triangles (n, 3) and the nodal variables by name."""
    with netCDF4.Dataset(path) as file:
        positions = np.stack([file["coordx"][:], file["coordy"][:]], axis=1)
        names = [str(name) for name in netCDF4.chartostring(file["name_nod_var"][:])]
        variables = {name: np.asarray(file["vals_nod_var%d" % (n + 1)][0]) for n, name in enumerate(names)}
        cells = np.asarray(file["connect1"][:]) - 1
        triangles = np.concatenate([cells[:, corners] for corners in TRIANGLES[file["connect1"].elem_type]])
    return positions, triangles, variables


def draw(axes, path, factor):
    """Deformed body, displacement times factor. Returns what a colour bar needs."""
    positions, triangles, variables = read(path)
    x = positions[:, 0] + factor * variables["disp_x"]
    y = positions[:, 1] + factor * variables["disp_y"]
    picture = axes.tripcolor(x, y, triangles, variables["von_mises"], shading="gouraud", cmap="turbo", vmin=0)
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.autoscale(tight=True)
    axes.margins(0.02)
    return picture

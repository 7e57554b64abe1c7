# SPDX-License-Identifier: BSD-3-Clause
"""Normal displacement and pressure along the beam's contact side for several yield stresses (the paper's Fig. 3).

    python3 beam_contact.py beam_contact.png 12=xi12.contact.csv 16=xi16.contact.csv ...

Debian packages: doc/packages.txt.
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def columns(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in ("s", "u_nu", "pressure")}


def main(picture, *arguments):
    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                         "grid.alpha": 0.3, "lines.linewidth": 1.8})
    curves = [argument.split("=", 1) for argument in arguments]
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.75), layout="constrained")
    colors = plt.get_cmap("viridis")
    for n, (xi, path) in enumerate(curves):
        data = columns(path)
        style = {"color": colors(0.92 * n / max(1, len(curves) - 1)), "label": r"$\xi$ = %s Pa" % xi, "zorder": 9 - n}
        left.plot(data["s"], data["u_nu"], **style)
        right.plot(data["s"], data["pressure"], **style)
    left.set(ylabel=r"normal displacement $u_\nu$ [m]")
    left.invert_yaxis()
    right.set(ylabel=r"pressure $-\sigma_\nu$ [Pa]", ylim=(0, None))
    for axes in (left, right):
        axes.set(xlabel="x [m]", xlim=(0, 5))
    right.legend(frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(picture, dpi=160)


if __name__ == "__main__":
    main(*sys.argv[1:])

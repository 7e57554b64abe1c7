# SPDX-License-Identifier: BSD-3-Clause
"""Body, foundation and pressures at four steps of input/indent.xml: indent.py OUT.png PLASTIC HARDENING SPRINGS

The arguments are the Exodus files of the deck as it stands, with "Hardening" = 200 and with "Stiffness" = 1000. Debian packages: doc/packages.txt.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).parents[1] / "picture"))
from result import Result  # noqa: E402
from style import LIGHT  # noqa: E402

STEPS = ((1, "pressed"), (1.25, "on the way up"), (2, "lifted"), (3, "pressed deeper"))
LAWS = (("perfectly plastic", "#1b6ca8"), ("hardening", "#d1495b"), ("on springs", "#2e933c"))
HALF = 1.7  # width shown [m]
BODY = "#dfe7ee"


def along_contact(path, time):
    """(x, height of the body, height of the foundation, pressure) along the contact side, from left to right [m, Pa]."""
    result = Result(path, time)
    order = np.flatnonzero(result.contact_nodes())
    order = order[np.argsort(result.positions[order, 0])]
    nodal = {name: result.nodal[name][order] for name in ("disp_x", "disp_y", "penetration", "dent", "contact_pressure")}
    sunk = np.maximum(np.maximum(nodal["penetration"], nodal["dent"]), 0)  # the obstacle is the plane y = 0
    place = result.positions[order]
    return place[:, 0], place[:, 0] + nodal["disp_x"], place[:, 1] + nodal["disp_y"], -sunk, nodal["contact_pressure"]


def main(target, *paths):
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(2, len(STEPS), figsize=(12, 4.6), layout="constrained", sharex=True, sharey="row", height_ratios=(1.25, 1))
    for (time, what), (above, below) in zip(STEPS, panels.T):
        x, moved, body, ground, _ = along_contact(paths[0], time)
        above.fill_between(x, ground, -0.22, color=LIGHT.ground, lw=0, label="foundation")
        above.fill_between(moved, body, 0.22, color=BODY, lw=0, label="body")
        above.plot(x, ground, color="0.2", lw=1.2)
        above.plot(moved, body, color="#1b6ca8", lw=1)
        above.plot(x, 0 * x, **{**LIGHT.rest, "linestyle": ":"}, label="foundation at first")
        above.set_title(f"{what}, t = {time:g}", fontsize=10)
        for (law, colour), path in zip(LAWS, paths):
            x, _, _, _, pressure = along_contact(path, time)
            below.plot(x, pressure, color=colour, lw=1.4, label=law)
        below.set(xlabel="x [m]", xlim=(-HALF, HALF))
        below.grid(alpha=0.3)
    panels[0, 0].set(ylabel="y [m], enlarged", ylim=(-0.17, 0.17))
    panels[1, 0].set(ylabel="contact pressure [Pa]", ylim=(0, None))
    for row in panels:
        handles, labels = row[0].get_legend_handles_labels()
        row[-1].legend(handles, labels, frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(target, dpi=120)


if __name__ == "__main__":
    main(*sys.argv[1:])

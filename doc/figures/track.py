# SPDX-License-Identifier: BSD-3-Clause
"""Body, foundation and pressure at four steps of input/track.xml: track.py OUT.png TRACK.e. Debian packages: doc/packages.txt."""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from indent import BODY, GROUND, REST, along_contact  # noqa: E402

STEPS = ((1, "pressed"), (3, "lifted and moved"), (4, "pressed again"), (5, "lifted"))
SHOWN = (-1.5, 2.2)  # [m]


def main(target, path):
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(2, len(STEPS), figsize=(12, 4.6), layout="constrained", sharex=True, sharey="row", height_ratios=(1.25, 1))
    for (time, what), (above, below) in zip(STEPS, panels.T):
        _, place, body, ground, pressure = along_contact(path, time)  # a point meets the dents over which it stands
        above.fill_between(place, ground, -0.22, color=GROUND, lw=0, label="foundation")
        above.fill_between(place, body, 0.22, color=BODY, lw=0, label="body")
        above.plot(place, ground, color="0.2", lw=1.2)
        above.plot(place, body, color="#1b6ca8", lw=1)
        above.plot(SHOWN, (0, 0), **{**REST, "linestyle": ":"}, label="foundation at first")
        above.set_title(f"{what}, t = {time:g}", fontsize=10)
        below.plot(place, pressure, color="#1b6ca8", lw=1.4)
        below.set(xlabel="x [m]", xlim=SHOWN)
        below.grid(alpha=0.3)
    panels[0, 0].set(ylabel="y [m], enlarged", ylim=(-0.12, 0.17))
    panels[1, 0].set(ylabel="contact pressure [Pa]", ylim=(0, None))
    panels[0, -1].legend(frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(target, dpi=120)


if __name__ == "__main__":
    main(*sys.argv[1:])

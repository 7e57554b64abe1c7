# SPDX-License-Identifier: BSD-3-Clause
"""Force against indentation of half a ball on a rigid plane, beside Hertz's closed form.

    python3 hertz.py [--plot=hertz.png]

The formulas are those of an elastic half space, d = (9 F^2/(16 R E*^2))^(1/3), a = (3 F R/(4 E*))^(1/3), p0 = 3 F/(2 pi a^2), E* = E/(1 - nu^2). Radius and
pressure of the contact depend on what is near it, and agree. The indentation counts from the plane through the ball's centre, which is held, and not
from infinity: the body is stiffer than the half space by a term that is linear in F, as the last column shows. Takes 3 s.
"""
import argparse
import sys

import numpy as np
import rpc

E, NU, R = 2000, 0.3, 1  # [Pa], 1, [m]: of ball_axisymmetric.xml
E_STAR = E / (1 - NU**2)
INDENTATIONS = [0.0025, 0.005, 0.01, 0.015, 0.02]  # [m]


def main(plot):
    result = rpc.run("ball_axisymmetric.xml", settings={"Dirichlet->top->Y": "-t", "Steps->Times": INDENTATIONS})
    steps = result.history()
    d, force, pressure = steps["time"], steps["contact_force_y"], steps["max_pressure"]
    radius = np.sqrt(steps["contact_area"] / np.pi)
    a = (3 * force * R / (4 * E_STAR)) ** (1 / 3)
    p0 = 3 * force / (2 * np.pi * a**2)
    of_force = (9 * force**2 / (16 * R * E_STAR**2)) ** (1 / 3)

    print("d [m]    F [N]    a [m]    Hertz    p0 [Pa]  Hertz    d - Hertz's d(F), in F/(E R)")
    for row in zip(d, force, radius, a, pressure, p0, (d - of_force) * E * R / force):
        print("{:.4f}   {:.4f}   {:.4f}   {:.4f}   {:6.2f}   {:6.2f}   {:+.3f}".format(*row))
    if plot:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        more = np.linspace(0, d[-1], 100)
        pyplot.plot(d, force, "o", label="rpc")
        of_half_space = 4 / 3 * E_STAR * np.sqrt(R) * more**1.5
        pyplot.plot(more, of_half_space, label="Hertz, half space")
        pyplot.plot(more + (d - of_force)[-1] / force[-1] * of_half_space, of_half_space, "--", label="the same, and the linear term of the last point")
        pyplot.xlim(0, 1.1 * d[-1])
        pyplot.xlabel("indentation [m]")
        pyplot.ylabel("force [N]")
        pyplot.legend()
        pyplot.savefig(plot, dpi=150)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plot", metavar="FILE.png", help="draws a picture; takes matplotlib")
    try:
        main(parser.parse_args().plot)
    except (rpc.Error, ImportError, OSError) as error:
        sys.exit(f"hertz.py: {error}")

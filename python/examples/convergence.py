# SPDX-License-Identifier: BSD-3-Clause
"""The beam on meshes that are refined where the error is: estimated error over unknowns, and results with their error bars.

    python3 convergence.py [--plot=convergence.png]

The energy of doc/paper/reference.json, by an independent code, tells how good estimate and error bar are. Takes 3 s.
"""
import argparse
import math
import sys

import numpy as np
import rpc

ENERGY, NORM_SQUARED = -0.21344083, 0.4268816  # J and a(u,u) [J/m] of the reference


def main(plot):
    adaptation = rpc.run("beam_adaptive.xml", settings={"Adapt->Target Relative Error": 0.0005}).summary["adaptation"]
    cycles, bars = adaptation["cycles"], adaptation["errors"]
    dofs, error, energy = (np.array([cycle[key] for cycle in cycles]) for key in ("dofs", "relative_estimate", "energy_J"))
    true = np.sqrt(2 * np.abs(energy - ENERGY) / NORM_SQUARED)

    print("  dofs   estimated error   order   from the reference   J [J/m]")
    for k in range(len(dofs)):
        order = f"{-2 * math.log(error[k] / error[k - 1]) / math.log(dofs[k] / dofs[k - 1]):.2f}" if k else ""  # in h, of which dofs are 1/h^2
        print(f"{dofs[k]:6d}   {100 * error[k]:13.4f} %   {order:>5}   {100 * true[k]:16.4f} %   {energy[k]:.8f}")
    for name in ("energy_J", "max_pressure", "contact_length"):
        bar = "unknown: " + adaptation["errors_unknown"].get(name, "") if bars[name] is None else f"{bars[name]:.2g}"
        print(f"{name} = {cycles[-1][name]:.8g} +- {bar}")
    print(f"energy_J less that of the reference = {energy[-1] - ENERGY:.1g}, whose last digit is 1e-8")
    if plot:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        pyplot.loglog(dofs, error, "o-", label="estimated")
        pyplot.loglog(dofs, true, "s--", label="from the reference's energy")
        pyplot.xlabel("unknowns")
        pyplot.ylabel("relative error in the energy norm")
        pyplot.legend()
        pyplot.savefig(plot, dpi=150)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plot", metavar="FILE.png", help="draws a picture; takes matplotlib")
    try:
        main(parser.parse_args().plot)
    except (rpc.Error, ImportError, OSError) as error:
        sys.exit(f"convergence.py: {error}")

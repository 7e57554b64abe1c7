# SPDX-License-Identifier: BSD-3-Clause
"""The paper's beam on foundations of different yield limits: force, width in contact and width that yields.

    python3 yield_limit.py [--plot=yield_limit.png] [--folder=study]

With --folder the runs are kept: what is there is not run again. Takes 3 s.
"""
import argparse
import sys

import numpy as np
import rpc

LIMITS = [2, 4, 8, 12, 14, 16, 18, 20, 22]  # xi [Pa]


def main(plot, folder):
    results = rpc.study("beam.xml", {"Contact->Yield Stress": LIMITS}, folder=folder, workers=2)
    done = [result for result in results if result.ok]
    xi = np.array([result.settings["Contact->Yield Stress"] for result in done])
    force = np.array([result.summary["contact_force"][1] for result in done])
    touching, yielded = (np.array([result.summary[key] for result in done]) for key in ("contact_length", "yielded_length"))

    print("xi [Pa]   force [N/m]   in contact [m]   yields [m]   dent [m]")
    for result, *row in zip(done, xi, force, touching, yielded):
        print("{:7.1f}   {:11.4f}   {:14.4f}   {:10.4f}   {:8.5f}".format(*row, result.contact()["dent"].max()))
    if plot:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        _, (above, below) = pyplot.subplots(2, sharex=True)
        above.plot(xi, force, "o-")
        above.set_ylabel("force [N/m]")
        below.plot(xi, touching, "o-", label="in contact")
        below.plot(xi, yielded, "s-", label="yields")
        below.set_xlabel("yield limit [Pa]")
        below.set_ylabel("width [m]")
        below.legend()
        pyplot.savefig(plot, dpi=150)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plot", metavar="FILE.png", help="draws a picture; takes matplotlib")
    parser.add_argument("--folder", help="keeps the runs")
    try:
        arguments = parser.parse_args()
        main(arguments.plot, arguments.folder)
    except (rpc.Error, ImportError, OSError) as error:
        sys.exit(f"yield_limit.py: {error}")

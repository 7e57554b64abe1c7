# SPDX-License-Identifier: BSD-3-Clause
"""Steps over the mesh: a cantilever in the plane and a block in space, both with three states; at most one step more a halving.

    python3 growth.py --rpc=build/rpc [--plane=256] [--space=32]       # the finest 1/h of each
"""
import argparse
import os
import pathlib
import sys
import tempfile

import families
import fields as f
import runs
from generate import CLAMPED, ZERO
from report import short
from scene import ContactSide, Scene
from suite.table import Table

MOST_GROWTH = 1  # steps a halving
COARSEST = {"plane": 16, "space": 8}
FINEST = {"plane": 256, "space": 32}
Q = 1e-3  # pressure over E


def cantilever(n):
    """3 x 1, clamped on the left, over a foundation that bends away from it."""
    return Scene(mesh={"Type": "box", "Cells": (3 * n, n), "Element": "Q1"}, lengths={"Lower": (0.0, 0.0), "Upper": (3.0, 1.0)},
                 dirichlet={"left": CLAMPED}, traction={"top": [ZERO, f.Constant(-Q)]}, material={"E": 1.0, "nu": 0.3, "blocks": {}},
                 contact=[ContactSide("bottom", f.exponential(0.7 * Q, 4 * Q, 3.0), f.parabola(4 * Q, 1.2, 2 * Q))], units=(1.0, 1e6), expect="solution")


def block(n):
    """2 x 1 x 1, clamped on the left, over a paraboloid."""
    return Scene(mesh={"Type": "box", "Cells": (2 * n, n, n), "Element": "Q1"}, lengths={"Lower": (0.0,) * 3, "Upper": (2.0, 1.0, 1.0)}, dim=3,
                 dirichlet={"left": families.CLAMPED_3D}, traction={"top": [ZERO, f.Constant(-Q), ZERO]},
                 material={"E": 1.0, "nu": 0.3, "blocks": {}}, units=(1.0, 1e6), expect="solution",
                 contact=[ContactSide("bottom", f.exponential(1.2 * Q, 4 * Q, 2.0), f.paraboloid(5 * Q, 1.4, 0.5))])


SCENES = {"cantilever": ("plane", cantilever), "block": ("space", block)}


def rows(options, finest):
    """{scene: [(1/h, Row)]}"""
    measured = {}
    for name, (bodies, make) in SCENES.items():
        n = COARSEST[bodies]
        while n <= finest[bodies]:
            with tempfile.TemporaryDirectory(prefix="rpc_growth_") as folder:
                row = runs.measure_scene(options, n, name, make(n), pathlib.Path(folder))
            print(f"  {name}, 1/h = {n}", file=sys.stderr, flush=True)
            measured.setdefault(name, []).append((n, row))
            n *= 2
    return measured


def grows(before, now):
    """Whether steps are more by more than MOST_GROWTH; None: there was no mesh before to compare with."""
    return None if before is None or now is None else now > before + MOST_GROWTH


def table(measured):
    result = Table("Steps of the families over the mesh",
                   "A cantilever, 3 x 1, and a block, 2 x 1 x 1, pressed from above. Criteria: all three states; solved with residuals of at "
                   "most 1e-8; at most %d step more than on the mesh before, cold and from a coarser mesh (where there is one: from 2000 "
                   "nodes on)." % MOST_GROWTH,
                   ["scene", "1/h", "dofs", "contact points", "open, closed, yielding", "steps", "", "cold", "", "residual", ""])
    for name, meshes in measured.items():
        before = {"steps": None, "cold_steps": None}
        for n, row in meshes:
            cells = []
            for key in before:
                worse = grows(before[key], getattr(row, key))
                cells += [short(getattr(row, key), "%.0f"), "" if worse is None else result.check(not worse)]
                before[key] = getattr(row, key)
            result.add(name, n, row.dofs, row.points, f"{row.open}, {row.closed}, {row.yielding}", *cells, "%.0e" % row.residual,
                       result.check(row.states == 3 and not row.failure) + (": " + row.failure if row.failure else ""))
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    for bodies, n in FINEST.items():
        parser.add_argument("--" + bodies, type=int, default=n)
    parser.add_argument("--time-limit", type=float, default=300.0, help="of a run [s] (%(default)s)")
    parser.add_argument("--np", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpiexec --oversubscribe --bind-to none")
    options = parser.parse_args()
    options.rpc, options.elastic, options.keep, options.only = os.path.abspath(options.rpc), False, None, None
    result = table(rows(options, {bodies: getattr(options, bodies) for bodies in FINEST}))
    print("\n" + result.text())
    return 0 if result.good else 1


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""deal.II's step-42: the same contact in space by a tutorial program that many start from."""
import json
import math
import os
import statistics
import sys

from .peers import HERE
from .program import Failure, execute
from .table import Table, skipped

NEEDED = ("/usr/share/doc/libdeal.ii-doc/examples/step-42/step-42.cc", "/usr/share/cmake/deal.II/deal.IIConfig.cmake")
LEAST_RATIO = 8.0  # step-42's time for its last mesh over that of rpc's process
FORCE_TOLERANCE = 4e-6  # relative: step-42 prints six digits
TIMEOUT = 590  # [s]


def run_pair(bench, n):
    """What step-42 says of its last mesh, and rpc's result."""
    script = [sys.executable, os.path.join(HERE, "step_42.py"), os.path.join(bench.output, "step-42"), str(round(math.log2(n)))]
    print("  step-42, %d cells along an edge" % n, file=sys.stderr, flush=True)
    theirs = json.loads(execute(script, timeout=TIMEOUT).output.splitlines()[-1])[-1]
    return theirs, bench.program.run(os.path.join(HERE, "step_42.xml"), fresh=True, **{"Mesh->Cells": "{%d, %d, %d}" % (n, n, n)})


def step_42(bench):
    meshes, repeats, judged = bench.sizes["step-42"]
    title = "Peers in space: deal.II's step-42"
    missing = [path for path in NEEDED if not os.path.exists(path)]
    if missing:
        return skipped(title, "there is no %s; on Debian apt-get install libdeal.ii-dev libdeal.ii-doc" % ", ".join(missing))
    table = Table(title,
                  "A rigid ball is pressed into a cube, elastic, Q1 (peers/step_42.xml). step-42: its last mesh alone, without the "
                  "time for pictures, starting from the solution of the mesh before; BiCGStab with Trilinos' ML. rpc: the whole "
                  "process with its coarser meshes. In turns on one rank with one thread; medians of %d. Force: within %g, "
                  "relative. %s"
                  % (repeats, FORCE_TOLERANCE, "Criterion: at %d³ cells step-42 takes at least %g x rpc's time."
                     % (judged, LEAST_RATIO) if judged else "No criterion: the meshes are too small."),
                  ["cells", "dofs", "force [N]", "rpc", "iterations", "rpc", "assembly, set-up, iterations [s]", "last mesh [s]",
                   "rpc [s]", "over rpc", ""])
    for n in meshes:
        try:
            pairs = [run_pair(bench, n) for _ in range(repeats)]
        except Failure as failure:
            table.add("%d³" % n, *[""] * 9, str(failure).strip().splitlines()[-1])
            table.check(False)
            continue
        theirs, ours = pairs[-1]
        force = -ours["contact_force"][2]
        ratio = statistics.median(peer["seconds"] / rpc["process"] for peer, rpc in pairs)
        good = abs(theirs["force"] / force - 1) <= FORCE_TOLERANCE and (n != judged or ratio >= LEAST_RATIO)
        table.add("%d³" % n, ours["dofs"], "%.6g" % theirs["force"], "%.6g" % force, " ".join(map(str, theirs["iterations"])),
                  " ".join(map(str, ours["linear_iterations"])),
                  "%.1f, %.1f, %.1f" % tuple(theirs[phase] for phase in ("assembly", "setup", "iterate")),
                  "%.2f" % statistics.median(peer["seconds"] for peer, _ in pairs),
                  "%.2f" % statistics.median(rpc["process"] for _, rpc in pairs), "%.1f" % ratio, table.check(good))
    return table

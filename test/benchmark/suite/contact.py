# SPDX-License-Identifier: BSD-3-Clause
"""What contact costs beyond elasticity."""
import os

from .program import median_ratio, solution_seconds, without_contact
from .table import Table

MOST_RATIO = 1.5
MOST_KKT = 1e-8
SCENES = (("xi = 2 Pa", "2", {}, 2), ("xi = 16 Pa", "16", {}, None), ("xi = inf", "inf", {}, 2),
          ("never touching: gap 1 m", "16", {"Contact->Gap": "1"}, 1))  # name, xi, parameters, most linear solves
TO_1E_8 = {"Linear Solver->Tolerance": "1e-8", "NOX->Residual Tolerance": "2e-8", "Uzawa->Tolerance": "1e-7"}


def contact_cost(bench):
    n, repeats, judged = bench.sizes["contact"]
    table = Table("The contact solve over the linear elastic solve, 1/h = %d" % n,
                  "The beam against the same deck without its Contact sublist: all from assembly to solve (CG to 1e-8), coarser "
                  "meshes included; median of %d interleaved pairs, in brackets the medians in s. Solves, set-ups: on the finest "
                  "mesh. %s"
                  % (repeats,
                     "Criteria: ratio at most %g; one set-up; KKT residual at most %g; at most 2 linear solves at xi = 2 and inf, "
                     "1 where nothing touches." % (MOST_RATIO, MOST_KKT) if judged else
                     "No criterion: the mesh is too small."),
                  ["scene", "ratio", "linear solves", "elastic", "CG iterations", "elastic", "set-ups", "KKT residual", ""])
    elastic_deck = without_contact(os.path.join(bench.program.input_folder, "beam.xml"), bench.output)
    for name, xi, parameters, most_solves in SCENES:
        pairs = []
        for _ in range(repeats):
            contact = bench.program.beam(n, xi, fresh=True, **parameters)
            elastic = bench.program.beam(n, None, fresh=True, deck=elastic_deck, **TO_1E_8)
            pairs.append((solution_seconds(contact), solution_seconds(elastic)))
        ratio = median_ratio(pairs)
        good = (ratio[0] <= MOST_RATIO and contact["preconditioner_setups"] == 1 and contact["kkt_residual"] <= MOST_KKT
                and (most_solves is None or contact["linear_solves"] <= most_solves))
        table.add(name, "%.2f (%.3f, %.3f)" % tuple(ratio), contact["linear_solves"], elastic["linear_solves"],
                  " ".join(map(str, contact["linear_iterations"])), " ".join(map(str, elastic["linear_iterations"])),
                  contact["preconditioner_setups"], "%.1e" % contact["kkt_residual"], table.check(good) if judged else "")
    return table

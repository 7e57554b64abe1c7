# SPDX-License-Identifier: BSD-3-Clause
"""The paper's own tables and its Fig. 2."""
import math

from .table import Table

ENERGY_TOLERANCE = 2e-6  # [J/m], half a digit of the paper's tables and more
MOST_UZAWA = {"table 1": 3, "table 2": 4}
ERROR_RATIO, ERROR_RATIO_TOLERANCE = 2.0, 0.15  # per halving of h at xi = 16


def table_1(bench):
    from_two = bench.sizes["two ranks from"]
    table = Table("Energy and Uzawa iterations for xi = 2 Pa (the paper's Table 1)",
                  "Criteria: energy within %g J/m of the paper's, at most %d Uzawa iterations."
                  % (ENERGY_TOLERANCE, MOST_UZAWA["table 1"]),
                  ["1/h", "dofs", "ranks", "Uzawa", "paper", "J [J/m]", "paper", "difference", "CG, most", ""])
    for n, uzawa, energy in bench.reference["table_1"]["rows"]:
        if n not in bench.sizes["table 1"]:
            continue
        ranks = 2 if n >= from_two else 1
        r = bench.program.beam(n, "2", ranks)
        difference = r["energy_J"] - energy
        good = abs(difference) <= ENERGY_TOLERANCE and r["uzawa_iterations"] <= MOST_UZAWA["table 1"]
        table.add(n, r["dofs"], ranks, r["uzawa_iterations"], uzawa, "%.7f" % r["energy_J"], "%.6f" % energy,
                  "%.1e" % difference, max(r["linear_iterations"]), table.check(good))
    return table


def table_2(bench):
    n = bench.sizes["table 2"]
    test = {"Uzawa->Stopping Test": "multiplier change"}
    table = Table("Uzawa iterations at 1/h = %d (the paper's Table 2)" % n,
                  "Two stopping tests: optimality residuals (the default), and the paper's, the relative change of the multiplier. "
                  "Newton: steps in each Uzawa iteration. Criterion: at most %d Uzawa iterations with either test."
                  % MOST_UZAWA["table 2"],
                  ["xi [Pa]", "paper", "optimality residuals", "Newton", "multiplier change", "Newton", "J [J/m]", ""])
    for xi, uzawa in bench.reference["table_2"]["rows"]:
        ours, theirs = bench.program.beam(n, xi), bench.program.beam(n, xi, **test)
        good = max(ours["uzawa_iterations"], theirs["uzawa_iterations"]) <= MOST_UZAWA["table 2"]
        table.add(xi, uzawa, ours["uzawa_iterations"], " ".join(map(str, ours["newton_iterations"])),
                  theirs["uzawa_iterations"], " ".join(map(str, theirs["newton_iterations"])),
                  "%.7f" % ours["energy_J"], table.check(good))
    return table


def energy_norm_error(energy, exact):
    """Relative error in the energy norm, sqrt(2 |J_h - J| / a(u, u)), from J_h and the reference's [J, its tolerance, a(u, u)]."""
    return math.sqrt(2 * abs(energy - exact[0]) / exact[2])


def figure_2(bench):
    table = Table("Relative error in the energy norm (the paper's Fig. 2)",
                  "sqrt(2 (J_h - J) / a(u,u)), with J and a(u,u) of an independent solution: an upper bound of the error, since "
                  "J_h >= J. Ratio: error on the mesh before over this one; order: its base-2 logarithm. Criterion: the "
                  "ratio at xi = 16 Pa is %g within %g." % (ERROR_RATIO, ERROR_RATIO_TOLERANCE),
                  ["xi [Pa]", "1/h", "J_h [J/m]", "J_h - J", "error", "ratio", "order", ""])
    for xi in ("2", "16"):
        exact = bench.energy_reference("beam", xi)
        before = None
        for n in bench.sizes["figure 2"]:
            r = bench.program.beam(n, xi, 2 if n >= bench.sizes["two ranks from"] else 1)
            error = energy_norm_error(r["energy_J"], exact)
            cells = ["", "", ""]
            if before:
                ratio = before / error if error > 0 else math.inf
                good = table.check(abs(ratio - ERROR_RATIO) <= ERROR_RATIO_TOLERANCE) if xi == "16" else ""
                cells = ["%.3f" % ratio, "%.2f" % math.log2(ratio), good]
            table.add(xi, n, "%.8f" % r["energy_J"], "%.3e" % (r["energy_J"] - exact[0]), "%.3f %%" % (100 * error), *cells)
            before = error
    return table

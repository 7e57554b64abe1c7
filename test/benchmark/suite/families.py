# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes by family, and steps over the mesh: test/families."""
import argparse
import os
import shlex
import sys

from .program import picture
from .table import Table

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../families")
sys.path.append(FOLDER)

import growth  # noqa: E402, after its folder
import measure  # noqa: E402
import report  # noqa: E402


def options_of(bench, **more):
    parser = argparse.ArgumentParser()
    measure.arguments(parser)
    options = parser.parse_args(["--rpc", bench.program.rpc, "--mpiexec", shlex.join(bench.program.mpiexec)])
    vars(options).update(more)
    return options


def families(bench):
    """The table by family, the bars and the failed scenes in one."""
    scenes, size = bench.sizes["families"]
    options = options_of(bench, scenes=scenes, size=size, seed=bench.seed)
    rows = measure.measured(options)
    path = os.path.join(bench.output, "families.csv")
    report.write_csv(rows, path)
    plotted = picture(os.path.join(FOLDER, "plot.py"), path, "Contact over elastic solve, and steps, over the number of contact points")
    return Joined(measure.tables(options, rows), ["A row a scene: [families.csv](families.csv).", plotted],
                  measure.failures(options, rows))


def steps_over_mesh(bench):
    return growth.table(growth.rows(options_of(bench, elastic=False), bench.sizes["growth"]))


class Joined(Table):
    """Tables under each other; good if all are. Texts follow the first, failures the last."""

    def __init__(self, tables, texts, failures):
        super().__init__(tables[0].title, tables[0].note, [])
        self.tables, self.texts, self.failures = tables, texts, failures
        self.good = all(table.good for table in tables)

    def text(self):
        first, *others = [table.text() for table in self.tables]
        parts = [first, *(text + "\n" for text in self.texts), *others]
        if self.failures:
            parts.append("\n".join("    " + line.strip() for line in "\n".join(self.failures).splitlines()) + "\n")
        return "\n".join(parts)

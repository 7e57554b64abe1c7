# SPDX-License-Identifier: BSD-3-Clause
"""Markdown tables with pass or fail."""


class Table:
    """Rows of text; remembers whether all criteria hold."""

    def __init__(self, title, note, columns):
        self.title, self.note, self.rows, self.good = title, note, [columns], True

    def add(self, *cells):
        self.rows.append([str(cell) for cell in cells])

    def check(self, holds):
        self.good = self.good and holds
        return "ok" if holds else "FAIL"

    def text(self):
        lines = []
        if len(self.rows) > 1:
            widths = [max(len(row[c]) for row in self.rows) for c in range(len(self.rows[0]))]
            lines = ["| " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths)) + " |" for row in self.rows]
            lines.insert(1, "|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
        return "\n".join(["## " + self.title, "", self.note, ""] + lines).rstrip() + "\n"


def skipped(title, reason):
    return Table(title, "Skipped: %s." % reason, [])

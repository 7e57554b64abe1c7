# SPDX-License-Identifier: BSD-3-Clause
"""Sizes of texts in pictures."""
from matplotlib import textpath

TITLE, SMALL = 12, 9  # points
GAP = 0.15  # inches between texts and what is beside them


def width_of(text, points):
    """Inches that a line of text takes."""
    return textpath.TextPath((0, 0), text, size=points).get_extents().width / 72 + 0.02 if text.strip() else 0.0


def in_lines(parts, width):
    """Parts of the title in lines that fit a width [inches], as far as the parts do."""
    found = [parts[0]]
    for part in parts[1:]:
        longer = f"{found[-1]}    {part}"
        if width_of(longer, TITLE) <= width:
            found[-1] = longer
        else:
            found.append(part)
    return found

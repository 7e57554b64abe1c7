# SPDX-License-Identifier: BSD-3-Clause
"""What fields are called, which of them are categories, and their colours."""
import re

import matplotlib
import numpy as np
from matplotlib import colors

ROUNDING = 1e-6  # of the largest value of a film: less is drawn as 0
CATEGORIES = {"contact_status": ("open", "closed", "yielding", "unseen"), "friction_status": ("none", "sticks", "slips")}
ERROR = "error_energy_norm"
DECADES = 3  # of a field on a logarithmic scale: less than its largest value over 10^DECADES has the lowest colour
NOT_NEGATIVE = ("contact_pressure", "von_mises", "dent", "penetration", "friction_used")


def label(name, units):
    """What a colour bar says of a field. @param units  see Result"""
    axes = name.rsplit("_", 1)[-1]
    if name in ("gap", "dent", "penetration"):
        return f"{name} [{units['length']}]"
    if name == "cell_size":
        return f"size of the cells [{units['length']}]"
    if name == ERROR:
        energy = units["energy"]
        return f"estimated error of the cells [\u221a{energy if energy.isalpha() else f'({energy})'}]"
    if name.startswith("disp_"):
        return f"displacement in {axes} [{units['length']}]"
    if name.startswith("slip_"):
        return f"slip in {axes} [{units['length']}]"
    if name == "contact_pressure":
        return f"contact pressure [{units['stress']}]"
    if name in ("friction_x", "friction_y", "friction_z"):
        return f"friction in {axes}, on the foundation [{units['stress']}]"
    if name == "friction_used":
        return "friction over what it can be"
    if name == "von_mises":
        return f"von Mises stress [{units['stress']}]"
    if name == "stress_theta":
        return f"hoop stress [{units['stress']}]"
    if name.startswith("stress_"):
        return rf"stress $\sigma_{{{axes}}}$ [{units['stress']}]"
    return name.replace("_", " ")


def is_category(name):
    """Whether a field's values are numbers of CATEGORIES; below 0 there is none."""
    return name in CATEGORIES


def is_signed(name):
    """Whether a contact field's sign says a direction."""
    return re.fullmatch(r"(friction|slip)_[xyz]", name) is not None


def coloring(name, values, contact, style, peak=lambda: 0.0):
    """(norm, colour map) of a field with these values. @param peak  tells the largest one of the whole film"""
    if is_category(name):
        names = CATEGORIES[name]
        colours = colors.ListedColormap([style.categories[name] for name in names])
        return colors.BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names)), colours.with_extremes(under=style.absent)
    values = values[np.isfinite(values)]
    low, high = (values.min(), values.max()) if len(values) else (0.0, 1.0)
    if name == "cell_size" and high > 4 * low > 0:
        return colors.LogNorm(low, high), color_map(style, "body")
    if name == ERROR and high > 4 * low and high > 0:
        return colors.LogNorm(max(low, high / 10**DECADES), high, clip=True), color_map(style, "body")
    if name in NOT_NEGATIVE:
        low, high = 0.0, max(high, 0.0)
        most = peak()
        high = most if high <= ROUNDING * most else high  # an unloaded body would show rounding errors
    if high - low <= 1e-12 * max(abs(low), abs(high)):
        high = low + (abs(low) or 1.0)
    if low < 0 < high and min(-low, high) > 0.1 * max(-low, high):
        limit = max(-low, high)
        return colors.Normalize(-limit, limit), color_map(style, "signed")
    return colors.Normalize(low, high), color_map(style, "contact" if contact else "body")


def color_map(style, which):
    """A colour map of the style, grey where a block lacks the field."""
    name, start, end = style.map_of(which)
    return colors.ListedColormap(matplotlib.colormaps[name](np.linspace(start, end, 256))).with_extremes(bad=style.absent)

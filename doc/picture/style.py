# SPDX-License-Identifier: BSD-3-Clause
"""Colours, lines and resolution of pictures: light for the screen, dark for dark slides, print for paper without colours."""
import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Style:
    """Colours are those of Matplotlib, but for arrays (3,): red, green and blue between 0 and 1."""

    name: str
    dpi: int
    background: str
    text: str
    faint: str  # captions, and numbers along axes in space
    rule: str  # those axes
    rest: dict  # of lines: the outline of the undeformed body
    ink: np.ndarray  # lines of the mesh, arrows
    ground: np.ndarray  # the foundation
    zones: dict  # {zone of friction: colour}
    body: tuple  # colour map and the part of it that is taken: of the body's field
    contact: tuple  # of the contact sides' field
    signed: tuple  # of fields of both signs
    absent: str  # where a block lacks the field
    categories: dict  # {name of a category: colour}, see fields.CATEGORIES
    curves: tuple  # [{"color":, "linestyle":, "marker":}] of several files
    energies: dict  # {column: colour}

    def rc(self):
        """What it sets in Matplotlib."""
        edges = {name: self.text for name in ("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color")}
        faces = {name: self.background for name in ("figure.facecolor", "savefig.facecolor", "axes.facecolor")}
        return {**edges, **faces, "pdf.fonttype": 42, "svg.hashsalt": "rpc"}  # fonts that editors take; the same picture is the same file

    def map_of(self, which):
        """(name, first, last) of a colour map: "body", "contact" or "signed"."""
        return getattr(self, which)


def curves(colours, linestyles=("-",), markers=(".",)):
    """Of several files."""
    return tuple({"color": colour, "linestyle": linestyles[k % len(linestyles)], "marker": markers[k % len(markers)]}
                 for k, colour in enumerate(colours))


LIGHT = Style(
    name="light", dpi=140, background="white", text="black", faint="0.3", rule="0.35", rest={"color": "0.45", "linewidth": 0.8},
    ink=np.array([0.1, 0.1, 0.12]), ground=np.array([0.80, 0.78, 0.75]),
    zones={"sticks": np.array([0.42, 0.68, 0.90]), "slips": np.array([0.93, 0.55, 0.75])},
    body=("viridis", 0, 1), contact=("YlOrRd", 0, 0.85), signed=("coolwarm", 0, 1), absent="0.75",
    categories={"open": "#d9d9d9", "closed": "#4292c6", "yielding": "#cb181d", "unseen": "#f2c14e",
                "none": "#d9d9d9", "sticks": "#6baee6", "slips": "#ed8cbf"},
    curves=curves(("#1b6ca8", "#d1495b", "#2e933c", "#8d6a9f", "#c77d0a", "0.3")),
    energies={"dissipated_by_friction": "#e9a03b", "dissipated_energy": "#d1495b", "strain_energy": "#1b6ca8", "foundation_energy": "#8fbfdc"})
DARK = dataclasses.replace(
    LIGHT, name="dark", background="#15181d", text="#e6e6e6", faint="0.75", rule="0.6", rest={"color": "0.65", "linewidth": 0.8},
    ink=np.array([0.90, 0.90, 0.92]), ground=np.array([0.33, 0.34, 0.37]), contact=("inferno", 0.25, 0.95), absent="0.45",
    zones={"sticks": np.array([0.22, 0.50, 0.78]), "slips": np.array([0.80, 0.32, 0.58])},
    categories={**LIGHT.categories, "open": "#5c6066", "none": "#5c6066", "closed": "#4aa3df", "yielding": "#ff5a4f",
                "sticks": "#3880c7", "slips": "#cc5294"},
    curves=curves(("#5eb1ef", "#ff7b89", "#6fcf7c", "#c3a1d6", "#f0b04f", "0.8")),
    energies={**LIGHT.energies, "strain_energy": "#3d8fd1"})
PRINT = dataclasses.replace(
    LIGHT, name="print", dpi=200, faint="0.2", rule="0.2", rest={"color": "0.35", "linewidth": 0.8},
    ink=np.zeros(3), ground=np.array([0.93, 0.93, 0.93]), zones={"sticks": np.full(3, 0.80), "slips": np.full(3, 0.50)},
    body=("Greys", 0.04, 0.72), contact=("Greys", 0.04, 0.85), signed=("gray", 0.25, 1), absent="white",
    categories={"open": "0.97", "closed": "0.70", "yielding": "0.25", "unseen": "0.48", "none": "0.97", "sticks": "0.75", "slips": "0.40"},
    curves=curves(("0", "0.45", "0.2", "0.55", "0.1", "0.35"), ("-", "--", "-.", ":", (0, (6, 2)), (0, (3, 1, 1, 1, 1, 1))),
                  ("o", "s", "^", "x", "D", "+")),
    energies={"dissipated_by_friction": "0.80", "dissipated_energy": "0.60", "strain_energy": "0.35", "foundation_energy": "0.92"})
STYLES = {style.name: style for style in (LIGHT, DARK, PRINT)}

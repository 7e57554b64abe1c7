# SPDX-License-Identifier: BSD-3-Clause
"""Command line of doc/picture.sh."""
import argparse
import math
import os
import re
import sys

import numpy as np

import figure
import history
import surface
from result import PictureError, Result
from scene import Scene

EPILOG = """contact_pressure, gap, dent, penetration and contact_status are drawn on the contact side, in the plane as a diagram inside
the foundation; the rest of the body has its von Mises stress. Default: contact_pressure if there is contact, else von_mises.
RESULT.e stands for all files of the run, RESULT.e-s0002 and so on too: one for each mesh of its load steps.
RESULT.history.csv, of load steps, gives force against displacement and the energies; several of them, each as LABEL=FILE, are compared."""


class Parser(argparse.ArgumentParser):
    """Refuses like the rest of the program."""

    def error(self, message):
        raise PictureError(f"{message}; see --help")


def number(text):
    """A finite number."""
    value = float(text)
    if not math.isfinite(value):
        raise ValueError
    return value


def factor(text):
    """A number >= 0."""
    value = number(text)
    if value < 0:
        raise ValueError
    return value


def plane(text):
    """(axis, value) of "x=0"."""
    axis, value = re.fullmatch(r"([xyz])=(.+)", text).groups()
    return "xyz".index(axis), number(value)


def vector(text):
    """Three numbers, not all 0."""
    x, y, z = (number(part) for part in text.split(","))
    if x == y == z == 0:
        raise ValueError
    return x, y, z


def window(text):
    """Two corners (2, dim), the lower one first."""
    numbers = [number(part) for part in text.split(",")]
    corners = np.array(numbers).reshape(2, -1)
    if corners.shape[1] not in (2, 3) or not (corners[0] < corners[1]).all():
        raise ValueError
    return corners


def parsed(convert, name, text, rule):
    """An option's value, None if it is absent."""
    try:
        return None if text is None else convert(text)
    except (ValueError, AttributeError):
        raise PictureError(f'--{name} must be {rule}, got "{text}"') from None


def options(arguments):
    """The command line, checked as far as that goes without the result."""
    parser = Parser(prog="bash doc/picture.sh", description="Makes a PNG of a result of rpc, in the plane or in space.",
                    epilog=EPILOG, allow_abbrev=False)
    parser.add_argument("results", metavar="RESULT.e", nargs="+", help="Exodus file of rpc, or RESULT.history.csv, one or several")
    parser.add_argument("--output", metavar="FILE.png", help="default: RESULT.png beside RESULT.e")
    parser.add_argument("--field", metavar="NAME", help="a field of the file")
    parser.add_argument("--scale", metavar="FACTOR",
                        help="of the displacements, and of the gaps if it is above 1; default: one that makes both visible")
    parser.add_argument("--time", metavar="T", help="time of the step to draw; default: the last one")
    parser.add_argument("--window", metavar="X0,Y0,X1,Y1", help="enlarges this rectangle of the picture; in space X0,Y0,Z0,X1,Y1,Z1, "
                        "a box of the undeformed body, and what lies outside is not drawn")
    parser.add_argument("--cut", metavar="x=0", help="in space: takes away what lies on this side of a plane across an axis")
    parser.add_argument("--view", metavar="X,Y,Z", help="in space: direction from the body to the viewer; default: chosen")
    found = parser.parse_args(arguments)
    found.scale = parsed(factor, "scale", found.scale, "a number >= 0")
    found.time = parsed(number, "time", found.time, "a number")
    found.window = parsed(window, "window", found.window, "x0,y0,x1,y1, in space x0,y0,z0,x1,y1,z1, "
                          "with x0 < x1, y0 < y1 and z0 < z1")
    found.cut = parsed(plane, "cut", found.cut, "an axis and a number, such as x=0")
    found.view = parsed(vector, "view", found.view, "three numbers that are not all 0, such as 1,-1,0.5")
    found.histories = histories(found)
    found.result = found.results[0]
    found.output = found.output or os.path.splitext(found.histories[0][1] if found.histories else found.result)[0] + ".png"
    if not found.output.endswith(".png"):
        raise PictureError(f'--output must end in .png, got "{found.output}"')
    return found


def histories(found):
    """[(label, path)] of tables of load steps; empty if the result is an Exodus file."""
    tables = [text for text in found.results if text.endswith(history.SUFFIX)]
    if not tables and len(found.results) == 1:
        return []
    if len(tables) < len(found.results):
        raise PictureError(f"several results must all end in {history.SUFFIX}; see --help")
    if len(tables) > len(history.COLOURS):
        raise PictureError(f"at most {len(history.COLOURS)} load histories go into one picture, got {len(tables)}")
    for name in ("field", "scale", "time", "window", "cut", "view"):
        if getattr(found, name) is not None:
            raise PictureError(f"--{name} does not go with {history.SUFFIX}")
    return [("", text) if "=" not in text or os.path.isfile(text) else tuple(text.rsplit("=", 1)) for text in tables]


def cut_of(result, found):
    """The plane to cut along; it must cross the body. What the viewer has in front is taken away."""
    if found.cut is None:
        return None
    axis, value = found.cut
    low, high = result.positions[:, axis].min(), result.positions[:, axis].max()
    if not low < value < high:
        raise PictureError(f'--cut must lie inside the body, {low:g} < {"xyz"[axis]} < {high:g} {result.units["length"]}, got {value:g}')
    if found.view:
        return surface.Cut(axis, value, -1 if found.view[axis] < 0 else 1)
    contact = result.contact_nodes()
    below = contact is None or not contact.any() or result.vector("contact_normal_")[contact, axis].mean() < 0.5
    return surface.Cut(axis, value, 1 if below else -1)  # the side away from the foundation, if it is one of the two


def picture_of(found):
    """Of a body, as the bytes of a PNG."""
    result = Result(found.result, found.time)
    if result.dim == 2 and (found.cut or found.view):
        raise PictureError("--cut and --view are for bodies in space")
    if found.window is not None and found.window.shape[1] != result.dim:
        where, wanted = ("the plane", "x0,y0,x1,y1") if result.dim == 2 else ("space", "x0,y0,z0,x1,y1,z1")
        raise PictureError(f'"{found.result}": --window of a body in {where} must be {wanted} [{result.units["length"]}], got {found.window.size} numbers')
    return figure.draw(Scene(result, found.field, found.scale, cut_of(result, found), found.window), found.view)


def main(arguments):
    """Exit code; 2: something of the command line or the result does not fit."""
    try:
        found = options(arguments)
        figure.write(found.output, history.draw(found.histories) if found.histories else picture_of(found))
    except PictureError as error:
        print(f"picture: error: {error}", file=sys.stderr)
        return 2
    print(f"wrote {found.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

# SPDX-License-Identifier: BSD-3-Clause
"""Command line of doc/picture.sh."""
import argparse
import math
import os
import re
import sys
import warnings

import numpy as np

import curves
import figure
import history
import output
import style
import summary
import surface
import table
from result import PictureError, Result, first_line
from scene import Scene

EPILOG = """Fields of the contact are drawn on the contact side, in the plane as a diagram inside the foundation; the rest of the body has its
von Mises stress. Default: contact_pressure if there is contact, else von_mises. cell_size shows where a mesh is fine. RESULT.e stands for
all files of the run, RESULT.e-s0002 and so on too: one for each mesh of its load steps. RESULT.contact.csv gives the pressure, the friction
and the state along the contact sides; RESULT.history.csv, of load steps, force against displacement and the energies, or with --columns any
of its columns; RESULT.points.csv results along lines, and at points over the time; RESULT.json the estimated error over the adapted meshes, or where none were adapted a histogram of the contact pressure. Several tables of one kind, each as FILE or LABEL=FILE, go into one picture. doc/pictures.md has examples."""
OF_BODIES = ("field", "scale", "time", "window", "cut", "view")
OF_TABLES = ("columns", "over", "range", "centre")
OF_POINTS = ".points.csv"


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
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0:
        raise ValueError
    return x / largest, y / largest, z / largest


def window(text):
    """Two corners (2, dim), the lower one first."""
    numbers = [number(part) for part in text.split(",")]
    corners = np.array(numbers).reshape(2, -1)
    if corners.shape[1] not in (2, 3) or not (corners[0] < corners[1]).all():
        raise ValueError
    return corners


def span(text):
    """Two numbers, the lower one first."""
    low, high = (number(part) for part in text.split(","))
    if not low < high:
        raise ValueError
    return low, high


def numbers(text):
    """Numbers between commas."""
    return [number(part) for part in text.split(",")]


def words(text):
    """Names between commas."""
    found = [part.strip() for part in text.split(",")]
    if not all(found):
        raise ValueError
    return list(dict.fromkeys(found))


def style_of(text):
    """A style by its name."""
    if text not in style.STYLES:
        raise ValueError
    return style.STYLES[text]


def parsed(convert, name, text, rule):
    """An option's value, None if it is absent."""
    try:
        return None if text is None else convert(text)
    except (ValueError, AttributeError):
        raise PictureError(f'--{name} must be {rule}, got "{text}"') from None
    except OverflowError:
        raise PictureError(f'--{name} must be {rule}, got "{text}", which is too large') from None


def options(arguments):
    """The command line, checked as far as that goes without the result."""
    parser = Parser(prog="bash doc/picture.sh", description="Makes a picture of results of rpc: of a body, in the plane or in space, or of tables.",
                    epilog=EPILOG, allow_abbrev=False)
    parser.add_argument("results", metavar="RESULT", nargs="+", help="RESULT.e, or one or several of RESULT.contact.csv, of RESULT.history.csv, of RESULT.points.csv or of RESULT.json")
    parser.add_argument("--output", metavar="FILE", help="FILE.png, FILE.pdf or FILE.svg; default: RESULT.png beside RESULT")
    parser.add_argument("--style", metavar="NAME", default="light", help="light, dark, or print: greys and line patterns; default: light")
    body = parser.add_argument_group("pictures of a body, RESULT.e")
    body.add_argument("--field", metavar="NAME", help="a field of the file, or cell_size")
    body.add_argument("--scale", metavar="FACTOR", help="of the displacements, not of the gaps; default: one that makes them visible")
    body.add_argument("--time", metavar="T", help="time of the step to draw, of RESULT.points.csv too; default: the last one")
    body.add_argument("--window", metavar="X0,Y0,X1,Y1", help="enlarges this rectangle of the picture; in space X0,Y0,Z0,X1,Y1,Z1, "
                      "a box of the undeformed body, and what lies outside is not drawn")
    body.add_argument("--cut", metavar="x=0", help="in space: takes away what lies on this side of a plane across an axis")
    body.add_argument("--view", metavar="X,Y,Z", help="in space: direction from the body to the viewer; default: chosen")
    tables = parser.add_argument_group("diagrams of tables, RESULT.contact.csv, RESULT.history.csv, RESULT.points.csv and RESULT.json")
    tables.add_argument("--columns", metavar="NAME,...", help="columns, one panel for each; of contact sides also friction, the size of q, and "
                        "penetration, u_nu - gap; default: chosen")
    tables.add_argument("--over", metavar="NAME", help="column to the right; of contact sides x (of a body of revolution its radius), y, z, s (the length along the surface), or "
                        "radius; default: chosen")
    tables.add_argument("--range", metavar="LOW,HIGH", help="part of it that is shown; default: all")
    tables.add_argument("--centre", metavar="X,Y", help="where the radius is 0, in the directions across which it is measured; default: the middle of "
                        "what bears a pressure, or the plane of symmetry at which that ends")
    found = parser.parse_args(arguments)
    found.style = parsed(style_of, "style", found.style, "light, dark or print")
    found.scale = parsed(factor, "scale", found.scale, "a number >= 0")
    found.time = parsed(number, "time", found.time, "a number")
    found.window = parsed(window, "window", found.window, "x0,y0,x1,y1, in space x0,y0,z0,x1,y1,z1, "
                          "with x0 < x1, y0 < y1 and z0 < z1")
    found.cut = parsed(plane, "cut", found.cut, "an axis and a number, such as x=0")
    found.view = parsed(vector, "view", found.view, "three numbers that are not all 0, such as 1,-1,0.5")
    found.columns = parsed(words, "columns", found.columns, "names of columns, such as pressure,gap")
    found.range = parsed(span, "range", found.range, "two numbers, such as 0,0.5, the lower one first")
    found.centre = parsed(numbers, "centre", found.centre, "a number for each direction of the radius, such as 1.5,0")
    found.tables = are_tables(found)
    first = found.results[0]
    found.output = found.output or output_beside(table.path_of(first) if found.tables else first)
    if not output.format_of(found.output):
        kinds = [f".{kind}" for kind in output.FORMATS]
        raise PictureError(f'--output must end in {", ".join(kinds[:-1])} or {kinds[-1]}, got "{found.output}"')
    return found


def output_beside(path):
    """Where a picture goes by default; that of RESULT.json not where that of RESULT.e goes."""
    stem, ending = os.path.splitext(path)
    return stem + (f".{summary.kind_of(path)}.png" if ending.lower() == ".json" else ".png")


def are_tables(found):
    """Whether the results are tables, which go with other options than a body does."""
    tables = [text.lower().endswith((".csv", ".json")) for text in found.results]
    if any(tables) and not all(tables):
        raise PictureError(f'results of one picture must be of one kind, got "{found.results[tables.index(False)]}" beside '
                           f'"{found.results[tables.index(True)]}"; see --help')
    if not any(tables) and len(tables) > 1:
        raise PictureError(f"pictures of bodies are made one at a time, got {len(tables)} files; several of *.contact.csv, "
                           "of *.history.csv, of *.points.csv or of *.json go into one picture")
    for name in OF_BODIES if any(tables) else OF_TABLES:
        of_points = name == "time" and all(text.lower().endswith(OF_POINTS) for text in found.results)
        if getattr(found, name) is not None and not of_points:
            wanted = "RESULT.e" if any(tables) else "*.contact.csv, *.history.csv, *.points.csv and *.json"
            raise PictureError(f'"{found.results[0]}": --{name} does not go with it, but with {wanted}; see --help')
    return any(tables)


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
    """Of a body, as a figure."""
    result = Result(found.results[0], found.time)
    if result.dim == 2 and (found.cut or found.view):
        raise PictureError("--cut and --view are for bodies in space")
    if found.window is not None and found.window.shape[1] != result.dim:
        where, wanted = ("the plane", "x0,y0,x1,y1") if result.dim == 2 else ("space", "x0,y0,z0,x1,y1,z1")
        raise PictureError(f'"{found.results[0]}": --window of a body in {where} must be {wanted} [{result.units["length"]}], got {found.window.size} numbers')
    return figure.compose(Scene(result, found.field, found.scale, cut_of(result, found), found.window), found.view, found.style)


def diagram_of(found):
    """Of tables, as a figure."""
    tables = table.tables_of(found.results, len(found.style.curves))
    if tables[0].kind == "history" and all(getattr(found, name) is None for name in OF_TABLES):
        return history.compose(tables, found.style)
    return curves.compose(tables, found.columns, found.over, found.range, found.style, found.centre, found.time)


def main(arguments):
    """Exit code; 2: something of the command line or the result does not fit."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a message is one line
            found = options(arguments)
            output.write(found.output, diagram_of(found) if found.tables else picture_of(found), found.style)
    except PictureError as error:
        print(f"picture: error: {error}", file=sys.stderr)
        return 2
    except MemoryError:
        print(f'picture: error: "{arguments[0]}" takes more memory than there is', file=sys.stderr)
        return 2
    except Exception as error:  # pylint: disable=broad-except
        print(f"picture: internal error: {type(error).__name__}: {first_line(error)}; please report the command line and its files", file=sys.stderr)
        return 1
    print(f"wrote {found.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

# SPDX-License-Identifier: BSD-3-Clause
"""The gallery: classical and published problems, each solved by rpc and compared with what is right; started by ../gallery.sh.

Runs the decks of this folder, reads their JSON files, and writes README.md and the pictures. Formulas: problems.py, problems_soil.py, problems_tools.py.
Exit codes: 0; 1 a value lies outside its error bar, or a run has failed; 2 bad command line.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import problems
import problems_soil
import problems_tools

HERE = os.path.dirname(os.path.abspath(__file__))
PICTURE = os.path.join(HERE, "../picture.sh")
REFUSED = 5  # exit code where no solution exists
PICTURE_WIDTH, COLOURS = 760, 256  # [pixels] of the pictures, and the size of their palette
MOST_DIGITS = 8
PROBLEMS = (problems.hertz_line, problems.hertz_ball, problems.hertz_space, problems.sneddon_cone, problems.flat_punch,
            problems.westergaard, problems.mindlin, problems_soil.greco, problems_soil.namm_tsoy, problems_soil.ball_dent,
            problems_soil.weitsman, problems_soil.raft, problems_soil.footing, problems_soil.limit_load, problems_tools.wedge,
            problems_tools.rounded_punch, problems_tools.hertz_ellipsoid)


class CommandLineError(Exception):
    """What the user has to mend, as one sentence."""


class RunError(Exception):
    """A run that has not ended as it should."""


def probe(folder, name):
    """The displacement along x at a point of the bottom, linear between nodes, from the Exodus file."""
    sys.path.append(os.path.join(HERE, "../picture"))
    import numpy
    import result  # of doc/picture, with python3-netcdf4

    exodus = result.Result(os.path.join(folder, name + ".e"))
    bottom = exodus.positions[:, 1] < 1e-12
    x, u = exodus.positions[bottom, 0], exodus.nodal["disp_x"][bottom]
    order = numpy.argsort(x)
    return lambda at: float(numpy.interp(at, x[order], u[order]))


def solved(program, run, folder, target):
    """Results of a run: those of its JSON file, with "folder" and "probe"; none of a run that was to be refused."""
    changes = dict(run.changes)
    if target is not None:
        changes["Adapt->Target Relative Error"] = "%g" % target
    command = [program, "--input=" + os.path.join(HERE, run.deck), "--output=" + folder]
    command += ["--set=%s=%s" % change for change in changes.items()]
    print(*command[1:2], *command[3:], file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if run.refused:
        if done.returncode != REFUSED or run.refused not in done.stdout:
            raise RunError("%s: expected exit code %d and \"%s\", got exit code %d" % (run.deck, REFUSED, run.refused, done.returncode))
        return None
    if done.returncode != 0:
        raise RunError("%s\nexit code %d of: %s" % (done.stdout, done.returncode, " ".join(command)))
    with open(os.path.join(folder, run.name + ".json")) as file:
        summary = json.load(file)
    return {**summary, "folder": folder, "probe": lambda at: probe(folder, run.name)(at)}


def bar_of(quantity, runs):
    """The error bar, or None, and why there is none."""
    if isinstance(quantity.bar, str):
        return None, quantity.bar
    if isinstance(quantity.bar, float):
        return quantity.bar, ""
    run, key = quantity.bar
    adaptation = runs[run]["adaptation"]
    bar = adaptation["errors"][key]
    return bar, "" if bar is not None else adaptation["errors_unknown"][key]


class Compared:
    """A quantity with the program's value."""

    def __init__(self, quantity, runs):
        self.quantity = quantity
        self.value = quantity.value(runs)
        self.bar, self.why = bar_of(quantity, runs)

    @property
    def inside(self):
        """Whether the right value lies within the bar; None without a bar."""
        right = self.quantity.right
        return None if self.bar is None else abs(self.value - right) <= self.bar + 1e-9 * abs(right)

    def decimals(self):
        """So many that the bar has two digits."""
        if self.bar is None:
            return self.quantity.digits
        most = MOST_DIGITS - math.ceil(math.log10(abs(self.value)))
        return min(most, 1 - math.floor(math.log10(self.bar))) if self.bar > 0 else most

    def right_text(self):
        """The right value with a digit more than the bar."""
        right = self.quantity.right
        return "∞" if math.isinf(right) else "%.*f" % (self.decimals(), right)

    def value_text(self):
        """The program's value with its bar."""
        decimals = self.decimals()
        if self.bar is None:
            return "%.*f" % (decimals, self.value)
        bar = "%.*f" % (decimals, self.bar)
        return "%.*f ± %s" % (decimals, self.value, bar if float(bar) > 0 else "%.0e" % self.bar)

    def inside_text(self):
        """yes, no, or why there is no answer."""
        return {True: "yes", False: "**no**", None: "no bar: " + self.why}[self.inside]


class Solved:
    """A problem with its runs and comparisons."""

    def __init__(self, problem, program, folder, target):
        self.problem, self.runs = problem, []
        for k, run in enumerate(problem.runs):
            into = os.path.join(folder, "%s_%d" % (problem.name, k))
            self.runs.append(solved(program, run, into, target(run)))
        self.compared = [Compared(quantity, self.runs) for quantity in problem.quantities]

    def total(self, key):
        """Sum of a number over the runs that have results."""
        return sum(run["seconds"]["total"] if key == "seconds" else run[key] for run in self.runs if run)

    def unknowns(self):
        """Of the last mesh of each run."""
        return ", ".join("{:,}".format(run["dofs"]).replace(",", " ") for run in self.runs if run)


def table(columns, rows):
    """Markdown."""
    lines = ["| " + " | ".join(row) + " |" for row in [columns] + rows]
    lines.insert(1, "|---" * len(columns) + "|")
    return "\n".join(lines)


def anchor(title):
    """Of a heading, as Markdown's readers make it."""
    kept = "".join(letter for letter in title.lower() if letter.isalnum() or letter in " -_")
    return kept.replace(" ", "-")


def overview(gallery):
    """The table at the head of the page."""
    rows = []
    for k, solved_problem in enumerate(gallery, 1):
        first = solved_problem.compared[0]
        judged = [each.inside for each in solved_problem.compared if each.inside is not None]
        inside = "%d of %d" % (sum(judged), len(judged)) if judged else "no bars"
        title = solved_problem.problem.title
        rows.append([str(k), "[%s](#%s)" % (title, anchor(title)), "%s [%s]" % (first.quantity.name, first.quantity.unit), first.right_text(),
                     first.value_text(), inside, solved_problem.unknowns(), "%.1f" % solved_problem.total("seconds")])
    return table(["", "problem", "first quantity", "right", "rpc", "inside the bars", "unknowns", "time [s]"], rows)


def section(solved_problem):
    """One problem."""
    problem = solved_problem.problem
    rows = [["%s [%s]" % (each.quantity.name, each.quantity.unit), each.right_text(), each.value_text(), each.inside_text()]
            for each in solved_problem.compared]
    commands = []
    for run in problem.runs:
        path = os.path.relpath(os.path.join(HERE, run.deck), os.path.join(HERE, "../.."))
        commands.append(" ".join(["rpc --input=" + path] + ['--set="%s=%s"' % change for change in run.changes.items()])
                        + ("    # refused" if run.refused else ""))
    parts = ["## " + problem.title, problem.statement, "![%s](%s.png)" % (problem.title, problem.name),
             "Source: %s. Right: %s." % (problem.source, problem.equation), ("<!-- exit code: %d -->\n" % REFUSED if problem.runs[-1].refused else "") + "```sh\n%s\n```" % "\n".join(commands),
             table(["quantity", "right", "rpc", "inside"], rows)]
    if problem.remark:
        parts.append(problem.remark)
    return "\n\n".join(parts)


HEAD = """# Gallery

Classical and published problems, solved by rpc and compared with what is right by formulas that have nothing to do with it ([problems.py](problems.py),
[problems_soil.py](problems_soil.py), [problems_tools.py](problems_tools.py)). This page and its pictures are made by one command, from the decks of this folder:

```sh
bash doc/gallery.sh
```

A value of rpc stands with the error bar that the program prints itself, `adaptation->errors` of its JSON file ([results.md](../input/results.md)); where it prints none, the table says why. "Inside" is whether the right value lies
within the bar. Times are those of the runs on one core, and vary. `ctest -R gallery` solves the same problems to coarser targets.

Half planes and half spaces are infinite, meshes are not: the bodies end at an ellipse, whose foci are the ends of the contact, and there they are given the exact displacement of the infinite body. So the formulas hold for the finite ones.
"""


def page(gallery):
    """README.md."""
    judged = [each.inside for solved_problem in gallery for each in solved_problem.compared if each.inside is not None]
    verdict = "%d of the %d values with an error bar lie inside of it." % (sum(judged), len(judged))
    return "\n".join([HEAD, overview(gallery), "", verdict, "", "\n\n".join(map(section, gallery)), ""])


def draw(solved_problem, output):
    """The picture of a problem, smaller and with a palette: in a tenth of the space."""
    from PIL import Image

    problem = solved_problem.problem
    run = solved_problem.runs[problem.pictured]
    path = os.path.join(output, problem.name + ".png")
    command = ["bash", PICTURE, os.path.join(run["folder"], run["deck"] + ".e"), "--output=" + path, *problem.picture]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise RunError("%s\nexit code %d of: %s" % (done.stdout, done.returncode, " ".join(command)))
    with Image.open(path) as picture:
        height = round(picture.height * PICTURE_WIDTH / picture.width)
        small = picture.convert("RGB").resize((PICTURE_WIDTH, height), Image.LANCZOS)
    small.quantize(COLOURS, Image.MAXCOVERAGE, dither=Image.NONE).save(path, optimize=True)


class Parser(argparse.ArgumentParser):
    """Refuses with one line."""

    def error(self, message):
        raise CommandLineError(message + "; see --help")


def options(arguments):
    """The command line, checked."""
    parser = Parser(prog="bash doc/gallery.sh", description=__doc__.split("\n\n")[0], allow_abbrev=False)
    parser.add_argument("--program", required=True, metavar="RPC", help="the program")
    parser.add_argument("--problem", action="append", metavar="NAME", help="one problem, by its deck's name; any number of times; default: all")
    parser.add_argument("--quick", action="store_true", help="coarser targets for the error; writes no page and no pictures")
    parser.add_argument("--target", type=float, metavar="T", help="one target for all runs that have one; writes no page and no pictures")
    parser.add_argument("--output", default=HERE, metavar="FOLDER", help="where README.md and the pictures go; default: doc/gallery")
    chosen = parser.parse_args(arguments)
    if not os.access(chosen.program, os.X_OK) or os.path.isdir(chosen.program):
        raise CommandLineError('--program must name a program, got "%s"' % chosen.program)
    if chosen.target is not None and not 0 < chosen.target < 1:
        raise CommandLineError("--target must be in (0, 1), got %g" % chosen.target)
    if not os.path.isdir(chosen.output):
        raise CommandLineError('--output must name a folder, got "%s"' % chosen.output)
    chosen.problems = [make() for make in PROBLEMS]
    names = [problem.name for problem in chosen.problems]
    for name in chosen.problem or []:
        if name not in names:
            raise CommandLineError('--problem must be one of %s, got "%s"' % (", ".join(names), name))
    if chosen.problem:
        chosen.problems = [problem for problem in chosen.problems if problem.name in chosen.problem]
    return chosen


def target_of(chosen):
    """A function of a run: its target for the error, None to leave the deck's."""
    if chosen.quick:
        return lambda run: run.coarse
    return lambda run: chosen.target if run.coarse else None


def report(gallery):
    """Prints each value; the number that lie outside of their bars."""
    outside = 0
    for solved_problem in gallery:
        for each in solved_problem.compared:
            outside += each.inside is False
            print("%-22s %-36s right %-14s rpc %-26s %s" % (solved_problem.problem.name, each.quantity.name, each.right_text(), each.value_text(),
                                                           each.inside_text()))
    return outside


def made(chosen):
    """Solves, reports and writes; the number of values outside of their bars."""
    with tempfile.TemporaryDirectory(prefix="rpc_gallery_") as folder:
        gallery = [Solved(problem, chosen.program, folder, target_of(chosen)) for problem in chosen.problems]
        outside = report(gallery)
        if not (chosen.quick or chosen.target or chosen.problem):
            for solved_problem in gallery:
                draw(solved_problem, chosen.output)
            with open(os.path.join(chosen.output, "README.md"), "w") as file:
                file.write(page(gallery))
    return outside


def run(arguments):
    """The command; its exit code."""
    try:
        outside = made(options(arguments))
    except CommandLineError as error:
        print("gallery: %s" % error, file=sys.stderr)
        return 2
    except RunError as error:
        print("gallery: %s" % error, file=sys.stderr)
        return 1
    if outside:
        print("gallery: %d values lie outside of their bars" % outside, file=sys.stderr)
    return 1 if outside else 0


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))

# SPDX-License-Identifier: BSD-3-Clause
"""Each right value of the gallery lies within the error bar that the program prints, at coarser targets than those of the page; and the gallery would
tell if one did not."""

import contextlib
import importlib.util
import io
import math
import os
import pathlib
import re
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("RPC_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("RPC_PROGRAM", "rpc")
FOLDER = SOURCE / "doc" / "gallery"
sys.path.insert(0, str(FOLDER))
import gallery  # noqa: E402
import problems  # noqa: E402

LARGEST_PICTURE = 80_000  # bytes
SKIP = 77


def run(*options):
    """Exit code, standard output and standard error of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = gallery.run(["--program=" + PROGRAM, *options])
    return code, out.getvalue(), err.getvalue()


class Values(unittest.TestCase):
    def test_all_lie_within_their_bars(self):
        code, out, err = run("--quick")
        self.assertEqual(code, 0, out + err)
        self.assertGreaterEqual(len(re.findall(r" yes$", out, re.MULTILINE)), 25, out)

    def test_a_wrong_one_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            problem = problems.hertz_line()
            solved = gallery.Solved(problem, PROGRAM, folder, lambda run: run.coarse)
            force = solved.compared[0]
            off = problem.quantities[0].right + 1.1 * force.bar + abs(force.value - problem.quantities[0].right)
            wrong = gallery.Compared(problem.quantities[0]._replace(right=off), solved.runs)
        self.assertIs(force.inside, True)
        self.assertIs(wrong.inside, False)
        self.assertEqual(wrong.inside_text(), "**no**")

    def test_none_without_a_bar_counts(self):
        quantity = problems.Quantity("q", "m", 1, lambda runs: 2.0, "no bar is printed")
        self.assertIsNone(gallery.Compared(quantity, []).inside)
        self.assertEqual(gallery.Compared(quantity, []).inside_text(), "no bar: no bar is printed")

    def test_a_value_has_as_many_digits_as_its_bar(self):
        for bar, text in ((0.0123, "2.000 ± 0.012"), (0.5, "2.00 ± 0.50"), (30.0, "2 ± 30")):
            self.assertEqual(gallery.Compared(problems.Quantity("q", "m", 1, lambda runs: 2.0, bar), []).value_text(), text)


class Raft(unittest.TestCase):
    def test_a_yield_stress_out_of_reach_gives_weitsmans_beam(self):
        import problems_soil

        beam = problems_soil.weitsman().quantities
        largest = 4 * problems_soil.STIFFNESS * beam[1].right  # the pressure below the force
        contact, yields, settlement = problems_soil.solved_raft(largest * (1 - 1e-9))
        self.assertAlmostEqual(contact, math.pi / 2, places=6)
        self.assertLess(yields, 1e-3)
        self.assertAlmostEqual(settlement, beam[1].right, places=8)


class FarFields(unittest.TestCase):
    def test_are_those_of_the_decks(self):
        import far_fields

        for name, text in far_fields.decks().items():
            number = r"\d+\.\d+(?:e-\d+)?"
            written = (FOLDER / name).read_text()
            self.assertEqual(re.sub(number, "#", text), re.sub(number, "#", written), name)
            for made, given in zip(re.findall(number, text), re.findall(number, written)):
                self.assertAlmostEqual(float(made), float(given), delta=1e-6 * float(given), msg=name)

    def test_of_a_cylinder_is_that_of_hertz(self):
        import far_fields

        circle = far_fields.Profile(lambda x: x / 50)
        self.assertAlmostEqual(circle.load() / 2, problems.hertz_line().quantities[0].right, places=9)
        self.assertAlmostEqual(circle.pressure(0.0), problems.hertz_line().quantities[1].right, places=6)
        places, forces, logarithm = circle.rule()
        moments = [sum(forces * places**k) / circle.load() for k in (2, 4, 6)]  # of (1 - x^2)^(1/2)
        for moment, right in zip(moments, (1 / 4, 1 / 8, 5 / 64)):
            self.assertAlmostEqual(moment, right, places=9)
        self.assertAlmostEqual(logarithm / circle.load(), -0.5 - math.log(2), places=7)


class Page(unittest.TestCase):
    def test_has_each_problem_with_its_deck_and_a_small_picture(self):
        page = (FOLDER / "README.md").read_text()
        for make in gallery.PROBLEMS:
            problem = make()
            self.assertEqual(page.count("\n## " + problem.title + "\n"), 1, problem.title)
            self.assertEqual(page.count("(#%s)" % gallery.anchor(problem.title)), 1, problem.title)
            self.assertLess((FOLDER / (problem.name + ".png")).stat().st_size, LARGEST_PICTURE, problem.name)
            for each in problem.runs:
                self.assertTrue((FOLDER / each.deck).is_file(), each.deck)
            for quantity in problem.quantities:
                self.assertTrue("%s [%s]" % (quantity.name, quantity.unit) in page, quantity.name)
        self.assertGreaterEqual(len(gallery.PROBLEMS), 12)

    def test_says_of_no_value_that_it_lies_outside(self):
        lines = (FOLDER / "README.md").read_text().splitlines()
        self.assertEqual([line for line in lines if "**no**" in line], [])


class CommandLine(unittest.TestCase):
    def test_refuses_with_one_line(self):
        for options, message in ((["--problem=ball"], "--problem must be one of hertz_line, "), (["--target=2"], "--target must be in (0, 1), got 2"),
                                 (["--target=x"], "argument --target: invalid float value: 'x'"), (["--output=none"], '--output must name a folder, got "none"'),
                                 (["--picture"], "unrecognized arguments: --picture"), (["--program=none"], '--program must name a program, got "none"')):
            code, out, err = run(*options)
            self.assertEqual((code, out), (2, ""), options)
            self.assertEqual(err.count("\n"), 1, err)
            self.assertIn(message, err)


if __name__ == "__main__":
    if importlib.util.find_spec("netCDF4") is None:
        print("skipped: it takes netCDF4 (doc/packages.txt)")
        sys.exit(SKIP)
    unittest.main(verbosity=2)

# SPDX-License-Identifier: BSD-3-Clause
"""What the console ends with: how the run ended, its results with their error bars, work. The summary has the same numbers."""

import csv
import json
import re
import unittest

from rpc_run import RANKS, SMALL, RpcTestCase, errors

# Headings of lines, and the keys of the summary's results on them in their order.
LINES = {"contact force": ["contact_force"], "largest pressure": ["max_pressure"], "largest penetration": ["max_penetration"],
         "initial penetration": ["max_initial_penetration"], "in contact": ["contact_length", "contact_area"],
         "yielded": ["yielded_length", "yielded_area"], "dents": ["max_dent", "dent_volume"],
         "friction": ["max_shear", "max_slip", "stick_length", "stick_area", "slip_length", "slip_area"],
         "body": ["max_displacement", "max_strain", "max_von_mises"], "energy J": ["energy_J"],
         "since the start": ["strain_energy", "foundation_energy", "dissipated_energy", "work", "energy_imbalance", "dissipated_by_friction"]}
NUMBER = r"-?[\d.]+(?:e[-+]\d+)?"
VALUE = re.compile(rf"(?P<open>\()?(?P<value>{NUMBER})(?: ± (?P<bar>{NUMBER}))?\)?(?P<ten>e[-+]\d+)?(?P<unit> [^\s(,;]+)?"
                   r"(?: \((?P<note>[^()]*)\))?(?:, components \((?P<components>[^)]*)\)(?P<power>e[-+]\d+)?)?")
PLACE = re.compile(r' at \(([^)]*)\) (\S+)(?: on "([^"]*)")?(?: and (\d+) other nodes?)?')
TWO_SIDES = """deck:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [8, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {left: {X: 0.0}}
  Traction: {top: {Y: -2.0}, right: {X: 1.0}}
  Contact: {Side: bottom, Yield Stress: 5.0, Sides: {right: {Gap: 0.0001}}}
"""
SQUEEZED = """deck:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [8, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {left: {X: 0.0}}
  Contact: {Side: bottom, Gap: -0.002, Sides: {top: {Gap: -0.002}}}
"""
FOOT = """deck:
  Units: {Length: mm, Force: N}
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [8, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {left: {X: 0.0}}
  Traction: {top: {Y: "-1 - x/2"}}
  Contact: {Side: bottom, Yield Stress: inf, Gap: "0.01*(x - 1.1)^2"}
"""
NO_CONTACT = """deck:
  Mesh: {Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [4, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {the left end: {Side: left, X: 0.0, Y: 0.0}}
  Traction: {right: {X: 3.0}}
"""


def end_of(stdout):
    """The lines after the table: (heading, text) of each, lines that go on put together."""
    lines = []
    for line in stdout.rpartition("\n\n")[2].splitlines():
        heading, text = line[:22].strip(), line[22:]
        if line.startswith("  reaction at ") or line.startswith("  on "):  # names may be longer
            heading, text = re.match(r'  ((?:reaction at|on) "[^"]*") +(.*)', line).groups()
        if not heading and lines:
            lines[-1] = (lines[-1][0], lines[-1][1] + " " + text.strip())
        else:
            lines.append((heading, text))
    return lines


def last_digit(text):
    """What one unit of a printed number's last digit is."""
    mantissa, _, power = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    if decimals == 0:
        decimals = -max(0, len(mantissa) - len(mantissa.rstrip("0")))
    return 10.0 ** (int(power or 0) - decimals)


class ConsoleTestCase(RpcTestCase):
    def run_deck(self, *arguments, deck="beam.xml", code=0):
        if not deck.endswith("xml"):
            (self.folder / "deck.yaml").write_text(deck)
            deck = "deck.yaml"
        result = self.rpc(f"--input={deck}", "--output=out", *arguments, code=code)
        self.assertEqual(errors(result), [])
        self.stdout = result.stdout
        self.summary = json.loads((self.folder / "out" / f"{deck.rpartition('.')[0]}.json").read_text())
        self.lines = end_of(result.stdout)
        self.end = dict(self.lines)
        return self.summary["results"]

    def check_number(self, text, result, what):
        """A printed number is that of the summary, to the digits that it shows."""
        found = VALUE.fullmatch(text)
        self.assertTrue(found, f"{what}: {text}")
        ten = found["ten"] or ""
        vector = isinstance(result["value"], list)
        value = sum(x * x for x in result["value"]) ** 0.5 if vector else result["value"]
        shown = found["value"] + ten
        self.assertAlmostEqual(float(shown), value, delta=0.51 * max(last_digit(shown), 1e-6 * abs(value)), msg=f"{what}: {text}")
        self.assertEqual((found["unit"] or " 1").strip(), result["unit"], what)
        bar = result["error_bar"]
        if found["bar"]:
            self.assertAlmostEqual(float(found["bar"] + ten), bar, delta=0.051 * bar, msg=f"{what}: {text}")
        elif float(found["value"]) == 0 and value > 0:
            self.assertIn(found["note"], ["to rounding", "to the solver's tolerance"], what)
            self.assertLess(value + (bar or 0), 1e-8, what)
        elif bar is not None:
            self.assertIn(found["note"], ["exact", "to rounding"], what)
            self.assertLessEqual(bar, 1e-11 * abs(value), what)
        self.assertEqual(bar is None, bool(result.get("reason")), what)
        if vector and value > 0 and float(found["value"]) > 0:
            for shown, component in zip(found["components"].split(", "), result["value"]):
                shown += found["power"] or ""
                self.assertAlmostEqual(float(shown), component, delta=0.51 * max(last_digit(shown), 2e-6 * value), msg=f"{what}: {text}")

    def check_place(self, found, pressure):
        """Where the largest pressure is."""
        self.assertTrue(found)
        for shown, coordinate in zip(found[1].split(", "), pressure["place"], strict=True):
            self.assertAlmostEqual(float(shown), coordinate, delta=1e-5)
        self.assertEqual(found[2], self.summary["units"]["length"])
        self.assertEqual(int(found[4] or 0) + 1, pressure["nodes"])

    def check_block(self, results, end):
        """Lines against results; their number."""
        checked = 0
        for heading, text in end.items():
            if heading.startswith("reaction at "):
                self.check_number(text, results["reaction_force"][heading.split('"')[1]], heading)
                checked += 1
                continue
            if heading == "largest pressure" and "place" in results["max_pressure"]:
                self.check_place(PLACE.search(text), results["max_pressure"])
                text = PLACE.sub("", text)
            keys = [key for key in LINES.get(heading, []) if key in results]
            if heading == "contact force" or len(keys) == 1:
                parts = [re.sub(r" \(no error bar: .*|, the vector sum of .* below$", "", text)]
            else:  # "at most 0.01 m, volume 0.02 m^2"
                parts = [re.sub(r"^[A-Za-z ]*(?= )", "", part).strip() for part in text.split(", ")]
            self.assertEqual(len(parts) if keys else 0, len(keys), f"{heading}: {text}")
            for part, key in zip(parts, keys):
                self.check_number(part, results[key], f"{heading}, {key}")
                checked += 1
        return checked


class Numbers(ConsoleTestCase):
    def test_console_and_summary_show_the_same_numbers(self):
        for least, arguments in [(13, {}), (13, {"deck": "beam_adaptive.xml"}),
                                 (20, {"deck": "shear.xml"}), (11, {"deck": "block.xml"}), (10, {"deck": TWO_SIDES})]:
            settings = {"beam.xml": [SMALL, "--set=Adapt->Estimate Error=true"],
                        "beam_adaptive.xml": ["--set=Adapt->Target Relative Error=0.02"],
                        "shear.xml": ["--set=Mesh->Cells={12, 6}", "--set=Steps->Times={1, 1.5}"],
                        "block.xml": ["--set=Mesh->Cells={4, 4, 2}", "--set=Units->Length=mm"]}.get(arguments.get("deck", "beam.xml"), [])
            with self.subTest(arguments.get("deck")):
                results = self.run_deck(*settings, **arguments)
                self.assertGreaterEqual(self.check_block(results, self.end), least, self.stdout)
                self.assertEqual(results["energy_J"]["value"], self.summary["energy_J"])
                self.assertEqual(results["contact_force"]["value"], self.summary["contact_force"])
                for name, reaction in results["reaction_force"].items():
                    self.assertEqual(reaction["value"], self.summary["reaction_force"][name])
                for key, result in results.items():
                    if "error_bar" in result and result["error_bar"] is not None:
                        self.assertIn(key, sum((LINES[heading] for heading in self.end if heading in LINES), []))


@unittest.skipIf(RANKS > 1, "what is told does not depend on the number of ranks")
class Told(ConsoleTestCase):
    def test_error_bars_are_those_of_the_adaptation(self):
        results = self.run_deck("--set=Adapt->Target Relative Error=0.02", deck="beam_adaptive.xml")
        bars = dict(self.summary["adaptation"]["errors"])
        relative = bars.pop("contact_pressure_l2_relative")
        self.assertEqual({key: result["error_bar"] for key, result in results.items() if result.get("error_bar") is not None}, bars)
        for name, reaction in results["reaction_force"].items():
            exact = (5.5090 if name == "left" else -5.5090, -0.6352)  # adapted to 0.0005
            error = sum((a - b) ** 2 for a, b in zip(reaction["value"], exact)) ** 0.5
            self.assertLess(error, reaction["error_bar"])
            self.assertLess(reaction["error_bar"], 0.2)  # it is of use
        self.assertEqual(results["contact_pressure_error"]["value"], relative)
        self.assertEqual(results["estimated_error"]["value"], self.summary["error_estimate"]["relative"])
        self.assertIn(f"of the contact pressure {relative:.1e} of its norm in L2", self.end["estimated error"])
        self.assertRegex(self.end["contact force"], r"^\S+ ± \S+ N/m \(\S+ %\), components \(\S+, \S+\)$")
        self.assertRegex(self.end["largest pressure"], r"^16 Pa \(exact\) at \([\d.]+, 0\) m and \d+ other nodes$")  # all that yields
        self.assertEqual(self.end["adapted"], "the error is what was asked for")

    def test_what_is_rounding_is_0(self):
        """Of a block that is pressed evenly nothing pulls at the left, and a rigid foundation does not give way."""
        for cells in (8, 9, 10):
            results = self.run_deck(deck=f"""deck:
  Mesh: {{Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [{cells}, 7], Element: P2}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {{left: {{X: 0.0}}, top: {{Y: -0.01}}}}
  Contact: {{Side: bottom}}
""")
            self.assertRegex(self.end['reaction at "left"'], r"^0 N/m( \(to rounding\))?$")
            self.assertLess(abs(results["reaction_force"]["left"]["value"][0]), 1e-9)
            self.assertEqual(self.end.get("largest penetration", "0 m (to the solver's tolerance)"), "0 m (to the solver's tolerance)")
            self.assertNotIn("rounding", self.end['reaction at "top"'])

    def test_what_has_no_error_bar_says_why_in_its_line(self):
        results = self.run_deck("--set=Adapt->Target Relative Error=0.02", "--set=Contact->Yield Stress=x < 2.5 ? 3 : inf", deck="beam_adaptive.xml")
        reason = self.summary["adaptation"]["errors_unknown"]["max_pressure"]
        self.assertEqual((results["max_pressure"]["error_bar"], results["max_pressure"]["reason"]), (None, reason))
        self.assertRegex(self.end["largest pressure"], rf"^\S+ Pa at \(\S+, 0\) m \(no error bar: {re.escape(reason)}\)$")
        self.assertIn("±", self.end["contact force"])

    def test_where_the_largest_pressure_is_and_what_the_load_alone_fixes(self):
        results = self.run_deck("--set=Adapt->Target Relative Error=0.1", deck=FOOT)
        rows = list(csv.DictReader((self.folder / "out" / "deck.contact.csv").read_text().splitlines()))
        most = max(rows, key=lambda row: float(row["pressure [MPa]"]))
        pressure = results["max_pressure"]
        self.assertEqual((pressure["nodes"], pressure["place"]), (1, [float(most["x [mm]"]), float(most["y [mm]"])]))
        self.assertIn(f" at ({float(most['x [mm]']):.6g}, 0) mm", self.end["largest pressure"])
        # No displacement is held along y: the contact force is the load to rounding, though the mesh is coarse.
        self.assertEqual(results["contact_force"]["error_bar"], 0)
        self.assertAlmostEqual(results["contact_force"]["value"][1], 3, delta=1e-7)
        self.assertRegex(self.end["contact force"], r"^3 N/mm \(exact\), components \(0, 3\), fixed by the load$")
        held = self.run_deck("--set=Adapt->Target Relative Error=0.1", "--set=Dirichlet->left->Y=0", deck=FOOT)
        self.assertGreater(held["contact_force"]["error_bar"], 0)
        self.assertNotIn("fixed by the load", self.stdout)
        self.run_deck(deck=TWO_SIDES)
        self.assertRegex(self.end["largest pressure"], r' m on "(bottom|right)"')

    def test_forecasts_tell_unknowns_and_what_the_mesh_before_told(self):
        self.run_deck("--set=Adapt->Target Relative Error=0.001", deck="beam_adaptive.xml")
        told = re.findall(r"^next mesh: about (\d+) dofs; the target with about (\d+) dofs in about (\d+) s(.*)$", self.stdout, re.MULTILINE)
        cycles = self.summary["adaptation"]["cycles"]
        self.assertEqual(len(told), len(cycles) - 1)
        self.assertGreaterEqual(len(told), 2)
        self.assertEqual(told[0][3], ", as one mesh tells")
        for before, (_, _, _, end) in zip(told, told[1:]):
            self.assertEqual(end, f"; the mesh before told {before[1]} dofs")
        self.assertLess(abs(int(told[-1][1]) / cycles[-1]["dofs"] - 1), 0.5)  # of the last mesh
        self.run_deck("--set=Adapt->Target Relative Error=0.001", "--set=Adapt->Max Dofs=3000", deck="beam_adaptive.xml", code=4)
        self.assertIn('dofs, more than "Adapt->Max Dofs" = 3000', self.stdout)

    def test_without_an_estimate_one_line_tells_how_to_have_error_bars(self):
        results = self.run_deck(SMALL)
        self.assertNotIn("±", self.stdout)
        self.assertEqual(self.stdout.count("not estimated"), 1)
        for parameter in ["Adapt->Target Relative Error", "Adapt->Estimate Error"]:
            self.assertIn(f'"{parameter}"', self.end["errors"])
        self.assertIn("Adapt->Target Relative Error", results["max_pressure"]["reason"])

    def test_an_estimate_on_one_mesh_gives_the_bar_of_the_energy(self):
        results = self.run_deck(SMALL, "--set=Adapt->Estimate Error=true")
        self.assertEqual([key for key, result in results.items() if result.get("error_bar") is not None], ["energy_J"])
        bar = results["energy_J"]["error_bar"]
        self.assertLess(abs(self.summary["energy_J"] + 0.21344083), bar)  # J as in test/benchmark/reference.json
        self.assertAlmostEqual(bar, self.summary["error_estimate"]["relative"] ** 2 * self.summary["energy_norm_squared"], delta=1e-9 * bar)
        self.assertIn("of J alone", self.end["errors"])

    def test_an_estimate_that_is_mostly_contact_that_the_mesh_misses_is_the_least(self):
        """A bump reaches into a body at rest, between its nodes; as deep at a node."""
        for middle, at_least in [("0.3125", True), ("0.25", False)]:
            self.run_deck("--set=Adapt->Estimate Error=true", deck=f"""
rpc:
  Mesh: {{Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4], Element: P2}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {{top: {{X: 0.0, Y: 0.0}}}}
  Contact: {{Side: bottom, Normal: "0, -1", Gap: "0.05 - 0.06*exp(-((x - {middle})/0.02)^2)"}}
""")
            self.assertEqual(self.summary["error_estimate"]["at_least"], at_least)
            self.assertEqual(self.end["estimated error"].startswith("at least "), at_least)

    def test_an_estimate_of_rounding_gives_no_bar_and_no_advice(self):
        self.run_deck(SMALL, "--set=Traction->top->Y=0", "--set=Adapt->Estimate Error=true")
        self.assertEqual(self.end["errors"], "not known: the strain energy is at rounding level")

    def test_a_guaranteed_bound_where_nothing_is_strained_is_no_share_of_0(self):
        self.run_deck(SMALL, "--set=Traction->top->Y=0", "--set=Adapt->Error Bound=guaranteed")
        self.assertEqual(self.end["guaranteed"], "J of the exact solution is in [0, 0] J/m; error at most 0.0e+00 in the energy norm")

    def test_the_end_begins_with_the_outcome_and_has_the_residuals_once(self):
        self.run_deck(SMALL)
        self.assertEqual(self.stdout.count("duality gap"), 1)
        end = self.stdout.rpartition("\n\n")[2]
        self.assertRegex(end, r"\Aconverged: KKT residual \S+, equilibrium residual \S+, energy balance \S+, duality gap \S+, tolerance 1e-08\n")
        self.assertEqual(self.summary["residual_tolerance"], 1e-8)
        shown = re.search(r"duality gap (\S+),", end)[1]
        self.assertAlmostEqual(float(shown), self.summary["duality_gap"], delta=0.06 * self.summary["duality_gap"])
        headings = [heading for heading, _ in self.lines]
        order = ["contact force", "largest pressure", "in contact", 'reaction at "left"', "energy J", "mesh misses", "notes", "work", "time"]
        self.assertEqual([heading for heading in headings if heading in order], order)
        self.assertTrue(end.splitlines()[-1].startswith("  wrote "))

    def test_residuals_of_iterations_that_others_follow_are_in_the_table(self):
        self.run_deck(SMALL, "--set=Uzawa->Stopping Test=multiplier change")
        iterations = self.summary["uzawa_iterations"]
        self.assertGreater(iterations, 1)
        self.assertEqual(len(re.findall(r"^ +\d+ +-- kkt", self.stdout, re.MULTILINE)), iterations - 1)
        self.run_deck(SMALL, "--set=Uzawa->Stopping Test=multiplier change", "--verbose")
        self.assertEqual(len(re.findall(r"^ +\d+ +-- kkt", self.stdout, re.MULTILINE)), iterations)

    def test_what_was_skipped_is_told_on_request_and_in_the_summary_always(self):
        self.run_deck(SMALL)
        self.assertNotIn("skipped", self.stdout)
        skipped = self.summary["skipped"]
        self.assertGreater(len(skipped), 1)
        self.run_deck(SMALL, "--verbose")
        self.assertEqual(re.findall(r"^ +skipped +(.*)$", self.stdout, re.MULTILINE), skipped)
        self.assertEqual(self.summary["skipped"], skipped)

    def test_without_contact_there_are_supports_body_and_energy(self):
        results = self.run_deck(deck=NO_CONTACT)
        self.assertEqual(self.check_block(results, self.end), 5, self.stdout)
        self.assertEqual(set(results), {"reaction_force", "max_displacement", "max_strain", "max_von_mises", "energy_J"})
        self.assertRegex(self.stdout, r'\n  reaction at "the left end" 3 N/m, components \(-3, \S+\)\n')
        self.assertNotIn("mesh misses", self.stdout)

    def test_each_of_several_sides_has_a_line(self):
        results = self.run_deck(deck=TWO_SIDES)
        sides = results["contact_sides"]
        self.assertEqual(list(sides), ["bottom", "right"])
        for name, side in sides.items():
            lines = dict(re.match(r"(contact force|largest pressure|largest penetration|in contact|yielded|dents) (.*)", part).groups()
                         for part in self.end[f'on "{name}"'].split("; "))
            self.assertGreaterEqual(self.check_block({**side, "reaction_force": {}}, lines), 5)

    def test_the_force_of_several_sides_is_called_their_sum(self):
        self.run_deck(deck=SQUEEZED)
        self.assertEqual(self.end["contact force"], "0 N/m (to rounding), the vector sum of 2 sides, each of which stands below")
        for name, force in (("bottom", "8.79121"), ("top", "-8.79121")):
            self.assertIn(f"contact force 8.79121 N/m, components (0, {force})", self.end[f'on "{name}"'])

    def test_steps_say_when_their_results_are_and_after_a_failure_that_they_are_those_before(self):
        steps = [SMALL, "--set=Traction->top->Y=-20*t*sin(pi*x/5)"]
        self.run_deck(*steps, "--set=Steps->Times={0.5, 1}")
        self.assertEqual(self.end["results"], "at t = 1, the last of 2 steps")
        hard = ["--set=Contact->Gap=0.004*sin(pi*x/5)", "--set=NOX->Maximum Iterations=1", "--set=Uzawa->Maximum Iterations=1",
                "--set=Nested Iteration->Enabled=false", "--set=Steps->Max Halvings=0", "--set=Adapt->Estimate Error=true"]
        results = self.run_deck(*steps, *hard, "--set=Steps->Times={1e-4, 1e-3, 1}", code=4)
        self.assertTrue(self.lines[0][0] + self.lines[0][1] and "NOT CONVERGED: at t = 1: " in self.stdout)
        self.assertEqual(self.end["results"], "of the last step that converged, t = 0.001")
        self.assertGreater(self.check_block(results, self.end), 10)
        self.assertIsInstance(results["energy_J"]["error_bar"], float)  # of the step whose results these are
        results = self.run_deck(*steps, *hard, "--set=Steps->Times={1, 2}", code=4)
        self.assertIn("none: the last iterate is no solution", self.end["results"])
        self.assertIn("kkt", self.end["residuals"])
        self.assertEqual((results["energy_J"]["value"], results["energy_J"]["error_bar"]), (None, None))
        self.assertEqual(results["energy_J"]["reason"], "there is no solution")
        self.assertNotIn("nan", self.stdout)

    def test_a_guaranteed_interval_of_J_is_its_bar(self):
        for more in ([], ["--set=Mesh->Element=P2", "--set=Adapt->Target Relative Error=0.05"]):
            results = self.run_deck(SMALL, "--set=Adapt->Error Bound=guaranteed", *more)
            lower, upper = self.summary["error_bound"]["energy_J"]
            value, bar = results["energy_J"]["value"], results["energy_J"]["error_bar"]
            if not more:
                self.assertAlmostEqual(bar, max(upper - value, value - lower))
                self.assertIn("bounded of J alone", self.end["errors"])
            self.assertLessEqual(bar, 1.0001 * max(upper - value, value - lower))
            self.check_block(results, self.end)

    def test_names_the_units_of_the_deck(self):
        results = self.run_deck(SMALL, "--set=Units->Length=mm")
        self.assertEqual((results["contact_force"]["unit"], results["energy_J"]["unit"]), ("N/mm", "mJ/mm"))
        self.check_block(results, self.end)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""The names of units in all that a run prints, and the body's largest numbers."""

import csv
import re
import unittest

from rpc_run import SMALL, SOURCE, RpcTestCase


class Units(RpcTestCase):
    """Names of units change what is printed, and no number."""

    STEPS = "--set=Steps->Times={0.5, 1}"
    IN_MM = ["--set=Units->Length=mm", "--set=Units->Force=N"]

    def headings(self, folder, table):
        return next(csv.reader((self.folder / folder / f"beam.{table}.csv").read_text().splitlines()))

    def test_default_is_metre_and_newton(self):
        summary = self.solve(self.STEPS)
        self.assertEqual(summary["units"], {"length": "m", "force": "N/m", "stress": "Pa", "energy": "J/m"})
        for table in ("contact", "history"):
            self.assertNotIn("[", "".join(self.headings("out", table)))

    def test_results_are_printed_in_the_decks_units(self):
        plain = self.solve(self.STEPS, output="plain")
        named = self.solve(self.STEPS, *self.IN_MM)
        self.assertEqual(named.pop("units"), {"length": "mm", "force": "N/mm", "stress": "MPa", "energy": "mJ/mm"})
        del plain["units"]
        self.assertEqual(named["results"]["contact_force"]["unit"], "N/mm")
        for summary in (plain, named):
            del summary["seconds"]
            for result in [*summary["results"].values(), *summary["results"]["reaction_force"].values()]:
                result.pop("unit", None)
            for step in summary["steps"]:
                del step["seconds"]
            for level in summary["levels"]:
                del level["seconds"]
        self.assertEqual(named, plain)
        self.assertEqual(self.headings("out", "contact"), ["x [mm]", "y [mm]", "s [mm]", "u_nu [mm]", "gap [mm]", "pressure [MPa]", "state",
                                                           "side", "dent [mm]", "u_t_x [mm]", "u_t_y [mm]", "force_x [N/mm]",
                                                           "force_y [N/mm]"])
        history = self.headings("out", "history")
        self.assertEqual([re.sub(r" \[.*\]", "", name) for name in history], self.headings("plain", "history"))
        for name in ("time", "work [mJ/mm]", "max_pressure [MPa]", "max_dent [mm]", "dent_volume [mm^2]", "contact_length [mm]",
                     "contact_force_y [N/mm]", "left_displacement_x [mm]", "left_reaction_x [N/mm]", "seconds", "max_strain",
                     "max_von_mises [MPa]"):
            self.assertIn(name, history)

    def test_console_and_messages_about_loads_use_them(self):
        text = self.rpc("--input=beam.xml", SMALL, "--output=out", *self.IN_MM).stdout
        for part in (" mJ/mm\n", " N/mm, components (", "16 MPa at (", " mm and ", " mm^2\n"):
            self.assertIn(part, text)
        self.assertNotRegex(text, r"[0-9] (Pa|J/m|N/m|m)\b")
        block = SOURCE / "test" / "verification" / "decks" / "block.xml"
        refused = self.rpc(f"--input={block}", "--set=Traction->top->Y=-10.1", "--output=out", *self.IN_MM, code=5)
        self.assertIn("10.1 [N/mm]", refused.stderr)

    def test_moduli_of_no_material_are_told(self):
        def notes(*assignments):
            checked = self.rpc("--input=beam.xml", "--check", *(f"--set={assignment}" for assignment in assignments)).stdout
            return [line for line in checked.splitlines() if "Young's Modulus" in line and line.startswith("note:")]
        in_mm = ("Units->Length=mm", "Units->Force=N")
        modulus = "Material->Young's Modulus="
        self.assertEqual(notes(*in_mm, modulus + "2.1e11"),
                         ["note: \"Material->Young's Modulus\" = 2.1e+11 [MPa] is 2.1e+17 Pa, more than any known material has (diamond "
                          "1.2e+12 Pa): is it in the deck's units? Steel has 210000 [MPa]"])
        (soft,) = notes(*in_mm, modulus + "2.1e-5")
        self.assertIn("is 21 Pa, less than any known material has (brain tissue 100 Pa)", soft)
        self.assertEqual(len(notes(modulus + "2.1e17")), 1)
        for quiet in ((*in_mm, modulus + "2.1e5"), (modulus + "2.1e11",), (modulus + "1",),  # which may have no dimension
                      ("Units->Length=in", "Units->Force=lbf", modulus + "3e18")):
            self.assertEqual(notes(*quiet), [], quiet)

    def test_may_change_at_a_restart(self):
        every = ["--set=Steps->Checkpoint Every=1"]
        self.solve("--set=Steps->Times={0.5}", *every)
        resumed = self.solve(self.STEPS, *every, *self.IN_MM, "--restart")
        self.assertEqual(len(resumed["steps"]), 2)
        self.assertGreater(resumed["steps"][0]["max_von_mises"], 0)


class LargestNumbers(RpcTestCase):
    def test_of_a_pressed_block_are_those_of_uniaxial_strain(self):
        # No Poisson's ratio: strain and stress are those of one direction.
        summary = self.solve("--set=Material->Poisson's Ratio=0", "--set=Dirichlet->left->Y=", "--set=Dirichlet->right->Y=",
                             "--set=Traction->top->Y=-20", "--set=Contact->Yield Stress=inf")
        self.assertAlmostEqual(summary["max_strain"], 0.01, delta=1e-9)
        self.assertAlmostEqual(summary["max_von_mises"], 20, delta=1e-6)
        self.assertAlmostEqual(summary["max_displacement"], 0.01, delta=1e-9)

    def test_note_tells_where_strains_are_not_small(self):
        quiet = self.rpc("--input=beam.xml", SMALL, "--output=out").stdout
        self.assertNotIn("small strains are assumed", quiet)
        self.assertRegex(quiet, r"body +displacement at most \S+ m, strain \S+, von Mises \S+ Pa\n")
        loud = self.rpc("--input=beam.xml", SMALL, "--output=out", "--set=Material->Young's Modulus=100", "--set=Contact->Yield Stress=2",
                        "--set=Steps->Times={0.5, 1}", "--set=Traction->top->Y=-20*t*sin(pi*x/5)").stdout
        self.assertRegex(loud, r"note +strains reach [\d.]+ at t = 1: small strains are assumed")


if __name__ == "__main__":
    unittest.main()

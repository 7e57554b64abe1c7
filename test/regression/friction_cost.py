# SPDX-License-Identifier: BSD-3-Clause
"""What friction costs beside none is measured into a table, in place of what the table had, and drawn."""
import csv
import os
import subprocess
import sys
import unittest

from rpc_run import PROGRAM, SOURCE, RpcTestCase

try:
    import matplotlib
except ImportError:
    matplotlib = None
SCRIPT = SOURCE / "test" / "benchmark" / "friction_cost.py"


class FrictionCost(RpcTestCase):
    def start(self, *words):
        return subprocess.run([sys.executable, "-B", SCRIPT, *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)

    def rows(self):
        with open(self.folder / "friction_cost.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_runs_with_and_without_friction_make_a_table_and_its_picture(self):
        kept = (SOURCE / "doc" / "friction_cost.csv").read_text()
        (self.folder / "friction_cost.csv").write_text(kept)
        before = self.rows()
        done = self.start("measure", "--backend=one core", "--scenes=shear.xml", "--repeats=1", os.path.abspath(PROGRAM))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        after = self.rows()
        self.assertEqual([row["scene"] for row in after], [row["scene"] for row in before])
        measured = [row for row in after if (row["scene"], row["backend"]) == ("shear.xml", "one core")]
        self.assertEqual([row for row in after if row not in measured], [row for row in before if (row["scene"], row["backend"]) != ("shear.xml", "one core")])
        without, rubbed = measured
        for row, mu in ((without, "0"), (rubbed, "0.3")):
            self.assertEqual((row["unknowns"], row["backend"], row["mu"], row["load steps"], row["runs"]), ("9506", "one core", mu, "26", "1"))
            self.assertGreater(float(row["seconds"]), 0)
        self.assertGreater(int(rubbed["Newton steps"]), int(without["Newton steps"]))
        self.assertGreaterEqual(int(without["iterations"]), int(without["Newton steps"]))
        if matplotlib:
            done = self.start("draw", "friction_cost.csv")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue((self.folder / "friction_cost.png").read_bytes().startswith(b"\x89PNG"))

    def test_scenes_tables_and_programs_that_there_are_not_are_named(self):
        for words, told in ((("measure", "--backend=one core", "--scenes=shear", "rpc"), 'no scene "shear"; scenes: 32 x 32 x 16; '),
                            (("measure", "--backend=one core", "--scenes=shear.xml", "/nowhere/rpc"), "cannot start /nowhere/rpc"),
                            (("draw", "none.csv"), "none.csv has no rows")):
            done = self.start(*words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(told, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_tables_with_what_there_is_not_are_refused_before_anything_is_measured(self):
        line = "shear.xml,9506,one core,0,1,26,30,40,1,0.4.0"
        head = (SOURCE / "doc" / "friction_cost.csv").read_text().splitlines()[0]
        for text, told in ((f"{head}\n{line}\n{line.replace('shear', 'sheer')}\n", 'friction_cost.csv, line 3: no scene "sheer.xml"; there are: 32 x 32 x 16; '),
                           (f"{head}\n{line.replace('one core', 'two cores')}\n", 'line 2: no backend "two cores"; there are: one core; '),
                           ("scene,seconds\nshear.xml,1\n", "friction_cost.csv has the columns scene, seconds, not scene, unknowns, ")):
            (self.folder / "friction_cost.csv").write_text(text)
            for words in (("draw", "friction_cost.csv"), ("measure", "--backend=one core", "--scenes=shear.xml", "/nowhere/rpc")):
                done = self.start(*words)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(told, done.stderr)
                self.assertNotIn("Traceback", done.stderr)
            self.assertEqual((self.folder / "friction_cost.csv").read_text(), text)


if __name__ == "__main__":
    unittest.main()

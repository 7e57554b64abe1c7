# SPDX-License-Identifier: BSD-3-Clause
"""ablation.py with a program that only counts: which rules stay, what is run, and that it goes on where it has stopped."""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import ablation

# Solves a scene in as many steps as its rules say.
PROGRAM = f"""#!{sys.executable}
import json, os, sys
rules = {{"test.most_idle": 6, "test.share": 0.5, "test.least": 2, "test.start": 4}}
meanings = {{"test.least": "off: 7"}}
asked = os.environ.get("RPC_RULES", "")
if asked == "list":
    for name, value in rules.items():
        print(name, value, meanings.get(name, "a share [-]"), "this test", sep="\\t")
    sys.exit(2)
name, _, value = asked.partition("=")
if name:
    rules[name] = float(value)
idle, least, start = rules["test.most_idle"], rules["test.least"], rules["test.start"]
steps = [8 if idle > 100 else 4, 0 if start else -1, 0 if start != 2 else -2]
failed = least == 7
counts = dict(newton_iterations=[sum(steps)], linear_iterations=[9], linear_solves=sum(steps), preconditioner_setups=1, levels=[])
residuals = dict.fromkeys(["kkt_residual", "equilibrium_residual", "energy_balance", "duality_gap"], 1e-12)
json.dump(dict(counts, converged=not failed, reason="stagnated", max_pressure=1.0, energy_J=-1.0, seconds=dict(total=1.5, output=0.5), **residuals),
          open("scene.json", "w"))
print("u_nu,gap,pressure,state", 0.0, file=open("scene.contact.csv", "w"))
sys.exit(4 if failed else 0)
"""


class Ablation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.rpc = pathlib.Path(cls.folder.name) / "rpc"
        cls.rpc.write_text(PROGRAM)
        cls.rpc.chmod(0o755)

    def ablate(self, *words, csv="runs.csv"):
        """(exit code, what is printed, runs of the file)"""
        path, text = os.path.join(self.folder.name, csv), io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(io.StringIO()):
            code = ablation.main([f"--rpc={self.rpc}", f"--csv={path}", "--kinds=well-shaped,histories", "--scenes=1", "--jobs=2", *words])
        return code, text.getvalue(), ablation.read(path)

    def test_rules_are_listed_with_what_off_means(self):
        rules = {rule.name: rule.settings() for rule in ablation.listed(str(self.rpc))}
        self.assertEqual(rules["test.most_idle"], {"off": 1e9, "halved": 3, "doubled": 12})
        self.assertEqual(rules["test.share"], {"off": 0, "halved": 0.25, "doubled": 1})
        self.assertEqual(rules["test.least"]["off"], 7)

    def test_a_rule_stays_that_saves_steps_or_failures_and_goes_where_it_does_neither(self):
        code, text, runs = self.ablate()
        self.assertEqual(code, 0)
        cells = [[cell.strip() for cell in line.split("|")] for line in text.splitlines() if line.startswith("|")]
        verdicts = {line[1]: line[-2] for line in cells if line[2] == "off"}
        self.assertEqual(verdicts, {"test.most_idle": "stays: steps, worst scene", "test.share": "never met", "test.least": "stays: 2 fail",
                                    "test.start": "goes: better off; better halved"})
        scaled = {run.rule for run in runs if run.setting == "halved"}
        self.assertEqual(scaled, {"test.most_idle", "test.least", "test.start"})  # not of a rule that no scene meets
        ratios = ablation.Effect(ablation.by_setting(runs)["test.most_idle", "off"])
        self.assertAlmostEqual(ratios.steps, 9 / 5)
        self.assertEqual((ratios.changed, ratios.failed, ratios.seconds), (2, 0, 1.0))

    def test_goes_on_where_it_has_stopped(self):
        whole = self.ablate("--rules=idle", "--continue", csv="part.csv")[2]  # of no file
        path = pathlib.Path(self.folder.name) / "part.csv"
        lines = path.read_text().splitlines(keepends=True)
        path.write_text("".join(lines[:4]) + lines[4][:9])  # cut in the midst of a line
        code, _, runs = self.ablate("--rules=idle", "--continue", csv="part.csv")
        self.assertEqual(code, 0)
        self.assertEqual(sorted({run.job for run in runs}), sorted(run.job for run in whole))
        self.assertEqual({run.call for run in runs if run.rule}, {0, 1})
        self.assertEqual(len([run for run in runs if not run.rule]), 4)  # the rules as they are, in both calls

    def test_reports_runs_that_have_no_numbers(self):
        path = pathlib.Path(self.folder.name) / "empty.csv"
        self.ablate("--rules=idle", csv=path.name)
        line = path.read_text().splitlines()[-1].split(",")
        names = list(ablation.NUMBERS)
        empty = ["" if name in ("steps", "solves", "cg", "seconds", "energy", "counts") else cell for name, cell in zip(names, line)]
        path.write_text(path.read_text() + ",".join([*empty[:-1], "exit 4"]) + "\n")
        code, text, runs = self.ablate("--report", csv=path.name)
        self.assertEqual((code, runs[-1].failure), (0, "exit 4"))
        self.assertNotIn("nan", text)

    def test_what_cannot_be_run_or_read_is_told_in_one_line(self):
        foreign = pathlib.Path(self.folder.name) / "foreign.csv"
        foreign.write_text("a,b\n1,2\n")
        for words, told in ((["--rpc=/gone/rpc"], "/gone/rpc"), (["--rules=("], "--rules"), (["--jobs=0"], "--jobs"), (["--scenes=few"], "--scenes"),
                            (["--csv=/gone/a.csv"], "/gone/a.csv"), ([f"--csv={foreign}", "--report"], "foreign.csv"),
                            (["--csv=/gone/a.csv", "--report"], "/gone/a.csv")):
            errors = io.StringIO()
            with contextlib.redirect_stderr(errors), self.assertRaises(SystemExit) as ended:
                ablation.main([f"--rpc={self.rpc}", f"--csv={self.folder.name}/none.csv", "--kinds=well-shaped", "--scenes=1", *words])
            self.assertEqual(ended.exception.code, 2, words)
            self.assertIn(told, errors.getvalue().splitlines()[-1])

    def test_stops_in_time(self):
        code, text, runs = self.ablate("--budget=0", csv="none.csv")
        self.assertEqual((code, runs), (3, []))
        self.assertIn("--continue", text)

    def test_a_program_without_rules_is_refused_in_one_line(self):
        self.assertEqual(self.ablate("--rules=nothing", csv="none.csv")[0], 2)

    def test_seconds_count_above_their_scatter_alone(self):
        def effect(*seconds):
            run = lambda t: ablation.Run(0, "r", "off", 0.0, "hard", 1, "small", 0, steps=4, solves=4, cg=9, seconds=t, energy=1.0)
            return ablation.Effect([(run(t), run(1.0)) for t in seconds])
        self.assertEqual(effect(1.05, 1.04, 1.06, 1.05).gains(), ["seconds"])
        self.assertEqual(effect(1.5, 0.9, 0.8, 1.2).gains(), [])
        self.assertTrue(effect(0.95, 0.96, 0.94, 0.95).is_better())


if __name__ == "__main__":
    unittest.main()

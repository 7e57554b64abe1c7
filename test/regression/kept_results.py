# SPDX-License-Identifier: BSD-3-Clause
"""What a run with load steps has computed is on disk: after an error in a later step, a full disk, a signal and kill -9; and a restart
goes on with the same files."""

import csv
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from film import Film
from rpc_run import BEAM, LAUNCH, PROGRAM, RANKS, SMALL, SOURCE, RpcTestCase, errors, files, ranks_below

BLOCK = SOURCE / "test" / "verification" / "decks" / "block.xml"
TO_AND_FRO = "-20*sin(pi*x/5)*(0.6 + 0.4*sin(t))"
NOT_CONVERGED, NO_SOLUTION, BAD_INPUT = 4, 5, 2
TWENTY = ["--set=Steps->From=0.25", "--set=Steps->To=5", "--set=Steps->Step=0.25"]


def rows(path):
    return list(csv.DictReader(path.read_text().splitlines()))


class KeptResults(RpcTestCase):
    def out(self, end, output="out", deck="beam"):
        return self.folder / output / f"{deck}.{end}"

    def summary(self, output="out", deck="beam"):
        return json.loads(self.out("json", output, deck).read_text())

    def expect_steps(self, times, failed_at, reason, deck="beam"):
        """All files hold the steps at these times, and say what ended the run."""
        summary = self.summary(deck=deck)
        self.assertFalse(summary["converged"])
        self.assertEqual(summary["failed_at"], failed_at)
        self.assertIn(reason, summary["reason"])
        self.assertEqual([step["time"] for step in summary["steps"]], [*times, failed_at])
        self.assertEqual([step["converged"] for step in summary["steps"]], [True] * len(times) + [False])
        table = rows(self.out("history.csv", deck=deck))
        self.assertEqual([float(row["time"]) for row in table], [*times, failed_at])
        self.assertEqual([row["converged"] for row in table], ["1"] * len(times) + ["0"])
        self.assertIn(reason, table[-1]["reason"])
        self.assertEqual(table[-1]["work"], "nan")
        self.assertEqual(Film(self.out("e", deck=deck)).times, list(times))

    def test_a_load_that_grows_beyond_the_limit_leaves_the_steps_before(self):
        # The foundation carries 10 N/m: at t = 2.75, and not at 3.
        result = self.rpc(f"--input={BLOCK}", "--output=out", "--set=Traction->top->Y=-3.6*t", "--set=Steps->From=0.5", "--set=Steps->To=4",
                          "--set=Steps->Step=0.25", "--set=Uzawa->Tolerance=1e-8", code=NO_SOLUTION)
        self.assertEqual(len(errors(result)), 1)
        for part in ["at t = 3: ", "10.8 [N/m]", "at most 10 [N/m]", "step 10, t = 2.75"]:
            self.assertIn(part, errors(result)[0])
        self.assertIn("NOT CONVERGED: at t = 3", result.stdout)
        self.expect_steps([0.5 + 0.25 * k for k in range(10)], 3, "at most 10 [N/m]", "block")
        self.assertEqual(self.summary(deck="block")["time"], 2.75)

    def test_an_expression_that_fails_later_leaves_the_steps_before(self):
        result = self.rpc("--input=beam.xml", SMALL, "--output=out", "--set=Traction->top->Y=-20*sqrt(2.5-t)", "--set=Steps->Times={1,2,3}",
                          code=BAD_INPUT)
        self.assertEqual(len(errors(result)), 1)
        self.assertIn("at t = 3: ", errors(result)[0])
        self.expect_steps([1, 2], 3, "nan")

    @unittest.skipIf(RANKS > 1, "needs one rank: bad_input.py has such expressions on several")
    def test_an_expression_that_fails_in_the_first_step_leaves_nothing(self):
        result = self.rpc("--input=beam.xml", SMALL, "--output=out", "--set=Traction->top->Y=-20*sqrt(0.5-t)", "--set=Steps->Times={1,2}",
                          code=BAD_INPUT)
        self.assertEqual(len(errors(result)), 1)
        self.assertEqual(files(self.folder / "out"), [])

    @unittest.skipIf(RANKS > 1, "needs one rank: the summary does not depend on their number")
    def test_a_step_that_does_not_converge_has_no_energies(self):
        self.rpc("--input=beam.xml", SMALL, "--output=out", f"--set=Traction->top->Y={TO_AND_FRO}", "--set=Steps->Times={1,4}",
                 "--set=Steps->Max Halvings=1", "--set=NOX->Maximum Iterations=1", "--set=Uzawa->Maximum Iterations=1",
                 "--set=Nested Iteration->Enabled=false", "--set=Contact->Gap=0.004*sin(pi*x/5)", code=NOT_CONVERGED)
        last = self.summary()["steps"][-1]
        self.assertFalse(last["converged"])
        self.assertIsNone(last["strain_energy"])
        self.assertEqual(last["time"], self.summary()["failed_at"])
        self.assertLess(last["time"], 1)  # that of the part that failed
        self.assertTrue(last["reason"])

    def start(self, *arguments, deck="beam", output="out"):
        process = subprocess.Popen([*LAUNCH, PROGRAM, f"--input={deck}.xml", f"--output={output}", *arguments], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        return process

    def limited(self, size):
        """A run whose files cannot grow beyond a size, from its third step on."""
        process = self.start("--set=Mesh->Cells={40,8}", f"--set=Traction->top->Y={TO_AND_FRO}", *TWENTY)
        for line in process.stdout:
            if line.startswith("   3/"):
                break
        for rank in ranks_below(process.pid):
            resource.prlimit(rank, resource.RLIMIT_FSIZE, (size, size))
        out, err = process.communicate(timeout=600)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def test_a_disk_that_is_full_leaves_the_steps_before(self):
        self.rpc("--input=beam.xml", "--set=Mesh->Cells={40,8}", "--output=whole", f"--set=Traction->top->Y={TO_AND_FRO}", *TWENTY)
        whole = Film(self.out("e", "whole"))
        size = self.out("e", "whole").stat().st_size
        for share in [0.6, 0.75, 0.9] if RANKS == 1 else [0.75]:
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            result = self.limited(int(share * size))
            with self.subTest(share):
                self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
                self.assertEqual(len(errors(result)), 1)
                for part in ["at t = ", "output: ", '"out/beam.e"', "File too large"]:
                    self.assertIn(part, errors(result)[0])
                film = Film(self.out("e"))
                self.assertGreaterEqual(len(film.times), 3)
                self.assertEqual(film.times, whole.times[:len(film.times)])
                for name, values in film.nodal.items():
                    self.assertEqual(values, whole.nodal[name][:len(values)], name)
                self.assertGreaterEqual(len(rows(self.out("history.csv"))), len(film.times))
                self.assertEqual([name for name in files(self.folder / "out") if ".tmp." in name or "lock" in name], [])

    HISTORY = [f"--set=Traction->top->Y={TO_AND_FRO}", "--set=Steps->From=0.25", "--set=Steps->To=10", "--set=Steps->Step=0.25",
               "--set=Steps->Checkpoint Every=3", SMALL]

    def parts(self, output, deck):
        """The files of a film."""
        return sorted((self.folder / output).glob(f"{deck}.e*"))

    def expect_equal_runs(self, a, b, deck="beam"):
        """Tables and films to the last bit, but for times."""
        left, right = (rows(self.out("history.csv", output, deck)) for output in (a, b))
        self.assertEqual(len(left), len(right))
        for x, y in zip(left, right):
            self.assertEqual({k: v for k, v in x.items() if k != "seconds"}, {k: v for k, v in y.items() if k != "seconds"})
        self.assertEqual(self.out("contact.csv", a, deck).read_bytes(), self.out("contact.csv", b, deck).read_bytes())
        self.assertEqual([path.name for path in self.parts(a, deck)], [path.name for path in self.parts(b, deck)])
        for x, y in zip(self.parts(a, deck), self.parts(b, deck)):
            self.assertEqual(x.read_bytes(), y.read_bytes(), x.name)

    # Meshes change in some of the steps.
    ADAPTED = ["--set=Mesh->Cells={10,2}", "--set=Adapt->Target Relative Error=0.04", *HISTORY[:-1]]

    wholes = {}  # folders of runs without a break

    def run_whole(self, history, deck):
        """A run without a break, in the folder `whole`; the same for all tests that ask for it, for it takes its time."""
        key = (deck, *history)
        if key not in self.wholes:
            self.rpc(f"--input={deck}.xml", *history, "--output=whole")
            kept = tempfile.TemporaryDirectory(prefix="rpc_whole_")
            self.addClassCleanup(kept.cleanup)
            self.wholes[key] = pathlib.Path(kept.name) / "whole"
            shutil.copytree(self.folder / "whole", self.wholes[key])
        else:
            shutil.copytree(self.wholes[key], self.folder / "whole")

    def stopped(self, number, after, history, deck):
        """A run that gets a signal soon after a step: exit code and output."""
        process = self.start(*history, deck=deck)
        for line in process.stdout:
            if line.startswith(f"{after:4}/"):
                break
        time.sleep(random.random() * 0.02)
        found = ranks_below(process.pid)
        for rank in found if number == signal.SIGKILL else found[-1:]:
            os.kill(rank, number)
        out, err = process.communicate(timeout=600)
        return process.returncode, out + err

    def expect_same_end_after_kill(self, history, deck, attempts):
        self.run_whole(history, deck)
        random.seed(30)
        for attempt in range(attempts):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            step = random.randrange(4, 36)
            self.stopped(signal.SIGKILL, step, history, deck)
            with self.subTest((attempt, step)):
                films = [Film(path) for path in self.parts("out", deck)]  # readable, and whole
                self.assertGreaterEqual(sum(len(film.times) for film in films), step)
                self.assertGreaterEqual(len(rows(self.out("history.csv", deck=deck))), step)
                self.assertFalse(self.out("json", deck=deck).exists())
                result = self.rpc(f"--input={deck}.xml", *history, "--output=out", "--restart")
                self.assertIn("note: goes on after ", result.stdout)
                self.assertNotIn("lacks times", result.stdout)
                self.expect_equal_runs("whole", "out", deck)
                self.assertEqual([name for name in files(self.folder / "out") if ".tmp." in name or "lock" in name], [])

    def test_after_kill_a_restart_ends_as_the_run_without_a_break(self):
        self.expect_same_end_after_kill(self.HISTORY, "beam", 4 if RANKS == 1 else 1)

    def test_after_kill_a_restart_on_adapted_meshes_ends_as_the_run_without_a_break(self):
        self.expect_same_end_after_kill(self.ADAPTED, "beam_adaptive", 2 if RANKS == 1 else 1)
        self.assertGreater(len(self.parts("whole", "beam_adaptive")), 3)

    def test_after_a_signal_a_restart_on_adapted_meshes_ends_as_the_run_without_a_break(self):
        plain = [argument for argument in self.ADAPTED if "Checkpoint" not in argument]
        self.run_whole(self.ADAPTED, "beam_adaptive")  # checkpoints change nothing
        random.seed(31)
        for number, after in [(signal.SIGTERM, 5), (signal.SIGINT, 21)][:2 if RANKS == 1 else 1]:
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            code, text = self.stopped(number, after, plain, "beam_adaptive")
            with self.subTest(number.name):
                self.assertEqual(code, NOT_CONVERGED, text)
                kept = [int(path.name[-8:-2]) for path in (self.folder / "out").glob("*checkpoint*")]
                self.assertEqual(len(kept), 1)
                self.assertGreaterEqual(kept[0], after - 1)
                self.rpc("--input=beam_adaptive.xml", *plain, "--output=out", "--restart")
                self.expect_equal_runs("whole", "out", "beam_adaptive")

    @unittest.skipIf(RANKS > 1, "needs one rank: on several, restarts after kill -9 take over films")
    def test_an_older_checkpoint_on_an_adapted_mesh_takes_over_the_film_up_to_it(self):
        self.run_whole(self.ADAPTED, "beam_adaptive")
        shorter = [argument.replace("To=10", "To=2.5") for argument in self.ADAPTED]
        self.rpc("--input=beam_adaptive.xml", *shorter, "--output=out")
        result = self.rpc("--input=beam_adaptive.xml", *self.ADAPTED, "--output=out", "--restart=out/beam_adaptive.checkpoint-000006.e")
        self.assertIn('note: goes on after "out/beam_adaptive.checkpoint-000006.e", t = 1.5', result.stdout)
        self.expect_equal_runs("whole", "out", "beam_adaptive")
        times = [t for path in self.parts("out", "beam_adaptive") for t in Film(path).times]
        self.assertEqual(times, [0.25 * k for k in range(1, 41)])

    @unittest.skipIf(RANKS == 1, "needs several ranks, on which meshes in space are dealt out anew")
    def test_a_checkpoint_on_an_adapted_mesh_in_space_goes_on_as_the_run_without_a_break(self):
        deck = "block_adaptive"
        steps = ["--set=Traction->front->Z=-20*t", "--set=Adapt->Target Relative Error=0.08", "--set=Steps->Checkpoint Every=1"]
        self.rpc(f"--input={deck}.xml", *steps, "--set=Steps->Times={0.4,0.8,1.2}", "--output=whole")
        self.rpc(f"--input={deck}.xml", *steps, "--set=Steps->Times={0.4,0.8}", "--output=out")
        result = self.rpc(f"--input={deck}.xml", *steps, "--set=Steps->Times={0.4,0.8,1.2}", "--output=out", "--restart")
        self.assertIn("t = 0.8", result.stdout)
        self.expect_equal_runs("whole", "out", deck)

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_a_checkpoint_on_an_adapted_mesh_wants_a_deck_that_adapts(self):
        shorter = [argument.replace("To=10", "To=1.5") for argument in self.ADAPTED]
        self.rpc("--input=beam_adaptive.xml", *shorter, "--output=out")
        result = self.rpc("--input=beam_adaptive.xml", *self.ADAPTED, "--set=Adapt->Target Relative Error=0",
                          "--restart=out/beam_adaptive.checkpoint-000006.e", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["beam_adaptive.checkpoint-000006.e", "was adapted", "Adapt->Target Relative Error"])

    def test_a_checkpoint_whose_adapted_mesh_is_not_described_is_refused(self):
        shorter = [argument.replace("To=10", "To=0.75") for argument in self.ADAPTED]
        self.rpc("--input=beam_adaptive.xml", *shorter, "--output=out")
        (checkpoint,) = (self.folder / "out").glob("*checkpoint*")
        found = checkpoint.read_bytes()
        self.assertEqual([found.count(name) for name in (b"sizes_size", b"sizes_kind")], [2, 2])  # of the text, and of Exodus
        checkpoint.write_bytes(found.replace(b"sizes_size", b"sizes_?").replace(b"sizes_kind", b"sizes_size").replace(b"sizes_?", b"sizes_kind"))
        result = self.rpc("--input=beam_adaptive.xml", *self.ADAPTED, f"--restart={checkpoint}", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, [checkpoint.name, "how its adapted mesh was made", "Take an older one"])

    def test_a_signal_leaves_a_checkpoint(self):
        plain = [argument for argument in self.HISTORY if "Checkpoint" not in argument]
        code, text = self.stopped(signal.SIGTERM, 5, plain, "beam")
        self.assertEqual(code, NOT_CONVERGED, text)
        done = len([row for row in rows(self.out("history.csv")) if row["converged"] == "1"])
        self.assertGreaterEqual(done, 5)
        self.assertEqual([path.name for path in (self.folder / "out").glob("*checkpoint*")], [f"beam.checkpoint-{done:06}.e"])
        self.rpc("--input=beam.xml", *plain, "--output=out", "--restart")
        self.assertEqual(len(rows(self.out("history.csv"))), 40)
        self.assertEqual(Film(self.out("e")).times, [0.25 * k for k in range(1, 41)])

    def test_a_checkpoint_that_cannot_be_written_is_told_and_the_run_goes_on(self):
        (self.folder / "out" / "beam.checkpoint-000003.e").mkdir(parents=True)
        result = self.rpc("--input=beam.xml", *self.HISTORY, "--output=out")
        self.assertIn("note: no checkpoint at t = 0.75: ", result.stdout)
        self.assertEqual(len(rows(self.out("history.csv"))), 40)
        self.assertTrue((self.folder / "out" / "beam.checkpoint-000039.e").is_file())

    @unittest.skipIf(RANKS > 1, "needs one rank: on several, restarts after kill -9 take the newest")
    def test_restart_takes_the_newest_whole_checkpoint(self):
        result = self.rpc("--input=beam.xml", *self.HISTORY, "--output=out", "--restart", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["there is no checkpoint", '"out"', "--restart=FILE"])
        self.rpc("--input=beam.xml", *self.HISTORY, "--output=out")
        newest = self.folder / "out" / "beam.checkpoint-000039.e"
        newest.write_bytes(newest.read_bytes()[:-1000])
        longer = [argument.replace("To=10", "To=11") for argument in self.HISTORY]
        result = self.rpc("--input=beam.xml", *longer, "--output=out", "--restart")
        self.assertIn('note: goes on after "out/beam.checkpoint-000036.e", t = 9', result.stdout)
        self.rpc("--input=beam.xml", *longer, "--output=whole")
        self.expect_equal_runs("whole", "out")

    def test_fields_may_change_after_the_steps_that_are_done(self):
        three = [argument.replace("To=10", "To=0.75") for argument in self.HISTORY]
        self.rpc("--input=beam.xml", *three, "--output=out")
        later = [argument.replace("To=10", "To=2") for argument in self.HISTORY]

        def restarted(field, code):
            return self.rpc("--input=beam.xml", *later, f"--set=Traction->top->Y={field}", "--output=other",
                            "--restart=out/beam.checkpoint-000003.e", code=code)

        spaced = TO_AND_FRO.replace("*", " * ").replace("0.4", "2/5")
        restarted(spaced, 0)
        restarted(f"(t <= 0.75 ? {TO_AND_FRO} : 0)", 0)
        result = restarted(TO_AND_FRO.replace("0.4", "0.5"), BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["Traction->top->Y", "at t = 0.25 and (", "it is ", "and was "])
        result = self.rpc("--input=beam.xml", *later, "--set=Steps->From=0.5", "--restart=out/beam.checkpoint-000003.e", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["Steps->Times", "0.25, 0.5, 0.75", "later times"])
        result = self.rpc("--input=beam.xml", *later, "--set=Material->Young's Modulus=2001", "--restart=out/beam.checkpoint-000003.e",
                          code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["Material->Young's Modulus"])

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_names_of_conditions_may_change_and_their_order_may_not(self):
        three = [argument.replace("To=10", "To=0.75") for argument in self.HISTORY]
        self.rpc("--input=beam.xml", *three, "--output=out")
        later = [argument.replace("To=10", "To=1") for argument in self.HISTORY]
        deck, end = BEAM.read_text(), "</ParameterList>"
        left, right = (deck[deck.index(f'<ParameterList name="{name}"'):] for name in ("left", "right"))
        left, right = (entry[:entry.index(end) + len(end)] for entry in (left, right))

        def restarted(text, code):
            (self.folder / "beam.xml").write_text(text)
            return self.rpc("--input=./beam.xml", *later, "--output=other", "--restart=out/beam.checkpoint-000003.e", code=code)

        side = '"clamp"><Parameter name="Side" type="string" value="left"/>'
        restarted(deck.replace(left, left.replace('"left">', side)), 0)
        self.assertIn("clamp_reaction_x", rows(self.out("history.csv", "other"))[0])
        result = restarted(deck.replace(left, left.replace('"left">', side.replace('"left"/>', '"top"/>'))), BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ['"Dirichlet->clamp->Side"', '"top"', '"left"'])
        result = restarted(deck.replace(left, "@").replace(right, left).replace("@", right), BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ['"Dirichlet->right->Side"', '"right"', '"left"'])

    def test_two_runs_of_one_name_in_one_folder(self):
        process = self.start("--set=Mesh->Cells={320,64}", f"--set=Traction->top->Y={TO_AND_FRO}", *TWENTY)
        for line in process.stdout:
            if line.startswith("   1/"):
                break
        result = self.rpc("--input=beam.xml", SMALL, "--output=out", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ["another run", '"beam"', '"out"', "--output=DIR"])
        self.rpc("--input=beam.xml", SMALL, "--output=elsewhere")
        for rank in ranks_below(process.pid):
            os.kill(rank, signal.SIGKILL)
        process.communicate(timeout=600)
        for name in ["beam.e.tmp.999999999", ".rpc.tmp.999999999"]:
            (self.folder / "out" / name).write_text("of a process that is gone")
        self.rpc("--input=beam.xml", SMALL, "--output=out")
        self.assertEqual(files(self.folder / "out"), ["beam.contact.csv", "beam.e", "beam.json"])


if __name__ == "__main__":
    unittest.main()

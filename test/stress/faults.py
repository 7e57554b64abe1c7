# SPDX-License-Identifier: BSD-3-Clause
"""Faults thrown into random load histories: what has been computed before must be on disk.

    python3 faults.py --rpc=build/rpc [--seed=1] [--scenes=300] [--only=K] [--jobs=2] [--np=1] [--keep=DIR]

History K is that of histories.py, in steps of a quarter, run once as it is and once with a fault: an expression without a value from some time
on, a disk that is full, SIGTERM, SIGINT, or kill -9. Rows of the history and times of the film must be the first ones of the whole run, to the
last bit; a message must tell the time of the step that failed; a run that was not killed leaves no temporary file. After a signal and after
kill -9 a restart must end as the whole run: after kill -9 to the last bit, after a signal to the tolerance. The exit code is 1 if a history failed.
"""
import collections
import contextlib
import csv
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import histories
import scenes
import trials

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "regression"))
from film import Film  # noqa: E402
from rpc_run import processes_below  # noqa: E402

FAULTS = ["expression", "disk", "SIGTERM", "SIGINT", "kill"]
SAME = 1e-5  # of two runs that differ by a restart, relative to the largest value of the column
ENERGIES = ["strain_energy", "foundation_energy", "dissipated_energy", "work", "energy_imbalance"]
KINDS = ["force", "reaction", "displacement", "penetration"]  # rounding of one component or number is to be seen against the others
# Not compared: work, and penetration, which on a rigid foundation is rounding.
WORK = {"seconds", "parts", "newton_iterations", "linear_iterations", "reason", "max_penetration"}


class Run:
    """One run in a folder of its own, with a fault or none."""

    def __init__(self, options, scene, folder, settings):
        self.folder, self.settings = folder, settings
        self.launch = scenes.launch(options)
        folder.mkdir()
        scenes.write(scene, folder)

    def start(self, *more, limit=None):
        def bound():
            if limit:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        return subprocess.Popen([*self.launch, "--input=scene.xml", *self.settings, *more], cwd=self.folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=bound, start_new_session=True)

    def finish(self, process, wait=None, number=None):
        """Exit code and stderr; a signal goes out after some seconds."""
        if wait is not None:
            try:
                process.wait(wait)
            except subprocess.TimeoutExpired:
                found = processes_below(process.pid, self.launch[-1])
                for rank in found if number == signal.SIGKILL else found[-1:]:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(rank, number)
        _, stderr = process.communicate(timeout=scenes.TIME_LIMIT)
        return process.returncode, stderr

    def rows(self):
        path = self.folder / "scene.history.csv"
        return list(csv.DictReader(path.read_text().splitlines())) if path.exists() else []

    def film(self):
        path = self.folder / "scene.e"
        return Film(path) if path.exists() else None


def same_rows(rows, whole):
    """Those that converged are the first of the whole run."""
    good = [row for row in rows if row["converged"] == "1"]
    strip = lambda row: {k: v for k, v in row.items() if k != "seconds"}
    return len(good) <= len(whole) and all(strip(a) == strip(b) for a, b in zip(good, whole)), len(good)


def near_rows(rows, whole):
    """Those that converged are the first of the whole run to SAME."""
    good = [row for row in rows if row["converged"] == "1"]
    energies = max(abs(float(row[name])) for row in whole for name in ENERGIES)
    for name in set(whole[0]) - WORK:
        kind = next((kind for kind in KINDS if kind in name), name)
        scale = energies if name in ENERGIES else max(abs(float(row[other])) for row in whole for other in row if kind in other and other != "reason")
        if any(abs(float(a[name]) - float(b[name])) > SAME * scale for a, b in zip(good, whole)):
            return False
    return len(good) <= len(whole)


def check(fault, run, whole, code, stderr, complain):
    """What every fault must leave. @return steps that are done"""
    rows = run.rows()
    equal, done = same_rows(rows, whole.rows())
    # A signal may end a prediction, and the step still converge: that step differs by the tolerance.
    last_may_differ = fault.startswith("SIG")
    if not equal and not (last_may_differ and near_rows(rows, whole.rows())):
        complain("rows differ from those of the whole run")
    film, whole_film = run.film(), whole.film()
    if film:
        compared = max(0, min(done, len(film.times)) - last_may_differ)
        if film.times[:compared] != whole_film.times[:compared]:
            complain(f"film of t = {film.times}")
        differ = [name for name, values in film.nodal.items() if values[:compared] != whole_film.nodal[name][:compared]]
        if differ:
            complain(f"film differs in {', '.join(differ)}")
    if done > (len(film.times) if film else 0) + 1:
        complain(f"{done} rows, {len(film.times) if film else 0} times in the film")
    left = [path.name for path in run.folder.iterdir() if ".tmp." in path.name or path.name.endswith(".lock")]
    if left and fault != "kill":
        complain(f"left behind: {left}")
    summary = run.folder / "scene.json"
    if code != 0 and fault != "kill" and summary.exists() and json.loads(summary.read_text())["converged"]:
        complain("the summary says converged")
    if code not in (0, 4) and fault != "kill" and done and "at t = " not in stderr:
        complain(f"no time in the message: {stderr.strip()[:200]}")
    return done


def thrown(options, rng, scene, folder, complain, whole, seconds, settings):
    """The fault, and the steps that were done before it."""
    fault = rng.choice(FAULTS)
    if fault == "disk" and options.np > 1:
        fault = "kill"  # the launcher would meet the limit as well
    if fault == "expression" and "Body Force" in (whole.folder / "scene.xml").read_text():
        fault = "kill"  # there is no place for another expression
    last = scene.times[-1]
    if fault == "expression":
        until = rng.uniform(0, last)
        run = Run(options, scene, folder, [*settings, f"--set=Body Force->X=0*sqrt({until!r} - t)"])
        code, stderr = run.finish(run.start())
        if code != 2:
            complain(f"exit {code}: {stderr.strip()[:200]}")
    elif fault == "disk":
        run = Run(options, scene, folder, settings)
        size = (whole.folder / "scene.e").stat().st_size
        code, stderr = run.finish(run.start(limit=rng.randint(1, size - 1)))
        if code != 1:
            complain(f"exit {code}: {stderr.strip()[:200]}")
    else:
        run = Run(options, scene, folder, settings)
        number = signal.SIGKILL if fault == "kill" else signal.Signals[fault]
        code, stderr = run.finish(run.start(), rng.uniform(0.3, 1) * seconds, number)
        if fault != "kill" and code not in (0, 4, -number):
            complain(f"exit {code}: {stderr.strip()[:200]}")
    done = check(fault, run, whole, code, stderr, complain)
    if fault in ("kill", "SIGTERM", "SIGINT") and code != 0 and list(run.folder.glob("scene.checkpoint-*.e")) and done < len(whole.rows()):
        code, stderr = run.finish(run.start("--restart"))
        if code != 0:
            complain(f"restart: exit {code}: {stderr.strip()[:200]}")
        elif fault == "kill" and (not same_rows(run.rows(), whole.rows())[0] or len(run.rows()) != len(whole.rows())):
            complain("rows after the restart differ")
        elif len(run.rows()) != len(whole.rows()) or not near_rows(run.rows(), whole.rows()):
            complain("rows after the restart differ by much")
        elif run.film().times != whole.film().times:
            complain(f"film after the restart: t = {run.film().times}")
    return fault, done


def judge(options, number):
    """(number, family, fault, steps done, complaints)"""
    rng = random.Random(f"{options.seed}:{number}")
    family, scene = histories.make(rng)
    times = [k / 4 for k in range(1, int(4 * scene.times[-1]) + 1)]
    settings = ["--set=Steps->Times={" + ", ".join(map(str, times)) + "}", "--set=Steps->Checkpoint Every=2", "--set=Output->Exodus=true"]
    complaints, fault, done = [], "none", 0
    with tempfile.TemporaryDirectory(prefix=f"rpc_fault_{number}_") as name:
        folder = pathlib.Path(name)
        whole = Run(options, scene, folder / "whole", settings)
        start = time.perf_counter()
        code, stderr = whole.finish(whole.start())
        if code == 0:
            fault, done = thrown(options, rng, scene, folder / "fault", complaints.append, whole, time.perf_counter() - start, settings)
        elif code != 4:  # at rounding, see histories.py
            complaints.append(f"without a fault: exit {code}: {stderr.strip()[:200]}")
        if complaints and options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / f"{number:04d}_{fault}", dirs_exist_ok=True)
    return number, family, fault, done, complaints


def main():
    options = trials.arguments(__doc__, 300)
    failed, faults, steps = 0, collections.Counter(), 0
    for number, family, fault, done, complaints in trials.each(options, judge):
        faults[fault] += 1
        steps += done
        if complaints:
            failed += 1
            print(f"FAILED {number} {family}, {fault}: {'; '.join(complaints)}", flush=True)
    print(f"seed {options.seed}: {failed} of {sum(faults.values())} histories failed; {dict(faults)}; {steps} steps before the faults")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

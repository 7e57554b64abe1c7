# SPDX-License-Identifier: BSD-3-Clause
"""kill -9 at random moments of a history of 40 steps: a restart must end as the run without a break.

    python3 kills.py --rpc=build/rpc [--seed=1] [--scenes=50] [--only=K] [--jobs=2] [--np=1] [--keep=DIR]

On each of the meshes, a fixed one, and adapted ones of a box and of a .geo, scene K is killed at a moment that comes from the seed and K alone,
and so are some of its restarts; of several ranks all are, or one. A killed run must leave a film that can be read and rows of the run without a
break. The restart that is left in peace goes on after the newest checkpoint, or from the first step where there is none yet. Rows of its history,
contact table and film must be those of the run without a break, to the last bit, and the parts of the film together must have each time once.
The exit code is 1 if a scene failed.
"""
import collections
import concurrent.futures
import contextlib
import csv
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import scenes
import trials

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "regression"))
from film import Film  # noqa: E402
from rpc_run import processes_below  # noqa: E402

STEPS = 40
HISTORY = ["--set=Steps->From=0.25", "--set=Steps->To=10", "--set=Steps->Step=0.25", "--set=Steps->Checkpoint Every=3",
           "--set=Traction->top->Y=-20*sin(pi*x/5)*(0.6 + 0.4*sin(t))"]
MESHES = {"fixed": ["--input=beam.xml", "--set=Mesh->Cells={20,4}"],
          "adapted": ["--input=beam_adaptive.xml", "--set=Mesh->Cells={10,2}", "--set=Adapt->Target Relative Error=0.04"],
          "geo": ["--input=geo.xml"]}
GEO = """SetFactory("Built-in");
Point(1) = {0, 0, 0, 0.5}; Point(2) = {5, 0, 0, 0.5}; Point(3) = {5, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("body") = {1};
"""
GEO_DECK = """<ParameterList name="geo">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="geo.geo"/>
  </ParameterList>
  <ParameterList name="Adapt"><Parameter name="Target Relative Error" type="double" value="0.03"/></ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="2000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="left"><Parameter name="X" type="double" value="0"/><Parameter name="Y" type="double" value="0"/></ParameterList>
    <ParameterList name="right"><Parameter name="X" type="double" value="0"/><Parameter name="Y" type="double" value="0"/></ParameterList>
  </ParameterList>
  <ParameterList name="Traction"><ParameterList name="top"><Parameter name="Y" type="double" value="0"/></ParameterList></ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Yield Stress" type="double" value="16"/>
  </ParameterList>
</ParameterList>
"""
AGAIN = 0.4  # of the restarts that are killed too
ONE_RANK = 0.3  # of the kills that end one rank of several


class Run:
    """Runs on a mesh in a folder, one after another."""

    def __init__(self, options, mesh, folder):
        self.folder, self.settings = folder, [*MESHES[mesh], *HISTORY, "--output=out"]
        self.launch = scenes.launch(options)
        folder.mkdir()
        (folder / "geo.xml").write_text(GEO_DECK)
        (folder / "geo.geo").write_text(GEO)

    def run(self, *more, until=None, one_rank=None):
        """Exit code, None of a run that was killed, and stderr.

        until: seconds after which it is killed; one_rank: chooses the one of several ranks that is
        """
        process = subprocess.Popen([*self.launch, *self.settings, *more], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, start_new_session=True)
        killed = False
        if until is not None:
            try:
                process.wait(until)
            except subprocess.TimeoutExpired:
                killed = True
                ranks = processes_below(process.pid, self.launch[-1])
                for rank in [one_rank(ranks)] if one_rank and ranks else ranks:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(rank, signal.SIGKILL)
        _, stderr = process.communicate(timeout=scenes.TIME_LIMIT)
        return None if killed else process.returncode, stderr

    def files(self, pattern):
        return sorted((self.folder / "out").glob(pattern))

    def rows(self):
        """Of the history, but for seconds."""
        table = [csv.DictReader(path.read_text().splitlines()) for path in self.files("*.history.csv")]
        return [{k: v for k, v in row.items() if k != "seconds"} for row in table[0]] if table else []

    def film(self):
        """The files of the film."""
        return [path for path in self.files("*.e*") if "checkpoint" not in path.name and ".tmp." not in path.name]


def check_left(run, whole_rows, complain):
    """What a killed run must leave: rows and times of what it has done."""
    rows = run.rows()
    if rows != whole_rows[:len(rows)]:
        complain("rows after the kill differ")
    films = [Film(path).times for path in run.film()]
    if any(times != sorted(set(times)) for times in films):
        complain(f"film after the kill: t = {films}")


def check_end(run, whole, complain):
    if run.rows() != whole.rows():
        complain(f"{len(run.rows())} rows after the restart differ")
    times = [t for path in run.film() for t in Film(path).times]
    if times != [0.25 * k for k in range(1, STEPS + 1)]:
        complain(f"film after the restart: t = {times}")
    for ours, theirs in [(run.film(), whole.film()), (run.files("*.contact.csv"), whole.files("*.contact.csv"))]:
        if [path.name for path in ours] != [path.name for path in theirs]:
            complain(f"files after the restart: {[path.name for path in ours]}")
        differ = [a.name for a, b in zip(ours, theirs) if a.read_bytes() != b.read_bytes()]
        if differ:
            complain(f"differ: {', '.join(differ)}")
    left = [path.name for path in run.files("*") if ".tmp." in path.name or path.name.endswith(".lock")]
    if left:
        complain(f"left behind: {left}")


def judge(options, mesh, number, whole, seconds, folder):
    """(mesh, number, kills, of them before the first checkpoint, complaints)"""
    rng = random.Random(f"{options.seed}:{mesh}:{number}")
    run, complaints, kills, early = Run(options, mesh, folder), [], 0, 0
    again, until = True, rng.uniform(0, seconds)
    while again:
        one_rank = rng.choice if options.np > 1 and rng.random() < ONE_RANK else None
        restart = ["--restart"] if run.files("*.checkpoint-*.e") else []
        code, stderr = run.run(*restart, until=until, one_rank=one_rank)
        if code == 0 and kills == 0:  # the moment came too late
            shutil.rmtree(run.folder / "out")
            until /= 2
            continue
        if code is None:
            kills += 1
            early += not run.files("*.checkpoint-*.e")
            check_left(run, whole.rows(), complaints.append)
        elif code != 0:
            complaints.append(f"restart: exit {code}: {stderr.strip()[:200]}")
        again, until = code is None and rng.random() < AGAIN, rng.uniform(0, seconds)
    if code is None:
        restart = ["--restart"] if run.files("*.checkpoint-*.e") else []
        code, stderr = run.run(*restart)
        if code != 0:
            complaints.append(f"restart: exit {code}: {stderr.strip()[:200]}")
    check_end(run, whole, complaints.append)
    if complaints and options.keep:
        shutil.copytree(folder, pathlib.Path(options.keep) / f"{number:04d}_{mesh}", dirs_exist_ok=True)
    shutil.rmtree(folder)
    return mesh, number, kills, early, complaints


def main():
    options = trials.arguments(__doc__, 50)
    numbers = trials.numbers(options)
    failed, kills, early = 0, collections.Counter(), 0
    with tempfile.TemporaryDirectory(prefix="rpc_kills_") as name, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for mesh in MESHES:
            whole = Run(options, mesh, pathlib.Path(name) / mesh)
            start = time.perf_counter()
            code, stderr = whole.run()
            seconds = time.perf_counter() - start
            if code != 0:
                print(f"FAILED {mesh} without a break: exit {code}: {stderr.strip()[:200]}")
                return 1
            judged = [pool.submit(judge, options, mesh, k, whole, seconds, pathlib.Path(name) / f"{mesh}_{k}") for k in numbers]
            for outcome in judged:
                mesh, number, count, before, complaints = outcome.result()
                kills[mesh] += count
                early += before
                if complaints:
                    failed += 1
                    print(f"FAILED {number} {mesh}: {'; '.join(complaints)}", flush=True)
            print(f"{mesh}: {len(whole.film())} files of the film, {seconds:.1f} s without a break, {kills[mesh]} kills", flush=True)
    print(f"seed {options.seed}, {options.np} ranks: {failed} of {len(MESHES) * len(numbers)} histories failed; {sum(kills.values())} kills, "
          f"{early} before the first checkpoint")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""What each rule of the program gains: random scenes with the rule off, halved and doubled, against the rule as it is.

    python3 ablation.py --rpc=build-ablation/rpc --csv=FILE [--rules=REGEX] [--kinds=well-shaped,hard,friction,histories]
                        [--seed=1] [--scenes=25] [--size=small] [--jobs=1] [--budget=SECONDS] [--continue] [--all-settings] [--report]

The program is one of -D RPC_ABLATION=ON (core/rule.hpp), which lists its rules with RPC_RULES=list and takes values from RPC_RULES. Scene K
of a kind comes from the seed and K alone; --kinds=adaptive has bodies that ask for an error (test/stress/adaptive.py), most of them for gmsh. First each rule is off; then those that changed a count of some scene are halved and doubled
(--all-settings: all of them). "Off" is the number in "off: NUMBER" at the end of a rule's meaning, where it has that; else 1e9 for names that begin
with one of UPPER, which bound from above, and 0 for others.

Each run is a line of FILE. --continue goes on where FILE ends; --budget stops in time. Runs are compared with those of the rules as they are in the
same call, so that calls may be on different machines. Then a table: per rule and setting the mean ratios to the rules as they are, and
the verdict: a rule stays if it gains over 1 % of steps or seconds in the mean, or 20 % in the worst scene, or scenes fail without it. Seconds
must exceed twice their standard error, too. A rule that is never met changes no count of any scene: other scenes have to tell. --report prints the table of FILE without a run.
"""
import argparse
import collections
import concurrent.futures
import contextlib
import csv
import dataclasses
import hashlib
import json
import math
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import types

import families
import adaptive  # of test/stress, whose folder families.py has put on the path
import friction_histories
import histories
import runs
import trials
from scenes import contact_rows, rounding, write
from suite.table import Table

KINDS = {"well-shaped": "three states", "hard": "hard", "friction": "friction"}  # those of families.py
HISTORIES = {"history": histories, "friction history": friction_histories}  # in turn
STANDARD_KINDS = [*KINDS, "histories"]
ALL_KINDS = [*STANDARD_KINDS, "adaptive"]
UPPER = ("most_", "largest", "greatest", "longest", "patience", "slowest")
LARGE = 1e9
AS_IS, OFF = "as is", "off"
SCALED = {"halved": 0.5, "doubled": 2.0}
MEAN, WORST = 1.01, 1.2  # ratios from which a rule gains
MORE_STEPS, MORE_SECONDS = 3, 0.5  # at least, in the worst scene
ERRORS = 2  # standard errors that a mean ratio of seconds must exceed
SLOWEST, SECONDS_MORE = 10, 30  # times as long as with the rules as they are, and so much more [s]: out of time
ENERGY = 1e-6  # relative change of the last step's energy: another answer


@dataclasses.dataclass(frozen=True)
class Rule:
    name: str
    value: float
    meaning: str = ""
    source: str = ""

    @property
    def off(self):
        told = re.search(r"off: (\S+?)\)?$", self.meaning)
        return float(told.group(1)) if told else LARGE if self.name.split(".")[-1].startswith(UPPER) else 0.0

    def settings(self):
        return {OFF: self.off, **{name: self.value * factor for name, factor in SCALED.items()}}


@dataclasses.dataclass
class Run:
    """A line of the file."""

    call: int  # of this program, from 0
    rule: str
    setting: str
    value: float
    kind: str
    seed: int
    size: str
    number: int
    family: str = ""
    steps: float = math.inf
    solves: float = math.inf
    cg: float = math.inf
    seconds: float = math.inf  # in the program, without output
    energy: float = math.nan
    counts: str = ""  # of all that was counted, on all meshes
    failure: str = ""

    @property
    def scene(self):
        return self.kind, self.seed, self.size, self.number

    @property
    def job(self):
        return (self.rule, self.setting, *self.scene)


NUMBERS = {field.name: {int: int, float: lambda text: float(text or "nan")}.get(field.type, str) for field in dataclasses.fields(Run)}


# --- runs ------------------------------------------------------------------------------------------------------------------


def listed(rpc):
    """The Rules of a program, each once, in order."""
    output = subprocess.run([rpc], env={**os.environ, "RPC_RULES": "list"}, capture_output=True, text=True, check=False).stdout
    lines = [line.split("\t") for line in output.splitlines()]
    rules = {words[0]: Rule(words[0], float(words[1]), *words[2:]) for words in lines if len(words) == 4}
    return list(rules.values())


def made(kind, seed, number, size, folder):
    """(family, scene), written into a folder; the scene is None for kinds whose residuals rounding does not excuse."""
    if kind == "adaptive":
        space = list(adaptive.TARGETS)[number % len(adaptive.TARGETS)]
        lists, geo = adaptive.deck(random.Random(f"{seed}/{space}/{number}"), space, number)
        (folder / "scene.yaml").write_text(trials.written({"scene": lists}, 0))
        if geo:
            (folder / "body.geo").write_text(geo)
        return space, None
    family, scene = make(kind, seed, number, size)
    write(scene, folder)
    return family, scene


def make(kind, seed, number, size):
    if kind in KINDS:
        return families.make(seed, number, size, KINDS[kind])
    name = list(HISTORIES)[number % len(HISTORIES)]
    return HISTORIES[name].make(random.Random(f"{seed}/{name}/{number}"))


class Scenes:
    """The scenes of all kinds, written once."""

    def __init__(self, options, folder):
        self.options, self.scenes = options, {}
        for number in range(options.scenes):
            for kind in options.kinds:
                where = folder / f"{kind}_{number}"
                where.mkdir()
                self.scenes[kind, options.seed, options.size, number] = *made(kind, options.seed, number, options.size, where), where

    def run(self, call, rule, setting, value, scene_id, limit):
        family, scene, where = self.scenes[scene_id]
        run = Run(call, rule, setting, value, *scene_id, family)
        rules = {"RPC_RULES": f"{rule}={value!r}"} if rule else {}
        options = types.SimpleNamespace(rpc=self.options.rpc, np=1, time_limit=limit, environment=rules)
        with tempfile.TemporaryDirectory(prefix="rpc_ablation_") as folder:
            folder = pathlib.Path(folder)
            for path in where.iterdir():
                shutil.copy(path, folder)
            result = runs.solve(options, folder, next(folder.glob("scene.[xy]*ml")).name)
            if result.complaint and result.summary and scene:
                runs.excuse(types.SimpleNamespace(), result, floor(scene, result.summary, contact_rows(folder)))
        run.failure = result.complaint
        if result.summary:
            count(run, result.summary)
        return run


def floor(scene, summary, rows):
    """What rounding leaves of residuals."""
    if not scene.times:
        return 10 * rounding(scene, summary, rows)
    return histories.floor(scene, summary, rows) if summary.get("steps") else 0.0


def count(run, summary):
    steps = summary.get("steps") or [{}]
    newton, solves, cg = ([step.get(key) for step in steps] for key in ("newton_iterations", "linear_solves", "linear_iterations"))
    history = None not in newton + solves + cg
    coarser = summary.get("adaptation", {}).get("cycles", [])[:-1]  # the last one is that of the result
    run.steps = sum(newton if history else summary["newton_iterations"]) + sum(cycle["newton_iterations"] for cycle in coarser)
    run.solves = sum(solves) if history else summary["linear_solves"] + sum(len(cycle["linear_iterations"]) for cycle in coarser)
    run.cg = sum(cg if history else summary["linear_iterations"]) + sum(sum(cycle["linear_iterations"]) for cycle in coarser)
    run.seconds = summary["seconds"]["total"] - summary["seconds"]["output"]
    run.energy = math.nan if summary["energy_J"] is None else summary["energy_J"]
    told = [newton, cg, [[mesh[key] for key in ("dofs", "newton_iterations", "linear_iterations")] for mesh in summary["levels"] + coarser]]
    told += [summary.get(key) for key in ("dofs", "uzawa_iterations", "newton_iterations", "coarse_choices", "line_search_steps", "linear_iterations",
                                          "preconditioner_setups", "local_corrections", "solver_path", "matrix_assemblies")]
    run.counts = hashlib.sha1(json.dumps(told).encode()).hexdigest()[:12]


# --- the file --------------------------------------------------------------------------------------------------------------


def read(path):
    with open(path, newline="") as file:
        lines = [line for line in csv.DictReader(file) if None not in line.values()]  # the last one may be cut
    return [Run(**{name: number(line[name]) for name, number in NUMBERS.items()}) for line in lines]


class File:
    def __init__(self, path, goes_on):
        fresh = not goes_on or os.path.getsize(path) == 0
        if not fresh:
            text = pathlib.Path(path).read_text()
            pathlib.Path(path).write_text(text[:text.rfind("\n") + 1])
        self.file = open(path, "w" if fresh else "a", newline="")
        self.writer = csv.writer(self.file)
        if fresh:
            self.writer.writerow(NUMBERS)

    def add(self, run):
        self.writer.writerow([getattr(run, name) for name in NUMBERS])
        self.file.flush()

    def close(self):
        self.file.close()


def measure(options, rules):
    """Runs what the file lacks, until there is no time left. @return whether all is there"""
    end = time.monotonic() + options.budget
    earlier = read(options.csv) if options.goes_on else []
    call, done = max((run.call for run in earlier), default=-1) + 1, {run.job: run for run in earlier}
    with tempfile.TemporaryDirectory(prefix="rpc_ablation_") as folder, contextlib.closing(File(options.csv, options.goes_on)) as file:
        scenes = Scenes(options, pathlib.Path(folder))

        def run_all(jobs):
            """(rule, setting, value, scene, time limit) of each; those that do not fit are left out."""
            def one(job):
                return scenes.run(call, *job) if time.monotonic() + job[-1] / SLOWEST < end else None
            with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
                for run in pool.map(one, jobs):
                    if run:
                        file.add(run)
                        done[run.job] = run
                        print(f"  {run.rule or 'rules'} {run.setting}, {run.kind} {run.number}: {run.steps:g} steps, {run.cg:g} CG, {run.seconds:.2f} s"
                              + (f"; FAILED: {run.failure}" if run.failure else ""), file=sys.stderr, flush=True)

        run_all([("", AS_IS, 0.0, scene, options.time_limit) for scene in scenes.scenes])
        base = {scene: done[("", AS_IS, *scene)] for scene in scenes.scenes if ("", AS_IS, *scene) in done and done["", AS_IS, *scene].call == call}

        def limit(scene):
            return min(options.time_limit, SLOWEST * base[scene].seconds + SECONDS_MORE) if not base[scene].failure else options.time_limit

        def wanted(settings, chosen):
            return [(rule.name, setting, rule.settings()[setting], scene, limit(scene)) for setting in settings for rule in chosen
                    for scene in base if (rule.name, setting, *scene) not in done]

        run_all(wanted([OFF], rules))
        all_off = len(base) == len(scenes.scenes) and not wanted([OFF], rules)
        names = met(done.values())
        scaled = [rule for rule in rules if options.all_settings or rule.name in names]
        run_all(wanted(SCALED, scaled))
        return all_off and not wanted(SCALED, scaled)


# --- judgement -------------------------------------------------------------------------------------------------------------


def by_setting(runs_):
    """{(rule, setting): [(run, run with the rules as they are)]}"""
    base = {(run.call, run.scene): run for run in runs_ if not run.rule}
    pairs = collections.defaultdict(list)
    for run in runs_:
        if run.rule and (run.call, run.scene) in base:
            pairs[run.rule, run.setting].append((run, base[run.call, run.scene]))
    return pairs


def differs(run, base):
    return run.counts != base.counts or bool(run.failure) != bool(base.failure)


def met(runs_):
    """Names of the rules without which a run differs in a count, or fails."""
    return {rule for (rule, setting), pairs in by_setting(list(runs_)).items() if setting == OFF and any(differs(*pair) for pair in pairs)}


@dataclasses.dataclass
class Effect:
    """Of a setting: ratios to the rules as they are, over scenes that both solve."""

    pairs: list
    steps: float = 1.0
    solves: float = 1.0
    cg: float = 1.0
    seconds: float = 1.0
    error: float = 0.0  # standard error of `seconds`
    changed: int = 0  # scenes with other counts, or that fail
    failed: int = 0  # that do not fail with the rule as it is
    mended: int = 0  # the other way round
    other_answers: int = 0
    worst: float = 1.0
    worst_scene: str = ""

    def __post_init__(self):
        both = [(run, base) for run, base in self.pairs if not run.failure and not base.failure]
        self.failed = sum(bool(run.failure) and not base.failure for run, base in self.pairs)
        self.mended = sum(bool(base.failure) and not run.failure for run, base in self.pairs)
        self.changed = sum(differs(run, base) for run, base in self.pairs)
        self.other_answers = sum(abs(run.energy - base.energy) > ENERGY * abs(base.energy) for run, base in both if run.kind != "adaptive")
        for name in ("steps", "solves", "cg") if both else ():
            setattr(self, name, statistics.fmean((getattr(run, name) + 1) / (getattr(base, name) + 1) for run, base in both))
        if both:
            ratios = [run.seconds / max(base.seconds, 1e-3) for run, base in both]
            self.seconds = statistics.fmean(ratios)
            self.error = statistics.stdev(ratios) / math.sqrt(len(ratios)) if len(ratios) > 1 else math.inf
        for run, base in both:
            ratio = max([1.0] + [run.steps / base.steps] * (run.steps - base.steps >= MORE_STEPS and base.steps > 0)
                        + [run.seconds / base.seconds] * (run.counts != base.counts and run.seconds - base.seconds >= MORE_SECONDS))
            if ratio > self.worst:
                self.worst, self.worst_scene = ratio, f"{base.kind} {base.number} {base.family}"

    def gains(self):
        """Why a rule stays whose lack has this effect; empty: it gains nothing."""
        why = [f"{self.failed} fail"] if self.failed > self.mended else []
        why += ["steps"] if self.steps > MEAN else []
        why += ["seconds"] if self.seconds > max(MEAN, 1 + ERRORS * self.error) else []
        return why + (["worst scene"] if self.worst > WORST else [])

    def is_better(self):
        return self.failed <= self.mended and not self.gains() and (self.steps < 2 - MEAN or self.seconds < min(2 - MEAN, 1 - ERRORS * self.error))


def verdict(effects):
    """Of {setting: Effect}."""
    if OFF not in effects:
        return "not measured"
    off = effects[OFF]
    why = off.gains()
    said = "stays: " + ", ".join(why) if why else "never met" if not off.changed else "goes" + (": better off" if off.is_better() else "")
    return "; ".join([said] + [f"better {name}" for name in SCALED if name in effects and effects[name].is_better()])


def table(runs_, rules):
    pairs = by_setting(runs_)
    used = {run.scene for run in runs_}
    failed = {run.scene for run in runs_ if not run.rule and run.failure}
    kinds_, seeds, sizes = (", ".join(sorted({str(scene[k]) for scene in used})) for k in range(3))
    note = (f"{len(used)} scenes of {kinds_}, seed {seeds}, size {sizes}; {len(failed)} fail with the rules as they are. Mean ratios to the rules as they "
            "are, of scenes that both solve; failed: more than with the rule as it is, or fewer (-).")
    result = Table("What rules gain", note, ["rule", "setting", "value", "scenes", "changed", "steps", "solves", "CG", "seconds", "failed", "other answers",
                                             "worst", "worst scene", "verdict"])
    for rule in rules:
        effects = {setting: Effect(pairs[rule.name, setting]) for setting in [OFF, *SCALED] if (rule.name, setting) in pairs}
        for setting, e in effects.items():
            result.add(rule.name, setting, "%g" % rule.settings()[setting], len(e.pairs), e.changed, *("%.3f" % v for v in (e.steps, e.solves, e.cg)),
                       f"{e.seconds:.3f} ± {e.error:.3f}", e.failed - e.mended, e.other_answers, "%.2f" % e.worst, e.worst_scene,
                       verdict(effects) if setting == OFF else "")
    return result


# --- command line ----------------------------------------------------------------------------------------------------------


def kinds(text):
    chosen = text.split(",")
    for kind in chosen:
        if kind not in ALL_KINDS:
            raise argparse.ArgumentTypeError(f"\"{kind}\" is none of {', '.join(ALL_KINDS)}")
    return chosen


def expression(text):
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"\"{text}\" is no regular expression: {error}")


def count_of(text):
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"\"{text}\" is no number >= 1")
    return int(text)


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True, help="a program of -D RPC_ABLATION=ON")
    parser.add_argument("--csv", required=True, help="file for a line a run")
    parser.add_argument("--rules", type=expression, default=re.compile(""), help="regular expression, found in names of rules; default: all")
    parser.add_argument("--kinds", type=kinds, default=STANDARD_KINDS, help="of " + ",".join(ALL_KINDS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=count_of, default=25, help="of each kind (%(default)s)")
    parser.add_argument("--size", choices=list(families.SIZES), default="small", help="of the meshes, but for histories (%(default)s)")
    parser.add_argument("--jobs", type=count_of, default=1, help="runs at a time (%(default)s); more than the cores disturb the times")
    parser.add_argument("--budget", type=float, default=math.inf, help="time for runs [s]")
    parser.add_argument("--time-limit", type=float, default=120.0, help="of a run [s] (%(default)s)")
    parser.add_argument("--continue", dest="goes_on", action="store_true", help="keep the runs of the file")
    parser.add_argument("--all-settings", action="store_true", help="halve and double also rules that are never met")
    parser.add_argument("--report", action="store_true", help="no runs")
    options = parser.parse_args(words)
    options.rpc = os.path.abspath(options.rpc)
    try:
        listed(options.rpc)
        if not options.report:
            open(options.csv, "a").close()
        if options.report or options.goes_on:
            read(options.csv)
    except OSError as error:
        parser.error(f"{error.filename}: {error.strerror}")
    except (KeyError, ValueError):
        parser.error(f"--csv={options.csv}: no file of this program")
    return options


def main(words=None):
    options = arguments(words)
    rules = [rule for rule in listed(options.rpc) if options.rules.search(rule.name)]
    if not rules:
        print(f"ablation.py: {options.rpc} with RPC_RULES=list names no rule like \"{options.rules.pattern}\"; build it with -D RPC_ABLATION=ON", file=sys.stderr)
        return 2
    complete = options.report or measure(options, rules)
    print(table(read(options.csv), rules).text())
    if not complete:
        print("Not all runs fitted into the time; go on with --continue.")
    return 0 if complete else 3


if __name__ == "__main__":
    sys.exit(main())

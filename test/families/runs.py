# SPDX-License-Identifier: BSD-3-Clause
"""Runs a scene three ways: with contact from a coarser mesh's solution, with contact cold, and without contact."""
import collections
import dataclasses
import json
import math
import pathlib
import shlex
import sys
import tempfile
import time

import families
from scenes import RESIDUALS, TOLERANCE, contact_rows, launch, rounding, run, write
from suite.program import without_contact

HERE = pathlib.Path(__file__).resolve().parent
COLD = "--set=Nested Iteration->Enabled=false"
SHORT = 5.0  # [s]: runs below are measured twice, and the best counts
STATES = ("open", "closed", "yielding")
WITHOUT_COLD = ("hard", "friction")  # kinds


@dataclasses.dataclass
class Row:
    """What a scene took. A count that no run gave is infinite, so that it stands above all bounds; None: does not apply."""

    number: int
    family: str
    dim: int = 2
    element: str = ""
    dofs: int = 0
    points: int = 0
    open: int = 0
    closed: int = 0
    yielding: int = 0
    sticks: int = 0
    slips: int = 0
    seconds: float = math.inf  # of the whole process
    elastic_seconds: float = math.inf
    steps: float = None  # from a coarser mesh
    cold_steps: float = math.inf  # None: not measured
    levels: int = 0
    cg: float = math.inf
    elastic_cg: float = math.inf
    most_cg: float = math.inf  # of a solve, with contact or without
    setups: float = math.inf
    residual: float = math.inf  # the worst of the four of all runs with contact
    floor: float = 0.0  # of residuals, by rounding of displacements
    at_rounding: str = ""  # rpc says that rounding ends its run, and by the data it does
    failure: str = ""

    @property
    def ratio(self):
        return self.seconds / self.elastic_seconds if math.isfinite(self.seconds) else math.inf

    @property
    def cg_ratio(self):
        return self.cg / self.elastic_cg if math.isfinite(self.cg) else math.inf

    @property
    def states(self):
        return sum(getattr(self, state) > 0 for state in STATES)

    @property
    def sticks_and_slips(self):
        return self.sticks > 0 and self.slips > 0


@dataclasses.dataclass
class Result:
    """Of one run: rpc's summary, {} without one, the whole process' time, and what is wrong."""

    summary: dict
    seconds: float
    complaint: str

    @property
    def steps(self):
        return sum(self.summary["newton_iterations"]) if self.summary else math.inf


def solve(options, folder, deck, *settings):
    """Runs a deck of a folder. Not converged, with a residual above 1e-8 or out of time: has a complaint."""
    path = folder / (pathlib.Path(deck).stem + ".json")
    path.unlink(missing_ok=True)
    start = time.perf_counter()
    code, stdout, stderr = run([*launch(options), f"--input={deck}", "--set=Output->Exodus=false", *settings], folder, options.time_limit,
                               getattr(options, "environment", None))
    seconds = time.perf_counter() - start
    if code is None or not path.exists():
        lines = (stderr or stdout).strip().splitlines()
        return Result({}, math.inf, f"exit {'-' if code is None else code}: " + (lines[-1][:200] if lines else ""))
    summary = json.loads(path.read_text())
    if code != 0 or not summary["converged"]:
        return Result(summary, seconds, f"exit {code}: {summary['reason']}")
    residual = worst_residual(summary)
    return Result(summary, seconds, "" if residual <= TOLERANCE else f"residual {residual:.1e}")


def worst_residual(summary):
    values = [summary.get(key) for key in RESIDUALS]
    return max(math.inf if value is None or not math.isfinite(value) else value for value in values)


def measure(options, number):
    """The Row of scene `number`."""
    with tempfile.TemporaryDirectory(prefix=f"rpc_family_{number}_") as folder:
        return measure_scene(options, number, *families.make(options.seed, number, options.size, options.kind), pathlib.Path(folder))


def measure_scene(options, number, family, scene, folder):
    write(scene, folder)
    row, complaints = Row(number, family, scene.dim), []
    contact = solve(options, folder, "scene.xml")
    if contact.summary:
        row.element, row.dofs, row.points = (contact.summary[key] for key in ("element", "dofs", "contact_nodes"))
        points = contact_rows(folder)
        states = collections.Counter(point["state"] for point in points)
        row.open, row.closed, row.yielding = (states[state] for state in STATES)
        rubbing = collections.Counter(point.get("friction_state") for point in points)
        row.sticks, row.slips = rubbing["sticks"], rubbing["slips"]
        row.cg, row.most_cg = sum(contact.summary["linear_iterations"]), max(contact.summary["linear_iterations"], default=0)
        row.setups = contact.summary["preconditioner_setups"]
        row.residual, row.levels = worst_residual(contact.summary), len(contact.summary["levels"])
        excuse(row, contact, 10 * rounding(scene, contact.summary, points))
    complain(complaints, "", contact)
    if options.elastic:
        elastic(options, folder, row, complaints, contact)
    if options.kind in WITHOUT_COLD:
        row.steps, row.cold_steps, row.failure = contact.steps, None, "; ".join(complaints)
        keep(options, row, folder)
        return row
    cold = contact
    if row.levels or not contact.summary:
        row.steps = contact.steps
        cold = solve(options, folder, "scene.xml", COLD)
        complain(complaints, "cold: ", cold)
        row.residual = max(row.residual, worst_residual(cold.summary)) if cold.summary else math.inf
    row.cold_steps = cold.steps
    row.failure = "; ".join(complaints)
    keep(options, row, folder)
    return row


def elastic(options, folder, row, complaints, contact):
    """Both times: in turns, twice where runs are short."""
    deck = pathlib.Path(without_contact(str(folder / "scene.xml"), str(folder))).name
    times = [contact.seconds], []
    for turn in range(2 if contact.seconds < SHORT else 1):
        if turn:
            times[0].append(solve(options, folder, "scene.xml").seconds)
        result = solve(options, folder, deck)
        times[1].append(result.seconds)
        excuse(row, result, row.floor)
        complain(complaints, "without contact: ", result)
        if result.summary:
            row.elastic_cg = sum(result.summary["linear_iterations"])
            row.most_cg = max([row.most_cg, *result.summary["linear_iterations"]])
    row.seconds, row.elastic_seconds = (min(values) for values in times)
    if not row.elastic_cg:  # nothing to solve: no measure of what contact adds
        complaints.append("without contact: no CG iterations")


def excuse(row, result, floor):
    """A run that rounding ends, as it says and as the data of the scene say with contact, is no failure."""
    row.floor = floor
    if result.complaint and result.summary and worst_residual(result.summary) <= floor and "rounding" in result.summary["reason"]:
        row.at_rounding, result.complaint = result.complaint, ""


def complain(complaints, where, result):
    if result.complaint and where + result.complaint not in complaints:
        complaints.append(where + result.complaint)


def keep(options, row, folder):
    """The files of a failed scene, or of one that was asked for alone."""
    if not options.keep or not (row.failure or options.only is not None):
        return
    kept = pathlib.Path(options.keep) / f"{row.number:04d}_{row.family}"
    kept.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        (kept / path.name).write_bytes(path.read_bytes())


def command(options, row):
    """The command that runs a scene alone."""
    words = [sys.executable, str(HERE / "measure.py"), f"--rpc={options.rpc}", f"--seed={options.seed}", f"--size={options.size}",
             f"--kind={options.kind}", f"--np={options.np}", f"--only={row.number}", "--keep=DIR"]
    return shlex.join(words)

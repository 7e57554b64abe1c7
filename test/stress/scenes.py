# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes against rpc: each must be solved, or refused for the right reason.

    python3 scenes.py --rpc=build/rpc [--seed=1] [--scenes=510] [--first=0] [--only=K] [--family=NAME] [--jobs=2] [--np=1] [--keep=DIR]

Scene K comes from the seed and K alone. A scene that has a solution must exit 0, converged, with all optimality residuals below 1e-8 and
at most 40 Newton steps (60 in the families of test/families), and its files must hold finite numbers, pressures in [0, xi] and
forces that balance. One without must exit 5 with one message that gives the reason. Which is which is known from the data (scene.py). Where |K||u|, rounded, is above
1e-8 of the load, no program in double precision can tell, and residuals up to that rounding pass: the column `rounding` counts
those scenes. Every 20 scenes a line on standard error says how many are done; interrupted (SIGINT, SIGTERM), the report is of these. The exit
code is 1 if a scene failed or was not run. --keep=DIR keeps the folders of failed scenes, and of --only.
"""
import concurrent.futures
import csv
import dataclasses
import json
import math
import os
import pathlib
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "families"))

import families  # noqa: E402, after its folder
import generate  # noqa: E402
import space  # noqa: E402
import trials  # noqa: E402
from scene import REASONS, applied_resultant, deck, radial_size  # noqa: E402

TIME_LIMIT = 120  # [s]
TOLERANCE = 1e-8  # on each optimality residual
RESIDUALS = ["kkt_residual", "equilibrium_residual", "energy_balance", "duality_gap"]
MOST_NEWTON, MOST_IN_FAMILIES = 40, 60
EACH = 20  # scenes from one line of progress to the next
LARGER = 0.2  # of the scenes of test/families: meshes of their size "middle"
ZONES = (50, 150, 500, math.inf)  # contact points
BALANCE = 1e-6  # forces, relative to the largest of them
NO_STRAIN = 1e-30  # a load that strains a body by less is the tail of an exponential
UNLOADED = 1e-4  # of the stresses within a cell: the largest force at least where nothing acts on a body
NULLABLE = {"multiplier_change"}
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")  # Open MPI refuses root, as in a container, unless told twice
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")


def family_scene(name):
    """A generator of scenes of a family of test/families."""
    return lambda rng: families.scene(name, rng, "middle" if rng.random() < LARGER else "small")


FAMILIES = {**generate.FAMILIES, **{name: family_scene(name) for name in families.FAMILIES}, **space.FAMILIES}
assert len(FAMILIES) == len(generate.FAMILIES) + len(families.FAMILIES) + len(space.FAMILIES), "two families of one name"


@dataclasses.dataclass
class Outcome:
    number: int
    family: str
    verdict: str
    seconds: float = 0.0
    points: int = 0
    newton: int = 0
    uzawa: int = 0
    cg: int = 0
    at_rounding: bool = False
    complaints: list = dataclasses.field(default_factory=list)


def launch(options):
    if options.np == 1:
        return [options.rpc]
    return shlex.split(options.mpiexec) + ["-n", str(options.np), options.rpc]


def run(command, folder, limit=TIME_LIMIT, environment=None):
    """Exit code (None if out of time [s]), stdout, stderr. @param environment  variables besides those of this process"""
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="replace", start_new_session=True, env={**os.environ, **(environment or {})}) as process:
        try:
            stdout, stderr = process.communicate(timeout=limit)
            return process.returncode, stdout, stderr
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # with the ranks that mpiexec has started
            return None, "", f"still running after {limit:g} s"


def write(scene, folder):
    mesh_file = None
    if scene.file:
        mesh_file = "scene.msh" if scene.body else "scene.geo"
        (folder / mesh_file).write_text(scene.file(scene.units[0]))
    (folder / "scene.xml").write_text(deck(scene, mesh_file))


def numbers(value, path=""):
    """(path, number) of all leaves of a JSON value that are numbers or null."""
    if isinstance(value, dict):
        for key, item in value.items():
            if not (key == "error_bar" and value.get("reason")):  # that there is none
                yield from numbers(item, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for item in value:
            yield from numbers(item, path)
    elif value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)):
        yield path, value


def contact_rows(folder):
    """None where a run has failed without results."""
    if not (folder / "scene.contact.csv").exists():
        return []
    with open(folder / "scene.contact.csv", newline="") as file:
        return [{k: v if k in ("state", "side", "friction_state") else float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def stress_of_cell(scene, rows):
    """E u over the size of a cell [Pa]: what K takes together to get the stresses."""
    length, stress = scene.units
    cell = (scene.body.smallest_cell() if scene.body else scene.cell) * length
    u = max([abs(row["u_nu"]) for row in rows] + [abs(row["gap"]) for row in rows if row["pressure"] > 0]
            + [abs(f(x, 0)) * length for c in scene.dirichlet.values() for f in c.values() for x in (0, 0.5, 1)], default=0.0)
    return scene.stiffest() * stress * u / cell


def largest_traction(scene):
    """In the scene's unit of stress, at the time that it is seen at."""
    return max([abs(f(x, 0)) for fs in scene.traction.values() for f in fs for x in (0, 0.5, 1)], default=0.0)


def rounding(scene, summary, rows):
    """What rounding of u leaves of equilibrium: eps |K||u| over the load, in the terms of one cell."""
    stress = scene.units[1]
    load = max(summary["max_pressure"] or 0.0, largest_traction(scene) * stress)
    return 4 * 2.0 ** -53 * scene.softening() * stress_of_cell(scene, rows) / load if load > 0 else 0.0


def check_solution(scene, folder, outcome, code, stdout, stderr):
    complain = outcome.complaints.append
    path = folder / "scene.json"
    if code not in (0, 4) or not path.exists():
        lines = (stderr or stdout).strip().splitlines()
        complain(f"exit {'-' if code is None else code}: " + (lines[-1][:200] if lines else ""))
        return
    summary = json.loads(path.read_text())
    rows = contact_rows(folder)
    outcome.points = len(rows)
    outcome.newton, outcome.uzawa = sum(summary["newton_iterations"]), summary["uzawa_iterations"]
    outcome.cg = max(summary["linear_iterations"], default=0)
    floor = rounding(scene, summary, rows)
    worst = {key: summary[key] for key in RESIDUALS if key in summary}
    at_most = lambda bound: all(value is not None and value <= bound for value in worst.values())
    outcome.at_rounding = not at_most(TOLERANCE) and at_most(10 * floor)
    if outcome.at_rounding:
        return
    if code != 0 or not summary["converged"]:
        complain(f"exit {code}: {summary['reason']}; " + ", ".join(f"{k} {v}" for k, v in worst.items()) + f"; rounding {floor:.0e}")
    elif not at_most(TOLERANCE):
        complain(", ".join(f"{k} {v}" for k, v in worst.items()))
    if outcome.newton > (MOST_IN_FAMILIES if outcome.family in families.FAMILIES else MOST_NEWTON):
        complain(f"{outcome.newton} Newton steps")
    if code == 0:
        check_numbers(scene, summary, rows, floor, complain)


def check_numbers(scene, summary, rows, floor, complain):
    for path, value in numbers(summary):
        if path not in NULLABLE and (value is None or not math.isfinite(value)):
            complain(f"{path} is {value}")
    length, stress = scene.units
    sides = {contact.side: contact for contact in scene.contact}
    for row in rows:
        side = sides[row["side"]]
        xi = side.xi(*(row[c] / length for c in "xyz"[:scene.dim])) * stress + side.hardening * stress / length * row["dent"]
        if not 0 <= row["pressure"] <= xi * (1 + 1e-7) or any(not math.isfinite(v) for v in row.values() if isinstance(v, float)):
            complain(f"contact node at ({row['x']}, {row['y']}): pressure {row['pressure']}, xi {xi}")
            break
        q, bears = traction_along(row), friction_bound(scene, row)
        lent = row.get("area") == 0  # by the nodes around: p, q and mu of one such point need not go together
        if q > bears * (1 + 1e-7) and not lent:
            complain(f"contact node at ({row['x']}, {row['y']}): traction {q} along the side, which bears {bears}")
            break
    applied = None if unknown_load(scene) else applied_resultant(scene)
    if applied is None:
        return
    unit = stress * length ** scene.load_power()
    forces = list(summary["reaction_force"].values()) + [summary["contact_force"]]
    forces.append([a * unit for a in applied])
    rest = math.hypot(*(sum(force[c] for force in forces) for c in range(scene.dim)))
    scale = max([math.hypot(*force) for force in forces] + [radial_size(scene) * unit])
    if not (largest_traction(scene) or scene.body_force or summary["max_pressure"]):  # moved without a touch: forces are what the solver leaves
        scale = max(scale, UNLOADED * stress_of_cell(scene, rows) * unit / stress)
    scale = max(scale, NO_STRAIN * scene.stiffest() * unit)
    if not rest <= max(BALANCE, 100 * floor) * scale:
        complain(f"forces do not balance: {rest:.3g} is left of {scale:.3g}")


def traction_along(row):
    return math.hypot(*(row.get("q_" + c, 0.0) for c in "xyz"))


def friction_bound(scene, row):
    """The traction along the side that the point of a row bears [Pa]."""
    length, stress = scene.units
    friction = next(contact.friction for contact in scene.contact if contact.side == row["side"])
    return friction.bears(row["pressure"] / stress, *(row[c] / length for c in "xyz"[:scene.dim])) * stress if friction else 0.0


def unknown_load(scene):
    """Body forces on curved cells in the plane are integrated by another rule here."""
    return bool(scene.body_force and scene.dim == 2 and scene.body and scene.file and scene.body.parts[0].order == 2)


def check_refusal(verdict, outcome, code, stderr):
    messages = [line for line in stderr.splitlines() if line.startswith("rpc: ")]
    if code != 5:
        outcome.complaints.append(f"exit {code} instead of 5 ({verdict}): {messages[0][:200] if messages else ''}")
    elif len(messages) != 1:
        outcome.complaints.append(f"{len(messages)} messages instead of one")
    elif not any(all(part in messages[0] for part in parts) for parts in REASONS[verdict]):
        outcome.complaints.append(f"message without the reason ({verdict}): {messages[0][:300]}")
    elif verdict == "limit" and len(re.findall(r"\d(?:\.\d+)?(?:e[-+]?\d+)?", messages[0])) < 2:
        outcome.complaints.append(f"message without load and limit: {messages[0][:300]}")


def judge(options, number):
    family, scene, verdict = generate.make(random.Random(f"{options.seed}/{number}"), number, FAMILIES)
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rpc_scene_{number}_"))
    outcome = Outcome(number, family, verdict)
    try:
        write(scene, folder)
        start = time.monotonic()
        code, stdout, stderr = run(launch(options) + ["--input=scene.xml"], folder)
        outcome.seconds = time.monotonic() - start
        if verdict == "solution":
            check_solution(scene, folder, outcome, code, stdout, stderr)
        else:
            check_refusal(verdict, outcome, code, stderr)
        if options.keep and (outcome.complaints or options.only is not None):
            kept = pathlib.Path(options.keep) / f"{number:04d}_{family}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            (kept / "stdout.txt").write_text(stdout)
            (kept / "stderr.txt").write_text(stderr)
            (kept / "verdict.txt").write_text("\n".join([f"must be: {verdict}"] + outcome.complaints) + "\n")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


# --- the report ------------------------------------------------------------------------------------------------------------


def median(values):
    return sorted(values)[len(values) // 2] if values else 0


def table(outcomes):
    lines = ["| family | scenes | converged | rounding | refused | failed | Newton median | worst | Uzawa worst | CG worst | s worst |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    names = [f for f in FAMILIES if any(o.family == f for o in outcomes)]
    for name in names + ["all"]:
        mine = [o for o in outcomes if name in (o.family, "all")]
        good = [o for o in mine if not o.complaints]
        solved = [o for o in good if o.verdict == "solution"]
        counts = [len(mine), sum(not o.at_rounding for o in solved), sum(o.at_rounding for o in solved), len(good) - len(solved),
                  len(mine) - len(good), median([o.newton for o in solved]), max((o.newton for o in mine), default=0),
                  max((o.uzawa for o in mine), default=0), max((o.cg for o in mine), default=0)]
        lines.append(f"| {name} | " + " | ".join(map(str, counts)) + f" | {max(o.seconds for o in mine):.1f} |")
    return "\n".join(lines)


def zone_table(outcomes):
    """Steps by the size of the contact zone, of all scenes with results, failed ones too."""
    lines = ["| contact points | scenes | steps median | 95 % | worst |", "|---|---|---|---|---|"]
    for low, high in zip((0,) + ZONES, ZONES):
        steps = sorted(o.newton for o in outcomes if o.points and low <= o.points < high)
        label = f"{low} to {high - 1}" if high < math.inf else f"{low} and more"
        if steps:
            lines.append(f"| {label} | {len(steps)} | {median(steps)} | {steps[math.ceil(0.95 * len(steps)) - 1]} | {steps[-1]} |")
    return "\n".join(lines)


def rerun(options, outcome):
    return f"{sys.argv[0]} --rpc={options.rpc} --seed={options.seed} --only={outcome.number} --keep=DIR"


def progress(outcomes, asked, start):
    failed = sum(1 for o in outcomes if o.complaints)
    print(f"{len(outcomes)} of {asked} scenes, {failed} failed, {(time.monotonic() - start) / 60:.1f} min", file=sys.stderr, flush=True)


def report(options, outcomes, asked):
    failed = [o for o in outcomes if o.complaints]
    print(f"\nseed {options.seed}, {len(outcomes)} of {asked} scenes\n\n{table(outcomes)}\n\n{zone_table(outcomes)}\n")
    for o in failed:
        print(f"FAILED {o.number} {o.family}: {'; '.join(o.complaints)}")
    if failed:
        print(f"\nOne alone, with its files: {rerun(options, failed[0])}")
    solved = [o for o in outcomes if o.verdict == "solution" and not o.complaints]
    for what, key in [("Newton steps", "newton"), ("CG iterations", "cg"), ("seconds", "seconds")]:
        worst = sorted(solved, key=lambda o: -getattr(o, key))[:3]
        print(f"most {what}: " + ", ".join(f"{getattr(o, key):.4g} ({o.family}, --only={o.number})" for o in worst))
    stopped = "" if len(outcomes) == asked else f"; stopped after {len(outcomes)} of {asked}"
    print(f"\n{len(failed)} of {len(outcomes)} scenes failed{stopped}")
    return 1 if failed or stopped else 0


def chosen(options):
    if options.only is not None:
        return [options.only]
    numbers_ = range(options.first, options.first + options.scenes)
    names = list(FAMILIES)
    return [k for k in numbers_ if not options.family or names[k % len(names)] in options.family.split(",")]


def judge_all(options, numbers_):
    """Outcomes of scenes in order: all of them, or those until the run is interrupted."""
    outcomes, start = [], time.monotonic()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    pool = concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs)
    try:
        for outcome in pool.map(lambda number: judge(options, number), numbers_):
            outcomes.append(outcome)
            if outcome.complaints:
                print(f"{outcome.number} {outcome.family}: {'; '.join(outcome.complaints)}", file=sys.stderr, flush=True)
            if len(outcomes) % EACH == 0:
                progress(outcomes, len(numbers_), start)
    except KeyboardInterrupt:
        for name in (signal.SIGINT, signal.SIGTERM):  # which may come twice
            signal.signal(name, signal.SIG_IGN)
        print("interrupted: scenes that run come to their end", file=sys.stderr, flush=True)
    pool.shutdown(cancel_futures=True)
    return outcomes


def main():
    families_ = {"help": "only these of the scenes, separated by commas: " + ", ".join(FAMILIES)}
    options = trials.arguments(__doc__, 510, ("--first", {"type": int, "default": 0}), ("--family", families_))
    print(f"seed {options.seed}", flush=True)
    numbers_ = chosen(options)
    return report(options, judge_all(options, numbers_), len(numbers_))


if __name__ == "__main__":
    sys.exit(main())

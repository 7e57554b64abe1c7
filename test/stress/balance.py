# SPDX-License-Identifier: BSD-3-Clause
"""`Steps->Energy Tolerance` on random load histories in which contact opens and closes: work and energies must balance.

    python3 balance.py --rpc=build/rpc [--seed=1] [--scenes=100] [--only=K] [--jobs=2] [--np=1] [--keep=DIR]

History K is that of histories.py, at its own times. Those count in which the part in contact changes from step to step, until there are as many
as asked for. With a tolerance of 1e-3 each step may be off by that share of the energies before or after it, doc/theory.md (11.3a); that is
checked, and the worst share of a step is told with the number of parts that it took. What the solver's rounding leaves, see histories.py, does not count, nor does a first step from a body at rest that the foundation overlaps,
which no division balances. The exit code is 1 if a history failed.
"""
import concurrent.futures
import dataclasses
import itertools
import pathlib
import random
import shutil
import sys
import tempfile

import histories
import trials

TOLERANCE = 1e-3
START, PRESSED = 1e-9, 1e-6  # a time just after rest, and the pressure then, over the largest, that tells of an overlap
ENERGIES = ["strain_energy", "foundation_energy", "dissipated_energy", "work"]


@dataclasses.dataclass
class Outcome:
    number: int
    family: str
    counts: bool = False  # contact opens or closes
    steps: int = 0
    parts: int = 0
    before: float = 0.0  # the worst share of a step without the tolerance
    after: float = 0.0  # with it
    worst_parts: int = 0  # of the worst step with it
    complaints: list = dataclasses.field(default_factory=list)


def contact_changes(steps):
    extent = next(key for key in ("contact_length", "contact_area") if key in steps[0])
    values = [step[extent] for step in steps]
    return any(a != b for a, b in zip(values, values[1:]))


def shares(steps, rest):
    """Of the energies before or after each step: by how much it is off beyond a rest [J]."""
    found, before = [], 0.0
    for step, missed in zip(steps, histories.missed(steps)):
        after = max(abs(step[key]) for key in ENERGIES)
        largest = max(before, after)
        found.append(max(0.0, abs(missed) - rest) / largest if largest > 0 else 0.0)
        before = after
    return found


def overlaps(options, scene, folder, steps):
    """Whether the foundation presses on the body before anything moves. Where it does not, there is only rounding to solve."""
    start = histories.run(options, dataclasses.replace(scene, times=[START]), folder, lambda complaint: None)
    return bool(start) and start[0]["max_pressure"] > PRESSED * max(step["max_pressure"] for step in steps)


def judge(options, number):
    family, scene = histories.make(random.Random(f"{options.seed}/history/{number}"))
    outcome = Outcome(number, family)
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rpc_balance_{number}_"))
    try:
        plain = histories.run(options, scene, folder / "plain", outcome.complaints.append)
        if not plain or not contact_changes(plain[0]["steps"]):
            return outcome
        balanced = histories.run(options, scene, folder / "balanced", outcome.complaints.append, f"--set=Steps->Energy Tolerance={TOLERANCE}")
        if not balanced:
            return outcome
        outcome.counts = True
        steps = balanced[0]["steps"]
        rest = histories.ROUNDING * histories.at_work(balanced) + histories.solver_rest(scene, balanced[1])
        outcome.steps, outcome.parts = len(steps), sum(step["parts"] for step in steps)
        before = shares(plain[0]["steps"], rest)
        off = shares(steps, rest)
        if overlaps(options, scene, folder / "start", steps):
            before[0] = off[0] = 0.0
        outcome.before = max(before)
        outcome.after, outcome.worst_parts = max((share, step["parts"]) for share, step in zip(off, steps))
        for share, step in zip(off, steps):
            if share > TOLERANCE:
                outcome.complaints.append(f"at t = {step['time']} {share:.2g} is missed in {step['parts']} parts")
    except histories.AtRounding:
        pass
    finally:
        if outcome.complaints and options.keep:
            shutil.copytree(folder, pathlib.Path(options.keep) / f"{number:04d}_{family}", dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def main():
    options = trials.arguments(__doc__, 100)
    numbers = iter([options.only] if options.only is not None else itertools.count())
    counted, failed = [], 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        while len(counted) < options.scenes:
            some = list(itertools.islice(numbers, min(10, options.scenes - len(counted))))
            if not some:
                break
            for o in pool.map(lambda number: judge(options, number), some):
                counted += [o] if o.counts else []
                failed += bool(o.complaints)
                if o.complaints:
                    print(f"FAILED {o.number} {o.family}: {'; '.join(o.complaints)}", flush=True)
    worst = max(counted, key=lambda o: o.after, default=Outcome(-1, "none"))
    most = max(counted, key=lambda o: o.parts, default=worst)
    print(f"seed {options.seed}: {failed} failed; {len(counted)} histories in which contact opens or closes, {sum(o.steps for o in counted)} steps in "
          f"{sum(o.parts for o in counted)} parts, most {most.parts} (--only={most.number}); off by {max((o.before for o in counted), default=0):.2g} "
          f"at worst without the tolerance, by {worst.after:.2g} with it (--only={worst.number}, a step of {worst.worst_parts} parts)")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

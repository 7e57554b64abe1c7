# SPDX-License-Identifier: BSD-3-Clause
"""Damages decks and meshes at random and expects of rpc, whatever they hold by then: an end in good time and memory, not by a
signal nor as an internal error, one message that names what is wrong, and no half of a result.

    mutations.py --rpc=build/rpc [--seed=1] [--count=2000] [--first=0] [--jobs=2] [--keep=DIR] [--decks=ball*,curved_*]
    mutations.py --rpc=build/rpc --seed=1 --only=17 --keep=DIR      mutation 17 alone, its files left in DIR
    mutations.py --rpc=build/rpc --files=*.msh                      meshes of gmsh alone are damaged; --words lists what was said of them

Mutation K depends on the seed, the decks, the files and K alone. --memory=0 lifts the bound on memory, which AddressSanitizer and CUDA do not bear.
"""

import argparse
import collections
import concurrent.futures
import fnmatch
import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import corpus
import mutators

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "test" / "regression"))
from rpc_run import NOISE, files  # noqa: E402

LONGEST_MESSAGE = 1000  # characters
# Numbers that a deck must ask for; null is how the JSON file says that it does not.
OPTIONAL = {"/error_estimate/exact_relative", "/error_estimate/effectivity"}
SANITIZERS = ["AddressSanitizer", "LeakSanitizer", "runtime error:", "ThreadSanitizer", "MemorySanitizer"]
# What keeps a scene that is still valid short.
CAPS = ["--set=Uzawa->Maximum Iterations=4", "--set=NOX->Maximum Iterations=15", "--set=Linear Solver->Maximum Iterations=100"]
# gmsh's language can start programs and write files.
FORBIDDEN_IN_GEO = re.compile(rb"system|include|merge|print|save|plugin|onelab|exit|abort|error|warning", re.IGNORECASE)


def cells_of(deck):
    """Number of cells that a deck asks for, 0 where that is not to be seen."""
    found = re.search(rb'(?:name="Cells"[^>]*value="|Cells: )[{\[]([^}\]"]*)', deck)
    counts = re.findall(rb"\d+", found[1]) if found else []
    return math.prod(int(count) for count in counts) if counts else 0


def is_fair(name, data):
    """Whether rpc may be blamed for what comes of it: a run that is long because its mesh is large is no fault."""
    if name.endswith(".geo"):
        return not FORBIDDEN_IN_GEO.search(data)
    return not (name.endswith((".xml", ".yaml")) and 2000 < cells_of(data) < 2e7)


class Mutation:
    """Scene, damaged file, kinds of damage and what has come of it."""

    def __init__(self, seed, number, scenes, pattern="*"):
        rng = random.Random(f"{seed}/{number}")
        self.number = number
        self.scene = scenes[rng.choice(sorted(scenes))]
        self.files = dict(self.scene.files)
        self.file = rng.choice(sorted(fnmatch.filter(self.files, pattern)))
        pool = [scene.files[name] for scene in scenes.values() for name in scene.files
                if pathlib.Path(name).suffix == pathlib.Path(self.file).suffix and name != self.file]
        weights = mutators.kinds_for(self.file)
        while True:
            self.kind, data = rng.choices(list(weights), weights.values())[0], self.scene.files[self.file]
            if self.kind in ("empty", "missing", "folder"):
                data = b"" if self.kind == "empty" else None
                break
            for _ in range(rng.choice([1, 1, 1, 2, 4])):
                data = mutators.ALL[self.kind](rng, data, pool) if data else data
            if data != self.scene.files[self.file] and is_fair(self.file, data):
                break
        self.files[self.file] = data

    def write(self, folder):
        for name, data in self.files.items():
            if data is not None:
                (folder / name).write_bytes(data)
        if self.kind == "folder":
            (folder / self.file).mkdir()


def run(options, folder, deck):
    """(exit code or None for one that was killed in the end, stdout, stderr)"""
    def limits():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if options.memory > 0:
            resource.setrlimit(resource.RLIMIT_AS, (int(options.memory * 2**30),) * 2)
    environment = {"OMP_NUM_THREADS": "1", "OMP_PROC_BIND": "false", **os.environ}
    try:
        result = subprocess.run([options.rpc, f"--input={deck}", "--output=out", *CAPS], cwd=folder, capture_output=True,
                                timeout=options.timeout, stdin=subprocess.DEVNULL, env=environment, preexec_fn=limits)
    except subprocess.TimeoutExpired as late:
        return None, late.stdout or b"", late.stderr or b""
    return result.returncode, result.stdout, result.stderr


def strict_json(text):
    def refuse(constant):
        raise ValueError(f"{constant} in the JSON file")
    return json.loads(text, parse_constant=refuse)


def nulls(value, path=""):
    """Where a JSON value holds a null, which stands for a number that is not finite, unless it is one that the deck must ask for."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
    if isinstance(value, dict) and value.get("reason"):  # that there is no error bar
        items = [item for item in items if item[0] != "error_bar"]
    return [path] if value is None and path not in OPTIONAL else [found for key, item in items for found in nulls(item, f"{path}/{key}")]


def check_message(stderr):
    """What is wrong with the words of a refusal."""
    lines = stderr.strip("\n").split("\n")
    if len(lines) != 1 or not re.match(r"rpc: error: .*\S", lines[0]):
        return f"stderr must hold one line \"rpc: error: ...\", got {len(lines)}: {stderr[:300]!r}"
    if len(lines[0]) > LONGEST_MESSAGE:
        return f"a message of {len(lines[0])} characters: {lines[0][:200]!r}"
    if not lines[0].isprintable():
        return f"control characters in the message: {lines[0][:300]!r}"
    noise = [word for word in NOISE if word in lines[0]]
    return f"{noise} in the message: {lines[0][:300]!r}" if noise else None


def check_results(out, code, stdout):
    """What is wrong with the files of a run to the end."""
    reports = [name for name in files(out) if name.endswith(".json")]
    if len(reports) > 1 or any(not re.search(r"(\.e|\.contact\.csv|\.json)$", name) for name in files(out)):
        return f"strange files: {files(out)}"
    for name in reports:
        report = strict_json((out / name).read_text(encoding="utf-8"))
        if report["converged"] != (code == 0):
            return f"exit code {code}, but converged is {report['converged']}"
        if code == 0 and nulls(report):
            return f"converged with numbers that are not finite: {nulls(report)}"
        if code == 4 and report["reason"] not in stdout:
            return "the console does not say why"
    if code == 0 and any("nan" in (out / name).read_text(errors="replace") for name in files(out) if name.endswith("csv")):
        return "nan in the CSV file"
    return None


def check(folder, code, stdout, stderr):
    """What rpc has done wrong, None for nothing."""
    stdout, stderr = stdout.decode(errors="replace"), stderr.decode(errors="replace")
    report = [mark for mark in SANITIZERS if mark in stderr + stdout]
    if report:
        return f"{report[0]}: {stderr[stderr.find(report[0]):][:600]}"
    if code is None:
        return f"has not come to an end; its last words: {stdout[-200:]!r}"
    if code not in (0, 2, 3, 4, 5):
        return f"{'signal' if code < 0 else 'exit code'} {abs(code)}: {stderr[-400:]!r}"
    out = folder / "out"
    if code in (2, 3, 5):
        return check_message(stderr) or (f"files left: {files(out)}" if files(out) else None)
    if code == 0 and stderr.strip():
        return f"words on stderr: {stderr[:300]!r}"
    try:
        return check_results(out, code, stdout)
    except (ValueError, KeyError) as error:
        return f"the JSON file: {error}"


def judge(options, mutation):
    """(mutation, exit code, complaint, stderr, seconds) of one mutation."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rpc_mutation_"))
    try:
        mutation.write(folder)
        start = time.monotonic()
        code, stdout, stderr = run(options, folder, mutation.scene.deck)
        seconds = time.monotonic() - start
        complaint = check(folder, code, stdout, stderr)
        if options.keep and (complaint or options.only is not None):
            kept = pathlib.Path(options.keep) / f"{options.seed}_{mutation.number}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            (kept / "stdout.txt").write_bytes(stdout)
            (kept / "stderr.txt").write_bytes(stderr)
        return mutation, code, complaint, stderr, seconds
    finally:
        shutil.rmtree(folder)


def require_meshio(names):
    """Damage to files that rpc converts by meshio shows nothing where python3 lacks it: each is refused for that."""
    converted = [name for name in names if name.endswith((".inp", ".med", ".vtk", ".vtu"))]
    if not converted or subprocess.run(["python3", "-c", "import meshio, h5py"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
        return
    told = f"{converted[0]} and the like take a python3 with meshio and h5py, which the first one of PATH has not: all are refused for that"
    if len(converted) == len(names):
        sys.exit(told)
    print(f"note: {told}", flush=True)


def print_table(results):
    codes = sorted({code for _, code, _ in results}, key=lambda code: (code is None, code))
    counts = collections.Counter((mutation.kind, code) for mutation, code, _ in results)
    print(f"{'mutation':18}" + "".join(f"{'late' if code is None else code:>7}" for code in codes) + f"{'failed':>8}")
    for kind in sorted({mutation.kind for mutation, _, _ in results}):
        failed = sum(1 for mutation, _, complaint in results if mutation.kind == kind and complaint)
        print(f"{kind:18}" + "".join(f"{counts[kind, code] or '':>7}" for code in codes) + f"{failed or '':>8}")
    print(f"{'all':18}" + "".join(f"{sum(1 for _, c, _ in results if c == code):>7}" for code in codes)
          + f"{sum(1 for *_, complaint in results if complaint):>8}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True, help="the program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=2000, help="number of mutations")
    parser.add_argument("--first", type=int, default=0, help="number of the first mutation")
    parser.add_argument("--only", type=int, help="one mutation by its number")
    parser.add_argument("--decks", default="*", help="only decks of corpus.py of these names, separated by commas, with * and ?")
    parser.add_argument("--files", default="*", help="only files of these names are damaged, with * and ?")
    parser.add_argument("--words", action="store_true", help="lists the different messages, numbers left out")
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side")
    parser.add_argument("--keep", help="folder for the input and output of failures")
    parser.add_argument("--memory", type=float, default=4, help="GiB of address space for a run, 0: no bound")
    parser.add_argument("--timeout", type=float, default=20, help="seconds for a run")
    options = parser.parse_args()
    options.rpc = os.path.abspath(options.rpc)

    scenes = {name: scene for name, scene in corpus.scenes(SOURCE).items()
              if any(fnmatch.fnmatch(name, pattern) for pattern in options.decks.split(",")) and fnmatch.filter(scene.files, options.files)}
    require_meshio([name for scene in scenes.values() for name in fnmatch.filter(scene.files, options.files)])
    numbers = range(options.first, options.first + options.count) if options.only is None else [options.only]
    failures = 0
    results = []
    times = []
    said = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for result in pool.map(lambda number: judge(options, Mutation(options.seed, number, scenes, options.files)), numbers):
            *result, stderr, seconds = result
            mutation, code, complaint = result
            results.append(result)
            times.append((seconds, mutation.number))
            said[re.sub(r"[-+.\w]*\d[-+.\w]*", "#", stderr.decode(errors="replace").strip())[:300]] += 1
            if options.only is not None:
                print(f"{mutation.kind} of {mutation.file} for {mutation.scene.deck}: exit code {code}")
            if complaint:
                failures += 1
                print(f"{mutation.number}: {mutation.kind} of {mutation.file} for {mutation.scene.deck}: {complaint}\n"
                      f"    {sys.argv[0]} --rpc={options.rpc} --seed={options.seed} '--decks={options.decks}' '--files={options.files}' --only={mutation.number} --keep=DIR",
                      flush=True)
    print_table(results)
    print("slowest: " + ", ".join(f"{number} ({seconds:.1f} s)" for seconds, number in sorted(times, reverse=True)[:5]))
    if options.words:
        print("\n".join(f"{count:6} {words}" for words, count in sorted(said.items(), key=lambda item: -item[1])))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""What becomes of all meshes and geometries in folders, such as clones of other programs' repositories: a table in Markdown.

    public_meshes.py --rpc=build/rpc FOLDER [FOLDER ...] [--kinds=inp,msh] [--timeout=120] [--jobs=2]

rpc reads each file (--mesh-info). What it reads it also solves: the top of the body, seen along the last axis, is pressed down by a thousandth
of its height on a plane under its lowest point. Refusals that differ in names and numbers alone share a row. Exit code 1: a file made rpc break
down, run late, or refuse in more than one line. FOLDER may be NAME=FOLDER.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ENDINGS = ("geo", "step", "stp", "iges", "igs", "brep", "stl", "msh", "e", "exo", "exoii", "ex2", "g", "gen", "unv", "inp", "med", "vtk", "vtu")
SLABS = (1e-6, 0.05, 0.3, 0.6)  # of the height: what counts as top and as bottom, the first with facets in it
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"

DECK = """run:
  Mesh: {{Type: gmsh, File: {file}, Sides: {{rpc top: {{Box: [{top}]}}, rpc bottom: {{Box: [{bottom}]}}}}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    rpc top: {{{held}}}
  Contact: {{Side: rpc bottom, Obstacle: {{Type: plane, Point: [{point}], Normal: [{normal}]}}}}
  Output: {{Exodus: none}}
"""


def started(options, folder, *arguments):
    """(exit code, stdout, stderr); 124 for one that is late."""
    try:
        done = subprocess.run([options.rpc, *arguments], cwd=folder, capture_output=True, timeout=options.timeout, stdin=subprocess.DEVNULL,
                              env={"OMP_NUM_THREADS": "1", "OMP_PROC_BIND": "false", **os.environ})
    except subprocess.TimeoutExpired:
        return 124, "", ""
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def deck_of(file, info, slab):
    """Presses the body, of which the first line of --mesh-info tells the extent."""
    extents = [(float(low), float(high)) for low, high in re.findall(rf"[xyz] from ({NUMBER}) to ({NUMBER})", info)]
    size = max(high - low for low, high in extents)
    low, high = extents[-1]
    wide = [(a - size, b + size) for a, b in extents]
    corners = lambda span: ", ".join(repr(float(number)) for side in zip(*wide[:-1], span) for number in side)
    held = ", ".join(f"{axis}: {-1e-3 * (high - low) if k + 1 == len(extents) else 0.0}" for k, axis in enumerate("XYZ"[:len(extents)]))
    point = [0.0] * (len(extents) - 1) + [low]
    normal = [0.0] * (len(extents) - 1) + [1.0]
    return DECK.format(file=json.dumps(str(file)), held=held, top=corners((high - slab * (high - low), high + size)),
                       bottom=corners((low - size, low + slab * (high - low))), point=", ".join(map(repr, point)), normal=", ".join(map(repr, normal)))


def solved(options, file, info):
    """What the run of a body comes to, and what is wrong with it."""
    said = ""
    for slab in SLABS:
        with tempfile.TemporaryDirectory(prefix="rpc_public_") as folder:
            (pathlib.Path(folder) / "run.yaml").write_text(deck_of(file.resolve(), info, slab))
            code, _, error = started(options, folder, "--input=run.yaml", "--output=out")
            reports = list(pathlib.Path(folder).glob("out/*.json"))
            report = json.loads(reports[0].read_text()) if reports else {}
        said = error.strip().removeprefix("rpc: error: ")
        if code == 2 and "rpc " in said and "no facet" in said:
            continue
        if code == 0:
            return f"solved: {report['dofs']} unknowns, force {report['contact_force'][-1]:.4g}", None
        return f"not solved ({code}): {report.get('reason') or said}", None if code in (2, 3, 4, 5) else f"exit code {code}"
    return f"not solved: {said}", None


def judged(options, file):
    """(what it holds, what comes of it, complaint)"""
    code, out, error = started(options, file.parent, f"--mesh-info={file.name}")
    if code == 0:
        lines = out.splitlines()
        parts = {kind: sum(line.startswith(f"  {kind} ") for line in lines) for kind in ("block", "side", "surface", "curve", "points", "note")}
        holds = lines[0].partition(": ")[2].partition(";")[0] + "".join(
            f", {count} {kind}{'s' if count > 1 and kind != 'points' else ''}" for kind, count in parts.items() if count and kind != "note")
        run, complaint = solved(options, file, lines[0])
        notes = [line.split(None, 1)[1] for line in lines if line.startswith("  note ")]
        return holds, "read" + (f" with {len(notes)} note{'s' if len(notes) > 1 else ''}" if notes else "") + f"; {run}", complaint
    refusal = error.strip().removeprefix("rpc: error: ").removeprefix("mesh: ").removeprefix(f'"{file.name}": ')
    wrong = f"exit code {code}" if code not in (2, 3) else "more than one line" if len(error.strip().splitlines()) != 1 else None
    return "", f"refused: {refusal}" if wrong is None else f"{wrong}: {refusal[:200]}", wrong


def escaped(text):
    """For a table in Markdown."""
    return re.sub(r"([*<|])", r"\\\1", text)


def rows_of(name, root, results):
    """Refusals that are the same but for names and numbers are one row."""
    rows = {}
    for file, (holds, outcome, _) in results:
        key = re.sub(r'"[^"]*"|' + NUMBER, "#", outcome) if outcome.startswith("refused") else str(file)
        rows.setdefault(key, []).append((file.relative_to(root).as_posix(), holds, outcome))
    for same in rows.values():
        file, holds, outcome = same[0]
        more = f" and {len(same) - 1} more" if len(same) > 1 else ""
        yield f"| {name} | {file}{more} | {holds} | {escaped(outcome)} |".replace("\n", " ")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True, help="the program")
    parser.add_argument("--kinds", default=",".join(ENDINGS), help="endings of files, separated by commas")
    parser.add_argument("--timeout", type=float, default=120, help="seconds for a run")
    parser.add_argument("--jobs", type=int, default=2, help="files side by side")
    parser.add_argument("folders", nargs="+")
    options = parser.parse_args()
    options.rpc = os.path.abspath(options.rpc)
    print("| From | File | What it holds | What comes of it |\n|---|---|---|---|")
    counts, complaints = {"read": 0, "refused": 0, "solved": 0}, []
    for given in options.folders:
        name, _, folder = given.rpartition("=")
        root = pathlib.Path(folder)
        files = sorted(path for path in root.rglob("*") if path.is_file() and path.suffix.lower()[1:] in options.kinds.split(","))
        with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
            results = list(zip(files, pool.map(lambda file: judged(options, file), files)))
        for row in rows_of(name or root.name, root, results):
            print(row, flush=True)
        for file, (_, outcome, complaint) in results:
            for key in counts:
                counts[key] += key in outcome.split(";")[0].split(":")[0].split() or (key == "solved" and "; solved: " in outcome)
            complaints += [f"{file}: {complaint}"] if complaint else []
    print(f"\n{counts['read']} read, {counts['solved']} of them solved; {counts['refused']} refused; {len(complaints)} failed")
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: BSD-3-Clause
"""A periodic rough surface beside tamaas and ContactMechanics: contact area, energy and processor time, elastic and with a hardness.

    python3 rough_peers.py --rpc=build/rpc [--grids=64,128] [--reference=512] [--depth=0.25] [--element=Q1] [--flatness=1] [--expansion=1] [--highest=8]
                           [--hardnesses=inf,0.3] [--csv=FILE]
    python3 rough_peers.py --read=FILE                                  # tables of an earlier --csv

One surface for all, made by rpc: period 1, Hurst exponent 0.8, wave numbers from 4 to --highest, rms slope 1, seed 1. E* = 1, mean pressure 0.05. The
hardness is the largest pressure that the foundation bears; inf is elastic contact.

- layer: an elastic layer of --depth on a rigid plate. rpc meshes it with cubes, or cells --flatness times as wide as deep; with --expansion the
  last ones, far from the surface, are so many times as deep as the first ones. Of ContactMechanics it is the substrate of finite thickness: the same
  problem. Energy is that of the layer, its mean compression included.
- half space: tamaas and ContactMechanics. Energy is that of the displacement less its mean. rpc has none: its value is that of the layer less p^2/2 times
  the layer's mean compliance, plus how much ContactMechanics' half space differs from its layer on the grid of the reference.

The reference is ContactMechanics on --reference points a period, extrapolated by that of half as many (energy with the second power of the spacing, area with
the first). Error: relative difference from it. "Extrapolated": from the two finest grids in the same way; its time is that of both. Times are seconds of a
processor, of one thread, so that other programs on the machine hardly matter; those of rpc are of its whole process, of the others of the solve.

The second table has the least time with which a program has an error of at most so much, all its finer grids too; the extrapolated values count as the finest.

tamaas and ContactMechanics come from PyPI; without network: pip download tamaas ContactMechanics -d FOLDER where there is one, then
pip install --no-index --find-links=FOLDER tamaas ContactMechanics. A peer that is missing is left out with a word. Without ContactMechanics there is no
reference; then the finest of rpc's own grids takes its place.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"  # before the peers are loaded
try:
    import numpy
except ImportError:
    sys.exit("rough_peers.py: NumPy is missing: pip install numpy, or in Debian apt install python3-numpy")
try:
    import tamaas
except ImportError:
    tamaas = None
try:
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from ContactMechanics.Optimization.ConstrainedConjugateGradients import constrained_conjugate_gradients
    from SurfaceTopography import Topography
except ImportError:
    PeriodicFFTElasticHalfSpace = None

POISSON, PRESSURE = 0.3, 0.05
ENERGY_ERRORS, AREA_ERRORS = (0.01, 0.003, 0.001), (0.1, 0.03, 0.01)
MODULUS = 1 - POISSON**2  # E* = 1
OEDOMETRIC = MODULUS * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
WAVES = {"Lowest Wave Number": 4, "RMS Slope": 1, "Seed": 1}
TOLERANCE = 1e-9


def heights(rpc, points, highest, folder):
    """The surface on a grid, and its file."""
    file = pathlib.Path(folder) / f"rough_{points}.npy"
    given = {**WAVES, "Points": points, "Highest Wave Number": highest}
    if not file.exists():
        subprocess.run([rpc, f"--make-surface={file}"] + [f"--set={name}={value}" for name, value in given.items()], check=True, capture_output=True)
    return numpy.load(file), file


def layers_of(depth, first, expansion):
    """So many that the first one of a depth is about that deep."""
    if expansion == 1:
        return max(1, round(depth / first))

    def first_of(layers):
        q = expansion ** (1 / (layers - 1))
        return depth * (q - 1) / (q**layers - 1)

    return min(range(2, max(3, math.ceil(depth / first))), key=lambda layers: abs(first_of(layers) - first))


def deck(points, layers, depth, element, hardness, file, expansion=1.0):
    cells = points // (2 if element == "Q2" else 1)
    law = "" if math.isinf(hardness) else f"Yield Stress: {hardness}"
    return f"""rough:
  Mesh: {{Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, {depth}], Cells: [{cells}, {cells}, {layers}], Element: {element}, Periodic: "X, Y", Expansion Ratio: [1.0, 1.0, {float(expansion)!r}]}}
  Material: {{Young's Modulus: {MODULUS}, Poisson's Ratio: {POISSON}}}
  Dirichlet: {{front: {{X: 0.0, Y: 0.0, Force Z: {-PRESSURE}}}}}
  Contact:
    Side: back
    Normal: "0, 0, -1"
    {law}
    Obstacle: {{Type: height map, File: {file.name}, Spacing X: {1 / points!r}, Periodic: true, Origin: [0.0, 0.0, {-float(numpy.load(file).max())!r}], Normal: [0.0, 0.0, 1.0]}}
  Output: {{Exodus: false, CSV: false}}
"""


def run_rpc(options, points, hardness, folder):
    """Of the layer: (area, energy), seconds of a processor."""
    _, file = heights(options.rpc, points, options.highest, folder)
    layers = layers_of(options.depth, (2 if options.element == "Q2" else 1) / (options.flatness * points), options.expansion)
    (pathlib.Path(folder) / "rough.yaml").write_text(deck(points, layers, options.depth, options.element, hardness, file, options.expansion))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run([options.rpc, f"--input={folder}/rough.yaml", f"--output={folder}"], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode != 0:
        sys.exit(f"rough_peers.py: rpc ends with {run.returncode} on {points} points: {run.stderr.strip()[-500:]}")
    found = json.loads((pathlib.Path(folder) / "rough.json").read_text())
    print(f"rpc, {points} points, hardness {hardness:g}: {found['dofs']} unknowns, Newton {found['newton_iterations']}, linear iterations {sum(found['linear_iterations'])}, "
          f"{found['seconds']['total']:.0f} s", file=sys.stderr, flush=True)
    return (found["contact_area"], found["strain_energy"]), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run_contactmechanics(surface, hardness, depth):
    """(area, energy), seconds of a processor."""
    n = len(surface)
    limited = None if math.isinf(hardness) else hardness / n**2  # forces of points
    finite = {"thickness": depth, "poisson": POISSON} if depth else {}
    body = PeriodicFFTElasticHalfSpace((n, n), MODULUS if depth else 1.0, (1.0, 1.0), **finite)
    start = time.process_time()
    found = constrained_conjugate_gradients(body, Topography(surface, (1.0, 1.0), periodic=True), hardness=limited, external_force=PRESSURE, pentol=TOLERANCE,
                                            forcetol=TOLERANCE, thermotol=TOLERANCE, maxiter=100000)
    seconds = time.process_time() - start
    if not found.success:
        sys.exit(f"rough_peers.py: ContactMechanics does not converge on {n} points: {found.message}")
    p, u = numpy.asarray(found.jac) * n**2, numpy.asarray(found.x)
    return (float((p > 0).mean()), float(0.5 * (p * (u if depth else u - u.mean())).mean())), seconds


def run_tamaas(surface, hardness):
    """Of the half space: (area, energy), seconds of a processor."""
    n = len(surface)
    tamaas.set_log_level(tamaas.LogLevel.warning)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    start = time.process_time()
    if math.isinf(hardness):
        solver = tamaas.PolonskyKeerRey(model, surface, TOLERANCE, tamaas.PolonskyKeerRey.pressure, tamaas.PolonskyKeerRey.pressure)
    else:
        solver = tamaas.KatoSaturated(model, surface, TOLERANCE, hardness)
    solver.max_iter, solver.dump_freq = 100000, 1000000
    solver.solve(PRESSURE)
    seconds = time.process_time() - start
    model.solveNeumann()
    p, u = numpy.array(model.traction), numpy.array(model.displacement)
    return (float((p > 0).mean()), float(0.5 * (p * (u - u.mean())).mean())), seconds


def extrapolated(coarse, fine):
    """(area, energy) from grids of which one has half the spacing of the other."""
    return 2 * fine[0] - coarse[0], (4 * fine[1] - coarse[1]) / 3


class Table:
    def __init__(self, file):
        self.rows = []
        self.file = file

    def add(self, problem, hardness, program, points, values, seconds, reference):
        errors = [value / exact - 1 for value, exact in zip(values, reference)]
        self.rows.append({"problem": problem, "hardness": hardness, "program": program, "points": points, "area": values[0], "area error": errors[0], "energy": values[1],
                          "energy error": errors[1], "seconds": seconds})
        if self.file:
            with open(self.file, "w", encoding="utf-8", newline="") as out:
                writer = csv.DictWriter(out, self.rows[0])
                writer.writeheader()
                writer.writerows(self.rows)

    def read(self, file):
        with open(file, encoding="utf-8", newline="") as table:
            for row in csv.DictReader(table):
                self.rows.append({key: value if key in ("problem", "program", "points") else float(value) for key, value in row.items()})

    def seconds_to(self, rows, column, error):
        """Of one program; the rows are from the coarsest to the finest. None where the finest misses."""
        good = None
        for row in reversed(rows):
            if abs(row[column]) > error:
                break
            good = row["seconds"]
        return good

    def __str__(self):
        lines = ["| problem | hardness | program | points a period | area | error | energy | error | processor time [s] |", "|---|--:|---|--:|--:|--:|--:|--:|--:|"]
        programs = {}
        for row in self.rows:
            lines.append(f"| {row['problem']} | {row['hardness']:g} | {row['program']} | {row['points']} | {row['area']:.5f} | {100 * row['area error']:+.2f} % | {row['energy']:.5e} | "
                         f"{100 * row['energy error']:+.3f} % | {row['seconds']:.2f} |")
            programs.setdefault((row["problem"], row["hardness"], row["program"]), []).append(row)
        lines += ["", "| problem | hardness | program | " + " | ".join([f"energy to {100 * error:g} %" for error in ENERGY_ERRORS] + [f"area to {100 * error:g} %" for error in AREA_ERRORS]) + " |",
                  "|---|--:|---|" + "--:|" * (len(ENERGY_ERRORS) + len(AREA_ERRORS))]
        for (problem, hardness, program), rows in programs.items():
            times = [self.seconds_to(rows, "energy error", error) for error in ENERGY_ERRORS] + [self.seconds_to(rows, "area error", error) for error in AREA_ERRORS]
            lines.append(f"| {problem} | {hardness:g} | {program} | " + " | ".join("" if time is None else f"{time:.2f}" for time in times) + " |")
        return "\n".join(lines)


def compare(options, hardness, folder, table):
    """One hardness: layer, then half space."""
    surfaces = {n: heights(options.rpc, n, options.highest, folder)[0] for n in {*options.grids, options.reference // 2, options.reference}}
    rpc = {n: run_rpc(options, n, hardness, folder) for n in options.grids}
    programs = {"layer": {"rpc": rpc}, "half space": {}}
    references = {}
    if PeriodicFFTElasticHalfSpace:
        for problem, depth in (("layer", options.depth), ("half space", 0)):
            coarse, fine = (run_contactmechanics(surfaces[n], hardness, depth) for n in (options.reference // 2, options.reference))
            references[problem] = extrapolated(coarse[0], fine[0])
            programs[problem]["ContactMechanics"] = {n: run_contactmechanics(surfaces[n], hardness, depth) for n in options.grids}
            programs[problem]["ContactMechanics"][options.reference] = fine
        mean = 0.5 * PRESSURE**2 * options.depth / OEDOMETRIC
        area, energy = (b - a for a, b in zip(references["layer"], references["half space"]))
        programs["half space"]["rpc, corrected for its depth"] = {n: ((values[0] + area, values[1] + energy), seconds) for n, (values, seconds) in rpc.items()}
        print(f"hardness {hardness:g}: the layer's energy without its mean compression differs from the half space's by "
              f"{100 * ((references['layer'][1] - mean) / references['half space'][1] - 1):+.2f} %, its area by {100 * (references['layer'][0] / references['half space'][0] - 1):+.2f} %", file=sys.stderr)
    else:
        references["layer"] = references["half space"] = rpc[options.grids[-1]][0]
    if tamaas:
        programs["half space"]["tamaas"] = {n: run_tamaas(surfaces[n], hardness) for n in options.grids}
    for problem, found in programs.items():
        for program, grids in found.items():
            for n, (values, seconds) in grids.items():
                table.add(problem, hardness, program, n, values, seconds, references[problem])
            if len(options.grids) > 1 and options.grids[-1] == 2 * options.grids[-2]:
                coarse, fine = grids[options.grids[-2]], grids[options.grids[-1]]
                table.add(problem, hardness, program, "extrapolated", extrapolated(coarse[0], fine[0]), coarse[1] + fine[1], references[problem])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", type=os.path.abspath)
    parser.add_argument("--read", help="prints the tables of this file of an earlier --csv, and runs nothing")
    parser.add_argument("--grids", default="64,128", type=lambda text: [int(n) for n in text.split(",")], help="points a period, rising")
    parser.add_argument("--reference", default=512, type=int)
    parser.add_argument("--depth", default=0.25, type=float)
    parser.add_argument("--element", default="Q1", choices=("Q1", "Q2"), help="of rpc; Q2 has half as many cells")
    parser.add_argument("--flatness", default=1.0, type=float, help="width over depth of rpc's cells")
    parser.add_argument("--expansion", default=1.0, type=float, help="depth of rpc's last cells over that of the first ones, at the surface")
    parser.add_argument("--highest", default=8, type=int, help="highest wave number")
    parser.add_argument("--hardnesses", default="inf,0.3", type=lambda text: [float(x) for x in text.split(",")])
    parser.add_argument("--csv", help="file for the rows, too")
    options = parser.parse_args()
    table = Table(options.csv)
    if options.read:
        table.read(options.read)
        print(table)
        return
    if not options.rpc:
        parser.error("--rpc or --read must be given")
    for name, module in (("tamaas", tamaas), ("ContactMechanics", PeriodicFFTElasticHalfSpace)):
        if not module:
            print(f"rough_peers.py: {name} is missing and left out: pip install {name}", file=sys.stderr)
    for hardness in options.hardnesses:
        with tempfile.TemporaryDirectory(prefix="rpc_rough_peers_") as folder:
            compare(options, hardness, folder, table)
    print(table)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: BSD-3-Clause
"""Tables 1 and 2 and Figures 2, 3, 4, 6 and 7 of Namm and Tsoy (2025) with rpc; started by reproduce.sh.

Fills README.md.in to README.md and writes the pictures next to it. The paper's numbers and those of independent codes are in
reference.json.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "../picture"))
from figure import draw_plane  # noqa: E402
from result import Result  # noqa: E402
from scene import Scene  # noqa: E402

INPUT = os.path.join(HERE, "../../input")
PAPERS_TEST = {"Uzawa->Stopping Test": "multiplier change", "Contact->Penalty": "1e8"}
# The paper's gap is vertical; an obstacle's would be measured along the normal.
SURFACE_NORMAL = {"Contact->Normal": "surface", "Contact->Obstacle->Type": "none", "Contact->Gap": "8-sqrt(64-x^2)"}
YOUNG, POISSON, RADIUS = 2000.0, 0.3, 8.0  # [Pa], 1, [m] of input/hertz.xml
FINE = 128  # 1/h of the paper's Table 2 and of the figures
AMPLIFICATION = 10  # of positions in Fig. 6b


class Program:
    """Runs rpc; equal runs once."""

    def __init__(self, rpc, work, size_factor):
        self.rpc, self.work, self.size_factor, self.runs = rpc, work, size_factor, {}

    def beam(self, n, xi, **parameters):
        """The paper's first example on 5 n x n cells."""
        return self._run("beam", {"Mesh->Cells": "{%d, %d}" % (5 * n, n), "Contact->Yield Stress": xi, **parameters})

    def hertz(self, xi, **parameters):
        """The paper's second example."""
        return self._run("hertz", {"Mesh->Size Factor": self.size_factor, "Contact->Yield Stress": xi, **parameters})

    def _run(self, deck, parameters):
        """Summary (<deck>.json) of a run, with its folder under "folder"."""
        key = (deck, *sorted(parameters.items()))
        if key not in self.runs:
            folder = os.path.join(self.work, str(len(self.runs)))
            command = [self.rpc, "--input=" + os.path.join(INPUT, deck + ".xml"), "--output=" + folder]
            command += ["--set=%s=%s" % parameter for parameter in parameters.items()]
            print(*command[3:], file=sys.stderr, flush=True)
            run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if run.returncode != 0:
                sys.exit("%s\nexit code %d of: %s" % (run.stdout, run.returncode, " ".join(command)))
            with open(os.path.join(folder, deck + ".json")) as file:
                self.runs[key] = {**json.load(file), "folder": folder}
        return self.runs[key]


def contact(run):
    """Columns of <deck>.contact.csv: lists of numbers; the state as text."""
    with open(os.path.join(run["folder"], run["deck"] + ".contact.csv")) as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] if name in ("state", "side") else float(row[name]) for row in rows] for name in rows[0]}


def exodus(run):
    """Contents of <deck>.e."""
    return Result(os.path.join(run["folder"], run["deck"] + ".e"))


def table(columns, rows):
    """Markdown table, aligned to the right."""
    cells = [columns] + [[str(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells)]
    lines = ["| " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
    return "\n".join(lines)


def table_1(program, paper, meshes):
    """Energy and Uzawa iterations of the beam at xi = 2 over the meshes."""
    rows, differences, most = [], [], 0
    for n, dofs, nodes, uzawa, energy in paper["rows"]:
        if n not in meshes:
            continue
        ours, theirs = program.beam(n, "2"), program.beam(n, "2", **PAPERS_TEST)
        differences.append(ours["energy_J"] - energy)
        most = max(most, theirs["uzawa_iterations"])
        rows.append(["1/%d" % n, ours["dofs"], dofs, ours["contact_nodes"], nodes, ours["uzawa_iterations"],
                     theirs["uzawa_iterations"], uzawa, theirs["uzawa_iterations"] - uzawa, "%.7f" % ours["energy_J"],
                     "%.6f" % energy, "%.1e" % differences[-1]])
    return (table(["h [m]", "dofs", "paper", "contact nodes", "paper", "Uzawa, optimality residuals", "Uzawa, paper's test", "paper",
                   "difference", "J [J/m]", "paper", "difference"], rows)
            + "\n\nAll differences of J lie between %.1e and %.1e J/m: %s the last digit that the paper prints, 1e-6. With the "
              "paper's test the largest number of Uzawa iterations is %d."
            % (min(differences), max(differences), "below" if max(map(abs, differences)) < 1e-6 else "above", most))


def table_2(program, paper):
    """Uzawa iterations of the beam over xi."""
    rows = []
    for xi, uzawa in paper["rows"]:
        ours, theirs = program.beam(FINE, xi), program.beam(FINE, xi, **PAPERS_TEST)
        rows.append([xi, ours["uzawa_iterations"], " ".join(map(str, ours["newton_iterations"])), theirs["uzawa_iterations"],
                     uzawa, theirs["uzawa_iterations"] - uzawa, "%.7f" % ours["energy_J"]])
    return table(["ξ [Pa]", "Uzawa, optimality residuals", "Newton in each", "Uzawa, paper's test", "paper", "difference", "J [J/m]"],
                 rows)


def work_table(runs):
    """Steps, CG iterations and set-ups of some runs, by their names."""
    rows = []
    for name, run in runs.items():
        predicted = ", ".join("%d (%d)" % (level["dofs"], level["newton_iterations"]) for level in run["levels"])
        rows.append([name, run["dofs"], predicted or "none", sum(run["newton_iterations"]), run["line_search_steps"],
                     " ".join(map(str, run["linear_iterations"])), run["preconditioner_setups"]])
    return table(["example", "dofs", "predicted by dofs (steps)", "steps", "of these Newton's", "CG iterations of each", "set-ups"], rows)


def hertz_table(program, reference):
    """Integral values of the half cylinder beside an independent code's."""
    rows = []
    for normal, parameters in (("foundation", {}), ("surface", SURFACE_NORMAL)):
        for xi, force, pressure, penetration in reference[normal]:
            run = program.hertz(xi, **parameters)
            ours = run["contact_force"][1]
            rows.append([normal, xi, "%.3f" % ours, force, "%+.2f %%" % (100 * (ours / force - 1)), "%.3f" % run["max_pressure"],
                         pressure, "%+.2f %%" % (100 * (run["max_pressure"] / pressure - 1)), "%.5f" % run["max_penetration"],
                         penetration, "%+.1e" % (run["max_penetration"] - penetration)])
    columns = ["normal", "ξ [Pa]"]
    for name in ("force [N/m]", "max. pressure [Pa]", "max. penetration [m]"):
        columns += [name, "reference", "difference"]
    return table(columns, rows)


def errors(energies, exact, norm):
    """Relative energy-norm errors sqrt(2 (J_h - J) / a(u,u)) and, from the second one on, their orders, by 1/h."""
    error = {n: math.sqrt(2 * (energy - exact) / norm) for n, energy in energies.items()}
    return error, {n: math.log2(error[n // 2] / error[n]) for n in error if n // 2 in error}


def figure_2(program, reference, meshes):
    """Error over h; returns the table of the curves and the orders at their finest meshes."""
    curves = {}
    for xi, energy, norm in reference["beam"]["rows"]:
        curves["ξ = %s Pa" % xi] = errors({n: program.beam(n, xi)["energy_J"] for n in meshes}, energy, norm)
    paper = {row[0]: row[-1] for row in reference["paper"]["table_1"]["rows"]}
    finest = paper.pop(max(paper))
    name = "ξ = 2 Pa, paper's J against its 1/512"
    curves[name] = errors({n: paper[n] for n in paper if n in meshes}, finest, reference["beam"]["rows"][0][2])

    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    for (label, (error, _)), style in zip(curves.items(), ("o-", "s-", "x--")):
        axes.loglog([1 / n for n in error], list(error.values()), style, base=2, label=label, markersize=6)
    ends = [1 / meshes[0], 1 / meshes[-1]]
    axes.loglog(ends, [0.25 * h for h in ends], "k:", base=2, linewidth=1.2, label="order 1")
    axes.set(xlabel="h [m]", ylabel=r"$\sqrt{2\,(J_h - J)\,/\,a(u,u)}$")
    axes.set_xticks([1 / n for n in meshes], ["1/%d" % n for n in meshes])
    axes.legend(frameon=False)
    save(figure, "figure_2.png")

    rows = []
    for n in meshes:
        cells = ["1/%d" % n]
        for error, order in curves.values():
            cells += ["%.3f %%" % (100 * error[n]) if n in error else "", "%.2f" % order[n] if n in order else ""]
        rows.append(cells)
    text = table(["h [m]"] + [column for label in curves for column in (label, "order")], rows)
    return text, [list(order.values())[-1] for _, order in curves.values()]


def panels():
    """Figure with two axes, (a) and (b)."""
    figure, axes = plt.subplots(1, 2, figsize=(10.5, 4), layout="constrained")
    figure.get_layout_engine().set(wspace=0.06)
    for side, letter in zip(axes, "ab"):
        side.set_title("(%s)" % letter, loc="left", fontsize=11)
    return figure, axes


def side_curves(stress, displacement, runs):
    """Pressure and normal displacement along the contact side, a curve for each xi."""
    for k, (xi, run) in enumerate(runs.items()):
        data = contact(run)
        style = {"color": plt.get_cmap("plasma")(0.88 * k / (len(runs) - 1)), "label": r"$\xi$ = %s Pa" % xi}
        stress.plot(data["x"], data["pressure"], **style)
        displacement.plot(data["x"], data["u_nu"], **style)
    stress.set(xlabel="x [m]", ylabel=r"$-\sigma_\nu$ [Pa]", ylim=(0, None))
    displacement.set(xlabel="x [m]", ylabel=r"$u_\nu$ [m], into the foundation")
    displacement.invert_yaxis()


def figure_3(program, xis):
    """The beam's contact side; returns from which x on the foundation has given way, by xi."""
    runs = {xi: program.beam(FINE, xi) for xi in xis}
    figure, (displacement, stress) = panels()
    side_curves(stress, displacement, runs)
    stress.legend(frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    save(figure, "figure_3.png")
    sides = {xi: contact(run) for xi, run in runs.items()}
    return {xi: side["x"][side["state"].index("yielding")] for xi, side in sides.items() if "yielding" in side["state"]}


def figure_4(program, xi, factor):
    """The deformed beam; returns the largest nodal von Mises stress and its place."""
    run = program.beam(FINE, xi)
    figure, axes = plt.subplots(figsize=(9, 3.1), layout="constrained")
    result = exodus(run)
    picture = draw_plane(axes, Scene(result, "von_mises", factor), 1400)
    figure.colorbar(picture, ax=axes, label="von Mises stress [Pa]", shrink=0.8, aspect=12)
    axes.set_title(r"$\xi$ = %s Pa, displacements %g-fold" % (xi, factor), fontsize=11)
    save(figure, "figure_4.png")
    stress = result.nodal["von_mises"]
    return stress.max(), *result.positions[stress.argmax(), :2]


def figure_6(program, xi):
    """The half cylinder; returns the half width over which the foundation has given way and the number of closed nodes."""
    run = program.hertz(xi)
    data = contact(run)
    figure, (left, right) = panels()
    picture = draw_plane(left, Scene(exodus(run), "von_mises", 1))
    figure.colorbar(picture, ax=left, label="von Mises stress [Pa]", shrink=0.75)
    left.set_title(r"$\xi$ = %s Pa, displacements as they are" % xi, fontsize=11)
    position = [AMPLIFICATION * (gap - u_nu) for gap, u_nu in zip(data["gap"], data["u_nu"])]
    right.axhline(0, color="0.6", linewidth=1)
    right.plot(data["x"], position, label=r"normal position $g - u_\nu$ [m], %d-fold" % AMPLIFICATION)
    right.plot(data["x"], data["pressure"], label=r"normal stress $-\sigma_\nu$ [Pa]")
    right.set(xlabel="x [m]", xlim=(-2, 2), ylim=(-1.3, 3.1))
    right.legend(frameon=False, loc="upper center")
    save(figure, "figure_6.png")
    return max(x for x, state in zip(data["x"], data["state"]) if state == "yielding"), data["state"].count("closed")


def figure_7(program, xis):
    """The half cylinder's contact side with Hertz's pressure; returns force, half width and pressure of Hertz's formula."""
    runs = {xi: program.hertz(xi) for xi in xis}
    force = program.hertz("inf")["contact_force"][1]
    modulus = YOUNG / (1 - POISSON**2)
    a, p0 = math.sqrt(4 * force * RADIUS / (math.pi * modulus)), math.sqrt(force * modulus / (math.pi * RADIUS))
    figure, (left, right) = panels()
    side_curves(left, right, runs)
    points = [a * k / 400 for k in range(-400, 401)]
    left.plot(points, [p0 * math.sqrt(1 - (x / a) ** 2) for x in points], "k--", linewidth=1.3, label="Hertz")
    left.set(xlim=(-1.5, 1.5))
    right.plot(contact(runs[xis[0]])["x"], contact(runs[xis[0]])["gap"], "k:", linewidth=1.3, label="gap $g$")
    right.set(xlim=(-1.5, 1.5), ylim=(0.13, -0.03))
    handles, labels = left.get_legend_handles_labels()
    gap_handle, gap_label = (item[-1] for item in right.get_legend_handles_labels())
    right.legend([*handles, gap_handle], [*labels, gap_label], frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    save(figure, "figure_7.png")
    return force, a, p0


def save(figure, name):
    """Writes a picture next to this file."""
    figure.savefig(os.path.join(HERE, name), dpi=120)
    plt.close(figure)


def main():
    """Runs, draws and writes everything."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True, help="program")
    parser.add_argument("--work", required=True, help="folder for the results of the runs")
    parser.add_argument("--long", action="store_true", help="finer meshes as well")
    options = parser.parse_args()
    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                         "grid.alpha": 0.3, "lines.linewidth": 1.7})
    with open(os.path.join(HERE, "reference.json")) as file:
        reference = json.load(file)
    paper = reference["paper"]
    meshes = [8, 16, 32, 64, 128] + [256, 512] * options.long
    program = Program(options.rpc, options.work, 0.6 if options.long else 1)

    hertz = paper["hertz"]
    example_2 = program.hertz(hertz["xi"], **PAPERS_TEST)
    stiff, rigid = program.hertz("100"), program.beam(FINE, "20")
    yielded = figure_3(program, [row[0] for row in paper["table_2"]["rows"]])
    force, a, p0 = figure_7(program, ["2", "5", "10", "20", "50", "100"])
    stress, *place = figure_4(program, "16", 5)
    half, closed = figure_6(program, hertz["xi"])
    error_table, orders = figure_2(program, reference, meshes)
    compared = reference["beam"]["yielded_from_x"]
    with open(os.path.join(HERE, "README.md.in")) as file:
        page = file.read()
    text = page.format(
        command="bash doc/paper/reproduce.sh" + " --long" * options.long, version=rigid["rpc_version"],
        origin=reference["origin"], fine=FINE, table_1=table_1(program, paper["table_1"], meshes),
        table_2=table_2(program, paper["table_2"]),
        work=work_table({**{"beam, 1/h = %d, ξ = %s" % (FINE, xi): program.beam(FINE, xi) for xi in ("2", "16")},
                         **{"half cylinder, ξ = %s" % xi: program.hertz(xi) for xi in ("2", "20", "100")}}),
        figure_2=error_table, orders=orders,
        whole=", ".join(xi for xi, x in yielded.items() if x == 0),
        yielded=", ".join("%.2f m at ξ = %s Pa" % (x, xi) for xi, x in yielded.items() if xi in compared),
        yielded_reference=", ".join("%.2f m at ξ = %s Pa" % (x, xi) for xi, x in compared.items()),
        rigid=rigid,
        mises=stress, place="(%g, %g)" % tuple(place), half=half, closed=closed, cells=example_2["cells"],
        nodes=example_2["contact_nodes"], paper_cells=hertz["elements"], paper_nodes=hertz["contact_nodes"],
        uzawa=example_2["uzawa_iterations"], newton=" and ".join(map(str, example_2["newton_iterations"])),
        paper_uzawa=hertz["uzawa_iterations"], paper_newton=hertz["newton_iterations_each"], top=stiff["max_pressure"],
        deep=stiff["max_penetration"], force=force, a=a, p0=p0, above=100 * (program.hertz("inf")["max_pressure"] / p0 - 1),
        hertz_table=hertz_table(program, reference["hertz"]))
    with open(os.path.join(HERE, "README.md"), "w") as file:
        file.write(text)


if __name__ == "__main__":
    main()

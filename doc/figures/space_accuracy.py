# SPDX-License-Identifier: BSD-3-Clause
"""Error against time of uniform, graded and adaptive meshes in space and of revolution.

    python3 space_accuracy.py space_accuracy.png build/rpc

Whole runs on one rank, the error in the energy norm from the energies: sqrt(2 |J_h - J| / a(u_h, u_h)). J of the ball is that of its section on meshes
adapted to 2e-4.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

INPUT = pathlib.Path(__file__).resolve().parents[2] / "input"
BLOCK_ENERGY = -1.03963959  # J [J], extrapolated from nested meshes adapted to 1 % and 0.5 % by the squares of their estimates


def run(rpc, deck, folder, *settings):
    """The summary of a run."""
    subprocess.run([rpc, f"--input={INPUT / deck}.xml", f"--output={folder}", *(f"--set={s}" for s in settings), "--set=Output->Exodus=false",
                    "--set=Output->CSV=false"], check=True, stdout=subprocess.DEVNULL)
    return json.loads((pathlib.Path(folder) / f"{deck}.json").read_text())


def targets(*values, meshes="automatic"):
    return [[f"Adapt->Target Relative Error={value}", f"Adapt->Meshes={meshes}"] for value in values]


def curve(rpc, deck, folder, all_settings, energy, parts=1):
    """(seconds, errors, dofs) of runs; parts: of the body that `energy` is of, over that of the deck."""
    seconds, errors, dofs = [], [], []
    for settings in all_settings:
        s = run(rpc, deck, folder, *settings)
        seconds.append(s["seconds"]["total"])
        errors.append(math.sqrt(2 * abs(parts * s["energy_J"] - energy) / (parts * s["energy_norm_squared"])))
        dofs.append(s["dofs"])
        print(deck, *settings, "%.2f s, error %.2e, %d dofs" % (seconds[-1], errors[-1], dofs[-1]), flush=True)
    return seconds, errors, dofs


def size_factors(*values):
    return [[f"Mesh->Size Factor={value}"] for value in values]


def main(picture, rpc):
    plt.rcParams.update({"font.size": 9})
    figure, (ball, block) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
    with tempfile.TemporaryDirectory() as folder:
        exact = run(rpc, "ball_axisymmetric_adaptive", folder, *targets(0.0002)[0])["energy_J"]
        off = ["Adapt->Target Relative Error=0"]
        for label, deck, settings, parts, style in [
                ("uniform", "ball_adaptive", [off + s for s in size_factors(1, 0.5, 0.33, 0.25, 0.18)], 4, "s-"),
                ("graded by hand (ball.xml)", "ball", size_factors(8, 4, 2, 1.4, 1), 4, "^-"),
                ("adaptive, by gmsh", "ball_adaptive", targets(0.1, 0.05, 0.02, 0.01, 0.006), 4, "o-"),
                ("adaptive, nested", "ball_adaptive", targets(0.1, 0.05, 0.02, 0.01, 0.006, meshes="nested"), 4, "D-"),
                ("adaptive, axisymmetric", "ball_axisymmetric_adaptive", targets(0.1, 0.03, 0.01, 0.003, 0.001), 1, "o--")]:
            seconds, errors, _ = curve(rpc, deck, folder, settings, exact, parts)
            ball.loglog(seconds, errors, style, label=label, markersize=4)
        ball.set_title("ball, d = 0.02, $\\xi = \\infty$")
        exact = BLOCK_ENERGY
        cells = [[f"Mesh->Cells={{{2 * n},{2 * n},{n}}}"] for n in (3, 6, 12, 18, 24)]
        for label, deck, settings, style in [("uniform, Q2", "block", cells, "s-"), ("adaptive by gmsh, P2", "block_adaptive", targets(0.1, 0.06, 0.04, 0.03, 0.02, meshes="gmsh"), "o-"),
                                             ("adaptive, nested, P2", "block_adaptive", targets(0.1, 0.06, 0.04, 0.03, 0.02, meshes="nested"), "D-")]:
            seconds, errors, _ = curve(rpc, deck, folder, settings, exact)
            block.loglog(seconds, errors, style, label=label, markersize=4)
        block.set_title("block with three states, a clamped side")
    for axes in (ball, block):
        axes.set(xlabel="time of the whole run [s]")
        axes.grid(True, which="both", alpha=0.3)
        axes.legend()
    ball.set_ylabel("relative error in the energy norm")
    figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:])

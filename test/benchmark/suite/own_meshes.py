# SPDX-License-Identifier: BSD-3-Clause
"""The body of input/block.xml as a .msh of another program, hexahedra or tetrahedra, inner nodes moved or not; and DOLFINx on it."""
import os
import statistics
import xml.etree.ElementTree as ElementTree

import numpy as np

from .peers import ENERGY_TOLERANCE
from .program import Failure
from .table import Table, skipped

MODULES = ("dolfinx", "petsc4py", "skfem")
SOLVERS = ("hypre", "gamg")
LEAST_RATIO = 5.0  # of processor time, the better peer's over rpc's
LOWER, UPPER = np.array([-1.0, -1, 0]), np.array([1.0, 1, 1])
SIDES = ("left", "right", "bottom", "top", "back", "front")  # across x, y, z
KINDS = ("hexahedra", "moved-hexahedra", "tetrahedra", "moved-tetrahedra")
AROUND = [(0, 0), (1, 0), (1, 1), (0, 1)]
PATHS = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]  # of tetrahedra along edges of a cell; the last three mirrored
GMSH_TYPES = {"hexahedra": (5, 3), "tetrahedra": (4, 2)}  # of cells, of facets


def corner_numbers(number, corner):
    """Of all cells the node at a corner, (0 or 1) along each axis."""
    return number[tuple(slice(c, n - 1 + c) for c, n in zip(corner, number.shape))].ravel()


def tetrahedra_at(number):
    cells = []
    for k, path in enumerate(PATHS):
        corner, nodes = [0, 0, 0], [corner_numbers(number, (0, 0, 0))]
        for axis in path:
            corner[axis] = 1
            nodes.append(corner_numbers(number, corner))
        if k >= 3:
            nodes[1], nodes[2] = nodes[2], nodes[1]
        cells.append(np.stack(nodes, axis=1))
    return np.stack(cells, axis=1).reshape(-1, 4)


def facets_at(number, axis, last, tetrahedra):
    """Of one side, seen from outside."""
    face = np.take(number, -1 if last else 0, axis=axis)
    if last == (axis == 1):  # the axes that remain, in their order, turn left around y's negative direction
        face = face.T
    quadrilaterals = np.stack([corner_numbers(face, at) for at in AROUND], axis=1)
    if not tetrahedra:
        return quadrilaterals
    return quadrilaterals[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)  # all diagonals go from the lowest corner to the highest


def mesh_of(kind, cells, seed=1):
    """Coordinates, cells and facets by side, numbered from 0."""
    tetrahedra = kind.endswith("tetrahedra")
    counts = np.array(cells) + 1
    number = np.arange(np.prod(counts)).reshape(counts)
    x = np.stack(np.meshgrid(*(np.linspace(a, b, n) for a, b, n in zip(LOWER, UPPER, counts)), indexing="ij"), axis=-1)
    if kind.startswith("moved"):
        inner = x[1:-1, 1:-1, 1:-1]
        inner += np.random.default_rng(seed).uniform(-0.15, 0.15, inner.shape) * (UPPER - LOWER) / np.array(cells)
    whole = tetrahedra_at(number) if tetrahedra else np.stack(
        [corner_numbers(number, (*at, high)) for high in (0, 1) for at in AROUND], axis=1)
    sides = {name: facets_at(number, s // 2, s % 2 == 1, tetrahedra) for s, name in enumerate(SIDES)}
    return x.reshape(-1, 3), whole, sides


def write_msh(path, kind, cells):
    """gmsh's format 2.2."""
    x, whole, sides = mesh_of(kind, cells)
    of_cells, of_facets = GMSH_TYPES[kind.split("-")[-1]]
    groups = [(s + 1, 2, name, of_facets, sides[name]) for s, name in enumerate(SIDES)] + [(7, 3, "body", of_cells, whole)]
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(groups))
        for tag, dim, name, _, _ in groups:
            file.write('%d %d "%s"\n' % (dim, tag, name))
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(x))
        np.savetxt(file, np.column_stack([np.arange(1, len(x) + 1), x]), fmt="%d %.17g %.17g %.17g")
        file.write("$EndNodes\n$Elements\n%d\n" % sum(len(nodes) for *_, nodes in groups))
        first = 1
        for tag, _, _, element, nodes in groups:
            head = np.broadcast_to([element, 2, tag, tag], (len(nodes), 4))
            np.savetxt(file, np.column_stack([np.arange(first, first + len(nodes)), head, nodes + 1]), fmt="%d")
            first += len(nodes)
        file.write("$EndElements\n")


def deck_on(bench, msh):
    """input/block.xml with that mesh; its path."""
    tree = ElementTree.parse(os.path.join(bench.program.input_folder, "block.xml"))
    mesh = tree.getroot().find("ParameterList[@name='Mesh']")
    for parameter in list(mesh):
        mesh.remove(parameter)
    for name, value in (("Type", "gmsh"), ("File", msh)):
        ElementTree.SubElement(mesh, "Parameter", name=name, type="string", value=value)
    path = msh.replace(".msh", ".xml")
    tree.write(path)
    return path


def own_mesh(bench):
    cells, repeats, judged = bench.sizes["own mesh"]
    title = "Peers on a mesh of one's own: DOLFINx"
    reason = bench.python.lacks(MODULES)
    if reason:
        return skipped(title, reason + "; on Debian apt-get install python3-dolfinx-real")
    table = Table(title,
                  "The block of input/block.xml of order 1 as a .msh (suite/own_meshes.py), read by both; inner nodes moved by up to 15 %% of a "
                  "cell. DOLFINx: an active-set iteration, CG with algebraic multigrid (peers/dolfinx_petsc.py). Processor time of whole "
                  "processes in turns, one thread; medians of %d. J within %g, relative. %s"
                  % (repeats, ENERGY_TOLERANCE,
                     "Criterion: the faster of the two takes at least %g x rpc's time." % LEAST_RATIO if judged
                     else "No criterion: the meshes are too small."),
                  ["mesh", "solver", "dofs", "steps, CG", "rpc", "time [s]", "rpc [s]", "GiB", "rpc [GiB]", "over rpc", ""])
    for kind in KINDS:
        msh, small = (os.path.join(bench.output, name + kind + ".msh") for name in ("", "small-"))
        write_msh(msh, kind, cells)
        write_msh(small, kind, (4, 3, 3))
        deck, ratios = deck_on(bench, msh), []
        for solver in SOLVERS:
            command = ("dolfinx_petsc.py", "{scene}", "{xi}", solver)
            try:
                bench.python.run(command, small, 0, 18, 1)  # DOLFINx compiles its forms once
                runs = [(bench.python.run(command, msh, 0, 18, 1, fresh=True), bench.program.run(deck, fresh=True))
                        for _ in range(repeats)]
            except Failure as failure:
                table.add(kind, solver, *[""] * 8, str(failure).strip().splitlines()[-1])
                table.check(False)
                continue
            theirs, ours = runs[-1]
            ratios.append(statistics.median(peer["cpu"] / rpc["cpu"] for peer, rpc in runs))
            good = abs(theirs["J"] / ours["energy_J"] - 1) <= ENERGY_TOLERANCE
            if judged and solver == SOLVERS[-1]:
                good = good and min(ratios) >= LEAST_RATIO
            table.add(kind.replace("-", " "), solver, ours["dofs"], "%d, %d" % (theirs["newton"][0], sum(theirs["linear_iterations"])),
                      "%d, %d" % (sum(ours["newton_iterations"]), sum(ours["linear_iterations"])),
                      "%.2f" % statistics.median(peer["cpu"] for peer, _ in runs),
                      "%.2f" % statistics.median(rpc["cpu"] for _, rpc in runs), "%.2f" % theirs["gib"], "%.2f" % ours["gib"],
                      "%.1f" % ratios[-1], table.check(good))
    return table

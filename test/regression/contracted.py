# SPDX-License-Identifier: BSD-3-Clause
"""A .msh of a box's tetrahedra, in any order, is solved as the box is: by multigrid on coarser meshes, from a prediction, in about as many steps."""

import itertools
import json
import random
import unittest

import structured
from rpc_run import RANKS, RpcTestCase

EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)]  # of a tetrahedron, as gmsh has their middle nodes
PATHS = {(0, 1, 2), (1, 2, 0), (2, 0, 1)}  # of a cube's edges along which a tetrahedron is not mirrored


def msh_of_box(cells, order, moved):
    """The box's six tetrahedra in each cell, nodes and cells in no order. @param moved  inner vertices, by so many cells at most"""
    choose = random.Random(5)
    vertex = lambda at: tuple(order * k for k in at)
    place = list(itertools.product(*(range(order * n + 1) for n in cells)))
    number = dict(zip(place, choose.sample(range(1, len(place) + 1), len(place))))
    x = {}
    for at in itertools.product(*(range(n + 1) for n in cells)):
        inside = all(0 < k < n for k, n in zip(at, cells))
        x[vertex(at)] = [length / n * (k + (moved * choose.uniform(-1, 1) if inside else 0))
                         for k, n, length in zip(at, cells, structured.LENGTHS)]
    elements = []

    def add(kind, tag, vertices, edges):
        nodes = [vertex(at) for at in vertices]
        for a, b in edges if order == 2 else []:
            nodes.append(tuple((p + q) // 2 for p, q in zip(nodes[a], nodes[b])))
            x[nodes[-1]] = [(p + q) / 2 for p, q in zip(x[nodes[a]], x[nodes[b]])]
        elements.append(f"{kind} 2 {tag} {tag} {' '.join(str(number[at]) for at in nodes)}")

    def along(at, directions):
        path = [at]
        for direction in directions:
            path.append(tuple(k + (d == direction) for d, k in enumerate(path[-1])))
        return path

    for at in itertools.product(*map(range, cells)):
        for directions in itertools.permutations(range(3)):
            a, b, c, d = along(at, directions)
            add(11 if order == 2 else 4, 7, (a, b, c, d) if directions in PATHS else (a, b, d, c), EDGES)
    for tag, (direction, upper) in enumerate(structured.SIDES.values(), 1):
        others = [d for d in range(3) if d != direction]
        for at in itertools.product(*(range(1) if d == direction else range(cells[d]) for d in range(3))):
            at = tuple(cells[direction] * upper if d == direction else k for d, k in enumerate(at))
            for directions in (others, others[::-1]):
                add(9 if order == 2 else 2, tag, along(at, directions), [(0, 1), (1, 2), (2, 0)])
    choose.shuffle(elements)
    names = [f'2 {tag} "{name}"' for tag, name in enumerate(structured.SIDES, 1)] + ['3 7 "body"']
    nodes = [f"{number[at]} {a!r} {b!r} {c!r}" for at, (a, b, c) in x.items()]
    sections = {"PhysicalNames": names, "Nodes": nodes, "Elements": [f"{k} {element}" for k, element in enumerate(elements, 1)]}
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join(
        "\n".join([f"${name}", str(len(rows)), *rows, f"$End{name}", ""]) for name, rows in sections.items())


class Contracted(RpcTestCase):
    def summary(self, name, mesh):
        (self.folder / f"{name}.yaml").write_text(structured.DECK.format(name=name, mesh=mesh))
        self.rpc(f"--input={name}.yaml", "--output=out")
        return json.loads((self.folder / "out" / f"{name}.json").read_text())

    def check(self, cells, order):
        box = self.summary("box", f"{{Type: box, Lower: [0.0, 0.0, 0.0], Upper: {list(structured.LENGTHS)}, Cells: {list(cells)}, Element: P{order}}}")
        for moved in (0, 0.15):
            (self.folder / "body.msh").write_text(msh_of_box(cells, order, moved))
            found = self.summary("msh", "{Type: gmsh, File: body.msh}")
            self.assertEqual(found["solver_path"], "meshes", RANKS)
            self.assertGreater(len(found["levels"]), 0)  # it was predicted
            self.assertAlmostEqual(found["energy_J"] / box["energy_J"], 1, delta=1e-2 if moved else 1e-10)
            self.assertLessEqual(sum(found["newton_iterations"]), 2 * sum(box["newton_iterations"]))
            self.assertLessEqual(sum(found["linear_iterations"]), 2 * sum(box["linear_iterations"]))

    def test_tetrahedra_of_order_one_take_the_box_s_steps(self):
        self.check((16, 11, 8), 1)

    def test_tetrahedra_of_order_two_take_the_box_s_steps(self):
        self.check((8, 6, 4), 2)


if __name__ == "__main__":
    unittest.main()

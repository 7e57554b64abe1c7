# SPDX-License-Identifier: BSD-3-Clause
"""A .msh of a box's hexahedra, in any order, is solved as the box is: by multigrid on coarser meshes, from a prediction, in about as many steps."""

import itertools
import json
import random
import unittest

from rpc_run import RANKS, RpcTestCase

CELLS, LENGTHS = (16, 11, 8), (2.0, 1.4, 1.0)
SIDES = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1), "back": (2, 0), "front": (2, 1)}
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]  # of a hexahedron, as gmsh has them
FACE = [(0, 0), (1, 0), (1, 1), (0, 1)]
BOX = f"{{Type: box, Lower: [0.0, 0.0, 0.0], Upper: {list(LENGTHS)}, Cells: {list(CELLS)}, Element: Q1}}"
DECK = """{name}:
  Mesh: {mesh}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {{left: {{X: 0.0, Y: 0.0, Z: 0.0}}}}
  Traction: {{front: {{Z: -20.0}}}}
  Contact: {{Side: back, Yield Stress: "18 + 9*x", Gap: "0.01*((x - 1)^2 + y^2)"}}
"""


def msh_of_box(moved):
    """Nodes and cells in no order. @param moved  inner nodes, by so many cells at most"""
    choose = random.Random(5)
    place = list(itertools.product(*(range(n + 1) for n in CELLS)))
    number = dict(zip(place, choose.sample(range(1, len(place) + 1), len(place))))
    nodes = []
    for at in place:
        inside = all(0 < k < n for k, n in zip(at, CELLS))
        x = [length / n * (k + (moved * choose.uniform(-1, 1) if inside else 0)) for k, n, length in zip(at, CELLS, LENGTHS)]
        nodes.append(f"{number[at]} {x[0]!r} {x[1]!r} {x[2]!r}")
    elements = [f"5 2 7 7 {' '.join(str(number[tuple(k + c for k, c in zip(at, corner))]) for corner in CORNERS)}"
                for at in itertools.product(*map(range, CELLS))]
    for tag, (direction, upper) in enumerate(SIDES.values(), 1):
        others = [d for d in range(3) if d != direction]
        for cell in itertools.product(*(range(CELLS[d]) for d in others)):
            corners = []
            for corner in FACE:
                at = [CELLS[direction] * upper] * 3
                for d, k, c in zip(others, cell, corner):
                    at[d] = k + c
                corners.append(str(number[tuple(at)]))
            elements.append(f"3 2 {tag} {tag} {' '.join(corners)}")
    choose.shuffle(elements)
    choose.shuffle(nodes)
    names = [f'2 {tag} "{name}"' for tag, name in enumerate(SIDES, 1)] + ['3 7 "body"']
    sections = {"PhysicalNames": names, "Nodes": nodes, "Elements": [f"{k} {element}" for k, element in enumerate(elements, 1)]}
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join(
        "\n".join([f"${name}", str(len(rows)), *rows, f"$End{name}", ""]) for name, rows in sections.items())


class Structured(RpcTestCase):
    def summary(self, name, mesh):
        (self.folder / f"{name}.yaml").write_text(DECK.format(name=name, mesh=mesh))
        self.rpc(f"--input={name}.yaml", "--output=out")
        return json.loads((self.folder / "out" / f"{name}.json").read_text())

    def msh(self, name, moved):
        (self.folder / f"{name}.msh").write_text(msh_of_box(moved))
        return self.summary(name, f"{{Type: gmsh, File: {name}.msh}}")

    def test_a_file_of_a_box_takes_its_steps(self):
        box, msh, moved = self.summary("box", BOX), self.msh("msh", 0), self.msh("moved", 0.15)
        self.assertAlmostEqual(msh["energy_J"] / box["energy_J"], 1, delta=1e-10)
        self.assertAlmostEqual(msh["max_displacement"] / box["max_displacement"], 1, delta=1e-8)
        self.assertAlmostEqual(msh["contact_area"], box["contact_area"], delta=1e-10)
        self.assertAlmostEqual(moved["energy_J"] / box["energy_J"], 1, delta=1e-2)
        for found in (msh, moved):
            self.assertEqual(found["solver_path"], "meshes", RANKS)
            self.assertGreater(len(found["levels"]), 0)  # it was predicted
            self.assertLessEqual(sum(found["newton_iterations"]), 2 * sum(box["newton_iterations"]))
            self.assertLessEqual(sum(found["linear_iterations"]), 2 * sum(box["linear_iterations"]))


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of files whose groups have names, numbers or nothing."""

import json
import unittest

from rpc_run import RpcTestCase


class Meshes(RpcTestCase):
    """A cube of one cell, pressed: its .msh names groups, numbers them, or has none."""

    FACES = {"bottom": "1 4 3 2", "top": "5 6 7 8", "left": "1 5 8 4", "back": "1 2 6 5"}

    def solve_cube(self, names, groups):
        """@param names  of the groups 1 to 5, the body last; @param groups  whether cells are in groups"""
        lines = [f'{2 + (k == 5)} {k} "{name}"' for k, name in enumerate(names, 1)]
        nodes = [f"{n} {x} {y} {z}" for n, (x, y, z) in enumerate([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1),
                                                                   (0, 1, 1)], 1)]
        elements = [f"{k} 3 2 {k} 0 {face}" for k, face in enumerate(self.FACES.values(), 1)]
        elements.append(f"5 5 2 {5 if groups else 0} 0 1 2 3 4 5 6 7 8")
        sections = {"PhysicalNames": lines, "Nodes": nodes, "Elements": elements}
        (self.folder / "cube.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join(
            "\n".join([f"${name}", str(len(rows)), *rows, f"$End{name}", ""]) for name, rows in sections.items()))
        side = dict(zip(self.FACES, names)) if names else {name: str(k) for k, name in enumerate(self.FACES, 1)}
        (self.folder / "cube.yaml").write_text(f"""cube:
  Mesh: {{Type: gmsh, File: cube.msh}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    press: {{Side: "{side['top']}", Z: -0.01}}
    left: {{Side: "{side['left']}", X: 0.0}}
    back: {{Side: "{side['back']}", Y: 0.0}}
  Contact: {{Side: "{side['bottom']}"}}
""")
        self.rpc("--check", "--input=cube.yaml")
        self.rpc("--input=cube.yaml", "--output=out")
        summary = json.loads((self.folder / "out" / "cube.json").read_text())
        self.assertAlmostEqual(summary["contact_force"][2], 10, delta=1e-8)

    def test_volumes_need_no_names_and_no_groups(self):
        for names, groups in (([*self.FACES, "body"], True), ([*self.FACES], True), ([], True), ([], False)):
            with self.subTest(names=names, groups=groups):
                self.solve_cube(names, groups)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Newton steps on thin bodies, where bending turns choices of states by pressures over: bounded scene by scene. Iterations of linear solves
on nearly incompressible bodies of stretched cells, with and without friction. Beside them a well-shaped body."""

import json
import re
import unittest

from rpc_run import SOURCE, RpcTestCase

DECK = """<ParameterList name="thin">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="box"/>
    <Parameter name="Lower" type="Array(double)" value="{%(lower)s}"/>
    <Parameter name="Upper" type="Array(double)" value="{%(upper)s}"/>
    <Parameter name="Cells" type="Array(int)" value="{%(cells)s}"/>
    <Parameter name="Element" type="string" value="%(element)s"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1000"/>
    <Parameter name="Poisson's Ratio" type="double" value="%(nu)s"/>
  </ParameterList>
  <ParameterList name="Dirichlet">%(held)s</ParameterList>
  <ParameterList name="Traction">
    <ParameterList name="top"><Parameter name="Y" type="string" value="%(load)s"/></ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Yield Stress" type="string" value="%(yield)s"/>
    <Parameter name="Gap" type="string" value="%(gap)s"/>
    <Parameter name="Friction Coefficient" type="string" value="%(friction)s"/>
  </ParameterList>
  <ParameterList name="Output"><Parameter name="Exodus" type="bool" value="false"/></ParameterList>
</ParameterList>
"""
ROUGH = "{0} + {1}*(43758.5453*sin(11*x + 78.233*z) - rint(43758.5453*sin(11*x + 78.233*z)))"


def deck(upper, cells, element, load, gap, xi="inf", sides=("left",), nu=0.3, friction=0):
    axes = "XYZ"[:len(cells)]
    zeros = "".join(f'<Parameter name="{axis}" type="double" value="0"/>' for axis in axes)
    held = "".join(f'<ParameterList name="{side}">{zeros}</ParameterList>' for side in sides)
    text = lambda values: ", ".join(map(str, values))
    return DECK % {"lower": text([0.0] * len(cells)), "upper": text(upper), "cells": text(cells), "element": element, "held": held,
                   "load": -load, "gap": gap.replace("<", "&lt;"), "yield": xi, "nu": nu, "friction": friction}


BOTH, ALL = ("left", "right"), ("left", "right", "front", "back")
SCENES = {  # deck, most steps
    "strip over a flat foundation": (deck((1, 0.01), (160, 1), "P1", 1e-3, "2e-3", "0.02"), 12),
    "strip over waves": (deck((1, 0.02), (50, 1), "Q2", 1e-3, "2e-3*(0.5 + 0.5*sin(15*x))"), 11),
    "strip over a rough foundation": (deck((1, 0.02), (60, 1), "P2", 1e-3, ROUGH.format("2e-3", "1e-3").replace(" + 78.233*z", ""), "0.01", BOTH), 6),
    "strip of which rough solves take a point to and fro": (deck((1, 0.002660804), (449, 4), "Q2", 1.7246739020181432e-7, "0.12146827586714429*(x - 0.6202524474006608)^2 + 0.0017698480931658397", "2.9848978085874425e-7", nu=0.012139926853788507), 6),
    "beam in space": (deck((1, 0.02, 0.02), (100, 2, 1), "Q1", 1e-2, "1e-2"), 7),
    "beam in space over a bump": (deck((1, 0.02, 0.02), (60, 1, 1), "Q2", 1e-2, "5e-3*(1 - exp(-(x - 0.6)^2/0.02))", "inf", BOTH), 5),
    "plate over a bump": (deck((1, 0.02, 1), (16, 1, 16), "Q1", 1e-2, "2e-3*(1 - exp(-((x - 0.6)^2 + (z - 0.4)^2)/0.05))", "0.2", BOTH), 16),
    "plate over a rough foundation": (deck((1, 0.05, 1), (16, 2, 16), "Q1", 1e-1, ROUGH.format("2e-3", "2e-3"), "0.5"), 9),
    "plate held all around": (deck((1, 0.02, 1), (8, 1, 8), "P2", 1e-2, "5e-4*((x - 0.4)^2 + (z - 0.5)^2)", "inf", ALL), 18),
    "strip whose predicting mesh is too large to choose states": (deck((1, 0.132), (70907, 1), "Q1", 1.16, ROUGH.format("0.285*(x - 0.323)^2 + 2.64e-4", "1.37e-3").replace(" + 78.233*z", ""), "inf", BOTH, nu=0.055), 8),
}


class ThinBodies(RpcTestCase):
    def test_steps(self):
        for name, (text, most) in SCENES.items():
            with self.subTest(name):
                (self.folder / "thin.xml").write_text(text)
                self.rpc("--input=thin.xml")
                summary = json.loads((self.folder / "thin.json").read_text())
                self.assertTrue(summary["converged"])
                steps = sum(summary["newton_iterations"])
                self.assertGreaterEqual(steps, 4)
                self.assertLessEqual(steps, most)


class WellShaped(RpcTestCase):
    def test_no_coarser_mesh_chooses_the_states_of_a_last_few_points(self):
        self.rpc(f"--input={SOURCE / 'input' / 'block.xml'}", "--set=Mesh->Element=P1", "--set=Mesh->Cells={24, 24, 12}",
                 "--set=Material->Poisson's Ratio=0.49", "--set=Output->Exodus=none")
        summary = json.loads((self.folder / "block.json").read_text())
        self.assertTrue(summary["converged"])
        self.assertGreater(sum(summary["newton_iterations"]), 4) # else the rule would not be asked
        self.assertEqual(summary["coarse_choices"], 0)


class Rubber(RpcTestCase):
    def test_no_solve_waits_for_iterations_that_stall(self):
        mixed, factor = "^mixed$", "^sparse factor: about [0-9]+ CG iterations expected$"
        by_nu = {0.499: mixed, 0.4999: factor, 0.49999: factor}  # of Q1 in the plane
        bodies = {  # upper, cells, element, path, or paths by nu
            "in the plane": ((2, 1), (32, 32), "Q2", mixed), "in the plane, stretched by 12": ((2, 1), (16, 96), "Q2", mixed),
            "in space, stretched by 4": ((1, 1, 1), (4, 4, 16), "Q2", mixed), "in space, stretched by 6": ((1, 1, 1), (4, 4, 24), "Q2", mixed),
            "of triangles": ((2, 1), (32, 32), "P2", mixed), "of tetrahedra": ((1, 1, 1), (6, 6, 6), "P2", mixed),
            "of Q1": ((2, 1), (48, 96), "Q1", by_nu), "of Q1, in space": ((1, 1, 1), (10, 9, 8), "Q1", mixed)}
        for name, (upper, cells, element, path) in bodies.items():
            for nu in (0.499, 0.4999, 0.49999):
                for friction in (0, 0.3) if nu == 0.4999 else (0,) if nu == 0.499 else (0.3,):
                    with self.subTest(f"{name}, nu {nu}, friction {friction}"):
                        (self.folder / "thin.xml").write_text(deck(upper, cells, element, 1, "1e-3*x", 20, nu=nu, friction=friction))
                        self.rpc("--input=thin.xml")
                        summary = json.loads((self.folder / "thin.json").read_text())
                        self.assertTrue(summary["converged"])
                        self.assertLessEqual(max(summary["linear_iterations"]), 44 if "by 12" in name else 30)
                        self.assertRegex(summary["solver_path"], path[nu] if path is by_nu else path)

    def test_what_nothing_touches_takes_the_mixed_form(self):
        """The same block without its Contact list."""
        text = deck((2, 1), (32, 32), "Q2", 1, "1e-3*x", 20, nu=0.4999)
        without = re.sub(r'<ParameterList name="Contact">.*?</ParameterList>', "", text, flags=re.S)
        self.assertNotEqual(text, without)
        (self.folder / "thin.xml").write_text(without)
        self.rpc("--input=thin.xml")
        summary = json.loads((self.folder / "thin.json").read_text())
        self.assertEqual(summary["solver_path"], "mixed")
        self.assertLessEqual(max(summary["linear_iterations"]), 30)

    def test_what_is_not_incompressible_keeps_its_multigrid(self):
        (self.folder / "thin.xml").write_text(deck((2, 1), (32, 32), "Q2", 1, "1e-3*x", 20))
        self.rpc("--input=thin.xml")
        self.assertEqual(json.loads((self.folder / "thin.json").read_text())["solver_path"], "meshes")


if __name__ == "__main__":
    unittest.main()

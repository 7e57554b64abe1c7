# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that rpc has written as Exodus and reads again gives the same run, on any number of ranks, of files and geometries, adapted or not, of both orders."""

import os
import shutil
import unittest

from rpc_run import RANKS, SOURCE, WrittenDeckTestCase

DATA = SOURCE / "packages" / "mesh" / "test" / "data"
DECK = """{name}:
  Mesh: {{Type: gmsh, File: {file}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {{{held}: {{X: 0.0, Y: 0.0, Z: 0.0}}}}
  Body Force: {{X: 0.3, Y: -0.2, Z: -1.0}}
  Contact: {{Side: {side}, Gap: 0.0001, Yield Stress: 0.5}}
"""
TIGHT = ["--set=Uzawa->Tolerance=1e-13", "--set=NOX->Residual Tolerance=1e-14", "--set=Linear Solver->Tolerance=1e-14"]
ADAPT = "  Adapt: {Target Relative Error: %g}\n"
OCTANT, BRICKS = {"held": "sphere", "side": "flat"}, {"held": "contact", "side": "held"}


class WrittenMeshes(WrittenDeckTestCase):
    def expect_the_same_run(self, file, sides, more="", *arguments):
        shutil.copy(DATA / file, self.folder)
        first = self.solve("first", DECK.format(name="first", file=file, **sides) + more, *TIGHT, *arguments)
        shutil.copy(self.folder / "first" / "first.e", self.folder / "again.exo")
        again = self.solve("again", DECK.format(name="again", file="again.exo", **sides), *TIGHT)
        self.assertEqual(again["dofs"], first["dofs"])
        self.assertGreater(first["max_pressure"], 0)
        for key in ("energy_J", "contact_force", "strain_energy", "max_pressure", "max_displacement"):
            one, two = (each[key] if isinstance(each[key], list) else [each[key]] for each in (first, again))
            for x, y in zip(one, two):
                self.assertAlmostEqual(x, y, delta=1e-12 * max(abs(v) for v in one), msg=key)

    def test_of_files(self):
        self.expect_the_same_run("octant_22.msh", OCTANT)
        if RANKS < 3:  # two cells
            self.expect_the_same_run("bricks_22.msh", BRICKS)

    def test_of_an_adapted_file(self):
        self.expect_the_same_run("octant_22.msh", OCTANT, ADAPT % 0.3)

    @unittest.skipUnless(os.environ.get("RPC_GMSH", "ON") == "ON", "needs gmsh")
    def test_of_adapted_geometries_of_both_orders(self):
        self.expect_the_same_run("octant.geo", OCTANT, ADAPT % 0.3)
        self.expect_the_same_run("octant.geo", OCTANT, ADAPT % 0.5, "--set=Mesh->Order=1")


if __name__ == "__main__":
    unittest.main()

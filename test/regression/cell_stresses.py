# SPDX-License-Identifier: BSD-3-Clause
"""`Output->Cell Stresses` in load steps whose meshes change, in joined and in split files: each cell has the same stress as on one rank, and the stresses bear the load."""

import subprocess
import unittest

from rpc_run import PROGRAM, RANKS, WrittenDeckTestCase

try:
    import netCDF4
    import numpy as np
except ImportError:
    netCDF4 = None

# The load moves along the top, so that each step refines elsewhere.
BODY = """body:
  Mesh: {{Lower: [0.0, 0.0], Upper: [4.0, 1.0], Cells: [8, 2], Element: {element}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    left: {{X: 0.0}}
  Traction: {{top: {{Y: "-10*exp(-8*(x - t)^2)"}}}}
  Contact: {{Side: bottom, Yield Stress: 6.0}}
  Steps: {{Times: [1.0, 2.0, 3.0]}}
  Adapt: {{Target Relative Error: {target}}}
  Output: {{Cell Stresses: true, Exodus: {kind}}}
"""
FIELDS = ("cell_stress_xx", "cell_stress_yy", "cell_stress_zz", "cell_stress_xy", "cell_von_mises")


@unittest.skipUnless(netCDF4, "python3 has no netCDF4")
class CellStresses(WrittenDeckTestCase):
    def cells(self, path):
        """Of one file (times, numbers of its cells in the joined file, nodes there, their places, stresses and von Mises stress at each time)."""
        with netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            names = [row.tobytes().split(b"\0")[0].decode() for row in file["name_elem_var"][:]]
            coords = np.stack([file["coord" + axis][:] for axis in "xy"], axis=1)
            nodes, numbers = (file[name][:] if name in file.variables else np.arange(1, count + 1)
                              for name, count in (("node_num_map", len(coords)), ("elem_num_map", file.dimensions["num_elem"].size)))
            at = file["connect1"][:] - 1
            fields = np.stack([file["vals_elem_var%deb1" % (names.index(each) + 1)][:] for each in FIELDS], axis=2)
            return list(file["time_whole"][:]), numbers, nodes[at], coords[at], np.moveaxis(fields, 1, 0)

    def meshes(self, name, ranks=None):
        """The same of each mesh of a run, of split files those of all ranks, ordered by the numbers of cells."""
        endings = [f".{ranks}.{rank}" for rank in range(ranks)] if ranks else [""]
        for mesh in ("", "-s0002", "-s0003"):
            parts = [self.cells(self.folder / name / f"{name}.e{mesh}{ending}") for ending in endings]
            for times, *_ in parts:
                self.assertEqual(times, parts[0][0])
            whole = [np.concatenate(each) for each in zip(*(part[1:] for part in parts))]
            order = np.argsort(whole[0])
            yield parts[0][0], *(each[order] for each in whole)

    def test_each_cell_has_the_same_in_joined_and_split_files_of_each_mesh(self):
        for element, target in (("P1", 0.15), ("Q2", 0.03)):
            with self.subTest(element):
                (self.folder / "one.yaml").write_text(BODY.format(element=element, target=target, kind="joined"))
                subprocess.run([PROGRAM, "--input=one.yaml", "--output=one"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
                one = list(self.meshes("one"))
                self.assertEqual([times for times, *_ in one], [[1.0], [2.0], [3.0]])
                self.assertGreater(len({len(numbers) for _, numbers, *_ in one}), 1, "the mesh is to change")
                for mesh in one:
                    self.check_loads(*mesh)
                for kind, ranks in (("joined", None), ("split", RANKS)):
                    self.solve(kind, BODY.format(element=element, target=target, kind=kind))
                    for expected, found in zip(one, self.meshes(kind, ranks)):
                        self.assertEqual(found[0], expected[0])
                        for k in (1, 2):
                            np.testing.assert_array_equal(found[k], expected[k])
                        np.testing.assert_allclose(found[3], expected[3], rtol=0, atol=1e-14)
                        np.testing.assert_allclose(found[4], expected[4], rtol=0, atol=1e-8 * abs(expected[4]).max())

    def check_loads(self, times, numbers, nodes, places, stresses):
        """By virtual work with the displacement (0, y) the sum of |K| stress_yy is the integral of the traction on top, -10 sqrt(pi/8); contact at y = 0 does none."""
        np.testing.assert_array_equal(numbers, np.arange(1, len(numbers) + 1))
        corners = 3 if nodes.shape[1] in (3, 6) else 4
        x, y = places[:, :corners, 0], places[:, :corners, 1]
        area = (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1) / 2
        self.assertAlmostEqual(area.sum(), 4.0, delta=1e-12)
        xx, yy, zz, xy, mises = np.moveaxis(stresses, 2, 0)
        np.testing.assert_allclose(mises, np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * xy**2), rtol=1e-9)
        for work, time in zip(area @ yy, times):
            self.assertAlmostEqual(work, -10 * np.sqrt(np.pi / 8), delta=5e-3, msg=f"time {time}")


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""How contact is spread: "contact_patches" of the summary against a count of the contact table."""
import csv
import json
import struct
import unittest

from rpc_run import RpcTestCase

CELLS = 16
# One period of a layer on a rough foundation that yields: patches reach across the joined sides.
LAYER = f"""layer:
  Mesh: {{Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 0.25], Cells: [{CELLS}, {CELLS}, 4], Element: ELEMENT, Periodic: "X, Y"}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{front: {{X: 0.0, Y: 0.0}}}}
  Traction: {{front: {{Z: -0.01}}}}
  Contact:
    Side: back
    Normal: "0, 0, -1"
    Yield Stress: 0.05
    Obstacle: {{Type: height map, File: made.npy, Spacing X: 0.0625, Periodic: true, Origin: [0.0, 0.0, -0.02], Normal: [0.0, 0.0, 1.0]}}
  Output: {{Exodus: false}}
"""
# Two humps under a strip, one of them mirrored at its end.
STRIP = """strip:
  Mesh: {Lower: [0.0, 0.0], Upper: [3.0, 0.5], Cells: [48, 8]}
  Material: {Young's Modulus: 0.91, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: -0.02}}
  Contact: {Side: bottom, Gap: "0.02*(1 - cos(pi*x))"}
"""


class Patches(RpcTestCase):
    def solve(self, name, deck):
        (self.folder / f"{name}.yaml").write_text(deck)
        output = self.rpc(f"--input={name}.yaml", "--output=out").stdout
        with (self.folder / "out" / f"{name}.contact.csv").open() as table:
            rows = [{key: value if key in ("state", "side") else float(value) for key, value in row.items()} for row in csv.DictReader(table)]
        return json.loads((self.folder / "out" / f"{name}.json").read_text()), rows, output

    def assert_counted(self, found, rows, neighbours, weight):
        """@param neighbours  of a row's number, those of the rows that share a facet with it"""
        pressed = {k for k, row in enumerate(rows) if row["pressure"] > 0}
        left, sizes = set(pressed), []
        while left:
            patch = [left.pop()]
            for k in patch:
                for other in neighbours(k):
                    if other in left:
                        left.remove(other)
                        patch.append(other)
            sizes.append(sum(weight(k) for k in patch))
        self.assertGreater(len(sizes), 1)
        self.assertEqual(found["count"], len(sizes))
        for counted, told in zip(sorted(sizes, reverse=True), found["sizes"]):
            self.assertAlmostEqual(counted, told, delta=1e-12)
        whole = sum(weight(k) for k in range(len(rows)))
        gap = sum(weight(k) * max(0, row["gap"] + row["dent"] - row["u_nu"]) for k, row in enumerate(rows) if k not in pressed) / whole
        self.assertGreater(gap, 0)
        self.assertAlmostEqual(found["mean_gap"], gap, delta=1e-8 * gap)
        ends, told = found["pressure_histogram"]["ends"], found["pressure_histogram"]["sizes"]
        self.assertEqual(len(ends), len(told) + 1)
        self.assertAlmostEqual(ends[-1], max(row["pressure"] for row in rows), delta=1e-9 * ends[-1])
        self.assertAlmostEqual(sum(told), sum(sizes), delta=1e-12)
        bins = [0.0] * len(told)
        for k in pressed:
            bins[min(int(len(bins) * rows[k]["pressure"] / ends[-1]), len(bins) - 1)] += weight(k)
        for counted, size in zip(bins, told):
            self.assertAlmostEqual(counted, size, delta=1e-12)

    def test_a_periodic_layer(self):
        self.rpc("--make-surface=made.npy", f"--set=Points={CELLS}", "--set=RMS Slope=0.1", "--set=Highest Wave Number=4", "--set=Seed=3")
        made = struct.unpack(f"<{CELLS * CELLS}d", (self.folder / "made.npy").read_bytes()[-8 * CELLS * CELLS:])
        self.assertGreater(max(made), 0)
        for element in ("Q1", "P1"):
            with self.subTest(element=element):
                found, rows, output = self.solve("layer", LAYER.replace("ELEMENT", element))
                place = {(round(CELLS * row["x"]), round(CELLS * row["y"])): k for k, row in enumerate(rows)}
                self.assertEqual(len(place), CELLS * CELLS)
                at = {k: where for where, k in place.items()}
                # Of the two diagonals of a cell P1 has one.
                steps = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if element == "Q1" or i * j != -1]

                def neighbours(k):
                    return [place[(at[k][0] + i) % CELLS, (at[k][1] + j) % CELLS] for i, j in steps]

                patches = found["contact_patches"]["back"]
                self.assert_counted(patches, rows, neighbours, lambda k: rows[k]["area"])
                self.assertAlmostEqual(sum(patches["sizes"]), found["contact_area"], delta=1e-12)
                self.assertIn(f"patches             {patches['count']}, the largest ", output)
                # A count that ends at the joined sides differs.
                cut = sum(rows[place[i, j]]["pressure"] > 0 and rows[place[0, j]]["pressure"] > 0 for i in (CELLS - 1,) for j in range(CELLS))
                self.assertGreater(cut, 0)

    def test_a_strip_in_the_plane(self):
        found, rows, output = self.solve("strip", STRIP)
        self.assert_counted(found["contact_patches"]["bottom"], rows, lambda k: [n for n in (k - 1, k + 1) if 0 <= n < len(rows)],
                            lambda k: 0.0625 if 0 < k < len(rows) - 1 else 0.03125)
        self.assertNotIn("patches  ", output)

    def test_histories_have_the_patches_of_each_step(self):
        steps = STRIP.replace("Y: -0.02", "Y: -0.02*t").replace("strip:\n", "strip:\n  Steps: {Times: [0.2, 1.0]}\n")
        found, _, _ = self.solve("strip", steps)
        with (self.folder / "out" / "strip.history.csv").open() as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), 2)
        for row, step in zip(rows, found["steps"]):
            for key in ("patches", "largest_patch", "mean_gap"):
                self.assertAlmostEqual(float(row[key]), step[key], delta=1e-12)
        last = found["contact_patches"]["bottom"]
        self.assertEqual(rows[1]["patches"], str(last["count"]))
        self.assertAlmostEqual(found["steps"][1]["largest_patch"], last["sizes"][0], delta=1e-12)
        self.assertAlmostEqual(found["steps"][1]["mean_gap"], last["mean_gap"], delta=1e-12)
        self.assertLess(found["steps"][0]["largest_patch"], last["sizes"][0])
        self.assertGreater(found["steps"][0]["mean_gap"], last["mean_gap"])


if __name__ == "__main__":
    unittest.main()

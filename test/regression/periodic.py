# SPDX-License-Identifier: BSD-3-Clause
"""Periodic boxes: "Mesh->Periodic"."""
import csv
import json
import math
import unittest

from rpc_run import RANKS, RpcTestCase, files

try:
    import netCDF4
except ImportError:
    netCDF4 = None
AMPLITUDE = 0.01
# A wave of length 1. E* = 1.
WAVE = f"Gap: {AMPLITUDE}*(1 - cos(2*pi*(x - {{shift!r}})))"
BLOCK = """deck:
  Mesh: {{Lower: [0.0, 0.0], Upper: [{length}, {height}], Cells: [{cells}, {deep}], Element: {element}, Periodic: {periodic}}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{{held}}}
  Traction: {{{loaded}}}
  Contact: {{Side: bottom, Normal: "0, -1", {foundation}}}
"""
# In space the wave runs along x and, less high, along y. Friction holds it, and it is dragged along x.
SLAB = """deck:
  Mesh: {{Lower: [0.0, 0.0, 0.0], Upper: [1.0, 1.0, 0.5], Cells: [8, 8, 4], Element: {element}, Periodic: "X, Y"}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{front: {{X: 0.002*(t - 1), Y: 0.0, Z: -0.008}}}}
  Contact:
    Side: back
    Normal: "0, 0, -1"
    Gap: 0.01*(1 - cos(2*pi*(x - {shift_x!r}))) + 0.003*(1 - cos(2*pi*(y - {shift_y!r})))
    Yield Stress: 0.03
    Friction Coefficient: 0.3
  Steps: {{Times: {times}, Checkpoint Every: 1}}
"""
# Pressed by a force, and by a circle that may stand anywhere.
RIGID = """deck:
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [16, 8], Periodic: X}
  Material: {Young's Modulus: 0.91, Poisson's Ratio: 0.3}
  Rigid: {top: {X: 0.0, Force Y: -0.005}}
  Contact: {Side: bottom, Obstacle: {Type: circle, Centre: [0.5, -1.0], Radius: 1.0}}
"""
ONE_RANK = "nothing here depends on ranks"
# Of one rank, Q1 after a step of friction [J].
ENERGY = 1.06807572855e-5


class Periodic(RpcTestCase):
    def solve(self, deck, *arguments, name="deck", output="out"):
        (self.folder / f"{name}.yaml").write_text(deck)
        self.rpc(f"--input={name}.yaml", f"--output={output}", *arguments)
        return json.loads((self.folder / output / f"{name}.json").read_text())

    def block(self, cells=16, deep=16, length=1.0, height=1.0, element="Q1", periodic="X", held="top: {X: 0.0, Y: -0.012}",
              loaded="", foundation=WAVE.format(shift=0.0), arguments=()):
        return self.solve(BLOCK.format(cells=cells, deep=deep, length=length, height=height, element=element, periodic=periodic, held=held,
                                       loaded=loaded, foundation=foundation), "--set=Uzawa->Tolerance=1e-12", *arguments)

    def points(self, column, output="out"):
        """Values at the points of the contact side, by their places."""
        with (self.folder / output / "deck.contact.csv").open() as table:
            rows = list(csv.DictReader(table))
        axes = [key for key in rows[0] if key.split(" ")[0] in ("x", "y", "z")]
        of = next(key for key in rows[0] if key.split(" ")[0] == column)
        return {tuple(round(float(row[axis]), 9) for axis in axes): float(row[of]) for row in rows}

    def assert_shifted(self, before, after, shift):
        """Values of one run are those of another one, moved round."""
        largest = max(abs(value) for value in before.values())
        self.assertGreater(largest, 0)
        self.assertEqual(len(before), len(after))
        for place, value in before.items():
            moved = tuple(round((x + by) % 1.0, 9) % 1.0 for x, by in zip(place, shift))
            self.assertAlmostEqual(after[moved], value, delta=1e-10 * largest)

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_an_obstacle_may_stand_anywhere(self):
        for element in ("Q1", "Q2", "P1", "P2"):
            with self.subTest(element=element):
                first = self.block(element=element)
                pressure = self.points("pressure")
                self.assertEqual(len(pressure), 16 if element[1] == "1" else 32)
                for cells in (3, 8, 13):
                    shift = cells / 16
                    found = self.block(element=element, foundation=WAVE.format(shift=shift))
                    self.assertAlmostEqual(found["contact_force"][1] / first["contact_force"][1], 1, delta=1e-10)
                    self.assertAlmostEqual(found["energy_J"] / first["energy_J"], 1, delta=1e-10)
                    self.assert_shifted(pressure, self.points("pressure"), (shift, 0))

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_in_space_it_may_too_with_friction_and_yield(self):
        for element in ("Q1", "P1"):
            with self.subTest(element=element):
                runs = {}
                for shift in ((0.0, 0.0), (0.375, 0.875)):
                    slab = SLAB.format(element=element, shift_x=shift[0], shift_y=shift[1], times="[1.0, 2.0]")
                    runs[shift] = self.solve(slab, "--set=Uzawa->Tolerance=1e-12"), self.points("pressure"), self.points("q_x")
                (first, pressure, friction), (found, moved, dragged) = runs.values()
                self.assertEqual(len(pressure), 64)
                for key in ("contact_force", "friction_work", "energy_J"):
                    for a, b in zip(*(value if isinstance(value, list) else [value] for value in (first[key], found[key]))):
                        self.assertAlmostEqual(a, b, delta=1e-9 * abs(first["contact_force"][2]))
                self.assertGreater(first["max_dent"], 0)
                self.assert_shifted(pressure, moved, (*shift, 0))
                self.assert_shifted(friction, dragged, (*shift, 0))

    def test_uniform_compression_is_exact(self):
        for element in ("Q1", "Q2", "P1", "P2"):
            with self.subTest(element=element):
                found = self.block(cells=5, deep=3, element=element, foundation='Gap: "0"')
                self.assertAlmostEqual(found["contact_force"][1], 0.91 * 0.7 / (1.3 * 0.4) * 0.012, delta=1e-11)
                self.assertAlmostEqual(found["contact_length"], 1, delta=1e-12)

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_half_a_wave_between_planes_of_symmetry_is_half_of_it(self):
        for element in ("Q1", "Q2"):
            with self.subTest(element=element):
                whole = self.block(element=element)
                half = self.block(element=element, cells=8, length=0.5, periodic="none", held="top: {X: 0.0, Y: -0.012}, left: {X: 0.0}, right: {X: 0.0}")
                for key in ("energy_J", "contact_length"):
                    self.assertAlmostEqual(whole[key] / (2 * half[key]), 1, delta=1e-10)
                self.assertAlmostEqual(whole["contact_force"][1] / (2 * half["contact_force"][1]), 1, delta=1e-10)
                self.assertAlmostEqual(whole["contact_force"][0], 0, delta=1e-10 * whole["contact_force"][1])

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_a_wave_is_westergaards(self):
        full, half_width = math.pi * AMPLITUDE, 0.15  # mean pressure of full contact
        mean = full * math.sin(math.pi * half_width) ** 2
        highest = 2 * full * math.sin(math.pi * half_width)
        errors = []
        for cells in (32, 64):
            found = self.block(cells=cells, deep=cells, height=1.0, held="top: {X: 0.0}", loaded=f"top: {{Y: {-mean!r}}}")
            self.assertAlmostEqual(found["contact_force"][1], mean, delta=1e-9 * mean)
            errors.append(abs(found["max_pressure"] / highest - 1))
            self.assertAlmostEqual(found["contact_length"], 2 * half_width, delta=1.5 / cells)
        self.assertLess(errors[1], 4e-3)
        self.assertLess(errors[1], errors[0] / 2)

    def test_a_foundation_without_the_period_is_told_where_it_matters(self):
        told = "has not the period of the box"
        for centre, is_told in ((0.5, False), (0.3, False), (0.0, True), (0.97, True)):
            with self.subTest(centre=centre):
                found = self.solve(RIGID, "--set=Rigid->top->Rotation Z=0", f"--set=Contact->Obstacle->Centre={{{centre},-1.0}}")
                self.assertAlmostEqual(found["contact_force"][1], 0.005, delta=1e-9)
                self.assertAlmostEqual(found["rigid"]["top"]["point"][0], 0.5, delta=1e-14)  # the middle of the joined side
                if centre == 0.5:
                    self.assertAlmostEqual(found["rigid"]["top"]["moment"], 0, delta=1e-12)
                self.assertEqual(sum(told in note for note in found["notes"]), is_told)

    @unittest.skipUnless(netCDF4, "python3 has no netCDF4")
    def test_no_cell_of_a_file_reaches_across_the_box(self):
        for element, width in (("P1", 1 / 8), ("Q2", 1 / 8)):
            self.block(cells=8, deep=8, element=element, foundation=WAVE.format(shift=0.25))
            with netCDF4.Dataset(self.folder / "out" / "deck.e") as file:
                x, y = file.variables["coordx"][:], file.variables["coordy"][:]
                names = ["".join(c.decode() for c in row.compressed()).strip() for row in file.variables["name_nod_var"][:]]
                of = {name: file.variables[f"vals_nod_var{k + 1}"][0] for k, name in enumerate(names)}
                cells = file.variables["connect1"][:] - 1
            self.assertAlmostEqual(float(x.max()), 1)
            for cell in cells:
                self.assertAlmostEqual(float(x[cell].max() - x[cell].min()), width)
            left = {round(float(y[n]), 9): n for n in range(len(x)) if x[n] == 0}
            right = {round(float(y[n]), 9): n for n in range(len(x)) if abs(x[n] - 1) < 1e-12}
            self.assertEqual(left.keys(), right.keys())
            for at, n in left.items():
                for field in of.values():
                    self.assertEqual(field[n], field[right[at]])
            pressed = [n for n in range(len(x)) if y[n] == 0]  # the middle of the wave is at x = 1/4, and stresses are symmetric about it
            middle = {round(float(x[n]) % 1, 9): n for n in pressed}
            stress, largest = of["stress_yy"], float(abs(of["stress_yy"]).max())
            for n in pressed:
                if element == "Q2":
                    self.assertAlmostEqual(float(stress[n]), float(stress[middle[round((0.5 - float(x[n])) % 1, 9)]]), delta=1e-8 * largest)

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_a_restart_goes_on_to_the_last_bit(self):
        deck = SLAB.format(element="Q1", shift_x=0.375, shift_y=0.0, times="[1.0, 2.0, 3.0]")
        whole = self.solve(deck, output="whole")
        checkpoint = next(name for name in files(self.folder / "whole") if "checkpoint" in name and "2" in name)
        again = self.solve(deck, f"--restart=whole/{checkpoint}", output="again")
        for key in ("energy_J", "contact_force", "friction_work"):
            self.assertEqual(whole[key], again[key])
        self.assertEqual((self.folder / "whole" / "deck.contact.csv").read_text(), (self.folder / "again" / "deck.contact.csv").read_text())

    def test_ranks_agree(self):
        found = self.solve(SLAB.format(element="Q1", shift_x=0.1, shift_y=0.2, times="[1.0, 2.0]"))
        self.assertAlmostEqual(found["energy_J"] / ENERGY, 1, delta=1e-9)

    @unittest.skipIf(RANKS > 1, ONE_RANK)
    def test_what_is_not_covered_is_refused(self):
        for changes, parts in (
                (["Mesh->Periodic=Z"], ["\"Mesh->Periodic\" names Z", "plane"]),
                (["Mesh->Periodic=U"], ["\"Mesh->Periodic\"", "none, X, Y", "got \"U\""]),
                (["Mesh->Periodic=X, Y"], ["\"Mesh->Periodic\" must leave the box sides"]),
                (["Mesh->Cells={2, 4}"], ["\"Mesh->Cells\" must be >= 3 in direction 1"]),
                (["Kinematics=axisymmetric"], ["\"Mesh->Periodic\" does not go with", "axisymmetric"]),
                (["Adapt->Target Relative Error=0.01"], ["\"Adapt\" does not go with \"Mesh->Periodic\""]),
                (["Adapt->Estimate Error=true"], ["\"Adapt\" does not go with \"Mesh->Periodic\""]),
                (["Adapt->Error Bound=guaranteed"], ["\"Adapt\" does not go with \"Mesh->Periodic\""]),
                (["Dirichlet->left->X=0"], ["the side \"left\"", "Its sides: bottom, top", "Mesh->Periodic"])):
            with self.subTest(changes=changes):
                (self.folder / "deck.yaml").write_text(BLOCK.format(cells=8, deep=4, length=1.0, height=1.0, element="Q1", periodic="X", held="top: {X: 0.0, Y: -0.012}",
                                                                    loaded="", foundation=WAVE.format(shift=0.0)))
                self.expect_refusal(self.rpc("--input=deck.yaml", *(f"--set={each}" for each in changes), code=None), 2, parts)
        # Both ends of a side that turns would not meet.
        (self.folder / "deck.yaml").write_text(RIGID)
        self.expect_refusal(self.rpc("--input=deck.yaml", code=None), 2, ["\"Rigid->top->Rotation Z\" must be 0 with \"Mesh->Periodic\"", "got none", "Write 0"])
        self.expect_refusal(self.rpc("--input=deck.yaml", "--set=Rigid->top->Rotation Z=0.001*t", code=None), 2, ["got 0.001*t"])
        # Nothing turns a periodic body, but something must hold it along the period.
        (self.folder / "deck.yaml").write_text(BLOCK.format(cells=8, deep=4, length=1.0, height=1.0, element="Q1", periodic="X", held="", loaded="top: {X: 0.001, Y: -0.01}",
                                                            foundation=WAVE.format(shift=0.0)))
        self.expect_refusal(self.rpc("--input=deck.yaml", code=None), 5, ["along (1, 0)"])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Files of results as arrays."""
import csv
import unittest

from support import HAS_MPI, SMALL, TestCase, beam, rpc

import numpy as np

SHEAR = {"Mesh->Cells": [24, 12], "Steps->Times": [0.5, 1, 1.125]}


class Results(TestCase):
    def test_the_contact_table_is_that_of_the_file(self):
        result = rpc.run(beam(), settings={"Units->Length": "mm"}, folder=self.folder)
        rows = result.contact()
        with open(self.folder / "deck.contact.csv", newline="") as file:
            expected = list(csv.DictReader(file))
        self.assertEqual(len(rows), 21)
        self.assertEqual(rows.dtype.names, ("x", "y", "s", "u_nu", "gap", "pressure", "state", "side", "dent", "u_t_x", "u_t_y", "force_x", "force_y"))
        self.assertEqual([float(row["pressure [MPa]"]) for row in expected], rows["pressure"].tolist())
        self.assertEqual([row["state"] for row in expected], rows["state"].tolist())
        self.assertEqual(set(rows["side"]), {"bottom"})
        self.assertEqual(rows["pressure"][rows["state"] == "yielding"].max(), 16)
        self.assertEqual(result.summary["units"]["stress"], "MPa")
        self.assertEqual(result.fields().units["stress"], "MPa")

    def test_load_steps_have_a_history_and_fields_of_each(self):
        result = rpc.run("shear.xml", settings=SHEAR)
        history, rows = result.history(), result.contact()
        self.assertEqual(history["time"].tolist(), [0.5, 1, 1.125])
        self.assertEqual(result.times.tolist(), [0.5, 1, 1.125])
        self.assertEqual(history["converged"].tolist(), [1, 1, 1])
        self.assertEqual(history["reason"].dtype.kind, "U")
        self.assertTrue(set(rows["friction_state"]) <= {"sticks", "slips", "none"})
        for step, time in enumerate(result.times):
            fields = result.fields(step)
            self.assertEqual(fields.time, time)
            self.assertAlmostEqual(np.linalg.norm(fields.displacement, axis=1).max(), history["max_displacement"][step], delta=1e-12)
            self.assertAlmostEqual(fields["contact_pressure"].max(), history["max_pressure"][step], delta=1e-12)
        np.testing.assert_array_equal(result.fields()["disp_x"], result.fields(2)["disp_x"])
        self.refused(["step must be below 3", "got 3"], result.fields, 3)
        self.refused(["step must be below 3", "got -4"], result.fields, -4)
        self.refused(['no field "temperature"', "von_mises"], lambda: result.fields()["temperature"])
        self.refused(['no side "hinten"', "bottom"], result.fields().side_nodes, "hinten")

    def test_results_at_points_are_those_of_the_fields(self):
        result = rpc.run(beam(), settings={"Output->Points->tip->Points": "5 1; 2.5 0"})
        rows, fields = result.points(), result.fields()
        self.assertEqual(rows["name"].tolist(), ["tip", "tip"])
        for row in rows:
            node = abs(fields.points - [row["x"], row["y"]]).sum(axis=1).argmin()
            for name in ("disp_x", "disp_y", "stress_xx", "von_mises"):
                self.assertAlmostEqual(row[name], fields[name][node], delta=1e-9 * abs(fields[name]).max())
        self.assertTrue(np.isnan(rows["contact_pressure"][0]))
        self.assertEqual(rows["contact_pressure"][1], 16)
        self.refused(["Output->Points"], rpc.run(beam()).points)

    def test_fields_follow_meshes_that_change(self):
        settings = {"Traction->top->Y": "-20*t*sin(pi*x/5)", "Steps->Times": [0.2, 0.6, 1.0], "Adapt->Target Relative Error": 0.02}
        results = [rpc.run("beam_adaptive.xml", settings=settings)]
        if HAS_MPI:
            results.append(rpc.run("beam_adaptive.xml", settings={**settings, "Output->Exodus": "split"}, ranks=2))
        for result in results:
            self.assertEqual(result.times.tolist(), [0.2, 0.6, 1.0])
            sizes = [len(result.fields(step).points) for step in range(3)]
            self.assertLess(sizes[0], sizes[2])
            self.assertEqual(2 * sizes[2], result.summary["dofs"])
            self.assertEqual([result.fields(step).time for step in range(3)], [0.2, 0.6, 1.0])
            for step in range(3):  # as many as there are cells, in every file of the film
                fields = result.fields(step)
                self.assertEqual(fields["error_energy_norm"].shape, (sum(len(block.cells) for block in fields.blocks),))
            estimate = result.summary["error_estimate"]["energy_norm"]
            self.assertAlmostEqual(np.linalg.norm(result.fields()["error_energy_norm"]), estimate, delta=1e-12 * estimate)
            self.assertEqual(result.fields().units["energy"], "J/m")

    def test_sides_have_their_nodes_whatever_the_element(self):
        places = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1), "back": (2, 0), "front": (2, 1)}
        for dim, element, name in ((2, "Q2", "QUAD9"), (2, "P2", "TRI6"), (3, "Q2", "HEX27"), (3, "P2", "TETRA10"), (3, "P1", "TETRA4")):
            held = dict.fromkeys("XYZ"[:dim], 0.0)
            fields = rpc.run({"Mesh": {"Lower": [0.0] * dim, "Upper": [1.0] * dim, "Cells": [3, 2, 2][:dim], "Element": element},
                              "Material": {"Young's Modulus": 1.0, "Poisson's Ratio": 0.3}, "Dirichlet": {"top": {**held, "Y": -0.1}},
                              "Contact": {"Side": "bottom"}}).fields()
            self.assertEqual((fields.blocks[0].element, fields.points.shape[1]), (name, dim))
            for side in fields.sides:
                axis, end = places[side]
                np.testing.assert_array_equal(fields.side_nodes(side), np.flatnonzero(fields.points[:, axis] == end), f"{name} {side}")

    def test_results_without_contact_and_without_files(self):
        deck = beam()
        del deck["Contact"]
        result = rpc.run(deck, settings={"Output->Exodus": "none"})
        self.refused(['"Output->Exodus"'], result.fields)
        self.refused(['"Steps->Times"'], result.history)
        self.refused(['"Output->CSV"'], result.contact)

    def test_results_can_be_loaded(self):
        ran = rpc.run(beam(), folder=self.folder)
        for name in ("deck", "deck.json", "deck.e", "deck.contact.csv", "deck.run.json"):
            loaded = rpc.load(self.folder / name)
            self.assertEqual((loaded.code, loaded.files, loaded.seconds, loaded.console), (0, ran.files, ran.seconds, ran.console))
        (self.folder / "deck.run.json").unlink()  # as one from the command line
        loaded = rpc.load(str(self.folder / "deck.json"))
        self.assertTrue(loaded.ok)
        self.assertEqual(loaded.contact().tolist(), ran.contact().tolist())
        self.refused(["there are no results", "nothing.*"], rpc.load, self.folder / "nothing.json")
        rpc.run("beam.xml", settings={**SMALL, "Uzawa->Tolerance": 1e-40}, folder=self.folder, check=False)
        (self.folder / "beam.run.json").unlink()
        failed = rpc.load(self.folder / "beam")
        self.assertFalse(failed.ok)
        self.assertIn("Uzawa->Tolerance", failed.message)

    def test_damaged_files_are_refused(self):
        rpc.run(beam(), folder=self.folder)
        for name, read in (("deck.json", lambda result: result.summary), ("deck.e", lambda result: result.fields())):
            content = (self.folder / name).read_bytes()
            (self.folder / name).write_bytes(content[:len(content) // 2])
            self.refused([name, "remedy: run it again"], read, rpc.load(self.folder / "deck"))
        (self.folder / "deck.run.json").write_text("{")
        self.refused(["deck.run.json", "remove it"], rpc.load, self.folder / "deck")


if __name__ == "__main__":
    unittest.main()

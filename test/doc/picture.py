# SPDX-License-Identifier: BSD-3-Clause
"""doc/picture.sh: pictures of results of the program, and of each element; what it refuses."""

import contextlib
import csv
import dataclasses
import io
import pathlib
import subprocess
import sys
import unittest

try:
    import matplotlib.image
    import netCDF4
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}; what pictures take: bash cmake/install_packages.sh doc/packages.txt")
    sys.exit(77)

HERE = pathlib.Path(__file__).parent
sys.path += [str(HERE.parent / "regression"), str(HERE.parents[1] / "doc" / "picture")]

import command_line
import elements
import exodus_file
import figure
import history
import fields
import raster
import scene as scenes
import sides
import style
import surface
import view
from result import PictureError, Result
from rpc_run import SOURCE, RpcTestCase, files
from scene import Scene, automatic_scale
from surface import LEVELS, NORMAL, PLACE, VALUE
from table import Table

style.STYLES |= {name: dataclasses.replace(one, dpi=one.dpi // 2) for name, one in style.STYLES.items()}  # a quarter of users' pixels

BLOCK = """<ParameterList name="block">
  <ParameterList name="Mesh">
    <Parameter name="Lower" type="Array(double)" value="{-1, -1, 0}"/>
    <Parameter name="Upper" type="Array(double)" value="{1, 1, 1}"/>
    <Parameter name="Cells" type="Array(int)" value="{4, 4, 2}"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="2000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="front">
      <Parameter name="X" type="double" value="0"/>
      <Parameter name="Y" type="double" value="0"/>
      <Parameter name="Z" type="double" value="-0.04"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="back"/>
    <Parameter name="Yield Stress" type="double" value="60"/>
    <Parameter name="Gap" type="string" value="0.03*(x^2+y^2)"/>
  </ParameterList>
</ParameterList>
"""


def bent(positions):
    """A smooth map that leaves the planes x, y, z = 0 and 1 where they are."""
    x = positions
    bubble = np.prod(4 * x * (1 - x), axis=1)
    return x + 0.05 * bubble[:, None] + 0.1 * x * (1 - x)


def box_file(path, element, n=2, shape=bent, **options):
    """A box with displacements 0.01 (x, y, z) and contact on its lowest side; returns positions and cells."""
    positions, cells = exodus_file.box(element, n)
    positions = shape(positions)
    dim = positions.shape[1]
    lowest = positions[:, -1] == 0
    if element == "TETRA10":  # the contact points of quadratic triangles are the middles of their edges
        lowest[cells[:, :4]] = False
    fields = {f"disp_{axis}": 0.01 * positions[:, d] for d, axis in enumerate("xyz"[:dim])}
    fields |= {"von_mises": positions[:, 0], "contact_pressure": np.where(lowest, 2 + positions[:, 0], 0),
               "gap": np.zeros(len(positions)), "dent": np.zeros(len(positions)), "penetration": np.zeros(len(positions)),
               "contact_status": np.where(lowest, 1.0, -1.0)}
    fields |= {f"contact_normal_{axis}": np.where(lowest & (d == dim - 1), -1.0, 0.0) for d, axis in enumerate("xyz"[:dim])}
    exodus_file.write(path, element, positions, cells, fields, **options)
    return positions, cells


def history_file(path, top=(0.0, -0.1, -0.05), **more):
    """Three load steps of which the second presses most."""
    columns = {"time": (1, 2, 3), "strain_energy": (0, 1, 0.2), "foundation_energy": (0, 0, 0), "dissipated_energy": (0, 2, 2),
               "work": (0, 3, 2.2), "contact_length": (0, 1, 1), "contact_force_x": (0, 1, 0), "contact_force_y": (0, 9, 4),
               "left_displacement_y": (0, 0, 0), "top_displacement_x": (0, 5, 0), "top_displacement_y": top, **more}
    rows = [columns, *zip(*columns.values())]
    path.write_text("".join(",".join(str(entry) for entry in row) + "\n" for row in rows))


def areas(triangles):
    """(n, 3) area times normal of triangles (n, 3, m)."""
    corner = triangles[..., PLACE]
    return 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])


class Elements(RpcTestCase):
    """Each element, in boxes with curved cells."""

    def scenes(self, dim, **options):
        for element in exodus_file.NODES:
            if exodus_file.dim(element) == dim:
                box_file(self.folder / "box.e", element)
                yield element, Scene(Result(str(self.folder / "box.e")), scale=0, **options)

    def test_cells_of_the_plane_cover_it_once(self):
        for element, scene in self.scenes(2, field="von_mises"):
            with self.subTest(element):
                area = areas(scene.layers["body"])[:, 2]
                self.assertTrue((area > 0).all())
                self.assertAlmostEqual(area.sum(), 1, delta=1e-12)

    def test_skin_in_space_is_closed_and_uncrossed(self):
        for element, scene in self.scenes(3, field="von_mises"):
            with self.subTest(element):
                skin = scene.layers["body"]
                area = areas(skin)
                self.assertAlmostEqual(np.linalg.norm(area, axis=1).sum(), 6, delta=1e-12)
                self.assertAlmostEqual((area * skin[..., PLACE].mean(axis=1)).sum() / 3, 1, delta=1e-12)
                outwards = surface.unit(area)[:, None] * skin[..., NORMAL]
                self.assertLess(abs(outwards.sum(axis=2) - 1).max(), 1e-9)
                self.assertLess(abs(skin[..., VALUE] - skin[..., 0]).max(), 0.03)

    def test_each_face_of_a_tetrahedron_looks_outwards(self):
        for element in ("TETRA4", "TETRA10"):
            positions, cells = exodus_file.box(element, 1)
            fields = {f"disp_{axis}": 0 * positions[:, 0] for axis in "xyz"} | {"von_mises": positions[:, 0]}
            exodus_file.write(self.folder / "one.e", element, positions + [1, 2, 4], cells[:1], fields)
            skin = Scene(Result(str(self.folder / "one.e"))).layers["body"]
            self.assertAlmostEqual((areas(skin) * skin[..., PLACE].mean(axis=1)).sum() / 3, 1 / 6, delta=1e-12)

    def test_contact_side_shows_the_contact_field_and_the_rest_the_stress(self):
        for element, scene in self.scenes(3):
            with self.subTest(element):
                side, rest = scene.layers["contact"], scene.layers["body"]
                self.assertAlmostEqual(np.linalg.norm(areas(side), axis=1).sum(), 1, delta=1e-12)
                self.assertAlmostEqual(np.linalg.norm(areas(rest), axis=1).sum(), 5, delta=1e-12)
                self.assertEqual(abs(side[..., 2]).max(), 0)
                self.assertGreaterEqual(side[..., VALUE].min(), 2)

    def test_cut_takes_away_what_lies_beyond_and_shows_the_section(self):
        for axis, value in ((0, 0.37), (1, 0.1), (2, 0.713)):
            for element, scene in self.scenes(3, field="von_mises", cut=surface.Cut(axis, value, 1)):
                with self.subTest(element):
                    drawn = scene.layers["body"]
                    area, place = areas(drawn), drawn[..., axis]
                    self.assertLessEqual(place.max(), value + 1e-12)
                    section = (abs(place - value) < 1e-12).all(axis=1)
                    self.assertAlmostEqual(np.linalg.norm(area[section], axis=1).sum(), 1, delta=1e-3)
                    self.assertAlmostEqual(np.linalg.norm(area[~section], axis=1).sum(), 1 + 4 * value, delta=1e-3)

    def test_tetrahedra_fill_a_cell_in_space(self):
        for element in exodus_file.NODES:
            if exodus_file.dim(element) == 3:
                positions, cells = exodus_file.box(element, 1)
                corner = positions[cells[:, elements.tetrahedra(element)]].reshape(-1, 4, 3)
                volumes = abs(np.linalg.det(corner[:, 1:] - corner[:, :1])) / 6
                self.assertAlmostEqual(volumes.sum(), 1, delta=1e-12, msg=element)
                self.assertGreater(volumes.min(), 0, element)

    def test_functions_of_a_face_are_one_at_their_node(self):
        for kind in ("TRI3", "TRI6", "QUAD4", "QUAD9"):
            nodes = exodus_file.TRIANGLE if kind.startswith("TRI") else exodus_file.SQUARE
            nodes = np.array(nodes[: exodus_file.NODES[kind]]) / 2
            points, _ = elements.division(kind, 8)
            for functions in (elements.shape, elements.hats):
                with self.subTest(f"{functions.__name__} of {kind}"):
                    self.assertLess(abs(functions(kind, nodes) - np.eye(len(nodes))).max(), 1e-15)
                    self.assertLess(abs(functions(kind, points) @ nodes - points).max(), 1e-15)
            self.assertGreaterEqual(elements.hats(kind, points).min(), 0)

    def test_fields_of_cells(self):
        positions, cells = exodus_file.box("TRI6", 2)
        still = dict.fromkeys(("disp_x", "disp_y"), 0 * positions[:, 0])
        exodus_file.write(self.folder / "cells.e", "TRI6", positions, cells, still, {"error": np.arange(len(cells), dtype=float)})
        drawn = Scene(Result(str(self.folder / "cells.e")), "error").layers["body"]
        value = drawn[..., VALUE].mean(axis=1)
        for k in range(len(cells)):
            self.assertAlmostEqual(areas(drawn[value == k])[:, 2].sum(), 1 / len(cells), delta=1e-12)


class Pixels(unittest.TestCase):
    """The raster."""

    @staticmethod
    def square(low, high, depth):
        a, b, c, d = ([x, y, depth] for x, y in ((low, low), (high, low), (high, high), (low, high)))
        return [[a, b, c], [a, c, d]]

    def test_the_nearer_surface_hides_the_other(self):
        for order in (1, -1):
            squares = np.array((self.square(1, 9, 5) + self.square(3, 7, 2))[::order], dtype=float)
            canvas = raster.Raster(10, 10)
            canvas.draw(squares)
            depth = canvas.depth.reshape(10, 10)
            self.assertTrue((depth[3:7, 3:7] == 2).all())
            self.assertEqual((depth == 5).sum(), 64 - 16)
            self.assertEqual((canvas.triangle == -1).sum(), 36)

    def test_neighbours_leave_no_gap_and_values_are_linear(self):
        x, y = np.meshgrid(np.linspace(-3, 43, 14), np.linspace(-3, 33, 14))
        moved = np.stack([x + 1.1 * np.sin(3 * y), y + 0.8 * np.sin(2 * x), 0 * x], axis=-1)
        a, b, c, d = moved[:-1, :-1], moved[:-1, 1:], moved[1:, 1:], moved[1:, :-1]
        triangles = np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, d, c))])
        canvas = raster.Raster(40, 30)
        canvas.draw(triangles)
        self.assertTrue((canvas.triangle >= 0).all())
        found = canvas.values(triangles, np.arange(40 * 30)).reshape(30, 40, 3)
        self.assertLess(abs(found[..., 0] - np.arange(40) - 0.5).max(), 2e-3)
        self.assertLess(abs(found[..., 1] - np.arange(30)[:, None] - 0.5).max(), 2e-3)

    def test_ink_behind_a_surface_is_not_seen(self):
        canvas = raster.Raster(10, 10)
        canvas.draw(np.array(self.square(2, 8, 5), dtype=float))
        line = np.stack([np.linspace(0, 9.9, 40), np.full(40, 5.5), np.full(40, 7.0)], axis=1)
        ink = canvas.ink(line, np.full(40, 0.5), 1, tolerance=1)
        self.assertEqual(sorted(np.flatnonzero(ink[5])), [0, 1, 8, 9])
        line[:, 2] = 5.9
        self.assertTrue((canvas.ink(line, np.full(40, 0.5), 1, tolerance=1)[5] == 0.5).all())


class Pictures(RpcTestCase):
    """The command as a user gives it."""

    def picture(self, *arguments):
        """Exit code, standard output and error of the command."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            with contextlib.chdir(self.folder):
                code = command_line.main(arguments)
        return code, out.getvalue(), err.getvalue()

    def expect_picture(self, name, *arguments):
        self.assertEqual(self.picture(*arguments), (0, f"wrote {name}\n", ""))
        image = matplotlib.image.imread(self.folder / name)
        colored = np.ptp(image[..., :3], axis=2) > 0.2
        self.assertGreater(colored.mean(), 0.05)
        return image

    def expect_refusal_of(self, arguments, *parts):
        before = files(self.folder)
        code, out, err = self.picture(*arguments)
        self.assertEqual((code, out, len(err.splitlines())), (2, "", 1), err)
        for part in ("picture: error: ", *parts):
            self.assertIn(part, err)
        self.assertEqual(files(self.folder), before)

    def test_beam_of_the_program(self):
        self.solve("--set=Contact->Yield Stress=16")
        result = Result(str(self.folder / "out" / "beam.e"))
        self.expect_contact(result)
        self.expect_picture("out/beam.png", "out/beam.e")
        stress = self.expect_picture("stress.png", "out/beam.e", "--field=von_mises", "--scale=5", "--output=stress.png")
        larger = self.expect_picture("larger.png", "out/beam.e", "--field=von_mises", "--scale=20", "--output=larger.png")
        self.assertNotEqual(stress.shape, larger.shape)

    def test_block_of_the_program(self):
        (self.folder / "block.xml").write_text(BLOCK)
        self.rpc("--input=block.xml", "--output=out")
        result = Result(str(self.folder / "out" / "block.e"))
        self.expect_contact(result)
        self.assertEqual(automatic_scale(result), 1)
        self.expect_picture("cut.png", "out/block.e", "--cut=x=0", "--output=cut.png")

    def expect_contact(self, result):
        """Where body and foundation touch they are drawn in one place; elsewhere the foundation lies beyond."""
        scene = Scene(result, scale=1)
        (side,) = scene.sides
        top, normals = scene._foundation(side), side.normals
        touching = result.nodal["contact_status"] > 0
        self.assertGreater(touching.sum(), 3)
        between = ((top - scene.places) * normals).sum(axis=1)
        size = result.size()
        self.assertLess(abs(between[touching]).max(), 1e-9 * size)
        self.assertGreater(between[scene.contact & ~touching].min(initial=0), -1e-9 * size)
        length = np.linalg.norm(normals, axis=1)
        self.assertLess(abs(length[scene.contact] - 1).max(), 1e-12)
        self.assertEqual(length[~scene.contact].max(), 0)
        self.assertGreater(result.nodal["penetration"][touching].max(), 1e-4)

    def test_curved_tetrahedra_seen_from_a_side_and_steps(self):
        box_file(self.folder / "box.e", "TETRA10", times=(0.5, 1.0))
        self.expect_picture("box.png", "box.e", "--time=0.5", "--field=contact_status", "--view=1,2,0.5", "--cut=y=0.5")

    def test_load_steps(self):
        history_file(self.folder / "a.history.csv")
        history_file(self.folder / "b.history.csv", top=(0, 0, 0))
        self.expect_picture("a.history.png", "a.history.csv")
        for name, tables in (("both.png", ["H = 2=a.history.csv", "b.history.csv"]), ("b.png", ["b.history.csv"])):
            self.assertEqual(self.picture(*tables, f"--output={name}"), (0, f"wrote {name}\n", ""))
            self.assertEqual(matplotlib.image.imread(self.folder / name).ndim, 3)

    def test_refusals_of_load_steps(self):
        history_file(self.folder / "a.history.csv")
        (self.folder / "old.history.csv").write_text("time,work\n1,0\n")
        (self.folder / "empty.history.csv").write_text("time,work\n")
        (self.folder / "text.history.csv").write_text("time,work\nsoon,much\n")
        self.expect_refusal_of(["none.history.csv"], '"none.history.csv": no such file', "Steps->Times")
        self.expect_refusal_of(["old.history.csv"], "no column contact_force_x", "run this version of rpc again")
        self.expect_refusal_of(["empty.history.csv"], '"empty.history.csv" has no rows')
        self.expect_refusal_of(["text.history.csv"], '"text.history.csv", column time: entries must be numbers, got "soon"')

    def test_units_of_load_steps_are_those_of_the_columns(self):
        history_file(self.folder / "plain.history.csv", max_dent=(0, 1, 1))
        text = (self.folder / "plain.history.csv").read_text()
        for name, unit in (("work", "mJ/mm"), ("contact_force_x", "N/mm"), ("max_dent", "mm")):
            text = text.replace(name, f"{name} [{unit}]")
        (self.folder / "mm.history.csv").write_text(text)
        plain, named = (history.History(Table(str(self.folder / f"{name}.history.csv"))) for name in ("plain", "mm"))
        self.assertEqual((plain.length_unit, plain.force_unit, plain.energy_unit), ("m", "N/m", "J/m"))
        self.assertEqual((named.length_unit, named.force_unit, named.energy_unit), ("mm", "N/mm", "mJ/mm"))
        self.assertEqual(named.columns, plain.columns)
        self.expect_refusal_of(["plain.history.csv", "mm.history.csv"], '"mm.history.csv"', "same units, got ", "mm] beside ")

    def test_exit_code_of_the_process(self):
        command = [sys.executable, "-B", SOURCE / "doc" / "picture" / "command_line.py", "none.e"]
        self.assertEqual(subprocess.run(command, cwd=self.folder, capture_output=True, check=False).returncode, 2)

    def test_refusals(self):
        box_file(self.folder / "box.e", "HEX8", n=1, times=(0.5, 1.0))
        box_file(self.folder / "plane.e", "TRI3", n=1)
        box_file(self.folder / "other.e", "TRI3", n=1, program="paraview")
        positions, cells = exodus_file.box("TRI3", 1)
        exodus_file.write(self.folder / "old.e", "TRI3", positions, cells,
                          {name: 0 * positions[:, 0] for name in ("disp_x", "disp_y", "gap", "dent", "penetration", "contact_status")})
        (self.folder / "text.e").write_text("no mesh")
        (self.folder / "short.e").write_bytes((self.folder / "box.e").read_bytes()[:700])
        self.expect_refusal_of([], "RESULT", "--help")
        self.expect_refusal_of(["box.e", "--colour=red"], "--colour=red", "--help")
        self.expect_refusal_of(["none.e"], '"none.e"', "no such file")
        self.expect_refusal_of(["text.e"], '"text.e" is not an Exodus file')
        self.expect_refusal_of(["short.e"], '"short.e" is not an Exodus file')
        self.expect_refusal_of(["other.e"], '"other.e" is not a file of rpc')
        self.expect_refusal_of(["old.e"], '"old.e" has no field contact_normal_x', "run this version of rpc again")
        self.expect_refusal_of(["box.e", "--field=heat"], "disp_x", "von_mises", 'got "heat"')
        for scale in ("-1", "nan", "inf", "big", ""):
            self.expect_refusal_of(["box.e", f"--scale={scale}"], "--scale must be a number >= 0", f'got "{scale}"')
        self.expect_refusal_of(["box.e", "--time=0.7"], '"box.e": --time must be one of 0.5, 1, got 0.7')
        box_file(self.folder / "many.e", "TRI3", n=1, times=np.arange(1, 31) / 10)
        self.expect_refusal_of(["many.e", "--time=0.72"], "one of 30 times from 0.1 to 3, nearest 0.7 and 0.8, got 0.72")
        self.expect_refusal_of(["plane.e", "--time=2"], "1, the only time there is, got 2")
        for window in ("0,0,1", "0,0,1,0", "1,0,0,1", "0,0,1,nan", "0,0,0,1,1,0", "a,b,c,d", ""):
            self.expect_refusal_of(["box.e", f"--window={window}"], "--window must be x0,y0,x1,y1", "x0 < x1", f'got "{window}"')
        self.expect_refusal_of(["box.e", "--window=0,0,1,1"], '"box.e": --window', "must be x0,y0,z0,x1,y1,z1 [m], got 4 numbers")
        self.expect_refusal_of(["plane.e", "--window=0,0,0,1,1,1"], '"plane.e": --window', "must be x0,y0,x1,y1 [m], got 6 numbers")
        part = "must show a part of the body"
        self.expect_refusal_of(["plane.e", "--window=3,0,4,1"], part, "0 <= x <= 1.0", "got 3 <= x <= 4", "remedy")
        self.expect_refusal_of(["box.e", "--window=0,0,3,1,1,4"], part, "0 <= z <= 1", "got 0 <= x <= 1", "remedy")
        self.expect_refusal_of(["box.e", "--cut=x"], "--cut", 'got "x"')
        self.expect_refusal_of(["box.e", "--cut=x=1"], "--cut", "0 < x < 1 m", "got 1")
        self.expect_refusal_of(["box.e", "--view=0,0,0"], "--view", "not all 0")
        self.expect_refusal_of(["plane.e", "--cut=x=0.5"], "in space")
        self.expect_refusal_of(["box.e", "--output=box.jpg"], ".png, .pdf or .svg", 'got "box.jpg"')
        self.expect_refusal_of(["box.e", "--output=none/box.png"], 'cannot write "none/box.png"', "No such file")


class Choices(RpcTestCase):
    """What is chosen where the user says nothing."""

    def result(self, displacement, gap):
        positions, cells = exodus_file.box("QUAD4", 2)
        zero = 0 * positions[:, 0]
        fields = {"disp_x": zero, "disp_y": zero + displacement, "gap": zero + gap, "dent": zero, "penetration": zero, "contact_status": zero,
                  "contact_normal_x": zero, "contact_normal_y": zero - 1}
        exodus_file.write(self.folder / "box.e", "QUAD4", positions, cells, fields)
        return Result(str(self.folder / "box.e"))

    def test_scale(self):
        for displacement, gap, scale in ((1e-3, 0, 50), (2.6e-3, 0, 10), (0.2, 0, 1), (0, 0, 1), (1e-3, 4e-3, 10), (1e-3, 9e-3, 5),
                                         (1e-3, 0.02, 1)):
            with self.subTest((displacement, gap)):
                self.assertAlmostEqual(automatic_scale(self.result(displacement, gap)) / scale, 1, delta=1e-9)

    def test_force_is_drawn_over_the_displacement_along_it(self):
        def history_of(**columns):
            history_file(self.folder / "a.history.csv", **columns)
            return history.History(Table(str(self.folder / "a.history.csv")))

        downwards, upwards = history_of(), history_of(top=(0, 0.1, 0.05), contact_force_y=(0, -9, -4))
        self.assertEqual((downwards.axis, downwards.sign, downwards.moved()), ("y", 1, [0, 0.1, 0.05]))
        self.assertEqual((upwards.axis, upwards.sign, upwards.moved()), ("y", -1, [0, 0.1, 0.05]))
        self.assertIsNone(history_of(top=(0, 0, 0)).moved())

    def test_units_are_those_of_the_file(self):
        box_file(self.folder / "box.e", "QUAD4", units={"length": "mm", "force": "N", "stress": "MPa"})
        scene = Scene(Result(str(self.folder / "box.e")))
        drawn = figure.compose(scene)
        self.addCleanup(figure.plt.close, drawn)
        names = {axes.get_xlabel() for axes in drawn.axes} | {axes.get_ylabel() for axes in drawn.axes}
        self.assertEqual(names - {""}, {"x [mm]", "y [mm]", "contact pressure [MPa]", "von Mises stress [MPa]"})
        self.assertEqual(fields.label("gap", scene.result.units), "gap [mm]")
        self.assertEqual(fields.label("disp_x", scene.result.units), "displacement in x [mm]")

    def test_dents_stay_where_nothing_touches(self):
        box_file(self.folder / "box.e", "QUAD4")
        result = Result(str(self.folder / "box.e"))
        lowest = result.contact_nodes()
        result.nodal["dent"] = np.where(lowest, 0.03, 0)
        result.nodal["penetration"] = np.where(lowest, -0.01, 0)
        for scale in (1, 5):
            scene = Scene(result, scale=scale)
            (side,) = scene.sides
            depth = ((scene._foundation(side) - result.positions) * side.normals).sum(axis=1)[lowest]
            self.assertLess(abs(depth - 0.03 * scale).max(), 1e-12)

    def test_view_turns_the_foundation_downwards_and_looks_into_the_cut(self):
        box_file(self.folder / "box.e", "HEX8")
        result = Result(str(self.folder / "box.e"))
        for towards in (1, -1):
            scene = Scene(result, cut=surface.Cut(0, 0.5, towards))
            up = figure.upwards(scene)
            self.assertEqual(list(up), [0, 0, 1])
            for level in figure.level_directions(scene, up):
                self.assertGreater(towards * level[0], 0)

    def test_cut_takes_away_the_viewers_side(self):
        for view, axis, expected in (("1,-1,1", "x", 1), ("1,-1,1", "y", -1), (None, "x", 1), (None, "z", 1)):
            box_file(self.folder / "box.e", "HEX8", n=1)
            found = command_line.options(["box.e", f"--cut={axis}=0.5", *([f"--view={view}"] if view else [])])
            self.assertEqual(command_line.cut_of(Result(str(self.folder / "box.e")), found).towards, expected, (view, axis))
        box_file(self.folder / "box.e", "HEX8", n=1, shape=lambda x: -x)  # the foundation is above, its normal is turned below
        with netCDF4.Dataset(self.folder / "box.e", "a") as file:
            names = [str(name) for name in netCDF4.chartostring(file["name_nod_var"][:])]
            variable = file[f"vals_nod_var{1 + names.index('contact_normal_z')}"]
            variable[:] = -variable[:]
        found = command_line.options(["box.e", "--cut=z=-0.5"])
        self.assertEqual(command_line.cut_of(Result(str(self.folder / "box.e")), found).towards, -1)


BEARING = {"bottom": (-1, 0.0, 5.0), "left": (0, 0.0, 2.0), "right": (0, 1.0, 3.0)}  # axis, place along it, pressure


def bearing_file(path, element, n=2, bearing=BEARING):
    """The unit square or cube at rest between foundations, pressure 5 below, 2 to the left and 3 to the right."""
    positions, cells = exodus_file.box(element, n)
    dim = positions.shape[1]
    zero = 0 * positions[:, 0]
    fields = {f"disp_{axis}": zero for axis in "xyz"[:dim]}
    fields |= {name: zero.copy() for name in ("von_mises", "contact_pressure", "gap", "dent", "penetration")}
    fields |= {"contact_status": zero - 1} | {f"contact_normal_{axis}": zero.copy() for axis in "xyz"[:dim]}
    for axis, place, pressure in sorted(bearing.values(), key=lambda side: side[2]):  # where two meet the higher pressure is shown
        on = positions[:, axis] == place
        fields["contact_pressure"][on], fields["contact_status"][on] = pressure, 1
        for d in range(dim):
            fields[f"contact_normal_{'xyz'[d]}"][on] = (2 * place - 1) * (d == axis % dim)
    exodus_file.write(path, element, positions, cells, fields)
    faces = surface.visible_faces(Result(str(path)))
    skin = surface.boundary_edges(faces) if dim == 2 else faces
    named = {"bottom": (-1, 0.0), "left": (0, 0.0), "right": (0, 1.0), "top": (-1, 1.0)}
    on_side = {name: [(face.cell[k], face.place[k]) for face in skin for k in range(len(face.cell))
                      if (positions[face.nodes[k], axis] == place).all()] for name, (axis, place) in named.items()}
    exodus_file.write(path, element, positions, cells, fields, sides=on_side)
    return Result(str(path))


class ContactSides(RpcTestCase):
    """Bodies with several contact sides."""

    def results(self, dim, **options):
        for element in ("TRI3", "TRI6", "QUAD4", "QUAD9") if dim == 2 else ("TETRA4", "HEX8", "HEX27"):
            yield bearing_file(self.folder / "box.e", element, **options)

    def test_each_has_its_foundation_and_diagram_in_the_plane(self):
        for result in self.results(2):
            scene = Scene(result)
            self.assertEqual({side.name for side in scene.sides}, set(BEARING))
            depth = scenes.THICKNESS
            for name, (axis, place, pressure) in BEARING.items():
                for layer, height in (("foundation", depth), ("contact", scenes.DIAGRAM * depth * pressure / 5)):
                    rows = scene.layers[layer]
                    away = (2 * place - 1) * (rows[..., PLACE][..., :2].mean(axis=1)[:, axis] - place)
                    self.assertAlmostEqual(abs(areas(rows[away > 0])[:, 2]).sum(), height, delta=1e-12, msg=(name, layer))
            self.assertEqual(len(np.unique(scene.layers["foundation"][..., 2].round(9))), 3)  # where they meet one covers the other
            self.assertLess(scene.layers["foundation"][..., 2].max(), scene.layers["contact"][..., 2].min())
            self.assertLess(scene.layers["contact"][..., 2].max(), 0)

    def test_each_shows_its_own_values_up_to_its_ends(self):
        for dim in (2, 3):
            for result in self.results(dim):
                for side in sides.contact_sides(result, skin_of(result)):
                    axis, place, pressure = BEARING[side.name]
                    self.assertLess(abs(side.fields["contact_pressure"][side.nodes()] - pressure).max(), 1e-9)
                    self.assertLess(abs(side.normals[side.nodes()][:, : result.dim][:, axis] - 2 * place + 1).max(), 1e-9)

    def test_each_has_a_slab_in_space_and_is_seen(self):
        for result in self.results(3):
            scene = Scene(result)
            self.assertAlmostEqual(np.linalg.norm(areas(scene.layers["ground"]), axis=1).sum(), 3, delta=1e-9)
            self.assertAlmostEqual(np.linalg.norm(areas(scene.layers["foundation"]), axis=1).sum(), 3 * 4 * scenes.THICKNESS, delta=1e-9)
            directions = [panel.view.axes[2] for panel in figure.panels(scene, None)]
            for side in scene.sides:
                self.assertTrue(any(figure.is_seen(scene, side, direction) for direction in directions), side.name)
            self.assertEqual(list(figure.upwards(scene)), [0, 0, 1])  # away from the side that bears most

    def test_a_side_between_contact_sides_is_none(self):
        between = {name: BEARING[name] for name in ("left", "right")}
        for dim in (2, 3):
            for result in self.results(dim, n=1, bearing=between):
                found = sides.contact_sides(result, skin_of(result))
                self.assertEqual({side.name for side in found}, set(between))

    def test_of_the_program(self):
        deck = BLOCK.replace('<ParameterList name="Contact">', """<ParameterList name="Contact">
          <ParameterList name="Sides"><ParameterList name="left"><Parameter name="Yield Stress" type="double" value="9"/>
          <Parameter name="Gap" type="string" value="0.001*z"/></ParameterList></ParameterList>""")
        (self.folder / "block.xml").write_text(deck)
        self.rpc("--input=block.xml", "--output=out")
        result = Result(str(self.folder / "out" / "block.e"))
        found = {side.name: side for side in sides.contact_sides(result, skin_of(result))}
        self.assertEqual(set(found), {"back", "left"})
        with open(self.folder / "out" / "block.contact.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), sum(len(side.nodes()) for side in found.values()))
        for row in rows:
            place = np.array([float(row[axis]) for axis in "xyz"])
            node = abs(result.positions - place).sum(axis=1).argmin()
            side = found[row["side"]]
            self.assertGreater(side.fields["contact_status"][node], -1)
            if row["side"] == "left":
                self.assertAlmostEqual(side.fields["gap"][node], 0.001 * place[2], delta=1e-9)
            if place[0] > -1 or place[2] > 0:  # the edge belongs to both sides
                self.assertAlmostEqual(side.fields["contact_pressure"][node], float(row["pressure"]), delta=1e-6 * 60)


def skin_of(result):
    """[Faces] of the boundary."""
    faces = surface.visible_faces(result)
    return surface.boundary_edges(faces) if result.dim == 2 else faces


class Speckle(RpcTestCase):
    """Body and foundation in one place."""

    def painted(self, scene, eye, without=()):
        window = figure.grown(view.bounds(scene, eye), 0.03)
        return view.paint(scene, eye, window, 120, figure.colorings(scene), without)

    def test_a_foundation_between_viewer_and_body_hides_nothing(self):
        for element in ("HEX8", "HEX27", "TETRA4"):
            box_file(self.folder / "box.e", element, n=3)
            result = Result(str(self.folder / "box.e"))
            result.nodal["gap"][:] = 0.02
            scene = Scene(result, scale=0)
            scene.lines = [lines for lines in scene.lines if lines.normals is not None]
            self.assertEqual(len(scene.lines), 1)
            from_below = view.view_from((0, 0, -1), (0, 1, 0))
            both, alone = self.painted(scene, from_below), self.painted(scene, from_below, view.GROUND_LAYERS)
            self.assertEqual(both.shape, alone.shape)
            inner = (slice(10, -10), slice(10, -10))  # without the rim
            self.assertLess(abs(both - alone)[inner].max(), 0.02)

    def test_where_they_coincide_the_body_is_drawn(self):
        box_file(self.folder / "box.e", "HEX27", n=3)
        scene = Scene(Result(str(self.folder / "box.e")), scale=0)
        scene.lines, rows = [], scene.layers["contact"]
        middle = rows.mean(axis=1)
        split = np.concatenate([np.stack([rows[:, k], rows[:, (k + 1) % 3], middle], axis=1) for k in range(3)])
        split[..., NORMAL] *= -1  # as if it were seen from the foundation's side
        scene.layers["ground"] = split
        eye = view.view_from((0.3, 0.2, -1), (0, 1, 0))
        with_walls = ("foundation",)
        both, alone = self.painted(scene, eye, with_walls), self.painted(scene, eye, view.GROUND_LAYERS)
        self.assertLess((abs(both - alone).max(axis=2) > 0.02).mean(), 1e-3)

    def test_rounding_errors_of_an_unloaded_body_are_not_coloured(self):
        box_file(self.folder / "box.e", "TRI3", times=(1.0, 1e-9))
        for time, largest in ((1, 1), (1e-9, 1)):
            scene = Scene(Result(str(self.folder / "box.e"), time), "von_mises")
            self.assertAlmostEqual(figure.colorings(scene)["body"][0].vmax, largest, delta=1e-9)


class Room(RpcTestCase):
    """Titles, numbers and legends cover nothing."""

    LONG = "a body with a title as long as the title of a deck can be, 60"

    def test_for_bodies_of_all_shapes(self):
        shapes = {"TRI3": ((1, 1), (1, 15), (40, 1), (3e-4, 2e-3), (7e4, 5e5)),
                  "HEX8": ((1, 1, 1), (1, 1, 12), (20, 2, 0.5), (15, 15, 1), (3e-4, 5e-4, 2e-3), (1e-3, 1e-3, 1e-4))}
        for element, sizes in shapes.items():
            for size in sizes:
                with self.subTest(f"{element} {size}"):
                    box_file(self.folder / "box.e", element, shape=lambda x, size=size: x * size, title=self.LONG, times=(0.25, 1.0))
                    self.expect_room(Scene(Result(str(self.folder / "box.e"))))

    def test_for_several_sides_windows_and_cuts(self):
        plane, space = (bearing_file(self.folder / f"{element}.e", element) for element in ("QUAD4", "HEX8"))
        self.expect_room(Scene(plane))
        self.expect_room(Scene(plane, window=np.array([(0.123, -0.02), (0.1234, 0.3)])))
        self.expect_room(Scene(space))
        self.expect_room(Scene(space, cut=surface.Cut(1, 0.5, -1), window=np.array([(0, 0, 0), (0.31, 1, 0.2)])))

    def expect_room(self, scene):
        drawn = figure.compose(scene)
        self.addCleanup(figure.plt.close, drawn)
        renderer = drawn.canvas.get_renderer()
        drawn.draw(renderer)
        texts = [(text.get_text(), text.get_window_extent(renderer)) for text in shown_texts(drawn)]
        names = [text for text, _ in texts]
        for axis in "xyz"[: scene.result.dim]:
            self.assertEqual(names.count(f"{axis} [m]"), len(figure.panels(scene, None)))
        width, height = drawn.get_size_inches() * drawn.dpi
        for k, (text, box) in enumerate(texts):
            self.assertTrue(0 <= box.x0 and box.x1 <= width and 0 <= box.y0 and box.y1 <= height, f'"{text}" leaves the picture')
            for other, beside in texts[:k]:
                self.assertFalse(overlap(box, beside), f'"{text}" covers "{other}"')
            for axes in drawn.axes:
                self.assertFalse(covers(box, axes, renderer), f'"{text}" covers a panel or a colour bar')


def shown_texts(drawn):
    """All texts that one sees."""
    found = [*drawn.texts, *(text for legend in drawn.legends for text in legend.get_texts())]
    for axes in drawn.axes:
        found += [axes.title, *axes.texts]
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            rounding = 1e-9 * (high - low)
            ticks = [tick for tick in axis.get_major_ticks() if low - rounding <= tick.get_loc() <= high + rounding]
            found += [axis.label, axis.offsetText, *(label for tick in ticks for label in (tick.label1, tick.label2))]
    return [text for text in found if text.get_visible() and text.get_text().strip()]


def overlap(a, b):
    """Whether two boxes have more than a line in common [pixels]."""
    return min(a.x1, b.x1) - max(a.x0, b.x0) > 0.5 and min(a.y1, b.y1) - max(a.y0, b.y0) > 0.5


def covers(box, axes, renderer):
    """Whether a text lies on what is drawn into axes."""
    frame = axes.get_window_extent(renderer)
    if not overlap(box, frame):
        return False
    if not axes.images:
        return axes.axison  # the names of states stand within axes that are not drawn
    image = np.asarray(axes.images[0].get_array())
    rows, columns = image.shape[:2]
    left, right = ((x - frame.x0) / frame.width * columns for x in (box.x0, box.x1))
    bottom, top = ((y - frame.y0) / frame.height * rows for y in (box.y0, box.y1))
    part = image[max(int(bottom), 0) : max(int(np.ceil(top)), 0), max(int(left), 0) : max(int(np.ceil(right)), 0), 3]
    return part.size > 0 and part.max() > 0.05


class Films(RpcTestCase):
    """Load steps on several meshes."""

    def test_the_files_of_a_run_are_one_film(self):
        box_file(self.folder / "a.e", "TRI3", n=1, times=(0.5, 1.0))
        box_file(self.folder / "a.e-s0002", "TRI3", n=2, times=(1.5,))
        box_file(self.folder / "a.e-s0003", "TRI3", n=3, times=(2.0, 2.5))
        box_file(self.folder / "a.e-s0005", "TRI3", n=4, times=(3.0,))  # of no film: the fourth is missing
        for path in ("a.e", "a.e-s0002"):
            for time, mesh in ((0.5, 1), (1, 1), (1.5, 2), (2, 3), (2.5, 3), (None, 3)):
                result = Result(str(self.folder / path), time)
                self.assertEqual((result.time, result.num_times), (time or 2.5, 5))
                self.assertEqual(len(result.positions), (mesh + 1) ** 2)
                self.assertAlmostEqual(result.nodal["contact_pressure"].max(), 3 * (time or 2.5), delta=1e-12)
        self.assertEqual(Result(str(self.folder / "a.e-s0005")).num_times, 1)
        self.assertEqual(Result(str(self.folder / "a.e")).peak("contact_pressure"), 7.5)
        with self.assertRaisesRegex(PictureError, r'a.e": --time must be one of 0.5, 1, 1.5, 2, 2.5, got 3'):
            Result(str(self.folder / "a.e-s0002"), 3)

    def test_of_the_program(self):
        deck = (SOURCE / "input" / "beam_adaptive.xml").read_text()
        steps = '<ParameterList name="Steps"><Parameter name="Times" type="Array(double)" value="{0.01, 0.5, 1}"/></ParameterList>'
        deck = deck.replace('value="0.002"', 'value="0.02"').replace("-20*sin", "-20*t*sin")
        (self.folder / "beam.xml").write_text(deck.rsplit("</ParameterList>", 1)[0] + steps + "</ParameterList>")
        self.rpc("--input=beam.xml", "--output=out")
        self.assertTrue((self.folder / "out" / "beam.e-s0002").exists())
        path = str(self.folder / "out" / "beam.e")
        first, last = Result(path, 0.01), Result(path)
        self.assertEqual((first.path, first.time, first.num_times), (path, 0.01, 3))
        self.assertEqual(last.time, 1)
        self.assertNotEqual(len(first.positions), len(last.positions))


class Windows(RpcTestCase):
    """A part, enlarged."""

    def test_in_the_plane_it_bounds_the_axes(self):
        result = bearing_file(self.folder / "box.e", "QUAD9", n=8)
        window = np.array([(-0.01, -0.02), (0.11, 0.06)])
        whole, part = Scene(result), Scene(result, window=window)
        drawn = figure.compose(part)
        self.addCleanup(figure.plt.close, drawn)
        limits = np.array([drawn.axes[0].get_xlim(), drawn.axes[0].get_ylim()]).T
        self.assertLess(abs(limits - window).max(), 1e-12)
        self.assertLess(len(part.layers["body"]), 0.1 * len(whole.layers["body"]))
        self.assertAlmostEqual(part.layers["foundation"][..., 1].min(), -0.12 * scenes.THICKNESS, delta=1e-12)

    def test_in_space_it_leaves_a_closed_box_and_what_lies_below(self):
        low, high = np.array([0.2, 0.3, 0]), np.array([0.7, 0.9, 0.45])
        a, b, c = high - low
        for element in ("TETRA4", "TETRA10", "HEX8", "HEX27"):
            with self.subTest(element):
                box_file(self.folder / "box.e", element, n=3, shape=lambda x: x)
                result = Result(str(self.folder / "box.e"))
                scene = Scene(result, scale=0, window=np.array([low, high]))
                skin = np.concatenate([scene.layers["body"], scene.layers["contact"]])
                self.assertLess((low - skin[..., PLACE]).max(), 1e-12)
                self.assertLess((skin[..., PLACE] - high).max(), 1e-12)
                self.assertEqual(skin.shape[2], LEVELS + 6)
                self.assertAlmostEqual(np.linalg.norm(areas(skin), axis=1).sum(), 2 * (a * b + b * c + c * a), delta=1e-9)
                self.assertAlmostEqual(np.linalg.norm(areas(scene.layers["ground"]), axis=1).sum(), a * b, delta=1e-9)
                above = Scene(result, scale=0, window=np.array([low + [0, 0, 0.1], high]))
                self.assertEqual((len(above.layers["ground"]), len(above.layers["foundation"])), (0, 0))

    def test_lines_end_where_the_box_ends(self):
        box_file(self.folder / "box.e", "HEX8", n=1, shape=lambda x: x)
        scene = Scene(Result(str(self.folder / "box.e")), scale=0, window=np.array([(0, 0.1, 0.2), (0.6, 1, 0.4)]))
        for lines in scene.lines:
            if lines.layer == "body":  # an edge's ends may lie on either side of the box
                found = view.dots(lines, 300 * lines.points)[0] / 300
                self.assertTrue(((found > np.array([0, 0.1, 0.2]) - 1e-9) & (found < np.array([0.6, 1, 0.4]) + 1e-9)).all())


if __name__ == "__main__":
    unittest.main()

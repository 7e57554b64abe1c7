# SPDX-License-Identifier: BSD-3-Clause
"""doc/picture.sh with friction: arrows of its traction, zones that stick and slip, loops of force against displacement."""

import csv
import unittest

import picture  # skips where Debian's modules are missing; finds those of doc/picture

import exodus_file
import figure
import friction
import history
import matplotlib.image
import numpy as np
import sides
import surface
import view
from result import Result
from rpc_run import SOURCE, RpcTestCase
from scene import Scene
from surface import PLACE
from table import Table

PLANE, SPACE = ("TRI3", "TRI6", "QUAD4", "QUAD9"), ("TETRA4", "HEX8", "HEX27")
TRACTION = np.array([3.0, 4.0, 0.0])  # on the lowest side in space; in the plane its first component


def sheared_file(path, element, n=4, sticks=0.5, **options):
    """A box whose lowest side sticks where x <= sticks and slips beyond, under the same traction everywhere."""
    positions, cells = picture.box_file(path, element, n, shape=lambda x: x)
    result = Result(str(path))
    on = result.contact_nodes()
    if element == "TETRA10":  # what the program writes: vertices are contact nodes, but carry nothing
        result.nodal["contact_status"][positions[:, 2] == 0] = 1
        result.nodal["contact_normal_z"][positions[:, 2] == 0] = -1
    axes = "xyz"[: positions.shape[1]]
    fields = result.nodal | {f"friction_{axis}": np.where(on, TRACTION[d] * (d < len(axes) - 1), 0) for d, axis in enumerate(axes)}
    fields |= {"friction_status": np.where(on, np.where(positions[:, 0] <= sticks, 1.0, 2.0), 0)}
    exodus_file.write(path, element, positions, cells, fields, **options)
    return Result(str(path))


def lines_of(scene, zone):
    """Points (n, 2, 3) of a zone's border."""
    return np.concatenate([np.empty((0, 2, 3)), *(lines.points for lines in scene.lines if lines.zone == zone)])


def labels(scene):
    """Of the legend."""
    return [handle.get_label() for handle in figure.legend_handles(scene)]


class Arrows(unittest.TestCase):
    """Their shape and number."""

    def test_from_tail_to_tip_they_are_the_vector(self):
        vectors = np.array([(0.5, 0, 0), (0, -0.2, 0), (0.03, 0.04, 0)])
        places = np.array([(0, 0, 0), (1, 1, 1), (2, 0, 1.0)])
        rows = friction.shapes(places, vectors, np.tile([0, 0, 1.0], (3, 1)), 0.5).reshape(3, 3, 3, -1)  # triangles, arrows, vertices
        tail, tip = 0.5 * (rows[0, :, 0, PLACE] + rows[1, :, 2, PLACE]), rows[2, :, 1, PLACE]
        self.assertLess(abs(tip - tail - vectors).max(), 1e-15)
        self.assertLess(abs(0.5 * (tip + tail) - places).max(), 1e-15)
        self.assertTrue((picture.areas(rows.reshape(9, 3, -1))[:, 2] > 0).all())

    def test_none_covers_another_and_small_tractions_have_none(self):
        x = np.linspace(0, 1, 200)
        places = np.stack([x, 0 * x, 0 * x], axis=1)
        tractions = np.stack([np.where(x < 0.5, 2 * x - 1, 0.01), 0 * x, 0 * x], axis=1)
        rows = friction.arrows(places, tractions, np.tile([0, 0, 1.0], (200, 1)), 1, 2, 1)
        ends = np.sort([(arrow[..., 0].min(), arrow[..., 0].max()) for arrow in rows.reshape(3, -1, 3, 7).swapaxes(0, 1)], axis=0)
        self.assertGreater(len(ends), 10)
        self.assertTrue((ends[1:, 0] > ends[:-1, 1]).all())
        self.assertGreaterEqual(ends.min(), -1e-12)
        self.assertLess(ends.max(), 0.51)

    def test_places_that_are_chosen_keep_their_distance(self):
        places = np.random.default_rng(1).random((500, 3)) * [1, 1, 0]
        chosen = friction.spread(places, 0.1)
        self.assertGreaterEqual(friction.nearest(places[chosen]), friction.CLOSEST * 0.1)
        self.assertGreater(len(chosen), 50)
        self.assertEqual(len(friction.spread(places[:1], 0.1)), 1)


class Zones(RpcTestCase):
    """What sticks and what slips, for each element."""

    expect_room = picture.Room.expect_room

    def test_in_the_plane_they_lie_below_the_diagram(self):
        for element in PLANE:
            with self.subTest(element):
                scene = Scene(sheared_file(self.folder / "box.e", element), scale=0)
                half = 0.0625 if element in ("TRI6", "QUAD9") else 0.125  # of the distance between nodes
                areas = [picture.areas(scene.layers[zone])[:, 2].sum() for zone in friction.ZONES]
                for area, length in zip(np.abs(areas), (0.5 + half, 0.5 - half)):
                    self.assertAlmostEqual(area, length * friction.RIBBON, delta=1e-12)
                self.assertLess(scene.layers["sticks"][..., 1].max(), scene.layers["contact"][..., 1].min())
                self.assertAlmostEqual(scene.layers["foundation"][..., 1].min(), scene.layers["slips"][..., 1].min(), delta=1e-12)
                arrows = scene.layers["arrows"]
                self.assertGreater(arrows[..., 2].min(), scene.layers["sticks"][..., 2].max())
                self.assertEqual(scene.shear, 3)
                self.assertEqual(labels(scene)[2:], ["sticks", "slips", "friction, of the body on the foundation: at most 3 Pa"])

    def test_in_space_they_have_borders_half_way_to_the_next_node(self):
        for element in SPACE:
            with self.subTest(element):
                scene = Scene(sheared_file(self.folder / "box.e", element), scale=0)
                half = 0.0625 if element == "HEX27" else 0.125
                for zone in friction.ZONES:
                    border = lines_of(scene, zone)
                    self.assertLess(abs(border[..., 0] - 0.5 - half).max(), 1e-12)
                    self.assertAlmostEqual(np.linalg.norm(border[:, 1] - border[:, 0], axis=1).sum(), 1, delta=1e-12)
                self.assertEqual(labels(scene)[1:], ["sticks", "slips", "friction, of the body on the foundation: at most 5 Pa"])

    def test_arrows_in_space_lie_below_the_side_along_the_traction(self):
        for element in (*SPACE, "TETRA10"):
            with self.subTest(element):
                scene = Scene(sheared_file(self.folder / "box.e", element), scale=0)
                rows = scene.layers["arrows"].reshape(3, -1, 3, 7)
                tail, tip = 0.5 * (rows[0, :, 0, PLACE] + rows[1, :, 2, PLACE]), rows[2, :, 1, PLACE]
                self.assertGreater(len(tip), 9)
                self.assertLess(abs(surface.unit(tip - tail) - TRACTION / 5).max(), 1e-12)
                self.assertLess(abs(tip[:, 2] + friction.LIFT).max(), 1e-12)
                below, above = (view.view_from(towards, (0, 1, 0)) for towards in ((0, 0, -1), (0, 0, 1)))
                self.assertEqual(len(view.seen_from(below, "arrows", scene.layers["arrows"])), rows.shape[0] * rows.shape[1])
                self.assertEqual(len(view.seen_from(above, "arrows", scene.layers["arrows"])), 0)

    def test_vertices_of_quadratic_triangles_are_those_of_their_neighbours(self):
        result = sheared_file(self.folder / "box.e", "TETRA10", sticks=1)
        (side,) = sides.contact_sides(result, picture.skin_of(result))
        self.assertEqual(side.fields["sticks"][side.nodes()].min(), 1)
        self.assertLess(abs(side.fields["traction"][side.nodes()] - TRACTION).max(), 1e-12)

    def test_one_zone_alone(self):
        for element in ("QUAD4", "HEX8"):
            for sticks, zone, other in ((2, "sticks", "slips"), (-1, "slips", "sticks")):
                scene = Scene(sheared_file(self.folder / "box.e", element, sticks=sticks))
                self.assertNotIn(other, labels(scene))
                if element == "QUAD4":  # in space the border of all that touches is that of the side
                    self.assertIn(zone, labels(scene))

    def test_without_friction_or_a_contact_field_there_are_none(self):
        for element, own in (("QUAD4", set()), ("HEX8", {"ground"})):
            result = sheared_file(self.folder / "box.e", element)
            drawn = [Scene(result, "von_mises")]
            for axis in "xyz"[: result.dim]:
                result.nodal[f"friction_{axis}"][:] = 0
            drawn.append(Scene(result))
            for scene in drawn:
                self.assertEqual(set(scene.layers) - own, {"body", "contact", "foundation"} & set(scene.layers))
                self.assertEqual([lines for lines in scene.lines if lines.zone], [])
                self.assertEqual(labels(scene)[-1], "foundation")

    def test_texts_cover_nothing(self):
        for element in ("QUAD4", "HEX8"):
            result = sheared_file(self.folder / "box.e", element, title=picture.Room.LONG, times=(0.25, 1.0))
            self.expect_room(Scene(result))
        self.expect_room(Scene(result, window=np.array([(0.1, 0.2, 0), (0.9, 0.7, 0.3)])))
        self.expect_room(Scene(sheared_file(self.folder / "box.e", "QUAD4"), window=np.array([(0.2, -0.2), (0.9, 0.1)])))


class Loops(RpcTestCase):
    """Load steps."""

    picture = picture.Pictures.picture

    def table(self, name="a", **columns):
        columns = {"dissipated_by_friction": (0, 1, 2), "contact_force_x": (0, -3, 2), **columns}
        picture.history_file(self.folder / f"{name}.history.csv", **columns)
        return Table(str(self.folder / f"{name}.history.csv"))

    def panels(self, *tables):
        """Axes that the diagram has."""
        figure_of = history.compose(tables)
        self.addCleanup(history.plt.close, figure_of)
        return figure_of.axes

    def test_friction_is_drawn_over_the_displacement_along_it(self):
        table = self.table()
        told = history.History(table)
        self.assertEqual((told.axis, told.shear(), told.moved("x")), ("y", "x", [0, 5, 0]))
        force, loop, energies = self.panels(table)
        self.assertEqual(loop.get_xlabel(), "prescribed displacement in x [m]")
        self.assertEqual(loop.lines[0].get_xydata().tolist(), [[0, 0], [0, 0], [5, 3], [0, -2]])  # of the body on the foundation
        self.assertEqual(force.get_xlabel(), "prescribed displacement [m]")
        names = [text.get_text() for text in energies.get_legend().get_texts()]
        self.assertEqual(names, ["dissipated by friction", "dissipated by yielding", "elastic, in the body", "work"])

    def test_over_time_where_nothing_is_prescribed_along_it(self):
        self.assertEqual(self.panels(self.table(top_displacement_x=(0, 0, 0)))[1].get_xlabel(), "t")

    def test_no_loop_without_friction(self):
        picture.history_file(self.folder / "plain.history.csv")
        plain = Table(str(self.folder / "plain.history.csv"))
        still = self.table(contact_force_x=(0, 1e-9, 0))
        for table in (plain, still):
            self.assertIsNone(history.History(table).shear())
            self.assertEqual(len(self.panels(table)), 2)
        names = [text.get_text() for text in self.panels(plain)[1].get_legend().get_texts()]
        self.assertEqual(names, ["dissipated", "elastic, in the body", "work"])
        self.assertEqual(len(self.panels(plain, plain)), 1)

    def test_several_are_compared(self):
        loop = self.panels(self.table(), self.table("b", contact_force_x=(0, -1, 1)))[1]
        self.assertEqual([len(line.get_xydata()) for line in loop.lines[:2]], [4, 4])
        self.assertEqual(self.picture("one=a.history.csv", "b.history.csv", "--output=both.png")[0], 0)

    def test_sides_that_squeeze_a_body_have_curves_of_their_own(self):
        squeezed = {"contact_force_x": (0, 0, 0), "contact_force_y": (0, 1e-9, -1e-9), "upper_contact_force_x": (0, 0, 0), "lower_contact_force_x": (0, 0, 0),
                    "upper_contact_force_y": (0, -9, -4), "lower_contact_force_y": (0, 9, 4)}
        force = self.panels(self.table(**squeezed))[0]
        self.assertEqual([(line.get_label(), line.get_ydata().tolist()[-2:]) for line in force.lines], [("upper, lower", [9, 4])])
        both = self.table("b", **{**squeezed, "contact_force_y": (0, 12, 5), "upper_contact_force_y": (0, 3, 1)})
        self.assertEqual([text.get_text() for text in self.panels(both)[0].get_legend().get_texts()], ["all sides", "upper", "lower"])

    def test_of_the_program(self):
        self.rpc("--input=shear.xml", "--set=Mesh->Cells={24, 12}", "--output=out")
        table = history.History(Table(str(self.folder / "out" / "shear.history.csv")))
        moved, force = table.moved("x"), [-value for value in table.columns["contact_force_x"]]
        self.assertAlmostEqual(max(moved), 0.02, delta=1e-12)
        area = sum(0.5 * (a + b) * (y - x) for x, y, a, b in zip(moved, moved[1:], force, force[1:]))
        work = dict(zip(table.columns["time"], table.columns["work"]))
        self.assertAlmostEqual(area / (work[6] - work[1]), 1, delta=0.01)
        result = Result(str(self.folder / "out" / "shear.e"), 1.5)
        scene = Scene(result)
        self.assertAlmostEqual(scene.shear, 0.3 * 20, delta=1e-6)
        self.assertEqual(set(labels(scene)) & set(friction.ZONES), set(friction.ZONES))
        for arguments in (("out/shear.e", "--time=1.5"), ("out/shear.history.csv",)):
            self.assertEqual(self.picture(*arguments)[0], 0)
        self.assertEqual(matplotlib.image.imread(self.folder / "out" / "shear.history.png").ndim, 3)

    def test_the_ring_of_a_ball_is_that_of_cattaneo_and_mindlin(self):
        for suffix in ("xml", "geo"):
            (self.folder / f"ball_friction.{suffix}").write_text((SOURCE / "input" / f"ball_friction.{suffix}").read_text())
        self.rpc("--input=ball_friction.xml", "--set=Mesh->Size Factor=1.5", "--output=out")
        with open(self.folder / "out" / "ball_friction.history.csv", newline="") as file:
            last = {name: float(value) for name, value in list(csv.DictReader(file))[-1].items() if name != "reason"}
        contact = last["stick_area"] + last["slip_area"]
        expected = (1 + last["contact_force_x"] / (0.3 * last["contact_force_z"])) ** (1 / 3)
        self.assertAlmostEqual((last["stick_area"] / contact) ** 0.5, expected, delta=0.04)
        border = lines_of(Scene(Result(str(self.folder / "out" / "ball_friction.e")), scale=0), "sticks")
        radius = np.linalg.norm(border[..., :2], axis=2) / np.sqrt(2 * contact / np.pi)
        self.assertAlmostEqual(radius.mean(), expected, delta=0.05)
        self.assertLess(np.ptp(radius), 0.35)


if __name__ == "__main__":
    unittest.main()

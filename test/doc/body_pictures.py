# SPDX-License-Identifier: BSD-3-Clause
"""doc/picture.sh of bodies: views along axes, enlarged displacements, states, styles, PDF and SVG, damaged files; how they look."""

import dataclasses
import random
import unittest
import xml.etree.ElementTree

import picture  # skips where Debian's modules are missing; finds those of doc/picture

import command_line
import exodus_file
import fields
import figure
import friction_pictures
import matplotlib.image
import numpy as np
import panels
import references
import scene as scenes
import style
import view
from result import PictureError, Result
from rpc_run import RpcTestCase
from scene import Scene, sunk_of
from surface import PLACE, VALUE

style.STYLES |= {name: dataclasses.replace(one, dpi=40) for name, one in style.STYLES.items()}
STATES = (0.0, 1.0, 2.0)
PICTURE, REFUSAL = picture.Pictures.picture, picture.Pictures.expect_refusal_of


def states_file(path, element, n=4):
    """A box of which the lowest side is open where x < 0.3, yields where x > 0.7 and is closed between."""
    picture.box_file(path, element, n, shape=lambda x: x)
    result = Result(str(path))
    x = result.positions[:, 0]
    result.nodal["contact_status"] = np.where(result.nodal["contact_status"] < 0, -1, np.where(x < 0.3, 0, np.where(x > 0.7, 2, 1)))
    return result


def round_file(path, pressed=0.02):
    """A box whose lowest side is round, y = 0.4 x^2, pressed by `pressed` on the plane y = 0: it touches where 0.4 x^2 < pressed."""
    positions, cells = exodus_file.box("QUAD9", 12)
    positions = (positions - [0.5, 0]) * [2, 1]
    side = positions[:, 1] == 0
    positions[:, 1] += (1 - positions[:, 1]) * 0.4 * positions[:, 0] ** 2
    down = np.where(side, np.minimum(pressed, 0.4 * positions[:, 0] ** 2), pressed)
    zero, touching = 0 * down, side & (down < pressed)
    exodus_file.write(path, "QUAD9", positions, cells,
                      {"disp_x": zero, "disp_y": -down, "von_mises": zero, "contact_pressure": np.where(touching, 1, 0), "dent": zero,
                       "gap": np.where(side, positions[:, 1], 0), "penetration": np.where(side, down - positions[:, 1], 0),
                       "contact_status": np.where(side, 1.0 * touching, -1), "contact_normal_x": zero, "contact_normal_y": np.where(side, -1.0, 0)})
    return Result(str(path))


def between(scene):
    """(drawn distance of the foundation from the body, true distance) at the nodes of the contact side, and its foundation's places."""
    (side,) = scene.sides
    nodes, places = side.nodes(), scene._foundation(side)
    drawn = ((places - scene.places) * side.normals).sum(axis=1)
    moved = (scene.result.vector("disp_") * side.normals).sum(axis=1)
    return drawn[nodes], (side.fields["gap"] + sunk_of(side) - moved)[nodes], places[nodes]


class Scales(RpcTestCase):
    """Enlarged displacements: contact stays contact, gaps stay as they are."""

    def test_they_touch_in_the_picture_where_they_touch(self):
        for scale in (1, 2, 10, 50):
            drawn, true, _ = between(Scene(round_file(self.folder / "round.e"), scale=scale))
            touching = true < 1e-12
            self.assertGreater(touching.sum(), 4)
            self.assertLess(abs(drawn[touching]).max(), 1e-12, scale)
            self.assertTrue((drawn[~touching] >= np.minimum(true[~touching], scenes.APART * 2) - 1e-12).all(), scale)

    def test_the_true_scale_shows_the_true_foundation(self):
        drawn, true, places = between(Scene(round_file(self.folder / "round.e"), scale=1))
        self.assertLess(abs(drawn - true).max(), 1e-12)
        self.assertLess(abs(places[:, 1]).max(), 1e-12)

    def test_the_foundation_stays_in_its_place_where_the_body_leaves_room(self):
        result = round_file(self.folder / "round.e")
        for scale in (0, 0.5, 2, 5):
            scene = Scene(result, scale=scale)
            _, _, places = between(scene)
            bent = abs(places[:, 1]) > 1e-12
            self.assertTrue((places[:, 1] <= 1e-12).all())
            x = abs(places[:, 0])
            self.assertFalse(bent[x > 0.6].any(), scale)  # there is a gap of more than the enlarged displacement
            self.assertEqual(bent.any(), scale > 1)

    def test_a_flat_foundation_stays_flat_below_a_body_that_lifts_off(self):
        picture.box_file(self.folder / "box.e", "QUAD4")
        result = Result(str(self.folder / "box.e"))
        result.nodal["disp_y"] = 0.01 * result.positions[:, 0]
        lowest = result.contact_nodes()
        result.nodal["penetration"] = np.where(lowest, -result.nodal["disp_y"], 0)
        _, _, places = between(Scene(result, scale=20))
        self.assertLess(abs(places[:, 1]).max(), 1e-12)

    def test_overlaps_of_the_undeformed_body_are_undone_by_displacements(self):
        picture.box_file(self.folder / "box.e", "QUAD4")
        result = Result(str(self.folder / "box.e"))
        lowest = result.contact_nodes()
        result.nodal["gap"] = np.where(lowest, -0.02, 0)
        result.nodal["disp_y"][:] = 0.02
        for scale in (1, 10):
            drawn, _, _ = between(Scene(result, scale=scale))
            self.assertLess(abs(drawn).max(), 1e-12)

    def test_titles_speak_of_displacements_alone(self):
        parts = figure.title_parts(Scene(round_file(self.folder / "round.e"), scale=5))
        self.assertEqual(parts[-1], "displacements \u00d7 5")

    def test_how_it_looks(self):
        result = round_file(self.folder / "round.e")
        for scale in (1, 3):
            references.expect_like(self, painted(Scene(result, scale=scale), view.FRONT), f"round_{scale}")


def painted(scene, eye, kind=style.LIGHT, without=()):
    """The body as a small picture (rows, columns, 3)."""
    window = figure.grown(view.bounds(scene, eye, without), 0.03)
    pixels = 120 / max(window[1] - window[0], window[3] - window[2])
    return references.on_background(view.paint(scene, eye, window, pixels, figure.colorings(scene, kind), without, kind), kind.background)


class Views(RpcTestCase):
    """Directions to the viewer."""

    def test_along_axes_the_picture_has_an_upright_axis(self):
        picture.box_file(self.folder / "box.e", "HEX8", n=1)
        scene = Scene(Result(str(self.folder / "box.e")))
        for axis in range(3):
            for sign in (1, -1):
                towards = sign * np.eye(3)[axis]
                (panel,) = figure.panels(scene, towards)
                right, up, viewer = panel.view.axes
                self.assertEqual(viewer.tolist(), towards.tolist())
                self.assertEqual(up.tolist(), [0, 1, 0] if axis == 2 else [0, 0, 1])
                self.assertLess(abs(np.cross(up, towards) - right).max(), 1e-15)
        drawn = figure.compose(scene, towards)
        self.addCleanup(figure.plt.close, drawn)
        self.assertEqual([text.get_text() for text in drawn.axes[0].texts if "[" in text.get_text()], ["x [m]", "y [m]"])

    def test_close_to_an_axis_too(self):
        up = np.eye(3)[2]
        for towards in ((0, 0, 1), (1e-9, 0, 1), (1e-5, 0, 1), (0, 1, 1e-9)):
            axes = view.view_from(towards, panels.upright(towards, up)).axes
            self.assertLess(abs(axes @ axes.T - np.eye(3)).max(), 1e-12)

    def test_lengths_of_directions_do_not_matter(self):
        for direction in ("0,0,1", "0,0,1e-320", "0,0,1e300"):
            self.assertEqual(command_line.options(["box.e", f"--view={direction}"]).view, (0, 0, 1))


class States(RpcTestCase):
    """Fields of categories."""

    def test_each_place_has_the_state_of_the_node_next_to_it(self):
        for element in exodus_file.NODES:
            with self.subTest(element):
                scene = Scene(states_file(self.folder / "box.e", element), "contact_status")
                rows = scene.layers["contact"]
                self.assertTrue(set(np.unique(rows[..., VALUE])) <= set(STATES))
                self.assertEqual(np.ptp(rows[..., VALUE], axis=1).max(), 0)
                middle = rows[..., PLACE].mean(axis=1)[:, 0]
                value = rows[:, 0, VALUE]
                self.assertLess(middle[value == 0].max(), 0.5)
                self.assertGreater(middle[value == 2].min(), 0.5)
                self.assertEqual(scene.states("contact_status"), [0, 1, 2])

    def test_nothing_lies_between_open_and_yielding(self):
        result = states_file(self.folder / "box.e", "HEX8")
        result.nodal["contact_status"] = np.where(result.contact_nodes(), np.where(result.positions[:, 0] < 0.4, 0, 2), -1)
        scene = Scene(result, "contact_status")
        self.assertEqual(set(np.unique(scene.layers["contact"][..., VALUE])), {0, 2})
        drawn = figure.compose(scene)
        self.addCleanup(figure.plt.close, drawn)
        names = [text.get_text() for axes in drawn.axes for text in axes.texts]
        self.assertEqual([name for name in fields.CATEGORIES["contact_status"] if name in names], ["open", "yielding"])

    def test_fields_of_friction_are_drawn_on_the_contact_sides(self):
        for element in ("QUAD9", "HEX8"):
            result = friction_pictures.sheared_file(self.folder / "box.e", element)
            for name, least, most in (("friction_status", 1, 2), ("friction_x", 3, 3)):
                scene = Scene(result, name)
                self.assertEqual((scene.contact_field, scene.body_field), (name, "von_mises"))
                rows = scene.layers["contact"]
                self.assertEqual((rows[..., VALUE].min(), rows[..., VALUE].max()), (least, most))
            result.nodal["friction_x"] *= -1
            if element == "QUAD9":  # what points to the left has a diagram too
                self.assertGreater(abs(picture.areas(Scene(result, "friction_x").layers["contact"])).sum(), 0.01)

    def test_texts_cover_nothing(self):
        picture.Room.expect_room(self, Scene(states_file(self.folder / "box.e", "QUAD4"), "contact_status"))
        picture.Room.expect_room(self, Scene(friction_pictures.sheared_file(self.folder / "box.e", "HEX8"), "friction_status"))

    def test_how_they_look(self):
        below = view.view_from((0.3, -0.5, -1), (0, 0, 1))
        for kind in style.STYLES.values():
            plane = states_file(self.folder / "plane.e", "QUAD9")
            references.expect_like(self, painted(Scene(plane, "contact_status", 1), view.FRONT, kind), f"states_{kind.name}")
            space = friction_pictures.sheared_file(self.folder / "space.e", "HEX8")
            references.expect_like(self, painted(Scene(space, "friction_status", 0), below, kind, view.GROUND_LAYERS), f"friction_{kind.name}")

    def test_sizes_of_cells(self):
        for element in exodus_file.NODES:
            dim = exodus_file.dim(element)
            positions, cells = picture.box_file(self.folder / "box.e", element, n=2, shape=lambda x: x)
            sizes = Result(str(self.folder / "box.e")).cell_sizes()
            self.assertAlmostEqual((sizes**dim).sum(), 1, delta=1e-12, msg=element)
            self.assertLess(np.ptp(sizes), 1e-12)
        scene = Scene(Result(str(self.folder / "box.e")), "cell_size")
        self.assertAlmostEqual(scene.layers["body"][..., VALUE].min(), sizes[0], delta=1e-12)

    def test_the_error_of_the_cells(self):
        for element in ("TRI6", "HEX8"):
            _, cells = picture.box_file(self.folder / "plain.e", element, n=2, shape=lambda x: x)
            error = 10.0 ** -np.arange(len(cells))
            picture.box_file(self.folder / "box.e", element, n=2, shape=lambda x: x, cell={fields.ERROR: error})
            result = Result(str(self.folder / "box.e"))
            scene = Scene(result, fields.ERROR)
            rows = scene.layers["body"]
            self.assertEqual(len(np.unique(rows[..., VALUE], axis=0)), len(np.unique(rows[:, :1, VALUE])))  # one value a cell
            self.assertEqual(set(np.unique(rows[..., VALUE])), set(error), element)
            norm, _ = figure.colorings(scene)["body"]
            self.assertEqual((norm.vmin, norm.vmax), (1e-3, 1))  # decades below have the lowest colour
            self.assertEqual(norm(error[-1]), 0)
            self.assertEqual(fields.label(fields.ERROR, result.units), "estimated error of the cells [\u221aJ]")


class Files(RpcTestCase):
    """What is written, what is refused."""

    picture = PICTURE
    expect_refusal_of = REFUSAL

    def test_endings_tell_the_kind(self):
        picture.box_file(self.folder / "box.e", "QUAD4")
        for name, begin in (("a.png", b"\x89PNG"), ("a.PDF", b"%PDF"), ("a.svg", b"<?xml")):
            written = []
            for _ in range(2 if name == "a.svg" else 1):
                self.assertEqual(self.picture("box.e", f"--output={name}"), (0, f"wrote {name}\n", ""))
                written.append((self.folder / name).read_bytes())
            self.assertTrue(written[0].startswith(begin), name)
            self.assertEqual(written[0], written[-1], name)
        svg = xml.etree.ElementTree.parse(self.folder / "a.svg")
        self.assertEqual(len(svg.findall(".//{*}image")), 1 + 2)  # the body, two colour bars
        for name in ("a.jpg", "a", "a.svgz", "png"):
            self.expect_refusal_of(["box.e", f"--output={name}"], "--output must end in .png, .pdf or .svg", f'got "{name}"')
        self.expect_refusal_of(["box.e", "--output=none/a.pdf"], 'cannot write "none/a.pdf"', "No such file")

    def test_styles_have_their_backgrounds(self):
        picture.box_file(self.folder / "box.e", "HEX8", n=1)
        for name, background in (("light", 1), ("dark", 0.09), ("print", 1)):
            self.assertEqual(self.picture("box.e", f"--style={name}", "--output=a.png")[0], 0)
            image = matplotlib.image.imread(self.folder / "a.png")[..., :3]
            self.assertAlmostEqual(image[0, 0].mean(), background, delta=0.02)
            coloured = (np.ptp(image, axis=2) > 0.1).mean()
            self.assertEqual(coloured < 0.001, name == "print", name)
        for name in ("", "Dark", "blue"):
            self.expect_refusal_of(["box.e", f"--style={name}"], "--style must be light, dark or print", f'got "{name}"')

    def test_refusals(self):
        picture.box_file(self.folder / "box.e", "HEX8", n=1)
        picture.box_file(self.folder / "plane.e", "TRI3", n=1)
        (self.folder / "empty.e").write_bytes(b"")
        (self.folder / "folder.e").mkdir()
        self.expect_refusal_of(["empty.e"], '"empty.e" is not an Exodus file')
        self.expect_refusal_of(["folder.e"], '"folder.e": no such file')
        self.expect_refusal_of(["box.e", "--field=von_misses"], '"box.e": --field', "(did you mean von_mises?)")
        self.expect_refusal_of(["box.e", "--field="], '"box.e": --field must be one of disp_x', 'got ""')
        self.expect_refusal_of(["box.e", "plane.e"], "one at a time, got 2 files")
        self.expect_refusal_of(["box.e", "a.contact.csv"], 'got "box.e" beside "a.contact.csv"')
        for option in ("columns=gap", "over=x", "range=0,1"):
            self.expect_refusal_of(["box.e", f"--{option}"], f'"box.e": --{option.split("=")[0]} does not go with it')
        for scale in ("1e9", "1e300"):
            self.expect_refusal_of(["box.e", f"--scale={scale}"], '"box.e": --scale must be at most 5.77e+04, which moves the body by 1000 times')
        for sizes in ("0,0,1e-9,1e-9", "0,0,1e-300,1", "-1e300,-1,1e300,1", "0,0,1,0.0005"):
            self.expect_refusal_of(["plane.e", f"--window={sizes}"], '"plane.e": --window must have sides between 1e-06 and 1e+03 m')
        for text in ("0,0,0", "1,2", "1,2,3,4", "a,b,c", "nan,0,1", "1e400,0,0", ""):
            self.expect_refusal_of(["box.e", f"--view={text}"], "--view must be three numbers", f'got "{text}"')
        for text in ("x", "x=", "w=0", "x=nan", "0"):
            self.expect_refusal_of(["box.e", f"--cut={text}"], "--cut must be an axis and a number", f'got "{text}"')
        for text in ("", "soon", "nan"):
            self.expect_refusal_of(["box.e", f"--time={text}"], "--time must be a number", f'got "{text}"')

    def test_damaged_files_end_in_one_line(self):
        picture.box_file(self.folder / "box.e", "QUAD4", n=1)
        sound = (self.folder / "box.e").read_bytes()
        chance, refused = random.Random(5), 0
        for _ in range(40):
            damaged = bytearray(sound)
            for _ in range(chance.choice((1, 4))):
                damaged[chance.randrange(8, min(len(sound), 2200))] = chance.randrange(256)
            (self.folder / "damaged.e").write_bytes(damaged)
            try:
                Scene(Result(str(self.folder / "damaged.e")))
            except PictureError as error:
                self.assertEqual(len(str(error).splitlines()), 1)
                refused += 1
        self.assertGreater(refused, 10)

    def test_meshes_that_do_not_fit_are_refused(self):
        positions, cells = exodus_file.box("QUAD4", 1)
        nodal = dict.fromkeys(("disp_x", "disp_y", "von_mises"), 0 * positions[:, 0])
        for change, text in (({"cells": cells + 7}, "a cell has a node that the mesh has not"),
                             ({"positions": positions * np.nan}, "nodes without a place"),
                             ({"element": "TRI3"}, "cells of TRI3 have another number of nodes"),
                             ({"element": "TETRA4"}, "cells of TETRA4 in 2 dimensions"),
                             ({"nodal": {**nodal, "disp_x": positions[:, 0] * np.nan}}, "disp_x has entries that are no numbers"),
                             ({"sides": {"left": [(9, 0)]}}, "side left has a facet of a cell that the mesh has not")):
            given = {"element": "QUAD4", "positions": positions, "cells": cells, "nodal": nodal, **change}
            exodus_file.write(self.folder / "box.e", **given)
            self.expect_refusal_of(["box.e"], '"box.e" is damaged: ', text, "remedy: run rpc again")


if __name__ == "__main__":
    unittest.main()

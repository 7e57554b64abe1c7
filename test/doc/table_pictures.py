# SPDX-License-Identifier: BSD-3-Clause
"""doc/picture.sh of tables: contact sides, columns of load steps, several files; what it refuses; how they look."""

import contextlib
import dataclasses
import importlib.util
import io
import json
import math
import re
import unittest

import picture  # skips where Debian's modules are missing; finds those of doc/picture

import command_line
import curves
import numpy as np
import references
import style
from rpc_run import SOURCE, RpcTestCase
from table import Table

SPEC = importlib.util.spec_from_file_location("page", SOURCE / "doc" / "figures" / "pictures.py")
page = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(page)
style.STYLES |= {name: dataclasses.replace(one, dpi=40) for name, one in style.STYLES.items()}
PICTURE, REFUSAL = picture.Pictures.picture, picture.Pictures.expect_refusal_of
N = 41


def contact_file(path, reach=0.5, yields=math.inf, units=False, sides=("bottom",), **more):
    """Points along the plane, -1 <= x <= 1, under Hertz's pressure where |x| < reach."""
    rows = []
    for side in sides:
        for k in range(N):
            x = -1 + 2 * k / (N - 1)
            p = min(10 * math.sqrt(max(1 - (x / reach) ** 2, 0)), yields)
            state = "open" if p == 0 else "yielding" if p == yields else "closed"
            rows.append({"x": x, "y": 0, "s": x + 1, "u_nu": 0.1, "gap": 0.4 * x * x, "pressure": p, "state": state, "side": side, "dent": 0} |
                        {name: value(x) for name, value in more.items()})
    heading = {"x": "x [mm]", "gap": "gap [mm]", "pressure": "pressure [MPa]"} if units else {}
    lines = [",".join(heading.get(name, name) for name in rows[0])] + [",".join(map(str, row.values())) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return Table(str(path))


def space_file(path):
    """Points of a quarter of the plane z = 0, of which some have no weight."""
    lines = ["x,y,z,area,u_nu,gap,pressure,state,side,dent,q_x,q_y,q_z,friction_state"]
    for x in np.linspace(0, 1, 9):
        for y in np.linspace(0, 1, 9):
            p = max(1 - x * x - y * y, 0)
            lines.append(f"{x},{y},{0.01 * x * x},{int(x > 0)},0,0,{p},{'closed' if p else 'open'},skin,0,{0.3 * p},{0.4 * p},0,{'sticks' if p else 'none'}")
    path.write_text("\n".join(lines) + "\n")
    return Table(str(path))


def summary_file(path, **more):
    """Of a run with two meshes."""
    meshes = [{"dofs": dofs, "relative_estimate": error, "energy_J": 2, "contact_force": [0, force], "max_pressure": None, "linear_iterations": [1, 2],
               "seconds": 0.5} for dofs, error, force in ((100, 0.1, 3), (1000, 0.02, 4))]
    path.write_text(json.dumps({"rpc_version": "1", "units": {"length": "mm", "force": "N/mm", "stress": "MPa", "energy": "mJ/mm"},
                                "adaptation": {"target": 0.03, "cycles": meshes}, **more}))
    return Table(str(path)) if not more else None


def points_file(path, points, times=(1, 2)):
    """Results at points on x, {name: [x, ...]}, along the plane's side y = 0 where |x| < 1."""
    lines = ["time,name,number,x [mm],y [mm],s [mm],off [mm],disp_x [mm],disp_y [mm],von_mises [MPa],contact_pressure [MPa]"]
    for time in times:
        for name, places in points.items():
            lines += [f"{time},{name},{k + 1},{x},0,{x - places[0]},0,0,{-time * x},{5 + x},{time * x if x < 1 else 'nan'}" for k, x in enumerate(places)]
    path.write_text("\n".join(lines) + "\n")
    return Table(str(path))


class Diagrams(RpcTestCase):
    """What they show."""

    picture = PICTURE

    def compose(self, tables, columns=None, over=None, span=None, kind=style.LIGHT):
        drawn = curves.compose(tables, columns, over, span, kind)
        self.addCleanup(curves.plt.close, drawn)
        return drawn

    def test_pressure_and_state_along_the_surface(self):
        pressure, state = self.compose([contact_file(self.folder / "a.contact.csv", yields=8)]).axes
        self.assertEqual((pressure.get_ylabel(), state.get_xlabel()), ("contact pressure [Pa]", "length along the surface [m]"))
        self.assertEqual(pressure.lines[0].get_ydata().max(), 8)
        self.assertEqual([label.get_text() for label in state.get_yticklabels()], ["open", "closed", "yielding"])
        self.assertEqual(sorted(set(state.lines[0].get_ydata())), [0, 1, 2])
        self.assertIsNone(pressure.get_legend())

    def test_over_a_coordinate_or_the_radius(self):
        table = contact_file(self.folder / "a.contact.csv")
        (axes,) = self.compose([table], ["pressure"], "x").axes
        self.assertEqual((axes.get_xlabel(), axes.lines[0].get_xdata().min()), ("x [m]", -1))
        (axes,) = self.compose([table], ["pressure"], "radius").axes
        self.assertEqual((axes.get_xlabel(), axes.lines[0].get_xdata().min()), ("radius |x| [m]", 0))
        (axes,) = self.compose([space_file(self.folder / "b.contact.csv")], ["friction"]).axes
        self.assertEqual(axes.get_xlabel(), r"radius $\sqrt{x^2 + y^2}$ [m]")
        x, friction = axes.lines[0].get_data()
        self.assertEqual(len(x), 72)  # points without weight are left out
        self.assertLess(abs(friction - 0.5 * np.maximum(1 - x**2, 0)).max(), 1e-12)
        self.assertEqual(axes.lines[0].get_linestyle(), "None")

    def test_the_radius_begins_where_contact_has_its_middle(self):
        def pressed(low, high, at, reach):
            """A square of points, pressed within `reach` of a point."""
            lines = ["x,y,z,area,u_nu,gap,pressure,state,side"]
            for x in np.linspace(low, high, 21):
                for y in np.linspace(low, high, 21):
                    lines.append(f"{x},{y},0,1,0,0,{max(1 - ((x - at[0])**2 + (y - at[1])**2) / reach**2, 0)},closed,skin")
            (self.folder / "a.contact.csv").write_text("\n".join(lines) + "\n")
            return Table(str(self.folder / "a.contact.csv"))
        for low, high, at, reach in ((0, 2, (1, 1), 0.45),    # a whole body aside of the origin
                                     (0, 2, (0, 0), 0.45),    # a quarter
                                     (3, 5, (3, 4), 0.45),    # half of one, aside of the origin
                                     (-1, 1, (0, 0), 9),      # all is pressed
                                     (0, 1, (0, 0), 9)):      # all of a quarter
            table = pressed(low, high, at, reach)
            np.testing.assert_allclose(table.radius_centre(table.radius_axes()), at, atol=1e-12, err_msg=f"{low} {at} {reach}")
        table = pressed(0, 2, (1, 1), 0.45)
        (axes,) = self.compose([table], ["pressure"], "radius").axes
        self.assertEqual(axes.get_xlabel(), r"radius $\sqrt{(x - 1)^2 + (y - 1)^2}$ [m]")
        points = axes.collections[0].get_offsets() if axes.collections else axes.lines[0].get_xydata()
        self.assertAlmostEqual(points[np.argmax(points[:, 1]), 0], 0, delta=1e-12)
        (axes,) = curves.compose([table], ["pressure"], "radius", None, style.LIGHT, [0.5, 0]).axes
        self.assertEqual(axes.get_xlabel(), r"radius $\sqrt{(x - 0.5)^2 + y^2}$ [m]")
        curves.plt.close(axes.figure)
        self.assertEqual(self.picture("a.contact.csv", "--centre=0.9,-1", "--output=a.png"), (0, "wrote a.png\n", ""))

    def test_derived_columns(self):
        table = contact_file(self.folder / "a.contact.csv", units=True, q_x=lambda x: -x)
        self.assertLess(abs(table.columns["penetration"] - 0.1 + table.columns["gap"]).max(), 1e-12)
        self.assertEqual(table.columns["friction"].tolist(), abs(table.columns["x"]).tolist())
        self.assertEqual((table.name_of("pressure"), table.name_of("radius", ("x",))), ("contact pressure [MPa]", "radius |x| [mm]"))

    def test_points_along_lines_at_a_time(self):
        table = points_file(self.folder / "a.points.csv", {"left": np.linspace(0, 0.5, 11), "far": np.linspace(2, 3, 5)})
        pressure, stress = self.compose([table]).axes
        self.assertEqual((pressure.get_ylabel(), stress.get_ylabel(), stress.get_xlabel()),
                         ("contact pressure [MPa]", "von Mises stress [MPa]", "length along the line [mm]"))
        self.assertEqual(pressure.lines[0].get_ydata()[-1], 1)  # of the last time
        self.assertTrue(np.isnan(pressure.lines[1].get_ydata()).all())
        self.assertEqual([text.get_text() for text in pressure.get_legend().get_texts()], ["left", "far"])
        first = curves.compose([table], ["disp_y"], None, None, style.LIGHT, time=1)
        self.assertEqual(first.axes[0].lines[0].get_ydata()[-1], -0.5)
        curves.plt.close(first)
        self.assertEqual(self.picture("a.points.csv", "--time=1", "--output=a.png"), (0, "wrote a.png\n", ""))

    def test_points_over_the_time(self):
        table = points_file(self.folder / "a.points.csv", {"tip": [0.25], "heel": [0.75]}, (1, 2, 3))
        pressure, stress = self.compose([table]).axes
        self.assertEqual((stress.get_xlabel(), pressure.lines[0].get_ydata().tolist(), len(pressure.lines)), ("t", [0.25, 0.5, 0.75], 2))
        table = points_file(self.folder / "b.points.csv", {"tip": [0.25, 2]}, (1,))
        self.assertEqual(self.compose([table], over="time").axes[0].lines[1].get_label(), "tip 2")

    def test_dents_are_shown_where_they_alone_are_left(self):
        pressed = contact_file(self.folder / "a.contact.csv", dent=lambda x: 0.1)
        left = contact_file(self.folder / "b.contact.csv", reach=1e-9, yields=0, dent=lambda x: 0.1)
        never = contact_file(self.folder / "c.contact.csv", reach=1e-9, yields=0)
        shown = [curves.chosen_columns(tables) for tables in ([pressed], [left], [never], [pressed, left])]
        self.assertEqual(shown, [["pressure", "state"], ["dent", "state"], ["pressure", "state"], ["pressure", "state"]])

    def test_with_friction_what_sticks_is_shown(self):
        self.assertEqual(curves.chosen_columns([space_file(self.folder / "a.contact.csv")]), ["pressure", "friction", "state", "friction_state"])

    def test_sides_are_lines_of_their_own(self):
        table = contact_file(self.folder / "a.contact.csv", sides=("left", "right"))
        axes = self.compose([table]).axes[0]
        self.assertEqual([len(line.get_xdata()) for line in axes.lines], [N, N])
        self.assertEqual(axes.get_xlabel() or self.compose([table]).axes[-1].get_xlabel(), "x [m]")

    def test_a_range_fills_the_panel(self):
        axes = self.compose([contact_file(self.folder / "a.contact.csv")], ["gap"], "x", (-0.5, 0)).axes[0]
        self.assertEqual(axes.get_xlim(), (-0.5, 0))
        self.assertAlmostEqual(axes.get_ylim()[1], 1.05 * 0.1, delta=1e-9)

    def test_columns_of_load_steps(self):
        picture.history_file(self.folder / "a.history.csv", max_dent=(0, 0.1, 0.1), reason=("", "", ""))
        table = Table(str(self.folder / "a.history.csv"))
        dent, force = self.compose([table], ["max_dent", "contact_force_y"]).axes
        self.assertEqual((dent.get_ylabel(), force.get_ylabel(), force.get_xlabel()), ("max dent [m]", "contact force in y [N/m]", "t"))
        self.assertEqual(dent.lines[0].get_data()[1].tolist(), [0, 0.1, 0.1])
        (axes,) = self.compose([table], ["work"], "max_dent").axes
        self.assertEqual((axes.get_ylabel(), axes.get_xlabel()), ("work [J/m]", "max dent [m]"))

    def test_estimated_errors_over_the_meshes(self):
        table = summary_file(self.folder / "a.json")
        (axes,) = self.compose([table]).axes
        self.assertEqual((axes.get_xscale(), axes.get_yscale(), axes.get_ylabel()), ("log", "log", "estimated relative error"))
        self.assertEqual(axes.lines[0].get_xydata().tolist(), [[100, 0.1], [1000, 0.02]])
        self.assertEqual(list(axes.lines[1].get_ydata()), [0.03, 0.03])
        (axes,) = self.compose([table], ["contact_force_y"], "seconds").axes
        self.assertEqual((axes.get_ylabel(), axes.get_xlabel()), ("contact force in y [N/mm]", "wall-clock time [s]"))
        self.assertEqual(self.picture("a.json"), (0, "wrote a.adaptation.png\n", ""))

    def test_pressures_of_a_rough_contact(self):
        told = {"rpc_version": "1", "units": {"stress": "MPa"},
                "contact_patches": {"low": {"pressure_histogram": {"ends": [0, 1, 2], "sizes": [3, 1]}}, "high": {"pressure_histogram": {"ends": [0, 2, 4], "sizes": [1, 5]}}}}
        (self.folder / "a.json").write_text(json.dumps(told))
        (axes,) = self.compose([Table(str(self.folder / "a.json"))]).axes
        self.assertEqual((axes.get_ylabel(), axes.get_xlabel()), ("share of what is in contact", "contact pressure [MPa]"))
        self.assertEqual(axes.lines[0].get_xydata().tolist(), [[0, 0.5], [2, 0.5], [2, 0.5], [4, 0.5]])  # all of "low" is in the first bin of "high"
        self.assertEqual(self.picture("a.json"), (0, "wrote a.patches.png\n", ""))

    def test_of_the_program(self):
        self.rpc("--input=shear.xml", "--set=Mesh->Cells={12, 6}", "--output=out")
        self.rpc("--input=beam_adaptive.xml", "--set=Adapt->Target Relative Error=0.02", "--output=out")
        for name in ("shear.contact.csv", "shear.history.csv", "beam_adaptive.contact.csv", "beam_adaptive.json"):
            self.assertEqual(self.picture(f"out/{name}", "--output=a.png"), (0, "wrote a.png\n", ""))
        self.assertEqual(self.picture("out/shear.contact.csv", "out/beam_adaptive.contact.csv", "--over=x", "--output=a.png")[0], 0)
        for name in ("shear.contact.csv", "shear.history.csv", "beam_adaptive.json"):  # units are told of all but of numbers
            table = Table(str(self.folder / "out" / name))
            bare = [column for column in table.names() if not table.is_text(column) and "[" not in table.name_of(column)]
            self.assertEqual(set(bare) - {"friction_used", "time", "newton_iterations", "linear_iterations", "parts", "patches", "converged", "max_strain",
                                          "dofs", "relative_estimate"}, set(), name)

    def test_several_files_have_a_legend(self):
        (self.folder / "one").mkdir()
        for name in ("one/a", "b", "c=d"):
            contact_file(self.folder / f"{name}.contact.csv")
        contact_file(self.folder / "a.contact.csv")
        for arguments, names in ((["one/a.contact.csv", "b.contact.csv"], ["a", "b"]), (["a.contact.csv", "one/a.contact.csv"], ["a", "one/a"]),
                                 (["E = 2=a.contact.csv", "b.contact.csv", "c=d.contact.csv"], ["E = 2", "b", "c=d"])):
            with contextlib.chdir(self.folder):
                drawn = command_line.diagram_of(command_line.options(arguments))
            self.addCleanup(curves.plt.close, drawn)
            self.assertEqual([text.get_text() for text in drawn.axes[0].get_legend().get_texts()], names)

    def test_files_that_are_written(self):
        contact_file(self.folder / "a.contact.csv")
        picture.history_file(self.folder / "b.history.csv")
        for arguments, name, begin in ((["a.contact.csv"], "a.contact.png", b"\x89PNG"), (["x=b.history.csv"], "b.history.png", b"\x89PNG"),
                                       (["b.history.csv", "--columns=work", "--output=c.svg", "--style=dark"], "c.svg", b"<?xml")):
            self.assertEqual(self.picture(*arguments), (0, f"wrote {name}\n", ""))
            self.assertTrue((self.folder / name).read_bytes().startswith(begin))

    def test_how_they_look(self):
        rigid, soft = contact_file(self.folder / "a.contact.csv"), contact_file(self.folder / "b.contact.csv", reach=0.7, yields=6)
        space = space_file(self.folder / "c.contact.csv")
        picture.history_file(self.folder / "d.history.csv")
        steps = Table(str(self.folder / "d.history.csv"))
        for name, tables, columns, over, span in (("sides", [rigid, soft], ["pressure", "state"], "x", None), ("radius", [space], ["pressure", "friction", "state"], None, (0, 0.8)),
                                                  ("steps", [steps], ["work", "contact_force_y"], None, None)):
            for kind in (style.LIGHT, style.PRINT if name == "sides" else style.DARK):
                references.expect_like(self, references.without_texts(self.compose(tables, columns, over, span, kind)), f"{name}_{kind.name}",
                                       references.DIAGRAM)


class Page(unittest.TestCase):
    """doc/pictures.md."""

    def test_its_commands_are_understood_and_have_a_picture_each(self):
        found = page.commands((SOURCE / "doc" / "pictures.md").read_text())
        self.assertGreater(len(found), 12)
        for arguments, image in found:
            command_line.options(arguments)
            self.assertTrue((SOURCE / "doc" / image).is_file(), image)
        self.assertLess(sum(path.stat().st_size for path in (SOURCE / "doc" / "figures" / "pictures").iterdir()), 400_000)

    def test_it_tells_of_all_options(self):
        text = (SOURCE / "doc" / "pictures.md").read_text()
        with contextlib.redirect_stdout(io.StringIO()) as told, self.assertRaises(SystemExit):
            command_line.options(["--help"])
        for option in sorted(set(re.findall(r"--(\w+)", told.getvalue())) - {"help"}):
            self.assertIn(f"--{option}", text)


class Refusals(RpcTestCase):
    """One line, exit code 2, no picture."""

    picture = PICTURE
    expect_refusal_of = REFUSAL

    def setUp(self):
        super().setUp()
        contact_file(self.folder / "a.contact.csv")
        space_file(self.folder / "b.contact.csv")
        picture.history_file(self.folder / "a.history.csv")

    def test_of_options(self):
        self.expect_refusal_of(["a.history.csv", "--columns=wrok"], '"a.history.csv": --columns must name columns of the table', 'got "wrok"',
                               "(did you mean work?)", "there are time, strain_energy")
        self.expect_refusal_of(["a.contact.csv", "--columns=pressure,Gap"], 'got "Gap" (did you mean gap?)')
        self.expect_refusal_of(["a.contact.csv", "--over=radus"], '--over must name a column of numbers, got "radus" (did you mean radius?)')
        self.expect_refusal_of(["a.contact.csv", "--over=state"], '--over must name a column of numbers, got "state"')
        self.expect_refusal_of(["a.history.csv", "--over=radius"], '"a.history.csv": --over must name', 'got "radius"')
        self.expect_refusal_of(["b.contact.csv", "--centre=1"], '"b.contact.csv": --centre must be 2 numbers of x and y, across which', "got 1")
        self.expect_refusal_of(["a.contact.csv", "--over=x", "--centre=1"], "--centre goes with --over=radius", "got 1 number")
        self.expect_refusal_of(["b.contact.csv", "--centre=1,two"], "--centre must be a number for each direction", '"1,two"')
        self.expect_refusal_of(["a.e", "--centre=1,2"], "--centre does not go with it")
        for text in ("", ",", "pressure,,gap"):
            self.expect_refusal_of(["a.contact.csv", f"--columns={text}"], "--columns must be names of columns, such as", f'got "{text}"')
        self.expect_refusal_of(["a.contact.csv", "--over="], '--over must name', 'got ""')
        for text in ("", "1", "1,0", "0,0", "a,b", "0,nan", "0,1,2", "0,1e999"):
            self.expect_refusal_of(["a.contact.csv", f"--range={text}"], "--range must be two numbers", f'got "{text}"')
        self.expect_refusal_of(["a.contact.csv", "--range=5,6"], '"a.contact.csv": --range must hold points of s, which goes from 0 to 2, got 5,6')
        points_file(self.folder / "a.points.csv", {"left": [0, 0.5, 1]})
        for arguments, got in ((["--time=1.5"], "--time must be one of 1, 2, got 1.5"), (["--over=time", "--time=1"], "--time does not go with --over=time"),
                               (["--columns=disp_z"], 'got "disp_z"'), (["--over=radius"], 'got "radius"'), (["--scale=1"], "--scale does not go with it")):
            self.expect_refusal_of(["a.points.csv", *arguments], '"a.points.csv"', got)
        for option in ("field=gap", "scale=1", "time=1", "window=0,0,1,1", "cut=x=0", "view=0,0,1"):
            for name in ("a.contact.csv", "a.history.csv"):
                self.expect_refusal_of([name, f"--{option}"], f'"{name}": --{option.split("=")[0]} does not go with it, but with RESULT.e')
        self.expect_refusal_of(["a.history.csv", "--columns=time,work,strain_energy,foundation_energy,dissipated_energy,contact_length,"
                                "contact_force_x,contact_force_y,left_displacement_y"], "at most 8 columns, got 9")

    def test_of_several_files(self):
        contact_file(self.folder / "mm.contact.csv", units=True)
        self.expect_refusal_of(["a.contact.csv", "a.history.csv"], '"a.history.csv": files of one picture must be of one kind')
        self.expect_refusal_of(["a.contact.csv", "mm.contact.csv"], '"mm.contact.csv": files of one picture must have the same units', "[MPa] beside ")
        self.expect_refusal_of(["a.contact.csv"] * 7, "at most 6 files", "got 7")
        self.expect_refusal_of(["a.contact.csv", "a.e"], 'of one kind, got "a.e" beside "a.contact.csv"')
        self.expect_refusal_of(["a.contact.csv", "x=none.contact.csv"], '"none.contact.csv": no such file')

    def test_of_files(self):
        text = (self.folder / "a.contact.csv").read_text()
        for name, content, *parts in (
                ("none", None, "no such file", "Steps->Times"), ("empty", "", "is empty"), ("blank", "\n\n", "is empty"),
                ("header", text.splitlines()[0] + "\n", "has no rows"), ("other", "a,b\n1,2\n", "is no table of rpc: it must have the columns"),
                ("study", "folder,exit_code,Contact->Yield Stress,seconds,reason\nrun-1,0,2,0.1,\n", "is the table of a study", "run-*/deck.contact.csv"),
                ("short", text[: len(text) // 2].rsplit(",", 3)[0] + "\n", "a row must have 9 entries", "got "),
                ("long", text + "1,2,3,4,5,6,7,8,9,10\n", f"row {N + 2}: a row must have 9 entries", "got 10"),
                ("words", text.replace(",0.1,", ",much,"), "column u_nu: entries must be numbers", 'got "much"'),
                ("nan", text.replace("-1.0,0,", "nan,0,"), None), ("picture", b"\x89PNG\r\n\x1a\n\0\0\xff\xfe", "is no table"),
                ("quote", text + '"', "is no table: "), ("failed", "time,work,converged\n1,nan,0\n", "has no rows of steps that have converged")):
            if content is not None:
                (self.folder / f"{name}.csv").write_bytes(content.encode() if isinstance(content, str) else content)
            if parts[0]:
                self.expect_refusal_of([f"{name}.csv"], f'"{name}.csv"', *parts)
        for name, told, part in (("plain", {"adaptation": None}, 'is damaged: "adaptation" is not what rpc writes'), ("none", {"adaptation": {}}, "is damaged"),
                                 ("empty", {"adaptation": {"target": 1, "cycles": []}}, "is damaged"), ("units", {"units": []}, "is damaged")):
            summary_file(self.folder / f"{name}.json", **told)
            self.expect_refusal_of([f"{name}.json"], f'"{name}.json" {part}', "remedy: run rpc again")
        for name, content, part in (("text", "{", '"text.json" is no JSON'), ("list", "[]", "is not a summary of rpc"),
                                    ("fixed", '{"rpc_version": "1"}', "tells of no adapted meshes"), ("binary", "\0", "is no JSON"),
                                    ("spread", '{"rpc_version": "1", "contact_patches": {"a": 1}}', 'is damaged: "contact_patches" is not what rpc writes')):
            (self.folder / f"{name}.json").write_text(content)
            self.expect_refusal_of([f"{name}.json"], part)
        self.expect_refusal_of(["missing.json"], '"missing.json": no such file')
        self.expect_refusal_of(["nan.csv", "--over=x"], '"nan.csv", column x: --over must name a column of finite numbers')
        (self.folder / "folder.csv").mkdir()
        self.expect_refusal_of(["folder.csv"], '"folder.csv": Is a directory')


if __name__ == "__main__":
    unittest.main()

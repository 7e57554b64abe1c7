# SPDX-License-Identifier: BSD-3-Clause
"""Geometries and meshes of other programs: what becomes of their names, and that a mesh gives the same run whatever file it comes in."""

import json
import os
import re
import shutil
import struct
import subprocess
import unittest
import zlib

from rpc_run import SOURCE, RpcTestCase

DATA = SOURCE / "packages" / "mesh" / "test" / "data"
FORCE = 11.3752530895  # of the square below [N/m]
HAS_GMSH = os.environ.get("RPC_GMSH", "ON") == "ON"
HAS_NETCDF = subprocess.run(["python3", "-c", "import netCDF4"], capture_output=True).returncode == 0
HAS_MESHIO = subprocess.run(["python3", "-c", "import meshio, h5py"], capture_output=True).returncode == 0

SQUARE = """square:
  Mesh: {{Type: gmsh, File: "{file}"{more}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    top: {{X: 0.0, Y: -0.01}}
  Contact: {{Side: bottom}}
  Output: {{Exodus: none}}
"""
CUBE = """cube:
  Mesh: {{Type: gmsh, File: "{file}", Order: 1, Sides: {{foot: {{Plane: "z = 0"}}, head: {{{head}}}}}{more}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    head: {{X: 0.0, Y: 0.0, Z: -0.01}}
  Contact: {{Side: foot}}
  Output: {{Exodus: none}}
"""


def stl_of_box(x, y, z):
    """The surface of a box in 12 triangles."""
    corner = [(x * (k & 1), y * (k >> 1 & 1), z * (k >> 2)) for k in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    text = "solid box\n"
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corner[k] for k in triangle) + "endloop\nendfacet\n"
    return text + "endsolid box\n"


def read_png(data):
    """(width, height, pixels, palette) of a picture with a palette and without filters."""
    chunks, at = {}, 8
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + chunk) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], kind
        chunks[kind] = chunk
        at += 12 + size
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    rows = zlib.decompress(chunks[b"IDAT"])  # which checks its sum
    return width, height, b"".join(rows[(width + 1) * y + 1:(width + 1) * (y + 1)] for y in range(height)), chunks[b"PLTE"]


class Formats(RpcTestCase):
    def run_of(self, deck, name, *more):
        (self.folder / f"{name}.yaml").write_text(deck)
        result = self.rpc(f"--input={name}.yaml", "--output=out", *more)
        return json.loads((self.folder / "out" / f"{name}.json").read_text()), result.stdout

    def square(self, file, more=""):
        summary, said = self.run_of(SQUARE.format(file=file, more=more), "square")
        self.assertAlmostEqual(summary["contact_force"][1], FORCE, delta=1e-8 * FORCE)
        return said

    @unittest.skipUnless(HAS_NETCDF, "python3 has no netCDF4")
    def test_faces_of_shells_in_side_sets_are_left_out(self):
        import netCDF4
        shutil.copy(DATA / "two_squares.exo", self.folder)
        with netCDF4.Dataset(self.folder / "two_squares.exo", "r+") as file:
            for name in ("connect1", "connect2"):
                file[name].elem_type = "SHELL"
            file["side_ss1"][:] = 1
            file["side_ss2"][:] = 4
        info = self.rpc("--mesh-info=two_squares.exo").stdout
        self.assertRegex(info, "1 entries of side set [0-9]+ are faces of shells, which bound no body: they are left out")
        self.assertIn('side        "right": 1 facet', info)

    def test_mesh_info_draws_a_mesh(self):
        for mesh, views, drawn in (("sector_22.msh", 1, (0.4, 1)), ("octant_22.msh", 2, (0.2, 0.9))):
            shutil.copy(DATA / mesh, self.folder)
            info = self.rpc(f"--mesh-info={mesh}", "--output=pictures").stdout
            picture = self.folder / "pictures" / mesh.replace(".msh", ".mesh.png")
            self.assertIn(f"picture     pictures/{picture.name}\n", info)
            colours = re.findall(r"^  side .*; drawn (\w+)$", info, re.MULTILINE)
            self.assertEqual(colours, ["blue", "orange", "green", "red"][:len(colours)])
            width, height, pixels, palette = read_png(picture.read_bytes())
            self.assertEqual(len(pixels), width * height)
            self.assertLessEqual(abs(width - views * height), 0.3 * width)
            body = sum(1 for pixel in pixels if pixel) / len(pixels)
            self.assertTrue(drawn[0] < body < drawn[1], body)
            shades = 16  # the first colours of the palette after that of the background are those of sides
            seen = {(pixel - 1) // shades for pixel in set(pixels) if pixel}
            self.assertLessEqual(set(range(len(colours))), seen, f"{mesh}: a side is not to be seen")
            self.assertEqual(palette[:3], b"\xff\xff\xff")

    def test_what_is_mended_changes_nothing(self):
        text = (DATA / "square_41.msh").read_text()
        (self.folder / "UPPER.MSH").write_text(text)
        self.square("UPPER.MSH")
        shutil.copy(DATA / "square_partitioned_41.msh", self.folder)
        self.square("square_partitioned_41.msh")
        blanks = text.replace('"bottom"', '"bottom  "')
        (self.folder / "blanks.msh").write_text(blanks)
        self.assertIn("ends in blanks", self.square("blanks.msh"))

    @unittest.skipUnless(HAS_GMSH, "rpc was built without gmsh")
    def test_unv_is_the_same_mesh(self):
        shutil.copy(DATA / "square.unv", self.folder)
        self.square("square.unv")

    @unittest.skipUnless(HAS_MESHIO, "python3 has no meshio and h5py")
    def test_what_meshio_converts_is_the_same_mesh(self):
        script = """import meshio, numpy, sys
mesh = meshio.read(sys.argv[1])
names = {int(tag): name for name, (tag, dim) in mesh.field_data.items()}
kinds = [block.type for block in mesh.cells]
sets = {}
for name, (tag, dim) in mesh.field_data.items():
    sets[name] = [numpy.flatnonzero((data == tag) & (len(block.data[0]) == dim + 1)) for block, data in zip(mesh.cells, mesh.cell_data["gmsh:physical"])]
cells = [("triangle", numpy.concatenate([block.data for block in mesh.cells if block.type == "triangle"]))]
points = mesh.points[:, :2] if sys.argv[2].endswith(".inp") else mesh.points
bottom, top = (numpy.flatnonzero(mesh.points[:, 1] == y) for y in (0, 1))
out = meshio.Mesh(points, cells, point_sets={"bottom": bottom, "top": top} if sys.argv[2].endswith(".inp") else None)
meshio.write(sys.argv[2], out)
"""
        for name in ("square.inp", "square.vtu", "square.vtk", "square.med"):
            subprocess.run(["python3", "-c", script, DATA / "square_41.msh", self.folder / name], check=True, capture_output=True)
            more = "" if name == "square.inp" else ', Sides: {bottom: {Plane: "y = 0"}, top: {Plane: "y = 1"}}'
            with self.subTest(name):
                self.square(name, more)

    def test_without_meshio_the_message_tells_how_to_install_it(self):
        (self.folder / "bin").mkdir()
        python = self.folder / "bin" / "python3"
        python.write_text("#!/bin/sh\nexit 9\n")  # as the converter does where it finds no meshio
        python.chmod(0o755)
        (self.folder / "square.inp").write_text("*NODE\n1, 0, 0\n")
        (self.folder / "square.yaml").write_text(SQUARE.format(file="square.inp", more=""))
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        result = self.rpc("--input=square.yaml", code=None, environment={"PATH": path})
        self.expect_refusal(result, 2, ["square.inp", "apt-get install python3-meshio"])

    @unittest.skipUnless(HAS_GMSH, "rpc was built without gmsh")
    def test_a_step_file_is_a_geometry_with_sides_by_place_and_number(self):
        shutil.copy(SOURCE / "doc" / "tutorial" / "pin.step", self.folder)
        info = self.rpc("--mesh-info=pin.step").stdout
        self.assertIn("  surface     3, ", info)
        self.assertIn('block       "body": ', info)
        self.assertIn("in the file's mm", info)
        deck = """pin:
  Mesh: {Type: gmsh, File: pin.step, Size: 4, Order: 1, Sides: {head: {Surfaces: [3]}}}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Units: {Length: mm}
  Dirichlet:
    head: {X: 0.0, Y: 0.0, Z: -0.01}
  Contact: {Side: surface 2}
"""
        (self.folder / "pin.yaml").write_text(deck)
        said = self.rpc("--input=pin.yaml", "--check").stdout
        self.assertIn('"head": area', said)
        self.assertIn('"surface 2": area', said)
        self.assertNotIn("note: mesh:", said)  # lengths of a STEP file are the deck's
        (self.folder / "pin.yaml").write_text(deck.replace("mm", "m"))
        self.assertIn(' m in this deck: lengths of the file are read in mm, for which "Units->Length" is mm', self.rpc("--input=pin.yaml", "--check").stdout)
        (self.folder / "pin.yaml").write_text(deck.replace("  Units: {Length: mm}\n", ""))
        self.assertIn(" in the file's mm; the deck's unit of length counts: see \"Units\"", self.rpc("--input=pin.yaml", "--check").stdout)
        (self.folder / "pin.yaml").write_text(deck.replace("Size: 4", "Size: 0.004"))  # in m
        result = self.rpc("--input=pin.yaml", "--check", code=None)
        self.expect_refusal(result, 3, ["cells of size 0.004 are too small", "unit of length"])
        (self.folder / "pin.yaml").write_text(deck.replace("surface 2", "foot"))
        result = self.rpc("--input=pin.yaml", "--check", code=None)
        self.expect_refusal(result, 2, ['"foot"', "surface 2", '"Mesh->Sides" chooses others by place or number'])

    @unittest.skipUnless(HAS_GMSH, "rpc was built without gmsh")
    def test_faces_of_an_iges_file_are_sewn_to_the_solid_of_a_brep(self):
        deck = """cylinder:
  Mesh: {{Type: gmsh, File: {file}, Size: 4, Order: 1, Sides: {{foot: {{Plane: "z = 0"}}, head: {{Near: [0.0, 0.0, 10.0]}}}}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Units: {{Length: mm}}
  Dirichlet:
    head: {{X: 0.0, Y: 0.0, Z: -0.01}}
  Contact: {{Side: foot}}
"""
        forces = []
        for file in ("cylinder.iges", "cylinder.brep"):
            shutil.copy(DATA / file, self.folder)
            summary, said = self.run_of(deck.format(file=file), "cylinder")
            forces.append(summary["contact_force"][2])
            self.assertEqual("3 faces and no solid: they are sewn, and bound one solid" in said, file.endswith("iges"))
        self.assertAlmostEqual(*forces, delta=0.03 * forces[0])
        text = (DATA / "cylinder.brep").read_text()
        (self.folder / "cylinder.brep").write_text(text.replace("1  3 0 0 6.28318530717959", "1  0x10 0 0 6.28318530717959"))
        self.expect_refusal(self.rpc("--mesh-info=cylinder.brep", code=None), 3, ["does not come to an end", "STEP"])
        text = (DATA / "cylinder.iges").read_text()
        wall = text.index("     144 ") # the first face
        (self.folder / "cylinder.iges").write_text(text[:wall] + "     406 " + text[wall + 9:])
        self.expect_refusal(self.rpc("--mesh-info=cylinder.iges", code=None), 3, ["do not bound a solid", "STEP"])

    @unittest.skipUnless(HAS_MESHIO, "python3 has no meshio and h5py")
    def test_abaqus_files_with_includes_repeated_sets_and_surfaces(self):
        corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        places = corners + [tuple((p + q) / 2 for p, q in zip(corners[a], corners[b])) for a, b in edges]
        (self.folder / "cells.txt").write_text("*NODE, NSET=all\n" + "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(places, 1))
                                               + "*ELEMENT, TYPE=C3D20R, ELSET=part\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,\n11, 12, 13, 14, 15, 16, 17, 18, 19, 20\n")
        (self.folder / "cube.inp").write_text("** by hand\n*Include, input=cells.txt\n*ELEMENT, TYPE=SPRINGA\n2, 1, 2\n*NSET, NSET=foot, GENERATE\n1, 4\n"
                                              "*NSET, NSET=foot\n9, 10, 11, 12\n*NSET, NSET=same\nFOOT\n"
                                              "*SURFACE, NAME=head\npart, S2\n*SURFACE, NAME=left\n1, S6\n*SURFACE, NAME=lost\n1, SPOS\n")
        info = self.rpc("--mesh-info=cube.inp").stdout
        for words in ('side        "head": 1 facet, area 1, centroid (0.5, 0.5, 1)', 'side        "left": 1 facet, area 1, centroid (0, 0.5, 0.5)',
                      'side        "foot": 1 facet, area 1, centroid (0.5, 0.5, 0)', 'side        "same": 1 facet', 'block       "part"',
                      "SPRINGA", '"all" has all nodes', '*SURFACE "lost": of 1 elements of "1" 1 have no facet "SPOS"'):
            self.assertIn(words, info)
        for change, words in ((("foot\n9", "foot\nx9x"), ['names "x9x"']), (("cells.txt", "cell.txt"), ["line 2: *INCLUDE", '"cell.txt"']),
                              (("SPRINGA", "C3D8"), ["line 4: *ELEMENT", "the last one is not whole"])):
            (self.folder / "wrong.inp").write_text((self.folder / "cube.inp").read_text().replace(*change))
            result = self.rpc("--mesh-info=wrong.inp", code=None)
            for word in words:
                self.assertIn(word, result.stdout + result.stderr)

    @unittest.skipUnless(HAS_GMSH, "rpc was built without gmsh")
    def test_an_stl_is_filled_or_refused(self):
        (self.folder / "box.stl").write_text(stl_of_box(1, 1, 1))
        summary, said = self.run_of(CUBE.format(file="box.stl", head='Near: [0.5, 0.5, 1.0]', more=", Size: 0.5"), "cube")
        self.assertGreater(summary["contact_force"][2], 9)
        self.assertIn("unit of length, which it does not tell", said)
        text = stl_of_box(1, 1, 1)
        (self.folder / "open.stl").write_text(text[:text.index("facet")] + text[text.index("endfacet") + 9:])
        (self.folder / "cube.yaml").write_text(CUBE.format(file="open.stl", head='Plane: "z = 1"', more=""))
        self.expect_refusal(self.rpc("--input=cube.yaml", code=None), 3, ["open.stl", "there is an open edge at ("])
        lines = text.split("\n")
        (self.folder / "open.stl").write_text("\n".join(lines[:28] + lines[29:62] + lines[63:]))  # gmsh would divide what it reads of it for ever
        self.expect_refusal(self.rpc("--input=cube.yaml", code=None), 3, ["open.stl", "there is an open edge at ("])

    @unittest.skipUnless(HAS_GMSH and HAS_MESHIO, "rpc was built without gmsh, or python3 has no meshio and h5py")
    def test_of_damaged_files_a_remedy_is_told(self):
        for name, damage in (("square.vtk", lambda text: text[:900]), ("square.unv", lambda text: text.replace("\n         3 ", "\n       999 ", 1)),
                             ("cut.stl", lambda text: text[:400])):
            text = (DATA / name).read_text() if name != "cut.stl" else stl_of_box(1, 1, 1)
            (self.folder / name).write_text(damage(text))
            self.expect_refusal(self.rpc(f"--mesh-info={name}", code=None), 3, [name, "damaged", "write it anew"])


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of hexahedra, wedges, pyramids and tetrahedra side by side, and of triangles and quadrilaterals: in all formats and on all numbers of ranks a
block of them is pressed as one of simplices is, which bear a uniform stress exactly."""

import json
import random
import subprocess
import unittest

from rpc_run import RANKS, RpcTestCase

HAS_NETCDF = subprocess.run(["python3", "-c", "import netCDF4"], capture_output=True).returncode == 0
HAS_MESHIO = subprocess.run(["python3", "-c", "import meshio, h5py"], capture_output=True).returncode == 0

CUBES = (3, 2, 2)
SIZE = (1.5, 1.0, 1.0)
# Edges whose middles a cell has, by gmsh, by VTK and Abaqus, and by Exodus; quadrilateral faces, by gmsh; facets by Abaqus and by Exodus.
GMSH = {"hexahedron": "01 03 04 12 15 23 26 37 45 47 56 67", "wedge": "01 02 03 12 14 25 34 35 45", "pyramid": "01 03 04 12 14 23 24 34", "tetra": "01 12 20 30 32 31",
        "quad": "01 12 23 30", "triangle": "01 12 20"}
VTK = {"hexahedron": "01 12 23 30 45 56 67 74 04 15 26 37", "wedge": "01 12 20 34 45 53 03 14 25", "pyramid": "01 12 23 30 04 14 24 34", "tetra": "01 12 20 03 13 23",
       "quad": "01 12 23 30", "triangle": "01 12 20"}
EXODUS = {"hexahedron": "01 12 23 30 04 15 26 37 45 56 67 74", "wedge": "01 12 20 03 14 25 34 45 53", "pyramid": VTK["pyramid"], "tetra": VTK["tetra"]}
EXODUS_MIDDLES = {"hexahedron": "01234567 0321 4567 0473 1265 0154 2376", "wedge": "0143 1254 0352", "pyramid": "0321"}
FACES = {"hexahedron": "0321 0154 0473 1265 2376 4567", "wedge": "021 345 0143 0352 1254", "pyramid": "014 124 234 304 0321", "tetra": "021 013 032 123"}
EXODUS_FACES = {"hexahedron": "0154 1265 2376 0473 0321 4567", "wedge": "0143 1254 0352 021 345", "pyramid": "014 124 234 304 0321", "tetra": "013 123 032 021"}
ABAQUS_FACES = {"hexahedron": "0321 4567 0154 1265 2376 0473", "wedge": "021 345 0143 1254 0352", "pyramid": "0321 014 124 234 304", "tetra": "021 013 123 032"}
TYPES = {"hexahedron": (5, 17, 12), "wedge": (6, 18, 13), "pyramid": (7, 19, 14), "tetra": (4, 11, 11), "quad": (3, 16, 10), "triangle": (2, 9, 9)}
MESHIO = {"hexahedron": "hexahedron20", "wedge": "wedge15", "pyramid": "pyramid13", "tetra": "tetra10"}

DECK = """run:
  Mesh: {{Type: gmsh, File: {file}{more}}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet:
    top: {{Side: top, {up}: -0.01}}
    left: {{Side: left, X: 0.0}}{back}
  Contact: {{Side: bottom}}
  Output: {{Exodus: none}}
"""


class Body:
    """A block of cubes in columns: a hexahedron each, two wedges, six pyramids, or five of them and two tetrahedra at its top."""

    def __init__(self, seed=1, order=1, full=True):
        self.rng, self.order, self.full = random.Random(seed), order, full
        self.places, self.cells = {}, []  # (doubled integer place) -> number; (kind, corners)
        for i in range(CUBES[0]):
            for j in range(CUBES[1]):
                for k in range(CUBES[2]):
                    self.add_cube(i, j, k, ("wedges", "pyramids", "hexahedron")[i] if j == 0 else ("hexahedron", "pyramids", "wedges")[i])
        numbers = list(range(1, len(self.places) + 1))
        self.rng.shuffle(numbers)
        self.tag = dict(zip(self.places.values(), numbers))
        self.coords = {self.tag[n]: self.moved(place) for place, n in self.places.items()}
        self.cells = [(kind, [self.tag[n] for n in nodes]) for kind, nodes in self.cells]
        self.middles = {}

    def node(self, *place):
        return self.places.setdefault(place, len(self.places))

    def moved(self, place):
        """Inner nodes stand aside."""
        inside = [0 < p < 2 * n for p, n in zip(place, CUBES)]
        return [s * p / (2 * n) + (self.rng.uniform(-0.03, 0.03) if all(inside) else 0) for p, n, s in zip(place, CUBES, SIZE)]

    def add_cube(self, i, j, k, of):
        c = [self.node(2 * (i + x), 2 * (j + y), 2 * (k + z)) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        if of == "hexahedron":
            return self.cells.append(("hexahedron", c))
        if of == "wedges":
            self.cells.append(("wedge", [c[n] for n in (0, 1, 2, 4, 5, 6)]))
            return self.cells.append(("wedge", [c[n] for n in (0, 2, 3, 4, 6, 7)]))
        centre = self.node(2 * i + 1, 2 * j + 1, 2 * k + 1)
        for face in FACES["hexahedron"].split():
            base = [c[int(n)] for n in reversed(face)]
            if face == "4567" and k + 1 == CUBES[2]:
                self.cells += [("tetra", [base[0], base[1], base[2], centre]), ("tetra", [base[0], base[2], base[3], centre])]
            else:
                self.cells.append(("pyramid", base + [centre]))
        return None

    def middle(self, *nodes):
        """The node in the middle of vertices, away from it inside the body."""
        key = tuple(sorted(nodes))
        if key not in self.middles:
            self.middles[key] = len(self.coords) + 1
            mean = [sum(self.coords[n][d] for n in nodes) / len(nodes) for d in range(3)]
            inside = all(1e-9 < x < s - 1e-9 for x, s in zip(mean, SIZE))
            self.coords[len(self.coords) + 1] = [x + (self.rng.uniform(-0.01, 0.01) if inside else 0) for x in mean]
        return self.middles[key]

    def nodes_of(self, kind, corners, edges):
        """All nodes of a cell or facet in the order of a format."""
        if self.order == 1:
            return corners
        quadrilaterals = [face for face in FACES.get(kind, "0123" if kind == "quad" else "").split() if len(face) == 4]
        whole = ["01234567"] if kind == "hexahedron" else []
        if edges is EXODUS:
            quadrilaterals = EXODUS_MIDDLES.get(kind, "").split()
            whole.clear()
        vertices = edges[kind].split() + (quadrilaterals + whole if self.full else [])
        return corners + [self.middle(*(corners[int(v)] for v in each)) for each in vertices]

    def type_of(self, kind):
        return TYPES[kind][0 if self.order == 1 else 2 if self.full else 1]

    def sides(self, faces):
        """name -> (number of the cell from 0, number of the face from 0, its corners), of the boundary's planes."""
        planes = {"left": (0, 0), "back": (1, 0), "bottom": (2, 0), "top": (2, SIZE[2])}
        found = {name: [] for name in planes}
        for c, (kind, corners) in enumerate(self.cells):
            for f, face in enumerate(faces[kind].split()):
                own = [corners[int(v)] for v in face]
                for name, (d, at) in planes.items():
                    if all(abs(self.coords[n][d] - at) < 1e-9 for n in own):
                        found[name].append((c, f, own))
        return found

    def msh(self):
        sides = self.sides(FACES)
        lines, names = [], []
        for g, (name, facets) in enumerate(sides.items(), 1):
            names.append(f'2 {g} "{name}"')
            for _, _, own in facets:
                kind = "quad" if len(own) == 4 else "triangle"
                lines.append([self.type_of(kind), 2, g, 0, *self.nodes_of(kind, own, GMSH)])
        names.append('3 9 "body"')
        lines += [[self.type_of(kind), 2, 9, 0, *self.nodes_of(kind, corners, GMSH)] for kind, corners in self.cells]
        sections = {"PhysicalNames": names, "Nodes": [f"{n} " + " ".join(map(repr, x)) for n, x in self.coords.items()],
                    "Elements": [" ".join(map(str, [k, *line])) for k, line in enumerate(lines, 1)]}
        return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join("\n".join([f"${name}", str(len(rows)), *rows, f"$End{name}", ""]) for name, rows in sections.items())

    def inp(self):
        types = {"hexahedron": "C3D8", "wedge": "C3D6", "pyramid": "C3D5", "tetra": "C3D4"} if self.order == 1 else \
                {"hexahedron": "C3D20", "wedge": "C3D15", "pyramid": "C3D13", "tetra": "C3D10"}
        cells = "".join(f"*ELEMENT, TYPE={types[kind]}, ELSET=body\n{c}, " + ",".join(map(str, self.nodes_of(kind, corners, VTK))) + "\n"
                        for c, (kind, corners) in enumerate(self.cells, 1))
        sides = "".join(f"*SURFACE, NAME={name}\n" + "".join(f"{c + 1}, S{f + 1}\n" for c, f, _ in facets) for name, facets in self.sides(ABAQUS_FACES).items())
        return "*NODE\n" + "".join(f"{n}, " + ", ".join(map(repr, x)) + "\n" for n, x in self.coords.items()) + cells + sides

    def write_exodus(self, path):
        import netCDF4
        import numpy
        blocks = {kind: [c for c in range(len(self.cells)) if self.cells[c][0] == kind] for kind in GMSH if kind in {kind for kind, _ in self.cells}}
        numbers = {c: k for k, c in enumerate((c for of_kind in blocks.values() for c in of_kind), 1)}
        nodes = {kind: numpy.array([self.nodes_of(kind, self.cells[c][1], EXODUS) for c in cells]) for kind, cells in blocks.items()}
        with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
            file.api_version = file.version = numpy.float32(8.11)
            file.title = "mixed"
            file.floating_point_word_size, file.file_size = 8, 1
            for name, size in {"len_string": 33, "len_name": 33, "num_dim": 3, "num_nodes": len(self.coords), "num_elem": len(self.cells), "num_el_blk": len(blocks),
                               "num_side_sets": 4, "time_step": None}.items():
                file.createDimension(name, size)
            file.createVariable("time_whole", "f8", ("time_step",))
            for d, x in enumerate("xyz"):
                file.createVariable("coord" + x, "f8", ("num_nodes",))[:] = [self.coords[n][d] for n in range(1, len(self.coords) + 1)]
            file.createVariable("eb_prop1", "i4", ("num_el_blk",))[:] = range(1, len(blocks) + 1)
            file["eb_prop1"].setncattr("name", "ID")
            file.createVariable("eb_status", "i4", ("num_el_blk",))[:] = 1
            for b, (kind, of_kind) in enumerate(nodes.items(), 1):
                file.createDimension(f"num_el_in_blk{b}", len(of_kind))
                file.createDimension(f"num_nod_per_el{b}", len(of_kind[0]))
                file.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", f"num_nod_per_el{b}"))[:] = of_kind
                file[f"connect{b}"].elem_type = {"hexahedron": "HEX", "wedge": "WEDGE", "pyramid": "PYRAMID", "tetra": "TETRA"}[kind]
            file.createVariable("ss_prop1", "i4", ("num_side_sets",))[:] = range(1, 5)
            file["ss_prop1"].setncattr("name", "ID")
            file.createVariable("ss_status", "i4", ("num_side_sets",))[:] = 1
            names = file.createVariable("ss_names", "S1", ("num_side_sets", "len_name"))
            for s, (name, facets) in enumerate(self.sides(EXODUS_FACES).items(), 1):
                names[s - 1] = netCDF4.stringtochar(numpy.array([name], "S33"))[0]
                file.createDimension(f"num_side_ss{s}", len(facets))
                file.createVariable(f"elem_ss{s}", "i4", (f"num_side_ss{s}",))[:] = [numbers[c] for c, _, _ in facets]
                file.createVariable(f"side_ss{s}", "i4", (f"num_side_ss{s}",))[:] = [f + 1 for _, f, _ in facets]

    def write_by_meshio(self, path):
        import meshio
        import numpy
        for kind in ("wedge15", "pyramid13"):  # which meshio 5.0 has forgotten
            meshio._mesh.topological_dimension.setdefault(kind, 3)
        blocks = {}
        for kind, corners in self.cells:
            blocks.setdefault(kind if self.order == 1 else MESHIO[kind], []).append([n - 1 for n in self.nodes_of(kind, corners, VTK)])
        points = numpy.array([self.coords[n] for n in range(1, len(self.coords) + 1)])
        meshio.write(path, meshio.Mesh(points, [(kind, numpy.array(cells)) for kind, cells in blocks.items()]))


def plane_msh(order):
    """A row of quadrilaterals and triangles on [0, 1.5] x [0, 1], with serendipity cells where the order is 2."""
    places, lines = {}, []

    def node(x, y):
        return places.setdefault((x, y), len(places) + 1)

    def add(kind, tag, corners):
        pairs = zip(corners, corners[1:] + corners[:1]) if len(corners) > 2 else [corners]
        nodes = [node(*c) for c in corners] + ([node(*((p + q) / 2 for p, q in zip(a, b))) for a, b in pairs] if order == 2 else [])
        lines.append([{"line": (1, 8), "triangle": (2, 9), "quad": (3, 16)}[kind][order - 1], 2, tag, 0, *nodes])

    at = [[(0.5 * i + (0.1 if (i, j) == (1, 1) else 0), 0.5 * j) for j in range(3)] for i in range(4)]
    for i in range(3):
        for j in range(2):
            a, b, c, d = at[i][j], at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]
            for corners in [(a, b, c, d)] if (i + j) % 2 == 0 else [(a, b, c), (a, c, d)]:
                add("quad" if len(corners) == 4 else "triangle", 9, list(corners))
    for i in range(3):
        add("line", 1, [at[i][0], at[i + 1][0]])
        add("line", 2, [at[i][2], at[i + 1][2]])
    for j in range(2):
        add("line", 3, [at[0][j], at[0][j + 1]])
    sections = {"PhysicalNames": ['1 1 "bottom"', '1 2 "top"', '1 3 "left"', '2 9 "body"'], "Nodes": [f"{n} {x!r} {y!r} 0" for (x, y), n in places.items()],
                "Elements": [" ".join(map(str, [k, *line])) for k, line in enumerate(lines, 1)]}
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join("\n".join([f"${name}", str(len(rows)), *rows, f"$End{name}", ""]) for name, rows in sections.items())


class BlockTestCase(RpcTestCase):
    SIDES = ', Sides: {left: {Plane: "x = 0"}, back: {Plane: "y = 0"}, bottom: {Plane: "z = 0"}, top: {Plane: "z = 1"}}'

    def press(self, file, more="", plane=False):
        """Presses the block by 1 % and expects the force and energy of a uniform stress; returns the summary."""
        back = "" if plane else "\n    back: {Side: back, Y: 0.0}"
        (self.folder / "run.yaml").write_text(DECK.format(file=file, more=more, up="Y" if plane else "Z", back=back))
        self.rpc("--input=run.yaml", "--output=out")
        summary = json.loads((self.folder / "out" / "run.json").read_text())
        force = 10 * SIZE[0] / (1 - 0.3**2) if plane else 10 * SIZE[0] * SIZE[1]
        self.assertAlmostEqual(summary["contact_force"][1 if plane else 2], force, delta=1e-9 * force, msg=file)
        self.assertAlmostEqual(summary["energy_J"], 0.005 * force, delta=1e-9 * force, msg=file)
        return summary

    def expect_note(self, summary, words):
        self.assertEqual(sum(words in note for note in summary["notes"]), 1, summary["notes"])


class MixedMeshes(BlockTestCase):
    """On any number of ranks."""

    def test_a_block_bears_a_uniform_stress(self):
        for order, full in ((1, True), (2, True), (2, False)):
            with self.subTest(order=order, full=full):
                (self.folder / "mixed.msh").write_text(Body(order, order, full).msh())
                self.expect_note(self.press("mixed.msh"), "4 hexahedra, 22 pyramids and 8 wedges are divided into 92 tetrahedra")

    def test_triangles_and_quadrilaterals_in_the_plane(self):
        for order in (1, 2):
            with self.subTest(order=order):
                (self.folder / "plane.msh").write_text(plane_msh(order))
                self.expect_note(self.press("plane.msh", plane=True), "3 quadrilaterals are divided into 6 triangles")


class Formats(BlockTestCase):
    """Files, which one rank alone reads."""

    def test_volumes_are_exact_and_no_face_inside_has_one_cell(self):
        for order, full in ((1, True), (2, True), (2, False)):
            (self.folder / "mixed.msh").write_text(Body(order, order, full).msh())
            info = self.rpc("--mesh-info=mixed.msh").stdout
            for words in ("8 wedges are divided into 92 tetrahedra", '"body": 96 cells, volume 1.5\n', "boundary    64 facets, area 8\n"):
                self.assertIn(words, info)
        (self.folder / "plane.msh").write_text(plane_msh(1))
        self.assertIn('"body": 12 cells, area 1.5\n', self.rpc("--mesh-info=plane.msh").stdout)

    @unittest.skipUnless(HAS_NETCDF, "python3 has no netCDF4")
    def test_exodus(self):
        for order, full in ((1, True), (2, True), (2, False)):
            with self.subTest(order=order, full=full):
                Body(3, order, full).write_exodus(self.folder / "mixed.exo")
                self.expect_note(self.press("mixed.exo"), "divided into 92 tetrahedra")

    @unittest.skipUnless(HAS_MESHIO, "python3 has no meshio and h5py")
    def test_abaqus(self):
        for order in (1, 2):
            with self.subTest(order=order):
                (self.folder / "mixed.inp").write_text(Body(4, order, False).inp())
                self.expect_note(self.press("mixed.inp"), "divided into 92 tetrahedra")

    @unittest.skipUnless(HAS_MESHIO, "python3 has no meshio and h5py")
    def test_what_meshio_converts(self):
        for name, order in (("mixed.vtu", 1), ("mixed.vtk", 2), ("mixed.med", 2)):
            with self.subTest(name):
                Body(5, order, False).write_by_meshio(self.folder / name)
                self.expect_note(self.press(name, self.SIDES), "divided into 92 tetrahedra")

    def test_cells_that_do_not_fit_are_refused(self):
        text = Body().msh()
        lines = text.split("\n")
        wedge = next(k for k, line in enumerate(lines) if line.split()[1:4] == ["6", "2", "9"])
        words = lines[wedge].split()
        number, nodes = words[0], words[5:]
        for changed, expected in ((nodes[:2] + [nodes[4], nodes[3], nodes[2], nodes[5]], ["wedge"]),
                                  (nodes[:5] + nodes[:1], [number, "twice"]),
                                  (nodes[:5] + ["9999"], ["node 9999", "which the file lacks"])):
            (self.folder / "wrong.msh").write_text("\n".join(lines[:wedge] + [" ".join(words[:5] + changed)] + lines[wedge + 1:]))
            self.expect_refusal(self.rpc("--mesh-info=wrong.msh", code=None), 3, ["wrong.msh", *expected])
        with_order_2 = lines[:wedge] + [" ".join([number, "13", "2", "9", "0"] + nodes * 3)] + lines[wedge + 1:]
        (self.folder / "wrong.msh").write_text("\n".join(with_order_2))
        self.expect_refusal(self.rpc("--mesh-info=wrong.msh", code=None), 3, ["one order", '"Prism 18"'])


if __name__ == "__main__":
    unittest.main(defaultTest=None if RANKS == 1 else "MixedMeshes")

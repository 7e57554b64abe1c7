// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::mesh
{

/// What python3 runs, with the file and the .msh to be written as arguments: meshio reads and writes. Of sets that overlap a cell belongs to
/// the smallest one. Lines that begin with "note: " go to the user. Exit code 9: there is no meshio; 8: rpc's own reader of Abaqus
/// files refuses it.
inline constexpr const char *meshio_script = R"py(
import contextlib
import io
import sys
try:
    import numpy
    import meshio
except ImportError:
    sys.exit(9)
path, target = sys.argv[1:3]
TYPES = {"vertex": 0, "line": 1, "line3": 1, "triangle": 2, "triangle6": 2, "quad": 2, "quad8": 2, "quad9": 2, "tetra": 3, "tetra10": 3,
         "hexahedron": 3, "hexahedron20": 3, "hexahedron27": 3, "wedge": 3, "wedge15": 3, "wedge18": 3, "pyramid": 3, "pyramid13": 3,
         "pyramid14": 3}
for kind, dim in TYPES.items():  # meshio 5.0 has forgotten wedge15 and pyramid13
    with contextlib.suppress(AttributeError):
        meshio._mesh.topological_dimension.setdefault(kind, dim)
MATERIALS = ("mat_id", "MaterialIds", "material", "CellEntityIds", "ElementBlockIds")  # of VTK: the first of them counts
TAGS = ("gmsh:physical", "medit:ref", "nastran:ref", "cell_tags", "avsucd:material", "flac3d:group", "tetgen:ref")

def say(text):
    print("note:", " ".join(str(text).split()))

def by_meshio():
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return meshio.read(path)
    except ImportError:
        sys.exit(9)
    except SystemExit:
        sys.exit("; ".join(line.strip() for line in said.getvalue().splitlines() if line.strip()) or "it gives no reason")

def by_own_reader():
    try:
        points, cells, sets, point_sets = read_abaqus(path, say)
    except SystemExit as refused:
        print(refused, file=sys.stderr)
        sys.exit(8)
    return meshio.Mesh(points, cells, cell_sets=sets, point_sets=point_sets)

mesh = by_own_reader() if path.lower().endswith(".inp") else by_meshio()
points = numpy.asarray(mesh.points, dtype=float)
if points.ndim != 2 or not 1 < points.shape[1] < 4 or not len(points):
    sys.exit("it finds no nodes in the plane or in space")
blocks = [(block.type, numpy.asarray(block.data)) for block in mesh.cells]
for kind, nodes in blocks:
    if kind not in TYPES:
        sys.exit(f"it finds cells of type {kind}, which rpc does not know")
    if nodes.size and (nodes.min() < 0 or nodes.max() >= len(points)):
        sys.exit(f"cells of type {kind} use node {nodes.max() + 1 if nodes.max() >= len(points) else nodes.min() + 1}; there are 1 to {len(points)}")
WEDGE_18 = [0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10, 15, 17, 16]  # meshio writes these as VTK has them, not in gmsh's order
blocks = [(kind, nodes[:, WEDGE_18] if kind == "wedge18" else nodes) for kind, nodes in blocks]
body = max([TYPES[kind] for kind, nodes in blocks if len(nodes)], default=0)
if body < 2:
    sys.exit("it finds no triangles, quadrilaterals, tetrahedra or hexahedra")
sets = {}  # name -> for each block the places of its cells
for name, of_blocks in (mesh.cell_sets or {}).items():
    sets[str(name)] = [numpy.asarray([] if cells is None else cells, dtype=int) for cells in of_blocks]
point_sets = {str(name): numpy.asarray(nodes, dtype=int).ravel() for name, nodes in (mesh.point_sets or {}).items()}
families = getattr(mesh, "cell_tags", None) or {}  # of MED
for key in TAGS:
    if key not in mesh.cell_data:
        continue
    values = [numpy.asarray(each).ravel() for each in mesh.cell_data[key]]
    for tag in sorted({int(v) for each in values for v in each} - {0}):
        for name in families.get(tag, [str(tag)]) if key == "cell_tags" else [str(tag)]:
            found = [numpy.flatnonzero(each == tag) for each in values]
            sets[name] = [numpy.union1d(a, b) for a, b in zip(sets[name], found)] if name in sets else found
fields = [] if "cell_tags" in mesh.cell_data else [name for name in mesh.cell_data if name not in TAGS]
for key in [name for name in MATERIALS if name in fields][:1]:
    values = [numpy.asarray(each, dtype=float).ravel() for each in mesh.cell_data[key]]
    if all(len(v) == len(nodes) and numpy.array_equal(v, numpy.round(v)) for v, (kind, nodes) in zip(values, blocks)):
        fields.remove(key)
        for tag in sorted({int(v) for each in values for v in each}):
            sets[str(tag)] = [numpy.flatnonzero(each == tag) for each in values]
fields += [name for name in mesh.point_data if name != "point_tags"]
if fields:
    say("fields are left out: " + ", ".join(f'"{name}"' for name in fields))
names, cells, physical = {}, [], []

def add(kind, nodes, name, dim):
    if len(nodes):
        cells.append((kind, nodes))
        tag = names.setdefault((name, dim), 1 + len(names))
        physical.append(numpy.full(len(nodes), tag, dtype=int))

place = {name: k for k, name in enumerate(sets)}
by_size = sorted(sets, key=lambda name: (sum(len(c) for c in sets[name]), place[name]))  # of equal ones the first counts
total, own = dict.fromkeys(by_size, 0), dict.fromkeys(by_size, 0)  # cells of the body in a set, and in its block
for b, (kind, nodes) in enumerate(blocks):
    dim = TYPES[kind]
    if 0 < dim < body - 1:
        say(f"{len(nodes)} cells of type {kind} are no part of a body in space: they are left out")
    if dim < body - 1:
        continue
    owner = numpy.full(len(nodes), -1)
    for k, name in enumerate(by_size):
        at = numpy.unique(sets[name][b]) if b < len(sets[name]) else numpy.array([], dtype=int)
        if len(at) and (at[0] < 0 or at[-1] >= len(nodes)):
            sys.exit(f"set {name} names cells that there are not")
        if dim < body:  # sides may have common facets
            add(kind, nodes[at], name, dim)
        else:
            total[name] += len(at)
            owner[at[owner[at] < 0]] = k
    for k, name in enumerate(by_size if dim == body else []):
        own[name] += numpy.count_nonzero(owner == k)
        add(kind, nodes[owner == k], name, dim)
    if dim == body:
        add(kind, nodes[owner < 0], "body", dim)
for name in by_size:
    if total[name] > own[name]:
        say(f'{total[name] - own[name]} of {total[name]} cells of set "{name}" belong to the block of another set that is no larger')
families = getattr(mesh, "point_tags", None) or {}
if "point_tags" in mesh.point_data:
    values = numpy.asarray(mesh.point_data["point_tags"]).ravel()
    for tag, of_tag in families.items():
        for name in of_tag:
            found = numpy.flatnonzero(values == tag)
            point_sets[name] = numpy.union1d(point_sets[name], found) if name in point_sets else found
nodes_of = {}  # of sides and blocks: a set of the same name and nodes need not be told again
for (name, dim), tag in names.items():
    nodes_of[name] = numpy.unique(numpy.concatenate([n.ravel() for (k, n), t in zip(cells, physical) if t[0] == tag]))
for name, nodes in point_sets.items():
    nodes = numpy.unique(nodes)
    if not len(nodes) or name in nodes_of and numpy.array_equal(nodes_of[name], nodes):
        continue
    if nodes[0] < 0 or nodes[-1] >= len(points):
        sys.exit(f"set {name} names nodes that there are not")
    add("vertex", nodes.reshape(-1, 1), name, 0)
if points.shape[1] == 2:
    points = numpy.column_stack([points, numpy.zeros(len(points))])
data = {"gmsh:physical": physical, "gmsh:geometrical": physical}
meshio.write(target, meshio.Mesh(points, cells, cell_data=data), file_format="gmsh22", binary=True)
with open(target, "rb") as file:
    text = file.read()
lines = ""
for (name, dim), tag in sorted(names.items(), key=lambda item: (item[0][1], item[1])):
    printed = "".join(c if c.isprintable() and c != '"' else "?" for c in name)
    lines += f'{dim} {tag} "{printed}"\n'
begin = text.index(b"$Nodes")
with open(target, "wb") as file:
    file.write(text[:begin] + f"$PhysicalNames\n{len(names)}\n{lines}$EndPhysicalNames\n".encode() + text[begin:])
)py";

} // namespace rpc::mesh

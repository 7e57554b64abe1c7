# SPDX-License-Identifier: BSD-3-Clause
"""Exodus files of rpc: mesh and fields of a time step, from one file or from one a rank, of one mesh or of several."""
import dataclasses
import pathlib
import re

import netCDF4
import numpy as np

from .errors import Error

UNITS = {"length": "m", "force": "N", "stress": "Pa", "energy": "J"}  # of files that do not name theirs


@dataclasses.dataclass
class Block:
    """Cells of one kind, such as the body of a box.

    name     of the block
    element  Exodus' name: TRI3, TRI6, QUAD4, QUAD9, TETRA4, TETRA10, HEX8, HEX27
    cells    (cells, nodes per cell) nodes from 0, in Exodus' order
    """
    name: str
    element: str
    cells: np.ndarray


@dataclasses.dataclass
class Fields:
    """Mesh and fields of one time step. fields["von_mises"] is the field of that name, see `<deck>.e` in doc/input/results.md.

    time    t of the step
    points  (nodes, dim) [m] of the undeformed body; dim 2 or 3; x is the radius of a body of revolution
    blocks  [Block]
    sides   {name: (facets, 2)} cell, counted over all blocks, and Exodus' number of the facet in it, both from 0
    nodal   {name: (nodes,)}: displacement [m], stress [Pa] (> 0 in tension), contact_pressure [Pa] (>= 0), gap, dent, penetration [m], ...
    cell    {name: (cells,)} of all blocks, one after the other: with "Adapt" error_energy_norm [J^1/2], in 2D per m^1/2
    units   {"length": "m", "force": "N", "stress": "Pa", "energy": "J"}, as the deck has them
    title   the deck's name
    """
    time: float
    points: np.ndarray
    blocks: list
    sides: dict
    nodal: dict
    cell: dict
    units: dict
    title: str

    def __getitem__(self, name):
        """(nodes,), of a field of cells (cells,)  @throws Error that lists the names if there is no such field"""
        fields = {**self.nodal, **self.cell}
        if name not in fields:
            raise Error(f'fields: there is no field "{name}"; there are {", ".join(sorted(fields))}')
        return fields[name]

    def vector(self, stem):
        """(nodes, dim) of the fields stem_x, stem_y, ...: "disp", "contact_normal", "friction", "slip"."""
        return np.stack([self[f"{stem}_{axis}"] for axis in "xyz"[:self.points.shape[1]]], axis=1)

    @property
    def displacement(self):
        """(nodes, dim) [m]"""
        return self.vector("disp")

    def side_nodes(self, name):
        """(nodes,) nodes of all facets of a side, from 0 and rising.  @throws Error that lists the sides if there is no such side"""
        if name not in self.sides:
            raise Error(f'fields: there is no side "{name}"; there are {", ".join(sorted(self.sides))}')
        found, start = [np.empty(0, dtype=np.int64)], 0
        for block in self.blocks:
            cells, facets = self.sides[name].T
            own = (cells >= start) & (cells < start + len(block.cells))
            for facet in np.unique(facets[own]):
                found.append(block.cells[cells[own & (facets == facet)] - start][:, FACETS[block.element][facet]].ravel())
            start += len(block.cells)
        return np.unique(np.concatenate(found))


def _facets(text):
    return [[int(node) for node in facet.split()] for facet in text.split(",")]


# Nodes of the facets of each element, in Exodus' order and from 0; corners first.
FACETS = {
    "TRI6": _facets("0 1 3, 1 2 4, 2 0 5"),
    "QUAD9": _facets("0 1 4, 1 2 5, 2 3 6, 3 0 7"),
    "TETRA10": _facets("0 1 3 4 8 7, 1 2 3 5 9 8, 0 3 2 7 9 6, 0 2 1 6 5 4"),
    "HEX27": _facets("0 1 5 4 8 13 16 12 25, 1 2 6 5 9 14 17 13 24, 2 3 7 6 10 15 18 14 26, 0 4 7 3 12 19 15 11 23, 0 3 2 1 11 10 9 8 21, 4 5 6 7 16 17 18 19 22"),
}
FACETS |= {linear: [facet[:corners] for facet in FACETS[quadratic]]
           for linear, quadratic, corners in (("TRI3", "TRI6", 2), ("QUAD4", "QUAD9", 2), ("TETRA4", "TETRA10", 3), ("HEX8", "HEX27", 4))}


class Film:
    """The steps of a run: RESULT.e and, where the mesh changed between steps, RESULT.e-s0002 and so on, each one file or one a rank.

    times  (steps,)
    """

    def __init__(self, paths):
        """@param paths  of all files, in any order  @throws Error if there are none, one is none of rpc, or a rank's is missing"""
        meshes = {}
        for path in map(pathlib.Path, paths):
            mesh, ranks, rank = re.fullmatch(r".*\.e(?:-s(\d+))?(?:\.(\d+)\.(\d+))?", path.name).groups()
            meshes.setdefault(int(mesh or 1), {})[int(rank or 0)] = (path, int(ranks or 1))
        self._meshes = [self._parts(meshes[mesh]) for mesh in sorted(meshes)]
        times = [_read(parts[0], lambda file: np.array(file["time_whole"][:], dtype=float)) for parts in self._meshes]
        self.times = np.concatenate(times) if times else np.empty(0)
        self._steps = [(parts, step) for parts, some in zip(self._meshes, times) for step in range(len(some))]

    @staticmethod
    def _parts(of_rank):
        """Paths of one mesh, by ranks."""
        (first, ranks), *_ = of_rank.values()
        if sorted(of_rank) != list(range(ranks)):
            raise Error(f'fields: of the {ranks} files of "{first.with_suffix("").with_suffix("")}", one a rank, there are {len(of_rank)}')
        return [of_rank[rank][0] for rank in range(ranks)]

    def fields(self, step=-1):
        """@param step  from 0, or from -1 backwards  @throws Error if there is no such step"""
        if not -len(self._steps) <= step < len(self._steps):
            raise Error(f"fields: step must be below {len(self._steps)}, the number of times in the Exodus file, got {step}")
        paths, number = self._steps[step]
        return _joined([_read(path, lambda file: _part(file, number)) for path in paths])


@dataclasses.dataclass
class _Part:
    """What a file has, with the numbers of its nodes and cells in the whole mesh, from 0. cells_of[k] are the numbers of the cells of blocks[k]."""
    fields: Fields
    node: np.ndarray
    cells_of: list

    def of_cells(self, name, block):
        """Of a field, (cells of blocks[block],)."""
        start = sum(len(cells) for cells in self.cells_of[:block])
        return self.fields.cell[name][start:start + len(self.cells_of[block])]


def _read(path, reader):
    try:
        with netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            if "qa_records" not in file.variables or _texts(file["qa_records"][0])[0] != "rpc":
                raise Error(f'fields: "{path}" is not a file of rpc, or damaged; remedy: run it again')
            return reader(file)
    except (OSError, RuntimeError, IndexError):
        raise Error(f'fields: "{path}" does not read as an Exodus file of rpc; remedy: run it again') from None


def _texts(characters):
    return [row.tobytes().split(b"\0")[0].decode(errors="replace").strip() for row in np.asarray(characters)]


def _names(file, variable):
    return _texts(file[variable][:]) if variable in file.variables else []


def _numbers(file, name, count):
    """From 0; a file of the whole mesh has no map."""
    return np.array(file[name][:], dtype=np.int64) - 1 if name in file.variables else np.arange(count)


def _size(file, name):
    return len(file.dimensions[name]) if name in file.dimensions else 0


def _part(file, step):
    node = _numbers(file, "node_num_map", _size(file, "num_nodes"))
    number = _numbers(file, "elem_num_map", _size(file, "num_elem"))
    blocks, cells_of, start = [], [], 0
    for k, name in enumerate(_names(file, "eb_names"), 1):
        cells, element = np.empty((0, 0), dtype=np.int64), ""
        if f"connect{k}" in file.variables:
            cells, element = np.array(file[f"connect{k}"][:], dtype=np.int64) - 1, file[f"connect{k}"].elem_type
        blocks.append(Block(name, element, node[cells]))
        cells_of.append(number[start:start + len(cells)])
        start += len(cells)
    sides = {}
    for k, name in enumerate(_names(file, "ss_names"), 1):
        columns = np.empty((0, 2), dtype=np.int64)
        if f"elem_ss{k}" in file.variables:
            columns = np.stack([number[np.array(file[f"elem_ss{k}"][:], dtype=np.int64) - 1], np.array(file[f"side_ss{k}"][:], dtype=np.int64) - 1], axis=1)
        sides[name or f"side {k}"] = columns
    points = [np.array(file["coord" + axis][:], dtype=float) for axis in "xyz"[:_size(file, "num_dim")] if "coord" + axis in file.variables]
    nodal = {name: np.array(file[f"vals_nod_var{k}"][step], dtype=float) if len(node) else np.empty(0) for k, name in enumerate(_names(file, "name_nod_var"), 1)}
    cell = {name: np.concatenate([np.empty(0)] + [np.array(file[values][step], dtype=float) for block in range(1, len(blocks) + 1)
                                                  if (values := f"vals_elem_var{k}eb{block}") in file.variables])
            for k, name in enumerate(_names(file, "name_elem_var"), 1)}
    records = [re.fullmatch(r"unit of (\w+): (.+)", text) for text in _names(file, "info_records")]
    units = {**UNITS, **{record[1]: record[2] for record in records if record}}
    fields = Fields(float(file["time_whole"][step]), np.stack(points, axis=1) if points else np.empty((0, _size(file, "num_dim"))), blocks, sides, nodal, cell,
                    units, getattr(file, "title", ""))
    return _Part(fields, node, cells_of)


def _joined(parts):
    """The whole mesh. Each node of two ranks has the same values on both."""
    if len(parts) == 1:
        return parts[0].fields
    node = np.concatenate([part.node for part in parts])
    _, first = np.unique(node, return_index=True)  # sorted: row n is node n
    of = parts[0].fields
    blocks, cell = [], {name: [np.empty(0)] for name in of.cell}
    for k, block in enumerate(of.blocks):
        own = [part for part in parts if len(part.cells_of[k])]
        cells = np.concatenate([part.fields.blocks[k].cells for part in own]) if own else block.cells
        order = np.argsort(np.concatenate([part.cells_of[k] for part in own])) if own else np.empty(0, dtype=np.int64)
        for name, values in cell.items():
            values.append(np.concatenate([np.empty(0)] + [part.of_cells(name, k) for part in own])[order])
        blocks.append(Block(block.name, own[0].fields.blocks[k].element if own else block.element, cells[order] if own else cells))
    sides = {}
    for name in of.sides:
        rows = np.concatenate([part.fields.sides[name] for part in parts])
        sides[name] = rows[np.lexsort((rows[:, 1], rows[:, 0]))]
    nodal = {name: np.concatenate([part.fields.nodal[name] for part in parts])[first] for name in of.nodal}
    points = np.concatenate([part.fields.points for part in parts])[first]
    cell = {name: np.concatenate(values) for name, values in cell.items()}
    return Fields(of.time, points, blocks, sides, nodal, cell, of.units, of.title)

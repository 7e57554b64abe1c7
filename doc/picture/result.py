# SPDX-License-Identifier: BSD-3-Clause
"""Reads the Exodus files that rpc writes."""
import difflib
import os
import re

import netCDF4
import numpy as np

import elements


MOST_LISTED = 12  # times in a message
BEYOND = 1e100  # are no places, displacements, gaps
UNITS = {"length": "m", "force": "N", "stress": "Pa", "energy": "J"}  # of files that do not name theirs


class PictureError(Exception):
    """What the user has to mend, as one sentence."""


def suggestion(name, known):
    """" (did you mean ...?)" for a misspelt name, or nothing."""
    by_lower = {one.lower(): one for one in reversed(known)}
    nearest = difflib.get_close_matches(name.lower(), by_lower, 1)
    return f" (did you mean {by_lower[nearest[0]]}?)" if nearest else ""


class Result:
    """Mesh and fields of one time step of a film: RESULT.e and, where the mesh changed between steps, RESULT.e-s0002 and so on.

    path      the file that has the step
    positions (nodes, 3) [m] of the undeformed body; z = 0 in the plane
    blocks    [(element's name, (cells, nodes per cell))], nodes from 0
    side_sets {name: (facets, 2)} cell and the facet's place in it, both from 0
    nodal     {name: (nodes,)}, cell {name: (cells of all blocks,)}
    units     {"length": name, "force": name, "stress": name, "energy": name}
    """

    def __init__(self, path, time=None):
        """@param time [s] of the step; None: the last one."""
        if not os.path.isfile(path):
            raise PictureError(f'"{path}": no such file; rpc writes one unless Output->Exodus is false')
        self.parts = film(path)
        times = [read(part, times_of) for part in self.parts]
        self.num_times = sum(len(some) for some in times)
        which, step = chosen(times, time, self.parts[0])
        self.path, self.time = self.parts[which], times[which][step]
        read(self.path, lambda file, path: self._read(file, path, step))

    def _read(self, file, path, step):
        self.title = getattr(file, "title", "")
        records = [re.fullmatch(r"unit of (\w+): (.+)", text) for text in names(file, "info_records")]
        self.units = UNITS | {record[1]: record[2] for record in records if record}
        self.dim = len(file.dimensions["num_dim"])
        self.positions = np.zeros((len(file.dimensions["num_nodes"]), 3))
        for d, axis in enumerate("xyz"[: self.dim]):
            self.positions[:, d] = file["coord" + axis][:]
        numbers = [k for k in range(1, len(file.dimensions["num_el_blk"]) + 1) if f"connect{k}" in file.variables]
        self.blocks = []
        for k in numbers:
            name = file[f"connect{k}"].elem_type
            if name not in elements.CELLS:
                raise PictureError(f'"{path}": cells must be {", ".join(elements.CELLS)}, got {name}')
            self.blocks.append((name, np.asarray(file[f"connect{k}"][:], dtype=np.int64) - 1))
        self._require_mesh()
        self.side_sets = side_sets(file, self.num_cells())
        self.nodal = {name: np.asarray(file[f"vals_nod_var{n}"][step], dtype=float)
                      for n, name in enumerate(names(file, "name_nod_var"), 1)}
        self.cell = {name: np.concatenate([cell_values(file, n, k, step) for k in numbers])
                     for n, name in enumerate(names(file, "name_elem_var"), 1)}
        wanted = self.vector_names("disp_")
        if "contact_status" in self.nodal:
            wanted += ["gap", "dent", "penetration", *self.vector_names("contact_normal_")]
        missing = [name for name in wanted if name not in self.nodal]
        if missing:
            raise PictureError(f'"{path}" has no field {missing[0]}; remedy: run this version of rpc again')
        for name in wanted:
            if not (abs(self.nodal[name]) < BEYOND).all():
                raise ValueError(f"{name} has entries that are no numbers, or beyond {BEYOND:g}")

    def _require_mesh(self):
        """Numbers of a mesh must fit each other. @throws ValueError"""
        if self.dim not in (2, 3) or not self.blocks or not (abs(self.positions) < BEYOND).all():
            raise ValueError("its mesh has no cells, or nodes without a place")
        for name, cells in self.blocks:
            if cells.ndim != 2 or cells.shape[1] != int(name.lstrip("TRIQUADEHX")):
                raise ValueError(f"cells of {name} have another number of nodes")
            if cells.size and not (0 <= cells.min() and cells.max() < len(self.positions)):
                raise ValueError("a cell has a node that the mesh has not")
            if name.startswith(("TETRA", "HEX")) != (self.dim == 3):
                raise ValueError(f"cells of {name} in {self.dim} dimensions")

    def num_cells(self):
        """Of all blocks."""
        return sum(len(cells) for _, cells in self.blocks)

    def vector_names(self, stem):
        """Names of a vector's components."""
        return [stem + axis for axis in "xyz"[: self.dim]]

    def vector(self, stem):
        """(nodes, 3), z = 0 in the plane."""
        values = np.zeros_like(self.positions)
        for d, name in enumerate(self.vector_names(stem)):
            values[:, d] = self.nodal[name]
        return values

    def contact_nodes(self):
        """(nodes,) whether the node is a contact node; None without contact."""
        return self.nodal["contact_status"] >= 0 if "contact_status" in self.nodal else None

    def peak(self, name):
        """Largest size of a field at all times; 0 where no file has it."""
        return max(read(part, lambda file, _: largest_of(file, name)) for part in self.parts)

    def cell_sizes(self):
        """(cells of all blocks,) root of the area, in space cube root of the volume, between a cell's vertices."""
        found = []
        for name, cells in self.blocks:
            kind = elements.CELLS[name][0]
            if self.dim == 2:
                x, y, _ = np.moveaxis(self.positions[cells[:, : elements.VERTICES[kind]]], 2, 0)
                area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
                found.append(np.sqrt(abs(area)))
            else:
                corner = self.positions[cells[:, elements.tetrahedra(name)]]
                found.append(np.cbrt(abs(np.linalg.det(corner[:, :, 1:] - corner[:, :, :1])).sum(axis=1) / 6))
        return np.concatenate(found)

    def size(self):
        """Largest extent of the undeformed body [m]."""
        return np.ptp(self.positions, axis=0).max()


def texts(characters):
    """Rows of characters as texts."""
    return [row.tobytes().split(b"\0")[0].decode(errors="replace").strip() for row in np.asarray(characters)]


def names(file, variable):
    """Names of the fields of a kind, or other texts; none if the file has no such variable."""
    return texts(file[variable][:]) if variable in file.variables else []


def cell_values(file, variable, block, step):
    """(cells of the block,); nan where the block lacks the field."""
    name = f"vals_elem_var{variable}eb{block}"
    if name in file.variables:
        return np.asarray(file[name][step], dtype=float)
    return np.full(len(file.dimensions[f"num_el_in_blk{block}"]), np.nan)


def read(path, reader):
    """What reader(file, path) returns of an Exodus file of rpc."""
    try:
        with netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            if "qa_records" not in file.variables or texts(file["qa_records"][0])[0] != "rpc":
                raise PictureError(f'"{path}" is not a file of rpc: its QA record names another program, or none')
            return reader(file, path)
    except (OSError, RuntimeError):
        raise PictureError(f'"{path}" is not an Exodus file; pictures are made of RESULT.e, *.contact.csv, *.history.csv and *.json') from None
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise PictureError(f'"{path}" is damaged: {first_line(error)}; remedy: run rpc again') from None


def first_line(error):
    """Of what an exception says."""
    return (str(error).splitlines() or [type(error).__name__])[0]


def film(path):
    """The files of a run, in the order of time, from any one of them."""
    first = re.sub(r"\.e-s\d{4,}$", ".e", path)
    if not os.path.isfile(first):
        return [path]
    parts = [first]
    while os.path.isfile(following := f"{first}-s{len(parts) + 1:04d}"):
        parts.append(following)
    return parts if path in parts else [path]


def times_of(file, path):
    """(steps,) of a file."""
    times = np.asarray(file["time_whole"][:])
    if not len(times):
        raise PictureError(f'"{path}" has no time step')
    return times


def chosen(times, time, path):
    """(file, step) of a time, None: the last one. @param times  [(steps,)] of each file of the film that begins with `path`"""
    if time is None:
        return len(times) - 1, len(times[-1]) - 1
    for which, some in reversed(list(enumerate(times))):
        step = int(np.abs(some - time).argmin())
        if abs(some[step] - time) <= 1e-6 * max(abs(time), 1e-6):
            return which, step
    raise PictureError(f'"{path}": --time must be {rule_of(np.concatenate(times), time)}, got {time:g}')


def rule_of(times, time):
    """What times there are, and which of many are nearest."""
    if len(times) == 1:
        return f"{times[0]:g}, the only time there is"
    if len(times) <= MOST_LISTED:
        return "one of " + ", ".join(f"{value:g}" for value in times)
    nearest = np.sort(times[np.argsort(np.abs(times - time), kind="stable")[:2]])
    return f"one of {len(times)} times from {times.min():g} to {times.max():g}, nearest {nearest[0]:g} and {nearest[1]:g}"


def side_sets(file, num_cells):
    """{name: (facets, 2)} cell and place of the facets of each side, see Result."""
    if "ss_names" not in file.variables:
        return {}
    found = {}
    for n, name in enumerate(texts(file["ss_names"][:]), 1):
        if f"elem_ss{n}" in file.variables:
            columns = [np.asarray(file[f"{stem}_ss{n}"][:], dtype=np.int64) - 1 for stem in ("elem", "side")]
            if columns[0].size and not (0 <= columns[0].min() and columns[0].max() < num_cells and 0 <= columns[1].min() and columns[1].max() < 6):
                raise ValueError(f"side {name or n} has a facet of a cell that the mesh has not")
            found[name or f"side {n}"] = np.stack(columns, axis=1)
    return found


def largest_of(file, name):
    """Largest size of a field of nodes at all times of a file."""
    fields = names(file, "name_nod_var")
    return float(np.abs(file[f"vals_nod_var{1 + fields.index(name)}"][:]).max(initial=0)) if name in fields else 0.0

# SPDX-License-Identifier: BSD-3-Clause
"""What a run has written: Exodus, contact table and summary, as arrays."""
import csv
import dataclasses
import json
import pathlib
import re

import netCDF4
import numpy as np

from elements import Element


@dataclasses.dataclass
class Block:
    name: str
    element: Element
    cells: np.ndarray  # (cells, nodes)


@dataclasses.dataclass
class Mesh:
    coords: np.ndarray  # (nodes, dim)
    blocks: list
    sides: dict  # {name: [(block, cell of the block, facet)]}

    @property
    def dim(self):
        return self.coords.shape[1]

    def facets(self, side):
        """(element, cells (facets, nodes), facet's number) of each kind of facet on a side."""
        groups = {}
        for block, cell, facet in self.sides[side]:
            groups.setdefault((block, facet), []).append(cell)
        for (block, facet), cells in sorted(groups.items()):
            yield self.blocks[block].element, self.blocks[block].cells[cells], facet

    def side_nodes(self, side):
        found = [cells[:, element.facet_nodes(facet)].ravel() for element, cells, facet in self.facets(side)]
        return np.unique(np.concatenate(found)) if found else np.array([], dtype=int)


class Run:
    """A run that has ended: exit code, console, and its files where there are some."""

    def __init__(self, folder, code, stdout="", stderr="", seconds=0.0, name="scene"):
        self.folder, self.code, self.stdout, self.stderr, self.seconds = pathlib.Path(folder), code, stdout, stderr, seconds
        self.name = name
        path = self.folder / f"{name}.json"
        self.summary = json.loads(path.read_text()) if path.exists() else None
        self.mesh, self.times, self.fields = None, [], []
        exodus = self.last_exodus()
        if exodus:
            self._read(exodus)

    def last_exodus(self):
        """The file of the last mesh: <deck>.e, or of steps on several meshes the last of <deck>.e-s0002, ..."""
        files = sorted(path for path in self.folder.glob(f"{self.name}.e*") if re.fullmatch(rf"{self.name}\.e(-s\d+)?", path.name))
        return files[-1] if files else None

    def _read(self, path):
        with netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            variables = file.variables
            coords = np.stack([variables["coord" + axis][:] for axis in "xyz" if "coord" + axis in variables], axis=1)
            blocks, starts = [], [0]
            for number, name in enumerate(texts(variables["eb_names"]), 1):
                connect = variables.get(f"connect{number}")
                if connect is not None:
                    blocks.append(Block(name, Element(connect.elem_type), connect[:] - 1))
                    starts.append(starts[-1] + len(blocks[-1].cells))
            self.mesh = Mesh(coords, blocks, {})
            for number, name in enumerate(texts(variables["ss_names"]), 1):
                if f"elem_ss{number}" in variables:
                    elements, facets = variables[f"elem_ss{number}"][:] - 1, variables[f"side_ss{number}"][:] - 1
                    of = np.searchsorted(starts, elements, side="right") - 1
                    self.mesh.sides[name] = [(int(b), int(e - starts[b]), int(s)) for b, e, s in zip(of, elements, facets)]
            self.times = [float(t) for t in variables["time_whole"][:]]
            names = texts(variables["name_nod_var"])
            self.fields = [{name: np.array(variables[f"vals_nod_var{k}"][step]) for k, name in enumerate(names, 1)} for step in range(len(self.times))]

    def vector(self, step, stem):
        """(nodes, dim) of the fields stem_x, stem_y, ...; 0 where there are none."""
        names = [f"{stem}_{axis}" for axis in "xyz"[:self.mesh.dim]]
        return np.stack([self.fields[step].get(name, np.zeros(len(self.mesh.coords))) for name in names], axis=1)

    def contact_rows(self):
        texts_of = {"state", "side", "friction_state"}
        with open(self.folder / f"{self.name}.contact.csv", newline="") as file:
            return [{k: v if k in texts_of else float(v) for k, v in row.items()} for row in csv.DictReader(file)]

    def step_summaries(self):
        """The summary of each step; of a run without steps that of the whole."""
        return self.summary.get("steps") or [self.summary]

    def parts(self, step):
        return self.step_summaries()[step].get("parts", 1)

    def reason(self):
        """Why the run has ended so: its messages, and what the summary says of the solve and of targets that were asked for."""
        told = self.summary or {}
        words = [line for line in self.stderr.splitlines() if line.startswith("rpc:")]
        words += [told.get("reason", "")] + [told.get(target, {}).get("reason", "") for target in ("adaptation", "energy_tolerance")]
        return " ".join(word for word in words if word)


def texts(variable):
    return [str(text).strip("\0 ") for text in np.atleast_1d(netCDF4.chartostring(variable[:]))]

"""Reads the Exodus files that rpc writes."""
import os

import netCDF4
import numpy as np

import elements


class PictureError(Exception):
    """What the user has to mend, as one sentence."""


class Result:
    """Mesh and fields of one time step.

    positions (nodes, 3) [m] of the undeformed body; z = 0 in the plane
    blocks    [(element's name, (cells, nodes per cell))], nodes from 0
    nodal     {name: (nodes,)}, cell {name: (cells of all blocks,)}
    """

    def __init__(self, path, time=None):
        """@param time [s] of the step; None: the last one."""
        if not os.path.isfile(path):
            raise PictureError(f'"{path}": no such file; rpc writes one unless Output->Exodus is false')
        try:
            with netCDF4.Dataset(path) as file:
                file.set_auto_mask(False)
                self._read(file, path, time)
        except (OSError, RuntimeError):
            raise PictureError(f'"{path}" is not an Exodus file') from None

    def _read(self, file, path, time):
        if "qa_records" not in file.variables or texts(file["qa_records"][0])[0] != "rpc":
            raise PictureError(f'"{path}" is not a file of rpc: its QA record names another program, or none')
        self.title = getattr(file, "title", "")
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
        times = np.asarray(file["time_whole"][:])
        if not len(times):
            raise PictureError(f'"{path}" has no time step')
        step = len(times) - 1 if time is None else int(np.abs(times - time).argmin())
        if time is not None and abs(times[step] - time) > 1e-6 * max(abs(time), 1e-6):
            raise PictureError(f'"{path}": --time must be one of {listed(times)}, got {time:g}')
        self.time, self.num_times = times[step], len(times)
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

    def size(self):
        """Largest extent of the undeformed body [m]."""
        return np.ptp(self.positions, axis=0).max()


def texts(characters):
    """Rows of characters as texts."""
    return [row.tobytes().split(b"\0")[0].decode(errors="replace").strip() for row in np.asarray(characters)]


def names(file, variable):
    """Names of the fields of a kind, none if the file has no such variable."""
    return texts(file[variable][:]) if variable in file.variables else []


def cell_values(file, variable, block, step):
    """(cells of the block,); nan where the block lacks the field."""
    name = f"vals_elem_var{variable}eb{block}"
    if name in file.variables:
        return np.asarray(file[name][step], dtype=float)
    return np.full(len(file.dimensions[f"num_el_in_blk{block}"]), np.nan)


def listed(values):
    """At most ten numbers as a text."""
    return ", ".join(f"{value:g}" for value in values[:10]) + (", ..." if len(values) > 10 else "")

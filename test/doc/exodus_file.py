# SPDX-License-Identifier: BSD-3-Clause
"""Writes small Exodus files as rpc's: boxes of each element, for tests of what reads them."""
import itertools

import netCDF4
import numpy as np

# Places of the nodes in the cell [0, 2]^d, in the order of the Exodus manual.
SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
TRIANGLE = [(0, 0), (2, 0), (0, 2), (1, 0), (1, 1), (0, 1)]
CUBE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
        (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1),
        (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (1, 1, 1),
        (1, 1, 0), (1, 1, 2), (0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1)]
MIDDLES_OF_TETRAHEDRON = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
NODES = {"TRI3": 3, "TRI6": 6, "QUAD4": 4, "QUAD9": 9, "TETRA4": 4, "TETRA10": 10, "HEX8": 8, "HEX27": 27}


def dim(element):
    """Of the space that the element fills."""
    return 3 if element.startswith(("TETRA", "HEX")) else 2


def places_in_cube(element):
    """Places of the nodes of the cells that one square or cube is divided into."""
    if element.startswith("QUAD"):
        return [SQUARE]
    if element.startswith("HEX"):
        return [CUBE]
    if element.startswith("TRI"):
        return [TRIANGLE, [(2 - x, 2 - y) for x, y in TRIANGLE]]
    cells = []
    for path in itertools.permutations(range(3)):
        vertices = [np.zeros(3, dtype=int)]
        for axis in path:
            vertices.append(vertices[-1] + 2 * np.eye(3, dtype=int)[axis])
        if np.linalg.det(np.diff(vertices, axis=0)) < 0:
            vertices[1], vertices[2] = vertices[2], vertices[1]
        middles = [(vertices[a] + vertices[b]) // 2 for a, b in MIDDLES_OF_TETRAHEDRON]
        cells.append([tuple(place) for place in (*vertices, *middles)])
    return cells


def box(element, n):
    """Nodes (nodes, dim) and cells of the unit square or cube, n x n (x n) squares or cubes."""
    number, cells = {}, []
    for corner in itertools.product(range(n), repeat=dim(element)):
        for places in places_in_cube(element):
            nodes = [tuple(2 * c + p for c, p in zip(corner, place)) for place in places[: NODES[element]]]
            cells.append([number.setdefault(node, len(number)) for node in nodes])
    return np.array(list(number)) / (2 * n), np.array(cells)


def write(path, element, positions, cells, nodal, cell=None, times=(1.0,), program="rpc", title="box", sides=None, units=None):
    """@param nodal, cell  {name: (nodes,) or (cells,) values}, the same at all times but for the factor t
    @param units        {"length": name, ...} of its information records
    @param sides        {name: (facets, 2)} cell and the facet's place in it, both from 0
    """
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        file.title = title
        put_sides(file, sides or {})
        if units:
            file.createDimension("num_info", len(units))
            put_texts(file.createVariable("info_records", "S1", ("num_info", "len_string")),
                      [f"unit of {kind}: {name}" for kind, name in units.items()])
        for name, size in {"num_dim": positions.shape[1], "num_nodes": len(positions), "num_el_blk": 1,
                           "four": 4, "num_qa_rec": 1, "time_step": None, "num_el_in_blk1": len(cells),
                           "num_nod_per_el1": cells.shape[1], "num_nod_var": len(nodal), "num_elem_var": len(cell or {})}.items():
            if size != 0:
                file.createDimension(name, size)
        put_texts(file.createVariable("qa_records", "S1", ("num_qa_rec", "four", "len_string")), [[program, "0", "", ""]])
        for d, axis in enumerate("xyz"[: positions.shape[1]]):
            file.createVariable("coord" + axis, "f8", ("num_nodes",))[:] = positions[:, d]
        connect = file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
        connect.elem_type = element
        connect[:] = cells + 1
        file.createVariable("time_whole", "f8", ("time_step",))[:] = times
        for kind, stem, size, fields in (("nod", "vals_nod_var{}", "num_nodes", nodal),
                                         ("elem", "vals_elem_var{}eb1", "num_el_in_blk1", cell or {})):
            if not fields:
                continue
            put_texts(file.createVariable(f"name_{kind}_var", "S1", (f"num_{kind}_var", "len_string")), list(fields))
            for n, values in enumerate(fields.values(), 1):
                variable = file.createVariable(stem.format(n), "f8", ("time_step", size))
                for step, time in enumerate(times):
                    variable[step] = time * values


def put_sides(file, sides):
    """The side sets of a file."""
    file.createDimension("len_string", 33)
    if sides:
        file.createDimension("num_side_sets", len(sides))
        put_texts(file.createVariable("ss_names", "S1", ("num_side_sets", "len_string")), list(sides))
    for n, facets in enumerate(sides.values(), 1):
        file.createDimension(f"num_side_ss{n}", len(facets))
        for stem, column in (("elem", 0), ("side", 1)):
            file.createVariable(f"{stem}_ss{n}", "i4", (f"num_side_ss{n}",))[:] = np.asarray(facets)[:, column] + 1


def put_texts(variable, texts):
    """Fills a variable of characters."""
    variable[:] = netCDF4.stringtochar(np.array(texts, dtype="S33"))

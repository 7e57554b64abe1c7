# SPDX-License-Identifier: BSD-3-Clause
"""Reads of a run's summary, RESULT.json, what it tells of the meshes that it has adapted, or of how pressures are spread over the contact."""
import json

import numpy as np

from result import PictureError

UNITS = {"relative_estimate": "", "energy_J": "energy", "max_pressure": "stress", "max_penetration": "length", "contact_length": "length"}


def read(path):
    """The summary."""
    try:
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
    except OSError as error:
        what = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise PictureError(f'"{path}": {what}; rpc writes a summary unless Output->JSON is false') from None
    except (ValueError, RecursionError) as error:
        raise PictureError(f'"{path}" is no JSON: {str(error).splitlines()[0]}') from None
    if not isinstance(told, dict) or "rpc_version" not in told:
        raise PictureError(f'"{path}" is not a summary of rpc')
    return told


def kind_of(path):
    """What of a summary is drawn: "patches" where no meshes were adapted and there is contact, else "adaptation"."""
    try:
        told = read(path)
    except PictureError:
        return "adaptation"  # which says what is wrong
    return "patches" if "adaptation" not in told and told.get("contact_patches") else "adaptation"


def spread(path):
    """({column: numbers}, {column: unit}) of the histogram of pressures, all contact sides together, as a line of steps."""
    told = read(path)
    try:
        histograms = [side["pressure_histogram"] for side in told["contact_patches"].values()]
        ends = max((np.array(one["ends"], dtype=float) for one in histograms), key=lambda each: each[-1])
        sizes = np.zeros(len(ends) - 1)
        for one in histograms:  # of a side with lower pressures in the bins of that with the highest
            middle = 0.5 * (np.array(one["ends"][1:], dtype=float) + np.array(one["ends"][:-1], dtype=float))
            np.add.at(sizes, np.clip(np.searchsorted(ends, middle) - 1, 0, len(sizes) - 1), np.array(one["sizes"], dtype=float))
        share = np.repeat(sizes / max(sizes.sum(), np.finfo(float).tiny), 2)
        return {"pressure": np.repeat(ends, 2)[1:-1], "share_of_contact": share}, {"pressure": told["units"]["stress"]}
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise PictureError(f'"{path}" is damaged: "contact_patches" is not what rpc writes; remedy: run rpc again') from None


def meshes(path):
    """({column: (meshes,) numbers}, {column: unit}, target of the relative estimate) of the meshes, from the first to the last."""
    told = read(path)
    if "adaptation" not in told:
        raise PictureError(f'"{path}" tells of no adapted meshes and no contact; rpc adapts meshes with Adapt->Target Relative Error')
    try:
        cycles, target = told["adaptation"]["cycles"], float(told["adaptation"]["target"])
        columns = {name: np.array([number(cycle[name]) for cycle in cycles]) for name in cycles[0] if not isinstance(cycles[0][name], list)}
        for d, axis in enumerate("xyz"[: len(cycles[0]["contact_force"])]):
            columns[f"contact_force_{axis}"] = np.array([number(cycle["contact_force"][d]) for cycle in cycles])
        names = told["units"]
        units = {name: names[kind] for name, kind in UNITS.items() if kind} | {name: names["force"] for name in columns if "force" in name}
        units |= {"contact_area": f"{names['length']}^2"}
        return columns, {name: unit for name, unit in units.items() if name in columns}, target
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise PictureError(f'"{path}" is damaged: "adaptation" is not what rpc writes; remedy: run rpc again') from None


def number(value):
    """Of a value that may be null."""
    return np.nan if value is None else float(value)

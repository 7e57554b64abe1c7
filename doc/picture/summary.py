# SPDX-License-Identifier: BSD-3-Clause
"""Reads of a run's summary, RESULT.json, what it tells of the meshes that it has adapted."""
import json

import numpy as np

from result import PictureError

UNITS = {"relative_estimate": "", "energy_J": "energy", "max_pressure": "stress", "max_penetration": "length", "contact_length": "length"}


def meshes(path):
    """({column: (meshes,) numbers}, {column: unit}, target of the relative estimate) of the meshes, from the first to the last."""
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
    if "adaptation" not in told:
        raise PictureError(f'"{path}" tells of no adapted meshes; rpc adapts them with Adapt->Target Relative Error')
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

# SPDX-License-Identifier: BSD-3-Clause
"""From where a body is seen."""
import dataclasses

import numpy as np

import view
from surface import VALUE, outward, unit

SEEN = 0.2  # cosine from which on a face is seen
ALONG = 1e-6  # sine up to which a direction is that of an axis


def upwards(scene):
    """The axis of space that leads away from the foundation; z without one."""
    main = abs(scene.normal).argmax() if abs(scene.normal).max() > 0.5 else 2
    up = np.zeros(3)
    up[main] = -1 if scene.normal[main] > 0.5 else 1
    return up


def level_directions(scene, up):
    """Directions to the viewer, level: four, or two that see into the cut; first the one from which most stress is seen."""
    first, second = (np.eye(3)[(abs(up).argmax() + k) % 3] for k in (1, 2))
    candidates = [a * first + b * second for a, b in ((0.8, -0.6), (-0.8, -0.6), (0.8, 0.6), (-0.8, 0.6))]
    if scene.cut:
        out = scene.cut.towards * np.eye(3)[scene.cut.axis]
        candidates = [c for c in candidates if c @ out > 0] or candidates
    rows = scene.layers["body"]
    sides = np.cross(rows[:, 1, :3] - rows[:, 0, :3], rows[:, 2, :3] - rows[:, 0, :3])
    seen = [(np.clip(sides @ c, 0, None) * abs(np.nan_to_num(rows[..., VALUE].mean(axis=1)))).sum() for c in candidates]
    best = next(k for k, amount in enumerate(seen) if amount >= 0.98 * max(seen))
    return [candidates[best], *candidates[:best], *candidates[best + 1 :]]


def is_seen(scene, side, direction):
    """Whether the larger part of what a contact side bears, or of the side if it bears nothing, looks towards the viewer."""
    normals = np.concatenate([outward(face, scene.result.positions) for face in side.faces])
    sizes = np.linalg.norm(normals, axis=1)
    pressure = np.concatenate([side.fields["contact_pressure"][face.nodes].mean(axis=1) for face in side.faces])
    weights = sizes * np.maximum(pressure, 0) if pressure.max() > 0 else sizes
    return weights[normals @ unit(direction) > SEEN * sizes].sum() > 0.5 * weights.sum()


def upright(direction, up):
    """An axis that leads upwards in a picture seen from a direction: `up`, or if that is seen from its end y, or z."""
    for axis in (up, np.eye(3)[1], np.eye(3)[2]):
        if np.linalg.norm(np.cross(axis, unit(direction))) > ALONG:
            return axis
    raise AssertionError("a direction cannot be along two axes")


@dataclasses.dataclass
class Panel:
    """One view of the body, and the layers that it leaves out."""

    view: view.View
    caption: str = ""
    without: tuple = ()


def panels(scene, direction):
    """[Panel]: one, or in space two if contact sides show their field; the second one sees those that the first one does not."""
    if scene.result.dim == 2:
        return [Panel(view.FRONT)]
    up = upwards(scene)
    if direction is not None:
        return [Panel(view.view_from(direction, upright(direction, up)))]
    levels = level_directions(scene, up)
    first = levels[0] + 0.45 * up
    if not scene.contact_field or not scene.sides:
        return [Panel(view.view_from(first, up))]
    hidden = [side for side in scene.sides if not is_seen(scene, side, first)]
    below = max((level - 0.7 * up for level in levels), key=lambda towards: sum(is_seen(scene, side, towards) for side in hidden))
    return [Panel(view.view_from(first, up), "on the foundation"), Panel(view.view_from(below, -up), "turned over", view.GROUND_LAYERS)]

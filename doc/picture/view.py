# SPDX-License-Identifier: BSD-3-Clause
"""From where a body is seen, and the picture that it makes in pixels."""
import dataclasses

import numpy as np

import raster
from friction import ZONES
from style import LIGHT
from surface import NORMAL, PLACE, VALUE, unit

SUPERSAMPLING = 3
GROUND_LAYERS = ("foundation", "ground")
ZONE_LINE = 10  # pixels of the fine raster
MARGIN = ZONE_LINE  # of the picture, in such pixels: lines that end within it may show
BACK = 2  # pixels of the fine raster by which the foundation steps back, lest rounding decides where it touches the body


@dataclasses.dataclass
class View:
    """Orthographic: rows of `axes` point to the right, upwards and to the viewer."""

    axes: np.ndarray

    def project(self, points):
        """(..., 3): to the right, upwards, away from the viewer [m]."""
        return points @ (self.axes * np.array([[1], [1], [-1]])).T


FRONT = View(np.eye(3))


def view_from(direction, up):
    """The view of someone who looks from a direction."""
    towards = unit(np.asarray(direction, dtype=float))
    right = unit(np.cross(up, towards))
    return View(np.stack([right, np.cross(towards, right), towards]))


def points_of(scene, without=()):
    """(n, 3) places of all that is drawn, but for some layers; of what is longer than a dot at least two."""
    found = [rows[..., PLACE].reshape(-1, 3) for name, rows in scene.layers.items() if name not in without]
    if scene.rest is not None:
        found.append(scene.rest.reshape(-1, 3))
    return np.concatenate(found)


def bounds(scene, view, without=()):
    """(left, right, bottom, top) of what is drawn [m]; in the plane the window if there is one."""
    if scene.window is not None and scene.result.dim == 2:
        (left, bottom), (right, top) = scene.window
    else:
        across = view.project(points_of(scene, without))[:, :2]
        (left, bottom), (right, top) = across.min(axis=0), across.max(axis=0)
    return left, right, bottom, top


def paint(scene, view, window, pixels, colors, without=(), style=LIGHT):
    """RGBA (rows from the bottom, columns, 4) of a window (left, right, bottom, top), `pixels` to the metre.

    @param colors   {"body": and "contact": (norm, colour map)}
    @param without  layers that are left out
    """
    left, right, bottom, top = window
    fine = pixels * SUPERSAMPLING
    width, height = (max(int(round((high - low) * pixels)), 1) * SUPERSAMPLING for low, high in ((left, right), (bottom, top)))
    corner = np.array([left, bottom, 0])
    canvas = raster.Raster(width, height)
    layers = {name: seen_from(view, name, rows) for name, rows in scene.layers.items() if name not in without}
    rows = np.concatenate(list(layers.values()))
    layer_of = np.repeat(np.arange(len(layers)), [len(part) for part in layers.values()])
    places = (view.project(rows[..., PLACE]) - corner) * fine
    places[np.isin(layer_of, [k for k, name in enumerate(layers) if name in GROUND_LAYERS]), :, 2] += BACK
    canvas.draw(places)
    plain = {**style.zones, "arrows": style.ink}  # layers of one colour; others without a field have the foundation's
    image = np.zeros((height * width, 4))
    data = rows[..., [VALUE, *range(6)[NORMAL]]].astype(np.float32)
    shown = np.flatnonzero(canvas.triangle >= 0)
    for pixels in np.array_split(shown, len(shown) // raster.CHUNK + 1):
        found, layer = canvas.values(data, pixels), layer_of[canvas.triangle[pixels]]
        color = np.empty((len(pixels), 3))
        for k, name in enumerate(layers):
            norm, color_map = colors.get(name, (None, None))
            color[layer == k] = color_map(norm(found[layer == k, 0]))[:, :3] if norm else plain.get(name, style.ground)
        if scene.result.dim == 3:
            color *= brightness(found[:, 1:], view)[:, None]
        image[pixels, :3], image[pixels, 3] = color, 1
    image = image.reshape(height, width, 4)
    for zone in (None, *reversed(ZONES)):
        ink = np.zeros(canvas.shape)
        for lines in scene.lines:
            if lines.layer not in without and lines.zone == zone:
                lines = lines if lines.normals is None else looking_away(view, lines)
                points, opacity = dots(lines, (view.project(lines.points) - corner) * fine, canvas.shape)
                ink = np.maximum(ink, canvas.ink(points, opacity, ZONE_LINE if zone else 2 if lines.fades else 4, tolerance=5))
        image[..., :3] = image[..., :3] * (1 - ink[..., None]) + style.zones.get(zone, style.ink) * ink[..., None]
        image[..., 3] = np.maximum(image[..., 3], ink)
    image[..., :3] *= image[..., 3:]  # so that the mean of pixels is that of their colours
    image = raster.reduced(image, SUPERSAMPLING)
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)
    return np.clip(image, 0, 1)


def seen_from(view, name, rows):
    """The triangles of a layer that are drawn: the foundation's surface only where it is not between viewer and body, arrows where the
    side on which they lie looks towards the viewer."""
    towards = rows[..., NORMAL].mean(axis=1) @ view.axes[2]
    return rows[towards <= 0] if name == "ground" else rows[towards > 0] if name == "arrows" else rows


def looking_away(view, lines):
    """The lines whose normals look away from the viewer."""
    kept = lines.normals @ view.axes[2] <= 0
    return dataclasses.replace(lines, points=lines.points[kept], levels=lines.levels[kept], normals=None)


def brightness(normals, view):
    """(n,) of surfaces, seen from either side, under a lamp to the left of the viewer."""
    normals = unit(normals @ view.axes.T)
    normals *= np.where(normals[:, 2:] < 0, -1, 1)
    return 0.75 + 0.25 * np.clip(normals @ unit(np.array([-0.45, 0.25, 0.85])), 0, 1)


def dots(lines, points, shape=None):
    """Points (n, 3), less than a pixel apart, of lines at projected points, and how dark they are (n,).

    @param shape  (height, width) of the picture; None: lines are not cut where it ends
    """
    across = np.linalg.norm(np.diff(points[..., :2], axis=1), axis=2)  # (lines, pieces)
    opacity = np.full(len(points), lines.opacity)
    if lines.fades:
        opacity *= np.clip((across.sum(axis=1) / SUPERSAMPLING - 4) / 12, 0, 1)
    kept = opacity > 0
    ends = np.concatenate([points, lines.levels], axis=2)[kept]
    start, end = (part.reshape(-1, ends.shape[2]) for part in (ends[:, :-1], ends[:, 1:]))
    begin, finish = (0.0, 1.0) if shape is None else within(start, end, shape)
    counts = np.where(begin <= finish, np.ceil(across[kept].ravel() * np.maximum(finish - begin, 0)) + 1, 0).astype(np.int64)
    piece, step = raster.expanded(counts, np.zeros(len(counts), dtype=np.int64))
    begin, finish = (np.broadcast_to(t, counts.shape)[piece] for t in (begin, finish))
    t = begin + (finish - begin) * step / counts[piece]
    found = start[piece] + t[:, None] * (end - start)[piece]
    seen = (found[:, 3:] <= 0).all(axis=1)
    return found[seen, :3], np.repeat(opacity[kept], across.shape[1])[piece][seen]


def within(start, end, shape):
    """From where to where, of 0 to 1 each, pieces of lines lie in a picture (height, width) or close to it; none if the first is larger."""
    begin, finish = np.zeros(len(start)), np.ones(len(start))
    for d, size in ((0, shape[1]), (1, shape[0])):
        along = end[:, d] - start[:, d]
        still = along == 0
        low, high = ((limit - start[:, d]) / np.where(still, 1, along) for limit in (-MARGIN, size + MARGIN))
        outside = still & ((start[:, d] < -MARGIN) | (start[:, d] > size + MARGIN))
        begin = np.where(still, np.where(outside, 2, begin), np.maximum(begin, np.minimum(low, high)))
        finish = np.where(still, finish, np.minimum(finish, np.maximum(low, high)))
    return begin, finish

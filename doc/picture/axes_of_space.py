# SPDX-License-Identifier: BSD-3-Clause
"""Axes of a picture in space."""
import numpy as np
from matplotlib import ticker

import view
from surface import unit
from text import GAP, SMALL, width_of

NUMBER = 8  # points of the numbers along the axes


class AxesOfSpace:
    """The three edges of the box around all that is drawn that lie at the rim of the picture, with ticks.

    lines  [(2 ends, 2)] and texts [(text, place (2,), size (2,), points)], to the right and upwards from the panel's centre [inches]
    """

    def __init__(self, scene, panel, window, inches, style):
        points = view.points_of(scene, panel.without)
        self.low, self.high = points.min(axis=0), points.max(axis=0)
        self.view, self.inches, self.unit, self.style = panel.view, inches, scene.result.units["length"], style
        self.centre = np.array([0.5 * (window[0] + window[1]), 0.5 * (window[2] + window[3])])
        self.half = 0.5 * inches * np.array([window[1] - window[0], window[3] - window[2]])
        self.lines, self.texts, names = [], [], []
        for d in range(3):
            if np.linalg.norm(self.view.project(np.eye(3)[d])[:2]) > 0.1:  # else seen from its end
                names.append(self._add_axis(d))
        for name, place, out in names:
            self._add_text(name, SMALL, lambda distance, place=place, out=out: place + distance * out, 0.62 if abs(out[0]) > 0.9 else 0.5)

    def _project(self, point):
        return (self.view.project(point)[:2] - self.centre) * self.inches

    def _add_axis(self, d):
        """Adds an axis without its name; returns that, where it belongs, and the direction away from the body."""
        along = unit(self.view.project(np.eye(3)[d])[:2])
        upright = abs(along[1]) > 0.9
        out = np.array([along[1], -along[0]])
        if (out[0] if upright else out[1]) > 0:
            out = -out  # downwards, or to the left
        corners = np.array(np.meshgrid(*zip(self.low, self.high))).reshape(3, -1).T
        start = max(corners[corners[:, d] == self.low[d]], key=lambda corner: (self._project(corner) @ out).round(9))

        def place(value, distance):
            return self._project(np.where(np.arange(3) == d, value, start)) + distance * out

        low, high = self.low[d], self.high[d]
        self.lines.append((place(low, 0.1), place(high, 0.1)))
        length = np.linalg.norm(place(high, 0) - place(low, 0))
        for tick in ticker.MaxNLocator(max(1, int(length / 0.5)), steps=[1, 2, 5, 10]).tick_values(low, high):
            if low <= tick <= high and length > 0.3:  # numbers of a shorter one would overlap
                self.lines.append((place(tick, 0.1), place(tick, 0.16)))
                number = f"{round(tick, 12):g}"
                aside = np.array([-0.5 * width_of(number, NUMBER), 0]) if upright else 0
                self._add_text(number, NUMBER, lambda distance, tick=tick, aside=aside: place(tick, distance) + aside,
                               0.2 if upright else 0.27, most=0.3)
        return f"{'xyz'[d]} [{self.unit}]", place(0.5 * (low + high), 0), out

    def _add_text(self, text, points, place, distance, most=2.0):
        """Adds a text at the least distance at which it covers no other; leaves it out beyond the largest one."""
        size = np.array([width_of(text, points) + 0.06, 1.3 * points / 72])
        start = distance
        while any((abs(place(distance) - other) < 0.5 * (size + extent)).all() for _, other, extent, _ in self.texts):
            distance += 0.02
            if distance > start + most:
                return
        self.texts.append((text, place(distance), size, points))

    def pad(self):
        """Inches to the left of and below the panel."""
        low = np.min([place - 0.5 * size for _, place, size, _ in self.texts], axis=0) if self.texts else -self.half
        return np.maximum(-self.half - low + GAP, 0.3)

    def draw(self, axes):
        """Into the panel's axes."""
        to_window = lambda place: self.centre + np.asarray(place) / self.inches  # noqa: E731
        left, bottom = self.centre - self.half / self.inches
        right, top = self.centre + self.half / self.inches
        axes.set(xlim=(left, right), ylim=(bottom, top))
        axes.set_axis_off()
        for ends in self.lines:
            axes.plot(*to_window(ends).T, color=self.style.rule, linewidth=0.8, clip_on=False, zorder=1)
        for text, place, _, points in self.texts:
            color = self.style.faint if points == NUMBER else self.style.text
            axes.text(*to_window(place), text, fontsize=points, color=color, ha="center", va="center")

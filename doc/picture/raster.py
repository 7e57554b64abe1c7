# SPDX-License-Identifier: BSD-3-Clause
"""Triangles and lines with hidden parts removed, pixel by pixel: neither a display nor a GPU is needed.

Positions are in pixels: x to the right, y upwards, depth away from the viewer; pixel (row, column) has its centre at
(column + 1/2, row + 1/2).
"""
import numpy as np

CHUNK = 200_000  # pixels at a time: what fits the cache


class Raster:
    """What each pixel shows: the triangle's number, -1 for none, and the weights of its second and third vertex."""

    def __init__(self, width, height):
        self.shape = (height, width)
        self.depth = np.full(width * height, np.inf, dtype=np.float32)
        self.triangle = np.full(width * height, -1, dtype=np.int32)
        self.weights = np.zeros((width * height, 2), dtype=np.float32)

    def draw(self, triangles):
        """@param triangles (n, 3 vertices, 3) positions; their numbers are their places in this one call"""
        a, b, c = (triangles[:, k] for k in range(3))
        area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        height, width = self.shape
        low = np.ceil(np.maximum(triangles[:, :, 1].min(axis=1), 0) - 0.5).astype(np.int64)
        high = np.floor(np.minimum(triangles[:, :, 1].max(axis=1), height) - 0.5).astype(np.int64)
        rows = np.where(abs(area) > 1e-12, np.clip(high - low + 1, 0, None), 0)
        for part in parts(rows):
            number, row = expanded(rows[part], low[part])
            self._draw_rows(triangles, area, number + part.start, row)

    def _draw_rows(self, triangles, area, number, row):
        """Pixels of triangles in one pixel row each."""
        y = row + 0.5
        corners, sign = triangles[number], np.sign(area[number])
        left, right = np.full(len(row), 0.0), np.full(len(row), float(self.shape[1]))
        for k in range(3):
            p, q = corners[:, k], corners[:, (k + 1) % 3]
            # The inside is where slope x + rest >= 0.
            slope = -(q[:, 1] - p[:, 1]) * sign
            rest = ((q[:, 0] - p[:, 0]) * (y - p[:, 1]) + (q[:, 1] - p[:, 1]) * p[:, 0]) * sign
            with np.errstate(divide="ignore", invalid="ignore"):
                bound = -rest / slope
            left = np.where(slope > 0, np.maximum(left, bound), left)
            right = np.where(slope < 0, np.minimum(right, bound), right)
            right = np.where((slope == 0) & (rest < 0), -1, right)
        # A thousandth of a pixel more, lest rounding leaves gaps between neighbours.
        first = np.ceil(np.clip(left, 0, None) - 0.5 - 1e-3).astype(np.int64)
        last = np.floor(np.clip(right, -1, self.shape[1]) - 0.5 + 1e-3).astype(np.int64)
        first, last = np.maximum(first, 0), np.minimum(last, self.shape[1] - 1)
        counts = np.clip(last - first + 1, 0, None)
        for part in parts(counts):
            span, column = expanded(counts[part], first[part])
            span += part.start
            self._draw_pixels(corners[span], area[number[span]], number[span], row[span], column)

    def _draw_pixels(self, corners, area, number, row, column):
        a, b, c = (corners[:, k] for k in range(3))
        x, y = column + 0.5 - a[:, 0], row + 0.5 - a[:, 1]
        second = (x * (c[:, 1] - a[:, 1]) - y * (c[:, 0] - a[:, 0])) / area
        third = (y * (b[:, 0] - a[:, 0]) - x * (b[:, 1] - a[:, 1])) / area
        depth = (a[:, 2] + second * (b[:, 2] - a[:, 2]) + third * (c[:, 2] - a[:, 2])).astype(np.float32)
        pixel = row * self.shape[1] + column
        places = np.arange(len(pixel))
        while len(places):  # as long as something lies in front of what is there; several may claim a pixel, one gets it
            places = places[depth[places] < self.depth[pixel[places]]]
            claims = np.empty(0, dtype=np.int64) if not len(places) else self._claim(pixel[places], places)
            self.depth[pixel[claims]] = depth[claims]
            self.triangle[pixel[claims]] = number[claims]
            self.weights[pixel[claims]] = np.stack([second[claims], third[claims]], axis=1)

    def _claim(self, pixels, places):
        """One of the places for each pixel."""
        self.triangle[pixels] = places
        return places[self.triangle[pixels] == places]

    def values(self, data, pixels):
        """(pixels, m): data (n, 3 vertices, m) of the triangles drawn, interpolated at pixels that show one."""
        second, third = self.weights[pixels].T[..., None]
        a, b, c = (data[self.triangle[pixels], k] for k in range(3))
        return (1 - second - third) * a + second * b + third * c

    def ink(self, points, opacity, width, tolerance):
        """How much ink (height, width) points of lines leave; behind a surface, by more than the tolerance, none.

        @param points    (n, 3) positions, a pixel or less apart along each line
        @param opacity   (n,) in [0, 1]
        @param width     of the lines, an integer
        """
        height, columns = self.shape
        result = np.zeros(columns * height)
        column, row = (np.floor(points[:, d]).astype(np.int64) for d in range(2))
        for down in range(width):
            for aside in range(width):
                r, c = row - down + width // 2, column - aside + width // 2
                inside = (r >= 0) & (r < height) & (c >= 0) & (c < columns)
                pixel = r[inside] * columns + c[inside]
                seen = points[inside, 2] <= self.depth[pixel] + tolerance
                np.maximum.at(result, pixel[seen], opacity[inside][seen])
        return result.reshape(self.shape)


def parts(counts):
    """Slices of about CHUNK items, at least one entry each."""
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts):
        before = ends[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, before + CHUNK, side="right")))
        yield slice(start, stop)
        start = stop


def expanded(counts, first):
    """Entry and number of each item: entry i has counts[i] numbers from first[i] on."""
    entry = np.repeat(np.arange(len(counts)), counts)
    start = np.cumsum(counts) - counts
    return entry, np.arange(len(entry)) - start[entry] + first[entry]


def reduced(image, factor):
    """Mean of factor x factor pixels."""
    height, width = image.shape[0] // factor, image.shape[1] // factor
    return image[: height * factor, : width * factor].reshape(height, factor, width, factor, -1).mean(axis=(1, 3))

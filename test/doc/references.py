# SPDX-License-Identifier: BSD-3-Clause
"""Compares pictures with those in references/, without their texts: letters differ between versions of fonts.

RPC_WRITE_REFERENCES=1 in the environment writes them anew; look at them before they are committed.
"""

import os
import pathlib

import matplotlib.image
import numpy as np
from matplotlib.text import Text

FOLDER = pathlib.Path(__file__).parent / "references"
BODY, DIAGRAM = 0.03, 0.1  # of what a picture differs from its background, in the root of the mean square: lines are smoothed in many ways
DPI = 32


def expect_like(test, image, name, most=BODY):
    """An image (rows, columns, 3) must look like the reference of that name."""
    path = FOLDER / f"{name}.png"
    if os.environ.get("RPC_WRITE_REFERENCES"):
        FOLDER.mkdir(exist_ok=True)
        matplotlib.image.imsave(path, image)
    expected = matplotlib.image.imread(path)[..., :3]
    test.assertEqual(image.shape, expected.shape, name)
    background = np.median(expected.reshape(-1, 3), axis=0)
    test.assertLess(size_of(image - expected), most * size_of(expected - background), f"the picture differs from {path}")


def size_of(differences):
    """Root of the mean square."""
    return float(np.sqrt((differences**2).mean()))


def on_background(image, colour):
    """(rows from the top, columns, 3) of what `view.paint` returns."""
    return (image[..., :3] * image[..., 3:] + np.asarray(matplotlib.colors.to_rgb(colour)) * (1 - image[..., 3:]))[::-1]


def without_texts(drawn):
    """(rows, columns, 3) of a diagram: its panels one above the other, without texts."""
    drawn.set_layout_engine("none")
    for text in drawn.findobj(Text):
        text.set_visible(False)
    number = len(drawn.axes)
    for k, axes in enumerate(drawn.axes):
        axes.set_position([0.03, 1 - (k + 0.95) / number, 0.94, 0.9 / number])
        if axes.get_legend():
            axes.get_legend().set_visible(False)
    drawn.set_size_inches(6, 2.5 * number)
    drawn.set_dpi(DPI)
    drawn.canvas.draw()
    return np.asarray(drawn.canvas.buffer_rgba())[..., :3] / 255

# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of fewer pixels and colours: python3 smaller.py PICTURE ..."""

import sys

from PIL import Image

WIDTH, COLOURS = 900, 256

for name in sys.argv[1:]:
    picture = Image.open(name).convert("RGB")
    if picture.width > WIDTH:
        picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.LANCZOS)
    picture.quantize(COLOURS, dither=Image.Dither.NONE).save(name, optimize=True)

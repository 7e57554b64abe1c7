# SPDX-License-Identifier: BSD-3-Clause
"""Picture files: PNG, PDF or SVG, by the ending of their names."""
import io
import os

import matplotlib

from result import PictureError

FORMATS = ("png", "pdf", "svg")
UNDATED = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}  # the same picture is the same file


def format_of(path):
    """Of a file name; None if it is none of FORMATS."""
    ending = os.path.splitext(path)[1][1:].lower()
    return ending if ending in FORMATS else None


def write(path, figure, style):
    """Replaces the file at once: an older picture stays if that fails. Letters and lines of PDF and SVG are sharp; bodies are pixels."""
    kind = format_of(path)
    picture = io.BytesIO()
    with matplotlib.rc_context(style.rc()):
        figure.savefig(picture, format=kind, dpi=style.dpi, metadata=UNDATED[kind])
    temporary = path + ".part"
    try:
        with open(temporary, "wb") as file:
            file.write(picture.getvalue())
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise PictureError(f'cannot write "{path}": {error.strerror}') from None

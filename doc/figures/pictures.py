# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of doc/pictures.md by its own commands, small, from results in a folder: pictures.py FOLDER

Each picture of the page in figures/pictures is that of the command before it; of two commands in a block they are in their order.
Debian packages: doc/packages.txt.
"""
import contextlib
import dataclasses
import os
import pathlib
import re
import shlex
import sys
import tempfile

from PIL import Image

DOC = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(DOC / "picture"))
import command_line  # noqa: E402
import style  # noqa: E402

DPI = 70
BLOCK = re.compile(r"```sh\n(.*?)```(.*?)(?=```sh|\Z)", re.DOTALL)
COMMAND, IMAGE = re.compile(r"bash doc/picture\.sh (.*)"), re.compile(r"!\[[^]]*\]\((figures/[^)]*)\)")


def commands(page):
    """[(arguments, picture)] of a page."""
    found = []
    for block, after in BLOCK.findall(page):
        found += zip((shlex.split(line) for line in COMMAND.findall(block)), IMAGE.findall(after), strict=True)
    return found


def main(folder):
    style.STYLES |= {name: dataclasses.replace(one, dpi=DPI) for name, one in style.STYLES.items()}
    (DOC / "figures" / "pictures").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch, contextlib.chdir(folder):
        for arguments, picture in commands((DOC / "pictures.md").read_text()):
            made = os.path.join(scratch, "a.png")
            if command_line.main([*(one for one in arguments if not one.startswith("--output=")), f"--output={made}"]):
                sys.exit(f"{picture}: the page's command has failed: {shlex.join(arguments)}")
            if picture.startswith("figures/pictures/"):
                image = Image.open(made).convert("RGB").quantize(255, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
                image.save(DOC / picture, optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:])

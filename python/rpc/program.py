# SPDX-License-Identifier: BSD-3-Clause
"""Where the program is."""
import os
import pathlib
import shutil

from .errors import Error

BUILT = ("build/rpc", "rpc")  # in a checkout: of cmake --build, and of cmake/run.sh


def find_program(program=None):
    """The program's path.

    The first there is of: `program`; $RPC_PROGRAM; build/rpc or rpc of the checkout that this module lies in; the same of the current folder, if it is
    a checkout; `rpc` on PATH. A name that is given, by argument or environment, must be there.

    @throws Error that tells where it was looked for
    """
    for source, given in (("program", program), ("$RPC_PROGRAM", os.environ.get("RPC_PROGRAM"))):
        if given:
            found = shutil.which(os.path.abspath(given)) or shutil.which(given)
            if not found:
                raise Error(f'program: {source} = "{given}" is no program that can be run; remedy: give the path of rpc, as build/rpc of a checkout')
            return pathlib.Path(found).resolve()
    places = [folder / name for folder in _checkouts() for name in BUILT]
    for place in places:
        if place.is_file() and os.access(place, os.X_OK):
            return place
    found = shutil.which("rpc")
    if not found:
        searched = ", ".join(map(str, [*places, "PATH"]))
        raise Error(f"program: there is no rpc; searched: {searched}; remedy: build it (bash cmake/run.sh --input=beam.xml), name it in $RPC_PROGRAM, "
                    "or give program=PATH")
    return pathlib.Path(found).resolve()


def deck_folders():
    """Where decks are looked for that are not there as given: as the program does."""
    folders = [pathlib.Path(os.environ["RPC_INPUT_DIR"])] if os.environ.get("RPC_INPUT_DIR") else []
    try:
        beside = find_program().parent
        folders += [beside.parent / "share" / "rpc" / "input", beside.parent / "input"]
    except Error:
        pass
    return folders + [folder / "input" for folder in _checkouts()]


def _checkouts():
    """The checkout that this module lies in, and the current folder if it is one."""
    folders = {pathlib.Path(__file__).resolve().parents[2]: None, pathlib.Path.cwd(): None}
    return [folder for folder in folders if (folder / "packages" / "contact").is_dir() and (folder / "CMakeLists.txt").is_file()]

# SPDX-License-Identifier: BSD-3-Clause
"""What all tests of the module share. CTest tells of program and launcher by $RPC_PROGRAM and $RPC_MPIRUN, which is empty where there is no MPI."""
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).resolve().parents[1]
SOURCE = FOLDER.parent
sys.path.insert(0, str(FOLDER))
os.environ.setdefault("PYTHONPATH", str(FOLDER))  # of Pythons that tests start

try:
    import rpc
except ImportError as missing:
    print(f"skipped: {missing}; what this takes: bash cmake/install_packages.sh doc/packages.txt")
    sys.exit(77)

HAS_MPI = os.environ.get("RPC_MPIRUN", "mpirun") != ""
SMALL = {"Mesh->Cells": [20, 4]}
LARGE = {"Mesh->Cells": [1600, 320], "Output->Exodus": "none"}  # of the beam: takes seconds


def beam(**settings):
    """The paper's beam on a coarse mesh; names of settings have __ for ->, _ for blanks."""
    named = {name.replace("__", "->").replace("_", " "): value for name, value in settings.items()}
    return rpc.with_settings(rpc.read_deck(SOURCE / "input" / "beam.xml"), {**SMALL, **named})


class TestCase(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.mkdtemp(prefix="rpc_python_")
        self.addCleanup(shutil.rmtree, scratch, ignore_errors=True)
        self.folder = pathlib.Path(scratch)

    def script(self, text, name="program.sh"):
        """A program of the shell; "$RPC" in it is rpc."""
        path = self.folder / name
        path.write_text(f"#!/bin/sh\nRPC='{rpc.find_program()}'\n{text}\n")
        path.chmod(0o755)
        return path

    def environment(self, **values):
        """Sets variables for one test; None takes one out."""
        for name, value in values.items():
            self.addCleanup(os.environ.__setitem__, name, os.environ[name]) if name in os.environ else self.addCleanup(os.environ.pop, name, None)
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = str(value)

    def refused(self, parts, function, *arguments, code=None, **options):
        """The Error of a call, one line that has all the parts."""
        with self.assertRaises(rpc.Error) as caught:
            function(*arguments, **options)
        self.assertEqual(caught.exception.code, code, caught.exception)
        self.assertEqual(len(str(caught.exception).splitlines()), 1, str(caught.exception))
        for part in parts:
            self.assertIn(part, str(caught.exception))
        return caught.exception

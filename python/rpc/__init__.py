# SPDX-License-Identifier: BSD-3-Clause
"""Runs rpc, contact of an elastic body with a rigid-plastic foundation, and reads its results as arrays.

    import rpc
    result = rpc.run("beam.xml", settings={"Contact->Yield Stress": 12})
    result.summary["contact_force"], result.contact()["pressure"], result.fields()["von_mises"]

A deck is a dict of dicts with the names of doc/input/parameters.md, or the name of a file. Each run is a process of its own. Units are those of the deck:
rpc converts none; where docstrings name m, N and Pa, other consistent units stand for them. Signs are those of doc/input/README.md: pressure >= 0 is
compression, a gap < 0 is initial penetration, stresses are positive in tension, contact forces act on the body.

    read_deck, write_deck, with_settings    a deck as a dict
    run, study, load                        one run; many; results of earlier runs
    Result, Fields                          what a run has left, as arrays
    Error                                   why there is no result: exit code, message, remedy
"""
from .deck import read_deck, with_settings, write_deck
from .errors import Error
from .exodus import Fields
from .program import find_program
from .result import Result, load
from .runs import run
from .studies import study

__all__ = ["Error", "Fields", "Result", "find_program", "load", "read_deck", "run", "study", "with_settings", "write_deck"]
__version__ = "0.4.0"

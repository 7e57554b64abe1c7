# SPDX-License-Identifier: BSD-3-Clause
"""What programs of random scenes share: their options, scenes judged side by side, a folder for each, decks as YAML."""

import argparse
import concurrent.futures
import contextlib
import json
import os
import pathlib
import shutil
import tempfile


def arguments(description, count, *more):
    """The options of a program.

    count: scenes unless told otherwise; more: (name, settings) of options that this program alone has.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=int, default=count)
    parser.add_argument("--only", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--np", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpiexec --oversubscribe --bind-to none")
    parser.add_argument("--keep", help="folder for the files of scenes")
    for name, settings in more:
        parser.add_argument(name, **settings)
    options = parser.parse_args()
    options.rpc = os.path.abspath(options.rpc)
    return options


def numbers(options):
    return [options.only] if options.only is not None else range(options.scenes)


def each(options, judge, *more):
    """What judge(options, number, *more) says of each scene, in order."""
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        yield from pool.map(lambda number: judge(options, number, *more), numbers(options))


def compared(options, judge):
    """Judges scenes that are run in two ways. @return (number of failures, what the scenes measured)

    judge: gives (complaint or None, what happened, what is measured or None)
    """
    failed, measured = 0, []
    for number, (complaint, what, one) in zip(numbers(options), each(options, judge)):
        failed += complaint is not None
        measured += [one] if one is not None else []
        print(f"{number}: {'FAILED ' + complaint if complaint else what}", flush=True)
    return failed, measured


@contextlib.contextmanager
def folder(options, name, kept=lambda: True):
    """A folder for the files of a scene, which is copied to options.keep under its name where kept() says so at the end."""
    path = pathlib.Path(tempfile.mkdtemp(prefix="rpc_"))
    try:
        yield path
    finally:
        if options.keep and kept():
            shutil.copytree(path, pathlib.Path(options.keep) / name, dirs_exist_ok=True)
        shutil.rmtree(path, ignore_errors=True)


def written(entries, indent=2):
    """Entries of a deck in YAML, whose texts and numbers are those of JSON."""
    lines = []
    for key, value in entries.items():
        inner = "\n" + written(value, indent + 2) if isinstance(value, dict) else f" {json.dumps(value)}\n"
        lines.append(f"{' ' * indent}{json.dumps(key)}:{inner}")
    return "".join(lines)

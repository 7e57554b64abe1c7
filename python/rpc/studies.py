# SPDX-License-Identifier: BSD-3-Clause
"""Many runs of one deck with other parameters."""
import concurrent.futures
import copy
import csv
import hashlib
import itertools
import math
import os
import pathlib
import subprocess
import sys
import threading
import time
from collections.abc import Mapping

from .deck import lists_with_files, read_deck, text_of, with_settings, xml_of
from .errors import Error
from .program import find_program
from .result import RECORD, load
from .runs import launcher, start

LASTING = {0, 4, 5}  # exit codes that come from the deck alone: such a run is not run again
RESULTS = ("contact_force", "obstacle_displacement", "max_pressure", "contact_length", "contact_area", "energy_J")  # of the summary that study.csv has; of vectors the size


def study(deck, parameters, *, folder=None, workers=1, progress=True, ranks=1, program=None, timeout=None):
    """Runs a deck for many parameters. Returns [Result] in the order of the parameters, runs that failed among them: see Result.ok and Result.message.

    study(deck, {"Contact->Yield Stress": [8, 12, 16], "Contact->Gap": [0, 0.01]}) are six runs, the last name varies fastest;
    study(deck, [{"Contact->Yield Stress": 8, "Mesh->Cells": [80, 16]}, {...}]) are those of the list. Result.settings are the parameters of a run.

    @param folder    keeps each run in a folder of its own, run-KEY, and study.csv with a row for each: its parameters, how it ended and its main results,
                     see RESULTS; a study that is called again with it, after Ctrl-C or with more parameters, does not run again what has ended with
                     exit code 0, 4 or 5 and is the same: deck, files of mesh and obstacles, number of ranks and version of the program. None: temporary
                     folders, which go with the results
    @param workers   runs at a time, > 0
    @param progress  a line on standard error for each run that has ended
    @param ranks, program, timeout  of each run, see run()
    @throws Error before the first run if a deck cannot be written or there is no program
    """
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise Error(f"study: workers must be an int > 0, got {workers!r}")
    deck = dict(deck) if isinstance(deck, Mapping) else read_deck(deck)
    rows = _rows(parameters)
    decks = [with_settings(deck, row) for row in rows]
    program = find_program(program)
    launcher(ranks)
    for each in decks:
        xml_of(each)
    version = _version(program) if folder is not None else ""
    keys = [_key(each, ranks, version) if folder is not None else number for number, each in enumerate(decks)]
    folders = {key: None if folder is None else pathlib.Path(folder) / f"run-{key}" for key in keys}
    show = _Progress(len(folders), progress)

    live, lock, ended = set(), threading.Lock(), threading.Event()

    def started(process):
        with lock:
            live.add(process)
            if ended.is_set():
                process.terminate()

    def one(key, of, settings):
        kept = _kept(folders[key])
        result = kept or start(of, ranks, program, folders[key], {}, timeout, started=started)
        result.settings = settings
        show(result, kept is not None)
        return result

    with concurrent.futures.ThreadPoolExecutor(max_workers=workers) as pool:
        futures = {}
        for key, of, row in zip(keys, decks, rows):
            if key not in futures:  # two equal rows are one run
                futures[key] = pool.submit(one, key, of, row)
        try:
            results = {key: future.result() for key, future in futures.items()}
        except BaseException:
            with lock:
                ended.set()
                for process in live:
                    process.terminate()
            pool.shutdown(cancel_futures=True)
            raise
    found = [_of_row(results[key], row) for key, row in zip(keys, rows)]
    if folder is not None:
        _index(pathlib.Path(folder) / "study.csv", rows, found)
    return found


def _rows(parameters):
    """[{path: value}] of all runs."""
    if not isinstance(parameters, Mapping):
        rows = list(parameters)
        if not all(isinstance(row, Mapping) for row in rows):
            raise Error("study: parameters must be a dict of lists or a list of dicts")
        return [dict(row) for row in rows]
    for path, values in parameters.items():
        if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__iter__"):
            raise Error(f'study: "{path}" must have a list of values, got {values!r}')
    return [dict(zip(parameters, values)) for values in itertools.product(*parameters.values())]


def _of_row(result, row):
    """The result of a run, for one of the rows that have it."""
    if result.settings == row:
        return result
    result = copy.copy(result)
    result.settings = row
    return result


def _key(deck, ranks, version):
    """What a run depends on, as a short name."""
    found = hashlib.sha256(f"{xml_of(deck)}\n{ranks}\n{version}\n".encode())
    for entry in lists_with_files(deck):
        if isinstance(entry["File"], (str, os.PathLike)) and os.path.isfile(entry["File"]):
            found.update(pathlib.Path(entry["File"]).read_bytes())
    return found.hexdigest()[:12]


def _version(program):
    try:
        return subprocess.run([program, "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""


def _kept(folder):
    """The result of an earlier call, if it is the deck's; None if there is none."""
    if folder is None or not (folder / ("deck" + RECORD)).is_file():
        return None
    try:
        result = load(folder / "deck")
    except Error:
        return None
    whole = all((folder / file).is_file() for file in result.files)
    return result if whole and result.code in LASTING and "interrupted by" not in result.message else None


def _index(path, rows, results):
    """A table of all runs, for people and spreadsheets."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    main = [_main_results(result) for result in results]
    columns = list(dict.fromkeys(column for found in main for column in found))
    try:
        with open(path, "w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["folder", "exit_code", *names, "seconds", *columns, "reason"])
            for row, result, found in zip(rows, results, main):
                seconds = "" if result.seconds is None else f"{result.seconds:.3g}"
                table.writerow([result.folder.name, result.code, *(_text(row[name], name) if name in row else "" for name in names), seconds,
                                *(found.get(column, "") for column in columns), result.message])
    except OSError as error:
        raise Error(f'study: cannot write "{path}": {error.strerror}') from None


def _main_results(result):
    """{column of study.csv: number or unit} of a run that has left any. The force of several sides is their sum, which may be 0: each has a column, too."""
    try:
        summary = result.summary
    except Error:
        return {}
    found = {}
    for key in RESULTS:
        entry = summary.get("results", {}).get(key) if summary.get("time") is not None else None
        if entry is None:
            continue
        value, bar = entry["value"], entry["error_bar"]
        found[key] = math.hypot(*value) if isinstance(value, list) else value
        found[f"{key}_unit"] = entry["unit"]
        found[f"{key}_error_bar"] = "" if bar is None else bar
        if key == "contact_force":
            for side, results in summary["results"].get("contact_sides", {}).items():
                found[f"contact_force on {side}"] = math.hypot(*results["contact_force"]["value"])
    for side, entry in summary.get("results", {}).get("force_displacement", {}).items() if summary.get("time") is not None else ():
        found[f"force_displacement of {side}"] = math.hypot(*entry["value"])
        found[f"force_displacement of {side}_unit"] = entry["unit"]
    return found


def _text(value, path):
    return "{...}" if isinstance(value, dict) else text_of(value, path)


class _Progress:
    """A line on standard error for each run that has ended, with an estimate of the time left from the runs so far."""

    def __init__(self, count, shown):
        self.count, self.shown, self.done, self.ran, self.lock, self.begin = count, shown, 0, 0, threading.Lock(), time.monotonic()

    def __call__(self, result, kept):
        with self.lock:
            self.done += 1
            self.ran += not kept
            if not self.shown:
                return
            what = ", ".join(f"{path} = {_text(value, path)}" for path, value in result.settings.items()) or "the deck itself"
            how = "kept from before" if kept else f"{result.seconds:.1f} s"
            end = "converged" if result.ok else f"exit code {result.code}, {result.message}"
            left = (time.monotonic() - self.begin) / self.ran * (self.count - self.done) if self.ran else 0
            more = f", about {left:.0f} s left" if self.done < self.count and self.ran else ""
            print(f"{self.done}/{self.count} {what}: {end} ({how}{more})", file=sys.stderr, flush=True)

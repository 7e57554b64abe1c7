# SPDX-License-Identifier: BSD-3-Clause
"""What a run has left: exit code, messages, and its files as arrays."""
import csv
import json
import pathlib
import re
import signal

import numpy as np

from .errors import Error, remedy_of
from .exodus import Film

TEXTS = {"state", "side", "friction_state", "reason", "name"}  # columns of the tables
MOST_LETTERS = 300  # of a message of others than rpc
RECORD = ".run.json"  # behind the run's name: what the results' files do not tell


class Result:
    """A run that has ended, well or not.

    folder    where its files are
    name      what they begin with
    code      exit code of the program, see Error; None of a run that was not started from here and has not done what was asked for
    seconds   wall-clock time of the process
    settings  {path: value} of a study, or as run() got them
    files     names of the files that the run has written; those of earlier runs in the same folder are none
    """

    def __init__(self, folder, name, code=None, stderr="", seconds=None, settings=None, files=()):
        self.folder, self.name, self.code = pathlib.Path(folder), name, code
        self.stderr, self.seconds, self.settings, self.files = stderr, seconds, dict(settings or {}), sorted(files)
        self._summary = self._film = None

    def __repr__(self):
        return f"<rpc.Result {self.name} in {self.folder}: {'exit code ' + str(self.code) if self.code else 'converged' if self.code == 0 else 'loaded'}>"

    @property
    def ok(self):
        """Whether the run has converged and met all targets that were asked for."""
        return self.code == 0

    @property
    def console(self):
        """What the program has printed, a text."""
        path = self.folder / f"{self.name}.log"
        return path.read_text(errors="replace") if path.is_file() else ""

    @property
    def summary(self):
        """The JSON file as a dict, see `<deck>.json` in doc/input/results.md; null is None.  @throws Error if the run has written none"""
        if self._summary is None:
            try:
                self._summary = json.loads(self._file(".json", '"Output->JSON"').read_text())
            except ValueError:
                raise Error(f'summary: "{self.folder / self.name}.json" is damaged; remedy: run it again') from None
        return self._summary

    def contact(self):
        """`<deck>.contact.csv` as a structured array, one row per contact node: contact()["pressure"] is (nodes,).

        Fields: x, y, in space z [m]; s [m] along the side in the plane, or area [m^2]; u_nu, gap, dent [m]; pressure [Pa] >= 0; state: "open", "closed",
        "yielding", "unseen"; side, a text; with friction q_x, ... [Pa] of the body on the foundation, slip_x, ... [m], friction_used, friction_state; u_t_x, ... [m] along the side; force_x, ... [N or N/m] on the body.

        @throws Error if the run has written none
        """
        return _table(self._file(".contact.csv", '"Contact" and "Output->CSV"'))

    def history(self):
        """`<deck>.history.csv` as a structured array, one row per load step, see doc/input/results.md for its columns.

        @throws Error if the run has written none, as without "Steps"
        """
        return _table(self._file(".history.csv", '"Steps->Times"'))

    def points(self):
        """`<deck>.points.csv` as a structured array, one row per point and step: time, name, number, x, y, in space z, s, off, disp_x, ..., stress_xx, ...,
        von_mises and contact_pressure, nan off the contact sides.

        @throws Error if the run has written none, as without "Output->Points"
        """
        return _table(self._file(".points.csv", '"Output->Points"'))

    @property
    def times(self):
        """(steps,) t of the steps in the Exodus files."""
        return self._exodus().times

    def fields(self, step=-1):
        """Mesh and nodal fields of a step, the last one by default: Fields.  @throws Error if there is no such step, or no Exodus file"""
        return self._exodus().fields(step)

    @property
    def message(self):
        """Why the run has not done what was asked for, in one line; "" if it has."""
        if self.code == 0:
            return ""
        said = self._said()
        if not said and self.code is not None and self.code < 0:
            said = f"killed by signal {-self.code} ({signal.strsignal(-self.code)})"
        words = " ".join((said or re.sub(r"^-+$", "", self.stderr, flags=re.MULTILINE)).split()) or "no message"
        return words if said or len(words) <= MOST_LETTERS else words[:MOST_LETTERS].rstrip() + " ..."

    def error(self):
        """The Error of this run, whatever its code."""
        return Error(self.message, self.code, remedy_of(self.code or 0, bool(self._said())), self)

    def record(self):
        """Keeps what the results' files do not tell, for load()."""
        told = {key: getattr(self, key) for key in ("code", "stderr", "seconds", "files")}
        path = self.folder / (self.name + RECORD)
        new = path.with_name(path.name + ".tmp")
        new.write_text(json.dumps(told, indent=1))
        new.replace(path)

    def _said(self):
        """What the program has said of it."""
        said = re.findall(r"^rpc: (?:internal )?error: (.*)$", self.stderr, re.MULTILINE)
        if not said and self.code in (4, None):
            said = self._reasons()
        return " ".join(dict.fromkeys(said))

    def _reasons(self):
        """What the summary says of the solve and of targets."""
        if f"{self.name}.json" not in self.files:
            return []
        if not self.summary.get("converged"):
            return [self.summary.get("reason", "")]
        targets = [(self.summary.get(name) or {}, met) for name, met in (("adaptation", "reached"), ("energy_tolerance", "kept"))]
        return [target.get("reason", "") for target, met in targets if not target.get(met, True)]

    def _file(self, suffix, parameters):
        if self.name + suffix not in self.files:
            why = f"the run ended with exit code {self.code}: {self.message}" if self.code else f"see {parameters} of the deck"
            raise Error(f'results: the run has written no "{self.folder / self.name}{suffix}"; {why}', self.code or None, result=self)
        return self.folder / (self.name + suffix)

    def _exodus(self):
        if self._film is None:
            pattern = re.compile(re.escape(self.name) + r"\.e(-s\d+)?(\.\d+\.\d+)?")
            paths = [self.folder / file for file in self.files if pattern.fullmatch(file)]
            if not paths:
                self._file(".e", '"Output->Exodus"')
            self._film = Film(paths)
        return self._film


def load(path):
    """Results of an earlier run, from here or from the command line.

    @param path  of one of its files: results/beam.json, or results/beam
    @throws Error if there are none
    """
    path = pathlib.Path(path)
    name = re.sub(r"\.(?:json|run\.json|log|xml|(?:contact|history)\.csv|e(?:-s\d+)?(?:\.\d+\.\d+)?)$", "", path.name)
    record = path.with_name(name + RECORD)
    if record.is_file():
        try:
            return Result(path.parent, name, **json.loads(record.read_text()))
        except (ValueError, TypeError):
            raise Error(f'load: "{record}" is damaged; remedy: remove it') from None
    files = result_files(path.parent, name)
    if not files:
        raise Error(f'load: there are no results "{path.with_name(name)}.*"; remedy: give one of a run\'s files, such as its JSON file')
    result = Result(path.parent, name, files=files)
    if f"{name}.json" in files and not result._reasons():
        result.code = 0
    return result


def result_files(folder, name):
    """{file: what tells whether it is still the same} of all results of a name."""
    pattern = re.compile(re.escape(name) + r"\.(?:json|(?:contact|history|points)\.csv|e(?:-s\d+)?(?:\.\d+\.\d+)?)")
    if not folder.is_dir():
        return {}
    stats = {path.name: path.stat() for path in folder.iterdir() if pattern.fullmatch(path.name)}
    return {file: (stat.st_ino, stat.st_mtime_ns, stat.st_size) for file, stat in stats.items()}


def _table(path):
    """A CSV file as a structured array; units behind the names of columns go: they are in the summary."""
    with open(path, newline="") as file:
        head, *rows = list(csv.reader(file))
    names = [re.sub(r" \[.*\]$", "", name) for name in head]
    widths = [max([1] + [len(row[k]) for row in rows]) for k in range(len(names))]
    kinds = [(name, f"U{width}" if name in TEXTS else float) for name, width in zip(names, widths)]
    return np.array([tuple(cell if name in TEXTS else float(cell) for name, cell in zip(names, row)) for row in rows], dtype=kinds)

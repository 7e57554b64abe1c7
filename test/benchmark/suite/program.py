# SPDX-License-Identifier: BSD-3-Clause
"""Runs rpc, and other programs, and measures them."""
import glob
import json
import os
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import typing
import xml.etree.ElementTree as ElementTree

os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")  # Open MPI refuses root, as in a container, unless told twice
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
MEASURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "measure.py")


class Failure(Exception):
    """A program that ended with an error; the text has what it said."""


class Run(typing.NamedTuple):
    """What a process said and took; all ranks together. With a launcher the time has its start-up too."""

    output: str
    seconds: float
    cpu_seconds: float
    gib: float


def execute(command, launcher=(), environment=None, timeout=None):
    """Runs a command, on several ranks with a launcher such as mpirun, and measures it."""
    with tempfile.TemporaryDirectory() as folder:
        full = [*launcher, sys.executable, MEASURE, folder, *command]
        start = time.perf_counter()
        process = subprocess.Popen(full, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                   env={**os.environ, **(environment or {})})
        try:
            output, errors = process.communicate(timeout=timeout)
        except BaseException as end:  # an interrupt, too, ends all that was started
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            if not isinstance(end, subprocess.TimeoutExpired):
                raise
            raise Failure("more than %g s: %s" % (timeout, shlex.join(command))) from end
        seconds = time.perf_counter() - start
        if process.returncode != 0:
            raise Failure("%s\n%s\nexit code %d of: %s" % (output, errors, process.returncode, shlex.join(full)))
        measured = [open(path).read().split() for path in glob.glob(os.path.join(folder, "*.measured"))]
    memory, own_seconds, cpu_seconds = ([float(number) for number in column] for column in zip(*measured))
    return Run(output, seconds if launcher else own_seconds[0], sum(cpu_seconds), sum(memory) / 2.0**20)


def find_python(module, environment=None):
    """An interpreter that can import a module, this one or the system's; None if there is none."""
    for path in (sys.executable, "/usr/bin/python3"):
        if os.path.exists(path) and can_import(path, module, environment):
            return path
    return None


def can_import(python, module, environment=None):
    return subprocess.run([python, "-c", "import " + module], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          env={**os.environ, **(environment or {})}, check=False).returncode == 0


def picture(script, path, alternative):
    """Runs a script of matplotlib on a table X.csv, which writes X.png beside it; what a page says of the picture."""
    python = find_python("matplotlib")
    if not python:
        return "No picture: it takes matplotlib (python3-matplotlib)."
    execute([python, script, path])
    return "![%s](%s.png)" % (alternative, os.path.splitext(os.path.basename(path))[0])


class Program:
    """Runs rpc; equal runs once. A result is rpc's JSON summary with `process`, `cpu` [s] and `gib` of all its ranks."""

    def __init__(self, rpc, input_folder, mpiexec):
        self.rpc, self.input_folder, self.mpiexec = rpc, input_folder, shlex.split(mpiexec)
        self.results = {}

    def launcher(self, ranks):
        return self.mpiexec + ["-n", str(ranks)] if ranks > 1 else []

    def run(self, deck, ranks=1, fresh=False, **parameters):
        """deck: a name in the folder of decks, or a path; parameters: assignments, with paths as "Mesh->Cells"."""
        key = (deck, ranks, tuple(sorted(parameters.items())))
        if fresh or key not in self.results:
            print("  %s, %d rank(s)%s" % (os.path.basename(deck), ranks, "".join(", %s = %s" % p for p in parameters.items())),
                  file=sys.stderr, flush=True)
            self.results[key] = self._run(os.path.join(self.input_folder, deck), ranks, parameters)
        return self.results[key]

    def beam(self, n, xi, ranks=1, fresh=False, deck="beam.xml", **parameters):
        cells = {"Mesh->Cells": "{%d, %d}" % (5 * n, n)}
        if xi is not None:
            cells["Contact->Yield Stress"] = xi
        return self.run(deck, ranks, fresh, **cells, **parameters)

    def _run(self, deck, ranks, parameters):
        assignments = {"Output->Exodus": "false", "Output->CSV": "false", **parameters}
        with tempfile.TemporaryDirectory() as folder:
            command = [self.rpc, "--input=" + deck, "--output=" + folder]
            command += ["--set=%s=%s" % assignment for assignment in assignments.items()]
            run = execute(command, self.launcher(ranks))
            with open(glob.glob(os.path.join(folder, "*.json"))[0]) as file:
                result = json.load(file)
        if result["ranks"] != ranks:
            raise Failure("asked for %d ranks, got %d" % (ranks, result["ranks"]))
        return {**result, "process": run.seconds, "cpu": run.cpu_seconds, "gib": run.gib}


def without_contact(deck, folder):
    """Writes the deck without its Contact sublist; its path."""
    tree = ElementTree.parse(deck)
    root = tree.getroot()
    root.remove(root.find("ParameterList[@name='Contact']"))
    path = os.path.join(folder, "elastic_" + os.path.basename(deck))
    tree.write(path)
    return path


def solution_seconds(result):
    """Assembly, prediction on coarser meshes, set-up and solve: all but the mesh and the output."""
    return sum(time for phase, time in result["seconds"].items() if phase not in ("mesh", "output", "total"))


def median_ratio(pairs):
    """Of pairs of times taken in turns: the median of first / second, and both medians."""
    return [statistics.median(a / b for a, b in pairs)] + [statistics.median(times) for times in zip(*pairs)]

# SPDX-License-Identifier: BSD-3-Clause
"""One run of the program, as a process of its own."""
import contextlib
import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import time
import weakref
from collections.abc import Mapping

from .deck import text_of, with_settings, write_deck
from .errors import Error
from .program import find_program
from .result import RECORD, Result, result_files

GRACE = 60  # [s] that a run gets to write its results after SIGTERM


def run(deck, *, ranks=1, program=None, folder=None, settings=None, check=True, timeout=None, restart=False):
    """Solves a deck. Returns when the process has ended: a Result.

    @param deck      a dict, see read_deck(); or the name of a file, which the program reads itself and looks for among its own decks
    @param ranks     MPI ranks; more than 1 are started by `mpirun`, or what $RPC_MPIRUN has in its place, such as "mpirun --oversubscribe"
    @param program   path of rpc, see find_program()
    @param folder    for the results, made if it is missing; None: a temporary one, which goes with the Result. A dict is written into it as deck.xml,
                     and its results are deck.json, deck.e, ...; those of a file have the file's name. While the run goes on, NAME.log has its console
    @param settings  {"Contact->Yield Stress": 12, ...}, on top of the deck
    @param check     whether a run that ends with another exit code than 0 is an Error
    @param timeout   [s] after which the run is asked to end; it writes the load steps that it has solved and ends with exit code 4, or at
                     once, -15, where there are none
    @param restart   whether to go on after the newest checkpoint in `folder`, see "Steps->Checkpoint Every"
    @throws Error with the program's exit code, message and remedy; with code None if nothing could be run
    """
    result = start(deck, ranks, program, folder, settings or {}, timeout, restart)
    if check and not result.ok:
        raise result.error()
    return result


def start(deck, ranks, program, folder, settings, timeout, restart=False, started=lambda process: None):
    """run() without check; started(process) is told of the process."""
    program = find_program(program)
    command = launcher(ranks) + [str(program)]
    temporary = folder is None
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rpc_")) if temporary else pathlib.Path(folder)
    try:
        with _readable("folder", folder):
            folder.mkdir(parents=True, exist_ok=True)
            name, arguments = _input(deck, settings, folder)
            before = result_files(folder, name)
            (folder / (name + RECORD)).unlink(missing_ok=True)
            log = open(folder / f"{name}.log", "wb")
        begin = time.monotonic()
        with log, _environment(ranks) as environment:
            code, stderr = _wait(command + arguments + [f"--output={folder}"] + restart * ["--restart"], log, environment, timeout, started)
    except BaseException:
        if temporary:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    after = result_files(folder, name)
    files = [file for file, stat in after.items() if before.get(file) != stat]
    result = Result(folder, name, code, stderr, time.monotonic() - begin, settings, files)
    if temporary:
        weakref.finalize(result, shutil.rmtree, folder, ignore_errors=True)
    else:
        with _readable("folder", folder):
            result.record()
    return result


def _input(deck, settings, folder):
    """Name of the results, and the arguments that say what to solve."""
    if isinstance(deck, Mapping):
        write_deck(with_settings(deck, settings), folder / "deck.xml")
        return "deck", [f"--input={folder / 'deck.xml'}"]
    if not isinstance(deck, (str, os.PathLike)):
        raise Error(f"run: a deck must be a dict or the name of a file, got {type(deck).__name__}")
    with_settings({}, settings)  # refuses paths that are none
    sets = [f"--set={path}={text_of(value, path)}" for path, value in settings.items()]
    return pathlib.Path(deck).stem, [f"--input={os.fspath(deck)}"] + sets


def launcher(ranks):
    """Words before the program.  @throws Error if it is not there"""
    if isinstance(ranks, bool) or not isinstance(ranks, int) or ranks < 1:
        raise Error(f"run: ranks must be an int > 0, got {ranks!r}")
    if ranks == 1:
        return []
    launcher = shlex.split(os.environ.get("RPC_MPIRUN", "")) or ["mpirun"]
    if not shutil.which(launcher[0]):
        raise Error(f'run: ranks = {ranks} needs "{launcher[0]}", which is not there; remedy: install Open MPI, name another launcher in $RPC_MPIRUN, or take '
                    "ranks=1")
    return launcher + ["-n", str(ranks)]


@contextlib.contextmanager
def _environment(ranks):
    """Variables of the process. If mpirun has started Python, the run is no rank of that job. A run on several ranks gets a folder of Open MPI's for
    itself, or those of two runs that start or end at once collide."""
    given = dict(os.environ)
    if "OMPI_COMM_WORLD_SIZE" in given:
        kept = ("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_MCA_rmaps_base_oversubscribe")  # what the user says of the machine
        given = {name: value for name, value in given.items() if name.startswith(kept) or not name.startswith(("OMPI_", "PMIX_", "PRTE_"))}
    if ranks == 1:
        yield given
        return
    names = ("OMPI_MCA_orte_tmpdir_base", "PRTE_MCA_prte_tmpdir_base")  # of Open MPI 4, and later ones
    base = next((given[name] for name in names if name in given), None)
    if base:
        os.makedirs(base, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="rpc_mpi_", dir=base, ignore_cleanup_errors=True) as session:
        yield {**given, **dict.fromkeys(names, session)}


def _wait(command, log, environment, timeout, started):
    """Exit code, -N after signal N, and standard error of a process, in a session of its own: Ctrl-C reaches Python alone, which asks it to end once."""
    try:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.PIPE, text=True, errors="replace", env=environment,
                                   start_new_session=True)
    except OSError as error:
        raise Error(f'run: cannot start "{command[0]}": {error.strerror}') from None
    started(process)
    try:
        _, stderr = process.communicate(timeout=timeout)
    except BaseException as error:
        process.terminate()
        try:
            _, stderr = process.communicate(timeout=GRACE)
        except BaseException:
            process.kill()
            _, stderr = process.communicate()
        if not isinstance(error, subprocess.TimeoutExpired):
            raise
        stderr += f"\nrpc: error: interrupted by timeout = {timeout:g} [s]\n"
    code = process.returncode
    return (128 - code if 128 < code < 192 else code), stderr  # a launcher tells of signal N by 128 + N


@contextlib.contextmanager
def _readable(what, path):
    """What the system refuses, as an Error."""
    try:
        yield
    except OSError as error:
        raise Error(f'run: {what} "{path}": {error.strerror}; remedy: give another folder=') from None

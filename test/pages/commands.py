# SPDX-License-Identifier: BSD-3-Clause
"""Commands of a page: which are run, and how; of those that are not, whether the files and options that they name exist."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess

# Commands that a test does not run, with the reason. The first that matches a command or a part of it between &&, ; and | counts.
NOT_RUN = [
    (r"(sudo )?(apt|apt-get|pip|pip3|conda|spack) ", "installs packages"),
    (r"git (clone|pull|push)", "takes a network"),
    (r"(docker|podman|apptainer|singularity|sbatch|srun) ", "takes a container or a batch system"),
    (r"(cmake|ctest|ninja|make) ", "builds or tests the program"),
    (r"bash (cmake/(test|trilinos|install_packages)|\.ci/run|test/\S+|doc/((figures|tutorial)/\S*make|gallery\.sh)|doc/(paper/reproduce|update_\w+))",
     "builds, tests or makes pictures"),
    (r"(\S*/)?build-\S+/rpc", "takes another build"),
    (r"(bash cmake/run\.sh|\S*rpc) .*Mesh->Refinements=3", "takes 800 000 unknowns"),
]
MOST_RANKS = 2
PASSED_ON = ("Linear Solver->MueLu", "NOX")  # lists whose parameters are those of other packages
PLACEHOLDERS = ("Path", "A->B", "List->Parameter", "Sublist->Parameter")
PROGRAMS = ("rpc", "./rpc", "build/rpc")
PICTURE = "doc/picture.sh"
WITHOUT_GMSH = "this rpc was built without gmsh"


class Tools:
    """What is there to run commands with.

    @param program  rpc
    @param source   root of the source tree
    """

    def __init__(self, program, source):
        self.program, self.source = pathlib.Path(program), pathlib.Path(source)
        self.version = self._ask(self.program, "--version")
        self.options = options_of(self._ask(self.program, "--help"))
        self.parameters = parameters_of(self._ask(self.program, "--print-parameters"))
        self.pictures = self._modules("matplotlib", "netCDF4")
        self.picture_options = options_of(self._ask("bash", self.source / PICTURE, "--help")) if self.pictures else None
        self.mpirun = shutil.which("mpirun")

    def _ask(self, *command):
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=100, check=True).stdout

    def _modules(self, *names):
        python = "/usr/bin/python3"  # picture.sh's
        if not os.path.exists(python):
            return False
        return subprocess.run([python, "-c", "import " + ", ".join(names)], capture_output=True).returncode == 0


def options_of(help_text):
    return set(re.findall(r"(?<![\w-])(--?[a-z][a-z-]*|-[a-z])", help_text))


def parameters_of(text):
    """Patterns of the paths of all parameters, from rpc --print-parameters."""
    patterns, folder = [], ""
    for line in text.splitlines():
        heading = re.match(r"^#+ (.*)$", line)
        entry = re.match(r"^- `([^`]+)` \(", line)
        if heading:
            folder = heading[1].strip() + "->"
        elif entry:
            patterns.append(re.escape(folder + entry[1]).replace("<any\\ name>", "[^>]+").replace("<any name>", "[^>]+"))
    return [re.compile(pattern) for pattern in patterns] + [re.compile(path + "->.+") for path in PASSED_ON]


def commands_of(lines):
    """(offset of its first line, text) of each command; one goes on over several lines where bash would read on."""
    text, begin = "", 0
    for n, line in enumerate(lines):
        if not text and not line.split("#")[0].strip():
            continue
        if not text:
            begin = n
        text += line + "\n"
        if line.endswith("\\"):
            continue
        parsed = subprocess.run(["bash", "-n", "-c", text], capture_output=True)
        if parsed.returncode == 0 and not parsed.stderr:  # a document that has no end is a warning
            yield begin, text.rstrip("\n")
            text = ""
    if text:
        yield begin, text.rstrip("\n")


def parts_of(command):
    """Words of each part between && || ; |, without assignments in front."""
    lexer = shlex.shlex(command, posix=True, punctuation_chars="&|;")
    lexer.whitespace_split = True
    lexer.commenters = "#"
    parts = [[]]
    for word in lexer:
        if word in ("&&", "||", ";", "|", "&"):
            parts.append([])
        elif parts[-1] or not re.fullmatch(r"[A-Z_][A-Z0-9_]*=.*", word):
            parts[-1].append(word)
    return [part for part in parts if part]


def reason_not_to_run(command, tools):
    for part in parts_of(command):
        text = " ".join(part) + " "
        for pattern, reason in NOT_RUN:
            if re.match(pattern, text):
                return reason
        if part[0] in ("mpirun", "mpiexec"):
            ranks = next((int(part[n + 1]) for n, word in enumerate(part[:-1]) if word in ("-n", "-np")), 0)
            if not 0 < ranks <= MOST_RANKS:
                return f"takes more than {MOST_RANKS} ranks"
            if not tools.mpirun:
                return "there is no mpirun"
            if not any(word in PROGRAMS for word in part):
                return "takes another build"
        if part[0] == "gmsh" and not shutil.which("gmsh"):
            return "gmsh's program is missing"
        if PICTURE in part and not tools.pictures:
            return "matplotlib or netCDF4 is missing"
    return ""


def as_run(command):
    """The command with what is built standing for what builds: cmake/run.sh is the program, after it has made it."""
    def program(found):
        return f"mpirun -np {found[1]} ./rpc" if found[1] else "./rpc"
    return re.sub(r"(?:\bNP=(\d+) )?bash cmake/run\.sh", program, command)


def as_checked(command):
    """The command with runs of the program as checks of their decks; "" if it is none."""
    parts = parts_of(command)
    return f"{command.split(' #')[0].rstrip()} --check" if len(parts) == 1 and parts[0][0] in PROGRAMS else ""


def faults_of(command, tools, folder):
    """Files and options that the command names and that do not exist.

    @param folder  where it would run, with the decks of the page
    """
    for part in parts_of(as_run(command)):
        names = [n for n, word in enumerate(part) if word in PROGRAMS or word.endswith("/rpc")]
        if names and (names[0] == 0 or part[0] in ("mpirun", "mpiexec", "srun")):
            yield from faults_of_arguments(part[names[0] + 1:], tools, folder)
        elif part[:2] == ["bash", PICTURE]:
            known = tools.picture_options
            yield from (f"{PICTURE} has no option {word}" for word in part[2:]
                        if known and word.startswith("--") and word.split("=")[0] not in known)
        for word in part[:1] if part[0] != "bash" else part[1:2]:
            if re.match(r"(\.ci|cmake|doc|test|input|python|packages)/", word) and not (tools.source / word).exists():
                yield f"there is no {word}"


def faults_of_arguments(arguments, tools, folder):
    makes_surface = any(word.startswith("--make-surface=") for word in arguments)  # which has parameters of its own
    for word in arguments:
        option, _, value = word.partition("=")
        placeholder = re.fullmatch(r"[A-Z_]+(\.\w+)?", value)
        if not word.startswith("-") or word.startswith("--kokkos"):
            continue
        if option not in tools.options:
            yield f"rpc has no option {option}"
        elif option == "--input" and value and not placeholder:
            if not any((place / value).exists() for place in (folder, tools.source, tools.source / "input")):
                yield f"there is no deck {value}"
        elif option == "--set" and "=" in value and not makes_surface:
            path = value.split("=")[0].strip()
            if path not in PLACEHOLDERS and not any(pattern.fullmatch(path) for pattern in tools.parameters):
                yield f'a deck has no parameter "{path}"'

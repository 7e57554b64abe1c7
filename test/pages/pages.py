# SPDX-License-Identifier: BSD-3-Clause
"""Commands, decks, outputs, pictures and links of Markdown pages, against the program and the source tree.

    RPC_PROGRAM=build/rpc python3 pages.py [--update] readme|tutorial|gallery|handbook|input|PAGE.md ...

Each page's ```sh blocks are run, in order, in a folder of their own that looks like the source tree with the program in it; decks in
```xml and ```yaml blocks must pass rpc --check; ```text blocks are what the commands before them print. page.py has the marks that say
otherwise. --update writes what the commands print into the pages instead of comparing it. Each fault is a line PAGE:LINE: what; the exit
code is 1 if there is one.
"""

import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import urllib.parse

import commands
import decks
import outputs
from page import MARKS, Page

SOURCE = pathlib.Path(os.environ.get("RPC_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
GROUPS = {"readme": ["README.md"], "tutorial": ["doc/tutorial/*.md"], "gallery": ["doc/gallery/*.md", "doc/gallery/*/*.md"], "handbook": ["doc/handbook.md"],
          "input": ["doc/input/*.md", "doc/commands.md", "doc/pictures.md"]}
CHECKED = "doc/gallery"  # whose test solves its decks, to coarser targets: here they are checked only
GMSH = "4.8"  # with whose meshes the numbers of the pages were made: Debian 12's
LIMIT = 300  # s of processor time of each process of a command: other work on the machine does not count. What hangs is ended by CTest.
MPI_OF_A_TEST = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
VERSION_OF_GMSH = """<ParameterList name="version">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="version.geo"/>
  </ParameterList>
</ParameterList>
"""


class Checker:
    """Of one page.

    @param page    its path
    @param tools   commands.Tools
    @param update  whether outputs are written into the page
    """

    def __init__(self, page, tools, update=False, compares=True):
        self.page, self.tools, self.update, self.compares = Page(page), tools, update, compares
        self.checks_only = (tools.source / CHECKED).resolve() in self.page.path.resolve().parents
        self.seconds = []  # (processor time, line) of each command
        self.faults, self.skipped, self.num_commands, self.num_decks, self.changed = [], [], 0, 0, False

    def fault(self, line, text):
        self.faults.append((line, text))

    def check(self):
        with tempfile.TemporaryDirectory(prefix="rpc_page_") as folder:
            self.folder = pathlib.Path(folder)
            self._lay_out()
            if self.page.unclosed:
                self.fault(self.page.unclosed, "the block has no end")
            self._check_links()
            self._save_decks()
            self._check_spans()
            printed = None
            for block in self.page.blocks:
                self._check_marks(block)
                if "from" in block.marks:
                    self._check_excerpt(block)
                elif block.language in ("sh", "bash", "shell"):
                    printed = self._run_block(block)
                elif block.language in ("xml", "yaml") and "not run" not in block.marks:
                    self._check_deck(block)
                elif block.language == "text":
                    self._check_output(block, printed)
        if self.changed:
            self.page.save()
        return self.faults

    def _lay_out(self):
        """The scratch folder: links to all that the source tree has, the program, and decks' meshes beside decks that are made here."""
        for entry in self.tools.source.iterdir():
            if not entry.name.startswith(("build", ".git")) and entry.name != "rpc":
                (self.folder / entry.name).symlink_to(entry)
        (self.folder / "build").mkdir()
        self.decks = self.folder / "decks_of_page"
        self.decks.mkdir()
        for place in (self.folder / "rpc", self.folder / "build" / "rpc"):
            place.symlink_to(self.tools.program)
        for folder in (self.tools.source / "input", self.page.path.parent):
            for mesh in folder.glob("*"):
                if mesh.suffix in (".geo", ".msh", ".step", ".stp") and not (self.decks / mesh.name).exists():
                    (self.decks / mesh.name).symlink_to(mesh)

    def _save_decks(self):
        """Whole decks of the page, under their names, for its commands."""
        for block in self.page.blocks:
            if block.language in ("xml", "yaml") and not {"from", "part of", "not run"} & set(block.marks):
                try:
                    if decks.is_whole(block.text, block.language):
                        file = self.folder / f"{decks.name_of(block.text, block.language)}.{block.language}"
                        if not file.exists():
                            file.write_text(block.text)
                except decks.DeckFault:
                    pass  # _check_deck tells

    def _check_marks(self, block):
        for mark in block.marks:
            if mark in MARKS and mark != "output" and not block.marks[mark]:
                self.fault(block.line, f"the mark \"{mark}\" lacks what stands behind the colon")
        if block.language == "text" and not {"output", "not run", "from"} & set(block.marks):
            self.fault(block.line, "a text block has none of the marks output, not run and from above it")

    def _check_links(self):
        pages = {self.page.path.resolve(): self.page}
        for line, target in dict.fromkeys(self.page.links()):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            place = (self.page.path.parent / urllib.parse.unquote(path)).resolve() if path else self.page.path.resolve()
            if not place.exists():
                self.fault(line, f"there is no {path}")
            elif anchor and place.suffix == ".md":
                if anchor not in pages.setdefault(place, Page(place)).anchors():
                    self.fault(line, f"{path or 'this page'} has no heading #{anchor}")

    def _check_spans(self):
        """Commands within the text are not run: what they name must exist."""
        for line, text in self.page.spans():
            if re.match(r"(\./|build/)?rpc -|bash \S+/|mpirun .*rpc", text):
                self._check_names(line, text)

    def _check_names(self, line, command):
        try:
            found = list(commands.faults_of(re.sub(r"[\[\]]|\.\.\.", " ", command), self.tools, self.folder))
        except ValueError as error:
            found = [f"it is no command: {error}"]
        for text in found:
            self.fault(line, text)

    def _run_block(self, block):
        """@return what its commands print, None where one was not run or failed"""
        printed, all_run = "", True
        of_block = list(commands.commands_of(block.lines))
        for n, (offset, command) in enumerate(of_block):
            line = block.line + offset
            expected = int(block.marks.get("exit code") or 0) if n == len(of_block) - 1 else 0
            if " [--" in command:  # how it is used
                self._check_names(line, command)
                continue
            text = self._run(line, command, block.marks.get("not run"), expected)
            all_run = all_run and text is not None
            printed += text or ""
        return printed.splitlines() if all_run else None

    def _run(self, line, command, reason, expected):
        self.num_commands += 1
        self._check_names(line, command)
        try:
            reason = reason or commands.reason_not_to_run(commands.as_run(command), self.tools)
        except ValueError as error:
            return self.fault(line, f"it is no command: {error}")
        if reason:
            self.skipped.append((line, f"not run ({reason}): {command}"))
            return None
        text = commands.as_run(command)
        if self.checks_only:
            text = commands.as_checked(text)
            if not text:
                self.skipped.append((line, f"not run (its results are not made here): {command}"))
                return None
        path = f"{self.folder}{os.pathsep}{os.environ['PATH']}"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run = subprocess.run(["bash", "-uo", "pipefail", "-c", f"ulimit -t {LIMIT}\n{text}"], cwd=self.folder,
                             env={**MPI_OF_A_TEST, **os.environ, "PATH": path}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             stdin=subprocess.DEVNULL, text=True, errors="replace")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.seconds.append((after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, line))
        if run.returncode != expected:
            if commands.WITHOUT_GMSH in run.stdout:
                self.skipped.append((line, f"not run (takes gmsh): {command}"))
                return None
            tail = "".join(f"\n    {text}" for text in run.stdout.splitlines()[-8:])
            return self.fault(line, f"exit code {run.returncode}, not {expected}, of {command}{tail}")
        return None if self.checks_only else run.stdout

    def _check_output(self, block, printed):
        if "output" not in block.marks or printed is None or not self.compares:
            return
        if self.update:
            try:
                lines = outputs.updated(block.lines, printed)
            except LookupError as error:
                return self.fault(block.line, f"{error}; change it by hand")
            if outputs.fault(block.lines, printed):
                self.changed = True
                self.page.replace(block, lines)
        found = outputs.fault(block.lines, printed)
        if found:
            self.fault(block.line + found[0], f"not what the command prints: {found[1]}")

    def _check_excerpt(self, block):
        file = self.tools.source / block.marks["from"]
        if not file.is_file():
            return self.fault(block.line, f"there is no {block.marks['from']}")
        found = outputs.mismatch(["...", *block.lines, "..."], file.read_text().splitlines(),
                                 lambda expected, actual: None if expected.strip() == actual.strip() else f"not a line of {file.name} here")
        if found:
            self.fault(block.line + max(found[0] - 1, 0), found[1])

    def _check_deck(self, block):
        self.num_decks += 1
        name = f"deck_{block.line}.{block.language}"
        try:
            text = block.text
            base = block.marks.get("part of")
            if base or not decks.is_whole(text, block.language):
                if block.language == "yaml":
                    raise decks.DeckFault("a part of a YAML deck is not checked: mark it \"not run\"")
                text = decks.completed(text, (self.tools.source / "input" / (base or decks.base_of(text))).read_text())
        except (decks.DeckFault, OSError) as error:
            return self.fault(block.line, str(error))
        (self.decks / name).write_text(text)
        run = subprocess.run([self.tools.program, f"--input={self.decks / name}", "--check"], capture_output=True, text=True)
        if run.returncode and commands.WITHOUT_GMSH not in run.stderr:
            self.fault(block.line, f"the deck is refused, exit code {run.returncode}: {run.stderr.strip()}")


def pages_of(names):
    for name in names:
        if name in GROUPS:
            yield from sorted(path for pattern in GROUPS[name] for path in SOURCE.glob(pattern))
        else:
            yield pathlib.Path(name).resolve()


def same_gmsh(program):
    """Whether gmsh makes the meshes of the pages; another version makes others, and other last digits."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "version.xml").write_text(VERSION_OF_GMSH)
        (path / "version.geo").write_text('Printf("%g.%g", GMSH_MAJOR_VERSION, GMSH_MINOR_VERSION) > "version.txt";\n')
        subprocess.run([program, "--input=version.xml", "--check"], cwd=path, capture_output=True)
        file = path / "version.txt"
        return file.exists() and file.read_text().strip() == GMSH


def shown(path):
    return path.relative_to(SOURCE) if path.is_relative_to(SOURCE) else path


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--update", action="store_true", help="write what commands print into the pages")
    options.add_argument("--times", action="store_true", help="print the processor time of each command")
    options.add_argument("pages", nargs="+", help=f"files, or groups of them: {', '.join(GROUPS)}")
    arguments = options.parse_args()
    program = pathlib.Path(os.environ.get("RPC_PROGRAM", SOURCE / "build" / "rpc")).resolve()
    tools = commands.Tools(program, SOURCE)
    compares = same_gmsh(program) and "Serial" in tools.version
    if not compares:
        print(f"outputs are not compared: the pages have those of the backend Serial with meshes by gmsh {GMSH}")
    failed = False
    for path in pages_of(arguments.pages):
        checker = Checker(path, tools, arguments.update, compares)
        for line, text in checker.check():
            print(f"{shown(path)}:{line}: {text}")
            failed = True
        for seconds, line in sorted(checker.seconds, reverse=True) if arguments.times else []:
            print(f"{shown(path)}:{line}: {seconds:.1f} s")
        for line, text in checker.skipped:
            print(f"{shown(path)}:{line}: {text}")
        print(f"{shown(path)}: {checker.num_commands} commands, {checker.num_decks} decks, {len(checker.faults)} faults, "
              f"{sum(seconds for seconds, _ in checker.seconds):.1f} s of processor time")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

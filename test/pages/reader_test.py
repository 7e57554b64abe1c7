# SPDX-License-Identifier: BSD-3-Clause
"""pages.py passes a sound page and finds each kind of fault, at its line."""

import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import commands
import outputs
import pages
from page import Page

TOOLS = commands.Tools(pages.os.environ.get("RPC_PROGRAM", "rpc"), pages.SOURCE)
SMALL = "--set=\"Mesh->Cells={20,4}\""
DECK = (pages.SOURCE / "input" / "beam.xml").read_text()

SOUND = f"""# A page

See [below](#the-results--all), [the beam](README.md#a-page), ![a picture](picture.png) and `rpc --input=beam.xml`; `rpc --check` writes nothing.

```sh
./rpc --input=beam.xml {SMALL} \\
  --output=results                       # a comment
bash cmake/run.sh --version && test -e results/beam.json
for k in 1 2; do
  echo "number $k"
done
```

<!-- output -->
```text
beam: 80 Q1 cells, ... on "bottom", 1 rank, Serial
...
number 1
number 2
```

A load beyond what the foundation carries:

<!-- exit code: 5 -->
```sh
rpc --input=beam.xml {SMALL} --set="Contact->Yield Stress=1" \\
  --set="Contact->Normal=0, -1" --set="Dirichlet->left->Side=left bottom" --set="Dirichlet->right->Side=left bottom"
```

<!-- not run: takes a day -->
```sh
rpc --input=beam.xml --set="Mesh->Cells={{20000,4000}}"
apt-get install something
```

```xml
{DECK}```

```xml
<ParameterList name="Contact">
  <Parameter name="Yield Stress" type="double" value="12"/>
</ParameterList>
```

<!-- from: input/beam.xml -->
```xml
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
...
</ParameterList>
```

## The results & all

    rpc --help

"""


class Checked(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "picture.png").write_text("")

    def checked(self, text, update=False):
        (self.folder / "README.md").write_text(text)
        checker = pages.Checker(self.folder / "README.md", TOOLS, update)
        return checker, checker.check()

    def expect_fault(self, text, line, *parts):
        """One fault, at the line that holds `line`, that says all the parts."""
        checker, faults = self.checked(text)
        self.assertEqual(len(faults), 1, faults)
        number, what = faults[0]
        self.assertIn(line, text.splitlines()[number - 1], what)
        for part in parts:
            self.assertIn(part, what)


class Pages(Checked):
    def test_a_sound_page_has_none(self):
        checker, faults = self.checked(SOUND)
        self.assertEqual(faults, [])
        self.assertEqual((checker.num_commands, checker.num_decks, len(checker.skipped)), (7, 2, 2))

    def test_commands_that_fail(self):
        for command, part in [("rpc --input=beam.xml --set=\"Contact->Side=nowhere\"", "exit code 2"), ("false", "exit code 1"),
                              ("no_such_program", "exit code 127"), ("bash doc/picture.sh nothing.e", "exit code 2")]:
            if command.startswith("bash doc") and not TOOLS.pictures:
                continue
            with self.subTest(command):
                self.expect_fault(f"text\n\n```sh\ntrue\n{command}\n```\n", command, part)

    def test_an_exit_code_that_is_another(self):
        self.expect_fault("<!-- exit code: 5 -->\n```sh\nrpc --version\n```\n", "--version", "exit code 0, not 5")

    def test_what_commands_name_that_are_not_run(self):
        for command, part in [("rpc --inptu=beam.xml", "no option --inptu"), ("rpc --input=baem.xml", "no deck baem.xml"),
                              ("rpc --input=beam.xml --set=\"Contact->Yield=1\"", 'no parameter "Contact->Yield"'),
                              ("mpirun -np 64 rpc --input=beam.xml --output=a --verbos", "no option --verbos"),
                              ("bash test/nothing.sh", "no test/nothing.sh"), ("doc/nothing.sh", "no doc/nothing.sh")]:
            with self.subTest(command):
                self.expect_fault(f"<!-- not run: long -->\n```sh\n{command}\n```\n", command, part)
        self.expect_fault("Text with `rpc --inptu=DECK` in it.\n", "inptu", "no option")
        if TOOLS.pictures:
            self.expect_fault("Text with `bash doc/picture.sh RESULT.e --feild=NAME` in it.\n", "feild", "no option --feild")

    def test_reasons_not_to_run(self):
        for command, reason in [("apt-get install a", "installs"), ("cmake -S . && ./rpc", "builds"), ("mpirun -np 64 ./rpc", "ranks"),
                                ("mpirun -np 2 build-cuda/rpc", "another build"), ("build-cuda/rpc", "another build"),
                                ("sudo apt-get install a", "installs")]:
            self.assertIn(reason, commands.reason_not_to_run(command, TOOLS), command)
        self.assertEqual(commands.reason_not_to_run("./rpc --input=beam.xml", TOOLS), "")
        self.assertEqual(commands.as_run("NP=2 bash cmake/run.sh --input=a"), "mpirun -np 2 ./rpc --input=a")

    def test_a_command_ends_by_its_processor_time(self):
        with unittest.mock.patch.object(pages, "LIMIT", 1):
            self.expect_fault("```sh\nwhile true; do true; done\n```\n", "while", "exit code")

    def test_links(self):
        for link in ["![x](nothing.png)", "[x](nothing.md)", "[x](#nothing)", "[x](README.md#nothing)", "[![x](nothing.png)](README.md)",
                     '<img src="nothing.png">']:
            with self.subTest(link):
                self.expect_fault(f"# Title\n\nA {link}.\n", link, "nothing")

    def test_outputs(self):
        def page(output):
            return f"```sh\nrpc --input=beam.xml {SMALL}\n```\n\n<!-- output -->\n```text\n{output}\n```\n"
        right = "...\n  energy J ... J/m\n...\n  time ...\n..."
        self.assertEqual(self.checked(page(right))[1], [])
        self.expect_fault(page("beam: 81 Q1 cells, ...\n..."), "81", "it says 81, the program 80")
        self.expect_fault(page("...\n  energy K ... J/m\n..."), "energy K", "not what the command prints")
        self.expect_fault(page("beam: 80 Q1 cells, ..."), "80", "more comes")

    def test_decks(self):
        self.expect_fault(f"```xml\n{DECK.replace('Poisson', 'Poison')}```\n", "<!--", "refused", "Poison")
        self.expect_fault("```xml\n<ParameterList name=\"Contact\">\n```\n", "<ParameterList", "not XML")
        self.expect_fault("<!-- part of: nothing.xml -->\n```xml\n<ParameterList name=\"Contact\"/>\n```\n", "Contact", "nothing.xml")
        self.expect_fault('```xml\n<ParameterList name="Contact">\n  <Parameter name="Sied" type="string" value="top"/>\n</ParameterList>\n```\n',
                          "Contact", "Sied")
        self.expect_fault("```yaml\nbeam:\n  Mesh: {Cells: [2, 2]}\n  Material: {Young's Modulus: -1.0, Poisson's Ratio: 0.3}\n```\n", "beam:", "refused")

    def test_decks_of_a_page_are_there_for_its_commands(self):
        page = "Run `rpc --input=press.xml`.\n\n```xml\n" + DECK.replace('name="beam"', 'name="press"') + f"```\n\n```sh\nrpc --input=press.xml {SMALL}\n```\n"
        self.assertEqual(self.checked(page)[1], [])
        self.expect_fault(page.replace("`rpc --input=press", "`rpc --input=push"), "push", "no deck push.xml")

    def test_excerpts(self):
        self.expect_fault("<!-- from: input/beam.xml -->\n```xml\n<Parameter name=\"Yield Stress\" type=\"double\" value=\"17\"/>\n```\n", "17", "not a line")
        self.expect_fault("<!-- from: input/nothing.xml -->\n```xml\n<A/>\n```\n", "<A/>", "nothing.xml")

    def test_blocks_without_marks_or_ends(self):
        self.expect_fault("```text\nwords\n```\n", "words", "none of the marks")
        self.expect_fault("<!-- exit code -->\n```sh\ntrue\n```\n", "true", "lacks")
        self.expect_fault("text\n\n```sh\ntrue\n", "```", "no end")

    def test_update_writes_what_commands_print(self):
        text = f"```sh\nrpc --input=beam.xml {SMALL}\necho end 3\n```\n\n<!-- output -->\n```text\nbeam: 81 Q1 cells, plane strain\n...\nend 2\n```\n\n" \
               "1. Item\n\n   ```sh\n   echo 1\n   echo 2\n   ```\n\n   <!-- output -->\n   ```text\n   ```\n"
        self.assertEqual(self.checked(text, update=True)[1], [])
        new = (self.folder / "README.md").read_text()
        self.assertRegex(new, r"(?s)```text\nbeam: 80 Q1 cells, [^\n]*\n\.\.\.\nend 3\n```\n.* {3}```text\n {3}1\n {3}2\n {3}```\n$")
        self.assertEqual(self.checked(new)[1], [])
        lost = new.replace("...\nend 3", "...\nnothing that is printed")
        _, faults = self.checked(lost, update=True)
        self.assertEqual(len(faults), 1)
        self.assertIn("by hand", faults[0][1])
        self.assertEqual((self.folder / "README.md").read_text(), lost)

    def test_pages_of_this_project_are_found(self):
        for group in ("readme", "tutorial", "input"):
            self.assertTrue(list(pages.pages_of([group])), group)


class Outputs(unittest.TestCase):
    def differs(self, expected, actual):
        return outputs.fault(expected.splitlines(), actual.splitlines()) is not None

    def test_numbers_within_a_thousandth_are_the_same(self):
        for expected, actual, differs in [("p 100", "p 100.09", False), ("p 100", "p 100.2", True), ("p 1e-9", "p -3e-12", False),
                                          ("e 9.4e+00", "e 9.3e+00", False), ("e 9.4e+00", "e 9.2e+00", True), ("16", "17", True),
                                          ("(0, 64.9349) N/m", "(0, 64.9350) N/m", False), ("P2", "P3", True), ("-0.2", "0.2", True)]:
            self.assertEqual(self.differs(expected, actual), differs, (expected, actual))

    def test_times_are_not_compared(self):
        for expected, actual, differs in [("total 0.3 s", "total 9.2 s", False), ("total 0.3 m", "total 9.2 m", True),
                                          ("  time   mesh 0.1, solve 2", "  time   mesh 3, solve 7", False),
                                          ("n  time [s]  left [s]\n1 2 3\n\n1 2", "n  time [s]  left [s]\n1 5 6\n\n1 2", False),
                                          ("n  time [s]  left [s]\n1 2 3", "n  time [s]  left [s]\n2 2 3", True),
                                          ("n  time [s]\n1 2\n\n1 2", "n  time [s]\n1 2\n\n1 3", True),
                                          ("n  time [s]\narea 3 mm^2", "n  time [s]\narea 4 mm^2", True)]:
            self.assertEqual(self.differs(expected, actual), differs, (expected, actual))

    def test_dots_stand_for_lines_and_for_words(self):
        for expected, actual, differs in [("a\n...\nd", "a\nb\nc\nd", False), ("a\n...\nd", "a\nd", False), ("a\n...", "a", False),
                                          ("...\nd", "a\nd", False), ("...\nd", "a\nd\ne", True), ("a\n...\nd\n...", "a\nb\n", True),
                                          ("a ... d", "a b c d", False), ("a ... d", "a b c e", True), ("a ...", "a 1 2", False),
                                          ("a", "a\nb", True), ("a\nb", "a", True), ("...\nb\nc\n...\nb\n...", "b\nb\nc\nb", False)]:
            self.assertEqual(self.differs(expected, actual), differs, (expected, actual))

    def test_update_keeps_what_is_left_out(self):
        for expected, actual, new in [
                ("one 1\n...\nlast 4", "one 2\ntwo 3\nthree 4\nlast 5", "one 2\n...\nlast 5"),
                ("...\nfirst line 1\nan old line\nlast line 2\n...", "head\nfirst line 3\nnew lines\nof another kind\nlast line 4\nend",
                 "...\nfirst line 3\nnew lines\nof another kind\nlast line 4\n..."),
                ("row 1 of 3\n...\nrow 3 of 3\n...", "row 1 of 3\nrow 2 of 3\nrow 3 of 3\nend", "row 1 of 3\n...\nrow 3 of 3\n..."),
                ("force ... N\n...", "force 1 2 N\nb", "force ... N\n..."),
                ("...\nerror at t = 1: it is not held. ...\n...\n  results of t = 0.7\n...",
                 "head\nerror at t = 2: it is not held. Prescribe a displacement of the side, or press it on the foundation by a load at all times of the history\n\n"
                 "  results of t = 0.8\nend", "...\nerror at t = 2: it is not held. ...\n...\n  results of t = 0.8\n..."),
                ("a 1\nb 2", "a 3\nb 4\nc 5", "a 3\nb 4\nc 5")]:
            self.assertEqual("\n".join(outputs.updated(expected.splitlines(), actual.splitlines())), new)
        with self.assertRaises(LookupError):
            outputs.updated(["...", "contact force (0, 1) N"], ["energy", "unlike"])


class Parser(unittest.TestCase):
    def test_commands_go_on_over_lines(self):
        lines = ["# only a comment", "a --b \\", "  --c", "", "for x in 1 2; do", "  echo $x", "done", "cat <<END", "text", "END"]
        self.assertEqual([offset for offset, _ in commands.commands_of(lines)], [1, 4, 7])

    def test_headings_are_anchors(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.md"
            path.write_text("# `a.json` & b\n## [C](d.md) e, f\n## Same\n## Same\n```sh\n# no heading\n```\n")
            self.assertEqual(Page(path).anchors(), {"ajson--b", "c-e-f", "same", "same-1"})


if __name__ == "__main__":
    sys.exit(unittest.main())

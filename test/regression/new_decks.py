# SPDX-License-Identifier: BSD-3-Clause
"""rpc --new: its menu, and each of its decks, which a newcomer gets to start from: written once, understood and solved."""

import re
import unittest

from rpc_run import SOURCE, RpcTestCase, errors, files, run_all

TEMPLATES = SOURCE / "input" / "templates"
NAMES = sorted(path.stem for path in TEMPLATES.glob("*.xml"))


def small(deck):
    """Changes of a template's mesh for a run in a moment."""
    if "Size Factor" in deck:
        return "--set=Mesh->Size Factor=4"
    cells = [max(1, int(number) // 4) for number in re.search(r'"Cells" type="Array\(int\)" value="\{(.*?)\}"', deck)[1].split(",")]
    return "--set=Mesh->Cells={" + ",".join(map(str, cells)) + "}"


class NewDecks(RpcTestCase):
    def test_menu_has_a_line_for_each(self):
        self.assertGreaterEqual(len(NAMES), 8)
        menu = self.rpc("--new").stdout
        self.assertEqual(re.findall(r"(?m)^  (\S+) ", menu), NAMES)
        for line in menu.splitlines():
            self.assertLess(len(line), 120)
        self.assertEqual(self.rpc("--new=help").stdout, menu)
        self.assertEqual(files(self.folder), [])

    def test_each_is_understood_and_solved(self):
        for name in NAMES:
            said = self.rpc(f"--new={name}").stdout
            for file in re.search("wrote (.*)", said)[1].split(", "):
                self.assertEqual((self.folder / file).read_bytes(), (TEMPLATES / file).read_bytes())
            self.assertIn(f"rpc --check --input={name}.xml", said)
        jobs = []
        for name in NAMES:
            text = (self.folder / f"{name}.xml").read_text()
            jobs += [([*check, f"--input={name}.xml", small(text), "--output=out"], self.folder) for check in (["--check"], [])]
        for result in run_all(jobs):
            with self.subTest(result.args):
                self.assertEqual((result.returncode, errors(result)), (0, []), result.stderr)
        for name in NAMES:
            self.assertIn(f"{name}.json", files(self.folder / "out"))

    def test_each_tells_a_newcomer_what_to_change(self):
        for name in NAMES:
            with self.subTest(name):
                text = (TEMPLATES / f"{name}.xml").read_text()
                self.assertGreaterEqual(text.count("<!--"), 3)
                for comment in re.findall("<!--(.*?)-->", text, re.S):
                    self.assertNotIn("--", comment)  # XML forbids it
                self.assertIn("Change numbers", text)

    def test_nothing_is_written_over(self):
        self.rpc("--new=hertz-2d", "--output=a/b")
        self.assertEqual(files(self.folder), ["a/b/hertz-2d.geo", "a/b/hertz-2d.xml"])
        (self.folder / "footing.xml").write_text("mine")
        self.expect_refusal(self.rpc("--new=footing", code=2), 2, ['does not write over "footing.xml"', "--output=DIR"])
        self.assertEqual((self.folder / "footing.xml").read_text(), "mine")
        (self.folder / "hertz-2d.xml").write_text("mine")
        self.expect_refusal(self.rpc("--new=hertz-2d", code=2), 2, ['does not write over "hertz-2d.xml"'])
        self.assertNotIn("hertz-2d.geo", files(self.folder))  # half of a template would be there

    def test_unknown_name_is_refused(self):
        self.expect_refusal(self.rpc("--new=hertz3d", code=2), 2, ['no template "hertz3d"', 'Did you mean "hertz-3d"?', "Templates: "])
        self.expect_refusal(self.rpc("--new=footing", "--output=/proc/x", code=2), 2, ['cannot write "/proc/x/footing.xml"', "--output=DIR"])
        self.assertEqual(files(self.folder), [])


if __name__ == "__main__":
    unittest.main()

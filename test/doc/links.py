# SPDX-License-Identifier: BSD-3-Clause
"""Each link of the documents to a file or a heading of this project leads somewhere."""

import os
import pathlib
import re
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("RPC_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
LINK = re.compile(r"\]\(([^()\s]+)\)")
CODE = re.compile(r"^( *)(`{3,}|~{3,}).*?^\1\2|`[^`\n]+`", re.MULTILINE | re.DOTALL)


def pages(root):
    """README.md and its like, and all below doc and python."""
    return [*sorted(root.glob("*.md")), *(path for top in ("doc", "python") for path in sorted((root / top).rglob("*.md")))]


def anchor(heading):
    """As GitHub and most others make it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(page):
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    return {anchor(re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)) for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


def broken(root):
    for page in pages(root):
        for target in LINK.findall(CODE.sub("", page.read_text())):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, heading = target.partition("#")
            file = page.parent / name if name else page
            if not file.exists():
                yield f"{page.relative_to(root)}: {target}: there is no such file"
            elif heading and file.suffix == ".md" and heading not in anchors(file):
                yield f"{page.relative_to(root)}: {target}: there is no such heading; headings: {', '.join(sorted(anchors(file)))}"


class Links(unittest.TestCase):
    def test_of_this_project_lead_somewhere(self):
        self.assertGreater(len(pages(SOURCE)), 10)
        found = list(broken(SOURCE))
        self.assertFalse(found, "\n" + "\n".join(found))

    def test_finds_a_link_that_leads_nowhere(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "doc").mkdir()
            (root / "a.md").write_text("# One\n[a](doc/b.md), [b](doc/b.md#two-three), [c](#one), [d](http://x.y/z.md), `[e](gone.md)`\n```\n[f](gone.md)\n```\n")
            (root / "doc" / "b.md").write_text("## Two, three\n")
            self.assertEqual(list(broken(root)), [])
            (root / "doc" / "b.md").write_text("## Two\n[g](../c.md)\n")
            self.assertEqual([each.split(": there")[0] for each in broken(root)], ["a.md: doc/b.md#two-three", "doc/b.md: ../c.md"])

    def test_headings_become_anchors(self):
        self.assertEqual(anchor("`<deck>.contact.csv`"), "deckcontactcsv")
        self.assertEqual(anchor("Exit code 5: no solution"), "exit-code-5-no-solution")
        self.assertEqual(anchor("How do I know that the work is right?"), "how-do-i-know-that-the-work-is-right")


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""A Markdown page: its fenced blocks with the marks above them, its links, its headings.

A mark is an HTML comment of one line, `<!-- name: value -->`, right above a block or above another mark:

    output              (text)       what the commands of the last sh block before it have printed, see outputs.py
    exit code: N        (sh)         the exit code of its last command, where that is not 0
    not run: reason     (sh, text, xml, yaml)  the block is not run or compared; files and options that its commands name must exist
    from: FILE          (any)        lines of that file of the source tree, `...` for lines left out
    part of: DECK       (xml, yaml)  lists of parameters that go into this deck of input/
"""

import dataclasses
import re

MARKS = ("output", "exit code", "not run", "from", "part of")
FENCE = re.compile(r"^( {0,3})(`{3,}|~{3,})\s*([\w+-]*)")
COMMENT = re.compile(r"^\s*<!--\s*([^:>]*?)\s*(?::\s*(.*?))?\s*-->\s*$")
INDENTED_COMMAND = re.compile(r"^ {4}(?:\./)?(?:rpc|bash|mpirun) ")
SPAN = re.compile(r"(`+)(.+?)\1")
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\]\([^)]*\))*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
INNER_IMAGE = re.compile(r"!\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
HTML_LINK = re.compile(r"<(?:img|a)\b[^>]*\b(?:src|href)=\"([^\"]+)\"")
HTML_ANCHOR = re.compile(r"<a\b[^>]*\b(?:id|name)=\"([^\"]+)\"")


@dataclasses.dataclass
class Block:
    language: str
    lines: list
    line: int  # number of its first line in the page, from 1
    marks: dict
    indent: int = 0

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)


class Page:
    """Of a file; `outside` has its lines with those in blocks left empty."""

    def __init__(self, path):
        self.path = path
        self.lines = path.read_text().splitlines()
        self.blocks, self.outside, self.unclosed = [], list(self.lines), None
        n = 0
        while n < len(self.lines):
            fence = FENCE.match(self.lines[n])
            if fence:
                n = self._fenced(n, fence)
            elif INDENTED_COMMAND.match(self.lines[n]) and (n == 0 or not self.lines[n - 1].strip()):
                n = self._indented(n)
            else:
                n += 1

    def _fenced(self, n, fence):
        close = re.compile(r"^ {0,3}" + re.escape(fence[2]) + "+\\s*$")
        end = next((m for m in range(n + 1, len(self.lines)) if close.match(self.lines[m])), None)
        if end is None:
            self.unclosed = n + 1
            end = len(self.lines)
        indent = len(fence[1])
        self._add(fence[3], n, n + 1, end, indent)
        return end + 1

    def _indented(self, n):
        end = n
        while end < len(self.lines) and self.lines[end].startswith("    "):
            end += 1
        self._add("sh", n, n, end, 4)
        return end

    def _add(self, language, top, begin, end, indent):
        lines = [line[indent:] if not line[:indent].strip() else line for line in self.lines[begin:end]]
        self.blocks.append(Block(language, lines, begin + 1, self._marks_above(top), indent))
        self.outside[top:end + 1] = [""] * len(self.outside[top:end + 1])

    def _marks_above(self, n):
        marks = {}
        while n > 0:
            n -= 1
            mark = COMMENT.match(self.lines[n])
            if mark:
                marks[mark[1]] = mark[2] or ""
            elif self.lines[n].strip():
                break
        return marks

    def spans(self):
        """(line number, text) of code within the text."""
        for number, line in enumerate(self.outside, 1):
            for span in SPAN.finditer(line):
                yield number, span[2].strip()

    def links(self):
        """(line number, target) of links and pictures."""
        for number, line in enumerate(self.outside, 1):
            text = SPAN.sub("", line)
            for pattern in (LINK, INNER_IMAGE, HTML_LINK):
                for link in pattern.finditer(text):
                    yield number, link[1]

    def anchors(self):
        """What links may lead to within the page, as GitHub names them."""
        found, count = set(), {}
        for line in self.outside:
            heading = re.match(r"^#{1,6}\s+(.*?)\s*#*\s*$", line)
            if heading:
                text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
                slug = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
                again = count.get(slug, 0)
                count[slug] = again + 1
                found.add(f"{slug}-{again}" if again else slug)
            found |= set(HTML_ANCHOR.findall(line))
        return found

    def replace(self, block, lines):
        """New lines for a block; those below it move."""
        margin = " " * block.indent
        self.lines[block.line - 1:block.line - 1 + len(block.lines)] = [margin + line if line else "" for line in lines]
        grown = len(lines) - len(block.lines)
        for other in self.blocks:
            if other.line > block.line:
                other.line += grown
        block.lines = lines

    def save(self):
        self.path.write_text("\n".join(self.lines) + "\n")

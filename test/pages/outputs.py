# SPDX-License-Identifier: BSD-3-Clause
"""What a page says that a command prints, against what it prints: the same words, and numbers to 1e-3.

A line `...` stands for any number of lines, a word `...` for any words of its line. Numbers below 1e-6 are rounding and count as 0. Times
differ from run to run and are not compared: numbers before the unit s, those of lines that begin with "time", and the last numbers of
rows below a head with [s], up to the next empty line.
"""

import difflib
import re

TOLERANCE, ROUNDING = 1e-3, 1e-6
LIKE = 0.5  # lines of less likeness are not the same line in new words
ELISION = "..."
NUMBER = re.compile(r"(?<![\w.^])([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?![A-Za-z_\d])")
SECONDS = re.compile(NUMBER.pattern + r"(?=\s*s(?:\W|$))")
TIME = "(time)"


def without_times(lines):
    """The lines with a word for each number that is a time."""
    result, columns = [], 0
    for line in lines:
        text = SECONDS.sub(TIME, line)
        if not line.strip():
            columns = 0
        elif "[s]" in line:
            columns = line.count("[s]")
        elif re.match(r"\s*(time\s|\"seconds\")", line):
            text = NUMBER.sub(TIME, text)
        elif columns:
            numbers = list(NUMBER.finditer(text))
            if numbers and not text[numbers[-1].end():].strip():
                for number in reversed(numbers[-columns:]):
                    text = text[:number.start()] + TIME + text[number.end():]
        result.append(text)
    return result


def same_number(expected, actual):
    a, b = float(expected), float(actual)
    if max(abs(a), abs(b)) < ROUNDING:
        return True
    decimals, exponent = re.match(r"[-+]?\d*\.?(\d*)(?:[eE]([-+]?\d+))?", expected).groups()
    unit = 10.0 ** (int(exponent or 0) - len(decimals)) if decimals else 0  # the last digit may be rounded the other way
    return abs(a - b) <= max(TOLERANCE * abs(a), 1.001 * unit)


def word_fault(expected, actual):
    e, a = NUMBER.split(expected), NUMBER.split(actual)
    if e[::2] != a[::2]:
        return f"it says {expected}, the program {actual}"
    return next((f"it says {x}, the program {y}" for x, y in zip(e[1::2], a[1::2]) if not same_number(x, y)), None)


def line_fault(expected, actual):
    fault = mismatch(expected.split(), actual.split(), word_fault)
    return f"{fault[1]} in\n    {actual.strip()}" if fault else None


def mismatch(pattern, items, fault_of):
    """None where the items are those of the pattern, in which ... stands for any number of them; else (index in the pattern, fault).

    @param fault_of  of an entry of the pattern and an item: None where they agree
    """
    n = at = 0
    while n < len(pattern):
        floating = pattern[n].strip() == ELISION
        begin = n + floating
        end = next((m for m in range(begin, len(pattern)) if pattern[m].strip() == ELISION), len(pattern))
        starts = range(at, len(items) - (end - begin) + 1) if floating else [at]
        if floating and end == len(pattern):
            starts = starts[-1:]
        faults = []
        for start in starts:
            fault = next(((m, f) for m in range(begin, end)
                          if (f := fault_of(pattern[m], items[start + m - begin]) if start + m - begin < len(items) else "nothing more comes")), None)
            if fault is None:
                at = start + end - begin
                break
            faults.append(fault)
        else:
            return max(faults, default=(min(begin, len(pattern) - 1), "nothing more comes"), key=lambda fault: fault[0])
        n = end
    if at < len(items) and not (pattern and pattern[-1].strip() == ELISION):
        return max(len(pattern) - 1, 0), f"more comes:\n    {items[at]}"
    return None


def fault(expected, actual):
    """None, or (index of the line in the block, what is wrong)."""
    return mismatch(without_times(expected), without_times([line.rstrip() for line in actual]), line_fault)


def likeness(expected, actual):
    """Of two lines: that of their words without numbers, in [0, 1], and a tenth of that with them, which tells like rows apart. Of a line with words
    left out: the share of its words that the other one has in their order, if that is more."""
    def bare(line):
        return " ".join(NUMBER.sub("#", line.replace(ELISION, "")).split())

    def ratio(a, b):
        return difflib.SequenceMatcher(None, a, b, autojunk=False).ratio()
    of_words = ratio(bare(expected), bare(actual))
    words = bare(expected).split()
    if ELISION in expected and words:  # the program's line may have any number of words more
        matching = difflib.SequenceMatcher(None, words, bare(actual).split(), autojunk=False).get_matching_blocks()
        of_words = max(of_words, sum(block.size for block in matching) / len(words))
    return of_words + 0.1 * ratio(expected, actual) if of_words >= LIKE else 0.0


def places(wanted, actual):
    """Where in `actual` lie the lines most like those of `wanted`, in their order.

    @param wanted  (line, index that it must have or None) of each
    """
    lost = float("-inf")
    best = [[0.0] * (len(actual) + 1)]  # [i][j]: the likeness of the first i lines and those that they have among the first j
    for i, (line, fixed) in enumerate(wanted, 1):
        best.append([lost] * (len(actual) + 1))
        for j, candidate in enumerate(actual, 1):
            like = likeness(line, candidate)
            here = best[i - 1][j - 1] + like if like > 0 and fixed in (None, j - 1) else lost
            best[i][j] = max(best[i][j - 1], here)
    if best[-1][-1] == lost:
        raise LookupError("the program prints no lines that are like those of the page")
    result, j = [], len(actual)
    for row in reversed(best[1:]):
        while row[j] == row[j - 1]:
            j -= 1
        j -= 1
        result.insert(0, j)
    return result


def updated(expected, actual):
    """The block with the program's lines, the same ones left out; raises LookupError where it cannot be told which ones these are."""
    actual = [line.rstrip() for line in actual]
    if not any(line.strip() == ELISION for line in expected):
        if len(expected) == len(actual):  # lines with words left out stay where they hold
            return [e if ELISION in e and line_fault(e, a) is None else a for e, a in zip(expected, actual)]
        return actual
    # The first and the last line of each part between lines ... are looked for; what lies between them is the program's.
    wanted = []
    for n, line in enumerate(expected):
        begins = n == 0 or expected[n - 1].strip() == ELISION
        ends = n == len(expected) - 1 or expected[n + 1].strip() == ELISION
        if line.strip() != ELISION and (begins or ends):
            wanted.append((n, begins, ends))
    fixed = {0: 0, len(expected) - 1: len(actual) - 1}
    found = places([(expected[n], fixed.get(n)) for n, *_ in wanted], actual)
    result, previous = [], None
    for (n, begins, ends), place in zip(wanted, found):
        if begins and n > 0:
            result.append(ELISION)
        if begins and ends and ELISION in expected[n] and line_fault(expected[n], actual[place]) is None:
            result.append(expected[n])
        elif begins and ends and expected[n].endswith(f" {ELISION}"):  # as many words as before
            result.append(" ".join([*actual[place].split(" ")[:len(expected[n].split(" ")) - 1], ELISION]))
        elif ends:
            result += actual[(place if begins else previous):place + 1]
        previous = place
    return result + ([ELISION] if expected[-1].strip() == ELISION else [])

# SPDX-License-Identifier: BSD-3-Clause
"""Features of rpc in pairs: a covering array of decks, each judged by an oracle that reads its files.

    python3 run.py --program=build/rpc [--seed=1] [--rows=110] [--only=K,L] [--jobs=2] [--openmp=build-openmp/rpc] [--keep=DIR] [--known=FILE]

Row K comes from the seed and K alone. Each two values of two factors (covering.py) that may stand together are in a row. A row is run as it is,
on other ranks by the default solver, after a restart, on a finer mesh (rows.py), and passes if the oracle has no complaint (oracle.py,
comparisons.py, reasons.py). A row that fails prints one line, with the folder of its deck. What is known to fail is in known.json; of the seed
and rows that it names, a row that no longer fails is a failure of the list. The exit code is 1 if a row fails that is not known, or such a row passes.
"""
import argparse
import collections
import concurrent.futures
import itertools
import json
import pathlib
import re
import sys
import time

try:
    import covering
    import rows
except ImportError as missing:
    print(f"skipped: {missing}; what this takes: bash cmake/install_packages.sh cmake/ci_packages.txt doc/packages.txt")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent
MOST_PAIRS = 3  # told of one kind of failure


def absolute(paths):
    """The same files from any folder: one, several with a colon between them, or None."""
    return paths and ":".join(str(pathlib.Path(path).resolve()) for path in paths.split(":"))


def arguments(given=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/rpc")
    parser.add_argument("--openmp", help="a program with OpenMP; without one there are no rows of threads")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rows", type=int, default=110)
    parser.add_argument("--only", type=lambda text: [int(k) for k in text.split(",")], help="some rows, by their numbers: 3,17")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--one-rank", action="store_true", help="of a program without MPI")
    parser.add_argument("--mpiexec", default="mpirun --oversubscribe --bind-to none")
    parser.add_argument("--preload", help="a library for runs on several ranks that share cores, or several: A:B")
    parser.add_argument("--keep", default="pairs", help="folder for the decks of rows that fail")
    parser.add_argument("--keep-all", action="store_true")
    parser.add_argument("--update", action="store_true", help="writes the rows of this array that fail by known faults into the list of --known")
    parser.add_argument("--known", default=str(HERE / "known.json"))
    options = parser.parse_args(given)
    # the program runs in the folders of the rows
    options.program, options.openmp, options.preload = (absolute(each) for each in (options.program, options.openmp, options.preload))
    options.keep_all |= options.only is not None
    return options


class Known:
    """Failures that open faults cause: entries of features, a pattern of complaints, and the reason."""

    def __init__(self, path):
        given = json.loads(pathlib.Path(path).read_text()) if path and pathlib.Path(path).exists() else {"entries": [], "lists": []}
        self.path, self.entries, self.lists = path, given["entries"], given["lists"]

    def reason(self, row, complaint):
        for entry in self.entries:
            if all(row[factor] in values for factor, values in entry["features"].items()) and re.search(entry["complaint"], complaint):
                return entry["reason"]
        return None

    def of(self, outcome):
        """Reasons of a row's complaints; None if one of them has none."""
        found = [self.reason(outcome.row, complaint) for complaint in outcome.complaints]
        return None if None in found else sorted(set(found))

    def update(self, seed, count, outcomes):
        """Writes the rows of an array that fail by known faults."""
        others = [each for each in self.lists if (each["seed"], each["rows"]) != (seed, count)]
        fail = [o.number for o in outcomes if o.complaints and self.of(o) is not None]
        self.lists = others + [{"seed": seed, "rows": count, "fail": fail}]
        entries = ",\n".join("    " + json.dumps(each) for each in self.entries)
        lists = ",\n".join("    " + json.dumps(each) for each in self.lists)
        pathlib.Path(self.path).write_text(f'{{\n  "entries": [\n{entries}\n  ],\n  "lists": [\n{lists}\n  ]\n}}\n')

    def listed(self, seed, count):
        """Rows of this array that are known to fail; None if no list is of it."""
        return next((set(each["fail"]) for each in self.lists if (each["seed"], each["rows"]) == (seed, count)), None)


def kind(complaint):
    """A complaint without its numbers and places."""
    text = re.sub(r"^t = [^:]*: ", "", complaint)
    return re.sub(r"\s+", " ", re.sub(r"[-+]?\d[\d.e+-]*|\([^)]*\)|\[[^]]*\]|nan|inf", "#", text))[:70]


def by_pairs(outcomes):
    """{kind of failure: (rows, pairs of features that its rows share most often, against how often they stand in the array)}"""
    in_array = collections.Counter(pair for o in outcomes for pair in covering.pairs_of(o.row))
    failing = collections.defaultdict(list)
    for outcome in outcomes:
        for each in {kind(complaint) for complaint in outcome.complaints}:
            failing[each].append(outcome)
    for each, some in sorted(failing.items(), key=lambda item: -len(item[1])):
        counts = collections.Counter(pair for o in some for pair in covering.pairs_of(o.row))
        ranked = sorted(counts, key=lambda pair: (-counts[pair] / len(some) - counts[pair] / in_array[pair], pair))[:MOST_PAIRS]
        yield each, some, [(pair, counts[pair], in_array[pair]) for pair in ranked]


def report(options, outcomes, of, known, seconds):
    failed = [o for o in outcomes if o.complaints]
    held, wanted = covering.coverage([o.row for o in outcomes], of)
    for each, some, pairs in by_pairs(outcomes):
        print(f"{len(some):4d} x {each}: rows {', '.join(str(o.number) for o in some[:12])}{', ...' if len(some) > 12 else ''}")
        for ((a, b), (c, d)), count, total in pairs:
            print(f"          {a} {b} x {c} {d}: {count} of {total} rows")
    unknown = [o.number for o in failed if known.of(o) is None]
    print(f"seed {options.seed}: {len(outcomes)} rows, {sum(o.runs for o in outcomes)} runs in {seconds:.0f} s; pairs of features: {held} of {wanted}; "
          f"{len(failed)} rows failed, {len(failed) - len(unknown)} of them by known faults")
    return unknown


def stale(options, outcomes, known):
    """Rows that the list has as failing and that pass, of an array that it is of."""
    listed = known.listed(options.seed, options.rows)
    if listed is None or options.only is not None:
        return []
    return sorted(listed - {o.number for o in outcomes if o.complaints})


def main():
    options = arguments()
    of = covering.factors(threads=bool(options.openmp))
    if options.one_rank:
        of["parallel"] = [value for value in of["parallel"] if "ranks" not in value]
    array = list(enumerate(covering.array(options.seed, options.rows, of)))
    if options.only is not None:
        array = [array[k] for k in options.only]
    known, outcomes, start = Known(options.known), [], time.monotonic()
    # processes, not threads: neither netCDF nor every BLAS serves several threads at once
    with concurrent.futures.ProcessPoolExecutor(max_workers=options.jobs) as pool:
        for outcome in pool.map(rows.judge, itertools.repeat(options), itertools.repeat(options.seed), *zip(*array)):
            outcomes.append(outcome)
            if outcome.complaints:
                reason = known.of(outcome)
                print(f"{'FAILED' if reason is None else 'known'} {outcome.number} {', '.join(outcome.row.values())}: {'; '.join(outcome.complaints)}"
                      + (f" [{'; '.join(reason)}]" if reason else "") + f" -> {outcome.folder}", flush=True)
    unknown = report(options, outcomes, of, known, time.monotonic() - start)
    if options.update and options.only is None:
        known.update(options.seed, options.rows, outcomes)
    pass_again = stale(options, outcomes, known)
    if pass_again:
        print(f"rows {pass_again} no longer fail: take them out of {options.known}")
    return 1 if unknown or pass_again else 0


if __name__ == "__main__":
    sys.exit(main())

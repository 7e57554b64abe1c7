# SPDX-License-Identifier: BSD-3-Clause
"""Covering arrays of rpc's features: every pair of values of every two factors that may stand together is in at least one row."""
import itertools
import random

import allpairspy

FACTORS = {
    "body": ["plane", "axisymmetric", "space"],
    "element": ["P1", "Q1", "P2", "Q2"],
    "mesh": ["box", "geo", "msh", "gmsh", "nested"],
    "law": ["rigid", "xi", "hardening", "springs"],
    "friction": ["none", "tresca", "coulomb"],
    "obstacle": ["plane", "sphere", "smooth", "tip", "jump"],
    "history": ["one", "unload", "slide", "tolerance", "restart"],
    "shape": ["well", "slender", "incompressible", "layers"],
    "solver": ["factor", "meshes", "algebraic"],
    "parallel": ["1 rank", "2 ranks", "3 ranks"],
}
THREADS = "2 threads"  # of OpenMP, where the program was built with it
# What cannot stand together, and why: {factor: values}.
EXCLUDED = [
    ({"mesh": {"box"}, "shape": {"layers"}}, "a box has one block"),
    ({"mesh": {"nested"}, "shape": {"layers"}, "element": {"Q1", "Q2"}}, "two blocks come from a file, and nested meshes halve a file's triangles and tetrahedra only"),
]


def factors(threads=False):
    """The factors; with OpenMP if the program has it."""
    return {**FACTORS, "parallel": FACTORS["parallel"] + ([THREADS] if threads else [])}


def allowed(row):
    """Whether the values of a row, which may lack factors, can stand together."""
    return not any(all(row.get(factor) in values for factor, values in rule.items()) for rule, _ in EXCLUDED)


def pairs_of(row):
    """All pairs of (factor, value) of a row, factors in the order of FACTORS."""
    return itertools.combinations(((factor, row[factor]) for factor in FACTORS), 2)


def allowed_pairs(of):
    """All pairs that a row may have."""
    singles = [[(factor, value) for value in values] for factor, values in of.items()]
    return {pair for a, b in itertools.combinations(singles, 2) for pair in itertools.product(a, b) if allowed(dict(pair))}


def covering(rng, of):
    """One covering array: rows that hold each allowed pair at least once."""
    names = list(of)
    values = [rng.sample(of[name], len(of[name])) for name in names]
    rows = [dict(zip(names, row)) for row in
            allpairspy.AllPairs(values, filter_func=lambda part: allowed(dict(zip(names, part))))]
    missing = lambda: sorted(allowed_pairs(of) - {pair for row in rows for pair in pairs_of(row)})
    while missing():  # rules of three factors lead the library into a dead end now and then
        rows.append(row_with(rng, of, missing()[0]))
    return rows


def row_with(rng, of, pair):
    """An allowed row that holds a pair, the rest at random."""
    while True:
        row = {**{name: rng.choice(values) for name, values in of.items()}, **dict(pair)}
        if allowed(row):
            return row


def array(seed, count, of):
    """`count` rows: covering arrays one after another, each of another order of values; the first ones hold all pairs if there are enough rows."""
    rng, rows = random.Random(f"{seed}/array"), []
    while len(rows) < count:
        rows += covering(rng, of)
    return rows[:count]


def coverage(rows, of):
    """(pairs that rows hold, pairs that they may hold)"""
    wanted = allowed_pairs(of)
    return len(wanted & {pair for row in rows for pair in pairs_of(row)}), len(wanted)

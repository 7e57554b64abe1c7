# SPDX-License-Identifier: BSD-3-Clause
"""Kernels against the memory bandwidth of a STREAM triad in the same run."""
import json

from .program import execute
from .table import Table, skipped


def run(bench, ranks, *arguments):
    """The kernels' program: {name: its counters}."""
    command = [bench.kernels, "--benchmark_format=json", *arguments]
    return {entry["name"].split("/iterations")[0].replace("/manual_time", ""): entry
            for entry in json.loads(execute(command, bench.program.launcher(ranks)).output)["benchmarks"]}


def triad(bench, ranks):
    """GB/s on all ranks together; None without the kernels' program."""
    if not bench.kernels:
        return None
    if ranks not in bench.triads:
        bench.triads[ranks] = run(bench, ranks, "--benchmark_filter=triad")["triad"]["GB/s"]
    return bench.triads[ranks]


def kernels(bench):
    title = "Kernels on one rank"
    if not bench.kernels:
        return skipped(title, "it takes Google Benchmark (libbenchmark-dev)")
    plane, space = (",".join(map(str, sizes)) for sizes in bench.sizes["kernels"])
    found = run(bench, 1, "--cells=" + plane, "--cells-in-space=" + space)
    table = Table(title,
                  "Bytes: what must move at least, every array once (kernels.cpp counts them). Times: the least of many, also the "
                  "triad's. Product, smoother and prolongation are those of multigrid's cycle: rows that repeat are kept once, and the "
                  "smoother, of degree 2, starts from a given vector, as after a coarse correction; the CSR product is KokkosKernels'. "
                  "Items: cells for assembly and internal work, rows for the others. Q2 and P2 have half of 1/h cells each way: "
                  "as many nodes. 3D: the same body, as deep as it is high. STREAM triad in the same run: %.1f GB/s." % found["triad"]["GB/s"],
                  ["1/h", "element", "kernel", "items", "bytes per item", "flops per item", "ns per item", "GB/s", "of triad", "GFlop/s"])
    for name, entry in found.items():
        if name == "triad":
            continue
        n, element, kernel = name.split("/")
        flops = entry["flops"]
        table.add(n, element, kernel, "%d" % entry["items"], "%.0f" % (entry["bytes"] / entry["items"]),
                  "%.0f" % (flops / entry["items"]) if flops else "", "%.1f" % entry["ns_per_item"], "%.2f" % entry["GB/s"],
                  "%.0f %%" % (100 * entry["of_triad"]), "%.2f" % entry["GFlop/s"] if flops else "")
    return table

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a V cycle on P GPUs takes, by its bytes, messages and launches: doc/portability.md, "A model of the cost".

    python3 test/benchmark/gpu_cost_model.py            the measured cycles beside the model, and the tables for 8, 64 and 512 GPUs

Q1 boxes in space, halved down; each level on as many ranks as give each 200 000 nodes. Constants: fitted to cycles of
block.xml with 12.2 and 97.0 million unknowns on one and two H100, by the profiler (test/benchmark/profiler.cpp).
"""
import math

KERNELS = 0.411e-9  # [s] of an unknown and cycle on one GPU: all kernels of all levels
OWN_COPY = 0.079e-9  # [s] the same for the copy of a rank's own entries beside its ghosts, where there are several ranks
LAUNCH = 30e-6  # [s] of a launch beyond what its kernel takes by its unknowns: Kokkos, Tpetra's views, small kernels
LAUNCHES = {"first": 21, "each": 15}  # kernels of the finest level, of each other one
EXCHANGE = 50e-6  # [s] two waits for the GPU and a message's latency
EXCHANGES = 8  # of a level that several ranks have: 5 products, a residual, to and from the coarser mesh
BANDWIDTH = 4.0e9  # [B/s] from pinned memory through a host's shared memory and back
NETWORK = 10e9  # [B/s] of a GPU between hosts, taken from data sheets: two halves of 25 GB/s, by way of the host
REDUCTION = 15e-6  # [s] a sum over two ranks; another 5e-6 for each doubling
LEAST_NODES = 200_000
GPUS_OF_HOST = 8


def halo_nodes(nodes, ranks):
    """Of the rank with the most neighbours, when a cube's blocks are cubes: faces alone count."""
    if ranks == 1:
        return 0
    side = (nodes / ranks) ** (1 / 3)
    directions = min(3, math.log2(ranks))  # with a neighbour in one sense or both
    return (1 if ranks <= 8 else 2) * directions * side**2


def cycle(unknowns, ranks, face=None):
    """Seconds of a cycle and of its parts. @param face: nodes of the only border, where it is known"""
    nodes, level = unknowns / 3, 0
    parts = {"kernels": (KERNELS + (OWN_COPY if ranks > 1 else 0)) * unknowns / ranks, "launches": 0.0, "exchanges": 0.0, "bytes": 0.0}
    used = ranks
    numbers = {"messages": 0, "MB": 0.0, "launches": 0}
    while nodes > 130:
        used = max(1, min(used, int(nodes / LEAST_NODES))) if level else ranks
        launches = LAUNCHES["first" if level == 0 else "each"] + (3 * EXCHANGES if used > 1 else 0) * 0.5
        numbers["launches"] += launches
        parts["launches"] += LAUNCH * launches
        if used > 1:
            sent = 24 * EXCHANGES * (face / 4**level if face else halo_nodes(nodes, used))
            parts["exchanges"] += EXCHANGE * EXCHANGES
            parts["bytes"] += sent / (BANDWIDTH if ranks <= GPUS_OF_HOST else min(BANDWIDTH, NETWORK))
            numbers["messages"] += EXCHANGES
            numbers["MB"] += 1e-6 * sent
        nodes /= 8
        level += 1
    return sum(parts.values()), parts, numbers


def iteration(unknowns, ranks):
    """A CG iteration: a cycle, a product with its exchange, some passes over vectors, four sums over the ranks."""
    beside = 0.11 * KERNELS * unknowns / ranks + 4 * (REDUCTION + 5e-6 * max(0, math.log2(ranks) - 1) if ranks > 1 else 0)
    return cycle(unknowns, ranks)[0] + beside


def main():
    print("measured and modelled cycles [ms]")
    for unknowns, ranks, face, measured in ((97.0e6, 1, None, 43.6), (97.0e6, 2, 401 * 201, 33.9), (12.24e6, 1, None, 6.5), (12.24e6, 2, 201 * 101, 9.5)):
        seconds, parts, numbers = cycle(unknowns, ranks, face)
        text = ", ".join(f"{name} {1e3 * value:.1f}" for name, value in parts.items())
        print(f"  {unknowns / 1e6:6.1f} M on {ranks}: measured {measured:5.1f}, model {1e3 * seconds:5.1f} ({text}); "
              f"{numbers['launches']:.0f} launches, {numbers['messages']} exchanges, {numbers['MB']:.1f} MB")
    for title, of in (("97 million unknowns on each GPU", lambda P: 97e6 * P), ("97 million unknowns in all", lambda P: 97e6)):
        print(title)
        one = iteration(of(1), 1)
        for ranks in (1, 2, 8, 64, 512):
            seconds, parts, numbers = cycle(of(ranks), ranks)
            whole = iteration(of(ranks), ranks)
            gain = of(ranks) / of(1) * one / whole
            text = ", ".join(f"{name} {1e3 * value:.2f}" for name, value in parts.items())
            print(f"  {ranks:4d} GPUs: cycle {1e3 * seconds:6.1f} ms ({text}), iteration {1e3 * whole:6.1f} ms, {gain:5.1f} times one, "
                  f"efficiency {100 * gain / ranks:.0f} %")


if __name__ == "__main__":
    main()

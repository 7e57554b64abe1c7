# SPDX-License-Identifier: BSD-3-Clause
"""What every peer reports, as JSON on standard output."""
import json
import os
import time


class Clock:
    """Seconds by phase, from the start of the process on (Linux)."""

    def __init__(self):
        with open("/proc/self/stat") as file:
            ticks = float(file.read().rpartition(")")[2].split()[19])
        with open("/proc/uptime") as file:
            age = float(file.read().split()[0]) - ticks / os.sysconf("SC_CLK_TCK")
        self.seconds = {}
        self.last = time.perf_counter() - age
        self.phase("imports")

    def phase(self, name):
        now = time.perf_counter()
        self.seconds[name] = self.seconds.get(name, 0) + now - self.last
        self.last = now


def report(clock, energy, dofs, newton, **counts):
    clock.phase("solve")
    print(json.dumps({"J": float(energy), "dofs": int(dofs), "newton": newton, **counts, "seconds": clock.seconds}))

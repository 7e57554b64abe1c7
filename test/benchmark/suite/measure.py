# SPDX-License-Identifier: BSD-3-Clause
"""Runs one process and leaves its peak memory, in KiB, its duration and its CPU time, in s, in a file of its own.

    mpirun -n 2 python3 measure.py FOLDER rpc --input=beam.xml

A launcher per rank: mpirun's children are not the benchmark's, and only a parent is told a process' resources.
"""
import os
import subprocess
import sys
import time


def main(folder, *command):
    start = time.perf_counter()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    with open(os.path.join(folder, "%d.measured" % os.getpid()), "w") as file:
        file.write("%d %g %g" % (usage.ru_maxrss, time.perf_counter() - start, usage.ru_utime + usage.ru_stime))
    return os.waitstatus_to_exitcode(status) if os.WIFEXITED(status) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

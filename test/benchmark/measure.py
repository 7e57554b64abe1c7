"""Runs one rank's command and leaves its peak memory, in KiB, in a file of its own.

    mpirun -n 2 python3 measure.py FOLDER rpc --input=beam.xml

A launcher per rank: mpirun's children are not the benchmark's, and only a parent is told a process' resources.
"""
import os
import subprocess
import sys


def main(folder, *command):
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    with open(os.path.join(folder, "%d.maxrss" % os.getpid()), "w") as file:
        file.write(str(usage.ru_maxrss))
    return os.waitstatus_to_exitcode(status) if os.WIFEXITED(status) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

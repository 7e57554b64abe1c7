# SPDX-License-Identifier: BSD-3-Clause
"""CTest's tests under NVIDIA's compute-sanitizer, from a build folder:

    python3 sanitize.py --tool=memcheck|racecheck [--jobs=N] -- [options of ctest that choose tests]

Kokkos 3.4 sums through shared memory without the barriers that racecheck wants between the lanes of a warp, and is warned of it: such
warnings count only outside of Kokkos' reductions and scans. One line for each test; the report of those that fail. The pool of device memory is off, so that each view has a block of its own,
and what lies beyond it is seen. The exit code is 1 if any test fails or any error is found.
"""

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import time


def tests(options):
    """The chosen tests: (name, command, environment)."""
    listing = subprocess.run(["ctest", "--show-only=json-v1", *options], check=True, capture_output=True, text=True)
    for test in json.loads(listing.stdout)["tests"]:
        properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
        environment = dict(entry.split("=", 1) for entry in properties.get("ENVIRONMENT", []))
        yield test["name"], test["command"], {**os.environ, **environment, "RPC_DEVICE_POOL": "off"}


def run(tool, name, command, environment):
    """One test: (name, whether all is well, seconds, output)."""
    start = time.time()
    sanitizer = ["compute-sanitizer", f"--tool={tool}", "--error-exitcode=99", "--target-processes=application-only"]
    if tool == "racecheck":
        sanitizer[2] = "--error-exitcode=0"  # by its summary: warnings would count
    result = subprocess.run(sanitizer + command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    checked = "ERROR SUMMARY: 0 errors" in result.stdout or re.search(r"RACECHECK SUMMARY: .*\b0 errors", result.stdout)
    of_kokkos = re.compile("Kokkos::Impl::Parallel(Reduce|Scan)")
    strange = [line for line in result.stdout.splitlines() if "Race reported" in line and not of_kokkos.search(line)]
    return name, result.returncode == 0 and checked and not strange, time.time() - start, result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", required=True, choices=["memcheck", "racecheck"])
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("options", nargs="*", help="of ctest, after --")
    arguments = parser.parse_args()
    chosen = list(tests(arguments.options))
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for name, good, seconds, output in pool.map(lambda test: run(arguments.tool, *test), chosen):
            print(f"{name:40} {'clean' if good else 'FAILED':6} {seconds:7.1f} s", flush=True)
            if not good:
                failed += 1
                print(output[-4000:], flush=True)
    print(f"{arguments.tool}: {len(chosen) - failed} of {len(chosen)} tests clean")
    return 1 if failed or not chosen else 0


if __name__ == "__main__":
    sys.exit(main())

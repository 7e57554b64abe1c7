# SPDX-License-Identifier: BSD-3-Clause
"""Compiles the sources of packages/ for a GPU, on a machine without one: the device's part alone, to PTX that is thrown away.

    python3 test/gpu_kernels.py --trilinos=DIR [--nvcc=nvcc] [--jobs=2] [--only=REGEX]
    python3 test/gpu_kernels.py --install=DIR      nvcc and its headers from PyPI into DIR, 1.2 GB; then --nvcc=DIR/nvidia/cu13/bin/nvcc

DIR of --trilinos is a Trilinos with Kokkos CUDA. Each source is compiled alone, so that a header that it misses is told; the builds for processors
join sources. A function of the host that a kernel calls is an error: nvcc only warns of it, and such a kernel may never end. Nothing is linked or run.
Exit code 1: some source does not compile, 77: there is no nvcc or no such Trilinos.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WHEELS = ("nvcc", "crt", "runtime", "cccl")
LIBRARIES = ("nvidia-nvvm", "nvidia-cublas", "nvidia-cusparse", "nvidia-cusolver", "nvidia-curand")  # headers of Kokkos and Tpetra
MOST_LINES = 4  # told of one source


def install(folder):
    wheels = [f"nvidia-cuda-{name}" for name in WHEELS] + list(LIBRARIES)
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", folder, *wheels], check=True)
    for program in [*pathlib.Path(folder).glob("nvidia/cu*/bin/*"), *pathlib.Path(folder).glob("nvidia/cu*/nvvm/bin/*")]:
        program.chmod(0o755)


def compiled(source, options):
    """What nvcc says of a source, if it is no warning of another kind; empty: it compiles."""
    home = pathlib.Path(shutil.which(options.nvcc)).resolve().parent.parent
    packages = [f"-I{ROOT.joinpath(*source.parts[:3])}", *(f"-I{folder}/include" for folder in (ROOT / "packages").iterdir())]  # its package's src/ first
    systems = [options.trilinos / "include", *options.include, home / "include", home / "include" / "cccl"]
    command = [options.nvcc, "-x", "cu", *packages, *(word for folder in systems for word in ("-isystem", str(folder))), "-DNDEBUG", '-DRPC_VERSION=""', "-O1",
               "-std=c++17", "-expt-extended-lambda", f"-arch={options.arch}", "--Werror", "cross-execution-space-call", "-ptx", "-o", os.devnull, str(source)]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    errors = [line for line in run.stderr.splitlines() if "error" in line]
    return errors or run.stderr.splitlines()[-MOST_LINES:] if run.returncode else []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trilinos", type=pathlib.Path, default=os.environ.get("RPC_TRILINOS_CUDA"))
    parser.add_argument("--nvcc", default="nvcc")
    parser.add_argument("--include", action="append", default=["/usr/lib/x86_64-linux-gnu/openmpi/include"], help="one more folder of headers")
    parser.add_argument("--arch", default="sm_90")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", type=re.compile, default=re.compile(""), help="regular expression, found in names of sources")
    parser.add_argument("--install", metavar="DIR")
    options = parser.parse_args()
    if options.install:
        install(options.install)
        return 0
    if options.trilinos is None or not (pathlib.Path(options.trilinos) / "include" / "Kokkos_Core.hpp").exists():
        print("not run: --trilinos or RPC_TRILINOS_CUDA must name a Trilinos with CUDA; bash cmake/trilinos.sh --backend=cuda --prefix=DIR makes one")
        return 77
    if shutil.which(options.nvcc) is None:
        print(f"not run: there is no {options.nvcc}; python3 test/gpu_kernels.py --install=DIR gets one, then --nvcc=DIR/nvidia/cu13/bin/nvcc")
        return 77
    sources = [p.relative_to(ROOT) for p in sorted((ROOT / "packages").glob("*/src/**/*.cpp")) if options.only.search(str(p))]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for source, errors in zip(sources, pool.map(lambda source: compiled(source, options), sources)):
            failed += bool(errors)
            for line in errors[:MOST_LINES]:
                print(f"{source}: {line}", flush=True)
    print(f"{len(sources)} sources, {failed} do not compile for {options.arch}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

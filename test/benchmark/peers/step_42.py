# SPDX-License-Identifier: BSD-3-Clause
"""deal.II's step-42, made elastic: python3 step_42.py FOLDER LEVEL

A ball pressed into a cube of 8³, 16³, ... (2^LEVEL)³ cells, each mesh starting from the solution of the one before; one thread. The
source is that of Debian's libdeal.ii-doc, of which FOLDER gets a copy with a yield stress that nothing reaches. On standard output
by mesh, as JSON: cells along an edge, dofs, force [N], iterations of each Newton step, seconds without those for pictures.
"""
import json
import os
import re
import subprocess
import sys

SOURCE = "/usr/share/doc/libdeal.ii-doc/examples/step-42"
COARSEST = 3  # level
PLASTIC, ELASTIC = "sigma_0(400.0)", "sigma_0(1e12)"
PARAMETERS = """set polynomial degree = 1
set number of initial refinements = %d
set number of cycles = %d
set refinement strategy = global
set obstacle = sphere
set transfer solution = true
set output directory = pictures
"""


def build(folder):
    os.makedirs(folder, exist_ok=True)
    for name in ("step-42.cc", "CMakeLists.txt"):
        with open(os.path.join(SOURCE, name)) as file:
            text = file.read()
        if name == "step-42.cc" and text.count(PLASTIC) != 1:
            sys.exit("%s is not the one that this script knows: %s occurs %d times" % (name, PLASTIC, text.count(PLASTIC)))
        with open(os.path.join(folder, name), "w") as file:
            file.write(text.replace(PLASTIC, ELASTIC))
    for step in (["cmake", "-DCMAKE_BUILD_TYPE=Release", "."], ["cmake", "--build", "."]):
        done = subprocess.run(step, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode != 0:
            sys.exit("%s\n%s failed" % (done.stdout, " ".join(step)))


def mesh(text):
    """What step-42 says of a mesh."""
    def number(pattern):
        return float(re.search(pattern, text).group(1))

    def seconds(section):
        return number(r"\| %s +\| +\d+ \| +([\d.e+-]+)s" % section)

    return {"cells": round(number(r"active cells: (\d+)") ** (1 / 3)), "dofs": int(number(r"degrees of freedom: (\d+)")),
            "force": number(r"Contact force = ([\d.e+-]+)"), "iterations": [int(k) for k in re.findall(r"in (\d+) Bicgstab", text)],
            "assembly": seconds("Assembling"), "setup": seconds("Solve: setup preconditioner"), "iterate": seconds("Solve: iterate"),
            "seconds": number(r"since start +\| +([\d.e+-]+)s") - seconds("Graphical output")}


def main(folder, level):
    binary = os.path.join(folder, "step-42")
    if not os.path.exists(binary):
        build(folder)
    with open(os.path.join(folder, "ball.prm"), "w") as file:
        file.write(PARAMETERS % (COARSEST, int(level) - COARSEST + 1))
    run = subprocess.run([os.path.abspath(binary), "ball.prm"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True, check=False, env={**os.environ, "DEAL_II_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"})
    if run.returncode != 0:
        sys.exit("%s\nexit code %d of %s" % (run.stdout, run.returncode, binary))
    print(json.dumps([mesh(text) for text in re.split(r"^Cycle \d+:", run.stdout, flags=re.M)[1:]]))


if __name__ == "__main__":
    main(*sys.argv[1:])

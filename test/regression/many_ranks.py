# SPDX-License-Identifier: BSD-3-Clause
"""More ranks than cores: the answers of one rank, and memory that is shared out."""

import csv
import json
import subprocess
import sys
import unittest

from rpc_run import LAUNCH, PROGRAM, RANKS, SOURCE, RpcTestCase

BLOCK = ["block.xml", "Mesh->Element=Q1"]
SCENES = {
    "a beam in three states": ["beam.xml", "Mesh->Cells={160,32}"],
    "a block in space": [*BLOCK, "Mesh->Cells={24,24,12}"],
    "a mesh from gmsh, dealt out by METIS": ["hertz.xml", "Mesh->Size Factor=2"],
    "triangles of order 2, algebraic multigrid": ["beam.xml", "Mesh->Cells={80,16}", "Mesh->Element=P2", "Linear Solver->Multigrid=algebraic"],
}
TIGHT = ["Uzawa->Tolerance=1e-11", "NOX->Residual Tolerance=1e-12", "Output->Exodus=false"]

# Runs a program and keeps the most memory it had [kB].
PEAK = """
import os, resource, subprocess, sys
code = subprocess.run(sys.argv[2:]).returncode
open(os.path.join(sys.argv[1], "peak.%d" % os.getpid()), "w").write(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss))
sys.exit(code)
"""


class ManyRanks(RpcTestCase):
    def run_scene(self, name, launch, deck, *settings):
        """The folder of its results."""
        folder = self.folder / name
        folder.mkdir()
        command = [*launch, PROGRAM, f"--input={SOURCE / 'input' / deck}", f"--output={folder}", *(f"--set={s}" for s in settings)]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)
        self.assertEqual(result.returncode, 0, f"{command}\n{result.stdout}\n{result.stderr}")
        return folder

    def states(self, folder):
        """State of each contact point, by its place."""
        path, = folder.glob("*.contact.csv")
        with path.open() as table:
            rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
        return {tuple(row[key] for key in ("side", "x", "y", "z") if key in row): row["state"] for row in rows}

    def test_answers_are_those_of_one_rank(self):
        for number, (name, scene) in enumerate(SCENES.items()):
            with self.subTest(name):
                folders = [self.run_scene(f"{number}-{k}", launch, *scene, *TIGHT) for k, launch in enumerate(([], LAUNCH))]
                one, many = (json.loads(next(folder.glob("*.json")).read_text()) for folder in folders)
                self.assertEqual((one["ranks"], many["ranks"]), (1, RANKS))
                self.assertAlmostEqual(many["energy_J"] / one["energy_J"], 1, delta=1e-10)
                self.assertEqual(self.states(folders[1]), self.states(folders[0]))

    def peaks(self, name, launch, *scene):
        """The most memory of each rank [kB]."""
        self.run_scene(name, [*launch, sys.executable, "-c", PEAK, str(self.folder)], *scene)
        found = []
        for path in self.folder.glob("peak.*"):
            found.append(int(path.read_text()))
            path.unlink()
        return found

    def test_no_rank_holds_the_whole_mesh_or_its_fields(self):
        on_one = 10_000  # coarse meshes of up to 4000 nodes, which one rank has, and their factor
        # Layers of cells that neighbours have too weigh more in a small mesh from gmsh.
        for number, (deck, small, large, most) in enumerate([(BLOCK, "Mesh->Cells={6,6,3}", "Mesh->Cells={80,80,40}", 1.5),
                                                             (["hertz.xml"], "Mesh->Size Factor=8", "Mesh->Size Factor=0.6", 3)]):
            # A process takes memory for the program and its libraries whatever the mesh: what a small mesh takes.
            least = min(self.peaks(f"small{number}", LAUNCH, *deck, small, "Output->Exodus=none"))
            one, = self.peaks(f"one{number}", [], *deck, large, "Output->Exodus=none")
            for files in ("none", "joined", "split"):
                with self.subTest(deck=deck[0], files=files):
                    many = [peak - least for peak in self.peaks(f"{files}{number}", LAUNCH, *deck, large, f"Output->Exodus={files}")]
                    self.assertEqual(len(many), RANKS)
                    self.assertLess(max(many), most * (one - least) / RANKS, many)
                    self.assertLess(max(many) - on_one, 1.3 * sum(many) / RANKS, many)


if __name__ == "__main__":
    unittest.main()

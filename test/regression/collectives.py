# SPDX-License-Identifier: BSD-3-Clause
"""All ranks make the same collective calls: each run loads test/support/collectives.c, which ends it where one rank calls what the others do not."""

import json
import os
import re
import subprocess
import time
import unittest

from rpc_run import LAUNCH, PROGRAM, RANKS, SOURCE, RpcTestCase, run

CHECKER = os.environ["RPC_COLLECTIVES"]
LOADED = {"LD_PRELOAD": ":".join(filter(None, [os.environ.get("LD_PRELOAD"), CHECKER])), "RPC_COLLECTIVES_WAIT": "100"}
DIFFERS, WAITS_FOR_EVER = 97, 98
QUIET = ["Output->Exodus=none"]
BEAM, BLOCK, HERTZ = SOURCE / "input/beam.xml", SOURCE / "input/block.xml", SOURCE / "input/hertz_adaptive.xml"
DECKS = SOURCE / "test/verification/decks"
# deck, settings, exit code; meshes have fewer cells than ranks, or few more, on their coarser levels.
SCENES = {
    "the coarse meshes of order 1 are on one rank": (BEAM, ["Mesh->Element=P2", "Mesh->Cells={40,8}", "Linear Solver->Multigrid=mesh"], 0),
    "algebraic multigrid": (BEAM, ["Mesh->Element=Q2", "Mesh->Cells={20,4}", "Linear Solver->Multigrid=algebraic"], 0),
    "Newton with a line search of NOX": (BEAM, ["Mesh->Cells={20,4}", "NOX->Direction->Method=Newton", "NOX->Line Search->Method=Backtrack"], 0),
    "nearly incompressible, in space": (BLOCK, ["Mesh->Cells={6,6,3}", "Material->Poisson's Ratio=0.4999"], 0),
    "a thin body, by the interior-point method": (BEAM, ["Mesh->Cells={120,2}", "Mesh->Upper={60,1}", "Traction->top->Y=-0.02", "Contact->Yield Stress=inf",
                                                        "Contact->Gap=0.01*sin(x)^2"], 0),
    "meshes of gmsh": (HERTZ, ["Adapt->Target Relative Error=0.15"], 0),
    "nested meshes, friction, springs, steps": (DECKS / "springs.xml", ["Adapt->Target Relative Error=0.6", "Steps->Times={0.5,1}"], 0),
    "contact that no node sees": (DECKS / "unseen_circle.xml", [], 0),
    "friction that does not hold the body": (DECKS / "friction_loop.xml", ["Dirichlet->top->X=", "Traction->right->X=0", "Steps->Times={1,1.5}"], 4),
    "a cell for each rank": (BEAM, ["Mesh->Cells={3,1}"], 0),
    "a field that is not finite on some ranks": (BEAM, ["Mesh->Cells={20,4}", "Contact->Yield Stress=sqrt(x - 4)"], 2),
}


def set_all(settings):
    return [f"--set={setting}" for setting in settings]


class Collectives(RpcTestCase):
    def checked(self, *arguments, code=0):
        counts = self.folder / "counts"
        counts.unlink(missing_ok=True)
        result = run(arguments, self.folder, {**LOADED, "RPC_COLLECTIVES_COUNT": str(counts)})
        text = f"{arguments}\n{result.stdout}\n{result.stderr}"
        self.assertNotIn("collectives: ", result.stderr, text)
        self.assertEqual(result.returncode, code, text)
        self.assertGreater(int(counts.read_text()), 10)

    def test_a_call_that_differs_is_found(self):
        for fault, code in (("none", 0), ("call", DIFFERS), ("size", DIFFERS), ("place", DIFFERS), ("throw", DIFFERS), ("wait", WAITS_FOR_EVER)):
            with self.subTest(fault):
                start = time.monotonic()
                result = subprocess.run([*LAUNCH, os.environ["RPC_DIFFERENT_CALLS"], fault], capture_output=True, text=True, timeout=300,
                                        stdin=subprocess.DEVNULL, env={**os.environ, **LOADED, "RPC_COLLECTIVES_WAIT": "2"}, check=False)
                self.assertEqual(result.returncode, code, result.stderr)
                told = {f"collectives: rank {rank}: " for rank in range(RANKS if code else 0)}
                self.assertEqual(set(re.findall(r"collectives: rank \d+: ", result.stderr)), told, result.stderr)
                self.assertEqual("thrown" in result.stderr, fault == "throw", result.stderr)
                self.assertLess(time.monotonic() - start, 100)

    def test_all_ranks_call_the_same(self):
        for name, (deck, settings, code) in SCENES.items():
            with self.subTest(name):
                self.checked(f"--input={deck}", *set_all(settings + QUIET), code=code)

    def test_a_history_and_its_restart(self):
        deck = [f"--input={DECKS / 'friction_loop.xml'}", "--set=Steps->Checkpoint Every=2"]
        self.checked(*deck, "--set=Steps->Times={1,1.5,1.75}")
        self.checked(*deck, "--set=Steps->Times={1,1.5,1.75,2.5}", "--restart")

    def test_the_answer_with_coarse_meshes_on_one_rank_is_that_of_one(self):
        deck, settings, _ = SCENES["the coarse meshes of order 1 are on one rank"]
        energies = []
        for launch in ([], LAUNCH):
            subprocess.run([*launch, PROGRAM, f"--input={deck}", *set_all(settings + QUIET)], cwd=self.folder, check=True, timeout=300,
                           capture_output=True, stdin=subprocess.DEVNULL, env={**os.environ, **LOADED})
            energies.append(json.loads((self.folder / "beam.json").read_text())["energy_J"])
        self.assertAlmostEqual(energies[1] / energies[0], 1, delta=1e-10)


if __name__ == "__main__":
    unittest.main()

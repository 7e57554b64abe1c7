# SPDX-License-Identifier: BSD-3-Clause
"""`Output->Exodus` = `split`: a file a rank, in the place of the joined one, in load steps and restarts too."""

import unittest

from rpc_run import RANKS, SMALL, RpcTestCase, files

SHEAR = ["--input=shear.xml", "--set=Mesh->Cells={24,12}", "--set=Steps->Checkpoint Every=1"]
TIMES = "--set=Steps->Times={%s}"
SPLIT = "--set=Output->Exodus=split"


def parts(name, ranks=RANKS):
    return [f"{name}.{ranks}.{rank}" for rank in range(ranks)]


class SplitFiles(RpcTestCase):
    def test_each_kind_takes_the_place_of_the_others(self):
        for kind, expected in [("joined", ["beam.e"]), ("split", parts("beam.e")), ("true", ["beam.e"]), ("split", parts("beam.e")), ("none", [])]:
            with self.subTest(kind):
                (self.folder / "out").mkdir(exist_ok=True)
                (self.folder / "out" / "beam.e.17.03").touch()  # of a run on more ranks
                result = self.rpc("--input=beam.xml", SMALL, f"--set=Output->Exodus={kind}", "--output=out")
                self.assertEqual([name for name in files(self.folder / "out") if ".e" in name], expected)
                self.assertEqual("beam.e" in result.stdout, kind != "none")
        self.rpc("--input=beam.xml", SMALL, "--set=Output->Exodus=both", code=2)

    def test_a_restart_goes_on_with_them(self):
        times = ["0.5", "1", "1.125"]
        self.rpc(*SHEAR, SPLIT, TIMES % ",".join(times), "--output=whole")
        self.rpc(*SHEAR, SPLIT, TIMES % ",".join(times[:2]), "--output=out")
        result = self.rpc(*SHEAR, SPLIT, TIMES % ",".join(times), "--output=out", "--restart")
        self.assertIn("goes on after", result.stdout)
        self.assertNotIn("lacks times", result.stdout)
        for name in parts("shear.e"):
            self.assertEqual((self.folder / "out" / name).read_bytes(), (self.folder / "whole" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()

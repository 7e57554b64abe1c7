# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles of type "height map", and the surfaces that rpc makes."""
import json
import math
import struct
import unittest

from rpc_run import SOURCE, RpcTestCase

ROUGH = SOURCE / "input" / "rough.xml"
COARSE = "--set=Mesh->Cells={16, 16, 8}"
# Half a wave of Westergaard's, between planes of symmetry, on a body that is deep against it.
WAVE = """deck:
  Mesh: {{Lower: [0.0, 0.0], Upper: [0.5, 1.0], Cells: [{cells}, {deep}]}}
  Material: {{Young's Modulus: 0.91, Poisson's Ratio: 0.3}}
  Dirichlet: {{left: {{X: 0.0}}, right: {{X: 0.0}}}}
  Traction: {{top: {{Y: {pressure}}}}}
  Contact: {{Side: bottom, Normal: "0, -1", {foundation}}}
"""
AMPLITUDE = 0.01
FORMULA = f"Gap: {AMPLITUDE}*(1 - cos(2*pi*x))"
MAP = f"Obstacle: {{Type: height map, File: wave.npy, Spacing X: 0.03125, Periodic: true, Origin: [0.0, {-AMPLITUDE}], Normal: [0.0, 1.0]}}"


def npy(heights, shape, kind="<f8"):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + struct.pack(f"{kind[0]}{len(heights)}d", *heights)


class Heights(RpcTestCase):
    def summary(self, name, output="out"):
        return json.loads((self.folder / output / f"{name}.json").read_text())

    def make(self, *assignments, file="made.npy"):
        return self.rpc(f"--make-surface={file}", *(f"--set={a}" for a in assignments))

    def test_a_wave_is_westergaards(self):
        wave = [AMPLITUDE * math.cos(2 * math.pi * k / 32) for k in range(32)]
        (self.folder / "wave.npy").write_bytes(npy(wave, "(32,)"))
        full = math.pi * AMPLITUDE  # mean pressure of full contact, of E* = 1 and a wave of length 1
        half_width = 0.15
        pressure = full * math.sin(math.pi * half_width) ** 2
        found = {}
        for foundation in (FORMULA, MAP):
            (self.folder / "wave.yaml").write_text(WAVE.format(cells=64, deep=128, pressure=-pressure, foundation=foundation))
            self.rpc("--input=wave.yaml", "--output=out")
            found[foundation] = self.summary("wave")
        self.assertAlmostEqual(found[MAP]["contact_length"], half_width, delta=0.5 / 64)
        self.assertAlmostEqual(found[MAP]["max_pressure"], 2 * full * math.sin(math.pi * half_width), delta=2e-3 * full)
        self.assertAlmostEqual(found[MAP]["energy_J"] / found[FORMULA]["energy_J"], 1, delta=2e-4)

    def test_the_deck_that_comes_with_rpc_tells_its_map_and_is_the_same_on_all_ranks(self):
        check = self.rpc(f"--input={ROUGH}", "--check").stdout
        for part in ("height map \"rough.npy\" of 64 x 64 heights, bicubic, periodic", "1 x 1 m, spacing 0.015625 m", "rms slope 0.0996191"):
            self.assertIn(part, check)
        self.rpc(f"--input={ROUGH}", COARSE, "--output=out")
        found = self.summary("rough")
        self.assertAlmostEqual(found["energy_J"] / ENERGY, 1, delta=1e-7)
        self.assertAlmostEqual(found["contact_area"] / AREA, 1, delta=1e-9)

    def test_a_surface_is_made_the_same_again_and_never_over_a_file(self):
        self.make("RMS Slope=0.1", "Symmetric=true", "Highest Wave Number=8")
        made = struct.unpack("<4096d", (self.folder / "made.npy").read_bytes()[-8 * 4096:])
        kept = struct.unpack("<4096d", (ROUGH.parent / "rough.npy").read_bytes()[-8 * 4096:])
        self.assertLess(max(abs(a - b) for a, b in zip(made, kept)), 1e-15)
        for i in range(64):  # mirrored about 0
            for j in range(64):
                self.assertAlmostEqual(made[64 * j + i], made[64 * (-j % 64) + -i % 64], delta=1e-16)
        self.expect_refusal(self.rpc("--make-surface=made.npy", "--set=RMS Slope=0.1", code=None), 2, ["does not write over", "made.npy"])
        for fault, parts in (("RMS Slope=0", ["one of \"RMS Slope\" and \"RMS Height\" must be > 0"]), ("Points=1", ["\"Points\" must be from 2"]),
                             ("Highest Wave Number=40", ["\"Points\"/2 = 32", "got 40"]), ("Hurst=1", ["Hurst Exponent"]),
                             ("Hurst Exponent=2", ["from 0 to 1", "got 2"]), ("Seed=-1", ["\"Seed\" must be >= 0"])):
            self.expect_refusal(self.rpc("--make-surface=other.npy", "--set=RMS Slope=0.1", f"--set={fault}", code=None), 2, parts)
        self.expect_refusal(self.rpc("--make-surface=other.png", "--set=RMS Slope=0.1", code=None), 2, [".npy, .csv and .asc", "heights.npy"])
        self.expect_refusal(self.rpc("--make-surface=other.npy", "--input=deck.yaml", code=None), 2, ["--make-surface does not go with --input", "Leave one"])
        self.expect_refusal(self.rpc("--make-surface=no/folder.npy", "--set=RMS Slope=0.1", code=None), 2, ["cannot write", "no/folder.npy"])

    def test_a_map_of_each_format_is_the_same(self):
        found = []
        for ending in ("npy", "csv", "asc"):
            self.make("RMS Slope=0.1", "Points=16", "Highest Wave Number=4", file=f"made.{ending}")
            self.rpc(f"--input={ROUGH}", "--set=Mesh->Cells={8, 8, 4}", f"--set=Contact->Obstacle->File={self.folder}/made.{ending}",
                     "--set=Contact->Obstacle->Spacing X=0.0625", f"--output={ending}")
            found.append(self.summary("rough", ending)["energy_J"])
        for energy in found[1:]:
            self.assertAlmostEqual(energy / found[0], 1, delta=1e-12)

    def test_a_restart_goes_on_with_the_same_map_alone(self):
        self.make("RMS Slope=0.1", "Points=16", "Highest Wave Number=4")
        deck = [f"--input={ROUGH}", "--set=Mesh->Cells={8, 8, 4}", f"--set=Contact->Obstacle->File={self.folder}/made.npy",
                "--set=Contact->Obstacle->Spacing X=0.0625", "--set=Contact->Obstacle->Origin={0.1*t, 0, -0.02}",
                "--set=Steps->Checkpoint Every=1"]
        whole = [*deck, "--set=Steps->Times={0.5, 1.0}"]
        self.rpc(*whole, "--output=out")
        self.rpc(*deck, "--set=Steps->Times={0.5}", "--output=on")
        self.rpc(*whole, "--restart", "--output=on")
        self.assertAlmostEqual(self.summary("rough", "on")["energy_J"] / self.summary("rough")["energy_J"], 1, delta=1e-10)
        self.rpc(*deck, "--set=Steps->Times={0.5}", "--output=other")
        (self.folder / "made.npy").unlink()
        self.make("RMS Slope=0.1", "Points=16", "Highest Wave Number=4", "Seed=2")
        self.expect_refusal(self.rpc(*whole, "--restart", "--output=other", code=None), 2, ["Contact->Obstacle->File", "another deck"])

    def test_what_is_no_map_is_refused_on_all_ranks(self):
        good = [1.0, 2.0, 3.0, 4.0]
        faults = {"missing.npy": (None, ["there is no file", "missing.npy"]),
                  "cut.npy": (npy(good, "(2, 2)")[:-1], ["is cut off", "31", "numpy.save"]),
                  "row.npy": (npy(good, "(1, 4)"), ["two rows and two columns", "1 rows of 4"]),
                  "nan.npy": (npy([1.0, 2.0, math.nan, 4.0], "(2, 2)"), ["finite", "row 2, column 1"]),
                  "ragged.csv": (b"1,2\n3\n", ["as many numbers", "line 2"]),
                  "empty.asc": (b"", ["ncols"]), "folder.npy": ("folder", ["is no file"]), "map.x3p": (b"PK", ["SurfaceTopography"]),
                  "damaged.nc": (b"CDF\x01" + bytes(range(60)), ["damaged.nc"])}
        for name, (content, parts) in faults.items():
            with self.subTest(name):
                if content == "folder":
                    (self.folder / name).mkdir()
                elif content is not None:
                    (self.folder / name).write_bytes(content)
                result = self.rpc(f"--input={ROUGH}", COARSE, f"--set=Contact->Obstacle->File={self.folder}/{name}", "--check", code=None)
                self.expect_refusal(result, 2, ["\"Contact->Obstacle->File\"", *parts])


# Of the deck on 16 x 16 x 8 cells.
ENERGY, AREA = -2.4594464362332544e-05, 0.071533203125

if __name__ == "__main__":
    unittest.main()

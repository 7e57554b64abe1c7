# SPDX-License-Identifier: BSD-3-Clause
"""With friction, answers do not depend on `Contact->Penalty`: from 1e-3 to 1e16 Pa/m all scenes are solved, with the energies of `auto`."""

import json
import unittest

from rpc_run import RpcTestCase

MATERIAL = "Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}"
BLOCK = f"""block:
  Mesh: {{Lower: [-1.0, -1.0, 0.0], Upper: [1.0, 1.0, 1.0], Cells: [8, 8, 4], Element: Q1}}
  {MATERIAL}
  Dirichlet: {{left: {{X: 0.0, Y: 0.0, Z: 0.0}}}}
  Traction: {{front: {{Z: -20.0}}}}
  Contact: {{Side: back, Friction Coefficient: 0.3, Yield Stress: "18 + 9*x", Gap: "0.01*(x^2 + y^2)"}}
"""
SHEAR = f"""shear:
  Mesh: {{Lower: [0.0, 0.0], Upper: [2.0, 1.0], Cells: [24, 12], Element: Q1}}
  {MATERIAL}
  Dirichlet: {{top: {{X: "0.02*(t < 1 ? 0 : t < 2 ? t - 1 : 3 - t)", Y: "-0.01*min(1, t)"}}}}
  Contact: {{Side: bottom, Friction Coefficient: 0.3, Yield Stress: 20.0}}
  Steps: {{Times: [0.5, 1.0, 1.25, 1.5, 2.0, 2.25, 2.5, 3.0]}}
"""
BEAM = """beam:
  Mesh: {Lower: [0.0, 0.0], Upper: [5.0, 1.0], Cells: [40, 8], Element: Q1}
  Material: {Young's Modulus: 2000.0, Poisson's Ratio: 0.3}
  Dirichlet: {left: {X: 0.0, Y: 0.0}, right: {X: 0.0, Y: 0.0}}
  Traction: {top: {Y: "-20*sin(pi*x/5)"}}
  Contact: {Side: bottom, Friction Coefficient: 0.3, Yield Stress: 16.0}
"""
SCENES = {
    "block": BLOCK,
    "shear": SHEAR,
    "beam": BEAM,
    "beam on a rigid foundation": BEAM.replace("16.0", "1e300"),
    "beam on springs": BEAM.replace("Yield Stress: 16.0", "Stiffness: 3000.0"),
    "beam on springs that yield and harden": BEAM.replace("16.0", "12.0, Stiffness: 3000.0, Hardening: 400.0"),
    "beam of Tresca's law": BEAM.replace("Friction Coefficient: 0.3", "Friction Bound: 2.0"),
}
PENALTIES = ["1e-3", "1", "1e2", "1e4", "1e6", "1e8", "1e12", "1e16"]  # [Pa/m]


class FrictionPenalties(RpcTestCase):
    def summaries(self, text, penalties):
        name = text.split(":")[0]
        (self.folder / f"{name}.yaml").write_text(text)
        for penalty in penalties:
            self.rpc(f"--input={name}.yaml", f"--output={penalty}", f"--set=Contact->Penalty={penalty}", "--set=Output->Exodus=false")
        return [json.loads((self.folder / penalty / f"{name}.json").read_text()) for penalty in penalties]

    def test_energies_do_not_depend_on_penalties(self):
        for scene, text in SCENES.items():
            with self.subTest(scene):
                reference, *others = self.summaries(text, ["auto"] + PENALTIES)
                self.assertNotIn("weak", " ".join(reference["notes"]))
                for penalty, other in zip(PENALTIES, others):
                    for key in ("energy_J", "energy_norm_squared", "max_shear"):
                        self.assertAlmostEqual(other[key] / reference[key], 1, delta=1e-9, msg=f"{key}, penalty {penalty}")

    def test_a_weak_penalty_is_told(self):
        weak, strong = self.summaries(BEAM, ["1e-3", "1e16"])
        self.assertTrue(any('"Contact->Penalty" is too weak for friction' in note for note in weak["notes"]), weak["notes"])
        self.assertFalse(any("too weak" in note for note in strong["notes"]), strong["notes"])


if __name__ == "__main__":
    unittest.main()

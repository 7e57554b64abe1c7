# SPDX-License-Identifier: BSD-3-Clause
"""The module as a package of pip, without a network; its examples."""
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import unittest

from support import FOLDER, SOURCE, TestCase, rpc


class Installed(TestCase):
    def call(self, *command, cwd=None, **environment):
        result = subprocess.run([str(word) for word in command], cwd=cwd or self.folder, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                                env={**os.environ, **environment})
        self.assertEqual(result.returncode, 0, f"{result.stdout}\n{result.stderr}")
        return result.stdout

    @unittest.skipUnless(importlib.util.find_spec("pip") and importlib.util.find_spec("setuptools"), "needs pip and setuptools")
    def test_by_pip_into_an_environment_without_network(self):
        shutil.copytree(FOLDER, self.folder / "python", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        self.call(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", "env")
        python = self.folder / "env" / "bin" / "python"
        self.call(sys.executable, "-m", "pip", "--python", python, "install", "--no-index", "--no-build-isolation", "--quiet", "./python")
        said = self.call(python, "-c", "import rpc; print(rpc.__file__, rpc.run('beam.xml', settings={'Mesh->Cells': [20, 4]}).summary['cells'])",
                         PYTHONPATH="", RPC_PROGRAM=str(rpc.find_program()))
        place, cells = said.split()
        self.assertTrue(place.startswith(str(self.folder / "env")), place)
        self.assertEqual(cells, "80")

    def test_versions_agree(self):
        of_program = re.search(r"project\(rpc VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        of_package = re.search(r'^version = "(.*?)"', (FOLDER / "pyproject.toml").read_text(), re.MULTILINE)[1]
        self.assertEqual((of_package, rpc.__version__), (of_program, of_program))


class Readme(TestCase):
    def test_its_programs_run(self):
        programs = re.findall(r"```python\n(.*?)```", (FOLDER / "README.md").read_text(), re.DOTALL)
        said = [subprocess.run([sys.executable, "-B", "-c", program], cwd=self.folder, capture_output=True, text=True) for program in programs]
        self.assertEqual([(each.returncode, "Traceback" in each.stderr) for each in said], [(0, False)] * 3, [each.stderr for each in said])
        self.assertTrue(said[0].stdout.startswith("[0.0, 60.0"), said[0].stdout)
        self.assertIn("3/3 ", said[1].stderr)
        self.assertIn('Did you mean "Yield Stress"?', said[2].stdout)


class Examples(TestCase):
    def example(self, name):
        """Rows of numbers that an example prints. With matplotlib it draws its picture."""
        plot = [f"--plot={self.folder / name}.png"] if importlib.util.find_spec("matplotlib") else []
        result = subprocess.run([sys.executable, "-B", FOLDER / "examples" / f"{name}.py", *plot], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list(self.folder.glob("*.png"))), len(plot))
        numbers = [re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", line) for line in result.stdout.splitlines() if re.match(r"\s*\d", line)]
        return [[float(number) for number in row] for row in numbers]

    def test_hertz(self):
        rows = self.example("hertz")
        self.assertEqual(len(rows), 5)
        for _, _, radius, a, pressure, p0, _ in rows:
            self.assertLess(abs(radius / a - 1), 0.02)  # cells of a hundredth
            self.assertLess(abs(pressure / p0 - 1), 0.005)

    def test_yield_limit(self):
        rows = self.example("yield_limit")
        self.assertEqual(len(rows), 9)
        for xi, force, touching, yielded, _ in rows:
            self.assertAlmostEqual(touching, 5, delta=1e-3)
            if xi <= 12:
                self.assertAlmostEqual(force, 5 * xi, delta=1e-3)
            self.assertEqual(yielded == 0, xi >= 20)

    def test_convergence(self):
        rows = self.example("convergence")
        self.assertLess(rows[-1][1], 0.05)
        for dofs, estimate, *_, true, energy in rows:
            self.assertLess(max(estimate / true, true / estimate), 1.5)

    def test_a_missing_program_is_one_line(self):
        for name in ("hertz", "yield_limit", "convergence"):
            result = subprocess.run([sys.executable, "-B", FOLDER / "examples" / f"{name}.py"], capture_output=True, text=True,
                                    env={**os.environ, "RPC_PROGRAM": "/nowhere/rpc"})
            self.assertEqual(result.returncode, 1)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn("/nowhere/rpc", result.stderr)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: BSD-3-Clause
"""Results that cannot be written: one message with the file and the system's reason, the right exit code, nothing
half-written and nothing left behind."""

import os
import resource
import shutil
import subprocess
import unittest

from rpc_run import LAUNCH, PROGRAM, RANKS, SMALL, SOURCE, RpcTestCase, errors, files, ranks_below

FULL, BAD_INPUT = 1, 2
SLOW = "--set=Mesh->Cells={160,32}"
NAMES = ["beam.contact.csv", "beam.e", "beam.json"]


class OutputFaults(RpcTestCase):
    def during(self, fault, *arguments):
        """The result of a run at whose start `fault` happens: a function of the processes' ids."""
        process = subprocess.Popen(LAUNCH + [PROGRAM, "--input=beam.xml", "--output=out", *arguments], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        for line in process.stdout:
            if line.startswith("uzawa newton"):
                break
        fault(ranks_below(process.pid))
        out, err = process.communicate(timeout=600)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def limited(self, size):
        def limit(processes):
            for process in processes:
                resource.prlimit(process, resource.RLIMIT_FSIZE, (size, size))
        return self.during(limit, SLOW)

    def sizes(self):
        self.rpc("--input=beam.xml", SLOW, "--output=out")
        return {name: (self.folder / "out" / name).stat().st_size for name in NAMES}

    def test_file_that_cannot_grow_is_not_left_half_written(self):
        sizes = self.sizes()
        whole = {name: (self.folder / "out" / name).read_bytes() for name in NAMES}
        shutil.rmtree(self.folder / "out")
        limits = [500, *(sizes["beam.e"] * k // 8 for k in range(1, 8)), sizes["beam.e"] - 1]
        for limit in limits if RANKS == 1 else limits[4:5]:
            with self.subTest(limit):
                result = self.limited(limit)
                self.expect_error(result, FULL, ['"out/beam.e"', "File too large"])
                self.assertEqual(files(self.folder), [])
        self.assertEqual(self.limited(sizes["beam.e"]).returncode, 0)
        # Sums on several threads or a GPU vary in the last digits.
        backend = self.rpc("--version").stdout
        repeats = "Serial" in backend or ("OpenMP" in backend and os.environ.get("OMP_NUM_THREADS") == "1")
        for name in NAMES[:2]:
            found = (self.folder / "out" / name).read_bytes()
            if repeats:
                self.assertEqual(found, whole[name])
            elif name.endswith(".csv"):
                self.assertEqual(found.count(b"\n"), whole[name].count(b"\n"))
            else:
                self.assertEqual(len(found), len(whole[name]))

    def expect_error(self, result, code, parts):
        self.assertEqual(result.returncode, code, f"{result.stdout}\n{result.stderr}")
        self.assertEqual(len(errors(result)), 1, result.stderr)
        for part in ["rpc: error: output: ", *parts]:
            self.assertIn(part, errors(result)[0])

    def test_full_disk(self):
        disk = self.folder / "out"
        disk.mkdir()
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk], capture_output=True, check=False)
        if mount.returncode:
            self.skipTest("needs the right to mount a small file system")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        self.rpc("--input=beam.xml", SMALL, "--output=out")
        sizes = {name: self.page_count(disk / name) for name in NAMES}
        for name in NAMES:
            (disk / name).unlink()
        enough_for_all = sum(sizes.values())
        for blocks in [*range(1, enough_for_all, 1 if RANKS == 1 else max(1, enough_for_all // 3)), enough_for_all]:
            subprocess.run(["mount", "-o", f"remount,size={4 * blocks}k", disk], check=True)
            with self.subTest(blocks):
                result = self.rpc("--input=beam.xml", SMALL, "--output=out", code=None)
                enough = blocks >= sum(sizes.values())
                if enough:
                    self.assertEqual(result.returncode, 0, result.stderr)
                else:
                    self.expect_error(result, FULL, ["No space left on device"])
                    self.assertNotIn("beam.json", files(disk))
                for name in files(disk):
                    self.assertIn(name, NAMES)
                    self.assertEqual(self.page_count(disk / name), sizes[name])
                    (disk / name).unlink()

    @staticmethod
    def page_count(path):
        """Blocks of 4 kB that a file takes in memory. Of one that is not written, as of free bytes of a header, there is none."""
        return path.stat().st_blocks * 512 // 4096

    def test_folder_that_vanishes(self):
        result = self.during(lambda _: shutil.rmtree(self.folder / "out"), SLOW)
        self.expect_error(result, BAD_INPUT, ['"out/beam.e"', "No such file or directory", "--output=DIR"])
        self.assertEqual(files(self.folder), [])

    def test_folder_in_place_of_a_file_is_refused_before_the_run(self):
        for name in NAMES[:3 if RANKS == 1 else 1]:
            with self.subTest(name):
                (self.folder / "out" / name).mkdir(parents=True)
                result = self.rpc("--input=beam.xml", SMALL, "--output=out", code=BAD_INPUT)
                self.expect_refusal(result, BAD_INPUT, [f'cannot replace "out/{name}": Is a directory'])
                self.assertNotIn("newton", result.stdout)
                self.assertEqual(files(self.folder), [])
                (self.folder / "out" / name).rmdir()

    def test_what_is_no_file_is_refused_before_the_run(self):
        (self.folder / "out").mkdir()
        for name in NAMES[:3 if RANKS == 1 else 1]:
            with self.subTest(name):
                place = self.folder / "out" / name
                os.mkfifo(place)
                result = self.rpc("--input=beam.xml", SMALL, "--output=out", code=BAD_INPUT)
                self.expect_refusal(result, BAD_INPUT, [f'cannot replace "out/{name}": it is a pipe', "--output=DIR"])
                self.assertNotIn("newton", result.stdout)
                self.assertTrue(place.is_fifo())
                place.unlink()

    def test_name_too_long_for_the_file_system_is_refused_before_the_run(self):
        for length in [237, 250][:2 if RANKS == 1 else 1]:  # with .json and what is appended meanwhile; the deck itself fits
            deck = self.folder / ("n" * length + ".xml")
            shutil.copy(SOURCE / "input" / "beam.xml", deck)
            result = self.rpc(f"--input={deck}", SMALL, "--output=out", code=BAD_INPUT)
            self.expect_refusal(result, BAD_INPUT, ['cannot create "out/nnn', "File name too long", "shorter name"])
            self.assertNotIn("newton", result.stdout)
            self.assertEqual(files(self.folder / "out"), [])

    @unittest.skipIf(RANKS > 1, "needs one rank: rank 0 looks at all files in the same way")
    def test_results_of_all_meshes_are_thought_of_before_the_run(self):
        adaptive = ["--input=beam_adaptive.xml", "--output=out", "--set=Adapt->Max Cycles=3"]
        (self.folder / "out" / "beam_adaptive.cycle3.e").mkdir(parents=True)
        result = self.rpc(*adaptive, "--set=Adapt->Write All=true", code=BAD_INPUT)
        self.expect_refusal(result, BAD_INPUT, ['cannot replace "out/beam_adaptive.cycle3.e": Is a directory'])
        self.assertNotIn("newton", result.stdout)
        self.assertEqual(files(self.folder), [])
        self.rpc(*adaptive, "--set=Adapt->Target Relative Error=0.1")  # nobody writes a file of that name

    def test_folder_that_comes_in_place_of_a_file(self):
        result = self.during(lambda _: (self.folder / "out" / "beam.contact.csv").mkdir(), SLOW)
        self.expect_error(result, BAD_INPUT, ['"out/beam.contact.csv"', "Is a directory"])
        self.assertEqual(files(self.folder), ["out/beam.e"])

    @unittest.skipIf(RANKS > 1, "needs one rank: mpiexec of another user needs a home")
    def test_without_permission_nothing_is_touched(self):
        user = {}
        if os.geteuid() == 0:  # who may write anywhere
            user = {"user": 65534, "group": 65534, "extra_groups": []}
        os.chmod(self.folder, 0o777)
        folder = self.folder / "out"
        folder.mkdir()
        file = folder / "beam.json"
        file.write_text("old")
        file.chmod(0o444)
        for folder_mode, parts in [(0o777, ['cannot replace "out/beam.json": Permission denied']),
                                   (0o555, ['cannot write to the folder "out": Permission denied'])]:
            folder.chmod(folder_mode)
            try:
                result = subprocess.run([PROGRAM, "--input=beam.xml", SMALL, "--output=out"], cwd=self.folder, text=True,
                                        capture_output=True, timeout=600, check=False, **user)
            except PermissionError:
                self.skipTest("another user cannot start the program")
            self.expect_refusal(result, BAD_INPUT, [*parts, "--output=DIR"])
            self.assertEqual(file.read_text(), "old")
            self.assertEqual(files(self.folder), ["out/beam.json"])

    @unittest.skipIf(RANKS > 1, "needs one rank: mpiexec is between the program and its output")
    def test_console_that_is_full(self):
        for arguments in (["--print-parameters"], ["--input=beam.xml", SMALL, "--output=out"]):
            with open("/dev/full", "w") as full, self.subTest(arguments):
                result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, text=True, stdout=full,
                                        stderr=subprocess.PIPE, timeout=600, check=False)
                self.expect_error(result, FULL, ["cannot write to standard output"])
        self.assertEqual(sorted(os.listdir(self.folder / "out")), NAMES)


if __name__ == "__main__":
    unittest.main()

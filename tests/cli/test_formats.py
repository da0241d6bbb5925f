"""Files state the version of their format. Those of every released version can be read, those of a later one are refused."""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import unittest

import h5py

from command import HAMFLOW, CommandCase

RELEASED = pathlib.Path(os.environ["FORMATS"])
MAGIC_AND_FORMAT = struct.Struct("<QQ")
LATER = "has format 2.0; hamflow "


def fnv1a(content):
    hash_so_far = 0xcbf29ce484222325
    for byte in content:
        hash_so_far = (hash_so_far ^ byte) * 0x100000001b3 % 2**64
    return hash_so_far


class Formats(CommandCase):
    def files_of(self, version):
        shutil.copytree(RELEASED / version, self.folder / version)
        return self.folder / version

    def refused(self, *words):
        error = self.hamflow(*words, status=3).stderr
        self.assertIn(LATER, error)
        self.assertIn("and a later version wrote this file", error)

    def versions(self):
        found = sorted(folder.name for folder in RELEASED.iterdir())
        self.assertIn("1.0", found)
        return found

    def test_files_of_every_version_can_be_read(self):
        for version in self.versions():
            with self.subTest(version=version):
                files = self.files_of(version)
                self.hamflow("plot", files / "run", "--output", self.folder / "figure.svg", "--kind", "energy")
                self.hamflow("plot", files / "reversal/reverse.h5", "--output", self.folder / "figure.svg", "--kind", "phase")
                self.hamflow("certify", files / "run/run.h5", "--time", "t", "--energy", "energy")
                # Today's run of the same scenario has the numbers that were stored.
                self.hamflow("run", files / "scenario.toml", "--out", "now", "--force", "--quiet")
                with h5py.File(files / "run/run.h5") as then, h5py.File(self.folder / "now/run.h5") as now:
                    for name in ("t", "q", "p", "energy", "section/q", "events/user/top/t", "observables/r"):
                        self.assertEqual(then[name][()].tolist(), now[name][()].tolist(), name)

    def test_work_of_an_older_version_is_continued_or_refused_because_its_bits_may_differ(self):
        for version in self.versions():
            with self.subTest(version=version):
                files = self.files_of(version)
                for words in (("run", files / "scenario.toml", "--out", files / "run", "--resume", "--set", "run.steps=250"),
                              ("sweep", "--merge", files / "sweep")):
                    done = subprocess.run([HAMFLOW, *words], capture_output=True, text=True)
                    self.assertNotIn("damaged", done.stderr)
                    self.assertNotIn("has format", done.stderr)
                    if done.returncode != 0:
                        self.assertEqual(done.returncode, 3)
                        self.assertIn("version", done.stderr)

    def test_every_file_states_its_format(self):
        self.write("s.toml", (RELEASED / "1.0/scenario.toml").read_text())
        self.hamflow("run", "s.toml", "--out", "run", "--quiet")
        self.hamflow("reverse", "s.toml", "--out", "back", "--quiet")
        self.hamflow("sweep", "s.toml", "--vary", "run.dt=0.05,0.02", "--out", "sweep", "--quiet", "--set", "output.formats=['h5']")
        for file in ("run/run.h5", "back/reverse.h5", "sweep/sweep.h5"):
            with h5py.File(self.folder / file) as h5:
                self.assertEqual(h5.attrs["format"], b"1.0", file)
        for file in ("run/summary.json", "back/reverse.json", "sweep/summary.json"):
            summary = json.loads((self.folder / file).read_text())
            self.assertEqual((next(iter(summary)), summary["format"]), ("format", "1.0"), file)
        for file in ("run/checkpoint.bin", "back/reversal.bin", "sweep/members.bin"):
            self.assertEqual(MAGIC_AND_FORMAT.unpack_from((self.folder / file).read_bytes())[1], 1 << 16, file)

    def test_a_later_format_is_refused_in_a_sentence(self):
        files = self.files_of("1.0")
        for file in ("run/run.h5", "reversal/reverse.h5", "sweep/sweep.h5"):
            with h5py.File(files / file, "r+") as h5:
                h5.attrs["format"] = "2.0"
        for file in ("run/run.h5", "reversal/reverse.h5"):
            self.refused("plot", files / file, "--output", self.folder / "figure.svg", "--kind", "energy")
        self.refused("certify", files / "run/run.h5", "--time", "t", "--energy", "energy")
        self.rewrite(files / "sweep/shard-0-of-2/members.bin", 2 << 16)
        self.refused("sweep", "--merge", files / "sweep")
        self.rewrite(files / "run/checkpoint.bin", 2 << 16)
        self.refused("run", files / "scenario.toml", "--out", files / "run", "--resume")

    def rewrite(self, file, word):
        content = bytearray(file.read_bytes())
        magic, _ = MAGIC_AND_FORMAT.unpack_from(content)
        MAGIC_AND_FORMAT.pack_into(content, 0, magic, word)
        if file.name == "checkpoint.bin":  # ends with a hash of all that is before
            content[-8:] = struct.pack("<Q", fnv1a(content[:-8]))
        file.write_bytes(content)


if __name__ == "__main__":
    unittest.main()

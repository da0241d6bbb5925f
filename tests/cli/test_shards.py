"""hamflow sweep --shard, --merge: several processes make the files of one, to the byte, also when they are killed."""

import json
import os
import random
import shutil
import signal
import subprocess
import time
import unittest

from command import HAMFLOW, CommandCase

MEASURED = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.1], p = [0.2, 0.3] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 3000
section = { coordinate = "q1" }
lyapunov = 1
[output]
formats = ["h5", "csv"]
observables = { r = "q1^2 + q2^2" }
"""
FILES = ("sweep.h5", "sweep.csv", "section.csv")
VARY = ("--vary", "problem.initial.q[1]=-0.2:0.2:23")


class Shards(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("s.toml", MEASURED)

    def sweep(self, *words, status=0, env=None):
        done = subprocess.run([HAMFLOW, "sweep", *words, "--quiet"], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, **(env or {})})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def files(self, folder):
        return {name: (self.folder / folder / name).read_bytes() for name in FILES}

    def whole(self):
        self.sweep("s.toml", *VARY, "--out", "whole")
        return self.files("whole")

    def test_any_number_of_shards_merged_in_any_order_give_the_files_of_one_sweep(self):
        whole = self.whole()
        for count in (2, 5, 23, 31):
            shards = list(range(count))
            random.Random(count).shuffle(shards)
            for shard in shards:
                self.sweep("s.toml", *VARY, "--out", f"in{count}", "--shard", f"{shard}/{count}", status=0)
            self.assertFalse((self.folder / f"in{count}" / "sweep.h5").exists())
            self.sweep("--merge", f"in{count}")
            self.assertEqual(self.files(f"in{count}"), whole)
            self.sweep("--merge", f"in{count}")  # again, with the journal of the whole in it
            self.assertEqual(self.files(f"in{count}"), whole)

    def test_a_merge_before_the_end_names_what_is_missing(self):
        self.sweep("s.toml", *VARY, "--out", "x", "--shard", "1/4")
        done = subprocess.run([HAMFLOW, "sweep", "--merge", "x", "--json"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        summary = json.loads(done.stdout)
        self.assertEqual((summary["status"], summary["members"], summary["done"], summary["unfinished"]),
                         ("interrupted", 23, 6, 17))
        self.assertIn("members are missing from the shards 0/4, 2/4, 3/4", done.stderr)
        table = (self.folder / "x/sweep.csv").read_text()
        self.assertEqual(table.count("not_run"), 17)
        # The rest by another number of shards, and by one process.
        self.sweep("s.toml", *VARY, "--out", "x", "--shard", "0/2")
        self.sweep("s.toml", *VARY, "--out", "x", "--resume")
        self.assertEqual(self.files("x"), self.whole())

    def test_a_shard_does_not_run_what_another_has_finished(self):
        self.sweep("s.toml", *VARY, "--out", "x", "--shard", "1/4")
        done = subprocess.run([HAMFLOW, "sweep", "s.toml", *VARY, "--out", "x", "--shard", "1/2", "--resume", "--json"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertIn("6 of 11 members are finished already", done.stderr)
        summary = json.loads(done.stdout)
        self.assertEqual((summary["status"], summary["shard"], summary["members"], summary["done"]), ("done", "1/2", 11, 11))

    def test_kills(self):
        whole = self.whole()
        rng = random.Random(3)
        for trial in range(int(os.environ.get("HAMFLOW_SHARD_KILLS", "6"))):
            shutil.rmtree(self.folder / "k", ignore_errors=True)
            count = rng.choice((2, 3, 4))
            for shard in range(count):
                words = ["s.toml", *VARY, "--out", "k", "--shard", f"{shard}/{count}", "--threads", "1", "--resume"]
                process = subprocess.Popen([HAMFLOW, "sweep", *words, "--quiet"], cwd=self.folder,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(rng.random() * 0.1)
                process.send_signal(rng.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT)))
                process.wait()
            if rng.random() < 0.5:
                subprocess.run([HAMFLOW, "sweep", "--merge", "k", "--quiet"], cwd=self.folder, capture_output=True)
            count = rng.choice((count, 5))
            for shard in range(count):
                self.sweep("s.toml", *VARY, "--out", "k", "--shard", f"{shard}/{count}", "--resume")
            self.sweep("--merge", "k")
            self.assertEqual(self.files("k"), whole, trial)

    def test_shards_that_run_at_once(self):
        processes = [subprocess.Popen([HAMFLOW, "sweep", "s.toml", *VARY, "--out", "x", "--shard", f"{shard}/3", "--quiet"],
                                      cwd=self.folder, stdout=subprocess.DEVNULL) for shard in range(3)]
        self.assertEqual([process.wait() for process in processes], [0, 0, 0])
        self.sweep("--merge", "x")
        self.assertEqual(self.files("x"), self.whole())

    def test_numbers_of_the_job_system(self):
        for number, env in enumerate((
                {"SLURM_ARRAY_TASK_ID": "7", "SLURM_ARRAY_TASK_MIN": "5", "SLURM_ARRAY_TASK_COUNT": "4"},
                {"SLURM_ARRAY_TASK_ID": "9", "SLURM_ARRAY_TASK_MIN": "5", "SLURM_ARRAY_TASK_COUNT": "4",
                 "SLURM_ARRAY_TASK_STEP": "2"},
                {"SLURM_PROCID": "2", "SLURM_NTASKS": "4"},
                {"OMPI_COMM_WORLD_RANK": "2", "OMPI_COMM_WORLD_SIZE": "4"}, {"PMI_RANK": "2", "PMI_SIZE": "4"})):
            done = self.sweep("s.toml", *VARY, "--set", "run.steps=10", "--out", f"e{number}", "--shard", "auto", "--json",
                              env=env)
            self.assertEqual(json.loads(done.stdout)["shard"], "2/4")
            self.assertTrue((self.folder / f"e{number}/shard-2-of-4/members.bin").exists())
        done = self.sweep("s.toml", *VARY, "--out", "none-of-these", "--shard", "auto", status=2)
        self.assertIn("--shard: error: found auto, but", done.stderr)

    def test_refusals(self):
        self.sweep("s.toml", *VARY, "--out", "x", "--shard", "0/2")
        for words, message in (
                (("s.toml", *VARY, "--shard", "2/2"), "--shard: error: found 2/2; allowed 0/2 to 1/2"),
                (("s.toml", *VARY, "--shard", "1"), "allowed INDEX/COUNT, e.g. 0/64, or auto"),
                (("s.toml", *VARY, "--shard", "-1/4"), "allowed INDEX/COUNT"),
                (("s.toml", *VARY, "--shard", "0/0"), "allowed INDEX/COUNT"),
                (("s.toml", *VARY, "--shard", "0/2", "--out", "none"), "--shard with --out none"),
                (("s.toml", *VARY, "--shard", "0/2", "--figure", "x.svg"), "allowed with --merge DIR"),
                (("s.toml", "--merge", "x"), "found --merge with a scenario"),
                (("--merge", "x", "--resume"), "found --merge with --resume"),
                (VARY, "scenario: missing; allowed a TOML file, or --merge DIR"),
                (("s.toml",), "--vary: error: missing")):
            self.assertIn(message, self.sweep(*words, status=2).stderr)
        for words, message in (
                (("--merge", "nowhere"), "found no sweep in nowhere"),
                (("s.toml", *VARY, "--out", "x", "--shard", "0/2"), "exists; give --resume"),
                (("s.toml", *VARY, "--out", "x", "--force"), "found shards of a sweep in x"),
                (("s.toml", "--vary", "problem.initial.q[1]=-0.2:0.2:22", "--out", "x", "--shard", "1/2", "--resume"),
                 "shard-0-of-2/members.bin belongs to another sweep")):
            self.assertIn(message, self.sweep(*words, status=3).stderr)
        self.sweep("s.toml", *VARY, "--set", "run.dt=0.01", "--out", "x", "--shard", "1/2")
        self.assertIn("belongs to another sweep", self.sweep("--merge", "x", status=3).stderr)


if __name__ == "__main__":
    unittest.main()

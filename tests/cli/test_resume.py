"""Runs that are killed, interrupted or extended and resumed: what they leave is what the uninterrupted run leaves."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import unittest

from command import HAMFLOW, CommandCase, until_it_works

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from kill_and_resume import differences, kill_and_resume  # noqa: E402

COMPARE = os.environ["COMPARE_RUNS"]

RUN = """
[problem]
{problem}
[method]
{method}
[run]
{run}
[output]
formats = ["h5", "csv"]
"""
KEPLER = 'name = "central-force"\npotential = "kepler"\norbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }'
CHAOS = 'name = "henon-heiles"\ninitial = { q = [0, -0.15], p = [0.54, 0.1] }'
MEASURES = "\nlyapunov = true\neigenvalues = true\nsection = { coordinate = 'q1', direction = 0 }"
MAGNETIC = 'name = "magnetic"\ninitial = { q = [1, 0, 0], p = [0, 1, 0.1] }'


class Resume(CommandCase):
    def scenario(self, method='name = "stv4"', run="dt = 0.01\nsteps = 3000", problem=KEPLER):
        return self.write("s.toml", RUN.format(problem=problem, method=method, run=run))

    def run_to(self, folder, *arguments, status=0):
        return self.hamflow("run", "s.toml", "--out", folder, "--json", *arguments, status=status)

    def expect_equal(self, a, b):
        self.assertEqual(differences(COMPARE, self.folder / a, self.folder / b), [])

    def interrupted(self, folder, *arguments, after=0.4):
        """A run stopped by Ctrl-C; its summary."""
        process = subprocess.Popen([HAMFLOW, "run", "s.toml", "--out", folder, "--json", *arguments], cwd=self.folder,
                                   stdout=subprocess.PIPE, text=True)
        until_it_works(process, after)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=20)
        return process.returncode, json.loads(out)

    def test_nothing_goes_on_in_the_folder_of_another_kind(self):
        self.scenario(run="dt = 0.01\nsteps = 100")
        self.run_to("a")
        self.hamflow("reverse", "s.toml", "--out", "b", "--json")
        before = sorted(os.listdir(self.folder / "a"))
        for arguments, kind, other in ((("reverse", "s.toml", "--out", "a"), "run", "reversal"),
                                       (("sweep", "s.toml", "--vary", "run.dt=0.01,0.02", "--out", "a"), "run", "sweep"),
                                       (("run", "s.toml", "--out", "b"), "reversal", "run")):
            said = self.hamflow(*arguments, "--resume", status=3).stderr
            self.assertIn(f"found a {kind} in", said)
            self.assertIn(f"which cannot be resumed as a {other}", said)
            said = self.hamflow(*arguments, status=3).stderr
            self.assertIn(f"exists and contains a {kind}; give another --out", said)
        self.assertEqual(sorted(os.listdir(self.folder / "a")), before)

    def test_the_scenario_of_a_longer_run_has_its_spacing_of_samples(self):
        self.scenario(run="dt = 0.01\nsteps = 100")
        self.run_to("a")
        self.run_to("a", "--resume", "--set", "run.steps=30000")
        self.assertRegex((self.folder / "a/run.h5").read_bytes(), rb"steps = 30000\s[^\0]*record_every = 1\b|"
                                                                  rb"record_every = 1\s[^\0]*steps = 30000\b")

    def test_a_complete_run_says_the_same_again(self):
        """Also where its summary holds what JSON writes as null: an unbounded orbit, overflowed derivatives."""
        hooke = 'name = "central-force"\npotential = "hooke"\ninitial = { q = [1, 0], p = [0, "0.7"] }'
        for method, run in (('name = "cg"', "dt = 0.1\nsteps = 400"), ('name = "stv4"', "dt = 1\nsteps = 300"),
                            ('name = "stv4"', "dt = 1\nsteps = 300" + MEASURES.replace("q1", "x"))):
            with self.subTest(method=method, run=run):
                self.scenario(method, run, hooke)
                first = self.hamflow("run", "s.toml", "--out", "r", "--force").stdout
                again = self.hamflow("run", "s.toml", "--out", "r", "--resume").stdout
                self.assertIn("null", (self.folder / "r" / "summary.json").read_text())
                kept = [[line for line in text.splitlines() if not line.startswith(("wall", "written"))]
                        for text in (first, again)]
                self.assertEqual(*kept)

    def test_kills_at_random_moments(self):
        for method, run, problem in (
            ('name = "stv4"', "dt = 0.01\nsteps = 300_000\nrecord_every = 101", KEPLER),
            ('name = "verlet-dkd"', "dt = 0.01\nsteps = 300_000\narithmetic = 'compensated'", KEPLER),
            ('name = "yoshida6"', "dt = 0.01\nsteps = 200_000\narithmetic = 'lattice'", KEPLER),
            ('name = "rk4"', "dt = 0.01\nsteps = 200_000\nrecord_every = 7000", KEPLER),
            ('name = "stv4" # watched', "dt = 0.1\nsteps = 20_000" + MEASURES, CHAOS),
            ('name = "boris"', "dt = 0.01\nsteps = 300_000", MAGNETIC),
            ('name = "cg"\ndiagnostics = true\non_divergence = "halve"', "dt = 0.1\nsteps = 30_000", KEPLER),
            ('name = "cg"\ndegree = 2', "dt = 0.1\nsteps = 30_000", KEPLER),
            ('name = "gauss"\nstages = 4\niteration = "fixed-point"', "dt = 0.1\nsteps = 30_000", KEPLER),
        ):
            with self.subTest(method=method, run=run):
                self.scenario(method, run + "\ncheckpoint_every = 7001", problem)
                room = self.folder / method.replace('"', "").replace("\n", " ")
                room.mkdir()
                killed, with_checkpoint, compared, wrong = kill_and_resume(
                    HAMFLOW, COMPARE, self.folder / "s.toml", [], 5, 1, room, say=lambda text: None)
                self.assertEqual(wrong, [])
                self.assertEqual(killed, 5)
                self.assertGreater(compared, 0)

    def test_interrupt_and_resume(self):
        # One sample would stand at the interruption only: it has to be gone in the end.
        self.scenario(run="dt = 0.01\nsteps = 20_000_000\nrecord_every = 10007")
        self.run_to("whole")
        status, summary = self.interrupted("part", after=0.05)
        self.assertEqual(status, 130)
        self.assertEqual(summary["status"], "interrupted")
        self.assertGreater(summary["steps"], 0)
        resumed = json.loads(self.run_to("part", "--resume").stdout)
        self.assertEqual(resumed["steps"], 20_000_000)
        self.expect_equal("whole", "part")

    def test_more_steps(self):
        self.scenario(run="dt = 0.01\nsteps = 1000\nrecord_every = 3")  # the last step is a sample as the last one only
        self.run_to("part")
        self.run_to("part", "--resume", "--set", "run.steps=2000")
        self.run_to("whole", "--set", "run.steps=2000")
        a, b = ((self.folder / name / "trajectory.csv").read_text() for name in ("whole", "part"))
        self.assertEqual(a, b)
        done = self.run_to("part", "--resume", "--set", "run.steps=100", status=2)
        self.assertIn("at least 2000", done.stderr)

    def test_measures_go_on_to_the_last_bit(self):
        """Exponents, eigenvalues and the section after ends that fall everywhere within a renormalisation."""
        self.scenario(run="dt = 0.1\nsteps = 5000" + MEASURES, problem=CHAOS)
        self.run_to("whole")
        wanted = json.loads((self.folder / "whole" / "summary.json").read_text())
        for number, ends in enumerate(([1], [64], [1000], [7, 2113, 4999], [3000, 3001, 3002, 3040])):
            with self.subTest(ends=ends):
                for end in ends:
                    part = json.loads(self.run_to(f"part{number}", "--resume", "--set", f"run.steps={end}").stdout)
                    self.assertEqual(part["steps"], end)
                    self.assertEqual(part["eigenvalues"]["steps"], end)
                found = json.loads(self.run_to(f"part{number}", "--resume").stdout)
                for key in ("lyapunov", "eigenvalues", "section", "certificate", "energy"):
                    self.assertEqual(found[key], wanted[key])
                self.expect_equal("whole", f"part{number}")

    def test_measures_after_an_interruption(self):
        self.scenario(run="dt = 0.1\nsteps = 4_000_000\nrecord_every = 10_007" + MEASURES, problem=CHAOS)
        self.run_to("whole")
        status, summary = self.interrupted("part", after=0.05)
        self.assertEqual((status, summary["status"]), (130, "interrupted"))
        self.run_to("part", "--resume")
        self.expect_equal("whole", "part")

    def test_points_of_the_section_after_the_checkpoint_are_dropped(self):
        self.scenario(run="dt = 0.1\nsteps = 5000\ncheckpoint_every = 1000" + MEASURES, problem=CHAOS)
        self.run_to("whole")
        self.run_to("part", "--set", "run.steps=1000")
        early = (self.folder / "part" / "checkpoint.bin").read_bytes()
        self.run_to("part", "--resume", "--set", "run.steps=3000")
        (self.folder / "part" / "checkpoint.bin").write_bytes(early)  # as if killed before the next one
        self.run_to("part", "--resume")
        self.expect_equal("whole", "part")
        (self.folder / "part" / "checkpoint.bin").write_bytes(early)
        changed = self.run_to("part", "--resume", "--set", "run.lyapunov=2", status=2)
        self.assertIn("error: run.lyapunov: found 2; allowed with --resume true", changed.stderr)

    def test_more_steps_keep_the_spacing_of_samples(self):
        self.scenario(run="dt = 0.01\nsteps = 25_000")
        self.run_to("part")
        done = self.run_to("part", "--resume", "--set", "run.steps=70_000")
        self.assertIn("every 3 steps", done.stderr)
        self.run_to("whole", "--set", "run.steps=70_000", "--set", "run.record_every=3")
        a, b = ((self.folder / name / "trajectory.csv").read_text() for name in ("whole", "part"))
        self.assertEqual(a, b)

    def test_a_finished_run_has_nothing_to_do(self):
        self.scenario()
        first = self.run_to("r").stdout
        before = {p.name: p.read_bytes() for p in (self.folder / "r").iterdir()}
        again = self.run_to("r", "--resume")
        self.assertEqual(again.stdout, first)
        self.assertIn("nothing to do", again.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in (self.folder / "r").iterdir()}, before)
        self.hamflow("run", "s.toml", "--out", "r", "--resume")  # as text, too

    def test_killed_between_the_last_step_and_the_summary(self):
        self.scenario(run="dt = 0.01\nsteps = 1000\nrecord_every = 3")
        self.run_to("whole")
        self.run_to("part")
        (self.folder / "part" / "summary.json").unlink()
        self.run_to("part", "--resume")
        self.expect_equal("whole", "part")

    def test_without_a_checkpoint_it_starts_from_the_beginning(self):
        self.scenario()
        self.run_to("whole")
        self.assertIn("the folder new does not exist", self.run_to("new", "--resume").stderr)
        self.expect_equal("whole", "new")
        (self.folder / "empty").mkdir()
        (self.folder / "empty" / "checkpoint.bin.new").write_bytes(b"half")  # killed as it was written
        (self.folder / "empty" / "notes.txt").write_text("mine")
        done = self.run_to("empty", "--resume")
        self.assertIn("no checkpoint", done.stderr)
        self.assertIn("from the beginning", done.stderr)
        self.expect_equal("whole", "empty")
        self.assertEqual((self.folder / "empty" / "notes.txt").read_text(), "mine")

    def test_another_scenario_is_refused(self):
        self.scenario()
        self.run_to("r")
        before = {p.name: p.read_bytes() for p in (self.folder / "r").iterdir()}
        for change, key in (("run.dt=0.02", "run.dt"), ("method.name=verlet", "method.name"),
                            ("problem.k=2", "problem.k"), ("run.arithmetic=compensated", "run.arithmetic"),
                            ("run.record_every=7", "run.record_every"), ("problem.orbit.r_aph=2.5", "problem.orbit.r_aph"),
                            ("output.formats=['h5']", "output.formats")):
            done = self.run_to("r", "--resume", "--set", change, "--set", "run.steps=4000", status=2)
            self.assertIn(f"error: {key}: found", done.stderr)
            rejected = json.loads(done.stdout)
            self.assertEqual(rejected["status"], "rejected")
            self.assertEqual([e["key"] for e in rejected["errors"]], [key])
        self.write("s.toml", (self.folder / "s.toml").read_text().replace("dt = 0.01\n", "dt = 0.03\n"))
        self.assertIn("s.toml:9:6: error: run.dt: found 0.03;", self.run_to("r", "--resume", status=2).stderr)
        self.assertEqual({p.name: p.read_bytes() for p in (self.folder / "r").iterdir()}, before)

    def test_long_lists_are_not_told_whole(self):
        times = ",\n".join(f"{k / 100}" for k in range(1500))
        self.scenario(run=f"dt = 0.01\nsteps = 3000\nrecord = [{times}]")
        self.run_to("r")
        said = self.run_to("r", "--resume", "--set", "run.record=[1, 2]", status=2).stderr
        self.assertIn("run.record: found [1, 2]; allowed with --resume [0.0, 0.01, 0.02, ..., 14.98", said)
        self.assertIn("] (1500 entries), as when the run began", said)
        self.assertNotIn("\\n", said)
        self.assertLess(len(said), 400)

    def test_options_that_exclude_each_other(self):
        self.scenario()
        for other in (["--force"], ["--out", "none"]):
            done = self.hamflow("run", "s.toml", "--json", "--resume", *other, status=2)
            self.assertIn("--resume", done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "rejected")
        self.assertEqual([p.name for p in self.folder.iterdir() if p.is_dir()], [])
        self.run_to("r")
        self.assertIn("--resume", self.run_to("r", status=3).stderr)

    def test_damaged_files(self):
        self.scenario(run="dt = 0.01\nsteps = 1000\nrecord_every = 3")
        self.run_to("r")
        checkpoint = self.folder / "r" / "checkpoint.bin"
        good = checkpoint.read_bytes()
        more = ("--resume", "--set", "run.steps=2000")
        for bad in (b"", good[:20], good[:-1], good + b"x", b"\0" * len(good),
                    *(good[:i] + bytes([good[i] ^ 1]) + good[i + 1:] for i in range(0, len(good), 50))):
            checkpoint.write_bytes(bad)
            done = self.run_to("r", *more, status=3)
            self.assertIn("checkpoint", done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "failed")
        checkpoint.write_bytes(good)
        h5 = self.folder / "r" / "run.h5"
        whole = h5.read_bytes()
        for bad in (b"", whole[:3000], b"\0" * 1000):
            h5.write_bytes(bad)
            self.assertIn("run.h5", self.run_to("r", *more, status=3).stderr)
            self.assertEqual(h5.read_bytes(), bad)
        h5.write_bytes(whole)
        csv = self.folder / "r" / "trajectory.csv"
        text = csv.read_bytes()
        csv.write_bytes(text[:-10])
        # The last row stands for the end only, so that ten bytes are not missed; a thousand are.
        csv.write_bytes(text[:-1000])
        self.assertIn("trajectory.csv", self.run_to("r", *more, status=3).stderr)
        csv.write_bytes(text)
        self.run_to("r", *more)
        self.run_to("whole", "--set", "run.steps=2000")
        a, b = ((self.folder / name / "trajectory.csv").read_text() for name in ("whole", "r"))
        self.assertEqual(a, b)

    def test_an_unfinished_checkpoint_does_not_count(self):
        self.scenario(run="dt = 0.01\nsteps = 1000")
        self.run_to("r")
        (self.folder / "r" / "checkpoint.bin.new").write_bytes(b"half")
        (self.folder / "r" / "run.h5.new").write_bytes(b"half")
        self.run_to("r", "--resume", "--set", "run.steps=1500")
        self.assertEqual(sorted(p.name for p in (self.folder / "r").iterdir()),
                         ["checkpoint.bin", "run.h5", "summary.json", "trajectory.csv"])

    def test_a_failed_run_fails_again_in_the_same_way(self):
        self.scenario(method='name = "rk4"', run="dt = 0.05\nsteps = 100_000\ncheckpoint_every = 10",
                      problem='name = "henon-heiles"\ninitial = { q = [0, 3], p = [0, 1] }')
        first = json.loads(self.run_to("r", status=1).stdout)
        self.assertTrue((self.folder / "r" / "checkpoint.bin").exists())
        again = json.loads(self.run_to("r", "--resume", status=1).stdout)
        for summary in (first, again):
            del summary["wall_seconds"], summary["steps_per_second"]
        self.assertEqual(first, again)


if __name__ == "__main__":
    unittest.main()

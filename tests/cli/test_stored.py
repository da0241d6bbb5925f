"""What run.h5 says of its run: the scenario that was carried out, which run takes as it is."""

import json
import os
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

COMPARE = os.environ["COMPARE_RUNS"]
PENDULUM = """
# a comment that looks like a setting is none:
# --set method.name=euler
[problem]
name = "double-pendulum"
initial = { q = [0.3, -1.25], p = [0.5, "1/3"] }
masses = [1, 2]
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.01
t_end = 2.0
"""
EIGHT = (EXAMPLES / "figure_eight.toml").read_text()


class Stored(CommandCase):
    def compared(self, *arguments):
        done = subprocess.run([COMPARE, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 2, done.stderr)
        return done.stdout

    def assert_rerun(self, file, *settings):
        """Runs, stores, runs what was stored: the same samples and the same summary."""
        sets = [part for setting in settings for part in ("--set", setting)]
        self.hamflow("run", file, *sets, "--out", "first", "--force", "--quiet")
        text = self.compared("--scenario", "first/run.h5")
        self.assertNotIn("--set", text.replace("# --set method.name=euler", ""))
        self.write("stored.toml", text)
        self.hamflow("run", "stored.toml", "--out", "again", "--force", "--quiet")
        differs = [line for line in self.compared("first/run.h5", "again/run.h5").splitlines() if "differs" in line]
        self.assertIn(differs, ([], ["scenario differs"]), f"{settings}\n{text}")
        self.assertEqual(self.compared("--scenario", "again/run.h5"), text)
        first, again = (json.loads((self.folder / run / "summary.json").read_text()) for run in ("first", "again"))
        for summary in (first, again):
            for key in ("wall_seconds", "steps_per_second"):
                del summary[key]
        self.assertEqual(first, again)

    def test_a_rerun_has_the_same_bits(self):
        self.write("pendulum.toml", PENDULUM)
        self.write("eight.toml", EIGHT)
        for file, *settings in (
            ["kepler.toml"],
            ["pendulum.toml"],
            ["kepler.toml", "method.name=stv4"],  # which has no quadrature
            ["kepler.toml", "method.name=cg(1,6)", "method.tolerance=1e-12"],
            ["kepler.toml", "method.name=taylor(20)", "run.dt='1/7'", "run.steps=100"],
            ["kepler.toml", "run.dt=0.1", "run.t_end=4", "run.arithmetic=quad"],
            ["kepler.toml", "run.arithmetic=mp(40)", "run.dt='2*pi/100'", "run.steps=50"],
            ["kepler.toml", "problem.potential=hooke", "problem.k=0.3", "problem.initial={q=[1,0],p=[0,'0.7']}"],
            ["kepler.toml", "problem.orbit={kind='circle',r0=1.5}", "run.record=[0, 0.25, '1/3', 7]"],
            ["kepler.toml", "problem.orbit.direction=-1", "output.figures=[]", "run.checkpoint_every=1e2"],
            ["kepler.toml", "method.name=verlet", "run.arithmetic=lattice"],
            ["pendulum.toml", "problem.initial.q[1]=1.25", "problem.initial.p=[0.1, '-1/7']", "problem.angles=relative"],
            ["eight.toml", "run.steps=200", "problem.softening=0.01", "output.figures=[]", "run.record_every=7"],
            ["eight.toml", "run.steps=200", "problem.masses[2]=1.0000001", "output.figures=[]",
             "run.section={ coordinate = 'y1', direction = 0 }"],
        ):
            with self.subTest(file=file, settings=settings):
                self.assert_rerun(file, *settings)

    def test_a_stored_scenario_goes_on_with_its_run(self):
        """Settings of the file that a method set from outside replaced are none of the run's."""
        sets = ("--set", "method.name=stv4", "--set", "run.steps=1000")
        self.hamflow("run", "kepler.toml", *sets, "--out", "whole", "--quiet")
        self.hamflow("run", "kepler.toml", *sets, "--set", "run.steps=300", "--out", "part", "--quiet")
        self.write("stored.toml", self.compared("--scenario", "part/run.h5"))
        self.hamflow("run", "stored.toml", "--set", "run.steps=1000", "--out", "part", "--resume", "--quiet")
        self.assertNotIn("differs", self.compared("whole/run.h5", "part/run.h5"))

    def test_digits_go_on_with_their_run(self):
        for arithmetic in ("double-double", "quad", "mp(40)"):
            sets = ("--set", f"run.arithmetic={arithmetic}", "--set", "run.record_every=3", "--quiet", "--force")
            self.hamflow("run", "kepler.toml", "--set", "run.steps=100", "--out", "whole", *sets)
            self.hamflow("run", "kepler.toml", "--set", "run.steps=50", "--out", "part", *sets)
            self.hamflow("run", "kepler.toml", "--set", "run.steps=100", "--out", "part", *sets[:4], "--resume", "--quiet")
            self.assertNotIn("differs", self.compared("whole/run.h5", "part/run.h5"), arithmetic)

    def test_a_comment_is_no_setting(self):
        self.write("pendulum.toml", PENDULUM)
        self.hamflow("run", "pendulum.toml", "--quiet")
        self.assertEqual(self.compared("--scenario", "pendulum.run/run.h5"), PENDULUM)
        done = self.hamflow("convert", "pendulum.run", "--to", "relative", "-o", "relative.h5")
        self.assertEqual(done.stderr, "")
        self.assertIn('name = "cg"', self.compared("--scenario", "relative.h5"))

    def test_a_sweep_stores_what_its_members_share(self):
        self.hamflow("sweep", "kepler.toml", "--set", "method.name=stv4", "--set", "run.steps=20", "--vary",
                     "run.dt=0.01,0.02", "--quiet")
        self.write("stored.toml", self.compared("--scenario", "kepler.sweep/sweep.h5"))
        self.assertEqual(self.summary("stored.toml", "--set", "run.dt=0.02")["method"], "stv4")

    def test_a_session_stores_its_own_length(self):
        self.run_shell("step 30\nsave half\nmethod verlet\nstep 10\nsave steered\nquit\n")
        self.write("half.toml", self.compared("--scenario", "half/run.h5"))
        summary = self.summary("half.toml")
        saved = json.loads((self.folder / "half" / "summary.json").read_text())
        self.assertEqual((summary["steps"], summary["final"]), (30, saved["final"]))
        self.write("steered.toml", self.compared("--scenario", "steered/run.h5"))
        self.assertEqual(self.summary("steered.toml")["method"], "verlet")

    def run_shell(self, lines):
        done = subprocess.run([HAMFLOW, "shell", "kepler.toml", "--quiet"], cwd=self.folder, input=lines,
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_chunk_has_a_checksum(self):
        self.write("pendulum.toml", PENDULUM)
        self.hamflow("run", "kepler.toml", "--set", "method.diagnostics=true", "--set", "run.section={coordinate='x'}")
        self.assertEqual(self.compared("--unprotected", "kepler.run/run.h5"), "")
        self.hamflow("run", "pendulum.toml", "--set", "run.arithmetic=quad", "--set", "run.t_end=0.1")
        self.hamflow("convert", "pendulum.run", "--to", "relative", "-o", "relative.h5")
        self.hamflow("sweep", "kepler.toml", "--vary", "run.dt=0.01,0.02", "--vary", "method.name=verlet,stv4",
                     "--set", "run.steps=5", "--quiet")
        for file in ("pendulum.run/run.h5", "relative.h5", "kepler.sweep/sweep.h5"):
            self.assertEqual(self.compared("--unprotected", file), "")


if __name__ == "__main__":
    unittest.main()

"""step_control = "reversible": what a run with steps of varying size leaves, and what it is refused."""

import csv
import json
import math
import os
import pathlib
import sys
import unittest

from command import EXAMPLES, CommandCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from kill_and_resume import differences, kill_and_resume  # noqa: E402

COMPARE = os.environ["COMPARE_RUNS"]
REVERSIBLE = ("--set", "method={name='stv4', step_control='reversible'}")
DISTANCE = ("--set", "method={name='stv4', step_control='reversible', monitor='distance'}")
TYPED = ("--set", "problem={name='formula', coordinates=['x'], hamiltonian='(x^2 + 1)*(p_x^2 + 1)/2', "
                  "initial={q=[1], p=[0]}}")


class StepControl(CommandCase):
    def refused(self, *arguments, command="run"):
        """What is written for people, after a refusal that left nothing."""
        before = sorted(self.folder.iterdir())
        text = self.hamflow(command, "kepler.toml", *arguments, status=2).stderr
        self.assertEqual(sorted(self.folder.iterdir()), before)
        return text

    def test_time_is_a_part_of_the_state(self):
        self.hamflow("run", "kepler.toml", *DISTANCE, "--out", "r", "--set", "output.formats=['h5','csv']",
                     "--set", "run.record_every=1")
        with open(self.folder / "r" / "trajectory.csv") as file:
            rows = [dict(row) for row in csv.DictReader(file)]
        summary = json.loads((self.folder / "r" / "summary.json").read_text())
        t = [float(row["t"]) for row in rows]
        self.assertEqual(len(t), 401)
        self.assertEqual(t[:2], [0, 0.1])  # dt is the first step
        self.assertEqual(summary["final"]["t"], t[-1])
        self.assertEqual(summary["dt"], 0.1)
        self.assertEqual(summary["method"], "stv4(step_control=reversible,monitor=distance)")
        # From r = 1 steps go to 3^(3/2) of the first one; r after a step is that of a whole step, not of its middle.
        for a, b, row in zip(t, t[1:], rows):
            sigma = math.hypot(float(row["q1"]), float(row["q2"])) ** 1.5
            self.assertAlmostEqual((b - a) / 0.1 / sigma, 1, delta=0.35)
        self.assertGreater(max(b - a for a, b in zip(t, t[1:])), 0.45)
        self.assertEqual(summary["certificate"]["reversal_distance"]["proves"], "reversible to rounding")
        exact = summary["exact"]
        self.assertLess(exact["max_difference"], 0.05)  # the closed form at the run's own time

    def test_any_arithmetic(self):
        for arithmetic in ("compensated", "double-double", "quad", "mp(40)", "lattice"):
            with self.subTest(arithmetic=arithmetic):
                s = self.summary("kepler.toml", *REVERSIBLE, "--set", "run.steps=50",
                                 "--set", f"run.arithmetic='{arithmetic}'")
                double = self.summary("kepler.toml", *REVERSIBLE, "--set", "run.steps=50")
                self.assertAlmostEqual(float(s["final"]["t"]), double["final"]["t"], delta=1e-10)
                self.assertAlmostEqual(float(s["final"]["q"][0]), double["final"]["q"][0], delta=1e-10)

    def test_the_way_back(self):
        for arithmetic, bits in (("double", False), ("lattice", True)):
            with self.subTest(arithmetic=arithmetic):
                done = self.hamflow("reverse", "kepler.toml", *REVERSIBLE, "--json",
                                    "--set", f"run.arithmetic='{arithmetic}'")
                s = json.loads(done.stdout)
                self.assertEqual((s["expected_bit_exact"], s["bit_exact"]), (bits, bits))
                self.assertLess(s["relative_distance"], 1e-10)
                self.assertTrue(s["method_reversible"])

    def test_any_hamiltonian(self):
        for method in ("cg(2,auto,step_control=reversible)", "tao2(step_control=reversible)",
                       "gauss(2,step_control=reversible)"):
            with self.subTest(method=method):
                s = self.summary("kepler.toml", *TYPED, "--set", f"method.name='{method}'", "--set", "run.dt=0.01")
                self.assertLess(s["energy"]["max_relative_error"], 1e-13 if "cg" in method else 0.01)
                self.assertNotEqual(s["final"]["t"], 4.0)

    def test_centres_that_are_typed_or_polar(self):
        ends = []
        for problem in ("{name='central-force', potential='kepler', mass=2, initial={q=[1, 0], p=[0, 1.7]}}",
                        "{name='central-force', potential='formula', V='-1/r', mass=2, initial={q=[1, 0], p=[0, 1.7]}}",
                        "{name='central-force', potential='kepler', mass=2, coordinates='polar', "
                        "initial={q=[1, 0], p=[0, 1.7]}}"):
            s = self.summary("kepler.toml", "--set", f"problem={problem}", "--set", "run.dt=0.01",
                             "--set", "method={name='cg', degree=3, step_control='reversible', monitor='distance'}")
            ends.append(s["final"]["t"])
        self.assertAlmostEqual(ends[0], ends[1], delta=1e-11 * ends[0])
        self.assertAlmostEqual(ends[0], ends[2], delta=1e-3)  # another discretisation of the same motion

    def test_an_explicit_time(self):
        problem = ("problem={name='formula', coordinates=['x'], kinetic='p_x^2/2', potential='x^2/2 - x*cos(t)/10', "
                   "initial={q=[1], p=[0]}}")
        s = self.summary("kepler.toml", "--set", problem, *REVERSIBLE)
        self.assertLess(s["energy"]["max_relative_error"], 1e-3)  # of H - H(0) - int dH/dt

    def test_sections_and_observables(self):
        s = self.summary("kepler.toml", *DISTANCE, "--set", "run.section={coordinate='y'}",
                         "--set", "output.observables={r='sqrt(x^2 + y^2)'}")
        self.assertGreaterEqual(s["section"]["points"], 1)
        self.assertLess(s["section"]["max_residual"], 1e-13)
        self.assertTrue(1 < s["observables"]["r"]["mean"] < 3)

    def test_sweeps_and_figures(self):
        done = self.hamflow("sweep", "kepler.toml", *DISTANCE, "--vary", "run.dt=0.1,0.05", "--json", "--out", "none")
        rows = json.loads(done.stdout)["rows"]
        for row, dt in zip(rows, (0.1, 0.05)):
            one = self.summary("kepler.toml", *DISTANCE, "--set", f"run.dt={dt}")
            self.assertEqual(row["final"]["t"], one["final"]["t"])
            self.assertEqual(row["final"]["q"], one["final"]["q"])
        self.hamflow("run", "kepler.toml", *DISTANCE, "--out", "r")
        self.hamflow("plot", "r", "--kind", "time", "-o", "time.svg")
        self.assertIn("step_control=reversible", (self.folder / "time.svg").read_text())

    def test_more_steps_and_kills(self):
        set_it = [*DISTANCE, "--set", "run.dt=0.01", "--set", "run.checkpoint_every=501"]
        self.hamflow("run", "kepler.toml", *set_it, "--out", "part")
        self.hamflow("run", "kepler.toml", *set_it, "--out", "part", "--resume", "--set", "run.steps=900")
        self.hamflow("run", "kepler.toml", *set_it, "--out", "whole", "--set", "run.steps=900")
        a, b = (json.loads((self.folder / name / "summary.json").read_text()) for name in ("part", "whole"))
        self.assertEqual((a["final"], a["energy"], a["certificate"]), (b["final"], b["energy"], b["certificate"]))
        self.refused(*REVERSIBLE, "--set", "run.dt=0.01", "--out", "part", "--resume", "--set", "run.steps=900")
        room = self.folder / "kills"
        room.mkdir()
        killed, _, compared, wrong = kill_and_resume(
            os.environ["HAMFLOW"], COMPARE, self.folder / "kepler.toml",
            [DISTANCE[1], "run.dt=0.01", "run.steps=60000", "run.checkpoint_every=7001"], 3, 1, room, say=lambda text: None)
        self.assertEqual((killed, wrong), (3, []))
        self.assertGreater(compared, 0)

    def test_refusals(self):
        for arguments, words in (
            (("--set", "run.t_end=40"), ("run.t_end", "allowed steps", "steps of varying size")),
            (("--set", "run.record=[0, 1]"), ("run.record", "allowed record_every")),
            (("--set", "run.lyapunov=true"), ("run.lyapunov", "step_control = \"fixed\"")),
            (("--set", "run.eigenvalues=true"), ("run.eigenvalues", "not differentiated")),
            (("--set", "run.threads=2"), ("run.threads", "allowed 1")),
            (("--set", "method.step_control='reversibel'"), ("did you mean reversible",)),
            (("--set", "method.monitor='distanse'"), ("did you mean distance",)),
        ):
            with self.subTest(arguments=arguments):
                text = self.refused(*REVERSIBLE, *arguments)
                for word in words:
                    self.assertIn(word, text)
        for method, words in (("euler-a(step_control=reversible)", ("not symmetric", "allowed fixed")),
                              ("rk4(step_control=reversible)", ("not symmetric",)),
                              ("itoh-abe(step_control=reversible)", ("not symmetric",)),
                              ("dop853(step_control=reversible)", ("allowed adaptive, fixed",)),
                              ("taylor(step_control=reversible)", ("allowed adaptive, fixed",)),
                              ("cg(1,5,diagnostics=true,step_control=reversible)", ("diagnostics",))):
            with self.subTest(method=method):
                text = self.refused("--set", f"method.name='{method}'")
                for word in words:
                    self.assertIn(word, text)
                self.assertEqual(len(text.strip().splitlines()), 1, text)
        self.assertIn("allowed arclength", self.refused(*TYPED, "--set", "method.name='cg(1,5,step_control=reversible,monitor=distance)'"))
        self.assertIn("allowed step_control=fixed", self.refused("--methods", "verlet(step_control=reversible)", command="compare"))
        self.assertIn("allowed step_control=fixed", self.hamflow("verify", "verlet(step_control=reversible)", status=2).stderr)
        self.assertIn("--set method.step_control=fixed", self.refused(*DISTANCE, "--methods", "verlet", command="compare"))
        # Any method may be told to take equal steps, which follow no monitor.
        s = self.summary("kepler.toml", *DISTANCE, "--set", "method.step_control='fixed'")
        self.assertEqual(s["final"], self.summary("kepler.toml", "--set", "method.name='stv4'")["final"])
        for method in ("euler", "rk4", "verlet", "cg(1,5)"):
            name = method.split("(")[0]
            s = self.summary("kepler.toml", "--set", f"method={{name='{name}', step_control='fixed'}}", "--set", "run.steps=3")
            self.assertAlmostEqual(s["final"]["t"], 0.3)

    def test_a_monitor_that_the_problem_has_not_is_told_at_its_key(self):
        done = self.hamflow("run", str(EXAMPLES / "t_tube.toml"), "--out", "none", "--set", "method.step_control=reversible",
                            "--set", "method.monitor=distance", "--set", "problem.wall_rule=soft", status=2)
        self.assertIn('--set: error: method.monitor: found "distance" for t-tube', done.stderr)
        self.assertNotIn("method.name", done.stderr)

    def test_a_monitor_that_nothing_follows(self):
        for arguments in (("--set", "method={name='stv4', monitor='distance'}"), ("--set", "method.name='stv4(monitor=distance)'"),
                          ("--set", "method={name='stv4', step_control='fixed', monitor='arclength'}", "--set", "run.steps=3")):
            if "step_control" in arguments[1]:
                self.assertIn("note: method.monitor", self.hamflow("run", "kepler.toml", *arguments, "--out", "none").stderr)
            else:
                self.assertIn('allowed with step_control = "reversible"', self.refused(*arguments))
        for words in (("verify", "verlet(monitor=distance)"), ("compare", "kepler.toml", "--methods", "verlet(monitor=distance)")):
            self.assertIn('allowed with step_control = "reversible"', self.hamflow(*words, status=2).stderr)
        # One of the file gives way to equal steps that are asked for, in what is kept, too.
        text = (self.folder / "kepler.toml").read_text().replace('name = "cg"\nquadrature = 5', 'name = "stv4"\n'
                                                                 'step_control = "reversible"\nmonitor = "distance"')
        self.write("varying.toml", text)
        for fixed in ("method.step_control=fixed", "method.name='verlet(step_control=fixed)'"):
            told = self.hamflow("run", "varying.toml", "--set", fixed, "--out", "r", "--force").stderr
            self.assertIn("note: method.monitor is not used", told)
            self.hamflow("plot", "r", "--kind", "energy", "-o", "f.svg")  # reads the scenario that it kept
        self.write("varying.toml", text.replace('"reversible"', '"fixed"'))
        self.assertIn("varying.toml", self.hamflow("run", "varying.toml", "--out", "none", status=2).stderr)

    def test_a_density_that_fails(self):
        done = self.hamflow("run", "kepler.toml", *DISTANCE, "--set", "run.dt=20", "--out", "none", "--json", status=1)
        error = json.loads(done.stdout)["error"]
        self.assertEqual(error["kind"], "not_converged")
        self.assertIn("density of steps", error["message"])
        self.assertEqual(error["hint"], "try a smaller dt")
        eccentric = ("--set", "problem.orbit={ kind='ellipse', r_per=0.1, r_aph=1.9 }", "--set", "problem.mass=1", "--set",
                     "method={ name='gauss(3)', step_control='reversible' }", "--set", "run.dt=0.02", "--set", "run.steps=100",
                     "--out", "none", "--json")
        error = json.loads(self.hamflow("run", "kepler.toml", *eccentric, status=1).stdout)["error"]
        self.assertIn("density of steps", error["message"])
        self.assertEqual(error["hint"].split(";")[0],
                         'if the density of steps failed, try a smaller dt or method.monitor = "distance"')
        self.hamflow("run", "kepler.toml", *eccentric, "--set", "method.monitor=distance")


if __name__ == "__main__":
    unittest.main()

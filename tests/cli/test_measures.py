"""What is measured beside a run: Lyapunov exponents, eigenvalues of the steps' derivative, Poincare sections."""

import json
import math
import unittest

from command import EXAMPLES, CommandCase

CHAOS = """
[problem]
name = "henon-heiles"
initial = { q = [0, -0.15], p = [0.54, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 20000
[output]
formats = ["h5", "csv"]
"""
ALL = ("--set", "run.lyapunov=true", "--set", "run.eigenvalues=true", "--set", "run.section={coordinate='q1'}")


class Measures(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("chaos.toml", CHAOS)

    def summary(self, *arguments):
        return json.loads(self.hamflow("run", "chaos.toml", "--json", *arguments).stdout)

    def test_the_trajectory_keeps_its_bits(self):
        alone = self.summary("--out", "alone")
        watched = self.summary("--out", "watched", *ALL)
        self.assertEqual(alone["final"], watched["final"])
        self.assertEqual(alone["energy"], watched["energy"])
        self.assertEqual(alone["evaluations"], watched["evaluations"])
        texts = [(self.folder / name / "trajectory.csv").read_bytes() for name in ("alone", "watched")]
        self.assertEqual(*texts)

    def test_exponents(self):
        found = self.summary("--out", "none", "--set", "run.lyapunov=true")["lyapunov"]
        self.assertEqual([len(found[key]) for key in ("exponents", "standard_errors", "pair_sums")], [4, 4, 2])
        self.assertAlmostEqual(found["time"], 2000, delta=1e-9)
        largest = found["exponents"][0]
        self.assertGreater(largest, 0.05)
        self.assertGreater(largest, 4 * found["standard_errors"][0])
        self.assertLess(max(map(abs, found["pair_sums"])), 1e-12)
        one = self.summary("--out", "none", "--set", "run.lyapunov=1")["lyapunov"]
        self.assertEqual(len(one["exponents"]), 1)
        self.assertEqual(one["pair_sums"], [])
        self.assertIn("Lyapunov exponents", self.hamflow("run", "chaos.toml", "--out", "none", *ALL).stdout)

    def test_a_sticky_orbit_is_undecided(self):
        """Over 3e6 steps its exponent is 0.115."""
        sticky = ("--out", "none", "--set", "run.lyapunov=1", "--set", "run.steps=50000", "--set",
                  'problem.initial={ q = [0, 0.075], p = ["+", 0.0232], energy = 0.165667 }')
        found = self.summary(*sticky)["lyapunov"]
        self.assertEqual(found["verdict"], "undecided")
        self.assertIn("undecided", self.hamflow("run", "chaos.toml", *sticky).stdout)
        regular = self.summary("--out", "none", "--set", "run.lyapunov=1", "--set",
                               "problem.initial={ q = [0.1, 0.1], p = [0.1, 0.1] }")["lyapunov"]
        self.assertEqual(regular["verdict"], "undecided")

    def test_a_map_is_iterated_by_hand(self):
        """The standard map: sections and exponents by steps, and nothing that compares it with a flow."""
        scenario = str(EXAMPLES / "standard_map.toml")
        chaotic = json.loads(self.hamflow("run", scenario, "--json", "--out", "none").stdout)["lyapunov"]
        self.assertEqual(chaotic["verdict"], "steady")
        self.assertGreater(chaotic["exponents"][0], 5 * chaotic["standard_errors"][0])
        self.assertAlmostEqual(chaotic["exponents"][0], 0.2, delta=0.05)
        island = ("--set", "problem.initial={ q = [3], p = [0.4] }")  # where rounding does not decide the orbit
        arguments = ("--json", "--set", "run.steps=1000", "--out", "map", *island)
        found = json.loads(self.hamflow("run", scenario, *arguments).stdout)
        q, p, tangent, growth = 3.0, 0.4, (1.0, 0.0), 0.0
        for _ in range(1000):
            slope = 1.2 * math.cos(q)
            p += 1.2 * math.sin(q)
            q += p
            dp = tangent[1] + slope * tangent[0]
            tangent = (tangent[0] + dp, dp)
            length = math.hypot(*tangent)
            growth += math.log(length)
            tangent = (tangent[0] / length, tangent[1] / length)
            if _ == 9:
                ten = (q, p)
        few = json.loads(self.hamflow("run", scenario, "--json", "--set", "run.steps=10", "--out", "few",
                                      *island).stdout)
        self.assertAlmostEqual(few["final"]["q"][0], ten[0], delta=1e-10)
        self.assertAlmostEqual(few["final"]["p"][0], ten[1], delta=1e-10)
        self.assertEqual(found["section"], {"points": 1000, "max_residual": 0})
        self.assertEqual(found["lyapunov"]["time"], 1000)
        self.assertAlmostEqual(found["lyapunov"]["exponents"][0], growth / 1000, delta=0.05)
        self.assertIsNone(found["certificate"])
        self.assertIsNone(found["energy"]["scale"])
        self.assertEqual(found["warnings"], [])
        half = json.loads(self.hamflow("run", scenario, "--json", "--set", "run.steps=1000", "--set", "run.dt=0.5",
                                       "--out", "half").stdout)
        self.assertEqual(half["lyapunov"]["time"], 1000)
        said = self.hamflow("run", scenario, "--set", "run.record=[0, 0.5]", "--out", "none", status=2).stderr
        self.assertIn("a map has no states between its steps", said)
        self.hamflow("sweep", scenario, "--set", "run.steps=100", "--vary", "problem.initial.p[0]=0.1,0.2,0.3,0.4",
                     "--out", "s", "--quiet")
        self.hamflow("reverse", scenario, "--set", "run.steps=100", "--set", "method.name=verlet")

    def test_eigenvalues_of_an_oscillator(self):
        self.write("chaos.toml", '[problem]\nname = "harmonic"\ninitial = { q = [1], p = [0] }\n'
                   '[method]\nname = "verlet"\n[run]\ndt = 0.1\nsteps = 100\neigenvalues = true\n')
        found = self.summary("--out", "none")["eigenvalues"]
        self.assertEqual(found["steps"], 100)
        angle = 100 * math.acos(1 - 0.1**2 / 2)
        for real, imaginary in found["values"]:
            self.assertAlmostEqual(real, math.cos(angle), delta=1e-11)
            self.assertAlmostEqual(abs(imaginary), abs(math.sin(angle)), delta=1e-11)
        self.assertLess(found["pair_defect"], 1e-12)
        self.assertLess(found["symplectic_defect"], 1e-12)

    def test_section(self):
        section = "run.section={ coordinate = 'q1', value = 0.1, direction = 0 }"
        found = self.summary("--set", section)["section"]
        self.assertGreater(found["points"], 400)
        self.assertLess(found["max_residual"], 1e-15)
        up = self.summary("--out", "up", "--set", section.replace("= 0 }", "= 1 }"))["section"]
        down = self.summary("--out", "down", "--set", section.replace("= 0 }", "= -1 }"))["section"]
        self.assertEqual(up["points"] + down["points"], found["points"])
        self.hamflow("plot", "chaos.run", "--kind", "section", "-o", "section.svg")
        self.assertIn("<svg", (self.folder / "section.svg").read_text())
        self.hamflow("run", "chaos.toml", "--out", "alone")
        self.assertIn("run.section", self.hamflow("plot", "alone", "--kind", "section", "-o", "s.svg", status=2).stderr)

    def test_section_of_bodies(self):
        """Bodies are named x1, y1, ..., p_x1, ...; by number they are q1, ..., p1, ..., as in any system of any size."""
        eight = EXAMPLES / "figure_eight.toml"
        for by_body, by_number in (("y2", "q4"), ("p_x3", "p5")):
            found = [json.loads(self.hamflow("run", eight, "--out", "none", "--json", "--set", "run.steps=500", "--set",
                                             f"run.section={{ coordinate = '{name}', direction = 0 }}").stdout)["section"]
                     for name in (by_body, by_number)]
            self.assertGreater(found[0]["points"], 0)
            self.assertEqual(found[0], found[1])

    def test_refusals(self):
        def refused(key, *arguments):
            text = self.hamflow("run", "chaos.toml", "--out", "none", *arguments, status=2).stderr
            self.assertIn(f"error: {key}: found", text)
            return text

        for key, value in (("lyapunov", "true"), ("lyapunov", "2"), ("eigenvalues", "true")):
            for arithmetic in ("lattice", "compensated", "quad"):
                text = refused(f"run.{key}", "--set", f"run.{key}={value}", "--set", f"run.arithmetic='{arithmetic}'")
                self.assertIn("allowed with arithmetic = \"double\"", text)
        self.assertIn("1 to 4, or true, false", refused("run.lyapunov", "--set", "run.lyapunov=5"))
        refused("run.lyapunov", "--set", "run.lyapunov=0")
        refused("run.eigenvalues", "--set", "run.eigenvalues=1")
        self.assertIn("q1, q2, p1, p2", refused("run.section.coordinate", "--set", "run.section={value=1}"))
        self.assertIn("did you mean", refused("run.section.coordinate", "--set", "run.section={coordinate='q3'}"))
        refused("run.section.direction", "--set", "run.section={coordinate='q1', direction=2}")
        refused("output.figures", "--set", "output.figures=['section']")

    def test_columns_of_a_sweep(self):
        def rows(*arguments):
            done = self.hamflow("sweep", "chaos.toml", "--vary", "problem.initial.p[1]=0.1,0.12", "--out", "none", "--json",
                                "--set", "run.steps=500", *arguments)
            return json.loads(done.stdout)["rows"]

        # What a method carries from step to step, an iteration's start or a step size of its own, is the run's too.
        for method in ("stv4", "cg(1,5)", "dop853", "rk4"):
            for count in ("1", "true"):
                sets = ("--set", f"run.lyapunov={count}", "--set", f"method.name={method}")
                for row, p2 in zip(rows(*sets), (0.1, 0.12), strict=True):
                    single = self.summary("--out", "none", "--set", "run.steps=500", *sets,
                                          "--set", f"problem.initial.p[1]={p2}")
                    exponents = single["lyapunov"]["exponents"]
                    self.assertEqual(len(exponents), 1 if count == "1" else 4)
                    self.assertEqual([row[f"lyapunov{i + 1}"] for i in range(len(exponents))], exponents,
                                     (method, count, p2))
        whole = rows("--set", "run.lyapunov=true")
        self.assertEqual([f"lyapunov{i}" in whole[0] for i in (1, 4, 5)], [True, True, False])
        self.assertAlmostEqual(whole[0]["lyapunov1"] + whole[0]["lyapunov4"], 0, delta=1e-12)

    def test_eigenvalues_in_sweeps(self):
        done = self.hamflow("sweep", "chaos.toml", "--vary", "problem.initial.p[1]=0.08:0.12:5", "--out", "none", "--json",
                            "--set", "run.steps=500", "--set", "run.eigenvalues=true")
        summary = json.loads(done.stdout)
        self.assertEqual(summary["members_in_lanes"], 5)
        for row in summary["rows"]:
            single = self.summary("--out", "none", "--set", "run.steps=500", "--set", "run.eigenvalues=true", "--set",
                                  f"problem.initial.p[1]={row['problem.initial.p[1]']!r}")["eigenvalues"]
            self.assertEqual([[row[f"eigenvalue{i}_re"], row[f"eigenvalue{i}_im"]] for i in range(1, 5)],
                             single["values"])
            for key in ("pair_defect", "symplectic_defect", "norm"):
                self.assertEqual(row[f"eigenvalues_{key}"], single[key])

    def test_members_whose_steps_cannot_be_differentiated_in_lanes(self):
        """A step with |x| is recorded, but its program has no derivative: vectors go the way that they go in a run."""
        self.write("chaos.toml", """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + x^2*abs(x) + y^2 + k*x*y"
parameters = { k = 0.3 }
initial = { q = [0.5, 0.2], p = [0.3, -0.1] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 300
lyapunov = true
""")
        done = self.hamflow("sweep", "chaos.toml", "--vary", "problem.parameters.k=0.2,0.3,0.4", "--out", "none", "--json")
        summary = json.loads(done.stdout)
        self.assertEqual(summary["members_in_lanes"], 3)
        for row in summary["rows"]:
            single = self.summary("--out", "none", "--set", f"problem.parameters.k={row['problem.parameters.k']}")["lyapunov"]["exponents"]
            self.assertEqual([row[f"lyapunov{i}"] for i in range(1, 5)], single)

    def test_converted_runs_have_no_section(self):
        sets = ("--set", "run.section={coordinate='y'}", "--set", "output.figures=['section', 'orbit']")
        self.hamflow("run", "kepler.toml", *sets)
        self.assertNotIn("section", self.hamflow("convert", "kepler.toml", "--to", "polar", *sets).stdout)
        self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "polar.h5")
        self.hamflow("plot", "polar.h5", "-o", "orbit.svg")
        self.hamflow("plot", "polar.h5", "--kind", "section", "-o", "section.svg", status=2)

    def test_runs_that_end_before_their_last_step(self):
        """What is due later is brought up to the end: exponents and eigenvalues are those of all steps that were taken."""
        measured = ("--out", "none", "--set", "run.lyapunov=1", "--set", "run.eigenvalues=true")
        for event in ("q1", "t - 1.73"):
            found = self.summary(*measured, "--set", f"run.events=[{{ expression='{event}', action='stop' }}]", "--set",
                                 "problem.initial.q[0]=0.1")
            steps = found["steps"]
            self.assertLess(steps, 100)
            whole = self.summary(*measured, "--set", f"run.steps={steps}", "--set", "problem.initial.q[0]=0.1")
            for key in ("lyapunov", "eigenvalues"):
                self.assertEqual(found[key], whole[key], event)
            self.assertEqual(found["eigenvalues"]["steps"], steps)
            self.assertAlmostEqual(found["lyapunov"]["time"], steps * 0.1, delta=1e-12)
            done = self.hamflow("sweep", "chaos.toml", *measured, "--json", "--set", f"run.events=[{{ expression='{event}', action='stop' }}]",
                                "--vary", "problem.initial.q[0]=0.1,0.2")
            row = json.loads(done.stdout)["rows"][0]
            self.assertEqual(row["steps"], steps)
            self.assertEqual(row["lyapunov1"], whole["lyapunov"]["exponents"][0])
            self.assertEqual([[row[f"eigenvalue{i}_re"], row[f"eigenvalue{i}_im"]] for i in range(1, 5)],
                             whole["eigenvalues"]["values"])

    def test_a_run_that_fails_has_those_of_its_steps(self):
        escape = ("--set", "problem.initial.p[1]=2", "--set", "method.name=verlet")
        measured = ("--out", "none", "--json", "--set", "run.eigenvalues=true")
        failed = json.loads(self.hamflow("run", "chaos.toml", *escape, *measured, status=1).stdout)
        whole = self.summary(*escape, *measured, "--set", f"run.steps={failed['steps']}")
        self.assertGreater(failed["steps"], 1)
        self.assertEqual(failed["eigenvalues"], whole["eigenvalues"])

    def test_points_are_counted_in_the_text(self):
        for steps, words in ((1, "0 points\n"), (40, "1 point, residual at most ")):
            done = self.hamflow("run", "chaos.toml", "--out", "none", "--set", "run.section={coordinate='q1'}", "--set",
                                f"run.steps={steps}", "--set", "problem.initial.q[0]=-0.1")
            self.assertIn("section             " + words, done.stdout)

    def test_resumed(self):
        self.summary("--set", "run.steps=10000", *ALL)
        found = self.summary("--resume", *ALL)
        whole = self.summary("--out", "whole", *ALL)
        for key in ("lyapunov", "eigenvalues", "section"):
            self.assertEqual(found[key], whole[key])


if __name__ == "__main__":
    unittest.main()

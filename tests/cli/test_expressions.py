"""Expressions on the state of any problem: sections, observables, varied values."""

import csv
import json
import math
import re
import unittest

import h5py

from test_formula import FormulaCase


class Expressions(FormulaCase):
    def test_sections_on_expressions(self):
        by_name = self.summary("b.toml", "--set", "run.section={ coordinate = 'q1', value = 0.05 }")
        typed = self.summary("b.toml", "--set", "run.section={ expression = 'q1 - 0.05' }")
        self.assertEqual(typed["section"]["points"], by_name["section"]["points"])
        self.assertGreater(typed["section"]["points"], 1)
        self.hamflow("run", "f.toml", "--set", "run.section={ expression = 'x*p_y - y*p_x', direction = 0 }", "--set",
                     "run.steps=2000", "--set", 'output.figures=["section"]', "--out", "s.run", "--quiet")
        with h5py.File(self.folder / "s.run/run.h5") as file:
            q, p = file["section/q"][()], file["section/p"][()]
        self.assertGreater(len(q), 10)
        for (x, y), (p_x, p_y) in zip(q, p, strict=True):
            self.assertAlmostEqual(x * p_y - y * p_x, 0, delta=1e-15)

    def test_jumps_and_poles_are_no_points(self):
        self.write("o.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + x^2/2"
initial = { q = [2], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 400
section = { expression = "x", direction = 0 }
""")
        zeros = self.summary("o.toml")["section"]["points"]
        self.assertEqual(zeros, 13)  # of cos(t) up to t = 40
        for jumping in ["1/x", "x/abs(x)"]:
            found = self.summary("o.toml", "--set", f'run.section={{expression="{jumping}",direction=0}}')["section"]
            self.assertEqual(found["points"], 0, jumping)
            self.assertEqual(found["message"], "13 changes of sign were not zeros: the expression jumps or has a pole there")
        found = self.summary("o.toml", "--set", 'run.section={expression="tan(x)",direction=0}')["section"]
        self.assertEqual(found["points"], zeros)
        self.assertLess(found["max_residual"], 1e-14)
        self.assertIn("not zeros", found["message"])

    def test_zeros_beside_the_edge_of_a_domain(self):
        """sqrt(x) - 0.1 has the zeros of x - 0.01, though steps of 0.1 begin and end below 0, where it has no value."""
        self.write("o.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + x^2/2"
initial = { q = [2], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 400
""")
        for direction in (-1, 0, 1):
            for root, plain in (("sqrt(x)-0.1", "x-0.01"), ("0.1-sqrt(x)", "0.01-x"), ("log(x+1.9)+5", "x+1.9-exp(-5)")):
                def points(text, *more):
                    return self.summary("o.toml", "--set", f"run.section={{expression='{text}',direction={direction}}}", *more)

                found = points(root)["section"]
                self.assertEqual(found["points"], points(plain)["section"]["points"], (root, direction))
                self.assertGreater(found["points"], 5)
                self.assertNotIn("message", found)
                self.assertLess(found["max_residual"], 1e-13)
            events = [self.summary("o.toml", "--set", f"run.events=[{{expression='{text}',direction={direction}}}]")
                      for text in ("sqrt(x)-0.1", "x-0.01")]
            self.assertEqual(events[0]["events"], events[1]["events"])
            self.assertNotIn("event_notes", events[0])
        # In lanes as alone, to the bit.
        found = []
        for lanes in ("none", "auto"):
            done = self.hamflow("sweep", "o.toml", "--set", "run.section={expression='sqrt(x)-0.1',direction=0}", "--vary",
                                "problem.initial.q[0]=1:2:20", "--lanes", lanes, "--out", "none", "--json", "--quiet")
            found.append([row["section"] for row in json.loads(done.stdout)["rows"]])
        self.assertEqual(found[0], found[1])
        self.assertEqual({one["points"] for one in found[0]}, {13})

    def test_a_section_of_a_run_that_fails(self):
        """The partial step fails at the first look, before there is any state."""
        self.write("l.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + sqrt(x^2) + log(x)"
initial = { q = [0.890625], p = [0] }
[method]
name = "rk4"
[run]
dt = 0.02
steps = 100
section = { coordinate = "p_x", direction = 0 }
""")
        done = self.hamflow("run", "l.toml", "--out", "none", "--json", "--quiet", status=1)
        self.assertEqual(json.loads(done.stdout)["status"], "failed")
        self.assertIn("a partial step failed", json.loads(done.stdout)["section"]["message"])

    def test_wrong_sections(self):
        for section, words in (
            ("{ expression = 'q1 - q3' }", "column 6: the unknown"),
            ("{ expression = '2 + lambda' }", "which is the same for every state"),
            ("{ expression = 'q1', coordinate = 'q1' }", "found coordinate and expression together; allowed one of them"),
            ("{ value = 1 }", "found neither coordinate nor expression; allowed one of them"),
            ("{ expression = 'q1 +' }", "column 5: a number is missing before the end"),
        ):
            text = self.hamflow("run", "b.toml", "--set", f"run.section={section}", "--out", "none", status=2).stderr
            self.assertIn(words, text, section)

    def test_an_event_that_never_changes(self):
        done = self.hamflow("run", "b.toml", "--set", "run.events=[{ expression = '2*3' }]", "--out", "none", status=2)
        self.assertIn("run.events[0].expression: found", done.stderr)
        self.assertIn("which is the same for every state", done.stderr)

    def test_of_two_events_in_a_step_the_first_ends_the_run(self):
        """Whichever way the time runs, and in whatever order they stand in the file."""
        self.write("o.toml", "[problem]\nname='harmonic'\ninitial={q=[1],p=[0]}\n[method]\nname='verlet'\n[run]\ndt=0.3\nsteps=20\n")
        events = ["{ name = 'later', expression = 'q - 0.85', direction = 0, action = 'stop' }",
                  "{ name = 'first', expression = 'q - 0.9', direction = 0, action = 'stop' }"]
        for order in (events, events[::-1]):
            for dt in ("0.3", "-0.3"):
                done = self.summary("o.toml", "--set", f"run.dt={dt}", "--set", f"run.events=[{', '.join(order)}]")
                self.assertEqual(done["stopped_by"]["event"], "first", (order, dt))
                self.assertAlmostEqual(done["stopped_by"]["q"][0], 0.9, delta=1e-14)

    OBSERVE = ["--set", "output.observables={ theta = 'atan2(q2, q1)', l = 'lambda*t' }"]

    def test_observables(self):
        self.hamflow("run", "b.toml", *self.OBSERVE, "--set", "run.record_every=1", "--set", 'output.formats=["h5","csv"]',
                     "--out", "o.run", "--quiet")
        with open(self.folder / "o.run/trajectory.csv") as file:
            rows = list(csv.DictReader(file))
        theta = [float(row["theta"]) for row in rows]
        for row, x in zip(rows, theta, strict=True):
            self.assertAlmostEqual(x, math.atan2(float(row["q2"]), float(row["q1"])), delta=1e-15)
            self.assertEqual(float(row["l"]), float(row["t"]))
        found = json.loads((self.folder / "o.run/summary.json").read_text())["observables"]
        self.assertEqual((found["theta"]["initial"], found["theta"]["final"]), (theta[0], theta[-1]))
        self.assertAlmostEqual(found["theta"]["mean"], math.fsum(theta[1:]) / (len(theta) - 1), delta=1e-15)
        # Over every step, however few are recorded.
        few = self.summary("b.toml", *self.OBSERVE, "--set", "run.record_every=100")["observables"]
        self.assertEqual(few, found)
        self.hamflow("plot", "o.run", "--kind", "time", "--y", "theta,l", "-o", "theta.svg")
        self.hamflow("plot", "o.run", "--kind", "phase", "--x", "theta", "--y", "q1", "-o", "theta.svg")
        with h5py.File(self.folder / "o.run/run.h5") as file:
            self.assertEqual(file["observables/theta"][()].tolist(), theta)
            self.assertEqual(file["observables/theta"].attrs["meaning"].decode(), "atan2(q2, q1)")

    def test_observables_that_are_no_numbers(self):
        infinite = ("--set", "output.observables={ r = '1/t', l = 'log(q1 - 9)' }", "--set",
                    'output.formats=["csv"]')
        text = self.hamflow("run", "b.toml", *infinite, "--out", "i.run").stdout
        self.assertIn("r not finite -> ", text)  # inf in the file, null in the summary
        self.assertIn("l not finite -> not finite, mean not finite", text)
        self.assertIn(",inf,nan\n", (self.folder / "i.run/trajectory.csv").read_text())
        self.hamflow("sweep", "b.toml", *infinite, "--vary", "problem.lambda=0.5,1", "--out", "i.sweep")
        for file in ("i.run/trajectory.csv", "i.sweep/sweep.csv"):
            self.assertIn(",nan", (self.folder / file).read_text())
            self.assertNotIn("-nan", (self.folder / file).read_text())

    def test_observables_in_sweeps(self):
        out = self.hamflow("sweep", "b.toml", *self.OBSERVE, "--vary", "problem.lambda=0.5,1", "--out", "none", "--json",
                           "--quiet").stdout
        one = self.summary("b.toml", *self.OBSERVE, "--set", "problem.lambda=0.5")["observables"]
        row = json.loads(out)["rows"][0]
        for name in ("theta", "l"):
            for what in ("initial", "mean", "final"):
                self.assertEqual(row[f"{name}_{what}"], one[name][what])

    def test_wrong_observables(self):
        for value, words in (
            ("{ theta = 'atan2(q2)' }", "output.observables.theta: found"),
            ("{ theta = 'q4' }", "did you mean"),
            ("{ theta = 1 }", "allowed a non-empty text"),
            ("{ q1 = 'q2' }", "found the name q1, which every run uses for a column"),
            ("{ 'a/b' = 'q2' }", "allowed letters, digits and _"),
        ):
            text = self.hamflow("run", "b.toml", "--set", f"output.observables={value}", "--out", "none", status=2).stderr
            self.assertIn(words, text, value)
        # trajectory.csv calls its columns so, whatever the names of the coordinates are.
        for name in ("q1", "p2"):
            text = self.hamflow("run", "kepler.toml", "--set", f"output.observables={{ {name} = 'x' }}", "--out", "none", status=2)
            self.assertIn(f"found the name {name}, which every run uses for a column", text.stderr)

    def test_a_varied_value_that_is_a_long_sum(self):
        for formula, status in (("sum(i,1,1000,i/1000*problem.lambda)", 0), ("sum(i,1,60000,i*problem.lambda)", 2),
                                ("sum(i,1,1,0)" + "-problem.lambda" * 3000, 0)):
            done = self.hamflow("sweep", "b.toml", "--vary", "problem.lambda=0.5,1", "--vary", f"problem.initial.q[0]=({formula})/1e5",
                                "--set", "run.steps=1", "--out", "none", status=status)
            if status == 2:
                self.assertIn("too long", done.stderr)

    def test_let_and_sum_in_varied_values(self):
        rows = json.loads(self.hamflow("sweep", "b.toml", "--vary", "problem.lambda=0.5,1", "--vary",
                                       "run.dt=let u = problem.lambda/10 in sum(i, 1, 3, u^i)", "--out", "none", "--json",
                                       "--quiet").stdout)["rows"]
        for row in rows:
            u = row["problem.lambda"] / 10
            self.assertAlmostEqual(row["run.dt"], u + u**2 + u**3, delta=1e-16)


if __name__ == "__main__":
    unittest.main()

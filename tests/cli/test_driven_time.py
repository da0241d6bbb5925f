"""H(q, p, t) late in long runs: the time within a step is n dt and what has passed since, whatever a run does beside its
steps. x'' = cos t from rest at 0 has p = sin t and x = 1 - cos t."""

import json
import math
import unittest

from command import CommandCase

DRIVEN = """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 - x*cos(w*t)"
parameters = { w = 1 }
initial = { q = [0], p = [0] }
[method]
name = "kahan-li8"
[run]
dt = 0.1
steps = 100000
"""
# y bounces between walls, which cut steps into parts; x knows nothing of them.
WALLED = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 - x*cos(t)"
initial = { q = [0, 0.2], p = [0, 0.7] }
walls = [{ coordinate = "y", min = -1, max = 1 }]
[method]
name = "kahan-li8"
[run]
dt = 0.1
steps = 100000
"""


class DrivenTime(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("driven.toml", DRIVEN)
        self.write("walled.toml", WALLED)

    def run_of(self, *settings, scenario="driven.toml"):
        arguments = [part for setting in settings for part in ("--set", setting)]
        summary = self.summary(scenario, *arguments)
        self.assertEqual(summary["status"], "done", settings)
        return summary

    def miss(self, *settings, scenario="driven.toml"):
        """|p_x - sin t| at the end, of the time as it is told."""
        final = self.run_of(*settings, scenario=scenario)["final"]
        return abs(final["p"][0] - math.sin(final["t"]))

    def test_elements_of_any_quadrature_go_on(self):
        """A time of 2000 rounds by more than the last digits of what happens within one step."""
        for method in ("cg", "cg(2)", "cg(3)", "itoh-abe"):
            for dt in ("0.3333333333333333", "-0.33"):
                with self.subTest(method=method, dt=dt):
                    found = self.run_of(f"method.name='{method}'", f"run.dt={dt}", "run.steps=10000")
                    self.assertEqual(found["steps"], 10000)
                    self.assertLess(found["newton"]["mean"], 3.5)
                    self.assertLess(found["energy"]["max_error"], 1e-9 if method == "itoh-abe" else 3e-12)
        self.assertLess(self.miss("method.name='cg(3)'", "run.dt=0.3333333333333333", "run.steps=20000"), 1e-11)

    def test_members_in_lanes(self):
        """They are right, and have the bits of single runs."""
        for method in ("kahan-li8", "rk4"):
            for dt in ("0.01", "-0.0078125"):
                arguments = ("--set", f"method.name='{method}'", "--set", f"run.dt={dt}")
                rows = json.loads(self.hamflow("sweep", "driven.toml", *arguments, "--vary",
                                               "problem.parameters.w=1,0.5,0.25,2,1.5,1,0.75,3,1.25", "--out", "none",
                                               "--json").stdout)
                self.assertEqual(rows["members_in_lanes"], 9)
                for row in rows["rows"]:
                    w, t, p = row["problem.parameters.w"], row["final"]["t"], row["final"]["p"][0]
                    if method == "kahan-li8":
                        self.assertLess(abs(p - math.sin(w * t) / w), 1e-11, (dt, w))
                    if w in (1, 3):
                        alone = self.summary("driven.toml", *arguments, "--set", f"problem.parameters.w={w}")
                        for part in ("q", "p"):
                            self.assertEqual(alone["final"][part], row["final"][part], (method, dt, w))
                        self.assertEqual(alone["energy"]["max_error"], row["energy"]["max_error"])

    def test_events_and_sections(self):
        """Located late: p = sin t at the time of the event, and each period has one of either."""
        for dt, steps in (("0.1", 1000000), ("0.3333333333333333", 301000)):
            found = self.run_of(f"run.dt={dt}", f"run.steps={steps}", """run.events=[
                { name = "up", expression = "p_x - 0.3" },
                { name = "late", expression = "t - 99999.5", action = "stop" }]""".replace("\n", " "),
                                "run.section={ expression = 'x - 1.2', direction = 1 }")
            stop = found["stopped_by"]
            self.assertLess(abs(stop["p"][0] - math.sin(99999.5)), 1e-11)
            turns = (99999.5 - math.asin(0.3)) // (2 * math.pi) + 1
            self.assertEqual(found["events"]["user:up"], turns)
            self.assertLessEqual(abs(found["section"]["points"] - turns), 1)
            self.assertLess(found["section"]["max_residual"], 1e-12)

    def test_walls(self):
        for rule, method, dt in (("event", "kahan-li8", "0.1"), ("event", "kahan-li8", "-0.1"),
                                 ("event", "rkn8-s19", "0.3333333333333333"), ("event", "cg(3)", "0.3333333333333333"),
                                 ("event", "dop853", "0.1"), ("event", "taylor", "-0.1"),
                                 ("mirror", "kahan-li8", "0.1"), ("mirror", "rkn8-s19", "-0.3333333333333333")):
            with self.subTest(rule=rule, method=method, dt=dt):
                slow = method in ("cg(3)", "dop853", "taylor")
                settings = (f"problem.wall_rule='{rule}'", f"method.name='{method}'", f"run.dt={dt}",
                            f"run.steps={5000 if slow else 100000}")
                self.assertLess(self.miss(*settings, scenario="walled.toml"), 1e-11)

    def test_steps_of_varying_length(self):
        for method, dt, steps in (("kahan-li8", 0.05, 100000), ("kahan-li8", -0.05, 100000), ("gauss(4)", 0.1, 5000)):
            self.assertLess(self.miss(f"method={{ name = '{method}', step_control = 'reversible' }}", f"run.dt={dt}",
                                      f"run.steps={steps}"), 1e-11)
        for method in ("dop853", "taylor"):
            for dt in ("0.25", "-0.3333333333333333"):
                self.assertLess(self.miss(f"method.name='{method}'", f"run.dt={dt}", "run.steps=10000"), 1e-11)

    def test_resumed(self):
        """In three parts, and made longer: the bits of one run, which is right."""
        for method in ("kahan-li8", "rk4", "gauss(4)", "cg(3)", "dop853"):
            with self.subTest(method=method):
                method_of = ("--set", f"method.name='{method}'")
                steps = 6000 if method in ("gauss(4)", "cg(3)", "dop853") else 60000
                for part in (1, 2, 3):
                    self.hamflow("run", "driven.toml", *method_of, "--set", f"run.steps={part * steps // 3}", "--out",
                                 f"{method}.run", *(["--resume"] if part > 1 else []))
                summary = json.loads((self.folder / f"{method}.run" / "summary.json").read_text())
                whole = self.summary("driven.toml", *method_of, "--set", f"run.steps={steps}")
                self.assertEqual(summary["final"], whole["final"])
                self.assertEqual(summary["energy"], whole["energy"])

    def test_shorter_steps_are_not_worse(self):
        rows = json.loads(self.hamflow("compare", "driven.toml", "--methods", "kahan-li8,rkn8-s19,rk4", "--dt",
                                       "0.1,0.05,0.025,0.0125,0.00625", "--set", "run.steps=10000", "--out", "none",
                                       "--json").stdout)["rows"]
        for method in ("kahan-li8", "rkn8-s19", "rk4"):
            errors = [row["differences"]["p_x"] for row in rows if row["method"] == method]
            self.assertEqual(len(errors), 5)
            for longer, shorter in zip(errors, errors[1:]):
                self.assertLess(shorter, max(longer, 1e-13), method)


if __name__ == "__main__":
    unittest.main()

"""Requests that contradict themselves are refused, and what is left out is said."""

import json
import subprocess
import unittest

from command import HAMFLOW, CommandCase

TOLERANT = """
[problem]
name = "harmonic"
initial = { q = [1], p = [0] }
[method]
name = "cg"
quadrature = 5
tolerance = 1e-3
max_iterations = 7
[run]
dt = 0.1
steps = 4
"""


class Nonsense(CommandCase):
    def refused(self, *arguments):
        return self.hamflow(*arguments, status=2).stderr

    def test_an_end_within_the_first_step(self):
        for t_end, dt in (("40", "1e11"), ("1e-9", "10"), ("-40", "-1e11")):
            text = self.refused("run", "kepler.toml", "--out", "none", "--set", f"run.t_end={t_end}", "--set", f"run.dt={dt}")
            self.assertIn("run.t_end", text)
            self.assertRegex(text, "nearest dt = (40|1e-09|-40) or t_end = (1e[+]11|10|-1e[+]11)\n")
        self.assertEqual(self.summary("kepler.toml", "--set", "run.t_end=0")["steps"], 0)
        self.assertEqual(self.summary("kepler.toml", "--set", "run.steps=0")["steps"], 0)
        text = self.refused("run", "kepler.toml", "--out", "none", "--set", "run.t_end=1.04")
        self.assertIn("nearest dt = 0.10400000000000001 or t_end = 1", text)

    def test_keys_of_a_sweep_that_override_each_other(self):
        ellipse = '{kind="ellipse",r_per=1,r_aph=2},{kind="ellipse",r_per=1,r_aph=3}'
        for varied in (["problem.orbit.r_per=0.5,1", f"problem.orbit={ellipse}"],
                       [f"problem.orbit={ellipse}", "problem.orbit.r_per=0.5,1"]):
            text = self.refused("sweep", "kepler.toml", "--out", "none", "--vary", varied[0], "--vary", varied[1])
            self.assertIn("of which one replaces the other", text)
        self.write("s.toml", TOLERANT)
        self.assertIn("replaces", self.refused("sweep", "s.toml", "--out", "none", "--vary", "problem.initial.q=[1],[2]",
                                               "--vary", "problem.initial.q[0]=1,2"))
        self.assertIn("--set: error: found run.dt", self.refused("sweep", "s.toml", "--out", "none", "--vary",
                                                                 "run.dt=0.1,0.2", "--set", "run.dt=0.3"))
        done = self.hamflow("sweep", "kepler.toml", "--out", "none", "--json", "--set", 'problem.orbit={kind="ellipse",'
                            "r_per=1,r_aph=2}", "--vary", "problem.orbit.r_aph=3,4")
        self.assertEqual(json.loads(done.stdout)["done"], 2, "a part of what is set may be varied")

    def test_keys_on_which_no_number_of_a_sweep_depends(self):
        for vary in ("output.folder=a,b", "run.record_every=1,2", "run.checkpoint_every=1,2"):
            self.assertIn("which does not change the results of a sweep",
                          self.refused("sweep", "kepler.toml", "--out", "none", "--vary", vary))

        self.assertIn("which must be the same for all members; allowed --set output.observables",
                      self.refused("sweep", "kepler.toml", "--out", "none", "--vary", "output.observables=1,2"))

    def test_an_unknown_method_is_not_answered_by_a_wall(self):
        text = self.refused("run", "kepler.toml", "--out", "none", "--set", "method.name=verlt")
        self.assertRegex(text, r"found .verlt.; allowed verlet, stv4, kahan-li8, rkn8-s19, cg, taylor and \d+ others")
        self.assertTrue(text.endswith("; did you mean verlet?\n"), text)

    def test_options_of_another_family_are_dropped_with_a_note(self):
        self.write("s.toml", TOLERANT)
        for method in ("taylor", "dop853", "verlet"):
            done = self.hamflow("run", "s.toml", "--out", "none", "--json", "--set", f"method.name={method}")
            for key in ("quadrature", "tolerance", "max_iterations"):
                self.assertIn(f"note: method.{key} of the file is not used", done.stderr, method)
            self.assertEqual(json.loads(done.stdout)["method"], method)
        self.assertIn("for which it has another meaning",
                      self.hamflow("run", "s.toml", "--out", "none", "--set", "method.name=taylor").stderr)
        done = self.hamflow("run", "s.toml", "--out", "none", "--json", "--set", "method.name=taylor",
                            "--set", "method.tolerance=1e-9")
        self.assertEqual(json.loads(done.stdout)["method"], "taylor(tolerance=1e-09)", "what is set is meant")
        text = self.refused("run", "s.toml", "--out", "none", "--set", "method.name=taylor", "--set", "method.quadrature=6")
        self.assertTrue(text.startswith("--set: error: method.quadrature: found an unknown key; "), text)
        self.write("t.toml", TOLERANT.replace('"cg"', '"taylor"').replace("quadrature = 5\n", "").replace(
            "max_iterations = 7\n", ""))
        done = self.hamflow("run", "t.toml", "--out", "none", "--json", "--set", "method.name=cg")
        self.assertIn("note: method.tolerance of the file is not used", done.stderr)
        done = self.hamflow("run", "t.toml", "--out", "none", "--json", "--set", "method.name=dop853")
        self.assertEqual(json.loads(done.stdout)["method"], "dop853(tolerance=0.001)", "both mean the same by it")

    def test_methods_of_a_sweep_each_with_its_own_options(self):
        self.write("s.toml", TOLERANT.replace("tolerance = 1e-3", "tolerance = 1e-3\ncriterion = \"seed\""))
        done = self.hamflow("sweep", "s.toml", "--vary", "method.name=taylor,cg,verlet,cg", "--out", "none", "--json")
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([r["status"] for r in rows], ["done"] * 4)
        self.assertEqual(rows[1]["final"], rows[3]["final"])
        self.assertEqual(rows[1]["final"], self.summary("s.toml")["final"], "the file's options hold for its own method")
        self.assertIn("note: method.tolerance of the file is not used", done.stderr)
        alone = self.summary("s.toml", "--set", "method.name=taylor")
        self.assertEqual(rows[0]["final"], alone["final"])

    def test_shell_methods_keep_to_their_own_tolerance(self):
        self.write("s.toml", TOLERANT)
        lines = "method taylor\nshow settings\nmethod dop853(1e-6)\nmethod taylor\nshow settings\nmethod cg\nshow settings\n"
        done = subprocess.run([HAMFLOW, "shell", "s.toml", "--json"], cwd=self.folder, input=lines, capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        shown = [json.loads(line)["tolerance"] for line in done.stdout.splitlines()]
        self.assertEqual(shown, [1e-12, 1e-6, 1e-3])

    def test_states_that_double_cannot_convert(self):
        text = self.refused("convert", "--from", "cartesian", "--to", "polar", "--q", "1e200,1e200", "--p", "1e200,1e200")
        self.assertIn("coordinates are not finite in double", text)
        done = self.hamflow("convert", "--from", "cartesian", "--to", "polar", "--q", "1e200,1e200", "--p", "1e200,1e200",
                            "--json", status=2)
        self.assertEqual(json.loads(done.stdout)["status"], "rejected")

    def test_names_that_are_not_meant_are_not_offered(self):
        text = self.refused("run", "kepler.toml", "--out", "none", "--set", "problem.foo=1")
        self.assertNotIn("did you mean", text)


if __name__ == "__main__":
    unittest.main()

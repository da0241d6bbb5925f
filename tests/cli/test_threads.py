"""Threads for the forces of many bodies: the same bits for any number, and refused where they would change bits."""

import unittest

from command import EXAMPLES, CommandCase

CLUSTER = str(EXAMPLES / "cluster_lattice.toml")
SUN = str(EXAMPLES / "solar_system.toml")


class Threads(CommandCase):
    def test_the_same_bits_for_any_number(self):
        results = [self.summary(CLUSTER, "--set", f"run.threads={n}") for n in (1, 2, 4)]
        for s in results:
            self.assertEqual(s["status"], "done")
            self.assertEqual(s["final"], results[0]["final"])
            self.assertEqual(s["energy"], results[0]["energy"])
            self.assertLess(s["invariants"]["linear_momentum"]["max_error"], 1e-15)  # of summing it up

    def test_where_they_are_refused(self):
        for words, sets in (
            ("order of floating-point sums", ("run.threads=2", "run.arithmetic=double")),
            ("from 1 to 256", ("run.threads=0",)),
            ("from 1 to 256", ("run.threads=257",)),
            ("from 1 to 256", ("run.threads=1.5",)),
        ):
            arguments = [word for text in sets for word in ("--set", text)]
            said = self.hamflow("run", CLUSTER, "--out", "none", *arguments, status=2).stderr
            self.assertIn("error: run.threads: found", said)
            self.assertIn(words, said)
        said = self.hamflow("run", "kepler.toml", "--out", "none", "--set", "run.threads=2", status=2).stderr
        self.assertIn("error: run.threads: found 2; a step of central-force is too short to be shared among threads; allowed 1", said)
        self.assertIn("n-body", said)
        self.hamflow("run", CLUSTER, "--out", "none", "--set", "run.threads=1", "--set", "run.arithmetic=double")

    def test_units_that_suit_the_start(self):
        s = self.summary(SUN, "--set", "run.t_end=5000", "--set", "output.figures=[]", "--set", "run.arithmetic=lattice",
                         "--set", "run.threads=2")
        self.assertEqual(s["lattice"]["position"], 2.0**-48)  # 30 AU
        self.assertIn(s["lattice"]["momentum"], (2.0**-70, 2.0**-69))  # of about 7e-6, Jupiter's
        cold = """[problem]
name = "n-body"
masses = [1e20, 1e20]
gravitational_constant = 6.7e-11
initial = { q = [1e6, 0, 0, -1e6, 0, 0], p = [0, 0, 0, 0, 0, 0] }
[method]
name = "stv4"
[run]
dt = 10
steps = 100
arithmetic = "lattice"
"""
        self.write("cold.toml", cold)
        s = self.summary("cold.toml")
        self.assertEqual(s["status"], "done")
        # T = |V| = 3.35e23 with p^2/m in each of 6 components: p = sqrt(3.35e23 1e20/3) = 3.3e21, 2^71.5.
        self.assertEqual(s["lattice"]["momentum"], 2.0 ** (71 - 52))
        self.assertEqual(s["lattice"]["position"], 2.0 ** (19 - 52))

    def test_two_bodies_that_meet(self):
        head_on = """[problem]
name = "n-body"
masses = [1, 1]
initial = { q = [1, 0, -1, 0], p = [0, 0, 0, 0] }
[method]
name = "verlet"
[run]
dt = "1/16"
steps = 100000
arithmetic = "lattice"
"""
        self.write("head_on.toml", head_on)
        s = self.summary("head_on.toml", status=1)
        self.assertEqual(s["error"]["kind"], "lattice_overflow")
        self.assertIn("softening", s["error"]["hint"])
        self.assertEqual(sum(s["final"]["p"]), 0.0)


if __name__ == "__main__":
    unittest.main()

"""What the figure of a sweep leaves out, it tells."""

import re
import unittest

from command import CommandCase

HENON = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.2], p = [0.1, 0] }
[method]
name = "verlet"
[run]
dt = 0.05
steps = 400
[output]
observables = { pole = "1/q1" }
"""


class SweepFigures(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("h.toml", HENON)

    def drawn(self, *arguments):
        """The words in the figure."""
        self.hamflow("sweep", "h.toml", "--out", "none", "--quiet", "--figure", "f.svg", *arguments)
        return re.sub("<[^>]*>", "", "".join(re.findall("<text.*</text>", (self.folder / "f.svg").read_text())))

    def test_values_that_are_not_finite(self):
        column = ("--colour", "observables/pole_initial")
        poles = ("--vary", "problem.initial.q[0]=0,0.1,0.2")
        self.assertIn("not drawn: 1 of 3 members (1 without a finite value)", self.drawn(*poles, *column))
        self.assertIn("white: 3 of 9 members (3 without a finite value)",
                      self.drawn("--vary", "problem.initial.q[0]=0:0.2:3", "--vary", "problem.initial.q[1]=0.1:0.3:3", *column))
        self.assertIn("not drawn: 1 of 3 means, which are not finite",
                      self.drawn(*poles, "--vary", "problem.initial.q[1]=0.1,0.2", "--mean", *column))
        self.assertNotIn("not drawn", self.drawn("--vary", "problem.initial.q[0]=0.1,0.2", *column))

    def test_sections_of_members_that_fail(self):
        """Points at 1e65 would leave one dot of all others."""
        section = ("--set", "run.section={ coordinate = 'q1' }", "--vary", "problem.initial.q[1]=0.1:1.4:6")
        words = self.drawn(*section)
        self.assertIn("not drawn: 2 of 6 members (2 non_finite)", words)
        self.assertIn("section q1 = 0, q1 increasing", words)
        self.assertNotIn("×10", words)
        self.assertNotIn("not drawn", self.drawn(*section[:2], "--vary", "problem.initial.q[1]=0.1:0.4:6"))


if __name__ == "__main__":
    unittest.main()

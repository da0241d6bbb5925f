"""Implicit steps of large sparse systems: fixed points where they cost less than Newton's matrix, and nobody says which;
the same in every road. Newton takes the steps in which they do not converge."""

import json
import unittest

from command import CommandCase


def ring(bodies, method="name = 'cg(1,4)'", dt=0.05, steps=60, coupling=1):
    """The discrete nonlinear Schroedinger equation on a ring."""
    q = [round(0.3 + 0.2 * ((i * 37) % 11) / 11, 4) for i in range(bodies)]
    p = [round(0.1 * ((i * 17) % 7) / 7, 4) for i in range(bodies)]
    return f"""
[problem]
name = "formula"
coordinates = ["q[n]"]
momenta = ["p[n]"]
hamiltonian = "c*(sum(i, 1, n - 1, (q[i+1] - q[i])^2/2 + (p[i+1] - p[i])^2/2) + (q[1] - q[n])^2/2 + \
(p[1] - p[n])^2/2) - sum(i, 1, n, (q[i]^2 + p[i]^2)^2/4)"
parameters = {{ n = {bodies}, c = {coupling} }}
initial = {{ q = {q}, p = {p} }}
[method]
{method}
[run]
dt = {dt}
steps = {steps}
"""


class SparseSteps(CommandCase):
    def found(self, text, *arguments):
        return self.summary(self.write("ring.toml", text), *arguments)

    def test_taken_where_it_costs_less(self):
        chosen = self.found(ring(128))
        self.assertEqual(chosen["newton"]["iteration"], "fixed-point-or-newton")
        self.assertEqual(chosen["evaluations"]["hessian"], 0)
        said = self.found(ring(128, "name = 'cg(1,4)'\niteration = 'fixed-point-or-newton'"))
        self.assertEqual(chosen["final"], said["final"])
        self.assertNotIn("iteration", said["newton"])
        by_newton = self.found(ring(128, "name = 'cg(1,4)'\niteration = 'newton'"))
        self.assertGreater(by_newton["evaluations"]["hessian"], 0)
        for part in ("q", "p"):
            for mine, its in zip(chosen["final"][part], by_newton["final"][part]):
                self.assertAlmostEqual(mine, its, delta=1e-12)
        self.assertLess(chosen["energy"]["max_error"], 1e-13)

    def test_it_is_said(self):
        self.write("ring.toml", ring(128))
        self.assertIn("fixed-point-or-newton", self.hamflow("show", "ring.toml").stdout)
        self.assertIn("fixed-point-or-newton", self.hamflow("run", "ring.toml", "--out", "none").stdout)

    def test_not_where_it_does_not(self):
        """Few unknowns, long steps, diagnostics."""
        for text in (ring(32), ring(100, dt=0.4, steps=3), ring(100, "name = 'cg(1,4)'\ndiagnostics = true", steps=3)):
            self.assertNotIn("iteration", self.found(text)["newton"])
        self.write("ring.toml", ring(32))
        self.assertNotIn("fixed-point", self.hamflow("show", "ring.toml").stdout)

    def test_the_same_in_every_road(self):
        """Resumed, in lanes of a sweep, with samples in between, and compared."""
        text = ring(128, steps=40)
        whole = self.found(text)
        self.hamflow("run", "ring.toml", "--out", "r", "--set", "run.steps=15")
        self.hamflow("run", "ring.toml", "--out", "r", "--resume")
        resumed = json.loads((self.folder / "r" / "summary.json").read_text())
        self.assertEqual(resumed["final"], whole["final"])
        self.assertEqual(resumed["evaluations"], whole["evaluations"])
        rows = json.loads(self.hamflow("sweep", "ring.toml", "--vary", "problem.parameters.c=1,1", "--out", "none",
                                       "--json").stdout)["rows"]
        for row in rows:
            self.assertEqual(row["final"], whole["final"])

    def test_newton_takes_what_does_not_converge(self):
        text = ring(60, "name = 'cg(1,4)'\niteration = 'fixed-point-or-newton'", dt=0.6, steps=10)
        found = self.found(text)
        self.assertEqual(found["status"], "done")
        self.assertGreater(found["evaluations"]["hessian"], 0)
        by_newton = self.found(text.replace("fixed-point-or-newton", "newton"))
        for mine, its in zip(found["final"]["q"], by_newton["final"]["q"]):
            self.assertAlmostEqual(mine, its, delta=1e-11)
        self.write("ring.toml", text.replace("fixed-point-or-newton", "fixed-point"))
        self.assertIn("did not converge", self.hamflow("run", "ring.toml", "--out", "none", status=1).stderr)


if __name__ == "__main__":
    unittest.main()

"""The formulas of examples/formulas, each against something that is known: an invariant, a period, a limit, a reference
computed here."""

import math
import unittest

import h5py

from command import EXAMPLES, CommandCase


def example(name):
    return str(EXAMPLES / "formulas" / f"{name}.toml")


def quadrature(f, n=2000):
    """The integral of f over [0, pi] by the trapezoidal rule, which converges faster than any power for periodic f."""
    return math.pi / n * (f(0.0) / 2 + sum(f(math.pi * k / n) for k in range(1, n)) + f(math.pi) / 2)


class FormulaExamples(CommandCase):
    def run_example(self, name, *sets):
        return self.summary(example(name), *(word for one in sets for word in ("--set", one)))

    def returns(self, name, q, p, period, steps, tolerance, *sets):
        """The state comes back after a period."""
        start = [f"problem.initial={{ q = {q}, p = {p} }}"]
        found = self.run_example(name, *start, f"run.dt={period!r}/{steps}", f"run.steps={steps}", *sets)
        for found_one, one in zip(found["final"]["q"] + found["final"]["p"], q + p):
            self.assertAlmostEqual(found_one, one, delta=tolerance)
        return found

    def test_toda(self):
        """Integrable: H, the momentum and Henon's cubic are conserved."""
        found = self.run_example("toda_lattice")
        self.assertEqual(found["parameters"]["structure"],
                         {"separable": True, "quadratic_kinetic": True, "time": False})
        self.assertLess(found["energy"]["max_error"], 1e-10)
        self.assertLess(found["invariants"]["henon"]["max_error"], 1e-10)
        self.assertLess(found["invariants"]["momentum"]["max_error"], 1e-12)

    def test_restricted_three_bodies(self):
        """Arenstorf's orbit closes: an error e of the start becomes some 1e6 e."""
        found = self.run_example("restricted_three_bodies")
        for one, start in zip(found["final"]["q"], [0.994, 0]):
            self.assertAlmostEqual(one, start, delta=1e-7)

    def test_driven_pendulum(self):
        """Against Runge-Kutta steps taken here; the energy's error is that of an autonomous system: bounded."""
        a, w, q, p = 0.4, 2 / 3, 0.2, 0.0
        steps, h = 8000, 3 * math.pi / 4000

        def f(t, q, p):
            return p, -math.sin(q) + a * math.cos(w * t)

        for k in range(steps):
            t = k * h
            k1 = f(t, q, p)
            k2 = f(t + h / 2, q + h / 2 * k1[0], p + h / 2 * k1[1])
            k3 = f(t + h / 2, q + h / 2 * k2[0], p + h / 2 * k2[1])
            k4 = f(t + h, q + h * k3[0], p + h * k3[1])
            q += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
            p += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        for method, dt, tolerance in (("kahan-li8", "3*pi/100", 1e-8), ("rk4", "3*pi/1000", 1e-6), ("cg", "3*pi/4000", 1e-4)):
            count = round(steps * h / eval(dt.replace("pi", "math.pi")))
            found = self.run_example("driven_pendulum", f"method.name={method}", f"run.dt={dt}", f"run.steps={count}")
            self.assertEqual(len(found["final"]["q"]), 1)
            self.assertAlmostEqual(found["final"]["q"][0], q, delta=tolerance, msg=method)
            self.assertAlmostEqual(found["final"]["p"][0], p, delta=tolerance, msg=method)
        self.assertLess(self.run_example("driven_pendulum")["energy"]["max_error"], 1e-3)

    def test_driven_duffing(self):
        """Once a period: without the force every point lies on the start's level of H."""
        found = self.run_example("driven_duffing", "run.steps=6400", "output.figures=[]")
        self.assertIn(found["section"]["points"], (99, 100))  # the last one is the end of the run, to rounding
        self.assertLess(found["section"]["max_residual"], 1e-10)
        self.hamflow("run", example("driven_duffing"), "--set", "problem.parameters.f=0", "--set", "run.steps=6400", "--out",
                     "free.run", "--quiet")
        with h5py.File(self.folder / "free.run/run.h5") as file:
            q, p = file["section/q"][:, 0], file["section/p"][:, 0]
        level = 0.1**4 / 4 - 0.1**2 / 2
        for x, v in zip(q, p):
            self.assertAlmostEqual(v * v / 2 - x * x / 2 + x**4 / 4, level, delta=1e-8)

    def test_relativistic_oscillator(self):
        """The period 4 int dx/v, with x = sin(theta): gamma = 1 + (1 - x^2)/2 for c = m = omega = 1."""
        def integrand(theta):
            k = math.cos(theta) ** 2 / 2
            return (1 + k) / math.sqrt(1 + k / 2)  # dx/v = gamma/sqrt(gamma^2 - 1) cos(theta) dtheta

        period = 2 * quadrature(lambda theta: integrand(theta - math.pi / 2))
        self.assertGreater(period, 2 * math.pi)
        found = self.returns("relativistic_oscillator", [1.0], [0.0], period, 400, 1e-8)
        self.assertEqual(found["parameters"]["structure"]["quadratic_kinetic"], False)

    def test_swinging_atwood(self):
        """M = 3 m is integrable: H to rounding, the second invariant to the order of the method."""
        errors = [self.run_example("swinging_atwood", f"run.dt={dt}", f"run.steps={n}")["invariants"]["tufillaro"]["max_error"]
                  for dt, n in ((0.02, 500), (0.01, 1000))]
        self.assertLess(errors[0], 1e-2)
        self.assertAlmostEqual(errors[0] / errors[1], 4, delta=1)
        other = self.run_example("swinging_atwood", "problem.parameters.M=2", "run.steps=500")
        self.assertGreater(other["invariants"]["tufillaro"]["max_error"], 100 * errors[0])

    def test_morse_chain(self):
        """The first mode of small oscillations: bonds k = 2 depth a^2, omega = 2 sqrt(k/m) sin(pi/12)."""
        q = [1e-6 * math.sin(math.pi * i / 6) for i in range(1, 6)]
        period = 2 * math.pi / (2 * math.sin(math.pi / 12))
        self.returns("morse_chain", q, [0.0] * 5, period, 400, 1e-11)

    def test_elastic_pendulum(self):
        """Small vertical oscillations about y = -l - m g/k: omega = sqrt(k/m), without any limit."""
        self.returns("elastic_pendulum", [0.0, -4 / 3 - 0.1], [0.0, 0.0], 2 * math.pi / math.sqrt(3), 200, 1e-11)

    def test_dipole_field(self):
        """In the equatorial plane about rho = 1, where (1/rho - 1/rho^2)^2/2 = (rho - 1)^2/2 + ...: period 2 pi."""
        found = self.returns("dipole_field", [1.0 + 1e-6, 0.0], [0.0, 0.0], 2 * math.pi, 800, 1e-10)
        self.assertEqual(found["final"]["q"][1], 0)

    def test_stark(self):
        """Integrable: what the field leaves of the Runge-Lenz vector."""
        found = self.run_example("stark")
        self.assertLess(found["invariants"]["runge_lenz"]["max_error"], 1e-9)
        self.assertLess(found["energy"]["max_error"], 1e-9)

    def test_logarithmic_galaxy(self):
        """Without flattening circles have the speed v0 r/sqrt(core^2 + r^2)."""
        r, core = 0.8, 0.14
        speed = r / math.hypot(core, r)
        found = self.returns("logarithmic_galaxy", [r, 0.0], [0.0, speed], 2 * math.pi * r / speed, 400, 1e-9,
                             "problem.parameters.flattening=1")
        self.assertLess(found["energy"]["max_error"], 1e-12)
        self.assertGreater(self.run_example("logarithmic_galaxy")["section"]["points"], 50)


if __name__ == "__main__":
    unittest.main()

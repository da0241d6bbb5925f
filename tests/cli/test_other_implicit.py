"""eg, the Lobatto pair and the discrete gradients, as they are typed: what they keep, what is refused and why."""

import json
import unittest

from command import CommandCase

PLANE = """
[problem]
name = "central-force"
potential = "kepler"
coordinates = "cartesian"
initial = { q = [0.4, 0], p = [0, 2] }
[method]
name = "eg(2)"
[run]
dt = 0.05
steps = 200
"""
BODIES = """
[problem]
name = "n-body"
masses = [1, 0.3, 0.2]
initial = { q = [0, 0, 1, 0, 0.125, -1.5], p = [0, -0.125, 0.0625, 0.3125, 0.1875, 0] }
[method]
name = "eg(2)"
[run]
dt = 0.02
steps = 500
"""
SPRING = """
[problem]
name = "central-force"
potential = "binomial"
k = 1e6
initial = { q = [1, 0], p = [0.2, 1] }
[method]
name = "cg(1,auto)"
[run]
dt = 0.1
steps = 70
"""
FAMILIES = ("eg(1)", "eg(3)", "lobatto-3a-3b(3)", "discrete-gradient", "itoh-abe")


class OtherImplicit(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("plane.toml", PLANE)
        self.write("bodies.toml", BODIES)

    def refused(self, scenario, *settings):
        arguments = [word for setting in settings for word in ("--set", setting)]
        return self.hamflow("run", scenario, "--out", "none", *arguments, status=2).stderr

    def test_energy_and_momenta_of_bodies(self):
        found = self.summary("bodies.toml")
        self.assertLess(found["energy"]["max_relative_error"], 30 * 500**0.5 * 2.0**-52)
        for name in ("angular_momentum", "linear_momentum"):
            self.assertLess(max_of(found["invariants"][name]["max_error"]), 30 * 500**0.5 * 2.0**-52, name)
        lost = self.summary("bodies.toml", "--set", "method.name='cg(1,5)'")
        self.assertGreater(lost["invariants"]["angular_momentum"]["max_error"], 1e-9)

    def test_in_more_digits(self):
        # 200 steps of some ten roundings, each of numbers of size 1, in units of the last digit.
        for method in FAMILIES[1:]:
            for arithmetic, digit in (("double-double", 2.0**-104), ("quad", 2.0**-112), ("mp(40)", 1e-40)):
                found = self.summary("plane.toml", "--set", f"method.name={method}", "--set", f"run.arithmetic={arithmetic}")
                kept = "angular_momentum" if method.startswith(("eg", "lobatto")) else "energy"
                error = (found["invariants"][kept] if kept != "energy" else found["energy"])["max_error"]
                self.assertLess(float(error), 100 * digit * 200**0.5, (method, arithmetic))

    def test_corrections_that_go_round_are_no_solution(self):
        # A position rounds by 2^-52, a force by k times that, its work in a step by h |v| times that; 8 of them a step.
        self.write("spring.toml", SPRING)
        # 200 radians a step: at step 28 the corrections of cg(1,auto) go round in threes from every start, at 62 and 64
        # those of eg(2) between two places that are near each other.
        for method in ("cg(1,auto)", "eg(2)"):
            found = self.summary("spring.toml", "--set", f"method.name={method}")
            self.assertLess(found["energy"]["max_error"], 8 * 2.0**-52 * 1e6 * 0.1 * 70**0.5, method)
        # What is left of a fixed-point iteration turns while it shrinks, by 3 % each time.
        slow = self.summary("spring.toml", "--set", "problem.k=1e4", "--set", "problem.initial.p=[0, 1e-3]", "--set", "run.dt=0.015",
                            "--set", "run.steps=300", "--set", "method.name=eg(2,iteration=fixed-point)")
        self.assertLess(slow["energy"]["max_error"], 8 * 2.0**-52 * 1e4 * 0.015 * 1e-3 * 300**0.5)

    def test_a_step_without_a_solution_says_where_it_ends(self):
        done = self.hamflow("run", "plane.toml", "--out", "none", "--set", "problem.initial={ q = [1.6, 0], p = [0, 0.5] }", "--set",
                            "run.dt=0.6", status=1)
        self.assertRegex(done.stderr, r"the solution that grows out of the beginning of the step ends at 0\.9\d* of its length")

    def test_a_run_in_two_parts_has_the_bits_of_one(self):
        for method in FAMILIES:
            once = self.summary("plane.toml", "--set", f"method.name={method}")["final"]
            common = ("plane.toml", "--set", f"method.name={method}", "--out", "cut", "--json")
            self.hamflow("run", *common, "--set", "run.steps=77", "--force")
            self.hamflow("run", *common, "--resume")
            self.assertEqual(json.loads((self.folder / "cut" / "summary.json").read_text())["final"], once, method)

    def test_refusals_name_the_reason(self):
        for settings in (("problem.coordinates=polar",), ("problem.potential=formula", "problem.V=-1/r")):
            said = self.refused("plane.toml", *settings)
            self.assertIn("eg needs an H of bodies whose forces act along the lines between them or to a centre", said)
            self.assertIn("that of central-force is none", said)
        self.write("double.toml", '[problem]\nname = "double-pendulum"\ninitial = { q = [0.1, 0], p = [0, 0] }\n'
                   '[method]\nname = "eg"\n[run]\ndt = 0.01\nsteps = 1\n')
        said = self.refused("double.toml")
        self.assertIn("that of double-pendulum is none", said)
        self.assertIn("gas without a container", said)
        for method, allowed in (("eg(0)", "from 1 to 3"), ("eg(4)", "from 1 to 3"), ("lobatto-3a-3b(1)", "from 2 to 10"),
                                ("lobatto-3a-3b(11)", "from 2 to 10")):
            self.assertIn("allowed a whole number " + allowed, self.refused("plane.toml", f"method.name={method}"))
        for method in FAMILIES:
            chosen = f"method.name={method}"
            self.assertIn("no bijection of the lattice", self.refused("plane.toml", chosen, "run.arithmetic=lattice"))
            self.assertIn("needs the exact force", self.refused("plane.toml", chosen, "run.kernel=fast"))
            self.assertIn("unknown key", self.refused("plane.toml", chosen, "method.quadrature=3"))


def max_of(errors):
    return max(errors) if isinstance(errors, list) else errors


if __name__ == "__main__":
    unittest.main()

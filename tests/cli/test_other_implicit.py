"""eg, the Lobatto pair and the discrete gradients, as they are typed: what they keep, what is refused and why."""

import json
import math
import subprocess
import unittest

from command import HAMFLOW, CommandCase

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


FREE = """
[problem]
%s
[method]
name = "gauss(2)"
[run]
dt = %s
steps = 60
"""
PLATEAU = FREE % (f'name = "fput"\nn = 12\nalpha = 0.25\ninitial = {{ q = {[1.0] * 12}, p = {[0.0] * 12} }}', 0.2)
SHIFTED = FREE % ('name = "n-body"\nmasses = [1, 0.5, 0.2]\nsoftening = 0.1\n'
                  'initial = { q = [10000, 10000, 10001, 10000, 10000, 10001.5], p = [0, 0, 0, 0.5, -0.1, 0] }', 0.05)
SMOOTH = FREE % ('name = "fput"\nn = 300\nalpha = 0.25\n'
                 f'initial = {{ q = {[round(math.sin(math.pi * (i + 1) / 301), 3) for i in range(300)]}, p = {[0.0] * 300} }}', 0.5)


class CoordinatesThatAreLargeBesideTheirDifferences(CommandCase):
    """Forces cancel there, and round by far more than their terms tell; iterations without second derivatives end at that."""

    def check(self, scenario, methods, iterations):
        self.write("s.toml", scenario)
        for method in methods:
            for iteration in iterations:
                sets = ["--set", f"method.name={method}"] + (["--set", f"method.iteration={iteration}"] if iteration else [])
                with self.subTest(f"{method} {iteration}"):
                    done = self.summary("s.toml", *sets)
                    self.assertEqual(done["steps"], 60)

    def test_a_plateau(self):
        self.check(PLATEAU, ["cg(1)", "avf", "gauss(2)", "lobatto-3a-3b(3)", "discrete-gradient", "itoh-abe"],
                   ["fixed-point", "simplified", "newton"])

    def test_bodies_far_from_the_origin(self):
        self.check(SHIFTED, ["cg(1)", "cg(2,4)", "gauss(2)", "gauss(3)", "discrete-gradient", "itoh-abe"],
                   ["fixed-point", "simplified", "newton"])

    def test_the_default_of_large_systems(self):
        self.check(SMOOTH, ["gauss(2)", "cg(2)", "discrete-gradient"], [None])

    def test_their_iterations_are_those_that_are_asked_for(self):
        self.write("s.toml", SMOOTH)
        told = self.summary("s.toml", "--set", "method.max_iterations=4", status=1)
        self.assertIn("did not converge in 4 iterations", told["error"]["message"])


class ATolerance(CommandCase):
    def test_is_no_fault_of_the_points(self):
        """What a residual leaves of the energy is not what more Gauss points would see."""
        self.write("p.toml", """
[problem]
name = "pendulum"
initial = { q = [1.5], p = [0.1] }
[method]
name = "cg"
[run]
dt = 0.05
steps = 2000
""")
        for method in ("cg", "cg(2)", "cg(3)"):
            for tolerance in (1e-4, 1e-8, 1e-10):
                with self.subTest(f"{method} {tolerance}"):
                    done = self.summary("p.toml", "--set", f"method.name={method}", "--set", f"method.tolerance={tolerance}")
                    self.assertEqual(done["steps"], 2000)
                    # 2000 residuals, each of which changes H by its product with a gradient of some 10 at most.
                    self.assertLess(done["energy"]["max_error"], 2000 * 10 * tolerance + 1e-13)


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
        self.assertRegex(done.stderr, r"the solution could be continued from the beginning of the step to 0\.9\d* of its length")

    def test_what_is_left_of_a_tangent_of_old_is_no_drift(self):
        self.write("swing.toml", "[problem]\nname='formula'\ncoordinates=['x']\nhamiltonian='p_x^2/2 - cos(x)'\ninitial={q=[2],p=[0]}\n"
                   "[method]\nname='itoh-abe'\niteration='simplified'\n[run]\ndt=0.1\nsteps=20000\n")
        for method in ("itoh-abe", "discrete-gradient", "lobatto-3a-3b(3)"):
            energy = self.summary("swing.toml", "--set", f"method.name={method}")["energy"]
            exact = self.summary("swing.toml", "--set", f"method.name={method}", "--set", "method.iteration=newton")["energy"]
            # As a random walk with 20 000 steps of Newton's would end: twice the largest of two such.
            self.assertLess(energy["max_error"], 4 * exact["max_error"], method)

    def test_an_iterate_beside_a_singularity_does_not_pass_for_a_solution(self):
        self.write("fall.toml", "[problem]\nname='n-body'\nmasses=[1,1]\ninitial={q=[-0.5,0,0.5,0],p=[0,0,0,0]}\n"
                   "[method]\nname='eg(2)'\n[run]\ndt=0.05\nsteps=60\n")
        self.write("atoms.toml", "[problem]\nname='lennard-jones-oscillator'\ninitial={q=[1.5],p=[-2]}\n"
                   "[method]\nname='discrete-gradient'\n[run]\ndt=0.3\nsteps=300\n")
        for scenario, method in (("fall.toml", "eg(2)"), ("fall.toml", "eg(3)"), ("fall.toml", "discrete-gradient"),
                                 ("fall.toml", "discrete-gradient(tolerance=1e-10)"), ("atoms.toml", "discrete-gradient")):
            done = self.hamflow("run", scenario, "--set", f"method.name={method}", "--out", "none", "--json", status=None)
            found = json.loads(done.stdout)
            self.assertIn(done.returncode, (0, 1))
            if done.returncode == 1:
                self.assertEqual(found["error"]["kind"], "not_converged", method)
            # Through a fall of two points the largest terms of H are 1e6 times their sum, at most.
            self.assertLess(found["energy"]["max_error"], 1e6 * 1e-13, (scenario, method))

    def test_what_overflows_has_not_converged(self):
        self.write("steep.toml", "[problem]\nname='formula'\ncoordinates=['x']\nhamiltonian='p_x^2/2 + 1e6*x^2/2 + x^4'\n"
                   "initial={q=[1],p=[0]}\n[method]\nname='discrete-gradient'\niteration='fixed-point'\non_divergence='halve'\n"
                   "[run]\ndt=0.1\nsteps=3\n")
        for method in ("discrete-gradient", "itoh-abe"):
            found = self.summary("steep.toml", "--set", f"method.name={method}")
            self.assertGreater(found["events"]["halved"], 0, method)

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
            self.assertIn("central-force does not meet this", said)
        self.write("double.toml", '[problem]\nname = "double-pendulum"\ninitial = { q = [0.1, 0], p = [0, 0] }\n'
                   '[method]\nname = "eg"\n[run]\ndt = 0.01\nsteps = 1\n')
        said = self.refused("double.toml")
        self.assertIn("double-pendulum does not meet this", said)
        self.assertIn("gas without a container", said)
        for method, allowed in (("eg(0)", "from 1 to 3"), ("eg(4)", "from 1 to 3"), ("lobatto-3a-3b(1)", "from 2 to 10"),
                                ("lobatto-3a-3b(11)", "from 2 to 10")):
            self.assertIn("allowed a whole number " + allowed, self.refused("plane.toml", f"method.name={method}"))
        for method in FAMILIES:
            chosen = f"method.name={method}"
            self.assertIn("not a bijection of the lattice", self.refused("plane.toml", chosen, "run.arithmetic=lattice"))
            self.assertIn("unknown key", self.refused("plane.toml", chosen, "method.quadrature=3"))


LARGE = FREE % ('name = "fput"\nn = 600\nalpha = 0.25\n'
                f'initial = {{ q = {[round(math.sin(math.pi * (i + 1) / 601), 3) for i in range(600)]}, p = {[0.0] * 600} }}', 0.1)
KINK = """
[problem]
name = "formula"
coordinates = ["x"]
momenta = ["p"]
hamiltonian = "p^2/2 + abs(x)"
initial = { q = [0.7], p = [0.4] }
[method]
name = "cg(1)"
[run]
dt = 0.05
steps = 200
"""


class WhatASystemOfManyUnknownsDoesNotTake(CommandCase):
    """Above 500 unknowns no tangent is made: what is about one is refused as every wrong value is, what asks for one noted."""

    def setUp(self):
        super().setUp()
        self.write("large.toml", LARGE.replace("steps = 60", "steps = 1"))

    def test_diagnostics(self):
        for method in ("cg(1)", "cg(2)", "gauss(2)", "discrete-gradient", "lobatto-3a-3b(2)", "avf", "implicit-midpoint"):
            sets = ("--set", f"method.name={method}", "--set", "method.diagnostics=true")
            done = self.hamflow("run", "large.toml", *sets, "--out", "none", "--json", status=2)
            (error,) = json.loads(done.stdout)["errors"]
            self.assertEqual(error["key"], "method.diagnostics", method)
            self.assertRegex(error["message"], "found true; allowed false: a step has [0-9]+ unknowns; more than 500", method)
            self.assertIn("--set: error: method.diagnostics: found true", done.stderr)
        self.write("kept.toml", LARGE.replace('"gauss(2)"', '"gauss(2)"\ndiagnostics = true'))
        self.assertRegex(self.hamflow("run", "kept.toml", status=2).stderr, "kept.toml:[0-9]+:[0-9]+: error: method.diagnostics: found")
        told = self.hamflow("sweep", "large.toml", "--vary", "run.dt=0.1,0.2", "--set", "method.diagnostics=true", "--out",
                            "none", status=2).stderr
        self.assertIn("method.diagnostics: found true", told)
        told = self.hamflow("compare", "large.toml", "--methods", "cg(2,3,diagnostics=true),gauss(2)", status=2).stderr
        self.assertIn("found 'cg(2,3,diagnostics=true)'; method.diagnostics: found true; allowed false", told)

    def test_what_is_taken_in_place_of_newton_is_noted(self):
        def told(*settings):
            sets = [word for setting in settings for word in ("--set", setting)]
            return self.hamflow("run", "large.toml", *sets, "--out", "none").stderr

        self.assertNotIn("note: method", told())
        self.assertNotIn("note: method", told("method.iteration=fixed-point", "method.max_iterations=50"))
        for asked in ("newton", "simplified"):
            self.assertIn(f'note: method.iteration = "{asked}" is not used: a step has 1200 unknowns', told(f"method.iteration={asked}"))
        self.assertIn("note: method.max_iterations = 15 is taken as 100", told("method.max_iterations=15"))
        self.assertNotIn("note: method", told("method.max_iterations=60"))
        compared = self.hamflow("compare", "large.toml", "--methods", "gauss(2,iteration=simplified),verlet", "--dt", "0.1").stderr
        self.assertIn("note: 'gauss(2,iteration=simplified)': iteration = \"simplified\" is not used: a step has 1200 unknowns",
                      compared)


STIFF = """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + %s^2*x^2/2 + x^4"
initial = { q = [1], p = [0] }
[method]
name = "cg"
[run]
dt = 0.1
steps = 2000
"""
STIFF_ORBIT = """
[problem]
name = "formula"
coordinates = ["r", "f"]
hamiltonian = "p_r^2/2 + p_f^2/(2*r^2) + 1000^2*(r-1)^2/2"
initial = { q = [1.05, 0], p = [0.3, 1] }
[method]
name = "cg"
[run]
dt = 0.1
steps = 300
"""
STIFF_CHAIN = """
[problem]
name = "formula"
coordinates = ["x[6]"]
hamiltonian = "sum(i,1,6,p_x[i]^2/2) + 1000^2/2*(x[1]^2 + sum(i,1,5,(x[i+1]-x[i]-1)^2)) + sum(i,1,6,x[i]^4)/10"
initial = { q = [0.01, 1, 2.02, 3.01, 4, 5], p = [0, 0.5, -0.3, 0.2, 0, 1] }
[method]
name = "cg"
[run]
dt = 0.1
steps = 300
"""

CHAIN_AT_REST = """
[problem]
name = "formula"
coordinates = ["x[%(n)d]"]
hamiltonian = "sum(i,1,%(n)d,p_x[i]^2)/2 + sum(i,1,%(last)d,exp(x[i]-x[i+1])-1-(x[i]-x[i+1])) + exp(x[%(n)d]-x[1])-1-(x[%(n)d]-x[1])"
initial = { q = [%(q)s], p = [%(p)s] }
[method]
name = "cg"
[run]
dt = 0.1
steps = 100
"""

NO_ROUNDING_SCENARIO = """
[problem]
name = "formula"
coordinates = %s
parameters = { %s }
initial = { q = [%s], p = [%s] }
[method]
name = "cg"
[run]
dt = %s
steps = 1
"""
NO_ROUNDING = [
    ('["x", "y"]\nhamiltonian = "p_x^2/2 + p_y^2/(2*m) + x^2/2 + m*w^2*y^2/2"', "m = 1e-6, w = 20", "1, 1e-11", "0.3, 0", 0.1,
     ("cg(1,auto,iteration=fixed-point)",)),
    ('["x"]\nhamiltonian = "p_x^2/2 + sqrt(1 + (4*(x-1))^2) + e/x^12"', "e = 1e-16", "0.01", "1", 1, ("cg(1,5,iteration=fixed-point)",)),
    ('["x"]\nhamiltonian = "p_x^2/2 + 0.001*tanh(k*(x-1))"', "k = 1e10", "0.900001", "1", 0.1, ("cg(1,auto)", "cg(2,auto)")),
    ('["x"]\nhamiltonian = "p_x^2/2 + 1/x^12"', "", "100000000.01", "-1e10", 0.01, ("cg(1,auto)", "cg(2,auto)")),
]


class StiffSteps(CommandCase):
    def test_elements_of_any_degree_keep_the_energy(self):
        """Steps of h omega radians round the energy by h omega units: a walk, whatever the degree, the points and where
        Newton begins. More points than the degree of H needs would mend nothing of it."""
        epsilon = 2.0 ** -52
        for omega in (10, 316, 1000, 10000):
            self.write("stiff.toml", STIFF % omega)
            walk = 4 * math.sqrt(2000) * max(1, 0.1 * omega) * epsilon
            for degree in (1, 2, 3, 4, 6):
                for options in ("auto", f"{2 * degree}", "auto,max_iterations=100"):
                    found = json.loads(self.hamflow("run", "stiff.toml", "--set", f"method.name=cg({degree},{options})", "--out",
                                                    "none", "--quiet", "--json").stdout)
                    case = (omega, degree, options, found["energy"]["max_error"])
                    self.assertEqual(found["status"], "done", case)
                    self.assertLess(found["energy"]["max_error"], walk * found["energy"]["scale"], case)
                    self.assertNotEqual(found["certificate"]["drift"], "linear", case)

    def test_a_guess_that_rounding_hides_is_no_solution(self):
        """Forces of the explicit predictor round by more than the whole step: any correction of it looks like rounding."""
        for power, omega, method in ((8, 1000, "cg(2,auto)"), (8, 1000, "cg(2,16)"), (8, 300, "cg(2,16)"), (6, 10000, "cg(2,auto)"),
                                     (12, 300, "cg(2,auto)"), (4, 1000000, "cg(3,auto)"), (4, 100000, "cg(2,4)")):
            self.write("stiff.toml", (STIFF % omega).replace("x^4", f"x^{power}"))
            found = json.loads(self.hamflow("run", "stiff.toml", "--set", f"method.name={method}", "--set", "run.steps=40", "--set",
                                            "problem.initial={q=[1],p=[0.3]}", "--out", "none", "--quiet", "--json").stdout)
            self.assertEqual(found["status"], "done", (power, omega, method))
            self.assertLess(found["energy"]["max_error"], 4 * math.sqrt(40) * 0.1 * omega * 2.0 ** -52 * found["energy"]["scale"],
                            (power, omega, method))

    def test_nor_of_elements_of_degree_one(self):
        for hamiltonian in ("p_x^2/2 + %g^2*x^2/2 + x^4", "p_x^2/2 + %g^2*x^2/2 + x^4 + x*p_x"):
            for omega in (1e6, 1e7):
                for method in ("cg(1,2)", "cg(1,5)", "cg(1,auto)", "avf"):
                    self.write("stiff.toml", STIFF.replace("p_x^2/2 + %s^2*x^2/2 + x^4", hamiltonian % omega))
                    found = self.summary("stiff.toml", "--set", f"method.name={method}", "--set", "run.steps=40")
                    bound = 4 * math.sqrt(40) * 0.1 * omega * 2.0 ** -52 * found["energy"]["scale"]
                    self.assertLess(found["energy"]["max_error"], bound, (hamiltonian, omega, method))

    def test_auto_takes_as_many_points_as_stiff_steps_need(self):
        """Rules of points that are far from converged see different gains of energy, as noise does: but each sees the
        same along neighbouring steps. 24 points are enough for all of these."""
        for scenario, degree in ((STIFF_CHAIN, 4), (STIFF_CHAIN, 6), (STIFF_ORBIT, 3), (STIFF_ORBIT, 6)):
            error = {points: self.summary(self.write("stiff.toml", scenario), "--set",
                                          f"method.name=cg({degree},{points})")["energy"]["max_error"] for points in ("auto", 24)}
            self.assertLess(error["auto"], 16 * error[24], (scenario, degree))

    def test_small_oscillations_are_no_lack_of_points(self):
        """Forces that are differences of larger terms round by more than is estimated from themselves."""
        for potential, start in (("1/x^12 - 2/x^6", "1.01"), ("1/x^12 - 2/x^6", "1.0001"), ("exp(x) - x", "0.01"), ("exp(x) - x", "1e-5")):
            self.write("small.toml", STIFF.replace("%s^2*x^2/2 + x^4", potential).replace("[1]", f"[{start}]"))
            for method in ("cg(1,auto)", "cg(2,auto)", "cg(3,auto)", "cg(2,auto,iteration=fixed-point,max_iterations=100)"):
                found = self.summary("small.toml", "--set", f"method.name={method}", "--set", "run.steps=10000")
                self.assertLess(found["energy"]["max_error"], 64 * 2.0 ** -52 * found["energy"]["scale"], (potential, start, method))
                self.assertNotEqual(found["certificate"]["drift"], "linear", (potential, start, method))

    def test_fixed_points_of_small_oscillations_end(self):
        """exp(x) - x rounds by a unit of 1 however small x is, which neither the size of the force nor a move of x by a
        unit of its own tells."""
        self.write("small.toml", STIFF.replace("%s^2*x^2/2 + x^4", "exp(x) - x").replace("[1]", "[1e-5]"))
        for method, steps in (("cg(1,auto)", 4000), ("cg(2,auto)", 8000), ("cg(3,6)", 4000), ("gauss(3)", 8000)):
            found = self.summary("small.toml", "--set", f"method.name={method}", "--set", "method.iteration=fixed-point", "--set",
                                 f"run.steps={steps}")
            self.assertLess(found["energy"]["max_error"], 8 * 2.0 ** -52, method)  # H is 1

    def test_chains_that_are_nearly_at_rest(self):
        """Of many particles most are at rest: a few stand where the unit by which exp(x) rounds comes and goes. H is the
        small difference of terms of 1, of which neither its size nor the virial tells."""
        n = 300
        self.write("toda.toml", CHAIN_AT_REST % {"n": n, "last": n - 1, "q": ", ".join(["0.001"] + ["0"] * (n - 1)),
                                                 "p": ", ".join(["0"] * n)})
        for method, steps in (("cg(1,auto)", 40), ("cg(2,auto)", 40), ("cg(2,4)", 200), ("gauss(3)", 200), ("lobatto-3a-3b(3)", 160)):
            found = self.summary("toda.toml", "--set", f"method.name={method}", "--set", f"run.steps={steps}")
            error = found["energy"]["max_error"]
            if not method.startswith("lobatto"):  # of a look at 300 terms of 1, and a walk of their roundings
                self.assertLess(error, (n + 4 * math.sqrt(steps * n)) * 2.0 ** -52, method)
            self.assertLess(error, 1e-5 * found["energy"]["scale"], method)

    def test_steps_that_lead_nowhere_are_no_rounding(self):
        """A force of 10^26 throws the particle out of all that H knows: second differences of H are equal there too."""
        self.write("far.toml", STIFF.replace("%s^2*x^2/2 + x^4", "1/x^12 - 2/x^6").replace("[1]", "[0.01]"))
        for iteration in ("newton", "simplified", "fixed-point"):
            for method in ("cg(1,auto)", "cg(2,auto)", "cg(3,auto)", "cg(4,auto)"):
                tried = subprocess.run([HAMFLOW, "run", "far.toml", "--set", f"method.name={method}", "--set",
                                        f"method.iteration={iteration}", "--set", "run.dt=0.02", "--set", "run.steps=20", "--out",
                                        "none", "--json"], cwd=self.folder, capture_output=True, text=True, check=False)
                found = json.loads(tried.stdout)
                kept = found["energy"]["max_error"] < 1e-10 * found["energy"]["scale"]
                self.assertTrue(found["status"] == "failed" or kept, (iteration, method, found["energy"]))

    def test_what_is_no_rounding(self):
        """A mode that diverges beside one that converges, a cycle far below a first residual of 10^11, jumps behind which a
        step ends, the way into a singularity: none of them is a solution that rounding hides."""
        for hamiltonian, parameters, q, p, dt, methods in NO_ROUNDING:
            self.write("no.toml", NO_ROUNDING_SCENARIO % (hamiltonian, parameters, q, p, dt))
            for method in methods:
                for steps in (1, 30):
                    tried = subprocess.run([HAMFLOW, "run", "no.toml", "--set", f"method.name={method}", "--set",
                                            f"run.steps={steps}", "--out", "none", "--json"], cwd=self.folder,
                                           capture_output=True, text=True, check=False)
                    found = json.loads(tried.stdout)
                    self.assertEqual(found["status"], "failed", (hamiltonian, method, steps, found["energy"]))

    def test_a_tangent_of_old_leaves_no_drift(self):
        """A correction with it is far smaller than the residual of a stiff step, which is what changes the energy."""
        for omega in (100, 1000):
            for method in ("cg(2,4)", "cg(3,6)", "gauss(3)"):
                self.write("stiff.toml", STIFF % omega)
                settings = [f"method.name={method}", "method.max_iterations=100"]
                newton, simplified = (self.summary("stiff.toml", "--set", f"method.iteration={iteration}",
                                                   *(word for each in settings for word in ("--set", each)))
                                      for iteration in ("newton", "simplified"))
                error = simplified["energy"]["max_error"] - (newton["energy"]["max_error"] if method == "gauss(3)" else 0)
                self.assertLess(error, 4 * math.sqrt(2000) * 0.1 * omega * 2.0 ** -52 * newton["energy"]["scale"], (omega, method))
                self.assertNotEqual(simplified["certificate"]["drift"], "linear", (omega, method))

    def test_the_certificate_calls_no_stiff_run_irreversible(self):
        """A method that is reversible, off by less than sixteen times what rounding is estimated to explain."""
        for omega in (10, 100, 1000, 10000):
            for steps in (50, 2000):
                found = self.summary(self.write("stiff.toml", STIFF % omega), "--set", "method.name=cg(2,auto)", "--set",
                                     f"run.steps={steps}")["certificate"]["reversal_distance"]
                self.assertNotEqual(found["proves"], "not reversible", (omega, steps, found))

    def test_members_of_a_sweep_have_the_bits_of_single_runs(self):
        self.write("stiff.toml", STIFF.replace("%s^2", "w^2").replace("[method]", "parameters = { w = 1 }\n[method]") % ())
        values = ("10", "1000", "300000", "1e7")
        for method in ("cg(2,auto)", "cg(3,6)", "gauss(2)"):
            common = ("--set", f"method.name={method}", "--set", "run.steps=40", "--out", "none", "--quiet", "--json")
            rows = json.loads(self.hamflow("sweep", "stiff.toml", "--vary", "problem.parameters.w=" + ",".join(values),
                                           *common).stdout)["rows"]
            for w, row in zip(values, rows):
                one = json.loads(self.hamflow("run", "stiff.toml", "--set", f"problem.parameters.w={w}", *common).stdout)
                self.assertEqual(row["status"], one["status"], (method, w))
                self.assertEqual(row["final"], {key: one["final"][key] for key in row["final"]}, (method, w))


class WhatAStepThatFoundNoSolutionIsToldToTry(CommandCase):
    def hint(self, *settings, scenario="kink.toml"):
        self.write("kink.toml", KINK)
        sets = [word for setting in settings for word in ("--set", setting)]
        return self.summary(scenario, *sets, status=1)["error"]["hint"]

    def test_too_few_iterations(self):
        few = ("problem.hamiltonian=p^2/2-cos(x)", "method.max_iterations=1", "method.name=gauss(2)", "run.dt=1")
        self.assertIn("a larger method.max_iterations (the default is 15)", self.hint(*few))
        self.assertNotIn("max_iterations", self.hint())

    def test_a_kink(self):
        self.assertIn('method.name = "discrete-gradient"', self.hint())
        self.assertNotIn("discrete-gradient", self.hint("method.name=cg(1,3)", "method.tolerance=1e-300", "method.criterion=seed"))
        self.summary("kink.toml", "--set", "method.name=discrete-gradient")


def max_of(errors):
    return max(errors) if isinstance(errors, list) else errors


if __name__ == "__main__":
    unittest.main()

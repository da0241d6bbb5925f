"""Arithmetic beyond double: digits, texts, refusals."""
import json
import math
import unittest
from decimal import Decimal, getcontext

from command import CommandCase

import h5py

getcontext().prec = 70
KEPLER = "kepler.toml"


class Arithmetic(CommandCase):
    def run_with(self, *sets, status=0):
        return self.summary(KEPLER, *[x for s in sets for x in ("--set", s)], status=status)

    def test_more_digits_agree_with_each_other(self):
        common = ("method.name=stv4", "run.steps=50", "run.dt=\"1/20\"")
        wide = self.run_with(*common, "run.arithmetic=mp(45)")["final"]["q"]
        # Fifty steps of a smooth orbit: a few hundred roundings of numbers up to 3.
        for arithmetic, bound in (("double-double", "1e-28"), ("quad", "1e-30"), ("mp(60)", "1e-41")):
            narrow = self.run_with(*common, f"run.arithmetic={arithmetic}")["final"]["q"]
            for a, b in zip(wide, narrow):
                self.assertIsInstance(b, str)
                self.assertLess(abs(Decimal(a) - Decimal(b)), Decimal(bound))
                self.assertGreater(abs(Decimal(a) - Decimal(b)), 0, "two arithmetics cannot agree in every digit")

    def test_a_scenario_float_is_its_shortest_decimal(self):
        one = self.run_with("method.name=verlet", "run.steps=1", "run.dt=0.1", "run.arithmetic=quad")
        two = self.run_with("method.name=verlet", "run.steps=1", "run.dt=\"1/10\"", "run.arithmetic=quad")
        self.assertEqual(one["final"], two["final"])

    def test_energy_of_an_element_in_many_digits(self):
        for arithmetic, bound in (("double-double", 1e-30), ("quad", 1e-32), ("mp(50)", 1e-48)):
            for degree in (1, 2, 3):
                s = self.run_with("method.quadrature=\"auto\"", f"method.degree={degree}", "run.steps=20",
                                  "run.dt=0.01", f"run.arithmetic={arithmetic}")
                self.assertLess(s["energy"]["max_relative_error"], bound, arithmetic)
                self.assertGreater(s["certificate"]["energy_level"], 0)  # differences are formed in all digits

    def test_two_bodies_begin_with_all_digits(self):
        self.write("bodies.toml", '[problem]\nname = "central-force"\npotential = "kepler"\nbodies = ['
                   '{ mass = "0.1", position = ["0.1", 0, 0.5], velocity = [0, "0.1", 0] }, '
                   '{ mass = "0.3", position = ["1.4", 0, 0.5], velocity = [0, "0.4", "0.4"] }]\n'
                   '[method]\nname = "cg"\n[run]\ndt = "0.01"\nsteps = 0\n')
        # mu = 0.075, r = 1.3, v = 0.5 across it.
        for arithmetic, rounding in (("double-double", "1e-30"), ("quad", "1e-32"), ("mp(40)", "1e-39")):
            for coordinates, momentum in (("cartesian", "0.0375"), ("polar", "0.04875")):
                s = self.summary("bodies.toml", "--set", f"run.arithmetic={arithmetic}", "--set",
                                 f"problem.coordinates={coordinates}")["final"]
                for found, wanted in zip(s["q"] + s["p"], ("1.3", "0", "0", momentum)):
                    self.assertLess(abs(Decimal(found) - Decimal(wanted)), 4 * Decimal(rounding), (arithmetic, coordinates))

    def test_invariants_have_all_digits(self):
        common = ("method.name=verlet", "run.steps=20", "run.dt=0.05")
        exact = Decimal(3).sqrt()  # sqrt(2 mass k r_per r_aph/(r_per + r_aph))
        for arithmetic, rounding in (("double-double", "1e-31"), ("quad", "1e-33"), ("mp(50)", "1e-49")):
            s = self.run_with(*common, f"run.arithmetic={arithmetic}")
            momentum = s["invariants"]["angular_momentum"]
            for part in ("initial", "final"):  # a hundred roundings at most
                self.assertIsInstance(momentum[part], str)
                self.assertLess(abs(Decimal(momentum[part]) - exact), 100 * Decimal(rounding), arithmetic)
            of_texts = Decimal(rounding) / 50  # they read back as the same number, and are not it
            self.assertLessEqual(abs(Decimal(momentum["final"]) - Decimal(momentum["initial"])),
                                 Decimal(momentum["max_error"]) + of_texts)
        # No double is so small.
        s = self.run_with(*common, "run.arithmetic=mp(400)")
        error = s["invariants"]["angular_momentum"]["max_error"]
        self.assertLess(0, Decimal(error))
        self.assertLess(Decimal(error), Decimal("1e-397"))
        self.assertEqual(s["certificate"]["momentum_maps"]["angular_momentum"]["max_error"], error)
        self.assertEqual(s["certificate"]["momentum_maps"]["angular_momentum"]["conserved"], "to rounding")
        text = self.hamflow("run", KEPLER, *[x for s in (*common, "run.arithmetic=quad") for x in ("--set", s)], "--out", "none")
        self.assertRegex(text.stdout, "angular_momentum +1.7320508075688772935274463415")
        self.assertIsInstance(self.run_with(*common)["invariants"]["angular_momentum"]["initial"], float)

    def test_invariants_of_members_of_a_sweep_too(self):
        sweep = ("sweep", KEPLER, "--set", "method.name=verlet", "--set", "run.arithmetic=quad", "--vary", "run.steps=3,4", "--json")
        rows = json.loads(self.hamflow(*sweep, "--out", "none").stdout)["rows"]
        for row, steps in zip(rows, (3, 4), strict=True):
            alone = self.run_with("method.name=verlet", "run.arithmetic=quad", f"run.steps={steps}")
            self.assertEqual(row["invariants"], alone["invariants"])
            self.assertIsInstance(row["invariants"]["angular_momentum"]["final"], str)

    def test_tables_are_not_used_beyond_their_digits(self):
        result = self.hamflow("run", KEPLER, "--set", "method.name=kahan-li8", "--set", "run.arithmetic=mp(80)",
                              "--out", "none", status=2)
        self.assertIn("are known here to", result.stderr)
        s = self.run_with("method.name=stv4", "run.steps=3", "run.arithmetic=mp(80)")
        self.assertGreater(len(s["final"]["q"][0]), 75)
        # -1.17... has 39 places behind the point: significant digits count.
        self.run_with("method.name=yoshida6", "run.steps=3", "run.arithmetic=mp(40)")
        self.hamflow("run", KEPLER, "--set", "method.name=yoshida6", "--set", "run.arithmetic=mp(41)", "--out", "none",
                     status=2)

    def test_a_closed_form_in_double_judges_no_further_than_it_is_known(self):
        accurate = ("method={name='dop853',tolerance=1e-20}", "run.dt=0.1", "run.steps=2000", "run.arithmetic=quad")
        exact = self.run_with(*accurate)["exact"]
        self.assertLessEqual(exact["max_difference"], exact["uncertainty"])
        self.assertLess(exact["uncertainty"], 1e-12)
        text = self.hamflow("run", KEPLER, *[x for s in accurate for x in ("--set", s)], "--out", "none").stdout
        self.assertRegex(text, "from the closed form, which is only known to")
        coarse = self.run_with("method.name=stv4", "run.dt=0.1", "run.steps=2000", "run.arithmetic=quad")["exact"]
        self.assertGreater(coarse["max_difference"], coarse["uncertainty"])
        self.assertNotIn("uncertainty", self.run_with("method.name=stv4")["exact"])

    def test_the_closed_form_is_known_beyond_half_a_turn_too(self):
        (self.folder / "polar.toml").write_text(
            '[problem]\nname = "central-force"\npotential = "kepler"\nmass = 2\ncoordinates = "polar"\n'
            'orbit = { kind = "ellipse", r_per = 1, r_aph = 3 }\n[method]\nname = "cg"\ndegree = 4\n'
            '[run]\ndt = 0.1\nsteps = 300\narithmetic = "quad"\n')
        s = json.loads(self.hamflow("run", "polar.toml", "--out", "none", "--json").stdout)
        self.assertGreater(float(s["final"]["q"][1]), math.pi)
        self.assertLess(s["exact"]["uncertainty"], 1e-13)
        self.assertLessEqual(s["exact"]["max_difference"], s["exact"]["uncertainty"] + 1e-14)

    def test_numbers_of_parameters_are_rounded_too(self):
        # The closed form of the linear double pendulum solves with a mass matrix of condition 250.
        (self.folder / "linear.toml").write_text(
            '[problem]\nname = "double-pendulum"\nmodel = "linear"\nangles = "relative"\nmasses = [1, 3]\n'
            'half_lengths = [0.5, 2]\ninertias = [0.1, 0.7]\ninitial = { q = [0.1, -0.11], p = [0, 0] }\n'
            '[method]\nname = "taylor"\n[run]\ndt = 0.1\nsteps = 23\narithmetic = "mp(30)"\n')
        exact = json.loads(self.hamflow("run", "linear.toml", "--out", "none", "--json").stdout)["exact"]
        self.assertLessEqual(exact["max_difference"], exact["uncertainty"])
        self.assertLess(exact["uncertainty"], 1e-12)

    def test_the_orbit_is_that_of_the_run_and_not_of_its_start_in_double(self):
        """A kinetic energy of 10^9 at the pericentre: a rounding of double in the start moves r_max by 10^-7."""
        self.write("long.toml", '[problem]\nname = "central-force"\npotential = "kepler"\n'
                   'orbit = { kind = "ellipse", r_per = "1e-9", r_aph = "2" }\n'
                   '[method]\nname = "verlet"\n[run]\ndt = 1e-12\nsteps = 2\narithmetic = "mp(40)"\n')
        orbit = self.summary("long.toml")["orbit"]
        r_min, r_max = Decimal("1e-9"), Decimal(2)
        axis = (r_min + r_max) / 2
        pi = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
        for name, right in (("r_min", r_min), ("r_max", r_max), ("apsidal_angle", pi),
                            ("radial_period", 2 * pi * axis * axis.sqrt()),
                            ("circular_radius", 2 * r_min * r_max / (r_min + r_max))):
            self.assertLess(abs(Decimal(orbit[name]) - right), Decimal("1e-38") * right, name)
            self.assertGreaterEqual(orbit["uncertainty"][name], 1e-40 * float(right))
        self.assertGreater(orbit["uncertainty"]["r_max"], 1e-32)  # E is a difference of numbers of 10^9
        self.assertLess(orbit["uncertainty"]["r_max"], 1e-29)
        for arithmetic in ("double-double", "quad"):
            orbit = self.run_with("run.steps=3", f"run.arithmetic={arithmetic}")["orbit"]
            self.assertLess(abs(Decimal(orbit["r_max"]) - 3), Decimal("1e-29"))
        # A strength that follows from the start, in polar coordinates; and one that runs off.
        self.write("hooke.toml", '[problem]\nname = "central-force"\npotential = "hooke"\ncoordinates = "polar"\nmass = 3\n'
                   'orbit = { kind = "ellipse", r_per = 0.7, r_aph = 1.9, energy = 1.1 }\n'
                   '[method]\nname = "taylor"\n[run]\ndt = 0.1\nsteps = 2\narithmetic = "mp(30)"\n')
        orbit = self.summary("hooke.toml")["orbit"]
        self.assertLess(abs(Decimal(orbit["r_max"]) - Decimal("1.9")), Decimal("1e-28"))
        self.assertLess(abs(Decimal(orbit["apsidal_angle"]) - pi / 2), Decimal("1e-28"))
        self.write("off.toml", '[problem]\nname = "central-force"\npotential = "kepler"\n'
                   'orbit = { kind = "parabola", r_per = 1 }\n'
                   '[method]\nname = "verlet"\n[run]\ndt = 0.1\nsteps = 2\narithmetic = "mp(30)"\n')
        orbit = self.summary("off.toml")["orbit"]
        self.assertIsNone(orbit["r_max"])
        self.assertLess(abs(Decimal(orbit["r_min"]) - 1), Decimal("1e-28"))

    def test_sections_and_events_are_located_in_the_digits_of_the_run(self):
        """x = cos t: its zeros and the values 0.1, where 0.1 is the decimal."""
        self.write("o.toml", '''
[problem]
name = "formula"
coordinates = ["x"]
parameters = { c = "1/3" }
hamiltonian = "p_x^2/2 + x^2/2"
initial = { q = [1], p = [0] }
[method]
name = "taylor"
tolerance = 1e-58
[run]
dt = 0.25
steps = 40
arithmetic = "mp(60)"
section = { coordinate = "x", value = 0.1, direction = 0 }
events = [{ name = "third", expression = "x - c" }, { name = "stop", expression = "p_x - x*t", action = "stop" }]
''')
        self.hamflow("run", "o.toml", "--quiet")
        s = json.loads((self.folder / "o.run/summary.json").read_text())
        self.assertGreater(s["section"]["points"], 0)
        self.assertLess(s["section"]["max_residual"], 1e-58)
        stop = s["stopped_by"]
        self.assertIsInstance(stop["t"], str)
        residual = Decimal(stop["p"][0]) - Decimal(stop["q"][0]) * Decimal(stop["t"])
        self.assertLess(abs(residual), Decimal("1e-57"))
        with h5py.File(self.folder / "o.run/run.h5") as file:
            for group, value in (("section", Decimal("0.1")), ("events/user/third", Decimal(1) / 3)):
                rows = [Decimal(row[0].decode()) for row in file["digits/" + group + "/q"][()]]
                self.assertEqual(len(rows), len(file[group + "/t"][()]))
                for row, rounded in zip(rows, file[group + "/q"][()]):
                    self.assertLess(abs(row - value), Decimal("1e-58"), group)
                    self.assertEqual(float(row), rounded[0])
                self.assertEqual(file["digits/" + group + "/t"].shape, (len(rows),))

    def test_unknown_arithmetic(self):
        for name in ("quadd", "mp(x)", "mp(0)", "mp", "mp()", "mp(-3)", "mp(1e9)"):
            result = self.hamflow("run", KEPLER, "--set", f"run.arithmetic={name}", "--out", "none", status=2)
            self.assertIn("run.arithmetic: found", result.stderr)

    def test_csv_has_all_digits(self):
        self.hamflow("run", KEPLER, "--set", "method.name=verlet", "--set", "run.steps=2", "--set",
                     "run.arithmetic=quad", "--set", 'output.formats=["csv"]', "--out", "digits.run", "--quiet")
        with open(f"{self.folder}/digits.run/trajectory.csv") as file:
            last = file.read().strip().split("\n")[-1].split(",")
        self.assertGreater(len(last[2]), 30)


if __name__ == "__main__":
    unittest.main()

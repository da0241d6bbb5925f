"""The certificate of a run and of a method: what is known to drift, to walk, to stay and to come back."""

import json
import math
import unittest

from command import EXAMPLES, CommandCase

EPSILON = 2.0**-52


class Certificate(CommandCase):
    def certificate(self, method, *sets, steps=200000, dt=0.1, scenario="kepler.toml"):
        s = self.summary(scenario, "--set", f"method={method}", "--set", f"run.steps={steps}", "--set", f"run.dt={dt}",
                         *(x for pair in sets for x in ("--set", pair)))
        return s["certificate"], s

    def test_keys(self):
        c, s = self.certificate("{name='stv4'}", steps=4000)
        self.assertEqual(set(c), {"drift", "reason", "p_value", "sign_p_value", "growth_exponent",
                                  "growth_uncertainty", "blocks", "periods", "mean_increment", "mean_increment_error",
                                  "trend_not_excluded", "energy_level", "momentum_maps", "reversal_distance"})
        self.assertGreaterEqual(c["blocks"], 128)
        self.assertEqual(c["energy_level"], s["energy"]["max_relative_error"])
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["max_error"],
                         s["invariants"]["angular_momentum"]["max_error"])
        # One period of 2 pi sqrt(mass a^3/k) = 25.1, known to the place of a turn between two steps.
        self.assertAlmostEqual(c["periods"], 4000 * 0.1 / (2 * math.pi * 4), delta=0.2)
        back = c["reversal_distance"]
        self.assertEqual(set(back), {"steps", "share", "bounces", "distance", "relative", "bit_exact", "proves", "reason"})
        self.assertAlmostEqual(back["steps"], 251, delta=4)
        self.assertEqual(back["share"], back["steps"] / 4000)
        self.assertEqual(back["bounces"], 0)
        self.assertIn("certificate", self.hamflow("run", "kepler.toml", "--out", "none").stdout)
        short = self.hamflow("run", "kepler.toml", "--set", "run.steps=20", "--out", "none").stdout
        self.assertIn("reversal tested over 20 steps (100 % of the run)", short)
        self.hamflow("run", "kepler.toml", "--quiet")
        written = json.loads((self.folder / "kepler.run" / "summary.json").read_text())
        self.assertEqual(written["certificate"]["blocks"], 200)

    def test_symplectic_methods_are_bounded(self):
        for method in ("euler-a", "verlet", "stv4", "yoshida6"):
            c, _ = self.certificate(f"{{name='{method}'}}")
            self.assertEqual(c["drift"], "bounded", method)
            self.assertLess(c["growth_exponent"], 0.3, method)
            self.assertGreater(c["p_value"], 1e-4, method)
            self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "to rounding", method)

    def test_the_rest_drifts(self):
        self.write("pendulum.toml", "[problem]\nname='pendulum'\ninitial={q=[2.5],p=[0]}\n[method]\nname='rk4'\n"
                   "[run]\ndt=0.1\nsteps=1\n")
        for scenario in ("kepler.toml", "pendulum.toml"):
            for method in ("euler", "rk4"):
                c, _ = self.certificate(f"{{name='{method}'}}", scenario=scenario)
                self.assertEqual(c["drift"], "linear", (scenario, method))
        c, _ = self.certificate("{name='rk4'}")
        self.assertGreater(c["growth_exponent"], 0.9)
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "not")

    def test_rounding_alone_walks(self):
        # With dt = 5e-4 stv4's own error, some 1e-6 (dt/0.1)^4 of the scale, is 6e-16; 10^6 steps are 20 periods.
        c, s = self.certificate("{name='stv4'}", steps=1000000, dt=5e-4)
        self.assertEqual(c["drift"], "random walk")
        self.assertLess(c["energy_level"], 16 * EPSILON * s["steps"] ** 0.5)

    def test_the_element_loses_angular_momentum_in_cartesian_coordinates(self):
        c, _ = self.certificate("{name='cg', quadrature=5}", steps=20000)
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "not")
        self.assertEqual(c["drift"], "random walk")  # at rounding: 2.5e-16 of the scale
        polar, _ = self.certificate("{name='cg', quadrature=5}", "problem.coordinates=polar", steps=2000)
        self.assertEqual(polar["momentum_maps"]["angular_momentum"],
                         {"max_error": 0, "relative": 0, "conserved": "to rounding",
                          "rounding": polar["momentum_maps"]["angular_momentum"]["rounding"]})

    def test_return(self):
        exact, _ = self.certificate("{name='stv4'}", "run.arithmetic=lattice", steps=20000)
        back = exact["reversal_distance"]
        self.assertEqual((back["distance"], back["bit_exact"], back["proves"]), (0, True, "every bit"))
        near, _ = self.certificate("{name='stv4'}", steps=20000)
        self.assertFalse(near["reversal_distance"]["bit_exact"])
        # 1500 kicks and drifts there and back, each rounded once; a perturbation grows like the time, 25, at most 25-fold.
        self.assertLess(near["reversal_distance"]["relative"], 1500 * EPSILON * 25)
        self.assertEqual(near["reversal_distance"]["proves"], "reversible to rounding")
        far, _ = self.certificate("{name='rk4'}", steps=20000)
        self.assertGreater(far["reversal_distance"]["relative"], 1e-8)
        self.assertEqual(far["reversal_distance"]["proves"], "not reversible")

    def test_what_a_reversal_proves(self):
        def proves(method, *sets, **keys):
            back = self.certificate(method, *sets, **keys)[0]["reversal_distance"]
            return back["proves"], back["steps"], back["reason"]

        # One step there and back: rk4 shows its defect where it has one, and is never called reversible.
        self.assertEqual(proves("{name='rk4'}", steps=1)[:2], ("not reversible", 1))
        found, steps, reason = proves("{name='rk4'}", steps=1, dt=1e-4)
        self.assertEqual((found, steps), ("nothing", 1))
        self.assertIn("rk4 is not reversible", reason)
        for steps in (1, 20, 5000):
            self.assertEqual(proves("{name='verlet'}", steps=steps)[0], "reversible to rounding")
            self.assertEqual(proves("{name='euler'}", steps=steps)[0], "not reversible")
        # At least a period or 1000 steps; what was left out is said.
        self.assertEqual(proves("{name='stv4'}", steps=100000, dt=1e-3)[1], 1000)
        self.assertIn("99000 steps of the run were not tested", proves("{name='stv4'}", steps=100000, dt=1e-3)[2])
        self.assertEqual(proves("{name='stv4'}", steps=300000)[1], 1500)  # 1/200
        # An iteration that stops early is not reversible, and a tolerance of its own makes dop853 none.
        self.assertEqual(proves("{name='dop853', tolerance=1e-5}", "run.dt=3")[0], "not reversible")
        # Beyond double the bound is that of the arithmetic.
        self.assertEqual(proves("{name='stv4'}", "run.arithmetic=quad", steps=500)[0], "reversible to rounding")
        self.assertEqual(proves("{name='rk4'}", "run.arithmetic=quad", steps=1, dt=1e-4)[0], "not reversible")

    def test_chaos_and_magnetic_fields_prove_nothing(self):
        s = self.summary(str(EXAMPLES / "magnetic.toml"))
        back = s["certificate"]["reversal_distance"]
        self.assertEqual(back["proves"], "nothing")
        self.assertIn("H(q, -p) differs from H(q, p)", back["reason"])
        # 1/200 of the run is a time of 300, in which neighbours part by a factor of exp(0.05 * 300) and more.
        self.write("chaos.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0,-0.15],p=[0.54,0.1]}\n"
                   "[method]\nname='verlet'\n[run]\ndt=0.3\nsteps=200000\n")
        back = self.summary("chaos.toml")["certificate"]["reversal_distance"]
        self.assertEqual((back["proves"], back["steps"]), ("nothing", 1000))
        self.assertIn("separate by a factor", back["reason"])

    def test_short_runs_have_no_class(self):
        for steps in (0, 1, 31):
            c, _ = self.certificate("{name='stv4'}", steps=steps)
            self.assertEqual(c["drift"], "undecided", steps)
            self.assertIn("32", c["reason"])
            self.assertIsNone(c["p_value"])
            self.assertEqual(c["reversal_distance"] is None, steps == 0)
        c, _ = self.certificate("{name='stv4'}", steps=32)  # an eighth of a period
        self.assertEqual(c["drift"], "undecided")
        self.assertIsNotNone(c["p_value"])

    def test_a_run_of_no_steps_has_kept_nothing(self):
        s = self.summary("kepler.toml", "--set", "run.steps=0")
        self.assertIsNone(s["certificate"]["momentum_maps"]["angular_momentum"]["conserved"])
        self.assertIsNone(s["certificate"]["reversal_distance"])

    def test_a_reason_contradicts_no_number(self):
        # 1.99 periods are too few, and are not called 2.
        own = ["problem.mass=1"]
        c, _ = self.certificate("{name='rk4'}", *own, steps=356)
        self.assertLess(c["periods"], 2)
        self.assertGreater(c["periods"], 1.985)
        self.assertRegex(c["reason"], r"^1\.98 periods")
        # A step there and back that is off by nothing but the sign of a zero.
        back = self.certificate("{name='stv4'}", *own, steps=1)[0]["reversal_distance"]
        self.assertEqual((back["distance"], back["bit_exact"]), (0, False))
        self.assertIn("every digit of q and p returned, but not the sign of a zero", back["reason"])

    def test_no_class_without_evidence(self):
        """The short runs that were classified wrongly once, and some that no one can classify."""
        for method, periods, allowed in (("rk4", 1, {"undecided"}), ("rk4", 2, {"undecided", "linear"}),
                                         ("rk4", 3, {"undecided", "linear"}), ("rk4", 5, {"undecided", "linear"}),
                                         ("rk4", 20, {"undecided", "linear"}), ("verlet", 1, {"undecided"}),
                                         ("verlet", 20, {"bounded"}), ("rk4", 100, {"linear"})):
            c, _ = self.certificate(f"{{name='{method}'}}", steps=round(periods * 251.3))
            self.assertIn(c["drift"], allowed, (method, periods))
        lennard = ("[problem]\nname='lennard-jones-oscillator'\ninitial={{q=[{}],p=[0]}}\n[method]\nname='{}'\n"
                   "[run]\ndt={}\nsteps={}\n")
        self.write("lj.toml", lennard.format(1.3, "stv4", 0.01, 100))
        self.assertEqual(self.summary("lj.toml")["certificate"]["drift"], "undecided")
        for number in range(24):
            steps = 33 + 11 * number
            self.write("p.toml", f"[problem]\nname='pendulum'\ninitial={{q=[{0.3 + 0.1 * number}],p=[0]}}\n"
                       f"[method]\nname='verlet'\n[run]\ndt={0.05 + 0.04 * (number % 7)}\nsteps={steps}\n")
            self.assertIn(self.summary("p.toml")["certificate"]["drift"], ("bounded", "undecided"), number)
        # A fall and a fly-by: nothing turns back, or once.
        self.write("fall.toml", "[problem]\nname='free-fall'\ninitial={q=[0],p=[1]}\n[method]\nname='euler'\n"
                   "[run]\ndt=0.01\nsteps=1000\n")
        c = self.summary("fall.toml")["certificate"]
        self.assertEqual(c["drift"], "undecided")
        # A planet that is thrown out, with ten times its energy.
        self.write("thrown.toml", "[problem]\nname='central-force'\npotential='kepler'\nmass=1\n"
                   "initial={q=[1.9,0],p=[0,0.22941573387056174]}\n[method]\nname='cg'\nquadrature=4\n"
                   "[run]\ndt=0.2\nsteps=20000\n")
        c = self.summary("thrown.toml")["certificate"]
        self.assertGreater(c["energy_level"], 1)
        self.assertNotEqual(c["drift"], "bounded")

    def formula(self, hamiltonian, q, p, steps, method="verlet", coordinates=("x", "y"), more=""):
        self.write("formula.toml", f"[problem]\nname='formula'\ncoordinates={list(coordinates)}\n"
                   f"hamiltonian='{hamiltonian}'\ninitial={{q={q},p={p}}}\n[method]\nname='{method}'\n"
                   f"[run]\ndt=0.05\nsteps={steps}\n{more}")
        return self.summary("formula.toml")["certificate"]

    def test_oscillations_that_are_over_count_as_long_as_they_lasted(self):
        # A spring that becomes weaker and lets go: a few oscillations at first, then a free flight.
        spring = "(p_x^2+p_y^2)/2+x^2/2*exp(-y^2/400)"
        for speed, steps, most in ((2, 40000, 3), (0.8, 40000, 8), (0.2, 100000, 30)):
            for method in ("verlet", "rk4"):
                c = self.formula(spring, [0.3, 0], [0, speed], steps, method)
                self.assertLess(c["periods"], most, (speed, method))
                self.assertEqual(c["drift"], "undecided", (speed, method, c["reason"]))
        for decay, most in (("exp(-t/20)", 9), ("(1-tanh((t-20)/5))/2", 6)):
            c = self.formula(f"p_x^2/2+x^2/2*{decay}", [1], [0], 40000, coordinates=("x",))
            self.assertLess(c["periods"], most, decay)
            self.assertEqual(c["drift"], "undecided", c["reason"])
            self.assertIn("no turning point in the last 9", c["reason"])
        # A planet that is thrown out within some steps.
        self.write("thrown.toml", "[problem]\nname='central-force'\npotential='kepler'\n"
                   "orbit={kind='ellipse',r_per=0.1,r_aph=1.9}\n[method]\nname='verlet'\n"
                   "step_control='reversible'\n[run]\ndt=0.01\nsteps=20000\n")
        c = self.summary("thrown.toml")["certificate"]
        self.assertLess(c["periods"] or 0, 4)
        self.assertEqual(c["drift"], "undecided", c["reason"])

    def test_a_quarter_of_a_slow_oscillation_of_a_symplectic_method_is_no_drift(self):
        slow = ("let X=(x-y)/sqrt(2), Y=(x+y-2*z)/sqrt(6), Z=(x+y+z)/sqrt(3) in (p_x^2+p_y^2+p_z^2)/2"
                "+(X^2+Y^2)/2*(1+0.2*Z)^2-0.2*Z+0.0001*Z^2/2")
        start = ([0.7071067811865475, -0.7071067811865475, 0.0],
                 [0.4111350418098112, 0.4111350418098112, -0.813609829581778])
        c = self.formula(slow, *start, 2500, "stv4", ("x", "y", "z"))
        self.assertLess(c["p_value"], 1e-20)
        self.assertEqual(c["drift"], "undecided")
        self.assertIn("symplectic", c["reason"])

    def test_a_revolution_of_an_eccentric_orbit_is_one_oscillation(self):
        """The momenta have a peak at each pericentre that samples far apart miss."""
        for e in (0.5, 0.9, 0.95):
            start = f"q=[{1 + e}, 0.0], p=[0.0, {math.sqrt((1 - e) / (1 + e))!r}]"
            self.write("eccentric.toml", "[problem]\nname='central-force'\npotential='kepler'\nk=1.0\nmass=1.0\n"
                       f"initial={{{start}}}\n[method]\nname='stv4'\n[run]\ndt={2 * math.pi / 3000!r}\nsteps=3000\n")
            for revolutions in (5, 50, 200):
                c = self.summary("eccentric.toml", "--set", f"run.steps={3000 * revolutions}")["certificate"]
                self.assertAlmostEqual(c["periods"], revolutions, delta=1 + 0.02 * revolutions, msg=e)

    def test_the_energy_of_a_very_eccentric_orbit_has_its_period(self):
        """Its error has a peak at each pericentre that is shorter than a block."""
        for e, revolutions in ((0.95, 5), (0.99, 5), (0.99, 20)):
            steps = round(40 * revolutions * (1 - e)**-1.5)
            self.write("eccentric.toml", "[problem]\nname='central-force'\npotential='kepler'\nk=1.0\nmass=1.0\n"
                       f"initial={{q=[{1 + e}, 0.0], p=[0.0, {math.sqrt((1 - e) / (1 + e))!r}]}}\n"
                       f"[method]\nname='stv4'\n[run]\ndt={2 * math.pi * revolutions / steps!r}\nsteps={steps}\n")
            c = self.summary("eccentric.toml")["certificate"]
            self.assertAlmostEqual(c["periods"], revolutions, delta=1 + 0.02 * revolutions, msg=(e, revolutions))

    def test_the_roundings_of_a_rotor_grow_with_its_angle(self):
        """Over 16 times as many steps the errors are 50 and 9 times as large."""
        for method, p, dt, steps in (("kahan-li8", 4.604369147280964, 0.03320944020708258, 3594),
                                     ("yoshida6", 2.551381735181486, 0.02039042205899522, 3542)):
            for problem in ("name='pendulum'", "name='formula'\ncoordinates=['a']\nhamiltonian='p_a^2/2-cos(a)'"):
                self.write("rotor.toml", f"[problem]\n{problem}\ninitial={{q=[0],p=[{p}]}}\n"
                           f"[method]\nname='{method}'\n[run]\ndt={dt}\nsteps={steps}\n")
                c = self.summary("rotor.toml")["certificate"]
                self.assertEqual(c["drift"], "undecided", (method, problem, c["reason"]))

    def test_a_walk_says_which_trend_it_may_hide(self):
        c, s = self.certificate("{name='cg', quadrature=12}", steps=20000)
        self.assertEqual(c["drift"], "random walk", c["reason"])
        self.assertIn("in 20000 steps a trend below", c["reason"])
        self.assertGreater(c["trend_not_excluded"], 0)
        self.assertLess(20000 * c["trend_not_excluded"], 100 * s["energy"]["max_relative_error"])

    def test_errors_of_summed_roundings_are_not_bounded(self):
        """Over 16 times as many steps the error is 85 times as large."""
        self.write("cancel.toml", "[problem]\nname='formula'\nhamiltonian='s + 0.3*sqrt(2*s)*cos(th)'\n"
                   "coordinates=['th']\nmomenta=['s']\ninitial={q=['pi'], p=[0.1806005]}\n"
                   "[method]\nname='discrete-gradient'\n[run]\ndt=0.01\nsteps=100000\n")
        self.assertNotEqual(self.summary("cancel.toml")["certificate"]["drift"], "bounded")

    def test_the_units_of_a_lattice_are_its_rounding(self):
        self.write("coarse.toml", "[problem]\nname='pendulum'\ninitial={q=[1],p=[0]}\n[method]\nname='kahan-li8'\n"
                   "[run]\ndt=0.05\nsteps=40000\narithmetic='lattice'\n")
        for unit in (52, 42, 32, 22):
            lattice = f"run.lattice={{position='2^-{unit}',momentum='2^-{unit}'}}"
            c = self.summary("coarse.toml", "--set", lattice)["certificate"]
            self.assertEqual(c["drift"], "random walk", (unit, c["reason"]))

    def test_an_energy_that_is_0_at_the_start(self):
        for problem in ("name='pendulum'\ninitial={q=['pi/2'],p=[0]}",
                        "name='duffing'\nalpha=-1\nbeta=1\ninitial={q=['sqrt(2)'],p=[0]}",
                        "name='formula'\ncoordinates=['x']\nhamiltonian='p_x^2/2+x^2/2-0.5'\ninitial={q=[1],p=[0]}"):
            self.write("level.toml", f"[problem]\n{problem}\n[method]\nname='verlet'\n[run]\ndt=0.1\nsteps=4000\n")
            s = self.summary("level.toml")
            c = s["certificate"]
            self.assertEqual(c["drift"], "bounded", (problem, c["reason"]))
            # The error is a part of what the motion exchanges between T and V.
            self.assertGreater(s["energy"]["scale"], 0.1, problem)
            self.assertGreater(s["energy"]["max_error"], 0)
            self.assertEqual(s["energy"]["max_relative_error"], s["energy"]["max_error"] / s["energy"]["scale"])
            self.assertEqual(c["energy_level"], s["energy"]["max_relative_error"], problem)
        # Errors of rounding are beside the energies that cancel.
        c = self.summary("level.toml", "--set", "method={name='cg', quadrature=12}")["certificate"]
        self.assertNotIn("above the scale", c["reason"])

    def test_located_walls_make_the_energy_of_a_splitting_walk(self):
        self.write("box.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0.1,0.2],p=[0.1,0]}\n"
                   "walls=[{coordinate='q1',min=-0.1,max=0.15}]\n[method]\nname='stv4'\n[run]\ndt=0.05\nsteps=100000\n")
        for rule in ("event", "reject"):
            c = self.summary("box.toml", "--set", f"problem.wall_rule={rule}")["certificate"]
            self.assertEqual(c["drift"], "undecided", (rule, c["reason"]))

    def test_more_digits(self):
        """Energies, differences and statistics in the arithmetic of the run: what doubles do not see."""
        for arithmetic in ("quad", "double-double"):
            c, _ = self.certificate("{name='dop853', tolerance=1e-17}", f"run.arithmetic={arithmetic}", steps=10000)
            self.assertEqual(c["drift"], "linear", c["reason"])
            self.assertLess(c["energy_level"], 1e-16)
            self.assertGreater(abs(c["mean_increment"]), 4 * c["mean_increment_error"])
            self.assertLess(abs(c["mean_increment"]), 1e-18)
        c, _ = self.certificate("{name='cg', quadrature=16}", "run.arithmetic=mp(40)", steps=40)
        self.assertLess(c["energy_level"], 1e-37)
        self.assertGreater(c["energy_level"], 0)
        self.assertLess(c["momentum_maps"]["angular_momentum"]["rounding"], 1e-35)
        # Too small for a double: a text.
        c, _ = self.certificate("{name='cg', quadrature=64}", "run.arithmetic=mp(340)", steps=2, dt=1e-6)
        self.assertRegex(c["energy_level"], "e-3[2-4][0-9]$")
        energy = self.summary("kepler.toml", "--set", "method={name='cg', quadrature=64}", "--set", "run.arithmetic=mp(340)",
                              "--set", "run.steps=2", "--set", "run.dt=1e-6")["energy"]
        self.assertEqual(energy["max_relative_error"], c["energy_level"])
        self.assertRegex(energy["max_error"], "e-3[2-4][0-9]$")
        c, _ = self.certificate("{name='verlet'}", "run.arithmetic=mp(400)", steps=40)
        self.assertIsInstance(c["reversal_distance"]["distance"], str)
        self.assertIsInstance(c["momentum_maps"]["angular_momentum"]["rounding"], str)
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "to rounding")

    def test_it_watches_and_changes_nothing(self):
        # Recording at every step takes one step at a time, as the certificate does at first.
        a = self.summary("kepler.toml", "--set", "method={name='stv4'}", "--set", "run.steps=5000")
        self.hamflow("run", "kepler.toml", "--quiet", "--set", "method={name='stv4'}", "--set", "run.steps=5000", "--set",
                     "run.record_every=1")
        b = json.loads((self.folder / "kepler.run" / "summary.json").read_text())
        for key in ("final", "energy", "invariants", "evaluations", "certificate"):
            self.assertEqual(a[key], b[key], key)

    def test_resumed_runs_have_the_certificate_of_whole_ones(self):
        self.write("stv4.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0.1,-0.2],p=[0.3,0.1]}\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=5000\n")
        self.hamflow("run", "stv4.toml", "--quiet", "--set", "run.steps=777")
        part = json.loads(self.hamflow("run", "stv4.toml", "--json", "--quiet", "--resume").stdout)
        self.assertEqual(part["certificate"], self.summary("stv4.toml")["certificate"])

    def test_failed_runs_are_certified_as_far_as_they_went(self):
        s = self.summary("kepler.toml", "--set", "problem={name='henon-heiles',initial={q=[3,3],p=[0,0]}}", "--set",
                         "method={name='verlet'}", "--set", "run.dt=0.001", "--set", "run.steps=100000", status=1)
        self.assertIn("certificate", s)
        self.assertEqual(s["certificate"]["momentum_maps"], {})

    def test_momentum_maps_of_several_bodies(self):
        s = self.summary(str(EXAMPLES / "figure_eight.toml"), "--set", "method={name='stv4'}")
        maps = s["certificate"]["momentum_maps"]
        self.assertEqual(set(maps), {"angular_momentum", "linear_momentum", "centre_of_mass"})
        for name, found in maps.items():
            self.assertEqual(found["conserved"], "to rounding", name)
        # Judged by what the problem declares of its terms, whether or not it has masses among its parameters.
        s = self.summary(str(EXAMPLES / "solar_system.toml"))
        maps = s["certificate"]["momentum_maps"]
        self.assertEqual({name: found["conserved"] for name, found in maps.items()},
                         {"angular_momentum": "to rounding", "linear_momentum": "to rounding",
                          "centre_of_mass": "to rounding"})

    def test_of_methods(self):
        answer = json.loads(self.hamflow("verify", "stv4", "rk4", "cg(1,5)", "--json").stdout)
        found = {m["method"]: m["certificate"] for m in answer["methods"]}
        kept = {method: {(m["problem"], m["name"]): m["conserved"] for m in c["momentum_maps"]}
                for method, c in found.items()}
        self.assertEqual(set(kept["stv4"].values()), {"to rounding"})
        for method in ("rk4", "cg(1,5)"):
            self.assertEqual(kept[method]["central-force", "angular_momentum"], "not")
            self.assertEqual(kept[method]["n-body", "angular_momentum"], "not")
            self.assertEqual(kept[method]["n-body", "linear_momentum"], "to rounding")
        self.assertEqual({m: c["drift"] for m, c in found.items()},
                         {"stv4": "bounded", "rk4": "linear", "cg(1,5)": "random walk"})
        self.assertLess(found["stv4"]["reversal_distance"][0]["relative"], 1e-11)
        self.assertEqual({m: {r["proves"] for r in c["reversal_distance"]} for m, c in found.items()},
                         {"stv4": {"reversible to rounding"}, "rk4": {"not reversible"},
                          "cg(1,5)": {"reversible to rounding"}})
        self.assertGreater(found["rk4"]["reversal_distance"][0]["relative"], 1e-6)
        self.assertIn("certificates", self.hamflow("verify", "verlet").stdout)

    def test_of_methods_on_a_problem_of_choice(self):
        answer = json.loads(self.hamflow("verify", "rk4", "--problem", "magnetic", "--json").stdout)
        maps = answer["methods"][0]["certificate"]["momentum_maps"]
        kept = {(m["problem"], m["name"]): m["conserved"] for m in maps}
        self.assertEqual(kept["magnetic", "parallel_momentum"], "to rounding")
        self.assertEqual(kept["magnetic", "angular_momentum"], "not")
        # Without a variant the problem is the one of a scenario, or the first that the method can run on.
        self.hamflow("verify", "stv4", "cg(1,5)", "--problem", "double-pendulum", "--json")

    def proof(self, text, *sets):
        self.write("one.toml", text)
        return self.summary("one.toml", *sets)["certificate"]["reversal_distance"]

    def test_evenness_is_not_asked_where_terms_vanish(self):
        """Without angular momentum x p_y - y p_x is 0 along the whole motion, and H(q, -p) = H(q, p) at its states."""
        run = "[method]\nname='gauss'\nstages=4\n[run]\ndt=0.0957883\nsteps=600\n"
        magnetic = "[problem]\nname='magnetic'\ninitial={q=[0,0,0], v=[0,1,0]}\n" + run
        foucault = ("[problem]\nname='formula'\ncoordinates=['x','y']\nhamiltonian='(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 "
                    "- 0.1*(x*p_y - y*p_x)'\ninitial={q=[1,0], p=[0,0]}\n" + run)
        for text in (magnetic, foucault):
            back = self.proof(text)
            self.assertEqual(back["proves"], "nothing", back["reason"])
            self.assertIn("H(q, -p) differs from H(q, p)", back["reason"])

    def test_h_that_has_no_value_there_and_back(self):
        back = self.proof("[problem]\nname='formula'\ncoordinates=['x']\nmomenta=['p']\nhamiltonian='p^1.5 + x^2/2'\n"
                          "initial={q=[0.1], p=[2]}\n[method]\nname='gauss'\n[run]\ndt=0.01\nsteps=50\n")
        self.assertEqual(back["proves"], "nothing")
        self.assertIn("H is not defined at (q, -p)", back["reason"])

    def test_units_change_no_verdict(self):
        """One ellipse in units that differ by powers of two: the same steps, the same relative figures to the last bit."""
        def proof(length, mass, time):
            return self.proof(f"[problem]\nname='central-force'\npotential='kepler'\nk={mass * length**3 / time**2!r}\n"
                              f"mass={mass!r}\ninitial={{q=[{length!r}, 0], p=[0, {0.75 * mass * length / time!r}]}}\n"
                              f"[method]\nname='stv4'\n[run]\ndt={time / 16!r}\nsteps=2000\n")
        natural = proof(1.0, 1.0, 1.0)
        self.assertEqual(natural["proves"], "reversible to rounding", natural["reason"])
        for units in ((2.0**40, 2.0**20, 2.0**30), (2.0**-40, 2.0**60, 2.0**-20)):
            other = proof(*units)
            self.assertEqual((other["proves"], other["relative"], other["bit_exact"]),
                             (natural["proves"], natural["relative"], natural["bit_exact"]))
        proton = self.proof("[problem]\nname='magnetic'\nmass=1.67262192e-27\ncharge=1.602176634e-19\nfield=[0,0,1e-8]\n"
                            "initial={q=[0,0,0], v=[0,1e5,0]}\n[method]\nname='gauss'\nstages=4\n[run]\ndt=0.1\nsteps=600\n")
        self.assertEqual(proton["proves"], "nothing")
        self.assertGreater(proton["relative"], 0.1)

    def test_what_is_not_chaotic_does_not_part(self):
        """Bounces at the ends of steps, and a body that all others ignore."""
        free = self.proof("[problem]\nname='formula'\ncoordinates=['x','y']\nhamiltonian='(p_x^2 + p_y^2)/2'\n"
                          "initial={q=[1,1.3], p=[1,0.7]}\nwalls=[{coordinate='x',min=0,max=4.5},"
                          "{coordinate='y',min=0,max=4.5}]\n[method]\nname='stv4'\n[run]\ndt=0.1\nt_end=900\n")
        self.assertEqual(free["proves"], "reversible to rounding", free["reason"])
        tiny = self.proof("[problem]\nname='n-body'\nmasses=[0.7,0.3,1e-20]\n"
                          "initial={q=[0.3,0,-0.7,0,1.5,0], p=[0,0.21,0,-0.21,0,0.8e-20]}\n"
                          "[method]\nname='stv4'\n[run]\ndt=0.01\nsteps=20000\n")
        self.assertEqual(tiny["proves"], "reversible to rounding", tiny["reason"])

    def test_copies_of_the_state_are_moved_apart(self):
        """tao4 is reversible; a rounding grows faster between its copies than between two states of one."""
        text = ("[problem]\nname='formula'\ncoordinates=['x','y']\n"
                "hamiltonian='-log((x-y)^2 + (p_x-p_y)^2)/(4*pi)'\ninitial={q=[0,0.01], p=[0,0]}\n"
                "[method]\nname='tao4'\n[run]\ndt=1e-4\nsteps=10000\n")
        back = self.proof(text)
        self.assertEqual(back["proves"], "reversible to rounding", back["reason"])
        kinds = [w["message"] for w in self.summary("one.toml", "--set", "run.dt=0.02", "--set", "run.steps=10")["warnings"]]
        self.assertTrue(any("omega dt = 0.4 is above 1/4" in text for text in kinds), kinds)

    def test_far_from_the_origin_rounding_is_that_of_the_coordinates(self):
        """Two masses on a spring, 1e9 away: a rounding of q moves H by eps |q| |dH/dq|, far more than by eps |H|."""
        for method in ("cg", "gauss", "kahan-li8"):
            self.write("far.toml", "[problem]\nname='formula'\ncoordinates=['a','b']\nhamiltonian='(p_a^2 + p_b^2)/2 "
                       "+ (a - b - 1)^2/2'\ninitial={q=['1e9 + 1.5','1e9'], p=[0.1,-0.2]}\n"
                       f"[method]\nname='{method}'\n[run]\ndt=0.1\nsteps=100000\n")
            c = self.summary("far.toml")["certificate"]
            self.assertEqual(c["drift"], "random walk", c["reason"])

    def test_unlike_masses_part_unlike_in_every_direction(self):
        """Moves of one size but in two directions part by factors of 6 in the solar system: no force jumps there, and
        a step of 50 days of rk4 is not reversible by far more than rounding becomes; verlet's is."""
        self.write("planets.toml", """
            [problem]
            name = "solar-system"
            [method]
            name = "rk4"
            [run]
            dt = 50
            steps = 20000
            """)
        found = self.summary("planets.toml")["certificate"]["reversal_distance"]
        self.assertEqual(found["proves"], "not reversible", found["reason"])
        self.assertGreater(found["relative"], 1e-6)
        found = self.summary("planets.toml", "--set", "method.name=verlet")["certificate"]["reversal_distance"]
        self.assertEqual(found["proves"], "reversible to rounding", found["reason"])

    def test_beside_what_a_run_has_blown_up_to_nothing_is_a_rounding(self):
        """A step without a solution at the end makes 1e87 of an energy of 23."""
        self.write("blown.toml", """[problem]
name = "double-pendulum"
initial = { q = [-1.0944391528208335, -0.3810951557811545], p = [0.0, 0.0] }
[method]
name = "cg"
quadrature = 1
[run]
dt = 0.04304626556104385
steps = 7031
""")
        summary = self.summary("blown.toml", status=1)
        self.assertGreater(summary["energy"]["max_relative_error"], 1e80)
        self.assertEqual(summary["certificate"]["drift"], "undecided")
        self.assertIn("above the scale", summary["certificate"]["reason"])

    def test_its_steps_are_bounded_by_counted_work(self):
        """A step of many bodies is long: of 1000 fewer are taken again, and the same everywhere."""
        bodies = 240
        masses = ", ".join(["1e-3"] * bodies)
        q = ", ".join(f"{math.cos(i * k):.6f}" for i in range(1, bodies + 1) for k in (1, 2, 3))
        self.write("many.toml", f"""
            [problem]
            name = "n-body"
            softening = 0.1
            masses = [{masses}]
            initial = {{ q = [{q}], p = [{", ".join(["0"] * 3 * bodies)}] }}
            [method]
            name = "verlet"
            [run]
            dt = 0.001
            steps = 1000
            """)
        back = self.summary("many.toml")["certificate"]["reversal_distance"]
        self.assertEqual((back["steps"], back["proves"]), (385, "reversible to rounding"), back["reason"])
        self.assertIn("the other 615 steps of the run were not tested", back["reason"])
        back = self.summary("many.toml", "--set", "method.name=yoshida8")["certificate"]["reversal_distance"]
        self.assertEqual(back["steps"], 25)
        # Where a step there and back is too much, nothing is said.
        back = self.certificate("{name='stv4'}", "run.arithmetic=mp(20000)", steps=2)[0]["reversal_distance"]
        self.assertEqual((back["steps"], back["distance"], back["proves"]), (0, None, "nothing"))
        self.assertIn("not tested: ", back["reason"])

    def test_none_is_asked_for(self):
        off = ("--set", "run.certificate=false")
        whole, without = self.summary("kepler.toml"), self.summary("kepler.toml", *off)
        self.assertIsNone(without["certificate"])
        for s in (whole, without):
            for key in ("certificate", "wall_seconds", "steps_per_second"):
                del s[key]
        self.assertEqual(whole, without)
        text = self.hamflow("run", "kepler.toml", *off, "--out", "r").stdout
        self.assertRegex(text, r"certificate +not requested\n")
        more = self.hamflow("run", "kepler.toml", *off, "--out", "r", "--resume", "--set", "run.steps=500", "--json")
        self.assertIsNone(json.loads(more.stdout)["certificate"])
        self.assertIn("run.certificate", self.hamflow("run", "kepler.toml", "--out", "r", "--resume", "--set",
                                                      "run.steps=600", status=2).stderr)
        for command in (("sweep", "kepler.toml", "--vary", "run.dt=0.1,0.2", "--out", "none"),
                        ("compare", "kepler.toml", "--methods", "verlet"), ("reverse", "kepler.toml")):
            self.assertNotIn("certificate", self.hamflow(*command, *off).stderr)
        refused = self.hamflow("sweep", "kepler.toml", "--vary", "run.certificate=true,false", "--out", "none", status=2)
        self.assertIn("which does not change the results of a sweep", refused.stderr)
        self.assertIn("\n# certificate = false\n", self.hamflow("new", "harmonic", "--all").stdout)


if __name__ == "__main__":
    unittest.main()

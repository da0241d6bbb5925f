"""Problems, starts and what a summary says of them, against closed forms and each other."""

import math
import unittest

from command import EXAMPLES, CommandCase

EPSILON = 2.0**-52

HEAD = '[method]\nname="cg"\nquadrature={points}\n[run]\ndt={dt}\nsteps={steps}\n'


class Problems(CommandCase):
    def run_text(self, problem, points=5, dt=0.01, steps=100, *extra):
        self.write("s.toml", "[problem]\n" + problem + "\n" + HEAD.format(points=points, dt=dt, steps=steps))
        return self.summary("s.toml", *extra)

    def rejected(self, problem, *extra, method='name="cg"'):
        self.write("s.toml", f"[problem]\n{problem}\n[method]\n{method}\n[run]\ndt=0.01\nsteps=10\n")
        return self.hamflow("run", "s.toml", "--out", "none", *extra, status=2).stderr

    def test_energies_and_momenta_of_the_starts(self):
        mu, k = 2.0, 1.5
        table = [
            ('potential="hooke"\norbit={kind="circle",r0=2,energy=3}', 3, 2 * math.sqrt(mu * 3)),
            ('potential="hooke"\norbit={kind="line",r_per=2,energy=3}', 3, 2 * math.sqrt(2 * mu * 3)),
            ('potential="hooke"\nk=1.5\norbit={kind="hyperbola",r_per=2,energy=3}', 3, 2 * math.sqrt(mu * (6 + k * 4))),
            ('potential="linear"\nk=1.5\norbit={kind="circle",r0=2}', 4.5, math.sqrt(k * mu * 8)),
            ('potential="linear"\nk=-1.5\norbit={kind="unbounded",r_per=2,energy=3}', 3, 2 * math.sqrt(2 * mu * 6)),
            ('potential="kepler"\nk=1.5\norbit={kind="ellipse",r_per=1,r_aph=3}', -k / 4, math.sqrt(2 * k * mu * 3 / 4)),
            ('potential="kepler"\nk=1.5\norbit={energy=-0.375,angular_momentum=1.5}', -0.375, 1.5),
            ('potential="power"\na=1.5\nn=3\norbit={energy=4,angular_momentum=1.5}', 4, 1.5),
        ]
        for coordinates in ("cartesian", "polar"):
            for problem, energy, momentum in table:
                s = self.run_text(f'name="central-force"\ncoordinates="{coordinates}"\nmass=2\n{problem}', steps=0)
                scale = s["energy"]["scale"]
                self.assertLess(abs(s["energy"]["initial"] - energy), 32 * EPSILON * scale, problem)
                l = s["invariants"]["angular_momentum"]["initial"]
                self.assertLess(abs(l - momentum), 8 * EPSILON * abs(momentum), problem)

    def test_orbit_facts(self):
        s = self.run_text('name="central-force"\npotential="kepler"\norbit={kind="ellipse",r_per=1,r_aph=3}', steps=0)
        orbit = s["orbit"]
        self.assertEqual((orbit["type"], orbit["conic"], orbit["closed"]), ("bounded closed", "ellipse", True))
        self.assertEqual((orbit["revolutions"], orbit["radial_periods"]), (1, 1))
        self.assertAlmostEqual(orbit["r_max"], 3, delta=32 * EPSILON)  # E and l are rounded
        self.assertAlmostEqual(orbit["apsidal_angle"], math.pi, delta=64 * EPSILON)
        self.assertAlmostEqual(orbit["circular_radius"], 1.5, delta=64 * EPSILON)
        self.assertAlmostEqual(orbit["radial_period"], 2 * math.pi * math.sqrt(8), delta=1e-13)

    def field(self, potential, q, p, *extra, steps=0):
        return self.run_text(f'name="central-force"\n{potential}\ninitial={{q={q},p={p}}}', 4, 0.001, steps, *extra)

    def test_the_angle_of_a_fall_with_angular_momentum(self):
        # The integral of l/(r^2 r') from the centre, by another quadrature in 40 digits.
        cubic = 'potential="power"\na=-1\nn=-4'  # V = -1/r^3
        orbit = self.field(cubic, [0.5, 0], [0, 0.5])["orbit"]
        self.assertTrue(orbit["falls_into_centre"])
        self.assertAlmostEqual(orbit["apsidal_angle"], 0.30437661506561234, delta=1e-14)
        for power, bounded, unbounded in (("5/2", 0.33697377510110164, 0.27682446494808064),
                                          ("3", 0.15188963385037247, 0.12395525766588556),
                                          ("4", 0.057955205851491250, 0.059905466127834608)):
            typed = f'potential="formula"\nV="-r^(-{power})"'
            for speed, angle in ((0, bounded), (12, unbounded)):
                orbit = self.field(typed, [0.5, 0], [speed, 0.25])["orbit"]
                self.assertEqual(orbit["type"], "unbounded" if speed else "bounded open")
                self.assertAlmostEqual(orbit["apsidal_angle"], angle, delta=1e-13, msg=typed)
        # Round -1/r^2 without end; on a line not at all.
        for sign in (1, -1):
            s = self.field('potential="power"\na=-2\nn=-3', [0.5, 0], [0, sign * 0.25])
            self.assertEqual((s["orbit"]["falls_into_centre"], s["orbit"]["apsidal_angle"]), (True, None))
        self.assertEqual(self.field(cubic, [0.5, 0], [0, 0])["orbit"]["apsidal_angle"], 0)
        text = self.hamflow("run", "s.toml", "--set", 'problem.initial={q=[0.5,0],p=[0,0.5]}', "--out", "none").stdout
        self.assertIn("apsidal angle 0.304377, falls into the centre", text)

    def test_what_keeps_a_fall_out_of_the_centre(self):
        for momentum, words in ((0, "some angular momentum"), (0.5, "enough angular momentum to miss the centre")):
            s = self.field('potential="power"\na=-1\nn=-4', [0.5, 0], [0, momentum], "--set", "method={name='verlet'}",
                           steps=150)
            (message,) = [w["message"] for w in s["warnings"] if w["kind"] == "falls_into_centre"]
            self.assertIn(words, message)

    def test_a_circle_closes_after_one_revolution(self):
        """apsidal angle/pi = revolutions/radial_periods where one revolution is a whole number of radial periods."""
        for potential, momentum, periods in (
            ('potential="hooke"\nk=-1', 1, 2),
            ('potential="formula"\nV="r^2/2"', 1, 2),
            ('potential="kepler"\nk=1', 1, 1),
            ('potential="formula"\nV="r^7/7"', 1, 3),
            ('potential="linear"\nk=1', 1, None),
            ('potential="formula"\nV="4*r^(1/4)"', 1, None),  # an angle of 2/3 pi: 1.5 radial periods
            ('potential="formula"\nV="log(r)"', 1, None),
            ('potential="formula"\nV="-r^(-4)/4"', 1, None),  # unstable
        ):
            orbit = self.field(potential, [1, 0], [0, momentum])["orbit"]
            self.assertEqual((orbit["type"], orbit["closed"], orbit["revolutions"]), ("circle", True, 1), potential)
            self.assertEqual(orbit["radial_periods"], periods, potential)
            if periods:
                self.assertAlmostEqual(orbit["apsidal_angle"] * periods, math.pi, delta=1e-13)
        rest = self.field('potential="binomial"\nk=1\nlambda=1', [1, 0], [0, 0])["orbit"]
        self.assertEqual((rest["type"], rest["apsidal_angle"], rest["revolutions"], rest["radial_periods"]), ("circle", 0, 0, 1))

    def test_where_there_is_no_circular_orbit(self):
        none = [self.field('mass=0.8\npotential="hooke"\nk=0.6', [0.9, 0.3], [-0.2, 0.7]),
                self.field('potential="linear"\nk=1', [1, 0], [0.5, 0])]
        for s in none:
            self.assertEqual((s["orbit"]["circular_radius"], s["orbit"]["circular_stable"]), (None, None))

    def test_exact_state(self):
        for problem in (
            'name="central-force"\npotential="kepler"\norbit={kind="hyperbola",r_per=1,angular_momentum=2}',
            'name="central-force"\npotential="kepler"\ncoordinates="polar"\norbit={kind="ellipse",r_per=1,r_aph=3}',
            'name="central-force"\npotential="linear"\norbit={kind="bounded",r_per=1,r_aph=3}',
            'name="duffing"\nmass=2\ncase=1\nk=1\nr0=4\nspeed=4',
            'name="pendulum"\ninitial={q=[2.5],p=[0]}',
            'name="free-fall"\ninitial={q=[0],p=[3]}',
            'name="harmonic"\ninitial={q=[1],p=[0.5]}',
            'name="magnetic"\ninitial={q=[1,0,0],p=[0.2,0.5,0.1]}',
            'name="double-pendulum"\nmodel="linear"\nangles="relative"\ninitial={q=[0.1,-0.11],p=[0,0]}',
        ):
            coarse = self.run_text(problem, dt=0.01, steps=200)["exact"]["max_difference"]
            fine = self.run_text(problem, dt=0.005, steps=400)["exact"]["max_difference"]
            self.assertLess(fine, 1e-2, problem)
            if fine > 1e-12:  # an element of order 2; free fall is exact
                self.assertAlmostEqual(coarse / fine, 4, delta=0.1, msg=problem)

    def test_there_is_no_exact_state_where_the_closed_form_is_not_known_well(self):
        """V = -1/(2 r^2) at l = 1: V_eff is 0 everywhere, and a quadrature over r is lost in rounding."""
        for slow in ("1e-6", "1e-3"):
            s = self.field('potential="power"\na=-0.5\nn=-3', [1, 0], [float(slow), 1])
            if "exact" in s:
                self.assertLess(s["exact"]["max_difference"], 1e-12, slow)

    def test_differences_from_the_exact_state_do_not_mix_units(self):
        """The same oscillator in units of 10^12: momenta are 10^-12 of the coordinates or 10^12 of them."""
        found = []
        for mass, omega, q in (("1", "1", 1), ("1e12", "1", 1), ("1e-12", "1", 1)):
            s = self.run_text(f'name="harmonic"\nmass={mass}\nomega={omega}\ninitial={{q=[{q}],p=[{float(mass) / 2}]}}',
                              dt=0.1, steps=33)["exact"]
            self.assertEqual(set(s["differences"]), {"q", "p"})
            self.assertIn(s["max_difference"], s["differences"].values())
            found.append(s["relative_difference"])
        for relative in found[1:]:
            self.assertAlmostEqual(relative / found[0], 1, delta=1e-6)

    def test_two_bodies(self):
        bodies = 'bodies=[{mass=2,position=[0,0,1],velocity=[0,0.1,0]},{mass=0.5,position=[1,0,1],velocity=[0,1,0.5]}]'
        s = self.run_text(f'name="central-force"\npotential="kepler"\nk=1\n{bodies}', dt=0.001, steps=1000)
        mass = [b["mass"] for b in s["bodies"]]
        self.assertEqual(mass, [2, 0.5])
        self.assertAlmostEqual(s["parameters"]["mass"], 0.4, delta=EPSILON)
        centre = [sum(m * b["position"][i] for m, b in zip(mass, s["bodies"])) / 2.5 for i in range(3)]
        for i, expected in enumerate((0.2, (0.2 + 0.5) / 2.5, 1 + 0.25 / 2.5)):
            self.assertAlmostEqual(centre[i], expected, delta=8 * EPSILON)
        relative = [s["bodies"][1]["position"][i] - s["bodies"][0]["position"][i] for i in range(3)]
        self.assertAlmostEqual(math.hypot(*relative), math.hypot(*s["final"]["q"]), delta=8 * EPSILON)

    def test_invariants_with_components(self):
        s = self.summary(str(EXAMPLES / "figure_eight.toml"), "--set", "run.t_end=6.32")
        self.assertIsInstance(s["invariants"]["angular_momentum"]["initial"], float)
        self.assertEqual(len(s["invariants"]["linear_momentum"]["final"]), 2)
        self.assertLess(s["invariants"]["centre_of_mass"]["max_error"], 1e-13)
        s = self.summary(str(EXAMPLES / "solar_system.toml"), "--set", "run.t_end=5000")
        for name in ("angular_momentum", "linear_momentum", "centre_of_mass"):
            self.assertEqual(len(s["invariants"][name]["initial"]), 3)
        self.assertEqual(len(s["final"]["q"]), 18)

    def test_diagnostics(self):
        s = self.summary(str(EXAMPLES / "double_pendulum.toml"), "--set", "run.t_end=1")
        self.assertGreaterEqual(s["diagnostics"]["condition_inverse_mass"]["min"], 1)
        self.assertLess(s["energy"]["max_error"], 1e-12)
        self.assertNotIn("diagnostics", self.run_text('name="pendulum"\ninitial={q=[1],p=[0]}'))

    def test_starts_by_energy_where_v_eff_is_no_single_well(self):
        cf = 'name="central-force"\n'
        for problem, energy, radius in (
            # Kepler with a relativistic term: an inner region falls into the centre, the outer one is an orbit.
            ('potential="power"\na=[-1,-0.3]\nn=[-2,-4]\norbit={energy=-0.15,angular_momentum=1.5}', -0.15, None),
            ('potential="hooke"\nk=1\norbit={energy=-1,angular_momentum=0}', -1, math.sqrt(2)),
            ('potential="hooke"\nk=1\norbit={energy=-5,angular_momentum=1}', -5, None),
            ('potential="kepler"\norbit={energy=-0.25,angular_momentum=0}', -0.25, 4),
            ('potential="binomial"\nk=-1\norbit={energy=-1,angular_momentum=1}', -1, None),
            ('potential="power"\na=-1\nn=-3\norbit={energy=-1,angular_momentum=1}', -1, math.sqrt(0.5)),
        ):
            s = self.run_text(cf + problem, steps=0)
            self.assertLess(abs(s["energy"]["initial"] - energy), 64 * EPSILON * s["energy"]["scale"], problem)
            if radius is not None:
                self.assertAlmostEqual(s["final"]["q"][0], radius, delta=16 * EPSILON)
        # Above the maximum of V_eff the motion has no turning point.
        self.assertIn(
            "without a turning point",
            self.rejected(cf + 'potential="power"\na=-1\nn=-4\norbit={energy=1,angular_momentum=1}'),
        )

    def test_exact_is_right_or_absent_near_a_maximum_of_v_eff(self):
        for kick in (1e-3, 1e-5, 1e-8, 0):
            problem = f'name="central-force"\npotential="power"\na="-1/3"\nn=-4\ninitial={{q=[1,0],p=[{kick},1]}}'
            s = self.run_text(problem, points=12, dt=0.001, steps=4000)
            if "exact" in s:
                self.assertLess(s["exact"]["max_difference"], 1e-2, kick)

    def test_exact_on_a_line_in_polar_coordinates(self):
        problem = 'name="central-force"\npotential="hooke"\nk=-1\ncoordinates="polar"\ninitial={q=[1,0.3],p=[0,0]}'
        s = self.run_text(problem, dt=0.01, steps=200)
        self.assertLess(s["final"]["q"][0], 0)  # through the centre
        self.assertLess(s["exact"]["max_difference"], 1e-4)

    def test_a_charge_without_a_field_has_the_momenta_of_free_flight(self):
        for key in ("charge=0", "field=[0,0,0]"):
            s = self.run_text(f'name="magnetic"\n{key}\ninitial={{q=[1,2,0],v=[0.3,1,0.1]}}', dt=0.1)
            for name, value in (("angular_momentum", 1 - 2 * 0.3), ("parallel_momentum", 0.1)):
                self.assertAlmostEqual(s["invariants"][name]["initial"], value, places=14)
                self.assertLess(s["invariants"][name]["max_error"], 1e-12)

    def test_newton_stops_where_rounding_is_all_that_is_left(self):
        linear = 'name="double-pendulum"\nmodel="linear"\nangles="{}"\nmasses={}\nhalf_lengths={}\ninitial={{q=[0.1,0.1],p=[0,0]}}'
        for angles, masses, lengths in (
            ("absolute", "[1,10]", "[1,0.1]"),
            ("relative", "[0.01,1]", "[1,0.2]"),
            ("relative", "[0.01,1]", "[1,1]"),
        ):
            s = self.run_text(linear.format(angles, masses, lengths), points='"auto"', dt=0.01, steps=20000)
            self.assertEqual(s["status"], "done")
        self.assertEqual(
            self.run_text('name="magnetic"\nfield=[0,0,1e5]\ninitial={q=[1,0,0],v=[0,1,0]}', dt=0.1)["status"], "done"
        )

    def test_the_lattice_of_a_small_start_is_fine(self):
        arguments = (str(EXAMPLES / "solar_system.toml"), "--set", "run.t_end=50000", "--set", "output.figures=[]")
        plain = self.summary(*arguments)
        lattice = self.summary(*arguments, "--set", "run.arithmetic=lattice")
        self.assertLess(lattice["lattice"]["momentum"], 2.0**-60)
        for a, b in zip(plain["final"]["q"], lattice["final"]["q"]):
            self.assertAlmostEqual(a, b, delta=1e-5)

    def test_errors_of_the_new_keys(self):
        cf = 'name="central-force"\n'
        for problem, words in (
            (cf + 'potential="power"\nn=2\norbit={energy=1,angular_momentum=1}', ("problem.a", "missing")),
            (cf + 'potential="power"\na=1\nn=-1\norbit={energy=1,angular_momentum=1}', ("problem.n", "except -1")),
            (cf + 'potential="power"\na=[1,2]\nn=2\norbit={energy=1,angular_momentum=1}', ("problem.n", "as in a, 2")),
            (cf + 'potential="kepler"\norbit={energy=-1,angular_momentum=1}', ("problem.orbit.energy", "exceeded by 0.5")),
            (cf + 'potential="kepler"\norbit={energy=1}', ("kind", "angular_momentum")),
            (cf + 'potential="kepler"\ncoordinates="plar"\norbit={kind="circle",r0=1}', ("did you mean polar",)),
            (cf + 'potential="kepler"\nbodies=[{mass=1,position=[0,0,0],velocity=[0,0,0]}]', ("bodies", "2 tables")),
            (
                cf + 'potential="kepler"\nmass=1\nbodies=[{mass=1,position=[0,0,0],velocity=[0,0,0]},'
                "{mass=0,position=[0,0,0],velocity=[0,0]}]",
                ("problem.mass", "bodies[1].mass", "bodies[1].velocity"),
            ),
            (
                cf + 'potential="kepler"\nbodies=[{mass=1,position=[0,0,0],velocity=[0,0,0]},'
                "{mass=1,position=[0,0,0],velocity=[0,0,1]}]",
                ("at the same point",),
            ),
            ('name="duffing"\nalpha=1\nk=1\ninitial={q=[1],p=[0]}', ("alpha with beta",)),
            ('name="duffing"\ncase=4\nr0=1', ("case", "from 1 to 3")),
            ('name="duffing"\ncase=3\nk=2\nr0=4\nspeed=40', ("problem.speed", "exceeded by")),
            ('name="duffing"\ncase=1\nk=2\nlambda=3\nr0=4\nspeed=4', ("problem.lambda", "follows")),
            ('name="duffing"\ncase=2\nk=2\nr0=4\nspeed=4', ("problem.speed",)),
            ('name="duffing"\ncase=1\nk=1\nr0=0\nspeed=1', ("problem.r0", "0 < r0")),
            ('name="duffing"\ncase=1\nk=0\nr0=1\nspeed=1', ("problem.k", "0 < k")),
            ('name="duffing"\ncase=2\nk=1\nr0=1e200', ("infinite",)),
            (
                cf + 'potential="kepler"\nbodies=[{mass=1e200,position=[0,0,0],velocity=[0,0,0]},'
                "{mass=1e200,position=[1,0,0],velocity=[0,0,1]}]",
                ("problem.bodies", "overflow"),
            ),
            ('name="double-pendulum"\nmasses=[1,0]\ninitial={q=[0,0],p=[0,0]}', ("problem.masses", "positive")),
            ('name="double-pendulum"\nhalf_lengths=[0,1]\ninitial={q=[0,0],p=[0,0]}', ("problem.half_lengths",)),
            ('name="double-pendulum"\nmasses=[1]\ninitial={q=[0,0],p=[0,0]}', ("problem.masses", "array of 2")),
            ('name="double-pendulum"\nmodel="curved"\ninitial={q=[0,0],p=[0,0]}', ("linear, nonlinear",)),
            ('name="double-pendulum"\nangles="absolut"\ninitial={q=[0,0],p=[0,0]}', ("did you mean absolute",)),
            ('name="pendulum"\nlength=0\ninitial={q=[0],p=[0]}', ("problem.length", "positive")),
            ('name="n-body"\nmasses=[1,1]\ninitial={q=[0,0,0,0],p=[0,0,0,0]}', ("bodies 1 and 2 at one point",)),
            ('name="n-body"\nmasses=[1,-1]\ninitial={q=[0,0,1,0],p=[0,0,0,0]}', ("problem.masses",)),
            ('name="n-body"\nmasses=[1,1]\ninitial={q=[0,0,1],p=[0,0,0]}', ("4 numbers in the plane, 6 in space",)),
            ('name="n-body"\nmasses=[1,1]\ninitial={q=[0,0,1,0],p=[0,0,0,0,0,0]}', ("the number of entries of q",)),
            ('name="n-body"\nmasses=[]\ninitial={q=[],p=[]}', ("problem.masses",)),
            ('name="n-body"\ninitial={q=[0,0,1,0],p=[0,0,0,0]}', ("problem.masses", "missing")),
            ('name="fput"\nn=2.5\ninitial={q=[1,2],p=[0,0]}', ("problem.n", "whole")),
            ('name="fput"\nn=3\ninitial={q=[1,2],p=[0,0]}', ("3 numbers",)),
            ('name="magnetic"\nfield=[1,2]\ninitial={q=[0,0,0],p=[0,0,0]}', ("problem.field", "array of 3")),
            ('name="sextic"\ninitial={q=[0.5],v=[0.1]}', ("give p",)),
        ):
            text = self.rejected(problem)
            for word in words:
                self.assertIn(word, text, problem)

    def test_the_seeds_own_criterion_aborts_where_its_programs_do(self):
        # Its residual is absolute, and rounds by (2 mu/h) |q| epsilon: too much on long ways and for stiff springs.
        cf = 'name="central-force"\nmass=2\n'
        for problem, dt, steps in (
            ('potential="hooke"\norbit={kind="line",r_per=1,energy=1}', 0.01, 100000),
            ('potential="hooke"\nk=1\norbit={kind="hyperbola",r_per=1,energy=1}', 0.1, 400),
            ('potential="linear"\nk=-1\norbit={kind="unbounded",r_per=1,energy=3}', 0.1, 4000),
            ('potential="binomial"\nk=1e6\nlambda=1\norbit={kind="bounded",r_per=0.9,r_aph=1.1}', 0.001, 400),
        ):
            text = f"[problem]\n{cf}{problem}\n" + HEAD.format(points=5, dt=dt, steps=steps)
            self.write("s.toml", text)
            aborted = self.summary("s.toml", "--set", "method.criterion=seed", status=1)
            self.assertEqual(aborted["error"]["kind"], "not_converged", problem)
            self.assertIn("residual", aborted["error"]["details"])
            done = self.summary("s.toml")
            # On the hyperbola T and V grow without bound and H is their difference.
            size = max(done["energy"]["scale"], *(x * x for x in done["final"]["q"] + done["final"]["p"]))
            self.assertLess(done["energy"]["max_error"], 1e-11 * size, problem)

    def test_methods_that_a_problem_refuses(self):
        pendulum = 'name="double-pendulum"\ninitial={q=[0,0],p=[0,0]}'
        text = self.rejected(pendulum, method='name="stv4"')
        self.assertIn("needs a separable H", text)
        self.assertIn("cg", text)
        self.assertIn("boris needs", self.rejected(pendulum, method='name="boris"'))
        chain = 'name="fput"\nn=3\ninitial={q=[1,0,0],p=[0,0,0]}'
        text = self.rejected(chain, "--set", 'output.figures=["orbit"]')
        self.assertIn("3 degrees of freedom", text)


if __name__ == "__main__":
    unittest.main()

"""Bodies by orbital elements: states against an independent conversion, wrong input, and bodies of mass 0."""

import json
import math
import unittest

from command import CommandCase

try:
    from mpmath import mp, mpf
except ImportError:
    mp = None

UNITS = 'units = { length = "AU", time = "day", mass = "Msun" }\n'
SUN = '{ name = "Sun", mass = 1 }'
EARTH = '{ name = "Earth", mass = 3e-6, a = 1, e = 0.0167 }'


SOLAR = ('[problem]\nname = "solar-system"\n{}\n[method]\nname = "stv4"\n[run]\ndt = 1\nsteps = 0\n[output]\n'
         'elements = "{}"\n')


def scenario(bodies, before="", method="stv4", steps=0, dt=1, run=""):
    return (f'[problem]\nname = "n-body"\n{before}\nbodies = [{", ".join(bodies)}]\n[method]\nname = "{method}"\n'
            f"[run]\ndt = {dt}\nsteps = {steps}\n{run}\n")


class States(CommandCase):
    def start(self, bodies, before=""):
        self.write("s.toml", scenario(bodies, before + "\nframe = \"given\""))
        return self.summary("s.toml")["final"]["q"], self.summary("s.toml")["final"]["p"]

    @unittest.skipIf(mp is None, "mpmath is not installed")
    def test_against_textbook_formulas_in_50_digits(self):
        """r and v of an ellipse and a hyperbola from Kepler's equation, rotated by three angles, about the centre of
        mass of the bodies before, a named body, or all."""
        mp.dps = 50
        g = mpf("1.3271244e20") * mpf(86400)**2 / mpf(149597870700)**3

        def rotated(x, y, i, node, pericentre):
            x, y = x * mp.cos(pericentre) - y * mp.sin(pericentre), x * mp.sin(pericentre) + y * mp.cos(pericentre)
            y, z = y * mp.cos(i), y * mp.sin(i)
            return [x * mp.cos(node) - y * mp.sin(node), x * mp.sin(node) + y * mp.cos(node), z]

        def state(mu, a, e, i, node, pericentre, mean):
            if e < 1:
                anomaly = mp.findroot(lambda x: x - e * mp.sin(x) - mean, mean)
                x, y = a * (mp.cos(anomaly) - e), a * mp.sqrt(1 - e**2) * mp.sin(anomaly)
                rate = mp.sqrt(mu / a**3) / (1 - e * mp.cos(anomaly))
                v = -a * mp.sin(anomaly) * rate, a * mp.sqrt(1 - e**2) * mp.cos(anomaly) * rate
            else:
                anomaly = mp.findroot(lambda x: e * mp.sinh(x) - x - mean, mp.asinh(mean / e))
                x, y = a * (mp.cosh(anomaly) - e), -a * mp.sqrt(e**2 - 1) * mp.sinh(anomaly)
                rate = mp.sqrt(mu / -a**3) / (e * mp.cosh(anomaly) - 1)
                v = a * mp.sinh(anomaly) * rate, -a * mp.sqrt(e**2 - 1) * mp.cosh(anomaly) * rate
            return rotated(x, y, i, node, pericentre), rotated(*v, i, node, pericentre)

        deg = mp.pi / 180
        zero = [mpf(0)] * 3
        total = mpf(1) + 1 / mpf("1047.3486")
        elements = dict(jupiter=(mpf("5.2026"), mpf("0.0485"), mpf("1.303") * deg, mpf("100.46") * deg,
                                 mpf("273.87") * deg, mpf("20.02") * deg),
                        saturn=(mpf("9.55"), mpf("0.055"), mpf("2.5") * deg, mpf("113.7") * deg, mpf("339.4") * deg,
                                mpf("317") * deg),
                        comet=(mpf("-3"), mpf("1.3"), mpf("2.8"), mp.pi / 3, mpf("0.5"), mpf("-7")))
        jupiter = ('{ name = "Jupiter", mass = "1/1047.3486", a = 5.2026, e = 0.0485, inclination = "1.303 deg", '
                   'node = "100.46deg", pericentre = "273.87 deg", mean_anomaly = "20.02 deg"%s }')
        saturn = ('{ name = "Saturn", mass = "1/3497.9", a = "9.55", e = 0.055, inclination = "2.5 deg", node = "113.7 deg",'
                  ' longitude_of_pericentre = "453.1 deg", mean_longitude = "770.1 deg"%s }')
        comet = ('{ mass = 0, a = -3, e = 1.3, inclination = "2.8 rad", node = "pi/3", pericentre = 0.5, '
                 'mean_anomaly = -7, primary = "Jupiter" }')
        small = 1 / mpf("3497.9")
        for primary in ("", ', primary = "Sun"', ', primary = "barycentre"'):
            bodies = [SUN, jupiter % primary, saturn % primary, comet]
            about = "barycentre" in primary
            whole = total + small
            first = state(g * (whole if about else total), *elements["jupiter"])
            second = state(g * (whole if about else 1 + small if primary else whole), *elements["saturn"])
            sun = [zero, zero]
            if about:
                sun = [[-(first[k][i] / mpf("1047.3486") + second[k][i] * small) for i in range(3)] for k in (0, 1)]
            elif not primary:  # about the centre of mass of Sun and Jupiter
                centre = [[x / mpf("1047.3486") / total for x in first[k]] for k in (0, 1)]
                second = [[x + c for x, c in zip(second[k], centre[k])] for k in (0, 1)]
            third = state(g / mpf("1047.3486"), *elements["comet"])
            third = [[x + y for x, y in zip(third[k], first[k])] for k in (0, 1)]
            q, p = self.start(bodies, UNITS)
            expected = [sun, first, second, third]
            masses = [1, 1 / mpf("1047.3486"), small, 1]
            for i, mass in enumerate(masses):
                for k, found in ((0, q), (1, [x / mass for x in map(mpf, p[3 * i:3 * i + 3])])):
                    found = found[3 * i:3 * i + 3] if k == 0 else found
                    size = max(abs(x) for x in expected[i][k])
                    for x, y in zip(found, expected[i][k]):
                        # Two roundings: of m v, and of the mass in v = p/m.
                        self.assertLessEqual(abs(mpf(x) - y), 2 * 2.0**-53 * size, (primary, i, k))

    def test_every_arithmetic_starts_in_the_same_place(self):
        from decimal import Decimal, getcontext
        getcontext().prec = 70
        self.write("s.toml", scenario([SUN, EARTH.replace(" }", ', inclination = "7 deg" }')], UNITS))
        exact = [Decimal(x) for x in self.summary("s.toml", "--set", 'run.arithmetic="mp(60)"')["final"]["q"]]
        size = max(abs(x) for x in exact)
        for arithmetic, unit in (("double", 2.0**-52), ("compensated", 2.0**-52), ("double-double", 1e-31), ("quad", 1e-33)):
            q = self.summary("s.toml", "--set", f'run.arithmetic="{arithmetic}"')["final"]["q"]
            for x, y in zip(q, exact):
                self.assertLess(abs(Decimal(x) - y), Decimal(unit) * size, arithmetic)

    def test_frame_and_first_body(self):
        self.write("s.toml", scenario([SUN, EARTH]))
        s = self.summary("s.toml")
        self.assertEqual(s["parameters"]["frame"], "barycentric")
        self.assertLess(abs(s["final"]["q"][0] + 3e-6 * s["final"]["q"][3]), 1e-21)
        q, _ = self.start(['{ mass = 1, position = [1, 2], velocity = [0, 0] }', '{ mass = 0.1, a = 1 }'])
        self.assertEqual(q, [1, 2, 2, 2])

    def test_a_planet_comes_back_after_its_period(self):
        self.write("s.toml", scenario([SUN, '{ mass = 0, period = 365.25, e = 0.3 }'], UNITS + 'frame = "given"',
                                      "dop853", 1000, 0.36525))
        s = self.summary("s.toml")["final"]
        self.write("t.toml", scenario([SUN, '{ mass = 0, period = 365.25, e = 0.3 }'], UNITS + 'frame = "given"'))
        start = self.summary("t.toml")["final"]
        for x, y in zip(s["q"], start["q"]):
            self.assertAlmostEqual(x, y, delta=1e-11)


class Wrong(CommandCase):
    def errors(self, text):
        self.write("wrong.toml", text)
        done = self.hamflow("run", "wrong.toml", "--out", "none", "--json", status=2)
        return json.loads(done.stdout)["errors"]

    def refused(self, bodies, key, *words, before="", **rest):
        found = self.errors(scenario(bodies, before, **rest))
        self.assertEqual([error["key"] for error in found], [key], found)
        for word in words:
            self.assertIn(word, found[0]["message"])
        self.assertGreater(found[0]["line"], 0)

    def test_one_body(self):
        for body, key, *words in (
            ("mass = 0, a = 1, period = 2", "period", "found a and period; allowed one of them"),
            ("mass = 0, a = 1, pericentre_distance = 2", "pericentre_distance", "found a and pericentre_distance"),
            ("mass = 0, a = 1, mean_anomaly = 1, true_anomaly = 2", "true_anomaly", "found mean_anomaly and true_anomaly"),
            ("mass = 0, a = 1, mean_longitude = 1, time_of_pericentre = 2", "time_of_pericentre", "allowed one of them"),
            ("mass = 0, a = 1, pericentre = 1, longitude_of_pericentre = 2", "longitude_of_pericentre", "one of them"),
            ("mass = 0, a = 1, e = 1.5", "a", "found 1 with e = 1.5", "below 0"),
            ("mass = 0, a = -1, e = 0.5", "a", "found -1 with e = 0.5", "above 0"),
            ("mass = 0, a = 1, e = 1", "a", "found a with e = 1; allowed pericentre_distance"),
            ("mass = 0, period = 1, e = 1", "period", "found a period with e = 1"),
            ("mass = 0, period = 1, e = 2", "period", "allowed pericentre_distance"),
            ("mass = 0, period = -1", "period", "found -1; allowed a number above 0"),
            ("mass = 0, pericentre_distance = 0", "pericentre_distance", "found 0; allowed a number above 0"),
            ("mass = 0, a = 1, e = -0.1", "e", "found -0.1; allowed a number from 0"),
            ("mass = 0, a = 1, inclination = 4", "inclination", "found 4 radians; allowed 0 to pi"),
            ("mass = 0, e = 0.5", "a", "no size of the orbit; allowed one of a, period, pericentre_distance"),
            ('mass = 0, a = 1, mean_anomaly = "20 degrees"', "mean_anomaly", 'found "20 degrees"', '"20 deg"'),
            ('mass = 0, a = 1, mean_anomaly = "deg"', "mean_anomaly", 'found "deg"', '"20 deg"'),
            ('mass = 0, a = 1, node = "north"', "node", 'found "north"', "a number in radians"),
            ("mass = 0, a = 1, node = true", "node", "found true"),
            ("mass = 0, pericentre_distance = 1, e = 1, mean_anomaly = 1", "mean_anomaly", "allowed true_anomaly"),
            ("mass = 0, a = -1, e = 2, true_anomaly = 2.2", "true_anomaly", "asymptotes"),
            ("a = 1", "mass", "missing; allowed a number, not negative"),
            ("mass = -1, a = 1", "mass", "found -1; allowed a number, not negative"),
            ("mass = 0", "a", "neither an orbit nor a position"),
            ("mass = 0, position = [1, 0, 0]", "position", "without velocity"),
            ("mass = 0, velocity = [1, 0, 0]", "velocity", "without position"),
            ("mass = 0, position = [1, 0, 0], velocity = [0, 1]", "velocity", "found 2 entries; allowed 3"),
            ("mass = 0, position = [1], velocity = [0, 1]", "position", "found 1 entry; allowed 2 numbers in the plane"),
            ("mass = 0, a = 1, position = [1, 0, 0], velocity = [0, 1, 0]", "a", "together with position"),
            ('mass = 0, position = [1, 0, 0], velocity = [0, 1, 0], primary = "Sun"', "primary", "without an orbit"),
            ('mass = 0, a = 1, primary = "Sum"', "primary", "which no body before this one is called", "did you mean Sun?"),
            ('mass = 0, a = 1, primary = "last"', "primary", "which no body before this one is called"),
            ('mass = 0, a = 1, primary = "dust"', "primary", "whose mass is 0"),
            ('mass = 0, a = 1, primary = 3', "primary", "found 3"),
            ("mass = 0, a = 1, excentricity = 0.1", "excentricity", "unknown key"),
            ('name = "Sun", mass = 0, a = 1', "name", 'the name "Sun" of bodies[0] again'),
            ('name = "a/b", mass = 0, a = 1', "name", "allowed letters, digits, _, - and spaces"),
            ('name = "jacobi", mass = 0, a = 1', "name", "a word for a primary"),
        ):
            with self.subTest(body):
                dust = '{ name = "dust", mass = 0, position = [7, 0, 0], velocity = [0, 0, 0] }'
                last = '{ name = "last", mass = 1, a = 100 }'
                self.refused([SUN, dust, f"{{ {body} }}", last], f"problem.bodies[2].{key}", *words)

    def test_the_list(self):
        for bodies, key, *words in (
            ([], "problem.bodies", "found no body"),
            (["1"], "problem.bodies", "allowed an array of tables"),
            (["{ mass = 1, a = 1 }"], "problem.bodies[0].a", "of the first body"),
            (["{ mass = 0 }", "{ mass = 1, a = 1 }"], "problem.bodies[1].primary", "whose masses are 0"),
            ([SUN, EARTH.replace(" }", ', primary = "barycentre" }'), "{ mass = 1e-6, a = 3 }"],
             "problem.bodies[2].primary", 'found no primary; allowed "barycentre", as Earth has it'),
            (["{ mass = 1, position = [0, 0, 0], velocity = [0, 0, 0] }",
              EARTH.replace(" }", ', primary = "barycentre" }')], "problem.bodies[0].position", "the centre of mass"),
            ([SUN, *(EARTH.replace("Earth", name).replace(" }", ', primary = "Sun" }') for name in ("Earth", "Moon"))], "problem.bodies", "Earth and Moon at one point"),
            ([SUN, "{ mass = 0, position = [1, 0], velocity = [0, 1] }", "{ mass = 0, a = 1, node = 1 }"],
             "problem.bodies[2].node", "found node together with positions of 2 numbers"),
            ([SUN, "{ mass = 0, position = [1, 0], velocity = [0, 1] }",
              "{ mass = 0, position = [2, 0, 0], velocity = [0, 1, 0] }"], "problem.bodies[2].position", "allowed 2, as"),
            ([SUN, "{ mass = 0, a = 1e308, e = 0.9, true_anomaly = \"pi\" }"], "problem.bodies", "not finite"),
        ):
            with self.subTest(bodies):
                self.refused(bodies, key, *words)

    def test_beside_other_keys(self):
        for before, key, *words in (
            ("masses = [1, 1]", "problem.masses", "found masses together with bodies"),
            ("initial = { q = [0, 0], p = [0, 0] }", "problem.initial", "found initial together with bodies"),
            (UNITS + "gravitational_constant = 1", "problem.gravitational_constant", "together with units"),
            (UNITS.replace("AU", "Au"), "problem.units.length", 'found "Au"', "did you mean AU?"),
            (UNITS.replace('time = "day", ', ""), "problem.units.time", "missing; allowed s, day, yr, Myr"),
            (UNITS.replace("mass =", "masse ="), "problem.units.mass", "missing"),
            ("gravitational_constant = 0", "problem.gravitational_constant", "beside an orbit; allowed a positive number"),
        ):
            with self.subTest(before):
                if "masse =" in before:
                    found = self.errors(scenario([SUN, EARTH], before))
                    self.assertIn("problem.units.masse", [error["key"] for error in found])
                else:
                    self.refused([SUN, EARTH], key, *words, before=before)


class Massless(CommandCase):
    DUST = '{ name = "dust", mass = 0, a = 1.6, e = 0.2, node = 1, inclination = 0.3 }'
    BODIES = [SUN, '{ name = "Jupiter", mass = 0.001, a = 5.2 }', '{ name = "Saturn", mass = 0.0003, a = 9.5, node = 2 }']

    def run_with(self, dust, method="stv4", arithmetic="double", run=""):
        bodies = self.BODIES[:2] + ([self.DUST] if dust else []) + self.BODIES[2:]
        self.write("s.toml", scenario(bodies, 'frame = "given"', method, 200, 0.05, f'arithmetic = "{arithmetic}"\n' + run))
        return self.summary("s.toml")

    def test_it_is_felt_by_none(self):
        """The motion, energy and invariants of the others keep every bit."""
        for method in ("stv4", "verlet", "rk4", "kahan-li8", "rkn8-s19", "chin4a"):
            for arithmetic in ("double", "compensated", "double-double", "mp(40)"):
                alone, beside = (self.run_with(dust, method, arithmetic) for dust in (False, True))
                for key in ("q", "p"):
                    self.assertEqual(beside["final"][key][:6] + beside["final"][key][9:], alone["final"][key])
                self.assertEqual(beside["energy"], alone["energy"])
                for name in alone["invariants"]:
                    self.assertEqual(beside["invariants"][name]["final"], alone["invariants"][name]["final"])

    def test_it_moves_as_a_body_of_tiny_mass(self):
        exact = self.run_with(True, "dop853")["final"]
        self.DUST = self.DUST.replace("mass = 0", "mass = 1e-30")
        tiny = self.run_with(True, "dop853")["final"]
        for x, y in zip(exact["q"][6:9], tiny["q"][6:9]):
            self.assertAlmostEqual(x, y, delta=1e-13)
        for x, y in zip(exact["p"][6:9], tiny["p"][6:9]):
            self.assertAlmostEqual(x, y / 1e-30, delta=1e-13)

    def test_by_masses(self):
        """p = v, also where velocities are given."""
        text = ('[problem]\nname = "n-body"\nmasses = [1, 0]\ninitial = {{ q = [0, 0, 1, 0], {} = [0, 0, 0, 1] }}\n'
                '[method]\nname = "verlet"\n[run]\ndt = 0.01\nsteps = 100\n')
        self.write("p.toml", text.format("p"))
        self.write("v.toml", text.format("v"))
        by_p, by_v = self.summary("p.toml")["final"], self.summary("v.toml")["final"]
        self.assertEqual(by_p, by_v)
        self.assertEqual(by_p["q"][:2], [0, 0])
        self.assertAlmostEqual(by_p["q"][2], math.cos(1), delta=1e-4)

    def test_refused_where_it_is_unknown(self):
        for method, run, key, word in (("cg", "", "method.name", "explicit methods"),
                                       ("stv4", 'arithmetic = "lattice"', "run.arithmetic", "opposite signs"),
                                       ("stv4", "lyapunov = 1", "run.lyapunov", "one H"),
                                       ("stv4", "eigenvalues = true", "run.eigenvalues", "one H")):
            self.write("s.toml", scenario([SUN, self.DUST], "", method, 10, 0.05, run))
            found = json.loads(self.hamflow("run", "s.toml", "--out", "none", "--json", status=2).stdout)["errors"]
            self.assertEqual([error["key"] for error in found], [key])
            self.assertIn(word, found[0]["message"])


class Elements(CommandCase):
    """output.elements gives back the elements by which bodies were placed, wherever they are recorded."""

    GIVEN = {"Jupiter": (5.2026, 0.0485, 0.0227, 1.75, 4.78, 0.35), "Saturn": (9.55, 0.055, 0.043, 1.98, 5.92, 5.53),
             "comet": (17.8, 0.967, 2.83, 1.02, 1.95, 0.67), "visitor": (-1.27, 1.2, 2.14, 0.43, 4.22, -3.5)}
    KEYS = ("a", "e", "inclination", "node", "pericentre", "mean_anomaly")
    MASSES = {"Jupiter": 9.5e-4, "Saturn": 2.9e-4, "comet": 0, "visitor": 0}

    def write_bodies(self, primary, steps=0, names=True):
        bodies = [SUN]
        for name, numbers in self.GIVEN.items():
            keys = ", ".join(f"{key} = {x}" for key, x in zip(self.KEYS, numbers))
            label = f'name = "{name}", ' if names else ""
            bodies.append(f'{{ {label}mass = {self.MASSES[name]}, primary = "{primary}", {keys} }}')
        self.write("s.toml", scenario(bodies, UNITS, steps=steps, dt=5) +
                   f'[output]\nelements = "{primary}"\nformats = ["h5", "csv"]\n')

    def test_there_and_back(self):
        for primary in ("jacobi", "barycentre", "Sun"):
            self.write_bodies(primary)
            found = self.summary("s.toml")["elements"]
            self.assertEqual(list(found), list(self.GIVEN))
            for name, numbers in self.GIVEN.items():
                for key, x in zip(self.KEYS, numbers):
                    # Positions and velocities are rounded, and moved to the centre of mass; e of a comet is the
                    # difference of numbers 30 times as large.
                    self.assertAlmostEqual(found[name][key] / x, 1, delta=2e-14, msg=(primary, name, key))
                of = found[name]
                turn = 2 * math.pi
                self.assertAlmostEqual(of["longitude_of_pericentre"], (of["node"] + of["pericentre"]) % turn, delta=1e-13)
                if of["e"] < 1:
                    sum_of = (of["longitude_of_pericentre"] + of["mean_anomaly"]) % turn
                    self.assertAlmostEqual(of["mean_longitude"], sum_of, delta=1e-12)
                else:
                    self.assertIsNone(of["period"])
                    self.assertIsNone(of["mean_longitude"])

    def test_in_every_file(self):
        self.write_bodies("Sun", 40)
        last = json.loads(self.hamflow("run", "s.toml", "--out", "r", "--json").stdout)["elements"]
        rows = (self.folder / "r" / "trajectory.csv").read_text().splitlines()
        columns = rows[0].split(",")
        for name, of in last.items():
            for key, x in of.items():
                found = float(rows[-1].split(",")[columns.index(f"{name}.{key}")])
                self.assertTrue(found == x or x is None and math.isnan(found), (name, key))
        self.hamflow("plot", "r", "--kind", "time", "--y", "Jupiter.e,comet.a", "--output", "f.svg")
        self.assertIn("Jupiter", (self.folder / "f.svg").read_text())

    def test_names_of_their_own(self):
        self.write_bodies("jacobi", names=False)
        self.assertEqual(list(self.summary("s.toml")["elements"]), ["body2", "body3", "body4", "body5"])

    def test_solar_system(self):
        """Mean orbits of 2000 [Standish, Keplerian elements for approximate positions]: osculating ones are near them."""
        text = SOLAR.format('planets = "all"', "Sun")
        self.write("s.toml", text)
        found = self.summary("s.toml")["elements"]
        for name, a, e, inclination in (("Mercury", 0.38710, 0.20564, 7.0050), ("Venus", 0.72333, 0.00677, 3.3946),
                                        ("Earth", 1.00000, 0.01671, 0), ("Mars", 1.52371, 0.09337, 1.8497),
                                        ("Jupiter", 5.20289, 0.04839, 1.3044), ("Saturn", 9.53668, 0.05386, 2.4860),
                                        ("Uranus", 19.189, 0.04726, 0.7726), ("Neptune", 30.070, 0.00859, 1.7700),
                                        ("Pluto", 39.482, 0.24883, 17.140)):
            self.assertAlmostEqual(found[name]["a"] / a, 1, delta=0.01, msg=name)
            self.assertAlmostEqual(found[name]["e"], e, delta=0.005, msg=name)
            self.assertAlmostEqual(math.degrees(found[name]["inclination"]), inclination, delta=0.02, msg=name)
        self.write("s.toml", SOLAR.format("", "jacobi"))
        self.assertEqual(list(self.summary("s.toml")["elements"]), ["Jupiter", "Saturn", "Uranus", "Neptune", "Pluto"])

    def test_wrong(self):
        for text, words in ((SOLAR.format("", "Jupyter"), "did you mean Jupiter?"),
                            (SOLAR.format("", "Earth"), "allowed jacobi, barycentre, Sun, Jupiter"),
                            (scenario([SUN, EARTH], "softening = 0.1") + '[output]\nelements = "jacobi"', "softening"),
                            (scenario([SUN, '{ name = "dust", mass = 0, a = 1 }']) + '[output]\nelements = "dust"',
                             "whose mass is 0"),
                            ('[problem]\nname = "pendulum"\ninitial = { q = [0], p = [1] }\n[method]\nname = "verlet"\n'
                             '[run]\ndt = 0.1\nsteps = 1\n[output]\nelements = "jacobi"', "whose bodies have orbits")):
            self.write("s.toml", text)
            found = json.loads(self.hamflow("run", "s.toml", "--out", "none", "--json", status=2).stdout)["errors"]
            self.assertEqual([error["key"] for error in found], ["output.elements"])
            self.assertIn(words, found[0]["message"])


if __name__ == "__main__":
    unittest.main()

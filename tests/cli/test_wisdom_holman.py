"""Kepler splittings of planetary systems: orders in dt and in the masses, coordinates, massless bodies, refusals."""

import csv
import json
import math
import os
import pathlib
import sys
import unittest
from decimal import Decimal

from command import CommandCase

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from kill_and_resume import differences  # noqa: E402

COMPARE = os.environ["COMPARE_RUNS"]

SYSTEM = """
[problem]
name = "n-body"
bodies = [
  {{ name = "Sun", mass = 1 }},
  {{ name = "inner", mass = {mass}, a = 1, e = 0.05, inclination = 0.02, node = 1, pericentre = 2 }},
  {{ name = "outer", mass = "{mass}/2", a = 2.3, e = 0.1, inclination = 0.05, node = 3, mean_anomaly = 2 }},
  {more}
]
[method]
name = "{method}"
{options}
[run]
dt = "{time}/{steps}"
steps = {steps}
arithmetic = "{arithmetic}"
"""
CORRECTED = ("wisdom-holman(corrector=3)", "wisdom-holman(corrector=5)", "wisdom-holman(corrector=7)",
             "wisdom-holman(corrector=11)", "wisdom-holman(corrector=17)", "wisdom-holman(corrector=17,kernel=lazy)")
METHODS = ("wisdom-holman", "wisdom-holman(coordinates=democratic-heliocentric)", "wisdom-holman(kernel=lazy)", "saba(1)",
           "saba(2)", "saba(3)", "saba(4)", "saba(8,4)", "saba(8,6,4)", "saba(10,6,4)", *CORRECTED)


class WisdomHolman(CommandCase):
    def run_with(self, method, steps, mass="1e-3", time=8, arithmetic="double", more="", options="", sets=()):
        self.write("s.toml", SYSTEM.format(method=method, steps=steps, mass=mass, time=time, arithmetic=arithmetic,
                                           more=more, options=options))
        return self.summary("s.toml", *(part for one in sets for part in ("--set", one)))

    def error(self, method, steps, **rest):
        """The largest error of a position, beside dop853."""
        exact = self.run_with("dop853", 40, **rest)["final"]["q"]
        return max(abs(x - y) for x, y in zip(self.run_with(method, steps, **rest)["final"]["q"], exact))

    def test_orders(self):
        """The error of a step of half the length is a power of two smaller."""
        for method, order, steps in (("wisdom-holman", 2, 40), ("saba(1)", 2, 40), ("saba(8,4)", 4, 24),
                                     ("saba(8,6,4)", 4, 12), ("wisdom-holman(coordinates=democratic-heliocentric)", 2, 80)):
            mass = "0.02" if order == 4 else "1e-3"
            coarse, fine = (self.error(method, n, mass=mass) for n in (steps, 2 * steps))
            # Terms of higher order in dt are 1/4 of those before at most.
            self.assertGreater(math.log2(coarse / fine), order - 0.5, method)

    def test_errors_are_proportional_to_powers_of_the_masses(self):
        """Ten times less mass: ten times less error, for the lazy kernel and high orders more."""
        for method, power, steps in (("wisdom-holman", 1, 60), ("saba(2)", 2, 60), ("saba(3)", 2, 60)):
            heavy, light = (self.error(method, steps, mass=mass) for mass in ("1e-2", "1e-3"))
            self.assertGreater(math.log10(heavy / light), power - 0.35, method)

    def test_two_bodies_are_exact(self):
        """Without a second planet the kick is 0, and steps of any length end on the orbit: the mean anomaly has grown by
        the mean motion times the time."""
        text = ('[problem]\nname = "n-body"\nframe = "given"\nbodies = [{{ mass = 1 }}, {{ mass = "1/10", a = 1, e = 0.6, '
                'inclination = 1, mean_anomaly = "0.3 + {}*sqrt(11/10)" }}]\n[method]\nname = "{}"\n[run]\ndt = 3.75\n'
                'steps = {}\n')
        apart = lambda q: [q[3 + k] - q[k] for k in range(3)]
        for method in METHODS:
            if "helio" in method:
                continue  # whose J is no part of a motion of two bodies
            self.write("s.toml", text.format(0, method, 10))
            found = self.summary("s.toml")
            self.write("e.toml", text.format(37.5, method, 0))
            # Ten steps of up to nine drifts, with the rounding of the mean motion times 37.5.
            for x, y in zip(apart(found["final"]["q"]), apart(self.summary("e.toml")["final"]["q"])):
                self.assertAlmostEqual(x, y, delta=1e-12, msg=method)
            self.assertLess(found["energy"]["max_relative_error"], 1e-13, method)

    def test_invariants(self):
        for method in METHODS:
            s = self.run_with(method, 400, time=40)
            self.assertLess(s["invariants"]["angular_momentum"]["max_error"], 1e-16, method)
            self.assertLess(s["invariants"]["linear_momentum"]["max_error"], 1e-17, method)
            self.assertLess(s["energy"]["max_relative_error"], 1e-4, method)

    def test_more_digits(self):
        double, quad = (self.run_with("saba(10,6,4)", 200, arithmetic=a) for a in ("double", "quad"))
        for x, y in zip(double["final"]["q"], quad["final"]["q"]):
            self.assertAlmostEqual(x, float(y), delta=1e-13)
        self.assertLess(float(quad["invariants"]["angular_momentum"]["max_error"]), 1e-33)
        compensated = self.run_with("saba(10,6,4)", 200, arithmetic="compensated")
        self.assertAlmostEqual(compensated["final"]["q"][3], float(quad["final"]["q"][3]), delta=1e-14)

    def test_massless_bodies(self):
        """They change no bit of the others, and move as dop853 moves them."""
        dust = '{ name = "dust", mass = 0, a = 1.5, e = 0.2, inclination = 0.3, node = 2, primary = "Sun" },'
        for method in METHODS:
            alone = self.run_with(method, 400)["final"]["q"]
            beside = self.run_with(method, 400, more=dust)["final"]["q"]
            self.assertEqual(beside[:9], alone, method)
            exact = self.run_with("dop853", 40, more=dust)["final"]["q"]
            for x, y in zip(beside[9:], exact[9:]):
                self.assertAlmostEqual(x, y, delta=1e-5, msg=method)

    def test_correctors(self):
        """Energy errors shrink from order to order where the masses are small; the summary says which states they are of."""
        errors = []
        for method in ("wisdom-holman", *CORRECTED[:4]):
            s = self.run_with(method, 200, mass="1e-6", time=60, arithmetic="compensated",
                              sets=("run.record_every=1",))
            errors.append(s["energy"]["max_error"])
            self.assertEqual(s["energy"].get("of"), "recorded states" if "corrector" in method else None)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertLess(fine, coarse / 3, errors)

    def test_the_start_is_not_changed_by_a_corrector(self):
        plain, corrected = (self.run_with(method, 1, sets=("run.steps=0",))["final"]
                            for method in ("wisdom-holman", CORRECTED[4]))
        self.assertEqual(plain, corrected)

    def test_a_corrector_in_every_arithmetic(self):
        exact = self.run_with(CORRECTED[5], 100, arithmetic="mp(40)")["final"]["q"]
        for arithmetic, delta in (("double", 1e-13), ("compensated", 1e-14), ("double-double", 1e-28), ("quad", 1e-31)):
            found = self.run_with(CORRECTED[5], 100, arithmetic=arithmetic)["final"]["q"]
            for x, y in zip(found, exact):
                self.assertLess(abs(Decimal(x) - Decimal(y)), Decimal(delta), arithmetic)

    def test_resumed_runs(self):
        """A run that is extended, or killed, leaves what the uninterrupted run leaves."""
        for method in ("wisdom-holman", "wisdom-holman(coordinates=democratic-heliocentric)", CORRECTED[5], "saba(8,4)"):
            name = "r" + str(len(list(self.folder.iterdir())))
            self.write("s.toml", SYSTEM.format(method=method, steps=4000, mass="1e-3", time=400, arithmetic="compensated",
                                               more="", options="") + 'record_every = 10\n[output]\nelements = "jacobi"\n')
            self.hamflow("run", "s.toml", "--out", name + "whole")
            self.hamflow("run", "s.toml", "--set", "run.steps=1500", "--out", name)
            self.hamflow("run", "s.toml", "--out", name, "--resume")
            self.assertEqual(differences(COMPARE, self.folder / (name + "whole"), self.folder / name), [], method)

    def test_ensembles(self):
        """Members of a sweep end where runs of their own end."""
        for method in ("wisdom-holman", CORRECTED[3], "saba(10,6,4)"):
            self.write("s.toml", SYSTEM.format(method=method, steps=100, mass="1e-3", time=10, arithmetic="double",
                                               more="", options=""))
            out = f"sweep{len(list(self.folder.iterdir()))}"
            self.hamflow("sweep", "s.toml", "--vary", "problem.bodies[1].e=0.01,0.1,0.3",
                         "--set", 'output.formats=["csv"]', "--out", out)
            rows = list(csv.DictReader((self.folder / out / "sweep.csv").read_text().splitlines()))
            for row, e in zip(rows, ("0.01", "0.1", "0.3")):
                alone = self.summary("s.toml", "--set", f"problem.bodies[1].e={e}")
                self.assertEqual(float(row["energy/final"]), alone["energy"]["final"], row)

    def test_verify_measures_the_claims(self):
        # Those that `verify --all` measures. In other long correctors a step costs 30 times as much, and verify minutes.
        for method in (*METHODS[:10], CORRECTED[0], CORRECTED[5]):
            done = self.hamflow("verify", method, "--json", status=None)
            (found,) = json.loads(done.stdout)["methods"]
            self.assertEqual(done.returncode, 0, found)

    def test_close_encounters_are_told(self):
        more = '{ name = "dust", mass = 0, a = 1.02, mean_anomaly = 3, primary = "Sun" },'
        for method in (*METHODS[:3], CORRECTED[3], "saba(4)"):
            s = self.run_with(method, 4000, time=400, more=more)
            told = [w["message"] for w in s["warnings"] if w["kind"] == "close_encounter"]
            self.assertEqual(len(told), 1, s["warnings"])
            self.assertIn("inner and dust came within 3 Hill radii of each other at t = ", told[0])
            self.assertIn("try dop853", told[0])
            quiet = self.run_with(method, 400, time=40)
            self.assertEqual([w for w in quiet["warnings"] if w["kind"] == "close_encounter"], [])

    def test_close_encounters_of_members_are_told(self):
        self.write("s.toml", SYSTEM.format(method="wisdom-holman", steps=4000, mass="1e-3", time=400, arithmetic="double", options="",
                                           more='{ name = "dust", mass = 0, a = 1.02, mean_anomaly = 3, primary = "Sun" },'))
        done = self.hamflow("sweep", "s.toml", "--vary", "problem.bodies[3].a=4,1.02,1.021,5", "--json", "--out", "met")
        told = [w["message"] for w in json.loads(done.stdout)["warnings"] if w["kind"] == "close_encounter"]
        self.assertEqual(len(told), 1)
        self.assertIn("in 2 of 4 members, first in member 1, two bodies came within 3 Hill radii", told[0])

    def test_it_is_reversible(self):
        s = self.run_with("saba(8,6,4)", 1000, time=100)
        self.assertEqual(s["certificate"]["reversal_distance"]["proves"], "reversible to rounding")

    def test_every_bit_returns_on_the_lattice(self):
        """In one process, and in a run that is extended; the energy error is that of the map in double."""
        helio = "wisdom-holman(coordinates=democratic-heliocentric)"
        in_double = self.run_with(helio, 4000, time=400)
        on_lattice = self.run_with(helio, 4000, time=400, arithmetic="lattice")
        self.assertIs(on_lattice["certificate"]["reversal_distance"]["bit_exact"], True)
        # Equal but for roundings, of 2e-16 of the largest momentum, while the map itself errs by 1e-6.
        self.assertAlmostEqual(on_lattice["energy"]["max_relative_error"] / in_double["energy"]["max_relative_error"], 1,
                               delta=1e-5)
        found = json.loads(self.hamflow("reverse", "s.toml", "--json").stdout)
        self.assertIs(found["bit_exact"], True)
        self.hamflow("run", "s.toml", "--out", "whole.run")
        self.hamflow("run", "s.toml", "--set", "run.steps=1500", "--out", "parts.run")
        self.hamflow("run", "s.toml", "--out", "parts.run", "--resume")
        self.assertEqual(differences(COMPARE, self.folder / "whole.run", self.folder / "parts.run"), [])

    def test_the_lattice_refuses_orbits_through_the_star(self):
        self.write("s.toml", SYSTEM.format(method="wisdom-holman(coordinates=democratic-heliocentric)", steps=10, mass="1e-3",
                                           time=1, arithmetic="lattice", more="", options=""))
        done = self.hamflow("run", "s.toml", "--set", "problem.bodies[1].e=0.99999", "--out", "none", status=None)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("so near to the first one that a drift of half a step would need more than 4096 parts", done.stderr)

    def test_lyapunov_exponents(self):
        """The derivative of a step in Kepler drifts: two regular planets have exponents near 0."""
        self.write("l.toml", SYSTEM.format(method="wisdom-holman", steps=2000, mass="1e-3", time=200, arithmetic="double",
                                           more="", options="") + "lyapunov = 1\n")
        self.assertLess(abs(self.summary("l.toml")["lyapunov"]["exponents"][0]), 0.1)

    def test_refusals(self):
        self.write("base.toml", SYSTEM.format(method="wisdom-holman", steps=4, mass="1e-3", time=1, arithmetic="double",
                                              more="", options=""))
        for sets, key, words in (
            (["problem.softening=0.1"], "problem.softening", "whose bodies move on conics; allowed 0"),
            (['run.arithmetic="lattice"'], "run.arithmetic", 'no bijection of the lattice; coordinates = "democratic-heliocentric" are'),
            (['run.arithmetic="lattice"', 'method.name="saba(4)"'], "run.arithmetic", "no bijection of the lattice"),
            (["problem.bodies[1].mass=2"], "method.name", "inner heavier than the first body; allowed the heaviest body first"),
            (['problem.walls=[{coordinate="x1",min=-9,max=9}]'], "problem.walls", "found walls with wisdom-holman"),
            (['method.kernel="lasy"'], "method.kernel", "did you mean lazy?"),
            (["method.corrector=4"], "method.corrector", "found 4; allowed 0, 3, 5, 7, 11, 17"),
            (["method.corrector=18"], "method.corrector", "allowed"),
            (["method.corrector=7", 'method.coordinates="democratic-heliocentric"'], "method.corrector",
             "found 7 with democratic-heliocentric coordinates; allowed with jacobi"),
            (["method.corrector=7", 'method.step_control="reversible"'], "method.step_control", "not symmetric"),
            (['method.kernel="lazy"', 'method.coordinates="democratic-heliocentric"'], "method.kernel", "allowed with jacobi"),
            (['method.name="saba(8,6)"'], "method.name", "found saba(8,6); allowed saba(1), saba(2)"),
            (['method.name="saba(5)"'], "method.name", "found saba(5)"),
        ):
            arguments = [part for one in sets for part in ("--set", one)]
            done = self.hamflow("run", "base.toml", *arguments, "--out", "none", "--json", status=2)
            found = json.loads(done.stdout)["errors"]
            self.assertIn(key, [error["key"] for error in found], found)
            self.assertIn(words, " ".join(error["message"] for error in found))
        self.write("p.toml", '[problem]\nname = "pendulum"\ninitial = { q = [1], p = [0] }\n[method]\nname = "wisdom-holman"\n'
                             "[run]\ndt = 0.1\nsteps = 1\n")
        self.assertIn("bodies under gravity", self.hamflow("run", "p.toml", "--out", "none", status=2).stderr)


if __name__ == "__main__":
    unittest.main()

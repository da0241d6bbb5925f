"""In which frame bodies start: as given, or that of their centre of mass, at rest."""

import math
import unittest

from command import CommandCase

EPSILON = 2.0**-52
BODIES = """
[problem]
name = "n-body"
masses = [1, "1/3", 0.1]
{frame}
initial = {{ q = [0, 0, 1, 0, 0, "1/7"], v = [0.1, 0, 0, 1, "1/3", 0] }}
[method]
name = "verlet"
[run]
dt = 0.01
steps = {steps}
arithmetic = "{arithmetic}"
"""
SOLAR = '[problem]\nname = "solar-system"\n{frame}\n[method]\nname = "stv4"\n[run]\ndt = 50\nsteps = {steps}\n'


class Frame(CommandCase):
    def run_text(self, text, *arguments):
        self.write("s.toml", text)
        return self.summary("s.toml", *arguments)

    def bodies(self, frame="", arithmetic="double", steps=0):
        return self.run_text(BODIES.format(frame=frame, arithmetic=arithmetic, steps=steps))

    def test_bodies_stay_as_given_by_default(self):
        s = self.bodies()
        self.assertEqual(s["parameters"]["frame"], "given")
        self.assertEqual(s["final"]["q"], [0, 0, 1, 0, 0, 1 / 7])
        self.assertEqual(s, {**self.bodies('frame = "given"'), "wall_seconds": s["wall_seconds"],
                             "steps_per_second": s["steps_per_second"]})

    def test_the_centre_of_mass_comes_to_the_origin_and_to_rest(self):
        given = self.bodies()
        moved = self.bodies('frame = "barycentric"')
        for name in ("linear_momentum", "centre_of_mass"):
            self.assertGreater(max(map(abs, given["invariants"][name]["initial"])), 0.01)
            # After the second pass what is left are the roundings of three subtractions of numbers up to 1.
            self.assertLess(max(map(abs, moved["invariants"][name]["initial"])), 8 * EPSILON)
        for i in range(0, 6, 2):  # differences of positions, and of velocities, are those that were given
            for k in (0, 1):
                difference = lambda s, key: s["final"][key][i + k] - s["final"][key][k]
                self.assertLess(abs(difference(given, "q") - difference(moved, "q")), 8 * EPSILON)
        masses = [1, 1, 1 / 3, 1 / 3, 0.1, 0.1]
        v = [[p / m for p, m in zip(s["final"]["p"], masses)] for s in (given, moved)]
        for i in range(6):
            self.assertLess(abs((v[0][i] - v[0][i % 2]) - (v[1][i] - v[1][i % 2])), 16 * EPSILON)

    def test_in_all_digits(self):
        from decimal import Decimal, getcontext
        getcontext().prec = 60
        for arithmetic, unit in (("quad", "1e-33"), ("double-double", "1e-31"), ("mp(50)", "1e-50")):
            s = self.bodies('frame = "barycentric"', arithmetic)
            masses = [Decimal(1), Decimal(1) / 3, Decimal(1) / 10]
            for k in (0, 1):
                p = sum(Decimal(x) for x in s["final"]["p"][k::2])
                c = sum(m * Decimal(x) for m, x in zip(masses, s["final"]["q"][k::2]))
                self.assertLess(max(abs(p), abs(c)), 32 * Decimal(unit), arithmetic)

    def test_the_solar_system_rests_by_default(self):
        s = self.run_text(SOLAR.format(frame="", steps=0))
        self.assertEqual(s["parameters"]["frame"], "barycentric")
        largest = max(map(abs, s["final"]["p"]))
        self.assertLess(max(map(abs, s["invariants"]["linear_momentum"]["initial"])), 8 * EPSILON * largest)
        self.assertLess(max(map(abs, s["invariants"]["centre_of_mass"]["initial"])), 8 * EPSILON)
        self.assertEqual(s, {**self.run_text(SOLAR.format(frame='frame = "barycentric"', steps=0)),
                             "wall_seconds": s["wall_seconds"], "steps_per_second": s["steps_per_second"]})

    def test_a_start_of_ones_own_stays_as_it_is(self):
        given = self.run_text(SOLAR.format(frame='frame = "given"', steps=0))["final"]
        own = f"initial = {{ q = {given['q']}, p = {given['p']} }}"
        s = self.run_text(SOLAR.format(frame=own, steps=0))
        self.assertEqual(s["parameters"]["frame"], "given")
        self.assertEqual(s["final"], given)
        moved = self.run_text(SOLAR.format(frame=own + '\nframe = "barycentric"', steps=0))
        rest = self.run_text(SOLAR.format(frame="", steps=0))
        for a, b in zip(moved["final"]["q"] + moved["final"]["p"], rest["final"]["q"] + rest["final"]["p"]):
            self.assertLess(abs(a - b), 8 * EPSILON * 30)

    def test_what_a_frame_at_rest_is_good_for(self):
        """The heliocentric start drifts by P t/M, and its energy loses digits to a motion that means nothing."""
        drift = {}
        error = {}
        for frame in ("given", "barycentric"):
            s = self.run_text(SOLAR.format(frame=f'frame = "{frame}"', steps=100_000))
            masses = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449,
                      1 / 1.3e8]
            centre = [sum(m * x for m, x in zip(masses, s["final"]["q"][k::3])) / sum(masses) for k in range(3)]
            drift[frame] = math.hypot(*centre)
            error[frame] = s["energy"]["max_relative_error"]
        self.assertGreater(drift["given"], 25)  # AU in 13 700 years
        self.assertLess(drift["barycentric"], 1e-9)

    def test_refused(self):
        self.write("s.toml", SOLAR.format(frame='frame = "barycenter"', steps=0))
        text = self.hamflow("run", "s.toml", "--out", "none", status=2).stderr
        self.assertIn("allowed given, barycentric", text)
        self.assertIn("did you mean barycentric?", text)
        text = self.hamflow("run", "kepler.toml", "--out", "none", "--set", "problem.frame=given", status=2).stderr
        self.assertIn("unknown key", text)

    def test_declared(self):
        for name in ("n-body", "solar-system"):
            self.assertIn("frame", self.hamflow("show", name).stdout)
            self.assertIn("frame = ", self.hamflow("new", name, "--all").stdout)


if __name__ == "__main__":
    unittest.main()

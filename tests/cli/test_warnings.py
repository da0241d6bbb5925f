"""What is plainly nonsense says so, in the summary and on stderr; what is right is left in peace."""

import json
import math
import random
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

RUN = """
[problem]
{problem}
[method]
name = "{method}"
[run]
{run}
"""
KEPLER = 'name = "central-force"\npotential = "kepler"\nmass = 2.0\norbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }'
PERIOD = 2 * math.pi * math.sqrt(2 * 2.0**3)  # of a = 2, k = 1, mass = 2
LEVEL = 'name = "pendulum"\ninitial = { q = ["pi/2"], p = [0] }'


class Warnings(CommandCase):
    def warned(self, problem, method, run, *extra):
        """The kinds of the warnings; they stand on stderr too, whatever is printed besides."""
        self.write("s.toml", RUN.format(problem=problem, method=method, run=run))
        done = self.hamflow("run", "s.toml", "--out", "none", "--json", "--quiet", *extra)
        summary = json.loads(done.stdout)
        self.assertEqual(summary["status"], "done")
        lines = [f"warning: {w['kind']}: {w['message']}" for w in summary["warnings"]]
        self.assertEqual(done.stderr.splitlines(), lines)
        return [w["kind"] for w in summary["warnings"]]

    def test_a_step_longer_than_the_period(self):
        for method in ("verlet", "stv4", "yoshida6"):
            kinds = self.warned(KEPLER, method, "dt = 30\nsteps = 500")
            self.assertIn("energy_error", kinds, method)
            self.assertIn("long_step", kinds, method)

    def test_ten_steps_a_period_are_the_limit(self):
        for coordinates in ("cartesian", "polar"):
            problem = KEPLER + f'\ncoordinates = "{coordinates}"'
            for steps, kinds in ((8, ["long_step"]), (12.5, [])):
                for method in ("kahan-li8", "dop853(step_control=fixed)")[coordinates == "polar":]:
                    run = f"dt = {PERIOD / steps}\nsteps = 300"
                    found = [k for k in self.warned(problem, method, run) if k == "long_step"]
                    self.assertEqual(found, kinds, (coordinates, steps, method))

    def test_copies_of_the_state_that_part(self):
        """Two point vortices under tao4: with springs too slow for them they fly apart."""
        vortices = ('name = "formula"\ncoordinates = ["x", "y"]\nhamiltonian = "-log((x-y)^2 + (p_x-p_y)^2)/(4*pi)"\n'
                    'initial = { q = [0, 0.01], p = [0, 0] }')
        run = "dt = 1e-4\nsteps = 20000"
        self.assertIn("parted_copies", self.warned(vortices, "tao4", run))
        self.assertEqual(self.warned(vortices, "tao4(omega=10000)", "dt = 1e-5\nsteps = 20000"), [])
        self.assertEqual(self.warned(vortices, "gauss(2)", run), [])

    def test_a_run_that_left_its_orbit(self):
        """At the pericentre of a narrow ellipse |T| + |V| is 200 |H|, so that the energy error stays below its scale."""
        narrow = 'name = "central-force"\npotential = "kepler"\norbit = { kind = "ellipse", r_per = 0.01, r_aph = 1.0 }'
        for coordinates in ("cartesian", "polar"):
            problem = narrow + f'\ncoordinates = "{coordinates}"'
            method = "dop853(step_control=fixed)" if coordinates == "polar" else "kahan-li8"
            self.assertIn("left_orbit", self.warned(problem, method, "dt = 0.01\nsteps = 20000"), coordinates)
            self.assertEqual(self.warned(problem, "dop853", "dt = 0.001\nsteps = 300"), [], coordinates)
        self.assertIn("left_orbit", self.warned(KEPLER, "euler", "dt = 0.2\nsteps = 3500"))

    def test_a_run_too_short_to_see_a_period_knows_that_of_its_orbit(self):
        self.assertIn("long_step", self.warned(KEPLER, "kahan-li8", f"dt = {PERIOD / 8}\nsteps = 3"))
        self.assertEqual(self.warned(KEPLER, "kahan-li8", f"dt = {PERIOD / 40}\nsteps = 3"), [])

    def test_a_first_step_of_many_lengths_that_is_longer_than_the_period(self):
        method = "gauss(2,step_control=reversible)"
        for dt in (1e5, PERIOD):  # straight on, without a bend
            self.assertIn("long_step", self.warned(KEPLER, method, f"dt = {dt}\nsteps = 3"))
        self.assertEqual(self.warned(KEPLER, method, f"dt = {PERIOD / 40}\nsteps = 100"), [])

    def test_steps_that_have_left_their_density(self):
        # From 0.005 on at the pericentre of e = 0.9 the summed density of arclength ends at steps of a period and more.
        lost = KEPLER.replace("mass = 2.0\n", "").replace("r_per = 1.0, r_aph = 3.0", "r_per = 0.1, r_aph = 1.9")
        for monitor, kinds in (("arclength", ["long_step"]), ("distance", [])):
            method = f"kahan-li8(step_control=reversible,monitor={monitor})"
            found = self.warned(lost, method, "dt = 0.005\nsteps = 100_000")
            self.assertEqual([kind for kind in found if kind == "long_step"], kinds, monitor)

    def test_sub_steps_of_a_methods_own_may_be_long(self):
        for method in ("dop853", "taylor"):
            self.assertEqual(self.warned(KEPLER, method, "dt = 30\nsteps = 50"), [])
            self.assertIn("long_step", self.warned(KEPLER, method + "(step_control=fixed)", "dt = 5\nsteps = 50"))

    def test_roots_that_have_nothing_to_do_with_the_motion(self):
        # Steps that an angle of hundreds of radians leaves: times the torque that is more than the energy is wrong by.
        wild = 'name = "double-pendulum"\nmasses = [2, 2]\nhalf_lengths = [3, 3]\ninitial = { q = [2.5, 3], p = [100, -300] }'
        for steps in (2, 3, 5):
            self.assertIn("energy_error", self.warned(wild, "gauss(1)", f"dt = 0.05\nsteps = {steps}"), steps)

    def test_a_fall_into_the_centre(self):
        fall = 'name = "central-force"\npotential = "kepler"\ninitial = { q = [1, 0], p = [0, 0] }'
        time = math.pi / math.sqrt(8)  # from rest at r = 1
        steps = 1000
        for method in ("verlet", "cg"):
            self.assertEqual(self.warned(fall, method, f"dt = {0.9 * time / steps}\nsteps = {steps}"), [])
        for method, dt, steps in (("verlet", 1.3 * time / 100, 100), ("cg(1,5)", 0.2, 20)):
            kinds = self.warned(fall, method, f"dt = {dt}\nsteps = {steps}")
            self.assertEqual(kinds, ["energy_error", "falls_into_centre"], method)
        # Thrown up from r = 1 with half of what is needed to escape: up to r = 4/3 and back in.
        up = fall.replace("p = [0, 0]", 'p = ["sqrt(1/2)", 0]')
        back = (math.pi + math.acos(2 / (4 / 3) - 1) + math.sin(math.acos(2 / (4 / 3) - 1))) * math.sqrt((2 / 3) ** 3)
        self.assertEqual(self.warned(up, "verlet", f"dt = {0.97 * back / 20000}\nsteps = 20000"), [])
        self.assertIn("falls_into_centre", self.warned(up, "verlet", f"dt = {1.03 * back / 200}\nsteps = 200"))
        hooke = 'name = "central-force"\npotential = "hooke"\ninitial = { q = [1, 0], p = [0, 0] }'
        self.assertEqual(self.warned(hooke, "verlet", "dt = 0.05\nsteps = 1000"), [], "its centre is a point like any other")

    def test_a_start_whose_energy_vanishes_by_chance(self):
        self.assertEqual(self.warned(LEVEL, "verlet", "dt = 0.2\nsteps = 1000"), [])
        self.assertEqual(self.warned('name = "free-fall"\ninitial = { q = [0], p = [0] }', "cg", "dt = 0.1\nsteps = 1000"), [])
        self.assertIn("energy_error", self.warned(LEVEL, "euler", "dt = 0.5\nsteps = 300"))

    def test_examples_are_left_in_peace(self):
        for example in sorted(EXAMPLES.glob("*.toml")):
            # In a gas for long a particle stands on the soft wall sooner or later.
            steps = 20 if example.stem == "melt" else 500 if example.stem.startswith("gas") else 3000
            text = subprocess.run([HAMFLOW, "run", example, "--out", "none", "--json", "--set", f"run.steps={steps}",
                                   "--set", "output.figures=[]"], capture_output=True, text=True, timeout=120)
            self.assertEqual(text.returncode, 0, text.stderr)
            self.assertEqual(json.loads(text.stdout)["warnings"], [], example.name)

    def test_two_particles_through_each_other(self):
        two = 'name = "gas"\ncontainer = {{ kind = "none" }}\n{}initial = {{ q = [-3.05, 0, 3, 0.1], p = [{}, 0, -{}, 0] }}'
        for keys, p in (("", 20), ("masses = 2\n", 40)):
            through = self.warned(two.format(keys, p, p), "verlet", "dt = 0.1\nsteps = 4")
            self.assertEqual(through, ["long_step"], keys)
        self.assertEqual(self.warned(two.format("sigma = 40\n", 1, 1), "verlet", "dt = 0.1\nsteps = 0"), [])
        self.assertEqual(self.warned(two.format("", 20, 20), "verlet", "dt = 0.1\nsteps = 0"), [], "none has moved")
        self.assertEqual(self.warned(two.format('pair = "newton"\n', 20, 20), "verlet", "dt = 0.1\nsteps = 4"), [])
        self.assertEqual(self.warned(two.format("", 1, 1), "verlet", "dt = 0.02\nsteps = 100"), [])

    def test_good_runs_are_left_in_peace(self):
        rng = random.Random(8)
        problems = {  # and the shortest period that their motion shows
            'name = "pendulum"\ninitial = {{ q = [{0}], p = [{1}] }}': 5,  # angles that grow among them
            'name = "henon-heiles"\ninitial = {{ q = ["{0}/5", "{1}/5"], p = [0.1, "{0}/5"] }}': 6,
            'name = "harmonic"\nomega = 3\ninitial = {{ q = [{0}], p = [{1}] }}': 2.1,
            'name = "lennard-jones-oscillator"\ninitial = {{ q = [1.2], p = ["{0}/5"] }}': 0.8,
            'name = "n-body"\nmasses = [1, 0.01]\nframe = "barycentric"\n'
            'initial = {{ q = [0, 0, 1, 0], v = [0, 0, "{0}/5", 0.9] }}': 3.5,
            'name = "fput"\nn = 5\nalpha = 0.2\ninitial = {{ q = [{0}, 0, {1}, 0, 0], p = [0, 0, 0, 0, 0.1] }}': 3.1,
            'name = "central-force"\npotential = "kepler"\ncoordinates = "polar"\n'
            'initial = {{ q = [1, 0], p = ["{0}/5", 0.9] }}': 3.5,
            'name = "magnetic"\nfield = [0, 0, 1]\ninitial = {{ q = [1, {0}, 0], p = [{1}, 1, 0.1] }}': 6,
        }
        for pattern, period in problems.items():
            for _ in range(6):
                problem = pattern.format(rng.uniform(-1, 1), rng.uniform(-2, 2))
                dt = period / rng.uniform(16, 100)
                method = rng.choice(["verlet", "kahan-li8"])
                if "magnetic" in problem:
                    method = "boris" if method == "verlet" else "cg"
                if "polar" in problem:
                    method = "rk4" if method == "verlet" else "cg"
                self.assertEqual(self.warned(problem, method, f"dt = {dt}\nsteps = {rng.choice([30, 400, 3000])}"), [],
                                 (problem, dt, method))

    def test_a_run_that_goes_on_warns_the_same(self):
        text = RUN.format(problem=KEPLER, method="kahan-li8", run=f"dt = {PERIOD / 7}\nsteps = 400")
        self.write("s.toml", text)
        whole = json.loads(self.hamflow("run", "s.toml", "--out", "whole", "--json").stdout)["warnings"]
        self.assertEqual([w["kind"] for w in whole], ["long_step"])
        for cut in (10, 100, 150):
            out = f"cut{cut}"
            self.hamflow("run", "s.toml", "--set", f"run.steps={cut}", "--out", out)
            parts = self.hamflow("run", "s.toml", "--out", out, "--resume", "--json")
            self.assertEqual(json.loads(parts.stdout)["warnings"], whole, cut)
        again = self.hamflow("run", "s.toml", "--out", "whole", "--resume", "--quiet")
        self.assertEqual(again.stderr, f"warning: long_step: {whole[0]['message']}\n")

    def test_shell(self):
        self.write("s.toml", RUN.format(problem=KEPLER, method="verlet", run="dt = 0.1\nsteps = 1"))
        done = subprocess.run([HAMFLOW, "shell", "s.toml", "--quiet"], cwd=self.folder, capture_output=True, text=True,
                              input=f"step 100\ndt {PERIOD / 7}\nstep 40\nstep 40\ndt 0.1\nsave out\n", timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        kinds = [line.split(": ")[1] for line in done.stderr.splitlines()]
        self.assertEqual(kinds.count("long_step"), 1, done.stderr)
        saved = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertIn("long_step", [w["kind"] for w in saved["warnings"]])

    def test_sweep(self):
        self.write("s.toml", RUN.format(problem=KEPLER, method="verlet", run="dt = 0.1\nsteps = 300"))
        for lanes in ("auto", "none"):
            done = self.hamflow("sweep", "s.toml", "--vary", "run.dt=0.05,30,0.1,28", "--out", "none", "--json",
                                "--quiet", "--lanes", lanes)
            (warning,) = json.loads(done.stdout)["warnings"]
            self.assertEqual(warning["kind"], "energy_error")
            self.assertIn("2 of 4 members", warning["message"])
            self.assertIn("member 1", warning["message"])
            self.assertEqual(done.stderr, f"warning: energy_error: {warning['message']}\n")
        good = self.hamflow("sweep", "s.toml", "--vary", "run.dt=0.05,0.1", "--out", "none", "--json")
        self.assertEqual(json.loads(good.stdout)["warnings"], [])


if __name__ == "__main__":
    unittest.main()

"""Walls beside what else a run has: events, reversals, sweeps, comparisons, starts of given energy."""

import decimal
import json
import math
import unittest

from test_walls import WallCase


class BesideWalls(WallCase):
    def test_events_beside_bounces(self):
        """A ball of period 2 that bounces at odd times: its momentum jumps from -1 to 1 there, and passes 0.95 and -0.95
        downwards 0.05 behind the bounce and before it. The motion is exact for each of the methods, at any step."""
        self.write("ball.toml", """
[problem]
name = "free-fall"
walls = [{ coordinate = "q", min = 0 }]
initial = { q = [0.5], p = [0] }
[method]
name = "verlet"
[run]
dt = 0.09
steps = 1111
events = [{ expression = "p - 0.95", direction = -1 }, { expression = "p + 0.95", direction = -1 },
          { expression = "q - 0.1", direction = 0 }]
section = { coordinate = "p", value = 0.95, direction = -1 }
""")
        for method in ("verlet", "stv4", "cg(2,auto)", "gauss(2)", "dop853"):
            found = self.summary("ball.toml", "--set", f"method.name={method}")
            self.assertEqual([found["events"][f"user:event{i}"] for i in (1, 2, 3)] + [found["section"]["points"]],
                             [50, 50, 100, 50], method)
        # However long the steps are beside the time between bounces.
        for dt, steps in ((0.65, 154), (1.3, 77)):
            found = self.summary("ball.toml", "--set", f"run.dt={dt}", "--set", f"run.steps={steps}")
            self.assertEqual([found["events"][f"user:event{i}"] for i in (1, 2, 3)], [50, 50, 100], dt)
        stop = self.summary("ball.toml", "--set", "run.events=[{expression='p-0.95',direction=-1,action='stop'}]")["stopped_by"]
        self.assertAlmostEqual(stop["t"], 1.05, delta=1e-12)
        told = json.loads(self.hamflow("sweep", "ball.toml", "--vary", "run.dt=0.09,0.045", "--set", "run.events=[]", "--out",
                                       "none", "--json").stdout)
        self.assertEqual([row["section"]["points"] for row in told["rows"]], [50, 25])

    def test_bodies_keep_their_names_behind_walls(self):
        self.write("named.toml", """
[problem]
name = "n-body"
masses = [1, 0.5, 0.2]
softening = 0.1
initial = { q = [0, 0, 1, 0.1, -0.7, 0.8], p = [0.3, 0.1, -0.2, 0.5, 0.1, -0.2] }
walls = [{ coordinate = "y2", min = -0.6, max = 0.5 }]
[method]
name = "stv4"
[run]
dt = 0.01
steps = 1000
section = { coordinate = "y2" }
events = [{ expression = "y2 - 0.25" }]
[output]
observables = { a = "x1*p_y2 + q1*p4" }
""")
        events = self.summary("named.toml")["events"]
        self.assertGreater(events["wall:y2:max"], 0)
        self.assertIn("allowed x1, y1, x2, y2", self.refused("named.toml", "--set", "run.section.coordinate=y4"))

    def test_a_reversal_to_a_wall_proves_nothing(self):
        """There the state before the bounce and that behind it are one: which of them comes back says nothing."""
        for rule in ("event", "mirror"):
            told = self.summary(self.free("verlet", f'wall_rule = "{rule}"'), "--set", "problem.initial={q=[1],p=[1]}",
                                "--set", "run.dt=0.3", "--set", "run.steps=1")["certificate"]["reversal_distance"]
            self.assertEqual(told["proves"], "nothing", told)
            self.assertIn("starts on a wall", told["reason"])

    def test_what_a_note_of_a_reversal_proposes_is_possible(self):
        def note(*arguments):
            return json.loads(self.hamflow("reverse", *arguments, "--json").stdout)["note"]

        box = ('[{ coordinate = "q1", min = -0.5, max = 0.5 }]', "stv4")
        every_bit = "a palindromic splitting returns every bit"
        self.assertIn('with run.arithmetic = "lattice" and problem.wall_rule = "mirror" ' + every_bit, note(self.box(*box)))
        self.assertIn('with run.arithmetic = "lattice" ' + every_bit, note(self.box(*box, 'wall_rule = "mirror"')))
        self.assertTrue(json.loads(self.hamflow("reverse", self.box(*box, 'wall_rule = "mirror"'), "--set",
                                                "run.arithmetic=lattice", "--json").stdout)["bit_exact"])
        rejecting = note(self.box(*box, 'wall_rule = "reject"'))
        self.assertNotIn("every bit", rejecting)
        self.assertIn("no exact return is expected", rejecting)

    def test_a_mirror_that_is_left_too_far_names_its_coordinate(self):
        file = self.free("verlet", 'wall_rule = "mirror"')
        done = self.hamflow("run", file, "--out", "none", "--set", "run.dt=5000", status=1)
        self.assertIn("more than 1000 bounces in one step, the last off the wall of x", done.stderr)

    def test_an_h_that_no_wall_throws_back(self):
        for rule in ("event", "reject"):
            self.write("one_way.toml", f"""
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x + x^2/2"
initial = {{ q = [0], p = [1] }}
walls = [{{ coordinate = "x", max = 1 }}]
wall_rule = "{rule}"
[method]
name = "verlet"
[run]
dt = 0.1
steps = 20
""")
            error = self.summary("one_way.toml", status=1)["error"]
            self.assertIn("at the wall of x no other momentum", error["message"])
            self.assertIn("H = E has only one root in this momentum", error["hint"])
            self.assertIn("a smaller dt does not help", error["hint"])

    def free(self, method, rule=""):
        return self.write("free.toml", f"""
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2"
initial = {{ q = [0.3], p = [1] }}
walls = [{{ coordinate = "x", min = 0, max = 1 }}]
{rule}
[method]
name = "{method}"
[run]
dt = 7.3
steps = 10
""")

    def test_the_period_between_bounces_within_a_step(self):
        """The true period is 2; the ends of the steps alone show one of 20.6. Free flight is exact with any step."""
        self.assertNotIn("long_step", self.hamflow("run", self.free("verlet"), "--out", "none").stderr)
        bent = ("--set", "problem.hamiltonian=p_x^2/2 + x^2/1e6")
        for arguments in (("run", self.free("verlet"), "--out", "none"), ("reverse", self.free("verlet"))):
            text = self.hamflow(*arguments, *bent).stderr
            self.assertRegex(text, r"a tenth of the shortest period seen, (1\.9\d|2) \(of x\); try dt = 0\.(09\d+|1) or less")

    def test_events_that_jump_at_walls(self):
        file = self.free("verlet")
        jumps = ("--set", "run.events=[{expression='p_x',direction=0}]", "--set", "run.dt=0.1", "--set", "run.steps=73")
        s = self.summary(file, *jumps)
        self.assertEqual(s["events"]["user:event1"], 0)
        bounces = s["events"]["wall:x:min"] + s["events"]["wall:x:max"]
        sentence = f"event1: {bounces} changes of sign were not zeros: the expression jumps or has a pole there"
        self.assertEqual(s["event_notes"], [sentence])
        self.assertIn(sentence, self.hamflow("run", file, *jumps, "--out", "none").stdout)
        self.assertNotIn("event_notes", self.summary(file, "--set", "run.events=[{expression='x-0.5',direction=0}]"))

    def test_a_comparison_says_which_wall(self):
        for rule, dt, words, hint in (
                ('wall_rule = "soft"\nstrength = 1e-9\nexponent = 2', "0.7", "x was on or beyond a soft wall",
                 "a larger exponent"),
                ('wall_rule = "mirror"', "1300", "more than 1000 bounces in one step, the last off the wall of x",
                 "pressed onto a wall")):
            done = self.hamflow("compare", self.free("stv4", rule), "--methods", "stv4", "--set", f"run.dt={dt}", "--set",
                                "run.steps=1", "--dt", dt, "--json", status=1)
            (row,) = json.loads(done.stdout)["rows"]
            self.assertIn(words, row["reason"])
            self.assertIn(hint, row["hint"])
            self.assertIn(words, done.stderr)
            self.assertIn(hint, done.stderr)

    def test_a_sweep_counts_for_each_member(self):
        self.tube()
        self.hamflow("sweep", "tube.toml", "--vary", "problem.velocities[0]=1,6", "--out", "s.sweep", "--set",
                     "output.formats=['csv']")
        rows = (self.folder / "s.sweep/sweep.csv").read_text().splitlines()
        head = rows[0].split(",")
        at = head.index("events/wall:q1:max")
        for row, speed in zip(rows[1:], ("1", "6")):
            one = self.summary("tube.toml", "--set", f"problem.velocities=[{speed}, 1]")
            self.assertEqual(int(row.split(",")[at]), one["events"]["wall:q1:max"])
            self.assertEqual(float(row.split(",")[head.index("observables/kinetic1_mean")]),
                             one["observables"]["kinetic1"]["mean"])

    def test_compare_has_a_reference(self):
        done = json.loads(self.hamflow("compare", self.tube(), "--methods", "cg(3,auto),stv4", "--set", "run.steps=100",
                                       "--out", "none", "--json").stdout)
        self.assertEqual(done["reference"]["kind"], "integration")
        errors = {row["method"]: row["error"] for row in done["rows"]}
        self.assertLess(errors["cg(3,auto)"], 1e-6)

    def test_long_steps_have_the_same_bounces_whoever_takes_them(self):
        """Loops of recorded steps, lanes and runs that go on: with steps of half a period, too."""
        text = ('[problem]\nname = "harmonic"\ninitial = { q = [-0.004598], p = [0.37009] }\n'
                'walls = [{ coordinate = "q", min = -0.3147, max = 0.5044 }]\n[method]\nname = "%s"\n[run]\ndt = %s\nsteps = 900\n')
        for method, dt in (("verlet", "2.9117"), ("stv4", "1.3"), ("rk4", "2.3"), ("gauss(2)", "1.7"), ("taylor", "5")):
            name = self.write("long.toml", text % (method, dt))
            whole = self.summary(name)
            self.hamflow("run", name, "--out", "part.run", "--set", "run.steps=41", "--force")
            parts = json.loads(self.hamflow("run", name, "--out", "part.run", "--resume", "--json").stdout)
            lane = json.loads(self.hamflow("sweep", name, "--vary", f"run.dt={dt},{dt}", "--out", "none", "--json").stdout)["rows"][0]
            for other in (parts, lane):
                self.assertEqual((other["final"], other["events"]), (whole["final"], whole["events"]), method)

    def test_long_steps_are_looked_into_once(self):
        """A run that goes on shows its state for a second time."""
        name = self.write("long.toml", '[problem]\nname = "harmonic"\ninitial = { q = [-0.039118], p = [0.927882] }\n'
                          '[method]\nname = "stv4"\n[run]\ndt = 2.5837\nsteps = 40\n'
                          'section = { coordinate = "q", direction = 0, value = -0.064 }\n')
        whole = self.summary(name)
        self.assertIn("long_step", [warning["kind"] for warning in whole["warnings"]])
        self.hamflow("run", name, "--out", "part.run", "--set", "run.steps=10")
        parts = json.loads(self.hamflow("run", name, "--out", "part.run", "--resume", "--json").stdout)
        self.assertEqual(parts["section"], whole["section"])

    def test_a_start_of_given_energy_counts_soft_walls(self):
        soft = ('[problem]\nname = "harmonic"\nwalls = [{ coordinate = "q", min = -2, max = 1.5 }]\nwall_rule = "soft"\n'
                'strength = 0.1\ninitial = { q = [0.4], %s = ["+"], energy = 3 }\n[method]\nname = "verlet"\n'
                "[run]\ndt = 0.01\nsteps = 0\n")
        for momenta in ("p", "v"):
            name = self.write("soft.toml", soft % momenta)
            for arithmetic, rounding in (("double", 1e-15), ("double-double", 1e-30), ("quad", 1e-32), ("mp(40)", 1e-39)):
                energy = self.summary(name, "--set", f"run.arithmetic={arithmetic}")["energy"]["initial"]
                self.assertLess(abs(decimal.Decimal(energy) - 3), 4 * rounding, arithmetic)
        rows = json.loads(self.hamflow("sweep", name, "--vary", "problem.initial.energy=0.1,1", "--out", "none", "--json").stdout)["rows"]
        self.assertEqual([row["status"] for row in rows], ["no_start", "done"])  # V is 0.18 there
        self.assertIn("beyond", self.hamflow("run", name, "--out", "none", "--set", "problem.initial.q=[1.6]", status=2).stderr)
        # An orbit by energy and angular momentum is one of the problem without walls.
        orbit = self.write("orbit.toml", '[problem]\nname = "central-force"\npotential = "kepler"\n'
                           "orbit = { energy = -0.3, angular_momentum = 1 }\n"
                           'walls = [{ coordinate = "x", min = -4, max = 4 }]\nwall_rule = "soft"\n'
                           '[method]\nname = "verlet"\n[run]\ndt = 0.01\nsteps = 0\n')
        self.assertGreater(self.summary(orbit)["energy"]["initial"], -0.3)

    def test_soft_walls_have_a_series_and_a_reference(self):
        """They are a term of H like others: the reference of compare is a Taylor series with that term."""
        name = self.box('[{ coordinate = "q1", min = -2, max = 2 }, { coordinate = "q2", min = -2, max = 1 }]', "stv4",
                        'wall_rule = "soft"\nexponent = 2.5')
        found = json.loads(self.hamflow("compare", name, "--methods", "cg(3,auto),taylor,stv4", "--set", "run.steps=200",
                                        "--dt", "0.01,0.005", "--out", "none", "--json").stdout)
        self.assertEqual(found["reference"]["kind"], "integration")
        errors = {(row["method"], row["dt"]): row["error"] for row in found["rows"]}
        self.assertLess(errors["cg(3,auto)", 0.005], 1e-11)
        self.assertLess(abs(math.log2(errors["stv4", 0.01] / errors["stv4", 0.005]) - 4), 0.2)
        series = self.summary(name, "--set", "method.name=taylor", "--set", "run.steps=200")
        self.assertLess(series["energy"]["max_relative_error"], 1e-11)
        # Beyond the wall V is none for a series either.
        outside = self.summary(self.box('[{ coordinate = "q1", min = -0.5, max = 0.5 }]', "taylor(order=4)",
                                        'wall_rule = "soft"'), "--set", "run.dt=0.9", "--set",
                               "method.step_control=fixed", status=1)
        self.assertEqual(outside["error"]["kind"], "outside")


if __name__ == "__main__":
    unittest.main()

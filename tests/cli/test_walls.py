"""Walls: what a run counts and records, what goes on with it, and what is refused with the reason."""

import decimal
import json
import math
import os
import pathlib
import subprocess
import unittest

from command import EXAMPLES, CommandCase
from test_files_document import PYTHON

COMPARE = os.environ["COMPARE_RUNS"]
DATA = pathlib.Path(__file__).parents[1] / "data"

TUBE = """
[problem]
name = "t-tube"
eps = -0.6
velocities = [6, 1]
{}
[method]
name = "{}"
[run]
dt = 0.01
steps = 2000
record_every = 100
"""

BOX = """
[problem]
name = "formula"
coordinates = ["q1", "q2"]
hamiltonian = "(p1^2 + p2^2 + q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3"
initial = {{ q = [0.1, -0.2], p = [1, 0.7] }}
walls = {}
{}
[method]
name = "{}"
[run]
dt = 0.01
steps = 1000
{}
"""


class Walls(CommandCase):
    def tube(self, method="stv4", rule=""):
        return self.write("tube.toml", TUBE.format(rule, method))

    def box(self, walls, method="stv4", rule="", run=""):
        return self.write("box.toml", BOX.format(walls, rule, method, run))

    def test_the_motion_itself(self):
        """Against Taylor series with located bounces, in 40 digits (tools/tube_reference.py)."""
        exact = json.loads((DATA / "t_tube_bounces.json").read_text())
        rows = exact["bounces"]
        for method, times, states in (("cg(4,auto)", 1e-11, 1e-9), ("rkn8-s19", 1e-11, 1e-9)):
            found = self.summary(self.tube(method), "--set", "run.dt=0.005", "--set", "run.steps=2400")
            self.assertEqual(found["status"], "done")
            end = exact["states"][1]
            for key in ("q", "p"):
                for value, other in zip(found["final"][key], end[key]):
                    self.assertLess(abs(value - float(other)), states * max(1, abs(value)), method)
            self.hamflow("run", self.tube(method), "--set", "run.dt=0.005", "--set", "run.steps=2400", "--out", "w.run",
                         "--force", "--quiet")
            self.assertEqual(self.column("w.run", "coordinate")[: len(rows)], [row["coordinate"] for row in rows])
            self.assertEqual(self.column("w.run", "side")[: len(rows)], [row["side"] for row in rows])
            for time, row in zip(self.column("w.run", "t"), rows):
                self.assertLess(abs(time - float(row["t"])), times, method)

    def test_counts_and_observables(self):
        found = self.summary(self.tube())
        self.assertEqual(found["status"], "done")
        self.assertEqual(sorted(found["events"]), ["wall:q1:max", "wall:q1:min", "wall:q2:max", "wall:q2:min"])
        self.assertGreater(sum(found["events"].values()), 60)
        self.assertEqual(found["parameters"]["wall_rule"], "event")
        for name, start in (("kinetic1", 18), ("kinetic2", 50)):
            self.assertEqual(found["observables"][name]["initial"], start)
        # What is no longer so behind walls is not shown.
        self.assertEqual(found["invariants"], {})
        for key in ("orbit", "exact"):
            self.assertNotIn(key, found)
        self.assertEqual(found["certificate"]["reversal_distance"]["proves"], "reversible to rounding")
        self.assertGreater(found["certificate"]["reversal_distance"]["bounces"], 0)

    def test_the_rows_of_bounces(self):
        """As many as are counted, at their walls, and no more than are asked for; the same after a resumption."""
        self.tube("cg")
        counts = json.loads(self.hamflow("run", "tube.toml", "--out", "whole", "--json").stdout)["events"]
        self.hamflow("run", "tube.toml", "--out", "parts", "--set", "run.steps=777")
        self.hamflow("run", "tube.toml", "--out", "parts", "--resume")
        subprocess.run([COMPARE, "whole/run.h5", "parts/run.h5"], cwd=self.folder, check=True, capture_output=True)
        self.assertEqual(json.loads((self.folder / "parts/summary.json").read_text())["events"], counts)
        self.assertEqual(len(self.column("whole", "t")), sum(counts.values()))
        self.assertEqual(self.column("whole", "t"), self.column("parts", "t"))
        sides = [(int(c), int(s)) for c, s in zip(self.column("whole", "coordinate"), self.column("whole", "side"))]
        names = {(0, -1): "wall:q1:min", (0, 1): "wall:q1:max", (1, -1): "wall:q2:min", (1, 1): "wall:q2:max"}
        self.assertEqual({name: sides.count(side) for side, name in names.items()}, counts)
        self.hamflow("run", "tube.toml", "--out", "few", "--set", "run.record_events=5")
        self.assertEqual(len(self.column("few", "t")), 5)

    def column(self, folder, name, group="wall"):
        done = subprocess.run([COMPARE, f"--numbers=/events/{group}/{name}", f"{folder}/run.h5"], cwd=self.folder,
                              capture_output=True, text=True, check=True)
        return [float(x) for x in done.stdout.split()]

    def test_walls_of_any_problem(self):
        for method in ("stv4", "cg(1,auto)", "cg(1,3)", "cg(2,auto)", "rk4", "gauss(2)", "dop853", "taylor"):
            walls = '[{ coordinate = "q1", min = -0.3, max = "1/3" }, { coordinate = "q2", max = 0.25 }]'
            found = self.summary(self.box(walls, method))
            self.assertGreater(sum(found["events"].values()), 10, method)
            self.assertEqual(sorted(found["events"]), ["wall:q1:max", "wall:q1:min", "wall:q2:max"])
        reject = self.summary(self.box(walls, "stv4", 'wall_rule = "reject"'))
        mirror = self.summary(self.box(walls, "stv4", 'wall_rule = "mirror"'))
        for other in (reject, mirror):
            self.assertGreater(sum(other["events"].values()), 10)
        soft = self.summary(self.box('[{ coordinate = "q1", min = -2, max = 2 }]', "stv4",
                                     'wall_rule = "soft"\nstrength = 0.5\nexponent = 3'))
        self.assertEqual(soft["events"], {})
        self.assertEqual(soft["parameters"]["wall_rule"], "soft")

    def test_the_thesis(self):
        """Sim-0.6III, a thousandth of it: the mean kinetic energies of the listing over its 20000 steps."""
        found = self.summary(self.tube("stv4", 'wall_rule = "reject"'), "--set", "run.steps=20000")
        for name, mean in (("kinetic1", 18.857958545985127), ("kinetic2", 49.066220503030145)):
            seen = found["observables"][name]  # the listing's mean has the start in it, and not the end
            self.assertAlmostEqual(seen["mean"] + (seen["initial"] - seen["final"]) / 20000, mean, delta=1e-9)

    def test_events_of_the_user(self):
        """Counted and recorded where they are located; the run ends with the step of one that stops it."""
        self.tube("cg")
        events = "run.events=[{name='cross', expression='q1', direction=0}, {expression='q2 - 2', action='stop'}]"
        found = json.loads(self.hamflow("run", "tube.toml", "--out", "e", "--json", "--set", events).stdout)
        self.assertEqual(found["status"], "done")
        self.assertEqual(found["stopped_by"]["event"], "event2")
        self.assertAlmostEqual(found["stopped_by"]["q"][1], 2, delta=1e-14)
        self.assertEqual(found["steps"] * 0.01, found["final"]["t"])
        self.assertLess(found["final"]["t"] - found["stopped_by"]["t"], 0.01)
        self.assertEqual(found["events"]["user:cross"], len(self.column("e", "t", "user/cross")))
        self.assertEqual(found["events"]["user:event2"], 1)
        again = json.loads(self.hamflow("run", "tube.toml", "--out", "e", "--resume", "--json", "--set", events).stdout)
        self.assertEqual(again["steps"], found["steps"])
        done = self.hamflow("sweep", "tube.toml", "--vary", "problem.eps=-0.6,2", "--set", events, "--out", "none", "--json")
        row = json.loads(done.stdout)["rows"][0]
        for key in ("steps", "events", "stopped_by", "final"):
            self.assertEqual(row[key], found[key])

    def oscillator(self, method, dt, steps, start="q = [1], p = [0]", walls="[]", run=""):
        text = ('[problem]\nname = "harmonic"\ninitial = {{ {} }}\nwalls = {}\n[method]\nname = "{}"\n'
                '[run]\ndt = {}\nsteps = {}\n{}\n')
        return self.write("oscillator.toml", text.format(start, walls, method, dt, steps, run))

    def test_every_bounce_of_a_long_step(self):
        """cos t between bounces off q = -0.9, which are 2 acos(-0.9) apart; steps of up to six periods."""
        to_wall = math.acos(-0.9)
        for method, near in (("taylor", 1e-10), ("dop853", 1e-9), ("gauss(10)", 1e-8), ("cg(8)", 1e-5)):
            for dt, steps in ((0.05, 800), (2, 20), (5, 8), (20, 2), (40, 1), (2 * math.pi, 6)):
                with self.subTest(method=method, dt=dt):
                    found = self.summary(self.oscillator(method, dt, steps, walls='[{ coordinate = "q", min = -0.9 }]'))
                    time = dt * steps
                    self.assertEqual(found["events"], {"wall:q:min": int((time / to_wall + 1) / 2)})
                    self.assertAlmostEqual(found["final"]["q"][0],
                                           math.cos((time + to_wall) % (2 * to_wall) - to_wall), delta=near)

    def test_a_long_step_without_a_bounce_has_the_bits_of_one_without_walls(self):
        for method in ("taylor", "dop853", "gauss(10)", "cg(8)"):
            for dt in (0.05, 5, 20):
                with self.subTest(method=method, dt=dt):
                    free = self.summary(self.oscillator(method, dt, 8))
                    walled = self.summary(self.oscillator(method, dt, 8, walls='[{ coordinate = "q", min = -1.5 }]'))
                    self.assertEqual(walled["events"], {"wall:q:min": 0})
                    self.assertEqual(walled["final"], free["final"])

    def test_steps_of_half_a_period_are_warned_of(self):
        for method, dt, steps, kinds in (("gauss(10)", 5, 8, ["long_step"]), ("cg(8)", 5, 8, ["long_step"]),
                                         ("gauss(10)", 20, 8, ["long_step"]), ("gauss(10)", 0.25, 400, []),
                                         ("taylor", 5, 8, []), ("taylor", 20, 2, [])):
            for walls, run in (('[{ coordinate = "q", min = -0.9 }]', ""), ("[]", 'section = { coordinate = "q" }'),
                               ("[]", 'events = [{ expression = "q" }]')):
                with self.subTest(method=method, dt=dt, walls=walls, run=run):
                    found = self.summary(self.oscillator(method, dt, steps, walls=walls, run=run))
                    self.assertEqual([each["kind"] for each in found["warnings"]], kinds)
        self.oscillator("taylor", 5, 8, walls='[{ coordinate = "q", min = -0.9 }]\nwall_rule = "reject"')
        self.assertEqual([each["kind"] for each in self.summary("oscillator.toml")["warnings"]], ["long_step"])

    def test_every_event_within_a_long_step(self):
        """Zeros of cos t - c, also where two of them are close to each other; the points of a section are the same."""
        for method in ("taylor", "dop853", "gauss(10)", "cg(8)"):
            longer = ((20, 10), (200, 1)) if method in ("taylor", "dop853") else ()  # others lose the phase
            for dt, steps in ((0.5, 401), (5, 40), *longer):
                for value in (0, 0.95, 0.9999):
                    with self.subTest(method=method, dt=dt, value=value):
                        down = math.acos(value)
                        run = (f'events = [{{ name = "any", expression = "q - {value}", direction = 0 }}, '
                               f'{{ name = "up", expression = "q - {value}" }}]\n'
                               f'section = {{ coordinate = "q", value = {value}, direction = -1 }}')
                        found = self.summary(self.oscillator(method, dt, steps, run=run))
                        time = dt * steps
                        falls = int((time - down) / (2 * math.pi)) + 1
                        rises = int((time + down) / (2 * math.pi))
                        if dt > 1:  # two crossings within a short step are not seen
                            self.assertEqual(found["events"], {"user:any": falls + rises, "user:up": rises})
                            self.assertEqual(found["section"]["points"], falls)
                        elif value == 0:
                            self.assertEqual(found["events"], {"user:any": falls + rises, "user:up": rises})
                        self.assertNotIn("message", found["section"])

    def test_long_steps_are_seen_alike_in_a_sweep_and_after_a_stop(self):
        run = 'section = { coordinate = "q", direction = 0 }'
        for method, dt in (("taylor", 20), ("gauss(10)", 5)):
            with self.subTest(method=method):
                whole = self.summary(self.oscillator(method, dt, 200 // dt, run=run))
                self.assertEqual(whole["section"]["points"], int(200 / math.pi + 0.5))
                self.hamflow("run", "oscillator.toml", "--out", "cut", "--force", "--quiet", "--set", "run.steps=4")
                again = json.loads(self.hamflow("run", "oscillator.toml", "--out", "cut", "--resume", "--json").stdout)
                self.assertEqual(again["section"], whole["section"])
                self.hamflow("sweep", "oscillator.toml", "--vary", "problem.initial.q[0]=1,2,3,4", "--out", "s",
                             "--force", "--quiet")
                done = subprocess.run([COMPARE, "--numbers=/section/member", "s/sweep.h5"], cwd=self.folder,
                                      capture_output=True, text=True, check=True)
                members = done.stdout.split()
                self.assertEqual(len(members), 4 * whole["section"]["points"])

    def test_failures(self):
        soft = self.summary(self.box('[{ coordinate = "q1", min = -0.5, max = 0.5 }]', "stv4", 'wall_rule = "soft"',
                                     run=""), "--set", "run.dt=0.9", status=1)
        self.assertEqual(soft["error"]["kind"], "outside")
        self.assertIn("q1", soft["error"]["message"])
        many = self.summary(self.box('[{ coordinate = "q1", min = 0.0999, max = 0.1001 }]'), "--set", "run.dt=1",
                            status=1)
        self.assertEqual(many["error"]["kind"], "wall")

    def refused(self, *arguments):
        return self.hamflow("run", *arguments, "--out", "none", status=2).stderr

    def test_tangents_through_bounces(self):
        """Exponents of an exact flow: pairs sum to 0 behind located bounces, too; other methods find the same."""
        sets = ("--set", "run.lyapunov=true", "--set", "run.eigenvalues=true", "--set", "run.steps=1000")
        found = {}
        for method in ("taylor", "cg(4,auto)", "stv4"):
            found[method] = self.summary(self.tube(method), *sets)
            self.assertGreater(sum(found[method]["events"].values()), 30)
        exact = found["taylor"]["lyapunov"]
        # The sub-steps of taylor are right to 1e-12; vectors grow by the largest row sum of M.
        for total in exact["pair_sums"]:
            self.assertLess(abs(total), 1e-12 * found["taylor"]["eigenvalues"]["norm"])
        for a, b in zip(found["cg(4,auto)"]["lyapunov"]["exponents"], exact["exponents"], strict=True):
            self.assertLess(abs(a - b), 1e-8)
        # A mirror is symplectic, a located bounce of stv4 is not.
        mirror = self.summary(self.tube("stv4", 'wall_rule = "mirror"'), *sets)["lyapunov"]
        self.assertLess(max(map(abs, mirror["pair_sums"])), 1e-13)
        self.assertGreater(max(map(abs, found["stv4"]["lyapunov"]["pair_sums"])), 1e-6)
        # A column of a sweep is that of the single run, and a run that goes on is one that never stopped.
        done = self.hamflow("sweep", self.tube("stv4"), *sets, "--vary", "problem.eps=-0.6,0.5", "--out", "none", "--json")
        row = json.loads(done.stdout)["rows"][0]
        self.assertEqual([row[f"lyapunov{i}"] for i in range(1, 5)], found["stv4"]["lyapunov"]["exponents"])
        self.hamflow("run", self.tube("stv4"), *sets, "--set", "run.steps=477", "--out", "part.run", "--quiet")
        again = json.loads(self.hamflow("run", self.tube("stv4"), *sets, "--out", "part.run", "--resume", "--json",
                                        "--quiet").stdout)
        for key in ("lyapunov", "eigenvalues"):
            self.assertEqual(again[key], found["stv4"][key])

    def test_an_empty_list_of_walls_is_none(self):
        walls = '[{ coordinate = "q1", min = -0.3, max = 0.3 }]'
        slow = ("--set", "problem.initial.p=[0.2, 0.1]")
        free = self.summary(self.write("free.toml", BOX.replace("walls = {}\n", "").format("", "stv4", "")), *slow)
        for given, more in ((("[]",), ()), ((walls, "stv4", 'wall_rule = "mirror"'), ("--set", "problem.walls=[]"))):
            found = self.summary(self.box(*given), *slow, *more)
            self.assertEqual((found["final"], found["events"]), (free["final"], {}))
        events = 'events = [{ expression = "q1 - 0.1" }]'
        self.assertGreater(self.summary(self.box("[]", run=events), *slow)["events"]["user:event1"], 0)
        self.assertEqual(self.summary(self.box("[]", run=events), *slow, "--set", "run.events=[]")["events"], {})
        self.assertEqual(self.summary("kepler.toml", "--set", "problem.bodies=[]")["final"], self.summary("kepler.toml")["final"])
        self.assertIn("are fixed", self.refused(self.tube(rule="walls = []")))
        self.write("gas.toml", "[problem]\nname='gas'\nparticles_per_side=3\ncontainer={ kind='box', size=[2.1, 2.2] }\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.001\nsteps=2\n")
        self.assertEqual(self.summary("gas.toml", "--set", "problem.walls=[]")["final"], self.summary("gas.toml")["final"])

    @unittest.skipUnless(PYTHON, "python3-h5py is not installed")
    def test_a_scenario_with_empty_lists_is_one(self):
        self.hamflow("run", self.box("[]"), "--set", "run.events=[]", "--set", "run.steps=10", "--out", "r")
        text = subprocess.run([PYTHON, "-c", "import h5py; print(h5py.File('r/run.h5')['scenario'][()].decode())"],
                              cwd=self.folder, capture_output=True, text=True, check=True, timeout=60).stdout
        self.assertIn("events = []", text)
        done = json.loads((self.folder / "r/summary.json").read_text())
        self.assertEqual(self.summary(self.write("again.toml", text))["final"], done["final"])

    def test_a_soft_wall_that_a_method_does_not_take(self):
        said = self.refused(str(EXAMPLES / "magnetic.toml"), "--set", "problem.wall_rule=soft", "--set",
                            'problem.walls=[{coordinate="x",min=-5,max=5}]')
        self.assertIn('problem.wall_rule: found "soft" with boris', said)
        self.assertIn('allowed "event", "reject", or another method', said)
        self.assertNotIn("method.name", said)

    def test_refusals(self):
        one = '[{ coordinate = "q1", min = -1, max = 1 }]'
        self.assertIn("no drifts", self.refused(self.box(one, "rk4", 'wall_rule = "mirror"')))
        self.assertIn("on the lattice", self.refused(self.box(one, run='arithmetic = "lattice"')))
        self.assertIn("q1 = 0.1 beyond the wall at 0.05",
                      self.refused(self.box('[{ coordinate = "q1", max = 0.05 }]')))
        self.assertIn("both ends", self.refused(self.box('[{ coordinate = "q1", max = 1 }]', rule='wall_rule = "soft"')))
        self.assertIn("did you mean q1?", self.refused(self.box('[{ coordinate = "q_1", max = 1 }]')))
        self.assertIn("allowed more than min", self.refused(self.box('[{ coordinate = "q1", min = 2, max = 1 }]')))
        self.assertIn("did you mean event?", self.refused(self.box(one, rule='wall_rule = "events"')))
        self.assertIn("soft", self.refused(self.box(one, rule="strength = 2")))
        self.assertIn("are fixed", self.refused(self.tube(rule="walls = " + one)))
        # A second copy of the state would meet the walls elsewhere: no template offers what is refused.
        self.assertNotIn("tao2", self.hamflow("new", "t-tube").stdout)
        self.assertIn("tao2", self.hamflow("new", "pendulum").stdout)
        self.write("arm.toml", """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "p_x^2 + p_x*p_y + p_y^2"
initial = { q = [0, 0], p = [1, 1] }
walls = [{ coordinate = "x", max = 1 }]
wall_rule = "mirror"
[method]
name = "stv4"
[run]
dt = 0.1
steps = 10
""")
        self.assertIn("depends on other momenta", self.refused("arm.toml"))

    def test_the_lattice_returns_every_bit(self):
        found = json.loads(self.hamflow("reverse", self.tube("stv4", 'wall_rule = "mirror"'), "--set",
                                        "run.arithmetic=lattice", "--json").stdout)
        self.assertTrue(found["bit_exact"])
        found = json.loads(self.hamflow("reverse", self.tube("stv4", 'wall_rule = "reject"'), "--set",
                                        "run.arithmetic=lattice", "--json").stdout)
        self.assertFalse(found["expected_bit_exact"])
        self.assertIn("one-to-one", found["note"])

    def test_mirrors_of_bodies_on_the_lattice(self):
        """The unit by default is coarse enough for walls further out than any body starts."""
        self.write("bodies.toml", """
[problem]
name = "n-body"
masses = [1, 0.5, 0.1]
softening = 0.1
initial = { q = [0, 0, 0.5, 0, -0.5, 0.3], p = [0, 0, 0, 0.4, 0, -0.1] }
walls = [{ coordinate = "x1", min = -1, max = 1 }, { coordinate = "q4", min = -2, max = 1 }]
wall_rule = "mirror"
[method]
name = "stv4"
[run]
dt = 0.01
steps = 500
arithmetic = "lattice"
""")
        found = json.loads(self.hamflow("reverse", "bodies.toml", "--json").stdout)
        self.assertTrue(found["bit_exact"])
        given = "run.lattice={{position='2^{}'}}"
        text = self.refused("bodies.toml", "--set", given.format(-52))
        self.assertIn('with run.lattice = { position = "2^-50" }', text)
        self.refused("bodies.toml", "--set", given.format(-51))
        self.assertEqual(self.summary("bodies.toml", "--set", given.format(-50))["status"], "done")

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
            self.assertIn("begins on a wall", told["reason"])

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
        self.assertIn("no return is promised", rejecting)

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
            self.assertIn("it is H that has a single root in that momentum", error["hint"])
            self.assertNotIn("smaller dt", error["hint"])

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
        """The true period is 2; the ends of the steps alone show one of 20.6."""
        for arguments in (("run", self.free("verlet"), "--out", "none"), ("reverse", self.free("verlet"))):
            text = self.hamflow(*arguments).stderr
            self.assertIn("a tenth of the shortest period seen, 1.97 (of x); try dt = 0.099 or less", text)

    def test_events_that_jump_at_walls(self):
        file = self.free("verlet")
        jumps = ("--set", "run.events=[{expression='p_x',direction=0}]", "--set", "run.dt=0.1", "--set", "run.steps=73")
        s = self.summary(file, *jumps)
        self.assertEqual(s["events"]["user:event1"], 0)
        bounces = s["events"]["wall:x:min"] + s["events"]["wall:x:max"]
        sentence = f"event1: {bounces} changes of sign were no zeros: the expression jumps there, or has a pole"
        self.assertEqual(s["event_notes"], [sentence])
        self.assertIn(sentence, self.hamflow("run", file, *jumps, "--out", "none").stdout)
        self.assertNotIn("event_notes", self.summary(file, "--set", "run.events=[{expression='x-0.5',direction=0}]"))

    def test_a_comparison_says_which_wall(self):
        for rule, dt, words, hint in (
                ('wall_rule = "soft"\nstrength = 1e-9\nexponent = 2', "0.7", "x stood on a soft wall or beyond it",
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

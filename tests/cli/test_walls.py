"""Walls: what a run counts and records, what goes on with it, and what is refused with the reason."""

import json
import sys
import math
import os
import pathlib
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

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


class WallCase(CommandCase):
    def tube(self, method="stv4", rule=""):
        return self.write("tube.toml", TUBE.format(rule, method))

    def box(self, walls, method="stv4", rule="", run=""):
        return self.write("box.toml", BOX.format(walls, rule, method, run))

    def oscillator(self, method, dt, steps, start="q = [1], p = [0]", walls="[]", run=""):
        text = ('[problem]\nname = "harmonic"\ninitial = {{ {} }}\nwalls = {}\n[method]\nname = "{}"\n'
                '[run]\ndt = {}\nsteps = {}\n{}\n')
        return self.write("oscillator.toml", text.format(start, walls, method, dt, steps, run))

    def column(self, folder, name, group="wall"):
        done = subprocess.run([COMPARE, f"--numbers=/events/{group}/{name}", f"{folder}/run.h5"], cwd=self.folder,
                              capture_output=True, text=True, check=True)
        return [float(x) for x in done.stdout.split()]

    def refused(self, *arguments):
        return self.hamflow("run", *arguments, "--out", "none", status=2).stderr


class Walls(WallCase):
    def test_a_sweep_over_a_wall_keeps_no_problem_for_each_member(self):
        """Each is a problem of its own, of some 25 kB, and its block takes as much: a row takes 2 kB."""
        self.write("wall.toml", "[problem]\nname='pendulum'\ninitial={q=[0.1], p=[1]}\n"
                   "walls=[{coordinate='q', max=1}]\n[method]\nname='verlet'\n[run]\ndt=0.05\nsteps=5\n")

        def peak(members):
            process = subprocess.Popen([HAMFLOW, "sweep", "wall.toml", "--vary", f"problem.walls[0].max=0.5:1.5:{members}",
                                        "--threads", "1", "--out", "none", "--quiet"], cwd=self.folder, stdout=subprocess.DEVNULL)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0)
            return used.ru_maxrss * 1024

        self.assertLess((peak(3000) - peak(500)) / 2500, 12_000)

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

    FREE = '''[problem]
name = "formula"
coordinates = ["q"]
hamiltonian = "p^2/2"
initial = { q = [0], p = [1] }
[method]
name = "verlet"
[run]
dt = 0.25
steps = 12
'''

    def test_zeros_and_touches_within_a_step(self):
        """x = t: two zeros between 1 and 1.25, a touch at 1.1 and one on a step, three zeros in one step."""
        self.write("free.toml", self.FREE)
        expressions = {"two": "(q - 1.05)*(q - 1.2)", "touch": "(q - 1.1)^2", "on_step": "(q - 1.25)^2",
                       "three": "(q - 1.05)*(q - 1.1)*(q - 1.2)", "never": "(q - 1.1)^2 + 1e-6", "late": "(q - 2.3)*(q - 2.4)",
                       "first": "(q - 0.1)*(q - 0.2)"}
        events = ", ".join(f"{{name='{name}', expression='{x}', direction=0}}" for name, x in expressions.items())
        found = json.loads(self.hamflow("run", "free.toml", "--out", "e", "--json", "--set", f"run.events=[{events}]").stdout)
        self.assertEqual(found["events"], {"user:two": 2, "user:touch": 1, "user:on_step": 1, "user:three": 3,
                                           "user:never": 0, "user:late": 2, "user:first": 2})
        self.assertEqual([round(t, 9) for t in self.column("e", "t", "user/two")], [1.05, 1.2])
        tenth = json.loads(self.hamflow("run", "free.toml", "--out", "e", "--force", "--json", "--set", "run.dt=0.1", "--set",
                                        "run.steps=30", "--set", f"run.events=[{events}]").stdout)
        self.assertEqual(tenth["events"]["user:touch"], 1)  # on a step, up to rounding
        self.assertEqual(tenth["events"]["user:two"], 2)

    def test_a_stop_event_before_the_step_fails(self):
        self.write("edge.toml", self.FREE.replace("p^2/2", "p^2/2 - sqrt(q)").replace("q = [0], p = [1]", "q = [1], p = [-1.5]")
                   .replace("verlet", "rk4").replace("0.25", "0.5"))
        events = "run.events=[{name='near', expression='q - 0.1', action='stop', direction=-1}]"
        self.hamflow("run", "edge.toml", "--out", "none", status=1)
        found = json.loads(self.hamflow("run", "edge.toml", "--out", "e", "--json", "--set", events).stdout)
        self.assertEqual(found["status"], "done")
        self.assertEqual(found["stopped_by"]["event"], "near")
        self.assertAlmostEqual(found["stopped_by"]["q"][0], 0.1, delta=1e-12)
        self.assertEqual(found["events"], {"user:near": 1})

    def test_rows_of_mirrors_lie_on_the_walls(self):
        self.write("mirror.toml", self.FREE.replace("q = [0]", "q = [0.5]").replace("0.25", "1.7").replace(
            "[method]", 'wall_rule = "mirror"\nwalls = [{ coordinate = "q", min = 0, max = 1 }]\n[method]'))
        self.hamflow("run", "mirror.toml", "--out", "m")
        self.assertEqual({*self.column("m", "q")}, {0.0, 1.0})

    def test_advice_is_one_that_runs(self):
        text = self.FREE.replace("p^2/2", "p^2*(1 + q^2)/2").replace("verlet", "tao4").replace(
            "[method]", 'walls = [{ coordinate = "q", min = -1, max = 1 }]\n[method]')
        self.write("tao.toml", text)
        said = self.hamflow("run", "tao.toml", "--out", "none", status=2).stderr
        self.assertIn("another method, e.g. cg, rk4", said)
        self.assertNotIn("stv4", said)
        for method in ("cg", "rk4"):
            self.hamflow("run", "tao.toml", "--out", "none", "--set", f"method.name={method}")

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
                        self.assertEqual(found["events"], {"user:any": falls + rises, "user:up": rises})
                        self.assertEqual(found["section"]["points"], falls)
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

    def test_a_scenario_with_empty_lists_is_one(self):
        self.hamflow("run", self.box("[]"), "--set", "run.events=[]", "--set", "run.steps=10", "--out", "r")
        text = subprocess.run([sys.executable, "-c", "import h5py; print(h5py.File('r/run.h5')['scenario'][()].decode())"],
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
        self.assertNotIn("tao2", self.hamflow("new", "t-tube", "--all").stdout)
        self.assertIn("tao2", self.hamflow("new", "pendulum", "--all").stdout)
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
        self.assertIn("cannot be undone", found["note"])

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
        self.assertIn('e.g. run.lattice = { position = "2^-50" }', text)
        self.refused("bodies.toml", "--set", given.format(-51))
        self.assertEqual(self.summary("bodies.toml", "--set", given.format(-50))["status"], "done")


if __name__ == "__main__":
    unittest.main()

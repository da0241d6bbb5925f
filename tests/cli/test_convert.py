"""hamflow convert: states, scenarios and runs in other coordinates, and back to rounding."""

import json
import math
import random
import shutil
import unittest
from decimal import Decimal, localcontext

from command import EXAMPLES, CommandCase

EPSILON = 2.0**-52

PENDULUM = """
# two rods
[problem]
name = "double-pendulum"
angles = "absolute"
initial = { q = [0.3, -1.25], p = [0.5, "1/3"] }
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.01
steps = 200
"""


class Convert(CommandCase):
    def state(self, from_, to, q, p, status=0):
        text = lambda numbers: ",".join(repr(x) for x in numbers)
        done = self.hamflow("convert", "--from", from_, "--to", to, "--q", text(q), "--p", text(p), "--json", status=status)
        answer = json.loads(done.stdout)
        if status == 0:
            self.assertEqual(answer["coordinates"], to)
        return answer

    def assert_close(self, found, expected, units=8):
        scale = max(1.0, *(abs(x) for x in expected))
        for a, b in zip(found, expected, strict=True):
            self.assertLessEqual(abs(a - b), units * EPSILON * scale, f"{found} is not {expected}")

    def test_known_states(self):
        s = self.state("cartesian", "polar", [3.0, 4.0], [1.0, 2.0])
        self.assert_close(s["q"], [5, math.atan2(4, 3)])
        self.assert_close(s["p"], [(3 * 1 + 4 * 2) / 5, 3 * 2 - 4 * 1])
        s = self.state("polar", "cartesian", [2.0, math.pi / 2], [0.5, 3.0])
        self.assert_close(s["q"], [0, 2])
        self.assert_close(s["p"], [-1.5, 0.5])
        # p^T dq is the same: (p1 + p2) dq1 + p2 d(q2 - q1) = p1 dq1 + p2 dq2.
        s = self.state("absolute", "relative", [0.5, 2.0], [3.0, 7.0])
        self.assertEqual((s["q"], s["p"]), ([0.5, 1.5], [10, 7]))
        text = self.hamflow("convert", "--from", "cartesian", "--to", "polar", "--q", "-1,0", "--p", "0,1/3").stdout
        self.assertEqual(text, f"q = [1, {math.pi:.17g}]\np = [0, {-1 / 3:.17g}]\n")

    def test_the_problem_is_the_one_with_as_many_coordinates(self):
        for q, p, wanted in (("0.5", "1", [math.sin(0.5), -math.cos(0.5)]), ("0.01,1.1", "1,100", [0.01, 0, 0, 1.1])):
            s = json.loads(self.hamflow("convert", "--from", "generalised", "--to", "cartesian", "--q", q, "--p", p, "--json").stdout)
            self.assert_close(s["q"], wanted)

    def test_round_trips_of_states(self):
        numbers = random.Random(1999)
        for a, b in (("cartesian", "polar"), ("absolute", "relative")):
            for _ in range(5):
                q = [numbers.uniform(-3, 3) for _ in range(2)]
                p = [numbers.uniform(-3, 3) for _ in range(2)]
                there = self.state(a, b, q, p)
                back = self.state(b, a, there["q"], there["p"])
                self.assert_close(back["q"] + back["p"], q + p)

    def test_scenarios(self):
        self.write("pendulum.toml", PENDULUM)
        for name, there, here in (("kepler.toml", "polar", "cartesian"), ("pendulum.toml", "relative", "absolute")):
            self.hamflow("convert", name, "--to", there, "-o", "there.toml")
            self.hamflow("convert", "there.toml", "--to", here, "-o", "back.toml")
            first, other, back = (self.summary(f) for f in (name, "there.toml", "back.toml"))
            self.assertIn(there, other["parameters"].values())
            self.assert_close([back["energy"]["initial"], other["energy"]["initial"]], [first["energy"]["initial"]] * 2)
            # The starts agree; both orbits are those of one H, so energies stay together.
            start = lambda f: self.summary(f, "--set", "run.steps=0")["final"]
            converted = self.state(there, here, start("there.toml")["q"], start("there.toml")["p"])
            self.assert_close(converted["q"] + converted["p"], start(name)["q"] + start(name)["p"])
            self.assert_close(start("back.toml")["q"] + start("back.toml")["p"], start(name)["q"] + start(name)["p"])

    def test_what_stays_in_a_scenario(self):
        done = self.hamflow("convert", "kepler.toml", "--to", "polar")
        self.assertIn('orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }', done.stdout)
        self.assertIn('coordinates = "polar"', done.stdout)
        self.assertIn("dt = 0.1\n", done.stdout)
        self.assertEqual(done.stderr, "")
        self.write("pendulum.toml", PENDULUM)
        done = self.hamflow("convert", "pendulum.toml", "--to", "relative")
        self.assertIn("initial = { q = [0.3, -1.55], p = [0.8333333333333333, 0.3333333333333333] }", done.stdout)
        self.assertIn("comments", done.stderr)
        self.write("velocity.toml", (self.folder / "kepler.toml").read_text().replace(
            'orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }', "initial = { q = [0, 2], v = [-0.5, 0] }"))
        s = json.loads(self.hamflow("convert", "velocity.toml", "--to", "polar", "--json").stdout)
        self.assert_close(s["q"] + s["p"], [2, math.pi / 2, 0, 2])

    def test_what_is_said_in_the_old_coordinates_is_left_out_with_a_note(self):
        named = (self.folder / "kepler.toml").read_text() + """section = { coordinate = "y" }
events = [{ expression = "x" }]
[output]
figures = ["section", "orbit"]
observables = { d = "sqrt(x^2 + y^2)" }
"""
        self.write("named.toml", named)
        done = self.hamflow("convert", "named.toml", "--to", "polar", "-o", "polar.toml")
        self.assertIn(": run.events, run.section, output.observables (written in the old coordinates)", done.stderr)
        self.summary("polar.toml")
        self.hamflow("run", "named.toml", "--out", "named.run", "--set", "run.steps=60")
        done = self.hamflow("convert", "named.run", "--to", "polar", "-o", "polar.h5")
        self.assertIn(": run.events, run.section, output.observables (written in the old coordinates)", done.stderr)
        self.assertIn("left out of the scenario in polar.h5: ", done.stderr)
        done = self.hamflow("convert", "named.run", "--to", "polar", "-o", "polar.csv")
        self.assertIn("note: the columns step, angular_momentum, d of the run were left out", done.stderr)
        done = self.hamflow("convert", "named.run", "--to", "polar", "-o", "polar.h5")
        self.assertIn("note: left out of polar.h5: /events/user, /section, which hold states in cartesian coordinates", done.stderr)
        self.hamflow("plot", "polar.h5", "-o", "polar.svg")
        # In the same coordinates all of it is meant as before.
        done = self.hamflow("convert", "named.toml", "--to", "cartesian")
        self.assertEqual(done.stderr, "")
        for words in ('events = [{ expression = "x" }]', 'section = { coordinate = "y" }', "d = "):
            self.assertIn(words, done.stdout)

    def test_walls_that_belong_to_the_problem_stand_in_each_chart(self):
        self.write("tube.toml", (EXAMPLES / "t_tube.toml").read_text())  # its start are velocities
        self.hamflow("convert", "tube.toml", "--to", "cartesian", "--set", "method={name='rattle'}", "-o", "there.toml")
        self.hamflow("convert", "there.toml", "--to", "generalised", "--set", "method={name='verlet'}", "-o", "back.toml")
        there = self.summary("there.toml", "--set", "run.steps=30")
        back = self.summary("back.toml", "--set", "run.steps=30")
        self.assertEqual((there["events"]["wall:x1:max"], back["events"]["wall:q1:max"]), (1, 1))
        self.assert_close([there["final"]["q"][0], there["final"]["q"][3]], back["final"]["q"], units=1e6)
        self.hamflow("run", "there.toml", "--out", "there.run", "--set", "run.steps=30")
        # Observables of the problem are in every chart: nothing of output.observables is left out.
        said = self.hamflow("convert", "there.run", "--to", "generalised", "-o", "there.h5").stderr
        self.assertEqual(said.count("output.observables"), 0)
        self.assertIn("left out of there.h5: /events/wall, which hold states in cartesian coordinates", said)
        rows = self.hamflow("convert", "there.run", "--to", "generalised").stdout.splitlines()
        self.assert_close([float(x) for x in rows[-1].split(",")[1:3]], [there["final"]["q"][0], there["final"]["q"][3]])

    def test_a_file_is_called_what_it_is(self):
        for name in ("x.h5", "x.csv"):
            self.assertIn("allowed a file .toml", self.hamflow("convert", "kepler.toml", "--to", "polar", "-o", name, status=2).stderr)
        done = self.hamflow("convert", "kepler.toml", "--to", "polar", "-o", "no/x.toml", status=3)
        self.assertIn("no/x.toml cannot be written: the folder no does not exist", done.stderr)

    def test_a_method_that_cannot_run_there(self):
        self.write("stv4.toml", (self.folder / "kepler.toml").read_text().replace('"cg"\nquadrature = 5', '"stv4"'))
        done = self.hamflow("convert", "stv4.toml", "--to", "polar", status=2)
        self.assertIn("--set method.name=", done.stderr)
        self.assertEqual(done.stdout, "")
        self.hamflow("convert", "stv4.toml", "--to", "polar", "--set", "method.name=cg", "-o", "polar.toml")
        self.assertEqual(self.summary("polar.toml")["status"], "done")

    def rows(self, *arguments):
        lines = self.hamflow("convert", *arguments).stdout.splitlines()
        to = arguments[arguments.index("--to") + 1]
        names = "r,phi,p_r,p_phi" if to == "polar" else "x,y,p_x,p_y"
        self.assertEqual(lines[0], f"t,{names},energy")
        return [[float(x) for x in line.split(",")] for line in lines[1:]]

    def test_runs(self):
        self.hamflow("run", "kepler.toml", "--set", "output.formats=['h5','csv']", "--set", "run.steps=3000")
        lines = (self.folder / "kepler.run" / "trajectory.csv").read_text().splitlines()
        recorded = [[float(x) for x in line.split(",")][1:7] for line in lines[1:]]
        rows = self.rows("kepler.run", "--to", "polar")
        self.assertEqual(len(rows), 3001)
        self.assertEqual([r[0] for r in rows], [r[0] for r in recorded])
        self.assertEqual([r[5] for r in rows], [r[5] for r in recorded])
        # Twelve rounds counter-clockwise, period 8 pi: phi grows all the way, without a jump.
        turns = [b[2] - a[2] for a, b in zip(rows, rows[1:])]
        self.assertGreater(min(turns), 0)
        self.assertLess(max(turns), 0.5)
        self.assertGreater(rows[-1][2], 2 * math.pi * 11)
        for row, (_, x, y, px, py, _) in zip(rows[::100], recorded[::100]):
            self.assert_close(row[1:5:2], [math.hypot(x, y), (x * px + y * py) / math.hypot(x, y)])
            self.assert_close([row[4]], [x * py - y * px])
        # To a file that reads like a run, and back from it.
        self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "polar.h5")
        self.assertEqual(self.rows("polar.h5", "--to", "polar"), rows)
        for row, start in zip(self.rows("polar.h5", "--to", "cartesian"), recorded):
            # cos and sin at phi up to 75: the rounding of phi counts.
            self.assert_close(row, start, units=200)
        self.hamflow("convert", "kepler.run/run.h5", "--to", "polar", "-o", "polar.csv")
        self.assertEqual((self.folder / "polar.csv").read_text().count("\n"), 3002)
        if shutil.which("gnuplot"):
            self.hamflow("plot", "polar.h5", "--kind", "energy-error", "-o", "e.svg")
            self.hamflow("plot", "polar.h5", "--kind", "orbit", "-o", "orbit.svg")

    def test_a_run_in_more_digits(self):
        """Every digit of the run's arithmetic goes through, and what is written reads like the run."""
        sets = ("--set", "problem.initial={q=[1, '1/3'], p=[0, 1.1]}", "--set", "run.steps=300", "--quiet")
        for arithmetic, places in (("double-double", 29), ("quad", 31), ("mp(60)", 57)):
            self.hamflow("run", "kepler.toml", "--set", f"run.arithmetic={arithmetic}", *sets, "--force")
            there, here = (json.loads(self.hamflow("convert", file, "--to", "cartesian", "--json").stdout)
                           for file in ("kepler.run", self.converted("kepler.run", "polar")))
            polar = json.loads(self.hamflow("convert", "kepler.run", "--to", "polar", "--json").stdout)
            start = json.loads(self.hamflow("convert", "kepler.toml", "--to", "polar", "--json", *sets[:-1], "--set",
                                            f"run.arithmetic={arithmetic}").stdout)
            self.assertEqual([start["q"], start["p"]], [polar["q"][0], polar["p"][0]])
            self.assertEqual(there["t"], polar["t"])
            self.assertEqual(there["energy"], polar["energy"])
            with localcontext() as context:
                context.prec = 90
                close = Decimal(10) ** -places
                for k in (0, 1, 299, 300):
                    (x, y), (px, py) = ([Decimal(a) for a in there[name][k]] for name in "qp")
                    (r, phi), (pr, pphi) = ([Decimal(a) for a in polar[name][k]] for name in "qp")
                    self.assertLess(abs(r * r - x * x - y * y), close)
                    self.assertLess(abs(pphi - x * py + y * px), close)
                    self.assertLess(abs(pr * r - x * px - y * py), close)
                    for name in "qp":  # there and back
                        for a, b in zip(there[name][k], here[name][k]):
                            self.assertLess(abs(Decimal(a) - Decimal(b)), close)
            turns = [float(row[1]) for row in polar["q"]]
            self.assertGreater(turns[-1], 2 * math.pi)  # whole turns are counted
            self.assertLess(max(abs(b - a) for a, b in zip(turns, turns[1:])), 1)
            lines = self.hamflow("convert", "kepler.run", "--to", "polar").stdout.splitlines()
            self.assertEqual(lines[-1].split(","), [polar["t"][-1], *polar["q"][-1], *polar["p"][-1],
                                                    polar["energy"][-1]])
            # The scenario starts there with all digits.
            text = self.hamflow("convert", "kepler.toml", "--set", f"run.arithmetic={arithmetic}", *sets[:4], "--to",
                                "polar").stdout
            self.write("start.toml", text)
            start = self.summary("start.toml", "--set", "run.steps=0")["final"]
            self.assertEqual((start["q"], start["p"]), (polar["q"][0], polar["p"][0]))

    def converted(self, run, to):
        self.hamflow("convert", run, "--to", to, "-o", "converted.h5")
        return "converted.h5"

    def test_missing_turns_are_said(self):
        # A circle of period 2 pi sqrt(2), seen about once a round: phi seems to stand.
        self.hamflow("run", "kepler.toml", "--set", "problem.orbit={kind='circle',r0=1}", "--set", "run.record_every=89",
                     "--set", "run.steps=890")
        self.assertIn("whole turns are lost", self.hamflow("convert", "kepler.run", "--to", "polar").stderr)

    def test_a_run_of_an_explicit_method(self):
        self.hamflow("run", "kepler.toml", "--set", "method.name=stv4")
        done = self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "polar.h5")
        self.assertIn("stv4", done.stderr)
        self.assertEqual(len(self.rows("polar.h5", "--to", "cartesian")), 401)

    def test_a_method_is_looked_at_and_what_it_drops_is_told(self):
        self.write("m.toml", (self.folder / "kepler.toml").read_text().replace('"cg"', '"cg"\ndegree = 2'))
        for json_too in ((), ("--json",)):
            wrong = self.hamflow("convert", "m.toml", "--to", "polar", "--set", "method.nme=verlet", *json_too, status=2)
            self.assertIn("did you mean name", wrong.stderr)
        done = self.hamflow("convert", "m.toml", "--to", "polar", "--set", "method.name=gauss")
        self.assertIn("note: method.degree of the file is not used", done.stderr)

    def test_coordinates_of_several_charts(self):
        self.write("d.toml", "[problem]\nname='double-pendulum'\ninitial={q=[0.3,0.1],p=[0,0]}\n[method]\nname='cg'\n"
                   "[run]\ndt=0.01\nsteps=10\n")
        said = self.hamflow("convert", "d.toml", "--to", "generalised", status=2).stderr
        self.assertIn("found generalised coordinates, of which double-pendulum has several; allowed absolute, relative", said)

    def test_wrong_requests(self):
        self.write("pendulum.toml", '[problem]\nname="pendulum"\ninitial={q=[1],p=[0]}\n[method]\nname="verlet"\n'
                   "[run]\ndt=0.1\nsteps=1\n")
        self.write("bad.toml", "[problem]\nname = 1\n")
        for arguments, words in (
            (["pendulum.toml", "--to", "polar"], "central-force has cartesian and polar"),
            (["kepler.toml", "--to", "relative"], "double-pendulum has absolute, relative and cartesian"),
            (["kepler.toml", "--to", "polr"], "did you mean polar?"),
            (["kepler.toml"], "--to"),
            (["--to", "polar"], "INPUT"),
            (["--from", "polar", "--to", "relative", "--q", "1,0", "--p", "0,1"], "cannot convert from"),
            (["--from", "cartesian", "--to", "polar", "--q", "0,0", "--p", "0,1"], "r = 0"),
            (["--from", "polar", "--to", "cartesian", "--q", "0,1", "--p", "0,1"], "r = 0"),
            (["--from", "cartesian", "--to", "polar", "--q", "1", "--p", "0,1"], "1 coordinates and 2 momenta"),
            (["--from", "cartesian", "--to", "polar", "--q", "1,x", "--p", "0,1"], "--q: error: found '1,x'"),
            (["--from", "cartesian", "--to", "generalised", "--q", "0,-2", "--p", "1,0"], "violates the constraints, |g(q)| = 3"),
            (["--from", "cartesian", "--to", "generalised", "--q", "0,-1", "--p", "1,5"], "leaves the constraints"),
            (["--from", "cartesian", "--to", "absolute", "--q", "0,-1,0,-7", "--p", "1,0,0,3"], "violates the constraints"),
            (["kepler.toml", "--from", "cartesian", "--to", "polar"], "allowed one of them"),
            (["kepler.toml", "--to", "polar", "-o", "kepler.toml"], "the input file itself"),
            (["bad.toml", "--to", "polar"], "bad.toml:2:8: error: problem.name"),
        ):
            done = self.hamflow("convert", *arguments, status=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(words, done.stderr)
        self.assertEqual(json.loads(self.hamflow("convert", "pendulum.toml", "--to", "polar", "--json", status=2).stdout)
                         ["status"], "rejected")
        self.hamflow("convert", "nowhere.toml", "--to", "polar", status=3)
        self.hamflow("run", "kepler.toml")
        self.assertIn(".h5 or .csv", self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "x.txt", status=2).stderr)
        self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "no/such/x.h5", status=3)
        self.hamflow("convert", "kepler.run", "--to", "polar", "-o", "no/such/x.csv", status=3)
        self.assertIn("Examples:", self.hamflow("convert", "--help").stdout)


if __name__ == "__main__":
    unittest.main()

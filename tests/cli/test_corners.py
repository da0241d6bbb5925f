"""Corners that were silent or said the wrong thing: no steps, free flight, coordinates that stand still, failed steps."""

import json
import math
import unittest

from command import CommandCase

FREE = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2"
initial = { q = [1, 1.3], p = [1, 0.7] }
walls = [{ coordinate = "x", min = 0, max = 4.5 }, { coordinate = "y", min = 0, max = 4.5 }]
[method]
name = "verlet"
[run]
dt = 2
t_end = 900
"""
STILL = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "p_x^2/2 + x^2*y^2/2"
initial = { q = [1, 1], p = [0, 0] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 10
"""


class Corners(CommandCase):
    def test_an_end_at_once_is_told(self):
        done = self.hamflow("run", "kepler.toml", "--out", "none", "--set", "run.t_end=0")
        self.assertIn("run.t_end = 0, so no step is taken", done.stderr)

    def test_free_flight_is_exact_with_any_step(self):
        self.write("free.toml", FREE)
        self.assertEqual(self.summary("free.toml")["warnings"], [])
        # With a force between the walls a step of 2 is long.
        bound = self.summary("free.toml", "--set", "problem.hamiltonian=(p_x^2 + p_y^2)/2 + sin(3*x)")
        self.assertIn("long_step", [w["kind"] for w in bound["warnings"]])

    def test_a_coordinate_that_stands_still_is_named(self):
        self.write("still.toml", STILL)
        done = self.hamflow("run", "still.toml", "--out", "none")
        self.assertIn("H does not contain p_y, so y does not move", done.stderr)
        self.assertNotIn("p_x:", done.stderr)

    def test_methods_with_blanks_between(self):
        done = self.hamflow("compare", "kepler.toml", "--methods", "verlet", "stv4", status=2)
        self.assertIn("found stv4 after a blank; allowed one list separated by commas", done.stderr)

    def test_a_number_where_a_table_is_meant(self):
        done = self.hamflow("run", "kepler.toml", "--set", "run.dt.first=1", status=2)
        self.assertIn("run.dt is a value here, not a table; allowed run.dt = { first = ... }", done.stderr)

    def test_a_step_without_solution_tells_cause_advice_numbers(self):
        sets = ("--set", "run.dt=30")
        done = self.hamflow("run", "kepler.toml", "--out", "none", *sets, status=1)
        lines = [line for line in done.stderr.splitlines() if line.split(":")[0] in ("error", "hint", "details")]
        self.assertEqual([line.split(":")[0] for line in lines], ["error", "hint", "details"], done.stderr)
        self.assertNotIn("residual", lines[0])
        self.assertIn("try a smaller dt", lines[1])
        self.assertIn("per iteration", lines[2])
        done = self.hamflow("sweep", "kepler.toml", "--out", "none", *sets, "--vary", "problem.mass=2,2.1", status=1)
        self.assertIn("hint: try a smaller dt", done.stderr)
        self.assertNotIn("per iteration", done.stderr)

    def test_indices_of_an_empty_array(self):
        done = self.hamflow("run", "kepler.toml", "--set", "problem.orbit={}", "--set", "problem.initial={q=[],p=[]}",
                            "--set", "problem.initial.q[0]=1", status=2)
        self.assertIn("problem.initial.q is an empty array", done.stderr)

    def test_a_key_with_a_blank_is_told_alike(self):
        run = json.loads(self.hamflow("run", "kepler.toml", "--json", "--set", "problem.my key=1", status=2).stdout)
        sweep = json.loads(self.hamflow("sweep", "kepler.toml", "--json", "--set", "problem.my key=1", "--vary", "run.dt=0.1,0.2",
                                        status=2).stdout)
        self.assertEqual([e["key"] for e in run["errors"]], ["problem.my key"])
        self.assertEqual([e["key"] for e in sweep["errors"]], ["problem.my key"])

    def test_too_many_members_are_refused_before_their_values_are_made(self):
        done = self.hamflow("sweep", "kepler.toml", "--out", "none", "--vary", "run.dt=1:1.3:10000000",
                            "--vary", "problem.mass=1:2:2", status=2)
        self.assertIn("found more than 10000000 members", done.stderr)

    def test_the_first_member_that_differs_is_named(self):
        self.write("ho.toml", """
[problem]
name = "harmonic"
initial = { q = [1], p = [0] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 1
""")
        names = ",".join(["harmonic"] * 700 + ["free-fall"] * 300)
        for _ in range(3):
            done = self.hamflow("sweep", "ho.toml", "--out", "none", "--threads", "2", "--vary", "problem.name=" + names, status=2)
            self.assertIn("member 700", done.stderr)

    def test_typed_invariants_are_judged(self):
        self.write("central.toml", """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)^2/4"
invariants = { turn = "x*p_y - y*p_x", square = "(x*p_y - y*p_x)^2", wrong = "x*p_y" }
initial = { q = [1, 0], p = [0.3, 0.7] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 5000
""")
        kept = self.summary("central.toml")["certificate"]["momentum_maps"]
        self.assertEqual({name: kept[name]["conserved"] for name in kept},
                         {"turn": "to rounding", "square": "to rounding", "wrong": "not"})
        lost = self.summary("central.toml", "--set", "method.name=rk4")["certificate"]["momentum_maps"]
        self.assertEqual({lost[name]["conserved"] for name in lost}, {"not"})

    def test_of_a_driven_motion_h_itself_is_told(self):
        self.write("driven.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p^2/2 - x*cos(t)"
momenta = ["p"]
initial = { q = [0], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 100
record_every = 50
[output]
formats = ["csv"]
""")
        done = self.hamflow("run", "driven.toml", "--out", "driven.run")
        self.assertIn("H(q, p, t)", done.stdout)
        self.assertIn("H - int dH/dt", done.stdout)
        summary = json.loads((self.folder / "driven.run/summary.json").read_text())
        x, p = summary["final"]["q"][0], summary["final"]["p"][0]
        self.assertEqual(summary["hamiltonian"]["initial"], 0)
        self.assertAlmostEqual(summary["hamiltonian"]["final"], p * p / 2 - x * math.cos(1), delta=1e-14)
        self.assertIn("hamiltonian", (self.folder / "driven.run/trajectory.csv").read_text().splitlines()[0])

    def test_a_constant_in_h_changes_no_verdict(self):
        level = """
[problem]
name = "formula"
coordinates = ["a"]
momenta = ["p_a"]
hamiltonian = "p_a^2/2 + 9.81*sin(a) + %s"
initial = { q = [0], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 20000
"""
        found = []
        for constant in ("0", "1", "-7"):
            self.write("level.toml", level % constant)
            summary = self.summary("level.toml")
            self.assertEqual(summary["warnings"], [])
            self.assertNotIn("scale", summary["certificate"]["reason"])
            found.append((summary["certificate"]["drift"], summary["certificate"]["periods"]))
        self.assertEqual(found, [found[0]] * 3)
        self.write("level.toml", level % "0")
        self.assertGreater(self.summary("level.toml")["energy"]["scale"], 9)
        self.assertLess(self.summary("level.toml")["energy"]["max_relative_error"], 1e-6)

    def test_nonsense_is_seen_beside_a_constant(self):
        kepler = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2) + %s"
initial = { q = [1, 0], p = [0, 0.3] }
[method]
name = "euler"
[run]
dt = 0.2
steps = 400
"""
        for constant in ("0", "1000000"):
            self.write("far.toml", kepler % constant)
            self.assertIn("energy_error", [w["kind"] for w in self.summary("far.toml")["warnings"]], constant)

    def test_a_sweep_is_coloured_by_a_coordinate(self):
        self.hamflow("sweep", "kepler.toml", "--out", "none", "--set", "run.steps=3", "--vary", "run.dt=0.1:0.2:3",
                     "--figure", "map.svg", "--colour", "final/x")
        self.assertIn("x", (self.folder / "map.svg").read_text())

    def test_winners_are_within_the_size_of_the_solution(self):
        found = json.loads(self.hamflow("compare", "kepler.toml", "--out", "none", "--json", "--methods", "verlet,euler,stv4",
                                        "--dt", "0.5,0.25,0.1").stdout)
        self.assertTrue(found["winners"])
        for winner in found["winners"]:
            self.assertLess(float(winner["error"]), 1)

    def test_names_of_others_lead_to_methods(self):
        for name, meant in (("generalized-leapfrog", "lobatto-3a-3b"), ("symplectic4", "stv4")):
            done = self.hamflow("run", "kepler.toml", "--set", f"method.name={name}", status=2)
            self.assertIn(f"did you mean {meant}?", done.stderr)


if __name__ == "__main__":
    unittest.main()

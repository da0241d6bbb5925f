"""run.functions: the portable functions against mpmath, and the same bits by every path."""

import csv
import json
import os
import unittest

from command import CommandCase

try:
    import mpmath
except ImportError:
    mpmath = None

OF_ONE = ("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh")

# A free particle passes through many arguments; asin and acos see q1/9.
FREE = """
[problem]
name = "formula"
coordinates = ["q1"]
hamiltonian = "p1^2/2"
initial = {{ q = [0.01], p = [1] }}
[method]
name = "verlet"
[run]
dt = 0.0437
steps = 200
record_every = 1
functions = "{}"
[output]
formats = ["h5", "csv"]
observables = {{ {} }}
"""

ROTORS = """
[problem]
name = "formula"
coordinates = ["q1", "q2"]
hamiltonian = "p1^2/2 + p2^2/2 - cos(q1) - cos(q2) + exp(-(q1 - q2)^2) + 0.1*tanh(q1)"
initial = {{ q = [0.3, 1.1], p = [0.7, -0.2] }}
[method]
name = "{}"
[run]
dt = 0.05
steps = 4000
{}
"""


def argument(name):
    return "q1/9" if name in ("asin", "acos") else "q1"


class Functions(CommandCase):
    def values(self, functions):
        """Rows of the observables, with the positions at which they are computed."""
        formulas = [f'{name}_ = "{name}({argument(name)})"' for name in OF_ONE]
        formulas += ['power_ = "q1^1.7"', 'atan2_ = "atan2(q1, 3)"']
        self.write("free.toml", FREE.format(functions, ", ".join(formulas)))
        self.hamflow("run", "free.toml", "--force")
        with open(self.folder / "free.run/trajectory.csv", newline="") as file:
            return [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]

    @unittest.skipIf(mpmath is None, "mpmath is not installed")
    def test_the_portable_ones_are_the_nearest_doubles(self):
        mpmath.mp.prec = 200
        wrong = {}
        for functions in ("portable", "system"):
            wrong[functions] = 0
            for row in self.values(functions):
                q = mpmath.mpf(row["q1"])
                for name in OF_ONE:
                    x = mpmath.mpf(row["q1"] / 9) if argument(name) == "q1/9" else q
                    wrong[functions] += row[name + "_"] != float(getattr(mpmath, name)(x))
                wrong[functions] += row["power_"] != float(mpmath.power(q, mpmath.mpf(1.7)))
                wrong[functions] += row["atan2_"] != float(mpmath.atan2(q, 3))
        # 2613 values; about one of 10000 is wrongly rounded, those of the C library more often.
        self.assertLessEqual(wrong["portable"], 3)
        self.assertGreater(wrong["system"], 20)

    def test_the_same_bits_by_every_path(self):
        """In machine code, by the interpreter and in the lanes of a sweep; in halves, and back on the lattice."""
        for method in ("stv4", "cg(1,3)", "gauss", "dop853", "taylor"):
            self.write("r.toml", ROTORS.format(method, 'functions = "portable"'))
            ends = [self.summary("r.toml")["final"]]
            done = self.hamflow("run", "r.toml", "--out", "none", "--json", env=dict(os.environ, HAMFLOW_NATIVE="0"))
            ends.append(json.loads(done.stdout)["final"])
            self.hamflow("run", "r.toml", "--set", "run.steps=170", "--force")
            ends.append(json.loads(self.hamflow("run", "r.toml", "--resume", "--json").stdout)["final"])
            for end in ends[1:]:
                self.assertEqual((end["q"], end["p"]), (ends[0]["q"], ends[0]["p"]), method)
            system = self.summary("r.toml", "--set", "run.functions=system")["final"]
            self.assertNotEqual(system["q"], ends[0]["q"], method)
        self.write("r.toml", ROTORS.format("stv4", 'functions = "portable"'))
        done = self.hamflow("sweep", "r.toml", "--vary", "problem.initial.q[1]=0.3:0.9:17", "--out", "none", "--json")
        swept = json.loads(done.stdout)
        self.assertEqual(swept["members_in_lanes"], 17)
        single = self.summary("r.toml", "--set", "problem.initial.q[1]=0.9")
        self.assertEqual(swept["rows"][-1]["final"], single["final"])
        self.write("l.toml", ROTORS.format("stv4", 'functions = "portable"\narithmetic = "lattice"'))
        self.assertIn("yes", self.hamflow("reverse", "l.toml").stdout)

    def test_the_typed_problem_has_them_too(self):
        pendulum = ('[problem]\nname = "pendulum"\ninitial = { q = [1.2], p = [0.4] }\n[method]\nname = "stv4"\n'
                    '[run]\ndt = 0.05\nsteps = 500\n')
        self.write("p.toml", pendulum)
        portable = self.summary("p.toml", "--set", "run.functions=portable")["final"]
        done = self.hamflow("run", "p.toml", "--set", "run.functions=portable", "--out", "none", "--json",
                            env=dict(os.environ, HAMFLOW_NATIVE="0"))
        self.assertEqual(json.loads(done.stdout)["final"]["q"], portable["q"])

    def test_refusals(self):
        self.write("r.toml", ROTORS.format("stv4", ""))
        for sets, key, message in (
                (["run.functions=fast"], "run.functions", "system, portable"),
                (["run.functions=portabel"], "run.functions", "portable"),
                (["run.functions=portable", "run.arithmetic=double-double"], "run.functions", "double, compensated, lattice"),
                (["run.functions=portable", "run.arithmetic=mp(50)"], "run.functions", "double, compensated, lattice")):
            options = [part for each in sets for part in ("--set", each)]
            error = self.summary("r.toml", *options, status=2)["errors"][0]
            self.assertEqual(error["key"], key)
            self.assertIn(message, error["message"])
        self.hamflow("run", "r.toml")
        refused = self.hamflow("run", "r.toml", "--resume", "--set", "run.functions=portable", "--set", "run.steps=500",
                               status=None)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("run.functions", refused.stderr)
        varied = self.hamflow("sweep", "r.toml", "--vary", "run.functions=system,portable", status=None)
        self.assertNotEqual(varied.returncode, 0)
        self.assertIn("run.functions", varied.stderr)


if __name__ == "__main__":
    unittest.main()

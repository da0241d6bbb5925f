"""Which method to take: a short list first, advice with each, and the better one where a wrong one was chosen."""

import json
import re
import subprocess
import unittest

from command import HAMFLOW, CommandCase

FIRST = ["verlet", "stv4", "kahan-li8", "rkn8-s19", "cg", "taylor"]


class Advice(CommandCase):
    def setUp(self):
        super().setUp()
        self.methods = json.loads(self.hamflow("list", "methods", "--json").stdout)
        self.names = [m["name"] for m in self.methods]

    def test_the_list_begins_with_six(self):
        lines = self.hamflow("list", "methods").stdout.splitlines()
        rows = [line.split()[0] for line in lines if re.match(r"\S+ +order", line)]
        self.assertEqual(rows, FIRST)
        self.assertEqual([m["name"] for m in self.methods if m["begin_with"]], FIRST)
        words = re.findall(r"[\w-]+", "\n".join(lines))
        self.assertEqual([name for name in self.names if name not in words], [], "all others are named behind them")
        self.assertLessEqual(max(map(len, lines)), 120)

    def test_all_have_a_line_with_all(self):
        text = self.hamflow("list", "methods", "--all").stdout
        rows = [line.split()[0] for line in text.splitlines() if re.match(r"\S+ +order", line)]
        self.assertEqual(sorted(rows), sorted(self.names))

    def test_every_method_says_when_and_when_not(self):
        known = set(self.names)
        for method in self.methods:
            self.assertTrue(method["take"] and method["avoid"], method["name"])
            better = known & set(re.findall(r"[a-z0-9-]+", method["avoid"]))
            self.assertTrue(better - {method["name"]}, f"{method['name']} names no better one: {method['avoid']}")
        shown = " ".join(self.hamflow("show", "stv4").stdout.split())
        stv4 = next(m for m in self.methods if m["name"] == "stv4")
        for said in ("take", "avoid", "purpose"):
            self.assertIn(stv4[said], shown)

    def refusal(self, problem, method):
        self.write("s.toml", f'[problem]\n{problem}\n[method]\nname = "{method}"\n[run]\ndt = 0.01\nsteps = 2\n')
        return self.hamflow("run", "s.toml", "--out", "none", status=2).stderr

    def test_a_refusal_names_one_that_runs(self):
        polar = ('name = "central-force"\npotential = "kepler"\ncoordinates = "polar"\n'
                 'initial = { q = [1, 0], p = [0, 1] }')
        text = self.refusal(polar, "stv4")
        self.assertIn("stv4 needs a separable H = T(p) + V(q)", text)
        self.assertIn("cg takes any twice differentiable H", text)
        problems = [polar, 'name = "double-pendulum"\ninitial = { q = [1, 0.5], p = [0, 0] }',
                    'name = "magnetic"\nfield = [0, 0, 1]\ninitial = { q = [1, 0, 0], p = [0, 1, 0] }',
                    'name = "sextic"\ninitial = { q = [0.1], p = [0.9] }']
        refused = 0
        for problem in problems:
            for method in ("verlet", "rkn8-s19", "boris", "chin4a", "srkn6b"):
                self.write("s.toml", f'[problem]\n{problem}\n[method]\nname = "{method}"\n[run]\ndt = 0.01\nsteps = 2\n')
                done = subprocess.run([HAMFLOW, "run", "s.toml", "--out", "none"], cwd=self.folder, capture_output=True,
                                      text=True, timeout=60)
                if done.returncode == 0:
                    continue
                refused += 1
                self.assertEqual(done.returncode, 2, done.stderr)
                better = re.search(r"; ([\w-]+) takes ", done.stderr)
                self.assertTrue(better, done.stderr)
                self.hamflow("run", "s.toml", "--out", "none", "--set", f"method.name={better[1]}")
        self.assertGreaterEqual(refused, 10)

    def test_advice_can_be_followed(self):
        """Whatever is named as an alternative takes the problem, in its arithmetic and with its size."""
        self.write("mixed.toml", """
            [problem]
            name = "formula"
            coordinates = ["x"]
            hamiltonian = "(x^2 + 1)*(p_x^2 + 1)/2"
            initial = { q = [1], p = [0] }
            [method]
            name = "rk4"
            [run]
            dt = 0.1
            steps = 10""")
        reversible = ("--out", "none", "--set", "method={ name = 'rk4', step_control = 'reversible' }")
        said = self.hamflow("run", "mixed.toml", *reversible, status=2).stderr
        self.assertIn("a symmetric method, e.g. cg", said)
        self.assertNotIn("verlet", said)
        said = self.hamflow("run", "kepler.toml", *reversible, status=2).stderr
        self.assertIn("a symmetric method, e.g. verlet, stv4, cg", said)
        # 600 unknowns: no matrix is made, so that Newton is no way out.
        chain = "[problem]\nname = 'formula'\ncoordinates = ['x[n]']\nparameters = { n = 300 }\nhamiltonian = " \
                "'sum(i, 1, n, p_x[i]^2/2 + 1000*cosh(x[i]))'\ninitial = { q = %s, p = %s }\n[method]\nname = " \
                "'cg(2,4)'\niteration = 'fixed-point'\n[run]\ndt = 1\nsteps = 1\n" % ([1] * 300, [0] * 300)
        said = self.hamflow("run", self.write("chain.toml", chain), "--out", "none", status=1).stderr
        self.assertIn("try a smaller dt", said)
        self.assertNotIn('method.iteration = "newton"', said)

    def test_eighth_order_for_quadratic_kinetic_energy(self):
        """rkn8-s19 is advised before kahan-li8 where T is quadratic: more accurate for as many forces."""
        for problem in ('name = "central-force"\npotential = "kepler"\norbit = { kind = "ellipse", r_per = 1, r_aph = 2 }',
                        'name = "henon-heiles"\ninitial = { q = [0, 0.1], p = [0.4, 0.1] }'):
            errors = {}
            for method, stages in (("kahan-li8", 17), ("rkn8-s19", 19), ("stv4", 3), ("verlet", 1)):
                forces = 17 * 19 * 3 * 16  # over t = 10, the same number for each
                self.write("s.toml", f'[problem]\n{problem}\n[method]\nname = "{method}"\n[run]\nt_end = 10\n'
                                     f'dt = "10*{stages}/{forces}"\n')
                errors[method] = self.summary("s.toml")["final"]
            self.write("s.toml", f'[problem]\n{problem}\n[method]\nname = "taylor(tolerance=1e-15)"\n[run]\nt_end = 10\ndt = 1\n')
            exact = self.summary("s.toml")["final"]
            size = {m: max(abs(a - b) for a, b in zip(f["q"], exact["q"])) for m, f in errors.items()}
            self.assertLess(size["rkn8-s19"], size["stv4"])
            self.assertLess(size["kahan-li8"], size["stv4"])
            self.assertLess(size["stv4"], size["verlet"])
            self.assertLess(size["rkn8-s19"], size["kahan-li8"], size)


if __name__ == "__main__":
    unittest.main()

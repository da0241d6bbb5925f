"""Hamiltonians as they are typed: every command treats them like built-in ones, and what is wrong in them is pointed at."""

import json
import math
import signal
import subprocess
import time
import unittest
from decimal import Decimal

import h5py

from command import HAMFLOW, CommandCase

HENON = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + k*(x^2*y - y^3/3)"
parameters = { k = 1 }
initial = { q = [0.1, 0.2], p = [0.3, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 200
"""

BUILT_IN = """
[problem]
name = "henon-heiles"
initial = { q = [0.1, 0.2], p = [0.3, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 200
"""

# H of a charge in a field, no T(p) + V(q): momenta with names of their own, a list, let and sum.
CHARGE = """
[problem]
name = "formula"
coordinates = ["u[2]"]
momenta = ["w[2]"]
hamiltonian = "let a = b*u[2]/2, c = -b*u[1]/2 in ((w[1] + a)^2 + (w[2] + c)^2)/(2*m) + sum(i, 1, 2, e[i]*u[i]^2)"
parameters = { b = 1, m = "1/2", e = [0.5, 0.25] }
invariants = { H = "((w[1] + b*u[2]/2)^2 + (w[2] - b*u[1]/2)^2)/(2*m) + e[1]*u[1]^2 + e[2]*u[2]^2" }
initial = { q = [1, 0], p = [0.1, 0.2] }
[method]
name = "cg"
[run]
dt = 0.05
steps = 50
"""


class FormulaCase(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("f.toml", HENON)
        self.write("b.toml", BUILT_IN)
        self.write("c.toml", CHARGE)

    def sets(self, sets):
        return [word for one in sets for word in ("--set", one)]


class Commands(FormulaCase):
    def test_summary(self):
        run = self.summary("f.toml")
        self.assertEqual(run["problem"], "formula")
        self.assertEqual(run["parameters"], {"k": 1.0, "structure": {"separable": True, "quadratic_kinetic": True,
                                                                     "time": False}})
        charge = self.summary("c.toml")
        self.assertEqual(charge["parameters"]["structure"], {"separable": False, "quadratic_kinetic": False,
                                                             "time": False})
        self.assertEqual(charge["parameters"]["e"], [0.5, 0.25])
        self.assertEqual(charge["energy"]["initial"], charge["invariants"]["H"]["initial"])
        self.assertLess(charge["invariants"]["H"]["max_error"], 1e-6)

    def test_parts_instead_of_the_whole(self):
        parts = HENON.replace('hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2',
                              'kinetic = "(p_x^2 + p_y^2)/2"\npotential = "(x^2 + y^2)/2')
        self.write("parts.toml", parts)
        self.assertEqual(self.summary("parts.toml")["final"], self.summary("f.toml")["final"])

    ONE = ("[problem]\nname='formula'\ncoordinates=['x']\nhamiltonian='%s'\nparameters={%s}\ninitial={q=[%s],p=[%s]}\n"
           "[method]\nname='verlet'\n[run]\ndt='1/8'\nsteps=40\n")

    def test_constants_have_all_their_digits(self):
        """A decimal beside a short binary fraction is none, however near it is."""
        for literal in ("1.00000000000000000000000001", "0.50000000000000000000000000000001", "1e0", "0.50", "2"):
            self.write("o.toml", self.ONE % (f"p_x^2/2 + {literal}*x^2", "", 1, 0))
            found = self.summary("o.toml", "--set", "run.arithmetic=mp(40)")
            self.assertLess(abs(Decimal(found["energy"]["initial"]) / Decimal(literal) - 1), Decimal("1e-39"), literal)

        # Zeros behind it change nothing.
        self.write("o.toml", self.ONE % ("p_x^2.0000000000000000000000/2 + x^2", "", 1, 0))
        self.assertTrue(self.summary("o.toml")["parameters"]["structure"]["quadratic_kinetic"])

    def test_powers_and_tanh_in_double_double(self):
        """As in quad: also of coordinates below 0, at 0, and far out."""
        for hamiltonian, parameters, q, p in (("p_x^2/2 + x^n/4", "n=4", 1, 0), ("p_x^2/2 + x^n/4", "n=4", 0, 1),
                                              ("p_x^2/2 + x^100/100", "", "-0.5", "-0.1"), ("p_x^2/2 + tanh(x)^2", "", 800, -1)):
            self.write("o.toml", self.ONE % (hamiltonian, parameters, q, p))
            found, wanted = (self.summary("o.toml", "--set", f"run.arithmetic={name}")["final"] for name in ("double-double", "quad"))
            for key in ("q", "p"):
                size = max(1, abs(Decimal(wanted[key][0])))
                self.assertLess(abs(Decimal(found[key][0]) - Decimal(wanted[key][0])), size * Decimal("1e-28"), hamiltonian)

    def test_angles_on_the_negative_axis(self):
        """Where atan2 jumps, but H does not: series begin there, and come there again."""
        for q, p in (("[-1, 0]", "[0.1, 0.5]"), ("[1, 0]", "[0, 1]")):
            self.write("o.toml", "[problem]\nname='formula'\ncoordinates=['x','y']\n"
                       "hamiltonian='(p_x^2+p_y^2)/2 + (x^2+y^2)/2 + 0.1*cos(2*atan2(y,x))'\ninitial={q=%s,p=%s}\n"
                       "[method]\nname='taylor'\ntolerance=1e-15\n[run]\ndt=0.1\nsteps=100\n" % (q, p))
            found, wanted = (self.summary("o.toml", "--set", f"method={method}")["final"] for method in
                             ("{name='taylor',tolerance=1e-15}", "{name='dop853',tolerance=1e-14}"))
            for key in ("q", "p"):
                for a, b in zip(found[key], wanted[key]):
                    self.assertAlmostEqual(a, b, delta=1e-11)

    def test_sums_within_sums(self):
        """Constants before them are multiplied into each; more than a thousand are refused at once."""
        def nested(names):
            definitions = [f"a{k} = " + "p_x + x + 0.5*(" * 40 + (f"a{k - 1}" if k > 0 else "p_x + x") + ")" * 40 for k in range(names)]
            return "let " + ", ".join(definitions) + f" in p_x^2/2 + x^2/2 + a{names - 1}"

        self.write("o.toml", self.ONE % (nested(2), "", 1, 0))
        self.assertEqual(self.summary("o.toml")["parameters"]["structure"]["separable"], True)
        self.write("o.toml", self.ONE % (nested(40), "", 1, 0))
        said = self.hamflow("run", "o.toml", "--out", "none", status=2).stderr
        self.assertIn("allowed at most 1000", said)

    def test_parameters_that_stand_nowhere(self):
        """A name with a mistake is no parameter that changes nothing."""
        self.write("d.toml", """[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 - cos(q) - a*q*cos(w*t)"
parameters = { a = 0.1, w = 0.7 }\ninitial = { q = [0.2], p = [0] }\n[method]\nname = "stv4"\n[run]\ndt = 0.05\nsteps = 20\n""")
        refused = self.hamflow("run", "d.toml", "--out", "none", "--set", "problem.parameters.aa=3", status=2).stderr
        self.assertIn("problem.parameters.aa", refused)
        self.assertIn("no formula uses; did you mean a?", refused)
        self.hamflow("sweep", "d.toml", "--out", "none", "--vary", "problem.parameters.z=0.5,0.7", status=2)
        self.assertTrue(refused.startswith("--set: error: problem.parameters.aa: found"), refused)

    def test_section_of_time(self):
        """Points of a section by t alone are those of partial steps to the times: of x'' = cos t from rest x = 1 - cos t."""
        self.write("s.toml", """[problem]\nname = "formula"\ncoordinates = ["x"]\nhamiltonian = "p_x^2/2 - x*cos(w*t)"
parameters = { w = 1 }\ninitial = { q = [0], p = [0] }\n[method]\nname = "kahan-li8"
[run]\ndt = 0.07\nsteps = 400\nsection = { expression = "sin(w*t - 0.5)", direction = 1 }\n[output]\nfigures = ["section"]\n""")
        summary = json.loads(self.hamflow("run", "s.toml", "--out", "s.run", "--json").stdout)
        self.assertEqual(summary["section"]["points"], 5)  # t = 0.5 + 2 pi k < 28
        self.assertLess(summary["section"]["max_residual"], 1e-13)
        self.assertTrue((self.folder / "s.run/figures/section.svg").is_file())
        with h5py.File(self.folder / "s.run/run.h5") as file:
            times, q, p = (file["section"][name][...] for name in ("t", "q", "p"))
        for k, (t, x, v) in enumerate(zip(times, q[:, 0], p[:, 0], strict=True)):
            self.assertAlmostEqual(t, 0.5 + 2 * math.pi * k, delta=1e-12)
            self.assertAlmostEqual(x, 1 - math.cos(t), delta=1e-9)
            self.assertAlmostEqual(v, math.sin(t), delta=1e-9)
        both = self.summary("s.toml", "--set", "run.section.direction=0", "--set", "output.figures=[]")
        self.assertEqual(both["section"]["points"], 9)
        # Partial steps, of any problem: t is known everywhere.
        own = self.summary("b.toml", "--set", "run.section={ expression = 'cos(t)', direction = -1 }")
        self.assertEqual(own["section"]["points"], 4 - 1)  # pi/2 + 2 pi k < 20, three of them
        refused = self.hamflow("run", "s.toml", "--out", "none", "--set", "run.section.expression=w + 1", status=2).stderr
        self.assertIn("the same for every state; allowed an expression with a coordinate, a momentum or t", refused)
        self.hamflow("sweep", "s.toml", "--vary", "problem.initial.q[0]=0,0.1,0.2", "--out", "none", "--figure", "all.svg",
                     "--set", "output.figures=[]", "--quiet")
        self.assertTrue((self.folder / "all.svg").is_file())

    def test_with_time_every_method_for_quadratic_kinetic_energy(self):
        self.write("d.toml", """[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 - cos(q) - q*cos(w*t)"
parameters = { w = 0.7 }\ninitial = { q = [0.2], v = [0.1] }\n[method]\nname = "stv4"\n[run]\ndt = 0.05\nsteps = 20\n""")
        ends = [self.summary("d.toml", "--set", f"method.name={name}")["final"]
                for name in ("rkn8-s19", "srkn11b", "chin4a", "dop853")]
        for end in ends:
            self.assertAlmostEqual(end["q"][0], ends[-1]["q"][0], delta=1e-7)
        self.assertEqual(self.summary("d.toml")["parameters"]["structure"],
                         {"separable": True, "quadratic_kinetic": True, "time": True})
        refused = self.hamflow("run", "d.toml", "--out", "none", "--set", "method.name=chin4a", "--set",
                               "problem.hamiltonian=sqrt(1 + p^2) - cos(q) - q*cos(w*t)", status=2).stderr
        self.assertIn("T quadratic in p with constant mass matrix", refused)

    def test_scale_of_the_energy(self):
        """|T| + |V| where H is their sum, whichever method asks."""
        sets = self.sets(["problem.hamiltonian=sqrt(1 + p_x^2 + p_y^2) - 3*cosh(k*x)*cosh(y)"])
        scales = {self.summary("f.toml", *sets, "--set", f"method.name={name}", "--set", "run.steps=2")["energy"]["scale"]
                  for name in ("stv4", "rk4", "cg", "dop853")}
        self.assertEqual(len(scales), 1)
        self.assertAlmostEqual(scales.pop(), math.sqrt(1.1) + 3 * math.cosh(0.1) * math.cosh(0.2), delta=1e-14)

    def test_charts(self):
        refused = self.hamflow("convert", "f.toml", "--to", "polar", status=2).stderr
        self.assertIn("formula has no polar coordinates; allowed: those that were typed, x, y", refused)

    def test_names_of_others(self):
        for text, meant in (("ln(x)", "log(x)"), ("pow(x, 2)", "x^y"), ("e^x", "exp(x) for e^x"), ("sqr(x)", "x^2"),
                            ("log10(x)", "log(x)/log(10)"), ("cbrt(x)", "x^(1/3)")):
            refused = self.hamflow("run", "f.toml", "--out", "none", "--set",
                                   f"problem.hamiltonian=p_x^2 + p_y^2 + k*({text})", status=2).stderr
            self.assertIn("; did you mean", refused)
            self.assertIn(meant, refused)
        self.assertIn("did you mean log(x)?", self.hamflow("run", "f.toml", "--out", "none", "--set", "run.dt=ln(2)", status=2).stderr)

    def test_every_function_in_long_runs(self):
        """Steps are recorded after some hundred of them: each function of the language has to be one that a recording has."""
        for v in ("q*asin(q/10)", "q^2 + acos(q/10)", "atan(q)^2", "atan2(q, 5 + q^2)", "2^q + 2^(-q)", "(2 + q^2)^(1 + q^2/9)", "abs(q)^3",
                  "sqrt(1 + q^2)", "exp(q^2/9)", "log(2 + q^2)", "cosh(q)", "q*sinh(q)", "tanh(q)^2", "tan(q/3)^2", "sin(q)^2 - cos(q)",
                  "abs(q)^2.5", "q^2 + 1/(1 + q^2)"):
            self.write("v.toml", f"""[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 + {v}"
invariants = {{ angle = "atan2(p, 3 + q^2)" }}\ninitial = {{ q = [0.5], p = [0.2] }}\n[method]\nname = "stv4"
[run]\ndt = 0.05\nsteps = 600\n""")
            with self.subTest(v):
                whole = self.summary("v.toml")
                self.assertEqual(whole["status"], "done")
                self.assertEqual(self.summary("v.toml", "--set", "run.record_every=7")["final"], whole["final"])
                self.assertEqual(self.summary("v.toml", "--set", "method.name=rk4")["status"], "done")

    def test_the_built_in_problem(self):
        # Rounding may differ where terms are grouped otherwise: some steps, some units of rounding.
        for method, arithmetic in (("stv4", "double"), ("rk4", "double"), ("cg(1,5)", "double"),
                                   ("dop853", "double"), ("taylor", "double"), ("stv4", "compensated"), ("stv4", "lattice"),
                                   ("rk4", "quad"), ("yoshida6", "mp(30)")):
            sets = self.sets([f"method.name={method}", f"run.arithmetic={arithmetic}", "run.steps=20"])
            typed, built_in = self.summary("f.toml", *sets), self.summary("b.toml", *sets)
            for key in "qp":
                for a, b in zip(typed["final"][key], built_in["final"][key], strict=True):
                    self.assertAlmostEqual(float(a), float(b), delta=1e-13, msg=f"{method} {arithmetic}")

    def test_names_of_coordinates(self):
        self.hamflow("run", "c.toml", "--set", 'output.formats=["h5","csv"]', "--out", "c.run", "--quiet")
        header = (self.folder / "c.run/trajectory.csv").read_text().splitlines()[0]
        self.assertEqual(header, "step,t,q1,q2,p1,p2,energy,H")
        self.hamflow("plot", "c.run", "--kind", "time", "--y", "u[1],w[2]", "-o", "c.svg")
        wrong = self.hamflow("plot", "c.run", "--kind", "time", "--y", "u[3]", "-o", "c.svg", status=2)
        self.assertIn("u[1], u[2], w[1], w[2]", wrong.stderr)
        with h5py.File(self.folder / "c.run/run.h5") as file:
            self.assertEqual([name.decode() for name in file.attrs["coordinates"]], ["u[1]", "u[2]"])
            self.assertEqual([name.decode() for name in file.attrs["momenta"]], ["w[1]", "w[2]"])

    def test_reverse_compare_verify(self):
        back = json.loads(self.hamflow("reverse", "f.toml", "--set", "run.arithmetic=lattice", "--json").stdout)
        self.assertTrue(back["bit_exact"])
        rows = json.loads(self.hamflow("compare", "f.toml", "--methods", "stv4,rk4,cg(1,5)", "--dt", "0.1,0.05", "--out",
                                       "none", "--json", "--quiet").stdout)["rows"]
        self.assertEqual({row["status"] for row in rows}, {"done"})
        self.assertTrue(all(row["error"] < 5e-2 for row in rows), [row["error"] for row in rows])  # relative to the motion
        verified = json.loads(self.hamflow("verify", "verlet", "--problem", "formula", "--json").stdout)
        self.assertTrue(verified["methods"][0]["agrees"])
        self.hamflow("convert", "f.toml", "--to", "polar", status=2)

    def test_shell(self):
        done = subprocess.run([HAMFLOW, "shell", "f.toml", "--quiet", "--set", "output.observables={ r = 'x^2' }"], cwd=self.folder, text=True, capture_output=True,
                              input="step 10\ndt 0.05\nstep 10\nshow q\nreverse\nstep 10\nsave s.run\nquit\n", timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.hamflow("plot", "s.run", "--kind", "time", "--y", "r,x", "-o", "s.svg")

    def test_sweep(self):
        out = self.hamflow("sweep", "f.toml", "--vary", "problem.parameters.k=0.5:1.5:5", "--out", "none", "--json",
                           "--quiet").stdout
        rows = json.loads(out)["rows"]
        for row in rows[::2]:
            one = self.summary("f.toml", "--set", f"problem.parameters.k={row['problem.parameters.k']!r}")
            self.assertEqual((row["final"], row["energy"]["max_error"]), (one["final"], one["energy"]["max_error"]))
        self.assertEqual(len({row["final"]["q"][0] for row in rows}), 5)
        self.hamflow("sweep", "f.toml", "--vary", "problem.parameters.k=0.5:1.5:3", "--vary", "run.dt=0.1,0.05", "--out",
                     "none", "--quiet", "--figure", "k.svg")

    def test_measures(self):
        sets = self.sets(["run.lyapunov=true", "run.eigenvalues=true", "run.section={ coordinate = 'x' }"])
        typed = self.summary("f.toml", *sets)
        built_in = self.summary("b.toml", *self.sets(["run.lyapunov=true", "run.eigenvalues=true",
                                                      "run.section={ coordinate = 'q1' }"]))
        self.assertEqual(typed["section"]["points"], built_in["section"]["points"])
        for a, b in zip(typed["lyapunov"]["exponents"], built_in["lyapunov"]["exponents"], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-9)
        for a, b in zip(typed["eigenvalues"]["values"], built_in["eigenvalues"]["values"], strict=True):
            self.assertAlmostEqual(a[0], b[0], delta=1e-8 * (1 + abs(b[0])))

    def test_start_of_energy(self):
        one = self.summary("f.toml", "--set", 'problem.initial={ q = [0, 0.1], p = ["+", 0.1], energy = 0.125 }')
        two = self.summary("b.toml", "--set", 'problem.initial={ q = [0, 0.1], p = ["+", 0.1], energy = 0.125 }')
        self.assertAlmostEqual(one["start"]["p"][0], two["start"]["p"][0], delta=2.0**-51)

    def test_velocities_with_masses_far_apart(self):
        """A pendulum of mass 1e-8 below one of mass 1: the determinant of its mass matrix is 1e-8; p = M v."""
        text = '''[problem]
name = "formula"
coordinates = ["a", "b"]
hamiltonian = "(p_a^2 - 2*p_a*p_b*cos(a-b) + (1+m)*p_b^2)/(2*(m + sin(a-b)^2)) - (1+m)*cos(a) - cos(b)"
parameters = { m = "1e-8" }
initial = { q = [1, 1], v = [1, 1] }
[method]
name = "gauss"
[run]
dt = 1e-5
steps = 0
'''
        self.write("v.toml", text)
        found = self.summary("v.toml")["final"]["p"]
        self.assertAlmostEqual(found[0], 2 + 1e-8, delta=1e-7)
        self.assertAlmostEqual(found[1], 2, delta=1e-7)
        self.write("v.toml", text.replace("1e-8", "1e-17"))
        said = self.hamflow("run", "v.toml", "--out", "none", status=2).stderr
        self.assertIn("the mass matrix is singular at this start", said)

    def test_figures(self):
        self.hamflow("run", "f.toml", "--set", 'output.figures=["orbit","time","energy","energy-error","phase"]', "--out",
                     "f.run", "--quiet")
        self.assertEqual(len(list((self.folder / "f.run/figures").iterdir())), 15)
        one = HENON.replace('["x", "y"]', '["q"]').replace("(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + k*(x^2*y - y^3/3)",
                                                           "p^2/2 - k*cos(q)")
        one = one.replace("q = [0.1, 0.2], p = [0.3, 0.1]", "q = [1], p = [0]")
        self.write("one.toml", one)
        self.hamflow("run", "one.toml", "--set", 'output.figures=["phase"]', "--out", "one.run", "--quiet")

    def test_resume_after_a_kill(self):
        sets = self.sets(["run.steps=300000", "run.checkpoint_every=20000", "output.observables={ r = 'sqrt(x^2+y^2)' }",
                          "run.section={ expression = 'x - y' }"])
        self.hamflow("run", "f.toml", *sets, "--out", "whole.run", "--quiet")
        run = subprocess.Popen([HAMFLOW, "run", "f.toml", *sets, "--out", "cut.run", "--quiet"], cwd=self.folder)
        checkpoint = self.folder / "cut.run/checkpoint.bin"
        while run.poll() is None and not (checkpoint.exists() and checkpoint.stat().st_size > 2000):
            time.sleep(0.01)
        run.send_signal(signal.SIGKILL)
        run.wait()
        self.hamflow("run", "f.toml", *sets, "--out", "cut.run", "--resume", "--quiet")
        whole, cut = (json.loads((self.folder / f"{name}.run/summary.json").read_text()) for name in ("whole", "cut"))
        for key in ("final", "energy", "section", "observables", "certificate"):
            self.assertEqual(cut[key], whole[key], key)

    def test_a_hamiltonian_of_time(self):
        """Time goes on when momenta are negated: no reversal is a proof. Steps are not differentiated."""
        self.write("t.toml", HENON.replace('/3)"', '/3) + k*x*cos(2*t)/50"'))
        certificate = self.summary("t.toml")["certificate"]["reversal_distance"]
        self.assertEqual((certificate["proves"], certificate["steps"], certificate["distance"]), ("nothing", 0, None))
        self.assertIn("H depends on t", certificate["reason"])
        found = json.loads(self.hamflow("reverse", "t.toml", "--json").stdout)
        self.assertIn("H depends on t", found["note"])
        self.assertFalse(found["expected_bit_exact"])
        for key in ("lyapunov", "eigenvalues"):
            for command in (["run", "t.toml"], ["sweep", "t.toml", "--vary", "problem.parameters.k=0.5,1"]):
                text = self.hamflow(*command, "--set", f"run.{key}=true", "--out", "none", status=2).stderr
                self.assertIn("with an H that depends on t; allowed with H(q, p)", text)

    def test_show_and_new(self):
        shown = self.hamflow("show", "formula").stdout
        for key in ("coordinates", "momenta", "hamiltonian", "kinetic", "potential", "parameters", "invariants"):
            self.assertIn(key, shown)
        self.assertIn("let r = ", shown)
        facts = self.hamflow("show", "c.toml").stdout
        self.assertIn("not separable", facts)
        self.assertIn("momenta: w[1], w[2]", facts)
        self.write("new.toml", self.hamflow("new", "formula").stdout)
        self.assertEqual(self.summary("new.toml")["status"], "done")
        self.assertIn("formula", self.hamflow("list", "problems").stdout)


class CentralForce(FormulaCase):
    KEPLER = """
[problem]
name = "central-force"
potential = "kepler"
k = 1.5
mass = 2
initial = { q = [1, 0], p = [0, 1.5] }
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.02
steps = 50
"""

    def setUp(self):
        super().setUp()
        self.write("kepler.toml", self.KEPLER)
        self.typed = self.KEPLER.replace('potential = "kepler"\nk = 1.5',
                                         'potential = "formula"\nV = "-k/r"\nparameters = { k = 1.5 }')
        self.write("typed.toml", self.typed)

    def test_a_typed_potential(self):
        one, two = self.summary("typed.toml"), self.summary("kepler.toml")
        for key in "qp":
            for a, b in zip(one["final"][key], two["final"][key], strict=True):
                self.assertAlmostEqual(a, b, delta=1e-13)
        momenta = [run["invariants"]["angular_momentum"]["max_error"] for run in (one, two)]
        self.assertAlmostEqual(*momenta, delta=1e-13)
        self.assertEqual((one["parameters"]["V"], one["parameters"]["k"]), ("-k/r", 1.5))
        self.write("polar.toml", self.hamflow("convert", "typed.toml", "--to", "polar").stdout)
        polar = self.summary("polar.toml")
        self.assertAlmostEqual(polar["energy"]["initial"], one["energy"]["initial"], delta=1e-15)

    def test_orbit_of_a_typed_potential(self):
        """Turning points, apsidal angle and period come from V(r) and its derivatives, as for built-in potentials."""
        for chart in ("cartesian", "polar"):
            sets = ["--set", f"problem.coordinates={chart}"]
            if chart == "polar":
                sets += ["--set", "problem.initial={ q = [1, 0.3], p = [0.1, 1.1] }"]
            one, two = self.summary("typed.toml", *sets)["orbit"], self.summary("kepler.toml", *sets)["orbit"]
            self.assertEqual((one["type"], one["closed"], one["circular_stable"]),
                             (two["type"], two["closed"], two["circular_stable"]))
            for key in ("r_min", "r_max", "circular_radius", "apsidal_angle", "radial_period"):
                self.assertAlmostEqual(one[key], two[key], delta=1e-13 * abs(two[key]), msg=key)
        start = ["--set", "problem.orbit={ energy = -0.4, angular_momentum = 1.1 }", "--set", "run.steps=0"]
        for arithmetic in ("double", "quad"):
            one, two = (self.summary(name, *start, "--set", f"run.arithmetic={arithmetic}")["final"]
                        for name in ("typed.toml", "kepler.toml"))
            for key in "qp":
                for a, b in zip(one[key], two[key], strict=True):
                    self.assertAlmostEqual(float(a), float(b), delta=1e-15)
        deep = ["--set", "problem.orbit={ energy = -40, angular_momentum = 1.1 }"]
        self.assertIn("V_eff <= energy", self.hamflow("run", "typed.toml", *deep, "--out", "none", status=2).stderr)
        # With a time there is neither an energy nor an orbit.
        timed = self.summary("typed.toml", "--set", "problem.V=-k/r*(1 + cos(t)/9)")
        self.assertNotIn("orbit", timed)

    def test_new_with_a_typed_potential(self):
        for chart in ("cartesian", "polar"):
            self.write("new.toml", self.hamflow("new", "central-force", "--potential", "formula", "--coordinates", chart).stdout)
            run = self.summary("new.toml")
            self.assertEqual((run["status"], run["parameters"]["potential"]), ("done", "formula"))
            self.assertLess(run["energy"]["max_relative_error"], 0.02)

    def test_wrong_potentials(self):
        for old, new, words in (
            ('"-k/r"', '"-kk/r"', "problem.V: found \"-kk/r\", column 2"),
            ('"-k/r"', '"-k/x"', "problem.V: found"),
            ('V = "-k/r"', "", "problem.V: missing; allowed a non-empty text"),
            ("{ k = 1.5 }", "{ k = 1.5, mass = 1 }", "problem.parameters.mass: found the name mass"),
            ("mass = 2", 'mass = 2\ncoordinates = "polarr"', "did you mean polar?"),
            ('"formula"', '"formulla"', "did you mean formula?"),
        ):
            self.write("wrong.toml", self.typed.replace(old, new, 1))
            text = self.hamflow("run", "wrong.toml", "--out", "none", status=2).stderr
            self.assertIn(words, text, new)


class FallsIntoTheCentre(FormulaCase):
    def test_typed_fields_run_as_built_in_ones(self):
        found = []
        for potential in ['potential = "kepler"', 'potential = "formula"\nV = "-1/r"']:
            self.write("d.toml", f"""
[problem]
name = "central-force"
{potential}
orbit = {{ energy = -0.5, angular_momentum = 0 }}
[method]
name = "stv4"
[run]
dt = 0.01
steps = 20
""")
            done = self.summary("d.toml")
            self.assertTrue(done["orbit"]["falls_into_centre"])
            found.append(done["final"]["q"][0])
        self.assertAlmostEqual(found[0], found[1], delta=1e-14)

    def test_starts_of_a_typed_field_have_no_kind(self):
        self.write("d.toml", """[problem]\nname = "central-force"\npotential = "formula"\nV = "-1/r"\norbit = { kind = "circle", r0 = 1 }
[method]\nname = "stv4"\n[run]\ndt = 0.01\nsteps = 20\n""")
        self.assertIn("allowed without: energy, angular_momentum", self.hamflow("run", "d.toml", "--out", "none", status=2).stderr)


if __name__ == "__main__":
    unittest.main()

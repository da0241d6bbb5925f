"""Constraints: Cartesian pendulums, typed constraints, both forms, and what is refused."""

import json
import math
import unittest

from command import EXAMPLES, CommandCase

EPSILON = 2.0**-52
PENDULUM = """
[problem]
name = "pendulum"
{problem}
[method]
name = "{method}"
[run]
dt = {dt}
steps = {steps}
"""
PLANE = 'coordinates = "cartesian"\ninitial = { q = [0.6, -0.8], p = [0.8, 0.6] }'
ANGLE = 'initial = { q = ["atan2(0.6, 0.8)"], p = [1] }'
SPACE = 'coordinates = "cartesian"\ndimension = 3\ninitial = { q = [0.6, 0, -0.8], p = [0.4, 0.9, 0.3] }'
RODS = """
[problem]
name = "double-pendulum"
coordinates = "cartesian"
masses = [1, 2]
half_lengths = [1, 0.75]
initial = {{ q = ["sin(0.7)", "-cos(0.7)", "2*sin(0.7) - 0.75*sin(0.4)", "-2*cos(0.7) - 0.75*cos(0.4)"], p = [0, 0, 0, 0] }}
[method]
name = "{method}"
[run]
dt = {dt}
steps = {steps}
"""
TYPED = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + y"
constraints = ["{g}"]
{form}
initial = {{ q = [0.6, -0.8], p = [0.8, 0.6] }}
[method]
name = "{method}"
[run]
dt = 0.05
steps = 1000
"""
T_TUBE = """
[problem]
name = "t-tube"
eps = -0.6
velocities = [6, 1]
{problem}
[method]
name = "{method}"
[run]
dt = 0.01
steps = 300
"""


class Constraints(CommandCase):
    def pendulum(self, problem=PLANE, method="rattle", dt=0.05, steps=1000):
        return self.write("s.toml", PENDULUM.format(problem=problem, method=method, dt=dt, steps=steps))

    def rods(self, method="rattle", dt=0.005, steps=400):
        return self.write("rods.toml", RODS.format(method=method, dt=dt, steps=steps))

    def typed(self, g="x^2 + y^2 - 1", form="", method="rattle"):
        return self.write("typed.toml", TYPED.format(g=g, form=form, method=method))

    def refused(self, file, *arguments):
        return self.hamflow("run", file, "--out", "none", *arguments, status=2).stderr

    def test_residuals_at_rounding(self):
        # g has terms of the size 2 (rods: 5), which round a handful of times, whatever the number of steps.
        for file in (self.pendulum(steps=20000), self.typed(), self.rods()):
            s = self.summary(file)
            self.assertEqual(set(s["constraints"]), {"position", "velocity"})
            self.assertLess(s["constraints"]["position"], 16 * EPSILON)
            self.assertLess(s["constraints"]["velocity"], 64 * EPSILON)
            self.assertLess(s["energy"]["max_relative_error"], 1e-2)
            self.assertGreater(s["newton"]["mean"], 0)
        self.assertNotIn("constraints", self.summary("kepler.toml"))

    def test_the_sphere_and_what_it_keeps(self):
        for method, level in (("rattle", 2e-3), ("rattle4", 2e-5)):
            s = self.summary(self.pendulum(SPACE, method))
            self.assertLess(s["constraints"]["position"], 16 * EPSILON)
            self.assertLess(s["energy"]["max_relative_error"], level)
            # A walk of some roundings a step.
            self.assertLess(s["invariants"]["angular_momentum"]["max_error"], 16 * EPSILON * math.sqrt(1000))
        self.assertEqual(s["certificate"]["reversal_distance"]["proves"], "reversible to rounding")

    def test_three_forms_agree(self):
        exact = self.summary(self.pendulum(ANGLE, "taylor"))["final"]
        q, p = exact["q"][0], exact["p"][0]
        there = [math.sin(q), -math.cos(q), p * math.cos(q), p * math.sin(q)]
        errors = []
        for dt, steps in ((0.05, 1000), (0.025, 2000)):
            end = self.summary(self.pendulum(PLANE, "rattle4", dt, steps))["final"]
            errors.append(max(abs(a - b) for a, b in zip(end["q"] + end["p"], there)))
        self.assertAlmostEqual(math.log2(errors[0] / errors[1]), 4, delta=0.3)
        form = PLANE + '\nconstraint_form = "multiplier"'
        s = self.summary(self.pendulum(form, "taylor"))
        self.assertLess(max(abs(a - b) for a, b in zip(s["final"]["q"] + s["final"]["p"], there)), 1e-9)
        self.assertLess(s["exact"]["max_difference"], 1e-9)

    def test_the_multipliers_drift(self):
        form = PLANE + '\nconstraint_form = "multiplier"'
        drifts = [self.summary(self.pendulum(form, "rk4", 0.1, n))["constraints"]["position"] for n in (100, 1000)]
        self.assertGreater(drifts[0], 1e-8)
        self.assertGreater(drifts[1], 4 * drifts[0])
        for method in ("dop853", "taylor"):
            self.assertLess(self.summary(self.pendulum(form, method))["constraints"]["position"], 1e-8)
        self.assertGreater(self.summary(self.typed(form='constraint_form = "multiplier"', method="rk4"))
                           ["constraints"]["position"], 1e-9)

    def test_the_double_pendulum_in_angles(self):
        angles = self.write("angles.toml", """
[problem]
name = "double-pendulum"
masses = [1, 2]
half_lengths = [1, 0.75]
initial = { q = [0.7, -0.4], p = [0, 0] }
[method]
name = "taylor"
[run]
dt = 0.01
steps = 100
""")
        q1, q2 = self.summary(angles)["final"]["q"]
        there = [math.sin(q1), -math.cos(q1), 2 * math.sin(q1) + 0.75 * math.sin(q2),
                 -2 * math.cos(q1) - 0.75 * math.cos(q2)]
        errors = []
        for dt, steps in ((0.01, 100), (0.005, 200)):
            end = self.summary(self.rods("rattle", dt, steps))["final"]["q"]
            errors.append(max(abs(a - b) for a, b in zip(end, there)))
        self.assertAlmostEqual(math.log2(errors[0] / errors[1]), 2, delta=0.15)
        end = self.summary(self.rods("taylor", 0.01, 100), "--set", "problem.constraint_form=multiplier")["final"]["q"]
        self.assertLess(max(abs(a - b) for a, b in zip(end, there)), 1e-10)

    def test_in_all_digits(self):
        for arithmetic, unit in (("compensated", EPSILON), ("double-double", 2.0**-100), ("quad", 2.0**-112),
                                 ("mp(40)", 1e-39)):
            file = self.pendulum('coordinates = "cartesian"\ninitial = { q = ["3/5", "-4/5"], p = ["4/5", "3/5"] }',
                                 "rattle", steps=20)
            s = self.summary(file, "--set", f"run.arithmetic={arithmetic}")
            self.assertLess(s["constraints"]["position"], 64 * unit)
            self.assertLess(s["constraints"]["velocity"], 64 * unit)

    def test_refusals(self):
        off = self.pendulum('coordinates = "cartesian"\ninitial = { q = [0.6, -0.81], p = [0.81, 0.6] }')
        self.assertIn("found a start that violates the constraints, |g(q)| = 0.016", self.refused(off))
        across = self.pendulum('coordinates = "cartesian"\ninitial = { q = [0.6, -0.8], p = [0.8, 0.61] }')
        self.assertIn("leaves the constraints, |g'(q) M^-1 p| = 0.016", self.refused(across))
        near = 'coordinates = "cartesian"\ninitial = { q = [0.6, "-0.8 + 5e-14"], p = [0.8, 0.6] }'
        self.assertEqual(self.summary(self.pendulum(near))["status"], "done")
        self.assertIn("rattle needs constraints g(q) = 0", self.refused(self.pendulum(ANGLE)))
        self.assertIn("verlet does not support constraints", self.refused(self.pendulum(method="verlet")))
        self.assertIn("rattle, rattle4", self.refused(self.pendulum(method="cg")))
        form = PLANE + '\nconstraint_form = "multiplier"'
        for method in ("cg", "verlet", "rattle", "euler"):
            self.assertIn("needs the gradient of H, but the field with multipliers is not a gradient",
                          self.refused(self.pendulum(form, method)))
        for key, value in (("dimension", "3"), ("constraint_form", '"manifold"')):
            text = self.refused(self.pendulum(ANGLE + f"\n{key} = {value}", "verlet"))
            self.assertIn(f'problem.{key}: found', text)
            self.assertIn('allowed with coordinates = "cartesian"', text)
        self.assertIn("allowed 2, 3", self.refused(self.pendulum(PLANE + "\ndimension = 4")))
        for key in ("lyapunov", "eigenvalues"):
            self.assertIn("with constraints; allowed in coordinates without constraints",
                          self.refused(self.pendulum(), "--set", f"run.{key}=true"))
        self.assertIn("lattice", self.refused(self.pendulum(), "--set", "run.arithmetic=lattice"))
        self.assertIn("inertias", self.refused(self.rods(), "--set", "problem.inertias=[1, 0]"))
        self.assertIn("no variant", self.refused(self.rods(), "--set", "problem.model=linear"))

    def constrained(self, constraints, problem="", method="rattle"):
        return self.write("dependent.toml", f"""
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + y"
constraints = {constraints}
{problem}
initial = {{ q = [1, 0], p = [0, 1] }}
[method]
name = "{method}"
[run]
dt = 0.05
steps = 10
""")

    def test_dependent_constraints(self):
        for constraints in ('["x^2 + y^2 - 1", "2*x^2 + 2*y^2 - 2"]', '["x^2 + y^2 - 1", "x - 1"]',
                            '["sqrt(x^2 + y^2)/3 - 1/3", "x^2 + y^2 - 1"]', '["x - 1", "(x - 1)*(y + 1)", "x^2 - 1"]'):
            for form in ("", 'constraint_form = "multiplier"'):
                text = self.refused(self.constrained(constraints, form, "rk4" if form else "rattle"))
                self.assertIn("problem.constraints: found constraints whose gradients are linearly dependent at the start; "
                              "allowed independent constraints, fewer than coordinates", text)
        text = self.refused(self.constrained('["(x - 1)^2"]'))
        self.assertIn("found a constraint whose gradient vanishes at the start", text)

    def test_the_constraint_that_fails_is_named(self):
        text = self.refused(self.constrained('["x - 1", "x^2 + y^2 - 4"]'))
        self.assertIn("violates the constraints, |g(q)| = 3; allowed at most 1e-12: constraints[1] = x^2 + y^2 - 4", text)

    def test_no_constraints_are_an_empty_list(self):
        for form in ("", 'constraint_form = "manifold"'):
            s = self.summary(self.constrained("[]", form, "stv4"))
            self.assertEqual(s["status"], "done")
            self.assertNotIn("constraints", s)

    def test_a_cross_term_under_a_common_factor(self):
        ends = []
        for kinetic in ("(p_x^2 + p_x*p_y + p_y^2)/2", "p_x^2/2 + p_x*p_y/2 + p_y^2/2"):
            file = self.constrained('["x^2 + y^2 - 1"]')
            text = (self.folder / file).read_text().replace("(p_x^2 + p_y^2)/2", kinetic).replace(
                "p = [0, 1]", 'p = ["-1/2", 1]')
            for method in ("rattle", "rkn8-s19"):
                other = text.replace('"rattle"', f'"{method}"')
                if method != "rattle":
                    other = other.replace("constraints", "# constraints")
                s = self.summary(self.write("cross.toml", other))
                ends.append(s["final"]["q"] + s["final"]["p"])
        for one, other in zip(ends[:2], ends[2:], strict=True):  # ten steps that round differently
            for a, b in zip(one, other, strict=True):
                self.assertAlmostEqual(a, b, delta=256 * EPSILON)

    def test_typed_constraints_are_checked(self):
        self.assertIn("problem.constraints[0]", self.refused(self.typed("x^2 + z^2 - 1")))
        self.assertIn("found p_x in it; allowed coordinates and parameters", self.refused(self.typed("x*p_x")))
        self.assertIn("found t in it", self.refused(self.typed("x - t")))
        unknown = self.refused(self.typed("x + w"))
        self.assertIn("unknown symbol w", unknown)
        self.assertNotIn("p_x", unknown)
        self.assertIn("found no coordinate in it", self.refused(self.typed("1 - 1")))
        bent = self.typed()
        text = (self.folder / bent).read_text().replace("(p_x^2 + p_y^2)/2", "(p_x^2 + p_y^2)/(2 + x^2)")
        self.assertIn("constant M", self.refused(self.write("bent.toml", text)))
        text = (self.folder / bent).read_text().replace('constraints = ["x^2 + y^2 - 1"]', "").replace("rattle", "rk4")
        self.assertIn("constraint_form", self.refused(self.write("free.toml", text.replace(
            "initial", 'constraint_form = "multiplier"\ninitial'))))

    def test_other_ways_to_say_the_same(self):
        # Another g of the same circle, with a parameter: the same motion to rounding.
        one = self.summary(self.typed())
        text = (self.folder / "typed.toml").read_text().replace("x^2 + y^2 - 1", "sqrt(x^2 + y^2) - l").replace(
            "initial", "parameters = { l = 1 }\ninitial")
        other = self.summary(self.write("root.toml", text))
        for a, b in zip(one["final"]["q"] + one["final"]["p"], other["final"]["q"] + other["final"]["p"]):
            self.assertAlmostEqual(a, b, delta=1e-11)
        built_in = self.summary(self.pendulum())
        for a, b in zip(one["final"]["q"] + one["final"]["p"], built_in["final"]["q"] + built_in["final"]["p"]):
            self.assertAlmostEqual(a, b, delta=1e-11)

    def test_force_that_depends_on_time(self):
        text = (self.folder / self.typed()).read_text().replace("+ y\"", "+ y*(1 + 0.1*sin(t))\"")
        s = self.summary(self.write("driven.toml", text))
        self.assertLess(s["constraints"]["position"], 16 * EPSILON)
        self.assertLess(s["energy"]["max_relative_error"], 1e-2)

    def test_conversion(self):
        there = json.loads(self.hamflow("convert", self.pendulum(ANGLE, "taylor"), "--to", "cartesian", "--json").stdout)
        for a, b in zip(there["q"] + there["p"], [0.6, -0.8, 0.8, 0.6]):
            self.assertAlmostEqual(a, b, delta=8 * EPSILON)
        self.hamflow("convert", self.pendulum(ANGLE, "taylor"), "--to", "cartesian", status=2)
        text = self.hamflow("convert", self.pendulum(ANGLE, "taylor"), "--to", "cartesian", "--set",
                            "method.name=rattle").stdout
        self.assertLess(self.summary(self.write("converted.toml", text))["constraints"]["position"], 16 * EPSILON)
        back = self.hamflow("convert", self.pendulum(), "--to", "generalised", "--set", "method.name=verlet").stdout
        self.assertAlmostEqual(self.summary(self.write("back.toml", back))["energy"]["initial"], -0.3, delta=8 * EPSILON)
        for chart in ("absolute", "relative"):
            text = self.hamflow("convert", self.rods(), "--to", chart, "--set", "method.name=taylor").stdout
            q1, q2 = self.summary(self.write("angles.toml", text), "--set", "run.steps=0")["final"]["q"]
            self.assertAlmostEqual(q1, 0.7, delta=16 * EPSILON)
            self.assertAlmostEqual(q2, -0.4 - (0.7 if chart == "relative" else 0), delta=16 * EPSILON)
            again = self.hamflow("convert", "angles.toml", "--to", "cartesian", "--set", "method.name=rattle",
                                 "--json").stdout
            for a, b in zip(json.loads(again)["q"], [math.sin(0.7), -math.cos(0.7)]):
                self.assertAlmostEqual(a, b, delta=16 * EPSILON)
        self.assertIn("dimension = 3, constraint_form = manifold, which has only the coordinates x, y, z", self.hamflow(
            "convert", self.pendulum(SPACE), "--to", "generalised", status=2).stderr)

    def test_conversion_of_runs(self):
        self.hamflow("run", self.pendulum(), "--out", "made.run", "--quiet")
        self.hamflow("convert", "made.run", "--to", "generalised", "-o", "angles.h5")
        rows = self.hamflow("convert", "made.run", "--to", "generalised").stdout.splitlines()
        self.assertEqual(rows[0], "t,q,p,energy")
        self.assertAlmostEqual(float(rows[1].split(",")[1]), math.atan2(0.6, 0.8), delta=4 * EPSILON)
        self.hamflow("run", self.pendulum(ANGLE, "verlet"), "--set", "run.arithmetic=quad", "--set", "run.steps=5",
                     "--out", "quad.run", "--quiet")
        rows = self.hamflow("convert", "quad.run", "--to", "cartesian").stdout.splitlines()
        self.assertEqual(rows[0], "t,x,y,p_x,p_y,energy")
        self.assertGreater(len(rows[2].split(",")[1]), 30)

    def test_reverse_resume_compare_and_sweep(self):
        for method in ("rattle", "rattle4"):
            s = json.loads(self.hamflow("reverse", self.pendulum(method=method), "--json").stdout)
            self.assertTrue(s["method_reversible"])
            self.assertLess(s["relative_distance"], 1e-11)
        file = self.rods("rattle4", 0.005, 400)
        whole = self.summary(file)
        self.hamflow("run", file, "--set", "run.steps=150", "--out", "part.run", "--quiet")
        self.hamflow("run", file, "--out", "part.run", "--resume", "--quiet")
        resumed = json.loads((self.folder / "part.run/summary.json").read_text())
        for key in ("final", "energy", "constraints", "newton"):
            self.assertEqual(whole[key], resumed[key])
        s = json.loads(self.hamflow("compare", self.rods("rattle", 0.005, 100), "--methods", "rattle,rattle4", "--dt",
                                    "0.005,0.0025", "--out", "none", "--json").stdout)
        errors = {(row["method"], row["dt"]): row["error"] for row in s["rows"]}
        for method, order in (("rattle", 2), ("rattle4", 4)):
            self.assertAlmostEqual(math.log2(errors[method, 0.005] / errors[method, 0.0025]), order, delta=0.3)
        s = json.loads(self.hamflow("sweep", self.pendulum(steps=50), "--vary", "run.dt=0.02,0.05", "--out", "none",
                                    "--json").stdout)
        self.assertEqual(s["done"], 2)
        self.assertEqual(s["rows"][1]["final"]["q"], self.summary(self.pendulum(steps=50))["final"]["q"])

    def test_the_t_tube_on_its_rails(self):
        # Rails are straight: rattle takes Verlet's steps there, but for rounding, and the walls see the same motion.
        def tube(method, problem):
            text = T_TUBE.format(method=method, problem=problem)
            # The force of a soft wall is stiff: a step of 0.01 jumps beyond it.
            return self.summary(self.write("tube.toml", text.replace("dt = 0.01", "dt = 0.001") if "soft" in text else text))

        rails = 'coordinates = "cartesian"\n'
        for free, bound in (("verlet", "rattle"), ("stv4", "rattle4")):
            for rule in ("event", "reject", "soft"):
                one = tube(free, f'wall_rule = "{rule}"')
                other = tube(bound, rails + f'wall_rule = "{rule}"')
                x1, y1, x2, y2 = other["final"]["q"]
                self.assertLess(max(abs(y1), abs(x2)), 16 * EPSILON)
                self.assertAlmostEqual(x1, one["final"]["q"][0], delta=1e-9)
                self.assertAlmostEqual(y2, one["final"]["q"][1], delta=1e-9)
                self.assertEqual({key.replace("q1", "x1").replace("q2", "y2"): n for key, n in one["events"].items()},
                                 other["events"])
                self.assertLess(other["constraints"]["position"], 16 * EPSILON)
                self.assertLess(other["constraints"]["velocity"], 64 * EPSILON)
                for name in ("kinetic1", "kinetic2"):
                    self.assertAlmostEqual(one["observables"][name]["mean"], other["observables"][name]["mean"], delta=1e-9)
        one = tube("rk4", "")
        other = tube("rk4", rails + 'constraint_form = "multiplier"')
        self.assertAlmostEqual(other["final"]["q"][0], one["final"]["q"][0], delta=1e-9)
        self.assertAlmostEqual(other["final"]["q"][3], one["final"]["q"][1], delta=1e-9)
        for rule, method in (("mirror", "rattle"), ("mirror", "rattle4")):
            text = self.refused(self.write("tube.toml", T_TUBE.format(method=method, problem=rails + f'wall_rule = "{rule}"')))
            self.assertIn("with constraints, where drifts are not free", text)
        walls = PLANE + '\nwalls = [{ coordinate = "x", max = 0.9 }]'
        self.assertIn("found walls together with constraints", self.refused(self.pendulum(walls)))

    def test_lists_and_templates(self):
        text = self.hamflow("new", "pendulum", "--all").stdout
        self.assertNotIn("rattle", text.split("[method]")[0])
        shown = self.hamflow("show", "pendulum").stdout
        for word in ("cartesian", "dimension", "constraint_form", "multiplier"):
            self.assertIn(word, shown)
        self.assertIn("constraints", self.hamflow("show", "rattle").stdout)
        self.assertIn("rattle4", self.hamflow("list", "methods", "--all").stdout)
        self.assertIn("constraints", self.hamflow("show", "formula").stdout)
        made = self.hamflow("new", "double-pendulum", "--coordinates", "cartesian", "--all").stdout
        self.assertLess(self.summary(self.write("new.toml", made))["constraints"]["position"], 64 * EPSILON)

    def test_the_example(self):
        s = self.summary(EXAMPLES / "spherical_pendulum.toml", "--set", "output.figures=[]")
        self.assertLess(s["constraints"]["position"], 16 * EPSILON)


    def test_two_constraints_stay_at_their_rounding(self):
        """One hardly bends, the other does: what Newton predicts from the largest of both residuals is too small."""
        self.write("curve.toml", """
[problem]
name = "formula"
coordinates = ["x", "y", "z"]
hamiltonian = "(p_x^2 + 2*p_y^2 + p_z^2)/2 + z"
constraints = ["x^2 + y^2 + z^2 - 1", "x - 0.1*z^2"]
initial = { q = [0, 1, 0], p = [0, 0, -0.3] }
[method]
name = "rattle4"
[run]
dt = 0.01
steps = 200
""")
        for arithmetic, epsilon in (("double", 2.3e-16), ("quad", 2e-34), ("mp(25)", 1e-24)):
            found = self.summary("curve.toml", "--set", f"run.arithmetic={arithmetic}")["constraints"]
            for name in ("position", "velocity"):  # 64 units of terms that add up to 4 at most
                self.assertLess(float(found[name]), 256 * epsilon, f"{arithmetic} {name}")


if __name__ == "__main__":
    unittest.main()

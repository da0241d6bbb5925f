"""What is wrong in a typed Hamiltonian is pointed at, and what is kept of it is told."""

import json
import unittest

from test_formula import HENON, FormulaCase


class Wrong(FormulaCase):
    """Every error names the file, the line, the column, the key, and the column inside the formula."""

    def errors(self, text):
        self.write("wrong.toml", text)
        done = self.hamflow("run", "wrong.toml", "--out", "none", "--json", status=2)
        return json.loads(done.stdout)["errors"], done.stderr

    def test_formulas(self):
        line = HENON.splitlines().index(next(row for row in HENON.splitlines() if row.startswith("hamiltonian"))) + 1
        for formula, words in (
            ("(p_x^2 + p_y^2)/2 + kk*x", "did you mean k?"),
            ("(p_x^2 + p_y^2)/2 + 2x", "column 22"),
            ("(p_x^2 + p_y^2)/2 + sinn(x)", "did you mean sin?"),
            ("(p_x^2 + p_y^2)/2 + x/0", "divided by 0"),
            ("(p_x^2 + p_y^2)/2 + 9^9^9^9", "column"),
            ("(p_x^2 + p_y^2/2", "')'"),
            ("", "a non-empty text"),
        ):
            found, text = self.errors(HENON.replace("(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + k*(x^2*y - y^3/3)", formula))
            self.assertEqual(len(found), 1, text)
            self.assertEqual((found[0]["key"], found[0]["line"]), ("problem.hamiltonian", line), text)
            self.assertIn(words, found[0]["message"])
            self.assertIn(f"wrong.toml:{line}:", text)

    def test_keys(self):
        for old, new, key, words in (
            ('coordinates = ["x", "y"]', 'coordinates = ["x", "sin"]', "problem.coordinates", "sin"),
            ('coordinates = ["x", "y"]', 'coordinates = ["x", 2]', "problem.coordinates", "allowed an array of texts"),
            ('coordinates = ["x", "y"]', "", "problem.coordinates", "missing; allowed an array of names"),
            ('coordinates = ["x", "y"]', 'coordinats = ["x", "y"]', "problem.coordinats", "did you mean coordinates?"),
            ("hamiltonian =", 'kinetic = "p_x^2"\nhamiltonian =', "problem.kinetic", "together with hamiltonian; allowed either"),
            ("hamiltonian =", "potential =", "problem.kinetic", "missing; allowed either hamiltonian, or"),
            ("{ k = 1 }", "{ k = true }", "problem.parameters.k", "a number"),
            ("{ k = 1 }", "{ k = 1, pi = 3 }", "problem.parameters.pi", "pi"),
            ("{ k = 1 }", "{ k = 1, x = 3 }", "problem.coordinates", "found the name x a second time"),
            ("{ k = 1 }", "{ k = 1 }\ninvariants = { L = \"x*p_z\" }", "problem.invariants.L", "p_z"),
            ("{ k = 1 }", "{ k = 1 }\nconstraints = [\"x^2 - z\"]", "problem.constraints[0]", "allowed"),
            ("q = [0.1, 0.2]", "q = [0.1, 0.2, 0.3]", "problem.initial.q", "2 numbers"),
        ):
            found, text = self.errors(HENON.replace(old, new, 1))
            message = [error["message"] for error in found if error["key"].startswith(key)]
            self.assertTrue(message, f"{new}\n{text}")
            self.assertIn(words, message[0])

    def test_methods_that_need_a_sum(self):
        text = self.hamflow("run", "c.toml", "--set", "method.name=stv4", "--out", "none", status=2).stderr
        self.assertIn("method.name", text)
        self.assertIn("separable", text)

    def test_other_errors_are_told_at_once(self):
        found, text = self.errors(HENON.replace("k*(x", "kk*(x").replace("dt = 0.1", "dt = 0"))
        self.assertEqual([error["key"] for error in found], ["problem.hamiltonian", "run.dt"], text)


    def test_names_of_what_is_watched(self):
        """Columns, as observables are."""
        for name, words in (("a/b", "found the name \"a/b\"; allowed letters, digits and _"), ("", "found the name \"\""),
                            ("u,v", "letters, digits and _"), ("2x", "a letter or _ first"),
                            *((name, f"found the name {name}, which every run uses for a column")
                              for name in ("t", "step", "energy", "x", "p_y", "q1", "p2"))):
            found, text = self.errors(HENON.replace("{ k = 1 }", '{ k = 1 }\ninvariants = { "%s" = "p_x", L = "x" }' % name))
            self.assertEqual([error["key"] for error in found], [f"problem.invariants.{name}"], text)
            self.assertIn(words, found[0]["message"])
        done = self.hamflow("run", "f.toml", "--set", 'problem.invariants={"a/b"="p_x"}', "--out", "i.run", status=2)
        self.assertIn("--set: error: problem.invariants.a/b: found", done.stderr)
        self.assertFalse((self.folder / "i.run").exists())

    def test_every_formula_that_is_wrong_is_told(self):
        wrong = HENON.replace('hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + k*(x^2*y - y^3/3)"',
                              'kinetic = "p_x^2*x"\npotential = "x*p_x + k"\ninvariants = { A = "zz", B = "y", C = "x +" }')
        found, text = self.errors(wrong)
        self.assertEqual([error["key"] for error in found], ["problem.kinetic", "problem.potential", "problem.invariants.A",
                                                             "problem.invariants.C"], text)

    def test_a_symbol_that_is_nearly_a_name(self):
        for old, new, words in (("k*(x", "K*(x", "the unknown symbol K"), ("p_x^2", "p^2", "did you mean p_x?")):
            found, text = self.errors(HENON.replace(old, new, 1))
            self.assertIn(words, found[0]["message"])
        self.assertIn("did you mean K?", self.errors(HENON.replace("{ k = 1 }", "{ K = 1 }"))[1])

    def test_an_empty_list_of_coordinates(self):
        self.assertIn("found an empty array; allowed an array of texts, at least one",
                      self.errors(HENON.replace('["x", "y"]', "[]", 1))[1])

    def test_velocities_of_an_h_that_is_linear_in_p(self):
        text = HENON.replace("(p_x^2 + p_y^2)/2 + (x^2", "p_x + p_y + (x^2").replace("p = [", "v = [").replace("stv4", "cg")
        self.assertIn("velocities do not determine the momenta: the mass matrix is singular", self.errors(text)[1])

    CENTRAL = """[problem]
name = "central-force"
potential = "formula"
V = "-k/r"
parameters = { k = 1 }
initial = { q = [1, 0], p = [0, 1] }
[method]
name = "cg"
[run]
dt = 0.1
steps = 10
"""

    def test_parameters_of_a_central_field_that_stand_nowhere(self):
        found, text = self.errors(self.CENTRAL.replace("{ k = 1 }", "{ k = 1, kk = 2 }"))
        self.assertEqual([error["key"] for error in found], ["problem.parameters.kk"], text)
        self.assertIn("no formula uses; did you mean k?", text)
        self.write("v.toml", self.CENTRAL)
        self.hamflow("run", "v.toml", "--out", "none", "--set", "problem.parameters={ k = 1, kk = 2 }", "--set",
                     "output.observables={ o = 'kk*x' }")
        self.hamflow("sweep", "v.toml", "--out", "none", "--vary", "problem.parameters.b=0.1,0.2", status=2)

    def test_an_orbit_in_a_field_that_changes(self):
        text = self.CENTRAL.replace("initial = { q = [1, 0], p = [0, 1] }", "orbit = { energy = -0.4, angular_momentum = 1 }")
        found, said = self.errors(text.replace("-k/r", "-k/r*(1 + t)"))
        self.assertEqual([error["key"] for error in found], ["problem.orbit"], said)
        self.assertIn("allowed with a V without t", said)

    def test_what_is_no_number_is_not_kept(self):
        done = self.hamflow("run", "f.toml", "--set", 'problem.invariants={ bad = "sqrt(p_x - 9)", good = "k" }', "--out", "none")
        self.assertRegex(done.stdout, "bad +not finite -> not finite, error unknown")
        self.assertRegex(done.stdout, "good +1 -> 1, largest error 0")
        self.assertIn("warning: no_number: bad was not finite", done.stderr)
        summary = self.summary("f.toml", "--set", 'problem.invariants={ bad = "sqrt(p_x - 9)" }')
        self.assertIsNone(summary["invariants"]["bad"]["max_error"])
        self.assertEqual([warning["kind"] for warning in summary["warnings"]], ["no_number"])

    def test_show_tells_what_is_watched_and_what_is_kept(self):
        self.write("w.toml", HENON.replace("{ k = 1 }", '{ k = 1 }\ninvariants = { am = "x*p_y - y*p_x" }'))
        shown = self.hamflow("show", "w.toml").stdout
        self.assertIn("  watched: am = x*p_y - y*p_x\n", shown)
        self.assertNotIn("conserved", shown)
        self.assertNotIn("a number; a number", shown)
        self.write("s.toml", """[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + y"
constraints = ["x^2 + y^2 - 1"]
initial = { q = [1, 0], p = [0, 1] }
[method]
name = "rattle"
[run]
dt = 0.1
steps = 10
""")
        shown = self.hamflow("show", "s.toml").stdout
        self.assertIn("  constraint: x^2 + y^2 - 1 = 0\n  constraint_form: manifold\n", shown)


if __name__ == "__main__":
    unittest.main()

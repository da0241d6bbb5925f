"""Options wherever they stand: keys of a scenario, --set, the text of a method, the shell, the command line. One
declaration each, so one meaning, one set of values and one way to be refused."""

import json
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

STATE = """[problem]
name = "pendulum"
initial = { q = [1.0], p = [0.25] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 100
"""


class Options(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("state.toml", STATE)

    def refused(self, *sets, scenario="kepler.toml"):
        arguments = [word for text in sets for word in ("--set", text)]
        return self.hamflow("run", scenario, "--out", "none", *arguments, status=2).stderr

    def final(self, *sets, scenario="kepler.toml"):
        s = self.summary(scenario, *[word for text in sets for word in ("--set", text)])
        return s["final"], s["method"]

    def shell(self, commands, *arguments, scenario="kepler.toml", status=0):
        done = subprocess.run([HAMFLOW, "shell", scenario, "--json", *arguments], cwd=self.folder, input=commands,
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, status, f"{commands}\n{done.stdout}\n{done.stderr}")
        return done.stderr if status else [json.loads(line) for line in done.stdout.splitlines()]

    # ---- methods with options, by key and by text ----

    def test_a_method_with_its_options_in_one_text(self):
        self.assertEqual(self.final('method={name="cg(1,3)"}'), self.final('method={name="cg",degree=1,quadrature=3}'))
        self.assertEqual(self.final('method={name="taylor(order=12)"}')[1], "taylor(order=12)")
        text = self.refused('method={name="cg(1,5)",quadrature=3}')
        self.assertIn("method.quadrature: given here and in method.name; allowed once", text)
        self.assertIn("closing parenthesis", self.refused('method={name="cg(1,5"}'))
        self.assertIn("quadrature: found '65'; allowed a whole number from 1 to 64", self.refused('method={name="cg(1,65)"}'))
        self.assertIn("did you mean order?", self.refused('method={name="taylor(oder=3)"}'))

    def test_another_method_from_outside_drops_the_options_of_the_file(self):
        done = self.hamflow("run", "kepler.toml", "--out", "none", "--set", "method.name=taylor")
        self.assertIn("method.quadrature of the file is not used: method.name is set to taylor", done.stderr)
        # The options that the new name carries are its own.
        self.assertEqual(self.final("method.name=cg(1,2)")[1], "cg(1,2)")
        # What is set beside it is not dropped.
        self.assertIn("unknown key", self.refused("method.name=stv4", "method.quadrature=3"))
        # The saved scenario can be read: without what does not apply.
        self.shell("step 3\nsave a.run\n", "--set", "method.name=stv4")
        self.hamflow("convert", "a.run", "--to", "polar")

    def test_keys_of_all_methods_are_known_when_the_name_is_wrong(self):
        text = self.refused("method={name='taylr',order=20,step_control='fixed',degree=1}")
        self.assertEqual(len(text.splitlines()), 1, text)
        self.assertIn("did you mean taylor?", text)

    # ---- the shell ----

    def test_the_shell_keeps_the_options_of_a_method(self):
        here = self.shell("method taylor(order=30)\nstep 20\nshow all\n")[-1]
        self.assertEqual(here["method"], "taylor(order=30)")
        final, name = self.final("method={name='taylor',order=30}", "run.steps=20")
        self.assertEqual(name, "taylor(order=30)")
        self.assertEqual({key: here[key] for key in ("t", "q", "p")}, final)
        self.assertNotEqual(final, self.final("method={name='taylor',order=4}", "run.steps=20")[0])
        # What stays open is as it was set before, where the new method means the same by it.
        here = self.shell("tol 1e-7\nmethod taylor\nshow settings\n")[-1]
        self.assertEqual((here["method"], here["tolerance"]), ("taylor", 1e-12))
        here = self.shell("method dop853\ntol 1e-7\nmethod taylor\nshow settings\n")[-1]
        self.assertEqual((here["method"], here["tolerance"]), ("taylor(tolerance=1e-07)", 1e-7))

    def test_the_shell_sets_the_tolerance_of_every_method_that_has_one(self):
        for method in ("dop853", "taylor"):
            here = self.shell(f"method {method}\ntol 1e-6\nstep 50\nshow all\n")[-1]
            self.assertEqual(here["tolerance"], 1e-6)
            final, _ = self.final(f"method={{name='{method}',tolerance=1e-6}}", "run.steps=50")
            self.assertEqual({key: here[key] for key in ("t", "q", "p")}, final)
            self.assertIn("tol: found '2'; allowed a number between 0 and 1", self.shell(f"method {method}\ntol 2\n", status=2))
        text = self.shell("method stv4\ntol 1e-3\n", status=2)
        self.assertIn("stv4 has no tolerance; allowed with avf, cg, discrete-gradient, dop853, eg, gauss, implicit-midpoint, itoh-abe, "
                      "lobatto-3a-3b, rattle, taylor\n", text)

    def test_saved_sessions_can_be_read(self):
        self.shell("step 5\ndt 0.05\nstep 5\nsave a.run\n", "--set", "problem.initial={q=[2,0],p=[0,1]}", "--set", "problem.initial.q[0]=2.5")
        rows = self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()
        self.assertEqual(float(rows[1].split(",")[1]), 2.5)
        self.shell("step 5\nmethod taylor(order=20,tolerance=1e-9)\nstep 2\nsave b.run\n")
        self.hamflow("convert", "b.run", "--to", "polar")

    # ---- paths ----

    def test_entries_of_lists(self):
        first, _ = self.final("problem.initial.q[0]=0.5", scenario="state.toml")
        second, _ = self.final("problem.initial={q=[0.5],p=[0.25]}", scenario="state.toml")
        self.assertEqual(first, second)
        text = self.refused("problem.initial.q[1]=0.5", scenario="state.toml")
        self.assertIn("problem.initial.q[1]: found index 1 of an array of 1; allowed 0 to 0", text)
        bodies = f"{EXAMPLES}/two_bodies.toml"
        sets = ("--set", "problem.bodies[0].mass=3")
        text = self.hamflow("convert", bodies, "--to", "polar", *sets).stdout
        self.write("polar.toml", text)
        there, here = self.summary("polar.toml")["bodies"], self.summary(bodies, *sets)["bodies"]
        self.assertEqual([b["mass"] for b in there], [b["mass"] for b in here])
        self.assertEqual(there[0]["mass"], 3)

    def test_of_two_keys_that_exclude_each_other_the_one_set_holds(self):
        self.assertEqual(self.summary("kepler.toml", "--set", "run.t_end=3")["steps"], 30)
        self.assertIn("together", self.refused("run.t_end=3", "run.steps=30"))
        self.hamflow("run", "kepler.toml", "--set", "run.record=[0,1.05]", "--out", "a.run")
        self.assertEqual(len(self.hamflow("convert", "a.run", "--to", "polar").stdout.splitlines()), 3)
        self.assertIn("together", self.refused("run.record=[0,1]", "run.record_every=2"))
        final, _ = self.final("problem.initial={q=[1,0],p=[0,1.3]}", "run.steps=0")
        self.assertEqual(final["q"], [1, 0])

    def test_one_start(self):
        both = "problem.initial={q=[1,0],p=[0,1.3]}", "problem.orbit={kind='circle',r0=1}"
        self.assertIn("problem.initial: found together with orbit; allowed one of them", self.refused(*both))
        self.write("duffing.toml", '[problem]\nname="duffing"\ncase=1\nr0=1\nk=1\ninitial={q=[1],p=[0]}\n[method]\n'
                   'name="verlet"\n[run]\ndt=0.1\nsteps=1\n')
        self.assertIn("together with case; allowed one of them", self.hamflow("run", "duffing.toml", status=2).stderr)
        text = self.hamflow("run", f"{EXAMPLES}/two_bodies.toml", "--set", "problem.initial={q=[1,0],p=[0,1]}", status=2).stderr
        self.assertIn("found initial together with bodies; allowed one of them", text)

    # ---- numbers ----

    def test_whole_numbers_in_every_form(self):
        for text in ("1e2", '"1e2"', '"10^2"', '"2*50"'):
            self.assertEqual(self.summary("kepler.toml", "--set", f"run.steps={text}")["steps"], 100)
        self.assertEqual(self.shell("step 1e2\nshow step\n")[-1]["step"], 100)
        self.assertEqual(self.summary("kepler.toml", "--set", 'method={name="taylor(order=2e1)"}')["method"], "taylor(order=20)")
        done = self.hamflow("sweep", "kepler.toml", "--vary", "problem.mass=1:2:1e1", "--threads", "1e0", "--out", "none", "--json")
        self.assertEqual(json.loads(done.stdout)["members"], 10)
        self.assertIn("run.steps: found 100.5; allowed a whole number from 0", self.refused("run.steps=100.5"))
        text = self.hamflow("sweep", "kepler.toml", "--vary", "problem.mass=1:2:3", "--threads", "1.5", status=2).stderr
        self.assertIn("found '1.5'; allowed a whole number from 0 to 1024", text)

    def test_formulas_say_what_is_wrong_with_them(self):
        for text, words in (("2pi", "did you mean 2*pi?"), ("foo(3)", "function foo"), ("2*pi/0", "divided by 0")):
            for key in ("run.dt", "problem.mass", "run.t_end", "method.tolerance"):
                self.assertIn(words, self.refused(f'{key}="{text}"'), key)
            self.assertIn(words, self.shell(f"dt {text}\n", status=2))
            self.assertIn(words, self.shell(f"tol {text}\n", status=2))
            self.assertIn(words, self.refused(f'method={{name="taylor(tolerance={text})"}}'))
            self.assertIn(words, self.refused(f'problem.initial={{q=[1,"{text}"],p=[0,1]}}'))

    # ---- names ----

    def test_every_unknown_name_is_answered(self):
        for sets, meant in (
            (["run.stesp=3"], "steps"), (["output.format=['h5']"], "formats"), (["problem.mas=1"], "mass"),
            (["method.quadratur=3"], "quadrature"), (["run.arithmetic=quadd"], "quad"),
            (["output.figures=['orbits']"], "orbit"), (["output.formats=['h6']"], "h5"),
            (["problem.potential=keplr"], "kepler"), (["problem.name=central-forc"], "central-force"),
            (["problem.orbit.kind=elipse"], "ellipse"), (["method.name=stv"], "stv4"),
            (["method.criterion=sed"], "seed"), (["method.quadrature=aut"], "auto"),
            (["run.section={coordinate='p_xx'}"], "p_x"), (["run.lattice={positoin=1}"], "position"),
            (["method={name='dop853',step_control='fixd'}"], "fixed"),
        ):
            self.assertIn(f"did you mean {meant}?", self.refused(*sets), sets)
        for arguments, meant in (
            (["runn"], "run"), (["list", "method"], "methods"), (["show", "pendulun"], "pendulum"),
            (["run", "kepler.toml", "--forse"], "--force"), (["verify", "verlett"], "verlet"),
            (["convert", "kepler.toml", "--to", "polr"], "polar"), (["new", "pendulun"], "pendulum"),
            (["sweep", "kepler.toml", "--vary", "problem.mass=1:2:2", "--lanes", "generik"], "generic"),
            (["sweep", "kepler.toml", "--vary", "problem.mass=1:2:2", "--out", "none", "--figure", "a.svg", "--colour",
              "energy/max_eror"], "energy/max_error"),
            (["plot", "kepler.run", "--kind", "enrgy", "-o", "a.svg"], "energy"),
        ):
            self.assertIn(f"did you mean {meant}?", self.hamflow(*arguments, status=2).stderr, arguments)
        self.assertIn("allowed mp(d) with d", self.refused("run.arithmetic=mp(1)"))

    def test_show_knows_the_keys(self):
        for name, keys in (("taylor", ("order", "tolerance", "step_control")), ("cg", ("quadrature", "on_divergence")),
                           ("run", ("dt", "lattice", "direction")), ("output", ("formats", "figures"))):
            text = self.hamflow("show", name).stdout
            for key in keys:
                self.assertRegex(text, rf"(?m)^ +{key} +\[", name)
        for method in ("cg", "taylor", "dop853"):
            self.assertIn(f"# Options of {method}:", self.hamflow("new", "pendulum", "--all").stdout)


if __name__ == "__main__":
    unittest.main()

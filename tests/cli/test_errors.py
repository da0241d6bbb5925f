"""Bad input: everything wrong is told at once, before anything runs, with file, line, column, key, what was found, what is
allowed and the nearest name; exit 2 for a wrong request, 3 for files."""

import json
import pathlib
import signal
import subprocess
import time
import unittest

from command import ELLIPSE, HAMFLOW, CommandCase, until_it_works


class Errors(CommandCase):
    def complaint(self, *sets, status=2):
        """What a run with these --set says on stderr."""
        arguments = [word for text in sets for word in ("--set", text)]
        done = self.hamflow("run", "kepler.toml", "--out", "none", *arguments, status=status)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_all_errors_at_once_in_the_given_form(self):
        self.write("bad.toml", """[problem]
name = "central-force"
potentail = "kepler"
potential = "kepler"
mass = -2.0
k = "abc"
orbit = { kind = "ellipse", r_per = 3.0, r_aph = 1.0, foo = 1 }
[methd]
[method]
name = "verlt"
[run]
dt = 0
steps = 4.5
t_end = 3
arithmetic = "lattic"
record_every = true
""")
        done = self.hamflow("run", "bad.toml", "--json", status=2)
        lines = done.stderr.splitlines()
        starts = ["bad.toml:3:1: error: problem.potentail: ", "bad.toml:5:8: error: problem.mass: ",
                  "bad.toml:6:5: error: problem.k: ", "bad.toml:7:55: error: problem.orbit.foo: ",
                  "bad.toml:8:2: error: methd: ", "bad.toml:10:8: error: method.name: ", "bad.toml:12:6: error: run.dt: ",
                  "bad.toml:13:9: error: run.steps: ", "bad.toml:14:9: error: run.t_end: ",
                  "bad.toml:15:14: error: run.arithmetic: ", "bad.toml:16:16: error: run.record_every: "]
        self.assertEqual(len(lines), len(starts), done.stderr)
        for line, start in zip(lines, starts):
            self.assertTrue(line.startswith(start), f"{line!r} should start with {start!r}")
            self.assertRegex(line, "found .*; allowed ")
        self.assertTrue(lines[0].endswith("; did you mean potential?"))
        self.assertTrue(lines[5].endswith("; did you mean verlet?"))
        rejection = json.loads(done.stdout)
        self.assertEqual(rejection["status"], "rejected")
        self.assertEqual([f"{e['file']}:{e['line']}:{e['column']}: error: {e['key']}: {e['message']}"
                          for e in rejection["errors"]], lines)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["bad.toml", "kepler.toml"])

    def test_numbers(self):
        for value in ("0", "nan", "inf", "-inf", '"abc"', "true", "[1]", "1979-05-27"):
            self.assertIn("run.dt", self.complaint(f"run.dt={value}"))
        self.assertIn("positive", self.complaint("problem.mass=-1"))
        self.assertIn("positive", self.complaint("problem.mass=0"))
        self.assertIn("allowed an array of 2 numbers", self.complaint("problem.initial={q=[1],p=[0,1]}"))
        self.assertIn("did you mean central-force?", self.complaint("problem.name=centralforce"))

    def test_geometry_says_which_inequality_fails_and_by_how_much(self):
        text = self.complaint("problem.orbit.r_per=4")
        self.assertIn("allowed r_per <= r_aph, but 4 > 3, exceeded by 1", text)
        text = self.complaint('problem.orbit={kind="hyperbola",r_per=2,angular_momentum=1}')
        self.assertIn("sqrt(2 mass k r_per) < angular_momentum", text)
        self.assertIn("0 < k", self.complaint("problem.k=-1"))
        self.assertIn("0 < r0", self.complaint('problem.orbit={kind="circle",r0=-1}'))

    def test_keys_of_other_choices_of_the_problem(self):
        self.assertIn('problem.lambda: found 3; allowed with potential = "', self.complaint("problem.lambda=3"))
        self.assertIn('problem.n: found 2; allowed with potential = "power"', self.complaint("problem.n=2"))
        self.assertIn('problem.V: found "-k/r" (a string); allowed with potential = "formula"', self.complaint("problem.V=-k/r"))
        pair = {"problem": '{ name = "gas", particles_per_side = 3, softening = 0.1 }', "method": '{ name = "stv4" }'}
        self.assertIn('problem.softening: found 0.1; allowed with pair = "newton"',
                      self.complaint(*(f"{key}={value}" for key, value in pair.items())))
        rod = '{ name = "pendulum", dimension = 3, initial = { q = [1], p = [0] } }'
        self.assertIn('allowed with coordinates = "cartesian"', self.complaint("problem=" + rod))
        # What goes with no other choice is unknown.
        self.assertIn("problem.omega: found an unknown key", self.complaint("problem.omega=2"))

    def test_the_name_of_the_problem_in_capitals(self):
        self.write("kepler.toml", ELLIPSE.replace('name = "central-force"', 'Name = "central-force"'))
        lines = self.complaint("run.steps=3").splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertIn("problem.name: missing", lines[0])
        self.assertTrue(lines[1].startswith("kepler.toml:3:"), lines[1])
        self.assertIn("problem.Name: found an unknown key; ", lines[1])
        self.assertTrue(lines[1].endswith("; did you mean name?"), lines[1])

    def test_exactly_the_keys_of_a_start(self):
        self.assertIn("unknown key", self.complaint('problem.orbit={kind="circle",r0=1,r_per=1}'))
        self.assertIn("missing", self.complaint('problem.orbit={kind="circle"}'))
        self.assertIn("allowed circle, ellipse, parabola, hyperbola", self.complaint('problem.orbit={kind="line",r_per=1}'))

    def test_starts_that_cannot_be(self):
        self.assertIn("not finite", self.complaint("problem.initial={q=[0,0],p=[0,1]}"))
        self.assertIn("p and v together", self.complaint("problem.initial={q=[1,0],p=[0,1],v=[0,1]}"))
        self.assertIn("neither p nor v", self.complaint("problem.initial={q=[1,0]}"))
        self.write("pendulum.toml", '[problem]\nname="pendulum"\n[method]\nname="verlet"\n[run]\ndt=0.1\nsteps=1\n')
        self.assertIn("initial", self.hamflow("run", "pendulum.toml", status=2).stderr)

    def test_steps_and_t_end(self):
        self.assertIn("together", self.complaint("run.t_end=3", "run.steps=30"))
        self.write("time.toml", '[problem]\nname="pendulum"\ninitial={q=[1],p=[0]}\n[method]\nname="verlet"\n[run]\ndt=0.1\nt_end=3.05\n')
        text = self.hamflow("run", "time.toml", status=2).stderr
        self.assertIn("nearest dt = ", text)
        self.assertIn("t_end = ", text)
        self.hamflow("run", "time.toml", "--set", "run.t_end=-3", status=2)
        self.hamflow("run", "time.toml", "--set", "run.t_end=3", "--out", "none")

    def test_methods_and_arithmetic(self):
        self.assertIn("bijection", self.complaint("run.arithmetic=lattice"))
        self.assertIn("power of two", self.complaint("method={name='stv4'}", "run.arithmetic=lattice",
                                                     "run.lattice={position=0.3}"))
        self.assertIn("2^62", self.complaint("method={name='stv4'}", "run.arithmetic=lattice",
                                             "run.lattice={position='2^-70'}"))
        self.assertIn("unknown key", self.complaint("method={name='stv4',quadrature=3}"))
        self.assertIn('or "auto"', self.complaint("method.quadrature=0"))
        self.assertIn("run.kernel: this key no longer exists; delete this key", self.complaint("run.kernel=fast"))
        self.assertIn("degree of freedom", self.complaint(
            "problem={name='pendulum',initial={q=[1],p=[0]}}", "output.figures=['orbit']"))

    def test_syntax(self):
        self.write("syntax.toml", "[problem\nname = 1\n")
        text = self.hamflow("run", "syntax.toml", status=2).stderr
        self.assertTrue(text.startswith("syntax.toml:1:9: error: syntax: "), text)
        for line, hint in {"dt = 2*pi/100": 'formulas in quotes, "2*pi/100"', "dt = .1": "numbers such as 0.5",
                           "name = pendulum": "a text in quotes", "section = { value = 0,\n direction = 1 }": "on one line"}.items():
            self.write("syntax.toml", f"[run]\n{line}\n")
            self.assertIn(hint, self.hamflow("run", "syntax.toml", status=2).stderr)
        self.write("empty.toml", "")
        text = self.hamflow("run", "empty.toml", status=2).stderr
        for key in ("problem.name", "method.name", "run.dt", "run.steps"):
            self.assertIn(f"empty.toml:1:1: error: {key}: missing", text)

    def test_files(self):
        self.assertIn("nowhere.toml: No such file", self.hamflow("run", "nowhere.toml", status=3).stderr)
        self.assertIn("found a folder", self.hamflow("run", str(self.folder), status=3).stderr)
        self.hamflow("run", "kepler.toml", "--out", "/proc/nowhere/x", status=3)
        self.hamflow("run", "kepler.toml")
        text = self.hamflow("run", "kepler.toml", status=3).stderr
        self.assertIn("--force", text)
        self.hamflow("run", "kepler.toml", "--force")
        self.write("a_file", "")
        self.hamflow("run", "kepler.toml", "--out", "a_file", "--force", status=3)
        self.hamflow("run", "kepler.toml", "--out", "a_file/below", status=3)
        pathlib.Path(self.folder / "kepler.run" / "notes.txt").write_text("mine")
        self.hamflow("run", "kepler.toml", "--force")
        self.assertTrue((self.folder / "kepler.run" / "notes.txt").exists())

    def test_what_a_beginner_meant(self):
        for given, meant in {"problem.name=keplr": 'central-force with potential = "kepler"', "problem.name=pendulm": "pendulum",
                             "problem.potential=newton": "kepler", "method.name=leapfrog": "verlet", "method.name=yoshida4": "stv4",
                             "run.arithmetic=quadruple": "quad", "run.arithmetic=mp50": "mp(50)", "run.arithmetic=dd": "double-double",
                             "quadrature=4": "method.quadrature", "dt=0.1": "run.dt", "method.dt=0.1": "run.dt", "mass=2": "problem.mass",
                             "method=verlet": "method.name", "run.h=0.1": "dt", "run.dt='0,1'": "0.1"}.items():
            first = self.complaint(given).splitlines()[0]
            self.assertTrue(first.endswith(f"; did you mean {meant}?"), f"{given}: {first}")
        self.assertEqual(len(self.complaint("problem.name=kepler").splitlines()), 1, "of another problem nothing is demanded")
        for command, meant in {("show", "kepler"): 'central-force with potential = "kepler"', ("show", "quad"): 'run.arithmetic = "quad"',
                               ("show", "lyapunov"): "run.lyapunov", ("show", "methods"): "hamflow list methods",
                               ("new", "keplr"): 'central-force with potential = "kepler"', ("verify", "leapfrog"): "verlet",
                               ("kepler.toml",): "run kepler.toml", ("help",): "--help", ("--versoin",): "--version",
                               ("run", "kepler.toml", "--steps", "3"): "--set run.steps=...", ("run", "kepler.toml", "-o", "x"): "--out",
                               ("run", "kepler.toml", "--method=rk4"): "--set method.name=..."}.items():
            self.assertIn(f"did you mean {meant}?", self.hamflow(*command, status=2).stderr)
        self.assertTrue(self.hamflow(status=2).stderr.startswith("error: found no command; allowed run, plot, "))
        text = self.hamflow("compare", "kepler.toml", "--methods", "leapfrog", status=2).stderr
        self.assertTrue(text.startswith("--methods: error: "), text)

    def test_command_line(self):
        self.hamflow(status=2)
        self.assertIn("did you mean run?", self.hamflow("runn", status=2).stderr)
        self.hamflow("run", status=2)
        self.hamflow("run", "kepler.toml", "--nonsense", status=2)
        self.assertIn("did you mean stv4", self.hamflow("show", "stv44", status=2).stderr)
        self.hamflow("list", "planets", status=2)
        self.hamflow("verify", status=2)
        self.hamflow("verify", "nonsense", status=2)
        self.assertIn("PATH=VALUE", self.complaint("nonsense"))
        for command in ([], ["run"], ["plot"], ["list"], ["show"], ["verify"]):
            self.assertIn("Examples:", self.hamflow(*command, "--help").stdout)

    def test_an_option_without_a_value_takes_no_other_for_it(self):
        # A run was kept in a folder called --json.
        for words in (["run", "kepler.toml", "--out=", "--json"], ["run", "kepler.toml", "--out", "--json"],
                      ["run", "kepler.toml", "--out", "", "--json"], ["compare", "kepler.toml", "--methods=", "--json"],
                      ["sweep", "kepler.toml", "--vary", "--json"], ["run", "kepler.toml", "--set", "--json"]):
            done = self.hamflow(*words, status=2)
            (error,) = json.loads(done.stdout)["errors"]
            self.assertTrue(words[2].startswith(error["key"]), error)
            self.assertTrue(error["message"].startswith("found "), error)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["kepler.toml"])
        # A negative number is none of them.
        self.hamflow("convert", "--from", "cartesian", "--to", "polar", "--q", "-1,0", "--p", "-1,0")

    def test_every_command_tells_the_parts_of_an_error(self):
        self.write("bad.toml", ELLIPSE.replace("mass", "mas"))
        for words in (["run"], ["reverse"], ["compare", "--methods", "stv4"], ["sweep", "--vary", "run.dt=0.1,0.2"],
                      ["shell"], ["convert", "--to", "polar"]):
            done = self.hamflow(words[0], "bad.toml", "--json", *words[1:], status=2)
            (error,) = json.loads(done.stdout)["errors"]
            self.assertEqual((error["file"], error["line"], error["column"], error["key"]), ("bad.toml", 6, 1, "problem.mas"), words)
            self.assertIn(error["message"], done.stderr)
        self.write("good.toml", ELLIPSE)
        for words in (["run"], ["reverse"], ["compare", "--methods", "stv4"], ["sweep", "--vary", "run.dt=0.1,0.2"]):
            done = self.hamflow(words[0], "good.toml", "--json", "--set", "run.dtt=1", *words[1:], status=2)
            (error,) = json.loads(done.stdout)["errors"]
            self.assertEqual((error["file"], error["line"], error["key"]), ("--set", 0, "run.dtt"), words)
        for vary, key in (("run.dz=1,2", "run.dz"), ("run.dt=1:2", "--vary"), ("run.dt=0.1,0", "run.dt")):
            done = self.hamflow("sweep", "kepler.toml", "--vary", vary, "--json", "--out", "none", status=2)
            self.assertEqual({e["key"] for e in json.loads(done.stdout)["errors"]}, {key}, done.stdout)

    def test_numbers_beyond_those_that_count(self):
        for key in ("run.steps", "run.threads", "run.lyapunov"):
            found = self.complaint(f"{key}=9223372036854775808")
            self.assertIn("found 9223372036854775808 (beyond 64 bits); allowed", found)
        # As many steps as a double counts: set up at once, and stopped in the midst of it.
        done = subprocess.Popen([HAMFLOW, "run", "kepler.toml", "--json", "--out", "many", "--set", "run.steps=9007199254740000"],
                                cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        until_it_works(done)
        done.send_signal(signal.SIGINT)
        self.assertEqual(json.loads(done.communicate(timeout=60)[0])["status"], "interrupted")

    def test_a_closed_form_that_rounding_hides_is_no_failure(self):
        """In 0.1 of time the orbit goes round 1e148 times."""
        self.write("strong.toml", ELLIPSE)
        done = self.hamflow("run", "strong.toml", "--json", "--out", "none", "--set", "problem.k=1e300", "--set", "run.steps=5",
                            status=1)
        error = json.loads(done.stdout)["error"]
        self.assertIn("step", error)
        self.assertNotIn("boost", done.stdout + done.stderr)
        # Where rounding hides the phase nothing is said of the exact state, and a comparison has no reference.
        done = self.hamflow("run", "strong.toml", "--json", "--out", "none", "--set", "run.dt=1e25", "--set", "run.steps=1",
                            "--set", "problem.orbit.r_aph=3e8", "--set", "problem.orbit.r_per=2.9e8", "--set", "problem.k=1e8")
        self.assertNotIn("exact", json.loads(done.stdout))

    def test_verify_takes_methods_or_all_of_them(self):
        self.assertIn("allowed one of them", self.hamflow("verify", "stv4", "--all", status=2).stderr)
        self.hamflow("verify", status=2)

    def test_what_stands_behind_a_parenthesis(self):
        self.assertIn("with 'x' after its closing parenthesis", self.hamflow("verify", "cg(2)x", status=2).stderr)
        for told in (self.hamflow("verify", "cg(2", status=2).stderr,
                     self.hamflow("run", "kepler.toml", "--set", "method.name=cg(2", status=2).stderr):
            self.assertIn("found 'cg(2' without a closing parenthesis; allowed cg(2)", told)

    def test_a_key_of_another_table_is_proposed_where_the_problem_and_the_method_have_it(self):
        self.write("typed.toml", '[problem]\nname = "formula"\ncoordinates = ["x"]\nmomenta = ["p"]\n'
                   'hamiltonian = "p^2/2 - a*cos(x)"\nparameters = { a = 2 }\ninitial = { q = [1], p = [0] }\n'
                   '[method]\nname = "cg"\n[run]\ndt = 0.1\nsteps = 1\n')

        def told(*settings, scenario="typed.toml"):
            sets = [word for setting in settings for word in ("--set", setting)]
            return self.hamflow("run", scenario, *sets, "--out", "none", status=2).stderr

        self.assertNotIn("did you mean", told("method.omega=20"))
        self.assertIn("did you mean problem.parameters.a?", told("method.a=20"))
        self.assertIn("did you mean problem.k?", told("method.k=20", scenario="kepler.toml"))
        self.assertIn("did you mean method.quadrature?", told("run.quadrature=3"))
        self.assertNotIn("did you mean", told("run.quadrature=3", "method.name=verlet"))
        self.assertIn("did you mean halve?", told("method.on_divergence=half"))

    def test_what_no_thread_means_is_told(self):
        self.assertRegex(self.hamflow("sweep", "--help").stdout, r"--threads N +number of threads, 0: all cores")

    def test_unknown_names_are_answered_by_those_that_are_known(self):
        for words, allowed in ((["verify", "stv4", "--problem", "foo"], "allowed double-pendulum, duffing"),
                               (["verify", "stv5"], "allowed verlet, stv4, kahan-li8"),
                               (["compare", "kepler.toml", "--methods", "leapfrog"], "allowed verlet, stv4, kahan-li8"),
                               (["new", "foo"], "allowed double-pendulum, duffing")):
            self.assertIn(allowed, self.hamflow(*words, status=2).stderr)


    def test_observables_of_a_problem_without_a_start(self):
        self.write("nb.toml", '[problem]\nname = "n-body"\n[method]\nname = "verlet"\n[run]\ndt = 0.01\nsteps = 10\n'
                              '[output]\nobservables = { a = "x1" }\n')
        for command in (["run"], ["reverse"], ["compare", "--methods", "verlet"], ["sweep", "--vary", "run.dt=1,2"]):
            said = self.hamflow(command[0], "nb.toml", *command[1:], status=2).stderr
            self.assertIn("problem.masses: missing", said)
            self.assertIn("problem.initial: missing", said)


    def test_messages_of_json_begin_with_what_was_found(self):
        """In every command alike: the key is the option or the key, the message has neither."""
        for words, key in (
            (["verify", "stv5"], "METHOD"),
            (["verify", "stv4", "--problem", "foo"], "--problem"),
            (["compare", "kepler.toml", "--methods", "verlte"], "--methods"),
            (["compare", "kepler.toml", "--methods", "stv4", "--set", "run.steps=0"], "run.steps"),
            (["compare", "kepler.toml", "--methods", "stv4", "--dt", "0"], "--dt"),
            (["run", "kepler.toml", "--set", "run.dt=0"], "run.dt"),
            (["run", "kepler.toml", "--bla"], "--bla"),
            (["list", "foo"], "what"),
            (["sweep", "kepler.toml", "--vary", "run.dz=1,2"], "run.dz"),
            (["sweep", "kepler.toml", "--vary", "run.dt=0.1,0.2", "--mean"], "--mean"),
            (["convert", "--from", "cartesian", "--to", "polar", "--q", "1", "--p", "1,x"], "--p"),
        ):
            done = self.hamflow(*words, "--json", status=2)
            (error,) = json.loads(done.stdout)["errors"]
            self.assertEqual(error["key"], key, words)
            self.assertTrue(error["message"].startswith("found "), error)
            self.assertIn(error["message"], done.stderr)

if __name__ == "__main__":
    unittest.main()

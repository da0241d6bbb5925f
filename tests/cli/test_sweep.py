"""hamflow sweep: every row has the bits of the run of that member alone, whatever the lanes and threads."""

import csv
import json
import os
import signal
import subprocess
import time
import unittest

import h5py

from command import HAMFLOW, CommandCase, until_it_works

KEPLER = """
[problem]
name = "central-force"
potential = "kepler"
k = 1.0
mass = 2.0
initial = { q = [1.0, 0.0], p = [0.0, 1.5] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 333
"""


def scenario(problem, q, p, method="stv4", dt=0.05, steps=333):
    return f"""
[problem]
{problem}
initial = {{ q = {q}, p = {p} }}
[method]
name = "{method}"
[run]
dt = {dt}
steps = {steps}
"""


class OptionsOfMethods(CommandCase):
    def test_members_in_lanes_have_their_own(self):
        self.write("t.toml", """
[problem]
name = "formula"
coordinates = ["q"]
hamiltonian = "(q^2 + 1)*(p^2 + 1)/2"
initial = { q = [-3], p = [0] }
[method]
name = "tao4"
[run]
dt = 0.02
steps = 100
""")
        found = {}
        for lanes in ["none", "generic", "auto"]:
            done = self.hamflow("sweep", "t.toml", "--vary", "method.omega=5,20,40", "--lanes", lanes, "--out", "none", "--json", "--quiet")
            found[lanes] = [row["final"] for row in json.loads(done.stdout)["rows"]]
        self.assertEqual(len({row["q"][0] for row in found["none"]}), 3)
        self.assertEqual(found["none"], found["generic"])
        self.assertEqual(found["none"], found["auto"])


class NotesOfRows(CommandCase):
    def test_a_row_says_of_events_and_sections_what_the_run_says(self):
        self.write("o.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + x^2/2"
initial = { q = [2], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 100
section = { expression = "1/x", direction = 0 }
""")
        events = 'run.events=[{name="pole",expression="1/x"}]'
        for sets in ([], ["--set", events]):  # in lanes, and one by one
            rows = json.loads(self.hamflow("sweep", "o.toml", *sets, "--vary", "problem.initial.q[0]=1,2", "--out", "none",
                                           "--json", "--quiet").stdout)["rows"]
            for row, q in zip(rows, (1, 2)):
                single = self.summary("o.toml", *sets, "--set", f"problem.initial.q[0]={q}")
                self.assertIn("were not zeros", single["section"]["message"])
                self.assertEqual(row["section"], single["section"])
                self.assertEqual(row.get("event_notes"), single.get("event_notes"))
        self.assertIn("not a zero", rows[0]["event_notes"][0])

    def test_what_ended_a_member_has_the_digits_of_its_run(self):
        self.write("o.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 + x^2/2"
initial = { q = [2], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 100
arithmetic = "quad"
section = { coordinate = "x", value = 0.5 }
events = [{ name = "half", expression = "x + 0.5", direction = 1, action = "stop" }]
""")
        self.hamflow("sweep", "o.toml", "--vary", "problem.initial.q[0]=1,2", "--set", 'output.formats=["h5","csv"]', "--quiet")
        rows = json.loads(self.hamflow("sweep", "o.toml", "--vary", "problem.initial.q[0]=1,2", "--out", "none", "--json",
                                       "--quiet").stdout)["rows"]
        for row, q in zip(rows, (1, 2)):
            single = self.summary("o.toml", "--set", f"problem.initial.q[0]={q}")
            self.assertIsInstance(row["stopped_by"]["t"], str)
            self.assertEqual(row["stopped_by"], single["stopped_by"])
            self.assertLess(row["section"]["max_residual"], 1e-32)
        table = list(csv.DictReader((self.folder / "o.sweep/sweep.csv").open()))
        self.assertEqual([row["stopped_by/t"] for row in table], [row["stopped_by"]["t"] for row in rows])


class Sweep(CommandCase):
    def sweep(self, *arguments, status=0):
        done = self.hamflow("sweep", *arguments, "--out", "none", "--json", "--quiet", status=status)
        return json.loads(done.stdout)

    def single(self, file, *sets):
        arguments = [word for one in sets for word in ("--set", one)]
        done = subprocess.run(
            [HAMFLOW, "run", file, *arguments, "--out", "none", "--json", "--quiet"],
            cwd=self.folder, capture_output=True, text=True, timeout=120)
        return json.loads(done.stdout)

    def assert_same(self, row, run):
        """All numbers, as JSON writes them: 17 digits, hence every bit."""
        self.assertEqual(row["status"], run["status"] if run["status"] == "done" else run["error"]["kind"])
        self.assertEqual(row["steps"], run["steps"])
        self.assertEqual(row["final"], run["final"])
        for key in ("initial", "final", "max_error", "scale"):
            self.assertEqual(row["energy"][key], run["energy"][key], key)
        self.assertEqual(row["invariants"], run["invariants"])

    def check(self, file, vary, *more, members=(0, 3, 16, -1), lanes=True):
        """A sweep over one key in every kind of lanes, some of its rows against single runs."""
        path = vary.split("=")[0]
        kinds = ["auto", "generic", "none"]
        sweeps = [self.sweep(file, "--vary", vary, *more, "--lanes", kind) for kind in kinds]
        self.assertEqual(sweeps[0]["members_in_lanes"], sweeps[0]["members"] if lanes else 0)
        self.assertEqual(sweeps[2]["members_in_lanes"], 0)
        for other in sweeps[1:]:
            self.assertEqual(sweeps[0]["rows"], other["rows"])
        rows = sweeps[0]["rows"]
        sets = [more[i + 1] for i in range(0, len(more), 2)]
        for member in members:
            row = rows[member]
            self.assert_same(row, self.single(file, *sets, f"{path}={row[path]!r}"))
        return rows

    def test_methods(self):
        self.write("k.toml", KEPLER)
        for method in ("verlet", "verlet-dkd", "stv4", "yoshida6", "yoshida6-dkd", "euler-a", "euler-b", "suzuki4"):
            rows = self.check("k.toml", "problem.initial.p[1]=1:1.9:21", "--set", f"method.name={method}",
                              members=(0, 20))
            self.assertGreater(len({row["final"]["q"][0] for row in rows}), 20)

    def test_parameters_start_and_step(self):
        self.write("k.toml", KEPLER)
        for vary in ("problem.k=0.5:1.5:18", "problem.mass=1:3:18", "run.dt=0.01:0.1:18", "run.dt=-0.02,0.02,0.04,0.08",
                     "problem.initial.q[0]=0.8:1.2:18", "problem.initial.q[1]=-0.3:0.3:18"):
            self.check("k.toml", vary, members=(0, 2, -1))

    def test_geometric_start(self):
        self.write("o.toml", KEPLER.replace("initial = { q = [1.0, 0.0], p = [0.0, 1.5] }",
                                            'orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }'))
        self.check("o.toml", "problem.orbit.r_aph=1.5:4:17")
        # k follows from the orbit, member by member.
        self.write("h.toml", """
[problem]
name = "central-force"
potential = "hooke"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 2.0, energy = 1.0 }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 200
""")
        self.check("h.toml", "problem.orbit.energy=0.5:2:17")

    def test_problems(self):
        cases = [
            ('name = "central-force"\npotential = "linear"\nk = 1.0', "[1.0, 0.0]", "[0.0, 1.0]", "problem.k"),
            ('name = "central-force"\npotential = "binomial"\nk = 1.0\nlambda = 1.0', "[1.0, 0.2]", "[0.3, 1.0]",
             "problem.k"),
            ('name = "henon-heiles"', "[0.1, 0.1]", "[0.2, 0.3]", "problem.lambda"),
            ('name = "pendulum"', "[1.0]", "[0.5]", "problem.length"),
            ('name = "harmonic"', "[1.0]", "[0.5]", "problem.omega"),
            ('name = "free-fall"', "[1.0]", "[0.5]", "problem.gravity"),
            ('name = "duffing"\nalpha = -1.0\nbeta = 1.0', "[1.0]", "[0.5]", "problem.beta"),
            ('name = "sextic"', "[0.5]", "[0.5]", "problem.initial.p[0]"),
            ('name = "lennard-jones-oscillator"', "[1.5]", "[0.0]", "problem.initial.q[0]"),
        ]
        for problem, q, p, path in cases:
            self.write("c.toml", scenario(problem, q, p, dt=0.01))
            self.check("c.toml", f"{path}=0.9:1.1:17", members=(0, -1))

    def test_without_lanes(self):
        self.write("k.toml", KEPLER)
        for sets in (["method.name=dop853"], ["method.name=cg"], ["run.arithmetic=lattice"]):
            more = [word for one in sets for word in ("--set", one)]
            self.check("k.toml", "problem.k=0.9:1.1:5", *more, members=(0, 4), lanes=False)
        self.write("p.toml", scenario('name = "central-force"\npotential = "power"\na = [1.0]\nn = [1.0]',
                                      "[1.0, 0.0]", "[0.0, 1.0]"))
        self.check("p.toml", "problem.a[0]=0.9:1.1:3", members=(0, 2))  # lists are no hindrance

    def test_steps_that_are_solved_for(self):
        """Members that take steps together by Newton, H not separable; more Gauss points where the motion is wilder."""
        self.write("d.toml", scenario('name = "double-pendulum"', "[0.4, -0.3]", "[0.5, 0.2]", dt=0.04))
        for method in ("cg(2,auto)", "gauss(3)"):
            self.check("d.toml", "problem.initial.q[0]=0.1:2.9:19", "--set", f"method.name={method}",
                       "--set", "run.steps=150", members=(0, 7, -1))

    def test_a_kink_that_no_point_has_seen(self):
        """Two rules of points agree where the kink of |x| lies beyond the last of them: H tells, in lanes too."""
        self.write("k.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2*(1 + 0.1*x^2) + x^2/2 + 1e-7*abs(x)"
initial = { q = [1], p = [0.3] }
[method]
name = "cg(2,auto)"
[run]
dt = 0.01
steps = 700
""")
        found = []
        for lanes in ("none", "auto"):
            done = self.hamflow("sweep", "k.toml", "--vary", "problem.initial.q[0]=0.1:2:160", "--lanes", lanes,
                                "--out", "none", "--json", "--quiet", status=1)
            sweep = json.loads(done.stdout)
            found.append([sweep["failed"], sweep["rows"], sweep["failures"]])
        self.assertEqual(found[0], found[1])
        self.assertEqual(found[0][0], 160)

    def test_arithmetic_and_time(self):
        """Compensated sums, and an H that depends on t: lanes like any other."""
        self.write("k.toml", KEPLER)
        self.check("k.toml", "problem.k=0.9:1.1:18", "--set", "run.arithmetic=compensated")
        self.write("t.toml", """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y + f*x*cos(w*t)"
parameters = { f = 0.1, w = 1.5 }
initial = { q = [0.1, 0.2], p = [0.3, -0.1] }
[method]
name = "stv4"
[run]
dt = 0.05
steps = 333
""")
        for method in ("stv4", "rk4"):
            for more in ((), ("--set", "run.arithmetic=compensated")):
                self.check("t.toml", "problem.parameters.w=1:2:18", "--set", f"method.name={method}", *more)

    def test_more_digits(self):
        """Rows, files and CSV have the digits of the single runs; nothing is rounded to double on the way."""
        self.write("k.toml", KEPLER + '[output]\nformats = ["h5", "csv"]\n')
        for arithmetic in ("double-double", "quad", "mp(40)"):
            more = ["--set", f"run.arithmetic={arithmetic}", "--set", "run.steps=20"]
            sweep = self.sweep("k.toml", "--vary", "problem.k=0.9,'1/3'", *more)
            self.assertEqual((sweep["arithmetic"], sweep["members_in_lanes"]), (arithmetic, 0))
            self.assertIn("lanes need double arithmetic", sweep["note"])
            runs = [self.single("k.toml", f"problem.k={k}", *more[1::2]) for k in ("0.9", "'1/3'")]
            self.assertEqual([row["problem.k"] for row in sweep["rows"]], [0.9, "1/3"])
            for row, run in zip(sweep["rows"], runs):
                self.assertIsInstance(row["final"]["q"][0], str)
                self.assert_same(row, run)
            self.hamflow("sweep", "k.toml", "--vary", "problem.k=0.9,'1/3'", *more, "--out", "out", "--force")
            table = list(csv.DictReader((self.folder / "out" / "sweep.csv").read_text().splitlines()))
            self.assertEqual([float(line["problem.k"]) for line in table], [0.9, 1 / 3])
            for line, run in zip(table, runs):
                self.assertEqual([line["final/t"], line["final/q1"], line["final/p2"], line["energy/initial"]],
                                 [run["final"]["t"], run["final"]["q"][0], run["final"]["p"][1], run["energy"]["initial"]])
            with h5py.File(self.folder / "out" / "sweep.h5") as file:
                self.assertEqual(file["digits/varied/problem.k"].asstr()[...].tolist(), ["0.9", "1/3"])
                for name, values in (("final/q", [run["final"]["q"] for run in runs]),
                                     ("final/p", [run["final"]["p"] for run in runs]),
                                     ("final/t", [run["final"]["t"] for run in runs]),
                                     ("energy/initial", [run["energy"]["initial"] for run in runs]),
                                     ("energy/final", [run["energy"]["final"] for run in runs])):
                    texts = file["digits/" + name].asstr()[...].tolist()
                    self.assertEqual(texts, values, name)
                    # The doubles beside them are the same numbers, rounded.
                    self.assertEqual(file[name][...].tolist(),
                                     [[float(x) for x in v] if isinstance(v, list) else float(v) for v in values])

    def test_digits_beside_doubles(self):
        self.write("k.toml", KEPLER + '[output]\nformats = ["csv"]\n')
        self.hamflow("sweep", "k.toml", "--vary", "run.arithmetic=double,quad", "--set", "run.steps=5", "--out", "out")
        table = list(csv.DictReader((self.folder / "out" / "sweep.csv").read_text().splitlines()))
        runs = [self.single("k.toml", f"run.arithmetic={a}", "run.steps=5") for a in ("double", "quad")]
        self.assertEqual(float(table[0]["final/q1"]), runs[0]["final"]["q"][0])
        self.assertEqual(table[1]["final/q1"], runs[1]["final"]["q"][0])

    def test_product_in_order_and_methods_mixed(self):
        self.write("k.toml", KEPLER)
        sweep = self.sweep("k.toml", "--vary", "method.name=verlet,cg,stv4", "--vary", "run.steps=10,20",
                           "--vary", "problem.k=1:1.2:3")
        self.assertEqual((sweep["members"], sweep["members_in_lanes"]), (18, 12))
        keys = [(row["method.name"], row["run.steps"], row["problem.k"]) for row in sweep["rows"]]
        self.assertEqual(keys, [(m, s, k) for m in ("verlet", "cg", "stv4") for s in (10, 20) for k in (1, 1.1, 1.2)])
        for row in sweep["rows"]:
            self.assert_same(row, self.single("k.toml", f"method.name={row['method.name']}",
                                              f"run.steps={int(row['run.steps'])}", f"problem.k={row['problem.k']!r}"))

    def test_members_that_fail(self):
        # Below the saddle bounded, above it the particle escapes to infinity in finite time.
        self.write("hh.toml", scenario('name = "henon-heiles"', "[0.0, 0.0]", "[0.0, 0.1]", dt=0.1, steps=500))
        rows = self.check("hh.toml", "problem.initial.p[1]=0.1:2:20", members=range(20))
        self.assertEqual({row["status"] for row in rows}, {"done", "non_finite"})
        done = self.hamflow("sweep", "hh.toml", "--vary", "problem.initial.p[1]=0.1:2:20", "--out", "none")
        self.assertIn("note: member", done.stderr)
        every = self.hamflow("sweep", "hh.toml", "--vary", "problem.initial.p[1]=1.8,1.9", "--out", "none", status=1)
        self.assertIn("error: member 0, step", every.stderr)

    def test_members_without_a_step_show_what_their_runs_show(self):
        self.write("still.toml", "[problem]\nname='pendulum'\ninitial={q=[0.5],p=[0.1]}\n[method]\nname='gauss(2)'\n[run]\n"
                   "dt=0.05\nsteps=3\nlyapunov=true\neigenvalues=true\n[output]\nobservables={o='q^2'}\n")
        for key, value, status in (("run.steps", 0, "done"), ("method.max_iterations", 1, "not_converged")):
            one = ("--set", f"{key}={value}", "--set", "method.tolerance=1e-300")
            own = self.summary("still.toml", *one, status=0 if status == "done" else 1)
            self.assertEqual(own["observables"]["o"], {"initial": 0.25, "mean": 0.25, "final": 0.25})
            for lanes in ("none", "auto"):
                done = self.hamflow("sweep", "still.toml", *one, "--vary", "problem.gravity=1,2", "--lanes", lanes, "--out",
                                    "none", "--json", status=0 if status == "done" else 1)
                for row in json.loads(done.stdout)["rows"]:
                    self.assertEqual((row["status"], row["steps"]), (status, 0))
                    self.assertEqual([row["o_" + what] for what in ("initial", "mean", "final")], 3 * [0.25])
                    self.assertEqual(row["observables"], own["observables"])
                    self.assertEqual(row["eigenvalues_norm"], own["eigenvalues"]["norm"])
                    self.assertEqual([row["lyapunov1"], row["lyapunov2"]], own["lyapunov"]["exponents"])

    def test_rows_have_the_observables_of_single_runs(self):
        for name, more, q, p in (("fput", "n = 4", "[1, 0, 0, 0.02]", "[1, 0, 0, 1]"), ("sextic", "", "[0.6]", "[0.9]"),
                                 ("magnetic", "", "[1, 0, 0]", "[0.1, 1, 0.2]")):
            x, p_x = {"fput": ("q1", "p1"), "sextic": ("q", "p"), "magnetic": ("x", "p_x")}[name]
            method = "cg" if name == "magnetic" else "verlet"
            for keys in ("", "record_every = 7\n", f"events = [{{ expression = '{x} - 0.3' }}]\nsection = {{ expression = '{p_x}' }}\n"):
                self.write("o.toml", f"[problem]\nname = '{name}'\n{more}\ninitial = {{ q = {q}, p = {p} }}\n[method]\n"
                           f"name = '{method}'\n[run]\ndt = 0.01\nsteps = 300\n{keys}[output]\nobservables = {{ ob = '{x}^2' }}\n")
                own = self.summary("o.toml")
                done = self.hamflow("sweep", "o.toml", "--vary", "run.dt=0.01,0.02", "--out", "none", "--json")
                row = json.loads(done.stdout)["rows"][0]
                with self.subTest(name=name, keys=keys):
                    self.assertEqual(row["observables"], own["observables"])

    def test_every_method_notes_what_it_does_without(self):
        self.write("gauss.toml", "[problem]\nname='pendulum'\ninitial={q=[0.5],p=[0.1]}\n[method]\nname='gauss'\nstages=2\n"
                   "max_iterations=20\n[run]\ndt=0.05\nsteps=3\n")
        told = self.hamflow("sweep", "gauss.toml", "--vary", "method.name=tao2,discrete-gradient,stv4,gauss", "--out", "none").stderr
        notes = [line for line in told.splitlines() if line.startswith("note: method.")]
        self.assertEqual(notes, [f"note: method.{key} of the file is not used: method.name is set to {name}" for key, name in
                                 (("max_iterations", "tao2"), ("stages", "tao2"), ("stages", "discrete-gradient"),
                                  ("max_iterations", "stv4"), ("stages", "stv4"))])

    def test_threads_and_files(self):
        self.write("k.toml", KEPLER + '[output]\nformats = ["h5", "csv"]\n')
        texts = set()
        for threads in ("1", "2", "4"):
            self.hamflow("sweep", "k.toml", "--vary", "problem.k=0.5:1.5:101", "--vary", "method.name=stv4,rk4",
                         "--threads", threads, "--out", "out", "--force")
            texts.add((self.folder / "out" / "sweep.csv").read_text())
            self.assertTrue((self.folder / "out" / "sweep.h5").stat().st_size > 0)
            summary = json.loads((self.folder / "out" / "summary.json").read_text())
            self.assertEqual((summary["members"], summary["done"], summary["threads"]), (202, 202, int(threads)))
        self.assertEqual(len(texts), 1)
        table = list(csv.DictReader(texts.pop().splitlines()))
        self.assertEqual(len(table), 202)
        run = self.single("k.toml", "problem.k=1.5", "method.name=rk4")
        self.assertEqual([float(table[-1][name]) for name in ("final/q1", "final/q2", "energy/max_error")],
                         [*run["final"]["q"], run["energy"]["max_error"]])
        self.hamflow("sweep", "k.toml", "--vary", "problem.k=1", "--out", "out", status=3)
        self.hamflow("sweep", "k.toml", "--vary", "problem.k=1")
        self.assertTrue((self.folder / "k.sweep" / "sweep.h5").exists())

    def test_what_belongs_to_single_runs_is_told(self):
        self.write("k.toml", KEPLER + '[output]\nfolder = "mine"\nfigures = ["energy-error"]\n')
        told = self.hamflow("sweep", "k.toml", "--vary", "problem.k=1", "--out", "none").stderr
        self.assertIn("note: output.folder is not used: --out gives the folder of a sweep", told)
        self.assertIn("note: output.figures is not used: --figure draws the figure of a sweep", told)
        for words in (["compare", "k.toml", "--methods", "stv4", "--dt", "0.05"], ["reverse", "k.toml"]):
            self.assertIn("note: output.figures is not used", self.hamflow(*words, "--set", "run.steps=3").stderr, words)

    def test_a_range_of_whole_numbers_has_no_others(self):
        """1 + 22 (15/22) is no whole number in double."""
        self.write("k.toml", KEPLER)
        done = self.hamflow("sweep", "k.toml", "--vary", "run.steps=1:23:23", "--out", "none", "--json", "--quiet")
        self.assertEqual([row["run.steps"] for row in json.loads(done.stdout)["rows"]], list(range(1, 24)))

    def test_errors(self):
        self.write("k.toml", KEPLER)
        cases = {
            "problem.k=1:2": "found 2 parts",
            "problem.k=1:2:0": "found n = 0",
            "problem.k=1:2:1.5": "found n = 1.5",
            "problem.k=1:x:3": 'found "x"',
            "problem.k=": "allowed PATH=a:b:n",
            "problem.k": "allowed PATH=a:b:n",
            "problem.k=1,,2": "empty value",
            "problem.kk=1:2:3": "problem.kk: found an unknown key",
            "problme.k=1:2:3": "did you mean problem?",
            "problem.initial.q[2]=1:2:3": "found index 2 of an array of 2",
            "problem.k[0]=1:2:3": "problem.k is not an array",
            "problem.mass=-1:1:3": "problem.mass",
            "run.steps=1:2:3": "whole number",
            "method.name=stv4,stv5": "did you mean stv4?",
            "problem.k=1:2:9999999999": "found n",
        }
        for vary, message in cases.items():
            done = self.hamflow("sweep", "k.toml", "--vary", vary, "--json", "--out", "none", status=2)
            self.assertIn(message, done.stderr, vary)
            self.assertTrue(done.stderr.startswith("--vary"), done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "rejected")
        self.hamflow("sweep", "k.toml", "--out", "none", status=2)
        self.hamflow("sweep", "k.toml", "--vary", "problem.k=1,2", "--threads", "-1", "--out", "none", status=2)
        twice = self.hamflow("sweep", "k.toml", "--vary", "problem.k=1", "--vary", "problem.k=2", status=2)
        self.assertIn("twice", twice.stderr)
        # The one member of many that cannot be is named; what is wrong for all is told once.
        some = self.hamflow("sweep", "k.toml", "--vary", "problem.mass=1,2,-3", status=2)
        self.assertIn("member 2: problem.mass=-3", some.stderr)
        every = self.hamflow("sweep", "k.toml", "--vary", "problem.mass=1,2,3", "--set", "run.dt=0", status=2)
        self.assertEqual(len(every.stderr.splitlines()), 1)
        self.hamflow("sweep", "missing.toml", "--vary", "problem.k=1", status=3)

    def test_interrupt_saves(self):
        self.write("k.toml", KEPLER.replace("333", "2000000000") + '[output]\nformats = ["csv"]\n')
        process = subprocess.Popen([HAMFLOW, "sweep", "k.toml", "--vary", "problem.k=0.9:1.1:40", "--json"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until_it_works(process, 0.5)
        os.kill(process.pid, signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(json.loads(out)["status"], "interrupted")
        table = list(csv.DictReader((self.folder / "k.sweep" / "sweep.csv").read_text().splitlines()))
        self.assertEqual(len(table), 40)
        begun = [row for row in table if row["member/status"] == "interrupted"]
        self.assertTrue(begun)
        self.assertGreater(int(begun[0]["member/steps"]), 0)

    def test_interrupt_while_measuring(self):
        """Between looks at members in lanes, Ctrl-C is seen; what is not finished has no columns of what is measured."""
        self.write("long.toml", scenario('name = "henon-heiles"', "[0.1, 0.1]", "[0.2, 0.3]", steps=10**9))
        for key, value, column in (("run.lyapunov", "1", "lyapunov1"),
                                   ("output.observables", "{ a = 'exp(sin(q1))*p1' }", "a_mean")):
            process = subprocess.Popen(
                [HAMFLOW, "sweep", "long.toml", "--vary", "problem.initial.q[1]=0:0.1:16", "--set", f"{key}={value}",
                 "--threads", "1", "--out", "none", "--json"],
                cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            until_it_works(process, 0.5)
            os.kill(process.pid, signal.SIGINT)
            out, _ = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)
            found = json.loads(out)
            self.assertEqual((found["status"], found["members_in_lanes"]), ("interrupted", 16))
            self.assertGreater(found["unfinished"], 0)
            self.assertEqual(found["done"] + found["unfinished"], 16)
            for row in found["rows"]:
                self.assertEqual(column in row, row["status"] == "done")

    def test_figure(self):
        self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", "--set", "method.name=stv4",
                     "--vary", "run.dt=0.01:0.1:4", "--vary", "problem.orbit.r_aph=2:3:5", "--out", "none",
                     "--figure", "map.svg")
        self.assertIn("<svg", (self.folder / "map.svg").read_text())
        for column in ("final/q1", "final/p2", "invariants/angular_momentum/final", "varied/run.dt"):
            self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", "--vary", "run.dt=0.01:0.1:4", "--out", "none",
                         "--quiet", "--figure", "column.svg", "--colour", column)
        # The end of a name is enough where it is the end of one column alone.
        for name in ("varied/run.dt", "run.dt"):
            self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", "--vary", "run.dt=0.01:0.1:4", "--out", "none",
                         "--quiet", "--figure", name.replace("/", "_") + ".svg", "--colour", name)
        self.assertEqual((self.folder / "run.dt.svg").read_text(), (self.folder / "varied_run.dt.svg").read_text())
        # Means over the second key of a column that is the second key, and of one more.
        self.hamflow("sweep", "kepler.toml", "--set", "run.steps=20", "--vary", "method.name=verlet,stv4",
                     "--vary", "run.dt=0.01:0.1:4", "--out", "none", "--quiet", "--figure", "mean.svg",
                     "--mean", "--colour", "varied/run.dt,energy/max_error")
        self.assertIn("over 4 members", (self.folder / "mean.svg").read_text())
        for options, words in ((("--figure", "mean.svg", "--mean"), "allowed two or more"),
                               (("--mean",), "allowed with --figure FILE"),
                               (("--figure", "mean.svg", "--mean", "--colour", "final/q1,max_error",
                                 "--vary", "problem.orbit.r_aph=2:3:5"), "did you mean energy/max_error?")):
            done = self.hamflow("sweep", "kepler.toml", "--vary", "run.dt=0.01:0.1:4", "--out", "none", *options,
                                status=2)
            self.assertIn(words, done.stderr)
        for options, words in ((("--colour", "energy/least"), "allowed varied/run.dt"),
                               (("--colour", "final/q3"), "did you mean final/q1?"),
                               (("--colour", "max_error"), "did you mean energy/max_error?"),
                               (("--colour", "lyapunov1"), "run.lyapunov = 1 adds observables/lyapunov1"),
                               (("--figure", "map.gif"), "allowed a file .svg")):
            figure = () if "--figure" in options else ("--figure", "map.svg")
            done = self.hamflow("sweep", "kepler.toml", "--vary", "run.dt=0.01:0.1:4", "--out", "none", *figure,
                                *options, status=2)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()

"""Starts of given energy, sweeps whose values follow from each other, sections of all members in one file and figure."""

import csv
import json
import math
import unittest

import h5py

from command import CommandCase

EPSILON = 2.0**-52

HENON = """
[problem]
name = "henon-heiles"
initial = { q = [0, 0.1], p = ["+", 0.1], energy = 0.125 }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 40
"""


def potential(x, y):
    return (x * x + y * y) / 2 + x * x * y - y**3 / 3


class StartOfEnergy(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("hh.toml", HENON)

    def start(self, *sets, problem=None):
        if problem is not None:
            self.write("own.toml", f"[problem]\n{problem}\n[method]\nname = 'rk4'\n[run]\ndt = 0.1\nsteps = 0\n")
        arguments = [word for one in sets for word in ("--set", one)]
        return self.summary("hh.toml" if problem is None else "own.toml", *arguments)

    def refused(self, *sets, file="hh.toml"):
        arguments = [word for one in sets for word in ("--set", one)]
        return self.hamflow("run", file, *arguments, "--out", "none", "--quiet", status=2).stderr

    def test_largest_and_smallest_root(self):
        expected = math.sqrt(2 * (0.125 - potential(0, 0.1)) - 0.01)
        up = self.start("run.steps=0")
        down = self.start("run.steps=0", "problem.initial.p[0]=-")
        self.assertAlmostEqual(up["start"]["p"][0], expected, delta=4 * EPSILON)
        self.assertEqual(down["start"]["p"][0], -up["start"]["p"][0])
        self.assertEqual(up["start"]["p"][1], 0.1)
        for run in (up, down):  # some roundings of numbers below 1/4
            self.assertAlmostEqual(run["energy"]["initial"], 0.125, delta=4 * EPSILON)
        other = self.start("run.steps=0", 'problem.initial.p=[0.2, "-"]')
        self.assertLess(other["start"]["p"][1], 0)
        self.assertAlmostEqual(other["energy"]["initial"], 0.125, delta=4 * EPSILON)

    def test_velocities(self):
        run = self.start(problem='name = "double-pendulum"\n'
                                 'initial = { q = [1, 0.5], v = ["-", 2], energy = 20 }')
        self.assertAlmostEqual(run["energy"]["initial"], 20, delta=64 * EPSILON * 20)
        # v = dH/dp of the start is [-, 2]: of two half-steps of rk4 the first shows dq/dt.
        one = self.start("run.dt=1e-6", "run.steps=1", problem=None)
        self.assertEqual(one["status"], "done")

    def test_every_arithmetic_has_its_digits(self):
        for arithmetic, digits in (("double-double", 30), ("quad", 32), ("mp(60)", 58)):
            run = self.start("run.steps=0", f"run.arithmetic={arithmetic}", 'problem.initial.energy="1/8"')
            from decimal import Decimal, getcontext
            getcontext().prec = 80
            off = abs(Decimal(run["energy"]["initial"]) - Decimal("0.125"))
            self.assertLess(off, Decimal(10) ** -digits, arithmetic)
        for arithmetic in ("compensated", "lattice"):
            run = self.start("run.steps=0", f"run.arithmetic={arithmetic}")
            self.assertAlmostEqual(run["energy"]["initial"], 0.125, delta=8 * EPSILON)

    def test_kinetic_energies_that_are_not_quadratic(self):
        # T = p^3/3 - p/2 has up to three roots; its cubic is known in closed form by what H is there.
        q = 0.5
        v = q**6 / 30 + q**4 / 4 - q**3 / 3 + 1 / 6
        level = v + 0.1  # between the extrema +-sqrt(2)/6 of T
        roots = {}
        for sign in "+-":
            run = self.start(problem=f'name = "sextic"\ninitial = {{ q = [{q}], p = ["{sign}"], energy = {level!r} }}')
            roots[sign] = run["start"]["p"][0]
            self.assertAlmostEqual(run["energy"]["initial"], level, delta=16 * EPSILON)
        self.assertGreater(roots["+"], math.sqrt(0.5))  # beyond the minimum of T
        self.assertLess(roots["-"], -math.sqrt(0.5))

    def test_a_parabola_that_touches(self):
        run = self.start("run.steps=0", 'problem.initial={ q = [0, 0], p = ["+", 0], energy = 0 }')
        self.assertEqual(run["start"]["p"], [0.0, 0.0])

    def test_no_root(self):
        text = self.refused("problem.initial.energy=0.001")
        self.assertIn("problem.initial.energy: found 0.001, but no p[0] has this energy: along p[0] H is at least 0.00966", text)

    def open_formula(self, hamiltonian, energy, sign):
        return ('name = "formula"\ncoordinates = ["q"]\n'
                f'hamiltonian = "{hamiltonian}"\ninitial = {{ q = [0], p = ["{sign}"], energy = {energy} }}')

    def test_roots_where_h_is_singular_or_has_a_dip(self):
        dip = "p^2/2 - 3*exp(-(p - 3)^2*50) + q"
        for hamiltonian, energy, sign, expected in (
            ("1/p + q", 4, "+", 0.25),
            ("1/p + q", 4, "-", 0.25),
            ("log(p) + q", 1, "+", math.e),
            ("(p^2 - 2)^2 + q", 0, "-", -math.sqrt(2)),
            (dip, 2, "-", -2),
        ):
            run = self.start(problem=self.open_formula(hamiltonian, energy, sign))
            p = run["start"]["p"][0]
            # A double root is known to the square root of the rounding.
            within = math.sqrt(64 * EPSILON) if "^2 - 2)" in hamiltonian else 16 * EPSILON * abs(expected)
            self.assertAlmostEqual(p, expected, delta=within, msg=hamiltonian)
        p = self.start(problem=self.open_formula("p^2/2 + 1/p + q", 4, "+"))["start"]["p"][0]
        self.assertAlmostEqual(p**3 / 2 - 4 * p + 1, 0, delta=64 * EPSILON * 4 * p)
        self.assertGreater(p, 2)  # the others are near 0.25 and -2.9
        # Of p^2/2 alone the root is 2; that in the dip lies further out, on the dip's outer flank.
        p = self.start(problem=self.open_formula(dip, 2, "+"))["start"]["p"][0]
        self.assertGreater(p, 3)
        self.assertAlmostEqual(p * p / 2 - 3 * math.exp(-((p - 3) ** 2) * 50), 2, delta=256 * EPSILON * 5)

    def test_no_root_is_the_last(self):
        for hamiltonian, energy in (("cos(p) + q^2", 0.3), ("cos(p) + q^2", 1), ("tan(p) + q", 0.5), ("p*sin(p) + q", 0.5)):
            for sign, word in (("+", "largest"), ("-", "smallest")):
                self.write("own.toml", f"[problem]\n{self.open_formula(hamiltonian, energy, sign)}\n"
                                       "[method]\nname = 'rk4'\n[run]\ndt = 0.1\nsteps = 0\n")
                text = self.refused(file="own.toml")
                self.assertIn(f"no {word} root along p[0] was found: H oscillates", text, hamiltonian)

    def test_wrong_requests(self):
        for sets, words in (
            (['problem.initial.p=["+", "-"]'], 'found 2 components "+" or "-"; allowed one'),
            (["problem.initial.p=[0.1, 0.1]"], "found together with all components of p; allowed if one of them"),
            (['problem.initial={ q = [0, 0.1], p = ["+", 0] }'], "problem.initial.energy: missing; allowed a num"),
            (['problem.initial={ q = [0, 0.1], p = ["*", 0], energy = 1 }'], 'found an array with "*"'),
            (['problem.initial={ q = ["+", 0.1], p = [1, 0], energy = 1 }'], "problem.initial.q: found"),
            (['problem.initial.energy="1/0"'], "divided by 0"),
            (["problem.initial.energi=1"], "did you mean energy?"),
        ):
            self.assertIn(words, self.refused(*sets), sets)
        self.write("orbit.toml", HENON.replace('name = "henon-heiles"', 'name = "central-force"\npotential = "kepler"\n'
                                                'orbit = { kind = "circle", r0 = 1 }'))
        self.assertIn("found together with orbit; allowed one of them", self.refused(file="orbit.toml"))

    def test_the_scenario_in_the_folder_keeps_it_as_typed(self):
        self.hamflow("run", "hh.toml", "--set", "run.steps=30", "--out", "a.run", "--quiet")
        done = json.loads((self.folder / "a.run/summary.json").read_text())
        with h5py.File(self.folder / "a.run/run.h5") as file:
            text = file["scenario"][()].decode()
        self.assertIn('p = ["+", 0.1]', text)
        self.assertIn("energy = 0.125", text)
        self.hamflow("run", "hh.toml", "--set", "run.steps=60", "--out", "a.run", "--resume", "--quiet")
        self.hamflow("run", "hh.toml", "--set", "run.steps=60", "--out", "b.run", "--quiet")
        resumed = json.loads((self.folder / "a.run/summary.json").read_text())
        whole = json.loads((self.folder / "b.run/summary.json").read_text())
        self.assertEqual(resumed["final"], whole["final"])
        self.assertEqual(done["start"], whole["start"])


class Studies(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("hh.toml", HENON)

    def sweep(self, *arguments, status=0):
        done = self.hamflow("sweep", "hh.toml", *arguments, "--out", "none", "--json", "--quiet", status=status)
        return json.loads(done.stdout)

    def refused(self, *arguments):
        return self.hamflow("sweep", "hh.toml", *arguments, "--out", "none", "--quiet", status=2).stderr

    def test_members_without_a_start(self):
        found = self.sweep("--vary", "problem.initial.q[1]=-0.8:1.2:21")
        self.assertEqual(found["no_start"] + found["done"], 21)
        for row in found["rows"]:
            y = row["problem.initial.q[1]"]
            if potential(0, y) + 0.005 > 0.125 + 1e-12:
                self.assertEqual((row["status"], row["steps"]), ("no_start", 0))
                self.assertIn("along p[0] H is at least", row["message"])
            else:
                self.assertEqual(row["status"], "done")
                self.assertAlmostEqual(row["energy"]["initial"], 0.125, delta=16 * EPSILON)
        nothing = self.sweep("--vary", "problem.initial.energy=-1,-2", status=1)
        self.assertEqual((nothing["status"], nothing["failed"]), ("failed", 2))
        # What else is wrong is exit 2, whether there is a start or not.
        self.assertIn("run.dt", self.refused("--vary", "problem.initial.energy=-1,-2", "--set", "run.dt=0"))

    def test_formulas(self):
        y = "problem.initial.q[1]"
        formula = f"sqrt(2*0.125 - 0.01 - {y}^2 + 2*{y}^3/3)"
        typed = self.sweep("--vary", f"{y}=-0.3:0.3:7", "--vary", f"problem.initial.p[0]={formula}", "--set",
                           f"problem.initial={{ q = [0, 0], p = [0, 0.1] }}")
        left = self.sweep("--vary", f"{y}=-0.3:0.3:7")
        for a, b in zip(typed["rows"], left["rows"], strict=True):
            self.assertAlmostEqual(a["problem.initial.p[0]"], math.sqrt(2 * (0.125 - potential(0, a[y])) - 0.01),
                                   delta=8 * EPSILON)
            self.assertAlmostEqual(a["energy"]["initial"], b["energy"]["initial"], delta=8 * EPSILON)
        self.assertEqual(typed["varied"]["problem.initial.p[0]"]["formula"], formula)
        # A member can be run alone from what the row gives; of more digits the row gives a formula of numbers.
        row = self.sweep("--vary", f"{y}=1/3,1/7", "--vary", f"run.dt=0.1*{y}", "--set", "run.arithmetic=quad")["rows"][1]
        self.assertEqual(row["run.dt"], "0.1*(1/7)")
        one = self.summary("hh.toml", "--set", f"{y}='1/7'", "--set", f"run.dt='{row['run.dt']}'", "--set",
                           "run.arithmetic=quad")
        self.assertEqual(row["final"], one["final"])

    def test_formulas_of_formulas(self):
        rows = self.sweep("--vary", "run.dt=0.1*problem.initial.p[1]", "--vary", "problem.initial.p[1]=problem.lambda/8",
                          "--vary", "problem.lambda=0.5,1")["rows"]
        self.assertEqual([row["run.dt"] for row in rows], [0.1 * 0.5 / 8, 0.1 / 8])

    def test_wrong_formulas(self):
        dt = "run.dt=0.1,0.2"
        for vary, words in (
            ("problem.lambda=2*run.steps", "found run.steps, column 3 of its formula; allowed other varied keys with"),
            ("problem.lambda=2*run.dy", "did you mean run.dt?"),
            ("problem.lambda=problem.lambda^2", "problem.lambda: found problem.lambda, column 1"),
            ("problem.lambda=sqrt(run.dt", "')'"),
            ("problem.lambda=sinus(run.dt)", "did you mean sin?"),
            ("problem.lambda=sqrt(0.15 - run.dt)", "is not a real number"),
            ("problem.lambda=1/(run.dt - 0.1)", "divided by"),
        ):
            text = self.refused("--vary", dt, "--vary", vary)
            self.assertIn(words, text, vary)
            self.assertIn("--vary: error: ", text, vary)
        cycle = self.refused("--vary", "problem.lambda=run.dt*2", "--vary", "run.dt=problem.lambda/2")
        self.assertIn("; allowed formulas of keys that have values", cycle)

    def test_complaints_show_formulas_as_typed(self):
        formula = "sqrt(problem.initial.q[1])/10 + 0.05"  # of dt; a start without a value is the member's affair
        text = self.refused("--vary", "problem.initial.q[1]=-0.01,0.1", "--vary", f"run.dt={formula}")
        self.assertIn(f'found "{formula}" where problem.initial.q[1]=-0.01: sqrt((-0.01)) is not a real number', text)
        self.assertIn(f"(member 0: problem.initial.q[1]=-0.01, run.dt={formula})", text)

    def test_starts_that_formulas_do_not_give(self):
        """A component of the start that has no real value leaves its member without a start, not the sweep."""
        formula = "sqrt(0.02 - problem.initial.q[1]^2)"
        found = self.sweep("--set", "problem.initial={ q = [0, 0.1], p = [0.1, 0.1] }", "--vary",
                           "problem.initial.q[1]=0,0.1,0.2,0.3", "--vary", f"problem.initial.p[0]={formula}")
        self.assertEqual([row["status"] for row in found["rows"]], ["done", "done", "no_start", "no_start"])
        self.assertIn("is not a real number", found["rows"][2]["message"])
        self.assertIsNone(found["rows"][3]["problem.initial.p[0]"])
        self.assertAlmostEqual(found["rows"][1]["problem.initial.p[0]"], 0.1, delta=1e-15)
        self.assertEqual((found["no_start"], found["failed"]), (2, 2))
        self.assertEqual([(one["member"], one["kind"]) for one in found["failures"]], [(2, "no_start"), (3, "no_start")])
        self.assertEqual(found["failures"][0]["message"], found["rows"][2]["message"])

    def test_what_decides_the_columns_is_not_varied(self):
        section = ("--set", "run.section={ coordinate = 'q1' }")
        for vary in ("run.lyapunov=false,true", "run.lyapunov=2,1,4", "run.eigenvalues=true,false",
                     "run.section.value=0,0.1", "run.section.coordinate=q1,q2", "run.section.direction=1,-1"):
            path = vary.split("=")[0]
            text = self.refused(*(section if "section" in path else ()), "--vary", vary)
            self.assertIn(f"--vary: error: found {path}, which must be the same for all members", text)

    def test_lists_in_step(self):
        found = self.sweep("--zip", "--vary", "run.dt=0.1,0.05,0.025", "--vary", "run.steps=10,20,40", "--vary",
                           "problem.lambda=0.5:1:3")
        self.assertEqual(found["members"], 3)
        self.assertEqual([(row["run.dt"], row["run.steps"], row["problem.lambda"]) for row in found["rows"]],
                         [(0.1, 10, 0.5), (0.05, 20, 0.75), (0.025, 40, 1.0)])
        for row in found["rows"]:
            self.assertAlmostEqual(row["final"]["t"], 1, delta=4 * EPSILON)
        text = self.refused("--zip", "--vary", "run.dt=0.1,0.05", "--vary", "run.steps=10,20,40")
        self.assertIn("--zip: error: found 2 values of run.dt and 3 of run.steps; allowed lists of equal", text)
        self.hamflow("sweep", "hh.toml", "--zip", "--vary", "run.dt=0.1,0.05,0.025", "--vary", "run.steps=10,20,40",
                     "--out", "none", "--quiet", "--figure", "dt.svg")

    SECTION = ["--set", "run.section={ coordinate = 'q1' }", "--set", "run.steps=2000", "--vary",
               "problem.initial.q[1]=-0.2:0.8:6"]

    def test_sections_of_all_members(self):
        self.hamflow("sweep", "hh.toml", *self.SECTION, "--out", "s", "--quiet", "--figure", "section.svg")
        drawn = (self.folder / "section.svg").read_text()
        self.assertIn("increasing", drawn)
        rows = self.sweep(*self.SECTION)["rows"]
        self.assertEqual(rows[-1]["status"], "no_start")
        with h5py.File(self.folder / "s/sweep.h5") as file:
            section = {name: file[f"section/{name}"][()] for name in ("member", "t", "q", "p")}
        for member, row in enumerate(rows):
            own = section["member"] == member
            if row["status"] == "no_start":
                self.assertEqual(own.sum(), 0)
                continue
            self.hamflow("run", "hh.toml", *self.SECTION[:4], "--set", f"problem.initial.q[1]={row['problem.initial.q[1]']!r}",
                         "--out", f"m{member}", "--quiet")
            with h5py.File(self.folder / f"m{member}/run.h5") as file:
                for name in ("t", "q", "p"):  # every bit
                    self.assertEqual(section[name][own].tolist(), file[f"section/{name}"][()].tolist())
            self.assertEqual(row["section"]["points"], own.sum())
            self.assertGreater(own.sum(), 10)

    def test_sections_as_text(self):
        self.hamflow("sweep", "hh.toml", *self.SECTION, "--set", 'output.formats=["csv"]', "--out", "s", "--quiet")
        self.assertEqual(sorted(path.name for path in (self.folder / "s").iterdir() if path.suffix in (".csv", ".h5")),
                         ["section.csv", "sweep.csv"])
        table = list(csv.DictReader((self.folder / "s/section.csv").read_text().splitlines()))
        self.assertEqual(list(table[0]), ["member", "t", "q1", "q2", "p1", "p2"])
        rows = self.sweep(*self.SECTION)["rows"]
        for member, row in enumerate(rows):
            own = [line for line in table if line["member"] == str(member)]
            self.assertEqual(len(own), row.get("section", {"points": 0})["points"])
            for line in own:
                self.assertLess(abs(float(line["q1"])), 1e-15)
                self.assertGreater(float(line["p1"]), 0)
        # --force takes it away with the rest.
        self.hamflow("sweep", "hh.toml", "--vary", "run.dt=0.1,0.05", "--out", "s", "--quiet", "--force")
        self.assertFalse((self.folder / "s/section.csv").exists())

    SECTIONS = ("{ coordinate = 'q1' }", "{ coordinate = 'p2', value = 0.05, direction = 0 }",
                "{ expression = 'lambda*q1 - 0.1*q2 + 0.001*t', direction = -1 }")

    def test_what_is_measured_in_lanes_is_that_of_runs(self):
        """Everything at once, also of members that escape over the saddle and break off."""
        for section in self.SECTIONS:
            sets = (f"run.section={section}", "run.lyapunov=true", "run.eigenvalues=true",
                    "output.observables={ r = 'q1^2 + q2^2', e = 'exp(-abs(p1))*t' }", "run.steps=2000",
                    "problem.initial.p[1]=0.05", 'output.formats=["csv"]')
            arguments = [word for one in sets for word in ("--set", one)]
            found = {}
            for lanes in ("none", "auto", "generic"):
                self.hamflow("sweep", "hh.toml", "--vary", "problem.initial.q[1]=-0.2:0.4:12", "--vary",
                             "problem.initial.energy=0.125,0.3", "--vary", "problem.lambda=0.9,1", *arguments,
                             "--lanes", lanes, "--out", f"{lanes}.sweep", "--quiet", "--force")
                found[lanes] = [(self.folder / f"{lanes}.sweep" / name).read_text()
                                for name in ("sweep.csv", "section.csv")]
            self.assertEqual(found["none"], found["auto"])
            self.assertEqual(found["none"], found["generic"])
            self.assertGreater(found["auto"][1].count("\n"), 500)
            self.assertGreater(found["auto"][0].count("non_finite"), 5)

    def test_so_it_is_where_steps_are_solved_for(self):
        """Members of steps that take Newton together, of an H that is not separable."""
        self.write("dp.toml", """
[problem]
name = "double-pendulum"
initial = { q = [0.4, 0.0], p = ["+", 0.1], energy = -20 }
[method]
name = "cg(2,auto)"
[run]
dt = 0.05
steps = 400
section = { coordinate = "q2", direction = 1 }
lyapunov = 1
[output]
formats = ["csv"]
observables = { r = "q1^2 + t" }
""")
        found = {}
        for lanes in ("none", "auto"):
            self.hamflow("sweep", "dp.toml", "--vary", "problem.initial.q[0]=0.0:0.6:9", "--lanes", lanes, "--out",
                         f"{lanes}.sweep", "--quiet", "--force")
            found[lanes] = [(self.folder / f"{lanes}.sweep" / name).read_text() for name in ("sweep.csv", "section.csv")]
        self.assertEqual(found["none"], found["auto"])
        self.assertGreater(found["auto"][1].count("\n"), 30)

    def test_figures_of_sections_that_cannot_be(self):
        # Without a section, and with a column, there is a map of the column as ever.
        self.hamflow("sweep", "hh.toml", *self.SECTION, "--out", "none", "--quiet", "--figure", "map.svg", "--colour",
                     "energy/max_error")
        self.assertNotIn("increasing", (self.folder / "map.svg").read_text())
        done = self.hamflow("sweep", "hh.toml", *self.SECTION, "--set", "run.steps=1", "--out", "none", "--quiet",
                            "--figure", "none.svg", status=3)
        self.assertIn("no member has a point of the section", done.stderr)

    def test_a_lyapunov_map_at_fixed_energy(self):
        found = self.sweep("--vary", "problem.initial.q[1]=-0.8:0.8:5", "--vary", "problem.initial.p[1]=-0.4:0.4:3",
                           "--set", "run.lyapunov=1", "--figure", "map.svg", "--colour", "observables/lyapunov1")
        for row in found["rows"]:  # the first member has no start, and yet there is the column
            self.assertEqual("lyapunov1" in row, row["status"] == "done", row)
        self.assertIn("no_start", (self.folder / "map.svg").read_text())


if __name__ == "__main__":
    unittest.main()

"""hamflow compare: orders, references, rows, winners; the table, JSON, CSV and the figure say the same."""

import csv
import decimal
import json
import math
import re
import select
import signal
import subprocess
import unittest
import xml.etree.ElementTree

from command import HAMFLOW, CommandCase


class CompareCase(CommandCase):
    def setUp(self):
        super().setUp()
        self.write("henon.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0.1,-0.2],p=[0.3,0.1]}\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=100\n")

    def compare(self, *arguments, status=0):
        return json.loads(self.hamflow("compare", *arguments, "--json", status=status).stdout)

    def slopes(self, rows, key):
        """log2 of the ratio of neighbours, as dt halves."""
        values = [row[key] for row in rows]
        return [math.log2(a / b) for a, b in zip(values, values[1:])]


class Compare(CompareCase):
    def test_rows_and_orders_against_the_closed_form(self):
        c = self.compare("kepler.toml", "--methods", "verlet, stv4,cg(1,5)", "--set", "run.steps=200")
        self.assertEqual(c["status"], "done")
        self.assertEqual(c["reference"]["kind"], "closed form")
        self.assertEqual(c["t_end"], 20)
        # Kepler at t = 20, within what a rounding of the start makes of it.
        self.assertLess(c["reference"]["uncertainty"], 1e-12)
        self.assertEqual([r["method"] for r in c["rows"]], 6 * ["verlet"] + 6 * ["stv4"] + 6 * ["cg(1,5)"])
        self.assertEqual([r["steps"] for r in c["rows"]], 3 * [100, 200, 400, 800, 1600, 3200])
        for r in c["rows"]:
            self.assertEqual(r["dt"], 20 / r["steps"])
            self.assertGreater(r["seconds"], 0)
            self.assertGreaterEqual(r["wall_seconds"], r["seconds"])
        for first, order in ((0, 2), (6, 4), (12, 2)):
            for slope in self.slopes(c["rows"][first + 2:first + 6], "error"):
                self.assertAlmostEqual(slope, order, delta=0.15)
        for r in c["rows"][12:]:  # the element keeps the energy to rounding
            self.assertLess(r["max_energy_error"], 1e-13)
        self.assertEqual(c["rows"][7]["evaluations"]["force"], 601)

    def test_errors_are_those_of_runs(self):
        c = self.compare("kepler.toml", "--methods", "stv4", "--dt", "0.1")
        s = self.summary("kepler.toml", "--set", "method={name='stv4'}")
        self.assertEqual(len(c["rows"]), 1)
        self.assertEqual(c["rows"][0]["differences"], s["exact"]["differences"])
        self.assertIn(s["exact"]["max_difference"], c["rows"][0]["differences"].values())
        self.assertEqual(c["rows"][0]["max_energy_error"], s["energy"]["max_relative_error"])
        self.assertEqual(c["rows"][0]["evaluations"], s["evaluations"])

    def test_the_reference_has_the_constants_of_the_run(self):
        """A literal 1.3 is the double in the run: cosh(sqrt(1.3) 20), where it is unstable, tells decimals from doubles."""
        self.write("hill.toml", """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 - 1.3*x^2/2"
initial = { q = [1], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.01
steps = 2000
""")
        reference = self.compare("hill.toml", "--methods", "stv4", "--dt", "0.01")["reference"]
        with decimal.localcontext(decimal.Context(prec=60)):
            grown = (decimal.Decimal(1.3).sqrt() * 20).exp()
            right = (grown + 1 / grown) / 2
            off = abs(decimal.Decimal(reference["q"][0]) - right)
            self.assertLess(off, right * decimal.Decimal(2 ** -52 + reference["uncertainty"]))
            rounded = (decimal.Decimal("1.3").sqrt() * 20).exp() / 2
            # The reference is shown as a double, whose rounding is at most 2.4e-7; the two H are 1.6e-6 apart.
            self.assertGreater(abs(rounded - right), 4 * off)
        # The inverse of an inertia: where there is no closed form, as beside a wall that is not met.
        self.write("swing.toml", """
[problem]
name = "pendulum"
mass = 3
length = 0.7
gravity = 1.3
initial = { q = [3.1], p = [0] }
walls = [{ coordinate = "q", max = 50 }]
[method]
name = "stv4"
[run]
dt = 0.01
steps = 3000
""")
        beside = self.compare("swing.toml", "--methods", "stv4", "--dt", "0.01")["reference"]
        self.assertEqual(beside["kind"], "integration")
        (self.folder / "free.toml").write_text((self.folder / "swing.toml").read_text().replace("walls", "# walls"))
        closed = self.compare("free.toml", "--methods", "stv4", "--dt", "0.01")["reference"]
        self.assertEqual(closed["kind"], "closed form")
        self.assertLessEqual(abs(beside["q"][0] - closed["q"][0]), 2 * closed["uncertainty"] * 50 + 1e-15)

    def test_a_run_of_a_comparison_is_the_single_run(self):
        """The typed dt, not t_end / steps, which differs from it by a rounding."""
        for arithmetic in ("double", "compensated", "double-double", "quad", "mp(40)"):
            for dts, sets in (("0.1,0.05,0.07", ()), ("1/30", ("run.dt='1/3'",)), ("0.1", ("run.dt=-0.1",))):
                sets = [word for one in (*sets, f"run.arithmetic='{arithmetic}'", "run.steps=70", "method={name='stv4'}")
                        for word in ("--set", one)]
                rows = self.compare("kepler.toml", *sets, "--methods", "stv4", "--dt", dts)["rows"]
                self.assertEqual(len(rows), dts.count(",") + 1)
                for row in rows:
                    dt = min(dts.split(","), key=lambda text: abs(eval(text) - abs(row["dt"])))
                    sign = "-" if row["dt"] < 0 else ""
                    own = self.summary("kepler.toml", *sets, "--set", f"run.dt='{sign}({dt})'", "--set", f"run.steps={row['steps']}")
                    with self.subTest(arithmetic=arithmetic, dt=dt, sets=sets):
                        self.assertEqual(row["dt"], own["dt"])
                        self.assertEqual(row["max_energy_error"], own["energy"]["max_relative_error"])

    def test_a_small_energy_error_of_a_comparison_has_the_digits_of_the_single_run(self):
        """0.01*70/70 in double-double is another number than 0.01."""
        self.write("k.toml", "[problem]\nname='central-force'\npotential='kepler'\ninitial={q=[1,0],p=[0,1.1]}\n"
                   "[method]\nname='kahan-li8'\n[run]\ndt=0.01\nsteps=70\narithmetic='double-double'\n")
        row = self.compare("k.toml", "--methods", "kahan-li8", "--dt", "0.01")["rows"][0]
        self.assertEqual(row["max_energy_error"], self.summary("k.toml")["energy"]["max_relative_error"])

    def test_without_dt_each_run_of_a_comparison_is_the_single_run(self):
        sets = ("--set", "run.arithmetic='double-double'", "--set", "run.steps=30", "--set", "method={name='stv4'}")
        for row in self.compare("kepler.toml", *sets, "--methods", "stv4")["rows"]:
            own = self.summary("kepler.toml", *sets, "--set", f"run.dt='0.1*{30 / row['steps']}'",
                               "--set", f"run.steps={row['steps']}")
            self.assertEqual(row["max_energy_error"], own["energy"]["max_relative_error"])

    def test_the_method_of_the_file_is_not_run(self):
        """Only the methods compared have to fit the problem."""
        self.write("rod.toml", """
[problem]
name = "pendulum"
coordinates = "cartesian"
initial = { q = [0.6, -0.8], p = [0.8, 0.6] }
[method]
name = "cg"
quadrature = 5
[run]
dt = 0.05
steps = 40
""")
        self.assertIn("method.name", self.hamflow("run", "rod.toml", "--out", "none", status=2).stderr)
        done = self.hamflow("compare", "rod.toml", "--methods", "rattle,rattle4", "--dt", "0.1,0.05", "--json")
        self.assertEqual([row["method"] for row in json.loads(done.stdout)["rows"]], 2 * ["rattle"] + 2 * ["rattle4"])
        self.assertIn("note: the comparison does not run the method of the file, which would be refused: method.name: ", done.stderr)
        for methods, wrong in (("rattle,verlet", ["verlet"]), ("verlet,stv4", ["verlet", "stv4"])):
            lines = self.hamflow("compare", "rod.toml", "--methods", methods, status=2).stderr.splitlines()
            for line, name in zip(lines, wrong, strict=True):
                self.assertTrue(line.startswith(f"--methods: error: found '{name}'; "), line)
                self.assertIn("rattle", line)
        both = self.hamflow("compare", "rod.toml", "--methods", "verlet", "--set", "run.dt=0", status=2).stderr.splitlines()
        self.assertEqual([line.split(": error: ")[0] for line in both], ["--set", "--methods"])
        self.assertIn("run.dt", both[0])

    def test_what_run_refuses_of_many_particles(self):
        self.write("gas.toml", "[problem]\nname='gas'\nparticles_per_side=39\n[method]\nname='stv4'\n[run]\ndt=1e-4\nsteps=1\n")
        refused = self.hamflow("run", "gas.toml", "--set", "method.name=chin4a", "--out", "none", status=2).stderr
        self.assertIn("chin4a with 3042 coordinates", refused)
        lines = self.hamflow("compare", "gas.toml", "--methods", "chin4a,discrete-gradient,verlet", status=2).stderr.splitlines()
        for line, name in zip(lines, ("chin4a", "discrete-gradient"), strict=True):
            self.assertTrue(line.startswith(f"--methods: error: found '{name}'; with 3042 coordinates"), line)

    def test_a_reference_of_many_coordinates_is_announced(self):
        """Before it starts: nothing else is seen of it for long."""
        gas = ("[problem]\nname='gas'\nparticles_per_side=%d\ncutoff={radius=2,skin=0.5}\ncontainer={kind='none'}\n"
               "[method]\nname='verlet'\n[run]\ndt=1e-5\nsteps=1\n")
        said = "1058 coordinates in double-double, takes most of the time; a smaller run.steps or run.t_end, or fewer"
        for side, announced in ((23, True), (4, False)):
            self.write("g.toml", gas % side)
            process = subprocess.Popen([HAMFLOW, "compare", "g.toml", "--methods", "verlet", "--json"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            ready, _, _ = select.select([process.stderr], [], [], 30)
            first = process.stderr.readline() if ready else ""
            process.send_signal(signal.SIGINT)
            first += process.communicate(timeout=60)[1]
            (self.assertIn if announced else self.assertNotIn)(said, first)

    def test_two_integrations_where_there_is_no_closed_form(self):
        c = self.compare("henon.toml", "--methods", "verlet,yoshida6,rk4")
        self.assertEqual(c["reference"]["kind"], "integration")
        for word in ("Taylor series", "extrapolated midpoint", "relative difference", "double-double"):
            self.assertIn(word, c["reference"]["description"])
        # Two digits below those of double, carried over ten units of time; never less than what a tolerance promises.
        size = max(abs(x) for x in c["reference"]["q"] + c["reference"]["p"])
        self.assertLess(c["reference"]["uncertainty"], 1e-17)
        self.assertGreaterEqual(c["reference"]["uncertainty"], 0.99e-18 * size)
        for first, order in ((0, 2), (12, 4)):
            for slope in self.slopes(c["rows"][first + 1:first + 6], "error"):
                self.assertAlmostEqual(slope, order, delta=0.15)
        for slope in self.slopes(c["rows"][6:11], "error"):
            self.assertAlmostEqual(slope, 6, delta=0.15)
        # A method that is right to rounding agrees with the reference: with compensated sums of 3200 steps the state is
        # rounded once, and every force, h eps |F| apart, walks to less than that.
        fine = self.compare("henon.toml", "--methods", "yoshida6", "--dt", "0.003125", "--set",
                            "run.arithmetic=compensated")
        self.assertLess(max(fine["rows"][0]["differences"].values()), 4 * 2.0**-52)

    def test_the_uncertainty_bounds_the_distance_of_both_kinds_of_reference(self):
        """The closed form of Kepler's problem against the same motion of two bodies, for which none is known here."""
        start = "q=[0.5,0,-0.5,0],p=[0,0.5,0,-0.5]"
        self.write("bodies.toml", "[problem]\nname='n-body'\nmasses=[1,1]\ninitial={%s}\n" % start +
                   "[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=200\n")
        self.write("reduced.toml", "[problem]\nname='central-force'\npotential='kepler'\nk=1\nmass=0.5\n"
                   "initial={q=[1,0],p=[0,0.5]}\n[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=200\n")
        bodies = self.compare("bodies.toml", "--methods", "verlet", "--dt", "0.1")["reference"]
        reduced = self.compare("reduced.toml", "--methods", "verlet", "--dt", "0.1")["reference"]
        self.assertEqual((bodies["kind"], reduced["kind"]), ("integration", "closed form"))
        # q = q1 - q2, p = (p1 - p2)/2; the reference is printed in double.
        printed = 4 * 2.0**-53
        for i in range(2):
            self.assertLessEqual(abs(bodies["q"][i] - bodies["q"][i + 2] - reduced["q"][i]),
                                 reduced["uncertainty"] + 2 * bodies["uncertainty"] + printed)
            self.assertLessEqual(abs((bodies["p"][i] - bodies["p"][i + 2]) / 2 - reduced["p"][i]),
                                 reduced["uncertainty"] + 2 * bodies["uncertainty"] + printed)

    def test_an_error_below_the_uncertainty_is_not_told(self):
        # e^(t) of the Lyapunov kind: after 600 units of a chaotic orbit no digit of any arithmetic here is left.
        self.write("chaos.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0,-0.25],p=[0.42,0]}\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=20000\n")
        c = self.compare("chaos.toml", "--methods", "stv4,yoshida6", "--dt", "0.1")
        self.assertGreater(c["reference"]["uncertainty"], 1e-3)
        for row in c["rows"]:
            self.assertEqual(row.get("below_uncertainty", False), row["error"] <= c["reference"]["uncertainty"])
        self.assertEqual([w for w in c["winners"] if w["error"] < 4 * c["reference"]["uncertainty"]], [])
        if any("below_uncertainty" in row for row in c["rows"]):
            self.assertIn("< ", self.hamflow("compare", "chaos.toml", "--methods", "stv4,yoshida6", "--dt", "0.1").stdout)

    def test_more_digits(self):
        """Orders go on far below the rounding of double; errors are those of the run's own digits."""
        for arithmetic, floor in (("double-double", 1e-28), ("quad", 1e-30), ("mp(35)", 1e-32), ("mp(12)", 1e-9)):
            c = self.compare("henon.toml", "--methods", "kahan-li8,yoshida8", "--dt", "0.1,0.05,0.025", "--set",
                             "run.steps=10", "--set", f"run.arithmetic={arithmetic}")
            self.assertEqual(c["arithmetic"], arithmetic)
            self.assertIsInstance(c["reference"]["q"][0], str)
            self.assertLess(c["reference"]["uncertainty"], floor)
            for method in ("kahan-li8", "yoshida8"):
                rows = [r for r in c["rows"] if r["method"] == method]
                if arithmetic != "mp(12)":
                    for slope in self.slopes(rows, "error"):
                        self.assertAlmostEqual(slope, 8, delta=0.4)
                self.assertGreater(rows[-1]["max_energy_error"], 0)
                self.assertLessEqual(rows[-1]["end_energy_error"], rows[-1]["max_energy_error"] * (1 + 1e-12))
        table = self.hamflow("compare", "henon.toml", "--methods", "kahan-li8", "--dt", "0.1", "--set", "run.steps=10",
                             "--set", "run.arithmetic=quad", "--csv", "t.csv", "--figure", "f.svg").stdout
        self.assertIn("quad arithmetic", table)
        self.assertGreater((self.folder / "f.svg").stat().st_size, 1000)

    def test_more_digits_are_those_of_a_run(self):
        c = self.compare("henon.toml", "--methods", "verlet", "--dt", "0.1", "--set", "run.steps=7", "--set",
                         "run.arithmetic=quad")
        run = self.summary("henon.toml", "--set", "method.name=verlet", "--set", "run.steps=7", "--set",
                           "run.arithmetic=quad")
        with decimal.localcontext() as context:
            context.prec = 60
            D = decimal.Decimal
            ends = [abs(D(a) - D(b)) for key in ("q", "p") for a, b in zip(run["final"][key], c["reference"][key])]
            energy = abs(D(run["energy"]["final"]) - D(run["energy"]["initial"])) / D(run["energy"]["scale"])
        self.assertAlmostEqual(max(c["rows"][0]["differences"].values()) / float(max(ends)), 1, delta=1e-12)
        self.assertAlmostEqual(c["rows"][0]["end_energy_error"] / float(energy), 1, delta=1e-12)

    def test_errors_below_the_doubles_are_texts(self):
        self.write("spring.toml", "[problem]\nname='harmonic'\ninitial={q=[1],p=[0]}\n[method]\nname='verlet'\n"
                   "[run]\ndt='1e-110'\nsteps=1\narithmetic='mp(350)'\n")
        row = self.compare("spring.toml", "--methods", "verlet", "--dt", "1e-110")["rows"][0]
        # p = -h + h^3/6 of the exact motion, -h + h^3/4 of verlet: the error is h^3/12.
        mantissa, exponent = row["differences"]["p"].split("e")
        self.assertAlmostEqual(float(mantissa), 100 / 12, delta=1e-9)
        self.assertEqual(int(exponent), -332)
        self.assertAlmostEqual(row["error"] / (1e-220 / 12), 1, delta=1e-9)  # beside p, which is h in size
        # The tolerance of the reference is beside the size of each number, as the error is.
        self.assertNotIn("below_uncertainty", row)

    def test_units_change_no_error(self):
        """One ellipse in units of length, mass and time that differ by 2^40, 2^20 and 2^30."""
        def rows(length, mass, time):
            self.write("ellipse.toml", f"""[problem]
                name = "central-force"
                potential = "kepler"
                k = {mass * length**3 / time**2!r}
                mass = {mass!r}
                initial = {{ q = [{length!r}, 0], p = [0, {0.75 * mass * length / time!r}] }}
                [run]
                dt = {time / 16!r}
                steps = 64
                """)
            c = self.compare("ellipse.toml", "--methods", "verlet,gauss(2)", "--dt", repr(time / 16))
            return [r["error"] for r in c["rows"]]
        natural = rows(1.0, 1.0, 1.0)
        self.assertGreater(natural[0], 1e-4)
        for units in ((2.0**40, 2.0**20, 2.0**30), (2.0**-40, 2.0**60, 2.0**-20)):
            for a, b in zip(natural, rows(*units)):
                self.assertAlmostEqual(a / b, 1, delta=1e-9)

    def test_adaptive_methods_vary_their_tolerance(self):
        c = self.compare("henon.toml", "--methods", "dop853,taylor,stv4")
        for method in ("dop853", "taylor"):
            rows = [r for r in c["rows"] if r["method"] == method]
            self.assertEqual([round(math.log10(r["tolerance"])) for r in rows], [-3, -5, -7, -9, -11, -13], method)
            self.assertEqual({r["steps"] for r in rows}, {32})
            work = [r["evaluations"]["force"] + r["evaluations"]["gradient"] for r in rows]
            self.assertEqual(work, sorted(work))
            for r in rows:  # the tolerance is that of a sub-step, of which there are some hundred
                self.assertLess(r["error"], max(1e3 * r["tolerance"], 1e-13), r)
        self.assertTrue(all("tolerance" not in r for r in c["rows"] if r["method"] == "stv4"))
        # They are ranked by evaluations like the others, and the table says what one of taylor is.
        ranked = {name for w in c["winners"] if w["by"] == "evaluations" for name in (w["method"], w.get("second"))}
        self.assertIn("taylor", ranked)
        table = self.hamflow("compare", "henon.toml", "--methods", "taylor").stdout
        self.assertIn("coefficient", table)
        self.assertGreater(len(set(re.findall(r"^(?:taylor)?\s+(\d+)\s+tol ", table, re.M))), 1, table)  # its orders

    def test_a_tolerance_that_is_given_counts(self):
        done = self.hamflow("compare", "henon.toml", "--methods", "dop853(tolerance=1e-12),dop853(1e-6),stv4", "--dt",
                            "0.1,0.05", "--json")
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([r["method"] for r in rows], ["dop853(tolerance=1e-12)", "dop853(tolerance=1e-06)"] + 2 * ["stv4"])
        self.assertEqual([r.get("tolerance") for r in rows], [1e-12, 1e-6, None, None])
        self.assertLess(rows[0]["error"], 1e-10)
        self.assertGreater(rows[1]["error"], 10 * rows[0]["error"])
        self.assertIn("dop853(tolerance=1e-12) chooses its sub-steps by its tolerance and not by dt", done.stderr)
        alone = self.compare("henon.toml", "--methods", "dop853,taylor", "--dt", "0.1")["rows"]
        self.assertEqual([r["tolerance"] for r in alone], [1e-12, 1e-12])

    def test_winners_lie_between_rows(self):
        c = self.compare("henon.toml", "--methods", "verlet,stv4,yoshida6")
        of = {(w["by"], round(math.log10(w["error"]))): w for w in c["winners"]}
        best = of["evaluations", -9]
        self.assertEqual(best["method"], "yoshida6")
        rows = [r for r in c["rows"] if r["method"] == "yoshida6"]
        above = max(r["evaluations"]["force"] for r in rows if r["error"] > 1e-9)
        below = min(r["evaluations"]["force"] for r in rows if r["error"] < 1e-9)
        self.assertTrue(above <= best["work"] <= below, (above, best, below))
        self.assertTrue(any(by == "seconds" for by, _ in of))
        for w in c["winners"]:
            if "second" in w:
                self.assertLessEqual(w["work"], w["second_work"])

    def test_no_row_undercuts_a_winner(self):
        # dop853 and cg(4, 6) are better than most levels with their cheapest row already.
        c = self.compare("henon.toml", "--methods", "verlet,stv4,cg(4,6),dop853", "--dt", "0.2,0.1,0.05,0.025")
        work = {"evaluations": lambda r: r["evaluations"]["force"] + r["evaluations"]["gradient"], "seconds": lambda r: r["seconds"]}
        firsts = set()
        for w in c["winners"]:
            reached = {}
            for r in c["rows"]:
                if r["error"] <= w["error"]:
                    reached.setdefault(r["method"], []).append(work[w["by"]](r))
            least = sorted((min(all_of), method) for method, all_of in reached.items())
            self.assertLessEqual(w["work"], least[0][0] * (1 + 1e-12), w)
            if len(least) > 1:
                self.assertLessEqual(w["second_work"], least[1][0] * (1 + 1e-12), w)
            if w["by"] == "evaluations":
                firsts.add(w["method"])
        self.assertIn("dop853", firsts)

    def test_steps_are_moved_to_divide_the_time(self):
        done = self.hamflow("compare", "henon.toml", "--methods", "verlet", "--dt", "0.3,1/8", "--json")
        c = json.loads(done.stdout)
        self.assertEqual([r["steps"] for r in c["rows"]], [33, 80])
        self.assertEqual(c["rows"][0]["dt"], 10 / 33)
        self.assertIn("0.3", done.stderr)
        self.assertNotIn("1/8", done.stderr)
        backwards = self.compare("henon.toml", "--methods", "verlet", "--dt", "0.1", "--set", "run.dt=-0.1")
        self.assertEqual((backwards["t_end"], backwards["rows"][0]["dt"]), (-10, -0.1))

    def test_a_run_that_fails_is_a_row(self):
        c = self.compare("kepler.toml", "--methods", "cg(1,5),verlet", "--set", "run.steps=30", "--set", "run.dt=10",
                         "--dt", "10,0.1")
        by = {(r["method"], r["steps"]): r for r in c["rows"]}
        bad = by["cg(1,5)", 30]
        self.assertEqual((bad["status"], bad["kind"]), ("failed", "not_converged"))
        self.assertIn("step", bad["reason"])
        self.assertIsNone(bad["error"])
        self.assertEqual(by["cg(1,5)", 3000]["status"], "done")
        only = self.compare("kepler.toml", "--methods", "cg(1,5)", "--set", "run.dt=30", "--dt", "30", status=1)
        self.assertEqual(only["status"], "failed")
        out = self.hamflow("compare", "kepler.toml", "--methods", "cg(1,5)", "--set", "run.dt=10", "--set", "run.steps=30",
                           "--dt", "10,0.1").stdout
        self.assertIn("failed: step", out)

    def test_refusals_name_the_method_before_anything_runs(self):
        for arguments, words in (
            (["--methods", "stv5"], "did you mean stv4"),
            (["--methods", "verlet,boris"], "'boris'"),
            (["--methods", "verlet,rk4", "--set", "run.arithmetic=lattice"], "'rk4'"),
            (["--methods", "verlet,"], "''"),
            (["--methods", "verlet", "--dt", "0.1,x"], "'x'"),
            (["--methods", "verlet", "--dt", "0"], "'0'"),
            (["--methods", "verlet", "--figure", "a.gif"], "a.gif"),
            (["--methods", "verlet", "--set", "run.steps=0"], "length 0"),
        ):
            done = self.hamflow("compare", "henon.toml", *arguments, "--json", status=2)
            self.assertIn(words, done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "rejected")
        self.hamflow("compare", "henon.toml", status=2)
        self.hamflow("compare", "missing.toml", "--methods", "verlet", status=3)

    def test_methods_that_differ_in_any_option_have_names_of_their_own(self):
        same, other = "cg(2,3)", "cg(2,3,tolerance=1e-3,iteration=fixed-point)"
        done = self.hamflow("compare", "henon.toml", "--methods", f"{same},{other},stv4", "--dt", "0.2,0.1,0.05", "--csv",
                            "t.csv", "--figure", "f.svg", "--json")
        c = json.loads(done.stdout)
        names = 3 * [same] + 3 * [other] + 3 * ["stv4"]
        self.assertEqual([r["method"] for r in c["rows"]], names)
        rows = list(csv.DictReader((self.folder / "t.csv").read_text().splitlines()))
        self.assertEqual([r["method"] for r in rows], names)
        drawn = "".join(xml.etree.ElementTree.parse(self.folder / "f.svg").getroot().itertext())
        self.assertIn(other, drawn)
        for w in c["winners"]:
            self.assertNotEqual(w["method"], w.get("second"))
        # A winner is the row that is meant: both have the same errors only where the tolerance does not matter.
        table = self.hamflow("compare", "henon.toml", "--methods", f"{same},{other}", "--dt", "0.1").stdout
        self.assertRegex(table, r"(?m)^cg\(2,3\) .*\n^cg\(2,3,tolerance=1e-3,iteration=fixed-point\) ")
        adaptive = self.compare("henon.toml", "--methods", "dop853(1.00001e-6),dop853(1e-6),tao2,tao2(5)", "--dt", "0.1")
        self.assertEqual(len({r["method"] for r in adaptive["rows"]}), 4)

    def test_the_same_method_twice_is_refused(self):
        for twice in ("stv4,stv4", "cg(2,3),cg(degree=2,quadrature=3)", "gauss,gauss(2)", "dop853(1e-6),dop853(tolerance=0.000001)"):
            done = self.hamflow("compare", "henon.toml", "--methods", twice, "--json", status=2)
            self.assertIn("the same method with the same options; allowed once", done.stderr)

    def test_a_method_takes_of_the_file_what_run_would_take(self):
        self.write("halve.toml", "[problem]\nname='central-force'\npotential='kepler'\ninitial={q=[1,0],p=[0,0.3]}\n[method]\n"
                   "name='gauss'\nstages=2\non_divergence='halve'\nmax_iterations=40\n[run]\ndt=0.2\nsteps=20\n")
        done = self.hamflow("compare", "halve.toml", "--methods", "gauss(2),cg(1,6),lobatto-3a-3b,stv4", "--dt", "0.2", "--json")
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([r["method"] for r in rows], ["gauss(2)", "cg(1,6)", "lobatto-3a-3b(2)", "stv4"])
        for row in rows:
            own = json.loads(self.hamflow("run", "halve.toml", "--set", f"method.name={row['method']}", "--out", "none",
                                          "--json").stdout)
            self.assertEqual({key: own["evaluations"][key] for key in row["evaluations"]}, row["evaluations"], row["method"])
        for words in ("method.max_iterations, method.on_divergence are not used by stv4: no such option",
                      "method.stages is not used by gauss(2): its name contains it",
                      "method.stages is not used by cg(1,6), stv4: no such option",
                      "method.stages is not used by lobatto-3a-3b: it has another meaning there"):
            self.assertIn("note: " + words, done.stderr)
        self.assertEqual(self.hamflow("compare", "halve.toml", "--methods", "gauss(2),stv4", "--quiet").stderr, "")
        # What the file says tells methods apart where it has to, and what is set goes to those that have it.
        told = self.compare("halve.toml", "--methods", "gauss,gauss(2,tolerance=1e-3),verlet,dop853", "--dt", "0.1,0.05", "--set",
                            "method.tolerance=1e-9")["rows"]
        self.assertEqual([r["method"] for r in told[::2]],
                         ["gauss(2,tolerance=1e-09)", "gauss(2,tolerance=1e-3)", "verlet", "dop853"])
        self.assertEqual([r.get("tolerance") for r in told[-2:]], [1e-3, 1e-13])
        named = self.hamflow("compare", "halve.toml", "--methods", "cg,stv4", "--set", "method.name=stv4").stderr
        self.assertNotIn("method.name is set to", named)
        # A key that is misspelt is no key that another method does without.
        wrong = self.hamflow("compare", "halve.toml", "--methods", "cg,stv4", "--set", "method.tolerence=1e-3", status=2).stderr
        for name in ("cg", "stv4"):
            self.assertIn(f"found '{name}'; method.tolerence: found an unknown key", wrong)
        # What is measured beside each step is not compared, and would be in the times.
        measured = self.hamflow("compare", "halve.toml", "--methods", "gauss(2),gauss(2,iteration=fixed-point)", "--dt", "0.2",
                                "--set", "method.diagnostics=true")
        self.assertIn("method.diagnostics of --set is not used by gauss(2), gauss(2,iteration=fixed-point): a comparison "
                      "does not show it", measured.stderr)
        # The file's own method need not fit, and what is wrong is told with the method that would take it.
        self.hamflow("compare", "halve.toml", "--methods", "cg(1,5)", "--set", "method.stages=99")
        wrong = self.hamflow("compare", "halve.toml", "--methods", "cg,stv4", "--set", "method.max_iterations=0", status=2)
        self.assertIn("max_iterations", wrong.stderr)


if __name__ == "__main__":
    unittest.main()

"""hamflow compare: files and tables, progress, stops, and what it says beside walls and without a reference."""

import csv
import decimal
import json
import os
import pty
import re
import signal
import subprocess
import unittest
import xml.etree.ElementTree

from command import HAMFLOW, until_it_works
from test_compare import CompareCase


class CompareFiles(CompareCase):
    def test_lattice(self):
        c = self.compare("henon.toml", "--methods", "stv4", "--set", "run.arithmetic=lattice", "--dt", "0.1,0.05")
        self.assertAlmostEqual(self.slopes(c["rows"], "error")[0], 4, delta=0.3)

    def test_files(self):
        done = self.hamflow("compare", "henon.toml", "--methods", "verlet,cg(1,2)", "--out", "o", "--csv", "t.csv", "--figure",
                            "f.svg", "--json")
        c = json.loads(done.stdout)
        self.assertEqual(json.loads((self.folder / "o" / "compare.json").read_text()), c)
        rows = list(csv.DictReader((self.folder / "t.csv").read_text().splitlines()))
        self.assertEqual([r["method"] for r in rows], [r["method"] for r in c["rows"]])
        self.assertEqual([float(r["error"]) for r in rows], [r["error"] for r in c["rows"]])
        self.assertEqual((self.folder / "o" / "compare.csv").read_text(), (self.folder / "t.csv").read_text())
        drawn = xml.etree.ElementTree.parse(self.folder / "f.svg").getroot()
        text = "".join(drawn.itertext())
        for word in ("cg(1,2)", "verlet", "order 2", "evaluations", "seconds", "henon-heiles"):
            self.assertIn(word, text)
        for extension in ("svg", "pdf", "png"):
            self.assertGreater((self.folder / "o" / "figures" / f"work-precision.{extension}").stat().st_size, 1000)
        self.hamflow("compare", "henon.toml", "--methods", "verlet", "--out", "o", status=3)
        self.hamflow("compare", "henon.toml", "--methods", "verlet", "--out", "o", "--force")
        self.hamflow("compare", "henon.toml", "--methods", "verlet", "--out", "none")

    def test_a_file_that_cannot_be_written_leaves_one_json_text(self):
        (self.folder / "f.svg").mkdir()
        few = ["henon.toml", "--set", "run.steps=4", "--json"]
        for words in ([*few, "--methods", "verlet", "--csv", "f.svg"], [*few, "--methods", "verlet", "--figure", "f.svg"]):
            done = self.hamflow("compare", *words, status=3)
            self.assertEqual(json.loads(done.stdout)["status"], "done")
            self.assertIn("error: ", done.stderr)
        done = self.hamflow("sweep", *few, "--vary", "run.dt=0.1,0.2", "--out", "none", "--figure", "f.svg", status=3)
        self.assertEqual(json.loads(done.stdout)["status"], "done")

    def test_notes_of_several_methods(self):
        done = self.hamflow("compare", "kepler.toml", "--methods", "cg(2,6),cg(2,6,tolerance=1e-3),cg(2,7,tolerance=1e-3)",
                            "--dt", "0.2")
        self.assertRegex(done.stderr, r"method.quadrature is not used by .*: their names contain it\n")
        sets = ("--set", "method.tolerance=1e-5", "--set", "run.steps=4")
        done = self.hamflow("compare", "kepler.toml", "--methods", "dop853,taylor", "--dt", "0.1", *sets)
        self.assertIn("not used by dop853, taylor: their rows have the default, unless their names contain it", done.stderr)
        done = self.hamflow("compare", "kepler.toml", "--methods", "dop853", "--dt", "0.1,0.2", *sets)
        self.assertIn("not used by dop853: it differs between its rows, unless its name contains it", done.stderr)

    def test_a_run_of_no_time_is_told_where_it_stands(self):
        self.write("still.toml", (self.folder / "henon.toml").read_text().replace("steps=100", "steps=0"))
        done = self.hamflow("compare", "still.toml", "--methods", "verlet", "--json", status=2)
        (error,) = json.loads(done.stdout)["errors"]
        self.assertEqual((error["file"], error["key"]), ("still.toml", "run.steps"))
        self.assertGreater(error["line"], 0)

    def test_a_motion_without_errors(self):
        """At rest every method is exact: nobody is the cheapest on the way to an error that nobody makes."""
        self.write("rest.toml", "[problem]\nname='harmonic'\ninitial={q=[0],p=[0]}\n"
                   "[method]\nname='rk4'\n[run]\ndt=0.05\nsteps=100\n")
        rest = ("compare", "rest.toml", "--methods", "verlet,rk4")
        c = self.compare(*rest[1:])
        self.assertEqual(c["winners"], [])
        for row in c["rows"]:
            self.assertEqual((row["error"], "below_uncertainty" in row), (0, False))
        text = self.hamflow(*rest, "--out", "o").stdout
        self.assertNotRegex(text, "<|fewest evaluations|1e-100000")
        self.assertFalse((self.folder / "o" / "figures").exists())
        self.assertIn("no error to draw", self.hamflow(*rest, "--figure", "f.svg", status=3).stderr)

    def drawn(self, *arguments):
        self.hamflow("compare", *arguments, "--figure", "f.svg", "--quiet")
        return (self.folder / "f.svg").read_text()

    def test_the_figure_shows_the_errors_of_large_motions_and_tells_what_it_leaves_out(self):
        self.write("large.toml", "[problem]\nname='harmonic'\ninitial={q=[1e9],p=[0]}\n"
                   "[method]\nname='verlet'\n[run]\ndt=0.1\nsteps=100\n")
        large = self.drawn("large.toml", "--methods", "verlet,stv4,rk4", "--dt", "0.2,0.1,0.05")
        small = self.drawn("large.toml", "--methods", "verlet,stv4,rk4", "--dt", "0.2,0.1,0.05", "--set", "problem.initial.q[0]=1")
        self.assertEqual(large.count("<use xlink:href="), small.count("<use xlink:href="))
        self.assertNotIn("above the axis", large)
        # Euler multiplies the energy by 10^9 with its longest step, and is shown with its best.
        euler = self.drawn("large.toml", "--methods", "euler,verlet", "--dt", "0.5,0.25,0.125", "--set", "run.steps=1000",
                           "--set", "problem.initial.q[0]=1")
        self.assertIn("errors above the axis: euler 2 of 3", euler)
        # What cannot be followed is told.
        failed = self.drawn("large.toml", "--methods", "verlet,stv4", "--dt", "25,0.1", "--set", "run.steps=25000",
                            "--set", "problem.initial.q[0]=1")
        self.assertIn("failed: verlet 1 of 2, stv4 1 of 2", failed)

    def test_table(self):
        out = self.hamflow("compare", "henon.toml", "--methods", "verlet,stv4").stdout
        for word in ("reference: ", "evaluations", "relative energy error", "fewest evaluations", "least time"):
            self.assertIn(word, out)

    def test_progress_tells_a_time_left_that_is_a_number(self):
        """On a terminal: runs that are done, and from the first look at every pace on the time left."""
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(self.folder)
            os.execv(HAMFLOW, ["hamflow", "compare", "kepler.toml", "--methods", "verlet,cg(1,4),taylor", "--set",
                               "run.steps=20000", "--dt", "0.1,0.01", "--json"])
        shown = b""
        while True:
            try:
                part = os.read(terminal, 4096)
            except OSError:  # how Linux ends a terminal whose other side is closed
                break
            if not part:
                break
            shown += part
        self.assertEqual(os.waitpid(pid, 0)[1], 0)
        text = shown.decode()
        self.assertNotIn("inf", text)
        self.assertNotIn("nan s", text)
        parts = [float(word) for word in re.findall(r"\]\s+([0-9.]+) %", text)]
        self.assertEqual(parts, sorted(parts))

    def stopped(self, by, *arguments, after=0.3):
        """What a comparison prints that would take hours, stopped by a signal after so many seconds of work."""
        process = subprocess.Popen([HAMFLOW, "compare", *arguments, "--methods", "stv4", "--set", "run.steps=100000000"],
                                   cwd=self.folder, stdout=subprocess.PIPE, text=True)
        until_it_works(process, after)
        process.send_signal(by)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        return out

    def test_ctrl_c(self):
        c = json.loads(self.stopped(signal.SIGINT, "kepler.toml", "--json"))
        self.assertEqual(c["status"], "interrupted")
        self.assertEqual((c["reference"]["kind"], c["rows"]), ("closed form", []))

    def test_trial_steps_of_a_reference_write_nothing(self):
        self.write("double.toml", "[problem]\nname='double-pendulum'\ngravity=10\ninitial={q=[2.0,1.5],p=[0,0]}\n"
                   "[method]\nname='rk4'\n[run]\ndt=0.01\nsteps=3200\n")
        done = self.hamflow("compare", "double.toml", "--methods", "rk4", "--dt", "0.01", "--json")
        self.assertEqual(done.stderr, "")
        self.assertGreater(json.loads(done.stdout)["reference"]["uncertainty"], 1e-3)  # a chaotic motion

    def test_behind_a_fall_into_the_centre_there_is_no_reference(self):
        self.write("fall.toml", "[problem]\nname='central-force'\npotential='kepler'\nmass=1\ninitial={q=[1,0],p=[0,0]}\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.01\nsteps=100\n")
        before = self.compare("fall.toml", "--methods", "stv4", "--dt", "0.01")  # the fall takes pi/sqrt(8)
        self.assertLess(before["rows"][0]["error"], 1e-4)
        done = self.hamflow("compare", "fall.toml", "--methods", "stv4", "--set", "run.steps=300", status=1)
        self.assertRegex(done.stderr, r"no reference solution: the motion cannot be integrated beyond t = (0\.9|1)")

    def test_what_walls_refuse_in_a_run_they_refuse_here(self):
        self.write("wall.toml", "[problem]\nname = 'harmonic'\ninitial = { q = [0], p = [1] }\n"
                   "walls = [{ coordinate = 'q', max = 0.5 }]\n[method]\nname = 'verlet'\n[run]\ndt = 0.1\nsteps = 50\n")
        for method, rule in (("cg(1,5)", "mirror"), ("rk4", "mirror"), ("tao4", "event"), ("tao4", "reject")):
            words = ("--set", f"problem.wall_rule={rule}")
            asked = self.hamflow("run", "wall.toml", "--out", "none", *words, "--set", f"method.name='{method}'", status=2).stderr
            told = self.hamflow("compare", "wall.toml", *words, "--methods", f"verlet,{method}", status=2).stderr
            self.assertIn(f"--methods: error: found '{method}'", told)
            self.assertIn(asked.split('" with ')[1].strip(), told)
        self.hamflow("compare", "wall.toml", "--methods", "verlet,cg(1,5)")

    def test_a_step_that_goes_the_other_way_is_noted(self):
        told = self.hamflow("compare", "kepler.toml", "--methods", "verlet", "--dt", "-0.1").stderr
        self.assertIn("note: dt = -0.1 leads away from t_end = 40; dt = 0.1 is used", told)
        self.assertNotIn("leads away", self.hamflow("compare", "kepler.toml", "--methods", "verlet", "--dt", "-0.1", "--set",
                                                   "run.dt=-0.1").stderr)

    def test_a_comparison_without_a_reference_states_no_uncertainty(self):
        reference = json.loads(self.stopped(signal.SIGTERM, "henon.toml", "--json"))["reference"]
        self.assertEqual((reference["kind"], reference["uncertainty"]), ("none", None))

    def test_a_long_comparison_in_more_digits_stops(self):
        out = self.stopped(signal.SIGTERM, "kepler.toml", "--set", "run.arithmetic=quad", after=1)
        self.assertIn("reference: none", out)
        self.assertNotIn("uncertain by", out)

    def test_a_reference_of_many_bodies_stops_within_a_step(self):
        """Of so many a sub-step takes minutes; it begins long before three seconds of work."""
        self.write("gas.toml", '[problem]\nname = "gas"\nparticles_per_side = 71\ncutoff = 2\n'
                   'container = { kind = "none" }\n[method]\nname = "verlet"\n[run]\ndt = 1e-5\nsteps = 2\n')
        process = subprocess.Popen([HAMFLOW, "compare", "gas.toml", "--methods", "verlet", "--json"], cwd=self.folder,
                                   stdout=subprocess.PIPE, text=True)
        until_it_works(process, 3)
        process.send_signal(signal.SIGTERM)
        out, _ = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(json.loads(out)["status"], "interrupted")

    def test_the_digits_of_a_reference_are_right_to_its_uncertainty(self):
        own = ["--methods", "rk4", "--dt", "0.125", "--set", "run.dt=0.125", "--set",
               "problem.initial={q=[0.0,0.125],p=[0.4375,0.125]}"]
        for t_end in ("0.125", "50"):
            with self.subTest(t_end):
                of = self.compare("henon.toml", *own, "--set", f"run.t_end={t_end}")["reference"]
                more = self.compare("henon.toml", *own, "--set", f"run.t_end={t_end}", "--set",
                                    "run.arithmetic=mp(40)")["reference"]
                with decimal.localcontext(prec=60):
                    for key in ("q", "p"):
                        self.assertEqual([float(x) for x in of["digits"][key]], of[key])
                        for x, y in zip(of["digits"][key], more[key]):
                            self.assertLessEqual(abs(decimal.Decimal(x) - decimal.Decimal(y)), of["uncertainty"])


if __name__ == "__main__":
    unittest.main()

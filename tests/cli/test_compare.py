"""hamflow compare: orders, references, rows, winners; the table, JSON, CSV and the figure say the same."""

import csv
import json
import math
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

from command import HAMFLOW, CommandCase


class Compare(CommandCase):
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
        self.assertEqual(c["rows"][0]["error"], s["exact"]["max_difference"])
        self.assertEqual(c["rows"][0]["max_energy_error"], s["energy"]["max_relative_error"])
        self.assertEqual(c["rows"][0]["evaluations"], s["evaluations"])

    def test_extrapolation_where_there_is_no_closed_form(self):
        c = self.compare("henon.toml", "--methods", "verlet,yoshida6,rk4")
        self.assertEqual(c["reference"]["kind"], "extrapolation")
        self.assertLess(c["reference"]["uncertainty"], 1e-16)
        for first, order in ((0, 2), (12, 4)):
            for slope in self.slopes(c["rows"][first + 1:first + 6], "error"):
                self.assertAlmostEqual(slope, order, delta=0.15)
        for slope in self.slopes(c["rows"][6:11], "error"):
            self.assertAlmostEqual(slope, 6, delta=0.15)
        # A method that is right to rounding agrees with the reference: with compensated sums of 3200 steps the state is
        # rounded once, and every force, h eps |F| apart, walks to less than that.
        fine = self.compare("henon.toml", "--methods", "yoshida6", "--dt", "0.003125", "--set",
                            "run.arithmetic=compensated")
        self.assertLess(fine["rows"][0]["error"], 4 * 2.0**-52)

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
        self.assertEqual(bad["status"], "failed")
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
            (["--methods", "verlet", "--set", "run.steps=0"], "no time"),
        ):
            done = self.hamflow("compare", "henon.toml", *arguments, "--json", status=2)
            self.assertIn(words, done.stderr)
            self.assertEqual(json.loads(done.stdout)["status"], "rejected")
        self.hamflow("compare", "henon.toml", status=2)
        self.hamflow("compare", "missing.toml", "--methods", "verlet", status=3)

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

    def test_table(self):
        out = self.hamflow("compare", "henon.toml", "--methods", "verlet,stv4").stdout
        for word in ("reference: ", "evaluations", "energy error", "fewest evaluations", "least time"):
            self.assertIn(word, out)

    def test_ctrl_c(self):
        process = subprocess.Popen([HAMFLOW, "compare", "kepler.toml", "--methods", "stv4", "--set", "run.steps=100000000",
                                    "--json"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(json.loads(out)["status"], "interrupted")


if __name__ == "__main__":
    unittest.main()

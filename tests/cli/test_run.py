"""What a run says: the summary's keys and numbers, against closed forms where there are some."""

import math
import os
import subprocess
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase

EPSILON = 2.0**-52


class Run(CommandCase):
    def test_start_loads_nothing_that_no_run_needs(self):
        """What the shared HDF5 of Debian reads the web with was a third of the time of a start. Its archive brings none of it."""
        loaded = subprocess.run([HAMFLOW], env={**os.environ, "LD_TRACE_LOADED_OBJECTS": "1"}, capture_output=True, text=True).stdout
        self.assertIn("libc.so", loaded)
        if "libhdf5" in loaded:
            self.skipTest("this system has HDF5 as a shared library only")
        self.assertLess(len(loaded.splitlines()), 25, loaded)
        for name in ("curl", "ssl", "crypto", "krb5", "gnutls"):
            self.assertNotIn(f"lib{name}", loaded)

    def test_summary_keys(self):
        s = self.summary("kepler.toml")
        self.assertEqual(s["status"], "done")
        self.assertEqual(s["problem"], "central-force")
        self.assertEqual(s["method"], "cg(1,5)")
        self.assertEqual(s["arithmetic"], "double")
        self.assertEqual(s["parameters"]["mass"], 2)
        self.assertEqual(s["steps"], 400)
        self.assertEqual(s["final"]["t"], 40)
        self.assertEqual((len(s["final"]["q"]), len(s["final"]["p"])), (2, 2))
        self.assertEqual(set(s["energy"]), {"initial", "final", "max_error", "scale", "max_relative_error"})
        self.assertEqual(set(s["evaluations"]), {"force", "gradient", "hessian", "linear_solves"})
        self.assertEqual(set(s["newton"]), {"min", "mean", "max", "stagnated"})
        self.assertEqual(s["events"], {})
        self.assertNotIn("error", s)

    def test_energies_of_the_conics(self):
        for name, energy in (("circle", -0.25), ("ellipse", -0.25), ("parabola", 0.0), ("hyperbola", 0.25)):
            s = self.summary(str(EXAMPLES / f"kepler_{name}.toml"))
            scale = s["energy"]["scale"]
            # The start rounds l and p once each; the walk of n rounding errors grows as sqrt(n).
            self.assertLess(abs(s["energy"]["initial"] - energy), 4 * EPSILON * scale, name)
            self.assertLess(s["energy"]["max_error"], 4 * EPSILON * scale * math.sqrt(s["steps"]), name)

    def test_numbers_as_text_and_set(self):
        a = self.summary("kepler.toml", "--set", 'run.dt="1/10"', "--set", 'problem.mass="4/2"')
        b = self.summary("kepler.toml")
        self.assertEqual(a["final"], b["final"])
        c = self.summary("kepler.toml", "--set", "run.dt=0.05", "--set", "run.steps=800")
        self.assertNotEqual(c["final"], b["final"])
        self.assertEqual(c["final"]["t"], 40)

    def test_velocities_and_state(self):
        a = self.summary("kepler.toml", "--set", "problem.initial={q=[1,0],p=[0,1.5]}")
        b = self.summary("kepler.toml", "--set", "problem.initial={q=[1,0],v=[0,0.75]}")
        self.assertEqual(a["final"], b["final"])
        self.assertEqual(a["invariants"]["angular_momentum"]["initial"], 1.5)

    def test_direction(self):
        a = self.summary("kepler.toml")["final"]
        b = self.summary("kepler.toml", "--set", "problem.orbit.direction=-1")["final"]
        self.assertEqual([a["q"][0], -a["q"][1], -a["p"][0]], [b["q"][0], b["q"][1], -b["p"][0]])

    def test_steps_zero_and_backwards(self):
        s = self.summary("kepler.toml", "--set", "run.steps=0")
        self.assertEqual(s["final"]["q"], [1, 0])
        back = self.summary("kepler.toml", "--set", "run.dt=-0.1")
        self.assertEqual(back["final"]["t"], -40)

    def test_cost_of_splittings(self):
        for method, forces in (("verlet", 401), ("verlet-dkd", 400), ("stv4", 1201), ("yoshida6", 2801), ("rk4", 1600)):
            s = self.summary("kepler.toml", "--set", f"method={{name='{method}'}}")
            self.assertEqual(s["evaluations"]["force"], forces, method)
            self.assertIsNone(s["newton"])

    def test_recording_changes_nothing(self):
        final = self.summary("kepler.toml")["final"]
        for every in (1, 7, 1000):
            self.hamflow("run", "kepler.toml", "--force", "--set", f"run.record_every={every}", "--set",
                         "output.formats=['csv','h5']")
            lines = (self.folder / "kepler.run" / "trajectory.csv").read_text().splitlines()
            self.assertEqual(len(lines) - 1, 400 // every + 1 + (1 if 400 % every else 0))
            last = [float(x) for x in lines[-1].split(",")]
            self.assertEqual(last[0], 400)
            self.assertEqual(last[2:6], final["q"] + final["p"])

    def test_newton_that_cannot_converge(self):
        done = self.hamflow("run", "kepler.toml", "--set", "run.dt=30", "--json", status=1)
        import json
        s = json.loads(done.stdout)
        self.assertEqual(s["status"], "failed")
        self.assertEqual(s["error"]["kind"], "not_converged")
        self.assertEqual(s["error"]["step"], s["steps"] + 1)
        self.assertIn("step", s["error"]["message"])
        self.assertIn("residual", s["error"]["details"])
        self.assertIn("dt", s["error"]["hint"])
        self.assertTrue((self.folder / "kepler.run" / "summary.json").exists())
        halved = self.summary("kepler.toml", "--set", "run.dt=30", "--set", "run.steps=1", "--set",
                              "method.on_divergence=halve")
        self.assertEqual(halved["events"], {"halved": 1})

    def test_lattice_overflow_and_not_finite(self):
        s = self.summary("kepler.toml", "--set", "method={name='stv4'}", "--set", "run.arithmetic=lattice", "--set",
                         "problem.orbit={kind='hyperbola',r_per=1,angular_momentum=1e3}", "--set", "run.steps=100000",
                         "--set", "run.lattice={position='2^-52', momentum='2^-40'}", status=1)
        self.assertEqual(s["error"]["kind"], "lattice_overflow")
        self.assertLess(max(abs(x) for x in s["final"]["q"]), 1024)  # 2^62 units
        self.assertGreater(max(abs(x) for x in s["final"]["q"]), 950)  # 50 a step
        s = self.summary("kepler.toml", "--set", "problem={name='henon-heiles',initial={q=[3,3],p=[0,0]}}", "--set",
                         "method={name='verlet'}", status=1)
        self.assertEqual(s["error"]["kind"], "non_finite")
        self.assertTrue(all(math.isfinite(x) for x in s["final"]["q"] + s["final"]["p"]))

    def test_list_and_show(self):
        names = self.hamflow("list", "methods", "--all").stdout
        for name in ("euler", "euler-a", "euler-b", "verlet", "verlet-dkd", "stv4", "stv4-dkd", "suzuki4", "yoshida6",
                     "rk4", "cg"):
            self.assertRegex(names, rf"(?m)^{name} ")
            self.hamflow("show", name)
        problems = self.hamflow("list", "problems").stdout
        for name in ("central-force", "harmonic", "henon-heiles", "pendulum", "lennard-jones-oscillator"):
            self.assertRegex(problems, rf"(?m)^{name} ")
            self.assertIn("H = ", self.hamflow("show", name).stdout)


if __name__ == "__main__":
    unittest.main()

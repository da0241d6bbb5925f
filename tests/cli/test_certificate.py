"""The certificate of a run and of a method: what is known to drift, to walk, to stay and to come back."""

import json
import unittest

from command import EXAMPLES, CommandCase

EPSILON = 2.0**-52


class Certificate(CommandCase):
    def certificate(self, method, *sets, steps=200000, dt=0.1, scenario="kepler.toml"):
        s = self.summary(scenario, "--set", f"method={method}", "--set", f"run.steps={steps}", "--set", f"run.dt={dt}",
                         *(x for pair in sets for x in ("--set", pair)))
        return s["certificate"], s

    def test_keys(self):
        c, s = self.certificate("{name='stv4'}", steps=4000)
        self.assertEqual(set(c), {"drift", "reason", "p_value", "sign_p_value", "growth_exponent",
                                  "growth_uncertainty", "blocks", "mean_increment", "mean_increment_error",
                                  "energy_level", "momentum_maps", "reversal_distance"})
        self.assertGreaterEqual(c["blocks"], 128)
        self.assertEqual(c["energy_level"], s["energy"]["max_relative_error"])
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["max_error"],
                         s["invariants"]["angular_momentum"]["max_error"])
        self.assertEqual(c["reversal_distance"]["steps"], 20)
        self.assertIn("certificate", self.hamflow("run", "kepler.toml", "--out", "none").stdout)
        self.hamflow("run", "kepler.toml", "--quiet")
        written = json.loads((self.folder / "kepler.run" / "summary.json").read_text())
        self.assertEqual(written["certificate"]["blocks"], 200)

    def test_symplectic_methods_are_bounded(self):
        for method in ("euler-a", "verlet", "stv4", "yoshida6"):
            c, _ = self.certificate(f"{{name='{method}'}}")
            self.assertEqual(c["drift"], "bounded", method)
            self.assertLess(c["growth_exponent"], 0.3, method)
            self.assertGreater(c["p_value"], 1e-4, method)
            self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "to rounding", method)

    def test_the_rest_drifts(self):
        self.write("pendulum.toml", "[problem]\nname='pendulum'\ninitial={q=[2.5],p=[0]}\n[method]\nname='rk4'\n"
                   "[run]\ndt=0.1\nsteps=1\n")
        for scenario in ("kepler.toml", "pendulum.toml"):
            for method in ("euler", "rk4"):
                c, _ = self.certificate(f"{{name='{method}'}}", scenario=scenario)
                self.assertEqual(c["drift"], "linear", (scenario, method))
        c, _ = self.certificate("{name='rk4'}")
        self.assertGreater(c["growth_exponent"], 0.9)
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "not")

    def test_rounding_alone_walks(self):
        # With dt = 1e-4 stv4's own error, some 1e-6 (dt/0.1)^4 of the scale, is 1e-18.
        c, s = self.certificate("{name='stv4'}", steps=1000000, dt=1e-4)
        self.assertEqual(c["drift"], "random walk")
        self.assertLess(c["energy_level"], 16 * EPSILON * s["steps"] ** 0.5)

    def test_the_element_loses_angular_momentum_in_cartesian_coordinates(self):
        c, _ = self.certificate("{name='cg', quadrature=5}", steps=20000)
        self.assertEqual(c["momentum_maps"]["angular_momentum"]["conserved"], "not")
        self.assertIn(c["drift"], ("bounded", "random walk"))
        polar, _ = self.certificate("{name='cg', quadrature=5}", "problem.coordinates=polar", steps=2000)
        self.assertEqual(polar["momentum_maps"]["angular_momentum"],
                         {"max_error": 0, "relative": 0, "conserved": "to rounding",
                          "rounding": polar["momentum_maps"]["angular_momentum"]["rounding"]})

    def test_return(self):
        exact, _ = self.certificate("{name='stv4'}", "run.arithmetic=lattice", steps=20000)
        self.assertEqual(exact["reversal_distance"], {"steps": 100, "distance": 0, "relative": 0, "bit_exact": True})
        near, _ = self.certificate("{name='stv4'}", steps=20000)
        self.assertFalse(near["reversal_distance"]["bit_exact"])
        # 600 kicks and drifts there and back, each rounded once; a perturbation grows like the time, 10, at most tenfold.
        self.assertLess(near["reversal_distance"]["relative"], 600 * EPSILON * 10)
        far, _ = self.certificate("{name='rk4'}", steps=20000)
        self.assertGreater(far["reversal_distance"]["relative"], 1e-8)

    def test_short_runs_have_no_class(self):
        for steps in (0, 1, 31):
            c, _ = self.certificate("{name='stv4'}", steps=steps)
            self.assertIsNone(c["drift"], steps)
            self.assertIn("32", c["reason"])
            self.assertIsNone(c["p_value"])
            self.assertEqual(c["reversal_distance"] is None, steps == 0)
        c, _ = self.certificate("{name='stv4'}", steps=32)
        self.assertIsNotNone(c["drift"])

    def test_it_watches_and_changes_nothing(self):
        # Recording at every step takes one step at a time, as the certificate does at first.
        a = self.summary("kepler.toml", "--set", "method={name='stv4'}", "--set", "run.steps=5000")
        self.hamflow("run", "kepler.toml", "--quiet", "--set", "method={name='stv4'}", "--set", "run.steps=5000", "--set",
                     "run.record_every=1")
        b = json.loads((self.folder / "kepler.run" / "summary.json").read_text())
        for key in ("final", "energy", "invariants", "evaluations", "certificate"):
            self.assertEqual(a[key], b[key], key)

    def test_resumed_runs_have_the_certificate_of_whole_ones(self):
        self.write("stv4.toml", "[problem]\nname='henon-heiles'\ninitial={q=[0.1,-0.2],p=[0.3,0.1]}\n"
                   "[method]\nname='stv4'\n[run]\ndt=0.1\nsteps=5000\n")
        self.hamflow("run", "stv4.toml", "--quiet", "--set", "run.steps=777")
        part = json.loads(self.hamflow("run", "stv4.toml", "--json", "--quiet", "--resume").stdout)
        self.assertEqual(part["certificate"], self.summary("stv4.toml")["certificate"])

    def test_failed_runs_are_certified_as_far_as_they_went(self):
        s = self.summary("kepler.toml", "--set", "problem={name='henon-heiles',initial={q=[3,3],p=[0,0]}}", "--set",
                         "method={name='verlet'}", "--set", "run.dt=0.001", "--set", "run.steps=100000", status=1)
        self.assertIn("certificate", s)
        self.assertEqual(s["certificate"]["momentum_maps"], {})

    def test_momentum_maps_of_several_bodies(self):
        s = self.summary(str(EXAMPLES / "figure_eight.toml"), "--set", "method={name='stv4'}")
        maps = s["certificate"]["momentum_maps"]
        self.assertEqual(set(maps), {"angular_momentum", "linear_momentum", "centre_of_mass"})
        for name, found in maps.items():
            self.assertEqual(found["conserved"], "to rounding", name)
        # Judged by what the problem declares of its terms, whether or not it has masses among its parameters.
        s = self.summary(str(EXAMPLES / "solar_system.toml"))
        maps = s["certificate"]["momentum_maps"]
        self.assertEqual({name: found["conserved"] for name, found in maps.items()},
                         {"angular_momentum": "to rounding", "linear_momentum": "to rounding",
                          "centre_of_mass": "to rounding"})

    def test_of_methods(self):
        answer = json.loads(self.hamflow("verify", "stv4", "rk4", "cg(1,5)", "--json").stdout)
        found = {m["method"]: m["certificate"] for m in answer["methods"]}
        kept = {method: {(m["problem"], m["name"]): m["conserved"] for m in c["momentum_maps"]}
                for method, c in found.items()}
        self.assertEqual(set(kept["stv4"].values()), {"to rounding"})
        for method in ("rk4", "cg(1,5)"):
            self.assertEqual(kept[method]["central-force", "angular_momentum"], "not")
            self.assertEqual(kept[method]["n-body", "angular_momentum"], "not")
            self.assertEqual(kept[method]["n-body", "linear_momentum"], "to rounding")
        self.assertEqual({m: c["drift"] for m, c in found.items()},
                         {"stv4": "bounded", "rk4": "linear", "cg(1,5)": "random walk"})
        self.assertLess(found["stv4"]["reversal_distance"][0]["relative"], 1e-11)
        self.assertGreater(found["rk4"]["reversal_distance"][0]["relative"], 1e-6)
        self.assertIn("certificates", self.hamflow("verify", "verlet").stdout)

    def test_of_methods_on_a_problem_of_choice(self):
        answer = json.loads(self.hamflow("verify", "rk4", "--problem", "magnetic", "--json").stdout)
        maps = answer["methods"][0]["certificate"]["momentum_maps"]
        kept = {(m["problem"], m["name"]): m["conserved"] for m in maps}
        self.assertEqual(kept["magnetic", "parallel_momentum"], "to rounding")
        self.assertEqual(kept["magnetic", "angular_momentum"], "not")
        # Without a variant the problem is the one of a scenario, or the first that the method can run on.
        self.hamflow("verify", "stv4", "cg(1,5)", "--problem", "double-pendulum", "--json")


if __name__ == "__main__":
    unittest.main()

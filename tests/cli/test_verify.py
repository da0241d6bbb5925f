"""hamflow verify: exit 0 when every claim agrees with its measurement, 2 for a wrong request; the table and the JSON."""

import json
import signal
import subprocess
import unittest

from command import HAMFLOW, CommandCase, until_it_works


class Verify(CommandCase):
    def test_ctrl_c(self):
        for asked in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([HAMFLOW, "verify", "--all"], cwd=self.folder, stdout=subprocess.DEVNULL)
            until_it_works(process)
            process.send_signal(asked)
            self.assertEqual(process.wait(timeout=10), 130)

    def test_ctrl_c_says_what_is_there(self):
        process = subprocess.Popen([HAMFLOW, "verify", "--all", "--json"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        until_it_works(process, 1)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=10)
        self.assertEqual(process.returncode, 130)
        answer = json.loads(out)
        self.assertEqual(answer["status"], "interrupted")
        names = [m["name"] for m in json.loads(self.hamflow("list", "methods", "--json").stdout)]
        for method in answer["methods"]:
            self.assertIn(method["method"].split("(")[0], names)

    def test_what_is_measured_of_an_adaptive_method_is_named(self):
        answer = json.loads(self.hamflow("verify", "taylor", "--problem", "henon-heiles", "--json").stdout)
        self.assertEqual(answer["methods"][0]["measured_as"], "taylor(order=8,step_control=fixed)")
        self.assertNotIn("measured_as", json.loads(self.hamflow("verify", "verlet", "--json").stdout)["methods"][0])

    def test_ctrl_c_where_nothing_can_be_written(self):
        with open("/dev/full", "w") as full:
            process = subprocess.Popen([HAMFLOW, "verify", "--all", "--json"], cwd=self.folder, stdout=full,
                                       stderr=subprocess.PIPE, text=True)
        until_it_works(process)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=10)
        self.assertEqual((process.returncode, said), (3, "error: cannot write to standard output\n"))

    def test_table_of_claims_and_measurements(self):
        out = self.hamflow("verify", "stv4", "cg(1,5)").stdout
        self.assertIn("claimed / measured", out)
        row = next(line for line in out.splitlines() if line.startswith("stv4"))
        self.assertIn("4 / 4.00", row)
        self.assertTrue(row.endswith("agrees"), row)
        for problem in ("pendulum", "henon-heiles"):
            self.assertIn(problem, out)

    def test_where_a_method_is_exact_no_order_is_told(self):
        answer = json.loads(self.hamflow("verify", "cg(1,1)", "--problem", "free-fall", "--json").stdout)["methods"][0]
        (measured,) = answer["measurements"]
        self.assertEqual((measured["order"]["points"], measured["order"]["slope"]), (0, None))
        self.assertIn("exact here", measured["order"]["reason"])
        order = next(p for p in answer["properties"] if p["property"] == "order")
        self.assertEqual(order["measured"], "exact")
        self.assertIn("cannot be measured", order["reason"])
        text = self.hamflow("verify", "cg(1,1)", "--problem", "free-fall").stdout
        self.assertIn("2 / exact", text)
        self.assertRegex(text, r"properties that were not fully measured(.|\n)*order +all errors are at rounding level")

    def test_json_has_every_property_and_problem(self):
        answer = json.loads(self.hamflow("verify", "rk4", "--json").stdout)
        (method,) = answer["methods"]
        self.assertEqual(method["method"], "rk4")
        self.assertTrue(method["agrees"])
        found = {p["property"]: p["measured"] for p in method["properties"]}
        self.assertEqual(found["symplectic"], "no")
        self.assertEqual(found["energy conserving"], "no")
        self.assertEqual([m["problem"] for m in method["measurements"]], ["pendulum", "henon-heiles"])
        for measurement in method["measurements"]:
            self.assertAlmostEqual(measurement["order"]["slope"], 4, delta=0.15)
            self.assertEqual(measurement["energy"]["drift"], "linear")

    def test_one_problem(self):
        answer = json.loads(self.hamflow("verify", "verlet", "--problem", "central-force", "--json").stdout)
        self.assertEqual([m["problem"] for m in answer["methods"][0]["measurements"]], ["central-force"])

    def measured(self, method, problem=None):
        """Of a method that does not agree."""
        which = ["--problem", problem] if problem else []
        return json.loads(self.hamflow("verify", method, *which, "--json", status=1).stdout)["methods"][0]

    def test_where_no_step_converges_nothing_is_found(self):
        method = self.measured("gauss(2,max_iterations=1)")
        self.assertIsNone(method["agrees"])
        for cell in method["properties"]:
            if cell["claimed"] == "-":
                continue
            self.assertIsNone(cell["agrees"], cell)
            self.assertIn(cell["measured"], ("unclear", "-"))
            self.assertRegex(cell["reason"], "a step failed|steps failed")
        for measurement in method["measurements"]:
            self.assertIsNone(measurement["order"]["slope"])
            self.assertIn("a step failed with 13 of 13 step sizes", measurement["order"]["reason"])
            self.assertEqual(measurement["energy"]["drift"], "undecided")
            for number in ("level", "fine_level", "p_value", "growth_exponent"):
                self.assertIsNone(measurement["energy"][number], number)
            self.assertIsNone(measurement["cost"]["linear_solves"])
            for which in ("symplectic", "symmetric", "reversible", "weakly_reversible", "jacobian"):
                self.assertEqual(measurement[which]["holds"], "unclear")
                self.assertIn("from 8 of 8 states", measurement[which]["reason"])
        self.assertEqual(method["certificate"]["drift"], "undecided")
        maps = method["certificate"]["momentum_maps"]
        self.assertEqual(len(maps), 4)
        for kept in maps:
            self.assertEqual((kept["steps"], kept["conserved"], kept["max_error"]), (0, "undecided", None))
            self.assertIn("Newton did not converge", kept["reason"])
        text = self.hamflow("verify", "gauss(2,max_iterations=1)", status=1).stdout
        self.assertIn("unclear: order, explicit, symplectic", text)
        self.assertIn("properties that were not fully measured", text)
        self.assertNotRegex(text, r"DIFFERS|\b(inf|nan)\b|/ 0\.00")

    def test_where_finer_steps_fail_no_level_and_no_jacobian_are_told(self):
        done = subprocess.run([HAMFLOW, "verify", "cg(1,criterion=seed)", "--problem", "pendulum"], capture_output=True,
                              text=True, timeout=120)
        self.assertNotRegex(done.stdout, r"\binf\b|e-3[12]\d")

    def test_a_run_that_leaves_the_finite_numbers(self):
        """Explicit steps never fail: their energy is not kept. What else was measured of such a run decides nothing."""
        (method,) = json.loads(self.hamflow("verify", "tao2(1e6)", "--problem", "pendulum", "--json").stdout)["methods"]
        (energy,) = [p for p in method["properties"] if p["property"] == "energy conserving"]
        self.assertEqual((energy["claimed"], energy["measured"], energy["agrees"]), ("no", "no", True))
        (measurement,) = method["measurements"]
        self.assertEqual((measurement["energy"]["drift"], measurement["energy"]["level"]), ("linear", None))
        self.assertIn("not finite", measurement["energy"]["reason"])
        (ellipse,) = [m for m in method["certificate"]["momentum_maps"] if m["problem"] == "central-force"]
        self.assertEqual(ellipse["conserved"], "undecided")
        self.assertIn("the state was no longer finite after step 8023 of 20000", ellipse["reason"])

    def test_only_whole_runs_and_errors_above_the_bound_say_not_kept(self):
        early = 0
        for name in ("euler", "tao2(1e6)", "cg(2,tolerance=1e-3)", "cg(1,criterion=seed)"):
            done = subprocess.run([HAMFLOW, "verify", name, "--problem", "pendulum", "--json"], capture_output=True,
                                  text=True, timeout=120)
            for kept in json.loads(done.stdout)["methods"][0]["certificate"]["momentum_maps"]:
                if kept["steps"] < 20000:
                    early += 1
                    self.assertEqual(kept["conserved"], "undecided", (name, kept))
                    self.assertIn(f"step {kept['steps']} of 20000", kept["reason"])
                elif kept["conserved"] == "not":
                    self.assertGreater(kept["max_error"], kept["rounding"], (name, kept))
        self.assertGreater(early, 0)

    def test_wrong_requests_name_what_is_meant(self):
        for arguments, words in (
            (["stv5"], "did you mean stv4?"),
            (["verlet", "--problem", "pendulun"], "did you mean pendulum?"),
            (["cg(1,0)"], "quadrature: found '0'; allowed a whole number from 1 to 64"),
            ([], "METHOD"),
        ):
            done = self.hamflow("verify", *arguments, status=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()

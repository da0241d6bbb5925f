"""hamflow verify: exit 0 when every claim agrees with its measurement, 2 for a wrong request; the table and the JSON."""

import json
import signal
import subprocess
import time
import unittest

from command import HAMFLOW, CommandCase


class Verify(CommandCase):
    def test_ctrl_c(self):
        for asked in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([HAMFLOW, "verify", "--all"], cwd=self.folder, stdout=subprocess.DEVNULL)
            time.sleep(0.5)
            process.send_signal(asked)
            self.assertEqual(process.wait(timeout=10), 130)

    def test_ctrl_c_says_what_is_there(self):
        process = subprocess.Popen([HAMFLOW, "verify", "--all", "--json"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=10)
        self.assertEqual(process.returncode, 130)
        answer = json.loads(out)
        self.assertEqual(answer["status"], "interrupted")
        names = [m["name"] for m in json.loads(self.hamflow("list", "methods", "--json").stdout)]
        for method in answer["methods"]:
            self.assertIn(method["method"].split("(")[0], names)

    def test_ctrl_c_where_nothing_can_be_written(self):
        with open("/dev/full", "w") as full:
            process = subprocess.Popen([HAMFLOW, "verify", "--all", "--json"], cwd=self.folder, stdout=full,
                                       stderr=subprocess.PIPE, text=True)
        time.sleep(0.5)
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

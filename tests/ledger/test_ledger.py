"""The ledger sees what changes and is silent about what may: a test of the test.

    python3 test_ledger.py build/release/hamflow
"""

import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import ledger  # noqa: E402
from cases import CASES, SCENARIOS, Case  # noqa: E402


class Ledger(unittest.TestCase):
    def left_by(self, *commands, scenario="kepler"):
        CASES["test"] = Case(scenario, [(command.split(), None) for command in commands])
        try:
            return ledger.carried_out(COMMAND, "test")
        finally:
            del CASES["test"]

    def test_the_last_bit_of_a_number_is_seen(self):
        run = "run s.toml --json --quiet --out r --set run.steps=20 --set problem.mass="
        found = ledger.differing({"": self.left_by(run + "2.0000000000000004")}, {"": self.left_by(run + "2")})[""]
        for part in ("0: final", "0: energy", "r/run.h5 /q", "r/run.h5 /scenario", "r/summary.json "):
            self.assertIn(part, found)
        for part in ("0: exit", "files", "r/run.h5 /t", "0: evaluations"):
            self.assertNotIn(part, found)

    def test_a_column_of_csv_is_seen(self):
        run = "run s.toml --quiet --out r --set output.formats=[\"csv\"] --set run.steps="
        self.assertIn("r/trajectory.csv q1", ledger.differing({"": self.left_by(run + "20")}, {"": self.left_by(run + "21")})[""])

    def test_a_place_is_seen_and_a_sentence_is_not(self):
        one, other = ('{"status": "rejected", "errors": [{"line": %d, "key": "run.dt", "message": "%s"}]}' % x
                      for x in ((1, "found 0"), (1, "0 is not allowed")))
        self.assertEqual(ledger.parts_of_json(one), ledger.parts_of_json(other))
        self.assertNotEqual(ledger.parts_of_json(one), ledger.parts_of_json(one.replace('"line": 1', '"line": 2')))

    def test_times_are_left_out(self):
        parts = ledger.parts_of_json(json.dumps({"status": "done", "wall_seconds": 3, "rows": [{"seconds": 1, "error": 2}]}))
        self.assertEqual(set(parts), {"status", "rows"})
        self.assertNotIn("seconds", "".join(parts["rows"]))

    def test_every_case_is_stored(self):
        self.assertEqual(set(json.loads(ledger.LEDGER.read_text())["cases"]), set(CASES))

    def test_every_scenario_is_used(self):
        self.assertEqual({case.scenario for case in CASES.values()}, set(SCENARIOS))


if __name__ == "__main__":
    COMMAND = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()

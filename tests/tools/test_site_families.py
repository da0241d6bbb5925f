"""The site has the formula of a step for every family of methods."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/site"))
from families import FORMULA, MEASURED_ON  # noqa: E402


class Families(unittest.TestCase):
    def test_every_family_has_a_formula(self):
        listed = subprocess.run([os.environ["HAMFLOW"], "list", "methods", "--json"], check=True, capture_output=True).stdout
        families = {entry["family"] for entry in json.loads(listed)}
        self.assertEqual(families, set(FORMULA))
        self.assertLessEqual(set(MEASURED_ON), families)


if __name__ == "__main__":
    unittest.main()

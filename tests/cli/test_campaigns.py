"""A small part of each campaign of tools/: kills, damage, objects, limits, signals. The whole ones are started by hand."""

import os
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
import campaign_damage  # noqa: E402
import campaign_kills  # noqa: E402
import campaign_limits  # noqa: E402
import campaign_signals  # noqa: E402
from campaign import Campaign  # noqa: E402


class Campaigns(unittest.TestCase):
    def nothing_wrong(self, attack, **arguments):
        with tempfile.TemporaryDirectory() as folder:
            campaign = Campaign(os.environ["HAMFLOW"], folder, os.environ["COMPARE_RUNS"])
            attack.attack(campaign, types.SimpleNamespace(seed=7, **arguments))
            self.assertEqual(campaign.wrong, [])
            self.assertGreater(sum(campaign.counts.values()), 0)

    def test_kills(self):
        self.nothing_wrong(campaign_kills, kills=4)

    def test_damage(self):
        self.nothing_wrong(campaign_damage, every=499, only=[])

    def test_objects(self):
        done = subprocess.run([sys.executable, "-B", TOOLS / "campaign_objects.py", os.environ["HAMFLOW"], "--every", "80"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("wrong: 0", done.stdout)

    def test_limits(self):
        self.nothing_wrong(campaign_limits, steps=3, only=["file-size", "memory", "disk"])

    def test_threads_that_cannot_be_started(self):
        self.nothing_wrong(campaign_limits, steps=9, only=["processes"])

    def test_signals(self):
        self.nothing_wrong(campaign_signals, signals=1)


if __name__ == "__main__":
    unittest.main()

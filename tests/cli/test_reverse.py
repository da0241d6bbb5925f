"""hamflow reverse: what comes back, bit by bit on the lattice, to rounding otherwise, not at all where it cannot."""

import json
import signal
import subprocess
import time
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase


class Reverse(CommandCase):
    def reverse(self, *arguments, status=0):
        return json.loads(self.hamflow("reverse", *arguments, "--json", status=status).stdout)

    def test_every_bit_on_the_lattice(self):
        for method in ("verlet", "verlet-dkd", "stv4", "suzuki4-dkd", "yoshida6"):
            s = self.reverse("kepler.toml", "--set", f"method={{name='{method}'}}", "--set", "run.arithmetic=lattice",
                             "--set", "run.steps=20000")
            self.assertEqual((s["status"], s["method"], s["arithmetic"], s["steps"]), ("done", method, "lattice", 20000))
            self.assertTrue(s["bit_exact"], method)
            self.assertTrue(s["expected_bit_exact"], method)
            self.assertEqual(s["distance"], 0)
            self.assertEqual(s["start"], s["returned"])
            self.assertEqual(s["hash"]["start"], s["hash"]["end"])
            self.assertNotEqual(s["hash"]["start"], s["hash"]["turn"])
            self.assertRegex(s["hash"]["turn"], "^[0-9a-f]{16}$")

    def test_without_a_mirror_image_it_does_not(self):
        s = self.reverse("kepler.toml", "--set", "method={name='euler-a'}", "--set", "run.arithmetic=lattice")
        self.assertFalse(s["expected_bit_exact"])
        self.assertFalse(s["method_reversible"])
        self.assertFalse(s["bit_exact"])
        self.assertGreater(s["relative_distance"], 1e-3)
        self.assertIn("not reversible", s["note"])

    def test_rounding(self):
        s = self.reverse("kepler.toml", "--set", "method={name='stv4'}", "--set", "run.steps=1000")
        self.assertFalse(s["expected_bit_exact"])
        self.assertFalse(s["bit_exact"])
        self.assertTrue(s["method_reversible"])
        # Over 8 periods rounding, 2000 steps of some 6 actions, grows linearly in time.
        self.assertLess(s["relative_distance"], 12000 * 2.0**-52 * 100)
        self.assertNotEqual(s["hash"]["start"], s["hash"]["end"])

    def test_motion_that_negated_momenta_do_not_reverse(self):
        self.write("sextic.toml", "[problem]\nname='sextic'\ninitial={q=[0.6],p=[0.9]}\n[method]\nname='stv4'\n"
                   "[run]\ndt=0.02\nsteps=500\n")
        for arithmetic in ("double", "lattice"):
            s = self.reverse("sextic.toml", "--set", f"run.arithmetic={arithmetic}")
            self.assertFalse(s["expected_bit_exact"])
            self.assertGreater(s["distance"], 1e-2)
            self.assertIn("H(q, -p)", s["note"])

    def test_readable(self):
        out = self.hamflow("reverse", str(EXAMPLES / "pendulum.toml")).stdout
        for word in ("returned q", "distance", "every bit", "hash of the bits", "1000 there, 1000 back"):
            self.assertIn(word, out)

    def test_no_steps(self):
        s = self.reverse("kepler.toml", "--set", "run.steps=0", "--set", "method={name='stv4'}", "--set",
                         "run.arithmetic=lattice")
        self.assertTrue(s["bit_exact"])

    def test_digits_that_come_back_without_every_bit(self):
        """cg carries on what its sums round off: that is part of the bits, and not of q and p."""
        s = self.reverse("kepler.toml", "--set", "run.steps=5", "--set", "run.dt=0.01", "--set", "method={name='cg'}", "--set",
                         "problem={name='henon-heiles', initial={q=[0.2, 0.1], p=[0.3, 0.1]}}")
        self.assertEqual((s["start"] == s["returned"], s["distance"] == 0, s["bit_exact"]), (True, True, False))
        self.assertIn("every digit of q and p came back", s["note"])

    def test_a_distance_below_all_doubles(self):
        s = self.reverse("kepler.toml", "--set", "method={name='stv4'}", "--set", "run.arithmetic=mp(400)", "--set",
                         "run.steps=20")
        self.assertFalse(s["bit_exact"])
        for key in ("distance", "relative_distance"):
            self.assertRegex(s[key], r"^\d\.\d+e-(39|40)\d$")
        text = self.hamflow("reverse", "kepler.toml", "--set", "method={name='stv4'}", "--set", "run.arithmetic=mp(400)",
                            "--set", "run.steps=20").stdout
        self.assertIn(s["distance"], text)

    def test_failures_and_wrong_requests(self):
        s = self.reverse("kepler.toml", "--set", "run.dt=30", status=1)
        self.assertEqual(s["status"], "failed")
        self.assertEqual(s["error"]["kind"], "not_converged")
        self.assertIsNone(s["distance"])
        s = self.reverse("kepler.toml", "--set", "run.arithmetic=lattice", status=2)
        self.assertEqual(s["status"], "rejected")
        self.hamflow("reverse", "missing.toml", status=3)

    def test_ctrl_c(self):
        process = subprocess.Popen([HAMFLOW, "reverse", "kepler.toml", "--json", "--set", "method={name='stv4'}", "--set",
                                    "run.steps=1000000000"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(json.loads(out)["status"], "interrupted")


if __name__ == "__main__":
    unittest.main()

"""hamflow reverse: what comes back, bit by bit on the lattice, to rounding otherwise, not at all where it cannot."""

import json
import random
import re
import shutil
import signal
import subprocess
import time
import unittest

from command import EXAMPLES, HAMFLOW, CommandCase, until, until_it_works


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

    def test_a_defect_below_rounding_is_not_called_its_own(self):
        self.write("pendulum.toml", '[problem]\nname = "formula"\ncoordinates = ["x"]\nmomenta = ["p"]\n'
                   'hamiltonian = "p^2/2 - cos(x)"\ninitial = { q = [2], p = [0] }\n'
                   '[method]\nname = "itoh-abe"\n[run]\ndt = 0.1\nsteps = 50\n')
        near = self.reverse("pendulum.toml")
        self.assertLess(near["digits_lost"], 1)
        if not near["bit_exact"]:
            self.assertRegex(near["note"], "^itoh-abe is not reversible, but this reversal does not show it: distance .*, "
                             "rounding explains up to .*its defect is below this bound")
        far = self.reverse("pendulum.toml", "--set", "method.name=rk4")
        self.assertEqual(far["note"], "rk4 is not reversible: rounding alone does not explain the distance")

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

    def test_what_a_tolerance_does_is_not_called_rounding(self):
        for method, words in (("gauss(2,tolerance=1e-4)", "steps that are solved only to tolerance = 1e-4"),
                              ("gauss(2)", "is reversible, but rounding is not")):
            s = self.reverse("kepler.toml", "--set", f"method={{name='{method}'}}", "--set", "run.steps=20")
            self.assertTrue(s["method_reversible"])
            self.assertIn(words, s["note"])

    def test_readable(self):
        out = self.hamflow("reverse", str(EXAMPLES / "pendulum.toml")).stdout
        for word in ("returned q", "distance", "every bit", "hash of the bits", "1000 forward, 1000 back"):
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
        self.assertIn("every digit of q and p returned", s["note"])

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

    def same(self, a, b):
        self.assertEqual({**a, "wall_seconds": 0}, {**b, "wall_seconds": 0})

    def test_double_double_is_shown_with_its_own_digits(self):
        """Texts that read back exactly have 98 digits where the halves of a number lie far apart; a report has 33."""
        start = 'problem.initial={ q = ["1.0000000000000000000000000000000000000000123", "1/3"], p = ["-1e-20", 0.7] }'
        text = (self.folder / "kepler.toml").read_text().splitlines()
        self.write("dd.toml", "\n".join(line for line in text if not line.startswith("orbit")))
        s = self.reverse("dd.toml", "--set", start, "--set", "method={name='verlet'}", "--set", "run.arithmetic=double-double",
                         "--set", "run.steps=20")
        self.assertEqual(s["start"]["q"][0], "1")
        for state in ("start", "returned"):
            for number in s[state]["q"] + s[state]["p"]:
                self.assertLessEqual(len(re.sub("e.*|[-.]", "", number).lstrip("0")), 33, number)
        self.assertLess(s["relative_distance"], 1e-30)

    def test_killed_and_resumed(self):
        """What comes back is what comes back of a reversal in one go, from whichever half it was killed in."""
        rng = random.Random(5)
        halves = set()
        for method, more in (("stv4", ("run.arithmetic=lattice", "run.steps=600_000")), ("stv4", ("run.steps=1_000_000",)),
                             ("gauss(2)", ("run.steps=30_000", "run.dt=0.05")), ("cg(1,5)", ("run.steps=60_000",)),
                             ("verlet", ("run.arithmetic=double-double", "run.steps=30_000"))):
            sets = [word for text in (f"method={{name='{method}'}}", *more, "run.checkpoint_every=5_000") for word in ("--set", text)]
            begin = time.monotonic()
            whole = self.reverse("kepler.toml", *sets)
            seconds = time.monotonic() - begin
            kills = 0
            while True:
                process = subprocess.Popen([HAMFLOW, "reverse", "kepler.toml", *sets, "--out", "r", "--resume", "--quiet", "--json"],
                                           cwd=self.folder, stdout=subprocess.PIPE, text=True)
                try:
                    out, _ = process.communicate(timeout=rng.uniform(0.1, 0.6) * seconds if kills < 5 else 120)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.communicate()
                    kills += 1
                    continue
                self.assertEqual(process.returncode, 0)
                break
            halves.add(kills)
            self.same(json.loads(out), whole)
            again = self.hamflow("reverse", "kepler.toml", *sets, "--out", "r", "--resume")
            self.assertIn("nothing to do", again.stderr)
            self.assertIn("every bit", again.stdout)
            shutil.rmtree(self.folder / "r")
        self.assertGreater(max(halves), 0, "nothing was killed")

    def test_what_goes_on(self):
        sets = ("--set", "method={name='stv4'}", "--set", "run.checkpoint_every=100", "--out", "r")
        process = subprocess.Popen([HAMFLOW, "reverse", "kepler.toml", *sets, "--json", "--set", "run.steps=100_000_000"],
                                   cwd=self.folder, stdout=subprocess.PIPE, text=True)
        state = self.folder / "r" / "reversal.bin"
        until(state.exists, process)
        first = state.read_bytes()  # of the start
        until(lambda: state.read_bytes() != first, process)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual((process.returncode, json.loads(out)["status"]), (130, "interrupted"))
        self.assertIn("--resume", self.hamflow("reverse", "kepler.toml", *sets, status=3).stderr)
        fewer = self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--set", "run.steps=1", status=2).stderr
        self.assertIn("steps; allowed with --resume at least", fewer)
        other = self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--set", "run.dt=0.2", status=2).stderr
        self.assertIn("run.dt: found 0.2", other)
        self.hamflow("reverse", "kepler.toml", *sets, "--force", "--set", "run.steps=300", "--quiet")
        more = self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--set", "run.steps=301", status=2).stderr
        self.assertIn("allowed with --resume 300, after which the momenta were negated", more)
        (self.folder / "r" / "reversal.bin").unlink()
        self.assertIn("no reversal.bin", self.hamflow("reverse", "kepler.toml", *sets, "--resume", status=3).stderr)
        self.assertIn("--force", self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--force", status=2).stderr)
        self.assertIn("--out DIR", self.hamflow("reverse", "kepler.toml", "--resume", status=2).stderr)

    def test_another_number_of_steps_of_a_short_one(self):
        """One that left no state on the way, but is complete."""
        sets = ("--set", "method={name='stv4'}", "--out", "r")
        self.hamflow("reverse", "kepler.toml", *sets)
        for steps in (401, 4000, 399):
            told = self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--set", f"run.steps={steps}", status=2).stderr
            self.assertIn(f"--set: error: run.steps: found {steps} steps", told)
        told = self.hamflow("reverse", "kepler.toml", *sets, "--resume", "--set", "run.t_end=41", status=2).stderr
        self.assertIn("--set: error: run.t_end: found 410 steps", told)
        self.assertIn("nothing to do", self.hamflow("reverse", "kepler.toml", *sets, "--resume").stderr)

    def test_warnings(self):
        nonsense = ("--set", "method={name='stv4'}", "--set", "run.dt=30", "--set", "run.steps=50")
        done = self.hamflow("reverse", "kepler.toml", *nonsense, "--json", "--quiet")
        warnings = json.loads(done.stdout)["warnings"]
        self.assertEqual([w["kind"] for w in warnings], ["energy_error", "long_step"])
        self.assertEqual(done.stderr.splitlines(), [f"warning: {w['kind']}: {w['message']}" for w in warnings])
        run = self.hamflow("run", "kepler.toml", *nonsense, "--out", "none", "--quiet").stderr
        self.assertEqual([line.split(": ")[1] for line in run.splitlines() if line.startswith("warning")],
                         ["energy_error", "long_step"])
        for again in ((), ("--resume",)):  # also of one that is complete
            kept = self.hamflow("reverse", "kepler.toml", *nonsense, "--out", "r", *again)
            self.assertEqual(kept.stderr.count("warning: "), 2)
        self.assertEqual(self.reverse("kepler.toml", "--set", "method={name='stv4'}")["warnings"], [])
        # H(q, -p) is another H: energies of the way back say nothing.
        self.write("sextic.toml", "[problem]\nname='sextic'\ninitial={q=[0.6],p=[0.9]}\n[method]\nname='stv4'\n"
                   "[run]\ndt=0.02\nsteps=500\n")
        self.assertEqual(self.reverse("sextic.toml")["warnings"], [])
        # A fall into the centre after the turn is none: the way there is what there is.
        self.write("fall.toml", "[problem]\nname='central-force'\npotential='kepler'\ninitial={q=[1,0],p=[0,0]}\n"
                   "[method]\nname='verlet'\n[run]\ndt=0.001\nsteps=900\n")
        self.assertEqual(self.reverse("fall.toml")["warnings"], [])

    def test_warnings_of_one_that_was_stopped(self):
        sets = ("--set", "method={name='stv4'}", "--set", "run.dt=3", "--set",
                "run.steps=2_000_000", "--json")
        whole = json.loads(self.hamflow("reverse", "kepler.toml", *sets).stdout)["warnings"]
        self.assertIn("long_step", [w["kind"] for w in whole])
        process = subprocess.Popen([HAMFLOW, "reverse", "kepler.toml", *sets, "--out", "r"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        until_it_works(process, 0.05)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        on = self.hamflow("reverse", "kepler.toml", *sets, "--out", "r", "--resume")
        self.assertEqual(json.loads(on.stdout)["warnings"], whole)

    def test_ctrl_c(self):
        process = subprocess.Popen([HAMFLOW, "reverse", "kepler.toml", "--json", "--set", "method={name='stv4'}", "--set",
                                    "run.steps=1000000000"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        until_it_works(process)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(json.loads(out)["status"], "interrupted")


if __name__ == "__main__":
    unittest.main()

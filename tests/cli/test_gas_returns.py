"""The gas there and back: what comes back, what no thread, list or interruption changes, and what a certificate proves."""

import json
import math
import signal
import subprocess
import time
import unittest

from command import EXAMPLES, HAMFLOW
from gas_case import GAS, GasCase


class GasReturns(GasCase):
    def test_there_and_back(self):
        s = self.reverse(str(EXAMPLES / "gas_121.toml"), "--set", "run.steps=20")
        self.assertEqual(s["pair_evaluations"], (61 + 61) * 121 * 120 // 2)
        differences = [[a - b for a, b in zip(s["returned"][x], s["start"][x])] for x in ("q", "p")]
        for difference, name in zip(differences, ("position", "momentum")):
            length = math.sqrt(sum(d * d for d in difference))
            self.assertAlmostEqual(s["return_error"][name], length / 121, delta=1e-12 * length)
            self.assertAlmostEqual(s["return_error"][name + "_rms"], length / 11, delta=1e-12 * length)
        self.assertAlmostEqual(s["digits_lost"], math.log10(s["relative_distance"] * 2**53), delta=1e-12)

    def test_pairs_beyond_a_cutoff_are_not_counted_as_computed(self):
        self.write("gas.toml", GAS % "cutoff = 1.4")
        s = self.reverse("gas.toml")
        self.assertIsNone(s["pair_evaluations"])
        self.assertEqual(s["force_evaluations"], 2 * (20 * 3 + 1))
        self.assertIn("; 122 force evaluations\n", self.hamflow("reverse", "gas.toml").stdout)
        self.write("gas.toml", GAS % "")
        self.assertIn(f"; {122 * 16 * 15 // 2} pairs computed\n", self.hamflow("reverse", "gas.toml").stdout)

    def test_a_force_that_jumps_where_pairs_stand(self):
        """Pairs of the lattice start stand at the cut-off to the last bit, and the force jumps by phi'(R)/S there: which
        of two motions takes the kick is a rounding, so that a distance of whole kicks proves nothing. A cut-off between
        the distances, or one whose force is continuous, does prove; and so does a method that is not reversible."""
        def back(cutoff, *sets):
            self.write("gas.toml", GAS % f"cutoff = {cutoff}")
            return self.summary("gas.toml", "--set", "problem.particles_per_side=11", "--set", "run.dt=0.001", "--set",
                                "run.steps=100", "--set", "method={name='verlet'}", *sets)["certificate"]["reversal_distance"]
        for radius in (2, 3):
            found = back(radius)
            jump = (12 / radius**7 - 12 / radius**13) / 10
            self.assertAlmostEqual(found["distance"] / (0.001 * jump) % 1, 0, delta=1e-3)
            self.assertEqual(found["proves"], "nothing")
            self.assertIn("a discontinuous force", found["reason"])
        for cutoff in (2.1, "{ radius = 2, kind = 'force-shifted' }"):
            self.assertEqual(back(cutoff)["proves"], "reversible to rounding", cutoff)
        self.assertEqual(back(2.1, "--set", "method={name='rk4'}")["proves"], "not reversible")

    def test_a_drift_below_the_sum_of_sizes_is_no_conservation(self):
        """Errors of many particles are independent: what the sizes of all add up to is not what rounding does."""
        def kept(method):
            maps = self.summary(str(EXAMPLES / "gas_121.toml"), "--set", "run.dt=0.0005", "--set",
                                f"method={{name='{method}'}}")["certificate"]["momentum_maps"]
            return maps["angular_momentum"]
        for method in ("verlet", "stv4", "suzuki4"):
            found = kept(method)
            self.assertEqual(found["conserved"], "to rounding", method)
            self.assertLess(found["rounding"], 1e-12)
        rk4 = kept("rk4")
        self.assertGreater(rk4["max_error"], rk4["rounding"])
        self.assertIn(rk4["conserved"], ("undecided", "not"))

    def test_the_reversal_of_a_certificate_is_stopped(self):
        """By Ctrl-C: all steps are there, what is left out is said, and --resume makes up for it."""
        self.write("gas.toml", GAS % "")
        command = [HAMFLOW, "run", "gas.toml", "--out", "r", "--json", "--set", "problem.particles_per_side=45", "--set",
                   "run.dt=1e-6", "--set", "run.steps=200"]
        begin = time.monotonic()
        done = subprocess.run([*command, "--force"], cwd=self.folder, capture_output=True, timeout=600, check=True)
        whole = json.loads(done.stdout)
        early, late = 0, time.monotonic() - begin
        for _ in range(16):  # the way there, back, and beside it are more than half of the time
            process = subprocess.Popen([*command, "--force"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
            wait = (early + late) / 2
            time.sleep(wait)
            process.send_signal(signal.SIGINT)
            out = process.communicate(timeout=600)[0]
            s = json.loads(out) if out else {"status": "interrupted", "steps": 0}
            if s["status"] == "interrupted" and s["steps"] == 200:
                break
            early, late = (wait, late) if s["status"] == "interrupted" else (early, wait)
        else:
            self.skipTest("no signal came while the motion was reversed")
        self.assertEqual(process.returncode, 130)
        self.assertIn("the reversal was interrupted before it finished", s["certificate"]["reversal_distance"]["reason"])
        self.assertEqual(s["certificate"]["momentum_maps"]["angular_momentum"]["conserved"], "to rounding")
        self.assertTrue((self.folder / "r/run.h5").exists())
        resumed = json.loads(subprocess.run([*command, "--resume"], cwd=self.folder, capture_output=True, timeout=600,
                                            check=True).stdout)
        self.assertEqual((resumed["status"], resumed["certificate"]), ("done", whole["certificate"]))

    def test_what_counts_no_pairs(self):
        """null, and why: where the count of forces is not all that was asked of the pairs."""
        self.write("gas.toml", GAS % "")
        for method, forces in (("itoh-abe", None), ("chin4a", 2 * (20 * 2) + 2)):
            s = self.reverse("gas.toml", "--set", f"method={{name='{method}'}}")
            self.assertIsNone(s["pair_evaluations"], method)
            self.assertEqual(s["force_evaluations"], forces)
            self.assertIn(method + " evaluates more than forces", s["pair_evaluations_note"])

    def test_every_bit_comes_back(self):
        for keys in ("", 'container = { kind = "none" }', 'container = { kind = "box", size = [2.1, 2.1] }',
                     'cutoff = { radius = 1.6, kind = "smooth", inner = 1.2 }\ncontainer = { kind = "periodic", size = [2.7, 3] }',
                     "cutoff = 1.4", 'pair = "newton"\nsoftening = 0.1'):
            self.write("gas.toml", GAS % keys)
            s = self.reverse("gas.toml", "--set", "run.arithmetic=lattice", "--set", "run.steps=300")
            self.assertTrue(s["bit_exact"] and s["expected_bit_exact"], keys)
            self.assertEqual((s["digits_lost"], s["return_error"]["position"]), (0, 0))
            self.assertEqual(s["hash"]["start"], s["hash"]["end"])
            self.assertNotEqual(s["hash"]["start"], s["hash"]["turn"])

    def test_steps_of_varying_length_on_the_lattice(self):
        varying = ("--set", "method.step_control=reversible", "--set", "run.steps=50")
        for keys in ("", 'pair = "formula"\nphi = "r^-12 - 2*r^-6"', "cutoff = 1.4",
                     'cutoff = 1.2\ncontainer = { kind = "periodic", size = [2.7, 3] }'):
            with self.subTest(keys):
                on_lattice = self.gas(keys, *varying, "--set", "run.arithmetic=lattice")
                double = self.gas(keys, *varying)
                self.assertEqual(on_lattice["method"], "stv4(step_control=reversible)")
                self.assertAlmostEqual(on_lattice["final"]["t"], double["final"]["t"], delta=1e-9)
                self.assertGreater(abs(double["final"]["t"] - 50 * 0.0005), 1e-4)
                s = self.reverse("gas.toml", *varying, "--set", "run.arithmetic=lattice")
                self.assertTrue(s["bit_exact"] and s["expected_bit_exact"])

    def test_threads_change_no_bit(self):
        turns = [self.reverse(str(EXAMPLES / "gas_121.toml"), "--set", "run.arithmetic=lattice", "--set",
                              "run.steps=10", "--set", f"run.threads={n}")["hash"] for n in (1, 2, 4)]
        self.assertEqual(turns[0], turns[1])
        self.assertEqual(turns[0], turns[2])

        ends = [self.summary(str(EXAMPLES / "gas_121.toml"), "--set", "run.steps=10", "--set", f"run.threads={n}")
                for n in (1, 2, 4)]
        self.assertEqual(ends[0]["final"], ends[1]["final"])
        self.assertEqual(ends[0]["final"], ends[2]["final"])
        self.assertEqual(ends[0]["energy"], ends[2]["energy"])
        self.assertIn("order", self.errors('pair = "formula"\nphi = "1/r"', "--set", "run.threads=2"))

    def test_resumed(self):
        """The same bits as in one go, though lists of neighbours are made anew."""
        self.write("gas.toml", GAS % "cutoff = { radius = 1.4, skin = 0.01 }")
        whole = self.summary("gas.toml")
        self.hamflow("run", "gas.toml", "--set", "run.steps=7")
        parts = json.loads(self.hamflow("run", "gas.toml", "--resume", "--json").stdout)
        for key in ("final", "energy", "invariants"):
            self.assertEqual(parts[key], whole[key])
        for arithmetic in ("double", "lattice"):
            ends = [self.summary("gas.toml", "--set", f"problem.cutoff.skin={skin}", "--set", f"run.arithmetic={arithmetic}")
                    for skin in (1e-9, 0.5)]  # lists made at every step, and once
            self.assertEqual(ends[0]["final"], ends[1]["final"])
        lattice = ("--set", "run.arithmetic=lattice")
        whole = self.summary("gas.toml", *lattice)
        self.hamflow("run", "gas.toml", *lattice, "--set", "run.steps=7", "--out", "lattice")
        parts = json.loads(self.hamflow("run", "gas.toml", *lattice, "--resume", "--json", "--out", "lattice").stdout)
        self.assertEqual(parts["final"], whole["final"])

    def test_lists_change_no_bit(self):
        """Those with a skin beyond all distances hold all pairs. stv4 steps back in between."""
        for container in ('{ kind = "none" }', '{ kind = "circle" }', '{ kind = "box", size = [2.1, 2.1] }',
                          '{ kind = "periodic", size = [2.5, 2.5] }'):
            for pair in ("", 'pair = "formula"\nphi = "r^-12 - 2*r^-6"\n'):
                self.write("gas.toml", GAS.replace("per_side = 4", "per_side = 7") %
                           f"{pair}container = {container}\ncutoff = {{ radius = 1.4, skin = 100 }}")
                with self.subTest(container, pair=pair):
                    lattice = ("--set", "run.arithmetic=lattice", "--set", "run.steps=100")
                    all_pairs = self.reverse("gas.toml", *lattice)
                    self.assertTrue(all_pairs["bit_exact"])
                    for skin, threads in ((1e-9, 1), (0.1, 2), (0.3, 4), (1, 1)):
                        skinned = ("--set", f"problem.cutoff.skin={skin}")
                        again = self.reverse("gas.toml", *lattice, *skinned, "--set", f"run.threads={threads}")
                        self.assertEqual(again["hash"], all_pairs["hash"])
                    ends = [self.summary("gas.toml", "--set", f"problem.cutoff.skin={skin}") for skin in (100, 1e-9, 0.3)]
                    for end in ends[1:]:
                        self.assertEqual((end["final"], end["energy"]), (ends[0]["final"], ends[0]["energy"]))

    def test_free_flight_is_rounded_to_one_side(self):
        """Then errors add up like the number of steps: it is not called a drift of the method."""
        self.write("two.toml", """
            [problem]
            name = "gas"
            container = { kind = "none" }
            cutoff = 2
            scale = 1
            initial = { q = [0.704, -0.051, 4.547, 3.652], p = [-0.726, -0.711, 0.5, 0.674] }
            [method]
            name = "verlet"
            [run]
            dt = 0.01
            steps = 1000000
            """)
        maps = self.summary("two.toml")["certificate"]["momentum_maps"]
        self.assertGreater(maps["angular_momentum"]["max_error"], maps["angular_momentum"]["rounding"])
        self.assertEqual([map["conserved"] for map in maps.values() if map["conserved"] == "not"], [])

    def test_many_on_the_lattice(self):
        """An encounter gives a momentum as much as it has: the usual unit of a melt leaves room for that."""
        edge = "(16^3/0.8442)^(1/3)"
        self.write("melt.toml", f"""
            [problem]
            name = "gas"
            particles_per_side = 16
            dimension = 3
            epsilon = 1
            sigma = 1
            scale = "{edge}*15/32"
            masses = "({edge}*15/32)^2/(3*1.44)"
            container = {{ kind = "periodic", size = ["32/15", "32/15", "32/15"] }}
            cutoff = 2.5
            [method]
            name = "verlet"
            [run]
            dt = 0.0195
            steps = 40
            arithmetic = "lattice"
            """)
        self.assertTrue(self.reverse("melt.toml")["bit_exact"])

    def test_kept_states(self):
        h5 = ("reverse", str(EXAMPLES / "gas_corner.toml"), "--set", "run.steps=5", "--out", "kept")
        self.hamflow(*h5)
        self.assertTrue(json.loads((self.folder / "kept/reverse.json").read_text())["bit_exact"])
        self.assertIn("kept", self.hamflow(*h5, status=3).stderr)
        self.hamflow(*h5, "--force")
        import h5py
        with h5py.File(self.folder / "kept/reverse.h5") as file:
            self.assertEqual(list(file["start/q"]), list(file["end/q"]))
            self.assertNotEqual(list(file["start/q"]), list(file["turn/q"]))
            self.assertEqual(file["turn"].attrs["step"], 5)
            self.assertIn("corner", bytes(file["scenario"][()]).decode())


if __name__ == "__main__":
    unittest.main()

"""The gas in boxes: lattices that fill them, particles that overlap, images many edges away."""

import json
import math
import unittest

from command import CommandCase

BOX = """
[problem]
name = "gas"
particles_per_side = 6
%s
container = { kind = "%s", size = [9, 12] }
[method]
name = "verlet"
[run]
dt = 0.001
steps = 100
"""
SIX = """
[problem]
name = "gas"
scale = 1
container = { kind = "periodic", size = [7.3, 7.3] }
cutoff = { radius = 2.5, kind = "force-shifted" }
initial = { q = [0.1, 0.2, 16.9, 1.1, -1.4, 17.2, 2.9, -14.1, -31.8, 3.1, 5.4, 47.2], p = [0.3, 0.7, -0.9, 0.4, 0.8, -0.5, 0.2, 0.9, -0.6, 0.1, 0.5, -0.8] }
[method]
name = "verlet"
[run]
dt = 0.01
steps = 300
"""


class GasBox(CommandCase):
    def test_a_lattice_fills_its_box(self):
        for kind in ("box", "periodic"):
            self.write("box.toml", BOX % ("scale = 1\ncutoff = 2.5", kind))
            start = self.summary("box.toml", "--set", "run.steps=0")["final"]["q"]
            xs, ys = sorted(set(start[0::2])), sorted(set(start[1::2]))
            self.assertEqual(len(xs), 6)
            for found, edge in ((xs, 9), (ys, 12)):
                for i, x in enumerate(found):
                    self.assertAlmostEqual(x, edge * (2 * i - 5) / 12, delta=1e-14)
            self.assertLess(self.summary("box.toml")["energy"]["max_relative_error"], 1e-3)

    def test_per_side_puts_the_nearest_neighbours_one_length_apart(self):
        self.write("box.toml", BOX % ("cutoff = 2.5", "periodic"))
        self.assertAlmostEqual(float(self.summary("box.toml", "--set", "run.steps=0")["parameters"]["scale"]), 6 / 9, delta=1e-15)

    def test_overlapping_particles_are_named(self):
        self.write("box.toml", BOX % ("scale = 0.3\ncutoff = 1", "periodic"))
        warned = self.summary("box.toml", "--set", "run.dt=0.01", status=1)["warnings"]
        told = [w["message"] for w in warned if w["kind"] == "energy_error"]
        self.assertEqual(len(told), 1)
        self.assertIn("particles 1 and 2 start 1.5 apart, but a pair repels within 3.33", told[0])

    def test_nearest_images_are_the_same_on_every_road(self):
        self.write("six.toml", SIX)
        whole = self.summary("six.toml")["final"]
        self.hamflow("run", "six.toml", "--out", "parts", "--set", "run.steps=150")
        self.hamflow("run", "six.toml", "--out", "parts", "--resume", "--set", "run.steps=300")
        self.assertEqual(json.loads((self.folder / "parts/summary.json").read_text())["final"], whole)
        self.assertEqual(self.summary("six.toml", "--set", "problem.cutoff.skin=0.1")["final"], whole)

    def test_no_distance_is_too_many_edges(self):
        self.write("six.toml", SIX)
        near = self.summary("six.toml", "--set", "run.arithmetic=double-double")
        # One particle 3 * 10^6 edges farther away: its images are where they were.
        self.write("far.toml", SIX.replace("[0.1, 0.2,", '["0.1 + 7.3*3000000", 0.2,'))
        far = self.summary("far.toml", "--set", "run.arithmetic=double-double")
        self.assertNotEqual(float(near["final"]["p"][0]), 0.3)
        for a, b in zip(near["final"]["p"], far["final"]["p"]):
            self.assertAlmostEqual(float(a), float(b), delta=1e-20 * 3e6)


if __name__ == "__main__":
    unittest.main()

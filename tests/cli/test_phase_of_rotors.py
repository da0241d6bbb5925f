"""Phase planes of rotors: an angle that has gone round often is folded, and no level curve is drawn too finely."""

import re
import unittest

from command import CommandCase

ROTOR = """
[problem]
name = "pendulum"
initial = { q = [0], p = [3] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 10000
"""
TYPED = """
[problem]
name = "formula"
coordinates = ["q"]
hamiltonian = "p^2/2 - cos(q)"
initial = { q = [0], p = [3] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 10000
"""


class Rotors(CommandCase):
    def drawn(self, text):
        self.write("rotor.toml", text)
        self.hamflow("run", "rotor.toml", "--out", "rotor.run", "--force")
        self.hamflow("plot", "rotor.run", "--kind", "phase", "-o", "phase.svg")
        return (self.folder / "phase.svg").read_text()

    def test_an_angle_is_folded(self):
        svg = self.drawn(ROTOR)
        self.assertIn("mod 2π", re.sub(r"<[^>]*>", "", svg))
        self.assertIn("exact", svg)

    def test_a_swing_is_not(self):
        svg = self.drawn(ROTOR.replace("p = [3]", "p = [1]"))
        self.assertNotIn("mod 2π", re.sub(r"<[^>]*>", "", svg))
        self.assertIn("exact", svg)

    def test_no_level_curve_with_more_waves_than_can_be_drawn(self):
        self.assertNotIn("exact", self.drawn(TYPED))
        self.assertIn("exact", self.drawn(TYPED.replace("steps = 10000", "steps = 100")))


if __name__ == "__main__":
    unittest.main()

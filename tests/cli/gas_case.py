"""What the tests of the gas share: a short scenario, and how it is run."""

import json

from command import CommandCase

GAS = """
[problem]
name = "gas"
particles_per_side = 4
%s
[method]
name = "stv4"
[run]
dt = 0.0005
steps = 20
"""


class GasCase(CommandCase):
    def gas(self, keys="", *arguments, status=0):
        self.write("gas.toml", GAS % keys)
        return self.summary("gas.toml", *arguments, status=status)

    def errors(self, keys, *arguments):
        """What is told of a wrong key, in one text."""
        self.write("gas.toml", GAS % keys)
        return self.hamflow("run", "gas.toml", "--out", "none", *arguments, status=2).stderr

    def reverse(self, scenario, *arguments):
        return json.loads(self.hamflow("reverse", scenario, *arguments, "--json").stdout)

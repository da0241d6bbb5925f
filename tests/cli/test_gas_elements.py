"""eg(k) on gases with a cut-off: the law has branches, and each pair may be on another one, or between two."""

import json
import math
import unittest

from command import CommandCase

GAS = """[problem]
name = "gas"
%s
container = { kind = "none" }
cutoff = %s
[method]
name = "eg(1)"
[run]
dt = 0.004
steps = 50
"""
SIXTEEN = "particles_per_side = 4"
CUTOFFS = {"smooth": '{ radius = 2.2, kind = "smooth", inner = 1.7 }', "shifted": '{ radius = 2.2, kind = "shifted" }',
           "force-shifted": '{ radius = 2.2, kind = "force-shifted" }'}


class CutOff(CommandCase):
    def run_of(self, *sets):
        words = [word for each in sets for word in ("--set", each)]
        return json.loads(self.hamflow("run", "gas.toml", "--json", "--quiet", "--out", "none", *words).stdout)

    def test_nothing_is_felt_beyond_it(self):
        at_rest = "initial = { q = [0, 0, 2.5, 0], p = [0, 0, 0, 0] }"
        self.write("gas.toml", GAS % (at_rest, "2"))
        for k in (1, 2, 3):
            found = self.run_of(f"method.name=eg({k})")
            self.assertEqual((found["final"]["q"], found["final"]["p"]), ([0, 0, 2.5, 0], [0, 0, 0, 0]))

    def test_energy_and_momenta_are_kept_through_it(self):
        """A jump of the force, too, is no more than a difference of energies."""
        for kind, cutoff in CUTOFFS.items():
            self.write("gas.toml", GAS % (SIXTEEN, cutoff))
            for k in (1, 2, 3):
                with self.subTest(f"{kind} eg({k})"):
                    found = self.run_of(f"method.name=eg({k})", "run.steps=250")
                    self.assertLess(found["energy"]["max_relative_error"], 16 * 2**-52)
                    for invariant in ("angular_momentum", "linear_momentum"):
                        self.assertEqual(found["certificate"]["momentum_maps"][invariant]["conserved"], "to rounding")

    def test_orders_where_it_is_smooth(self):
        self.write("gas.toml", GAS % (SIXTEEN, CUTOFFS["smooth"]))

        def end(method, halvings):
            found = self.run_of(f"method.name={method}", f"run.dt={0.004 / 2**halvings!r}", f"run.steps={50 * 2**halvings}")
            return found["final"]["q"] + found["final"]["p"]

        reference = end("kahan-li8", 4)
        for method, order in (("eg(1)", 2), ("eg(2)", 4)):
            one, other = (math.dist(end(method, halvings), reference) for halvings in (0, 1))
            self.assertAlmostEqual(math.log2(one / other), order, delta=0.25)


if __name__ == "__main__":
    unittest.main()

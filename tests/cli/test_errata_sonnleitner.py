"""hamflow reproduce: what is known to be wrong in [Sonnleitner2010] comes out as a verdict, and what is right does too."""

import unittest

from errata import ErrataCase

EXPECTED = {
    # S-C64: five real factors have no order 6; seven have.
    "S-C64/order_6": "cannot hold",
    "S-C64/seven": "holds",
    # S-C24: momenta of generalised coordinates without the masses; right for the T-tube.
    "S-C24/momentum": "cannot hold",
    "S-C24/t_tube": "holds",
    # S2.7: 1/1000 of Runge-Kutta's error is true of the end of a period at dt = 0.001, of nothing else.
    "S2.7/final_0.001": "holds",
    "S2.7/final_0.0005": "differs",  # in double it is rounding
    "S2.7/largest_0.001": "differs",
    "S2.7/stv4_final_0.001": "holds",
    "S2.7/stv4_largest_0.001": "cannot hold",
    # Found beyond the errata.
    "S-C17/past": "cannot hold",
    "S-C55/third": "cannot hold",
    "S-C107/kinetic": "cannot hold",
    "S-C102/sign": "cannot hold",
    "S-C41/conserves": "cannot hold",
    # S-T81: the rows of 121 do not follow from their own columns, but for one that may, if its power of ten is a rounded
    # one; those of 441 do, but for 800 steps.
    **{f"S-T81/columns_{row}": "cannot hold" for row in ("121_200", "121_800", "121_1200", "441_800")},
    "S-T81/columns_121_400": "undecided",
    **{f"S-T81/columns_{row}": "holds" for row in ("441_200", "441_400", "441_1200")},
    "S-T81/digits": "cannot hold",
    # S3.3: a map that sets crossers to (0, 0) is not one-to-one.
    "S3.3/one_to_one": "cannot hold",
    "S3.3/returns_0.001_per-side": "holds",
    # S3.2: with the text's step length a particle passes the wall within tens of steps.
    "S3.2/inside_0.01_per-side": "cannot hold",
    "S3.2/returns_per-side": "holds",
    "S3.2/lattice": "holds",
    # The listings: a mean that is none, N^2 for N, a second test that undoes the first.
    "S-C72/mean": "cannot hold",
    **{f"S-C75/listing_{n}": "cannot hold" for n in (121, 441)},
    **{f"S-C75/per-side_{n}": "holds" for n in (121, 441)},
    "S-C103/both": "cannot hold",
    # Late motions of the T-tube are curves, but not all: one of these three winds about a torus and goes on filling it.
    "S3.5/discrete_+0.6I": "holds",
    "S3.5/discrete_-0.6I": "differs",
    "S3.5/discrete_-0.6I-2": "holds",
    "S3.5/discrete_-0.6III": "holds",
    "S3.5/no_curve": "holds",
}


class Errata(ErrataCase):
    def test_verdicts(self):
        self.assert_verdicts(EXPECTED)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""How far driven motions are off: families of methods, step sizes and lengths of run.

    python3 tools/time_table.py build/release/hamflow            # 10^4 and 10^6 steps, 10^5 of slow methods
    python3 tools/time_table.py build/release/hamflow --long     # and 10^7 of fast, 10^6 of slow methods

H = p^2/2 - x cos t from rest at 0 has p = sin t. What is printed is |p - sin t| at the end, t = n dt of the double dt.
A method of low order misses by its own error at long steps; where the error grows with the number of steps at one dt,
or as dt falls, the times inside its steps are not those of the motion.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
from fractions import Fraction

METHODS = ["verlet", "kahan-li8", "chin4a", "rkn8-s19", "rk4", "dop853", "taylor", "gauss(4)", "cg(3)", "cg(1)",
           "lobatto-3a-3b(4)", "discrete-gradient", "itoh-abe", "tao4"]
SLOW = ("dop853", "taylor", "gauss", "cg", "lobatto", "discrete", "itoh")  # of these 10^6 steps take up to a minute
SCENARIO = """
[problem]
name = "formula"
coordinates = ["x"]
hamiltonian = "p_x^2/2 - x*cos(t)"
initial = {{ q = [0], p = [0] }}
[method]
name = "{method}"
[run]
dt = {dt!r}
steps = {steps}
"""


def sine(t):
    """sin t of a fraction, to the digits of a double."""
    pi = Fraction(3141592653589793238462643383279502884197169399375105820974944592307816406286, 10**75)
    t -= 2 * pi * round(t / (2 * pi))
    term = total = t
    for k in range(1, 40):
        term *= -t * t / ((2 * k) * (2 * k + 1))
        term = term.limit_denominator(10**60)
        total += term
    return float(total)


def miss(command, method, dt, steps):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "driven.toml"
        file.write_text(SCENARIO.format(method=method, dt=dt, steps=steps))
        done = subprocess.run([command, "run", str(file), "--json", "--quiet", "--out", "none"], capture_output=True,
                              text=True, check=False)
    summary = json.loads(done.stdout)
    if summary["status"] != "done":
        return summary["status"]
    return f"{abs(summary['final']['p'][0] - sine(Fraction(dt) * steps)):.1e}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", help="the hamflow to run")
    parser.add_argument("--long", action="store_true", help="ten times the steps, too")
    given = parser.parse_args()
    lengths = [("0.1", 0.1), ("0.01", 0.01), ("2^-7", 2.0**-7), ("1/3", 1 / 3)]
    print(f"{'':18}{'steps':>6}" + "".join(f"{name:>10}" for name, _ in lengths))
    for method in METHODS:
        powers = (4, 5, 6) if method.startswith(SLOW) else (4, 6, 7)
        for power in powers if given.long else powers[:2]:
            row = [miss(given.command, method, dt, 10**power) for _, dt in lengths]
            print(f"{method:18}{'10^' + str(power):>6}" + "".join(f"{x:>10}" for x in row), flush=True)


if __name__ == "__main__":
    main()

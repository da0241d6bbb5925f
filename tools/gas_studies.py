#!/usr/bin/env python3
"""What the gas does, in tables: gas_studies.py HAMFLOW STUDY... [--sides 121,441] [--arithmetics double,lattice] [--steps N]

orders:   25 particles in a circle with cut-offs "smooth", "shifted", "force-shifted": the slopes of the error over dt of
          methods of order 2, 4 and 8, against the same motion in double-double with steps of a quarter of the least dt
energy:   the same gas over --steps [1000000] steps of stv4: size and class of the energy error for each kind of cut-off
page81:   121 and 441 particles there and back, 200 to 1200 steps: return errors in the measure of [Sonnleitner2010, p. 81]
          (root of the sum of squares over N), digits lost, and which runs stop at the wall, when and by which particle;
          dt = 0.01, 0.001, 0.0001, both scales, exponents 1, 2, 4
lattice:  121 particles on the lattice, --steps there and back with 1, 2 and 4 threads: the hashes
"""

import argparse
import decimal
import itertools
import json
import math
import pathlib
import subprocess
import sys

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"
SMALL = {"particles_per_side": 5, "container": '{ kind = "circle", radius = 1.5, exponent = 2 }'}
CUTOFFS = {"none": None, "smooth": '{ radius = 2.5, kind = "smooth", inner = 1.2 }',
           "shifted": '{ radius = 2.5, kind = "shifted" }', "force-shifted": '{ radius = 2.5, kind = "force-shifted" }'}


def command(hamflow, verb, file, **settings):
    """The JSON of a command with settings PATH=VALUE, None where it prints none, and what it says."""
    words = [hamflow, verb, str(EXAMPLES / file), "--json", "--quiet"]
    if verb == "run":
        words += ["--out", "none"]
    for key, value in settings.items():
        if value is not None:
            words += ["--set", f"{key.replace('__', '.')}={value}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout), done.stderr
    except ValueError:
        return None, done.stderr


def small_gas(hamflow, kind, method, dt, steps, arithmetic="double"):
    settings = {f"problem__{key}": value for key, value in SMALL.items()}
    found, said = command(hamflow, "run", "gas_121.toml", **settings, problem__cutoff=CUTOFFS[kind], method__name=method,
                          run__dt=repr(dt), run__steps=steps, run__arithmetic=arithmetic, output__figures="[]")
    if found is None or found["status"] != "done":
        sys.exit(f"{kind}, {method}, dt = {dt}: {said}")
    return found


def state_of(found):
    return [decimal.Decimal(x) for x in found["final"]["q"] + found["final"]["p"]]


def orders(arguments):
    time, halvings = 0.25, 5
    steps = [125 * 2**k for k in range(halvings + 1)]
    for kind in CUTOFFS:
        reference = state_of(small_gas(arguments.hamflow, kind, "kahan-li8", time / (4 * steps[-1]), 4 * steps[-1],
                                       "double-double"))
        for method in ("verlet", "stv4", "kahan-li8"):
            errors = []
            for count in steps:
                exact = "double-double" if method == "kahan-li8" else "double"
                state = state_of(small_gas(arguments.hamflow, kind, method, time / count, count, exact))
                errors.append(float(sum((a - b) ** 2 for a, b in zip(state, reference)).sqrt()))
            slopes = [math.log2(one / other) if other > 0 else math.inf for one, other in itertools.pairwise(errors)]
            print(f"{kind:14} {method:10} dt = {time / steps[0]:g} .. {time / steps[-1]:g}: errors",
                  " ".join(f"{error:.1e}" for error in errors), " slopes", " ".join(f"{slope:.2f}" for slope in slopes),
                  flush=True)


def energy(arguments):
    for kind in CUTOFFS:
        found = small_gas(arguments.hamflow, kind, "stv4", 0.001, arguments.steps)
        drift = found["certificate"]
        print(f"{kind:14} {arguments.steps} steps: {found['energy']['max_error'] / found['energy']['scale']:.2e} of the scale,",
              f"{drift['drift']}, growth exponent {drift['growth_exponent']}: {drift['reason']}", flush=True)


def page81(arguments):
    for side, arithmetic in itertools.product(arguments.sides.split(","), arguments.arithmetics.split(",")):
        for dt, scale, exponent in itertools.product(("0.01", "0.001", "0.0001"), ("per-side", "listing"), (1, 2, 4)):
            stopped = ""
            for steps in (200, 400, 800, 1200):
                head = f"{side:>4} {arithmetic:13} dt {dt:6} {scale:8} exponent {exponent} {steps:5} steps:"
                if stopped:  # it stops at the same step
                    print(head, stopped)
                    continue
                found, said = command(arguments.hamflow, "reverse", f"gas_{side}.toml", run__steps=steps, run__dt=dt,
                                      problem__scale=scale, problem__container__exponent=exponent,
                                      run__arithmetic=arithmetic)
                if found is None:
                    print(head, said.strip())
                elif found["status"] != "done":
                    error = found["error"]
                    stopped = f"stops at step {error['step']}: {error['message']}"
                    print(head, stopped, flush=True)
                else:
                    back = found["return_error"]
                    print(head, "every bit" if found["bit_exact"] else
                          f"position {back['position']:.2e} (RMS {back['position_rms']:.2e}), momentum "
                          f"{back['momentum']:.2e} (RMS {back['momentum_rms']:.2e}), {found['digits_lost']:.1f} digits lost",
                          flush=True)


def lattice(arguments):
    for threads in (1, 2, 4):
        found, said = command(arguments.hamflow, "reverse", "gas_121.toml", run__arithmetic="lattice",
                              problem__container__exponent=4, run__steps=arguments.steps, run__threads=threads)
        print(f"{threads} threads, {arguments.steps} steps there and back:",
              said if found is None else f"{found['hash']}, every bit: {found['bit_exact']}", flush=True)


def main():
    studies = {"orders": orders, "energy": energy, "page81": page81, "lattice": lattice}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hamflow")
    parser.add_argument("study", nargs="+", choices=studies)
    parser.add_argument("--sides", default="121,441")
    parser.add_argument("--arithmetics", default="double,compensated,lattice,double-double")
    parser.add_argument("--steps", type=int, default=1000000)
    arguments = parser.parse_args()
    for study in arguments.study:
        studies[study](arguments)


if __name__ == "__main__":
    main()

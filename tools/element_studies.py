#!/usr/bin/env python3
"""What elements of any degree and Gauss collocation do, in tables: element_studies.py HAMFLOW STUDY...

flows:    the error against every flow of tests/data/exact_flow.json over dt, in quad, down to its rounding, of every
          implicit method that takes it
orders:   cg(k, s), k = 1..6, s = k, k + 1, 2 k, 3 k: the slopes of the error of a pendulum, in quad
energy:   16 starts, --steps [1000000] steps of Kepler's ellipse and of a double pendulum, cg(1..3,auto): growth and size
sextic:   10^4 steps of 0.16 with s = k .. 3 k points: what the energy does, and that 2 s >= 6 k points see all of it
binomial: springs of 1000 and 10^6, dt = 0.1, 0.01, 0.001: whether a step is solved, or why not
bodies:   eg(1..3) and cg(1,5) with masses 1, 0.3, 0.2, --steps: energy and momenta; orders; a circle; a fall from rest
"""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).resolve().parents[1] / "tests" / "data" / "exact_flow.json"
FLOWS = {
    "kepler_e0.6": {"name": "central-force", "potential": "kepler"},
    "henon_heiles_regular_gni": {"name": "henon-heiles"},
    "pendulum_q2.5": {"name": "pendulum", "mass": 1, "length": 1, "gravity": 1},
    "double_pendulum_midrod": {"name": "double-pendulum", "masses": [2, 2], "half_lengths": [3, 3]},
    "lj_oscillator": {"name": "lennard-jones-oscillator"},
    "binomial_k1": {"name": "central-force", "potential": "binomial", "k": 1, "lambda": 1},
    "duffing_a1_b1": {"name": "duffing", "alpha": 1, "beta": 1},
}


class Studies:
    def __init__(self, hamflow, steps):
        self.hamflow = hamflow
        self.steps = steps
        self.folder = pathlib.Path(tempfile.mkdtemp())

    def run(self, problem, q, p, method, run, columns=False):
        """The summary of a run, or its columns."""
        text = "[problem]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in problem.items())
        text += f"initial = {{ q = {json.dumps(q)}, p = {json.dumps(p)} }}\n"
        text += f'[method]\nname = "{method}"\n[run]\n'
        text += "".join(f"{key} = {json.dumps(value)}\n" for key, value in run.items())
        text += '[output]\nformats = ["csv"]\n'
        (self.folder / "s.toml").write_text(text)
        out = str(self.folder / "out") if columns else "none"
        done = subprocess.run([self.hamflow, "run", "s.toml", "--out", out, "--force",
                               "--json"], cwd=self.folder, capture_output=True, text=True, check=False)
        if not done.stdout:
            sys.exit(f"{method}: {done.stderr}")
        if columns:
            with open(self.folder / "out" / "trajectory.csv", newline="", encoding="utf-8") as file:
                return list(csv.DictReader(file))
        return json.loads(done.stdout)

    def errors(self, problem, q, p, method, time, wanted):
        """log2 of the error with 4, 8, 16 .. steps, in quad, until it is rounding or no longer falls."""
        found = []
        for steps in (4, 8, 16, 32, 64, 128, 256, 512):
            end = self.run(problem, q, p, method, {"dt": f"{time}/{steps}", "steps": steps, "arithmetic": "quad"})
            if end["status"] == "rejected":
                return []
            if end["status"] != "done":
                found.append(math.nan)
                continue
            state = end["final"]["q"] + end["final"]["p"]
            error = max(abs(decimal_difference(a, b)) for a, b in zip(state, wanted))
            found.append(error)
            if error < 1e-28 * max(1.0, *(abs(float(x)) for x in wanted)):
                break
        return found

    def flows(self):
        methods = [f"gauss({k})" for k in range(1, 11)] + [f"cg({k},auto)" for k in range(1, 7)]
        methods += ["eg(1)", "eg(2)", "eg(3)", "discrete-gradient", "itoh-abe"]
        methods += [f"lobatto-3a-3b({s})" for s in range(2, 11)]
        for flow in json.loads(DATA.read_text())["problems"]:
            start = flow["initial_state_values"]
            half = len(start) // 2
            [end] = [r for r in flow["results"] if float(r.get("t_value", r["t"])) == 1]
            print(f"{flow['problem']}, t = 1, errors with 4, 8, 16 .. steps, and the last slope above 1e-27")
            for method in methods:
                errors = self.errors(FLOWS[flow["problem"]], start[:half], start[half:], method, 1, end["state"])
                if errors:
                    print(f"  {method:17s}", " ".join(f"{e:7.0e}" for e in errors), f"  {slope(errors):6.2f}", flush=True)

    def orders(self):
        start = ("2.5",), ("0",)
        [flow] = [f for f in json.loads(DATA.read_text())["problems"] if f["problem"] == "pendulum_q2.5"]
        print("pendulum, q = 2.5, t = 1: the last slope above 1e-27, to be 2 k")
        for k in range(1, 7):
            for s in (k, k + 1, 2 * k, 3 * k):
                errors = self.errors(FLOWS["pendulum_q2.5"], *start, f"cg({k},{s})", 1, flow["results"][0]["state"])
                print(f"  cg({k},{s:2d})  {slope(errors):6.3f}", flush=True)

    def energy(self):
        draw = random.Random(12)
        ellipses = [on_ellipse(0.6, draw.uniform(0, 2 * math.pi), draw.uniform(0, 2 * math.pi)) for _ in range(16)]
        swings = [([draw.uniform(-1, 1), draw.uniform(-1, 1)], [draw.uniform(-1, 1), draw.uniform(-1, 1)])
                  for _ in range(16)]
        blocks = 512
        for name, problem, starts, dt in (("Kepler, e = 0.6", FLOWS["kepler_e0.6"], ellipses, 0.05),
                                          ("double pendulum", FLOWS["double_pendulum_midrod"], swings, 0.01)):
            for k in (1, 2, 3):
                squares = [0.0] * blocks
                scale = math.inf
                for q, p in starts:
                    run = {"dt": dt, "steps": self.steps, "record_every": self.steps // blocks}
                    rows = [float(row["energy"]) for row in self.run(problem, q, p, f"cg({k},auto)", run, True)]
                    for b in range(blocks):
                        squares[b] += (rows[b + 1] - rows[0]) ** 2 / len(starts)
                    run["steps"] = 1
                    scale = min(scale, self.run(problem, q, p, f"cg({k},auto)", run)["energy"]["scale"])
                windows = [(math.log2(b + 1), math.log2(sum(squares[b:2 * b + 1]) / (b + 1)) / 2)
                           for b in (2 ** j - 1 for j in range(9))]
                bound = 3 * 2 ** -53 * math.sqrt(self.steps) * scale
                print(f"{name}, dt = {dt}, cg({k},auto), {self.steps} steps: grows like t^{fitted(windows):.2f}, "
                      f"RMS {math.sqrt(squares[-1]):.2e} of {bound:.2e} allowed", flush=True)

    def sextic(self):
        print("sextic, dt = 0.16, 10^4 steps: what the certificate says of the energy, and its largest error")
        for k in (1, 2, 3):
            for s in range(k, 3 * k + 1):
                end = self.run({"name": "sextic"}, [1], [0], f"cg({k},{s})", {"dt": 0.16, "steps": 10_000})
                print(f"  cg({k},{s})  {end['certificate']['drift']:12s} {end['energy']['max_relative_error']:8.1e}",
                      "exact" if 2 * s >= 6 * k else "", flush=True)

    def binomial(self):
        print("binomial, lambda = 1, from (1, 0), p = (0.2, 1), up to t = 10")
        for k in (1000, 1_000_000):
            for dt in (0.1, 0.01, 0.001):
                for method in ("gauss(3)", "cg(1,auto)", "cg(2,auto)", "cg(3,auto)", "eg(2)"):
                    problem = {"name": "central-force", "potential": "binomial", "k": k}
                    end = self.run(problem, [1, 0], [0.2, 1], method, {"dt": dt, "steps": round(10 / dt)})
                    what = f"energy to {end['energy']['max_relative_error']:.0e}"
                    if end["status"] != "done":
                        what = end["error"]["message"].partition(";")[0]
                    print(f"  k = {k:7d}, dt = {dt:5}, {method:10s} {what}", flush=True)


    def bodies(self):
        # A pair, and a third one that goes round it: none of them leaves.
        three = {"name": "n-body", "masses": [1, 0.3, 0.2], "frame": "barycentric"}
        q, p = [0, 0, 1, 0, 0, -8], [-0.11, -0.25, 0.035, 0.25, 0.075, 0]
        dt = 0.02
        print(f"masses 1, 0.3, 0.2, dt = {dt}, {self.steps} steps: largest errors of H, the momenta, and what H does")
        for method in ("eg(1)", "eg(2)", "eg(3)", "cg(1,5)"):
            end = self.run(three, q, p, method, {"dt": dt, "steps": self.steps})
            kept = end["invariants"]
            print(f"  {method:8s} {end['energy']['max_error']:8.1e} linear {largest(kept['linear_momentum']):8.1e}, angular "
                  f"{largest(kept['angular_momentum']):8.1e}, {end['certificate']['drift']}, "
                  f"{end['newton']['mean']:.2f} solves a step", flush=True)
        print("the same up to t = 1, in quad: log2 of what halving 1/8, 1/16 .. changes, over what it changed before")
        for method in ("eg(1)", "eg(2)", "eg(3)"):
            ends = [self.run(three, q, p, method, {"dt": f"1/{n}", "steps": n, "arithmetic": "quad"})["final"]["q"]
                    for n in (8, 16, 32, 64, 128)]
            changes = [max(abs(decimal_difference(x, y)) for x, y in zip(a, b)) for a, b in zip(ends, ends[1:])]
            print(f"  {method:8s}", " ".join(f"{math.log2(a / b):6.3f}" for a, b in zip(changes, changes[1:])), flush=True)
        kepler = {"name": "central-force", "potential": "kepler"}
        print("a circle, r = 1, 10^5 steps: largest errors of H and l, |r - 1| in the end; a fall from rest, 20 steps of 0.05")
        for method in ("eg(1)", "eg(2)", "eg(3)"):
            for h in (0.01, 0.1, 0.3):
                end = self.run(kepler, [1, 0], [0, 1], method, {"dt": h, "steps": 100_000})
                print(f"  {method}, dt = {h:4}  {end['energy']['max_error']:8.1e} "
                      f"{largest(end['invariants']['angular_momentum']):8.1e} {abs(math.hypot(*end['final']['q']) - 1):8.1e}",
                      flush=True)
            end = self.run(kepler, [1, 0.5], [0, 0], method, {"dt": 0.05, "steps": 20})
            print(f"  {method}, from rest {end['energy']['max_error']:8.1e}", flush=True)


def largest(invariant):
    error = invariant["max_error"]
    return max(error) if isinstance(error, list) else error


def decimal_difference(a, b):
    from decimal import Decimal, getcontext
    getcontext().prec = 60
    return float(Decimal(a) - Decimal(b))


def slope(errors):
    """The last one of a halving whose errors are far above rounding."""
    pairs = [(a, b) for a, b in zip(errors, errors[1:]) if b > 1e-27]
    return math.log2(pairs[-1][0] / pairs[-1][1]) if pairs else math.nan


def fitted(points):
    mean_x = sum(x for x, _ in points) / len(points)
    mean_y = sum(y for _, y in points) / len(points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def on_ellipse(e, anomaly, turn):
    """A state of the ellipse with semi-major axis 1 at an eccentric anomaly, turned."""
    b = math.sqrt(1 - e * e)
    rate = 1 / (1 - e * math.cos(anomaly))
    c, s = math.cos(turn), math.sin(turn)
    return tuple([c * x - s * y, s * x + c * y] for x, y in (
        (math.cos(anomaly) - e, b * math.sin(anomaly)), (-math.sin(anomaly) * rate, b * math.cos(anomaly) * rate)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hamflow", type=pathlib.Path)
    parser.add_argument("studies", nargs="+", choices=["flows", "orders", "energy", "sextic", "binomial", "bodies"])
    parser.add_argument("--steps", type=int, default=1_000_000, help="of energy and bodies, rounded up to a multiple of 512")
    given = parser.parse_args()
    studies = Studies(given.hamflow.resolve(), -(-given.steps // 512) * 512)
    for name in given.studies:
        getattr(studies, name)()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares the Python module with C++: ratios within rounds, as median with quartiles in brackets.

    PYTHONPATH=build/release/python HAMFLOW=build/release/hamflow python3 bench/python_bench.py [--rounds N] [--only NAME]

The goals stand beside the figures; nothing here is a test of time. SciPy's solve_ivp is timed beside where it is installed.
"""

import argparse
import inspect
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")
KEPLER = {"name": "central-force", "potential": "kepler", "mass": 2.0, "orbit": {"kind": "ellipse", "r_per": 1, "r_aph": 3}}


def spread(values):
    low, middle, high = statistics.quantiles(values, n=4)
    return f"{middle:.3f} [{low:.3f}, {high:.3f}]"


def seconds(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def paired(rounds, one, other):
    """Times both functions in each round. Their order alternates from round to round."""
    found = []
    for k in range(rounds):
        taken = [None, None]
        for place in ((0, 1), (1, 0))[k % 2]:
            taken[place] = (one, other)[place]()
        found.append(taken)
    return found


def simulation():
    sim = hf.Simulation(KEPLER, method="stv4", dt=0.01)
    sim.advance(10_000)  # in these steps the step is recorded and compiled
    return sim


def advance(rounds):
    sim, other = simulation(), simulation()
    found = paired(rounds, lambda: seconds(lambda: sim.advance(10**6)), lambda: other._core.seconds_without_python(10**6, 1))
    print(f"advance(10**6) / C++                       {spread([a / b for a, b in found])}   goal 1.02")
    assert sim.q.tobytes() == other.q.tobytes()


def advance_one(rounds):
    sim, other = simulation(), simulation()

    def calls():
        for _ in range(100_000):
            sim.advance(1)

    found = paired(rounds, lambda: seconds(calls), lambda: other._core.seconds_without_python(1, 100_000))
    print(f"advance(1) beyond the step, us             {spread([(a - b) * 10 for a, b in found])}   goal 1")


def propagate(rounds):
    n, steps = 100_000, 100
    ranges = {"q[0]": (-0.2, 0.2), "q[1]": (0.1, 0.2), "p[0]": (-0.1, 0.1), "p[1]": (0.05, 0.1)}
    q0, p0 = (np.stack([np.linspace(*ends, n) for key, ends in ranges.items() if key[0] == name], axis=1) for name in "qp")
    file = tempfile.NamedTemporaryFile("w", suffix=".toml")
    file.write(str(hf.Scenario(problem=hf.Problem("henon-heiles").at(q=[0, 0], p=[0, 0]), method="stv4",
                               run={"dt": 0.05, "steps": steps, "certificate": False})))
    file.flush()
    command = [HAMFLOW, "sweep", file.name, "--zip", "--out", "none", "--quiet", "--json"]
    for key, (low, high) in ranges.items():
        command += ["--vary", f"problem.initial.{key}={low}:{high}:{n}"]

    found = paired(rounds, lambda: seconds(lambda: hf.propagate("henon-heiles", "stv4", q0, p0, dt=0.05, steps=steps)),
                   lambda: seconds(lambda: subprocess.run(command, stdout=subprocess.DEVNULL, check=True)))
    print(f"propagate of 10^5 members / the command    {spread([a / b for a, b in found])}   goal 1.1; "
          f"{statistics.median(a for a, _ in found):.2f} s")


# Memory: each measurement has its own process, whose peak is reported.

def peak():  # ru_maxrss is not used, because it includes the memory of the parent process
    with open("/proc/self/status") as file:
        return 1024 * int(next(line for line in file if line.startswith("VmHWM")).split()[1])


def sweep_memory():
    n = 10**6
    scenario = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4",
                           run={"dt": 0.05, "steps": 10, "certificate": False})
    values = np.linspace(0.1, 1, n)
    hf.sweep(scenario, {"problem.initial.q[0]": values[:1000]})
    before = peak()
    ens = hf.sweep(scenario, {"problem.initial.q[0]": values})
    reached = peak()
    kept = sum(column.nbytes for column in (ens[name] for name in ens.columns) if isinstance(column, np.ndarray))
    print(f"sweep of 10^6 members, bytes a member      {(reached - before - kept) / n:.0f}   goal 200; {kept / n:.0f} kept as numbers")


def sample_memory():
    sim = simulation()
    before = peak()
    traj = sim.sample(steps=10**7 - 1)
    reached = peak()
    kept = sum(each.nbytes for each in (traj.t, traj.q, traj.p, traj.energy, traj.step))
    assert traj.q.base is not None and len(traj) == 10**7
    print(f"sample of 10^7 samples, memory / samples   {(reached - before) / kept:.3f}   goal 1.1; {kept / 10**7:.0f} bytes a sample")


def alone(name):
    def run(rounds):
        subprocess.run([sys.executable, "-B", __file__, "--memory", name], check=True)
    return run


# The time from the start of Python to a figure.

def with_hamflow():
    import matplotlib
    matplotlib.use("Agg")
    import hamflow as hf
    sim = hf.Simulation(hf.Problem("central-force", potential="kepler"), method="stv4", q=[1, 0], p=[0, 1.2], dt=0.01)
    traj = sim.sample(steps=10_000, every=10)
    import matplotlib.pyplot as plt
    plt.plot(traj["x"], traj["y"])
    plt.savefig("/dev/null", format="png")


def with_scipy():
    import matplotlib
    matplotlib.use("Agg")
    import numpy as np
    from scipy.integrate import solve_ivp
    def motion(t, y):
        q, p = y[:2], y[2:]
        return np.concatenate([p, -q / np.dot(q, q) ** 1.5])
    found = solve_ivp(motion, (0, 100), [1, 0, 0, 1.2], method="DOP853", rtol=1e-9, atol=1e-12, t_eval=np.linspace(0, 100, 1001))
    import matplotlib.pyplot as plt
    plt.plot(found.y[0], found.y[1])
    plt.savefig("/dev/null", format="png")


def first_figure(rounds):
    def process(function):
        lines = inspect.getsource(function).splitlines()[1:]
        code = "\n".join(line.removeprefix("    ") for line in lines)
        return lambda: seconds(lambda: subprocess.run([sys.executable, "-B", "-c", code], check=True)), len(lines)

    here, lines = process(with_hamflow)
    try:
        import scipy  # noqa: F401
    except ImportError:
        print(f"from nothing to a figure of Kepler, s      {spread([here() for _ in range(rounds)])}   {lines} lines; SciPy is not installed")
        return
    there, others = process(with_scipy)
    found = paired(rounds, here, there)
    print(f"from nothing to a figure / SciPy           {spread([a / b for a, b in found])}   {lines} lines, SciPy {others}")


MEASURES = {"advance": advance, "advance-one": advance_one, "propagate": propagate, "sweep-memory": alone("sweep"),
            "sample-memory": alone("sample"), "figure": first_figure}

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument("--only", choices=MEASURES)
    parser.add_argument("--memory", choices=("sweep", "sample"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.memory:
        {"sweep": sweep_memory, "sample": sample_memory}[given.memory]()
    else:
        for name, measure in MEASURES.items():
            if given.only in (None, name):
                measure(max(given.rounds, 2))

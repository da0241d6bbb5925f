"""The module gives the bits of the command, however a motion is cut into pieces, copied or put into an ensemble."""

import concurrent.futures
import itertools
import os
import pickle
import random
import subprocess

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")

PROBLEMS = {
    "pendulum": {"name": "pendulum", "initial": {"q": ["1/3"], "p": [0]}},
    "wide pendulum": {"name": "pendulum", "initial": {"q": [2.5], "p": [0.1]}},
    "kepler": {"name": "central-force", "potential": "kepler", "initial": {"q": [1, 0], "p": [0, "6/5"]}},
    "polar": {"name": "central-force", "potential": "kepler", "coordinates": "polar", "initial": {"q": [1, 0], "p": [0, 1.2]}},
    "henon": {"name": "henon-heiles", "initial": {"q": [0, -0.15], "p": [0.54, 0.1]}},
    "double pendulum": {"name": "double-pendulum", "initial": {"q": [0.3, 0.5], "p": [0, 0]}},
    "ball": {"name": "free-fall", "walls": [{"coordinate": "q", "min": -0.5}], "initial": {"q": [0], "p": [0.3]}},
    "mirrored ball": {"name": "harmonic", "walls": [{"coordinate": "q", "min": -0.5, "max": 0.7}], "wall_rule": "mirror",
                      "initial": {"q": [0], "p": [0.9]}},
    "tube": {"name": "t-tube", "masses": [1, 100], "eps": -0.6, "velocities": [6, 1]},
    "chain": {"name": "fput", "n": 4, "alpha": 0.25, "initial": {"q": [0.1, 0.3, 0.2, 0.4], "p": [0, 0, 0, 0]}},
    "eight": {"name": "n-body", "masses": [1, 1, 1],
              "initial": {"q": [0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0],
                          "p": [0.466203685, 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146]}},
    "gas": {"name": "gas", "particles_per_side": 3, "container": {"kind": "circle", "radius": 1.5, "exponent": 1}},
    "rod": {"name": "pendulum", "coordinates": "cartesian", "dimension": 3,
            "initial": {"q": [0.6, 0, -0.8], "v": [0.4, 0.9, 0.3]}},
    "typed": {"name": "formula", "coordinates": ["x", "y"], "hamiltonian": "(p_x^2 + p_y^2)/2 + x^2/2 + y^2 + a*x^2*y",
              "parameters": {"a": 0.3}, "initial": {"q": [0.3, 0.2], "p": [0.1, 0.4]}},
    "driven": {"name": "formula", "coordinates": ["x"], "hamiltonian": "p_x^2/2 - x*cos(t)",
               "initial": {"q": [0.2], "p": [0]}},
}
METHODS = [{"name": "stv4"}, {"name": "kahan-li8"}, {"name": "cg(1,5)"}, {"name": "cg", "degree": 2}, {"name": "gauss(2)"},
           {"name": "rk4"}, {"name": "rkn8-s19"}, {"name": "taylor"}, {"name": "dop853"}, {"name": "discrete-gradient"},
           {"name": "rattle4"}, {"name": "verlet", "step_control": "reversible"},
           {"name": "gauss", "stages": 1, "step_control": "reversible", "on_divergence": "halve"}]
ARITHMETICS = ["double", "compensated", "double-double", "quad", "mp(40)", "lattice"]
EXTRAS = ["nothing", "section", "events", "times", "exponents", "derivative", "every third", "t_end"]
FIRST_MOMENTA = {"kepler": "p_x", "polar": "p_r", "rod": "p_x", "typed": "p_x", "driven": "p_x", "tube": "p1", "chain": "p1",
                 "henon": "p1", "double pendulum": "p1", "eight": "p_x1", "gas": "p_x1"}


def keys_of(extra, p):
    return {"section": {"section": {"expression": p, "direction": 0}},
            "events": {"events": [{"name": "turn", "expression": p}, {"expression": f"{p} - 0.9", "action": "stop"}]},
            "times": {"record": [0, 0.05, 0.3]},
            "exponents": {"lyapunov": 1},
            "derivative": {"eigenvalues": True},
            "every third": {"record_every": 3},
            "t_end": {"t_end": 0.4}}.get(extra, {})


def scenario(problem, method, arithmetic, extra):
    """A short run; None where this problem, method, arithmetic and extra do not go together."""
    run = {"dt": 0.001 if problem == "gas" else 0.02, "steps": 25, "certificate": False, "arithmetic": arithmetic}
    run |= keys_of(extra, FIRST_MOMENTA.get(problem, "p"))
    if "t_end" in run:
        del run["steps"]
    tables = {"problem": PROBLEMS[problem], "method": METHODS[method], "run": run, "output": {"formats": ["h5"]}}
    try:
        return hf.Scenario(tables)
    except hf.Rejection:
        return None


def chosen():
    """200 scenarios, in which every problem, method, arithmetic and extra occurs."""
    every = list(itertools.product(PROBLEMS, range(len(METHODS)), ARITHMETICS, EXTRAS))
    random.Random(20).shuffle(every)
    found = {}
    for names in every:
        one = scenario(*names)
        if one is not None:
            found[names] = one
        if len(found) == 200:
            break
    for place, names in enumerate((PROBLEMS, range(len(METHODS)), ARITHMETICS, EXTRAS)):
        assert {each[place] for each in found} == set(names)
    return found


def hashes(run):
    return {name: getattr(run, name).tobytes() for name in ("t", "q", "p", "energy")}


def test_runs_are_those_of_the_command(tmp_path):
    scenarios = chosen()

    def by_command(place):
        return subprocess.run([HAMFLOW, "run", f"{place}.toml", "--quiet", "--out", f"{place}.run"], cwd=tmp_path,
                              capture_output=True, text=True)

    for place, one in enumerate(scenarios.values()):
        (tmp_path / f"{place}.toml").write_text(str(one))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        told = list(pool.map(by_command, range(len(scenarios))))
    failed = 0
    for place, names in enumerate(scenarios):
        try:
            run = hf.run(hf.Scenario.load(tmp_path / f"{place}.toml"))
        except hf.StepFailed as error:
            run, failed = error.partial, failed + 1
            assert told[place].returncode != 0, names
        else:
            assert told[place].returncode == 0, (names, told[place].stderr)
        kept = hf.open(tmp_path / f"{place}.run")
        assert hashes(run) == hashes(kept), names
        assert run.summary["final"] == kept.summary["final"] and len(run.t) > 1, names
    assert failed < 10


IN_MEMORY = [(problem, method, arithmetic) for problem, method in
             (("pendulum", 0), ("kepler", 3), ("henon", 4), ("ball", 2), ("tube", 3), ("gas", 0), ("rod", 10), ("typed", 7),
              ("driven", 5), ("kepler", 11), ("wide pendulum", 12), ("eight", 1)) for arithmetic in ARITHMETICS
             if scenario(problem, method, arithmetic, "nothing") is not None]


@pytest.mark.parametrize("problem, method, arithmetic", IN_MEMORY)
def test_pieces_pickles_and_copies_go_on_to_the_bit(problem, method, arithmetic):
    dt = 0.001 if problem == "gas" else 0.02
    # The cuts stand within a lane of steps, behind it, and at it.
    cuts = random.Random(problem + arithmetic).sample(range(1, 300), 6)
    sim = hf.Simulation(PROBLEMS[problem], method=METHODS[method], dt=dt, arithmetic=arithmetic)
    pieces, restored, copied = sim.copy(), sim.copy(), sim.copy()
    sim.advance(300)
    for begin, end in itertools.pairwise([0, *sorted(cuts), 300]):
        pieces.advance(end - begin)
        restored = pickle.loads(pickle.dumps(restored))
        restored.advance(end - begin)
        copied = copied.copy()
        copied.sample(steps=end - begin)
    for each in (pieces, restored, copied):
        assert (each.q.tobytes(), each.p.tobytes(), each.t, each.energy) == (sim.q.tobytes(), sim.p.tobytes(), sim.t, sim.energy)
        assert each.energy_error.max_error == sim.energy_error.max_error and each.evaluations == sim.evaluations


@pytest.mark.parametrize("problem, method", [("henon-heiles", "stv4"), ("henon-heiles", "cg(1,5)"), ("henon-heiles", "gauss(2)"),
                                             ("henon-heiles", "taylor"), ("pendulum", "kahan-li8"), ("harmonic", "rk4")])
def test_rows_of_propagate_are_single_runs(problem, method):
    d = len(hf.Problem(problem).coordinates)
    rng = np.random.default_rng(3)
    for n in (1, 7, 33):  # fewer than a group of lanes, one that is not full, several
        q, p = rng.uniform(-0.2, 0.2, (2, n, d))
        found = hf.propagate(problem, method, q, p, dt=0.05, steps=60)
        for k in range(n):
            sim = hf.Simulation(problem, method=method, q=q[k], p=p[k], dt=0.05)
            sim.advance(60)
            assert (sim.q.tobytes(), sim.p.tobytes()) == (found[0][k].tobytes(), found[1][k].tobytes())


def test_rows_of_propagate_with_parameters_of_their_own():
    typed = hf.Problem("(p_x^2 + p_y^2)/2 + a*(x^2 + y^4)", coordinates=["x", "y"], parameters={"a": 1})
    a, q = np.array([0.5, 1.5, 2.25]), np.array([[1, 0.5], [0.1, 1], [-1, 1]])
    found = hf.propagate(typed, "stv4", q, 0 * q, dt=0.05, steps=60, parameters={"a": a})
    for k in range(3):
        sim = hf.Simulation(typed, method="stv4", q=q[k], p=[0, 0], dt=0.05, parameters={"a": a[k]})
        sim.advance(60)
        assert (sim.q.tobytes(), sim.p.tobytes()) == (found[0][k].tobytes(), found[1][k].tobytes())

"""The Python module: surface, errors, bits, memory, threads, signals."""

import copy
import gc
import json
import math
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")
SWING = "(p_x^2+p_y^2)/2 + g*y + k/2*(sqrt(x^2+y^2)-1)^2"


def swing():
    return hf.Problem(SWING, coordinates=["x", "y"], parameters={"k": 20, "g": 1})


def simulation(**more):
    keys = {"method": "kahan-li8", "q": [0.6, -0.8], "p": [0, 0], "dt": 0.02} | more
    return hf.Simulation(swing(), **keys)


# Problems

def test_a_problem_says_what_it_is():
    s = swing()
    assert s.coordinates == ["x", "y"] and s.momenta == ["p_x", "p_y"]
    assert s.structure == {"separable": True, "quadratic_kinetic": True, "time": False}
    assert s.parameters["k"] == "20"


def test_energy_and_gradient_of_rows_and_of_one():
    s, rng = swing(), np.random.default_rng(1)
    q, p = rng.uniform(0.5, 1.5, (20, 2)), rng.normal(size=(20, 2))
    energy, (by_q, by_p) = s.energy(q, p), s.gradient(q, p)
    r = np.hypot(q[:, 0], q[:, 1])
    assert np.allclose(energy, (p**2).sum(1) / 2 + q[:, 1] + 10 * (r - 1) ** 2, rtol=1e-14)
    assert np.allclose(by_p, p, rtol=1e-15)
    assert np.allclose(by_q, 20 * ((r - 1) / r)[:, None] * q + [0, 1], rtol=1e-12)
    assert s.energy(q[3], p[3]) == energy[3] and np.array_equal(s.gradient(q[3], p[3])[0], by_q[3])


@pytest.mark.parametrize("dtype", [np.float32, np.int64, np.float64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_of_every_kind(dtype, order):
    q = np.asarray([[1, 2], [3, 4], [5, 6]], dtype=dtype, order=order)
    p = np.asarray([[1, 0], [0, 1], [2, 2]], dtype=dtype, order=order)
    wanted = swing().energy(q.astype(float).copy(), p.astype(float).copy())
    assert np.array_equal(swing().energy(q, p), wanted)
    assert np.array_equal(swing().energy(q[::-1], p[::-1]), wanted[::-1])


def test_a_traced_function_has_the_bits_of_its_text():
    rotor = hf.Problem(lambda q, p: (p[0] ** 2 + p[1] ** 2 / (2 + hf.cos(q[0]))) / 2 - hf.cos(q[0]), dimension=2)
    typed = hf.Problem("(p1^2 + p2^2/(2 + cos(q1)))/2 - cos(q1)", dimension=2)
    runs = [hf.Simulation(each, method="cg(1,5)", q=[0.3, 0.1], p=[0.1, 1.0], dt=0.1) for each in (rotor, typed)]
    for each in runs:
        each.advance(300)
    assert runs[0].q.tobytes() == runs[1].q.tobytes() and runs[0].energy_error.max_error < 1e-13


def test_numpy_functions_are_traced():
    traced = hf.Problem(lambda q, p: (p @ p) / 2 + np.exp(-q[0]) + np.sum(q**2) / 2 + np.hypot(q[0], q[1]), dimension=2)
    q, p = np.array([0.3, 0.4]), np.array([0.1, 0.2])
    assert traced.energy(q, p) == pytest.approx(p @ p / 2 + math.exp(-0.3) + q @ q / 2 + 0.5, rel=1e-15)


@pytest.mark.parametrize("function, word", [
    (lambda q, p: p[0] ** 2 if q[0] > 0 else -p[0], "comparison"),
    (lambda q, p: math.sin(q[0]) + p[0] ** 2, "hf.sin"),
    (lambda q, p: np.floor(q[0]) + p[0] ** 2, "floor"),
    (lambda q, p: "x", "str"),
    (lambda q, p: float("nan") * p[0], "finite")])
def test_what_cannot_be_traced_is_said(function, word):
    with pytest.raises(TypeError, match=word):
        hf.Problem(function, dimension=1)


def test_catalogue_names():
    kepler = hf.Problem("central-force", potential="kepler", mass=2.0, orbit={"kind": "ellipse", "r_per": 1, "r_aph": 3})
    sim = hf.Simulation(kepler, method="stv4", dt=0.1)
    assert np.allclose(sim.q, [1, 0]) and sim.coordinates == ["x", "y"]
    assert "kahan-li8" in [m.name for m in hf.methods(kepler)] and "henon-heiles" in [m.name for m in hf.problems()]
    with pytest.raises(hf.Error, match="central-force"):
        hf.Problem("centralforce")


# Simulations

def test_advance_in_pieces_has_the_bits_of_one_go():
    one, other = simulation(), simulation()
    one.advance(1000)
    for _ in range(1000):
        other.advance(1)
    assert one.q.tobytes() == other.q.tobytes() and one.t == other.t == 20.0 and one.step == 1000


def test_the_bits_are_those_of_the_command(tmp_path):
    sim = simulation()
    sim.advance(777)
    scenario = hf.Scenario(problem=swing().at(q=[0.6, -0.8], p=[0, 0]), method="kahan-li8", run={"dt": 0.02, "steps": 777})
    file = tmp_path / "s.toml"
    file.write_text(str(scenario))
    told = json.loads(subprocess.run([HAMFLOW, "run", file, "--json", "--quiet", "--out", "none"], check=True,
                                     capture_output=True, text=True).stdout)
    assert sim.q.tolist() == told["final"]["q"] and sim.p.tolist() == told["final"]["p"]
    assert hf.run(scenario).summary["final"] == told["final"]


def test_samples_by_steps_and_at_times():
    sim = simulation()
    traj = sim.sample(steps=200, every=20)
    assert len(traj) == 11 and traj.t[-1] == 4.0 and np.array_equal(traj["x"], traj.q[:, 0])
    other = simulation()
    at = other.sample(at=np.array([0.0, 0.4, 1.03, 4.0]))
    assert np.array_equal(at.q[[0, 1, 3]], traj.q[[0, 1, 10]])
    assert abs(at.energy[2] - at.energy[0]) < 1e-8
    other.integrate(4.0)
    assert other.q.tobytes() == sim.q.tobytes()


def test_integrate_names_the_nearest_times():
    with pytest.raises(hf.Error, match="0.98.*1.0"):
        simulation().integrate(0.99)


@pytest.mark.parametrize("t", [float("nan"), float("inf"), -1.0])
def test_integrate_refuses_what_is_no_later_time(t):
    with pytest.raises(hf.Error, match="t:"):
        simulation().integrate(t)


def test_views_keep_their_memory_alive_and_cannot_be_written():
    q = simulation().sample(steps=1000).q
    wanted = q.copy()
    gc.collect()
    junk = [np.ones(2000) for _ in range(1000)]
    assert np.array_equal(q, wanted) and q.base is not None and not q.flags.writeable and len(junk)
    with pytest.raises(ValueError):
        q[0, 0] = 1


def test_copy_pickle_save_and_load_go_on_to_the_bit():
    sim = simulation()
    sim.advance(500)
    others = [sim.copy(), copy.deepcopy(sim), pickle.loads(pickle.dumps(sim))]
    fresh = simulation()
    fresh.load(sim.save())
    for each in [sim, fresh, *others]:
        each.advance(500)
        assert each.q.tobytes() == sim.q.tobytes() and each.energy_error.max_error == sim.energy_error.max_error
    with pytest.raises(hf.Error):
        fresh.load(sim.save()[:-3])
    with pytest.raises(hf.Error):
        hf.Simulation("pendulum", q=[1], p=[0], dt=0.1).load(sim.save())


def test_reverse_returns_every_bit_on_the_lattice():
    sim = simulation(arithmetic="lattice", method="stv4")
    start = sim.q, sim.p
    sim.advance(1000)
    sim.reverse()
    sim.advance(1000)
    assert np.array_equal(sim.q, start[0]) and np.array_equal(-sim.p, start[1])


def test_observers_look_and_stop():
    sim, seen = simulation(), []

    @sim.observe(every=100)
    def watch(s):
        seen.append((s.step, s.q.tolist()))
        return "stop" if s.step == 500 else None

    sim.advance(1000)
    assert [step for step, _ in seen] == [100, 200, 300, 400, 500] and sim.step == 500


def test_what_an_observer_raises_reaches_the_caller():
    sim = simulation()

    @sim.observe(every=10)
    def watch(s):
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        sim.advance(100)
    assert sim.step == 10


def test_digits():
    sim = hf.Simulation("pendulum", method="stv4", q=["1/3"], p=[0], dt="1/50", arithmetic="mp(40)")
    sim.advance(10)
    assert isinstance(sim.digits.q[0], Decimal) and len(str(sim.digits.q[0])) > 38
    assert float(sim.digits.q[0]) == sim.q[0]
    with pytest.raises(hf.Error, match="more digits than double"):
        simulation().digits


def test_invariants_evaluations_and_errors():
    sim = hf.Simulation(hf.Problem("central-force", potential="kepler"), method="stv4", q=[1, 0], p=[0, 1.2], dt=0.01)
    sim.advance(1000)
    assert sim.invariants["angular_momentum"].max_error < 1e-12
    assert sim.evaluations["force"] > 1000 and 0 < sim.energy_error.max_relative_error < 1e-5


@pytest.mark.parametrize("keys", [{"dt": "no"}, {"q": [1]}, {"method": "stv5"}, {"q": [float("nan"), 0]}, {"dt": 0},
                                  {"arithmetic": "float"}, {"q": [1e400, 0]}])
def test_wrong_requests_are_rejected(keys):
    with pytest.raises(hf.Rejection) as caught:
        simulation(**keys)
    assert caught.value.errors and isinstance(caught.value, ValueError)


@pytest.mark.parametrize("keys", [{"q": None, "p": [0, 0]}, {"q": object(), "p": [0, 0]}, {"q": [[1, 2], [3, 4]]},
                                  {"method": {"name": ["x"]}}, {"dt": [1, 2]}])
def test_hostile_arguments_raise_and_do_nothing_else(keys):
    with pytest.raises((hf.Error, TypeError)):
        simulation(**keys)


def test_a_table_is_a_dict():
    with pytest.raises(hf.Error, match="problem: found 5"):
        hf.Scenario({"problem": 5})


def test_every_error_at_once():
    with pytest.raises(hf.Rejection) as caught:
        hf.Scenario({"problem": {"name": "pendulum", "initial": {"q": [1], "p": [0]}}, "method": {"name": "stv5"},
                     "run": {"dt": -0.0, "stepz": 3}})
    assert {"method.name", "run.stepz"} <= {key for key, _ in caught.value.errors}
    assert pickle.loads(pickle.dumps(caught.value)).errors == caught.value.errors


def test_a_failed_step_stands_at_the_last_good_one():
    sim = hf.Simulation(hf.Problem("p^2/2 - exp(q^2)", coordinates=["q"]), method="verlet", q=[1], p=[1], dt=0.1)
    with pytest.raises(hf.StepFailed) as caught:
        sim.advance(10000)
    assert caught.value.step == sim.step and caught.value.t == sim.t and np.isfinite(sim.q).all()


def test_numbers_of_other_kinds():
    for dt in (Decimal("0.02"), Fraction(1, 50), "1/50", np.float64(0.02)):
        sim = simulation(dt=dt)
        sim.advance(100)
        assert sim.q.tobytes() == (lambda s: (s.advance(100), s.q.tobytes())[1])(simulation())


# Runs

SECTION = {"problem": {"name": "henon-heiles", "initial": {"q": [0, -0.15], "p": [0.54, 0.1]}}, "method": {"name": "stv4"},
           "run": {"dt": 0.1, "steps": 3000, "lyapunov": 1, "section": {"coordinate": "q1"},
                   "events": [{"name": "up", "expression": "p2"}]},
           "output": {"observables": {"r2": "q1^2+q2^2"}}}


def test_a_run_in_memory_is_the_run_in_a_folder(tmp_path):
    one, other = hf.run(SECTION), hf.run(SECTION, out=tmp_path / "a.run")
    opened = hf.open(tmp_path / "a.run")
    for each in (other, opened):
        for name in ("t", "q", "p", "energy"):
            assert np.array_equal(getattr(each, name), getattr(one, name))
        assert np.array_equal(each.section.q, one.section.q) and np.array_equal(each.events["up"].t, one.events["up"].t)
        assert np.array_equal(each["r2"], one["r2"]) and each.lyapunov.exponents == one.lyapunov.exponents
    assert opened.certificate.drift == one.certificate.drift and str(opened.scenario) == str(one.scenario)
    with pytest.raises(hf.FileError):
        hf.run(SECTION, out=tmp_path / "a.run")
    assert hf.run(SECTION, out=tmp_path / "a.run", existing="replace").status == "done"


def test_without_a_certificate():
    assert hf.run(SECTION, certificate=False).certificate is None


def test_set_and_texts():
    s = hf.Scenario(SECTION)
    s.set("run.steps", 10)
    s.set("problem.initial.q", [0.1, 0.2])
    assert s.steps == 10 and hf.Scenario.from_text(str(s)).steps == 10 and pickle.loads(pickle.dumps(s)).steps == 10


def test_progress_may_be_a_function_that_raises():
    told = []
    long = SECTION | {"run": {"dt": 0.1, "steps": 20_000_000, "certificate": False}}

    def tell(done, total):
        told.append((done, total))
        raise RuntimeError("enough")

    with pytest.raises((RuntimeError, KeyboardInterrupt)):
        hf.run(long, progress=tell)
    assert told[0][1] == 20_000_000


def test_reversal():
    exact = SECTION | {"run": {"dt": 0.1, "steps": 1000, "arithmetic": "lattice"}, "output": {}}
    assert hf.reverse(exact).bit_exact and not hf.reverse(SECTION | {"run": {"dt": 0.1, "steps": 1000}}).bit_exact


def test_sweep_columns_are_single_runs():
    values = np.linspace(0.1, 0.12, 50)
    base = SECTION | {"run": {"dt": 0.1, "steps": 200}, "output": {}}
    ens = hf.sweep(base, {"problem.initial.p[1]": values})
    assert len(ens) == 50 and set(ens.status) == {"done"} and np.array_equal(ens["varied/problem.initial.p[1]"], values)
    s = hf.Scenario(base)
    s.set("problem.initial.p[1]", float(values[7]))
    assert ens["final/q"][7].tolist() == hf.run(s).summary["final"]["q"]


def test_propagate_rows_are_single_runs():
    rng = np.random.default_rng(2)
    q, p = rng.uniform(-0.2, 0.2, (40, 2)), rng.uniform(-0.2, 0.2, (40, 2))
    qn, pn = hf.propagate("henon-heiles", "stv4", q, p, dt=0.1, steps=100)
    for k in (0, 17, 39):
        sim = hf.Simulation("henon-heiles", method="stv4", q=q[k], p=p[k], dt=0.1)
        sim.advance(100)
        assert sim.q.tobytes() == qn[k].tobytes() and sim.p.tobytes() == pn[k].tobytes()


# Threads, signals, other libraries

def test_threads_have_their_own_simulations():
    sims = [simulation() for _ in range(4)]
    threads = [threading.Thread(target=each.advance, args=(200_000,)) for each in sims]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len({each.q.tobytes() for each in sims}) == 1


def test_one_simulation_in_two_threads_raises():
    sim, errors = simulation(), []
    thread = threading.Thread(target=sim.advance, args=(3_000_000,))
    thread.start()
    while thread.is_alive() and not errors:
        try:
            sim.advance(1)
        except hf.Error as error:
            errors.append(error)
    thread.join()
    assert errors and "another thread" in str(errors[0])


INTERRUPTED = """
import os, signal, sys, threading, time
import hamflow as hf
def send():
    time.sleep(0.3)
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
sent = []
sim = hf.Simulation("pendulum", method="stv4", q=[1], p=[0], dt=0.01)
threading.Thread(target=send).start()
try:
    %s
except KeyboardInterrupt as error:
    print(time.monotonic() - sent[0], sim.step, getattr(error, "partial", None) is not None)
"""
RUN = ('hf.run({"problem": {"name": "pendulum", "initial": {"q": [1], "p": [0]}}, "method": {"name": "stv4"}, '
       '"run": {"dt": 0.01, "steps": 10**11}})')
SWEPT = ('hf.sweep({"problem": {"name": "pendulum", "initial": {"q": [1], "p": [0]}}, "method": {"name": "stv4"}, '
         '"run": {"dt": 0.01, "steps": 10**10}}, {"problem.initial.q[0]": [1, 2, 3]})')


@pytest.mark.parametrize("call, partial", [("sim.advance(10**12)", False), (RUN, True), (SWEPT, True)])
def test_ctrl_c_ends_soon_and_keeps_what_is_there(call, partial):
    done = subprocess.run([sys.executable, "-c", INTERRUPTED % call], capture_output=True, text=True, timeout=60,
                          env=os.environ)
    seconds, step, has = done.stdout.split()
    assert (has == "True") == partial and (partial or int(step) > 0)


def test_h5py_before_and_after(tmp_path):
    for first in ("import h5py; import hamflow as hf", "import hamflow as hf; import h5py"):
        code = first + f"""
hf.run({SECTION!r}, out={str(tmp_path / 'h.run')!r}, existing="replace")
with h5py.File({str(tmp_path / 'h.run' / 'run.h5')!r}) as f: print(f["q"].shape)
print(hf.open({str(tmp_path / 'h.run')!r}).q.shape)"""
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert len(set(done.stdout.split("\n")[:2])) == 1


def test_the_import_is_quick_and_takes_nothing_with_it():
    code = ("import sys, numpy, time; b = time.perf_counter(); import hamflow; "
            "print([m for m in ('matplotlib', 'h5py', 'sympy', 'pandas') if m in sys.modules])")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"


def test_memory_does_not_grow_with_objects():
    import resource

    def many():
        for _ in range(20000):
            sim = _KEPT.copy()
            sim.q, sim.energy_error  # noqa: B018

    _KEPT = simulation()
    many()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    many()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4096  # kB


def test_names_of_sympy():
    """Abs and E, as SymPy prints them."""

    class Expression:
        free_symbols = {"x", "p_x"}

        def __str__(self):
            return "p_x**2/2 + Abs(x)**3 + E*x**2"

    found = hf.Problem(Expression(), coordinates=["x"])
    assert found.energy([-0.5], [1.0]) == pytest.approx(0.5 + 0.125 + np.exp(1) / 4, rel=1e-15)


def test_reprs_are_one_line():
    run = hf.run(SECTION)
    for each in (swing(), simulation(), simulation().sample(steps=3), hf.Scenario(SECTION), run, run.section, hf.methods()):
        assert "\n" not in repr(each) and len(repr(each)) > 10


def test_the_examples_of_the_readme(tmp_path, monkeypatch, capsys):
    import re

    text = (pathlib.Path(__file__).resolve().parents[2] / "README.md").read_text()
    monkeypatch.chdir(tmp_path)
    pathlib.Path("kepler.toml").write_text(re.search(r"```toml\n(# kepler\.toml.*?)```", text, re.S)[1])
    names = {}
    for block in re.findall(r"```python\n(.*?)```", text, re.S):
        exec(compile(block, "README.md", "exec"), names)
    assert "bounded" in capsys.readouterr().out


def test_doctests():
    import doctest

    for name in ("_certify", "_problem", "_scenario", "_simulation"):
        module = sys.modules["hamflow." + name]
        assert doctest.testmod(module).failed == 0

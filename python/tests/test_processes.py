"""Other processes, threads, and Ctrl-C."""

import multiprocessing
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import hamflow as hf

START = {"name": "henon-heiles", "initial": {"q": [0, -0.15], "p": [0.54, 0.1]}}
SCENARIO = hf.Scenario(problem=START, method="stv4", run={"dt": 0.1, "steps": 50})


def energy(q, p):
    return (p[0] ** 2 + p[1] ** 2) / 2 + hf.cos(q[0]) * q[1] ** 2


def bytes_of(sim):
    return sim.q.tobytes() + sim.p.tobytes() + np.float64(sim.t).tobytes()


# What other processes are asked for: each takes an object and gives a text of bits.

def advanced(sim):
    sim.advance(100)
    return bytes_of(sim)


def carried_out(scenario):
    return hf.run(scenario, certificate=False).q.tobytes()


def computed(problem):
    return str(problem.energy([0.1, 0.2], [0.3, 0.4])).encode()


def columns_of_run(run):
    return run.q.tobytes() + run.scenario.steps.to_bytes(4, "big") + run.section.q.tobytes()


SENT = {
    "Simulation": (lambda: hf.Simulation(START, method="cg(1,5)", dt=0.1), advanced),
    "Simulation on its way": (lambda: (lambda sim: (sim.advance(77), sim)[1])(hf.Simulation(START, method="taylor", dt=0.1)), advanced),
    "Scenario": (lambda: SCENARIO, carried_out),
    "Problem": (lambda: hf.Problem("henon-heiles"), computed),
    "Problem of a function": (lambda: hf.Problem(energy, dimension=2), computed),
}


@pytest.fixture(scope="module")
def pool():
    with multiprocessing.get_context("spawn").Pool(2) as found:
        yield found


@pytest.mark.parametrize("name", SENT)
def test_objects_go_to_spawned_processes(name, pool):
    make, asked = SENT[name]
    assert pool.map(asked, [make(), make()]) == [asked(make())] * 2


@pytest.mark.parametrize("error", [hf.Error("x"), hf.Rejection([("run.dt", "wrong")]), hf.FileError("no file"),
                                   hf.StepFailed("step 3", "not_converged", 2, 0.5, "try a smaller dt")])
def test_errors_come_back_from_processes(error):
    other = pickle.loads(pickle.dumps(error))
    assert type(other) is type(error) and str(other) == str(error)
    names = set(vars(error)) & {"errors", "kind", "step", "t", "hint"}
    assert {name: getattr(other, name) for name in names} == {name: getattr(error, name) for name in names}


def test_a_comparison_stays_here_and_says_so():
    with pytest.raises(TypeError, match="pickle.*rows"):
        pickle.dumps(hf.compare(SCENARIO, methods="verlet", dt=[0.1]))


def test_threads_side_by_side_give_the_bits_of_one_after_the_other():
    def tasks():
        sims = [hf.Simulation(START, method=method, dt=0.05, arithmetic=arithmetic)
                for method in ("stv4", "cg(1,5)", "taylor", "gauss(2)") for arithmetic in ("double", "quad")]
        yield from ((lambda sim=sim: [sim.advance(7) for _ in range(30)] and bytes_of(sim)) for sim in sims)
        yield lambda: hf.run(SCENARIO).q.tobytes()
        yield lambda: hf.sweep(SCENARIO, {"problem.initial.q[1]": np.linspace(-0.1, 0.1, 40)}, threads=2)["final/q"].tobytes()
        yield lambda: hf.propagate("henon-heiles", "stv4", np.full((40, 2), 0.1), np.zeros((40, 2)), dt=0.1, steps=50)[0].tobytes()
        yield lambda: str(hf.compare(SCENARIO, methods=["verlet", "stv4"], dt=[0.1]).rows[1]["error"])

    wanted = [task() for task in tasks()]
    found = [None] * len(wanted)

    def work(place, task):
        found[place] = task()

    for _ in range(3):
        threads = [threading.Thread(target=work, args=each) for each in enumerate(tasks())]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        assert found == wanted


def test_every_use_by_a_second_thread_raises():
    sim, stop = hf.Simulation(START, method="stv4", dt=0.1), threading.Event()
    entered = threading.Event()

    @sim.observe(every=1000)
    def hold(s):
        entered.set()
        return "stop" if stop.is_set() else None

    thread = threading.Thread(target=sim.advance, args=(10**12,))
    thread.start()
    entered.wait()
    uses = [lambda: sim.advance(1), lambda: sim.sample(steps=1), lambda: sim.reverse(), lambda: sim.copy(), lambda: sim.save(),
            lambda: sim.q, lambda: sim.t, lambda: sim.energy_error, lambda: sim.invariants, lambda: sim.evaluations,
            lambda: pickle.dumps(sim), lambda: sim.load(b"")]
    try:
        for use in uses:
            with pytest.raises(hf.Error, match="another thread"):
                use()
    finally:
        stop.set()
        thread.join()
    sim.advance(1)


# Ctrl-C. The signal is sent once the process has computed for a while, by its own processor time.

INTERRUPTED = """
import os, signal, threading, time
import hamflow as hf
def send():
    begin = time.process_time()
    while time.process_time() < begin + 0.3:
        time.sleep(0.01)
    os.kill(os.getpid(), signal.SIGINT)
start = {"name": "pendulum", "initial": {"q": [1], "p": [0]}}
def scenario(steps, **run):
    return hf.Scenario(problem=start, method="stv4", run={"dt": 0.01, "steps": steps} | run)
sim = hf.Simulation(start, method="stv4", dt=0.01)
long = scenario(10**11)
threading.Thread(target=send).start()
caught = None
try:
    CALL
except KeyboardInterrupt as error:
    caught = error
assert caught is not None
partial = getattr(caught, "partial", None)
CHECK
# Everything is usable afterwards.
sim.advance(3)
assert hf.run(scenario(5)).status == "done"
print("fine")
"""
STEP_BOUNDARY = """
other = hf.Simulation(start, method="stv4", dt=0.01)
assert sim.step > 0
other.advance(sim.step)
assert sim.q.tobytes() == other.q.tobytes() and sim.t == other.t
"""
INTERRUPTS = {
    "advance": ("sim.advance(10**12)", STEP_BOUNDARY),
    "integrate": ("sim.integrate(1e9)", STEP_BOUNDARY),
    "sample": ("sim.sample(steps=10**12, every=10**9)", STEP_BOUNDARY),
    "sample at": ("sim.sample(at=[1e9])", STEP_BOUNDARY),
    "run": ("hf.run(long)", "assert partial.status == 'interrupted' and partial.q.shape == (len(partial.t), 1)"),
    "run in a folder": ("hf.run(long, out='a.run')", "assert partial.status == 'interrupted' == hf.open('a.run').status"),
    "sweep": ("hf.sweep(long, {'problem.initial.q[0]': [1, 2, 3]})",
              "assert len(partial) == 3 and 'done' not in partial.status and partial.summary['status'] == 'interrupted'"),
    "propagate": ("hf.propagate('pendulum', 'stv4', [[1], [2]], [[0], [0]], dt=0.01, steps=10**11)", ""),
    "compare": ("hf.compare(scenario(10**9), methods=['verlet', 'stv4'], dt=[0.01, 0.02])", "assert partial.status == 'interrupted'"),
    "verify": ("hf.verify(all=True)", "assert isinstance(partial.rows, list)"),
    "reverse": ("hf.reverse(scenario(10**11, arithmetic='lattice'))", ""),
}


@pytest.mark.parametrize("name", INTERRUPTS)
def test_ctrl_c(name, tmp_path):
    call, check = INTERRUPTS[name]
    code = INTERRUPTED.replace("CALL", call).replace("CHECK", check)
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (0, "fine\n"), done.stderr


def test_ctrl_c_of_certify_step():
    calls = []

    def step(q, p, h):
        calls.append(h)
        if len(calls) == 50:
            signal.raise_signal(signal.SIGINT)
        return q + h * p, p - h * (q + h * p)

    with pytest.raises(KeyboardInterrupt):
        hf.certify_step(step, "harmonic")
    assert hf.certify_step(step, "harmonic", order=1).agrees


def test_an_interrupted_folder_goes_on_to_the_bit(tmp_path):
    code = INTERRUPTED.replace("CALL", "hf.run(scenario(10**11, record_every=10**6), out='a.run')").replace("CHECK", "")
    subprocess.run([sys.executable, "-B", "-c", code], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    reached = hf.open(tmp_path / "a.run").summary["steps"]
    longer = hf.Scenario(problem={"name": "pendulum", "initial": {"q": [1], "p": [0]}}, method="stv4",
                         run={"dt": 0.01, "steps": reached + 1000, "record_every": 10**6})
    resumed, once = hf.run(longer, out=tmp_path / "a.run", existing="resume"), hf.run(longer)
    assert reached > 0 and resumed.q.tobytes() == once.q.tobytes() and resumed.summary["final"] == once.summary["final"]

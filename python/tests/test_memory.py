"""Memory: nothing is lost with the objects, views keep theirs, and arrays of every kind come in."""

import gc
import itertools
import os
import subprocess
import sys

import numpy as np
import pytest

import hamflow as hf

PENDULUM = {"name": "pendulum", "initial": {"q": [1], "p": [0]}}
SCENARIO = hf.Scenario(problem=PENDULUM, method="stv4",
                       run={"dt": 0.2, "steps": 40, "certificate": False, "section": {"coordinate": "q"}},
                       output={"observables": {"c": "cos(q)"}})
SIMULATION = hf.Simulation(PENDULUM, dt=0.1)


def resident():
    """Bytes of this process that are in memory."""
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def refused():
    try:
        hf.Problem("p^2/2 + nothing", coordinates=["q"])
    except hf.Error:
        pass


def observed():
    sim = SIMULATION.copy()
    sim.observe(every=1)(lambda s: s.q)
    sim.advance(2)


# How often; together more than 10^5 objects.
MADE = {
    "copies": (lambda: SIMULATION.copy().q, 60_000),
    "saved": (lambda: SIMULATION.save(), 60_000),
    "simulations": (lambda: hf.Simulation(PENDULUM, dt=0.1), 1500),
    "observed": (observed, 3000),
    "samples": (lambda: SIMULATION.copy().sample(steps=100).q, 10_000),
    "problems": (lambda: hf.Problem("p^2/2 + cos(q)", coordinates=["q"]), 3000),
    "refused": (refused, 3000),
    "scenarios": (lambda: hf.Scenario.from_text(str(SCENARIO)), 2000),
    "runs": (lambda: hf.run(SCENARIO), 1000),
    "sweeps": (lambda: hf.sweep(SCENARIO, {"run.dt": [0.1, 0.2]}, threads=1), 300),
    "columns": (lambda: [TABLE[name] for name in TABLE.columns], 5000),
}
TABLE = hf.run(SCENARIO)


@pytest.mark.parametrize("name", MADE)
def test_objects_leave_no_memory_behind(name):
    make, count = MADE[name]

    def many():
        for _ in range(count):
            make()

    many()  # fills the caches, and the pools of the allocators
    between = resident()
    many()
    # The smallest of these objects has more than 200 bytes; the allocators take memory by the mebibyte.
    assert resident() - between < 50 * count + 2**21, name


def samples():
    return SIMULATION.copy().sample(steps=500)


def sections():
    return hf.run(SCENARIO)


def sweeps():
    return hf.sweep(SCENARIO, {"problem.initial.q[0]": np.linspace(0.1, 1, 300)})


VIEWS = {
    "samples": (samples, [lambda x: x.q, lambda x: x.p, lambda x: x.t, lambda x: x.energy, lambda x: x["q"]]),
    "run": (sections, [lambda x: x.q, lambda x: x.energy, lambda x: x["c"], lambda x: x.section.q, lambda x: x.section.t]),
    "sweep": (sweeps, [lambda x: x["final/q"], lambda x: x["energy/max_error"], lambda x: x["varied/problem.initial.q[0]"],
                       lambda x: x.section["section/q"]]),
}


@pytest.mark.parametrize("name", VIEWS)
def test_views_outlive_their_owners(name):
    make, columns = VIEWS[name]
    wanted = [column(make()).copy() for column in columns]
    for order in itertools.permutations(range(len(columns) + 1)):
        alive = {0: make()} | {k + 1: None for k in range(len(columns))}
        alive |= {k + 1: column(alive[0]) for k, column in enumerate(columns)}
        for gone in order:
            alive.pop(gone)
            junk = [np.full(600, np.nan) for _ in range(20)]  # takes memory that was given back
            for k, view in alive.items():
                assert k == 0 or np.array_equal(view, wanted[k - 1]), (order, gone, k)
            del junk


@pytest.mark.parametrize("name", VIEWS)
def test_views_are_read_only_doubles_in_c_order(name):
    make, columns = VIEWS[name]
    for column in columns:
        view = column(make())
        assert view.dtype == np.float64 and not view.flags.writeable and view.base is not None
        assert view.flags.c_contiguous or view.ndim == 1  # a coordinate is every d-th number of q
        with pytest.raises(ValueError):
            view[...] = 0
        with pytest.raises(ValueError):
            view.flags.writeable = True


def test_states_are_copies():
    sim = SIMULATION.copy()
    q = sim.q
    q[:] = 5
    sim.advance(1)
    assert q[0] == 5 and sim.q[0] < 1 and sim.q.flags.owndata and sim.q.flags.writeable


FIRST = ("import h5py; import hamflow as hf", "import hamflow as hf; import h5py")


@pytest.mark.parametrize("imports", FIRST)
def test_h5py_in_the_same_process(imports, tmp_path):
    code = imports + f"""
hf.run(hf.Scenario.from_text({str(SCENARIO)!r}), out="a.run")
for _ in range(3):
    with h5py.File("a.run/run.h5") as file:
        kept = file["q"][:]
        assert (hf.open("a.run").q == kept).all()  # both have the file open
    assert (hf.open("a.run").q == kept).all()
    try:
        hf.open("nothing.run")
    except hf.FileError:
        pass
    try:
        h5py.File("nothing.h5")
    except OSError:
        pass
with h5py.File("b.h5", "w") as file:
    file["x"] = kept
print(kept.shape)"""
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "(41, 1)\n", "")


DTYPES = [np.int8, np.uint8, np.int16, np.int32, np.uint32, np.int64, np.uint64, np.float16, np.float32, np.float64, np.longdouble,
          ">f8", ">i4", object]
LAYOUTS = {
    "C": lambda x: np.array(x, order="C"),
    "F": lambda x: np.array(x, order="F"),
    "every second row": lambda x: np.repeat(x, 2, axis=0)[::2],
    "every second column": lambda x: np.repeat(x, 2, axis=1)[:, ::2],
    "backwards": lambda x: np.array(x[::-1])[::-1],
    "columns backwards": lambda x: np.array(x[:, ::-1])[:, ::-1],
    "one row for all": lambda x: np.broadcast_to(x[0], x.shape),
    "within a record": lambda x: np.array(np.stack([x, x], axis=-1))[..., 0],
    "lists": lambda x: x.tolist(),
    "tuples": lambda x: tuple(map(tuple, x.tolist())),
    "list of arrays": lambda x: list(x),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", DTYPES, ids=lambda x: np.dtype(x).str)
def test_arrays_of_every_kind(dtype, layout):
    problem = hf.Problem("henon-heiles")
    q, p = (LAYOUTS[layout](np.array(rows, dtype=dtype)) for rows in ([[0, 1], [1, 0], [1, 1]], [[1, 0], [0, 0], [0, 1]]))
    plain = [np.array(np.array(x).tolist(), dtype=np.float64) for x in (q, p)]
    before = np.array(q).tolist()
    assert np.array_equal(problem.energy(q, p), problem.energy(*plain))
    for found, wanted in zip(problem.gradient(q, p), problem.gradient(*plain)):
        assert np.array_equal(found, wanted)
    for found, wanted in zip(hf.propagate(problem, "stv4", q, p, dt=0.01, steps=3),
                             hf.propagate(problem, "stv4", *plain, dt=0.01, steps=3)):
        assert np.array_equal(found, wanted)
    one, other = hf.Simulation(problem, q=q[1], p=p[1], dt=0.01), hf.Simulation(problem, q=plain[0][1], p=plain[1][1], dt=0.01)
    assert np.array_equal(one.q, other.q) and np.array(q).tolist() == before


def test_arrays_that_cannot_be_written():
    q, p = np.array([[0.1, 0.2]]), np.zeros((1, 2))
    q.flags.writeable = p.flags.writeable = False
    problem = hf.Problem("henon-heiles")
    assert problem.energy(q, p) == problem.energy([[0.1, 0.2]], [[0, 0]])
    assert hf.Simulation(problem, q=q[0], p=p[0], dt=0.1).q.tolist() == [0.1, 0.2]


def test_numbers_of_numpy_are_numbers():
    for dt in (np.float32(0.5), np.float16(0.5), np.longdouble(0.5), np.array(0.5), np.float64(0.5)):
        sim = hf.Simulation("pendulum", q=np.array([1]), p=[np.array(0.0)], dt=dt)
        sim.advance(np.int32(3))
        sim.integrate(np.float32(3))
        assert sim.t == 3 and len(sim.sample(steps=np.uint8(4), every=np.int64(2))) == 3


def test_float16_and_text_keep_their_value():
    assert hf.Simulation("pendulum", q=np.array([0.1], dtype=np.float16), p=[0], dt=0.1).q[0] == float(np.float16(0.1))
    assert hf.Simulation("pendulum", q=np.array(["1/3"]), p=[0], dt=0.1).q[0] == 1 / 3

"""Every function of the surface refuses what it cannot use: by Error, TypeError or ValueError, and by nothing else."""

import datetime
import faulthandler
import sys
import warnings
from decimal import Decimal

import matplotlib
import matplotlib.pyplot
import numpy as np
import pytest

import hamflow as hf

matplotlib.use("Agg")


def endless_list():
    found = []
    found.append(found)
    return found


def endless_dict():
    found = {}
    found["x"] = found
    return found


def nested(depth):
    found = [1]
    for _ in range(depth):
        found = [found]
    return found


class EndlessArray:
    def tolist(self):
        return self


# Objects whose own methods raise are left out: what they raise reaches the caller.
VALUES = {
    "None": None, "True": True, "nan": float("nan"), "inf": float("inf"), "1e308": 1e308, "-1": -1, "0": 0, "2^63 - 1": 2**63 - 1,
    "10^30": 10**30, "-10^30": -10**30, "1j": 1j, "Decimal nan": Decimal("nan"), "object": object(), "type": int, "module": sys,
    "function": lambda *x, **more: None, "date": datetime.date(2020, 1, 1), "datetime64": np.datetime64("2020-01-01"),
    "no text": "", "number as text": "1/50", "long text": "x" * 10**5, "long number": "9" * 10**5, "parentheses": "(" * 10**5,
    "zero byte": "a\0b", "surrogate": "\ud800", "bytes": b"abc", "no UTF-8": b"\xff\xfe",
    "no entries": [], "None in a list": [None, None], "texts": ["a", "b"], "tuple": (1, 2), "set": {1, 2}, "deep list": nested(5000),
    "endless list": endless_list(), "endless dict": endless_dict(), "endless array": EndlessArray(), "no keys": {},
    "number as key": {1: 2}, "dicts in dicts": {"a": {"b": {"c": [1, {"d": 2}]}}},
    "array (2, 3, 4)": np.zeros((2, 3, 4)), "array (0, 2)": np.zeros((0, 2)), "array of objects": np.array([object()]),
    "array of texts": np.array(["a"]), "array of nan": np.full(2, np.nan), "array ()": np.array(1.0),
}

PENDULUM, HENON = hf.Problem("pendulum"), hf.Problem("henon-heiles")
START = PENDULUM.at(q=[1], p=[0])
SHORT = {"dt": 0.1, "steps": 10}
SCENARIO = hf.Scenario(problem=START, method="stv4", run=SHORT)
SIMULATION = hf.Simulation(PENDULUM, q=[1], p=[0], dt=0.1)


def simulation(**keys):
    return hf.Simulation(PENDULUM, **({"q": [1], "p": [0], "dt": 0.1} | keys))


def scenario():
    return hf.Scenario.from_text(str(SCENARIO))


def observed(told):
    sim = SIMULATION.copy()
    sim.observe()(told)
    sim.advance(2)


def leapfrog(q, p, h):
    p = p - h / 2 * q
    q = q + h * p
    return q, p - h / 2 * q


def propagated(problem=PENDULUM, method="stv4", q=((1,),), p=((0,),), **keys):
    hf.propagate(problem, method, q, p, **({"dt": 0.1, "steps": 2} | keys))


@pytest.fixture(scope="module")
def results():
    return {"run": hf.run(SCENARIO), "sweep": hf.sweep(SCENARIO, {"run.dt": [0.1, 0.2]}),
            "compare": hf.compare(SCENARIO, methods="verlet", dt=[0.1]), "samples": SIMULATION.copy().sample(steps=4)}


CALLS = {
    "Problem": lambda x: hf.Problem(x),
    "Problem with a dimension": lambda x: hf.Problem(x, dimension=2),
    "Problem: coordinates": lambda x: hf.Problem("p^2/2+q^2", coordinates=x),
    "Problem: dimension": lambda x: hf.Problem("p^2/2+q^2", dimension=x),
    "Problem: parameters": lambda x: hf.Problem("p^2/2+a*q^2", coordinates=["q"], parameters=x),
    "Problem: a parameter": lambda x: hf.Problem("p^2/2+a*q^2", coordinates=["q"], parameters={"a": x}),
    "Problem: a key": lambda x: hf.Problem("pendulum", length=x),
    "Problem: masses": lambda x: hf.Problem("n-body", masses=x),
    "Problem: orbit": lambda x: hf.Problem("central-force", potential="kepler", orbit=x),
    "Problem.energy": lambda x: HENON.energy(x, x),
    "Problem.energy: p": lambda x: HENON.energy([0, 0], x),
    "Problem.gradient": lambda x: HENON.gradient(x, x),
    "Problem.at": lambda x: hf.Scenario(problem=PENDULUM.at(q=x, p=x), method="stv4", run=SHORT),
    "Problem.at: energy": lambda x: hf.Scenario(problem=PENDULUM.at(q=[1], p=["+"], energy=x), method="stv4", run=SHORT),
    "methods": lambda x: hf.methods(x),
    "show": lambda x: hf.show(x),
    "cite": lambda x: hf.cite(x),
    "Simulation": lambda x: hf.Simulation(x, dt=0.1),
    "Simulation: method": lambda x: simulation(method=x),
    "Simulation: q": lambda x: simulation(q=x),
    "Simulation: a coordinate": lambda x: simulation(q=[x]),
    "Simulation: v": lambda x: simulation(p=None, v=x),
    "Simulation: dt": lambda x: simulation(dt=x),
    "Simulation: arithmetic": lambda x: simulation(arithmetic=x),
    "Simulation: threads": lambda x: simulation(threads=x),
    "Simulation: parameters": lambda x: simulation(parameters=x),
    "Simulation: a parameter": lambda x: simulation(parameters={"length": x}),
    "Simulation.advance": lambda x: SIMULATION.copy().advance(x),
    "Simulation.integrate": lambda x: SIMULATION.copy().integrate(x),
    "Simulation.sample: steps": lambda x: SIMULATION.copy().sample(steps=x),
    "Simulation.sample: every": lambda x: SIMULATION.copy().sample(steps=10, every=x),
    "Simulation.sample: at": lambda x: SIMULATION.copy().sample(at=x),
    "Simulation.sample: a time": lambda x: SIMULATION.copy().sample(at=[x]),
    "Simulation.sample: digits": lambda x: SIMULATION.copy().sample(steps=2, digits=x),
    "Simulation.load": lambda x: SIMULATION.copy().load(x),
    "Simulation.observe: every": lambda x: SIMULATION.copy().observe(every=x)(print),
    "Simulation.observe": observed,
    "Simulation of a pickle": lambda x: SIMULATION.copy().__setstate__({"scenario": x, "saved": x}),
    "Scenario": lambda x: hf.Scenario(x),
    "Scenario: problem": lambda x: hf.Scenario(problem=x, method="stv4", run=SHORT),
    "Scenario: method": lambda x: hf.Scenario(problem=START, method=x, run=SHORT),
    "Scenario: run": lambda x: hf.Scenario(problem=START, method="stv4", run=x),
    "Scenario: output": lambda x: hf.Scenario(problem=START, method="stv4", run=SHORT, output=x),
    "Scenario.load": lambda x: hf.Scenario.load(x),
    "Scenario.from_text": lambda x: hf.Scenario.from_text(x),
    "Scenario.from_text: name": lambda x: hf.Scenario.from_text(str(SCENARIO), x),
    "Scenario.set: key": lambda x: scenario().set(x, 1),
    "Scenario.set: steps": lambda x: scenario().set("run.steps", x),
    "Scenario.set: start": lambda x: scenario().set("problem.initial.q", x),
    "Scenario.set: a table": lambda x: scenario().set("run", x),
    "run": lambda x: hf.run(x),
    "run: out": lambda x: hf.run(SCENARIO, out=x),
    "run: existing": lambda x: hf.run(SCENARIO, existing=x),
    "run: progress": lambda x: hf.run(SCENARIO, progress=x),
    "run: digits": lambda x: hf.run(SCENARIO, digits=x),
    "open": lambda x: hf.open(x),
    "reverse": lambda x: hf.reverse(x),
    "compare": lambda x: hf.compare(x, methods=["verlet"]),
    "compare: methods": lambda x: hf.compare(SCENARIO, methods=x),
    "compare: dt": lambda x: hf.compare(SCENARIO, methods=["verlet"], dt=x),
    "compare: a dt": lambda x: hf.compare(SCENARIO, methods=["verlet"], dt=[x]),
    "compare: out": lambda x: hf.compare(SCENARIO, methods=["verlet"], dt=[0.1], out=x),
    "compare: existing": lambda x: hf.compare(SCENARIO, methods=["verlet"], dt=[0.1], existing=x),
    "compare: progress": lambda x: hf.compare(SCENARIO, methods=["verlet"], dt=[0.1], progress=x),
    "verify": lambda x: hf.verify(x),
    "verify: problem": lambda x: hf.verify("verlet", problem=x or "no problem"),
    "sweep": lambda x: hf.sweep(x, {"run.dt": [0.1]}),
    "sweep: varied": lambda x: hf.sweep(SCENARIO, x),
    "sweep: values": lambda x: hf.sweep(SCENARIO, {"run.dt": x}),
    "sweep: a value": lambda x: hf.sweep(SCENARIO, {"run.dt": [x]}),
    "sweep: threads": lambda x: hf.sweep(SCENARIO, {"run.dt": [0.1]}, threads=x),
    "sweep: out": lambda x: hf.sweep(SCENARIO, {"run.dt": [0.1]}, out=x),
    "sweep: existing": lambda x: hf.sweep(SCENARIO, {"run.dt": [0.1]}, existing=x),
    "sweep: progress": lambda x: hf.sweep(SCENARIO, {"run.dt": [0.1]}, progress=x),
    "sweep: client": lambda x: hf.sweep(SCENARIO, {"run.dt": [0.1]}, client=x),
    "propagate": lambda x: propagated(problem=x),
    "propagate: method": lambda x: propagated(method=x),
    "propagate: q and p": lambda x: propagated(q=x, p=x),
    "propagate: p": lambda x: propagated(p=x),
    "propagate: dt": lambda x: propagated(dt=x),
    "propagate: steps": lambda x: propagated(steps=x),
    "propagate: parameters": lambda x: propagated(parameters=x),
    "propagate: a parameter": lambda x: propagated(parameters={"length": x}),
    "convert": lambda x: hf.convert(x, to="polar"),
    "convert: to": lambda x: hf.convert(SCENARIO, to=x),
    "convert: (q, p)": lambda x: hf.convert((x, x), start="cartesian", to="polar"),
    "convert: start": lambda x: hf.convert(([1, 0], [0, 1]), start=x, to="polar"),
    "convert: method": lambda x: hf.convert(SCENARIO, to="cartesian", method=x),
    "certify": lambda x: hf.certify(x, x),
    "certify: energy": lambda x: hf.certify(np.arange(100.0), x),
    "certify: scale": lambda x: hf.certify(np.arange(100.0), np.sin(np.arange(100.0)) + 5, scale=x),
    "certify_step": lambda x: hf.certify_step(x, "harmonic"),
    "certify_step: problem": lambda x: hf.certify_step(leapfrog, x),
    "certify_step: order": lambda x: hf.certify_step(leapfrog, "harmonic", order=x),
    "certify_step: symplectic": lambda x: hf.certify_step(leapfrog, "harmonic", symplectic=x),
    "certify_step: preserves": lambda x: hf.certify_step(leapfrog, "harmonic", preserves=x),
    "certify_step: what a step returns": lambda x: hf.certify_step(lambda q, p, h: x, "harmonic"),
    "certify_step: a part of it": lambda x: hf.certify_step(lambda q, p, h: (q, x), "harmonic"),
    "sin": lambda x: hf.sin(x),
    "atan2": lambda x: hf.atan2(x, 1),
}
OF_RESULTS = {
    "Run.digits": lambda all, x: all["run"].digits(x),
    "Run.plot": lambda all, x: all["run"].plot(x),
    "Run.plot: ax": lambda all, x: all["run"].plot("time", x),
    "Run.plot: x": lambda all, x: all["run"].plot("time", x=x),
    "Run.plot: y": lambda all, x: all["run"].plot("time", y=x),
    "Run.plot: at": lambda all, x: all["run"].plot("time", at=x),
    "Run.figure: file": lambda all, x: all["run"].figure("time", x),
    "Run.save": lambda all, x: all["run"].save(x),
    "Compare.plot": lambda all, x: all["compare"].plot(x),
    "Compare.figure": lambda all, x: all["compare"].figure(x),
    "Sweep.plot": lambda all, x: all["sweep"].plot(x),
    "Sweep.plot: colour": lambda all, x: all["sweep"].plot(colour=x),
    "a column of Run": lambda all, x: all["run"][x],
    "a column of Sweep": lambda all, x: all["sweep"][x],
    "a column of Trajectory": lambda all, x: all["samples"][x],
}


@pytest.mark.parametrize("name", [*CALLS, *OF_RESULTS])
def test_hostile_arguments(name, results, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    allowed = (hf.Error, TypeError, ValueError, *([KeyError] if name.startswith("a column") else []))
    for value, x in VALUES.items():
        faulthandler.dump_traceback_later(60, exit=True)  # what hangs says where
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                CALLS[name](x) if name in CALLS else OF_RESULTS[name](results, x)
        except allowed as error:
            assert "pybind11" not in str(error) or isinstance(error, TypeError), value
        except Exception as error:
            raise AssertionError(f"{name}: {value}") from error
        finally:
            faulthandler.cancel_dump_traceback_later()
    if name in OF_RESULTS:
        matplotlib.pyplot.close("all")


def test_what_objects_raise_reaches_the_caller():
    class Raises:
        def __float__(self):
            raise ZeroDivisionError("mine")

    def raises(*x):
        raise ZeroDivisionError("mine")

    for call in (lambda: simulation(dt=Raises()), lambda: hf.Problem(raises, dimension=1), lambda: observed(raises),
                 lambda: hf.run({"problem": START, "method": "stv4", "run": {"dt": 0.1, "steps": 10**9}}, progress=raises)):
        with pytest.raises(ZeroDivisionError, match="mine"):
            call()


def test_steps_that_no_run_takes_are_refused():
    sim = SIMULATION.copy()
    sim.advance(3)
    for steps in (-1, 2**53 + 1, 2**63 - 1):
        with pytest.raises(hf.Error, match="allowed"):
            sim.advance(steps)
    with pytest.raises(hf.Error, match="memory"):
        sim.sample(steps=2**53)
    assert sim.step == 3 and len(sim.sample(steps=5, every=2**62)) == 1

"""Runs: digits, figures, folders that exist."""

import os
import subprocess
from decimal import Decimal

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")


def pendulum(**run):
    return hf.Scenario(problem=hf.Problem("pendulum").at(q=["1/3"], p=[0]), method="stv4",
                       run={"dt": "1/50", "steps": 40} | run, output={"formats": ["h5", "csv"]})


@pytest.mark.parametrize("arithmetic", ["mp(40)", "quad", "double-double"])
def test_digits_are_those_of_the_command(tmp_path, arithmetic):
    s = pendulum(arithmetic=arithmetic)
    (tmp_path / "s.toml").write_text(str(s))
    subprocess.run([HAMFLOW, "run", "s.toml", "--quiet", "--out", "c.run"], cwd=tmp_path, check=True, capture_output=True)
    head, *lines = (tmp_path / "c.run" / "trajectory.csv").read_text().splitlines()
    columns = dict(zip(head.split(","), zip(*(line.split(",") for line in lines))))
    sim = hf.Simulation(hf.Problem("pendulum"), method="stv4", q=["1/3"], p=[0], dt="1/50", arithmetic=arithmetic)
    for each in (hf.run(s, digits=True), hf.open(tmp_path / "c.run", digits=True),
                 hf.run(s, out=tmp_path / "p.run", existing="replace", digits=True), sim.sample(steps=40, digits=True)):
        for name, values in (("t", each.t), ("q1", each.q[:, 0]), ("p1", each.p[:, 0]), ("energy", each.energy)):
            assert [str(x) for x in values] == [str(Decimal(x)) for x in columns[name]], name
        assert each.q.dtype == object and each["q"][3] == each.q[3, 0] and isinstance(each.t[0], Decimal)
    assert [str(x) for x in sim.sample(at=["4/5"], digits=True).q[0]] == [columns["q1"][-1]]


def test_digits_of_doubles_are_refused():
    for ask in (lambda: hf.run(pendulum(), digits=True),
                lambda: hf.Simulation("pendulum", q=[1], p=[0], dt=0.1).sample(steps=3, digits=True)):
        with pytest.raises(hf.Error, match="double-double|more digits than double"):
            ask()


KINDS = {"orbit": "henon-heiles", "time": "henon-heiles", "energy": "henon-heiles", "energy-error": "henon-heiles",
         "phase": "henon-heiles", "section": "henon-heiles", "particles": "gas", "tracks": "gas", "radial": "gas"}


def a_run(problem):
    if problem == "gas":
        text = subprocess.run([HAMFLOW, "new", "gas"], check=True, capture_output=True, text=True).stdout
        s = hf.Scenario.from_text(text)
        s.set("run.steps", 20)
        return hf.run(s, certificate=False)
    return hf.run({"problem": {"name": problem, "initial": {"q": [0, -0.15], "p": [0.54, 0.1]}}, "method": {"name": "stv4"},
                   "run": {"dt": 0.1, "steps": 2000, "section": {"coordinate": "q1"}}})


@pytest.mark.parametrize("kind", KINDS)
def test_figures_on_axes(kind):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    run = a_run(KINDS[kind])
    axes = np.ravel(run.plot(kind))
    for each in axes:
        assert each.has_data() and each.get_xlabel() and np.isfinite([*each.get_xlim(), *each.get_ylim()]).all()
    axes[0].figure.canvas.draw()
    _, ax = plt.subplots()
    assert run.plot(kind, ax) is ax
    plt.close("all")


def test_figures_that_a_run_does_not_have():
    run = hf.run(pendulum())
    with pytest.raises(hf.Error, match="orbit"):
        run.plot("orbit")
    with pytest.raises(hf.Error, match="allowed"):
        run.plot("nothing")


def test_tables_are_keys_of_scenarios():
    s = pendulum()
    s.set("run", {"dt": 0.5, "steps": 3})
    assert s.steps == 3 and s.dt == 0.5


def test_an_opened_run_has_the_columns_of_one_in_memory(tmp_path):
    kept = hf.run(pendulum(), out=tmp_path / "a.run")
    once = hf.run(pendulum())
    assert set(kept.columns) == set(once.columns) and once["q"].shape == once["p"].shape == (41,)
    for name in once.columns:
        assert np.array_equal(kept[name], once[name]), name


def test_a_run_in_a_notebook():
    pytest.importorskip("matplotlib")
    shown = hf.run(pendulum())._repr_html_()
    assert "<table>" in shown and "<svg" in shown and "pendulum" in shown


def test_messages_name_arguments(tmp_path):
    for how in (lambda: hf.run(pendulum(), out=tmp_path / "a.run"),
                lambda: hf.sweep(pendulum(), {"run.dt": [0.1, 0.2]}, out=tmp_path / "s")):
        how()
        with pytest.raises(hf.FileError, match='existing="resume" to continue.*existing="replace"') as caught:
            how()
        assert "--" not in str(caught.value)
    with pytest.raises(hf.Rejection, match='existing="resume"') as caught:
        hf.run(pendulum(dt="1/60"), out=tmp_path / "a.run", existing="resume")
    assert "--" not in str(caught.value)
    with pytest.raises(hf.Rejection) as caught:
        hf.sweep(pendulum(), {"output.folder": ["x"]})
    assert caught.value.errors[0][0] == "varied" and "--" not in str(caught.value)


def test_a_sweep_is_no_run(tmp_path):
    hf.sweep(pendulum(), {"run.dt": [0.1, 0.2]}, out=tmp_path / "s")
    with pytest.raises(hf.FileError, match="Sweep.plot draws it"):
        hf.open(tmp_path / "s")


def test_resume_goes_on(tmp_path):
    hf.run(pendulum(), out=tmp_path / "a.run")
    longer = hf.run(pendulum(steps=80), out=tmp_path / "a.run", existing="resume")
    once = hf.run(pendulum(steps=80))
    assert longer.q.tobytes() == once.q.tobytes() and longer.summary["final"] == once.summary["final"]


def test_sweeps_are_drawn():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ens = hf.sweep(pendulum(), {"problem.initial.q[0]": np.linspace(0.1, 1, 5)})
    ax = ens.plot()
    assert np.array_equal(ax.lines[0].get_ydata(), ens["energy/max_error"]) and "<table>" in ens._repr_html_()
    plane = hf.sweep(pendulum(), {"problem.initial.q[0]": [0.1, 0.2, 0.3], "problem.initial.p[0]": [0, 0.1]})
    plane.plot(colour="energy/scale").figure.canvas.draw()
    with pytest.raises(hf.Error, match="colour"):
        ens.plot(colour="nothing")


def test_doctests():
    import doctest
    import importlib

    for name in ("_compare", "_convert", "_run", "_show", "_sweep", "_verify"):
        assert doctest.testmod(importlib.import_module("hamflow." + name)).failed == 0


def test_sampling_ends_where_an_observer_says_stop():
    sim = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05)
    sim.observe(every=7)(lambda s: "stop")
    found = sim.sample(at=np.linspace(0.1, 5, 50))
    assert sim.step == 7 and found.t[-1] <= 0.35 + 0.05
    alone = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05).sample(at=found.t)
    assert np.array_equal(found.q, alone.q)


def test_an_observer_that_says_something_else():
    sim = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05)
    sim.observe(every=7)(lambda s: "stopp")
    with pytest.raises(hf.Error, match="stopp"):
        sim.advance(20)


def test_attributes_of_a_simulation_are_its_own():
    sim = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05)
    for name in ("dt", "t", "steps_typo"):
        with pytest.raises(AttributeError):
            setattr(sim, name, 1)


def test_damaged_saves_are_refused():
    sim = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05)
    saved = sim.save()
    for k in range(len(saved)):
        with pytest.raises(hf.Error):
            sim.load(saved[:k] + bytes([saved[k] ^ 1]) + saved[k + 1:])
    sim.load(saved)


def test_what_progress_raises_is_raised():
    long = {"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.3, 0]}}, "method": "stv4",
            "run": {"dt": 0.05, "steps": 10**8, "certificate": False, "record_every": 10**6}}
    with pytest.raises(ZeroDivisionError) as error:
        hf.run(long, progress=lambda done, total: 1 / 0)
    assert error.value.partial.status == "interrupted"
    with pytest.raises(ZeroDivisionError) as error:
        hf.sweep(long, {"run.dt": [0.05, 0.1]}, progress=lambda done, total: 1 / 0)
    assert len(error.value.partial) == 2


def test_progress_ends_with_its_total():
    told = []
    hf.run({"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.3, 0]}}, "method": "stv4",
            "run": {"dt": 0.05, "steps": 1000}}, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (1000, 1000)


def test_members_without_a_start_are_failures():
    found = hf.sweep({"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": ["+", 0], "energy": 0.1}},
                      "method": "stv4", "run": {"dt": 0.05, "steps": 10}}, {"problem.initial.q[1]": [0.1, 0.9, -0.9, 0.2]})
    assert found.status == ["done", "no_start", "no_start", "done"]
    assert [text.split(",")[0] for text in found.failures] == ["member 1", "member 2"]


def test_results_are_pickled():
    import copy
    import pickle

    scenario = {"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.3, 0]}}, "method": "stv4",
                "run": {"dt": 0.05, "steps": 500, "section": {"coordinate": "q1"}, "arithmetic": "quad"}}
    run = hf.run(scenario)
    sim = hf.Simulation("henon-heiles", q=[0, 0.1], p=[0.3, 0], dt=0.05)
    samples = sim.sample(steps=10)
    ens = hf.sweep(scenario, {"run.dt": [0.05, 0.1]})
    for restore in (lambda x: pickle.loads(pickle.dumps(x)), copy.deepcopy):
        again = restore(run)
        assert np.array_equal(again.q, run.q) and again.summary == run.summary and list(again.digits("q")[3]) == list(run.digits("q")[3])
        assert np.array_equal(again.section.q, run.section.q)
        assert np.array_equal(restore(samples).p, samples.p)
        swept = restore(ens)
        assert np.array_equal(swept["final/q"], ens["final/q"]) and swept.status == ens.status
        assert np.array_equal(swept.section.q, ens.section.q)


def test_nearest_names():
    with pytest.raises(hf.Error, match="did you mean henon-heiles"):
        hf.Problem("henon_heiles")
    with pytest.raises(hf.Error, match="did you mean pendulum"):
        hf.Problem("pendulun")


def test_digits_in_double_are_refused_before_the_run():
    with pytest.raises(hf.Error, match="double-double"):
        hf.run({"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.3, 0]}}, "method": "stv4",
                "run": {"dt": 0.05, "steps": 10**12}}, digits=True)


def test_ctrl_c_while_members_are_read():
    """It is said by `partial`, which is None: no member has begun."""
    import signal
    import threading

    stop = threading.Timer(0.15, os.kill, (os.getpid(), signal.SIGINT))
    stop.start()
    with pytest.raises(KeyboardInterrupt) as error:
        hf.sweep({"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.3, 0]}}, "method": "stv4",
                  "run": {"dt": 0.05, "steps": 10**7, "certificate": False}},
                 {"problem.initial.q[1]": np.linspace(-0.3, 0.3, 100_000)})
    assert error.value.partial is None or len(error.value.partial) == 100_000

"""hf.convert: runs and scenarios in other coordinates."""

import csv
import io
import os
import subprocess

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")


def kepler(**run):
    return hf.Scenario(problem=hf.Problem("central-force", potential="kepler").at(q=[1, 0], p=[0, 1.2]), method="stv4",
                       run={"dt": 0.05, "steps": 100} | run)


@pytest.mark.parametrize("arithmetic", ["double", "mp(40)"])
def test_columns_are_those_of_the_command(tmp_path, arithmetic):
    run = hf.run(kepler(arithmetic=arithmetic), out=tmp_path / "k.run")
    told = subprocess.run([HAMFLOW, "convert", tmp_path / "k.run", "--to", "polar"], check=True, capture_output=True,
                          text=True).stdout
    rows = list(csv.DictReader(io.StringIO(told)))
    beyond = arithmetic != "double"
    for given in (run, hf.run(kepler(arithmetic=arithmetic)), tmp_path / "k.run"):
        orbit = hf.convert(given, to="polar", digits=beyond)
        for name in ("t", "r", "phi", "p_r", "p_phi", "energy"):
            assert [str(x) if beyond else float(x) for x in orbit[name]] == [
                row[name] if beyond else float(row[name]) for row in rows], name
    assert np.allclose(np.array(orbit["p_phi"], dtype=float), 1.2)


def test_scenarios(tmp_path):
    polar = hf.convert(kepler(), to="polar", method="cg(1,5)")
    assert polar.coordinates == ["r", "phi"] and "cg" in str(polar)
    with pytest.raises(hf.Error, match="Scenario.set|separable"):
        hf.convert(kepler(), to="polar")
    with pytest.warns(UserWarning, match="run.section"):
        hf.convert(kepler(section={"coordinate": "x"}), to="polar", method="cg")


def test_what_cannot_be_converted():
    with pytest.raises(hf.Error, match="polar"):
        hf.convert(kepler(), to="spherical")
    pendulum = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 5})
    with pytest.raises(hf.Error):
        hf.convert(hf.run(pendulum), to="polar")
    with pytest.raises(TypeError, match="method"):
        hf.convert(hf.run(kepler()), to="polar", method="cg")


def test_samples_too_far_apart_for_turns():
    far = kepler(steps=4000, record_every=500)
    with pytest.warns(UserWarning, match="phi changes by up to"):
        hf.convert(hf.run(far), to="polar")


def test_states():
    q, p = np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([[0.0, 1.0], [1.0, 0.5]])
    polar = hf.convert((q, p), start="cartesian", to="polar")
    back = hf.convert(polar, start="polar", to="cartesian")
    assert np.allclose(polar[1][:, 1], q[:, 0] * p[:, 1] - q[:, 1] * p[:, 0]) and np.allclose(back, (q, p))
    assert np.array_equal(hf.convert((q[1], p[1]), start="cartesian", to="polar")[0], polar[0][1])
    with pytest.raises(hf.Error, match="r = 0|r > 0"):
        hf.convert(([0, 0], [1, 0]), start="cartesian", to="polar")
    with pytest.raises(TypeError, match="start"):
        hf.convert((q, p), to="polar")
    with pytest.raises(hf.Error, match="one shape"):
        hf.convert((q, p[0]), start="cartesian", to="polar")

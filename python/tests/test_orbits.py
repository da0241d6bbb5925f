"""Orbital elements in Python, alone and of a run."""

import math

import numpy as np
import pytest

import hamflow as hf


def test_there_and_back():
    random = np.random.default_rng(1)
    n = 1000
    e = np.concatenate([random.uniform(0, 0.99, n // 2), random.uniform(1.01, 5, n // 2)])
    given = dict(a=np.where(e < 1, 1, -1) * random.uniform(0.1, 50, n), e=e, inclination=random.uniform(0.01, 3.1, n),
                 node=random.uniform(0, 2 * np.pi, n), pericentre=random.uniform(0, 2 * np.pi, n),
                 mean_anomaly=np.where(e < 1, random.uniform(0, 2 * np.pi, n), random.uniform(-9, 9, n)))
    mu = random.uniform(0.1, 10, n)
    position, velocity = hf.state(mu, **given)
    assert position.shape == velocity.shape == (n, 3)
    found = hf.elements(position, velocity, mu)
    for key, x in given.items():
        # e down to 0.001 and inclinations down to 0.01 magnify the rounding of angles by their inverses.
        assert np.all(np.abs(found[key] - x) <= 1e-10 * (1 + np.abs(x))), key
    assert np.array_equal(np.isnan(found["period"]), e > 1)
    one = hf.elements(position[3], velocity[3], mu[3])
    assert all(one[key] == found[key][3] for key in found)


def test_numbers_and_arrays_broadcast():
    position, velocity = hf.state(a=[1, 2], e=0.5)
    assert np.allclose(position[:, 0], [0.5, 1])
    assert hf.state(a=1)[0].shape == (3,)
    assert np.allclose(hf.state(4.0, period=math.pi, time_of_pericentre=0, t=math.pi / 2)[0], [-1, 0, 0])


@pytest.mark.parametrize("call, words", [
    (lambda: hf.state(a=1, period=2), "found a and period; allowed one of them"),
    (lambda: hf.state(a=[1, 1], e=[0.5, 1.5]), "a of orbit 1: found 1 with e = 1.5"),
    (lambda: hf.state(e=0.1), "no size of the orbit"),
    (lambda: hf.state(a=1, exentricity=2), "found the argument exentricity; allowed a, period"),
    (lambda: hf.state(0, a=1), "mu: found 0; allowed a positive number"),
    (lambda: hf.state(a=[1, 2], e=[0, 0, 0]), "do not fit together"),
    (lambda: hf.elements([1, 0], [0, 1]), "allowed shapes (3,) and (n, 3)"),
    (lambda: hf.elements([1, 0, 0], [[0, 1, 0]]), "allowed (3,), the shape of position"),
])
def test_wrong(call, words):
    with pytest.raises(hf.Error) as error:
        call()
    assert words in str(error.value)


BODIES = [{"name": "Sun", "mass": 1}, {"name": "Jupiter", "mass": "1/1047.3486", "a": 5.2, "e": 0.05},
          {"name": "comet", "mass": 0, "pericentre_distance": 0.6, "e": 0.9, "inclination": "162 deg", "node": 1,
           "primary": "Sun"}]


def test_bodies_of_a_run():
    problem = hf.Problem("n-body", units={"length": "AU", "time": "yr", "mass": "Msun"}, bodies=BODIES)
    run = hf.run({"problem": dict(problem.table), "method": {"name": "wisdom-holman"},
                  "run": {"dt": 0.05, "steps": 100, "record_every": 10}, "output": {"elements": "Sun"}})
    assert abs(run["Jupiter.e"][0] - 0.05) < 1e-15 and len(run["Jupiter.a"]) == 11
    assert abs(run["comet.inclination"][0] - math.radians(162)) < 1e-15
    masses = np.repeat([1, 1 / 1047.3486, 1], 3)
    r, v = run.q.reshape(-1, 3, 3), (run.p / masses).reshape(-1, 3, 3)
    mu = 1.3271244e20 * 31557600**2 / 149597870700**3 * (1 + 1 / 1047.3486)
    again = hf.elements(r[:, 1] - r[:, 0], v[:, 1] - v[:, 0], mu)
    assert np.allclose(again["true_anomaly"], run["Jupiter.true_anomaly"], rtol=1e-11)


def test_every_error_of_bodies_names_the_body():
    with pytest.raises(hf.Rejection) as error:
        hf.Problem("n-body", bodies=[{"mass": 1}, {"mass": 1, "a": 1, "period": 2}])
    assert "problem.bodies[1].period: found a and period" in str(error.value)


def test_members_of_a_sweep_have_the_bits_of_runs():
    tree = {"problem": {"name": "n-body", "bodies": BODIES}, "method": {"name": "stv4"}, "run": {"dt": 0.05, "steps": 200}}
    sizes = [0.6, 0.7, 0.8, 0.9, 1.0]
    swept = hf.sweep(tree, {"problem.bodies[2].pericentre_distance": sizes})
    for member, size in enumerate(sizes):
        one = hf.Scenario(tree)
        one.set("problem.bodies[2].pericentre_distance", size)
        assert np.array_equal(swept["final/q"][member], hf.run(one).q[-1])

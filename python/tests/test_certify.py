"""Energies of other programs, and other people's integrators: wrong ones are found, right ones raise no alarm."""

import math
from decimal import Decimal

import numpy as np
import pytest

import hamflow as hf

# Energies


def t_of(samples=4001, end=400.0):
    return np.linspace(0, end, samples)


def test_an_oscillation_is_bounded_and_a_trend_beneath_it_is_linear():
    t = t_of()
    found = hf.certify(t, -0.5 + 1e-6 * np.sin(3 * t))
    assert found.drift == "bounded" and found.energy_level == pytest.approx(2e-6, rel=1e-3)
    assert abs(found.growth_exponent) < 0.2 and found.samples == 4001 and found.periods > 16
    found = hf.certify(t, -0.5 + 1e-6 * np.sin(3 * t) + 1e-7 * t)
    assert found.drift == "linear" and "linear" in repr(found)


def test_rounding_errors_are_a_random_walk_and_nothing_larger_is():
    rng = np.random.default_rng(7)
    seen = [hf.certify(t_of(), 1 + np.cumsum(rng.normal(size=4001)) * 1e-16).drift for _ in range(40)]
    assert set(seen) <= {"random walk", "undecided"} and seen.count("random walk") > 25
    seen = [hf.certify(t_of(), 1 + np.cumsum(rng.normal(size=4001)) * 1e-6).drift for _ in range(40)]
    assert set(seen) <= {"undecided"}


def test_noise_is_bounded_and_noise_about_a_trend_is_linear():
    rng = np.random.default_rng(8)
    noise = 1e-6 * rng.normal(size=(20, 4001))
    assert all(hf.certify(t_of(), -3 + each).drift == "bounded" for each in noise)
    assert all(hf.certify(t_of(), -3 + each + 3e-8 * t_of()).drift == "linear" for each in noise)


@pytest.mark.parametrize("phase", np.linspace(0, 2 * np.pi, 9))
@pytest.mark.parametrize("part", [0.1, 0.25, 0.5, 0.75, 1.0, 1.5])
@pytest.mark.parametrize("ripple", [0.0, 0.1])
def test_a_part_of_a_slow_oscillation_has_no_class(phase, part, ripple):
    t = t_of()
    e = -1 + 1e-4 * (np.sin(phase + 2 * np.pi * part * t / t[-1]) + ripple * np.sin(40 * t))
    # A quarter of a period beneath a ripple may be a straight line to all that the log shows.
    if part > 0.25 or not ripple:
        assert hf.certify(t, e).drift == "undecided"


def test_a_straight_line_needs_no_oscillation():
    t = t_of()
    assert hf.certify(t, 1 + 1e-6 * t).drift == "linear"
    assert hf.certify(t, np.exp(1e-3 * t)).drift == "linear"  # symmetric under no time reversal: euler on a harmonic
    assert hf.certify(t, np.ones_like(t)).drift == "undecided"
    assert hf.certify(t, 1 + 1e-5 * (t / t[-1]) ** 2).drift == "undecided"


def test_printed_digits_are_rounding():
    t = t_of()
    e = np.round(-0.5 + 4e-9 * np.sin(3 * t), 8)  # one digit flips
    assert hf.certify(t, e).drift in ("undecided",)


def pendulum_energies(step, h=0.1, steps=6000):
    q, p = np.array([1.0]), np.array([0.2])
    energies = []
    for _ in range(steps):
        energies.append(p[0] ** 2 / 2 - math.cos(q[0]))
        q, p = step(q, p, h)
    return h * np.arange(steps), np.array(energies)


def test_integrators_by_their_energies():
    def verlet(q, p, h):
        p = p - h / 2 * np.sin(q)
        q = q + h * p
        return q, p - h / 2 * np.sin(q)

    def euler(q, p, h):
        return q + h * p, p - h * np.sin(q)

    def rk4(q, p, h):
        def f(q, p):
            return p, -np.sin(q)
        k1 = f(q, p)
        k2 = f(q + h / 2 * k1[0], p + h / 2 * k1[1])
        k3 = f(q + h / 2 * k2[0], p + h / 2 * k2[1])
        k4 = f(q + h * k3[0], p + h * k3[1])
        return (q + h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]), p + h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1]))

    assert hf.certify(*pendulum_energies(verlet)).drift == "bounded"
    assert hf.certify(*pendulum_energies(rk4, 0.3)).drift == "linear"
    assert hf.certify(*pendulum_energies(euler, 0.01, 3000)).drift in ("linear", "undecided")


@pytest.mark.parametrize("method", ["verlet", "rk4", "stv4", "euler-a"])
def test_a_run_and_its_samples_are_not_of_different_classes(method):
    run = hf.run(hf.Scenario(problem=hf.Problem("henon-heiles").at(q=[0.3, 0.1], p=[0.1, 0.2]), method=method,
                             run={"dt": 0.2, "steps": 20_000, "record_every": 10}))
    found = hf.certify(run.t, run.energy)
    assert found.drift in (run.certificate.drift, "undecided")
    if method in ("verlet", "rk4"):
        assert found.drift == run.certificate.drift


def test_logs_of_random_runs_do_not_contradict_theory():
    """Of 10 511 such runs 1 was called bounded whose certificate says random walk, and none contradicted its method."""
    rng = np.random.default_rng(5)
    decided = 0
    for _ in range(120):
        problem = str(rng.choice(["pendulum", "henon-heiles", "sextic"]))
        method = str(rng.choice(["verlet", "stv4", "kahan-li8", "rk4", "euler", "implicit-midpoint", "cg(1,3)"]))
        d = 2 if problem == "henon-heiles" else 1
        start = hf.Problem(problem).at(q=rng.uniform(-0.25, 0.25, d), p=rng.uniform(-0.25, 0.25, d))
        every = int(rng.choice([1, 3, 37]))
        scenario = hf.Scenario(problem=start, method=method, run={
            "dt": float(10 ** rng.uniform(-2, -0.7)), "steps": every * int(rng.integers(40, 2000)), "record_every": every})
        try:
            run = hf.run(scenario)
        except hf.StepFailed:  # euler leaves the well
            continue
        drift = hf.certify(run.t, run.energy).drift
        decided += drift != "undecided"
        dissipates = method in ("rk4", "euler")
        assert drift in (("linear", "undecided") + (("random walk",) if method == "rk4" else ()) if dissipates
                         else ("bounded", "random walk", "undecided")), (problem, method, run.scenario, drift)
    assert decided > 40


T20000 = np.arange(20_000.0)
NOISE = np.random.default_rng(11).normal(size=20_000)
SWELLING = {
    "exp(t/2000) sin": np.exp(T20000 / 2000) * np.sin(0.3 * T20000),
    "t sin": T20000 * np.sin(0.3 * T20000),
    "t^2 sin": T20000**2 * np.sin(0.3 * T20000),
    "sqrt(t) sin": np.sqrt(T20000) * np.sin(0.3 * T20000),
    "(1 + t/T) sin": (1 + T20000 / 20_000) * np.sin(0.3 * T20000),
    "sin that begins to grow late": np.exp(np.maximum(T20000 - 15_000, 0) / 1000) * np.sin(0.3 * T20000),
    "t noise": T20000 * NOISE,
}


@pytest.mark.parametrize("name", SWELLING)
@pytest.mark.parametrize("every", [1, 7])
def test_a_swelling_oscillation_is_not_bounded(name, every):
    found = hf.certify(T20000[::every], -1 + 1e-10 * SWELLING[name][::every])
    assert found.drift == "undecided" and "grows over the log, from" in found.reason, (found.drift, found.reason)


def test_an_amplitude_that_returns_or_shrinks_is_bounded():
    rng = np.random.default_rng(12)
    t = T20000[:8000]
    drifts = []
    for _ in range(40):
        w, beat, phase = 2 * np.pi / rng.uniform(3, 300), 2 * np.pi * rng.uniform(3, 30) / t[-1], rng.uniform(0, 7, 2)
        anomaly = mean = w * t + phase[0]
        for _ in range(40):
            anomaly = anomaly - (anomaly - 0.6 * np.sin(anomaly) - mean) / (1 - 0.6 * np.cos(anomaly))
        for x in (np.sin(w * t + phase[0]) * np.cos(beat * t + phase[1]), np.sin(w * t) * (1 + np.cos(beat * t + phase[1]) / 2),
                  (1 - 0.6 * np.cos(anomaly)) ** -3, np.exp(-t / 4000) * np.sin(w * t), rng.normal(size=len(t))):
            drifts.append(hf.certify(t, -1 + 1e-7 * x).drift)
    assert set(drifts) <= {"bounded", "undecided"} and drifts.count("bounded") > 180, drifts.count("bounded")


def test_the_reason_says_which_way_the_energy_goes():
    t = t_of()
    ripple = -0.5 + 1e-6 * np.sin(3 * t)
    assert hf.certify(t, ripple + 1e-6 * t).reason == "the energy rises steadily"
    assert hf.certify(t, ripple - 1e-6 * t).reason == "the energy falls steadily"


def test_times_that_are_not_equidistant_are_resampled_or_undecided():
    rng = np.random.default_rng(3)
    t = np.sort(rng.uniform(0, 400, 4001))
    assert hf.certify(t, -0.5 + 1e-6 * np.sin(3 * t)).drift == "bounded"
    assert hf.certify(t, -0.5 + 1e-6 * np.sin(3 * t) + 1e-7 * t).drift == "linear"
    t = np.concatenate([t_of(2000, 100.0), [400.0]])
    found = hf.certify(t, -0.5 + 1e-6 * np.sin(3 * t))
    assert found.drift == "undecided" and "uneven" in found.reason


def test_scale_and_what_is_unknown():
    t = t_of()
    e = 1e-6 * np.sin(3 * t)
    found = hf.certify(t, e)
    assert found.scale is None and found.energy_level is None and "unknown" in repr(found)
    found = hf.certify(t, e, scale=2)
    assert found.scale == 2 and found.energy_level == pytest.approx(5e-7, rel=1e-3)
    few = hf.certify(t[:20], e[:20] + 1)
    assert few.drift == "undecided" and few.growth_exponent is None and few.energy_level > 0 and "33" in few.reason


def test_array_likes():
    t = t_of()
    e = -0.5 + 1e-6 * np.sin(3 * t)
    wanted = hf.certify(t, e).growth_exponent
    assert hf.certify(list(t), tuple(e)).growth_exponent == wanted
    assert hf.certify(t[::-1][::-1], np.asfortranarray(e)).growth_exponent == wanted
    assert hf.certify([Decimal(x) for x in t], e).growth_exponent == wanted
    assert hf.certify(np.arange(4001), e).drift == "bounded"


@pytest.mark.parametrize("t, e, words", [
    ([0, 1, 1], [1, 1, 1], "t[2]"), ([0, 2, 1], [1, 1, 1], "strictly increasing"), ([0, 1], [1, math.nan], "energy[1]"),
    ([0, math.inf], [1, 1], "t[1]"), ([0, 1, 2], [1, 1], "3 times and 2 energies"), ([0], [1], "1 sample"),
    ([], [], "0 samples"), ([[0, 1]], [[1, 1]], "shape (1, 2)"), (["a", "b"], [1, 1], "allowed numbers"),
    ([0, 1], [1j, 1], "allowed numbers"), ([0, 1], None, "allowed numbers")])
def test_wrong_logs(t, e, words):
    with pytest.raises(hf.Error) as refused:
        hf.certify(t, e)
    assert words in str(refused.value)


@pytest.mark.parametrize("scale", [0, -1, math.nan, math.inf, "1", [1], True])
def test_wrong_scales(scale):
    with pytest.raises(hf.Error, match="scale"):
        hf.certify([0, 1], [1, 1], scale=scale)


# Steps. H = p^2/2 + V(q) in all of them.

def kepler_gradient(q):
    return q / (q @ q) ** 1.5


FORCES = {
    "harmonic": lambda q: q.copy(),
    "pendulum": np.sin,
    "kepler": kepler_gradient,
    "henon-heiles": lambda q: np.array([q[0] + 2 * q[0] * q[1], q[1] + q[0] ** 2 - q[1] ** 2]),
}


def splitting(gradient, drifts, kicks):
    """q += a_i h p, p -= b_i h gradient(q), in turn."""
    def step(q, p, h):
        for i, a in enumerate(drifts):
            q = q + a * h * p
            if i < len(kicks):
                p = p - kicks[i] * h * gradient(q)
        return q, p
    return step


def kicks_first(gradient, kicks, drifts):
    def step(q, p, h):
        for i, b in enumerate(kicks):
            p = p - b * h * gradient(q)
            if i < len(drifts):
                q = q + drifts[i] * h * p
        return q, p
    return step


def composed(basic, factors):
    def step(q, p, h):
        for gamma in factors:
            q, p = basic(q, p, gamma * h)
        return q, p
    return step


def verlet(gradient):
    return splitting(gradient, [0.5, 0.5], [1.0])


def velocity_verlet(gradient):
    return kicks_first(gradient, [0.5, 0.5], [1.0])


YOSHIDA4 = [1 / (2 - 2 ** (1 / 3)), -2 ** (1 / 3) / (2 - 2 ** (1 / 3)), 1 / (2 - 2 ** (1 / 3))]
SUZUKI4 = [1 / (4 - 4 ** (1 / 3))] * 2 + [1 - 4 / (4 - 4 ** (1 / 3))] + [1 / (4 - 4 ** (1 / 3))] * 2
Y6 = [0.784513610477560, 0.235573213359357, -1.17767998417887]
YOSHIDA6 = Y6 + [1 - 2 * sum(Y6)] + Y6[::-1]
Y8 = [0.9148442462297915667, 0.2536933365662113541, -1.444852236860605157, -0.1582406353680501752, 1.938139137622525986,
      -1.960610232975310807, 0.1027998493917964406]
YOSHIDA8 = Y8 + [1 - 2 * sum(Y8)] + Y8[::-1]
KL8 = [0.13020248308889008087881763, 0.56116298177510838456196441, -0.38947496264484728640807860,
       0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
       0.25837438768632204729397911, 0.29501172360931029887096624]
KAHAN_LI8 = KL8 + [1 - 2 * sum(KL8)] + KL8[::-1]
KL6 = [0.3921614440073141392792505, 0.3325991367893594385997486, -0.7062461725576393598099648, 0.08221359629355080023149]
KAHAN_LI6 = KL6 + [1 - 2 * sum(KL6)] + KL6[::-1]
ML_S5 = [0.28, 0.62546642846767004501]
MCLACHLAN_S5 = ML_S5 + [1 - 2 * sum(ML_S5)] + ML_S5[::-1]
FOREST_RUTH_THETA = 1 / (2 - 2 ** (1 / 3))


def forest_ruth(gradient):
    th = FOREST_RUTH_THETA
    return splitting(gradient, [th / 2, (1 - th) / 2, (1 - th) / 2, th / 2], [th, 1 - 2 * th, th])


def pefrl(gradient):
    xi, lam, chi = 0.1786178958448091, -0.2123418310626054, -0.6626458266981849e-01
    return splitting(gradient, [xi, chi, 1 - 2 * (chi + xi), chi, xi],
                     [(1 - 2 * lam) / 2, lam, lam, (1 - 2 * lam) / 2])


def ruth3(gradient):
    return kicks_first(gradient, [7 / 24, 3 / 4, -1 / 24], [2 / 3, -2 / 3, 1])


def blanes_moan_6(gradient):
    a = [0.0792036964311957, 0.353172906049774, -0.0420650803577195]
    b = [0.209515106613362, -0.143851773179818]
    return splitting(gradient, a + [1 - 2 * sum(a)] + a[::-1], b + [0.5 - sum(b)] * 2 + b[::-1])


def mclachlan_rkn_4(gradient):
    """Blanes and Moan, SRKN order 4 with 6 stages and its palindromic kicks."""
    b = [0.0829844064174052, 0.396309801498368, -0.0390563049223486]
    a = [0.245298957184271, 0.604872665711080]
    return kicks_first(gradient, b + [1 - 2 * sum(b)] + b[::-1], a + [0.5 - sum(a)] * 2 + a[::-1])


def mclachlan_atela_3(gradient):
    a, b, c = 0.2683300957817599, 0.9196615230173999, -0.1879916187991598
    return kicks_first(gradient, [a, c, b], [b, c, a])


def implicit(matrix, weights, gradient, rounds=200):
    """A Runge-Kutta method whose stages are iterated until they stand still."""
    a, w = np.array(matrix), np.array(weights)

    def step(q, p, h):
        s = len(w)
        kq, kp = np.tile(p, (s, 1)), np.tile(-gradient(q), (s, 1))
        for _ in range(rounds):
            new_q = p + h * (a @ kp)
            new_p = np.array([-gradient(each) for each in q + h * (a @ kq)])
            change = max(abs(new_q - kq).max(), abs(new_p - kp).max())
            kq, kp = new_q, new_p
            if change < 1e-15:
                break
        return q + h * (w @ kq), p + h * (w @ kp)
    return step


def midpoint(gradient):
    return implicit([[0.5]], [1.0], gradient)


def gauss4(gradient):
    r = math.sqrt(3) / 6
    return implicit([[0.25, 0.25 - r], [0.25 + r, 0.25]], [0.5, 0.5], gradient)


def trapezoidal(gradient):
    return implicit([[0.0, 0.0], [0.5, 0.5]], [0.5, 0.5], gradient)


def explicit(matrix, weights, gradient):
    def step(q, p, h):
        kq, kp = [], []
        for row in matrix:
            kq.append(p + h * sum((x * k for x, k in zip(row, kp)), 0 * p))
            kp.append(-gradient(q + h * sum((x * k for x, k in zip(row, kq)), 0 * q)))
        return (q + h * sum(w * k for w, k in zip(weights, kq)), p + h * sum(w * k for w, k in zip(weights, kp)))
    return step


def rk4(gradient):
    return explicit([[], [0.5], [0, 0.5], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], gradient)


def heun(gradient):
    return explicit([[], [1]], [0.5, 0.5], gradient)


def dormand_prince5(gradient):
    return explicit([[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
                     [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
                     [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656]],
                    [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84], gradient)


def in_place_leapfrog(gradient):
    def step(q, p, h):
        p -= h / 2 * gradient(q)
        q += h * p
        p -= h / 2 * gradient(q)
    return step


def stormer(gradient):
    """The two-step recursion as a map of (q, p), with p from central differences."""
    def step(q, p, h):
        before = q - h * p - h * h / 2 * gradient(q)
        after = 2 * q - before - h * h * gradient(q)
        beyond = 2 * after - q - h * h * gradient(after)
        return after, (beyond - q) / (2 * h)
    return step


STRUCTURE = {"symplectic": True, "symmetric": True}
RIGHT = {
    "symplectic Euler, kick first": (lambda g: kicks_first(g, [1.0], [1.0]), {"order": 1, "symplectic": True, "symmetric": False}),
    "symplectic Euler, drift first": (lambda g: splitting(g, [1.0], [1.0]), {"order": 1, "symplectic": True, "symmetric": False}),
    "position Verlet": (verlet, {"order": 2, **STRUCTURE}),
    "velocity Verlet": (velocity_verlet, {"order": 2, **STRUCTURE}),
    "leapfrog in place": (in_place_leapfrog, {"order": 2, **STRUCTURE}),
    "Stormer": (stormer, {"order": 2, **STRUCTURE}),
    "Ruth 3": (ruth3, {"order": 3, "symplectic": True}),
    "Forest-Ruth": (forest_ruth, {"order": 4, **STRUCTURE}),
    "Yoshida 4": (lambda g: composed(verlet(g), YOSHIDA4), {"order": 4, **STRUCTURE}),
    "Suzuki 4": (lambda g: composed(velocity_verlet(g), SUZUKI4), {"order": 4, **STRUCTURE}),
    "McLachlan 4 of 5 stages": (lambda g: composed(verlet(g), MCLACHLAN_S5), {"order": 4, **STRUCTURE}),
    "PEFRL": (pefrl, {"order": 4, **STRUCTURE}),
    "Blanes-Moan 6": (blanes_moan_6, {"order": 4, **STRUCTURE}),
    "Blanes-Moan RKN 6": (mclachlan_rkn_4, {"order": 4, **STRUCTURE}),
    "Yoshida 6": (lambda g: composed(verlet(g), YOSHIDA6), {"order": 6, **STRUCTURE}),
    "Kahan-Li 6": (lambda g: composed(verlet(g), KAHAN_LI6), {"order": 6, **STRUCTURE}),
    "Yoshida 8": (lambda g: composed(verlet(g), YOSHIDA8), {"order": 8, **STRUCTURE}),
    "McLachlan-Atela 3": (mclachlan_atela_3, {"order": 3, "symplectic": True}),
    "Kahan-Li 8": (lambda g: composed(velocity_verlet(g), KAHAN_LI8), {"order": 8, **STRUCTURE}),
    "implicit midpoint": (midpoint, {"order": 2, **STRUCTURE}),
    "Gauss 4": (gauss4, {"order": 4, **STRUCTURE}),
    "trapezoidal": (trapezoidal, {"order": 2, "symmetric": True}),
    "RK4": (rk4, {"order": 4, "symplectic": False}),
    "Heun": (heun, {"order": 2, "symplectic": False, "symmetric": False}),
    "Dormand-Prince 5": (dormand_prince5, {"order": 5, "symplectic": False, "symmetric": False}),
}


@pytest.mark.parametrize("problem", FORCES)
@pytest.mark.parametrize("name", RIGHT)
def test_right_integrators_raise_no_alarm(name, problem):
    make, claims = RIGHT[name]
    found = hf.certify_step(make(FORCES[problem]), problem, **claims)
    assert found.agrees is True, (found, found.reason)


@pytest.mark.parametrize("problem", ["kepler"])
@pytest.mark.parametrize("name", ["position Verlet", "Forest-Ruth", "Kahan-Li 8", "Gauss 4", "implicit midpoint"])
def test_angular_momentum_is_kept(name, problem):
    make, claims = RIGHT[name]
    found = hf.certify_step(make(FORCES[problem]), problem, preserves="angular momentum", **claims)
    assert found.agrees is True and found.preserves["energy"] is False


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # its iteration fails with the longest steps
def test_what_preserves_the_energy():
    def average_vector_field(q, p, h):  # of p^2/2 + q^4/4, exact: the integral of a cubic
        a, b = q.copy(), p.copy()
        for _ in range(200):
            force = (q**3 + q**2 * a + q * a**2 + a**3) / 4
            new = q + h * (p + b) / 2, p - h * force
            done = max(abs(new[0] - a).max(), abs(new[1] - b).max()) < 1e-15
            a, b = new
            if done:
                break
        return a, b

    quartic = hf.Problem("p^2/2 + q^4/4", coordinates=["q"]).at(q=[0.6], p=[0.5])
    found = hf.certify_step(average_vector_field, quartic, order=2, symmetric=True, symplectic=False, preserves="energy")
    assert found.agrees is True, found.reason


# Integrators as they were shipped, wrong.

def swapped_factors(gradient):
    """x += v dt + a dt/2, v += a dt^2: factors of dt in the wrong places."""
    def step(q, p, h):
        a = -gradient(q)
        q = q + p * h + a * h / 2
        return q, p + (a - gradient(q)) / 2 * h**2
    return step


def half_step_with_the_whole(gradient):
    """Verlet with dt where dt/2 belongs."""
    def step(q, p, h):
        p = p - h * gradient(q)
        q = q + h * p
        return q, p - h * gradient(q)
    return step


def twice_with_new_velocities(gradient):
    """Both halves of the drift with the velocities after the kick."""
    def step(q, p, h):
        p = p - h * gradient(q)
        q = q + h / 2 * p
        return q + h / 2 * p, p
    return step


WRONG = {
    "Verlet with swapped factors": (swapped_factors, {"order": 2}),
    "Verlet with whole half-steps": (half_step_with_the_whole, {"order": 2}),
    "Yoshida 4 with two weights of 5": (lambda g: composed(verlet(g), [0.25, 0.25, 0.0, 0.25, 0.25]), {"order": 4}),
    "Suzuki 4 with the exponent of order 6": (
        lambda g: composed(verlet(g), [1 / (4 - 4 ** 0.2)] * 2 + [1 - 4 / (4 - 4 ** 0.2)] + [1 / (4 - 4 ** 0.2)] * 2), {"order": 4}),
    "McLachlan 4 with a wrong sign": (
        lambda g: composed(verlet(g), [0.28, -ML_S5[1], 1 - 2 * sum(ML_S5), -ML_S5[1], 0.28]), {"order": 4}),
    "leapfrog, new velocities twice": (twice_with_new_velocities, {"order": 2, "symmetric": True}),
    "Runge-Kutta called symplectic": (rk4, {"order": 4, "symplectic": True}),
    "trapezoidal called symplectic": (trapezoidal, {"order": 2, "symplectic": True}),
    "Yoshida 6 with a digit wrong": (lambda g: composed(verlet(g), [0.784513610477560, 0.235574213359357, -1.17767998417887,
                                                                   1 - 2 * (0.784513610477560 + 0.235574213359357 - 1.17767998417887),
                                                                   -1.17767998417887, 0.235574213359357, 0.784513610477560]), {"order": 6}),
}


@pytest.mark.parametrize("problem", ["pendulum", "kepler", "henon-heiles"])
@pytest.mark.parametrize("name", WRONG)
def test_wrong_integrators_are_found(name, problem):
    make, claims = WRONG[name]
    found = hf.certify_step(make(FORCES[problem]), problem, **claims)
    assert found.agrees is False and "claimed" in found.reason, found.reason


def test_three_dimensions_and_a_start():
    k = np.array([1.0, 4.0, 9.0])
    springs = hf.Problem("(p_x^2 + p_y^2 + p_z^2)/2 + (x^2 + 4*y^2 + 9*z^2)/2 + x*y*z/4", coordinates=["x", "y", "z"])

    def gradient(q):
        return k * q + np.array([q[1] * q[2], q[0] * q[2], q[0] * q[1]]) / 4

    for problem in (springs.at(q=[0.6, 0.5, 0.55], p=[0.5, 0.6, 0.4]), springs.at(q=[0.4, -0.2, 0.3], p=[0, 0, 0])):
        found = hf.certify_step(forest_ruth(gradient), problem, order=4, **STRUCTURE)
        assert found.agrees is True, found.reason
        assert hf.certify_step(rk4(gradient), problem, symplectic=True).agrees is False
    ellipse = hf.Problem("central-force", potential="kepler", orbit={"kind": "ellipse", "r_per": 1, "r_aph": 3})
    assert hf.certify_step(verlet(kepler_gradient), ellipse, order=2, **STRUCTURE).agrees is True


def test_one_dimension_with_lambdas():
    def kick(q, p, h):
        p -= h * np.sin(q)

    def drift(q, p, h):
        q += h * p
    found = hf.certify_step(lambda q, p, h: (kick(q, p, h), drift(q, p, h)) and None, "pendulum", order=1, symplectic=True)
    assert found.agrees is True
    assert hf.certify_step(lambda q, p, h: (q + h * p, p - h * (q + h * p)), "harmonic", symplectic=True).agrees is True


def test_an_exact_step_has_every_property():
    def rotation(q, p, h):
        return q * math.cos(h) + p * math.sin(h), p * math.cos(h) - q * math.sin(h)
    found = hf.certify_step(rotation, "harmonic", symplectic=True, symmetric=True, preserves=["energy"])
    assert found.order == math.inf and found.agrees is True, found.reason


def test_single_precision_is_undecided():
    def single(q, p, h):
        q, p, h = np.float32(q), np.float32(p), np.float32(h)
        p = p - h / 2 * np.sin(q)
        q = q + h * p
        return q, p - h / 2 * np.sin(q)
    found = hf.certify_step(single, "pendulum", symplectic=True, symmetric=True)
    assert found.symplectic is None and found.symmetric is None and found.agrees is None
    assert "single precision" in found.reason

    def single_forces(q, p, h):
        p = p - h / 2 * np.sin(np.float32(q)).astype(float)
        q = q + h * p
        return q, p - h / 2 * np.sin(np.float32(q)).astype(float)
    found = hf.certify_step(single_forces, "pendulum", order=2, symplectic=True, symmetric=True)
    assert found.symplectic is not False and found.symmetric is not False and found.agrees is not False


def test_a_coarse_solver_is_undecided():
    def coarse(q, p, h):
        a, b = q, p
        for _ in range(100):
            new = q + h * (p + b) / 2, p - h * np.sin((q + a) / 2)
            change = abs(new[0] - a).max()
            a, b = new
            if change < 1e-9:
                break
        return a, b
    found = hf.certify_step(coarse, "pendulum", order=2, symplectic=True, symmetric=True)
    assert found.symplectic is not False and found.symmetric is not False and found.agrees is not False


def adaptive(gradient, matrix, weights, lower, tolerance):
    """An explicit pair with step control over one h: the number of inner steps is no smooth function of (q, p, h)."""
    order = 3 if len(weights) == 4 else 5

    def step(q, p, h):
        def field(z):
            return np.concatenate([z[len(q):], -gradient(z[:len(q)])])
        z, done = np.concatenate([q, p]), 0.0
        inner = h / 10 * min(1, tolerance ** (1 / order) / abs(h) * 10)
        while abs(done) < abs(h):
            inner = math.copysign(min(abs(inner), abs(h - done)), h)
            k = []
            for row in matrix:
                k.append(field(z + inner * sum((x * each for x, each in zip(row, k)), 0 * z)))
            error = inner * sum((w - v) * each for w, v, each in zip(weights, lower, k))
            size = np.sqrt(np.mean((error / (tolerance + tolerance * abs(z))) ** 2))
            if size < 1:
                z = z + inner * sum(w * each for w, each in zip(weights, k))
                done = h if abs(h - done) <= abs(inner) else done + inner
            inner *= min(5, max(0.2, 0.9 * max(size, 1e-10) ** (-1 / order)))
        return z[:len(q)], z[len(q):]
    return step


PAIR_23 = ([[], [1 / 2], [0, 3 / 4], [2 / 9, 1 / 3, 4 / 9]], [2 / 9, 1 / 3, 4 / 9, 0], [7 / 24, 1 / 4, 1 / 3, 1 / 8])
PAIR_45 = ([[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9], [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
            [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
            [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]],
           [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84, 0],
           [5179 / 57600, 0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40])


@pytest.mark.parametrize("problem, pair, tolerance", [
    ("kepler", PAIR_23, 1e-3), ("kepler", PAIR_23, 1e-6), ("pendulum", PAIR_23, 1e-7), ("kepler", PAIR_45, 1e-3),
    ("kepler", PAIR_45, 1e-6), ("kepler", PAIR_45, 1e-8), ("pendulum", PAIR_45, 1e-8)])
def test_an_adaptive_step_is_not_called_symplectic(problem, pair, tolerance):
    found = hf.certify_step(adaptive(FORCES[problem], *pair, tolerance), problem, symplectic=True)
    assert not found.symplectic and not found.symmetric and not found.preserves["energy"], found
    assert found.agrees is not True


@pytest.mark.parametrize("rtol, atol", [(1e-3, 1e-6), (1e-8, 1e-10)])
def test_an_adaptive_step_of_scipy_is_not_called_symplectic(rtol, atol):
    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp

    def step(q, p, h):
        z = solve_ivp(lambda t, z: np.concatenate([z[2:], -kepler_gradient(z[:2])]), [0, h], np.concatenate([q, p]),
                      method="RK45", rtol=rtol, atol=atol).y[:, -1]
        return z[:2], z[2:]
    found = hf.certify_step(step, "kepler")
    assert not found.symplectic and not found.symmetric, found


GM = 1.327e20
SUN = hf.Problem("(p_x^2 + p_y^2)/2 - GM/sqrt(x^2 + y^2)", coordinates=["x", "y"], parameters={"GM": GM})


@pytest.mark.parametrize("start", [{"q": [5e10, 0], "p": [0, 5e4]}, {"q": [0, 1.5e11], "p": [-3e4, 1e3]}])
def test_units_of_any_size(start):
    def gradient(q):
        return GM * kepler_gradient(q)
    for make, claims in (RIGHT["velocity Verlet"], RIGHT["Forest-Ruth"], RIGHT["Kahan-Li 6"], RIGHT["RK4"]):
        found = hf.certify_step(make(gradient), SUN.at(**start), **claims)
        assert found.agrees is True, (found, found.reason)
        assert found.preserves["energy"] is False
    wrong = hf.certify_step(half_step_with_the_whole(gradient), SUN.at(**start), order=2)
    assert wrong.agrees is False
    with pytest.raises(hf.Error, match="found no start"):
        hf.certify_step(verlet(gradient), SUN)
    slow = hf.Problem("p^2/2e20 + q^2/2", coordinates=["q"]).at(q=[1e-8], p=[1e2])  # a period of 6e10

    def slow_verlet(q, p, h):
        p = p - h / 2 * q
        q = q + h * p / 1e20
        return q, p - h / 2 * q
    found = hf.certify_step(slow_verlet, slow, order=2, **STRUCTURE)
    assert found.agrees is True, (found, found.reason)


def test_a_wrong_force_is_no_smooth_error():
    found = hf.certify_step(verlet(lambda q: -3 * np.sin(q)), "pendulum", order=2, symplectic=True)
    assert found.agrees is not True and "smooth" not in found.reason, found.reason


def test_hidden_state_is_refused():
    class Cached:
        force = None

        def __call__(self, q, p, h):
            force = np.sin(q) if self.force is None else self.force
            p = p - h / 2 * force
            q = q + h * p
            self.force = np.sin(q)
            return q, p - h / 2 * self.force

    with pytest.raises(hf.Error, match="hidden state"):
        hf.certify_step(Cached(), "pendulum")
    rng = np.random.default_rng(1)
    with pytest.raises(hf.Error, match="hidden state"):
        hf.certify_step(lambda q, p, h: (q + h * p + 1e-9 * rng.normal(size=1), p - h * q), "harmonic")


@pytest.mark.parametrize("step, words", [
    (lambda q, p, h: None, "returned None"),
    (lambda q, p, h: q, r"returned q of shape \(\)"),
    (lambda q, p, h: 1.5, "returned float"),
    (lambda q, p, h: (q[:1], p), r"q of shape \(1,\)"),
    (lambda q, p, h: (q, np.array([p, p])), r"p of shape \(2, 2\)"),
    (lambda q, p, h: (q * math.nan, p), "returned nan"),
    (lambda q, p, h: (q + 1j, p), "for q; allowed"),
    (lambda q, p, h: ("ab", p), "for q; allowed"),
    (lambda q, p, h: (q, p), "changed nothing"),
    (lambda q, p, h: 1 / 0, "raised ZeroDivisionError: division by zero"),
    (lambda q, p, h: {}, "returned dict"),
    (lambda q, p: (q, p), "raised TypeError"),
    (3, "found int")])
def test_wrong_steps(step, words):
    with pytest.raises(hf.Error, match=words):
        hf.certify_step(step, "kepler")


def test_interrupts_are_not_swallowed():
    def stopped(q, p, h):
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        hf.certify_step(stopped, "kepler")


def test_a_step_that_goes_forward_only():
    def forward(q, p, h):
        if h < 0:
            raise RuntimeError("h is negative")
        return velocity_verlet(np.sin)(q, p, h)
    found = hf.certify_step(forward, "pendulum", order=2, symplectic=True)
    assert found.agrees is True and found.symmetric is None and "h is negative" in found.reason


@pytest.mark.parametrize("claims, words", [
    ({"order": 2.5}, "order"), ({"order": 0}, "order"), ({"symplectic": 1}, "symplectic"), ({"symmetric": "yes"}, "symmetric"),
    ({"preserves": ["enrgy"]}, "did you mean energy"), ({"preserves": [1]}, "preserves")])
def test_wrong_claims(claims, words):
    with pytest.raises(hf.Error, match=words):
        hf.certify_step(verlet(np.sin), "pendulum", **claims)


@pytest.mark.parametrize("problem, words", [
    ("keppler", "did you mean kepler"), (3, "found int"), (hf.Problem("n-body", masses=[1, 1]), "problem.at"),
    (hf.Problem("t-tube"), "walls"), (hf.Problem("p^2/2 + q^2/2 + q*sin(t)", coordinates=["q"]).at(q=[0.5], p=[0.5]), "depends on t"),
    (hf.Problem("p^2/2 + q^4/4", coordinates=["q"]), "found no start.*problem.at")])
def test_wrong_problems(problem, words):
    with pytest.raises(hf.Error, match=words):
        hf.certify_step(verlet(np.sin), problem)


def test_repr_is_one_line():
    found = hf.certify_step(verlet(np.sin), "pendulum")
    assert "\n" not in repr(found) and repr(found).startswith("<hamflow.StepCertificate order 2.0")

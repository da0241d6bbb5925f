"""Runs whose class of energy drift is known beforehand: the rows of tools/confusion_table.py.

A behaviour draws scenarios at random: start, step, length. Its class follows from theory and not from a certificate:

- bounded: symplectic methods at steps that resolve the motion. The modified Hamiltonian is kept for times beyond any run
  here [HLW2006, Thm. IX.8.1], and rounding lies many orders below their error.
- random walk: methods whose own error is below rounding (energy-conserving and collocation elements, high orders at small
  steps), where rounding errors without bias remain (Brouwer's law).
- linear: methods that are neither symplectic nor symmetric, of which the error of an energy has a mean.
- none: runs that no one can judge, of fewer than 32 steps or of less than two periods.

`confusion_table.py --truth` repeats runs four and sixteen times as long and shows how the largest energy error grows.
"""

import math

BOUNDED, WALK, LINEAR, NONE = "bounded", "random walk", "linear", "undecided"


def text(name, keys):
    def value(x):
        return '"%s"' % x if isinstance(x, str) else repr(x)

    def table(d):
        return "{ " + ", ".join(f"{k} = {table(v) if isinstance(v, dict) else value(v)}" for k, v in d.items()) + " }"

    return f"[{name}]\n" + "".join(f"{k} = {table(v) if isinstance(v, dict) else value(v)}\n" for k, v in keys.items())


class Run:
    """A scenario, and how many periods of its slowest oscillation it lasts (None: there is no one period)."""

    def __init__(self, problem, method, dt, steps, period, arithmetic="double"):
        self.problem, self.method, self.dt, self.steps, self.arithmetic = problem, method, dt, steps, arithmetic
        self.period = period

    @property
    def periods(self):
        return self.steps * self.dt / self.period if self.period else None

    def cut(self, longest):
        self.steps = min(self.steps, longest)

    def scenario(self, times=1):
        return (text("problem", self.problem) + text("method", self.method) +
                text("run", {"dt": self.dt, "steps": self.steps * times, "arithmetic": self.arithmetic}))


def log_uniform(rng, a, b):
    return math.exp(rng.uniform(math.log(a), math.log(b)))


def method(spec):
    if isinstance(spec, dict):
        return spec
    return {"name": spec}


MIDPOINT = {"name": "cg", "quadrature": 1}  # the implicit midpoint rule, which is symplectic
ELEMENT = {"name": "cg", "quadrature": 12}  # energy to rounding


def length(rng, dt, period, fewest, most, longest):
    """Steps for log-uniform periods in [fewest, most], between 40 and longest."""
    return max(40, min(longest, round(log_uniform(rng, fewest, most) * period / dt)))


def kepler_state(rng, e):
    """A random place on the ellipse of axis 1 and period 2 pi, mass and k 1, turned by a random angle."""
    mean = rng.uniform(0, 2 * math.pi)
    E = mean + e * math.sin(mean)
    for _ in range(50):
        E -= (E - e * math.sin(E) - mean) / (1 - e * math.cos(E))
    b = math.sqrt(1 - e * e)
    r = 1 - e * math.cos(E)
    x, y = math.cos(E) - e, b * math.sin(E)
    u, v = -math.sin(E) / r, b * math.cos(E) / r
    return r, x, y, u, v


def kepler(rng, spec, e, steps_per_period, fewest=32, most=1000, longest=40000, arithmetic="double", polar=False):
    r, x, y, u, v = kepler_state(rng, e)
    if polar:
        start = {"q": [r, 0.0], "p": [(x * u + y * v) / r, x * v - y * u]}
    else:
        a = rng.uniform(0, 2 * math.pi)
        c, s = math.cos(a), math.sin(a)
        start = {"q": [c * x - s * y, s * x + c * y], "p": [c * u - s * v, s * u + c * v]}
    problem = {"name": "central-force", "potential": "kepler", "k": 1.0, "mass": 1.0, "initial": start}
    if polar:
        problem["coordinates"] = "polar"
    dt = 2 * math.pi / steps_per_period * rng.uniform(0.9, 1.1)
    return Run(problem, method(spec), dt, length(rng, dt, 2 * math.pi, fewest, most, longest), 2 * math.pi, arithmetic)


def agm(a, b):
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return a


def pendulum(rng, spec, amplitude, dt, fewest=32, most=1000, longest=40000, arithmetic="double"):
    period = 2 * math.pi / agm(1, math.cos(amplitude / 2))
    problem = {"name": "pendulum", "initial": {"q": [amplitude], "p": [0.0]}}
    return Run(problem, method(spec), dt, length(rng, dt, period, fewest, most, longest), period, arithmetic)


def harmonic(rng, spec, dt, fewest=32, most=1000, longest=40000):
    problem = {"name": "harmonic", "initial": {"q": [rng.uniform(0.5, 2)], "p": [rng.uniform(-1, 1)]}}
    return Run(problem, method(spec), dt, length(rng, dt, 2 * math.pi, fewest, most, longest), 2 * math.pi)


def lennard_jones(rng, spec, dt, fewest=32, most=1000, longest=40000):
    q = rng.uniform(1.02, 1.35)
    potential = lambda x: x**-12 - 2 * x**-6  # noqa: E731
    level, period, x, p, h = potential(q), 0.0, q, 0.0, 1e-3
    for turns in range(2):  # half a period each, by verlet
        inside = potential(x + 1e-6) < potential(x)
        while True:
            p += h / 2 * (12 * x**-13 - 12 * x**-7)
            x += h * p
            p += h / 2 * (12 * x**-13 - 12 * x**-7)
            period += h
            if (p < 0) == inside or period > 1e3:
                break
    assert level < 0
    problem = {"name": "lennard-jones-oscillator", "initial": {"q": [q], "p": [0.0]}}
    return Run(problem, method(spec), dt, length(rng, dt, period, fewest, most, longest), period)


def henon_heiles(rng, spec, energy, dt, fewest=32, most=1000, longest=40000):
    while True:
        q1, q2, p1 = rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.4), rng.uniform(-0.3, 0.3)
        rest = 2 * energy - p1 * p1 - q1 * q1 - q2 * q2 - 2 * (q1 * q1 * q2 - q2**3 / 3)
        if rest > 0:
            break
    problem = {"name": "henon-heiles", "initial": {"q": [q1, q2], "p": [p1, math.sqrt(rest)]}}
    return Run(problem, method(spec), dt, length(rng, dt, 2 * math.pi, fewest, most, longest), 2 * math.pi)


def double_pendulum(rng, spec, size, dt, fewest=32, most=300, longest=10000):
    problem = {"name": "double-pendulum",
               "initial": {"q": [rng.uniform(-size, size), rng.uniform(-size, size)], "p": [0.0, 0.0]}}
    return Run(problem, method(spec), dt, length(rng, dt, 8.0, fewest, most, longest), 8.0)


def figure_eight(rng, spec, dt, fewest=32, most=300, longest=30000):
    problem = {"name": "n-body", "masses": [1, 1, 1], "initial": {
        "q": [0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0],
        "p": [0.466203685 + rng.uniform(-1e-3, 1e-3), 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146]}}
    return Run(problem, method(spec), dt, length(rng, dt, 6.3259, fewest, most, longest), 6.3259)


def pick(rng, *specs):
    return specs[rng.randrange(len(specs))]


LENGTH = dict(fewest=5, most=1000)

BEHAVIOURS = {
    # Symplectic methods at steps that resolve the motion.
    "kepler, verlet": (BOUNDED, lambda r: kepler(r, "verlet", r.uniform(0.05, 0.7), log_uniform(r, 80, 800), **LENGTH)),
    "kepler, stv4": (BOUNDED, lambda r: kepler(r, "stv4", r.uniform(0.05, 0.6), log_uniform(r, 60, 300), **LENGTH)),
    "kepler, order 6 and 8": (BOUNDED, lambda r: kepler(r, pick(r, "yoshida6", "mclachlan6-s9", "suzuki-umeno8"),
                                                        r.uniform(0.3, 0.7), log_uniform(r, 40, 120), **LENGTH)),
    "kepler, e = 0.9": (BOUNDED, lambda r: kepler(r, pick(r, "verlet", "stv4"), r.uniform(0.85, 0.92),
                                                  log_uniform(r, 1000, 4000), fewest=5, most=200)),
    "kepler, euler-a": (BOUNDED, lambda r: kepler(r, pick(r, "euler-a", "euler-b"), r.uniform(0.05, 0.4),
                                                  log_uniform(r, 200, 2000), **LENGTH)),
    "kepler in polar coordinates": (BOUNDED, lambda r: kepler(r, MIDPOINT, r.uniform(0.05, 0.6),
                                                              log_uniform(r, 60, 300), polar=True, longest=10000,
                                                              **LENGTH)),
    "kepler, stv4 in quad": (BOUNDED, lambda r: kepler(r, "stv4", r.uniform(0.05, 0.6), log_uniform(r, 60, 200),
                                                       arithmetic=pick(r, "quad", "double-double"), longest=3000,
                                                       **LENGTH)),
    "kepler, compensated": (BOUNDED, lambda r: kepler(r, pick(r, "verlet", "yoshida6"), r.uniform(0.2, 0.6),
                                                      log_uniform(r, 60, 200), arithmetic="compensated", **LENGTH)),
    "pendulum, verlet, short": (BOUNDED, lambda r: pendulum(r, "verlet", r.uniform(0.3, 2.8), r.uniform(0.05, 0.3),
                                                            fewest=2, most=12, longest=300)),
    "pendulum, verlet, long": (BOUNDED, lambda r: pendulum(r, "verlet", r.uniform(0.3, 2.8), r.uniform(0.05, 0.3),
                                                           most=3000, longest=200000)),
    "pendulum at the separatrix": (BOUNDED, lambda r: pendulum(r, pick(r, "verlet", "stv4", "euler-a"),
                                                               math.pi - 10**r.uniform(-5, -1), r.uniform(0.05, 0.2),
                                                               **LENGTH)),
    "lennard-jones, stv4": (BOUNDED, lambda r: lennard_jones(r, pick(r, "stv4", "suzuki4", "verlet"),
                                                             r.uniform(0.005, 0.03), **LENGTH)),
    "henon-heiles, chaotic": (BOUNDED, lambda r: henon_heiles(r, pick(r, "verlet", "stv4", "pefrl"),
                                                              r.uniform(0.125, 0.16), r.uniform(0.05, 0.3), **LENGTH)),
    "henon-heiles, regular": (BOUNDED, lambda r: henon_heiles(r, pick(r, "verlet", "stv4", "ruth3"),
                                                              r.uniform(0.02, 0.08), r.uniform(0.05, 0.3), **LENGTH)),
    "double pendulum, midpoint": (BOUNDED, lambda r: double_pendulum(r, MIDPOINT,
                                                                  r.uniform(0.3, 1.2), r.uniform(0.02, 0.05), fewest=5)),
    "figure eight": (BOUNDED, lambda r: figure_eight(r, pick(r, "verlet", "stv4"), r.uniform(0.005, 0.02), fewest=5)),
    "harmonic, verlet": (BOUNDED, lambda r: harmonic(r, pick(r, "verlet", "stv4", "euler-a"), log_uniform(r, 0.02, 0.6),
                                                     **LENGTH)),
    # Rounding alone.
    "kepler, element at rounding": (WALK, lambda r: kepler(r, ELEMENT, r.uniform(0.1, 0.5), log_uniform(r, 60, 120),
                                                           longest=30000, fewest=32)),
    "pendulum, element at rounding": (WALK, lambda r: pendulum(r, ELEMENT, r.uniform(0.5, 2.0), r.uniform(0.05, 0.1),
                                                               longest=30000, fewest=32)),
    "kepler, tight splitting": (WALK, lambda r: kepler(r, pick(r, "kahan-li8", "sofroniou10"), r.uniform(0.1, 0.3),
                                                       log_uniform(r, 700, 1500), fewest=5, most=300,
                                                       longest=200000)),
    "pendulum, tight splitting": (WALK, lambda r: pendulum(r, pick(r, "kahan-li8", "sofroniou10"), r.uniform(0.5, 1.5),
                                                           log_uniform(r, 0.004, 0.008), fewest=5, most=300,
                                                           longest=200000)),
    # Methods that lose or gain energy.
    "kepler, rk4": (LINEAR, lambda r: kepler(r, "rk4", r.uniform(0.0, 0.5), log_uniform(r, 40, 600), **LENGTH)),
    "kepler, rk4, e to 0.8": (LINEAR, lambda r: kepler(r, "rk4", r.uniform(0.5, 0.8), log_uniform(r, 200, 1000),
                                                       **LENGTH)),
    "pendulum, rk4": (LINEAR, lambda r: pendulum(r, "rk4", r.uniform(0.3, 2.8), r.uniform(0.05, 0.3), **LENGTH)),
    "harmonic, rk4": (LINEAR, lambda r: harmonic(r, "rk4", log_uniform(r, 0.02, 0.6), **LENGTH)),
    "henon-heiles, rk4": (LINEAR, lambda r: henon_heiles(r, "rk4", r.uniform(0.02, 0.08), r.uniform(0.1, 0.4),
                                                         **LENGTH)),
    "kepler, dop853, loose": (LINEAR, lambda r: kepler(r, {"name": "dop853", "tolerance": 10**r.uniform(-9, -3)},
                                                       r.uniform(0.0, 0.7), log_uniform(r, 4, 16), fewest=32)),
    "kepler, taylor, loose": (LINEAR, lambda r: kepler(r, {"name": "taylor", "tolerance": 10**r.uniform(-9, -3)},
                                                       r.uniform(0.0, 0.7), log_uniform(r, 4, 16), fewest=32)),
    "kepler, dop853 in quad": (LINEAR, lambda r: kepler(r, {"name": "dop853", "tolerance": 10**r.uniform(-17, -13)},
                                                        r.uniform(0.2, 0.6), 40, fewest=32, most=100,
                                                        arithmetic="quad")),
    "kepler, euler": (LINEAR, lambda r: kepler(r, "euler", r.uniform(0.0, 0.3), log_uniform(r, 300, 3000), fewest=5,
                                               most=100)),
    "pendulum, euler": (LINEAR, lambda r: pendulum(r, "euler", r.uniform(0.3, 1.0), log_uniform(r, 0.001, 0.01),
                                                   fewest=5, most=100)),
    # No one can tell.
    "kepler, less than two periods": (NONE, lambda r: kepler(r, pick(r, "rk4", "verlet", "euler", "stv4"),
                                                             r.uniform(0.1, 0.7), log_uniform(r, 100, 1000), fewest=0.5,
                                                             most=1.8)),
    "pendulum, less than two periods": (NONE, lambda r: pendulum(r, pick(r, "rk4", "verlet", "euler", "stv4"),
                                                                 r.uniform(0.3, 2.8), log_uniform(r, 0.01, 0.1),
                                                                 fewest=0.5, most=1.8)),
}

"""Runs whose class of energy drift is known beforehand: the rows of tools/confusion_table.py.

A behaviour draws scenarios at random: start, step, length. Its class follows from theory and not from a certificate:

- bounded: symplectic methods at steps that resolve the motion. The modified Hamiltonian is kept for times beyond any run
  here [HLW2006, Thm. IX.8.1], and rounding lies many orders below their error.
- random walk: methods whose own error is below rounding (energy-conserving and collocation elements, high orders at small
  steps), where rounding errors without bias remain (Brouwer's law).
- linear: methods that are neither symplectic nor symmetric, of which the error of an energy has a mean.
- none: runs that no one can judge, of fewer than 32 steps or of less than two periods.
- held: no theory tells. The class is compared with what a run 16 times as long did.

`confusion_table.py --truth` repeats runs four and sixteen times as long and shows how the largest energy error grows.
"""

import math

BOUNDED, WALK, LINEAR, NONE, HELD = "bounded", "random walk", "linear", "undecided", "held"


def text(name, keys):
    def value(x):
        if isinstance(x, list):
            return "[" + ", ".join(table(v) if isinstance(v, dict) else value(v) for v in x) + "]"
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


def formula(rng, hamiltonian, q, p, spec, dt, period, fewest=5, most=1000, longest=20000, **more):
    problem = {"name": "formula", "hamiltonian": hamiltonian, "initial": {"q": q, "p": p}, **more}
    return Run(problem, method(spec), dt, length(rng, dt, period, fewest, most, longest), period)


def kepler_in_si(rng, spec, steps_per_period):
    """A satellite of the Earth: metres, seconds, kilograms."""
    k, axis, mass = 3.986004418e14, rng.uniform(6.8e6, 4.2e7), 10**rng.uniform(0, 4)
    r, x, y, u, v = kepler_state(rng, rng.uniform(0.0, 0.7))
    speed, period = math.sqrt(k / axis), 2 * math.pi * math.sqrt(axis**3 / k)
    problem = {"name": "central-force", "potential": "kepler", "k": k * mass, "mass": mass,
               "initial": {"q": [axis * x, axis * y], "p": [mass * speed * u, mass * speed * v]}}
    dt = period / steps_per_period
    return Run(problem, method(spec), dt, length(rng, dt, period, 5, 500, 20000), period)


def magnetic(rng, spec):
    problem = {"name": "magnetic", "mass": 1.0, "charge": 1.0, "field": [0.0, 0.0, rng.uniform(0.5, 2)],
               "initial": {"q": [rng.uniform(-1, 1), rng.uniform(-1, 1), 0.0],
                           "p": [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.3, 0.3)]}}
    period = 2 * math.pi / problem["field"][2]
    dt = period / log_uniform(rng, 20, 200)
    return Run(problem, method(spec), dt, length(rng, dt, period, 5, 500, 10000), period)


def rotating(rng, spec):
    """The circular restricted problem of three bodies in its rotating frame, near the larger one."""
    mu = 10**rng.uniform(-4, -2)
    r = rng.uniform(0.2, 0.4)
    h = (f"(px^2+py^2)/2 - x*py + y*px - {1 - mu!r}/sqrt((x+{mu!r})^2+y^2) - {mu!r}/sqrt((x-{1 - mu!r})^2+y^2)")
    period = 2 * math.pi * r**1.5
    return formula(rng, h, [r, 0.0], [0.0, math.sqrt(1 / r) * rng.uniform(0.85, 1.0)], spec,
                   period / log_uniform(rng, 60, 400), period, longest=10000, coordinates=["x", "y"],
                   momenta=["px", "py"])


def between_walls(rng, spec):
    """Free flight whose bounces fall on the ends of steps."""
    steps = rng.randrange(20, 100)
    dt = 1 / steps
    problem = {"name": "formula", "hamiltonian": "(px^2+py^2)/2", "coordinates": ["x", "y"], "momenta": ["px", "py"],
               "initial": {"q": [0.5, 0.25], "p": [1.0, 0.5]},
               "walls": [{"coordinate": "x", "min": 0.0, "max": 1.0}, {"coordinate": "y", "min": 0.0, "max": 1.0}]}
    return Run(problem, method(spec), dt, length(rng, dt, 4, 5, 500, 20000), 4.0)


def henon_heiles_in_walls(rng, spec):
    run = henon_heiles(rng, spec, rng.uniform(0.05, 0.16), rng.uniform(0.05, 0.2), fewest=5, most=500, longest=10000)
    run.problem["walls"] = [{"coordinate": "q1", "min": -0.35, "max": 0.35}]
    run.problem["wall_rule"] = pick(rng, "event", "mirror", "reject")
    return run


def tiny_mass(rng, spec):
    """Two bodies and a third of next to no mass."""
    m = 10**rng.uniform(-20, -6)
    d = rng.uniform(2, 4)
    v = math.sqrt(1 / d)
    problem = {"name": "n-body", "masses": [0.7, 0.3, m], "initial": {
        "q": [-0.3, 0.0, 0.7, 0.0, d, 0.0], "p": [0.0, -0.21, 0.0, 0.21, 0.0, m * v]}}
    period = 2 * math.pi * d**1.5
    dt = rng.uniform(0.005, 0.03)
    return Run(problem, method(spec), dt, length(rng, dt, period, 5, 100, 20000), period)


def shifted(rng, spec):
    """An oscillation in a well to which a constant is added."""
    c = rng.choice([-1, 1]) * 10**rng.uniform(0, 6)
    return formula(rng, f"p^2/2 + x^2/2 + x^4/4 + {c!r}", [rng.uniform(0.3, 1.5)], [0.0], spec,
                   log_uniform(rng, 0.01, 0.2), 6.0, coordinates=["x"], momenta=["p"])


def from_zero(rng, spec):
    """A pendulum let go from the horizontal, where T = V = 0."""
    return formula(rng, "p^2/2 + 9.81*sin(a)", [0.0], [0.0], spec, log_uniform(rng, 0.002, 0.05), 2.37,
                   coordinates=["a"], momenta=["p"])


def far_away(rng, spec):
    far = 10**rng.uniform(3, 9)
    return formula(rng, "(p1^2+p2^2)/2 + (x2-x1-1)^2/2", [far, far + rng.uniform(1.2, 2)], [0.0, 0.0], spec,
                   log_uniform(rng, 0.01, 0.2), 4.44, coordinates=["x1", "x2"], momenta=["p1", "p2"])


def driven(rng, spec):
    h = f"p^2/2 + x^2/2 + x^4/4 - {rng.uniform(0.05, 0.4)!r}*x*cos({rng.uniform(0.3, 2)!r}*t)"
    return formula(rng, h, [rng.uniform(0, 1)], [0.0], spec, log_uniform(rng, 0.01, 0.1), 6.0, coordinates=["x"],
                   momenta=["p"])


def rotor(rng, spec):
    problem = {"name": "pendulum", "initial": {"q": [0.0], "p": [rng.uniform(2.1, 6)]}}
    dt = log_uniform(rng, 0.01, 0.1)
    return Run(problem, method(spec), dt, rng.randrange(400, 20000), None)


def tao_run(rng):
    spec = {"name": pick(rng, "tao2", "tao4"), "omega": rng.uniform(5, 40)}
    if rng.random() < 0.5:
        return double_pendulum(rng, spec, rng.uniform(0.3, 1.5), log_uniform(rng, 0.001, 0.01), fewest=5, most=50)
    return formula(rng, "(x^2+1)*(p^2+1)/2", [rng.uniform(-2, 2)], [rng.uniform(-1, 1)], spec,
                   log_uniform(rng, 0.001, 0.01), 4.0, most=100, coordinates=["x"], momenta=["p"])


def adaptive(rng):
    spec = {"name": pick(rng, "dop853", "taylor"), "tolerance": 10**rng.uniform(-15, -8)}
    kind = rng.randrange(4)
    if kind == 0:
        return kepler(rng, spec, rng.uniform(0, 0.7), log_uniform(rng, 10, 60), fewest=5, most=300, longest=5000)
    if kind == 1:
        return harmonic(rng, spec, log_uniform(rng, 0.05, 0.5), fewest=5, most=300, longest=10000)
    if kind == 2:
        return pendulum(rng, spec, rng.uniform(0.3, 2.5), log_uniform(rng, 0.05, 0.5), fewest=5, most=300,
                        longest=10000)
    return kepler_in_si(rng, spec, log_uniform(rng, 10, 100))


def low_orbit(rng):
    """Ten days of a satellite of the Earth at a height of 300 to 1000 km, in metres and seconds or in its radius."""
    mu, radius = 3.986004418e14, 6.378137e6
    e = rng.choice([0.0, 10**rng.uniform(-3, -1.3)])
    perigee = radius + rng.uniform(3e5, 1e6)
    speed = math.sqrt(mu * (1 + e) / perigee)
    period = 2 * math.pi * math.sqrt((perigee / (1 - e))**3 / mu)
    metre, second = (1.0, 1.0) if rng.random() < 0.5 else (1 / radius, math.sqrt(mu / radius**3))
    dt = log_uniform(rng, 30, 900)
    spec = pick(rng, {"name": "dop853", "step_control": "fixed"},
                {"name": "dop853", "tolerance": 10**rng.uniform(-15, -9)})
    problem = {"name": "central-force", "potential": "kepler", "k": mu * metre**3 / second**2, "mass": 1.0,
               "initial": {"q": [perigee * metre, 0.0], "p": [0.0, speed * metre / second]}}
    return Run(problem, spec, dt * second, round(864000 / dt), period * second)


LENGTH = dict(fewest=5, most=1000)
SPLIT = ("verlet", "stv4", "yoshida6", "kahan-li8", "rk4", ELEMENT)  # bounded, walking and drifting errors
IMPLICIT = (MIDPOINT, {"name": "gauss", "stages": 4}, ELEMENT, "rk4")

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
    # Compared with runs 16 times as long.
    "eccentric": (HELD, lambda r: kepler(r, pick(r, "verlet", "stv4", "yoshida6", "rk4"), r.uniform(0.5, 0.99),
                                         log_uniform(r, 300, 4000), longest=30000, **LENGTH)),
    "SI units": (HELD, lambda r: kepler_in_si(r, pick(r, *SPLIT), log_uniform(r, 60, 400))),
    "magnetic field": (HELD, lambda r: magnetic(r, pick(r, *IMPLICIT))),
    "rotating frame": (HELD, lambda r: rotating(r, pick(r, *IMPLICIT))),
    "walls met at ends of steps": (HELD, lambda r: between_walls(r, pick(r, "verlet", "stv4", {"name": "cg"}))),
    "henon-heiles in walls": (HELD, lambda r: henon_heiles_in_walls(r, pick(r, "verlet", "stv4"))),
    "tiny masses": (HELD, lambda r: tiny_mass(r, pick(r, "verlet", "stv4", "rk4"))),
    "adaptive": (HELD, adaptive),
    "low orbit": (HELD, low_orbit),
    "driven": (HELD, lambda r: driven(r, pick(r, "verlet", "stv4", "rk4"))),
    "rotors": (HELD, lambda r: rotor(r, pick(r, *SPLIT))),
    "H = 0 at the start": (HELD, lambda r: from_zero(r, pick(r, *SPLIT))),
    "shifted by a constant": (HELD, lambda r: shifted(r, pick(r, *SPLIT))),
    "far from the origin": (HELD, lambda r: far_away(r, pick(r, *SPLIT))),
    "tao": (HELD, tao_run),
}

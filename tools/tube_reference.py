#!/usr/bin/env python3
"""The motion of the problem t-tube between its walls in 40 digits, by Taylor series, with each bounce located on the series: a
solution that shares nothing with hamflow. Writes tests/data/t_tube_bounces.json: tube_reference.py > FILE (a minute).

H = p1^2/(2 m1) + p2^2/(2 m2) - eps/r, r^2 = u = q1^2 + q2^2, hence q' = p/m, p' = -eps q w with w = u^(-3/2), whose series
follows from u w' = -(3/2) u' w. The radius of convergence is r/|v|, 0.016 at the nearest: with steps of 0.001 and 30 terms
what is left out is 1e-36.
"""

import decimal
import json
from decimal import Decimal

decimal.getcontext().prec = 44
MASSES, EPS, TERMS, STEP = (Decimal(1), Decimal(100)), Decimal("-0.6"), 30, Decimal("0.001")
WALLS = ((0, -1, Decimal(-1)), (0, 1, Decimal(1)), (1, -1, Decimal("0.1")), (1, 1, Decimal("2.1")))


def series(q, p):
    """The coefficients of q and p."""
    q, p, u, w = [[x] for x in q], [[x] for x in p], [], []
    for k in range(TERMS):
        u.append(sum(x[i] * x[k - i] for x in q for i in range(k + 1)))
        if k == 0:
            w.append(1 / (u[0] * u[0].sqrt()))
        else:
            w.append(sum((Decimal(-3) / 2 * j - (k - j)) * u[j] * w[k - j] for j in range(1, k + 1)) / (k * u[0]))
        forces = [-EPS * sum(x[i] * w[k - i] for i in range(k + 1)) for x in q]
        for i in range(2):
            q[i].append(p[i][k] / MASSES[i] / (k + 1))
            p[i].append(forces[i] / (k + 1))
    return q, p


def at(coefficients, time):
    value = Decimal(0)
    for c in reversed(coefficients):
        value = value * time + c
    return value


def first_bounce(q, step):
    """(time, coordinate, side) of the first wall that is crossed within a step, or None."""
    found = []
    for coordinate, side, wall in WALLS:
        beyond = lambda t: (at(q[coordinate], t) - wall) * side > 0
        if beyond(step):
            low, high = Decimal(0), step
            for _ in range(140):
                middle = (low + high) / 2
                low, high = (low, middle) if beyond(middle) else (middle, high)
            found.append((low, coordinate, side))
    return min(found, default=None)


def motion(end):
    q, p, t, bounces = [Decimal("0.01"), Decimal("1.1")], [6 * MASSES[0], 1 * MASSES[1]], Decimal(0), []
    while t < end:
        step = min(STEP, end - t)
        of_q, of_p = series(q, p)
        bounce = first_bounce(of_q, step)
        if bounce:
            step = bounce[0]
        q, p, t = [at(x, step) for x in of_q], [at(x, step) for x in of_p], t + step
        if bounce:
            p[bounce[1]] = -p[bounce[1]]
            bounces.append((t, bounce[1], bounce[2]))
    return q, p, bounces


if __name__ == "__main__":
    text = lambda x: f"{x:.25g}"
    states = []
    for end in (3, 12):
        q, p, bounces = motion(Decimal(end))
        states.append({"t": end, "q": [text(x) for x in q], "p": [text(x) for x in p]})
    rows = [{"t": text(t), "coordinate": i, "side": side} for t, i, side in bounces[:30]]
    print(json.dumps({"made by": "tools/tube_reference.py", "masses": [1, 100], "eps": -0.6, "velocities": [6, 1],
                      "states": states, "bounces": rows}, indent=1))

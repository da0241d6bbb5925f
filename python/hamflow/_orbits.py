"""Orbital elements and states of bodies on conics."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._problem import Numbers


def elements(position: npt.ArrayLike, velocity: npt.ArrayLike, mu: npt.ArrayLike = 1.0) -> dict[str, float | Numbers]:
    """The elements of the orbits about mu = G m on which bodies are.

    Parameters
    ----------
    position, velocity : array_like, shape (3,) or (n, 3)
        From the primary.
    mu : float or array of shape (n,)

    Returns
    -------
    dict with a, e, inclination, node, pericentre, longitude_of_pericentre, mean_anomaly, true_anomaly,
    mean_longitude and period: floats, or arrays of shape (n,). Angles are in radians, in [0, 2 pi); the inclination is
    in [0, pi]. On a hyperbola mean_longitude and period are NaN, and the mean anomaly is e sinh F - F.
    """
    r, v = np.asarray(position, dtype=float), np.asarray(velocity, dtype=float)
    for name, x in (("position", r), ("velocity", v)):
        if x.ndim not in (1, 2) or x.shape[-1] != 3:
            raise Error(f"{name}: found an array of shape {x.shape}; allowed shapes (3,) and (n, 3)")
    if r.shape != v.shape:
        raise Error(f"velocity: found an array of shape {v.shape}; allowed {r.shape}, the shape of position")
    m = np.asarray(mu, dtype=float)
    count = len(r) if r.ndim == 2 else 1
    if m.ndim > 0 and m.shape != (count,):
        raise Error(f"mu: found an array of shape {m.shape}; allowed a number or shape ({count},)")
    found = _core.elements(r, v, np.ascontiguousarray(np.broadcast_to(m, (count,))))
    return {name: x if r.ndim == 2 else float(x[0]) for name, x in found.items()}


def state(mu: npt.ArrayLike = 1.0, /, *, t: npt.ArrayLike = 0.0, **orbit: npt.ArrayLike) -> tuple[Numbers, Numbers]:
    """Position and velocity about the primary, of bodies on orbits about mu = G m.

    Parameters
    ----------
    mu : float or array of shape (n,)
    a, period, pericentre_distance : float or array of shape (n,)
        One of them; a is negative on a hyperbola, and only pericentre_distance is allowed with e = 1.
    e, inclination, node : float or array of shape (n,), default 0
    pericentre, longitude_of_pericentre : at most one, default 0
    mean_anomaly, true_anomaly, eccentric_anomaly, mean_longitude, time_of_pericentre : at most one, default the pericentre
    t : the time, for time_of_pericentre

    Returns
    -------
    position, velocity : arrays of shape (3,) or (n, 3)
    """
    names = list(orbit)
    try:
        m, when, *given = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (mu, t, *orbit.values())))
    except ValueError as error:
        raise Error(f"found arrays that do not fit together ({error}); allowed numbers and arrays of one shape (n,)") from None
    if m.ndim > 1:
        raise Error(f"found arrays with {m.ndim} dimensions; allowed numbers and arrays of one shape (n,)")
    flat = [np.ascontiguousarray(x).reshape(-1) for x in (m, when, *given)]
    position, velocity = _core.orbit_states(flat[0], dict(zip(names, flat[2:])), flat[1])
    return (position[0], velocity[0]) if m.ndim == 0 else (position, velocity)

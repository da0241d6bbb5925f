"""Converts runs, scenarios and states to other coordinates."""

from __future__ import annotations

import os
import warnings
from typing import Any, overload

import numpy as np

from . import _core
from ._errors import Error, shown
from ._problem import Numbers
from ._run import Run, open
from ._scenario import Scenario, scenario_of
from ._simulation import Trajectory


@overload
def convert(given: Run, /, *, to: str, digits: bool = False) -> Trajectory: ...
@overload
def convert(given: Scenario, /, *, to: str, method: str | None = None) -> Scenario: ...
@overload
def convert(given: tuple[Any, Any], /, *, to: str, start: str) -> tuple[Numbers, Numbers]: ...
@overload
def convert(given: Any, /, *, to: str, method: str | None = None, digits: bool = False) -> Any: ...


def convert(given: Any, /, *, to: str, start: str | None = None, method: str | None = None, digits: bool = False) -> Any:
    """Converts a run, a scenario or states to other coordinates. The transformation is canonical: it keeps H.

    Parameters
    ----------
    given : Run, folder of a run or its run.h5; Scenario, dict of tables or name of a TOML file; or (q, p)
        q and p have the shape (d,) or (n, d).
    to : str
        The new coordinates: "cartesian" or "polar" for a central force, "absolute" or "relative" for a double pendulum.
    start : str
        The coordinates of (q, p). Only allowed with (q, p), and needed there.
    method : str, optional
        The method of the converted scenario. Only allowed with a scenario. Default: the method is kept.
    digits : bool
        Whether t, q, p, energy of a run are arrays of decimal.Decimal. Only allowed in arithmetic with more digits than
        double.

    Returns
    -------
    Trajectory
        From a run: all samples, t (n,), q (n, d), p (n, d), energy (n,), step (n,), and columns by their new names.
    Scenario
        From a scenario.
    q, p : arrays
        From states, with the shape of the given q and p.

    Warns
    -----
    UserWarning
        If samples are too far apart to count the turns of an angle, or if the converted scenario loses keys.

    Raises
    ------
    Error
        If the problem has no such coordinates, if they cannot describe a state (polar coordinates at r = 0), or if the
        method cannot run in them.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("central-force", potential="kepler").at(q=[1, 0], p=[0, 1]), method="stv4",
    ...                 run={"dt": 0.1, "steps": 20})
    >>> orbit = hf.convert(hf.run(s), to="polar")
    >>> orbit.coordinates, orbit["r"].shape
    (['r', 'phi'], (21,))
    >>> q, p = hf.convert(([0, 2], [1, 0]), start="cartesian", to="polar")
    >>> q.round(6).tolist(), p.round(6).tolist()
    ([2.0, 1.570796], [0.0, -2.0])
    """
    _core.check_coordinates(to)
    if isinstance(given, tuple):
        return _states(given, start, to)
    if start is not None:
        raise TypeError("start: found with a run or scenario, which has its coordinates; allowed with (q, p)")
    if isinstance(given, (str, os.PathLike)) and os.path.exists(given) and _core.is_run(given):
        given = open(given)
    if isinstance(given, Run):
        if method is not None:
            raise TypeError("method: found with a run; allowed with a scenario")
        table, coordinates, momenta, note = _core.convert_samples(given.scenario._core, given._tables, to)
        if note:
            warnings.warn(note, stacklevel=2)
        return Trajectory(table, coordinates, momenta, digits)
    if method is not None and not isinstance(method, str):
        raise TypeError(f"method: found {shown(method)}; allowed a text")
    scenario = scenario_of(given)
    sets = [] if method is None else [f'method.name="{method}"']
    text, notes = _core.convert_scenario(scenario._core, to, sets)
    for each in notes:
        warnings.warn(each, stacklevel=2)
    return Scenario.from_text(text, scenario._name)


def _states(given: tuple[Any, ...], start: str | None, to: str) -> tuple[Numbers, Numbers]:
    if start is None:
        raise TypeError('start: missing; allowed the coordinates of (q, p), such as "cartesian"')
    if len(given) != 2 or np.shape(given[0]) != np.shape(given[1]) or np.ndim(given[0]) not in (1, 2):
        raise Error("found no pair (q, p) of one shape; allowed (d,) or (n, d)")
    rows = [np.atleast_2d(np.asarray(each, dtype=np.float64)).tolist() for each in given]
    q, p = (np.array(each) for each in _core.convert_states(start, to, *rows))
    return (q, p) if np.ndim(given[0]) == 2 else (q[0], p[0])

"""Runs and scenarios in the other coordinates of their problem."""

from __future__ import annotations

import os
import warnings
from typing import Any, overload

from . import _core
from ._run import Run, open
from ._scenario import Scenario, scenario_of
from ._simulation import Trajectory


@overload
def convert(given: Run, /, *, to: str, digits: bool = False) -> Trajectory: ...
@overload
def convert(given: Scenario, /, *, to: str, method: str | None = None) -> Scenario: ...
@overload
def convert(given: Any, /, *, to: str, method: str | None = None, digits: bool = False) -> Any: ...


def convert(given: Any, /, *, to: str, method: str | None = None, digits: bool = False) -> Any:
    """Converts a run or a scenario to other coordinates of its problem. Momenta change with positions; H stays.

    Parameters
    ----------
    given : Run, folder of a run or its run.h5; or Scenario, dict of tables or name of a TOML file
    to : str
        Such as "cartesian" or "polar" of a central force, "absolute" or "relative" of a double pendulum.
    method : str, optional
        Of a scenario: the method of the converted one. Default: its own.
    digits : bool
        Of a run beyond double: t, q, p, energy as arrays of decimal.Decimal.

    Returns
    -------
    Trajectory
        Of a run: all samples, t (n,), q (n, d), p (n, d), energy (n,), step (n,); columns by their new names.
    Scenario
        Of a scenario.

    Warns
    -----
    UserWarning
        Where samples lie too far apart to count the turns of an angle, and of keys that the converted scenario has not.

    Raises
    ------
    Error
        Where the problem has no such coordinates, they do not reach a state (polar ones at r = 0), or the method does
        not run in them.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("central-force", potential="kepler").at(q=[1, 0], p=[0, 1]), method="stv4",
    ...                 run={"dt": 0.1, "steps": 20})
    >>> orbit = hf.convert(hf.run(s), to="polar")
    >>> orbit.coordinates, orbit["r"].shape
    (['r', 'phi'], (21,))
    """
    _core.check_coordinates(to)
    if isinstance(given, (str, os.PathLike)) and os.path.exists(given) and _core.is_run(given):
        given = open(given)
    if isinstance(given, Run):
        if method is not None:
            raise TypeError("method: found with a run; allowed with a scenario")
        table, coordinates, momenta, note = _core.convert_samples(given.scenario._core, given._tables, to)
        if note:
            warnings.warn(note, stacklevel=2)
        return Trajectory(table, coordinates, momenta, digits)
    scenario = scenario_of(given)
    sets = [] if method is None else [f'method.name="{method}"']
    text, notes = _core.convert_scenario(scenario._core, to, sets)
    for each in notes:
        warnings.warn(each, stacklevel=2)
    return Scenario.from_text(text, scenario._name)

"""Structure-preserving time integration of Hamiltonian systems.

    import hamflow as hf

    swing = hf.Problem("(p_x^2+p_y^2)/2 + g*y + k/2*(sqrt(x^2+y^2)-1)^2", coordinates=["x", "y"],
                       parameters={"k": 20, "g": 1})
    sim = hf.Simulation(swing, method="kahan-li8", q=[0.6, -0.8], p=[0, 0], dt=0.02)
    traj = sim.sample(steps=20_000, every=20)
    print(sim.energy_error.max_relative_error)

The names, defaults and messages are those of the command `hamflow`.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from . import _core
from . import _html
from ._certify import LogCertificate, StepCertificate, certify, certify_step
from ._compare import Compare, compare
from ._convert import convert
from ._errors import Error, FileError, Rejection, StepFailed
from ._orbits import elements, state
from ._problem import Problem
from ._run import Reversal, Run, States, open, reverse, run
from ._scenario import Scenario
from ._show import Shown, cite, show
from ._simulation import Simulation, Trajectory
from ._sweep import Sweep, propagate, sweep
from ._trace import acos, asin, atan, atan2, cos, cosh, exp, log, sin, sinh, sqrt, tan, tanh
from ._verify import Verification, verify
from ._view import View, view

__version__: str = _core.version

__all__ = ["Compare", "Error", "FileError", "LogCertificate", "Problem", "Rejection", "Reversal", "Run", "Scenario",
           "Shown", "Simulation", "States", "StepCertificate", "StepFailed", "Sweep", "Trajectory", "Verification", "View",
           "acos", "asin", "atan", "atan2", "certify", "certify_step", "cite", "compare", "convert", "cos", "cosh",
           "elements", "exp", "log", "methods", "open", "problems", "propagate", "reverse", "run", "show", "sin", "sinh", "sqrt", "state",
           "sweep",
           "tan", "tanh", "verify", "view"]


class Infos(list):  # type: ignore[type-arg]
    """A list of entries of the catalogue. A notebook shows it as a table."""

    def __repr__(self) -> str:
        return f"<hamflow: {len(self)} entries: {', '.join(each.name for each in self[:6])}{', ...' if len(self) > 6 else ''}>"

    def _repr_html_(self) -> str:
        names = list(vars(self[0])) if self else []
        return _html.table(names, ([getattr(each, name) for name in names] for each in self))


def methods(problem: Problem | None = None, /) -> Infos:
    """Lists the methods of the catalogue.

    Parameters
    ----------
    problem : Problem, optional
        Lists only the methods that can integrate this problem. Default: all methods.

    Returns
    -------
    list of objects
        With the attributes name, summary, order, symplectic, symmetric, reversible, ...

    Raises
    ------
    TypeError
        If `problem` is not a Problem.
    """
    if problem is not None and not isinstance(problem, Problem):
        raise TypeError(f"problem: found {type(problem).__name__}; allowed a Problem, or nothing")
    found = [SimpleNamespace(**each) for each in _core.methods()]
    return Infos(each for each in found if problem is None or problem._core.accepts(each.name))


def problems() -> Infos:
    """Lists the problems of the catalogue.

    Returns
    -------
    list of objects
        With the attributes name, formula, coordinates, parameters and reference.
    """
    return Infos(SimpleNamespace(**each) for each in _core.problems())


def __dir__() -> list[str]:
    return [*__all__, "__version__"]

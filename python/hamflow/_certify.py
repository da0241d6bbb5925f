"""Certificates for the energies and the integrators of other programs."""

from __future__ import annotations

import difflib
import operator
from typing import Any, Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._problem import Problem
from ._scenario import Scenario

Numbers = npt.NDArray[np.float64]
Step = Callable[[Numbers, Numbers, float], Any]

_step_problems = {
    "harmonic": {"name": "harmonic"},
    "kepler": {"name": "central-force", "potential": "kepler"},
    "henon-heiles": {"name": "henon-heiles"},
    "pendulum": {"name": "pendulum"},
}


class LogCertificate:
    """The result of certify() for a log.

    Attributes
    ----------
    drift : str
        "bounded", "random walk", "linear" or "undecided", as in the certificate of a run.
    energy_level : float or None
        The largest abs(E - E[0])/scale; None if the scale is unknown.
    growth_exponent : float or None
        The exponent c of the growth t^c of the error; None with fewer than 33 samples.
    reason : str
        Why the log has this drift class, or why the class is undecided.
    samples : int
        The number of energies in the log.
    periods : float or None
        The number of oscillations found in the energy; None if none was found. The log is averaged over 256 blocks, so
        that at most 128 oscillations are found.
    scale : float or None
        The scale that the caller gave, else abs(E[0]); None if E[0] is 0.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.drift: str = found["drift"]
        self.energy_level: float | None = found["energy_level"]
        self.growth_exponent: float | None = found["growth_exponent"]
        self.reason: str = found["reason"]
        self.samples: int = found["samples"]
        self.periods: float | None = found["periods"]
        self.scale: float | None = found["scale"]

    def __repr__(self) -> str:
        level = "unknown" if self.energy_level is None else f"{self.energy_level:.2g}"
        return f"<hamflow.LogCertificate {self.drift}, energy error {level}: {self.reason}>"


def _column(x: npt.ArrayLike, name: str) -> Numbers:
    array = np.asarray(x)
    if array.ndim != 1 or array.dtype.kind not in "fiub":
        if array.ndim == 1 and array.dtype.kind == "O":  # Decimal, Fraction
            try:
                return np.array([float(each) for each in array])
            except (TypeError, ValueError):
                pass
        raise Error(f"{name}: found {array.dtype} of shape {array.shape}; allowed numbers of shape (n,)")
    return np.ascontiguousarray(array, dtype=np.float64)


def certify(t: npt.ArrayLike, energy: npt.ArrayLike, scale: float | None = None) -> LogCertificate:
    """Classifies the energy error in the log of any program, by the rules for the certificate of a run.

    Parameters
    ----------
    t : array_like, shape (n,)
        Strictly increasing times. If they are not equidistant, the log is divided into parts of equal duration.
    energy : array_like, shape (n,)
        The energies at these times, in any unit.
    scale : float, optional
        The energy that the error is divided by. Default: abs(energy[0]).

    Returns
    -------
    LogCertificate
        With drift, energy_level, growth_exponent, reason. A log contains no coordinates, so oscillations are counted in
        the energy itself. If they do not suffice for a class, or if there are fewer than 33 samples, `drift` is
        "undecided" and `reason` says why.

    Raises
    ------
    Error
        If a number is NaN or infinite, if the times do not increase, if the lengths differ, if there are fewer than two
        samples, or if the scale is not positive.

    Notes
    -----
    `hamflow run` uses the same tests and limits; docs/design/certificates.md explains them.

    Examples
    --------
    >>> import hamflow as hf, numpy as np
    >>> t = np.linspace(0, 500, 5001)
    >>> hf.certify(t, -0.5 + 1e-6*np.sin(3*t)).drift
    'bounded'
    >>> hf.certify(t, -0.5 + 1e-6*np.sin(3*t) + 1e-7*t).drift
    'linear'
    """
    if scale is not None and (isinstance(scale, (bool, str)) or np.ndim(scale) != 0):
        raise Error(f"scale: found {shown(scale)}; allowed a positive number")
    return LogCertificate(_core.certify_log(_column(t, "t"), _column(energy, "energy"), scale))


class StepCertificate:
    """The result of certify_step(): measured properties of a step on one problem.

    Attributes
    ----------
    order : float
        The measured order; inf if every step is exact up to rounding, nan if no order could be measured.
    symplectic, symmetric : True, False or None
        None means undecided.
    preserves : dict
        {NAME: True, False or None}, for "energy" and every invariant of the problem.
    agrees : True, False or None
        True if all claims hold, False if one is refuted, else None: a claim is undecided.
    reason : str
        The measurement that refutes a claim, or why a property is undecided.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.order: float = float("nan") if found["order"] is None else found["order"]
        self.symplectic: bool | None = found["symplectic"]
        self.symmetric: bool | None = found["symmetric"]
        self.preserves: dict[str, bool | None] = dict(found["preserves"])
        self.agrees: bool | None = found["agrees"]
        self.reason: str = found["reason"]

    def __repr__(self) -> str:
        return (f"<hamflow.StepCertificate order {self.order:.2f}, symplectic {self.symplectic}, "
                f"symmetric {self.symmetric}, preserves {self.preserves}, agrees {self.agrees}>")


def _claim(value: bool | None, name: str) -> bool | None:
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    raise Error(f"{name}: found {shown(value)}; allowed True, False or None")


def _step_problem(problem: Any) -> Any:
    if isinstance(problem, str):
        if problem not in _step_problems:
            near = difflib.get_close_matches(problem, _step_problems, 1)
            meant = f"; did you mean {near[0]}?" if near else ""
            raise Error(f"problem: found {shown(problem)}; allowed {', '.join(_step_problems)}, or a hamflow.Problem{meant}")
        problem = _step_problems[problem]
    table = problem.table if isinstance(problem, Problem) else problem
    if not isinstance(table, Mapping):
        raise Error(f"problem: found {type(problem).__name__}; allowed {', '.join(_step_problems)}, or a hamflow.Problem")
    if any(key in table for key in ("initial", "orbit", "case", "bodies")):
        return Scenario(problem=table, method="rk4", run={"dt": 0.001, "steps": 0})._core
    return _core.Problem(dict(table))


def certify_step(step: Step, problem: str | Problem | Mapping[str, Any], order: int | None = None,
                 symplectic: bool | None = None, symmetric: bool | None = None,
                 preserves: str | Sequence[str] = ()) -> StepCertificate:
    """Measures one step of any integrator: order, symplecticity, time symmetry and invariants.

    Parameters
    ----------
    step : callable
        step(q, p, h) -> (q, p), or a function that changes its arguments in place and returns None. q and p are arrays
        of float64 and shape (d,), h is a float, also a negative one. The same arguments have to give the same bits.
    problem : str, Problem, or dict from Problem.at
        The problem that the step integrates. A name stands for the problem with default parameters:
        "harmonic", H = (p^2 + q^2)/2; "kepler", H = (p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2); "henon-heiles";
        "pendulum", H = p^2/2 - cos q. The start determines the sizes of q and p and the time scale, in any units. A
        Problem without a start is measured near a state that the catalogue declares for it. A problem without such
        a state needs `problem.at(q=..., p=...)`.
    order : int, optional
        The claimed order. A measured order agrees if it differs by at most 0.5, or by at most 1 for orders from 7.
    symplectic, symmetric : bool, optional
        The claim. A property without a claim is measured, but not compared.
    preserves : str or sequence of str, optional
        The quantities that the step is claimed to conserve up to rounding: "energy", or invariants such as
        "angular_momentum".

    Returns
    -------
    StepCertificate
        With order, symplectic, symmetric, preserves, agrees, reason for this problem. On a linear problem, or with one
        degree of freedom, a step may have properties that it does not claim; that does not refute a claim.

    Raises
    ------
    Error
        If the step raises, returns other shapes or NaN, changes nothing, or keeps hidden state; if the problem has
        walls or constraints, or an H that depends on t; if a name is unknown.

    Notes
    -----
    Errors of single steps are measured against Taylor series in long double. The Jacobian comes from central
    differences of order 6 with three difference lengths; their disagreement bounds its error [HLW2006, Def. VI.2.1].
    A property is True if its defect is at rounding level, False if the defect is as large as the error of the step, and
    None in between, for instance if equations are solved to a coarse tolerance or in single precision. The measurement
    takes some 2000 steps.

    Examples
    --------
    >>> import hamflow as hf, numpy as np
    >>> def leapfrog(q, p, h):
    ...     p -= h/2*np.sin(q)
    ...     q += h*p
    ...     p -= h/2*np.sin(q)
    >>> found = hf.certify_step(leapfrog, "pendulum", order=2, symplectic=True, symmetric=True)
    >>> round(found.order), found.symplectic, found.symmetric, found.preserves, found.agrees
    (2, True, True, {'energy': False}, True)
    """
    if not callable(step):
        raise Error(f"step: found {type(step).__name__}; allowed a function step(q, p, h)")
    if order is not None:
        try:
            order = operator.index(order)
        except TypeError:
            raise Error(f"order: found {shown(order)}; allowed a whole number from 1") from None
        if isinstance(order, bool) or not 1 <= order <= 1000:
            raise Error(f"order: found {shown(order)}; allowed a whole number from 1")
    names = [preserves] if isinstance(preserves, str) else list(preserves)
    if not all(isinstance(name, str) for name in names):
        raise Error(f"preserves: found {shown(preserves)}; allowed names")
    names = [name.replace(" ", "_") for name in names]
    return StepCertificate(_core.certify_step(step, _step_problem(problem), order, _claim(symplectic, "symplectic"),
                                              _claim(symmetric, "symmetric"), names))

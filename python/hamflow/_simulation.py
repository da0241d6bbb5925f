"""Simulations step by step, in memory."""

from __future__ import annotations

import weakref
from decimal import Decimal
from types import SimpleNamespace
from typing import Any, Callable, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._digits import decimals
from ._errors import Error, shown
from ._problem import Problem, _list
from ._scenario import Scenario

Numbers = npt.NDArray[np.float64]


class Trajectory:
    """Samples of a trajectory.

    The arrays are read-only views of memory of C++, and keep it alive. With digits=True t, q, p, energy are arrays of
    decimal.Decimal (dtype object).

    Attributes
    ----------
    t, q, p, energy, step : arrays of shape (n,), (n, d), (n, d), (n,), (n,)
    coordinates, momenta : list of str
        The names of the columns of q and p. [] takes these names, too.
    """

    def __init__(self, table: Any, coordinates: Sequence[str], momenta: Sequence[str], digits: bool = False) -> None:
        self._table, self.coordinates, self.momenta = table, list(coordinates), list(momenta)
        read: Callable[[str], npt.NDArray[Any]] = (lambda name: decimals(table, name)) if digits else table.__getitem__
        self.t: npt.NDArray[Any] = read("t")
        self.q: npt.NDArray[Any] = read("q")
        self.p: npt.NDArray[Any] = read("p")
        self.energy: npt.NDArray[Any] = read("energy")

    @property
    def step(self) -> npt.NDArray[np.int64]:
        """The number of steps since the start, of shape (n,)."""
        steps: npt.NDArray[np.int64] = self._table["step"]
        return steps

    @property
    def columns(self) -> list[str]:
        """The names that [] takes."""
        return ["t", *self.coordinates, *self.momenta, "energy", *(["step"] if "step" in self._table else [])]

    def __reduce__(self) -> tuple[Any, ...]:
        return (Trajectory, (self._table, self.coordinates, self.momenta, self.t.dtype == object))

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> Any:
        if name in self.coordinates:
            return self.q[:, self.coordinates.index(name)]
        if name in self.momenta:
            return self.p[:, self.momenta.index(name)]
        if name in ("t", "q", "p", "energy", "step"):
            return getattr(self, name)
        raise KeyError(f"no column {shown(name)}; there are {', '.join(self.columns)}")

    def __len__(self) -> int:
        return len(self.t)

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a column for each name in `columns`."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self.columns})

    def __repr__(self) -> str:
        span = f"t = {self.t[0]:g} .. {self.t[-1]:g}" if len(self) else "empty"
        return f"<hamflow.Trajectory {len(self)} samples, {span}>"


class Simulation:
    """One trajectory, integrated step by step in memory.

    Parameters
    ----------
    problem : Problem, str or dict
        A Problem, or what Problem() takes.
    method : str or dict
        A name such as "stv4" or "cg(1,5)", see `hamflow.methods`, or a table [method]. Default: "stv4".
    dt : float or str
        Step size. A negative step size integrates backward in time.
    q, p : sequence of d numbers, optional
        Coordinates and canonical momenta at the start. Texts are read in the arithmetic of the simulation. Default: the
        start in the table [problem].
    v : sequence of d numbers, optional
        Velocities at the start, in place of p.
    arithmetic : str
        "double", "compensated", "double-double", "quad", "mp(50)" or "lattice".
    functions : str
        "system": exp, sin, ... of the C library; "portable": with the same bits on every machine. All simulations that
        exist in a process at a time use the same.
    threads : int
        Number of threads for a problem of many particles.
    parameters : dict, optional
        Values of parameters of the problem, by name.

    Raises
    ------
    Rejection
        If the request is wrong. It lists all errors.

    Examples
    --------
    >>> import hamflow as hf
    >>> sim = hf.Simulation(hf.Problem("pendulum"), method="stv4", q=[1], p=[0], dt=0.05)
    >>> sim.advance(1000)
    >>> round(sim.t, 12)
    50.0
    >>> sim.energy_error.max_error < 1e-6
    True
    """

    __slots__ = ("_core", "_observers", "coordinates", "momenta", "__weakref__")

    def __init__(self, problem: Problem | str | dict[str, Any], /, *, method: str | dict[str, Any] = "stv4", dt: float | str,
                 q: Any = None, p: Any = None, v: Any = None, arithmetic: str = "double", functions: str = "system", threads: int = 1,
                 parameters: dict[str, Any] | None = None) -> None:
        chosen = problem if isinstance(problem, Problem) else Problem(problem)
        initial = {} if v is None else {"v": _list(v)}
        table = chosen._started(q, p, initial)
        if parameters:
            if chosen.name == "formula":
                table["parameters"] = dict(table.get("parameters", {})) | dict(parameters)
            else:
                table |= parameters
        run: dict[str, Any] = {"dt": dt, "steps": 1}
        if arithmetic != "double":
            run["arithmetic"] = arithmetic
        if functions != "system":
            run["functions"] = functions
        if threads != 1:
            run["threads"] = threads
        self._begin(_core.Simulation(Scenario(problem=table, method=method, run=run)._core))

    def _begin(self, core: Any) -> None:
        self._core = core
        self._observers: list[Callable[[Simulation], Any]] = []
        scenario = core.scenario
        self.coordinates: list[str] = list(scenario.coordinates)
        self.momenta: list[str] = list(scenario.momenta)

    @property
    def dt(self) -> float:
        """Step size."""
        return float(self._core.scenario.dt)

    def advance(self, steps: int) -> None:
        """Takes `steps` steps. advance(1000) gives the same bits as advance(1) called 1000 times.

        Raises
        ------
        StepFailed
            If a step fails. The simulation stays at the last good step.
        KeyboardInterrupt
            The simulation stays at the last step that it finished.
        """
        self._core.advance(steps)

    def integrate(self, t: float) -> None:
        """Advances to the time t, a multiple of dt.

        Raises
        ------
        Error
            If t is not a whole number of steps away, or is before the present time. `sample(at=...)` takes any time.
        """
        steps = (t - self.t) / self.dt
        if not np.isfinite(steps):
            raise Error(f"t: found {shown(t)}; allowed finite times")
        whole = round(steps)
        if not abs(steps - whole) <= 1e-9 * max(1.0, abs(steps)):
            raise Error(f"t: found {t!r}, which is not a whole number of steps from t = {self.t!r}; the nearest times are "
                        f"{self.t + np.floor(steps) * self.dt!r} and {self.t + np.ceil(steps) * self.dt!r}; sample(at=...) takes any time")
        if whole < 0:
            raise Error(f"t: found {t!r}, which is before t = {self.t!r}; allowed later times; to integrate backward, "
                        "call reverse() first")
        self.advance(whole)

    def sample(self, *, steps: int | None = None, every: int = 1, at: npt.ArrayLike | None = None,
               digits: bool = False) -> Trajectory:
        """Advances the simulation and returns samples of the trajectory. Needs either `steps` or `at`.

        Parameters
        ----------
        steps : int
            Number of steps to take. The samples are the present state and every `every`-th step.
        every : int
            Number of steps from one sample to the next. Default: 1.
        at : array_like of times
            Samples the states at these times, by partial steps of the method from the step before each time. Partial
            steps do not change the trajectory. The simulation ends at the last step before the last time.
        digits : bool
            Whether t, q, p, energy are arrays of decimal.Decimal with all digits; `at` may then contain texts. Only
            allowed in arithmetic with more digits than double.

        Returns
        -------
        Trajectory

        Raises
        ------
        Error
            With digits=True, if the arithmetic has no more digits than double.
        StepFailed, KeyboardInterrupt
            As in advance().
        """
        if (steps is None) == (at is None):
            raise TypeError("sample needs either steps= or at=")
        if at is not None:
            times = [each if isinstance(each, str) else repr(float(each)) for each in np.ravel(np.asarray(at)).tolist()]
            table = self._core.sample_at(times, digits)
        else:
            table = self._core.sample(steps, every, digits)
        return Trajectory(table, self.coordinates, self.momenta, digits)

    @property
    def step(self) -> int:
        """The number of steps since the start."""
        return int(self._core.step)

    @property
    def t(self) -> float:
        """The present time."""
        return float(self._core.t)

    @property
    def q(self) -> Numbers:
        """The coordinates, a copy of shape (d,)."""
        q: Numbers = self._core.q
        return q

    @property
    def p(self) -> Numbers:
        """The canonical momenta, a copy of shape (d,)."""
        p: Numbers = self._core.p
        return p

    @property
    def energy(self) -> float:
        """H at the present state."""
        return float(self._core.energy)

    @property
    def digits(self) -> SimpleNamespace:
        """t, q, p, energy with all digits, as decimal.Decimal. Raises Error if they are doubles."""
        all_digits = self._core.digits
        if not all_digits["q"]:
            raise Error("digits exist only in arithmetic with more digits than double; use t, q, p, energy")
        return SimpleNamespace(t=Decimal(all_digits["t"]), q=[Decimal(x) for x in all_digits["q"]],
                               p=[Decimal(x) for x in all_digits["p"]], energy=Decimal(all_digits["energy"]))

    @property
    def energy_error(self) -> SimpleNamespace:
        """The energies `initial` and `final`, and `max_error`, `scale` and `max_relative_error` over all steps."""
        initial, final, worst, scale = self._core.energy_range
        return SimpleNamespace(initial=initial, final=final, max_error=worst, scale=scale,
                               max_relative_error=worst / scale if scale > 0 else (0.0 if worst == 0 else float("nan")))

    @property
    def invariants(self) -> dict[str, SimpleNamespace]:
        """For each conserved quantity, by name: its `initial` and `final` value, and the `max_error` over all steps."""
        return {name: SimpleNamespace(initial=initial, final=final, max_error=worst)
                for name, initial, final, worst in self._core.invariants}

    @property
    def evaluations(self) -> dict[str, int]:
        """The numbers of evaluations since the start, by their kind."""
        return dict(self._core.evaluations)

    def reverse(self) -> None:
        """Reverses the momenta, so that the trajectory is followed backward."""
        self._core.negate_momenta()

    def copy(self) -> Simulation:
        """An independent copy of the simulation."""
        other = Simulation.__new__(Simulation)
        other._begin(self._core.copy())
        return other

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Simulation:
        return self.copy()

    def save(self) -> bytes:
        """Returns the complete state as bytes, from which load() continues bit for bit."""
        return bytes(self._core.save())

    def load(self, saved: bytes) -> None:
        """Restores the state that save() returned, from which the simulation continues bit for bit.

        Raises
        ------
        Error
            If the bytes are damaged or belong to another kind of simulation. The simulation is then unchanged.
        """
        self._core.load(saved)

    def observe(self, *, every: int = 1) -> Callable[[Callable[[Simulation], Any]], Callable[[Simulation], Any]]:
        """Decorates a function that is called with the simulation after every `every` steps.

        If the function returns "stop", advance(), integrate() and sample() end at this step; `step` is its number.
        """
        def decorate(function: Callable[[Simulation], Any]) -> Callable[[Simulation], Any]:
            # C++ gets only a weak reference to the simulation, because Python cannot free a cycle through C++.
            itself, place = weakref.ref(self), len(self._observers)

            def told() -> Any:
                simulation = itself()
                return simulation._observers[place](simulation) if simulation is not None else None

            self._core.watch(every, told)
            self._observers.append(function)
            return function

        return decorate

    def __getstate__(self) -> dict[str, Any]:
        return {"scenario": self._core.scenario.text, "saved": self.save()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._begin(_core.Simulation(_core.Scenario.read(state["scenario"], "scenario", [])))
        self.load(state["saved"])

    def __repr__(self) -> str:
        scenario = self._core.scenario
        return f"<hamflow.Simulation {scenario.problem}, {scenario.method}, dt = {self.dt:g}, t = {self.t:g}>"

"""Problems: Hamiltonians from the catalogue, from text, from functions and from SymPy."""

from __future__ import annotations

import difflib
import re
from typing import Any, Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _core, _html
from ._errors import Error, shown
from ._trace import traced

Numbers = npt.NDArray[np.float64]


def momentum_names(coordinates: Sequence[str]) -> list[str]:
    """Returns the names of the momenta in formulas: p for q, p1 for q1, p_x for x."""
    names = []
    for name in coordinates:
        is_q = name == "q" or (name[:1] == "q" and name[1:].isdigit())
        names.append("p" + name[1:] if is_q else "p_" + name)
    return names


class Problem:
    """A Hamiltonian H(q, p), without a start.

    Parameters
    ----------
    hamiltonian : str, callable, SymPy expression or dict
        One of: H as text in the names of coordinates and momenta (p for q, p1 for q1, p_x for x); a function (q, p)
        that is called once, with arrays of symbols; a SymPy expression; the name of a problem of the catalogue
        (`hamflow.problems()`); a table [problem] as a dict.
    coordinates : list of str, optional
        Names of the coordinates. Default with `dimension`: q for one coordinate, else q1, q2, ...
    dimension : int, optional
        Number of degrees of freedom, 1 to 100000. Replaces `coordinates`.
    parameters : mapping, optional
        Values of the other names in H: numbers, or texts with more digits.
    **keys
        Other keys of the table [problem], such as the parameters of a problem of the catalogue.

    Raises
    ------
    Rejection
        If the text is not a Hamiltonian, or a key is wrong.
    Error
        If the catalogue has no problem of this name.
    TypeError
        If an argument has the wrong type, or `coordinates` and `dimension` are both missing.

    Examples
    --------
    >>> import hamflow as hf
    >>> swing = hf.Problem("(p_x^2+p_y^2)/2 + g*y + k/2*(sqrt(x^2+y^2)-1)^2", coordinates=["x", "y"],
    ...                    parameters={"k": 20, "g": 1})
    >>> swing.momenta
    ['p_x', 'p_y']
    >>> swing.structure
    {'separable': True, 'quadratic_kinetic': True, 'time': False}
    """

    def __init__(self, hamiltonian: str | Callable[..., Any] | Mapping[str, Any] | Any, /, *,
                 coordinates: Sequence[str] | None = None, dimension: int | None = None,
                 parameters: Mapping[str, Any] | None = None, **keys: Any) -> None:
        known = {each["name"] for each in _core.problems()}
        if isinstance(hamiltonian, Mapping):
            if coordinates is not None or dimension is not None or parameters is not None:
                raise TypeError("a table [problem] has its coordinates and parameters in itself")
            self.table: dict[str, Any] = dict(hamiltonian) | keys
        elif isinstance(hamiltonian, str) and hamiltonian in known and hamiltonian != "formula":
            self.table = {"name": hamiltonian} | keys
            for name, value in (("coordinates", coordinates), ("dimension", dimension), ("parameters", parameters)):
                if value is not None:
                    self.table[name] = dict(value) if isinstance(value, Mapping) else value
        elif isinstance(hamiltonian, str) and coordinates is None and dimension is None and hamiltonian.replace("-", "_").isidentifier():
            near = difflib.get_close_matches(hamiltonian.replace("_", "-"), known, 1)
            meant = f"; did you mean {near[0]}?" if near else ""
            raise Error(f"problem: found {hamiltonian!r}; allowed {', '.join(sorted(known - {'formula'}))}, or H as text with "
                        f"coordinates={meant}")
        else:
            names = list(coordinates) if coordinates is not None else _numbered(dimension, hamiltonian)
            if callable(hamiltonian) and not hasattr(hamiltonian, "free_symbols"):
                text = traced(hamiltonian, names, momentum_names(names))
            elif not isinstance(hamiltonian, str) and not hasattr(hamiltonian, "free_symbols"):
                raise TypeError(f"hamiltonian: found {shown(hamiltonian)}; allowed a text, a function, a SymPy expression, or a dict")
            else:
                text = str(hamiltonian).replace("**", "^")
                if not isinstance(hamiltonian, str):  # SymPy's names of what formulas call otherwise
                    text = text.replace("Abs(", "abs(")
                    if "E" not in {str(symbol) for symbol in hamiltonian.free_symbols}:
                        text = re.sub(r"\bE\b", "exp(1)", text)
            self.table = {"name": "formula", "coordinates": names, "hamiltonian": text} | keys
            if parameters:
                self.table["parameters"] = dict(parameters)
        self._core = _core.Problem(self.table)

    @property
    def name(self) -> str:
        """The name in the catalogue, or "formula" for a typed Hamiltonian."""
        return str(self._core.name)

    @property
    def formula(self) -> str:
        """H as text."""
        return str(self._core.formula).removeprefix("H = ")

    @property
    def coordinates(self) -> list[str]:
        """Names of the coordinates; empty if their number depends on the start."""
        return list(self._core.coordinates)

    @property
    def momenta(self) -> list[str]:
        """Names of the momenta; empty if their number depends on the start."""
        return list(self._core.momenta)

    @property
    def parameters(self) -> dict[str, str]:
        """Values of all parameters, as texts."""
        return dict(self._core.parameters)

    @property
    def structure(self) -> dict[str, bool]:
        """{"separable": H = T(p) + V(q), "quadratic_kinetic": T is quadratic in p, "time": H depends on t}."""
        return dict(self._core.structure)

    def energy(self, q: npt.ArrayLike, p: npt.ArrayLike) -> float | Numbers:
        """Evaluates H(q, p) at one state or at n states.

        Parameters
        ----------
        q, p : array_like, shape (d,) or (n, d)

        Returns
        -------
        float, or array of shape (n,)
        """
        found: float | Numbers = self._core.energy(_state(q, "q"), _state(p, "p"))
        return found

    def gradient(self, q: npt.ArrayLike, p: npt.ArrayLike) -> tuple[Numbers, Numbers]:
        """Evaluates the derivatives of H at one state or at n states.

        Parameters
        ----------
        q, p : array_like, shape (d,) or (n, d)

        Returns
        -------
        dH/dq, dH/dp : arrays with the shape of q and p
        """
        by_q, by_p = self._core.gradient(_state(q, "q"), _state(p, "p"))
        return by_q, by_p

    def at(self, *, q: Sequence[Any] | Numbers | None = None, p: Sequence[Any] | Numbers | None = None,
           **initial: Any) -> dict[str, Any]:
        """Returns the table [problem] with a start, as `Scenario` takes it.

        Parameters
        ----------
        q, p : sequence of d numbers, optional
            Coordinates and canonical momenta. A text keeps all its digits.
        **initial
            Other keys of the table [problem.initial], such as v for velocities.

        Returns
        -------
        dict
        """
        return self._started(q, p, initial)

    def _started(self, q: Any, p: Any, initial: Mapping[str, Any]) -> dict[str, Any]:
        table = dict(self.table)
        start = dict(initial)
        if q is not None:
            start["q"] = _list(q)
        if p is not None:
            start["p"] = _list(p)
        if start:
            table["initial"] = start
        return table

    def __repr__(self) -> str:
        return f"<hamflow.Problem {self.name}: H = {self.formula}>"

    def _repr_html_(self) -> str:
        return _html.formula(f"H = {self.formula}")

    def __reduce__(self) -> tuple[Any, ...]:
        return (Problem, (self.table,))


def _numbered(dimension: int | None, hamiltonian: Any) -> list[str]:
    if dimension is None:
        if isinstance(hamiltonian, str) and hamiltonian.replace("-", "").replace("_", "").isalpha():
            names = [each["name"] for each in _core.problems()]
            from ._errors import Error
            raise Error(f"no problem {hamiltonian}; there are {', '.join(names)}")
        raise TypeError("coordinates: missing; allowed a list of names, or dimension=")
    if isinstance(dimension, bool) or not isinstance(dimension, (int, np.integer)) or not 1 <= dimension <= 100_000:
        raise TypeError(f"dimension: found {shown(dimension)}; allowed a whole number from 1 to 100000")
    return ["q"] if dimension == 1 else [f"q{i + 1}" for i in range(dimension)]


def _state(x: npt.ArrayLike, name: str) -> Numbers:
    try:
        array = np.ascontiguousarray(x, dtype=np.float64)
    except (TypeError, ValueError) as error:
        from ._errors import Error
        raise Error(f"{name}: found {type(x).__name__}; allowed arrays of numbers, (d,) or (n, d)") from error
    return array


def _list(x: Any) -> list[Any]:
    return list(x.tolist() if isinstance(x, np.ndarray) else x)

"""Symbols, with which `Problem(function)` records the formula of a Python function."""

from __future__ import annotations

import math
from typing import Any, Callable, NoReturn

import numpy as np

_REFUSED = "a Hamiltonian is traced once with symbols, for which {} has no value; {}"


class Symbol:
    """An expression of coordinates, momenta and parameters, kept as text in hamflow's notation."""

    __slots__ = ("text",)
    __array_priority__ = 1000.0

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return f"Symbol({self.text!r})"

    def _with(self, other: Any, form: str) -> Any:
        if not isinstance(other, (Symbol, int, float, np.number, np.bool_)):
            return NotImplemented
        return Symbol(form.format(self.text, text_of(other)))

    def __add__(self, other: Any) -> Any:
        return self._with(other, "({0} + {1})")

    def __radd__(self, other: Any) -> Any:
        return self._with(other, "({1} + {0})")

    def __sub__(self, other: Any) -> Any:
        return self._with(other, "({0} - {1})")

    def __rsub__(self, other: Any) -> Any:
        return self._with(other, "({1} - {0})")

    def __mul__(self, other: Any) -> Any:
        return self._with(other, "({0} * {1})")

    def __rmul__(self, other: Any) -> Any:
        return self._with(other, "({1} * {0})")

    def __truediv__(self, other: Any) -> Any:
        return self._with(other, "({0} / {1})")

    def __rtruediv__(self, other: Any) -> Any:
        return self._with(other, "({1} / {0})")

    def __pow__(self, other: Any) -> Any:
        return self._with(other, "({0})^({1})")

    def __rpow__(self, other: Any) -> Any:
        return self._with(other, "({1})^({0})")

    def __neg__(self) -> Symbol:
        return Symbol(f"(-{self.text})")

    def __pos__(self) -> Symbol:
        return self

    def __abs__(self) -> Symbol:
        return Symbol(f"abs({self.text})")

    def _refuse(self, what: str) -> NoReturn:
        raise TypeError(_REFUSED.format(what, "a Hamiltonian has no branches; abs() is allowed"))

    def __bool__(self) -> bool:
        self._refuse("a comparison or truth value")

    def __lt__(self, other: Any) -> bool:
        self._refuse("a comparison")

    __le__ = __gt__ = __ge__ = __lt__
    __eq__ = __lt__
    __ne__ = __lt__
    __hash__ = None  # type: ignore[assignment]

    def __float__(self) -> float:
        raise TypeError(_REFUSED.format("float()", "use hf.sin, hf.sqrt, ... or NumPy's functions, not those of math"))

    __int__ = __complex__ = __index__ = __float__

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **more: Any) -> Any:
        form = _FORMS.get(ufunc.__name__)
        if method != "__call__" or form is None or more:
            raise TypeError(f"numpy.{ufunc.__name__} is not traced; traced are {', '.join(sorted(_FORMS))}")
        arrays = [each for each in inputs if isinstance(each, np.ndarray)]
        if arrays:  # element by element
            found = np.empty(np.broadcast(*arrays).shape, dtype=object)
            spread = [each if isinstance(each, np.ndarray) else np.broadcast_to(np.array(each, dtype=object), found.shape)
                      for each in inputs]
            for place in np.ndindex(found.shape):
                found[place] = Symbol(form.format(*(text_of(each[place]) for each in spread)))
            return found
        return Symbol(form.format(*(text_of(each) for each in inputs)))


_FORMS = {name: name + "({0})" for name in
          ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh")}
_FORMS |= {"arcsin": "asin({0})", "arccos": "acos({0})", "arctan": "atan({0})", "absolute": "abs({0})",
           "fabs": "abs({0})", "arctan2": "atan2({0}, {1})", "hypot": "sqrt(({0})^2 + ({1})^2)",
           "square": "({0})^2", "power": "({0})^({1})", "float_power": "({0})^({1})", "add": "({0} + {1})",
           "subtract": "({0} - {1})", "multiply": "({0} * {1})", "divide": "({0} / {1})",
           "true_divide": "({0} / {1})", "negative": "(-{0})", "positive": "{0}",
           "reciprocal": "(1 / {0})"}


def text_of(x: Any) -> str:
    """Returns the text of a symbol or number. The text of a float is read as the same double."""
    if isinstance(x, Symbol):
        return x.text
    if isinstance(x, (bool, np.bool_)):
        raise TypeError("found a truth value in a Hamiltonian; allowed numbers and symbols")
    if isinstance(x, (int, np.integer)):
        return str(int(x)) if x >= 0 else f"({int(x)})"
    if isinstance(x, (float, np.floating)):
        if not math.isfinite(x):
            raise TypeError(f"found {x} in a Hamiltonian; allowed finite numbers")
        text = repr(float(x))
        return text if x >= 0 else f"({text})"
    raise TypeError(f"found {type(x).__name__} in a Hamiltonian; allowed numbers and symbols")


def _function(name: str, count: int = 1) -> Callable[..., Any]:
    ufunc = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}.get(name, name)

    def function(*x: Any) -> Any:
        if len(x) != count:
            raise TypeError(f"{name} takes {count} argument{'s' if count > 1 else ''}, found {len(x)}")
        try:
            return getattr(np, ufunc)(*x)
        except AttributeError as error:  # for an object of unknown type NumPy looks for a method of this name
            found = ", ".join(type(each).__name__ for each in x)
            raise TypeError(f"{name}: found {found}; allowed numbers, arrays of numbers, and symbols") from error

    function.__name__ = name
    function.__doc__ = f"{name} of symbols and numbers, for Hamiltonians given as Python functions."
    return function


sin, cos, tan = _function("sin"), _function("cos"), _function("tan")
asin, acos, atan, atan2 = _function("asin"), _function("acos"), _function("atan"), _function("atan2", 2)
sinh, cosh, tanh = _function("sinh"), _function("cosh"), _function("tanh")
exp, log, sqrt = _function("exp"), _function("log"), _function("sqrt")


def traced(function: Callable[..., Any], coordinates: list[str], momenta: list[str]) -> str:
    """Calls H with arrays of symbols, and returns the text of the result."""
    q = np.array([Symbol(name) for name in coordinates], dtype=object)
    p = np.array([Symbol(name) for name in momenta], dtype=object)
    found = function(q, p)
    if isinstance(found, np.ndarray) and found.shape == ():
        found = found.item()
    return text_of(found)

"""The errors that hamflow raises."""

from __future__ import annotations

import reprlib
from typing import Any, TypeVar

AnyException = TypeVar("AnyException", bound=BaseException)


class Error(ValueError):
    """A request is refused. The message names the error and the allowed values."""


class Rejection(Error):
    """A scenario is refused before anything runs.

    Attributes
    ----------
    errors : list of (key, message)
        All errors of the scenario.
    """

    def __init__(self, errors: list[tuple[str, str]]) -> None:
        self.errors = [tuple(each) for each in errors]
        super().__init__("\n".join(f"{key}: {message}" if key else message for key, message in self.errors))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Rejection, (self.errors,))


class StepFailed(Error):
    """A step failed. The simulation stays at the last good step.

    Attributes
    ----------
    kind : str
        The kind of failure, such as "not_converged" or "non_finite".
    step : int
        The number of the last good step.
    t : float
        The time of the last good step.
    hint : str
        What the caller can try.
    """

    def __init__(self, message: str, kind: str = "", step: int = 0, t: float = 0.0, hint: str = "") -> None:
        self.kind, self.step, self.t, self.hint = kind, step, t, hint
        super().__init__(f"{message}; {hint}" if hint else message)
        self._given = (message, kind, step, t, hint)

    def __reduce__(self) -> tuple[Any, ...]:
        return (StepFailed, self._given)


class FileError(Error, OSError):
    """A file or folder cannot be read or written."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def shown(found: Any) -> str:
    """The repr of a value for a message, shortened if it is long or deeply nested."""
    return reprlib.repr(found)


def stopped(error: AnyException, partial: Any) -> AnyException:
    """The error that ended a computation early, with the results so far as its attribute `partial`."""
    error.partial = partial  # type: ignore[attr-defined]
    return error

"""Measurements of the claims of methods."""

from __future__ import annotations

import json
from typing import Any, Sequence

from . import _core, _html
from ._errors import stopped


class Verification:
    """Claims of methods, with the measurements.

    Attributes
    ----------
    agrees : bool or None
        Whether every claim agrees with its measurement; None where one is unclear and none is refuted.
    claims : list of dict
        One for each property of each method: method, property, claimed, measured, agrees and, where something was not
        measured, reason.
    rows : list of dict
        One for each method, with the names and values of `hamflow verify --json`: method, reference, agrees,
        properties, certificate, measurements.
    text : str
        The table of the command.
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self.summary: dict[str, Any] = json.loads(found["json"])
        self.rows: list[dict[str, Any]] = self.summary["methods"]
        self.text: str = found["text"]
        self.claims: list[dict[str, Any]] = [{"method": row["method"]} | claim
                                             for row in self.rows for claim in row["properties"]]

    @property
    def agrees(self) -> bool | None:
        """Whether every claim agrees with its measurement."""
        verdicts = [row["agrees"] for row in self.rows]
        return False if False in verdicts else None if None in verdicts or not verdicts else True

    def __repr__(self) -> str:
        verdicts = {True: "agrees", False: "differs", None: "unclear"}
        return f"<hamflow.Verification {', '.join(str(row['method']) + ' ' + verdicts[row['agrees']] for row in self.rows)}>"

    def _repr_html_(self) -> str:
        names = ("method", "property", "claimed", "measured", "agrees")
        return _html.table(names, ([claim[name] for name in names] for claim in self.claims))


def verify(methods: str | Sequence[str] = (), /, *, problem: str | None = None, all: bool = False) -> Verification:  # noqa: A002
    """Measures order, structure, energy and cost of methods, and compares them with what the methods claim.

    Parameters
    ----------
    methods : str or list of str
        Such as "cg(1,5)".
    problem : str, optional
        A problem of the catalogue. Default: pendulum and henon-heiles, or what the method needs.
    all : bool
        Every method of the catalogue; takes minutes.

    Returns
    -------
    Verification

    Raises
    ------
    Rejection
        For unknown methods or problems.
    KeyboardInterrupt
        Its attribute `partial` has the methods that were measured.

    Examples
    --------
    >>> import hamflow as hf
    >>> hf.verify("verlet", problem="pendulum").agrees
    True
    """
    names = [methods] if isinstance(methods, str) else list(methods)
    if bool(names) == all:
        raise TypeError("verify takes methods, or all=True")
    found = _core.verify(names, all, problem or "")
    result = Verification(found)
    if found["interrupted"] is not None:
        raise stopped(found["interrupted"], result)
    return result

"""Measurements of the claims of methods."""

from __future__ import annotations

import json
from typing import Any, Sequence

from . import _core, _html
from ._errors import stopped


class Verification:
    """The result of verify(): the claims of methods beside their measurements.

    Attributes
    ----------
    agrees : bool or None
        True if all claims agree with their measurements, False if one is refuted, else None: a claim is undecided.
    claims : list of dict
        One for each property of each method: method, property, claimed, measured, agrees and, if something was not
        measured, reason.
    rows : list of dict
        One for each method, with the names and values of `hamflow verify --json`: method, reference, agrees,
        properties, certificate, measurements.
    summary : dict
        The whole JSON.
    text : str
        The table that the command prints.
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self.summary: dict[str, Any] = json.loads(found["json"])
        self.rows: list[dict[str, Any]] = self.summary["methods"]
        self.text: str = found["text"]
        self.claims: list[dict[str, Any]] = [{"method": row["method"]} | claim
                                             for row in self.rows for claim in row["properties"]]

    @property
    def agrees(self) -> bool | None:
        """True if all claims agree with their measurements, False if one is refuted, else None."""
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
        Names such as "cg(1,5)".
    problem : str, optional
        A problem of the catalogue. Default: pendulum and henon-heiles, or a problem that the method can integrate.
    all : bool
        Measures every method of the catalogue, in place of `methods`. This takes minutes.

    Returns
    -------
    Verification

    Raises
    ------
    Rejection
        If a method or the problem is unknown.
    TypeError
        Unless exactly one of `methods` and `all` is given.
    KeyboardInterrupt
        Its attribute `partial` is the verification of the methods that were measured until then.

    Examples
    --------
    >>> import hamflow as hf
    >>> hf.verify("verlet", problem="pendulum").agrees
    True
    """
    names = [methods] if isinstance(methods, str) else list(methods)
    if bool(names) == all:
        raise TypeError("verify needs methods, or all=True")
    found = _core.verify(names, all, problem or "")
    result = Verification(found)
    if found["interrupted"] is not None:
        raise stopped(found["interrupted"], result)
    return result

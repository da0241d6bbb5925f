"""Scenarios: the complete input of a run."""

from __future__ import annotations

import os
from typing import Any, Mapping

from . import _core
from ._errors import Error, shown
from ._problem import Problem


class Scenario:
    """The input of a run: problem, method, run and output.

    Parameters
    ----------
    tree : mapping, optional
        All tables, {"problem": {...}, "method": {...}, "run": {...}}. Each may have the type of the keyword below, and
        keywords replace its tables.
    problem : Problem or mapping, optional
        A problem with its start, as `Problem.at` returns it.
    method : str or mapping, optional
        A name such as "stv4" or "cg(1,5)", or a table.
    run, output : mapping, optional
        The tables [run] and [output]. Numbers may be texts: "2*pi/100".

    Raises
    ------
    Rejection
        If the scenario is wrong. It lists all errors.
    Error
        If a table has the wrong type.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.05, "steps": 100})
    >>> hf.run(s).status
    'done'
    """

    def __init__(self, tree: Mapping[str, Any] | None = None, /, *, problem: Problem | Mapping[str, Any] | None = None,
                 method: str | Mapping[str, Any] | None = None, run: Mapping[str, Any] | None = None,
                 output: Mapping[str, Any] | None = None) -> None:
        given = {"problem": problem, "method": method, "run": run, "output": output}
        all_tables = dict(tree or {}) | {name: table for name, table in given.items() if table is not None}
        self._read(_core.scenario_text(tables_of(all_tables)), "scenario")

    def _read(self, text: str, name: str, sets: list[str] | None = None) -> None:
        self._core = _core.Scenario.read(text, name, sets or [])
        self._name = name

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Scenario:
        """Reads a scenario from a TOML file.

        Raises
        ------
        FileError
            If the file cannot be read.
        Rejection
            If the scenario is wrong.
        """
        return cls.from_text(_core.read_file(os.fspath(file)), os.fspath(file))

    @classmethod
    def from_text(cls, text: str, name: str = "scenario") -> Scenario:
        """Reads a scenario from TOML text. Messages show `name` in place of a file name.

        Raises
        ------
        Rejection
            If the scenario is wrong.
        """
        self = cls.__new__(cls)
        self._read(text, name)
        return self

    def set(self, key: str, value: Any) -> None:
        """Sets one key, and checks the whole scenario again.

        Parameters
        ----------
        key : str
            A dotted path, such as "run.steps".
        value : number, str, bool, sequence or mapping

        Raises
        ------
        Rejection
            If the new scenario is wrong; the old one stays.
        """
        if not isinstance(key, str):
            raise TypeError(f"key: found {shown(key)}; allowed a text such as \"run.steps\"")
        self._read(self._core.text, self._name, [f"{key}={_core.value_text(value)}"])

    @property
    def steps(self) -> int:
        """Number of steps."""
        return int(self._core.steps)

    @property
    def dt(self) -> float:
        """Step size."""
        return float(self._core.dt)

    @property
    def coordinates(self) -> list[str]:
        """Names of the coordinates."""
        return list(self._core.coordinates)

    @property
    def momenta(self) -> list[str]:
        """Names of the momenta."""
        return list(self._core.momenta)

    def __str__(self) -> str:
        return str(self._core.text)

    def __repr__(self) -> str:
        core = self._core
        return f"<hamflow.Scenario {core.problem}, {core.method}, dt = {core.dt:g}, {core.steps} steps>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Scenario.from_text, (str(self), self._name))


def tables_of(tree: Mapping[str, Any]) -> dict[str, Any]:
    """Copies the tables of a scenario into dicts. A method may be given by its name, a problem as a Problem."""
    tables: dict[str, Any] = {}
    for name, table in tree.items():
        if name == "method" and isinstance(table, str):
            tables[name] = {"name": table}
        elif name == "problem" and isinstance(table, Problem):
            tables[name] = dict(table.table)
        elif isinstance(table, Mapping):
            tables[name] = dict(table)
        else:
            raise Error(f"{name}: found {shown(table)}; allowed a table, as a dict")
    return tables


def scenario_of(given: Any) -> Scenario:
    """Returns the scenario that a Scenario, a dict or the name of a file describes."""
    if isinstance(given, Scenario):
        return given
    text, name = text_of(given)
    return Scenario.from_text(text, name)


def text_of(given: Any) -> tuple[str, str]:
    """Returns the unchecked TOML text of a Scenario, a dict or a file, and its name for messages."""
    if isinstance(given, Scenario):
        return str(given), given._name
    if isinstance(given, Mapping):
        return _core.scenario_text(tables_of(given)), "scenario"
    if isinstance(given, (str, os.PathLike)):
        return _core.read_file(os.fspath(given)), os.fspath(given)
    raise TypeError(f"found {type(given).__name__}; allowed a Scenario, a dict of tables, or the name of a TOML file")

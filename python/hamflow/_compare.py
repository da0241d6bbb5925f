"""Work-precision comparison of methods."""

from __future__ import annotations

import json
import os
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, NoReturn, Sequence

from . import _core, _html
from ._errors import Error, stopped
from ._run import Progress, progress_of_both
from ._scenario import text_of

_SHOWN = ("method", "order", "dt", "steps", "evaluations", "error", "max_energy_error", "seconds", "status")


class Compare:
    """The result of compare(): several methods with several step sizes on one problem.

    Attributes
    ----------
    rows : list of dict
        One row for each method and step size, with the names and values of `hamflow compare --json`: method, order, dt,
        steps, status, evaluations (force, gradient, hessian, linear_solves), error (the largest difference at the end,
        divided by the size of the coordinate along the trajectory), max_energy_error, end_energy_error, seconds, ...
        A number too small for a float is a text.
    summary : dict
        The whole JSON: status, reference (kind, description, q, p, uncertainty), rows, winners, warnings.
    status : str
        "failed" if no run finished.
    text : str
        The table that the command prints.
    notes : list of str
        Notes on the request: unused keys, and step sizes that were changed.
    """

    def __init__(self, report: Any, notes: Sequence[str]) -> None:
        self._report = report
        self.summary: dict[str, Any] = json.loads(report.json)
        self.rows: list[dict[str, Any]] = self.summary["rows"]
        self.status: str = self.summary["status"]
        self.text: str = report.text
        self.notes = list(notes)

    def plot(self, ax: Any = None) -> Any:
        """Draws three panels: error over evaluations, error over seconds, and energy error over evaluations.

        Parameters
        ----------
        ax : matplotlib axes, or an array of three, optional
            Single axes show only the error over evaluations. Default: new axes.

        Returns
        -------
        The axes.

        Raises
        ------
        Error
            If no run has an error that can be drawn.
        """
        from ._page import draw

        return draw(self._report.page(), ax)

    def figure(self, file: str | os.PathLike[str]) -> None:
        """Draws the same figure with gnuplot into a file.

        Parameters
        ----------
        file : path
            Its suffix selects the format: .svg, .pdf or .png.
        """
        self._report.draw(os.fspath(file))

    def to_pandas(self) -> Any:
        """Returns the rows as a pandas.DataFrame, with one column for each kind of evaluation."""
        import pandas

        return pandas.json_normalize(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Compare cannot be pickled, as its figures are memory of C++; pass its rows, or its summary")

    def __repr__(self) -> str:
        methods = dict.fromkeys(row["method"] for row in self.rows)
        return f"<hamflow.Compare {self.summary['problem']}: {', '.join(methods)}, {len(self.rows)} runs, {self.status}>"

    def _repr_html_(self) -> str:
        def shown(row: dict[str, Any], name: str) -> Any:
            return row[name]["force"] + row[name]["gradient"] if name == "evaluations" else row[name]

        return _html.table(_SHOWN, ([shown(row, name) for name in _SHOWN] for row in self.rows))


def _number(dt: Any) -> str:
    return str(dt) if isinstance(dt, (str, Decimal, Fraction)) else str(_core.value_text(dt))


def compare(scenario: Any, /, *, methods: Sequence[str] | str, dt: Sequence[Any] | float | str | None = None,
            out: str | os.PathLike[str] | None = None, existing: str = "error",
            progress: bool | Progress | None = None) -> Compare:
    """Runs a scenario with several methods and step sizes, and measures error, evaluations and time.

    Parameters
    ----------
    scenario : Scenario, dict of tables, or name of a TOML file
        `methods` replaces its method. Other keys of its table [method] apply to every method that has them.
    methods : list of str
        For example ["verlet", "cg(1,5)"].
    dt : list of float or str, optional
        Step sizes. Each is replaced by the nearest one that divides the time of the run. Default: 2, 1, 1/2, ..., 1/16
        times the step size of the scenario.
    out : path, optional
        Output directory, for compare.json, compare.csv and figures/. Default: no files are written.
    existing : "error" or "replace"
        What to do if the output directory exists.
    progress : bool or callable(done, total), optional
        Whether to show progress, or a function that is called with the number of finished runs and of all runs.
        Default: show it on a terminal or in a notebook, if the comparison takes longer than 2 s.

    Returns
    -------
    Compare

    Raises
    ------
    Rejection
        If the scenario is wrong. It lists all errors, and is raised before anything runs.
    Error
        If no run finishes. Its attribute `partial` is the comparison.
    FileError
        If a file or folder cannot be read or written.
    KeyboardInterrupt
        Its attribute `partial` is the comparison up to the interrupt.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 50})
    >>> cmp = hf.compare(s, methods=["verlet", "stv4"], dt=[0.1, 0.05])
    >>> [(row["method"], row["steps"]) for row in cmp.rows]
    [('verlet', 50), ('verlet', 100), ('stv4', 50), ('stv4', 100)]
    >>> cmp.rows[3]["error"] < cmp.rows[1]["error"]
    True
    """
    text, name = text_of(scenario)
    sizes = [] if dt is None else [dt] if isinstance(dt, (str, int, float, Decimal, Fraction)) else list(dt)
    found = _core.compare(text, name, [methods] if isinstance(methods, str) else list(methods),
                          [_number(each) for each in sizes], Path(out) if out is not None else "", existing,
                          progress_of_both(progress))
    result = Compare(found["report"], found["notes"])
    if found["interrupted"] is not None:
        raise stopped(found["interrupted"], result)
    if result.status == "failed":
        report = found["report"]
        raise stopped(Error(f"{report.message}; {report.hint}" if report.hint else report.message), result)
    return result

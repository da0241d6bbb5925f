"""Sweeps: one scenario for many values of some of its keys."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from . import _core, _html
from ._errors import Error, shown, stopped
from ._page import require_axes
from ._run import Progress, States, progress_of_both
from ._scenario import Scenario, scenario_of


class Sweep:
    """The result of sweep(): a table with one row for each member. [] takes column names, such as "final/q".

    Attributes
    ----------
    summary : dict
        The summary that `hamflow sweep --json` prints.
    failures : list of str
        The messages of members that failed.
    scenario : Scenario
        The scenario that all members share, before any key is varied.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self._found = {"members": found["members"], "section": found["section"], "json": found["json"],
                       "failures": list(found["failures"]), "scenario": found["scenario"]}
        self._members, self._section = found["members"], found["section"]
        self.summary: dict[str, Any] = json.loads(found["json"])
        self.failures: list[str] = list(found["failures"])

    @property
    def scenario(self) -> Scenario:
        """The scenario that all members share, before any key is varied."""
        return Scenario.from_text(self._found["scenario"])

    @property
    def columns(self) -> list[str]:
        """The names that [] takes."""
        return list(self._members.columns)

    @property
    def status(self) -> list[str]:
        """The status of each member: "done", "failed", ..."""
        return list(self._members["member/status"])

    @property
    def section(self) -> States | None:
        """The section points of all members (member, t, q, p), or None without run.section."""
        return States(self._section, "section/") if self._section.columns else None

    def __getitem__(self, name: str) -> Any:
        return self._members[name]

    def __len__(self) -> int:
        return len(self._members)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __iter__(self) -> Any:
        return iter(self.columns)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Sweep, (self._found,))

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a row for each member."""
        import pandas

        columns: dict[str, Any] = {}
        for name in self.columns:
            values = self[name]
            if getattr(values, "ndim", 1) == 1:
                columns[name] = values
            else:
                columns.update({f"{name}{i + 1}": values[:, i] for i in range(values.shape[1])})
        return pandas.DataFrame(columns)

    def plot(self, ax: Any = None, *, colour: str = "energy/max_error") -> Any:
        """Draws a column as a curve over one varied key, or as colours over two varied keys.

        Parameters
        ----------
        ax : matplotlib axes, optional
            Default: new axes.
        colour : str
            The column, with one number for each member, such as "observables/lyapunov1".

        Returns
        -------
        The axes.

        Raises
        ------
        Error
            If the column has no numbers, or if other than one or two keys of numbers were varied.
        """
        keys = [name for name in self.columns if name.startswith("varied/") and self._is_number(name)]
        if len(keys) not in (1, 2):
            raise Error(f"plot: found {len(keys)} varied keys of numbers; allowed one or two")
        if colour not in self.columns or not self._is_number(colour):
            numbers = [name for name in self.columns if self._is_number(name) and name not in keys]
            raise Error(f"colour: found {shown(colour)}; allowed {', '.join(numbers)}")
        if ax is None:
            import matplotlib.pyplot as plt

            _, ax = plt.subplots()
        require_axes(ax)
        values = np.where(np.array(self.status) == "done", self[colour], np.nan)
        x = self[keys[0]]
        ax.set_xlabel(keys[0].removeprefix("varied/"))
        if len(keys) == 1:
            words = [name for name in self.columns if name.startswith("varied/") and name not in keys]
            labels = np.array([", ".join(str(self[name][k]) for name in words) for k in range(len(self))])
            for label in dict.fromkeys(labels.tolist()):  # for example, one curve for each method
                own = np.flatnonzero(labels == label)
                own = own[np.argsort(x[own], kind="stable")]
                ax.plot(x[own], values[own], ".-", label=label)
            if words:
                ax.legend(title=", ".join(name.removeprefix("varied/") for name in words))
            if colour.startswith("energy/") and np.nanmin(values, initial=np.inf) > 0:
                ax.set_yscale("log")
            ax.set_ylabel(colour)
            return ax
        y = self[keys[1]]
        ax.set_ylabel(keys[1].removeprefix("varied/"))
        columns, rows = np.unique(x), np.unique(y)
        if len(columns) * len(rows) == len(values):  # a Cartesian product
            grid = values[np.lexsort((x, y))].reshape(len(rows), len(columns))
            drawn = ax.pcolormesh(columns, rows, grid, shading="nearest")
        else:
            drawn = ax.scatter(x, y, c=values, s=4)
        ax.figure.colorbar(drawn, ax=ax, label=colour)
        return ax

    def _is_number(self, name: str) -> bool:
        values = self[name]
        return isinstance(values, np.ndarray) and values.ndim == 1

    def _repr_html_(self) -> str:
        shown = 20
        names = [name for name in self.columns if name.startswith("varied/")]
        names += [name for name in ("member/status", "energy/max_error") if name in self.columns]
        rows = ([self[name][k] for name in names] for k in range(min(len(self), shown)))
        more = f"<p>... {len(self) - shown} more</p>" if len(self) > shown else ""
        return _html.table(names, rows) + more

    def __repr__(self) -> str:
        return f"<hamflow.Sweep {len(self)} members, {self.summary['status']}>"


def _varied(key: str, values: Any) -> str:
    if isinstance(values, str):
        return f"{key}={values}"
    if isinstance(values, np.ndarray) and values.dtype == np.float64 and values.ndim == 1 and values.size:
        return str(_core.varied_text(key, values))
    items = values.tolist() if isinstance(values, np.ndarray) else list(values)
    if not items:
        raise Error(f"{key}: found no values; allowed at least one")
    texts = [each if isinstance(each, str) else _core.value_text(each) for each in items]
    for text in texts:
        if "," in text and not (text.startswith("[") or "(" in text):
            raise Error(f"{key}: found {text!r}; allowed values without commas")
    return f"{key}=" + ",".join(texts)


def sweep(scenario: Any, varied: Mapping[str, Any], /, *, zip: bool = False, threads: int | None = None,  # noqa: A002
          out: str | os.PathLike[str] | None = None, existing: str = "error",
          progress: bool | Progress | None = None, client: Any = None, shard: str | None = None) -> Sweep:
    """Runs a scenario for many values of some of its keys, in SIMD lanes and on all cores.

    Parameters
    ----------
    scenario : Scenario, dict of tables, or name of a TOML file
    varied : mapping of dotted key to array, list or text
        For example {"problem.initial.q[1]": np.linspace(-.4, .6, 100)}. A text has the form of the command line:
        "a:b:n", or a formula of other keys. Several keys form a Cartesian product; the last one varies fastest.
    zip : bool
        Combine the n-th values of all keys instead of forming the product.
    threads : int, optional
        Number of threads. Default: one for each core. Results have the same bits with any number.
    out : path, optional
        Output directory. Default: nothing is written.
    existing : "error", "replace" or "resume"
        What to do if the output directory exists. "resume" runs only the members that are not finished.
    progress : bool or callable(done, total), optional
        Whether to show progress, or a function that is called with the number of steps taken and of all steps of all
        members. Default: show it on a terminal or in a notebook, if the sweep takes longer than 2 s.
    client : dask.distributed.Client, optional
        Runs the members on the workers of a Dask cluster, on which the same version of hamflow has to be installed.
        Results have the same bits as without a cluster. `threads` is not used.
    shard : str, optional
        "3/64": run only the members k with k mod 64 = 3, in a folder of their own within `out`, which is needed. "auto"
        takes the numbers from Slurm, Open MPI or PMI. Afterwards the same call without `shard`, with
        existing="resume", reads what all shards have finished, runs the rest and writes the table.

    Returns
    -------
    Sweep

    Raises
    ------
    Rejection
        If the scenario or a varied key is wrong. It lists all errors, and is raised before anything runs.
    FileError
        If a file or folder cannot be read or written.
    Error
        If workers of the cluster fail. Its attribute `partial` is the sweep with the members that finished.
    KeyboardInterrupt
        Its attribute `partial` is the sweep with the members that finished, or None if members were still being read.
        An exception that `progress` raises has the same attribute.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 100})
    >>> ens = hf.sweep(s, {"problem.initial.q[0]": [0.5, 1.0, 1.5]})
    >>> ens["final/q"].shape, ens.status
    ((3, 1), ['done', 'done', 'done'])
    """
    wanted = scenario_of(scenario)
    if not isinstance(varied, Mapping):
        raise TypeError(f"varied: found {type(varied).__name__}; allowed a dict of keys and their values")
    if shard is not None and (out is None or client is not None):
        raise Error(f"shard: found {shard!r} {'without out' if out is None else 'with client'}; "
                    "allowed with out, and without client")
    if client is not None and not hasattr(client, "nthreads"):
        raise TypeError(f"client: found {type(client).__name__}; allowed a dask.distributed.Client")
    if client is not None:
        return _on_cluster(client, str(wanted), [_varied(key, values) for key, values in varied.items()], zip, out,
                           existing, progress)
    try:
        asked = [_varied(key, values) for key, values in varied.items()]
        found = _core.sweep(str(wanted), asked, zip, threads or 0, shard or "", Path(out) if out is not None else "",
                            existing, progress_of_both(progress))
    except KeyboardInterrupt as error:  # the members are still being read
        raise stopped(error, None) from None
    result = Sweep({**found, "scenario": str(wanted)})
    if found["interrupted"] is not None:
        raise stopped(found["interrupted"], result)
    return result


def _shard(text: str, varied: list[str], zip: bool, index: int, count: int) -> bytes:  # noqa: A002
    """Runs the members index, index + count, ... of a sweep on a worker, and returns their results as bytes."""
    return bytes(_core.sweep_shard(text, varied, zip, index, count))


def _on_cluster(client: Any, text: str, varied: list[str], zip: bool, out: Any,  # noqa: A002
                existing: str, progress: bool | Progress | None) -> Sweep:
    from distributed import as_completed

    gathered = _core.GatheredSweep(text, varied, zip, Path(out) if out is not None else "", existing)
    members = gathered.members
    # Four parts for each thread, because Dask repeats the whole part of a worker that dies on another worker.
    count = max(1, min(members, 4 * sum(client.nthreads().values())))
    told = progress_of_both(progress)
    completed: Any = as_completed  # distributed has no annotations
    futures = client.map(_shard, [text] * count, [varied] * count, [zip] * count, range(count),
                         [count] * count, pure=False)
    trouble: BaseException | None = None
    try:
        for done, future in enumerate(completed(futures), 1):
            gathered.take(future.result())
            if told is not None:
                told(members * done // count, members)
    except (KeyboardInterrupt, Exception) as error:  # the result keeps the finished members
        trouble = error
        client.cancel(futures)
    result = Sweep({**gathered.found(), "scenario": text})
    if trouble is None:
        return result
    if not isinstance(trouble, (KeyboardInterrupt, Error)):
        cause = trouble
        trouble = Error(f"the cluster failed: {type(cause).__name__}: {cause}")
        trouble.__cause__ = cause
    raise stopped(trouble, result)


def propagate(problem: Any, method: str, q: npt.ArrayLike, p: npt.ArrayLike, /, *, dt: float | str, steps: int,
              parameters: Mapping[str, Any] | None = None) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Integrates n starts over `steps` steps, in SIMD lanes and on all cores, and returns their final states.

    Parameters
    ----------
    problem : Problem, str or dict
        A Problem, or what Problem() takes.
    method : str
        A name such as "stv4" or "cg(1,5)".
    q, p : array_like of shape (n, d)
        Coordinates and canonical momenta of the starts.
    dt : float or str
        Step size.
    steps : int
        Number of steps.
    parameters : mapping, optional
        Values of parameters by name: one for all starts, or an array with one for each start.

    Returns
    -------
    q, p : arrays of shape (n, d)

    Raises
    ------
    Rejection
        If the request is wrong.
    Error
        If a member fails; the message names the first one. Its attribute `partial` is the sweep.

    Examples
    --------
    >>> import hamflow as hf
    >>> q, p = hf.propagate("pendulum", "stv4", [[0.5], [1.0]], [[0], [0]], dt=0.1, steps=100)
    >>> q.shape
    (2, 1)
    """
    from ._problem import Problem

    chosen = problem if isinstance(problem, Problem) else Problem(problem)
    q0 = np.atleast_2d(np.asarray(q, dtype=np.float64))
    p0 = np.atleast_2d(np.asarray(p, dtype=np.float64))
    if q0.shape != p0.shape or q0.ndim != 2 or q0.size == 0:
        raise Error(f"q and p: found shapes {np.shape(q)} and {np.shape(p)}; allowed one shape (n, d)")
    table = chosen._started(q0[0], p0[0], {})
    n, d = q0.shape
    varied: dict[str, Any] = {f"problem.initial.q[{i}]": q0[:, i] for i in range(d)}
    varied |= {f"problem.initial.p[{i}]": p0[:, i] for i in range(d)}
    if parameters is not None and not isinstance(parameters, Mapping):
        raise TypeError(f"parameters: found {type(parameters).__name__}; allowed a dict of names and values")
    for name, value in (parameters or {}).items():
        path = f"problem.parameters.{name}" if chosen.name == "formula" else f"problem.{name}"
        if np.ndim(value) == 1:
            if len(np.asarray(value)) != n:
                raise Error(f"parameters[{name!r}]: found {len(np.asarray(value))} values; allowed one, or {n}")
            varied[path] = np.asarray(value, dtype=np.float64)
        elif chosen.name == "formula":
            table["parameters"] = dict(table.get("parameters", {})) | {name: value}
        else:
            table[name] = value
    from ._scenario import Scenario

    scenario = Scenario(problem=table, method=method, run={"dt": dt, "steps": steps, "certificate": False})
    members = sweep(scenario, varied, zip=True, progress=False)
    if members.summary["done"] != n:
        bad = [k for k, status in enumerate(members.status) if status != "done"]
        more = f"; {len(bad)} of {n} members failed" if len(bad) > 1 else ""
        raise stopped(Error(f"member {bad[0]} ended as {members.status[bad[0]]}: {(members.failures or [''])[0]}{more}"), members)
    return np.array(members["final/q"]), np.array(members["final/p"])

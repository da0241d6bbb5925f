"""Complete runs, as with the command `hamflow run`."""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _core, _html
from ._digits import decimals
from ._errors import Error, FileError, StepFailed, shown, stopped
from ._scenario import Scenario, scenario_of

Numbers = npt.NDArray[np.float64]
Progress = Callable[[int, int], Any]


def _as_attributes(tree: Any) -> Any:
    """Converts dicts, at any depth, to objects with the entries as attributes."""
    if isinstance(tree, Mapping):
        return SimpleNamespace(**{str(key).replace(" ", "_"): _as_attributes(value) for key, value in tree.items()})
    if isinstance(tree, list):
        return [_as_attributes(entry) for entry in tree]
    return tree


class States:
    """Points of a section, bounces or events.

    Attributes
    ----------
    t, q, p : arrays of shape (n,), (n, d), (n, d)
        Every other column of the table is an attribute, too. [] takes the names of columns.
    """

    def __init__(self, table: Any, prefix: str = "") -> None:
        self._table, self._prefix = table, prefix
        for name in table.columns:
            short = name.removeprefix(prefix)
            if "/" not in short:
                setattr(self, short, table[name])

    def __getitem__(self, name: str) -> Any:
        return self._table[name if name in self._table else self._prefix + name]

    def __reduce__(self) -> tuple[Any, ...]:
        return (States, (self._table, self._prefix))

    def __len__(self) -> int:
        return len(self._table)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise AttributeError(f"no column {name!r}; there are {', '.join(self._table.columns)}")

    def __repr__(self) -> str:
        return f"<hamflow.States {len(self)} rows: {', '.join(self._table.columns)}>"


class Run:
    """The results of a run.

    Attributes
    ----------
    status : str
        "done", "failed", "interrupted", or "running" for an opened run without a summary.
    t, q, p, energy : arrays of shape (n,), (n, d), (n, d), (n,)
        The samples, as read-only views of float64. After run(..., digits=True) or open(..., digits=True) they are
        arrays of decimal.Decimal (dtype object) with all digits of the arithmetic.
    summary : dict
        The summary that `hamflow run --json` prints.
    scenario : Scenario
        What was run.
    folder : Path or None
        The folder of the run; None if nothing was written.
    warnings : list of objects
        The warnings of the summary.
    notes : list of str
        Notes about the start of the run: unused keys, and the step from which the run was resumed.
    """

    def __init__(self, scenario: Scenario, tables: Any, summary: str, folder: Path | None, digits: bool = False,
                 notes: list[str] | None = None) -> None:
        self.scenario, self._tables, self.folder = scenario, tables, folder
        self.notes = [*scenario._core.notes, *(notes or [])]
        samples = tables.samples
        self._samples = samples
        self.summary: dict[str, Any] = json.loads(summary) if summary else {}
        self.status: str = self.summary.get("status", "running")
        read = self.digits if digits else samples.__getitem__
        self.t: npt.NDArray[Any] = read("t")
        self.q: npt.NDArray[Any] = read("q")
        self.p: npt.NDArray[Any] = read("p")
        self.energy: npt.NDArray[Any] = read("energy")
        self.warnings: list[SimpleNamespace] = _as_attributes(self.summary.get("warnings", []))

    @property
    def columns(self) -> list[str]:
        """The names that [] takes."""
        short = [name.split("/", 1)[1] for name in self._samples.columns
                 if name.startswith(("observables/", "invariants/"))]
        return list(dict.fromkeys(["t", *self.scenario.coordinates, *self.scenario.momenta, *short, *self._samples.columns]))

    def __getitem__(self, name: str) -> Any:
        if name in self.scenario.coordinates:
            return self.q[:, self.scenario.coordinates.index(name)]
        if name in self.scenario.momenta:
            return self.p[:, self.scenario.momenta.index(name)]
        if name in ("t", "q", "p", "energy"):
            return getattr(self, name)
        for place in (name, "observables/" + name, "invariants/" + name):
            if place in self._samples:
                return self._samples[place]
        raise KeyError(f"no column {shown(name)}; there are {', '.join(self.columns)}")

    def digits(self, name: str) -> npt.NDArray[Any]:
        """Returns t, q, p or energy with all digits, as an array of decimal.Decimal (dtype object).

        Raises
        ------
        Error
            If the arithmetic has no more digits than double, or if `name` is another column.
        """
        if name not in ("t", "q", "p", "energy"):
            raise Error(f"name: found {shown(name)}; allowed t, q, p, energy")
        return decimals(self._samples, name)

    @property
    def certificate(self) -> Any:
        """The certificate of the summary (drift, growth_exponent, energy_level, reason, ...), or None."""
        return _as_attributes(self.summary.get("certificate"))

    @property
    def lyapunov(self) -> Any:
        """The Lyapunov exponents (exponents, errors, ...), or None without run.lyapunov."""
        return _as_attributes(self.summary.get("lyapunov"))

    @property
    def section(self) -> States | Any:  # not `| None`, so that type checkers accept run.section.q without a test
        """The points of the Poincare section run.section, or None without one."""
        return States(self._tables.section) if self._tables.section is not None else None

    @property
    def bounces(self) -> States | Any:
        """The recorded bounces off hard walls, or None without a record."""
        return States(self._tables.bounces) if self._tables.bounces is not None else None

    @property
    def events(self) -> dict[str, States]:
        """The located events, by their name in run.events."""
        return {name: States(table) for name, table in self._tables.events.items()}

    @property
    def observables(self) -> dict[str, Numbers]:
        """The values of the expressions of output.observables, by name: one for each sample."""
        return {name[12:]: self._samples[name] for name in self._samples.columns if name.startswith("observables/")}

    @property
    def invariants(self) -> dict[str, Numbers]:
        """The values of the conserved quantities of the problem, by name: one for each sample."""
        return {name[11:]: self._samples[name] for name in self._samples.columns if name.startswith("invariants/")}

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame of t, coordinates, momenta and energy."""
        import pandas

        names = ["t", *self.scenario.coordinates, *self.scenario.momenta, "energy"]
        return pandas.DataFrame({name: self[name] for name in names})

    def _page(self, kind: str, x: str = "", y: Sequence[str] = (), at: Sequence[float] = ()) -> dict[str, Any]:
        names = [y] if isinstance(y, str) else list(y)
        return dict(_core.page(self.scenario._core, self._tables, kind, x, names, [float(time) for time in at]))

    def plot(self, kind: str = "", ax: Any = None, *, x: str = "", y: Sequence[str] = (),
             at: Sequence[float] = ()) -> Any:
        """Draws a figure on matplotlib axes.

        Parameters
        ----------
        kind : str
            "orbit", "time", "energy", "energy-error", "phase", "section", "particles", "tracks", "radial",
            "condition"; `hamflow.show(kind)` explains each. Default: the first kind that the run allows.
        ax : matplotlib axes, or an array of them, optional
            One for each panel. Single axes show the first panel. Default: new axes.
        x, y : str, list of str
            Columns for the axes of "time", "orbit" and "phase".
        at : list of float
            Times for "particles" and "radial".

        Returns
        -------
        The axes; an array of them if more than one panel is drawn.

        Raises
        ------
        Error
            If this kind of figure cannot be drawn of the run.
        """
        from ._page import draw

        return draw(self._page(kind, x, y, at), ax)

    def figure(self, kind: str, file: str | os.PathLike[str], *, x: str = "", y: Sequence[str] = (),
               at: Sequence[float] = ()) -> None:
        """Draws a figure with gnuplot into a file, like `hamflow plot`.

        Parameters
        ----------
        kind, x, y, at
            As for plot().
        file : path
            Its suffix selects the format: .svg, .pdf or .png.

        Raises
        ------
        Error, FileError
        """
        more = (x, [y] if isinstance(y, str) else list(y), [float(time) for time in at])
        if self.folder is not None:
            _core.draw(self.folder, kind, os.fspath(file), *more)
            return
        with tempfile.TemporaryDirectory() as place:
            _core.draw(self.save(Path(place) / "a.run"), kind, os.fspath(file), *more)

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Writes a folder like `hamflow run`: copies the folder of the run, or repeats a run that has none.

        Raises
        ------
        FileError
            If the folder exists or cannot be written.
        """
        to = Path(folder)
        if os.path.lexists(to):
            raise FileError(f"{to} exists; choose another folder")
        if self.folder is not None:
            try:
                shutil.copytree(self.folder, to)
            except OSError as error:
                raise FileError(f"{to}: {error}") from error
        else:
            _core.run(self.scenario._core, to, "error", None)
        return to

    def __len__(self) -> int:
        return len(self.t)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __reduce__(self) -> tuple[Any, ...]:
        return (Run, (self.scenario, self._tables, json.dumps(self.summary), self.folder, self.t.dtype == object))

    def __repr__(self) -> str:
        worst = self.summary.get("energy", {}).get("max_relative_error")
        error = f", energy error {worst:.2g}" if isinstance(worst, float) else ""
        core = self.scenario._core
        return f"<hamflow.Run {core.problem}, {core.method}: {self.status}, {len(self.t)} samples{error}>"

    def _repr_html_(self) -> str:
        rows = [("status", self.status), ("problem", self.summary.get("problem", "")),
                ("method", self.summary.get("method", "")), ("steps", self.summary.get("steps", "")),
                ("energy error", self.summary.get("energy", {}).get("max_relative_error", "")),
                ("drift", getattr(self.certificate, "drift", ""))]
        return _html.facts(rows) + self._first_figure()

    def _first_figure(self) -> str:
        """Returns the first figure of the scenario, or the default one, as SVG; empty if nothing can be drawn."""
        from ._page import svg

        try:
            return svg(self._page((self.scenario._core.figures or [""])[0]))
        except (Error, FileError):
            return ""


def _progress(asked: bool | Progress | None, total: int) -> Callable[[int], None] | None:
    """Returns the function that shows the number of steps taken, or None.

    By default, a terminal or a notebook shows a line once the work has taken 2 s.
    """
    if asked is None:
        asked = sys.stderr is not None and sys.stderr.isatty() or "ipykernel" in sys.modules
    if asked is False:
        return None
    if callable(asked):
        told = asked

        def tell(steps: int) -> None:
            told(min(steps, total), total)

        return tell
    begin = time.monotonic()
    bars: list[Callable[[int], None]] = []

    def line(steps: int) -> None:
        if time.monotonic() - begin > 2:
            if not bars:
                bars.append(_bar(total))
            bars[0](steps)

    return line


def _bar(total: int) -> Callable[[int], None]:
    """Returns a function that updates a bar of tqdm if it is installed, else a line on stderr."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        def percent(steps: int) -> None:
            if sys.stderr is not None:
                print(f"\r{100 * steps / max(total, 1):5.1f} %", end="", file=sys.stderr, flush=True)

        return percent
    bar = tqdm(total=total)

    def update(steps: int) -> None:
        bar.update(steps - bar.n)

    return update


def progress_of_both(asked: bool | Progress | None) -> Progress | None:
    """Like _progress(), for work whose total is known only at the first call."""
    if callable(asked):
        return asked
    if asked is False:
        return None
    told: list[Callable[[int], None] | None] = []

    def of_both(steps: int, total: int) -> None:
        if not told:
            told.append(_progress(asked, total))
        if told[0] is not None:
            told[0](steps)

    return of_both


def run(scenario: Any, /, *, out: str | os.PathLike[str] | None = None, existing: str = "error",
        progress: bool | Progress | None = None, certificate: bool = True, digits: bool = False) -> Run:
    """Runs a scenario.

    Parameters
    ----------
    scenario : Scenario, dict of tables, or name of a TOML file
    out : path, optional
        Output directory, as for the command. Default: nothing is written.
    existing : "error", "replace" or "resume"
        What to do if the output directory exists. "resume" continues from its last checkpoint, bit for bit, or starts
        at step 0 if there is no checkpoint.
    progress : bool or callable(done, total), optional
        Whether to show progress, or a function that is called with the number of steps taken and of all steps.
        Default: show it on a terminal or in a notebook, if the run takes longer than 2 s.
    certificate : bool
        Whether to make a certificate. It takes at most a second, or a tenth of the time of the run.
    digits : bool
        Whether t, q, p, energy are arrays of decimal.Decimal with all digits. Only allowed in arithmetic with more
        digits than double.

    Returns
    -------
    Run

    Raises
    ------
    Rejection
        If the scenario is wrong. It lists all errors, and is raised before anything runs.
    FileError
        If a file or folder cannot be read or written.
    StepFailed
        If a step fails. Its attribute `partial` is the run up to the last good step.
    KeyboardInterrupt
        Its attribute `partial` is the run up to the interrupt. If `out` is given, existing="resume" continues it.

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4", run={"dt": 0.1, "steps": 1000})
    >>> run = hf.run(s)
    >>> run.q.shape, run.status
    ((1001, 1), 'done')
    """
    wanted = scenario_of(scenario)
    if not certificate:
        wanted = Scenario.from_text(str(wanted), wanted._name)
        wanted.set("run.certificate", False)
    if digits and wanted._core.arithmetic in ("double", "compensated", "lattice"):
        raise Error(f"digits: found True in {wanted._core.arithmetic} arithmetic, whose numbers are doubles; allowed with "
                    "run.arithmetic = \"double-double\", \"quad\" or \"mp(d)\"")
    if out is None and existing != "error":
        raise Error(f"existing: found {shown(existing)} without out=; allowed with a folder")
    folder = None if out is None else Path(out)
    tell = _progress(progress, wanted.steps)
    found = _core.run(wanted._core, folder if folder is not None else "", existing, tell)
    if folder is not None:
        opened = _core.open_run(folder) if (folder / "run.h5").exists() else found
        result = Run(wanted, opened["tables"], found["json"], folder, digits, found["notes"])
    else:
        result = Run(wanted, found["tables"], found["json"], None, digits, found["notes"])
    if found["interrupted"] is not None:
        raise stopped(found["interrupted"], result)
    if tell is not None:
        tell(int(result.summary.get("steps", 0)))
    if found["file_trouble"]:
        raise stopped(FileError(found["file_trouble"]), result)
    if result.status == "failed":
        why = result.summary.get("error", {})
        raise stopped(StepFailed(found["message"], why.get("kind", ""), why.get("step", 0) - 1, why.get("t", 0.0), found["hint"]),
                      result)
    return result


def open(run: str | os.PathLike[str], /, *, digits: bool = False) -> Run:  # noqa: A001
    """Opens a finished, running or interrupted run.

    Parameters
    ----------
    run : path
        The folder of the run, or its run.h5.
    digits : bool
        Whether t, q, p, energy are arrays of decimal.Decimal with all digits. Only allowed in arithmetic with more
        digits than double.

    Returns
    -------
    Run

    Raises
    ------
    FileError
        If the run cannot be read.
    Error
        With digits=True, if the run has no more digits than double.
    """
    path = Path(run)
    found = _core.open_run(path)
    scenario = Scenario.__new__(Scenario)
    scenario._core, scenario._name = found["scenario"], str(path)
    return Run(scenario, found["tables"], found["json"], path if path.is_dir() else path.parent, digits)


class Reversal:
    """The result of reverse().

    Attributes
    ----------
    status : str
    bit_exact : bool
        Whether the reversal ends at the start, bit for bit.
    distance : float or None
        The distance from the start; None if the reversal did not finish.
    summary : dict
        The summary that `hamflow reverse --json` prints.
    """

    def __init__(self, text: str) -> None:
        self.summary: dict[str, Any] = json.loads(text)
        self.status: str = self.summary["status"]
        self.bit_exact: bool = bool(self.summary.get("bit_exact"))
        self.distance: Any = self.summary.get("distance")

    def __repr__(self) -> str:
        return f"<hamflow.Reversal {self.status}, bit_exact = {self.bit_exact}, distance = {self.distance}>"


def reverse(scenario: Any, /) -> Reversal:
    """Tests time reversibility: integrates forward, reverses the momenta, integrates back.

    Parameters
    ----------
    scenario : Scenario, dict of tables, or name of a TOML file

    Returns
    -------
    Reversal

    Raises
    ------
    Rejection
        If the scenario is wrong.
    KeyboardInterrupt

    Examples
    --------
    >>> import hamflow as hf
    >>> s = hf.Scenario(problem=hf.Problem("pendulum").at(q=[1], p=[0]), method="stv4",
    ...                 run={"dt": 0.1, "steps": 100, "arithmetic": "lattice"})
    >>> hf.reverse(s).bit_exact
    True
    """
    return Reversal(_core.reverse(scenario_of(scenario)._core)[0])

"""The laboratory: a page in which the integrators run, with a scenario, a run or a sweep in it."""

from __future__ import annotations

import base64
import html
import json
import os
import sys
import tempfile
import webbrowser
from pathlib import Path
from typing import Any

import numpy as np

from ._errors import FileError
from ._run import Run
from ._scenario import scenario_of
from ._sweep import Sweep

_PLACE = "<!--inlined-->"  # in laboratory.html, where the data go
_MOST_NUMBERS = 15_000_000 // 8  # 20 MB as base64


class View:
    """A page that was written. A notebook shows it.

    Attributes
    ----------
    file : Path
        The page, one HTML file.
    note : str
        What was left out of the page; empty if nothing was.
    """

    def __init__(self, file: Path, note: str) -> None:
        self.file, self.note = file, note

    def __repr__(self) -> str:
        return f"<hamflow.View: {self.file}{', ' + self.note if self.note else ''}>"

    def _repr_html_(self) -> str:
        page = html.escape(self.file.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{page}" title="hamflow laboratory" style="width: 100%; height: 900px; border: 0"></iframe>'


def view(what: Any = None, /, *, out: str | os.PathLike[str] | None = None, browser: bool | None = None) -> View:
    """Writes the laboratory as one HTML file, and opens it.

    Parameters
    ----------
    what : Run, Sweep, Scenario, dict of tables, or name of a TOML file, optional
        What the page shows first. The samples of a run, or the columns of a sweep, are stored in the page; of more than
        20 MB only every n-th row. Default: the laboratory alone.
    out : path, optional
        The file to write. Default: a file in a new temporary folder.
    browser : bool, optional
        Whether to open the page in a browser. Default: yes, except in a notebook, which shows the returned value.

    Returns
    -------
    View
        With the attribute `file`.

    Raises
    ------
    FileError
        If the laboratory is neither installed nor built, or the file cannot be written.
    """
    page = laboratory().read_text(encoding="utf-8")
    data = None if what is None else _inlined(what)
    if data is not None:
        # A script element ends at "</script", wherever that stands.
        text = json.dumps(data).replace("<", "\\u003c")
        page = page.replace(_PLACE, f'<script type="application/json" id="inlined">{text}</script>', 1)
    file = Path(tempfile.mkdtemp(prefix="hamflow-")) / "laboratory.html" if out is None else Path(out)
    try:
        file.write_text(page, encoding="utf-8")
    except OSError as error:
        raise FileError(f"cannot write {file}: {error.strerror}") from None
    if browser if browser is not None else not _in_notebook():
        webbrowser.open(file.resolve().as_uri())
    return View(file, data["note"] if data else "")


def laboratory() -> Path:
    """Returns the page that is installed with this module, or built beside it."""
    for folder in [*Path(__file__).resolve().parents, Path(sys.prefix)]:
        for place in ("share/hamflow/laboratory.html", "web/laboratory.html"):
            if (folder / place).is_file():
                return folder / place
    raise FileError("the laboratory is neither installed in share/hamflow nor built; to build it, run ./dev web in the "
                    "sources of hamflow")


def _in_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


def _inlined(what: Any) -> dict[str, Any]:
    if isinstance(what, Run):
        names = ["t", *what.scenario.coordinates, *what.scenario.momenta]
        columns = {name: np.asarray(what[name], dtype=float) for name in names}
        energy = np.asarray(what.energy, dtype=float)
        columns["energy error"] = energy - energy[:1]
        columns.update({name: values for name, values in {**what.invariants, **what.observables}.items() if values.ndim == 1})
        name = what.folder.name if what.folder is not None else "run"
        return _data("run", name, str(what.scenario), columns)
    if isinstance(what, Sweep):
        columns = {}
        for name in what.columns:
            values = np.asarray(what[name])
            if values.dtype.kind not in "fiu" or len(values) != len(what):
                continue
            parts = values.reshape(len(values), -1).astype(float)
            for k in range(parts.shape[1]):
                columns[name if values.ndim == 1 else f"{name}[{k}]"] = parts[:, k]
        return _data("sweep", "sweep", str(what.scenario), columns)
    scenario = scenario_of(what)
    return _data("scenario", "scenario", str(scenario), {})


def _data(kind: str, name: str, toml: str, columns: dict[str, Any]) -> dict[str, Any]:
    rows = np.column_stack(list(columns.values())) if columns else np.empty((0, 0))
    every = max(1, -(-rows.size // _MOST_NUMBERS))
    kept = np.ascontiguousarray(rows[::every], dtype="<f8")
    return {"kind": kind, "name": name, "toml": toml, "columns": list(columns),
            "rows": base64.b64encode(kept.tobytes()).decode("ascii"),
            "note": "" if every == 1 else f"one of every {every} is in this file"}

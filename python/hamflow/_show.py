"""Descriptions and citations of what the catalogue contains."""

from __future__ import annotations

import html
import os

from . import _core, _html
from ._run import Run
from ._scenario import Scenario


class Shown:
    """The result of show(). A notebook shows it with H typeset.

    Attributes
    ----------
    name : str
    text : str
        The text that `hamflow show` prints.
    formulas : list of str
        H as LaTeX; empty except for problems and scenarios.
    """

    def __init__(self, name: str, text: str, formulas: list[str]) -> None:
        self.name, self.text, self.formulas = name, text, formulas

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        lines = [line.strip() for line in self.text.splitlines()]
        return f"<hamflow.Shown {self.name}: {lines[1] if len(lines) > 1 else lines[0]}>"

    def _repr_html_(self) -> str:
        return "".join(f"<p>{_html.typeset(each)}</p>" for each in self.formulas) + f"<pre>{html.escape(self.text)}</pre>"


def show(name: str | os.PathLike[str] | Scenario, /) -> Shown:
    """Describes a method, a problem, a kind of figure, the keys of a table ("run", "output"), or a scenario.

    Parameters
    ----------
    name : str, Scenario, or name of a TOML file
        For example "cg", "cg(1,5)", "central-force", "energy-error".

    Returns
    -------
    Shown

    Raises
    ------
    Error
        If nothing has this name; the message proposes the nearest name.

    Examples
    --------
    >>> import hamflow as hf
    >>> hf.show("stv4").text.splitlines()[0]
    'stv4'
    """
    if isinstance(name, Scenario):
        return Shown("scenario", *_core.show_scenario(name._core))
    typed = os.fspath(name)
    if typed.endswith(".toml"):
        return Shown(typed, *_core.show_scenario(Scenario.load(typed)._core))
    return Shown(typed, *_core.show(typed))


def cite(cited: str | os.PathLike[str] | Scenario | Run, /) -> str:
    """Returns the works behind a method, a problem, a scenario or a run, as BibTeX.

    Parameters
    ----------
    cited : str, Scenario, Run, or name of a TOML file
        For example "kahan-li8", "cg(2,6)", "henon-heiles", or the result of `run` or `open`.

    Returns
    -------
    str
        One entry for hamflow, then one for each work.

    Raises
    ------
    Error
        If nothing has this name; the message proposes the nearest name.

    Examples
    --------
    >>> import hamflow as hf
    >>> [line for line in hf.cite("verlet").splitlines() if line.startswith("@")][0]
    '@software{hamflow,'
    """
    if isinstance(cited, Run):
        return _core.cite_scenario(cited.scenario._core)
    if isinstance(cited, Scenario):
        return _core.cite_scenario(cited._core)
    typed = os.fspath(cited)
    if typed.endswith(".toml"):
        return _core.cite_scenario(Scenario.load(typed)._core)
    return _core.cite(typed)

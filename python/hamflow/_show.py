"""The catalogue as text."""

from __future__ import annotations

import html
import os

from . import _core, _html
from ._scenario import Scenario


class Shown:
    """A description: `text`, as `hamflow show` prints it, and for a problem `formulas`, H as LaTeX."""

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
        Such as "cg", "cg(1,5)", "central-force", "energy-error".

    Returns
    -------
    Shown
        Its `text` is that of the command; a notebook shows it with H typeset.

    Raises
    ------
    Error
        Where nothing has that name; the message proposes the nearest.

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

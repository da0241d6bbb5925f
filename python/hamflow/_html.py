"""HTML for notebooks: tables and typeset formulas."""

from __future__ import annotations

import html
from typing import Any, Iterable, Sequence

from . import _core


def text(value: Any) -> str:
    """Returns the text of a table cell; floats have 6 digits."""
    return html.escape(f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value))


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Returns a table with a heading for each column."""
    headings = "".join(f"<th>{text(name)}</th>" for name in head)
    lines = "".join("<tr>" + "".join(f"<td>{text(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table><tr>{headings}</tr>{lines}</table>"


def facts(rows: Iterable[tuple[str, Any]]) -> str:
    """Returns a table with one line for each name and value."""
    lines = "".join(f"<tr><th>{text(name)}</th><td>{text(value)}</td></tr>" for name, value in rows)
    return f"<table>{lines}</table>"


def formula(typed: str) -> str:
    """Returns a formula as LaTeX between dollar signs. A formula that is too long to typeset stays as it was typed."""
    tex = _core.tex(typed)
    return typeset(tex) if tex else f"<code>{html.escape(typed)}</code>"


def typeset(tex: str) -> str:
    """Returns LaTeX between dollar signs."""
    return f"${html.escape(tex)}$"

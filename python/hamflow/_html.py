"""HTML for notebooks: tables and typeset formulas."""

from __future__ import annotations

import html
from typing import Any, Iterable, Sequence

from . import _core


def text(value: Any) -> str:
    """A value of a table: floats to 6 digits."""
    return html.escape(f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value))


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table with a heading for each column."""
    headings = "".join(f"<th>{text(name)}</th>" for name in head)
    lines = "".join("<tr>" + "".join(f"<td>{text(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table><tr>{headings}</tr>{lines}</table>"


def facts(rows: Iterable[tuple[str, Any]]) -> str:
    """A table of names and values, a line each."""
    lines = "".join(f"<tr><th>{text(name)}</th><td>{text(value)}</td></tr>" for name, value in rows)
    return f"<table>{lines}</table>"


def formula(typed: str) -> str:
    """A formula as LaTeX between dollar signs; a very long one as it was typed."""
    tex = _core.tex(typed)
    return typeset(tex) if tex else f"<code>{html.escape(typed)}</code>"


def typeset(tex: str) -> str:
    """LaTeX between dollar signs."""
    return f"${html.escape(tex)}$"

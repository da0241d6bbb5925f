"""Figures of hamflow on matplotlib axes. C++ computes the contents of a figure; this file draws it."""

from __future__ import annotations

import re
from typing import Any, Mapping

import numpy as np

from ._errors import Error

_MARKERS = {1: "+", 4: "s", 5: "s", 6: "o", 7: "o", 8: "^", 9: "^", 10: "v", 11: "v", 12: "D", 13: "D", 14: "p", 15: "p"}
_RINGS = (4, 6, 8, 10, 12, 14)
_DASHES = {1: "-", 2: "--", 3: ":", 4: "-."}
# A symbol in italics or a word, with its indices and powers.
_SYMBOL = re.compile(r"\{/:Italic ([^{}]*)\}((?:[_^](?:\{[^{}]*\}|[^\\]))*)|(\w+)((?:(?<!\\)[_^](?:\{[^{}]*\}|[^\\]))+)")


def label(enhanced: str) -> str:
    """Translates a label from gnuplot's notation for indices and italics to matplotlib's."""
    def typeset(found: re.Match[str]) -> str:
        letter, indices = (found[1], found[2]) if found[1] is not None else (rf"\mathrm{{{found[3]}}}", found[4])
        return f"${letter}{indices}$".replace("−", "-")

    parts, at = [], 0
    for found in _SYMBOL.finditer(enhanced):
        parts += [enhanced[at:found.start()].replace("$", r"\$"), typeset(found)]
        at = found.end()
    return re.sub(r"\\([\\{}^_@&~])", r"\1", "".join(parts) + enhanced[at:].replace("$", r"\$"))


def draw(page: Mapping[str, Any], ax: Any = None) -> Any:
    """Draws the panels of a page.

    Parameters
    ----------
    page : dict
        The page from C++ (python/src/pages.cpp).
    ax : matplotlib axes, or an array of them, optional
        One for each panel. Single axes show the first panel. Default: new axes of pyplot.

    Returns
    -------
    The axes; an array of them if more than one panel is drawn.
    """
    panels = page["panels"]
    if ax is None:
        import matplotlib.pyplot as plt

        axes = _axes_in(plt.figure(layout="constrained"), page)
    else:
        axes = np.ravel(np.asarray(ax, dtype=object))
        if len(axes) != 1 and len(axes) < len(panels):
            raise Error(f"ax: found {len(axes)} axes; allowed one, or {len(panels)}, one for each panel")
    for each in axes:
        require_axes(each)
    for panel, each in zip(panels, axes):
        _panel(panel, each)
    _legend(page, axes)
    return axes[0] if len(axes) == 1 else axes


def require_axes(ax: Any) -> None:
    """Raises TypeError if these are not axes of matplotlib."""
    if not hasattr(ax, "set_xlabel"):
        raise TypeError(f"ax: found {type(ax).__name__}; allowed axes of matplotlib")


def svg(page: Mapping[str, Any]) -> str:
    """Returns the page as SVG, or an empty text if matplotlib is not installed."""
    try:
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    from io import StringIO

    figure = Figure(layout="constrained")
    FigureCanvasSVG(figure)
    draw(page, _axes_in(figure, page))
    text = StringIO()
    figure.savefig(text, format="svg")
    return text.getvalue()[text.getvalue().index("<svg"):]


def _axes_in(figure: Any, page: Mapping[str, Any]) -> Any:
    count = len(page["panels"])
    columns = min(page["columns"], count)
    rows = -(-count // columns)
    width = 6.0 if columns == 1 else 10.0
    heights = [0.8 + width / columns * min(float(page["panels"][row * columns]["aspect"]), 1.2) for row in range(rows)]
    figure.set_size_inches(width, sum(heights))
    return np.array([figure.add_subplot(rows, columns, i + 1) for i in range(count)], dtype=object)


def _panel(panel: Mapping[str, Any], ax: Any) -> None:
    for series in panel["series"]:
        _series(panel, series, ax)
    for name in ("x", "y"):
        axis = panel[name]
        low, high = _limits(axis)
        getattr(ax, f"set_{name}label")(label(panel[f"{name}_label"]))
        if axis["logarithmic"]:
            getattr(ax, f"set_{name}scale")("log")
        getattr(ax, f"set_{name}lim")(low, high)
        if axis["words"]:
            getattr(ax, f"set_{name}ticks")(range(len(axis["words"])), [label(word) for word in axis["words"]])
    if panel["equal_axes"]:
        ax.set_aspect("equal", "datalim")
    if panel["note"]:
        ax.set_title(label(panel["note"]), loc="right", fontsize="small")
    if any(series["name"] for series in panel["series"]):
        ax.legend(fontsize="small")


def _limits(axis: Mapping[str, Any]) -> tuple[float, float]:
    if axis["logarithmic"]:
        return 10.0 ** axis["low"], 10.0 ** axis["high"]
    return axis["low"] * 10.0 ** axis["exponent"], axis["high"] * 10.0 ** axis["exponent"]


def _style(mark: Mapping[str, Any]) -> dict[str, Any]:
    hollow = {"markerfacecolor": "none"} if mark["shape"] in _RINGS else {}
    return {"color": mark["colour"], "marker": _MARKERS.get(mark["shape"], "o"), "markersize": 4} | hollow


def _series(panel: Mapping[str, Any], series: Mapping[str, Any], ax: Any) -> None:
    ink, x, y, value, mark = series["ink"], series["x"], series["y"], series["value"], series["mark"]
    more: dict[str, Any] = {"label": label(series["name"])} if series["name"] else {}
    more |= {"alpha": series["opacity"]} if series["opacity"] < 1 else {}
    dash = _DASHES.get(mark["dash"], "-")
    if ink == "line":
        ax.plot(x, y, dash, color=mark["colour"], linewidth=1, **more)
    elif ink == "level":
        ax.plot(x, y, "--", color=mark["colour"], linewidth=1, **more)
    elif ink == "dots":
        ax.plot(x, y, ".", color=mark["colour"], markersize=2, **more)
    elif ink == "centre":
        ax.plot(x, y, "+", color=mark["colour"], **more)
    elif ink == "marks":
        ax.plot(x, y, linestyle="none", **_style(mark), **more)
    elif ink == "marked":
        ax.plot(x, y, linestyle=dash, linewidth=1, **_style(mark), **more)
    elif ink == "band":
        ax.fill_between(x, y, value, color=mark["colour"], alpha=0.4, **{k: v for k, v in more.items() if k != "alpha"})
        ax.plot(x, y, color=mark["colour"], linewidth=0.5)
        ax.plot(x, value, color=mark["colour"], linewidth=0.5)
    elif ink == "bars":
        ax.errorbar(x, y, yerr=value, linestyle="none", linewidth=1, **_style(mark), **more)
    else:
        _fields(panel, x, y, value, ax)


def _fields(panel: Mapping[str, Any], x: Any, y: Any, value: Any, ax: Any) -> None:
    """Draws coloured rectangles. x and y alternate between lower left and upper right corners."""
    from matplotlib.collections import PatchCollection
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.patches import Rectangle

    boxes = [Rectangle((a, b), c - a, d - b) for a, b, c, d in zip(x[::2], y[::2], x[1::2], y[1::2])]
    norm = (LogNorm if panel["z"]["logarithmic"] else Normalize)(*_limits(panel["z"]))
    drawn = ax.add_collection(PatchCollection(boxes, norm=norm, cmap="viridis"))
    drawn.set_array(value)
    ax.figure.colorbar(drawn, ax=ax, label=label(panel["z_label"]))


def _legend(page: Mapping[str, Any], axes: Any) -> None:
    """Draws the legend of all panels: in an empty place after the last panel, else in the first panel."""
    from matplotlib.lines import Line2D

    if not page["legend"]:
        return
    handles = [Line2D([], [], linestyle="none") if heading else Line2D([], [], **_style(mark))
               for heading, _, mark in page["legend"]]
    has_room = len(axes) > 1 and len(axes) % page["columns"] != 0
    (axes[0].figure if has_room else axes[0]).legend(
        handles, [label(name) for _, name, _ in page["legend"]], fontsize="small", loc="lower right" if has_room else "best")

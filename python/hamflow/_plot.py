"""Figures of runs on matplotlib axes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import Error

KINDS = ("orbit", "phase", "time", "energy-error", "section")


def draw(run: Any, kind: str, ax: Any) -> Any:
    """Draws one of KINDS of a Run; new axes without `ax`."""
    if kind not in KINDS:
        raise Error(f"kind: found {kind!r}; allowed {', '.join(KINDS)}; Run.figure draws all kinds of the command")
    if ax is None:
        import matplotlib.pyplot as plt

        _, ax = plt.subplots()
    q, p = run.scenario.coordinates, run.scenario.momenta
    if kind == "orbit":
        if len(q) < 2:
            raise Error("kind: found 'orbit' of one coordinate; allowed 'phase', 'time', 'energy-error'")
        if q[:2] == ["r", "phi"]:
            ax.plot(run["r"] * np.cos(run["phi"]), run["r"] * np.sin(run["phi"]))
        else:
            for i in range(0, len(q) - len(q) % 2, 2) if run.summary.get("problem") in ("n-body", "solar-system") else (0,):
                ax.plot(run.q[:, i], run.q[:, i + 1])
            ax.set(xlabel=q[0], ylabel=q[1])
        ax.set_aspect("equal", "datalim")
    elif kind == "phase":
        ax.plot(run.q[:, 0], run.p[:, 0])
        ax.set(xlabel=q[0], ylabel=p[0])
    elif kind == "time":
        for i, name in enumerate(q):
            ax.plot(run.t, run.q[:, i], label=name)
        ax.set(xlabel="t")
        ax.legend()
    elif kind == "energy-error":
        scale = run.summary.get("energy", {}).get("scale") or 1.0
        ax.plot(run.t, (run.energy - run.energy[0]) / scale)
        ax.set(xlabel="t", ylabel="energy error / scale")
    else:
        points = run.section
        if points is None:
            raise Error("kind: found 'section' of a run without run.section")
        shown = min(1, len(q) - 1)
        ax.plot(points.q[:, shown], points.p[:, shown], ".", markersize=2)
        ax.set(xlabel=q[shown], ylabel=p[shown])
    return ax

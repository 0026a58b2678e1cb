"""Figures, drawn by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import pandas as pd

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._record import Record
    from ._run import Run
    from ._study import Fragility, Study

#: Least number of records of which fractiles are drawn.
LEAST_RECORDS = 3

#: |θ|/α beyond which angles are not drawn: a falling block would hide the rocking.
DRAWN = 1.2


def plain(words: str) -> str:
    """A text as it is: a dollar sign begins no formula."""
    return words.replace("$", r"\$")


def record(drawn: "Record", ax: "Axes | None" = None) -> "Axes":
    ax = plt.subplots(figsize=(8, 2.5), layout="constrained")[1] if ax is None else ax
    ax.plot(drawn.t, drawn.accel, lw=0.8)
    ax.set(xlabel="t [s]", ylabel="a [m/s²]", title=plain(drawn.name) or None)
    return ax


def run(drawn: "Run", axes: Any = None) -> "npt.NDArray[Any]":
    if axes is None:
        axes = plt.subplots(2, 1, sharex=True, figsize=(8, 5), height_ratios=[1, 2.5], layout="constrained")[1]
    if np.shape(axes) != (2,):
        raise ValueError("axes are those of the ground and of the angles; give two, such as plt.subplots(2, 1)[1]")
    above, below = axes
    # A single row is a point.
    marker = "." if len(drawn.t) == 1 else None
    for column, name in enumerate(("horizontal", "vertical")):
        if np.any(drawn.ground[:, column]):
            above.plot(drawn.t, drawn.ground[:, column], lw=0.8, marker=marker, label=name)
    above.set(ylabel="ground [m/s²]")
    if len(above.lines) > 1:
        above.legend(frameon=False)
    # A stack that does not stand by itself has no slenderness to measure angles by.
    stands = (np.asarray(drawn.alpha) > 0).all()
    shares, most = (drawn.theta / drawn.alpha, DRAWN) if stands else (np.degrees(drawn.theta), 90.0)
    for block in range(shares.shape[1]):
        below.plot(drawn.t, shares[:, block], lw=1, marker=marker, label=f"block {block + 1}")
    times = drawn.events["t"][drawn.events["kind"].isin(["impact", "landing"])]
    below.plot(times, np.full(len(times), 0.02), "|", color="0.5", ms=6, transform=below.get_xaxis_transform(), label="impacts")
    low, high = np.clip([shares.min(), shares.max()], -most, most)
    room = 0.08 * (high - low or 1.0)
    below.set(xlabel="t [s]", ylabel="θ / α" if stands else "θ [°]", ylim=(low - 2 * room, high + room))
    below.set(xlim=(drawn.t[0], drawn.t[-1]) if marker is None else (0.0, drawn.t_final or 1.0))
    below.legend(frameon=False, ncols=min(shares.shape[1] + 1, 6), loc="upper right", fontsize="small")
    above.set_title(plain(drawn.scene.title) or f"{drawn._lead}{drawn.outcome}, {drawn.impacts} impact(s)", fontsize="medium")
    return np.array([above, below])


def study(drawn: "Study", ax: "Axes | None" = None) -> "Axes":
    ax = plt.subplots(figsize=(6, 5), layout="constrained")[1] if ax is None else ax
    runs = drawn._runs()
    stripes = drawn._stripes(runs)
    labels, levels, outcomes, peaks = runs.records, runs.levels, runs.outcomes, runs.peaks
    demand = np.fmax.reduce(peaks, axis=1) if peaks.shape[1] else np.full(len(levels), np.nan)
    # Runs that failed or are not determined have no answer, as in the figure of the command line.
    undecided = np.array([outcome in (None, "error", "undetermined", "not-determined") for outcome in outcomes], dtype=bool)
    if runs.trust is not None:
        undecided |= np.array([trust == "not-determined" for trust in runs.trust], dtype=bool)
    demand = np.where(undecided, np.nan, demand)
    lost = np.isin(np.array(outcomes, dtype=object), ["overturns", "collapses"])
    # Peaks of a stack that does not stand by itself are infinite.
    right = max(1.0, float(np.nanmax(np.where(lost | ~np.isfinite(demand), np.nan, demand), initial=0.0))) * 1.1
    demand = np.where(lost, right, np.minimum(demand, right))
    sizes = np.array(levels)
    for places in pd.Series(labels).groupby(labels, sort=False).indices.values():
        own = np.asarray(places)[np.argsort(sizes[places])]
        ax.plot(demand[own], sizes[own], lw=0.8, color="0.7", marker=".", ms=3)
    has_fractiles = len(set(labels)) >= LEAST_RECORDS
    decided = (stripes.runs - stripes.errors - stripes.undetermined - stripes.not_determined).to_numpy()
    for share, style in ((16, ":"), (50, "-"), (84, "--")) if has_fractiles else ():
        # Of one run or two, all fractiles are the same few values.
        fractile = np.where(decided >= LEAST_RECORDS, stripes[f"peak_{share}"].to_numpy(), np.nan)
        fractile = np.where(np.isfinite(fractile), np.minimum(fractile, right), np.nan)
        ax.plot(fractile, stripes[drawn.measure], style, color="C0", lw=1.6, label=f"{share} %")
    ax.axvline(right, color="0.4", lw=0.8)
    ax.annotate("lost", (right, 1.01), xycoords=("data", "axes fraction"), ha="right", fontsize="small")
    ax.set(xlabel="largest |θ| / α", ylabel=plain(drawn.label), xlim=(0, right * 1.02), ylim=(0, None))
    if has_fractiles:
        ax.legend(frameon=False, title="fractile")
    return ax


def fragility(drawn: "Fragility", ax: "Axes | None" = None, **style: Any) -> "Axes":
    ax = plt.subplots(figsize=(6, 4), layout="constrained")[1] if ax is None else ax
    counts = drawn.counts
    known = counts[counts.runs > 0]
    color = style.pop("color", style.pop("c", None))
    color = ax._get_lines.get_next_color() if color is None else color  # type: ignore[attr-defined]
    label = style.pop("label", drawn.state)
    ax.plot(known.level, known.share, "o", ms=4, mfc="none", color=color, label=f"{label}: no curve" if drawn.median is None else None)
    if drawn.median is not None and len(known):
        levels = np.geomspace(known.level.min(), known.level.max(), 200)
        ax.plot(levels, drawn.probability(levels), color=color, label=f"{label}: median {drawn.median:.3g}, dispersion {drawn.dispersion:.2g}", **style)
        if drawn.bands and drawn.bands["levels"]:
            low, high = np.array(drawn.bands["probability"]).T
            ax.fill_between(drawn.bands["levels"], low, high, color=color, alpha=0.15, lw=0)
    ax.set(xlabel=plain(drawn.label), ylabel="probability", ylim=(-0.02, 1.02))
    ax.legend(frameon=False, fontsize="small")
    return ax

"""Time and failed missions against the share of fallible robots."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from .. import reference
from ..statistics import quantile
from . import style

LOOKS = {"40": (style.OURS, "o", -0.008), "80": (style.OTHER, "s", 0.008)}
"""Colour, marker, and offset of each swarm: markers are slightly apart, as in the paper."""
NEVER = float("inf")
Curve = dict[str, Any]


def draw_time(curves: dict[str, Curve], path: Path) -> None:
    """Least, median and most steps, the paper's two numbers, and an arrow where trials did not complete."""
    figure, axes = style.axes()
    limit = 0
    for robots, curve in curves.items():
        colour, marker, offset = LOOKS[robots]
        limit = max(point["limit"] for point in curve.values())
        shares = [float(share) + offset for share in curve]
        spreads = [spread(point) for point in curve.values()]
        for x, (low, _, high) in zip(shares, spreads, strict=True):
            bar(axes, x, low, min(high, limit), censored=high > limit, colour=colour)
        middle = [median if median <= limit else math.nan for _, median, _ in spreads]
        axes.plot(shares, middle, color=colour, marker=marker, markersize=5, linewidth=1.2, label=f"{robots} robots")
    points = [(float(share) + LOOKS[robots][2], steps) for (robots, share), steps in reference.faults().items()]
    axes.plot([x for x, _ in points], [y for _, y in points], **style.PAPER, label="paper, medians at 0.7")
    axes.axhline(limit, color=style.GREY, linewidth=0.8, linestyle=":")
    axes.text(0.0, limit, "given up", fontsize=7, color=style.GREY, ha="center", va="bottom")
    axes.set(xlabel="share of fallible robots", ylabel="control steps to completion", ylim=(0, limit * 1.09))
    axes.set_xticks([share / 10 for share in range(10)])
    axes.legend(loc="lower right")  # No mission takes less than 1,000 steps.
    style.save(figure, path)


def spread(point: Curve) -> tuple[float, float, float]:
    """Least, median and most steps; a trial that did not complete would have taken longer than any limit."""
    steps = [NEVER if step is None else step for step in point["steps"]]
    return min(steps), quantile(steps, 0.5), max(steps)


def bar(axes: Axes, x: float, low: float, high: float, *, censored: bool, colour: str) -> None:
    """A bar with caps; an arrow head instead of the upper cap where trials were given up."""
    if low > high:
        return
    axes.plot([x, x], [low, high], color=colour, linewidth=0.9)
    axes.plot([x], [low], color=colour, marker="_", markersize=6)
    axes.plot([x], [high], color=colour, marker="^" if censored else "_", markersize=5 if censored else 6)


def draw_failed(curves: dict[str, Curve], path: Path) -> None:
    """The share of failed missions with Wilson's intervals."""
    figure, axes = style.axes()
    for robots, curve in curves.items():
        colour, marker, offset = LOOKS[robots]
        failed_line(axes, curve, offset, colour, marker, f"{robots} robots, 95 % interval")
    axes.set(xlabel="share of fallible robots", ylabel="failed missions, %", ylim=(-3, 103))
    axes.set_xticks([share / 10 for share in range(10)])
    axes.legend(loc="upper left")
    style.save(figure, path)


def failed_line(axes: Axes, curve: Curve, offset: float, colour: str, marker: str, label: str) -> None:
    """One swarm's failed missions in per cent."""
    shares = [float(share) + offset for share in curve]
    ratios = [point["failed_ratio"] for point in curve.values()]
    values = [100 * ratio["value"] for ratio in ratios]
    below = [max(100 * (ratio["value"] - ratio["ci95"][0]), 0) for ratio in ratios]
    above = [max(100 * (ratio["ci95"][1] - ratio["value"]), 0) for ratio in ratios]
    look: style.Look = {"color": colour, "marker": marker, "markersize": 5, "linewidth": 1.2}
    axes.errorbar(shares, values, yerr=(below, above), label=label, elinewidth=0.9, capsize=2.5, **look)


def draw_sensitivity(curves: dict[str, dict[str, Curve]], path: Path) -> None:
    """Median steps and failed missions by hazard and for the harsher reading, 40 robots beside 80."""
    figure, grid = plt.subplots(2, 2, figsize=(7.2, 5.2), layout="constrained", sharex=True, sharey="row")
    for robots, (above, below) in zip(LOOKS, grid.T, strict=True):
        for number, name in enumerate(sorted(curves)):
            hazard_line(above, below, curves[name][robots], number, name.replace("Fallible", "hazard"))
        above.set_title(f"{robots} robots, 2 links", fontsize=9)
        below.set_xlabel("share of fallible robots (OnJoin: probability)")
    grid[0][0].set_ylabel("median control steps")
    grid[1][0].set(ylabel="failed missions, %", ylim=(-3, 103))
    handles, labels = grid[1][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    style.save(figure, path)


def hazard_line(above: Axes, below: Axes, curve: Curve, number: int, label: str) -> None:
    """One hazard: medians above, failed missions below; a median that half of the trials did not reach is left out."""
    shares = [float(share) + (number - 2) * 0.006 for share in curve]
    medians = [math.nan if point["median"]["value"] is None else point["median"]["value"] for point in curve.values()]
    failed = [100 * point["failed_ratio"]["value"] for point in curve.values()]
    look: style.Look = {"color": style.LINES[number], "marker": "osD^v"[number], "markersize": 4, "linewidth": 1.1}
    above.plot(shares, medians, **look)
    below.plot(shares, failed, **look, label=label)

"""Bytes a control step of a robot, from 10 to 100 robots, and the ways to count them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import ScalarFormatter

from .. import reference
from . import style

MEDIANS: style.Look = {"color": style.OURS, "linewidth": 5, "alpha": 0.6, "solid_capstyle": "butt"}
SERIES = {"with headers": (style.OURS, "o", -1.2), "payload": (style.OTHER, "s", 1.2)}


def draw(runs: dict[str, Any], path: Path) -> None:
    """Sent beside received; bars from the least to the most of any robot of any trial, a mark at the median."""
    figure, grid = plt.subplots(1, 2, figsize=(7.2, 3.7), layout="constrained", sharey=True)
    for axes, direction in zip(grid, ("sent", "received"), strict=True):
        for what, (colour, marker, offset) in SERIES.items():
            bars(axes, runs, f"{direction}, {what}", colour, marker, offset, what)
        papers(axes)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(ScalarFormatter())
        axes.set(xlabel="robots", title=f"{direction} by a robot", xticks=range(10, 101, 10))
    grid[0].set_ylabel("bytes a control step")
    grid[0].legend(loc="upper left", bbox_to_anchor=(0, 0.98))
    style.save(figure, path)


def bars(axes: Axes, runs: dict[str, Any], reading: str, colour: str, marker: str, offset: float, label: str) -> None:
    """Least, median, most by number of robots."""
    of = {int(robots) + offset: run["readings"][reading] for robots, run in runs.items()}
    low, middle, high = ([each[key] for each in of.values()] for key in ("min", "median", "max"))
    axes.vlines(list(of), low, high, color=colour, linewidth=1)
    for end in (low, high):
        axes.plot(list(of), end, color=colour, marker="_", linestyle="none", markersize=5)
    axes.plot(list(of), middle, color=colour, marker=marker, markersize=4, linewidth=1, label=label)


def papers(axes: Axes) -> None:
    """What the paper's text says: the least at 10 robots, the most at 100, about 100 as the median of all."""
    paper = reference.bandwidth()
    axes.plot([10, 100], [paper["min"], paper["max"]], **style.PAPER, label="paper: least, most")
    axes.axhline(paper["median"], color="black", linewidth=0.9, linestyle="--", label="paper: median, about")


def draw_readings(runs: dict[str, Any], path: Path) -> None:
    """A row for each reading: its least of 10 robots, its medians, its most of 100, against the paper's three lines."""
    readings = list(runs["10"]["readings"])
    figure, axes = style.axes((7.2, 4.2))
    paper = reference.bandwidth()
    for row, reading in enumerate(reversed(readings)):
        of = {robots: run["readings"][reading] for robots, run in runs.items()}
        medians = [each["median"] for each in of.values()]
        axes.plot([min(medians), max(medians)], [row, row], **MEDIANS)
        axes.plot(of["10"]["min"], row, color=style.THIRD, marker="<", linestyle="none")
        axes.plot(of["100"]["max"], row, color=style.OTHER, marker=">", linestyle="none")
    for key, colour, side in (
        ("min", style.THIRD, "center"),
        ("median", style.OURS, "right"),
        ("max", style.OTHER, "left"),
    ):
        axes.axvline(paper[key], color=colour, linewidth=1, linestyle="--", zorder=0)
        axes.text(paper[key], len(readings) - 0.4, f"{paper[key]:.0f}", color=colour, ha=side, va="bottom", fontsize=8)
    axes.set_yticks(range(len(readings)), list(reversed(readings)))
    axes.set(xscale="log", xlabel="bytes a control step of a robot", ylim=(-0.6, len(readings) - 0.4))
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.grid(visible=False)
    handles = [
        axes.plot([], [], color=style.THIRD, marker="<", linestyle="none", label="least, 10 robots")[0],
        axes.plot([], [], **MEDIANS, label="medians, 10 to 100 robots")[0],
        axes.plot([], [], color=style.OTHER, marker=">", linestyle="none", label="most, 100 robots")[0],
        axes.plot([], [], color="black", linewidth=1, linestyle="--", label="paper")[0],
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    style.save(figure, path)

"""The paper's figure 2: where the robots ended, with 20, 40, 60 and 80 of them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from . import style

LOOKS: dict[str, style.Look] = {
    "free": {"marker": "o", "color": "#6b6b6b", "markerfacecolor": "white", "markersize": 3.2},
    "networker": {"marker": "o", "color": "#0072b2", "markersize": 4},
    "worker": {"marker": "^", "color": "#d55e00", "markersize": 6},
    "root": {"marker": "s", "color": "#000000", "markersize": 5},
}
TARGET: style.Look = {"marker": "x", "color": "#c00000", "markersize": 7, "markeredgewidth": 1.4}
LINK, CHAIN = "#3fae49", "#444444"
Line = tuple[list[float], list[float]]


def draw(runs: dict[str, Any], path: Path) -> None:
    """Four arenas, and one legend for all."""
    figure, grid = plt.subplots(2, 2, figsize=(7.2, 7.7), layout="constrained")
    for letter, axes, (_, run) in zip("abcd", grid.flat, runs.items(), strict=False):
        arena(axes, run["final"])
        axes.set_title(f"({letter}) {run['robots']} robots, {style.links(run['links'])}", fontsize=9)
    figure.legend(handles=legend(), loc="outside lower center", ncols=4)
    style.save(figure, path)


def arena(axes: Axes, final: dict[str, Any]) -> None:
    """One arena from the back to the front: who hears whom, chains, targets, robots."""
    robots = final["robots"]
    axes.add_collection(LineCollection(within_range(final), colors=LINK, linewidths=0.5, alpha=0.35))
    axes.add_collection(LineCollection(chains(robots), colors=CHAIN, linewidths=1.3))
    for x, y in final["targets"]:
        axes.plot(x, y, linestyle="none", **TARGET)
    for role, look in LOOKS.items():
        places = [robot["at"] for robot in robots if robot["role"] == role]
        axes.plot([x for x, _ in places], [y for _, y in places], linestyle="none", **look)
    width, height = final["arena_m"]
    axes.set(xlim=(-width / 2, width / 2), ylim=(-height / 2, height / 2), aspect="equal")
    axes.tick_params(labelsize=7)
    axes.spines[["top", "right"]].set_visible(True)
    axes.grid(visible=False)


def within_range(final: dict[str, Any]) -> list[Line]:
    """Pairs of robots that hear each other."""
    places = [robot["at"] for robot in final["robots"]]
    pairs = ((a, b) for number, a in enumerate(places) for b in places[number + 1 :])
    return [(a, b) for a, b in pairs if math.dist(a, b) <= final["range_m"]]


def chains(robots: list[dict[str, Any]]) -> list[Line]:
    """From each robot of the backbone to the robots that it relies on."""
    return [(robot["at"], robots[parent]["at"]) for robot in robots for parent in robot["parents"]]


def legend() -> list[Line2D]:
    """What the marks are."""
    marks = [Line2D([], [], linestyle="none", label=role, **look) for role, look in LOOKS.items()]
    marks.append(Line2D([], [], linestyle="none", label="target", **TARGET))
    return [
        *marks,
        Line2D([], [], color=LINK, linewidth=1, label="within range (2 m)"),
        Line2D([], [], color=CHAIN, linewidth=1.5, label="relies on"),
    ]

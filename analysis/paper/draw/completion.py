"""Time to completion with 20, 40, 60 and 80 robots, beside the optimum."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import reference
from . import style

BOX = 0.36


def draw(runs: dict[str, Any], path: Path) -> None:
    """A box for our steps, a box for the optimum of the same trials, and the paper's median."""
    figure, axes = style.axes()
    at = range(1, len(runs) + 1)
    boxes(axes, [x - 0.21 for x in at], [completed(run["steps"]) for run in runs.values()], style.OURS, "desim")
    optima = [run["optimum"]["same_robot"] for run in runs.values()]
    boxes(axes, [x + 0.21 for x in at], optima, style.GREY, "optimum of the same trials")
    paper = reference.completion()
    axes.plot([x - 0.21 for x in at], [paper[label] for label in runs], **style.PAPER, label="paper, median")
    axes.set_xticks(list(at), [f"{run['robots']} robots\n{style.links(run['links'])}" for run in runs.values()])
    axes.set(ylabel="control steps to completion", xlim=(0.5, len(runs) + 0.5))
    axes.legend(loc="upper right")
    style.save(figure, path)


def completed(steps: list[int | None]) -> list[int]:
    """The trials that completed."""
    return [step for step in steps if step is not None]


def boxes(axes: Any, at: list[float], values: Sequence[Sequence[float]], colour: str, label: str) -> None:
    """Boxes with whiskers to the least and the greatest trial: with 35 trials nobody needs to be an outlier."""
    drawn = axes.boxplot(
        values,
        positions=at,
        widths=BOX,
        whis=(0, 100),
        manage_ticks=False,
        patch_artist=True,
        boxprops={"facecolor": "white", "edgecolor": colour},
        medianprops={"color": colour, "linewidth": 2},
        whiskerprops={"color": colour},
        capprops={"color": colour},
    )
    drawn["boxes"][0].set_label(label)

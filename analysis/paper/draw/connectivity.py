"""λ₂ over time in five configurations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.ticker import ScalarFormatter

from . import style

DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))


def draw(runs: dict[str, Any], path: Path) -> None:
    """Medians with the band of the middle four fifths of the trials, on a logarithmic scale: it falls a hundredfold."""
    figure, axes = style.axes()
    for (_, run), colour, dashes in zip(runs.items(), style.LINES, DASHES, strict=True):
        axes.fill_between(run["time_s"], run["low"], run["high"], color=colour, alpha=0.2, linewidth=0)
        label = f"{run['robots']} robots, {style.links(run['links'])}"
        axes.plot(run["time_s"], run["median"], color=colour, linestyle=dashes, linewidth=1.4, label=label)
    axes.set_yscale("log")
    axes.set_yticks([0.3, 1, 3, 10, 30])
    axes.yaxis.set_major_formatter(ScalarFormatter())
    axes.set(xlabel="simulated time, s", ylabel="algebraic connectivity λ₂", xlim=(0, None))
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], loc="upper right")
    style.save(figure, path)

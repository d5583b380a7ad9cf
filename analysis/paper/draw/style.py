"""How every figure looks: readable at the width of a column, told apart without colour, the same bytes each time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLUMN = (5.6, 3.6)
"""Inches. Text of 9 points stays readable when this is shrunk to a column of 3.4 inches."""
OURS, OTHER, THIRD, GREY = "#0072b2", "#d55e00", "#009e73", "#6b6b6b"
"""Okabe and Ito's colours, which colour-blind readers tell apart."""
Look = dict[str, Any]
"""What matplotlib is told about a line or a marker."""
PAPER: Look = {
    "color": "#000000",
    "marker": "D",
    "markerfacecolor": "white",
    "linestyle": "none",
    "markersize": 6,
    "zorder": 5,
}
"""The paper's own numbers are the same hollow diamond in every figure."""
LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000")


def setup() -> None:
    """Fixed ids and no date: the same data gives the same file."""
    plt.rcParams.update(
        {
            "font.size": 9,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "axes.grid": True,
            "axes.grid.axis": "y",
            "grid.color": "#dddddd",
            "grid.linewidth": 0.6,
            "axes.axisbelow": True,
            "legend.frameon": False,
            "legend.fontsize": 8,
            "svg.hashsalt": "desim",
        }
    )


def axes(size: tuple[float, float] = COLUMN) -> tuple[Figure, Axes]:
    """A figure with one pair of axes."""
    return plt.subplots(figsize=size, layout="constrained")


def links(number: int) -> str:
    """So many links in words."""
    return "1 link" if number == 1 else f"{number} links"


def save(figure: Figure, path: Path) -> None:
    """Writes it; the format follows from the name."""
    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    figure.savefig(path, dpi=140, metadata=metadata)
    plt.close(figure)

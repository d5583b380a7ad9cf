#!/usr/bin/env python3
"""Draws every figure of the paper's evaluation, and writes the tables behind them.

    python analysis/figures.py

Reads results/ as `scorecard.py` does, and results/paper/figures.json where runs are missing. Writes SVG, PNG and
tables.md to results/paper/.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from paper import tables
from paper.draw import bandwidth, completion, connectivity, faults, formation, style
from scorecard import figures, parser

Draw = Callable[[dict[str, Any], Path], None]


def fault_curves(sections: dict[str, Any]) -> dict[str, Any]:
    """The paper's own reading of failures."""
    return next(iter(sections["faults"].values()))


def every_curve(sections: dict[str, Any]) -> dict[str, Any]:
    """All hazards, and the harsher reading."""
    return {**sections["faults"], **sections["sensitivity"]}


FIGURES: tuple[tuple[str, tuple[str, ...], Callable[[dict[str, Any]], dict[str, Any]], Draw], ...] = (
    ("final_configurations.png", ("completion",), lambda all: all["completion"], formation.draw),
    ("time_to_completion.svg", ("completion",), lambda all: all["completion"], completion.draw),
    ("time_with_faults.svg", ("faults",), fault_curves, faults.draw_time),
    ("failed_missions.svg", ("faults",), fault_curves, faults.draw_failed),
    ("hazards.svg", ("faults", "sensitivity"), every_curve, faults.draw_sensitivity),
    ("connectivity.svg", ("connectivity",), lambda all: all["connectivity"], connectivity.draw),
    ("bandwidth.svg", ("bandwidth",), lambda all: all["bandwidth"], bandwidth.draw),
    ("bandwidth_readings.svg", ("bandwidth",), lambda all: all["bandwidth"], bandwidth.draw_readings),
)
"""Each figure: its file, the sections that it needs, what it is given of them, and who draws it."""


def main(given: list[str]) -> int:
    """Draws what there are figures for."""
    options = parser(__doc__).parse_args(given)
    sections = figures(options.results, options.out, options.trials)
    style.setup()
    for name, needs, part, draw in FIGURES:
        if all(need in sections for need in needs):
            draw(part(sections), options.out / name)
            print(options.out / name)
        else:
            print(f"{name}: not run")
    tables.write(sections, options.out / "tables.md")
    print(options.out / "tables.md")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

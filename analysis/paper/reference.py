"""The paper's numbers and statements, from `analysis/reference/`: the one place where they stand."""

from __future__ import annotations

import csv
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "reference"


def rows(name: str) -> list[dict[str, str]]:
    """A file's rows, by column."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def completion() -> dict[str, float]:
    """Median steps by configuration."""
    return {f"{row['robots']}x{row['links']}": float(row["median_steps"]) for row in rows("completion")}


def faults() -> dict[tuple[str, str], float]:
    """Median steps by robots and share."""
    return {(row["robots"], row["share"]): float(row["median_steps"]) for row in rows("faults")}


def bandwidth() -> dict[str, float]:
    """Bytes a timestep by statistic: the least of 10 robots, the most of 100, the median of any."""
    return {row["statistic"]: float(row["bytes_per_step"]) for row in rows("bandwidth")}


def statement(key: str) -> str:
    """What the paper says in words."""
    return next(row["statement"] for row in rows("statements") if row["key"] == key)

"""A results folder of desim, as `results/README.md` describes it. Reads files, knows nothing of the simulator."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Any

import polars as pl

from .statistics import Estimate


class Folder:
    """The results of one scenario."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def is_complete(self, trials: int) -> bool:
        """Whether all its trials are done, at least `trials` of them."""
        manifest = self.path / "manifest.json"
        return manifest.is_file() and self.manifest["finished"] and self.manifest["scenario"]["trials"] >= trials

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """Version, scenario with its defaults, digests."""
        return json.loads((self.path / "manifest.json").read_text(encoding="utf-8"))

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Every figure of the report, with its interval."""
        return json.loads((self.path / "summary.json").read_text(encoding="utf-8"))

    @property
    def scenario(self) -> dict[str, Any]:
        """The whole scenario."""
        return self.manifest["scenario"]

    @cached_property
    def trials(self) -> pl.DataFrame:
        """A row a trial, in order."""
        return self.table("trials").sort("trial")

    def table(self, name: str) -> pl.DataFrame:
        """A table."""
        return pl.read_parquet(self.path / f"{name}.parquet")

    def has(self, name: str) -> bool:
        """Whether the version that made the results wrote that table."""
        return (self.path / f"{name}.parquet").is_file()

    @property
    def max_speed(self) -> float:
        """Full speed of a robot, m/s."""
        return self.scenario["motion"]["max_speed"]

    @property
    def control_period(self) -> float:
        """Length of a control step, s."""
        return self.scenario["control"]["period"]

    @property
    def limit(self) -> int:
        """Control steps after which a trial is given up."""
        return round(self.scenario["time_limit"] / self.control_period)

    def median_steps(self) -> Estimate:
        """Kaplan–Meier median of the steps to completion."""
        return self.summary["steps_to_completion"]["median"]

    def steps(self) -> list[int | None]:
        """Steps to completion of each trial, `None` where the time limit came first."""
        return self.trials["steps_to_completion"].to_list()

    def provenance(self) -> dict[str, Any]:
        """Which run the figures come from."""
        manifest, scenario = self.manifest, self.scenario
        return {
            "scenario": self.path.name,
            "version": manifest["version"],
            "commit": manifest["commit"],
            "trials": scenario["trials"],
            "seed": manifest["seed"],
            "max_speed": self.max_speed,
            "digest": self.summary["digest"],
        }

#!/usr/bin/env python3
"""Draws the trials of a run that failed, from their pictures, side by side, and says of each what had failed of late.

    desim scenario scenarios/paper/faults_80x2_p70.ron --pictures all
    python analysis/failed_trials.py results/faults_80x2_p70 results/paper/failed_trials.png

Needs rsvg-convert (Debian's librsvg2-bin) for the pictures.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import polars as pl

LATE_S = 60.0
MOST = 3


def tell(folder: Path, trials: pl.DataFrame) -> None:
    """One line a failed trial: what failed, how late, and what was not mended."""
    faults = pl.read_parquet(folder / "faults.parquet")
    healing = pl.read_parquet(folder / "healing.parquet")
    for trial, end in trials.select("trial", "simulated_s").iter_rows():
        failed = faults.filter(trial=trial)
        late = failed.filter(pl.col("from_s") > end - LATE_S)
        open_ = healing.filter(pl.col("trial") == trial, pl.col("healed_s").is_null())
        waits = ", ".join(f"{end - since:.0f} s" for since in open_["failed_s"]) or "none"
        print(f"trial {trial}: {len(failed)} failures, {len(late)} in the last {LATE_S:.0f} s; unmended at the end, and for how long: {waits}")


def draw(folder: Path, trials: list[int], out: Path) -> None:
    """The final pictures of `trials` in a row."""
    figure, row = plt.subplots(1, len(trials), figsize=(5.2 * len(trials), 4.4), squeeze=False)
    with tempfile.TemporaryDirectory() as scratch:
        for axes, trial in zip(row[0], trials, strict=True):
            png = Path(scratch) / f"{trial}.png"
            subprocess.run(["rsvg-convert", "-w", "900", folder / f"final_{trial}.svg", "-o", png], check=True)
            axes.imshow(plt.imread(png))
            axes.axis("off")
    figure.tight_layout(pad=0.2)
    figure.savefig(out, dpi=110)


def main(given: list[str]) -> int:
    """The folder of the run, and the picture to write."""
    folder, out = Path(given[0]), Path(given[1])
    trials = pl.read_parquet(folder / "trials.parquet").filter(outcome="censored").sort("trial")
    tell(folder, trials)
    draw(folder, trials["trial"].to_list()[:MOST], out)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

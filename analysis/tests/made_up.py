"""A results folder and figures that nobody has run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import polars as pl

from paper.statistics import Estimate, estimate, median, wilson

RUN = {"scenario": "made_up", "trials": 35, "max_speed": 0.026}


def folder(path: Path, finished: bool = True) -> None:
    """Two trials of three robots: 0 is the root and stands, 1 works, 2 stays free. Trial 1 does not complete."""
    path.mkdir(parents=True)
    scenario = {"trials": 2, "time_limit": 4.0, "motion": {"max_speed": 0.5}, "control": {"period": 0.1}}
    manifest = {"finished": finished, "version": "0", "commit": None, "seed": 1, "scenario": scenario}
    (path / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    pl.DataFrame(
        {"trial": [0, 1], "robots": [3, 3], "steps": [40, 40], "steps_to_completion": [25, None]},
    ).write_parquet(path / "trials.parquet")
    ends = [(0, 0, 0.0, "root"), (0, 1, 3.0, "worker"), (0, 2, 0.0, "free")]
    ends += [(1, robot, x, role) for _, robot, x, role in ends]
    pl.DataFrame(
        [(trial, robot, x, 0.0, role) for trial, robot, x, role in ends],
        schema=["trial", "robot", "x_m", "y_m", "role"],
        orient="row",
    ).write_parquet(path / "robots.parquet")
    moves = [(0.0, 1.0), (1.0, 1.5), (2.0, 2.0), (3.0, 2.4)]
    samples = [(t, time, robot, x) for t in (0, 1) for time, x in moves for robot, x in ((0, 0.0), (1, x), (2, -1.0))]
    pl.DataFrame(
        [(trial, time, robot, x, 0.0) for trial, time, robot, x in samples],
        schema=["trial", "time_s", "robot", "x_m", "y_m"],
        orient="row",
    ).write_parquet(path / "trajectories.parquet")


def near(value: float, width: float = 0.01) -> Estimate:
    """An estimate with an interval of so much of it to either side."""
    return estimate(value, value * (1 - width), value * (1 + width), 35)


def figures() -> dict[str, Any]:
    """Figures that agree with the paper wherever they can, bandwidth apart."""
    paper = {"20x1": 1400, "40x2": 1270, "60x3": 1223, "80x4": 1214}
    return {
        "completion": {
            label: {
                "run": RUN,
                "median": near(steps, 0.002),
                "completed": 35,
                "steps": [steps] * 35,
                "optimum": {"same_robot": [steps / 1.1] * 35},
            }
            for label, steps in paper.items()
        },
        "connectivity": {
            label: {
                "run": RUN,
                "first": near(20),
                "last": near(least),
                "least": near(least),
                "least_of_all": least,
                "connected_trials": 35,
            }
            for label, least in zip((*paper, "100x4"), (0.3, 0.9, 1.7, 2.9, 3.4), strict=True)
        },
        "faults": {
            "Fallible 0.0003": {
                robots: {f"{tenths / 10:.1f}": fault_point(steps, tenths) for tenths in range(10)}
                for robots, steps in (("40", 2067), ("80", 2125))
            }
        },
    }


def fault_point(at_07: int, tenths: int) -> dict[str, Any]:
    """1,270 steps up to a share of 0.2, then a climb to `at_07` at 0.7; missions fail from 0.8 on."""
    steps = 1270 if tenths <= 2 else 1270 + (at_07 - 1270) * (tenths - 2) / 5
    completed = 35 if tenths < 8 else 20
    return {
        "trials": 35,
        "completed": completed,
        "failed_ratio": wilson(35 - completed, 35),
        "median": near(steps),
        "failures": [tenths] * 35,
        "steps": [round(steps)] * completed + [None] * (35 - completed),
        "limit": 4000,
    }


def bandwidth() -> dict[str, Any]:
    """Ten swarms that send and receive as the paper says."""

    def reading(topics: dict[str, float]) -> dict[str, Any]:
        values = {"min": 17.0, "median": 100.0, "max": 174.0}
        of_a_trial = {name: median([value] * 35) for name, value in values.items()}
        return {**values, "of_a_trial": of_a_trial, "topics": topics}

    topics = {"request": 3.0, "status": 2.0, "strand": 1.0}
    names = ("sent, with headers", "received, with headers", "received, requests and responses alone, with headers")
    return {
        str(robots): {"run": RUN, "neighbours": robots / 2, "readings": {name: reading(topics) for name in names}}
        for robots in range(10, 101, 10)
    }

"""From results folders to `results/paper/figures.json`: everything that figures and scorecard need, and no more.

The file is small and committed, so that a fresh clone can draw the figures and print the scorecard. Each section is
taken from the results if all of its runs are there with all their trials; else it stays as it was.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import polars as pl

from . import optimal, readings
from .evaluation import (
    BANDWIDTH,
    COMPLETION,
    CONNECTIVITY,
    DEPLOYMENT,
    FAULTS,
    NEEDED,
    SENSITIVITY,
    TRIALS,
    FaultRun,
    Run,
)
from .folder import Folder
from .statistics import median, quantile, wilson

Section = dict[str, Any]
FREE = "free"
BAND = (0.1, 0.9)
"""Quantiles of the band around a median over time."""
OPTIMA = ("same_robot", "best_assignment")
"""To the formation at completion, by the same robots or by the best placed ones."""


def collect(results: Path, known: Section, trials: int = TRIALS) -> tuple[Section, dict[str, str]]:
    """The sections, and where each is from: fresh where `results` has all runs with `trials` trials, else `known`."""
    sections, sources = dict(known), {}
    for name, (runs, make) in SECTIONS.items():
        missing = [run.name for run in runs if not Folder(results / run.name).is_complete(trials)]
        if missing:
            what = f"{missing[0]} and {len(missing) - 1} more" if len(missing) > 1 else missing[0]
            sources[name] = f"as committed ({what} not in {results})" if name in known else f"absent ({what})"
        else:
            sections[name] = make(results)
            sources[name] = f"from {results}"
    return sections, sources


def completion(results: Path) -> Section:
    """The four configurations: steps, the optimum, and where the robots of trial 0 ended."""
    return {item.label: _completion(item.robots, item.links, Folder(results / item.run.name)) for item in COMPLETION}


def deployment(results: Path) -> Section:
    """The four configurations from equally wide deployments: steps and optimum."""
    kept = ("run", "robots", "links", "completed", "median", "steps", "optimum", "robots_used")
    of = {item.label: _completion(item.robots, item.links, Folder(results / item.run.name)) for item in DEPLOYMENT}
    return {label: {key: run[key] for key in kept} for label, run in of.items()}


def _completion(robots: int, links: int, folder: Folder) -> Section:
    ways = [_ways(folder, trial) for trial in folder.trials["trial"]]
    return {
        "run": folder.provenance(),
        "robots": robots,
        "links": links,
        "completed": folder.summary["completed"],
        "median": folder.median_steps(),
        "completion_ratio": folder.summary["completion_ratio"],
        "steps": folder.steps(),
        "limit": folder.limit,
        "robots_used": folder.summary["robots_used"],
        "optimum": {name: [round(way[name], 1) for way in ways] for name in OPTIMA},
        "final": final_formation(folder, 0),
    }


def _ways(folder: Folder, trial: int) -> dict[str, float]:
    """The optimal steps of one trial to its formation at completion."""
    robots = folder.table("robots").filter(trial=trial).sort("robot")
    path = way(folder, trial)
    ends = [(float(x), float(y)) for x, y in robots.select("x_m", "y_m").iter_rows()]
    completed = folder.trials.filter(trial=trial)["steps_to_completion"][0]
    starts = places_at(path, 0.0)
    then = ends if completed is None else places_at(path, completed * folder.control_period)
    formation = [robot for robot, role in enumerate(robots["role"]) if role != FREE]

    def steps(metres: float) -> float:
        return optimal.steps(metres, folder.max_speed, folder.control_period)

    def of(points: list[optimal.Point]) -> list[optimal.Point]:
        return [points[robot] for robot in formation]

    return {
        "same_robot": steps(optimal.same_robot(of(starts), of(then))),
        "best_assignment": steps(optimal.best_assignment(starts, of(then))),
    }


def way(folder: Folder, trial: int) -> pl.DataFrame:
    """Where the robots of a trial were: its samples, and its end, which lies after the last of them."""
    samples = folder.table("trajectories").filter(trial=trial).select("time_s", "robot", "x_m", "y_m")
    end_s = folder.trials.filter(trial=trial)["steps"][0] * folder.control_period
    ends = folder.table("robots").filter(trial=trial).select(pl.lit(end_s).alias("time_s"), "robot", "x_m", "y_m")
    before = samples.filter(pl.col("time_s") < end_s - folder.control_period / 2)
    return pl.concat([before, ends], how="vertical_relaxed")


def places_at(samples: pl.DataFrame, time_s: float) -> list[optimal.Point]:
    """Where the robots of a trial were: on a straight line between the samples before and after."""
    times = samples["time_s"].unique().sort().to_list()
    after = next((time for time in times if time >= time_s), times[-1])
    before = max((time for time in times if time <= time_s), default=after)
    share = (time_s - before) / (after - before) if after > before else 0.0
    pairs = zip(_sample(samples, before), _sample(samples, after), strict=True)
    return [(x + share * (to_x - x), y + share * (to_y - y)) for (x, y), (to_x, to_y) in pairs]


def _sample(samples: pl.DataFrame, time_s: float) -> list[optimal.Point]:
    rows = samples.filter(pl.col("time_s") == time_s).sort("robot").select("x_m", "y_m").iter_rows()
    return [(float(x), float(y)) for x, y in rows]


def final_formation(folder: Folder, trial: int) -> Section:
    """Where the robots of a trial ended, to draw the paper's figure 2."""
    rows = folder.table("robots").filter(trial=trial).sort("robot")
    return {
        "trial": trial,
        "range_m": folder.scenario["radio"]["range"],
        "arena_m": folder.scenario["arena"]["size"],
        "targets": targets(folder.scenario["protocol"]["Backbone"]["targets"]),
        "robots": [
            {"at": [round(x, 3), round(y, 3)], "role": role, "target": target, "parents": parents}
            for x, y, role, target, parents in rows.select("x_m", "y_m", "role", "target", "parents").iter_rows()
        ],
    }


def targets(config: Section) -> list[list[float]]:
    """Places of a ring of targets, the first on the positive x axis."""
    ring = config["Ring"]
    angles = [2 * pi * number / ring["count"] for number in range(ring["count"])]
    return [[round(ring["radius"] * cos(angle), 6), round(ring["radius"] * sin(angle), 6)] for angle in angles]


def connectivity(results: Path) -> Section:
    """λ₂ over time, while all trials run: their median and the band of the middle four fifths."""
    return {
        item.label: _connectivity(item.robots, item.links, Folder(results / item.run.name)) for item in CONNECTIVITY
    }


def _connectivity(robots: int, links: int, folder: Folder) -> Section:
    samples = folder.table("connectivity").sort("trial", "time_s")
    trials = len(folder.trials)
    at = samples.group_by("time_s").agg(pl.col("lambda2")).sort("time_s").filter(pl.col("lambda2").list.len() == trials)
    values = at["lambda2"].to_list()
    of_trials = samples.group_by("trial", maintain_order=True)
    first, last, least = (of_trials.agg(figure)["lambda2"].to_list() for figure in _of_a_trial())
    return {
        "run": folder.provenance(),
        "robots": robots,
        "links": links,
        "time_s": [round(time, 3) for time in at["time_s"]],
        "median": [round(quantile(sample, 0.5), 4) for sample in values],
        "low": [round(quantile(sample, BAND[0]), 4) for sample in values],
        "high": [round(quantile(sample, BAND[1]), 4) for sample in values],
        "first": median(first),
        "last": median(last),
        "least": median(least),
        "least_of_all": samples["lambda2"].min(),
        "samples": len(samples),
        "connected_trials": sum(of_trials.agg((pl.col("components") == 1).all())["components"]),
    }


def _of_a_trial() -> tuple[pl.Expr, pl.Expr, pl.Expr]:
    value = pl.col("lambda2")
    return value.first(), value.last(), value.min()


def bandwidth(results: Path) -> Section:
    """Bytes a control step of a robot, 10 to 100 robots, by every reading."""
    return {str(robots): _bandwidth(robots, Folder(results / run.name)) for robots, run in BANDWIDTH}


def _bandwidth(robots: int, folder: Folder) -> Section:
    rows = folder.table("bandwidth")
    return {
        "run": folder.provenance(),
        "links": folder.scenario["protocol"]["Backbone"]["targets"]["Ring"]["links"],
        "completed": folder.summary["completed"],
        "neighbours": round(readings.neighbours(rows), 2),
        "readings": {reading.name: _reading(reading, rows, robots, folder.trials) for reading in readings.READINGS},
    }


def _reading(reading: readings.Reading, bandwidth: pl.DataFrame, robots: int, trials: pl.DataFrame) -> Section:
    rows = reading.rows(bandwidth, robots)
    of_trials = readings.per_robot(rows, trials)
    everyone = [size for robots in of_trials for size in robots]
    extremes: dict[str, Callable[[Iterable[float]], float]] = {
        "min": min,
        "median": lambda sizes: quantile(sizes, 0.5),
        "max": max,
    }
    return {
        **{name: round(of(everyone), 3) for name, of in extremes.items()},
        "of_a_trial": {name: median([of(sizes) for sizes in of_trials]) for name, of in extremes.items()},
        "topics": {topic: round(size, 4) for topic, size in readings.by_topic(rows, trials).items()},
    }


def faults(results: Path) -> Section:
    """Steps and failures against the share of fallible robots: the paper's reading."""
    return _fault_curves(results, FAULTS)


def sensitivity(results: Path) -> Section:
    """The same with other hazards and with the harsher reading."""
    return _fault_curves(results, SENSITIVITY)


def _fault_curves(results: Path, points: Iterable[FaultRun]) -> Section:
    curves: Section = {}
    for point in points:
        curve = curves.setdefault(point.key, {}).setdefault(str(point.robots), {})
        curve[f"{point.share / 100:.1f}"] = _fault_point(Folder(results / point.run.name))
    return curves


def _fault_point(folder: Folder) -> Section:
    trials, completed = len(folder.trials), folder.summary["completed"]
    failed = failures(folder)
    return {
        "run": folder.provenance(),
        "trials": trials,
        "completed": completed,
        "failed_ratio": wilson(trials - completed, trials),
        "median": folder.median_steps(),
        "steps": folder.steps(),
        "limit": folder.limit,
        "connected_share": folder.summary["connected_share"],
        "lambda2_min": folder.summary["lambda2_min"],
        "failures": failed,
        "failed_though_enough": None if failed is None else failed_though_enough(folder, failed),
    }


def failures(folder: Folder) -> list[int] | None:
    """Robots that failed in each trial, `None` where the version that ran it recorded no faults."""
    if not folder.has("faults"):
        return None
    rows = folder.table("faults").filter(pl.col("robot").is_not_null()).select("trial", "robot").unique()
    counts = dict(rows.group_by("trial").len().iter_rows())
    return [counts.get(trial, 0) for trial in folder.trials["trial"]]


def failed_though_enough(folder: Folder, failed: list[int]) -> list[int]:
    """The trials that did not complete though as many robots as a backbone needs were left."""
    robots = folder.scenario["swarm"]["robots"]
    pairs = zip(folder.steps(), failed, strict=True)
    return [trial for trial, (steps, lost) in enumerate(pairs) if steps is None and robots - lost >= NEEDED]


def _runs(items: Iterable[Any]) -> tuple[Run, ...]:
    return tuple(item.run for item in items)


SECTIONS: dict[str, tuple[tuple[Run, ...], Callable[[Path], Section]]] = {
    "completion": (_runs(COMPLETION), completion),
    "deployment": (_runs(DEPLOYMENT), deployment),
    "connectivity": (_runs(CONNECTIVITY), connectivity),
    "bandwidth": (tuple(run for _, run in BANDWIDTH), bandwidth),
    "faults": (_runs(FAULTS), faults),
    "sensitivity": (_runs(SENSITIVITY), sensitivity),
}


def read(path: Path) -> Section:
    """The committed file, or nothing."""
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def write(path: Path, sections: Section) -> None:
    """One line a leaf list, so that the file stays small and its changes readable."""
    path.write_text(dumps(sections) + "\n", encoding="utf-8")


def dumps(value: Any, depth: int = 0) -> str:
    """JSON with objects opened out and lists on one line."""
    if not isinstance(value, dict) or not value:
        return json.dumps(value, ensure_ascii=False)
    if set(value) <= {"value", "ci95", "n", "unit"} or set(value) == {"at", "role", "target", "parents"}:
        return json.dumps(value, ensure_ascii=False)
    pad = " " * (depth + 1)
    inner = ",\n".join(f"{pad}{json.dumps(key)}: {dumps(item, depth + 1)}" for key, item in value.items())
    return "{\n" + inner + "\n" + " " * depth + "}"

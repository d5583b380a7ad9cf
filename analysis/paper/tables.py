"""The numbers behind the figures as Markdown, so that no number in prose goes stale."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from . import reference
from .claims import misfit
from .statistics import Estimate, quantile

Section = dict[str, Any]
HEAD = """# The numbers behind the figures

Written by `python analysis/figures.py`; do not edit. Brackets are 95 % intervals, a dash is a figure that does not
exist (such as a median that fewer than half of the trials reached).
"""


def write(sections: Section, path: Path) -> None:
    """All tables that there are figures for."""
    made = [make(sections[name]) for name, make in TABLES.items() if name in sections]
    path.write_text("\n".join([HEAD, *made]), encoding="utf-8")


def table(title: str, head: list[str], rows: Iterable[list[str]]) -> str:
    """A titled table."""
    lines = [f"| {' | '.join(cells)} |" for cells in (head, ["---"] * len(head), *rows)]
    return f"## {title}\n\n" + "\n".join(lines) + "\n"


def plain(value: float | None, digits: int = 0) -> str:
    """A number, or a dash."""
    return "–" if value is None else f"{value:,.{digits}f}"


def with_interval(given: Estimate, digits: int = 0, scale: float = 1.0) -> str:
    """An estimate."""
    value, low, high = (None if end is None else end * scale for end in (given["value"], *given["ci95"]))
    return f"{plain(value, digits)} [{plain(low, digits)}, {plain(high, digits)}]"


def completion(runs: Section, title: str = "Time to completion") -> str:
    """Steps and optimum."""
    steps = ["median steps", "paper", "optimum", "best assignment"]
    head = ["robots", "links", "completed", *steps, "robots used"]
    paper = reference.completion()
    rows = [
        [
            str(run["robots"]),
            str(run["links"]),
            f"{run['completed']} of {len(run['steps'])}",
            with_interval(run["median"]),
            plain(paper[label]),
            *(plain(quantile(run["optimum"][name], 0.5)) for name in ("same_robot", "best_assignment")),
            plain(run["robots_used"]["value"], 1),
        ]
        for label, run in runs.items()
    ]
    return table(title, head, rows)


def deployment(runs: Section) -> str:
    """The same from equally wide deployments."""
    return completion(runs, "Time to completion, all deployments 0.95 m wide")


def connectivity(runs: Section) -> str:
    """λ₂ at the start, at the end, at its least."""
    head = ["robots", "links", "trials", "λ₂ at the start", "at the end", "least of a trial", "least of all"]
    rows = [
        [
            str(run["robots"]),
            str(run["links"]),
            str(run["run"]["trials"]),
            *(with_interval(run[key], 2) for key in ("first", "last", "least")),
            plain(run["least_of_all"], 3),
        ]
        for run in runs.values()
    ]
    return table("Algebraic connectivity", head, rows)


def bandwidth(runs: Section) -> str:
    """Bytes by number of robots at face value, and by reading against the paper."""
    head = ["robots", "links", "neighbours", "completed", "sent: least, median, most", "received: least, median, most"]
    rows = [
        [
            robots,
            str(run["links"]),
            plain(run["neighbours"], 1),
            f"{run['completed']} of {run['run']['trials']}",
            *(spread(run["readings"][f"{direction}, with headers"]) for direction in ("sent", "received")),
        ]
        for robots, run in runs.items()
    ]
    return table("Bandwidth: bytes a control step of a robot, with headers", head, rows) + "\n" + readings(runs)


def spread(reading: Section) -> str:
    """Least, median, most of all robots of all trials."""
    return ", ".join(plain(reading[key], 1) for key in ("min", "median", "max"))


def readings(runs: Section) -> str:
    """Each way to count against the paper's three numbers."""
    numbers = ["least, 10 robots (17)", "medians (about 100)", "most, 100 robots (174)", "worst factor"]
    head = ["reading", *numbers, "mean bytes by topic, 100 robots"]
    rows = []
    for reading in sorted(runs["10"]["readings"], key=lambda name: misfit(runs, name)):
        of = {robots: run["readings"][reading] for robots, run in runs.items()}
        medians = [each["median"] for each in of.values()]
        topics = of["100"]["topics"]
        order = " > ".join(f"{topic} {topics[topic]:.3g}" for topic in sorted(topics, key=lambda topic: -topics[topic]))
        cells = [plain(of["10"]["min"], 1), f"{min(medians):.3g} to {max(medians):.3g}", plain(of["100"]["max"], 1)]
        rows.append([reading, *cells, f"{misfit(runs, reading):.1f}", order])
    return table("Readings of the paper's bandwidth", head, rows)


def faults(curves: Section, title: str = "Failures: the paper's reading, hazard 0.0003") -> str:
    """Steps, failed missions and failures by share."""
    counts = ["completed", "median steps", "failed missions, %", "failed robots", "failed, enough left", "connected, % of time"]
    head = ["faults", "robots", "share", *counts]
    rows = [
        [
            name,
            robots,
            share,
            f"{point['completed']} of {point['trials']}",
            with_interval(point["median"]),
            with_interval(point["failed_ratio"], 0, 100),
            "–" if point["failures"] is None else plain(sum(point["failures"]) / len(point["failures"]), 1),
            "–" if point["failed_though_enough"] is None else str(len(point["failed_though_enough"])),
            plain(100 * point["connected_share"]["value"], 1),
        ]
        for name, by_robots in curves.items()
        for robots, curve in by_robots.items()
        for share, point in curve.items()
    ]
    return table(title, head, rows)


def sensitivity(curves: Section) -> str:
    """The same for other hazards."""
    return faults(curves, "Failures: other hazards, and the harsher reading")


TABLES: dict[str, Callable[[Section], str]] = {
    "completion": completion,
    "deployment": deployment,
    "faults": faults,
    "sensitivity": sensitivity,
    "connectivity": connectivity,
    "bandwidth": bandwidth,
}

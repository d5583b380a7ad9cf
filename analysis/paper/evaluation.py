"""The runs of the paper's evaluation: which scenario files, under which names, for which figure.

Nothing is read here. `run_paper.py` runs this list, `collect.py` looks for its results.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIOS = ROOT / "scenarios" / "paper"
TRIALS = 35
"""Trials of every configuration (paper, section 5.2)."""

SHARES = tuple(range(0, 100, 10))
"""Fallible robots, per cent."""
FAULT_ROBOTS = (40, 80)
HAZARD = 0.0003
"""Probability a control step with which a fallible robot of the backbone goes silent: fitted, see the README."""
HAZARDS = (0.0002, 0.0004, 0.0005)
"""The other hazards that are tried."""
TRIED_SHARES = (20, 50, 70, 90)
"""Shares at which other hazards and readings are tried, per cent."""
NEEDED = 21
"""Robots of a backbone with 2 links to four targets 4.5 m out: a root, and for each a worker and 2 × 2 relays."""
ON_JOIN_WINDOW = 100.0
"""Seconds after joining within which `OnJoin` strikes: about the time that a chain takes to grow."""


@dataclass(frozen=True)
class Run:
    """A scenario to run: its results are in the folder `name`."""

    name: str
    scenario: Path
    overrides: tuple[str, ...] = ()

    def command(self, binary: Path, results: Path, trials: int, extra: tuple[str, ...] = ()) -> list[str]:
        """The command line that runs it, or finishes what an earlier one began."""
        overrides = [argument for override in self.overrides for argument in ("--set", override)]
        target = ["--trials", str(trials), "--out", str(results / self.name)]
        return [str(binary), "scenario", str(self.scenario), *target, *overrides, *extra]


def shipped(name: str) -> Run:
    """A scenario of `scenarios/paper/` as it stands there."""
    return Run(name, SCENARIOS / f"{name}.ron")


@dataclass(frozen=True)
class Completion:
    """One of the paper's four configurations, or the fifth of the figure of connectivity."""

    label: str
    robots: int
    links: int
    run: Run


COMPLETION = tuple(
    Completion(f"{robots}x{links}", robots, links, shipped(f"completion_{robots}x{links}"))
    for robots, links in ((20, 1), (40, 2), (60, 3), (80, 4))
)
SAME_RADIUS = 0.95
"""Metres: a deployment that 20 robots and 80 (the least for them is 0.88) can share."""


def same_deployment(item: Completion) -> Completion:
    """A configuration whose cluster does not widen with the number of robots."""
    run = Run(f"{item.run.name}_r095", item.run.scenario, (f"swarm.deploy=Cluster(radius: {SAME_RADIUS})",))
    return replace(item, run=run)


DEPLOYMENT = tuple(same_deployment(item) for item in COMPLETION)
"""What is left of the falling trend if deployments are equally wide, not equally dense."""
CONNECTIVITY = (*COMPLETION, Completion("100x4", 100, 4, shipped("bandwidth_100")))
"""The paper draws five configurations and does not name them: its four, and the largest swarm that it mentions."""

BANDWIDTH = tuple((robots, shipped(f"bandwidth_{robots}")) for robots in range(10, 101, 10))


@dataclass(frozen=True)
class FaultRun:
    """A point of the curves of failures: so many robots, such a share of them fallible."""

    robots: int
    share: int
    model: str
    hazard: float | None
    run: Run

    @property
    def key(self) -> str:
        """Which curve the point belongs to."""
        return self.model if self.hazard is None else f"{self.model} {self.hazard:g}"


def fault_name(robots: int, share: int) -> str:
    """Name of the shipped scenario."""
    return f"faults_{robots}x2_p{share:02}"


def fallible(robots: int, share: int) -> FaultRun:
    """The paper's failures as desim reads them, with the fitted hazard."""
    return FaultRun(robots, share, "Fallible", HAZARD, shipped(fault_name(robots, share)))


def other_hazard(robots: int, share: int, hazard: float) -> FaultRun:
    """The same with another hazard."""
    base = fault_name(robots, share)
    faults = f"faults=[Fallible(share: {share / 100}, hazard: {hazard:.4f})]"
    run = Run(f"{base}_h{round(hazard * 10_000)}", SCENARIOS / f"{base}.ron", (faults,))
    return FaultRun(robots, share, "Fallible", hazard, run)


def on_join(robots: int, share: int) -> FaultRun:
    """The harsher reading: every robot that takes a backbone role fails with this probability."""
    base = fault_name(robots, share)
    faults = f"faults=[OnJoin(probability: {share / 100}, window: {ON_JOIN_WINDOW})]"
    return FaultRun(robots, share, "OnJoin", None, Run(f"{base}_onjoin", SCENARIOS / f"{base}.ron", (faults,)))


FAULTS = tuple(fallible(robots, share) for robots in FAULT_ROBOTS for share in SHARES)
SENSITIVITY = tuple(
    other_hazard(robots, share, hazard) for robots in FAULT_ROBOTS for hazard in HAZARDS for share in TRIED_SHARES
) + tuple(on_join(robots, share) for robots in FAULT_ROBOTS for share in TRIED_SHARES)


def sets() -> dict[str, tuple[Run, ...]]:
    """Every run, by the figure that asks for it."""
    return {
        "completion": tuple(configuration.run for configuration in COMPLETION),
        "deployment": tuple(configuration.run for configuration in DEPLOYMENT),
        "bandwidth": tuple(run for _, run in BANDWIDTH),
        "connectivity": tuple(configuration.run for configuration in CONNECTIVITY),
        "faults": tuple(point.run for point in FAULTS),
        "sensitivity": tuple(point.run for point in SENSITIVITY),
    }


def chosen(names: list[str]) -> Iterator[Run]:
    """The runs of the named sets, each once."""
    seen = set()
    for name in names:
        for run in sets()[name]:
            if run.name not in seen:
                seen.add(run.name)
                yield run

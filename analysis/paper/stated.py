"""What the paper states, claim by claim, and by what rule and margin each is to be judged, from `analysis/reference/`.

The list was committed before any run that it is held against, so that neither rule nor margin could follow from a result.
Each claim is to be judged under each reading of what the paper leaves open: where targets stand and how robots are
deployed. One speed is to be fitted for each reading, on one of its claims. So far the list can be printed, no more.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from . import reference

RULES = ("number", "above", "below", "same", "equal")
"""As in `verdict.py`; `equal` means in every trial."""


@dataclass(frozen=True)
class Stated:
    """A claim of the paper."""

    key: str
    section: str
    says: str
    measured: str
    """What is measured of it."""
    paper: float | None
    """The paper's figure; `None` where it has words alone."""
    rule: str
    margin: float
    """Of `number` and `same` the share that is granted, of `above` and `below` the threshold."""
    runs: str

    def judged(self) -> str:
        """The rule in words."""
        of = {
            "number": f"if it lies in our interval widened by {self.margin:.0%} of it",
            "same": f"if the whole interval is within {self.margin:.0%} of 1",
            "above": f"if the whole interval is above {self.margin:g}",
            "below": f"if the whole interval is below {self.margin:g}",
            "equal": "if it is so in every trial",
        }
        return of[self.rule]


@dataclass(frozen=True)
class Reading:
    """How what the paper leaves open is taken, for all claims alike."""

    key: str
    targets: str
    deployment: str
    speed: str
    """What the speed of robots is fitted on."""
    why: str


def claims() -> Iterator[Stated]:
    """Every claim, in the paper's order."""
    for row in reference.rows("claims"):
        paper = float(row["paper"]) if row["paper"] else None
        if row["rule"] not in RULES:
            raise ValueError(f"claims.csv: {row['key']}: no rule is called {row['rule']!r}: use one of {', '.join(RULES)}")
        if row["rule"] == "number" and paper is None:
            raise ValueError(f"claims.csv: {row['key']}: a claim that is a number needs the paper's")
        rest = (row["rule"], float(row["margin"]), row["runs"])
        yield Stated(row["key"], row["section"], row["says"], row["measured"], paper, *rest)


def readings() -> Iterator[Reading]:
    """Every reading; the first is the one of the committed figures."""
    for row in reference.rows("readings"):
        yield Reading(row["key"], row["targets"], row["deployment"], row["speed"], row["why"])

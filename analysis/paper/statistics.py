"""Estimates and their intervals. Standard library only: the scorecard must print on a fresh clone.

An estimate is what desim's `summary.json` has: `{"value": v, "ci95": [low, high], "n": trials}`, `None` for what does
not exist. Intervals are 95 %.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from statistics import NormalDist
from typing import TypedDict

Z = NormalDist().inv_cdf(0.975)


class Estimate(TypedDict):
    """A figure, its 95 % interval, and the number of trials behind it."""

    value: float | None
    ci95: list[float | None]
    n: int


def estimate(value: float | None, low: float | None = None, high: float | None = None, n: int = 0) -> Estimate:
    """An estimate, by its parts."""
    return {"value": value, "ci95": [low, high], "n": n}


def quantile(values: Iterable[float], q: float) -> float:
    """The quantile by linear interpolation between order statistics, as desim has it."""
    ordered = sorted(values)
    rank = (len(ordered) - 1) * q
    below, above = ordered[math.floor(rank)], ordered[math.ceil(rank)]
    return below if below == above else below + (above - below) * (rank - math.floor(rank))


def median(values: Sequence[float]) -> Estimate:
    """The median with the order statistics that enclose it: no assumption on the distribution."""
    ordered, n = sorted(values), len(values)
    if n == 0:
        return estimate(None)
    rank = _outer_rank(n)
    low, high = (ordered[rank - 1], ordered[n - rank]) if rank else (None, None)
    return estimate(quantile(ordered, 0.5), low, high, n)


def _outer_rank(n: int) -> int:
    """The largest k for which fewer than k of n values lie below the median with probability at most 2.5 %, or 0."""
    below, rank = 0.0, 0
    for k in range(n):
        below += math.comb(n, k) * 0.5**n
        if below > 0.025:
            break
        rank = k + 1
    return rank


def wilson(successes: int, n: int) -> Estimate:
    """A share with Wilson's interval, which stays within 0 and 1 and has a width at 0 and 1 too."""
    if n == 0:
        return estimate(None)
    share, shrink = successes / n, 1 + Z * Z / n
    centre = (share + Z * Z / (2 * n)) / shrink
    half = Z / shrink * math.sqrt(share * (1 - share) / n + Z * Z / (4 * n * n))
    low = 0.0 if successes == 0 else centre - half
    high = 1.0 if successes == n else centre + half
    return estimate(share, low, high, n)


def difference(a: Estimate, b: Estimate) -> Estimate:
    """a − b from the two intervals alone (Zou and Donner's MOVER; for shares it is Newcombe's interval).

    The two are taken as independent. Our trials share their deployments from run to run, which makes true intervals
    narrower, not wider.
    """
    n = min(a["n"], b["n"])
    if a["value"] is None or b["value"] is None:
        return estimate(None, n=n)
    value = a["value"] - b["value"]
    down = _reach(a["value"], a["ci95"][0], b["value"], b["ci95"][1])
    up = _reach(a["value"], a["ci95"][1], b["value"], b["ci95"][0])
    return estimate(value, None if down is None else value - down, None if up is None else value + up, n)


def ratio(a: Estimate, b: Estimate) -> Estimate:
    """a / b, both positive: the difference of their logarithms."""
    logarithm = difference(_mapped(a, math.log), _mapped(b, math.log))
    return _mapped(logarithm, math.exp)


def _reach(a: float, a_end: float | None, b: float, b_end: float | None) -> float | None:
    return None if a_end is None or b_end is None else math.hypot(a - a_end, b - b_end)


def _mapped(given: Estimate, function: Callable[[float], float]) -> Estimate:
    low, high = (None if end is None else function(end) for end in given["ci95"])
    value = None if given["value"] is None else function(given["value"])
    return estimate(value, low, high, given["n"])

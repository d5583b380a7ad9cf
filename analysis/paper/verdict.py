"""When our figure agrees with the paper's, differs from it, or cannot say. The rules, in one place.

The paper gives numbers without intervals. Each is a median of 35 trials of another simulator, rounded, and our only
fitted speed has two digits. So a number of the paper **agrees** if it lies in our 95 % interval widened by `MARGIN` of
the number, **differs** if it lies outside, and we **cannot say** if our interval is open or wider than it could tell.

5 % is the sum of what no trial of ours can remove: 2 % for the two digits of the speed (0.026 m/s; time goes with its
inverse), 1 to 2 % for the sampling error of the paper's own median (what ours have with as many trials), 1 % for the
paper's "about".

A statement in words is put as a difference or ratio with its interval. It **agrees** if the whole interval is on the
side that the statement names, **differs** if none of it is, and else we **cannot say**.
"""

from __future__ import annotations

from .statistics import Estimate

AGREES, DIFFERS, CANNOT_SAY = "agrees", "differs", "cannot say"
MARGIN = 0.05
"""Share of the paper's number by which our interval is widened."""
WIDEST = 0.25
"""Half a width, as a share of the paper's number, above which an interval contains too much to tell."""
SAME = 0.15
"""How far medians that the paper calls almost identical may lie apart. Ours: the paper names no number."""


def number(ours: Estimate, paper: float, margin: float = MARGIN) -> str:
    """A number of the paper against our estimate of it."""
    low, high = ours["ci95"]
    reach = margin * abs(paper)
    if ours["value"] is None:
        return CANNOT_SAY
    if (low is not None and paper < low - reach) or (high is not None and paper > high + reach):
        return DIFFERS
    if low is None or high is None or (high - low) / 2 > WIDEST * abs(paper):
        return CANNOT_SAY
    return AGREES


def above(ours: Estimate, threshold: float = 0.0) -> str:
    """A statement that something is larger than `threshold`."""
    low, high = ours["ci95"]
    if low is not None and low > threshold:
        return AGREES
    return DIFFERS if high is not None and high < threshold else CANNOT_SAY


def below(ours: Estimate, threshold: float) -> str:
    """A statement that something is smaller than `threshold`."""
    opposite = {AGREES: DIFFERS, DIFFERS: AGREES, CANNOT_SAY: CANNOT_SAY}
    return opposite[above(ours, threshold)]


def same(ours: Estimate, apart: float = SAME) -> str:
    """A statement that a ratio is 1, up to `apart`: agrees if the whole interval is that near, differs if none is."""
    low, high = ours["ci95"]
    least, most = 1 - apart, 1 + apart
    if low is not None and high is not None and least <= low and high <= most:
        return AGREES
    outside = (low is not None and low > most) or (high is not None and high < least)
    return DIFFERS if outside else CANNOT_SAY


def every(verdicts: list[str]) -> str:
    """A statement of several parts: one that differs spoils it, one that is open leaves it open."""
    for worst in (DIFFERS, CANNOT_SAY):
        if worst in verdicts:
            return worst
    return AGREES

"""The claims of the paper's section 5, each with what we found and the verdict.

Standard library only, and only `figures.json`: it prints on a fresh clone. A section that has not been run gives claims
that cannot be said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from . import reference, verdict
from .statistics import Estimate, difference, estimate, ratio, wilson

Section = dict[str, Any]
CALIBRATED, PREDICTION = "calibrated", "prediction"
CURVE = "Fallible 0.0003"
"""The curve of failures that the paper's figures are compared with."""
NEAR_ZERO = 0.05
"""λ₂ is near zero when below this share of what it starts with. Ours: the paper names no number."""
LONE_LINK = "20x1"
MAIN_READINGS = ("sent, with headers", "received, with headers")
REQUESTS = "received, requests and responses alone, with headers"
TOPICS = ("request", "status", "strand")
"""By bytes, most first, as the paper has them."""


@dataclass(frozen=True)
class Claim:
    """A line of the scorecard."""

    claim: str
    paper: float | str
    ours: float | str | None
    ci95: list[float | None] | None
    verdict: str
    kind: str = PREDICTION
    trials: int | None = None
    note: str = ""


def scorecard(figures: Section) -> list[Section]:
    """Every claim, in the paper's order."""
    return [asdict(claim) for make in CLAIMS for claim in make(figures)]


def rounded(value: float | None) -> float | None:
    """Four significant digits: more would be noise."""
    return None if value is None else float(f"{value:.4g}")


def interval(given: Estimate) -> list[float | None]:
    """An interval, rounded."""
    return [rounded(end) for end in given["ci95"]]


def from_number(name: str, paper: float, ours: Estimate, kind: str = PREDICTION, note: str = "") -> Claim:
    """A claim that is a number."""
    judged = verdict.number(ours, paper)
    off = "" if ours["value"] is None else f"{(ours['value'] / paper - 1) * 100:+.1f} %"
    notes = "; ".join(part for part in (off, note) if part)
    return Claim(name, paper, rounded(ours["value"]), interval(ours), judged, kind, ours["n"], notes)


def unsaid(name: str, paper: float | str, note: str, kind: str = PREDICTION) -> Claim:
    """A claim that nothing here decides."""
    return Claim(name, paper, None, None, verdict.CANNOT_SAY, kind, note=note)


def medians(figures: Section) -> Iterator[Claim]:
    """Median steps of the four configurations."""
    for label, paper in reference.completion().items():
        name = (
            f"median steps to completion, {label.replace('x', ' robots, ')} {'link' if label == LONE_LINK else 'links'}"
        )
        ours, kind = figures.get("completion", {}).get(label), CALIBRATED if label == LONE_LINK else PREDICTION
        if ours is None:
            yield unsaid(name, paper, "not run", kind)
            continue
        note = f"max_speed {ours['run']['max_speed']} m/s is fitted on this" if kind == CALIBRATED else ""
        yield from_number(name, paper, ours["median"], kind, note)


def reached(figures: Section) -> Iterator[Claim]:
    """Whether every trial reached its targets with its links."""
    statement, runs = reference.statement("reached"), figures.get("completion")
    if not runs:
        yield unsaid(statement, "all configurations", "not run")
        return
    done = wilson(sum(run["completed"] for run in runs.values()), sum(len(run["steps"]) for run in runs.values()))
    judged = verdict.above(done, 0.9)
    yield Claim(statement, "all configurations", rounded(done["value"]), interval(done), judged, trials=done["n"])


def falls(figures: Section) -> Iterator[Claim]:
    """Whether more robots and links take fewer steps."""
    statement, runs = reference.statement("falls"), figures.get("completion")
    if not runs:
        yield unsaid(statement, "1400 → 1214", "not run")
        return
    of = [run["median"] for run in runs.values()]
    whole = difference(of[0], of[-1])
    monotone = all(a["value"] > b["value"] for a, b in zip(of, of[1:], strict=False))
    judged = verdict.above(whole) if monotone else verdict.DIFFERS
    note = f"steps less with 80 robots than with 20: {_arrows(runs)}"
    if "deployment" in figures:
        note += f"; {_arrows(figures['deployment'])} from equally wide deployments"
    yield Claim(statement, 1400 - 1214, rounded(whole["value"]), interval(whole), judged, trials=whole["n"], note=note)


def _arrows(runs: Section) -> str:
    return " → ".join(f"{run['median']['value']:.0f}" for run in runs.values())


def optimum(figures: Section) -> Iterator[Claim]:
    """How near the optimum the medians are: the paper's figure of it is not to be had."""
    runs = figures.get("completion")
    found = ", ".join(f"{_beyond_optimum(run):.2f}" for run in runs.values()) if runs else None
    note = "median of steps over optimal steps, 20 to 80 robots; the paper's own optimum is only in its figure"
    yield Claim(reference.statement("optimum"), "not in the text", found, None, verdict.CANNOT_SAY, note=note)


def _beyond_optimum(run: Section) -> float:
    pairs = zip(run["steps"], run["optimum"]["same_robot"], strict=True)
    ratios = sorted(math.inf if steps is None else steps / optimal for steps, optimal in pairs)
    return ratios[len(ratios) // 2]


def fault_curves(figures: Section) -> dict[str, Section]:
    """The curves of 40 and of 80 robots, by share."""
    return figures.get("faults", {}).get(CURVE, {})


def fault_medians(figures: Section) -> Iterator[Claim]:
    """Median steps at a share of 0.7."""
    for (robots, share), paper in reference.faults().items():
        name = f"median steps at a share of {share} fallible robots, {robots} robots, 2 links"
        point, kind = fault_curves(figures).get(robots, {}).get(share), CALIBRATED if robots == "40" else PREDICTION
        if point is None:
            yield unsaid(name, paper, "not run", kind)
            continue
        note = "hazard 0.0003 a step is fitted on this" if kind == CALIBRATED else ""
        yield from_number(name, paper, point["median"], kind, note)


def per_swarm(
    figures: Section, key: str, judge: Callable[[Section], tuple[Estimate, str, str]], paper: float | str
) -> Iterator[Claim]:
    """A statement about each curve of failures: `judge` makes estimate, verdict and note of one."""
    for robots in ("40", "80"):
        name, curve = f"{reference.statement(key)}, {robots} robots", fault_curves(figures).get(robots)
        if curve is None:
            yield unsaid(name, paper, "not run")
            continue
        ours, judged, note = judge(curve)
        yield Claim(name, paper, rounded(ours["value"]), interval(ours), judged, trials=ours["n"], note=note)


def same_up_to_02(figures: Section) -> Iterator[Claim]:
    """Medians up to a share of 0.2: against that without failures, and 80 robots against 40."""

    def judge(curve: Section) -> tuple[Estimate, str, str]:
        ratios = [ratio(curve[share]["median"], curve["0.0"]["median"]) for share in ("0.1", "0.2")]
        return ratios[-1], verdict.every([verdict.same(each) for each in ratios]), "median at 0.2 over that at 0"

    yield from per_swarm(figures, "same_to_02", judge, "almost identical")
    name = f"{reference.statement('same_to_02')}, 80 against 40 robots"
    curves = fault_curves(figures)
    if not curves:
        yield unsaid(name, "almost identical", "not run")
        return
    ratios = [ratio(curves["80"][share]["median"], curves["40"][share]["median"]) for share in ("0.0", "0.1", "0.2")]
    judged, last = verdict.every([verdict.same(each) for each in ratios]), ratios[-1]
    note = "median of 80 over that of 40 at 0.2: the other way to read the sentence"
    yield Claim(name, "almost identical", rounded(last["value"]), interval(last), judged, trials=last["n"], note=note)


def time_grows(figures: Section) -> Iterator[Claim]:
    """Whether failures take time."""

    def judge(curve: Section) -> tuple[Estimate, str, str]:
        more = difference(curve["0.7"]["median"], curve["0.0"]["median"])
        return more, verdict.above(more), "steps more at 0.7 than at 0"

    yield from per_swarm(figures, "grows", judge, "grows")


def eighty_slower(figures: Section) -> Iterator[Claim]:
    """Whether 80 robots take longer than 40 at a share of 0.7."""
    statement, curves = reference.statement("eighty_slower"), fault_curves(figures)
    if not curves:
        yield unsaid(statement, 2125 - 2067, "not run")
        return
    more = difference(curves["80"]["0.7"]["median"], curves["40"]["0.7"]["median"])
    note = "steps more at a share of 0.7"
    value, judged = rounded(more["value"]), verdict.above(more)
    yield Claim(statement, 2125 - 2067, value, interval(more), judged, trials=more["n"], note=note)


def survives(figures: Section) -> Iterator[Claim]:
    """Whether most missions complete at a share of 0.7: the paper has a median there."""

    def judge(curve: Section) -> tuple[Estimate, str, str]:
        point = curve["0.7"]
        done = wilson(point["completed"], point["trials"])
        failed = point["failures"]
        note = "share of missions completed; agrees if surely more than half"
        if failed:
            note += f"; {sum(failed) / len(failed):.1f} robots failed a mission, whose backbone takes 21"
        return done, verdict.above(done, 0.5), note

    yield from per_swarm(figures, "survives", judge, "up to 70 %")


def failures_grow(figures: Section) -> Iterator[Claim]:
    """Whether more missions fail the larger the share is."""

    def judge(curve: Section) -> tuple[Estimate, str, str]:
        more = difference(curve["0.9"]["failed_ratio"], curve["0.0"]["failed_ratio"])
        return more, verdict.above(more), "share of failed missions at 0.9 less that at 0"

    yield from per_swarm(figures, "failures_grow", judge, "grows")


def connected(figures: Section) -> Iterator[Claim]:
    """Whether λ₂ stays above zero in every trial of every configuration."""
    statement, runs = reference.statement("connected"), figures.get("connectivity")
    if not runs:
        yield unsaid(statement, "> 0", "not run")
        return
    trials = sum(run["run"]["trials"] for run in runs.values())
    always = wilson(sum(run["connected_trials"] for run in runs.values()), trials)
    least = min(run["least_of_all"] for run in runs.values())
    judged = verdict.AGREES if least > 0 else verdict.DIFFERS
    note = f"share of trials connected in every sample, five configurations; least λ₂ of all {least:.2f}"
    yield Claim(statement, "> 0", rounded(always["value"]), interval(always), judged, trials=trials, note=note)


def orders_of_lambda2(figures: Section) -> Iterator[Claim]:
    """Large while clustered, near zero with a single link, higher with more links."""
    keys, runs = ("clustered", "single_link", "more_links"), figures.get("connectivity")
    if not runs:
        yield from (unsaid(reference.statement(key), "in words", "not run") for key in keys)
        return
    falling = [ratio(run["first"], run["last"]) for run in runs.values()]
    least_fall = min(falling, key=lambda each: each["value"] or 0.0)
    near_zero = ratio(runs[LONE_LINK]["least"], runs[LONE_LINK]["first"])
    by_links = [runs[label]["least"] for label in reference.completion()]
    steps = [difference(b, a) for a, b in zip(by_links, by_links[1:], strict=False)]
    least_step = min(steps, key=lambda each: each["value"] or 0.0)
    found = (
        (least_fall, verdict.every([verdict.above(each, 1.0) for each in falling]), "start over end, least of five"),
        (near_zero, verdict.below(near_zero, NEAR_ZERO), f"least over start; near means below {NEAR_ZERO}"),
        (least_step, verdict.every([verdict.above(each) for each in steps]), _least_values(by_links)),
    )
    for key, (ours, judged, note) in zip(keys, found, strict=True):
        value = rounded(ours["value"])
        yield Claim(reference.statement(key), "in words", value, interval(ours), judged, trials=ours["n"], note=note)


def _least_values(of: list[Estimate]) -> str:
    return "least rise a link; median of least λ₂, 1 to 4 links: " + ", ".join(f"{each['value']:.2f}" for each in of)


def bandwidth_numbers(figures: Section) -> Iterator[Claim]:
    """Least, most and median bytes, at face value: sent or received, with headers."""
    paper, runs, keys = reference.bandwidth(), figures.get("bandwidth"), ("min", "max", "median")
    for reading in MAIN_READINGS:
        names = [f"bytes a step, {statistic}, {reading}" for statistic in ("least of 10 robots", "most of 100 robots")]
        names.append(f"bytes a step, median of every configuration, {reading}")
        if not runs:
            yield from (unsaid(name, paper[key], "not run") for name, key in zip(names, keys, strict=True))
            continue
        yield from_number(names[0], paper["min"], runs["10"]["readings"][reading]["of_a_trial"]["min"])
        yield from_number(names[1], paper["max"], runs["100"]["readings"][reading]["of_a_trial"]["max"])
        yield _every_median(names[2], paper["median"], [run["readings"][reading] for run in runs.values()])


def _every_median(name: str, paper: float, readings: list[Section]) -> Claim:
    of = [reading["of_a_trial"]["median"] for reading in readings]
    values = [each["value"] for each in of]
    judged = verdict.every([verdict.number(each, paper, 2 * verdict.MARGIN) for each in of])
    span = estimate(None, min(values), max(values), of[0]["n"])
    note = "least and greatest of ten medians; the margin is doubled, the paper says about"
    found = f"{min(values):,.3g} to {max(values):,.3g}"
    return Claim(name, paper, found, interval(span), judged, trials=span["n"], note=note)


def nearest_reading(figures: Section) -> Iterator[Claim]:
    """Which way to count comes nearest to all three of the paper's numbers."""
    name, paper = "reading of bandwidth nearest to 17, 100 and 174 bytes", "not stated"
    runs = figures.get("bandwidth")
    if not runs:
        yield unsaid(name, paper, "not run")
        return
    off = {reading: misfit(runs, reading) for reading in runs["10"]["readings"]}
    best = min(off, key=lambda reading: off[reading])
    note = f"its worst number is off by a factor of {off[best]:.1f}; all readings are in results/paper/README.md"
    yield Claim(name, paper, best, None, verdict.CANNOT_SAY, note=note)


def misfit(runs: Section, reading: str) -> float:
    """The largest factor between a reading and the paper: least of 10 robots, most of 100, median of each."""
    paper = reference.bandwidth()
    few, many = (runs[robots]["readings"][reading] for robots in ("10", "100"))
    pairs = [(few["min"], paper["min"]), (many["max"], paper["max"])]
    pairs += [(run["readings"][reading]["median"], paper["median"]) for run in runs.values()]
    return max(max(ours / theirs, theirs / ours) if ours > 0 else math.inf for ours, theirs in pairs)


def topic_order(figures: Section) -> Iterator[Claim]:
    """Which messages cost most."""
    statement, runs = reference.statement("topics"), figures.get("bandwidth")
    for reading in MAIN_READINGS:
        name = f"{statement} ({reading})"
        if not runs:
            yield unsaid(name, " > ".join(TOPICS), "not run")
            continue
        orders = {robots: _order(run["readings"][reading]["topics"]) for robots, run in runs.items()}
        judged = verdict.AGREES if all(order == TOPICS for order in orders.values()) else verdict.DIFFERS
        found = sorted(set(orders.values()), key=lambda order: -list(orders.values()).count(order))
        shown = " or ".join(" > ".join(order) for order in found)
        yield Claim(name, " > ".join(TOPICS), shown, None, judged, trials=runs["10"]["run"]["trials"])


def _order(topics: dict[str, float]) -> tuple[str, ...]:
    return tuple(sorted(topics, key=lambda topic: -topics[topic]))


def requests_need_neighbours(figures: Section) -> Iterator[Claim]:
    """Whether a robot among more neighbours hears more requests and responses."""
    statement, runs = reference.statement("neighbours"), figures.get("bandwidth")
    if not runs:
        yield unsaid(statement, "grows", "not run")
        return
    few, many = (runs[robots]["readings"][REQUESTS]["of_a_trial"]["median"] for robots in ("20", "100"))
    more = ratio(many, few)
    note = f"bytes received at {runs['100']['neighbours']:.0f} neighbours over those at {runs['20']['neighbours']:.0f}"
    value, judged = rounded(more["value"]), verdict.above(more, 1.0)
    yield Claim(statement, "grows", value, interval(more), judged, trials=more["n"], note=note)


CLAIMS: tuple[Callable[[Section], Iterator[Claim]], ...] = (
    reached,
    medians,
    falls,
    optimum,
    bandwidth_numbers,
    nearest_reading,
    topic_order,
    requests_need_neighbours,
    connected,
    orders_of_lambda2,
    fault_medians,
    same_up_to_02,
    time_grows,
    eighty_slower,
    survives,
    failures_grow,
)

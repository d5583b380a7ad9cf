#!/usr/bin/env python3
"""Recomputes summary.json of a results folder from its Parquet files alone, and fails on any disagreement.

    python analysis/recompute_summary.py results/quickstart...

Written from results/README.md and the papers that it names, not from the simulator's code, and by other means where there are any: the
Kaplan-Meier curve and its band are SciPy's, the median is taken where exact fractions say that the curve is at or below one half, what a
trial adds to a mean of times is the derivative of the curve's area by that trial's weight, Wilson's, Hall's and the Poisson limits are
roots and quantiles found by SciPy and NumPy.

Three things repeat desim's choices and would not show a wrong one: which interval a figure has, the levels of few trials and of times (`TAILS`), and
Cochran's residuals of a ratio of sums.
"""

import json
import math
import pathlib
import statistics
import sys
import warnings
from fractions import Fraction

import numpy as np
import polars as pl
import xxhash
from scipy.optimize import brentq
from scipy.stats import CensoredData, binom, chi2, ecdf, norm
from scipy.stats import t as student

from paper.statistics import estimate

TOLERANCE = 1e-12
"""Of values: sums are rounded in another order here."""
INTERVAL_TOLERANCE = 1e-6
"""Of ends of intervals: distributions are computed to some nine digits on either side."""
TAILS = {2: 0.0175, 3: 0.006, 4: 0.015, 5: 0.02, 6: 0.0225}
"""What the intervals of means from so few trials leave out on either side."""
WHY = ("no_worker", "held_up", "on_its_way", "links_short", "too_late")


def total(values):
    """The sum in order. Python's own corrects rounding on the way, from version 3.12 on."""
    result = 0.0
    for value in values:
        result += value
    return result


def at_least_0(estimated, most=math.inf):
    ends = (None if end is None else min(max(end, 0.0), most) for end in estimated["ci95"])
    return estimate(estimated["value"], *ends, estimated["n"])


class Moments:
    """Variance and skewness of an estimate, from what each trial adds to it."""

    def __init__(self, terms):
        self.n = n = len(terms)
        power = [total(term**k for term in terms) for k in range(4)]
        self.variance = power[2] * n / (n - 1) if n > 1 else None
        self.third = power[3] * n * n / ((n - 1) * (n - 2)) if n > 2 else 0.0


def terms_of(parts, value):
    watched = total(b for _, b in parts)
    return [(a - value * b) / watched for a, b in parts if a or b]


def hall(value, moments, most=1.0):
    """Hall's interval (1992): the cubic that makes a skewed Student's t nearly symmetric, solved for the ends."""
    error = math.sqrt(moments.variance)
    skewness = moments.third / error**3
    quantile = student.ppf(1 - min(TAILS.get(moments.n, 0.025), most), moments.n - 1)

    def shift(wanted):
        def cubic(t):
            return t + skewness * t * t / 3 + skewness**2 * t**3 / 27 + skewness / 6 - wanted

        return brentq(cubic, -1e9, 1e9, xtol=1e-12, rtol=1e-14, maxiter=1000)

    return value - error * shift(quantile), value - error * shift(-quantile)


def score(share, n, z):
    """Wilson's limits: the shares that are z standard errors from the one seen."""
    low, high = sorted(np.roots([n + z * z, -(2 * n * share + z * z), n * share * share]).real)
    return (0.0 if share <= 0 else low), (1.0 if share >= 1 else high)


def ratio(parts, kind):
    """The ratio of two sums over trials, with the interval of its kind."""
    n = sum(1 for a, b in parts if a or b)
    watched = total(b for _, b in parts)
    if watched <= 0:
        return estimate(None, n=n)
    value = total(a for a, _ in parts) / watched
    terms = terms_of(parts, value)
    z = norm.ppf(0.975)
    if kind == "share" and all(b == 0 or (b == 1 and a in (0, 1)) for a, b in parts):
        return estimate(value, *score(value, n, z), n)
    if len(terms) < 2:
        return estimate(value, n=n)
    moments = Moments(terms)
    flat = all(abs(term) < 1e-15 * max(abs(value), 1e-300) for term in terms)
    inflation = (student.ppf(0.975, n - 1) / z) ** 2
    if kind in ("mean", "signed", "fraction", "count"):
        if flat:
            ends = (value, value) if kind != "count" else (None, None)
        else:
            ends = hall(value, moments)
        if kind == "signed":
            return estimate(value, *ends, n)
        return at_least_0(estimate(value, *ends, n), 1.0 if kind == "fraction" else math.inf)
    if kind == "rate":
        events = total(a for a, _ in parts)
        if events == 0:
            return estimate(value, 0.0, chi2.ppf(0.975, 2) / 2 / watched, n)
        effective = events / max(1.0, moments.variance * inflation * watched / value)
        limits = chi2.ppf(0.025, 2 * effective) / 2, chi2.ppf(0.975, 2 * effective + 2) / 2
        return estimate(value, *(value * limit / effective for limit in limits), n)
    things = watched if kind == "share of things" else None
    if all(b == 0 or (b == 1 and a in (0, 1)) for a, b in parts):
        return estimate(value, *score(value, n, z), n)
    if value in (0.0, 1.0):
        return estimate(value, *score(value, things or n, z), n)
    most = things * inflation if things else math.inf
    effective = most if flat else min(most, value * (1 - value) / moments.variance)
    if effective == math.inf:
        return estimate(value, n=n)
    return estimate(value, *score(value, effective, student.ppf(1 - max(TAILS.get(n, 0.025), TAILS[2]), n - 1)), n)


def inverse(estimated):
    low, high = (None if end is None or end == 0 else 1 / end for end in estimated["ci95"])
    return estimate(1 / estimated["value"] if estimated["value"] else None, high, low, estimated["n"])


def plain(values):
    return [(value, 1.0) if value is not None else (0.0, 0.0) for value in values]


def mean(values, kind="mean"):
    return ratio(plain(values), kind)


def quantile(ordered, q):
    if not ordered:
        return None
    rank = (len(ordered) - 1) * q
    below, above = ordered[math.floor(rank)], ordered[math.ceil(rank)]
    return below + (above - below) * (rank - math.floor(rank))


def median(values):
    ordered = sorted(value for value in values if value is not None)
    n = len(ordered)
    ranks = [k for k in range(1, n + 1) if binom.cdf(k - 1, n, 0.5) <= 0.025]
    low, high = (ordered[ranks[-1] - 1], ordered[n - ranks[-1]]) if ranks else (None, None)
    return estimate(quantile(ordered, 0.5), low, high, n)


def survival(times):
    """SciPy's Kaplan-Meier curve of (time, happened) pairs."""
    done = [float(time) for time, happened in times if happened]
    cut = [float(time) for time, happened in times if not happened]
    data = CensoredData(uncensored=done, right=cut)
    return ecdf(data).sf


def kaplan_meier(times):
    """The median of (time, happened) pairs: the middle of the stretch on which the curve is exactly one half. From six on with the interval
    of Brookmeyer and Crowley under the log(-log) transform."""
    n = len(times)
    events = sorted({float(time) for time, happened in times if happened})
    left, middle = Fraction(1), None
    for place, event in enumerate(events):
        at_risk = sum(1 for time, _ in times if time >= event)
        left *= 1 - Fraction(sum(1 for time, happened in times if happened and time == event), at_risk)
        if 2 * left <= 1:
            later = events[place + 1] if place + 1 < len(events) else max(float(time) for time, _ in times)
            middle = (event + later) / 2 if 2 * left == 1 else event
            break
    low = high = None
    if n >= 6 and events:
        curve = survival(times)
        with warnings.catch_warnings():
            # Where nobody is left, it says that it says nothing.
            warnings.simplefilter("ignore", RuntimeWarning)
            band = curve.confidence_interval(0.95, method="log-log")

        def first(end):
            within = (end.probabilities <= 0.5) & (curve.probabilities > 1e-12) & np.isin(curve.quantiles, events)
            return float(curve.quantiles[within][0]) if within.any() else None

        low, high = first(band.low), first(band.high)
    return estimate(middle, low, high, n)


def mean_time(trials):
    """The mean of times of which some were cut off, a list of (time, happened) pairs a trial: the area under the Kaplan-Meier curve, up to the
    longest time if that was cut off. What a trial adds is the area's derivative by the trial's weight, taken by a complex step."""
    pairs = [pair for trial in trials for pair in trial]
    cut_off = sum(1 for _, happened in pairs if not happened)
    n = sum(1 for trial in trials if trial)
    longest = max((float(time) for time, _ in pairs), default=0.0)
    over = any(happened and time == longest for time, happened in pairs) and not any(
        not happened and time == longest for time, happened in pairs
    )
    restricted = None if over or not pairs else longest
    extra = {"cut_off": cut_off, "restricted_to": restricted}
    if cut_off == len(pairs):
        return {**estimate(None), **extra}
    curve = survival(pairs)
    edges = np.concatenate([[0.0], curve.quantiles])
    value = float(np.sum(np.diff(edges) * np.concatenate([[1.0], curve.probabilities[:-1]])))
    if n < 2:
        return {**estimate(value, n=n), **extra}
    times = np.array([time for time, _ in pairs], dtype=float)
    done = np.array([happened for _, happened in pairs])
    owner = np.concatenate([np.full(len(trial), number) for number, trial in enumerate(trials)])
    places = np.searchsorted(curve.quantiles, times)

    def area(weights):
        size = len(curve.quantiles)
        lost, ended = np.zeros(size, dtype=complex), np.zeros(size, dtype=complex)
        np.add.at(lost, places, weights)
        np.add.at(ended, places[done], weights[done])
        at_risk = np.cumsum(lost[::-1])[::-1]
        left = np.cumprod(1 - ended / at_risk)
        return np.sum(np.diff(edges) * np.concatenate([[1.0], left[:-1]]))

    step = 1e-30
    terms = [area(1 + 1j * step * (owner == trial)).imag / step for trial in range(len(trials)) if trials[trial]]
    moments = Moments(terms)
    ends = hall(value, moments, most=0.018) if moments.variance > 0 else (None, None)
    return {**at_least_0(estimate(value, *ends, n)), **extra}


def gini(values):
    ordered, n = sorted(values), float(len(values))
    whole = total(ordered)
    ranked = total(float(rank) * value for rank, value in enumerate(ordered, 1))
    return max(2.0 * ranked / (n * whole) - (n + 1.0) / n, 0.0) if whole > 0 else None


class Folder:
    """The tables of a results folder."""

    def __init__(self, path):
        self.path = path
        self.trials = self.table("trials").sort("trial")
        self.frames = self.table("frames")
        self.bandwidth = self.table("bandwidth")
        self.latency = self.table("latency")
        self.connectivity = self.table("connectivity")
        self.faults = self.table("faults")
        self.healing = self.table("healing")
        self.detection = self.table("detection")
        self.rumors = self.table("spread")
        self.robots = self.table("robots").sort("trial", "robot")
        self.topics = self.frames["topic"].unique(maintain_order=True).to_list()
        prefix = "robots_"
        self.roles = [c.removeprefix(prefix) for c in self.connectivity.columns if c.startswith(prefix)]
        self.causes = [c.removeprefix("lost_") for c in self.frames.columns if c.startswith("lost_")]

    def table(self, name):
        return pl.read_parquet(self.path / f"{name}.parquet")

    def per_step(self, rows, headers=True):
        """Bytes a control step of every robot, trial by trial; a robot without rows has 0."""
        size = pl.col("payload_bytes") + pl.col("header_bytes") if headers else pl.col("payload_bytes")
        sums = rows.group_by("trial", "robot").agg(size.sum().alias("bytes"))
        joined = self.robots.join(sums, on=["trial", "robot"], how="left", maintain_order="left")
        joined = joined.with_columns(cost=pl.col("bytes").fill_null(0) / pl.max_horizontal("steps", 1))
        return joined.group_by("trial", maintain_order=True).agg("cost")["cost"].to_list()

    def spread(self, rows, headers=True):
        trials = self.per_step(rows, headers)
        pooled = sorted(value for robots in trials for value in robots)
        return {
            "min": pooled[0],
            "median": quantile(pooled, 0.5),
            "p95": quantile(pooled, 0.95),
            "max": pooled[-1],
            "mean": mean([mean(robots)["value"] for robots in trials]),
        }

    def directions(self, rows):
        sent, received = (rows.filter(direction=direction) for direction in ("tx", "rx"))
        return {
            "tx_bytes_per_step": self.spread(sent),
            "rx_bytes_per_step": self.spread(received),
            "tx_payload_bytes_per_step": self.spread(sent, headers=False),
            "rx_payload_bytes_per_step": self.spread(received, headers=False),
        }

    def of_topic(self, topic):
        rows = self.bandwidth.filter(topic=topic)
        sent = rows.filter(direction="tx")
        headers, payload = sent["header_bytes"].sum(), sent["payload_bytes"].sum()
        return {
            **self.directions(rows),
            "lost_bytes_per_step": self.spread(rows.filter(pl.col("direction").str.starts_with("lost_"))),
            "header_share": {"value": headers / (headers + payload) if headers + payload else None},
        }

    def fates(self, rows):
        counts = {fate: rows[fate].sum() for fate in ("offered", "delivered", "in_flight")}
        lost = {cause: rows[f"lost_{cause}"].sum() for cause in self.causes}
        assert counts["offered"] == counts["delivered"] + counts["in_flight"] + sum(lost.values()), "a copy has no fate"
        return {**counts, "lost": lost}

    def deliveries(self):
        """Copies delivered, or that will be as far as they are lost by then, and copies offered, of each trial."""
        for trial in self.trials["trial"]:
            rows = self.frames.filter(trial=trial)
            offered, delivered, under_way = (rows[fate].sum() for fate in ("offered", "delivered", "in_flight"))
            arrived = delivered + rows["lost_receiver_down"].sum()
            yield delivered + under_way * (delivered / arrived if arrived else 1.0), offered

    def latencies(self):
        buckets = self.latency.group_by("low_ns", "high_ns").agg(pl.col("count").sum()).sort("low_ns").rows()
        count = sum(bucket[2] for bucket in buckets)
        least, most = self.trials["latency_min_ns"].min(), self.trials["latency_max_ns"].max()

        def at(q):
            below = 0
            for low, high, held in buckets:
                below += held
                if below >= min(max(math.ceil(q * count), 1), count):
                    return min(max(low + (high - low) // 2, least), most) / 1e9
            return None

        counts = dict(self.latency.group_by("trial").agg(pl.col("count").sum()).iter_rows())
        sums = self.trials.select("trial", "latency_sum_ns").iter_rows()
        means = [nanos / counts[trial] / 1e9 if trial in counts else None for trial, nanos in sums]
        return {"p50": at(0.5), "p95": at(0.95), "p99": at(0.99), "mean": mean(means)}

    def samples(self, figure):
        """A figure of each trial's connectivity samples, `None` where there are none."""
        for trial in self.trials["trial"]:
            rows = self.connectivity.filter(trial=trial)
            yield figure(rows) if len(rows) else None

    def completion(self):
        """Steps to completion, or the steps watched in vain, of trials with a mission."""
        rows = self.trials.select("outcome", "steps_to_completion", "steps").iter_rows()
        times = {"completed": lambda done, _: (done, True), "censored": lambda _, steps: (steps, False)}
        return [times[outcome](done, steps) for outcome, done, steps in rows if outcome != "no_mission"]

    def missed(self):
        """Why missions failed, if any did: the targets that were missed, and what stood in the way."""
        targets = range(sum(column.startswith("target_") for column in self.connectivity.columns))
        failed = [row for row in self.trials.iter_rows(named=True) if row["outcome"] == "censored"]
        samples = {row["trial"]: self.connectivity.filter(trial=row["trial"]).rows(named=True) for row in failed}
        failed = [row for row in failed if samples[row["trial"]] and len(targets)]
        if not failed:
            return {}
        ailing = self.faults.filter(pl.col("robot").is_not_null() & pl.col("until_s").is_null())
        alive = [row["robots"] - ailing.filter(trial=row["trial"])["robot"].n_unique() for row in failed]
        misses = {}
        for row in failed:
            rows, end = samples[row["trial"]], row["simulated_s"]
            held = {k: [sample[f"target_{k}"] == "held" for sample in rows] for k in targets}
            kept = {k: ([False] + held[k])[::-1].index(False) for k in targets}
            never = [k for k in targets if not any(held[k])]
            loose = never or [k for k in targets if not held[k][-1]] or [min(targets, key=lambda k: kept[k])]
            for k in loose:
                misses.setdefault(k, []).append(miss(rows, end, k))
        found = []
        for k, of_target in sorted(misses.items()):
            middle = lambda key: statistics.median([v[key] for v in of_target if v[key] is not None] or [math.nan])
            maybe = lambda key: None if math.isnan(middle(key)) else middle(key)
            why = {name: sum(v["why"] == name for v in of_target) for name in WHY}
            found.append({"target": k, "trials": len(of_target), "missed_s": middle("missed_s"), "why": why,
                          **{key: maybe(key) for key in ("links", "nearest_m", "at_end_m")}})  # fmt: skip
        lasted = statistics.median(row["simulated_s"] for row in failed)
        return {"missed": {"failed": len(failed), "lasted_s": lasted, "robots_alive": statistics.median(alive), "targets": found}}

    def failures(self):
        """What failed, if anything did."""
        if self.faults.is_empty():
            return {}
        robots = self.faults.filter(pl.col("robot").is_not_null())
        failed = [float(robots.filter(trial=trial)["robot"].n_unique()) for trial in self.trials["trial"]]
        by_role = {role: len(robots.filter(role=role)) for role in self.roles}
        return {"faults": {"robots": mean(failed, "count"), "by_role": by_role, "links": len(self.faults) - len(robots)}}

    def healed(self, rows):
        mended = rows.filter(pl.col("healed_s").is_not_null())
        trials = self.trials["trial"]
        times = [
            list(rows.filter(trial=trial).select("watched_s", pl.col("healed_s").is_not_null()).iter_rows()) for trial in trials
        ]

        def meanwhile(column):
            chosen = [mended.filter(trial=trial)[column].to_list() for trial in trials]
            return ratio([(total(values), float(len(values))) for values in chosen], "count")

        frames = {topic: meanwhile(f"{topic.replace(' ', '_')}_frames") for topic in self.topics}
        return {
            "failures": len(rows),
            "healed": len(mended),
            "time": {"median": kaplan_meier([pair for trial in times for pair in trial]), "mean": mean_time(times)},
            "distance": meanwhile("distance_m"),
            "frames": frames,
        }

    def mending(self):
        """How targets got their links back, if a robot failed that worked for one."""
        if self.healing.is_empty():
            return {}
        harmless = self.healing.filter(pl.col("healed_s").eq_missing(pl.col("failed_s")))
        harmful = self.healing.filter(pl.col("healed_s").ne_missing(pl.col("failed_s")))
        alone = pl.col("overlapping") == 0
        by_overlap = {"alone": self.healed(harmful.filter(alone)), "overlapping": self.healed(harmful.filter(~alone))}
        by_role = {role: self.healed(harmful.filter(role=role)) for role in self.roles}
        whole = {**self.healed(harmful), "harmless": len(harmless), "by_role": by_role, "by_overlap": by_overlap}
        return {"healing": whole}

    def spreading(self):
        """How rumours spread over the robots that nothing ails at the end, if there were any."""
        if self.rumors.is_empty():
            return {}
        trials = []
        for trial, end in self.trials.select("trial", "simulated_s").iter_rows():
            ailing = self.faults.filter(pl.col("trial") == trial, pl.col("until_s").is_null())["robot"].drop_nulls()
            pairs = self.rumors.filter(pl.col("trial") == trial, ~pl.col("robot").is_in(ailing.to_list()))
            trials.append((len(pairs), sorted(pairs["informed_s"].drop_nulls()), end))

        def until(wanted):
            times = [(known[n - 1], True) if n <= len(known) else (end, False) for n, known, end in wanted]
            complete = all(done for _, done in times)
            return {"median": kaplan_meier(times), "mean": mean([t for t, _ in times] if complete else [], "count")}

        spread = {
            "informed_ratio": mean([len(known) / count for count, known, _ in trials], "share"),
            "time_to_half": until([((count + 1) // 2, known, end) for count, known, end in trials]),
            "time_to_all": until(trials),
        }
        return {"spread": spread}

    def heard_in_vain(self):
        """Messages that told their receiver nothing new, in those delivered."""
        counted = self.bandwidth.filter(pl.col("direction").is_in(["rx", "duplicate"]))

        def share(rows):
            grouped = rows.group_by("trial", "direction").agg(pl.sum("frames"))
            sums = {(trial, direction): frames for trial, direction, frames in grouped.iter_rows()}
            of = [tuple(sums.get((trial, way), 0) for way in ("duplicate", "rx")) for trial in self.trials["trial"]]
            return ratio(of, "share of things")

        by_topic = {topic: share(counted.filter(topic=topic)) for topic in self.topics}
        return {"duplicates": {**share(counted), "by_topic": by_topic}}

    def failure_detection(self):
        suspicions = self.detection.filter(event="suspicion")
        failures = self.detection.filter(event="failure")
        mistakes = suspicions.filter(verdict="mistake")
        causes = ["failure", *self.causes, "out_of_range", "latency", "not_sent"]
        verdicts = ["right", "mistake", "out_of_range", "observer"]

        def of_trials(rows, figure):
            return [figure(rows.filter(trial=trial)) for trial in self.trials["trial"]]

        monitored, mistaken = self.trials["monitored_s"].to_list(), self.trials["mistaken_s"].to_list()
        made = of_trials(mistakes, lambda rows: float(len(rows)))
        rate = ratio(list(zip(made, monitored)), "rate")
        right = ratio([(seen - wrong, seen) for wrong, seen in zip(mistaken, monitored)], "share")
        lasted = pl.col("mistake_duration_s"), pl.col("mistake_cut_off") == 0
        watched = pl.col("watched_s"), pl.col("verdict") == "detected"
        outcomes = ("detected", "recovered", "observer_failed", "undetected")
        # Probes are no cause where nobody probes.
        causes += sorted(set(suspicions["cause"]) & {"unanswered"})
        assert set(suspicions["cause"]) <= set(causes) and set(failures["verdict"]) <= set(outcomes)
        return {
            "suspicions": {
                "value": len(suspicions),
                "by_cause": {cause: len(suspicions.filter(cause=cause)) for cause in causes},
                "by_verdict": {verdict: len(suspicions.filter(verdict=verdict)) for verdict in verdicts},
            },
            "mistakes": {"value": len(mistakes)},
            "failures": {
                "observed": len(failures),
                **{outcome: len(failures.filter(verdict=outcome)) for outcome in outcomes},
            },
            "detection_time_s": mean_time(of_trials(failures, lambda rows: list(rows.select(*watched).iter_rows()))),
            "mistake_recurrence_s": inverse(rate),
            "mistake_duration_s": mean_time(of_trials(mistakes, lambda rows: list(rows.select(*lasted).iter_rows()))),
            "mistake_rate_hz": rate,
            "query_accuracy": right,
            "monitored_s": {"value": total(monitored)},
        }

    def summary(self):
        times = self.completion()
        completed = sum(done for _, done in times)
        digests = b"".join(int(digest, 16).to_bytes(16, "little") for digest in self.trials["digest"])
        least = list(self.samples(lambda rows: rows.filter((pl.col("components") > 1) | (pl.col("lambda2") > 0))["lambda2"].min()))
        sent, received = (self.per_step(self.bandwidth.filter(direction=d)) for d in ("tx", "rx"))
        return {
            "trials": len(self.trials),
            "completed": completed,
            "digest": xxhash.xxh3_128_hexdigest(digests),
            "completion_ratio": mean([float(done) for _, done in times], "share"),
            "steps_to_completion": {"median": kaplan_meier(times)},
            "frames": {
                **self.fates(self.frames),
                "by_topic": {topic: self.fates(self.frames.filter(topic=topic)) for topic in self.topics},
            },
            "delivery_ratio": ratio(list(self.deliveries()), "share of things"),
            "latency_s": self.latencies(),
            "bandwidth": {
                **self.directions(self.bandwidth),
                "by_topic": {topic: self.of_topic(topic) for topic in self.topics},
                "by_role": {role: self.directions(self.bandwidth.filter(role=role)) for role in self.roles},
            },
            "load_imbalance": {
                way: mean([gini(trial) for trial in trials], "fraction") for way, trials in (("tx", sent), ("rx", received))
            },
            "lambda2_min": {**median(least), "min": min((v for v in least if v is not None), default=None)},
            "connected_share": mean(list(self.samples(lambda rows: (rows["components"] == 1).sum() / live if (live := (rows["components"] > 0).sum()) else None)), "share"),
            "robots_used": mean([None if n is None else float(n) for n in self.trials["robots_used"]], "count"),
            **self.missed(),
            **self.failures(),
            **self.mending(),
            **self.spreading(),
            **self.heard_in_vain(),
            "detection": self.failure_detection(),
            "steps": {"value": self.trials["steps"].sum()},
            "simulated_s": {"value": total(self.trials["simulated_s"])},
            **self.further(),
            **self.air(),
        }

    def further(self):
        """The figures of the general list that a trial has."""
        period = self.trials["control_period_s"][0]
        in_range = self.samples(lambda rows: math.fsum(live) / len(live) if len(live := rows.filter(pl.col("components") > 0)["neighbours"]) else None)
        rows = self.trials.select("outcome", "steps_to_completion", "simulated_s").iter_rows()
        times = [(done * period, True) if outcome == "completed" else (end, False) for outcome, done, end in rows if outcome != "no_mission"]
        cut_off = sum(not done for _, done in times)
        found = {
            "completion_s": {**mean([seconds for seconds, _ in times], "count"), **({"cut_off": cut_off} if cut_off else {})},
            "neighbours": mean(list(in_range), "mean"),
            "spread.hops": ratio([self.hops(trial) for trial in self.trials["trial"]], "mean"),
            **self.pairs(),
        }
        known = {key: figure for key, figure in found.items() if figure["value"] is not None}
        return {"figures": known} if known else {}


    def hops(self, trial):
        """The hops that rumours came over to robots that had them from others in a trial, and how many these are."""
        hops = self.rumors.filter(pl.col("trial") == trial, pl.col("hops") > 0)["hops"]
        return hops.sum(), len(hops)

    def air(self):
        """What radios did, over one on which frames take time."""
        if not (self.path / "radio.parquet").exists():
            return {}
        robots, waits = self.table("radio"), self.table("waits") if (self.path / "waits.parquet").exists() else None
        trials = [(robots.filter(trial=trial), seconds) for trial, seconds in self.trials.select("trial", "simulated_s").iter_rows()]

        def share(column):
            return mean([mean([value / seconds for value in rows[column]])["value"] for rows, seconds in trials], "fraction")

        def wait(column):
            means = [rows[column].sum() / rows["on_air"].sum() if rows["on_air"].sum() else None for rows, _ in trials]
            return mean(means, "mean")

        def late(trial):
            rows = robots.filter(trial=trial)
            least, most = rows["access_delay_min_s"].min(), rows["access_delay_max_s"].max()
            if least is None:
                return None
            least, most = round(least * 1e9), round(most * 1e9)
            buckets = waits.filter(trial=trial, wait="access").sort("low_ns").select("low_ns", "high_ns", "count").rows()
            rank, below = math.ceil(0.95 * sum(held for *_, held in buckets)), 0
            for low, high, held in buckets:
                below += held
                if below >= rank:
                    return min(max(low + (high - low) // 2, least), most) / 1e9

        def of_sums(part, whole, kind):
            return ratio([(rows[part].sum() if isinstance(part, str) else part(rows), whole(rows)) for rows, _ in trials], kind)

        def heard(rows):
            known = [(count, power) for count, power in rows.select("delivered", "delivered_power_dBm_mean").iter_rows() if power is not None]
            weight = sum(count for count, _ in known)
            return total(count * power for count, power in known) / weight if weight else None

        delivered = dict(self.frames.group_by("trial").agg(pl.col("delivered").sum()).iter_rows())
        states = [column for column in robots.columns if column.startswith("energy_")]
        spent = [[total(row) for row in rows.select(states).iter_rows()] for rows, _ in trials]
        causes = [column for column in robots.columns if column.startswith("dropped_")]
        payload = self.bandwidth.filter(direction="rx").group_by("trial").agg(pl.col("payload_bytes").sum())
        payload = dict(payload.iter_rows())
        rates = [8 * payload.get(trial, 0) / seconds for trial, seconds in self.trials.select("trial", "simulated_s").iter_rows()]
        energy = mean([mean(each)["value"] if any(each) else None for each in spent], "mean")
        by_state = {column.removeprefix("energy_").removesuffix("_J"): total(robots[column]) / len(robots) for column in states}
        counts = ("frames", "on_air", "attempts", "acknowledged", "unacknowledged")
        return {
            "goodput_bps": mean(rates, "mean"),
            "radio": {
                "airtime_share": share("sent_s"),
                "busy_share": share("busy_s"),
                "queue_wait_s": {"mean": wait("queue_wait_sum_s")},
                "access_delay_s": {"mean": wait("access_delay_sum_s"), "p95": mean([late(trial) for trial in self.trials["trial"]], "mean")},
                "attempts": of_sums("attempts", lambda rows: rows["on_air"].sum(), "mean"),
                "unacknowledged": of_sums("unacknowledged", lambda rows: rows["unacknowledged"].sum() + rows["acknowledged"].sum(), "share of things"),
                "dropped": of_sums(lambda rows: rows["frames"].sum() - rows["on_air"].sum(), lambda rows: rows["frames"].sum(), "share of things"),
                "strayed": of_sums("strayed", lambda rows: rows["strayed"].sum() + delivered[rows["trial"][0]], "share of things"),
                "energy_J": energy,
                "power_dBm": mean([heard(rows) for rows, _ in trials], "signed"),
                "sending": {**{name: robots[name].sum() for name in counts}, "dropped": {column.removeprefix("dropped_"): robots[column].sum() for column in causes}},
                **({"energy_by_state_J": by_state} if energy["value"] is not None else {}),
                "empty": {"value": robots["empty_s"].count()},
            },
        }

    def pairs(self):
        """Every measure of pairs: the mean over the pairs of a trial, and over trials."""
        if not (self.path / "pairs.parquet").exists():
            return {}
        pairs = self.table("pairs")
        measures = [name for name in pairs.columns if name not in ("trial", "sender", "receiver", "offered", "delivered")]

        def of(trial, measure):
            values = pairs.filter(trial=trial)[measure].drop_nulls()
            return math.fsum(values) / len(values) if len(values) else None

        return {f"pairs.{measure}": mean([of(trial, measure) for trial in self.trials["trial"]], "mean") for measure in measures}


def miss(rows, end, k):
    """A target that a failed trial missed: `rows` are the trial's samples."""
    state, metres = [row[f"target_{k}"] for row in rows], [row[f"worker_m_{k}"] for row in rows]
    nanos = [round(1e9 * seconds) for seconds in [*(row["time_s"] for row in rows), end]]
    last = max((i for i, name in enumerate(state) if name == "held"), default=-1)
    loose = state[last + 1 :]
    # Of causes that are as frequent the one that is nearest to success.
    cause = max(("links_short", "away", "no_worker"), key=loose.count) if loose else "too_late"
    if cause == "away":
        back = len(loose) - 1 - max(len(rows) // 10, 1)
        before = metres[last + 1 + back] if back >= 0 else None
        nearer = before is not None and metres[-1] is not None and metres[-1] < 0.95 * before
        cause = "on_its_way" if nearer else "held_up"
    links = [row[f"links_{k}"] for row in rows[last + 1 :] if row[f"target_{k}"] == "links_short"]
    return {
        "missed_s": sum(b - a for a, b, name in zip(nanos, nanos[1:], state) if name != "held") / 1e9,
        "why": cause,
        "links": max(links, default=None),
        "nearest_m": min((m for m in metres if m is not None), default=None),
        "at_end_m": metres[-1],
    }


def leaves(value, path=""):
    """Every figure with its path; units and names are no figures."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in ("unit", "scenario", "name"):
                yield from leaves(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{index}]")
    else:
        yield path, value


def agree(path, stated, found):
    if isinstance(stated, float) and isinstance(found, (int, float)):
        # Ends near zero, whose interval is wide, are differences of large numbers.
        tolerance = INTERVAL_TOLERANCE if "ci95" in path else TOLERANCE
        return math.isclose(stated, found, rel_tol=tolerance, abs_tol=tolerance if "ci95" in path else 0.0)
    return stated == found


def disagreements(folder):
    stated = dict(leaves(json.loads((folder / "summary.json").read_text(encoding="utf-8"))))
    found = dict(leaves(Folder(folder).summary()))
    for path in stated.keys() | found.keys():
        if path not in found:
            yield f"{path}: not recomputed"
        elif path not in stated:
            yield f"{path}: not in summary.json"
        elif not agree(path, stated[path], found[path]):
            yield f"{path}: {stated[path]!r} stated, {found[path]!r} recomputed"
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    for name, entry in manifest["files"].items():
        content = (folder / name).read_bytes()
        if (len(content), xxhash.xxh3_128_hexdigest(content)) != (entry["bytes"], entry["xxh3_128"]):
            yield f"{name}: not the file that the manifest describes"
    if not found:
        yield "nothing to compare"


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    status = 0
    for argument in arguments:
        wrong = sorted(disagreements(pathlib.Path(argument)))
        print(f"{argument}: {'disagrees' if wrong else 'every figure agrees'}")
        for line in wrong:
            print(f"  {line}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

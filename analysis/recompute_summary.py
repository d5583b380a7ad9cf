#!/usr/bin/env python3
"""Recomputes summary.json of a results folder from its Parquet files alone, and fails on any disagreement.

    python analysis/recompute_summary.py results/quickstart...

Written from results/README.md, not from the simulator's code. Figures must agree bit for bit: sums are taken in the
order of the rows. Ends of intervals come from SciPy's distributions here and must agree to nine digits.
"""

import json
import math
import pathlib
import statistics
import sys

import polars as pl
import xxhash
from scipy.stats import binom, t as student

from paper.statistics import Z, estimate, wilson

INTERVAL_TOLERANCE = 1e-9
WHY = ("no_worker", "held_up", "on_its_way", "links_short", "too_late")


def total(values):
    """The sum in order. Python's own corrects rounding on the way, from version 3.12 on."""
    result = 0.0
    for value in values:
        result += value
    return result


def mean(values):
    values = [value for value in values if value is not None]
    n = len(values)
    if n == 0:
        return estimate(None)
    value = values[0] + total(v - values[0] for v in values) / n
    if n == 1:
        return estimate(value, n=1)
    squares = total((v - value) ** 2 for v in values)
    half = student.ppf(0.975, n - 1) * math.sqrt(squares / (n - 1) / n)
    return estimate(value, value - half, value + half, n)


def share(values):
    """The mean of shares, with Wilson's interval at the effective number of trials."""
    shares = [value for value in values if value is not None]
    n, found = len(shares), mean(shares)
    value = found["value"]
    if n < 2:
        return found
    if value in (0.0, 1.0):
        return wilson(n * int(value), n)
    squared_error = total((share - value) ** 2 for share in shares) / (n - 1) / n
    if squared_error == 0:
        return estimate(value, value, value, n)
    z, effective = student.ppf(0.975, n - 1), value * (1 - value) / squared_error
    centre = (value + z * z / (2 * effective)) / (1 + z * z / effective)
    half = z / (1 + z * z / effective) * math.sqrt(value * (1 - value) / effective + (z / effective) ** 2 / 4)
    return estimate(value, centre - half, centre + half, n)


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


def kaplan_meier(times):
    """The median of (time, happened) pairs, with the Brookmeyer-Crowley interval under the log(-log) transform."""
    at_risk, survival, greenwood = float(len(times)), 1.0, 0.0
    found = [None, None, None]
    for time in sorted({time for time, _ in times}):
        happened = sum(1 for t, done in times if t == time and done)
        if happened:
            survival *= 1 - happened / at_risk
            if survival > 0:
                greenwood += happened / (at_risk * (at_risk - happened))
                width = Z * math.sqrt(greenwood) / -math.log(survival)
                levels = [survival, survival ** math.exp(width), survival ** math.exp(-width)]
            else:
                levels = [0.0] * 3
            found = [f if f is not None else (float(time) if s <= 0.5 else None) for f, s in zip(found, levels)]
        at_risk -= sum(1 for t, _ in times if t == time)
    return estimate(*(found if len(times) > 1 else [found[0], None, None]), n=len(times))


def ratio(parts):
    """The ratio of two sums over trials, with the interval of the ratio estimator."""
    n = len(parts)
    watched = total(b for _, b in parts)
    if watched <= 0:
        return estimate(None, n=n)
    value = total(a for a, _ in parts) / watched
    if n < 2:
        return estimate(value, n=n)
    squares = total((a - value * b) ** 2 for a, b in parts)
    half = student.ppf(0.975, n - 1) * math.sqrt(squares / (n - 1) / n) / (watched / n)
    return estimate(value, max(value - half, 0.0), max(value + half, 0.0), n)


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
        sums = {(trial, robot): size for trial, robot, size in sums.iter_rows()}
        trials = self.trials.select("trial", "robots", "steps").iter_rows()
        return [[sums.get((t, r), 0) / max(steps, 1) for r in range(robots)] for t, robots, steps in trials]

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

    def delivery_ratios(self):
        for trial in self.trials["trial"]:
            rows = self.frames.filter(trial=trial)
            offered = rows["offered"].sum()
            yield rows["delivered"].sum() / offered if offered else None

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
        return {"faults": {"robots": mean(failed), "by_role": by_role, "links": len(self.faults) - len(robots)}}

    def healed(self, rows):
        mended = rows.filter(pl.col("healed_s").is_not_null())
        times = list(rows.select("watched_s", pl.col("healed_s").is_not_null()).iter_rows())
        frames = {topic: [float(n) for n in mended[f"{topic.replace(' ', '_')}_frames"]] for topic in self.topics}
        return {
            "failures": len(rows),
            "healed": len(mended),
            "time": {"median": kaplan_meier(times)},
            "distance": mean(mended["distance_m"].to_list()),
            "frames": {topic: mean(counts) for topic, counts in frames.items()},
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
            return {"median": kaplan_meier(times), "mean": mean([t for t, _ in times] if complete else [])}

        spread = {
            "informed_ratio": mean([len(known) / count for count, known, _ in trials]),
            "time_to_half": until([((count + 1) // 2, known, end) for count, known, end in trials]),
            "time_to_all": until(trials),
        }
        return {"spread": spread}

    def heard_in_vain(self):
        """Messages that told their receiver nothing new, in those delivered, if there were any."""
        counted = self.bandwidth.filter(pl.col("direction").is_in(["rx", "duplicate"]))
        if counted.filter(direction="duplicate").is_empty():
            return {}

        def share(rows):
            grouped = rows.group_by("trial", "direction").agg(pl.sum("frames"))
            sums = {(trial, direction): frames for trial, direction, frames in grouped.iter_rows()}
            received = [(trial, sums.get((trial, "rx"), 0)) for trial in self.trials["trial"]]
            return mean([sums.get((trial, "duplicate"), 0) / rx for trial, rx in received if rx > 0])

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

        def sum_and_count(rows, column):
            values = rows[column].drop_nulls().to_list()
            return total(values), float(len(values))

        monitored, mistaken = self.trials["monitored_s"].to_list(), self.trials["mistaken_s"].to_list()
        made = of_trials(mistakes, lambda rows: float(len(rows)))
        wrong = ratio(list(zip(mistaken, monitored)))
        low, high = (None if end is None else max(1.0 - end, 0.0) for end in reversed(wrong["ci95"]))
        right = estimate(None if wrong["value"] is None else 1.0 - wrong["value"], low, high, wrong["n"])
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
            "detection_time_s": ratio(of_trials(failures, lambda rows: sum_and_count(rows, "detection_time_s"))),
            "mistake_recurrence_s": ratio(list(zip(monitored, made))),
            "mistake_duration_s": ratio(of_trials(suspicions, lambda rows: sum_and_count(rows, "mistake_duration_s"))),
            "mistake_rate_hz": ratio(list(zip(made, monitored))),
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
            "completion_ratio": wilson(completed, len(times)),
            "steps_to_completion": {"median": kaplan_meier(times)},
            "frames": {
                **self.fates(self.frames),
                "by_topic": {topic: self.fates(self.frames.filter(topic=topic)) for topic in self.topics},
            },
            "delivery_ratio": mean(list(self.delivery_ratios())),
            "latency_s": self.latencies(),
            "bandwidth": {
                **self.directions(self.bandwidth),
                "by_topic": {topic: self.of_topic(topic) for topic in self.topics},
                "by_role": {role: self.directions(self.bandwidth.filter(role=role)) for role in self.roles},
            },
            "load_imbalance": {"tx": mean([gini(t) for t in sent]), "rx": mean([gini(t) for t in received])},
            "lambda2_min": {**median(least), "min": min((v for v in least if v is not None), default=None)},
            "connected_share": share(list(self.samples(lambda rows: (rows["components"] == 1).sum() / live if (live := (rows["components"] > 0).sum()) else None))),
            "robots_used": mean([None if n is None else float(n) for n in self.trials["robots_used"]]),
            **self.missed(),
            **self.failures(),
            **self.mending(),
            **self.spreading(),
            **self.heard_in_vain(),
            "detection": self.failure_detection(),
            "steps": {"value": self.trials["steps"].sum()},
            "simulated_s": {"value": total(self.trials["simulated_s"])},
        }


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
            if key not in ("unit", "scenario"):
                yield from leaves(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{index}]")
    else:
        yield path, value


def agree(path, stated, found):
    if stated is None or found is None or "ci95" not in path:
        return stated == found
    return math.isclose(stated, found, rel_tol=INTERVAL_TOLERANCE, abs_tol=INTERVAL_TOLERANCE)


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

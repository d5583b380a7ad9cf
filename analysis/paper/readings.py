"""What the paper's "bandwidth consumed by a robot" may mean: readings of it, computed from the same frames.

The paper counts bytes a timestep and says neither whether they are sent or received, nor what is counted beside the
payload. Each reading turns the table of traffic into bytes a control step of every robot of every trial.

Two readings re-encode what was sent. A strand of desim is binary: 4 bytes and one for each robot in it (two from robot
256 on, which does not occur here), so its payload tells how many robots it named.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import polars as pl

STRANDS = ("parent strand", "child strand")
STRAND_FIXED_BYTES = 4
"""Kind, chain, next robot, number of robots: what a strand's payload has beside the robots."""

BUZZ_PACKET_BYTES = 2
"""A robot's id, once for all that it sends in a step."""
BUZZ_MESSAGE_BYTES = 2 + 1 + 2 + 2
"""Length and kind of a message; type and length of its topic, a string."""
BUZZ_TOPIC_CHARACTERS = 2
"""Length of a topic's name: the one number here chosen after the paper, so that a lone status takes its 17 bytes."""
BUZZ_NUMBER_BYTES = 2 + 4
"""Type and value of a number: a status, a request or a response."""
BUZZ_STRING_BYTES = 2 + 2
"""Type and length of a string: a strand."""


def text_bytes_per_id(robots: int) -> float:
    """Mean length of a robot's id in decimal digits with a separator, ids being 0 to `robots` − 1."""
    return sum(len(str(robot)) + 1 for robot in range(robots)) / robots


def payload(_robots: int) -> pl.Expr:
    """Payload alone."""
    return pl.col("payload_bytes").cast(pl.Float64)


def with_headers(_robots: int) -> pl.Expr:
    """Payload and headers, 2 + 3 bytes a message."""
    return (pl.col("payload_bytes") + pl.col("header_bytes")).cast(pl.Float64)


def _names() -> pl.Expr:
    return pl.col("payload_bytes") - STRAND_FIXED_BYTES * pl.col("frames")


def text_strands(robots: int) -> pl.Expr:
    """As `with_headers`, a strand being the text of its ids: "a serialized string", says section 4.3."""
    text = _names() * text_bytes_per_id(robots) + pl.col("header_bytes")
    return pl.when(pl.col("topic").is_in(STRANDS)).then(text).otherwise(with_headers(robots))


def buzz(robots: int) -> pl.Expr:
    """As Buzz, the authors' language, puts values on air: a typed value under a named topic, strands as text.

    The robot's id, once a packet, is counted with the status, which every robot sends every step.
    """
    frame = BUZZ_MESSAGE_BYTES + BUZZ_TOPIC_CHARACTERS
    strand = (frame + BUZZ_STRING_BYTES) * pl.col("frames") + _names() * text_bytes_per_id(robots)
    number = (frame + BUZZ_NUMBER_BYTES) * pl.col("frames").cast(pl.Float64)
    status = number + BUZZ_PACKET_BYTES * pl.col("frames")
    topic = pl.col("topic")
    return pl.when(topic.is_in(STRANDS)).then(strand).when(topic == "status").then(status).otherwise(number)


@dataclass(frozen=True)
class Reading:
    """One way to count."""

    name: str
    directions: tuple[str, ...]
    size: Callable[[int], pl.Expr]
    topics: tuple[str, ...] | None = None

    def rows(self, bandwidth: pl.DataFrame, robots: int) -> pl.DataFrame:
        """The rows that count, with their `bytes`."""
        counted = bandwidth.filter(pl.col("direction").is_in(self.directions))
        if self.topics is not None:
            counted = counted.filter(pl.col("topic").is_in(self.topics))
        return counted.with_columns(self.size(robots).alias("bytes"))


SENT, RECEIVED = ("tx",), ("rx",)
READINGS = (
    Reading("sent, payload", SENT, payload),
    Reading("sent, with headers", SENT, with_headers),
    Reading("sent, with headers, strands as text", SENT, text_strands),
    Reading("sent, encoded as Buzz does", SENT, buzz),
    Reading("received, payload", RECEIVED, payload),
    Reading("received, with headers", RECEIVED, with_headers),
    Reading("received, encoded as Buzz does", RECEIVED, buzz),
    Reading("received, status payload alone", RECEIVED, payload, ("status",)),
    Reading("received, strand payload alone", RECEIVED, payload, STRANDS),
    Reading("received, requests and responses alone, with headers", RECEIVED, with_headers, ("request",)),
    Reading("sent and received, payload", SENT + RECEIVED, payload),
)
MAIN = ("sent, with headers", "received, with headers")
"""The two that the paper's sentence can mean at face value."""


def per_robot(rows: pl.DataFrame, trials: pl.DataFrame) -> list[list[float]]:
    """Bytes a control step of every robot, trial by trial; a robot without rows has 0."""
    grouped = rows.group_by("trial", "robot").agg(pl.col("bytes").sum())
    sums = {(trial, robot): size for trial, robot, size in grouped.iter_rows()}
    every = trials.select("trial", "robots", "steps").iter_rows()
    return [
        [sums.get((trial, robot), 0.0) / max(steps, 1) for robot in range(robots)] for trial, robots, steps in every
    ]


def by_topic(rows: pl.DataFrame, trials: pl.DataFrame) -> dict[str, float]:
    """Mean bytes a robot and control step of each topic; both strands are one, as in the paper."""
    whole = float((trials["robots"] * trials["steps"]).sum())
    topic = pl.when(pl.col("topic").is_in(STRANDS)).then(pl.lit("strand")).otherwise("topic").alias("topic")
    sums = rows.group_by(topic).agg(pl.col("bytes").sum()).sort("topic").iter_rows()
    return {topic: size / whole for topic, size in sums}


def neighbours(bandwidth: pl.DataFrame) -> float:
    """Robots that hear a status, on average."""
    status = bandwidth.filter(topic="status")
    heard, sent = (float(status.filter(direction=direction)["frames"].sum()) for direction in ("rx", "tx"))
    return heard / sent

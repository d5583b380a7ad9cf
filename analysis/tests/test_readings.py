"""Ways to count bytes, on two robots."""

import unittest

import polars as pl

from paper import readings

TRIALS = pl.DataFrame({"trial": [0], "robots": [3], "steps": [10]})
BANDWIDTH = pl.DataFrame(
    [
        # Robot 0 sends ten statuses, and ten strands that name two robots each. Robot 1 hears them. Robot 2 is silent.
        (0, 0, "status", "tx", 10, 40, 50),
        (0, 0, "child strand", "tx", 10, 60, 50),
        (0, 1, "status", "rx", 10, 40, 50),
        (0, 1, "child strand", "rx", 10, 60, 50),
        (0, 2, "request", "lost_channel", 1, 4, 5),
    ],
    schema=["trial", "robot", "topic", "direction", "frames", "payload_bytes", "header_bytes"],
    orient="row",
)
BY_NAME = {reading.name: reading for reading in readings.READINGS}


def per_robot(name: str) -> list[float]:
    """Bytes a step of the three robots."""
    return readings.per_robot(BY_NAME[name].rows(BANDWIDTH, 10), TRIALS)[0]


class Readings(unittest.TestCase):
    def test_sent_and_received_are_told_apart_and_what_is_lost_counts_for_neither(self) -> None:
        self.assertEqual(per_robot("sent, with headers"), [20, 0, 0])
        self.assertEqual(per_robot("received, payload"), [0, 10, 0])
        self.assertEqual(per_robot("sent and received, payload"), [10, 10, 0])

    def test_one_topic_can_be_counted_alone(self) -> None:
        self.assertEqual(per_robot("received, status payload alone"), [0, 4, 0])
        self.assertEqual(per_robot("received, strand payload alone"), [0, 6, 0])

    def test_a_strand_as_text_is_its_ids_with_separators(self) -> None:
        # Status 9; strand: header 5 and two ids of one digit and a separator each.
        self.assertEqual(per_robot("sent, with headers, strands as text"), [9 + 5 + 4, 0, 0])
        self.assertEqual(readings.text_bytes_per_id(10), 2)
        self.assertEqual(readings.text_bytes_per_id(100), 2.9)

    def test_a_lone_status_takes_17_bytes_as_buzz_encodes_it(self) -> None:
        # The strand: frame 9, string 4, text 4.
        self.assertEqual(per_robot("sent, encoded as Buzz does"), [17 + 17, 0, 0])

    def test_both_strands_are_one_topic(self) -> None:
        rows = BY_NAME["sent, with headers"].rows(BANDWIDTH, 10)
        self.assertEqual(readings.by_topic(rows, TRIALS), {"status": 3.0, "strand": 110 / 30})

    def test_neighbours_are_the_copies_of_a_status(self) -> None:
        self.assertEqual(readings.neighbours(BANDWIDTH), 1.0)

"""The rules by which claims are judged."""

import unittest

from paper import verdict
from paper.statistics import Estimate, estimate
from paper.verdict import AGREES, CANNOT_SAY, DIFFERS


def of(low: float | None, high: float | None) -> Estimate:
    """An estimate with this interval."""
    ends = [end for end in (low, high) if end is not None]
    return estimate(sum(ends) / len(ends), low, high, 35)


class Number(unittest.TestCase):
    def test_a_number_within_the_widened_interval_agrees(self) -> None:
        self.assertEqual(verdict.number(of(1051, 1100), 1000), DIFFERS)
        self.assertEqual(verdict.number(of(1049, 1100), 1000), AGREES)
        self.assertEqual(verdict.number(of(900, 951), 1000), AGREES)
        self.assertEqual(verdict.number(of(900, 949), 1000), DIFFERS)

    def test_an_open_interval_can_show_a_difference_but_no_agreement(self) -> None:
        self.assertEqual(verdict.number(of(900, None), 1000), CANNOT_SAY)
        self.assertEqual(verdict.number(of(1200, None), 1000), DIFFERS)

    def test_an_interval_that_contains_everything_says_nothing(self) -> None:
        self.assertEqual(verdict.number(of(500, 1500), 1000), CANNOT_SAY)

    def test_a_median_that_does_not_exist_says_nothing(self) -> None:
        self.assertEqual(verdict.number(estimate(None, 3000, None, 35), 1000), CANNOT_SAY)


class Statement(unittest.TestCase):
    def test_the_whole_interval_must_be_on_the_side_that_is_named(self) -> None:
        self.assertEqual(verdict.above(of(0.1, 2)), AGREES)
        self.assertEqual(verdict.above(of(-0.1, 2)), CANNOT_SAY)
        self.assertEqual(verdict.above(of(-2, -0.1)), DIFFERS)
        self.assertEqual(verdict.below(of(0.1, 0.2), 0.3), AGREES)
        self.assertEqual(verdict.below(of(0.4, 0.5), 0.3), DIFFERS)

    def test_medians_are_the_same_if_their_ratio_is_surely_near_one(self) -> None:
        self.assertEqual(verdict.same(of(0.9, 1.1)), AGREES)
        self.assertEqual(verdict.same(of(0.9, 1.2)), CANNOT_SAY)
        self.assertEqual(verdict.same(of(0.9, None)), CANNOT_SAY)
        self.assertEqual(verdict.same(of(1.2, 1.3)), DIFFERS)

    def test_one_part_that_differs_spoils_the_whole(self) -> None:
        self.assertEqual(verdict.every([AGREES, CANNOT_SAY, DIFFERS]), DIFFERS)
        self.assertEqual(verdict.every([AGREES, CANNOT_SAY]), CANNOT_SAY)
        self.assertEqual(verdict.every([AGREES]), AGREES)

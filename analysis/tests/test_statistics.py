"""Estimates against textbook values and an independent library."""

import math
import unittest

from scipy.stats import binomtest

from paper.statistics import difference, estimate, median, quantile, ratio, wilson


class Wilson(unittest.TestCase):
    def test_it_agrees_with_scipy_at_every_count_of_35(self) -> None:
        for successes in range(36):
            ours = wilson(successes, 35)
            theirs = binomtest(successes, 35).proportion_ci(0.95, method="wilson")
            self.assertAlmostEqual(ours["ci95"][0], theirs.low, places=12)
            self.assertAlmostEqual(ours["ci95"][1], theirs.high, places=12)

    def test_no_trials_give_no_share(self) -> None:
        self.assertEqual(wilson(0, 0)["value"], None)


class Median(unittest.TestCase):
    def test_35_trials_are_enclosed_by_the_12th_and_the_24th(self) -> None:
        self.assertEqual(median([float(value) for value in range(1, 36)]), estimate(18.0, 12.0, 24.0, 35))

    def test_five_trials_are_too_few_for_an_interval(self) -> None:
        self.assertEqual(median([5.0, 1.0, 3.0, 2.0, 4.0]), estimate(3.0, None, None, 5))

    def test_six_trials_are_enclosed_by_the_least_and_the_greatest(self) -> None:
        self.assertEqual(median([6.0, 1.0, 3.0, 2.0, 4.0, 5.0]), estimate(3.5, 1.0, 6.0, 6))

    def test_a_quantile_between_trials_that_never_completed_is_never(self) -> None:
        self.assertEqual(quantile([1.0, math.inf, math.inf], 0.75), math.inf)


class Difference(unittest.TestCase):
    def test_it_is_newcombes_interval_for_shares(self) -> None:
        # Newcombe (1998), method 10, first example: 56 of 70 less 48 of 80.
        found = difference(wilson(56, 70), wilson(48, 80))
        self.assertAlmostEqual(found["value"], 0.2)
        self.assertAlmostEqual(found["ci95"][0], 0.0524, places=4)
        self.assertAlmostEqual(found["ci95"][1], 0.3339, places=4)

    def test_a_missing_end_leaves_the_side_open_that_it_bounds(self) -> None:
        known, open_above = estimate(10.0, 9.0, 11.0, 35), estimate(20.0, 18.0, None, 35)
        self.assertEqual(difference(open_above, known)["ci95"][1], None)
        self.assertAlmostEqual(difference(open_above, known)["ci95"][0], 10 - math.hypot(2, 1))

    def test_a_missing_value_gives_no_difference(self) -> None:
        self.assertEqual(difference(estimate(None, n=35), estimate(1.0, 0.0, 2.0, 35)), estimate(None, n=35))

    def test_a_ratio_with_a_constant_scales_the_interval(self) -> None:
        found = ratio(estimate(10.0, 8.0, 12.0, 35), estimate(2.0, 2.0, 2.0, 35))
        for got, wanted in zip([found["value"], *found["ci95"]], [5.0, 4.0, 6.0], strict=True):
            self.assertAlmostEqual(got, wanted)

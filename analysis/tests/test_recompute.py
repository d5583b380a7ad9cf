"""The recomputation against wrong summaries: what it is for."""

import math
import unittest

from recompute_summary import agree, hall, kaplan_meier, leaves, mean_time, median, Moments, ratio, score
from scipy.stats import binomtest


def done(times):
    return [(float(time), True) for time in times]


class Medians(unittest.TestCase):
    def test_a_median_one_order_statistic_late_is_caught_for_every_even_number_up_to_300(self) -> None:
        for n in range(2, 301, 2):
            times = [100.0 + 3 * place for place in range(n)]
            found = kaplan_meier(done(times))["value"]
            self.assertEqual(found, (times[n // 2 - 1] + times[n // 2]) / 2)
            for late in (times[n // 2], times[min(n // 2 + 1, n - 1)], times[n // 2 - 1]):
                stated = dict(leaves({"median": {"value": late}}))["median.value"]
                self.assertFalse(agree("steps_to_completion.median.value", stated, found), n)

    def test_a_curve_that_rounding_puts_a_hair_above_one_half_is_at_one_half(self) -> None:
        # 1 − d/n multiplied up in binary: above 0.5 for 24, 28, 30, 38 and 44 trials, so that the next one is taken.
        rounded = []
        for n in (24, 28, 30, 38, 44):
            left, taken = 1.0, None
            for place in range(n):
                left *= 1 - 1 / (n - place)
                if taken is None and left <= 0.5:
                    taken = place
            rounded.append(taken != n // 2 - 1)
            self.assertEqual(kaplan_meier(done(range(n)))["value"], n / 2 - 0.5)
        self.assertTrue(any(rounded), "the fault that this is about")

    def test_cut_off_trials_keep_the_median_of_r(self) -> None:
        # quantile(survfit(Surv(t, e) ~ 1, conf.type = "log-log"), 0.5), R 4.2
        times = done([1400, 1380, 1420, 1390, 1500, 1600, 1700]) + [(4000.0, False)] * 3
        found = kaplan_meier(times)
        self.assertEqual((found["value"], found["ci95"]), (1550.0, [1380.0, None]))
        self.assertEqual(kaplan_meier([(5.0, True), (5.0, True), (11.0, False), (12.0, False)])["value"], 8.5)
        self.assertEqual(kaplan_meier(done([5, 11]))["value"], 8.0)
        self.assertEqual(median([5.0, 11.0])["value"], 8.0)


class MeanTimes(unittest.TestCase):
    def test_the_area_and_its_error_are_those_of_r(self) -> None:
        # survfit(..., rmean=35): 23.28739495798319, standard error 2.82746762337144 by Greenwood
        over = done([6, 6, 6, 7, 10, 13, 16, 22, 23])
        cut = [(float(time), False) for time in (6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35)]
        found = mean_time([[pair] for pair in over + cut])
        self.assertAlmostEqual(found["value"], 23.28739495798319, places=10)
        self.assertEqual((found["cut_off"], found["restricted_to"]), (12, 35.0))
        low, high = found["ci95"]
        # scipy.stats.t.ppf(1 - 0.018, 20) = 2.247; the clustered error differs a little from Greenwood's.
        self.assertLess(abs((high - low) / 2 / 2.247 / 2.82746762337144 - 1), 0.05)

    def test_leaving_out_what_was_cut_off_is_caught(self) -> None:
        trials = [[(3.0, True), (9.0, False)], [(5.0, True), (12.0, False)], [(7.0, True)]]
        right = mean_time(trials)["value"]
        self.assertFalse(agree("detection.mistake_duration_s.value", (3.0 + 5.0 + 7.0) / 3, right))


class Intervals(unittest.TestCase):
    def test_wilsons_limits_as_roots_are_those_of_scipy(self) -> None:
        for successes in range(36):
            ours = score(successes / 35, 35, 1.959963984540054)
            theirs = binomtest(successes, 35).proportion_ci(0.95, method="wilson")
            self.assertAlmostEqual(ours[0], theirs.low, places=10)
            self.assertAlmostEqual(ours[1], theirs.high, places=10)

    def test_nothing_seen_has_an_upper_limit(self) -> None:
        self.assertAlmostEqual(ratio([(0.0, 20_000.0), (0.0, 15_678.0)], "rate")["ci95"][1] * 35_678, 3.688879454, places=8)
        self.assertLess(ratio([(1.0, 1.0)] * 13, "share")["ci95"][0], 0.8)

    def test_a_symmetric_mean_has_students_interval(self) -> None:
        values = [5.0, 6.5, 8.0, 8.5, 9.5, 10.0, 11.5, 13.0]
        centre = sum(values) / 8
        low, high = hall(centre, Moments([(value - centre) / 8 for value in values]))
        self.assertTrue(math.isclose(low, 6.83370770584782, rel_tol=1e-9) and math.isclose(high, 11.16629229415218, rel_tol=1e-9))


if __name__ == "__main__":
    unittest.main()

//! Ratios of sums over trials, and which interval befits them.

use serde::{Deserialize, Serialize};

use super::interval::{inflation, poisson, share_at, skewed, tail_of_few, wilson};
use super::median::median;
use super::permutation::Part;
use super::terms::{Moments, of_ratio};
use super::{Ci95, Estimate, normal_quantile};

/// What the interval of a mean of times leaves out on either side at most. Where many were cut off, the curve's end hangs on few, and its
/// spread is known less well than by as many whole times; found by simulation.
const TAIL_OF_TIMES: f64 = 0.018;

/// What kind of number a figure is: that decides how its interval is made. All but medians are ratios of sums over trials; of a plain mean
/// each trial adds its value over 1. None but a [`Signed`](Self::Signed) one is negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The mean of a quantity: Student's t, corrected for skewness. Equal values are their own interval: such a figure is fixed.
    Mean,
    /// The mean of a quantity that may be negative: as [`Mean`](Self::Mean), and not kept above 0.
    Signed,
    /// The mean of a quantity from 0 to 1, within which its interval is kept: else as [`Mean`](Self::Mean).
    Fraction,
    /// The mean of whole numbers: as [`Mean`](Self::Mean), but that a few trials gave equal numbers does not show that others will, so
    /// that then there is no interval.
    Count,
    /// The mean of times of which some may have been cut off: the mean of their [pseudo-values](super::pseudo_values), as
    /// [`Count`](Self::Count).
    Times,
    /// The median, between [order statistics](super::median).
    Median,
    /// A share of what trials are independent of each other in: Wilson's interval at the effective number of trials (Korn and
    /// Graubard, 1998).
    Share,
    /// A share of a number of things, such as copies: as [`Share`](Self::Share), but never as if there had been more than those, and
    /// where none or all are meant, as if they were independent.
    ShareOf,
    /// Events over what was watched: the Poisson interval at the effective number of events, never above those there were.
    Rate,
    /// What was watched over events: the inverse of a rate.
    Recurrence,
}

impl Estimator {
    /// The ratio of the sums of `parts`, one a trial, with its interval. No value where nothing was watched; no interval from
    /// fewer than two trials that tell something, unless they are a proportion, nor where no interval would hold.
    #[must_use]
    pub fn estimate(self, parts: &[Part]) -> Estimate {
        if self == Self::Median {
            let values = parts.iter().filter(|part| part[1] > 0.0).map(|[a, b]| a / b);
            return median(&values.collect::<Vec<_>>());
        }
        if self == Self::Recurrence {
            return inverse(Self::Rate.estimate(&parts.iter().map(|&[a, b]| [b, a]).collect::<Vec<_>>()));
        }
        let n = parts.iter().filter(|[a, b]| *a != 0.0 || *b != 0.0).count() as u64;
        let Some((value, terms)) = of_ratio(parts) else {
            return Estimate {
                n,
                ..Estimate::default()
            };
        };
        let ci95 = match Moments::of(&terms) {
            // A proportion's interval needs no spread: one trial tells a little, too.
            _ if self == Self::Share && n > 0 && parts.iter().all(is_yes_or_no) => {
                wilson(value, n as f64, normal_quantile()).map(Some)
            }
            Some(moments) => self.interval(value, moments, parts),
            None => [None; 2],
        };
        Estimate {
            value: Some(value),
            ci95: ci95.map(|end| end.map(|end| end.clamp(self.least(), self.most()))),
            n,
        }
    }

    /// The least value that there can be.
    fn least(self) -> f64 {
        if self == Self::Signed { f64::NEG_INFINITY } else { 0.0 }
    }

    /// The greatest value that there can be.
    fn most(self) -> f64 {
        match self {
            Self::Fraction | Self::Share | Self::ShareOf => 1.0,
            Self::Mean | Self::Signed | Self::Count | Self::Times | Self::Median | Self::Rate | Self::Recurrence => {
                f64::INFINITY
            }
        }
    }

    fn interval(self, value: f64, moments: Moments, parts: &[Part]) -> Ci95 {
        match self {
            Self::Mean | Self::Signed | Self::Fraction if moments.variance <= 0.0 => [Some(value); 2],
            Self::Count | Self::Times if moments.variance <= 0.0 => [None; 2],
            Self::Mean | Self::Signed | Self::Fraction | Self::Count => {
                skewed(value, moments, tail_of_few(moments.trials))
            }
            Self::Times => skewed(value, moments, tail_of_few(moments.trials).min(TAIL_OF_TIMES)),
            Self::Share => share(value, moments, parts, None),
            Self::ShareOf => share(value, moments, parts, Some(parts.iter().map(|part| part[1]).sum())),
            Self::Rate | Self::Recurrence => rate(value, moments, parts),
            Self::Median => [None; 2],
        }
    }
}

/// Whether a trial says yes or no, or nothing.
fn is_yes_or_no(&[a, b]: &Part) -> bool {
    let is = |value: f64, whole: f64| (value - whole).abs() <= 0.0;
    is(b, 0.0) || (is(b, 1.0) && (is(a, 0.0) || is(a, 1.0)))
}

/// Wilson's interval: plain where all trials are yeses and noes, else at the effective number of trials, which is not above that of the
/// `things` whose share it is, if these are known.
fn share(value: f64, moments: Moments, parts: &[Part], things: Option<f64>) -> Ci95 {
    let ends = match things {
        _ if parts.iter().all(is_yes_or_no) => Some(wilson(value, moments.trials as f64, normal_quantile())),
        Some(things) if value <= 0.0 || value >= 1.0 => Some(wilson(value, things, normal_quantile())),
        Some(things) => {
            let least = value * (1.0 - value) / (things * inflation(moments.freedom));
            let variance = moments.variance.max(least);
            share_at(value, Moments { variance, ..moments })
        }
        None => share_at(value, moments),
    };
    ends.map_or([None; 2], |ends| ends.map(Some))
}

/// The Poisson interval at the effective number of events: those there were, over how many times more the rate varies over trials than
/// if events were independent, if it does.
fn rate(value: f64, moments: Moments, parts: &[Part]) -> Ci95 {
    let [events, watched] = [0, 1].map(|part| parts.iter().map(|parts| parts[part]).sum::<f64>());
    if events <= 0.0 {
        return poisson(0.0).map(|events| Some(events / watched));
    }
    let overdispersion = moments.variance * inflation(moments.freedom) * watched / value;
    poisson(events / overdispersion.max(1.0)).map(|factor| Some(value * factor))
}

/// One over an estimate; its lower end may be absent, where the other's upper is 0.
fn inverse(estimate: Estimate) -> Estimate {
    let [low, high] = estimate
        .ci95
        .map(|end| end.map(f64::recip).filter(|end| end.is_finite()));
    Estimate {
        value: estimate.value.map(f64::recip).filter(|value| value.is_finite()),
        ci95: [high, low],
        n: estimate.n,
    }
}

/// The mean of `values`, one a trial.
#[must_use]
pub fn mean(values: &[f64]) -> Estimate {
    Estimator::Mean.estimate(&values.iter().map(|&value| [value, 1.0]).collect::<Vec<_>>())
}

/// The value of the [`mean`] of `values` alone: its interval takes far longer.
#[must_use]
pub fn mean_value(values: &[f64]) -> Option<f64> {
    let first = *values.first()?;
    // Equal values are exactly their mean.
    let are_equal = values.iter().all(|value| (value - first).abs() <= 0.0);
    let mean = if are_equal {
        first
    } else {
        values.iter().sum::<f64>() / values.len() as f64
    };
    mean.is_finite().then_some(mean)
}

/// The share of `trials` that were `successes`, with Wilson's score interval.
#[must_use]
pub fn proportion(successes: u64, trials: u64) -> Estimate {
    let parts = (0..trials).map(|trial| [f64::from(u8::from(trial < successes)), 1.0]);
    Estimator::Share.estimate(&parts.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn assert_interval(estimate: Estimate, low: f64, high: f64) {
        let [Some(a), Some(b)] = estimate.ci95 else {
            panic!("no interval in {estimate:?}")
        };
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-7 * b.abs().max(1.0);
        assert!(close(a, low) && close(b, high), "{a} {b} instead of {low} {high}");
    }

    fn plain(values: &[f64]) -> Vec<Part> {
        values.iter().map(|&value| [value, 1.0]).collect()
    }

    #[test]
    fn without_skewness_a_mean_has_the_interval_of_scipy() {
        // scipy.stats.t.interval(0.95, 7, loc=numpy.mean(x), scale=scipy.stats.sem(x)), x symmetric about 9
        let x = [5.0, 6.5, 8.0, 8.5, 9.5, 10.0, 11.5, 13.0];
        assert_interval(mean(&x), 6.833_707_705_847_82, 11.166_292_294_152_18);
        // Two: scipy.stats.t.interval(0.965, 1, loc=12, scale=1), and nothing below 0
        assert_interval(mean(&[11.0, 13.0]), 0.0, 30.170_806_702_388_695);
        // But of a quantity that may be negative
        let signed = Estimator::Signed.estimate(&plain(&[11.0, 13.0]));
        assert_interval(signed, -6.170_806_702_388_695, 30.170_806_702_388_695);
    }

    #[test]
    fn a_skewed_mean_has_an_interval_that_reaches_further_where_values_do() {
        // By hand from Hall (1992): numpy, skew = n² m₃ / ((n−1)(n−2)) / s³, T ↦ 3/(a/√n) (∛(1 + a/√n (T − a/√n/6)) − 1)
        let x = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
        let found = mean(&x);
        assert_eq!(found.value, Some(12.4));
        let [low, high] = found.ci95.map(Option::unwrap);
        assert!(high - 12.4 > 1.3 * (12.4 - low), "{low} {high}");
        assert_interval(found, 7.593_041_050_083_975, 24.557_853_130_963_576);
    }

    #[test]
    fn a_ratio_of_sums_over_equal_watches_is_the_mean_and_its_interval() {
        let x = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
        let doubled = Estimator::Mean.estimate(&x.map(|a| [a, 2.0]));
        let [low, high] = mean(&x).ci95.map(Option::unwrap);
        assert_eq!(doubled.value, Some(6.2));
        assert_interval(doubled, low / 2.0, high / 2.0);
    }

    #[test]
    fn equal_values_are_their_own_mean_without_width_but_equal_counts_say_nothing_of_others() {
        let equal = mean(&[0.1; 35]);
        assert_eq!((equal.value, equal.ci95, equal.n), (Some(0.1), [Some(0.1); 2], 35));
        let counts = Estimator::Count.estimate(&plain(&[5.0; 3]));
        assert_eq!((counts.value, counts.ci95, counts.n), (Some(5.0), [None; 2], 3));
    }

    #[test]
    fn one_trial_has_no_interval_and_none_has_no_value_and_trials_that_tell_nothing_do_not_count() {
        for estimator in [
            Estimator::Mean,
            Estimator::Share,
            Estimator::ShareOf,
            Estimator::Rate,
            Estimator::Times,
        ] {
            let one = estimator.estimate(&[[0.5, 1.0], [0.0, 0.0]]);
            assert_eq!((one.value, one.ci95, one.n), (Some(0.5), [None; 2], 1));
            assert_eq!(estimator.estimate(&[]), Estimate::default());
            assert_eq!(estimator.estimate(&[[0.0, 0.0]; 3]).value, None);
        }
    }

    #[test]
    fn proportions_have_the_wilson_interval_of_scipy() {
        // scipy.stats.binomtest(k, n).proportion_ci(0.95, method="wilson")
        assert_interval(proportion(0, 10), 0.0, 0.277_532_799_862_889_26);
        assert_interval(proportion(10, 10), 0.722_467_200_137_111, 1.0);
        assert_interval(proportion(7, 10), 0.396_778_147_461_145_26, 0.892_208_732_593_699);
        assert_interval(proportion(33, 35), 0.813_929_425_798_350_7, 0.984_186_838_142_891_3);
        assert_interval(proportion(1, 2), 0.094_531_205_734_230_74, 0.905_468_794_265_769_3);
        assert_eq!(proportion(0, 0), Estimate::default());
    }

    #[test]
    fn shares_have_an_interval_within_0_and_1_that_is_wilsons_at_the_effective_number_of_trials() {
        // m = 0.99, s²/n = 0.01²: n_e = 99, t = scipy.stats.t.ppf(1 - 0.0175, 3); statsmodels' proportion_confint(0.99·99, 99,
        // method="wilson") with t for z.
        let t: f64 = 3.670_003_452_900_844_3;
        let (m, n) = (0.99, 99.0);
        let centre = (m + t * t / (2.0 * n)) / (1.0 + t * t / n);
        let half = t / (1.0 + t * t / n) * (m * (1.0 - m) / n + t * t / (4.0 * n * n)).sqrt();
        let found = Estimator::Share.estimate(&plain(&[1.0, 1.0, 1.0, 0.96]));
        assert_interval(found, centre - half, centre + half);
    }

    #[test]
    fn shares_that_are_all_or_nothing_are_a_proportion_and_other_equal_ones_say_nothing_of_others() {
        let share = |shares: &[f64]| Estimator::Share.estimate(&plain(shares));
        assert_eq!(share(&[1.0; 35]), proportion(35, 35));
        assert_eq!(share(&[0.0; 7]), proportion(0, 7));
        assert_eq!(share(&[0.25; 7]).ci95, [None; 2]);
        assert_eq!(share(&[1.0]), proportion(1, 1));
        assert_eq!(share(&[0.5]).ci95, [None; 2]);
    }

    #[test]
    fn a_share_of_things_is_no_surer_than_so_many_independent_ones() {
        // None of 5,000 lost: scipy.stats.binomtest(5000, 5000).proportion_ci(0.95, method="wilson")
        let none_lost = Estimator::ShareOf.estimate(&[[1000.0, 1000.0]; 5]);
        assert_interval(none_lost, 0.999_232_298_054_942_8, 1.0);
        // Equal by chance, as one in six pairs of binomials of ten are: still ten things each.
        let equal = Estimator::ShareOf.estimate(&[[5.0, 10.0]; 2]);
        let [low, high] = equal.ci95.map(Option::unwrap);
        assert!(low < 0.3 && high > 0.7, "{low} {high}");
    }

    #[test]
    fn things_that_fare_alike_in_a_trial_count_as_few() {
        // Var = 4 · (5/40)² · 4/3 = 1/12, so that the forty are worth ¼ · 12 = 3 things; t = scipy.stats.t.ppf(1 - 0.0175, 3).
        let t: f64 = 3.670_003_452_900_844_3;
        let half = t / (1.0 + t * t / 3.0) * (0.25_f64 / 3.0 + t * t / 36.0).sqrt();
        let found = Estimator::ShareOf.estimate(&[[0.0, 10.0], [10.0, 10.0], [0.0, 10.0], [10.0, 10.0]]);
        assert_interval(found, 0.5 - half, 0.5 + half);
    }

    #[test]
    fn a_rate_of_few_events_has_the_exact_poisson_limits_and_of_none_an_upper_one() {
        // scipy.stats.chi2.ppf(0.025, 2·4)/2, scipy.stats.chi2.ppf(0.975, 2·5)/2: four events in 400 s. They are spread more evenly
        // than by chance, which does not make the rate surer.
        let four = Estimator::Rate.estimate(&[[1.0, 100.0]; 4]);
        assert_interval(four, 1.089_865_373_6 / 400.0, 10.241_588_675_4 / 400.0);
        // chi2.ppf(0.975, 2)/2 = 3.688_879_454
        let none = Estimator::Rate.estimate(&[[0.0, 20_000.0], [0.0, 15_678.0]]);
        assert_eq!(none.value, Some(0.0));
        assert_interval(none, 0.0, 3.688_879_454 / 35_678.0);
    }

    #[test]
    fn events_that_come_together_tell_less_of_their_rate() {
        let scattered = Estimator::Rate.estimate(&[
            [3.0, 10.0],
            [5.0, 10.0],
            [4.0, 10.0],
            [4.0, 10.0],
            [4.0, 10.0],
            [4.0, 10.0],
        ]);
        let together = Estimator::Rate.estimate(&[
            [24.0, 10.0],
            [0.0, 10.0],
            [0.0, 10.0],
            [0.0, 10.0],
            [0.0, 10.0],
            [0.0, 10.0],
        ]);
        let width = |estimate: Estimate| estimate.ci95[1].unwrap() - estimate.ci95[0].unwrap();
        assert_eq!(scattered.value, together.value);
        assert!(width(together) > 4.0 * width(scattered), "{together:?} {scattered:?}");
    }

    #[test]
    fn a_recurrence_is_one_over_the_rate_and_without_an_event_at_least_something() {
        let parts = [[100.0, 2.0], [150.0, 1.0], [90.0, 3.0]];
        let (recurrence, rate) = (
            Estimator::Recurrence.estimate(&parts),
            Estimator::Rate.estimate(&parts.map(|[a, b]| [b, a])),
        );
        assert!((recurrence.value.unwrap() * rate.value.unwrap() - 1.0).abs() < 1e-12);
        assert!((recurrence.ci95[0].unwrap() * rate.ci95[1].unwrap() - 1.0).abs() < 1e-12);
        let never = Estimator::Recurrence.estimate(&[[100.0, 0.0]; 2]);
        assert_eq!((never.value, never.ci95[1]), (None, None));
        assert!((never.ci95[0].unwrap() - 200.0 / 3.688_879_454).abs() < 1e-6);
    }

    proptest! {
        #[test]
        fn the_value_of_a_mean_is_that_of_its_estimate_to_the_last_bit(
            values in prop::collection::vec(-9.0..9.0_f64, 0..20), equal: f64, count in 0_usize..9,
        ) {
            for values in [values, vec![equal; count]] {
                prop_assert_eq!(mean_value(&values).map(f64::to_bits), mean(&values).value.map(f64::to_bits));
            }
        }

        #[test]
        fn every_interval_holds_its_value_and_stays_within_the_bounds_of_its_figure(
            parts in prop::collection::vec((0.0..=1.0_f64, 0.1..20.0_f64), 2..40),
        ) {
            for estimator in [Estimator::Mean, Estimator::Fraction, Estimator::Count, Estimator::Times, Estimator::Share, Estimator::ShareOf, Estimator::Rate] {
                let parts: Vec<Part> = parts.iter().map(|(share, watched)| [share * watched, *watched]).collect();
                let Estimate { value: Some(value), ci95: [Some(low), Some(high)], .. } = estimator.estimate(&parts) else { continue };
                prop_assert!(0.0 <= low && low <= value + 1e-12 && value - 1e-12 <= high && high <= estimator.most());
            }
        }
    }
}

//! Times of which some were cut off: what did not happen by the end counts as not yet, never as not at all.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{Estimate, normal_quantile};

/// How long one trial took, or how long it was watched in vain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The time.
    pub time: f64,
    /// Whether it happened then; otherwise the trial was cut off (censored).
    pub happened: bool,
}

/// The Kaplan–Meier median: the first time by which half of the trials are estimated to be done. Its interval holds the
/// times at which Greenwood's 95 % band of the survival curve, under the log(−log) transform, contains one half
/// (Brookmeyer and Crowley). What is not reached before the trials end is absent, and so is the interval of a single trial.
#[must_use]
pub fn median_survival(observations: &[Observation]) -> Estimate {
    let curve = survival_curve(observations);
    let first = |level: fn(&Step) -> f64| curve.iter().find(|step| level(step) <= 0.5).map(|step| step.time);
    let ci95 = if observations.len() > 1 {
        [first(|step| step.band[0]), first(|step| step.band[1])]
    } else {
        [None; 2]
    };
    Estimate {
        value: first(|step| step.survival),
        ci95,
        n: observations.len() as u64,
    }
}

/// The survival curve from one time on until the next step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// The time.
    pub time: f64,
    /// Estimated share of trials that are not done by then.
    pub survival: f64,
    /// Greenwood's 95 % band under the log(−log) transform.
    pub band: [f64; 2],
}

/// The Kaplan–Meier curve, a step for each time at which something happened. At a tie, what happened came before what
/// was cut off.
#[must_use]
pub fn survival_curve(observations: &[Observation]) -> Vec<Step> {
    let mut sorted = observations.to_vec();
    sorted.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut at_risk = sorted.len() as f64;
    let mut survival = 1.0;
    let mut greenwood = 0.0;
    let mut curve = Vec::new();
    for tied in sorted.chunk_by(|a, b| a.time.total_cmp(&b.time).is_eq()) {
        let happened = tied.iter().filter(|observation| observation.happened).count() as f64;
        if happened > 0.0 {
            survival *= 1.0 - happened / at_risk;
            greenwood += happened / (at_risk * (at_risk - happened));
            curve.push(Step {
                time: tied[0].time,
                survival,
                band: band(survival, greenwood),
            });
        }
        at_risk -= tied.len() as f64;
    }
    curve
}

/// The 95 % band of the curve at a point, S^exp(±z·σ/ln S): never outside [0, 1].
fn band(survival: f64, greenwood: f64) -> [f64; 2] {
    if survival <= 0.0 {
        return [0.0; 2];
    }
    let width = normal_quantile() * greenwood.sqrt() / -survival.ln();
    [survival.powf(width.exp()), survival.powf((-width).exp())]
}

/// The log-rank test (Mantel, 1966) of two independent groups: the probability of curves at least as far apart if nothing differs.
/// It makes no use of pairs, and so says less than it might where trials share their random numbers. `None` where nothing happened.
#[must_use]
pub fn log_rank(a: &[Observation], b: &[Observation]) -> Option<f64> {
    let mut times: Vec<f64> = a
        .iter()
        .chain(b)
        .filter(|seen| seen.happened)
        .map(|seen| seen.time)
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let (mut surplus, mut variance) = (0.0, 0.0);
    for time in times {
        let at_risk = |group: &[Observation]| group.iter().filter(|seen| seen.time >= time).count() as f64;
        let happened = |group: &[Observation]| {
            let now = group
                .iter()
                .filter(|seen| seen.happened && seen.time.total_cmp(&time).is_eq());
            now.count() as f64
        };
        let (n, share) = (at_risk(a) + at_risk(b), at_risk(a) / (at_risk(a) + at_risk(b)));
        let events = happened(a) + happened(b);
        surplus += happened(a) - events * share;
        if n > 1.0 {
            variance += events * share * (1.0 - share) * (n - events) / (n - 1.0);
        }
    }
    let chi_squared = ChiSquared::new(1.0).ok()?;
    (variance > 0.0).then(|| chi_squared.sf(surplus * surplus / variance))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observed(times: &[u32], cut_off: &[u32]) -> Vec<Observation> {
        let observations = |times: &[u32], happened| -> Vec<_> {
            times
                .iter()
                .map(|&time| Observation {
                    time: f64::from(time),
                    happened,
                })
                .collect()
        };
        [observations(times, true), observations(cut_off, false)].concat()
    }

    fn assert_median(observations: &[Observation], value: Option<u32>, low: Option<u32>, high: Option<u32>) {
        let [value, low, high] = [value, low, high].map(|time| time.map(f64::from));
        let n = observations.len() as u64;
        assert_eq!(
            median_survival(observations),
            Estimate {
                value,
                ci95: [low, high],
                n
            }
        );
    }

    // Figures: k = lifelines.KaplanMeierFitter().fit(times, happened); k.median_survival_time_;
    // lifelines.utils.median_survival_times(k.confidence_interval_)

    #[test]
    fn remission_times_of_freireich_1963_have_their_published_medians() {
        let treated = observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        );
        assert_median(&treated, Some(23), Some(13), None);
        let placebo = observed(
            &[1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23],
            &[],
        );
        assert_median(&placebo, Some(8), Some(4), Some(11));
    }

    #[test]
    fn medians_and_intervals_are_those_of_lifelines() {
        let most_complete = observed(&[1400, 1380, 1420, 1390, 1500, 1600, 1700], &[4000, 4000, 4000]);
        assert_median(&most_complete, Some(1500), Some(1380), None);
        assert_median(&observed(&[10, 20, 30, 40], &[]), Some(20), Some(10), Some(40));
        assert_median(&observed(&[10], &[20, 30, 40]), None, Some(10), None);
    }

    #[test]
    fn a_single_trial_has_a_median_and_no_interval() {
        assert_median(&observed(&[5], &[]), Some(5), None, None);
    }

    #[test]
    fn a_curve_and_its_band_are_those_of_lifelines() {
        // lifelines.KaplanMeierFitter().fit(times, happened): survival_function_, confidence_interval_
        let curve = survival_curve(&observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        ));
        for (step, (time, survival, low, high)) in curve.iter().zip([
            (6.0, 0.857_142_857, 0.619_718, 0.951_552),
            (7.0, 0.806_722_689, 0.563_147, 0.922_809),
            (10.0, 0.752_941_176, 0.503_200, 0.889_362),
        ]) {
            assert!((step.time - time).abs() < 1e-12 && (step.survival - survival).abs() < 1e-9);
            assert!((step.band[0] - low).abs() < 1e-6 && (step.band[1] - high).abs() < 1e-6);
        }
        assert_eq!(curve.len(), 7);
    }

    #[test]
    fn the_log_rank_test_is_that_of_lifelines() {
        // lifelines.statistics.logrank_test(times_a, times_b, happened_a, happened_b).p_value
        let treated = observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        );
        let placebo = observed(
            &[1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23],
            &[],
        );
        assert!((log_rank(&treated, &placebo).unwrap() - 4.168_809_109e-5).abs() < 1e-12);
        let a = observed(&[1400, 1380, 1420], &[4000, 4000]);
        let b = observed(&[1500, 1380, 1600, 1700], &[4000]);
        assert!((log_rank(&a, &b).unwrap() - 0.899_745_406_580_755).abs() < 1e-9);
        assert_eq!(log_rank(&observed(&[], &[400]), &observed(&[], &[400])), None);
    }

    #[test]
    fn trials_that_were_all_cut_off_say_nothing() {
        assert_median(&observed(&[], &[400, 400]), None, None, None);
        assert_median(&[], None, None, None);
    }

    #[test]
    fn leaving_failures_out_would_flatter_the_median() {
        let honest = median_survival(&observed(&[100, 110, 120], &[400, 400]));
        let flattering = median_survival(&observed(&[100, 110, 120], &[]));
        assert!(honest.value > flattering.value);
    }
}

//! One setting held against another by one figure.

use serde::{Deserialize, Serialize};

use super::setting::observations;
use super::{Design, Side, Verdict};
use crate::metrics::figures::{Better, COMPLETION, Sample, parts};
use crate::statistics::{
    Estimate, POWER, Part, Tested, cliffs_delta_estimate, difference, least_of_ranks, log_rank, mann_whitney,
    paired_permutation, ratio_of_sums, trials_needed, wilcoxon,
};

/// How a setting differs from another in one figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Key of the figure.
    pub figure: String,
    /// Name of the setting.
    pub setting: String,
    /// Name of the setting that it is held against.
    pub against: String,
    /// Whether trials are paired by their number; otherwise they are independent.
    pub paired: bool,
    /// Its value less that of the other, with its interval. `n` is the number of pairs, or of the fewer trials.
    pub difference: Estimate,
    /// The difference over the other's value.
    pub relative: Option<f64>,
    /// Cliff's δ with its interval: 1 where every trial's value is above all of the other's, −1 where below.
    pub cliffs_delta: Estimate,
    /// Two-sided p-value: of the permutation test where paired, else Mann and Whitney's.
    pub p: Option<f64>,
    /// The p-value by Holm's adjustment over all differences of the study.
    pub p_adjusted: Option<f64>,
    /// The p-values of each test that applies, none of them adjusted.
    pub tests: Tests,
    /// What common random numbers gain; absent where trials are independent.
    pub gain: Option<Gain>,
    /// Trials that would show a difference worth finding.
    pub plan: Option<Plan>,
    /// What to make of it.
    pub verdict: Verdict,
    /// The same in words; filled in by the report.
    pub words: String,
}

/// Two-sided p-values, none adjusted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tests {
    /// Paired permutation test of the difference.
    pub permutation: Option<f64>,
    /// Wilcoxon's signed-rank test of the trials' own values.
    pub wilcoxon: Option<f64>,
    /// Mann and Whitney's test of the trials' own values, for independent trials.
    pub mann_whitney: Option<f64>,
    /// The log-rank test, for what may be cut off. It takes trials as independent.
    pub log_rank: Option<f64>,
}

/// Variances of the mean difference times the number of trials, from the same data. Of ratios of sums, to first order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Var(X − Y) of pairs that share their random numbers.
    pub paired_variance: f64,
    /// Var(X) + Var(Y), as if seeds were independent.
    pub independent_variance: f64,
    /// How many times fewer trials common random numbers need for the same interval: the latter over the former; absent where
    /// pairs do not vary.
    pub ratio: Option<f64>,
}

/// Trials for a difference worth finding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The difference, in the figure's unit.
    pub size: f64,
    /// Probability that so many trials find it.
    pub power: f64,
    /// Level of the test, the worst that Holm's adjustment may ask for.
    pub alpha: f64,
    /// Trials of each setting.
    pub trials: u64,
}

/// How far a change takes a figure the better way.
pub(super) fn gain_of(better: Better, change: f64) -> f64 {
    match better {
        Better::Lower => -change,
        Better::Higher => change,
    }
}

impl Pair {
    /// Holds the second of two settings against the first, by one figure, in a family of so many tests at level `alpha` each. Not judged yet;
    /// with what its test found.
    pub(super) fn of(
        design: &Design,
        figure: usize,
        [against, setting]: [&Side; 2],
        alpha: f64,
        family: usize,
    ) -> (Self, Option<Tested>) {
        let paired = against.seed == setting.seed;
        let mut samples = [&against.samples[figure][..], &setting.samples[figure][..]];
        if paired {
            let both = samples[0].len().min(samples[1].len());
            samples = samples.map(|samples| &samples[..both]);
        }
        let [a, b] = samples;
        let parts = samples.map(parts);
        let values = [a, b].map(|samples| samples.iter().map(Sample::value).collect::<Vec<_>>());
        let base = ratio_of_sums(parts[0].iter().copied());
        let difference = difference(design.figures[figure].estimator, [&parts[0], &parts[1]], paired);
        let permuted = paired
            .then(|| paired_permutation(&[parts.each_ref().map(Vec::as_slice)], family))
            .flatten();
        let tests = Tests::of(design.figures[figure].key == COMPLETION, permuted, paired, samples);
        let tested = if paired { permuted } else { tests.ranks(samples) };
        let gain = paired.then(|| Gain::of(&parts)).flatten();
        let deviation = if paired {
            gain.as_ref().map(|gain| gain.paired_variance.sqrt())
        } else {
            Gain::of(&parts).map(|gain| gain.independent_variance.sqrt())
        };
        let pair = Self {
            figure: design.figures[figure].key.clone(),
            setting: setting.name.to_owned(),
            against: against.name.to_owned(),
            paired,
            relative: difference
                .value
                .map(|value| value / base.abs())
                .filter(|share| share.is_finite()),
            difference,
            cliffs_delta: cliffs_delta_estimate([&values[0], &values[1]], paired),
            p: if paired { tests.permutation } else { tests.mann_whitney },
            p_adjusted: None,
            tests,
            gain,
            plan: deviation.and_then(|deviation| Plan::of((design.relevant * base).abs(), deviation, alpha)),
            verdict: Verdict::NotComparable,
            words: String::new(),
        };
        (pair, tested)
    }
}

/// Whether two settings differ in any trial's figure.
pub(super) fn differ(trials: &[Side], figure: usize, [a, b]: [usize; 2]) -> bool {
    let [a, b] = [&trials[a], &trials[b]].map(|trials| &trials.samples[figure]);
    let same = |(a, b): (&Sample, &Sample)| a.part.iter().zip(b.part).all(|(a, b)| super::apart(*a, b) == 0.0);
    a.len() != b.len() || !a.iter().zip(b).all(same)
}

impl Tests {
    fn of(may_be_cut_off: bool, permuted: Option<Tested>, paired: bool, samples: [&[Sample]; 2]) -> Self {
        let pairs = samples[0].iter().zip(samples[1]);
        let differences = || {
            pairs
                .filter_map(|(a, b)| Some(b.value()? - a.value()?))
                .collect::<Vec<f64>>()
        };
        Self {
            permutation: permuted.map(|tested| tested.p),
            wilcoxon: paired.then(|| wilcoxon(&differences())).flatten(),
            mann_whitney: (!paired)
                .then(|| mann_whitney(&values(samples[0]), &values(samples[1])))
                .flatten(),
            log_rank: may_be_cut_off
                .then(|| log_rank(&observations(samples[0]), &observations(samples[1])))
                .flatten(),
        }
    }

    /// What Mann and Whitney's test found. Where all values are the same it finds nothing, and could not have.
    fn ranks(&self, samples: [&[Sample]; 2]) -> Option<Tested> {
        let [a, b] = samples.map(values);
        let alike = || {
            (!a.is_empty() && !b.is_empty()).then_some(Tested {
                p: 1.0,
                least: 1.0,
                alike: true,
            })
        };
        match (self.mann_whitney, least_of_ranks(&a, &b)) {
            (Some(p), Some(least)) => Some(Tested { p, least, alike: false }),
            _ => alike(),
        }
    }
}

fn values(samples: &[Sample]) -> Vec<f64> {
    samples.iter().filter_map(Sample::value).collect()
}

impl Gain {
    /// `None` from fewer than two trials, or without a value in one of the settings.
    fn of(parts: &[Vec<Part>; 2]) -> Option<Self> {
        let [x, y] = [influences(&parts[0])?, influences(&parts[1])?];
        let independent_variance = variance(&x)? + variance(&y)?;
        let differences: Vec<f64> = x.iter().zip(&y).map(|(x, y)| y - x).collect();
        let paired_variance = variance(&differences)?;
        Some(Self {
            paired_variance,
            independent_variance,
            // Pairs that differ by rounding alone do not vary.
            ratio: (paired_variance > 1e-20 * independent_variance).then(|| independent_variance / paired_variance),
        })
    }
}

/// What each trial adds to the ratio of sums, to first order: the residual a − R b over the mean of b. Of plain values, how far
/// each is from the mean.
fn influences(parts: &[Part]) -> Option<Vec<f64>> {
    let ratio = ratio_of_sums(parts.iter().copied());
    let mean = parts.iter().map(|part| part[1]).sum::<f64>() / parts.len() as f64;
    let residuals = parts.iter().map(|[a, b]| (a - ratio * b) / mean);
    ratio.is_finite().then(|| residuals.collect())
}

/// The sample variance; `None` from fewer than two values.
fn variance(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (values.len() > 1).then(|| squares / (n - 1.0))
}

impl Plan {
    fn of(size: f64, deviation: f64, alpha: f64) -> Option<Self> {
        // Fewer pairs have no permutation rare enough for the level: of n pairs, 2 of 2ⁿ are as extreme as the most extreme one.
        let fewest = (2.0 / alpha).log2().ceil() as u64;
        Some(Self {
            size,
            power: POWER,
            alpha,
            trials: trials_needed(size, deviation, alpha)?.max(fewest),
        })
    }
}

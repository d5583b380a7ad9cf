//! From what trials tell to a verdict.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::row::Row;
use crate::statistics::Part;

/// The probability that the intervals of all rows of the catalogue hold what they are of.
pub const LEVEL: f64 = 0.99;

/// Whether a form and a measurement agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The form lies in the interval of the measurement, widened by its margin.
    Agrees,
    /// It does not, or nothing was measured.
    Differs,
}

/// A row that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Its model.
    pub model: &'static str,
    /// Its name.
    pub name: String,
    /// The form in words and symbols, with its source.
    pub form: String,
    /// Unit of the numbers; empty for plain numbers.
    pub unit: &'static str,
    /// What the form gives.
    pub expected: f64,
    /// What was measured; `None` if no trial told anything.
    pub measured: Option<f64>,
    /// The ends of its interval.
    pub interval: Option<[f64; 2]>,
    /// What the form is wrong by either way, as far as that is known: 0 of an exact one.
    pub margin: f64,
    /// What it leaves out, where the margin is not 0.
    pub margin_for: Option<&'static str>,
    /// How many trials were run.
    pub trials: u32,
    /// Whether they agree.
    pub verdict: Verdict,
    /// The scenario that was run, seed and all.
    pub scenario: String,
}

/// All that were measured at once.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Validation {
    /// Version of the simulator.
    pub version: &'static str,
    /// Seed of all trials.
    pub seed: u64,
    /// The probability that the intervals of the whole catalogue hold what they are of.
    pub level: f64,
    /// The rows, in order.
    pub rows: Vec<Judged>,
}

impl Validation {
    /// The rows at which form and measurement do not agree.
    pub fn differing(&self) -> impl Iterator<Item = &Judged> {
        self.rows.iter().filter(|row| row.verdict == Verdict::Differs)
    }
}

impl Judged {
    /// What to make of `row` of a catalogue of `all` rows, of which trials with `seed` told `parts`.
    pub(super) fn of(row: &Row, all: usize, seed: u64, parts: &[Part]) -> Self {
        let tail = (1.0 - LEVEL) / all.max(1) as f64 / 2.0;
        let estimate = match estimate(parts, tail, row.resolution) {
            Some((value, _)) if row.is_exact => Some((value, about(value, row.resolution))),
            estimate => estimate,
        };
        let margin = row.margin.as_ref().map_or(0.0, |margin| margin.size);
        let holds = |[low, high]: [f64; 2]| (low - margin..=high + margin).contains(&row.expected);
        let each = || {
            told(parts)
                .into_iter()
                .all(|[value, weight]| holds(about(value / weight, row.resolution)))
        };
        let agrees = estimate.is_some_and(|(_, interval)| holds(interval)) && (!row.is_exact || each());
        Self {
            model: row.model,
            name: row.name.clone(),
            form: row.form.clone(),
            unit: row.unit,
            expected: row.expected,
            measured: estimate.map(|(value, _)| value),
            interval: estimate.map(|(_, interval)| interval),
            margin,
            margin_for: row.margin.as_ref().map(|margin| margin.why),
            trials: row.trials,
            verdict: if agrees { Verdict::Agrees } else { Verdict::Differs },
            scenario: row.scenario(seed),
        }
    }
}

/// The trials that tell anything.
fn told(parts: &[Part]) -> Vec<Part> {
    parts.iter().copied().filter(|part| part[1] != 0.0).collect()
}

/// A share of `resolution` on either side of a value.
fn about(value: f64, resolution: f64) -> [f64; 2] {
    let half = resolution * value.abs();
    [value - half, value + half]
}

/// A ratio of sums over trials and the interval that leaves out `tail` on either side: Student's, by the spread of what each trial leaves over, and no narrower than
/// `resolution` of the value. `None` where fewer than two trials tell anything.
fn estimate(parts: &[Part], tail: f64, resolution: f64) -> Option<(f64, [f64; 2])> {
    let told = told(parts);
    let trials = told.len() as f64;
    let [sum, weights] = told.iter().fold([0.0; 2], |[sum, weights], [value, weight]| {
        [sum + value, weights + weight]
    });
    let value = sum / weights;
    let quantile = StudentsT::new(0.0, 1.0, trials - 1.0).ok()?.inverse_cdf(1.0 - tail);
    let left: f64 = told.iter().map(|[part, weight]| (part - value * weight).powi(2)).sum();
    let error = (left * trials / (trials - 1.0)).sqrt() / weights.abs();
    let half = (quantile * error).max(resolution * value.abs());
    half.is_finite().then_some((value, [value - half, value + half]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R: `t.test(c(1, 2, 4), conf.level = 0.9998)$conf.int`, whose quantile is `qt(0.9999, 2)` = 70.70007 and whose standard error √(7/9).
    #[test]
    fn an_interval_is_students_far_out_in_its_tails() {
        let parts = [1.0, 2.0, 4.0].map(|value| [value, 1.0]);
        let (value, [low, high]) = estimate(&parts, 1e-4, 0.0).unwrap();
        let half = 70.70007 * (7.0_f64 / 9.0).sqrt();
        assert!((value - 7.0 / 3.0).abs() < 1e-12);
        assert!(((high - low) / 2.0 / half - 1.0).abs() < 1e-5, "{low} {high} {half}");
    }

    #[test]
    fn trials_that_all_give_the_same_are_resolved_no_finer_than_records_are() {
        let (value, [low, high]) = estimate(&[[2.0, 1.0]; 3], 1e-4, 1e-6).unwrap();
        assert_eq!(value.to_bits(), 2.0_f64.to_bits());
        assert!((high - low - 4e-6).abs() < 1e-12);
    }

    #[test]
    fn a_single_trial_and_none_tell_nothing() {
        assert_eq!(estimate(&[[2.0, 1.0]], 1e-4, 1e-6), None);
        assert_eq!(estimate(&[], 1e-4, 1e-6), None);
        assert_eq!(estimate(&[[0.0, 0.0]; 5], 1e-4, 1e-6), None);
    }
}

//! Predictions held against the figures of a run.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::scene::Scene;
use super::{Holds, Prediction, Preflight};
use crate::metrics::summary::TopicBandwidth;
use crate::metrics::{Estimate, Summary};
use crate::scenario::Scenario;

/// Probability that chance alone makes a run disagree with any of the predictions that it is held against.
const CHANCE: f64 = 0.05;
/// Mistakes, expected or made, from which their figures say something.
const FEWEST_MISTAKES: f64 = 10.0;

/// A figure of a run that is not what was predicted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Surprise {
    /// The prediction, for trials as long as the run's were.
    pub predicted: Prediction,
    /// The run's figure, in the same unit, with its 95 % interval.
    pub measured: Estimate,
    /// What in the run may explain it.
    pub why: String,
}

/// Where the run that `summary` tells of disagrees with what closed forms say of `scenario`, of which it is the run. A figure
/// counts only if its prediction should hold for the run. It disagrees if the prediction, give or take its accuracy, lies outside the
/// figure's interval, taken so wide that chance makes any of all those compared disagree in one run of twenty (Bonferroni).
/// A single trial has no intervals, and disagrees with nothing.
#[must_use]
pub fn surprises(scenario: &Scenario, summary: &Summary) -> Vec<Surprise> {
    if summary.trials == 0 {
        return Vec::new();
    }
    let preflight = Preflight::lasting(scenario, summary.simulated_s.value / summary.trials as f64);
    let scene = Scene::of(scenario, scenario.time_limit.get());
    let compared: Vec<(&Prediction, Estimate)> = preflight
        .predictions
        .iter()
        .filter_map(|prediction| Some((prediction, compared(prediction, scenario, summary)?)))
        .collect();
    let family = compared.len();
    compared
        .into_iter()
        .filter(|(prediction, measured)| !agrees(prediction.value, prediction.accuracy, measured, family))
        .map(|(prediction, measured)| Surprise {
            predicted: prediction.clone(),
            measured,
            why: explanation(prediction.name, &scene, summary),
        })
        .collect()
}

/// The figure that `prediction` is about, if it should hold for the run.
fn compared(prediction: &Prediction, scenario: &Scenario, summary: &Summary) -> Option<Estimate> {
    let detection = &summary.detection;
    // Detectors are judged by the time in which robots are in range of each other, so that what holds of those holds of the run.
    let holds = match prediction.holds {
        Holds::Throughout | Holds::InRange => true,
        Holds::AtStart | Holds::AtEnd => false,
    };
    let mistakes = detection.mistakes.value as f64;
    let made = mistakes >= FEWEST_MISTAKES;
    let measured = match prediction.name {
        "loss_ratio" => Some(lost(summary)),
        "overlap_ratio" if overlaps_are_lost(scenario) => Some(lost(summary)),
        "radio.airtime_share" => summary.radio.as_ref().map(|radio| radio.airtime_share.estimate),
        "radio.energy_J" => summary.radio.as_ref().map(|radio| radio.energy.estimate),
        "latency_s" => Some(summary.latency_s.mean),
        "status_tx_bytes_per_step" => Some(status(summary)?.directions.tx_bytes_per_step.mean),
        "status_rx_bytes_per_step" => Some(status(summary)?.directions.rx_bytes_per_step.mean),
        "mistake_rate_hz" => {
            let expected = prediction.value * detection.monitored_s.value;
            (expected.max(mistakes) >= FEWEST_MISTAKES).then_some(detection.mistake_rate_hz.estimate)
        }
        "mistake_duration_s" => made.then_some(detection.mistake_duration_s.estimate),
        "query_accuracy" => made.then_some(detection.query_accuracy.estimate),
        "detection_time_s" => Some(detection.detection_time_s.estimate),
        _ => None,
    };
    measured.filter(|_| holds)
}

/// Whether whatever overlaps is lost.
fn overlaps_are_lost(scenario: &Scenario) -> bool {
    let radio = scenario.radio.shared();
    radio.is_some_and(|radio| radio.phy().capture == Some(f64::INFINITY))
}

/// The share of copies lost.
fn lost(summary: &Summary) -> Estimate {
    let delivered = summary.delivery_ratio.estimate;
    let lost = |delivered: f64| 1.0 - delivered;
    let [low, high] = delivered.ci95.map(|end| end.map(lost));
    Estimate {
        value: delivered.value.map(lost),
        ci95: [high, low],
        ..delivered
    }
}

fn status(summary: &Summary) -> Option<&TopicBandwidth> {
    let topics = summary.bandwidth.by_topic.0.iter();
    topics
        .clone()
        .find(|(topic, _)| topic == "status")
        .map(|(_, bandwidth)| bandwidth)
}

/// Whether a prediction is within `accuracy` of the interval of one of `family` figures.
fn agrees(predicted: f64, accuracy: f64, measured: &Estimate, family: usize) -> bool {
    let (Some(value), [Some(low), Some(high)]) = (measured.value, measured.ci95) else {
        return true;
    };
    let wider = widening(measured.n, family);
    let (low, high) = (value + wider * (low - value), value + wider * (high - value));
    // Figures are sums of many roundings.
    let accuracy = accuracy + 1e-9 * predicted.abs();
    predicted + accuracy >= low && predicted - accuracy <= high
}

/// How much wider Student's interval of `trials` is at the level of one of `family` than at 95 %.
fn widening(trials: u64, family: usize) -> f64 {
    let Ok(student) = StudentsT::new(0.0, 1.0, trials.saturating_sub(1) as f64) else {
        return 1.0;
    };
    let quantile = |family: f64| student.inverse_cdf(1.0 - CHANCE / 2.0 / family);
    quantile(family as f64) / quantile(1.0)
}

/// A word on what may have made the figure another than was predicted.
fn explanation(name: &str, scene: &Scene<'_>, summary: &Summary) -> String {
    let fates = &summary.frames.total;
    let others = fates
        .lost
        .0
        .iter()
        .filter(|(cause, lost)| cause != "channel" && *lost > 0);
    let others: Vec<String> = others
        .map(|(cause, lost)| {
            let share = 100.0 * *lost as f64 / fates.offered as f64;
            format!("{} {share:.2} %", cause.replace('_', " "))
        })
        .collect();
    let mut reasons = Vec::new();
    let of_losses = !matches!(name, "latency_s" | "status_tx_bytes_per_step");
    if of_losses && !others.is_empty() {
        reasons.push(format!("copies were lost beside the channel ({})", others.join(", ")));
    }
    if summary
        .faults
        .as_ref()
        .is_some_and(|faults| faults.robots.estimate.value > Some(0.0))
    {
        reasons.push("robots failed, and who fails neither sends nor hears as before".to_owned());
    }
    let moves = matches!(name, "loss_ratio" | "status_rx_bytes_per_step");
    if moves && !scene.stands_still() {
        reasons.push("robots moved, and neighbours with them".to_owned());
    }
    reasons.extend(cut_off(name, summary));
    if reasons.is_empty() {
        "nothing in the run explains it: the model and its closed form may differ".to_owned()
    } else {
        reasons.join("; ")
    }
}

/// What the end of the run has to do with it.
fn cut_off(name: &str, summary: &Summary) -> Option<String> {
    let fates = &summary.frames.total;
    let detection = &summary.detection;
    let share = |part: u64, all: u64| 100.0 * part as f64 / all as f64;
    match name {
        "loss_ratio" | "latency_s" | "status_rx_bytes_per_step" if fates.in_flight > 0 => {
            let share = share(fates.in_flight, fates.offered);
            Some(format!("copies were still under way at the end ({share:.2} %)"))
        }
        "detection_time_s" if detection.detection_time_s.cut_off > 0 => {
            let share = share(detection.detection_time_s.cut_off, detection.failures.observed);
            Some(format!(
                "failures ended, or the run, before they were detected ({share:.2} %)"
            ))
        }
        "mistake_duration_s" | "query_accuracy" if detection.mistake_duration_s.cut_off > 0 => {
            let share = share(detection.mistake_duration_s.cut_off, detection.mistakes.value);
            Some(format!(
                "mistakes were cut off before they ended in trust ({share:.2} %)"
            ))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, half_width: f64, n: u64) -> Estimate {
        Estimate {
            value: Some(value),
            ci95: [Some(value - half_width), Some(value + half_width)],
            n,
        }
    }

    #[test]
    fn a_prediction_agrees_with_an_interval_within_its_accuracy_and_with_no_interval_always() {
        let measured = estimate(0.2, 0.01, 35);
        for (predicted, accuracy, agreed) in [(0.205, 0.0, true), (0.22, 0.0, false), (0.22, 0.0101, true)] {
            assert_eq!(
                agrees(predicted, accuracy, &measured, 1),
                agreed,
                "{predicted} ± {accuracy}"
            );
        }
        let single = Estimate {
            ci95: [None; 2],
            ..measured
        };
        assert!(agrees(0.9, 0.0, &single, 1));
    }

    #[test]
    fn an_interval_is_the_wider_the_more_figures_are_compared() {
        // scipy.stats.t.ppf(1 − 0.025/8, 34) / scipy.stats.t.ppf(0.975, 34) = 2.9151 / 2.0322
        assert!((widening(35, 8) - 1.434_454_7).abs() < 1e-6, "{}", widening(35, 8));
        assert!((widening(35, 1) - 1.0).abs() < 1e-12);
        assert!(agrees(0.213, 0.0, &estimate(0.2, 0.01, 35), 8) && !agrees(0.213, 0.0, &estimate(0.2, 0.01, 35), 1));
    }
}

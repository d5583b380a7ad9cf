//! The figures of a report in a few lines, with their intervals.

use super::PageInput;
use super::detection;
use crate::metrics::summary::Spread;
use crate::predict;
use crate::report::number::{self, count, estimate, figure, percent, seconds};
use crate::report::{air, further, surprises};

/// What was found, a name and a value each.
pub fn rows(input: &PageInput) -> Vec<(String, String)> {
    let summary = input.summary;
    let mut rows = Vec::new();
    let completion = &summary.completion_ratio.estimate;
    if completion.value.is_some() {
        let of = format!("{} of {} trials", count(summary.completed), count(completion.n));
        rows.push(("missions complete", format!("{}: {of}", estimate(completion, percent))));
        let steps = estimate(&summary.steps_to_completion.median, figure);
        rows.push(("steps to completion, Kaplan–Meier median", steps));
    }
    let spread = |spread: &Spread| {
        let [least, most] = [spread.min, spread.max].map(number::maybe);
        format!(
            "{} B/step; from {least} to {most} of single robots",
            estimate(&spread.mean, figure)
        )
    };
    rows.push((
        "a robot sends, mean",
        spread(&summary.bandwidth.total.tx_bytes_per_step),
    ));
    rows.push((
        "a robot receives, mean",
        spread(&summary.bandwidth.total.rx_bytes_per_step),
    ));
    rows.push(("copies delivered", estimate(&summary.delivery_ratio.estimate, percent)));
    if let (Some(p50), Some(p95), Some(p99)) = (summary.latency_s.p50, summary.latency_s.p95, summary.latency_s.p99) {
        let words = format!("{}, {}, {}", seconds(p50), seconds(p95), seconds(p99));
        rows.push(("latency: median, 95 %, 99 %", words));
    }
    if summary.lambda2_min.min.is_some() {
        rows.push((
            "least λ₂, median of trials",
            estimate(&summary.lambda2_min.estimate, figure),
        ));
        rows.push((
            "in one piece, share of the time",
            estimate(&summary.connected_share.estimate, percent),
        ));
    }
    if let Some(faults) = &summary.faults {
        rows.push((
            "robots that failed in a trial",
            estimate(&faults.robots.estimate, figure),
        ));
    }
    rows.extend(detection::quality(input));
    if let Some(spread) = &summary.spread {
        let informed = estimate(&spread.informed_ratio.estimate, percent);
        rows.push(("pairs of a robot and a rumour informed at the end", informed));
        let time = estimate(&spread.time_to_all.median, seconds);
        rows.push(("until all were, Kaplan–Meier median", time));
    }
    if summary.duplicates.any() {
        let share = estimate(&summary.duplicates.total, percent);
        rows.push(("duplicates in the messages delivered", share));
    }
    let mut rows: Vec<(String, String)> = rows.into_iter().map(|(name, words)| (name.to_owned(), words)).collect();
    let of_air = air::rows(summary).into_iter();
    rows.extend(of_air.map(|(name, words)| (format!("air: {name}"), words)));
    rows.extend(further::rows(summary));
    let surprises = predict::surprises(input.scenario, summary);
    for (together, why) in surprises::by_reason(&surprises) {
        let figures: Vec<_> = together.into_iter().map(surprises::words).collect();
        rows.push(("not as predicted".to_owned(), format!("{}: {why}", figures.join("; "))));
    }
    rows
}

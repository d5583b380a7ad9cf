//! How well robots knew who had failed.

use plotly::Bar;
use plotly::common::{LineShape, Marker, Orientation};
use plotly::layout::HoverMode;

use super::PageInput;
use super::chart::{axis, cause_colour, chart, line, one_value, percent_axis, stacked, words};
use super::data::ecdf;
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::DataTable;
use crate::metrics::detection::{Cause, FailureOutcome, Verdict};
use crate::metrics::summary::Measured;
use crate::protocol::detector::DetectorConfig;
use crate::report::number;

/// Suspicions by verdict and cause.
pub fn suspicions(input: &PageInput) -> Option<Figure> {
    let all = || input.records.iter().flat_map(|record| &record.detection.suspicions);
    all().next()?;
    let count = |verdict: Verdict, cause: Cause| {
        all()
            .filter(|one| one.verdict() == verdict && one.cause == cause)
            .count() as u64
    };
    let mut table = DataTable::new(&["verdict", "cause", "suspicions"]);
    let names = Names::of(Verdict::ALL.map(said));
    let mut plot = stacked(axis("suspicions"), names.down());
    for (number, cause) in Cause::ALL.into_iter().enumerate() {
        let counts = Verdict::ALL.map(|verdict| count(verdict, cause));
        if counts.iter().all(|&count| count == 0) {
            continue;
        }
        for (verdict, count) in Verdict::ALL.into_iter().zip(counts).filter(|(_, count)| *count > 0) {
            table
                .rows
                .push(vec![said(verdict).into(), cause.name().into(), count.into()]);
        }
        let bars = Bar::new(counts.to_vec(), names.all())
            .name(words(cause.name()))
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(cause_colour(number)))
            .hover_template("%{y}: %{x}");
        plot.add_trace(bars);
    }
    let total = all().count() as u64;
    Some(Figure {
        id: "suspicions".into(),
        title: "Suspicions by verdict and cause".into(),
        caption: format!(
            "Each time that a robot came to believe that another was down, {}: {} times in all. Rows say what to make of it, held against a truth that \
             robots never see: right if the other could not send; out of range, or the observer deaf, if that is what kept its statuses away; else a \
             mistake. Colours say what most of the missed statuses suffered.",
            input.in_trials(),
            number::count(total)
        ),
        panels: vec![Panel::of_rows("", plot, Verdict::ALL.len())],
        key: Vec::new(),
        table,
    })
}

fn said(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Right => "right",
        Verdict::Mistake => "mistake",
        Verdict::OutOfRange => "out of range",
        Verdict::Observer => "observer deaf",
    }
}

/// How long detection took, and how long mistakes lasted.
pub fn times(input: &PageInput) -> Option<Figure> {
    let records = || input.records.iter().map(|record| &record.detection);
    let detected: Vec<f64> = records()
        .flat_map(|detection| &detection.failures)
        .filter_map(|failure| match failure.outcome {
            FailureOutcome::Detected(after) => Some(after.as_secs()),
            _ => None,
        })
        .collect();
    let mistaken: Vec<f64> = records()
        .flat_map(|detection| &detection.suspicions)
        .filter_map(|suspicion| suspicion.duration.map(crate::engine::Span::as_secs))
        .collect();
    let both = [
        (
            "Detection time T_D",
            "time from a failure to its detection, s",
            "failures detected",
            "#0072b2",
            detected,
        ),
        (
            "Mistake duration T_M",
            "time from a mistake to trust, s",
            "mistakes over",
            "#d55e00",
            mistaken,
        ),
    ];
    let mut table = DataTable::new(&["of", "time, s", "share that took no longer, %"]);
    let mut panels = Vec::new();
    let mut words = Vec::new();
    for (title, unit, what, colour, values) in both {
        if values.is_empty() {
            continue;
        }
        words.push(format!("{} {what}", number::count(values.len() as u64)));
        if let Some(value) = one_value(values.iter().copied()) {
            table.rows.push(vec![title.into(), value.into(), 100.0.into()]);
            panels.push(Panel::words(title, format!("{} each time.", number::seconds(value))));
            continue;
        }
        let curve: Vec<[f64; 2]> = ecdf(values)
            .into_iter()
            .map(|[time, share]| [time, share * 100.0])
            .collect();
        for [time, share] in &curve {
            table.rows.push(vec![title.into(), (*time).into(), (*share).into()]);
        }
        let start = curve.first().map(|[time, _]| [*time, 0.0]);
        let curve: Vec<[f64; 2]> = start.into_iter().chain(curve).collect();
        let mut plot = chart(axis(unit), percent_axis(what), HoverMode::Closest);
        plot.add_trace(
            line(
                title,
                colour,
                &curve,
                LineShape::Hv,
                "%{y:.1f} % within %{x:.4g} s<extra></extra>",
            )
            .show_legend(false),
        );
        panels.push(Panel::new(title, plot));
    }
    panels.first()?;
    Some(Figure {
        id: "detection-times".into(),
        title: "Detection times and mistakes".into(),
        caption: format!(
            "Which share took no longer than so many seconds ({}). Failures count once for each robot that watched; those that were never detected are counted under \
             “What was found”, not here.",
            words.join(", ")
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

/// Detection quality in numbers, a row a figure.
pub fn quality(input: &PageInput) -> Vec<(&'static str, String)> {
    let detection = &input.summary.detection;
    if input.scenario.detector == DetectorConfig::None {
        return vec![("failure detection", "none: robots ran no failure detector".to_owned())];
    }
    if detection.monitored_s.value <= 0.0 {
        return Vec::new();
    }
    let failures = &detection.failures;
    let seconds = |name, measured: &Measured| {
        let estimate = &measured.estimate;
        let value = estimate
            .value
            .map(|_| format!("{} s", number::estimate(estimate, number::figure)));
        value.map(|value| (name, value))
    };
    let accuracy = number::estimate(&detection.query_accuracy.estimate, number::percent);
    let mut rows = vec![("query accuracy P_A", accuracy)];
    rows.extend(seconds("mistake recurrence T_MR", &detection.mistake_recurrence_s));
    rows.extend(seconds("mistake duration T_M", &detection.mistake_duration_s));
    rows.extend(seconds("detection time T_D", &detection.detection_time_s));
    if failures.observed > 0 {
        let words = format!(
            "{} of {}",
            number::count(failures.detected),
            number::count(failures.observed)
        );
        rows.push(("failures detected by those who watched", words));
    }
    rows
}

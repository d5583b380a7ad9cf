//! How well robots knew who had failed.

use std::collections::BTreeMap;

use plotly::Bar;
use plotly::common::{LineShape, Marker, Orientation};
use plotly::layout::HoverMode;

use super::PageInput;
use super::chart::{axis, cause_colour, chart, line, one_value, percent_axis, stacked, words};
use super::data::over_by;
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::DataTable;
use crate::metrics::detection::{Cause, Verdict};
use crate::metrics::summary::Lasted;
use crate::protocol::detector::DetectorConfig;
use crate::report::number;
use crate::statistics::Estimate;

/// Suspicions by verdict and cause.
pub fn suspicions(input: &PageInput) -> Option<Figure> {
    let mut counted: BTreeMap<(Verdict, Cause), u64> = BTreeMap::new();
    for one in input.records().iter().flat_map(|record| &record.detection.suspicions) {
        *counted.entry((one.verdict(), one.cause)).or_default() += 1;
    }
    counted.first_key_value()?;
    let count = |verdict: Verdict, cause: Cause| counted.get(&(verdict, cause)).copied().unwrap_or(0);
    let mut table = DataTable::new(&["verdict", "cause", "suspicions"]);
    let names = Names::of(Verdict::ALL.map(said));
    let mut plot = stacked(axis("suspicions"), names.down());
    for cause in Cause::ALL {
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
            .marker(Marker::new().color(cause_colour(cause.name())))
            .hover_template("%{y}: %{x}");
        plot.add_trace(bars);
    }
    let total = counted.values().sum();
    Some(Figure {
        id: "suspicions".into(),
        title: "Suspicions by verdict and cause".into(),
        caption: format!(
            "Each time that a robot came to believe that another was down, {}: {} times in all. Rows say what to make of it, held against a truth that \
             robots never see: right if the other could not send; out of range, or the observer deaf, if that is what kept its statuses away; else a \
             mistake. Colours say what most of the missed statuses suffered.",
            input.in_drawn(),
            number::count(total)
        ),
        panels: vec![match table.rows.len() {
            1 => Panel::words("", only(&counted)),
            _ => Panel::of_rows("", plot, Verdict::ALL.len()),
        }],
        key: Vec::new(),
        table,
    })
}

/// What is said of suspicions that are all of one kind.
fn only(counted: &BTreeMap<(Verdict, Cause), u64>) -> String {
    let one = counted.iter().next();
    one.map_or_else(String::new, |((verdict, cause), count)| {
        format!(
            "All {} are of one kind: {}, {}.",
            number::count(*count),
            said(*verdict),
            cause.name().replace('_', " ")
        )
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
    let both = [
        (
            "Detection time T_D",
            "time from a failure to its detection, s",
            "failures detected",
            "#0072b2",
            input.trials.times("detection.detection_time_s"),
        ),
        (
            "Mistake duration T_M",
            "time from a mistake to trust, s",
            "mistakes over",
            "#d55e00",
            input.trials.times("detection.mistake_duration_s"),
        ),
    ];
    let mut table = DataTable::new(&["of", "time, s", "share that took no longer, %"]);
    let mut panels = Vec::new();
    let mut words = Vec::new();
    for (title, unit, what, colour, values) in both {
        let curve = over_by(values.iter());
        if curve.is_empty() {
            continue;
        }
        let over = values.iter().filter(|seen| seen.happened).count();
        words.push(format!(
            "{} {what}, {} cut off",
            number::count(over as u64),
            number::count((values.len() - over) as u64)
        ));
        if let Some(value) = one_value(values.iter().map(|seen| seen.time)).filter(|_| over == values.len()) {
            table.rows.push(vec![title.into(), value.into(), 100.0.into()]);
            panels.push(Panel::words(title, format!("{} each time.", number::seconds(value))));
            continue;
        }
        let curve: Vec<[f64; 2]> = curve.into_iter().map(|[time, share]| [time, share * 100.0]).collect();
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
            "Which share took no longer than so many seconds ({}). Failures count once for each robot that watched. What was cut off, by the end of the run or \
             by another failure, counts as having taken longer than that (Kaplan–Meier).",
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
    let told = |name, estimate: &Estimate, words: String| estimate.value.map(|_| (name, words));
    let recurrence = &detection.mistake_recurrence_s.estimate;
    let lasted = |name, lasted: &Lasted| told(name, &lasted.estimate, number::lasted(lasted));
    let accuracy = number::estimate(&detection.query_accuracy.estimate, number::percent);
    let mut rows = vec![("query accuracy P_A", accuracy)];
    let words = format!("{} s", number::estimate(recurrence, number::figure));
    rows.extend(told("mistake recurrence T_MR", recurrence, words));
    rows.extend(lasted("mistake duration T_M", &detection.mistake_duration_s));
    rows.extend(lasted("detection time T_D", &detection.detection_time_s));
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

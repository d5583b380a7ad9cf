//! The report's section on rumours.

use super::layout::Page;
use super::number::{estimate, percent, seconds};
use crate::metrics::Summary;
use crate::metrics::summary::SpreadTime;

/// How rumours spread; nothing where there were none.
pub fn section(page: &mut Page, summary: &Summary) {
    let Some(spread) = &summary.spread else {
        return;
    };
    page.heading("Spread of rumours");
    let informed = estimate(&spread.informed_ratio.estimate, percent);
    page.entry(
        "informed",
        &format!("{informed} of pairs of a robot and a rumour at the end"),
    );
    for (name, time) in [("half after", &spread.time_to_half), ("all after", &spread.time_to_all)] {
        page.entry(name, &took(time));
    }
}

fn took(time: &SpreadTime) -> String {
    let median = format!(
        "{}: Kaplan–Meier median of {} trials",
        estimate(&time.median, seconds),
        time.median.n
    );
    match time.mean.value {
        Some(_) => format!("{median}; {} on average", estimate(&time.mean, seconds)),
        None => median,
    }
}

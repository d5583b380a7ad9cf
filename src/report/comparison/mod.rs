//! Settings compared, as text for people.

mod describe;
mod factors;
mod finding;
mod rows;
mod tables;
mod words;

pub use describe::describe;
#[cfg(feature = "command")]
pub(super) use words::{fitted, label, stopping};

use std::path::Path;

use super::layout::Page;
use super::number::count;
use crate::metrics::comparison::{Comparison, Verdict};
use crate::text::{Style, shown};

/// What the report of a comparison is made of.
#[derive(Debug)]
pub struct ComparisonInput<'a> {
    /// The comparison, [`describe`]d.
    pub comparison: &'a Comparison,
    /// Where the results are.
    pub folder: &'a Path,
    /// Names of the files there.
    pub files: &'a [&'a str],
    /// How it is laid out.
    pub style: Style,
}

/// The report as text.
#[must_use]
pub fn comparison(input: &ComparisonInput) -> String {
    let comparison = input.comparison;
    let mut page = Page::new(input.style);
    page.title(&comparison.study, comparison.question.as_deref());
    page.heading("Finding");
    page.words(&comparison.finding);
    tables::settings(&mut page, comparison);
    tables::differences(&mut page, comparison);
    tables::gains(&mut page, comparison);
    tables::pareto(&mut page, comparison);
    page.heading("Study");
    page.entry("compared", &compared(comparison));
    if let Some(stopping) = &comparison.stopping {
        page.entry("stopped", &words::stopping(stopping, comparison));
    }
    page.entry("results", &shown(input.folder));
    page.entry("", &input.files.join(", "));
    page.gap();
    page.words("Figures in brackets are 95 % intervals over trials.");
    page.text()
}

/// What was compared, and how.
pub(super) fn compared(comparison: &Comparison) -> String {
    let trials = comparison.settings.iter().map(|setting| setting.trials);
    let (least, most) = (trials.clone().min().unwrap_or(0), trials.max().unwrap_or(0));
    let trials = if least == most {
        count(most)
    } else {
        format!("{} to {}", count(least), count(most))
    };
    let how = if comparison.paired {
        "paired by common random numbers"
    } else {
        "independent: their seeds differ"
    };
    format!(
        "{} settings × {trials} trials, {how}; {}",
        comparison.settings.len(),
        family(comparison)
    )
}

/// Over what p-values are adjusted.
pub(super) fn family(comparison: &Comparison) -> String {
    let family = &comparison.family;
    let mut words = vec![format!(
        "p adjusted by Holm over {} test{}",
        count(family.tests),
        if family.tests == 1 { "" } else { "s" }
    )];
    if family.alike > 0 {
        let never = if has_gaps(comparison) {
            "never differs or has no value"
        } else {
            "never differs"
        };
        words.push(format!("without {} of what {never}", count(family.alike)));
    }
    if family.impossible > 0 {
        words.push(format!(
            "without {} that so few trials cannot decide",
            count(family.impossible)
        ));
    }
    words.join(", ")
}

/// Whether a setting has no value of something compared.
fn has_gaps(comparison: &Comparison) -> bool {
    comparison
        .pairs
        .iter()
        .any(|pair| pair.verdict == Verdict::NotComparable)
}

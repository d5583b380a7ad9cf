//! A protocol's own figures in words.

use super::number::{estimate, figure};
use crate::metrics::summary::NotedSummary;

/// The figure with its interval and its unit.
pub fn noted_words(noted: &NotedSummary) -> String {
    let words = estimate(&noted.estimate, figure);
    match &*noted.unit {
        "1" => words,
        unit => format!("{words} {unit}"),
    }
}

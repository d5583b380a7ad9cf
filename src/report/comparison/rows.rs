//! What the tables of a comparison share.

use crate::metrics::comparison::Verdict;
use crate::report::grid::Grid;
use crate::report::layout::Page;
use crate::report::number::NOTHING;

pub fn put(page: &mut Page, header: &[String], rows: impl Iterator<Item = Vec<String>>) {
    let mut grid = Grid::of_figures(header);
    rows.for_each(|row| grid.row(row));
    page.table(&grid);
}

/// A verdict in a word or two.
pub fn effect_verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Better => "better",
        Verdict::Worse => "worse",
        Verdict::NoDetectableDifference => "unclear",
        Verdict::CannotTell => "cannot tell",
        Verdict::NotComparable => NOTHING,
    }
}

//! What failed, marked where time runs from left to right.

use std::collections::BTreeMap;

use plotly::Plot;
use plotly::common::DashType;
use plotly::layout::{Shape, ShapeLayer, ShapeLine, ShapeType};

use super::PageInput;
use super::chart::shown;
use crate::engine::SimTime;
use crate::metrics::{FaultEpisode, FaultKind};

/// More marks of a kind than this are drawn together with their neighbours.
const MOST_MARKS: usize = 60;
const FAILS: &str = "#b2182b";
const RECOVERS: &str = "#009e73";
const LINKS: &str = "#7b3294";

/// Marks in a chart over time, in seconds, what failed in the trials and when.
pub fn mark(plot: &mut Plot, input: &PageInput) {
    let mut shapes: Vec<Shape> = Vec::new();
    let ends = |which: fn(&FaultEpisode) -> Option<SimTime>| {
        let episodes = input.records.iter().flat_map(|record| &record.faults);
        episodes
            .filter(|episode| episode.kind.robot().is_some())
            .filter_map(which)
            .collect()
    };
    let begun: Vec<SimTime> = ends(|episode| Some(episode.from));
    let over: Vec<SimTime> = ends(|episode| episode.until);
    for (times, colour) in [(over, RECOVERS), (begun, FAILS)] {
        shapes.extend(marks(&times).into_iter().map(|(at, share)| {
            let line = ShapeLine::new().color(colour).width(1.2).dash(DashType::Dot);
            let opacity = 0.25 + 0.6 * share;
            whole_height(ShapeType::Line, [at, at]).line(line).opacity(opacity)
        }));
    }
    let of_links = |record: &crate::metrics::TrialRecord| {
        let episodes = record.faults.iter().filter(|episode| is_of_links(&episode.kind));
        let end = record.simulated;
        episodes
            .map(|episode| (episode.from, episode.until.unwrap_or(end)))
            .collect::<Vec<_>>()
    };
    let mut stretches: BTreeMap<(SimTime, SimTime), usize> = BTreeMap::new();
    for stretch in input.records.iter().flat_map(of_links) {
        *stretches.entry(stretch).or_default() += 1;
    }
    for ((from, until), trials) in stretches.into_iter().take(MOST_MARKS) {
        let share = trials as f64 / input.records.len() as f64;
        let stretch = whole_height(ShapeType::Rect, [from.as_secs(), until.as_secs()]);
        let stretch = stretch.fill_color(LINKS).line(ShapeLine::new().width(0.0));
        shapes.push(stretch.opacity(0.06 + 0.12 * share));
    }
    if !shapes.is_empty() {
        let layout = plot.layout().clone().shapes(shapes);
        plot.set_layout(layout);
    }
}

/// What the marks are, for captions; nothing where nothing failed.
pub fn words(input: &PageInput) -> String {
    let any = |is_it: fn(&FaultKind) -> bool| {
        let mut episodes = input.records.iter().flat_map(|record| &record.faults);
        episodes.any(|episode| is_it(&episode.kind))
    };
    let mut words = String::new();
    if any(|kind| kind.robot().is_some()) {
        words.push_str(" Dotted lines: robots fail (red) and recover (green), the fainter, the fewer at a time.");
    }
    if any(is_of_links) {
        words.push_str(" Shaded: links are in trouble.");
    }
    words
}

fn is_of_links(kind: &FaultKind) -> bool {
    matches!(kind, FaultKind::Burst | FaultKind::Partition)
}

/// A shape over the whole height of a chart.
fn whole_height(kind: ShapeType, [from, to]: [f64; 2]) -> Shape {
    Shape::new()
        .shape_type(kind)
        .layer(ShapeLayer::Below)
        .x_ref("x")
        .y_ref("paper")
        .x0(shown(from))
        .x1(shown(to))
        .y0(0.0)
        .y1(1.0)
}

/// Where to draw marks for `times`, seconds, and what share of the most at one place each stands for.
fn marks(times: &[SimTime]) -> Vec<(f64, f64)> {
    let mut counts: BTreeMap<SimTime, usize> = BTreeMap::new();
    for &time in times {
        *counts.entry(time).or_default() += 1;
    }
    let counts: Vec<(SimTime, usize)> = counts.into_iter().collect();
    let together = counts.len().div_ceil(MOST_MARKS).max(1);
    let marks: Vec<(f64, usize)> = counts
        .chunks(together)
        .map(|chunk| {
            (
                chunk[chunk.len() / 2].0.as_secs(),
                chunk.iter().map(|(_, count)| count).sum(),
            )
        })
        .collect();
    let most = marks.iter().map(|(_, count)| *count).max().unwrap_or(1) as f64;
    marks.into_iter().map(|(at, count)| (at, count as f64 / most)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_at_one_time_are_one_mark_and_many_are_drawn_with_their_neighbours() {
        let at = |seconds: f64| SimTime::from_secs(seconds);
        let planned = marks(&[at(50.0), at(50.0), at(50.0), at(70.0)]);
        assert_eq!(planned, [(50.0, 1.0), (70.0, 1.0 / 3.0)]);
        let many: Vec<SimTime> = (0..1000).map(|number| at(f64::from(number))).collect();
        let marks = marks(&many);
        assert!(
            marks.len() <= MOST_MARKS && marks.len() > MOST_MARKS / 2,
            "{}",
            marks.len()
        );
        assert!(marks.iter().all(|(_, share)| *share > 0.1));
    }
}

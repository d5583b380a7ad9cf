//! What failed, and who was suspected, marked where time runs from left to right: all of it in rows above the chart, folded where it is
//! much, and, through the chart, what is the same in every trial.

use std::borrow::Cow;

use plotly::color::Rgba;
use plotly::common::{DashType, Font, HoverInfo, Line, Marker, MarkerSymbol, Mode};
use plotly::layout::{Axis, AxisRange, HoverMode, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Plot, Scatter};

use super::PageInput;
use super::chart::{INK, chart, faint, shown};
use super::figure::{HEIGHT, Panel};
use super::happened::{Mark, What, common, folded, happenings, stretches};

/// Lines through a chart; where there were more, none are drawn.
const MOST_LINES: usize = 30;
/// Height of a row, CSS pixels.
const ROW: f64 = 15.0;
/// Room between the rows and the chart, as a share of a row.
const GAP: f64 = 0.6;
/// Height of a chart's plane, without what stands around it, CSS pixels.
const PLANE: f64 = HEIGHT as f64 - 85.0;

/// What is marked in the charts of a page; by default nothing.
#[derive(Default)]
pub struct Marks {
    rows: Vec<(What, Vec<Mark>)>,
    /// Through the chart, seconds.
    lines: Vec<(What, f64)>,
    /// Stretches in which links were in trouble, in any trial, and whether in all of them.
    stretches: Vec<([f64; 2], bool)>,
    words: String,
    /// Units of the charts' axis in a second.
    per_second: f64,
}

impl Marks {
    /// What happened in the trials of a page, for charts over seconds.
    pub fn of(input: &PageInput) -> Self {
        let records = input.records();
        let mut rows = Vec::new();
        let mut lines = Vec::new();
        for what in What::ALL {
            let happenings = happenings(records, what);
            if happenings.is_empty() {
                continue;
            }
            if matches!(what, What::Fails | What::Recovers) {
                lines.extend(common(&happenings, records.len()).into_iter().map(|at| (what, at)));
            }
            rows.push((what, folded(&happenings, what, records.len())));
        }
        if lines.len() > MOST_LINES {
            lines.clear();
        }
        let stretches = stretches(records);
        let words = words(&rows, &lines, &stretches, &any_of(input));
        Self {
            rows,
            lines,
            stretches,
            words,
            per_second: 1.0,
        }
    }

    /// The same, for charts over control steps of so many seconds.
    pub fn in_steps(self, period_s: f64) -> Self {
        Self {
            per_second: 1.0 / period_s,
            ..self
        }
    }

    /// What the marks are, for captions; nothing where nothing happened.
    pub fn words(&self) -> &str {
        &self.words
    }

    /// A chart over time without data yet, with room for the marks.
    pub fn chart(&self, x: Axis, y: Axis) -> Plot {
        if self.rows.is_empty() {
            return chart(x, y, HoverMode::Closest);
        }
        let share = self.strip() / (PLANE + self.strip());
        let mut plot = chart(x, y.domain(&[0.0, 1.0 - share]), HoverMode::Closest);
        let layout = plot.layout().clone();
        plot.set_layout(layout.y_axis2(self.above(share)).shapes(self.shapes(share)));
        plot
    }

    /// Such a chart as a panel, with the marks in it.
    pub fn panel(&self, title: impl Into<Cow<'static, str>>, mut plot: Plot) -> Panel {
        let last = self.rows.len().saturating_sub(1);
        for (place, (what, marks)) in self.rows.iter().enumerate() {
            let row = (last - place) as f64;
            if *what == What::Links {
                plot.add_trace(self.troubled(row));
            }
            plot.add_trace(self.ticks(*what, marks, row));
        }
        Panel::of_height(title, plot, HEIGHT + self.strip() as u32)
    }

    /// Height of the rows above a chart, CSS pixels.
    fn strip(&self) -> f64 {
        match self.rows.len() {
            0 => 0.0,
            rows => ROW * (rows as f64 + GAP),
        }
    }

    /// A time on the chart's axis.
    fn along(&self, at_s: f64) -> f64 {
        shown(at_s * self.per_second)
    }

    /// The rows, which take this share of the height with the gap below them.
    fn above(&self, share: f64) -> Axis {
        let rows = self.rows.len();
        let names = self.rows.iter().rev().map(|(what, _)| what.name().to_owned());
        Axis::new()
            .domain(&[1.0 - share * rows as f64 / (rows as f64 + GAP), 1.0])
            .range(AxisRange::new(-0.5, rows as f64 - 0.5))
            .tick_values((0..rows).map(|row| row as f64).collect())
            .tick_text(names.collect())
            .tick_font(Font::new().size(10).color(INK))
            .show_grid(false)
            .zero_line(false)
            .fixed_range(true)
            .auto_margin(true)
    }

    /// What goes through the chart.
    fn shapes(&self, share: f64) -> Vec<Shape> {
        let through = |kind: ShapeType, [from, until]: [f64; 2]| {
            Shape::new()
                .shape_type(kind)
                .layer(ShapeLayer::Below)
                .x_ref("x")
                .y_ref("paper")
                .x0(self.along(from))
                .x1(self.along(until))
                .y0(0.0)
                .y1(1.0 - share)
        };
        let shaded = self.stretches.iter().filter(|(_, always)| *always).map(|(ends, _)| {
            let stretch = through(ShapeType::Rect, *ends).fill_color(What::Links.colour());
            stretch.line(ShapeLine::new().width(0.0)).opacity(0.14)
        });
        let lines = self.lines.iter().map(|(what, at)| {
            let dash = if *what == What::Fails {
                DashType::Dot
            } else {
                DashType::Dash
            };
            let line = ShapeLine::new().color(what.colour()).width(1.2).dash(dash);
            through(ShapeType::Line, [*at, *at]).line(line).opacity(0.8)
        });
        shaded.chain(lines).collect()
    }

    /// The stretches in which links were in trouble, along their row.
    fn troubled(&self, row: f64) -> Box<Scatter<Option<f64>, Option<f64>>> {
        let ends = |[from, until]: [f64; 2]| [Some(self.along(from)), Some(self.along(until)), None];
        let x = self.stretches.iter().flat_map(|(stretch, _)| ends(*stretch)).collect();
        let y = self.stretches.iter().flat_map(|_| [Some(row), Some(row), None]);
        Scatter::new(x, y.collect())
            .mode(Mode::Lines)
            .line(Line::new().color(faint(What::Links.colour(), 0.45)).width(5.0))
            .y_axis("y2")
            .show_legend(false)
            .hover_info(HoverInfo::Skip)
    }

    /// The marks of a row.
    fn ticks(&self, what: What, marks: &[Mark], row: f64) -> Box<Scatter<f64, f64>> {
        let most = marks.iter().map(|mark| mark.count).max().unwrap_or(1) as f64;
        let colour = |mark: &Mark| faint(what.colour(), 0.4 + 0.6 * mark.count as f64 / most);
        let colours: Vec<Rgba> = marks.iter().map(colour).collect();
        let look = Marker::new().symbol(MarkerSymbol::LineNSOpen).size(9);
        Scatter::new(
            marks.iter().map(|mark| self.along(mark.at_s)).collect(),
            vec![row; marks.len()],
        )
        .name(what.name())
        .mode(Mode::Markers)
        .marker(look.color_array(colours).line(Line::new().width(1.8)))
        .hover_text_array(marks.iter().map(|mark| mark.words.clone()).collect())
        .hover_template("%{hovertext}<extra></extra>")
        .y_axis("y2")
        .show_legend(false)
    }
}

/// In which trials something is marked, and in which it is where it goes through the chart.
fn any_of(input: &PageInput) -> [String; 2] {
    match (input.drawn(), input.trials.count()) {
        (Some([drawn, _]), _) => [
            format!("in any of {drawn} trials, spread evenly"),
            format!(" in all of these {drawn} trials"),
        ],
        (None, 1) => ["in the trial".to_owned(), String::new()],
        (None, _) => ["in any of the trials".to_owned(), " in every trial".to_owned()],
    }
}

fn words(
    rows: &[(What, Vec<Mark>)],
    lines: &[(What, f64)],
    stretches: &[([f64; 2], bool)],
    [any, every]: &[String; 2],
) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let has = |what: What| rows.iter().any(|(row, _)| *row == what);
    let mut marked = Vec::new();
    if has(What::Fails) {
        marked.push(if has(What::Recovers) {
            "robots fail and recover"
        } else {
            "robots fail"
        });
    }
    if has(What::Links) {
        marked.push("links are in trouble");
    }
    if has(What::Right) || has(What::Other) {
        marked.push("robots suspect others, rightly or not (mistaken, out of range, or deaf themselves)");
    }
    let folded = rows.iter().any(|(_, marks)| marks.iter().any(|mark| mark.count > 1));
    let mut words = format!(
        " Above the chart is marked when {}, {}{}.",
        marked.join("; "),
        any,
        if folded { ", the darker, the more at a time" } else { "" }
    );
    let mut through = Vec::new();
    if lines.iter().any(|(what, _)| *what == What::Fails) {
        through.push(format!("dotted where robots fail{every}"));
    }
    if lines.iter().any(|(what, _)| *what == What::Recovers) {
        through.push(format!("dashed where they recover{every}"));
    }
    if !through.is_empty() {
        words = format!("{words} Lines through the chart are {}.", through.join(", "));
    }
    if stretches.iter().any(|(_, always)| *always) {
        words = format!("{words} It is shaded while links are in trouble{every}.");
    }
    words
}

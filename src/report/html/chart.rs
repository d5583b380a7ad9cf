//! Charts of one look: quiet axes, the same colour for the same thing, words instead of codes.

use plotly::color::Rgba;
use plotly::common::{Anchor, Font, HoverInfo, Label, Line, LineShape, Mode, Orientation, Title};
use plotly::configuration::{Configuration, DisplayModeBar, ModeBarButtonName};
use plotly::layout::{Axis, AxisRange, BarMode, HoverMode, Legend, Margin, TraceOrder};
use plotly::{Layout, Plot, Scatter};

use crate::metrics::comparison::apart;
use crate::metrics::detection::Cause;

/// Ink of axes and words.
pub const INK: &str = "#333333";
/// Lines of the grid.
pub const GRID: &str = "#e6e6e6";
/// All topics together, and whatever else is one of its kind.
pub const ALL: &str = "#1a1a1a";
/// What robots send, and what they receive.
pub const DIRECTIONS: [&str; 2] = ["#0072b2", "#d55e00"];

/// Okabe and Ito's colours, which colour-blind readers tell apart.
const TOPICS: [&str; 7] = [
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c510a",
];
/// In the order of [`Cause::ALL`].
const CAUSES: [&str; Cause::ALL.len()] = [
    "#b2182b", "#ef8a62", "#7b3294", "#999999", "#c2a5cf", "#4d4d4d", "#d9b38c", "#1b7837", "#80cdc1", "#4393c3",
    "#fdb863", "#35978f", "#8c510a", "#053061", "#e7298a", "#a6d854", "#fde725",
];
/// Room above a chart for the buttons that a pointer brings up, CSS pixels.
pub const TOOLS: u32 = 30;

/// The colour of topic number `topic`.
pub fn topic_colour(topic: usize) -> &'static str {
    TOPICS[topic % TOPICS.len()]
}

/// The colour of a cause, of a loss or of whatever else kept messages away, by its name, with blanks or without: the same in all figures.
pub fn cause_colour(name: &str) -> &'static str {
    let mut known = Cause::ALL.iter().zip(CAUSES);
    let found = known.find(|(cause, _)| cause.name() == name.replace(' ', "_"));
    found.map_or(ALL, |(_, colour)| colour)
}

/// The colour of role number `index`, called `name`, as the pictures have it.
pub fn role_colour(name: &str, index: usize) -> &'static str {
    match name {
        "root" => "#000000",
        "worker" => "#d55e00",
        "networker" => "#0072b2",
        "free" => "#7f7f7f",
        _ => TOPICS[(index + 1) % TOPICS.len()],
    }
}

/// `colour`, a `#rrggbb`, seen through.
pub fn faint(colour: &str, opacity: f64) -> Rgba {
    let part = |at: usize| {
        colour
            .get(at..at + 2)
            .and_then(|hex| u8::from_str_radix(hex, 16).ok())
            .unwrap_or(0)
    };
    Rgba::new(part(1), part(3), part(5), opacity)
}

/// A name as a chart shows it: plotly takes some tags for its own.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Words as a chart shows them, blanks between.
pub fn words(text: &str) -> String {
    escaped(text).replace('_', " ")
}

/// The value of all `values`, if they are one but for rounding: no chart is needed to see that.
pub fn one_value(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values = values.into_iter();
    let first = values.next()?;
    values.all(|value| apart(value, first) == 0.0).then_some(first)
}

/// Rounded to what a screen can show; what is exact stands in the table.
pub fn shown(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = 10_f64.powi(5 - value.abs().log10().ceil() as i32);
    if scale.is_finite() && scale > 0.0 {
        (value * scale).round() / scale
    } else {
        value
    }
}

/// An axis of numbers, with what they are and their unit.
pub fn axis(title: &str) -> Axis {
    bare(title)
        .zero_line(false)
        .show_grid(true)
        .range_mode(plotly::layout::RangeMode::ToZero)
}

/// An axis of shares in percent.
pub fn percent_axis(title: &str) -> Axis {
    axis(title).range(AxisRange::new(-2.0, 102.0)).tick_suffix(" %")
}

/// An axis with its title and nothing else.
pub fn bare(title: &str) -> Axis {
    Axis::new()
        .title(Title::with_text(title).font(Font::new().size(12).color(INK)))
        .line_color(INK)
        .grid_color(GRID)
        .tick_font(Font::new().size(11).color(INK))
        .auto_margin(true)
}

/// A legend above the chart.
pub fn legend() -> Legend {
    Legend::new()
        .orientation(Orientation::Horizontal)
        .trace_order(TraceOrder::Normal)
        .x(0.0)
        .x_anchor(Anchor::Left)
        .y(1.02)
        .y_anchor(Anchor::Bottom)
        .font(Font::new().size(11))
}

/// A chart with these axes and no data yet.
pub fn chart(x: Axis, y: Axis, hover: HoverMode) -> Plot {
    let layout = Layout::new()
        .x_axis(x)
        .y_axis(y)
        .legend(legend())
        .hover_mode(hover)
        .hover_label(Label::new().font(Font::new().size(12)).name_length(40))
        .margin(Margin::new().left(8).right(12).top(TOOLS as usize).bottom(8))
        .font(Font::new().family("system-ui, sans-serif").size(12).color(INK))
        .paper_background_color("#ffffff")
        .plot_background_color("#ffffff");
    let mut plot = Plot::new();
    plot.set_layout(layout);
    plot.set_configuration(
        Configuration::new()
            .responsive(true)
            .display_logo(false)
            .typeset_math(false)
            .display_mode_bar(DisplayModeBar::Hover)
            .mode_bar_buttons_to_remove(vec![
                ModeBarButtonName::Select2d,
                ModeBarButtonName::Lasso2d,
                ModeBarButtonName::AutoScale2d,
                ModeBarButtonName::ZoomIn2d,
                ModeBarButtonName::ZoomOut2d,
            ]),
    );
    plot
}

/// Points of a line.
pub type Points = Vec<[f64; 2]>;

fn split(points: &[[f64; 2]]) -> [Vec<f64>; 2] {
    [0, 1].map(|part| points.iter().map(|point| shown(point[part])).collect())
}

/// A line through `points`; `shape` says how it goes from one to the next, `hover` what the pointer reads.
pub fn line(
    name: &str,
    colour: &'static str,
    points: &[[f64; 2]],
    shape: LineShape,
    hover: &str,
) -> Box<Scatter<f64, f64>> {
    let [x, y] = split(points);
    let style = Line::new().color(colour).width(2.0).shape(shape).simplify(false);
    Scatter::new(x, y)
        .name(words(name))
        .legend_group(words(name))
        .mode(Mode::Lines)
        .line(style)
        .hover_template(hover)
}

/// A band between two lines over the same places, which goes with the line `name`.
pub fn band(
    name: &str,
    colour: &'static str,
    low: &[[f64; 2]],
    high: &[[f64; 2]],
    shape: &LineShape,
) -> [Box<Scatter<f64, f64>>; 2] {
    let edge = |points: &[[f64; 2]]| {
        let [x, y] = split(points);
        Scatter::new(x, y)
            .name(words(name))
            .legend_group(words(name))
            .show_legend(false)
            .mode(Mode::Lines)
            .line(
                Line::new()
                    .width(0.0)
                    .color(colour)
                    .shape(shape.clone())
                    .simplify(false),
            )
            .hover_info(HoverInfo::Skip)
    };
    let upper = edge(high)
        .fill(plotly::common::Fill::ToNextY)
        .fill_color(faint(colour, 0.18));
    [edge(low), upper]
}

/// A chart of bars that lie on top of each other, with a legend also for a single kind.
pub fn stacked(x: Axis, y: Axis) -> Plot {
    let mut plot = chart(x, y, HoverMode::Closest);
    let layout = plot.layout().clone().bar_mode(BarMode::Stack).show_legend(true);
    plot.set_layout(layout);
    plot
}

//! The swarm's map, with traffic as colour.

use plotly::common::{
    ColorBar, ColorScale, ColorScaleElement, HoverInfo, Line, Marker, MarkerSymbol, Mode, ThicknessMode, Title,
};
use plotly::layout::{Axis, AxisConstrain, AxisRange, HoverMode};
use plotly::{Plot, Scatter};

use super::PageInput;
use super::bandwidth::WAYS;
use super::chart::{axis, chart, shown, words};
use super::figure::{Figure, Panel};
use super::table::{Cell, DataTable};
use crate::experiment::reach;
use crate::geometry::Vec2;
use crate::metrics::TrialRecord;
use crate::radio::Reach;

const HEIGHT: u32 = 460;

/// Where the robots of the first trial ended, how they are linked and what they carried: of a swarm that can be drawn.
pub fn traffic(input: &PageInput) -> Option<Figure> {
    let record = input.records().first().filter(|record| record.can_be_drawn())?;
    record.robots.first()?;
    let loads = WAYS.map(|(.., bytes)| record.bytes_per_step(bytes));
    let mut table = DataTable::new(&["robot", "role", "x, m", "y, m", "sent, B/step", "received, B/step"]);
    for (robot, state) in record.robots.iter().enumerate() {
        let row: Vec<Cell> = vec![
            (robot as u64).into(),
            input.role(state.role.into()).into(),
            state.pose.position.x.into(),
            state.pose.position.y.into(),
            loads[0][robot].into(),
            loads[1][robot].into(),
        ];
        table.rows.push(row);
    }
    let reach = reach(input.scenario, record.trial);
    let within = match &reach {
        Reach::Disk(range) => format!(" ({range} m)"),
        Reach::Links(_) => String::new(),
    };
    let panels = WAYS
        .iter()
        .zip(&loads)
        .map(|((_, heading, _), load)| Panel::of_height(*heading, map(input, record, &reach, load), HEIGHT));
    Some(Figure {
        id: "map".into(),
        title: "The swarm with its traffic".into(),
        caption: format!(
            "Where the robots of trial {} (seed {}) ended. Grey lines join robots within range of each other{}; colour is what a robot \
             sent, and received, in a control step over the whole trial, headers included; shapes are roles{}.",
            record.trial,
            record.seed,
            within,
            if targets(input).is_empty() {
                ""
            } else {
                ", crosses targets"
            }
        ),
        panels: panels.collect(),
        key: Vec::new(),
        table,
    })
}

fn targets(input: &PageInput) -> Vec<Vec2> {
    let targets = input.scenario.protocol.targets();
    let places = targets.into_iter().flat_map(|targets| targets.places);
    places.map(|(place, _)| place).collect()
}

fn map(input: &PageInput, record: &TrialRecord, reach: &Reach, load: &[f64]) -> Plot {
    let (width, height) = &input.scenario.arena.size;
    let half = [width.get() / 2.0, height.get() / 2.0];
    let side = |title: &str, half: f64| -> Axis {
        axis(title)
            .range_mode(plotly::layout::RangeMode::Normal)
            // A little beyond the walls, so that a tick at their corner has room for both of its labels.
            .range(AxisRange::new(-1.05 * half, 1.05 * half))
            .constrain(AxisConstrain::Domain)
            // On a telephone more would touch each other.
            .n_ticks(7)
    };
    let y = side("y, m", half[1]).scale_anchor("x").scale_ratio(1.0);
    let mut plot = chart(side("x, m", half[0]), y, HoverMode::Closest);
    plot.add_trace(links(record, reach));
    let places = targets(input);
    if !places.is_empty() {
        let marks = Scatter::new(
            places.iter().map(|at| shown(at.x)).collect(),
            places.iter().map(|at| shown(at.y)).collect(),
        )
        .name("target")
        .mode(Mode::Markers)
        .marker(
            Marker::new()
                .symbol(MarkerSymbol::CrossThinOpen)
                .size(18)
                .color("#c00000"),
        )
        .hover_template("target<extra></extra>");
        plot.add_trace(marks);
    }
    let mut is_first = true;
    for role in 0..input.roles.len() {
        if let Some(robots) = robots(input, record, role, load, is_first) {
            plot.add_trace(robots);
            is_first = false;
        }
    }
    plot
}

/// The robots of one role; the scale of colours stands beside the first.
fn robots(
    input: &PageInput,
    record: &TrialRecord,
    role: usize,
    load: &[f64],
    with_scale: bool,
) -> Option<Box<Scatter<f64, f64>>> {
    let of_role = || {
        record
            .robots
            .iter()
            .enumerate()
            .filter(|(_, state)| usize::from(state.role) == role)
    };
    of_role().next()?;
    let most = load.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let name = words(input.role(role));
    let symbol = match input.role(role) {
        "root" => MarkerSymbol::Square,
        "worker" => MarkerSymbol::TriangleUp,
        "free" => MarkerSymbol::CircleOpen,
        _ => MarkerSymbol::Circle,
    };
    let hollow = matches!(symbol, MarkerSymbol::CircleOpen);
    let bar = ColorBar::new()
        .title(Title::with_text("B/step"))
        .thickness_mode(ThicknessMode::Pixels)
        .thickness(10)
        .outline_width(0);
    let marker = Marker::new()
        .symbol(symbol)
        .size(11)
        .line(Line::new().width(if hollow { 3.0 } else { 0.8 }).color("#4d4d4d"))
        .color_array(of_role().map(|(robot, _)| shown(load[robot])).collect::<Vec<f64>>())
        .cmin(0.0)
        .cmax(shown(most))
        .color_scale(ColorScale::Vector(scale()))
        .show_scale(with_scale)
        .color_bar(bar);
    let marker = if hollow {
        marker.line(Line::new().width(3.0))
    } else {
        marker
    };
    let texts: Vec<String> = of_role()
        .map(|(robot, _)| {
            format!(
                "robot {robot}, {name}: {} B/step",
                crate::report::number::figure(load[robot])
            )
        })
        .collect();
    let places = |part: usize| {
        of_role()
            .map(|(_, state)| shown(state.pose.position[part]))
            .collect::<Vec<_>>()
    };
    Some(
        Scatter::new(places(0), places(1))
            .name(&name)
            .mode(Mode::Markers)
            .marker(marker)
            .text_array(texts)
            .hover_info(HoverInfo::Text),
    )
}

/// From pale to dark, also in grey print.
fn scale() -> Vec<ColorScaleElement> {
    let stops = [
        (0.0, "#fde9b8"),
        (0.25, "#f6b26b"),
        (0.5, "#e0653a"),
        (0.75, "#a52a5a"),
        (1.0, "#3f0f5c"),
    ];
    stops
        .map(|(at, colour)| ColorScaleElement(at, colour.to_owned()))
        .into()
}

/// A line for each pair of robots that hear each other, all in one trace, with a gap after each.
fn links(record: &TrialRecord, reach: &Reach) -> Box<Scatter<Option<f64>, Option<f64>>> {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (from, to) in record.links_at_end(reach) {
        x.extend([Some(shown(from.x)), Some(shown(to.x)), None]);
        y.extend([Some(shown(from.y)), Some(shown(to.y)), None]);
    }
    Scatter::new(x, y)
        .name("within range")
        .mode(Mode::Lines)
        .line(Line::new().color("#a9bfa9").width(0.8))
        .hover_info(HoverInfo::Skip)
}

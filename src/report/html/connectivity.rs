//! The swarm's graph over time.

use plotly::Plot;
use plotly::common::LineShape;

use super::PageInput;
use super::chart::{DIRECTIONS, Points, axis, band, line, one_value, role_colour};
use super::data::{Moment, over_time};
use super::figure::{Figure, Panel};
use super::marks::Marks;
use super::table::DataTable;
use crate::engine::SimTime;
use crate::metrics::{ConnectivitySample, TrialRecord};
use crate::report::number;

const HEAD: [&str; 9] = [
    "figure",
    "time, s",
    "trials",
    "least",
    "5 % of trials",
    "25 % of trials",
    "median of trials",
    "75 % of trials",
    "95 % of trials",
];

fn samples(record: &TrialRecord, value: impl Fn(&ConnectivitySample) -> Option<f64>) -> Vec<(SimTime, f64)> {
    let samples = record.connectivity.iter();
    samples
        .filter_map(|sample| Some((sample.at, value(&sample)?)))
        .collect()
}

fn rows(table: &mut DataTable, name: &str, moments: &[Moment]) {
    for moment in moments {
        let spread = moment.spread;
        let mut row = vec![
            name.into(),
            moment.time_s.into(),
            moment.trials.into(),
            spread.min.into(),
        ];
        row.extend(spread.quantiles.map(super::table::Cell::from));
        table.rows.push(row);
    }
}

fn curves(moments: &[Moment]) -> [Points; 3] {
    [0, 2, 4].map(|q| {
        moments
            .iter()
            .map(|moment| [moment.time_s, moment.spread.quantiles[q]])
            .collect()
    })
}

fn draw(
    plot: &mut Plot,
    name: &str,
    colour: &'static str,
    moments: &[Moment],
    banded: bool,
    shape: &LineShape,
    hover: &str,
) {
    let [low, middle, high] = curves(moments);
    if banded {
        for edge in band(name, colour, &low, &high, shape) {
            plot.add_trace(edge);
        }
    }
    plot.add_trace(line(name, colour, &middle, shape.clone(), hover));
}

/// λ₂ and the number of components over time.
pub fn graph(input: &PageInput) -> Option<Figure> {
    let lambda2 = over_time(input.records(), |record| samples(record, |sample| Some(sample.lambda2)));
    let components = over_time(input.records(), |record| {
        samples(record, |sample| Some(f64::from(sample.components)))
    });
    lambda2.first()?;
    let banded = input.records().len() > 1;
    let marks = Marks::of(input);
    let mut table = DataTable::new(&HEAD);
    rows(&mut table, "λ₂", &lambda2);
    rows(&mut table, "components", &components);

    let mut first = marks.chart(axis("time, s"), axis("λ₂"));
    draw(
        &mut first,
        "median",
        DIRECTIONS[0],
        &lambda2,
        banded,
        &LineShape::Linear,
        "%{x:.4g} s: λ₂ %{y:.3g}<extra></extra>",
    );
    if banded {
        let least: Points = lambda2
            .iter()
            .map(|moment| [moment.time_s, moment.spread.min])
            .collect();
        first.add_trace(line(
            "least of all trials",
            "#8c8c8c",
            &least,
            LineShape::Linear,
            "%{x:.4g} s: least λ₂ %{y:.3g}<extra></extra>",
        ));
    }
    let pieces = components.iter().map(|moment| moment.spread.max).fold(0.0, f64::max);
    let y = axis("components");
    let y = if pieces < 8.0 { y.dtick(1.0) } else { y };
    let mut second = marks.chart(axis("time, s"), y);
    draw(
        &mut second,
        "median",
        DIRECTIONS[1],
        &components,
        banded,
        &LineShape::Hv,
        "%{x:.4g} s: %{y:.3g} components<extra></extra>",
    );
    if banded {
        let most: Points = components
            .iter()
            .map(|moment| [moment.time_s, moment.spread.max])
            .collect();
        second.add_trace(line(
            "most of all trials",
            "#8c8c8c",
            &most,
            LineShape::Hv,
            "%{x:.4g} s: at most %{y:.3g}<extra></extra>",
        ));
    }
    let panel = |title: &'static str, plot: Plot, moments: &[Moment]| {
        let ends = moments.iter().flat_map(|moment| [moment.spread.min, moment.spread.max]);
        let always = |value: f64| format!("{} at all times of all trials.", number::figure(value));
        marks.panel(title, plot).unless_one(ends, always)
    };
    let panels = vec![
        panel("Algebraic connectivity", first, &lambda2),
        panel("Components", second, &components),
    ];
    Some(Figure {
        id: "connectivity".into(),
        title: "Connectivity over time".into(),
        caption: format!(
            "First the algebraic connectivity λ₂ of the graph of live robots within range of each other: 0 where it falls apart, larger the \
             harder it is to cut. Then into how many pieces it falls. {}{}",
            input.band_words(),
            marks.words()
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

/// How many robots are in each role over time.
pub fn roles(input: &PageInput) -> Option<Figure> {
    if input.roles.len() < 2 {
        return None;
    }
    let marks = Marks::of(input);
    let mut table = DataTable::new(&HEAD);
    let mut plot = marks.chart(axis("time, s"), axis("robots"));
    let mut changes = false;
    for role in 0..input.roles.len() {
        let count = |sample: &ConnectivitySample| sample.roles.get(role).map(|&robots| f64::from(robots));
        let moments = over_time(input.records(), |record| samples(record, count));
        if moments.iter().all(|moment| moment.spread.max == 0.0) {
            continue;
        }
        let name = input.role(role);
        let ends = moments.iter().flat_map(|moment| [moment.spread.min, moment.spread.max]);
        changes |= one_value(ends).is_none();
        rows(&mut table, name, &moments);
        let banded = input.records().len() > 1;
        draw(
            &mut plot,
            name,
            role_colour(name, role),
            &moments,
            banded,
            &LineShape::Hv,
            "%{x:.4g} s: %{y:.3g} robots",
        );
    }
    table.rows.first()?;
    Some(Figure {
        id: "roles".into(),
        title: "Robots in each role over time".into(),
        caption: format!(
            "How many robots are in each role, whether they are well or have failed. {}{}",
            input.band_words(),
            marks.words()
        ),
        panels: vec![if changes {
            marks.panel("", plot)
        } else {
            Panel::words("", "No robot changes its role in any trial.")
        }],
        key: Vec::new(),
        table,
    })
}

//! Traffic over time.

use plotly::common::LineShape;

use super::PageInput;
use super::chart::{ALL, Points, axis, band, line, topic_colour};
use super::data::{Moment, over_time};
use super::figure::Figure;
use super::marks::Marks;
use super::table::{Cell, DataTable};
use crate::engine::SimTime;
use crate::metrics::{RobotBytes, SeriesEntry, TrialRecord};
use crate::report::number;

/// One way, in an entry of the series.
type Way = fn(&SeriesEntry) -> &[RobotBytes];
const WAYS: [(&str, &str, Way); 2] = [
    ("sent", "Sent", |entry| &entry.sent),
    ("received", "Received", |entry| &entry.received),
];

/// What a robot carries over time, by topic and direction.
pub fn by_topic(input: &PageInput) -> Option<Figure> {
    input.records().iter().find(|record| !record.series.is_empty())?;
    let marks = Marks::of(input);
    let mut table = DataTable::new(&[
        "topic",
        "direction",
        "until, s",
        "trials",
        "5 % of trials, B/step",
        "median of trials, B/step",
        "95 % of trials, B/step",
    ]);
    let mut panels = Vec::new();
    for (direction, heading, way) in WAYS {
        let mut plot = marks.chart(axis("time, s"), axis("B/step of a robot, mean"));
        let mut all = Vec::new();
        for topic in 0..input.topics.len() {
            let name = input.topic(topic);
            let moments = over_time(input.records(), |record| means(record, way, topic));
            for moment in &moments {
                let quantiles = moment.spread.quantiles;
                table.rows.push(vec![
                    name.into(),
                    direction.into(),
                    moment.time_s.into(),
                    moment.trials.into(),
                    quantiles[0].into(),
                    quantiles[2].into(),
                    quantiles[4].into(),
                ]);
            }
            all.extend(ends(&moments));
            let [low, middle, high] = curves(&moments);
            if input.records().len() > 1 {
                for edge in band(name, topic_colour(topic), &low, &high, &LineShape::Linear) {
                    plot.add_trace(edge);
                }
            }
            plot.add_trace(line(
                name,
                topic_colour(topic),
                &middle,
                LineShape::Linear,
                "%{x:.4g} s: %{y:.4g} B/step",
            ));
        }
        let panel = marks.panel(heading, plot);
        panels.push(panel.unless_one(all, |value| {
            format!("{} B/step on every topic at all times.", number::figure(value))
        }));
    }
    Some(Figure {
        id: "series-by-topic".into(),
        title: "Bytes over time, by topic".into(),
        caption: format!(
            "What a robot sends and receives in a control step, headers included, mean over robots, from one sample to the next, topic by \
             topic. {}{}",
            input.band_words(),
            marks.words()
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

/// The mean over robots of one trial, in bytes a control step.
fn means(record: &TrialRecord, way: Way, topic: usize) -> Vec<(SimTime, f64)> {
    let robots = record.robots.len().max(1) as f64;
    per_step(record, move |entry| {
        way(entry).get(topic).map(|bytes| bytes.total as f64 / robots)
    })
}

/// A number of bytes of each entry of a trial, a control step.
fn per_step(record: &TrialRecord, bytes: impl Fn(&SeriesEntry) -> Option<f64>) -> Vec<(SimTime, f64)> {
    let period = record.control_period.as_secs();
    let entries = record.series.iter();
    let rates = entries.filter_map(|entry| {
        let steps = entry.at.since(entry.since).as_secs() / period;
        Some((entry.at, bytes(&entry)? / steps))
    });
    rates.collect()
}

/// The least and the most of each moment.
fn ends(moments: &[Moment]) -> impl Iterator<Item = f64> {
    moments.iter().flat_map(|moment| [moment.spread.min, moment.spread.max])
}

fn curves(moments: &[Moment]) -> [Points; 3] {
    [0, 2, 4].map(|q| {
        moments
            .iter()
            .map(|moment| [moment.time_s, moment.spread.quantiles[q]])
            .collect()
    })
}

/// How far robots are apart over time, on all topics together.
pub fn over_robots(input: &PageInput) -> Option<Figure> {
    input.records().iter().find(|record| !record.series.is_empty())?;
    let marks = Marks::of(input);
    let topics = input.topics.len();
    let mut table = DataTable::new(&[
        "direction",
        "until, s",
        "trials",
        "least robot, B/step",
        "median robot, B/step",
        "robot with the most, B/step",
    ]);
    let mut panels = Vec::new();
    for (direction, heading, way) in WAYS {
        let of = |figure: fn(&RobotBytes) -> f64| {
            over_time(input.records(), |record| {
                per_step(record, |entry| way(entry).get(topics).map(figure))
            })
        };
        let least = of(|bytes| bytes.min as f64);
        let median = of(|bytes| bytes.median);
        let most = of(|bytes| bytes.max as f64);
        for ((least, median), most) in least.iter().zip(&median).zip(&most) {
            let row: Vec<Cell> = vec![
                direction.into(),
                median.time_s.into(),
                median.trials.into(),
                least.spread.median().into(),
                median.spread.median().into(),
                most.spread.median().into(),
            ];
            table.rows.push(row);
        }
        let mut plot = marks.chart(axis("time, s"), axis("B/step, all topics"));
        let [_, low, _] = curves(&least);
        let [_, middle, _] = curves(&median);
        let [_, high, _] = curves(&most);
        for edge in band("robots", ALL, &low, &high, &LineShape::Linear) {
            plot.add_trace(edge);
        }
        let middle_line = line(
            "median robot",
            ALL,
            &middle,
            LineShape::Linear,
            "%{x:.4g} s: median robot %{y:.4g} B/step<extra></extra>",
        );
        plot.add_trace(middle_line.show_legend(false));
        let edges = [("robot with the most", &high), ("robot with the least", &low)];
        for (name, points) in edges {
            let hover = format!("%{{x:.4g}} s: {name} %{{y:.4g}} B/step<extra></extra>");
            let edge = line(name, "#8c8c8c", points, LineShape::Linear, &hover);
            plot.add_trace(edge.show_legend(false));
        }
        let panel = marks.panel(heading, plot);
        panels.push(panel.unless_one(ends(&least).chain(ends(&most)), |value| {
            format!("{} B/step of every robot at all times.", number::figure(value))
        }));
    }
    Some(Figure {
        id: "series-over-robots".into(),
        title: "Bytes over time, from robot to robot".into(),
        caption: format!(
            "How far robots are apart in what they send and receive in a control step on all topics together, headers included: the \
             line is the median robot, the band reaches from the robot with the least to that with the most. Each is the median over the trials \
             that still run.{}",
            marks.words()
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

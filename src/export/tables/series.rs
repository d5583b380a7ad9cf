//! `series.parquet`: a row for trial × entry of the series × topic × direction.

use super::super::Names;
use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::{RobotBytes, TrialRecord};

/// Traffic of all robots from one sample to the next, one way, on one topic or on all.
pub struct Row {
    trial: u32,
    since: SimTime,
    at: SimTime,
    topic: Option<&'static str>,
    direction: &'static str,
    robots: RobotBytes,
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    record.series.iter().flat_map(move |entry| {
        let sent = entry.sent.into_iter().map(|robots| ("tx", robots)).enumerate();
        let received = entry.received.into_iter().map(|robots| ("rx", robots)).enumerate();
        sent.chain(received).map(move |(topic, (direction, robots))| Row {
            trial: record.trial,
            since: entry.since,
            at: entry.at,
            topic: (topic < names.topics.len()).then(|| names.topic(topic)),
            direction,
            robots,
        })
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("since_s", |row| row.since.as_secs()),
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::optional_text("topic", |row| row.topic.map(Into::into)),
        Col::text("direction", |row| row.direction.into()),
        Col::count("bytes", |row| row.robots.total),
        Col::count("min_bytes", |row| row.robots.min),
        Col::f64("median_bytes", |row| row.robots.median),
        Col::count("max_bytes", |row| row.robots.max),
    ]
}

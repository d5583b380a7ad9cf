//! `latency.parquet`: a row for trial × bucket of the latency histogram that holds something.

use super::super::table::Column;
use crate::metrics::TrialRecord;

/// Copies of one trial, delivered or under way, whose latency lies between two bounds.
pub struct Row {
    trial: u32,
    low_ns: u64,
    high_ns: u64,
    count: u64,
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    let buckets = record.latency.buckets();
    buckets.map(|(low_ns, high_ns, count)| Row {
        trial: record.trial,
        low_ns,
        high_ns,
        count,
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::key("low_ns", |row| row.low_ns),
        Col::key("high_ns", |row| row.high_ns),
        Col::count("count", |row| row.count),
    ]
}

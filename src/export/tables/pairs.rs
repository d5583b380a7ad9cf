//! `pairs.parquet`: a row for trial × sender × receiver, where a scenario asks for pairs.

use super::super::table::Column;
use crate::metrics::{PAIR_MEASURES, PairRecord, TrialRecord};

/// What passed from one robot to another in one trial.
pub struct Row {
    trial: u32,
    pair: PairRecord,
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    record.pairs.iter().map(|pair| Row {
        trial: record.trial,
        pair: pair.clone(),
    })
}

type Col = Column<Row>;

/// A column a measure, by its key.
pub fn columns() -> Vec<Column<Row>> {
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::id("sender", |row| row.pair.sender.0),
        Col::id("receiver", |row| row.pair.receiver.0),
        Col::count("offered", |row| row.pair.offered),
        Col::count("delivered", |row| row.pair.delivered),
    ];
    columns.extend(PAIR_MEASURES.iter().enumerate().map(|(place, measure)| {
        Col::optional_f64(measure.key, move |row| row.pair.values.get(place).copied().flatten())
    }));
    columns
}

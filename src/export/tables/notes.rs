//! `notes.parquet`: a row for trial × robot × name that robots counted or measured something under.

use super::super::table::Column;
use crate::metrics::{Amount, Noted, TrialRecord, Values};

/// What one robot noted under one name in one trial.
pub struct Row {
    trial: u32,
    noted: Noted,
}

impl Row {
    fn values(&self) -> Option<&Values> {
        match &self.noted.amount {
            Amount::Count(_) => None,
            Amount::Values(values) => Some(values),
        }
    }

    fn count(&self) -> u64 {
        match &self.noted.amount {
            Amount::Count(count) => *count,
            Amount::Values(values) => values.count,
        }
    }

    fn buckets<T>(&self, part: fn((f64, u64)) -> T) -> Vec<T> {
        let values = self.values().into_iter();
        values.flat_map(Values::buckets).map(part).collect()
    }
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    record.noted.iter().map(|noted| Row {
        trial: record.trial,
        noted: noted.clone(),
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::text("name", |row| row.noted.name.clone().into()),
        Col::id("robot", |row| row.noted.robot.0),
        Col::text("kind", |row| row.values().map_or(KINDS[0], |_| KINDS[1]).into()),
        Col::count("count", Row::count),
        Col::optional_f64("sum", |row| row.values().map(|values| values.sum)),
        Col::optional_f64("min", |row| row.values().map(|values| values.min)),
        Col::optional_f64("max", |row| row.values().map(|values| values.max)),
        Col::list_of_f64("values", |row| row.buckets(|(value, _)| value)),
        Col::list_of_counts("times", |row| row.buckets(|(_, count)| count)),
    ]
}

/// What a row tells of: a count, or measured values.
pub const KINDS: [&str; 2] = ["count", "value"];

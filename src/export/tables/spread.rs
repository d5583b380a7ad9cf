//! `spread.parquet`: a row for trial × rumour × robot.

use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::TrialRecord;

/// When a robot came to know a rumour.
pub struct Row {
    trial: u32,
    rumor: u32,
    robot: u32,
    informed: Option<SimTime>,
    hops: Option<u32>,
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    (0..).zip(&record.spread).flat_map(move |(rumor, spread)| {
        let told = spread.informed.iter().zip(&spread.hops);
        (0..).zip(told).map(move |(robot, (&informed, &hops))| Row {
            trial: record.trial,
            rumor,
            robot,
            informed,
            hops,
        })
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::id("rumor", |row| row.rumor),
        Col::id("robot", |row| row.robot),
        Col::optional_f64("informed_s", |row| row.informed.map(SimTime::as_secs)),
        Col::optional_id("hops", |row| row.hops),
    ]
}

//! `trajectories.parquet`: a row for trial × sample time × robot.

use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::TrialRecord;

/// A robot's place at one instant of one trial.
pub struct Row {
    trial: u32,
    at: SimTime,
    robot: usize,
    place: [f32; 2],
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    record.trajectories.iter().flat_map(move |(at, places)| {
        let robots = places.iter().enumerate();
        robots.map(move |(robot, &place)| Row {
            trial: record.trial,
            at: *at,
            robot,
            place,
        })
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::i32("trial", |row| row.trial as i32),
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::i32("robot", |row| row.robot as i32),
        Col::f32("x_m", |row| row.place[0]),
        Col::f32("y_m", |row| row.place[1]),
    ]
}

//! `trajectories.parquet`: a row for trial × sample time × robot.

use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::TrialRecord;

/// A robot's place at one instant of one trial.
pub struct Row {
    trial: u32,
    at: SimTime,
    robot: u32,
    place: [f32; 2],
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    record.trajectories.iter().flat_map(move |(at, places)| {
        let robots = (0..).zip(places);
        robots.map(move |(robot, place)| Row {
            trial: record.trial,
            at,
            robot,
            place,
        })
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::id("robot", |row| row.robot),
        Col::f32("x_m", |row| row.place[0]),
        Col::f32("y_m", |row| row.place[1]),
    ]
}

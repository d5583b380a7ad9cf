//! `robots.parquet`: a row for trial × robot, as it was at the end.

use super::super::Names;
use super::super::table::Column;
use crate::metrics::{RobotState, TrialRecord};

/// A robot at the end of a trial.
pub struct Row {
    trial: u32,
    robot: u32,
    role: &'static str,
    state: RobotState,
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    (0..).zip(&record.robots).map(move |(robot, state)| Row {
        trial: record.trial,
        robot,
        role: names.role(state.role.into()),
        state: state.clone(),
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::id("robot", |row| row.robot),
        Col::f64("x_m", |row| row.state.pose.position.x),
        Col::f64("y_m", |row| row.state.pose.position.y),
        Col::f64("heading_rad", |row| row.state.pose.heading),
        Col::text("role", |row| row.role.into()),
        Col::optional_id("target", |row| row.state.target.map(u32::from)),
        Col::list_of_ids("parents", |row| {
            row.state.parents.iter().map(|parent| parent.0).collect()
        }),
        Col::count("steps", |row| row.state.steps),
    ]
}

//! `faults.parquet`: a row for each failure of a robot or of links, in order of time.

use super::super::Names;
use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::{FaultEpisode, FaultKind, TrialRecord};

/// A failure, from its beginning to its end.
pub struct Row {
    trial: u32,
    episode: FaultEpisode,
    robot: Option<u32>,
    role: Option<&'static str>,
    target: Option<u32>,
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    record.faults.iter().map(move |episode| {
        let (robot, role, target) = match episode.kind {
            FaultKind::Robot {
                robot, role, target, ..
            } => (Some(robot.0), Some(names.role(role.into())), target.map(u32::from)),
            FaultKind::Partition | FaultKind::Burst => (None, None, None),
        };
        Row {
            trial: record.trial,
            episode: episode.clone(),
            robot,
            role,
            target,
        }
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::id("fault", |row| row.episode.fault.into()),
        Col::text("kind", |row| row.episode.kind.name().into()),
        Col::optional_id("robot", |row| row.robot),
        Col::optional_text("role", |row| row.role.map(Into::into)),
        Col::optional_id("target", |row| row.target),
        Col::f64("from_s", |row| row.episode.from.as_secs()),
        Col::optional_f64("until_s", |row| row.episode.until.map(SimTime::as_secs)),
    ]
}

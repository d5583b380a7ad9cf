//! `bandwidth.parquet`: a row for trial × robot × role × topic × direction with traffic.

use std::borrow::Cow;

use super::super::Names;
use super::super::table::Column;
use crate::metrics::{TrafficRow, TrialRecord, Volume};
use crate::radio::LossCause;

/// What went one way between one robot, while in one role, and the air, on one topic.
pub struct Row {
    trial: u32,
    robot: u32,
    role: &'static str,
    topic: &'static str,
    direction: Cow<'static, str>,
    volume: Volume,
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    record.traffic.iter().flat_map(move |traffic| {
        directions(traffic).map(move |(direction, volume)| Row {
            trial: record.trial,
            robot: traffic.robot.0,
            role: names.role(traffic.role.into()),
            topic: names.topic(traffic.topic.into()),
            direction,
            volume,
        })
    })
}

/// The directions in which there was traffic: `tx`, `rx`, `lost_<cause>`, `duplicate`.
fn directions(traffic: &TrafficRow) -> impl Iterator<Item = (Cow<'static, str>, Volume)> {
    let lost = LossCause::ALL.iter().zip(traffic.lost);
    let lost = lost.map(|(cause, volume)| (Cow::Owned(format!("lost_{}", cause.name())), volume));
    [("tx".into(), traffic.sent), ("rx".into(), traffic.received)]
        .into_iter()
        .chain(lost)
        .chain([("duplicate".into(), traffic.duplicate)])
        .filter(|(_, volume)| volume.frames > 0)
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    vec![
        Col::id("trial", |row| row.trial),
        Col::id("robot", |row| row.robot),
        Col::text("role", |row| row.role.into()),
        Col::text("topic", |row| row.topic.into()),
        Col::text("direction", |row| row.direction.clone()),
        Col::count("frames", |row| row.volume.frames),
        Col::count("payload_bytes", |row| row.volume.payload_bytes),
        Col::count("header_bytes", |row| row.volume.header_bytes),
    ]
}

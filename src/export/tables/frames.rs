//! `frames.parquet`: a row for trial × topic, copies of frames by fate.

use super::super::Names;
use super::super::table::Column;
use crate::metrics::{TopicFates, TrialRecord};
use crate::radio::LossCause;

/// The fates of one topic's copies in one trial.
pub struct Row {
    trial: u32,
    topic: &'static str,
    fates: TopicFates,
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    let topics = record.ledger.iter().enumerate();
    topics.map(|(topic, fates)| Row {
        trial: record.trial,
        topic: names.topic(topic),
        fates: fates.clone(),
    })
}

type Col = Column<Row>;

pub fn columns() -> Vec<Column<Row>> {
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::text("topic", |row| row.topic.into()),
        Col::count("offered", |row| row.fates.offered),
        Col::count("delivered", |row| row.fates.delivered),
    ];
    columns.extend(
        LossCause::ALL
            .iter()
            .enumerate()
            .map(|(index, cause)| Col::count(format!("lost_{}", cause.name()), move |row| row.fates.lost[index])),
    );
    columns.push(Col::count("in_flight", |row| row.fates.in_flight));
    columns
}

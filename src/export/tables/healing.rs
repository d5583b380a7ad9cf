//! `healing.parquet`: a row for each failure of a robot that worked for a target, in order of time.

use super::super::Names;
use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::{HealingEpisode, TrialRecord};

/// A failure, until the target has its links again.
pub struct Row {
    trial: u32,
    role: &'static str,
    episode: HealingEpisode,
    /// When the trial ended.
    end: SimTime,
}

impl Row {
    /// Until the target had its links again, or until the trial ended.
    fn watched_s(&self) -> f64 {
        let until = self.episode.healed_at.unwrap_or(self.end);
        until.since(self.episode.failed_at).as_secs()
    }
}

pub fn rows(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Row> {
    record.healing.iter().map(move |episode| Row {
        trial: record.trial,
        role: names.role(episode.role.into()),
        episode: episode.clone(),
        end: record.simulated,
    })
}

type Col = Column<Row>;

/// Two columns a topic: `<topic>_frames`, `<topic>_payload_bytes`.
pub fn columns(names: &Names) -> Vec<Column<Row>> {
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::id("fault", |row| row.episode.fault.into()),
        Col::id("robot", |row| row.episode.robot.0),
        Col::text("role", |row| row.role.into()),
        Col::id("target", |row| row.episode.target.into()),
        Col::f64("failed_s", |row| row.episode.failed_at.as_secs()),
        Col::id("links_before", |row| row.episode.links_before),
        Col::id("links_after", |row| row.episode.links_after),
        Col::optional_f64("worker_m", |row| row.episode.worker_m),
        Col::optional_f64("healed_s", |row| row.episode.healed_at.map(SimTime::as_secs)),
        Col::f64("watched_s", Row::watched_s),
        Col::id("overlapping", |row| row.episode.overlapping),
        Col::f64("distance_m", |row| row.episode.distance_m),
    ];
    for (index, topic) in names.topics.iter().enumerate() {
        let topic = topic.replace(' ', "_");
        let of = move |counts: &[u64]| counts.get(index).copied().unwrap_or(0);
        columns.push(Col::count(format!("{topic}_frames"), move |row| {
            of(&row.episode.frames)
        }));
        columns.push(Col::count(format!("{topic}_payload_bytes"), move |row| {
            of(&row.episode.payload_bytes)
        }));
    }
    columns
}

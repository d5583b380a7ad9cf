//! `connectivity.parquet`: a row for trial × sample time.

use super::super::Names;
use super::super::table::Column;
use crate::metrics::{ConnectivitySample, TrialRecord};

/// The swarm's graph at one instant of one trial.
pub struct Row {
    trial: u32,
    sample: ConnectivitySample,
}

pub fn rows(record: &TrialRecord) -> impl Iterator<Item = Row> {
    let samples = record.connectivity.iter();
    samples.map(|sample| Row {
        trial: record.trial,
        sample,
    })
}

type Col = Column<Row>;

/// One column a role and three a target: `robots_<role>`, `links_<target>`, `target_<target>`, `worker_m_<target>`.
pub fn columns(names: &Names, targets: usize) -> Vec<Column<Row>> {
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::f64("time_s", |row| row.sample.at.as_secs()),
        Col::f64("lambda2", |row| row.sample.lambda2),
        Col::id("components", |row| row.sample.components),
        Col::f64("neighbours", |row| row.sample.neighbours),
    ];
    columns.extend(
        names
            .roles
            .iter()
            .enumerate()
            .map(|(index, role)| Col::optional_id(format!("robots_{role}"), move |row| at(&row.sample.roles, index))),
    );
    columns.extend(
        (0..targets).map(|index| Col::optional_id(format!("links_{index}"), move |row| at(&row.sample.links, index))),
    );
    columns.extend((0..targets).flat_map(|index| {
        let target = move |row: &Row| row.sample.targets.get(index).copied();
        let state = move |row: &Row| target(row).map_or("", |target| target.state.name()).into();
        let worker = move |row: &Row| target(row).and_then(|target| target.worker_m);
        [
            Col::text(format!("target_{index}"), state),
            Col::optional_f64(format!("worker_m_{index}"), worker),
        ]
    }));
    columns
}

fn at(counts: &[u32], index: usize) -> Option<u32> {
    counts.get(index).copied()
}

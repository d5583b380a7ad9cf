//! The tables of a results folder, filled a trial at a time, in order of trials.

mod bandwidth;
mod connectivity;
mod detection;
mod faults;
mod frames;
mod healing;
mod latency;
mod notes;
mod robots;
mod series;
mod spread;
mod trajectories;
mod trials;

use std::io;
use std::path::{Path, PathBuf};

use super::Names;
use super::table::Table;
use crate::metrics::TrialRecord;

/// The tables of a results folder being written.
pub struct Tables {
    names: Names,
    trials: Table<trials::Row>,
    frames: Table<frames::Row>,
    bandwidth: Table<bandwidth::Row>,
    latency: Table<latency::Row>,
    connectivity: Table<connectivity::Row>,
    detection: Table<detection::Row>,
    robots: Table<robots::Row>,
    trajectories: Table<trajectories::Row>,
    faults: Table<faults::Row>,
    healing: Table<healing::Row>,
    spread: Table<spread::Row>,
    series: Table<series::Row>,
    /// Where it goes, and once there is something to put into it, the table.
    notes: (PathBuf, Option<Table<notes::Row>>),
}

impl Tables {
    /// Names of the files that are always there.
    pub const FILES: [&str; 12] = [
        "trials.parquet",
        "frames.parquet",
        "bandwidth.parquet",
        "latency.parquet",
        "connectivity.parquet",
        "robots.parquet",
        "trajectories.parquet",
        "faults.parquet",
        "healing.parquet",
        "detection.parquet",
        "series.parquet",
        "spread.parquet",
    ];
    /// Names of the files that are there only where there is something to put into them.
    pub const OPTIONAL: [&str; 1] = ["notes.parquet"];

    /// Starts the tables in folder `dir`, for a mission with `targets` targets.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn create(dir: &Path, names: Names, targets: usize) -> io::Result<Self> {
        let path = |index: usize| dir.join(Self::FILES[index]);
        Ok(Self {
            names,
            trials: Table::create(&path(0), trials::columns())?,
            frames: Table::create(&path(1), frames::columns())?,
            bandwidth: Table::create(&path(2), bandwidth::columns())?,
            latency: Table::create(&path(3), latency::columns())?,
            connectivity: Table::create(&path(4), connectivity::columns(&names, targets))?,
            robots: Table::create(&path(5), robots::columns())?,
            trajectories: Table::create(&path(6), trajectories::columns())?,
            faults: Table::create(&path(7), faults::columns())?,
            healing: Table::create(&path(8), healing::columns(&names))?,
            detection: Table::create(&path(9), detection::columns())?,
            spread: Table::create(&path(11), spread::columns())?,
            series: Table::create(&path(10), series::columns())?,
            notes: (dir.join(Self::OPTIONAL[0]), None),
        })
    }

    /// Adds a trial's rows to every table.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn append(&mut self, record: &TrialRecord) -> io::Result<()> {
        self.trials.extend([trials::row(record)])?;
        self.frames.extend(frames::rows(record, &self.names))?;
        self.bandwidth.extend(bandwidth::rows(record, &self.names))?;
        self.latency.extend(latency::rows(record))?;
        self.connectivity.extend(connectivity::rows(record))?;
        self.detection.extend(detection::rows(record))?;
        self.robots.extend(robots::rows(record, &self.names))?;
        self.trajectories.extend(trajectories::rows(record))?;
        self.faults.extend(faults::rows(record, &self.names))?;
        self.healing.extend(healing::rows(record, &self.names))?;
        self.spread.extend(spread::rows(record))?;
        self.series.extend(series::rows(record, &self.names))?;
        if record.noted.is_empty() {
            return Ok(());
        }
        let (path, table) = &mut self.notes;
        let table = match table {
            Some(table) => table,
            none => none.insert(Table::create(path, notes::columns())?),
        };
        table.extend(notes::rows(record))
    }

    /// Ends every file, and answers the names of those that there are.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn finish(self) -> io::Result<Vec<&'static str>> {
        self.trials.finish()?;
        self.frames.finish()?;
        self.bandwidth.finish()?;
        self.latency.finish()?;
        self.connectivity.finish()?;
        self.detection.finish()?;
        self.robots.finish()?;
        self.trajectories.finish()?;
        self.faults.finish()?;
        self.healing.finish()?;
        self.spread.finish()?;
        self.series.finish()?;
        let mut files = Self::FILES.to_vec();
        if let (_, Some(notes)) = self.notes {
            notes.finish()?;
            files.push(Self::OPTIONAL[0]);
        }
        Ok(files)
    }
}

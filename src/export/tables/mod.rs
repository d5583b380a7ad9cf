//! The tables of a results folder, filled a trial at a time, in order of trials.

mod air;
mod asked;
mod bandwidth;
mod connectivity;
mod detection;
mod faults;
mod frames;
mod healing;
mod latency;
mod notes;
mod pairs;
mod robots;
mod series;
mod spread;
mod trajectories;
mod trials;

use std::io;
use std::path::{Path, PathBuf};

use super::Names;
use super::table::{Column, Table};
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
    notes: Later<notes::Row>,
    pairs: Later<pairs::Row>,
    radio: Later<air::Robot>,
    waits: Later<air::Bucket>,
    distance: Later<air::Band>,
    links: Later<air::Link>,
    delivery: Later<asked::Delivery>,
    delays: Later<asked::Delays>,
    degree: Later<asked::Degree>,
    hops: Later<asked::Learnt>,
    traffic: Later<asked::Traffic>,
    roles: Later<asked::Entered>,
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
    pub const OPTIONAL: [&str; 12] = [
        "notes.parquet",
        "pairs.parquet",
        "radio.parquet",
        "waits.parquet",
        "distance.parquet",
        "links.parquet",
        "delivery.parquet",
        "delays.parquet",
        "degree.parquet",
        "hops.parquet",
        "traffic.parquet",
        "roles.parquet",
    ];

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
            notes: Later::new(dir, Self::OPTIONAL[0], notes::columns),
            pairs: Later::new(dir, Self::OPTIONAL[1], pairs::columns),
            radio: Later::new(dir, Self::OPTIONAL[2], air::robot_columns),
            waits: Later::new(dir, Self::OPTIONAL[3], air::wait_columns),
            distance: Later::new(dir, Self::OPTIONAL[4], air::band_columns),
            links: Later::new(dir, Self::OPTIONAL[5], air::link_columns),
            delivery: Later::new(dir, Self::OPTIONAL[6], asked::delivery_columns),
            delays: Later::new(dir, Self::OPTIONAL[7], asked::delay_columns),
            degree: Later::new(dir, Self::OPTIONAL[8], asked::degree_columns),
            hops: Later::new(dir, Self::OPTIONAL[9], asked::hop_columns),
            traffic: Later::new(dir, Self::OPTIONAL[10], asked::traffic_columns),
            roles: Later::new(dir, Self::OPTIONAL[11], asked::role_columns),
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
        self.notes.extend(notes::rows(record))?;
        self.pairs.extend(pairs::rows(record))?;
        self.radio.extend(air::robots(record))?;
        self.waits.extend(air::waits(record))?;
        self.distance.extend(air::bands(record))?;
        self.links.extend(air::links(record))?;
        self.delivery.extend(asked::delivery(record, &self.names))?;
        self.delays.extend(asked::delays(record, &self.names))?;
        self.degree.extend(asked::degree(record))?;
        self.hops.extend(asked::hops(record))?;
        self.traffic.extend(asked::traffic(record, &self.names))?;
        self.roles.extend(asked::roles(record, &self.names))
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
        let later = [
            self.notes.finish()?,
            self.pairs.finish()?,
            self.radio.finish()?,
            self.waits.finish()?,
            self.distance.finish()?,
            self.links.finish()?,
            self.delivery.finish()?,
            self.delays.finish()?,
            self.degree.finish()?,
            self.hops.finish()?,
            self.traffic.finish()?,
            self.roles.finish()?,
        ];
        Ok(Self::FILES.into_iter().chain(later.into_iter().flatten()).collect())
    }
}

/// A table that is there only where there is something to put into it.
struct Later<R> {
    dir: PathBuf,
    name: &'static str,
    columns: fn() -> Vec<Column<R>>,
    table: Option<Table<R>>,
}

impl<R> Later<R> {
    fn new(dir: &Path, name: &'static str, columns: fn() -> Vec<Column<R>>) -> Self {
        Self {
            dir: dir.to_owned(),
            name,
            columns,
            table: None,
        }
    }

    fn extend(&mut self, rows: impl Iterator<Item = R>) -> io::Result<()> {
        let mut rows = rows.peekable();
        if rows.peek().is_none() {
            return Ok(());
        }
        let table = match &mut self.table {
            Some(table) => table,
            none => none.insert(Table::create(&self.dir.join(self.name), (self.columns)())?),
        };
        table.extend(rows)
    }

    /// Ends the file, if there is one, and answers its name.
    fn finish(self) -> io::Result<Option<&'static str>> {
        let Some(table) = self.table else { return Ok(None) };
        table.finish().map(|()| Some(self.name))
    }
}

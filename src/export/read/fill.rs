//! Which table is read by whom.

use super::records::Records;
use super::table::{Table, Wrong};
use super::{air, asked, failures, swarm, traffic, trials};

/// How a table's rows are put into the records.
pub type Fill = fn(&mut Records, &Table) -> Result<(), Wrong>;

/// The tables and what is read of them, the trials first. Paths are the bulk of a result and no report needs them.
pub const TABLES: [(&str, Fill); 11] = [
    ("trials.parquet", trials::trials),
    ("frames.parquet", traffic::frames),
    ("bandwidth.parquet", traffic::bandwidth),
    ("latency.parquet", traffic::latency),
    ("series.parquet", traffic::series),
    ("connectivity.parquet", swarm::connectivity),
    ("robots.parquet", swarm::robots),
    ("detection.parquet", failures::detection),
    ("faults.parquet", failures::faults),
    ("healing.parquet", failures::healing),
    ("spread.parquet", traffic::spread),
];

/// Tables that are there only where there is something to put into them.
pub const OPTIONAL: [(&str, Fill); 12] = [
    ("notes.parquet", traffic::notes),
    ("pairs.parquet", traffic::pairs),
    ("radio.parquet", air::robots),
    ("waits.parquet", air::waits),
    ("distance.parquet", air::bands),
    ("links.parquet", air::links),
    ("delivery.parquet", asked::delivery),
    ("delays.parquet", asked::delays),
    ("degree.parquet", asked::degree),
    ("hops.parquet", asked::hops),
    ("traffic.parquet", asked::traffic),
    ("roles.parquet", asked::roles),
];

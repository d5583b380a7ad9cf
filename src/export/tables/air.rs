//! What radios did, over one on which frames take time: `radio.parquet`, a row for trial × robot; `waits.parquet`, a row for trial × wait × bucket of its
//! histogram; `distance.parquet`, a row for trial × band of distance; and, where a scenario asks for it, `links.parquet`, a row for trial × sender × receiver.

use super::super::table::Column;
use crate::engine::{SimTime, Span};
use crate::metrics::{
    AirRecord, Copies, DistanceBand, ENERGY_STATES, LatencyHistogram, LinkRecord, RobotAir, TrialRecord, Waits,
};
use crate::radio::LossCause;

/// What one robot's radio did in one trial.
pub struct Robot {
    trial: u32,
    id: u32,
    air: RobotAir,
}

pub fn robots(record: &TrialRecord) -> impl Iterator<Item = Robot> {
    let robots = record.air.iter().flat_map(|air| (0..).zip(&air.robots));
    robots.map(|(id, air)| Robot {
        trial: record.trial,
        id,
        air: air.clone(),
    })
}

/// Waits of a robot's frames, and a part of what they sum up to.
type OfRobot = fn(&RobotAir) -> Option<Waits>;
type Part = fn(Waits) -> Span;

pub fn robot_columns() -> Vec<Column<Robot>> {
    type Col = Column<Robot>;
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::id("robot", |row| row.id),
        Col::f64("sent_s", |row| row.air.sent.as_secs()),
        Col::f64("busy_s", |row| row.air.busy.as_secs()),
        Col::count("frames", |row| row.air.frames),
        Col::count("on_air", |row| row.air.on_air),
        Col::count("attempts", |row| row.air.attempts),
        Col::count("acknowledged", |row| row.air.acknowledged),
        Col::count("unacknowledged", |row| row.air.unacknowledged),
    ];
    let causes = LossCause::ALL.iter().enumerate();
    columns.extend(
        causes.map(|(place, cause)| Col::count(format!("dropped_{}", cause.name()), move |row| row.air.dropped[place])),
    );
    let waits: [(&str, OfRobot); 2] = [
        ("queue_wait", |robot| robot.queue_wait),
        ("access_delay", |robot| robot.access_delay),
    ];
    let parts: [(&str, Part); 3] = [
        ("sum", |waits| waits.sum),
        ("min", |waits| waits.min),
        ("max", |waits| waits.max),
    ];
    for (wait, of) in waits {
        columns.extend(parts.map(|(name, part)| {
            let seconds = move |row: &Robot| of(&row.air).map(|waits| part(waits).as_secs());
            Col::optional_f64(format!("{wait}_{name}_s"), seconds)
        }));
    }
    columns.extend(of_copies(|row: &Robot| row.air.heard));
    columns.push(Col::count("strayed", |row| row.air.strayed));
    let states = ENERGY_STATES.iter().enumerate();
    columns
        .extend(states.map(|(place, state)| Col::f64(format!("energy_{state}_J"), move |row| row.air.energy[place])));
    columns.push(Col::optional_f64("empty_s", |row| {
        row.air.empty_at.map(SimTime::as_secs)
    }));
    columns
}

/// Columns of what became of copies.
fn of_copies<R: 'static>(copies: fn(&R) -> Copies) -> Vec<Column<R>> {
    vec![
        Column::count("offered", move |row| copies(row).offered),
        Column::count("delivered", move |row| copies(row).delivered),
        Column::count("reached", move |row| copies(row).reached),
        Column::optional_f64("power_dBm_mean", move |row| copies(row).power_dbm),
        Column::optional_f64("delivered_power_dBm_mean", move |row| copies(row).delivered_power_dbm),
    ]
}

/// Frames of one trial that waited so long for one thing.
pub struct Bucket {
    trial: u32,
    wait: &'static str,
    bounds: [u64; 2],
    count: u64,
}

/// How a histogram is read off.
type Histogram = fn(&AirRecord) -> &LatencyHistogram;

/// What frames wait for, and the histogram of it.
pub const WAITS: [(&str, Histogram); 2] = [("queue", |air| &air.queue_wait), ("access", |air| &air.access_delay)];

pub fn waits(record: &TrialRecord) -> impl Iterator<Item = Bucket> {
    let histograms = record
        .air
        .iter()
        .flat_map(|air| WAITS.map(|(wait, of)| (wait, of(air))));
    histograms.flat_map(move |(wait, histogram)| {
        histogram.buckets().map(move |(low, high, count)| Bucket {
            trial: record.trial,
            wait,
            bounds: [low, high],
            count,
        })
    })
}

pub fn wait_columns() -> Vec<Column<Bucket>> {
    type Col = Column<Bucket>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::text("wait", |row| row.wait.into()),
        Col::key("low_ns", |row| row.bounds[0]),
        Col::key("high_ns", |row| row.bounds[1]),
        Col::count("count", |row| row.count),
    ]
}

/// What became of one trial's copies in a band of distance.
pub struct Band {
    trial: u32,
    band: DistanceBand,
}

pub fn bands(record: &TrialRecord) -> impl Iterator<Item = Band> {
    let bands = record.air.iter().flat_map(|air| &air.bands);
    bands.map(|band| Band {
        trial: record.trial,
        band: band.clone(),
    })
}

pub fn band_columns() -> Vec<Column<Band>> {
    type Col = Column<Band>;
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::f64("from_m", |row| row.band.from_m),
        Col::f64("to_m", |row| row.band.to_m),
    ];
    columns.extend(of_copies(|row: &Band| row.band.copies));
    columns
}

/// What became of one trial's copies on a link.
pub struct Link {
    trial: u32,
    link: LinkRecord,
}

pub fn links(record: &TrialRecord) -> impl Iterator<Item = Link> {
    let links = record.air.iter().flat_map(|air| &air.links);
    links.map(|link| Link {
        trial: record.trial,
        link: link.clone(),
    })
}

pub fn link_columns() -> Vec<Column<Link>> {
    type Col = Column<Link>;
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::id("sender", |row| row.link.sender.0),
        Col::id("receiver", |row| row.link.receiver.0),
    ];
    columns.extend(of_copies(|row: &Link| row.link.copies));
    columns.push(Col::f64("distance_m_mean", |row| row.link.distance_m));
    columns
}

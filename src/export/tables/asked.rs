//! What is there only where a scenario asks for it (`metrics: (record: [...])`): `delivery.parquet`, a row for trial × topic × band of distance;
//! `delays.parquet`, a row for trial × window of time × topic; `degree.parquet`, a row for trial × sample time × robot; `hops.parquet`, a row for trial × rumour × robot
//! that came to know it; `traffic.parquet`, a row for trial × window of time × robot × topic; `roles.parquet`, a row for trial × role that a robot entered.

use super::super::Names;
use super::super::table::Column;
use crate::engine::SimTime;
use crate::metrics::{DelayEntry, DeliveryBand, Hop, RoleChange, TrafficEntry, TrialRecord};
use crate::radio::LossCause;

/// What became of one trial's copies on a topic, in a band of distance.
pub struct Delivery {
    trial: u32,
    topic: &'static str,
    band: DeliveryBand,
}

pub fn delivery(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Delivery> {
    record.asked.delivery.iter().map(|band| Delivery {
        trial: record.trial,
        topic: names.topic(band.topic.into()),
        band: band.clone(),
    })
}

pub fn delivery_columns() -> Vec<Column<Delivery>> {
    type Col = Column<Delivery>;
    let mut columns = vec![
        Col::id("trial", |row| row.trial),
        Col::text("topic", |row| row.topic.into()),
        Col::f64("from_m", |row| row.band.from_m),
        Col::f64("to_m", |row| row.band.to_m),
        Col::count("offered", |row| row.band.fates.offered),
        Col::count("delivered", |row| row.band.fates.delivered),
    ];
    let causes = LossCause::ALL.iter().enumerate();
    columns.extend(
        causes
            .map(|(place, cause)| Col::count(format!("lost_{}", cause.name()), move |row| row.band.fates.lost[place])),
    );
    columns.push(Col::count("in_flight", |row| row.band.fates.in_flight));
    columns
}

/// How long one trial's copies took on a topic, in a window of time.
pub struct Delays {
    trial: u32,
    topic: &'static str,
    entry: DelayEntry,
}

pub fn delays(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Delays> {
    record.asked.delays.iter().map(|entry| Delays {
        trial: record.trial,
        topic: names.topic(entry.topic.into()),
        entry,
    })
}

pub fn delay_columns() -> Vec<Column<Delays>> {
    type Col = Column<Delays>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("since_s", |row| row.entry.since.as_secs()),
        Col::f64("time_s", |row| row.entry.at.as_secs()),
        Col::text("topic", |row| row.topic.into()),
        Col::count("copies", |row| row.entry.copies),
        Col::f64("mean_s", |row| row.entry.mean_s),
        Col::f64("min_s", |row| row.entry.min.as_secs()),
        Col::f64("max_s", |row| row.entry.max.as_secs()),
        Col::f64("median_s", |row| row.entry.median.as_secs()),
        Col::f64("p95_s", |row| row.entry.p95.as_secs()),
        Col::f64("p99_s", |row| row.entry.p99.as_secs()),
    ]
}

/// How many others a robot has in range at one instant of one trial.
pub struct Degree {
    trial: u32,
    at: SimTime,
    robot: u32,
    neighbours: Option<u32>,
}

pub fn degree(record: &TrialRecord) -> impl Iterator<Item = Degree> {
    record.asked.degree.iter().flat_map(move |sample| {
        let robots = (0..).zip(sample.neighbours);
        robots.map(move |(robot, neighbours)| Degree {
            trial: record.trial,
            at: sample.at,
            robot,
            neighbours,
        })
    })
}

pub fn degree_columns() -> Vec<Column<Degree>> {
    type Col = Column<Degree>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("time_s", |row| row.at.as_secs()),
        Col::id("robot", |row| row.robot),
        Col::optional_id("neighbours", |row| row.neighbours),
    ]
}

/// How a robot of one trial came to know a rumour.
pub struct Learnt {
    trial: u32,
    hop: Hop,
}

pub fn hops(record: &TrialRecord) -> impl Iterator<Item = Learnt> {
    record.asked.hops.iter().map(|hop| Learnt {
        trial: record.trial,
        hop,
    })
}

pub fn hop_columns() -> Vec<Column<Learnt>> {
    type Col = Column<Learnt>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::id("rumor", |row| row.hop.rumor.into()),
        Col::id("robot", |row| row.hop.robot.0),
        Col::f64("informed_s", |row| row.hop.at.as_secs()),
        Col::optional_id("parent", |row| row.hop.parent.map(|parent| parent.0)),
        Col::id("hops", |row| row.hop.hops),
    ]
}

/// What a robot of one trial sent and received on a topic, in a window of time.
pub struct Traffic {
    trial: u32,
    topic: &'static str,
    entry: TrafficEntry,
}

pub fn traffic(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Traffic> {
    record.asked.traffic.iter().map(|entry| Traffic {
        trial: record.trial,
        topic: names.topic(entry.topic.into()),
        entry,
    })
}

pub fn traffic_columns() -> Vec<Column<Traffic>> {
    type Col = Column<Traffic>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("since_s", |row| row.entry.since.as_secs()),
        Col::f64("time_s", |row| row.entry.at.as_secs()),
        Col::id("robot", |row| row.entry.robot.0),
        Col::text("topic", |row| row.topic.into()),
        Col::count("sent_frames", |row| row.entry.sent_frames),
        Col::count("sent_bytes", |row| row.entry.sent_bytes),
        Col::count("received_frames", |row| row.entry.received_frames),
        Col::count("received_bytes", |row| row.entry.received_bytes),
    ]
}

/// A robot of one trial enters a role.
pub struct Entered {
    trial: u32,
    change: RoleChange,
    before: Option<&'static str>,
    role: &'static str,
}

pub fn roles(record: &TrialRecord, names: &Names) -> impl Iterator<Item = Entered> {
    record.asked.roles.iter().map(|change| Entered {
        trial: record.trial,
        before: change.before.map(|role| names.role(role.into())),
        role: names.role(change.role.into()),
        change,
    })
}

pub fn role_columns() -> Vec<Column<Entered>> {
    type Col = Column<Entered>;
    vec![
        Col::id("trial", |row| row.trial),
        Col::f64("time_s", |row| row.change.at.as_secs()),
        Col::id("robot", |row| row.change.robot.0),
        Col::optional_text("before", |row| row.before.map(Into::into)),
        Col::text("role", |row| row.role.into()),
    ]
}

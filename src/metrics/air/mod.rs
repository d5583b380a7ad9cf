//! What radios do in a trial, over one that keeps accounts: how long they send and find the channel busy, how long frames wait and how often they go out,
//! how strong they arrive, from how far.
//!
//! The book is begun when something is told: over a radio that tells nothing, such as the disk, there is none.

mod bands;
mod record;

pub use record::{AirRecord, Copies, DistanceBand, ENERGY_STATES, LinkRecord, RobotAir, Waits};

use std::collections::BTreeMap;

use super::latency::LatencyHistogram;
use crate::engine::ActorId;
use crate::radio::{Account, Conclusion, Outcome, Reading};
pub(super) use bands::Bands;

/// The book of a run.
#[derive(Debug)]
pub(super) struct Air {
    robots: Vec<Robot>,
    queue_wait: LatencyHistogram,
    access_delay: LatencyHistogram,
    bands: Bands,
    by_distance: Vec<Tally>,
    links: Option<BTreeMap<(ActorId, ActorId), Link>>,
}

#[derive(Clone, Debug, Default)]
struct Robot {
    air: RobotAir,
    heard: Tally,
}

#[derive(Debug, Default)]
struct Link {
    tally: Tally,
    /// Sum over copies, metres.
    distance: f64,
}

/// Copies being counted.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    offered: u64,
    delivered: u64,
    reached: Levels,
    understood: Levels,
}

/// Powers, dBm, being averaged.
#[derive(Clone, Copy, Debug, Default)]
struct Levels {
    count: u64,
    sum: f64,
}

impl Levels {
    fn add(&mut self, power: f32) {
        self.count += 1;
        self.sum += f64::from(power);
    }

    fn mean(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

impl Tally {
    fn add(&mut self, reading: &Reading) {
        self.offered += 1;
        self.delivered += u64::from(reading.received);
        if reading.power.is_finite() {
            self.reached.add(reading.power);
            if reading.received {
                self.understood.add(reading.power);
            }
        }
    }

    fn copies(self) -> Copies {
        Copies {
            offered: self.offered,
            delivered: self.delivered,
            reached: self.reached.count,
            power_dbm: self.reached.mean(),
            delivered_power_dbm: self.understood.mean(),
        }
    }
}

impl Air {
    /// Of so many robots, and of every link that any copy is offered on if `links`.
    pub fn new(robots: usize, links: bool) -> Self {
        let bands = Bands::new();
        Self {
            robots: vec![Robot::default(); robots],
            queue_wait: LatencyHistogram::default(),
            access_delay: LatencyHistogram::default(),
            by_distance: vec![Tally::default(); bands.len()],
            bands,
            links: links.then(BTreeMap::new),
        }
    }

    /// A robot's radio is done with a frame.
    pub fn concluded(&mut self, conclusion: &Conclusion) {
        let robot = &mut self.robots[conclusion.frame.sender.index()].air;
        robot.frames += 1;
        robot.attempts += u64::from(conclusion.attempts);
        match conclusion.outcome {
            Outcome::Sent => {}
            Outcome::Acknowledged => robot.acknowledged += 1,
            Outcome::Unacknowledged => robot.unacknowledged += 1,
            Outcome::Dropped(cause) => robot.dropped[cause as usize] += 1,
        }
        let Some(began) = conclusion.began else { return };
        robot.on_air += 1;
        let queue_wait = conclusion.at_head.since(conclusion.handed_over);
        let access_delay = began.since(conclusion.at_head);
        robot.queue_wait = Some(Waits::and(robot.queue_wait, queue_wait));
        robot.access_delay = Some(Waits::and(robot.access_delay, access_delay));
        self.queue_wait.record(queue_wait);
        self.access_delay.record(access_delay);
    }

    /// A copy of a frame of `sender` is decided.
    pub fn measured(&mut self, sender: ActorId, reading: &Reading) {
        self.robots[reading.receiver.index()].heard.add(reading);
        self.by_distance[Bands::of(reading.distance)].add(reading);
        if let Some(links) = &mut self.links {
            let link = links.entry((sender, reading.receiver)).or_default();
            link.tally.add(reading);
            link.distance += f64::from(reading.distance);
        }
    }

    /// A robot got a message though it counted as out of range.
    pub fn strayed(&mut self, receiver: ActorId) {
        self.robots[receiver.index()].air.strayed += 1;
    }

    /// What a robot's radio did in all of the run.
    pub fn accounted(&mut self, robot: ActorId, account: &Account) {
        let robot = &mut self.robots[robot.index()].air;
        robot.sent = account.sent;
        robot.busy = account.busy;
        robot.energy = account.energy;
        robot.empty_at = account.empty_at;
    }

    /// Closes the book.
    pub fn into_record(self) -> AirRecord {
        let robot = |robot: Robot| RobotAir {
            heard: robot.heard.copies(),
            ..robot.air
        };
        let bands = self.by_distance.iter().enumerate();
        let bands = bands
            .filter(|(_, tally)| tally.offered > 0)
            .map(|(band, tally)| {
                let [from_m, to_m] = self.bands.bounds(band);
                DistanceBand {
                    from_m,
                    to_m,
                    copies: tally.copies(),
                }
            })
            .collect();
        let links = self.links.into_iter().flatten();
        let link = |((sender, receiver), link): ((ActorId, ActorId), Link)| LinkRecord {
            sender,
            receiver,
            copies: link.tally.copies(),
            distance_m: link.distance / link.tally.offered as f64,
        };
        AirRecord {
            robots: self.robots.into_iter().map(robot).collect(),
            queue_wait: self.queue_wait,
            access_delay: self.access_delay,
            bands,
            links: links.map(link).collect(),
        }
    }
}

#[cfg(test)]
mod tests;

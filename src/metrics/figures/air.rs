//! Radios on which frames take time: how full the channel is, how long frames wait for it and how often they go out, what that costs.

use super::figure::{Better, Sample};
use super::registry::Registry;
use crate::engine::{SimTime, Span};
use crate::metrics::air::{AirRecord, RobotAir, Waits};
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, SECONDS};
use crate::statistics::{Estimator, Observation, Part, mean_value};

/// A time of a robot.
type Time = fn(&RobotAir) -> Span;

impl Registry {
    /// The same, and the figures of a radio that keeps accounts: of robots that share the air.
    ///
    /// | key | meaning |
    /// |---|---|
    /// | `goodput_bps` | payload that arrived at all robots together, bit/s |
    /// | `radio.airtime_share` | share of the time that a robot sends |
    /// | `radio.busy_share` | share of the time that a robot finds the channel busy, its own sending included |
    /// | `radio.queue_wait_s.mean` | how long frames that went on air waited for those before them, s |
    /// | `radio.access_delay_s.mean`, `.p95` | how long medium access took with them then, s |
    /// | `radio.attempts` | how often a frame that went on air was there |
    /// | `radio.unacknowledged` | share of the frames that are acknowledged or sent again that never were acknowledged |
    /// | `radio.dropped` | share of the frames handed over that never went on air |
    /// | `radio.strayed` | of all messages received, those whose receiver counted as out of range: offered to nobody, they are in no other figure |
    /// | `radio.energy_J` | what a robot's radio drew from its battery, J |
    /// | `radio.power_dBm` | power of copies that were understood, dBm |
    #[must_use]
    pub fn sharing_air(mut self) -> Self {
        declare(&mut self);
        self
    }

    /// The same, and of robots with a battery `radio.lifetime_s`: how long it lasts, the mean of these times. Of a battery that lasts beyond
    /// the end the time is cut off there.
    #[must_use]
    pub fn on_batteries(mut self) -> Self {
        let kind = (SECONDS, Better::Higher, Estimator::Times);
        self.add_as_ratio("radio.lifetime_s", "life of a battery", kind, |record| {
            Sample::times(lifetimes(record).collect())
        });
        self
    }
}

fn declare(registry: &mut Registry) {
    let goodput = ("bit/s", Better::Higher, Estimator::Mean);
    registry.add_plain("goodput_bps", "goodput", goodput, goodput_bps);
    let share = (DIMENSIONLESS, Better::Lower, Estimator::Fraction);
    let shares: [(&str, &str, Time); 2] = [
        ("radio.airtime_share", "time that a robot sends", |robot| robot.sent),
        (
            "radio.busy_share",
            "time that a robot finds the channel busy",
            |robot| robot.busy,
        ),
    ];
    for (key, name, time) in shares {
        registry.add_plain(key, name, share, move |record| share_of_time(record, time));
    }
    let wait = (SECONDS, Better::Lower, Estimator::Mean);
    registry.add_plain("radio.queue_wait_s.mean", "wait in the queue, mean", wait, |record| {
        mean_wait(record, |robot| robot.queue_wait)
    });
    registry.add_plain("radio.access_delay_s.mean", "access delay, mean", wait, |record| {
        mean_wait(record, |robot| robot.access_delay)
    });
    registry.add_plain(
        "radio.access_delay_s.p95",
        "access delay, 95th percentile",
        wait,
        |record| record.air.as_ref()?.access_delay.quantile(0.95).map(Span::as_secs),
    );
    let attempts = (DIMENSIONLESS, Better::Lower, Estimator::Mean);
    registry.add_ratio("radio.attempts", "attempts at a frame", attempts, |record| {
        [sum(record, |robot| robot.attempts), sum(record, |robot| robot.on_air)]
    });
    let lost = (DIMENSIONLESS, Better::Lower, Estimator::ShareOf);
    registry.add_ratio(
        "radio.unacknowledged",
        "frames never acknowledged, of those that ask for it",
        lost,
        unacknowledged,
    );
    registry.add_ratio("radio.dropped", "frames that never went on air", lost, |record| {
        [sum(record, RobotAir::never_sent), sum(record, |robot| robot.frames)]
    });
    let apart = (DIMENSIONLESS, Better::Lower, Estimator::ShareOf);
    registry.add_ratio(
        "radio.strayed",
        "messages received from out of range",
        apart,
        |record| {
            let strayed = sum(record, |robot| robot.strayed);
            let delivered: u64 = record.ledger.iter().map(|fates| fates.delivered).sum();
            [strayed, strayed + delivered as f64]
        },
    );
    let energy = ("J", Better::Lower, Estimator::Mean);
    registry.add_plain("radio.energy_J", "energy of a robot's radio", energy, energy_j);
    let power = ("dBm", Better::Higher, Estimator::Signed);
    registry.add_plain("radio.power_dBm", "power of frames received", power, power_dbm);
}

/// The robots of a trial.
fn robots(record: &TrialRecord) -> &[RobotAir] {
    record.air.as_ref().map_or(&[], |air: &AirRecord| &air.robots)
}

/// How long each robot's battery lasted, or how long it was watched.
fn lifetimes(record: &TrialRecord) -> impl Iterator<Item = Observation> {
    robots(record).iter().map(|robot| Observation {
        time: robot.empty_at.map_or(record.simulated.as_secs(), SimTime::as_secs),
        happened: robot.empty_at.is_some(),
    })
}

fn sum(record: &TrialRecord, count: impl Fn(&RobotAir) -> u64) -> f64 {
    robots(record).iter().map(count).sum::<u64>() as f64
}

fn goodput_bps(record: &TrialRecord) -> Option<f64> {
    let bytes: u64 = record.traffic.iter().map(|row| row.received.payload_bytes).sum();
    let seconds = record.simulated.as_secs();
    (seconds > 0.0).then(|| 8.0 * bytes as f64 / seconds)
}

/// Mean over robots.
fn share_of_time(record: &TrialRecord, time: Time) -> Option<f64> {
    let all = record.simulated.as_secs();
    let shares: Vec<f64> = robots(record).iter().map(|robot| time(robot).as_secs() / all).collect();
    (all > 0.0).then(|| mean_value(&shares)).flatten()
}

/// Mean over frames that went on air.
fn mean_wait(record: &TrialRecord, wait: impl Fn(&RobotAir) -> Option<Waits>) -> Option<f64> {
    let frames = sum(record, |robot| robot.on_air);
    let waits = robots(record).iter().filter_map(wait);
    let nanos: u128 = waits.map(|waits| u128::from(waits.sum.as_nanos())).sum();
    (frames > 0.0).then(|| nanos as f64 / frames / 1e9)
}

fn unacknowledged(record: &TrialRecord) -> Part {
    let missing = sum(record, |robot| robot.unacknowledged);
    [missing, missing + sum(record, |robot| robot.acknowledged)]
}

/// Mean over robots; none where the radio does not account for energy.
fn energy_j(record: &TrialRecord) -> Option<f64> {
    let each: Vec<f64> = robots(record).iter().map(|robot| robot.energy.iter().sum()).collect();
    each.iter()
        .any(|energy| *energy > 0.0)
        .then(|| mean_value(&each))
        .flatten()
}

/// Mean over the copies that were understood.
fn power_dbm(record: &TrialRecord) -> Option<f64> {
    let heard = robots(record).iter().map(|robot| robot.heard);
    let known = heard.filter_map(|heard| Some((heard.delivered as f64, heard.delivered_power_dbm?)));
    let [weighted, weights] = known.fold([0.0; 2], |[sum, weights], (weight, power)| {
        [sum + weight * power, weights + weight]
    });
    (weights > 0.0).then(|| weighted / weights)
}

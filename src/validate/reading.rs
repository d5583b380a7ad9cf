//! What is read off a finished trial, each as a numerator and a denominator.

use crate::metrics::detection::FailureOutcome;
use crate::metrics::{RobotAir, TopicFates, TrialRecord};
use crate::radio::LossCause;
use crate::statistics::Part;

const NANOS: f64 = 1e-9;

fn fates(record: &TrialRecord) -> TopicFates {
    let mut sum = TopicFates::default();
    record.ledger.iter().for_each(|fates| sum.add(fates));
    sum
}

/// Copies whose fate is known.
fn settled(fates: &TopicFates) -> f64 {
    (fates.offered - fates.in_flight) as f64
}

/// Share of the copies that arrive.
pub fn delivered(record: &TrialRecord) -> Part {
    let fates = fates(record);
    [fates.delivered as f64, settled(&fates)]
}

/// Share of the copies that are lost.
pub fn lost(record: &TrialRecord) -> Part {
    let [delivered, all] = delivered(record);
    [all - delivered, all]
}

/// Share of the copies that are lost to `cause`.
pub fn lost_to(cause: LossCause) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let fates = fates(record);
        [fates.lost[cause as usize] as f64, settled(&fates)]
    }
}

/// Mean time from handing a message over to its arrival, in units of `unit` seconds.
pub fn latency(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        [
            record.latency.sum_nanos() as f64 * NANOS / unit,
            record.latency.count() as f64,
        ]
    }
}

fn robots(record: &TrialRecord) -> &[RobotAir] {
    record.air.as_ref().map_or(&[], |air| &air.robots)
}

/// Mean wait of frames for those before them, in units of `unit` seconds.
pub fn queue_wait(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let wait = record.air.as_ref().map(|air| &air.queue_wait);
        wait.map_or([0.0; 2], |wait| {
            [wait.sum_nanos() as f64 * NANOS / unit, wait.count() as f64]
        })
    }
}

/// Mean time that medium access takes with a frame, in units of `unit` seconds.
pub fn access_delay(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let wait = record.air.as_ref().map(|air| &air.access_delay);
        wait.map_or([0.0; 2], |wait| {
            [wait.sum_nanos() as f64 * NANOS / unit, wait.count() as f64]
        })
    }
}

/// Mean time from handing a frame over until it is first on air, in units of `unit` seconds.
pub fn delay(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let [waits, frames] = queue_wait(unit)(record);
        [waits + access_delay(unit)(record)[0], frames]
    }
}

/// Mean time that robots send for a frame, in units of `unit` seconds.
pub fn time_on_air(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let sent: f64 = robots(record).iter().map(|robot| robot.sent.as_secs()).sum();
        let frames: u64 = robots(record).iter().map(|robot| robot.on_air).sum();
        [sent / unit, frames as f64]
    }
}

/// Share of the time that robot 0 sends.
pub fn airtime_share(record: &TrialRecord) -> Part {
    let sent = robots(record).first().map_or(0.0, |robot| robot.sent.as_secs());
    [sent, record.simulated.as_secs()]
}

/// Share of the time that robots find the channel busy.
pub fn busy_share(record: &TrialRecord) -> Part {
    let busy: f64 = robots(record).iter().map(|robot| robot.busy.as_secs()).sum();
    [busy, record.simulated.as_secs() * robots(record).len() as f64]
}

/// How often a frame is on air.
pub fn attempts(record: &TrialRecord) -> Part {
    let count = |of: fn(&RobotAir) -> u64| robots(record).iter().map(of).sum::<u64>() as f64;
    [count(|robot| robot.attempts), count(|robot| robot.on_air)]
}

/// Share of the attempts that are not acknowledged.
pub fn failed_attempts(record: &TrialRecord) -> Part {
    let count = |of: fn(&RobotAir) -> u64| robots(record).iter().map(of).sum::<u64>() as f64;
    let attempts = count(|robot| robot.attempts);
    [attempts - count(|robot| robot.acknowledged), attempts]
}

/// Payload that arrives, Mb/s.
pub fn goodput(record: &TrialRecord) -> Part {
    let received: u64 = record.traffic.iter().map(|row| row.received.payload_bytes).sum();
    [8e-6 * received as f64, record.simulated.as_secs()]
}

/// What the radio of `robot` draws for `states`, mean over time, mW.
pub fn draws(robot: usize, states: &'static [usize]) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let energy = robots(record)
            .get(robot)
            .map_or(0.0, |air| states.iter().map(|state| air.energy[*state]).sum());
        [1e3 * energy, record.simulated.as_secs()]
    }
}

/// The powers at which each robot of an even number was heard by the next, dBm, in order.
fn powers(record: &TrialRecord) -> Vec<f64> {
    let links = record.air.as_ref().map_or(&[][..], |air| &air.links);
    let known = links.iter().filter(|link| link.sender.0 % 2 == 0);
    known.filter_map(|link| link.copies.power_dbm).collect()
}

/// Mean power of what is heard, dBm.
pub fn power(record: &TrialRecord) -> Part {
    let powers = powers(record);
    [powers.iter().sum(), powers.len() as f64]
}

/// Mean square of the difference of powers to `mean_dbm`, dB².
pub fn power_variance(mean_dbm: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let powers = powers(record);
        [
            powers.iter().map(|power| (power - mean_dbm).powi(2)).sum(),
            powers.len() as f64,
        ]
    }
}

/// Mean product of what `of` makes of each two powers that stand beside each other, dBm.
pub fn products(of: impl Fn(f64) -> f64 + Send + Sync) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| {
        let powers = powers(record);
        let pairs = powers.chunks_exact(2).map(|pair| of(pair[0]) * of(pair[1]));
        [pairs.sum(), (powers.len() / 2) as f64]
    }
}

/// Robots in range of a robot: mean over robots and samples.
pub fn neighbours(record: &TrialRecord) -> Part {
    let seen: Vec<f64> = record.connectivity.iter().map(|sample| sample.neighbours).collect();
    [seen.iter().sum(), seen.len() as f64]
}

/// Algebraic connectivity: mean over samples.
pub fn lambda2(record: &TrialRecord) -> Part {
    let seen: Vec<f64> = record.connectivity.iter().map(|sample| sample.lambda2).collect();
    [seen.iter().sum(), seen.len() as f64]
}

/// How often a second and pair statuses begin to be missed: suspicions in all of the time, in range or not.
pub fn onset_rate(record: &TrialRecord) -> Part {
    let seen = &record.detection;
    [
        seen.suspicions.len() as f64,
        record.simulated.as_secs() * seen.pairs as f64,
    ]
}

/// Statuses lost for each suspicion, each worth `unit`.
pub fn losses_a_suspicion(unit: f64) -> impl Fn(&TrialRecord) -> Part + Send + Sync {
    move |record| [lost(record)[0] * unit, record.detection.suspicions.len() as f64]
}

/// Monitored time for each suspicion, s.
pub fn recurrence(record: &TrialRecord) -> Part {
    [record.detection.monitored_s, record.detection.suspicions.len() as f64]
}

/// How long mistakes last that end in trust, s.
pub fn mistake_duration(record: &TrialRecord) -> Part {
    let over = record
        .detection
        .suspicions
        .iter()
        .filter(|suspicion| !suspicion.cut_off);
    let lasted: Vec<f64> = over
        .filter_map(|suspicion| Some(suspicion.duration?.as_secs()))
        .collect();
    [lasted.iter().sum(), lasted.len() as f64]
}

/// Share of the monitored time in which robots that are well are trusted.
pub fn accuracy(record: &TrialRecord) -> Part {
    let seen = &record.detection;
    [seen.monitored_s - seen.mistaken_s, seen.monitored_s]
}

/// How long after a failure it is suspected, s.
pub fn detection_time(record: &TrialRecord) -> Part {
    let times = record
        .detection
        .failures
        .iter()
        .filter_map(|failure| match failure.outcome {
            FailureOutcome::Detected(after) => Some(after.as_secs()),
            _ => None,
        });
    let times: Vec<f64> = times.collect();
    [times.iter().sum(), times.len() as f64]
}

/// When the last robot learns the first rumour, s.
pub fn spread_time(record: &TrialRecord) -> Part {
    let informed = record.spread.first().map_or(&[][..], |rumour| &rumour.informed);
    let all: Option<Vec<f64>> = informed
        .iter()
        .map(|at| at.map(crate::engine::SimTime::as_secs))
        .collect();
    all.filter(|all| !all.is_empty())
        .map_or([0.0; 2], |all| [all.iter().copied().fold(0.0, f64::max), 1.0])
}

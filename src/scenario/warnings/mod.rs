//! What is allowed and hardly meant: settings that can do nothing, or not what their author will have had in mind. Each is
//! a warning, said with its place and its remedy; a scenario that has some is run all the same.

use super::checks::Problem;
use super::{ProtocolConfig, Scenario};
use crate::metrics::MetricsConfig;
use crate::motion::MotionConfig;
use crate::radio::SensingConfig;

/// Everything that looks wrong with `scenario`, which holds.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let mut found = unread(scenario);
    found.extend(samples(scenario));
    found
}

/// Settings that differ from their defaults and that nothing reads with this protocol.
fn unread(scenario: &Scenario) -> Vec<Problem> {
    let Scenario {
        motion, metrics, radio, ..
    } = scenario;
    let defaults = MotionConfig::default();
    let wanders = scenario.wander.speed() > 0.0;
    let (protocol, senses, is_mission) = match scenario.protocol {
        ProtocolConfig::Backbone(_) => ("Backbone", true, true),
        ProtocolConfig::Heartbeat => ("Heartbeat", false, false),
        ProtocolConfig::Rumor(_) => ("Rumor", false, true),
    };
    let moves = senses || wanders;
    let quiet = SensingConfig::default();
    let no_hold = metrics.hold != MetricsConfig::default().hold && !is_mission;
    let nowhere = "no robot moves: see `wander`";
    let blind = "its robots do not ask where a sender or an obstacle is";
    let settings = [
        ("radio.sensing", !senses && radio.sensing != quiet, blind),
        (
            "motion.proximity_range",
            !senses && motion.proximity_range != defaults.proximity_range,
            blind,
        ),
        (
            "motion.max_speed",
            !moves && motion.max_speed != defaults.max_speed,
            nowhere,
        ),
        (
            "motion.max_turn_rate",
            !moves && motion.max_turn_rate != defaults.max_turn_rate,
            nowhere,
        ),
        ("motion.linear", !moves && motion.linear != defaults.linear, nowhere),
        ("motion.angular", !moves && motion.angular != defaults.angular, nowhere),
        ("metrics.hold", no_hold, "it has nothing to complete"),
        (
            "metrics.series_every",
            metrics.series_every > 1 && metrics.sample_interval.get() <= 0.0,
            "without samples there is no series",
        ),
    ];
    let told = settings
        .into_iter()
        .filter(|(_, is_set, _)| *is_set)
        .map(|(path, _, why)| {
            let message = format!("`{path}` is set, but nothing reads it with the protocol {protocol}: {why}");
            Problem::new(path, message, format!("leave `{path}` out")).with(&["protocol", "wander"])
        });
    told.collect()
}

/// Samples and series of which a trial is too short to hold any.
fn samples(scenario: &Scenario) -> Option<Problem> {
    let time_limit = scenario.time_limit.get();
    let interval = scenario.metrics.sample_interval.get();
    let every = scenario.metrics.series_every;
    let entry = interval * f64::from(every);
    let also = ["time_limit"];
    if interval > time_limit {
        let message =
            format!("samples are {interval} s apart, and a trial ends at {time_limit} s: only its start is sampled");
        let help = "make `metrics.sample_interval` shorter, or 0 for no samples";
        return Some(Problem::new("metrics.sample_interval", message, help).with(&also));
    }
    (entry > time_limit).then(|| {
        let message =
            format!("an entry of the series takes {entry} s, and a trial ends at {time_limit} s: there is none");
        let help =
            "make `metrics.series_every` or `metrics.sample_interval` less, or `metrics.series_every` 0 for no series";
        Problem::new("metrics.series_every", message, help).with(&["metrics.sample_interval", "time_limit"])
    })
}

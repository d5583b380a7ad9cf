//! What is allowed and hardly meant: settings that can do nothing, or not what their author will have had in mind. Each is
//! a warning, said with its place and its remedy; a scenario that has some is run all the same.

mod place;
mod time;

use super::{Scenario, needs};
use crate::kind::Problem;
use crate::metrics::{AskedTable, MetricsConfig};
use crate::motion::MotionConfig;
use crate::radio::{LossConfig, SensingConfig};

/// Everything that looks wrong with `scenario`, which holds.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let mut found = unread(scenario);
    found.extend(losses(scenario));
    found.extend(links(scenario));
    found.extend(tables(scenario));
    found.extend(time::warnings(scenario));
    found.extend(place::warnings(scenario));
    found.extend(scenario.protocol.warnings(&scenario.sections(), scenario.completion()));
    found.extend(needs::warnings(scenario));
    found
}

/// Channels that let nothing through, or never do what they are set up for.
fn losses(scenario: &Scenario) -> Option<Problem> {
    let radio = scenario.radio.disk();
    let range = radio.range.get();
    if radio.loss.mean_loss(range / 2.0, range) >= 1.0 {
        let message = "the channel loses every frame: no robot ever hears another";
        return Some(Problem::new("radio.loss", message, "make the loss less than 1"));
    }
    match radio.loss {
        LossConfig::GilbertElliott {
            good_to_bad, bad_loss, ..
        } if good_to_bad.get() <= 0.0 => {
            let message = format!(
                "the channel is never in its bad state, so that its `bad_loss` of {} counts for nothing",
                bad_loss.get()
            );
            let help = "make `good_to_bad` greater than 0, or use Bernoulli with the loss of the good state";
            Some(Problem::new("radio.loss", message, help))
        }
        _ => None,
    }
}

/// Links that are to be followed where the radio tells nothing of them.
fn links(scenario: &Scenario) -> Option<Problem> {
    let in_vain = scenario.metrics.links && scenario.radio.shared().is_none();
    in_vain.then(|| {
        let message = "`metrics.links` is set, but the disk radio measures nothing on its links";
        let help = "leave `metrics.links` out, say `metrics: (pairs: true)`, or give the radio a technology";
        Problem::new("metrics.links", message, help).with(&["radio"])
    })
}

/// Tables that are asked for and can only be empty, or tell nothing over time.
fn tables(scenario: &Scenario) -> Vec<Problem> {
    let Scenario { metrics, protocol, .. } = scenario;
    let spreads = protocol.mission().is_some() && protocol.targets().is_none();
    let sampled = metrics.sample_interval.get() > 0.0;
    let series = sampled && metrics.series_every > 0;
    let unknown = "which stays empty: no robot of this protocol notes that it knows a rumour";
    let unsampled = "which stays empty: nothing is sampled";
    let at_once = "over time, and all of a trial is one window of it: there is no series";
    let all = [
        (AskedTable::Hops, spreads, unknown, "protocol"),
        (AskedTable::Degree, sampled, unsampled, "metrics.sample_interval"),
        (AskedTable::Delays, series, at_once, "metrics.series_every"),
        (AskedTable::Traffic, series, at_once, "metrics.series_every"),
    ];
    let in_vain = all
        .into_iter()
        .filter(|(table, is_of_use, ..)| metrics.record.contains(table) && !is_of_use);
    let told = in_vain.map(|(table, _, why, also)| {
        let message = format!("`metrics.record` asks for {table:?}, {why}");
        let help = format!("leave {table:?} out of `metrics.record`, or change `{also}`");
        Problem::new("metrics.record", message, help).with(&[also])
    });
    told.collect()
}

/// Settings that differ from their defaults and that nothing reads with this protocol.
fn unread(scenario: &Scenario) -> Vec<Problem> {
    let Scenario { motion, metrics, .. } = scenario;
    let radio = scenario.radio.disk();
    let defaults = MotionConfig::default();
    let protocol = scenario.protocol.name();
    let senses = scenario.protocol.senses();
    let is_mission = scenario.protocol.mission().is_some();
    let moves = scenario.moves();
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

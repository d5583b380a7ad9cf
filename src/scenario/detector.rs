//! What a failure detector needs of the rest of a scenario.

use super::Scenario;
use crate::kind::Problem;
use crate::protocol::control::WakeConfig;
use crate::protocol::detector::{DetectorConfig, NfdSConfig, SwimConfig};

/// What is wrong with the detector among the other settings.
pub fn problems(scenario: &Scenario) -> Vec<Problem> {
    let own = match &scenario.detector {
        DetectorConfig::NfdS(nfd_s) => freshness(scenario, nfd_s),
        DetectorConfig::Swim(swim) => answers(scenario, swim),
        DetectorConfig::None | DetectorConfig::Timeout(_) | DetectorConfig::PhiAccrual(_) => None,
    };
    pauses(scenario)
        .into_iter()
        .chain(own)
        .chain(unspoken(scenario))
        .collect()
}

/// What a detector says must fit into the robots' messages.
fn unspoken(scenario: &Scenario) -> Option<Problem> {
    let speaks = scenario.runs_detector() && scenario.detector.sends();
    (speaks && !scenario.protocol.has_probes()).then(|| {
        let message = format!(
            "this detector sends messages, and those of the protocol {} cannot carry what it says",
            scenario.protocol.name()
        );
        let help = "use one that listens: `Timeout`, `NfdS` or `PhiAccrual`";
        Problem::new("detector", message, help).with(&["protocol"])
    })
}

/// The pause from one status to the next must not be suspicious.
fn pauses(scenario: &Scenario) -> Option<Problem> {
    let circumstances = scenario.circumstances();
    let status = circumstances.status_interval.as_secs();
    let silence = scenario.detector.shortest_silence(circumstances)?.as_secs();
    let help = match scenario.detector {
        DetectorConfig::Timeout(_) => "make `detector`'s timeout several times `gossip.status.interval`",
        _ => "make `detector`'s threshold or its intervals longer, or `gossip.status.interval` shorter",
    };
    (status >= silence).then(|| {
        let message = format!(
            "every pause between two statuses would be taken for a failure: they come every {status} s, and a silence of {silence} s is suspicious"
        );
        let help = format!("{help}, which is rounded up to whole control periods");
        Problem::new("detector", message, help).with(&["gossip.status.interval", "control.period"])
    })
}

/// A status must arrive before its freshness point.
fn freshness(scenario: &Scenario, nfd_s: &NfdSConfig) -> Option<Problem> {
    let (shift, latency) = (nfd_s.shift.get(), scenario.radio.disk().latency.mean());
    (latency >= shift).then(|| {
        let message = format!(
            "most statuses would come too late to count: they take {latency} s on average, and count {shift} s after they were sent"
        );
        let help = "make `detector`'s `shift` longer, or `radio.latency` shorter";
        Problem::new("detector", message, help).with(&["radio.latency"])
    })
}

/// A ping must have the time to be answered, and so must the pings of others.
fn answers(scenario: &Scenario, swim: &SwimConfig) -> Option<Problem> {
    let period = match scenario.control.wake {
        WakeConfig::ControlStep => scenario.control.period.get(),
        WakeConfig::OnReception => 0.0,
    };
    let latency = scenario.radio.disk().latency.mean();
    let (interval, timeout) = (swim.probe_interval.get(), swim.probe_timeout.get());
    let direct = in_micros(period + 2.0 * latency);
    let through_others = in_micros(3.0 * period + 4.0 * latency);
    let also = ["control.period", "control.wake", "radio.latency"];
    if direct >= timeout {
        let message = format!(
            "every ping would be taken for lost: a robot that reads at its control steps answers within {direct} s, and `probe_timeout` is {timeout} s"
        );
        let help = "make `probe_timeout` longer, or `control.period` shorter";
        return Some(Problem::new("detector", message, help).with(&also));
    }
    let left = in_micros(interval - timeout);
    (swim.indirect_checks > 0 && left > 0.0 && through_others >= left).then(|| {
        let message = format!(
            "no answer through others would come in time: it takes up to {through_others} s, and `probe_timeout` leaves {left} s of the `probe_interval`"
        );
        let help = "make `probe_interval` longer, or `control.period` shorter, or `indirect_checks` 0";
        Problem::new("detector", message, help).with(&also)
    })
}

/// Seconds rounded to whole microseconds, as a reader would add them up.
fn in_micros(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

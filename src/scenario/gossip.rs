//! What is wrong between gossip settings and what they are for: the protocol, its timeouts, its failure detector.

use crate::engine::Span;
use crate::kind::{Problem, Shared};
use crate::protocol::gossip::{
    FanOutConfig, GossipConfig, RelayConfig, RequestConfig, RetransmitConfig, SendConfig, StrandConfig, Timing,
    TopicConfig,
};
use crate::protocol::wander::WanderConfig;

use super::Scenario;

/// Everything wrong with the gossip settings of `scenario`, whose periods hold.
pub fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut found = unheeded(scenario);
    found.extend(of_topics(scenario));
    found.extend(wandering(scenario));
    found
}

/// Settings that differ from their defaults and that the protocol does not heed.
fn unheeded(scenario: &Scenario) -> Vec<Problem> {
    let protocol = &scenario.protocol;
    let heeded = protocol.heeds(&scenario.sections());
    let heeds = |setting: &Shared| heeded.contains(setting);
    let unheeded = Shared::ALL.into_iter().filter(|setting| {
        // A part of what is not heeded anyway is not worth a word of its own.
        is_set(*setting, scenario) && !heeds(setting) && setting.whole().as_ref().is_none_or(heeds)
    });
    let told = unheeded.map(|setting| {
        let (path, name, why) = (setting.path(), protocol.name(), protocol.unheeded(setting));
        let message = format!("`{path}` is set, but the protocol {name} does not heed it: {why}");
        Problem::new(path, message, format!("leave `{path}` out")).with(&["protocol"])
    });
    told.collect()
}

/// Whether `setting` differs from its default.
fn is_set(setting: Shared, scenario: &Scenario) -> bool {
    let GossipConfig {
        status,
        strand,
        request,
        relay,
        piggyback,
    } = &scenario.gossip;
    match setting {
        Shared::Status => *status != TopicConfig::default(),
        Shared::StatusSend => status.send != SendConfig::Always,
        Shared::Strand => *strand != StrandConfig::default(),
        Shared::Request => *request != RequestConfig::default(),
        Shared::Relay => *relay != RelayConfig::default(),
        Shared::RelayFanOut => relay.fan_out != FanOutConfig::Everyone,
        Shared::Piggyback => *piggyback,
        Shared::Wander => scenario.wander != WanderConfig::Still,
        Shared::Detector => scenario.detector != Default::default(),
    }
}

fn of_topics(scenario: &Scenario) -> Vec<Problem> {
    let gossip = &scenario.gossip;
    let period = control_period(scenario);
    let topics: [(&str, f64, Timing, Option<SendConfig>); 4] = [
        (
            "status",
            gossip.status.jitter.get(),
            gossip.status.timing(period),
            Some(gossip.status.send),
        ),
        (
            "strand",
            gossip.strand.jitter.get(),
            gossip.strand.timing(period),
            Some(gossip.strand.send),
        ),
        (
            "request",
            gossip.request.jitter.get(),
            gossip.request.timing(period),
            None,
        ),
        ("relay", gossip.relay.jitter.get(), gossip.relay.timing(period), None),
    ];
    let mut found = Vec::new();
    for (topic, jitter, timing, send) in topics {
        let interval = format!("gossip.{topic}.interval");
        if jitter > 0.0 && !timing.is_jittered() {
            let path = format!("gossip.{topic}.jitter");
            let message = format!(
                "`{path}` of {jitter} moves nothing: of an interval of {} s it is less than 2 control periods",
                (period * timing.every()).as_secs()
            );
            let help = format!("make `{path}` or `{interval}` greater");
            found.push(Problem::new(&path, message, help).with(&[&interval, "control.period"]));
        }
        if let Some(SendConfig::OnChange {
            max_interval,
            repetition,
        }) = send
        {
            let path = format!("gossip.{topic}.send");
            let pause = (period * timing.every()).as_secs();
            let max_interval = max_interval.get();
            if max_interval < 2.0 * pause {
                let message = format!(
                    "with a `max_interval` of {max_interval} s, `{path}` sends at every turn, as `Always` does: turns are {pause} s apart"
                );
                let help = format!("make it at least {} s, or use Always", 2.0 * pause);
                found.push(Problem::new(&path, message, help).with(&[&interval]));
            }
            if repetition == 0 {
                let message = format!("`{path}` says what is new 0 times");
                found.push(Problem::new(&path, message, "make `repetition` at least 1"));
            }
        }
    }
    if gossip.relay.retransmit == RetransmitConfig::Multiplier(0) {
        let help = "make it at least 1, or use Unlimited";
        found.push(Problem::new(
            "gossip.relay.retransmit",
            "a multiplier of 0 passes nothing on",
            help,
        ));
    }
    if gossip.relay.fan_out == FanOutConfig::Peers(0) {
        let help = "make it at least 1, or use Everyone";
        found.push(Problem::new(
            "gossip.relay.fan_out",
            "a fan-out of 0 addresses nobody",
            help,
        ));
    }
    found
}

fn wandering(scenario: &Scenario) -> Option<Problem> {
    let (speed, most) = (scenario.wander.speed(), scenario.motion.max_speed.get());
    (speed > most).then(|| {
        let message = format!("robots that wander at {speed} m/s are faster than they can go, {most} m/s");
        let help = "make `wander`'s speed less, or `motion.max_speed` greater";
        Problem::new("wander", message, help).with(&["motion.max_speed"])
    })
}

fn control_period(scenario: &Scenario) -> Span {
    Span::from_secs(scenario.control.period.get())
}

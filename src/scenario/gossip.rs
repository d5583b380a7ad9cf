//! What is wrong between gossip settings and what they are for: the protocol, its timeouts, its failure detector.

use crate::engine::Span;
use crate::protocol::backbone::BackboneConfig;
use crate::protocol::gossip::{
    FanOutConfig, GossipConfig, RelayConfig, RequestConfig, RetransmitConfig, SendConfig, StrandConfig, TimeToLiveConfig,
    Timing, TopicConfig,
};
use crate::protocol::wander::WanderConfig;

use super::checks::Problem;
use super::{ProtocolConfig, Scenario};

/// Everything wrong with the gossip settings of `scenario`, whose periods hold.
pub fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut found = unheeded(scenario);
    found.extend(of_topics(scenario));
    found.extend(wandering(scenario));
    match &scenario.protocol {
        ProtocolConfig::Backbone(backbone) => found.extend(strands(scenario, backbone)),
        ProtocolConfig::Rumor(rumor) => {
            let relay = rumor.relay_problems(&scenario.gossip.relay, scenario.swarm.robots);
            let placed = |problem| Problem::of_section("gossip.relay", problem).with(&["protocol", "swarm.robots"]);
            found.extend(relay.into_iter().map(placed));
        }
        ProtocolConfig::Heartbeat => {}
    }
    found
}

/// Settings that differ from their defaults and that the protocol does not heed.
fn unheeded(scenario: &Scenario) -> Vec<Problem> {
    let GossipConfig {
        status,
        strand,
        request,
        relay,
        piggyback,
    } = &scenario.gossip;
    let status_set = *status != TopicConfig::default();
    let strand_set = *strand != StrandConfig::default();
    let request_set = *request != RequestConfig::default();
    let relay_set = *relay != RelayConfig::default();
    let always = status.send == SendConfig::Always;
    let still = scenario.wander == WanderConfig::Still;
    let detector_set = scenario.detector != Default::default();
    let (protocol, settings): (_, &[(&str, bool, &str)]) = match &scenario.protocol {
        ProtocolConfig::Backbone(_) => (
            "Backbone",
            &[
                ("gossip.relay.fan_out", relay.fan_out != FanOutConfig::Everyone, "its orders are for everyone"),
                ("wander", !still, "it says itself how robots move"),
            ],
        ),
        ProtocolConfig::Heartbeat => (
            "Heartbeat",
            &[
                ("gossip.status.send", !always, "each of its statuses has a new number, and so has changed"),
                ("gossip.strand", strand_set, "it has no strands"),
                ("gossip.request", request_set, "it has no requests"),
                ("gossip.relay", relay_set, "it passes nothing on"),
                ("gossip.piggyback", *piggyback, "it sends one message at a time"),
            ],
        ),
        ProtocolConfig::Rumor(_) => (
            "Rumor",
            &[
                ("gossip.status", status_set, "it has no statuses"),
                ("gossip.strand", strand_set, "it has no strands"),
                ("gossip.request", request_set, "its requests go out with its rounds: see `gossip.relay`"),
                ("detector", detector_set, "it runs no failure detector"),
            ],
        ),
    };
    let told = settings.iter().filter(|(_, is_set, _)| *is_set).map(|(path, _, why)| {
        let message = format!("`{path}` is set, but the protocol {protocol} does not heed it: {why}");
        Problem::new(path, message, format!("leave `{path}` out")).with(&["protocol"])
    });
    told.collect()
}

fn of_topics(scenario: &Scenario) -> Vec<Problem> {
    let gossip = &scenario.gossip;
    let period = control_period(scenario);
    let topics: [(&str, f64, Timing, Option<SendConfig>); 4] = [
        ("status", gossip.status.jitter.get(), gossip.status.timing(period), Some(gossip.status.send)),
        ("strand", gossip.strand.jitter.get(), gossip.strand.timing(period), Some(gossip.strand.send)),
        ("request", gossip.request.jitter.get(), gossip.request.timing(period), None),
        ("relay", gossip.relay.jitter.get(), gossip.relay.timing(period), None),
    ];
    let mut found = Vec::new();
    for (topic, jitter, timing, send) in topics {
        let interval = format!("gossip.{topic}.interval");
        if jitter > 0.0 && !timing.is_jittered() {
            let path = format!("gossip.{topic}.jitter");
            let message = format!(
                "`{path}` of {jitter} moves nothing: of an interval of {} control periods it is less than 2",
                timing.every()
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
        found.push(Problem::new("gossip.relay.retransmit", "a multiplier of 0 passes nothing on", help));
    }
    if gossip.relay.fan_out == FanOutConfig::Peers(0) {
        let help = "make it at least 1, or use Everyone";
        found.push(Problem::new("gossip.relay.fan_out", "a fan-out of 0 addresses nobody", help));
    }
    found
}

/// What the backbone's timeouts and chains bear.
fn strands(scenario: &Scenario, backbone: &BackboneConfig) -> Vec<Problem> {
    let strand = &scenario.gossip.strand;
    let period = control_period(scenario);
    let pause = (period * strand.repetition(period).longest_pause()).as_secs();
    let mut bounds = vec![
        ("protocol.recruiting.join_timeout", backbone.recruiting.join_timeout.get(), "a join without a sign is undone"),
        ("protocol.healing.patience", backbone.healing.patience.get(), "the root forgets a chain"),
    ];
    if let TimeToLiveConfig::Seconds(seconds) = strand.time_to_live {
        bounds.push(("gossip.strand.time_to_live", seconds.get(), "a strand counts no more"));
    }
    let too_rare = bounds.into_iter().filter(|(_, seconds, _)| pause >= *seconds);
    let mut found: Vec<_> = too_rare
        .map(|(path, seconds, what)| {
            let message = format!("strand info comes every {pause} s at the latest, and after {seconds} s {what}");
            let help = format!("make `{path}` several times the interval of `gossip.strand`, or that one shorter");
            Problem::new(path, message, help).with(&["gossip.strand", "control.period"])
        })
        .collect();
    let robots = backbone.longest_chain();
    if usize::from(strand.hop_limit) < robots {
        let path = "gossip.strand.hop_limit";
        let message = format!("no strand may name more than {} robots, but the longest chain has {robots}", strand.hop_limit);
        let help = format!("make `{path}` at least {robots}");
        found.push(Problem::new(path, message, help).with(&["protocol.targets"]));
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

//! What is wrong between gossip settings and what they are for: the protocol, its timeouts, its failure detector.

use crate::engine::Span;
use crate::kinds::backbone::BackboneConfig;
use crate::protocol::gossip::{
    FanOutConfig, GossipConfig, RelayConfig, RequestConfig, RetransmitConfig, SendConfig, StrandConfig,
    TimeToLiveConfig, Timing, TopicConfig,
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
                (
                    "gossip.relay.fan_out",
                    relay.fan_out != FanOutConfig::Everyone,
                    "its orders are for everyone",
                ),
                ("wander", !still, "it says itself how robots move"),
            ],
        ),
        ProtocolConfig::Heartbeat => (
            "Heartbeat",
            &[
                (
                    "gossip.status.send",
                    !always,
                    "each of its statuses has a new number, and so has changed",
                ),
                ("gossip.strand", strand_set, "it has no strands"),
                ("gossip.request", request_set, "it has no requests"),
                ("gossip.relay", relay_set, "it passes nothing on"),
                (
                    "gossip.piggyback",
                    *piggyback && !scenario.detector.sends(),
                    "it sends one message at a time",
                ),
            ],
        ),
        ProtocolConfig::Rumor(_) => (
            "Rumor",
            &[
                ("gossip.status", status_set, "it has no statuses"),
                ("gossip.strand", strand_set, "it has no strands"),
                (
                    "gossip.request",
                    request_set,
                    "its requests go out with its rounds: see `gossip.relay`",
                ),
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

/// What the backbone's timeouts and chains bear.
fn strands(scenario: &Scenario, backbone: &BackboneConfig) -> Vec<Problem> {
    let strand = &scenario.gossip.strand;
    let period = control_period(scenario);
    let pause = (period * strand.repetition(period).longest_pause()).as_secs();
    let mut bounds = vec![
        (
            "protocol.recruiting.join_timeout",
            backbone.recruiting.join_timeout.get(),
            "a join without a sign is undone",
        ),
        (
            "protocol.healing.patience",
            backbone.healing.patience.get(),
            "the root forgets a chain",
        ),
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
        let message = format!(
            "no strand may name more than {} robots, but the longest chain has {robots}",
            strand.hop_limit
        );
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

#[cfg(test)]
mod tests {
    use crate::scenario::{Override, parse};

    const BACKBONE: &str = "Backbone(targets: Ring(count: 4, radius: 4.5, links: 2))";
    const RUMOR: &str = "Rumor(rounds: Poisson)";

    /// The messages about a scenario with this protocol and these sections, with the fields that they point at.
    fn messages(protocol: &str, sections: &str) -> Vec<String> {
        let text = format!(
            "Scenario(name: \"a\", time_limit: 60.0, swarm: (robots: 40, deploy: Cluster(radius: 1.06)), protocol: {protocol}, {sections})"
        );
        let none: &[Override] = &[];
        let report = parse("a.ron", &text, none).err();
        report.map_or_else(Vec::new, |report| {
            report.diagnostics.into_iter().map(|found| found.message).collect()
        })
    }

    #[test]
    fn a_setting_that_the_protocol_does_not_heed_is_refused_by_name() {
        for (protocol, sections, field) in [
            ("Heartbeat", "gossip: (piggyback: true)", "gossip.piggyback"),
            (
                "Heartbeat",
                "gossip: (status: (send: OnChange(max_interval: 1.0)))",
                "gossip.status.send",
            ),
            ("Heartbeat", "gossip: (strand: (hop_limit: 9))", "gossip.strand"),
            ("Heartbeat", "gossip: (request: (interval: 0.2))", "gossip.request"),
            (
                "Heartbeat",
                "gossip: (relay: (retransmit: Multiplier(4)))",
                "gossip.relay",
            ),
            (BACKBONE, "gossip: (relay: (fan_out: Peers(3)))", "gossip.relay.fan_out"),
            (BACKBONE, "wander: RandomWaypoint(speed: 0.02)", "wander"),
            (RUMOR, "gossip: (status: (interval: 0.2))", "gossip.status"),
            (RUMOR, "gossip: (strand: (time_to_live: Seconds(3.0)))", "gossip.strand"),
            (RUMOR, "gossip: (request: (jitter: 1.0))", "gossip.request"),
            (RUMOR, "detector: Timeout(3.0)", "detector"),
        ] {
            let found = messages(protocol, sections);
            let expected = format!("`{field}` is set, but the protocol");
            assert!(
                found.iter().any(|message| message.starts_with(&expected)),
                "{sections}: {found:?}"
            );
        }
    }

    #[test]
    fn settings_that_a_protocol_heeds_are_accepted() {
        for (protocol, sections) in [
            (
                "Heartbeat",
                "gossip: (status: (interval: 0.5, jitter: 0.5)), wander: RandomWalk(speed: 0.02, leg: 5.0)",
            ),
            (
                BACKBONE,
                "gossip: (status: (send: OnChange(max_interval: 0.4, repetition: 2)), piggyback: true,
                 strand: (interval: 0.2, jitter: 1.0, time_to_live: Seconds(3.0), hop_limit: 3),
                 relay: (interval: 0.5, retransmit: Multiplier(4)))",
            ),
            (
                RUMOR,
                "gossip: (relay: (fan_out: Peers(39), retransmit: Multiplier(1)), piggyback: true)",
            ),
        ] {
            assert_eq!(messages(protocol, sections), [] as [String; 0], "{sections}");
        }
    }

    #[test]
    fn what_settings_together_make_meaningless_is_refused_with_the_numbers() {
        for (protocol, sections, expected) in [
            (
                "Heartbeat",
                "gossip: (status: (interval: 0.3, jitter: 0.5))",
                "moves nothing",
            ),
            (
                BACKBONE,
                "gossip: (status: (send: OnChange(max_interval: 0.1)))",
                "turns are 0.1 s apart",
            ),
            (
                BACKBONE,
                "gossip: (status: (send: OnChange(max_interval: 9.0)))",
                "they come every 9 s",
            ),
            (
                BACKBONE,
                "gossip: (status: (interval: 2.0, send: OnChange(max_interval: 4.0)))",
                "they come every 4 s",
            ),
            (
                BACKBONE,
                "gossip: (strand: (send: OnChange(max_interval: 5.0)))",
                "after 4 s a join without a sign is undone",
            ),
            (
                BACKBONE,
                "gossip: (strand: (send: OnChange(max_interval: 2.0, repetition: 0)))",
                "0 times",
            ),
            (
                BACKBONE,
                "gossip: (strand: (interval: 0.5, time_to_live: Seconds(0.5)))",
                "after 0.5 s a strand counts no more",
            ),
            (BACKBONE, "gossip: (strand: (hop_limit: 2))", "the longest chain has 3"),
            (
                BACKBONE,
                "gossip: (relay: (retransmit: Multiplier(0)))",
                "passes nothing on",
            ),
            (
                "Rumor()",
                "gossip: (relay: (fan_out: Peers(40)))",
                "has 39 others to address, not 40",
            ),
            ("Rumor()", "gossip: (relay: (fan_out: Peers(0)))", "addresses nobody"),
            (
                "Rumor(mode: Pull)",
                "gossip: (relay: (retransmit: Multiplier(2)))",
                "are not pushed",
            ),
            (RUMOR, "gossip: (relay: (jitter: 1.0))", "random already"),
            ("Rumor(sources: Robots([40]))", "", "robots are numbered from 0 to 39"),
            ("Rumor(sources: Random(65))", "", "there must be 1 to 64"),
            (
                "Rumor()",
                "metrics: (hold: 60.0)",
                "rumours must be known to all for 60 s",
            ),
            (
                "Heartbeat",
                "wander: RandomWalk(speed: 1.0, leg: 5.0)",
                "faster than they can go",
            ),
        ] {
            let found = messages(protocol, sections);
            assert!(
                found.iter().any(|message| message.contains(expected)),
                "{sections}: {found:?}"
            );
        }
    }
}

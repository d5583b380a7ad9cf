//! Gossip settings that a protocol does not heed, or that together mean nothing.

use desim::scenario::{Override, parse};

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

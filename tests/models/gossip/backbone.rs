//! A backbone that says less reaches its targets all the same.

use desim::metrics::{Outcome, TrialRecord};

use super::{run, scenario};

fn mission(gossip: &str) -> TrialRecord {
    let text = format!(
        "Scenario(name: \"small\", time_limit: 200.0, swarm: (robots: 12, deploy: Cluster(radius: 0.6)),
         protocol: Backbone(targets: Ring(count: 2, radius: 2.8, links: 2)), {gossip}
         radio: (loss: Bernoulli(0.2), latency: LogNormal(median: 0.02, sigma: 0.5)), metrics: (hold: 2.0))"
    );
    run(&scenario(&text), 1).remove(0)
}

fn bytes_per_step(record: &TrialRecord) -> f64 {
    record.traffic.iter().map(|row| row.sent.bytes()).sum::<u64>() as f64 / record.steps as f64
}

#[test]
fn what_changes_seldom_is_said_seldom_and_the_mission_is_still_completed() {
    let always = mission("");
    let frugal = mission(
        "gossip: (piggyback: true, status: (send: OnChange(max_interval: 0.3)),
         strand: (send: OnChange(max_interval: 0.8, repetition: 2))),",
    );
    for record in [&always, &frugal] {
        assert!(
            matches!(record.outcome, Outcome::Completed { .. }),
            "{:?}",
            record.outcome
        );
        assert!(record.ledger.iter().all(desim::metrics::TopicFates::is_balanced));
    }
    let (always, frugal) = (bytes_per_step(&always), bytes_per_step(&frugal));
    assert!(frugal < 0.5 * always, "{frugal} of {always}");
}

#[test]
fn jittered_turns_and_strands_of_limited_life_and_length_build_chains_too() {
    let record = mission(
        "gossip: (status: (interval: 0.2, jitter: 1.0), request: (interval: 0.2, jitter: 1.0),
         strand: (interval: 0.3, jitter: 0.7, time_to_live: Seconds(3.0), hop_limit: 2)),",
    );
    assert!(
        matches!(record.outcome, Outcome::Completed { .. }),
        "{:?}",
        record.outcome
    );
}

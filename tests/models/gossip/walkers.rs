//! Robots that wander while they gossip.

use desim::engine::ActorId;
use desim::metrics::Outcome;

use super::{run, scenario};

fn walkers(protocol: &str, wander: &str) -> desim::metrics::TrialRecord {
    let text = format!(
        "Scenario(name: \"walk\", time_limit: 120.0, arena: (size: (6.0, 6.0)), motion: (max_speed: 0.1),
         swarm: (robots: 8, deploy: Uniform), protocol: {protocol}, wander: {wander},
         radio: (range: 1.0, latency: Constant(0.02)), metrics: (hold: 0.0))"
    );
    run(&scenario(&text), 1).remove(0)
}

fn way(record: &desim::metrics::TrialRecord) -> f32 {
    let places = record.trajectories.iter().map(|(_, places)| places[3]);
    let places = places.clone().zip(places.skip(1));
    places.map(|([x0, y0], [x1, y1])| (x1 - x0).hypot(y1 - y0)).sum()
}

#[test]
fn walking_heartbeats_move_stay_in_the_arena_and_meet_more_robots_than_still_ones() {
    let still = walkers("Heartbeat", "Still");
    assert!(way(&still) < 1e-6);
    for wander in ["RandomWaypoint(speed: 0.1)", "RandomWalk(speed: 0.1, leg: 10.0)"] {
        let walked = walkers("Heartbeat", wander);
        assert!(way(&walked) > 6.0, "{wander}: {} m in 120 s", way(&walked));
        let inside = |place: &[f32; 2]| place.iter().all(|side| side.abs() <= 3.0);
        assert!(walked.trajectories.iter().all(|(_, places)| places.iter().all(inside)));
        assert!(walked.detection.pairs > still.detection.pairs, "{wander}");
    }
}

#[test]
fn a_rumour_is_carried_to_robots_out_of_range_of_its_source() {
    let protocol = "Rumor(sources: Robots([0]))";
    let still = walkers(protocol, "Still");
    let walked = walkers(protocol, "RandomWaypoint(speed: 0.1)");
    assert_eq!(still.outcome, Outcome::Censored);
    let informed = |record: &desim::metrics::TrialRecord| record.spread[0].informed.iter().flatten().count();
    assert!(
        informed(&walked) > informed(&still),
        "{} and {}",
        informed(&walked),
        informed(&still)
    );
    assert_eq!(walked.robots[ActorId(0).index()].role, 1);
}

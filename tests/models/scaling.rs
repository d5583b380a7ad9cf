//! Models hold no lengths of their own: only those of the scenario, and shares of them.

use desim::experiment::run_trial;
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

/// A scenario with every length and speed times 128. Powers of two are exact in binary, so that the mission must be the same to the
/// last event if no model holds a length of its own; another factor rounds otherwise, and robots that push each other amplify that.
#[test]
fn a_mission_in_a_world_128_times_as_large_takes_the_same_steps() {
    let mission = |scale: f64| {
        let m = |metres: f64| format!("{:?}", metres * scale);
        let text = format!(
            "Scenario(name: \"scaled\", time_limit: 250.0, arena: (size: ({arena}, {arena}), obstacles: [
                Disc(at: ({o}, {o}), radius: {r})]),
             swarm: (robots: 16, deploy: Cluster(radius: {cluster})),
             motion: (max_speed: {speed}, body_radius: {body}, proximity_range: {proximity}),
             control: (phase: Together),
             protocol: Backbone(targets: Ring(count: 3, radius: {ring}, links: 1), safe_distance: {safe},
                critical_distance: {critical}, movement_threshold: {threshold}, lj_delta: {delta},
                motion: (movement_gate: {gate}, push_limit: {push}, lane_spacing: {lane}, lane_limit: {lane_limit},
                    lj_speed: {lj}, avoidance_range: {avoid}, backbone_avoidance_range: {backbone},
                    avoidance_gain: {gain}, rest_speed: {rest})),
             radio: (range: {range}, loss: Bernoulli(0.1)), faults: [Crash(robots: [5], at: 40.0),
                Radiation(within: Disc(at: ({ring}, 0.0), radius: {safe}), hazard: 0.0005)])",
            arena = m(10.0),
            o = m(1.5),
            r = m(0.3),
            cluster = m(0.75),
            speed = m(0.04),
            body = m(0.07),
            proximity = m(0.25),
            ring = m(3.0),
            safe = m(1.4),
            critical = m(1.7),
            threshold = m(0.3),
            delta = m(0.5),
            gate = m(1.6),
            push = m(0.05),
            lane = m(0.35),
            lane_limit = m(0.3),
            lj = m(0.001),
            avoid = m(0.2),
            backbone = m(0.1),
            gain = m(0.05),
            rest = m(0.005),
            range = m(2.0),
        );
        let scenario = parse("scaled.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
        run_trial(&scenario, 0, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
    };
    let (small, large) = (mission(1.0), mission(128.0));
    assert_eq!(small.outcome, large.outcome);
    assert_eq!(small.events, large.events);
    assert_eq!(small.traffic, large.traffic);
    for (small, large) in small.robots.iter().zip(&large.robots) {
        assert_eq!(small.pose.position * 128.0, large.pose.position);
    }
}

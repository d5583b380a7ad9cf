//! Whole missions of the backbone: its chains form, last, and look as they should.

use std::path::Path;

use desim::experiment::run_trial;
use desim::geometry::Vec2;
use desim::kinds::backbone::Role;
use desim::metrics::{Outcome, RobotState, TrialRecord};
use desim::scenario::{Override, load};
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

fn run(file: &str, overrides: &[&str], trial: u32) -> TrialRecord {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(file);
    let overrides: Vec<Override> = overrides
        .iter()
        .map(|text| text.parse().expect("an override"))
        .collect();
    let scenario = load(&path, &overrides).expect("a shipped scenario with valid overrides");
    run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
}

fn assert_complete_and_connected(record: &TrialRecord) {
    assert!(
        matches!(record.outcome, Outcome::Completed { .. }),
        "{:?}",
        record.outcome
    );
    let lambda2 = record.lambda2_min().expect("connectivity is sampled");
    assert!(lambda2 > 0.0, "the swarm fell apart");
}

fn has_role(robot: &RobotState, role: Role) -> bool {
    robot.role == role as u8
}

/// The chain from the worker `robot` along its parent number `link` to the root, both included.
fn chain<'a>(robots: &'a [RobotState], worker: &'a RobotState, link: usize) -> Vec<&'a RobotState> {
    let mut chain = vec![worker, &robots[worker.parents[link].index()]];
    while !has_role(chain[chain.len() - 1], Role::Root) {
        let parent = chain[chain.len() - 1].parents[0];
        chain.push(&robots[parent.index()]);
        assert!(chain.len() <= robots.len(), "a chain runs in a circle");
    }
    chain
}

/// Every chain has two relays, hops within 0.15 m of each other, and relays that keep to one side of the straight line.
fn assert_straight_and_even(record: &TrialRecord) {
    let workers = record.robots.iter().filter(|robot| has_role(robot, Role::Worker));
    for worker in workers {
        for link in 0..worker.parents.len() {
            let chain = chain(&record.robots, worker, link);
            assert_eq!(chain.len(), 4, "two relays do for 4.5 m");
            let places: Vec<Vec2> = chain.iter().map(|robot| robot.pose.position).collect();
            let hops: Vec<f64> = places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
            let longest = hops.iter().copied().fold(0.0, f64::max);
            let shortest = hops.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(longest - shortest < 0.15, "uneven hops {hops:?}");
            let line = (places[3] - places[0]).normalize();
            let beside: Vec<f64> = places[1..3]
                .iter()
                .map(|place| line.perp(&(place - places[0])))
                .collect();
            assert!(
                (beside[0] - beside[1]).abs() < 0.15,
                "a chain that crosses its lane: {beside:?}"
            );
        }
    }
}

#[test]
fn one_link_to_each_target_makes_four_straight_evenly_spaced_chains() {
    for trial in 0..3 {
        let record = run("paper/completion_20x1.ron", &[], trial);
        assert_complete_and_connected(&record);
        assert_straight_and_even(&record);
    }
}

#[test]
fn two_links_run_side_by_side() {
    for trial in 0..3 {
        let record = run("ideal.ron", &[], trial);
        assert_complete_and_connected(&record);
        assert_straight_and_even(&record);
    }
}

#[test]
fn four_links_run_side_by_side_through_the_crowd_of_80_robots() {
    // Held, so that the chains have come to rest.
    let record = run("paper/completion_80x4.ron", &["protocol.completion=Held(10.0)"], 0);
    assert_complete_and_connected(&record);
    assert_straight_and_even(&record);
}

#[test]
fn a_fifth_of_all_frames_lost_and_late_ones_do_not_matter() {
    for trial in 0..2 {
        let radio = "radio=(loss: Bernoulli(0.2), latency: LogNormal(median: 0.02, sigma: 0.5))";
        assert_complete_and_connected(&run("ideal.ron", &[radio], trial));
    }
}

#[test]
fn half_of_all_frames_lost_and_noisy_senses_slow_the_swarm_down_and_do_not_stop_it() {
    let radio = "radio=(loss: Bernoulli(0.5), latency: LogNormal(median: 0.2, sigma: 1.0), \
                 sensing: (range_noise: 0.05, bearing_noise: 5.0))";
    assert_complete_and_connected(&run("ideal.ron", &[radio], 0));
}

#[test]
fn exactly_enough_robots_are_enough() {
    let record = run("paper/completion_20x1.ron", &["swarm.robots=13"], 0);
    assert_complete_and_connected(&record);
    assert!(!record.robots.iter().any(|robot| has_role(robot, Role::Free)));
}

#[test]
fn targets_at_any_distance_get_as_many_relays_as_they_need() {
    for (radius, relays) in [("0.5", 1), ("1.5", 1), ("3.2", 2), ("4.8", 3)] {
        let targets = format!("protocol=Backbone(targets: Ring(count: 2, radius: {radius}, links: 2))");
        let record = run("ideal.ron", &[&targets], 0);
        assert_complete_and_connected(&record);
        let worker = record
            .robots
            .iter()
            .find(|robot| has_role(robot, Role::Worker))
            .expect("two workers");
        let longest = (0..2).map(|link| chain(&record.robots, worker, link).len()).max();
        assert_eq!(longest, Some(relays + 2), "targets {radius} m out");
    }
}

/// Whether a robot is at target number `target` of four.
fn is_visited(target: usize, places: &[[f32; 2]]) -> bool {
    let (x, y) = [(4.5, 0.0), (0.0, 4.5), (-4.5, 0.0), (0.0, -4.5)][target];
    let is_there = |place: &[f32; 2]| (f64::from(place[0]) - x).hypot(f64::from(place[1]) - y) <= 0.3;
    places.iter().any(is_there)
}

#[test]
fn robots_that_do_for_one_target_alone_build_a_single_full_chain_and_visit_one_target_at_a_time() {
    // A root, four workers and the four relays of one target.
    let swarm = "swarm=(robots: 9, deploy: Cluster(radius: 0.5))";
    let record = run("paper/completion_40x2.ron", &[swarm, "time_limit=1500.0"], 0);
    let mut held = Vec::new();
    for (sample, (at, places)) in record.connectivity.iter().zip(&record.trajectories) {
        assert_eq!(sample.at, at);
        let is_held = |target: &usize| sample.links[*target] == 2 && is_visited(*target, &places);
        let now: Vec<usize> = (0..4).filter(is_held).collect();
        assert!(now.len() <= 1, "{now:?} at {} s", at.as_secs());
        held.extend(now);
    }
    held.sort_unstable();
    held.dedup();
    assert_eq!(held, [0, 1, 2, 3]);
}

#[test]
fn too_few_robots_for_all_targets_visit_one_after_another() {
    // 1 + 4 + 4·2·2 = 21 robots would be needed.
    let swarm = "swarm=(robots: 20, deploy: Cluster(radius: 0.75))";
    let record = run("paper/completion_40x2.ron", &[swarm, "time_limit=800.0"], 0);
    assert_eq!(record.outcome, Outcome::Censored, "never all at once");
    assert!(record.lambda2_min().is_some_and(|lambda2| lambda2 > 0.0));
    let mut visits = Vec::new();
    for (at, places) in &record.trajectories {
        for target in (0..4).filter(|&target| is_visited(target, &places)) {
            if !visits.contains(&target) {
                assert!(at.as_secs() > 0.0);
                visits.push(target);
            }
        }
    }
    assert_eq!(visits.len(), 4, "visited {visits:?}");
    let links = &record.connectivity.last().expect("connectivity is sampled").links;
    assert!(links.contains(&2), "the last target has both links: {links:?}");
}

#[test]
fn ten_robots_that_visit_four_targets_one_after_another_complete_where_each_is_to_be_visited_once_and_nowhere_else() {
    let complete = |rule: &str| {
        let rule = format!("protocol.completion={rule}");
        run("paper/bandwidth_10.ron", &[&rule], 0)
    };
    let visited = complete("EachVisited");
    let Outcome::Completed { step } = visited.outcome else {
        panic!("{:?}", visited.outcome)
    };
    assert_eq!(visited.steps, step + 1, "it is not held");
    assert_eq!(complete("Reached").outcome, Outcome::Censored);
}

#[test]
fn a_mission_reached_is_one_held_for_no_time() {
    let complete = |rule: &str| {
        let rule = format!("protocol.completion={rule}");
        run("paper/completion_20x1.ron", &[&rule], 3)
    };
    let [reached, at_once, held] = ["Reached", "Held(0.0)", "Held(2.5)"].map(complete);
    assert_eq!((reached.outcome, reached.digest), (at_once.outcome, at_once.digest));
    assert_eq!(held.outcome, reached.outcome, "the first step of the hold counts");
    assert_eq!(held.steps, reached.steps + 25);
}

//! Robots that wander, with their drives, their bodies and walls: where they are in the long run, and that they get where they go.

use desim::experiment::run_trial;
use desim::geometry::Vec2;
use desim::metrics::TrialRecord;
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

fn run(settings: &str, trial: u32) -> TrialRecord {
    let text = format!("Scenario(name: \"wandering\", protocol: Heartbeat, radio: (range: 1.0), {settings})");
    let scenario = parse("wandering.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
}

/// The places of each robot at every sample.
fn ways(record: &TrialRecord) -> Vec<Vec<Vec2>> {
    let robots = record.robots.len();
    let place = |robot: usize, places: &[[f32; 2]]| Vec2::new(places[robot][0].into(), places[robot][1].into());
    (0..robots)
        .map(|robot| {
            record
                .trajectories
                .iter()
                .map(|(_, places)| place(robot, &places))
                .collect()
        })
        .collect()
}

/// The mean of independent samples, and its standard error.
fn mean_and_error(samples: &[f64]) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let variance = samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// Uniform over 5.86 × 5.86 m, a robot is within 0.2 m of the rim for a share of 1 − (5.46/5.86)² = 0.132. A robot turns at a wall,
/// for half a turn takes it a second and more of its drive: v/π a second and metre of rim arrive there, 0.1/π · 4 · 5.86/5.86² =
/// 0.0217, and stay for 1.5 s at most, which adds up to 0.033. Each robot's share over 30 samples is one observation.
#[test]
fn walkers_do_not_stick_to_walls() {
    for period in [0.1, 1.0] {
        let settings = format!(
            "time_limit: 900.0, arena: (size: (6.0, 6.0)), swarm: (robots: 20, deploy: Uniform), control: (period: {period:?}),
             gossip: (status: (interval: 10.0)), detector: Timeout(1000.0), motion: (max_speed: 0.1),
             wander: RandomWalk(speed: 0.1, leg: 20.0), metrics: (sample_interval: 30.0)"
        );
        let near = |place: &Vec2| place.abs().max() > 2.93 - 0.2;
        let shares: Vec<f64> = (0..8)
            .flat_map(|trial| ways(&run(&settings, trial)))
            .map(|way| way.iter().filter(|place| near(place)).count() as f64 / way.len() as f64)
            .collect();
        let (share, error) = mean_and_error(&shares);
        let uniform = 1.0 - (5.46_f64 / 5.86).powi(2);
        assert!(
            share > uniform - 4.0 * error && share < uniform + 0.033 + 4.0 * error,
            "period {period} s: {share} ± {error}, uniform {uniform}"
        );
    }
}

/// Two uniform points of a square of side 9.72 m are 0.5214 · 9.72 = 5.07 m apart on average: 10.14 s at 0.5 m/s, and 2 s of rest. A
/// robot turns for a second and half at most, and waits for a control step twice, when it arrives and when it has rested.
#[test]
fn a_robot_gets_to_its_waypoints_in_the_time_that_the_way_takes_whatever_the_period() {
    for period in [0.1, 0.2, 0.5, 1.0] {
        let settings = format!(
            "time_limit: 600.0, swarm: (robots: 8, deploy: Uniform), control: (period: {period:?}),
             gossip: (status: (interval: 10.0)), detector: Timeout(1000.0), motion: (max_speed: 0.5),
             wander: RandomWaypoint(speed: 0.5, pause: 2.0), metrics: (sample_interval: 0.25)"
        );
        let mut legs = Vec::new();
        for way in (0..2).flat_map(|trial| ways(&run(&settings, trial))) {
            // A rest is a second without motion that a motion follows.
            let stands = |at: usize| way[at..at + 5].iter().all(|place| (place - way[at]).norm() < 1e-3);
            let rests = (0..way.len() - 6)
                .filter(|&at| stands(at) && !stands(at + 1))
                .collect::<Vec<_>>();
            legs.extend(rests.windows(2).map(|pair| 0.25 * (pair[1] - pair[0]) as f64));
        }
        let (mean, error) = mean_and_error(&legs);
        let least = 0.5214 * 9.72 / 0.5 + 2.0;
        assert!(
            mean > least - 4.0 * error && mean < least + 1.5 + 2.0 * period + 4.0 * error,
            "period {period} s: {mean} ± {error} s a leg, at least {least}"
        );
    }
}

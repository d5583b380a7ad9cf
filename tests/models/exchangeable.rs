//! Robots are alike whatever their number: where a robot stands, and so what befalls it, does not depend on it.

use desim::engine::Streams;
use desim::experiment::run_trial;
use desim::geometry::Vec2;
use desim::metrics::Outcome;
use desim::motion::{ArenaConfig, DeployConfig, ObstacleConfig, deploy};
use desim::quantity::{Finite, Positive};
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

/// Places of all robots of a cluster but for the first, which stands at the centre, as is said of it.
fn places(config: &DeployConfig, trial: u32) -> Vec<Vec2> {
    let arena = ArenaConfig {
        size: (Positive::new(9.0), Positive::new(6.0)),
        obstacles: vec![ObstacleConfig::Disc {
            at: (Finite::new(2.0), Finite::new(1.5)),
            radius: Positive::new(0.4),
            attenuation: None,
        }],
    };
    let poses = deploy(config, &arena, 60, 0.07, &Streams::new(3, trial)).expect("room for all");
    let first = usize::from(matches!(config, DeployConfig::Cluster { .. }));
    poses[first..].iter().map(|pose| pose.position).collect()
}

/// Spearman's rank correlation of the numbers 0, 1, … with `values`, which are all different.
fn rank_correlation(values: &[f64]) -> f64 {
    let number = values.len() as f64;
    let rank = |value: &f64| values.iter().filter(|other| *other < value).count() as f64;
    let squares: f64 = (0..)
        .zip(values)
        .map(|(id, value)| (f64::from(id) - rank(value)).powi(2))
        .sum();
    1.0 - 6.0 * squares / (number * (number * number - 1.0))
}

/// Under exchangeability a rank correlation of n robots has mean 0 and variance 1/(n − 1), and the distance between robots with
/// numbers in a row is on average that between any two. Over 400 trials the mean correlation has σ = 1/√(400 · 58) = 0.0066; the mean
/// distance in a row of 59 pairs of a trial varies by less than if they were independent with the deviation of a pair. Four σ.
#[test]
fn a_robots_number_says_nothing_about_its_place_nor_about_its_neighbours() {
    let cluster = DeployConfig::Cluster {
        radius: Positive::new(1.8),
    };
    for config in [DeployConfig::Uniform, cluster] {
        let trials: Vec<Vec<Vec2>> = (0..400).map(|trial| places(&config, trial)).collect();
        let count = trials.len() as f64;
        for measure in [
            |at: &Vec2| at.x,
            |at: &Vec2| at.y,
            |at: &Vec2| at.norm(),
            |at: &Vec2| at.x + at.y,
        ] {
            let of = |places: &Vec<Vec2>| rank_correlation(&places.iter().map(measure).collect::<Vec<f64>>());
            let mean = trials.iter().map(of).sum::<f64>() / count;
            let error = 1.0 / (count * (trials[0].len() as f64 - 1.0)).sqrt();
            assert!(mean.abs() < 4.0 * error, "{config:?}: {mean} ± {error}");
        }
        let (mut in_a_row, mut any, mut squares, mut pairs) = (0.0, 0.0, 0.0, 0.0);
        for places in &trials {
            in_a_row += places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>();
            for (index, a) in places.iter().enumerate() {
                for b in &places[index + 1..] {
                    let apart = (b - a).norm();
                    (any, squares, pairs) = (any + apart, squares + apart * apart, pairs + 1.0);
                }
            }
        }
        let rows = count * (trials[0].len() as f64 - 1.0);
        let (mean, any) = (in_a_row / rows, any / pairs);
        let deviation = (squares / pairs - any * any).sqrt();
        let error = deviation * (1.0 / rows).sqrt();
        assert!(
            (mean - any).abs() < 4.0 * error,
            "{config:?}: {mean} m in a row, {any} m between any ± {error}"
        );
    }
}

/// Steps until all of 50 robots know a rumour, over 120 swarms each: of robot 0, and of one drawn at random. Four standard
/// errors of the difference.
#[test]
fn a_rumour_takes_as_long_from_robot_0_as_from_any_other() {
    let steps = |sources: &str| -> (f64, f64) {
        let text = format!(
            "Scenario(name: \"rumour\", time_limit: 60.0, arena: (size: (6.0, 6.0)), swarm: (robots: 50, deploy: Uniform),
             protocol: Rumor(mode: Push, sources: {sources}), gossip: (relay: (interval: 0.5)),
             radio: (range: 1.6), metrics: (sample_interval: 0.0))"
        );
        let scenario = parse("rumour.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
        let run = |trial| run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new());
        let completed = (0..120).filter_map(|trial| match run(trial).expect("the trial reaches its end").outcome {
            Outcome::Completed { step } => Some(step as f64),
            _ => None,
        });
        let steps: Vec<f64> = completed.collect();
        assert!(steps.len() > 100, "{sources}: {} swarms in one piece", steps.len());
        let count = steps.len() as f64;
        let mean = steps.iter().sum::<f64>() / count;
        let variance = steps.iter().map(|steps| (steps - mean).powi(2)).sum::<f64>() / (count - 1.0);
        (mean, variance / count)
    };
    let ((first, of_first), (any, of_any)) = (steps("Robots([0])"), steps("Random(1)"));
    assert!(
        (first - any).abs() < 4.0 * (of_first + of_any).sqrt(),
        "{first} from robot 0, {any} from any"
    );
}

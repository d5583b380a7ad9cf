use proptest::prelude::*;

use super::*;
use crate::quantity::{Finite, Positive};

const FREQUENCY: f64 = 2.44e9;

fn log_distance(exponent: f64, reference_loss: Option<f64>) -> PathLossConfig {
    PathLossConfig::LogDistance(LogDistanceConfig {
        exponent: Positive::new(exponent),
        reference_loss: reference_loss.map(Finite::new),
        ..LogDistanceConfig::default()
    })
}

fn two_ray(height: f64, ground: Option<f64>) -> PathLossConfig {
    PathLossConfig::TwoRay(TwoRayConfig {
        height: Positive::new(height),
        ground: ground.map(Positive::new),
    })
}

fn all() -> Vec<PathLossConfig> {
    vec![
        PathLossConfig::Friis,
        log_distance(3.0, None),
        log_distance(2.4, Some(55.0)),
        PathLossConfig::BreakPoint(BreakPointConfig::default()),
        two_ray(0.1, None),
        two_ray(0.5, None),
        two_ray(0.1, Some(15.0)),
        two_ray(0.5, Some(15.0)),
        two_ray(1.5, Some(4.0)),
    ]
}

#[track_caller]
fn assert_losses(config: &PathLossConfig, frequency: f64, distances: &[f64], expected: &[f64]) {
    let loss = PathLoss::new(config, frequency);
    for (&distance, &expected) in distances.iter().zip(expected) {
        let found = loss.loss_db(distance);
        let error = (found - expected).abs();
        assert!(error < 1e-6, "{config:?}, {distance} m: {found}, not {expected}");
    }
}

#[test]
fn losses_are_those_of_an_independent_program() {
    let distances = [0.1, 1.0, 10.0, 250.0];
    for (frequency, expected) in [
        (2.405e9, [20.070084836, 40.070084836, 60.070084836, 88.028885010]),
        (2.44e9, [20.195579749, 40.195579749, 60.195579749, 88.154379922]),
        (868e6, [11.218177725, 31.218177725, 51.218177725, 79.176977899]),
        (5.15e9, [26.683927803, 46.683927803, 66.683927803, 94.642727976]),
    ] {
        assert_losses(&PathLossConfig::Friis, frequency, &distances, &expected);
    }
    let steep = [10.195579749, 40.195579749, 61.164679879, 100.195579749];
    assert_losses(&log_distance(3.0, None), FREQUENCY, &[0.1, 1.0, 5.0, 100.0], &steep);
    let known = [55.0, 71.775280104, 103.0];
    assert_losses(&log_distance(2.4, Some(55.0)), FREQUENCY, &[1.0, 5.0, 100.0], &known);

    let distances = [0.3, 1.0, 2.0, 5.0, 50.0, 300.0];
    let low = [
        29.738004843,
        40.195579749,
        52.041199827,
        67.958800173,
        107.958800173,
        139.084850189,
    ];
    assert_losses(&two_ray(0.1, None), FREQUENCY, &distances, &low);
    let high = [
        29.738004843,
        40.195579749,
        46.216179662,
        54.174979835,
        80.0,
        111.126050015,
    ];
    assert_losses(&two_ray(0.5, None), FREQUENCY, &distances, &high);
}

#[test]
fn the_exact_sum_of_two_rays_is_that_of_an_independent_program() {
    let distances = [0.05, 0.3, 1.0, 2.0, 5.0, 20.0, 50.0, 300.0, 5000.0];
    for (height, ground, expected) in [
        (
            0.1,
            15.0,
            [
                14.249991732,
                32.980110518,
                40.706890567,
                49.817070082,
                63.892022628,
                86.993148499,
                102.707406488,
                133.719293534,
                182.571682063,
            ],
        ),
        (
            0.5,
            15.0,
            [
                14.183776045,
                28.471616262,
                42.061390368,
                44.441023206,
                54.477591184,
                65.969823714,
                80.374975877,
                110.837019639,
                159.599643134,
            ],
        ),
        (
            1.5,
            4.0,
            [
                14.127039128,
                29.504598589,
                40.913658295,
                45.100196589,
                54.122067710,
                67.097478580,
                71.761583086,
                92.439691910,
                140.912231465,
            ],
        ),
    ] {
        assert_losses(&two_ray(height, Some(ground)), FREQUENCY, &distances, &expected);
    }
}

/// IEEE 802.15.4, Annex E: 40.2 + 20 log₁₀ d up to 8 m; beyond it 58.5 + 33 log₁₀(d/8), where a line without a step has 40.2 + 18.06 = 58.26.
#[test]
fn by_default_a_break_point_is_that_of_802154() {
    let expected = [40.195579749, 58.257379489, 58.257379489 + 33.0];
    assert_losses(
        &PathLossConfig::BreakPoint(BreakPointConfig::default()),
        FREQUENCY,
        &[1.0, 8.0, 80.0],
        &expected,
    );
    let other = PathLossConfig::BreakPoint(BreakPointConfig {
        exponent: Positive::new(2.5),
        distance: Positive::new(20.0),
        exponent_beyond: Positive::new(4.0),
        reference_distance: Positive::new(2.0),
        reference_loss: Some(Finite::new(50.0)),
    });
    assert_losses(&other, FREQUENCY, &[2.0, 20.0, 200.0], &[50.0, 75.0, 115.0]);
}

#[test]
fn nobody_receives_more_than_was_sent_however_near() {
    for config in all() {
        let loss = PathLoss::new(&config, FREQUENCY);
        for distance in [0.0, 1e-12, 1e-3, 0.005] {
            assert!(
                loss.loss_db(distance) == 0.0 || distance > 1e-3,
                "{config:?}, {distance} m"
            );
            assert!(loss.loss_db(distance).is_finite());
        }
        assert!(loss.loss_db(1e9).is_finite());
        assert!(loss.distance_at(-0.1) == 0.0 && loss.distance_at(f64::INFINITY).is_infinite());
    }
}

/// Interference: at 1.5 m above the ground the sum rises and falls up to tens of metres.
#[test]
fn over_a_reflecting_ground_the_farthest_of_all_distances_counts() {
    let loss = PathLoss::new(&two_ray(1.5, Some(4.0)), FREQUENCY);
    for limit in [40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 67.0, 70.0] {
        let farthest = (1..200_000)
            .rev()
            .map(|step| f64::from(step) * 1e-3)
            .find(|&distance| loss.loss_db(distance) <= limit);
        let found = loss.distance_at(limit);
        let expected = farthest.expect("some distance is near enough");
        assert!((found - expected).abs() < 2e-3, "{limit} dB: {found}, not {expected}");
    }
    let falls = (10..400).filter(|&step| loss.loss_db(0.1 * f64::from(step + 1)) < loss.loss_db(0.1 * f64::from(step)));
    assert!(falls.count() > 50, "a sum that only rises would be no test");
}

#[test]
fn ground_that_reflects_nothing_is_refused() {
    let problems = two_ray(0.1, Some(1.0)).problems();
    assert_eq!(problems.len(), 1);
    assert!(problems[0].0 == "ground" && problems[0].1.contains("expected above 1"));
    for config in all() {
        assert_eq!(config.problems(), []);
    }
}

proptest! {
    #[test]
    fn a_distance_is_the_largest_with_so_little_loss(config in prop::sample::select(all()), loss in 0.0..150.0_f64) {
        let model = PathLoss::new(&config, FREQUENCY);
        let distance = model.distance_at(loss);
        prop_assert!(model.loss_db(distance) <= loss + 1e-9);
        for farther in [1.0 + 1e-6, 1.01, 1.5, 3.0, 100.0] {
            prop_assert!(model.loss_db(distance * farther) > loss, "{} × {farther}", distance);
        }
    }

    #[test]
    fn straight_lines_never_fall(config in prop::sample::select(all()[..6].to_vec()), near in 1e-3..1e3_f64, more in 1.0..10.0_f64) {
        let model = PathLoss::new(&config, FREQUENCY);
        prop_assert!(model.loss_db(near * more) >= model.loss_db(near) - 1e-9);
    }
}

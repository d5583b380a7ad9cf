use desim::geometry::{Vec2, unit};
use desim::radio::propagation::{Shadowing, ShadowingConfig};

use super::super::statistics::{assert_near, correlation, mean, variance};
use super::super::{non_negative, positive};
use super::{in_fields, streams};

const SIGMA: f64 = 4.0;
const DECORRELATION: f64 = 5.0;
const FIELDS: u32 = 20_000;

fn shadowing(field: u32) -> Shadowing {
    Shadowing::new(&config(), &streams(field))
}

fn config() -> ShadowingConfig {
    ShadowingConfig {
        sigma: non_negative(SIGMA),
        decorrelation: positive(DECORRELATION),
    }
}

/// Losses between `a` and `b` in many fields.
fn losses(a: Vec2, b: Vec2) -> Vec<f64> {
    in_fields(FIELDS, |streams| Shadowing::new(&config(), streams).db(a, b))
}

/// A sample variance of n normal values has a standard error of σ²√(2/n); a mean one of σ/√n.
#[test]
fn the_variance_is_that_of_the_settings_also_where_the_ends_are_near_each_other() {
    let n = f64::from(FIELDS);
    for distance in [0.0, 0.5, 2.0, 5.0, 50.0] {
        let a = Vec2::new(-3.0, 7.0);
        let losses = losses(a, a + unit(1.1) * distance);
        let what = format!("at {distance} m");
        assert_near(&format!("mean {what}"), mean(&losses), 0.0, SIGMA / n.sqrt());
        let error = SIGMA * SIGMA * (2.0 / n).sqrt();
        assert_near(&format!("variance {what}"), variance(&losses), SIGMA * SIGMA, error);
    }
}

/// Of a normal law 15.87 % are above σ and 5 % above 1.645 σ. 32 waves have a kurtosis of 3 − 1.5/32, which moves these by 0.05 % and 0.02 %, a fifth and a tenth of their standard errors.
#[test]
fn losses_are_normal() {
    let losses = losses(Vec2::new(10.0, 0.0), Vec2::new(0.0, 3.0));
    for (limit, share) in [(1.0, 0.158655), (1.644854, 0.05), (-1.0, 0.841345), (-1.644854, 0.95)] {
        let above = losses.iter().filter(|&&loss| loss > limit * SIGMA).count() as f64;
        let n = f64::from(FIELDS);
        let error = (share * (1.0 - share) / n).sqrt();
        assert_near(&format!("above {limit} σ"), above / n, share, error);
    }
}

/// exp(−(Δa + Δb)/decorrelation). Of n pairs of normal values whose correlation is ρ, the sample correlation has a standard error of (1 − ρ²)/√n.
#[test]
fn the_correlation_falls_exponentially_over_the_sum_of_both_ways() {
    const FIELDS: u32 = 80_000;
    const MOVED: [[f64; 2]; 7] = [
        [1.0, 0.0],
        [0.0, 1.0],
        [5.0, 0.0],
        [2.0, 3.0],
        [5.0, 5.0],
        [20.0, 0.0],
        [0.05, 0.05],
    ];
    let (a, b) = (Vec2::new(4.0, 4.0), Vec2::new(12.0, -1.0));
    let mut here = Vec::new();
    let mut there: [Vec<f64>; MOVED.len()] = Default::default();
    for field in 0..FIELDS {
        let shadowing = shadowing(field);
        here.push(shadowing.db(a, b));
        for (losses, [first, second]) in there.iter_mut().zip(MOVED) {
            // In no direction in particular.
            losses.push(shadowing.db(a + unit(first) * first, b + unit(2.5 * second) * second));
        }
    }
    for (losses, [first, second]) in there.iter().zip(MOVED) {
        let expected = (-(first + second) / DECORRELATION).exp();
        let error = (1.0 - expected * expected) / f64::from(FIELDS).sqrt();
        let what = format!("moved by {first} and {second} m");
        assert_near(&what, correlation(&here, losses), expected, error);
    }
}

/// Named in the other order, the ends have another loss: the caller names the lower number first. The mean of both would have a variance of (1 + exp(−2d/decorrelation))/2 σ², which at 0.5 m
/// is nearly that of one: so both are nearly the same there.
#[test]
fn the_order_of_the_ends_decides() {
    let (a, b) = (Vec2::new(0.0, 0.0), Vec2::new(0.5, 0.0));
    let [there, back] = [losses(a, b), losses(b, a)];
    let expected = (-2.0 * 0.5 / DECORRELATION).exp();
    let error = (1.0 - expected * expected) / f64::from(FIELDS).sqrt();
    assert_near("there and back", correlation(&there, &back), expected, error);
    assert!(
        there
            .iter()
            .zip(&back)
            .all(|(there, back)| there.to_bits() != back.to_bits())
    );
}

#[test]
fn a_loss_is_a_function_of_trial_and_places() {
    let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(-3.0, 4.0));
    let of = |field| shadowing(field).db(a, b).to_bits();
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
    let none = ShadowingConfig {
        sigma: non_negative(0.0),
        ..config()
    };
    assert!(Shadowing::new(&none, &streams(1)).db(a, b) == 0.0);
}

/// Twice as wide a field over twice as long ways is the same field.
#[test]
fn lengths_count_in_decorrelations() {
    let wide = ShadowingConfig {
        decorrelation: positive(2.0 * DECORRELATION),
        ..config()
    };
    let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(-3000.0, 4.0));
    let [narrow, wide] = [
        shadowing(3).db(a, b),
        Shadowing::new(&wide, &streams(3)).db(a * 2.0, b * 2.0),
    ];
    assert_eq!(narrow.to_bits(), wide.to_bits());
}

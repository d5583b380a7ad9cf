use std::f64::consts::{PI, TAU};

use desim::engine::Streams;
use desim::geometry::{Vec2, unit};
use desim::radio::propagation::{Fading, FadingConfig};
use statrs::function::gamma::gamma;

use super::super::statistics::{assert_near, correlation};
use super::super::{non_negative, positive};
use super::{assert_mean, in_fields, streams};

const FREQUENCY: f64 = 2.44e9;
const WAVELENGTH: f64 = 299_792_458.0 / FREQUENCY;

fn rayleigh() -> FadingConfig {
    FadingConfig::Rayleigh {
        doppler: non_negative(0.0),
    }
}

fn rician(k: f64) -> FadingConfig {
    FadingConfig::Rician {
        k: non_negative(k),
        doppler: non_negative(0.0),
    }
}

fn nakagami(m: f64) -> FadingConfig {
    FadingConfig::Nakagami {
        m: positive(m),
        doppler: non_negative(0.0),
    }
}

fn laws() -> [FadingConfig; 9] {
    [
        rayleigh(),
        rician(1.0),
        rician(4.0),
        rician(10.0),
        nakagami(0.5),
        nakagami(1.3),
        nakagami(1.5),
        nakagami(3.0),
        nakagami(20.0),
    ]
}

/// Gains between `a` and `b` in so many fields.
fn gains(config: &FadingConfig, fields: u32, a: Vec2, b: Vec2) -> Vec<f64> {
    in_fields(fields, |streams| {
        Fading::new(config, streams, FREQUENCY).gain(a, b, 0.0)
    })
}

/// A share p of n fields has a standard error of √(p(1 − p)/n). That gains are sums of 32 waves and not of endless many makes outages wrong by at most exp(−x)(1 − x/2)x/64, 0.4 % of one at most, and is within one standard error.
#[test]
fn gains_have_a_mean_of_1_and_the_outages_of_their_law() {
    let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(40.0, -9.0));
    for config in laws() {
        // Laying one law onto another takes half a millisecond a field.
        let is_laid = [nakagami(1.3), nakagami(20.0)].contains(&config);
        let fields = if is_laid { 1000 } else { 6000 };
        let gains = gains(&config, fields, a, b);
        assert_mean(&format!("mean gain of {config:?}"), &gains, 1.0);
        for limit in [0.1, 0.3, 1.0, 2.0] {
            let expected = config.outage(limit);
            let n = f64::from(fields);
            let below = gains.iter().filter(|&&gain| gain < limit).count() as f64 / n;
            // One field more or less where hardly any is expected.
            let error = (expected * (1.0 - expected) / n).sqrt().max(0.5 / n);
            assert_near(&format!("{config:?} below {limit}"), below, expected, error);
        }
    }
}

/// Downward crossings of ρ (amplitude over its root mean square) a second and the time spent below, while the ends drive at `speeds` wavelengths a second: one measurement a field.
fn fades(config: &FadingConfig, streams: Streams, speeds: [f64; 2], rho: f64) -> [f64; 2] {
    const STEP: f64 = 4e-4;
    const STEPS: u32 = 2500;
    let fading = Fading::new(config, &streams, FREQUENCY);
    // Each field has them drive in other directions.
    let turn = streams
        .keyed(desim::engine::Purpose::new("test.turn"))
        .at(0, 0, 0)
        .next_u64() as f64;
    let ways = [turn.sin() * PI, turn.cos() * PI].map(unit);
    let (mut crossings, mut below_for) = (0.0, 0.0);
    let mut was_below = None;
    for step in 0..STEPS {
        let seconds = f64::from(step) * STEP;
        let [a, b] = [0, 1].map(|end| ways[end] * (speeds[end] * seconds * WAVELENGTH));
        let below = fading.gain(a, b + Vec2::new(9.0, 3.0), 0.0) < rho * rho;
        if below {
            below_for += STEP;
        }
        if below && was_below == Some(false) {
            crossings += 1.0;
        }
        was_below = Some(below);
    }
    let lasted = f64::from(STEPS) * STEP;
    [crossings / lasted, below_for / lasted]
}

/// Modified Bessel function I0 by its series.
fn i0(x: f64) -> f64 {
    let mut term = 1.0;
    (1..200).fold(1.0, |sum, n| {
        term *= (x / 2.0 / f64::from(n)).powi(2);
        sum + term
    })
}

/// Rayleigh: √(2π) f ρ exp(−ρ²); Rician with a direct way that has no Doppler shift: √(2π(K + 1)) f ρ exp(−K − (K + 1)ρ²) I0(2ρ√(K(K + 1))); Nakagami: √(2π) f m^(m − ½) ρ^(2m − 1) exp(−mρ²)/Γ(m); f² = f₁² + f₂² where both ends
/// move (Akki and Haber). The mean fade is the outage over that rate. By the spread over 250 fields of a second each; steps of 0.4 ms miss the half percent of fades that is shorter.
#[test]
fn fades_come_as_often_and_last_as_long_as_theory_says() {
    const FIELDS: u32 = 250;
    let f = 20.0;
    for (config, speeds, rho) in [
        (rayleigh(), [20.0, 0.0], 0.3),
        (rayleigh(), [12.0, 16.0], 0.3),
        (rayleigh(), [12.0, 16.0], 1.0),
        (rician(4.0), [12.0, 16.0], 0.3),
        (rician(4.0), [0.0, 20.0], 1.0),
        (nakagami(2.0), [12.0, 16.0], 0.3),
        (nakagami(1.5), [16.0, 12.0], 0.5),
        (nakagami(0.5), [12.0, 16.0], 0.5),
    ] {
        let rate = match config {
            FadingConfig::Rician { k, .. } => {
                let k = k.get();
                (TAU * (k + 1.0)).sqrt()
                    * f
                    * rho
                    * (-k - (k + 1.0) * rho * rho).exp()
                    * i0(2.0 * rho * (k * (k + 1.0)).sqrt())
            }
            FadingConfig::Nakagami { m, .. } => {
                let m = m.get();
                TAU.sqrt() * f * m.powf(m - 0.5) * rho.powf(2.0 * m - 1.0) * (-m * rho * rho).exp() / gamma(m)
            }
            _ => TAU.sqrt() * f * rho * (-rho * rho).exp(),
        };
        let outage = config.outage(rho * rho);
        let measured: Vec<[f64; 2]> = (0..FIELDS)
            .map(|field| fades(&config, streams(field), speeds, rho))
            .collect();
        let [crossings, below] = [0, 1].map(|index| measured.iter().map(|pair| pair[index]).collect::<Vec<f64>>());
        let what = format!("{config:?}, {speeds:?}, {rho}");
        assert_mean(&format!("rate of {what}"), &crossings, rate);
        assert_mean(&format!("outage of {what}"), &below, outage);
        // The mean fade is the ratio of both means: what it leaves over in each field has a mean of 0.
        let left: Vec<f64> = measured
            .iter()
            .map(|[crossings, below]| below - crossings * outage / rate)
            .collect();
        assert_mean(&format!("mean fade of {what}"), &left, 0.0);
    }
}

/// Cov(gain, gain later) is that of the squares of normal fields: (J0 J0)². The sample correlation of n pairs has a standard error of at most 1/√n for gains, whose fourth moments are great, somewhat more: twice that.
#[test]
fn gains_forget_each_other_as_the_square_of_a_bessel_function() {
    const FIELDS: u32 = 8000;
    let (a, b) = (Vec2::new(-3.0, 2.0), Vec2::new(5.0, 5.0));
    for config in [rayleigh(), nakagami(3.0)] {
        let here = gains(&config, FIELDS, a, b);
        for [first, second] in [[0.1, 0.0], [0.1, 0.1], [0.38, 0.0], [0.6, 0.6], [0.0, 2.0]] {
            let moved = |place: Vec2, far: f64, angle: f64| place + unit(angle) * (far * WAVELENGTH);
            let there = gains(&config, FIELDS, moved(a, first, 0.3), moved(b, second, 2.0));
            let expected = (libm::j0(TAU * first) * libm::j0(TAU * second)).powi(2);
            let error = 2.0 * (1.0 - expected * expected) / f64::from(FIELDS).sqrt();
            let what = format!("{config:?} moved by {first} and {second} wavelengths");
            assert_near(&what, correlation(&here, &there), expected, error);
        }
    }
}

#[test]
fn a_link_whose_ends_stand_keeps_its_gain_unless_its_surroundings_move() {
    let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(4.0, -3.0));
    for config in laws() {
        let fading = Fading::new(&config, &streams(1), FREQUENCY);
        let [now, later] = [0.0, 1e6].map(|seconds| fading.gain(a, b, seconds).to_bits());
        assert_eq!(now, later, "{config:?}");
        assert_ne!(now, fading.gain(b, a, 0.0).to_bits(), "the order of the ends decides");
        let other = Fading::new(&config, &streams(2), FREQUENCY);
        assert_ne!(now, other.gain(a, b, 0.0).to_bits());
    }
    let windy = FadingConfig::Rayleigh {
        doppler: non_negative(2.0),
    };
    let fading = Fading::new(&windy, &streams(1), FREQUENCY);
    assert_ne!(fading.gain(a, b, 0.0).to_bits(), fading.gain(a, b, 0.1).to_bits());
    let none = Fading::new(&FadingConfig::None, &streams(1), FREQUENCY);
    assert!(none.gain(a, b, 0.0) >= 1.0 && none.gain(a, b, 0.0) <= 1.0);
}

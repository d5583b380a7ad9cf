use libm::j0;

use super::*;
use crate::quantity::{NonNegative, Positive};

fn rician(k: f64) -> FadingConfig {
    FadingConfig::Rician {
        k: NonNegative::new(k),
        doppler: NonNegative::new(0.0),
    }
}

fn nakagami(m: f64) -> FadingConfig {
    FadingConfig::Nakagami {
        m: Positive::new(m),
        doppler: NonNegative::new(0.0),
    }
}

fn rayleigh(doppler: f64) -> FadingConfig {
    FadingConfig::Rayleigh {
        doppler: NonNegative::new(doppler),
    }
}

enum Law {
    Rayleigh,
    Rician(f64),
    Nakagami(f64),
}

/// Chances of gains below 0.01, 0.1, 0.5, 1 and 2, by an independent program: a non-central chi-square law of two degrees, and gamma laws.
const OUTAGES: [(Law, [f64; 5]); 10] = [
    (
        Law::Rayleigh,
        [
            0.00995016625083,
            0.095162581964,
            0.393469340287,
            0.632120558829,
            0.864664716763,
        ],
    ),
    (
        Law::Rician(0.0),
        [
            0.00995016625083,
            0.095162581964,
            0.393469340287,
            0.632120558829,
            0.864664716763,
        ],
    ),
    (
        Law::Rician(0.5),
        [
            0.00906388537808,
            0.0876122537089,
            0.375764316032,
            0.62064365322,
            0.86769854964,
        ],
    ),
    (
        Law::Rician(4.0),
        [
            0.000984836084821,
            0.016301531529,
            0.212827909091,
            0.564927984149,
            0.933522232619,
        ],
    ),
    (
        Law::Rician(10.0),
        [
            7.79093715411e-06,
            0.000738704063491,
            0.0991485804348,
            0.543094964374,
            0.980746202064,
        ],
    ),
    (
        Law::Rician(100.0),
        [
            7.02269257139e-38,
            1.40370853959e-22,
            1.78214361766e-05,
            0.514055024539,
            0.999999998468,
        ],
    ),
    (
        Law::Nakagami(0.5),
        [
            0.0796556745541,
            0.248170365954,
            0.520499877813,
            0.682689492137,
            0.84270079295,
        ],
    ),
    (
        Law::Nakagami(0.7),
        [
            0.0340350620452,
            0.166247345076,
            0.459435129389,
            0.65658906026,
            0.850107202625,
        ],
    ),
    (
        Law::Nakagami(3.0),
        [
            4.39995493975e-06,
            0.00359949318309,
            0.191153169462,
            0.576809918873,
            0.938031195583,
        ],
    ),
    (
        Law::Nakagami(50.0),
        [
            1.78877651044e-80,
            2.18105921408e-32,
            6.95330524762e-06,
            0.518808315472,
            0.999999988215,
        ],
    ),
];

#[test]
fn outages_are_those_of_an_independent_program() {
    for (law, expected) in OUTAGES {
        let config = match law {
            Law::Rayleigh => rayleigh(0.0),
            Law::Rician(k) => rician(k),
            Law::Nakagami(m) => nakagami(m),
        };
        for (gain, expected) in [0.01, 0.1, 0.5, 1.0, 2.0].into_iter().zip(expected) {
            let found = config.outage(gain);
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-9, "{config:?} below {gain}: {found}, not {expected}");
        }
        assert!(config.outage(0.0) == 0.0 && config.outage(1e9) > 1.0 - 1e-12);
    }
    assert!(FadingConfig::None.outage(0.999) == 0.0 && FadingConfig::None.outage(1.001) >= 1.0);
    // The largest ratio: 0.8, 0.9, 1 and 1.1.
    let narrow = [1.21941246582e-06, 0.0111499548368, 0.504458731358, 0.985930036334];
    for (gain, expected) in [0.8, 0.9, 1.0, 1.1].into_iter().zip(narrow) {
        let error = rician(1000.0).outage(gain) / expected - 1.0;
        assert!(error.abs() < 1e-8, "below {gain}: {error}");
    }
}

/// E(gain^(2/n)), by which a mean degree grows where loss goes as distance to the n: Γ(1 + 2/n); Γ(m + 2/n)/(Γ(m) m^(2/n)); Γ(1 + 2/n)(1 + K)^(−2/n) 1F1(−2/n; 1; −K).
#[test]
fn means_over_gains_are_their_closed_forms() {
    for (exponent, of_rayleigh, of_nakagami, of_rician) in [
        (2.0, 1.0, 1.0, 1.0),
        (2.5, 0.93138377098, 0.974613007339, 0.971116234028),
        (3.0, 0.902745292951, 0.964432600634, 0.95913322765),
        (4.0, 0.886226925453, 0.9593687887, 0.952632788324),
    ] {
        for (config, expected) in [
            (rayleigh(0.0), of_rayleigh),
            (nakagami(3.0), of_nakagami),
            (rician(4.0), of_rician),
            (FadingConfig::None, 1.0),
        ] {
            let found = config.mean_of(|gain| libm::pow(gain, 2.0 / exponent));
            assert!(
                (found - expected).abs() < 1e-9,
                "{config:?}, {exponent}: {found}, not {expected}"
            );
        }
    }
    for config in [rician(1000.0), nakagami(0.5), nakagami(100.0), nakagami(1.3)] {
        assert!((config.mean_of(|gain| gain) - 1.0).abs() < 1e-9, "{config:?}");
    }
}

/// The share of 802.15.4 frames of 31 bytes lost at a mean ratio of 0, 5 and 10 dB, by adaptive quadrature.
#[test]
fn the_mean_loss_of_frames_is_that_of_an_independent_program() {
    let modulation = crate::radio::Modulation::OQpsk;
    for (config, expected) in [
        (rayleigh(0.0), [0.518180045936, 0.207692905183, 0.0711591592272]),
        (rician(4.0), [0.382637667894, 0.0620424054594, 0.0107804196719]),
        (rician(10.0), [0.293152084248, 0.0102813856199, 0.000364153200748]),
        (nakagami(0.5), [0.60672761607, 0.369514087153, 0.213368044921]),
        (nakagami(3.0), [0.379109516925, 0.0361280358768, 0.00167735833913]),
    ] {
        for (db, expected) in [0.0, 5.0, 10.0].into_iter().zip(expected) {
            let ratio = libm::pow(10.0, db / 10.0);
            let found = config.mean_of(|gain| 1.0 - modulation.success(gain * ratio, 296));
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-7, "{config:?}, {db} dB: {found}, not {expected}");
        }
    }
}

#[test]
fn a_sharp_limit_has_its_outage_as_mean_to_half_a_step() {
    for config in [rayleigh(0.0), rician(4.0), nakagami(3.0)] {
        for limit in [0.1, 0.5, 1.0] {
            let found = config.mean_of(|gain| f64::from(u8::from(gain < limit)));
            assert!(
                (found - config.outage(limit)).abs() < 5e-3,
                "{config:?} {limit}: {found}"
            );
        }
    }
}

/// E(h(0) h*(τ)) = J0(2πf₁τ) J0(2πf₂τ), and J0 once more for a moving background. Over n independent fields the mean of Re h(0)h*(τ) has a variance of at most 1/n.
#[test]
fn the_autocorrelation_is_a_bessel_function_of_each_end_and_of_the_background() {
    const FIELDS: u32 = 4000;
    let wavelength = LIGHT / 2.44e9;
    let (here, there) = (Vec2::new(3.0, 1.0), Vec2::new(700.0, -20.0));
    let doppler = 3.0;
    // Both ends move in any direction; how far in wavelengths, and for how long the background moves.
    for [first, second, background] in [
        [0.3, 0.0, 0.0],
        [0.0, 0.6, 0.0],
        [0.2, 0.25, 0.0],
        [0.6, 0.6, 0.0],
        [0.0, 0.0, 0.7],
        [0.1, 0.2, 0.3],
    ] {
        let [moved, moved_too] = [(here, first, 0.6), (there, second, 4.0)]
            .map(|(place, far, angle)| place + crate::geometry::unit(angle) * far * wavelength);
        let products: Vec<f64> = (0..FIELDS)
            .map(|seed| {
                let streams = Streams::new(u64::from(seed), 7);
                let draws = [FADING, DRIFT].map(|purpose| streams.keyed(purpose));
                let field = Field::new(draws, 0, wavelength, doppler);
                let [a, b] = field.at(here, there, Some(10.0));
                let [c, d] = field.at(moved, moved_too, Some(10.0 + background / doppler));
                (a * c + b * d) / WAVES as f64
            })
            .collect();
        let found = products.iter().sum::<f64>() / f64::from(FIELDS);
        let expected: f64 = [first, second, background]
            .map(|turns| j0(TAU * turns))
            .iter()
            .product();
        let four_errors = 4.0 / f64::from(FIELDS).sqrt();
        assert!(
            (found - expected).abs() < four_errors,
            "{first}, {second}, {background}: {found}, not {expected}"
        );
    }
}

#[test]
fn a_reshaped_gain_has_the_same_chance_of_less() {
    use crate::radio::propagation::gamma::below_and_above;
    for (from, to) in [(0.5, 0.7), (1.5, 1.3), (4.0, 5.5), (4.0, 100.0), (1.0, 0.8)] {
        let reshaping = Reshaping::new(from, to);
        let mut before = 0.0;
        for step in 0..400 {
            let gain = libm::exp2(f64::from(step) * 0.1 - 34.0);
            let found = reshaping.gain(gain);
            assert!(found >= before, "{from} to {to} at {gain}");
            before = found;
            let [[below, above], [found_below, found_above]] =
                [below_and_above(from, from * gain), below_and_above(to, to * found)];
            // By 5e-4 in the gain, whose power the lesser chances are, and whose exponential the greater.
            let tolerance = 1e-3 * (1.0 + to) * (1.0 + found);
            let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < tolerance;
            let agrees = if below < 0.5 {
                near(found_below, below)
            } else {
                near(found_above, above)
            };
            assert!(agrees, "{from} to {to} at {gain}: {found}");
        }
    }
}

#[test]
fn what_is_out_of_range_is_refused() {
    for (config, field, part) in [
        (rician(1001.0), "k", "expected 0 to 1000"),
        (nakagami(0.49), "m", "expected 0.5 to 100"),
        (nakagami(101.0), "m", "expected 0.5 to 100"),
    ] {
        let problems = config.problems();
        assert_eq!(problems.len(), 1);
        assert!(problems[0].0 == field && problems[0].1.contains(part), "{problems:?}");
    }
    for config in [
        FadingConfig::None,
        rayleigh(80.0),
        rician(1000.0),
        nakagami(0.5),
        nakagami(100.0),
    ] {
        assert_eq!(config.problems(), []);
    }
}

#[test]
fn fading_is_a_few_words_in_a_scenario() {
    let read = |text| ron::from_str::<FadingConfig>(text);
    assert_eq!(read("None"), Ok(FadingConfig::None));
    assert_eq!(read("Rayleigh()"), Ok(rayleigh(0.0)));
    assert_eq!(read("Rayleigh(doppler: 2.0)"), Ok(rayleigh(2.0)));
    assert_eq!(read("Rician(k: 4.0)"), Ok(rician(4.0)));
    assert_eq!(read("Nakagami(m: 3.0, doppler: 0.0)"), Ok(nakagami(3.0)));
    assert!(read("Rician()").is_err() && read("Rayleigh(k: 1.0)").is_err());
}

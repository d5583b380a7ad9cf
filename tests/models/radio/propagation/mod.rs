//! Shadowing and fading against the laws that they are made to follow.
//!
//! One field is one draw of many waves, and its values at different places hang together. So what is measured is measured in many fields that are independent of each other, and its standard error is that of their
//! mean: of the closed form's variance where that is known, else of the fields' own spread.

mod degree;
mod fading;
mod shadowing;

use desim::engine::Streams;
use desim::geometry::Vec2;
use desim::radio::propagation::{Fading, FadingConfig, PathLoss, PathLossConfig, Shadowing, ShadowingConfig};
use desim::radio::{ErrorTable, Modulation};

use super::statistics::{assert_near, mean, variance};
use super::{non_negative, positive};

/// The streams of field number `field`.
fn streams(field: u32) -> Streams {
    Streams::new(20_260_101, field)
}

/// What `measure` gives in each of so many fields.
fn in_fields(fields: u32, measure: impl Fn(&Streams) -> f64) -> Vec<f64> {
    (0..fields).map(|field| measure(&streams(field))).collect()
}

/// Asserts that the mean of what was measured in independent fields is as `expected`, by their own spread.
#[track_caller]
fn assert_mean(what: &str, measured: &[f64], expected: f64) {
    let standard_error = (variance(measured) / measured.len() as f64).sqrt();
    assert_near(what, mean(measured), expected, standard_error);
}

#[test]
fn values_are_pinned_to_the_bit_so_that_published_results_stay_reproducible_on_any_machine() {
    let streams = Streams::new(1, 0);
    let (a, b) = (Vec2::new(1.0, 2.0), Vec2::new(-30.0, 4.5));
    let doppler = non_negative(2.0);
    let gains = [
        FadingConfig::Rayleigh { doppler },
        FadingConfig::Rician {
            k: non_negative(4.0),
            doppler,
        },
        FadingConfig::Nakagami {
            m: positive(1.3),
            doppler,
        },
    ]
    .map(|config| Fading::new(&config, &streams, 2.44e9).gain(a, b, 12.5).to_bits());
    assert_eq!(
        gains,
        [0x3fe2_e978_d45b_9020, 0x3fe0_5189_3269_6e12, 0x3fe9_1e2d_35d0_dd70]
    );
    let shadowing = Shadowing::new(&ShadowingConfig::default(), &streams).db(a, b);
    assert_eq!(shadowing.to_bits(), 0x4012_d266_4000_0000);
    let loss = PathLoss::new(&PathLossConfig::default(), 2.44e9).loss_db(7.0);
    assert_eq!(loss.to_bits(), 0x4050_631a_f79c_5f9b);
    let survival = ErrorTable::new(Modulation::OQpsk).log_survival(1.0);
    assert_eq!(survival.to_bits(), 0xb929_62ff);
}

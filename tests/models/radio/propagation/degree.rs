use desim::engine::{Purpose, Streams};
use desim::geometry::{Vec2, unit};
use desim::radio::propagation::{
    Fading, FadingConfig, LogDistanceConfig, PathLoss, PathLossConfig, Shadowing, ShadowingConfig,
};

use super::super::{non_negative, positive};
use super::{assert_mean, in_fields};

const FREQUENCY: f64 = 2.44e9;
/// Loss that a link may have at most, dB.
const LIMIT: f64 = 80.0;
/// Robots are looked for up to so many times the range of path loss alone. With n = 3 that leaves out who has a gain of 18 dB or more.
const REACH: f64 = 4.0;
/// Places that are looked at in each field.
const PLACES: u32 = 50;

/// Who is within reach by path loss of exponent 3, shadowing of `sigma` dB and `fading`, relative to path loss alone: the share of places on a disc from which a link holds, times the disc's area, in many fields.
fn degrees(sigma: f64, fading: FadingConfig) -> Vec<f64> {
    let path = PathLoss::new(&PathLossConfig::LogDistance(LogDistanceConfig::default()), FREQUENCY);
    let range = path.distance_at(LIMIT);
    let config = ShadowingConfig {
        sigma: non_negative(sigma),
        decorrelation: positive(range / 10.0),
    };
    in_fields(2000, |streams: &Streams| {
        let shadowing = Shadowing::new(&config, streams);
        let fading = Fading::new(&fading, streams, FREQUENCY);
        let mut random = streams.keyed(Purpose::new("test.places")).at(0, 0, 0);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let mut within = 0.0;
        for place in 0..PLACES {
            // Rings of one area each, one place in each ring.
            let share = (f64::from(place) + uniform()) / f64::from(PLACES);
            let distance = range * REACH * share.sqrt();
            let here = Vec2::new(uniform(), uniform()) * 1000.0;
            let there = here + unit(uniform() * std::f64::consts::TAU) * distance;
            let loss =
                path.loss_db(distance) + shadowing.db(here, there) - 10.0 * fading.gain(here, there, 0.0).log10();
            if loss <= LIMIT {
                within += 1.0;
            }
        }
        within / f64::from(PLACES) * REACH * REACH
    })
}

/// exp(2(σ ln 10/10n)²) for shadowing, E(gain^(2/n)) for fading, and their product for both.
#[test]
fn the_mean_degree_grows_or_shrinks_by_its_closed_forms() {
    let still = non_negative(0.0);
    let none = FadingConfig::None;
    let rayleigh = FadingConfig::Rayleigh { doppler: still };
    let rician = FadingConfig::Rician {
        k: non_negative(4.0),
        doppler: still,
    };
    let nakagami = FadingConfig::Nakagami {
        m: positive(3.0),
        doppler: still,
    };
    for (sigma, fading, expected) in [
        (0.0, none, 1.0),
        (4.0, none, 1.207451),
        (0.0, rayleigh, 0.902745),
        (0.0, rician, 0.959133),
        (0.0, nakagami, 0.964433),
        (4.0, rayleigh, 1.207451 * 0.902745),
    ] {
        assert_mean(&format!("{sigma} dB and {fading:?}"), &degrees(sigma, fading), expected);
    }
}

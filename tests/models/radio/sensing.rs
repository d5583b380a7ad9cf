//! Situated communication's noise.
//!
//! Of n normal errors the mean has the standard error σ/√n and the standard deviation σ/√(2n). Displacements are kept
//! in single precision, an error of 1e-7 that is far below either.

use desim::geometry::wrap_angle;
use desim::quantity::NonNegative;
use desim::radio::{Fate, LossConfig, SensingConfig};
use statrs::distribution::{ContinuousCDF, Normal};

use super::statistics::{assert_near, correlation, kolmogorov_limit, kolmogorov_smirnov, mean, variance};
use super::{fates, losing};

/// Sensed range and bearing of a sender at 1 m along the x axis, of 40,000 frames.
fn sensed(range_noise: f64, bearing_noise_degrees: f64) -> (Vec<f64>, Vec<f64>) {
    let mut config = losing(LossConfig::None);
    config.sensing = SensingConfig {
        range_noise: NonNegative::new(range_noise),
        bearing_noise: NonNegative::new(bearing_noise_degrees),
    };
    let polar = |fate: Fate| match fate {
        Fate::Arrives {
            displacement: [x, y], ..
        } => (f64::from(x.hypot(y)), f64::from(y.atan2(x))),
        Fate::Lost(_) | Fate::Open => (f64::NAN, f64::NAN),
    };
    fates(&config, 20, 2000).concat().into_iter().map(polar).unzip()
}

fn assert_normal(what: &str, sample: &[f64], centre: f64, std_dev: f64) {
    let n = sample.len() as f64;
    assert_near(what, mean(sample), centre, std_dev / n.sqrt());
    assert_near(what, variance(sample).sqrt(), std_dev, std_dev / (2.0 * n).sqrt());
    let law = Normal::new(centre, std_dev).unwrap();
    let distance = kolmogorov_smirnov(sample, |x| law.cdf(x));
    assert!(distance < kolmogorov_limit(), "{what}: D√n = {distance}");
}

#[test]
fn range_errors_are_a_share_of_the_range_and_bearing_errors_an_angle_each_normal_and_on_its_own() {
    let (ranges, bearings) = sensed(0.1, 10.0);
    assert_normal("range", &ranges, 1.0, 0.1);
    assert_normal("bearing", &bearings, 0.0, 10.0_f64.to_radians());
    let error = 1.0 / (ranges.len() as f64).sqrt();
    assert_near("range with bearing", correlation(&ranges, &bearings), 0.0, error);
}

#[test]
fn either_noise_leaves_the_other_coordinate_alone() {
    let (ranges, _) = sensed(0.0, 10.0);
    assert!(ranges.iter().all(|range| (range - 1.0).abs() < 1e-6));
    let (_, bearings) = sensed(0.1, 0.0);
    assert!(bearings.iter().all(|bearing| wrap_angle(*bearing).abs() < 1e-6));
}

#[test]
fn without_noise_the_sender_is_sensed_where_it_is() {
    let (ranges, bearings) = sensed(0.0, 0.0);
    assert!(ranges.iter().all(|range| range.to_bits() == 1.0_f64.to_bits()));
    assert!(bearings.iter().all(|bearing| *bearing == 0.0));
}

//! Latency models.
//!
//! Whole distributions are held against Kolmogorov–Smirnov, means against σ/√n with the σ of the closed form. Arrival
//! times are whole nanoseconds, which moves a distribution function by at most its density times 0.5 ns, below 1e-5
//! here, where the Kolmogorov–Smirnov distance may reach 0.016.

use desim::radio::{Fate, LatencyConfig, LossConfig, Medium};
use statrs::distribution::{Continuous, ContinuousCDF, Exp, Gamma, LogNormal, Normal, Uniform};
use statrs::statistics::Distribution;

use super::statistics::{assert_near, correlation, kolmogorov_limit, kolmogorov_smirnov, mean};
use super::{fates, losing, medium, non_negative, positive, sent};

const RECEIVERS: u32 = 10;
const FRAMES: u32 = 2000;

/// Latencies of every copy, by receiver and frame, in seconds.
fn latencies(config: &LatencyConfig) -> Vec<Vec<f64>> {
    let mut radio = losing(LossConfig::None);
    radio.latency = config.clone();
    let of_link = |link: Vec<Fate>| (0..).zip(link).map(|(frame, fate)| latency(frame, fate)).collect();
    fates(&radio, RECEIVERS, FRAMES).into_iter().map(of_link).collect()
}

fn latency(frame: u32, fate: Fate) -> f64 {
    match fate {
        Fate::Arrives { at, .. } => at.since(sent(frame)).as_secs(),
        Fate::Lost(_) | Fate::Open => f64::INFINITY,
    }
}

/// Asserts that latencies under `config` have the distribution `cdf`, and the mean that `config` states with a
/// standard deviation of `std_dev`.
fn assert_law(config: &LatencyConfig, cdf: impl Fn(f64) -> f64, std_dev: f64) {
    let sample = latencies(config).concat();
    let distance = kolmogorov_smirnov(&sample, cdf);
    assert!(distance < kolmogorov_limit(), "{config:?}: D√n = {distance}");
    assert_near(
        "mean latency",
        mean(&sample),
        config.mean(),
        std_dev / (sample.len() as f64).sqrt(),
    );
}

fn normal(mean: f64, std_dev: f64, min: f64) -> LatencyConfig {
    LatencyConfig::Normal {
        mean: non_negative(mean),
        std_dev: non_negative(std_dev),
        min: non_negative(min),
    }
}

#[test]
fn each_latency_model_has_its_distribution() {
    let uniform = Uniform::new(0.01, 0.05).unwrap();
    let config = LatencyConfig::Uniform {
        min: non_negative(0.01),
        max: non_negative(0.05),
    };
    assert_law(&config, |x| uniform.cdf(x), uniform.std_dev().unwrap());

    let log_normal = LogNormal::new(0.02_f64.ln(), 0.5).unwrap();
    let config = LatencyConfig::LogNormal {
        median: positive(0.02),
        sigma: non_negative(0.5),
    };
    assert_law(&config, |x| log_normal.cdf(x), log_normal.std_dev().unwrap());

    for shape in [0.5, 1.0, 3.0] {
        let gamma = Gamma::new(shape, 1.0 / 0.01).unwrap();
        let config = LatencyConfig::Gamma {
            shape: positive(shape),
            scale: positive(0.01),
        };
        assert_law(&config, |x| gamma.cdf(x), gamma.std_dev().unwrap());
    }

    let exponential = Exp::new(1.0 / 0.03).unwrap();
    let config = LatencyConfig::Exponential { mean: positive(0.03) };
    assert_law(&config, |x| exponential.cdf(x), 0.03);
}

/// Cut off below `a` (in standard deviations from the mean), a normal distribution has F(x) = (Φ(x) − Φ(a)) / Z with
/// Z = 1 − Φ(a), and the variance σ² (1 + aφ(a)/Z − (φ(a)/Z)²).
#[test]
fn a_truncated_normal_latency_is_the_conditional_distribution_and_not_the_clipped_one() {
    for (mu, sigma, min) in [(0.01, 0.003, 0.001), (0.01, 0.01, 0.005), (0.01, 0.02, 0.01)] {
        let (plain, standard) = (Normal::new(mu, sigma).unwrap(), Normal::standard());
        let a = (min - mu) / sigma;
        let kept = standard.sf(a);
        let hazard = standard.pdf(a) / kept;
        let cdf = |x: f64| ((plain.cdf(x) - plain.cdf(min)) / kept).max(0.0);
        let std_dev = sigma * (1.0 + a * hazard - hazard * hazard).sqrt();
        assert_law(&normal(mu, sigma, min), cdf, std_dev);
        assert!((normal(mu, sigma, min).mean() - (mu + sigma * hazard)).abs() < 1e-12);
    }
    let sample = latencies(&normal(0.01, 0.01, 0.005)).concat();
    let clipped = Normal::new(0.01, 0.01).unwrap();
    assert!(kolmogorov_smirnov(&sample, |x| clipped.cdf(x)) > 10.0 * kolmogorov_limit());
    assert!(sample.iter().all(|&latency| latency >= 0.005));
}

#[test]
fn a_distribution_without_spread_is_a_constant() {
    let degenerate = [
        LatencyConfig::Constant(non_negative(0.02)),
        LatencyConfig::Uniform {
            min: non_negative(0.02),
            max: non_negative(0.02),
        },
        normal(0.02, 0.0, 0.01),
        LatencyConfig::LogNormal {
            median: positive(0.02),
            sigma: non_negative(0.0),
        },
    ];
    for config in degenerate {
        assert!((config.mean() - 0.02).abs() < 1e-15);
        assert!(
            latencies(&config)
                .concat()
                .iter()
                .all(|latency| latency.to_bits() == 0.02_f64.to_bits())
        );
    }
}

#[test]
fn no_latency_falls_short_of_the_lookahead_which_is_the_least_that_the_model_allows() {
    let uniform = LatencyConfig::Uniform {
        min: non_negative(0.01),
        max: non_negative(0.05),
    };
    let exponential = LatencyConfig::Exponential { mean: positive(0.03) };
    for (config, least) in [
        (LatencyConfig::Constant(non_negative(0.02)), 0.02),
        (uniform, 0.01),
        (normal(0.01, 0.02, 0.005), 0.005),
        (normal(0.02, 0.0, 0.01), 0.02),
        (exponential, 0.0),
    ] {
        let mut radio = losing(LossConfig::None);
        radio.latency = config.clone();
        let lookahead = medium(&radio, 1).disk.lookahead().as_secs();
        assert!((lookahead - least).abs() < 1e-12, "{config:?}: {lookahead}");
        assert!(latencies(&config).concat().iter().all(|&latency| latency >= lookahead));
    }
}

#[test]
fn latencies_are_uncorrelated_between_links_and_between_frames() {
    let links = latencies(&LatencyConfig::Exponential { mean: positive(0.03) });
    let error = 1.0 / f64::from(FRAMES).sqrt();
    for (i, link) in links.iter().enumerate() {
        assert_near(
            "between frames",
            correlation(&link[1..], &link[..link.len() - 1]),
            0.0,
            error,
        );
        for other in &links[..i] {
            assert_near("between links", correlation(link, other), 0.0, error);
        }
    }
}

/// Two exponential latencies of mean m differ by more than the interval i with probability exp(−i/m) / 2 each way.
/// Pairs (0, 1), (2, 3), … of frames are independent, so the share of n pairs has the error √(p(1−p)/n).
#[test]
fn a_late_frame_is_overtaken_by_the_next_for_a_link_is_no_queue() {
    let scale = 0.2;
    let links = latencies(&LatencyConfig::Exponential { mean: positive(scale) });
    let pairs: Vec<bool> = links
        .iter()
        .flat_map(|link| link.as_chunks::<2>().0)
        .map(|[first, second]| *first > second + super::INTERVAL)
        .collect();
    let overtaken = pairs.iter().filter(|overtaken| **overtaken).count() as f64 / pairs.len() as f64;
    let expected = 0.5 * (-super::INTERVAL / scale).exp();
    let error = (expected * (1.0 - expected) / pairs.len() as f64).sqrt();
    assert_near("overtaken", overtaken, expected, error);
}

//! Loss models.
//!
//! - A share of n independent losses of probability p has a standard error of √(p(1−p)/n).
//! - Losses of one Gilbert–Elliott link are correlated: with loss probabilities k and h in its states, shares π and 1−π
//!   of bad and good, and λ = 1 − P(good→bad) − P(bad→good), two losses n frames apart have the covariance
//!   c λⁿ, c = (h−k)² π(1−π). The variance of a share of n frames is therefore
//!   (p(1−p) + 2c Σ (1 − i/n) λⁱ) / n, which for k = 0, h = 1 and long runs is π(1−π)/n · (1+λ)/(1−λ).

use desim::engine::ActorId;
use desim::quantity::Positive;
use desim::radio::{Fate, LossConfig};

use super::statistics::{assert_geometric, assert_near, correlation, indicators, mean, variance};
use super::{fates, gilbert, gilbert_elliott, listeners, losing, losses, medium, non_negative, probability};

/// Losses in a row, by their number minus one. The last run is dropped if the frames end before it does.
fn burst_counts(lost: &[bool]) -> Vec<u64> {
    let mut counts = Vec::new();
    let mut length = 0;
    for &lost in lost {
        if lost {
            length += 1;
        } else if length > 0 {
            counts.resize(counts.len().max(length), 0);
            counts[length - 1] += 1;
            length = 0;
        }
    }
    counts
}

/// Standard error of the share of `n` frames that a Gilbert–Elliott link loses.
fn share_error([to_bad, to_good]: [f64; 2], [good_loss, bad_loss]: [f64; 2], n: u32) -> f64 {
    let bad = to_bad / (to_bad + to_good);
    let persistence = 1.0 - to_bad - to_good;
    let loss = (1.0 - bad) * good_loss + bad * bad_loss;
    let covariance = (bad_loss - good_loss).powi(2) * bad * (1.0 - bad);
    let length = f64::from(n);
    let pairs: f64 = (1..n)
        .map(|i| (1.0 - f64::from(i) / length) * persistence.powf(f64::from(i)))
        .sum();
    ((loss * (1.0 - loss) + 2.0 * covariance * pairs) / length).sqrt()
}

#[test]
fn independent_losses_have_their_probability_no_memory_and_geometric_bursts() {
    let (p, n) = (0.2, 200_000);
    let lost = &losses(&LossConfig::Bernoulli(probability(p)), 1, n)[0];
    let x = indicators(lost);
    assert_near("loss", mean(&x), p, (p * (1.0 - p) / f64::from(n)).sqrt());
    for lag in [1, 2, 7] {
        let autocorrelation = correlation(&x[lag..], &x[..x.len() - lag]);
        assert_near("autocorrelation", autocorrelation, 0.0, 1.0 / f64::from(n).sqrt());
    }
    assert_geometric("bursts", &burst_counts(lost), p);
}

#[test]
fn a_channel_without_loss_loses_nothing_and_one_of_probability_one_everything() {
    for (loss, share) in [
        (LossConfig::None, 0.0),
        (LossConfig::Bernoulli(probability(0.0)), 0.0),
        (LossConfig::Bernoulli(probability(1.0)), 1.0),
    ] {
        let lost = &losses(&loss, 1, 10_000)[0];
        assert_eq!(mean(&indicators(lost)).to_bits(), f64::to_bits(share));
    }
}

#[test]
fn loss_over_distance_follows_its_power_law() {
    let n = 100_000;
    let loss = LossConfig::Distance {
        at_range: probability(0.5),
        exponent: Positive::new(3.0),
    };
    for (distance, expected) in [
        (0.0, 0.0),
        (0.5, 0.5 / 64.0),
        (1.0, 0.0625),
        (1.5, 13.5 / 64.0),
        (2.0, 0.5),
    ] {
        let mut medium = medium(&losing(loss.clone()), 2);
        let mut dropped = 0_u32;
        for frame in 0..n {
            medium.transmit(super::sent(frame), ActorId(0), listeners(1..2, distance), |_, fate| {
                dropped += u32::from(matches!(fate, Fate::Lost(_)));
            });
        }
        let share = f64::from(dropped) / f64::from(n);
        let error = (expected * (1.0 - expected) / f64::from(n)).sqrt();
        assert_near("loss at a distance", share, expected, error);
        assert!((loss.mean_loss(distance, 2.0) - expected).abs() < 1e-12);
    }
}

#[test]
fn a_gilbert_elliott_link_loses_its_stationary_share() {
    let n = 200_000;
    for (steps, by_state, expected) in [
        ([0.05, 0.2], [0.0, 1.0], 0.2),
        ([0.01, 0.03], [0.02, 0.7], 0.19),
        ([0.7, 0.8], [0.1, 0.9], 0.1 + 0.8 * 0.7 / 1.5),
        ([0.3, 0.0], [0.0, 0.6], 0.6),
    ] {
        let loss = gilbert_elliott(steps, by_state);
        assert!((loss.mean_loss(1.0, 2.0) - expected).abs() < 1e-12);
        let measured = mean(&indicators(&losses(&loss, 1, n)[0]));
        assert_near("loss", measured, expected, share_error(steps, by_state, n));
    }
}

/// Over 10,000 frames the standard error is 0.0106, where independent losses would have 0.0040. The sample variance
/// of L shares, which are close to normal at 500 frames, has a relative standard error of √(2/L).
#[test]
fn the_loss_of_gilbert_links_spreads_as_its_correlation_says() {
    let steps = [0.05, 0.2];
    assert!((share_error(steps, [0.0, 1.0], 10_000) - 0.0106).abs() < 5e-5);
    let (links, frames) = (4000, 500);
    let shares: Vec<f64> = losses(&gilbert(0.05, 0.2), links, frames)
        .iter()
        .map(|link| mean(&indicators(link)))
        .collect();
    let expected = share_error(steps, [0.0, 1.0], frames).powi(2);
    let error = expected * (2.0 / f64::from(links)).sqrt();
    assert_near("variance of the loss", variance(&shares), expected, error);
}

#[test]
fn gilbert_bursts_are_geometric_and_so_are_the_gaps_between_them() {
    let lost = &losses(&gilbert(0.05, 0.2), 1, 400_000)[0];
    let kept: Vec<bool> = lost.iter().map(|lost| !lost).collect();
    assert_geometric("bursts", &burst_counts(lost), 1.0 - 0.2);
    assert_geometric("gaps", &burst_counts(&kept), 1.0 - 0.05);
}

/// The losses of L links at frame 0 and at frame n, which are L independent pairs, give the autocorrelation
/// ρ = Σ (x₀−π)(xₙ−π) / (L π(1−π)), whose mean is λⁿ and whose variance follows from the joint distribution of a
/// pair: P(both lost) = π² + π(1−π)λⁿ, and so on. It must not matter whether the link was listened to in between.
#[test]
fn what_a_gilbert_link_remembers_fades_as_a_power_also_while_nobody_listens() {
    let links = 40_000_u32;
    for (to_bad, to_good) in [(0.05, 0.2), (0.9, 0.6)] {
        let bad: f64 = to_bad / (to_bad + to_good);
        for (lag, listened) in [
            (1, true),
            (2, true),
            (2, false),
            (3, true),
            (5, false),
            (10, true),
            (10, false),
        ] {
            let (first, last) = ends_of_links(&gilbert(to_bad, to_good), links, lag, listened);
            let share_error = (bad * (1.0 - bad) / f64::from(links)).sqrt();
            assert_near("loss at the first frame", mean(&first), bad, share_error);

            let scale = bad * (1.0 - bad);
            let expected = f64::powf(1.0 - to_bad - to_good, f64::from(lag));
            let products = first.iter().zip(&last).map(|(x, y)| (x - bad) * (y - bad) / scale);
            let measured = products.sum::<f64>() / f64::from(links);
            let both = bad * bad + scale * expected;
            let square = both * (1.0 - bad).powi(4)
                + 2.0 * (bad - both) * (bad * (1.0 - bad)).powi(2)
                + (1.0 - 2.0 * bad + both) * bad.powi(4);
            let error = ((square / scale.powi(2) - expected.powi(2)) / f64::from(links)).sqrt();
            assert_near("autocorrelation", measured, expected, error);
        }
    }
}

/// Whether each of `links` links lost frame 0 and frame `lag`; frames in between are `listened` to or not.
fn ends_of_links(loss: &LossConfig, links: u32, lag: u32, listened: bool) -> (Vec<f64>, Vec<f64>) {
    let mut medium = medium(&losing(loss.clone()), links + 1);
    let (mut first, mut last) = (Vec::new(), Vec::new());
    for frame in 0..=lag {
        let end = frame == 0 || frame == lag;
        let hearing = if end || listened { 1..links + 1 } else { 0..0 };
        medium.transmit(super::sent(frame), ActorId(0), listeners(hearing, 1.0), |_, fate| {
            let dropped = f64::from(u8::from(matches!(fate, Fate::Lost(_))));
            match frame {
                0 => first.push(dropped),
                frame if frame == lag => last.push(dropped),
                _ => {}
            }
        });
    }
    (first, last)
}

#[test]
fn frames_lost_by_a_milder_channel_are_a_strict_subset_of_those_lost_by_a_harsher_one() {
    let distance = |at_range: f64| LossConfig::Distance {
        at_range: probability(at_range),
        exponent: Positive::new(2.0),
    };
    for (mild, harsh) in [
        (
            LossConfig::Bernoulli(probability(0.1)),
            LossConfig::Bernoulli(probability(0.3)),
        ),
        (distance(0.4), distance(0.9)),
        (
            gilbert_elliott([0.05, 0.2], [0.0, 0.5]),
            gilbert_elliott([0.05, 0.2], [0.1, 0.9]),
        ),
        (gilbert(0.05, 0.2), gilbert(0.1, 0.1)),
    ] {
        let (mild, harsh) = (losses(&mild, 20, 2000).concat(), losses(&harsh, 20, 2000).concat());
        assert!(mild.iter().zip(&harsh).all(|(mild, harsh)| !mild || *harsh));
        assert!(mild.iter().filter(|lost| **lost).count() < harsh.iter().filter(|lost| **lost).count());
    }
}

#[test]
fn a_frame_that_survives_both_of_two_channels_arrives_at_the_same_time_in_both() {
    let over = |p: f64| {
        let mut config = losing(LossConfig::Bernoulli(probability(p)));
        config.latency = desim::radio::LatencyConfig::Normal {
            mean: non_negative(0.01),
            std_dev: non_negative(0.003),
            min: non_negative(0.001),
        };
        fates(&config, 5, 2000).concat()
    };
    let pairs: Vec<(Fate, Fate)> = over(0.1).into_iter().zip(over(0.3)).collect();
    assert!(
        pairs
            .iter()
            .all(|(mild, harsh)| matches!(harsh, Fate::Lost(_)) || mild == harsh)
    );
}

#[test]
fn losses_of_different_links_are_uncorrelated_whoever_they_share() {
    let n = 50_000;
    for loss in [LossConfig::Bernoulli(probability(0.2)), gilbert(0.5, 0.5)] {
        let mut medium = medium(&losing(loss), 3);
        let mut links = vec![Vec::new(); 9];
        for frame in 0..n {
            for sender in 0..3 {
                let others = (0..3)
                    .filter(|id| *id != sender)
                    .flat_map(|id| listeners(id..id + 1, 1.0));
                medium.transmit(super::sent(frame), ActorId(sender), others, |id, fate| {
                    let lost = f64::from(u8::from(matches!(fate, Fate::Lost(_))));
                    links[3 * sender as usize + id.index()].push(lost);
                });
            }
        }
        links.retain(|link| !link.is_empty());
        for (i, link) in links.iter().enumerate() {
            for other in &links[..i] {
                assert_near("correlation", correlation(link, other), 0.0, 1.0 / f64::from(n).sqrt());
            }
        }
    }
}

//! Closed forms of the channel: what a reader can expect of it before a frame is sent.

use statrs::distribution::{ContinuousCDF, Gamma, Normal};

use super::disk_config::{LatencyConfig, LossConfig};

/// Shape of a gamma law from which on its quantiles are those of a cube.
const CUBES: f64 = 1e5;

/// The losses on one link as a chain of at most two states that steps once a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossChain {
    /// Share of the frames that find the link in each state.
    share: [f64; 2],
    /// `step[s][t]`: probability of going from state s to state t at a frame.
    step: [[f64; 2]; 2],
    /// Probability that a frame is lost in each state.
    loss: [f64; 2],
}

/// A run of losses in a row: the probability that it has lasted so long, by the state of the link.
#[derive(Clone, Copy, Debug)]
pub struct LossRun {
    chain: LossChain,
    weights: [f64; 2],
}

impl LossConfig {
    /// The losses between robots at `distance` metres of each other, where the range is `range` metres.
    #[must_use]
    pub fn chain(&self, distance: f64, range: f64) -> LossChain {
        match *self {
            Self::GilbertElliott {
                good_to_bad,
                bad_to_good,
                good_loss,
                bad_loss,
            } => {
                let [worse, better] = [good_to_bad, bad_to_good].map(crate::quantity::Probability::get);
                LossChain {
                    share: [better / (worse + better), worse / (worse + better)],
                    step: [[1.0 - worse, worse], [better, 1.0 - better]],
                    loss: [good_loss.get(), bad_loss.get()],
                }
            }
            Self::None | Self::Bernoulli(_) | Self::Distance { .. } => LossChain {
                share: [1.0, 0.0],
                step: [[1.0, 0.0]; 2],
                loss: [self.mean_loss(distance, range); 2],
            },
        }
    }
}

impl LossChain {
    /// Share of the frames that arrive in the long run.
    #[must_use]
    pub fn arriving(&self) -> f64 {
        (0..2).map(|state| self.share[state] * (1.0 - self.loss[state])).sum()
    }

    /// λ: what a state tells of the one at the next frame; 0 where losses are independent.
    #[must_use]
    pub fn memory(&self) -> f64 {
        self.step[0][0] - self.step[1][0]
    }

    /// The losses that follow on a frame that arrived, of which none is certain yet; nothing if no frame arrives.
    #[must_use]
    pub fn after_arrival(self) -> Option<LossRun> {
        let arriving = self.arriving();
        let weights = [0, 1].map(|state| self.share[state] * (1.0 - self.loss[state]) / arriving);
        (arriving > 0.0).then_some(LossRun { chain: self, weights })
    }

    /// The losses up to an instant that has nothing to do with the channel. The chain is reversible, so they are in law those
    /// that follow on it.
    #[must_use]
    pub fn at_any_time(self) -> LossRun {
        LossRun {
            chain: self,
            weights: self.share,
        }
    }
}

impl LossRun {
    /// The probability that all frames so far were lost.
    #[must_use]
    pub fn probability(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// One more is lost.
    pub fn lose(&mut self) {
        let [good, bad] = self.weights;
        self.weights = [0, 1].map(|to| {
            let LossChain { step, loss, .. } = self.chain;
            (good * step[0][to] + bad * step[1][to]) * loss[to]
        });
    }

    /// So many more are lost. Returns the sum of the probabilities before each: with w the weights and A the step to a lost frame,
    /// w (I + A + … + Aⁿ⁻¹) 1, by doubling: in no time, however many they are.
    pub fn lose_all(&mut self, frames: u64) -> f64 {
        let LossChain { step, loss, .. } = self.chain;
        let a = [0, 1].map(|from| [0, 1].map(|to| step[from][to] * loss[to]));
        let (mut power, mut sum) = ([[1.0, 0.0], [0.0, 1.0]], [[0.0; 2]; 2]);
        for bit in (0..u64::BITS - frames.leading_zeros()).rev() {
            sum = plus(sum, times(power, sum));
            power = times(power, power);
            if frames >> bit & 1 == 1 {
                sum = plus(sum, power);
                power = times(power, a);
            }
        }
        let [good, bad] = self.weights;
        self.weights = [0, 1].map(|to| good * power[0][to] + bad * power[1][to]);
        good * (sum[0][0] + sum[0][1]) + bad * (sum[1][0] + sum[1][1])
    }

    /// The probabilities of this and of all longer runs, summed: with w the weights and A the step to a lost frame,
    /// w (I − A)⁻¹ 1. Infinite if a loss may be the first of endless ones.
    #[must_use]
    pub fn probabilities_from_here(&self) -> f64 {
        let LossChain { step, loss, .. } = self.chain;
        let a = [0, 1].map(|from| [0, 1].map(|to| step[from][to] * loss[to]));
        let determinant = (1.0 - a[0][0]) * (1.0 - a[1][1]) - a[0][1] * a[1][0];
        let sums = [1.0 - a[1][1] + a[0][1], 1.0 - a[0][0] + a[1][0]];
        let sum: f64 = (0..2)
            .filter(|state| self.weights[*state] > 0.0)
            .map(|state| self.weights[state] * sums[state])
            .sum();
        if sum > 0.0 { sum / determinant } else { 0.0 }
    }
}

type Matrix = [[f64; 2]; 2];

fn times(a: Matrix, b: Matrix) -> Matrix {
    a.map(|[left, right]| [0, 1].map(|to| left * b[0][to] + right * b[1][to]))
}

fn plus(a: Matrix, b: Matrix) -> Matrix {
    [0, 1].map(|from| [0, 1].map(|to| a[from][to] + b[from][to]))
}

/// The quantile of a gamma law of a large shape and scale 1 at that of the standard normal law: its cube root is nearly normal (Wilson and
/// Hilferty, 1931). The series that gives it exactly takes as many terms as the root of the shape.
fn near_normal(shape: f64, deviate: f64) -> f64 {
    shape * (1.0 - 1.0 / (9.0 * shape) + deviate / (3.0 * shape.sqrt())).powi(3)
}

impl LatencyConfig {
    /// `number` latencies in seconds that stand for all: the middle quantiles of as many equal shares. One if all are the same.
    ///
    /// # Panics
    /// Never: a shape is above 0 by its type.
    #[must_use]
    pub fn quantiles(&self, number: u32) -> Vec<f64> {
        let shares = || (0..number).map(|share| (f64::from(share) + 0.5) / f64::from(number));
        match *self {
            Self::Constant(seconds) => vec![seconds.get()],
            Self::Uniform { min, max } if min == max => vec![min.get()],
            Self::Uniform { min, max } => shares()
                .map(|share| min.get() + share * (max.get() - min.get()))
                .collect(),
            Self::Normal { mean, std_dev, .. } if std_dev.get() == 0.0 => vec![mean.get()],
            Self::Normal { mean, std_dev, min } => {
                let standard = Normal::standard();
                let cut = standard.cdf((min.get() - mean.get()) / std_dev.get());
                shares()
                    .map(|share| mean.get() + std_dev.get() * standard.inverse_cdf(cut + share * (1.0 - cut)))
                    .collect()
            }
            Self::LogNormal { median, sigma } if sigma.get() == 0.0 => vec![median.get()],
            Self::LogNormal { median, sigma } => shares()
                .map(|share| median.get() * (sigma.get() * Normal::standard().inverse_cdf(share)).exp())
                .collect(),
            Self::Gamma { shape, scale } if shape.get() > CUBES => {
                let deviates = shares().map(|share| Normal::standard().inverse_cdf(share));
                deviates
                    .map(|deviate| scale.get() * near_normal(shape.get(), deviate))
                    .collect()
            }
            Self::Gamma { shape, scale } => {
                let standard = Gamma::new(shape.get(), 1.0).expect("a shape is above 0 by its type");
                shares()
                    .map(|share| scale.get() * standard.inverse_cdf(share))
                    .collect()
            }
            Self::Exponential { mean } => shares().map(|share| -mean.get() * (1.0 - share).ln()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{NonNegative, Positive, Probability};

    fn gilbert(worse: f64, better: f64, good_loss: f64, bad_loss: f64) -> LossChain {
        let [good_to_bad, bad_to_good, good_loss, bad_loss] =
            [worse, better, good_loss, bad_loss].map(Probability::new);
        let config = LossConfig::GilbertElliott {
            good_to_bad,
            bad_to_good,
            good_loss,
            bad_loss,
        };
        config.chain(1.0, 2.0)
    }

    fn lost(mut run: LossRun, frames: u32) -> f64 {
        (0..frames).for_each(|_| run.lose());
        run.probability()
    }

    #[test]
    fn independent_losses_are_powers_of_their_probability() {
        let chain = LossConfig::Bernoulli(Probability::new(0.2)).chain(1.0, 2.0);
        assert_eq!((chain.arriving(), chain.memory()), (0.8, 0.0));
        let run = chain.after_arrival().unwrap();
        assert!((lost(run, 3) - 0.008).abs() < 1e-15 && (lost(chain.at_any_time(), 3) - 0.008).abs() < 1e-15);
        assert!((run.probabilities_from_here() - 1.25).abs() < 1e-12, "1/(1−p)");
    }

    #[test]
    fn many_losses_at_once_are_those_one_by_one_and_the_sum_is_that_of_their_probabilities() {
        for chain in [
            gilbert(0.05, 0.2, 0.0, 1.0),
            gilbert(0.3, 0.6, 0.1, 0.8),
            gilbert(1.0, 1.0, 1.0, 1.0),
        ] {
            for frames in [0, 1, 2, 3, 7, 20, 33] {
                let (mut one_by_one, mut at_once) = (chain.at_any_time(), chain.at_any_time());
                let mut sum = 0.0;
                for _ in 0..frames {
                    sum += one_by_one.probability();
                    one_by_one.lose();
                }
                let found = at_once.lose_all(frames);
                assert!((found - sum).abs() < 1e-12, "{frames}: {found}, not {sum}");
                assert!((at_once.probability() - one_by_one.probability()).abs() < 1e-14);
            }
        }
        let all: f64 = gilbert(0.05, 0.2, 0.0, 1.0).at_any_time().lose_all(u64::MAX);
        assert!((all - 2.0).abs() < 1e-9, "1 + π/r: {all}");
    }

    #[test]
    fn simple_gilbert_losses_come_in_geometric_bursts() {
        // After an arrival the link is good: it turns bad with p, and stays bad with 1−r.
        let chain = gilbert(0.05, 0.2, 0.0, 1.0);
        assert!((chain.arriving() - 0.8).abs() < 1e-12 && (chain.memory() - 0.75).abs() < 1e-12);
        let mut run = chain.after_arrival().unwrap();
        assert!((lost(run, 3) - 0.05 * 0.8 * 0.8).abs() < 1e-15);
        run.lose();
        assert!((run.probabilities_from_here() - 0.05 / 0.2).abs() < 1e-12, "p/r");
    }

    /// Every run of three losses is one of the eight ways through the states.
    #[test]
    fn losses_in_both_states_are_summed_over_all_ways_through_them() {
        let chain = gilbert(0.3, 0.4, 0.1, 0.7);
        let (share, loss, step) = ([4.0 / 7.0, 3.0 / 7.0], [0.1, 0.7], [[0.7, 0.3], [0.4, 0.6]]);
        let mut expected = 0.0;
        for (a, b, c) in (0..8).map(|way| (way & 1, way >> 1 & 1, way >> 2)) {
            expected += share[a] * loss[a] * step[a][b] * loss[b] * step[b][c] * loss[c];
        }
        assert!((lost(chain.at_any_time(), 3) - expected).abs() < 1e-15);
        let sum: f64 = (0..2000).map(|frames| lost(chain.at_any_time(), frames)).sum();
        assert!((chain.at_any_time().probabilities_from_here() - sum).abs() < 1e-9);
    }

    #[test]
    fn losses_without_end_are_infinite_and_a_dead_link_has_no_arrival() {
        assert_eq!(
            gilbert(0.0, 1.0, 1.0, 1.0).after_arrival().map(|run| run.probability()),
            None
        );
        let trap = gilbert(0.5, 0.0, 0.0, 1.0);
        assert!(trap.arriving().abs() < 1e-15);
        assert!(trap.at_any_time().probabilities_from_here().is_infinite());
    }

    /// The error of the cube falls as the shape grows, in proportion: SciPy has 1.3e-5 standard deviations in the tails at a tenth of the
    /// least shape that it is used for.
    #[test]
    fn the_quantiles_of_a_large_gamma_law_are_those_of_a_cube() {
        let shape = CUBES / 10.0;
        let exact = Gamma::new(shape, 1.0).unwrap();
        for share in [0.0025, 0.1, 0.5, 0.9, 0.9975] {
            let cube = near_normal(shape, Normal::standard().inverse_cdf(share));
            let error = (cube - exact.inverse_cdf(share)) / shape.sqrt();
            assert!(error.abs() < 2e-5, "{share}: {error}");
        }
    }

    #[test]
    fn quantiles_have_the_mean_of_their_law() {
        let (positive, non_negative) = (Positive::new, NonNegative::new);
        for config in [
            LatencyConfig::Constant(non_negative(0.1)),
            LatencyConfig::Uniform {
                min: non_negative(0.1),
                max: non_negative(0.3),
            },
            LatencyConfig::Normal {
                mean: non_negative(0.05),
                std_dev: non_negative(0.03),
                min: non_negative(0.01),
            },
            LatencyConfig::LogNormal {
                median: positive(0.02),
                sigma: non_negative(0.5),
            },
            LatencyConfig::Gamma {
                shape: positive(2.0),
                scale: positive(0.03),
            },
            LatencyConfig::Exponential { mean: positive(0.04) },
        ] {
            let quantiles = config.quantiles(2000);
            let mean = quantiles.iter().sum::<f64>() / quantiles.len() as f64;
            assert!((mean / config.mean() - 1.0).abs() < 1e-3, "{config:?}: {mean}");
            assert!(quantiles.is_sorted());
        }
    }
}

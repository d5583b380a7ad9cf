//! The simple epidemic: who knows tells others, one at a time, and nobody forgets.

/// Longest stretch of time, in mean times between the fastest events, that is gone in one step: the weights of more would underflow.
const LONGEST: f64 = 30.0;
/// What may be left out of a distribution.
const NEGLIGIBLE: f64 = 1e-13;

/// A simple epidemic, or SI model: each of `size` meets others one at a time, any other as likely, at the instants of a Poisson process.
/// If one of the two knows and the other does not, it knows from then on. While n know, one more does at the rate β n (N − n) / (N − 1): a
/// pure birth process (Bailey, The Mathematical Theory of Infectious Diseases, 1975, chapter 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimpleEpidemic {
    size: u32,
    /// β, a second.
    rate: f64,
}

impl SimpleEpidemic {
    /// Of so many, at least two, that meet at this `rate` a second, above 0.
    #[must_use]
    pub const fn new(size: u32, rate: f64) -> Self {
        Self { size, rate }
    }

    /// The one that takes this mean time, s.
    #[must_use]
    pub fn lasting(size: u32, mean_s: f64) -> Self {
        let at_one = Self::new(size, 1.0).mean_duration();
        Self::new(size, at_one / mean_s)
    }

    /// The mean time from one who knows to all, s: 2 (N − 1) H(N − 1) / (N β).
    #[must_use]
    pub fn mean_duration(&self) -> f64 {
        let harmonic: f64 = (1..self.size).map(|n| 1.0 / f64::from(n)).sum();
        let size = f64::from(self.size);
        2.0 * (size - 1.0) * harmonic / (size * self.rate)
    }

    /// How many know at the times 0, `step_s`, 2 `step_s`, … `steps` · `step_s`, one at the first: for each of `levels`, from 0 to 1, the
    /// least number that is not exceeded with that probability.
    #[must_use]
    pub fn quantiles<const N: usize>(&self, step_s: f64, steps: usize, levels: [f64; N]) -> Vec<[u32; N]> {
        let size = f64::from(self.size);
        let birth = |n: u32| self.rate * f64::from(n) * (size - f64::from(n)) / (size - 1.0);
        let rates: Vec<f64> = (1..=self.size).map(birth).collect();
        let fastest = rates.iter().copied().fold(0.0, f64::max);
        let parts = (fastest * step_s / LONGEST).ceil().max(1.0);
        let mean = fastest * step_s / parts;
        let mut known = vec![0.0; rates.len()];
        known[0] = 1.0;
        let mut found = vec![self::quantiles(&known, levels)];
        for _ in 0..steps {
            for _ in 0..parts as u32 {
                known = later(&known, &rates, fastest, mean);
            }
            found.push(self::quantiles(&known, levels));
        }
        found
    }
}

/// The distribution after so long that there are `mean` events of a process that is as fast as the fastest state everywhere, by
/// uniformisation (Jensen, 1953).
fn later(known: &[f64], rates: &[f64], fastest: f64, mean: f64) -> Vec<f64> {
    let mut state = known.to_vec();
    let mut weight = (-mean).exp();
    let mut left = 1.0 - weight;
    let mut after: Vec<f64> = state.iter().map(|share| weight * share).collect();
    let mut events = 0.0;
    while left > NEGLIGIBLE {
        for n in (0..state.len()).rev() {
            let leaves = state[n] * rates[n] / fastest;
            state[n] -= leaves;
            if let Some(next) = state.get_mut(n + 1) {
                *next += leaves;
            }
        }
        events += 1.0;
        weight *= mean / events;
        left -= weight;
        after
            .iter_mut()
            .zip(&state)
            .for_each(|(sum, share)| *sum += weight * share);
        // Rounding may leave more than what is negligible.
        if weight < NEGLIGIBLE && events > mean {
            break;
        }
    }
    after
}

fn quantiles<const N: usize>(known: &[f64], levels: [f64; N]) -> [u32; N] {
    levels.map(|level| {
        let mut below = 0.0;
        let found = known.iter().position(|share| {
            below += share;
            below >= level - NEGLIGIBLE
        });
        found.unwrap_or(known.len() - 1) as u32 + 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stages summed: 6.741 for 20, 9.782 for 80, 10.251 for 100.
    #[test]
    fn the_mean_time_to_all_is_that_of_the_stages() {
        for (size, mean) in [(20, 6.741), (80, 9.782), (100, 10.251)] {
            let epidemic = SimpleEpidemic::new(size, 1.0);
            assert!((epidemic.mean_duration() - mean).abs() < 5e-4);
            let twice = SimpleEpidemic::lasting(size, mean / 2.0);
            assert!((twice.mean_duration() - mean / 2.0).abs() < 1e-12);
        }
    }

    /// Of two, the other knows after an exponential time: the median is ln 2 / β. Of three, the stages have the rates β and β: two know, or
    /// more, from ln 2 on, and all three from the median of a gamma law of shape 2, 1.67835.
    #[test]
    fn two_and_three_have_the_quantiles_of_exponential_and_gamma_times() {
        let medians = |size: u32| -> Vec<u32> {
            let all = SimpleEpidemic::new(size, 1.0).quantiles(0.001, 2_000, [0.5]);
            all.into_iter().map(|[median]| median).collect()
        };
        let when = |medians: &[u32], number: u32| medians.iter().position(|median| *median >= number).unwrap();
        // The median is 2 as soon as one alone knows with less than a half.
        assert!((694..=695).contains(&when(&medians(2), 2)));
        let of_three = medians(3);
        assert!((694..=695).contains(&when(&of_three, 2)));
        assert!((1_679..=1_680).contains(&when(&of_three, 3)), "{}", when(&of_three, 3));
    }

    #[test]
    fn a_large_swarm_goes_from_one_to_all_and_wide_steps_give_what_narrow_ones_do() {
        let epidemic = SimpleEpidemic::new(500, 2.0);
        let wide = epidemic.quantiles(1.0, 12, [0.05, 0.5, 0.95]);
        let narrow = epidemic.quantiles(0.125, 96, [0.05, 0.5, 0.95]);
        assert_eq!(wide, narrow.iter().step_by(8).copied().collect::<Vec<_>>());
        assert_eq!((wide[0], wide[12]), ([1; 3], [500; 3]));
        assert!(wide.iter().all(|[low, middle, high]| low <= middle && middle <= high));
    }
}

//! Detectors that wait for so long in closed form: a status every η, a channel with losses and latency, a silence TO after which
//! a robot is suspected.
//!
//! Let G be the number of statuses from one arrival to the next and Δ by how much the latency of the second exceeds that of the
//! first, independent of each other. A gap of Gη + Δ beyond TO is a mistake, and lasts for what it is beyond. So, with s the share
//! of statuses that arrive,
//!
//! - q = P(Gη + Δ > TO) and T_MR = η / (s q);
//! - T_M = E[(Gη + Δ − TO)⁺] / q, and then until the observer reads the arrival.
//!
//! With constant latency Δ = 0 and these are η/((1−p)pᵐ) and (m + 1/(1−p))η − TO under independent loss, m = ⌊TO/η⌋, and
//! η(p+r)/(r p (1−r)^(m−1)) and (m + 1/r)η − TO under simple Gilbert loss; where TO is a multiple of η, a status that arrives at
//! the very instant of the timeout is in time. NFD-S counts from the sending: its TO is η + δ, and Δ the latency of the second status
//! alone. Statuses are taken not to overtake each other.

use crate::radio::{LatencyConfig, LossChain};

/// Latencies that stand for all.
const QUANTILES: u32 = 200;
/// What is no difference between two times, seconds: virtual time counts nanoseconds.
const ROUNDING: f64 = 1e-10;

/// Statuses as they come to an observer, and how long it waits for one.
#[derive(Clone, Debug)]
pub struct Timeout {
    /// η, seconds from one status to the next.
    interval: f64,
    /// TO, seconds.
    silence: f64,
    /// When the silence begins after the sending of the status that was heard, seconds: values that stand for all, least first.
    begins: Vec<f64>,
    /// Latencies that stand for all, least first, seconds.
    latencies: Vec<f64>,
}

/// What mistakes cost between one observer and one subject, as sums over the statuses that arrive.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mistakes {
    /// λ_M, mistakes a second.
    pub rate: f64,
    /// Share of the time that is spent in a mistake, reading not included.
    pub share: f64,
    /// Mean statuses lost beyond the timeout in a mistake, times `rate`: how its duration varies.
    pub excess: f64,
}

impl Timeout {
    /// A silence of `silence` seconds from the arrival of a status on, of which there is one every `interval` seconds.
    pub fn from_arrival(interval: f64, silence: f64, latency: &LatencyConfig) -> Self {
        let latencies = latency.quantiles(QUANTILES);
        Self {
            interval,
            silence,
            begins: latencies.clone(),
            latencies,
        }
    }

    /// A silence of `silence` seconds from the sending of a status on.
    pub fn from_sending(interval: f64, silence: f64, latency: &LatencyConfig) -> Self {
        Self {
            interval,
            silence,
            begins: vec![0.0],
            latencies: latency.quantiles(QUANTILES),
        }
    }

    /// TO, seconds.
    pub fn silence(&self) -> f64 {
        self.silence
    }

    /// Whether a status may arrive at the very instant of a timeout without having been under way, when it depends on the order of
    /// events who is first.
    pub fn is_undecided(&self) -> bool {
        let multiple = self.silence / self.interval;
        self.latencies == [0.0] && (multiple - multiple.round()).abs() < 1e-9
    }

    /// The share of statuses that are overtaken by the next one.
    pub fn overtaken(&self) -> f64 {
        let overtaken = |first: &f64| {
            self.latencies
                .iter()
                .filter(move |second| *first > **second + self.interval)
                .count()
        };
        let number = self.latencies.len() as f64;
        self.latencies.iter().map(overtaken).sum::<usize>() as f64 / number.powi(2)
    }

    /// The mistakes under the losses of `chain`.
    pub fn mistakes(&self, chain: LossChain) -> Mistakes {
        let Some(mut run) = chain.after_arrival() else {
            return Mistakes::default();
        };
        let ends = |of: &[f64]| (of[0], of[of.len() - 1]);
        let ((earliest, latest), (least, most)) = (ends(&self.begins), ends(&self.latencies));
        let (mut late, mut beyond) = (0.0, 0.0);
        // Gaps that end too early to be one, all at once; then those that may be one, then those that are.
        let early = ((self.silence - most + earliest + ROUNDING) / self.interval).max(0.0) as u64;
        run.lose_all(early);
        let mut gap = early;
        while (gap + 1) as f64 * self.interval <= self.silence + latest - least + ROUNDING {
            let before = run.probability();
            run.lose();
            gap += 1;
            let ends = before - run.probability();
            let over = gap as f64 * self.interval - self.silence;
            late += ends * self.share_of_pairs(|first, second| over + second - first > ROUNDING);
            beyond += ends * self.mean_of_pairs(|first, second| (over + second - first).max(0.0));
        }
        let (certain, longer) = (run.probability(), run.probabilities_from_here());
        late += certain;
        beyond += certain * (gap as f64 * self.interval - self.silence + mean(&self.latencies) - mean(&self.begins));
        if certain > 0.0 {
            beyond += self.interval * longer;
        }
        let arrivals = chain.arriving() / self.interval;
        Mistakes {
            rate: arrivals * late,
            share: arrivals * beyond,
            excess: arrivals * longer,
        }
    }

    /// E[T_D] = E[(TO + D − U − Kη)⁺], without D where the silence begins at the sending, of a robot that fails at a time that has nothing to do with its statuses: U is uniform in
    /// (0, η], K the number of its last statuses that were lost. A robot that is suspected as it fails is detected at once.
    ///
    /// E[(X − A)⁺] = ∫₀ˣ P(A ≤ t) dt = X − ∫₀ˣ P(A > t) dt, A = U + Kη the age of what was last heard.
    pub fn detection_time(&self, chain: LossChain) -> f64 {
        let times = self.begins.iter().map(|begin| {
            let most = self.silence + begin;
            (most - self.interval * self.ages_beyond(chain, most)).max(0.0)
        });
        times.sum::<f64>() / self.begins.len() as f64
    }

    /// ∫₀ˣ P(A > t) dt in intervals: with T(k) the chance that the last k statuses were lost, P(A > t) falls in a straight line
    /// from T(k) at kη to T(k+1) at (k+1)η.
    fn ages_beyond(&self, chain: LossChain, until: f64) -> f64 {
        let (whole, part) = self.intervals(until);
        let mut run = chain.at_any_time();
        let first = run.probability();
        let sum = run.lose_all(whole);
        let last = run.probability();
        run.lose();
        let lines = sum + f64::midpoint(last, -first);
        lines + last * (part - part * part / 2.0) + run.probability() * part * part / 2.0
    }

    /// P(A > `age`): that what was last heard is older, at a time that has nothing to do with the statuses.
    pub fn is_older(&self, chain: LossChain, age: f64) -> f64 {
        let (whole, part) = self.intervals(age);
        let mut run = chain.at_any_time();
        run.lose_all(whole);
        let last = run.probability();
        run.lose();
        last + part * (run.probability() - last)
    }

    /// How many whole intervals fit into `time`, and what part of one is left.
    fn intervals(&self, time: f64) -> (u64, f64) {
        let intervals = (time / self.interval).max(0.0);
        (intervals as u64, intervals.fract())
    }

    /// From the arrival of a status to the instant at which a timer that its predecessor set may fire, seconds.
    pub fn after_arrival(&self) -> f64 {
        (self.silence + mean(&self.begins) - mean(&self.latencies)).rem_euclid(self.interval)
    }

    /// η, seconds.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    fn share_of_pairs(&self, holds: impl Fn(f64, f64) -> bool) -> f64 {
        self.mean_of_pairs(|first, second| f64::from(u8::from(holds(first, second))))
    }

    /// The mean of a figure of the beginning of a silence and of a latency, independent of each other.
    fn mean_of_pairs(&self, figure: impl Fn(f64, f64) -> f64) -> f64 {
        let pairs = self.begins.iter().flat_map(|begin| {
            let figure = &figure;
            self.latencies.iter().map(move |latency| figure(*begin, *latency))
        });
        pairs.sum::<f64>() / (self.begins.len() * self.latencies.len()) as f64
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{NonNegative, Probability};
    use crate::radio::LossConfig;

    fn bernoulli(p: f64) -> LossChain {
        LossConfig::Bernoulli(Probability::new(p)).chain(1.0, 2.0)
    }

    fn gilbert(p: f64, r: f64) -> LossChain {
        let config = LossConfig::GilbertElliott {
            good_to_bad: Probability::new(p),
            bad_to_good: Probability::new(r),
            good_loss: Probability::new(0.0),
            bad_loss: Probability::new(1.0),
        };
        config.chain(1.0, 2.0)
    }

    fn constant(interval: f64, timeout: f64) -> Timeout {
        Timeout::from_arrival(interval, timeout, &LatencyConfig::Constant(NonNegative::new(0.05)))
    }

    #[track_caller]
    fn assert_figures(detector: &Timeout, chain: LossChain, recurrence: f64, duration: f64) {
        let Mistakes { rate, share, .. } = detector.mistakes(chain);
        assert!((1.0 / rate / recurrence - 1.0).abs() < 1e-9, "T_MR {}", 1.0 / rate);
        assert!((share / rate - duration).abs() < 1e-9, "T_M {}", share / rate);
    }

    #[test]
    fn the_published_figures_of_independent_and_gilbert_loss() {
        assert_figures(&constant(1.0, 3.5), bernoulli(0.2), 156.25, 0.75);
        assert_figures(&constant(1.0, 2.5), bernoulli(0.1), 1.0 / 0.009, 0.5 + 1.0 / 0.9 - 1.0);
        assert_figures(&constant(1.0, 3.5), gilbert(0.05, 0.2), 39.0625, 4.5);
    }

    #[test]
    fn a_timeout_of_whole_intervals_waits_for_the_status_that_is_due_at_its_very_end() {
        // m = 3, as for any timeout from 3 s to below 4 s; 40 · 0.1 is not 4 in binary.
        assert_figures(&constant(1.0, 3.0), bernoulli(0.2), 156.25, 3.0 + 1.25 - 3.0);
        assert_figures(&constant(0.1, 4.0), bernoulli(0.9), 0.1 / 0.1 / 0.9_f64.powi(40), 1.0);
        let zero = Timeout::from_arrival(1.0, 3.0, &LatencyConfig::Constant(NonNegative::new(0.0)));
        assert!(zero.is_undecided() && !constant(1.0, 3.0).is_undecided());
    }

    /// TO = 2η exactly, latency uniform over 0.2 s: of the gaps of two intervals, half are too long, by 0.2/6 s on the average of
    /// all of them; P(Δ > 0) is ½ and E[Δ⁺] a sixth of the width. The grid of 200 quantiles is exact to one in 200.
    #[test]
    fn jitter_makes_mistakes_of_half_the_gaps_as_long_as_the_timeout() {
        let latency = LatencyConfig::Uniform {
            min: NonNegative::new(0.1),
            max: NonNegative::new(0.3),
        };
        let (p, late) = (0.2_f64, 0.2_f64.powi(2) + 0.8 * 0.2 / 2.0);
        let beyond = p.powi(2) * (2.0 + 1.25 - 2.0) + 0.8 * p * 0.2 / 6.0;
        let found = Timeout::from_arrival(1.0, 2.0, &latency).mistakes(bernoulli(p));
        assert!((found.rate / (0.8 * late) - 1.0).abs() < 0.006, "{found:?}");
        assert!((found.share / (0.8 * beyond) - 1.0).abs() < 0.006, "{found:?}");
    }

    #[test]
    fn failures_are_detected_after_the_published_time() {
        let time = Timeout::from_arrival(1.0, 3.5, &LatencyConfig::Constant(NonNegative::new(0.0)))
            .detection_time(bernoulli(0.2));
        // TO + d − η(½ + p/(1−p)) = 2.75 s, and 2.7528 s where a time is never below zero.
        assert!((time - 2.7528).abs() < 5e-5, "{time}");
        assert!((constant(1.0, 3.5).detection_time(bernoulli(0.0)) - 3.05).abs() < 1e-12);
    }

    /// Ten thousand million intervals are as soon reckoned with as three: without loss a failure is found after TO + d − η/2, and with
    /// p = ½ on average half an interval and 1/(1−p) − 1 = 1 of them sooner.
    #[test]
    fn a_timeout_of_any_length_has_its_closed_form_at_once() {
        let detector = constant(0.1, 1e9);
        assert!((detector.detection_time(bernoulli(0.5)) - (1e9 + 0.05 - 0.15)).abs() < 1e-5);
        assert!(detector.mistakes(bernoulli(0.5)).rate.abs() < 1e-300);
        let never = bernoulli(1.0 - 1e-12);
        // m = 10¹⁰ losses in a row have the chance exp(−10¹⁰⁻¹²).
        let rate = 1e-12 * (-0.01_f64).exp() / 0.1;
        assert!(
            (detector.mistakes(never).rate / rate - 1.0).abs() < 1e-3,
            "{:?}",
            detector.mistakes(never)
        );
    }

    #[test]
    fn without_loss_and_without_jitter_there_is_no_mistake_and_on_a_dead_link_nobody_to_mistake() {
        for chain in [bernoulli(0.0), bernoulli(1.0)] {
            assert!(constant(1.0, 3.5).mistakes(chain).rate.abs() < 1e-15);
        }
    }
}

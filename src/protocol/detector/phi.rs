//! φ-accrual: suspects when the present silence is improbable, given the past intervals between arrivals (Hayashibara,
//! Défago, Yared and Katayama, *The φ accrual failure detector*, SRDS 2004).
//!
//! φ = 8 is meant to say that a longer silence has a chance of 10⁻⁸, but three detectors in wide use understand it
//! differently: a dialect is a formula, and a way to fill the window of intervals. Each φ grows with the silence, so that the
//! instant at which it reaches the threshold is known beforehand, and all three of those silences are linear in the window's
//! mean and standard deviation: a pause + a · mean + b · deviation. Nobody polls.

use std::collections::VecDeque;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::watch::{Row, Rule};
use crate::engine::{SimTime, Span};
use crate::protocol::Reception;
use crate::quantity::{NonNegative, Positive};

/// Longest interval that is remembered as it was, seconds: a day. It keeps exact sums of squares within their integers.
const LONGEST_S: f64 = 86_400.0;

/// Settings of φ-accrual.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhiAccrualConfig {
    /// What φ means. Required: "φ = 8" names three detectors.
    pub dialect: DialectConfig,
    /// φ from which on a robot is suspected. All three libraries have 8; recommended: 5 to 12.
    #[serde(default = "threshold")]
    pub threshold: Positive,
    /// Intervals that are remembered of each robot, 8 bytes each; all three libraries have 1000.
    #[schemars(range(min = 1, max = 100_000))]
    #[serde(default = "window")]
    pub window: u32,
    /// The interval that is assumed of a robot before any was seen, seconds: above 0, at most a day. By default chitchat's 5 s, Cassandra's
    /// 2 s, Akka's 1 s, which Akka takes to vary by a quarter.
    #[serde(default)]
    pub initial_interval: DialectSetting,
    /// Intervals longer than this are not remembered, seconds: above 0, at most a day. By default chitchat's 10 s, Cassandra's 2 s. Not for
    /// Akka, which remembers those that did not end a suspicion.
    #[serde(default)]
    pub max_interval: DialectSetting,
    /// A pause that is always borne, seconds, added to the mean interval: by default Akka's 3 s. Only for Akka.
    #[serde(default)]
    pub acceptable_pause: DialectSetting,
    /// The least standard deviation that is assumed, seconds: by default Akka's 0.1 s. Only for Akka.
    #[serde(default)]
    pub min_std_deviation: DialectSetting,
}

fn threshold() -> Positive {
    Positive::new(8.0)
}

fn window() -> u32 {
    1000
}

/// What φ means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum DialectConfig {
    /// φ = silence / mean interval, as in chitchat (Quickwit). After a suspicion it forgets all intervals.
    Chitchat,
    /// φ = silence / (mean interval · ln 10), as in Apache Cassandra: intervals are taken to be exponential.
    Cassandra,
    /// φ = −log₁₀ of the chance of a longer silence where intervals are normal, by a logistic approximation of the tail, as
    /// in Akka.
    Akka,
}

/// A setting whose default depends on the dialect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum DialectSetting {
    /// The dialect's own.
    #[default]
    Default,
    /// So many seconds.
    Seconds(NonNegative),
}

impl DialectSetting {
    fn or(self, default_s: f64) -> f64 {
        match self {
            Self::Default => default_s,
            Self::Seconds(seconds) => seconds.get(),
        }
    }
}

impl PhiAccrualConfig {
    /// The settings of `dialect` as its library has them.
    #[must_use]
    pub fn of(dialect: DialectConfig) -> Self {
        Self {
            dialect,
            threshold: threshold(),
            window: window(),
            initial_interval: DialectSetting::Default,
            max_interval: DialectSetting::Default,
            acceptable_pause: DialectSetting::Default,
            min_std_deviation: DialectSetting::Default,
        }
    }

    /// The silence after which a robot is suspected whose arrivals came every `interval`.
    pub(super) fn regular_silence(&self, interval: Span) -> Span {
        Phi::new(self).silence(interval.as_secs(), 0.0)
    }

    /// The silence after which a robot is suspected that was heard once.
    pub(super) fn first_silence(&self) -> Span {
        let phi = Phi::new(self);
        let mut window = Window::default();
        phi.begin(&mut window);
        window.silence
    }

    /// That of a robot all of whose intervals are as long as any that is remembered, or five status intervals on average and
    /// as much apart where there is no bound.
    pub(super) fn longest_silence(&self, status_interval: Span) -> Span {
        let phi = Phi::new(self);
        let interval = match self.dialect {
            DialectConfig::Chitchat | DialectConfig::Cassandra => phi.max_interval.as_secs(),
            DialectConfig::Akka => 5.0 * status_interval.as_secs(),
        };
        let longest = phi.silence(interval, interval);
        longest.max(self.first_silence())
    }

    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let Self {
            dialect,
            initial_interval,
            max_interval,
            acceptable_pause,
            min_std_deviation,
            ..
        } = *self;
        let mut found = Vec::new();
        let is_akka = dialect == DialectConfig::Akka;
        let settings = [
            ("max_interval", max_interval, !is_akka),
            ("acceptable_pause", acceptable_pause, is_akka),
            ("min_std_deviation", min_std_deviation, is_akka),
        ];
        for (field, setting, known) in settings {
            if !known && setting != DialectSetting::Default {
                found.push((field.into(), format!("the dialect `{dialect:?}` has no such setting")));
            }
        }
        for (field, setting) in [("initial_interval", initial_interval), ("max_interval", max_interval)] {
            let seconds = setting.or(1.0);
            if seconds <= 0.0 || seconds > LONGEST_S {
                let message = format!("{seconds} s is out of range: expected above 0 and at most {LONGEST_S} s");
                found.push((field.into(), message));
            }
        }
        if !(1..=100_000).contains(&self.window) {
            found.push((
                "window".into(),
                format!("{} is out of range: expected 1 to 100000 intervals", self.window),
            ));
        }
        found
    }
}

/// The rule of φ-accrual, in working units: suspects after `pause` + `per_mean` · mean + `per_deviation` · deviation.
#[derive(Debug)]
pub struct Phi {
    dialect: DialectConfig,
    pause_s: f64,
    per_mean: f64,
    per_deviation: f64,
    min_deviation_s: f64,
    initial: Span,
    max_interval: Span,
    window: usize,
}

/// What is known of the intervals between a robot's arrivals.
#[derive(Debug, Default)]
pub struct Window {
    /// The newest last, nanoseconds. Sums are of whole numbers: they never drift.
    intervals: VecDeque<u64>,
    sum: u64,
    sum_of_squares: u128,
    /// The silence at which φ reaches the threshold.
    silence: Span,
}

impl Phi {
    /// The rule that `config` sets.
    pub fn new(config: &PhiAccrualConfig) -> Self {
        let threshold = config.threshold.get();
        let (initial_s, max_s) = match config.dialect {
            DialectConfig::Chitchat => (5.0, 10.0),
            DialectConfig::Cassandra => (2.0, 2.0),
            DialectConfig::Akka => (1.0, f64::INFINITY),
        };
        let (pause_s, per_mean, per_deviation, min_deviation_s) = match config.dialect {
            DialectConfig::Chitchat => (0.0, threshold, 0.0, 0.0),
            DialectConfig::Cassandra => (0.0, threshold * std::f64::consts::LN_10, 0.0, 0.0),
            DialectConfig::Akka => (
                config.acceptable_pause.or(3.0),
                1.0,
                logistic_quantile(threshold),
                config.min_std_deviation.or(0.1),
            ),
        };
        Self {
            dialect: config.dialect,
            pause_s,
            per_mean,
            per_deviation,
            min_deviation_s,
            initial: Span::from_secs(config.initial_interval.or(initial_s).min(LONGEST_S)),
            max_interval: Span::from_secs(config.max_interval.or(max_s)),
            window: config.window as usize,
        }
    }

    /// The silence after which φ reaches the threshold, for intervals of this mean and deviation, seconds.
    fn silence(&self, mean_s: f64, deviation_s: f64) -> Span {
        let deviation_s = deviation_s.max(self.min_deviation_s);
        Span::from_secs(self.pause_s + self.per_mean * mean_s + self.per_deviation * deviation_s)
    }

    /// Fills `window` with what is assumed before any interval was seen.
    fn begin(&self, window: &mut Window) {
        window.intervals.clear();
        (window.sum, window.sum_of_squares) = (0, 0);
        let initial = self.initial.as_nanos();
        match self.dialect {
            DialectConfig::Chitchat | DialectConfig::Cassandra => self.remember(window, initial),
            DialectConfig::Akka => {
                // Two intervals whose mean and deviation are those assumed.
                self.remember(window, initial - initial / 4);
                self.remember(window, initial + initial / 4);
            }
        }
    }

    fn remember(&self, window: &mut Window, nanos: u64) {
        let nanos = nanos.min(Span::from_secs(LONGEST_S).as_nanos());
        if window.intervals.len() >= self.window
            && let Some(oldest) = window.intervals.pop_front()
        {
            window.sum -= oldest;
            window.sum_of_squares -= u128::from(oldest).pow(2);
        }
        window.intervals.push_back(nanos);
        window.sum += nanos;
        window.sum_of_squares += u128::from(nanos).pow(2);
        let count = window.intervals.len() as u64;
        let mean_s = window.sum as f64 / count as f64 / 1e9;
        // n Σx² − (Σx)², in whole numbers: what floats would cancel is exact.
        let spread = u128::from(count) * window.sum_of_squares - u128::from(window.sum).pow(2);
        let deviation_s = (spread as f64).sqrt() / count as f64 / 1e9;
        window.silence = self.silence(mean_s, deviation_s);
    }
}

impl Rule for Phi {
    type State = Window;
    /// A long interval that the window forgets makes it less patient.
    const HASTENS: bool = true;

    fn first<M>(&self, _: &Reception<M>) -> Window {
        let mut window = Window::default();
        self.begin(&mut window);
        window
    }

    fn next<M>(&self, row: &mut Row<Window>, status: &Reception<M>) {
        let interval = status.at.since(row.heard());
        let was_trusted = self.due(row) > status.at;
        let counts = match self.dialect {
            DialectConfig::Chitchat if !was_trusted => return self.begin(&mut row.state),
            DialectConfig::Chitchat | DialectConfig::Cassandra => interval <= self.max_interval,
            DialectConfig::Akka => was_trusted,
        };
        if counts {
            self.remember(&mut row.state, interval.as_nanos());
        }
    }

    fn due(&self, row: &Row<Window>) -> SimTime {
        row.heard() + row.state.silence
    }
}

/// The y at which Akka's approximation of the normal tail is 10^−φ: with e = exp(−y (1.5976 + 0.070566 y²)), the tail is
/// e / (1 + e), so that y solves 0.070566 y³ + 1.5976 y = −ln e = ln(10^φ − 1). The cubic has one real root (Cardano's
/// formula in hyperbolic form).
fn logistic_quantile(phi: f64) -> f64 {
    const LINEAR: f64 = 1.5976;
    const CUBIC: f64 = 0.070_566;
    // ln(10^φ − 1), without overflow for large φ.
    let exponent = phi * std::f64::consts::LN_10;
    let odds = exponent + (-(-exponent).exp()).ln_1p();
    let (p, q) = (LINEAR / CUBIC, odds / CUBIC);
    2.0 * (p / 3.0).sqrt() * (((3.0 * q) / (2.0 * p) * (3.0 / p).sqrt()).asinh() / 3.0).sinh()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// φ as Akka computes it.
    fn akka_phi(silence: f64, mean: f64, deviation: f64) -> f64 {
        let y = (silence - mean) / deviation;
        let e = (-y * (1.5976 + 0.070_566 * y * y)).exp();
        if silence > mean {
            -(e / (1.0 + e)).log10()
        } else {
            -(1.0 - 1.0 / (1.0 + e)).log10()
        }
    }

    #[test]
    fn at_the_silence_that_is_computed_akkas_phi_is_the_threshold() {
        for threshold in [0.1, 0.5, 1.0, 3.0, 8.0, 12.0] {
            let y = logistic_quantile(threshold);
            let phi = akka_phi(4.0 + 0.3 * y, 4.0, 0.3);
            assert!(
                (phi - threshold).abs() < 1e-6 * threshold.max(1.0),
                "{threshold}: {phi}"
            );
        }
    }

    #[test]
    fn eight_names_three_detectors() {
        // Jitter-free heartbeats of 1 s: 8 · 1 s; 8 · ln 10 · 1 s; 1 s + 3 s + 5.2260 · 0.1 s.
        for (dialect, silence) in [
            (DialectConfig::Chitchat, 8.0),
            (DialectConfig::Cassandra, 18.4207),
            (DialectConfig::Akka, 4.5226),
        ] {
            let found = PhiAccrualConfig::of(dialect)
                .regular_silence(Span::from_secs(1.0))
                .as_secs();
            assert!((found - silence).abs() < 5e-4, "{dialect:?}: {found}");
        }
    }

    #[test]
    fn the_window_forgets_the_oldest_and_its_sums_stay_exact() {
        let phi = Phi::new(&PhiAccrualConfig {
            window: 3,
            min_std_deviation: DialectSetting::Seconds(NonNegative::new(0.0)),
            ..PhiAccrualConfig::of(DialectConfig::Akka)
        });
        let mut window = Window::default();
        phi.begin(&mut window);
        for seconds in [9, 1, 2, 3] {
            phi.remember(&mut window, seconds * 1_000_000_000);
        }
        // Of 1, 2 and 3 s the mean is 2 s and the deviation √(2/3) s.
        let expected = 3.0 + 2.0 + logistic_quantile(8.0) * f64::sqrt(2.0 / 3.0);
        assert!((window.silence.as_secs() - expected).abs() < 1e-6);
    }

    #[test]
    fn a_setting_of_another_dialect_is_refused() {
        let seconds = DialectSetting::Seconds(NonNegative::new(0.0));
        let fields = |config: PhiAccrualConfig| -> Vec<String> {
            config.problems().into_iter().map(|(field, _)| field).collect()
        };
        let all = |dialect| PhiAccrualConfig {
            initial_interval: seconds,
            max_interval: seconds,
            acceptable_pause: seconds,
            min_std_deviation: seconds,
            window: 0,
            ..PhiAccrualConfig::of(dialect)
        };
        assert_eq!(
            fields(all(DialectConfig::Chitchat)),
            [
                "acceptable_pause",
                "min_std_deviation",
                "initial_interval",
                "max_interval",
                "window"
            ]
        );
        assert_eq!(
            fields(all(DialectConfig::Akka)),
            ["max_interval", "initial_interval", "max_interval", "window"]
        );
    }
}

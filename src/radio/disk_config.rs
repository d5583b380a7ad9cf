//! What a scenario says about the disk radio.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use crate::quantity::{NonNegative, Positive, Probability};

/// The disk radio: range, channel, and what a frame carries beside its payload.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DiskConfig {
    /// Communication range C in metres: a robot hears transmissions from at most this far (paper table 1: 2 m).
    pub range: Positive,
    /// Which frames the channel drops.
    pub loss: LossConfig,
    /// How long a frame takes from transmission to arrival, drawn for each reception on its own.
    pub latency: LatencyConfig,
    /// Bytes that every frame carries once, whatever is in it. 2: its sender.
    pub frame_header_bytes: u16,
    /// Bytes that every message in a frame carries beside its payload. 3: its topic and its length.
    pub message_header_bytes: u16,
    /// Noise of the receiver's sense of where a sender is.
    pub sensing: SensingConfig,
    /// Whether walls and obstacles of the arena stop what is sent: `Pass` or `Block`.
    pub walls: WallsConfig,
}

/// What walls and obstacles of the arena do to what is sent through them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum WallsConfig {
    /// Nothing.
    #[default]
    Pass,
    /// They stop it.
    Block,
    /// Each takes so many dB from it, or as many as its own `attenuation` says. Not over the disk radio, which knows no powers.
    Loss(NonNegative),
}

impl Default for DiskConfig {
    fn default() -> Self {
        Self {
            range: Positive::new(2.0),
            loss: LossConfig::None,
            latency: LatencyConfig::Constant(NonNegative::new(0.1)),
            frame_header_bytes: 2,
            message_header_bytes: 3,
            sensing: SensingConfig::default(),
            walls: WallsConfig::Pass,
        }
    }
}

impl DiskConfig {
    /// What is wrong between fields that are each in range: the path of the field at fault, from this section on, and
    /// what is wrong with it and would be right. Empty if the radio can be built.
    #[must_use]
    pub fn problems(&self) -> Vec<(String, String)> {
        let loss = self.loss.problem().map(|message| ("loss".to_owned(), message));
        let latency = self.latency.problem().map(|message| ("latency".to_owned(), message));
        let walls = matches!(self.walls, WallsConfig::Loss(_)).then(|| {
            let message = "the disk radio knows no dB; use Pass or Block, or a radio with a `technology`";
            ("walls".to_owned(), message.to_owned())
        });
        loss.into_iter().chain(latency).chain(walls).collect()
    }
}

/// Loss of frames in the channel, for each receiver on its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LossConfig {
    /// Every frame arrives.
    None,
    /// Each frame is lost with this probability, independently.
    Bernoulli(Probability),
    /// Bursts: each ordered pair of robots is a two-state chain, good or bad, that steps once at every frame of the
    /// sender, whether or not the receiver is in range to hear it. It starts from its stationary distribution.
    GilbertElliott {
        /// Probability of going from good to bad at a frame. Not 0 together with `bad_to_good`.
        good_to_bad: Probability,
        /// Probability of going from bad to good at a frame; the mean burst is its inverse.
        bad_to_good: Probability,
        /// Loss probability in the good state.
        #[serde(default = "never")]
        good_loss: Probability,
        /// Loss probability in the bad state, at least `good_loss`.
        #[serde(default = "always")]
        bad_loss: Probability,
    },
    /// Loss grows with distance d as `at_range` · (d / range)^`exponent`.
    Distance {
        /// Loss probability at the edge of the range.
        at_range: Probability,
        /// How sharply loss sets in towards the edge.
        exponent: Positive,
    },
}

impl LossConfig {
    /// The share of frames that are lost in the long run between robots at `distance` metres of each other, where the
    /// communication range is `range` metres.
    #[must_use]
    pub fn mean_loss(&self, distance: f64, range: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Bernoulli(probability) => probability.get(),
            Self::GilbertElliott {
                good_to_bad,
                bad_to_good,
                good_loss,
                bad_loss,
            } => {
                let bad_share = good_to_bad.get() / (good_to_bad.get() + bad_to_good.get());
                (1.0 - bad_share) * good_loss.get() + bad_share * bad_loss.get()
            }
            Self::Distance { at_range, exponent } => at_range.get() * (distance / range).powf(exponent.get()),
        }
    }

    fn problem(&self) -> Option<String> {
        let Self::GilbertElliott {
            good_to_bad,
            bad_to_good,
            good_loss,
            bad_loss,
        } = self
        else {
            return None;
        };
        if good_to_bad.get() + bad_to_good.get() == 0.0 {
            return Some(
                "GilbertElliott never changes state: good_to_bad and bad_to_good are both 0; \
                 set one of them above 0, or use Bernoulli for independent losses"
                    .into(),
            );
        }
        (good_loss > bad_loss).then(|| {
            let (good, bad) = (good_loss.get(), bad_loss.get());
            format!("GilbertElliott loses more in its good state (good_loss {good}) than in its bad one (bad_loss {bad}); exchange them")
        })
    }
}

fn never() -> Probability {
    Probability::new(0.0)
}

fn always() -> Probability {
    Probability::new(1.0)
}

/// Latency of a frame, in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LatencyConfig {
    /// Always the same.
    Constant(NonNegative),
    /// Uniform between two bounds.
    Uniform {
        /// Smallest latency.
        min: NonNegative,
        /// Largest latency, not below `min`.
        max: NonNegative,
    },
    /// Normal, drawn again until at least `min` (a truncated normal).
    Normal {
        /// Mean before truncation.
        mean: NonNegative,
        /// Standard deviation before truncation.
        std_dev: NonNegative,
        /// Smallest latency, at most `mean`.
        #[serde(default = "zero")]
        min: NonNegative,
    },
    /// Log-normal.
    LogNormal {
        /// Median.
        median: Positive,
        /// Standard deviation of the logarithm.
        sigma: NonNegative,
    },
    /// Gamma.
    Gamma {
        /// Shape.
        shape: Positive,
        /// Scale; the mean is shape · scale.
        scale: Positive,
    },
    /// Exponential.
    Exponential {
        /// Mean.
        mean: Positive,
    },
}

impl LatencyConfig {
    /// Mean latency in seconds, after truncation.
    #[must_use]
    pub fn mean(&self) -> f64 {
        match *self {
            Self::Constant(seconds) => seconds.get(),
            Self::Uniform { min, max } => f64::midpoint(min.get(), max.get()),
            Self::Normal { mean, std_dev, min } => truncated_mean(mean.get(), std_dev.get(), min.get()),
            Self::LogNormal { median, sigma } => median.get() * (sigma.get().powi(2) / 2.0).exp(),
            Self::Gamma { shape, scale } => shape.get() * scale.get(),
            Self::Exponential { mean } => mean.get(),
        }
    }

    fn problem(&self) -> Option<String> {
        match *self {
            Self::Uniform { min, max } if min > max => {
                let (min, max) = (min.get(), max.get());
                Some(format!("Uniform has min {min} above max {max}; exchange them"))
            }
            Self::Normal { mean, min, .. } if min > mean => {
                let (min, mean) = (min.get(), mean.get());
                Some(format!(
                    "Normal has min {min} above mean {mean}; lower min to at most the mean, or raise the mean"
                ))
            }
            _ => None,
        }
    }
}

/// Mean of a normal distribution that is cut off below `min`: μ + σ φ(α) / (1 − Φ(α)), α = (min − μ) / σ.
fn truncated_mean(mean: f64, std_dev: f64, min: f64) -> f64 {
    if std_dev == 0.0 {
        return mean;
    }
    let standard = Normal::standard();
    let alpha = (min - mean) / std_dev;
    mean + std_dev * standard.pdf(alpha) / standard.sf(alpha)
}

fn zero() -> NonNegative {
    NonNegative::new(0.0)
}

/// Noise of situated communication.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SensingConfig {
    /// Standard deviation of the sensed range, as a share of it. A range is never sensed below 0.
    pub range_noise: NonNegative,
    /// Standard deviation of the sensed bearing, in degrees.
    pub bearing_noise: NonNegative,
}

impl Default for SensingConfig {
    fn default() -> Self {
        Self {
            range_noise: zero(),
            bearing_noise: zero(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problems(loss: LossConfig, latency: LatencyConfig) -> Vec<(String, String)> {
        DiskConfig {
            loss,
            latency,
            ..DiskConfig::default()
        }
        .problems()
    }

    fn gilbert_elliott(good_to_bad: f64, bad_to_good: f64, good_loss: f64, bad_loss: f64) -> LossConfig {
        LossConfig::GilbertElliott {
            good_to_bad: Probability::new(good_to_bad),
            bad_to_good: Probability::new(bad_to_good),
            good_loss: Probability::new(good_loss),
            bad_loss: Probability::new(bad_loss),
        }
    }

    fn uniform(min: f64, max: f64) -> LatencyConfig {
        LatencyConfig::Uniform {
            min: NonNegative::new(min),
            max: NonNegative::new(max),
        }
    }

    fn normal(mean: f64, min: f64) -> LatencyConfig {
        LatencyConfig::Normal {
            mean: NonNegative::new(mean),
            std_dev: NonNegative::new(0.003),
            min: NonNegative::new(min),
        }
    }

    #[test]
    fn every_problem_is_reported_at_its_field_with_its_remedy() {
        for (loss, latency, expected) in [
            (
                gilbert_elliott(0.0, 0.0, 0.0, 1.0),
                uniform(0.0, 0.1),
                vec![("loss", "set one of them above 0")],
            ),
            (
                gilbert_elliott(0.1, 0.2, 0.9, 0.1),
                uniform(0.0, 0.1),
                vec![("loss", "exchange them")],
            ),
            (
                LossConfig::None,
                uniform(0.2, 0.1),
                vec![("latency", "min 0.2 above max 0.1; exchange them")],
            ),
            (
                LossConfig::None,
                normal(0.01, 0.02),
                vec![("latency", "lower min to at most the mean")],
            ),
            (
                gilbert_elliott(0.0, 0.0, 0.0, 1.0),
                normal(0.01, 0.02),
                vec![("loss", "never changes state"), ("latency", "min 0.02 above mean 0.01")],
            ),
        ] {
            let found = problems(loss, latency);
            assert_eq!(found.len(), expected.len());
            for ((field, message), (expected_field, part)) in found.iter().zip(expected) {
                assert_eq!(field, expected_field);
                assert!(message.contains(part), "{message}");
            }
        }
    }

    #[test]
    fn limits_that_meet_are_no_problem() {
        for latency in [uniform(0.1, 0.1), normal(0.01, 0.01)] {
            assert_eq!(problems(gilbert_elliott(0.0, 1.0, 0.5, 0.5), latency), []);
        }
        assert_eq!(DiskConfig::default().problems(), []);
    }
}

//! How long copies take.

use rand_distr::{Distribution, Exp1, Gamma, StandardNormal, StandardUniform};

use super::disk_config::LatencyConfig;
use super::draw::LatencyBits;
use crate::engine::Span;

/// A latency model.
#[derive(Debug)]
pub(super) struct Latency {
    model: Model,
}

#[derive(Debug)]
enum Model {
    Constant(Span),
    Random(Law),
}

/// A distribution of seconds.
#[derive(Debug)]
enum Law {
    Uniform { min: f64, width: f64 },
    Normal { mean: f64, std_dev: f64, min: f64 },
    LogNormal { median: f64, sigma: f64 },
    Gamma(Gamma<f64>),
    Exponential { mean: f64 },
}

impl Latency {
    /// The model that `config` describes.
    pub fn new(config: &LatencyConfig) -> Self {
        Self {
            model: Model::new(config),
        }
    }

    /// The latency, if every copy takes the same time.
    pub fn constant(&self) -> Option<Span> {
        match self.model {
            Model::Constant(span) => Some(span),
            Model::Random(_) => None,
        }
    }

    /// What no latency falls short of.
    pub fn least(&self) -> Span {
        match self.model {
            Model::Constant(span) => span,
            Model::Random(Law::Uniform { min, .. } | Law::Normal { min, .. }) => Span::from_secs(min),
            Model::Random(Law::LogNormal { .. } | Law::Gamma(_) | Law::Exponential { .. }) => Span::ZERO,
        }
    }

    /// How to draw from the law that is named most, if it is that one: a loop of its own keeps all that it needs in registers.
    #[inline]
    pub fn normal(&self) -> Option<impl Fn(&mut LatencyBits) -> Span + use<>> {
        let Model::Random(Law::Normal { mean, std_dev, min }) = self.model else {
            return None;
        };
        Some(move |random: &mut LatencyBits| Span::from_secs(truncated_normal(mean, std_dev, min, random)))
    }

    /// The latency of a copy, drawn from `channel`, its own stream, and rounded to the nearest nanosecond.
    #[inline]
    pub fn draw(&self, channel: &mut LatencyBits) -> Span {
        match &self.model {
            Model::Constant(span) => *span,
            Model::Random(law) => Span::from_secs(law.draw(channel)),
        }
    }
}

impl Model {
    /// A distribution without spread becomes the constant that it is.
    fn new(config: &LatencyConfig) -> Self {
        let constant = |seconds| Self::Constant(Span::from_secs(seconds));
        match *config {
            LatencyConfig::Constant(seconds) => constant(seconds.get()),
            LatencyConfig::Uniform { min, max } if min == max => constant(min.get()),
            LatencyConfig::Uniform { min, max } => Self::Random(Law::Uniform {
                min: min.get(),
                width: max.get() - min.get(),
            }),
            LatencyConfig::Normal { mean, std_dev, .. } if std_dev.get() == 0.0 => constant(mean.get()),
            LatencyConfig::Normal { mean, std_dev, min } => Self::Random(Law::Normal {
                mean: mean.get(),
                std_dev: std_dev.get(),
                min: min.get(),
            }),
            LatencyConfig::LogNormal { median, sigma } if sigma.get() == 0.0 => constant(median.get()),
            LatencyConfig::LogNormal { median, sigma } => Self::Random(Law::LogNormal {
                median: median.get(),
                sigma: sigma.get(),
            }),
            LatencyConfig::Gamma { shape, scale } => Self::Random(Law::Gamma(
                Gamma::new(shape.get(), scale.get()).expect("shape and scale are above 0 by their type"),
            )),
            LatencyConfig::Exponential { mean } => Self::Random(Law::Exponential { mean: mean.get() }),
        }
    }
}

impl Law {
    /// One latency in seconds.
    #[inline]
    fn draw(&self, random: &mut LatencyBits) -> f64 {
        match self {
            Self::Uniform { min, width } => {
                let share: f64 = StandardUniform.sample(random);
                min + width * share
            }
            Self::Normal { mean, std_dev, min } => truncated_normal(*mean, *std_dev, *min, random),
            Self::LogNormal { median, sigma } => {
                let normal: f64 = StandardNormal.sample(random);
                median * (sigma * normal).exp()
            }
            Self::Gamma(gamma) => gamma.sample(random),
            Self::Exponential { mean } => {
                let exponential: f64 = Exp1.sample(random);
                mean * exponential
            }
        }
    }
}

/// A normal draw, repeated until it is at least `min`. As `min` is at most `mean`, each try succeeds with a
/// probability of at least one half.
#[inline]
fn truncated_normal(mean: f64, std_dev: f64, min: f64, random: &mut LatencyBits) -> f64 {
    loop {
        let normal: f64 = StandardNormal.sample(random);
        let latency = mean + std_dev * normal;
        if latency >= min {
            return latency;
        }
    }
}

//! How likely the channel is to drop a copy.

use super::disk_config::LossConfig;
use super::draw::FrameCopy;
use super::gilbert::GilbertElliott;
use crate::engine::Streams;

/// A loss model with its state.
#[derive(Debug)]
pub(super) struct Loss {
    model: Model,
}

#[derive(Debug)]
enum Model {
    /// The same probability for every copy; 0 for a channel without loss.
    Bernoulli(f64),
    GilbertElliott(GilbertElliott),
    /// Probability `at_range` · (d² / range²)^`half_exponent`.
    Distance {
        at_range: f64,
        half_exponent: f64,
        range_squared: f64,
    },
}

impl Loss {
    /// The model that `config` describes, for `robots` robots with a communication range of `range` metres.
    pub fn new(config: &LossConfig, range: f64, streams: Streams, robots: usize) -> Self {
        let model = match *config {
            LossConfig::None => Model::Bernoulli(0.0),
            LossConfig::Bernoulli(probability) => Model::Bernoulli(probability.get()),
            LossConfig::GilbertElliott {
                good_to_bad,
                bad_to_good,
                good_loss,
                bad_loss,
            } => Model::GilbertElliott(GilbertElliott::new(
                [good_to_bad.get(), bad_to_good.get()],
                [good_loss.get(), bad_loss.get()],
                streams,
                robots,
            )),
            LossConfig::Distance { at_range, exponent } => Model::Distance {
                at_range: at_range.get(),
                half_exponent: exponent.get() / 2.0,
                range_squared: range * range,
            },
        };
        Self { model }
    }

    /// The probability, if it is the same for every copy.
    pub fn same_for_all(&self) -> Option<f64> {
        match self.model {
            Model::Bernoulli(probability) => Some(probability),
            Model::GilbertElliott(_) | Model::Distance { .. } => None,
        }
    }

    /// The probability that the channel drops `copy`, which has the square root of `distance_squared` metres to go.
    #[inline]
    pub fn probability(&mut self, copy: FrameCopy, distance_squared: f64) -> f64 {
        match &mut self.model {
            Model::Bernoulli(probability) => *probability,
            Model::GilbertElliott(links) => links.loss_probability(copy),
            Model::Distance {
                at_range,
                half_exponent,
                range_squared,
            } => *at_range * (distance_squared / *range_squared).powf(*half_exponent),
        }
    }
}

//! Situated communication: where a receiver believes the sender to be (paper section 3.1).

use rand_distr::{Distribution, StandardNormal};

use super::disk_config::SensingConfig;
use super::draw::FrameCopy;
use crate::engine::{KeyedStreams, Purpose, Streams};
use crate::geometry::{Vec2, unit};

/// The stream of a copy's sensing errors: the range's first, then the bearing's.
const SENSING: Purpose = Purpose::new("radio.sensing");

/// A range-and-bearing sensor.
#[derive(Debug)]
pub(super) struct Sensing {
    /// Standard deviation of the range, as a share of it.
    range_noise: f64,
    /// Standard deviation of the bearing, radians.
    bearing_noise: f64,
    draws: KeyedStreams,
}

impl Sensing {
    /// The sensor that `config` describes.
    pub fn new(config: &SensingConfig, streams: Streams) -> Self {
        Self {
            range_noise: config.range_noise.get(),
            bearing_noise: config.bearing_noise.get().to_radians(),
            draws: streams.keyed(SENSING),
        }
    }

    /// What the receiver of `copy` senses of a sender that is at `truth` relative to it.
    #[inline]
    pub fn displacement(&self, copy: FrameCopy, truth: Vec2) -> [f32; 2] {
        let sensed = if self.range_noise == 0.0 && self.bearing_noise == 0.0 {
            truth
        } else {
            self.disturbed(copy, truth)
        };
        [sensed.x as f32, sensed.y as f32]
    }

    /// `truth`, scaled and turned by the errors of `copy`. A range is never sensed below 0.
    fn disturbed(&self, copy: FrameCopy, truth: Vec2) -> Vec2 {
        let mut random = copy.stream(self.draws);
        let mut error = || -> f64 { StandardNormal.sample(&mut random) };
        let scale = (1.0 + self.range_noise * error()).max(0.0);
        let turn = unit(self.bearing_noise * error());
        Vec2::new(truth.x * turn.x - truth.y * turn.y, truth.x * turn.y + truth.y * turn.x) * scale
    }
}

//! What a scenario says of fading.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{NonNegative, Positive};

/// The largest ratio of Rician fading: 30 dB, where gains are within half a dB.
const LARGEST_K: f64 = 1000.0;
/// Shapes of Nakagami fading: below ½ there is none, and at 100 gains are within a dB.
const SHAPES: [f64; 2] = [0.5, 100.0];

/// Fading: what many ways of a signal add and take off, quickly varying over places. The power gain has a mean of 1.
///
/// It is a field over the places of both ends: while robots stand, it stands, unless a background `doppler` in Hz says how fast the surroundings move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FadingConfig {
    /// None: the gain is 1.
    #[default]
    None,
    /// No way is stronger than the others: the gain is exponential.
    Rayleigh {
        /// How fast a standing link changes, Hz: its autocorrelation is J0(2π · doppler · τ).
        #[serde(default = "still")]
        doppler: NonNegative,
    },
    /// One way is direct.
    Rician {
        /// Power of the direct way over that of all others, a plain ratio, at most 1000; 4 is usual in sight. 0 is Rayleigh.
        k: NonNegative,
        /// How fast a standing link changes, Hz.
        #[serde(default = "still")]
        doppler: NonNegative,
    },
    /// The gain follows a gamma law of shape `m`.
    ///
    /// Up to 4 in halves it is a sum of squares of independent normal fields, and everything about it is as theory has it. Any other `m` has the gains of the nearest of those, laid onto the law of
    /// its own one by one: how gains are distributed is exact, how they change over places and time is as with the other.
    Nakagami {
        /// Shape, 0.5 to 100: 1 is Rayleigh, more is milder.
        m: Positive,
        /// How fast a standing link changes, Hz.
        #[serde(default = "still")]
        doppler: NonNegative,
    },
}

fn still() -> NonNegative {
    NonNegative::new(0.0)
}

impl FadingConfig {
    /// What is wrong between fields that are each in range: the field, from here, variants left out, and why, with what would be right.
    #[must_use]
    pub fn problems(&self) -> Vec<(String, String)> {
        let [least, most] = SHAPES;
        let problem = match *self {
            Self::Rician { k, .. } if k.get() > LARGEST_K => {
                let message = format!(
                    "k {} is out of range: expected 0 to {LARGEST_K}, or None for no fading",
                    k.get()
                );
                Some(("k", message))
            }
            Self::Nakagami { m, .. } if !(least..=most).contains(&m.get()) => {
                let message = format!("m {} is out of range: expected {least} to {most}", m.get());
                Some(("m", message))
            }
            _ => None,
        };
        problem
            .into_iter()
            .map(|(field, message)| (field.to_owned(), message))
            .collect()
    }

    /// The background's Doppler frequency, Hz.
    pub(super) fn doppler(&self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Rayleigh { doppler } | Self::Rician { doppler, .. } | Self::Nakagami { doppler, .. } => doppler.get(),
        }
    }
}

//! What else is on air: jammers, and noise that is everywhere.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::{SimTime, Span};
use crate::geometry::Vec2;
use crate::quantity::{Finite, NonNegative, Positive};

/// What is on air beside what robots send.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum NoiseConfig {
    /// Noise of so much power everywhere, added to what receivers have of their own.
    Background {
        /// dBm in the receiver's bandwidth.
        power: Finite,
    },
    /// A sender of noise at one place. Carrier sense hears it, and no frame is told from it by capture.
    Jammer {
        /// Where it is, metres from the arena's centre.
        at: (Finite, Finite),
        /// What it sends with, dBm in the receivers' bandwidth.
        power: Finite,
        /// When it begins, seconds.
        #[serde(default = "at_once")]
        from: NonNegative,
        /// When it ends, seconds. `None`: with the run.
        #[serde(default)]
        until: Option<Positive>,
        /// For how long it is on and then off, again and again, seconds. `None`: it is on all the time.
        #[serde(default)]
        pulses: Option<(Positive, Positive)>,
    },
}

fn at_once() -> NonNegative {
    NonNegative::new(0.0)
}

/// The jammers of a run.
#[derive(Debug)]
pub(super) struct Jammers {
    jammers: Vec<Jammer>,
    background: f64,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jammer {
    pub position: Vec2,
    /// dBm.
    pub power: f64,
    from: SimTime,
    until: SimTime,
    pulses: Option<(Span, Span)>,
}

/// A jammer is on air in bursts of no more than this: who comes near meanwhile is jammed from the next one on.
const LONGEST: Span = Span::from_nanos(5_000_000);

impl Jammers {
    pub fn new(config: &[NoiseConfig]) -> Self {
        let mut jammers = Vec::new();
        let mut background = 0.0;
        for noise in config {
            match noise {
                NoiseConfig::Background { power } => background += super::receiver::milliwatts(power.get()),
                NoiseConfig::Jammer {
                    at,
                    power,
                    from,
                    until,
                    pulses,
                } => jammers.push(Jammer {
                    position: Vec2::new(at.0.get(), at.1.get()),
                    power: power.get(),
                    from: SimTime::from_secs(from.get()),
                    until: until.map_or(SimTime::NEVER, |until| SimTime::from_secs(until.get())),
                    pulses: pulses.map(|(on, off)| (Span::from_secs(on.get()), Span::from_secs(off.get()))),
                }),
            }
        }
        Self { jammers, background }
    }

    /// Noise that is everywhere, milliwatts.
    pub fn background(&self) -> f64 {
        self.background
    }

    /// When each begins.
    pub fn begin(&self) -> impl Iterator<Item = (u32, SimTime)> + '_ {
        (0..).zip(&self.jammers).map(|(place, jammer)| (place, jammer.from))
    }

    pub fn get(&self, place: u32) -> Jammer {
        self.jammers[place as usize]
    }
}

impl Jammer {
    /// Its burst that begins `now`: until when it lasts, and when the next begins, if one does.
    pub fn burst(&self, now: SimTime) -> (SimTime, Option<SimTime>) {
        let (ends, next) = match self.pulses {
            None => (now + LONGEST, now + LONGEST),
            Some((on, off)) => {
                let since = Span::from_nanos(now.since(self.from).as_nanos() % (on + off).as_nanos().max(1));
                let pulse_ends = now + Span::from_nanos(on.as_nanos().saturating_sub(since.as_nanos()));
                let ends = pulse_ends.min(now + LONGEST);
                (ends, if ends < pulse_ends { ends } else { pulse_ends + off })
            }
        };
        (ends.min(self.until), Some(next).filter(|next| *next < self.until))
    }
}

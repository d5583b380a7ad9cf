//! How long what has arrived waits until its receiver reads it.
//!
//! A robot reads whenever it wakes: at its control steps, a period P apart, and whenever the timer of its detector fires, for whichever
//! neighbour. The timer fires at the time at which, when it last fired, the first of its neighbours was due to be suspected. So from one
//! time to the next passes TO − max A, with A the ages of what was last heard of those n neighbours that are not suspected yet:
//!
//! P(longer than w) = G(w) = (P(A ≤ TO − w) / P(A ≤ TO))ⁿ.
//!
//! Taken as a renewal process, which has nothing to do with the steps nor with the arrival at hand, the wait is longer than w with
//! probability (1 − w/P) (1 − ∫₀ʷ G / ∫₀^TO G). What this leaves out, that times in a row depend on each other and a mistake begins with one, was
//! within a fifth of the wait, and within half of what timers take off P/2, in simulations of 1 to 30 neighbours, losses of 0 to 50 % and
//! timeouts of 1.2 to 40 intervals.

use super::scene::Scene;
use super::timeout::Timeout;
use crate::protocol::control::{PhaseConfig, WakeConfig};
use crate::radio::LossChain;

/// Share of the wait by which the formula may be off.
const OF_WAIT: f64 = 0.2;
/// Share of what timers take off the wait for a control step by which it may be off.
const OF_TIMERS: f64 = 0.5;
/// Parts of what is integrated.
const PARTS: u32 = 500;
/// Latencies that stand for all.
const QUANTILES: u32 = 200;
/// A chance that is as good as none.
const NONE: f64 = 1e-6;

/// From the arrival of a status until its receiver reads it, seconds.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// On average.
    pub mean: f64,
    /// How far off that may be.
    pub accuracy: f64,
}

impl Reading {
    /// Where robots run `detector` over links of `chain` and have so many `neighbours` on average, if that is known.
    pub fn of(scene: &Scene<'_>, detector: &Timeout, chain: LossChain, neighbours: Option<f64>) -> Self {
        let control = &scene.scenario.control;
        let period = scene.period_s();
        if control.wake == WakeConfig::OnReception {
            return Self {
                mean: 0.0,
                accuracy: 0.0,
            };
        }
        let timer = neighbours.map(|neighbours| Timer::of(detector, chain, neighbours));
        match (control.phase, timer) {
            (PhaseConfig::Random, Some(timer)) => {
                let mean = timer.wait(period);
                Self {
                    mean,
                    accuracy: (OF_WAIT * mean).min(OF_TIMERS * (period / 2.0 - mean).max(0.0)),
                }
            }
            (PhaseConfig::Random, None) => between(0.0, period / 2.0),
            (PhaseConfig::Together, timer) => {
                let step = at_next_step(scene, period);
                // All statuses arrive at once, but for what their latencies differ, and all that makes the timer fire does so that long after.
                let fires = detector.after_arrival();
                if fires >= step {
                    return Self {
                        mean: step,
                        accuracy: 0.0,
                    };
                }
                timer.map_or(between(fires, step), |timer| {
                    let sooner = (detector.interval() / timer.mean).min(1.0) * (step - fires);
                    Self {
                        mean: step - sooner,
                        accuracy: sooner / 2.0,
                    }
                })
            }
        }
    }
}

/// Anything from the one to the other.
fn between(least: f64, most: f64) -> Reading {
    Reading {
        mean: f64::midpoint(least, most),
        accuracy: (most - least) / 2.0,
    }
}

/// Until the next control step, where all robots take theirs at once: sent at one and read at another.
fn at_next_step(scene: &Scene<'_>, period: f64) -> f64 {
    let latencies = scene.scenario.radio.disk().latency.quantiles(QUANTILES);
    let waits = latencies.iter().map(|latency| {
        let steps = (latency / period - 1e-9).ceil().max(1.0);
        steps * period - latency
    });
    waits.sum::<f64>() / latencies.len() as f64
}

/// When the timer of a robot's detector fires.
struct Timer<'a> {
    detector: &'a Timeout,
    chain: LossChain,
    /// Neighbours that are not suspected, beside the one whose status waits.
    others: f64,
    /// P(A ≤ TO).
    trusted: f64,
    /// From one time to the next on average, seconds.
    mean: f64,
}

impl<'a> Timer<'a> {
    fn of(detector: &'a Timeout, chain: LossChain, neighbours: f64) -> Self {
        let trusted = 1.0 - detector.is_older(chain, detector.silence());
        let mut timer = Self {
            detector,
            chain,
            others: (neighbours - 1.0).max(0.0) * trusted,
            trusted,
            mean: 0.0,
        };
        // Beyond an age that nobody reaches G is 1.
        let mut old = detector.interval().min(detector.silence());
        while old < detector.silence() && detector.is_older(chain, old) > NONE {
            old = (2.0 * old).min(detector.silence());
        }
        let width = old / f64::from(PARTS);
        let young = |part| timer.longer(detector.silence() - (f64::from(part) + 0.5) * width) * width;
        timer.mean = (0..PARTS).map(young).sum::<f64>() + detector.silence() - old;
        timer
    }

    /// G(w).
    fn longer(&self, wait: f64) -> f64 {
        let younger = 1.0 - self.detector.is_older(self.chain, self.detector.silence() - wait);
        if self.trusted > 0.0 {
            (younger / self.trusted).clamp(0.0, 1.0).powf(self.others)
        } else {
            1.0
        }
    }

    /// Until it fires or a control step comes, of which there is one every `period`, on average.
    fn wait(&self, period: f64) -> f64 {
        let width = period / f64::from(PARTS);
        let (mut passed, mut mean) = (0.0, 0.0);
        for part in 0..PARTS {
            let wait = (f64::from(part) + 0.5) * width;
            passed += self.longer(wait) * width;
            let silent = (1.0 - passed / self.mean).max(0.0);
            mean += (1.0 - wait / period) * silent * width;
        }
        mean
    }
}

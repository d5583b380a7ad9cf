//! The radio against closed forms, each model on its own.
//!
//! # The arithmetic of the tolerances
//! A measured figure must lie within four standard errors of its closed form, and the standard error is the closed
//! form's too, never one that was tuned: a right model fails such a check once in 16,000 seeds, and the seed is fixed,
//! so a check that passes goes on passing. Whole distributions are held against Kolmogorov–Smirnov or chi-square
//! limits of the same significance. What makes up each standard error is said where it is computed.

mod latency;
mod loss;
mod sensing;
mod statistics;
mod timeouts;

use std::collections::BTreeMap;

use desim::engine::{ActorId, SimTime, Span, Streams};
use desim::geometry::Vec2;
use desim::quantity::{NonNegative, Positive, Probability};
use desim::radio::{
    Disk, Fate, Fates, FrameId, LatencyConfig, Listener, LossConfig, Medium, RadioConfig, Transmission,
};

/// Time between two frames of a sender.
const INTERVAL: f64 = 0.1;

fn probability(value: f64) -> Probability {
    Probability::new(value)
}

fn non_negative(value: f64) -> NonNegative {
    NonNegative::new(value)
}

fn positive(value: f64) -> Positive {
    Positive::new(value)
}

/// Gilbert's own model: every bad frame is lost, no good one.
fn gilbert(good_to_bad: f64, bad_to_good: f64) -> LossConfig {
    gilbert_elliott([good_to_bad, bad_to_good], [0.0, 1.0])
}

fn gilbert_elliott([good_to_bad, bad_to_good]: [f64; 2], [good_loss, bad_loss]: [f64; 2]) -> LossConfig {
    LossConfig::GilbertElliott {
        good_to_bad: probability(good_to_bad),
        bad_to_good: probability(bad_to_good),
        good_loss: probability(good_loss),
        bad_loss: probability(bad_loss),
    }
}

/// A radio that loses frames by `loss` and delivers the others at once.
fn losing(loss: LossConfig) -> RadioConfig {
    RadioConfig {
        loss,
        latency: LatencyConfig::Constant(non_negative(0.0)),
        ..RadioConfig::default()
    }
}

/// A disk radio, and for each robot the number of its next frame.
struct Channel {
    disk: Disk,
    numbers: Vec<u32>,
}

impl Channel {
    /// Hands the next frame of `sender` over at `at`, and calls `receive` for each of `listeners`.
    fn transmit(
        &mut self,
        at: SimTime,
        sender: ActorId,
        listeners: impl Iterator<Item = Listener>,
        mut receive: impl FnMut(ActorId, Fate),
    ) {
        let listeners: Vec<Listener> = listeners.collect();
        let number = &mut self.numbers[sender.index()];
        let frame = Transmission {
            at,
            frame: FrameId::new(sender, *number),
            bytes: 9,
            to: None,
            position: Vec2::zeros(),
            listeners: &listeners,
        };
        *number += 1;
        let mut fates = Fates::default();
        self.disk.transmit(&frame, &Vec::new(), &mut fates);
        let fates: BTreeMap<ActorId, Fate> = fates.drain().collect();
        for listener in listeners {
            receive(listener.id, fates[&listener.id]);
        }
    }
}

fn medium(config: &RadioConfig, robots: u32) -> Channel {
    Channel {
        disk: Disk::new(config, &Streams::new(20_260_101, 0), robots as usize),
        numbers: vec![0; robots as usize],
    }
}

/// Robots `ids`, each with the sender at `distance` metres.
fn listeners(ids: std::ops::Range<u32>, distance: f64) -> impl Iterator<Item = Listener> {
    ids.map(move |id| Listener {
        id: ActorId(id),
        sender: Vec2::new(distance, 0.0),
    })
}

/// When frame number `frame` is sent.
fn sent(frame: u32) -> SimTime {
    SimTime::ZERO + Span::from_secs(INTERVAL) * u64::from(frame)
}

/// What became of `frames` frames from robot 0 at each of `receivers` robots, 1 m away: by receiver, then by frame.
fn fates(config: &RadioConfig, receivers: u32, frames: u32) -> Vec<Vec<Fate>> {
    let mut medium = medium(config, receivers + 1);
    let mut fates = vec![Vec::with_capacity(frames as usize); receivers as usize];
    for frame in 0..frames {
        medium.transmit(sent(frame), ActorId(0), listeners(1..receivers + 1, 1.0), |id, fate| {
            fates[id.index() - 1].push(fate);
        });
    }
    fates
}

/// As [`fates`]: which frames were lost.
fn losses(loss: &LossConfig, receivers: u32, frames: u32) -> Vec<Vec<bool>> {
    let dropped = |link: Vec<Fate>| link.iter().map(|fate| matches!(fate, Fate::Lost(_))).collect();
    fates(&losing(loss.clone()), receivers, frames)
        .into_iter()
        .map(dropped)
        .collect()
}

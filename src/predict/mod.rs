//! What closed forms say of a scenario before it is run, and where a run then disagrees with them.
//!
//! [`Preflight::of`] needs no randomness and no time to speak of. Each [`Prediction`] says what it takes for granted, how
//! near it claims to be, and of what part of a run it is true; what no closed form here covers is in
//! [`Preflight::not_predicted`], with the reason. The closed forms of a model live with it ([`crate::motion::Spacing`],
//! [`crate::radio::LossChain`]); those in which models meet are here. [`surprises`] holds them against the figures of a run.

mod air;
mod compare;
mod detection;
mod reading;
mod scene;
mod swarm;
mod timeout;
mod traffic;

pub use compare::{Surprise, surprises};

use serde::Serialize;

pub use crate::kind::{Holds, Prediction, Unpredicted};

use crate::scenario::Scenario;
use scene::Scene;

/// What is expected of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Preflight {
    /// Name of the scenario.
    pub scenario: String,
    /// What closed forms say, in the order in which a reader asks.
    pub predictions: Vec<Prediction>,
    /// What they do not.
    pub not_predicted: Vec<Unpredicted>,
}

impl Preflight {
    /// What is expected of `scenario`, which holds.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self::lasting(scenario, scenario.time_limit.get())
    }

    /// What is expected of trials that last `duration_s` seconds.
    fn lasting(scenario: &Scenario, duration_s: f64) -> Self {
        let scene = Scene::of(scenario, duration_s);
        let mut preflight = Self {
            scenario: scenario.name.clone(),
            predictions: Vec::new(),
            not_predicted: Vec::new(),
        };
        if scenario.radio.shared().is_some() {
            air::predict(&scene, &mut preflight);
            return preflight;
        }
        swarm::predict(&scene, &mut preflight);
        traffic::predict(&scene, &mut preflight);
        detection::predict(&scene, &mut preflight);
        preflight
    }

    /// The prediction of that name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Prediction> {
        self.predictions.iter().find(|prediction| prediction.name == name)
    }

    fn refuse(&mut self, name: &'static str, what: &'static str, why: impl Into<String>) {
        self.not_predicted.push(Unpredicted {
            name,
            what,
            why: why.into(),
        });
    }
}

//! What closed forms say of a scenario before it is run, and where a run then disagrees with them.
//!
//! [`Preflight::of`] needs no randomness and no time to speak of. Each [`Prediction`] says what it takes for granted, how
//! near it claims to be, and of what part of a run it is true; what no closed form here covers is in
//! [`Preflight::not_predicted`], with the reason. The closed forms of a model live with it ([`crate::motion::Spacing`],
//! [`crate::radio::LossChain`]); those in which models meet are here. [`surprises`] holds them against the figures of a run.

mod compare;
mod detection;
mod reading;
mod scene;
mod swarm;
mod timeout;
mod traffic;

pub use compare::{Surprise, surprises};

use serde::Serialize;

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

/// A figure expected of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Its stable name, in the manner of `summary.json`.
    pub name: &'static str,
    /// What it is, in a few words.
    pub what: &'static str,
    /// The figure.
    pub value: f64,
    /// Its unit; `"1"` where it has none.
    pub unit: &'static str,
    /// How far off the closed form may be of what it describes, in the same unit: end effects of a run as long as the time limit,
    /// what a formula leaves out. 0 where it is exact.
    pub accuracy: f64,
    /// Of what part of a run it is true.
    pub holds: Holds,
    /// The formula.
    pub formula: &'static str,
    /// What it takes for granted.
    pub assumes: String,
}

/// Of what part of a run a prediction is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Holds {
    /// Of all of it.
    Throughout,
    /// Of its beginning, before robots have moved.
    AtStart,
    /// Of robots that stay in range of each other.
    InRange,
    /// Of the formation that the mission ends in.
    AtEnd,
}

/// A figure that no closed form here covers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unpredicted {
    /// Its stable name.
    pub name: &'static str,
    /// What it is, in a few words.
    pub what: &'static str,
    /// Why not.
    pub why: String,
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

#[cfg(test)]
mod tests;

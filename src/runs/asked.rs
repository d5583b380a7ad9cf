//! What is to be run.

use serde::{Deserialize, Serialize};

use crate::export::Pictures;
use crate::scenario::{Plan, Scenario};

/// A scenario that is to be run.
#[derive(Clone, Debug)]
pub struct ScenarioRun<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The question that it asks, for the manifest.
    pub question: Option<String>,
    /// Of which trials there are pictures.
    pub pictures: Pictures,
}

impl<'a> ScenarioRun<'a> {
    /// The trials of `scenario`, with pictures of the first.
    #[must_use]
    pub fn of(scenario: &'a Scenario) -> Self {
        Self {
            scenario,
            question: None,
            pictures: Pictures::First,
        }
    }
}

/// A study that is to be run.
#[derive(Clone, Debug)]
pub struct StudyRun<'a> {
    /// The settings, and the figures to compare.
    pub plan: &'a Plan,
    /// Until when trials are added; `None` for as many as the plan says.
    pub until: Option<Until>,
}

/// Trials are added until intervals are narrow enough.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Until {
    /// How wide the interval of the first figure may be in every setting, in the figure's unit.
    pub width: f64,
    /// Most trials of a setting.
    pub most_trials: u32,
}

impl<'a> StudyRun<'a> {
    /// All trials of `plan`.
    #[must_use]
    pub fn of(plan: &'a Plan) -> Self {
        Self { plan, until: None }
    }
}

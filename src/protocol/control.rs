//! When robots wake.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Positive;

/// When robots wake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ControlConfig {
    /// Seconds between the control steps of a robot (paper table 1: dt = 0.1 s).
    pub period: Positive,
    /// How the robots' control steps lie against each other.
    pub phase: PhaseConfig,
    /// What wakes a robot beside its control step and its timers.
    pub wake: WakeConfig,
}

impl Default for ControlConfig {
    fn default() -> Self {
        Self {
            period: Positive::new(0.1),
            phase: PhaseConfig::Together,
            wake: WakeConfig::ControlStep,
        }
    }
}

/// How the robots' control steps lie against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum PhaseConfig {
    /// All at once (the paper's simulator).
    Together,
    /// Each robot at its own random phase, drawn once a trial.
    Random,
}

/// What wakes a robot beside its control step and its timers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum WakeConfig {
    /// Nothing: frames wait in the inbox.
    ControlStep,
    /// Every arrival of a frame.
    OnReception,
}

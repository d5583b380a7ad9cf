//! Failures of robots and of links: a pure state machine, told the time, roles and places, that says what changed.
//!
//! [`Faults`] asks to be called at [`Faults::next`], and never if nothing can fail. What happens at an instant happens
//! before any robot wakes then. The run obeys: it sends nothing for a robot whose [`Health`] says that it cannot send,
//! loses what reaches one that cannot hear, and wakes none that has stopped.
//!
//! Every draw is keyed by the fault's place in the scenario, the robot and the occasion, and a setting only moves the
//! threshold that a draw is compared with. So robots that are fallible at a share of 0.2 are also at 0.5, and one that
//! fails at a hazard fails no later at a greater one, as long as it is exposed to the same.

mod config;
mod link;
mod robot;
mod rules;
mod state;
mod warnings;

#[cfg(test)]
mod tests;

pub use config::{
    BurstConfig, ChosenConfig, Effect, FallibleConfig, FaultConfig, IntervalConfig, LastsConfig, LinksConfig,
    OnJoinConfig, PartitionConfig, PlannedConfig, RadiationConfig, RegionConfig, RobotsConfig, WhenConfig,
};
pub use link::LinkFaultKind;
pub use rules::problems;
pub use state::{Change, Faults, Health, Subject};
pub use warnings::{Stage, warnings};

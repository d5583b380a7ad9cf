//! desim: an actor-based discrete-event network simulator for robot swarms.

pub mod cli;
pub mod engine;
pub mod experiment;
pub mod export;
pub mod geometry;
pub mod metrics;
pub mod motion;
pub mod protocol;
pub mod quantity;
pub mod radio;
pub mod report;
pub mod scenario;
pub mod simulation;

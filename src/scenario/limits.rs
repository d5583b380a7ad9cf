//! Bounds that keep every accepted scenario within the memory and time of one machine.

/// Robots of a swarm.
pub const ROBOTS: u32 = 1_000_000;
/// Trials of a scenario.
pub const TRIALS: u32 = 1_000_000;
/// Letters of a scenario's name: it names a folder.
pub const NAME: usize = 64;
/// Simulated seconds of a trial: thirty years.
pub const SECONDS: f64 = 1e9;
/// Shortest period of anything that repeats, seconds. Virtual time counts nanoseconds.
pub const SHORTEST_PERIOD: f64 = 1e-6;
/// Motion ticks, or control steps of a robot, in a trial.
pub const STEPS: f64 = 1e8;
/// Control steps of all robots in a trial.
pub const ROBOT_STEPS: f64 = 1e10;
/// Positions kept of a trial, robots times samples.
pub const SAMPLED_POSITIONS: f64 = 1e8;
/// Copies of frames under way at once: robots times robots in range times messages within a latency.
pub const COPIES: f64 = 1e8;
/// Settings of a study.
pub const SETTINGS: usize = 1000;
/// Bytes of a scenario file.
pub const FILE: u64 = 64 << 20;
/// Diagnostics of one file: more are of no help.
pub const DIAGNOSTICS: usize = 20;

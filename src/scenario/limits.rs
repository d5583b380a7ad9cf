//! Bounds that keep every accepted scenario within the memory and time of one machine.

/// Robots of a swarm.
pub const ROBOTS: u32 = 1_000_000;
/// Trials of a scenario.
pub const TRIALS: u32 = 1_000_000;
/// Letters of a scenario's name: it names a folder.
pub const NAME: usize = 64;
/// Simulated seconds of a trial: thirty years.
pub const SECONDS: f64 = 1e9;
/// Width and height of an arena, metres: a million kilometres, which tables of 32-bit numbers hold many times.
pub const METRES: f64 = 1e9;
/// Shortest period of anything that repeats, seconds. Virtual time counts nanoseconds.
pub const SHORTEST_PERIOD: f64 = 1e-6;
/// By how many parts in a million clocks are wrong at most.
pub const CLOCK_DRIFT: f64 = 1e5;
/// Motion ticks, or control steps of a robot, in a trial.
pub const STEPS: f64 = 1e8;
/// Control steps of all robots in a trial.
pub const ROBOT_STEPS: f64 = 1e10;
/// Bytes of memory that a trial may take by the estimate, and those from which it is warned of.
pub const MEMORY: f64 = 16e9;
/// See [`MEMORY`].
pub const MUCH_MEMORY: f64 = 2e9;
/// Events of a trial by the estimate: a processor takes about a day for 1e12.
pub const EVENTS: f64 = 1e13;
/// Events of all trials together from which they are warned of.
pub const MANY_EVENTS: f64 = 1e12;
/// Settings of a study.
pub const SETTINGS: usize = 1000;
/// Bytes of a scenario file.
pub const FILE: u64 = 64 << 20;
/// Diagnostics of one file: more are of no help.
pub const DIAGNOSTICS: usize = 20;

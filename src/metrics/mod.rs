//! What a run leaves behind: traffic, fates, connectivity, outcome, and the statistics over trials.

mod config;
mod latency;
mod record;

pub use config::MetricsConfig;
pub use latency::LatencyHistogram;
pub use record::{ConnectivitySample, Outcome, RobotState, TopicFates, TrafficRow, TrialRecord, Volume};

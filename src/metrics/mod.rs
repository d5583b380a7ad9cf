//! What a run leaves behind: traffic, fates, connectivity, outcome, and the statistics over trials.

mod air;
mod asked;
pub mod comparison;
mod completion;
mod config;
mod connectivity;
pub mod detection;
mod episode;
mod faults;
pub mod figures;
mod healing;
mod latency;
mod mission;
mod noted;
mod noted_figure;
mod pairs;
mod record;
mod recorder;
mod reports;
mod series;
mod spread;
pub mod summary;
mod traffic;
mod unit;
mod volume;

pub use crate::statistics::Estimate;
pub use air::{AirRecord, Copies, DistanceBand, ENERGY_STATES, LinkRecord, RobotAir, Waits};
pub use asked::{Asked, DegreeSample, DelayEntry, DeliveryBand, Hop, RoleChange, TrafficEntry};
pub use completion::Progress;
pub use config::{AskedTable, MetricsConfig};
pub use connectivity::{Chains, Graph};
pub use episode::{FaultEpisode, FaultKind, HealingEpisode};
pub use latency::LatencyHistogram;
pub use mission::{Mission, MissionTarget, Ties};
pub use noted::{Amount, Noted, Values};
pub use noted_figure::NotedFigure;
pub use pairs::{MEASURES as PAIR_MEASURES, PairMeasure, PairRecord};
pub use record::{
    ConnectivitySample, Lists, Outcome, RobotBytes, RobotState, SeriesEntry, TargetSample, TargetState, TrialRecord,
};
pub use recorder::{Layout, Recorder, RunEnd};
pub use spread::RumorSpread;
pub use summary::Summary;
pub use traffic::HeaderBytes;
pub use volume::{TopicFates, TrafficRow, Volume};

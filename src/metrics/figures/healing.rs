//! Healing: how long failures do harm, and how often it is mended.

use super::figure::Better;
use super::registry::Registry;
use crate::engine::SimTime;
use crate::metrics::episode::HealingEpisode;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::DIMENSIONLESS;
use crate::statistics::{Estimator, Observation, Times};

pub(super) fn declare(registry: &mut Registry) {
    let harmful = |record: &TrialRecord| {
        let episodes = record.healing.iter().filter(|episode| episode.is_harmful());
        let seen: Times = episodes.map(|episode| mending(episode, record.simulated)).collect();
        seen
    };
    registry.add_times("healing.unmended_s", "time unmended, a failure", harmful);
    registry.add_ratio(
        "healing.healed_ratio",
        "failures healed",
        (DIMENSIONLESS, Better::Higher, Estimator::ShareOf),
        move |record| {
            let seen = harmful(record);
            [
                seen.iter().filter(|seen| seen.happened).count() as f64,
                seen.len() as f64,
            ]
        },
    );
}

/// How long the harm of a failure lasted, or was watched in vain until the trial's end, seconds.
pub(in crate::metrics) fn mending(episode: &HealingEpisode, end: SimTime) -> Observation {
    Observation {
        time: episode.healed_at.unwrap_or(end).since(episode.failed_at).as_secs(),
        happened: episode.healed_at.is_some(),
    }
}

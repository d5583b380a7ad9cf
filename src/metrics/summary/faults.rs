//! What failed, and how targets got their links back.

use serde::{Deserialize, Serialize};

use crate::engine::SimTime;
use crate::metrics::episode::{FaultKind, HealingEpisode};
use crate::metrics::figures::mending;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{SECONDS, Unit};
use crate::statistics::{Estimate, Estimator, Observation, Part, Times, median_survival, pseudo_values};

use super::estimates::mean_count;
use super::quantity::{Lasted, Measured, Named};

/// What failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaultSummary {
    /// Robots that failed at some time of a trial: mean over trials.
    pub robots: Measured,
    /// Failures of robots over all trials, by the robot's role at the time.
    pub by_role: Named<u64>,
    /// Failures of links over all trials.
    pub links: u64,
}

/// How targets got their links back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HealingSummary {
    /// Of all failures that cost a target a link or its worker.
    #[serde(flatten)]
    pub total: Healed,
    /// Failures of robots that worked for a target and cost it nothing, since the chains it needed were whole, or it had
    /// none yet.
    pub harmless: u64,
    /// By the role of the robot that failed.
    pub by_role: Named<Healed>,
    /// By whether harm from other failures to the same target was unmended meanwhile: `alone`, `overlapping`.
    pub by_overlap: Named<Healed>,
}

/// Harm and its mending. Means are over failures, their intervals over trials; that of the median takes failures as independent, also
/// those of one trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Healed {
    /// Failures that did harm.
    pub failures: u64,
    /// Those whose harm was mended before the trial ended.
    pub healed: u64,
    /// From the failure until its harm was mended.
    pub time: HealingTime,
    /// Way of the robots of the target's chains meanwhile, mean over mended failures; what the end cut off is not among them.
    pub distance: Measured,
    /// Frames that robots of the target's chains sent meanwhile, by topic, mean over mended failures.
    pub frames: Named<Measured>,
}

/// Time to heal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HealingTime {
    /// Kaplan–Meier median; harm that was not mended by the end of its trial is censored. `n` counts failures.
    pub median: Estimate,
    /// The mean, what was not mended counted as cut off.
    pub mean: Lasted,
    /// Always `"s"`.
    pub unit: Unit,
}

impl FaultSummary {
    /// What failed in `records`, by these names of `roles`; `None` if nothing did.
    pub(super) fn of(roles: &[&str], records: &[TrialRecord]) -> Option<Self> {
        let failures_of = |wanted: usize| {
            let kinds = records
                .iter()
                .flat_map(|record| &record.faults)
                .map(|fault| &fault.kind);
            kinds
                .filter(|kind| matches!(kind, FaultKind::Robot { role, .. } if usize::from(*role) == wanted))
                .count() as u64
        };
        let all = records.iter().flat_map(|record| &record.faults);
        let links = all
            .filter(|fault| !matches!(fault.kind, FaultKind::Robot { .. }))
            .count() as u64;
        records.iter().any(|record| !record.faults.is_empty()).then(|| Self {
            robots: Measured {
                estimate: mean_count(records, |record| record.failed_robots().len() as f64),
                unit: "robots".into(),
            },
            by_role: Named::of(roles.iter().copied(), failures_of),
            links,
        })
    }
}

/// A failure and the end of its trial.
type Case<'a> = (&'a HealingEpisode, SimTime);

impl HealingSummary {
    /// How targets healed in `records`, by these names; `None` if no robot failed that worked for a target.
    pub(super) fn of<'a>(topics: &[&str], roles: &[&str], records: &'a [TrialRecord]) -> Option<Self> {
        let cases = || {
            records
                .iter()
                .flat_map(|record| record.healing.iter().map(|episode| (episode, record.simulated)))
        };
        let harmful = |belongs: &dyn Fn(&HealingEpisode) -> bool| {
            let of_trial = |record: &'a TrialRecord| -> Vec<Case> {
                let episodes = record.healing.iter().map(|episode| (episode, record.simulated));
                episodes
                    .filter(|(episode, _)| episode.is_harmful() && belongs(episode))
                    .collect()
            };
            Healed::of(topics, &records.iter().map(of_trial).collect::<Vec<_>>())
        };
        cases().next()?;
        Some(Self {
            total: harmful(&|_| true),
            harmless: cases().filter(|(episode, _)| !episode.is_harmful()).count() as u64,
            by_role: Named::of(roles.iter().copied(), |role| {
                harmful(&|episode| usize::from(episode.role) == role)
            }),
            by_overlap: Named::of(["alone", "overlapping"], |place| {
                harmful(&|episode| (episode.overlapping > 0) == (place == 1))
            }),
        })
    }
}

impl Healed {
    fn of(topics: &[&str], trials: &[Vec<Case>]) -> Self {
        let times: Vec<Times> = trials
            .iter()
            .map(|cases| cases.iter().map(|(episode, end)| mending(episode, *end)).collect())
            .collect();
        let observations: Vec<Observation> = times.iter().flat_map(Times::iter).collect();
        let of_trial = |cases: &Vec<Case>, figure: &dyn Fn(&HealingEpisode) -> f64| -> Part {
            let mended = cases.iter().filter(|(episode, _)| episode.healed_at.is_some());
            mended.fold([0.0; 2], |[sum, count], (episode, _)| {
                [sum + figure(episode), count + 1.0]
            })
        };
        let measured = |figure: &dyn Fn(&HealingEpisode) -> f64, unit: &'static str| Measured {
            estimate: Estimator::Count
                .estimate(&trials.iter().map(|cases| of_trial(cases, figure)).collect::<Vec<_>>()),
            unit: unit.into(),
        };
        let (parts, lasting) = pseudo_values(&times);
        Self {
            failures: observations.len() as u64,
            healed: observations.iter().filter(|seen| seen.happened).count() as u64,
            time: HealingTime {
                median: median_survival(&observations),
                mean: Lasted {
                    estimate: Estimator::Times.estimate(&parts).at_most(lasting.restricted_to),
                    cut_off: lasting.cut_off,
                    restricted_to: lasting.restricted_to,
                    unit: SECONDS.into(),
                },
                unit: SECONDS.into(),
            },
            distance: measured(&|episode| episode.distance_m, "m"),
            frames: Named::of(topics.iter().copied(), |topic| {
                measured(&|episode| episode.frames[topic] as f64, "frames")
            }),
        }
    }
}

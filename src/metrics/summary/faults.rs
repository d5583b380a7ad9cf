//! What failed, and how targets got their links back.

use serde::{Deserialize, Serialize};

use crate::engine::SimTime;
use crate::metrics::episode::{FaultKind, HealingEpisode};
use crate::metrics::figures::mending;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{SECONDS, Unit};
use crate::spool::{Columns, Scratch};
use crate::statistics::{Estimate, Estimator, Observation, Part, Times, median_survival, pseudo_values_in_a_row};

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

/// What failed, over the trials that were counted.
#[derive(Debug, Default)]
pub(super) struct Failed {
    /// Robots of each trial.
    robots: Vec<f64>,
    by_role: Vec<u64>,
    links: u64,
}

impl Failed {
    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        self.robots.push(record.failed_robots().len() as f64);
        for fault in &record.faults {
            let FaultKind::Robot { role, .. } = fault.kind else {
                self.links += 1;
                continue;
            };
            let role = usize::from(role);
            self.by_role.resize(self.by_role.len().max(role + 1), 0);
            self.by_role[role] += 1;
        }
    }
}

impl FaultSummary {
    /// What `failed`, by these names of `roles`; `None` if nothing did.
    pub(super) fn of(roles: &[&str], failed: &Failed) -> Option<Self> {
        let robots = failed.robots.iter().map(|robots| [*robots, 1.0]);
        (failed.links > 0 || !failed.by_role.is_empty()).then(|| Self {
            robots: Measured {
                estimate: Estimator::Count.estimate(&robots.collect::<Vec<_>>()),
                unit: "robots".into(),
            },
            by_role: Named::of(roles.iter().copied(), |role| {
                failed.by_role.get(role).copied().unwrap_or(0)
            }),
            links: failed.links,
        })
    }
}

/// What failures did, over the trials that were counted.
#[derive(Debug)]
pub(super) struct Healings {
    harmless: u64,
    total: Harm,
    by_role: Vec<Harm>,
    /// Of those alone, and of those that overlapped.
    by_overlap: [Harm; 2],
}

impl Healings {
    /// None yet, of so many topics and roles.
    pub fn new(topics: usize, roles: usize) -> Self {
        Self {
            harmless: 0,
            total: Harm::new(topics),
            by_role: (0..roles).map(|_| Harm::new(topics)).collect(),
            by_overlap: [0; 2].map(|_| Harm::new(topics)),
        }
    }

    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        let (harmful, harmless): (Vec<_>, Vec<_>) = record.healing.iter().partition(|episode| episode.is_harmful());
        self.harmless += harmless.len() as u64;
        let count = |harm: &mut Harm, belongs: &dyn Fn(&HealingEpisode) -> bool| {
            let own = harmful.iter().copied().filter(|episode| belongs(episode));
            harm.count(&own.collect::<Vec<_>>(), record.simulated);
        };
        count(&mut self.total, &|_| true);
        for (role, harm) in self.by_role.iter_mut().enumerate() {
            count(harm, &|episode| usize::from(episode.role) == role);
        }
        for (place, harm) in self.by_overlap.iter_mut().enumerate() {
            count(harm, &|episode| (episode.overlapping > 0) == (place == 1));
        }
    }
}

/// Failures that did harm, of the trials that have any: the others tell nothing.
#[derive(Debug)]
struct Harm {
    topics: usize,
    /// How long each was unmended, one trial after another.
    times: Times,
    /// How many each trial has.
    counts: Vec<u32>,
    /// Of those that each trial mended: how many, the way meanwhile, the frames on each topic.
    mended: Columns,
}

impl Harm {
    fn new(topics: usize) -> Self {
        Self {
            topics,
            times: Times::default(),
            counts: Vec::new(),
            mended: Columns::new(2 + topics, &Scratch::default()),
        }
    }

    /// Takes in those of a trial that ended at `end`.
    fn count(&mut self, episodes: &[&HealingEpisode], end: SimTime) {
        if episodes.is_empty() {
            return;
        }
        self.counts.push(episodes.len() as u32);
        self.times.extend(episodes.iter().map(|episode| mending(episode, end)));
        let mended = || episodes.iter().filter(|episode| episode.healed_at.is_some());
        let sum = |figure: &dyn Fn(&HealingEpisode) -> f64| mended().fold(0.0, |sum, episode| sum + figure(episode));
        let frames = (0..self.topics).map(|topic| sum(&|episode| episode.frames[topic] as f64));
        let first = [mended().count() as f64, sum(&|episode| episode.distance_m)];
        self.mended.push(first.into_iter().chain(frames));
    }
}

impl HealingSummary {
    /// How targets healed, by these names; `None` if no robot failed that worked for a target.
    pub(super) fn of(topics: &[&str], roles: &[&str], healings: &Healings) -> Option<Self> {
        let healed = |harm: &Harm| Healed::of(topics, harm);
        let total = healed(&healings.total);
        (total.failures + healings.harmless > 0).then(|| Self {
            total,
            harmless: healings.harmless,
            by_role: Named::of(roles.iter().copied(), |role| healed(&healings.by_role[role])),
            by_overlap: Named::of(["alone", "overlapping"], |place| healed(&healings.by_overlap[place])),
        })
    }
}

impl Healed {
    fn of(topics: &[&str], harm: &Harm) -> Self {
        let observations: Vec<Observation> = harm.times.iter().collect();
        let counts = harm.mended.column(0);
        let measured = |column: usize, unit: &'static str| {
            let sums = harm.mended.column(column).into_iter();
            let parts: Vec<Part> = sums.zip(&counts).map(|(sum, count)| [sum, *count]).collect();
            Measured {
                estimate: Estimator::Count.estimate(&parts),
                unit: unit.into(),
            }
        };
        let (parts, lasting) = pseudo_values_in_a_row(&harm.times, harm.counts.iter().map(|count| *count as usize));
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
            distance: measured(1, "m"),
            frames: Named::of(topics.iter().copied(), |topic| measured(2 + topic, "frames")),
        }
    }
}

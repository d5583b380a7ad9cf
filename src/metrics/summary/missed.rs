//! Why missions failed: which targets were missed, for how long, and what stood in the way. It follows from the samples.

use serde::{Deserialize, Serialize};

use super::quantity::Named;
use crate::engine::{SimTime, Span};
use crate::metrics::record::{ConnectivitySample, Outcome, TargetState, TrialRecord};

/// What stood in the way, by the names of `summary.json`.
const WHY: [&str; 5] = ["no_worker", "held_up", "on_its_way", "links_short", "too_late"];
/// A worker whose way shrank by so much over the last tenth of a trial was still on it.
const SHRINKS: f64 = 0.95;

/// Why missions failed, over the trials that did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissedSummary {
    /// Trials that did not complete their mission, and were sampled.
    pub failed: u64,
    /// How long they lasted, median over them, seconds.
    pub lasted_s: f64,
    /// Live robots at their end, median over them.
    pub robots_alive: f64,
    /// The targets for which they failed, in order.
    pub targets: Vec<MissedTarget>,
}

/// A target for which missions failed: it was never held, or, where all were at some time, not at the end; or, where all were
/// then, it was held last, and not for long enough.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissedTarget {
    /// Number of the target, from 0.
    pub target: u32,
    /// Failed trials in which it was missed. What follows is over them.
    pub trials: u64,
    /// How long it was not held, all together, median, seconds.
    pub missed_s: f64,
    /// Trials by what stood in its way at last: `no_worker`; `held_up`: its worker came no nearer; `on_its_way`: its worker still came
    /// nearer; `links_short`: its worker was there, and had too few links; `too_late`: it was held, and not for long enough.
    pub why: Named<u64>,
    /// The most links it had in the end, where links were short: median.
    pub links: Option<f64>,
    /// How near a worker ever was, median, metres; absent where there never was one.
    pub nearest_m: Option<f64>,
    /// How near one was at the end, median, metres; absent where there was none.
    pub at_end_m: Option<f64>,
}

/// A target in one failed trial.
struct Miss {
    target: usize,
    missed_s: f64,
    why: usize,
    links: Option<f64>,
    nearest_m: Option<f64>,
    at_end_m: Option<f64>,
}

/// A trial that failed, and for which targets.
pub(super) struct FailedTrial {
    lasted_s: f64,
    robots_alive: f64,
    misses: Vec<Miss>,
}

impl FailedTrial {
    /// Why the trial of `record` failed; `None` if it did not, or nothing is known of its targets.
    pub fn of(record: &TrialRecord) -> Option<Self> {
        let sample = record.connectivity.first();
        let failed = record.outcome == Outcome::Censored && sample.is_some_and(|sample| !sample.targets.is_empty());
        failed.then(|| Self {
            lasted_s: record.simulated.as_secs(),
            robots_alive: (record.robots.len() - record.failed_at_end().len()) as f64,
            misses: misses(record),
        })
    }
}

impl MissedSummary {
    /// Why those of `records` failed that did; `None` if none did, or nothing is known of their targets.
    #[must_use]
    pub fn of(records: &[TrialRecord]) -> Option<Self> {
        Self::put_together(&records.iter().filter_map(FailedTrial::of).collect::<Vec<_>>())
    }

    pub(super) fn put_together(failed: &[FailedTrial]) -> Option<Self> {
        let misses: Vec<&Miss> = failed.iter().flat_map(|trial| &trial.misses).collect();
        let count = misses.iter().map(|miss| miss.target + 1).max().unwrap_or(0);
        let targets = (0..count).filter_map(|target| MissedTarget::of(target, &misses));
        Some(Self {
            failed: failed.len() as u64,
            lasted_s: middle(failed.iter().map(|trial| trial.lasted_s))?,
            robots_alive: middle(failed.iter().map(|trial| trial.robots_alive))?,
            targets: targets.collect(),
        })
    }
}

impl MissedTarget {
    fn of(target: usize, misses: &[&Miss]) -> Option<Self> {
        let own = || misses.iter().filter(|miss| miss.target == target);
        Some(Self {
            target: target as u32,
            trials: own().count() as u64,
            missed_s: middle(own().map(|miss| miss.missed_s))?,
            why: Named::of(WHY, |place| own().filter(|miss| miss.why == place).count() as u64),
            links: middle(own().filter_map(|miss| miss.links)),
            nearest_m: middle(own().filter_map(|miss| miss.nearest_m)),
            at_end_m: middle(own().filter_map(|miss| miss.at_end_m)),
        })
    }
}

/// The targets for which a trial failed.
fn misses(record: &TrialRecord) -> Vec<Miss> {
    let targets = record.connectivity.first().map_or(0, |sample| sample.targets.len());
    let all: Vec<Vec<Stand>> = (0..targets).map(|target| stands(record, target)).collect();
    let held_for = |stands: &[Stand]| stands.iter().rev().take_while(|stand| stand.is_held()).count();
    let that = |wanted: &dyn Fn(&[Stand]) -> bool| {
        let places = 0..all.len();
        places.filter(|&target| wanted(&all[target])).collect::<Vec<usize>>()
    };
    let mut blocking = that(&|stands| !stands.iter().any(Stand::is_held));
    if blocking.is_empty() {
        blocking = that(&|stands| held_for(stands) == 0);
    }
    if blocking.is_empty() {
        let last = (0..all.len()).min_by_key(|&target| held_for(&all[target]));
        blocking = last.into_iter().collect();
    }
    let end = record.simulated;
    blocking
        .into_iter()
        .map(|target| miss(end, target, &all[target]))
        .collect()
}

/// How a target stood in a sample.
struct Stand {
    at: SimTime,
    state: TargetState,
    worker_m: Option<f64>,
    links: Option<u32>,
}

impl Stand {
    fn is_held(&self) -> bool {
        self.state == TargetState::Held
    }
}

fn stands(record: &TrialRecord, target: usize) -> Vec<Stand> {
    let stand = |sample: ConnectivitySample| Stand {
        at: sample.at,
        state: sample.targets[target].state,
        worker_m: sample.targets[target].worker_m,
        links: sample.links.get(target).copied(),
    };
    record.connectivity.iter().map(stand).collect()
}

fn miss(end: SimTime, target: usize, samples: &[Stand]) -> Miss {
    let ends = samples.iter().skip(1).map(|stand| stand.at).chain([end]);
    let spans = samples.iter().zip(ends).filter(|(stand, _)| !stand.is_held());
    let missed = spans.fold(Span::ZERO, |sum, (stand, end)| sum + end.since(stand.at));
    // What stood in the way since it was held last.
    let since = samples.iter().rposition(Stand::is_held).map_or(0, |held| held + 1);
    let stretch = &samples[since..];
    let times = |wanted: TargetState| stretch.iter().filter(|stand| stand.state == wanted).count();
    let hindrances = [TargetState::NoWorker, TargetState::Away, TargetState::LinksShort];
    // Of equals the last, which is the nearest to success.
    let most = hindrances.into_iter().max_by_key(|hindrance| times(*hindrance));
    let way = |back: usize| stretch.iter().rev().nth(back).and_then(|stand| stand.worker_m);
    let why = match most.filter(|_| !stretch.is_empty()) {
        None | Some(TargetState::Held) => 4,
        Some(TargetState::NoWorker) => 0,
        Some(TargetState::LinksShort) => 3,
        Some(TargetState::Away) => match (way(0), way((samples.len() / 10).max(1))) {
            (Some(now), Some(before)) if now < SHRINKS * before => 2,
            _ => 1,
        },
    };
    let short = stretch.iter().filter(|stand| stand.state == TargetState::LinksShort);
    let links = short.filter_map(|stand| stand.links).max();
    let ways = samples.iter().filter_map(|stand| stand.worker_m);
    Miss {
        target,
        missed_s: missed.as_secs(),
        why,
        links: links.map(f64::from),
        nearest_m: ways.min_by(f64::total_cmp),
        at_end_m: samples.last().and_then(|stand| stand.worker_m),
    }
}

/// The median, of an even number the mean of the middle two.
fn middle(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some(f64::midpoint(values[last / 2], values[last.div_ceil(2)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::ActorId;
    use crate::faults::Effect;
    use crate::geometry::Pose;
    use crate::metrics::episode::{FaultEpisode, FaultKind};
    use crate::metrics::record::TargetSample;
    use crate::metrics::{HeaderBytes, Layout, MetricsConfig, Recorder, RunEnd};
    use crate::radio::Reach;
    use crate::spool::Scratch;
    use TargetState::{Away, Held, LinksShort, NoWorker};

    type Stand = (TargetState, Option<f64>, u32);

    /// A trial of five robots that failed after a sample every 10 s of how each target stood, with its links.
    fn failed<const TARGETS: usize>(samples: &[[Stand; TARGETS]]) -> TrialRecord {
        let layout = Layout {
            robots: 5,
            topics: 1,
            roles: 1,
            headers: HeaderBytes { frame: 2, message: 3 },
            reach: Reach::Disk(2.0),
            control_period: Span::from_secs(0.1),
            mission: None,
            rumors: 0,
            completion: crate::protocol::CompletionConfig::default(),
            status_memory: Span::from_secs(8.0),
            patience: Span::from_secs(4.0),
            status: None,
            scratch: Scratch::default(),
        };
        let at = |place: usize| SimTime::from_secs(10.0 * place as f64);
        let record = Recorder::new(layout, &MetricsConfig::default()).finish(RunEnd {
            trial: 0,
            seed: 1,
            steps: 1,
            simulated: at(samples.len()),
            events: 1,
            digest: 0,
            robot_steps: vec![1; 5],
            poses: vec![Pose::default(); 5],
        });
        let sample = |(place, stands): (usize, &[Stand; TARGETS])| ConnectivitySample {
            at: at(place),
            lambda2: 1.0,
            components: 1,
            neighbours: 4.0,
            roles: vec![5],
            links: stands.iter().map(|stand| stand.2).collect(),
            targets: stands
                .iter()
                .map(|&(state, worker_m, _)| TargetSample { state, worker_m })
                .collect(),
        };
        TrialRecord {
            outcome: Outcome::Censored,
            connectivity: samples.iter().enumerate().map(sample).collect(),
            ..record
        }
    }

    /// The only target that `records` missed, with the one thing that stood in its way.
    fn only(records: &[TrialRecord]) -> (MissedTarget, String) {
        let summary = MissedSummary::of(records).expect("they failed");
        let [target] = &summary.targets[..] else {
            panic!("one target was missed: {summary:?}");
        };
        let why: Vec<_> = target.why.0.iter().filter(|(_, trials)| *trials > 0).collect();
        assert_eq!(why.len(), 1, "{why:?}");
        (target.clone(), why[0].0.clone())
    }

    const HELD: Stand = (Held, Some(0.1), 2);
    const NOBODY: Stand = (NoWorker, None, 0);

    fn way(metres: f64) -> Stand {
        (Away, Some(metres), 1)
    }

    #[test]
    fn a_target_that_was_never_held_is_to_blame_and_not_one_that_was_let_go() {
        let trial = failed(&[[NOBODY, way(2.0)], [NOBODY, HELD], [NOBODY, way(1.0)]]);
        let (target, why) = only(&[trial]);
        assert_eq!((target.target, why.as_str()), (0, "no_worker"));
        assert_eq!((target.missed_s, target.nearest_m, target.at_end_m), (30.0, None, None));
    }

    #[test]
    fn where_all_were_held_at_some_time_the_one_that_is_loose_at_the_end_is_to_blame_for_what_then_stood_in_its_way() {
        let short = (LinksShort, Some(0.2), 1);
        let trial = failed(&[
            [way(3.0), HELD],
            [HELD, HELD],
            [short, HELD],
            [short, HELD],
            [way(0.5), HELD],
        ]);
        let (target, why) = only(&[trial]);
        assert_eq!(
            (target.target, why.as_str(), target.links),
            (0, "links_short", Some(1.0))
        );
        assert_eq!(
            (target.missed_s, target.nearest_m, target.at_end_m),
            (40.0, Some(0.1), Some(0.5))
        );
    }

    #[test]
    fn where_all_are_held_at_the_end_the_last_one_came_too_late() {
        let (target, why) = only(&[failed(&[[way(3.0), HELD], [way(1.0), HELD], [HELD, HELD]])]);
        assert_eq!((target.target, why.as_str(), target.missed_s), (0, "too_late", 20.0));
    }

    #[test]
    fn a_worker_that_came_nearer_was_on_its_way_and_one_that_did_not_was_held_up() {
        assert_eq!(only(&[failed(&[[way(3.0)], [way(2.0)], [way(1.0)]])]).1, "on_its_way");
        assert_eq!(only(&[failed(&[[way(3.0)], [way(1.01)], [way(1.0)]])]).1, "held_up");
    }

    #[test]
    fn trials_are_put_together_by_medians_and_counts_and_those_that_completed_do_not_count() {
        let trials = [
            failed(&[[NOBODY], [way(1.0)], [way(1.0)]]),
            failed(&[[NOBODY], [NOBODY]]),
            TrialRecord {
                outcome: Outcome::Completed { step: 1 },
                ..failed(&[[HELD]])
            },
        ];
        let silence = |robot: u32, until| FaultEpisode {
            fault: 0,
            kind: FaultKind::Robot {
                robot: ActorId(robot),
                effect: Effect::Silence,
                role: 0,
                target: None,
            },
            from: SimTime::ZERO,
            until,
        };
        let mut trials = trials;
        trials[0].faults = vec![
            silence(1, None),
            silence(2, Some(SimTime::from_secs(9.0))),
            silence(3, None),
        ];
        let summary = MissedSummary::of(&trials).unwrap();
        assert_eq!((summary.failed, summary.lasted_s, summary.robots_alive), (2, 25.0, 4.0));
        let target = &summary.targets[0];
        assert_eq!((target.trials, target.missed_s, target.nearest_m), (2, 25.0, Some(1.0)));
        let whys: Vec<u64> = target.why.0.iter().map(|(_, trials)| *trials).collect();
        assert_eq!(whys, [1, 1, 0, 0, 0]);
        assert_eq!(MissedSummary::of(&trials[2..]), None);
    }
}

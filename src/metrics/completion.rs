//! When a mission is complete: what must have held, and for how long.

use std::cell::OnceCell;

use crate::engine::Span;
use crate::protocol::CompletionConfig;

use super::faults::Failures;
use super::mission::{Mission, Scene};
use super::spread::Spread;

/// How far a mission has come at a control step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// What is asked for does not hold, or there is no mission.
    Underway,
    /// It does, without a break since step `since`, but not yet for long enough.
    Holding {
        /// The first control step of the hold.
        since: u64,
    },
    /// It did for as long as the scenario asks: the run may end.
    Complete {
        /// The first control step of the hold: the steps to completion.
        since: u64,
    },
}

/// Follows a mission from control step to control step.
#[derive(Debug)]
pub(super) struct Judge {
    pub(super) mission: Mission,
    /// Which targets were once held, where that is enough.
    visited: Option<Vec<bool>>,
    hold: Hold,
}

impl Judge {
    /// A judge that calls `mission` complete as `rule` says; steps come every `control_period`.
    pub(super) fn new(mission: Mission, rule: CompletionConfig, control_period: Span) -> Self {
        Self {
            visited: once(rule, mission.targets.len()),
            mission,
            hold: Hold::new(rule, control_period),
        }
    }

    /// Judges control step number `step`; steps are judged in order. A mission that is complete stays so.
    pub(super) fn observe(&mut self, step: u64, scene: Scene) -> Progress {
        let Self { mission, visited, hold } = self;
        hold.observe(step, || match visited {
            None => mission.is_accomplished(scene),
            Some(visited) => {
                let chains = OnceCell::new();
                all_once(visited, |target| mission.is_served(target, scene, &chains))
            }
        })
    }

    /// The step that completed the mission, if one did.
    pub(super) fn completed_at(&self) -> Option<u64> {
        self.hold.completed_at()
    }
}

/// What was once so, of `parts` of a mission, where `rule` asks for no more than that.
fn once(rule: CompletionConfig, parts: usize) -> Option<Vec<bool>> {
    (rule == CompletionConfig::EachVisited).then(|| vec![false; parts])
}

/// Whether each part was once so, with what `is_so` now: every part is looked at, however the others stand. Never of no parts.
fn all_once(seen: &mut [bool], is_so: impl Fn(usize) -> bool) -> bool {
    for (part, seen) in seen.iter_mut().enumerate() {
        *seen = *seen || is_so(part);
    }
    !seen.is_empty() && seen.iter().all(|seen| *seen)
}

/// Follows rumours from control step to control step.
#[derive(Debug)]
pub(super) struct Hearing {
    /// Which rumours were once known to all, where that is enough.
    known: Option<Vec<bool>>,
    hold: Hold,
}

impl Hearing {
    /// One that calls the spread of so many `rumors` complete as `rule` says; steps come every `control_period`.
    pub(super) fn new(rumors: usize, rule: CompletionConfig, control_period: Span) -> Self {
        Self {
            known: once(rule, rumors),
            hold: Hold::new(rule, control_period),
        }
    }

    /// Judges control step number `step`; steps are judged in order.
    pub(super) fn observe(&mut self, step: u64, spread: &Spread, failures: &Failures) -> Progress {
        let Self { known, hold } = self;
        hold.observe(step, || match known {
            None => spread.is_complete(failures),
            Some(known) => all_once(known, |rumor| spread.is_known(rumor, failures)),
        })
    }

    /// The step that completed it, if one did.
    pub(super) fn completed_at(&self) -> Option<u64> {
        self.hold.completed_at()
    }
}

/// Asks for something to hold without a break for some time.
#[derive(Clone, Debug)]
struct Hold {
    duration: Span,
    control_period: Span,
    progress: Progress,
}

impl Hold {
    /// What `rule` asks for, judged every `control_period`.
    fn new(rule: CompletionConfig, control_period: Span) -> Self {
        Self {
            duration: Span::from_secs(rule.hold()),
            control_period,
            progress: Progress::Underway,
        }
    }

    /// Judges control step number `step`; steps are judged in order. What is complete stays so.
    fn observe(&mut self, step: u64, holds: impl FnOnce() -> bool) -> Progress {
        self.progress = match self.progress {
            complete @ Progress::Complete { .. } => complete,
            _ if !holds() => Progress::Underway,
            Progress::Underway => self.held_since(step, step),
            Progress::Holding { since } => self.held_since(since, step),
        };
        self.progress
    }

    fn held_since(&self, since: u64, step: u64) -> Progress {
        if self.control_period * (step - since) >= self.duration {
            Progress::Complete { since }
        } else {
            Progress::Holding { since }
        }
    }

    /// The step that completed it, if one did.
    fn completed_at(&self) -> Option<u64> {
        match self.progress {
            Progress::Complete { since } => Some(since),
            Progress::Underway | Progress::Holding { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mission::tests::{Stage, mission};
    use super::*;
    use crate::engine::{ActorId, SimTime};
    use crate::protocol::Note;
    use crate::quantity::NonNegative;

    const STEP: Span = Span::from_nanos(100_000_000);

    fn held(seconds: f64) -> CompletionConfig {
        CompletionConfig::Held(NonNegative::new(seconds))
    }

    fn judge(mission: Mission, rule: CompletionConfig) -> Judge {
        Judge::new(mission, rule, STEP)
    }

    #[test]
    fn the_first_step_of_an_unbroken_hold_is_the_completion() {
        let mut judge = judge(mission(2), held(0.3));
        let (held, mut broken) = (Stage::new(), Stage::new());
        broken.positions[3].x = 0.0;
        let scenes = [&broken, &held, &held, &broken, &held, &held, &held, &held];
        let seen: Vec<_> = (0..)
            .zip(scenes)
            .map(|(step, stage)| judge.observe(step, stage.scene()))
            .collect();
        assert_eq!(seen[2], Progress::Holding { since: 1 });
        assert_eq!(seen[3], Progress::Underway);
        assert_eq!(seen[6], Progress::Holding { since: 4 });
        assert_eq!(seen[7], Progress::Complete { since: 4 });
        assert_eq!(judge.observe(8, broken.scene()), Progress::Complete { since: 4 });
        assert_eq!(judge.completed_at(), Some(4));
    }

    #[test]
    fn without_a_hold_the_first_step_completes() {
        assert_eq!(
            judge(mission(2), held(0.0)).observe(7, Stage::new().scene()),
            Progress::Complete { since: 7 }
        );
    }

    /// Two targets at one place, and the worker of one of them: a swarm that can hold either, and never both at once.
    fn torn() -> (Mission, [Stage; 2]) {
        let target = mission(2).targets[0];
        let both = Mission {
            targets: vec![target; 2],
            ..mission(2)
        };
        let works_for = |target| {
            let mut stage = Stage::new();
            stage.reports.note(ActorId(3), &Note::Target(Some(target)));
            stage
        };
        (both, [works_for(0), works_for(1)])
    }

    #[test]
    fn targets_visited_one_after_another_complete_where_each_is_to_be_visited_and_nowhere_else() {
        let (both, [first, second]) = torn();
        for (rule, last) in [
            (CompletionConfig::EachVisited, Progress::Complete { since: 1 }),
            (CompletionConfig::Reached, Progress::Underway),
            (held(0.0), Progress::Underway),
        ] {
            let mut judge = judge(both.clone(), rule);
            assert_eq!(judge.observe(0, first.scene()), Progress::Underway);
            assert_eq!(judge.observe(1, second.scene()), last, "{rule:?}");
        }
    }

    #[test]
    fn rumours_are_known_to_all_only_where_somebody_lives() {
        let mut spread = Spread::new(2, 4);
        let mut stage = Stage::new();
        let mut now = Hearing::new(2, CompletionConfig::Reached, STEP);
        let mut each = Hearing::new(2, CompletionConfig::EachVisited, STEP);
        for robot in 0..4 {
            spread.inform(ActorId(robot), 0, SimTime::ZERO, None);
        }
        assert_eq!(now.observe(0, &spread, &stage.failures), Progress::Underway);
        assert_eq!(each.observe(0, &spread, &stage.failures), Progress::Underway);
        (0..4).for_each(|robot| stage.silence(robot));
        assert_eq!(
            now.observe(1, &spread, &stage.failures),
            Progress::Underway,
            "nobody is alive"
        );
        assert_eq!(
            each.observe(1, &spread, &stage.failures),
            Progress::Underway,
            "nor to know the second"
        );
        let mut stage = Stage::new();
        (1..4).for_each(|robot| stage.silence(robot));
        spread.inform(ActorId(0), 1, SimTime::ZERO, None);
        assert_eq!(
            now.observe(2, &spread, &stage.failures),
            Progress::Complete { since: 2 }
        );
        assert_eq!(
            each.observe(2, &spread, &stage.failures),
            Progress::Complete { since: 2 }
        );
    }
}

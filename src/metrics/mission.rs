//! When a mission is complete: every target held by a worker with its links, for long enough.

use crate::engine::{ActorId, Span};
use crate::geometry::{Vec2, at_most};
use crate::protocol::Role;

use super::connectivity::Chains;
use super::faults::Failures;
use super::reports::Reports;

/// What the swarm is asked to do (paper section 3.3): hold every target, with so many chains to the root.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// The targets; robots report them by their place in this list.
    pub targets: Vec<MissionTarget>,
    /// d_δ: a worker this near to its target holds it, metres.
    pub reach: f64,
    /// d_c: a parent must be this near to its worker for the link to count, metres.
    pub link_limit: f64,
    /// The robot that every chain leads to.
    pub root: ActorId,
    /// The role of the robots that visit targets.
    pub worker_role: Role,
}

/// A place to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissionTarget {
    /// Where it is, metres.
    pub position: Vec2,
    /// Nt_i, the vertex-disjoint chains that it needs, at least 1.
    pub links: u32,
}

/// How far a mission has come at a control step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Some target is not held with its links, or there is no mission.
    Underway,
    /// All are, without a break since step `since`, but not yet for long enough.
    Holding {
        /// The first control step of the hold.
        since: u64,
    },
    /// All were held for as long as the scenario asks: the run may end.
    Complete {
        /// The first control step of the hold: the steps to completion.
        since: u64,
    },
}

/// What the mission is judged by at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene<'a> {
    pub(super) reports: &'a Reports,
    pub(super) failures: &'a Failures,
    pub(super) positions: &'a [Vec2],
    radio_range: f64,
}

impl<'a> Scene<'a> {
    /// What robots have reported, which have failed, where they are, and how far their radios carry, in metres.
    pub(super) fn new(reports: &'a Reports, failures: &'a Failures, positions: &'a [Vec2], radio_range: f64) -> Self {
        Self {
            reports,
            failures,
            positions,
            radio_range,
        }
    }

    fn apart(&self, a: ActorId, b: ActorId) -> f64 {
        (self.positions[a.index()] - self.positions[b.index()]).norm()
    }

    fn are_live(&self, a: ActorId, b: ActorId) -> bool {
        self.failures.is_live(a) && self.failures.is_live(b)
    }

    fn chains(&self, root: ActorId) -> Chains {
        Chains::new(&self.reports.parents, root, |child, parent| {
            self.are_live(child, parent) && self.apart(child, parent) <= at_most(self.radio_range)
        })
    }
}

impl Mission {
    /// nl(t) of each target, in order: the chains of its best connected worker, wherever that is; 0 without a worker.
    pub(super) fn links(&self, scene: Scene) -> Vec<u32> {
        let chains = scene.chains(self.root);
        (0..self.targets.len())
            .map(|target| self.best_connected(target, &chains, scene))
            .collect()
    }

    /// nl(t) of target number `target`.
    pub(super) fn links_of(&self, target: usize, scene: Scene) -> u32 {
        self.best_connected(target, &scene.chains(self.root), scene)
    }

    fn best_connected(&self, target: usize, chains: &Chains, scene: Scene) -> u32 {
        let workers = scene.reports.working_for(target, self.worker_role);
        workers.map(|robot| chains.count(robot)).max().unwrap_or(0)
    }

    /// How far the nearest live worker of target number `target` is from it, metres; infinite without one.
    pub(super) fn nearest_worker(&self, target: usize, scene: Scene) -> f64 {
        let place = self.targets[target].position;
        let workers = scene.reports.working_for(target, self.worker_role);
        let live = workers.filter(|robot| scene.failures.is_live(*robot));
        let distances = live.map(|robot| (scene.positions[robot.index()] - place).norm());
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Whether every target is held with its links. The flow through the parent relation is computed only when
    /// everything that is cheaper to see holds.
    pub(super) fn is_accomplished(&self, scene: Scene) -> bool {
        let holders: Vec<Vec<ActorId>> = (0..self.targets.len())
            .map(|target| self.holders(target, scene))
            .collect();
        if holders.iter().any(Vec::is_empty) {
            return false;
        }
        let chains = scene.chains(self.root);
        let mut wanted = self.targets.iter().map(|target| target.links);
        holders.iter().all(|robots| {
            wanted
                .next()
                .is_some_and(|links| robots.iter().any(|&robot| chains.count(robot) >= links))
        })
    }

    /// The workers of target number `target` that are at it and have enough parents near.
    fn holders(&self, target: usize, scene: Scene) -> Vec<ActorId> {
        let MissionTarget { position, links } = self.targets[target];
        scene
            .reports
            .working_for(target, self.worker_role)
            .filter(|robot| (scene.positions[robot.index()] - position).norm() <= at_most(self.reach))
            .filter(|&robot| self.near_parents(robot, scene) >= links as usize) // None if it has failed.
            .collect()
    }

    /// Distinct live parents of `robot`, live itself, within d_c of it.
    fn near_parents(&self, robot: ActorId, scene: Scene) -> usize {
        let named = &scene.reports.parents[robot.index()];
        let distinct = named
            .iter()
            .enumerate()
            .filter(|(i, parent)| !named[..*i].contains(parent));
        distinct
            .filter(|&(_, &parent)| {
                scene.are_live(robot, parent) && scene.apart(robot, parent) <= at_most(self.link_limit)
            })
            .count()
    }
}

/// Follows a mission from control step to control step.
#[derive(Debug)]
pub(super) struct Judge {
    pub(super) mission: Mission,
    hold: Hold,
}

impl Judge {
    /// A judge that asks for `mission` to be held as `hold` says.
    pub(super) fn new(mission: Mission, hold: Hold) -> Self {
        Self { mission, hold }
    }

    /// Judges control step number `step`; steps are judged in order. A mission that is complete stays so.
    pub(super) fn observe(&mut self, step: u64, scene: Scene) -> Progress {
        self.hold.observe(step, || self.mission.is_accomplished(scene))
    }

    /// The step that completed the mission, if one did.
    pub(super) fn completed_at(&self) -> Option<u64> {
        self.hold.completed_at()
    }
}

/// Asks for something to hold without a break for some time.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    duration: Span,
    control_period: Span,
    progress: Progress,
}

impl Hold {
    /// Something is to be held for `duration`, judged every `control_period`.
    pub(super) fn new(duration: Span, control_period: Span) -> Self {
        Self {
            duration,
            control_period,
            progress: Progress::Underway,
        }
    }

    /// Judges control step number `step`; steps are judged in order. What is complete stays so.
    pub(super) fn observe(&mut self, step: u64, holds: impl FnOnce() -> bool) -> Progress {
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
    pub(super) fn completed_at(&self) -> Option<u64> {
        match self.progress {
            Progress::Complete { since } => Some(since),
            Progress::Underway | Progress::Holding { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::SimTime;
    use crate::faults::{Change, Effect, Health, Subject};
    use crate::protocol::Note;

    const WORKER: Role = Role(1);
    const STEP: Span = Span::from_nanos(100_000_000);

    /// One target two hops out on the x axis: robot 0 is the root, 3 the worker, 1 and 2 relay side by side.
    struct Stage {
        reports: Reports,
        failures: Failures,
        positions: Vec<Vec2>,
    }

    impl Stage {
        fn new() -> Self {
            let mut reports = Reports::new(4);
            let relies_on = |ids: &[u32]| Note::Parents(ids.iter().copied().map(ActorId).collect());
            for (robot, note) in [
                (3, Note::Role(WORKER)),
                (3, Note::Target(Some(0))),
                (3, relies_on(&[1, 2])),
                (1, relies_on(&[0])),
                (2, relies_on(&[0])),
            ] {
                reports.note(ActorId(robot), &note);
            }
            let positions = [(0.0, 0.0), (1.5, 0.5), (1.5, -0.5), (3.0, 0.0)]
                .map(|(x, y)| Vec2::new(x, y))
                .to_vec();
            let failures = Failures::new(4);
            Self {
                reports,
                failures,
                positions,
            }
        }

        fn silence(&mut self, robot: u32) {
            let silence = Subject::Robot {
                robot: ActorId(robot),
                effect: Effect::Silence,
                health: Health {
                    sends: false,
                    hears: false,
                    acts: true,
                },
            };
            let change = Change {
                fault: 0,
                begins: true,
                subject: silence,
            };
            self.failures.change(SimTime::ZERO, &change, &self.reports);
        }

        fn scene(&self) -> Scene<'_> {
            Scene::new(&self.reports, &self.failures, &self.positions, 2.0)
        }

        fn accomplishes(&self, mission: &Mission) -> bool {
            mission.is_accomplished(self.scene())
        }
    }

    fn mission(links: u32) -> Mission {
        Mission {
            targets: vec![MissionTarget {
                position: Vec2::new(3.2, 0.0),
                links,
            }],
            reach: 0.3,
            link_limit: 1.7,
            root: ActorId(0),
            worker_role: WORKER,
        }
    }

    #[test]
    fn a_worker_at_its_target_with_two_disjoint_chains_serves_two_links_and_not_three() {
        let stage = Stage::new();
        assert!(stage.accomplishes(&mission(1)) && stage.accomplishes(&mission(2)) && !stage.accomplishes(&mission(3)));
        assert_eq!(mission(2).links(stage.scene()), [2]);
    }

    fn assert_fails_when(what: &str, wreck: impl FnOnce(&mut Stage)) {
        let mut stage = Stage::new();
        wreck(&mut stage);
        assert!(!stage.accomplishes(&mission(2)), "{what}");
    }

    #[test]
    fn each_condition_alone_can_fail_the_mission() {
        let parents = |robot, ids: &[u32]| {
            let note = Note::Parents(ids.iter().copied().map(ActorId).collect());
            move |stage: &mut Stage| stage.reports.note(ActorId(robot), &note)
        };
        assert_fails_when("the worker is away", |stage| stage.positions[3].x = 2.85);
        assert_fails_when("a parent is beyond d_c", |stage| stage.positions[1].y = 1.1);
        assert_fails_when("the relays are out of the root's range", |stage| {
            stage.positions[0].x = -0.5;
        });
        assert_fails_when("a relay has no parent", parents(1, &[]));
        assert_fails_when("the chains share a relay", parents(1, &[2]));
        assert_fails_when("the worker has one parent", parents(3, &[1]));
        assert_fails_when("the worker works for no target", |stage| {
            stage.reports.note(ActorId(3), &Note::Target(None));
        });
        for robot in [0, 1, 3] {
            assert_fails_when("a robot of the chains is silent", |stage| stage.silence(robot));
        }
        assert_fails_when("the worker has another role", |stage| {
            stage.reports.note(ActorId(3), &Note::Role(Role(0)));
        });
    }

    #[test]
    fn a_parent_named_twice_is_one_link() {
        let mut stage = Stage::new();
        stage
            .reports
            .note(ActorId(3), &Note::Parents(vec![ActorId(1), ActorId(1)]));
        assert!(!stage.accomplishes(&mission(2)) && stage.accomplishes(&mission(1)));
    }

    #[test]
    fn the_first_step_of_an_unbroken_hold_is_the_completion() {
        let mut judge = Judge::new(mission(2), Hold::new(STEP * 3, STEP));
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
            Judge::new(mission(2), Hold::new(Span::ZERO, STEP)).observe(7, Stage::new().scene()),
            Progress::Complete { since: 7 }
        );
    }
}

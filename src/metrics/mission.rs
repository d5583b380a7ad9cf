//! What a swarm is asked to do, and whether it does it at an instant: every target held by a worker with its links.

use std::cell::OnceCell;

use crate::engine::ActorId;
use crate::geometry::{Vec2, at_most};
use crate::protocol::Role;
use crate::radio::Reach;

use super::connectivity::{Chains, Graph};
use super::faults::Failures;
use super::record::{TargetSample, TargetState};
use super::reports::Reports;

/// What the swarm is asked to do (paper section 3.3): hold every target, with so many chains to the root.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// The targets; robots report them by their place in this list.
    pub targets: Vec<MissionTarget>,
    /// d_δ: a worker this near to its target holds it, metres.
    pub reach: f64,
    /// What counts as a link.
    pub ties: Ties,
    /// The robot that every chain leads to.
    pub root: ActorId,
    /// The role of whoever is in its stead, where another robot can be: a live one that reports it, and is not the first root, comes before that.
    pub root_role: Option<Role>,
    /// The role of the robots that visit targets.
    pub worker_role: Role,
}

/// What counts as a link between a worker and the root, in chains of live robots each within range of the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ties {
    /// The parents that robots name, [one after the other](crate::protocol::Note::Parents).
    Parents {
        /// d_c: a parent must be this near to its worker, metres.
        within: f64,
    },
    /// Whoever is there, for protocols that keep the swarm in one piece and no chains in it.
    Neighbours,
}

/// A place to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissionTarget {
    /// Where it is, metres.
    pub position: Vec2,
    /// Nt_i, the vertex-disjoint chains that it needs, at least 1.
    pub links: u32,
}

/// What the mission is judged by at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene<'a> {
    pub(super) reports: &'a Reports,
    pub(super) failures: &'a Failures,
    pub(super) positions: &'a [Vec2],
    reach: &'a Reach,
}

impl<'a> Scene<'a> {
    /// What robots have reported, which have failed, where they are, and who is in range of whom.
    pub(super) fn new(reports: &'a Reports, failures: &'a Failures, positions: &'a [Vec2], reach: &'a Reach) -> Self {
        Self {
            reports,
            failures,
            positions,
            reach,
        }
    }

    fn apart(&self, a: ActorId, b: ActorId) -> f64 {
        (self.positions[a.index()] - self.positions[b.index()]).norm()
    }

    fn are_live(&self, a: ActorId, b: ActorId) -> bool {
        self.failures.is_live(a) && self.failures.is_live(b)
    }

    fn chains(&self, root: ActorId, ties: Ties) -> Chains {
        if ties == Ties::Neighbours {
            return Chains::new(&self.neighbours(), root, |_, _| true);
        }
        Chains::new(&self.reports.parents, root, |child, parent| {
            let [child, parent] = [child, parent].map(|robot| (robot, self.positions[robot.index()]));
            self.are_live(child.0, parent.0) && self.reach.linked(child, parent)
        })
    }

    /// Everyone whom each live robot hears and is heard by, in order of ids.
    fn neighbours(&self) -> Vec<Vec<ActorId>> {
        let robots = (0..).map(ActorId).zip(self.positions.iter().copied());
        let live = robots.filter(|(robot, _)| self.failures.is_live(*robot));
        let (graph, who) = Graph::with_robots(live, self.reach);
        let mut neighbours = vec![Vec::new(); self.positions.len()];
        for &[a, b] in graph.edges() {
            let [a, b] = [a, b].map(|vertex| who[vertex as usize]);
            neighbours[a.index()].push(b);
            neighbours[b.index()].push(a);
        }
        neighbours
    }
}

impl Mission {
    /// Where chains lead to.
    fn chains(&self, scene: Scene) -> Chains {
        let elected = self.root_role.and_then(|role| {
            let mut others = scene.reports.in_role(role).filter(|robot| *robot != self.root);
            others.find(|robot| scene.failures.is_live(*robot))
        });
        scene.chains(elected.unwrap_or(self.root), self.ties)
    }

    /// nl(t) of each target, in order: the chains of its best connected worker, wherever that is; 0 without a worker.
    pub(super) fn links(&self, scene: Scene) -> Vec<u32> {
        let chains = self.chains(scene);
        (0..self.targets.len())
            .map(|target| self.best_connected(target, &chains, scene))
            .collect()
    }

    /// How each target stands.
    pub(super) fn stands(&self, scene: Scene) -> Vec<TargetSample> {
        let chains = self.chains(scene);
        let targets = self.targets.iter().enumerate();
        let stands = targets.map(|(target, MissionTarget { links, .. })| {
            let worker_m = Some(self.nearest_worker(target, scene)).filter(|metres| metres.is_finite());
            let holders = || self.holders(target, scene);
            let state = match worker_m {
                None => TargetState::NoWorker,
                Some(metres) if metres > self.reach => TargetState::Away,
                Some(_) if holders().any(|robot| chains.count(robot) >= *links) => TargetState::Held,
                Some(_) => TargetState::LinksShort,
            };
            TargetSample { state, worker_m }
        });
        stands.collect()
    }

    /// nl(t) of target number `target`.
    pub(super) fn links_of(&self, target: usize, scene: Scene) -> u32 {
        self.best_connected(target, &self.chains(scene), scene)
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

    /// Whether every target is held with its links, which is never so of no target. The flow through the parent relation is
    /// computed only when everything that is cheaper to see holds.
    pub(super) fn is_accomplished(&self, scene: Scene) -> bool {
        let targets = 0..self.targets.len();
        let chains = OnceCell::new();
        !self.targets.is_empty()
            && targets
                .clone()
                .all(|target| self.holders(target, scene).next().is_some())
            && targets.clone().all(|target| self.is_served(target, scene, &chains))
    }

    /// Whether a worker holds target number `target` with all its links. The `chains` of this instant are computed when they are first
    /// needed.
    pub(super) fn is_served(&self, target: usize, scene: Scene, chains: &OnceCell<Chains>) -> bool {
        let links = self.targets[target].links;
        let chains = || chains.get_or_init(|| self.chains(scene));
        self.holders(target, scene).any(|robot| chains().count(robot) >= links)
    }

    /// The workers of target number `target` that are at it and have enough parents near.
    fn holders<'a>(&'a self, target: usize, scene: Scene<'a>) -> impl Iterator<Item = ActorId> + 'a {
        let MissionTarget { position, links } = self.targets[target];
        scene
            .reports
            .working_for(target, self.worker_role)
            .filter(move |robot| (scene.positions[robot.index()] - position).norm() <= at_most(self.reach))
            .filter(move |&robot| self.has_near(links as usize, robot, scene)) // Not one that has failed.
    }

    /// Whether so many `links` can end at `robot`, as far as it can tell: distinct live parents, within d_c of it.
    fn has_near(&self, links: usize, robot: ActorId, scene: Scene) -> bool {
        let Ties::Parents { within } = self.ties else {
            return scene.failures.is_live(robot);
        };
        let named = &scene.reports.parents[robot.index()];
        let distinct = named
            .iter()
            .enumerate()
            .filter(|(i, parent)| !named[..*i].contains(parent));
        let near = distinct
            .filter(|&(_, &parent)| scene.are_live(robot, parent) && scene.apart(robot, parent) <= at_most(within));
        near.count() >= links
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::engine::SimTime;
    use crate::faults::{Change, Effect, Health, Subject};
    use crate::protocol::Note;
    use crate::radio::Walled;

    const WORKER: Role = Role(1);

    /// One target two hops out on the x axis: robot 0 is the root, 3 the worker, 1 and 2 relay side by side.
    pub struct Stage {
        pub reports: Reports,
        pub failures: Failures,
        pub positions: Vec<Vec2>,
        pub reach: Reach,
    }

    impl Stage {
        pub fn new() -> Self {
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
                reach: Reach::Disk(2.0),
            }
        }

        pub fn silence(&mut self, robot: u32) {
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

        pub fn scene(&self) -> Scene<'_> {
            Scene::new(&self.reports, &self.failures, &self.positions, &self.reach)
        }

        fn accomplishes(&self, mission: &Mission) -> bool {
            mission.is_accomplished(self.scene())
        }
    }

    pub fn mission(links: u32) -> Mission {
        Mission {
            targets: vec![MissionTarget {
                position: Vec2::new(3.2, 0.0),
                links,
            }],
            reach: 0.3,
            ties: Ties::Parents { within: 1.7 },
            root: ActorId(0),
            root_role: None,
            worker_role: WORKER,
        }
    }

    #[test]
    fn a_worker_at_its_target_with_two_disjoint_chains_serves_two_links_and_not_three() {
        let stage = Stage::new();
        assert!(stage.accomplishes(&mission(1)) && stage.accomplishes(&mission(2)) && !stage.accomplishes(&mission(3)));
        assert_eq!(mission(2).links(stage.scene()), [2]);
    }

    #[test]
    fn what_stands_in_the_way_of_a_target_is_told_apart() {
        let stands = |links, wreck: &dyn Fn(&mut Stage)| {
            let mut stage = Stage::new();
            wreck(&mut stage);
            let [sample] = mission(links).stands(stage.scene())[..] else {
                panic!("there is one target");
            };
            (
                sample.state,
                sample.worker_m.map(|metres| (metres * 1000.0).round() / 1000.0),
            )
        };
        assert_eq!(stands(2, &|_| {}), (TargetState::Held, Some(0.2)));
        assert_eq!(stands(3, &|_| {}), (TargetState::LinksShort, Some(0.2)));
        assert_eq!(
            stands(2, &|stage| stage.silence(1)),
            (TargetState::LinksShort, Some(0.2))
        );
        assert_eq!(
            stands(2, &|stage| stage.positions[3].x = 2.7),
            (TargetState::Away, Some(0.5))
        );
        assert_eq!(stands(2, &|stage| stage.silence(3)), (TargetState::NoWorker, None));
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
    fn a_chain_counts_where_its_robots_hear_each_other_and_not_through_a_wall_or_one_way() {
        // Odd robots, of which the worker is one, are heard half as far as others.
        let links = |range, shift| {
            let mut stage = Stage::new();
            stage.reach = Walled::reach(range);
            stage.positions.iter_mut().for_each(|place| place.x += shift);
            mission(2).links(stage.scene())
        };
        assert_eq!(links(4.0, 0.0), [2]);
        assert_eq!(links(4.0, -1.0), [0], "a wall parts the root from its relays");
        assert_eq!(links(4.0, -2.0), [0], "a wall parts the worker from its relays");
        assert_eq!(links(3.0, 0.0), [0], "nobody hears the worker");
    }

    #[test]
    fn where_no_chains_are_kept_whoever_is_in_range_makes_a_link() {
        let mission = |links| Mission {
            ties: Ties::Neighbours,
            ..mission(links)
        };
        let mut stage = Stage::new();
        stage.reports.note(ActorId(3), &Note::Parents(Vec::new()));
        stage.reports.note(ActorId(1), &Note::Parents(vec![ActorId(3)]));
        assert!(stage.accomplishes(&mission(2)) && !stage.accomplishes(&mission(3)));
        assert_eq!(mission(2).links(stage.scene()), [2]);
        stage.silence(1);
        assert!(stage.accomplishes(&mission(1)) && !stage.accomplishes(&mission(2)));
        stage.silence(2);
        assert!(!stage.accomplishes(&mission(1)), "the worker has lost the root");
        let mut stage = Stage::new();
        stage.silence(3);
        assert!(!stage.accomplishes(&mission(1)), "the worker itself has failed");
    }

    #[test]
    fn chains_lead_to_whoever_was_elected_root_while_that_one_lives() {
        const ROOT: Role = Role(2);
        let mission = Mission {
            root_role: Some(ROOT),
            ..mission(1)
        };
        let mut stage = Stage::new();
        assert!(stage.accomplishes(&mission), "nobody else is");
        stage.silence(0);
        assert!(!stage.accomplishes(&mission));
        stage.reports.note(ActorId(2), &Note::Role(ROOT));
        assert!(stage.accomplishes(&mission), "the worker relies on the new root itself");
        stage.silence(2);
        assert!(!stage.accomplishes(&mission));
    }

    #[test]
    fn a_mission_without_targets_is_never_accomplished() {
        let aimless = Mission {
            targets: Vec::new(),
            ..mission(1)
        };
        assert!(!Stage::new().accomplishes(&aimless));
    }

    #[test]
    fn a_parent_named_twice_is_one_link() {
        let mut stage = Stage::new();
        stage
            .reports
            .note(ActorId(3), &Note::Parents(vec![ActorId(1), ActorId(1)]));
        assert!(!stage.accomplishes(&mission(2)) && stage.accomplishes(&mission(1)));
    }
}

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
    /// The robot that chains lead to.
    pub(super) fn root_now(&self, scene: Scene) -> ActorId {
        let elected = self.root_role.and_then(|role| {
            let mut others = scene.reports.in_role(role).filter(|robot| *robot != self.root);
            others.find(|robot| scene.failures.is_live(*robot))
        });
        elected.unwrap_or(self.root)
    }

    fn chains(&self, scene: Scene) -> Chains {
        scene.chains(self.root_now(scene), self.ties)
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
pub(super) mod tests;

//! How a target gets its links back after a robot of its chains has failed.

use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Subject};
use crate::geometry::{Vec2, at_most};
use crate::protocol::Topic;

use super::episode::HealingEpisode;
use super::mission::{Mission, Scene};
use super::reports::Reports;

/// Every failure of a robot that works for a target, and those whose harm is not mended yet.
#[derive(Debug)]
pub(super) struct Healing {
    topics: usize,
    episodes: Vec<HealingEpisode>,
    open: Vec<Wound>,
}

/// A failure whose harm is not mended yet.
#[derive(Debug)]
struct Wound {
    /// Its place among the episodes.
    episode: usize,
    wanted: Standing,
    /// Where robots were when distances were last added up.
    last: Vec<Vec2>,
}

/// How a target stands.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Standing {
    /// Its chains, at most as many as it needs.
    links: u32,
    /// How far its nearest live worker is, metres; infinite without one.
    worker: f64,
}

impl Standing {
    fn of(target: u16, mission: &Mission, scene: Scene) -> Self {
        let target = usize::from(target);
        Self {
            links: mission.links_of(target, scene).min(mission.targets[target].links),
            worker: mission.nearest_worker(target, scene),
        }
    }

    fn meets(self, wanted: Self) -> bool {
        self.links >= wanted.links && self.worker <= at_most(wanted.worker)
    }
}

/// The failure of a robot that works for a target, seen from just before it happens.
#[derive(Debug)]
pub(super) struct Blow {
    robot: ActorId,
    target: u16,
    before: Standing,
    /// What it takes to be as well off as before.
    wanted: Standing,
}

impl Healing {
    /// Nothing has failed yet, among robots that speak on so many topics.
    pub(super) fn new(topics: usize) -> Self {
        Self {
            topics,
            episodes: Vec::new(),
            open: Vec::new(),
        }
    }

    /// Whether some harm is not mended yet.
    #[inline]
    pub(super) fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// What `change` is about to strike: a live robot that will no longer be live and works for a target, or for all of them as the root.
    pub(super) fn brace(change: &Change, mission: &Mission, scene: Scene) -> Vec<Blow> {
        let Subject::Robot { robot, health, .. } = change.subject else {
            return Vec::new();
        };
        if !change.begins || health.is_live() || !scene.failures.is_live(robot) {
            return Vec::new();
        }
        if robot == mission.root_now(scene) {
            let targets = 0..mission.targets.len() as u16;
            return targets
                .map(|target| Self::blow(robot, target, mission, scene))
                .collect();
        }
        let target = scene.reports.targets[robot.index()];
        target
            .into_iter()
            .map(|target| Self::blow(robot, target, mission, scene))
            .collect()
    }

    fn blow(robot: ActorId, target: u16, mission: &Mission, scene: Scene) -> Blow {
        let before = Standing::of(target, mission, scene);
        // A worker's place is its progress. Where it is on its way, and a relay of its fails, only the links count.
        let is_worker = scene.reports.roles[robot.index()] == mission.worker_role;
        let worker = if is_worker || before.worker <= at_most(mission.reach) {
            before.worker.max(mission.reach)
        } else {
            f64::INFINITY
        };
        Blow {
            robot,
            target,
            before,
            wanted: Standing { worker, ..before },
        }
    }

    /// The blow has fallen, as fault number `fault`.
    pub(super) fn strike(&mut self, now: SimTime, fault: u16, blow: &Blow, mission: &Mission, scene: Scene) {
        let Blow {
            robot,
            target,
            before,
            wanted,
        } = *blow;
        let after = Standing::of(target, mission, scene);
        let harmed = !after.meets(wanted);
        let episode = self.episodes.len();
        let mut overlapping = 0;
        if harmed {
            for wound in &self.open {
                let other = &mut self.episodes[wound.episode];
                if other.target == target {
                    other.overlapping += 1;
                    overlapping += 1;
                }
            }
            self.open.push(Wound {
                episode,
                wanted,
                last: scene.positions.to_vec(),
            });
        }
        self.episodes.push(HealingEpisode {
            fault,
            robot,
            role: scene.reports.roles[robot.index()].0,
            target,
            failed_at: now,
            links_before: before.links,
            links_after: after.links,
            worker_m: before.worker.is_finite().then_some(before.worker),
            healed_at: (!harmed).then_some(now),
            overlapping,
            distance_m: 0.0,
            frames: vec![0; self.topics],
            payload_bytes: vec![0; self.topics],
        });
    }

    /// A robot that works for `target` sent a frame.
    pub(super) fn sent(&mut self, target: Option<u16>, topic: Topic, payload_bytes: u32) {
        for wound in &self.open {
            let episode = &mut self.episodes[wound.episode];
            if Some(episode.target) == target {
                episode.frames[usize::from(topic.0)] += 1;
                episode.payload_bytes[usize::from(topic.0)] += u64::from(payload_bytes);
            }
        }
    }

    /// Adds up what robots have moved by `now`, and closes what has healed.
    pub(super) fn observe(&mut self, now: SimTime, mission: &Mission, scene: Scene) {
        let episodes = &mut self.episodes;
        self.open.retain_mut(|wound| {
            let episode = &mut episodes[wound.episode];
            episode.distance_m += moved(&wound.last, episode.target, scene);
            wound.last.copy_from_slice(scene.positions);
            let healed = Standing::of(episode.target, mission, scene).meets(wound.wanted);
            if healed {
                episode.healed_at = Some(now);
            }
            !healed
        });
    }

    /// Every failure, by its time.
    pub(super) fn into_episodes(self) -> Vec<HealingEpisode> {
        self.episodes
    }
}

/// How far the live robots that work for `target` have moved from their places in `last`, all together, metres.
fn moved(last: &[Vec2], target: u16, scene: Scene) -> f64 {
    let Scene {
        reports,
        failures,
        positions,
        ..
    } = scene;
    let robots = (0..).map(ActorId).zip(last.iter().zip(positions));
    robots
        .filter(|(robot, _)| works_for(reports, *robot, target) && failures.is_live(*robot))
        .map(|(_, (from, to))| (to - from).norm())
        .sum()
}

fn works_for(reports: &Reports, robot: ActorId, target: u16) -> bool {
    reports.targets[robot.index()] == Some(target)
}

#[cfg(test)]
mod tests;

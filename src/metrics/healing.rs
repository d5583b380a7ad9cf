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

    /// What `change` is about to strike: a live robot that works for a target and will no longer be live.
    pub(super) fn brace(change: &Change, mission: &Mission, scene: Scene) -> Option<Blow> {
        let Subject::Robot { robot, health, .. } = change.subject else {
            return None;
        };
        let strikes = change.begins && !health.is_live() && scene.failures.is_live(robot);
        let target = scene.reports.targets[robot.index()].filter(|_| strikes)?;
        let before = Standing::of(target, mission, scene);
        // A worker's place is its progress. Where it is on its way, and a relay of its fails, only the links count.
        let is_worker = scene.reports.roles[robot.index()] == mission.worker_role;
        let worker = if is_worker || before.worker <= at_most(mission.reach) {
            before.worker.max(mission.reach)
        } else {
            f64::INFINITY
        };
        Some(Blow {
            robot,
            target,
            before,
            wanted: Standing { worker, ..before },
        })
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
mod tests {
    use super::*;
    use crate::faults::{Effect, Health};
    use crate::metrics::faults::Failures;
    use crate::metrics::{MissionTarget, Ties};
    use crate::protocol::{Note, Role};
    use crate::radio::Reach;

    const WORKER: Role = Role(1);
    const RANGE: Reach = Reach::Disk(2.0);

    /// Robot 0 is the root; 1 and 2 relay side by side to the worker 3 at the target; 4 stands by.
    struct Stage {
        reports: Reports,
        failures: Failures,
        positions: Vec<Vec2>,
        mission: Mission,
        healing: Healing,
    }

    impl Stage {
        fn new() -> Self {
            let mut reports = Reports::new(5);
            for robot in [1, 2, 3] {
                reports.note(ActorId(robot), &Note::Target(Some(0)));
            }
            reports.note(ActorId(3), &Note::Role(WORKER));
            for (child, parents) in [(3, &[1, 2][..]), (1, &[0]), (2, &[0])] {
                let parents = parents.iter().copied().map(ActorId).collect();
                reports.note(ActorId(child), &Note::Parents(parents));
            }
            let positions = [(0.0, 0.0), (1.5, 0.5), (1.5, -0.5), (3.0, 0.0), (0.5, 0.5)];
            Self {
                reports,
                failures: Failures::new(5),
                positions: positions.map(|(x, y)| Vec2::new(x, y)).to_vec(),
                mission: Mission {
                    targets: vec![MissionTarget {
                        position: Vec2::new(3.0, 0.0),
                        links: 2,
                    }],
                    reach: 0.3,
                    ties: Ties::Parents { within: 1.7 },
                    root: ActorId(0),
                    root_role: None,
                    worker_role: WORKER,
                },
                healing: Healing::new(2),
            }
        }

        fn silence(&mut self, second: u32, robot: u32, begins: bool) {
            let now = SimTime::from_secs(second.into());
            let change = Change {
                fault: 7,
                begins,
                subject: Subject::Robot {
                    robot: ActorId(robot),
                    effect: Effect::Silence,
                    health: Health {
                        sends: !begins,
                        hears: !begins,
                        acts: true,
                    },
                },
            };
            let scene = Scene::new(&self.reports, &self.failures, &self.positions, &RANGE);
            let blow = Healing::brace(&change, &self.mission, scene);
            self.failures.change(now, &change, &self.reports);
            let scene = Scene::new(&self.reports, &self.failures, &self.positions, &RANGE);
            if let Some(blow) = blow {
                self.healing.strike(now, 7, &blow, &self.mission, scene);
            }
        }

        fn observe(&mut self, second: u32) {
            let scene = Scene::new(&self.reports, &self.failures, &self.positions, &RANGE);
            self.healing
                .observe(SimTime::from_secs(second.into()), &self.mission, scene);
        }
    }

    #[test]
    fn a_lost_relay_is_healed_once_another_gives_its_worker_the_second_link_again() {
        let mut stage = Stage::new();
        stage.silence(10, 1, true);
        stage.positions[1].x = 9.0; // Failed robots do not count.
        stage.positions[2].x -= 0.25;
        stage.healing.sent(Some(0), Topic(1), 6);
        stage.healing.sent(None, Topic(1), 6);
        stage.observe(11);
        assert!(stage.healing.is_open());
        stage.reports.note(ActorId(4), &Note::Target(Some(0)));
        stage.reports.note(ActorId(4), &Note::Parents(vec![ActorId(0)]));
        stage
            .reports
            .note(ActorId(3), &Note::Parents(vec![ActorId(4), ActorId(2)]));
        stage.positions[4].x = 1.5;
        stage.observe(12);
        stage.healing.sent(Some(0), Topic(1), 6);
        let [episode] = &stage.healing.into_episodes()[..] else {
            panic!("one episode")
        };
        assert_eq!((episode.links_before, episode.links_after), (2, 1));
        assert_eq!(episode.healed_at, Some(SimTime::from_secs(12.0)));
        assert!((episode.distance_m - 1.25).abs() < 1e-12);
        assert_eq!(
            (&episode.frames[..], &episode.payload_bytes[..]),
            (&[0, 1][..], &[0, 6][..])
        );
    }

    #[test]
    fn a_lost_worker_is_healed_only_by_one_that_is_at_the_target_again() {
        let mut stage = Stage::new();
        stage.silence(10, 3, true);
        stage.reports.note(ActorId(4), &Note::Role(WORKER));
        stage.reports.note(ActorId(4), &Note::Target(Some(0)));
        stage
            .reports
            .note(ActorId(4), &Note::Parents(vec![ActorId(1), ActorId(2)]));
        stage.observe(11);
        assert!(stage.healing.is_open(), "it is linked, and not there yet");
        assert_eq!(stage.healing.episodes[0].worker_m, Some(0.0));
        stage.positions[4] = Vec2::new(2.9, 0.1);
        stage.observe(12);
        assert_eq!(stage.healing.episodes[0].healed_at, Some(SimTime::from_secs(12.0)));
    }

    #[test]
    fn on_the_way_a_relay_need_not_wait_for_the_worker_and_another_worker_must_come_as_far() {
        let mut stage = Stage::new();
        stage.positions[3].x = 2.5;
        stage.silence(10, 1, true);
        stage.positions[3].x = 1.0;
        stage.silence(11, 1, false);
        stage.observe(11);
        assert!(!stage.healing.is_open(), "both links are there again");
        stage.silence(12, 3, true);
        stage.reports.note(ActorId(4), &Note::Role(WORKER));
        stage.reports.note(ActorId(4), &Note::Target(Some(0)));
        stage
            .reports
            .note(ActorId(4), &Note::Parents(vec![ActorId(1), ActorId(2)]));
        stage.observe(13);
        assert!(
            stage.healing.is_open(),
            "its place was 2 m from the target, the other is at 2.5 m"
        );
        stage.positions[4] = Vec2::new(1.1, 0.0);
        stage.observe(14);
        assert!(!stage.healing.is_open());
    }

    #[test]
    fn failures_at_one_time_overlap_a_harmless_one_is_healed_at_once_and_recovery_heals() {
        let mut stage = Stage::new();
        stage.silence(10, 4, true);
        assert_eq!(stage.healing.episodes, [], "it works for no target");
        stage.silence(10, 1, true);
        stage.silence(10, 2, true);
        stage.silence(10, 2, true);
        let seen = |stage: &Stage| {
            let episodes = stage.healing.episodes.iter();
            episodes
                .map(|episode| (episode.links_before, episode.overlapping, episode.healed_at.is_some()))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            seen(&stage),
            [(2, 1, false), (1, 1, false)],
            "a failed robot does not fail"
        );
        stage.silence(11, 2, false);
        stage.observe(11);
        assert_eq!(seen(&stage), [(2, 1, false), (1, 1, true)]);
        stage.silence(12, 1, false);
        stage.observe(12);
        stage.reports.note(ActorId(4), &Note::Target(Some(0)));
        stage.silence(12, 4, true);
        assert!(!stage.healing.is_open() && stage.healing.episodes.len() == 2);
    }
}

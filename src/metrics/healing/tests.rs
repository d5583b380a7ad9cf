//! Failures on a stage of five robots, and what mends their harm.

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
        for blow in blow {
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
fn a_lost_root_is_a_loss_of_each_target_until_chains_lead_to_its_successor() {
    const ROOT: Role = Role(2);
    let mut stage = Stage::new();
    stage.mission.root_role = Some(ROOT);
    let again = stage.mission.targets[0];
    stage.mission.targets.push(again);
    stage.silence(10, 0, true);
    let lost = stage.healing.episodes.iter();
    let lost: Vec<_> = lost
        .map(|episode| (episode.target, episode.links_before, episode.links_after))
        .collect();
    assert_eq!(lost, [(0, 2, 0), (1, 0, 0)], "nobody works for the other one");
    stage.observe(11);
    assert!(stage.healing.is_open());
    for relay in [1, 2] {
        stage.reports.note(ActorId(relay), &Note::Parents(vec![ActorId(4)]));
    }
    stage.reports.note(ActorId(4), &Note::Role(ROOT));
    stage.observe(12);
    assert!(!stage.healing.is_open());
    assert_eq!(stage.healing.episodes[0].healed_at, Some(SimTime::from_secs(12.0)));
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

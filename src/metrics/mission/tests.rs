//! Missions judged on a stage of four robots.

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

//! Robots whose neighbours fall silent, frame by frame.

use super::*;

/// Longer than the silence after which a robot is declared inactive.
const SILENT_S: f64 = 4.5;

fn adopt(to: u32, sequence: u8) -> Message {
    let (to, chain) = (ActorId(to), 1);
    Message::Request(Request::Adopt { to, sequence, chain })
}

/// A relay at 1.4 m whose parent is the root and whose child, `CHILD` at 2.8 m, is a relay below the worker.
fn relay() -> Bench {
    let mut relay = Bench::new(FREE, 1.4);
    relay.step(&[(CHILD, 2.8, join(FREE, 1))]);
    relay.run(0.3, &below());
    assert!(matches!(&relay.robot.duty, duty::Duty::Networker(networker) if networker.is_settled()));
    relay
}

const CHILD: u32 = OTHER_FREE;
const FAR: u32 = 9;

fn below() -> [(u32, f64, Message); 3] {
    [
        (ROOT, 0.0, status(Role::Root, false, 0)),
        (CHILD, 2.8, status(Role::Networker, false, 1)),
        (CHILD, 2.8, Message::ChildStrand(strand(FREE, &[WORKER, CHILD]))),
    ]
}

fn root_alone() -> [(u32, f64, Message); 1] {
    [(ROOT, 0.0, status(Role::Root, false, 0))]
}

#[test]
fn a_relay_that_lost_its_child_goes_out_wants_more_robots_and_serves_whoever_asks_from_beyond() {
    let mut relay = relay();
    let output = relay.run(SILENT_S, &root_alone());
    assert!(
        output.velocity.is_some_and(|velocity| velocity.x > 0.0),
        "towards its child's place"
    );
    assert!(
        output.broadcasts.contains(&status(Role::Networker, true, 1)),
        "it passes on a need"
    );
    let strand_without_child = Message::ChildStrand(strand(ROOT, &[WORKER, FREE]));
    assert!(output.broadcasts.contains(&strand_without_child));
    for _ in 0..2 {
        let asker = [status(Role::Worker, true, 1), adopt(FREE, 5)].map(|message| (WORKER, 3.0, message));
        let answers = requests(&relay.step(&asker));
        assert!(answers.contains(&accept(WORKER, 5)), "again and again: {answers:?}");
    }
    let output = relay.step(&[(WORKER, 3.0, Message::ChildStrand(strand(FREE, &[WORKER])))]);
    assert!(
        output
            .broadcasts
            .contains(&Message::ParentStrand(strand(WORKER, &[ROOT, FREE])))
    );
}

#[test]
fn a_relay_with_a_child_or_of_another_chain_or_below_the_asker_refuses_to_adopt() {
    let refused = |relay: &mut Bench, sender| {
        let to = ActorId(sender);
        let asker = [status(Role::Networker, true, 1), adopt(FREE, 5)].map(|message| (sender, 1.0, message));
        let answers = requests(&relay.step(&asker));
        answers.contains(&Request::Refuse { to, sequence: 5 })
    };
    assert!(refused(&mut relay(), FAR), "its child is there");
    let mut orphan = relay();
    orphan.run(SILENT_S, &root_alone());
    assert!(refused(&mut orphan, ROOT), "its parent asks");
    assert!(refused(&mut Bench::new(FREE, 0.7), FAR), "it is free");
}

#[test]
fn a_relay_that_lost_its_child_is_free_when_one_from_beyond_has_another_parent() {
    let mut relay = relay();
    relay.run(SILENT_S, &root_alone());
    relay.step(&[(WORKER, 3.0, Message::ChildStrand(strand(CHILD, &[WORKER])))]);
    assert_eq!(relay.role(), Role::Networker, "that one has not missed its parent yet");
    relay.step(&[(WORKER, 3.0, Message::ChildStrand(strand(FAR, &[WORKER])))]);
    assert_eq!(relay.role(), Role::Free);
}

#[test]
fn the_relay_next_to_a_lost_worker_takes_over_and_not_if_it_hears_another_worker() {
    for (another, role) in [(false, Role::Worker), (true, Role::Networker)] {
        let mut relay = Bench::new(FREE, 1.4);
        relay.step(&[(WORKER, 2.8, join(FREE, 1))]);
        let strand = Message::ChildStrand(strand(FREE, &[WORKER]));
        relay.run(
            0.3,
            &[(WORKER, 2.8, status(Role::Worker, true, 1)), (WORKER, 2.8, strand)],
        );
        let mut heard = root_alone().to_vec();
        heard.extend(another.then(|| (FAR, 2.0, status(Role::Worker, true, 1))));
        relay.run(SILENT_S, &heard);
        assert_eq!(relay.role(), role);
    }
}

#[test]
fn of_two_workers_of_one_target_the_farther_one_stands_down() {
    for (other, role) in [(2.0, Role::Free), (0.6, Role::Worker)] {
        let mut worker = Bench::new(WORKER, 1.2);
        worker.run(0.2, &[(FAR, other, status(Role::Worker, true, 1))]);
        assert_eq!(worker.role(), role, "the other at {other} m");
    }
}

/// A worker at 4.2 m whose parent is `FREE` at 2.8 m.
fn worker_with_parent() -> Bench {
    let mut worker = Bench::new(WORKER, 1.2);
    worker.step(&[(FREE, 0.7, status(Role::Free, false, 0))]);
    worker.step(&[(FREE, 0.7, Message::Request(accept(WORKER, 1)))]);
    worker.step(&[(FREE, 0.7, status(Role::Networker, true, 1))]);
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(FREE));
    worker.x = 4.2;
    worker.run(1.0, &[(FREE, 2.8, status(Role::Networker, true, 1))]);
    worker
}

#[test]
fn a_worker_that_lost_its_parent_comes_in_and_asks_the_relay_beyond_to_adopt_it() {
    let mut worker = worker_with_parent();
    let nobody_near = [(FAR, 4.0, status(Role::Free, false, 0))];
    let output = worker.run(SILENT_S, &nobody_near);
    assert!(output.velocity.is_some_and(|velocity| velocity.x < 0.0));
    assert_eq!(
        worker.robot.duty.slots()[0].parent,
        ActorId(ROOT),
        "for want of another"
    );
    assert!(
        !output
            .broadcasts
            .iter()
            .any(|message| matches!(message, Message::ChildStrand(_))),
        "nobody is told that it is linked"
    );
    let relay = (OTHER_FREE, 2.6, status(Role::Networker, true, 1));
    let asked = requests(&worker.step(std::slice::from_ref(&relay)));
    let [Request::Adopt { to, sequence, .. }] = asked[..] else {
        panic!("{asked:?}")
    };
    assert_eq!(to, ActorId(OTHER_FREE));
    let answer = Message::Request(Request::Accept {
        to: ActorId(WORKER),
        sequence,
    });
    let output = worker.step(&[(OTHER_FREE, 2.6, answer)]);
    assert!(
        output
            .broadcasts
            .contains(&Message::ChildStrand(strand(OTHER_FREE, &[WORKER])))
    );
}

#[test]
fn a_parent_suspected_wrongly_is_taken_back_when_it_is_heard_again() {
    let mut worker = worker_with_parent();
    worker.run(SILENT_S, &[(FAR, 4.0, status(Role::Free, false, 0))]);
    let parent = [
        (FREE, 2.8, status(Role::Networker, true, 1)),
        (FREE, 2.8, Message::ParentStrand(strand(WORKER, &[ROOT, FREE]))),
    ];
    let answers = requests(&worker.step(&parent));
    assert!(!answers.contains(&Request::Release { to: ActorId(FREE) }));
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(FREE));
}

#[test]
fn a_parent_whose_way_to_the_root_leads_through_its_child_is_given_up() {
    let mut worker = worker_with_parent();
    let circle = Message::ParentStrand(strand(WORKER, &[ROOT, WORKER, FREE]));
    worker.step(&[(FREE, 2.8, circle)]);
    assert_ne!(worker.robot.duty.slots()[0].parent, ActorId(FREE));
}

#[test]
fn a_robot_that_hears_nobody_comes_in_beside_the_chains_and_is_free_when_it_must_hear_the_root() {
    let mut worker = worker_with_parent();
    let output = worker.run(SILENT_S, &[]);
    assert_eq!(worker.role(), Role::Worker, "it may meet somebody");
    let velocity = output.velocity.expect("a command");
    assert!(velocity.x < 0.0, "towards the root: {velocity}");
    worker.x = 1.6;
    worker.step(&[]);
    assert_eq!(worker.role(), Role::Free);
}

#[test]
fn the_root_asks_a_free_robot_to_replace_the_lost_end_of_a_chain_and_that_one_waits_for_those_beyond() {
    let mut root = Bench::new(ROOT, 0.0);
    let free = (OTHER_FREE, 0.4, status(Role::Free, false, 0));
    let end = [
        (FREE, 1.4, status(Role::Networker, false, 1)),
        (FREE, 1.4, Message::ChildStrand(strand(ROOT, &[WORKER, 8, FREE]))),
        free.clone(),
    ];
    root.run(1.0, &end);
    let asked = requests(&root.run(SILENT_S, &[free]));
    let replace = |sequence| Request::Replace {
        to: ActorId(OTHER_FREE),
        sequence,
        chain: 1,
        child: ActorId(8),
        beyond: 2,
    };
    assert_eq!(asked, [replace(1)]);

    let mut spare = Bench::new(OTHER_FREE, 0.4);
    for _ in 0..2 {
        let answers = requests(&spare.step(&[(ROOT, 0.0, Message::Request(replace(1)))]));
        assert_eq!(answers, [accept(ROOT, 1)]);
    }
    assert_eq!(spare.role(), Role::Networker);
    let output = spare.run(10.0, &root_alone());
    assert!(
        output.velocity.is_some_and(|velocity| velocity.x > 0.0),
        "out, and it does not give up soon"
    );
    let asker = [status(Role::Networker, true, 1), adopt(OTHER_FREE, 3)].map(|message| (8, 2.0, message));
    let answers = requests(&spare.step(&asker));
    assert_eq!(answers, [accept(8, 3)]);
}

#[test]
fn the_root_appoints_a_worker_for_a_target_that_has_none_left() {
    let mut root = Bench::new(ROOT, 0.0);
    let free = [(OTHER_FREE, 0.4, status(Role::Free, false, 0))];
    assert_eq!(requests(&root.run(7.0, &free)), []);
    let asked = requests(&root.run(1.5, &free));
    let work = Request::Work {
        to: ActorId(OTHER_FREE),
        sequence: 1,
        target: 0,
    };
    assert_eq!(asked, [work]);
    let mut spare = Bench::new(OTHER_FREE, 0.4);
    let answers = requests(&spare.step(&[(ROOT, 0.0, Message::Request(work))]));
    assert!(answers.contains(&accept(ROOT, 1)), "{answers:?}");
    assert_eq!(spare.role(), Role::Worker);
}

/// The root with a chain of two relays, of which it heard at 1.4 m the one with id `FREE`; so many free robots are near.
fn root_with_chain(free: u32) -> (Bench, Vec<(u32, f64, Message)>) {
    let mut root = Bench::new(ROOT, 0.0);
    let mut heard = vec![
        (FREE, 1.4, status(Role::Networker, false, 1)),
        (FREE, 1.4, Message::ChildStrand(strand(ROOT, &[WORKER, CHILD, FREE]))),
    ];
    heard.extend((0..free).map(|robot| (20 + robot, 0.4, status(Role::Free, false, 0))));
    root.run(SILENT_S, &heard);
    assert_eq!(root.robot.known.order, Order::default(), "nobody was lost");
    (root, heard)
}

#[test]
fn from_the_first_lost_robot_on_the_root_orders_as_large_a_reserve_as_robots_are_enough_for() {
    // The chain needs two relays, each step of reserve one more, and one robot is to be left.
    for (free, reserve) in [(0, 0), (2, 0), (3, 1), (4, 2), (9, 2)] {
        let (mut root, mut heard) = root_with_chain(free);
        heard[1].2 = Message::ChildStrand(strand(ROOT, &[WORKER, FREE]));
        root.run(0.2, &heard);
        assert_eq!(root.robot.known.order.reserve, reserve, "{free} free robots");
    }
}

#[test]
fn a_robot_that_leaves_its_chain_in_the_roots_sight_is_not_a_lost_one() {
    let (mut root, mut heard) = root_with_chain(9);
    heard[1].2 = Message::ChildStrand(strand(ROOT, &[WORKER, FREE]));
    heard.push((CHILD, 1.0, status(Role::Free, false, 0)));
    heard.rotate_right(1);
    root.run(0.2, &heard);
    assert_eq!(root.robot.known.order.reserve, 0);
}

#[test]
fn the_reserve_is_reduced_when_robots_were_too_few_for_it_for_long_and_not_before() {
    let (mut root, mut heard) = root_with_chain(4);
    heard[1].2 = Message::ChildStrand(strand(ROOT, &[WORKER, FREE]));
    root.run(0.2, &heard);
    let fewer = &heard[..heard.len() - 1];
    root.run(13.0, fewer);
    assert_eq!(
        root.robot.known.order.reserve, 2,
        "missed after 4 s, and then 10 s of patience"
    );
    root.run(2.0, fewer);
    assert_eq!(root.robot.known.order.reserve, 1);
}

#[test]
fn a_relay_at_the_root_recruits_beyond_the_fewest_when_a_reserve_is_ordered_though_its_worker_needs_none() {
    let order = |reserve| {
        let dismantled = TargetSet::default();
        let epoch = reserve;
        (
            ROOT,
            0.0,
            Message::Request(Request::Order(Order {
                epoch,
                dismantled,
                reserve,
            })),
        )
    };
    for (robots, reserve, recruits) in [(2, 0, false), (2, 1, true), (3, 1, false), (3, 2, true)] {
        let mut relay = relay();
        let outer: Vec<u32> = [WORKER, FAR, CHILD][3 - robots..].to_vec();
        let mut heard = below().to_vec();
        heard[2].2 = Message::ChildStrand(strand(FREE, &outer));
        heard.extend([order(reserve), (20, 0.4, status(Role::Free, false, 0))]);
        let asks = requests(&relay.run(0.3, &heard));
        let joins = asks
            .iter()
            .any(|request| matches!(request, Request::Join { to: ActorId(20), .. }));
        assert_eq!(joins, recruits, "{robots} relays, a reserve of {reserve}");
    }
}

#[test]
fn of_the_relays_beside_a_lost_worker_the_one_nearest_to_the_target_takes_over_at_once() {
    for (other, waits) in [(1.3, false), (1.5, true)] {
        let mut relay = Bench::new(FREE, 1.4);
        relay.step(&[(WORKER, 2.8, join(FREE, 1))]);
        let strand = Message::ChildStrand(strand(FREE, &[WORKER]));
        relay.run(
            0.3,
            &[(WORKER, 2.8, status(Role::Worker, true, 1)), (WORKER, 2.8, strand)],
        );
        let heard = [
            (ROOT, 0.0, status(Role::Root, false, 0)),
            (FAR, other, status(Role::Networker, false, 1)),
        ];
        relay.run(4.2, &heard);
        let role = if waits { Role::Networker } else { Role::Worker };
        assert_eq!(relay.role(), role, "the other at {other} m");
        relay.run(1.0, &heard);
        assert_eq!(relay.role(), Role::Worker, "the other did not");
    }
}

#[test]
fn a_robot_that_hears_nobody_is_free_where_it_stops_though_that_is_not_within_reach_of_the_root() {
    let mut worker = worker_with_parent();
    worker.run(SILENT_S, &[]);
    // Its only target lies ahead, so its waiting place is behind the root, 1.7 m away, and aside by its share of the spread.
    (worker.x, worker.y) = (-1.77, 0.54);
    let output = worker.step(&[]);
    assert_eq!((worker.role(), output.velocity), (Role::Free, Some(Vec2::zeros())));
}

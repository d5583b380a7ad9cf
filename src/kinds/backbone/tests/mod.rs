//! Robots that are handed frames by hand: joining, its undoing, and orders.

mod gossip;
mod healing;

use super::*;
use crate::protocol::control::PhaseConfig;
use crate::protocol::{Address, Frame, TimerId};
use rand_philox::Philox;

const ROOT: u32 = 0;
const WORKER: u32 = 1;
const FREE: u32 = 2;
const OTHER_FREE: u32 = 3;

/// A root at the centre, a worker far enough out to recruit, and two free robots in between.
fn robots(targets: u8) -> Vec<Backbone> {
    robots_with(targets, &GossipConfig::default())
}

fn robots_with(targets: u8, gossip: &GossipConfig) -> Vec<Backbone> {
    let config = format!("(targets: Ring(count: {targets}, radius: 4.5), healing: (reserve: 2))");
    let config = ron::from_str(&config).unwrap();
    let poses: Vec<Pose> = [0.0, 1.2, 0.7, 0.4]
        .map(|x| Pose {
            position: Vec2::new(x, 0.0),
            heading: 0.0,
        })
        .into();
    swarm(
        &config,
        gossip,
        &DetectorConfig::default(),
        &ControlConfig {
            phase: PhaseConfig::Together,
            ..ControlConfig::default()
        },
        &poses,
        Streams::new(1, 0),
    )
}

/// The world of one robot under test: it hears what the test says and keeps count of time.
struct Bench {
    robot: Backbone,
    x: f64,
    y: f64,
    sequence: u32,
}

impl Bench {
    fn new(robot: u32, x: f64) -> Self {
        Self::with(&GossipConfig::default(), robot, x)
    }

    fn with(gossip: &GossipConfig, robot: u32, x: f64) -> Self {
        Self::of(robots_with(1, gossip).remove(robot as usize), x)
    }

    fn of(robot: Backbone, x: f64) -> Self {
        Self {
            robot,
            x,
            y: 0.0,
            sequence: 0,
        }
    }

    /// One control step in which `heard` arrives: sender, its place on the x axis, what it says.
    fn step(&mut self, heard: &[(u32, f64, Message)]) -> Output<Message> {
        let now = SimTime::from_secs(0.1 * self.robot.known.step as f64);
        self.sequence += 1;
        let inbox = heard.iter().map(|(sender, x, message)| Reception {
            at: now,
            frame: Frame {
                sender: ActorId(*sender),
                sequence: self.sequence,
                sent_at: now,
                payload_bytes: 4,
                rides: false,
                address: Address::Everyone,
                message: Rc::new(message.clone()),
            },
            displacement: [(x - self.x) as f32, -self.y as f32],
        });
        let mut input = Input {
            powers: Vec::new(),
            outcomes: Vec::new(),
            me: ActorId(0),
            wake: Wake::ControlStep,
            inbox: inbox.collect(),
            pose: Pose {
                position: Vec2::new(self.x, self.y),
                heading: 0.0,
            },
            proximity: Vec::new(),
            random: Philox::from_u64_seed(1),
        };
        let mut output = Output::default();
        self.robot.known.detector.expire(now, &mut input.random, &mut output);
        output.clear();
        self.robot.step(now, &mut input, &mut output);
        output
    }

    /// Control steps in which `heard` arrives, for `seconds`; the last one's output.
    fn run(&mut self, seconds: f64, heard: &[(u32, f64, Message)]) -> Output<Message> {
        let steps = (seconds / 0.1).round() as usize;
        (0..steps).fold(Output::default(), |_, _| self.step(heard))
    }

    fn role(&self) -> Role {
        self.robot.duty.role()
    }
}

fn status(role: Role, need: bool, chain: u8) -> Message {
    Message::Status(Status {
        role,
        previous: Role::Free,
        need,
        chain,
    })
}

fn join(to: u32, sequence: u8) -> Message {
    Message::Request(Request::Join {
        to: ActorId(to),
        sequence,
        chain: 1,
    })
}

fn strand(next: u32, robots: &[u32]) -> Strand {
    Strand {
        chain: 1,
        next: ActorId(next),
        robots: robots.iter().copied().map(ActorId).collect(),
    }
}

fn requests(output: &Output<Message>) -> Vec<Request> {
    let request = |message: &Message| match message {
        Message::Request(request) => Some(*request),
        _ => None,
    };
    output.broadcasts.iter().filter_map(request).collect()
}

fn accept(to: u32, sequence: u8) -> Request {
    let to = ActorId(to);
    Request::Accept { to, sequence }
}

#[test]
fn every_role_is_reported_at_the_first_step() {
    for (robot, role) in [(ROOT, Role::Root), (WORKER, Role::Worker)] {
        let notes = Bench::new(robot, 0.0).step(&[]).notes;
        assert!(notes.contains(&Note::Role(role.index())), "{notes:?}");
    }
    assert_eq!(Bench::new(FREE, 0.7).step(&[]).notes, []);
    let notes = Bench::new(WORKER, 1.2).step(&[]).notes;
    assert!(notes.contains(&Note::Parents(vec![ActorId(ROOT)])));
    assert!(notes.contains(&Note::Target(Some(0))));
}

#[test]
fn a_free_robot_accepts_the_first_request_again_and_again_and_refuses_all_others() {
    let mut free = Bench::new(FREE, 0.7);
    assert_eq!(
        requests(&free.step(&[(WORKER, 1.2, join(FREE, 7))])),
        [accept(WORKER, 7)]
    );
    assert_eq!(
        requests(&free.step(&[(WORKER, 1.2, join(FREE, 7))])),
        [accept(WORKER, 7)]
    );
    let refusal = Request::Refuse {
        to: ActorId(OTHER_FREE),
        sequence: 9,
    };
    assert_eq!(requests(&free.step(&[(OTHER_FREE, 0.4, join(FREE, 9))])), [refusal]);
}

#[test]
fn a_request_for_an_unknown_chain_or_for_another_robot_is_not_accepted() {
    let mut free = Bench::new(FREE, 0.7);
    let nonsense = Message::Request(Request::Join {
        to: ActorId(FREE),
        sequence: 1,
        chain: 77,
    });
    assert!(matches!(
        requests(&free.step(&[(WORKER, 1.2, nonsense)]))[..],
        [Request::Refuse { .. }]
    ));
    assert_eq!(requests(&free.step(&[(WORKER, 1.2, join(OTHER_FREE, 1))])), []);
}

#[test]
fn a_worker_asks_the_free_robot_nearest_to_the_joining_place_and_repeats_itself() {
    let mut worker = Bench::new(WORKER, 1.2);
    let heard = [
        (FREE, 0.7, status(Role::Free, false, 0)),
        (OTHER_FREE, 0.4, status(Role::Free, false, 0)),
    ];
    let asked = |output: &Output<Message>| match requests(output)[..] {
        [Request::Join { to, sequence, .. }] => (to, sequence),
        ref other => panic!("{other:?}"),
    };
    let first = asked(&worker.step(&heard));
    // The place is half a spring's length behind the worker, at 0.5 m: both are near, the one at 0.4 m is nearer.
    assert_eq!(first.0, ActorId(OTHER_FREE));
    assert_eq!(asked(&worker.step(&heard)), first);
    let refusal = Message::Request(Request::Refuse {
        to: ActorId(WORKER),
        sequence: first.1,
    });
    let second = asked(&worker.step(&[(OTHER_FREE, 0.4, refusal)]));
    assert_eq!(second.0, ActorId(FREE));
    assert_ne!(second.1, first.1);
}

#[test]
fn a_request_without_an_answer_is_given_up_and_goes_to_another_robot() {
    let mut worker = Bench::new(WORKER, 1.2);
    let heard = [
        (FREE, 0.7, status(Role::Free, false, 0)),
        (OTHER_FREE, 0.4, status(Role::Free, false, 0)),
    ];
    let mut asked: Vec<ActorId> = (0..60)
        .flat_map(|_| requests(&worker.step(&heard)))
        .filter_map(|request| match request {
            Request::Join { to, .. } => Some(to),
            _ => None,
        })
        .collect();
    asked.dedup();
    assert_eq!(asked, [ActorId(OTHER_FREE), ActorId(FREE)]);
}

#[test]
fn a_joiner_in_place_becomes_the_parent_and_the_child_strand_names_it() {
    let mut worker = Bench::new(WORKER, 1.2);
    worker.step(&[(FREE, 0.7, status(Role::Free, false, 0))]);
    let agreed = Message::Request(accept(WORKER, 1));
    let output = worker.step(&[(FREE, 0.7, agreed), (FREE, 0.7, status(Role::Networker, true, 1))]);
    // A frame cannot be older than the one before it from the same sender: the status of the next step counts.
    let next = worker.step(&[(FREE, 0.7, status(Role::Networker, true, 1))]);
    let broadcasts = [output.broadcasts, next.broadcasts].concat();
    assert!(broadcasts.contains(&Message::ChildStrand(strand(FREE, &[WORKER]))));
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(FREE));
}

#[test]
fn a_joiner_behind_the_root_is_not_taken_into_the_chain() {
    let mut worker = Bench::new(WORKER, 1.2);
    worker.step(&[(FREE, -0.1, status(Role::Free, false, 0))]);
    worker.step(&[(FREE, -0.1, Message::Request(accept(WORKER, 1)))]);
    worker.step(&[(FREE, -0.1, status(Role::Networker, true, 1))]);
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(ROOT));
}

#[test]
fn an_acceptance_or_a_strand_that_nobody_waits_for_is_answered_with_a_release() {
    let release = Request::Release { to: ActorId(FREE) };
    let surplus = Message::Request(accept(WORKER, 5));
    assert!(requests(&Bench::new(WORKER, 1.2).step(&[(FREE, 0.7, surplus)])).contains(&release));
    let stray = Message::ParentStrand(strand(WORKER, &[ROOT, FREE]));
    assert!(requests(&Bench::new(WORKER, 1.2).step(&[(FREE, 0.7, stray)])).contains(&release));
}

#[test]
fn a_joiner_that_is_released_or_never_confirmed_is_free_again() {
    let mut free = Bench::new(FREE, 0.7);
    free.step(&[(WORKER, 1.2, join(FREE, 1))]);
    assert_eq!(free.robot.duty.role(), Role::Networker);
    let release = Message::Request(Request::Release { to: ActorId(FREE) });
    free.step(&[(OTHER_FREE, 0.4, release.clone())]);
    assert_eq!(free.robot.duty.role(), Role::Networker, "only its child lets it go");
    let notes = free.step(&[(WORKER, 1.2, release)]).notes;
    assert!(notes.contains(&Note::Role(Role::Free.index())));

    free.step(&[(WORKER, 1.2, join(FREE, 2))]);
    for _ in 0..42 {
        free.step(&[]);
    }
    assert_eq!(free.robot.duty.role(), Role::Free);
}

#[test]
fn a_linked_networker_passes_on_need_and_both_strands() {
    let mut relay = Bench::new(FREE, 0.7);
    let worker = || (WORKER, 1.2, status(Role::Worker, true, 1));
    relay.step(&[(WORKER, 1.2, join(FREE, 1)), worker()]);
    let output = relay.step(&[(WORKER, 1.2, Message::ChildStrand(strand(FREE, &[WORKER]))), worker()]);
    for message in [
        Message::ParentStrand(strand(WORKER, &[ROOT, FREE])),
        Message::ChildStrand(strand(ROOT, &[WORKER, FREE])),
        status(Role::Networker, true, 1),
    ] {
        assert!(
            output.broadcasts.contains(&message),
            "{message:?} in {:?}",
            output.broadcasts
        );
    }
}

#[test]
fn a_worker_whose_parent_serves_it_no_more_falls_back_to_the_root() {
    let mut worker = Bench::new(WORKER, 1.2);
    worker.step(&[(FREE, 0.7, status(Role::Free, false, 0))]);
    worker.step(&[(FREE, 0.7, Message::Request(accept(WORKER, 1)))]);
    worker.step(&[(FREE, 0.7, status(Role::Networker, true, 1))]);
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(FREE));
    worker.step(&[(FREE, 0.7, status(Role::Free, false, 0))]);
    assert_eq!(worker.robot.duty.slots()[0].parent, ActorId(ROOT));
}

fn only(target: u8) -> TargetSet {
    let mut set = TargetSet::default();
    set.insert(target);
    set
}

#[test]
fn a_root_that_sees_too_few_robots_for_long_leaves_out_a_target_and_not_before() {
    let mut root = Bench::new(ROOT, 0.0);
    root.robot = robots(2).remove(ROOT as usize);
    let workers = [WORKER, FREE].map(|worker| (worker, 1.2, status(Role::Worker, true, worker as u8)));
    root.run(10.0, &workers);
    assert_eq!(root.robot.known.order, Order::default());
    root.step(&workers);
    let order = Order {
        epoch: 1,
        dismantled: only(1),
        reserve: 0,
    };
    assert_eq!(root.robot.known.order, order);
    let repeated = (0..10).flat_map(|_| requests(&root.step(&workers))).collect::<Vec<_>>();
    assert!(repeated.contains(&Request::Order(order)));
}

#[test]
fn a_root_with_enough_robots_orders_nothing() {
    let mut root = Bench::new(ROOT, 0.0);
    let enough = [
        (WORKER, 1.2, status(Role::Worker, true, 1)),
        (FREE, 0.7, status(Role::Free, false, 0)),
        (OTHER_FREE, 0.4, status(Role::Free, false, 0)),
    ];
    for _ in 0..300 {
        assert_eq!(requests(&root.step(&enough)), []);
    }
}

#[test]
fn an_older_order_does_not_undo_a_newer_one() {
    let mut free = Bench::new(FREE, 0.7);
    let order = |epoch, dismantled| Order {
        epoch,
        dismantled,
        reserve: 0,
    };
    let (newer, older) = (order(2, only(1)), order(1, TargetSet::default()));
    free.step(&[newer, older].map(|order| (ROOT, 0.0, Message::Request(Request::Order(order)))));
    assert_eq!(free.robot.known.order, newer);
    let (zero, last) = (order(0, TargetSet::default()), order(255, TargetSet::default()));
    assert!(zero.is_newer_than(last), "numbers wrap");
}

#[test]
fn wakes_other_than_control_steps_only_listen() {
    let mut robot = robots(1).remove(FREE as usize);
    let mut output = Output::default();
    for wake in [Wake::Reception, Wake::Timer(TimerId(0))] {
        let mut input = Input {
            powers: Vec::new(),
            outcomes: Vec::new(),
            me: ActorId(0),
            wake,
            inbox: Vec::new(),
            pose: Pose::default(),
            proximity: Vec::new(),
            random: Philox::from_u64_seed(1),
        };
        robot.step(SimTime::ZERO, &mut input, &mut output);
    }
    assert!(output.broadcasts.is_empty() && output.velocity.is_none());
}

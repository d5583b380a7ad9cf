//! Who is in range of whom, where that does not follow from a distance alone: everything in a run that asks for it goes by the one relation that
//! the radio has.

use std::collections::BTreeSet;
use std::sync::Arc;

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::{Pose, Vec2, unit};
use desim::metrics::Graph;
use desim::motion::{ObstacleConfig, World};
use desim::protocol::control::PhaseConfig;
use desim::protocol::detector::DetectorConfig;
use desim::protocol::{Input, Note, Output, Protocol, Role, Serialised, Topic};
use desim::quantity::{Finite, NonNegative, Positive};
use desim::radio::{
    Fate, Fates, Links, LossCause, Medium, Obstacle, Placed, Places, RadioKind, RadioSite, Reach, Shape, Transmission,
};
use desim::simulation::{Copy, DriverKind, Finished, Inbox, Observer, Sent, Setup};
use proptest::prelude::*;
use tokio_util::sync::CancellationToken;

/// The fixed walls of the arena let nothing through. Even robots are heard from 2 m away, odd ones from 1 m.
#[derive(Clone, Debug)]
struct Walls(Vec<Obstacle>);

const FARTHEST: f64 = 2.0;

impl Links for Walls {
    fn farthest(&self) -> f64 {
        FARTHEST
    }

    fn connects(&self, (sender, from): Placed, (_, to): Placed) -> bool {
        let range = if sender.0.is_multiple_of(2) { FARTHEST } else { 1.0 };
        (to - from).norm() <= range && !self.0.iter().any(|wall| crosses(wall, from, to))
    }
}

/// Whether the way from `from` to `to` crosses `wall`.
fn crosses(wall: &Obstacle, from: Vec2, to: Vec2) -> bool {
    let Shape::Segment(a, b) = wall.shape else {
        panic!("walls only")
    };
    let side = |point: Vec2, of: Vec2, along: Vec2| along.perp(&(point - of)) > 0.0;
    side(from, a, b - a) != side(to, a, b - a) && side(a, from, to - from) != side(b, from, to - from)
}

/// A radio over which everything arrives at once where it is offered, by the walls that it finds in the arena.
#[derive(Debug)]
struct Walled;

impl RadioKind for Walled {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        Box::new(Instant(Reach::Links(Arc::new(Walls(site.obstacles.clone())))))
    }
}

struct Instant(Reach);

impl Medium for Instant {
    fn reach(&self) -> Reach {
        self.0.clone()
    }

    fn lookahead(&self) -> Span {
        Span::ZERO
    }

    fn transmit(&mut self, frame: &Transmission<'_>, places: &dyn Places, fates: &mut Fates) {
        assert_eq!(places.position(frame.frame.sender, frame.at), frame.position);
        let mut near = BTreeSet::new();
        places.for_each_within(frame.position, frame.at, FARTHEST, &mut |robot, place| {
            assert_eq!(place, places.position(robot, frame.at));
            near.insert(robot);
        });
        assert!(
            near.contains(&frame.frame.sender),
            "a sender is within any range of itself"
        );
        for listener in frame.listeners {
            assert!(near.contains(&listener.id));
            let there = places.position(listener.id, frame.at);
            assert!((frame.position - there - listener.sender).norm() < 1e-12);
            let arrives = Fate::Arrives {
                at: frame.at,
                displacement: [0.0; 2],
            };
            fates.push(listener.id, arrives);
        }
    }
}

/// A run over a walled radio, with a wall along the y axis from −`half` to `half` m, which bodies go around.
fn setup(seconds: f64, half: f64) -> Setup {
    let mut setup = Setup::lasting(Span::from_secs(seconds));
    let end = |y| (Finite::new(0.0), Finite::new(y));
    setup.arena.obstacles = vec![ObstacleConfig::Wall {
        from: end(-half),
        to: end(half),
        attenuation: Some(NonNegative::new(8.0)),
    }];
    setup.motion.max_speed = Positive::new(0.5);
    setup.control.phase = PhaseConfig::Random;
    setup.metrics.sample_interval = NonNegative::new(0.5);
    setup.own_radio = Some(Arc::new(Walled));
    setup
}

fn run<P: Protocol, O: Observer>(setup: &Setup, places: &[Vec2], robots: Vec<P>, observer: O) -> Finished<P, O> {
    let pose = |&position| Pose { position, heading: 0.0 };
    let poses = places.iter().map(pose).collect();
    let finished = setup.observe(poses, robots, DriverKind::Inline, &CancellationToken::new(), observer);
    finished.expect("the run reaches its end")
}

/// Roams, and says things to all and to one.
struct Roamer;

impl Protocol for Roamer {
    type Message = (u8, u8);
    type Heard = (u8, u8);
    type Codec = Serialised<(u8, u8)>;
    const TOPICS: &'static [&'static str] = &["all", "one"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(message: &(u8, u8)) -> Topic {
        Topic(message.0)
    }

    fn step(&mut self, _: SimTime, input: &mut Input<(u8, u8)>, output: &mut Output<(u8, u8)>) {
        output.broadcast((0, 0));
        output.send(
            ActorId((input.me.0 + input.random.random_range(1..ROAMERS)) % ROAMERS),
            (1, 0),
        );
        if input.random.random_bool(0.1) {
            output.velocity = Some(unit(input.random.random_range(0.0..6.3)) * 0.4);
        }
    }
}

const ROAMERS: u32 = 12;

/// Holds what is offered, and the samples of the graph, against the relation.
struct Witness {
    reach: Reach,
    /// What the present robot has said: to whom, and the copies of it.
    said: Vec<(Option<ActorId>, u64)>,
    reached: Vec<Vec<ActorId>>,
    lost: Vec<ActorId>,
    /// By sample: pieces, mean degree and λ₂.
    graphs: Vec<(u32, f64, f64)>,
    /// Pairs near each other that a wall parts, one-way links, addressees out of range.
    seen: [u32; 3],
}

fn placed(positions: &[Vec2]) -> Vec<Placed> {
    (0..).map(ActorId).zip(positions.iter().copied()).collect()
}

impl Observer for Witness {
    fn sent(&mut self, message: &Sent<'_>) {
        self.said.push((message.to, message.copies));
        self.reached.push(Vec::new());
    }

    fn arrives(&mut self, copy: &Copy, _: SimTime) {
        self.reached.last_mut().expect("it was sent").push(copy.receiver);
    }

    fn lost(&mut self, copy: &Copy, cause: LossCause, _: SimTime) {
        assert_eq!(cause, LossCause::BelowSensitivity);
        self.lost.push(copy.receiver);
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        let at = |robot| (robot, world.position(robot, now));
        let others = (0..ROAMERS).map(ActorId).filter(|other| *other != robot);
        let hearing: Vec<ActorId> = others.filter(|other| self.reach.hears(at(robot), at(*other))).collect();
        for ((to, copies), mut reached) in self.said.drain(..).zip(self.reached.drain(..)) {
            reached.sort_unstable();
            match to {
                None => assert_eq!((copies, reached), (hearing.len() as u64, hearing.clone())),
                Some(to) if hearing.contains(&to) => assert_eq!((copies, reached), (1, vec![to])),
                Some(to) => {
                    assert_eq!((copies, reached, self.lost.pop()), (1, Vec::new(), Some(to)));
                    self.seen[2] += 1;
                }
            }
        }
        assert!(self.lost.is_empty());
    }

    fn sample(&mut self, _: SimTime, positions: &[Vec2]) {
        let robots = placed(positions);
        let mut edges = Vec::new();
        for (place, &a) in robots.iter().enumerate() {
            for &b in &robots[place + 1..] {
                match [self.reach.hears(a, b), self.reach.hears(b, a)] {
                    [true, true] => edges.push([a.0.0, b.0.0]),
                    [false, false] => self.seen[0] += u32::from((b.1 - a.1).norm() < 1.0),
                    _ => self.seen[1] += 1,
                }
            }
        }
        let graph = Graph::new(robots.len(), edges);
        let told = (
            graph.components() as u32,
            graph.mean_degree(),
            graph.algebraic_connectivity(),
        );
        self.graphs.push(told);
    }
}

/// What one run may happen not to see, six do.
#[test]
fn all_is_seen_that_can_be() {
    let mut all = [0; 3];
    for seed in 0..6 {
        let mut setup = setup(20.0, 1.5);
        setup.seed = seed;
        let place = |robot: u32| Vec2::new(f64::from(robot % 4) - 1.5, f64::from(robot / 4) - 1.0);
        let places: Vec<Vec2> = (0..12).map(place).collect();
        let robots = (0..ROAMERS).map(|_| Roamer).collect();
        let seen = run(&setup, &places, robots, witness(&setup)).observer.seen;
        all.iter_mut().zip(seen).for_each(|(sum, count)| *sum += count);
    }
    assert!(all.iter().all(|count| *count > 0), "{all:?}");
}

fn witness(setup: &Setup) -> Witness {
    Witness {
        reach: setup.reach(ROAMERS as usize),
        said: Vec::new(),
        reached: Vec::new(),
        lost: Vec::new(),
        graphs: Vec::new(),
        seen: [0; 3],
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn what_is_offered_and_what_the_graph_is_follow_from_the_relation(seed: u64, half in 0.5..2.5_f64) {
        let mut setup = setup(20.0, half);
        setup.seed = seed;
        let places: Vec<Vec2> = (0..12).map(|robot| Vec2::new(f64::from(robot % 4) - 1.5, f64::from(robot / 4) - 1.0)).collect();
        let finished = run(&setup, &places, (0..ROAMERS).map(|_| Roamer).collect(), witness(&setup));
        let Witness { reach, graphs, .. } = finished.observer;
        let samples: Vec<_> = finished.record.connectivity.iter().collect();
        prop_assert_eq!(samples.len(), graphs.len());
        for (sample, (components, degree, lambda2)) in samples.iter().zip(graphs) {
            prop_assert_eq!(sample.components, components);
            prop_assert!((sample.neighbours - degree).abs() < 1e-12);
            prop_assert!((sample.lambda2 - lambda2).abs() < 1e-6 * lambda2.max(1e-3), "{} and {}", sample.lambda2, lambda2);
        }
        // What pictures draw.
        let ends = placed(&finished.record.robots.iter().map(|robot| robot.pose.position).collect::<Vec<_>>());
        let linked = |a: Placed, b: Placed| a.0 < b.0 && reach.hears(a, b) && reach.hears(b, a);
        let pairs = ends.iter().flat_map(|a| ends.iter().filter(|b| linked(*a, **b)).map(|b| (a.1, b.1)));
        prop_assert_eq!(finished.record.links_at_end(&reach), pairs.collect::<Vec<_>>());
    }
}

#[test]
fn a_radio_is_told_what_stands_in_the_arena_and_how_wide_its_robots_are() {
    #[derive(Debug)]
    struct Asks(std::sync::Mutex<Vec<RadioSite>>);
    impl RadioKind for Asks {
        fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
            self.0.lock().unwrap().push(site.clone());
            Walled.medium(site)
        }
    }
    let mut setup = setup(1.0, 1.5);
    setup.arena.obstacles.push(ObstacleConfig::Disc {
        at: (Finite::new(3.0), Finite::new(-2.0)),
        radius: Positive::new(0.25),
        attenuation: None,
    });
    setup.motion.body_radius = Positive::new(0.11);
    let asks = Arc::new(Asks(std::sync::Mutex::default()));
    setup.own_radio = Some(asks.clone());
    let _ = setup.reach(7);
    let told = &asks.0.lock().unwrap()[0];
    assert_eq!((told.robots, told.body_radius.to_bits()), (7, 0.11_f64.to_bits()));
    let wall = Obstacle {
        shape: Shape::Segment(Vec2::new(0.0, -1.5), Vec2::new(0.0, 1.5)),
        attenuation: Some(8.0),
    };
    let disc = Obstacle {
        shape: Shape::Disc {
            centre: Vec2::new(3.0, -2.0),
            radius: 0.25,
        },
        attenuation: None,
    };
    assert_eq!(told.obstacles, [wall, disc]);
}

/// Says at each step that it is there, and watches whom it hears; never suspects anybody. Walks to and fro, if it does.
struct Watcher {
    velocity: f64,
    watched: BTreeSet<ActorId>,
    steps: u32,
}

impl Protocol for Watcher {
    type Message = u8;
    type Heard = u8;
    type Codec = Serialised<u8>;
    const TOPICS: &'static [&'static str] = &["status"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));

    fn step(&mut self, _: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        output.broadcast(0);
        for reception in &input.inbox {
            let sender = reception.frame.sender;
            if self.watched.insert(sender) {
                output.notes.push(Note::Watches(sender));
            }
        }
        // 6 s there, 6 s back.
        let sign = if (self.steps / 60).is_multiple_of(2) { -1.0 } else { 1.0 };
        output.velocity = Some(Vec2::new(sign * self.velocity, 0.0));
        self.steps += 1;
    }
}

/// How long each is monitored of those that watch each other, from where robots are at each tick and when they began to watch.
struct Monitor {
    reach: Reach,
    patience: Span,
    now: SimTime,
    /// By observer and subject: since when in range, if it is, and since when watched.
    pairs: Vec<(Placed, Placed, Option<SimTime>, SimTime)>,
    monitored_s: f64,
    crossings: u32,
}

impl Monitor {
    fn count(pair: &(Placed, Placed, Option<SimTime>, SimTime), patience: Span, until: SimTime) -> f64 {
        let (_, _, within, watched) = pair;
        let Some(since) = within else { return 0.0 };
        // Who is in range from the start has been for long enough.
        let settled = if *since == SimTime::ZERO {
            SimTime::ZERO
        } else {
            *since + patience
        };
        until.since(settled.max(*watched)).as_secs()
    }

    fn look(&mut self, world: &World) {
        let now = world.now();
        for pair in &mut self.pairs {
            for robot in [&mut pair.0, &mut pair.1] {
                robot.1 = world.position(robot.0, now);
            }
            let within = self.reach.hears(pair.1, pair.0);
            if within != pair.2.is_some() {
                self.crossings += 1;
                self.monitored_s += Self::count(pair, self.patience, now);
                pair.2 = within.then_some(now);
            }
        }
    }
}

impl Observer for Monitor {
    fn begin(&mut self, world: &World) {
        let robots = placed(world.positions());
        for &observer in &robots {
            let others = robots.iter().filter(|other| other.0 != observer.0);
            self.pairs
                .extend(others.map(|subject| (observer, *subject, None, SimTime::NEVER)));
        }
        self.look(world);
        self.crossings = 0;
    }

    fn tick(&mut self, world: &World) {
        self.look(world);
    }

    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, _: &Inbox<'_, H>) {
        if let Note::Watches(subject) = note {
            let mut pairs = self.pairs.iter_mut();
            let pair = pairs.find(|pair| pair.0.0 == robot && pair.1.0 == *subject);
            pair.expect("two robots").3 = now;
        }
    }

    fn end(&mut self, end: SimTime) {
        self.now = end;
        for pair in &self.pairs {
            self.monitored_s += Self::count(pair, self.patience, end);
        }
    }
}

/// Three robots stand beside the upper end of the wall; one walks past it, to where it is hidden from them, and comes back.
#[test]
fn a_pair_is_monitored_while_the_one_hears_the_other_and_not_while_a_wall_parts_them() {
    let mut setup = setup(60.0, 1.0);
    setup.detector = DetectorConfig::Timeout(Positive::new(1.0));
    setup.status_interval = Span::from_secs(0.1);
    let places = [(0.4, 0.8), (0.3, 0.3), (0.9, 0.6), (0.5, 1.2)].map(|(x, y)| Vec2::new(x, y));
    let robots = [0.0, 0.0, 0.0, 0.3].map(|velocity| Watcher {
        velocity,
        watched: BTreeSet::new(),
        steps: 0,
    });
    let monitor = Monitor {
        reach: setup.reach(4),
        patience: Span::from_secs(1.0),
        now: SimTime::ZERO,
        pairs: Vec::new(),
        monitored_s: 0.0,
        crossings: 0,
    };
    let finished = run(&setup, &places, robots.into(), monitor);
    let (monitor, told) = (finished.observer, finished.record.detection.monitored_s);
    assert!(monitor.crossings >= 30, "{} crossings", monitor.crossings);
    let watched = monitor.pairs.iter().filter(|pair| pair.3 < SimTime::NEVER).count();
    assert_eq!(watched, 12, "all have met");
    let all: f64 = monitor
        .pairs
        .iter()
        .map(|pair| monitor.now.since(pair.3).as_secs())
        .sum();
    assert!(monitor.monitored_s < 0.9 * all, "{} of {all} s", monitor.monitored_s);
    assert!(
        (told - monitor.monitored_s).abs() < 1e-6,
        "{told} and {}",
        monitor.monitored_s
    );
}

/// Reports a chain from the last robot to the first.
struct Reporter;

impl Protocol for Reporter {
    type Message = u8;
    type Heard = u8;
    type Codec = Serialised<u8>;
    const TOPICS: &'static [&'static str] = &["none"];
    const ROLES: &'static [&'static str] = &["relay", "worker"];

    fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        let me = input.me.0;
        if now == SimTime::ZERO && me > 0 {
            output.notes.push(Note::Target(Some(0)));
            output.notes.push(Note::Parents(vec![ActorId(me - 1)]));
            if me == 3 {
                output.notes.push(Note::Role(Role(1)));
            }
        }
    }
}

#[test]
fn the_chain_of_a_mission_is_as_long_as_its_links_hold_both_ways() {
    use desim::metrics::{Mission, MissionTarget, Ties};
    let links = |places: [(f64, f64); 4], half: f64| {
        let mut setup = setup(1.0, half);
        setup.control.phase = PhaseConfig::Together;
        setup.mission = Some(Mission {
            targets: vec![MissionTarget {
                position: Vec2::new(1.5, 0.0),
                links: 1,
            }],
            reach: 0.3,
            ties: Ties::Parents { within: 1.7 },
            root: ActorId(0),
            root_role: None,
            worker_role: Role(1),
        });
        let places = places.map(|(x, y)| Vec2::new(x, y));
        let finished = run(&setup, &places, (0..4).map(|_| Reporter).collect(), ());
        finished.record.connectivity.get(1).expect("a second sample").links[0]
    };
    let row = [(-1.3, 0.0), (-0.4, 0.0), (0.5, 0.0), (1.4, 0.0)];
    let beside = row.map(|(x, _)| (x, 2.0));
    assert_eq!(links(beside, 1.0), 1);
    assert_eq!(links(row, 1.0), 0, "the wall parts its middle");
    // Robot 1 hears the root from 1.2 m away and is not heard.
    let far = [(-1.6, 2.0), (-0.4, 2.0), (0.5, 2.0), (1.4, 2.0)];
    assert_eq!(links(far, 1.0), 0);
}

//! Who counts on whom, watched at every control step of runs in which robots fail and frames are lost: no relation
//! between two live robots stays one-sided, and no two robots stay each other's parents, nor any in a circle.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use desim::engine::{ActorId, SimTime, Span};
use desim::kinds::backbone::{self, Backbone, BackboneCodec, BackboneConfig, Message, Request, Role};
use desim::metrics::{FaultKind, TrialRecord};
use desim::motion::deploy;
use desim::protocol::{Input, Note, Output, Protocol, Topic, Wake};
use desim::scenario::{Override, Scenario, load};
use desim::simulation::{DriverKind, Setup};
use proptest::prelude::*;
use tokio_util::sync::CancellationToken;

/// Seconds after which one who is silent is missed, and a join without a sign is undone: the defaults.
const MISSED_S: f64 = 4.0;
const JOIN_TIMEOUT_S: f64 = 4.0;
/// Seconds for which the other end of a break is waited for: the default.
const PATIENCE_S: f64 = 60.0;
/// Slack for what is on the way: a message takes a step, and with one frame in five lost a few of them are tried.
const ON_THE_WAY_S: f64 = 2.0;

/// For how long a parent may be named that does not know of it, seconds: it was given up, freed itself, and is heard to
/// have done so or missed.
const UNKNOWN_CHILD_S: f64 = MISSED_S + JOIN_TIMEOUT_S + ON_THE_WAY_S;
/// For how long a robot may wait for a child that does not name it and does not ask it either, seconds.
const UNASKED_S: f64 = PATIENCE_S + MISSED_S + JOIN_TIMEOUT_S + ON_THE_WAY_S;
/// For how long robots may be their own ancestors, seconds: a strand goes round once and is dropped.
const CIRCLE_S: f64 = 2.0;

/// What one robot says of its relations at one control step.
#[derive(Clone, Debug, Default)]
struct Ties {
    role: u8,
    /// Whom it counts on as parents.
    parents: Vec<ActorId>,
    /// Whom it serves or means to serve, in its parent strand.
    child: Option<ActorId>,
    /// Whom it asks for something.
    asks: Vec<ActorId>,
}

/// All robots' ties, control step by control step.
type Diary = Rc<RefCell<Vec<Vec<Ties>>>>;

/// A robot of the backbone whose answers are written down.
struct Watched {
    robot: Backbone,
    id: usize,
    now: Ties,
    diary: Diary,
}

impl Protocol for Watched {
    type Message = Message;
    type Heard = Rc<Message>;
    type Codec = BackboneCodec;
    const TOPICS: &'static [&'static str] = Backbone::TOPICS;
    const ROLES: &'static [&'static str] = Backbone::ROLES;
    const STATUS: Option<Topic> = Backbone::STATUS;

    fn topic(message: &Message) -> Topic {
        Backbone::topic(message)
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Rc<Message>>, output: &mut Output<Message>) {
        self.robot.step(now, input, output);
        for note in &output.notes {
            match note {
                Note::Role(role) => self.now.role = role.0,
                Note::Parents(parents) => self.now.parents.clone_from(parents),
                _ => {}
            }
        }
        if input.wake != Wake::ControlStep {
            return;
        }
        self.now.child = None;
        self.now.asks.clear();
        for message in &output.broadcasts {
            match message {
                Message::ParentStrand(strand) if strand.chain != 0 => self.now.child = Some(strand.next),
                Message::Request(Request::Join { to, .. } | Request::Adopt { to, .. }) => self.now.asks.push(*to),
                _ => {}
            }
        }
        self.diary.borrow_mut()[self.id].push(self.now.clone());
    }
}

fn scenario(file: &str, overrides: &[String]) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(file);
    let parse = |text: &String| -> Override { text.parse().expect("an override") };
    let overrides: Vec<Override> = overrides.iter().map(parse).collect();
    load(&path, &overrides).expect("a shipped scenario with valid overrides")
}

/// Runs `trial` to its time limit, complete or not: every robot's ties at every step, and the record.
fn watch(scenario: &Scenario, trial: u32) -> (Vec<Vec<Ties>>, TrialRecord) {
    let config: &BackboneConfig = scenario.protocol.as_kind().expect("a backbone");
    let setup = Setup {
        seed: scenario.seed,
        trial,
        time_limit: Span::from_secs(scenario.time_limit.get()),
        arena: scenario.arena.clone(),
        motion: scenario.motion.clone(),
        control: scenario.control.clone(),
        radio: scenario.radio.disk().into_owned(),
        faults: scenario.faults.clone(),
        ..Setup::default()
    };
    let body = scenario.motion.body_radius.get();
    let (swarm, arena) = (&scenario.swarm, &scenario.arena);
    let poses = deploy(&swarm.deploy, arena, swarm.robots, body, &setup.streams()).expect("room for all");
    let diary = Diary::new(RefCell::new(vec![Vec::new(); poses.len()]));
    let robots = backbone::swarm(
        config,
        &scenario.gossip,
        &scenario.detector,
        &scenario.control,
        &poses,
        setup.streams(),
    );
    let watched = robots.into_iter().enumerate().map(|(id, robot)| Watched {
        robot,
        id,
        now: Ties::default(),
        diary: Rc::clone(&diary),
    });
    let record = setup
        .run(poses, watched.collect(), DriverKind::Inline, &CancellationToken::new())
        .expect("the trial reaches its end");
    let steps = diary.take();
    (steps, record)
}

/// How long each kind of fault in the relations lasts, and what was found last.
#[derive(Default)]
struct Watch {
    /// Since which step, for a pair of robots, one names the other and not the other way round.
    since: BTreeMap<(&'static str, u32, u32), usize>,
}

impl Watch {
    /// Fails the test if something that is `amiss` now has been so for longer than its bound.
    fn check(&mut self, step: usize, amiss: Vec<(&'static str, u32, u32, f64)>, context: &str) {
        let mut since = BTreeMap::new();
        for (what, a, b, bound) in amiss {
            let first = self.since.get(&(what, a, b)).copied().unwrap_or(step);
            let lasted = 0.1 * (step - first) as f64;
            assert!(
                lasted <= bound,
                "{context}: {what}, robots {a} and {b}, for {lasted} s at {} s",
                0.1 * step as f64
            );
            since.insert((what, a, b), first);
        }
        self.since = since;
    }
}

/// Checks every control step of a run, and that nothing is amiss at its end if that `is_quiet`.
fn assert_sound(diary: &[Vec<Ties>], record: &TrialRecord, is_quiet: bool, context: &str) {
    let steps = diary.iter().map(Vec::len).min().expect("robots");
    // The record is in order of time: the first failure of a robot counts, for it is for good.
    let mut failed_from: BTreeMap<u32, SimTime> = BTreeMap::new();
    for fault in &record.faults {
        if let FaultKind::Robot { robot, .. } = fault.kind {
            failed_from.entry(robot.0).or_insert(fault.from);
        }
    }
    let mut watch = Watch::default();
    for step in 0..steps {
        let now = SimTime::from_secs(0.1 * step as f64);
        let is_live = |robot: u32| failed_from.get(&robot).is_none_or(|from| *from > now);
        let live: Vec<u32> = (0..diary.len() as u32).filter(|robot| is_live(*robot)).collect();
        let ties = |robot: u32| &diary[robot as usize][step];
        let mut amiss = Vec::new();
        for &robot in &live {
            for parent in &ties(robot).parents {
                let is_root = ties(parent.0).role == Role::Root as u8;
                if !is_root && is_live(parent.0) && ties(parent.0).child != Some(ActorId(robot)) {
                    amiss.push(("a parent does not know its child", robot, parent.0, UNKNOWN_CHILD_S));
                }
            }
            if let Some(child) = ties(robot).child.filter(|child| is_live(child.0)) {
                let is_named = ties(child.0).parents.contains(&ActorId(robot));
                if !is_named && !ties(child.0).asks.contains(&ActorId(robot)) {
                    amiss.push(("a child does not know its parent", robot, child.0, UNASKED_S));
                }
            }
            if is_own_ancestor(robot, &|robot| is_live(robot).then(|| &ties(robot).parents[..])) {
                amiss.push(("its own ancestor", robot, robot, CIRCLE_S));
            }
        }
        if is_quiet && step + 1 == steps {
            assert_eq!(amiss, [], "{context}: at the end of a quiet time");
        }
        watch.check(step, amiss, context);
    }
}

/// Whether `robot` is among its own ancestors, over live robots.
fn is_own_ancestor<'a>(robot: u32, parents: &impl Fn(u32) -> Option<&'a [ActorId]>) -> bool {
    let mut ancestors: Vec<ActorId> = parents(robot).unwrap_or_default().to_vec();
    let mut next = 0;
    while let Some(&ancestor) = ancestors.get(next) {
        if ancestor.0 == robot {
            return true;
        }
        for &parent in parents(ancestor.0).unwrap_or_default() {
            if !ancestors.contains(&parent) {
                ancestors.push(parent);
            }
        }
        next += 1;
    }
    false
}

const LOSSY: &str = "radio=(loss: Bernoulli(0.2), latency: LogNormal(median: 0.02, sigma: 0.5))";

/// Failures until so late, then quiet until the end, seconds.
const TROUBLED_S: u32 = 160;
const QUIET_S: u32 = 80;

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_robot_is_left_half_joined_nor_in_a_circle_whoever_fails_under_loss(
        seed in 0_u64..10_000,
        failures in prop::collection::vec((1_u32..24, 5_u32..TROUBLED_S), 0..9),
    ) {
        let faults: Vec<String> = failures
            .iter()
            .map(|(robot, at)| format!("Silence(robots: [{robot}], at: {at}.0)"))
            .collect();
        let overrides = [
            "swarm=(robots: 24, deploy: Cluster(radius: 0.82))".into(),
            "protocol=Backbone(targets: Ring(count: 2, radius: 4.5, links: 2))".into(),
            LOSSY.into(),
            format!("seed={seed}"),
            format!("faults=[{}]", faults.join(", ")),
            format!("time_limit={}.0", TROUBLED_S + QUIET_S),
        ];
        let (diary, record) = watch(&scenario("paper/completion_40x2.ron", &overrides), 0);
        assert_sound(&diary, &record, true, &format!("seed {seed}, failures {failures:?}"));
    }
}

#[test]
fn in_the_papers_missions_with_failures_relations_are_sound_at_every_step() {
    for trial in 0..2 {
        let overrides = ["faults=[Fallible(share: 0.7, hazard: 0.0003)]".into()];
        let scenario = scenario("paper/faults_40x2_p70.ron", &overrides);
        let (diary, record) = watch(&scenario, trial);
        assert_sound(&diary, &record, false, &format!("trial {trial}"));
    }
}

//! Radios over which frames take time: what a run makes of a medium with events of its own.
//!
//! The radios here are of a program of its own, as those of users are: they see no more of desim than anybody does.

mod aloha;
mod closed_forms;
mod faults;
mod late;
mod seam;

use std::sync::Arc;

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::{Pose, Vec2};
use desim::protocol::control::PhaseConfig;
use desim::protocol::{Input, Output, Protocol, Serialised, TimerId, Topic, Wake};
use desim::quantity::NonNegative;
use desim::radio::RadioKind;
use desim::simulation::{DriverKind, Finished, Setup};
use rand::RngExt as _;
use tokio_util::sync::CancellationToken;

/// The bytes of headers of a frame with one message.
const HEADERS: u32 = 5;

/// A run of so many seconds over `radio`, in which all robots take their control steps together, every 0.1 s.
fn setup(seconds: f64, radio: impl RadioKind + 'static) -> Setup {
    let mut setup = Setup::lasting(Span::from_secs(seconds));
    setup.control.phase = PhaseConfig::Together;
    setup.metrics.sample_interval = NonNegative::new(0.0);
    setup.own_radio = Some(Arc::new(radio));
    setup
}

/// Robots on a line, so many metres apart.
fn line(robots: u32, apart: f64) -> Vec<Pose> {
    let pose = |robot| Pose {
        position: Vec2::new(apart * f64::from(robot), 0.0),
        heading: 0.0,
    };
    (0..robots).map(pose).collect()
}

fn run<P: Protocol>(setup: &Setup, poses: Vec<Pose>, robots: Vec<P>, driver: DriverKind) -> Finished<P, ()> {
    let finished = setup.observe(poses, robots, driver, &CancellationToken::new(), ());
    finished.expect("the run reaches its end")
}

/// What a robot heard: when, from whom, which of its messages, and where that one was.
type Heard = (SimTime, u32, u8, [f32; 2]);

/// At each control step in which it has something to say it says it, to all. Writes down what it hears.
#[derive(Clone, Debug, Default, PartialEq)]
struct Scripted {
    /// The numbers of control steps, from 0, at which it says something, that number being what it says.
    at: Vec<u8>,
    steps: u8,
    velocity: Vec2,
    heard: Vec<Heard>,
}

impl Scripted {
    fn new(at: &[u8]) -> Self {
        Self {
            at: at.to_vec(),
            ..Self::default()
        }
    }

    /// From whom it heard what, in order.
    fn words(&self) -> Vec<(u32, u8)> {
        self.heard.iter().map(|heard| (heard.1, heard.2)).collect()
    }
}

impl Protocol for Scripted {
    type Message = u8;
    type Heard = u8;
    type Codec = Serialised<u8>;
    const TOPICS: &'static [&'static str] = &["word"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, _: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        for reception in &input.inbox {
            let frame = &reception.frame;
            self.heard
                .push((reception.at, frame.sender.0, frame.message, reception.displacement));
        }
        if input.wake == Wake::ControlStep {
            if self.at.contains(&self.steps) {
                output.broadcast(self.steps);
            }
            output.velocity = Some(self.velocity);
            self.steps += 1;
        }
    }
}

/// Says all kinds of things at all times: to all and to one, alone and several at once, at control steps and between them; moves about; and writes
/// down what it hears.
#[derive(Clone, Debug, Default, PartialEq)]
struct Chatter<const OVERHEARS: bool> {
    said: u8,
    robots: u32,
    heard: Vec<(Heard, bool)>,
}

impl<const OVERHEARS: bool> Protocol for Chatter<OVERHEARS> {
    type Message = (u8, u8);
    type Heard = (u8, u8);
    type Codec = Serialised<(u8, u8)>;
    const TOPICS: &'static [&'static str] = &["all", "one", "late"];
    const ROLES: &'static [&'static str] = &["robot"];
    const OVERHEARS: bool = OVERHEARS;

    fn topic(message: &(u8, u8)) -> Topic {
        Topic(message.0)
    }

    fn start(&mut self, start: desim::protocol::Start) {
        self.robots = start.robots as u32;
    }

    fn step(&mut self, now: SimTime, input: &mut Input<(u8, u8)>, output: &mut Output<(u8, u8)>) {
        for reception in &input.inbox {
            let frame = &reception.frame;
            let heard = (reception.at, frame.sender.0, frame.message.1, reception.displacement);
            self.heard.push((heard, frame.rides));
        }
        self.said = self.said.wrapping_add(1);
        let other = ActorId((input.me.0 + input.random.random_range(1..self.robots)) % self.robots);
        match input.wake {
            Wake::ControlStep => {
                output.broadcast((0, self.said));
                if input.random.random_bool(0.5) {
                    output.send(other, (1, self.said));
                }
                if input.random.random_bool(0.3) {
                    output.send(other, (1, self.said));
                    output.broadcast((0, self.said));
                }
                let later = Span::from_secs(input.random.random_range(0.0..0.09));
                output.set_timer(TimerId(0), now + later);
                let speed = input.random.random_range(-0.2..0.2);
                output.velocity = Some(Vec2::new(speed, 0.1 - speed.abs()));
            }
            Wake::Timer(_) => output.send(other, (2, self.said)),
            Wake::Reception | Wake::Sent => {}
        }
    }
}

fn chatters<const OVERHEARS: bool>(robots: u32) -> Vec<Chatter<OVERHEARS>> {
    (0..robots).map(|_| Chatter::default()).collect()
}

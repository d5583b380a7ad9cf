//! Questions flooded through a swarm, and answers that come back the way they went, with every command of desim:
//! `cargo run --release --example flood -- scenario examples/flood/flood.ron`.

use std::collections::BTreeMap;
use std::process::ExitCode;

use desim::engine::{ActorId, SimTime};
use desim::kind::{Kind, Swarm};
use desim::metrics::NotedFigure;
use desim::protocol::{Input, Output, Protocol, Reception, Serialised, Topic, Wake};
use desim::quantity::Probability;
use rand::RngExt as _;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots ask each other questions, which are flooded; the one who is asked answers the one who asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Flood {
    /// Hops that a question goes at most.
    ttl: u8,
    /// Probability that a robot asks a question in a control step.
    ask_probability: Probability,
}

/// Who asked, and which of its questions it is.
type Question = (ActorId, u32);

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
enum Message {
    /// A question, whom it is for, and how many hops it has left.
    Ask(Question, ActorId, u8),
    Answer(Question),
}

#[derive(Default)]
struct Robot {
    ttl: u8,
    ask_probability: f64,
    me: ActorId,
    robots: u32,
    /// When each question was asked, until it is answered.
    asked: Vec<Option<SimTime>>,
    /// From whom each question came first: its answer goes back there.
    ways: BTreeMap<Question, ActorId>,
}

impl Robot {
    fn hear(&mut self, reception: &Reception<Message>, output: &mut Output<Message>) {
        let from = reception.frame.sender;
        match reception.frame.message {
            Message::Ask(question, ..) if question.0 == self.me || self.ways.contains_key(&question) => {
                output.notes.push(reception.duplicate(Topic(0)));
            }
            Message::Ask(question, whom, ttl) => {
                self.ways.insert(question, from);
                if whom == self.me {
                    output.send(from, Message::Answer(question));
                } else if ttl > 1 {
                    output.broadcast(Message::Ask(question, whom, ttl - 1));
                }
            }
            Message::Answer(question) if question.0 != self.me => {
                output.send(self.ways[&question], Message::Answer(question));
            }
            Message::Answer(question) => {
                if let Some(asked) = self.asked[question.1 as usize].take() {
                    output.count("answered", 1);
                    output.measure("delay", reception.at.since(asked).as_secs());
                }
            }
        }
    }
}

impl Protocol for Robot {
    type Message = Message;
    type Heard = Message;
    type Codec = Serialised<Message>;
    const TOPICS: &'static [&'static str] = &["ask", "answer"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(message: &Message) -> Topic {
        Topic(u8::from(matches!(message, Message::Answer(_))))
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Message>, output: &mut Output<Message>) {
        input.inbox.iter().for_each(|reception| self.hear(reception, output));
        if input.wake == Wake::ControlStep && input.random.random_bool(self.ask_probability) {
            let whom = (self.me.0 + input.random.random_range(1..self.robots.max(2))) % self.robots;
            let question = (self.me, self.asked.len() as u32);
            self.asked.push(Some(now));
            output.count("asked", 1);
            output.broadcast(Message::Ask(question, ActorId(whom), self.ttl));
        }
    }
}

impl Kind for Flood {
    const NAME: &'static str = "Flood";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        let (ttl, ask_probability) = (self.ttl, self.ask_probability.get());
        let robots = swarm.poses.len() as u32;
        swarm.each(|me| Robot {
            ttl,
            ask_probability,
            me,
            robots,
            ..Robot::default()
        })
    }

    fn figures(&self) -> Vec<NotedFigure> {
        let success = NotedFigure::share("success", "questions answered", "answered", "asked");
        vec![
            success.higher(),
            NotedFigure::mean("delay_s", "delay of an answer", "s", "delay"),
        ]
    }
}

fn main() -> ExitCode {
    desim::kinds::add::<Flood>();
    desim::cli::main()
}

use desim::engine::{SimTime, Span};
use desim::protocol::{Input, Output, Protocol, Serialised, TimerId, Topic, Wake};
use serde::{Deserialize, Serialize};

/// What robots say to each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Message {
    /// Who is near?
    Call,
    /// I am.
    Answer,
}

/// A robot that calls at regular times, and answers the calls of others.
pub struct Robot {
    interval: Span,
    has_begun: bool,
    /// How many have answered its last call.
    pub answers: u32,
}

/// Its one timer: the next call.
pub const CALL: TimerId = TimerId(0);

impl Robot {
    /// One that calls so often.
    pub fn calling_every(interval: Span) -> Self {
        Self {
            interval,
            has_begun: false,
            answers: 0,
        }
    }
}

impl Protocol for Robot {
    type Message = Message;
    type Heard = Message;
    type Codec = Serialised<Message>;
    const TOPICS: &'static [&'static str] = &["call", "answer"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn topic(message: &Message) -> Topic {
        match message {
            Message::Call => Topic(0),
            Message::Answer => Topic(1),
        }
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Message>, output: &mut Output<Message>) {
        for reception in &input.inbox {
            match reception.frame.message {
                Message::Call => output.send(reception.frame.sender, Message::Answer),
                Message::Answer => self.answers += 1,
            }
        }
        let is_time = input.wake == Wake::Timer(CALL);
        if is_time {
            output.measure("answers", f64::from(self.answers));
        }
        if is_time || !self.has_begun {
            (self.has_begun, self.answers) = (true, 0);
            output.broadcast(Message::Call);
            output.set_timer(CALL, now + self.interval);
        }
    }
}

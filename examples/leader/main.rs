//! A leader by failure detectors: `cargo run --release --example leader -- scenario examples/leader/leader.ron`.

use std::{collections::BTreeSet, process::ExitCode, rc::Rc};

use desim::engine::{ActorId, SimTime, Span};
use desim::kind::{Kind, Sections, Shared, Swarm};
use desim::metrics::NotedFigure;
use desim::protocol::detector::{Detector, Monitored, Probe, Sign};
use desim::protocol::{Input, Output, Protocol, Serialised, Topic, Wake, gossip::OwnTurns};
use desim::quantity::NonNegative;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots that follow the robot of the lowest number among themselves and those that they have heard and do not suspect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Leader {
    /// Seconds for which a robot stands by its leader though it would choose another one by now.
    patience: NonNegative,
}

#[derive(Debug, Serialize, Deserialize)]
enum Message {
    /// I am alive, and follow this robot.
    Status(ActorId),
    Probe(Probe),
}

impl Monitored for Message {
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status(_) => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe),
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(probe)
    }
}

struct Robot {
    patience: Span,
    detector: Detector,
    turns: OwnTurns,
    known: BTreeSet<ActorId>,
    leader: ActorId,
    /// When it would last have chosen the same leader again.
    content: SimTime,
}

impl Protocol for Robot {
    type Message = Message;
    type Heard = Rc<Message>;
    type Codec = Serialised<Message>;
    const TOPICS: &'static [&'static str] = &["status", "probe"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const PROBE: Option<Topic> = Some(Topic(1));

    fn topic(message: &Message) -> Topic {
        Topic(u8::from(matches!(message, Message::Probe(_))))
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Rc<Message>>, output: &mut Output<Message>) {
        self.detector.step(now, input, output);
        for reception in &input.inbox {
            if let Message::Status(leader) = *reception.frame.message {
                self.known.insert(reception.frame.sender);
                output.count("heard", 1);
                output.count("agreed", u64::from(leader == self.leader));
            }
        }
        let trusted = self.known.iter().find(|robot| !self.detector.suspects(**robot));
        let lowest = *trusted.unwrap_or(&input.me);
        if lowest == self.leader || now.since(self.content) >= self.patience {
            output.count("changes", u64::from(lowest != self.leader));
            (self.leader, self.content) = (lowest, now);
        }
        if input.wake == Wake::ControlStep && self.turns.is_due() {
            output.broadcast(Message::Status(self.leader));
        }
    }
}

impl Kind for Leader {
    const NAME: &'static str = "Leader";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        swarm.each(|id| Robot {
            patience: Span::from_secs(self.patience.get()),
            detector: swarm.detector(id),
            turns: swarm.status_turns(id),
            known: BTreeSet::from([id]),
            leader: id,
            content: SimTime::ZERO,
        })
    }

    fn heeds(&self, _: &Sections<'_>) -> &'static [Shared] {
        &[Shared::Status, Shared::Detector]
    }

    fn moves(&self, _: &Sections<'_>) -> bool {
        false
    }

    fn figures(&self) -> Vec<NotedFigure> {
        let agreement = NotedFigure::share("agreement", "statuses that name one's own leader", "agreed", "heard");
        let changes = NotedFigure::per_robot("changes", "changes of leader of a robot", "changes");
        vec![agreement.higher(), changes]
    }
}

fn main() -> ExitCode {
    desim::kinds::add::<Leader>();
    desim::cli::main()
}

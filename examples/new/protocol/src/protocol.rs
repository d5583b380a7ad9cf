//! Robots say hello, and know whom they have heard of late.

use std::collections::BTreeMap;

use desim::engine::{ActorId, SimTime, Span};
use desim::kind::{Kind, Swarm};
use desim::metrics::NotedFigure;
use desim::protocol::{Input, Output, Protocol, Serialised, Wake};
use desim::quantity::Positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a scenario says of the protocol: `protocol: MyProtocol(hello_interval: 2.0)`. The comments are what `desim schema` and
/// messages about faults show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MyProtocol {
    /// Seconds between two hellos of a robot, rounded up to control steps.
    pub hello_interval: Positive,
    /// Seconds after which a robot that was not heard again is no neighbour any more.
    pub forget_after: Positive,
}

impl Default for MyProtocol {
    fn default() -> Self {
        Self {
            hello_interval: Positive::new(1.0),
            forget_after: Positive::new(5.0),
        }
    }
}

/// What robots say. `Serialised` makes the bytes that are accounted; a codec of your own may make fewer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// How many neighbours the sender has.
    pub neighbours: u32,
}

/// One robot.
pub struct Robot {
    settings: MyProtocol,
    next_hello: SimTime,
    /// When each neighbour was last heard.
    pub neighbours: BTreeMap<ActorId, SimTime>,
}

impl Robot {
    pub fn new(settings: MyProtocol) -> Self {
        Self {
            settings,
            next_hello: SimTime::ZERO,
            neighbours: BTreeMap::new(),
        }
    }
}

impl Protocol for Robot {
    type Message = Hello;
    type Heard = Hello;
    type Codec = Serialised<Hello>;
    const TOPICS: &'static [&'static str] = &["hello"];
    const ROLES: &'static [&'static str] = &["robot"];

    // A robot never looks at a clock or at another robot: it is handed the time and what it has heard since it last woke.
    fn step(&mut self, now: SimTime, input: &mut Input<Hello>, output: &mut Output<Hello>) {
        for reception in &input.inbox {
            self.neighbours.insert(reception.frame.sender, reception.at);
        }
        if input.wake != Wake::ControlStep || now < self.next_hello {
            return;
        }
        let patience = Span::from_secs(self.settings.forget_after.get());
        self.neighbours.retain(|_, heard| now.since(*heard) <= patience);
        let neighbours = self.neighbours.len() as u32;
        output.broadcast(Hello { neighbours });
        // Values and counts that a robot notes are read by the figures below.
        output.measure("neighbours", f64::from(neighbours));
        self.next_hello = now + Span::from_secs(self.settings.hello_interval.get());
    }
}

impl Kind for MyProtocol {
    const NAME: &'static str = "MyProtocol";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        swarm.each(|_| Robot::new(self.clone()))
    }

    fn figures(&self) -> Vec<NotedFigure> {
        vec![NotedFigure::mean("neighbours", "neighbours known", "robots", "neighbours").higher()]
    }
}

#[cfg(test)]
mod tests {
    use desim::testing::{Fate, Solo, Swarm};

    use super::*;

    fn robot() -> Robot {
        Robot::new(MyProtocol::default())
    }

    #[test]
    fn a_robot_says_how_many_it_has_heard_and_forgets_who_is_silent() {
        let mut robot = Solo::new(ActorId(0), 3, robot());
        assert_eq!(robot.advance(0.5)[0].words(), [Hello { neighbours: 0 }]);
        robot.hears(ActorId(1), Hello { neighbours: 0 });
        robot.hears(ActorId(2), Hello { neighbours: 0 });
        assert!(robot.advance(0.5)[0].said.is_empty()); // not yet again
        assert_eq!(robot.advance(10.0)[0].words(), [Hello { neighbours: 2 }]);
        assert_eq!(robot.control_step().words(), [Hello { neighbours: 0 }]);
    }

    #[test]
    fn in_a_row_robots_know_their_neighbours_alone() {
        let mut swarm = Swarm::new((0..4).map(|_| robot()).collect());
        swarm.radio(|_, from, to, _| if from.0.abs_diff(to.0) == 1 { Fate::Arrives(0.01) } else { Fate::Lost });
        swarm.run_for(3.0);
        let known: Vec<usize> = swarm.robots().iter().map(|robot| robot.neighbours.len()).collect();
        assert_eq!(known, [1, 2, 2, 1]);
    }
}

//! Robots that keep together by virtual forces between them: `cargo run --release --example flock -- scenario examples/flock/flock.ron`.

use std::process::ExitCode;

use desim::engine::{SimTime, Span};
use desim::geometry::Vec2;
use desim::kind::{Kind, Swarm};
use desim::metrics::NotedFigure;
use desim::protocol::{Input, Output, Protocol, Serialised, TimerId, Wake};
use desim::quantity::Positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots that head where the others head, neither too near to each other nor too far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Flock {
    /// Distance at which two robots neither attract nor repel each other, metres.
    spacing: Positive,
    /// Seconds between two beacons of a robot.
    beacon_interval: Positive,
}

/// What a robot says: how fast it moves, in m/s.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Beacon([f32; 2]);

/// Its settings, and the velocity that it wants once it has begun.
struct Robot(Flock, Option<Vec2>);

const BEACON: TimerId = TimerId(0);

impl Protocol for Robot {
    type Message = Beacon;
    type Heard = Beacon;
    type Codec = Serialised<Beacon>;
    const TOPICS: &'static [&'static str] = &["beacon"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, now: SimTime, input: &mut Input<Beacon>, output: &mut Output<Beacon>) {
        let Self(flock, wanted) = self;
        let begins = wanted.is_none();
        let velocity = wanted.get_or_insert_default();
        for reception in &input.inbox {
            let (there, [x, y]) = (reception.displacement(), reception.frame.message.0.map(f64::from));
            let stretch = 1.0 - flock.spacing.get() / there.norm().max(1e-3);
            *velocity += 0.05 * stretch * there + 0.1 * (Vec2::new(x, y) - *velocity);
            output.measure("distance", there.norm());
        }
        output.velocity = Some(*velocity);
        if input.wake == Wake::Timer(BEACON) || begins {
            output.broadcast(Beacon([velocity.x as f32, velocity.y as f32]));
            output.set_timer(BEACON, now + Span::from_secs(flock.beacon_interval.get()));
        }
    }
}

impl Kind for Flock {
    const NAME: &'static str = "Flock";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        swarm.each(|_| Robot(self.clone(), None))
    }

    fn figures(&self) -> Vec<NotedFigure> {
        vec![NotedFigure::mean(
            "distance_m",
            "distance of a robot that is heard",
            "m",
            "distance",
        )]
    }
}

fn main() -> ExitCode {
    desim::kinds::add::<Flock>();
    desim::cli::main()
}

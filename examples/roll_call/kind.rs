use crate::robot::Robot;
use desim::engine::Span;
use desim::kind::{Kind, Sections, Swarm};
use desim::metrics::NotedFigure;
use desim::quantity::Positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots that call each other, and answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RollCall {
    /// Seconds from one call of a robot to its next.
    pub interval: Positive,
}

impl Kind for RollCall {
    const NAME: &'static str = "RollCall";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        swarm.each(|_| Robot::calling_every(Span::from_secs(self.interval.get())))
    }

    fn moves(&self, _: &Sections<'_>) -> bool {
        false
    }

    fn figures(&self) -> Vec<NotedFigure> {
        vec![NotedFigure::mean("answers", "answers to a call", "robots", "answers").higher()]
    }
}

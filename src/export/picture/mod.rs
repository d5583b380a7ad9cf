//! Pictures of a trial as SVG: where its robots ended, and how they got there.

mod canvas;
mod final_state;
mod labels;
mod pareto;
mod shapes;
mod style;
mod trajectories;

pub use pareto::draw as pareto;

use super::files::PICTURES;
use super::scene::Scene;
use crate::geometry::Vec2;
use crate::metrics::{Outcome, TrialRecord};
use crate::motion::ObstacleConfig;
use crate::radio::Reach;

impl Scene {
    /// The pictures of a trial in which robots were in range of each other as `reach` says, with their kinds. Where its robots ended: by role, with
    /// the links within range (as in the paper's figure 2) and the chains to each target. And their paths, by their roles at the end. None of a swarm
    /// that is too large to be [drawn](TrialRecord::can_be_drawn).
    #[must_use]
    pub fn draw(&self, record: &TrialRecord, reach: &Reach) -> Vec<(&'static str, String)> {
        if !record.can_be_drawn() {
            return Vec::new();
        }
        let [last, paths] = PICTURES;
        vec![
            (last, format!("{}\n", final_state::draw(self, record, reach))),
            (paths, format!("{}\n", trajectories::draw(self, record))),
        ]
    }
}

/// One line on which trial this is and how it ended.
fn subtitle(record: &TrialRecord) -> String {
    let (trial, period) = (record.trial, record.control_period.as_secs());
    match record.outcome {
        Outcome::Completed { step } => {
            format!("trial {trial}: completed at step {step}, {:.1} s", step as f64 * period)
        }
        Outcome::Censored => format!("trial {trial}: not completed in {:.1} s", record.simulated.as_secs()),
        Outcome::NoMission => format!("trial {trial}: after {:.1} s", record.simulated.as_secs()),
    }
}

/// Draws the obstacles.
fn obstacles(canvas: &mut canvas::Canvas, obstacles: &[ObstacleConfig]) {
    for obstacle in obstacles {
        match obstacle {
            ObstacleConfig::Disc { at, radius, .. } => {
                canvas.disc(Vec2::new(at.0.get(), at.1.get()), radius.get(), style::OBSTACLE);
            }
            ObstacleConfig::Wall { from, to, .. } => canvas.line(
                Vec2::new(from.0.get(), from.1.get()),
                Vec2::new(to.0.get(), to.1.get()),
                style::Stroke {
                    colour: style::OBSTACLE,
                    width: 3.0,
                    opacity: 1.0,
                },
            ),
        }
    }
}

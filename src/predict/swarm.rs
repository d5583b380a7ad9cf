//! How many robots hear one, and what the protocol itself expects.

use super::scene::Scene;
use super::{Holds, Prediction, Preflight};
use crate::motion::DeployConfig;

const NEIGHBOURS: &str = "neighbours";

pub fn predict(scene: &Scene<'_>, preflight: &mut Preflight) {
    match &scene.spacing {
        Ok(spacing) => {
            let range = scene.scenario.radio.disk().range.get();
            let value = spacing.neighbours(range);
            let (formula, assumes) = law(&scene.scenario.swarm.deploy);
            preflight.predictions.push(Prediction {
                name: "degree",
                what: NEIGHBOURS,
                value,
                unit: "robots",
                accuracy: spacing.accuracy(range),
                holds: if scene.stands_still() {
                    Holds::Throughout
                } else {
                    Holds::AtStart
                },
                formula,
                assumes: assumes.into(),
            });
        }
        Err(why) => preflight.refuse("degree", NEIGHBOURS, *why),
    }
    preflight.predictions.append(&mut scene.expected.predictions.clone());
}

fn law(deploy: &DeployConfig) -> (&'static str, &'static str) {
    match deploy {
        DeployConfig::Uniform => (
            "(N−1) P(edge), in a square of side L πx² − (8/3)x³ + x⁴/2, x = C/L",
            "centres are a body from the walls and two from each other; how bodies crowd otherwise is left out",
        ),
        DeployConfig::Cluster { .. } => (
            "[(N−1)(N−2) P(disc) + 2(N−1) (C/ρ)²]/N, by disc line picking",
            "robot 0 at the centre, centres two bodies from each other; how bodies crowd otherwise is left out",
        ),
        DeployConfig::At(_) => ("2 · pairs within C / N", "counted on the places given"),
    }
}

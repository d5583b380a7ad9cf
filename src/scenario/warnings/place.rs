//! Swarms whose robots stand too near, too far or too much apart.

use crate::kind::{InPieces, Problem};
use crate::motion::DeployConfig;
use crate::radio::LossConfig;
use crate::scenario::Scenario;

/// By how many times a range may exceed the arena's diagonal before that is said.
const FAR: f64 = 3.0;

/// What looks wrong with where robots are and how far they hear.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let mut found: Vec<Problem> = range(scenario).into_iter().collect();
    found.extend(alone(scenario));
    found.extend(cluster(scenario));
    if found.is_empty() {
        // Pieces say nothing new where nobody can hear anybody.
        found.extend(deployment(scenario));
    }
    found
}

/// The field that says how far robots reach.
fn reach(scenario: &Scenario) -> &'static str {
    match scenario.radio.shared() {
        None => "radio.range",
        Some(_) => "radio.transmit_power",
    }
}

/// What makes them reach farther.
fn farther(scenario: &Scenario) -> &'static str {
    match scenario.radio.shared() {
        None => "`radio.range` greater",
        Some(_) => "`radio.transmit_power` or `radio.path_loss` such that robots reach farther",
    }
}

/// Ranges below what bodies keep apart, and far beyond the arena.
fn range(scenario: &Scenario) -> Option<Problem> {
    let range = scenario.radio.disk().range.get();
    let bodies = 2.0 * scenario.motion.body_radius.get();
    if range < bodies {
        let message =
            format!("nobody ever hears anybody: bodies keep centres {bodies} m apart, and a radio reaches {range} m");
        let help = format!("make {}, or `motion.body_radius` less", farther(scenario));
        return Some(Problem::new(reach(scenario), message, help).with(&["motion.body_radius"]));
    }
    let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
    let diagonal = width.hypot(height);
    // Loss by distance is stated against the range, which may then lie where nobody is.
    let by_distance = matches!(scenario.radio.disk().loss, LossConfig::Distance { .. });
    // That technologies reach far is no slip.
    let is_set = scenario.radio.shared().is_none();
    (is_set && range > FAR * diagonal && !by_distance).then(|| {
        let message = format!(
            "a range of {range} m is far beyond the arena, whose diagonal is {diagonal:.1} m: everybody hears everybody"
        );
        let help = "make `radio.range` less, or `arena.size` greater";
        Problem::new("radio.range", message, help).with(&["arena.size"])
    })
}

fn alone(scenario: &Scenario) -> Option<Problem> {
    (scenario.swarm.robots == 1).then(|| {
        let message = "one robot alone hears nobody, and nobody hears it";
        Problem::new("swarm.robots", message, "make it at least 2")
    })
}

/// Clusters that the walls cut off.
fn cluster(scenario: &Scenario) -> Option<Problem> {
    let DeployConfig::Cluster { radius } = scenario.swarm.deploy else {
        return None;
    };
    let radius = radius.get();
    let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
    let room = width.min(height) / 2.0 - scenario.motion.body_radius.get();
    (radius > room).then(|| {
        let message = format!("a cluster of radius {radius} m reaches beyond the walls, which leave {room} m: it is cut off there, and denser");
        let help = "make its radius less, or `arena.size` greater";
        Problem::new("swarm.deploy.Cluster.radius", message, help).with(&["arena.size", "motion.body_radius"])
    })
}

/// Deployments that leave no room now and then, or that fall into pieces.
fn deployment(scenario: &Scenario) -> Vec<Problem> {
    let by_chance = !matches!(scenario.swarm.deploy, DeployConfig::At(_));
    let Some(InPieces { bearable, what }) = scenario.protocol.in_pieces(&scenario.sections()) else {
        return Vec::new();
    };
    let Some(survey) = scenario.site().survey(scenario.radio.disk().range.get()) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let (trials, range) = (survey.trials, scenario.radio.disk().range.get());
    if survey.without_room > 0 {
        let message = format!(
            "robots find no room in trial {}, were there so many: random places fill up",
            trials - 1
        );
        let help = "use fewer robots, or more room for them";
        found.push(Problem::new("swarm.deploy", message, help).with(&["swarm.robots", "motion.body_radius"]));
    }
    if f64::from(survey.in_pieces) > bearable * f64::from(trials) {
        let when = if by_chance {
            format!("in {} of the first {trials} trials", survey.in_pieces)
        } else {
            "from the start".to_owned()
        };
        let message = format!("the swarm stands in pieces {when}, out of each other's range of {range} m: {what}");
        let help = format!(
            "make {}, or deploy more robots or nearer to each other",
            farther(scenario)
        );
        let also = [reach(scenario), "swarm.robots", "arena.size"];
        found.push(Problem::new("swarm.deploy", message, help).with(&also));
    }
    found
}

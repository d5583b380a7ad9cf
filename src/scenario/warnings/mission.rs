//! Missions that cannot be accomplished, or only by chance.

use crate::geometry::Vec2;
use crate::kinds::backbone::{BackboneConfig, TargetsConfig};
use crate::motion::{DeployConfig, Reach, reach};
use crate::protocol::CompletionConfig;
use crate::scenario::checks::Problem;
use crate::scenario::{ProtocolConfig, Scenario};

/// What looks wrong with the mission, where there is one.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let ProtocolConfig::Backbone(backbone) = &scenario.protocol else {
        return Vec::new();
    };
    let mut found = places(scenario, backbone);
    found.extend(robots(scenario, backbone));
    found.extend(time(scenario, backbone));
    found
}

/// Targets that no robot can hold.
fn places(scenario: &Scenario, backbone: &BackboneConfig) -> Vec<Problem> {
    let targets = backbone.targets();
    let half = Vec2::new(scenario.arena.size.0.get(), scenario.arena.size.1.get()) / 2.0;
    let near = backbone.movement_threshold.get();
    let body_radius = scenario.motion.body_radius.get();
    let places: Vec<Vec2> = targets.iter().map(|(place, _)| *place).collect();
    let reached = reach(&scenario.arena, body_radius, Vec2::zeros(), &places, near);
    let mut found = Vec::new();
    for (index, (place, reached)) in places.iter().zip(reached).enumerate() {
        let outside = place.x.abs() > half.x || place.y.abs() > half.y;
        let twin = places[..index].iter().position(|other| other == place);
        let why = match (reached, outside, twin) {
            (Reach::NoRoom, true, _) => {
                format!("lies outside the arena, further than the {near} m from which it is held")
            }
            (_, true, _) => "lies outside the arena".to_owned(),
            (Reach::NoRoom, ..) => format!("has no room for a robot within the {near} m from which it is held"),
            (Reach::WalledIn, ..) => "is walled in: no way leads there from the root".to_owned(),
            (Reach::Open, _, Some(twin)) => format!("is at the same place as target {twin}"),
            (Reach::Open, false, None) => continue,
        };
        let (x, y) = (micrometres(place.x), micrometres(place.y));
        let message = format!("target {index}, at ({x}, {y}), {why}");
        let (path, help) = backbone.target_field(index);
        let also = ["arena.size", "arena.obstacles", "motion.body_radius"];
        found.push(Problem::new(&format!("protocol.{path}"), message, help).with(&also));
    }
    if let (TargetsConfig::Ring { .. }, [first, others @ ..]) = (&backbone.targets, &mut found[..])
        && !others.is_empty()
    {
        // They have one radius, and so one remedy.
        first.message = format!("{}, and so it is with {} more", first.message, others.len());
        found.truncate(1);
    }
    found
}

/// Metres rounded to whole micrometres, as a reader would write them.
fn micrometres(metres: f64) -> f64 {
    (metres * 1e6).round() / 1e6
}

/// Swarms too small for their mission, where all of it is to hold at once.
fn robots(scenario: &Scenario, backbone: &BackboneConfig) -> Option<Problem> {
    let (needed, there) = (backbone.robots_needed(), scenario.swarm.robots);
    let at_once = scenario.completion() != CompletionConfig::EachVisited;
    (at_once && needed > there as usize).then(|| {
        let message = format!(
            "the mission takes {needed} robots at least, for a root, a worker a target and their chains, and there are {there}"
        );
        let help = "make `swarm.robots` more, ask for fewer targets or links or for nearer ones, or for `completion: EachVisited`";
        Problem::new("swarm.robots", message, help).with(&["protocol.targets"])
    })
}

/// Missions that end before robots can be where they have to be.
fn time(scenario: &Scenario, backbone: &BackboneConfig) -> Option<Problem> {
    let start = |target: Vec2| match &scenario.swarm.deploy {
        DeployConfig::Cluster { radius } => target.norm() - radius.get(),
        DeployConfig::Uniform => 0.0,
        DeployConfig::At(places) => {
            let away = places
                .iter()
                .map(|(x, y)| (target - Vec2::new(x.get(), y.get())).norm());
            away.fold(f64::INFINITY, f64::min)
        }
    };
    let near = backbone.movement_threshold.get();
    let ways = backbone.targets().into_iter().map(|(target, _)| start(target) - near);
    let way = ways.fold(0.0, f64::max);
    let (speed, hold) = (scenario.motion.max_speed.get(), scenario.completion().hold());
    let least = way / speed + hold;
    let time_limit = scenario.time_limit.get();
    (least > time_limit).then(|| {
        let message = format!(
            "no trial can complete: the farthest target is {way:.2} m from where robots start, at {speed} m/s and held for {hold} s that takes {least:.0} s, and a trial ends at {time_limit} s"
        );
        let help = "make `time_limit` longer, `motion.max_speed` greater or the targets nearer";
        let also = ["motion.max_speed", "protocol", "metrics.hold", "swarm.deploy"];
        Problem::new("time_limit", message, help).with(&also)
    })
}

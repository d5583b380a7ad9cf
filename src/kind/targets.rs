//! What may be wrong with the targets of a mission, in the world that a scenario describes: for the warnings of kinds that have some.

use super::{Problem, Sections};
use crate::geometry::Vec2;
use crate::motion::{DeployConfig, Reach, reach};
use crate::protocol::{CompletionConfig, TargetsConfig};

/// Warnings of `targets` that no robot can hold, which takes one within `near` metres.
#[must_use]
pub fn unreachable(targets: &TargetsConfig, near: f64, sections: &Sections<'_>) -> Vec<Problem> {
    let config = targets;
    let targets = config.places();
    let half = Vec2::new(sections.arena.size.0.get(), sections.arena.size.1.get()) / 2.0;
    let body_radius = sections.motion.body_radius.get();
    let places: Vec<Vec2> = targets.iter().map(|(place, _)| *place).collect();
    let reached = reach(sections.arena, body_radius, Vec2::zeros(), &places, near);
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
        let (path, help) = config.field(index);
        let also = ["arena.size", "arena.obstacles", "motion.body_radius"];
        found.push(Problem::new(&format!("protocol.{path}"), message, help).with(&also));
    }
    if let (TargetsConfig::Ring { .. }, [first, others @ ..]) = (config, &mut found[..])
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

/// A warning of missions that end before robots can be at the `targets`, within `near` metres of each.
#[must_use]
pub fn too_far(
    targets: &TargetsConfig,
    near: f64,
    sections: &Sections<'_>,
    completion: CompletionConfig,
) -> Option<Problem> {
    let start = |target: Vec2| match sections.deploy {
        DeployConfig::Cluster { radius } => target.norm() - radius.get(),
        DeployConfig::Uniform => 0.0,
        DeployConfig::At(places) => {
            let away = places
                .iter()
                .map(|(x, y)| (target - Vec2::new(x.get(), y.get())).norm());
            away.fold(f64::INFINITY, f64::min)
        }
    };
    let ways = targets.places().into_iter().map(|(target, _)| start(target) - near);
    let way = ways.fold(0.0, f64::max);
    let (speed, hold) = (sections.motion.max_speed.get(), completion.hold());
    let least = way / speed + hold;
    let time_limit = sections.time_limit;
    (least > time_limit).then(|| {
        let message = format!(
            "no trial can complete: the farthest target is {way:.2} m from where robots start, at {speed} m/s and held for {hold} s that takes {least:.0} s, and a trial ends at {time_limit} s"
        );
        let help = "make `time_limit` longer, `motion.max_speed` greater or the targets nearer";
        let also = ["motion.max_speed", "protocol", "metrics.hold", "swarm.deploy"];
        Problem::new("time_limit", message, help).with(&also)
    })
}

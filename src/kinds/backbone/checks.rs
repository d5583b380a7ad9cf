//! What is wrong between the backbone and the rest of a scenario, and missions that cannot be accomplished, or only by chance.

use super::config::{BackboneConfig, TargetsConfig};
use crate::geometry::Vec2;
use crate::kind::{Problem, Sections};
use crate::motion::{DeployConfig, Reach, reach};
use crate::protocol::CompletionConfig;
use crate::protocol::detector::DetectorConfig;
use crate::protocol::gossip::TimeToLiveConfig;

/// What is wrong between the backbone and the other sections.
pub fn conflicts(backbone: &BackboneConfig, sections: &Sections<'_>) -> Vec<Problem> {
    let mut found = strands(backbone, sections);
    found.extend(undetected(sections));
    found
}

/// The backbone cannot do without a detector.
fn undetected(sections: &Sections<'_>) -> Option<Problem> {
    (*sections.detector == DetectorConfig::None).then(|| {
        let message = "the backbone needs a failure detector: robots forget neighbours that have left, and mend chains, by whom they suspect";
        let help = "use `Timeout(4.0)` or another detector; `None` is for Heartbeat and Rumor";
        Problem::new("detector", message, help).with(&["protocol"])
    })
}

/// What the backbone's timeouts and chains bear.
fn strands(backbone: &BackboneConfig, sections: &Sections<'_>) -> Vec<Problem> {
    let strand = &sections.gossip.strand;
    let period = sections.period();
    let pause = (period * strand.repetition(period).longest_pause()).as_secs();
    let mut bounds = vec![
        (
            "protocol.recruiting.join_timeout",
            backbone.recruiting.join_timeout.get(),
            "a join without a sign is undone",
        ),
        (
            "protocol.healing.patience",
            backbone.healing.patience.get(),
            "the root forgets a chain",
        ),
    ];
    if let TimeToLiveConfig::Seconds(seconds) = strand.time_to_live {
        bounds.push(("gossip.strand.time_to_live", seconds.get(), "a strand counts no more"));
    }
    let too_rare = bounds.into_iter().filter(|(_, seconds, _)| pause >= *seconds);
    let mut found: Vec<_> = too_rare
        .map(|(path, seconds, what)| {
            let message = format!("strand info comes every {pause} s at the latest, and after {seconds} s {what}");
            let help = format!("make `{path}` several times the interval of `gossip.strand`, or that one shorter");
            Problem::new(path, message, help).with(&["gossip.strand", "control.period"])
        })
        .collect();
    let robots = backbone.longest_chain();
    if usize::from(strand.hop_limit) < robots {
        let path = "gossip.strand.hop_limit";
        let message = format!(
            "no strand may name more than {} robots, but the longest chain has {robots}",
            strand.hop_limit
        );
        let help = format!("make `{path}` at least {robots}");
        found.push(Problem::new(path, message, help).with(&["protocol.targets"]));
    }
    found
}

/// What looks wrong with the mission, which is complete as `completion` says.
pub fn warnings(backbone: &BackboneConfig, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem> {
    let mut found = places(backbone, sections);
    found.extend(robots(backbone, sections, completion));
    found.extend(time(backbone, sections, completion));
    found
}

/// Targets that no robot can hold.
fn places(backbone: &BackboneConfig, sections: &Sections<'_>) -> Vec<Problem> {
    let targets = backbone.targets();
    let half = Vec2::new(sections.arena.size.0.get(), sections.arena.size.1.get()) / 2.0;
    let near = backbone.movement_threshold.get();
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
fn robots(backbone: &BackboneConfig, sections: &Sections<'_>, completion: CompletionConfig) -> Option<Problem> {
    let (needed, there) = (backbone.robots_needed(), sections.robots);
    let at_once = completion != CompletionConfig::EachVisited;
    (at_once && needed > there as usize).then(|| {
        let message = format!(
            "the mission takes {needed} robots at least, for a root, a worker a target and their chains, and there are {there}"
        );
        let help = "make `swarm.robots` more, ask for fewer targets or links or for nearer ones, or for `completion: EachVisited`";
        Problem::new("swarm.robots", message, help).with(&["protocol.targets"])
    })
}

/// Missions that end before robots can be where they have to be.
fn time(backbone: &BackboneConfig, sections: &Sections<'_>, completion: CompletionConfig) -> Option<Problem> {
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
    let near = backbone.movement_threshold.get();
    let ways = backbone.targets().into_iter().map(|(target, _)| start(target) - near);
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

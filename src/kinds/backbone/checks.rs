//! What is wrong between the backbone and the rest of a scenario, and missions that cannot be accomplished, or only by chance.

use super::config::BackboneConfig;
use crate::kind::{Problem, Sections, targets};
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
    let near = backbone.movement_threshold.get();
    let mut found = targets::unreachable(&backbone.targets, near, sections);
    found.extend(robots(backbone, sections, completion));
    found.extend(targets::too_far(&backbone.targets, near, sections, completion));
    found
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

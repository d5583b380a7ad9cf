//! Why missions failed, in words: which target was missed, for how long, and what stood in the way.

use super::number::{count, figure, seconds};
use crate::geometry::Vec2;
use crate::metrics::Summary;
use crate::metrics::summary::{MissedSummary, MissedTarget};
use crate::motion::{Reach, reach};
use crate::scenario::Scenario;

/// What a mission asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Links that each target needs, in order.
    pub links: Vec<u8>,
    /// Whether a robot can come to each target, in order.
    pub reach: Vec<Reach>,
    /// The fewest robots that it takes.
    pub robots: usize,
}

impl Asked {
    /// What the mission of `scenario` asks for, if it has targets.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let targets = scenario.protocol.targets()?;
        let (places, links): (Vec<Vec2>, Vec<u8>) = targets.places.into_iter().unzip();
        let body = scenario.motion.body_radius.get();
        Some(Self {
            links,
            reach: reach(&scenario.arena, body, Vec2::zeros(), &places, targets.near),
            robots: targets.robots,
        })
    }
}

/// A sentence for each target for which missions failed, and one if there were too few robots; none where none failed.
pub fn sentences(summary: &Summary, asked: Option<&Asked>) -> Vec<String> {
    let (Some(missed), Some(asked)) = (&summary.missed, asked) else {
        return Vec::new();
    };
    let mut said: Vec<String> = missed
        .targets
        .iter()
        .map(|target| of_target(target, missed, asked))
        .collect();
    if missed.robots_alive < asked.robots as f64 {
        said.push(format!(
            "too few robots: {} alive at the end, and the mission takes {}",
            missed.robots_alive, asked.robots
        ));
    }
    said
}

fn of_target(target: &MissedTarget, missed: &MissedSummary, asked: &Asked) -> String {
    let number = target.target;
    let (time, all) = (seconds(target.missed_s), seconds(missed.lasted_s));
    let how_long = if missed.failed == 1 {
        format!("missed for {time} of {all}")
    } else {
        let (trials, failed) = (count(target.trials), count(missed.failed));
        format!("missed in {trials} of {failed} failed trials, in the median for {time} of {all}")
    };
    let wanted = asked.links.get(number as usize).copied().unwrap_or(1);
    let several = target.why.0.iter().filter(|(_, trials)| *trials > 0).count() > 1;
    let mut causes: Vec<&(String, u64)> = target.why.0.iter().filter(|(_, trials)| *trials > 0).collect();
    causes.sort_by_key(|(_, trials)| std::cmp::Reverse(*trials));
    let causes = causes.into_iter().map(|(why, trials)| {
        let words = cause(why, target, wanted);
        match (several, *trials) {
            (false, _) => words,
            (true, 1) => format!("{words} (1 trial)"),
            (true, trials) => format!("{words} ({} trials)", count(trials)),
        }
    });
    let causes = causes.collect::<Vec<_>>().join("; ");
    let bar = match asked.reach.get(number as usize) {
        Some(Reach::WalledIn) => "; it is walled in",
        Some(Reach::NoRoom) => "; there is no room for a robot near enough to it",
        Some(Reach::Open) | None => "",
    };
    format!("target {number}: {how_long}: {causes}{bar}")
}

fn cause(why: &str, target: &MissedTarget, wanted: u8) -> String {
    let metres =
        |metres: Option<f64>| metres.map_or_else(|| "far".to_owned(), |metres| format!("{} m", figure(metres)));
    let (end, best) = (metres(target.at_end_m), metres(target.nearest_m));
    match why {
        "no_worker" if target.nearest_m.is_none() => "it never had a worker".to_owned(),
        "no_worker" => format!("no worker was left; one had come to {best}"),
        "held_up" => format!("its worker was held up {end} away, {best} at best"),
        "on_its_way" => format!("its worker was still on its way, {end} away at the end"),
        "links_short" => match target.links {
            Some(links) if links < f64::from(wanted) => format!("links short, needed {wanted}, had {links}"),
            _ => format!("links too long for its {wanted} to count"),
        },
        _ => "held at the end, and not for long enough".to_owned(),
    }
}

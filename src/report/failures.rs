//! The report's section on failures and healing.

use super::layout::Page;
use super::number::{count, estimate, figure, maybe, seconds};
use crate::metrics::Summary;
use crate::metrics::summary::HealingSummary;

/// What failed, and how targets got their links back; nothing where nothing failed.
pub fn section(page: &mut Page, summary: &Summary) {
    let Some(faults) = &summary.faults else {
        return;
    };
    page.heading("Failures");
    let roles = faults.by_role.0.iter().filter(|(_, failures)| *failures > 0);
    let roles: Vec<_> = roles
        .map(|(role, failures)| format!("{role} {}", count(*failures)))
        .collect();
    // Where all robots have one role, there is nothing to tell apart.
    let roles = if roles.is_empty() || faults.by_role.0.len() == 1 {
        String::new()
    } else {
        format!("; in all trials: {}", roles.join(", "))
    };
    let robots = estimate(&faults.robots.estimate, figure);
    page.entry("robots", &format!("{robots} failed in a trial{roles}"));
    if faults.links > 0 {
        page.entry("links", &format!("{} faults in all trials", count(faults.links)));
    }
    if let Some(healing) = &summary.healing {
        healed(page, healing);
    }
}

fn healed(page: &mut Page, healing: &HealingSummary) {
    let total = &healing.total;
    let harm = format!(
        "a target lost a link or its worker by {} failures, nothing by {}",
        count(total.failures),
        count(healing.harmless)
    );
    page.entry("harm", &harm);
    if total.failures == 0 {
        return;
    }
    let time = format!(
        "{} of {}; Kaplan–Meier median of the time {}",
        count(total.healed),
        count(total.failures),
        estimate(&total.time.median, seconds)
    );
    page.entry("healed", &time);
    for (name, part) in healing.by_role.0.iter().chain(&healing.by_overlap.0) {
        if part.failures > 0 {
            let (healed, failures) = (count(part.healed), count(part.failures));
            let time = estimate(&part.time.median, seconds);
            page.entry("", &format!("{name}: {healed} of {failures}, median {time}"));
        }
    }
    if total.healed == 0 {
        return;
    }
    let distance = estimate(&total.distance.estimate, figure);
    page.entry(
        "meanwhile",
        &format!("the target's robots moved {distance} m all together"),
    );
    let frames = total.frames.0.iter();
    let frames: Vec<_> = frames
        .map(|(topic, frames)| format!("{topic} {}", maybe(frames.estimate.value)))
        .collect();
    page.entry("", &format!("and sent on average, in frames: {}", frames.join(", ")));
}

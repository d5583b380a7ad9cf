//! The report's section on a channel that robots share: how full it was, how long frames waited and how often they were sent, what it cost, what was lost
//! to what.

use super::layout::Page;
use super::number::{self, NOTHING, count, estimate, figure, percent, seconds, signed};
use crate::metrics::summary::{RadioSummary, Sending};
use crate::metrics::{Estimate, Summary};

/// A name and what there is to say under it.
type Row = (&'static str, String);

/// What radios did, over one on which frames take time; nothing over another.
pub fn section(page: &mut Page, summary: &Summary) {
    let rows = rows(summary);
    if rows.is_empty() {
        return;
    }
    page.heading("Air");
    for (name, words) in rows {
        page.entry(name, &words);
    }
    let mut name = "lost to";
    for (cause, frames) in lost(summary) {
        let share = percent(frames as f64 / summary.frames.total.offered.max(1) as f64);
        page.entry(
            name,
            &format!("{cause}: {}, {share} of the copies offered", count(frames)),
        );
        name = "";
    }
}

/// The causes to which any copy was lost, in words, the worst first.
pub fn lost(summary: &Summary) -> Vec<(String, u64)> {
    let lost = summary.frames.total.lost.0.iter().filter(|(_, frames)| *frames > 0);
    let mut lost: Vec<(String, u64)> = lost.map(|(cause, frames)| (cause.replace('_', " "), *frames)).collect();
    lost.sort_by_key(|(_, frames)| std::cmp::Reverse(*frames));
    lost
}

/// What there is to say of the radios of a summary.
pub fn rows(summary: &Summary) -> Vec<Row> {
    let Some(radio) = &summary.radio else {
        return Vec::new();
    };
    let mut rows = vec![(
        "channel",
        format!(
            "a robot sends {} of the time and finds it busy {} of the time",
            estimate(&radio.airtime_share.estimate, percent),
            estimate(&radio.busy_share.estimate, percent)
        ),
    )];
    if let Some(goodput) = &summary.goodput_bps {
        let words = format!("{} of payload, all robots together", estimate(&goodput.estimate, bits));
        rows.push(("goodput", words));
    }
    rows.push(("frames", sent(&radio.sending, &radio.attempts.estimate)));
    rows.extend(dropped(radio));
    if radio.sending.on_air > 0 {
        rows.push((
            "waiting",
            format!(
                "{} in the queue, then {} for the channel, 95 % within {}",
                estimate(&radio.queue_wait_s.mean, seconds),
                estimate(&radio.access_delay_s.mean, seconds),
                radio.access_delay_s.p95.value.map_or(NOTHING.to_owned(), seconds)
            ),
        ));
    }
    if radio.unacknowledged.estimate.value.is_some() {
        let share = estimate(&radio.unacknowledged.estimate, percent);
        rows.push((
            "unanswered",
            format!("{share} of the frames that ask for an acknowledgement"),
        ));
    }
    if radio.strayed.estimate.value > Some(0.0) {
        let share = estimate(&radio.strayed.estimate, percent);
        let words = format!("{share} of all messages received came from out of range: counted nowhere else");
        rows.push(("beyond", words));
    }
    if radio.power.estimate.value.is_some() {
        let power = estimate(&radio.power.estimate, signed);
        rows.push(("power", format!("{power} dBm, mean of the copies that were understood")));
    }
    rows.extend(energy(radio));
    if let Some(life) = &radio.lifetime_s {
        let lasted = match life.estimate.value {
            Some(_) => number::lasted(life),
            None => format!("none of {} was empty at the end", count(life.cut_off)),
        };
        rows.push(("battery", lasted));
    }
    rows
}

fn sent(sending: &Sending, attempts: &Estimate) -> String {
    let sent = format!("{} of {} went on air", count(sending.on_air), count(sending.frames));
    match attempts.value {
        Some(_) => format!("{sent}, {} times each", estimate(attempts, figure)),
        None => sent,
    }
}

/// Frames that their senders gave up.
fn dropped(radio: &RadioSummary) -> Option<Row> {
    let causes = radio.sending.dropped.0.iter().filter(|(_, frames)| *frames > 0);
    let causes: Vec<_> = causes
        .map(|(cause, frames)| format!("{} {}", cause.replace('_', " "), count(*frames)))
        .collect();
    let never = estimate(&radio.dropped.estimate, percent);
    (!causes.is_empty()).then(|| ("given up", format!("{}; {never} never went on air", causes.join(", "))))
}

fn energy(radio: &RadioSummary) -> Option<Row> {
    radio.energy.estimate.value?;
    let states = radio.energy_by_state.0.iter();
    let states: Vec<_> = states
        .map(|(state, energy)| format!("{state} {}", figure(*energy)))
        .collect();
    let energy = estimate(&radio.energy.estimate, figure);
    Some(("energy", format!("{energy} J a robot ({})", states.join(", "))))
}

/// A rate in the unit that suits it.
fn bits(rate: f64) -> String {
    match rate {
        _ if rate >= 1e6 => format!("{} Mbit/s", figure(rate / 1e6)),
        _ if rate >= 1e3 => format!("{} kbit/s", figure(rate / 1e3)),
        _ => format!("{} bit/s", figure(rate)),
    }
}

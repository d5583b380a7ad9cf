//! What statuses cost on the air, and what becomes of copies.

use super::scene::Scene;
use super::{Holds, Prediction, Preflight};
use crate::motion::Spacing;
use crate::radio::LossConfig;

const LOST: &str = "copies lost";
const RECEIVED: &str = "status bytes received";
const LOAD: &str = "channel load";

pub fn predict(scene: &Scene<'_>, preflight: &mut Preflight) {
    loss(scene, preflight);
    latency(scene, preflight);
    match scene.unmeasured() {
        None => {
            sent(scene, preflight);
            received(scene, preflight);
        }
        Some(why) => preflight.refuse("status_tx_bytes_per_step", "status bytes", why),
    }
    preflight.not_predicted.append(&mut scene.expected.unpredicted.clone());
    if scene.scenario.detector.sends() {
        let why = "how many probes are answered late, asked through others and told on depends on who is suspected";
        preflight.refuse("probe", "probe bytes", why);
    }
    let why = "the radio has no bit rate: bytes are counted, airtime and collisions do not exist";
    preflight.refuse("channel_utilisation", "share of the channel used", why);
}

fn loss(scene: &Scene<'_>, preflight: &mut Preflight) {
    let Some(value) = scene.loss_ratio() else {
        let why = "it depends on the distances of neighbours, which are not known";
        return preflight.refuse("loss_ratio", LOST, why);
    };
    let (formula, assumes) = match scene.scenario.radio.disk().loss {
        LossConfig::None => ("0", "every frame arrives"),
        LossConfig::Bernoulli(_) => ("p", "the channel alone: no fault of a link or a receiver"),
        LossConfig::GilbertElliott { .. } => (
            "π_G good_loss + π_B bad_loss, π_B = p/(p+r)",
            "the channel alone, stationary from the start",
        ),
        LossConfig::Distance { .. } => (
            "∫ at_range · (d/C)^e over neighbours",
            "the channel alone, at the distances of the start",
        ),
    };
    let by_distance = scene.depends_on_distance();
    let covered = scene.spacing.as_ref().map_or(0.0, Spacing::covered);
    preflight.predictions.push(Prediction {
        name: "loss_ratio",
        what: LOST,
        value,
        unit: "1",
        accuracy: if by_distance { value * covered } else { 0.0 },
        holds: if by_distance && !scene.stands_still() {
            Holds::AtStart
        } else {
            Holds::Throughout
        },
        formula,
        assumes: assumes.into(),
    });
}

fn latency(scene: &Scene<'_>, preflight: &mut Preflight) {
    let value = scene.scenario.radio.disk().latency.mean();
    preflight.predictions.push(Prediction {
        name: "latency_s",
        what: "mean latency",
        value,
        unit: "s",
        // Each copy's is rounded to a nanosecond.
        accuracy: 1e-9,
        holds: Holds::Throughout,
        formula: "mean of the latency's law",
        assumes: "all copies that are not lost, from transmission to arrival and not to reading".into(),
    });
}

pub fn sent(scene: &Scene<'_>, preflight: &mut Preflight) {
    let steps = scene.steps_a_status();
    let bytes = scene.status_bytes();
    // A trial has one status more than whole intervals, or less.
    let end = scene.interval_s() / scene.duration_s;
    let mut push = |name, what, value: f64, shared, unit, formula, assumes: &str| {
        preflight.predictions.push(Prediction {
            name,
            what,
            value,
            unit,
            accuracy: value * end + shared,
            holds: Holds::Throughout,
            formula,
            assumes: assumes.into(),
        });
    };
    push(
        "status_frames_per_step",
        "statuses sent",
        1.0 / steps,
        0.0,
        "frames/step",
        "1 / control steps an interval",
        "of a robot, none of which fails",
    );
    push(
        "status_tx_bytes_per_step",
        "status bytes sent",
        bytes / steps,
        scene.shared_bytes() / steps,
        "B/step",
        "(4 + header) / control steps an interval",
        "of a robot, none of which fails",
    );
}

fn received(scene: &Scene<'_>, preflight: &mut Preflight) {
    let degree = preflight.get("degree").map(|degree| (degree.value, degree.accuracy));
    let lost = preflight.get("loss_ratio").map(|lost| lost.value);
    let (Some((degree, accuracy)), Some(lost)) = (degree, lost) else {
        let why = "it takes the neighbours of a robot and the loss on the way from them";
        preflight.refuse("status_rx_bytes_per_step", RECEIVED, why);
        return preflight.refuse("channel_load_bytes_per_s", LOAD, why);
    };
    let holds = if scene.stands_still() {
        Holds::Throughout
    } else {
        Holds::AtStart
    };
    let end = scene.interval_s() / scene.duration_s;
    let latency = scene.scenario.radio.disk().latency.mean() / scene.duration_s;
    let sent = scene.status_bytes() / scene.steps_a_status();
    let shared = scene.shared_bytes() / scene.steps_a_status();
    preflight.predictions.push(Prediction {
        name: "status_rx_bytes_per_step",
        what: RECEIVED,
        value: degree * (1.0 - lost) * sent,
        unit: "B/step",
        accuracy: (1.0 - lost) * (sent * (accuracy + degree * (end + latency)) + degree * shared),
        holds,
        formula: "neighbours · (1 − loss) · status bytes sent",
        assumes: "of a robot, none of which fails".into(),
    });
    let a_second = sent / scene.period_s();
    let shared_a_second = shared / scene.period_s();
    let others = if scene.sends_statuses_alone() {
        "all that is sent in range of a robot, heard or lost"
    } else {
        "statuses alone, heard or lost: the other topics come on top"
    };
    preflight.predictions.push(Prediction {
        name: "channel_load_bytes_per_s",
        what: LOAD,
        value: degree * a_second,
        unit: "B/s",
        accuracy: a_second * (accuracy + degree * end) + degree * shared_a_second,
        holds,
        formula: "neighbours · status bytes a second",
        assumes: others.into(),
    });
}

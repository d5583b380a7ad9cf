//! What closed forms say where all robots share the air: what is sent, how full that makes the channel, what it costs; and, where all hear each other, who sends
//! at the same time.

use super::scene::Scene;
use super::{Holds, Prediction, Preflight};
use super::{swarm, traffic};
use crate::kind::Broadcasts;
use crate::quantity::Positive;
use crate::radio::propagation::FadingConfig;
use crate::radio::shared::{Form, Stream};
use crate::radio::{SharedConfig, WallsConfig};

const SHARE: &str = "time that a robot sends";
const OVERLAPS: &str = "frames on air with others";
const ENERGY: &str = "energy of a radio";

pub fn predict(scene: &Scene<'_>, preflight: &mut Preflight) {
    let Some(radio) = scene.scenario.radio.shared() else {
        return;
    };
    if is_even(scene, radio) {
        swarm::predict(scene, preflight);
    } else {
        let why = "who is in range follows from walls, shadowing or powers that differ, and not from distances alone";
        preflight.refuse("degree", "neighbours", why);
    }
    match scene.unmeasured() {
        None => traffic::sent(scene, preflight),
        Some(_) if scene.broadcasts().is_some() => {}
        Some(why) => preflight.refuse("status_tx_bytes_per_step", "status bytes", why),
    }
    if let Some(broadcasts) = scene.broadcasts() {
        sent(scene, radio, broadcasts, preflight);
        met(scene, radio, broadcasts, preflight);
    } else {
        let why = "robots send more than one steady stream of equal broadcasts: run it";
        preflight.refuse("radio.airtime_share", "airtime, share of the channel, energy", why);
    }
    preflight.not_predicted.append(&mut scene.expected.unpredicted.clone());
    let why =
        "what is lost, when it arrives and what a detector makes of it follow from who sends at the same time: run it";
    preflight.refuse("loss_ratio", "copies lost, latency, mistakes", why);
}

/// Whether who is in range is a matter of distances alone.
fn is_even(scene: &Scene<'_>, radio: &SharedConfig) -> bool {
    let in_the_way = radio.walls != WallsConfig::Pass && !scene.scenario.arena.obstacles.is_empty();
    let differ = radio.transmit_power_spread.get() + radio.antenna_gain_spread.get() > 0.0;
    !in_the_way && !differ && radio.shadowing.is_none()
}

/// The stream of `senders` robots, as frames.
fn stream(scene: &Scene<'_>, broadcasts: Broadcasts, senders: f64) -> Stream {
    let [_, header] = scene.scenario.header_bytes();
    Stream {
        robots: scene.scenario.swarm.robots,
        senders,
        per_second: broadcasts.per_second,
        payload: broadcasts.payload as u32 + u32::from(header),
    }
}

/// A closed form as a prediction.
fn prediction(name: &'static str, what: &'static str, unit: &'static str, form: Form, assumes: &str) -> Prediction {
    Prediction {
        name,
        what,
        value: form.value,
        unit,
        accuracy: form.accuracy,
        holds: Holds::Throughout,
        formula: form.formula,
        assumes: assumes.into(),
    }
}

/// What follows from what is sent alone.
fn sent(scene: &Scene<'_>, radio: &SharedConfig, broadcasts: Broadcasts, preflight: &mut Preflight) {
    if !radio.takes_time() {
        let why = "over this radio frames take no time";
        return preflight.refuse("radio.airtime_share", SHARE, why);
    }
    let others = f64::from(scene.scenario.swarm.robots) - 1.0;
    let neighbours = preflight.get("degree").map_or(others, |degree| degree.value);
    let stream = stream(scene, broadcasts, broadcasts.sending * (neighbours + 1.0));
    let airtime = radio.airtime_s(stream.payload);
    let exact = |value, formula| Form {
        value,
        accuracy: 0.0,
        formula,
    };
    preflight.predictions.push(prediction(
        "airtime_s",
        "airtime of a frame",
        "s",
        exact(airtime, "the technology's layout of a frame"),
        "on all its channels together",
    ));
    preflight.predictions.push(prediction(
        "capacity_robots",
        "senders that fill the channel",
        "robots",
        radio.capacity(stream),
        "in range of each other; what is lost to overlaps makes it fewer by far",
    ));
    if !radio.sustains(stream) {
        let why = "robots have more to send than medium access lets out, or so much that frames wait and are given up";
        return preflight.refuse("radio.airtime_share", SHARE, why);
    }
    let share = Form {
        // A trial has a frame of each robot more than whole intervals, or less.
        accuracy: airtime / scene.duration_s,
        ..exact(broadcasts.sending * broadcasts.per_second * airtime, "λT")
    };
    let assumes = "of a robot, none of which fails; frames that are never sent make it less";
    let share = prediction("radio.airtime_share", SHARE, "1", share, assumes);
    preflight.predictions.push(share);
}

/// Why chance alone does not decide who sends at the same time, if it does not.
fn unmet(scene: &Scene<'_>, radio: &SharedConfig, broadcasts: Broadcasts) -> Option<&'static str> {
    let others = f64::from(scene.scenario.swarm.robots) - 1.0;
    let clear = || {
        let spacing = scene.spacing.as_ref();
        spacing.map_or(0.0, |spacing| spacing.neighbours(radio.clear_range()))
    };
    if radio.phy().infrared.is_some() {
        return Some("who is in the way of whose light decides");
    }
    if !is_even(scene, radio) || radio.fading != FadingConfig::None || clear() < others * (1.0 - 1e-9) {
        return Some("not all robots hear each other all the time: who is hidden from whom decides");
    }
    if !scene.stands_still() {
        return Some("robots move, and need not stay in range of each other");
    }
    let why = "all robots send at once: what becomes of that is decided by medium access alone";
    (!broadcasts.scattered).then_some(why)
}

/// What follows where all robots hear each other, and each frame has its instant to itself or not by chance.
fn met(scene: &Scene<'_>, radio: &SharedConfig, broadcasts: Broadcasts, preflight: &mut Preflight) {
    if let Some(why) = unmet(scene, radio, broadcasts) {
        preflight.refuse("overlap_ratio", OVERLAPS, why);
        return preflight.refuse("radio.energy_J", ENERGY, why);
    }
    let robots = f64::from(scene.scenario.swarm.robots);
    let stream = stream(scene, broadcasts, broadcasts.sending * robots);
    if let Some(clean) = radio.clean(stream, scene.scenario.control.drift()) {
        let overlap = Form {
            value: 1.0 - clean.value,
            ..clean
        };
        let assumes = "one less the form; with `capture: inf` that is what is lost, with capture less";
        let overlap = prediction("overlap_ratio", OVERLAPS, "1", overlap, assumes);
        preflight.predictions.push(overlap);
    } else {
        let why = "no closed form holds for this medium access at this load";
        preflight.refuse("overlap_ratio", OVERLAPS, why);
    }
    let Some(watts) = radio.mean_watts(stream, broadcasts.sending) else {
        let why = "the channel is so full that frames wait, or the technology says nothing of what it draws";
        return preflight.refuse("radio.energy_J", ENERGY, why);
    };
    let joules = watts.value * scene.duration_s;
    let battery = radio.battery.map_or(f64::INFINITY, Positive::get);
    if battery < joules {
        let lifetime = Form {
            value: battery / watts.value,
            accuracy: battery / watts.value * watts.accuracy / watts.value,
            formula: "battery over mean power",
        };
        let assumes = "until the first batteries are empty: who fails neither sends nor is heard";
        let lifetime = prediction("lifetime_s", "life of a battery", "s", lifetime, assumes);
        preflight.predictions.push(lifetime);
        let why = "batteries are empty before the end, and robots fail";
        return preflight.refuse("radio.energy_J", ENERGY, why);
    }
    let energy = Form {
        value: joules,
        accuracy: watts.accuracy * scene.duration_s + watts.value * radio.airtime_s(stream.payload),
        ..watts
    };
    let assumes = "of a robot; P of listening, sending, turning round and receiving, times the trial's length";
    let energy = prediction("radio.energy_J", ENERGY, "J", energy, assumes);
    preflight.predictions.push(energy);
}

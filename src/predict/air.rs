//! What closed forms still say where all robots share the air: what is sent, not what becomes of it.

use super::Preflight;
use super::scene::Scene;
use super::{swarm, traffic};
use crate::radio::WallsConfig;

pub fn predict(scene: &Scene<'_>, preflight: &mut Preflight) {
    let Some(radio) = scene.scenario.radio.shared() else {
        return;
    };
    let in_the_way = radio.walls != WallsConfig::Pass && !scene.scenario.arena.obstacles.is_empty();
    let is_uneven =
        radio.shadowing.is_some() || radio.transmit_power_spread.get() + radio.antenna_gain_spread.get() > 0.0;
    if in_the_way || is_uneven {
        let why = "who is in range follows from walls, shadowing or powers that differ, and not from distances alone";
        preflight.refuse("degree", "neighbours", why);
    } else {
        swarm::predict(scene, preflight);
    }
    match scene.unmeasured() {
        None => traffic::sent(scene, preflight),
        Some(why) => preflight.refuse("status_tx_bytes_per_step", "status bytes", why),
    }
    preflight.not_predicted.append(&mut scene.expected.unpredicted.clone());
    let why =
        "what is lost, when it arrives and what a detector makes of it follow from who sends at the same time: run it";
    preflight.refuse("loss_ratio", "copies lost, latency, mistakes", why);
}

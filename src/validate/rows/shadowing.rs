//! Shadowing: its variance and how it changes from place to place.

use super::{Row, Setting, traffic};
use crate::validate::reading;

const MODEL: &str = "shadowing";
const SIGMA_DB: f64 = 4.0;
const DECORRELATION_M: f64 = 5.0;
/// Far from each other: 16 times the decorrelation, at either end.
const APART_M: f64 = 80.0;

/// Robots in couples at these places, each couple again and again in places far away; who is first in a couple sends to the other.
pub fn couples(couples: &[[(f64, f64); 2]], copies: u32, apart: f64, radio: &str) -> Setting {
    let mut places = Vec::new();
    for copy in 0..copies {
        let shift = apart * (f64::from(copy) - f64::from(copies - 1) / 2.0);
        places.extend(
            couples
                .iter()
                .flatten()
                .map(|(x, y)| format!("({:?}, {y:?})", x + shift)),
        );
    }
    let senders: Vec<String> = (0..places.len()).step_by(2).map(|robot| robot.to_string()).collect();
    let place = format!(
        "arena: (size: ({:?}, 60.0)),\n    motion: (body_radius: 0.0005, max_speed: 0.001),\n    swarm: (robots: {}, deploy: At([{}]))",
        apart * f64::from(copies) + 60.0,
        places.len(),
        places.join(", ")
    );
    let load = format!(
        "senders: Given([{}]), to: Next, when: Periodic(0.1), payload: 20",
        senders.join(", ")
    );
    let radio = format!(
        "technology: Custom(bit_rate: None, sensitivity: -300.0), {}, access: None, {radio}",
        super::EQUAL_LOSS
    );
    traffic(0.1, &place, &load, &radio)
}

fn setting(places: &[[(f64, f64); 2]]) -> Setting {
    let radio = format!("shadowing: (sigma: {SIGMA_DB:?}, decorrelation: {DECORRELATION_M:?})");
    couples(places, 20, APART_M, &radio)
}

/// What is beyond the loss of 50 dB.
fn beyond(power: f64) -> f64 {
    (power + 50.0) / SIGMA_DB
}

pub fn rows() -> Vec<Row> {
    let variance = |name: &str, metres: f64| {
        let couple = [[(0.0, 0.0), (metres, 0.0)]];
        let expected = SIGMA_DB * SIGMA_DB;
        Row::new(
            MODEL,
            name,
            (expected, "dB²"),
            setting(&couple),
            reading::power_variance(-50.0),
        )
        .trials(3000)
        .form("variance σ², however near the ends are to each other (Gudmundson, 1991)")
    };
    let correlation = |name: &str, [first, second]: [f64; 2]| {
        // One end goes along, the other across.
        let here = [(0.0, 0.0), (8.0, 0.0)];
        let there = [(first, 0.0), (8.0, second)];
        let expected = (-(first + second) / DECORRELATION_M).exp();
        Row::new(
            MODEL,
            name,
            (expected, ""),
            setting(&[here, there]),
            reading::products(beyond),
        )
        .trials(3000)
        .form("correlation e^(−(Δ₁ + Δ₂)/d) where the ends of a link go Δ₁ and Δ₂ (Gudmundson, 1991)")
    };
    vec![
        variance("shadowing.variance.0.5m", 0.5),
        variance("shadowing.variance.20m", 20.0),
        correlation("shadowing.correlation.one-end", [2.5, 0.01]),
        correlation("shadowing.correlation.both-ends", [2.0, 3.0]),
    ]
}

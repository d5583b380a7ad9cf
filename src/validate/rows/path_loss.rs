//! Path loss and walls: the power at which lone frames are heard.

use super::{Row, Setting, link};
use crate::validate::forms::fading::{friis, two_rays};
use crate::validate::reading;

const MODEL: &str = "path loss";

/// Carrier of the radio that measures, Hz.
const CARRIER: f64 = 2.44e9;

/// A radio that hears everything.
const HEARS_ALL: &str = "technology: Custom(sensitivity: -300.0)";

/// Powers are kept to about so much, dB.
const RESOLUTION_DB: f64 = 1e-5;

fn heard(metres: f64, radio: &str) -> Setting {
    link(1.0, metres, "Periodic(0.25)", 20, &format!("{HEARS_ALL}, {radio}"))
}

fn row(model: &'static str, name: &str, metres: f64, radio: &str, loss: f64) -> Row {
    Row::new(model, name, (-loss, "dBm"), heard(metres, radio), reading::power).exact_to(RESOLUTION_DB / loss)
}

pub fn rows() -> Vec<Row> {
    let line = |metres: f64| 40.0 + 30.0 * metres.log10();
    let bent = |metres: f64| friis(1.0, CARRIER) + 20.0 * 8_f64.log10() + 33.0 * (metres / 8.0).log10();
    let height = 0.1;
    let grounded = |ground: f64, metres| two_rays(metres, CARRIER, height, ground);
    vec![
        row(
            MODEL,
            "path-loss.friis.1m",
            1.0,
            "path_loss: Friis",
            friis(1.0, CARRIER),
        )
        .form("20 log₁₀(4πd/λ) dB, free space (Friis)"),
        row(
            MODEL,
            "path-loss.friis.30m",
            30.0,
            "path_loss: Friis",
            friis(30.0, CARRIER),
        )
        .form("20 log₁₀(4πd/λ) dB, free space (Friis)"),
        row(
            MODEL,
            "path-loss.log-distance.30m",
            30.0,
            "path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0)",
            line(30.0),
        )
        .form("40 dB + 10 · 3 log₁₀ d"),
        row(
            MODEL,
            "path-loss.break-point.5m",
            5.0,
            "path_loss: BreakPoint()",
            friis(5.0, CARRIER),
        )
        .form("40.2 dB + 20 log₁₀ d up to 8 m (IEEE 802.15.4, Annex E)"),
        row(
            MODEL,
            "path-loss.break-point.20m",
            20.0,
            "path_loss: BreakPoint()",
            bent(20.0),
        )
        .form("that at 8 m, and 33 log₁₀(d/8) dB (IEEE 802.15.4, Annex E)"),
        row(
            MODEL,
            "path-loss.two-ray.10m",
            10.0,
            "path_loss: TwoRay(height: 0.1)",
            40.0 - 40.0 * height.log10(),
        )
        .form("40 log₁₀ d − 40 log₁₀ h dB beyond 4πh²/λ, ground that reflects all"),
        row(
            MODEL,
            "path-loss.two-ray-ground.2m",
            2.0,
            "path_loss: TwoRay(height: 0.1, ground: Some(15.0))",
            grounded(15.0, 2.0),
        )
        .form("sum of the direct and the reflected wave, ground of ε = 15, vertical antennas (Fresnel)"),
        row(
            MODEL,
            "path-loss.two-ray-ground.20m",
            20.0,
            "path_loss: TwoRay(height: 0.1, ground: Some(15.0))",
            grounded(15.0, 20.0),
        )
        .form("sum of the direct and the reflected wave, ground of ε = 15, vertical antennas (Fresnel)"),
        walls(),
    ]
}

/// Two walls in the way, one with an attenuation of its own.
fn walls() -> Row {
    let radio = "path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0), walls: Loss(8.0)";
    let (seconds, mut sections) = heard(10.0, radio);
    let walls =
        "Wall(from: (3.0, -2.0), to: (3.0, 2.0)), Wall(from: (6.0, -2.0), to: (6.0, 2.0), attenuation: Some(5.0))";
    sections[0] = format!(
        "arena: (size: (30.0, 10.0), obstacles: [{walls}]),\n    swarm: (robots: 2, deploy: At([(0.0, 0.0), (10.0, 0.0)]))"
    );
    let loss = 40.0 + 30.0 + 8.0 + 5.0;
    Row::new(
        "walls",
        "walls.two",
        (-loss, "dBm"),
        (seconds, sections),
        reading::power,
    )
    .exact_to(RESOLUTION_DB / loss)
    .form("dB for each crossing, added: 70 at 10 m, a wall of 8 and one of 5")
}

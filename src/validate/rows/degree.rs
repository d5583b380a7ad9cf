//! How many robots hear each other.

use super::{Row, traffic};
use crate::metrics::TrialRecord;
use crate::statistics::Part;
use crate::validate::forms::fading::Law;
use crate::validate::reading;

const MODEL: &str = "degree";

/// Robots hear each other so far by path loss alone: 40 dB and 30 a decade leave the −80 dBm that they need.
fn range() -> f64 {
    10_f64.powf(40.0 / 30.0)
}

pub fn rows() -> Vec<Row> {
    let b = 4.0 * 10_f64.ln() / 30.0;
    vec![
        border(),
        factor(
            "shadowing",
            3.0,
            "shadowing: (sigma: 4.0, decorrelation: 2.0)",
            (2.0 * b * b).exp(),
        )
        .form("mean degree over that by path loss alone: e^(2(σ ln 10/10n)²), σ = 4 dB, n = 3"),
        factor("rayleigh", 2.0, "fading: Rayleigh()", Law::Rayleigh.degree(3.0))
            .form("mean degree over that by path loss alone: Γ(1 + 2/n), n = 3"),
        factor("rician-4", 2.0, "fading: Rician(k: 4.0)", Law::Rician(4.0).degree(3.0))
            .form("mean degree over that by path loss alone: Γ(1 + 2/n)(1 + K)^(−2/n) ₁F₁(−2/n; 1; −K), K = 4, n = 3"),
        factor(
            "nakagami-3",
            2.0,
            "fading: Nakagami(m: 3.0)",
            Law::Nakagami(3.0).degree(3.0),
        )
        .form("mean degree over that by path loss alone: Γ(m + 2/n)/(Γ(m) m^(2/n)), m = 3, n = 3"),
    ]
}

/// Robots in a square, borders and all.
fn border() -> Row {
    let x = 0.2_f64;
    let expected = 99.0 * (std::f64::consts::PI * x * x - 8.0 / 3.0 * x.powi(3) + x.powi(4) / 2.0);
    let sections = [
        "arena: (size: (10.0, 10.0))",
        "swarm: (robots: 100, deploy: Uniform)",
        "motion: (body_radius: 0.001, max_speed: 0.001)",
        "protocol: Traffic(when: Periodic(1.0))",
        "radio: (range: 2.0)",
        "metrics: (sample_interval: 1.0)",
    ];
    let setting = (0.1, sections.map(str::to_owned).to_vec());
    Row::new(MODEL, "degree.square", (expected, ""), setting, reading::neighbours)
        .trials(3000)
        .within(0.0005, "robots have bodies, of 1 mm")
        .form("(N − 1)(πx² − 8x³/3 + x⁴/2) in a square of side L, x = R/L = 0.2, N = 100: a disc less what is beyond the border")
}

/// All robots of a disc of `radius` ranges send to the one in its middle: who is heard there.
fn factor(name: &str, radius: f64, radio: &str, expected: f64) -> Row {
    let disc = radius * range();
    let place = format!(
        "arena: (size: ({size:?}, {size:?})),\n    motion: (body_radius: 0.001, max_speed: 0.001),\n    swarm: (robots: 200, deploy: Cluster(radius: {disc:?}))",
        size = 2.0 * disc + 10.0
    );
    let radio = format!(
        "technology: Custom(bit_rate: None, sensitivity: -80.0), path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0), access: None, negligible: 60.0, {radio}"
    );
    let setting = traffic(1.0, &place, "to: Robot(0), when: Periodic(1.0), payload: 20", &radio);
    let heard = move |record: &TrialRecord| -> Part {
        let [delivered, all] = reading::delivered(record);
        [delivered * radius * radius, all]
    };
    Row::new(MODEL, format!("degree.{name}"), (expected, ""), setting, heard).trials(240)
}

//! Fading: how deep, how often, how long, and how it changes from place to place.

use std::f64::consts::TAU;

use super::shadowing::couples;
use super::{EQUAL_LOSS, Row, Setting, WAVES, link};
use crate::validate::forms::fading::Law;
use crate::validate::forms::special::{db, j0, ratio};
use crate::validate::reading;

const MODEL: &str = "fading";

/// So fast that each frame has a gain of its own.
const FAST: &str = "doppler: 5000.0";

/// Doppler shift where gains are followed, Hz, and the time from a frame to the next, seconds.
const DOPPLER: f64 = 20.0;
const STEP_S: f64 = 0.0005;

fn law(law: Law, doppler: &str) -> String {
    match law {
        Law::Rayleigh => format!("Rayleigh({doppler})"),
        Law::Rician(k) => format!("Rician(k: {k:?}, {doppler})"),
        Law::Nakagami(m) => format!("Nakagami(m: {m:?}, {doppler})"),
    }
}

/// A radio without noise that hears what has at least so many dB of its mean power.
fn hears(depth_db: f64) -> String {
    format!(
        "technology: Custom(bit_rate: None, sensitivity: {:?}), {EQUAL_LOSS}",
        -50.0 + depth_db
    )
}

pub fn rows() -> Vec<Row> {
    let mut rows = vec![
        outage("fading.outage.rayleigh", Law::Rayleigh, 0.1, "1 − e^(−x), x = 0.1"),
        outage(
            "fading.outage.rician-4",
            Law::Rician(4.0),
            0.3,
            "1 − Q₁(√2K, √(2(K + 1)x)), K = 4, x = 0.3",
        ),
        outage(
            "fading.outage.nakagami-3",
            Law::Nakagami(3.0),
            0.3,
            "P(m, mx), m = 3, x = 0.3",
        ),
        outage(
            "fading.outage.nakagami-1.3",
            Law::Nakagami(1.3),
            0.2,
            "P(m, mx), m = 1.3, x = 0.2",
        ),
    ];
    rows.extend(crossings(
        "rayleigh",
        Law::Rayleigh,
        0.5,
        "√(2π) f ρ e^(−ρ²), f = 20 Hz, ρ = 0.5",
    ));
    rows.extend(crossings(
        "rician-4",
        Law::Rician(4.0),
        0.7,
        "√(2π(K + 1)) f ρ e^(−K − (K + 1)ρ²) I₀(2ρ√(K(K + 1))), K = 4, f = 20 Hz, ρ = 0.7",
    ));
    rows.push(correlation("fading.correlation.one-end", [0.2, 0.02]));
    rows.push(correlation("fading.correlation.both-ends", [0.1, 0.15]));
    rows
}

/// The share of frames whose gain is below `x`.
fn outage(name: &str, of: Law, x: f64, form: &str) -> Row {
    let radio = format!("{}, fading: {}", hears(db(x)), law(of, FAST));
    let expected = of.outage(x);
    Row::new(
        MODEL,
        name,
        (expected, ""),
        link(10.0, 1.0, "Poisson(1000.0)", 20, &radio),
        reading::lost,
    )
    .trials(24)
    .form(format!("P(gain < x) = {form}"))
    // Of n normal sums of 32 waves: the first term that is left out.
    .give_or_take((-x).exp() * (1.0 - x / 2.0) * x / 64.0, WAVES)
}

/// Statuses every half millisecond, of which a detector says when they begin to fail.
fn followed(of: Law, rho: f64) -> Setting {
    let seconds = 4.0;
    let radio = format!(
        "{}, access: None, fading: {}",
        hears(db(rho * rho)),
        law(of, &format!("doppler: {DOPPLER:?}"))
    );
    let sections = vec![
        super::pair(1.0),
        format!("control: (period: {STEP_S:?}, phase: Random)"),
        format!("motion: (tick: {STEP_S:?})"),
        "protocol: Heartbeat".to_owned(),
        format!("gossip: (status: (interval: {STEP_S:?}))"),
        format!("detector: Timeout({:?})", 1.5 * STEP_S),
        format!("radio: ({radio})"),
        "metrics: (sample_interval: 0.0)".to_owned(),
    ];
    (seconds, sections)
}

fn crossings(name: &str, of: Law, rho: f64, form: &str) -> [Row; 2] {
    let rate = of.crossings(rho, DOPPLER);
    let lasts = of.outage(rho * rho) / rate;
    let why = "fades that fall between two frames, 0.5 ms apart, are missed; gains are sums of 32 waves";
    [
        Row::new(
            MODEL,
            format!("fading.crossings.{name}"),
            (rate, "/s"),
            followed(of, rho),
            reading::onset_rate,
        )
        .form(format!(
            "falls through ρ of the root mean square a second: {form} (Rice, 1948)"
        ))
        .trials(120)
        .within(0.025, why),
        Row::new(
            MODEL,
            format!("fading.duration.{name}"),
            (1e3 * lasts, "ms"),
            followed(of, rho),
            reading::losses_a_suspicion(1e3 * STEP_S),
        )
        .form(format!("mean fade, P(gain < ρ²) over the rate of crossings: {form}"))
        .trials(120)
        .within(0.025, why),
    ]
}

/// Gains of a link and of one whose ends are so many wavelengths away.
fn correlation(name: &str, [first, second]: [f64; 2]) -> Row {
    let wavelength = 299_792_458.0 / 2.44e9;
    let here = [(0.0, 0.0), (3.0, 0.0)];
    // Robots have bodies: no end stays where it is.
    let there = [(first * wavelength, 0.0), (3.0, second * wavelength)];
    let [first, second] = [first, second].map(|wavelengths| j0(TAU * wavelengths));
    let setting = couples(&[here, there], 60, 11.0, "fading: Rayleigh()");
    Row::new(
        MODEL,
        name,
        (1.0 + (first * second).powi(2), ""),
        setting,
        reading::products(|power| ratio(power + 50.0)),
    )
    .trials(300)
    .form("mean product of gains 1 + (J0(2πΔ₁/λ) J0(2πΔ₂/λ))² where the ends go Δ₁ and Δ₂ (Akki and Haber, 1986)")
    .give_or_take(1.0 / 32.0, WAVES)
}

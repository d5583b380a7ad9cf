//! The timeout detector: mistakes under loss, and how soon failures are found.

use super::{Row, Setting};
use crate::validate::reading;

const MODEL: &str = "timeout detector";

/// Constant latency, seconds.
const LATENCY: f64 = 0.05;

/// Robots that hear each other and send a status a second, for long.
fn setting(seconds: f64, timeout: f64, loss: &str, more: &[&str]) -> Setting {
    let mut sections = vec![
        "swarm: (robots: 20, deploy: Cluster(radius: 0.9))".to_owned(),
        "control: (period: 1.0, phase: Random, wake: OnReception)".to_owned(),
        "protocol: Heartbeat".to_owned(),
        "gossip: (status: (interval: 1.0))".to_owned(),
        format!("detector: Timeout({timeout:?})"),
        format!("radio: (loss: {loss}, latency: Constant({LATENCY:?}))"),
        "metrics: (sample_interval: 0.0)".to_owned(),
    ];
    sections.extend(more.iter().map(|section| (*section).to_owned()));
    (seconds, sections)
}

pub fn rows() -> Vec<Row> {
    let (p, timeout) = (0.2_f64, 2.5);
    let m = 2.0;
    let bernoulli = || setting(1000.0, timeout, "Bernoulli(0.2)", &[]);
    let recurrence = 1.0 / ((1.0 - p) * p.powf(m));
    let duration = m + 1.0 / (1.0 - p) - timeout;
    let (to_bad, to_good) = (0.05_f64, 0.2_f64);
    let gilbert = (to_bad + to_good) / (to_good * to_bad * (1.0 - to_good).powi(2));
    let ends = "a pair is watched from a first status to the end of the run, and not for ever";
    let row = |name: &str,
               expected: (f64, &'static str),
               setting: Setting,
               reading: fn(&crate::metrics::TrialRecord) -> [f64; 2]| {
        Row::new(MODEL, name, expected, setting, reading).trials(12)
    };
    vec![
        row(
            "timeout.recurrence",
            (recurrence, "s"),
            bernoulli(),
            reading::recurrence,
        )
        .form("from mistake to mistake: η/((1 − p) p^m), m = ⌊TO/η⌋, η = 1 s, TO = 2.5 s, p = 0.2")
        .within(0.004, ends),
        row(
            "timeout.duration",
            (duration, "s"),
            bernoulli(),
            reading::mistake_duration,
        )
        .form("mean mistake: (m + 1/(1 − p))η − TO, TO = 2.5 s, p = 0.2")
        .within(0.002, ends),
        row(
            "timeout.accuracy",
            (1.0 - duration / recurrence, ""),
            bernoulli(),
            reading::accuracy,
        )
        .form("share of the time without mistake: 1 − E(T_M)/E(T_MR)")
        .within(0.0002, ends),
        row(
            "timeout.recurrence.bursts",
            (gilbert, "s"),
            setting(1000.0, 3.5, "GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2)", &[]),
            reading::recurrence,
        )
        .form("η(p + r)/(r p (1 − r)^(m − 1)), TO = 3.5 s, p = 0.05, r = 0.2: as much loss, in bursts")
        .within(0.01, ends),
        detection_time(),
    ]
}

/// Half of the robots fall silent.
fn detection_time() -> Row {
    let (p, timeout) = (0.2_f64, 3.5_f64);
    // After k losses in a row and a share u of a period: ∫ max(0, TO − u − k) du, and the status that was under way.
    let after = |k: i32| {
        let left = timeout - f64::from(k);
        let [far, near] = [left, left - 1.0].map(|left: f64| left.max(0.0).powi(2) / 2.0);
        (1.0 - p) * p.powi(k) * (far - near)
    };
    let expected = (0..40).map(after).sum::<f64>() + LATENCY;
    let faults = "faults: [Mute(robots: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9], at: 30.0)]";
    Row::new(
        MODEL,
        "timeout.detection",
        (expected, "s"),
        setting(45.0, timeout, "Bernoulli(0.2)", &[faults]),
        reading::detection_time,
    )
    .trials(200)
    .form("from a failure to its detection: Σ (1 − p) p^k ∫ max(0, TO − u − kη) du + d, TO = 3.5 s, p = 0.2")
    .within(
        0.001,
        "who is suspected already and wrongly when a robot fails counts as detected at once, latency and all",
    )
}

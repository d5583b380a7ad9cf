//! How well the failure detector will do.

use super::reading::Reading;
use super::scene::Scene;
use super::timeout::{Mistakes, Timeout};
use super::{Holds, Prediction, Preflight};
use crate::protocol::control::PhaseConfig;
use crate::protocol::detector::DetectorConfig;
use crate::radio::LossConfig;

/// Share of statuses that may overtake each other before the formulas no longer hold.
const OVERTAKEN: f64 = 1e-3;

const DURATION: &str = "mistake_duration_s";

pub fn predict(scene: &Scene<'_>, preflight: &mut Preflight) {
    if let Err(why) = figures(scene, preflight) {
        return preflight.refuse("detection", "mistakes, accuracy, detection time", why);
    }
    if preflight.get("mistake_recurrence_s").is_some() && preflight.get(DURATION).is_none() {
        let why = "mistakes are so rare that the formula's last digits decide";
        preflight.refuse(DURATION, "duration of a mistake", why);
    }
}

fn figures(scene: &Scene<'_>, preflight: &mut Preflight) -> Result<(), &'static str> {
    let radio = scene.scenario.radio.disk();
    if let Some(why) = scene.unsteady() {
        return Err(why);
    }
    if scene.status_timing().is_jittered() {
        return Err("statuses are moved at random within their interval, which the formulas leave out");
    }
    let detector = detector(scene)?;
    if detector.is_undecided() {
        return Err("the timeout is a multiple of the status interval and latency is 0: the order of events decides");
    }
    if detector.overtaken() > OVERTAKEN {
        return Err("the spread of latency lets statuses overtake each other, which the formulas leave out");
    }
    let range = radio.range.get();
    let of_distance = |distance| {
        let chain = radio.loss.chain(distance, range);
        let Mistakes { rate, share, excess } = detector.mistakes(chain);
        [rate, share, excess, detector.detection_time(chain)]
    };
    let Some([rate, share, excess, time]) = scene.mean_over_neighbours(of_distance) else {
        return Err("it depends on the distances of neighbours, which are not known");
    };
    let model = Model::of(scene);
    let ends = ends(scene, detector.silence());
    let neighbours = preflight.get("degree").map(|degree| degree.value);
    let reading = Reading::of(scene, &detector, radio.loss.chain(range, range), neighbours);
    let is_nfd_s = matches!(scene.scenario.detector, DetectorConfig::NfdS(_));
    let nfd_s = if is_nfd_s { "; NFD-S: TO = η + δ − d" } else { "" };
    let mut push = |name, what, value, unit, accuracy, formula, assumes: &str| {
        preflight.predictions.push(Prediction {
            name,
            what,
            value,
            unit,
            accuracy,
            holds: model.holds,
            formula,
            assumes: format!("{assumes}{nfd_s}{}", model.caveat),
        });
    };
    let pair = "a pair of robots in range, neither of which fails";
    push(
        "mistake_rate_hz",
        "mistakes a second",
        rate,
        "Hz",
        rate * ends,
        model.rate,
        pair,
    );
    let recurrence = 1.0 / rate;
    if recurrence.is_finite() {
        push(
            "mistake_recurrence_s",
            "time between mistakes",
            recurrence,
            "s",
            recurrence * ends,
            "1 / mistakes a second",
            pair,
        );
        // Long mistakes are the likelier to be cut off by the end.
        let varies = (scene.interval_s() * excess / rate).powi(2) / scene.duration_s;
        let duration = share / rate + reading.mean;
        // Of mistakes as rare as the last digits of a share it is all rounding, and may come out negative.
        if duration >= 0.0 {
            push(
                DURATION,
                "duration of a mistake",
                duration,
                "s",
                varies + reading.accuracy,
                model.duration,
                "until the observer reads the next status",
            );
        }
    }
    // Where nearly all time is mistaken, the next mistake begins before the end of one is read.
    let mistaken = (share + rate * reading.mean).min(1.0);
    push(
        "query_accuracy",
        "query accuracy",
        1.0 - mistaken,
        "1",
        mistaken * ends + rate * reading.accuracy,
        "1 − duration / time between mistakes",
        pair,
    );
    push(
        "detection_time_s",
        "time to detect a failure",
        time,
        "s",
        match scene.scenario.control.phase {
            PhaseConfig::Random => 0.0,
            // When in an interval a robot fails is the scenario's: off by half an interval at most.
            PhaseConfig::Together => scene.interval_s() / 2.0,
        },
        "E[(TO + d − U − Kη)⁺] ≈ TO + d − η(½ + p/(1−p))",
        "it fails at any time of its interval; TO + d at most",
    );
    Ok(())
}

/// The detector, where its closed forms are known.
fn detector(scene: &Scene<'_>) -> Result<Timeout, &'static str> {
    let latency = &scene.scenario.radio.disk().latency;
    let detector = &scene.scenario.detector;
    let silence = detector.usual_silence(scene.scenario.circumstances()).as_secs();
    match detector {
        DetectorConfig::Timeout(_) => Ok(Timeout::from_arrival(scene.interval_s(), silence, latency)),
        DetectorConfig::NfdS(_) => Ok(Timeout::from_sending(scene.interval_s(), silence, latency)),
        DetectorConfig::None => Err("robots run no failure detector: nobody is suspected, and no failure is noticed"),
        DetectorConfig::PhiAccrual(_) => {
            Err("φ-accrual learns from the intervals that losses leave: no closed form is known")
        }
        DetectorConfig::Swim(_) => {
            Err("SWIM's closed forms are of probes, not of pairs of robots: none is known of these figures")
        }
    }
}

/// What the loss model makes of the formulas.
struct Model {
    rate: &'static str,
    duration: &'static str,
    holds: Holds,
    caveat: &'static str,
}

impl Model {
    fn of(scene: &Scene<'_>) -> Self {
        let (rate, duration) = match scene.scenario.radio.disk().loss {
            LossConfig::None | LossConfig::Bernoulli(_) => ("(1−p) pᵐ / η, m = ⌊TO/η⌋", "(m + 1/(1−p)) η − TO"),
            LossConfig::GilbertElliott { .. } => (
                "r p (1−r)^(m−1) / (η(p+r)) if simple; else summed over states",
                "(m + 1/r) η − TO if simple; else summed over states",
            ),
            LossConfig::Distance { .. } => (
                "(1−p) pᵐ / η, averaged over neighbours",
                "(m + 1/(1−p)) η − TO, averaged over mistakes",
            ),
        };
        let bursts = matches!(scene.scenario.radio.disk().loss, LossConfig::GilbertElliott { .. });
        let still = scene.stands_still();
        let (holds, caveat) = match (still, bursts && !scene.sends_statuses_alone()) {
            (true, false) => (Holds::Throughout, ""),
            (_, true) => (
                Holds::AtStart,
                "; of robots that send statuses alone: other frames shorten the bursts that statuses see",
            ),
            (false, false) if scene.depends_on_distance() => (Holds::AtStart, ""),
            (false, false) => (Holds::InRange, ""),
        };
        Self {
            rate,
            duration,
            holds,
            caveat,
        }
    }
}

/// The share by which the ends of a run change the number of mistakes: what begins within a timeout of its end is none yet,
/// and a link is watched from an arrival on, which is an arrival more than its share.
fn ends(scene: &Scene<'_>, silence: f64) -> f64 {
    let radio = scene.scenario.radio.disk();
    let chain = radio.loss.chain(radio.range.get(), radio.range.get());
    let (arriving, memory) = (chain.arriving(), chain.memory());
    let first = (1.0 + (1.0 - arriving) * memory / (1.0 - memory)) / arriving;
    let interval = scene.interval_s();
    ((silence + interval * (0.5 + first)) / scene.duration_s).min(1.0)
}

//! What comes too late, takes too long or is too rare for the length of a trial.

use crate::faults::{self, Effect, Stage, WhenConfig};
use crate::geometry::Vec2;
use crate::kind::{Problem, Shared};
use crate::protocol::detector::DetectorConfig;
use crate::protocol::gossip::GossipConfig;
use crate::protocol::wander::WanderConfig;
use crate::scenario::Scenario;

/// Latencies that stand for all.
const QUANTILES: u32 = 200;
/// The share of statuses that may come later than a detector waits before that is said.
const LATE: f64 = 0.01;
/// The share of copies that may be under way when a trial ends before that is said.
const UNDER_WAY: f64 = 0.1;
/// By which share an interval may be rounded up before that is said.
const ROUNDED: f64 = 0.01;

/// What is too late, too long or too rare.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let mut found: Vec<Problem> = samples(scenario).into_iter().collect();
    found.extend(intervals(scenario));
    found.extend(pauses(scenario));
    found.extend(latency(scenario));
    found.extend(patience(scenario));
    found.extend(idle_faults(scenario));
    found
}

/// Samples and series of which a trial is too short to hold any.
fn samples(scenario: &Scenario) -> Option<Problem> {
    let time_limit = scenario.time_limit.get();
    let interval = scenario.metrics.sample_interval.get();
    let every = scenario.metrics.series_every;
    let entry = interval * f64::from(every);
    let also = ["time_limit"];
    if interval > time_limit {
        let message =
            format!("samples are {interval} s apart, and a trial ends at {time_limit} s: only its start is sampled");
        let help = "make `metrics.sample_interval` shorter, or 0 for no samples";
        return Some(Problem::new("metrics.sample_interval", message, help).with(&also));
    }
    (entry > time_limit).then(|| {
        let message =
            format!("an entry of the series takes {entry} s, and a trial ends at {time_limit} s: there is none");
        let help =
            "make `metrics.series_every` or `metrics.sample_interval` less, or `metrics.series_every` 0 for no series";
        Problem::new("metrics.series_every", message, help).with(&["metrics.sample_interval", "time_limit"])
    })
}

/// Whether robots watch each other.
fn watches(scenario: &Scenario) -> bool {
    scenario.runs_detector() && scenario.detector != DetectorConfig::None
}

/// Topics that are repeated less than twice in a trial, or at another interval than the one that is set.
fn intervals(scenario: &Scenario) -> Vec<Problem> {
    let gossip = &scenario.gossip;
    let (time_limit, period) = (scenario.time_limit.get(), scenario.control.period.get());
    let defaults = GossipConfig::default();
    let status = (
        "gossip.status.interval",
        gossip.status.interval,
        defaults.status.interval,
    );
    let strand = (
        "gossip.strand.interval",
        gossip.strand.interval,
        defaults.strand.interval,
    );
    let request = (
        "gossip.request.interval",
        gossip.request.interval,
        defaults.request.interval,
    );
    let relay = ("gossip.relay.interval", gossip.relay.interval, defaults.relay.interval);
    let heeded = scenario.protocol.heeds(&scenario.sections());
    let topics = [
        (Shared::Status, status),
        (Shared::Strand, strand),
        (Shared::Request, request),
        (Shared::Relay, relay),
    ];
    let mut found = Vec::new();
    for (setting, (path, interval, default)) in topics {
        if !heeded.contains(&setting) {
            continue;
        }
        let in_steps = setting != Shared::Relay || scenario.protocol.relays_in_steps();
        let seconds = interval.get();
        if seconds > time_limit {
            let message = format!("`{path}` is {seconds} s, and a trial ends at {time_limit} s: nothing is said twice");
            let help = format!("make `{path}` shorter, or `time_limit` longer");
            found.push(Problem::new(path, message, help).with(&["time_limit"]));
        }
        // As the topics' own timing rounds, a hair of binary fractions apart.
        let kept = (seconds / period - 1e-9).ceil().max(1.0) * period;
        if in_steps && interval != default && kept > seconds * (1.0 + ROUNDED) {
            let message = format!(
                "`{path}` of {seconds} s is kept at {} s, for robots speak at their control steps, every {period} s",
                micros(kept)
            );
            let help = format!("make `{path}` a multiple of `control.period`, or that one shorter");
            found.push(Problem::new(path, message, help).with(&["control.period"]));
        }
    }
    found
}

/// Seconds rounded to whole microseconds, as a reader would write them.
fn micros(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

/// Rests and legs that outlast the trial, and walks that lead nowhere.
fn pauses(scenario: &Scenario) -> Option<Problem> {
    let time_limit = scenario.time_limit.get();
    let help = "make `wander` faster, or `time_limit` longer";
    if let WanderConfig::RandomWaypoint { pause, .. } = scenario.wander
        && pause.get() >= time_limit
    {
        let message = format!(
            "a robot rests {} s at its first waypoint, and a trial ends at {time_limit} s",
            pause.get()
        );
        return Some(Problem::new("wander", message, "make its `pause` shorter").with(&["time_limit"]));
    }
    let way = scenario.wander.speed() * time_limit;
    let body = 2.0 * scenario.motion.body_radius.get();
    (way > 0.0 && way < body).then(|| {
        let message = format!("robots go {way:.3} m in a whole trial, less than the {body} m of their bodies");
        Problem::new("wander", message, help).with(&["time_limit", "motion.body_radius"])
    })
}

/// Latencies as long as the run.
fn latency(scenario: &Scenario) -> Option<Problem> {
    let time_limit = scenario.time_limit.get();
    let latencies = scenario.radio.disk().latency.quantiles(QUANTILES);
    // Of frames that are sent at any time of the trial: E[min(D, T)]/T.
    let within = latencies.iter().map(|latency| (latency / time_limit).min(1.0));
    let share = within.sum::<f64>() / latencies.len() as f64;
    (share > UNDER_WAY).then(|| {
        let message = format!(
            "about {:.0} % of all copies are still under way when a trial ends, at {time_limit} s",
            100.0 * share
        );
        let help = "make `time_limit` longer, or `radio.latency` shorter";
        Problem::new("radio.latency", message, help).with(&["time_limit"])
    })
}

/// Detectors that cannot suspect anybody within a trial, or that latency alone makes suspicious.
fn patience(scenario: &Scenario) -> Option<Problem> {
    if !watches(scenario) {
        return None;
    }
    let time_limit = scenario.time_limit.get();
    let silence = scenario.detector.usual_silence(scenario.circumstances()).as_secs();
    if silence >= time_limit {
        let message = format!(
            "nobody is ever suspected: that takes a silence of {silence} s, and a trial ends at {time_limit} s"
        );
        let help = "make `detector` less patient, or `time_limit` longer";
        return Some(Problem::new("detector", message, help).with(&["time_limit", "gossip.status.interval"]));
    }
    let borne = match &scenario.detector {
        DetectorConfig::NfdS(nfd_s) => nfd_s.shift.get(),
        _ => silence,
    };
    let latencies = scenario.radio.disk().latency.quantiles(QUANTILES);
    let late = latencies.iter().filter(|latency| **latency > borne).count() as f64 / latencies.len() as f64;
    (late > LATE).then(|| {
        let message = format!(
            "{:.0} % of statuses take longer than the {borne} s that the detector waits for one",
            100.0 * late
        );
        let help = "make `detector` more patient, or `radio.latency` shorter";
        Problem::new("radio.latency", message, help).with(&["detector"])
    })
}

/// Faults that never act, and failures that come too late to be noticed.
fn idle_faults(scenario: &Scenario) -> Vec<Problem> {
    let time_limit = scenario.time_limit.get();
    let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
    let half = Vec2::new(width, height) / 2.0;
    let stage = Stage {
        time_limit,
        half: half.add_scalar(-scenario.motion.body_radius.get()),
        reserved: scenario.protocol.reserved(),
    };
    let help = "remove it, or change what keeps it from acting";
    let also = ["time_limit", "arena.size"];
    let idle = faults::warnings(&scenario.faults, &stage)
        .into_iter()
        .map(|(path, message)| {
            let problem = Problem::new(&format!("faults{path}"), message, help);
            problem.with(&also)
        });
    let mut found: Vec<Problem> = idle.collect();
    if watches(scenario) {
        found.extend(unnoticed(scenario));
    }
    found
}

/// Failures at a given time that leave a detector too little time before the end.
fn unnoticed(scenario: &Scenario) -> Vec<Problem> {
    let time_limit = scenario.time_limit.get();
    let silence = scenario.detector.usual_silence(scenario.circumstances()).as_secs();
    let mut found = Vec::new();
    for (index, fault) in scenario.faults.iter().enumerate() {
        let Some(robots) = fault.of_robots() else { continue };
        let WhenConfig::At(at) = robots.when else { continue };
        let at = at.get();
        let is_seen = robots.effect != Effect::Deaf;
        if is_seen && at < time_limit && at + silence > time_limit && silence < time_limit {
            let message = format!(
                "a failure at {at} s is noticed after the end: that takes a silence of {silence} s, and a trial ends at {time_limit} s"
            );
            let help = "let it come earlier, or make `time_limit` longer";
            found.push(Problem::new(&format!("faults[{index}]"), message, help).with(&["time_limit", "detector"]));
        }
    }
    found
}

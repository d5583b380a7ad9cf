//! What no field shows on its own: relations between fields, and bounds on memory and time.

use crate::engine::Span;
use crate::faults;
use crate::kind::Problem;
use crate::quantity::Positive;

use super::{Scenario, detector, gossip, limits, needs};

/// Everything wrong with `scenario`.
pub fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut found = counts(scenario);
    found.extend(periods(scenario));
    let radio = scenario.radio.problems(scenario.swarm.robots, scenario.control.drift());
    if found.is_empty() && radio.is_empty() {
        // Times and sizes are computed from counts, periods and a radio that hold.
        found.extend(times(scenario));
        found.extend(detector::problems(scenario));
        found.extend(sizes(scenario));
        found.extend(gossip::problems(scenario));
        found.extend(scenario.protocol.conflicts(&scenario.sections()));
    }
    found.extend(name(scenario));
    found.extend(sections(scenario, radio));
    if found.is_empty() {
        found.extend(room(scenario));
    }
    found
}

/// Robots that find no place in one of the first trials.
fn room(scenario: &Scenario) -> Option<Problem> {
    let refusal = scenario.site().refusal(scenario.trials)?;
    let help = "random places fill up long before bodies cover the ground: make room for twice the bodies";
    let also = ["swarm.robots", "arena.size", "arena.obstacles", "motion.body_radius"];
    Some(Problem::new("swarm.deploy", refusal, help).with(&also))
}

fn name(scenario: &Scenario) -> Option<Problem> {
    let name = &scenario.name;
    let fits = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    let help = format!(
        "use 1 to {} letters a-z, A-Z, digits, `-` and `_`: it names the results folder",
        limits::NAME
    );
    let refused = |message: String| Some(Problem::new("name", message, help));
    match name.chars().find(|letter| !fits(*letter)) {
        Some(letter) => refused(format!("the name {name:?} has {letter:?} in it")),
        None if name.is_empty() => refused("the name is empty".into()),
        None if name.len() > limits::NAME => refused(format!("the name is {} letters long", name.len())),
        None => None,
    }
}

fn counts(scenario: &Scenario) -> Vec<Problem> {
    let mut found = Vec::new();
    let mut count = |path: &str, value: u32, most: u32| {
        if !(1..=most).contains(&value) {
            let message = format!("{value} is out of range for `{path}`");
            found.push(Problem::new(
                path,
                message,
                format!("expected a whole number from 1 to {most}"),
            ));
        }
    };
    count("trials", scenario.trials, limits::TRIALS);
    count("swarm.robots", scenario.swarm.robots, limits::ROBOTS);
    found
}

/// What each section finds wrong with itself.
fn sections(scenario: &Scenario, radio: Vec<(String, String)>) -> Vec<Problem> {
    let Scenario {
        arena,
        motion,
        swarm,
        detector,
        ..
    } = scenario;
    let deploy = swarm.deploy.problems(swarm.robots, arena, motion.body_radius.get());
    // What fits a frame is asked of a radio that holds.
    let protocol = if radio.is_empty() {
        scenario.protocol.problems(&scenario.sections())
    } else {
        Vec::new()
    };
    let faults = faults::problems(&scenario.faults, swarm.robots, scenario.protocol.roles());
    let around = ["swarm.robots", "arena.size", "motion.body_radius"];
    let sections: [(_, _, &[&str]); 7] = [
        ("arena", arena.problems(), &[]),
        ("motion", motion.problems(), &[]),
        ("radio", radio, &[]),
        ("swarm.deploy", deploy, &around),
        ("protocol", protocol, &["swarm.robots", "radio.range"]),
        ("detector", detector.problems(), &[]),
        ("faults", faults, &["swarm.robots", "protocol"]),
    ];
    let found = sections.into_iter().flat_map(|(section, problems, also)| {
        let placed = move |problem| Problem::of_section(section, problem).with(also);
        problems.into_iter().map(placed)
    });
    let mut found: Vec<_> = found.collect();
    if found.is_empty() {
        found.extend(statuses_fit(scenario));
    }
    found
}

/// Statuses whose length is known, and that no frame can carry. Other messages are lost one by one, with that cause.
fn statuses_fit(scenario: &Scenario) -> Option<Problem> {
    let bytes = scenario.protocol.status_bytes()?;
    let topics = scenario.topics().len();
    let most = scenario.radio.longest_message(topics, scenario.gossip.piggyback)?;
    (bytes > f64::from(most)).then(|| {
        let message =
            format!("a status of {bytes} bytes never fits a frame of this radio, which carries at most {most}");
        let help = "take a `technology` with longer frames, or a protocol with shorter statuses";
        Problem::new("radio", message, help).with(&["protocol"])
    })
}

fn periods(scenario: &Scenario) -> Vec<Problem> {
    let gossip = &scenario.gossip;
    let periods = [
        ("control.period", scenario.control.period),
        ("motion.tick", scenario.motion.tick),
        ("gossip.status.interval", gossip.status.interval),
        ("gossip.strand.interval", gossip.strand.interval),
        ("gossip.request.interval", gossip.request.interval),
        ("gossip.relay.interval", gossip.relay.interval),
    ];
    let mut found: Vec<_> = periods
        .into_iter()
        .filter_map(|(path, period)| too_short(path, period))
        .collect();
    let drift = scenario.control.clock_drift.get();
    if drift > limits::CLOCK_DRIFT {
        let message = format!("clocks that are wrong by {drift} parts in a million are out of range");
        let help = format!("expected at most {}: crystals are within 10 to 50", limits::CLOCK_DRIFT);
        found.push(Problem::new("control.clock_drift", message, help));
    }
    let time_limit = scenario.time_limit.get();
    if time_limit > limits::SECONDS {
        let message = format!("a time limit of {time_limit} s is out of range");
        let help = format!("expected at most {} s", limits::SECONDS);
        found.push(Problem::new("time_limit", message, help));
    }
    let (width, height) = (scenario.arena.size.0.get(), scenario.arena.size.1.get());
    if width.max(height) > limits::METRES {
        let message = format!("an arena of {width} m × {height} m is out of range");
        let help = format!("expected at most {} m", limits::METRES);
        found.push(Problem::new("arena.size", message, help));
    }
    found
}

fn too_short(path: &str, period: Positive) -> Option<Problem> {
    let period = period.get();
    (period < limits::SHORTEST_PERIOD).then(|| {
        let message = format!("`{path}` of {period} s is too short");
        Problem::new(
            path,
            message,
            format!("expected at least {} s", limits::SHORTEST_PERIOD),
        )
    })
}

fn times(scenario: &Scenario) -> Vec<Problem> {
    let mut found = Vec::new();
    let period = scenario.control.period.get();
    let tick = scenario.motion.tick.get();
    let time_limit = scenario.time_limit.get();
    let completion = scenario.completion();
    let hold = completion.hold();
    if !Span::from_secs(period)
        .as_nanos()
        .is_multiple_of(Span::from_secs(tick).as_nanos())
    {
        let message = format!("a control period of {period} s is no whole number of motion ticks of {tick} s");
        let help = "make `control.period` a multiple of `motion.tick`";
        found.push(Problem::new("control.period", message, help).with(&["motion.tick"]));
    }
    if time_limit < period {
        let message = format!("the time limit of {time_limit} s ends before the first control period of {period} s");
        let help = "make `time_limit` longer than `control.period`";
        found.push(Problem::new("time_limit", message, help).with(&["control.period"]));
    }
    if let Some(held) = scenario.protocol.mission() {
        if hold >= time_limit {
            let message = format!("no trial can complete: {held} for {hold} s, and a trial ends at {time_limit} s");
            let help = "make `time_limit` longer, or the hold of `protocol.completion` shorter";
            found.push(Problem::new("time_limit", message, help).with(&["metrics.hold", "protocol"]));
        }
        if scenario.protocol.completion().is_some() && scenario.metrics.hold.is_some() {
            let message = "`metrics.hold` and `protocol.completion` both say when the mission is complete";
            let help = "leave out `metrics.hold`: it is the older way to say `completion: Held(seconds)`";
            found.push(Problem::new("metrics.hold", message, help).with(&["protocol.completion"]));
        }
    }
    found
}

fn sizes(scenario: &Scenario) -> Vec<Problem> {
    let robots = f64::from(scenario.swarm.robots);
    let time_limit = scenario.time_limit.get();
    let steps = time_limit / scenario.control.period.get();
    let ticks = time_limit / scenario.motion.tick.get();
    let bound = |also: &[&str], what: &str, value: f64, most: f64, help: &str| {
        (value > most).then(|| {
            let message = format!("{value:.3e} {what}, more than the {most:.0e} that a trial may have");
            Problem::new("time_limit", message, help).with(also)
        })
    };
    let counted = [
        bound(
            &["control.period", "motion.tick"],
            "steps or ticks in a trial",
            steps.max(ticks),
            limits::STEPS,
            "make `time_limit` shorter, or `control.period` and `motion.tick` longer",
        ),
        bound(
            &["control.period", "swarm.robots"],
            "control steps of all robots in a trial",
            robots * steps,
            limits::ROBOT_STEPS,
            "make `time_limit` shorter, `control.period` longer, or `swarm.robots` fewer",
        ),
    ];
    let mut found: Vec<Problem> = counted.into_iter().flatten().collect();
    if found.is_empty() {
        found.extend(needs::problems(scenario));
    }
    found
}

//! What a scenario asks of a machine, before it is run: the memory that a trial takes and the events that it has, as upper
//! bounds in closed form. What is too much is refused, what is much is warned of, each with the number and with the field to
//! change.
//!
//! The bytes are of the command at its peak, the writing of the results included, as measured; they hold within a factor of
//! about three where a scenario keeps what it may keep.

mod view;

use super::{Scenario, limits};
use crate::kind::Problem;
use view::View;

/// Bytes of the program itself.
const PROGRAM: f64 = 30e6;
/// Of a robot, its traffic by role and topic included.
const ROBOT: f64 = 4000.0;
/// Of an observer and a subject.
const PAIR: f64 = 200.0;
/// Of a copy under way.
const COPY: f64 = 140.0;
/// Of an interval that φ-accrual remembers.
const INTERVAL: f64 = 16.0;
/// Rows of a table that are in memory at once; what there is more of is in a file.
const ROWS: f64 = 262_144.0;
/// Of a long list, the part in memory.
const LIST: f64 = 4.2e6;
/// Of the row of a suspicion, of a sample, of a position in it, and of a topic in the series, each way.
const SUSPICION: f64 = 350.0;
const SAMPLE: f64 = 170.0;
const POSITION: f64 = 150.0;
const TOPIC: f64 = 240.0;
/// Of what a robot carried one way, and of how it ended.
const CARRIED: f64 = 400.0;
/// Of how long a mistake lasted, and of how a target stood in a sample: that is all in memory in the end.
const TIME: f64 = 22.0;
const STAND: f64 = 50.0;
/// Of a number in the factor of a matrix.
const ENTRY: f64 = 8.0;
/// Of an entry of a list: a suspicion, and a sample.
const LISTED: f64 = 100.0;
/// Of a finished trial until all are, and of a robot in it; its other numbers are in a file.
const TRIAL: f64 = 2000.0;
const LOAD: f64 = 16.0;
/// Of what a failure takes, the share that stays: how long it was until somebody noticed.
const NOTICED: f64 = 0.2;
/// Of what passed between two robots.
const BETWEEN: f64 = 6500.0;
/// Of what became of copies on a link.
const LINK: f64 = 600.0;
/// Of a row of a table that is asked for, where it is written, and where it is listed.
const ASKED: f64 = 190.0;
const ASKED_LISTED: f64 = 60.0;
/// Of a copy under way whose distance is kept.
const PLACED: f64 = 30.0;

/// What a scenario asks of a machine.
struct Needs {
    shares: Vec<Share>,
    /// Events of a trial: steps, ticks, frames and what robots hear of them.
    events: f64,
}

/// A share of the memory.
struct Share {
    what: &'static str,
    bytes: f64,
    /// The field best changed, others that it depends on, and how.
    field: &'static str,
    also: &'static [&'static str],
    help: &'static str,
}

/// What is more than a machine has.
pub fn problems(scenario: &Scenario) -> Vec<Problem> {
    let needs = Needs::of(scenario);
    let memory = needs.memory(limits::MEMORY, "more than desim goes along with");
    let time = time(needs.events, limits::EVENTS, "a trial", "which would take weeks");
    memory.into_iter().chain(time).collect()
}

/// What is much for a machine.
pub fn warnings(scenario: &Scenario) -> Vec<Problem> {
    let needs = Needs::of(scenario);
    let memory = needs.memory(
        limits::MUCH_MEMORY,
        "and so does each other trial that runs at the same time",
    );
    let all = needs.events * f64::from(scenario.trials);
    let time = time(all, limits::MANY_EVENTS, "all trials", "which may take days");
    memory.into_iter().chain(time).collect()
}

impl Needs {
    fn memory(&self, most: f64, verdict: &str) -> Option<Problem> {
        let total = self.shares.iter().map(|share| share.bytes).sum::<f64>() + PROGRAM;
        let largest = self.shares.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes))?;
        (total > most).then(|| {
            let message = format!(
                "a trial may take {} of memory, {verdict}: {} of it for {}",
                words(total),
                words(largest.bytes),
                largest.what
            );
            Problem::new(largest.field, message, largest.help).with(largest.also)
        })
    }

    fn of(scenario: &Scenario) -> Self {
        let view = View::of(scenario);
        let mut shares = vec![
            Share {
                what: "robots and whom they hear",
                bytes: view.robots * ROBOT + view.pairs * (PAIR + view.window() * INTERVAL),
                field: "swarm.robots",
                also: &["radio.range", "swarm.deploy", "arena.size", "detector"],
                help: "make `swarm.robots` fewer, or `radio.range` shorter",
            },
            Share {
                what: "copies of frames under way",
                bytes: view.copies() * COPY,
                field: "radio.latency",
                also: &["radio.range", "swarm.robots", "gossip", "protocol", "swarm.deploy"],
                help: "make `radio.latency` or `radio.range` shorter, or what is sent less frequent",
            },
            Share {
                what: "statuses that suspicions are traced to",
                bytes: view.log(),
                field: "detector",
                also: &["gossip.status.interval", "swarm.robots", "radio.loss"],
                help: "make `detector` less patient, or `gossip.status.interval` longer",
            },
            Share {
                what: "suspicions",
                bytes: rows(view.suspicions()) * SUSPICION
                    + list(view.suspicions() * LISTED)
                    + view.suspicions() * TIME,
                field: "time_limit",
                also: &["detector", "radio.loss", "swarm.robots", "gossip.status.interval"],
                help: "make `time_limit` shorter, `detector` more patient, or fewer robots hear each other",
            },
            Share {
                what: "what passes between every two robots",
                bytes: view.between() * BETWEEN,
                field: "metrics.pairs",
                also: &["swarm.robots", "radio.range"],
                help: "leave out `metrics.pairs`",
            },
            Share {
                what: "what became of copies on every link",
                bytes: view.links() * LINK,
                field: "metrics.links",
                also: &["swarm.robots", "radio.range_payload"],
                help: "leave out `metrics.links`",
            },
            Share {
                what: "tables that it asks for",
                bytes: view
                    .asked()
                    .map(|all| rows(all) * ASKED + list(all * ASKED_LISTED))
                    .sum::<f64>()
                    + view.placed() * PLACED,
                field: "metrics.record",
                also: &["metrics.sample_interval", "metrics.series_every", "swarm.robots"],
                help: "ask for fewer tables in `metrics.record`",
            },
            Share {
                what: "failures and who notices them",
                bytes: view.failures(),
                field: "faults",
                also: &["time_limit", "control.period", "swarm.robots"],
                help: "make hazards smaller, failures longer, or `time_limit` shorter",
            },
            Share {
                what: "samples and positions",
                bytes: rows(view.samples) * SAMPLE
                    + rows(view.samples * view.robots) * POSITION
                    + 2.0 * list(view.samples * LISTED)
                    + view.samples * STAND,
                field: "metrics.sample_interval",
                also: &["time_limit", "swarm.robots"],
                help: "make `metrics.sample_interval` longer",
            },
            Share {
                what: "λ₂ of their graph",
                bytes: view.factor() * ENTRY,
                field: "metrics.sample_interval",
                also: &["swarm.robots", "radio.range", "swarm.deploy", "arena.size"],
                help: "set `metrics.sample_interval` to 0: then there are no samples, and no λ₂",
            },
            Share {
                what: "the series of traffic",
                bytes: rows(view.entries() * view.topics()) * TOPIC + list(view.entries() * LISTED),
                field: "metrics.series_every",
                also: &["metrics.sample_interval", "time_limit"],
                help: "make `metrics.series_every` more, or 0 for no series",
            },
        ];
        shares.push(others(&view, f64::from(scenario.trials)));
        Self {
            shares,
            events: view.events(),
        }
    }
}

/// What is in memory of the trials but one until all are finished: a few numbers each, and their rows, which fill the tables.
fn others(view: &View, trials: f64) -> Share {
    let kept = TRIAL + view.robots * LOAD + view.suspicions() * TIME + view.failures() * NOTICED;
    let rows_more = |own: f64| rows(own * trials) - rows(own);
    Share {
        what: "the other trials, until all are finished",
        bytes: (trials - 1.0) * kept
            + rows_more(view.suspicions()) * SUSPICION
            + rows_more(view.samples) * SAMPLE
            + rows_more(view.samples * view.robots) * POSITION
            + rows_more(view.entries() * view.topics()) * TOPIC
            + rows_more(2.0 * view.robots) * CARRIED,
        field: "trials",
        also: &["time_limit", "detector", "swarm.robots"],
        help: "make `trials` fewer",
    }
}

/// As many of `all` rows as are in memory at once.
fn rows(all: f64) -> f64 {
    all.min(ROWS)
}

/// As many of `all` bytes of a long list as are in memory.
fn list(all: f64) -> f64 {
    all.min(LIST)
}

/// What to say of `events` if they are more than `most`.
fn time(events: f64, most: f64, whose: &str, verdict: &str) -> Option<Problem> {
    (events > most).then(|| {
        let message = format!("{whose} may have {events:.0e} events, {verdict}");
        let help = "make `time_limit` shorter, what repeats less frequent, or the swarm smaller or thinner";
        let also = ["swarm.robots", "control.period", "radio.range", "gossip", "trials"];
        Problem::new("time_limit", message, help).with(&also)
    })
}

/// Bytes as people say them.
fn words(bytes: f64) -> String {
    match bytes {
        ..1e9 => format!("{:.0} MB", bytes / 1e6),
        ..1e12 => format!("{:.1} GB", bytes / 1e9),
        ..1e15 => format!("{:.1} TB", bytes / 1e12),
        _ => format!("{bytes:.1e} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::parse;

    /// A protocol whose robots send nothing but statuses, and that takes no settings.
    fn statuses_alone() -> &'static str {
        let unit = crate::kinds::all().into_iter().find(|kind| kind.is_unit);
        unit.expect("such a protocol is shipped").name
    }

    /// Of a small arena that is sampled only where that is what is looked at.
    fn needs(sections: &str) -> f64 {
        let text = format!("Scenario(name: \"a\", {sections})");
        let scenario = parse("a.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
        let needs = Needs::of(&scenario);
        (needs.shares.iter().map(|share| share.bytes).sum::<f64>() + PROGRAM) / 1e6
    }

    #[test]
    fn links_take_memory_where_there_is_something_to_keep_of_them() {
        let with = |radio: &str, links: bool| {
            needs(&format!(
                "time_limit: 60.0, swarm: (robots: 1000, deploy: Uniform), protocol: Traffic(), radio: ({radio}), metrics: (links: {links})"
            ))
        };
        let technology = "technology: Ieee802154()";
        let more = with(technology, true) - with(technology, false);
        // Everybody hears everybody.
        assert!((more - 1000.0 * 999.0 * LINK / 1e6).abs() < 1.0, "{more} MB");
        assert!((with("", true) - with("", false)).abs() < f64::EPSILON);
    }

    /// Peak memory of the command as the system told it, MB, on 64 bits, of a run of each scenario with one thread.
    #[test]
    fn the_estimate_is_no_less_than_what_runs_took_and_no_more_than_three_times_as_much() {
        let alone = statuses_alone();
        let lossy = format!(
            "arena: (size: (6.0, 6.0)), protocol: {alone}, detector: Timeout(0.15), radio: (loss: Bernoulli(0.5), latency: Constant(0.0))"
        );
        let still = format!("arena: (size: (6.0, 6.0)), protocol: {alone}");
        let unsampled = "metrics: (sample_interval: 0.0)";
        for (sections, measured) in [
            (
                format!("time_limit: 200.0, swarm: (robots: 40, deploy: Uniform), {lossy}"),
                100.0,
            ),
            (
                format!("trials: 20, time_limit: 100.0, swarm: (robots: 40, deploy: Uniform), {lossy}, {unsampled}"),
                124.0,
            ),
            (
                format!(
                    "trials: 3000, time_limit: 1.0, swarm: (robots: 40, deploy: Uniform), {still}, control: (period: 1.0), {unsampled}"
                ),
                125.0,
            ),
            (
                format!(
                    "time_limit: 500.0, swarm: (robots: 2, deploy: Uniform), {still}, metrics: (sample_interval: 0.001)"
                ),
                131.0,
            ),
            (
                format!(
                    "time_limit: 1000.0, swarm: (robots: 2, deploy: Uniform), {still}, metrics: (sample_interval: 0.001, series_every: 0)"
                ),
                104.0,
            ),
            (
                format!(
                    "time_limit: 100.0, swarm: (robots: 200, deploy: Uniform), arena: (size: (20.0, 20.0)), protocol: {alone}, gossip: (status: (interval: 10.0)), detector: Timeout(30.0), metrics: (sample_interval: 0.01, series_every: 0)"
                ),
                70.0,
            ),
            (
                format!(
                    "time_limit: 1.0, swarm: (robots: 20000, deploy: Uniform), arena: (size: (200.0, 200.0)), protocol: {alone}, {unsampled}"
                ),
                123.0,
            ),
            (
                format!(
                    "time_limit: 1.0, swarm: (robots: 20000, deploy: Uniform), arena: (size: (60.0, 60.0)), protocol: {alone}, {unsampled}"
                ),
                479.0,
            ),
            (
                format!(
                    "time_limit: 100.0, swarm: (robots: 100, deploy: Uniform), {still}, radio: (latency: Constant(50.0)), {unsampled}"
                ),
                210.0,
            ),
            (
                format!(
                    "time_limit: 300.0, swarm: (robots: 300, deploy: Uniform), {still}, detector: PhiAccrual(dialect: Chitchat, window: 100000), {unsampled}"
                ),
                830.0,
            ),
            (
                format!(
                    "time_limit: 2000.0, swarm: (robots: 300, deploy: Uniform), arena: (size: (30.0, 30.0)), wander: RandomWaypoint(speed: 0.3), motion: (max_speed: 0.3), gossip: (status: (interval: 1.0)), protocol: {alone}, detector: Timeout(3.0), {unsampled}"
                ),
                108.0,
            ),
            (
                format!(
                    "time_limit: 60.0, swarm: (robots: 300, deploy: Uniform), {still}, radio: (loss: Bernoulli(0.2), latency: Normal(mean: 0.02, std_dev: 0.01, min: 0.001)), metrics: (sample_interval: 0.0, pairs: true)"
                ),
                179.0,
            ),
        ] {
            let needs = needs(&sections);
            assert!(
                (measured..3.0 * measured).contains(&needs),
                "{sections}: {measured} MB measured, {needs:.0} MB estimated"
            );
        }
    }
}

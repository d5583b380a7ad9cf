//! No scenario file, however broken, ends in a panic or a hang: it is read, or what is wrong with it is said.

use std::time::{Duration, Instant};

use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeVal;

use desim::scenario::{Override, Report, Scenario, parse, to_ron};

use crate::shipped;

#[cfg(feature = "command")]
mod command;
mod mutations;
mod studies;

const MUTANTS: u32 = 300;
/// Longest time that a mutant may take: a hundred times what one takes.
const PATIENCE: Duration = Duration::from_secs(5);

/// What a report must have: words, and a place within the text for what stands in it.
fn sound(report: &Report, text: &str, label: &str) {
    assert!(!report.diagnostics.is_empty(), "{label}");
    let lines = text.matches('\n').count() + 1;
    for found in &report.diagnostics {
        assert!(
            !found.message.is_empty() && found.help.as_ref().is_none_or(|help| !help.is_empty()),
            "{label}"
        );
        let place = found
            .place
            .as_ref()
            .unwrap_or_else(|| panic!("{label}: no place for {found}"));
        assert!(
            (1..=lines).contains(&place.line) && place.column >= 1,
            "{label}: {found}"
        );
    }
    assert!(!report.to_string().is_empty(), "{label}");
}

#[test]
fn each_of_300_broken_scenario_files_is_read_or_refused_with_line_and_field() {
    let mut refused = 0;
    for mutant in mutations::mutants(MUTANTS) {
        let start = Instant::now();
        match parse("mutant.ron", &mutant.text, &[]) {
            Ok(scenario) => assert_eq!(
                parse("again.ron", &to_ron(&scenario), &[]).as_ref(),
                Ok(&scenario),
                "{}",
                mutant.label
            ),
            Err(report) => {
                refused += 1;
                sound(&report, &mutant.text, &mutant.label);
            }
        }
        assert!(start.elapsed() < PATIENCE, "{}", mutant.label);
    }
    assert!(
        refused > 200,
        "only {refused} of {MUTANTS} mutants are wrong: the mutations have become too tame"
    );
}

#[test]
fn a_misspelt_field_is_always_named_on_its_line_with_the_right_name() {
    for mutant in mutations::mutants(MUTANTS) {
        let Some((name, line)) = mutant.misspelt else {
            continue;
        };
        let report = parse("mutant.ron", &mutant.text, &[]).expect_err("no field has this name");
        let named = report.diagnostics.iter().find(|found| {
            let here = found.place.as_ref().is_some_and(|place| place.line == line);
            here && found.message.contains(&format!("unknown field `{name}`"))
        });
        let named = named.unwrap_or_else(|| panic!("{}: {report}", mutant.label));
        assert!(
            named.path.as_ref().is_some_and(|path| path.ends_with(&name)),
            "{}: {report}",
            mutant.label
        );
        assert!(named.message.contains("did you mean"), "{}: {report}", mutant.label);
    }
}

#[test]
fn what_stands_in_a_mutant_given_as_an_override_is_read_or_refused() {
    let base = std::fs::read_to_string(&shipped::files()[0]).unwrap();
    for mutant in mutations::mutants(MUTANTS) {
        for line in mutant.text.lines().filter(|line| line.len() < 2000) {
            let given = line.trim().replacen(": ", "=", 1);
            let outcome: Result<Scenario, Report> = given
                .parse::<Override>()
                .and_then(|given| parse("base.ron", &base, &[given]));
            if let Err(report) = outcome {
                sound(&report, &base, &given);
            }
        }
    }
}

#[test]
fn each_of_300_scenario_files_with_extreme_numbers_is_read_or_refused_with_line_and_field() {
    let mut read = 0;
    for (mutant, models) in mutations::extremes(MUTANTS) {
        let label = format!("{} with {models:?}", mutant.label);
        let models: Vec<Override> = models
            .iter()
            .map(|model| model.parse().expect("it has a value"))
            .collect();
        let start = Instant::now();
        match parse("mutant.ron", &mutant.text, &models) {
            Ok(_) => read += 1,
            Err(report) => sound(&report, &mutant.text, &label),
        }
        assert!(start.elapsed() < PATIENCE, "{label}");
    }
    assert!(read > MUTANTS / 10, "only {read} are well, so that little is shown");
}

/// Processor time of this thread so far, that of the system for its memory apart: others may be using the machine.
fn spent() -> Duration {
    let usage = getrusage(UsageWho::RUSAGE_THREAD).expect("the system tells of its threads");
    let time = |time: TimeVal| {
        let [seconds, micros] =
            [time.tv_sec(), time.tv_usec()].map(|part| u64::try_from(part).expect("no time is negative"));
        Duration::from_secs(seconds) + Duration::from_micros(micros)
    };
    time(usage.user_time())
}

/// The least time that reading `text` takes, of a few tries.
fn least_time(text: &str) -> Duration {
    let time = || {
        let start = spent();
        let report = parse("long.ron", text, &[]).expect_err("the file is wrong");
        assert!(report.to_string().len() < 50_000, "the report is as long as the file");
        spent().saturating_sub(start)
    };
    (0..3).map(|_| time()).min().unwrap_or_default()
}

/// A broken file of so many parts.
type Text = fn(usize) -> String;

/// Four times the file takes four times as long, or sixteen times where time grows with its square: eight tell them apart.
#[test]
fn what_is_wrong_with_a_long_file_is_found_in_time_proportional_to_its_length() {
    let base = "Scenario(name: \"a\", time_limit: 9.0, swarm: (robots: 2, deploy: Uniform), protocol: Heartbeat";
    let broken: [(&str, Text); 8] = [
        ("numbers on a line behind an open bracket", |n| {
            format!("(a: [{}", "1.5, ".repeat(n))
        }),
        ("numbers on lines behind an open bracket", |n| {
            format!("(a: [\n{}", "1.5,\n".repeat(n))
        }),
        ("groups on a line behind an open bracket", |n| {
            format!("(a: [{}", "(1, 2), ".repeat(n))
        }),
        ("closing brackets after many lines", |n| {
            format!("{}({}", "// words\n".repeat(n), "]".repeat(n))
        }),
        ("missing commas", |n| format!("(a: [{}])", "1.5 ".repeat(n))),
        ("stray letters", |n| format!("(a: [{}])", "? ".repeat(n))),
        ("an open string", |n| format!("(a: \"{}", "x ".repeat(n))),
        ("open comments in each other", |n| format!("(a: 1, {}", "/* ".repeat(n))),
    ];
    let mut texts: Vec<(String, [String; 2])> = broken
        .iter()
        .map(|(label, text)| ((*label).to_owned(), [40_000, 160_000].map(text)))
        .collect();
    let faults = |n| format!("{base}, faults: [{}])", "Crash(robots: [7], at: 1.0), ".repeat(n));
    texts.push(("faults at unknown robots".to_owned(), [5_000, 20_000].map(faults)));
    for (label, [short, long]) in texts {
        let (short, long) = (least_time(&short), least_time(&long));
        assert!(
            long < short * 8 + Duration::from_millis(100),
            "{label}: {short:?}, then {long:?}"
        );
    }
}

#[test]
fn of_20_000_faults_at_unknown_robots_the_first_20_are_shown_and_the_others_counted() {
    let faults = "Crash(robots: [7], at: 1.0),\n".repeat(20_000);
    let text = format!(
        "Scenario(name: \"a\", time_limit: 9.0, swarm: (robots: 2, deploy: Uniform), protocol: Heartbeat, faults: [\n{faults}])"
    );
    let report = parse("long.ron", &text, &[]).expect_err("there is no robot 7");
    let lines: Vec<_> = report
        .diagnostics
        .iter()
        .filter_map(|found| Some(found.place.as_ref()?.line))
        .collect();
    assert_eq!(lines, (2..22).collect::<Vec<_>>());
    assert_eq!(report.more, 19_980);
    assert!(report.to_string().ends_with("and 19980 more\n"), "{report}");
}

//! No scenario file, however broken, ends in a panic or a hang: it is read, or what is wrong with it is said.

use std::time::{Duration, Instant};

use desim::scenario::{Override, Report, Scenario, parse, to_ron};

mod command;
mod mutations;
#[path = "../shipped/mod.rs"]
mod shipped;
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

//! Runs into folders by the library: the same bytes as the command's, interruption, resume, and what is refused.

use std::fs;
use std::path::Path;

use desim::export::Pictures;
use desim::metrics::Summary;
use desim::runs::{Cause, Happening, Options, Other, RunsError, ScenarioRun, StudyRun, Until, run_scenario, run_study};
use desim::scenario::{Plan, Scenario, load_study, parse};
use desim::simulation::DriverKind;

use crate::studies::command::{bytes, desim, place};

fn scenario(settings: &str) -> Scenario {
    let text = format!(
        "Scenario(name: \"a\", trials: 4, time_limit: 10.0, swarm: (robots: 3, deploy: Uniform), protocol: Heartbeat, {settings})"
    );
    parse("a.ron", &text, &[]).unwrap()
}

fn plan(dir: &Path) -> Plan {
    load_study(&dir.join("study.ron")).unwrap()
}

#[test]
fn a_study_run_by_the_library_has_the_bytes_of_the_command() {
    let dir = place();
    let until = ["--until-width", "0.01", "--most-trials", "12"];
    let commanded = [&["compare", "study.ron", "--out", "commanded", "--quiet"][..], &until].concat();
    desim(dir.path(), &commanded).assert().success();
    let plan = plan(dir.path()).with_most_trials(12);
    let run = StudyRun {
        until: Some(Until {
            width: 0.01,
            most_trials: 12,
        }),
        ..StudyRun::of(&plan)
    };
    let options = Options {
        driver: DriverKind::Actors,
        ..Options::default()
    };
    let mut begun = Vec::new();
    let told = |happening: Happening| {
        if let Happening::Begin { kept, trials } = happening {
            begun.push((kept, trials));
        }
    };
    let called = dir.path().join("called");
    let results = run_study(&run, &called, &options, told).unwrap();
    assert_eq!(
        begun,
        [(0, 16), (16, 24)],
        "8 trials of two settings, then as many as may be"
    );
    assert_eq!(results.comparison.stopping.as_ref().unwrap().trials, 12);
    let [commanded, called] = [dir.path().join("commanded"), called].map(|dir| bytes(&dir));
    assert_eq!(commanded.keys().collect::<Vec<_>>(), called.keys().collect::<Vec<_>>());
    for (name, bytes) in &commanded {
        assert!(called[name] == *bytes, "{name} differs");
    }
}

#[test]
fn a_scenario_run_by_the_library_has_the_bytes_of_the_command() {
    let dir = place();
    desim(
        dir.path(),
        &["scenario", "base.ron", "--trials", "3", "--out", "commanded", "--quiet"],
    )
    .assert()
    .success();
    let text = fs::read_to_string(dir.path().join("base.ron")).unwrap();
    let scenario = parse("base.ron", &text, &["trials=3".parse().unwrap()]).unwrap();
    let called = dir.path().join("called");
    let results = run_scenario(&ScenarioRun::of(&scenario), &called, &Options::default(), |_| ()).unwrap();
    assert_eq!(results.summary.trials, 3);
    assert_eq!(bytes(&dir.path().join("commanded")), bytes(&called));
}

#[test]
fn a_cancelled_run_keeps_what_has_finished_and_goes_on_to_the_same_bytes() {
    let dir = place();
    let plan = plan(dir.path());
    let run = StudyRun::of(&plan);
    let [whole, cut] = ["whole", "cut"].map(|name| dir.path().join(name));
    run_study(&run, &whole, &Options::default(), |_| ()).unwrap();

    let options = Options::default();
    let mut finished = 0;
    let error = run_study(&run, &cut, &options, |happening| {
        if let Happening::Trial(_) = happening {
            finished += 1;
            options.stop.cancel();
        }
    })
    .unwrap_err();
    assert_eq!(error.cause(), Cause::Interruption);
    let RunsError::Interrupted { kept, trials: 16, .. } = error else {
        panic!("{error:?}");
    };
    assert!(
        kept >= 1 && kept == finished && kept < 16,
        "{kept} kept, {finished} told"
    );
    let mut begun = None;
    run_study(&run, &cut, &Options::default(), |happening| {
        if let Happening::Begin { kept, .. } = happening {
            begun = Some(kept as usize);
        }
    })
    .unwrap();
    assert_eq!(begun, Some(kept));
    assert_eq!(bytes(&whole), bytes(&cut));

    let mut told = Vec::new();
    let again = run_study(&run, &cut, &options, |happening| told.push(format!("{happening:?}"))).unwrap();
    assert_eq!(told, ["There"], "what is there needs no run, cancelled or not");
    assert_eq!(again.comparison.settings.len(), 2);
}

#[test]
fn a_run_cancelled_before_its_first_trial_leaves_nothing() {
    let dir = place();
    let options = Options::default();
    options.stop.cancel();
    let out = dir.path().join("deep/out");
    let plan = plan(dir.path());
    let errors = [
        run_study(&StudyRun::of(&plan), &out, &options, |_| ()).unwrap_err(),
        run_scenario(&ScenarioRun::of(&scenario("")), &out, &options, |_| ()).unwrap_err(),
    ];
    for error in errors {
        assert!(matches!(error, RunsError::Interrupted { kept: 0, .. }), "{error:?}");
        assert!(!dir.path().join("deep").exists());
    }
}

#[test]
fn results_of_something_else_are_refused_and_replaced_only_when_that_is_asked_for() {
    let dir = place();
    let out = dir.path().join("out");
    let run = |seed: &str, options: &Options| {
        let scenario = scenario(&format!("seed: {seed}"));
        let run = ScenarioRun {
            pictures: Pictures::None,
            ..ScenarioRun::of(&scenario)
        };
        run_scenario(&run, &out, options, |_| ()).map(|results| results.summary)
    };
    let first: Summary = run("1", &Options::default()).unwrap();
    let error = run("2", &Options::default()).unwrap_err();
    assert_eq!(error.cause(), Cause::Input);
    let RunsError::Taken {
        of: Other::Scenario,
        differences,
        ..
    } = error
    else {
        panic!("{error:?}");
    };
    assert_eq!(differences, ["seed: 1 there, 2 now"]);
    let replace = Options {
        replace: true,
        ..Options::default()
    };
    assert_ne!(run("2", &replace).unwrap(), first);
}

#[test]
fn a_trial_that_fails_is_told_from_an_interruption_and_cancels_nobody_else() {
    let dir = place();
    // As many robots as a file may ask for: packed, they would fit.
    let crowd = |robots: u32| {
        let text = format!(
            "Scenario(name: \"a\", time_limit: 10.0, swarm: (robots: {robots}, deploy: Uniform), protocol: Heartbeat, \
             arena: (size: (0.5, 0.5)))"
        );
        parse("a.ron", &text, &[]).ok()
    };
    let crowded = (1..).map_while(crowd).last().unwrap();
    let options = Options::default();
    let error = run_scenario(&ScenarioRun::of(&crowded), &dir.path().join("out"), &options, |_| ()).unwrap_err();
    assert!(matches!(error, RunsError::Trial { .. }), "{error:?}");
    assert_eq!(
        error.cause(),
        Cause::Input,
        "robots without room are the scenario's fault"
    );
    assert!(!options.stop.is_cancelled());
    assert!(!dir.path().join("out").exists());
}

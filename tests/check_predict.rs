//! `desim check --predict` on broken and on extreme scenario files: exit status 0 or 2, never a panic, and each within a second of
//! processor time. Alone in its program: the time of processes is that of all that a program has started.

use std::time::Duration;

use assert_cmd::Command;
use nix::sys::resource::{UsageWho, getrusage};

#[allow(dead_code)] // What a mutant misspells matters elsewhere.
#[path = "scenario/fuzz/mutations.rs"]
mod mutations;
mod shipped;

/// How many files are checked, unless the environment says otherwise.
const FILES: u32 = 120;
const NUMBER: &str = "DESIM_CHECKED_FILES";
/// Processor time that one may take.
const MOST: Duration = Duration::from_secs(1);
/// After so long it is taken to hang.
const PATIENCE: Duration = Duration::from_secs(120);

/// Processor time of all processes that have ended.
fn spent() -> Duration {
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).expect("the system tells of its processes");
    let time = |time: nix::sys::time::TimeVal| {
        let [seconds, micros] =
            [time.tv_sec(), time.tv_usec()].map(|part| u64::try_from(part).expect("no time is negative"));
        Duration::from_secs(seconds) + Duration::from_micros(micros)
    };
    time(usage.user_time()) + time(usage.system_time())
}

#[test]
fn every_broken_or_extreme_file_is_checked_and_predicted_within_a_second_and_without_a_panic() {
    let count = std::env::var(NUMBER).map_or(FILES, |number| number.parse().expect("a whole number of files"));
    let broken = mutations::mutants(count / 2)
        .into_iter()
        .map(|mutant| (mutant, Vec::new()));
    let extreme = mutations::extremes(count - count / 2);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("mutant.ron");
    let (mut well, mut wrong) = (0, Vec::new());
    for (mutant, models) in broken.chain(extreme) {
        std::fs::write(&file, &mutant.text).expect("the folder can be written to");
        let mut command = Command::cargo_bin("desim").expect("the command is built with the tests");
        command.args(["check", "--predict"]).arg(&file);
        for model in &models {
            command.args(["--set", model]);
        }
        let before = spent();
        let output = command.timeout(PATIENCE).output().expect("the command starts and ends");
        let time = spent().saturating_sub(before);
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8_lossy(&said);
        let status = output.status.code();
        well += u32::from(status == Some(0));
        if !matches!(status, Some(0 | 2)) || said.contains("panicked") || time > MOST || said.len() > 100_000 {
            let start: String = said.chars().take(600).collect();
            wrong.push(format!(
                "{} with {models:?}: status {status:?}, {time:?}, {} bytes: {start}",
                mutant.label,
                said.len()
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(
        well > count / 10,
        "only {well} of {count} are well, so that little is shown"
    );
}

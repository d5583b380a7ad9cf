//! Broken study files: read or refused, and never a panic.

use std::fs;
use std::path::Path;

use desim::scenario::load_study;

use super::mutations;
use crate::shipped;

const MUTANTS: u32 = 200;

#[test]
fn each_of_200_broken_study_files_is_read_or_refused_and_the_command_ends_in_exit_status_0_or_2() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Where their bases are, as seen from the file.
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let studies = folder.path().join("studies");
    for place in [".", "radio", "studies/bases"] {
        fs::create_dir_all(folder.path().join(place)).expect("the folder can be written to");
        for file in fs::read_dir(scenarios.join(place)).expect("the folder can be read") {
            let file = file.expect("the folder can be read");
            if file.path().extension().is_some_and(|ending| ending == "ron") {
                let copy = folder.path().join(place).join(file.file_name());
                fs::copy(file.path(), copy).expect("shipped files can be copied");
            }
        }
    }
    let file = studies.join("mutant.ron");
    let mut refused = 0;
    for (number, mutant) in mutations::mutants_of(shipped::studies(), MUTANTS).iter().enumerate() {
        fs::write(&file, &mutant.text).expect("the folder can be written to");
        // A mutant need not be a study any more; asked to be one, it must be refused as one.
        let read = load_study(&file);
        if let Err(report) = &read {
            refused += 1;
            assert!(
                !report.diagnostics.is_empty() && !report.to_string().is_empty(),
                "{}",
                mutant.label
            );
        }
        if let Some((name, line)) = &mutant.misspelt {
            let report = read.as_ref().expect_err("no field has this name");
            let named = report.diagnostics.iter().any(|found| {
                found.place.as_ref().is_some_and(|place| place.line == *line) && found.message.contains(name.as_str())
            });
            assert!(named, "{}: {report}", mutant.label);
        }
        if cfg!(feature = "command") && number % 8 == 0 {
            let mut command = assert_cmd::Command::cargo_bin("desim").expect("the command is built with the tests");
            let output = command
                .arg("check")
                .arg(&file)
                .output()
                .expect("the command starts and ends");
            assert!(
                matches!(output.status.code(), Some(0 | 2)),
                "{}: {output:?}",
                mutant.label
            );
        }
    }
    assert!(refused > MUTANTS / 3, "only {refused} of {MUTANTS} mutants are wrong");
}

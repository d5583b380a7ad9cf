//! Results read back: the same records, or a clear word about what is wrong with the folder.

use std::fs;
use std::path::{Path, PathBuf};

use desim::export::{Results, ResultsError, sealed};
use desim::metrics::detection::Suspicion;
use desim::metrics::{Summary, TrialRecord};
use desim::scenario::Scenario;
use desim::spool::Spool;
use tempfile::{TempDir, tempdir};
use tokio_util::sync::CancellationToken;

use super::fixture::{record, records_of, run, scenario};

/// Finished results of `trials` made-up trials of `scenario`.
fn write(dir: &Path, scenario: &Scenario) {
    let made_up = |trial| {
        Ok(TrialRecord {
            seed: scenario.seed,
            ..record(trial)
        })
    };
    run(dir, scenario, 2, &CancellationToken::new(), made_up).unwrap();
}

/// What no table holds.
fn as_kept(mut record: TrialRecord) -> TrialRecord {
    record.trajectories = Spool::default();
    let suspicions = record.detection.suspicions.iter();
    record.detection.suspicions = suspicions.map(|one| Suspicion { sequence: 0, ..one }).collect();
    record
}

#[test]
fn records_come_back_from_their_tables_as_they_were_written() {
    let dir = tempdir().unwrap();
    write(dir.path(), &scenario(7));
    let results = Results::open(dir.path()).unwrap();
    let expected: Vec<_> = (0..7).map(|trial| as_kept(record(trial))).collect();
    // Twice: they are read anew each time.
    for read in [records_of(&results), records_of(&results)] {
        for (read, written) in read.iter().zip(&expected) {
            assert_eq!(read, written);
        }
        assert_eq!(read.len(), 7);
    }
    assert_eq!(results.scenario, scenario(7));
}

#[test]
fn the_figures_follow_from_the_tables() {
    let dir = tempdir().unwrap();
    write(dir.path(), &scenario(7));
    let results = Results::open(dir.path()).unwrap();
    let records = records_of(&results);
    let Results { names, summary, .. } = results;
    let as_text = |names: &[String]| names.iter().map(|name| name.as_str().to_owned()).collect::<Vec<_>>();
    let (topics, roles) = (as_text(&names.topics), as_text(&names.roles));
    let [topics, roles] = [&topics, &roles].map(|names| names.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(Summary::of("made-up", &topics, &roles, &records), summary);
}

/// A folder that something is done to, and what desim says of it, without the path of this machine.
fn complaint(damage: impl Fn(&Path)) -> String {
    let place = tempdir().unwrap();
    let dir = place.path().join("results");
    write(&dir, &scenario(2));
    damage(&dir);
    let error = Results::open(&dir).unwrap_err().to_string();
    error.replace(&place.path().display().to_string(), "…")
}

/// A change to a manifest, and the hash that desim would have given it: what is wrong then is no accident.
fn forge(file: &Path, change: impl Fn(String) -> String) {
    let text = fs::read_to_string(file).unwrap();
    let mut manifest: serde_json::Value = serde_json::from_str(&change(text)).unwrap();
    manifest.as_object_mut().unwrap().shift_remove("xxh3_128");
    fs::write(file, sealed(&manifest)).unwrap();
}

fn edit(file: &Path, change: impl Fn(String) -> String) {
    let text = fs::read_to_string(file).unwrap();
    fs::write(file, change(text)).unwrap();
}

#[test]
fn a_damaged_folder_is_refused_by_the_file_that_is_wrong() {
    let table = "bandwidth.parquet";
    let truncate = |dir: &Path| {
        let bytes = fs::read(dir.join(table)).unwrap();
        fs::write(dir.join(table), &bytes[..1000]).unwrap();
    };
    let alter = |dir: &Path| {
        let mut bytes = fs::read(dir.join(table)).unwrap();
        bytes[100] ^= 1;
        fs::write(dir.join(table), bytes).unwrap();
    };
    let said = [
        ("missing", complaint(|dir| fs::remove_file(dir.join(table)).unwrap())),
        ("truncated", complaint(truncate)),
        ("one bit flipped", complaint(alter)),
        (
            "longer",
            complaint(|dir| edit(&dir.join("summary.json"), |text| text + " ")),
        ),
        (
            "foreign table",
            complaint(|dir| fs::write(dir.join("old.parquet"), "").unwrap()),
        ),
        (
            "manifest damaged",
            complaint(|dir| {
                edit(&dir.join("manifest.json"), |text| {
                    text.replace("\"seed\": 1", "\"seed\": one")
                });
            }),
        ),
        (
            "manifest edited",
            complaint(|dir| {
                edit(&dir.join("manifest.json"), |text| {
                    text.replace("\"seed\": 1", "\"seed\": 2")
                });
            }),
        ),
        (
            "manifest of a version before",
            complaint(|dir| {
                edit(&dir.join("manifest.json"), |text| {
                    let (first, rest) = text.split_once("  \"xxh3_128\"").unwrap();
                    first.to_owned() + rest.split_once('\n').unwrap().1
                });
            }),
        ),
        (
            "manifest forgets a table",
            complaint(|dir| {
                forge(&dir.join("manifest.json"), |text| {
                    text.replace("\"faults.parquet\"", "\"gone.txt\"")
                });
            }),
        ),
        (
            "manifest leads outside",
            complaint(|dir| {
                forge(&dir.join("manifest.json"), |text| {
                    text.replace("\"final_0.svg\"", "\"../outside.svg\"")
                });
            }),
        ),
        (
            "unfinished",
            complaint(|dir| {
                forge(&dir.join("manifest.json"), |text| {
                    text.replace("\"finished\": true", "\"finished\": false")
                });
            }),
        ),
        (
            "scenario of another version",
            complaint(|dir| {
                forge(&dir.join("manifest.json"), |text| {
                    text.replace("\"time_limit\"", "\"limit_of_time\"")
                });
            }),
        ),
        ("no folder", complaint(|dir| fs::remove_dir_all(dir).unwrap())),
        (
            "other files only",
            complaint(|dir| fs::remove_file(dir.join("manifest.json")).unwrap()),
        ),
    ];
    insta::assert_snapshot!(list(&said));
}

#[test]
fn what_can_be_no_file_of_results_is_refused_before_it_is_read() {
    let table = "bandwidth.parquet";
    let said = [
        (
            "a folder for a table",
            complaint(|dir| {
                fs::remove_file(dir.join(table)).unwrap();
                fs::create_dir(dir.join(table)).unwrap();
            }),
        ),
        (
            "a device for a table",
            complaint(|dir| {
                fs::remove_file(dir.join(table)).unwrap();
                std::os::unix::fs::symlink("/dev/zero", dir.join(table)).unwrap();
            }),
        ),
        (
            "a link to itself for a table",
            complaint(|dir| {
                fs::remove_file(dir.join(table)).unwrap();
                std::os::unix::fs::symlink(table, dir.join(table)).unwrap();
            }),
        ),
        (
            "a table of a terabyte",
            complaint(|dir| {
                let file = fs::File::options().write(true).open(dir.join(table)).unwrap();
                file.set_len(1 << 40).unwrap();
            }),
        ),
        (
            "a manifest of a terabyte",
            complaint(|dir| {
                let manifest = fs::File::options().write(true).open(dir.join("manifest.json")).unwrap();
                manifest.set_len(1 << 40).unwrap();
            }),
        ),
    ];
    insta::assert_snapshot!(list(&said));
}

fn list(said: &[(&str, String)]) -> String {
    let lines = said
        .iter()
        .map(|(what, words)| format!("{what}\n  {}\n", without_lengths(words)));
    lines.collect::<Vec<_>>().join("\n")
}

/// `words` with N for every number of bytes above the one that the test itself chose: lengths of files change with every figure.
fn without_lengths(words: &str) -> String {
    let is_length = |number: &str| number.parse::<u64>().is_ok_and(|length| length > 1000);
    let parts = words.split_inclusive(|letter: char| !letter.is_ascii_digit());
    let masked = parts.map(|part| {
        let digits = part.trim_end_matches(|letter: char| !letter.is_ascii_digit());
        if is_length(digits) {
            part.replace(digits, "N")
        } else {
            part.to_owned()
        }
    });
    masked.collect()
}

#[test]
fn a_table_of_another_shape_is_refused_by_the_column_that_is_wrong() {
    // Whole files of a version that called or typed a column otherwise: the same table under another name.
    let swapped = complaint(|dir| {
        fs::copy(dir.join("latency.parquet"), dir.join("robots.parquet")).unwrap();
        let manifest: serde_json::Value =
            serde_json::from_slice(&fs::read(dir.join("manifest.json")).unwrap()).unwrap();
        let mut changed = manifest.clone();
        changed["files"]["robots.parquet"] = manifest["files"]["latency.parquet"].clone();
        fs::write(dir.join("manifest.json"), changed.to_string()).unwrap();
        forge(&dir.join("manifest.json"), |text| text);
    });
    assert!(
        swapped.contains("robots.parquet is of another version (it has no column `role`"),
        "{swapped}"
    );
}

/// Two results beside each other, the second one of a changed scenario.
fn two(change: impl Fn(&mut Scenario)) -> (TempDir, [PathBuf; 2]) {
    let place = tempdir().unwrap();
    let dirs = ["one", "other"].map(|name| place.path().join(name));
    let mut changed = scenario(3);
    write(&dirs[0], &changed);
    change(&mut changed);
    write(&dirs[1], &changed);
    (place, dirs)
}

#[test]
fn trials_of_other_seeds_are_put_together() {
    let (_place, dirs) = two(|scenario| {
        scenario.seed = 2;
        scenario.trials = 4;
    });
    let both = Results::pooled(&dirs).unwrap();
    let records = records_of(&both);
    assert_eq!((records.len(), both.summary.trials), (7, 7));
    let seeds: Vec<_> = records.iter().map(|record| record.seed).collect();
    assert_eq!(seeds, [1, 1, 1, 2, 2, 2, 2]);
    let alone = Results::pooled(&dirs[..1]).unwrap();
    assert_eq!(alone.summary, Results::open(&dirs[0]).unwrap().summary);
}

#[test]
fn results_that_do_not_belong_together_are_refused_with_the_difference() {
    let refusal = |change: fn(&mut Scenario), version: Option<&str>| {
        let (place, dirs) = two(change);
        if let Some(version) = version {
            let own = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
            forge(&dirs[1].join("manifest.json"), |text| {
                text.replace(&own, &format!("\"version\": \"{version}\""))
            });
        }
        let error = Results::pooled(&dirs).unwrap_err();
        assert!(matches!(error, ResultsError::Apart { .. }));
        error.to_string().replace(&place.path().display().to_string(), "…")
    };
    let said = [
        refusal(|_| (), None),
        refusal(
            |scenario| {
                scenario.seed = 2;
                let mut radio = scenario.radio.disk().into_owned();
                radio.frame_header_bytes = 9;
                scenario.radio = radio.into();
                scenario.name = "other".to_owned();
            },
            None,
        ),
        refusal(|scenario| scenario.seed = 2, Some("0.0.9")),
    ];
    insta::assert_snapshot!(said.join("\n\n"));
}

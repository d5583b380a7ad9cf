//! The folder: resumed, refused, read back.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use desim::experiment::{Claim, Ending, FinishedTrial, Key, Parts, PartsError};
use desim::export::{Contents, Folder, FolderError, Manifest, Results, sealed};
use desim::scenario::Scenario;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

use super::fixture::{GivenUp, record, run, scenario};

const TRIALS: u32 = 7;

/// Every file of a folder but the manifest, which says what the run took.
fn results(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(dir).unwrap().map(Result::unwrap);
    let files = entries.map(|entry| (entry.file_name().into_string().unwrap(), entry.path()));
    files
        .filter(|(name, _)| name != "manifest.json")
        .map(|(name, path)| (name, fs::read(path).unwrap()))
        .collect()
}

fn uninterrupted(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let stop = CancellationToken::new();
    assert_eq!(
        run(dir, &scenario(TRIALS), 1, &stop, |trial| Ok(record(trial))).unwrap(),
        Ending::Finished
    );
    results(dir)
}

/// Runs until trial 3, which is cancelled.
fn interrupted(dir: &Path) {
    let stop = CancellationToken::new();
    let ending = run(dir, &scenario(TRIALS), 1, &stop, |trial| {
        if trial < 3 {
            return Ok(record(trial));
        }
        stop.cancel();
        Err(GivenUp)
    });
    assert_eq!(ending.unwrap(), Ending::Interrupted);
}

#[test]
fn an_interrupted_experiment_goes_on_and_ends_with_the_same_bytes() {
    let dir = tempdir().unwrap();
    let (whole, halves) = (dir.path().join("whole"), dir.path().join("halves"));
    let expected = uninterrupted(&whole);
    interrupted(&halves);
    assert!(!halves.join("summary.json").exists());

    let ran = AtomicU32::new(0);
    let ending = run(&halves, &scenario(TRIALS), 3, &CancellationToken::new(), |trial| {
        ran.fetch_add(1, Ordering::Relaxed);
        Ok(record(trial))
    });
    assert_eq!((ending.unwrap(), ran.into_inner()), (Ending::Finished, TRIALS - 3));
    let resumed = results(&halves);
    assert_eq!(resumed.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    for (name, bytes) in expected {
        assert!(resumed[&name] == bytes, "{name} differs");
    }
}

#[test]
fn finished_trials_are_gone_once_the_tables_hold_them() {
    let dir = tempdir().unwrap();
    let files = uninterrupted(dir.path());
    let names: Vec<_> = files.keys().map(String::as_str).collect();
    let expected = [
        "bandwidth.parquet",
        "connectivity.parquet",
        "degree.parquet",
        "delays.parquet",
        "delivery.parquet",
        "detection.parquet",
        "distance.parquet",
        "faults.parquet",
        "final_0.svg",
        "frames.parquet",
        "healing.parquet",
        "hops.parquet",
        "latency.parquet",
        "links.parquet",
        "notes.parquet",
        "pairs.parquet",
        "radio.parquet",
        "robots.parquet",
        "roles.parquet",
        "series.parquet",
        "spread.parquet",
        "summary.json",
        "traffic.parquet",
        "trajectories.parquet",
        "trajectories_0.svg",
        "trials.parquet",
        "waits.parquet",
    ];
    assert_eq!(names, expected);
}

/// The first made-up trial notes nothing, the second does.
#[test]
fn a_table_of_notes_is_there_only_where_robots_note_something_and_goes_with_the_rest() {
    let dir = tempdir().unwrap();
    let notes = dir.path().join("notes.parquet");
    let stop = CancellationToken::new();
    for (trials, there) in [(2, true), (1, false)] {
        let folder = Folder::new(dir.path().to_owned());
        folder.clear().unwrap();
        assert!(!notes.exists(), "it is desim's own, and goes with the rest");
        run(dir.path(), &scenario(trials), 1, &stop, |trial| Ok(record(trial))).unwrap();
        assert_eq!(notes.exists(), there);
        assert_eq!(Results::open(dir.path()).unwrap().records().count() as u32, trials);
    }
}

#[test]
fn a_trial_whose_file_is_damaged_runs_again() {
    let dir = tempdir().unwrap();
    interrupted(dir.path());
    fs::write(dir.path().join(".trials/000001.trial"), "{\"wall_s\":").unwrap();
    let parts = Folder::new(dir.path().to_owned()).parts(&Manifest::new(&scenario(TRIALS)));
    assert_eq!(parts.missing(0..4), [1, 3]);
    assert!(matches!(parts.load(1), Err(PartsError::Damaged { .. })));
    let other = Scenario {
        seed: 99,
        ..scenario(TRIALS)
    };
    let other = Folder::new(dir.path().to_owned()).parts(&Manifest::new(&other));
    assert_eq!(other.missing(0..2), [0, 1], "trials of another seed are other trials");
}

#[test]
fn a_kept_trial_comes_back_bit_for_bit() {
    let dir = tempdir().unwrap();
    let parts = Parts::at(dir.path().to_owned(), Key(1 << 127 | 5));
    let mut record = record(2);
    record.seed = u64::MAX;
    for (place, lambda2) in [0.1 + 0.2, f64::MIN_POSITIVE / 8.0, f64::MIN_POSITIVE.next_down()]
        .into_iter()
        .enumerate()
    {
        record.connectivity.change(place, |sample| sample.lambda2 = lambda2);
    }
    record.trajectories.change(0, |(_, places)| {
        places[0] = [f32::MIN_POSITIVE / 8.0, 16_777_217.0_f32.sqrt()];
    });
    record.robots[0].pose.heading = -0.0;
    record.detection.monitored_s = 1e17 / 3.0;
    let mut part = FinishedTrial {
        wall_s: 1.0 / 3.0,
        record,
    };
    parts.save(&mut part).unwrap();
    let read = parts.load(2).unwrap();
    assert_eq!(read, part);
    assert!(read.record.robots[0].pose.heading.is_sign_negative());
}

#[test]
fn two_processes_never_run_the_same_experiment() {
    let dir = tempdir().unwrap();
    let first = Claim::lay(dir.path()).unwrap();
    assert!(matches!(Claim::lay(dir.path()), Err(PartsError::Busy(_))));
    drop(first);
    assert!(Claim::lay(dir.path()).is_ok());
}

#[test]
fn a_folder_says_what_is_in_it() {
    let dir = tempdir().unwrap();
    let contents = |path: &Path| Folder::new(path.to_owned()).contents();
    assert!(matches!(contents(&dir.path().join("none")), Ok(Contents::Nothing)));
    assert!(matches!(contents(dir.path()), Ok(Contents::Nothing)));

    let file = dir.path().join("file");
    fs::write(&file, "").unwrap();
    assert!(matches!(contents(&file), Err(FolderError::NotAFolder(_))));
    assert!(matches!(contents(dir.path()), Err(FolderError::Foreign { found, .. }) if found == "file"));

    fs::write(dir.path().join("manifest.json"), "{\"version\": ").unwrap();
    assert!(matches!(contents(dir.path()), Err(FolderError::Altered { .. })));

    interrupted(&dir.path().join("results"));
    let Ok(Contents::Results(manifest)) = contents(&dir.path().join("results")) else {
        panic!("there are results")
    };
    assert!(!manifest.finished && manifest.differences(&Manifest::new(&scenario(TRIALS))).is_empty());
}

#[test]
fn clearing_deletes_what_desim_wrote_and_nothing_else() {
    let dir = tempdir().unwrap();
    uninterrupted(dir.path());
    fs::write(dir.path().join("notes.txt"), "mine").unwrap();
    let folder = Folder::new(dir.path().to_owned());
    let Ok(Contents::Results(mut manifest)) = folder.contents() else {
        panic!("there are results")
    };
    let entry = manifest.files["summary.json"].clone();
    manifest.files.insert("../outside".to_owned(), entry);
    fs::write(dir.path().join("manifest.json"), sealed(&manifest)).unwrap();
    folder.clear().unwrap();
    assert_eq!(results(dir.path()).into_keys().collect::<Vec<_>>(), ["notes.txt"]);
    assert!(!dir.path().join("manifest.json").exists());
}

#[test]
fn the_manifest_knows_length_and_hash_of_every_other_file() {
    let dir = tempdir().unwrap();
    let files = uninterrupted(dir.path());
    let Ok(Contents::Results(manifest)) = Folder::new(dir.path().to_owned()).contents() else {
        panic!()
    };
    assert_eq!(
        manifest.files.keys().collect::<Vec<_>>(),
        files.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in files {
        assert_eq!(manifest.files[&name].bytes, bytes.len() as u64);
        let hash = xxhash_rust::xxh3::xxh3_128(&bytes);
        assert_eq!(manifest.files[&name].xxh3_128, format!("{hash:032x}"));
    }
    assert_eq!(manifest.trials.len(), TRIALS as usize);
}

fn rows(dir: &Path, table: &str) -> Vec<Row> {
    let file = fs::File::open(dir.join(table)).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    reader.get_row_iter(None).unwrap().map(Result::unwrap).collect()
}

fn column(row: &Row, name: &str) -> Field {
    row.get_column_iter()
        .find(|(column, _)| *column == name)
        .map(|(_, field)| field.clone())
        .unwrap()
}

#[test]
fn tables_read_back_as_they_were_recorded() {
    let dir = tempdir().unwrap();
    uninterrupted(dir.path());

    let trials = rows(dir.path(), "trials.parquet");
    let steps: Vec<_> = trials.iter().map(|row| column(row, "steps_to_completion")).collect();
    assert_eq!(
        (&steps[3], &steps[4]),
        (&Field::Long(121), &Field::Null),
        "trial 4 is censored"
    );
    assert_eq!(column(&trials[0], "digest"), Field::Str("f".repeat(32)));

    let robots = rows(dir.path(), "robots.parquet");
    let parents = |row: &Row| column(row, "parents").to_string();
    assert_eq!(
        (parents(&robots[0]), parents(&robots[5])),
        ("[]".to_owned(), "[3, 0]".to_owned())
    );
    assert_eq!(column(&robots[0], "target"), Field::Null);
    let Field::Double(y) = column(&robots[8], "y_m") else {
        panic!("y_m is a double")
    };
    assert_eq!(y.to_bits(), record(0).robots[8].pose.position.y.to_bits());

    let (bandwidth, expected) = (rows(dir.path(), "bandwidth.parquet"), record(0).traffic);
    let first_lost = bandwidth
        .iter()
        .find(|row| column(row, "direction") == Field::Str("lost_channel".into()));
    assert_eq!(
        column(first_lost.unwrap(), "frames"),
        Field::Long(expected[2].lost[0].frames.cast_signed())
    );
    assert_eq!(rows(dir.path(), "frames.parquet").len(), 4 * TRIALS as usize);
    assert_eq!(
        column(&rows(dir.path(), "connectivity.parquet")[3], "links_1"),
        Field::Int(0)
    );
    let faults = rows(dir.path(), "faults.parquet");
    let fault = |row: usize| ["kind", "robot", "role", "until_s"].map(|name| column(&faults[row], name));
    let text = |text: &str| Field::Str(text.to_owned());
    assert_eq!(
        fault(0),
        [text("silence"), Field::Int(3), text("networker"), Field::Double(50.0)]
    );
    assert_eq!(
        fault(1),
        [text("partition"), Field::Null, Field::Null, Field::Double(50.0)]
    );
    let healing = rows(dir.path(), "healing.parquet");
    let wound = |row: usize| ["healed_s", "watched_s", "request_frames"].map(|name| column(&healing[row], name));
    assert_eq!(
        wound(2),
        [Field::Null, Field::Double(40.0), Field::Long(2)],
        "never mended in trial 2"
    );
    assert_eq!(
        wound(3),
        [Field::Double(21.5), Field::Double(0.0), Field::Long(2)],
        "harmless"
    );
    assert_eq!(rows(dir.path(), "trajectories.parquet").len(), 9 * 12 * TRIALS as usize);
}

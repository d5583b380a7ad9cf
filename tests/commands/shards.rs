//! Shards: run anywhere, killed, run twice, harmed, and put together to the bytes of one machine, or refused with what is wrong.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use desim::experiment::Parts;
use desim::export::{Contents, Folder};
use tempfile::{TempDir, tempdir};

use crate::harm::{Chance, assert_same, desim, kill, timed, tree, tries};

const TRIALS: u32 = 9;

const BASE: &str = "// Who is suspected?\nScenario(name: \"base\", trials: 9, time_limit: 20.0, arena: (size: (4.0, 4.0)), control: (period: 0.5), \
    swarm: (robots: 10, deploy: Uniform), protocol: Heartbeat, gossip: (status: (interval: 0.5)), \
    detector: Timeout(1.2), radio: (loss: Bernoulli(0.2)))";

const STUDY: &str = "// Does loss hurt?\nStudy(name: \"losses\", base: \"base.ron\", trials: 9, factors: [(name: \"loss\", \
    paths: [\"radio.loss\"], levels: [(label: \"some\", values: [Bernoulli(0.2)]), (label: \"much\", values: [Bernoulli(0.4)])])], \
    reference: [\"some\"], figure: \"detection.mistake_rate_hz\", also: [\"detection.query_accuracy\"], \
    pareto: (\"detection.mistake_rate_hz\", \"detection.query_accuracy\"))";

const SCENARIO_RUN: [&str; 3] = ["scenario", "base.ron", "--quiet"];
const STUDY_RUN: [&str; 3] = ["compare", "study.ron", "--quiet"];

fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("base.ron"), BASE).unwrap();
    fs::write(dir.path().join("study.ron"), STUDY).unwrap();
    dir
}

fn run(dir: &Path, arguments: &[&str]) -> Output {
    desim(dir, arguments).output().unwrap()
}

fn done(dir: &Path, arguments: &[&str]) -> Output {
    let output = run(dir, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", said(&output));
    output
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs it, and answers what it says when it refuses for the user's sake.
fn refused(dir: &Path, arguments: &[&str]) -> String {
    let output = run(dir, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
    assert!(output.stdout.is_empty());
    said(&output)
}

fn shard(dir: &Path, command: &[&str], number: u32, of: u32, out: &str) {
    let shard = format!("{number}/{of}");
    done(dir, &[command, &["--shard", &shard, "--out", out]].concat());
}

/// The files of finished trials below `dir`, each with the folder and the number that it is of: `("s1/.trials", 4)`.
fn trials(dir: &Path) -> Vec<(PathBuf, u32)> {
    let of = |path: &PathBuf| {
        let number = path.file_name()?.to_str()?.strip_suffix(".trial")?.parse().ok()?;
        Some((path.parent()?.to_owned(), number))
    };
    crate::harm::files(dir).iter().filter_map(of).collect()
}

fn file(folder: &Path, trial: u32) -> PathBuf {
    folder.join(format!("{trial:06}.trial"))
}

/// A split of an experiment by chance: into up to five shards, each in a folder of its own or in one that they share, some of them run twice. The
/// folders.
fn split(dir: &Path, command: &[&str], chance: &mut Chance) -> Vec<String> {
    let of = 1 + chance.below(5) as u32;
    let mut folders = BTreeSet::new();
    for number in 1..=of {
        for _ in 0..=chance.below(3) / 2 {
            let folder = format!("s{}", chance.below(3));
            shard(dir, command, number, of, &folder);
            folders.insert(folder);
        }
    }
    folders.into_iter().collect()
}

/// Harms what a split has left, and answers what is said of the trials that no folder has whole any more, by their folders' settings.
fn harm(dir: &Path, folders: &[String], chance: &mut Chance) -> BTreeMap<String, BTreeSet<u32>> {
    for _ in 0..chance.below(4) {
        let all: Vec<(PathBuf, u32)> = folders.iter().flat_map(|folder| trials(&dir.join(folder))).collect();
        if all.is_empty() {
            break;
        }
        let (folder, trial) = &all[usize::try_from(chance.below(all.len() as u64)).unwrap()];
        let path = file(folder, *trial);
        match chance.below(5) {
            0 => fs::remove_file(&path).unwrap(),
            1 => {
                let mut bytes = fs::read(&path).unwrap();
                let at = usize::try_from(chance.below(bytes.len() as u64)).unwrap();
                bytes[at] ^= 1 << chance.below(8);
                fs::write(&path, bytes).unwrap();
            }
            2 => fs::write(&path, &fs::read(&path).unwrap()[..100]).unwrap(),
            // A trial of another number, or of another scenario, under this one's name.
            3 => drop(fs::copy(file(folder, (trial + 1) % TRIALS), &path)),
            _ => drop(fs::copy(file(&dir.join("foreign/.trials"), *trial), &path).unwrap()),
        }
    }
    let mut missing = BTreeMap::new();
    let settings: BTreeSet<PathBuf> = folders
        .iter()
        .flat_map(|folder| crate::harm::files(&dir.join(folder)))
        .filter(|path| path.ends_with("manifest.json"))
        .map(|path| path.strip_prefix(dir).unwrap().iter().skip(1).collect::<PathBuf>())
        .map(|path| path.parent().unwrap().to_owned())
        .collect();
    for setting in settings {
        let whole = |trial: u32| {
            folders.iter().any(|folder| {
                let folder = Folder::new(dir.join(folder).join(&setting));
                let Ok(Contents::Results(manifest)) = folder.contents() else {
                    return false;
                };
                folder.parts(&manifest).load(trial).is_ok()
            })
        };
        let lacking: BTreeSet<u32> = (0..TRIALS).filter(|trial| !whole(*trial)).collect();
        if !lacking.is_empty() {
            missing.insert(setting.display().to_string(), lacking);
        }
    }
    missing
}

/// Splits by chance, harms, merges: the bytes of one machine, or exactly the trials that are missing, and nothing written.
fn splits(command: &[&str], seed: u64, rounds: usize) {
    let dir = place();
    done(dir.path(), &[command, &["--out", "whole"]].concat());
    let expected = tree(&dir.path().join("whole"));
    done(
        dir.path(),
        &[
            "scenario", "base.ron", "--quiet", "--seed", "5", "--shard", "1/1", "--out", "foreign",
        ],
    );
    let mut chance = Chance(seed);
    let (mut whole, mut lacking) = (0, 0);
    for round in 0..rounds {
        let folders = split(dir.path(), command, &mut chance);
        let missing = harm(dir.path(), &folders, &mut chance);
        let before: Vec<_> = folders.iter().map(|folder| tree(&dir.path().join(folder))).collect();
        let names: Vec<&str> = folders.iter().map(String::as_str).collect();
        let merge = [&["merge"][..], &names, &["--out", "merged", "--quiet"]].concat();
        if missing.is_empty() {
            whole += 1;
            done(dir.path(), &merge);
            assert_same(&expected, &tree(&dir.path().join("merged")), &format!("round {round}"));
            done(dir.path(), &merge);
            assert_same(
                &expected,
                &tree(&dir.path().join("merged")),
                &format!("round {round}, again"),
            );
        } else {
            lacking += 1;
            let words = refused(dir.path(), &merge);
            for trials in missing.values() {
                let count = format!("{} of {TRIALS} trials", trials.len());
                assert!(words.contains(&count), "round {round}: {words} has no {count}");
                let first = trials.first().unwrap().to_string();
                assert!(
                    words.contains(&format!("are missing: {first}")),
                    "round {round}: {words}"
                );
            }
            assert!(!dir.path().join("merged").exists());
        }
        for (folder, before) in folders.iter().zip(before) {
            assert_same(&before, &tree(&dir.path().join(folder)), "a merge changes no shard");
            fs::remove_dir_all(dir.path().join(folder)).unwrap();
        }
        let _ = fs::remove_dir_all(dir.path().join("merged"));
    }
    println!("{whole} splits put together, {lacking} refused");
    assert!(whole > 1 && lacking > 1);
}

#[test]
fn random_splits_of_a_scenario_give_its_bytes_or_what_is_missing() {
    splits(&SCENARIO_RUN, 14, tries(20));
}

#[test]
fn random_splits_of_a_study_give_its_bytes_or_what_is_missing() {
    splits(&STUDY_RUN, 41, tries(20));
}

#[test]
fn the_part_of_the_array_that_is_missing_is_named_and_running_it_is_enough() {
    let dir = place();
    done(dir.path(), &[&SCENARIO_RUN[..], &["--out", "whole"]].concat());
    for number in [1, 3] {
        shard(dir.path(), &SCENARIO_RUN, number, 4, "shared");
    }
    let words = refused(dir.path(), &["merge", "shared"]);
    assert!(words.contains("4 of 9 trials are missing: 1,3,5,7"), "{words}");
    assert!(words.contains("--array=2,4 with --shard auto/4"), "{words}");
    for task in ["2", "4"] {
        let auto = [&SCENARIO_RUN[..], &["--shard", "auto/4", "--out", "shared"]].concat();
        let output = desim(dir.path(), &auto)
            .env("SLURM_ARRAY_TASK_ID", task)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", said(&output));
    }
    // One folder is where its results go.
    done(dir.path(), &["merge", "shared"]);
    let expected = tree(&dir.path().join("whole"));
    assert_same(&expected, &tree(&dir.path().join("shared")), "in one folder");
    // Shards that come late find the results.
    shard(dir.path(), &SCENARIO_RUN, 2, 4, "shared");
    done(dir.path(), &["merge", "shared"]);
    assert_same(&expected, &tree(&dir.path().join("shared")), "once more");
}

#[test]
fn a_run_without_shards_goes_on_from_theirs() {
    let dir = place();
    for (command, name) in [(&SCENARIO_RUN, "base"), (&STUDY_RUN, "losses")] {
        done(dir.path(), &[&command[..], &["--out", "whole"]].concat());
        shard(dir.path(), command, 2, 3, name);
        done(dir.path(), &[&command[..], &["--out", name]].concat());
        let [whole, resumed] = ["whole", name].map(|folder| tree(&dir.path().join(folder)));
        assert_same(&whole, &resumed, name);
        fs::remove_dir_all(dir.path().join("whole")).unwrap();
    }
}

#[test]
fn shards_of_other_experiments_are_refused_with_the_difference() {
    let dir = place();
    shard(dir.path(), &SCENARIO_RUN, 1, 2, "own");
    shard(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--seed", "5"]].concat(),
        2,
        2,
        "seed",
    );
    shard(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--set", "radio.range=2.5"]].concat(),
        2,
        2,
        "range",
    );
    shard(dir.path(), &STUDY_RUN, 2, 2, "study");
    shard(
        dir.path(),
        &[&STUDY_RUN[..], &["--figure", "delivery_ratio"]].concat(),
        2,
        2,
        "figure",
    );
    fs::create_dir(dir.path().join("empty")).unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["own", "seed"], "seed: 1 and 5"),
        (&["own", "range"], "radio.range: 2.0 and 2.5"),
        (&["own", "study"], "one scenario and a study"),
        (&["study", "figure"], "figures: "),
        (&["empty"], "empty holds no trials of desim"),
        (&["nowhere"], "nowhere holds no trials of desim"),
    ];
    for (folders, difference) in cases {
        for command in ["merge", "status"] {
            let out: &[&str] = if command == "merge" { &["--out", "merged"] } else { &[] };
            let words = refused(dir.path(), &[&[command][..], folders, out].concat());
            assert!(words.contains(difference), "{command} {folders:?}: {words}");
        }
        assert!(!dir.path().join("merged").exists());
    }
    // A shard that was killed at once has left nothing, and its trials are missing.
    let words = refused(dir.path(), &["merge", "empty", "own", "--out", "merged"]);
    assert!(words.contains("4 of 9 trials are missing: 1,3,5,7"), "{words}");
    let words = refused(dir.path(), &["merge", "own", "seed"]);
    assert!(words.contains("--out"), "{words}");
    let words = refused(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--shard", "1/2", "--out", "seed"]].concat(),
    );
    assert!(words.contains("seed: 5 there, 1 now"), "{words}");
    assert_eq!(trials(&dir.path().join("seed")).len(), 4, "nothing of it is lost");
}

#[test]
fn a_trial_that_two_folders_have_and_that_differs_is_no_result() {
    let dir = place();
    for folder in ["one", "other"] {
        shard(dir.path(), &SCENARIO_RUN, 1, 1, folder);
    }
    let folder = Folder::new(dir.path().join("other"));
    let Ok(Contents::Results(manifest)) = folder.contents() else {
        panic!("there are trials")
    };
    let parts = folder.parts(&manifest);
    let mut part = parts.load(4).unwrap();
    part.wall_s += 1.0;
    parts.save(&mut part).unwrap();
    let merge = ["merge", "one", "other", "--out", "merged", "--quiet"];
    done(dir.path(), &merge);
    fs::remove_dir_all(dir.path().join("merged")).unwrap();
    part.record.events += 1;
    parts.save(&mut part).unwrap();
    let output = run(dir.path(), &merge);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("trial 4 in "), "{}", said(&output));
    assert!(!dir.path().join("merged").exists());
}

/// Two that begin at once in an empty folder may each think it theirs.
#[test]
fn trials_of_another_scenario_in_the_folder_are_none_of_these() {
    let dir = place();
    shard(dir.path(), &SCENARIO_RUN, 1, 1, "own");
    shard(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--set", "radio.range=2.5"]].concat(),
        1,
        1,
        "other",
    );
    for trial in [2, 3] {
        let [own, other] = ["own", "other"].map(|folder| file(&dir.path().join(folder).join(".trials"), trial));
        fs::copy(other, own).unwrap();
    }
    let words = refused(dir.path(), &["merge", "own"]);
    assert!(words.contains("2 of 9 trials are missing: 2-3"), "{words}");
    assert!(words.contains("it is of another scenario"), "{words}");
    shard(dir.path(), &SCENARIO_RUN, 1, 1, "own");
    done(dir.path(), &[&SCENARIO_RUN[..], &["--out", "whole"]].concat());
    done(dir.path(), &["merge", "own", "--quiet"]);
    let [whole, own] = ["whole", "own"].map(|folder| tree(&dir.path().join(folder)));
    assert_same(&whole, &own, "run again");
}

#[test]
fn a_study_until_a_width_is_judged_by_the_merge() {
    let dir = place();
    let until = ["--until-width", "0.004", "--most-trials", "400"];
    let asked = |trials: &str, out: &str, shard: &[&str]| {
        let command = [&STUDY_RUN[..], &until, &["--trials", trials, "--out", out], shard].concat();
        done(dir.path(), &command);
    };
    for number in ["1/3", "2/3", "3/3"] {
        asked("9", "shards", &["--shard", number]);
    }
    let words = refused(dir.path(), &["merge", "shards", "--out", "merged"]);
    assert!(
        words.contains("is to be 0.004 wide") && words.contains("with 9 trials"),
        "{words}"
    );
    assert!(!dir.path().join("merged").exists());
    let (_, enough) = words.split_once("--trials ").expect("how many more");
    let enough = enough.split(';').next().unwrap().to_owned();
    assert!(enough.parse::<u32>().unwrap() > 9, "{words}");
    // It is an estimate: one step more may be needed.
    let enough = (enough.parse::<u32>().unwrap() * 3 / 2).to_string();
    for number in ["1/3", "2/3", "3/3"] {
        asked(&enough, "shards", &["--shard", number]);
    }
    done(dir.path(), &["merge", "shards", "--out", "merged", "--quiet"]);
    asked(&enough, "whole", &[]);
    let [whole, merged] = ["whole", "merged"].map(|folder| tree(&dir.path().join(folder)));
    assert_same(&whole, &merged, "as many as it takes");
    let manifest = String::from_utf8(merged["some/manifest.json"].clone()).unwrap();
    assert!(manifest.contains(&format!("\"trials\": {enough},")), "{manifest}");
}

#[test]
fn shards_killed_at_any_instant_go_on_to_the_same_bytes() {
    let dir = place();
    for (command, name) in [(&SCENARIO_RUN, "a scenario"), (&STUDY_RUN, "a study")] {
        let whole = timed(dir.path(), &[&command[..], &["--out", "whole", "--jobs", "1"]].concat());
        let expected = tree(&dir.path().join("whole"));
        let mut chance = Chance(9);
        for round in 0..tries(2) {
            thread::scope(|scope| {
                for number in ["1/2", "2/2"] {
                    let mut chance = Chance(chance.below(1 << 32));
                    let arguments = [&command[..], &["--shard", number, "--out", "shared", "--jobs", "1"]].concat();
                    let dir = dir.path();
                    scope.spawn(move || kill(dir, &arguments, whole / 2, &mut chance));
                }
            });
            kill(
                dir.path(),
                &["merge", "shared", "--out", "merged", "--quiet"],
                whole,
                &mut chance,
            );
            assert_same(
                &expected,
                &tree(&dir.path().join("merged")),
                &format!("{name}, round {round}"),
            );
            kill(dir.path(), &["merge", "shared", "--quiet"], whole, &mut chance);
            assert_same(
                &expected,
                &tree(&dir.path().join("shared")),
                &format!("{name}, in place, round {round}"),
            );
            for folder in ["merged", "shared"] {
                fs::remove_dir_all(dir.path().join(folder)).unwrap();
            }
        }
        fs::remove_dir_all(dir.path().join("whole")).unwrap();
    }
}

fn status(dir: &Path, folders: &[&str]) -> serde_json::Value {
    let output = done(dir, &[&["status", "--format", "json"], folders].concat());
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn how_far_shards_are_is_told_while_they_run_and_when_they_are_killed() {
    let dir = place();
    shard(dir.path(), &STUDY_RUN, 1, 3, "first");
    let arguments = [
        "compare",
        "study.ron",
        "--quiet",
        "--shard",
        "2/3",
        "--out",
        "second",
        "--jobs",
        "1",
    ];
    // Trials that outlast the test.
    let mut child = desim(
        dir.path(),
        &[
            "scenario",
            "base.ron",
            "--set",
            "time_limit=1e5",
            "--quiet",
            "--shard",
            "2/3",
            "--out",
            "slow",
            "--jobs",
            "1",
        ],
    )
    .stdout(Stdio::null())
    .spawn()
    .unwrap();
    let mut running = serde_json::Value::Null;
    for _ in 0..100 {
        thread::sleep(Duration::from_millis(100));
        if dir.path().join("slow/manifest.json").exists() {
            running = status(dir.path(), &["slow"]);
            if running["processes"][0]["under_way"][0] == "1" {
                break;
            }
        }
    }
    assert_eq!(running["processes"][0]["state"], "running", "{running}");
    assert_eq!(running["processes"][0]["shard"], "2/3");
    assert_eq!((&running["trials"], &running["done"]), (&9.into(), &0.into()));
    assert_eq!(
        (&running["unattended"], &running["unattended_shards"]),
        (&6.into(), &"1,3".into())
    );
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-s", "KILL", &id])
            .status()
            .unwrap()
            .success()
    );
    child.wait().unwrap();
    let killed = status(dir.path(), &["slow"]);
    assert_eq!(killed["processes"][0]["state"], "silent", "{killed}");
    assert_eq!(
        (&killed["unattended"], &killed["unattended_shards"]),
        (&9.into(), &"1-3".into())
    );

    done(dir.path(), &arguments);
    let both = status(dir.path(), &["first", "second"]);
    assert_eq!(
        (&both["trials"], &both["done"], &both["unattended"]),
        (&18.into(), &12.into(), &6.into())
    );
    assert_eq!(both["unattended_shards"], "3");
    assert_eq!(
        both["settings"][1],
        serde_json::json!({"name": "much", "trials": 9, "done": 6})
    );
    assert_eq!(both["processes"][1]["state"], "ended");
    let text = String::from_utf8(done(dir.path(), &["status", "first", "second"]).stdout).unwrap();
    assert!(text.contains("12 of 18 trials") && text.contains("--array=3"), "{text}");
    shard(dir.path(), &STUDY_RUN, 3, 3, "first");
    done(dir.path(), &["merge", "first", "second", "--out", "first", "--quiet"]);
    let merged = status(dir.path(), &["first"]);
    assert_eq!(
        (&merged["done"], &merged["finished"]),
        (&18.into(), &true.into()),
        "{merged}"
    );
}

#[test]
fn no_shard_deletes_anything() {
    let dir = place();
    shard(dir.path(), &SCENARIO_RUN, 1, 2, "shared");
    let words = refused(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--shard", "2/2", "--out", "shared", "--force"]].concat(),
    );
    assert!(words.contains("--force"), "{words}");
    assert_eq!(trials(&dir.path().join("shared")).len(), 5);
    // Fewer trials, or more, are the same trials.
    done(
        dir.path(),
        &[
            &SCENARIO_RUN[..],
            &["--trials", "3", "--shard", "2/2", "--out", "shared"],
        ]
        .concat(),
    );
    assert_eq!(trials(&dir.path().join("shared")).len(), 6);
    done(dir.path(), &["merge", "shared", "--out", "merged", "--quiet"]);
    done(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--trials", "3", "--out", "whole"]].concat(),
    );
    let [whole, merged] = ["whole", "merged"].map(|folder| tree(&dir.path().join(folder)));
    assert_same(&whole, &merged, "three trials");
}

#[test]
fn a_merge_over_other_results_is_refused_and_replaces_them_by_force() {
    let dir = place();
    shard(dir.path(), &SCENARIO_RUN, 1, 1, "shard");
    done(
        dir.path(),
        &[&SCENARIO_RUN[..], &["--seed", "5", "--out", "taken"]].concat(),
    );
    let merge = ["merge", "shard", "--out", "taken", "--quiet"];
    let words = refused(dir.path(), &merge);
    assert!(
        words.contains("seed: 5 there, 1 now") && words.contains("--force"),
        "{words}"
    );
    done(dir.path(), &[&merge[..], &["--force"]].concat());
    done(dir.path(), &[&SCENARIO_RUN[..], &["--out", "whole"]].concat());
    let [whole, taken] = ["whole", "taken"].map(|folder| tree(&dir.path().join(folder)));
    assert_same(&whole, &taken, "by force");
    let words = refused(dir.path(), &["merge", "taken", "--out", "elsewhere"]);
    assert!(words.contains("taken holds finished results"), "{words}");
    // By force over one of the shards themselves would lose them.
    done(dir.path(), &["merge", "shard", "--quiet", "--force"]);
    assert_same(&whole, &tree(&dir.path().join("shard")), "in place by force");
}

#[test]
fn a_file_of_a_trial_can_be_read_by_whoever_may_read_the_folder() {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let dir = place();
        shard(dir.path(), &SCENARIO_RUN, 1, 9, "shared");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let plain = mode(&dir.path().join("base.ron"));
        let trials = dir.path().join("shared/.trials");
        assert_eq!(mode(&file(&trials, 0)), plain);
        assert_eq!(mode(&dir.path().join("shared/manifest.json")), plain);
        let key = Folder::new(dir.path().join("shared"));
        let Ok(Contents::Results(manifest)) = key.contents() else {
            panic!("there are trials")
        };
        assert_eq!(Parts::at(trials, manifest.key()).there().unwrap(), [0]);
    }
}

/// `sbatch` as the script calls it: it keeps what it is given, and runs it as a task of an array would.
const SBATCH: &str = "#!/bin/sh\nprintf '%s\\n' \"$*\" >> \"$PLACE/asked\"\nprintf 'job:\\n' >> \"$PLACE/asked\"\ntee -a \"$PLACE/asked\" > \"$PLACE/job\"\n\
    case \"$*\" in *--array=*) for task in 1 2 3; do SLURM_ARRAY_TASK_ID=$task sh \"$PLACE/job\" || exit; done ;; *) sh \"$PLACE/job\" > \"$PLACE/log\" ;; esac\necho 7\n";

#[test]
#[cfg(unix)]
fn the_script_for_slurm_runs_an_array_and_merges() {
    use std::os::unix::fs::PermissionsExt;
    let dir = place();
    for (file, command, name) in [("base.ron", &SCENARIO_RUN, "one"), ("study.ron", &STUDY_RUN, "many")] {
        done(dir.path(), &["new", name, "--slurm", "3", "--run", file]);
        let sbatch = dir.path().join("bin/sbatch");
        fs::create_dir_all(dir.path().join("bin")).unwrap();
        fs::write(&sbatch, SBATCH).unwrap();
        fs::set_permissions(&sbatch, fs::Permissions::from_mode(0o755)).unwrap();
        let path = format!(
            "{}:{}",
            dir.path().join("bin").display(),
            std::env::var("PATH").unwrap()
        );
        let script = Command::new("bash")
            .arg(format!("{name}.slurm.sh"))
            .current_dir(dir.path())
            .envs([("PATH", path.as_str()), ("DESIM", env!("CARGO_BIN_EXE_desim"))])
            .env("PLACE", dir.path())
            .output()
            .unwrap();
        assert!(script.status.success(), "{}", said(&script));
        let asked = fs::read_to_string(dir.path().join("asked")).unwrap();
        assert!(
            asked.contains("--array=1-3") && asked.contains("--dependency=afterany:7"),
            "{asked}"
        );
        assert!(
            asked.contains(&format!("{} \"{file}\" --shard auto/3", command[0])),
            "{asked}"
        );
        let log = fs::read_to_string(dir.path().join("log")).unwrap();
        assert!(
            log.contains("Does loss hurt?") || log.contains("Who is suspected?"),
            "{log}"
        );
        done(dir.path(), &[&command[..], &["--out", "whole"]].concat());
        let [whole, merged] = ["whole", &format!("results/{name}")].map(|folder| tree(&dir.path().join(folder)));
        assert_same(&whole, &merged, name);
        fs::remove_dir_all(dir.path().join("whole")).unwrap();
    }
    let words = refused(dir.path(), &["new", "one", "--slurm", "3", "--run", "base.ron"]);
    assert!(words.contains("is there already"), "{words}");
    let words = refused(dir.path(), &["new", "two", "--slurm", "3"]);
    assert!(words.contains("two.ron"), "{words}");
    fs::write(dir.path().join("$HOME.ron"), BASE).unwrap();
    let words = refused(dir.path(), &["new", "two", "--slurm", "3", "--run", "$HOME.ron"]);
    assert!(words.contains("a shell would read"), "{words}");
    fs::write(dir.path().join("two.ron"), BASE.replace("trials", "trails")).unwrap();
    let words = refused(dir.path(), &["new", "two", "--slurm", "3"]);
    assert!(words.contains("trials"), "{words}");
    refused(dir.path(), &["new", "two", "--slurm", "0"]);
    assert!(!dir.path().join("two.slurm.sh").exists());
}

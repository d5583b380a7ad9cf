//! Results that were harmed are never shown as if they were whole; runs that were killed leave nothing of it behind.

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::{TempDir, tempdir};

use crate::harm::{Chance, assert_same, desim, files, flip, kill, timed, tree, tries};

const SCENARIO: &str = "// Who is missed?\nScenario(name: \"missed\", trials: 12, time_limit: 20.0, arena: (size: (3.0, 3.0)), \
    swarm: (robots: 12, deploy: Uniform), protocol: Heartbeat, control: (period: 0.5), \
    gossip: (status: (interval: 0.5)), detector: Timeout(1.2), radio: (loss: Bernoulli(0.3)), \
    faults: [Mute(robots: [1], at: 5.0, lasts: For(4.0))])";

fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("missed.ron"), SCENARIO).unwrap();
    dir
}

/// A folder with finished results, with their page of charts.
fn finished() -> TempDir {
    let dir = place();
    timed(dir.path(), &["scenario", "missed.ron", "--quiet"]);
    timed(dir.path(), &["report", "results/missed"]);
    dir
}

#[test]
fn no_bit_that_flips_changes_what_is_shown() {
    let dir = finished();
    let commands: [&[&str]; 4] = [
        &["scenario", "missed.ron"],
        &["scenario", "missed.ron", "--format", "json"],
        &["report", "results/missed", "--out", "/dev/stdout"],
        &["explain", "results/missed", "--trial", "1", "--robot", "1"],
    ];
    flip(dir.path(), &dir.path().join("results"), &commands, tries(36));
}

#[test]
fn a_run_killed_at_any_instant_goes_on_to_the_same_bytes_and_leaves_nothing_behind() {
    let dir = place();
    let run = ["scenario", "missed.ron", "--quiet", "--jobs", "2"];
    let whole = timed(dir.path(), &run);
    let expected = tree(&dir.path().join("results"));
    let mut chance = Chance(1);
    let mut kills: usize = 0;
    while kills < tries(6) {
        fs::remove_dir_all(dir.path().join("results")).unwrap();
        kills += kill(dir.path(), &run, whole, &mut chance);
        assert_same(&expected, &tree(&dir.path().join("results")), &format!("{kills} kills"));
    }
    println!("{kills} runs killed");
}

#[test]
fn a_report_killed_at_any_instant_leaves_nothing_behind() {
    let dir = finished();
    let report = ["report", "results/missed"];
    let whole = timed(dir.path(), &report);
    let expected = tree(&dir.path().join("results"));
    let mut chance = Chance(2);
    let mut kills: usize = 0;
    while kills < tries(6) {
        let page = dir.path().join("results/missed/report.html");
        kills += kill(dir.path(), &report, whole, &mut chance);
        assert!(page.exists());
        assert_same(&expected, &tree(&dir.path().join("results")), &format!("{kills} kills"));
    }
    println!("{kills} reports killed");
}

/// What a kill between the last manifest and the end leaves, and one between a page and the manifest.
#[test]
fn what_a_killed_attempt_left_beside_finished_results_goes_when_they_are_shown() {
    let dir = finished();
    let results = dir.path().join("results/missed");
    let before = tree(&results);
    fs::create_dir(results.join(".trials")).unwrap();
    for name in ["lock", "000003.trial", "report.html"] {
        fs::write(results.join(".trials").join(name), "left").unwrap();
    }
    timed(dir.path(), &["scenario", "missed.ron"]);
    assert_same(&before, &tree(&results), "after the results were shown");
    assert!(!results.join(".trials").exists());
}

#[test]
fn a_kept_trial_that_has_changed_runs_again() {
    let dir = place();
    let interrupted = [
        "scenario",
        "missed.ron",
        "--quiet",
        "--jobs",
        "1",
        "--set",
        "time_limit=2000.0",
        "--out",
        "long",
    ];
    let mut child = desim(dir.path(), &interrupted).spawn().unwrap();
    let kept = dir.path().join("long/.trials/000000.trial");
    while !kept.exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    // A digit is another: the file still reads as a trial.
    let mut bytes = fs::read(&kept).unwrap();
    let key = b"\"events\":";
    let at = bytes.windows(key.len()).position(|there| there == key).unwrap() + key.len();
    bytes[at] = if bytes[at] == b'9' { b'8' } else { bytes[at] + 1 };
    fs::write(&kept, bytes).unwrap();
    timed(dir.path(), &interrupted);
    let events = |out: &str| fs::read(dir.path().join(out).join("trials.parquet")).unwrap();
    timed(
        dir.path(),
        &[
            "scenario",
            "missed.ron",
            "--quiet",
            "--set",
            "time_limit=2000.0",
            "--out",
            "whole",
        ],
    );
    assert!(events("long") == events("whole"));
}

#[test]
fn force_replaces_results_that_cannot_be_trusted_and_nothing_of_others() {
    let dir = finished();
    let results = dir.path().join("results/missed");
    let expected = tree(&results);
    let break_manifest = || fs::write(results.join("manifest.json"), "{\"version\": \"0.1.0\"").unwrap();
    break_manifest();
    let refused = desim(dir.path(), &["scenario", "missed.ron"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    fs::write(results.join("notes.txt"), "mine").unwrap();
    let refused = desim(dir.path(), &["scenario", "missed.ron", "--force"])
        .output()
        .unwrap();
    assert!(String::from_utf8_lossy(&refused.stderr).contains("notes.txt"));
    assert_eq!(
        (refused.status.code(), results.join("trials.parquet").exists()),
        (Some(2), true)
    );
    fs::remove_file(results.join("notes.txt")).unwrap();
    timed(dir.path(), &["scenario", "missed.ron", "--force", "--quiet"]);
    timed(dir.path(), &["report", "results/missed"]);
    assert_same(&expected, &tree(&results), "made again");
}

/// Root may write anywhere, so the command runs as nobody.
#[test]
fn a_folder_that_takes_no_files_is_reported_all_the_same() {
    let dir = finished();
    let results = dir.path().join("results/missed");
    fs::remove_file(results.join("report.html")).unwrap();
    let desim = dir.path().join("desim");
    fs::copy(env!("CARGO_BIN_EXE_desim"), &desim).unwrap();
    let all = |mode: u32| {
        use std::os::unix::fs::PermissionsExt;
        for path in [dir.path(), &dir.path().join("results"), &results] {
            fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
        }
        for file in files(&results) {
            fs::set_permissions(file, fs::Permissions::from_mode(0o444)).unwrap();
        }
    };
    all(0o555);
    let probe = results.join("probe");
    let is_root = fs::write(&probe, "").is_ok();
    let run = |arguments: &[&str]| {
        let mut command = if is_root {
            let mut command = Command::new("setpriv");
            command
                .args(["--reuid=65534", "--regid=65534", "--clear-groups"])
                .arg(&desim);
            command
        } else {
            Command::new(&desim)
        };
        command.current_dir(dir.path()).args(arguments).output().unwrap()
    };
    let _ = fs::remove_file(&probe);
    let reported = run(&["report", "results/missed"]);
    let said = String::from_utf8_lossy(&reported.stderr).into_owned();
    all(0o755);
    assert!(reported.status.success(), "{said}");
    assert!(
        said.contains("no page of charts here") && said.contains("--out FILE"),
        "{said}"
    );
    assert!(String::from_utf8_lossy(&reported.stdout).contains("Who is missed?"));
    assert!(!results.join("report.html").exists() && !results.join(".trials").exists());
}

#[test]
fn a_page_goes_where_it_is_asked_for_whole_or_not_at_all() {
    let dir = finished();
    let at = |name: &str| dir.path().join(name);
    let page = fs::read(at("results/missed/report.html")).unwrap();
    let report = |out: &str| {
        desim(dir.path(), &["report", "results/missed", "--out", out])
            .output()
            .unwrap()
    };
    // Over a page, through a link to one, where an attempt that was cut short left something.
    fs::write(at("page.html"), &page[..2000]).unwrap();
    fs::write(at(".page.html.unfinished"), "left").unwrap();
    std::os::unix::fs::symlink("page.html", at("link.html")).unwrap();
    assert!(report("link.html").status.success());
    assert!(at("link.html").is_symlink() && fs::read(at("page.html")).unwrap() == page);
    assert!(!at(".page.html.unfinished").exists() && !at(".link.html.unfinished").exists());
    // Into a stream, which has nothing else on it.
    assert!(report("/dev/stdout").stdout == page);
    assert!(report("/dev/null").status.success());
    std::os::unix::fs::symlink("nothing", at("loose")).unwrap();
    for (out, says) in [
        ("results", "results is a folder"),
        ("missed.ron", "missed.ron is no page of desim"),
        ("loose", "loose is a link to nothing"),
    ] {
        let refused = report(out);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains(says), "{said}");
    }
    assert_eq!(fs::read_to_string(at("missed.ron")).unwrap(), SCENARIO);
    let lost = report("none/page.html");
    assert_eq!(lost.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&lost.stderr).contains("none/page.html"));
}

#[test]
fn the_readme_says_how_to_check_a_folder_by_hand() {
    let readme = include_str!("../../../results/README.md");
    let start = readme
        .find("grep -v '^  \"xxh3_128\"'")
        .expect("the command is documented");
    assert!(readme[start..].starts_with("grep -v '^  \"xxh3_128\"' manifest.json | xxh128sum"));
    let dir = finished();
    let manifest = fs::read_to_string(dir.path().join("results/missed/manifest.json")).unwrap();
    let is_own = |line: &&str| line.starts_with("  \"xxh3_128\"");
    let rest: Vec<&str> = manifest.lines().filter(|line| !is_own(line)).collect();
    let rest = rest.join("\n") + "\n";
    let own = manifest.lines().find(is_own).unwrap();
    let hash = format!("{:032x}", xxhash_rust::xxh3::xxh3_128(rest.as_bytes()));
    assert_eq!(own, format!("  \"xxh3_128\": \"{hash}\","));
}

#[test]
fn a_file_that_never_ends_is_refused_at_once() {
    let dir = finished();
    let results = dir.path().join("results/missed");
    for name in ["trials.parquet", "summary.json", "manifest.json", "report.html"] {
        let file = results.join(name);
        let whole = fs::read(&file).unwrap();
        for make in [pipe as fn(&Path), |file| {
            std::os::unix::fs::symlink("/dev/zero", file).unwrap();
        }] {
            fs::remove_file(&file).unwrap();
            make(&file);
            let shown = Command::new("timeout")
                .args(["20", env!("CARGO_BIN_EXE_desim"), "scenario", "missed.ron"])
                .current_dir(dir.path())
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&shown.stderr);
            assert_eq!(shown.status.code(), Some(2), "{name}: {said}");
            assert!(said.contains(name), "{name}: {said}");
        }
        fs::remove_file(&file).unwrap();
        fs::write(&file, whole).unwrap();
    }
}

fn pipe(at: &Path) {
    assert!(Command::new("mkfifo").arg(at).status().unwrap().success());
}

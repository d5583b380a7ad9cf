//! A mission that fails says which target it missed, for how long, and what stood in the way; so does its report, from the tables.

use std::path::Path;

use assert_cmd::Command;

fn desim(arguments: &[&str], folder: &Path) -> String {
    let mut command = Command::cargo_bin("desim").unwrap();
    let output = command.args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The words of the section on the mission, on one line.
fn mission(report: &str) -> String {
    let section = report.split("Mission\n").nth(1).unwrap().split("\n\n").next().unwrap();
    section.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Runs a mission to one target 3 m out with `robots` robots, and checks that run, report and page say `words` of it.
fn assert_said(robots: u32, sections: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("Scenario(name: \"a\", swarm: (robots: {robots}, deploy: Cluster(radius: 0.6)), {sections})");
    std::fs::write(folder.path().join("a.ron"), text).unwrap();
    let run = mission(&desim(&["scenario", "a.ron", "--out", "out"], folder.path()));
    let report = mission(&desim(&["report", "out"], folder.path()));
    assert_eq!(run, report, "the tables say what the run said");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    for words in words {
        assert!(run.contains(words), "{words}: {run}");
        // There each is a sentence.
        let (first, rest) = words.split_at(1);
        let on_page = [first.to_uppercase().as_str(), rest].concat();
        let found = page.contains(words) || page.contains(&on_page);
        assert!(found, "{on_page} is not on the page");
    }
}

const MISSION: &str = "protocol: Backbone(targets: Ring(count: 1, radius: 3.0))";

#[test]
fn a_mission_without_time_says_that_its_worker_was_still_on_its_way() {
    // The way is 2.1 m at least, and 50 s are good for 1.3 m.
    let words = ["target 0: missed for 50.0 s of 50.0 s: its worker was still on its way"];
    assert_said(12, &format!("time_limit: 50.0, {MISSION}"), &words);
}

#[test]
fn a_mission_behind_a_wall_says_that_its_worker_was_held_up_and_its_target_is_walled_in() {
    // A body's centre comes to 2.13 m, 0.87 m from the target.
    let wall = "arena: (obstacles: [Wall(from: (2.2, -5.0), to: (2.2, 5.0))])";
    let words = [
        "target 0: missed for 200 s of 200 s: its worker was held up 0.870 m away, 0.870 m at best",
        "it is walled in",
    ];
    assert_said(12, &format!("time_limit: 200.0, {wall}, {MISSION}"), &words);
}

#[test]
fn a_mission_whose_robots_crash_says_that_no_worker_was_left_and_how_many_it_would_have_taken() {
    let faults = "faults: [Crash(robots: [1, 2, 3, 4, 5, 6], at: 40.0)]";
    let words = [
        "target 0: missed for 150 s of 150 s: no worker was left",
        "too few robots: 1 alive at the end, and the mission takes 3",
    ];
    assert_said(7, &format!("time_limit: 150.0, {faults}, {MISSION}"), &words);
}

#[test]
fn several_trials_are_put_together_in_a_line_a_target() {
    let two = "protocol: Backbone(targets: Ring(count: 2, radius: 3.0))";
    let words = [
        "target 0: missed in 3 of 3 failed trials, in the median for 50.0 s of 50.0 s",
        "target 1: missed in 3 of 3 failed trials",
    ];
    assert_said(12, &format!("trials: 3, time_limit: 50.0, {two}"), &words);
}

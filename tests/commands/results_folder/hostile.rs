//! What others wrote into files, names and arguments is words, wherever it is shown: never an order to a terminal, a formula of a
//! spreadsheet, or markup.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use desim::text::is_unsafe;
use tempfile::{TempDir, tempdir};

/// Colours, a title, a bell, a carriage return, a reversed C1 control, bidirectional overrides, letters without width.
const EVIL: &str = "\u{1b}[31mred\u{1b}]0;owned\u{7}\rover\u{9b}2J\u{202e}gpj\u{200b}\u{feff}x\u{7f}\u{8}";

const SCENARIO: &str = "Scenario(name: \"small\", trials: 2, time_limit: 2.0, \
    swarm: (robots: 5, deploy: Uniform), protocol: Heartbeat, detector: Timeout(0.35), radio: (loss: Bernoulli(0.4)))";

fn place() -> TempDir {
    let dir = tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    write("small.ron", &format!("// Why {}?\n{SCENARIO}", EVIL.replace('\r', "")));
    write("ev\u{1b}[31mil\u{202e}.ron", SCENARIO);
    write(
        "field.ron",
        &SCENARIO.replace("swarm", &format!("/* {EVIL} */ swa{}rm", "\u{1b}[2J")),
    );
    write("value.ron", &SCENARIO.replace("\"small\"", &format!("\"{EVIL}\"")));
    write(
        "long.ron",
        &SCENARIO.replace(
            "2.0,",
            &format!("2.0, /* {EVIL}{} */ nonsense{EVIL}: 1,", "x".repeat(500)),
        ),
    );
    fs::write(dir.path().join("bytes.ron"), b"Scenario(\x1b[2J \xff name: 1)").unwrap();
    let study = |label: &str| {
        format!(
            "// Does {}\u{202e} pay?\nStudy(name: \"patience\", base: \"small.ron\", trials: 6, factors: [(name: \"t\u{1b}[1m<b>\", \
            paths: [\"detector\"], levels: [(label: \"=1+1{label}\", values: [Timeout(0.25)]), (label: \"<img src=x>{label}\", \
            values: [Timeout(0.55)])])], figure: \"detection.mistake_rate_hz\", \
            pareto: (\"detection.mistake_rate_hz\", \"detection.query_accuracy\"))",
            "\u{1b}[5mpatience"
        )
    };
    write("study.ron", &study("\u{1b}[31m\u{9b}2J\u{202e}\u{200b}"));
    write("two.ron", &study("\u{1b}").replace("0.55", "-0.55"));
    dir
}

fn run(dir: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_desim"))
        .current_dir(dir)
        .args(arguments)
        .env("DESIM_LOG", "debug")
        .output()
        .unwrap()
}

/// Panics if `text` holds anything that [`EVIL`] is made of.
fn assert_safe(text: &[u8], what: &str) {
    let text = String::from_utf8(text.to_owned()).unwrap_or_else(|_| panic!("{what} is no UTF-8"));
    let found = text
        .chars()
        .find(|letter| is_unsafe(*letter) && !matches!(letter, '\n' | '\t'));
    assert_eq!(found, None, "{what}: {text}");
}

#[test]
fn nothing_that_others_wrote_gives_orders_to_a_terminal() {
    let dir = place();
    let evil_file = "ev\u{1b}[31mil\u{202e}.ron";
    let evil_set = format!("radio.loss={EVIL}");
    let evil_path = format!("{}=1", EVIL.replace('=', ""));
    let evil_flag = format!("--{EVIL}");
    let evil_out = "out\u{1b}[31m\u{202e}";
    let commands: [(&[&str], i32); 22] = [
        (&["check", "small.ron", evil_file, "study.ron"], 0),
        (&["check", "--predict", "small.ron"], 0),
        (&["check", "--resolved", "small.ron"], 0),
        (
            &["check", "field.ron", "value.ron", "long.ron", "bytes.ron", "two.ron"],
            2,
        ),
        (&["check", "--predict", "--format", "json", "field.ron"], 2),
        (&["check", "small.ron", "--set", &evil_set], 2),
        (&["check", "small.ron", "--set", &evil_path], 2),
        (&["check", EVIL], 2),
        (&["scenario", &evil_flag], 2),
        (&["scenario", "small.ron", "--format", EVIL], 2),
        (&["scenario", "small.ron", "--trials", EVIL], 2),
        (&[EVIL], 2),
        (&["scenario", "value.ron"], 2),
        (&["scenario", "small.ron", "--out", evil_out], 0),
        (&["scenario", "small.ron", "--out", evil_out, "--seed", "4"], 2),
        (&["report", evil_out], 0),
        (&["explain", evil_out, "--trial", "0", "--robot", "1"], 0),
        (&["explain", EVIL, "--trial", "0", "--robot", "1"], 2),
        (&["compare", "study.ron"], 0),
        (&["compare", "study.ron", "--format", "json"], 0),
        (&["compare", "study.ron", "--trials", "7"], 2),
        (&["report", "results/patience"], 0),
    ];
    for (arguments, status) in commands {
        let output = run(dir.path(), arguments);
        let what = format!("{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(status), "{what}");
        assert_safe(&output.stdout, &what);
        assert_safe(&output.stderr, &what);
    }
    // A folder that others wrote: its names are shown, too.
    fs::create_dir(dir.path().join("theirs")).unwrap();
    fs::write(dir.path().join("theirs").join("\u{1b}[2J\n\u{202e}"), "").unwrap();
    let refused = run(dir.path(), &["scenario", "small.ron", "--out", "theirs"]);
    assert_eq!(refused.status.code(), Some(2));
    assert_safe(&refused.stderr, "a folder of others");
}

#[test]
fn a_fault_is_underlined_where_it_stands_though_signs_are_longer() {
    let dir = place();
    let text = "Scenario(name: \"a\u{1b}\u{1b}\u{1b}b\", nonsense: 1)";
    fs::write(dir.path().join("signs.ron"), text).unwrap();
    let output = run(dir.path(), &["check", "signs.ron"]);
    let said = String::from_utf8(output.stdout).unwrap();
    let (_, unknown) = said.split_once("unknown field `nonsense`").expect(&said);
    let mut lines = unknown.lines().skip_while(|line| !line.contains("a␛␛␛b"));
    let (shown, under) = (lines.next().expect(&said), lines.next().expect(&said));
    let column = shown[..shown.find("nonsense").expect(&said)].chars().count();
    let underlined = under.chars().position(|letter| "─┬".contains(letter));
    assert_eq!(underlined, Some(column), "{said}");
    assert!(!said.contains('\u{1b}'), "{said}");
}

#[test]
fn what_files_hold_is_safe_for_browsers_spreadsheets_and_parsers() {
    let dir = place();
    assert!(run(dir.path(), &["compare", "study.ron", "--quiet"]).status.success());
    assert!(run(dir.path(), &["report", "results/patience"]).status.success());
    let results = dir.path().join("results/patience");
    let read = |name: &str| fs::read_to_string(results.join(name)).unwrap();
    for name in ["comparison.json", "study.json", "pareto.svg"] {
        assert_safe(read(name).as_bytes(), name);
    }
    // Escaped, not lost.
    let comparison: serde_json::Value = serde_json::from_str(&read("comparison.json")).unwrap();
    assert_eq!(
        comparison["factors"][0]["levels"][0],
        "=1+1\u{1b}[31m\u{9b}2J\u{202e}\u{200b}"
    );
    assert!(!read("pareto.svg").contains("<img"));

    let page = read("report.html");
    let (_, body) = page.split_once("<body>").unwrap();
    assert_safe(body.as_bytes(), "report.html");
    assert!(!body.contains("<img") && !body.contains("<b>"), "names are words");
    let csvs: Vec<String> = body
        .split("href=\"data:text/csv;charset=utf-8,")
        .skip(1)
        .map(|rest| decoded(rest.split('"').next().unwrap()))
        .collect();
    assert!(csvs.len() > 2);
    for csv in csvs {
        assert_safe(csv.replace('\r', "").as_bytes(), "csv");
        for cell in csv.lines().flat_map(|line| line.split(',')) {
            assert!(
                !cell.trim_matches('"').starts_with(['=', '@', '\t', '\r']),
                "{cell:?} in {csv}"
            );
        }
        assert!(!csv.contains("=1+1") || csv.contains("\"'=1+1"), "{csv}");
    }
}

/// A text whose bytes are written as `%41`.
fn decoded(text: &str) -> String {
    let mut parts = text.split('%');
    let mut bytes = parts.next().unwrap().as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(&part[..2], 16).unwrap());
        bytes.extend(&part.as_bytes()[2..]);
    }
    String::from_utf8(bytes).unwrap()
}

//! Harm done to results: bits that flip, processes that are killed. `DESIM_TRIES` says how often; `.ci/full` asks for more than
//! `cargo test`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// How often to try, by default `few` times.
pub fn tries(few: usize) -> usize {
    std::env::var("DESIM_TRIES").map_or(few, |tries| tries.parse().expect("DESIM_TRIES is a number"))
}

/// Numbers that look random (splitmix64) and are the same in every test run.
pub struct Chance(pub u64);

impl Chance {
    /// A number below `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end
    }
}

/// The binary, to be run in `dir`.
pub fn desim(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_desim"));
    command.current_dir(dir).args(arguments);
    command
}

/// Files below `dir`, in order.
pub fn files(dir: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap().flatten() {
        if entry.path().is_dir() {
            found.extend(files(&entry.path()));
        } else {
            found.push(entry.path());
        }
    }
    found.sort();
    found
}

/// Everything below `dir`, hidden or not, by its path, but for what an experiment took on this machine: wall times, and the
/// hashes of the manifests that hold them.
pub fn tree(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let of_machine = |line: &str| line.contains("\"wall_s\"") || line.starts_with("  \"xxh3_128\"");
    let content = |path: &Path| {
        let bytes = fs::read(path).unwrap();
        if path.ends_with("manifest.json") {
            let text = String::from_utf8(bytes).unwrap();
            let lines: Vec<&str> = text.lines().filter(|line| !of_machine(line)).collect();
            lines.join("\n").into_bytes()
        } else {
            bytes
        }
    };
    let name = |path: &Path| path.strip_prefix(dir).unwrap().display().to_string();
    files(dir).iter().map(|path| (name(path), content(path))).collect()
}

/// Panics unless both trees are the same.
pub fn assert_same(one: &BTreeMap<String, Vec<u8>>, other: &BTreeMap<String, Vec<u8>>, when: &str) {
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>(),
        "{when}"
    );
    for (name, content) in one {
        assert!(other[name] == *content, "{name} differs, {when}");
    }
}

/// Flips single bits in files below `results`, each file in turn, and runs `commands` in `dir` after each: they show what they
/// showed before, or they end with a status that is not 0 and a message that names the file.
pub fn flip(dir: &Path, results: &Path, commands: &[&[&str]], tries: usize) {
    let run = |arguments: &[&str]| desim(dir, arguments).output().unwrap();
    let before: Vec<Output> = commands.iter().map(|arguments| run(arguments)).collect();
    assert!(before.iter().all(|output| output.status.success()), "{before:?}");
    let files = files(results);
    let mut chance = Chance(7);
    let mut refused = 0;
    for attempt in 0..tries {
        let file = &files[attempt % files.len()];
        let whole = fs::read(file).unwrap();
        let mut flipped = whole.clone();
        let (at, bit) = (chance.below(whole.len() as u64), chance.below(8));
        flipped[usize::try_from(at).unwrap()] ^= 1 << bit;
        fs::write(file, &flipped).unwrap();
        for (arguments, before) in commands.iter().zip(&before) {
            let after = run(arguments);
            let said = String::from_utf8_lossy(&after.stderr);
            let what = format!("bit {bit} of byte {at} in {}, {arguments:?}: {said}", file.display());
            if after.status.success() {
                assert!(after.stdout == before.stdout, "{what}");
            } else {
                let name = file.file_name().unwrap().to_str().unwrap();
                assert!(after.stdout.is_empty() && said.contains(name), "{what}");
                assert!(matches!(after.status.code(), Some(1 | 2)), "{what}");
                refused += 1;
            }
        }
        fs::write(file, &whole).unwrap();
    }
    println!(
        "{tries} bits flipped below {}: {refused} commands refused",
        results.display()
    );
    assert!(refused > tries / 2, "{refused} of {tries}");
}

/// Kills the command again and again at instants that chance draws from the time that a whole run takes, each time by another
/// signal; then lets it come to its end.
pub fn kill(dir: &Path, arguments: &[&str], whole: Duration, chance: &mut Chance) -> usize {
    let mut kills = 0;
    for signal in ["KILL", "INT", "TERM"] {
        let mut child = desim(dir, arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let micros = u64::try_from(whole.as_micros()).unwrap();
        std::thread::sleep(Duration::from_micros(chance.below(micros)));
        let id = child.id().to_string();
        // It may have come to its end by itself.
        let _ = Command::new("kill")
            .args(["-s", signal, &id])
            .stderr(Stdio::null())
            .status();
        let status = child.wait().unwrap();
        kills += usize::from(!status.success());
        assert!(matches!(status.code(), None | Some(0 | 130)), "{signal}: {status}");
    }
    let last = desim(dir, arguments).output().unwrap();
    assert!(last.status.success(), "{}", String::from_utf8_lossy(&last.stderr));
    kills
}

/// Runs the command once and answers how long it took.
pub fn timed(dir: &Path, arguments: &[&str]) -> Duration {
    let start = Instant::now();
    let output = desim(dir, arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    start.elapsed()
}

//! `manifest.json`: what a results folder is the result of, and what it took.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use xxhash_rust::xxh3::xxh3_128;

use super::files::{MANIFEST, PAGE};
use super::held::{FileEntry, measure};
use crate::experiment::Key;
use crate::kinds;
use crate::scenario::{Scenario, parse, to_ron};
use crate::text::shown;

/// What `manifest.json` holds. The only file of a results folder that depends on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of desim.
    pub version: String,
    /// Commit that it was built from, where the build was told (environment variable `DESIM_COMMIT`).
    pub commit: Option<String>,
    /// The program that made it, where the protocol is the program's own: the XXH3-128 hash of its file. Another build of it may hold another
    /// protocol.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// The question that the scenario asks: the first comment of its file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
    /// Whether every trial has finished.
    pub finished: bool,
    /// The whole scenario, defaults and overrides worked in.
    pub scenario: Value,
    /// Seed of every random stream.
    pub seed: u64,
    /// What ran: empty until all trials have finished.
    pub trials: Vec<TrialEntry>,
    /// The other files, by name.
    pub files: BTreeMap<String, FileEntry>,
}

/// One trial in the manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialEntry {
    /// Its number.
    pub trial: u32,
    /// Digest of its events, 32 hexadecimal digits.
    pub digest: String,
    /// Simulated seconds.
    pub simulated_s: f64,
    /// Copies of frames that were delivered.
    pub delivered: u64,
    /// Wall time that its thread spent on it, seconds.
    pub wall_s: f64,
}

impl Manifest {
    /// The manifest of an experiment that has just begun.
    ///
    /// # Panics
    /// Never: a scenario holds only what JSON can write.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("DESIM_COMMIT").map(str::to_owned),
            program: program(scenario),
            question: None,
            finished: false,
            scenario: serde_json::to_value(scenario).expect("a scenario holds only what JSON can write"),
            seed: scenario.seed,
            trials: Vec::new(),
            files: BTreeMap::new(),
        }
    }

    /// The scenario, of results in the folder `dir`. Somebody may have edited it: it must hold as any scenario file must.
    ///
    /// # Errors
    /// In words, what is wrong with it.
    pub fn read_scenario(&self, dir: &Path) -> Result<Scenario, String> {
        let scenario: Scenario = serde_json::from_value(self.scenario.clone()).map_err(|error| error.to_string())?;
        let place = shown(&dir.join(MANIFEST));
        parse(&place, &to_ron(&scenario), &[]).map_err(|report| report.to_string())
    }

    /// What its trials are of: version, program and scenario, but for the number of trials, which no trial depends on.
    #[must_use]
    pub fn key(&self) -> Key {
        let mut scenario = self.scenario.clone();
        if let Some(fields) = scenario.as_object_mut() {
            fields.shift_remove("trials");
        }
        let of = json!([self.version, self.program, scenario]);
        Key(xxh3_128(of.to_string().as_bytes()))
    }

    /// The other files but for the page of charts, which follows from them.
    #[must_use]
    pub fn results(&self) -> BTreeMap<String, FileEntry> {
        let files = self.files.iter().filter(|(name, _)| *name != PAGE);
        files.map(|(name, entry)| (name.clone(), entry.clone())).collect()
    }

    /// What keeps results of `self` from being results of `asked`, a line each: version and scenario, field by field.
    /// While `self` is unfinished, the number of trials may be another one: finished trials stay good.
    #[must_use]
    pub fn differences(&self, asked: &Self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.version != asked.version {
            lines.push(format!("desim {} there, {} now", self.version, asked.version));
        }
        lines.extend(other_program(self.program.as_ref(), asked.program.as_ref()));
        let fields = self.scenario_differences(asked).into_iter();
        let counts = |field: &Difference| self.finished || field.path != "trials";
        lines.extend(fields.filter(counts).map(|difference| difference.line()));
        lines
    }

    /// The values of the scenarios of two results that differ.
    #[must_use]
    pub fn scenario_differences(&self, other: &Self) -> Vec<Difference> {
        let mut found = Vec::new();
        compare("", &self.scenario, &other.scenario, &mut found);
        found
    }

    /// The version of desim and the commit that it was built from, where that is known.
    #[must_use]
    pub fn made_by(&self) -> String {
        made_by(&self.version, self.commit.as_deref())
    }
}

/// What a version of desim is called, with its commit where that is known.
pub(super) fn made_by(version: &str, commit: Option<&str>) -> String {
    let commit = commit.map(|commit| format!(" ({commit})"));
    format!("desim {version}{}", commit.unwrap_or_default())
}

/// The hash of this program's file, if the protocol of `scenario` is not one that desim ships: then it is the program's own.
#[must_use]
pub fn program(scenario: &Scenario) -> Option<String> {
    static HASH: OnceLock<Option<String>> = OnceLock::new();
    let hash = || {
        let measured = measure(&std::env::current_exe().ok()?).ok()?;
        Some(measured.xxh3_128)
    };
    let own = !kinds::is_shipped(scenario.protocol.name());
    own.then(|| HASH.get_or_init(hash).clone()).flatten()
}

/// What to say of results of another program than `asked`.
pub(super) fn other_program(there: Option<&String>, asked: Option<&String>) -> Option<String> {
    let differs = there.zip(asked).is_some_and(|(there, asked)| there != asked);
    differs.then(|| "another build of this program made them, whose protocol may have been another".to_owned())
}

/// A value of a scenario that is another one in another scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Where it is, such as `radio.range`.
    pub path: String,
    /// The one and the other, as JSON.
    pub values: [String; 2],
}

impl Difference {
    /// Whether it is in the outermost field of this name.
    #[must_use]
    pub fn is_at(&self, name: &str) -> bool {
        self.path.split('.').next() == Some(name)
    }

    /// As a line for people.
    #[must_use]
    pub fn line(&self) -> String {
        let [there, now] = &self.values;
        format!("{}: {there} there, {now} now", self.path)
    }
}

/// Adds each value that differs between `one` and `other`.
pub fn compare(path: &str, one: &Value, other: &Value, found: &mut Vec<Difference>) {
    match (one, other) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            for ((key, one), other) in a.iter().zip(b.values()) {
                let path = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                compare(&path, one, other, found);
            }
        }
        _ if one != other => found.push(Difference {
            path: path.to_owned(),
            values: [one.to_string(), other.to_string()],
        }),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(finished: bool, scenario: Value) -> Manifest {
        Manifest {
            version: "1".into(),
            commit: None,
            program: None,
            question: None,
            finished,
            scenario,
            seed: 1,
            trials: Vec::new(),
            files: BTreeMap::new(),
        }
    }

    #[test]
    fn a_difference_names_the_field_and_both_values() {
        let there = manifest(
            true,
            json!({"trials": 3, "radio": {"range": 2.0, "loss": {"Bernoulli": 0.1}}}),
        );
        let now = manifest(false, json!({"trials": 3, "radio": {"range": 2.0, "loss": "None"}}));
        assert_eq!(
            there.differences(&now),
            [r#"radio.loss: {"Bernoulli":0.1} there, "None" now"#]
        );
    }

    #[test]
    fn only_an_unfinished_result_takes_another_number_of_trials() {
        let (few, many) = (json!({"trials": 3}), json!({"trials": 5}));
        assert!(
            manifest(false, few.clone())
                .differences(&manifest(false, many.clone()))
                .is_empty()
        );
        assert_eq!(
            manifest(true, few).differences(&manifest(false, many)),
            ["trials: 3 there, 5 now"]
        );
    }

    #[test]
    fn another_version_is_a_difference() {
        let mut other = manifest(false, json!({}));
        other.version = "2".into();
        assert_eq!(manifest(true, json!({})).differences(&other), ["desim 1 there, 2 now"]);
    }

    #[test]
    fn results_of_another_build_of_ones_own_program_differ_and_of_none_do_not() {
        let made = |program: Option<&str>| Manifest {
            program: program.map(str::to_owned),
            ..manifest(true, json!({ "trials": 3 }))
        };
        assert_eq!(made(Some("a")).differences(&made(Some("a"))), [""; 0]);
        let [line] = &made(Some("a")).differences(&made(Some("b")))[..] else {
            panic!("one difference")
        };
        assert!(line.contains("another build of this program"));
        assert_eq!(made(None).differences(&made(None)), [""; 0]);
    }
}

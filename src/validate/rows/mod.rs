//! The catalogue, a file for each group of models.

mod access;
mod airtime;
mod contention;
mod degree;
mod detection;
mod disk;
mod energy;
mod errors;
mod fading;
mod path_loss;
mod shadowing;

use super::row::Row;

/// All oracles, in the order in which they are shown.
#[must_use]
pub fn catalogue() -> Vec<Row> {
    let groups = [
        path_loss::rows(),
        shadowing::rows(),
        fading::rows(),
        degree::rows(),
        errors::rows(),
        airtime::rows(),
        access::rows(),
        contention::rows(),
        energy::rows(),
        disk::rows(),
        detection::rows(),
    ];
    let mut rows: Vec<Row> = groups.into_iter().flatten().collect();
    // Those of one model together, models as they first come.
    let mut models: Vec<&str> = Vec::new();
    for row in &rows {
        if !models.contains(&row.model) {
            models.push(row.model);
        }
    }
    rows.sort_by_key(|row| models.iter().position(|model| *model == row.model));
    rows
}

/// How long trials last, seconds, and the sections of their scenario.
type Setting = (f64, Vec<String>);

/// The standard sentence about fields of few waves.
const WAVES: &str = "a gain is a sum of 32 waves, and not of endlessly many";

/// Two robots `metres` apart.
fn pair(metres: f64) -> String {
    format!(
        "arena: (size: ({size:?}, 10.0)),\n    swarm: (robots: 2, deploy: At([(0.0, 0.0), ({metres:?}, 0.0)]))",
        size = 2.0 * metres + 10.0
    )
}

/// So many robots anywhere in a small arena.
fn anywhere(robots: u32) -> String {
    format!("arena: (size: (9.0, 9.0)),\n    swarm: (robots: {robots}, deploy: Uniform)")
}

/// A loss of 50 dB between any two robots.
const EQUAL_LOSS: &str = "path_loss: LogDistance(exponent: 0.000001, reference_loss: 50.0)";

/// Robots at a `place` that send as `traffic` says over a `radio`.
fn traffic(seconds: f64, place: &str, traffic: &str, radio: &str) -> Setting {
    let sections = vec![
        place.to_owned(),
        format!("control: (period: {:?}, phase: Together)", f64::min(seconds, 1.0)),
        format!("protocol: Traffic({traffic})"),
        format!("radio: ({radio})"),
        "metrics: (sample_interval: 0.0, links: true)".to_owned(),
    ];
    (seconds, sections)
}

/// Robot 0 sends to robot 1, `metres` away, without a medium between them.
fn link(seconds: f64, metres: f64, when: &str, payload: u32, radio: &str) -> Setting {
    let load = format!("senders: Given([0]), to: Next, when: {when}, payload: {payload}");
    traffic(seconds, &pair(metres), &load, &format!("{radio}, access: None"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::scenario::{examine, parse, to_ron};

    #[test]
    fn there_are_many_rows_each_with_a_name_of_its_own_a_form_and_trials_to_tell() {
        let rows = catalogue();
        assert!(rows.len() >= 40, "{}", rows.len());
        let names: BTreeSet<&str> = rows.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names.len(), rows.len());
        for row in &rows {
            assert!(
                !row.form.is_empty() && row.trials >= 2 && row.expected.is_finite(),
                "{row:?}"
            );
            assert!(
                row.margin
                    .as_ref()
                    .is_none_or(|margin| margin.size > 0.0 && !margin.why.is_empty()),
                "{row:?}"
            );
        }
    }

    #[test]
    fn every_scenario_is_accepted_without_a_fault_and_holds_its_seed_and_trials() {
        for row in catalogue() {
            let text = row.scenario(7);
            let (scenario, _) = examine(&row.name, &text, &[]).unwrap_or_else(|report| panic!("{text}\n{report}"));
            assert_eq!((scenario.seed, scenario.trials), (7, row.trials), "{}", row.name);
            assert!(parse(&row.name, &to_ron(&scenario), &[]).is_ok(), "{}", row.name);
        }
    }
}

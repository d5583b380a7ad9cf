//! The figures that a study compares: those that all of its settings have.

use crate::kind::Problem;
use crate::scenario::Scenario;
use crate::scenario::explain::nearest;

/// Keys of the figures that every setting has.
pub fn common(scenarios: &[&Scenario]) -> Vec<String> {
    let of = |scenario: &Scenario| -> Vec<String> {
        let figures = scenario.figures();
        let keys = figures.figures().map(|figure| figure.key.clone());
        keys.filter(|key| scenario.metrics.pairs || !is_of_pairs(key)).collect()
    };
    let mut known: Option<Vec<String>> = None;
    for scenario in scenarios {
        let has = of(scenario);
        known = Some(match known {
            None => has,
            Some(known) => known.into_iter().filter(|key| has.contains(key)).collect(),
        });
    }
    known.unwrap_or_default()
}

/// What two scenarios are compared by where nobody says: what the mission takes, what it costs, what arrives, who is mistaken.
pub fn usual(scenarios: &[&Scenario]) -> Vec<String> {
    let all = |has: fn(&Scenario) -> bool| scenarios.iter().all(|scenario| has(scenario));
    let mission = all(|scenario| scenario.protocol.mission().is_some());
    let detector = all(Scenario::runs_detector);
    let keys = [
        ("steps_to_completion", mission),
        ("bandwidth.tx_bytes_per_step.mean", true),
        ("bandwidth.rx_bytes_per_step.mean", true),
        ("delivery_ratio", true),
        ("detection.mistake_rate_hz", detector),
        ("duplicates", !detector),
    ];
    let apt = keys.into_iter().filter(|(_, is_apt)| *is_apt);
    apt.map(|(key, _)| key.to_owned()).collect()
}

/// Whether a figure is of what passes between two robots, which is kept only where a scenario asks for it.
fn is_of_pairs(key: &str) -> bool {
    key.starts_with("pairs.")
}

/// Whether a figure is of radios on which frames take time.
fn is_of_air(key: &str) -> bool {
    key.starts_with("radio.") || key == "goodput_bps"
}

/// Says that a figure is not known, and which may be meant.
pub fn unknown(key: &str, known: &[String]) -> String {
    if is_of_pairs(key) && !known.iter().any(|key| is_of_pairs(key)) {
        return format!("`{key}` is there only where all settings say `metrics: (pairs: true)`");
    }
    if is_of_air(key) && !known.iter().any(|key| is_of_air(key)) {
        return format!("`{key}` is there only where the radio of all settings has a technology");
    }
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let guess = nearest(key, &known).map_or_else(String::new, |name| format!(", did you mean `{name}`?"));
    format!("no figure `{key}` is common to all settings{guess}")
}

/// Names the figures, those of single topics and causes by their kind.
pub fn help(known: &[String]) -> String {
    let whole = known
        .iter()
        .filter(|key| !key.contains("by_topic") && !key.starts_with("lost."));
    let keys: Vec<&str> = whole.map(String::as_str).collect();
    format!(
        "figures are {}, lost.<cause>, and bandwidth.by_topic.<topic>.*",
        keys.join(", ")
    )
}

/// Figures that a study names and not all of its `scenarios` have: `named`, the first as its `figure` and `also` further ones, and the
/// `axes` of its Pareto front.
pub fn problems(scenarios: &[&Scenario], named: &[String], also: usize, axes: Option<&[String; 2]>) -> Vec<Problem> {
    let known = common(scenarios);
    let places = std::iter::once("figure".to_owned()).chain((0..also).map(|index| format!("also[{index}]")));
    let named = places.zip(named);
    let drawn = axes.into_iter().flat_map(|axes| (0..).zip(axes));
    let drawn = drawn.map(|(axis, key): (usize, &String)| (format!("pareto[{axis}]"), key));
    let all = named.chain(drawn).filter(|(_, key)| !known.contains(key));
    all.map(|(place, key)| Problem::new(&place, unknown(key, &known), help(&known)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(radio: &str) -> Scenario {
        let text = format!(
            "Scenario(name: \"a\", time_limit: 9.0, swarm: (robots: 3, deploy: Cluster(radius: 0.5)), protocol: Traffic(), radio: ({radio}))"
        );
        crate::scenario::parse("a.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
    }

    #[test]
    fn figures_of_the_air_are_common_to_settings_that_all_share_it() {
        let (disk, shared) = (over(""), over("technology: Ieee802154()"));
        let of_air = |scenarios: &[&Scenario]| common(scenarios).iter().filter(|key| is_of_air(key)).count();
        assert_eq!(of_air(&[&shared, &shared]), 12);
        assert_eq!((of_air(&[&shared, &disk]), of_air(&[&disk])), (0, 0));
        let none = unknown("radio.busy_share", &common(&[&shared, &disk]));
        assert!(
            none.ends_with("only where the radio of all settings has a technology"),
            "{none}"
        );
        let typo = unknown("radio.busy_shares", &common(&[&shared]));
        assert!(typo.ends_with("did you mean `radio.busy_share`?"), "{typo}");
    }
}

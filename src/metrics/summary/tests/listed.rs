//! Figures without a place of their own, those of others too.

use super::*;
use crate::metrics::figures::{Better, Figure, Sample};
use crate::spool::Spool;
use crate::statistics::Estimator;

#[test]
fn a_figure_without_a_place_of_its_own_stands_in_the_list_and_one_that_no_trial_has_does_not() {
    let value = |summary: &Summary, key: &str| summary.figures.get(key).and_then(|listed| listed.estimate.value);
    let seen = summary();
    // Done at step 7 of 0.1 s, and not done in 1 s.
    assert!((value(&seen, "completion_s").unwrap() - 0.85).abs() < 1e-12);
    assert_eq!(seen.figures.get("completion_s").unwrap().cut_off, Some(1));
    // One in range of each other in both samples, and in one of two.
    assert_eq!(value(&seen, "neighbours"), Some(0.75));

    let mut still = trial(0, 8);
    still.outcome = Outcome::NoMission;
    still.connectivity = Spool::default();
    let none = Summary::of("still", &TOPICS, &ROLES, &[still]);
    assert!(none.figures.is_empty());
    assert!(serde_json::to_value(&none).unwrap().get("figures").is_none());
}

/// A figure from outside: how much less than nothing there is of it.
fn from_outside(registry: &mut Registry) {
    let figure = Figure {
        key: "chill".to_owned(),
        name: "degrees of chill".to_owned(),
        unit: "K".into(),
        better: Better::Lower,
        is_ratio: false,
        estimator: Estimator::Mean,
    };
    registry.add_figure(figure, |record| Sample::plain(Some(-f64::from(record.trial))));
}

#[test]
fn a_figure_from_outside_is_read_estimated_and_summarised_as_those_of_desim_are() {
    let mut registry = Registry::of(&TOPICS);
    let shipped = registry.figures().count();
    from_outside(&mut registry);
    let records = [trial(0, 8), trial(1, 6), trial(2, 6)];
    let read: Vec<_> = records
        .iter()
        .map(|record| registry.read(record)[shipped].value())
        .collect();
    assert_eq!(read, [Some(-0.0), Some(-1.0), Some(-2.0)]);
    let summary = Summary::by(&registry, "duet", &TOPICS, &ROLES, &records);
    let listed = summary.figures.get("chill").unwrap();
    assert_eq!((listed.estimate.value, &*listed.unit), (Some(-1.0), "K"));
    assert_eq!(
        Summary {
            figures: Named::default(),
            ..summary
        },
        Summary {
            figures: Named::default(),
            ..Summary::of("duet", &TOPICS, &ROLES, &records)
        },
        "it touches no other"
    );
}

#[test]
#[should_panic(expected = "two figures have the key chill")]
fn a_key_that_is_taken_is_a_mistake_of_the_program() {
    let mut registry = Registry::of(&TOPICS);
    from_outside(&mut registry);
    from_outside(&mut registry);
}

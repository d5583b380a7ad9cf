//! Study files: what ships is well, and what is wrong is named where it stands.

use std::fs;
use std::path::Path;

use desim::scenario::{Report, load_study, question};

use crate::shipped;

const BASE: &str = "Scenario(name: \"base\", time_limit: 60.0, swarm: (robots: 20, deploy: Cluster(radius: 1.0)), \
    protocol: Backbone(targets: Ring(count: 2, radius: 3.0)))";

const STUDY: &str = r#"// Does it matter?
Study(
    name: "made-up",
    base: "base.ron",
    factors: [
        (
            name: "loss",
            paths: ["radio.loss"],
            levels: [(label: "none", values: [None]), (label: "some", values: [Bernoulli(0.2)])],
        ),
        (
            name: "status",
            paths: ["gossip.status.interval", "detector"],
            levels: [(values: [0.1, Timeout(2.0)]), (label: "slow", values: [0.5, Timeout(4.0)])],
        ),
    ],
    reference: ["none", "slow"],
    figure: "steps_to_completion",
    also: ["delivery_ratio"],
)
"#;

/// What a study in a folder beside `base.ron` is read as.
fn read(study: &str) -> Result<desim::scenario::Plan, Report> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("base.ron"), BASE).unwrap();
    let file = folder.path().join("study.ron");
    fs::write(&file, study).unwrap();
    load_study(&file)
}

/// What a person sees of `STUDY` with each of `changes` made, without the name of the folder.
fn shown(changes: &[(&str, &str)]) -> String {
    let mut study = STUDY.to_owned();
    for (from, to) in changes {
        assert!(study.contains(from), "{from}");
        study = study.replace(from, to);
    }
    let mut report = read(&study).expect_err("the study is wrong");
    for found in &mut report.diagnostics {
        if let Some(place) = &mut found.place {
            let name = Path::new(&place.name).file_name().unwrap();
            place.name = name.to_str().unwrap().to_owned();
        }
    }
    report.to_string()
}

#[test]
fn every_shipped_study_is_well_and_begins_with_its_question() {
    let studies = shipped::studies();
    assert!(studies.len() >= 3);
    for path in studies {
        let plan = load_study(&path).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(path.file_stem().unwrap().to_str(), Some(plan.name.as_str()));
        assert!(plan.reference.is_some(), "{}", path.display());
        let text = fs::read_to_string(&path).unwrap();
        assert!(
            question(&text).is_some_and(|question| question.ends_with('?')),
            "{}",
            path.display()
        );
    }
}

#[test]
fn a_full_design_has_every_combination_with_one_seed_and_whole_variants_as_levels() {
    let plan = read(STUDY).unwrap_or_else(|report| panic!("{report}"));
    let names: Vec<_> = plan.settings.iter().map(|setting| setting.name.as_str()).collect();
    assert_eq!(
        names,
        ["none_0-1-Timeout-2-0", "none_slow", "some_0-1-Timeout-2-0", "some_slow"]
    );
    assert_eq!(plan.reference, Some(1));
    assert_eq!(plan.figures, ["steps_to_completion", "delivery_ratio"]);
    let last = &plan.settings[3].scenario;
    assert_eq!(
        (last.seed, last.trials, last.gossip.status.interval.get()),
        (1, 35, 0.5)
    );
    assert_eq!(
        last.radio.disk().loss,
        desim::radio::LossConfig::Bernoulli(desim::quantity::Probability::new(0.2))
    );
}

#[test]
fn paired_and_explicit_designs_have_the_combinations_that_they_say() {
    let of = |design: &str| {
        let reference = "    reference: [\"none\", \"slow\"],\n";
        let study = STUDY.replace(reference, &format!("    design: {design},\n"));
        let plan = read(&study).unwrap_or_else(|report| panic!("{report}"));
        plan.settings
            .iter()
            .map(desim::scenario::Setting::label)
            .collect::<Vec<_>>()
    };
    assert_eq!(of("Paired"), ["none, 0.1, Timeout(2.0)", "some, slow"]);
    let explicit = r#"Explicit([["some", "slow"], ["none", "slow"]])"#;
    assert_eq!(of(explicit), ["some, slow", "none, slow"]);
}

#[test]
fn several_mistakes_are_named_at_once_each_on_its_line() {
    insta::assert_snapshot!(shown(&[
        ("name: \"made-up\"", "nome: \"made-up\""),
        ("label: \"none\"", "lable: \"none\""),
        ("figure: \"steps_to_completion\"", "figure: 7"),
    ]));
}

#[test]
fn a_level_that_the_scenario_does_not_take_is_named_once_in_the_study() {
    insta::assert_snapshot!(shown(&[
        ("Bernoulli(0.2)", "Bernoulli(1.2)"),
        ("radio.loss", "radio.lost")
    ]));
}

#[test]
fn a_level_out_of_range_is_named_once_in_the_study() {
    insta::assert_snapshot!(shown(&[("Bernoulli(0.2)", "Bernoulli(1.2)")]));
}

#[test]
fn a_combination_that_does_not_hold_is_named_with_its_levels() {
    insta::assert_snapshot!(shown(&[("[0.5, Timeout(4.0)]", "[5.0, Timeout(4.0)]")]));
}

#[test]
fn a_figure_that_no_setting_has_is_named_with_the_nearest() {
    insta::assert_snapshot!(shown(&[("\"delivery_ratio\"", "\"delivery_rate\"")]));
}

#[test]
fn a_figure_of_pairs_is_refused_where_no_setting_keeps_them() {
    let said = shown(&[("\"delivery_ratio\"", "\"pairs.age_mean_s\"")]);
    assert!(
        said.contains("`pairs.age_mean_s` is there only where all settings say"),
        "{said}"
    );
}

#[test]
fn a_base_that_is_not_there_is_named_at_its_field() {
    let said = shown(&[("base.ron", "bass.ron")]);
    assert!(said.contains("bass.ron") && said.contains("study.ron:4"), "{said}");
}

#[test]
fn what_makes_no_design_is_refused() {
    for (from, to, said) in [
        (
            "label: \"some\"",
            "label: \"none\"",
            "another level of the factor is called \"none\"",
        ),
        ("[\"none\", \"slow\"]", "[\"none\"]", "no combination of levels"),
        ("[0.5, Timeout(4.0)]", "[0.5]", "1 values for 2 paths"),
        ("radio.loss", "seed", "`seed` is the study's own"),
        ("radio.loss", "detector", "`detector` is set twice"),
        ("label: \"some\"", "label: \"λ\"", "has no folder"),
        ("label: \"some\"", "label: \"none.\"", "would share the folder"),
        ("radio.loss", "radio..loss", "is no path of a field"),
        (
            "name: \"status\"",
            "name: \"loss\"",
            "another factor is called \"loss\"",
        ),
    ] {
        let shown = shown(&[(from, to)]);
        let words = shown
            .split_whitespace()
            .map(|word| word.trim_matches('│'))
            .collect::<Vec<_>>()
            .join(" ");
        assert!(words.contains(said), "{to}: {shown}");
    }
}

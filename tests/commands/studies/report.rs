//! What people read of a comparison.

use std::path::Path;
use std::rc::Rc;

use desim::metrics::comparison::{Comparison, Design, Factor, Stopping, Trials};
use desim::metrics::figures::{Better, COMPLETION, Figure, Sample};
use desim::report::{ComparisonInput, comparison, describe, study_page};
use desim::statistics::Estimator;
use desim::text::{Style, columns};

fn figure(key: &str, name: &str, unit: &'static str, better: Better, is_ratio: bool) -> Figure {
    Figure {
        key: key.into(),
        name: name.into(),
        unit: unit.into(),
        better,
        is_ratio,
        estimator: match key {
            COMPLETION => Estimator::Count,
            _ if is_ratio => Estimator::Rate,
            _ => Estimator::Mean,
        },
    }
}

/// Twelve trials of three settings: the second sends half and takes as long, the third is slow and at times not done.
fn made_up(reference: Option<usize>, stopping: Option<Stopping>) -> Comparison {
    let steps = |shift: f64, limit: f64| {
        let sample = move |trial: u32| {
            let steps = 1250.0 + f64::from(trial * 37 % 91) + shift * f64::from(1 + trial % 4);
            Sample {
                part: [steps.min(limit), 1.0],
                is_censored: steps > limit,
                ..Sample::default()
            }
        };
        (0..12).map(sample).collect::<Vec<_>>()
    };
    let bytes = |mean: f64| {
        let sample = move |trial: u32| Sample {
            part: [mean + f64::from(trial % 5) / 50.0, 1.0],
            ..Sample::default()
        };
        (0..12).map(sample).collect::<Vec<_>>()
    };
    let mistakes = |rate: f64| {
        let sample = move |trial: u32| Sample {
            part: [(rate * f64::from(3 + trial % 3)).round(), 5000.0],
            ..Sample::default()
        };
        (0..12).map(sample).collect::<Vec<_>>()
    };
    let setting = |label: &str, samples: Vec<Vec<Sample>>| Trials {
        name: label.replace([' ', '.'], "-"),
        label: label.into(),
        levels: vec![label.into()],
        seed: 1,
        places: (0..samples.len()).collect(),
        samples: Rc::new(samples.into()),
    };
    let figures = vec![
        figure(
            "steps_to_completion",
            "steps to completion",
            "control steps",
            Better::Lower,
            false,
        ),
        figure(
            "bandwidth.tx_bytes_per_step.median",
            "bytes sent, median robot",
            "B/step",
            Better::Lower,
            false,
        ),
        figure(
            "detection.mistake_rate_hz",
            "mistake rate λ_M",
            "Hz",
            Better::Lower,
            true,
        ),
    ];
    let design = Design {
        study: "made-up".into(),
        question: Some("How rarely may robots repeat their status before the mission suffers from it?".into()),
        factors: vec![Factor {
            name: "status interval".into(),
            levels: ["0.1 s", "0.5 s", "2 s"].map(str::to_owned).to_vec(),
        }],
        compared: if reference.is_some() { vec![1, 0, 2] } else { vec![0, 1] },
        figures,
        reference,
        relevant: 0.05,
        pareto: Some([0, 1]),
    };
    let settings = [
        setting("0.1 s", vec![steps(0.0, 1600.0), bytes(18.0), mistakes(0.1)]),
        setting("0.5 s", vec![steps(-2.0, 1600.0), bytes(9.0), mistakes(0.1)]),
        setting("2 s", vec![steps(90.0, 1600.0), bytes(7.0), mistakes(9.0)]),
    ];
    let mut compared = Comparison::of(&design, &settings, stopping);
    describe(&mut compared);
    compared
}

fn shown(compared: &Comparison, style: Style) -> String {
    comparison(&ComparisonInput {
        comparison: compared,
        folder: Path::new("results/made-up"),
        files: &["comparison.json", "comparison.parquet", "study.json"],
        style,
    })
}

#[test]
fn the_report_of_a_study_with_a_reference() {
    insta::assert_snapshot!(shown(&made_up(Some(0), None), Style::PLAIN));
}

#[test]
fn the_report_of_a_study_without_a_reference_that_added_trials() {
    let stopping = Stopping {
        figure: "steps_to_completion".into(),
        width: 20.0,
        widest: Some(31.4),
        trials: 12,
        cap: 12,
        reached: false,
    };
    insta::assert_snapshot!(shown(&made_up(None, Some(stopping)), Style::PLAIN));
}

/// Four settings whose accuracies are about these in each of twelve trials, described; one that is not a number is of trials that have none.
fn told(accuracies: [f64; 4], reference: Option<usize>) -> Comparison {
    let design = Design {
        study: "made-up".into(),
        question: None,
        factors: vec![Factor {
            name: "patience".into(),
            levels: ["a", "b", "c", "d"].map(str::to_owned).to_vec(),
        }],
        compared: vec![0],
        figures: vec![figure("accuracy", "query accuracy", "1", Better::Higher, false)],
        reference,
        relevant: 0.05,
        pareto: None,
    };
    let settings = ["a", "b", "c", "d"]
        .iter()
        .zip(accuracies)
        .map(|(name, accuracy)| Trials {
            name: (*name).into(),
            label: (*name).into(),
            levels: vec![(*name).into()],
            seed: 1,
            places: vec![0],
            samples: Rc::new(
                vec![
                    (0..12)
                        .map(|trial| Sample {
                            part: if accuracy.is_nan() {
                                [0.0; 2]
                            } else {
                                [accuracy + f64::from(trial % 3) / 100.0, 1.0]
                            },
                            ..Sample::default()
                        })
                        .collect(),
                ]
                .into(),
            ),
        });
    let mut compared = Comparison::of(&design, &settings.collect::<Vec<_>>(), None);
    describe(&mut compared);
    compared
}

#[test]
fn of_equal_settings_none_is_called_the_highest_the_best_or_the_worst() {
    for reference in [None, Some(1)] {
        // Two of them differ by rounding.
        let finding = told([0.1 + 0.2, 0.3, 0.3, 0.3], reference).finding;
        assert!(
            finding.starts_with("All 4 settings have the same query accuracy: 0.31"),
            "{finding}"
        );
        for word in ["highest", "lowest", "best", "worst", "better"] {
            assert!(!finding.contains(word), "{finding}");
        }
    }
    let shared = told([0.3, 0.9, 0.9, 0.5], None).finding;
    assert!(
        shared.starts_with("b; c share the highest query accuracy: 0.91"),
        "{shared}"
    );
    assert!(shared.contains("They are detectably better than a; d."), "{shared}");
    let against = told([0.3, 0.9, 0.9, 0.3], Some(1)).finding;
    assert!(
        against.contains("No setting has a higher query accuracy than b"),
        "{against}"
    );
    assert!(
        against.contains("0 are better, 2 worse, 1 the same in every trial"),
        "{against}"
    );
    assert!(against.contains("a; d are worst"), "{against}");
}

#[test]
fn a_setting_without_a_value_is_neither_like_the_others_nor_one_to_hold_them_against() {
    let none = f64::NAN;
    let among = told([none, 0.3, 0.9, 0.3], None).finding;
    assert!(among.starts_with("c has the highest query accuracy: 0.91"), "{among}");
    assert!(
        among.contains("It is detectably better than b; d; not comparable with a."),
        "{among}"
    );
    let against = told([none, 0.3, 0.9, 0.3], Some(1)).finding;
    assert!(
        against.contains("1 is better, 0 worse, 1 the same in every trial, 1 cannot be compared, and 0 show no"),
        "{against}"
    );
    let nothing = told([none, 0.3, 0.9, 0.3], Some(0)).finding;
    assert!(
        nothing
            .starts_with("a has no value of query accuracy, so that nothing can be held against it. c has the highest"),
        "{nothing}"
    );
    let report = shown(&told([none, 0.3, 0.9, 0.3], Some(1)), Style::PLAIN);
    let report = report.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        report.contains("1 test, without 2 of what never differs or has no value"),
        "{report}"
    );
}

/// A detector or none by two losses: of none, no accuracy; of the others the same in each of eight trials.
fn with_and_without_a_detector(reference: Option<usize>) -> Comparison {
    let factor = |name: &str, levels: &[&str]| Factor {
        name: name.into(),
        levels: levels.iter().map(|&level| level.into()).collect(),
    };
    let factors = vec![
        factor("detector", &["none", "short", "long"]),
        factor("loss", &["0", "1"]),
    ];
    let design = Design {
        study: "made-up".into(),
        question: None,
        compared: vec![0],
        figures: vec![figure("accuracy", "query accuracy", "1", Better::Higher, false)],
        reference,
        relevant: 0.05,
        pareto: None,
        factors: factors.clone(),
    };
    let cells = factors[0]
        .levels
        .iter()
        .flat_map(|detector| factors[1].levels.iter().map(move |loss| [detector, loss]));
    let sample = |watched: f64, trial: u32| Sample {
        part: [watched * (0.5 + f64::from(trial % 3) / 100.0), watched],
        ..Sample::default()
    };
    let settings = cells.map(|levels| Trials {
        name: levels.map(String::as_str).join("_"),
        label: levels.map(String::as_str).join(", "),
        levels: levels.map(String::clone).to_vec(),
        seed: 1,
        places: vec![0],
        samples: Rc::new(
            vec![
                (0..8)
                    .map(|trial| sample(f64::from(levels[0] != "none"), trial))
                    .collect(),
            ]
            .into(),
        ),
    });
    let mut compared = Comparison::of(&design, &settings.collect::<Vec<_>>(), None);
    describe(&mut compared);
    compared
}

#[test]
fn of_a_factor_that_was_never_compared_it_is_not_said_that_it_has_no_effect() {
    let finding = with_and_without_a_detector(Some(0)).finding;
    assert!(
        finding.ends_with("Nothing can be averaged over the others, for a setting has no value."),
        "{finding}"
    );
    assert!(!finding.contains("no factor shows"), "{finding}");
    let finding = with_and_without_a_detector(None).finding;
    assert!(
        finding
            .ends_with("no factor shows a detectable effect. Of loss nothing can be said, for a setting has no value."),
        "{finding}"
    );
    let page = study_page(&with_and_without_a_detector(None), "desim 9.9", &[]);
    assert!(page.contains("The same wherever there is a value: 0.509"));
    assert!(!page.contains("The same everywhere"));
}

#[test]
fn every_difference_is_said_in_words() {
    let compared = made_up(Some(0), None);
    let words: Vec<&str> = compared.pairs.iter().map(|pair| pair.words.as_str()).collect();
    insta::assert_snapshot!(words.join("\n"));
}

#[test]
fn every_width_is_kept_and_used() {
    for reference in [Some(0), None] {
        for width in [60, 80, 100, 120, 160] {
            let report = |width| shown(&made_up(reference, None), Style { width, ..Style::PLAIN });
            let widest = report(width).lines().map(columns).max().unwrap_or(0);
            let is_used = widest + 20 > width || report(width) == report(1000);
            assert!(
                widest <= width && is_used,
                "{widest} of {width} columns:\n{}",
                report(width)
            );
        }
    }
}

#[test]
fn the_report_on_a_narrow_terminal() {
    insta::assert_snapshot!(shown(
        &made_up(Some(0), None),
        Style {
            width: 60,
            ..Style::PLAIN
        }
    ));
}

#[test]
fn a_comparison_reads_back_from_its_json() {
    let compared = made_up(Some(0), None);
    let json = serde_json::to_string(&compared).unwrap();
    let again: Comparison = serde_json::from_str(&json).unwrap();
    assert_eq!(again, compared);
}

/// Headings, captions and charts of a page, without its data.
fn outline(page: &str) -> String {
    let start = page.find("<body>").unwrap();
    let mut lines = Vec::new();
    for part in page[start..].split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap_or((part, ""));
        let name = tag.split(' ').next().unwrap_or_default();
        match name {
            "h1" | "h2" | "h3" | "figcaption" | "summary" | "p" | "li" if !text.trim().is_empty() => {
                lines.push(format!("{name}: {}", text.trim()));
            }
            "th" | "td" if !tag.contains("class") => lines.push(format!("{name}: {text}")),
            "div" if tag.contains("plotly-graph-div") => {
                lines.push(format!("chart: {}", tag.split('"').nth(1).unwrap_or_default()));
            }
            // The data of a figure: its head is enough.
            "tbody" if lines.iter().any(|line| line.starts_with("h3")) => lines.push("data".to_owned()),
            _ => {}
        }
    }
    let mut in_data = false;
    lines.retain(|line| {
        in_data = line == "data" || in_data && line.starts_with("td");
        !in_data
    });
    lines.join("\n")
}

#[test]
fn the_page_of_a_study_with_a_reference() {
    insta::assert_snapshot!(outline(&study_page(&made_up(Some(0), None), "desim 9.9", &[])));
}

#[test]
fn the_page_of_a_study_has_a_figure_for_each_comparison_with_its_data_and_asks_for_nothing_from_outside() {
    let page = study_page(&made_up(None, None), "desim 9.9", &[]);
    let figures = page.matches("<figure ").count();
    assert_eq!(
        figures, 6,
        "two figures by setting and by difference, the curves, the front"
    );
    assert_eq!(page.matches("href=\"data:text/csv;").count(), figures);
    assert_eq!(page.matches("class=\"plotly-graph-div\"").count(), figures);
    assert!(page.contains("default-src 'none'"));
    assert_eq!(page, study_page(&made_up(None, None), "desim 9.9", &[]));
}

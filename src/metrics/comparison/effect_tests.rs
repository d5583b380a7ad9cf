//! Factors whose effects are known, and families of which some tests cannot show anything.

use super::tests::{design, figure, normal, plain};
use super::*;
use crate::metrics::figures::Better;

/// A full design of factors with so many levels, labelled by their numbers.
fn full(sizes: &[u32], figures: Vec<Figure>, reference: Option<usize>) -> (Design, Vec<Vec<u32>>) {
    let factors = sizes.iter().zip('a'..).map(|(&size, name)| Factor {
        name: name.to_string(),
        levels: (0..size).map(|level| level.to_string()).collect(),
    });
    let design = Design {
        factors: factors.collect(),
        reference,
        ..design(figures)
    };
    let settings = sizes.iter().fold(vec![Vec::new()], |settings, &size| {
        let with = |setting: &Vec<u32>, level| setting.iter().copied().chain([level]).collect();
        settings
            .iter()
            .flat_map(|setting| (0..size).map(move |level| with(setting, level)))
            .collect()
    });
    (design, settings)
}

/// Trials of a setting with these levels.
fn setting(levels: &[u32], samples: Vec<Vec<Sample>>) -> Trials {
    let levels: Vec<String> = levels.iter().map(u32::to_string).collect();
    Trials {
        name: levels.join("_"),
        label: levels.join(", "),
        levels,
        seed: 1,
        places: (0..samples.len()).collect(),
        samples: Rc::new(samples.into()),
    }
}

/// `10 + 0.15 a − 0.1 b + 0.45 (a = 2)(b = 1)`, and a noise of its own of eight trials.
fn made_up(a: u32, b: u32) -> Vec<f64> {
    let trial = |t: u32| {
        let noise = f64::from((7 * t + 3 * a * a + 5 * b) % 11) / 10.0
            + f64::from((3 * t * t + a * (t + 1) * (2 + b)) % 7) / 8.0
            + f64::from(t) / 2.0;
        let bend = if a == 2 && b == 1 { 0.45 } else { 0.0 };
        10.0 + 0.15 * f64::from(a) - 0.1 * f64::from(b) + bend + noise
    };
    (0..8).map(trial).collect()
}

fn near(found: Option<f64>, expected: f64) {
    let found = found.expect("a value");
    assert!((found - expected).abs() < 1e-6, "{found} instead of {expected}");
}

#[test]
fn effects_and_interactions_are_those_of_statsmodels_and_scipy() {
    // y by a, b and t as above; m = smf.ols("y ~ C(a, Treatment(0)) * C(b, Treatment(0))", df).fit().params: the interaction [T.2]:[T.1] is 0.48125.
    // d = (y[l, 0] + y[l, 1])/2 − (y[r, 0] + y[r, 1])/2; on either side the farther end of stats.ttest_1samp(d, 0).confidence_interval() and of Hall's
    // interval: g the skewness of the mean of d, t = stats.t.ppf(0.975, 7), mean − se · 3/g (cbrt(1 + g (±t − g/6)) − 1). p over itertools.product([1, −1], repeat=8).
    // R = E − E.mean(2) − E.mean(1) + E.mean((1, 2)) of E[t, a, b]; (s @ R)² summed over all 2⁸ signs s.
    let (design, settings) = full(&[3, 2], vec![figure("bytes", Better::Lower, false)], Some(0));
    let trials: Vec<Trials> = settings
        .iter()
        .map(|levels| setting(levels, vec![plain(made_up(levels[0], levels[1]))]))
        .collect();
    let compared = Comparison::of(&design, &trials, None);
    assert_eq!((compared.pairs.len(), compared.effects.len()), (5, 3));
    let expected = [
        (-0.004_687_5, [-0.366_563_172, 0.404_933_300], 254.0),
        (0.456_25, [-0.045_209_404, 0.866_233_732], 10.0),
        (0.015_625, [-0.462_512_122, 0.478_778_661], 244.0),
    ];
    for (effect, (difference, [low, high], ways)) in compared.effects.iter().zip(expected) {
        near(effect.difference.value, difference);
        near(effect.difference.ci95[0], low);
        near(effect.difference.ci95[1], high);
        assert_eq!(effect.p, Some(ways / 256.0));
    }
    let [interaction] = &compared.interactions[..] else {
        panic!("one interaction")
    };
    near(interaction.difference.value, 0.481_25);
    near(interaction.difference.ci95[0], -0.072_825_079);
    near(interaction.difference.ci95[1], 1.205_824_582);
    assert_eq!(interaction.p, Some(58.0 / 256.0));
    assert_eq!(
        (&interaction.first, &interaction.second),
        (&["2".into(), "0".into()], &["1".into(), "0".into()])
    );
    near(interaction.steps[0], 0.215_625 + 0.481_25);
    near(interaction.steps[1], 0.215_625);
    // The means of a's levels: the intercept less or plus the coefficients of C(a, Sum).
    for (mean, expected) in compared.level_means.iter().zip([12.6375, 12.632_813, 13.09375]) {
        assert!((mean.mean.value.unwrap() - expected).abs() < 1e-6, "{mean:?}");
    }
    // Without a reference also 2 against 1, with the least p-value of eight trials, and no setting against another.
    let alone = Design {
        reference: None,
        ..design
    };
    let compared = Comparison::of(&alone, &trials, None);
    assert_eq!((compared.pairs.len(), compared.effects.len()), (0, 4));
    assert_eq!(
        (compared.effects[2].against.as_str(), compared.effects[2].p),
        ("1", Some(2.0 / 256.0))
    );
    near(compared.effects[2].difference.value, 0.460_937_5);
}

#[test]
fn what_is_averaged_over_a_third_factor_is_the_mean_over_its_levels() {
    let (design, settings) = full(&[2, 2, 3], vec![figure("bytes", Better::Lower, false)], None);
    let value = |levels: &[u32]| f64::from(4 * levels[0] + 2 * levels[1] * levels[2] + 7 * levels[2]);
    let trials: Vec<Trials> = settings
        .iter()
        .map(|levels| {
            setting(
                levels,
                vec![plain((0..12).map(|trial| value(levels) + f64::from(trial)))],
            )
        })
        .collect();
    let compared = Comparison::of(&design, &trials, None);
    let of = |factor: &str, level: &str, against: &str| {
        let is_it = |effect: &&Effect| effect.factor == factor && effect.level == level && effect.against == against;
        compared.effects.iter().find(is_it).expect("an effect").difference.value
    };
    near(of("a", "1", "0"), 4.0);
    near(of("b", "1", "0"), 2.0);
    near(of("c", "2", "1"), 8.0);
    let verdicts: Vec<Dependence> = compared.interactions.iter().map(|it| it.verdict).collect();
    let [none, depends] = [Dependence::NoDetectableDependence, Dependence::Depends];
    assert_eq!(verdicts, [none, none, depends]);
    assert_eq!(
        compared.interactions[0].p_adjusted, None,
        "a and b add up in every trial"
    );
    near(compared.interactions[2].difference.value, 4.0);
    assert_eq!(compared.interactions[2].factors, ["b".to_owned(), "c".to_owned()]);
}

#[test]
fn ratios_of_sums_have_effects_too_and_a_setting_without_a_value_has_none() {
    let (design, settings) = full(&[2, 2], vec![figure("rate", Better::Lower, true)], Some(0));
    let trial = |levels: &[u32], trial: u32| Sample {
        part: [
            f64::from((levels[0] * 3 + 1) * (1 + trial % 3)),
            f64::from(50 + 10 * (trial % 2)),
        ],
        ..Sample::default()
    };
    let of = |levels: &Vec<u32>| setting(levels, vec![(0..12).map(|number| trial(levels, number)).collect()]);
    let mut trials: Vec<Trials> = settings.iter().map(of).collect();
    let compared = Comparison::of(&design, &trials, None);
    // Four times the events over the same time: 3 · Σ(1 + t mod 3)/Σ(50 + 10 (t mod 2)) = 3 · 24/660.
    near(compared.effects[0].difference.value, 72.0 / 660.0);
    // d = R₁ − R₀ + ((a₁ − R₁ b) − (a₀ − R₀ b))/55 of each trial, not skewed; stats.ttest_1samp(d, 0).confidence_interval().
    near(compared.effects[0].difference.ci95[0], 0.078_811_815);
    near(compared.effects[0].difference.ci95[1], 0.139_370_004);
    assert_eq!(
        (compared.effects[0].verdict, compared.effects[0].p),
        (Verdict::Worse, Some(2.0 / 4096.0))
    );
    near(compared.effects[1].difference.value, 0.0);
    trials[3].samples = Rc::new(vec![vec![Sample::default(); 12]].into());
    let compared = Comparison::of(&design, &trials, None);
    assert!(
        compared
            .effects
            .iter()
            .all(|effect| effect.verdict == Verdict::NotComparable)
    );
    assert_eq!(compared.interactions[0].verdict, Dependence::NotComparable);
    assert_eq!(
        compared.pairs[1].verdict,
        Verdict::Worse,
        "other settings are compared all the same"
    );
}

/// A study of 3 × 2 settings and two figures of ten trials each, whose first figure gains `effect` at the second level of b, and `bend` where
/// also a is at its third.
fn study(repetition: u32, effect: f64, bend: f64) -> Comparison {
    let figures = ["bytes", "steps"].map(|key| figure(key, Better::Lower, false));
    let (design, settings) = full(&[3, 2], figures.into(), None);
    let trials: Vec<Trials> = (0..)
        .zip(&settings)
        .map(|(place, levels): (u32, _)| {
            let values = |number: u32, shift: f64| {
                let (shared, own) = (
                    normal(1000 * repetition + number, 10),
                    normal(1000 * repetition + 10 + 2 * place + number, 10),
                );
                // Settings differ in how much they vary.
                let spread = 1.0 + f64::from(place) / 3.0;
                plain(
                    shared
                        .iter()
                        .zip(own)
                        .map(|(shared, own)| 20.0 + 3.0 * shared + spread * own + shift)
                        .collect::<Vec<_>>(),
                )
            };
            let bent = if levels[0] == 2 { bend } else { 0.0 };
            let shift = if levels[1] == 1 { effect + bent } else { 0.0 };
            setting(levels, vec![values(0, shift), values(1, 0.0)])
        })
        .collect();
    Comparison::of(&design, &trials, None)
}

#[test]
fn of_studies_whose_factors_do_nothing_one_in_twenty_claims_anything_at_most() {
    // Holm over 2 · (3 + 1 + 1) tests: at most 0.05 of studies. Of 100, 10 or more have probability 0.03 at that rate (scipy.stats.binom.sf(9, 100, 0.05)).
    let claims = |compared: &Comparison| {
        compared
            .effects
            .iter()
            .any(|effect| matches!(effect.verdict, Verdict::Better | Verdict::Worse))
            || compared
                .interactions
                .iter()
                .any(|interaction| interaction.verdict == Dependence::Depends)
    };
    let studies: Vec<Comparison> = (0..100).map(|repetition| study(repetition, 0.0, 0.0)).collect();
    assert!(studies.iter().all(|study| study.family.tests == 10));
    let wrong = studies.iter().filter(|study| claims(study)).count();
    assert!(wrong < 10, "{wrong} of 100");
    // Each test by itself errs in one of twenty: 1,000 of them, of which those of one study share their trials: 50 ± 3·√(1000·0.05·0.95·2) = 29.
    let p = studies.iter().flat_map(|study| {
        study
            .effects
            .iter()
            .map(|it| it.p)
            .chain(study.interactions.iter().map(|it| it.p))
    });
    let small = p.filter(|p| p.is_some_and(|p| p <= 0.05)).count();
    assert!((21..=79).contains(&small), "{small} of 1,000");
}

#[test]
fn a_factor_that_matters_is_found_and_whether_that_depends_on_the_other_only_if_it_does() {
    let found = |bend: f64| {
        let studies: Vec<Comparison> = (0..20).map(|repetition| study(repetition, 6.0, bend)).collect();
        let effect = |study: &Comparison| study.effects[3].verdict == Verdict::Worse && study.effects[3].factor == "b";
        let depends = |study: &Comparison| study.interactions[0].verdict == Dependence::Depends;
        [
            studies.iter().filter(|study| effect(study)).count(),
            studies.iter().filter(|study| depends(study)).count(),
        ]
    };
    let [effects, dependent] = found(0.0);
    assert!(effects == 20 && dependent <= 4, "{effects}, {dependent} of 20");
    let [effects, dependent] = found(20.0);
    assert!(effects == 20 && dependent == 20, "{effects}, {dependent} of 20");
}

#[test]
fn figures_that_are_the_same_in_all_settings_leave_the_family_and_a_clear_difference_stays_clear() {
    // Five settings of nine trials, pair by pair in three figures. One figure is the same everywhere, one is absent, one differs clearly: of 30 tests
    // ten are left, and 10 · 2/2⁹ = 0.039. Over all 30, p would be 0.12.
    let figures = ["bytes", "duplicates", "mistakes"].map(|key| figure(key, Better::Lower, false));
    let mut design = design(figures.into());
    design.reference = None;
    let settings: Vec<Trials> = (0..5_u32)
        .map(|place| {
            let clear = (0..9).map(|trial| f64::from(place) + f64::from(trial % 4) / 10.0);
            let absent = vec![Sample::default(); 9];
            setting(&[place], vec![plain(vec![18.0; 9]), absent, plain(clear)])
        })
        .collect();
    let compared = Comparison::of(&design, &settings, None);
    assert_eq!(compared.pairs.len(), 30);
    let family = &compared.family;
    assert_eq!(
        (family.tests, family.alike, family.impossible, family.trials_needed),
        (10, 20, 0, Some(9))
    );
    for pair in &compared.pairs {
        let expected = match pair.figure.as_str() {
            "bytes" => (None, Verdict::NoDetectableDifference),
            "duplicates" => (None, Verdict::NotComparable),
            _ => (Some(10.0 * 2.0 / 512.0), Verdict::Worse),
        };
        assert_eq!((pair.p_adjusted, pair.verdict), expected, "{}", pair.figure);
    }
}

#[test]
fn with_too_few_trials_nothing_can_be_told_and_the_comparison_says_how_many_are_needed() {
    let mut design = design(vec![figure("mistakes", Better::Lower, false)]);
    design.reference = None;
    let settings = |trials: u32| -> Vec<Trials> {
        (0..5_u32)
            .map(|place| {
                setting(
                    &[place],
                    vec![plain((0..trials).map(|trial| f64::from(9 * place + trial % 3)))],
                )
            })
            .collect()
    };
    let few = Comparison::of(&design, &settings(8), None);
    assert!(
        few.pairs
            .iter()
            .all(|pair| pair.verdict == Verdict::CannotTell && pair.p == Some(2.0 / 256.0))
    );
    assert_eq!(
        (few.family.tests, few.family.impossible, few.family.trials_needed),
        (0, 10, Some(9))
    );
    let enough = Comparison::of(&design, &settings(9), None);
    assert!(enough.pairs.iter().all(|pair| pair.verdict == Verdict::Worse));
}

#[test]
fn settings_that_differ_by_rounding_alone_are_neither_better_nor_on_the_front_alone() {
    let mut design = design(["x", "y"].map(|key| figure(key, Better::Lower, false)).into());
    design.pareto = Some([0, 1]);
    let values = |shift: f64| plain((0..12).map(|trial| 0.1 + 0.2 + f64::from(trial % 3) + shift));
    let (exact, rounded) = (values(0.0), values(f64::EPSILON));
    let settings = [
        setting(&[0], vec![exact.clone(), exact.clone()]),
        setting(&[1], vec![rounded.clone(), rounded]),
        setting(&[2], vec![exact.clone(), exact]),
    ];
    let compared = Comparison::of(&design, &settings, None);
    assert!(
        compared
            .pairs
            .iter()
            .all(|pair| pair.verdict == Verdict::NoDetectableDifference && pair.p == Some(1.0))
    );
    assert!(compared.pareto.unwrap().points.iter().all(|point| point.on_front));
}

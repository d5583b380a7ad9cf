//! Comparisons of made-up trials whose truth is known.

use rand_distr::{Distribution, StandardNormal};
use rand_philox::Philox;

use super::*;
use crate::engine::{Purpose, Streams};
use crate::metrics::figures::Better;
use crate::statistics::Estimator;

pub(super) fn figure(key: &str, better: Better, is_ratio: bool) -> Figure {
    Figure {
        key: key.to_owned(),
        name: key.to_owned(),
        unit: "B".into(),
        better,
        is_ratio,
        estimator: if is_ratio { Estimator::Rate } else { Estimator::Mean },
    }
}

/// A design of these figures, all of them tested, the first setting the reference.
pub(super) fn design(figures: Vec<Figure>) -> Design {
    Design {
        study: "made-up".into(),
        question: None,
        factors: Vec::new(),
        compared: (0..figures.len()).collect(),
        figures,
        reference: Some(0),
        relevant: 0.05,
        pareto: None,
    }
}

pub(super) fn plain(values: impl IntoIterator<Item = f64>) -> Vec<Sample> {
    let sample = |value| Sample {
        part: [value, 1.0],
        ..Sample::default()
    };
    values.into_iter().map(sample).collect()
}

fn trials(name: &str, seed: u64, samples: Vec<Vec<Sample>>) -> Trials {
    Trials {
        name: name.into(),
        label: name.into(),
        levels: Vec::new(),
        seed,
        places: (0..samples.len()).collect(),
        samples: Rc::new(samples.into()),
    }
}

/// Standard normal numbers, those of `stream` the same each time.
pub(super) fn normal(stream: u32, count: usize) -> Vec<f64> {
    let mut random: Philox = Streams::new(7, 0)
        .keyed(Purpose::new("test.comparison"))
        .at(stream, 0, 0);
    (0..count).map(|_| StandardNormal.sample(&mut random)).collect()
}

/// Bytes of `count` trials: what trials of one number share has thrice the spread of what is a setting's own.
fn bytes(stream: u32, own: u32, count: usize, shift: f64) -> Vec<Sample> {
    let (shared, own) = (normal(stream, count), normal(own, count));
    let half = std::f64::consts::FRAC_1_SQRT_2;
    plain(
        shared
            .iter()
            .zip(own)
            .map(|(shared, own)| 10.0 + 3.0 * shared + half * own + shift),
    )
}

fn pairs(design: &Design, trials: &[Trials]) -> Vec<Pair> {
    Comparison::of(design, trials, None).pairs
}

fn claims(design: &Design, a: &Trials, b: &Trials) -> bool {
    let [pair] = &pairs(design, &[a.clone(), b.clone()])[..] else {
        panic!("one pair")
    };
    matches!(pair.verdict, Verdict::Better | Verdict::Worse)
}

#[test]
fn a_setting_against_itself_with_other_seeds_is_called_different_in_one_case_of_twenty() {
    // 200 repetitions at the level 0.05: 4 to 17 of them, scipy.stats.binom.ppf([0.025, 0.975], 200, 0.05).
    let design = design(vec![figure("bytes", Better::Lower, false)]);
    let independent = (0..200).filter(|&repetition| {
        let a = trials("a", 1, vec![bytes(4 * repetition, 4 * repetition + 1, 20, 0.0)]);
        let b = trials("b", 2, vec![bytes(4 * repetition + 2, 4 * repetition + 3, 20, 0.0)]);
        claims(&design, &a, &b)
    });
    let independent = independent.count();
    assert!((4..=17).contains(&independent), "{independent} of 200");
}

#[test]
fn settings_that_share_their_random_numbers_and_do_not_differ_are_called_different_in_one_case_of_twenty() {
    let design = design(vec![figure("bytes", Better::Lower, false)]);
    let paired = (0..200).filter(|&repetition| {
        let of = |name, own| trials(name, 1, vec![bytes(3 * repetition, 3 * repetition + own, 20, 0.0)]);
        claims(&design, &of("a", 1), &of("b", 2))
    });
    let paired = paired.count();
    assert!((4..=17).contains(&paired), "{paired} of 200");
}

#[test]
fn a_known_shift_is_found_as_often_as_the_planner_said() {
    // A shift of 0.5 B is 5 % of 10 B, and the deviation of differences 1 B: 34 trials with power 0.8. Of 200 studies of that
    // size 149 to 171 find it, scipy.stats.binom.ppf([0.025, 0.975], 200, 0.8).
    let design = design(vec![figure("bytes", Better::Lower, false)]);
    let study = |first: u32, count: usize| {
        [0.0, 0.5].map(|shift| {
            let own = first + if shift > 0.0 { 1 } else { 2 };
            trials(&shift.to_string(), 1, vec![bytes(first, own, count, shift)])
        })
    };
    let pilot = pairs(&design, &study(100_000, 2000));
    let planned = pilot[0].plan.as_ref().expect("the pilot has a variance").trials as usize;
    assert!((31..=37).contains(&planned), "{planned}");
    let found = (0..200).filter(|&repetition| {
        let [a, b] = study(3 * repetition, planned);
        claims(&design, &a, &b)
    });
    let found = found.count();
    assert!((149..=171).contains(&found), "{found} of 200 with {planned} trials");
}

#[test]
fn common_random_numbers_gain_what_the_variances_say() {
    // Var X + Var Y = 2 (9 + 1/2) = 19 against Var (X − Y) = 1. The ratio of two variances of 500 trials is known to about
    // √(2/500 + 2/1000) = 8 %.
    let design = design(vec![figure("bytes", Better::Lower, false)]);
    let of = |name, own| trials(name, 1, vec![bytes(1, own, 500, 0.0)]);
    let compared = Comparison::of(&design, &[of("a", 2), of("b", 3)], None);
    let gain = compared.pairs[0].gain.as_ref().expect("pairs");
    let ratio = gain.ratio.expect("pairs vary");
    assert!((ratio / 19.0 - 1.0).abs() < 0.24, "{gain:?}");
    let apart = Comparison::of(
        &design,
        &[of("a", 2), trials("b", 2, vec![bytes(9, 8, 500, 0.0)])],
        None,
    );
    assert!(!apart.paired && apart.pairs[0].gain.is_none() && apart.pairs[0].tests.mann_whitney.is_some());
}

#[test]
fn what_was_cut_off_counts_with_the_shortest_time_watched_in_vain_and_is_never_left_out() {
    let design = design(vec![figure(crate::metrics::figures::COMPLETION, Better::Lower, false)]);
    let seen = |values: &[(f64, bool)]| {
        let sample = |&(value, is_censored)| Sample {
            part: [value, 1.0],
            is_censored,
            ..Sample::default()
        };
        vec![values.iter().map(sample).collect()]
    };
    let a = trials("a", 1, seen(&[(100.0, false), (200.0, false), (400.0, true)]));
    let b = trials("b", 1, seen(&[(150.0, false), (600.0, true), (500.0, false)]));
    let compared = Comparison::of(&design, &[a, b], None);
    let [a, b] = &compared.settings[..] else {
        panic!("two settings")
    };
    let of = |setting: &Setting| setting.figures.0[0].1.clone();
    assert_eq!(of(a).estimate.value, Some(700.0 / 3.0));
    assert_eq!(of(b).estimate.value, Some(950.0 / 3.0), "400 for both that took longer");
    let survival = of(b).survival.expect("it may be cut off");
    assert_eq!(
        (survival.censored, survival.median.value),
        (1, Some(500.0)),
        "each setting's own curve is not restricted by the others"
    );
    let difference = compared.pairs[0].difference.value.expect("both have a value");
    assert!((difference - 250.0 / 3.0).abs() < 1e-9, "{difference}");
}

#[test]
fn a_ratio_of_sums_weighs_each_trial_by_what_it_watched() {
    let design = design(vec![figure("rate", Better::Lower, true)]);
    let sample = |part| Sample {
        part,
        ..Sample::default()
    };
    let of = |name, parts: [[f64; 2]; 4]| trials(name, 1, vec![parts.map(sample).to_vec()]);
    let a = of("a", [[1.0, 100.0], [0.0, 50.0], [2.0, 100.0], [1.0, 50.0]]);
    let b = of("b", [[4.0, 100.0], [2.0, 50.0], [5.0, 100.0], [1.0, 50.0]]);
    let compared = Comparison::of(&design, &[a, b], None);
    let figures = compared.settings[1].figures.0[0].1.clone();
    assert_eq!((figures.estimate.value, figures.median), (Some(0.04), None));
    let pair = &compared.pairs[0];
    assert!((pair.difference.value.expect("both have a value") - 12.0 / 300.0 + 4.0 / 300.0).abs() < 1e-12);
    assert_eq!(pair.verdict, Verdict::CannotTell, "four pairs cannot show a difference");
}

#[test]
fn the_front_holds_what_no_other_beats() {
    let mut design = design(vec![
        figure("time", Better::Lower, false),
        figure("accuracy", Better::Higher, false),
    ]);
    design.pareto = Some([0, 1]);
    let places = [(1.0, 0.9), (2.0, 0.95), (2.0, 0.8), (3.0, 0.95), (4.0, 0.99)];
    let settings = places.map(|(x, y)| trials(&format!("{x} {y}"), 1, vec![plain([x, x]), plain([y, y])]));
    let compared = Comparison::of(&design, &settings, None);
    let front: Vec<bool> = compared
        .pareto
        .expect("asked for")
        .points
        .iter()
        .map(|point| point.on_front)
        .collect();
    assert_eq!(front, [true, true, false, false, true]);
}

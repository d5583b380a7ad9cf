//! Data of known distributions, and the intervals of each kind that are made from them.

use rand_distr::{Beta, Binomial, Distribution, Exp1, Gamma, LogNormal, Poisson, StandardNormal};
use rand_philox::Philox;

use super::super::*;

/// A data set of `n` trials, made up: its interval and the truth.
pub(super) type Simulate = Box<dyn Fn(&mut Philox, usize) -> (Ci95, f64)>;

/// Data of one distribution for one kind of interval.
pub(super) struct Case {
    pub(super) kind: &'static str,
    pub(super) data: &'static str,
    /// Whether its coverage is to lie in 93 to 97.5 % for each number of trials; else at least 93 %, over the cases of the kind.
    pub(super) continuous: bool,
    pub(super) simulate: Simulate,
}

/// A distribution, its mean and its median.
type Law = (&'static str, fn(&mut Philox) -> f64, f64, f64);

fn normal(random: &mut Philox) -> f64 {
    StandardNormal.sample(random)
}

fn exponential(random: &mut Philox) -> f64 {
    Exp1.sample(random)
}

fn gamma(random: &mut Philox) -> f64 {
    Gamma::new(4.0, 1.0).unwrap().sample(random)
}

fn log_normal(random: &mut Philox) -> f64 {
    LogNormal::new(0.0, 0.5).unwrap().sample(random)
}

fn uniform(random: &mut Philox) -> f64 {
    Beta::new(1.0, 1.0).unwrap().sample(random)
}

fn poisson(random: &mut Philox, mean: f64) -> f64 {
    Poisson::new(mean).unwrap().sample(random)
}

/// Far enough from zero that no bound helps.
const FAR: f64 = 20.0;

/// What values of a trial look like: symmetric, skewed as sums of a few are, and skewed as single waiting times are.
const LAWS: [Law; 5] = [
    ("uniform", uniform, 0.5, 0.5),
    ("normal", normal, 0.0, 0.0),
    ("gamma, skewness 1", gamma, 4.0, 3.672_060_748_850_897),
    (
        "log-normal, σ 0.5, skewness 1.75",
        log_normal,
        1.133_148_453_066_826_3,
        1.0,
    ),
    ("exponential, skewness 2", exponential, 1.0, std::f64::consts::LN_2),
];

fn case(
    kind: &'static str,
    data: &'static str,
    continuous: bool,
    simulate: impl Fn(&mut Philox, usize) -> (Ci95, f64) + 'static,
) -> Case {
    Case {
        kind,
        data,
        continuous,
        simulate: Box::new(simulate),
    }
}

fn plain(random: &mut Philox, n: usize, value: impl Fn(&mut Philox) -> f64) -> Vec<Part> {
    (0..n).map(|_| [value(random), 1.0]).collect()
}

fn means(cases: &mut Vec<Case>) {
    for (data, law, mean, _) in LAWS {
        cases.push(case("mean", data, true, move |random, n| {
            let parts = plain(random, n, |random| FAR + law(random));
            (Estimator::Mean.estimate(&parts).ci95, FAR + mean)
        }));
        cases.push(case("difference of means, paired", data, true, move |random, n| {
            let shared: Vec<f64> = (0..n).map(|_| FAR + 3.0 * normal(random)).collect();
            let mut of = |shift: f64| {
                shared
                    .iter()
                    .map(|shared| [shared + law(random) + shift, 1.0])
                    .collect::<Vec<_>>()
            };
            let (a, b) = (of(0.0), of(1.0));
            (difference(Estimator::Mean, [&a, &b], true).ci95, 1.0)
        }));
        cases.push(case("difference of means, unpaired", data, true, move |random, n| {
            let a = plain(random, n, |random| FAR + law(random));
            let b = plain(random, n, |random| FAR + 1.5 * law(random));
            (difference(Estimator::Mean, [&a, &b], false).ci95, mean / 2.0)
        }));
    }
    // Single waiting times against what does not vary: as skewed as differences come.
    cases.push(case(
        "difference of means, one of them fixed",
        "exponential, skewness 2",
        false,
        |random, n| {
            let a = vec![[FAR, 1.0]; n];
            let b = plain(random, n, |random| FAR + exponential(random));
            (difference(Estimator::Mean, [&a, &b], true).ci95, 1.0)
        },
    ));
    cases.push(case(
        "mean, of a very skewed quantity",
        "log-normal, σ 1, skewness 6.2",
        false,
        |random, n| {
            let parts = plain(random, n, |random| {
                FAR + LogNormal::new(0.0, 1.0).unwrap().sample(random)
            });
            (Estimator::Mean.estimate(&parts).ci95, FAR + 0.5_f64.exp())
        },
    ));
    for mean in [3.0, 10.0] {
        cases.push(case(
            "mean of counts",
            "Poisson, mean 3 and 10",
            false,
            move |random, n| {
                let parts = plain(random, n, |random| poisson(random, mean));
                (Estimator::Count.estimate(&parts).ci95, mean)
            },
        ));
    }
    for share in [0.1, 0.3, 0.5] {
        cases.push(case(
            "mean of counts",
            "five, or with a probability six",
            false,
            move |random, n| {
                let parts = plain(random, n, |random| if uniform(random) < share { 6.0 } else { 5.0 });
                (Estimator::Count.estimate(&parts).ci95, 5.0 + share)
            },
        ));
    }
}

/// Times of some mistakes, a trial having about `number` of them: exponential, cut off at a uniform end if `end` says how far that is.
fn times(random: &mut Philox, n: usize, number: f64, end: Option<f64>) -> Vec<Times> {
    let time = |random: &mut Philox| {
        let (time, end) = (
            exponential(random),
            end.map_or(f64::INFINITY, |end| end * uniform(random)),
        );
        Observation {
            time: time.min(end),
            happened: time <= end,
        }
    };
    (0..n)
        .map(|_| (0..poisson(random, number) as usize).map(|_| time(random)).collect())
        .collect()
}

fn restricted(random: &mut Philox, n: usize, number: f64, end: Option<f64>) -> (Vec<Part>, f64) {
    let times = times(random, n, number, end);
    let (parts, lasting) = pseudo_values(&times);
    let truth = lasting.restricted_to.map_or(1.0, |longest| 1.0 - f64::exp(-longest));
    (parts, truth)
}

fn mean_times(cases: &mut Vec<Case>) {
    for (data, number, end) in [
        ("some 10 exponential times a trial", 10.0, None),
        ("the same, a third of them cut off", 10.0, Some(3.0)),
        ("some 100 exponential times a trial", 100.0, None),
        ("the same, a third of them cut off", 100.0, Some(3.0)),
    ] {
        cases.push(case("mean of times", data, true, move |random, n| {
            let (parts, truth) = restricted(random, n, number, end);
            (Estimator::Times.estimate(&parts).ci95, truth)
        }));
    }
}

fn shares(cases: &mut Vec<Case>) {
    for (data, a, b) in [
        ("beta, mean 0.5", 2.0, 2.0),
        ("beta, mean 0.9", 9.0, 1.0),
        ("beta, mean 0.99", 49.5, 0.5),
    ] {
        let shares = move |random: &mut Philox, n| plain(random, n, |random| Beta::new(a, b).unwrap().sample(random));
        cases.push(case("share", data, false, move |random, n| {
            (Estimator::Share.estimate(&shares(random, n)).ci95, a / (a + b))
        }));
        cases.push(case("difference of shares", data, false, move |random, n| {
            let (first, second) = (shares(random, n), shares(random, n));
            (difference(Estimator::Share, [&first, &second], false).ci95, 0.0)
        }));
    }
    let yes =
        |random: &mut Philox, n, share: f64| plain(random, n, |random| f64::from(u8::from(uniform(random) < share)));
    cases.push(case(
        "proportion",
        "yes or no, any probability",
        false,
        move |random, n| {
            let share = uniform(random);
            (Estimator::Share.estimate(&yes(random, n, share)).ci95, share)
        },
    ));
    cases.push(case(
        "difference of proportions",
        "yes or no, any two probabilities",
        false,
        move |random, n| {
            let shares = [uniform(random), uniform(random)];
            let [first, second] = shares.map(|share| yes(random, n, share));
            (
                difference(Estimator::Share, [&first, &second], false).ci95,
                shares[1] - shares[0],
            )
        },
    ));
    cases.push(case(
        "share of things",
        "binomial, of 50 a trial, any probability",
        false,
        move |random, n| {
            let share = uniform(random);
            let law = Binomial::new(50, share).unwrap();
            let parts: Vec<Part> = (0..n).map(|_| [law.sample(random) as f64, 50.0]).collect();
            (Estimator::ShareOf.estimate(&parts).ci95, share)
        },
    ));
}

fn rates(cases: &mut Vec<Case>) {
    for events in [0.1, 0.3, 1.0, 3.0, 10.0, 50.0] {
        let rate = events / 100.0;
        let trials = move |random: &mut Philox, n: usize, clustered: bool| -> Vec<Part> {
            let trial = |random: &mut Philox| {
                let factor = if clustered { gamma(random) / 4.0 } else { 1.0 };
                [poisson(random, events * factor), 100.0]
            };
            (0..n).map(|_| trial(random)).collect()
        };
        for (data, clustered) in [
            ("Poisson, 0.1 to 50 events a trial", false),
            ("the same, of rates that vary by half over trials", true),
        ] {
            cases.push(case("rate", data, false, move |random, n| {
                (Estimator::Rate.estimate(&trials(random, n, clustered)).ci95, rate)
            }));
            cases.push(case("difference of rates", data, false, move |random, n| {
                let (a, b) = (trials(random, n, clustered), trials(random, n, clustered));
                (difference(Estimator::Rate, [&a, &b], false).ci95, 0.0)
            }));
        }
    }
}

fn medians(cases: &mut Vec<Case>) {
    for (data, law, _, truth) in LAWS {
        cases.push(case("median", data, false, move |random, n| {
            let values: Vec<f64> = (0..n).map(|_| law(random)).collect();
            (median(&values).ci95, truth)
        }));
        cases.push(case("difference of medians", data, false, move |random, n| {
            let of = |random: &mut Philox, shift: f64| plain(random, n, |random| FAR + law(random) + shift);
            let (a, b) = (of(random, 0.0), of(random, 1.0));
            (difference(Estimator::Median, [&a, &b], false).ci95, 1.0)
        }));
    }
    for (data, end) in [
        ("exponential, none cut off", f64::INFINITY),
        ("exponential, a third cut off", 2.8),
        ("exponential, two fifths cut off", 2.2),
    ] {
        let times = move |random: &mut Philox, n: usize| -> Vec<Observation> {
            let time = |random: &mut Philox| {
                let (time, end) = (
                    exponential(random),
                    if end.is_finite() { end * uniform(random) } else { end },
                );
                Observation {
                    time: time.min(end),
                    happened: time <= end,
                }
            };
            (0..n).map(|_| time(random)).collect()
        };
        cases.push(case("Kaplan–Meier median", data, false, move |random, n| {
            (median_survival(&times(random, n)).ci95, std::f64::consts::LN_2)
        }));
        cases.push(case("survival curve at the median", data, false, move |random, n| {
            let curve = survival_curve(times(random, n));
            let step = curve.iter().rev().find(|step| step.time <= std::f64::consts::LN_2);
            (step.map_or([None; 2], |step| step.band.map(Some)), 0.5)
        }));
    }
}

fn deltas(cases: &mut Vec<Case>) {
    // Φ(shift/√2) of normal pairs are in the order of the shift.
    for (data, shift, truth) in [
        ("normal, δ 0, 0.52 and 0.84", 0.0, 0.0),
        ("normal, δ 0, 0.52 and 0.84", 1.0, 0.520_499_877_8),
        ("normal, δ 0, 0.52 and 0.84", 2.0, 0.842_700_792_9),
    ] {
        cases.push(case("Cliff's δ, unpaired", data, false, move |random, n| {
            let a: Vec<_> = (0..n).map(|_| Some(normal(random))).collect();
            let b: Vec<_> = (0..n).map(|_| Some(normal(random) + shift)).collect();
            (cliffs_delta_estimate([&a, &b], false).ci95, truth)
        }));
        cases.push(case("Cliff's δ, paired", data, false, move |random, n| {
            let half = std::f64::consts::FRAC_1_SQRT_2;
            let shared: Vec<f64> = (0..n).map(|_| half * normal(random)).collect();
            let a: Vec<_> = shared
                .iter()
                .map(|shared| Some(shared + half * normal(random)))
                .collect();
            let b: Vec<_> = shared
                .iter()
                .map(|shared| Some(shared + half * normal(random) + shift))
                .collect();
            (cliffs_delta_estimate([&a, &b], true).ci95, truth)
        }));
    }
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for add in [means, mean_times, shares, rates, medians, deltas] {
        add(&mut cases);
    }
    cases
}

use proptest::prelude::*;

use super::super::{Estimator, ratio_of_sums};
use super::*;

fn seen(times: &[f64], cut_off: &[f64]) -> Times {
    let of = |times: &[f64], happened| {
        let seen = times.iter().map(move |&time| Observation { time, happened });
        seen.collect::<Vec<_>>()
    };
    of(times, true).into_iter().chain(of(cut_off, false)).collect()
}

/// Parts of all times, one after the other.
fn split(times: &Times, at: &[usize]) -> Vec<Times> {
    let ends = at.iter().copied().chain([times.len()]);
    let starts = [0].into_iter().chain(at.iter().copied());
    let part = |(start, end): (usize, usize)| times.iter().skip(start).take(end - start).collect();
    starts.zip(ends).map(part).collect()
}

#[test]
fn the_mean_of_times_is_the_area_under_the_kaplan_meier_curve() {
    // summary(survfit(Surv(t, e) ~ 1), rmean = 35)$table, R 4.2, and lifelines' restricted_mean_survival_time; Freireich (1963)
    let treated = seen(
        &[6.0, 6.0, 6.0, 7.0, 10.0, 13.0, 16.0, 22.0, 23.0],
        &[6.0, 9.0, 10.0, 11.0, 17.0, 19.0, 20.0, 25.0, 32.0, 32.0, 34.0, 35.0],
    );
    for trials in [split(&treated, &[]), split(&treated, &[4, 11])] {
        let (parts, lasting) = pseudo_values(&trials);
        assert!((ratio_of_sums(parts) - 23.287_394_957_983_19).abs() < 1e-9);
        assert_eq!((lasting.cut_off, lasting.restricted_to), (12, Some(35.0)));
    }
}

#[test]
fn without_cut_offs_pseudo_values_are_the_times_themselves() {
    let (a, b) = (seen(&[1.0, 4.0], &[]), seen(&[2.5], &[]));
    let (parts, lasting) = pseudo_values(&[a, b, Times::default()]);
    assert_eq!(
        (parts, lasting),
        (vec![[5.0, 2.0], [2.5, 1.0], [0.0, 0.0]], Lasting::default())
    );
}

#[test]
fn a_pseudo_value_is_what_the_mean_would_lose_without_its_trial() {
    // Against the jackknife: n θ − (n − 1) θ without one of n = 40 single times, the longest of them left in. The
    // infinitesimal one differs from it by terms of the order 1/n.
    let times: Vec<Observation> = (0..40_u32)
        .map(|number| Observation {
            time: f64::from(number * 7919 % 97) + 1.0,
            happened: number % 3 > 0,
        })
        .collect();
    let mean = |times: &[Observation]| {
        let (parts, _) = pseudo_values(&[times.iter().copied().collect()]);
        ratio_of_sums(parts)
    };
    let trials: Vec<Times> = times.iter().map(|&time| Times::from_iter([time])).collect();
    let (parts, _) = pseudo_values(&trials);
    let longest = times.iter().map(|seen| seen.time).fold(0.0, f64::max);
    for (number, part) in parts
        .iter()
        .enumerate()
        .filter(|(number, _)| times[*number].time < longest)
    {
        let mut without = times.clone();
        without.remove(number);
        let jackknife = 40.0 * mean(&times) - 39.0 * mean(&without);
        assert!(
            (part[0] - jackknife).abs() < 0.06 * longest,
            "{number}: {} {jackknife}",
            part[0]
        );
    }
}

/// As the definitions say, step by step, without blocks.
fn plainly(times: &[Observation]) -> Vec<f64> {
    let curve = crate::statistics::survival_curve(times.iter().copied());
    let longest = times.iter().map(|seen| seen.time).fold(0.0, f64::max);
    let mut areas = vec![0.0; curve.len()];
    let (mut area, mut end) = (0.0, longest);
    for (step, place) in curve.iter().zip(&mut areas).rev() {
        area += step.survival * (end - step.time);
        (*place, end) = (area, step.time);
    }
    let mean = area + end;
    let value = |seen: &Observation| {
        let (mut reach, mut ended) = (0.0, 0.0);
        for (step, area) in curve.iter().zip(&areas).filter(|(step, _)| step.time <= seen.time) {
            let survivors = (step.at_risk - step.happened) as f64;
            let ends = if survivors > 0.0 { area / survivors } else { 0.0 };
            reach += ends * step.happened as f64 / step.at_risk as f64;
            ended = if seen.happened && step.time.total_cmp(&seen.time).is_eq() {
                ends
            } else {
                0.0
            };
        }
        mean + times.len() as f64 * (reach - ended)
    };
    times.iter().map(value).collect()
}

proptest! {
    #[test]
    fn times_of_many_blocks_and_ties_are_to_the_last_digit_what_the_definitions_say(
        times in prop::collection::vec((0..200_u32, any::<bool>()), 1..300),
    ) {
        let times: Vec<_> = times
            .into_iter()
            .map(|(time, happened)| Observation { time: f64::from(time) / 7.0, happened })
            .collect();
        prop_assume!(times.iter().any(|seen| seen.happened) && times.iter().any(|seen| !seen.happened));
        let single: Vec<Times> = times.iter().map(|&time| Times::from_iter([time])).collect();
        let found: Vec<f64> = pseudo_values(&single).0.into_iter().map(|part| part[0]).collect();
        prop_assert_eq!(found, plainly(&times));
    }
}

#[test]
fn times_that_were_all_cut_off_have_no_mean_and_the_last_may_be_over_by_itself() {
    let (parts, lasting) = pseudo_values(&[seen(&[], &[3.0, 5.0])]);
    assert_eq!(Estimator::Times.estimate(&parts).value, None);
    assert_eq!((lasting.cut_off, lasting.restricted_to), (2, Some(5.0)));
    let (parts, lasting) = pseudo_values(&[seen(&[2.0, 6.0], &[3.0])]);
    // S is 2/3 from 2 s on and 0 from 6 s on.
    assert!((ratio_of_sums(parts) - 14.0 / 3.0).abs() < 1e-12 && lasting.restricted_to.is_none());
    assert_eq!(pseudo_values(&[]).1, Lasting::default());
}

#[test]
fn what_the_end_cuts_off_is_not_lost_whatever_the_times_and_the_end() {
    // Times that are over at m + 1, m + 2, … s with probability r each (a geometric law) and cut off at ends spread evenly over
    // 0 … 150 s, as those of mistakes under bursts of losses are. Truth: m + 1/r, restricted to the longest seen. 40,000 times,
    // of which about a third count: σ/√n ≈ 1/r/√13,000 = 0.9 % of 1/r, more at the tail; four of them.
    for (m, r) in [(4.0, 0.03), (0.0, 0.05), (10.0, 0.1)] {
        let mut number = 0_u64;
        let mut uniform = || {
            number = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mixed = (number ^ (number >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        let times: Vec<Observation> = (0..40_000)
            .map(|_| {
                let time = m + 1.0 + (uniform().ln() / f64::ln(1.0 - r)).floor();
                let end = 150.0 * uniform();
                Observation {
                    time: time.min(end),
                    happened: time <= end,
                }
            })
            .collect();
        let (parts, lasting) = pseudo_values(&[times.iter().copied().collect()]);
        let found = ratio_of_sums(parts);
        let over: Vec<f64> = times
            .iter()
            .filter(|seen| seen.happened)
            .map(|seen| seen.time)
            .collect();
        let naive = over.iter().sum::<f64>() / over.len() as f64;
        let beyond = f64::powf(1.0 - r, lasting.restricted_to.unwrap_or(f64::INFINITY) - m) / r;
        let truth = m + 1.0 / r - beyond;
        assert!((found - truth).abs() < 0.04 / r, "{found} instead of {truth}");
        assert!(
            naive < truth - 0.02 / r,
            "leaving out what was cut off flatters: {naive}"
        );
    }
}

//! A comparison in plain words: which setting is better, by how much, how sure.

use super::factors;
use super::finding::finding;
use super::words::{change, fitted, label, planned, probability, signed};
use crate::metrics::comparison::{Comparison, Pair, Verdict};
use crate::report::number::{NOTHING, count};

/// Fills in the words of each difference, and the finding.
pub fn describe(comparison: &mut Comparison) {
    let words: Vec<String> = comparison.pairs.iter().map(|pair| of_pair(comparison, pair)).collect();
    for (pair, words) in comparison.pairs.iter_mut().zip(words) {
        pair.words = words;
    }
    factors::describe(comparison);
    comparison.finding = finding(comparison);
}

fn of_pair(comparison: &Comparison, pair: &Pair) -> String {
    let Some(figure) = comparison.figure(&pair.figure) else {
        return String::new();
    };
    let [setting, against] = [&pair.setting, &pair.against].map(|name| label(comparison, name));
    let name = &figure.name;
    let p = format!("adjusted p {}", probability(pair.p_adjusted));
    let found = fitted(&pair.difference);
    match pair.verdict {
        Verdict::NotComparable => {
            format!("{name}: {setting} and {against} cannot be compared, for one of them has no value")
        }
        Verdict::CannotTell => {
            let trials = count(pair.difference.n);
            format!(
                "{name}: cannot tell {setting} from {against} with {trials} trials ({found}){}",
                planned(comparison, pair, figure)
            )
        }
        Verdict::NoDetectableDifference if pair.p_adjusted.is_none() => {
            format!("{name}: {setting} and {against} are the same in every trial")
        }
        Verdict::NoDetectableDifference => {
            let seen = format!("{name}: no detectable difference between {setting} and {against}");
            format!("{seen} ({found}, {p}){}", planned(comparison, pair, figure))
        }
        Verdict::Better | Verdict::Worse => {
            let verdict = if pair.verdict == Verdict::Better {
                "better"
            } else {
                "worse"
            };
            let delta = pair.cliffs_delta.value.map_or(NOTHING.to_owned(), |delta| {
                signed(delta, &format!("{:.2}", delta.abs()))
            });
            format!(
                "{name}: {setting} is {verdict} than {against}, {}, Cliff's δ {delta}, {p}",
                change(&pair.difference, pair.relative, figure)
            )
        }
    }
}

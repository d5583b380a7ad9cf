//! What a study found, in a few sentences: which setting is best, what that is worth, what single factors do.

use super::factors;
use super::words::{change, fitted, label, planned, probability, with_unit};
use crate::metrics::comparison::{Comparison, Pair, Setting, Verdict, apart};
use crate::metrics::figures::{Better, Figure};
use crate::report::number::count;

/// Of a longer list, so many are named.
const MOST_NAMES: usize = 6;

/// What the study found.
pub fn finding(comparison: &Comparison) -> String {
    let Some(figure) = comparison.figure(&comparison.primary) else {
        return String::new();
    };
    let best = leaders(comparison, figure);
    let Some(first) = best.first() else {
        return format!("No setting has a value of {}.", figure.name);
    };
    let valued = comparison
        .settings
        .iter()
        .filter(|setting| known(setting, figure).is_some());
    if comparison.family.tests == 0 && comparison.family.impossible > 0 {
        let lead = format!(
            "{} the {} {}: {}",
            have(&best),
            superlative(figure),
            figure.name,
            value(first, figure)
        );
        return format!("{} By the estimates alone, {lead}.", powerless(comparison));
    }
    let mut found = if best.len() > 1 && best.len() == valued.count() {
        let all = if best.len() == comparison.settings.len() {
            format!("All {} settings", best.len())
        } else {
            format!("The {} settings that have one", best.len())
        };
        let others = if comparison.reference.is_some() {
            elsewhere(comparison, figure)
        } else {
            String::new()
        };
        format!("{all} have the same {}: {}.{others}", figure.name, value(first, figure))
    } else {
        match comparison.reference.as_deref() {
            Some(reference) => against_reference(comparison, figure, &best, reference),
            None => among_all(comparison, figure, &best),
        }
    };
    found.push_str(&factors::finding(comparison, figure));
    found
}

/// That so few trials could not show anything, and how many could.
fn powerless(comparison: &Comparison) -> String {
    let trials = comparison
        .settings
        .iter()
        .map(|setting| setting.trials)
        .min()
        .unwrap_or(0);
    let needed = comparison.family.trials_needed.filter(|&needed| needed > trials);
    let remedy = needed.map_or(String::new(), |needed| {
        format!(": that takes {} trials of each setting or more", count(needed))
    });
    format!(
        "{} cannot show any of {}, however large{remedy}.",
        counted(trials, "trial"),
        counted(comparison.family.impossible, "difference")
    )
}

/// `1 trial`, `4 trials`.
fn counted(number: u64, what: &str) -> String {
    format!("{} {what}{}", count(number), if number == 1 { "" } else { "s" })
}

fn known(setting: &Setting, figure: &Figure) -> Option<f64> {
    setting.figure(&figure.key)?.estimate.value
}

/// The settings with the best value: several where they differ by rounding alone.
fn leaders<'a>(comparison: &'a Comparison, figure: &Figure) -> Vec<&'a Setting> {
    let sign = if figure.better == Better::Lower { 1.0 } else { -1.0 };
    let values = comparison.settings.iter().filter_map(|setting| known(setting, figure));
    let Some(best) = values.min_by(|a, b| (sign * a).total_cmp(&(sign * b))) else {
        return Vec::new();
    };
    let ties = |setting: &&Setting| known(setting, figure).is_some_and(|value| apart(value, best) == 0.0);
    comparison.settings.iter().filter(ties).collect()
}

fn value(setting: &Setting, figure: &Figure) -> String {
    let estimate = setting
        .figure(&figure.key)
        .map(|estimated| estimated.estimate)
        .unwrap_or_default();
    with_unit(&fitted(&estimate), figure)
}

fn superlative(figure: &Figure) -> &'static str {
    match figure.better {
        Better::Lower => "lowest",
        Better::Higher => "highest",
    }
}

fn comparative(figure: &Figure) -> &'static str {
    match figure.better {
        Better::Lower => "lower",
        Better::Higher => "higher",
    }
}

/// Names with semicolons between, the first of many.
fn listed(names: &[&str]) -> String {
    if names.len() <= MOST_NAMES {
        return names.join("; ");
    }
    format!(
        "{}; and {} more",
        names[..MOST_NAMES - 1].join("; "),
        names.len() - MOST_NAMES + 1
    )
}

/// `A has`, or `A; B share`.
fn have(settings: &[&Setting]) -> String {
    let names: Vec<&str> = settings.iter().map(|setting| setting.label.as_str()).collect();
    format!("{} {}", listed(&names), if names.len() == 1 { "has" } else { "share" })
}

fn against_reference(comparison: &Comparison, figure: &Figure, best: &[&Setting], reference: &str) -> String {
    let pairs: Vec<&Pair> = comparison.pairs_in(&figure.key).collect();
    let name = &figure.name;
    let there = label(comparison, reference);
    let tally = format!("{}{}", tally(comparison, figure, there), at_worst(comparison, figure));
    let others = elsewhere(comparison, figure);
    let at_reference = comparison.setting(reference);
    let Some(at_reference) = at_reference.filter(|setting| known(setting, figure).is_some()) else {
        return format!(
            "{there} has no value of {name}, so that nothing can be held against it. {} the {} {name}: {}.{others}",
            have(best),
            superlative(figure),
            value(best[0], figure)
        );
    };
    let at_reference = value(at_reference, figure);
    if best.iter().any(|setting| setting.name == reference) {
        let way = comparative(figure);
        return format!("No setting has a {way} {name} than {there}, {at_reference}. {tally}{others}");
    }
    let ahead = best
        .iter()
        .map(|setting| pairs.iter().find(|pair| pair.setting == setting.name));
    let ahead: Option<Vec<&&Pair>> = ahead.collect();
    let ahead = ahead.filter(|pairs| pairs.iter().all(|pair| pair.verdict == Verdict::Better));
    let Some(pair) = ahead.as_ref().and_then(|pairs| pairs.first()) else {
        return format!("No setting is detectably better than {there} in {name} ({at_reference}). {tally}{others}");
    };
    let mut found = format!(
        "{} the {} {name}: {}, {} than {there} (adjusted p {}).",
        have(best),
        superlative(figure),
        value(best[0], figure),
        change(&pair.difference, pair.relative, figure),
        probability(pair.p_adjusted)
    );
    for key in comparison.compared.iter().skip(1).filter(|_| best.len() == 1) {
        let Some(figure) = comparison.figure(key) else { continue };
        let Some(pair) = comparison.pairs_in(key).find(|pair| pair.setting == best[0].name) else {
            continue;
        };
        found.push(' ');
        found.push_str(&aside(comparison, pair, figure));
    }
    found.push(' ');
    found.push_str(&tally);
    found
}

/// How many settings are better than the reference, how many worse, and of how many nothing can be said.
fn tally(comparison: &Comparison, figure: &Figure, there: &str) -> String {
    let pairs: Vec<&Pair> = comparison.pairs_in(&figure.key).collect();
    let number = |counts: &dyn Fn(&Pair) -> bool| pairs.iter().filter(|pair| counts(pair)).count();
    let of = |verdict: Verdict| number(&|pair| pair.verdict == verdict);
    let alike = number(&|pair| pair.verdict == Verdict::NoDetectableDifference && pair.p_adjusted.is_none());
    let unclear = of(Verdict::NoDetectableDifference) - alike;
    let (better, worse, cannot_tell) = (of(Verdict::Better), of(Verdict::Worse), of(Verdict::CannotTell));
    let not_comparable = of(Verdict::NotComparable);
    let mut parts = vec![
        format!("{better} {} better", if better == 1 { "is" } else { "are" }),
        format!("{worse} worse"),
    ];
    if alike > 0 {
        parts.push(format!("{alike} the same in every trial"));
    }
    if cannot_tell > 0 {
        parts.push(format!("{cannot_tell} cannot be told with so few trials"));
    }
    if not_comparable > 0 {
        parts.push(format!("{not_comparable} cannot be compared"));
    }
    let show = if unclear == 1 { "shows" } else { "show" };
    format!(
        "Of {} settings held against {there} by {}, {}, and {unclear} {show} no detectable difference.",
        pairs.len(),
        figure.name,
        parts.join(", ")
    )
}

/// Of pairs, those that differ most, all of them where they do by rounding alone.
fn furthest<'a>(pairs: impl Iterator<Item = &'a Pair>) -> Vec<&'a Pair> {
    let size = |pair: &Pair| pair.difference.value.unwrap_or_default().abs();
    let pairs: Vec<&Pair> = pairs.collect();
    let most = pairs.iter().map(|pair| size(pair)).fold(0.0, f64::max);
    pairs
        .into_iter()
        .filter(|pair| apart(size(pair), most) == 0.0)
        .collect()
}

/// What other figures gain in other settings, and what that costs in the figure that the study is about.
fn elsewhere(comparison: &Comparison, primary: &Figure) -> String {
    let gains = comparison.compared.iter().skip(1).filter_map(|key| {
        let figure = comparison.figure(key)?;
        let best = furthest(comparison.pairs_in(key).filter(|pair| pair.verdict == Verdict::Better));
        let pair = best.first()?;
        let names: Vec<&str> = best.iter().map(|pair| label(comparison, &pair.setting)).collect();
        if names.len() > 1 {
            let gain = change(&pair.difference, pair.relative, figure);
            return Some(format!(" {} are best in {}, {gain}.", listed(&names), figure.name));
        }
        let cost = comparison
            .pairs_in(&primary.key)
            .find(|other| other.setting == pair.setting)?;
        let cost = match cost.verdict {
            Verdict::Better | Verdict::Worse => change(&cost.difference, cost.relative, primary),
            Verdict::CannotTell => "too few trials to tell".to_owned(),
            Verdict::NoDetectableDifference if cost.p_adjusted.is_none() => "the same in every trial".to_owned(),
            Verdict::NoDetectableDifference => "no detectable difference".to_owned(),
            Verdict::NotComparable => "not comparable".to_owned(),
        };
        Some(format!(
            " {} is best in {}, {}, with {}: {cost}.",
            names[0],
            figure.name,
            change(&pair.difference, pair.relative, figure),
            primary.name
        ))
    });
    gains.collect()
}

/// The setting that is furthest on the wrong side of the reference, if one is.
fn at_worst(comparison: &Comparison, figure: &Figure) -> String {
    let worst = furthest(
        comparison
            .pairs_in(&figure.key)
            .filter(|pair| pair.verdict == Verdict::Worse),
    );
    let Some(pair) = worst.first() else {
        return String::new();
    };
    let Some(setting) = comparison.setting(&pair.setting) else {
        return String::new();
    };
    let names: Vec<&str> = worst.iter().map(|pair| label(comparison, &pair.setting)).collect();
    format!(
        " {} {} worst: {}, {}.",
        listed(&names),
        if names.len() == 1 { "is" } else { "are" },
        value(setting, figure),
        change(&pair.difference, pair.relative, figure)
    )
}

/// What the best setting does to another figure.
fn aside(comparison: &Comparison, pair: &Pair, figure: &Figure) -> String {
    let name = &figure.name;
    let change = || change(&pair.difference, pair.relative, figure);
    match pair.verdict {
        Verdict::NotComparable => format!("There, {name} cannot be compared."),
        Verdict::CannotTell => {
            format!(
                "There, {name} cannot be told with so few trials{}.",
                planned(comparison, pair, figure)
            )
        }
        Verdict::NoDetectableDifference if pair.p_adjusted.is_none() => {
            format!("There, {name} is the same in every trial.")
        }
        Verdict::NoDetectableDifference => {
            format!(
                "There, {name} shows no detectable difference{}.",
                planned(comparison, pair, figure)
            )
        }
        Verdict::Better => format!("There, {name} is better: {}.", change()),
        Verdict::Worse => format!("There, {name} is worse: {}.", change()),
    }
}

fn among_all(comparison: &Comparison, figure: &Figure, best: &[&Setting]) -> String {
    let is_best = |name: &str| best.iter().any(|setting| setting.name == name);
    let mut groups: [Vec<&str>; 4] = Default::default();
    for other in comparison.settings.iter().filter(|setting| !is_best(&setting.name)) {
        let mut outcomes = best.iter().filter_map(|leader| {
            let is_it = |pair: &&Pair| {
                (pair.setting == leader.name && pair.against == other.name)
                    || (pair.against == leader.name && pair.setting == other.name)
            };
            let pair = comparison.pairs_in(&figure.key).find(is_it)?;
            let wins = if pair.setting == leader.name {
                Verdict::Better
            } else {
                Verdict::Worse
            };
            Some(match pair.verdict {
                verdict if verdict == wins => 0,
                Verdict::CannotTell => 2,
                Verdict::NotComparable => 3,
                _ => 1,
            })
        });
        let Some(first) = outcomes.next() else { continue };
        groups[outcomes.fold(first, usize::max)].push(&other.label);
    }
    let [beaten, unclear, untold, valueless] = groups;
    let (name, it) = (&figure.name, if best.len() == 1 { "It is" } else { "They are" });
    let mut found = vec![];
    if !beaten.is_empty() {
        found.push(format!("{it} detectably better than {}", listed(&beaten)));
    }
    if !unclear.is_empty() {
        let no = if found.is_empty() { "No" } else { "no" };
        found.push(format!("{no} detectable difference from {}", listed(&unclear)));
    }
    if !untold.is_empty() {
        let too = if found.is_empty() { "Too" } else { "too" };
        found.push(format!("{too} few trials to tell from {}", listed(&untold)));
    }
    if !valueless.is_empty() {
        let not = if found.is_empty() { "Not" } else { "not" };
        found.push(format!("{not} comparable with {}", listed(&valueless)));
    }
    let found = if found.is_empty() {
        String::new()
    } else {
        format!(" {}.", found.join("; "))
    };
    format!(
        "{} the {} {name}: {}.{found}",
        have(best),
        superlative(figure),
        value(best[0], figure)
    )
}

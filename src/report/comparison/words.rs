//! A comparison in plain words: which setting is better, by how much, how sure.

use crate::metrics::Estimate;
use crate::metrics::comparison::{Comparison, Pair, Setting, Stopping, Verdict};
use crate::metrics::figures::{Better, Figure};
use crate::report::number::{NOTHING, count, figure as number};

/// Fills in the words of each difference, and the finding.
pub fn describe(comparison: &mut Comparison) {
    let words: Vec<String> = comparison.pairs.iter().map(|pair| of_pair(comparison, pair)).collect();
    for (pair, words) in comparison.pairs.iter_mut().zip(words) {
        pair.words = words;
    }
    comparison.finding = finding(comparison);
}

/// The value, with as many digits as its interval makes sense of.
pub fn fitted(estimate: &Estimate) -> String {
    let Some(value) = estimate.value else {
        return NOTHING.to_owned();
    };
    let half = match estimate.ci95 {
        // A width that is all rounding is none.
        [Some(low), Some(high)] if high - low > 1e-9 * value.abs() => (high - low) / 2.0,
        _ => return signed(value, &number(value.abs())),
    };
    let digits = (-half.log10().floor()).max(0.0) as usize + usize::from(half < 1.0);
    let write = |value: f64| {
        let written = format!("{:.digits$}", value.abs());
        let grouped = if digits == 0 {
            count(value.abs().round() as u64)
        } else {
            written
        };
        signed(value, &grouped)
    };
    let [low, high] = estimate.ci95.map(|end| end.map_or(NOTHING.to_owned(), write));
    format!("{} [{low}, {high}]", write(value))
}

fn signed(value: f64, written: &str) -> String {
    let is_zero = !written.contains(|digit: char| ('1'..='9').contains(&digit));
    if value < 0.0 && !is_zero {
        format!("−{written}")
    } else {
        written.to_owned()
    }
}

/// A figure's value with its unit.
pub fn with_unit(value: &str, figure: &Figure) -> String {
    match figure.unit.as_ref() {
        "1" => value.to_owned(),
        unit => format!("{value} {unit}"),
    }
}

/// A p-value.
pub fn probability(p: Option<f64>) -> String {
    match p {
        None => NOTHING.to_owned(),
        Some(p) if p < 0.001 => "<0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}

/// A relative difference in percent.
pub fn percent(share: Option<f64>) -> String {
    share.map_or(NOTHING.to_owned(), |share| {
        let percent = share.abs() * 100.0;
        let written = match percent {
            _ if percent < 9.95 => format!("{percent:.1}"),
            _ => count(percent.round() as u64),
        };
        format!("{} %", signed(share, &written))
    })
}

/// What people call a setting.
pub fn label<'a>(comparison: &'a Comparison, name: &'a str) -> &'a str {
    comparison.setting(name).map_or(name, |setting| setting.label.as_str())
}

/// The difference itself: `lower by 12.3 [11.0, 13.1] B/step (45 % less)`.
fn change(pair: &Pair, figure: &Figure) -> String {
    let falls = pair.difference.value.is_some_and(|value| value < 0.0);
    let [low, high] = pair.difference.ci95;
    let size = Estimate {
        value: pair.difference.value.map(f64::abs),
        ci95: if falls {
            [high.map(|end| -end), low.map(|end| -end)]
        } else {
            [low, high]
        },
        n: pair.difference.n,
    };
    let (way, less) = if falls { ("lower", "less") } else { ("higher", "more") };
    let relative = pair.relative.map_or(String::new(), |share| {
        format!(" ({} {less})", percent(Some(share.abs())))
    });
    format!("{way} by {}{relative}", with_unit(&fitted(&size), figure))
}

fn of_pair(comparison: &Comparison, pair: &Pair) -> String {
    let Some(figure) = comparison.figure(&pair.figure) else {
        return String::new();
    };
    let [setting, against] = [&pair.setting, &pair.against].map(|name| label(comparison, name));
    let name = &figure.name;
    let p = format!("adjusted p {}", probability(pair.p_adjusted));
    match pair.verdict {
        Verdict::NotComparable => {
            format!("{name}: {setting} and {against} cannot be compared, for one of them has no value")
        }
        Verdict::NoDetectableDifference => {
            let seen = format!("{name}: no detectable difference between {setting} and {against}");
            format!(
                "{seen} ({}, {p}){}",
                fitted(&pair.difference),
                planned(comparison, pair, figure)
            )
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
                change(pair, figure)
            )
        }
    }
}

/// How many trials would show a difference worth finding.
fn planned(comparison: &Comparison, pair: &Pair, figure: &Figure) -> String {
    pair.plan.as_ref().map_or(String::new(), |plan| {
        let size = with_unit(&number(plan.size), figure);
        format!(
            "; {} trials would show one of {} ({size}) with {:.0} % power",
            count(plan.trials),
            percent(Some(comparison.relevant)),
            plan.power * 100.0
        )
    })
}

/// How adding trials ended.
pub fn stopping(stopping: &Stopping, comparison: &Comparison) -> String {
    let name = comparison
        .figure(&stopping.figure)
        .map_or(stopping.figure.as_str(), |figure| figure.name.as_str());
    let (widest, trials) = (
        stopping.widest.map_or(NOTHING.to_owned(), number),
        count(stopping.trials.into()),
    );
    let asked = number(stopping.width);
    if stopping.reached {
        format!(
            "after {trials} trials of each setting: no interval of {name} is wider than {widest}, and {asked} was asked for"
        )
    } else {
        format!(
            "at the cap of {trials} trials of each setting: the widest interval of {name} is {widest}, and {asked} was asked for"
        )
    }
}

/// What the study found.
fn finding(comparison: &Comparison) -> String {
    let Some(figure) = comparison.figure(&comparison.primary) else {
        return String::new();
    };
    let Some(best) = best(comparison, figure) else {
        return format!("No setting has a value of {}.", figure.name);
    };
    match comparison.reference.as_deref() {
        Some(reference) => against_reference(comparison, figure, best, reference),
        None => among_all(comparison, figure, best),
    }
}

/// The setting with the best value, the first where several have it.
fn best<'a>(comparison: &'a Comparison, figure: &Figure) -> Option<&'a Setting> {
    let valued = comparison.settings.iter().filter_map(|setting| {
        let value = setting.figure(&figure.key)?.estimate.value?;
        Some((if figure.better == Better::Lower { value } else { -value }, setting))
    });
    valued.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, setting)| setting)
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

fn against_reference(comparison: &Comparison, figure: &Figure, best: &Setting, reference: &str) -> String {
    let pairs: Vec<&Pair> = comparison.pairs_in(&figure.key).collect();
    let number = |verdict| pairs.iter().filter(|pair| pair.verdict == verdict).count();
    let (better, worse) = (number(Verdict::Better), number(Verdict::Worse));
    let unclear = number(Verdict::NoDetectableDifference);
    let name = &figure.name;
    let there = label(comparison, reference);
    let tally = format!(
        "Of {} settings held against {there} by {name}, {better} {} better, {worse} worse, and {unclear} show no detectable difference.",
        pairs.len(),
        if better == 1 { "is" } else { "are" },
    );
    let at_reference = comparison
        .setting(reference)
        .map_or(String::new(), |setting| value(setting, figure));
    let tally = format!("{tally}{}", at_worst(comparison, figure));
    let Some(pair) = pairs.iter().find(|pair| pair.setting == best.name) else {
        let nobody = format!(
            "No setting has a {} {name} than {there}, {at_reference}.",
            comparative(figure)
        );
        return format!("{nobody} {tally}{}", elsewhere(comparison, figure));
    };
    if pair.verdict != Verdict::Better {
        let nobody = format!("No setting is detectably better than {there} in {name} ({at_reference}).");
        return format!("{nobody} {tally}{}", elsewhere(comparison, figure));
    }
    let mut found = format!(
        "{} has the {} {name}: {}, {} than {there} (adjusted p {}). {tally}",
        best.label,
        superlative(figure),
        value(best, figure),
        change(pair, figure),
        probability(pair.p_adjusted)
    );
    for key in comparison.compared.iter().skip(1) {
        let Some(figure) = comparison.figure(key) else { continue };
        let Some(pair) = comparison.pairs_in(key).find(|pair| pair.setting == best.name) else {
            continue;
        };
        found.push(' ');
        found.push_str(&aside(comparison, pair, figure));
    }
    found
}

/// What other figures gain in other settings, and what that costs in the figure that the study is about.
fn elsewhere(comparison: &Comparison, primary: &Figure) -> String {
    let gains = comparison.compared.iter().skip(1).filter_map(|key| {
        let figure = comparison.figure(key)?;
        let pairs = comparison.pairs_in(key).filter(|pair| pair.verdict == Verdict::Better);
        let size = |pair: &&Pair| pair.difference.value.unwrap_or_default().abs();
        let pair = pairs.max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let cost = comparison
            .pairs_in(&primary.key)
            .find(|other| other.setting == pair.setting)?;
        let cost = match cost.verdict {
            Verdict::NoDetectableDifference | Verdict::NotComparable => "no detectable difference".to_owned(),
            Verdict::Better | Verdict::Worse => change(cost, primary),
        };
        let label = label(comparison, &pair.setting);
        Some(format!(
            " {label} is best in {}, {}, with {}: {cost}.",
            figure.name,
            change(pair, figure),
            primary.name
        ))
    });
    gains.collect()
}

/// The setting that is furthest on the wrong side of the reference, if one is.
fn at_worst(comparison: &Comparison, figure: &Figure) -> String {
    let worse = comparison
        .pairs_in(&figure.key)
        .filter(|pair| pair.verdict == Verdict::Worse);
    let size = |pair: &&Pair| pair.difference.value.unwrap_or_default().abs();
    let worst = worse.max_by(|a, b| size(a).total_cmp(&size(b)));
    let setting = worst.and_then(|pair| Some((pair, comparison.setting(&pair.setting)?)));
    setting.map_or(String::new(), |(pair, setting)| {
        format!(
            " {} is worst: {}, {}.",
            setting.label,
            value(setting, figure),
            change(pair, figure)
        )
    })
}

fn comparative(figure: &Figure) -> &'static str {
    match figure.better {
        Better::Lower => "lower",
        Better::Higher => "higher",
    }
}

/// What the best setting does to another figure.
fn aside(comparison: &Comparison, pair: &Pair, figure: &Figure) -> String {
    let name = &figure.name;
    match pair.verdict {
        Verdict::NotComparable => format!("There, {name} cannot be compared."),
        Verdict::NoDetectableDifference => {
            format!(
                "There, {name} shows no detectable difference{}.",
                planned(comparison, pair, figure)
            )
        }
        Verdict::Better => format!("There, {name} is better: {}.", change(pair, figure)),
        Verdict::Worse => format!("There, {name} is worse: {}.", change(pair, figure)),
    }
}

fn among_all(comparison: &Comparison, figure: &Figure, best: &Setting) -> String {
    let mut beaten = Vec::new();
    let mut unclear = Vec::new();
    for pair in comparison.pairs_in(&figure.key) {
        let (other, wins) = if pair.setting == best.name {
            (&pair.against, Verdict::Better)
        } else if pair.against == best.name {
            (&pair.setting, Verdict::Worse)
        } else {
            continue;
        };
        let group = if pair.verdict == wins {
            &mut beaten
        } else {
            &mut unclear
        };
        group.push(label(comparison, other));
    }
    let name = &figure.name;
    let found = format!(
        "{} has the {} {name}: {}.",
        best.label,
        superlative(figure),
        value(best, figure)
    );
    match (&beaten[..], &unclear[..]) {
        (beaten, []) => format!("{found} It is detectably better than {}.", beaten.join("; ")),
        ([], unclear) => format!("{found} No detectable difference from {}.", unclear.join("; ")),
        (beaten, unclear) => format!(
            "{found} It is detectably better than {}; no detectable difference from {}.",
            beaten.join("; "),
            unclear.join("; ")
        ),
    }
}

//! What single factors do, and whether what one does depends on another, in words and in tables.

use super::rows::{effect_verdict, put};
use super::words::{change, fitted, percent, probability, with_unit};
use crate::metrics::comparison::{Comparison, Dependence, Effect, Interaction, Verdict, apart};
use crate::metrics::figures::Figure;
use crate::report::layout::Page;
use crate::report::number::{NOTHING, count, figure as number};

/// Fills in the words of each effect and interaction.
pub fn describe(comparison: &mut Comparison) {
    let words = |figure: &str, of: &dyn Fn(&Figure) -> String| comparison.figure(figure).map_or(String::new(), of);
    let effects = comparison.effects.iter();
    let effects: Vec<String> = effects
        .map(|effect| words(&effect.figure, &|figure| of_effect(effect, figure)))
        .collect();
    let interactions = comparison.interactions.iter();
    let interactions: Vec<String> = interactions
        .map(|interaction| words(&interaction.figure, &|figure| of_interaction(interaction, figure)))
        .collect();
    for (effect, words) in comparison.effects.iter_mut().zip(effects) {
        effect.words = words;
    }
    for (interaction, words) in comparison.interactions.iter_mut().zip(interactions) {
        interaction.words = words;
    }
}

fn of_effect(effect: &Effect, figure: &Figure) -> String {
    let Effect {
        factor, level, against, ..
    } = effect;
    let name = &figure.name;
    let (found, p) = (fitted(&effect.difference), probability(effect.p_adjusted));
    match effect.verdict {
        Verdict::NotComparable => {
            format!("{name}: {factor} {level} and {against} cannot be compared, for a setting has no value")
        }
        Verdict::CannotTell => {
            let trials = count(effect.difference.n);
            format!("{name}: cannot tell {factor} {level} from {against} with {trials} trials ({found})")
        }
        Verdict::NoDetectableDifference if effect.p_adjusted.is_none() => {
            format!("{name}: {factor} {level} and {against} are the same in every trial")
        }
        Verdict::NoDetectableDifference => {
            format!("{name}: no detectable difference between {factor} {level} and {against} ({found}, adjusted p {p})")
        }
        Verdict::Better | Verdict::Worse => {
            let verdict = if effect.verdict == Verdict::Better {
                "better"
            } else {
                "worse"
            };
            let change = change(&effect.difference, effect.relative, figure);
            format!(
                "{name}: {factor} {level} is {verdict} than {against}, {change}, averaged over the other factors, adjusted p {p}"
            )
        }
    }
}

fn of_interaction(interaction: &Interaction, figure: &Figure) -> String {
    let [first, second] = &interaction.factors;
    let name = &figure.name;
    match interaction.verdict {
        Dependence::NotComparable => {
            format!("{name}: whether {first} depends on {second} cannot be said, for a setting has no value")
        }
        Dependence::CannotTell => {
            let trials = count(interaction.difference.n);
            format!("{name}: cannot tell whether the effect of {first} depends on {second} with {trials} trials")
        }
        Dependence::NoDetectableDependence if interaction.p_adjusted.is_none() => {
            format!("{name}: {first} and {second} add up in every trial")
        }
        Dependence::NoDetectableDependence => {
            let p = probability(interaction.p_adjusted);
            format!("{name}: no detectable dependence of the effect of {first} on {second} (adjusted p {p})")
        }
        Dependence::Depends => format!("{name}: {}", depends(interaction, figure)),
    }
}

/// `the effect of A depends on B (adjusted p 0.003): from A 1 to 2 it changes by +5 s at B x, by −1 s at B y`.
fn depends(interaction: &Interaction, figure: &Figure) -> String {
    let [first, second] = &interaction.factors;
    let ([to, from], [at, against]) = (&interaction.first, &interaction.second);
    let step = |step: Option<f64>| {
        let signed = |step: f64| {
            let sign = if step < 0.0 { "−" } else { "+" };
            format!("{sign}{}", with_unit(&number(step.abs()), figure))
        };
        step.map_or(NOTHING.to_owned(), signed)
    };
    format!(
        "the effect of {first} depends on {second} (adjusted p {}): {first} {to} less {from} is {} at {second} {at}, and {} at {second} {against}",
        probability(interaction.p_adjusted),
        step(interaction.steps[0]),
        step(interaction.steps[1])
    )
}

/// What factors do to the figure that the study is about, after what was found of its settings.
pub fn finding(comparison: &Comparison, figure: &Figure) -> String {
    let size = |effect: &Effect| effect.difference.value.unwrap_or_default().abs();
    // Of each factor the largest step that is there.
    let mut largest: Vec<&Effect> = Vec::new();
    let found = |effect: &&Effect| matches!(effect.verdict, Verdict::Better | Verdict::Worse);
    for effect in comparison.effects_in(&figure.key).filter(found) {
        match largest.iter_mut().find(|other| other.factor == effect.factor) {
            Some(other) if size(other) < size(effect) => *other = effect,
            Some(_) => {}
            None => largest.push(effect),
        }
    }
    largest.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let step = |effect: &Effect| {
        format!(
            "{} is {} than {} (adjusted p {})",
            effect.level,
            change(&effect.difference, effect.relative, figure),
            effect.against,
            probability(effect.p_adjusted)
        )
    };
    let mut words: Vec<String> = Vec::new();
    match &largest[..] {
        [] if comparison.effects_in(&figure.key).next().is_none() => return String::new(),
        [] if comparison
            .effects_in(&figure.key)
            .all(|effect| effect.verdict == Verdict::NotComparable) =>
        {
            return " Nothing can be averaged over the others, for a setting has no value.".to_owned();
        }
        [] => words.push(" Averaged over the others, no factor shows a detectable effect.".to_owned()),
        [first, second, ..] if apart(size(first), size(second)) == 0.0 => words.push(format!(
            " Averaged over the others, {} and {} matter alike: ",
            first.factor, second.factor
        )),
        [first, ..] => words.push(format!(" Averaged over the others, {} matters most: ", first.factor)),
    }
    let steps: Vec<String> = largest
        .iter()
        .enumerate()
        .map(|(place, effect)| match place {
            0 => step(effect),
            _ => format!("of {}, {}", effect.factor, step(effect)),
        })
        .collect();
    if !steps.is_empty() {
        words.push(format!("{}.", steps.join("; ")));
    }
    let valueless = valueless(comparison, figure);
    if !valueless.is_empty() {
        words.push(format!(
            " Of {} nothing can be said, for a setting has no value.",
            valueless.join(" and ")
        ));
    }
    for interaction in comparison.interactions_in(&figure.key) {
        match interaction.verdict {
            Dependence::Depends => words.push(format!(" Mind that {}.", depends(interaction, figure))),
            Dependence::NoDetectableDependence if interaction.p_adjusted.is_some() => {
                let [first, second] = &interaction.factors;
                words.push(format!(
                    " The effect of {first} does not detectably depend on {second}."
                ));
            }
            _ => {}
        }
    }
    words.concat()
}

/// The factors of which no two levels can be compared.
fn valueless<'a>(comparison: &'a Comparison, figure: &Figure) -> Vec<&'a str> {
    let names = comparison.factors.iter().map(|factor| factor.name.as_str());
    let is_valueless = |name: &&str| {
        let mut effects = comparison
            .effects_in(&figure.key)
            .filter(|effect| effect.factor == *name)
            .peekable();
        effects.peek().is_some() && effects.all(|effect| effect.verdict == Verdict::NotComparable)
    };
    names.filter(is_valueless).collect()
}

/// What levels of single factors do to a figure, and whether that depends on other factors.
pub fn effects(page: &mut Page, comparison: &Comparison, figure: &Figure) {
    if comparison.effects_in(&figure.key).next().is_none() {
        return;
    }
    page.heading(&format!("Effects on {}, averaged over the other factors", figure.name));
    let alike = |verdict: Verdict, p: Option<f64>| verdict == Verdict::NoDetectableDifference && p.is_none();
    if comparison
        .effects_in(&figure.key)
        .all(|effect| alike(effect.verdict, effect.p_adjusted))
    {
        page.words("None: it is the same at all levels, in every trial.");
        return;
    }
    let header = ["", "difference", "relative", "p adjusted", ""].map(str::to_owned);
    let rows = comparison.effects_in(&figure.key).map(|effect| {
        vec![
            format!("{}: {}\nless {}", effect.factor, effect.level, effect.against),
            fitted(&effect.difference),
            percent(effect.relative),
            probability(effect.p_adjusted),
            if alike(effect.verdict, effect.p_adjusted) {
                "the same".to_owned()
            } else {
                effect_verdict(effect.verdict).to_owned()
            },
        ]
    });
    put(page, &header, rows);
    if comparison.interactions_in(&figure.key).next().is_none() {
        return;
    }
    page.gap();
    let header = ["", "largest difference\nof differences", "p adjusted", ""].map(str::to_owned);
    let rows = comparison.interactions_in(&figure.key).map(|interaction| {
        let [first, second] = &interaction.factors;
        let verdict = match interaction.verdict {
            Dependence::Depends => "depends",
            Dependence::NoDetectableDependence if interaction.p_adjusted.is_none() => "adds up",
            Dependence::NoDetectableDependence => "unclear",
            Dependence::CannotTell => "cannot tell",
            Dependence::NotComparable => NOTHING,
        };
        vec![
            format!("{first}\nby {second}"),
            fitted(&interaction.difference),
            probability(interaction.p_adjusted),
            verdict.to_owned(),
        ]
    });
    put(page, &header, rows);
}

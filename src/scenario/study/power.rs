//! Whether a study can find anything at all.

use super::Plan;
use crate::metrics::comparison::{Contrasts, Factor, SIGNIFICANT, TooFew};
use crate::scenario::diagnostic::Diagnostic;

impl Plan {
    /// Says, before anything is run, if so few trials cannot show any of the differences that the study asks for, and how many could.
    #[must_use]
    pub fn too_few_trials(&self) -> Option<Diagnostic> {
        let factors: Vec<Factor> = self
            .factors
            .iter()
            .map(|(name, levels)| Factor {
                name: name.clone(),
                levels: levels.clone(),
            })
            .collect();
        let settings: Vec<&[String]> = self.settings.iter().map(|setting| &setting.levels[..]).collect();
        let paired = self
            .settings
            .windows(2)
            .all(|two| two[0].scenario.seed == two[1].scenario.seed);
        let tests = Contrasts::of(&factors, &settings, self.reference, paired).count() * self.figures.len();
        let trials = self.settings.iter().map(|setting| setting.scenario.trials);
        let trials = trials.min().unwrap_or(0).max(self.most_trials.unwrap_or(0));
        let few = TooFew::of(tests, trials.into(), paired, SIGNIFICANT)?;
        let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let message = format!(
            "{} of each setting cannot show any of {}: the least p-value is {:.2}, and after Holm's adjustment over all {:.2}",
            counted(trials as usize, "trial"),
            counted(few.tests, "difference"),
            few.least,
            (few.least * few.tests as f64).min(1.0)
        );
        let fewer = match few.allowed {
            0 => String::new(),
            allowed => {
                let reference = if self.reference.is_none() {
                    "give a `reference` to hold the others against, or "
                } else {
                    ""
                };
                format!(
                    "; or ask for {} at most: {reference}leave out figures or levels",
                    counted(allowed, "difference")
                )
            }
        };
        Some(Diagnostic {
            message,
            help: Some(format!("run {} trials of each setting or more{fewer}", few.needed)),
            path: Some("trials".into()),
            place: self.trials_place.clone(),
        })
    }
}

//! A study made ready: every setting as a scenario that holds.

use std::path::Path;
use std::sync::Arc;

use super::design::{combinations, is_name, labels, name};
use super::{Study, figures};
use crate::kind::Problem;
use crate::scenario::diagnostic::{Diagnostic, Place};
use crate::scenario::file::{contents, question};
use crate::scenario::path::{FieldPath, follow};
use crate::scenario::read::{between, document};
use crate::scenario::report::{Report, Warnings};
use crate::scenario::{Override, Scenario, examine, limits, parse, tree};

/// What is to be run and compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Its name; the default results folder is `results/<name>`.
    pub name: String,
    /// The question that it answers.
    pub question: Option<String>,
    /// What is varied: names of factors, and the labels of their levels.
    pub factors: Vec<(String, Vec<String>)>,
    /// The settings, in order.
    pub settings: Vec<Setting>,
    /// Keys of the figures to compare, first the one that it is about.
    pub figures: Vec<String>,
    /// Place of the setting that the others are held against.
    pub reference: Option<usize>,
    /// A relative difference worth finding.
    pub relevant: f64,
    /// Keys of two figures in whose plane settings are drawn.
    pub pareto: Option<[String; 2]>,
    /// Most trials that a setting may come to, if they are added as it runs.
    pub most_trials: Option<u32>,
    /// Where the number of trials stands, if it is a study's own.
    pub trials_place: Option<Place>,
    /// What looks wrong with the study as a whole.
    pub warnings: Warnings,
}

/// A setting: a level of each factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The name of its scenario and of its results folder.
    pub name: String,
    /// The labels of its levels, one for each factor.
    pub levels: Vec<String>,
    /// The whole scenario.
    pub scenario: Scenario,
    /// What looks wrong with it.
    pub warnings: Warnings,
}

impl Setting {
    /// What people call it.
    #[must_use]
    pub fn label(&self) -> String {
        self.levels.join(", ")
    }
}

/// Reads the study file at `path`, its base and all its settings.
///
/// # Errors
/// Everything that is wrong with the study; or with its base; or with the combinations.
pub fn load_study(path: &Path) -> Result<Plan, Report> {
    let text = contents(path)?;
    let shown = path.display().to_string();
    let study: Study = document(&shown, &text, &[])?;
    let file = File {
        name: &shown,
        text: text.as_str().into(),
    };
    let base = path.parent().unwrap_or(Path::new("")).join(&study.base);
    let base_text = contents(&base).map_err(|report| file.blame("base", report))?;
    parse(&base.display().to_string(), &base_text, &[])?;
    let settings = file.settings(&study, &base.display().to_string(), &base_text)?;
    let plan = Plan {
        name: study.name.clone(),
        question: question(&text),
        factors: study
            .factors
            .iter()
            .map(|factor| {
                (
                    factor.name.clone(),
                    factor.levels.iter().map(super::LevelConfig::label).collect(),
                )
            })
            .collect(),
        figures: std::iter::once(&study.figure).chain(&study.also).cloned().collect(),
        reference: settings.iter().position(|setting| setting.levels == study.reference),
        relevant: study.relevant.get(),
        pareto: study.pareto.clone().map(|(x, y)| [x, y]),
        most_trials: None,
        trials_place: file.diagnose(Problem::new("trials", "", "")).place,
        warnings: Warnings::default(),
        settings,
    };
    let problems = figures::problems(&plan.scenarios(), &plan.figures, study.also.len(), plan.pareto.as_ref());
    if problems.is_empty() {
        Ok(plan)
    } else {
        let diagnostics: Vec<_> = problems.into_iter().map(|problem| file.diagnose(problem)).collect();
        Err(Report::from(diagnostics))
    }
}

/// Makes a plan of scenario files, each a setting with the seed and the trials of its own, compared in all pairs.
///
/// # Errors
/// Everything that is wrong with the files, or that keeps them from being compared.
pub fn plan_of_files<P: AsRef<Path>>(files: &[P]) -> Result<Plan, Report> {
    let mut diagnostics = Vec::new();
    let mut settings: Vec<Setting> = Vec::new();
    for file in files {
        let read = contents(file.as_ref());
        match read.and_then(|text| examine(&file.as_ref().display().to_string(), &text, &[])) {
            Ok((scenario, warnings)) => settings.push(Setting {
                name: scenario.name.clone(),
                levels: vec![scenario.name.clone()],
                scenario,
                warnings,
            }),
            Err(report) => diagnostics.extend(report.diagnostics),
        }
    }
    let twice = |(index, setting): (usize, &Setting)| {
        let earlier = settings[..index].iter().any(|other| other.name == setting.name);
        earlier.then(|| Diagnostic {
            message: format!("two scenarios are called {:?}", setting.name),
            help: Some("give each a name of its own: it names the folder of its results".into()),
            path: None,
            place: None,
        })
    };
    diagnostics.extend(settings.iter().enumerate().filter_map(twice));
    if !diagnostics.is_empty() {
        return Err(Report::from(diagnostics));
    }
    let names: Vec<String> = settings.iter().map(|setting| setting.name.clone()).collect();
    let joined = names.join("-vs-");
    let mut plan = Plan {
        name: if is_name(&joined) { joined } else { "comparison".into() },
        question: None,
        factors: vec![("scenario".into(), names)],
        settings,
        figures: Vec::new(),
        reference: None,
        relevant: 0.05,
        pareto: None,
        most_trials: None,
        trials_place: None,
        warnings: Warnings::default(),
    };
    plan.figures = figures::usual(&plan.scenarios());
    Ok(plan)
}

impl Plan {
    /// The scenarios of its settings.
    fn scenarios(&self) -> Vec<&Scenario> {
        self.settings.iter().map(|setting| &setting.scenario).collect()
    }

    /// Compares these figures instead.
    ///
    /// # Errors
    /// If a setting does not have one of them.
    pub fn with_figures(mut self, keys: &[String]) -> Result<Self, Report> {
        if !keys.is_empty() {
            self.figures = keys.to_vec();
        }
        let known = figures::common(&self.scenarios());
        let unknown = self.figures.iter().filter(|key| !known.contains(key));
        let diagnostics: Vec<_> = unknown
            .map(|key| Diagnostic {
                message: figures::unknown(key, &known),
                help: Some(figures::help(&known)),
                path: None,
                place: None,
            })
            .collect();
        if diagnostics.is_empty() {
            Ok(self)
        } else {
            Err(Report::from(diagnostics))
        }
    }

    /// What looks wrong with the study and with its settings; what does with several of them is said once.
    #[must_use]
    pub fn all_warnings(&self) -> Warnings {
        let mut found: Vec<(Diagnostic, Vec<&Setting>)> = Vec::new();
        for setting in &self.settings {
            for diagnostic in &setting.warnings.diagnostics {
                match found.iter_mut().find(|(known, _)| known == diagnostic) {
                    Some((_, settings)) => settings.push(setting),
                    None => found.push((diagnostic.clone(), vec![setting])),
                }
            }
        }
        let said = found.into_iter().map(|(diagnostic, settings)| {
            let whose = match &settings[..] {
                all if all.len() == self.settings.len() => String::new(),
                [one] => format!("setting {}: ", one.label()),
                [first, others @ ..] => format!("setting {} and {} more: ", first.label(), others.len()),
                [] => String::new(),
            };
            Diagnostic {
                message: format!("{whose}{}", diagnostic.message),
                ..diagnostic
            }
        });
        let few = self.too_few_trials();
        let whole = self.warnings.diagnostics.iter().cloned().chain(few);
        let mut diagnostics: Vec<Diagnostic> = whole.chain(said).collect();
        let beyond = diagnostics.len().saturating_sub(limits::DIAGNOSTICS);
        diagnostics.truncate(limits::DIAGNOSTICS);
        let unplaced = self.settings.iter().map(|setting| setting.warnings.more);
        Warnings {
            diagnostics,
            more: self.warnings.more + beyond + unplaced.max().unwrap_or(0),
        }
    }

    /// Adds trials until there are `most` of each setting, or enough.
    #[must_use]
    pub fn with_most_trials(mut self, most: u32) -> Self {
        self.most_trials = Some(most);
        self
    }

    /// Runs so many trials of each setting instead.
    #[must_use]
    pub fn with_trials(mut self, trials: u32) -> Self {
        for setting in &mut self.settings {
            setting.scenario.trials = trials;
        }
        self.trials_place = None;
        self
    }
}

/// A study file.
struct File<'a> {
    name: &'a str,
    text: Arc<str>,
}

impl File<'_> {
    /// Every setting, its levels worked into the base.
    fn settings(&self, study: &Study, base: &str, base_text: &str) -> Result<Vec<Setting>, Report> {
        let mut settings = Vec::new();
        let mut found: Vec<(Vec<String>, Diagnostic)> = Vec::new();
        for combination in combinations(study) {
            let labels = labels(study, &combination);
            match examine(base, base_text, &self.overrides(study, &combination)) {
                Ok((scenario, warnings)) => settings.push(Setting {
                    name: name(&labels),
                    scenario: Scenario {
                        name: name(&labels),
                        trials: study.trials,
                        seed: study.seed,
                        ..scenario
                    },
                    levels: labels,
                    warnings,
                }),
                Err(report) => {
                    for diagnostic in report.diagnostics {
                        // What is wrong with a level is wrong in many combinations, and said once.
                        if !found.iter().any(|(_, known)| *known == diagnostic) {
                            found.push((labels.clone(), diagnostic));
                        }
                    }
                }
            }
        }
        if found.is_empty() {
            return Ok(settings);
        }
        let more = found.len().saturating_sub(limits::DIAGNOSTICS);
        found.truncate(limits::DIAGNOSTICS);
        let said = found.into_iter().map(|(labels, diagnostic)| Diagnostic {
            message: format!("setting {}: {}", labels.join(", "), diagnostic.message),
            ..diagnostic
        });
        Err(Report {
            diagnostics: said.collect(),
            more,
        })
    }

    /// The levels of a combination as overrides that stand in the study file.
    fn overrides(&self, study: &Study, combination: &[usize]) -> Vec<Override> {
        let Some(root) = tree::read(&self.text).0 else {
            return Vec::new();
        };
        let node = |path: String| follow(&root, &FieldPath::of(&path), &self.text).node;
        let mut overrides = Vec::new();
        for (factor, level) in combination.iter().enumerate() {
            for index in 0..study.factors[factor].paths.len() {
                let path = &node(format!("factors[{factor}].paths[{index}]")).span;
                // Within its quotes.
                let path = path.start + 1..path.end.saturating_sub(1).max(path.start + 1);
                let value = &node(format!("factors[{factor}].levels[{level}].values[{index}]")).span;
                overrides.extend(Override::within(self.name, &self.text, &path, value));
            }
        }
        overrides
    }

    /// Places what is wrong with another file at the field that names it.
    fn blame(&self, field: &str, report: Report) -> Report {
        let diagnostics = report.diagnostics.into_iter().map(|diagnostic| {
            let help = "give the path of a scenario file, relative to the study file";
            self.diagnose(Problem::new(field, diagnostic.message, help))
        });
        Report::from(diagnostics.collect::<Vec<_>>())
    }

    fn diagnose(&self, problem: Problem) -> Diagnostic {
        let path = Some(problem.path.clone());
        let Some(root) = tree::read(&self.text).0 else {
            return Diagnostic {
                message: problem.message,
                help: problem.help,
                path,
                place: None,
            };
        };
        let finding = between(problem, &root, &self.text);
        Diagnostic {
            message: finding.message,
            help: finding.help,
            path,
            place: Some(Place::new(self.name, &self.text, finding.span, finding.label)),
        }
    }
}

//! An oracle: a form, and the scenario by which it is measured.

use std::fmt::Write as _;

use crate::metrics::TrialRecord;
use crate::statistics::Part;

/// How a figure is read off a finished trial: a numerator and a denominator, both 0 where the trial tells nothing.
pub(super) type Reading = Box<dyn Fn(&TrialRecord) -> Part + Send + Sync>;

/// What a form is wrong by, as far as that is known, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Margin {
    /// So much either way, in the unit of the row.
    pub size: f64,
    /// What the form leaves out.
    pub why: &'static str,
}

/// An oracle and how it is measured.
pub struct Row {
    /// Its model: a word or two that many rows share.
    pub model: &'static str,
    /// Its name, unique among all rows.
    pub name: String,
    /// The form in words and symbols, with its source.
    pub form: String,
    /// Unit of what follows; empty for plain numbers.
    pub unit: &'static str,
    /// What the form gives.
    pub expected: f64,
    /// What the form is wrong by, if it is no exact one.
    pub margin: Option<Margin>,
    /// How many trials its scenario has.
    pub trials: u32,
    /// How finely records keep what is measured, relative: no interval is narrower.
    pub resolution: f64,
    /// Whether nothing is left to chance: then every trial must give what the form does.
    pub is_exact: bool,
    seconds: f64,
    sections: Vec<String>,
    reading: Reading,
}

/// How finely records keep what they hold.
const RESOLUTION: f64 = 1e-6;

impl Row {
    /// A row of `model` that holds `expected` against what `reading` reads off trials of `seconds` whose scenario has these `sections`.
    pub(super) fn new(
        model: &'static str,
        name: impl Into<String>,
        (expected, unit): (f64, &'static str),
        (seconds, sections): (f64, Vec<String>),
        reading: impl Fn(&TrialRecord) -> Part + Send + Sync + 'static,
    ) -> Self {
        Self {
            model,
            name: name.into(),
            form: String::new(),
            unit,
            expected,
            margin: None,
            trials: 20,
            resolution: RESOLUTION,
            is_exact: false,
            seconds,
            sections,
            reading: Box::new(reading),
        }
    }

    /// The same, with its form in words.
    #[must_use]
    pub(super) fn form(mut self, form: impl Into<String>) -> Self {
        self.form = form.into();
        self
    }

    /// The same, in so many trials.
    #[must_use]
    pub(super) fn trials(mut self, trials: u32) -> Self {
        self.trials = trials;
        self
    }

    /// The same, whose form is wrong by up to `size` of what it gives.
    #[must_use]
    pub(super) fn within(self, size: f64, why: &'static str) -> Self {
        let size = size * self.expected.abs();
        self.give_or_take(size, why)
    }

    /// The same, whose form is wrong by up to `size`, in its unit.
    #[must_use]
    pub(super) fn give_or_take(mut self, size: f64, why: &'static str) -> Self {
        self.margin = Some(Margin { size, why });
        self
    }

    /// The same, where nothing is left to chance, and records hold what is measured to a share of `resolution`.
    #[must_use]
    pub(super) fn exact_to(self, resolution: f64) -> Self {
        Self {
            resolution,
            ..self.exact()
        }
    }

    /// The same, where nothing is left to chance.
    #[must_use]
    pub(super) fn exact(mut self) -> Self {
        self.is_exact = true;
        self.trials = 2;
        self
    }

    /// Its scenario with this seed, as a file that `desim scenario` runs.
    #[must_use]
    pub fn scenario(&self, seed: u64) -> String {
        let Self {
            name,
            form,
            trials,
            seconds,
            ..
        } = self;
        let folder = name.replace('.', "_");
        let mut text = format!(
            "// {name}: {form}\nScenario(\n    name: \"{folder}\",\n    trials: {trials},\n    seed: {seed},\n    time_limit: {seconds:?},\n"
        );
        for section in &self.sections {
            // Writing to a string does not fail.
            let _ = writeln!(text, "    {section},");
        }
        text.push_str(")\n");
        text
    }

    /// Whether trials of another row are its own: but for its name, a trial follows from the scenario.
    pub(super) fn runs_as(&self, other: &Self) -> bool {
        let runs = |row: &Self| (row.trials, row.seconds.to_bits());
        runs(self) == runs(other) && self.sections == other.sections
    }

    /// The same over another scenario.
    #[cfg(test)]
    pub(super) fn with_other(mut self, from: &str, to: &str) -> Self {
        let before = self.sections.clone();
        self.sections
            .iter_mut()
            .for_each(|section| *section = section.replace(from, to));
        assert_ne!(before, self.sections, "nothing is as {from}");
        self
    }

    /// What a trial tells.
    #[must_use]
    pub fn read(&self, record: &TrialRecord) -> Part {
        (self.reading)(record)
    }
}

impl std::fmt::Debug for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Row")
            .field("name", &self.name)
            .field("expected", &self.expected)
            .finish_non_exhaustive()
    }
}

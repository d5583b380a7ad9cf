//! Reads scenario text. Where a field is wrong, it is reported, blanked out, and the rest is read again, so that one
//! pass names everything that is wrong.

use std::marker::PhantomData;
use std::sync::Arc;

use ron::error::Error;

use super::diagnostic::{Diagnostic, Place};
use super::document::Document;
use super::explain::{Finding, explain, nearest};
use super::overrides::Override;
use super::path::{FieldPath, Step, field_at, follow, head, path_at};
use super::report::{Report, Warnings};
use super::source::{Source, blank};
use super::token::{Faults, Span};
use super::tree;
use super::typed::{Failure, typed_by};
use super::{Scenario, limits};
use crate::kind::Problem;

/// Reads the scenario in `text`, the contents of the file `name`, with `overrides` worked in, in order.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse(name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, Report> {
    document(name, text, overrides)
}

/// Reads the scenario in `text` as [`parse`] does, and says too what looks wrong with one that holds.
///
/// # Errors
/// Everything that is wrong with it.
pub fn examine(name: &str, text: &str, overrides: &[Override]) -> Result<(Scenario, Warnings), Report> {
    let mut reader = Reader::new(name, text, overrides);
    let scenario: Scenario = reader.read()?;
    let (diagnostics, more) = reader.between(scenario.warnings());
    Ok((scenario, Warnings { diagnostics, more }))
}

/// Reads the document in `text`, the contents of the file `name`, with `overrides` worked in, in order.
///
/// # Errors
/// Everything that is wrong with it.
pub(super) fn document<D: Document>(name: &str, text: &str, overrides: &[Override]) -> Result<D, Report> {
    Reader::new(name, text, overrides).read()
}

/// What serde makes of `text`.
pub(super) fn typed<D: Document>(text: &str) -> Result<D, Box<Failure>> {
    typed_by(text, |reader| D::deserialize(reader)).map_err(|failure| D::nearer(failure, text))
}

/// How a text is changed so that the rest of it can be read. What stands before it keeps its place.
enum Repair {
    /// Without this field.
    LeaveOut(Span),
    /// With this field, at the end of the document.
    Add(usize, String),
}

struct Reader<'a, D> {
    name: &'a str,
    file: Arc<str>,
    overrides: &'a [Override],
    source: Source,
    diagnostics: Vec<Diagnostic>,
    /// How many faults are known beside the diagnostics.
    more: usize,
    document: PhantomData<D>,
}

impl<'a, D: Document> Reader<'a, D> {
    fn new(name: &'a str, text: &str, overrides: &'a [Override]) -> Self {
        Self {
            name,
            file: text.into(),
            overrides,
            source: Source::new(text),
            diagnostics: Vec::new(),
            more: 0,
            document: PhantomData,
        }
    }

    /// The document, or everything that is wrong with it.
    fn read(&mut self) -> Result<D, Report> {
        for (index, given) in self.overrides.iter().enumerate() {
            let resolved = typed(self.source.text()).ok().map(|document: D| document.to_ron());
            if let Err(misfit) = given.apply(index, &mut self.source, resolved.as_deref()) {
                self.diagnostics.extend(misfit.diagnostics);
            }
        }
        match self.document() {
            Some(document) if self.diagnostics.is_empty() => Ok(document.settled()),
            _ => Err(self.report()),
        }
    }

    /// The document, or what is left of it without its faults, whose diagnostics are kept.
    fn document(&mut self) -> Option<D> {
        let mut text = self.source.text().to_owned();
        let mut blanked = Vec::new();
        loop {
            match typed(&text) {
                Ok(document) => {
                    self.check(&document, &blanked);
                    return Some(document);
                }
                Err(failure) => match self.fault(&failure, &text, &mut blanked)? {
                    Repair::LeaveOut(span) => blank(&mut text, &span),
                    Repair::Add(at, field) => text.insert_str(at, &field),
                },
            }
        }
    }

    /// Reports a failure, unless an earlier one caused it. Answers how to read the rest without it, if there is a way.
    fn fault(&mut self, failure: &Failure, text: &str, blanked: &mut Vec<FieldPath>) -> Option<Repair> {
        let (root, faults) = tree::read(text);
        let Some(root) = root.filter(|_| faults.is_empty()) else {
            self.form(&faults, text);
            return None;
        };
        let finding = explain(
            &failure.error,
            &failure.path,
            failure.whole,
            &root,
            text,
            (D::KIND, D::shape()),
        );
        let missing = matches!(failure.error.code, Error::MissingStructField { .. });
        let field = if missing {
            follow(&root, &failure.path, text).field
        } else {
            field_at(&root, finding.span.start)
        };
        let path = field.map(|field| path_at(&root, field.start(), text));
        let caused = missing && blanked.iter().any(|path| stands_for(path, &finding.path));
        let finding_path = finding.path.clone();
        if !caused {
            self.add(finding);
        }
        if self.diagnostics.len() >= limits::DIAGNOSTICS {
            return None;
        }
        if let (Error::MissingStructField { field, .. }, None) = (&failure.error.code, field) {
            let stand_in = D::stand_in(field)?;
            blanked.push(finding_path);
            let group = root.group?;
            let comma = if group.items.last().is_some_and(|last| !last.comma) {
                ", "
            } else {
                ""
            };
            return Some(Repair::Add(group.inside.end, format!("{comma}{stand_in}")));
        }
        blanked.push(path?);
        field.map(|field| Repair::LeaveOut(field.start()..field.end))
    }

    /// Reports what is wrong with the form of the text.
    fn form(&mut self, faults: &Faults, text: &str) {
        let root = tree::read(text).0;
        self.more += faults.more;
        for fault in &faults.first {
            let path = root.as_ref().map(|root| path_at(root, fault.span.start, text));
            self.add(Finding {
                message: fault.message.clone(),
                help: Some(fault.help.clone()),
                path: path.unwrap_or_default(),
                span: fault.span.clone(),
                label: "here".into(),
            });
        }
        if faults.is_empty() {
            self.add(Finding {
                message: format!("the file holds no {}", D::KIND.to_lowercase()),
                help: Some(format!("a {} file holds `{}( ... )`", D::KIND.to_lowercase(), D::KIND)),
                path: FieldPath::default(),
                span: text.len()..text.len(),
                label: "the file ends here".into(),
            });
        }
    }

    /// Reports what is wrong between fields, but not what a fault of one of them may have caused.
    fn check(&mut self, document: &D, blanked: &[FieldPath]) {
        let text = self.source.text().to_owned();
        let (Some(root), _) = tree::read(&text) else {
            return;
        };
        let stands = |path: &FieldPath| follow(&root, path, &text).steps == path.0.len();
        let caused = |problem: &Problem| {
            problem.involved().map(FieldPath::of).any(|path| {
                let path = &path;
                // A field that the file leaves out may be the one that is misspelt beside it.
                let misspelt = |left_out: &FieldPath| !stands(path) && left_out.parent() == path.parent();
                let touches = |left_out: &FieldPath| left_out.holds(path) || path.holds(left_out);
                blanked.iter().any(|left_out| touches(left_out) || misspelt(left_out))
            })
        };
        let problems = document.problems().into_iter().filter(|problem| !caused(problem));
        let (found, more) = self.between(problems.collect());
        self.diagnostics.extend(found);
        self.more += more;
    }

    /// The first of `problems`, each placed, in the order of the text, and how many more there are.
    fn between(&self, problems: Vec<Problem>) -> (Vec<Diagnostic>, usize) {
        let text = self.source.text();
        let (Some(root), _) = tree::read(text) else {
            return (Vec::new(), problems.len());
        };
        let mut found: Vec<Finding> = problems
            .into_iter()
            .map(|problem| between(problem, &root, text))
            .collect();
        found.sort_by_key(|finding| finding.span.start);
        let more = found.len().saturating_sub(limits::DIAGNOSTICS);
        found.truncate(limits::DIAGNOSTICS);
        (found.into_iter().map(|finding| self.diagnose(finding)).collect(), more)
    }

    fn add(&mut self, finding: Finding) {
        let diagnostic = self.diagnose(finding);
        self.diagnostics.push(diagnostic);
    }

    fn diagnose(&self, finding: Finding) -> Diagnostic {
        let location = self.source.locate(&finding.span);
        let given = location.override_index.and_then(|index| self.overrides.get(index));
        let (prefix, name, text) = match given {
            Some(given) => (given.prefix(), given.name(), given.text()),
            None => (String::new(), self.name, &self.file),
        };
        Diagnostic {
            message: format!("{prefix}{}", finding.message),
            help: finding.help,
            path: Some(finding.path.to_string()).filter(|path| !path.is_empty()),
            place: Some(Place::new(name, text, location.span, finding.label)),
        }
    }

    fn report(&mut self) -> Report {
        // By line; what stands in overrides comes after the file.
        let mut diagnostics = std::mem::take(&mut self.diagnostics);
        diagnostics.sort_by_key(|diagnostic| {
            let place = diagnostic.place.as_ref();
            place.map(|place| (place.name != self.name, place.line, place.column))
        });
        let more = self.more + diagnostics.len().saturating_sub(limits::DIAGNOSTICS);
        diagnostics.truncate(limits::DIAGNOSTICS);
        Report { diagnostics, more }
    }
}

/// Whether `blanked` is the field `missing`, or a misspelt name of it.
fn stands_for(blanked: &FieldPath, missing: &FieldPath) -> bool {
    let (blanked, missing) = (blanked.plain(), missing.plain());
    match (blanked.0.last(), missing.0.last()) {
        (Some(Step::Field(found)), Some(Step::Field(known))) if blanked.parent() == missing.parent() => {
            found == known || nearest(found, &[known]).is_some()
        }
        _ => false,
    }
}

/// Places a problem at its field, or where that is left out, at another that it depends on, or at what is around it.
pub(super) fn between(problem: Problem, root: &tree::Node, text: &str) -> Finding {
    let stands = |path: &FieldPath| {
        let place = follow(root, path, text);
        place.steps == path.0.len()
    };
    let changed = FieldPath::of(&problem.path);
    let path = problem.involved().map(FieldPath::of).find(stands);
    let place = follow(root, path.as_ref().unwrap_or(&changed), text);
    let (span, label) = match (&path, place.field) {
        (Some(_), _) if place.node.group.is_none() => (place.node.span.clone(), "here".to_owned()),
        (None, Some(field)) => {
            let key = field.key.clone().unwrap_or_else(|| head(place.node));
            (key, format!("leaves `{changed}` at its default"))
        }
        (None, None) => (head(place.node), format!("leaves `{changed}` at its default")),
        (Some(_), _) => (head(place.node), "here".to_owned()),
    };
    Finding {
        message: problem.message,
        help: problem.help,
        path: changed,
        span,
        label,
    }
}

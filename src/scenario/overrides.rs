//! `--set path=value`: a value of a scenario, given beside its file.

use std::str::FromStr;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Place};
use super::path::{FieldPath, Step, contents, follow, parts, variant};
use super::report::Report;
use super::shape::Shape;
use super::source::{Origin, Piece, Source};
use super::token::Span;
use super::tree::{self, Node};

/// A value of a scenario, given beside its file as `path=value`, such as `radio.loss=Bernoulli(0.3)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Where it is given: `--set`, or the name of a study file.
    name: Arc<str>,
    /// All of the text that it stands in.
    text: Arc<str>,
    path: FieldPath,
    /// Where each step of the path stands in the text.
    steps: Vec<Span>,
    /// Where the value stands in the text.
    value: Span,
}

/// What overrides of the command line are given by.
const COMMAND_LINE: &str = "--set";

impl FromStr for Override {
    type Err = Report;

    fn from_str(text: &str) -> Result<Self, Report> {
        let text: Arc<str> = text.into();
        let fault = |span: Span, message: &str, help: &str| {
            Report::from(Diagnostic {
                message: format!("--set {text}: {message}"),
                help: Some(help.into()),
                path: None,
                place: Some(Place::new("--set", &text, span, "here")),
            })
        };
        let Some(equals) = text.find('=') else {
            return Err(fault(
                0..text.len(),
                "no `=`",
                "write path=value, such as radio.loss=Bernoulli(0.3)",
            ));
        };
        let written = text[..equals].trim_end();
        let mut path = FieldPath::default();
        let mut steps = Vec::new();
        for (part, start) in parts(written) {
            let span = start..start + part.len();
            let Some(step) = Step::parse(part) else {
                return Err(fault(
                    span,
                    "not a path of a field",
                    "write names with dots between, such as radio.range",
                ));
            };
            path.0.push(step);
            steps.push(span);
        }
        let value = equals + 1;
        let (node, faults) = tree::read(&text[value..]);
        if let Some(first) = faults.first.first() {
            let span = value + first.span.start..value + first.span.end;
            return Err(fault(span, &first.message, &first.help));
        }
        let Some(node) = node else {
            return Err(fault(
                equals..value,
                "no value after `=`",
                "write one as it would stand in the file",
            ));
        };
        let value = value + node.span.start..value + node.span.end;
        Ok(Self {
            name: COMMAND_LINE.into(),
            text,
            path,
            steps,
            value,
        })
    }
}

/// Why an override has no place in a file.
struct Misfit {
    step: usize,
    message: String,
    help: String,
}

impl Override {
    /// The override that stands in a larger text, the file `name`: its path in `path`, its value in `value`. `None` if that is no
    /// path of a field.
    #[must_use]
    pub fn within(name: &str, text: &Arc<str>, path: &Span, value: &Span) -> Option<Self> {
        let mut given = Self {
            name: name.into(),
            text: Arc::clone(text),
            path: FieldPath::default(),
            steps: Vec::new(),
            value: value.clone(),
        };
        for (part, start) in parts(&text[path.clone()]) {
            given.path.0.push(Step::parse(part)?);
            given.steps.push(path.start + start..path.start + start + part.len());
        }
        Some(given)
    }

    /// Where it is given: `--set`, or the name of a file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text that it stands in: as it was given, or a whole file.
    #[must_use]
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// What a message about this override begins with.
    #[must_use]
    pub fn prefix(&self) -> String {
        if self.is_of_command_line() {
            format!("--set {}: ", self.text)
        } else {
            String::new()
        }
    }

    fn is_of_command_line(&self) -> bool {
        *self.name == *COMMAND_LINE
    }

    /// Works the override, the `index`th, into `source`. `resolved` is the whole scenario with its defaults, where the
    /// file is one: a field that the file leaves out is then set within its defaults.
    ///
    /// # Errors
    /// If the path leads into a list or a variant that the file does not have.
    pub fn apply(&self, index: usize, source: &mut Source, resolved: Option<&str>) -> Result<(), Report> {
        let text = source.text().to_owned();
        let (Some(root), faults) = tree::read(&text) else {
            return Ok(());
        };
        if !faults.is_empty() || root.group.is_none() {
            return Ok(());
        }
        let edit = Edit { given: self, index };
        let outcome = edit.place(&root, &text, source, resolved);
        outcome.map_err(|misfit| {
            Report::from(Diagnostic {
                message: format!("{}{}", self.prefix(), misfit.message),
                help: Some(misfit.help),
                path: Some(self.path.to_string()),
                place: Some(Place::new(
                    &self.name,
                    &self.text,
                    self.steps[misfit.step].clone(),
                    "here",
                )),
            })
        })
    }
}

struct Edit<'o> {
    given: &'o Override,
    index: usize,
}

impl Edit<'_> {
    fn place(&self, root: &Node, text: &str, source: &mut Source, resolved: Option<&str>) -> Result<(), Misfit> {
        let path = &self.given.path;
        let place = follow(root, path, text);
        let Some(step) = path.0.get(place.steps) else {
            // All of the path stands in the file.
            let span = match path.0.last() {
                Some(Step::Variant(_)) => {
                    let inside = place.node.group.as_ref().map(|group| group.inside.clone());
                    let Some(inside) = inside else {
                        let pieces = self.nested(place.steps - 1);
                        source.replace(&place.node.span, pieces);
                        return Ok(());
                    };
                    inside
                }
                _ => place.node.span.clone(),
            };
            source.replace(&span, vec![self.value()]);
            return Ok(());
        };
        match step {
            Step::Variant(_) if place.steps + 1 == path.0.len() => {
                source.replace(&place.node.span, self.nested(place.steps));
                Ok(())
            }
            Step::Field(name) if takes_fields(place.node) => {
                let added = self.added(name, place.steps, resolved)?;
                insert(place.node, source, added);
                Ok(())
            }
            _ => Err(self.misfit(place.node, text, place.steps)),
        }
    }

    fn misfit(&self, node: &Node, text: &str, step: usize) -> Misfit {
        let parent = FieldPath(self.given.path.0[..step].to_vec());
        let found = variant(node, text).unwrap_or("a list or a struct");
        let message = match &self.given.path.0[step] {
            Step::Index(index) => {
                let count = contents(node).map_or(0, |group| group.items.len());
                format!("`{parent}` has no element {index}: it has {count}, counted from 0")
            }
            Step::Variant(name) => format!("`{parent}` is `{found}` here, not `{name}`"),
            Step::Field(name) => format!("`{parent}` is `{found}` here, which has no field `{name}`"),
        };
        Misfit {
            step,
            message,
            help: if self.given.is_of_command_line() {
                format!("set the whole of it: --set {parent}=...")
            } else {
                format!("set the whole of it: {parent:?}", parent = parent.to_string())
            },
        }
    }

    /// `name: value` for a field that the file leaves out: within its defaults if they are known and have it.
    fn added(&self, name: &str, step: usize, resolved: Option<&str>) -> Result<Vec<Piece>, Misfit> {
        let within = match resolved {
            Some(resolved) if step + 1 < self.given.path.0.len() => self.within_defaults(step, resolved)?,
            _ => None,
        };
        let mut pieces = vec![self.around(step, &format!("{name}: "))];
        pieces.extend(within.unwrap_or_else(|| self.nested(step + 1)));
        Ok(pieces)
    }

    /// The field of this step as the resolved scenario has it, with the value worked in.
    fn within_defaults(&self, step: usize, resolved: &str) -> Result<Option<Vec<Piece>>, Misfit> {
        let field = FieldPath(self.given.path.0[..=step].to_vec());
        let mut defaults = Source::of(self.around(step, resolved));
        let Some(root) = tree::read(resolved).0 else {
            return Ok(None);
        };
        if follow(&root, &field, resolved).steps <= step {
            return Ok(None);
        }
        self.place(&root, resolved, &mut defaults, None)?;
        let root = tree::read(defaults.text()).0;
        Ok(root.map(|root| defaults.cut(follow(&root, &field, defaults.text()).node.span.clone())))
    }

    /// The value inside what the steps from `from` on lead through.
    fn nested(&self, from: usize) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut close = String::new();
        let steps = &self.given.path.0;
        for (step, name) in steps.iter().enumerate().skip(from) {
            let last = step + 1 == steps.len();
            let open = match name {
                Step::Variant(name) if !last => name.clone(),
                Step::Variant(name) => format!("{name}("),
                Step::Field(name) => format!("({name}: "),
                Step::Index(_) => "[".into(),
            };
            match open.chars().last() {
                Some('[') => close.insert(0, ']'),
                Some('(' | ' ') => close.insert(0, ')'),
                _ => {}
            }
            pieces.push(self.around(step, &open));
        }
        pieces.push(self.value());
        if !close.is_empty() {
            pieces.push(self.around(from, &close));
        }
        pieces
    }

    fn around(&self, step: usize, text: &str) -> Piece {
        Piece {
            text: text.into(),
            origin: Origin::Around {
                index: self.index,
                span: self.given.steps[step].clone(),
            },
        }
    }

    /// The value as given; a bare word where the scenario takes text is text.
    fn value(&self) -> Piece {
        let span = self.given.value.clone();
        let given = &self.given.text[span.clone()];
        let bare = given
            .chars()
            .all(|letter| letter.is_alphanumeric() || "_-".contains(letter));
        if bare && Shape::scenario().at(&self.given.path).is_some_and(Shape::is_text) {
            let index = self.index;
            return Piece {
                text: format!("{given:?}"),
                origin: Origin::Around { index, span },
            };
        }
        Piece {
            text: given.into(),
            origin: Origin::Override {
                index: self.index,
                start: span.start,
            },
        }
    }
}

/// Whether `node` is a struct, and not a list or a variant that holds a lone value.
fn takes_fields(node: &Node) -> bool {
    contents(node).is_some_and(|group| group.items.iter().all(|item| item.key.is_some()))
}

/// Adds a field at the end of what `node` holds.
fn insert(node: &Node, source: &mut Source, mut added: Vec<Piece>) {
    let Some(group) = contents(node) else {
        return;
    };
    if let (Some(last), Some(first)) = (group.items.last(), added.first_mut()) {
        let comma = if last.comma { " " } else { ", " };
        first.text.insert_str(0, comma);
    }
    source.replace(&(group.inside.end..group.inside.end), added);
}

//! Turns an error of the reader into what people need: which field, what is wrong, what would be right.

use ron::error::{Error, Position, SpannedError};

use super::lines::line_of;
use super::path::{FieldPath, Step, field, follow, head, path_at};
use super::shape::Shape;
use super::token::Span;
use super::tree::Node;

/// Longest expectation that a message still holds, bytes; a longer one goes into the help.
const SHORT: usize = 60;

/// Similarity (Jaro and Winkler, from 0 to 1) above which a name may be meant for another.
const NEAR: f64 = 0.75;

/// What is wrong, before it is placed in a file.
#[derive(Debug)]
pub struct Finding {
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
    /// The field.
    pub path: FieldPath,
    /// Where in the text that was read.
    pub span: Span,
    /// What the label says.
    pub label: String,
}

/// Explains `error`, which came up when serde had `reached` this path of `root` in `text`; `whole` is false if serde
/// could not name the last step. The file holds a `kind` of that `shape`.
pub fn explain(
    error: &SpannedError,
    reached: &FieldPath,
    whole: bool,
    root: &Node,
    text: &str,
    (kind, shape): (&'static str, Shape<'static>),
) -> Finding {
    let span = bytes(text, error.span.start)..bytes(text, error.span.end);
    let reader = Reader {
        root,
        text,
        span,
        kind,
        shape,
    };
    match &error.code {
        Error::NoSuchStructField { expected, found, .. } => reader.unknown_field(found, expected),
        Error::NoSuchEnumVariant { expected, found, .. } => reader.unknown_variant(found, expected, reached),
        Error::MissingStructField { field, .. } => reader.missing(field, reached),
        Error::DuplicateStructField { field, .. } => reader.duplicate(field, reached),
        Error::ExpectedDifferentStructName { found, .. } => reader.wrong_name(found, reached),
        Error::Message(message) => reader.refused(message, reached),
        other => {
            let path = if whole {
                reached.clone()
            } else {
                path_at(root, reader.span.start, text)
            };
            reader.mismatch(other, path)
        }
    }
}

struct Reader<'t> {
    root: &'t Node,
    text: &'t str,
    span: Span,
    /// What the file holds: `Scenario`, or `Study`.
    kind: &'static str,
    shape: Shape<'static>,
}

impl Reader<'_> {
    fn unknown_field(&self, found: &str, known: &[&str]) -> Finding {
        let path = path_at(self.root, self.span.start, self.text);
        let owner = self.owner(&path.parent());
        let elsewhere = self.shape.find(found).map(|path| path.to_string());
        let guesses: Vec<_> = nearest(found, known).into_iter().chain(elsewhere.as_deref()).collect();
        let guess = did_you_mean(&guesses);
        Finding {
            message: format!("unknown field `{found}` in {owner}{guess}"),
            help: Some(format!("known fields: {}", known.join(", "))),
            path,
            span: self.span.clone(),
            label: "unknown field".into(),
        }
    }

    fn unknown_variant(&self, found: &str, known: &[&str], path: &FieldPath) -> Finding {
        let expected = self.shape.at(path).map(Shape::expected);
        Finding {
            message: format!(
                "`{path}` cannot be `{found}`{}",
                did_you_mean(nearest(found, known).as_slice())
            ),
            help: Some(format!("expected {}", expected.unwrap_or_else(|| known.join(", ")))),
            path: path.clone(),
            span: self.span.clone(),
            label: "unknown name".into(),
        }
    }

    fn missing(&self, name: &str, reached: &FieldPath) -> Finding {
        let path = reached.join(Step::Field(name.into()));
        let shape = self.shape.at(&path);
        let expected = shape.map_or_else(String::new, |shape| format!(", {}", shape.expected()));
        let meaning = shape.and_then(Shape::meaning).unwrap_or_default();
        let place = follow(self.root, reached, self.text);
        Finding {
            message: format!("missing field `{name}` in {}", self.owner(reached)),
            help: Some(format!("add `{name}: ...`{expected}. {meaning}").trim().into()),
            path,
            span: head(place.node),
            label: format!("has no `{name}`"),
        }
    }

    fn duplicate(&self, name: &str, reached: &FieldPath) -> Finding {
        let path = reached.join(Step::Field(name.into()));
        let place = follow(self.root, reached, self.text);
        let first = place
            .node
            .group
            .as_ref()
            .and_then(|group| field(group, name, self.text));
        let line = first.map_or(0, |first| line_of(self.text, first.start()));
        Finding {
            message: format!("field `{name}` is given twice in {}", self.owner(reached)),
            help: Some(format!("remove this one or that of line {line}")),
            path,
            span: self.span.clone(),
            label: "the second".into(),
        }
    }

    fn wrong_name(&self, found: &str, path: &FieldPath) -> Finding {
        let (message, help) = if path.0.is_empty() {
            (
                format!(
                    "a {} file holds `{}( ... )`, not `{found}( ... )`",
                    self.word(),
                    self.kind
                ),
                format!("write `{}(`", self.kind),
            )
        } else {
            (
                format!("`{path}` takes no name `{found}`"),
                "write the round brackets without a name".into(),
            )
        };
        Finding {
            message,
            help: Some(help),
            path: path.clone(),
            span: self.span.clone(),
            label: "here".into(),
        }
    }

    fn refused(&self, message: &str, path: &FieldPath) -> Finding {
        Finding {
            message: format!("`{path}`: {message}"),
            help: self.meaning(path),
            path: path.clone(),
            span: self.span.clone(),
            label: "out of range".into(),
        }
    }

    /// The value is not of the form that the field takes.
    fn mismatch(&self, error: &Error, path: FieldPath) -> Finding {
        if path.0.is_empty() {
            return Finding {
                message: format!("not a {}: {error}", self.word()),
                help: Some(format!("a {} file holds `{}( ... )`", self.word(), self.kind)),
                path,
                span: self.span.clone(),
                label: "here".into(),
            };
        }
        let node = follow(self.root, &path, self.text).node;
        let found = excerpt(node, self.text);
        let (message, help) = match self.expected(&path, node) {
            _ if has_doubled_brackets(node) => (
                format!("`{path}` has two pairs of round brackets"),
                Some("write one pair after the name".into()),
            ),
            Some(expected) if is_mismatch(error) && expected.len() <= SHORT => (
                format!("`{path}` cannot be `{found}`: expected {expected}"),
                self.meaning(&path),
            ),
            Some(expected) if is_mismatch(error) => (
                format!("`{path}` cannot be `{found}`"),
                Some(format!("expected {expected}")),
            ),
            _ => (format!("`{path}` cannot be `{found}`: {error}"), self.meaning(&path)),
        };
        Finding {
            message,
            help,
            span: if node.group.is_none() {
                node.span.clone()
            } else {
                head(node)
            },
            path,
            label: "here".into(),
        }
    }
}

impl Reader<'_> {
    /// What people call the kind of file.
    fn word(&self) -> String {
        self.kind.to_lowercase()
    }

    /// What the field takes; of a variant that lacks its brackets, the variant with them.
    fn expected(&self, path: &FieldPath, node: &Node) -> Option<String> {
        let shape = self.shape.at(path)?;
        match path.0.last() {
            Some(Step::Variant(name)) if node.group.is_none() => Some(format!("`{}`", shape.in_variant(name))),
            _ => Some(shape.expected()),
        }
    }

    fn meaning(&self, path: &FieldPath) -> Option<String> {
        let text = self.shape.at(path)?.meaning()?;
        Some(format!("`{path}`: {text}"))
    }

    fn owner(&self, path: &FieldPath) -> String {
        if path.plain().0.is_empty() {
            format!("the {}", self.word())
        } else {
            format!("`{path}`")
        }
    }
}

/// Whether the error says no more than that something else was expected.
fn is_mismatch(error: &Error) -> bool {
    !matches!(
        error,
        Error::InvalidEscape(_)
            | Error::FloatUnderscore
            | Error::UnderscoreAtBeginning
            | Error::NoSuchExtension(_)
            | Error::ExceededRecursionLimit
            | Error::Utf8Error(_)
    )
}

/// `Name((...))`.
fn has_doubled_brackets(node: &Node) -> bool {
    let items = node.group.as_ref().map_or(&[][..], |group| &group.items);
    match items {
        [only] => node.name.is_some() && only.key.is_none() && only.value.is_bare_struct(),
        _ => false,
    }
}

/// What a value looks like, short enough for a message.
fn excerpt(node: &Node, text: &str) -> String {
    let all = &text[node.span.clone()];
    if all.chars().count() <= 40 && !all.contains('\n') {
        return all.into();
    }
    match &node.group {
        Some(_) => format!("{}...", &text[head(node)]),
        None => all.chars().take(40).chain("...".chars()).collect(),
    }
}

/// The known name that is nearest to `found`, if one is near.
pub fn nearest<'k>(found: &str, known: &[&'k str]) -> Option<&'k str> {
    let lower = found.to_lowercase();
    let scored = known
        .iter()
        .map(|name| (strsim::jaro_winkler(&lower, &name.to_lowercase()), *name));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(score, _)| *score > NEAR).map(|(_, name)| name)
}

fn did_you_mean(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        names => format!(", did you mean `{}`?", names.join("` or `")),
    }
}

/// The byte that a position of `ron` stands for.
fn bytes(text: &str, position: Position) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.line - 1).map(str::len).sum();
    let rest = &text[line..];
    let column = rest.char_indices().nth(position.col - 1);
    column.map_or(text.len(), |(offset, _)| line + offset)
}

//! Paths of fields, such as `protocol.targets.links` or `arena.obstacles[1].radius`, and where they stand in a file.

use std::fmt;

use super::token::Span;
use super::tree::{Group, Item, Node};

/// A path of a field, from the scenario inwards.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldPath(pub Vec<Step>);

/// A step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Into a field.
    Field(String),
    /// Into a variant of an enum: a name that begins with a capital. A path may leave it out.
    Variant(String),
    /// Into an element of a list, from 0.
    Index(usize),
}

impl FieldPath {
    /// Reads `a.b[2].c` or `a.Variant.b.2`; anything else is `None`.
    pub fn parse(text: &str) -> Option<Self> {
        let mut steps = Vec::new();
        for (part, _) in parts(text) {
            steps.push(Step::parse(part)?);
        }
        (!steps.is_empty()).then_some(Self(steps))
    }

    /// Reads a path that the code itself states.
    pub fn of(text: &str) -> Self {
        Self::parse(text).unwrap_or_default()
    }

    /// The path that serde had reached.
    pub fn reached(path: &serde_path_to_error::Path) -> Self {
        use serde_path_to_error::Segment;
        let steps = path.iter().filter_map(|segment| match segment {
            Segment::Seq { index } => Some(Step::Index(*index)),
            Segment::Map { key } => Some(Step::Field(key.clone())),
            Segment::Enum { variant } => Some(Step::Variant(variant.clone())),
            Segment::Unknown => None,
        });
        Self(steps.collect())
    }

    /// This path, one step further.
    pub fn join(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }

    /// The path without its last field, variants not counted.
    pub fn parent(&self) -> Self {
        let mut steps = self.plain().0;
        steps.pop();
        Self(steps)
    }

    /// The path without the names of variants.
    pub fn plain(&self) -> Self {
        let steps = self.0.iter().filter(|step| !matches!(step, Step::Variant(_)));
        Self(steps.cloned().collect())
    }

    /// Whether `other` is this field or lies within it, variants not counted.
    pub fn holds(&self, other: &Self) -> bool {
        other.plain().0.starts_with(&self.plain().0)
    }
}

/// The parts of a path as written, each with where it begins.
pub fn parts(text: &str) -> impl Iterator<Item = (&str, usize)> {
    let mut at = 0;
    text.split(['.', '[']).map(move |part| {
        let start = at;
        at += part.len() + 1;
        (part, start)
    })
}

impl Step {
    /// Reads one part of a path, a closing bracket after an index included.
    pub fn parse(part: &str) -> Option<Self> {
        let name = part.strip_suffix(']').unwrap_or(part);
        if let Ok(index) = name.parse() {
            return Some(Self::Index(index));
        }
        let known = |letter: char| letter.is_alphanumeric() || letter == '_';
        if name.is_empty() || name.len() < part.len() || !name.chars().all(known) {
            None
        } else if name.starts_with(char::is_uppercase) {
            Some(Self::Variant(name.into()))
        } else {
            Some(Self::Field(name.into()))
        }
    }
}

/// As people read it: without the names of variants, which the file itself shows.
impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, step) in self.plain().0.iter().enumerate() {
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Field(name) | Step::Variant(name) if place == 0 => f.write_str(name)?,
                Step::Field(name) | Step::Variant(name) => write!(f, ".{name}")?,
            }
        }
        Ok(())
    }
}

/// How far a path leads into a file.
#[derive(Debug)]
pub struct Place<'t> {
    /// The innermost value on the path that stands in the file.
    pub node: &'t Node,
    /// The innermost field on the path that stands in the file.
    pub field: Option<&'t Item>,
    /// How many steps of the path stand in the file.
    pub steps: usize,
}

/// Follows `path` from `root` as far as the file goes.
pub fn follow<'t>(root: &'t Node, path: &FieldPath, text: &str) -> Place<'t> {
    let mut place = Place {
        node: root,
        field: None,
        steps: 0,
    };
    for step in &path.0 {
        if !place.enter(step, text) {
            break;
        }
        place.steps += 1;
    }
    place
}

impl Place<'_> {
    /// Takes one step if the file has it.
    fn enter(&mut self, step: &Step, text: &str) -> bool {
        if let Step::Variant(name) = step {
            return variant(self.node, text) == Some(name);
        }
        let Some(group) = contents(self.node) else {
            return false;
        };
        let found = match step {
            Step::Index(index) => group.items.get(*index),
            Step::Field(name) | Step::Variant(name) => field(group, name, text),
        };
        if let Some(item) = found {
            self.node = &item.value;
            self.field = item.key.is_some().then_some(item).or(self.field);
        }
        found.is_some()
    }
}

/// The variant that `node` names, or the scalar that it is.
pub fn variant<'x>(node: &Node, text: &'x str) -> Option<&'x str> {
    let span = match (&node.name, &node.group) {
        (Some(name), _) => name,
        (None, None) => &node.span,
        (None, Some(_)) => return None,
    };
    text.get(span.clone())
}

/// The group that fields and elements of `node` lie in: its own, or in `At([..])` the one within.
pub fn contents(node: &Node) -> Option<&Group> {
    let group = node.group.as_ref()?;
    match group.items.as_slice() {
        [only] if node.name.is_some() && only.key.is_none() => only.value.group.as_ref().or(Some(group)),
        _ => Some(group),
    }
}

/// The first field called `name`.
pub fn field<'t>(group: &'t Group, name: &str, text: &str) -> Option<&'t Item> {
    group.items.iter().find(|item| {
        let key = item.key.as_ref().and_then(|key| text.get(key.clone()));
        key == Some(name)
    })
}

/// The innermost field that has `at` within it.
pub fn field_at(root: &Node, at: usize) -> Option<&Item> {
    let mut found = None;
    let mut node = root;
    while let Some(group) = &node.group {
        let inside = |item: &&Item| (item.start()..=item.value.span.end).contains(&at);
        let Some(item) = group.items.iter().find(inside) else {
            break;
        };
        found = item.key.is_some().then_some(item).or(found);
        node = &item.value;
    }
    found
}

/// The path of the innermost field that has `at` within it, its element included.
pub fn path_at(root: &Node, at: usize, text: &str) -> FieldPath {
    let mut path = FieldPath::default();
    let mut node = root;
    while let Some(group) = contents(node) {
        let inside = |item: &Item| (item.start()..=item.value.span.end).contains(&at);
        let Some(index) = group.items.iter().position(inside) else {
            break;
        };
        if let (Some(name), false) = (&node.name, path.0.is_empty()) {
            path.0.push(Step::Variant(text[name.clone()].into()));
        }
        let item = &group.items[index];
        match &item.key {
            Some(key) => path.0.push(Step::Field(text[key.clone()].into())),
            // What a variant such as `Bernoulli(0.2)` holds has no step of its own.
            None if node.name.is_some() && group.items.len() == 1 && node.group.as_ref() == Some(group) => {}
            None => path.0.push(Step::Index(index)),
        }
        node = &item.value;
    }
    path
}

/// The opening of `node` up to its first line's end or its contents: enough to point at.
pub fn head(node: &Node) -> Span {
    let end = node.group.as_ref().map_or(node.span.end, |group| group.inside.start);
    node.span.start..end
}

#[cfg(test)]
mod tests {
    use super::super::tree::read;
    use super::*;

    const TEXT: &str = "Scenario(a: 1, p: Variant(targets: Ring(links: 2)), list: At([(1, 2), (3, x)]), none: None)";

    fn at(path: &str) -> (&'static str, usize) {
        let root = read(TEXT).0.expect("the text has a value");
        let place = follow(&root, &FieldPath::of(path), TEXT);
        (&TEXT[place.node.span.clone()], place.steps)
    }

    #[test]
    fn a_path_finds_its_value_with_or_without_the_names_of_variants() {
        assert_eq!(at("a"), ("1", 1));
        assert_eq!(at("p.Variant.targets.Ring.links"), ("2", 5));
        assert_eq!(at("p.targets.links"), ("2", 3));
        assert_eq!(at("list.At[1][1]"), ("x", 4));
        assert_eq!(at("list.1.1"), ("x", 3));
        assert_eq!(at("none.None"), ("None", 2));
    }

    #[test]
    fn a_path_that_the_file_lacks_leads_to_the_nearest_field_around_it() {
        assert_eq!(at("p.targets.radius"), ("Ring(links: 2)", 2));
        assert_eq!(at("p.Other.x"), ("Variant(targets: Ring(links: 2))", 1));
    }

    #[test]
    fn a_path_is_shown_without_the_names_of_variants() {
        assert_eq!(FieldPath::of("p.At.list[3].x").to_string(), "p.list[3].x");
        assert_eq!(FieldPath::parse("a..b"), None);
        assert_eq!(FieldPath::parse("a]"), None);
    }
}

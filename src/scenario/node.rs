//! Values of a RON text and where they stand.

use super::token::Span;

/// A value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// All of it, a leading name included.
    pub span: Span,
    /// The name before the bracket, of a struct or of an enum's variant.
    pub name: Option<Span>,
    /// What is in its brackets; `None` if it has none.
    pub group: Option<Group>,
}

/// What stands between two brackets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Where the opening bracket stands.
    pub opening: Span,
    /// From after the opening bracket to before the closing one.
    pub inside: Span,
    /// The values in order.
    pub items: Vec<Item>,
}

/// A value in a group, with its name if it is a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// The field's name.
    pub key: Option<Span>,
    /// Its value.
    pub value: Node,
    /// Where it ends, the comma that follows included.
    pub end: usize,
    /// Whether a comma follows.
    pub comma: bool,
}

impl Node {
    /// Whether it is `( ... )` without a name.
    pub fn is_bare_struct(&self) -> bool {
        self.name.is_none() && self.group.is_some()
    }
}

impl Item {
    /// Where it begins.
    pub fn start(&self) -> usize {
        self.key.as_ref().map_or(self.value.span.start, |key| key.start)
    }
}

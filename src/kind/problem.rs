//! What is wrong with a scenario, or looks so, between fields that are each of the right form.

/// Something wrong with a scenario, at a path such as `protocol.targets[0].at`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The field that is best changed.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What would be right, where the message does not say so.
    pub help: Option<String>,
    /// Other fields that it depends on.
    pub also: Vec<String>,
}

impl Problem {
    /// What is wrong at `path`, and what would be right.
    pub fn new(path: &str, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            message: message.into(),
            help: Some(help.into()),
            also: Vec::new(),
        }
    }

    /// A problem that a section found in itself, at a path relative to it.
    #[must_use]
    pub fn of_section(section: &str, (path, message): (String, String)) -> Self {
        let dot = if path.is_empty() || path.starts_with('[') {
            ""
        } else {
            "."
        };
        let path = format!("{section}{dot}{path}");
        Self {
            message: format!("`{path}`: {message}"),
            path,
            help: None,
            also: Vec::new(),
        }
    }

    /// The same, depending on these fields too.
    #[must_use]
    pub fn with(mut self, also: &[&str]) -> Self {
        self.also = also.iter().map(|path| (*path).to_owned()).collect();
        self
    }

    /// Every field that it depends on, first the one best changed.
    pub fn involved(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.path).chain(&self.also).map(String::as_str)
    }
}

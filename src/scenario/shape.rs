//! What a scenario may hold, field by field, read off its JSON Schema: for messages that say what would be right.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

use serde_json::Value;

use super::path::{FieldPath, Step};

/// The schema of a value within a scenario.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'s> {
    root: &'s Value,
    here: &'s Value,
    /// Where the value stands: its own documentation and default, if it has them.
    place: &'s Value,
}

impl Shape<'static> {
    /// The schema of a whole scenario.
    pub fn scenario() -> Self {
        // One for each number of kinds of protocols that there were: they are added before anything is read, once or twice in a program.
        static SCHEMAS: Mutex<BTreeMap<usize, &'static Value>> = Mutex::new(BTreeMap::new());
        let mut schemas = SCHEMAS.lock().unwrap_or_else(PoisonError::into_inner);
        let root: &'static Value = schemas
            .entry(crate::kinds::names().len())
            .or_insert_with(|| Box::leak(Box::new(super::json_schema().to_value())));
        Self {
            root,
            here: root,
            place: root,
        }
    }
}

impl Shape<'static> {
    /// The schema of a whole study.
    pub fn study() -> Self {
        static SCHEMA: OnceLock<Value> = OnceLock::new();
        let root = SCHEMA.get_or_init(|| super::study_schema().to_value());
        Self {
            root,
            here: root,
            place: root,
        }
    }
}

impl<'s> Shape<'s> {
    /// The value at `path`, if scenarios have it.
    pub fn at(self, path: &FieldPath) -> Option<Self> {
        path.0.iter().try_fold(self, Self::step)
    }

    fn step(self, step: &Step) -> Option<Self> {
        match step {
            Step::Field(name) => self.field(name).or_else(|| {
                // Of an enum whose variant the path leaves out: the first variant that has such a field.
                let variants = self.choices().filter_map(Self::payload);
                variants.into_iter().find_map(|variant| variant.field(name))
            }),
            Step::Variant(name) => {
                let mut choices = self.choices().filter(|choice| choice.name() == Some(name));
                choices.next().and_then(Self::payload)
            }
            Step::Index(index) => {
                let tuple = self.here.get("prefixItems").and_then(|items| items.get(index));
                tuple.or_else(|| self.here.get("items")).map(|item| self.go(item))
            }
        }
    }

    fn go(self, place: &'s Value) -> Self {
        let named = place.get("$ref").and_then(Value::as_str);
        let target = named.and_then(|name| self.root.pointer(name.trim_start_matches('#')));
        Self {
            root: self.root,
            here: target.unwrap_or(place),
            place,
        }
    }

    fn field(self, name: &str) -> Option<Self> {
        let field = self.here.get("properties")?.get(name)?;
        Some(self.go(field))
    }

    /// The variants, if it is an enum.
    fn choices(self) -> impl Iterator<Item = Self> {
        let choices = self.here.get("oneOf").and_then(Value::as_array);
        choices.into_iter().flatten().map(move |choice| self.go(choice))
    }

    /// The name of a variant.
    fn name(self) -> Option<&'s str> {
        let unit = self.here.get("const").and_then(Value::as_str);
        unit.or_else(|| {
            self.here
                .get("properties")?
                .as_object()?
                .keys()
                .next()
                .map(String::as_str)
        })
    }

    /// What a variant holds.
    fn payload(self) -> Option<Self> {
        let payload = self.here.get("properties")?.as_object()?.values().next()?;
        Some(self.go(payload))
    }

    fn kind(self) -> &'s str {
        self.here.get("type").and_then(Value::as_str).unwrap_or_default()
    }

    /// Whether it is text.
    pub fn is_text(self) -> bool {
        self.kind() == "string" && self.here.get("enum").is_none()
    }

    /// Names of the fields of a struct, required ones first.
    pub fn fields(self) -> Vec<&'s str> {
        let all = self.here.get("properties").and_then(Value::as_object);
        let names: Vec<_> = all
            .into_iter()
            .flat_map(|fields| fields.keys().map(String::as_str))
            .collect();
        let (mut required, optional): (Vec<_>, Vec<_>) = names.into_iter().partition(|name| self.requires(name));
        required.extend(optional);
        required
    }

    /// Where in it a field called `name` is, variants included.
    pub fn find(self, name: &str) -> Option<FieldPath> {
        let mut found = Vec::new();
        self.search(name, &FieldPath::default(), &mut found);
        found.into_iter().min_by_key(|path| path.0.len())
    }

    fn search(self, name: &str, path: &FieldPath, found: &mut Vec<FieldPath>) {
        let fields = self
            .fields()
            .into_iter()
            .map(|field| (Step::Field(field.into()), field == name));
        let variants = self
            .choices()
            .filter_map(Self::name)
            .map(|name| (Step::Variant(name.into()), false));
        for (step, same) in fields.chain(variants) {
            let next = path.join(step.clone());
            if same {
                found.push(next);
            } else if let Some(inner) = self.step(&step) {
                inner.search(name, &next, found);
            }
        }
    }

    fn requires(self, field: &str) -> bool {
        let required = self.here.get("required").and_then(Value::as_array);
        required.is_some_and(|required| required.iter().any(|name| name == field))
    }

    /// The first sentence of its documentation.
    pub fn meaning(self) -> Option<&'s str> {
        let own = self.place.get("description").or_else(|| self.here.get("description"));
        let text = own.and_then(Value::as_str)?;
        let line = text.lines().next()?;
        Some(line.find(". ").map_or(line, |end| &line[..=end]))
    }

    /// What a value here looks like, in words: `a number above 0`, `one of None, Bernoulli(...)`.
    pub fn expected(self) -> String {
        let names: Vec<_> = self
            .choices()
            .filter_map(|choice| Some(choice.form(choice.name()?)))
            .collect();
        if !names.is_empty() {
            return list("one of", &names);
        }
        match self.kind() {
            "number" => format!("a number{}", self.range()),
            "integer" => format!("a whole number{}", self.range()),
            "boolean" => "true or false".into(),
            "string" => match self.here.get("enum").and_then(Value::as_array) {
                Some(names) => list("one of", &names.iter().filter_map(Value::as_str).collect::<Vec<_>>()),
                None => "text in double quotes".into(),
            },
            "array" => match self.here.get("prefixItems").and_then(Value::as_array) {
                Some(items) => self.tuple(items),
                None => "a list in square brackets".into(),
            },
            _ => format!("a struct: {}", fields_form(&self.fields())),
        }
    }

    fn tuple(self, items: &'s [Value]) -> String {
        let first = items.first().map(|item| self.go(item).expected()).unwrap_or_default();
        let first = first
            .strip_prefix("a ")
            .unwrap_or(&first)
            .replacen("number", "numbers", 1);
        format!("{} {first}, in round brackets", items.len())
    }

    fn form(self, name: &str) -> String {
        self.payload()
            .map_or_else(|| name.into(), |payload| payload.in_variant(name))
    }

    /// What the variant `name` looks like, this being what it holds.
    pub fn in_variant(self, name: &str) -> String {
        match self.kind() {
            "object" => format!("{name}{}", fields_form(&self.fields())),
            "array" => format!("{name}([...])"),
            "" => format!("{name}(...)"),
            _ => format!("{name}(number)"),
        }
    }

    fn range(self) -> String {
        let bound = |key: &str| self.here.get(key).and_then(Value::as_f64);
        let low = bound("minimum").map(|low| format!(" from {low}"));
        let low = low.or_else(|| bound("exclusiveMinimum").map(|low| format!(" above {low}")));
        let high = bound("maximum").or_else(|| self.largest_integer());
        let high = high.map(|high| format!(" to {high}"));
        format!("{}{}", low.unwrap_or_default(), high.unwrap_or_default())
    }

    fn largest_integer(self) -> Option<f64> {
        let format = self.here.get("format").and_then(Value::as_str)?;
        let bits: i32 = format.strip_prefix("uint")?.parse().ok()?;
        // Nobody counts that far in 64 bits.
        (bits < 64).then(|| 2_f64.powi(bits) - 1.0)
    }
}

fn fields_form(fields: &[&str]) -> String {
    let shown: Vec<_> = fields.iter().take(4).map(|field| format!("{field}: ...")).collect();
    let more = if fields.len() > shown.len() { ", ..." } else { "" };
    format!("({}{more})", shown.join(", "))
}

fn list(intro: &str, names: &[impl AsRef<str>]) -> String {
    let names: Vec<_> = names.iter().map(AsRef::as_ref).collect();
    match names.as_slice() {
        [only] => (*only).to_owned(),
        _ => format!("{intro} {}", names.join(", ")),
    }
}

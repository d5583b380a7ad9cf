//! results/README.md names the columns that the tables have: all of them, no others, in their order and with their types.

use std::fs::File;
use std::path::Path;

use desim::export::Tables;
use desim::metrics::figures::{Registry, Samples};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::Type;
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

use super::fixture::{record, run, scenario};

const README: &str = include_str!("../../../results/README.md");

/// A documented column: its name, in which `<…>` stands for any word, and its type.
#[derive(Debug)]
struct Documented {
    name: String,
    kind: String,
}

/// The columns that the README documents of `table`.
fn documented(table: &str) -> Vec<Documented> {
    let start = README
        .find(&format!("\n**{table}**"))
        .unwrap_or_else(|| panic!("{table} is not documented"));
    let section = &README[start + 1..];
    let end = section[2..]
        .find("\n**")
        .or_else(|| section.find("\n## "))
        .map_or(section.len(), |end| end + 2);
    let end = section.find("\n## ").map_or(end, |next| next.min(end));
    let rows = section[..end].lines().filter(|line| line.starts_with("| `"));
    rows.flat_map(columns_of_row).collect()
}

/// The columns of one row: one type for all of them, or one for each; `null` belongs to all.
fn columns_of_row(row: &str) -> Vec<Documented> {
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let names: Vec<&str> = cells[1].split('`').skip(1).step_by(2).collect();
    let (null, kinds): (Vec<&str>, Vec<&str>) = cells[2].split(", ").partition(|kind| *kind == "null");
    let null = if null.is_empty() { "" } else { ", null" };
    assert!(kinds.len() == 1 || kinds.len() == names.len(), "{row}");
    let columns = names.iter().enumerate().map(|(index, name)| Documented {
        name: (*name).to_owned(),
        kind: format!("{}{null}", kinds[index.min(kinds.len() - 1)]),
    });
    columns.collect()
}

/// The columns of a file, by name and by the README's words for their type.
fn columns(path: &Path) -> Vec<(String, String)> {
    let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr().root_schema_ptr();
    let columns = schema.get_fields().iter();
    columns.map(|column| (column.name().to_owned(), kind(column))).collect()
}

fn kind(column: &Type) -> String {
    if column.is_group() {
        // A list: a group of one group of one column.
        let element = &column.get_fields()[0].get_fields()[0];
        return format!("list of {}", kind(element));
    }
    let info = column.get_basic_info();
    let kind = match info.logical_type_ref() {
        Some(LogicalType::String) => "text",
        Some(_) => "uint64",
        None => match column.get_physical_type() {
            Physical::INT32 => "int32",
            Physical::INT64 => "int64",
            Physical::FLOAT => "float32",
            Physical::DOUBLE => "float64",
            other => panic!("no column is {other}"),
        },
    };
    let null = if info.repetition() == Repetition::OPTIONAL {
        ", null"
    } else {
        ""
    };
    format!("{kind}{null}")
}

fn matches(documented: &str, name: &str) -> bool {
    match documented.split_once('<') {
        None => documented == name,
        Some((prefix, rest)) => {
            let suffix = rest.split_once('>').map_or("", |(_, suffix)| suffix);
            name.len() > prefix.len() + suffix.len() && name.starts_with(prefix) && name.ends_with(suffix)
        }
    }
}

#[test]
fn the_readme_names_exactly_the_columns_that_the_tables_have() {
    let dir = tempdir().unwrap();
    run(dir.path(), &scenario(3), 1, &CancellationToken::new(), |trial| {
        Ok(record(trial))
    })
    .unwrap();
    for table in Tables::FILES.into_iter().chain(Tables::OPTIONAL) {
        let mut found = columns(&dir.path().join(table)).into_iter().peekable();
        let mut rest = documented(table).into_iter().peekable();
        assert!(rest.peek().is_some(), "{table} has no documented columns");
        while let Some(column) = rest.next() {
            // Columns documented side by side with one word for many, such as `<topic>_frames`, take turns.
            let mut family = vec![column];
            while family[0].name.contains('<')
                && rest
                    .peek()
                    .is_some_and(|next| shares_a_word(&family[0].name, &next.name))
            {
                family.extend(rest.next());
            }
            // A column that is documented by its own name is not one of the many.
            let own = rest.peek().map(|next| next.name.clone());
            let is_of =
                |name: &String| Some(name) != own.as_ref() && family.iter().any(|column| matches(&column.name, name));
            let mut taken = 0;
            while let Some((name, kind)) = found.next_if(|(name, _)| is_of(name)) {
                let column = family.iter().find(|column| matches(&column.name, &name));
                assert_eq!(
                    column.map(|column| &column.kind),
                    Some(&kind),
                    "type of {name} in {table}"
                );
                taken += 1;
                if !family[0].name.contains('<') {
                    break;
                }
            }
            assert!(
                taken > 0,
                "{table} is documented to have {family:?}, next in it is {:?}",
                found.peek()
            );
        }
        assert_eq!(found.next(), None, "{table} has a column more than is documented");
    }
}

/// Whether both names stand for many by the same word.
fn shares_a_word(one: &str, other: &str) -> bool {
    let word = |name: &str| name.find('<').map(|at| name[at..].split('>').next().map(str::to_owned));
    word(one).is_some() && word(one) == word(other)
}

#[test]
fn every_file_of_a_finished_folder_is_in_the_readmes_list() {
    let tables = Tables::FILES.into_iter().chain(Tables::OPTIONAL);
    for table in tables.chain(["summary.json", "manifest.json"]) {
        assert!(README.contains(&format!("| `{table}` |")), "{table}");
    }
}

#[test]
fn the_readme_names_every_figure_of_the_general_list() {
    let registry = Registry::of(&["status"]);
    let none = Samples::new(registry.figures().count());
    let listed: Vec<&str> = registry
        .estimate(&none)
        .filter(|one| one.is_listed)
        .map(|one| one.figure.key.as_str())
        .collect();
    assert!(listed.len() >= 2);
    for key in listed {
        assert!(README.contains(&format!("`{key}`")), "{key} is not documented");
    }
}

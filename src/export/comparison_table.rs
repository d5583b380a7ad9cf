//! `comparison.parquet`: a row for setting × figure × trial.

use std::io;
use std::path::Path;
use std::rc::Rc;

use super::table::{Column, Table};
use crate::metrics::comparison::{Comparison, Trials};
use crate::metrics::figures::Sample;

/// A row.
struct Row {
    setting: Rc<str>,
    levels: Rc<[String]>,
    figure: Rc<str>,
    trial: u32,
    sample: Sample,
}

/// Writes the table to `path`.
///
/// # Errors
/// If it cannot be written.
pub fn write(path: &Path, comparison: &Comparison, trials: &[Trials]) -> io::Result<()> {
    let mut table = Table::create(path, columns(comparison))?;
    for setting in trials {
        let (name, levels): (Rc<str>, Rc<[String]>) = (setting.name.as_str().into(), setting.levels.as_slice().into());
        for (place, figure) in comparison.figures.iter().enumerate() {
            let key: Rc<str> = figure.key.as_str().into();
            table.extend((0..).zip(setting.of(place).samples()).map(|(trial, sample)| Row {
                setting: name.clone(),
                levels: levels.clone(),
                figure: key.clone(),
                trial,
                sample,
            }))?;
        }
    }
    table.finish()
}

fn columns(comparison: &Comparison) -> Vec<Column<Row>> {
    let mut columns = vec![Column::text("setting", |row: &Row| row.setting.to_string().into())];
    for (place, factor) in comparison.factors.iter().enumerate() {
        let name = format!("level_{}", factor.name.replace(' ', "_"));
        columns.push(Column::text(name, move |row: &Row| {
            row.levels.get(place).cloned().unwrap_or_default().into()
        }));
    }
    columns.extend([
        Column::text("figure", |row: &Row| row.figure.to_string().into()),
        Column::id("trial", |row: &Row| row.trial),
        Column::optional_f64("value", |row: &Row| row.sample.value()),
        Column::f64("numerator", |row: &Row| row.sample.part[0]),
        Column::f64("denominator", |row: &Row| row.sample.part[1]),
        Column::id("censored", |row: &Row| row.sample.is_censored.into()),
    ]);
    columns
}

//! `comparison.parquet` read back: what the trials of each setting tell of one figure.

use std::collections::BTreeMap;
use std::fs::File;

use super::table::{Table, Wrong};
use crate::metrics::figures::Told;
use crate::spool::Section;

/// What trials that have a value tell of the figure with the key `figure`, by the names of settings.
///
/// # Errors
/// If it is no such table.
pub fn told(file: File, figure: &str) -> Result<BTreeMap<String, Vec<Told>>, Wrong> {
    let mut table = Table::new(&Section::of(file, 0))?;
    let mut settings: BTreeMap<String, Vec<Told>> = BTreeMap::new();
    loop {
        let (names, figures) = (table.texts("setting")?, table.texts("figure")?);
        let (trials, censored) = (table.ids("trial")?, table.ids("censored")?);
        let values = table.optional_numbers("value")?;
        let rows = names.into_iter().zip(figures).zip(trials).zip(values).zip(censored);
        for ((((setting, key), trial), value), censored) in rows {
            if let Some(value) = value.filter(|_| key == figure) {
                let is_censored = censored != 0;
                settings.entry(setting).or_default().push(Told {
                    trial,
                    value,
                    is_censored,
                });
            }
        }
        if !table.advance(u32::MAX)? {
            return Ok(settings);
        }
    }
}

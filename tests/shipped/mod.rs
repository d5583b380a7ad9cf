//! The scenario and study files that the project ships.

use std::fs;
use std::path::{Path, PathBuf};

/// Paths of the scenario files, in order.
#[allow(dead_code)] // Not every test needs both.
pub fn files() -> Vec<PathBuf> {
    all(false)
}

/// Paths of the study files, in order.
#[allow(dead_code)] // Not every test needs both.
pub fn studies() -> Vec<PathBuf> {
    all(true)
}

fn all(studies: bool) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)
            .expect("the folder of scenarios is there")
            .flatten()
        {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "ron") && is_study(&path) == studies {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn is_study(path: &Path) -> bool {
    let text = fs::read_to_string(path).expect("shipped files can be read");
    desim::scenario::is_study(&text)
}

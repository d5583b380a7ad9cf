//! Names of the files in a results folder, but for the tables.

/// What a folder is the result of.
pub const MANIFEST: &str = "manifest.json";
/// The summary's file.
pub const SUMMARY: &str = "summary.json";
/// The page of charts. It follows from the other files and may be missing.
pub const PAGE: &str = "report.html";
/// The page on which trial 0 is watched.
pub const REPLAY: &str = "replay.html";
/// The page on which trial number `trial` is watched.
#[must_use]
pub fn replay_page(trial: u32) -> String {
    match trial {
        0 => REPLAY.to_owned(),
        other => format!("replay-{other}.html"),
    }
}

/// The trial that a page of this name shows, if it is called as such pages are.
#[must_use]
pub fn shows(name: &str) -> Option<u32> {
    let number = name.strip_prefix("replay")?.strip_suffix(".html")?;
    let trial = match number {
        "" => 0,
        _ => number.strip_prefix('-')?.parse().ok()?,
    };
    // Not `replay-007.html`, nor `replay-0.html`.
    (replay_page(trial) == name).then_some(trial)
}

/// Pictures of a trial, before its number.
pub const PICTURES: [&str; 2] = ["final", "trajectories"];
/// A trace of trial 0: a folder of tables, or, with an ending, a file.
pub const TRACE: &str = "trace";
/// How traces end that are files.
pub const TRACE_ENDINGS: [&str; 4] = ["pcapng", "mcap", "json", "json.gz"];
/// The tables of a trace.
pub const TRACE_TABLES: [&str; 5] = [
    "frames.parquet",
    "messages.parquet",
    "copies.parquet",
    "events.parquet",
    "places.parquet",
];

/// Whether a trace of some trial has this name: a folder, if it has no ending.
pub fn is_trace(name: &str) -> bool {
    let (name, ending) = name
        .split_once('.')
        .map_or((name, None), |(name, ending)| (name, Some(ending)));
    // Not `trace7`, nor `trace-007`, nor `trace-0`: those are somebody else's.
    let is_numbered = name
        .strip_prefix(TRACE)
        .is_some_and(|number| match number.strip_prefix('-') {
            None => number.is_empty(),
            Some(number) => number
                .parse::<u32>()
                .is_ok_and(|trial| trial > 0 && trial.to_string() == number),
        });
    is_numbered && ending.is_none_or(|ending| TRACE_ENDINGS.contains(&ending))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn traces_are_known_by_their_names() {
        for name in ["trace", "trace-7", "trace.pcapng", "trace-120.mcap", "trace-1.json.gz"] {
            assert!(is_trace(name), "{name}");
        }
        for name in [
            "trace7.pcapng",
            "trace-.pcapng",
            "trace-0.mcap",
            "trace-007.mcap",
            "trace.txt",
            "traces",
            "trace.pcapng.bak",
        ] {
            assert!(!is_trace(name), "{name}");
        }
    }

    #[test]
    fn pages_of_trials_are_known_by_their_names() {
        for trial in [0, 1, 7, 120] {
            assert_eq!(shows(&replay_page(trial)), Some(trial));
        }
        for name in [
            "report.html",
            "replay-007.html",
            "replay-0.html",
            "replay-.html",
            "replay-1.htm",
            "replay1.html",
        ] {
            assert_eq!(shows(name), None, "{name}");
        }
    }
}

//! `--shard`: which of the trials this process runs, as the user says or the scheduler does that started it.

use std::path::Path;

use serde_json::json;

use super::failure::Failure;
use super::output;
use super::shown::Format;
use crate::experiment::Shard;
use crate::runs::FinishedShard;
use crate::text::shown;

/// What `--shard` says in the help of a command.
pub const HELP: &str = "\
Run one shard of the trials only: I/N, number I of N, such as 2/4, or auto/N, the number from the scheduler. It leaves finished trials, which `desim merge` puts \
together";

/// The same at length.
pub const LONG_HELP: &str = "\
Run one shard of the trials only: number I of N, from 1, has the trials k with k mod N = I - 1. It leaves finished trials, and no report: `desim merge` puts \
the shards together, to the bytes that a run without shards gives. Shards may share a folder or have folders of their own (--out).

With auto/N the number comes from the scheduler that started this process: SLURM_ARRAY_TASK_ID or PBS_ARRAY_INDEX, which are to go from 1 to N, or JOB_COMPLETION_INDEX \
(Kubernetes), from 0 to N - 1. N is always given, so that a part of an array that is run again runs the same trials.";

/// Where schedulers say which task of an array a process is, with the number of the first.
const SCHEDULERS: [(&str, u32); 3] = [
    ("SLURM_ARRAY_TASK_ID", 1),
    ("PBS_ARRAY_INDEX", 1),
    ("JOB_COMPLETION_INDEX", 0),
];

/// Reads the argument of `--shard`.
///
/// # Errors
/// In words, if it names no shard.
pub fn shard(text: &str) -> Result<Shard, String> {
    shard_by(text, |name| std::env::var(name).ok())
}

fn shard_by(text: &str, variable: impl Fn(&str) -> Option<String>) -> Result<Shard, String> {
    let Some(of) = text.strip_prefix("auto/") else {
        return text.parse();
    };
    let of = of
        .parse()
        .map_err(|_| "expected auto/N, such as auto/4 for an array of four")?;
    let set: Vec<(&str, u32, String)> = SCHEDULERS
        .into_iter()
        .filter_map(|(name, first)| Some((name, first, variable(name)?)))
        .collect();
    let names = SCHEDULERS.map(|(name, _)| name).join(", ");
    match &set[..] {
        [] => Err(format!(
            "no scheduler says which: none of {names} is set; give the number, such as 1/{of}"
        )),
        [(name, first, value)] => {
            let last = u64::from(*first) + u64::from(of).saturating_sub(1);
            let number = value
                .parse()
                .ok()
                .and_then(|number: u32| number.checked_add(1)?.checked_sub(*first));
            let number = number.filter(|number| (1..=of).contains(number));
            let number = number
                .ok_or_else(|| format!("{name} is {value}, and of {of} shards it is to be from {first} to {last}"))?;
            Shard::new(number, of)
        }
        several => {
            let names: Vec<&str> = several.iter().map(|(name, ..)| *name).collect();
            Err(format!(
                "{} are set: give the number, such as 1/{of}",
                names.join(" and ")
            ))
        }
    }
}

/// Says what a shard has come to.
///
/// # Errors
/// If standard output cannot be written to.
pub fn print(
    shard: Shard,
    name: &str,
    dir: &Path,
    end: FinishedShard,
    (quiet, format): (bool, Format),
) -> Result<(), Failure> {
    use std::io::Write;
    let mut out = output::stdout();
    let FinishedShard { trials, is_merged } = end;
    match format {
        Format::Json => out.write_all(&crate::export::json(&json!({
            "name": name,
            "shard": shard.to_string(),
            "trials": trials,
            "folder": dir,
            "is_merged": is_merged,
        })))?,
        Format::Text if quiet || is_merged => {}
        Format::Text => {
            let dir = shown(dir);
            let of = if trials == 1 { "trial" } else { "trials" };
            writeln!(out, "shard {shard} of {name}: {trials} {of} in {dir}")?;
            writeln!(
                out,
                "once all shards are done, `desim merge` puts their folders together"
            )?;
        }
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auto(text: &str, variables: &[(&str, &str)]) -> Result<String, String> {
        let variable = |name: &str| {
            let found = variables.iter().find(|(own, _)| *own == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        shard_by(text, variable).map(|shard| shard.to_string())
    }

    #[test]
    fn each_scheduler_counts_from_its_own_first_number() {
        assert_eq!(auto("auto/4", &[("SLURM_ARRAY_TASK_ID", "1")]), Ok("1/4".to_owned()));
        assert_eq!(auto("auto/4", &[("SLURM_ARRAY_TASK_ID", "4")]), Ok("4/4".to_owned()));
        assert_eq!(auto("auto/4", &[("PBS_ARRAY_INDEX", "2")]), Ok("2/4".to_owned()));
        assert_eq!(auto("auto/4", &[("JOB_COMPLETION_INDEX", "0")]), Ok("1/4".to_owned()));
        assert_eq!(auto("auto/4", &[("JOB_COMPLETION_INDEX", "3")]), Ok("4/4".to_owned()));
        assert_eq!(auto("3/4", &[("SLURM_ARRAY_TASK_ID", "9")]), Ok("3/4".to_owned()));
    }

    #[test]
    fn what_is_out_of_range_is_refused_with_the_range() {
        for (name, value, range) in [
            ("SLURM_ARRAY_TASK_ID", "0", "from 1 to 4"),
            ("SLURM_ARRAY_TASK_ID", "5", "from 1 to 4"),
            ("SLURM_ARRAY_TASK_ID", "4294967295", "from 1 to 4"),
            ("PBS_ARRAY_INDEX", "-1", "from 1 to 4"),
            ("JOB_COMPLETION_INDEX", "4", "from 0 to 3"),
            ("JOB_COMPLETION_INDEX", "", "from 0 to 3"),
        ] {
            let refused = auto("auto/4", &[(name, value)]).unwrap_err();
            assert!(refused.contains(range) && refused.contains(name), "{refused}");
        }
        for text in ["auto/0", "auto/", "auto", "auto/1000001"] {
            assert!(auto(text, &[("SLURM_ARRAY_TASK_ID", "1")]).is_err(), "{text}");
        }
    }

    #[test]
    fn without_a_scheduler_or_with_two_the_number_is_asked_for() {
        assert!(auto("auto/4", &[]).unwrap_err().contains("1/4"));
        let two = [("SLURM_ARRAY_TASK_ID", "1"), ("JOB_COMPLETION_INDEX", "0")];
        assert!(
            auto("auto/4", &two)
                .unwrap_err()
                .contains("SLURM_ARRAY_TASK_ID and JOB_COMPLETION_INDEX")
        );
    }
}

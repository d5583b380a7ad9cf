//! How many trials run at a time where nobody says.

use std::num::NonZeroUsize;
use std::thread;

/// What Slurm says of a task's processors: those that were asked for, else those of its node that the job has.
const SLURM: [&str; 2] = ["SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"];

/// One for each processor that this process may use: as many as the machine has, the process is bound to and its control group allows, and no
/// more than Slurm has given to the task, which need not have bound it.
pub fn processors() -> NonZeroUsize {
    let available = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    allotted(available, |name| std::env::var(name).ok())
}

fn allotted(available: NonZeroUsize, variable: impl Fn(&str) -> Option<String>) -> NonZeroUsize {
    let given = SLURM.iter().find_map(|name| variable(name)?.parse().ok());
    given.map_or(available, |given: NonZeroUsize| given.min(available))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(available: usize, variables: &[(&str, &str)]) -> usize {
        let variable = |name: &str| {
            let found = variables.iter().find(|(own, _)| *own == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        allotted(NonZeroUsize::new(available).unwrap(), variable).get()
    }

    #[test]
    fn a_task_of_slurm_uses_what_it_was_given_and_no_more_than_there_is() {
        assert_eq!(of(8, &[]), 8);
        assert_eq!(of(8, &[("SLURM_CPUS_PER_TASK", "3")]), 3);
        assert_eq!(of(8, &[("SLURM_CPUS_PER_TASK", "3"), ("SLURM_CPUS_ON_NODE", "6")]), 3);
        assert_eq!(of(8, &[("SLURM_CPUS_ON_NODE", "1")]), 1);
        assert_eq!(of(2, &[("SLURM_CPUS_PER_TASK", "16")]), 2);
        assert_eq!(of(4, &[("SLURM_CPUS_PER_TASK", "0"), ("SLURM_CPUS_ON_NODE", "two")]), 4);
    }
}

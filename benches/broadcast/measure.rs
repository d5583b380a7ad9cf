//! Measuring a program from inside its own process, and several against each other in turn.

use std::process::Command;

use nix::sys::resource::{UsageWho, getrusage};

use crate::workload::Counts;

/// One run of one program.
pub struct Sample {
    pub simulated_s: f64,
    pub deliveries: u64,
    pub suspicions: u64,
    pub user_nanos: u64,
    pub peak_kib: u64,
}

impl Sample {
    /// User CPU nanoseconds a delivered frame.
    pub fn nanos(&self) -> f64 {
        self.user_nanos as f64 / self.deliveries as f64
    }

    /// Simulated seconds a second of user CPU: how many times faster than real time.
    pub fn speed(&self) -> f64 {
        self.simulated_s / (self.user_nanos as f64 / 1e9)
    }

    pub fn to_line(&self) -> String {
        let counts = [self.deliveries, self.suspicions, self.user_nanos, self.peak_kib];
        format!(
            "{} {}",
            self.simulated_s,
            counts.map(|count| count.to_string()).join(" ")
        )
    }

    fn of_line(line: &str) -> Self {
        let mut words = line.split_whitespace();
        let simulated_s = words
            .next()
            .and_then(|word| word.parse().ok())
            .expect("a number of seconds");
        let mut count = || words.next().and_then(|word| word.parse().ok()).expect("four counts");
        Self {
            simulated_s,
            deliveries: count(),
            suspicions: count(),
            user_nanos: count(),
            peak_kib: count(),
        }
    }
}

/// Runs `program` in this process. Building the run is counted: it is what users wait for, too.
pub fn sample(program: impl FnOnce() -> Counts) -> Sample {
    let before = user_nanos();
    let counts = program();
    let usage = getrusage(UsageWho::RUSAGE_SELF).expect("the system accounts for its processes");
    Sample {
        simulated_s: counts.simulated_s,
        deliveries: counts.deliveries,
        suspicions: counts.suspicions,
        user_nanos: user_nanos() - before,
        peak_kib: usage.max_rss() as u64,
    }
}

fn user_nanos() -> u64 {
    let usage = getrusage(UsageWho::RUSAGE_SELF).expect("the system accounts for its processes");
    let time = usage.user_time();
    time.tv_sec() as u64 * 1_000_000_000 + time.tv_usec() as u64 * 1_000
}

/// Runs each program once a round, in turn, each in a process of its own; samples by program.
pub fn rounds(rounds: usize, programs: &[&str], robots: u32) -> Vec<Vec<Sample>> {
    let mut samples: Vec<Vec<Sample>> = programs.iter().map(|_| Vec::new()).collect();
    for _ in 0..rounds {
        for (program, samples) in programs.iter().zip(&mut samples) {
            samples.push(in_child(program, robots));
        }
    }
    samples
}

fn in_child(program: &str, robots: u32) -> Sample {
    let myself = std::env::current_exe().expect("a running program has a path");
    let child = Command::new(myself)
        .args(["--program", program, "--robots", &robots.to_string()])
        .output()
        .expect("this program can be run again");
    assert!(
        child.status.success(),
        "{program} failed: {}",
        String::from_utf8_lossy(&child.stderr)
    );
    Sample::of_line(&String::from_utf8_lossy(&child.stdout))
}

/// The least user CPU a delivered frame among `samples`, nanoseconds.
pub fn least(samples: &[Sample]) -> f64 {
    samples.iter().map(Sample::nanos).fold(f64::INFINITY, f64::min)
}

//! The `broadcast` workload: what a delivered frame costs, against a bare event loop that does the same and nothing else.
//!
//! N robots stand still, uniform in a square in which a robot has 12 neighbours on average. Each broadcasts a 4-byte
//! status every 0.1 s at a phase of its own. A copy is lost with probability 0.2, or arrives after a truncated normal
//! latency. A neighbour not heard for 1.0 s is suspected at that very instant.
//!
//! `cargo bench` runs each program in a process of its own, in turn, and prints the median of the rounds and the ratios
//! within each round, which hold where the machine's speed drifts. `cargo bench -- --rounds 9` for more rounds.

mod bare;
mod measure;
mod swarm;
mod trial;
mod workload;

use desim::simulation::DriverKind;
use measure::Sample;
use workload::{Counts, Workload};

const PROGRAMS: [&str; 3] = ["bare", "inline", "actors"];
const TRIALS: [&str; 2] = ["trial, inline", "trial, actors"];
const SIZES: [u32; 3] = [80, 1_280, 20_480];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let value_of = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name)?;
        arguments.get(at + 1)
    };
    if let (Some(program), Some(robots)) = (value_of("--program"), value_of("--robots")) {
        let robots = robots.parse().expect("--robots takes a number");
        println!("{}", run_one(program, robots).to_line());
        return;
    }
    let rounds = value_of("--rounds").map_or(5, |rounds| rounds.parse().expect("--rounds takes a number"));
    compare(rounds);
}

/// Runs one program and measures it from inside its own process.
fn run_one(program: &str, robots: u32) -> Sample {
    let broadcast = |run: fn(&Workload) -> Counts| {
        let workload = Workload::new(robots);
        measure::sample(|| run(&workload))
    };
    match program {
        "bare" => broadcast(bare::run),
        "inline" => broadcast(|workload| swarm::run(workload, DriverKind::Inline)),
        "actors" => broadcast(|workload| swarm::run(workload, DriverKind::Actors)),
        "trial, inline" => measure::sample(|| trial::run(DriverKind::Inline)),
        "trial, actors" => measure::sample(|| trial::run(DriverKind::Actors)),
        other => panic!("no program is called `{other}`"),
    }
}

fn compare(rounds: usize) {
    println!("User CPU of one process; medians of {rounds} rounds, ratios taken within each round.\n");
    println!(
        "broadcast: 12 neighbours, loss 0.2, latency 10 ± 3 ms, timeout 1.0 s. Sends, losses and timers included."
    );
    println!(
        "{:>7}  {:8} {:>12} {:>13} {:>8} {:>12} {:>16} {:>11}",
        "robots", "program", "deliveries", "ns/delivery", "of bare", "per second", "peak memory", "suspicions"
    );
    for robots in SIZES {
        let results = measure::rounds(rounds, &PROGRAMS, robots);
        for (program, samples) in PROGRAMS.iter().zip(&results) {
            let ratios = samples
                .iter()
                .zip(&results[0])
                .map(|(sample, bare)| sample.nanos() / bare.nanos());
            let nanos = measure::median(samples.iter().map(Sample::nanos));
            let sample = &samples[0];
            println!(
                "{robots:>7}  {program:8} {:>12} {nanos:>13.1} {:>7.2}x {:>11.2}M {:>6.2} kB/robot {:>11}",
                sample.deliveries,
                measure::median(ratios),
                1e3 / nanos,
                sample.peak_kib as f64 / f64::from(robots),
                sample.suspicions,
            );
        }
    }
    println!("\nthe paper's 80-robot trial with 4 links (scenarios/paper/completion_80x4.ron, trial 0):");
    for (program, samples) in TRIALS.iter().zip(measure::rounds(rounds, &TRIALS, trial::ROBOTS)) {
        println!(
            "{program:>15}: {:.0} times real time, {:.1} ns/delivery, {:.1}M deliveries a second, {:.0} s simulated",
            measure::median(samples.iter().map(Sample::speed)),
            measure::median(samples.iter().map(Sample::nanos)),
            measure::median(samples.iter().map(|sample| 1e3 / sample.nanos())),
            samples[0].simulated_s,
        );
    }
}

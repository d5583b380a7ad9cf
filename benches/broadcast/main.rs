//! The `broadcast` workload: what a delivered frame costs, against a bare event loop that does the same and nothing else.
//!
//! N robots stand still, uniform in a square in which a robot has 12 neighbours on average. Each broadcasts a 4-byte
//! status every 0.1 s at a phase of its own. A copy is lost with probability 0.2, or arrives after a truncated normal
//! latency. A neighbour not heard for 1.0 s is suspected at that very instant.
//!
//! `cargo bench` runs each program in a process of its own, in turn, several times, and prints the least of each and the
//! ratios of those. `cargo bench -- --rounds 15` for more rounds.

mod bare;
mod measure;
mod swarm;
mod trial;
mod workload;

use desim::simulation::DriverKind;
use measure::Sample;
use mimalloc::MiMalloc;
use workload::{Counts, Workload};

/// The allocator of the `desim` command, for every program here.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

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
    let rounds = value_of("--rounds").map_or(7, |rounds| rounds.parse().expect("--rounds takes a number"));
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
    println!("User CPU of one process; least of {rounds} rounds, for whatever else a machine does only adds to it.\n");
    println!("broadcast: 12 neighbours, loss 0.2, latency 10 ± 3 ms, timeout 1.0 s; sends, losses and timers included");
    println!(
        "{:>7}  {:7} {:>11} {:>12} {:>8} {:>16} {:>11}",
        "robots", "program", "deliveries", "ns/delivery", "of bare", "peak memory", "suspicions"
    );
    for robots in SIZES {
        let results = measure::rounds(rounds, &PROGRAMS, robots);
        for (program, samples) in PROGRAMS.iter().zip(&results) {
            let nanos = measure::least(samples);
            let sample = &samples[0];
            println!(
                "{robots:>7}  {program:7} {:>11} {nanos:>12.0} {:>7.2}x {:>7.2} kB/robot {:>11}",
                sample.deliveries,
                nanos / measure::least(&results[0]),
                sample.peak_kib as f64 / f64::from(robots),
                sample.suspicions,
            );
        }
    }
    println!("\nthe paper's 80-robot trial with 4 links (scenarios/paper/completion_80x4.ron, trial 0)");
    for (program, samples) in TRIALS.iter().zip(measure::rounds(rounds, &TRIALS, trial::ROBOTS)) {
        println!(
            "{program}: {:.0} times real time, {:.0} ns/delivery, {:.1}M deliveries a second, {:.0} s simulated",
            samples.iter().map(Sample::speed).fold(0.0, f64::max),
            measure::least(&samples),
            1e3 / measure::least(&samples),
            samples[0].simulated_s,
        );
    }
}

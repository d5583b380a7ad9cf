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
mod workload;

use measure::Sample;
use workload::Workload;

const PROGRAMS: [&str; 3] = ["bare", "inline", "actors"];
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
    let workload = Workload::new(robots);
    match program {
        "bare" => measure::sample(|| bare::run(&workload)),
        "inline" => measure::sample(|| swarm::run(&workload, desim::simulation::DriverKind::Inline)),
        "actors" => measure::sample(|| swarm::run(&workload, desim::simulation::DriverKind::Actors)),
        other => panic!("no program is called `{other}`"),
    }
}

fn compare(rounds: usize) {
    println!(
        "broadcast: 12 neighbours, loss 0.2, latency 10 ± 3 ms, timeout 1.0 s; user CPU of one process, median of {rounds} rounds\n"
    );
    println!(
        "{:>7}  {:8} {:>12} {:>14} {:>10} {:>12} {:>14} {:>11}",
        "robots", "program", "deliveries", "ns/delivery", "of bare", "per second", "peak memory", "suspicions"
    );
    for robots in SIZES {
        let results: Vec<Vec<Sample>> = measure::rounds(rounds, &PROGRAMS, robots);
        for (program, samples) in PROGRAMS.iter().zip(&results) {
            let ratios = samples
                .iter()
                .zip(&results[0])
                .map(|(sample, bare)| sample.nanos() / bare.nanos());
            let nanos = measure::median(samples.iter().map(Sample::nanos));
            let sample = &samples[0];
            println!(
                "{robots:>7}  {program:8} {:>12} {nanos:>14.1} {:>9.2}x {:>11.2}M {:>6.2} kB/robot {:>11}",
                sample.deliveries,
                measure::median(ratios),
                1e3 / nanos,
                sample.peak_kib as f64 / f64::from(robots),
                sample.suspicions,
            );
        }
    }
    println!("\nper delivery: sends, losses and timers included");
}

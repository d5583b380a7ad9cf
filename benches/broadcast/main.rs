//! The `broadcast` workload: what a delivered frame costs, against two bare event loops that do the same and nothing else:
//! one of calendar rings, which is what can be reached, and one of a binary heap, which is what is mostly done.
//!
//! N robots stand still, uniform in a square in which a robot has 12 neighbours on average. Each broadcasts a 4-byte
//! status every 0.1 s at a phase of its own. A copy is lost with probability 0.2, or arrives after a truncated normal
//! latency. A neighbour not heard for 1.0 s is suspected at that very instant.
//!
//! The same status over 802.15.4 on real air stands beside it: 50 robots in one cell, and 12 neighbours again.
//!
//! `cargo bench` runs each program in a process of its own, in turn, several times, and prints the least of each and the
//! ratios of those. `cargo bench -- --rounds 15` for more rounds.

mod heap;
mod links;
mod measure;
mod rings;
mod swarm;
mod trial;
mod workload;

use desim::simulation::DriverKind;
use measure::Sample;
use mimalloc::MiMalloc;
use workload::{CELL_ROBOTS, Counts, Workload};

/// The allocator of the `desim` command, for every program here.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

const PROGRAMS: [&str; 4] = ["rings", "heap", "inline", "actors"];
/// Swarms from this size on take minutes: the heap, which falls behind ever further, is left out, and there are fewer rounds.
const LARGE: u32 = 100_000;
const LARGE_ROUNDS: usize = 3;
const TRIALS: [&str; 2] = ["trial, inline", "trial, actors"];
const SIZES: [u32; 6] = [80, 1_280, 20_480, 100_000, 400_000, 1_000_000];

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
        "rings" => broadcast(rings::run),
        "heap" => broadcast(heap::run),
        "inline" => broadcast(|workload| swarm::run(workload, DriverKind::Inline)),
        "actors" => broadcast(|workload| swarm::run(workload, DriverKind::Actors)),
        "disk" => measure::sample(|| swarm::run(&Workload::cell_over_disk(robots), DriverKind::Inline)),
        "air" if robots == CELL_ROBOTS => {
            measure::sample(|| swarm::run(&Workload::cell_over_air(robots), DriverKind::Inline))
        }
        "air" => measure::sample(|| swarm::run(&Workload::field_over_air(robots), DriverKind::Inline)),
        "trial, inline" => measure::sample(|| trial::run(DriverKind::Inline)),
        "trial, actors" => measure::sample(|| trial::run(DriverKind::Actors)),
        other => panic!("no program is called `{other}`"),
    }
}

fn compare(rounds: usize) {
    println!(
        "User CPU of one process; least of {rounds} rounds, of {LARGE_ROUNDS} from {LARGE} robots on, for whatever else a machine does only adds to it.\n"
    );
    println!("broadcast: 12 neighbours, loss 0.2, latency 10 ± 3 ms, timeout 1.0 s; sends, losses and timers included");
    println!(
        "{:>7}  {:7} {:>11} {:>12} {:>9} {:>8} {:>16} {:>11}",
        "robots", "program", "deliveries", "ns/delivery", "of rings", "of heap", "peak memory", "suspicions"
    );
    for robots in SIZES {
        let is_large = robots >= LARGE;
        let rounds = if is_large { rounds.min(LARGE_ROUNDS) } else { rounds };
        let programs: Vec<&str> = PROGRAMS
            .into_iter()
            .filter(|program| !is_large || *program != "heap")
            .collect();
        let results = measure::rounds(rounds, &programs, robots);
        let least = |wanted: &str| {
            let of = programs.iter().zip(&results).find(|(program, _)| **program == wanted);
            of.map(|(_, samples)| measure::least(samples))
        };
        for (program, samples) in programs.iter().zip(&results) {
            let nanos = measure::least(samples);
            let of = |bare: &str| least(bare).map_or(String::new(), |bare| format!("{:.2}x", nanos / bare));
            let sample = &samples[0];
            println!(
                "{robots:>7}  {program:7} {:>11} {nanos:>12.0} {:>9} {:>8} {:>7.2} kB/robot {:>11}",
                sample.deliveries,
                of("rings"),
                of("heap"),
                sample.peak_kib as f64 / f64::from(robots),
                sample.suspicions,
            );
        }
    }
    over_air(rounds);
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

/// The shared radio: beside a disk where all hear each other, and by how much it grows with the swarm.
fn over_air(rounds: usize) {
    println!("\n802.15.4 with log-distance path loss, shadowing and Rician fading, a status every 0.1 s, inline");
    let line = |robots: u32, program: &str, samples: &[Sample], against: f64, of: &str| {
        let (deliveries, nanos) = (samples[0].deliveries, measure::least(samples));
        let ratio = nanos / against;
        println!("{robots:>7}  {program:7} {deliveries:>11} {nanos:>12.0} {ratio:>7.2}x {of}");
        nanos
    };
    let cell = measure::rounds(rounds, &["disk", "air"], CELL_ROBOTS);
    let disk = measure::least(&cell[0]);
    line(CELL_ROBOTS, "disk", &cell[0], disk, "of the disk, all in one cell");
    line(CELL_ROBOTS, "air", &cell[1], disk, "of the disk");
    let mut least = None;
    for robots in [1_280, 20_480] {
        let samples = &measure::rounds(rounds, &["air"], robots)[0];
        let against = *least.get_or_insert(measure::least(samples));
        line(robots, "air", samples, against, "of 1280, 12 neighbours");
    }
}

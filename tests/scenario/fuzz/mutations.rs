//! Scenario files with something done to them, as people and their editors do: made from the shipped files by a fixed
//! seed, so that a list of them is the same on every machine.

use std::path::PathBuf;

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};
use rand_philox::Philox;

use desim::engine::{Purpose, Streams};

use crate::shipped;

/// A scenario file that something was done to.
#[derive(Debug)]
pub struct Mutant {
    /// What was done, to which file.
    pub label: String,
    /// The text.
    pub text: String,
    /// The misspelt name that now stands in it, and its line, if that is what was done.
    pub misspelt: Option<(String, usize)>,
}

/// A field of a file: its name, where it stands, and where its value stands.
struct Field {
    name: String,
    start: usize,
    value: std::ops::Range<usize>,
}

const NUMBERS: [&str; 24] = [
    "-1",
    "0",
    "-0.0",
    "1e308",
    "-1e308",
    "1e309",
    "1e-320",
    "NaN",
    "-NaN",
    "inf",
    "-inf",
    "99999999999999999999",
    "340282366920938463463374607431768211456",
    "0x10",
    "0b2",
    "1_000",
    "1__0.0_",
    "1.2.3",
    "1e",
    ".",
    "-",
    "+5",
    "1u8",
    "3.7",
];
const VALUES: [&str; 22] = [
    "()",
    "[]",
    "{}",
    "\"\"",
    "\"text\"",
    "'c'",
    "true",
    "None",
    "Some(1)",
    "Some",
    "Bernoulli",
    "Bernoulli()",
    "Bernoulli((0.1))",
    "Uniform(min: 2.0, max: 1.0)",
    "Ring(count: 0, radius: 1.0)",
    "At([])",
    "At([(0, 0), (0, 0)])",
    "Heartbeat",
    "Heartbeat()",
    "(1, 2, 3)",
    "r#\"raw\"#",
    "b\"bytes\"",
];
const LETTERS: [&str; 27] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ",,",
    ":",
    "::",
    "=",
    "\"",
    "'",
    "//",
    "/*",
    "*/",
    "#",
    "é",
    "🤖",
    "\u{202e}",
    "\0",
    "\r",
    "\u{1b}[31m",
    "\u{7}",
    "\u{200b}",
    "\u{feff}",
    "Å\u{30a}\u{30a}",
];

/// Numbers at the ends of what a field may hold, and a little within.
const EXTREMES: [&str; 24] = [
    "1e308",
    "1e-308",
    "-0.0",
    "0",
    "1e39",
    "1e-39",
    "1e18",
    "1e12",
    "1e9",
    "1e6",
    "999999",
    "1e-6",
    "1e-9",
    "1e-12",
    "0.9999999999999999",
    "0.5",
    "1",
    "255",
    "65535",
    "100000",
    "1000000",
    "4294967295",
    "18446744073709551615",
    "3.0000000000000004",
];
/// Models with extreme settings, each with the section and the field that it is a value of.
const MODELS: [&str; 38] = [
    "detector=Timeout(1e9)",
    "detector=Timeout(1e308)",
    "detector=Timeout(1e-9)",
    "detector=NfdS(shift: 1e12)",
    "detector=PhiAccrual(dialect: Chitchat, threshold: 1e300)",
    "detector=PhiAccrual(dialect: Akka, threshold: 1e-300, window: 100000)",
    "detector=PhiAccrual(dialect: Akka, acceptable_pause: Seconds(1e300), min_std_deviation: Seconds(1e300))",
    "detector=PhiAccrual(dialect: Cassandra, max_interval: Seconds(86400), initial_interval: Seconds(86400))",
    "detector=Swim(probe_interval: 1e300, probe_timeout: 1e299, leave_timeout: 1e301, suspicion_mult: 1e300)",
    "detector=Swim(probe_interval: 1.5, indirect_checks: 255, retransmit_mult: 255, max_awareness: 255)",
    "radio.latency=Gamma(shape: 1e308, scale: 1e-308)",
    "radio.latency=Gamma(shape: 1e-300, scale: 1e300)",
    "radio.latency=Gamma(shape: 1e-3, scale: 10)",
    "radio.latency=Gamma(shape: 1e9, scale: 1e-9)",
    "radio.latency=LogNormal(median: 1e-300, sigma: 1e300)",
    "radio.latency=LogNormal(median: 0.01, sigma: 30)",
    "radio.latency=Normal(mean: 1e-300, std_dev: 1e300)",
    "radio.latency=Normal(mean: 0.1, std_dev: 1e-300, min: 0.1)",
    "radio.latency=Normal(mean: 1e308, std_dev: 1e308, min: 1e308)",
    "radio.latency=Uniform(min: 0, max: 1e308)",
    "radio.latency=Exponential(mean: 1e308)",
    "radio.latency=Constant(1e308)",
    "radio.loss=GilbertElliott(good_to_bad: 1e-300, bad_to_good: 1e-300)",
    "radio.loss=GilbertElliott(good_to_bad: 1e-12, bad_to_good: 1e-12, good_loss: 0.3, bad_loss: 0.999999999)",
    "radio.loss=GilbertElliott(good_to_bad: 1, bad_to_good: 1)",
    "radio.loss=Distance(at_range: 1, exponent: 1e300)",
    "radio.loss=Distance(at_range: 1, exponent: 1e-300)",
    "radio.loss=Bernoulli(0.9999999999999999)",
    "swarm.deploy=Uniform",
    "swarm.deploy=Cluster(radius: 1e-300)",
    "swarm.deploy=Cluster(radius: 1e300)",
    "wander=RandomWaypoint(speed: 1e-300, pause: 1e300)",
    "wander=RandomWalk(speed: 0.02, leg: 1e-300)",
    "gossip.status=(interval: 1e18, jitter: 1.0)",
    "gossip.status.send=OnChange(max_interval: 1e300, repetition: 4294967295)",
    "gossip.relay=(interval: 1e-6, fan_out: Peers(1))",
    "protocol=Rumor(rounds: Poisson, sources: Random(64), size: 60000)",
    "faults=[Partition(line: ((-1e308, 1e308), (1e308, -1e308))), Radiation(within: Disc(at: (1e308, 0), radius: 1e-308), hazard: 1e-300)]",
];

/// The first `count` scenario files with extreme numbers in them, each with what is set beside: one that is no scenario any more
/// is refused, and the others have to be borne.
pub fn extremes(count: u32) -> Vec<(Mutant, Vec<&'static str>)> {
    let files: Vec<_> = shipped::files()
        .into_iter()
        .map(|path| {
            (
                path.display().to_string(),
                std::fs::read_to_string(path).expect("shipped files can be read"),
            )
        })
        .collect();
    let streams = Streams::new(21, 0);
    let drawn = (0..count).map(|number| {
        let mut random: Philox = streams.keyed(Purpose::new("test.extremes")).at(number, 0, 0);
        let (name, text) = files.choose(&mut random).expect("some scenarios are shipped");
        let mut text = text.clone();
        for _ in 0..random.random_range(0..3) {
            let numeric = |field: &Field| text[field.value.clone()].trim().parse::<f64>().is_ok();
            let numbers: Vec<Field> = fields(&text).into_iter().filter(numeric).collect();
            let field = numbers.choose(&mut random).expect("a scenario has numbers");
            text.replace_range(
                field.value.clone(),
                EXTREMES.choose(&mut random).expect("there are some"),
            );
        }
        let models = (0..random.random_range(0..3)).map(|_| *MODELS.choose(&mut random).expect("there are some"));
        let models = models.collect();
        let mutant = Mutant {
            label: format!("extreme {number} of {name}"),
            text,
            misspelt: None,
        };
        (mutant, models)
    });
    drawn.collect()
}

/// The first `count` mutants of scenario files.
pub fn mutants(count: u32) -> Vec<Mutant> {
    mutants_of(shipped::files(), count)
}

/// The first `count` mutants of these files.
pub fn mutants_of(files: Vec<PathBuf>, count: u32) -> Vec<Mutant> {
    let files: Vec<_> = files
        .into_iter()
        .map(|path| {
            (
                path.display().to_string(),
                std::fs::read_to_string(path).expect("shipped files can be read"),
            )
        })
        .collect();
    let streams = Streams::new(20, 0);
    let drawn = (0..count).map(|number| {
        let mut random: Philox = streams.keyed(Purpose::new("test.mutants")).at(number, 0, 0);
        let (name, text) = files.choose(&mut random).expect("some scenarios are shipped");
        let mut mutant = mutant(number, text, &mut random);
        mutant.label = format!("{number}: {} of {name}", mutant.label);
        mutant
    });
    drawn.collect()
}

fn mutant(number: u32, text: &str, random: &mut impl Rng) -> Mutant {
    let fields = fields(text);
    let field = fields.choose(random).expect("a scenario has fields");
    let other = fields.choose(random).expect("a scenario has fields");
    let entry = field.start..field.value.end;
    let own = &text[entry.clone()];
    let anywhere = place(text, random);
    let swap =
        |range: std::ops::Range<usize>, new: &str| format!("{}{new}{}", &text[..range.start], &text[range.end..]);
    let pick = |list: &[&'static str], random: &mut _| *list.choose(random).expect("the lists are not empty");
    let mut misspelt = None;
    let (label, text) = match number % 18 {
        0 => ("a field left out", swap(entry, "")),
        1 => ("a field given twice", swap(entry, &format!("{own}, {own}"))),
        2 => {
            let name = typo(&field.name, random);
            misspelt = Some((name.clone(), 1 + text[..field.start].matches('\n').count()));
            (
                "a misspelt field",
                swap(field.start..field.start + field.name.len(), &name),
            )
        }
        3 | 4 => ("another number", swap(field.value.clone(), pick(&NUMBERS, random))),
        5 | 6 => ("another value", swap(field.value.clone(), pick(&VALUES, random))),
        7 => (
            "the value of another field",
            swap(field.value.clone(), &text[other.value.clone()]),
        ),
        8 => ("a letter put in", swap(anywhere..anywhere, pick(&LETTERS, random))),
        9 => ("a piece cut out", cut(text, anywhere, random.random_range(1..9))),
        10 => ("the end cut off", text[..anywhere].to_owned()),
        11 => ("deep nesting", swap(field.value.clone(), &nested(random))),
        12 => (
            "another struct name",
            text.replacen(
                "Scenario(",
                pick(&["Scenaro(", "Scenario", "Scenario((", "[", "Some("], random),
                1,
            ),
        ),
        13 => (
            "a field moved into another",
            swap(other.value.clone(), &format!("({own})")),
        ),
        14 => (
            "a long list",
            swap(
                field.value.clone(),
                &format!("At([{}])", "(0.5, -0.5), ".repeat(random.random_range(0..3000))),
            ),
        ),
        15 => (
            "a long word",
            swap(field.value.clone(), &"x".repeat(random.random_range(1..5000))),
        ),
        16 => ("noise", noise(random)),
        _ => (
            "two things at once",
            swap(field.value.clone(), pick(&NUMBERS, random)).replacen(':', pick(&LETTERS, random), 1),
        ),
    };
    Mutant {
        label: label.into(),
        text,
        misspelt,
    }
}

/// A place where the text can be cut.
fn place(text: &str, random: &mut impl Rng) -> usize {
    text.floor_char_boundary(random.random_range(0..=text.len()))
}

fn cut(text: &str, from: usize, length: usize) -> String {
    let to = text.floor_char_boundary((from + length).min(text.len()));
    format!("{}{}", &text[..from], &text[to..])
}

/// The name with a letter more, which no field has.
fn typo(name: &str, random: &mut impl Rng) -> String {
    let at = random.random_range(1..=name.len());
    format!("{}x{}", &name[..at], &name[at..])
}

fn nested(random: &mut impl Rng) -> String {
    let depth = random.random_range(1..100_000);
    let (open, close) = [("(", ")"), ("[", "]"), ("Some(", ")"), ("(a:", ")"), ("/*", "*/")][random.random_range(0..5)];
    let closed = if random.random() {
        close.repeat(depth)
    } else {
        String::new()
    };
    format!("{}1{closed}", open.repeat(depth))
}

fn noise(random: &mut impl Rng) -> String {
    let length = random.random_range(0..400);
    (0..length)
        .map(|_| char::from_u32(random.random_range(0..0x300)).unwrap_or('?'))
        .collect()
}

/// The fields of a well-formed file.
fn fields(text: &str) -> Vec<Field> {
    let code = without_comments(text);
    let mut found = Vec::new();
    for (colon, _) in code.match_indices(": ") {
        let name: String = code[..colon]
            .chars()
            .rev()
            .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
            .collect();
        let value = colon + 2;
        found.push(Field {
            start: colon - name.len(),
            name: name.chars().rev().collect(),
            value: value..value + extent(&code[value..]),
        });
    }
    found
}

/// Where a value ends: at the comma or the bracket after it.
fn extent(text: &str) -> usize {
    let mut depth = 0;
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' | ',' if depth == 0 => return at,
            ')' | ']' => depth -= 1,
            _ => {}
        }
    }
    text.len()
}

/// The text with its comments blanked, each byte in its place.
fn without_comments(text: &str) -> String {
    let lines = text.split_inclusive('\n').map(|line| match line.find("//") {
        Some(at) => format!(
            "{}{}\n",
            &line[..at],
            " ".repeat(line.trim_end_matches('\n').len() - at)
        ),
        None => line.to_owned(),
    });
    lines.collect()
}

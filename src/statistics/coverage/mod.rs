//! How often the intervals hold the truth, by simulation: a quick look at each run of the tests, the table of docs/coverage.md by
//! `cargo test --release --lib coverage -- --ignored --nocapture`.

mod cases;

use rand_philox::Philox;

use self::cases::{Case, cases};
use crate::engine::{Purpose, Streams};

/// Data sets that had an interval, and those whose interval held the truth.
fn covered(case: &Case, number: usize, trials: usize, sets: u32) -> [f64; 2] {
    let streams = Streams::new(10, 0).keyed(Purpose::new("test.coverage"));
    let mut counts = [0.0; 2];
    for set in 0..sets {
        let mut random: Philox = streams.at(set, number as u32, trials as u32);
        let ([low, high], truth) = (case.simulate)(&mut random, trials);
        if low.is_some() || high.is_some() {
            counts[0] += 1.0;
            let holds = low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high);
            counts[1] += f64::from(u8::from(holds));
        }
    }
    counts
}

/// A row of the table: coverage of each kind and kind of data, by number of trials; none where no data set had an interval.
struct Row {
    kind: &'static str,
    data: &'static str,
    continuous: bool,
    counts: Vec<[f64; 2]>,
}

fn table(trials: &[usize], sets: u32) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (number, case) in cases().iter().enumerate() {
        let found: Vec<_> = trials
            .iter()
            .map(|&trials| covered(case, number, trials, sets))
            .collect();
        let same = |row: &&mut Row| (row.kind, row.data, row.continuous) == (case.kind, case.data, false);
        match rows.iter_mut().find(same) {
            Some(row) => add(&mut row.counts, &found),
            None => rows.push(Row {
                kind: case.kind,
                data: case.data,
                continuous: case.continuous,
                counts: found,
            }),
        }
    }
    rows
}

/// What is wrong with the coverage of `rows`, by four standard deviations of the simulation: of continuous kinds with any data, of others on
/// the average.
fn complaints(trials: &[usize], rows: &[Row]) -> Vec<String> {
    let mut judged: Vec<(String, f64, Vec<[f64; 2]>)> = Vec::new();
    // These are listed so that nobody trusts them blindly: so few trials cannot tell how skewed they are.
    let is_judged = |row: &&Row| !row.kind.contains(", one of them fixed") && !row.kind.contains(", of a very skewed");
    for row in rows.iter().filter(is_judged) {
        let name = if row.continuous {
            format!("{}, {}", row.kind, row.data)
        } else {
            row.kind.to_owned()
        };
        match judged.iter_mut().find(|judged| judged.0 == name) {
            Some(judged) => add(&mut judged.2, &row.counts),
            None => judged.push((name, if row.continuous { 0.975 } else { 1.0 }, row.counts.clone())),
        }
    }
    let mut complaints = Vec::new();
    for (name, most, counts) in judged {
        for (trials, [sets, held]) in trials.iter().zip(counts) {
            let error = 4.0 * (0.05 * 0.95 / sets).sqrt();
            if sets > 100.0 && !(0.93 - error..=most + error).contains(&(held / sets)) {
                complaints.push(format!("{name}, from {trials} trials: {:.3}", held / sets));
            }
        }
    }
    complaints
}

fn add(sums: &mut [[f64; 2]], counts: &[[f64; 2]]) {
    for (sum, count) in sums.iter_mut().zip(counts) {
        *sum = [sum[0] + count[0], sum[1] + count[1]];
    }
}

#[test]
fn intervals_of_every_kind_hold_the_truth_as_often_as_they_say() {
    let trials = [2, 3, 5, 8, 20];
    let complaints = complaints(&trials, &table(&trials, 400));
    assert!(complaints.is_empty(), "{complaints:#?}");
}

#[test]
#[ignore = "the table of docs/coverage.md: some minutes"]
fn the_table_of_coverage() {
    let trials = [2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 25, 30, 35];
    let rows = table(&trials, 2_000);
    let cells = |cells: Vec<String>| println!("| {} |", cells.join(" | "));
    cells(
        [
            vec!["interval".into(), "data".into()],
            trials.map(|trials| trials.to_string()).to_vec(),
        ]
        .concat(),
    );
    cells(vec!["---".to_owned(); trials.len() + 2]);
    for row in &rows {
        let shown = row.counts.iter().map(|[sets, held]| match sets {
            0.0 => "–".to_owned(),
            sets => format!("{:.1}", 100.0 * held / sets),
        });
        cells([vec![row.kind.to_owned(), row.data.to_owned()], shown.collect()].concat());
    }
    let complaints = complaints(&trials, &rows);
    assert!(complaints.is_empty(), "{complaints:#?}");
}

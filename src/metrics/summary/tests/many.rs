//! Trials that are taken in one by one are summarised as if all of their records were there: held against sums over the records.

use proptest::prelude::*;

use super::*;
use crate::metrics::figures::mending;
use crate::metrics::{HealingEpisode, TrafficRow, Volume};
use crate::statistics::{Estimator, Times, mean, median_survival, pseudo_values, quantile};

/// As [`Spread`] is defined: of each robot's sum of `bytes`, over all robots and trials.
fn spread(records: &[TrialRecord], bytes: impl Fn(&TrafficRow) -> u64) -> Spread {
    let trials: Vec<Vec<f64>> = records.iter().map(|record| record.bytes_per_step(&bytes)).collect();
    let means: Vec<f64> = trials.iter().filter_map(|robots| mean(robots).value).collect();
    let mut pooled = trials.concat();
    pooled.sort_by(f64::total_cmp);
    Spread {
        min: pooled.first().copied(),
        median: quantile(&pooled, 0.5),
        p95: quantile(&pooled, 0.95),
        max: pooled.last().copied(),
        mean: mean(&means),
        unit: "B/step".into(),
    }
}

fn directions(records: &[TrialRecord], counts: impl Fn(&TrafficRow) -> bool) -> Directions {
    let spread = |bytes: fn(&TrafficRow) -> u64| spread(records, |row| u64::from(counts(row)) * bytes(row));
    Directions {
        tx_bytes_per_step: spread(|row| row.sent.bytes()),
        rx_bytes_per_step: spread(|row| row.received.bytes()),
        tx_payload_bytes_per_step: spread(|row| row.sent.payload_bytes),
        rx_payload_bytes_per_step: spread(|row| row.received.payload_bytes),
    }
}

fn assert_bandwidth(records: &[TrialRecord]) {
    let found = Summary::of("many", &TOPICS, &ROLES, records).bandwidth;
    assert_eq!(found.total, directions(records, |_| true));
    for (topic, (_, found)) in found.by_topic.0.iter().enumerate() {
        let is_its = |row: &TrafficRow| usize::from(row.topic) == topic;
        assert_eq!(found.directions, directions(records, is_its));
        let lost = |row: &TrafficRow| u64::from(is_its(row)) * row.lost.into_iter().map(Volume::bytes).sum::<u64>();
        assert_eq!(found.lost_bytes_per_step, spread(records, lost));
    }
    for (role, (_, found)) in found.by_role.0.iter().enumerate() {
        assert_eq!(*found, directions(records, |row| usize::from(row.role) == role));
    }
}

#[test]
fn bandwidth_of_more_robots_than_memory_holds_has_the_quantiles_of_all_of_them() {
    // More than a block of rows, and than the file takes at a time.
    let base = trial(0, 8);
    let records: Vec<TrialRecord> = (0..2_300_u64)
        .map(|number| {
            let mut record = base.clone();
            record.traffic[0].sent.payload_bytes += number * 7919 % 1_000;
            record.robots[1].steps = 5 + number % 11;
            record
        })
        .collect();
    assert_bandwidth(&records);
}

/// Harm as [`Healed`] is defined, of the episodes that `belongs` accepts.
fn healed(records: &[TrialRecord], belongs: impl Fn(&HealingEpisode) -> bool) -> Healed {
    let trials: Vec<Vec<&HealingEpisode>> = records
        .iter()
        .map(|record| {
            let harmful = record.healing.iter().filter(|episode| episode.is_harmful());
            harmful.filter(|episode| belongs(episode)).collect()
        })
        .collect();
    let times: Vec<Times> = trials
        .iter()
        .zip(records)
        .map(|(episodes, record)| {
            episodes
                .iter()
                .map(|episode| mending(episode, record.simulated))
                .collect()
        })
        .collect();
    let observations: Vec<_> = times.iter().flat_map(Times::iter).collect();
    let (parts, lasting) = pseudo_values(&times);
    let measured = |figure: &dyn Fn(&HealingEpisode) -> f64, unit: &'static str| {
        let of_trial = |episodes: &Vec<&HealingEpisode>| {
            let mended = episodes.iter().filter(|episode| episode.healed_at.is_some());
            mended.fold([0.0; 2], |[sum, count], episode| [sum + figure(episode), count + 1.0])
        };
        Measured {
            estimate: Estimator::Count.estimate(&trials.iter().map(of_trial).collect::<Vec<_>>()),
            unit: unit.into(),
        }
    };
    let seconds = || "s".into();
    Healed {
        failures: observations.len() as u64,
        healed: observations.iter().filter(|seen| seen.happened).count() as u64,
        time: HealingTime {
            median: median_survival(&observations),
            mean: Lasted {
                estimate: Estimator::Times.estimate(&parts).at_most(lasting.restricted_to),
                cut_off: lasting.cut_off,
                restricted_to: lasting.restricted_to,
                unit: seconds(),
            },
            unit: seconds(),
        },
        distance: measured(&|episode| episode.distance_m, "m"),
        frames: Named::of(TOPICS, |topic| {
            measured(&|episode| episode.frames[topic] as f64, "frames")
        }),
    }
}

/// A failure at a time in tenths of a second, mended so much later or not at all: it did harm unless it was mended at once.
fn episode((at, after, role, overlapping): (u8, Option<u8>, u8, u32)) -> HealingEpisode {
    let tenths = |tenths: u8| SimTime::from_secs(f64::from(tenths) / 10.0);
    HealingEpisode {
        fault: 0,
        robot: ActorId(1),
        role,
        target: 0,
        failed_at: tenths(at),
        links_before: 1,
        links_after: 0,
        worker_m: None,
        healed_at: after.map(|after| tenths(at + after)),
        overlapping,
        distance_m: f64::from(at) * 0.37,
        frames: vec![u64::from(at), 3],
        payload_bytes: vec![0, 0],
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn harm_is_that_of_all_records_also_where_many_trials_saw_none(
        trials in prop::collection::vec(
            prop::collection::vec((0_u8..5, prop::option::of(0_u8..5), 0_u8..2, 0_u32..2), 0..4), 1..12,
        ),
        bytes in prop::collection::vec((1_u64..40, 1_u64..40, 1_u64..9), 12),
    ) {
        let base = trial(0, 8);
        let record = |(episodes, (sent, received, steps)): (Vec<_>, (u64, u64, u64))| {
            let mut record = base.clone();
            record.healing = episodes.into_iter().map(episode).collect();
            record.traffic[0].sent.header_bytes += sent;
            record.traffic[1].received.payload_bytes += received;
            record.robots[0].steps = steps;
            record
        };
        let records: Vec<TrialRecord> = trials.into_iter().zip(bytes).map(record).collect();
        assert_bandwidth(&records);
        let found = Summary::of("many", &TOPICS, &ROLES, &records).healing;
        let all = records.iter().flat_map(|record| &record.healing);
        let expected = all.clone().next().map(|_| HealingSummary {
            total: healed(&records, |_| true),
            harmless: all.filter(|episode| !episode.is_harmful()).count() as u64,
            by_role: Named::of(ROLES, |role| healed(&records, |episode| usize::from(episode.role) == role)),
            by_overlap: Named::of(["alone", "overlapping"], |place| {
                healed(&records, |episode| (episode.overlapping > 0) == (place == 1))
            }),
        });
        prop_assert_eq!(found, expected);
    }
}

//! What the tables of failures, of beliefs about them and of healing hold.

use super::records::Records;
use super::table::{Table, Wrong};
use super::traffic::by_cause;
use crate::engine::{ActorId, SimTime, Span};
use crate::faults::Effect;
use crate::metrics::detection::{Cause, FailureOutcome, Missed, ObservedFailure, Suspicion, Verdict};
use crate::metrics::{FaultEpisode, FaultKind, HealingEpisode};

pub fn detection(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, event, time) = (table.ids("trial")?, table.texts("event")?, table.numbers("time_s")?);
    let (observer, subject) = (table.ids("observer")?, table.ids("subject")?);
    let (verdict, cause) = (table.texts("verdict")?, table.texts("cause")?);
    let (heard, trusted) = (table.optional_numbers("heard_s")?, table.optional_numbers("trusted_s")?);
    let mistake = table.optional_numbers("mistake_duration_s")?;
    let cut_off = table.optional_ids("mistake_cut_off")?;
    let (detected, watched) = (
        table.optional_numbers("detection_time_s")?,
        table.optional_numbers("watched_s")?,
    );
    let lost = by_cause(|cause| table.optional_ids(&format!("missed_{cause}")))?;
    let missed = ["missed_out_of_range", "missed_under_way"].map(|name| table.optional_ids(name));
    let [out_of_range, under_way] = missed;
    let (out_of_range, under_way) = (out_of_range?, under_way?);
    for row in 0..trial.len() {
        let (at, observer, subject) = (
            SimTime::from_secs(time[row]),
            ActorId(observer[row]),
            ActorId(subject[row]),
        );
        let detection = &mut records.of(trial[row])?.detection;
        match event[row].as_str() {
            "suspicion" => detection.suspicions.push(&Suspicion {
                observer,
                subject,
                at,
                heard: SimTime::from_secs(heard[row].unwrap_or(0.0)),
                // No table has it: only a trial that is run again can follow single statuses.
                sequence: 0,
                until: trusted[row].map(SimTime::from_secs),
                subject_down: verdict[row] == Verdict::Right.name(),
                cause: cause_called(&cause[row])?,
                missed: Missed {
                    lost: std::array::from_fn(|cause| lost[cause][row].unwrap_or(0)),
                    out_of_range: out_of_range[row].unwrap_or(0),
                    under_way: under_way[row].unwrap_or(0),
                },
                duration: mistake[row].map(Span::from_secs),
                cut_off: cut_off[row] == Some(1),
            }),
            "failure" => detection.failures.push(&ObservedFailure {
                subject,
                observer,
                at,
                outcome: outcome_called(&verdict[row], detected[row])?,
                watched: Span::from_secs(watched[row].unwrap_or(0.0)),
            }),
            other => return Err(format!("it has an unknown event `{other}`")),
        }
    }
    Ok(())
}

fn cause_called(name: &str) -> Result<Cause, Wrong> {
    let found = Cause::ALL.into_iter().find(|cause| cause.name() == name);
    found.ok_or_else(|| format!("it has an unknown cause `{name}`"))
}

fn outcome_called(name: &str, after: Option<f64>) -> Result<FailureOutcome, Wrong> {
    let after = Span::from_secs(after.unwrap_or(0.0));
    let all = [
        FailureOutcome::Detected(after),
        FailureOutcome::Recovered,
        FailureOutcome::ObserverFailed,
        FailureOutcome::Undetected,
    ];
    let found = all.into_iter().find(|outcome| outcome.name() == name);
    found.ok_or_else(|| format!("it has an unknown verdict `{name}`"))
}

pub fn faults(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, fault, kind) = (table.ids("trial")?, table.ids("fault")?, table.texts("kind")?);
    let (robot, role, target) = (
        table.optional_ids("robot")?,
        table.optional_texts("role")?,
        table.optional_ids("target")?,
    );
    let (from, until) = (table.numbers("from_s")?, table.optional_numbers("until_s")?);
    for row in 0..trial.len() {
        let effect = Effect::ALL.into_iter().find(|effect| effect.name() == kind[row]);
        let kind = match (effect, robot[row], &role[row]) {
            (Some(effect), Some(robot), Some(role)) => FaultKind::Robot {
                robot: ActorId(robot),
                effect,
                role: records.names.role(role)?,
                target: target[row].and_then(|target| u16::try_from(target).ok()),
            },
            (None, None, None) if kind[row] == FaultKind::Partition.name() => FaultKind::Partition,
            (None, None, None) if kind[row] == FaultKind::Burst.name() => FaultKind::Burst,
            _ => return Err(format!("it has a fault of an unknown kind `{}`", kind[row])),
        };
        records.of(trial[row])?.faults.push(FaultEpisode {
            fault: fault[row] as u16,
            kind,
            from: SimTime::from_secs(from[row]),
            until: until[row].map(SimTime::from_secs),
        });
    }
    Ok(())
}

pub fn healing(records: &mut Records, table: &Table) -> Result<(), Wrong> {
    let (trial, fault, robot) = (table.ids("trial")?, table.ids("fault")?, table.ids("robot")?);
    let (role, target) = (table.texts("role")?, table.ids("target")?);
    let (failed, healed) = (table.numbers("failed_s")?, table.optional_numbers("healed_s")?);
    let (before, after) = (table.ids("links_before")?, table.ids("links_after")?);
    let (worker, overlapping) = (table.optional_numbers("worker_m")?, table.ids("overlapping")?);
    let distance = table.numbers("distance_m")?;
    let topics: Vec<String> = records
        .names
        .topics
        .iter()
        .map(|topic| topic.replace(' ', "_"))
        .collect();
    let of_topics = |what: &str| -> Result<Vec<Vec<u64>>, Wrong> {
        let columns = topics.iter().map(|topic| table.counts(&format!("{topic}_{what}")));
        columns.collect()
    };
    let (frames, payload) = (of_topics("frames")?, of_topics("payload_bytes")?);
    let at = |columns: &[Vec<u64>], row: usize| columns.iter().map(|column| column[row]).collect();
    for row in 0..trial.len() {
        let role = records.names.role(&role[row])?;
        records.of(trial[row])?.healing.push(HealingEpisode {
            fault: fault[row] as u16,
            robot: ActorId(robot[row]),
            role,
            target: target[row] as u16,
            failed_at: SimTime::from_secs(failed[row]),
            links_before: before[row],
            links_after: after[row],
            worker_m: worker[row],
            healed_at: healed[row].map(SimTime::from_secs),
            overlapping: overlapping[row],
            distance_m: distance[row],
            frames: at(&frames, row),
            payload_bytes: at(&payload, row),
        });
    }
    Ok(())
}

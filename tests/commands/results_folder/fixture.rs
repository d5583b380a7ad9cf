//! Made-up trials: quick, and with every kind of value that a record can hold.

mod air;
mod asked;

use std::num::NonZeroUsize;
use std::path::Path;

use desim::engine::{ActorId, SimTime, Span};
use desim::experiment::{Claim, Ending, Experiment, ExperimentError, Kept, Pool, Shard};
use desim::export::{Folder, Manifest, Pictures, Results, write};
use desim::faults::Effect;
use desim::geometry::{Pose, Vec2};
use desim::metrics::detection::{Cause, DetectionRecord, FailureOutcome, Missed, ObservedFailure, Suspicion};
use desim::metrics::{
    Amount, ConnectivitySample, FaultEpisode, FaultKind, HealingEpisode, LatencyHistogram, Noted, Outcome,
    PAIR_MEASURES, PairRecord, RobotBytes, RobotState, RumorSpread, SeriesEntry, TargetSample, TargetState, TopicFates,
    TrafficRow, TrialRecord, Values, Volume,
};
use desim::radio::LossCause;
use desim::scenario::{Scenario, parse};
use tokio_util::sync::CancellationToken;

const ROBOTS: u32 = 9;
const SAMPLES: u64 = 12;

/// A scenario that no made-up trial looks at, for its names, targets and number of trials.
pub fn scenario(trials: u32) -> Scenario {
    let text = format!(
        "Scenario(name: \"made-up\", trials: {trials}, time_limit: 60.0, \
         swarm: (robots: {ROBOTS}, deploy: Cluster(radius: 1.0)), \
         protocol: Backbone(targets: Ring(count: 2, radius: 3.0)))"
    );
    parse("made-up.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// Trial number `trial`: a root in the middle, two chains to two targets, every fifth trial censored.
pub fn record(trial: u32) -> TrialRecord {
    let odd = f64::from(trial) * 0.1 + 0.2;
    let mut latency = LatencyHistogram::default();
    (1..40).for_each(|n| latency.record(Span::from_nanos(1_000_003 * n * u64::from(trial + 1))));
    TrialRecord {
        trial,
        seed: 1,
        outcome: if trial % 5 == 4 {
            Outcome::Censored
        } else {
            Outcome::Completed {
                step: 100 + 7 * u64::from(trial),
            }
        },
        steps: 600,
        control_period: Span::from_secs(0.1),
        simulated: SimTime::from_secs(60.0),
        events: 12_345,
        digest: u128::MAX - u128::from(trial),
        ledger: (0..4).map(|topic| fates(topic, trial)).collect(),
        traffic: (0..ROBOTS)
            .flat_map(|robot| (0..2).map(move |topic| traffic(robot, topic, trial)))
            .collect(),
        latency,
        faults: faults(trial),
        healing: healing(trial),
        spread: spread(trial),
        noted: noted(trial),
        pairs: pairs(trial),
        air: Some(air::air(trial)),
        asked: asked::asked(trial),
        detection: detection(trial),
        trace: None,
        connectivity: (0..SAMPLES).map(|sample| connectivity(sample, odd)).collect(),
        series: (1..SAMPLES).map(|sample| series(sample, trial)).collect(),
        robots: (0..ROBOTS).map(|robot| state(robot, odd)).collect(),
        trajectories: (0..SAMPLES)
            .map(|sample| (SimTime::from_secs(sample as f64 * 5.0), places(sample)))
            .collect(),
    }
}

/// What robots count and measure in every second trial.
fn noted(trial: u32) -> Vec<Noted> {
    let noted = |name: &str, robot, amount| Noted {
        name: name.to_owned(),
        robot: ActorId(robot),
        amount,
    };
    let values = Values::restored(9.0, -1.5, 5.0, [(-1.5, 1), (0.0, 2), (2.0, 1), (5.0, 2)]);
    let all = vec![
        noted("drops", 3, Amount::Count(7 + u64::from(trial))),
        noted("hops", 0, Amount::Values(values)),
        noted("hops", 4, Amount::Count(0)),
    ];
    if trial % 2 == 1 { all } else { Vec::new() }
}

/// Suspicions of every verdict and failures of every outcome.
fn detection(trial: u32) -> DetectionRecord {
    let causes = [
        Cause::Failure,
        Cause::Lost(LossCause::Channel),
        Cause::OutOfRange,
        Cause::Lost(LossCause::ReceiverDown),
        Cause::Latency,
        Cause::NotSent,
    ];
    let suspicion = |(number, cause): (u32, Cause)| Suspicion {
        observer: ActorId(number),
        subject: ActorId(8),
        at: SimTime::from_secs(10.0 + f64::from(number)),
        heard: SimTime::from_secs(6.0 + f64::from(number)),
        sequence: 60,
        until: (number > 0).then(|| SimTime::from_secs(11.0 + f64::from(number))),
        subject_down: number == 0,
        cause,
        missed: Missed {
            lost: [0, 0, 0, number % 2, 0, 0, 0, 0, 0, 0, 0, 0],
            out_of_range: number,
            ..Missed::default()
        },
        duration: (number == 1 || number >= 4).then(|| Span::from_secs(0.7 + f64::from(number + trial) / 10.0)),
        cut_off: number == 5,
    };
    let outcomes = [
        FailureOutcome::Detected(Span::from_secs(3.2 + f64::from(trial) / 7.0)),
        FailureOutcome::Detected(Span::ZERO),
        FailureOutcome::Recovered,
        FailureOutcome::ObserverFailed,
        FailureOutcome::Undetected,
    ];
    let failure = |(observer, outcome): (u32, FailureOutcome)| ObservedFailure {
        subject: ActorId(8),
        observer: ActorId(observer),
        at: SimTime::from_secs(7.0),
        outcome,
        watched: match outcome {
            FailureOutcome::Detected(after) => after,
            _ => Span::from_secs(1.5 + f64::from(observer)),
        },
    };
    DetectionRecord {
        pairs: 20,
        monitored_s: 1100.0 + f64::from(trial) / 3.0,
        mistaken_s: 2.1,
        suspicions: (0..).zip(causes).map(suspicion).collect(),
        failures: (0..).zip(outcomes).map(failure).collect(),
    }
}

fn fates(topic: u64, trial: u32) -> TopicFates {
    let lost = [15 + topic + u64::from(trial), 2, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    TopicFates {
        offered: 103 + topic + u64::from(trial),
        delivered: 80,
        lost,
        in_flight: 3,
    }
}

fn traffic(robot: u32, topic: u8, trial: u32) -> TrafficRow {
    let volume = |frames: u64| Volume {
        frames,
        payload_bytes: 4 * frames,
        header_bytes: 5 * frames,
    };
    TrafficRow {
        robot: ActorId(robot),
        role: role(robot),
        topic,
        sent: volume(600),
        received: volume(u64::from(4000 + 10 * robot + trial)),
        duplicate: volume(u64::from(topic) * u64::from(7 + robot + trial)),
        lost: [robot, 0, robot % 2, 0, 0, 0, 0, 0, 0, 0, 0, 0].map(|frames| volume(frames.into())),
    }
}

/// Robot 3 falls silent in every second trial, and recovers in every fourth; a partition comes and goes in the others.
fn faults(trial: u32) -> Vec<FaultEpisode> {
    let until = (trial % 4 != 2).then_some(SimTime::from_secs(50.0));
    let kind = if trial.is_multiple_of(2) {
        FaultKind::Robot {
            robot: ActorId(3),
            effect: Effect::Silence,
            role: 2,
            target: Some(0),
        }
    } else {
        FaultKind::Partition
    };
    vec![FaultEpisode {
        fault: 1,
        kind,
        from: SimTime::from_secs(20.0),
        until,
    }]
}

/// What robot 3 leaves behind is mended in every fourth trial; another failure did no harm.
fn healing(trial: u32) -> Vec<HealingEpisode> {
    let episode = |at: f64, healed: Option<f64>| HealingEpisode {
        fault: 1,
        robot: ActorId(3),
        role: 2,
        target: 0,
        failed_at: SimTime::from_secs(at),
        links_before: 1,
        links_after: u32::from(healed == Some(at)),
        worker_m: (trial != 2).then_some(0.125),
        healed_at: healed.map(SimTime::from_secs),
        overlapping: trial % 3,
        distance_m: f64::from(trial) / 7.0,
        frames: vec![300, u64::from(trial), 5, 6],
        payload_bytes: vec![1200, 4 * u64::from(trial), 60, 70],
    };
    let mended = trial.is_multiple_of(4).then(|| 30.3 + f64::from(trial));
    if trial.is_multiple_of(2) {
        vec![episode(20.0, mended), episode(21.5, Some(21.5))]
    } else {
        Vec::new()
    }
}

/// Two rumours, of which the second does not reach the last robot in the first trial.
fn spread(trial: u32) -> Vec<RumorSpread> {
    let at = |rumor: u32, robot: u32| SimTime::from_secs(f64::from(robot * (rumor + 3) + trial) / 7.0);
    let reaches = |rumor, robot| trial > 0 || rumor == 0 || robot + 1 < ROBOTS;
    let informed = |rumor| {
        (0..ROBOTS)
            .map(|robot| reaches(rumor, robot).then(|| at(rumor, robot)))
            .collect()
    };
    (0..2)
        .map(|rumor| RumorSpread {
            informed: informed(rumor),
            hops: (0..ROBOTS)
                .map(|robot| reaches(rumor, robot).then_some(robot % 3))
                .collect(),
        })
        .collect()
}

/// Each robot and the next, of whose measures the second trial lacks some.
fn pairs(trial: u32) -> Vec<PairRecord> {
    let value = |robot: u32, place: usize| f64::from(robot * 3 + trial + 1) / (place as f64 + 7.0);
    let values = |robot: u32| {
        let places = 0..PAIR_MEASURES.len();
        places.map(move |place| (trial != 1 || place != 2).then(|| value(robot, place)))
    };
    (0..ROBOTS - 1)
        .map(|robot| PairRecord {
            sender: ActorId(robot),
            receiver: ActorId(robot + 1),
            offered: u64::from(100 + robot),
            delivered: u64::from(80 + trial),
            values: values(robot).collect(),
        })
        .collect()
}

fn connectivity(sample: u64, odd: f64) -> ConnectivitySample {
    let lambda2 = if sample == 7 { 0.0 } else { odd / (sample + 1) as f64 };
    ConnectivitySample {
        at: SimTime::from_secs(sample as f64 * 5.0),
        lambda2,
        components: if sample == 7 { 2 } else { 1 },
        neighbours: 1.0 + odd / 8.0,
        roles: vec![2, 1, 4, 2],
        links: vec![1, u32::from(sample > 3)],
        targets: targets(sample),
    }
}

/// The first target is held from the third sample on; to the second a worker sets out late, and has one link at last.
fn targets(sample: u64) -> Vec<TargetSample> {
    let (late, way) = (sample as f64, 3.0 / (sample + 1) as f64);
    let first = match sample {
        0..3 => (TargetState::Away, Some(3.0 - late)),
        _ => (TargetState::Held, Some(0.1)),
    };
    let second = match sample {
        0..3 => (TargetState::NoWorker, None),
        3..6 => (TargetState::Away, Some(way)),
        _ => (TargetState::LinksShort, Some(0.25)),
    };
    let sample = |(state, worker_m)| TargetSample { state, worker_m };
    [first, second].map(sample).into()
}

/// Traffic that dies down; the last entry is of all topics.
fn series(sample: u64, trial: u32) -> SeriesEntry {
    let bytes = |scale: u64| RobotBytes {
        total: scale * (1000 + u64::from(trial)) / sample,
        min: scale / 10,
        median: scale as f64 * 1.5,
        max: scale * 9,
    };
    SeriesEntry {
        since: SimTime::from_secs((sample - 1) as f64 * 5.0),
        at: SimTime::from_secs(sample as f64 * 5.0),
        sent: [1, 2, 3, 4, 10].map(bytes).into(),
        received: [10, 20, 30, 40, 100].map(bytes).into(),
    }
}

/// Robot 0 is the root, 1 to 4 relay, 5 and 6 are workers, the others free.
fn role(robot: u32) -> u8 {
    match robot {
        0 => 1,
        1..=4 => 2,
        5 | 6 => 3,
        _ => 0,
    }
}

fn state(robot: u32, odd: f64) -> RobotState {
    let side = if robot % 2 == 1 { 1.0 } else { -1.0 };
    let (x, target, parents) = match robot {
        0 => (0.0, None, vec![]),
        1 | 2 => (side, Some(robot as u16 - 1), vec![ActorId(0)]),
        3 | 4 => (side * 2.0, Some(robot as u16 - 3), vec![ActorId(robot - 2)]),
        5 | 6 => (side * 3.0, Some(robot as u16 - 5), vec![ActorId(robot - 2), ActorId(0)]),
        _ => (side * 0.5, None, vec![]),
    };
    let position = Vec2::new(x, odd * f64::from(robot) / 30.0);
    RobotState {
        pose: Pose { position, heading: odd },
        role: role(robot),
        target,
        parents,
        steps: 600 - u64::from(robot % 2),
    }
}

fn places(sample: u64) -> Vec<[f32; 2]> {
    let grown = sample as f32 / SAMPLES as f32;
    (0..ROBOTS)
        .map(|robot| state(robot, 0.1).pose.position)
        .map(|at| [at.x as f32 * grown, at.y as f32])
        .collect()
}

/// What keeps a made-up trial from being made up.
#[derive(Debug, thiserror::Error)]
#[error("given up")]
pub struct GivenUp;

/// Runs `scenario` in `dir` as the command does, trial by trial with `run`.
pub fn run(
    dir: &Path,
    scenario: &Scenario,
    jobs: usize,
    stop: &CancellationToken,
    run: impl Fn(u32) -> Result<TrialRecord, GivenUp> + Sync,
) -> Result<Ending, ExperimentError<GivenUp>> {
    let folder = Folder::new(dir.to_owned());
    let claim = Claim::lay(&folder.trials())?;
    let manifest = Manifest::new(scenario);
    folder.declare(&manifest).expect("the folder can be written");
    let parts = folder.parts(&manifest);
    let jobs = NonZeroUsize::new(jobs).expect("at least one thread");
    let experiment = Experiment {
        trials: scenario.trials,
        shard: Shard::WHOLE,
        parts: &parts,
    };
    let pool = Pool { jobs, stop };
    let ending = pool.run(&[experiment], |_, trial| run(trial), |_, _| ())?;
    if ending == Ending::Finished {
        write(&folder, claim, &Kept::in_one(parts), scenario, Pictures::First).expect("the results can be written");
    }
    Ok(ending)
}

/// The records of results, all at once: they are few.
pub fn records_of(results: &Results) -> Vec<TrialRecord> {
    results.records().collect::<Result<_, _>>().unwrap()
}

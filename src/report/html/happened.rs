//! What failed in the trials of a page, and who was suspected: instant by instant, folded where it is much, and in words.

use std::collections::{BTreeMap, BTreeSet};

use crate::engine::{ActorId, SimTime};
use crate::metrics::detection::Verdict;
use crate::metrics::{FaultKind, TrialRecord};
use crate::report::number;

/// Marks of a row: what is closer together than a telephone can show is one.
const MOST_MARKS: usize = 120;
/// Stretches in which links were in trouble, of one row.
const MOST_STRETCHES: usize = 200;
/// Robots that a mark names; of more it says how many.
const MOST_NAMED: usize = 4;

/// What happened, as rows and captions have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum What {
    Fails,
    Recovers,
    Links,
    /// Somebody is rightly suspected.
    Right,
    /// Somebody is suspected who could send.
    Other,
}

impl What {
    pub const ALL: [Self; 5] = [Self::Fails, Self::Recovers, Self::Links, Self::Right, Self::Other];

    pub fn name(self) -> &'static str {
        match self {
            Self::Fails => "fails",
            Self::Recovers => "recovers",
            Self::Links => "link trouble",
            Self::Right => "right suspicion",
            Self::Other => "other suspicion",
        }
    }

    /// Told apart by colour-blind readers, and by the row in any case.
    pub fn colour(self) -> &'static str {
        match self {
            Self::Fails => "#b2182b",
            Self::Recovers => "#4393c3",
            Self::Links => "#7b3294",
            Self::Right => "#333333",
            Self::Other => "#e08214",
        }
    }
}

/// Something that happened in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening {
    pub at: SimTime,
    /// The trial, by its place among the records.
    pub trial: usize,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Robot(ActorId),
    Links(SimTime),
    Suspicion {
        observer: ActorId,
        subject: ActorId,
        verdict: Verdict,
    },
}

/// A mark of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub at_s: f64,
    /// How many it stands for.
    pub count: usize,
    pub words: String,
}

/// All of one kind, in order of time.
pub fn happenings(records: &[TrialRecord], what: What) -> Vec<Happening> {
    let of = |(trial, record): (usize, &TrialRecord)| -> Vec<Happening> {
        let faults = record.faults.iter();
        let robots = faults
            .clone()
            .filter_map(|episode| Some((episode, episode.kind.robot()?)));
        let happening = |at, kind| Happening { at, trial, kind };
        match what {
            What::Fails => robots
                .map(|(episode, robot)| happening(episode.from, Kind::Robot(robot)))
                .collect(),
            What::Recovers => {
                let over = robots.filter_map(|(episode, robot)| Some((episode.until?, robot)));
                over.map(|(at, robot)| happening(at, Kind::Robot(robot))).collect()
            }
            What::Links => faults
                .filter(|episode| is_of_links(&episode.kind))
                .map(|episode| happening(episode.from, Kind::Links(episode.until.unwrap_or(record.simulated))))
                .collect(),
            What::Right | What::Other => {
                let all = record.detection.suspicions.iter();
                let chosen = all.filter(|one| (one.verdict() == Verdict::Right) == (what == What::Right));
                let seen = chosen.map(|one| {
                    let verdict = one.verdict();
                    let (observer, subject) = (one.observer, one.subject);
                    happening(
                        one.at,
                        Kind::Suspicion {
                            observer,
                            subject,
                            verdict,
                        },
                    )
                });
                seen.collect()
            }
        }
    };
    let mut all: Vec<Happening> = records.iter().enumerate().flat_map(of).collect();
    all.sort_by_key(|happening| happening.at);
    all
}

fn is_of_links(kind: &FaultKind) -> bool {
    matches!(kind, FaultKind::Burst | FaultKind::Partition)
}

/// The times at which something happened in each of so many trials, seconds.
pub fn common(happenings: &[Happening], trials: usize) -> Vec<f64> {
    let times = happenings.chunk_by(|a, b| a.at == b.at);
    let everywhere = times.filter(|together| trials_of(together) == trials);
    everywhere.map(|together| together[0].at.as_secs()).collect()
}

fn trials_of(happenings: &[Happening]) -> usize {
    happenings
        .iter()
        .map(|happening| happening.trial)
        .collect::<BTreeSet<_>>()
        .len()
}

/// When links were in trouble, and whether in all trials.
pub fn stretches(records: &[TrialRecord]) -> Vec<([f64; 2], bool)> {
    let mut trials: BTreeMap<(SimTime, SimTime), BTreeSet<usize>> = BTreeMap::new();
    for happening in happenings(records, What::Links) {
        if let Kind::Links(until) = happening.kind {
            trials.entry((happening.at, until)).or_default().insert(happening.trial);
        }
    }
    let of = |((from, until), trials): ((SimTime, SimTime), BTreeSet<usize>)| {
        ([from.as_secs(), until.as_secs()], trials.len() == records.len())
    };
    trials.into_iter().take(MOST_STRETCHES).map(of).collect()
}

/// The marks of what happened, in order of time: of each instant one, or, where they are many, of those close together.
pub fn folded(happenings: &[Happening], what: What, trials: usize) -> Vec<Mark> {
    let mut times: Vec<&[Happening]> = happenings.chunk_by(|a, b| a.at == b.at).collect();
    let width = match (happenings.first(), happenings.last()) {
        (Some(first), Some(last)) if times.len() > MOST_MARKS => last.at.since(first.at).as_secs() / MOST_MARKS as f64,
        _ => 0.0,
    };
    if width > 0.0 {
        let start = happenings[0].at;
        let bin = |happening: &Happening| {
            (happening.at.since(start).as_secs() / width)
                .floor()
                .min(MOST_MARKS as f64 - 1.0)
        };
        times = happenings.chunk_by(|a, b| bin(a).total_cmp(&bin(b)).is_eq()).collect();
    }
    let mark = |together: &[Happening]| Mark {
        at_s: f64::midpoint(together[0].at.as_secs(), together[together.len() - 1].at.as_secs()),
        count: together.len(),
        words: said(together, what, trials),
    };
    times.into_iter().map(mark).collect()
}

/// What a mark stands for.
fn said(together: &[Happening], what: What, trials: usize) -> String {
    let (first, last) = (together[0].at, together[together.len() - 1].at);
    let when = if first == last {
        number::seconds(first.as_secs())
    } else {
        format!(
            "{} to {}",
            number::seconds(first.as_secs()),
            number::seconds(last.as_secs())
        )
    };
    let so_many = number::count(together.len() as u64);
    let happened = match (what, together) {
        (What::Fails | What::Recovers, _) => {
            let robots: BTreeSet<ActorId> = together.iter().filter_map(robot).collect();
            let [one, many] = if what == What::Fails {
                ["fails", "fail"]
            } else {
                ["recovers", "recover"]
            };
            let names: Vec<String> = robots.iter().map(|robot| robot.0.to_string()).collect();
            match &names[..] {
                [robot] => format!("robot {robot} {one}"),
                // In every trial the same, or there is one: else it would not be seen which of them failed in which.
                names if names.len() <= MOST_NAMED && together.len() == names.len() * trials_of(together) => {
                    format!("robots {} {many}", names.join(", "))
                }
                _ => format!("{so_many} robots {many}"),
            }
        }
        (
            What::Links,
            [
                Happening {
                    kind: Kind::Links(until),
                    ..
                },
                ..,
            ],
        ) if first == last => {
            format!("links are in trouble until {}", number::seconds(until.as_secs()))
        }
        (What::Links, _) => format!("links get into trouble {so_many} times"),
        (
            _,
            [
                Happening {
                    kind:
                        Kind::Suspicion {
                            observer,
                            subject,
                            verdict,
                        },
                    ..
                },
            ],
        ) => {
            format!(
                "robot {observer} suspects robot {subject}: {}",
                verdict.name().replace('_', " ")
            )
        }
        _ => {
            let mut counts: BTreeMap<Verdict, u64> = BTreeMap::new();
            for happening in together {
                if let Kind::Suspicion { verdict, .. } = happening.kind {
                    *counts.entry(verdict).or_default() += 1;
                }
            }
            let parts = counts
                .iter()
                .map(|(verdict, count)| format!("{}: {}", verdict.name().replace('_', " "), number::count(*count)));
            format!("{so_many} suspicions, {}", parts.collect::<Vec<_>>().join(", "))
        }
    };
    match trials {
        1 => format!("{when}: {happened}"),
        _ => format!(
            "{when}: {happened}, in {} of {} trials",
            trials_of(together),
            number::count(trials as u64)
        ),
    }
}

fn robot(happening: &Happening) -> Option<ActorId> {
    match happening.kind {
        Kind::Robot(robot) => Some(robot),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failures(times: impl IntoIterator<Item = (f64, usize, u32)>) -> Vec<Happening> {
        let failure = |(seconds, trial, robot)| Happening {
            at: SimTime::from_secs(seconds),
            trial,
            kind: Kind::Robot(ActorId(robot)),
        };
        times.into_iter().map(failure).collect()
    }

    #[test]
    fn what_happens_at_one_instant_is_one_mark_and_only_what_is_the_same_in_every_trial_goes_through_the_chart() {
        let planned = failures([(50.0, 0, 3), (50.0, 1, 3), (50.0, 1, 5), (70.0, 1, 2)]);
        let marks = folded(&planned, What::Fails, 2);
        assert_eq!(
            marks.iter().map(|mark| (mark.at_s, mark.count)).collect::<Vec<_>>(),
            [(50.0, 3), (70.0, 1)]
        );
        assert_eq!(common(&planned, 2), [50.0]);
        assert_eq!(common(&planned, 3), [0.0; 0]);
    }

    #[test]
    fn thousands_of_marks_are_as_many_as_can_be_told_apart_and_stand_for_all() {
        let many = failures((0..5_000).map(|number| (f64::from(number) * 0.3, 0, 1)));
        let marks = folded(&many, What::Fails, 1);
        assert!((MOST_MARKS / 2..=MOST_MARKS).contains(&marks.len()), "{}", marks.len());
        assert_eq!(marks.iter().map(|mark| mark.count).sum::<usize>(), 5_000);
        assert!(marks.windows(2).all(|pair| pair[0].at_s < pair[1].at_s));
    }

    #[test]
    fn a_mark_says_who_where_that_is_clear_and_in_how_many_trials() {
        let said = |times: &[(f64, usize, u32)], trials| said(&failures(times.iter().copied()), What::Fails, trials);
        assert_eq!(said(&[(50.0, 0, 3)], 1), "50.0 s: robot 3 fails");
        assert_eq!(said(&[(50.0, 0, 3), (50.0, 0, 5)], 1), "50.0 s: robots 3, 5 fail");
        assert_eq!(
            said(&[(50.0, 0, 3), (50.0, 1, 3)], 12),
            "50.0 s: robot 3 fails, in 2 of 12 trials"
        );
        // Not the same in both.
        assert_eq!(
            said(&[(50.0, 0, 3), (50.0, 1, 5)], 2),
            "50.0 s: 2 robots fail, in 2 of 2 trials"
        );
        assert_eq!(
            said(&[(50.0, 0, 3), (51.0, 0, 3)], 1),
            "50.0 s to 51.0 s: robot 3 fails"
        );
        let suspicion = |verdict| Happening {
            at: SimTime::from_secs(2.0),
            trial: 0,
            kind: Kind::Suspicion {
                observer: ActorId(2),
                subject: ActorId(4),
                verdict,
            },
        };
        let one = [suspicion(Verdict::OutOfRange)];
        assert_eq!(
            super::said(&one, What::Other, 1),
            "2.00 s: robot 2 suspects robot 4: out of range"
        );
        let two = [suspicion(Verdict::OutOfRange), suspicion(Verdict::Mistake)];
        let words = super::said(&two, What::Other, 1);
        assert!(
            words.contains("2 suspicions") && words.contains("mistake: 1") && words.contains("out of range: 1"),
            "{words}"
        );
    }
}

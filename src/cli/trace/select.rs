//! What part of a trial is asked for.

use std::collections::BTreeSet;
use std::str::FromStr;

use clap::Args;

use crate::cli::failure::Failure;
use crate::cli::finished_trial::refuse;
use crate::engine::{ActorId, SimTime, Span};
use crate::export::trace::Run;
use crate::happenings::log::Selection;
use crate::protocol::Topic;
use crate::report::seconds;

/// A part of a trial.
#[derive(Debug, Args)]
pub struct Part {
    /// From when on, seconds [default: from the beginning]
    #[arg(long, value_name = "SECONDS")]
    pub from: Option<f64>,
    /// Up to when, seconds [default: to the end]
    #[arg(long, visible_alias = "to", value_name = "SECONDS")]
    pub until: Option<f64>,
    /// Only these robots, such as 3,7-9: what they send and are offered, and what happens to them
    #[arg(long, value_name = "ROBOTS")]
    pub robots: Option<Robots>,
    /// Only frames with messages on these topics, by their names, with commas between them
    #[arg(long, value_name = "TOPICS", value_delimiter = ',')]
    pub topics: Option<Vec<String>>,
    /// Seconds from one look at places to the next [default: the motion's tick]
    #[arg(long, value_name = "SECONDS")]
    pub places_every: Option<f64>,
}

/// Robots by their numbers, such as `3,7-9`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Robots(Vec<(u32, u32)>);

impl FromStr for Robots {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |word: &str| {
            let word = word.trim();
            word.parse::<u32>()
                .map_err(|_| format!("`{word}` is no robot's number; robots are numbered from 0: write such as 3,7-9"))
        };
        let range = |word: &str| match word.split_once('-') {
            Some((first, last)) => Ok((number(first)?, number(last)?)),
            None => number(word).map(|robot| (robot, robot)),
        };
        let ranges: Vec<(u32, u32)> = text.split(',').map(range).collect::<Result<_, String>>()?;
        match ranges.iter().find(|(first, last)| first > last) {
            Some((first, last)) => Err(format!("{first}-{last} has no robots: the lower number comes first")),
            None => Ok(Self(ranges)),
        }
    }
}

impl Robots {
    fn of(&self, robots: u32) -> Result<BTreeSet<ActorId>, Failure> {
        if let Some((_, beyond)) = self.0.iter().find(|(_, last)| *last >= robots) {
            return refuse(format!(
                "there is no robot {beyond}: the scenario has robots 0 to {}",
                robots - 1
            ));
        }
        Ok(self
            .0
            .iter()
            .flat_map(|&(first, last)| (first..=last).map(ActorId))
            .collect())
    }
}

impl Part {
    /// The part of `run` that is asked for, which lasted `simulated_s` seconds.
    ///
    /// # Errors
    /// If there is none.
    pub fn of(&self, run: &Run, simulated_s: f64) -> Result<Selection, Failure> {
        let time = |name: &str, given: Option<f64>| match given {
            Some(time) if !time.is_finite() || time < 0.0 => refuse(format!(
                "--{name} {time} is no time: give seconds from 0 on, such as 12.5"
            )),
            given => Ok(given),
        };
        let from = time("from", self.from)?.unwrap_or(0.0);
        let until = time("until", self.until)?;
        let every = time("places-every", self.places_every)?.unwrap_or(0.0);
        if from > simulated_s {
            return refuse(format!(
                "--from {from} is behind the end of the trial, which lasted {}",
                seconds(simulated_s)
            ));
        }
        if let Some(until) = until.filter(|until| *until <= from) {
            return refuse(format!(
                "from {from} until {until} is no time at all: --until must be greater than --from"
            ));
        }
        let topics = self.topics.as_ref().map(|names| topics(names, run)).transpose()?;
        let robots = self.robots.as_ref();
        Ok(Selection {
            from: at(from),
            until: until.map_or(SimTime::NEVER, at),
            robots: robots.map(|robots| robots.of(run.scenario.swarm.robots)).transpose()?,
            topics,
            places_every: Span::from_secs(every.min(LONGEST_S)),
        })
    }
}

/// More seconds than any run has, and few enough for their nanoseconds to be counted.
const LONGEST_S: f64 = 1e9;

fn at(seconds: f64) -> SimTime {
    SimTime::ZERO + Span::from_secs(seconds.min(LONGEST_S))
}

fn topics(names: &[String], run: &Run) -> Result<BTreeSet<Topic>, Failure> {
    let topic = |name: &String| {
        let place = run.topics.iter().position(|topic| topic == &name.trim());
        place.map(|place| Topic(place as u8)).map_or_else(
            || {
                refuse(format!(
                    "there is no topic `{name}`: robots that run {} talk of {}",
                    run.scenario.protocol.name(),
                    run.topics.join(", ")
                ))
            },
            Ok,
        )
    };
    names.iter().map(topic).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_are_numbers_and_ranges_of_them() {
        let robots = |text: &str| text.parse::<Robots>();
        let ids = |text: &str| robots(text).unwrap().of(10).unwrap();
        assert_eq!(ids("3,7-9"), [3, 7, 8, 9].map(ActorId).into());
        assert_eq!(ids(" 0 , 0-0"), [0].map(ActorId).into());
        for wrong in ["", "a", "3,", "5-4", "-1", "1-2-3", "99999999999"] {
            assert!(robots(wrong).is_err(), "{wrong}");
        }
        assert!(robots("4-10").unwrap().of(10).is_err());
        assert!(robots("0-4000000000").unwrap().of(10).is_err());
    }
}

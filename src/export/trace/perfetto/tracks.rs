//! Tracks of a trace: a process a robot, a thread a track. On a track slices lie one after the other; what overlaps goes to the next lane.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

use serde_json::{Value, json};

use super::json::{Entry, Events, long, micros};
use crate::engine::{ActorId, SimTime, Span};

/// Slices of what takes no time are so long, for a viewer to show.
pub const INSTANT: Span = Span::from_nanos(1_000);

/// What a track shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The role that a robot has.
    Role,
    /// What ails it.
    Faults,
    /// When it comes to suspect another.
    Suspects,
    /// The frames that it says.
    Says,
    /// The copies that reach it, or that it loses.
    Hears,
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::Role => "role",
            Self::Faults => "faults",
            Self::Suspects => "suspects",
            Self::Says => "says",
            Self::Hears => "hears",
        }
    }
}

/// Whose tracks they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// Nobody's: figures of the whole swarm.
    Swarm,
    /// All links together.
    Links,
    /// A robot's.
    Robot(ActorId),
}

/// A track that a slice lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Track {
    owner: Owner,
    kind: Kind,
    lane: usize,
    thread: u32,
}

/// A slice to be drawn.
pub struct Slice<'a> {
    /// Whose.
    pub owner: Owner,
    /// On which of its tracks.
    pub kind: Kind,
    /// What is written on it.
    pub name: &'a str,
    /// What more there is to know.
    pub args: Value,
}

/// An end of an arrow: where, and when.
pub type End = (Track, SimTime);

/// Slices that overlap, on lanes where none do.
#[derive(Debug, Default)]
pub struct Lanes {
    /// From which instant on each lane is free, nanoseconds.
    free: Vec<u64>,
}

impl Lanes {
    /// The first lane that is free from `begin` on, taken until `end`, and from then on free again.
    ///
    /// Readers multiply microseconds by a thousand and cut off what is left, so that one slice may seem to end a nanosecond after the next begins: that
    /// much is left between them.
    pub fn place(&mut self, begin: SimTime, end: SimTime) -> usize {
        let lane = self.take(begin);
        self.free[lane] = end.as_nanos().saturating_add(1);
        lane
    }

    /// The first lane that is free from `begin` on, taken until it is [left](Self::leave).
    pub fn take(&mut self, begin: SimTime) -> usize {
        let lane = self.free.iter().position(|&free| free <= begin.as_nanos());
        let lane = lane.unwrap_or(self.free.len());
        self.free.resize(self.free.len().max(lane + 1), 0);
        self.free[lane] = u64::MAX;
        lane
    }

    /// Lets go of a lane.
    pub fn leave(&mut self, lane: usize, end: SimTime) {
        self.free[lane] = end.as_nanos();
    }
}

/// The tracks of a trace being written.
pub struct Tracks<W> {
    events: Events<W>,
    robots: u32,
    named: BTreeSet<Owner>,
    lanes: BTreeMap<(Owner, Kind), Lanes>,
    /// The thread of each lane, by a number that no other process has: readers take threads of one number for one.
    threads: BTreeMap<(Owner, Kind, usize), u32>,
}

impl<W: Write> Tracks<W> {
    /// No tracks yet, of so many robots.
    pub fn new(events: Events<W>, robots: u32) -> Self {
        Self {
            events,
            robots,
            named: BTreeSet::new(),
            lanes: BTreeMap::new(),
            threads: BTreeMap::new(),
        }
    }

    /// Draws a slice.
    ///
    /// # Errors
    /// Those of the file.
    pub fn slice(&mut self, slice: Slice<'_>, begin: SimTime, lasts: Span) -> io::Result<Track> {
        let lanes = self.lanes.entry((slice.owner, slice.kind)).or_default();
        let lane = lanes.place(begin, begin + lasts);
        let track = self.track(slice.owner, slice.kind, lane)?;
        self.put(track, "X", slice, begin, Some(long(lasts)))?;
        Ok(track)
    }

    /// Begins a slice whose end is not known yet.
    ///
    /// # Errors
    /// Those of the file.
    pub fn open(&mut self, slice: Slice<'_>, begin: SimTime) -> io::Result<Track> {
        let lane = self.lanes.entry((slice.owner, slice.kind)).or_default().take(begin);
        let track = self.track(slice.owner, slice.kind, lane)?;
        self.put(track, "B", slice, begin, None)?;
        Ok(track)
    }

    /// Ends it.
    ///
    /// # Errors
    /// Those of the file.
    pub fn close(&mut self, track: Track, end: SimTime) -> io::Result<()> {
        let lanes = self.lanes.entry((track.owner, track.kind)).or_default();
        lanes.leave(track.lane, end);
        self.events.put(&Entry {
            ph: "E",
            pid: self.process(track.owner),
            tid: track.thread,
            ts: Some(micros(end)),
            ..Entry::default()
        })
    }

    /// One end of an arrow: where it comes from, if `ph` is `s`, or where it leads, if it is `f`.
    ///
    /// # Errors
    /// Those of the file.
    pub fn flow(&mut self, ph: &'static str, name: &str, id: u64, (track, at): End) -> io::Result<()> {
        self.events.put(&Entry {
            ph,
            name,
            cat: Some("flow"),
            pid: self.process(track.owner),
            tid: track.thread,
            ts: Some(micros(at)),
            id: Some(id),
            // To the slice that is there, and not to the next one.
            bp: (ph == "f").then_some("e"),
            ..Entry::default()
        })
    }

    /// Begins, if `ph` is `b`, or ends, if it is `e`, a slice that has a track of its own.
    ///
    /// # Errors
    /// Those of the file.
    pub fn apart(&mut self, ph: &'static str, owner: Owner, name: &str, id: u64, at: SimTime) -> io::Result<()> {
        self.name(owner)?;
        let process = self.process(owner);
        self.events.put(&Entry {
            ph,
            name,
            cat: Some("suspicion"),
            pid: process,
            tid: process,
            ts: Some(micros(at)),
            id: Some(id),
            ..Entry::default()
        })
    }

    /// Figures of the swarm from `at` on.
    ///
    /// # Errors
    /// Those of the file.
    pub fn counter(&mut self, name: &str, at: SimTime, values: Value) -> io::Result<()> {
        self.name(Owner::Swarm)?;
        let process = self.process(Owner::Swarm);
        self.events.put(&Entry {
            ph: "C",
            name,
            pid: process,
            tid: process,
            ts: Some(micros(at)),
            args: Some(values),
            ..Entry::default()
        })
    }

    /// The trace's end, which says what it is `of`.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(self, of: &Value) -> io::Result<W> {
        self.events.finish(of)
    }

    /// Readers have a meaning of their own for process 0.
    fn process(&self, owner: Owner) -> u32 {
        match owner {
            Owner::Robot(robot) => robot.0 + 1,
            Owner::Swarm => self.robots + 1,
            Owner::Links => self.robots + 2,
        }
    }

    fn put(
        &mut self,
        track: Track,
        ph: &'static str,
        slice: Slice<'_>,
        ts: SimTime,
        dur: Option<f64>,
    ) -> io::Result<()> {
        self.events.put(&Entry {
            ph,
            name: slice.name,
            cat: Some(slice.kind.name()),
            pid: self.process(track.owner),
            tid: track.thread,
            ts: Some(micros(ts)),
            dur,
            args: (!slice.args.is_null()).then_some(slice.args),
            ..Entry::default()
        })
    }

    /// A lane as a track, which is named when it is first used.
    fn track(&mut self, owner: Owner, kind: Kind, lane: usize) -> io::Result<Track> {
        let of = |thread| Track {
            owner,
            kind,
            lane,
            thread,
        };
        if let Some(&thread) = self.threads.get(&(owner, kind, lane)) {
            return Ok(of(thread));
        }
        self.name(owner)?;
        let process = self.process(owner);
        let thread = self.robots + 3 + self.threads.len() as u32;
        self.threads.insert((owner, kind, lane), thread);
        let name = match lane {
            0 => kind.name().to_owned(),
            _ => format!("{} {}", kind.name(), lane + 1),
        };
        self.say("thread_name", process, thread, json!({ "name": name }))?;
        let order = json!({ "sort_index": 1_000 * kind as usize + lane });
        self.say("thread_sort_index", process, thread, order)?;
        Ok(of(thread))
    }

    /// Names a process, once.
    fn name(&mut self, owner: Owner) -> io::Result<()> {
        if !self.named.insert(owner) {
            return Ok(());
        }
        let process = self.process(owner);
        let (name, order) = match owner {
            Owner::Swarm => ("swarm".to_owned(), 0),
            Owner::Links => ("links".to_owned(), 1),
            Owner::Robot(robot) => (format!("robot {}", robot.0), robot.0 + 2),
        };
        self.say("process_name", process, process, json!({ "name": name }))?;
        self.say("process_sort_index", process, process, json!({ "sort_index": order }))
    }

    fn say(&mut self, name: &str, pid: u32, tid: u32, args: Value) -> io::Result<()> {
        self.events.put(&Entry {
            ph: "M",
            name,
            pid,
            tid,
            args: Some(args),
            ..Entry::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn on_a_lane_slices_lie_one_after_the_other(mut slices in prop::collection::vec((0_u64..300, 0_u64..60), 0..80)) {
            slices.sort_unstable();
            let mut lanes = Lanes::default();
            let mut ends: Vec<u64> = Vec::new();
            for &(begin, lasts) in &slices {
                let end = begin + lasts;
                let lane = lanes.place(SimTime::from_nanos(begin), SimTime::from_nanos(end));
                prop_assert!(lane <= ends.len(), "no lane is left out");
                if lane == ends.len() {
                    ends.push(end);
                } else {
                    prop_assert!(ends[lane] < begin);
                    prop_assert!(ends[..lane].iter().all(|&end| end >= begin), "the first that is free");
                    ends[lane] = end;
                }
            }
            // As many as overlap somewhere, and no more.
            let deepest = slices.iter().map(|&(at, _)| slices.iter().filter(|&&(begin, lasts)| begin <= at && at <= begin + lasts).count());
            prop_assert_eq!(ends.len(), deepest.max().unwrap_or(0));
        }
    }

    #[test]
    fn a_lane_is_taken_until_its_slice_ends() {
        let at = SimTime::from_nanos;
        let mut lanes = Lanes::default();
        assert_eq!([lanes.take(at(5)), lanes.take(at(5)), lanes.take(at(900))], [0, 1, 2]);
        lanes.leave(1, at(1_000));
        assert_eq!(lanes.take(at(1_000)), 1);
        assert_eq!(lanes.take(at(1_000)), 3);
    }
}

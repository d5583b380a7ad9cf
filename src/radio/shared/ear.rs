//! What a robot's antenna takes up: the bursts that reach it above the floor, each with its power there, and when it was deaf.
//!
//! Everything that a receiver or medium access asks of the air is asked of one robot's ear: whether the channel is clear, what overlaps
//! with a frame, what it has locked on. An ear is filled when a burst begins, with one look at each robot that it reaches, and nothing is searched for.

use std::collections::VecDeque;

use super::burst::BurstId;
use crate::engine::{SimTime, Span, prefetch};

/// A burst at one robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heard {
    /// Which.
    pub burst: BurstId,
    /// From when to when.
    pub begins: SimTime,
    pub ends: SimTime,
    /// Its power there, milliwatts.
    pub power: f64,
    /// The same in dBm, if that is known already, or NaN.
    pub dbm: f32,
    /// On which channel.
    pub channel: u8,
    /// Whether it is no frame but noise.
    pub is_noise: bool,
}

impl Heard {
    /// Whether it is on air at any time from `from` to before `until`.
    #[inline]
    pub fn overlaps(&self, from: SimTime, until: SimTime) -> bool {
        self.begins < until && self.ends > from
    }

    /// Whether it is noticed on `channel`.
    #[inline]
    pub fn shares(&self, channel: u8) -> bool {
        self.channel == channel || self.is_noise
    }
}

/// One robot's.
#[derive(Debug, Default)]
pub(super) struct Ear {
    /// In the order in which they began; those before `first` are forgotten.
    heard: Vec<Heard>,
    first: usize,
    /// The longest of them so far.
    longest: Span,
    /// When it sent or turned round, and so heard nothing, in order of time.
    deaf: VecDeque<(SimTime, SimTime)>,
    /// How long it has found the channel busy, and how long it has heard frames of others.
    pub busy: Union,
    pub frames: Union,
}

/// The length of a union of intervals that begin one after another.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Union {
    length: Span,
    until: SimTime,
}

impl Union {
    /// Adds an interval that begins no earlier than any before.
    pub fn add(&mut self, begins: SimTime, ends: SimTime) {
        let from = begins.max(self.until);
        if ends > from {
            self.length = self.length + ends.since(from);
            self.until = ends;
        }
    }

    /// How much of it lies before `now`, which none that was added begins after.
    pub fn by(&self, now: SimTime) -> Span {
        self.length.less(self.until.since(now))
    }
}

impl Ear {
    /// Asks for what it heard last.
    pub fn prefetch_contents(&self) {
        if let Some(last) = self.heard.last() {
            prefetch(last);
        }
        if let Some(last) = self.deaf.back() {
            prefetch(last);
        }
    }

    /// Takes up a burst, and forgets what ended before `since`.
    pub fn hear(&mut self, heard: Heard, since: SimTime) {
        while self.heard.get(self.first).is_some_and(|oldest| oldest.ends < since) {
            self.first += 1;
        }
        if self.first > self.heard.len() / 2 {
            self.heard.drain(..self.first);
            self.first = 0;
        }
        self.longest = self.longest.max(heard.ends.since(heard.begins));
        self.heard.push(heard);
    }

    /// It sends or turns round from `from` to before `until`. What ended before `since` is forgotten.
    pub fn deafen(&mut self, from: SimTime, until: SimTime, since: SimTime) {
        while self.deaf.front().is_some_and(|oldest| oldest.1 < since) {
            self.deaf.pop_front();
        }
        self.deaf.push_back((from, until));
    }

    /// What it was to send from now on it does not: it hears again from `now` on.
    pub fn hear_again(&mut self, now: SimTime) {
        for interval in &mut self.deaf {
            interval.1 = interval.1.min(now).max(interval.0);
        }
    }

    /// Whether it was deaf for any time from `from` to before `until`.
    #[inline]
    pub fn is_deaf(&self, from: SimTime, until: SimTime) -> bool {
        let overlaps = |deaf: &&(SimTime, SimTime)| deaf.0 < until && deaf.1 > from;
        self.deaf.iter().rev().any(|deaf| overlaps(&deaf))
    }

    /// What is remembered.
    #[inline]
    fn all(&self) -> &[Heard] {
        &self.heard[self.first..]
    }

    /// Where this burst stands for [`at`](Self::at), if it reaches here. It came lately, and is looked for from the end on.
    #[inline]
    pub fn place_of(&self, burst: BurstId) -> Option<usize> {
        let mut place = self.heard.len();
        while place > self.first && self.heard[place - 1].burst > burst {
            place -= 1;
        }
        let place = place.checked_sub(1)?;
        (place >= self.first && self.heard[place].burst == burst).then_some(place)
    }

    /// All else that is on air while what stands at `place` is, on its channel, as it began.
    #[inline]
    pub fn besides(&self, place: usize) -> impl Iterator<Item = &Heard> + Clone {
        let heard = &self.heard[place];
        let since = heard.begins - self.longest;
        let (mut first, mut end) = (place, place + 1);
        while first > self.first && self.heard[first - 1].begins >= since {
            first -= 1;
        }
        while self.heard.get(end).is_some_and(|later| later.begins < heard.ends) {
            end += 1;
        }
        self.heard[first..end].iter().filter(move |other| {
            other.burst != heard.burst && other.shares(heard.channel) && other.overlaps(heard.begins, heard.ends)
        })
    }

    /// All that is on air on `channel` at any time from `from` to before `until`, as it began. What began more than the longest burst
    /// before is over, so that it does not matter how much is remembered.
    pub fn during(&self, channel: u8, from: SimTime, until: SimTime) -> impl Iterator<Item = &Heard> + Clone {
        let (first, last) = (from - self.longest, until);
        let heard = self.all();
        let heard = &heard[heard.partition_point(|heard| heard.begins < first)..];
        let heard = heard.iter().take_while(move |heard| heard.begins < last);
        heard.filter(move |heard| heard.shares(channel) && heard.overlaps(from, until))
    }

    /// The places of what is known of `burst` and of those that began after it, for [`at`](Self::at).
    pub fn from(&self, burst: BurstId) -> std::ops::Range<usize> {
        self.first + self.all().partition_point(|heard| heard.burst < burst)..self.heard.len()
    }

    /// What stands at a place.
    #[inline]
    pub fn at(&self, place: usize) -> &Heard {
        &self.heard[place]
    }

    /// All frames on the channel of `heard` that are remembered, up to itself, as they began.
    pub fn until(&self, heard: &Heard) -> impl Iterator<Item = &Heard> {
        let (burst, channel) = (heard.burst, heard.channel);
        let earlier = self.all().iter().take_while(move |heard| heard.burst <= burst);
        earlier.filter(move |heard| heard.channel == channel && !heard.is_noise)
    }

    /// A burst breaks off.
    pub fn cut(&mut self, burst: BurstId, now: SimTime) {
        if let Some(place) = self.place_of(burst) {
            self.heard[place].ends = now;
        }
    }
}

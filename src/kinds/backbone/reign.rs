//! For how long a swarm that elects its roots is without one, seen from outside: no robot knows it.

use super::message::Role;
use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Subject};
use crate::geometry::Vec2;
use crate::happenings::{Inbox, Observer};
use crate::metrics::{Noted, NotedFigure, TrialRecord};
use crate::protocol::Note;

const WITHOUT_ROOT: &str = "without_root_s";
const ROOTLESS: &str = "rootless_at_end";
const ENDS: &str = "ends";

/// Which robots are roots and can be heard as such, and since when none is.
#[derive(Debug)]
pub struct Reign {
    roots: Vec<bool>,
    live: Vec<bool>,
    without_since: Option<SimTime>,
    /// Each time without a root that ended, seconds.
    times: Vec<f64>,
}

impl Reign {
    /// Of a swarm of so many robots that begins with the root `root`.
    pub fn new(robots: usize, root: ActorId) -> Self {
        let mut roots = vec![false; robots];
        if let Some(first) = roots.get_mut(root.index()) {
            *first = true;
        }
        Self {
            roots,
            live: vec![true; robots],
            without_since: None,
            times: Vec::new(),
        }
    }

    /// The figures of what it notes.
    pub fn figures() -> Vec<NotedFigure> {
        vec![
            NotedFigure::mean(
                "without_root_s.mean",
                "time until a lost root has a successor",
                "s",
                WITHOUT_ROOT,
            ),
            NotedFigure::quantile(
                "without_root_s.max",
                "the same, longest of a trial",
                "s",
                WITHOUT_ROOT,
                1.0,
            ),
            NotedFigure::share("rootless_at_end", "trials that end without a root", ROOTLESS, ENDS),
        ]
    }

    /// Adds what it saw to the record.
    pub fn note(self, record: &mut TrialRecord) {
        let observer = ActorId(0);
        record.note(Noted::counted(ENDS, observer, 1));
        if self.without_since.is_some() {
            record.note(Noted::counted(ROOTLESS, observer, 1));
        }
        if !self.times.is_empty() {
            record.note(Noted::measured(WITHOUT_ROOT, observer, self.times));
        }
    }

    fn look(&mut self, now: SimTime) {
        let there_is_one = self.roots.iter().zip(&self.live).any(|(root, live)| *root && *live);
        match (self.without_since, there_is_one) {
            (None, false) => self.without_since = Some(now),
            (Some(since), true) => {
                self.times.push(now.since(since).as_secs());
                self.without_since = None;
            }
            (None, true) | (Some(_), false) => {}
        }
    }
}

impl Observer for Reign {
    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, _: &Inbox<'_, H>) {
        if let Note::Role(role) = note {
            self.roots[robot.index()] = *role == Role::Root.index();
            self.look(now);
        }
    }

    fn fault(&mut self, now: SimTime, change: &Change, _: &[Vec2]) {
        if let Subject::Robot { robot, health, .. } = change.subject {
            self.live[robot.index()] = health.sends && health.hears && health.acts;
            self.look(now);
        }
    }
}

//! Who came to know which rumour when.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime};

use super::faults::Failures;

/// How one rumour spread.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RumorSpread {
    /// When each robot came to know it, in order of ids; `None` if it never did.
    pub informed: Vec<Option<SimTime>>,
}

/// Follows the rumours of a run.
#[derive(Debug)]
pub(super) struct Spread(Vec<RumorSpread>);

impl Spread {
    /// Nobody knows any of `rumors` rumours yet.
    pub(super) fn new(rumors: usize, robots: usize) -> Self {
        let unknown = RumorSpread {
            informed: vec![None; robots],
        };
        Self(vec![unknown; rumors])
    }

    /// `robot` knows `rumor` since `at`.
    ///
    /// # Panics
    /// If the run has no such rumour.
    pub(super) fn inform(&mut self, robot: ActorId, rumor: u16, at: SimTime) {
        let rumors = self.0.len();
        let spread = self.0.get_mut(usize::from(rumor));
        let spread = spread.unwrap_or_else(|| panic!("robot {robot} reported rumour {rumor}, one of {rumors}"));
        spread.informed[robot.index()].get_or_insert(at);
    }

    /// Whether every live robot knows every rumour, and there is one.
    pub(super) fn is_complete(&self, failures: &Failures) -> bool {
        (0..self.0.len()).all(|rumor| self.is_known(rumor, failures))
    }

    /// Whether every live robot knows rumour number `rumor`, and there is one.
    pub(super) fn is_known(&self, rumor: usize, failures: &Failures) -> bool {
        let informed = (0..).map(ActorId).zip(&self.0[rumor].informed);
        let mut live = informed.filter(|(robot, _)| failures.is_live(*robot)).peekable();
        live.peek().is_some() && live.all(|(_, at)| at.is_some())
    }

    pub(super) fn into_records(self) -> Vec<RumorSpread> {
        self.0
    }
}

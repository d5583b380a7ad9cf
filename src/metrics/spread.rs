//! Who came to know which rumour when.

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime};

use super::faults::Failures;

/// How one rumour spread.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RumorSpread {
    /// When each robot came to know it, in order of ids; `None` if it never did.
    pub informed: Vec<Option<SimTime>>,
    /// How many transmissions it had come over by then, in order of ids: 0 where it began; `None` where it never came.
    pub hops: Vec<Option<u32>>,
}

/// Follows the rumours of a run.
#[derive(Debug)]
pub(super) struct Spread(Vec<RumorSpread>);

impl Spread {
    /// Nobody knows any of `rumors` rumours yet.
    pub(super) fn new(rumors: usize, robots: usize) -> Self {
        let unknown = RumorSpread {
            informed: vec![None; robots],
            hops: vec![None; robots],
        };
        Self(vec![unknown; rumors])
    }

    /// `robot` knows `rumor` since `at`, and has it `from` another robot, if it did not begin there: over how many transmissions it came, if that is new.
    ///
    /// # Panics
    /// If the run has no such rumour.
    pub(super) fn inform(&mut self, robot: ActorId, rumor: u16, at: SimTime, from: Option<ActorId>) -> Option<u32> {
        let rumors = self.0.len();
        let spread = self.0.get_mut(usize::from(rumor));
        let spread = spread.unwrap_or_else(|| panic!("robot {robot} reported rumour {rumor}, one of {rumors}"));
        if spread.informed[robot.index()].is_some() {
            return None;
        }
        spread.informed[robot.index()] = Some(at);
        // Who tells it knows it: 0 hops more than none that were ever told of it.
        let before = from.map(|from| spread.hops[from.index()].unwrap_or(0));
        spread.hops[robot.index()] = Some(before.map_or(0, |hops| hops + 1));
        spread.hops[robot.index()]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rumour_comes_over_one_hop_more_than_to_whom_it_came_from_and_the_first_way_counts() {
        let mut spread = Spread::new(1, 5);
        let mut inform = |robot: u32, from: Option<u32>| {
            spread.inform(
                ActorId(robot),
                0,
                SimTime::from_secs(f64::from(robot)),
                from.map(ActorId),
            )
        };
        assert_eq!(inform(2, None), Some(0));
        assert_eq!(inform(0, Some(2)), Some(1));
        assert_eq!(inform(1, Some(0)), Some(2));
        assert_eq!(inform(1, Some(2)), None, "it knows it already");
        assert_eq!(inform(3, Some(2)), Some(1));
        let [rumor] = &spread.into_records()[..] else {
            panic!("one rumour")
        };
        assert_eq!(rumor.hops, [Some(1), Some(2), Some(0), Some(1), None]);
    }
}
